//! Linear problem of all lines together: shear of the stretches that stick, and the motions that are not prescribed.
//!
//! Forces of all lines, bodies and motions change the slip of a line by a polynomial. So each stretch is solved for every
//! power of one, and these polynomials follow from as many equations ([`super::field`], [`super::surface`]).

use super::contact::{MOST_LINES, SeriesContact};
use super::series_line::SeriesLine;
use super::stretch::{BySolution, Stretch};
use crate::axes::Axis;
use crate::contact::cone::Polynomials;
use crate::contact::error::ContactError;
use crate::contact::flexibility::{ByMoments, ByPowers};
use crate::linalg::vectorised::vectorised;
use crate::linalg::{DenseSystem, POINTS};

impl SeriesContact<'_> {
    /// Solves for the shear of stretches of the half-lengths `halves` \[m] that stick from the leading edges on
    /// (`None`: nothing sticks on this line), and for the motions that are not prescribed. Writes the strengths of the
    /// roots at the ends where slip begins to `roots` \[Pa]. Shear and displacements have their places still to come.
    pub fn stick(&mut self, halves: &[Option<f64>], roots: &mut [f64]) -> Result<(), ContactError> {
        self.lines.iter_mut().zip(halves).for_each(|(line, half)| line.begin_stretch(*half));
        self.exchange();
        let surface = self.surface();
        let mut stretches: Vec<Option<Stretch>> = Vec::with_capacity(self.lines.len());
        for (line, half) in self.lines.iter().zip(halves) {
            stretches.push(half.map(|_| line.stretch(&surface)).transpose()?);
        }
        let slips = self.share(&stretches)?;
        for (((line, stretch), slip), root) in self.lines.iter_mut().zip(&stretches).zip(&slips).zip(roots) {
            *root = stretch.as_ref().map_or(0.0, |stretch| line.take(&stretch.tractions(slip)));
        }
        Ok(())
    }

    /// Finds the motions that are not prescribed where nothing sticks.
    pub fn glide(&mut self) -> Result<(), ContactError> {
        for line in &mut self.lines {
            line.begin_stretch(None);
            line.place_shear();
        }
        self.displace();
        if self.free_axes().next().is_none() {
            return Ok(());
        }
        self.share(&[])?;
        self.displace();
        Ok(())
    }
}

impl SeriesContact<'_> {
    /// Finds the motions that are not prescribed, and the slips of all lines that stick by all that the known slip does
    /// not contain, as polynomials.
    pub fn share(&mut self, stretches: &[Option<Stretch>]) -> Result<[ByPowers; MOST_LINES], ContactError> {
        let (count, axes) = (POINTS * sticking(stretches).count(), self.free_axes());
        let mut system = std::mem::take(&mut self.system);
        system.reset(count + axes.clone().count());
        self.write_motions(stretches, &mut system);
        let by_bodies = self.slips_by_bodies();
        for (column, (by, stretch)) in sticking(stretches).enumerate() {
            let (moments, forces) = (stretch.moments(), stretch.forces());
            for (row, (at, _)) in sticking(stretches).enumerate() {
                let slips = slips_of(&self.slips_through(&by_bodies, [at, by]), &moments);
                // The known tractions stand on the right, the others take away from them.
                for (p, [known, slips @ ..]) in slips.iter().enumerate() {
                    let (coefficients, side) = system.row(POINTS * row + p);
                    *side += known;
                    let coefficients = coefficients[POINTS * column..][..POINTS].iter_mut();
                    coefficients.zip(slips).for_each(|(value, slip)| *value += slip);
                }
            }
            for (row, axis) in axes.clone().enumerate() {
                let Pull { force, moments: by_moments } = self.pull_along(axis, by);
                let mut pulls = forces.map(|along| force * along);
                for (by, moments) in by_moments.iter().zip(&moments) {
                    pulls.iter_mut().zip(moments).for_each(|(pull, moment)| *pull -= by * moment);
                }
                let ([known, pulls @ ..], (coefficients, side)) = (pulls, system.row(count + row));
                *side += known;
                let coefficients = coefficients[POINTS * column..][..POINTS].iter_mut();
                coefficients.zip(pulls).for_each(|(value, pull)| *value += pull);
            }
        }
        let mut slips = [ByPowers::default(); MOST_LINES];
        let solved = system.solve().map(|solution| {
            let (polynomials, changes) = solution.split_at(count);
            let lines = sticking(stretches).zip(polynomials.as_chunks::<POINTS>().0);
            lines.for_each(|((line, _), slip)| slips[line] = *slip);
            axes.zip(changes).for_each(|(axis, change)| self.speed_up(axis, *change));
        });
        self.system = system;
        solved.map(|()| slips).ok_or(ContactError::Unsuited { reason: "the lines have no common solution" })
    }

    /// Writes the effect of the motions on the slips of lines that stick, and the balances of the motions but for the
    /// stretches that stick.
    fn write_motions(&self, stretches: &[Option<Stretch>], system: &mut DenseSystem) {
        let count = POINTS * sticking(stretches).count();
        for (row, (line, _)) in sticking(stretches).enumerate() {
            for p in 0..POINTS {
                system.row(POINTS * row + p).0[POINTS * row + p] = 1.0;
            }
            for (column, axis) in self.free_axes().enumerate() {
                let slip = self.lines[line].slip_by_motion(axis);
                slip.iter().enumerate().for_each(|(p, slip)| system.row(POINTS * row + p).0[count + column] = -slip);
            }
        }
        // Of friction alone: the stretches have no shear yet.
        let resultant = self.resultant();
        for (row, axis) in self.free_axes().enumerate() {
            let (coefficients, side) = system.row(count + row);
            *side = -self.unbalance(axis, resultant[axis]);
            for (column, other) in self.free_axes().enumerate() {
                coefficients[count + column] = self.inertia(axis, other) * self.rigid[other].gain;
            }
        }
    }

    /// Parts of unit moments of the shear of a line, along and across, in the balance of a motion \[1, m].
    pub fn pulls<const D: usize>(&self, axis: Axis, line: usize) -> Polynomials<D> {
        let Pull { force, moments } = self.pull_along(axis, line);
        let mut pulls = [ByPowers::default(); D];
        pulls[0] = moments.map(|by| -by);
        pulls[0][0] += force;
        if let Some(across) = pulls.get_mut(1) {
            across[0] = if axis == Axis::Lateral { self.lines[line].problem.line.share } else { 0.0 };
        }
        pulls
    }

    /// Part of a shear along of a line in the balance of a motion.
    fn pull_along(&self, axis: Axis, line: usize) -> Pull {
        let (line, momentum) = (&self.lines[line], &self.bodies().momentum);
        let (share, sliding) = (line.problem.line.share, self.lines[0].problem.line.sliding(axis));
        if axis == Axis::Lateral {
            return Pull::default();
        }
        let at_points = std::array::from_fn(|l| share * momentum[(axis.number(), 2 * l)]);
        let moments = line.constants.points.polynomial(&at_points).by_powers(line.half_length);
        Pull { force: sliding * share, moments }
    }

    /// Slips of a line by what unit moments of shear with the powers of `x/reach`, per metre of the bodies' width, do to the
    /// bodies, as polynomials of `x/reach` [m/s/(N/m)].
    pub fn slips_by_bodies(&self) -> ByMoments {
        let (line, [wheel, rail]) = (&self.lines[0], &self.by_powers);
        let (v, rim, a0, reach) =
            (line.rigid.travel, line.rim_velocity(), line.problem.line.time.a0, line.constants.points.reach);
        std::array::from_fn(|n| {
            let slope = |of: &ByPowers, p: usize| (p + 1) as f64 / reach * of.get(p + 1).copied().unwrap_or(0.0);
            std::array::from_fn(|p| {
                a0 * (wheel[n][p] - rail[n][p]) + v * slope(&rail[n], p) - rim * slope(&wheel[n], p)
            })
        })
    }

    /// Slips of a line by unit moments of the shear of another one, given [`Self::slips_by_bodies`].
    pub fn slips_through(&self, by_bodies: &ByMoments, [at, by]: [usize; 2]) -> ByMoments {
        let (line, other) = (&self.lines[at], &self.lines[by]);
        let reach = line.constants.points.reach;
        let powers = |ratio: f64, first: f64| {
            let mut power = first;
            ByPowers::default().map(|_| {
                let next = power * ratio;
                std::mem::replace(&mut power, next)
            })
        };
        let here = powers(line.half_length / reach, 1.0);
        let there = powers(other.half_length / reach, other.problem.line.share);
        let mut slips = *by_bodies;
        for (slip, there) in slips.iter_mut().zip(&there) {
            slip.iter_mut().zip(&here).for_each(|(slip, here)| *slip *= there * here);
        }
        let Some(patch) = line.problem.line.patch else { return slips };
        let by_field = patch.flexibility.between(patch.line, by).slips(line.slip_of_field());
        for (slip, by_field) in slips.as_flattened_mut().iter_mut().zip(by_field.as_flattened()) {
            *slip += by_field;
        }
        slips
    }
}

/// Part of the shear of a line along in the balance of a motion: by its force \[1, m], less those by its moments with the
/// powers of the place over the half-length of the line \[1, m].
#[derive(Default)]
struct Pull {
    force: f64,
    moments: ByPowers,
}

vectorised! {
    /// Slips by power that belong to moments of several solutions.
    fn slips_of<'a, S>(_simd, by_moments: &'a ByMoments, moments: &'a [BySolution; POINTS]) -> [BySolution; POINTS] {
        let mut slips = [BySolution::default(); POINTS];
        for (p, slips) in slips.iter_mut().enumerate() {
            for n in 0..POINTS {
                for j in 0..slips.len() {
                    slips[j] += by_moments[n][p] * moments[n][j];
                }
            }
        }
        slips
    }
}

/// Lines of which a stretch sticks, by number.
fn sticking(stretches: &[Option<Stretch>]) -> impl Iterator<Item = (usize, &Stretch)> {
    stretches.iter().enumerate().filter_map(|(line, stretch)| Some((line, stretch.as_ref()?)))
}

impl SeriesLine<'_> {
    /// Change of the slip per unit of V or Ω as a polynomial, the small effect of the strains left out.
    pub fn slip_by_motion(&self, axis: Axis) -> ByPowers {
        let (bodies, rim) = (&self.problem.line.bodies, self.rim_velocity());
        let answer =
            self.constants.points.polynomial(&std::array::from_fn(|k| bodies.inertial[(2 * k, axis.number())]));
        let (a0, gain) = (self.problem.line.time.a0, self.problem.rigid[axis].gain);
        let [values, slopes] = [answer, answer.derivative()].map(|of| of.by_powers(self.half_length));
        let mut slip: ByPowers = std::array::from_fn(|k| gain * (a0 * values[k] - rim * slopes[k]));
        slip[0] += self.problem.line.sliding(axis);
        slip
    }
}
