//! Patches much wider than those for which the mesh is laid out: the wings of the candidate zone hold them.

mod common;
use common::*;
use std::sync::Arc;
use wheelrail::analytic::{contact_modulus, hertz_half_width, hertz_peak_pressure};
use wheelrail::config::Config;
use wheelrail::rolling::State;
use wheelrail::simulation::{Inputs, Model, Simulation};

fn modulus(config: &Config) -> f64 {
    contact_modulus(config.material.youngs_modulus, config.material.poissons_ratio)
}

/// Ports of a contact: more in the wide zone.
fn ports(state: &State) -> usize {
    state.contact.traction.port_forces.len()
}

/// Relative errors of half-width, peak pressure and approach under many loads, without friction.
#[test]
fn patches_under_ten_times_the_nominal_load_are_those_of_hertz() {
    for (name, elements) in [("railway", 20), ("paper_d", 10)] {
        let mut config = preset(name, elements);
        (config.physics.centrifugal, config.thermal.enabled) = (false, false);
        let model = model(config);
        let config = model.config();
        let mut approach = Vec::new();
        for ratio in [2.2, 3.0, 4.0, 5.0, 7.0, 10.0, 14.0] {
            let mut inputs = prescribed(&model, 50.0 * KMH, 0.0);
            inputs.drive.load = ratio * config.model.nominal_load;
            inputs.drive.friction = 0.0;
            let line_load = inputs.drive.load / config.model.contact_width;
            let a = hertz_half_width(line_load, config.wheel.radius, modulus(config));
            let p0 = hertz_peak_pressure(line_load, a);
            let simulation = Simulation::new(model.clone(), &inputs).unwrap();
            let o = simulation.outputs();
            let errors = [o.contact_half_width / a - 1.0, o.contact_pressure_max / p0 - 1.0];
            println!(
                "{name} {elements}: load x {ratio}: {:.2e} {:.2e}, approach {:.4e}",
                errors[0], errors[1], o.contact_approach
            );
            approach.push([line_load, a, o.contact_approach]);
            assert!(o.contact_force_y / inputs.drive.load - 1.0 < 1e-9);
        }
        // Approach of line contacts: w = P/(πE*) (2 ln(4 R.../a) − 1) + const; differences are free of the constant.
        for pair in approach.windows(2) {
            let [p, a, w] = pair[0];
            let [q, b, v] = pair[1];
            let e = std::f64::consts::PI * modulus(config);
            println!("{:.5e} {:.5e}", v / q - w / p, -2.0 / e * (b / a).ln());
        }
    }
}
