//! Shear of lines at the points of [`super::points`] in D directions, along or along and across, as [`crate::contact::cone`]
//! finds it: slips of every line by its points, by other lines and by motions, and what the balances of these miss.

use super::chebyshev::Arch;
use super::contact::SeriesContact;
use super::points::{COUNT, PointTables};
use super::series_line::SeriesLine;
use super::surface::SmoothSurfaces;
use crate::axes::{Axis, PerAxis};
use crate::contact::cone::{ByPolynomials, ConeProblem, FreeMotion, Polynomials, SlipRows, TangentialCoupling};
use crate::contact::flexibility::{ByMoments, ByPowers};
use crate::contact::kernel::Logarithm;
use crate::linalg::POINTS;
use std::f64::consts::PI;

/// Unknowns at most.
const UNKNOWNS: usize = 2 * COUNT;
/// Way of a step over the half-width of the patch from which on slips stand half a point upstream \[1].
const WHOLE_WAY: f64 = 0.03;

impl SeriesLine<'_> {
    /// The problem of the line, whose tractions have no shear at the moment, with the smooth displacements `surface`.
    pub fn cone_problem<const D: usize>(&self, surface: &SmoothSurfaces) -> ConeProblem<COUNT, D> {
        let (constants, leading) = (self.constants, self.upstream());
        let Arch { centre, half_width: half, terms, .. } = self.tractions.pressure;
        let at = |t: &f64| centre + leading * half * t;
        let places = [&constants.of_points, &constants.in_place].map(|tables| tables.slips.each_ref().map(at));
        let both: [f64; UNKNOWNS] = std::array::from_fn(|i| places[i / COUNT][i % COUNT]);
        let known: [_; D] = std::array::from_fn(|direction| match direction {
            0 => self.slip(&both, surface, false),
            _ => self.lateral_slip(&both, false),
        });
        let kernels = [self.problem.line.kernel.tangential, self.problem.line.kernel.lateral];
        let rows = |set: usize, tables: &PointTables| SlipRows {
            by_shear: std::array::from_fn(|direction| self.slips_by_points(tables, kernels[direction]).to_vec()),
            known: known.each_ref().map(|known| std::array::from_fn(|i| known[set * COUNT + i])),
            powers: self.powers_at(&places[set]).to_vec(),
        };
        let (mut upstream, in_place) = (rows(0, &constants.of_points), (D > 1).then(|| rows(1, &constants.in_place)));
        if let Some(in_place) = &in_place {
            upstream = upstream.mean(in_place, 1.0 - self.way_upstream());
        }
        // The rule of Gauss and Chebyshev has its places at the points.
        let part = PI / (COUNT + 1) as f64;
        let weights: [f64; COUNT] = std::array::from_fn(|i| half * part * libm::sin((i + 1) as f64 * part));
        let bears = self.tractions.pressure.density(&places[1]).map(|p| self.friction * p.max(0.0));
        ConeProblem::new(upstream, in_place, &weights, bears, self.friction * terms[0])
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

impl SeriesContact<'_> {
    /// Slips of a line by unit moments of the shear of another one, given [`Self::slips_by_bodies`].
    fn slips_between<const D: usize>(&self, by_bodies: &ByMoments, [at, by]: [usize; 2]) -> ByPolynomials<D> {
        let (along, line) = (self.slips_through(by_bodies, [at, by]), &self.lines[at]);
        let mut slips = [[[ByPowers::default(); D]; POINTS]; D];
        slips[0].iter_mut().zip(&along).for_each(|(slips, along)| slips[0] = *along);
        let patch = line.problem.line.patch.filter(|_| D > 1);
        let Some(tables) = patch.and_then(|patch| patch.flexibility.across(patch.line, by)) else { return slips };
        let [across, askew] = tables.each_ref().map(|between| between.slips(line.slip_of_field()));
        for (slips, askew) in slips[0].iter_mut().zip(&askew) {
            slips[D - 1] = *askew;
        }
        for (slips, (askew, across)) in slips[D - 1].iter_mut().zip(askew.iter().zip(&across)) {
            (slips[0], slips[D - 1]) = (*askew, *across);
        }
        slips
    }

    /// Coupling of all lines and free motions under the present pressures.
    pub fn coupling<const D: usize>(&self) -> TangentialCoupling<D> {
        let (count, resultant) = (self.lines.len(), self.resultant());
        let (first, by_bodies) = (&self.lines[0], self.slips_by_bodies());
        TangentialCoupling {
            between: (0..count * count).map(|k| self.slips_between(&by_bodies, [k / count, k % count])).collect(),
            motions: self.free_axes().map(|axis| self.free_motion(axis, resultant[axis])).collect(),
            base: first.rigid,
            radius: first.problem.line.radius(),
            shares: self.lines.iter().map(|line| line.problem.line.share).collect(),
            friction: self.sum(|line| line.friction * line.load()).max(f64::MIN_POSITIVE),
        }
    }

    /// A motion under a contact `force` without shear [N/m, N].
    fn free_motion<const D: usize>(&self, axis: Axis, force: f64) -> FreeMotion<D> {
        FreeMotion {
            axis,
            slips: self.lines.iter().map(|line| line.slips_by_motion(axis)).collect(),
            pulls: (0..self.lines.len()).map(|line| self.pulls(axis, line)).collect(),
            resistance: PerAxis::from_fn(|other| self.inertia(axis, other) * self.rigid[other].gain),
            missing: -self.unbalance(axis, force),
            drawn: [0.0; 2],
        }
    }
}

impl SeriesLine<'_> {
    /// Slip by a unit of a motion.
    fn slips_by_motion<const D: usize>(&self, axis: Axis) -> Polynomials<D> {
        let spin = self.problem.spin.by(axis);
        let mut slips = [ByPowers::default(); D];
        slips[0] = self.slip_by_motion(axis);
        slips[0][0] -= spin * self.problem.line.position;
        if let Some(across) = slips.get_mut(1) {
            across[0] = if axis == Axis::Lateral { 1.0 } else { 0.0 };
            across[1] = spin * self.half_length;
        }
        slips
    }
}
