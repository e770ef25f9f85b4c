//! Energy of wheels that leave the rail: as someone finds it who has nothing but the outputs, at steps of a
//! millisecond.

use crate::common::{self, KMH, model, preset};
use wheelrail::config::Config;
use wheelrail::simulation::{Inputs, Outputs, Simulation, Vertical};

/// Energy that has gone in and is neither stored nor dissipated \[J], from the outputs.
fn missing(o: &Outputs) -> f64 {
    let work = o.hub_work + o.gravity_work + o.lift_work + o.thermal_work;
    work - o.stored_energy - o.damping_energy - o.friction_energy - o.plastic_energy
}

/// A cold wheel on a coarse mesh.
fn cold() -> Config {
    let mut config = preset("railway", 10);
    config.thermal.enabled = false;
    config
}

/// A drop from `height` \[m], where the wheel was held since the start.
struct Drop {
    load: f64,
    step: f64,
    height: f64,
    config: Config,
}

impl Drop {
    /// Of a millimetre under 100 kN without damper, in steps of a millisecond.
    fn usual() -> Self {
        let mut config = cold();
        config.vehicle.damping = 0.0;
        Self { load: 1e5, step: 1e-3, height: 1e-3, config }
    }

    /// Checks energy and work at every output until shortly after the first strike.
    fn check(self, name: &str) {
        let Self { load, step, height, config } = self;
        let model = model(config);
        let mut inputs = Inputs::rolling(model.config());
        (inputs.vertical, inputs.drive.displacement) = (Vertical::Displacement, height);
        let mut simulation = Simulation::new(model, &inputs).unwrap();
        for _ in 0..3 {
            simulation.advance(&inputs, step).unwrap();
        }
        (inputs.vertical, inputs.drive.load) = (Vertical::Force, load);
        let start = simulation.outputs().clone();
        let (mut worst, mut struck, mut steps) = ([0.0f64; 4], 0, 0);
        while struck < 3 {
            simulation.advance(&inputs, step).unwrap();
            let now = simulation.outputs();
            steps += 1;
            assert!(steps < 500, "{name}: no strike");
            let fallen = load * (start.hub_height - now.hub_height);
            let work = now.hub_work - start.hub_work;
            let lost = missing(now) - missing(&start);
            worst[0] = worst[0].max((work - fallen).abs() / (load * height));
            if struck == 0 && now.contact_force_max == 0.0 {
                worst[1] = worst[1].max(lost.abs() / fallen);
                worst[2] = worst[2].max(now.energy_residual.abs());
            } else {
                struck += 1;
                worst[3] = worst[3].max(lost.abs() / (load * height));
            }
        }
        common::round_off("drop.work", &worst[..1], 1e-12);
        common::figure("drop.missing", &[worst[1], worst[3]]);
        println!(
            "{name}: work {:.1e}, falling {:.1e}, residual {:.1e}, struck {:.1e}",
            worst[0], worst[1], worst[2], worst[3]
        );
        assert!(worst[0] < 1e-9, "{name}: work of the load against its height {}", worst[0]);
        assert!(worst[1] < 2e-3, "{name}: {} of the fall is missing before the strike", worst[1]);
        assert!(worst[2] < 1e-2, "{name}: energy residual before the strike {}", worst[2]);
        assert!(worst[3] < 2e-3, "{name}: {} of the fall is missing after the strike", worst[3]);
    }
}

#[test]
fn a_falling_wheel_has_the_energy_of_its_height_at_every_step_length() {
    for step in [1e-4, 3e-4, 1e-3, 2e-3] {
        Drop { step, ..Drop::usual() }.check(&format!("{step} s"));
    }
    for load in [1e4, 1.9e5] {
        Drop { load, ..Drop::usual() }.check(&format!("{load} N"));
    }
    Drop { height: 3e-4, ..Drop::usual() }.check("from 0.3 mm");
    type Change = (&'static str, fn(&mut Config));
    let changes: [Change; 4] = [
        ("with damper", |config| config.vehicle.damping = 2e4),
        ("standing", |config| config.initial.velocity = 0.0),
        ("reversed", |config| config.initial.velocity *= -1.0),
        ("without error control", |config| (config.tuning.tolerance, config.tuning.max_step) = (0.0, 1e-5)),
    ];
    for (name, change) in changes {
        let mut drop = Drop::usual();
        change(&mut drop.config);
        drop.check(name);
    }
}

/// The time formula itself: a single step of a millisecond, which starts afresh, falls by `½ a t²`.
#[test]
fn a_step_that_starts_afresh_falls_as_far_as_its_work_says() {
    for step in [1e-3, 5e-4] {
        let mut config = cold();
        (config.vehicle.damping, config.tuning.tolerance) = (0.0, 0.0);
        let model = model(config);
        let mut inputs = Inputs::rolling(model.config());
        (inputs.vertical, inputs.drive.displacement) = (Vertical::Displacement, 1e-3);
        let mut simulation = Simulation::new(model, &inputs).unwrap();
        simulation.advance(&inputs, step).unwrap();
        (inputs.vertical, inputs.drive.load) = (Vertical::Force, 1e5);
        for k in 1..=2 {
            simulation.advance(&inputs, step).unwrap();
            let (o, t) = (simulation.outputs(), f64::from(k) * step);
            let fall = 0.5 * 1e5 / o.wheel_mass * t * t;
            println!("{t} s: {:.6} mm, ½ a t² {:.6} mm", 1e3 * (1e-3 - o.hub_height), 1e3 * fall);
            // The deformation of the wheel takes part with a percent; backward Euler alone falls twice as far in the
            // first step.
            assert!(((1e-3 - o.hub_height) / fall - 1.0).abs() < 2e-2);
        }
    }
}

/// Residual at the end of `end` seconds in steps of `step` under a load that `load` gives, and the time without
/// contact. The work of the hub must be what the outputs say: load times height.
fn residual(config: Config, step: f64, end: f64, load: impl Fn(f64) -> f64) -> [f64; 2] {
    let model = model(config);
    let mut inputs = Inputs::rolling(model.config());
    inputs.drive.load = load(0.0);
    let mut simulation = Simulation::new(model, &inputs).unwrap();
    let (mut steps, mut work) = (0, 0.0);
    for k in 0..(end / step).round() as usize {
        inputs.drive.load = load((k as f64 + 0.5) * step);
        let height = simulation.outputs().hub_height;
        simulation.advance(&inputs, step).unwrap();
        work += inputs.drive.load * (height - simulation.outputs().hub_height);
        steps += simulation.outputs().internal_steps;
    }
    let o = simulation.outputs();
    let dissipated = o.friction_energy + o.damping_energy + o.plastic_energy;
    common::figure("energy.in.the.air", &[o.energy_residual]);
    println!("  {steps} steps, {:.3} of {dissipated:.2} J missing, residual {:+.1e}", missing(o), o.energy_residual);
    assert!((o.hub_work - work).abs() < 1e-6, "work {} J, load times height {work} J", o.hub_work);
    [o.energy_residual, o.contact_lost_time]
}

#[test]
fn a_load_that_drops_in_one_step_leaves_no_energy_unaccounted() {
    for (from, to, step) in [(1e5, 1e4, 1e-3), (1e5, 1e4, 1e-4), (1e5, 3e4, 1e-3), (1.9e5, 1e4, 1e-3), (1e4, 1e3, 1e-3)]
    {
        println!("{from} to {to} N in steps of {step} s");
        let [residual, lost] = residual(cold(), step, 0.05, |t| if t < 0.01 { from } else { to });
        assert!(residual.abs() < 1e-2, "{from} to {to} N, {step} s: {residual}");
        assert!(lost > 0.0 || to > 1e4 || from < 1e5, "the contact is lost");
    }
}

#[test]
fn a_flat_that_throws_the_wheel_off_the_rail_leaves_no_energy_unaccounted() {
    for (length, speed, step) in
        [(0.05, 90.0, 1e-3), (0.05, 90.0, 1e-4), (0.05, -90.0, 1e-3), (0.03, 60.0, 1e-3), (0.05, 140.0, 1e-3)]
    {
        println!("flat of {length} m at {speed} km/h in steps of {step} s");
        let mut config = cold();
        // Backwards the flat comes from the other side.
        let turn = std::f64::consts::TAU * config.wheel.radius;
        let position = if speed > 0.0 { 0.3 } else { turn - 0.3 };
        config.wheel.profile = format!("flat(position = {position}, length = {length})");
        config.initial.velocity = speed * KMH;
        let [residual, lost] = residual(config, step, 0.05, |_| 1e5);
        assert!(residual.abs() < 1e-2, "{length} m, {speed} km/h, {step} s: {residual}");
        assert!(lost > 0.0, "the contact is lost");
    }
}
