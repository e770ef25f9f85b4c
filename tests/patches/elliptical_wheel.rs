//! A wheel on its rail that touches in an ellipse: energy, convergence and limits of the whole model.

use crate::common::*;
use std::sync::Arc;
use wheelrail::analytic::{carter_full_slip, contact_modulus, hertz_half_width};
use wheelrail::config::{Config, ContactShape, StartTemperature};
use wheelrail::simulation::{Inputs, Model, Rotation, Simulation, Translation};

/// The preset with a number of lines and of elements per half axis.
fn ellipse(lines: usize, elements: usize, heat: bool) -> Config {
    let mut config = preset("railway_ellipse", elements);
    config.contact.lines = lines;
    config.thermal.enabled = heat;
    config
}

#[test]
fn pressure_half_axis_and_approach_of_the_wheel_are_those_of_hertz_under_any_load() {
    let model = model(ellipse(7, 10, false));
    let hertz = model.config().hertz();
    for share in [0.1, 0.5, 1.0, 1.9] {
        let mut inputs = Inputs::rolling(model.config());
        inputs.drive.load = share * 1e5;
        let simulation = Simulation::new(model.clone(), &inputs).unwrap();
        let (outputs, exact) = (simulation.outputs(), hertz.under(share * 1e5));
        let pressure = outputs.contact_pressure_max / exact.peak - 1.0;
        let half_axis = outputs.contact_half_width / exact.a - 1.0;
        let more = outputs.contact_approach - exact.approach;
        println!(
            "{share}: pressure {pressure:+.1e}, half axis {half_axis:+.1e}, bodies yield {:.3e} m/N",
            more / (share * 1e5)
        );
        assert!(pressure.abs() < 5e-3 && half_axis.abs() < 5e-3);
        assert!(more > 0.0 && (outputs.contact_force_y / (share * 1e5) - 1.0).abs() < 1e-9);
    }
}

#[test]
fn braking_with_varying_load_friction_and_rail_balances_energy() {
    let mut config = ellipse(5, 10, true);
    (config.tuning.tolerance, config.tuning.max_step) = (0.0, 2.5e-4);
    let model = model(config);
    let mut inputs = Inputs::rolling(model.config());
    inputs.drive.moment = -4000.0;
    let residual = run(&model, inputs, (1e-3, 60), vary)[60].energy_residual;
    println!("residual {residual:.1e}");
    assert!(residual.abs() < 5.2e-3);
}

/// Lines widen and narrow with the load; what they carry of the shear before keeps its energy. With displacements that
/// stayed, 1.4e-3 of what friction takes was missing, and CONTACT's force under such loads was missed by .013 instead
/// of .005.
#[test]
fn a_load_that_swings_by_a_third_under_braking_balances_energy() {
    let mut config = ellipse(5, 10, false);
    (config.tuning.tolerance, config.tuning.max_step) = (0.0, 5e-5);
    let model = model(config);
    let mut inputs = Inputs::rolling(model.config());
    inputs.drive.moment = -6000.0;
    let seen = run(&model, inputs, (5e-5, 600), |inputs, t| {
        inputs.drive.load = 1e5 * (1.0 + 0.3 * (400.0 * t).sin());
    });
    let worst = seen[400..].iter().fold(0.0, |worst: f64, outputs| worst.max(outputs.energy_residual.abs()));
    figure("ellipse.swing", &[worst]);
    println!("residual at most {worst:.1e}");
    assert!(worst < 6e-4);
}

#[test]
fn a_wheel_that_locks_slides_with_friction_and_stays_within_its_sources() {
    for step in [1e-3, 2e-4] {
        let mut config = ellipse(5, 8, true);
        config.initial.velocity = 60.0 * KMH;
        let model = model(config);
        let mut inputs = Inputs::rolling(model.config());
        inputs.rotation = Rotation::Velocity;
        let start = inputs.drive.omega;
        let count = (0.06 / step) as usize;
        let seen =
            run(&model, inputs, (step, count), |inputs, t| inputs.drive.omega = start * (1.0 - t / 0.03).max(0.0));
        let last = &seen[count];
        println!(
            "{step}: force {:.1} N, friction {:.3}, {:.1} K, heat residual {:.1e}, energy {:.1e}",
            last.contact_force_x, last.friction, last.temperature_wheel_max, last.heat_residual, last.energy_residual
        );
        for outputs in &seen {
            let limit = outputs.friction * outputs.contact_force_y;
            assert!(outputs.contact_force_x.abs() <= 1.01 * limit, "{}", outputs.contact_force_x / limit);
        }
        assert!(last.contact_force_x < 0.0 && last.heat_residual.abs() < 1e-6);
    }
}

#[test]
fn a_wheel_at_rest_starts_and_stops() {
    let mut config = ellipse(5, 8, true);
    config.initial.velocity = 0.0;
    config.initial.temperature = StartTemperature::Uniform;
    let model = model(config);
    let inputs = Inputs::rolling(model.config());
    let seen = run(&model, inputs, (1e-2, 60), |inputs, t| {
        inputs.drive.moment = if t < 0.3 { 4000.0 * (t / 0.05).min(1.0) } else { 0.0 };
    });
    let last = &seen[60];
    println!("{:.3} m/s, residual {:.1e}", last.wheel_velocity, last.energy_residual);
    assert!(last.wheel_velocity > 0.1);
}

/// A wheel whose patch is that of the reference: a circle of 6 mm under 100 kN.
fn circle(lines: usize) -> Config {
    let mut config = ellipse(lines, 20, true);
    (config.wheel.radius, config.contact.rail_lateral_radius) = (0.332308, 0.332308);
    config.wheel.hub_radius = 0.067;
    (config.tuning.softening, config.initial.velocity) = (0.0, 20.0);
    config
}

/// Flash temperatures of the wheel before its tread comes round again against Jaeger's integral over the tractions of
/// CONTACT, half of the heat in each body.
#[test]
fn flash_temperatures_are_those_of_the_tractions_of_contact() {
    let reference: serde_json::Value = serde_json::from_str(include_str!("../contact_reference/ellipse.json")).unwrap();
    let number = |value: &serde_json::Value| value.as_f64().unwrap();
    let model = model(circle(7));
    for case in reference["flash"].as_array().unwrap() {
        if number(&case["aspect"]) != 1.0 {
            continue;
        }
        let (xi, speed) = (number(&case["xi"]), number(&case["speed"]));
        let seen = run(&model, prescribed(&model, speed, xi), (1e-3, 20), |_, _| {});
        let last = &seen[20];
        let (hottest, expected) = (last.temperature_wheel_max - 293.0, number(&case["hottest"]));
        figure(&format!("ellipse.flash.{}", (1e3 * xi).abs().round()), &[hottest / expected - 1.0]);
        println!("xi {xi}: {hottest:.2} K for {expected:.2} K, {:+.3}", hottest / expected - 1.0);
        assert!((hottest / expected - 1.0).abs() < 0.035);
        let rows = |key: &str| -> Vec<f64> { case[key].as_array().unwrap().iter().map(number).collect() };
        let (y, rows) = (rows("y_mm"), rows("hottest_of_row"));
        for (position, temperature) in last.line_position.iter().zip(&last.line_temperature_wheel).take(7) {
            let of_row = wheelrail::piecewise::interpolate(&y, &rows, 1e3 * position);
            println!("  {:.2} mm: {:.2} K for {of_row:.2} K", 1e3 * position, temperature - 293.0);
            assert!((temperature - 293.0 - of_row).abs() < 0.05 * expected);
        }
    }
}

/// Each line alone would be heated by its own friction, the outermost of seven to less than a third of the middle one:
/// heat spreads between them by its diffusion length, 7 mm in a second.
#[test]
fn heat_of_a_locked_wheel_spreads_from_line_to_line_within_a_second() {
    let mut config = ellipse(7, 8, true);
    (config.friction.coefficient, config.tuning.softening, config.initial.velocity) = (2e-3, 0.0, 5.0);
    let model = model(config);
    let mut inputs = Inputs::rolling(model.config());
    (inputs.rotation, inputs.translation, inputs.drive.omega) = (Rotation::Velocity, Translation::Velocity, 0.0);
    let seen = run(&model, inputs, (1e-2, 100), |_, _| {});
    let ratio = |k: usize| {
        let rise = |line: usize| seen[k].line_temperature_wheel[line] - 293.0;
        rise(6) / rise(3)
    };
    println!("outermost over middle line: {:.3} after 10 ms, {:.3} after 1 s", ratio(1), ratio(100));
    assert!(ratio(1) < 0.33 && ratio(100) > 1.5 * ratio(1));
}

/// Load per metre of width on the middle line of patches of any breadth, and on a plane contact [N/m].
const PER_WIDTH: f64 = 1e6;

/// A patch with a ratio of the curvatures across and along the direction of rolling; bodies as wide as a line with this
/// load per width everywhere.
fn of_curvature(curvature: f64) -> Config {
    let mut config = ellipse(7, 10, false);
    config.contact.rail_lateral_radius = config.wheel.radius / curvature;
    // The load per width, 3N/4b, goes with N^⅔.
    let middle = 0.75 * 1e5 / config.hertz().under(1e5).b;
    config.model.nominal_load = 1e5 * (PER_WIDTH / middle).powf(1.5);
    config.model.structural_width = config.model.nominal_load / PER_WIDTH;
    config
}

/// Force over friction, stick, largest pressure and half length of the middle line of a wheel that rolls with a
/// creepage, and the force of all lines over friction.
fn middle_line(model: &Arc<Model>, creepage: f64) -> ([f64; 4], f64) {
    let simulation = Simulation::new(model.clone(), &prescribed(model, 20.0, creepage)).unwrap();
    let (seen, friction) = (simulation.outputs(), model.config().friction.coefficient);
    let all = seen.contact_force_x / (friction * seen.contact_force_y);
    if model.config().contact.shape.is_line() {
        return ([all, seen.contact_stick_fraction, seen.contact_pressure_max, seen.contact_half_width], all);
    }
    let force = seen.line_force_x[3] / (friction * seen.line_force_y[3]);
    ([force, seen.line_stick[3], seen.line_pressure_max[3], seen.line_half_length[3]], all)
}

/// Force over friction of plane contacts side by side over an ellipse whose middle one sticks on all but a `share` of
/// its length.
fn of_strips(share: f64) -> f64 {
    let count = 10_000;
    let strip = |k: i32| {
        let root = (1.0 - ((f64::from(k) + 0.5) / f64::from(count)).powi(2)).sqrt();
        root * root * (1.0 - (1.0 - share / root).max(0.0).powi(2))
    };
    1.5 * (0..count).map(strip).sum::<f64>() / f64::from(count)
}

/// Half axes of 1:4.5, 1:9.5 and, at the limit of the curvatures, 1:18.
#[test]
fn a_patch_that_grows_across_the_rail_becomes_the_plane_contact_of_its_load_per_width() {
    let mut plane = ellipse(7, 10, false);
    plane.contact.shape = ContactShape::Line;
    (plane.model.contact_width, plane.model.nominal_load) = (0.1, 0.1 * PER_WIDTH);
    let modulus = contact_modulus(plane.material.youngs_modulus, plane.material.poissons_ratio);
    let half_width = hertz_half_width(PER_WIDTH, plane.wheel.radius, modulus);
    let full = carter_full_slip(plane.friction.coefficient, half_width, plane.wheel.radius);
    let plane = model(plane);
    let mut before = [f64::INFINITY; 5];
    for curvature in [0.1, 0.03, 0.01] {
        let patch = model(of_curvature(curvature));
        let mut worst = [0.0_f64; 5];
        for share in [0.3, 0.7] {
            let (line, (found, all)) = (middle_line(&plane, -share * full).0, middle_line(&patch, -share * full));
            // Bodies of finite size creep by a trifle when they roll freely: what counts is the share of full slip at
            // which Carter has the force of the plane contact.
            let strips = all / of_strips(1.0 - (1.0 - line[0]).sqrt()) - 1.0;
            let errors: [f64; 5] = std::array::from_fn(|k| if k < 4 { found[k] / line[k] - 1.0 } else { strips });
            if curvature == 0.01 {
                figure("ellipse.to.plane", &errors[..4]);
            }
            println!("{curvature}, {share} of full slip: {errors:+.4?}");
            worst.iter_mut().zip(errors).for_each(|(worst, error)| *worst = worst.max(error.abs()));
        }
        // Pressure and half-length tend to those of the plane contact with the size of the patch, forces and stick from the
        // other side, as Kalker's coefficient does: 1 % at 1:4.5 and at 1:9.5.
        let third = curvature < 0.1;
        let least = |k: usize| -> f64 { if k == 2 || k == 3 { 0.0 } else { 0.012 } };
        let bound = |k: usize, before: f64| if third { least(k).max(0.5 * before) } else { 0.05 };
        assert!(worst.iter().zip(before).enumerate().all(|(k, (now, before))| *now < bound(k, before)));
        before = worst;
    }
    assert!(before.into_iter().all(|error| error < 8e-3));
}
