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

/// Places of the rule by which kernels become polynomials: on the lines themselves they have a kink.
const PLACES: usize = 40;
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
        let (rule, factor) = (Rule::new(), 1.0 / (PI * shear_modulus));
        let logarithm = 2.0 * (1.0 - nu) * factor;
        let (mut pairs, mut reaches) = (Vec::with_capacity(tiles.len() * tiles.len()), Vec::new());
        for (line, at) in tiles.iter().enumerate() {
            let (first, mut reach) = (pairs.len(), 0.0);
            for of in tiles {
                let beside = mirrored && of.edges[0] + of.edges[1] > LEAST_OFFSET * of.width();
                let images = [Some(*of), beside.then(|| of.mirrored())];
                let mut pair = Between::default();
                for image in images.into_iter().flatten() {
                    rule.add([at, of], factor, |x| at.displaced_by(image, x, nu), &mut pair);
                }
                reach += mean(&pair.displacement) / logarithm;
                pairs.push(pair);
            }
            // A constant displacement may belong to the logarithm as well.
            let own = &mut pairs[first + line];
            own.displacement[0][0] -= logarithm * reach;
            own.growth[0][0] += 0.5 * logarithm * reach;
            reaches.push(reach);
        }
        (Self { lines: tiles.len(), pairs }, reaches)
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

/// Quadrature on [−1, 1], and the weights that make polynomials of the values: the orthogonal projection.
struct Rule {
    places: Vec<f64>,
    /// By power.
    weights: [Vec<f64>; POINTS],
}

impl Rule {
    fn new() -> Self {
        let rule = gauss::rule(PLACES);
        let weight = |k: usize, line: &GaussLine| {
            let term = |n: usize| (n as f64 + 0.5) * LEGENDRE[n][k] * value(&LEGENDRE[n], line.ordinate);
            line.weight * (0..POINTS).map(term).sum::<f64>()
        };
        let weights = std::array::from_fn(|k| rule.iter().map(|line| weight(k, line)).collect());
        Self { places: rule.iter().map(|line| line.ordinate).collect(), weights }
    }

    /// Adds the projection of `factor` times a kernel between two lines.
    fn add(&self, [at, of]: [&Tile; 2], factor: f64, kernel: impl Fn(f64) -> Influence, sum: &mut Between) {
        for (q, t) in self.places.iter().enumerate() {
            // Along the line of the force first.
            let mut rows = [[0.0; 3]; POINTS];
            for (r, s) in self.places.iter().enumerate() {
                let Influence { displacement, strain, growth } = kernel(at.half_length * t - of.half_length * s);
                let values = [displacement, strain * at.half_length, growth];
                for (row, weights) in rows.iter_mut().zip(&self.weights) {
                    row.iter_mut().zip(values).for_each(|(row, value)| *row += factor * weights[r] * value);
                }
            }
            for (n, row) in rows.iter().enumerate() {
                for (k, weights) in self.weights.iter().enumerate() {
                    sum.displacement[n][k] += weights[q] * row[0];
                    sum.strain[n][k] += weights[q] * row[1];
                    sum.growth[n][k] += weights[q] * row[2];
                }
            }
        }
    }
}

/// Mean over a line of its displacement by a unit force that is spread over the other one.
fn mean(displacement: &ByMoments) -> f64 {
    let of_power = |k: usize| if k.is_multiple_of(2) { 1.0 / (k + 1) as f64 } else { 0.0 };
    let of_moment = |by: &Powers| by.iter().enumerate().map(|(k, by)| of_power(k) * by).sum::<f64>();
    displacement.iter().enumerate().map(|(n, by)| of_power(n) * of_moment(by)).sum()
}
