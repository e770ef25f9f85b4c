//! Kernels between two lines as polynomials by moments.
//!
//! Forces act by their moments with the powers of t, as a density `(1 − t²)^α` times a polynomial with these moments, and
//! displacements are projected with the same weight, so that Betti's theorem holds between lines. α lies between that of
//! tractions that end finite (0) and that of those that grow without bound towards one end (−½), as under small creepages.
//! Derivation: `docs/theory/lines.md`, section 5.

use crate::linalg::POINTS;
use crate::patch::gauss::{self, GaussLine};
use crate::patch::tiles::{Tile, TileInfluence};
use std::f64::consts::FRAC_PI_2;

/// A polynomial by powers of the place over the half-length of a line, or moments of forces with these powers [N/m].
pub type ByPowers = [f64; POINTS];

/// Polynomials by unit moments: displacements, strains or others, one for each power.
pub type ByMoments = [ByPowers; POINTS];

/// Displacement of the wheel less that of the rail on one line by the forces of one.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Between {
    /// Displacements \[m] by unit moments.
    pub displacement: ByMoments,
    /// Strains times the half-length of the displaced line \[m]; no derivatives of the former, so that forces do no
    /// work on the slopes of their own displacements.
    pub strain: ByMoments,
    /// Derivative of the displacement by the size of the displaced line while the forces stay where they are \[m].
    pub growth: ByMoments,
}

impl Between {
    /// Adds a multiple of another one.
    pub fn add(&mut self, factor: f64, other: &Self) {
        let ours = [&mut self.displacement, &mut self.strain, &mut self.growth];
        for (ours, theirs) in ours.into_iter().zip([&other.displacement, &other.strain, &other.growth]) {
            let theirs = theirs.as_flattened();
            ours.as_flattened_mut().iter_mut().zip(theirs).for_each(|(ours, theirs)| *ours += factor * theirs);
        }
    }
}

/// Exponent α of the weight \[1]: linear theory within 2 %, with least loss where lines slip.
const EXPONENT: f64 = -0.2;
/// Places on the displaced line, and on each part of the line of the force, by which kernels become polynomials.
const DISPLACED: usize = 32;
const FORCED: usize = 16;

/// Quadrature by which kernels become polynomials: the orthogonal projection on both lines, with a weight. Kernels have a
/// kink where places agree, about as wide as the lines: the integral over the line of the force is divided there, with
/// places that become denser towards it and towards the ends.
pub struct MomentProjection {
    displaced: Vec<GaussLine>,
    forced: Vec<GaussLine>,
    /// Polynomials by powers that are orthonormal with the weight: on the displaced line by its places, so that
    /// polynomials are projected to round-off, and on that of the force.
    bases: [[ByPowers; POINTS]; 2],
}

/// Displacement where the distance changes its sign.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Symmetry {
    /// It stays.
    Even,
    /// It changes its sign, too.
    Odd,
}

/// Place on a line, and the weight there times the change of t with the angle `asin t`.
#[derive(Clone, Copy)]
struct WeightedPlace {
    t: f64,
    weight: f64,
}

impl WeightedPlace {
    fn at(angle: f64) -> Self {
        let (t, cosine) = libm::sincos(angle);
        Self { t, weight: libm::pow(cosine.max(0.0), 2.0 * EXPONENT + 1.0) }
    }
}

impl MomentProjection {
    pub fn new() -> Self {
        Self::on([DISPLACED, FORCED])
    }

    /// With numbers of places on the displaced line, and on each part of the line of the force.
    fn on(numbers: [usize; 2]) -> Self {
        let [displaced, forced] = numbers.map(gauss::rule);
        let places =
            displaced.iter().map(|line| (WeightedPlace::at(FRAC_PI_2 * line.ordinate), FRAC_PI_2 * line.weight));
        let bases = [orthonormal(&places.collect::<Vec<_>>()), orthonormal(&from(&forced, 0.0).collect::<Vec<_>>())];
        Self { displaced, forced, bases }
    }

    /// Adds the projections of `factor` times kernels of given symmetries between two lines. What a line's own kernel is at
    /// no distance, in which the unit of length is, is projected to round-off.
    ///
    /// Places on one half of the displaced line say what those on the other half do: forces there act as their mirror
    /// images.
    pub fn add<const K: usize>(
        &self,
        [at, of]: [&Tile; 2],
        factor: f64,
        (symmetries, kernels): ([Symmetry; K], impl Fn(f64) -> [TileInfluence; K]),
        mut sums: [&mut Between; K],
    ) {
        let apart = if at == of { kernels(0.0) } else { [TileInfluence::default(); K] };
        for (sum, apart) in sums.iter_mut().zip(&apart) {
            sum.displacement[0][0] += factor * apart.displacement;
            sum.growth[0][0] += factor * apart.growth;
        }
        for line in self.displaced.iter().filter(|line| line.ordinate > 0.0) {
            let WeightedPlace { t, weight } = WeightedPlace::at(FRAC_PI_2 * line.ordinate);
            let (x, weight) = (at.half_length * t, 2.0 * FRAC_PI_2 * line.weight * weight);
            let duals = dual(&self.bases[0], t).map(|dual| weight * dual);
            let mut rows = [[[0.0; 3]; POINTS]; K];
            for (WeightedPlace { t, weight }, part) in from(&self.forced, (x / of.half_length).clamp(-1.0, 1.0)) {
                let duals = dual(&self.bases[1], t).map(|dual| factor * part * weight * dual);
                let influences = kernels(x - of.half_length * t);
                for (rows, (influence, apart)) in rows.iter_mut().zip(influences.iter().zip(&apart)) {
                    let TileInfluence { displacement, strain, growth } = influence;
                    let values = [displacement - apart.displacement, strain * at.half_length, growth - apart.growth];
                    for (row, dual) in rows.iter_mut().zip(&duals) {
                        row.iter_mut().zip(values).for_each(|(row, value)| *row += dual * value);
                    }
                }
            }
            for (sum, (rows, symmetry)) in sums.iter_mut().zip(rows.iter().zip(symmetries)) {
                for (n, row) in rows.iter().enumerate() {
                    for (k, dual) in duals.iter().enumerate() {
                        if (n + k).is_multiple_of(2) == (symmetry == Symmetry::Even) {
                            sum.displacement[n][k] += dual * row[0];
                            sum.growth[n][k] += dual * row[2];
                        } else {
                            sum.strain[n][k] += dual * row[1];
                        }
                    }
                }
            }
        }
    }
}

/// Places of a rule on both sides of a place, or on one side of an end, and the parts of the angle that belong to them.
fn from(rule: &[GaussLine], t: f64) -> impl Iterator<Item = (WeightedPlace, f64)> {
    let middle = libm::asin(t);
    [-FRAC_PI_2, FRAC_PI_2].into_iter().map(move |end| end - middle).filter(|way| *way != 0.0).flat_map(move |way| {
        rule.iter().map(move |line| {
            let u = 0.5 * (1.0 + line.ordinate);
            let part = 3.0 * line.weight * way.abs() * u * (1.0 - u);
            (WeightedPlace::at(middle + way * u * u * (3.0 - 2.0 * u)), part)
        })
    })
}

/// Value of a polynomial by powers.
fn value(polynomial: &ByPowers, t: f64) -> f64 {
    polynomial.iter().rev().fold(0.0, |sum, c| sum * t + c)
}

/// Polynomials whose weighted products with a function integrate to the coefficients of its projection, at a place.
fn dual(basis: &[ByPowers; POINTS], t: f64) -> ByPowers {
    let mut sum = ByPowers::default();
    for polynomial in basis {
        let value = value(polynomial, t);
        sum.iter_mut().zip(polynomial).for_each(|(sum, c)| *sum += value * c);
    }
    sum
}

/// Polynomials that are orthonormal by a sum over places, which lie as those of Gegenbauer's on both sides of the middle
/// (T. J. Stieltjes' recurrence).
fn orthonormal(places: &[(WeightedPlace, f64)]) -> [ByPowers; POINTS] {
    let (mut before, mut now, mut last) = ([0.0; POINTS], [0.0; POINTS], 0.0);
    now[0] = 1.0;
    std::array::from_fn(|_| {
        let square: f64 =
            places.iter().map(|(WeightedPlace { t, weight }, part)| part * weight * value(&now, *t).powi(2)).sum();
        let (found, fall) = (now.map(|c| c / square.sqrt()), if last > 0.0 { square / last } else { 0.0 });
        let next = std::array::from_fn(|k| if k > 0 { now[k - 1] } else { 0.0 } - fall * before[k]);
        (before, now, last) = (now, next, square);
        found
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn densities_have_the_moments_for_which_they_stand_wherever_the_line_is_divided() {
        let MomentProjection { forced, bases, .. } = MomentProjection::new();
        for (k, power) in (0..POINTS).flat_map(|k| (0..POINTS).map(move |power| (k, power))) {
            let moment: f64 = from(&forced, 0.3)
                .map(|(WeightedPlace { t, weight }, part)| part * weight * dual(&bases[1], t)[k] * t.powi(power as i32))
                .sum();
            let expected = if k == power { 1.0 } else { 0.0 };
            assert!((moment - expected).abs() < 1e-4, "{k} {power}: {moment}");
        }
    }

    /// Tile of its own, and beside a longer and a shorter one.
    #[test]
    fn twice_the_places_give_the_same_polynomials() {
        let tile = |low: f64, high: f64, half_length: f64| Tile { edges: [low, high], half_length };
        let (at, beside) = (tile(-0.3, 0.3, 2.0), [tile(0.3, 0.7, 1.8), tile(0.7, 1.0, 0.6)]);
        let ways = [Symmetry::Even, Symmetry::Even, Symmetry::Odd].into_iter().enumerate();
        for (of, (way, symmetry)) in
            [at].into_iter().chain(beside).flat_map(|of| ways.clone().map(move |way| (of, way)))
        {
            let [found, fine] = [1, 2].map(|times| {
                let mut sum = Between::default();
                let projection = MomentProjection::on([times * DISPLACED, times * FORCED]);
                let kernel = |x: f64| [at.displaced_every_way(of, x, 0.3)[way]];
                projection.add([&at, &of], 1.0, ([symmetry], kernel), [&mut sum]);
                [sum.displacement, sum.strain, sum.growth]
            });
            for ((found, fine), most) in found.iter().zip(&fine).zip([5e-4, 6e-3, 2e-2]) {
                let (found, fine) = (found.as_flattened(), fine.as_flattened());
                let largest = fine.iter().fold(0.0_f64, |most, c| most.max(c.abs()));
                let error = found.iter().zip(fine).fold(0.0_f64, |most, (found, fine)| most.max((found - fine).abs()));
                println!("{:?}: {error:.1e} of {largest:.2}", of.edges);
                assert!(error <= most * largest);
            }
        }
    }

    /// The projection of [`MomentProjection::add`] of one kernel over all places on the displaced line, whatever it is on the
    /// other half.
    fn plain(projection: &MomentProjection, [at, of]: [&Tile; 2], kernel: impl Fn(f64) -> TileInfluence) -> Between {
        let (mut sum, mut apart) = (Between::default(), TileInfluence::default());
        if at == of {
            apart = kernel(0.0);
            sum.displacement[0][0] = apart.displacement;
            sum.growth[0][0] = apart.growth;
        }
        for line in &projection.displaced {
            let WeightedPlace { t, weight } = WeightedPlace::at(FRAC_PI_2 * line.ordinate);
            let (x, ways) = (at.half_length * t, dual(&projection.bases[0], t));
            for (WeightedPlace { t, weight: there }, part) in
                from(&projection.forced, (x / of.half_length).clamp(-1.0, 1.0))
            {
                let (found, forces) = (kernel(x - of.half_length * t), dual(&projection.bases[1], t));
                for (n, k) in (0..POINTS).flat_map(|n| (0..POINTS).map(move |k| (n, k))) {
                    let by = FRAC_PI_2 * line.weight * weight * ways[k] * part * there * forces[n];
                    sum.displacement[n][k] += by * (found.displacement - apart.displacement);
                    sum.strain[n][k] += by * found.strain * at.half_length;
                    sum.growth[n][k] += by * (found.growth - apart.growth);
                }
            }
        }
        sum
    }

    /// Lines of uneven widths, lengths and distances, their own kernels among them, and with the image of a line on the other
    /// side of the middle.
    #[test]
    fn half_a_line_says_what_the_other_half_does_wherever_lines_lie() {
        let mut state = 7_u64;
        let mut random = |low: f64, high: f64| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            low + (high - low) * (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        let (projection, symmetries) = (MomentProjection::new(), [Symmetry::Even, Symmetry::Even, Symmetry::Odd]);
        let mut worst = 0.0_f64;
        for round in 0..40 {
            let scale = 10_f64.powf(random(-4.0, 0.0));
            let mut tile = || {
                let low = random(-1.0, 1.0);
                Tile {
                    edges: [low, low + random(0.02, 1.0)].map(|z| scale * z),
                    half_length: scale * random(0.05, 2.0),
                }
            };
            let (at, other) = (tile(), tile());
            let of = match round % 3 {
                0 => at,
                1 => Tile { edges: [at.edges[1], at.edges[1] + other.width()], ..other },
                _ => other,
            };
            let kernels = |x: f64| {
                let mut ways = at.displaced_every_way(of, x, 0.3);
                // The image of a pair, of which only symmetric kernels are asked for.
                ways[0].add(&at.displaced_by(of.mirrored(), x, 0.3));
                ways
            };
            let mut sums = [Between::default(); 3];
            projection.add([&at, &of], 1.0, (symmetries, kernels), sums.each_mut());
            for (way, found) in sums.iter().enumerate() {
                let whole = plain(&projection, [&at, &of], |x| kernels(x)[way]);
                for (found, whole) in [
                    (&found.displacement, &whole.displacement),
                    (&found.strain, &whole.strain),
                    (&found.growth, &whole.growth),
                ] {
                    let (found, whole) = (found.as_flattened(), whole.as_flattened());
                    let largest = whole.iter().fold(1e-3_f64, |most, c| most.max(c.abs()));
                    let off = found.iter().zip(whole).fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
                    worst = worst.max(off / largest);
                }
            }
        }
        println!("halves differ by at most {worst:.1e}");
        assert!(worst < 1e-10);
    }
}
