//! Stationary rolling, Papers C and D: ours beside Carter; for figure D 6 also the thesis's own path, without heat.

use super::{Extent, Figure, must};
use crate::annulus::{INNER, OUTER};
use crate::contact::Law;
use crate::mesh::Mesh;
use crate::newton::{self, Drive, Newton};
use crate::ours::Product;
use crate::plot::{Curve, Plot, Source};
use crate::quoted::Status;
use crate::rail::{self, Plate};
use crate::rolling::{Motion, Parameters, System, Touch};
use crate::wheel::{self, Annulus};
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
        values: vec![
            ("c7.first".into(), first),
            ("c7.second".into(), second),
            ("c7.free".into(), free),
            ("c7.carter.off".into(), difference),
        ],
        predicates: vec![
            must(format!("without centrifugal load within 0.004 of Carter: {difference:.4}"), difference < 4e-3),
            must(format!("without it within 0.002 of 0.4511 and 0.8765: {worst:.4}"), worst < 2e-3),
        ],
    })
}

/// Wheel and rail of Paper D in linear triangles, whose edges in the contact are `edge` of its half-width, after so
/// many refinements of the whole wheel, and their meshes.
pub(super) fn triangles(edge: f64, global: usize) -> Result<(System, [Mesh; 2]), String> {
    let law = Law { penalty: 5e12, friction: 0.4, regularisation: 1e-4 };
    let annulus = Annulus { outer: OUTER, inner: INNER };
    let plate = Plate { length: 1.0, height: 0.1 };
    let parameters = Parameters { annulus, plate, young: 200e9, poisson: 0.3, density: 8000.0, load: 100e3, law };
    let a = hertz_half_width(parameters.load, OUTER, contact_modulus(parameters.young, parameters.poisson));
    let wheel = wheel::rolling(annulus, 1.5 * a, edge * a, global, parameters.poisson);
    let wheel = wheel.map_err(|error| error.to_string())?;
    let rail = rail::rolling(plate, 31, 2.0 * a, edge * a);
    Ok((System::new(parameters, &wheel, &rail, 2.0 * a), [wheel, rail]))
}

/// Velocities that belong to a velocity [m/s] and a creepage.
pub(super) fn motion(velocity: f64, creepage: f64) -> Motion {
    Motion { omega: velocity * (1.0 - 0.5 * creepage) / (1.0 + 0.5 * creepage) / OUTER, velocity }
}

/// Force of the contact over its limit, traction positive.
pub(super) fn share_of_limit(system: &System, touches: &[Touch]) -> f64 {
    let [forward, up] = newton::resultant(touches);
    forward / (system.parameters.law.friction * up)
}

/// Forces over creepage by penalty, tanh and velocity stepping on linear triangles, whose edges in the contact are
/// `edge` of its half-width.
fn thesis_path(creepages: &[f64], edge: f64) -> Result<Vec<[f64; 2]>, String> {
    let (system, _) = triangles(edge, 1)?;
    let newton = Newton { system: &system, law: system.parameters.law, drive: Drive::Velocity };
    let force = |xi: &f64| {
        let (state, _) = newton::rolling(&system, motion(50.0 / 3.6, *xi)).map_err(|error| error.to_string())?;
        Ok([1e4 * xi, share_of_limit(&system, &newton.residual(&state).1)])
    };
    creepages.iter().map(force).collect()
}

/// Smallest creepage, traction negative, at which nothing of the contact sticks, within 1e-6: by halving the interval
/// in which that begins.
fn slides_from(product: &Product) -> Result<f64, String> {
    let (mut sticks, mut slides) = (4e-4, 8e-4);
    while slides - sticks > 1e-6 {
        let middle = 0.5 * (sticks + slides);
        let run = product.rolling(product.config().initial.velocity, -middle, |_| ())?;
        if run.traction().stick_fraction > 0.0 { sticks = middle } else { slides = middle }
    }
    Ok(-slides)
}

/// Figure D 6: force over creepage, and the creepage of full slip.
pub fn paper_d(extent: Extent) -> Result<Figure, String> {
    let product = Product::new("paper_d", true)?;
    let (mut all, difference) = curves(&product, 100e3, 0.4, 8e-4)?;
    all.push(Curve {
        source: Source::Quoted,
        name: "stated full slip".into(),
        points: vec![[-6.0, -1.0], [-6.0, 1.0]],
    });
    let free = |product: &Product, velocity: f64| product.rolling(velocity, 0.0, |_| ()).map(|run| run.utilisation());
    // At 100 km/h and without centrifugal load: what deformation alone makes, and what that load adds.
    let (slow, fast) = (50.0 / 3.6, 100.0 / 3.6);
    let still = free(&Product::new("paper_d", false)?, slow)?;
    let (free, fast) = (free(&product, slow)?, free(&product, fast)?);
    let (full, slides) = (full_slip(100e3, 0.4), slides_from(&product)?);
    let axis = extent.axis(&[-8e-4, -4e-4, -1.9e-4, 0.0, 1.9e-4, 4e-4, 8e-4]);
    let (mut worst, mut soft, mut bias) = (0.0_f64, Vec::new(), Vec::new());
    for edge in extent.choose(&[0.2][..], &[0.2, 0.1]) {
        let path = thesis_path(&axis.values, *edge)?;
        // The mean of traction and braking, from creepages that lie opposite to each other.
        let mean = |i: usize| 0.5 * (path[i][1] - path[path.len() - 1 - i][1]);
        let off = |i: usize| (mean(i) - carter_force(axis.values[i], full)).abs();
        worst = (0..path.len() / 2).fold(worst, |worst, i| worst.max(off(i)));
        soft.push(mean(2 * axis.every));
        bias.push(axis.listed(&path, 3)[1]);
        let name = format!("penalty and tanh, P1 triangles, edges of {edge} a");
        all.push(Curve { source: Source::Method, name, points: path });
    }
    let (soft, biases) = (soft[0], bias.iter().map(|force| format!("{force:+.3}")).collect::<Vec<_>>().join(", "));
    Ok(Figure {
        item: "D 6",
        title: "Tangential force over creepage",
        status: Status::Agrees,
        parameters: "Base of Paper D, P = 100 kN/m, μ = 0.4, 50 km/h, ε_r = 1e-4 m/s, ε_n = 5e12; own mesh of 4946 linear triangles (in full, one with edges of half the length, too), rigid hub, no \
                     heat.",
        finding: format!(
            "Full slip from {slides:.3e} on in ours, at ∓{full:.3e} after Carter, stated −6e-4. Ours is within {difference:.1e} of the limit of Carter on the whole curve, with all deformations of \
             both bodies. Without creepage the deformation under the load makes {still:+.4} of the limit, and the centrifugal load shifts that to {free:+.4} at 50 km/h and {fast:+.4} at 100 km/h: \
             at the stated load and speed two real deformations nearly cancel. So local deformations do make a force without creepage, as the thesis says, but one of a hundredth of the limit \
             at most; the thesis's path has {biases} there, which its meshes make, and {soft:.3} at 1.9e-4 in the mean of \
             traction and braking."
        ),
        plots: vec![plot(all)],
        values: vec![
            ("d6.full_slip".into(), slides),
            ("d6.carter.off".into(), difference),
            ("d6.free".into(), free),
            ("d6.free.still".into(), still),
            ("d6.free.fast".into(), fast),
            ("d6.tanh".into(), soft),
            ("d6.tanh_bias".into(), bias[0]),
        ],
        predicates: vec![
            must(
                format!(
                    "deformable bodies are within 0.003 of the limit of Carter on the whole curve: {difference:.1e}"
                ),
                difference < 3e-3,
            ),
            must(format!("thesis's path within 0.03 of Carter in the mean of both signs: {worst:.4}"), worst < 0.03),
            must(
                format!("the bias of its mesh below 0.05 of the limit: {biases}"),
                bias.iter().all(|force| force.abs() < 0.05),
            ),
            must(
                format!(
                    "without creepage the force is real and below 0.01 of the limit, without centrifugal load {still:+.4}, with it {free:+.4}, at 100 km/h {fast:+.4}"
                ),
                [still, fast].iter().all(|force| (1e-3..1e-2).contains(&force.abs())) && free.abs() < 5e-3,
            ),
            must("the centrifugal load turns its sign", still < 0.0 && fast > 0.0),
        ],
    })
}
