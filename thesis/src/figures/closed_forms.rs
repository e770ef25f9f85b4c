//! Numbers of the text that closed forms decide.

use super::validation::validation;
use super::{Figure, must};
use crate::Error;
use crate::elastic;
use crate::mesh::Mesh;
use crate::paper_a::{self, ANNULUS, BASE, DAMPING, PATCH, SPEED, WAVE};
use crate::plot::{Curve, Plot, Source};
use crate::quoted::Status;
use crate::transient::STEEL;
use crate::triangle::{Order, Space};
use crate::wheel;
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
    let validation = validation(pressure)?;
    let (spring, torsion) = frequencies()?;
    let meshes = [0, 1, 2, 3].map(|global| torsion_of_mesh(&wheel::early(ANNULUS, PATCH, BASE, global)));
    let meshes = meshes.into_iter().collect::<Result<Vec<f64>, _>>().map_err(|error| error.to_string())?;
    let stiff = meshes.iter().map(|omega| format!("{omega:.0}")).collect::<Vec<_>>().join(", ");
    Ok(Figure {
        item: "A text",
        title: "Hertzian contact of Paper A",
        status: Status::ThesisError,
        parameters: "E 200 GPa, ν 0.3 of both bodies, r 0.46 m, P 4.7 MN/m.",
        finding: format!(
            "The load gives {:.0} MPa over {:.2} mm. 1 GPa needs {:.1} MN/m. The stated 7 mm are the width on a rigid plate, {:.2} \
             mm, whose pressure would be {:.0} MPa. {} Linearised spring: {:.0} rad/s (stated 2.85e3). Damping α₁ω/2: \
             {:.3} for the wheel on its contact at 2922 rad/s, {:.3} for the tread that turns about its held hub at {:.0} rad/s; linear triangles \
             make that mode, the lowest, stiffer: {stiff} rad/s with n_r = 0 to 3, which is {:.3} to {:.3}. The stated 0.11 lies between, so it is this mode on a mesh that is coarse at its hub: n_r = 1 has {:.4}.",
            1e-6 * pressure,
            2e3 * a,
            1e-6 * load,
            2e3 * rigid,
            1e-6 * rigid_pressure,
            validation.finding(),
            spring,
            0.5 * DAMPING * 2922.0,
            0.5 * DAMPING * torsion,
            torsion,
            0.5 * DAMPING * meshes[0],
            0.5 * DAMPING * meshes[3],
            0.5 * DAMPING * meshes[1]
        ),
        plots: vec![
            Plot {
                axes: ["place in mm".into(), "pressure in MPa".into()],
                curves: vec![curve("Hertz", a, pressure), curve("Hertz, rigid plate", rigid, rigid_pressure), quoted],
            },
            validation.plot(),
        ],
        values: [
            ("closed.a.pressure", pressure),
            ("closed.a.width", 2.0 * a),
            ("closed.a.rigid_width", 2.0 * rigid),
            ("closed.a.load_for_1GPa", load),
            ("a.spring", spring),
            ("closed.a.damping.bounce", 0.5 * DAMPING * 2922.0),
            ("closed.a.damping.torsion", 0.5 * DAMPING * torsion),
            ("a.damping.coarsest", 0.5 * DAMPING * meshes[0]),
            ("a.damping.coarse", 0.5 * DAMPING * meshes[1]),
            ("a.damping.mesh", 0.5 * DAMPING * meshes[3]),
            ("closed.a.weight", 8000.0 * PI * (RADIUS_A * RADIUS_A - 0.046 * 0.046) * 9.81),
        ]
        .map(|(name, value)| (name.into(), value))
        .into_iter()
        .chain(validation.values())
        .collect(),
        predicates: [
            must("the pressure carries the load", (PI * a * pressure / 2.0 / LOAD_A - 1.0).abs() < 1e-12),
            must("that load has a peak of 1 GPa", (hertz_peak_pressure(load, half_width) / wanted - 1.0).abs() < 1e-12),
            must(
                format!(
                    "the tread about its held hub comes down to its closed form, {torsion:.0} rad/s, from above: {stiff}; it is lower than the wheel on its contact and passes the stated 0.11"
                ),
                meshes.windows(2).all(|pair| pair[1] < pair[0])
                    && meshes[3] > torsion
                    && meshes[3] < spring
                    && (0.5 * DAMPING * meshes[3]..0.5 * DAMPING * meshes[0]).contains(&0.11),
            ),
            must("10.0 mm and 598 MPa", (2.0 * a - 0.01).abs() < 5e-5 && (pressure - 598e6).abs() < 0.5e6),
        ]
        .into_iter()
        .chain(validation.predicates())
        .collect(),
    })
}

/// Angular frequencies [rad/s] of the wheel on its linearised contact and of the tread about its hub.
fn frequencies() -> Result<(f64, f64), String> {
    let product = paper_a::product("", |_| ())?;
    let approach = |share: f64| {
        product.rolling(SPEED, 0.0, |inputs| inputs.drive.load *= share).map(|run| run.outputs().contact_approach)
    };
    let stiffness = 0.02 * LOAD_A / (approach(1.01)? - approach(0.99)?);
    let shear = (0.5 * YOUNG / (1.0 + POISSON) / 8000.0).sqrt();
    Ok(((stiffness / MASS).sqrt(), hub_torsion(RADIUS_A, 0.1 * RADIUS_A, shear).frequency))
}

/// Angular frequency [rad/s] of the tread that turns about its held hub, on linear triangles: the lowest mode, by
/// inverse iteration.
fn torsion_of_mesh(wheel: &Mesh) -> Result<f64, Error> {
    let ([young, poisson, density], space) = (STEEL, Space::new(wheel, Order::Linear));
    let (mut stiffness, mass) = (elastic::stiffness(&space, young, poisson), elastic::mass(&space, density));
    let (_, hub) = wheel::rims(wheel, ANNULUS);
    let held: Vec<usize> = hub.iter().flat_map(|node| [2 * node, 2 * node + 1]).collect();
    stiffness.fix(&held);
    let factors = stiffness.factorise()?;
    let mut u: Vec<f64> = space.places.iter().flat_map(|[x, y]| [*y, -x]).collect();
    let mut square = 0.0;
    for _ in 0..30 {
        held.iter().for_each(|i| u[*i] = 0.0);
        let mut load = mass.multiply(&u);
        held.iter().for_each(|i| load[*i] = 0.0);
        let next = factors.solve(load.clone())?;
        let product = |v: &[f64]| load.iter().zip(v).map(|(a, b)| a * b).sum::<f64>();
        square = product(&u) / product(&next);
        u = next.iter().map(|value| square * value).collect();
    }
    Ok(square.sqrt())
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

/// Share that the patch leaves of waves of a `length` \[m] \[1].
pub(super) fn filter(length: f64) -> f64 {
    bessel(TAU * hertz_half_width(LOAD_A, RADIUS_A, contact_modulus(YOUNG, POISSON)) / length)
}

/// Amplitude of the force over that of the wave as the patch sees it [N/m²] at an angular frequency [rad/s]:
/// `|K* m ω²/(K* − m ω²)|` with `K* = K (1 + iωα)`.
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
    fn the_torsion_of_the_tread_is_stiffer_on_a_mesh_and_comes_down_to_its_closed_form() {
        let shear = (0.5 * YOUNG / (1.0 + POISSON) / 8000.0).sqrt();
        let exact = hub_torsion(RADIUS_A, 0.1 * RADIUS_A, shear).frequency;
        let over = |global: usize| torsion_of_mesh(&wheel::early(ANNULUS, 0.1, 0.05, global)).unwrap() / exact - 1.0;
        let found = [2, 4, 6].map(over);
        println!("over the closed form: {found:.4?}");
        assert!(found[2] > 0.0 && found.windows(2).all(|pair| pair[1] < 0.4 * pair[0]));
    }

    #[test]
    fn bessel_function_has_its_first_null_and_values() {
        assert!(bessel(2.404_825_557_695_773).abs() < 1e-14);
        assert!((bessel(1.0) - 0.765_197_686_557_966_6).abs() < 1e-14 && bessel(0.0) == 1.0);
    }
}
