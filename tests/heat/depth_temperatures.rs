//! Temperatures over the depth: below the contact they are those of the fields and of closed forms, and a point of the
//! tread takes its own along when the wheel turns.

use crate::common::{self, KMH, model, preset};
use std::f64::consts::{PI, TAU};
use wheelrail::config::{Config, CrossSection};
use wheelrail::simulation::{Inputs, Outputs, Rotation, Simulation, TemperatureField, Translation};

/// `erf x` by its series, for |x| below 3.
fn erf(x: f64) -> f64 {
    let (mut term, mut sum) = (x, x);
    for n in 1..120 {
        term *= -x * x / n as f64;
        sum += term / (2 * n + 1) as f64;
    }
    2.0 / PI.sqrt() * sum
}

/// A simulation with prescribed speeds.
fn held(config: Config, velocity: f64, omega: f64) -> (Simulation, Inputs) {
    let mut inputs = Inputs::rolling(&config);
    (inputs.rotation, inputs.translation) = (Rotation::Velocity, Translation::Velocity);
    (inputs.drive.velocity, inputs.drive.omega) = (velocity, omega);
    (Simulation::new(model(config), &inputs).unwrap(), inputs)
}

/// A warm wheel that stands on a cold rail of the same steel: `T = ½ ΔT (1 ± erf(z/2√κt))` as long as `√κt` is small
/// beside the patch (Carslaw and Jaeger, *Conduction of Heat in Solids*, 2.15).
#[test]
fn a_standing_warm_wheel_cools_over_the_depth_as_half_spaces_in_contact_do() {
    let mut config = preset("railway", 20);
    config.thermal.cross_section = CrossSection::Contact;
    config.thermal.wheel_excess = 200.0;
    (config.material.expansion, config.initial.velocity) = (0.0, 0.0);
    let diffusivity = config.material.conductivity / (config.material.density * config.material.specific_heat);
    let (reference, excess) = (config.thermal.reference, config.thermal.wheel_excess);
    let (mut simulation, inputs) = held(config, 0.0, 0.0);
    let mut worst = 0.0f64;
    for k in 1..=40 {
        simulation.advance(&inputs, 1e-3).unwrap();
        if k % 20 > 0 {
            continue;
        }
        let time = simulation.time();
        let o = simulation.all_outputs();
        for (z, (wheel, rail)) in o.profile_depth.iter().zip(o.profile_wheel_below.iter().zip(&o.profile_rail_below)) {
            let share = z / (2.0 * (diffusivity * time).sqrt());
            let half = 0.5 * excess * if share < 3.0 { erf(share) } else { 1.0 };
            for (found, exact) in [(wheel, 0.5 * excess + half), (rail, 0.5 * excess - half)] {
                worst = worst.max((found - reference - exact).abs() / excess);
            }
        }
    }
    common::figure("depth.standing", &[worst]);
    println!("up to {worst:.2e} of the difference of temperatures");
    assert!(worst < 7e-3, "{worst}");
}

/// Temperature of the surface of the wheel at a distance along the tread, linear between the nodes of the field.
fn surface(field: &TemperatureField, radius: f64, s: f64) -> f64 {
    let on_tread = |p: &[f64; 2]| ((p[0]).hypot(p[1]) - radius).abs() < 1e-9 * radius;
    let nodes = field.mesh.nodes.iter().zip(&field.temperature).filter(|(p, _)| on_tread(p));
    let mut nodes: Vec<_> = nodes.map(|(p, t)| (radius * p[0].atan2(-p[1]), *t)).collect();
    nodes.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (first, last) = (nodes[0], nodes[nodes.len() - 1]);
    let round = TAU * radius;
    nodes.insert(0, (last.0 - round, last.1));
    nodes.push((first.0 + round, first.1));
    let next = nodes.partition_point(|(place, _)| *place <= s);
    let ((from, a), (to, b)) = (nodes[next - 1], nodes[next]);
    a + (b - a) * (s - from) / (to - from)
}

/// A braked wheel makes a turn; its tread point was hot when it left the contact and is cooled by the rail when it
/// returns.
#[test]
fn a_point_of_the_tread_has_over_a_turn_the_temperatures_that_the_field_has_where_it_is() {
    let mut config = preset("railway", 10);
    (config.thermal.wheel_excess, config.tuning.tread_point) = (20.0, 1.0);
    let (radius, velocity) = (config.wheel.radius, 50.0 * KMH);
    let (mut simulation, inputs) = held(config, velocity, 0.97 * velocity / radius);
    let (step, mut worst, mut turned, mut swing) = (1e-3, 0.0f64, 0.0, [f64::INFINITY, f64::NEG_INFINITY]);
    while turned < TAU {
        simulation.advance(&inputs, step).unwrap();
        let [field, _] = simulation.temperature_fields().unwrap().unwrap();
        let o = simulation.all_outputs();
        turned = o.wheel_angle;
        let s = radius * ((1.0 - turned + PI).rem_euclid(TAU) - PI);
        worst = worst.max((o.profile_tread_below[0] - surface(&field, radius, s)).abs());
        swing = [swing[0].min(o.profile_tread_below[0]), swing[1].max(o.profile_tread_below[0])];
        // At the contact point both columns begin with the surface.
        let beside = |below: &[f64], surface: f64| (below[0] - surface).abs();
        worst = worst.max(beside(&o.profile_wheel_below, o.temperature_wheel_nominal));
        worst = worst.max(beside(&o.profile_rail_below, o.temperature_rail_nominal));
    }
    common::round_off("depth.tread [K]", &[worst], 1e-9);
    println!("up to {worst:.1e} K from the field; the point was at {:.2} to {:.2} K", swing[0], swing[1]);
    assert!(worst < 1e-6 && swing[1] - swing[0] > 5.0);
}

/// Looked at where it touches, the point of the tread is that below the contact.
#[test]
fn the_point_of_the_tread_may_be_chosen_during_a_run() {
    let config = preset("railway", 10);
    let (radius, velocity) = (config.wheel.radius, 50.0 * KMH);
    let (mut simulation, inputs) = held(config, velocity, 0.97 * velocity / radius);
    for _ in 0..20 {
        simulation.advance(&inputs, 1e-3).unwrap();
    }
    let mut tuning = simulation.tuning().clone();
    tuning.tread_point = simulation.outputs().wheel_angle + 1e-3 * inputs.drive.omega;
    simulation.retune(&tuning);
    simulation.advance(&inputs, 1e-3).unwrap();
    let o = simulation.all_outputs();
    let largest =
        o.profile_tread_below.iter().zip(&o.profile_wheel_below).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    println!("{largest:.1e} K apart");
    assert!(largest < 1e-6, "{largest}");
}

/// A place that the locked wheel heats is followed on a mesh of its own when the wheel turns again: below the tread
/// point no temperature is higher than the highest so far, and the surface cools from turn to turn.
#[test]
fn a_hot_place_takes_its_temperatures_along() {
    let mut config = preset("railway", 10);
    config.initial.velocity = 60.0 * KMH;
    let (velocity, rolling) = (60.0 * KMH, 60.0 * KMH / config.wheel.radius);
    let (mut simulation, mut inputs) = held(config, velocity, rolling);
    let mut advance = |simulation: &mut Simulation, omega: f64, steps: usize, seen: &mut dyn FnMut(&Outputs)| {
        inputs.drive.omega = omega;
        for _ in 0..steps {
            simulation.advance(&inputs, 1e-3).unwrap();
            seen(simulation.all_outputs());
        }
    };
    for k in 1..=20 {
        advance(&mut simulation, rolling * (1.0 - f64::from(k) / 20.0), 1, &mut |_| {});
    }
    let mut tuning = simulation.tuning().clone();
    tuning.tread_point = simulation.outputs().wheel_angle;
    simulation.retune(&tuning);
    let mut apart = 0.0f64;
    advance(&mut simulation, 0.0, 100, &mut |o| {
        let below = o.profile_tread_below.iter().zip(&o.profile_wheel_below);
        apart = below.map(|(a, b)| (a - b).abs()).fold(apart, f64::max);
    });
    let hot = simulation.all_outputs().profile_tread_below[0];
    let mut over = f64::NEG_INFINITY;
    let mut surface = Vec::new();
    for _ in 0..4 {
        advance(&mut simulation, rolling, 60, &mut |o| {
            let below = o.profile_tread_below.iter().zip(&o.profile_peak);
            over = below.map(|(now, peak)| now - peak).fold(over, f64::max);
        });
        surface.push(simulation.all_outputs().profile_tread_below[0]);
    }
    println!(
        "locked: {hot:.0} K, columns {apart:.1} K apart; then {surface:.0?} K, at most {over:.1e} K over the peak"
    );
    assert!(hot > 700.0 && apart < 0.05 * (hot - 293.0));
    assert!(surface.windows(2).all(|pair| pair[1] < pair[0]) && surface[0] < 0.7 * hot && over < 1.0);
    // The field that stands with the contact has smeared that place over an element of the tread.
    assert!(surface[3] > simulation.outputs().temperature_wheel_bulk + 20.0);
}
