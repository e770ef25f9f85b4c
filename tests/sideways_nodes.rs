//! Lateral creepage and spin on paired nodes of the surfaces: what profiles, wear, yielding and melting need, against
//! CONTACT.

mod half_spaces;

use half_spaces::{FRICTION, HalfSpaces, LOAD, Lines, SPEED, number, numbers};
use serde_json::Value as Json;
use wheelrail::contact::{Friction, RigidMotion, Spin};
use wheelrail::multistep::TimeDerivative;

/// Mean of the half axes of all patches of the reference \[m].
const MEAN_AXIS: f64 = 6e-3;

fn reference() -> Json {
    serde_json::from_str(include_str!("contact_reference/sideways.json")).unwrap()
}

/// Creepages along and across \[1] and spin [1/m].
type Slip = [f64; 3];

fn roll(spaces: &HalfSpaces, [xi, eta, phi]: Slip, time: TimeDerivative, start: &Lines) -> Lines {
    let [translation, rotation] = spaces.held(xi);
    let motion = [translation, rotation, RigidMotion::held(eta * SPEED, 0.0)];
    let spin = Spin { per_travel: phi, per_rotation: 0.0 };
    spaces.solve_sideways(LOAD, motion, spin, (time, Friction::constant(FRICTION)), start).unwrap()
}

fn steady(spaces: &HalfSpaces, slip: Slip) -> Lines {
    roll(spaces, slip, TimeDerivative::default(), &spaces.start())
}

/// Forces along and across and moment about the downward vertical, over friction times load, and times the mean half axis.
fn forces(spaces: &HalfSpaces, lines: &Lines) -> [f64; 3] {
    let most = FRICTION * LOAD;
    let sum =
        |of: &dyn Fn(&wheelrail::contact::Traction) -> f64| spaces.sum(LOAD, lines, |line| of(&line.traction)) / most;
    [sum(&|it| it.resultant.travel), sum(&|it| it.resultant.lateral), -sum(&|it| it.spin_moment) / MEAN_AXIS]
}

/// Largest errors of the forces of a kind of cases of a set of the reference.
fn errors(spaces: &HalfSpaces, set: &Json, kind: &str) -> [f64; 3] {
    let mut worst = [0.0_f64; 3];
    let kinds = set["kinds"].as_array().unwrap();
    for (case, _) in set["cases"].as_array().unwrap().iter().zip(kinds).filter(|(_, of)| *of == kind) {
        let case = numbers(case);
        let found = forces(spaces, &steady(spaces, [case[0], case[1], case[2]]));
        for k in 0..3 {
            worst[k] = worst[k].max((found[k] - case[3 + k]).abs());
        }
    }
    worst
}

/// The reference is too large by up to .007.
#[test]
fn steady_forces_on_nodes_under_creepage_and_spin_are_those_of_contact() {
    let (reference, mut missed) = (reference(), Vec::new());
    for set in reference["steady"].as_array().unwrap() {
        let aspect = number(&set["aspect"]);
        for nodes in [10, 20, 40] {
            let spaces = HalfSpaces::sideways_on_nodes(aspect, 7, nodes);
            for kind in ["xi", "eta", "phi", "mixed"] {
                let errors = errors(&spaces, set, kind);
                println!("{aspect:.1} {nodes} {kind}: {errors:.4?}");
                let spin = if aspect < 1.0 { 0.021 } else { 0.013 };
                let most = match kind {
                    "xi" => [0.006, 1e-3, 1e-3],
                    "eta" => [1e-3, 0.010, 0.006],
                    "phi" => [0.001, spin, spin],
                    _ => [0.025, 0.025, 0.018],
                };
                if nodes >= 20 && errors.iter().zip(most).any(|(error, most)| *error > most) {
                    missed.push((aspect, nodes, kind));
                }
            }
        }
    }
    assert!(missed.is_empty(), "{missed:?}");
}
