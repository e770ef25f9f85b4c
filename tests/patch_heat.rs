//! The contact on a single smooth patch in runs with heat, `solver.contact = auto` and `patch`, whose layers swell and
//! pull at the bodies: against the contact on the grid, also on finer ones.

mod common;
use common::*;
use wheelrail::config::{ContactMethod, StartTemperature};
use wheelrail::simulation::{Inputs, Outputs, Simulation};

/// A wheel with heat whose moment rises over 50 ms, `share` of the load and of the moment; outputs after every step.
fn heated(method: ContactMethod, elements: usize, share: f64, moment: f64, step: f64) -> Vec<Outputs> {
    let model = solved_by(method, "railway", |config| {
        (config.thermal.enabled, config.mesh.elements_per_half_width) = (true, elements);
    });
    let mut inputs = Inputs::rolling(model.config());
    inputs.drive.load *= share;
    let mut simulation = Simulation::new(model, &inputs).unwrap();
    let mut seen = Vec::new();
    for k in 0..(0.07 / step).round() as usize {
        inputs.drive.moment = share * moment * (k as f64 * step / 0.05).min(1.0);
        simulation.advance(&inputs, step).unwrap();
        assert!(method == ContactMethod::Grid || is_patch(&simulation));
        seen.push(simulation.outputs().clone());
    }
    seen
}

/// Layers swell and pull at the bodies: force, pressure and temperature are those of the grid, a tenth of the step and
/// nearly twice the load included, and the energy is accounted for.
#[test]
fn a_wheel_with_heat_moves_as_on_the_grid_and_its_energy_is_accounted_for() {
    for (share, moment, step) in [
        (1.0, -7e3, 1e-3),
        (1.0, -12e3, 1e-3),
        (1.0, 7e3, 1e-3),
        (1.9, -7e3, 1e-3),
        (1.0, -7e3, 1e-4),
        (0.1, -7e3, 1e-3),
    ] {
        let run = |method| heated(method, 20, share, moment, step);
        let [ours, theirs] = [ContactMethod::Auto, ContactMethod::Grid].map(run);
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
        if share > 0.5 {
            figure("points.heat", &[force, pressure, residual]);
        }
        println!(
            "{share} of the load, {moment:.0} N m, {step:.0e} s: F/muP {force:.1e}, pressure {pressure:.1e}, rise {rise:.2} K \
             within {warmth:.1e}, residual {residual:.1e}"
        );
        // A tenth of the load has six cells of the grid to a half-width.
        let coarse = if share < 0.5 { 10.0 } else { 1.0 };
        assert!(force < 1e-3 && pressure < 3e-4 * coarse && residual < 1e-4 * coarse);
        assert!(warmth < 2e-2 * coarse);
    }
}

/// The difference between both is the grid's error: its temperature rise tends to that on the patch as the mesh is
/// refined.
#[test]
fn the_temperature_on_the_patch_is_the_one_to_which_the_grid_converges() {
    let rise = |method, elements| {
        let seen = heated(method, elements, 1.0, -7e3, 1e-3);
        seen[seen.len() - 1].temperature_wheel_max - seen[0].temperature_wheel_max
    };
    let ours = rise(ContactMethod::Patch, 20);
    let [coarse, fine] = [20, 40].map(|elements| rise(ContactMethod::Grid, elements) / ours - 1.0);
    figure("points.rise", &[coarse, fine]);
    println!("rise {ours:.4} K on the patch; on the grid {coarse:+.2e}, with twice as many elements {fine:+.2e}");
    assert!(fine.abs() < 0.6 * coarse.abs() && fine.abs() < 4e-3);
}

/// The rail chills a hot wheel, whose tread contracts: it rolls freely at another creepage. The grid, whose elements
/// have to resolve the root with which the heat begins to flow, tends to what the patch finds.
#[test]
fn a_chilled_tread_changes_the_creepage_of_free_rolling_by_what_the_grid_tends_to() {
    let shift = |method, elements| {
        let creepage = |expansion| {
            let model = solved_by(method, "railway", |config| {
                (config.thermal.enabled, config.physics.thermal_expansion) = (true, expansion);
                (config.thermal.wheel_excess, config.mesh.elements_per_half_width) = (300.0, elements);
                config.initial.temperature = StartTemperature::Stationary;
            });
            Simulation::new(model.clone(), &Inputs::rolling(model.config())).unwrap().outputs().contact_creepage
        };
        creepage(true) - creepage(false)
    };
    let ours = [10, 20, 40].map(|elements| shift(ContactMethod::Patch, elements));
    let theirs = [20, 40].map(|elements| shift(ContactMethod::Grid, elements));
    let scaled = |shifts: &[f64]| shifts.iter().map(|shift| 1e5 * shift).collect::<Vec<_>>();
    figure_within(0.05, "points.chill", &scaled(&ours));
    figure_within(0.05, "nodes.chill", &scaled(&theirs));
    println!("shift on the patch {ours:?} with 10, 20, 40 elements, on the grid {theirs:?} with 20, 40");
    assert!(ours.iter().all(|shift| (shift / ours[2] - 1.0).abs() < 0.3));
    let away = theirs.map(|shift| shift - ours[2]);
    assert!(away[1] > 0.0 && away[1] < 0.65 * away[0]);
}

/// A locked wheel heats its contact within a millisecond to where steel yields and melts: `auto` leaves it to the grid. After
/// 5 ms a film that melts and freezes lets the torsion stick and slip, at instants that rounding decides.
#[test]
fn a_locked_hot_slide_is_that_of_the_grid_with_auto() {
    let run = |method| {
        let model = solved_by(method, "railway", |config| {
            (config.thermal.enabled, config.mesh.elements_per_half_width) = (true, 10);
            (config.tuning.softening, config.initial.velocity) = (0.0, 60.0 * KMH);
        });
        let mut inputs = prescribed(&model, 60.0 * KMH, 0.0);
        let mut simulation = Simulation::new(model, &inputs).unwrap();
        assert_eq!(is_patch(&simulation), method == ContactMethod::Auto);
        (inputs.drive.omega, inputs.drive.friction) = (0.0, 0.4);
        for _ in 0..4 {
            simulation.advance(&inputs, 1e-3).unwrap();
            assert!(!is_patch(&simulation));
        }
        simulation.outputs().clone()
    };
    let [ours, theirs] = [ContactMethod::Auto, ContactMethod::Grid].map(run);
    let (a, b) = (ours.temperature_wheel_max, theirs.temperature_wheel_max);
    println!("{a:.2} and {b:.2} K, {:.3} and {:.3} kN", 1e-3 * ours.contact_force_x, 1e-3 * theirs.contact_force_x);
    // Steel melts here, which makes more of a difference between two starts.
    assert!((a / b - 1.0).abs() < 2e-4 && (ours.contact_force_x / theirs.contact_force_x - 1.0).abs() < 2e-3);
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
        assert!(is_patch(&simulation));
        simulation.outputs().temperature_wheel_max - simulation.model().config().thermal.reference
    };
    let [usual, fine] = [None, Some(40)].map(rise);
    figure("braking.rise", &[usual / fine - 1.0]);
    println!("rise {usual:.4} K on the default mesh, {fine:.4} K with 40 elements");
    assert!(usual > 4.0 && (usual / fine - 1.0).abs() < 2e-3);
}
