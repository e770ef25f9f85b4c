//! Patches much wider than those for which the mesh is laid out: the wings of the candidate zone hold them.

use crate::common;
use crate::common::*;
use std::f64::consts::PI;
use std::sync::Arc;
use wheelrail::analytic::{contact_modulus, hertz_half_width, hertz_peak_pressure};
use wheelrail::config::{Config, StartTemperature};
use wheelrail::rolling::{Outputs, StepError};
use wheelrail::simulation::{Checkpoint, Inputs, Model, Simulation};

/// The default wheel with `elements` per half-width and room for three times the half-width in uniform nodes: laid out
/// for nine times the load with as many times more elements as the half-width grows, so that all nodes of its zone have
/// the spacing of the first.
fn laid_out_for(share: f64, elements: usize, change: impl Fn(&mut Config)) -> Arc<Model> {
    let mut config = preset("railway", (share.sqrt() * elements as f64).round() as usize);
    config.model.nominal_load *= share;
    change(&mut config);
    model(config)
}

#[test]
fn patches_under_ten_times_the_nominal_load_are_those_of_hertz() {
    for (name, elements) in [("railway", 20), ("paper_d", 10)] {
        let mut config = preset(name, elements);
        (config.physics.centrifugal, config.thermal.enabled) = (false, false);
        // Ten times the load is more than steel bears without yielding.
        config.physics.yielding = false;
        let model = model(config);
        let config = model.config();
        let modulus = contact_modulus(config.material.youngs_modulus, config.material.poissons_ratio);
        let mut before: Option<[f64; 3]> = None;
        for ratio in [1.0, 2.2, 3.0, 4.0, 5.0, 7.0, 10.0] {
            let mut inputs = prescribed(&model, 50.0 * KMH, 0.0);
            inputs.drive.load = ratio * config.model.nominal_load;
            inputs.drive.friction = 0.0;
            let load = inputs.drive.load / config.model.contact_width;
            let a = hertz_half_width(load, config.wheel.radius, modulus);
            let simulation = Simulation::new(model.clone(), &inputs).unwrap();
            let o = simulation.outputs();
            let width = o.contact_half_width / a - 1.0;
            let pressure = o.contact_pressure_max / hertz_peak_pressure(load, a) - 1.0;
            assert!((o.contact_force_y / inputs.drive.load - 1.0).abs() < 1e-9);
            // The approach of a line contact over its load falls by 2/(πE*) with the logarithm of its half-width,
            // whatever the size of the bodies; 1.5 %: they are finite.
            let now = [a, o.contact_approach / load, ratio];
            let fall = before
                .replace(now)
                .map_or(0.0, |[b, compliance, _]| (now[1] - compliance) / (-2.0 / (PI * modulus) * (a / b).ln()) - 1.0);
            if ratio <= 4.0 {
                figure("hertz.wide", &[width, pressure]);
            }
            println!("{name}: load x {ratio}: half-width {width:.1e}, pressure {pressure:.1e}, approach {fall:.1e}");
            assert!(width.abs() < 1e-2 && pressure.abs() < 1e-2 && fall.abs() < 4e-2);
        }
    }
}

/// Outputs of each of `steps` steps of 1 ms under a load that follows `share` of 100 kN.
fn run(simulation: &mut Simulation, inputs: &mut Inputs, steps: usize, share: impl Fn(f64) -> f64) -> Vec<Outputs> {
    let step = |k: usize| {
        inputs.drive.load = 1e5 * share((k + 1) as f64 / steps as f64);
        simulation.advance(inputs, 1e-3).unwrap();
        simulation.outputs().clone()
    };
    (0..steps).map(step).collect()
}

/// Largest difference of an output between two runs over its largest size.
fn difference(a: &[Outputs], b: &[Outputs], output: impl Fn(&Outputs) -> f64) -> f64 {
    let size = a.iter().map(|o| output(o).abs()).fold(0.0, f64::max);
    a.iter().zip(b).map(|(a, b)| (output(a) - output(b)).abs()).fold(0.0, f64::max) / size
}

/// Forces within 1 %, temperatures within 3 %: the depth of the first thermal layer follows from the nominal load, too,
/// and the elements along the surface are coarse in the wings. Layers that swell have a depth that follows from the
/// nominal load: without them. Hot steel that yields would leave the wings.
#[test]
fn a_sliding_contact_in_the_wings_is_that_of_a_model_laid_out_for_it() {
    let runs = [(1.0, 20), (9.0, 8)].map(|(laid_out, elements)| {
        let model = laid_out_for(laid_out, elements, |config| {
            (config.material.expansion, config.physics.yielding) = (0.0, false);
            // A molten film holds friction by its thickness, which differs by 3 % between these meshes.
            config.material.latent_heat = 0.0;
            // From a cold start both alternate for long between friction at its floor and above it, by up to 8 %, each
            // at its own steps.
            config.initial.temperature = StartTemperature::Stationary;
        });
        let mut inputs = prescribed(&model, 60.0 * KMH, 1.0);
        inputs.drive.load = 7e5;
        let mut simulation = Simulation::new(model, &inputs).unwrap();
        run(&mut simulation, &mut inputs, 200, |share| 7.0 + 0.8 * (4.0 * share).sin())
    });
    let [wings, core] = &runs;
    let differences = [
        difference(wings, core, |o| o.contact_force_y),
        difference(wings, core, |o| o.contact_force_x),
        difference(wings, core, |o| o.contact_moment),
        difference(wings, core, |o| o.contact_half_width),
        difference(wings, core, |o| o.contact_pressure_max),
        difference(wings, core, |o| o.friction_power),
        difference(wings, core, |o| o.temperature_wheel_mean - 293.0),
        difference(wings, core, |o| o.temperature_rail_max - 293.0),
        difference(wings, core, |o| o.temperature_rail_mean - 293.0),
        difference(wings, core, |o| o.heat_to_rail),
    ];
    println!("{differences:?}");
    let (mechanical, thermal) = differences.split_at(6);
    assert!(mechanical.iter().all(|d| *d < 1e-2) && thermal.iter().all(|d| *d < 3e-2));
    assert!(wings.iter().all(|o| o.contact_half_width > 2.4 * 6.0e-3));
}

/// The load rises to five times the nominal one and falls again while the wheel brakes, by less than 2 % of the nominal
/// one in a step: faster changes restart the time formula, and what is nominal is not the same in both models.
#[test]
fn a_load_that_comes_and_goes_leaves_forces_and_energy_as_in_one_zone() {
    let [zones, one] = [(1.0, 20), (6.25, 8)].map(|(laid_out, elements)| {
        let model = laid_out_for(laid_out, elements, |_| {});
        let mut inputs = Inputs::rolling(model.config());
        (inputs.drive.load, inputs.drive.moment) = (1e5, -5000.0);
        let mut simulation = Simulation::new(model, &inputs).unwrap();
        let up = run(&mut simulation, &mut inputs, 250, |share| 1.0 + 4.0 * share);
        let down = run(&mut simulation, &mut inputs, 300, |share| 5.0 - 4.0 * (1.2 * share).min(1.0));
        [up, down].concat()
    });
    let differences = [
        difference(&zones, &one, |o| o.contact_force_y),
        difference(&zones, &one, |o| o.contact_force_x),
        difference(&zones, &one, |o| o.contact_approach),
        difference(&zones, &one, |o| o.friction_power),
        difference(&zones, &one, |o| o.stored_energy),
    ];
    let residuals = [&zones, &one].map(|run| run.last().unwrap().energy_residual);
    println!("{differences:?}, energy residuals {residuals:?}");
    assert!(differences.iter().all(|d| *d < 1.2e-2), "{differences:?}");
    assert!((residuals[0] - residuals[1]).abs() < 3e-3);
}

#[test]
fn a_restored_state_continues_bit_by_bit_into_the_wings_and_back() {
    let model = laid_out_for(1.0, 6, |_| ());
    let mut inputs = Inputs::rolling(model.config());
    (inputs.drive.load, inputs.drive.moment) = (1e5, -5000.0);
    let mut simulation = Simulation::new(model.clone(), &inputs).unwrap();
    let (mut saved, mut seen) = (Vec::new(), Vec::new());
    for k in 0..110 {
        saved.push((inputs, postcard::to_stdvec(simulation.checkpoint()).unwrap()));
        inputs.drive.load = 1e5 * (1.0 + 4.0 * (f64::from(k) / 60.0 * PI).sin().max(0.0));
        simulation.advance(&inputs, 1e-3).unwrap();
        seen.push((inputs, simulation.checkpoint().clone()));
    }
    for from in (0..108).step_by(12) {
        let checkpoint: Checkpoint = postcard::from_bytes(&saved[from].1).unwrap();
        let mut again = Simulation::resume(model.clone(), checkpoint.tuning.clone(), checkpoint.clone()).unwrap();
        // Once with fresh memory, once rolled back with that of other steps.
        for _ in 0..2 {
            for (inputs, expected) in &seen[from..from + 3] {
                again.advance(inputs, 1e-3).unwrap();
                assert!(again.checkpoint() == expected);
            }
            again.recall(checkpoint.clone()).unwrap();
        }
    }
}

#[test]
fn a_patch_beyond_the_wide_zone_is_refused_and_small_bodies_do_without_wings() {
    let model = laid_out_for(1.0, 6, |config| config.thermal.enabled = false);
    let mut inputs = prescribed(&model, 10.0, 0.0);
    inputs.drive.load = 30e5;
    let error = Simulation::new(model.clone(), &inputs).map(|_| ()).unwrap_err();
    assert!(matches!(error, StepError::ZoneExceeded { zone, .. } if zone > 2.0 * 1.5e-3), "{error}");
    let mut small = model.config().clone();
    (small.wheel.radius, small.wheel.hub_radius) = (0.05, 0.01);
    small.model.nominal_load = 5e4;
    let model = common::model(small);
    let mut inputs = prescribed(&model, 1.0, 0.0);
    Simulation::new(model.clone(), &inputs).unwrap();
    inputs.drive.load *= 30.0;
    let error = Simulation::new(model, &inputs).map(|_| ()).unwrap_err();
    assert!(matches!(error, StepError::ZoneExceeded { .. }), "{error}");
}
