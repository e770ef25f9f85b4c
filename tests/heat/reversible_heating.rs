//! Reversible (Gough–Joule) heating against the stresses of a half-plane under Hertzian pressure and traction.

use crate::common::{self, model, prescribed, preset};
use wheelrail::config::{Config, StartTemperature};
use wheelrail::simulation::{Outputs, Simulation};

/// Stationary rolling without frictional heat, reversible heating on.
fn rolling(creepage: f64, conductance: f64) -> (Config, Outputs, Simulation) {
    let mut config = preset("railway", 20);
    config.physics.thermoelastic_heating = true;
    config.physics.centrifugal = false;
    config.thermal.heat_ratio = 0.0;
    config.thermal.conductance = conductance;
    config.initial.temperature = StartTemperature::Stationary;
    let model = model(config.clone());
    let simulation = Simulation::new(model.clone(), &prescribed(&model, 20.0, creepage)).unwrap();
    (config, simulation.outputs().clone(), simulation)
}

/// Temperature change per in-plane mean stress `−(σ_x + σ_y)` in plane strain [K/Pa].
fn per_stress(config: &Config) -> f64 {
    let m = &config.material;
    config.thermal.reference * m.expansion * (1.0 + m.poissons_ratio) / (m.density * m.specific_heat)
}

#[test]
fn compressed_surface_is_warmer_by_the_adiabatic_temperature_of_hertzian_stress() {
    let (config, seen, _) = rolling(0.0, 0.0);
    // Surface stress of a half-plane under pressure alone: σ_x = σ_y = −p.
    let expected = per_stress(&config) * 2.0 * seen.contact_pressure_max;
    for (found, name) in [(seen.temperature_wheel_nominal, "wheel"), (seen.temperature_rail_nominal, "rail")] {
        let rise = found - config.thermal.reference;
        common::figure("reversible", &[rise / expected - 1.0]);
        assert!((rise / expected - 1.0).abs() < 0.02, "{name}: {rise:.4} K, closed form {expected:.4} K");
    }
    let outside = seen.profile_temperature_wheel[0] - config.thermal.reference;
    assert!(outside.abs() < 0.02 * expected, "ahead of the contact {outside:.4} K");
}

#[test]
fn traction_heats_one_surface_and_cools_the_other() {
    let (config, seen, _) = rolling(0.05, 0.0);
    let (a, traction) = (seen.contact_half_width, -config.friction.coefficient * seen.contact_pressure_max);
    let peak = seen.profile_shear.iter().fold(0.0f64, |m, q| m.min(*q));
    assert!(peak < 0.5 * traction, "the wheel slides: {peak:.3e} Pa");
    // The driven wheel winds up on its hub, which moves the patch.
    let moment: f64 = seen.profile_x.iter().zip(&seen.profile_pressure).map(|(x, p)| x * p).sum();
    let centre = moment / seen.profile_pressure.iter().sum::<f64>();
    for (x, (w, r)) in
        seen.profile_x.iter().zip(seen.profile_temperature_wheel.iter().zip(&seen.profile_temperature_rail))
    {
        let x = x - centre;
        if x.abs() < 0.7 * a {
            // Full sliding: σ_x = −2 q x/a on the wheel, opposite on the rail.
            let expected = per_stress(&config) * 4.0 * peak * x / a;
            let scale = per_stress(&config) * 4.0 * peak.abs();
            let error = (w - r - expected) / scale;
            assert!(error.abs() < 0.03, "x/a = {:.2}: {:.4} K, closed form {expected:.4} K", x / a, w - r);
        }
    }
}

#[test]
fn conducted_reversible_heat_leaves_one_body_and_enters_the_other() {
    let (_, seen, mut simulation) = rolling(0.05, 1e8);
    assert!(seen.heat_conduction.abs() > 0.1, "{} W", seen.heat_conduction);
    assert!((seen.heat_to_wheel + seen.heat_to_rail).abs() < 1e-9 * seen.heat_conduction.abs());
    let inputs = prescribed(simulation.model(), 20.0, 0.05);
    for _ in 0..20 {
        simulation.advance(&inputs, 1e-3).unwrap();
    }
    let later = simulation.outputs();
    assert!((later.heat_conduction / seen.heat_conduction - 1.0).abs() < 1e-3, "{} W", later.heat_conduction);
}
