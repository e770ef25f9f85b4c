//! Numbers of the text that closed forms decide.

use super::{Figure, must};
use crate::paper_a::WAVE;
use crate::plot::{Curve, Plot, Source};
use crate::quoted::Status;
use std::f64::consts::{PI, TAU};
use wheelrail::analytic::{
    carter_force, carter_full_slip, contact_modulus, hertz_half_width, hertz_load, hertz_peak_pressure,
};

/// Young's modulus \[Pa] and Poisson's ratio of all papers.
const YOUNG: f64 = 200e9;
const POISSON: f64 = 0.3;
/// Paper A: radius \[m], load [N/m].
const RADIUS_A: f64 = 0.46;
const LOAD_A: f64 = 4.7e6;

/// Paper A, 3.1: pressure and width of the patch.
pub fn hertz() -> Result<Figure, String> {
    let modulus = contact_modulus(YOUNG, POISSON);
    let a = hertz_half_width(LOAD_A, RADIUS_A, modulus);
    let pressure = hertz_peak_pressure(LOAD_A, a);
    // On a rigid plate only the wheel gives way.
    let rigid = hertz_half_width(LOAD_A, RADIUS_A, 2.0 * modulus);
    let rigid_pressure = hertz_peak_pressure(LOAD_A, rigid);
    let wanted = 1e9;
    let half_width = 2.0 * wanted * RADIUS_A / modulus;
    let load = hertz_load(half_width, RADIUS_A, modulus);
    let curve = |name: &str, a: f64, pressure: f64| {
        let x = |i: i32| 1.02 * a * f64::from(i) / 100.0;
        let height = |x: f64| pressure * (1.0 - (x / a).powi(2)).max(0.0).sqrt();
        let points = (-100..=100).map(|i| [1e3 * x(i), 1e-6 * height(x(i))]).collect();
        Curve { source: Source::Exact, name: name.into(), points }
    };
    let quoted = Curve {
        source: Source::Quoted,
        name: "stated: 1 GPa over 7 mm".into(),
        points: vec![[-3.5, 0.0], [-3.5, 1000.0], [3.5, 1000.0], [3.5, 0.0]],
    };
    Ok(Figure {
        item: "A text",
        title: "Hertzian contact of Paper A",
        status: Status::ThesisError,
        parameters: "E 200 GPa, ν 0.3 of both bodies, r 0.46 m, P 4.7 MN/m.",
        finding: format!(
            "The load gives {:.0} MPa over {:.2} mm. 1 GPa needs {:.1} MN/m. The stated 7 mm are the width on a rigid plate, {:.2} \
             mm, whose pressure would be {:.0} MPa.",
            1e-6 * pressure,
            2e3 * a,
            1e-6 * load,
            2e3 * rigid,
            1e-6 * rigid_pressure
        ),
        plots: vec![Plot {
            axes: ["place in mm".into(), "pressure in MPa".into()],
            curves: vec![curve("Hertz", a, pressure), curve("Hertz, rigid plate", rigid, rigid_pressure), quoted],
        }],
        values: vec![
            ("a.hertz.pressure".into(), pressure),
            ("a.hertz.width".into(), 2.0 * a),
            ("a.hertz.rigid_width".into(), 2.0 * rigid),
            ("a.hertz.load_for_1GPa".into(), load),
            ("a.weight".into(), 8000.0 * PI * (RADIUS_A * RADIUS_A - 0.046 * 0.046) * 9.81),
        ],
        predicates: vec![
            must("the pressure carries the load", (PI * a * pressure / 2.0 / LOAD_A - 1.0).abs() < 1e-12),
            must("that load has a peak of 1 GPa", (hertz_peak_pressure(load, half_width) / wanted - 1.0).abs() < 1e-12),
            must("10.0 mm and 598 MPa", (2.0 * a - 0.01).abs() < 5e-5 && (pressure - 598e6).abs() < 0.5e6),
        ],
    })
}

/// Bessel function J₀ for moderate arguments, by its series.
fn bessel(x: f64) -> f64 {
    let (mut term, mut sum) = (1.0, 1.0);
    for k in 1..40 {
        term *= -0.25 * x * x / f64::from(k * k);
        sum += term;
    }
    sum
}

/// Amplitude of the force [N/m] on the waves of Paper A at an angular frequency [rad/s]: `|K* m ω²/(K* − m ω²)|` times the wave as the
/// patch sees it, with `K* = K (1 + iωα)`.
pub(super) fn corrugation_force(omega: f64) -> f64 {
    let (mass, natural, damping, [amplitude, wavelength]) = (5265.0, 2922.0, 1e-4, WAVE);
    let stiffness = mass * natural * natural;
    let filter = bessel(TAU * hertz_half_width(LOAD_A, RADIUS_A, contact_modulus(YOUNG, POISSON)) / wavelength);
    let (inertia, loss) = (mass * omega * omega, stiffness * omega * damping);
    amplitude * filter * stiffness.hypot(loss) * inertia / (stiffness - inertia).hypot(loss)
}

/// Text to D 18: share of the limit at the largest creepage.
pub fn braking() -> Result<Figure, String> {
    let (radius, load, friction, creepage) = (0.5, 100e3, 0.4, 1.9e-4);
    let a = hertz_half_width(load, radius, contact_modulus(YOUNG, POISSON));
    let full = carter_full_slip(friction, a, radius);
    let share = carter_force(-creepage, full);
    let points = (0..=80).map(|i| f64::from(i) * 1e-5).map(|xi| [1e4 * xi, carter_force(-xi, full)]).collect();
    Ok(Figure {
        item: "D 18",
        title: "Controlled braking: share of the limit at the largest creepage (closed form only)",
        status: Status::ThesisError,
        parameters: "r 0.5 m, P 100 kN/m, μ 0.4, creepage 1.9e-4 as stated.",
        finding: format!(
            "Carter: {share:.3} of the limit; stated 0.48. The regularised law does not give it on the meshes tried: figure D 6."
        ),
        plots: vec![Plot {
            axes: ["|creepage| in 1e-4".into(), "|F|/μP".into()],
            curves: vec![
                Curve { source: Source::Exact, name: "Carter".into(), points },
                Curve {
                    source: Source::Quoted,
                    name: "stated".into(),
                    points: vec![[0.0, 0.48], [1.9, 0.48], [1.9, 0.0]],
                },
            ],
        }],
        values: vec![("d18.share".into(), share), ("d6.full_slip".into(), full)],
        predicates: vec![must("0.527 ± 0.001 by Carter's law", (share - 0.527).abs() < 1e-3)],
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn forces_on_waves_are_those_of_the_specification() {
        let known = [(50.0, 0.110), (75.0, 0.514), (100.0, 0.556), (150.0, 0.324)];
        assert!(known.iter().all(|(kmh, force)| {
            let found = 1e-6 * corrugation_force(TAU * kmh / 3.6 / WAVE[1]);
            (found - force).abs() < 1e-3
        }));
        let a = hertz_half_width(LOAD_A, RADIUS_A, contact_modulus(YOUNG, POISSON));
        assert!(bessel(TAU * a / 0.01308).abs() < 1e-3, "first null of the filter");
    }

    #[test]
    fn bessel_function_has_its_first_null_and_values() {
        assert!(bessel(2.404_825_557_695_773).abs() < 1e-14);
        assert!((bessel(1.0) - 0.765_197_686_557_966_6).abs() < 1e-14 && bessel(0.0) == 1.0);
    }
}
