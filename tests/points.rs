//! Slip in both directions, at the leading edge and in several stretches on a single smooth patch.

mod common;
use common::random::Random;
use common::*;
use std::sync::Arc;
use wheelrail::config::ContactMethod;
use wheelrail::simulation::{Inputs, Model, Simulation};

const SPEED: f64 = 27.0;

fn railway(method: ContactMethod, preset: &str, tolerance: f64) -> Arc<Model> {
    solved_by(method, preset, |config| {
        config.tuning.tolerance = tolerance;
        config.thermal.enabled = false;
        config.physics.yielding = false;
        config.initial.velocity = SPEED;
    })
}

/// `F/μP` after steps with creepages that jump, each of a length of its own.
fn jumps(model: &Arc<Model>, steps: &[(f64, f64)]) -> Vec<f64> {
    let mut inputs = prescribed(model, SPEED, 0.0);
    let mut simulation = Simulation::new(model.clone(), &inputs).unwrap();
    let mut forces = Vec::new();
    for (dt, creepage) in steps {
        inputs.drive.omega = omega(model, SPEED, *creepage);
        simulation.advance(&inputs, *dt).unwrap();
        forces.push(signed_utilisation(&simulation, inputs.drive.friction));
    }
    forces
}

#[test]
fn forces_after_jumps_of_the_creepage_are_those_of_the_grid() {
    let mut random = Random(7);
    let step = |random: &mut Random| (random.logarithmic(1e-4, 1e-3), random.between(-4e-3, 4e-3));
    let steps: Vec<_> = (0..150).map(|_| step(&mut random)).collect();
    // Steps are whole: what divides them is as good as random where the creepage jumps.
    let [patch, grid] = [ContactMethod::Patch, ContactMethod::Grid].map(|method| railway(method, "railway", 0.0));
    let (ours, theirs) = (jumps(&patch, &steps), jumps(&grid, &steps));
    let errors: Vec<f64> = ours.iter().zip(&theirs).map(|(a, b)| (a - b).abs()).collect();
    let worst = errors.iter().fold(0.0_f64, |worst, error| worst.max(*error));
    let rms = (errors.iter().map(|e| e * e).sum::<f64>() / errors.len() as f64).sqrt();
    figure("points.jumps", &[worst, rms]);
    println!("from the grid at most {worst:.1e} of friction, rms {rms:.1e}");
    assert!(worst < 1e-3 && rms < 3e-4);
}

#[test]
fn moments_that_jump_on_lines_side_by_side_are_solved_within_friction_and_their_energy_is_accounted_for() {
    for preset in ["railway", "railway_ellipse"] {
        let model = railway(ContactMethod::Auto, preset, 2e-3);
        let mut random = Random(11);
        let mut inputs = Inputs::rolling(model.config());
        let mut simulation = Simulation::new(model.clone(), &inputs).unwrap();
        let (mut worst, mut on_grid) = (0.0_f64, 0);
        for _ in 0..120 {
            inputs.drive.moment = random.between(-14e3, 14e3);
            for _ in 0..5 {
                simulation.advance(&inputs, 1e-3).unwrap();
                let outputs = simulation.outputs();
                assert!(outputs.contact_utilisation <= 1.0 + 1e-9);
                worst = worst.max(outputs.energy_residual.abs());
                on_grid += usize::from(!is_patch(&simulation));
            }
        }
        println!("{preset}: energy missing {worst:.1e}, {on_grid} of 600 steps on the grid");
        assert!(worst < 3e-2 && on_grid < 60);
    }
}
