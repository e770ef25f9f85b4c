//! Contact lines side by side: halves of a line are the line, and lines that differ share load and friction by closed
//! forms.

mod common;
mod half_planes;

use common::{KMH, preset};
use half_planes::{FRICTION, HalfPlanes, NOMINAL, RADIUS, SideLine, modulus};
use std::f64::consts::PI;
use wheelrail::analytic::{carter_force, carter_full_slip, hertz_half_width};
use wheelrail::config::{Config, ContactMethod};
use wheelrail::contact::ContactState;
use wheelrail::mechanics::{Basis, bodies};
use wheelrail::rolling::outputs::observe;
use wheelrail::rolling::{Inputs, Model, ModelError, Rotation, State, Translation, Workspace, stationary, substeps};
use wheelrail::simulation::Outputs;
use wheelrail::surface::Surfaces;

/// Distance at which a force of a line no longer displaces it by more than forces of other lines do [m].
const REACH: f64 = 0.025;

/// Inputs of a run over its time [s].
type Course = fn(&mut Inputs, f64);

/// The model of a configuration, with lines of given shares side by side.
fn model(config: &Config, shares: &[f64]) -> Result<Model, ModelError> {
    let found = common::store().find(config).unwrap();
    let basis = found.map_or_else(|| Basis::compute(config, &mut |_, _| {}).unwrap(), |(basis, _)| basis);
    let pair = bodies(config, Some(basis), &mut |_, _| {}).unwrap();
    let model = Model::new(config.clone(), pair, Surfaces::from_config(config, None).unwrap())?;
    if shares.len() == 1 { Ok(model) } else { model.with_lines(shares.to_vec(), REACH) }
}

/// Outputs of the start and after every one of `steps` steps of `dt` seconds, and the last state.
fn run(model: &Model, inputs: &Inputs, course: Course, (dt, steps): (f64, usize)) -> (Vec<Outputs>, State) {
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

/// Largest difference of two runs in every real output and profile, over the largest amount of that output.
fn difference(a: &[Outputs], b: &[Outputs]) -> (f64, &'static str) {
    use wheelrail::rolling::{OutputRow, Read};
    let values = |row: &OutputRow, outputs: &Outputs| match row.read {
        Read::Real(read) => vec![read(outputs)],
        Read::Profile(read) => read(outputs).to_vec(),
        Read::Count(read) => vec![read(outputs) as f64],
        Read::Flag(read) => vec![f64::from(u8::from(read(outputs)))],
    };
    let mut worst = (0.0, "");
    for row in Outputs::ROWS.iter().filter(|row| !UNCOMPARED.contains(&row.name)) {
        let pairs = || a.iter().zip(b).flat_map(|(a, b)| values(row, a).into_iter().zip(values(row, b)));
        let scale = pairs().map(|(a, b)| a.abs().max(b.abs())).fold(row.nominal * 1e-6, f64::max);
        let apart = pairs().map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / scale;
        if apart > worst.0 {
            worst = (apart, row.name);
        }
    }
    worst
}

/// Outputs that count the work of the solver, and the residuals, which are differences of round-off themselves.
const UNCOMPARED: [&str; 4] = ["solver.iterations", "solver.energy_residual", "heat.residual", "solver.internal_steps"];

/// Runs one line and lines of the given shares, and compares them.
fn compare(name: &str, config: &Config, inputs: &Inputs, course: Course, steps: (f64, usize)) -> f64 {
    let mut worst = 0.0;
    let (one, _) = run(&model(config, &[1.0]).unwrap(), inputs, course, steps);
    for shares in [&[0.5, 0.5][..], &[0.2, 0.5, 0.3]] {
        let (several, state) = run(&model(config, shares).unwrap(), inputs, course, steps);
        assert_eq!(state.lines.len(), shares.len());
        let (apart, output) = difference(&one, &several);
        println!("{name:<18} {shares:?}: {apart:.1e} in {output}");
        worst = f64::max(worst, apart);
    }
    worst
}

fn small(name: &str) -> Config {
    let mut config = preset(name, 8);
    config.solver.contact = ContactMethod::Grid;
    config
}

fn braking(config: &Config) -> Inputs {
    let mut inputs = Inputs::rolling(config);
    inputs.drive.moment = -4000.0;
    inputs
}

fn vary(inputs: &mut Inputs, t: f64) {
    inputs.drive.moment = -4000.0 - 2000.0 * (300.0 * t).sin();
    inputs.drive.load *= 1.0 + 0.01 * (400.0 * t).sin();
}

#[test]
fn lines_of_a_part_of_the_width_and_equal_load_are_one_line_while_moment_and_load_vary() {
    let config = small("railway");
    let apart = compare("braking", &config, &braking(&config), vary, (1e-3, 30));
    assert!(apart < 1e-9, "{apart:e}");
}
