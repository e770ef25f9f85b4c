//! Work of a step that its results do not show.

use super::*;
use crate::config::{ContactMethod, ContactShape};
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
    let (mut tools, mut before) = (Box::<Tools>::default(), [0; 2]);
    for step in 0..220 {
        // The first steps follow the change of the moment.
        if step == 20 {
            before = tools.workspace.contact.active_set.solved();
        }
        simulation.advance_with(&inputs, 1e-4, &mut tools).unwrap();
    }
    let after = tools.workspace.contact.active_set.solved();
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
    for profile in ["", "roughness(spectrum = EN_ISO_3095)"] {
        let [one_by_one, together] = solved(ContactShape::Ellipse, profile, -7000.0);
        println!("{profile}: {one_by_one} line by line, {together} together");
        assert!(together == 0 && (200..700).contains(&one_by_one), "{profile}: {one_by_one}, {together}");
    }
}
