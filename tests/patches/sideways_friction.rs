//! Friction that falls with the slip along and across the elliptical patch on lines side by side: against CONTACT along, and across by symmetry.

use crate::common;
use crate::half_spaces::{HalfSpaces, LOAD, SPEED, number, numbers, reference};
use std::f64::consts::{FRAC_PI_2, LN_2};
use wheelrail::contact::{ContactState, Drift, Friction, FrictionLaw, Heating, RigidMotion, SlipDependence};
use wheelrail::multistep::TimeDerivative;

/// Law of the reference, and its coefficient at rest \[1].
fn falling() -> (Friction, f64) {
    let case = &reference()["falling"];
    let [kinetic, rest, half] = ["mu_kin", "mu_1", "s_half"].map(|name| number(&case[name]));
    let slip = SlipDependence::Exponential { remaining: kinetic / (kinetic + rest), decay: LN_2 / half };
    let law = FrictionLaw { slip, ..FrictionLaw::CONSTANT };
    (Friction::local(law, kinetic + rest, Heating::default(), 0.0), kinetic + rest)
}

/// Forces along and across of steady rolling with creepages along and across, over friction at rest.
fn forces(spaces: &HalfSpaces, [xi, eta]: [f64; 2]) -> [f64; 2] {
    let (friction, most) = falling();
    let [translation, rotation] = spaces.held(xi);
    let motion = [translation, rotation, RigidMotion::held(eta * SPEED, 0.0)];
    let laws = (TimeDerivative::default(), friction);
    let lines = spaces.solve_sideways(LOAD, motion, Drift::default(), laws, &spaces.start()).unwrap();
    let sum = |of: fn(&ContactState) -> f64| spaces.sum(LOAD, &lines, of) / (most * LOAD);
    [sum(|line| line.traction.resultant.travel), sum(|line| line.traction.resultant.lateral)]
}

/// Every line has the coefficient of its own mean slip, every element of CONTACT that of its own.
#[test]
fn creep_forces_along_are_those_of_contact_where_lines_take_lateral_forces() {
    let reference = reference();
    let case = &reference["falling"];
    for nodes in [10, 20] {
        let spaces = HalfSpaces::sideways_on_nodes(1.0, 7, nodes);
        let errors: Vec<_> = numbers(&case["xi"])
            .into_iter()
            .zip(numbers(&case["Fx"]))
            .map(|(xi, force)| forces(&spaces, [xi, 0.0])[0] - force)
            .collect();
        common::figure(
            &format!("sideways.falling.{nodes}"),
            &[errors.iter().fold(0.0, |most: f64, error| most.max(error.abs()))],
        );
        println!("{nodes} nodes: {errors:+.4?}");
        assert!(errors.iter().all(|error| error.abs() < 0.018), "{nodes} nodes");
    }
}

/// On a circle of steel without Poisson's ratio only the lines know which way is along.
#[test]
fn without_poissons_ratio_a_creepage_across_a_circle_has_the_force_of_one_along() {
    let reference = reference();
    for xi in numbers(&reference["falling"]["xi"]) {
        for lines in [7, 13] {
            let spaces = HalfSpaces::isotropic(lines);
            let along = forces(&spaces, [xi, 0.0])[0];
            let turned = [0.25, 0.5, 0.75, 1.0].map(|quarter: f64| {
                let (sin, cos) = (quarter * FRAC_PI_2).sin_cos();
                let [x, z] = forces(&spaces, [xi * cos, xi * sin]);
                [x * cos + z * sin - along, z * cos - x * sin]
            });
            turned.as_flattened().iter().for_each(|difference| common::figure("sideways.isotropic", &[*difference]));
            println!("{xi} {lines}: {along:.4}, {turned:+.4?}");
            assert!(turned.as_flattened().iter().all(|difference| difference.abs() < 5e-4));
        }
    }
}
