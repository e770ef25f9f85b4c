//! Transient heat against independently computed values: locked wheel, braking.

use crate::common;
use crate::heat_common::*;
use wheelrail::heat::*;

#[test]
fn locked_wheel_after_a_tenth_of_a_second() {
    let v = 50.0 * KMH;
    let exchange = carter(1e5, v, 2.0);
    let heat = heat(&config(1e5, v));
    for steps in [20, 40] {
        let mut state = heat.initial(0.0, 0.0);
        let mut scratch = HeatScratch::default();
        let (mut worst, mut last, mut iterations) = (0.0_f64, HeatFlows::default(), 0);
        // Steps that grow with time resolve the start; their sum is 0.1 s.
        let growth = 1.3_f64.powf(20.0 / f64::from(steps));
        let first = 0.1 * (growth - 1.0) / (growth.powi(steps) - 1.0);
        for k in 0..steps {
            last = heat.advance(&mut state, first * growth.powi(k), v, 0.0, &exchange, &mut scratch);
            worst = worst.max(last.relative_imbalance());
            iterations += last.iterations;
        }
        println!("{steps} steps, {iterations} iterations, balance {worst:.1e}");
        let t = heat.temperatures(&state);
        let pairs = [
            ("wheel maximum", t.wheel_max, 33.51842, 5e-3),
            ("rail maximum", t.rail_max, 31.88154, 5e-3),
            ("wheel centre", t.wheel_centre, 28.10268, 5e-3),
            ("rail centre", t.rail_centre, 25.92435, 5e-3),
            ("wheel mean", t.wheel_mean, 8.72562e-5, 5e-3),
            ("rail mean", t.rail_mean, 0.005252097, 5e-3),
            ("conduction", last.conduction, 26046.99, 5e-3),
        ];
        for (what, value, reference, limit) in pairs {
            common::figure("heat.locked", &[deviation(value, reference)]);
            println!("  {what} {value:.6e} ({:+.3} %)", 100.0 * deviation(value, reference));
            assert!(deviation(value, reference).abs() < limit);
        }
        assert!(worst < 1e-10, "heat balance {worst:.1e}");
    }
}

/// Braking from 50 km/h at 4 km/h per second with creepage −8e-4, temperatures at 5 s and 10 s.
fn brake(heat: &Heat, dt: f64) -> [Temperatures; 2] {
    let mut state = heat.initial(0.0, 0.0);
    let mut scratch = HeatScratch::default();
    let mut out = [Temperatures::default(); 2];
    let steps = (10.0 / dt).round() as usize;
    for k in 1..=steps {
        let v = (50.0 - 4.0 * k as f64 * dt) * KMH;
        let flows = heat.advance(&mut state, dt, v, omega(v, -8e-4), &carter(1e5, v, -8e-4), &mut scratch);
        assert!(flows.relative_imbalance() < 1e-10, "{:.1e}", flows.relative_imbalance());
        if 2 * k == steps {
            out[0] = heat.temperatures(&state);
        }
    }
    out[1] = heat.temperatures(&state);
    out
}

#[test]
fn braking_transient() {
    let heat = heat(&config(1e5, 50.0 * KMH));
    // Held over a step, slowing speeds are those of its end: the error grows with the step (1.2 % at 0.25 s).
    for dt in [0.05, 0.0125] {
        let [t5, t10] = brake(&heat, dt);
        let pairs = [
            ("wheel maximum at 5 s", t5.wheel_max, 0.011975),
            ("wheel mean at 5 s", t5.wheel_mean, 3.02e-5),
            ("wheel maximum at 10 s", t10.wheel_max, 0.0070706),
            ("rail maximum at 10 s", t10.rail_max, 0.0070576),
            ("wheel mean at 10 s", t10.wheel_mean, 4.48e-5),
        ];
        for (what, value, reference) in pairs {
            common::figure("heat.braking", &[deviation(value, reference)]);
            println!("dt = {dt}: {what} {value:.6e} ({:+.3} %)", 100.0 * deviation(value, reference));
            assert!(deviation(value, reference).abs() < 0.01);
        }
    }
}

/// The front begins at the end of the zone and is one half-width long; its middle travels with the stream, nothing on
/// its way is colder or warmer than both rails, and the rail holds what has entered.
#[test]
fn a_front_of_warmer_rail_travels_with_the_stream_between_both_temperatures() {
    let config = config(1e5, 20.0);
    let (a, zone) = (config.half_width, config.zone);
    for (velocity, warm) in [(10.0, 30.0), (-10.0, 30.0), (10.0, -30.0)] {
        let heat = heat(&config);
        let (mut state, mut scratch) = (heat.initial(0.0, 0.0), HeatScratch::default());
        let exchange = Exchange { arriving: warm, ..Exchange::default() };
        let steps = 200;
        let dt = (zone + 0.5 * a) / 10.0 / f64::from(steps);
        let before = heat.heat_content(&state).unwrap()[1];
        let (mut entered, mut extremes) = (None, [0.0_f64; 2]);
        for k in 0..steps {
            let flows = heat.advance(&mut state, dt, velocity, velocity / RADIUS, &exchange, &mut scratch);
            let content = heat.heat_content(&state).unwrap()[1];
            // The rail ahead has become warmer at once, before the first step.
            entered = Some(entered.unwrap_or(content - before - dt * flows.stored_rail) + dt * flows.stored_rail);
            assert!((content - before - entered.unwrap()).abs() < 1e-9 * content.abs(), "step {k}");
            for t in &heat.observed(&state).surface[1] {
                let share = t / warm;
                extremes = [extremes[0].min(share), extremes[1].max(share)];
            }
        }
        // The middle of the front has come to the contact point.
        let seen = heat.observed(&state);
        let surface = wheelrail::piecewise::Piecewise { x: heat.zone_x().to_vec(), value: seen.surface[1].clone() };
        let ahead = |place: &f64| surface.at(place * velocity.signum()) / warm > 0.5;
        let place = (0..4000).map(|i| zone * (f64::from(i) / 2000.0 - 1.0)).find(ahead).unwrap();
        println!("{velocity} m/s: the middle at {:.4} half-widths, shares {extremes:?}", place / a);
        assert!(place.abs() < 0.05 * a, "{place}");
        assert!(extremes[0] > -0.1 / 30.0 - 1e-9 && extremes[1] < 1.0 + 0.1 / 30.0 + 1e-9, "{extremes:?}");
    }
}
