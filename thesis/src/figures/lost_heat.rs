//! Text to Paper C, figure 12: the mean temperatures of wheel and rail, and which change of the scheme gives the
//! thesis's numbers.

use super::extrapolation::{Sequence, lacking, limit, sequence};
use super::friction_heat::pictures;
use super::mesh_heat::{BASE, BUBBLES, Thermal, meshes, paper_c, roll, thermal};
use super::paper_b::{CREEPAGE, LOAD, REFERENCE, SPEED};
use super::{Extent, Figure, curve, must};
use crate::annulus::{CONDUCTIVITY, INNER, OUTER};
use crate::heat::{Spot, Warmth};
use crate::mesh::Mesh;
use crate::ours::{Product, Run};
use crate::plot::{Curve, Plot, Source};
use crate::quoted::Status;
use crate::stabilise::Scheme;
use crate::triangle::Order;
use std::f64::consts::TAU;

/// Stated means of wheel and rail \[K].
const STATED: [f64; 2] = [2.26e-6, 4.45e-9];
const LINEAR: (Order, Scheme) = (Order::Linear, Scheme::Supg);
/// Size of edges under the contact before any refinement of the whole wheel, so that there are about the thesis's 8017
/// triangles without one.
const FINE: f64 = 0.1;

/// A change of the scheme, and the means \[K] of wheel and rail that it gives.
struct Candidate {
    name: String,
    means: [f64; 2],
}

impl Candidate {
    /// By which factors it misses what is stated.
    fn misses(&self) -> [f64; 2] {
        [0, 1].map(|body| (self.means[body] / STATED[body]).ln().abs().exp())
    }

    /// True where the wheel is within a factor of three and the rail within two.
    fn explains(&self) -> bool {
        let [wheel, rail] = self.misses();
        wheel < 3.0 && rail < 2.0
    }
}

/// A mesh with its contact.
struct Rolled {
    bodies: [Mesh; 2],
    spots: Vec<Spot>,
}

impl Rolled {
    fn new(base: f64, global: usize) -> Result<Self, String> {
        let bodies = meshes(LOAD, base, global)?;
        let (_, spots) = roll(LOAD, paper_c(10f64.powf(-4.5)), &bodies, CREEPAGE)?;
        Ok(Self { bodies, spots })
    }

    fn count(&self) -> usize {
        self.bodies.iter().map(|mesh| mesh.triangles.len()).sum()
    }

    fn warmth(&self, wheel: (Order, Scheme)) -> Result<Warmth, String> {
        thermal(&self.bodies, &self.spots, Thermal { wheel, ..Thermal::paper_c() })
    }
}

/// Changes of what the thesis describes, one at a time, on its mesh: two refinements of the whole wheel.
fn changes(described: &Rolled) -> Result<Vec<Candidate>, String> {
    let base = Thermal::paper_c();
    let with = |name: &str, thermal_: Thermal| {
        let means = thermal(&described.bodies, &described.spots, thermal_)?.means;
        Ok::<_, String>(Candidate { name: name.into(), means })
    };
    let mut all = vec![
        with("as described: quadratic, bubbles", base)?,
        with("quadratic, no stabilisation", Thermal { wheel: (Order::Quadratic, Scheme::Galerkin), ..base })?,
        with("quadratic, SUPG", Thermal { wheel: (Order::Quadratic, Scheme::Supg), ..base })?,
        with("wheel turns backward", Thermal { motion: [-base.motion[0], base.motion[1]], ..base })?,
        with("rail streams backward", Thermal { motion: [base.motion[0], -base.motion[1]], ..base })?,
        with("50 m/s instead of 50 km/h in the heat", Thermal { motion: [50.0 / OUTER, 50.0], ..base })?,
        with("diameter instead of radius", Thermal { motion: [0.5 * base.motion[0], base.motion[1]], ..base })?,
        with("conductance 1e5 W/(m² K)", Thermal { contact: [1e5, base.contact[1]], ..base })?,
        with("conductance 1e12 W/(m² K)", Thermal { contact: [1e12, base.contact[1]], ..base })?,
        with("share γ_f taken twice", Thermal { contact: [base.contact[0], base.contact[1].powi(2)], ..base })?,
        with("no stream in the wheel", Thermal { motion: [0.0, base.motion[1]], ..base })?,
        with("hub insulated", Thermal { cold_hub: false, ..base })?,
    ];
    let warmth = described.warmth(BUBBLES)?;
    let places = &warmth.space.places;
    let (wheel, rail) = warmth.theta.split_at(places.len());
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let near = |(p, _): &(&[f64; 2], &f64)| p[0].abs() < 0.75e-3 && p[1] + OUTER < 0.3e-3;
    let window: Vec<f64> = places.iter().zip(wheel).filter(near).map(|(_, theta)| *theta).collect();
    all.push(Candidate { name: "mean of the nodal values".into(), means: [mean(wheel), mean(rail)] });
    all.push(Candidate {
        name: "wheel's mean over the window of the figure".into(),
        means: [mean(&window), warmth.means[1]],
    });
    for (friction, regularisation) in [(0.2, 10f64.powf(-4.5)), (1.0, 10f64.powf(-4.5)), (0.4, 1e-3)] {
        let law = crate::contact::Law { friction, ..paper_c(regularisation) };
        let (_, spots) = roll(LOAD, law, &described.bodies, CREEPAGE)?;
        let name = format!("μ = {friction}, ε_r = {regularisation:.1e} m/s");
        all.push(Candidate { name, means: thermal(&described.bodies, &spots, base)?.means });
    }
    Ok(all)
}

/// Rolled meshes of one base over refinements of the whole wheel, and the wheel's means \[K] with linear SUPG and with
/// quadratic bubbles.
fn refinement(levels: std::ops::Range<usize>) -> Result<(Vec<Rolled>, [Vec<f64>; 2]), String> {
    let rolled = levels.map(|global| Rolled::new(BASE, global)).collect::<Result<Vec<_>, _>>()?;
    let means = |wheel| rolled.iter().map(|mesh| Ok(mesh.warmth(wheel)?.means[0])).collect::<Result<Vec<_>, String>>();
    let (linear, quadratic) = (means(LINEAR)?, means(BUBBLES)?);
    Ok((rolled, [linear, quadratic]))
}

/// Temperatures \[K] in words.
fn kelvin(all: &[f64]) -> String {
    all.iter().map(|theta| format!("{theta:.2e}")).collect::<Vec<_>>().join(", ")
}

/// Means over the number of triangles.
fn halved(name: &str, sequence: &Sequence) -> Curve {
    let points = sequence.counts.iter().zip(&sequence.means).map(|(count, mean)| [*count as f64, mean.log10()]);
    curve(Source::Method, name, points.collect())
}

/// Mean temperature of an annulus with a cold hub over the heat into its tread \[K m/W]: a fast wheel is axisymmetric
/// but for its skin.
fn per_heat() -> f64 {
    let square = OUTER * OUTER;
    (square * (OUTER / INNER).ln() / (square - INNER * INNER) - 0.5) / (TAU * CONDUCTIVITY)
}

/// Place where the tread is warmest within the contact \[m].
fn warmest_of_the_tread(run: &Run) -> f64 {
    let outputs = run.outputs();
    let all = outputs.profile_x.iter().zip(&outputs.profile_temperature_wheel);
    all.max_by(|a, b| a.1.total_cmp(b.1)).map_or(f64::NAN, |(x, _)| *x)
}

/// Text to C 12: mean temperatures of wheel and rail.
pub fn temperature(extent: Extent) -> Result<Figure, String> {
    let ours = Product::new("paper_c", true)?.stationary(CREEPAGE, None)?;
    // The reference knows no centrifugal load.
    let product = Product::new("paper_c", false)?;
    let run = product.rolling(SPEED, CREEPAGE, |_| ())?;
    let (still, mut plots) = (run.warmth().wheel_mean, pictures(&run)?);
    let hottest = warmest_of_the_tread(&run);
    // Half of a tenth of the friction power F V |ξ| goes to the wheel, before conduction to the rail.
    let heat = 0.05 * ours.utilisation * 0.4 * LOAD * SPEED * CREEPAGE.abs();
    let shares = [ours.wheel_mean, STATED[0]].map(|mean| 100.0 * mean / (heat * per_heat()));
    let (rolled, [linear, quadratic]) = refinement(0..extent.choose(4, 5))?;
    let fine = Rolled::new(FINE, 0)?;
    let mut others = changes(&rolled[2])?;
    let candidate = |name: &str, mesh: &Rolled, wheel| {
        Ok::<_, String>(Candidate {
            name: format!("{name}, {} triangles", mesh.count()),
            means: mesh.warmth(wheel)?.means,
        })
    };
    let bubbles_on_fine = candidate("as described but all refined at the contact", &fine, BUBBLES)?;
    others.push(bubbles_on_fine);
    let mut lines = Vec::new();
    for mesh in rolled.iter().chain([&fine]) {
        lines.push(candidate("linear, SUPG", mesh, LINEAR)?);
    }
    lines.push(candidate("linear, bubbles", &fine, (Order::Linear, Scheme::Bubble))?);
    let last = &lines[rolled.len()];
    let halvings = extent.choose(3, 4);
    let [whole, corners] = [sequence(halvings, false)?, sequence(halvings, true)?];
    let ([order, extrapolated], [corner_order, from_corners]) = (limit(&whole.means), limit(&corners.means));
    let off = extrapolated / REFERENCE - 1.0;
    let lack = lacking(1, 0..extent.choose(5, 7))?;
    let percent = lack.iter().map(|share| format!("{:.1}", 100.0 * share)).collect::<Vec<_>>().join(", ");
    let row = |c: &Candidate| format!("{}: {:.2e} and {:.2e} K", c.name, c.means[0], c.means[1]);
    let list = |all: &[Candidate]| all.iter().map(row).collect::<Vec<_>>().join("; ");
    let over = |means: &[f64]| rolled.iter().zip(means).map(|(m, t)| [m.count() as f64, t.log10()]).collect::<Vec<_>>();
    let level =
        |mean: f64| [&rolled[0], &rolled[rolled.len() - 1]].map(|mesh| [mesh.count() as f64, mean.log10()]).to_vec();
    plots.push(Plot {
        axes: ["triangles".into(), "lg of the wheel's mean temperature in K".into()],
        curves: vec![
            curve(Source::Method, "linear, SUPG", over(&linear)),
            curve(Source::Method, "quadratic, bubbles", over(&quadratic)),
            halved("graded, contact in the weights", &whole),
            halved("graded, contact at corners", &corners),
            curve(Source::Ours, "ours", level(ours.wheel_mean)),
            curve(Source::Quoted, "stated", level(STATED[0])),
        ],
    });
    Ok(Figure {
        item: "C 12",
        title: "Temperatures beside the contact, and their means in wheel and rail",
        status: Status::ThesisError,
        parameters: "Base of Paper C, ξ = −5e-5, 50 km/h; μ = 0.4 assumed. Own meshes after the thesis's recipe, n_r = 0 to 3 (in full, 4, too), and one of its number of triangles \
                     without refinement of the whole wheel.",
        finding: format!(
            "Ours {:.2e} K with the centrifugal load and {still:.2e} K without it, reference 7.52e-5 K, without it; stated 2.26e-6 K, {:.0} times less. The hub carries away what the mean temperature drives through the annulus: \
             {:.1} % of the wheel's half of the friction heat in ours, {:.1} % in the thesis, which must have lost the rest. What it describes does not \
             lose so much. Changed one at a time, wheel and rail have — {}. But linear triangles in the wheel do, by an amount that hangs on the mesh — {}. On the mesh described, \
             n_r = 2, they keep four times what is stated; where all refinement is at the contact they have the stated number. So the thesis's wheel \
             has the loss of linear triangles, which figures B 5 to B 7 show, and not that of the quadratic ones with bubbles that it describes. \
             That it was computed with them is an inference. On graded meshes of {} triangles, each with half the edges of the one before, under Carter's contact, quadratic bubbles \
             have {} K where the contact has the weights of their edges: order {order:.2}, {extrapolated:.2e} K for ever shorter edges, {:+.1} % off the reference. With the contact at \
             corners alone, as the thesis has it, a quadratic edge takes the same friction power in at points: {} K, order {corner_order:.2}, {from_corners:.2e} K. These edges are \
             too long for that order: with those in the contact alone halved again and again from a quarter of its half-width on, it lacks {percent} % of the other contact's mean, half as much \
             each time in the end, so that both have one limit.",
            ours.wheel_mean,
            ours.wheel_mean / STATED[0],
            shares[0],
            shares[1],
            list(&others),
            list(&lines),
            whole.counts.iter().map(usize::to_string).collect::<Vec<_>>().join(", "),
            kelvin(&whole.means),
            100.0 * off,
            kelvin(&corners.means)
        ),
        plots,
        values: vec![
            ("c12.wheel".into(), ours.wheel_mean),
            ("c12.wheel.method".into(), quadratic[2]),
            ("c12.rail.method".into(), others[0].means[1]),
            ("c12.wheel.linear".into(), last.means[0]),
            ("c12.rail.linear".into(), last.means[1]),
            ("c12.wheel.extrapolated".into(), extrapolated),
            ("c12.wheel.extrapolated.corners".into(), from_corners),
        ],
        predicates: vec![
            must(
                format!(
                    "linear triangles: the wheel warms with every refinement, n_r from 0 on, and stays below ours: {}",
                    kelvin(&linear)
                ),
                linear.windows(2).all(|pair| pair[1] > pair[0]) && linear.iter().all(|mean| *mean < ours.wheel_mean),
            ),
            must(
                format!(
                    "on the thesis's number of triangles within 5 %, {}, linear ones have the stated 2.26e-6 K within 10 %: {:.3e} K",
                    fine.count(),
                    last.means[0]
                ),
                (fine.count() as f64 / 8017.0 - 1.0).abs() < 0.05 && (last.means[0] / STATED[0] - 1.0).abs() < 0.1,
            ),
            must(format!("and the rail within a factor of two: {:.2}", last.misses()[1]), last.explains()),
            must(
                format!("quadratic bubbles have at least half of ours on all meshes: {}", kelvin(&quadratic)),
                quadratic.iter().all(|mean| *mean > 0.5 * ours.wheel_mean && *mean < ours.wheel_mean),
            ),
            must(
                "no other change brings the wheel within a factor of three and the rail within two",
                !others.iter().any(Candidate::explains),
            ),
            must(
                format!("without centrifugal load {still:.4e} K, within 2 % of the reference 7.5217e-5 K"),
                (still / REFERENCE - 1.0).abs() < 0.02,
            ),
            must(
                format!(
                    "the tread is warmest behind the middle of the contact, in or behind the slip zone from −0.113 mm on, as shown: {:.3} mm",
                    1e3 * hottest
                ),
                hottest < -0.1e-3,
            ),
            must(
                "reference and its heat to the hub fit the annulus",
                (0.011_648_07 * per_heat() / REFERENCE - 1.0).abs() < 1e-3,
            ),
            must(
                format!("quadratic bubbles extrapolate to the reference within 5 %: {off:+.4}, order {order:.2}"),
                off.abs() < 0.05 && order > 1.5 && whole.means.windows(2).all(|pair| pair[1] > pair[0]),
            ),
            must(
                format!("halved edges in the contact take half of that away in the end: {percent} %"),
                lack.windows(2).next_back().is_some_and(|pair| pair[1] < 0.6 * pair[0]),
            ),
            must(
                format!("the contact at corners loses a tenth or more on the same meshes: {}", kelvin(&corners.means)),
                whole.means.iter().zip(&corners.means).all(|(whole, corners)| *corners < 0.9 * whole),
            ),
        ],
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The specification expected the described scheme within a factor of three of the stated mean on a mesh of the
    /// thesis's size. That was an estimate, and it is refuted: the mesh described and one refined at the contact alone,
    /// both of about 8017 triangles, are too warm by a factor of 20. Linear triangles on the second have what is
    /// stated.
    #[test]
    fn the_described_wheel_is_twenty_times_warmer_than_stated_on_meshes_of_its_size_and_a_linear_one_as_stated() {
        let sizes = [Rolled::new(BASE, 2), Rolled::new(FINE, 0)].map(Result::unwrap);
        assert!(sizes.iter().all(|mesh| (mesh.count() as f64 / 8017.0 - 1.0).abs() < 0.05));
        let over = |mesh: &Rolled, wheel| mesh.warmth(wheel).unwrap().means[0] / STATED[0];
        let described = [0, 1].map(|k| over(&sizes[k], BUBBLES));
        let linear = [0, 1].map(|k| over(&sizes[k], LINEAR));
        println!("times the stated mean: described {described:.3?}, linear {linear:.3?}");
        assert!(described.iter().all(|factor| (20.0..24.0).contains(factor)));
        assert!((3.5..4.5).contains(&linear[0]) && (linear[1] - 1.0).abs() < 0.1);
    }

    #[test]
    fn a_wheel_of_linear_triangles_warms_with_every_refinement() {
        let (_, [linear, quadratic]) = refinement(0..2).unwrap();
        println!("linear {}, quadratic {}", kelvin(&linear), kelvin(&quadratic));
        assert!(linear[1] > linear[0] && linear.iter().all(|mean| *mean > 1.9e-6 && *mean < 3.3e-6));
        assert!(quadratic.iter().all(|mean| *mean > 3.9e-5 && *mean < 5.5e-5));
    }
}
