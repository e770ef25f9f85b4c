//! Probability density of the force on a rough rail, Paper A, figures 8 to 10: trends on a seeded spectrum of our own,
//! since the measured one is not published.

use crate::common::{self, KMH, model, prescribed, preset};
use std::sync::Arc;
use wheelrail::simulation::{Model, Simulation};

/// 3.9 µm root mean square with peaks at 8 and 5 cm, as the paper describes its spectrum.
const ROUGH: &str =
    "roughness(levels = [0, 2, 7, 2, 7, 0], longest = 0.125, seed = 3, length = 40, from = 0.1, blend = 0.2)";
/// Shortest wave \[m], way that is analysed and way before it \[m].
const SHORTEST: f64 = 0.035;
const WAYS: [f64; 2] = [8.3, 0.6];

/// The wheel of Paper A with a mass on its hub [kg].
fn paper(mass: f64) -> Arc<Model> {
    let mut config = preset("paper_a", 5);
    (config.thermal.enabled, config.tuning.tolerance) = (false, 0.0);
    // The damping ratio of the paper's bounce: 1e-4 s times half of 2922 rad/s, here in a damper of the hub.
    config.vehicle.damping = 1e-4 * 5265.0 * 2922.0 * 2922.0;
    config.rail.profile = ROUGH.into();
    config.wheel.hub_mass = mass;
    model(config)
}

/// Sorted forces [MN] under a load [MN].
fn forces(model: &Arc<Model>, speed: f64, load: f64) -> Vec<f64> {
    let mut inputs = prescribed(model, speed * KMH, 0.0);
    (inputs.drive.friction, inputs.drive.load) = (0.0, 1e6 * load);
    let mut simulation = Simulation::new(model.clone(), &inputs).unwrap();
    let step = SHORTEST / 16.0 / (speed * KMH);
    let mut found = Vec::new();
    while simulation.outputs().wheel_distance < WAYS[0] + WAYS[1] {
        simulation.advance(&inputs, step).unwrap();
        if simulation.outputs().wheel_distance > WAYS[1] {
            found.push(1e-6 * simulation.outputs().contact_force_y);
        }
    }
    found.sort_by(f64::total_cmp);
    found
}

fn mean(forces: &[f64]) -> f64 {
    forces.iter().sum::<f64>() / forces.len() as f64
}

fn deviation(forces: &[f64]) -> f64 {
    let mean = mean(forces);
    (forces.iter().map(|f| (f - mean).powi(2)).sum::<f64>() / forces.len() as f64).sqrt()
}

/// Between the fifth and the ninety-fifth hundredth [MN].
fn width(forces: &[f64]) -> f64 {
    forces[forces.len() * 95 / 100] - forces[forces.len() * 5 / 100]
}

#[test]
fn the_density_of_the_force_widens_with_speed_and_unsprung_mass_and_moves_with_the_load() {
    let (bare, heavy) = (paper(0.0), paper(1000.0));
    let by_speed = [25.0, 50.0, 75.0, 100.0].map(|speed| forces(&bare, speed, 4.7));
    let by_load = [3.7, 5.7].map(|load| forces(&bare, 75.0, load));
    let more = forces(&heavy, 75.0, 4.7);
    let told = |forces: &Vec<f64>| [mean(forces), deviation(forces), width(forces)];
    common::figure_within(0.02, "rough.deviation [MN]", &by_speed.each_ref().map(|forces| deviation(forces)));
    common::figure_within(0.02, "rough.heavy [MN]", &[deviation(&more)]);
    common::figure_within(0.02, "rough.loads.mean [MN]", &by_load.each_ref().map(|forces| mean(forces)));
    common::figure_within(0.02, "rough.loads.deviation [MN]", &by_load.each_ref().map(|forces| deviation(forces)));
    println!("25 to 100 km/h: mean, deviation, 5 to 95 % [MN] {:.4?}", by_speed.each_ref().map(told));
    println!("3.7, 5.7 MN: {:.4?}; 1 t on the hub {:.4?}", by_load.each_ref().map(told), told(&more));
    for pair in by_speed.windows(2) {
        assert!(deviation(&pair[1]) > 1.1 * deviation(&pair[0]) && width(&pair[1]) > 1.1 * width(&pair[0]));
    }
    for (forces, load) in by_load.iter().zip([3.7, 5.7]) {
        assert!((mean(forces) - load).abs() < 0.02 && (deviation(forces) / deviation(&by_speed[2]) - 1.0).abs() < 0.25);
    }
    assert!(deviation(&more) > 1.05 * deviation(&by_speed[2]) && width(&more) > 1.05 * width(&by_speed[2]));
}
