//! Waves of the rail under an elliptical patch.
//!
//! Closed form of the patch: a small height `h` of the surfaces changes the force by the work of the pressure under a flat punch of the
//! same patch, by Betti's theorem. Summed across the patch that pressure is constant along it, so that waves of the
//! amplitude A and the wave number k act with `A sin(ka)/(ka)` (under a line with `A J₀(ka)`). Lines that
//! reach as far as patches of soft steel are long are not quite equally stiff, as this needs.

use crate::common::{self, model, preset};
use std::f64::consts::{PI, TAU};
use wheelrail::config::Config;
use wheelrail::simulation::{Inputs, Simulation, Vertical};

/// Amplitude of the waves [m].
const AMPLITUDE: f64 = 1e-7;

fn rest(lines: usize) -> Config {
    let mut config = preset("railway_ellipse", 20);
    config.contact.lines = lines;
    (config.thermal.enabled, config.initial.velocity, config.friction.coefficient) = (false, 0.0, 0.0);
    config
}

/// Normal force [N] of a wheel at rest at a given height of the hub, with a wave of the `length` [m] under it that has the
/// `phase` [rad] in its middle.
fn force(lines: usize, height: f64, [amplitude, length, phase]: [f64; 3]) -> f64 {
    let mut config = rest(lines);
    config.rail.profile = format!("sinusoid(amplitude = {amplitude:?}, wavelength = {length:?}, phase = {phase:?})");
    let model = model(config);
    let mut inputs = Inputs::rolling(model.config());
    (inputs.vertical, inputs.drive.displacement) = (Vertical::Displacement, height);
    Simulation::new(model, &inputs).unwrap().outputs().contact_force_y
}

/// Height of the hub under the nominal load [m].
fn height(lines: usize) -> f64 {
    let mut config = rest(lines);
    config.rail.profile = format!("sinusoid(amplitude = {AMPLITUDE:?}, wavelength = 1.0)");
    let model = model(config);
    -Simulation::new(model.clone(), &Inputs::rolling(model.config())).unwrap().outputs().contact_approach
}

#[test]
fn waves_act_with_their_mean_under_a_punch() {
    for (lines, tolerance) in [(5, 0.05), (7, 0.03)] {
        let (a, hub) = (rest(lines).hertz().under(1e5).a, height(lines));
        // Half of the difference of crest and trough under the middle.
        let answer = |length: f64| {
            let at = |phase: f64| force(lines, hub, [AMPLITUDE, length, phase]);
            0.5 * (at(0.5 * PI) - at(-0.5 * PI))
        };
        let slope = answer(2e3 * a);
        for waves in [0.25, 0.5, 1.0, 1.5, 2.0] {
            let q = TAU * waves * 0.5;
            let (found, exact) = (answer(2.0 * a / waves) / slope, q.sin() / q);
            common::figure(&format!("ellipse.waves.{lines}"), &[found - exact]);
            println!("{lines} lines, {waves} waves in the patch: {found:.4} for {exact:.4}");
            assert!((found - exact).abs() < tolerance, "{found} for {exact}");
        }
    }
}

/// Lines that stay where they are lift off one after the other when the load falls, as the patch does.
#[test]
fn a_patch_on_a_rough_rail_has_the_pressure_of_hertz_under_other_loads() {
    let mut config = rest(7);
    config.rail.profile = format!("sinusoid(amplitude = {AMPLITUDE:?}, wavelength = 1.0)");
    let model = model(config);
    let hertz = model.config().hertz();
    for (share, tolerance) in [(0.3, 0.05), (0.5, 0.04), (0.8, 0.015), (1.0, 0.002), (1.2, 0.015), (1.5, 0.03)] {
        let mut inputs = Inputs::rolling(model.config());
        inputs.drive.load = share * 1e5;
        let seen = Simulation::new(model.clone(), &inputs).unwrap().outputs().clone();
        let exact = hertz.under(share * 1e5);
        let (pressure, half_axis) =
            (seen.contact_pressure_max / exact.peak - 1.0, seen.contact_half_width / exact.a - 1.0);
        println!("{share}: pressure {pressure:+.4}, half axis {half_axis:+.4}");
        assert!(pressure.abs() < tolerance && half_axis.abs() < tolerance);
    }
}
