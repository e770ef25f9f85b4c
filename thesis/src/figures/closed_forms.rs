//! Numbers of the text that closed forms decide.

use super::{Figure, must};
use crate::ours::Product;
use crate::paper_a::{self, DAMPING, SPEED, WAVE};
use crate::plot::{Curve, Plot, Source};
use crate::quoted::Status;
use crate::transient::Rolling;
use std::f64::consts::{PI, TAU};
use wheelrail::analytic::{contact_modulus, hertz_half_width, hertz_load, hertz_peak_pressure, hub_torsion};

/// Young's modulus \[Pa] and Poisson's ratio of all papers.
const YOUNG: f64 = 200e9;
const POISSON: f64 = 0.3;
/// Paper A: radius \[m], load [N/m].
const RADIUS_A: f64 = 0.46;
const LOAD_A: f64 = 4.7e6;
/// Mass of the wheel [kg/m].
const MASS: f64 = 5265.0;

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
    let checks = validation(pressure)?;
    let [nodal, equal, small, large] = checks.pressures;
    Ok(Figure {
        item: "A text",
        title: "Hertzian contact of Paper A",
        status: Status::ThesisError,
        parameters: "E 200 GPa, ν 0.3 of both bodies, r 0.46 m, P 4.7 MN/m.",
        finding: format!(
            "The load gives {:.0} MPa over {:.2} mm. 1 GPa needs {:.1} MN/m. The stated 7 mm are the width on a rigid plate, {:.2} \
             mm, whose pressure would be {:.0} MPa. Validation, stated 0.968 of Hertz and 0.997 on a plate five times as large: the highest of the few nodal \
             pressures of the thesis's method with n_r = 5 and 61 nodes is {nodal:.3} of Hertz, that of the Hertzian contact with the same width {equal:.3}; the product has \
             {small:.4} and {large:.4}. The plate changes {:.4} of it, so the 3 % were the mesh's. Linearised spring: {:.0} rad/s (stated 2.85e3). Damping α₁ω/2: \
             {:.3} for the wheel on its contact at 2922 rad/s, {:.3} for the tread that turns about its hub at {:.0} rad/s; the stated 0.11 belongs to 2200 rad/s.",
            1e-6 * pressure,
            2e3 * a,
            1e-6 * load,
            2e3 * rigid,
            1e-6 * rigid_pressure,
            large - small,
            checks.spring,
            0.5 * DAMPING * 2922.0,
            0.5 * DAMPING * checks.torsion,
            checks.torsion
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
            ("a.pressure.method".into(), nodal),
            ("a.pressure.small".into(), small),
            ("a.pressure.large".into(), large),
            ("a.spring".into(), checks.spring),
            ("a.damping.bounce".into(), 0.5 * DAMPING * 2922.0),
            ("a.damping.torsion".into(), 0.5 * DAMPING * checks.torsion),
            ("a.weight".into(), 8000.0 * PI * (RADIUS_A * RADIUS_A - 0.046 * 0.046) * 9.81),
        ],
        predicates: vec![
            must("the pressure carries the load", (PI * a * pressure / 2.0 / LOAD_A - 1.0).abs() < 1e-12),
            must("that load has a peak of 1 GPa", (hertz_peak_pressure(load, half_width) / wanted - 1.0).abs() < 1e-12),
            must(
                format!("the product has Hertz' pressure within 1 % on both plates: {small:.4}, {large:.4}"),
                (small - 1.0).abs() < 0.01 && (large - 1.0).abs() < 0.01,
            ),
            must(
                format!("the thesis's method has it within 10 % at a node, 3 % by its width: {nodal:.4}, {equal:.4}"),
                (nodal - 1.0).abs() < 0.1 && (equal - 1.0).abs() < 0.03,
            ),
            must("10.0 mm and 598 MPa", (2.0 * a - 0.01).abs() < 5e-5 && (pressure - 598e6).abs() < 0.5e6),
        ],
    })
}

/// What the validation of Paper A and two of its sentences come to.
struct Validation {
    /// Over Hertz: highest nodal pressure and that of the width by the thesis's method, the product on both plates.
    pressures: [f64; 4],
    /// Angular frequency of the wheel on its linearised contact [rad/s].
    spring: f64,
    /// Of the tread about its hub [rad/s].
    torsion: f64,
}

/// Computes them; `peak` is Hertz' pressure \[Pa].
fn validation(peak: f64) -> Result<Validation, String> {
    let bodies = paper_a::meshes(paper_a::BASE, 5, 61, paper_a::PLATE);
    let rolling =
        Rolling::new(paper_a::case(), &bodies.wheel, &bodies.rail, &|_| 0.0).map_err(|error| error.to_string())?;
    let nodal = rolling.pressure();
    let top = nodal.iter().fold(0.0_f64, |most, point| most.max(point[1]));
    let moment =
        |power: i32| nodal.iter().zip(&rolling.forces).map(|(point, force)| force * point[0].powi(power)).sum::<f64>();
    let width = 2.0 * (moment(2) / moment(0) - (moment(1) / moment(0)).powi(2)).sqrt();
    let plate =
        |scale: f64| paper_a::product("", |config| (config.rail.length, config.rail.height) = (scale, 0.1 * scale));
    let small = plate(1.0)?;
    let pressure =
        |product: &Product| product.rolling(SPEED, 0.0, |_| ()).map(|run| run.outputs().contact_pressure_max / peak);
    let approach = |share: f64| {
        small.rolling(SPEED, 0.0, |inputs| inputs.drive.load *= share).map(|run| run.outputs().contact_approach)
    };
    let stiffness = 0.02 * LOAD_A / (approach(1.01)? - approach(0.99)?);
    let shear = (0.5 * YOUNG / (1.0 + POISSON) / 8000.0).sqrt();
    Ok(Validation {
        pressures: [top / peak, hertz_peak_pressure(LOAD_A, width) / peak, pressure(&small)?, pressure(&plate(5.0)?)?],
        spring: (stiffness / MASS).sqrt(),
        torsion: hub_torsion(RADIUS_A, 0.1 * RADIUS_A, shear).frequency,
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

/// What the patch leaves of waves of a `length` \[m] \[1].
pub(super) fn filter(length: f64) -> f64 {
    bessel(TAU * hertz_half_width(LOAD_A, RADIUS_A, contact_modulus(YOUNG, POISSON)) / length)
}

/// Amplitude of the force over that of the wave as the patch sees it [N/m²] at an angular frequency [rad/s]: `|K* m ω²/(K* − m ω²)|` with
/// `K* = K (1 + iωα)`.
pub(super) fn unfiltered(omega: f64) -> f64 {
    let stiffness = MASS * 2922.0 * 2922.0;
    let (inertia, loss) = (MASS * omega * omega, stiffness * omega * DAMPING);
    stiffness.hypot(loss) * inertia / (stiffness - inertia).hypot(loss)
}

/// Amplitude of the force [N/m] on the waves of Paper A at an angular frequency [rad/s].
pub(super) fn corrugation_force(omega: f64) -> f64 {
    WAVE[0] * filter(WAVE[1]) * unfiltered(omega)
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
        assert!(filter(0.01308).abs() < 1e-3, "first null of the filter");
    }

    #[test]
    fn bessel_function_has_its_first_null_and_values() {
        assert!(bessel(2.404_825_557_695_773).abs() < 1e-14);
        assert!((bessel(1.0) - 0.765_197_686_557_966_6).abs() < 1e-14 && bessel(0.0) == 1.0);
    }
}
