//! Order of convergence in the time step of the coupled run: mechanics, friction and heat.

mod common;

use common::{model, preset};
use std::sync::Arc;
use wheelrail::simulation::{Inputs, Model, Outputs, Simulation};

/// Outputs 10 ms after the start of a smooth rise of the braking moment to 60 % of what adhesion carries.
fn braked(model: &Arc<Model>, steps: usize) -> Outputs {
    const DURATION: f64 = 1e-2;
    let config = model.config();
    let peak = 0.6 * config.friction.coefficient * config.model.nominal_load * config.wheel.radius;
    let mut inputs = Inputs::rolling(config);
    let mut simulation = Simulation::new(model.clone(), &inputs).unwrap();
    for k in 1..=steps {
        let share = k as f64 / steps as f64;
        inputs.drive.moment = -peak * (0.5 * std::f64::consts::PI * share).sin().powi(2);
        simulation.advance(&inputs, DURATION / steps as f64).unwrap();
    }
    simulation.outputs().clone()
}

#[test]
fn order() {
    let mut config = preset("railway", 8);
    (config.solver.modes_wheel, config.solver.modes_rail) = (20, 10);
    config.thermal.wheel_excess = 20.0;
    config.friction.coefficient = 0.3;
    for heat in [true, false] {
        config.thermal.enabled = heat;
        let model = model(config.clone());
        let exact = braked(&model, 6400);
        for n in [50, 100, 200, 400, 800] {
            let o = braked(&model, n);
            println!(
                "heat {heat} n {n}: force {:.3e} omega {:.3e} T {:.3e} power {:.3e}",
                (o.contact_force_x - exact.contact_force_x) / 1e5,
                o.wheel_omega - exact.wheel_omega,
                o.temperature_wheel_max - exact.temperature_wheel_max,
                o.friction_power / exact.friction_power - 1.0
            );
        }
    }
}
