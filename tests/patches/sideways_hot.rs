//! Steel that yields, melts, wears or has a profile under a contact that slips sideways, too: forces, temperatures and dents
//! are those of a contact in one direction where nothing goes sideways, and mirror images where it does.

use crate::common::*;
use std::sync::Arc;
use wheelrail::config::{Config, Damping, Wear};
use wheelrail::simulation::{Inputs, Model, Outputs, Simulation};

/// The hot elliptical patch on five lines; with `lateral` creepage.
fn hot(lateral: bool, change: impl Fn(&mut Config)) -> Arc<Model> {
    let mut config = preset("railway_ellipse", 10);
    (config.contact.lines, config.contact.lateral) = (5, lateral);
    change(&mut config);
    model(config)
}

/// Outputs of a wheel that locks within .1 s and slides on for as long with a lateral creepage.
fn locked(model: &Arc<Model>, lateral: f64) -> Outputs {
    let speed = model.config().initial.velocity;
    let mut inputs = prescribed(model, speed, 1e-3);
    inputs.drive.lateral_velocity = lateral * speed;
    let rolling = inputs.drive.omega;
    let mut simulation = Simulation::new(model.clone(), &inputs).unwrap();
    for k in 1..=200 {
        inputs.drive.omega = rolling * (1.0 - f64::from(k) / 100.0).max(0.0);
        simulation.advance(&inputs, 1e-3).unwrap();
    }
    simulation.outputs().clone()
}

fn close(a: f64, b: f64, share: f64) -> bool {
    (a / b - 1.0).abs() < share
}

#[test]
fn a_wheel_that_locks_yields_as_in_one_direction_and_as_its_mirror_image() {
    let along = locked(&hot(false, |_| {}), 0.0);
    let [straight, right, left] = [HARDLY, 0.02, -0.02].map(|lateral| locked(&hot(true, |_| {}), lateral));
    let seen = |it: &Outputs| {
        [it.contact_force_x, it.contact_force_z, it.temperature_rail_max, it.contact_pressure_max, it.plastic_energy]
    };
    println!("{:?}\n{:?}\n{:?}\n{:?}", seen(&along), seen(&straight), seen(&right), seen(&left));
    let ratio = |of: fn(&Outputs) -> f64| of(&straight) / of(&along) - 1.0;
    round_off("sideways.locked.force", &[ratio(|it| it.contact_force_x)], 2e-4);
    round_off("sideways.locked.heat [K]", &[straight.temperature_rail_max - along.temperature_rail_max], 0.2);
    round_off("sideways.yields", &[ratio(|it| it.contact_pressure_max), ratio(|it| it.plastic_energy)], 1e-3);
    round_off("sideways.locked.mirror", &[right.contact_force_z / left.contact_force_z + 1.0], 1e-8);
    round_off("sideways.locked.mirror", &[right.contact_force_x / left.contact_force_x - 1.0], 1e-8);
    assert!(close(straight.contact_force_x, along.contact_force_x, 1e-3));
    assert!((straight.temperature_rail_max - along.temperature_rail_max).abs() < 2.0);
    assert!(close(straight.contact_pressure_max, along.contact_pressure_max, 2e-3));
    assert!(along.plastic_energy > 0.1 && close(straight.plastic_energy, along.plastic_energy, 1e-2));
    assert!(close(right.contact_force_z, -left.contact_force_z, 1e-6));
    assert!(close(right.contact_force_x, left.contact_force_x, 1e-6));
    // The slide turns into the direction of the slip.
    assert!(close(right.contact_force_z / right.contact_force_x, 0.02, 1e-2));
    assert!([&straight, &right].iter().all(|it| it.energy_residual.abs() < 1e-3));
}

/// Load, moment, friction and lateral motion change in every step while wear and yielding change the surfaces, and bodies are damped or heated by
/// compression.
#[test]
fn energy_is_kept_while_everything_varies_on_worn_flattened_and_even_surfaces() {
    type Change = fn(&mut Config);
    let cases: [(&str, Change); 5] = [
        ("even", |_| {}),
        ("damped", |config| config.damping = Damping::all(0.05)),
        ("reversibly heated", |config| config.physics.thermoelastic_heating = true),
        ("worn", |config| config.damage.wear = Wear::TGamma),
        ("flattened", |config| config.wheel.profile = "flat(length=0.02)".to_owned()),
    ];
    for (name, change) in cases {
        let model = hot(true, change);
        let speed = model.config().initial.velocity;
        let seen = run(&model, Inputs::rolling(model.config()), (2e-4, 100), |inputs, t| {
            vary(inputs, t);
            inputs.drive.lateral_velocity = speed * 3e-3 * (250.0 * t).sin();
            inputs.drive.spin = 0.3 * (170.0 * t).cos();
        });
        let last = &seen[100];
        if ["even", "worn", "flattened"].contains(&name) {
            figure(&format!("sideways.energy.{name}"), &[last.energy_residual]);
        }
        println!("{name}: residual {:.1e} of {:.1} J", last.energy_residual, last.friction_energy);
        assert!(last.friction_energy > 1.0 && last.energy_residual.abs() < 2e-3, "{name}");
        // On a slope pressure pushes along, too, and its power counts as that of friction.
        let within = |it: &Outputs| {
            let force = it.contact_force_x.hypot(it.contact_force_z);
            force <= it.friction * it.contact_force_y * (1.0 + 1e-6) && it.friction_power >= 0.0
        };
        assert!(name == "flattened" || seen.iter().all(within), "{name}");
    }
}

/// Over a flat, with the force of braking held by the moment.
#[test]
fn a_flat_is_run_over_as_in_one_direction() {
    let over = |lateral: bool| {
        let model = hot(lateral, |config| config.wheel.profile = "flat(length=0.03)".to_owned());
        run(&model, Inputs::rolling(model.config()), (5e-4, 60), |inputs, _| {
            inputs.drive.moment = -4000.0;
            inputs.drive.lateral_velocity = if lateral { HARDLY } else { 0.0 };
        })
    };
    let [both, along] = [true, false].map(over);
    let farthest =
        |of: fn(&Outputs) -> f64| both.iter().zip(&along).map(|(a, b)| (of(a) - of(b)).abs()).fold(0.0, f64::max);
    let [normal, force] = [farthest(|it| it.contact_force_y), farthest(|it| it.contact_force_x)];
    figure("sideways.flat [N]", &[normal, force]);
    println!("largest differences {normal:.1} N, {force:.1} N");
    assert!(normal < 1e2 && force < 3e2);
}

/// Melting decides from node to node, so that runs scatter by some thousandths.
#[test]
fn a_surface_that_melts_slides_as_in_one_direction() {
    let melting = |config: &mut Config| (config.material.latent_heat, config.initial.velocity) = (2.7e5, 40.0);
    let [along, both] = [false, true].map(|lateral| locked(&hot(lateral, melting), if lateral { HARDLY } else { 0.0 }));
    round_off("sideways.melting.force", &[both.contact_force_x / along.contact_force_x - 1.0], 5e-3);
    round_off("sideways.melting.heat [K]", &[both.temperature_rail_max - along.temperature_rail_max], 5.0);
    println!(
        "{} N at {} K, {} N at {} K",
        along.contact_force_x, along.temperature_rail_max, both.contact_force_x, both.temperature_rail_max
    );
    assert!(close(both.contact_force_x, along.contact_force_x, 2e-2));
    assert!(close(both.temperature_rail_max, along.temperature_rail_max, 1e-2));
    assert!(close(both.friction_energy, along.friction_energy, 5e-3));
}
