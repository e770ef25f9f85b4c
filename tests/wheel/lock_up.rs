//! A wheel whose rotation is stopped: convergence of the slide, and lock-ups of all kinds that must run.

use crate::common::{self, model, preset};
use wheelrail::config::Config;
use wheelrail::simulation::{Drive, Inputs, Rotation, Simulation};

/// The railway wheel with few elements per half-width.
fn coarse(velocity: f64) -> Config {
    let mut config = preset("railway", 4);
    config.initial.velocity = velocity;
    config
}

/// Takes the angular velocity to zero within `duration` seconds and holds it there until `end`; calls `see` with time,
/// force and temperature after every step of `h` seconds.
fn stop(config: &Config, load: f64, [duration, end, h]: [f64; 3], mut see: impl FnMut(f64, f64, f64)) {
    let model = model(config.clone());
    let mut inputs = Inputs::rolling(model.config());
    inputs.rotation = Rotation::Velocity;
    inputs.drive.load = load;
    let start = inputs.drive.omega;
    let mut simulation = Simulation::new(model, &inputs).unwrap();
    for k in 1..=(end / h).round() as usize {
        let time = k as f64 * h;
        inputs.drive.omega = start * (1.0 - time / duration).max(0.0);
        simulation.advance(&inputs, h).unwrap_or_else(|error| panic!("at {time} s with steps of {h} s: {error}"));
        let o = simulation.outputs();
        see(time, o.contact_force_x, o.temperature_wheel_max);
    }
}

/// Force and temperature of a wheel that is locked within half a second, as means over 50 ms, in which the flashes of
/// the hot slide (milliseconds, at other instants with other steps) count with their share.
#[test]
fn a_lock_up_does_not_depend_on_the_communication_step() {
    const BINS: usize = 12;
    let means = |h: f64| {
        let mut sums = [[0.0; 2]; BINS];
        stop(&coarse(100.0 / 3.6), 1e5, [0.5, 0.05 * BINS as f64, h], |time, force, temperature| {
            let bin = &mut sums[((time / 0.05 - 1e-6) as usize).min(BINS - 1)];
            *bin = [bin[0] + force * h / 0.05, bin[1] + temperature * h / 0.05];
        });
        sums
    };
    let [long, short] = [1e-3, 1e-4].map(means);
    for (bin, (a, b)) in long.iter().zip(&short).enumerate() {
        println!(
            "until {:.2} s: {:.1} and {:.1} N, {:.1} and {:.1} K",
            0.05 * (bin + 1) as f64,
            a[0],
            b[0],
            a[1],
            b[1]
        );
    }
    common::figure("lock.up", &[0, 1].map(|k| long[11][k] / short[11][k] - 1.0));
    assert!(short[11][0] < -3e3 && short[11][1] > 1000.0, "it slides");
    // The first mean holds the sudden onset of braking, which samples of 1 ms sum up only roughly.
    for (a, b) in long.iter().zip(&short).skip(1) {
        assert!((a[0] / b[0] - 1.0).abs() < 0.01 && (a[1] / b[1] - 1.0).abs() < 0.01, "{a:?} {b:?}");
    }
}

#[test]
fn a_wheel_locked_within_a_millisecond_slides_on_at_any_load_speed_and_temperature() {
    let mut hot = coarse(20.0);
    hot.thermal.wheel_excess = 300.0;
    let cases = [
        ("nominal", coarse(27.8), 1e5),
        ("light", coarse(27.8), 1e4),
        ("heavy", coarse(27.8), 1.9e5),
        ("backwards", coarse(-27.8), 1e5),
        ("hot", hot, 1e5),
        ("slow", coarse(10.0), 1e5),
        ("fast", coarse(40.0), 1e5),
    ];
    for (name, config, load) in cases {
        let [long, short] = [1e-3, 1e-4].map(|h| {
            // The flashes of the hot slide come every 3 ms, and in the end at other instants with other steps: a mean
            // over five of them.
            let mut sum = 0.0;
            stop(&config, load, [1e-3, 0.03, h], |time, force, _| {
                sum += if time > 0.015 + 1e-6 { force * h } else { 0.0 };
            });
            sum / 0.015
        });
        common::figure("stopped.at.once", &[long / short - 1.0]);
        println!("{name}: {long:.0} N with steps of 1 ms, {short:.0} N with 0.1 ms");
        // Hot friction is a tenth of the cold one, 0.3, which is not exceeded.
        let resists = -short * config.initial.velocity.signum() / load;
        assert!(resists > 0.02 && resists < 0.3, "{name}: {short} N");
        // Of a flash the longer step samples three points.
        assert!((long / short - 1.0).abs() < 0.05, "{name}: {long} and {short} N");
    }
}

/// A moment beyond adhesion takes the rotation to zero, where the brake holds it.
#[test]
fn a_moment_locks_the_wheel_on_a_slippery_rail() {
    let mut slides = Vec::new();
    for h in [1e-3, 1e-4] {
        let model = model(coarse(10.0));
        let mut inputs = Inputs::rolling(model.config());
        inputs.drive = Drive { friction: 0.05, ..inputs.drive };
        let mut simulation = Simulation::new(model, &inputs).unwrap();
        inputs.drive.moment = -9000.0;
        let mut locked = None;
        for k in 1..=(0.15_f64 / h).round() as usize {
            simulation.advance(&inputs, h).unwrap();
            let o = simulation.outputs();
            if locked.is_none() && o.wheel_omega < 0.5 {
                locked = Some(k as f64 * h);
                (inputs.rotation, inputs.drive.omega) = (Rotation::Velocity, 0.0);
            }
        }
        let o = simulation.outputs();
        println!("steps of {h} s: locked at {locked:?}, {:.1} N, {:.4} m/s", o.contact_force_x, o.wheel_velocity);
        assert!(locked.is_some() && o.wheel_omega == 0.0);
        slides.push((o.contact_force_x, o.wheel_velocity));
    }
    assert!((slides[0].0 / slides[1].0 - 1.0).abs() < 0.01 && (slides[0].1 / slides[1].1 - 1.0).abs() < 1e-4);
}

/// Seven lines that a growing brake locks one after the other: means over 50 ms of force and temperature, and the numbers of
/// internal steps of all communication steps.
fn brake_lines(h: f64) -> (Vec<[f64; 2]>, Vec<u64>) {
    let mut config = preset("railway_ellipse", 4);
    config.initial.velocity = 16.7;
    let model = model(config);
    let mut inputs = Inputs::rolling(model.config());
    let mut simulation = Simulation::new(model, &inputs).unwrap();
    let (each, mut means, mut steps) = ((0.05 / h).round() as usize, Vec::new(), Vec::new());
    let seen = |simulation: &Simulation| {
        let o = simulation.outputs();
        [o.contact_force_x, o.temperature_wheel_max]
    };
    for bin in 0..14 {
        let mut sums = [0.0; 2];
        for k in 1..=each {
            inputs.drive.torque = 41.6e3 / 0.8 * (0.05 * bin as f64 + h * k as f64);
            let before = seen(&simulation);
            simulation.advance(&inputs, h).unwrap();
            let now = seen(&simulation);
            sums = [0, 1].map(|q| sums[q] + 0.5 * (before[q] + now[q]) / each as f64);
            steps.push(simulation.outputs().internal_steps);
        }
        means.push(sums);
    }
    (means, steps)
}

#[test]
fn lines_that_lock_take_few_internal_steps_and_slide_as_in_short_ones() {
    let [(long, steps), (short, _)] = [1e-3, 1e-4].map(brake_lines);
    for (k, (a, b)) in long.iter().zip(&short).enumerate() {
        println!("until {:.2} s: {:.1} and {:.1} N, {:.1} and {:.1} K", 0.05 * (k + 1) as f64, a[0], b[0], a[1], b[1]);
    }
    let [last, before] = [13, 12].map(|k| long[k][1]);
    assert!(last > 1000.0 && before > 1000.0, "it slides hot: {last} K");
    for (a, b) in long.iter().zip(&short) {
        assert!((a[0] - b[0]).abs() < 0.01 * b[0].abs().max(1e4) && (a[1] - b[1]).abs() < 0.01 * b[1]);
    }
    // Steps that lock, or that the sudden ends of the slip of a line bend, may be shorter.
    let short_ones = steps.iter().filter(|&&steps| steps > 4).count();
    println!("{} internal steps in {}, more than 4 in {short_ones} of them", steps.iter().sum::<u64>(), steps.len());
    assert!(short_ones < 10 && steps.iter().sum::<u64>() < 3 * steps.len() as u64);
}
