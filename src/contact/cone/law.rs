//! Friction on one line under given pressures: the shear of every place stays within a disc of D directions, along the line
//! or along and across.
//!
//! Of the shear q, the slip s and the radius g of the disc, `q = P(q − r s)` says Coulomb's law for any `r > 0`, with the
//! projection P on the disc. Slips stand half a place upstream of their shear. In two directions a shear that slips would
//! point against the slip there, and not where it stands: so its slip is corrected once by the difference of both in the
//! solution without. A step of Newton's method makes the law linear: what sticks has no slip, and what slips turns along
//! the circle. In one direction the disc is an interval, and nothing turns.
//! Theory: `docs/theory/patch-contact.md`, section 3.

use crate::contact::flexibility::ByPowers;
use crate::linalg::vectorised::vectorised;

/// Slip times r over the radius of the disc at which half of the correction counts \[1].
const BEGINNING: f64 = 0.05;

/// Values at all places by direction: along, then across.
pub type ByDirection<const N: usize, const D: usize> = [[f64; N]; D];
/// Polynomials of the place over the half-length of the line by direction, or moments with its powers.
pub type Polynomials<const D: usize> = [ByPowers; D];

/// Slips at the places of a line, by the shear there.
#[derive(Clone)]
pub struct SlipRows<const N: usize, const D: usize> {
    /// Slips in every direction by the shear of every point in this direction [m/s/Pa].
    pub by_shear: [Vec<[f64; N]>; D],
    /// Slips without any shear [m/s].
    pub known: ByDirection<N, D>,
    /// Powers of the place over the half-length of the line.
    pub powers: Vec<[f64; N]>,
}

/// The tangential problem of one line.
#[derive(Clone)]
pub struct ConeProblem<const N: usize, const D: usize> {
    /// Slips that friction sees.
    pub rows: SlipRows<N, D>,
    /// Slips in the place of the shear; `None`: friction sees these.
    in_place: Option<SlipRows<N, D>>,
    /// Change of the slip of every point by its shear [m/s/Pa], the largest one of all directions.
    pub least: [f64; N],
    /// Moments of the shear of every point with the powers of the places \[m].
    moments: Vec<[f64; N]>,
    /// Friction that points bear, and that at the peak of the pressure \[Pa].
    bears: [f64; N],
    most: f64,
}

/// State that friction asks of a point, and what is missing.
#[derive(Clone, Copy)]
pub enum PointState<const D: usize> {
    /// Stick, with the slip that is left [m/s].
    Stick { slip: [f64; D] },
    /// Slip against `direction`; `turn`: how much of a turn of the shear is left over, over r [m/s/Pa]; `excess`: shear
    /// beyond that of friction \[Pa].
    Slip { direction: [f64; D], turn: f64, excess: [f64; D] },
}

/// States that friction asks of all points of a line.
pub struct ConeVerdict<const N: usize, const D: usize> {
    pub points: [PointState<D>; N],
    /// Largest violation of friction over its peak \[1].
    pub largest: f64,
}

vectorised! {
    /// Adds slips of all points by a shear and by polynomials.
    fn add_slips<'a, S, const N: usize, const D: usize>(
        _simd,
        rows: &'a SlipRows<N, D>,
        shear: &'a ByDirection<N, D>,
        others: [&'a [f64]; D],
        slips: &'a mut ByDirection<N, D>,
    ) {
        for c in 0..D {
            let mut sum = slips[c];
            for (by, strength) in rows.by_shear[c].iter().zip(&shear[c]) {
                for i in 0..N {
                    sum[i] += by[i] * strength;
                }
            }
            for (by, strength) in rows.powers.iter().zip(others[c]) {
                for i in 0..N {
                    sum[i] += by[i] * strength;
                }
            }
            slips[c] = sum;
        }
    }
}

vectorised! {
    /// Moments of a shear, given those of the shear of every point.
    fn moments<'a, S, const N: usize, const D: usize>(
        _simd,
        by_shear: &'a [[f64; N]],
        shear: &'a ByDirection<N, D>,
    ) -> Polynomials<D> {
        let mut moments = [ByPowers::default(); D];
        for (moments, shear) in moments.iter_mut().zip(shear) {
            let (shear, shear_rest) = shear.as_chunks::<4>();
            for (moment, by) in moments.iter_mut().zip(by_shear) {
                let ((by, by_rest), mut sums) = (by.as_chunks::<4>(), [0.0; 4]);
                for (by, shear) in by.iter().zip(shear) {
                    for l in 0..4 {
                        sums[l] += by[l] * shear[l];
                    }
                }
                *moment = (sums[0] + sums[1]) + (sums[2] + sums[3]);
                for (by, shear) in by_rest.iter().zip(shear_rest) {
                    *moment += by * shear;
                }
            }
        }
        moments
    }
}

vectorised! {
    /// Moves values to others by a share of what lies between.
    fn mix<'a, S>(_simd, values: &'a mut [f64], others: &'a [f64], share: f64) {
        for (value, other) in values.iter_mut().zip(others) {
            *value += share * (other - *value);
        }
    }
}

impl<const N: usize, const D: usize> SlipRows<N, D> {
    /// Mean with others, which have a `share`.
    pub fn mean(mut self, other: &Self, share: f64) -> Self {
        for (by, other) in self.by_shear.iter_mut().zip(&other.by_shear) {
            mix(by.as_flattened_mut(), other.as_flattened(), share);
        }
        mix(self.known.as_flattened_mut(), other.known.as_flattened(), share);
        mix(self.powers.as_flattened_mut(), other.powers.as_flattened(), share);
        self
    }

    /// Slips by a shear alone [m/s].
    pub fn slips_of(&self, shear: &ByDirection<N, D>) -> ByDirection<N, D> {
        let mut slips = [[0.0; N]; D];
        add_slips(self, shear, [&[]; D], &mut slips);
        slips
    }

    /// Slips by a shear and by all else as polynomials [m/s].
    pub fn slips(&self, shear: &ByDirection<N, D>, others: &Polynomials<D>) -> ByDirection<N, D> {
        let mut slips = self.known;
        add_slips(self, shear, others.each_ref().map(|others| &others[..]), &mut slips);
        slips
    }
}

impl<const N: usize, const D: usize> ConeProblem<N, D> {
    /// The problem with the slips that friction sees, and those in the place of the shear if they are others, forces by the
    /// `weights` \[m] of points that bear the given friction, and this at the peak of the pressure \[Pa]. Points that bear
    /// none have no shear.
    pub fn new(
        rows: SlipRows<N, D>,
        in_place: Option<SlipRows<N, D>>,
        weights: &[f64; N],
        bears: [f64; N],
        most: f64,
    ) -> Self {
        let least = |i: usize| rows.by_shear.iter().map(|by| by[i][i].abs()).fold(f64::MIN_POSITIVE, f64::max);
        let least = std::array::from_fn(least);
        let powers = in_place.as_ref().map_or(&rows.powers, |rows| &rows.powers);
        let moments = powers.iter().map(|power| std::array::from_fn(|i| weights[i] * power[i])).collect();
        Self { rows, in_place, least, moments, bears, most }
    }

    /// Moments [N/m] of a shear with the powers.
    pub fn moments(&self, shear: &ByDirection<N, D>) -> Polynomials<D> {
        moments(&self.moments, shear)
    }

    /// Shears within the disc that come next to the given ones, which belong to a friction `ratio` times smaller.
    pub fn within(&self, shear: &ByDirection<N, D>, ratio: f64) -> ByDirection<N, D> {
        let mut within = shear.map(|shear| shear.map(|q| ratio * q));
        for (i, bears) in self.bears.iter().enumerate() {
            let size = length(&at(&within, i));
            if size > *bears {
                within.iter_mut().for_each(|shear| shear[i] *= bears / size);
            }
        }
        within
    }

    /// Correction of the slip by the difference between that in the place of the shear and that upstream, where a solution
    /// slips [m/s].
    pub fn correction(&self, shear: &ByDirection<N, D>, others: &Polynomials<D>) -> ByDirection<N, D> {
        let Some(in_place) = &self.in_place else { return [[0.0; N]; D] };
        let [upstream, in_place] = [&self.rows, in_place].map(|rows| rows.slips(shear, others));
        let weight = |i: usize| {
            let ahead = length(&at(&upstream, i)) / self.least[i];
            let sum = ahead + BEGINNING * self.bears[i];
            if sum > 0.0 { ahead / sum } else { 0.0 }
        };
        let weights: [f64; N] = std::array::from_fn(weight);
        std::array::from_fn(|c| std::array::from_fn(|i| weights[i] * (in_place[c][i] - upstream[c][i])))
    }

    /// Adds given slips to the known ones.
    pub fn add(&mut self, slips: &ByDirection<N, D>) {
        let known = self.rows.known.as_flattened_mut();
        known.iter_mut().zip(slips.as_flattened()).for_each(|(known, slip)| *known += slip);
    }

    /// Force [N/m] by which the points resist a unit of slip, each for itself [kg/(m s)].
    pub fn resistance(&self) -> f64 {
        self.moments[0].iter().zip(&self.least).map(|(weight, least)| weight / least).sum()
    }

    /// Draws the shear to the given one, `strength` times as much as the slip of a point resists its own shear.
    pub fn draw(&mut self, strength: f64, shear: &ByDirection<N, D>) {
        let SlipRows { by_shear, known, .. } = &mut self.rows;
        for ((by_shear, known), shear) in by_shear.iter_mut().zip(known).zip(shear) {
            for (i, (least, shear)) in self.least.iter().zip(shear).enumerate() {
                by_shear[i][i] += strength * least;
                known[i] -= strength * least * shear;
            }
        }
        self.least.iter_mut().for_each(|least| *least *= 1.0 + strength);
    }

    /// States that friction asks for under a shear and the slip by all else as polynomials.
    pub fn verdict(&self, shear: &ByDirection<N, D>, others: &Polynomials<D>) -> ConeVerdict<N, D> {
        let slips = self.rows.slips(shear, others);
        let (mut points, mut largest) = ([PointState::Stick { slip: [0.0; D] }; N], 0.0_f64);
        for (i, point) in points.iter_mut().enumerate() {
            let (state, violation) = self.judge(i, at(shear, i), at(&slips, i));
            let violation = violation / self.most.max(f64::MIN_POSITIVE);
            (*point, largest) = (state, largest.max(violation));
        }
        ConeVerdict { points, largest }
    }

    /// State that friction asks of a point with the shear q and the slip s, and its violation \[Pa].
    fn judge(&self, i: usize, q: [f64; D], s: [f64; D]) -> (PointState<D>, f64) {
        let (bears, least) = (self.bears[i], self.least[i]);
        let held: [f64; D] = std::array::from_fn(|c| q[c] - s[c] / least);
        let size = length(&held);
        if size <= bears && bears > 0.0 {
            return (PointState::Stick { slip: s }, length(&s) / least);
        }
        // Nothing is held at a point that bears nothing, and asks for nothing.
        let (size, share) = if size > 0.0 { (size, bears / size) } else { (1.0, 0.0) };
        let direction = held.map(|z| z / size);
        let turn = if share > 0.0 { (1.0 - share) / share * least } else { f64::INFINITY };
        let excess = std::array::from_fn(|c| q[c] - bears * direction[c]);
        (PointState::Slip { direction, turn, excess }, length(&excess))
    }
}

impl<const N: usize, const D: usize> ConeVerdict<N, D> {
    /// States of the points: 0 where they stick; where they slip, the sign of their shear in one direction and 1 in two.
    pub fn states(&self) -> [i8; N] {
        self.points.map(|point| match point {
            PointState::Stick { .. } => 0,
            PointState::Slip { direction, .. } if D == 1 && direction[0] < 0.0 => -1,
            PointState::Slip { .. } => 1,
        })
    }
}

/// The vector of a point.
fn at<const N: usize, const D: usize>(values: &ByDirection<N, D>, i: usize) -> [f64; D] {
    std::array::from_fn(|c| values[c][i])
}

/// Length of a vector of shear or slip, whose squares are in range.
fn length<const D: usize>(vector: &[f64; D]) -> f64 {
    vector.iter().map(|part| part * part).sum::<f64>().sqrt()
}
