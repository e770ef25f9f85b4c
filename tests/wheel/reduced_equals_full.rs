//! The reduced bodies against the full finite-element equations on the same mesh.

use crate::common::*;
use wheelrail::simulation::Simulation;

#[test]
fn reduced_and_full_response_agree_within_a_thousandth_of_the_load() {
    let mut config = preset("paper_d", 10);
    let reduced = model(config.clone());
    config.solver.reduced = false;
    let full = model(config);
    // Quasi-static rolling.
    for creepage in [0.0, -2e-4, 4e-4] {
        let inputs = prescribed(&reduced, 50.0 * KMH, creepage);
        let run = |model: &std::sync::Arc<_>| Simulation::new(std::sync::Arc::clone(model), &inputs).unwrap();
        let (a, b) = (run(&reduced), run(&full));
        let difference = (a.outputs().contact_force_x - b.outputs().contact_force_x).abs() / inputs.drive.load;
        figure("reduced.stationary", &[difference]);
        println!("stationary, xi = {creepage}: {difference:.2e} of the load");
        assert!(difference <= 1e-3);
    }
    // The 1 ms creepage ramp.
    let mut inputs = prescribed(&reduced, 50.0 * KMH, 0.0);
    let mut a = Simulation::new(reduced.clone(), &inputs).unwrap();
    let mut b = Simulation::new(full.clone(), &inputs).unwrap();
    let mut worst = 0.0f64;
    for k in 1..=50 {
        inputs.drive.omega = omega(&reduced, 50.0 * KMH, -8e-4 * (k as f64 / 35.0).min(1.0));
        a.advance(&inputs, 2e-5).unwrap();
        b.advance(&inputs, 2e-5).unwrap();
        let (a, b) = (a.outputs(), b.outputs());
        worst = worst.max((a.contact_force_x - b.contact_force_x).abs() / inputs.drive.load);
        worst = worst.max((a.contact_force_y - b.contact_force_y).abs() / inputs.drive.load);
    }
    figure("reduced.ramp", &[worst]);
    println!("1 ms ramp: largest difference {worst:.2e} of the load");
    assert!(worst <= 1e-3);
}
