//! Order of convergence in the time step of the coupled run: mechanics, friction and heat.

use crate::common::{self, model, preset};
use std::sync::Arc;
use wheelrail::config::StartTemperature;
use wheelrail::simulation::{Inputs, Model, Outputs, Simulation};

/// Outputs 10 ms after the start of a smooth rise of the braking moment to 60 % of what adhesion carries, from a wheel
/// that is 20 K warmer than the rail; the friction softens with the temperature.
fn braked(model: &Arc<Model>, steps: usize) -> Outputs {
    const DURATION: f64 = 1e-2;
    let config = model.config();
    let peak = 0.6 * config.friction.coefficient * config.model.nominal_load * config.wheel.radius;
    let mut inputs = Inputs::rolling(config);
    let mut simulation = Simulation::new(model.clone(), &inputs).unwrap();
    let step = DURATION / steps as f64;
    for k in 0..steps {
        let moment = |k: usize| -peak * (0.5 * std::f64::consts::PI * k as f64 / steps as f64).sin().powi(2);
        inputs.drive.moment = moment(k);
        inputs.rate.moment = (moment(k + 1) - moment(k)) / step;
        simulation.advance(&inputs, step).unwrap();
    }
    simulation.outputs().clone()
}

/// Errors of the peripheral velocity [m/s] with 50, 100, 200 and 400 steps against 6400, and the largest of the contact
/// force relative to the load.
fn errors(heat: bool) -> ([f64; 4], f64) {
    let mut config = preset("railway", 8);
    (config.solver.modes_wheel, config.solver.modes_rail) = (20, 10);
    config.thermal.wheel_excess = 20.0;
    config.thermal.enabled = heat;
    // A uniform start has a transient that begins with the square root of the time, of which no step has the second
    // order.
    config.initial.temperature = StartTemperature::Stationary;
    config.tuning.tolerance = 0.0;
    let model = model(config);
    let exact = braked(&model, 6400);
    let seen = [50, 100, 200, 400].map(|steps| braked(&model, steps));
    let radius = model.config().wheel.radius;
    let force = |o: &Outputs| (o.contact_force_x - exact.contact_force_x).abs() / exact.contact_force_y;
    let speed = seen.each_ref().map(|o| radius * (o.wheel_omega - exact.wheel_omega).abs());
    println!("with heat {heat}: speed errors {speed:?} m/s, force errors {:?} P", seen.each_ref().map(force));
    (speed, seen.iter().map(force).fold(0.0, f64::max))
}

/// Heat and mechanics are solved one after the other in a step, friction and swelling with predicted temperatures; on
/// the motion this leaves no error of first order. The contact force itself does not show the order: as the wheel rolls
/// less than the patch, then less than a cell, in a step, the error of the mesh changes by some 1e-4 of the load.
#[test]
fn braked_motion_converges_with_second_order_in_the_step_with_and_without_heat() {
    for heat in [false, true] {
        let (speed, force) = errors(heat);
        let orders = [0, 1, 2].map(|k| (speed[k] / speed[k + 1]).log2());
        common::figure_within(0.05, if heat { "order.with.heat" } else { "order.cold" }, &orders);
        println!("observed orders {orders:.2?}");
        // With heat the errors of mechanics and exchange cancel in part, at one step more than at another.
        let mean = orders.iter().sum::<f64>() / 3.0;
        assert!(mean > 1.8 && orders.iter().all(|order| *order > 1.0), "heat {heat}: {orders:?}");
        assert!(heat || orders.iter().all(|order| *order > 1.7), "{orders:?}");
        assert!(force < 1e-3, "heat {heat}: {force}");
    }
}
