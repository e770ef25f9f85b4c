//! Heat and friction of rolling by the thesis's own method: Paper B figure 11, Paper C figure 6.

use super::paper_b::{CAPACITY, HEAT, LOAD, SPEED, heated, paper_b};
use super::{Extent, Figure, balanced, curve, largest, must};
use crate::annulus::{CONDUCTIVITY, INNER, OUTER};
use crate::contact::Law;
use crate::heat::{Heating, Spot, Warmth, spots};
use crate::mesh::Mesh;
use crate::newton::{self, Drive, Newton};
use crate::plot::{Plot, Source};
use crate::quoted::Status;
use crate::rail::{self, Plate};
use crate::rolling::{Motion, Parameters, System};
use crate::stabilise::Scheme;
use crate::triangle::Order;
use crate::wheel::{self, Annulus};
use wheelrail::analytic::{carter_force, carter_full_slip, contact_modulus, hertz_half_width};

/// Wheel and rail of Papers B to D.
pub(super) const ANNULUS: Annulus = Annulus { outer: OUTER, inner: INNER };
pub(super) const PLATE: Plate = Plate { length: 1.0, height: 0.1 };
/// Edges under the contact, over half of it, before the whole wheel is refined.
pub(super) const BASE: f64 = 0.25;

/// Half of a contact \[m].
pub(super) fn half_width(load: f64) -> f64 {
    hertz_half_width(load, OUTER, contact_modulus(200e9, 0.3))
}

/// Meshes of \[B] § 6.2 and \[C] § 5.1 for a load, with so many refinements of the whole wheel.
pub(super) fn meshes(load: f64, base: f64, global: usize) -> Result<[Mesh; 2], String> {
    let a = half_width(load);
    let size = base * a / 2.0_f64.powf(0.5 * global as f64);
    let wheel = wheel::rolling(ANNULUS, 2.0 * a, size, global, 0.3).map_err(|error| error.to_string())?;
    Ok([wheel, rail::rolling(PLATE, 31, 2.0 * a, 1.5 * size)])
}

/// Wheel and rail that touch.
fn system(load: f64, law: Law, [wheel, rail]: &[Mesh; 2]) -> System {
    let parameters =
        Parameters { annulus: ANNULUS, plate: PLATE, young: 200e9, poisson: 0.3, density: 8000.0, load, law };
    System::new(parameters, wheel, rail, 2.0 * half_width(load))
}

/// Share of the limit, traction positive, and the nodes in contact, by velocity stepping.
pub(super) fn roll(load: f64, law: Law, bodies: &[Mesh; 2], creepage: f64) -> Result<(f64, Vec<Spot>), String> {
    let system = system(load, law, bodies);
    let omega = SPEED * (1.0 - 0.5 * creepage) / (1.0 + 0.5 * creepage) / OUTER;
    let (state, _) = newton::rolling(&system, Motion { omega, velocity: SPEED })
        .map_err(|error| format!("ε_r {:.1e}, ξ {creepage:e}: {error}", law.regularisation))?;
    let newton = Newton { system: &system, law, drive: Drive::Velocity };
    let [forward, up] = newton::resultant(&newton.residual(&state).1);
    Ok((forward / (law.friction * up), spots(&system, &state)))
}

/// Parameters of the heat of rolling beside mesh and contact; as in [`Heating`].
#[derive(Clone, Copy)]
pub(super) struct Thermal {
    /// Functions and stabilisation of the wheel.
    pub wheel: (Order, Scheme),
    /// Angular velocity [rad/s] and velocity [m/s].
    pub motion: [f64; 2],
    /// Conductance [W/(m² K)] and share of the friction power that becomes heat.
    pub contact: [f64; 2],
    /// Heat into each arc [W/m].
    pub arcs: f64,
    /// True with the hub held at the reference.
    pub cold_hub: bool,
}

impl Thermal {
    /// As Paper C describes it.
    pub(super) fn paper_c() -> Self {
        Self { wheel: BUBBLES, motion: [SPEED / OUTER, SPEED], contact: [1e7, 0.1], arcs: 0.0, cold_hub: true }
    }
}

/// Heating of both bodies.
pub(super) fn heating<'a>([first, second]: &'a [Mesh; 2], spots: &'a [Spot], thermal: Thermal) -> Heating<'a> {
    let Thermal { wheel, motion, contact, arcs, cold_hub } = thermal;
    let material = [CAPACITY, CONDUCTIVITY];
    Heating { meshes: [first, second], annulus: ANNULUS, wheel, material, motion, spots, contact, arcs, cold_hub }
}

/// Temperatures under the given contact. Refused where heat put in and heat that leaves differ by more than 1e-8 of it.
pub(super) fn thermal(bodies: &[Mesh; 2], spots: &[Spot], thermal: Thermal) -> Result<Warmth, String> {
    let heating = heating(bodies, spots, thermal);
    let warmth = heating.solve().map_err(|error| error.to_string())?;
    let imbalance = heating.imbalance(&warmth);
    if imbalance <= 1e-8 { Ok(warmth) } else { Err(format!("heat does not balance: {imbalance:.1e} of it")) }
}

/// Quadratic bubbles, as the thesis has them.
pub(super) const BUBBLES: (Order, Scheme) = (Order::Quadratic, Scheme::Bubble);

/// Temperatures \[K] on the segment x = 0, y < 0 over the radius, from the tread `depth` \[m] inward.
fn below(warmth: &Warmth, depth: f64) -> Vec<[f64; 2]> {
    let places = warmth.space.places.iter().zip(&warmth.theta);
    let line = places.filter(|([x, y], _)| x.abs() < 1e-9 && *y < 0.0 && -y > OUTER - depth);
    let mut points: Vec<[f64; 2]> = line.map(|([_, y], t)| [-y, *t]).collect();
    points.sort_by(|a, b| a[0].total_cmp(&b[0]));
    points
}

/// Figure B 11: temperature below the contact over the refinement of the wheel.
pub fn convergence(extent: Extent) -> Result<Figure, String> {
    let law = Law { penalty: 5e12, friction: 0.0, regularisation: 1.0 };
    let depth = 2.0 * half_width(LOAD) / 5.0;
    let (mut curves, mut surface, mut means, mut counts) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    let (mut arrives, mut lost, mut imbalance) = (Vec::new(), 0.0_f64, Vec::new());
    for global in 0..extent.choose(4, 5) {
        let bodies = meshes(LOAD, BASE, global)?;
        let system = system(LOAD, law, &bodies);
        let state = newton::frictionless(&system).map_err(|error| error.to_string())?;
        let spots = spots(&system, &state);
        let heating = heating(&bodies, &spots, Thermal { arcs: 0.5 * HEAT, cold_hub: false, ..Thermal::paper_c() });
        let warmth = heating.solve().map_err(|error| error.to_string())?;
        let let_in = heating.let_in(&warmth.space, &warmth.theta);
        imbalance.push(heating.imbalance(&warmth));
        let points = below(&warmth, depth);
        surface.push(points.last().map_or(f64::NAN, |point| point[1]));
        means.push(warmth.means[0]);
        counts.push([bodies[0].triangles.len() + bodies[1].triangles.len(), warmth.theta.len()]);
        arrives.push(warmth.flows[0] / HEAT);
        lost = lost.max(((warmth.flows[0] - let_in) / HEAT - 1.0).abs());
        curves.push(curve(Source::Method, format!("n_r = {global}"), points));
    }
    let ours = heated(&paper_b(|_| ())?, SPEED, LOAD)?.warmth();
    curves.push(curve(
        Source::Ours,
        "ours, contact point",
        vec![[OUTER - 0.05 * depth, ours.wheel_centre], [OUTER, ours.wheel_centre]],
    ));
    let off = |found: f64| found / ours.wheel_centre - 1.0;
    let [triangles, nodes] = counts[2];
    Ok(Figure {
        item: "B 11",
        title: "Temperature below the contact over the refinement of the wheel",
        status: Status::NotStated,
        parameters: "Base of Paper B; quadratic bubbles in the wheel, SUPG in the rail, frictionless contact by penalty. n_r = 0 to 3 (in full, 4, too) and the base mesh are \
                     assumed, the latter so that n_r = 2 has about the thesis's 8017 triangles.",
        finding: format!(
            "At the contact point {} K for n_r = 0 to {}, ours {:.4} K; mean of the wheel {} K, ours {:.4} K. n_r = 2 has {triangles} triangles and {nodes} nodes; the \
             thesis's 8017 and 12608 mean 5733 quadratic triangles in the wheel and 2284 linear ones in the rail. {:.3} times the \
             heat of the arcs reach the rail with n_r = 2: the convective form lets heat in through the chords of the rims, which are no streamlines.",
            surface.iter().map(|t| format!("{t:.4}")).collect::<Vec<_>>().join(", "),
            surface.len() - 1,
            ours.wheel_centre,
            means.iter().map(|t| format!("{t:.4}")).collect::<Vec<_>>().join(", "),
            ours.wheel_mean,
            arrives[2]
        ),
        plots: vec![Plot { axes: ["radius in m".into(), "temperature in K".into()], curves }],
        values: (0..4)
            .map(|global| (format!("b11.surface.{global}"), surface[global]))
            .chain([
                ("b11.mean".into(), means[2]),
                ("b.triangles".into(), triangles as f64),
                ("b.nodes".into(), nodes as f64),
            ])
            .collect(),
        predicates: vec![
            must(
                format!("n_r = 3 within 10 % of ours at the contact point: {:+.4}", off(surface[3])),
                off(surface[3]).abs() < 0.1,
            ),
            must("nearer to ours with n_r = 3 than with n_r = 0", off(surface[3]).abs() < off(surface[0]).abs()),
            must(
                format!(
                    "what reaches the rail is the heat of the arcs and what the chords of the rims let in: {lost:.1e}"
                ),
                lost < 1e-6,
            ),
            balanced(largest(imbalance)),
            must(
                format!("n_r = 2 has the thesis's numbers of triangles and nodes within 5 %: {triangles}, {nodes}"),
                (triangles as f64 / 8017.0 - 1.0).abs() < 0.05 && (nodes as f64 / 12608.0 - 1.0).abs() < 0.05,
            ),
        ],
    })
}

/// Paper C's law for a regularisation \[m/s].
pub(super) fn paper_c(regularisation: f64) -> Law {
    Law { penalty: 5e12, friction: 0.4, regularisation }
}

/// Figure C 6: force over the regularisation of friction.
pub fn regularisation(extent: Extent) -> Result<Figure, String> {
    let axis = extent.axis(&[-4.5, -4.0, -3.5, -3.0, -2.5, -2.0]);
    let powers = &axis.values;
    let over = |global: usize| {
        let bodies = meshes(LOAD, BASE, global)?;
        let force = |power: &f64| roll(LOAD, paper_c(10f64.powf(*power)), &bodies, -5e-5).map(|(force, _)| force);
        powers.iter().map(force).collect::<Result<Vec<f64>, String>>()
    };
    let found = over(1)?;
    let finer =
        (2..extent.choose(2, 3)).map(|global| Ok((global, over(global)?))).collect::<Result<Vec<_>, String>>()?;
    let exact = carter_force(-5e-5, carter_full_slip(0.4, half_width(LOAD), OUTER));
    let [plateau, at, at_3, at_2] = [0, 1, 3, 5].map(|i| *axis.listed(&found, i));
    let line = |global: usize, found: &[f64]| {
        let points = powers.iter().zip(found).map(|(power, force)| [*power, *force]).collect();
        curve(Source::Method, format!("penalty and tanh, n_r = {global}"), points)
    };
    let mut curves = vec![line(1, &found)];
    curves.extend(finer.iter().map(|(global, found)| line(*global, found)));
    curves.push(curve(Source::Exact, "Carter", powers.iter().map(|power| [*power, exact]).collect()));
    curves.push(curve(Source::Quoted, "stated threshold", vec![[-4.0, 0.0], [-4.0, exact]]));
    let all = || finer.iter().map(|(_, found)| found).chain([&found]);
    Ok(Figure {
        item: "C 6",
        title: "Tangential force over the regularisation of friction",
        status: Status::NotStated,
        parameters: "Base of Paper C, P = 10 kN/m, 50 km/h, μ = 0.4 and ξ = −5e-5 assumed; penalty, tanh, velocity stepping, mesh of figure B 11 with n_r = 1 (in full, 2, too), linear \
                     triangles, no heat.",
        finding: format!(
            "{plateau:.4} of the limit at 3.2e-5 m/s, {at:.4} at 1e-4, {:.4} at 1e-3, {:.4} at 1e-2 m/s: from about 1e-4 m/s on the force falls, as stated. Carter has \
             {exact:.4}.",
            at_3, at_2
        ),
        plots: vec![Plot { axes: ["lg of ε_r in m/s".into(), "F/μP".into()], curves }],
        values: powers.iter().zip(&found).map(|(power, force)| (format!("c6.{power}"), *force)).collect(),
        predicates: vec![
            must(
                "the force falls with the regularisation",
                all().all(|found| found.windows(2).all(|pair| pair[1] < pair[0])),
            ),
            must(format!("by less than 5 % up to 1e-4 m/s: {:.4}", 1.0 - at / plateau), 1.0 - at / plateau < 0.05),
            must(format!("by more than 10 % at 1e-3 m/s: {:.4}", 1.0 - at_3 / plateau), 1.0 - at_3 / plateau > 0.1),
        ],
    })
}
