//! Flexibility of the lines of a patch under the tangential forces of all of them.
//!
//! Half-spaces displace a line by the forces on its own strip and on all others. Of the own ones the logarithm of the
//! distance is left to the line itself ([`super::LineKernel`]); the rest is smooth, and felt through moments:
//! displacements and strains are polynomials of the place over the half-length of the line, `t = x/a`, and forces act
//! by their moments with the powers of t. So all coefficients are the same under any load.
//! Derivation: `docs/theory/lines.md`, section 5.

use crate::linalg::POINTS;
use crate::patch::gauss::{self, GaussLine};
use crate::patch::tiles::{Influence, Tile};
use std::f64::consts::PI;

/// A polynomial by powers of the place over the half-length of a line, or moments of forces with these powers [N/m].
pub type Powers = [f64; POINTS];

/// Polynomials by unit moments: displacements, strains or others, one for each power.
pub type ByMoments = [Powers; POINTS];

/// Places on the displaced line, and on each part of the line of the force, by which kernels become polynomials.
const DISPLACED: usize = 32;
const FORCED: usize = 16;
/// Place over the half-length beyond which displacements of a line stay as they are there \[1].
pub const BEYOND: f64 = 1.3;

/// Offset of a strip from the middle over its width beyond which it has a mirror image \[1].
const LEAST_OFFSET: f64 = 1e-9;
/// Coefficients of Legendre's polynomials by powers.
const LEGENDRE: [Powers; POINTS] = [
    [1.0, 0.0, 0.0, 0.0, 0.0],
    [0.0, 1.0, 0.0, 0.0, 0.0],
    [-0.5, 0.0, 1.5, 0.0, 0.0],
    [0.0, -1.5, 0.0, 2.5, 0.0],
    [0.375, 0.0, -3.75, 0.0, 4.375],
];

/// Displacement of the wheel less that of the rail on one line by the forces of one.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Between {
    /// Displacements \[m] by unit moments.
    pub displacement: ByMoments,
    /// Strains times the half-length of the displaced line \[m]; no derivatives of the former, so that forces do no work
    /// on the slopes of their own displacements.
    pub strain: ByMoments,
    /// Derivative of the displacement by the size of the displaced line while the forces stay where they are \[m].
    pub growth: ByMoments,
}

/// What the forces of a patch do to one of its lines.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Field {
    /// Displacement of the wheel less that of the rail \[m].
    pub displacement: Powers,
    /// Its strain times the half-length of the line \[m].
    pub strain: Powers,
}

/// Flexibility of all lines of a patch.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PatchFlexibility {
    lines: usize,
    /// By displaced line, then by line of the force.
    pairs: Vec<Between>,
}

/// A line as part of a patch that displaces it.
#[derive(Clone, Copy)]
pub struct InPatch<'a> {
    /// Flexibility of the patch.
    pub flexibility: &'a PatchFlexibility,
    /// Number of the line in it.
    pub line: usize,
    /// Half-length of the line in the layout \[m].
    pub half_length: f64,
}

impl PatchFlexibility {
    /// That of half-spaces with a shear modulus \[Pa] and Poisson's ratio \[1] under lines on `tiles`; with `mirrored`
    /// those beside the middle stand for a symmetric pair. Besides, for every line the logarithm of the distance over 1 m
    /// at which a force of its own no longer displaces it by more than the mean over all lines.
    pub fn new(tiles: &[Tile], mirrored: bool, (shear_modulus, nu): (f64, f64)) -> (Self, Vec<f64>) {
        let (projection, factor, count) = (Projection::new(), 1.0 / (PI * shear_modulus), tiles.len());
        let beside = |tile: &Tile| mirrored && tile.edges[0] + tile.edges[1] > LEAST_OFFSET * tile.width();
        let mut pairs = vec![Between::default(); count * count];
        for (pair, (at, of)) in pairs.iter_mut().zip(tiles.iter().flat_map(|at| tiles.iter().map(move |of| (at, of)))) {
            for image in [Some(*of), beside(of).then(|| of.mirrored())].into_iter().flatten() {
                projection.add([at, of], factor, |x| at.displaced_by(image, x, nu), pair);
            }
        }
        let width = |tile: &Tile| if beside(tile) { 2.0 * tile.width() } else { tile.width() };
        for (i, j) in (0..count).flat_map(|i| (i..count).map(move |j| (i, j))) {
            let [mut first, mut second] = [pairs[i * count + j], pairs[j * count + i]];
            let of = [&tiles[i], &tiles[j]];
            reconcile([&mut first, &mut second], of.map(width), of.map(|tile| tile.half_length));
            (pairs[i * count + j], pairs[j * count + i]) = (first, second);
        }
        // A constant displacement may belong to the logarithm as well.
        let logarithm = 2.0 * (1.0 - nu) * factor;
        let reaches = (0..count).map(|line| {
            let reach =
                pairs[line * count..][..count].iter().map(|pair| mean(&pair.displacement)).sum::<f64>() / logarithm;
            pairs[line * (count + 1)].displacement[0][0] -= logarithm * reach;
            pairs[line * (count + 1)].growth[0][0] += 0.5 * logarithm * reach;
            reach
        });
        let reaches = reaches.collect();
        (Self { lines: count, pairs }, reaches)
    }

    /// What forces of a line `by` do to a line `at`.
    pub fn between(&self, at: usize, by: usize) -> &Between {
        &self.pairs[at * self.lines + by]
    }

    /// Sum over the forces of all lines with the given moments [N/m], by line, on the line `at`.
    pub fn sum<'a>(
        &self,
        at: usize,
        moments: impl IntoIterator<Item = &'a Powers>,
        of: impl Fn(&Between) -> &ByMoments,
    ) -> Powers {
        let mut sum = Powers::default();
        for (by, moments) in moments.into_iter().enumerate() {
            add(of(self.between(at, by)), moments, &mut sum);
        }
        sum
    }
}

/// Adds the polynomial that belongs to moments.
pub fn add(by_moments: &ByMoments, moments: &Powers, sum: &mut Powers) {
    for (by_moment, moment) in by_moments.iter().zip(moments) {
        sum.iter_mut().zip(by_moment).for_each(|(sum, by)| *sum += by * moment);
    }
}

/// Value at the place t of a polynomial.
pub fn value(polynomial: &Powers, t: f64) -> f64 {
    polynomial.iter().rev().fold(0.0, |sum, c| sum * t + c)
}

impl Between {
    /// What forces with given moments do.
    pub fn field(&self, moments: &Powers) -> Field {
        let mut field = Field::default();
        add(&self.displacement, moments, &mut field.displacement);
        add(&self.strain, moments, &mut field.strain);
        field
    }
}

impl Field {
    /// Slip [m/s] as a polynomial, given the weight of a displacement in its rate [1/s] and the sum of the speeds of both
    /// surfaces [m/s], half of which carries the strain.
    pub fn slip(&self, [rate, speed]: [f64; 2], half_length: f64) -> Powers {
        let by_strain = -0.5 * speed / half_length;
        std::array::from_fn(|k| rate * self.displacement[k] + by_strain * self.strain[k])
    }
}

impl InPatch<'_> {
    /// What the forces of all lines with the given moments do to this one.
    pub fn field<'a>(&self, moments: impl Iterator<Item = &'a Powers> + Clone) -> Field {
        let sum = |of: fn(&Between) -> &ByMoments| self.flexibility.sum(self.line, moments.clone(), of);
        Field { displacement: sum(|by| &by.displacement), strain: sum(|by| &by.strain) }
    }

    /// Place over the half-length of the line \[1]; those far beyond its ends count as one not so far.
    pub fn place(&self, x: f64) -> f64 {
        (x / self.half_length).clamp(-BEYOND, BEYOND)
    }
}

/// Quadrature by which kernels become polynomials: the orthogonal projection on both lines. Kernels have a kink where
/// places agree, about as wide as the lines: the integral over the line of the force is divided there, with places that
/// become denser towards it.
struct Projection {
    displaced: Vec<GaussLine>,
    forced: Vec<GaussLine>,
}

impl Projection {
    fn new() -> Self {
        Self { displaced: gauss::rule(DISPLACED), forced: gauss::rule(FORCED) }
    }

    /// Adds the projection of `factor` times a kernel between two lines.
    fn add(&self, [at, of]: [&Tile; 2], factor: f64, kernel: impl Fn(f64) -> Influence, sum: &mut Between) {
        for line in &self.displaced {
            let (x, weights) = (at.half_length * line.ordinate, dual(line.ordinate));
            let middle = (x / of.half_length).clamp(-1.0, 1.0);
            let mut rows = [[0.0; 3]; POINTS];
            for (end, line) in
                [-1.0, 1.0].iter().flat_map(|end| self.forced.iter().map(move |line| (end - middle, line)))
            {
                let u = 0.5 * (1.0 + line.ordinate);
                let (t, weight) = (middle + end * u * u, factor * line.weight * end.abs() * u);
                let Influence { displacement, strain, growth } = kernel(x - of.half_length * t);
                for (row, dual) in rows.iter_mut().zip(dual(t)) {
                    let values = [displacement, strain * at.half_length, growth];
                    row.iter_mut().zip(values).for_each(|(row, value)| *row += weight * dual * value);
                }
            }
            for (n, row) in rows.iter().enumerate() {
                for (k, weight) in weights.iter().map(|weight| line.weight * weight).enumerate() {
                    sum.displacement[n][k] += weight * row[0];
                    sum.strain[n][k] += weight * row[1];
                    sum.growth[n][k] += weight * row[2];
                }
            }
        }
    }
}

/// Polynomials whose products with a function integrate to the coefficients of its projection, at a place.
fn dual(t: f64) -> Powers {
    let mut sum = Powers::default();
    for (n, legendre) in LEGENDRE.iter().enumerate() {
        let factor = (n as f64 + 0.5) * value(legendre, t);
        sum.iter_mut().zip(legendre).for_each(|(sum, c)| *sum += factor * c);
    }
    sum
}

/// Makes tables of two lines that displace each other, which stand for the given widths, obey Betti's theorem to
/// round-off: displacements symmetric, strains antisymmetric.
fn reconcile([first, second]: [&mut Between; 2], widths: [f64; 2], lengths: [f64; 2]) {
    for n in 0..POINTS {
        for k in 0..POINTS {
            let [there, back] = [widths[0] * first.displacement[n][k], widths[1] * second.displacement[k][n]];
            let mean = 0.5 * (there + back);
            (first.displacement[n][k], second.displacement[k][n]) = (mean / widths[0], mean / widths[1]);
            let scales = [widths[0] / lengths[0], widths[1] / lengths[1]];
            let [there, back] = [scales[0] * first.strain[n][k], scales[1] * second.strain[k][n]];
            let mean = 0.5 * (there - back);
            (first.strain[n][k], second.strain[k][n]) = (mean / scales[0], -mean / scales[1]);
        }
    }
}

/// Mean over a line of its displacement by a unit force that is spread over the other one.
fn mean(displacement: &ByMoments) -> f64 {
    let of_power = |k: usize| if k.is_multiple_of(2) { 1.0 / (k + 1) as f64 } else { 0.0 };
    let of_moment = |by: &Powers| by.iter().enumerate().map(|(k, by)| of_power(k) * by).sum::<f64>();
    displacement.iter().enumerate().map(|(n, by)| of_power(n) * of_moment(by)).sum()
}
