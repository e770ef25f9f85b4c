//! The contact evens out waves of the rail: by `J₀(2πa/λ)` to first order in the amplitude, for a Hertzian line contact
//! of half-width a. By reciprocity with the flat punch, whose pressure `1/(π√(a² − x²))` per unit force says how much
//! each place of the profile lifts the wheel: `∫ cos(2πx/λ)/(π√(a² − x²)) dx = J₀(2πa/λ)`.

use crate::common::{self, model, preset};
use crate::half_planes::{HalfPlanes, NOMINAL, RADIUS, modulus};
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use wheelrail::analytic::hertz_half_width;
use wheelrail::material::Isotropic;
use wheelrail::simulation::{Inputs, Simulation};
use wheelrail::surface::{Body, Profile};

/// Contact filter of CNOSSOS-EU for 100 kN and a wheel of 920 mm: wavelength over half-width, 7.16 mm, and level \[dB].
/// Directive (EU) 2015/996 as amended by (EU) 2021/1226, Table G-2.
const CNOSSOS: [(f64, f64); 7] =
    [(100.0, -0.3), (80.0, -0.6), (63.0, -1.0), (50.0, -1.8), (40.0, -3.2), (31.5, -5.4), (25.0, -8.7)];
const HALF_WIDTH: f64 = 7.16;
/// Amplitude of the waves, far below the depth by which the bodies approach \[m].
const AMPLITUDE: f64 = 1e-9;

/// `J₀(z)` by its integral.
fn bessel(z: f64) -> f64 {
    let n = 200;
    (0..n).map(|k| (z * (PI * (f64::from(k) + 0.5) / f64::from(n)).sin()).cos()).sum::<f64>() / f64::from(n)
}

/// Height at which a cylinder under a load rests on a wave whose phase below its centre is given \[m].
fn height(elements: usize, load: f64, wavelength: f64, phase: f64) -> f64 {
    let text = format!("sinusoid(amplitude = {AMPLITUDE:?}, wavelength = {wavelength:?}, phase = {phase:?})");
    let wave = Profile::parse(&text, None, Body::Rail).unwrap();
    let circle = |x: f64| x * x / (RADIUS + (RADIUS * RADIUS - x * x).sqrt());
    let bodies = HalfPlanes::new(elements).with_gap(|x| circle(x) - wave.height(x));
    bodies.roll(load, 0.0, &bodies.start()).unwrap().traction.rigid.height
}

/// Shares of a wave of so many half-widths that lift the cylinder, from a crest and a trough below its centre. The
/// loads of the list let the edges of the contact wander over one spacing of the nodes.
fn shares(elements: usize, length: f64) -> Vec<f64> {
    let share = |k: i32| {
        let load = NOMINAL * (1.0 + f64::from(k) / 8.0 / elements as f64).powi(2);
        let wavelength = length * hertz_half_width(load, RADIUS, modulus());
        let [crest, trough] = [FRAC_PI_2, -FRAC_PI_2].map(|phase| height(elements, load, wavelength, phase));
        (crest - trough) / (2.0 * AMPLITUDE)
    };
    (-3..=4).map(share).collect()
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// A small wave changes no node between open and closed, so that the patch feels it with a half-width that is wrong by
/// up to half a spacing. The filter is the mean over the places that the edges can have between two nodes.
#[test]
fn a_static_contact_evens_out_waves_by_the_bessel_function() {
    let level = |share: f64| 20.0 * share.abs().log10();
    for (wavelength, table) in CNOSSOS {
        let length = wavelength / HALF_WIDTH;
        let exact = level(bessel(TAU / length));
        let [coarse, fine] = [10, 20].map(|elements| shares(elements, length));
        let found = level(mean(&fine));
        let single = |shares: &[f64]| shares.iter().map(|&s| (level(s) - exact).abs()).fold(0.0, f64::max);
        let spread = [single(&coarse), single(&fine)];
        common::figure("filter.planes [dB]", &[found - exact]);
        common::figure("filter.cnossos [dB]", &[found - table]);
        println!(
            "{wavelength} mm: {found:.3} dB, J0 {exact:.3} dB, CNOSSOS {table} dB; single contacts within {spread:.3?} dB"
        );
        assert!((found - exact).abs() < 0.02, "{found} {exact}");
        assert!((found - table).abs() < 1.0, "{found} {table}");
        // Of first order in the spacing; the eight loads find the largest only roughly.
        assert!((0.3..0.7).contains(&(spread[1] / spread[0])) && spread[1] < 0.6, "{spread:?}");
    }
    // At the first null nothing is left, and beyond it a crest lowers the wheel.
    let [null, beyond] = [2.613, 1.9].map(|length| mean(&shares(20, length)) - bessel(TAU / length));
    println!("off the Bessel function by {null:.5} at the null, {beyond:.5} beyond");
    assert!(null.abs() < 2e-3 && beyond.abs() < 2e-3 && bessel(TAU / 1.9) < -0.3, "{null} {beyond}");
    // A quarter of a wave further the wheel neither rises nor sinks.
    let wavelength = 5.0 * hertz_half_width(NOMINAL, RADIUS, modulus());
    let even = height(20, NOMINAL, wavelength, 0.0) - height(20, NOMINAL, wavelength, PI);
    assert!(even.abs() < 1e-4 * AMPLITUDE, "{even}");
}

/// Contact filter of elastic wheel and rail: a wheel that stands on waves of its rail under loads that let the edges
/// wander.
#[test]
fn a_standing_wheel_is_lifted_by_what_the_contact_leaves_of_waves() {
    let elements = 20;
    let amplitude = 1e-7;
    for wavelength in [0.05, 0.025] {
        let heights = |phase: f64| -> Vec<f64> {
            let mut config = preset("railway", elements);
            config.thermal.enabled = false;
            config.initial.velocity = 0.0;
            config.rail.profile =
                format!("sinusoid(amplitude = {amplitude:?}, wavelength = {wavelength:?}, phase = {phase:?})");
            let model = model(config);
            let height = |k: i32| {
                let mut inputs = Inputs::rolling(model.config());
                inputs.drive.load *= (1.0 + f64::from(k) / 8.0 / elements as f64).powi(2);
                Simulation::new(model.clone(), &inputs).unwrap().outputs().hub_height
            };
            (-3..=4).map(height).collect()
        };
        let [crest, trough] = [FRAC_PI_2, -FRAC_PI_2].map(heights);
        let shares: Vec<f64> = crest.iter().zip(&trough).map(|(c, t)| (c - t) / (2.0 * amplitude)).collect();
        let config = preset("railway", elements);
        let line = config.model.nominal_load / config.model.contact_width;
        let half_width = |k: i32| {
            let load = line * (1.0 + f64::from(k) / 8.0 / elements as f64).powi(2);
            hertz_half_width(load, config.wheel.radius, Isotropic::from(&config.material).contact_modulus())
        };
        let exact = mean(&(-3..=4).map(|k| bessel(TAU * half_width(k) / wavelength)).collect::<Vec<_>>());
        let level = |share: f64| 20.0 * share.abs().log10();
        let (found, exact) = (level(mean(&shares)), level(exact));
        common::figure("filter.wheel [dB]", &[found - exact]);
        println!("standing wheel, {wavelength} m: {found:.3} dB, J0 {exact:.3} dB");
        assert!((found - exact).abs() < 0.2, "{found} {exact}");
    }
}
