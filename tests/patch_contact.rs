//! The contact on a single smooth patch, `solver.contact = patch` and `auto`, against Hertz, Carter, the converged reference and
//! the contact on the grid.

mod common;
use common::*;
use std::sync::Arc;
use wheelrail::config::{Config, ContactMethod};
use wheelrail::simulation::{Model, Simulation};

/// A preset without heat, on the contact solver asked for.
fn solved_by(contact: ContactMethod, name: &str, change: impl Fn(&mut Config)) -> Arc<Model> {
    let mut config = preset(name, 20);
    config.thermal.enabled = false;
    config.solver.contact = contact;
    change(&mut config);
    model(config)
}

fn paper_d(contact: ContactMethod) -> Arc<Model> {
    solved_by(contact, "paper_d", |config| config.physics.centrifugal = false)
}

/// Creepage ramp from 0 to −8e-4 in 70 % of `duration`, held to its end: `F/μP` at tenths of the duration.
fn creepage_ramp(model: &Arc<Model>, duration: f64, steps: usize) -> Vec<f64> {
    let velocity = 50.0 * KMH;
    let mut inputs = prescribed(model, velocity, 0.0);
    let mut simulation = Simulation::new(model.clone(), &inputs).unwrap();
    let mut tenths = Vec::new();
    for k in 1..=steps {
        let share = k as f64 / steps as f64;
        inputs.drive.omega = omega(model, velocity, -8e-4 * (share / 0.7).min(1.0));
        if let Err(error) = simulation.advance(&inputs, duration / steps as f64) {
            println!("step {k}: {error}");
            break;
        }
        if k % (steps / 10) == 0 {
            tenths.push(signed_utilisation(&simulation, inputs.drive.friction));
        }
    }
    tenths
}

#[test]
fn explore() {
    let [patch, grid] = [ContactMethod::Patch, ContactMethod::Grid].map(paper_d);
    for xi in [0.0, -1e-4, -3e-4, -5e-4, -8e-4, 1e-4, 4e-4, 8e-4] {
        let at = |model: &Arc<Model>| {
            let inputs = prescribed(model, 50.0 * KMH, xi);
            match Simulation::new(model.clone(), &inputs) {
                Ok(simulation) => {
                    let o = simulation.outputs();
                    format!("{:.6} a {:.5e} p {:.5e} stick {:.4} U {:.6e} M {:.4} Q {:.4}", signed_utilisation(&simulation, 0.4), o.contact_half_width, o.contact_pressure_max, o.contact_stick_fraction, o.contact_approach, o.hub_moment, o.friction_power)
                }
                Err(error) => error.to_string(),
            }
        };
        println!("{xi:e}:\n   patch {}\n   grid  {}", at(&patch), at(&grid));
    }
    for duration in [1e-3] {
        println!("{duration}\n   {:.4?}\n   {:.4?}", creepage_ramp(&patch, duration, 400), creepage_ramp(&grid, duration, 400));
    }
}

#[test]
fn explore_moment() {
    for method in [ContactMethod::Patch, ContactMethod::Grid] {
        let model = solved_by(method, "railway", |_| {});
        let mut inputs = wheelrail::simulation::Inputs::rolling(model.config());
        let mut simulation = match Simulation::new(model.clone(), &inputs) {
            Ok(simulation) => simulation,
            Err(error) => {
                println!("{error}");
                continue;
            }
        };
        inputs.drive.moment = -7000.0;
        for k in 0..200 {
            if let Err(error) = simulation.advance(&inputs, 1e-3) {
                println!("{k} {error}");
                break;
            }
            if k % 20 == 0 || k < 5 {
                let o = simulation.outputs();
                println!("{k} {:.6} {:.6} v {:.8} w {:.8} res {:.2e} int {} fric {:.6} stick {:.4}", signed_utilisation(&simulation, 0.3), o.contact_force_y, o.wheel_velocity, o.wheel_omega, o.energy_residual, o.internal_steps, o.friction_power, o.contact_stick_fraction);
            }
        }
        let begin = std::time::Instant::now();
        for _ in 0..2000 {
            if simulation.advance(&inputs, 1e-3).is_err() { break }
        }
        println!("{method:?}: {:.1} us a step", begin.elapsed().as_secs_f64() / 2000.0 * 1e6);
    }
}
