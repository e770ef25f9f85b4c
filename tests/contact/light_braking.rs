//! Light braking: slip in a part of the patch that is shorter than a cell or hardly longer, on ten nodes to a half-width.

use crate::common::{self, figure, model, prescribed, range};
use std::sync::Arc;
use wheelrail::config::{Config, StartTemperature};
use wheelrail::simulation::{Model, Outputs, Simulation};

/// Used friction, rise of the surface temperature above the bodies [K] and share of the patch that sticks.
struct Seen {
    used: f64,
    rise: f64,
    stick: f64,
}

fn on_nodes(name: &str, nodes: usize, change: impl Fn(&mut Config)) -> Arc<Model> {
    let mut config = common::shipped(name);
    config.initial.temperature = StartTemperature::Stationary;
    config.mesh.grid_elements_per_half_width = nodes;
    change(&mut config);
    model(config)
}

/// Stationary rolling at 27 m/s.
fn rolling(model: &Arc<Model>, creepage: f64) -> Outputs {
    let inputs = prescribed(model, 27.0, creepage);
    Simulation::new(model.clone(), &inputs).unwrap().outputs().clone()
}

fn seen(model: &Arc<Model>, creepage: f64) -> Seen {
    let outputs = rolling(model, creepage);
    Seen {
        used: outputs.contact_utilisation,
        rise: outputs.temperature_wheel_max - outputs.temperature_wheel_bulk,
        stick: outputs.contact_stick_fraction,
    }
}

#[test]
fn flash_temperature_and_stick_of_light_braking_are_those_of_eight_times_the_nodes() {
    let [coarse, fine] = [10, 80].map(|nodes| on_nodes("railway", nodes, |_| {}));
    for creepage in [1e-4, 1.6e-4, 2.3e-4, 4e-4, 7e-4, 1.1e-3, 1.7e-3, 2.6e-3] {
        let [ours, reference] = [&coarse, &fine].map(|model| seen(model, creepage));
        let (flash, stick) = (ours.rise / reference.rise - 1.0, ours.stick - reference.stick);
        println!("used friction {:.3}: flash {flash:+.4}, stick {stick:+.5}", reference.used);
        figure(if reference.used < 0.2 { "zone.flash.light" } else { "zone.flash" }, &[flash.abs()]);
        figure("zone.stick", &[stick.abs()]);
        let bound = if reference.used < 0.15 { 0.01 } else { 5e-3 };
        assert!(reference.rise > 0.1 && flash.abs() < bound && stick.abs() < 2e-3, "{creepage}: {flash} {stick}");
    }
}

/// On a half-plane the share that sticks is `√(1 − u)` at used friction `u` (Carter 1926); hub and layers are other bodies.
#[test]
fn stick_of_a_rolling_wheel_is_that_of_carter() {
    let model = on_nodes("railway", 10, |config| config.thermal.enabled = false);
    for creepage in [1e-4, 3e-4, -6e-4, 1e-3, -1.6e-3, 2.4e-3] {
        let Seen { used, stick, .. } = seen(&model, creepage);
        let carter = (1.0 - used).sqrt();
        println!("used friction {used:.3}: stick {stick:.4}, Carter {carter:.4}");
        figure("zone.carter", &[(stick - carter).abs()]);
        assert!((stick - carter).abs() < 4e-3, "{creepage}: {stick} {carter}");
    }
}

/// The places of nodes do not show while the slip zone grows over three cells: a parabola describes the change.
#[test]
fn stick_and_flash_are_smooth_while_the_slip_zone_passes_nodes() {
    let model = on_nodes("railway", 10, |_| {});
    let places: Vec<Seen> = (0..60).map(|k| seen(&model, 4e-4 + 1.1e-5 * f64::from(k))).collect();
    let (low, high) = range(&places.iter().map(|seen| seen.stick).collect::<Vec<_>>());
    assert!(high - low > 0.15, "{low} {high}");
    let bends = |value: fn(&Seen) -> f64| {
        let bend = |seen: &[Seen]| (value(&seen[2]) - 2.0 * value(&seen[1]) + value(&seen[0])).abs();
        places.windows(3).map(bend).fold(0.0, f64::max)
    };
    let [stick, rise] = [bends(|seen| seen.stick), bends(|seen| seen.rise)];
    println!("largest second differences: stick {stick:.1e}, flash {rise:.1e} K");
    figure("zone.smooth", &[stick, rise]);
    assert!(stick < 2e-3 && rise < 0.02, "{stick} {rise}");
}

/// Spin lets slip grow along the zone otherwise than in Carter's contact. Twenty nodes see slip zones where ten see slip from node
/// to node, so that both ways of writing the heat must agree.
#[test]
fn flash_under_spin_is_the_same_whether_the_slip_zone_or_the_nodes_tell_where_friction_heats() {
    let rises = [10, 20].map(|nodes| {
        let model = on_nodes("railway_ellipse", nodes, |config| config.contact.lateral = true);
        let mut inputs = prescribed(&model, 27.0, 1e-3);
        inputs.drive.spin = 0.5;
        let outputs = Simulation::new(model, &inputs).unwrap().outputs().clone();
        outputs.temperature_wheel_max - outputs.temperature_wheel_bulk
    });
    println!("rise under spin on 10 and 20 nodes: {rises:.3?} K");
    figure("zone.spin", &[(rises[1] / rises[0] - 1.0).abs()]);
    assert!(rises[0] > 10.0 && (rises[1] / rises[0] - 1.0).abs() < 0.01, "{rises:?}");
}

/// The share that sticks falls to zero with the last nodes that stick, in steps that are shorter than theirs: a node is .05 of a patch.
#[test]
fn stick_vanishes_without_steps_of_a_node_as_a_brake_uses_all_friction() {
    let model = on_nodes("railway", 10, |config| config.thermal.enabled = false);
    let shares: Vec<f64> = (0..80).map(|k| seen(&model, 2.6e-3 + 2e-5 * f64::from(k)).stick).collect();
    let largest = shares.windows(2).map(|pair| pair[0] - pair[1]).fold(0.0, f64::max);
    println!("stick from {:.3} to {:.3}, largest step {largest:.4}", shares[0], shares[79]);
    figure("zone.vanishes", &[largest]);
    assert!(shares[0] > 0.3 && shares[79] == 0.0 && largest < 0.035, "{largest}");
}

/// Slip at a place of the profile is that of finer nodes from the place where it begins on, but for the cell of the trailing edge.
#[test]
fn slip_of_the_profile_is_that_of_four_times_the_nodes() {
    let [coarse, fine] = [10, 40].map(|nodes| on_nodes("railway", nodes, |_| {}));
    for creepage in [7e-4, 1.1e-3, 1.7e-3] {
        let [ours, reference] = [&coarse, &fine].map(|model| rolling(model, creepage));
        let ends = ours.profile_slip.iter().zip(&ours.profile_x).filter(|(slip, _)| **slip != 0.0).map(|(_, x)| *x);
        let [low, high] = [-ours.contact_half_width * 0.9, ends.fold(f64::NEG_INFINITY, f64::max)];
        let largest = reference.profile_slip.iter().fold(0.0f64, |most, slip| most.max(slip.abs()));
        let of_fine = |x: f64| wheelrail::piecewise::interpolate(&reference.profile_x, &reference.profile_slip, x);
        let places = ours.profile_x.iter().zip(&ours.profile_slip).filter(|(x, _)| **x > low && **x < high);
        let missed: Vec<f64> = places.map(|(x, slip)| (slip - of_fine(*x)).abs() / largest).collect();
        let most = missed.iter().copied().fold(0.0, f64::max);
        println!("creepage {creepage}: slip up to {largest:.4} m/s misses {most:.4} of it at {} places", missed.len());
        figure("zone.slip", &[most]);
        assert!(missed.len() > 3 && most < 0.05, "{creepage}: {missed:.3?}");
    }
}
