//! Contact lines side by side: halves of a line are the line, and lines that differ share load and friction by closed
//! forms.

use crate::common::{self, KMH, preset};
use crate::half_planes::{FRICTION, HalfPlanes, NOMINAL, RADIUS, SideLine, modulus};
use std::f64::consts::PI;
use wheelrail::analytic::{carter_force, carter_full_slip, hertz_half_width};
use wheelrail::config::{Config, Damping, StartTemperature, Wear};
use wheelrail::mechanics::{Basis, bodies};
use wheelrail::piecewise::Piecewise;
use wheelrail::rolling::outputs::observe;
use wheelrail::rolling::{
    Inputs, Line, ModelError, RollingModel, Rotation, State, Translation, Workspace, stationary, substeps,
};
use wheelrail::simulation::Outputs;
use wheelrail::surface::Surfaces;

/// Distance at which a force of a line no longer displaces it by more than forces of other lines do [m].
const REACH: f64 = 0.025;

/// Inputs of a run over its time [s].
type Course = fn(&mut Inputs, f64);

/// Shares of two lines of half the width.
const HALVES: [f64; 2] = [0.5, 0.5];

/// The model of a configuration, with lines of given shares side by side.
fn model(config: &Config, shares: &[f64]) -> Result<RollingModel, ModelError> {
    let found = common::store().find(config).unwrap();
    let basis = found.map_or_else(|| Basis::compute(&config.into(), &mut |_, _| {}).unwrap(), |(basis, _)| basis);
    let pair = bodies(&config.into(), Some(basis), &mut |_, _| {}).unwrap();
    let profiles = [&config.wheel.profile, &config.rail.profile].map(String::as_str);
    let surfaces = Surfaces::parse(config.wheel.radius, profiles, None).unwrap();
    let model = RollingModel::new(config.clone(), pair, surfaces)?;
    if shares.len() == 1 { Ok(model) } else { model.with_lines(shares.to_vec(), REACH) }
}

/// Outputs of the start and after every one of `steps` steps of `dt` seconds, and the last state.
fn run(model: &RollingModel, inputs: &Inputs, course: Course, (dt, steps): (f64, usize)) -> (Vec<Outputs>, State) {
    let (mut workspace, tuning) = (Workspace::default(), &model.config.tuning);
    let mut state = stationary::start(model, tuning, inputs, &mut workspace).unwrap();
    let mut seen = vec![observe(model, &state)];
    let mut inputs = *inputs;
    for step in 1..=steps {
        course(&mut inputs, dt * step as f64);
        let mut next = State::default();
        substeps::advance(model, tuning, &state, &inputs, dt, &mut workspace, &mut next).unwrap();
        assert!(model.fits(&next));
        state = next;
        seen.push(observe(model, &state));
    }
    (seen, state)
}

/// Largest difference of two runs in the outputs of `rows`, profiles included, over the largest amount of that output
/// or a thousandth of its usual size.
fn difference(a: &[Outputs], b: &[Outputs], rows: impl Fn(&str) -> bool) -> (f64, &'static str) {
    use wheelrail::rolling::{OutputRow, Read};
    // Outputs of single lines differ by their number.
    let rows = |name: &str| !name.starts_with("line.") && rows(name);
    let values = |row: &OutputRow, outputs: &Outputs| match row.read {
        Read::Real(read) => vec![read(outputs)],
        Read::Profile(read) | Read::Deferred(read) => read(outputs).to_vec(),
        Read::Count(read) => vec![read(outputs) as f64],
        Read::Flag(read) => vec![f64::from(u8::from(read(outputs)))],
    };
    let mut worst = (0.0, "");
    for row in Outputs::ROWS.iter().filter(|row| rows(row.name)) {
        let pairs = || a.iter().zip(b).flat_map(|(a, b)| values(row, a).into_iter().zip(values(row, b)));
        let scale = pairs().map(|(a, b)| a.abs().max(b.abs())).fold(row.nominal * 1e-3, f64::max);
        let apart = pairs().map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / scale;
        if apart > worst.0 {
            worst = (apart, row.name);
        }
    }
    worst
}

/// Outputs that count the work of the solver, and the residuals, which are differences of round-off themselves.
const UNCOMPARED: [&str; 5] = [
    "contact.line_count",
    "solver.iterations",
    "solver.energy_residual",
    "solver.heat_residual",
    "solver.internal_steps",
];
/// Outputs that magnify round-off: the time formula divides that of motions by the step, and stored energy is a small
/// difference of large ones.
const RATES: [&str; 5] = [
    "wheel.acceleration",
    "wheel.angular_acceleration",
    "hub.vertical_velocity",
    "brake.torque_actual",
    "energy.stored",
];

/// Runs one line and lines of each of the given `shares`, and asserts that they agree: forces, creepage, temperatures
/// and energies to 1e-8, those that magnify round-off to 1e-5.
fn compare(name: &str, (config, inputs): (&Config, &Inputs), course: Course, steps: (f64, usize), shares: &[&[f64]]) {
    let (one, _) = run(&model(config, &[1.0]).unwrap(), inputs, course, steps);
    for shares in shares {
        let (several, state) = run(&model(config, shares).unwrap(), inputs, course, steps);
        assert_eq!(state.lines.len(), shares.len());
        let rates = difference(&one, &several, |name| RATES.contains(&name));
        let others = |name: &str| !RATES.contains(&name) && !UNCOMPARED.contains(&name);
        let others = difference(&one, &several, others);
        let kind = name.split([' ', ',']).next().unwrap_or_default();
        common::round_off(&format!("lines.{kind}"), &[others.0], 1e-8);
        println!("{name}, {shares:?}: {:.1e} in {}, rates {:.1e} in {}", others.0, others.1, rates.0, rates.1);
        assert!(others.0 < 1e-8 && rates.0 < 1e-5, "{name} {shares:?}: {others:?} {rates:?}");
    }
}

fn braking(config: &Config) -> Inputs {
    let mut inputs = Inputs::rolling(config);
    inputs.drive.moment = -4000.0;
    inputs
}

fn with_speeds(config: &Config) -> Inputs {
    let mut inputs = Inputs::rolling(config);
    (inputs.rotation, inputs.translation) = (Rotation::Velocity, Translation::Velocity);
    inputs
}

fn vary(inputs: &mut Inputs, t: f64) {
    inputs.drive.moment = -4000.0 - 2000.0 * (300.0 * t).sin();
    inputs.drive.load = 1e5 * (1.0 + 0.1 * (400.0 * t).sin());
    inputs.drive.friction = 0.3 + 0.03 * (200.0 * t).sin();
    inputs.drive.temperature = 293.0 + 1e3 * t;
}

fn keep(_: &mut Inputs, _: f64) {}

#[test]
fn lines_of_a_part_of_the_width_and_equal_load_are_one_line_while_all_inputs_vary() {
    let config = preset("railway", 8);
    compare("braking", (&config, &braking(&config)), vary, (1e-3, 30), &[&HALVES, &[0.2, 0.5, 0.3]]);
}

#[test]
fn lines_of_a_part_of_the_width_and_equal_load_are_one_line_on_a_rough_rail_with_damped_bodies_on_a_track() {
    let mut config = preset("railway", 8);
    config.rail.profile = "sinusoid(amplitude = 10e-6, wavelength = 0.05)".into();
    (config.rail.support_stiffness, config.rail.support_damping) = (5e7, 5e4);
    config.damping = Damping::all(0.02);
    compare("rough rail", (&config, &braking(&config)), vary, (5e-4, 30), &[&HALVES]);
}

#[test]
fn lines_of_a_part_of_the_width_and_equal_load_are_one_line_from_rolling_to_lock_by_a_brake_with_yielding_steel() {
    let mut config = preset("railway_damage", 8);
    config.initial.velocity = 60.0 * KMH;
    let mut inputs = Inputs::rolling(&config);
    inputs.translation = Translation::Velocity;
    let brake = |inputs: &mut Inputs, t: f64| inputs.drive.torque = (4e6 * t).min(60e3);
    compare("lock by brake", (&config, &inputs), brake, (1e-3, 60), &[&HALVES]);
}

#[test]
fn lines_of_a_part_of_the_width_and_equal_load_are_one_line_under_falling_friction_with_wear() {
    let mut config = preset("railway", 8);
    (config.tuning.falling_ratio, config.tuning.falling_decay) = (0.4, 0.6);
    config.damage.wear = Wear::TGamma;
    (config.initial.velocity, config.initial.creepage) = (15.0, Some(0.02));
    compare("falling friction", (&config, &with_speeds(&config)), keep, (1e-3, 30), &[&[0.3, 0.7]]);
}

/// At rest nodes that unload pass from stick to slip and back within the tolerance of the states, so that only the
/// start is compared there.
#[test]
fn stationary_lines_of_a_part_of_the_width_and_equal_load_are_one_line_hot_fast_and_at_rest() {
    let load = |inputs: &mut Inputs, t: f64| inputs.drive.load = if t < 2.5e-3 { 1e4 } else { 1.9e5 };
    for (velocity, temperature, steps) in
        [(0.0, StartTemperature::Uniform, 0), (-30.0, StartTemperature::Stationary, 5)]
    {
        let mut config = preset("railway", 8);
        (config.initial.velocity, config.thermal.wheel_excess) = (velocity, 150.0);
        config.initial.temperature = temperature;
        compare(&format!("hot, {velocity} m/s"), (&config, &Inputs::rolling(&config)), load, (1e-3, steps), &[&HALVES]);
    }
}

/// Round-off decides when a node opens or strikes, so that flights of the wheel agree to what that costs.
#[test]
fn lifted_lines_come_down_together() {
    let config = preset("railway", 8);
    let lift = |inputs: &mut Inputs, t: f64| inputs.drive.load = if t > 4.5e-3 { 1e5 } else { 0.0 };
    let [one, several] =
        [&[1.0][..], &HALVES].map(|shares| run(&model(&config, shares).unwrap(), &braking(&config), lift, (1e-3, 8)).0);
    assert!(one.iter().any(|outputs| outputs.contact_patches == 0));
    let apart = difference(&one, &several, |name| name.starts_with("contact.force_y") || name == "contact.impulse_y");
    println!("lifted: {apart:?}");
    assert!(apart.0 < 1e-3, "{apart:?}");
}

/// Load of a Hertzian line [N/m] whose own flexibility, with the reach L, lets the surfaces approach by `approach`:
/// `(2P/πE*)(ln(2L/a) + ½)`, from the mean of `−ln(|x|/L)` over the elliptical pressure at its middle.
fn approach(load: f64, length: f64) -> f64 {
    let a = hertz_half_width(load, RADIUS, modulus());
    2.0 * load / (PI * modulus()) * ((2.0 * length / a).ln() + 0.5)
}

/// Wheels of different height on two lines of different width: the loads differ by what the flexibility of each line
/// for itself allows, whatever the bodies that both press are like.
#[test]
fn a_lower_wheel_takes_more_load_by_the_closed_form_of_hertz() {
    let planes = HalfPlanes::new(40);
    let length = 0.03;
    for (shares, lower) in [([0.5, 0.5], 2e-6), ([0.3, 0.7], 1.5e-6), ([0.6, 0.4], -1e-6)] {
        let lines =
            [0, 1].map(|k| SideLine { share: shares[k], lower: if k == 0 { lower } else { 0.0 }, friction: FRICTION });
        let shared: &dyn Fn(f64) -> f64 = &|x| 3e-11 * (1.0 - 20.0 * x * x);
        let found = planes.roll_lines(&lines, (length, shared), (NOMINAL, 0.0)).unwrap();
        let load = |k: usize| found[k].traction.resultant.height;
        assert!((shares[0] * load(0) + shares[1] * load(1) - NOMINAL).abs() < 1e-9 * NOMINAL);
        let apart = approach(load(0), length) - approach(load(1), length);
        common::figure("lines.height", &[apart / lower - 1.0]);
        println!("{shares:?}: {:.1} and {:.1} N/m, apart by {apart:e} m", load(0), load(1));
        assert!((apart / lower - 1.0).abs() < 2e-3, "{apart:e} for {lower:e}");
    }
}

/// Each line creeps by its own load and its own friction: its force is that of Carter, and forces of the other line
/// that stretch the surface of both alike change it by what they stretch.
#[test]
fn lines_of_different_load_and_friction_each_have_the_creep_force_of_carter() {
    let planes = HalfPlanes::new(40);
    let rigid: &dyn Fn(f64) -> f64 = &|_| 2e-11;
    let sides = [(0.4, 3e-6, 0.4), (0.6, 0.0, 0.2)];
    let lines = sides.map(|(share, lower, friction)| SideLine { share, lower, friction });
    for creepage in [2e-4, 8e-4, 4e-3, -1.2e-3] {
        let found = planes.roll_lines(&lines, (0.03, rigid), (NOMINAL, creepage)).unwrap();
        for (line, state) in lines.iter().zip(&found) {
            let (force, load) = (state.traction.resultant.travel, state.traction.resultant.height);
            let a = hertz_half_width(load, RADIUS, modulus());
            let full = carter_full_slip(line.friction, a, RADIUS);
            let carter = carter_force(creepage, full) * line.friction * load;
            common::figure("lines.carter", &[(force - carter) / (line.friction * load)]);
            println!("{creepage:e}: {force:.1} for {carter:.1} N/m under {load:.0} N/m");
            assert!((force - carter).abs() < 3e-3 * line.friction * load);
        }
    }
}

/// Smallest ratio of the loads of the first and the last line while a dent of the wheel under the first one passes, that
/// ratio at the end, and the largest and the last energy residual.
fn dent_passes(shares: &[f64], step: f64) -> ([f64; 2], [f64; 2]) {
    let mut config = preset("railway", 8);
    (config.thermal.enabled, config.tuning.max_step) = (false, step);
    let model = model(&config, shares).unwrap();
    let (mut workspace, inputs) = (Workspace::default(), Inputs::rolling(&config));
    let mut state = stationary::start(&model, &config.tuning, &inputs, &mut workspace).unwrap();
    let x: Vec<f64> = (-60..=60).map(|k| 1e-3 * f64::from(k)).collect();
    let value = x.iter().map(|x| 50e-6 * (0.5 * PI * x / 0.06).cos().powi(2)).collect();
    state.lines[0].flattening[0].indent(0.1, &Piecewise { x, value }, 5e-4);
    let (mut ratio, mut residual) = ([f64::INFINITY; 2], [0.0; 2]);
    for _ in 0..16 {
        let mut next = State::default();
        substeps::advance(&model, &config.tuning, &state, &inputs, 5e-4, &mut workspace, &mut next).unwrap();
        state = next;
        let load = |line: &Line| line.contact.traction.resultant.height;
        let now = load(&state.lines[0]) / state.lines.last().map_or(0.0, load);
        let missing = observe(&model, &state).energy_residual;
        (ratio, residual) = ([ratio[0].min(now), now], [f64::max(residual[0], missing.abs()), missing]);
    }
    println!("{shares:?}, {step:e} s: ratio of the loads {ratio:?}, residual {residual:?}");
    (ratio, residual)
}

/// While a dent passes under one of two lines, the other one takes over load, and the flexibility that each has for itself
/// stores energy and gives it back: what the balance misses in the end falls with the square of the step. On the way nodes follow
/// the load, by which the energy of lines differs from that of lines on nodes that stay, and comes back.
#[test]
fn energy_is_balanced_while_a_dent_passes_one_of_two_lines() {
    let [(coarse, missing), (fine, less)] = [1e-4, 2.5e-5].map(|step| dent_passes(&[0.4, 0.6], step));
    assert!(fine[0] < 0.6 && (coarse[0] / fine[0] - 1.0).abs() < 1e-3 && (fine[1] - 1.0).abs() < 1e-9);
    assert!(less[0] < 8e-4 && missing[1] / less[1].abs() > 8.0, "{missing:?} {less:?}");
}

#[test]
fn shares_that_are_no_parts_of_one_width_are_refused() {
    let mut config = preset("railway", 8);
    config.thermal.enabled = false;
    for shares in [&[0.5, 0.4][..], &[1.5, -0.5]] {
        let error = model(&config, shares).err().unwrap().to_string();
        assert!(error.contains("add up to 1"), "{error}");
    }
}
