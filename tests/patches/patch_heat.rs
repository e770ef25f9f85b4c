//! The contact in runs with heat, whose layers swell and pull at the bodies.

use crate::common::*;
use wheelrail::config::StartTemperature;
use wheelrail::simulation::{Inputs, Outputs, Simulation};

/// A wheel with heat whose moment rises over 50 ms, `share` of the load and of the moment; outputs after every step.
fn heated(nodes: usize, share: f64, moment: f64, step: f64) -> Vec<Outputs> {
    let mut config = preset("railway", 10);
    config.mesh.grid_elements_per_half_width = nodes;
    let model = model(config);
    let mut inputs = Inputs::rolling(model.config());
    inputs.drive.load *= share;
    let mut simulation = Simulation::new(model, &inputs).unwrap();
    let mut seen = Vec::new();
    for k in 0..(0.07 / step).round() as usize {
        inputs.drive.moment = share * moment * (k as f64 * step / 0.05).min(1.0);
        simulation.advance(&inputs, step).unwrap();
        seen.push(simulation.outputs().clone());
    }
    seen
}

/// Layers swell and pull at the bodies: force, pressure and temperature are those of four times as many nodes, a tenth of the
/// step and nearly twice the load included, and the energy is accounted for.
#[test]
fn a_wheel_with_heat_moves_as_on_more_nodes_and_its_energy_is_accounted_for() {
    for (share, moment, step) in [
        (1.0, -7e3, 1e-3),
        (1.0, -12e3, 1e-3),
        (1.0, 7e3, 1e-3),
        (1.9, -7e3, 1e-3),
        (1.0, -7e3, 1e-4),
        (0.1, -7e3, 1e-3),
    ] {
        let [ours, theirs] = [10, 40].map(|nodes| heated(nodes, share, moment, step));
        let last = &theirs[theirs.len() - 1];
        let worst = |get: fn(&Outputs) -> f64, scale: f64| {
            ours.iter().zip(&theirs).map(|(a, b)| (get(a) - get(b)).abs() / scale).fold(0.0, f64::max)
        };
        let force = worst(|o| o.contact_force_x, 0.3 * last.contact_force_y);
        let pressure = worst(|o| o.contact_pressure_max, last.contact_pressure_max);
        let rise = last.temperature_wheel_max - theirs[0].temperature_wheel_max;
        let warmth = worst(|o| o.temperature_wheel_max, rise);
        let energy = last.friction_power * 0.07;
        let residual = ours.iter().map(|o| o.energy_residual.abs()).fold(0.0, f64::max) / energy;
        figure("heat.nodes", &[force, pressure, warmth, residual]);
        println!(
            "{share} of the load, {moment:.0} N m, {step:.0e} s: F/muP {force:.1e}, pressure {pressure:.1e}, rise {rise:.2} K \
             within {warmth:.1e}, residual {residual:.1e}"
        );
        assert!(force < 3e-3 && pressure < 3e-4 && residual < 1e-4);
        assert!(warmth < 2e-2);
    }
}

/// Shift of the creepage of free rolling of a wheel 300 K hotter than the rail at 27.8 m/s, found with tractions as series and 40
/// elements \[1].
const SHIFT: f64 = 1.67e-5;

/// The rail chills a hot wheel, whose tread contracts: it rolls freely at another creepage, which depends on how meshes resolve the
/// root with which the heat begins to flow.
#[test]
fn a_chilled_tread_changes_the_creepage_of_free_rolling_by_what_finer_meshes_tend_to() {
    let shift = |elements| {
        let creepage = |expansion| {
            let mut config = preset("railway", elements);
            config.material.expansion *= f64::from(u8::from(expansion));
            config.thermal.wheel_excess = 300.0;
            config.initial.temperature = StartTemperature::Stationary;
            let model = model(config);
            Simulation::new(model.clone(), &Inputs::rolling(model.config())).unwrap().outputs().contact_creepage
        };
        creepage(true) - creepage(false)
    };
    let shifts = [10, 20, 40].map(shift);
    figure_within(0.05, "nodes.chill", &shifts.map(|shift| 1e5 * shift));
    println!("shift {shifts:?} with 10, 20, 40 elements");
    let away = shifts.map(|shift| shift - SHIFT);
    assert!(away[2] > 0.0 && away[2] < 0.65 * away[1]);
}

/// Rises \[K] of the highest temperature of the wheel: 4.6941, 4.6938, 4.6890 and 4.6880 with 10, 20, 40 and 80 elements.
#[test]
fn the_rise_in_steady_braking_on_the_default_mesh_is_within_two_per_mille_of_that_on_a_fine_one() {
    let rise = |elements: Option<usize>| {
        let mut config = shipped("railway");
        config.initial.velocity = 27.0;
        if let Some(elements) = elements {
            config.mesh.elements_per_half_width = elements;
            config.mesh.grid_elements_per_half_width = elements;
        }
        let model = model(config);
        let mut inputs = Inputs::rolling(model.config());
        // The vehicle is pushed against its brake, so that the speed stays.
        (inputs.drive.moment, inputs.drive.force) = (-7e3, 1.5e4);
        let mut simulation = Simulation::new(model, &inputs).unwrap();
        (0..400).for_each(|_| simulation.advance(&inputs, 1e-3).unwrap());
        simulation.outputs().temperature_wheel_max - simulation.model().config().thermal.reference
    };
    let [usual, fine] = [None, Some(40)].map(rise);
    figure("braking.rise", &[usual / fine - 1.0]);
    println!("rise {usual:.4} K on the default mesh, {fine:.4} K with 40 elements");
    assert!(usual > 4.0 && (usual / fine - 1.0).abs() < 2e-3);
}
