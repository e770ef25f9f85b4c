//! Torsional stick–slip: friction that falls with the slip of the tread excites the torsion of the wheel on its hub.

use crate::common::*;
use std::f64::consts::{FRAC_PI_2, TAU};
use std::sync::Arc;
use wheelrail::analytic::{Torsion, hub_torsion};
use wheelrail::config::{Config, Damping, Tuning};
use wheelrail::simulation::{Inputs, Model, Rotation, Simulation};

/// Friction coefficient on the rail [1].
const FRICTION: f64 = 0.4;
/// Slip velocity of the sliding wheel [m/s].
const SLIP: f64 = 0.1;
/// Sliding distance within which nothing happens: friction without a memory [m].
const AT_ONCE: f64 = 1e-12;
/// Share of the coefficient that remains at high slip.
const RATIO: f64 = 0.4;

/// The wheel of Paper D without heat, on a hub so heavy that the torsion meets it at rest.
fn heavy_hub() -> Arc<Model> {
    let mut config = preset("paper_d", 8);
    config.thermal.enabled = false;
    config.wheel.hub_inertia = 1e6;
    config.initial.velocity = 2.0;
    model(config)
}

fn torsion(config: &Config) -> Torsion {
    let material = &config.material;
    let shear = 0.5 * material.youngs_modulus / (1.0 + material.poissons_ratio);
    hub_torsion(config.wheel.radius, config.wheel.hub_radius, (shear / material.density).sqrt())
}

/// The law `μ₀ (A + (1 − A) e^{−B s})` with the slope `slope` [s/m] at [`SLIP`]; beyond the range of the interface it
/// may rise.
fn law_of_slope(config: &Config, slope: f64) -> Tuning {
    // At s no such law is steeper than that with B = 1/s.
    let ratio = if slope > 0.0 { 2.0 - RATIO } else { RATIO };
    let steep = |decay: f64| FRICTION * (ratio - 1.0) * decay * (-decay * SLIP).exp();
    let (mut low, mut high) = (0.0, 1.0 / SLIP);
    assert!(steep(high).abs() > slope.abs(), "{slope} is out of reach");
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if steep(middle).abs() < slope.abs() { low = middle } else { high = middle }
    }
    Tuning { falling_ratio: ratio, falling_decay: low, softening: 0.0, memory_length: AT_ONCE, ..config.tuning.clone() }
}

/// A wheel that slides steadily under a moment, and its inputs.
fn sliding(model: &Arc<Model>, tuning: &Tuning) -> (Simulation, Inputs) {
    let config = model.config();
    let v = config.initial.velocity;
    let mut inputs = prescribed(model, v, 0.0);
    inputs.drive.friction = FRICTION;
    inputs.drive.omega = (v - SLIP) / config.wheel.radius;
    let held = Simulation::start(model.clone(), tuning.clone(), &inputs).unwrap();
    inputs.rotation = Rotation::Moment;
    inputs.drive.moment = held.outputs().hub_moment;
    (held, inputs)
}

/// Growth rate [1/s] and frequency [rad/s] of an oscillation, from the amplitudes of its half-waves.
fn growth(values: &[f64], h: f64) -> (f64, f64) {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let mut crossings = Vec::new();
    for (k, pair) in values.windows(2).enumerate() {
        let (a, b) = (pair[0] - mean, pair[1] - mean);
        if a * b < 0.0 {
            crossings.push((k as f64 + a / (a - b)) * h);
        }
    }
    // Energy between every second crossing: whole periods.
    let mut points = Vec::new();
    for period in crossings.windows(3).step_by(2) {
        let inside = |k: &usize| (*k as f64 * h) >= period[0] && (*k as f64 * h) < period[2];
        let square: f64 = (0..values.len()).filter(inside).map(|k| (values[k] - mean).powi(2)).sum::<f64>() * h;
        points.push((0.5 * (period[0] + period[2]), 0.5 * (square / (period[2] - period[0])).ln()));
    }
    let frequency =
        std::f64::consts::PI * (crossings.len() - 1) as f64 / (crossings[crossings.len() - 1] - crossings[0]);
    let n = points.len() as f64;
    let (x, y) = points.iter().fold((0.0, 0.0), |(x, y), p| (x + p.0 / n, y + p.1 / n));
    let (xy, xx) = points.iter().fold((0.0, 0.0), |(xy, xx), p| (xy + (p.0 - x) * (p.1 - y), xx + (p.0 - x).powi(2)));
    (xy / xx, frequency)
}

/// Quarter of a period of the torsion [s].
fn quarter(model: &Model) -> f64 {
    0.25 * TAU / torsion(model.config()).frequency
}

/// Slip of the tread of the sliding wheel in steps of `h`, after a short dip of the friction available to the share
/// `dip`.
fn rings(model: &Arc<Model>, tuning: &Tuning, h: f64, time: f64, dip: f64) -> Vec<f64> {
    rings_after(model, tuning, h, time, |quarters| if quarters < 1.0 { dip } else { 1.0 })
}

/// Slip of the tread of the sliding wheel in steps of `h`, with this share of the friction available after so many
/// quarters of a period.
fn rings_after(model: &Arc<Model>, tuning: &Tuning, h: f64, time: f64, share: impl Fn(f64) -> f64) -> Vec<f64> {
    let (mut simulation, inputs) = sliding(model, tuning);
    let quarter = quarter(model);
    let slip = |k: usize| {
        let mut now = inputs;
        now.drive.friction *= share(k as f64 * h / quarter);
        simulation.advance(&now, h).unwrap();
        simulation.outputs().contact_tread_slip
    };
    (0..(time / h).round() as usize).map(slip).collect()
}

/// Growth rate [1/s] and frequency [rad/s] two periods after a small dip, within 0.15 s.
fn small_swings(model: &Arc<Model>, tuning: &Tuning, h: f64) -> (f64, f64) {
    let slips = rings(model, tuning, h, 0.15, 0.99);
    growth(&slips[(8.0 * quarter(model) / h) as usize..], h)
}

/// Growth rate [1/s] and frequency [rad/s] of the torsion for friction of this slope, and the rate in closed form: a
/// force `−μ(s) P` at the rim on the modal mass `m = ρ · rim_area` gives `q̈ + (P μ′/m) q̇ + ω² q = 0`.
fn grown(model: &Arc<Model>, slope: f64, h: f64) -> [f64; 3] {
    let config = model.config();
    let mass = config.material.density * torsion(config).rim_area * config.model.contact_width;
    let (rate, frequency) = small_swings(model, &law_of_slope(config, slope), h);
    let expected = -0.5 * config.model.nominal_load * slope / mass;
    println!("h {h:.0e}, slope {slope:+.2} s/m: rate {rate:+.4} 1/s, closed form {expected:+.4}, {frequency:.1} rad/s");
    [rate, frequency, expected]
}

#[test]
fn falling_friction_excites_the_torsion_at_half_its_slope_over_the_mass_and_rising_friction_damps_it() {
    let model = heavy_hub();
    let exact = torsion(model.config()).frequency;
    assert!((exact / 1777.3 - 1.0).abs() < 1e-3, "{exact}");
    for (h, slopes) in [(2e-5, &[-0.2, -0.4, -0.8, 0.4][..]), (1e-5, &[-0.4])] {
        // Constant friction neither damps nor excites; what is left is the energy that streams out with the rail, and
        // the damping of the time formula.
        let [constant, ..] = grown(&model, 0.0, h);
        assert!(constant < 0.0 && constant > -0.1, "{constant}");
        for &slope in slopes {
            let [rate, frequency, expected] = grown(&model, slope, h);
            figure("stick.slip.rate", &[rate / expected - 1.0, frequency / exact - 1.0]);
            assert!(rate.signum() == -slope.signum(), "{rate}");
            assert!((rate / expected - 1.0).abs() < 0.05, "{rate} for {expected}");
            assert!((frequency / exact - 1.0).abs() < 0.01, "{frequency} for {exact}");
        }
    }
}

/// Damping ratio at which friction of this slope feeds just what is lost: `2 ζ ω = P |μ′|/m`.
fn ratio_of_onset(config: &Config, slope: f64) -> f64 {
    let mass = config.material.density * torsion(config).rim_area * config.model.contact_width;
    0.5 * config.model.nominal_load * slope.abs() / mass / torsion(config).frequency
}

/// The wheel with this modal damping ratio of its torsion.
fn damped(ratio: f64) -> Arc<Model> {
    let mut config = heavy_hub().config().clone();
    config.damping = Damping { wheel_torsion: ratio, ..Damping::default() };
    model(config)
}

#[test]
fn stick_slip_sets_in_where_the_slope_of_friction_equals_the_modal_damping() {
    for (h, slopes) in [(2e-5, &[-0.2, -0.4, -0.8][..]), (1e-5, &[-0.2])] {
        for &slope in slopes {
            let config = heavy_hub().config().clone();
            let (tuning, onset, torsion) =
                (law_of_slope(&config, slope), ratio_of_onset(&config, slope), torsion(&config).frequency);
            let [below, above] = [0.95, 1.05].map(|share| {
                let (rate, frequency) = small_swings(&damped(share * onset), &tuning, h);
                assert!((frequency / torsion - 1.0).abs() < 0.01, "{frequency} for {torsion}");
                rate
            });
            let found = 0.95 + 0.1 * below / (below - above);
            figure("stick.slip.onset", &[found - 1.0]);
            println!(
                "h {h:.0e}, slope {slope} s/m: onset at {found:.4} of the ratio {onset:.3e}: {below:+.4}, {above:+.4} 1/s"
            );
            assert!(below > 0.0 && above < 0.0);
        }
    }
    // Rising friction damps on top.
    let (rate, _) = small_swings(&damped(1e-3), &law_of_slope(heavy_hub().config(), 0.4), 2e-5);
    assert!(rate < -7.0, "{rate}");
}

/// Periods of the torsion during which friction comes and goes.
const DRIVEN: f64 = 10.0;

/// Smallest and largest slip, and frequency [rad/s], of stick–slip that friction that comes and goes has driven to its
/// full size.
fn limit_cycle(h: f64) -> [f64; 3] {
    let config = heavy_hub().config().clone();
    let model = damped(0.2 * ratio_of_onset(&config, -0.4));
    let drive = |quarters: f64| if quarters < 4.0 * DRIVEN && quarters % 4.0 < 2.0 { 0.0 } else { 1.0 };
    let slips = rings_after(&model, &law_of_slope(&config, -0.4), h, 0.25, drive);
    let last = &slips[slips.len() - (0.05 / h) as usize..];
    let (low, high) = range(last);
    let [rate, frequency] = <[f64; 2]>::from(growth(last, h));
    println!("h {h:.0e}: slip {low:.5} to {high:.5} m/s, {frequency:.2} rad/s, growth {rate:+.4} 1/s");
    assert!(rate.abs() < 0.01);
    [low, high, frequency]
}

#[test]
fn saturated_stick_slip_does_not_depend_on_the_step() {
    let exact = torsion(heavy_hub().config()).frequency;
    let cycles = [4e-5, 2e-5].map(limit_cycle);
    for [low, high, frequency] in cycles {
        // It grows until the tread all but sticks once in each period.
        assert!(low.abs() < 1e-3 * high && (high / (2.0 * SLIP) - 1.0).abs() < 0.05);
        assert!((frequency / exact - 1.0).abs() < 0.01);
    }
    let [swing, frequency] =
        [(cycles[0][1] - cycles[0][0]) / (cycles[1][1] - cycles[1][0]), cycles[0][2] / cycles[1][2]];
    figure("stick.slip.cycle", &[swing - 1.0, frequency - 1.0]);
    println!("swings {swing:.5}, frequencies {frequency:.5}");
    assert!((swing - 1.0).abs() < 0.03 && (frequency - 1.0).abs() < 0.03);
}

/// Communication steps of 1 ms hide the onset from a time formula that damps; the error control refines them as soon as
/// the swings are large enough to matter.
#[test]
fn error_control_finds_the_onset_of_swings_that_matter_in_long_communication_steps() {
    let config = heavy_hub().config().clone();
    let tuning = Tuning { tolerance: Config::default().tuning.tolerance, ..law_of_slope(&config, -0.4) };
    for (share, grows) in [(0.5, true), (0.95, false)] {
        let slips = rings(&damped(share * ratio_of_onset(&config, -0.4)), &tuning, 1e-3, 0.6, 0.0);
        let swing = |part: &[f64]| {
            let (low, high) = range(part);
            high - low
        };
        let [early, late] = [&slips[200..300], &slips[500..]].map(swing);
        let rate = (late / early).ln() / 0.3;
        println!("{share} of the ratio of onset: swing {early:.4} to {late:.4} m/s, growth {rate:+.3} 1/s");
        // Half the damping leaves half the rate of the undamped wheel.
        let undamped = ratio_of_onset(&config, -0.4) * torsion(&config).frequency;
        assert_eq!(rate > 0.0, grows);
        assert!(!grows || (rate / (0.5 * undamped) - 1.0).abs() < 0.1, "{rate} for {}", 0.5 * undamped);
    }
}

/// Flexibility without mass has no time scale of its own but `P C |μ′|`, some microseconds; steps as short make it
/// chatter.
#[test]
fn a_short_memory_of_friction_keeps_local_flexibility_from_chattering_in_very_short_steps() {
    let config = heavy_hub().config().clone();
    let model = damped(0.5 * ratio_of_onset(&config, -0.4));
    let tuning = law_of_slope(&config, -0.4);
    let smooth = Tuning { memory_length: 1e-5, ..tuning.clone() };
    let found = [(&tuning, 1e-5), (&smooth, 5e-6), (&smooth, 2e-6)].map(|(tuning, h)| {
        // A jump of the friction would excite what is faster than the torsion, too.
        let dip = |quarters: f64| 1.0 - if quarters < 2.0 { 0.01 * (FRAC_PI_2 * quarters).sin().powi(2) } else { 0.0 };
        let slips = rings_after(&model, tuning, h, 0.05, dip);
        let (rate, frequency) = growth(&slips[slips.len() / 4..], h);
        println!("memory {:.0e} m, h {h:.0e}: growth {rate:+.4} 1/s, {frequency:.1} rad/s", tuning.memory_length);
        [rate, frequency]
    });
    for [rate, frequency] in &found[1..] {
        assert!((rate / found[0][0] - 1.0).abs() < 0.1 && (frequency / found[0][1] - 1.0).abs() < 2e-3);
    }
}

/// The wheel with half the damping of onset in its torsion, and more in all else.
fn viscous(reduced: bool) -> Arc<Model> {
    let mut config = preset("paper_d", 4);
    (config.thermal.enabled, config.wheel.hub_inertia, config.initial.velocity) = (false, 1e6, 2.0);
    let ratio = 0.5 * ratio_of_onset(&config, SLOPE_OF_RESPONSES);
    config.damping = Damping { wheel_torsion: ratio, ..Damping::all(0.05) };
    config.solver.reduced = reduced;
    model(config)
}

/// Slope of friction at which both responses are compared [s/m].
const SLOPE_OF_RESPONSES: f64 = -0.8;

/// Slips of the reduced and the full response.
fn both_responses(h: f64, time: f64) -> [Vec<f64>; 2] {
    [true, false].map(|reduced| {
        let model = viscous(reduced);
        rings(&model, &law_of_slope(model.config(), SLOPE_OF_RESPONSES), h, time, 0.99)
    })
}

#[test]
fn reduced_and_full_response_swing_alike() {
    let h = 5e-5;
    // Two milliseconds after the dip, whose jump excites modes that the reduced response has not.
    let [reduced, full] = both_responses(h, 0.0055).map(|slips| slips[40..].to_vec());
    let (low, high) = range(&full);
    let differences = reduced.iter().zip(&full).map(|(a, b)| (a - b).abs() / (high - low));
    let worst = differences.fold(0.0, f64::max);
    println!("largest difference {worst:.2e} of the swing {:.2e} m/s", high - low);
    assert!(worst < 0.02);
}

#[test]
#[ignore = "two minutes"]
fn reduced_and_full_response_grow_alike() {
    let [reduced, full] = both_responses(2e-5, 0.04).map(|slips| growth(&slips[slips.len() / 5..], 2e-5));
    println!("growth and frequency {reduced:?} reduced, {full:?} full");
    assert!((reduced.0 / full.0 - 1.0).abs() < 0.02 && (reduced.1 / full.1 - 1.0).abs() < 0.02);
    let config = viscous(true).config().clone();
    let half = 0.5 * ratio_of_onset(&config, SLOPE_OF_RESPONSES) * torsion(&config).frequency;
    assert!((full.0 / half - 1.0).abs() < 0.05, "{full:?} for {half}");
}
