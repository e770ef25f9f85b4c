//! Text to Paper D, figure 18: the share of the limit at a creepage, and how much of it is the mesh.

use super::mesh_heat::{ANNULUS, PLATE, meshes, roll};
use super::{Extent, Figure, Predicate, curve, must};
use crate::annulus::OUTER;
use crate::contact::Law;
use crate::ours::Product;
use crate::plot::{Plot, Source};
use crate::quoted::Status;
use crate::{rail, wheel};
use wheelrail::analytic::{carter_force, carter_full_slip, contact_modulus, hertz_half_width};

const LOAD: f64 = 100e3;
const CREEPAGE: f64 = 1.9e-4;
const LAW: Law = Law { penalty: 5e12, friction: 0.4, regularisation: 1e-4 };
/// Edges under the contact over half of it before the wheel is refined as a whole: a row fixed before anything was
/// computed, each 2^(−1/2) of the one before down to about that of figure B 11. All of them are shown with each number
/// of refinements.
const EDGES: [f64; 4] = [0.8, 0.566, 0.4, 0.283];
/// Refinements of the whole wheel; in full, one more.
const REFINEMENTS: [usize; 3] = [1, 2, 3];

/// Edges and refinements of the meshes, none left out of the row.
fn row(extent: Extent) -> Vec<(f64, usize)> {
    let refinements = &REFINEMENTS[..extent.choose(2, 3)];
    EDGES.iter().flat_map(|base| refinements.iter().map(move |global| (*base, *global))).collect()
}

/// Shares of the limit in traction and braking on edges of a tenth of the half-width, where the law counts for more and
/// the mesh for less than on any mesh of the thesis.
struct Softened {
    /// By tanh.
    tanh: [f64; 2],
    /// By the product.
    ours: [f64; 2],
}

/// The share that the specification calls exact: ours when a prescribed moment brakes to the stated creepage.
const EXACT: f64 = 0.531;

impl Softened {
    fn new(a: f64) -> Result<Self, String> {
        let wheel = wheel::rolling(ANNULUS, 1.5 * a, 0.1 * a, 1, 0.3).map_err(|error| error.to_string())?;
        let bodies = [wheel, rail::rolling(PLATE, 61, 2.0 * a, 0.1 * a)];
        let tanh = [roll(LOAD, LAW, &bodies, -CREEPAGE)?.0, -roll(LOAD, LAW, &bodies, CREEPAGE)?.0];
        let product = Product::new("paper_d", true)?;
        let share = |creepage: f64| product.stationary(creepage, None).map(|run| run.utilisation);
        Ok(Self { tanh, ours: [share(-CREEPAGE)?, -share(CREEPAGE)?] })
    }

    /// Mean of traction and braking, which leaves out most of what an uneven mesh adds, by tanh.
    fn mean(&self) -> f64 {
        0.5 * (self.tanh[0] + self.tanh[1])
    }

    fn finding(&self) -> String {
        format!(
            "On edges of a tenth of the half-width tanh leaves {:.3} in braking and {:.3} in the mean of both signs, the exact law {:.3} in ours.",
            self.tanh[1],
            self.mean(),
            self.ours[1]
        )
    }

    fn values(&self) -> [(String, f64); 3] {
        [("braking", self.tanh[1]), ("mean", self.mean()), ("ours", self.ours[1])]
            .map(|(name, value)| (format!("d18.tanh.{name}"), value))
    }

    fn predicate(&self) -> Predicate {
        let ([_, braking], [_, ours], mean) = (self.tanh, self.ours, self.mean());
        must(
            format!(
                "tanh is below the exact law there: {braking:.4} of {ours:.4} in braking, {mean:.4} of {EXACT} in the mean of both signs"
            ),
            braking < ours && mean < EXACT,
        )
    }
}

/// Shares by the thesis's method over the number of triangles, beside Carter's `share` and the stated one.
fn plot(rows: &[[f64; 4]], share: f64) -> Plot {
    let last = rows[rows.len() - 1];
    let over = |k: usize| rows.iter().map(|row| [row[0], row[k]]).collect::<Vec<_>>();
    let level = |value: f64| vec![[rows[0][0], value], [last[0], value]];
    Plot {
        axes: ["triangles".into(), "|F|/μP".into()],
        curves: vec![
            curve(Source::Method, "traction", over(1)),
            curve(Source::Method, "braking", over(3)),
            curve(
                Source::Exact,
                "Carter",
                (0..=20).map(|i| [rows[0][0] + (last[0] - rows[0][0]) * f64::from(i) / 20.0, share]).collect(),
            ),
            curve(Source::Quoted, "stated", level(0.48)),
        ],
    }
}

/// Text to D 18: share of the limit at the largest creepage.
pub fn braking(extent: Extent) -> Result<Figure, String> {
    let a = hertz_half_width(LOAD, OUTER, contact_modulus(200e9, 0.3));
    let full = carter_full_slip(LAW.friction, a, OUTER);
    let share = carter_force(-CREEPAGE, full);
    let mut rows = Vec::new();
    for (base, global) in row(extent) {
        let bodies = meshes(LOAD, base, global)?;
        let at = |creepage: f64| roll(LOAD, LAW, &bodies, creepage).map(|(force, _)| force);
        let count = (bodies[0].triangles.len() + bodies[1].triangles.len()) as f64;
        rows.push([count, at(-CREEPAGE)?, at(0.0)?, -at(CREEPAGE)?]);
    }
    let softened = Softened::new(a)?;
    rows.sort_by(|a: &[f64; 4], b| a[0].total_cmp(&b[0]));
    let braking = || rows.iter().map(|row| row[3]);
    let (low, high) = (braking().fold(f64::MAX, f64::min), braking().fold(f64::MIN, f64::max));
    let average = braking().sum::<f64>() / rows.len() as f64;
    let spread = (braking().map(|share| (share - average).powi(2)).sum::<f64>() / rows.len() as f64).sqrt();
    let mean = rows.iter().fold(0.0_f64, |worst, row| worst.max((0.5 * (row[1] + row[3]) - share).abs()));
    let last = rows[rows.len() - 1];
    let list: Vec<String> =
        rows.iter().map(|r| format!("{:.0}: {:.3}, {:+.3}, {:.3}", r[0], r[1], r[2], r[3])).collect();
    Ok(Figure {
        item: "D 18",
        title: "Controlled braking: share of the limit at the largest creepage",
        status: Status::ThesisError,
        parameters: "r 0.5 m, P 100 kN/m, μ 0.4, creepage 1.9e-4 as stated, ε_r 1e-4 m/s; base mesh of Paper D not stated: edges of 0.8 a, each 2^(−1/2) of the one before, with each number of refinements, a row fixed beforehand of which none is left out; linear triangles, no heat.",
        finding: format!(
            "Carter: {share:.3} of the limit; stated 0.48, which the text reads off figure D 6. Triangles: share in traction, without creepage, in braking by the \
             thesis's method: {}. In braking that is {average:.2} in the mean with a standard deviation of {spread:.2}, {low:.2} to {high:.2}, and 0.48 lies within: uneven \
             meshes add a force that figure D 6 has, too, without creepage, {:+.2} on the coarsest and {:+.3} on the finest. The mean of traction and braking, \
             which leaves it out, is within {mean:.3} of Carter on all. So a coarse mesh can have given 0.48; the law does not, nor does the mesh with \
             most triangles, {:.3}. {}",
            list.join("; "),
            rows[0][2],
            last[2],
            last[3],
            softened.finding()
        ),
        plots: vec![plot(&rows, share)],
        values: [
            ("closed.d18.share".into(), share),
            ("closed.d6.full_slip".into(), full),
            ("d18.method.low".into(), low),
            ("d18.method.high".into(), high),
            ("d18.method.mean".into(), average),
            ("d18.method.spread".into(), spread),
        ]
        .into_iter()
        .chain(softened.values())
        .collect(),
        predicates: vec![
            softened.predicate(),
            must("0.527 ± 0.001 by Carter's law", (share - 0.527).abs() < 1e-3),
            must(
                format!("the stated 0.48 within the scatter of the thesis's method: {low:.3} to {high:.3}"),
                low < 0.48 && high > 0.48,
            ),
            must(
                format!("traction and braking have Carter's share in their mean within 0.06 on all meshes: {mean:.3}"),
                mean < 0.06,
            ),
            must(
                format!("the force without creepage fades to 0.03 of the limit: {:+.3}", last[2]),
                last[2].abs() < 0.03,
            ),
            must(
                format!("the mesh with most triangles is within 0.05 of Carter in braking: {:.3}", last[3]),
                (last[3] - share).abs() < 0.05,
            ),
        ],
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn in_full_the_row_of_meshes_has_all_the_quick_ones_and_one_more_refinement_of_each() {
        let (quick, full) = (row(Extent::Quick), row(Extent::Full));
        assert_eq!((quick.len(), full.len()), (8, 12));
        assert!(quick.iter().all(|mesh| full.contains(mesh)));
        assert!(full.iter().filter(|mesh| !quick.contains(mesh)).all(|(_, global)| *global == 3));
    }
}
