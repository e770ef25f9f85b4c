//! The force where the contact goes from the series to the grid and back while the wheel rolls: it moves from the one
//! solution to the other, whose distance is the error of the grid, and by nothing beyond.

mod common;

use common::*;
use std::sync::Arc;
use wheelrail::config::ContactMethod;
use wheelrail::simulation::{Model, Simulation};

const SPEED: f64 = 27.0;
const CREEPAGE: f64 = -1.5e-3;
/// Communication step \[s]: the material passes the patch twice in it.
const STEP: f64 = 1e-3;
/// Steps before the wheel is unloaded for two of them, and all steps.
const STEPS: [usize; 2] = [60, 220];

fn rolling(method: ContactMethod, elements: usize) -> Arc<Model> {
    solved_by(method, "railway", |config| {
        config.tuning.tolerance = 0.0;
        config.mesh.elements_per_half_width = elements;
        config.mesh.grid_elements_per_half_width = elements;
    })
}

/// Force over the load after every step of a wheel at constant creepage that is unloaded so fast that its patch slips at
/// the leading edge, and whether it is found on a patch.
fn run(method: ContactMethod, elements: usize) -> Vec<(f64, bool)> {
    let model = rolling(method, elements);
    let mut inputs = prescribed(&model, SPEED, CREEPAGE);
    let load = inputs.drive.load;
    let mut simulation = Simulation::new(model, &inputs).unwrap();
    let mut step = |k: usize| {
        inputs.drive.load = if (STEPS[0]..STEPS[0] + 2).contains(&k) { 0.0 } else { load };
        simulation.advance(&inputs, STEP).unwrap();
        (simulation.outputs().contact_force_x / load, is_patch(&simulation))
    };
    (0..STEPS[1]).map(&mut step).collect()
}

/// Distance of both solutions before the change.
fn changes_by_the_error_of_the_grid(elements: usize) -> f64 {
    let [auto, grid] = [ContactMethod::Auto, ContactMethod::Grid].map(|method| run(method, elements));
    let apart: Vec<f64> = auto.iter().zip(&grid).map(|(a, b)| a.0 - b.0).collect();
    let changes: Vec<usize> = (1..auto.len()).filter(|&k| auto[k].1 != auto[k - 1].1).collect();
    let [_, back] = changes[..] else { panic!("to the grid and back: {changes:?}") };
    let (error, end) = (apart[STEPS[0] - 1], apart[STEPS[1] - 1]);
    let left = apart[back - 3..back].iter().fold(0.0_f64, |most, apart| most.max(apart.abs()));
    let steps = (back..auto.len()).map(|k| (apart[k] - apart[k - 1]).abs());
    let largest = steps.fold(0.0_f64, f64::max);
    figure(&format!("solver.apart.{elements}"), &[error, largest]);
    println!(
        "{elements} elements: {error:.1e} apart, {left:.1e} on the grid, {end:.1e} later; {largest:.1e} in a step"
    );
    assert!(left < 0.01 * error.abs(), "on the grid it is forgotten that the solution came from the series");
    assert!((end / error - 1.0).abs() < 0.1, "the series find their solution again");
    assert!(largest < 0.5 * error.abs() && largest < 1e-4, "the torsion of the wheel takes some steps for it");
    error.abs()
}

#[test]
fn a_change_of_solver_moves_the_force_by_the_error_of_the_grid() {
    let [coarse, fine] = [10, 20].map(changes_by_the_error_of_the_grid);
    assert!(fine < 0.35 * coarse && fine < 1.5e-4, "{coarse} and {fine} of the load");
}
