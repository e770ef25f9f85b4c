//! Heat coupled to the rolling contact: balances, time-step independence, extreme slides, feedback.

use crate::common;
use crate::common::*;
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};
use wheelrail::analytic::flash_temperature;
use wheelrail::config::{Config, CrossSection, StartTemperature};
use wheelrail::simulation::{Inputs, Rotation, Simulation, Translation};

#[test]
fn friction_power_is_traction_times_slip_and_all_of_it_becomes_heat() {
    let mut config = preset("railway", 10);
    config.thermal.heat_ratio = 0.9;
    config.initial.velocity = 15.0;
    let model = model(config);
    let mut inputs = Inputs::rolling(model.config());
    let mut simulation = Simulation::new(model.clone(), &inputs).unwrap();
    let (mut friction, mut heat) = (0.0, 0.0);
    for k in 0..400 {
        inputs.drive.moment = -9000.0 * (k as f64 / 100.0).min(1.0);
        simulation.advance(&inputs, 1e-3).unwrap();
        let o = simulation.outputs();
        friction += 1e-3 * o.friction_power;
        heat += 1e-3 * (o.heat_to_wheel + o.heat_to_rail);
        assert!(
            (o.heat_to_wheel + o.heat_to_rail - 0.9 * o.friction_power).abs() <= 1e-9 * o.friction_power.abs() + 1e-9
        );
        assert!(o.heat_residual.abs() < 1e-9, "{}", o.heat_residual);
    }
    println!("friction work {friction:.3} J, heat {heat:.3} J");
    assert!(friction > 50.0 && (heat / friction - 0.9).abs() < 1e-6);
}

/// Lines become wider and narrower with the load, also within a step.
#[test]
fn all_friction_of_lines_becomes_heat_in_long_steps_of_a_load_that_swings() {
    for (name, h) in [("railway_ellipse", 5e-3_f64), ("railway_ellipse", 2e-2), ("railway_s1002_3mm", 1e-2)] {
        let mut config = preset(name, 6);
        config.initial.velocity = 20.0;
        let model = model(config);
        let mut inputs = Inputs::rolling(model.config());
        let mut simulation = Simulation::new(model, &inputs).unwrap();
        let load = |t: f64| 1e5 * (1.0 + 0.5 * (10.0 * PI * t).sin());
        let (mut worst, mut divided) = (0.0_f64, 0);
        for k in 0..(0.2 / h).round() as usize {
            let [from, to] = [k, k + 1].map(|k| k as f64 * h);
            inputs.drive.torque = 9e3 * (to / 0.1).min(1.0);
            (inputs.drive.load, inputs.rate.load) = (load(from), (load(to) - load(from)) / h);
            simulation.advance(&inputs, h).unwrap();
            let o = simulation.outputs();
            worst = worst.max(((o.heat_to_wheel + o.heat_to_rail) / o.friction_power - 1.0).abs());
            divided += usize::from(o.internal_steps > 1);
        }
        println!("{name}, steps of {h} s, {divided} of them divided: heat off by {worst:.1e} of friction");
        assert!(divided > 3 && worst < 1e-9, "{worst}");
    }
}

#[test]
fn peak_temperature_of_a_slide_does_not_depend_on_the_step() {
    let config = preset("railway", 20);
    let model = model(config);
    let peak = |h: f64| {
        let mut inputs = prescribed(&model, 20.0, 0.0);
        let mut simulation = Simulation::new(model.clone(), &inputs).unwrap();
        let steps = (0.12 / h).round() as usize;
        let mut peak = (0.0f64, 0.0f64);
        for k in 1..=steps {
            inputs.drive.omega = 20.0 / 0.46 * (1.0 - k as f64 * h / 0.1).max(0.0);
            simulation.advance(&inputs, h).unwrap();
            peak.0 = peak.0.max(simulation.outputs().temperature_wheel_max);
            peak.1 = peak.1.max(simulation.outputs().temperature_rail_max);
        }
        (peak.0 - 293.0, peak.1 - 293.0)
    };
    let (coarse, fine) = (peak(1e-3), peak(1e-5));
    figure("flash.step", &[coarse.0 / fine.0 - 1.0]);
    figure("flash.step", &[coarse.1 / fine.1 - 1.0]);
    println!("peak rise {coarse:?} K with 1 ms, {fine:?} K with 10 us");
    assert!((coarse.0 / fine.0 - 1.0).abs() < 0.01 && (coarse.1 / fine.1 - 1.0).abs() < 0.01);
}

#[test]
fn locked_wheel_slides_to_rest_with_finite_temperatures() {
    let mut config = preset("railway", 8);
    config.initial.velocity = 16.0;
    // Resolved, the torsion winds up the tread until the patch leaves the candidate zone.
    config.tuning.tolerance = 0.0;
    config.thermal.max_speed = 30.0;
    let (heat_ratio, width, reference) =
        (config.thermal.heat_ratio, config.model.contact_width, config.thermal.reference);
    let model = model(config.clone());
    let mut inputs = Inputs::rolling(model.config());
    let mut simulation = Simulation::new(model.clone(), &inputs).unwrap();
    // Wet rail, too strong a brake: the wheel locks; the rail dries after a second and a half.
    inputs.drive.friction = 0.08;
    inputs.drive.moment = -8000.0;
    // The flash temperature is in proportion to Q/√(a v).
    let m = &config.material;
    let unit = flash_temperature(1.0, 1.0, 1.0, (m.conductivity * m.density * m.specific_heat).sqrt());
    let (mut hottest, mut all_to_rail, mut locked) = (0.0f64, 0.0f64, false);
    let mut time = 0.0;
    while simulation.outputs().wheel_velocity > 0.05 {
        if !locked && simulation.outputs().wheel_omega < 0.5 {
            (inputs.rotation, inputs.drive.omega, locked) = (Rotation::Velocity, 0.0, true);
        }
        inputs.drive.friction = if time > 1.5 { 0.25 } else { 0.08 };
        simulation.advance(&inputs, 2e-3).unwrap();
        time += 2e-3;
        let o = simulation.outputs();
        hottest = hottest.max(o.temperature_wheel_max).max(o.temperature_rail_max);
        if locked && o.wheel_velocity > 1.0 {
            let heat = heat_ratio * o.friction_power / width;
            let flash = unit * heat / (o.contact_half_width * o.wheel_velocity).sqrt();
            all_to_rail = all_to_rail.max(reference + flash);
        }
        assert!(o.temperature_wheel_max.is_finite() && o.temperature_wheel_max > 290.0);
        assert!(time < 60.0, "still {} m/s", o.wheel_velocity);
    }
    let o = simulation.outputs();
    println!("at rest after {time:.2} s, hottest {hottest:.0} K, above Ac1 {:.2} s", o.austenitised_time);
    figure("slide.energy", &[o.energy_residual]);
    round_off("slide.heat", &[o.heat_residual], 1e-12);
    println!("energy residual {:+.2e}, heat residual {:+.1e}", o.energy_residual, o.heat_residual);
    println!("flash temperature of a rail that takes all heat {all_to_rail:.0} K");
    // Most heat leaves with the rail. The pressure of a hot, expanding patch is no ellipse: within a fifth.
    let ratio = (hottest - reference) / (all_to_rail - reference);
    assert!(locked && (ratio - 1.0).abs() < 0.2, "{ratio:.3}");
    assert!(o.energy_residual.abs() < 0.01 && o.heat_residual.abs() < 1e-6);
}

/// Radial growth of the rim of a uniformly warm annulus in plane strain whose hub neither grows nor warms [m].
///
/// `u = A r + B/r` with `u(r_i) = 0` and `σ_r(r_o) = 2(λ+μ)A − 2μB/r_o² − (3λ+2μ)αT = 0` (Timoshenko & Goodier, *Theory
/// of Elasticity*, section 150).
fn growth_on_rigid_hub(config: &Config, warmth: f64) -> f64 {
    let (ro, ri, m) = (config.wheel.radius, config.wheel.hub_radius, &config.material);
    let nu = m.poissons_ratio;
    let shear = 0.5 * m.youngs_modulus / (1.0 + nu);
    let lambda = 2.0 * shear * nu / (1.0 - 2.0 * nu);
    let heating = (3.0 * lambda + 2.0 * shear) * m.expansion * warmth;
    let a = heating / (2.0 * (lambda + shear) + 2.0 * shear * ri * ri / (ro * ro));
    a * (ro - ri * ri / ro)
}

#[test]
fn full_slide_of_two_fast_surfaces_reaches_the_flash_temperature() {
    let mut config = preset("railway", 20);
    (config.tuning.falling_ratio, config.tuning.softening) = (1.0, 0.0);
    config.material.expansion = 0.0;
    config.thermal.conductance = 1e9;
    // The closed form is that of the plane, in which nothing yields or melts.
    config.physics.yielding = false;
    config.material.latent_heat = 0.0;
    config.thermal.cross_section = CrossSection::Contact;
    config.initial.temperature = StartTemperature::Stationary;
    let model = model(config.clone());
    // The rail streams past at 20 m/s, the tread at 10 m/s.
    let inputs = prescribed(&model, 20.0, 2.0 / 3.0);
    let simulation = Simulation::new(model, &inputs).unwrap();
    let o = simulation.outputs();
    let (rail, tread) = (o.wheel_velocity, o.wheel_omega * config.wheel.radius);
    let heat = config.thermal.heat_ratio * o.friction_power / config.model.contact_width;
    // Equal temperatures on both sides divide the heat in proportion to √v: √v_rail + √v_wheel act together.
    let together = (rail.sqrt() + tread.sqrt()).powi(2);
    let m = &config.material;
    let effusivity = (m.conductivity * m.density * m.specific_heat).sqrt();
    let expected = flash_temperature(heat, o.contact_half_width, together, effusivity);
    // The tread comes round warm from the pass before: the flash temperature is the rise over that.
    let arriving = o.profile_temperature_wheel.last().unwrap() - config.thermal.reference;
    let share = tread.sqrt() / (rail.sqrt() + tread.sqrt());
    let rise = o.temperature_rail_max - config.thermal.reference - share * arriving;
    println!(
        "rail {rail} m/s, tread {tread:.2} m/s: {rise:.2} K over {arriving:.2} K, flash temperature {expected:.2} K ({:+.2} %)",
        100.0 * (rise / expected - 1.0)
    );
    assert!((rise / expected - 1.0).abs() < 0.02);
}

#[test]
fn a_warm_wheel_in_plane_strain_grows_by_the_thermoelastic_annulus() {
    let mut config = preset("railway", 10);
    (config.thermal.wheel_excess, config.thermal.cross_section) = (60.0, CrossSection::Contact);
    let model = model(config.clone());
    let simulation = Simulation::new(model, &Inputs::rolling(&config)).unwrap();
    let o = simulation.outputs();
    let bulk = o.temperature_wheel_bulk - config.thermal.reference;
    let expected = growth_on_rigid_hub(&config, bulk);
    println!("growth {:.9e} m, annulus {expected:.9e} m, bulk {bulk:.3} K over the reference", o.thermal_growth);
    // The start is iterated until contact and temperatures agree, to a little more than six digits.
    assert!((o.thermal_growth / expected - 1.0).abs() < 1e-6);
    // Warm but for the cold hub, and a stationary contact that takes and gives a little heat.
    assert!((bulk / 60.0 - 1.0).abs() < 0.03);
    // It rolls with the radius that it has: only what the tread gives to the rail in passing shifts the creepage.
    let mut cold = config.clone();
    cold.thermal.wheel_excess = 0.0;
    let reference = Simulation::new(common::model(cold.clone()), &Inputs::rolling(&cold)).unwrap();
    let shift = o.contact_creepage - reference.outputs().contact_creepage;
    println!("creepage shifted by {shift:e}, force {} N", o.contact_force_x);
    assert!(shift.abs() < 1e-5, "{shift:e}");
    assert!(o.contact_force_x.abs() < 0.1, "{}", o.contact_force_x);
    assert!(o.contact_approach < reference.outputs().contact_approach);
}

#[test]
fn falling_friction_lowers_the_force_of_a_fast_slide_exactly() {
    let mut config = preset("railway", 10);
    (config.tuning.falling_ratio, config.tuning.falling_decay, config.tuning.softening) = (0.4, 0.6, 0.0);
    let model = model(config);
    let inputs = prescribed(&model, 20.0, 0.2);
    let simulation = Simulation::new(model, &inputs).unwrap();
    let o = simulation.outputs();
    let expected = 0.3 * (0.4 + 0.6 * (-0.6 * o.contact_tread_slip).exp());
    println!("tread slip {:.6} m/s, V - r omega {:.6} m/s", o.contact_tread_slip, o.contact_slip_velocity);
    assert!((o.contact_tread_slip / o.contact_slip_velocity - 1.0).abs() < 0.01);
    assert!((o.friction / expected - 1.0).abs() < 1e-9);
    assert!((o.contact_force_x.abs() / (expected * o.contact_force_y) - 1.0).abs() < 1e-9);
}

#[test]
fn hot_contact_softens_friction_to_its_floor() {
    let mut config = preset("railway", 10);
    (config.tuning.softening, config.tuning.softening_floor) = (2e-2, 0.3);
    let model = model(config);
    let mut inputs = prescribed(&model, 20.0, 0.0);
    let mut simulation = Simulation::new(model, &inputs).unwrap();
    for k in 0..300 {
        inputs.drive.omega = 20.0 / 0.46 * (1.0 - 0.5 * (k as f64 / 100.0).min(1.0));
        simulation.advance(&inputs, 1e-3).unwrap();
    }
    let o = simulation.outputs();
    println!("friction {:.4} at {:.0} K", o.friction, o.temperature_wheel_mean);
    assert!((o.friction / (0.3 * 0.3) - 1.0).abs() < 1e-9);
    assert!((o.contact_utilisation - 1.0).abs() < 1e-9);
}

#[test]
fn brake_blocks_heat_the_tread_and_the_rail_chills_it() {
    let mut config = preset("paper_b", 10);
    config.initial.velocity = 50.0 * KMH;
    config.initial.temperature = StartTemperature::Stationary;
    let model = model(config);
    let mut inputs = Inputs::rolling(model.config());
    inputs.drive.tread_heat = 60.0;
    let simulation = Simulation::new(model, &inputs).unwrap();
    let o = simulation.outputs();
    println!(
        "wheel {:.5} K, rail {:.5} K, conduction {:.4} W",
        o.temperature_wheel_nominal - 293.0,
        o.temperature_rail_nominal - 293.0,
        o.heat_conduction
    );
    // Rail chill at 50 km/h: independent reference with a Hertzian patch.
    assert!(((o.temperature_wheel_nominal - 293.0) / 0.06039787 - 1.0).abs() < 0.01);
    assert!(((o.temperature_rail_nominal - 293.0) / 0.05080656 - 1.0).abs() < 0.01);
    assert!((o.heat_conduction / 60.0 - 1.0).abs() < 1e-6);
}

/// Two blocks on a standing wheel: the middle of the heat is a quarter of a turn from the contact on either side, and in the middle
/// of a block the tread is as warm as a half-space under the flux of half of the heat over 45° and 80 mm,
/// `2q √(t/(π kρc))` (Carslaw & Jaeger, *Conduction of Heat in Solids*, 2.9).
#[test]
fn blocks_heat_a_standing_wheel_in_their_middle_as_a_half_space_under_their_flux() {
    let (power, steps, step) = (2e6, 20, 1e-5);
    let mut config = preset("railway", 10);
    config.initial.velocity = 0.0;
    let radius = config.wheel.radius;
    let mut inputs = Inputs::rolling(&config);
    (inputs.rotation, inputs.translation) = (Rotation::Velocity, Translation::Velocity);
    let mut simulation = Simulation::new(model(config), &inputs).unwrap();
    inputs.drive.tread_heat = power;
    for _ in 0..steps {
        simulation.advance(&inputs, step).unwrap();
    }
    let [wheel, _] = simulation.temperature_fields().unwrap().unwrap();
    // Angle from the contact point, forward positive, and temperature of the tread.
    let nodes = wheel.mesh.nodes.iter().zip(&wheel.temperature);
    let mut tread: Vec<_> = nodes
        .filter(|([x, y], _)| (x.hypot(*y) / radius - 1.0).abs() < 1e-9)
        .map(|([x, y], t)| (x.atan2(-y), t - 293.0))
        .collect();
    tread.sort_by(|a, b| a.0.total_cmp(&b.0));
    let time = f64::from(steps) * step;
    let flux = 0.5 * power / (FRAC_PI_4 * radius * 0.08);
    let expected = 2.0 * flux * (time / (PI * 50.0 * 7850.0 * 470.0)).sqrt();
    for side in [1.0, -1.0] {
        let on_side: Vec<_> = tread.iter().filter(|(angle, _)| side * angle > 0.0).collect();
        let mut sums = [0.0; 2];
        for pair in on_side.windows(2) {
            let (length, mean) = (pair[1].0 - pair[0].0, 0.5 * (pair[0].1 + pair[1].1));
            sums[0] += length * mean;
            sums[1] +=
                length * (pair[0].0 * (2.0 * pair[0].1 + pair[1].1) + pair[1].0 * (pair[0].1 + 2.0 * pair[1].1)) / 6.0;
        }
        let middle = side * sums[1] / sums[0];
        let inner: Vec<f64> =
            on_side.iter().filter(|(angle, _)| (side * angle - FRAC_PI_2).abs() < 0.2).map(|(_, t)| *t).collect();
        let warm = inner.iter().sum::<f64>() / inner.len() as f64;
        println!("middle at {middle:.5} rad; {warm:.4} K at {} nodes, {expected:.4} K in closed form", inner.len());
        assert!((middle / FRAC_PI_2 - 1.0).abs() < 0.01, "{middle}");
        assert!((warm / expected - 1.0).abs() < 0.02, "{warm} for {expected}");
    }
}

#[test]
fn long_steps_do_not_undershoot_and_find_the_peak_of_a_ramp_within_fifteen_percent() {
    let mut config = preset("railway", 10);
    config.tuning.tolerance = 0.0;
    let model = model(config);
    // A wheel that spins too fast while the vehicle is stopped under it, in steps h; then friction vanishes.
    let extremes = |h: f64| {
        let mut inputs = prescribed(&model, 20.0, 0.0);
        let mut simulation = Simulation::new(model.clone(), &inputs).unwrap();
        for k in 0..100 {
            inputs.drive.omega = 20.0 / 0.46 + 23.5 * (k as f64 / 50.0).min(1.0);
            simulation.advance(&inputs, 1e-3).unwrap();
        }
        let (mut lowest, mut highest) = (f64::INFINITY, 0.0f64);
        let steps = (0.2 / h).round() as usize;
        for k in 1..=steps + 1 {
            inputs.drive.velocity = 20.0 - 19.5 * (k as f64 / steps as f64).min(1.0);
            inputs.drive.friction = if k > steps { 0.0 } else { 0.3 };
            simulation.advance(&inputs, h).unwrap();
            let o = simulation.outputs();
            highest = highest.max(o.temperature_wheel_max).max(o.temperature_rail_max);
            let points = o.profile_temperature_wheel.iter().chain(&o.profile_temperature_rail);
            lowest = points.fold(lowest, |low, t| low.min(*t));
        }
        println!("h = {h} s: {lowest:.3} to {highest:.3} K");
        (lowest, highest)
    };
    let (_, fine) = extremes(1e-3);
    // The slip at the end of a step is held over the step: what is too hot grows with the step.
    for (h, limit) in [(0.01, 0.03), (0.02, 0.07), (0.1, 0.15), (0.2, 0.15)] {
        let (lowest, highest) = extremes(h);
        let excess = (highest - 293.0) / (fine - 293.0) - 1.0;
        assert!(lowest > 293.0 - 1e-4 * (fine - 293.0), "h = {h} s: {lowest} K");
        assert!((-0.01..limit).contains(&excess), "h = {h} s: {excess:+.3}");
    }
}
