//! Work of a step that its results do not show.

use super::*;
use crate::config::{ContactShape, presets};
use crate::rolling::outputs::{complete, observe_over};
use std::path::Path;

/// Linear problems of the contact that 200 steps of 0.1 ms solve.
fn solved(shape: ContactShape, profile: &str, moment: f64) -> u64 {
    let store = BasisStore::within(&Path::new(env!("CARGO_MANIFEST_DIR")).join("target"));
    let mut config = Config::default();
    (config.thermal.enabled, config.tuning.tolerance) = (false, 0.0);
    config.mesh.elements_per_half_width = 20;
    (config.contact.shape, config.rail.profile) = (shape, profile.to_owned());
    let model = Model::prepare(config, &store, &mut |_, _| {}).unwrap();
    let mut inputs = Inputs::rolling(model.config());
    let mut simulation = Simulation::new(model, &inputs).unwrap();
    inputs.drive.moment = moment;
    let counted = |simulation: &Simulation| simulation.model.shelf.lend(|tools| tools.workspace.contact.solved());
    let mut before = 0;
    for step in 0..220 {
        // The first steps follow the change of the moment.
        if step == 20 {
            before = counted(&simulation);
        }
        simulation.advance(&inputs, 1e-4).unwrap();
    }
    counted(&simulation) - before
}

#[test]
fn ordinary_steps_solve_one_or_two_linear_problems() {
    let rough = "roughness(spectrum = EN_ISO_3095)";
    let line = [("", 0.0, 220), ("", -7000.0, 300), (rough, 0.0, 300), (rough, -7000.0, 450)];
    let ellipse = [("", -7000.0, 300), (rough, -7000.0, 500)];
    let line = line.map(|case| (ContactShape::Line, case));
    for (shape, (profile, moment, most)) in line.into_iter().chain(ellipse.map(|case| (ContactShape::Ellipse, case))) {
        let solved = solved(shape, profile, moment);
        println!("{shape:?} {profile}, {moment} N m: {solved} linear problems in 200 steps");
        assert!((200..most).contains(&solved), "{shape:?} {profile}, {moment} N m: {solved}");
    }
}

/// Inputs that change with the time \[s].
type Course = fn(&mut Inputs, f64);

/// Linear problems of the contact and internal steps in each millisecond of a run at 5 m/s; the wheel was held `height` \[m]
/// above the rail before.
fn work(preset: &str, height: f64, (course, milliseconds): (Course, usize)) -> Vec<[u64; 2]> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let resources = root.join("resources");
    let store = BasisStore::within(&root.join("target")).with_packed(Some(&resources));
    let text = std::fs::read_to_string(resources.join(format!("{preset}.json"))).unwrap();
    let mut config = presets::parse(&text).unwrap();
    config.initial.velocity = 5.0;
    let model = Model::shared(config, &store, &mut |_, _| {}).unwrap();
    let mut inputs = Inputs::rolling(model.config());
    if height > 0.0 {
        (inputs.vertical, inputs.drive.displacement) = (Vertical::Displacement, height);
    }
    let mut simulation = Simulation::new(model, &inputs).unwrap();
    inputs.vertical = Vertical::Force;
    let advanced = |k: usize| {
        course(&mut inputs, 1e-3 * k as f64);
        simulation.advance(&inputs, 1e-3).unwrap_or_else(|error| panic!("{preset}, {k} ms: {error}"));
        let solved = simulation.model.shelf.lend(|tools| tools.workspace.contact.solved());
        (solved, simulation.outputs().internal_steps)
    };
    let counts: Vec<_> = (1..=milliseconds).map(advanced).collect();
    let before = std::iter::once(0).chain(counts.iter().map(|(solved, _)| *solved));
    counts.iter().zip(before).map(|((solved, steps), before)| [solved - before, *steps]).collect()
}

/// A millisecond of calm rolling takes one step and one linear problem, the first one besides those of the start. Steps of 16 µs resolve
/// a strike: milliseconds of flights and landings take far more than ten times that work. Bounded is the work of a step: no search stalls, and most steps take a single one. `most`: linear problems in a millisecond, and in a step
/// on average.
#[test]
fn flights_and_load_jumps_take_few_linear_problems_a_step() {
    let calm: Course = |_, _| {};
    let sine: Course = |inputs, t| inputs.drive.load = 1e5 * (1.0 + 0.4 * (std::f64::consts::TAU * 15.0 * t).sin());
    let jumps: Course =
        |inputs, t| inputs.drive.load = if ((200.0 * t - 0.1) as u64).is_multiple_of(2) { 0.0 } else { 2e5 };
    for preset in ["railway_ellipse", "railway_s1002_3mm"] {
        assert_eq!(work(preset, 0.0, (calm, 5))[1..], [[1, 1]; 4], "{preset}");
        for (name, height, course, most) in [
            ("load ±40 % at 15 Hz", 0.0, (sine, 30), [45, 2]),
            ("load 0 and 200 % in turns of 5 ms", 0.0, (jumps, 11), [350, 3]),
            ("drop from 0.3 mm", 3e-4, (calm, 11), [350, 3]),
            ("drop from 3 mm", 3e-3, (calm, 11), [350, 3]),
        ] {
            let counts = work(preset, height, course);
            let worst = counts.iter().map(|[solved, _]| *solved).max().unwrap_or(0);
            // The first one has the linear problems of the start, too.
            let [solved, steps] = [0, 1].map(|k| counts[1..].iter().map(|count| count[k]).sum::<u64>());
            let longest = counts.iter().map(|[_, steps]| *steps).max().unwrap_or(0);
            println!(
                "{preset}, {name}: {solved} linear problems in {steps} steps, in a millisecond {worst} and {longest}"
            );
            assert!(worst <= most[0] && solved <= most[1] * steps && longest <= 110, "{preset}, {name}: {counts:?}");
        }
    }
}

/// Names of the outputs whose value nobody gives: those that follow what the outputs were filled with before.
fn forgotten(model: &Model, state: &State) -> Vec<&'static str> {
    let [plain, marked] = [Outputs::default(), Outputs::marked()].map(|others| {
        let mut outputs = observe_over(&model.rolling, state, others);
        complete(&model.rolling, state, &mut outputs);
        outputs
    });
    let differ = |read: Read| match read {
        Read::Real(of) => of(&plain).to_bits() != of(&marked).to_bits(),
        Read::Count(of) => of(&plain) != of(&marked),
        Read::Flag(of) => of(&plain) != of(&marked),
        Read::Profile(of) | Read::Deferred(of) => of(&plain) != of(&marked) || of(&plain).is_empty(),
    };
    Outputs::ROWS.iter().filter(|row| differ(row.read)).map(|row| row.name).collect()
}

#[test]
fn every_output_is_given_a_value() {
    let store = BasisStore::within(&Path::new(env!("CARGO_MANIFEST_DIR")).join("target"));
    for shape in [ContactShape::Line, ContactShape::Ellipse] {
        let mut config = Config::default();
        config.contact.shape = shape;
        let model = Model::prepare(config, &store, &mut |_, _| {}).unwrap();
        let mut inputs = Inputs::rolling(model.config());
        let mut simulation = Simulation::new(Arc::clone(&model), &inputs).unwrap();
        inputs.drive.moment = -5000.0;
        (0..5).for_each(|_| simulation.advance(&inputs, 1e-3).unwrap());
        let forgotten = forgotten(&model, simulation.state());
        println!("{shape:?}: {} outputs, forgotten {forgotten:?}", Outputs::ROWS.len());
        assert!(forgotten.is_empty(), "give their values in `observe` or what it calls: {forgotten:?}");
    }
}

#[test]
fn marks_of_outputs_are_none_of_their_defaults() {
    let (plain, marked) = (Outputs::default(), Outputs::marked());
    let same = |read: Read| match read {
        Read::Real(of) => of(&plain) == of(&marked),
        Read::Count(of) => of(&plain) == of(&marked),
        Read::Flag(of) => of(&plain) == of(&marked),
        Read::Profile(of) | Read::Deferred(of) => of(&plain) == of(&marked),
    };
    assert!(Outputs::ROWS.iter().all(|row| !same(row.read)));
}

/// Where friction changes as in the step before, so do the nodes at which stick ends: the search begins with the states in which it ends.
#[test]
fn a_brake_that_grows_steadily_takes_one_linear_problem_in_most_steps() {
    let grows: Course = |inputs, t| inputs.drive.moment = -2e5 * t;
    let counts = work("railway_ellipse", 0.0, (grows, 40));
    let [solved, steps] = [0, 1].map(|k| counts[10..].iter().map(|count| count[k]).sum::<u64>());
    println!("{solved} linear problems in {steps} steps of a brake that grows");
    assert!(steps >= 30 && 10 * solved <= 14 * steps, "{counts:?}");
}
