//! Stationary rolling, Papers C and D: ours beside Carter; for figure D 6 also the thesis's own path, without heat.

use super::mesh_heat::friction_means;
use super::{Figure, must};
use crate::annulus::{CONDUCTIVITY, INNER, OUTER};
use crate::contact::Law;
use crate::newton::{self, Drive, Newton};
use crate::ours::Product;
use crate::plot::{Curve, Plot, Source};
use crate::quoted::Status;
use crate::rail::{self, Plate};
use crate::rolling::{Motion, Parameters, System};
use crate::wheel::{self, Annulus};
use std::f64::consts::TAU;
use wheelrail::analytic::{carter_force, carter_full_slip, contact_modulus, hertz_half_width};

/// Creepage at which Carter's contact slips fully, for a load [N/m].
fn full_slip(load: f64, friction: f64) -> f64 {
    carter_full_slip(friction, hertz_half_width(load, OUTER, contact_modulus(200e9, 0.3)), OUTER)
}

/// Force–creepage curves: product and Carter, and the largest difference.
fn curves(product: &Product, load: f64, friction: f64, largest: f64) -> Result<(Vec<Curve>, f64), String> {
    let creepages: Vec<f64> = (-8..=8).map(|i| largest * f64::from(i) / 8.0).collect();
    let full = full_slip(load, friction);
    let force = |xi: &f64| product.stationary(*xi, Some(friction)).map(|state| [1e4 * xi, state.utilisation]);
    let ours = creepages.iter().map(force).collect::<Result<Vec<_>, _>>()?;
    let carter: Vec<[f64; 2]> = creepages.iter().map(|xi| [1e4 * xi, carter_force(*xi, full)]).collect();
    let difference = ours.iter().zip(&carter).fold(0.0_f64, |worst, (a, b)| worst.max((a[1] - b[1]).abs()));
    let curves = vec![
        Curve { source: Source::Ours, name: format!("ours, μ = {friction}"), points: ours },
        Curve { source: Source::Exact, name: format!("Carter, μ = {friction}"), points: carter },
    ];
    Ok((curves, difference))
}

fn plot(curves: Vec<Curve>) -> Plot {
    Plot { axes: ["creepage ξ in 1e-4".into(), "F/μP".into()], curves }
}

/// Figure C 7: force over creepage. The friction coefficient is not stated.
pub fn paper_c() -> Result<Figure, String> {
    let (product, still) = (Product::new("paper_c", true)?, Product::new("paper_c", false)?);
    let (mut all, _) = curves(&product, 10e3, 0.4, 2.5e-4)?;
    all.extend(curves(&product, 10e3, 0.5, 2.5e-4)?.0);
    let at = [-5e-5, -1.25e-4, 0.0].map(|xi| product.stationary(xi, None).map(|state| state.utilisation));
    let [first, second, free] = [at[0].clone()?, at[1].clone()?, at[2].clone()?];
    // Carter and the references know no centrifugal load.
    let difference = curves(&still, 10e3, 0.4, 2.5e-4)?.1;
    let references = [(-5e-5, 0.45108), (-1.25e-4, 0.876526)];
    let error = |(xi, value): (f64, f64)| still.stationary(xi, None).map(|state| (state.utilisation - value).abs());
    let worst = error(references[0])?.max(error(references[1])?);
    Ok(Figure {
        item: "C 7",
        title: "Tangential force over creepage",
        status: Status::NotStated,
        parameters: "Base of Paper C, P = 10 kN/m, 50 km/h; μ is not stated: 0.4 and 0.5 assumed.",
        finding: format!(
            "μ = 0.4: {first:.4} of the limit at −5e-5, {second:.4} at −1.25e-4, {free:+.4} without creepage: the centrifugal load \
             counts under so small a weight."
        ),
        plots: vec![plot(all)],
        values: vec![("c7.first".into(), first), ("c7.second".into(), second), ("c7.free".into(), free)],
        predicates: vec![
            must(format!("without centrifugal load within 0.002 of Carter: {difference:.4}"), difference < 2e-3),
            must(format!("without it within 0.002 of 0.4511 and 0.8765: {worst:.4}"), worst < 2e-3),
        ],
    })
}

/// Forces over creepage by penalty, tanh and velocity stepping on linear triangles.
fn thesis_path(creepages: &[f64]) -> Result<Vec<[f64; 2]>, String> {
    let law = Law { penalty: 5e12, friction: 0.4, regularisation: 1e-4 };
    let annulus = Annulus { outer: OUTER, inner: INNER };
    let plate = Plate { length: 1.0, height: 0.1 };
    let parameters = Parameters { annulus, plate, young: 200e9, poisson: 0.3, density: 8000.0, load: 100e3, law };
    let a = hertz_half_width(parameters.load, OUTER, contact_modulus(parameters.young, parameters.poisson));
    let wheel = wheel::rolling(annulus, 1.5 * a, 0.2 * a, 1, parameters.poisson).map_err(|error| error.to_string())?;
    let system = System::new(parameters, &wheel, &rail::rolling(plate, 31, 2.0 * a, 0.2 * a), 2.0 * a);
    let newton = Newton { system: &system, law, drive: Drive::Velocity };
    let force = |xi: &f64| {
        let velocity = 50.0 / 3.6;
        let omega = velocity * (1.0 - 0.5 * xi) / (1.0 + 0.5 * xi) / OUTER;
        let (state, _) = newton::rolling(&system, Motion { omega, velocity }).map_err(|error| error.to_string())?;
        let [forward, up] = newton::resultant(&newton.residual(&state).1);
        Ok([1e4 * xi, forward / (law.friction * up)])
    };
    creepages.iter().map(force).collect()
}

/// Figure D 6: force over creepage, and the creepage of full slip.
pub fn paper_d() -> Result<Figure, String> {
    let product = Product::new("paper_d", true)?;
    let (mut all, difference) = curves(&product, 100e3, 0.4, 8e-4)?;
    all.push(Curve {
        source: Source::Quoted,
        name: "stated full slip".into(),
        points: vec![[-6.0, -1.0], [-6.0, 1.0]],
    });
    let free = product.stationary(0.0, None)?.utilisation;
    let full = full_slip(100e3, 0.4);
    let path = thesis_path(&[-8e-4, -4e-4, -1.9e-4, 0.0, 1.9e-4, 4e-4, 8e-4])?;
    let mean = |i: usize| 0.5 * (path[i][1] - path[6 - i][1]);
    let carter = [-8e-4, -4e-4, -1.9e-4].map(|xi| carter_force(xi, full));
    let worst = (0..3).fold(0.0_f64, |worst, i| worst.max((mean(i) - carter[i]).abs()));
    let (soft, bias) = (mean(2), path[3][1]);
    all.push(Curve { source: Source::Method, name: "penalty and tanh, P1 triangles".into(), points: path });
    Ok(Figure {
        item: "D 6",
        title: "Tangential force over creepage",
        status: Status::Agrees,
        parameters: "Base of Paper D, P = 100 kN/m, μ = 0.4, 50 km/h, ε_r = 1e-4 m/s, ε_n = 5e12; own mesh of 4946 linear triangles, rigid hub, no \
                     heat.",
        finding: format!(
            "Full slip at ∓{full:.3e} after Carter, stated −6e-4. F(0) = {free:.4} of the limit, not quite zero. The \
             thesis's path has {bias:+.3} there, a bias of its uneven mesh of first order, and {soft:.3} at 1.9e-4 in the mean of \
             traction and braking."
        ),
        plots: vec![plot(all)],
        values: vec![("d6.free".into(), free), ("d6.tanh".into(), soft), ("d6.tanh_bias".into(), bias)],
        predicates: vec![
            must(format!("within 0.002 of Carter: {difference:.4}"), difference < 2e-3),
            must(format!("thesis's path within 0.03 of Carter in the mean of both signs: {worst:.4}"), worst < 0.03),
            must("|F(0)| below 0.005 of the limit and not zero", free.abs() < 5e-3 && free.abs() > 1e-5),
        ],
    })
}

/// Text to C 12: mean temperature of the wheel.
pub fn temperature() -> Result<Figure, String> {
    let product = Product::new("paper_c", true)?;
    let ours = product.stationary(-5e-5, None)?;
    // The reference knows no centrifugal load.
    let still = Product::new("paper_c", false)?.stationary(-5e-5, None)?.wheel_mean;
    // Outside of the skin the fast wheel is axisymmetric: its heat flows to the hub through an annulus.
    let square = OUTER * OUTER;
    let shape = square * (OUTER / INNER).ln() / (square - INNER * INNER) - 0.5;
    let per_heat = shape / (TAU * CONDUCTIVITY);
    // Half of a tenth of the friction power F V |ξ| goes to the wheel, before conduction to the rail.
    let friction = ours.utilisation * 0.4 * 10e3 * 50.0 / 3.6 * 5e-5;
    let share = ours.wheel_mean / (0.05 * friction * per_heat);
    let (meshes, linear) = friction_means()?;
    let rows: Vec<String> =
        meshes.iter().map(|(count, [wheel, rail])| format!("{count} triangles {wheel:.2e} and {rail:.2e} K")).collect();
    let own = |i: usize| meshes[i].1[0];
    let stated = 2.26e-6;
    let stated_share = stated / (0.05 * friction * per_heat);
    Ok(Figure {
        item: "C 12",
        title: "Mean temperature of the wheel",
        status: Status::ThesisError,
        parameters: "Base of Paper C, ξ = −5e-5, 50 km/h; μ = 0.4 assumed.",
        finding: format!(
            "Ours {:.2e} K, reference 7.52e-5 K; stated 2.26e-6 K, {:.0} times less. The hub carries away what the mean temperature \
             drives through the annulus: {:.1} % of the wheel's half of the friction heat in ours, {:.1} % in the thesis, which \
             must have lost the rest. Its own method, quadratic bubbles, loses less than half of it: wheel and rail have {} with n_r = 0 to 2, linear SUPG with n_r = 2 {:.2e} and {:.2e} K.",
            ours.wheel_mean,
            ours.wheel_mean / stated,
            100.0 * share,
            100.0 * stated_share,
            rows.join(", "),
            linear[0],
            linear[1]
        ),
        plots: Vec::new(),
        values: vec![
            ("c12.wheel".into(), ours.wheel_mean),
            ("c12.wheel.method".into(), own(2)),
            ("c12.rail.method".into(), meshes[2].1[1]),
        ],
        predicates: vec![
            must(
                format!(
                    "the thesis's method has more with n_r = 2 than with 0, though not steadily: {:.2e} to {:.2e} K",
                    own(0),
                    own(2)
                ),
                own(2) > own(0),
            ),
            must("and stays below ours", meshes.iter().all(|(_, means)| means[0] < ours.wheel_mean)),
            must(
                format!("without centrifugal load {still:.4e} K, within 2 % of the reference 7.5217e-5 K"),
                (still / 7.5217e-5 - 1.0).abs() < 0.02,
            ),
            must(
                "reference and its heat to the hub fit the annulus",
                (0.011_648_07 * per_heat / 7.5217e-5 - 1.0).abs() < 1e-3,
            ),
        ],
    })
}
