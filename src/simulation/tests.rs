//! Work of a step that its results do not show.

use super::*;
use crate::config::{ContactMethod, ContactShape};
use crate::rolling::outputs::{complete, observe_over};
use std::path::Path;

/// Linear problems of the contact that 200 steps of 0.1 ms solve by alternation or line by line, and all equations
/// together.
fn solved(shape: ContactShape, profile: &str, moment: f64) -> [u64; 2] {
    let store = BasisStore::within(&Path::new(env!("CARGO_MANIFEST_DIR")).join("target"));
    let mut config = Config::default();
    (config.thermal.enabled, config.tuning.tolerance) = (false, 0.0);
    (config.solver.contact, config.mesh.elements_per_half_width) = (ContactMethod::Grid, 20);
    (config.contact.shape, config.rail.profile) = (shape, profile.to_owned());
    let model = Model::prepare(config, &store, &mut |_, _| {}).unwrap();
    let mut inputs = Inputs::rolling(model.config());
    let mut simulation = Simulation::new(model, &inputs).unwrap();
    inputs.drive.moment = moment;
    let counted =
        |simulation: &Simulation| simulation.model.shelf.lend(|tools| tools.workspace.contact.active_set.solved());
    let mut before = [0; 2];
    for step in 0..220 {
        // The first steps follow the change of the moment.
        if step == 20 {
            before = counted(&simulation);
        }
        simulation.advance(&inputs, 1e-4).unwrap();
    }
    let after = counted(&simulation);
    [after[0] - before[0], after[1] - before[1]]
}

#[test]
fn ordinary_steps_are_solved_by_alternation() {
    let rough = "roughness(spectrum = EN_ISO_3095)";
    for (profile, moment, most) in [("", 0.0, 220), ("", -7000.0, 300), (rough, 0.0, 300), (rough, -7000.0, 450)] {
        let [alternated, together] = solved(ContactShape::Line, profile, moment);
        println!("{profile}, {moment} N m: {alternated} by alternation, {together} together");
        assert!(
            together == 0 && (200..most).contains(&alternated),
            "{profile}, {moment} N m: {alternated}, {together}"
        );
    }
}

#[test]
fn ordinary_steps_of_an_ellipse_are_solved_line_by_line() {
    for (profile, most) in [("", 300), ("roughness(spectrum = EN_ISO_3095)", 500)] {
        let [one_by_one, together] = solved(ContactShape::Ellipse, profile, -7000.0);
        println!("{profile}: {one_by_one} line by line, {together} together");
        assert!(together == 0 && (200..most).contains(&one_by_one), "{profile}: {one_by_one}, {together}");
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
