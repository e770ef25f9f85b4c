//! Stationary rolling against Hertz, Carter and independently computed reference values.

use crate::common::*;
use std::f64::consts::PI;
use std::sync::Arc;
use wheelrail::analytic::{carter_force, carter_full_slip, contact_modulus, hertz_half_width, hertz_peak_pressure};
use wheelrail::config::Config;
use wheelrail::simulation::{Inputs, Model, Simulation};

/// The reference values are computed without centrifugal load.
fn without_centrifugal(name: &str, n: usize) -> Config {
    let mut config = preset(name, n);
    config.physics.centrifugal = false;
    config
}

fn modulus(config: &Config) -> f64 {
    contact_modulus(config.material.youngs_modulus, config.material.poissons_ratio)
}

/// Relative errors of half-width and peak pressure against Hertz, worst over a sweep of the load that moves the
/// contact edges through a cell.
fn hertz_errors(n: usize) -> (f64, f64) {
    let model = model(without_centrifugal("paper_d", n));
    let config = model.config();
    let mut worst = (0.0f64, 0.0f64);
    for k in 0..9 {
        let mut inputs = prescribed(&model, 50.0 * KMH, 0.0);
        inputs.drive.load = config.model.nominal_load * (1.0 + 0.02 * k as f64 / n as f64 * 5.0);
        inputs.drive.friction = 0.0;
        let line_load = inputs.drive.load / config.model.contact_width;
        let a = hertz_half_width(line_load, config.wheel.radius, modulus(config));
        let p0 = hertz_peak_pressure(line_load, a);
        let simulation = Simulation::new(model.clone(), &inputs).unwrap();
        let outputs = simulation.outputs();
        worst.0 = worst.0.max((outputs.contact_half_width / a - 1.0).abs());
        worst.1 = worst.1.max((outputs.contact_pressure_max / p0 - 1.0).abs());
    }
    worst
}

#[test]
fn hertz_half_width_within_two_per_mille_on_every_mesh_and_pressure_of_second_order() {
    let [coarse, middle, fine] = [5, 10, 20].map(hertz_errors);
    figure("hertz.20", &[fine.0, fine.1]);
    figure("hertz.10", &[middle.0, middle.1]);
    figure("hertz.5", &[coarse.0, coarse.1]);
    println!("half-width error {:.2e} {:.2e} {:.2e}", coarse.0, middle.0, fine.0);
    println!("peak pressure error {:.2e} {:.2e} {:.2e}", coarse.1, middle.1, fine.1);
    assert!(fine.0 <= 1e-3 && fine.1 <= 1e-3, "half-width {:.2e}, pressure {:.2e}", fine.0, fine.1);
    // Real bodies are 2e-4 from Hertz on every mesh: half-widths are as near on few nodes already.
    assert!(coarse.0 <= 2e-3 && middle.0 <= 6e-4, "half-width {:.2e}, {:.2e}", coarse.0, middle.0);
    let order = (coarse.1 / middle.1).log2();
    println!("observed order of the peak pressure {order:.2}");
    assert!(order > 1.7, "{order}");
}

#[test]
fn thesis_paper_d_patch_and_approach_match_the_reference() {
    let model = model(without_centrifugal("paper_d", 20));
    let mut inputs = prescribed(&model, 50.0 * KMH, 0.0);
    inputs.drive.friction = 0.0;
    let simulation = Simulation::new(model, &inputs).unwrap();
    let outputs = simulation.outputs();
    figure_within(1e-3, "hub.approach [µm]", &[1e6 * outputs.contact_approach]);
    println!("{:e} {:e} {:e}", outputs.contact_half_width, outputs.contact_pressure_max, outputs.contact_approach);
    assert!((outputs.contact_half_width / 7.611e-4 - 1.0).abs() < 2e-3, "{:e}", outputs.contact_half_width);
    assert!((outputs.contact_pressure_max / 83.65e6 - 1.0).abs() < 1e-3, "{:e}", outputs.contact_pressure_max);
    assert!((outputs.contact_approach / 3.852e-6 - 1.0).abs() < 3e-3, "{:e}", outputs.contact_approach);
}

#[test]
fn steady_force_creepage_curve_matches_the_reference() {
    let cases: [(&str, &[(f64, f64)]); 2] = [
        (
            "paper_d",
            &[
                (0.0, -0.003556),
                (-0.0001, 0.298297),
                (-0.0003, 0.741135),
                (-0.0005, 0.967564),
                (-0.0008, 1.0),
                (0.0001, -0.304676),
                (0.0004, -0.882458),
            ],
        ),
        ("paper_c", &[(-5e-5, 0.45108), (-0.000125, 0.876526), (5e-5, -0.452738)]),
    ];
    for (name, curve) in cases {
        let model = model(without_centrifugal(name, 20));
        for &(xi, reference) in curve {
            let utilisation = stationary_utilisation(&model, &prescribed(&model, 50.0 * KMH, xi));
            println!(
                "{name} xi = {xi:9.2e}: {utilisation:.6}, reference {reference:.6}, {:+.6}",
                utilisation - reference
            );
            figure("steady.force", &[utilisation - reference]);
            assert!((utilisation - reference).abs() <= 2e-3, "{name} at xi = {xi}: {utilisation} against {reference}");
        }
    }
}

#[test]
fn centrifugal_load_shifts_the_force_as_the_reference() {
    let with = model(preset("paper_d", 20));
    let without = model(without_centrifugal("paper_d", 20));
    for (speed, shift, lift) in [(50.0, 0.0033, 4.896e-7), (100.0, 0.0132, 1.9584e-6), (300.0, 0.1147, 1.76257e-5)] {
        let run = |model: &Arc<Model>| {
            let inputs = prescribed(model, speed * KMH, 0.0);
            let simulation = Simulation::new(model.clone(), &inputs).unwrap();
            (signed_utilisation(&simulation, inputs.drive.friction), simulation.outputs().contact_approach)
        };
        let (a, b) = (run(&with), run(&without));
        let (force, height) = (a.0 - b.0, b.1 - a.1);
        figure_within(0.02, &format!("centrifugal.{speed}"), &[force]);
        println!("{speed} km/h: shift {force:.5} ({shift}), hub lift {height:.4e} ({lift:.4e})");
        assert!((force - shift).abs() <= 0.03 * shift + 1e-4, "{speed} km/h: {force} against {shift}");
        assert!((height / lift - 1.0).abs() < 0.01, "{speed} km/h: {height:e} against {lift:e}");
    }
}

/// Creepage without tangential force under the nominal load.
fn free_rolling_creepage(model: &Arc<Model>) -> f64 {
    let force = |xi: f64| stationary_utilisation(model, &prescribed(model, 50.0 * KMH, xi));
    // Two secants: the force is nearly linear this far from full slip.
    let (mut a, mut b) = (-2e-6, 0.0);
    for _ in 0..2 {
        let (fa, fb) = (force(a), force(b));
        (a, b) = (b, b - fb * (b - a) / (fb - fa));
    }
    b
}

#[test]
fn free_rolling_creepage_matches_the_reference() {
    let found = free_rolling_creepage(&model(without_centrifugal("paper_d", 20)));
    println!("{found:.4e}");
    // Error of the reference: 3e-8.
    assert!((found + 1.0839e-6).abs() < 4e-8, "{found:e}");
}

#[test]
fn force_is_smooth_while_the_contact_edges_pass_the_nodes() {
    let model = model(without_centrifugal("paper_d", 20));
    let config = model.config();
    let full_slip = |load: f64| {
        let a = hertz_half_width(load / config.model.contact_width, config.wheel.radius, modulus(config));
        carter_full_slip(config.friction.coefficient, a, config.wheel.radius)
    };
    // Carter's curve is shifted by the creepage of free rolling: the finite bodies.
    let shift = free_rolling_creepage(&model);
    for share in [0.3, 0.6, 0.8, 0.9, 0.95, -0.3, -0.6, -0.8, -0.9, -0.95] {
        let mut start: Option<Simulation> = None;
        let (mut forces, mut widths) = (Vec::new(), Vec::new());
        for k in 0..61 {
            let load = config.model.nominal_load * (0.85 + 0.005 * k as f64);
            let xi = share * full_slip(load) + shift;
            let mut inputs = prescribed(&model, 50.0 * KMH, xi);
            inputs.drive.load = load;
            match &mut start {
                Some(simulation) => simulation.restart(&inputs).unwrap(),
                None => start = Some(Simulation::new(model.clone(), &inputs).unwrap()),
            }
            let Some(simulation) = &start else { unreachable!() };
            let a = hertz_half_width(load / config.model.contact_width, config.wheel.radius, modulus(config));
            forces.push(
                signed_utilisation(simulation, config.friction.coefficient) - carter_force(xi - shift, full_slip(load)),
            );
            widths.push(simulation.outputs().contact_half_width / a);
        }
        let mean = forces.iter().sum::<f64>() / forces.len() as f64;
        let spread = |v: &[f64]| range(v).1 - range(v).0;
        figure("carter.shifted", &[mean, spread(&forces)]);
        figure("carter.half.width", &[spread(&widths)]);
        println!("share {share}: mean {mean:+.5}, p-p {:.5}; half-width p-p {:.5}", spread(&forces), spread(&widths));
        assert!(mean.abs() <= 1e-3, "share {share}: mean {mean}");
        assert!(spread(&forces) <= 2e-3, "share {share}: peak to peak {}", spread(&forces));
        // 3.8e-3: 0.08 cells, by which the edge seen with and without a node that opens differs.
        assert!(spread(&widths) <= 4e-3, "share {share}: half-width peak to peak {}", spread(&widths));
    }
}

#[test]
fn driven_start_state_accelerates_as_newton_demands() {
    let model = model(preset("railway", 10));
    let mut inputs = Inputs::rolling(model.config());
    inputs.drive.moment = 500.0;
    let simulation = Simulation::new(model.clone(), &inputs).unwrap();
    let outputs = simulation.outputs();
    assert!((outputs.contact_force_y / inputs.drive.load - 1.0).abs() < 1e-9);
    assert!((outputs.hub_moment - 500.0).abs() < 1e-9);
    let config = model.config();
    let (outer, inner) = (config.wheel.radius, config.wheel.hub_radius);
    let annulus = config.material.density * PI * (outer * outer - inner * inner) * config.model.contact_width;
    let mass = annulus + config.wheel.hub_mass + config.vehicle.mass;
    let inertia = 0.5 * annulus * (outer * outer + inner * inner) + config.wheel.hub_inertia;
    let (force, moment) = (mass * outputs.wheel_acceleration, inertia * outputs.wheel_angular_acceleration);
    println!("m a = {force:.6} N under {:.6} N", outputs.contact_force_x + outputs.hub_force_x);
    println!("I α = {moment:.6} N m under {:.6} N m", outputs.contact_moment + outputs.hub_moment);
    assert!((force - outputs.contact_force_x - outputs.hub_force_x).abs() < 1e-9 * inputs.drive.load);
    assert!((moment - outputs.contact_moment - outputs.hub_moment).abs() < 1e-9 * inputs.drive.load);
}
