//! Cost of one two-body step in which step size and speeds change.

mod heat_common;
use heat_common::*;
use std::time::Instant;
use wheelrail::heat::*;
use wheelrail::piecewise::Piecewise;

fn median(mut times: Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

fn cost(name: &str, heat: &Heat, vary: f64, creepage: f64) -> f64 {
    let v = 50.0 * KMH;
    let mut exchange = carter(1e5, v, creepage);
    // As the mechanics delivers it: about forty nodes.
    let a = half_width(1e5);
    exchange.friction_power = Piecewise::sampled(-a, a, 41, |x| 1e6 * (1.0 - x / a));
    let mut state = heat.initial(0.0);
    let mut scratch = Scratch::default();
    let mut times = Vec::new();
    for k in 0..400 {
        let wave = 1.0 + vary * f64::from(k % 7);
        let (dt, v) = (1e-3 * wave, v * wave);
        let start = Instant::now();
        heat.step(&mut state, dt, v, omega(v, creepage), &exchange, &mut scratch).unwrap();
        times.push(start.elapsed().as_secs_f64());
    }
    let cost = median(times);
    println!("{name}: {:.3} ms per step, {} unknowns", 1e3 * cost, heat.unknowns());
    cost
}

#[test]
fn two_body_step_with_changing_step_size_and_speeds_takes_a_third_of_a_millisecond() {
    let heat = heat(&config(1e5, 50.0 * KMH));
    cost("constant step and speeds", &heat, 0.0, -8e-4);
    let changing = cost("step and speeds changing as in braking", &heat, 1e-4, -8e-4);
    cost("step and speeds changing by 1 to 6 % per step", &heat, 0.01, -8e-4);
    cost("locked wheel", &heat, 0.01, 2.0);
    let euler = HeatConfig { time_scheme: HeatTimeScheme::BackwardEuler, ..config(1e5, 50.0 * KMH) };
    cost("changing, backward Euler", &Heat::new(&euler).unwrap(), 0.01, -8e-4);
    // Generous, for other work on the same machine; `benches/heat.rs` measures.
    assert!(changing < 3e-3, "{changing}");
}
