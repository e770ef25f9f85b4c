//! Limits of the model of which a run is warned: each in a case beyond it, none in ordinary rolling.

use crate::common::*;
use wheelrail::config::{Config, Damping, Tuning};
use wheelrail::simulation::validity::Limit;
use wheelrail::simulation::{Inputs, Rotation, Simulation, Translation};

fn limits(simulation: &Simulation) -> Vec<Limit> {
    simulation.exceeded_limits().collect()
}

fn small(change: impl Fn(&mut Config)) -> Config {
    let mut config = preset("railway", 8);
    change(&mut config);
    config
}

fn at_start(config: Config) -> Simulation {
    let inputs = Inputs::rolling(&config);
    Simulation::new(model(config), &inputs).unwrap()
}

#[test]
fn ordinary_rolling_is_within_all_limits() {
    assert_eq!(limits(&at_start(small(|_| {}))), []);
}

#[test]
fn pressure_beyond_what_steel_carries_is_told_with_both_numbers() {
    let simulation = at_start(small(|config| {
        config.thermal.enabled = false;
        config.model.contact_width = 0.0025;
        config.physics.yielding = false;
    }));
    assert_eq!(limits(&simulation), [Limit::Yield]);
    let text = simulation.describe_limit(Limit::Yield);
    let pressure = format!("{:.0} MPa", simulation.outputs().contact_pressure_max * 1e-6);
    assert!([&pressure, "1633 MPa", "model.contact_width"].iter().all(|word| text.contains(*word)), "{text}");
}

#[test]
fn contact_near_the_end_of_where_it_is_looked_for_is_told_before_it_is_refused_and_the_advice_helps() {
    let over_a_hole = |length: f64, reach: f64| {
        let config = small(|config| {
            config.thermal.enabled = false;
            config.mesh.reach = reach;
            config.rail.profile = format!("hole(length = {length}, depth = 0.005, position = 0)");
        });
        let inputs = Inputs::rolling(&config);
        Simulation::new(model(config), &inputs).map(|simulation| (limits(&simulation), simulation))
    };
    let (near, simulation) = over_a_hole(0.042, 0.0).unwrap();
    assert!(near.contains(&Limit::Reach));
    let text = simulation.describe_limit(Limit::Reach);
    println!("{text}");
    let advised = text.split("m) to ").nth(1).and_then(|rest| rest.split(' ').next()).unwrap().parse().unwrap();
    assert!(!over_a_hole(0.02, 0.0).unwrap().0.contains(&Limit::Reach));
    assert!(over_a_hole(0.05, 0.0).is_err());
    assert!(!over_a_hole(0.042, advised).unwrap().0.contains(&Limit::Reach));
}

/// Largest difference of the contact force from that in steps of at most 10 µs, over the load, of a wheel with `profile` in
/// steps of 1 ms, and the limits that these exceed but for that of the coarse mesh; the balance of energy tells as the FMU does.
fn error_of_usual_steps(profile: &str, velocity: f64, steps: usize) -> (f64, Vec<Limit>) {
    let course = |max_step: f64, tolerance: f64| {
        let mut config = preset("railway", 6);
        (config.thermal.enabled, config.wheel.profile) = (false, profile.into());
        (config.tuning.max_step, config.tuning.tolerance) = (max_step, tolerance);
        let model = model(config);
        let inputs = prescribed(&model, velocity, 0.0);
        let mut simulation = Simulation::new(model, &inputs).unwrap();
        let (mut told, mut heights, mut forces) = (Vec::new(), [f64::MAX, f64::MIN], Vec::new());
        for _ in 0..steps {
            simulation.advance(&inputs, 1e-3).unwrap();
            let outputs = simulation.outputs();
            heights = [heights[0].min(outputs.hub_height), heights[1].max(outputs.hub_height)];
            let rise = heights[1] - heights[0];
            told.extend(
                simulation
                    .exceeded_limits()
                    .filter(|l| *l != Limit::Waves && (*l != Limit::Energy || simulation.loses_energy(rise))),
            );
            forces.push(outputs.contact_force_y);
        }
        (forces, told)
    };
    let ((exact, _), (usual, told)) = (course(1e-5, 0.0), course(0.1, 2e-3));
    let error = exact.iter().zip(&usual).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    (error / 1e5, told)
}

#[test]
fn a_polygon_that_steps_resolve_within_two_per_cent_of_the_load_is_not_called_inexact() {
    let (error, told) = error_of_usual_steps("polygon(order = 5, amplitude = 1e-4)", 20.0, 150);
    println!("error {error:.4} of the load, told {told:?}");
    assert!(error < 0.02 && told.is_empty(), "{error} {told:?}");
}

#[test]
fn a_melting_contact_is_told() {
    let simulation = at_start(small(|config| {
        config.thermal.wheel_excess = 1500.0;
        config.material.latent_heat = 0.0;
    }));
    assert!(limits(&simulation).contains(&Limit::Melting), "{:?}", limits(&simulation));
    assert!(simulation.describe_limit(Limit::Melting).contains("1723 K"));
}

/// Without the film that takes friction from molten steel a locked wheel is heated as long as it slides. With it steel never
/// boils.
#[test]
fn steel_above_the_boiling_point_of_iron_is_told_with_its_temperature() {
    let slide = |film_friction: f64| {
        let mut config = preset("railway_dry", 8);
        (config.initial.velocity, config.material.film_friction) = (20.0, film_friction);
        let mut inputs = Inputs::rolling(&config);
        (inputs.rotation, inputs.translation) = (Rotation::Velocity, Translation::Velocity);
        let mut simulation = Simulation::new(model(config), &inputs).unwrap();
        let omega = inputs.drive.omega;
        let boils = |simulation: &Simulation| limits(simulation).contains(&Limit::Boiling);
        let ends = (1..=100).find(|k| {
            inputs.drive.omega = omega * (1.0 - f64::from(*k) / 20.0).max(0.0);
            simulation.advance(&inputs, 1e-3).unwrap();
            boils(&simulation)
        });
        (ends, simulation)
    };
    let (boils, simulation) = slide(1.0);
    let text = simulation.describe_limit(Limit::Boiling);
    println!("after {boils:?} ms: {text}");
    let peak = format!("{:.0} K", simulation.outputs().peak_temperature.max(simulation.outputs().rail_peak));
    assert!(
        boils.is_some() && [&peak, "3134 K", "material.film_friction (now 1"].iter().all(|word| text.contains(*word)),
        "{text}"
    );
    let (never, simulation) = slide(0.02);
    assert!(never.is_none() && simulation.outputs().melted > 0.0);
}

#[test]
fn falling_friction_in_steps_that_cannot_show_stick_slip_is_told_and_the_advice_helps() {
    let mut config = preset("railway_dry", 8);
    config.thermal.enabled = false;
    let model = model(config);
    let mut inputs = prescribed(&model, 10.0, 0.0);
    inputs.rotation = Rotation::Velocity;
    let rolling = Simulation::new(model.clone(), &inputs).unwrap();
    assert_eq!(limits(&rolling), []);
    inputs.drive.omega = 9.0 / 0.46;
    let mut tuning = model.config().tuning.clone();
    let mut coarse = Simulation::new(model.clone(), &inputs).unwrap();
    coarse.advance(&inputs, 1e-3).unwrap();
    assert_eq!(limits(&coarse), [Limit::StickSlip]);
    // The step that the message names.
    let text = coarse.describe_limit(Limit::StickSlip);
    let step = text.split("solver.max_step to ").nth(1).and_then(|rest| rest.split(' ').next()).unwrap();
    tuning.max_step = step.parse().unwrap();
    println!("{text}");
    let mut fine = Simulation::start(model, tuning, &inputs).unwrap();
    fine.advance(&inputs, 1e-3).unwrap();
    assert_eq!(limits(&fine), []);
}

/// The closed form of its onset, `P |μ′| = 2 ζ ω m`, is that of `stick_slip`: at 9 m/s of slip friction of the dry rail
/// falls by 5e-4 to 1e-3 s/m, and of the wet one, at 2 m/s on a friction of 0.05, by 4e-3; 1e-2 would be needed.
#[test]
fn falling_friction_that_the_damping_of_the_wheel_outweighs_says_nothing_of_stick_slip() {
    for (name, friction, slip, told) in [
        ("railway_dry", 0.55, 1.0, true),
        ("railway_dry", 0.55, 9.0, false),
        ("railway_wet", 0.3, 2.0, true),
        ("railway_wet", 0.05, 2.0, false),
    ] {
        let mut config = preset(name, 8);
        config.thermal.enabled = false;
        let run = |damped: bool| {
            let mut config = config.clone();
            config.damping = if damped { config.damping } else { Damping::NONE };
            let model = model(config);
            let mut inputs = prescribed(&model, 10.0, 0.0);
            (inputs.rotation, inputs.drive.friction) = (Rotation::Velocity, friction);
            inputs.drive.omega = (10.0 - slip) / 0.46;
            let mut simulation = Simulation::new(model, &inputs).unwrap();
            simulation.advance(&inputs, 1e-3).unwrap();
            limits(&simulation).contains(&Limit::StickSlip)
        };
        println!("{name}, friction {friction}, slip {slip} m/s: told {}, undamped {}", run(true), run(false));
        assert_eq!((run(true), run(false)), (told, true), "{name} {friction} {slip}");
    }
}

#[test]
fn falling_friction_without_memory_is_told_in_steps_in_which_it_has_no_definite_value() {
    let mut config = preset("railway_dry", 8);
    config.thermal.enabled = false;
    let memory = config.tuning.memory_length;
    config.initial.velocity = 2.0;
    let model = model(config);
    let mut inputs = prescribed(&model, 2.0, 0.0);
    inputs.drive.omega = 1.0 / 0.46;
    let told = |length: f64, step: f64| {
        let tuning = Tuning { memory_length: length, ..model.config().tuning.clone() };
        let mut simulation = Simulation::start(model.clone(), tuning, &inputs).unwrap();
        // Friction without a definite value lets the contact stick and slip in turn: it is told of where it slips.
        let told = (0..4).any(|_| {
            simulation.advance(&inputs, step).unwrap();
            limits(&simulation).contains(&Limit::Chatter)
        });
        if told {
            println!("{}", simulation.describe_limit(Limit::Chatter));
        }
        told
    };
    assert!(told(1e-12, 5e-6));
    assert!(!told(0.0, 5e-6), "friction that falls has a memory by itself");
    assert!(!told(1e-12, 2e-4), "in long steps the rest of the wheel answers");
    assert!(!told(memory, 5e-6), "the memory of the preset is long enough");
}

/// Errors that the warning of short patches tells are those against four times as many nodes.
#[test]
fn short_patches_are_told_with_the_size_of_their_errors() {
    for (name, shares) in
        [("railway", [3.5e-3, 4e-3, 5e-3, 6e-3, 8e-3]), ("railway_ellipse", [1.1e-3, 1.3e-3, 1.6e-3, 2e-3, 2.8e-3])]
    {
        for share in shares {
            let seen = |elements: usize| {
                let mut config = preset(name, 20);
                config.thermal.enabled = false;
                // Nodes do not follow the load where surfaces have a profile.
                config.rail.profile = "sinusoid(amplitude = 1e-9, wavelength = 0.5)".into();
                config.mesh.grid_elements_per_half_width = elements;
                let model = model(config);
                let growth = if name == "railway" { f64::sqrt(share) } else { f64::cbrt(share) };
                let mut inputs = prescribed(&model, 20.0, -1e-3 * growth);
                inputs.drive.load = 1e5 * share;
                let simulation = Simulation::new(model, &inputs).unwrap();
                let o = simulation.outputs();
                let force = o.contact_force_x / (o.friction * o.contact_force_y);
                let text = limits(&simulation).contains(&Limit::Patch).then(|| simulation.describe_limit(Limit::Patch));
                (text, [o.contact_pressure_max, o.contact_half_width, force])
            };
            let ((told, found), (_, right)) = (seen(20), seen(80));
            let told = told.unwrap();
            let percents: Vec<f64> =
                told.split(" %").filter_map(|part| part.rsplit(' ').next()?.parse().ok()).collect();
            let errors =
                [found[0] / right[0] - 1.0, found[1] / right[1] - 1.0, found[2] - right[2]].map(|e| 1e2 * e.abs());
            println!("{name}, {share}: pressure, length, force {errors:.2?} %, told {percents:?}");
            assert!(percents.len() == 2 && errors[0].max(errors[1]) < percents[0] && errors[2] < percents[1], "{told}");
        }
    }
}

/// A limit that is exceeded, and the run that obeys its advice: whether it is left, and the error of a quantity before and
/// after against that of a much finer run.
fn obeyed(limit: Limit, run: impl Fn(f64) -> (Vec<Limit>, f64), values: [f64; 3]) -> [f64; 2] {
    let [(before, found), (after, better), (_, reference)] = values.map(&run);
    assert!(before.contains(&limit) && !after.contains(&limit), "{limit:?}: {before:?}, {after:?}");
    let errors = [found, better].map(|value| (value / reference - 1.0).abs());
    println!("{limit:?}: error {:.2e}, obeyed {:.2e}", errors[0], errors[1]);
    errors
}

#[test]
fn meshes_that_follow_the_advice_of_their_warnings_bring_the_error_down() {
    let sliding = |max_speed: f64| {
        let mut config = preset("railway", 10);
        config.thermal.max_speed = max_speed;
        let model = model(config);
        let mut simulation = Simulation::new(model.clone(), &prescribed(&model, 50.0, 0.02)).unwrap();
        (0..50).for_each(|_| simulation.advance(&prescribed(&model, 50.0, 0.02), 1e-3).unwrap());
        (limits(&simulation), simulation.outputs().temperature_wheel_max)
    };
    let [before, after] = obeyed(Limit::Speed, sliding, [10.0, 50.0, 150.0]);
    assert!(after < 0.5 * before);

    let lightly = |elements: f64| {
        let mut config = preset("railway", 5);
        config.thermal.enabled = false;
        config.rail.profile = "sinusoid(amplitude = 1e-9, wavelength = 0.2)".into();
        config.mesh.grid_elements_per_half_width = elements as usize;
        let model = model(config);
        let mut inputs = prescribed(&model, 20.0, 5e-4);
        inputs.drive.load = 1e3;
        let simulation = Simulation::new(model, &inputs).unwrap();
        (limits(&simulation), simulation.outputs().contact_pressure_max)
    };
    let [before, after] = obeyed(Limit::Patch, lightly, [10.0, 25.0, 80.0]);
    assert!(after < 0.5 * before);

    let rough = |elements: f64| {
        let mut config = preset("railway", 5);
        config.thermal.enabled = false;
        config.rail.profile = "sinusoid(amplitude = 2e-6, wavelength = 0.003)".into();
        config.mesh.grid_elements_per_half_width = elements as usize;
        let inputs = Inputs::rolling(&config);
        let simulation = Simulation::new(model(config), &inputs).unwrap();
        (limits(&simulation), simulation.outputs().contact_pressure_max)
    };
    let [before, after] = obeyed(Limit::Waves, rough, [5.0, 10.0, 40.0]);
    assert!(after < 0.5 * before);
}
