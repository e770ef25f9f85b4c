//! Memory requests of a heat step and its observation.

use crate::heap;
use crate::heat_common::*;
use wheelrail::heat::*;

#[test]
fn a_step_with_its_observation_requests_memory_for_the_coupling_matrix_only() {
    let v = 50.0 * KMH;
    let heat = heat(&config(1e5, 1.1 * v));
    let rolling = Exchange { sources: brake_blocks(60.0), ..carter(1e5, v, -8e-4) };
    let mut exchange = rolling.clone();
    let (mut state, mut next) = (heat.initial(20.0, 0.0), HeatState::default());
    let (mut seen, mut scratch) = (Observation::default(), HeatScratch::default());
    // Nothing changes; speeds and step change; the wheel is locked and conduction around it corrected.
    for (name, vary, turning, dt, largest) in
        [("held", 0.0, 1.0, 1e-3, 0), ("changing", 1e-3, 1.0, 1e-3, 2), ("locked", 1e-3, 0.0, 2e-2, 2)]
    {
        let mut most = 0;
        for k in 0..24 {
            let wave = 1.0 + vary * f64::from(k % 5);
            let before = heap::requests();
            exchange.clear();
            exchange.patches.extend_from_slice(&rolling.patches);
            exchange.sources.extend_from_slice(&rolling.sources);
            for (&x, &value) in rolling.friction_power.x.iter().zip(&rolling.friction_power.value) {
                exchange.friction_power.push(x, value * wave);
            }
            let omega = turning * omega(v * wave, -8e-4);
            let mut line = [HeatLine::new(&state, &mut next, &exchange)];
            heat.step(&mut line, dt * wave, v * wave, omega, &mut scratch).unwrap();
            heat.observe(&next, &mut seen).unwrap();
            std::mem::swap(&mut state, &mut next);
            // The first steps of each kind lay out the buffers.
            if k >= 12 {
                most = most.max(heap::requests() - before);
            }
        }
        println!("{name}: at most {most} requests per step");
        assert!(most <= largest, "{name}: {most} requests");
    }
}
