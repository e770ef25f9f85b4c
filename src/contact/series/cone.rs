//! Shear of one line along and across, at the points of [`super::points`]: its vector stays within a disc.
//!
//! Of the shear q, the slip s and the radius g of the disc, `q = P(q − r s)` says Coulomb's law for any `r > 0`, with the
//! projection P on the disc. Slips stand half a point upstream of their shear. In two directions a shear that slips would
//! point against the slip there, and not where it stands: so its slip is corrected once by the difference of both in the
//! solution without. A step of Newton's method makes the law linear: what sticks has no slip, and what slips turns along
//! the circle.
//! Theory: `docs/theory/patch-contact.md`, section 3.

use super::across::Vectors;
use super::chebyshev::Arch;
use super::contact::SeriesContact;
use super::points::{COUNT, PointTables};
use super::series_line::SeriesLine;
use super::surface::SmoothSurfaces;
use crate::contact::flexibility::{ByMoments, ByPowers};
use crate::contact::kernel::Logarithm;
use crate::linalg::POINTS;
use crate::linalg::vectorised::vectorised;
use std::f64::consts::PI;

/// Coefficients of the polynomials of slip along and across.
pub const SLIPS: usize = 2 * POINTS;
/// Unknowns at most.
const UNKNOWNS: usize = 2 * COUNT;
/// Slip times r over the radius of the disc at which half of the correction counts \[1].
const BEGINNING: f64 = 0.05;
/// Way of a step over the half-width of the patch from which on slips stand half a point upstream \[1].
const WHOLE_WAY: f64 = 0.03;

/// Slips at places that belong to the points.
#[derive(Clone)]
pub struct SlipRows {
    /// Slips along and across by the shear of every point in this direction [m/s/Pa].
    pub by_shear: [[[f64; COUNT]; COUNT]; 2],
    /// Slips without any shear [m/s].
    known: Vectors,
    /// Powers of the place over the half-length of the line.
    pub powers: [[f64; COUNT]; POINTS],
}

/// The tangential problem of one line.
#[derive(Clone)]
pub struct ConeProblem {
    /// Upstream of the shear, and in its place.
    pub rows: [SlipRows; 2],
    /// Change of the slip of every point by its shear [m/s/Pa], the larger one of both directions.
    pub least: [f64; COUNT],
    /// Moments of the shear of every point with the powers of the places \[m].
    moments: [[f64; COUNT]; POINTS],
    /// Friction that points bear, and that at the peak of the pressure \[Pa].
    bears: [f64; COUNT],
    most: f64,
}

/// State that friction asks of a point, and what is missing.
#[derive(Clone, Copy)]
pub enum PointState {
    /// Stick, with the slip that is left [m/s].
    Stick { slip: [f64; 2] },
    /// Slip against `direction`; `turn`: how much of a turn of the shear is left over, over r [m/s/Pa]; `excess`: shear
    /// beyond that of friction \[Pa].
    Slip { direction: [f64; 2], turn: f64, excess: [f64; 2] },
}

/// States that friction asks of all points of a line.
pub struct ConeVerdict {
    pub points: [PointState; COUNT],
    /// Largest violation of friction over its peak \[1].
    pub largest: f64,
}

vectorised! {
    /// Adds slips of all points by given strengths of something.
    fn add_slips<'a, S>(_simd, by: &'a [[f64; COUNT]], strengths: &'a [f64], slips: &'a mut [f64; COUNT]) {
        for (by, strength) in by.iter().zip(strengths) {
            slips.iter_mut().zip(by).for_each(|(slip, by)| *slip += by * strength);
        }
    }
}

impl SlipRows {
    /// Mean with others, which have a `share`.
    fn mean(mut self, other: &Self, share: f64) -> Self {
        fn mix(values: &mut [f64], others: &[f64], share: f64) {
            values.iter_mut().zip(others).for_each(|(value, other)| *value += share * (other - *value));
        }
        for (by, other) in self.by_shear.iter_mut().zip(&other.by_shear) {
            mix(by.as_flattened_mut(), other.as_flattened(), share);
        }
        mix(self.known.as_flattened_mut(), other.known.as_flattened(), share);
        mix(self.powers.as_flattened_mut(), other.powers.as_flattened(), share);
        self
    }

    /// Slips by a shear alone [m/s].
    pub fn slips_of(&self, shear: &Vectors) -> Vectors {
        self.beside(Vectors::default(), shear)
    }

    /// Slips by a shear beside given ones.
    fn beside(&self, mut slips: Vectors, shear: &Vectors) -> Vectors {
        for ((slips, by_shear), shear) in slips.iter_mut().zip(&self.by_shear).zip(shear) {
            add_slips(by_shear, shear, slips);
        }
        slips
    }

    fn slips(&self, shear: &Vectors, others: &[f64; SLIPS]) -> Vectors {
        let mut slips = self.beside(self.known, shear);
        for (slips, others) in slips.iter_mut().zip(others.as_chunks::<POINTS>().0) {
            add_slips(&self.powers, others, slips);
        }
        slips
    }
}

impl SeriesLine<'_> {
    /// The problem of the line, whose tractions have no shear at the moment, with the smooth displacements `surface`.
    pub fn cone_problem(&self, surface: &SmoothSurfaces) -> ConeProblem {
        let (constants, upstream) = (self.constants, self.upstream());
        let Arch { centre, half_width: half, terms, .. } = self.tractions.pressure;
        let at = |t: &f64| centre + upstream * half * t;
        let places = [&constants.of_points, &constants.in_place].map(|tables| tables.slips.each_ref().map(at));
        let both: [f64; UNKNOWNS] = std::array::from_fn(|i| places[i / COUNT][i % COUNT]);
        let known = [self.slip(&both, surface, false), self.lateral_slip(&both, false)];
        let rows = |set: usize, tables: &PointTables| SlipRows {
            by_shear: [self.problem.line.kernel.tangential, self.problem.line.kernel.lateral]
                .map(|kernel| self.slips_by_points(tables, kernel)),
            known: known.map(|known| std::array::from_fn(|i| known[set * COUNT + i])),
            powers: self.powers_at(&places[set]),
        };
        let in_place = rows(1, &constants.in_place);
        let rows = [rows(0, &constants.of_points).mean(&in_place, 1.0 - self.way_upstream()), in_place];
        let least = |i: usize| rows[0].by_shear.iter().map(|by| by[i][i].abs()).fold(f64::MIN_POSITIVE, f64::max);
        let least = std::array::from_fn(least);
        // The rule of Gauss and Chebyshev has its places at the points.
        let part = PI / (COUNT + 1) as f64;
        let weights: [f64; COUNT] = std::array::from_fn(|i| half * part * libm::sin((i + 1) as f64 * part));
        let moments = rows[1].powers.map(|power| std::array::from_fn(|i| weights[i] * power[i]));
        let bears = self.tractions.pressure.density(&places[1]).map(|p| self.friction * p.max(0.0));
        ConeProblem { rows, least, moments, bears, most: self.friction * terms[0] }
    }

    /// Share of the way to half a point upstream that the slips stand from their shear: in steps much shorter than the
    /// patch the slip is that of a body at rest.
    fn way_upstream(&self) -> f64 {
        let (rate, half) = (self.problem.line.time.a0.abs(), self.tractions.pressure.half_width);
        let speed = 0.5 * (self.rigid.travel + self.rim_velocity()).abs();
        let whole = WHOLE_WAY * rate * half;
        if speed < whole { speed / whole } else { 1.0 }
    }

    /// Slips by the shear of points with the flexibility `kernel` \[m/s/Pa].
    pub fn slips_by_points(&self, tables: &PointTables, kernel: Logarithm) -> [[f64; COUNT]; COUNT] {
        let half = self.tractions.pressure.half_width;
        let speed = self.rigid.travel + self.rim_velocity();
        let convection = speed * kernel.factor * PI * self.upstream();
        let rate = -2.0 * kernel.factor * self.problem.line.time.a0 * half;
        let mut slips = tables.slips_by_shear([convection, rate], [half, kernel.reach]);
        let [by_slope, by_shear] = self.slip_of_layer();
        tables.add_layer([by_slope * self.upstream() / half, by_shear], &mut slips);
        slips
    }
}

impl ConeProblem {
    /// Moments [N/m] of a shear with the powers along, then across.
    pub fn moments(&self, shear: &Vectors) -> [f64; SLIPS] {
        std::array::from_fn(|k| self.moments[k % POINTS].iter().zip(&shear[k / POINTS]).map(|(by, q)| by * q).sum())
    }

    /// Shears within the disc that come next to the given ones, which belong to a friction `ratio` times smaller.
    pub fn within(&self, shear: &Vectors, ratio: f64) -> Vectors {
        let mut within = shear.map(|shear| shear.map(|q| ratio * q));
        for (i, bears) in self.bears.iter().enumerate() {
            let size = length([within[0][i], within[1][i]]);
            if size > *bears {
                within.iter_mut().for_each(|shear| shear[i] *= bears / size);
            }
        }
        within
    }

    /// Correction of the slip by the difference between that in the place of the shear and that upstream, where a solution
    /// slips [m/s].
    pub fn correction(&self, shear: &Vectors, others: &[f64; SLIPS]) -> Vectors {
        let [upstream, in_place] = self.rows.each_ref().map(|rows| rows.slips(shear, others));
        let weight = |i: usize| {
            let ahead = length([upstream[0][i], upstream[1][i]]) / self.least[i];
            let sum = ahead + BEGINNING * self.bears[i];
            if sum > 0.0 { ahead / sum } else { 0.0 }
        };
        let weights: [f64; COUNT] = std::array::from_fn(weight);
        std::array::from_fn(|c| std::array::from_fn(|i| weights[i] * (in_place[c][i] - upstream[c][i])))
    }

    /// Adds given slips to the known ones.
    pub fn add(&mut self, slips: &Vectors) {
        let known = self.rows[0].known.as_flattened_mut();
        known.iter_mut().zip(slips.as_flattened()).for_each(|(known, slip)| *known += slip);
    }

    /// Force [N/m] by which the points resist a unit of slip, each for itself [kg/(m s)].
    pub fn resistance(&self) -> f64 {
        self.moments[0].iter().zip(&self.least).map(|(weight, least)| weight / least).sum()
    }

    /// Draws the shear to the given one, `strength` times as much as the slip of a point resists its own shear.
    pub fn draw(&mut self, strength: f64, shear: &Vectors) {
        let SlipRows { by_shear, known, .. } = &mut self.rows[0];
        for ((by_shear, known), shear) in by_shear.iter_mut().zip(known).zip(shear) {
            for (i, (least, shear)) in self.least.iter().zip(shear).enumerate() {
                by_shear[i][i] += strength * least;
                known[i] -= strength * least * shear;
            }
        }
        self.least.iter_mut().for_each(|least| *least *= 1.0 + strength);
    }

    /// States that friction asks for under a shear and the slip by all else as polynomials.
    pub fn verdict(&self, shear: &Vectors, others: &[f64; SLIPS]) -> ConeVerdict {
        let slips = self.rows[0].slips(shear, others);
        let (mut points, mut largest) = ([PointState::Stick { slip: [0.0; 2] }; COUNT], 0.0_f64);
        for (i, point) in points.iter_mut().enumerate() {
            let (state, violation) = self.judge(i, [shear[0][i], shear[1][i]], [slips[0][i], slips[1][i]]);
            let violation = violation / self.most.max(f64::MIN_POSITIVE);
            (*point, largest) = (state, largest.max(violation));
        }
        ConeVerdict { points, largest }
    }

    /// State that friction asks of a point with the shear q and the slip s, and its violation \[Pa].
    fn judge(&self, i: usize, q: [f64; 2], s: [f64; 2]) -> (PointState, f64) {
        let (bears, least) = (self.bears[i], self.least[i]);
        let held = [0, 1].map(|c| q[c] - s[c] / least);
        let size = length(held);
        if size <= bears {
            return (PointState::Stick { slip: s }, length(s) / least);
        }
        let (direction, share) = (held.map(|z| z / size), bears / size);
        let turn = if share > 0.0 { (1.0 - share) / share * least } else { f64::INFINITY };
        let excess = [0, 1].map(|c| q[c] - bears * direction[c]);
        (PointState::Slip { direction, turn, excess }, length(excess))
    }
}

impl ConeVerdict {
    /// States of the points: 0 where they stick, 1 where they slip.
    pub fn states(&self) -> [i8; COUNT] {
        self.points.map(|point| match point {
            PointState::Stick { .. } => 0,
            PointState::Slip { .. } => 1,
        })
    }
}

/// Length of a vector of shear or slip, whose squares are in range.
fn length([along, across]: [f64; 2]) -> f64 {
    (along * along + across * across).sqrt()
}

/// Coefficients along and across as one list.
fn joined([along, across]: [ByPowers; 2]) -> [f64; SLIPS] {
    std::array::from_fn(|k| if k < POINTS { along[k] } else { across[k - POINTS] })
}

impl SeriesContact<'_> {
    /// Slips of a line along and across by unit moments of the shear of another one.
    pub fn slips_askew(&self, [at, by]: [usize; 2]) -> [[f64; SLIPS]; SLIPS] {
        let (along, line) = (self.slips_between([at, by]), &self.lines[at]);
        let [rate, strain] = line.slip_of_field();
        let patch = line.problem.line.patch;
        let [across, askew]: [ByMoments; 2] =
            patch.and_then(|patch| patch.flexibility.across(patch.line, by)).map_or_else(Default::default, |tables| {
                tables.map(|between| {
                    std::array::from_fn(|n| {
                        std::array::from_fn(|p| rate * between.displacement[n][p] + strain * between.strain[n][p])
                    })
                })
            });
        std::array::from_fn(|n| match n < POINTS {
            true => joined([along[n], askew[n]]),
            false => joined([askew[n - POINTS], across[n - POINTS]]),
        })
    }
}
