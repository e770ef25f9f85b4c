//! The law of [`super::law`] made linear, on one line and for all lines and motions together.

use super::law::{ByDirection, ConeProblem, ConeVerdict, PointState, Polynomials};
use crate::axes::{Axis, PerAxis};
use crate::contact::flexibility::ByPowers;
use crate::linalg::vectorised::vectorised;
use crate::linalg::{DenseSystem, POINTS};

/// One unknown of the linear law with its equation: part of the shear of a point in a direction.
#[derive(Clone, Copy)]
struct Unknown<const D: usize> {
    point: usize,
    along: [f64; D],
    turn: f64,
}

/// Polynomials of slip by units of the coefficients or moments of others, by direction and power.
pub type ByPolynomials<const D: usize> = [[Polynomials<D>; POINTS]; D];

/// The linear law of one line.
#[derive(Clone)]
struct LinearLine<const N: usize, const D: usize> {
    points: [PointState<D>; N],
    unknowns: Vec<Unknown<D>>,
    /// Factors of the equations of the unknowns.
    system: DenseSystem,
    /// Shear that a unit of each coefficient of the polynomials of the slip takes away \[Pa], and its moments.
    responses: Vec<ByDirection<N, D>>,
    /// By moment, then by coefficient.
    moments: ByPolynomials<D>,
}

/// The linear law of all lines and motions.
#[derive(Clone)]
pub struct Linearised<const N: usize, const D: usize> {
    lines: Vec<LinearLine<N, D>>,
    /// Factors of the equations of the slips that lines and motions give to each other.
    system: DenseSystem,
}

impl<const D: usize> Unknown<D> {
    /// One for each direction of points that stick, and one across the slip of those that slip in two and bear anything.
    fn of<const N: usize>(points: &[PointState<D>; N]) -> Vec<Self> {
        let mut all = Vec::with_capacity(D * N);
        for (point, state) in points.iter().enumerate() {
            match *state {
                PointState::Stick { .. } => all.extend((0..D).map(|direction| {
                    let along = std::array::from_fn(|c| if c == direction { 1.0 } else { 0.0 });
                    Self { point, along, turn: 0.0 }
                })),
                PointState::Slip { direction, turn, .. } if D == 2 && turn.is_finite() => {
                    let along = std::array::from_fn(|c| if c == 0 { -direction[1] } else { direction[0] });
                    all.push(Self { point, along, turn });
                }
                PointState::Slip { .. } => {}
            }
        }
        all
    }

    /// Part of a vector of its point.
    fn part(&self, of: [f64; D]) -> f64 {
        self.along.iter().zip(of).map(|(along, of)| along * of).sum()
    }
}

impl<const N: usize, const D: usize> LinearLine<N, D> {
    /// Law about a verdict; `None`: the equations are singular.
    fn new(problem: &ConeProblem<N, D>, verdict: &ConeVerdict<N, D>) -> Option<Self> {
        let (points, unknowns, rows) = (verdict.points, Unknown::of(&verdict.points), &problem.rows);
        let mut system = DenseSystem::default();
        system.reset(unknowns.len());
        for (i, unknown) in unknowns.iter().enumerate() {
            let (coefficients, _) = system.row(i);
            for (value, by) in coefficients.iter_mut().zip(&unknowns) {
                let slip = |c: usize| by.along[c] * rows.by_shear[c][by.point][unknown.point];
                *value = unknown.part(std::array::from_fn(slip));
            }
            coefficients[i] += unknown.turn;
        }
        if !system.factorise() {
            return None;
        }
        let responses = vec![[[0.0; N]; D]; D * POINTS];
        let mut line = Self { points, unknowns, system, responses, moments: [[[ByPowers::default(); D]; POINTS]; D] };
        let mut values = vec![[ByPowers::default(); D]; line.unknowns.len()];
        for (value, Unknown { point, along, .. }) in values.iter_mut().zip(&line.unknowns) {
            *value = along.map(|along| std::array::from_fn(|p| along * rows.powers[p][*point]));
        }
        if !line.system.solve_with_all(&mut values) {
            return None;
        }
        for (value, Unknown { point, along, .. }) in values.iter().zip(&line.unknowns) {
            for (response, value) in line.responses.iter_mut().zip(value.as_flattened()) {
                response.iter_mut().zip(along).for_each(|(shear, along)| shear[*point] += along * value);
            }
        }
        for (k, response) in line.responses.iter().enumerate() {
            let of_response = problem.moments(response);
            let moments = line.moments.as_flattened_mut().iter_mut().zip(of_response.as_flattened());
            moments.for_each(|(by_coefficient, moment)| by_coefficient.as_flattened_mut()[k] = *moment);
        }
        Some(line)
    }

    /// Shear of the unknowns under a right-hand side.
    fn solve(&mut self, right: impl Fn(&Unknown<D>) -> f64) -> Option<ByDirection<N, D>> {
        let mut values = [[0.0; D]; N];
        let values = &mut values.as_flattened_mut()[..self.unknowns.len()];
        values.iter_mut().zip(&self.unknowns).for_each(|(value, unknown)| *value = right(unknown));
        if !self.system.solve_with(values) {
            return None;
        }
        let mut shear = [[0.0; N]; D];
        for (unknown, value) in self.unknowns.iter().zip(values) {
            shear.iter_mut().zip(unknown.along).for_each(|(shear, along)| shear[unknown.point] += along * *value);
        }
        Some(shear)
    }

    /// True if the same points stick.
    fn is_of(&self, verdict: &ConeVerdict<N, D>) -> bool {
        let sticks = |state: &PointState<D>| matches!(state, PointState::Stick { .. });
        self.points.iter().zip(&verdict.points).all(|(mine, other)| sticks(mine) == sticks(other))
    }

    /// Change of the shear that takes away what a verdict misses, while nothing else changes.
    fn change(&mut self, problem: &ConeProblem<N, D>, verdict: &ConeVerdict<N, D>) -> Option<ByDirection<N, D>> {
        let mut given = [[0.0; N]; D];
        for (i, (mine, state)) in self.points.iter().zip(&verdict.points).enumerate() {
            let (PointState::Slip { direction, turn, .. }, PointState::Slip { excess, .. }) = (mine, state) else {
                continue;
            };
            let outward: f64 = direction.iter().zip(excess).map(|(direction, excess)| direction * excess).sum();
            for c in 0..D {
                given[c][i] = if turn.is_finite() { -outward * direction[c] } else { -excess[c] };
            }
        }
        let slips = problem.rows.slips_of(&given);
        let missing = |unknown: &Unknown<D>| {
            let i = unknown.point;
            let missing = match verdict.points[i] {
                PointState::Stick { slip } => unknown.part(slip),
                PointState::Slip { excess, .. } => (unknown.turn + problem.least[i]) * unknown.part(excess),
            };
            -missing - unknown.part(std::array::from_fn(|c| slips[c][i]))
        };
        let mut change = self.solve(missing)?;
        change.as_flattened_mut().iter_mut().zip(given.as_flattened()).for_each(|(change, given)| *change += given);
        Some(change)
    }
}

/// A free motion and the lines.
pub struct FreeMotion<const D: usize> {
    pub axis: Axis,
    /// Slips of every line by a unit of it.
    pub slips: Vec<Polynomials<D>>,
    /// Part that a unit of each moment of the shear of every line has in its balance.
    pub pulls: Vec<Polynomials<D>>,
    /// Change of the force [N/m] or moment \[N] that it takes, by all motions.
    pub resistance: PerAxis<f64>,
    /// Missing part of its balance without shear, where motions are those of the known slips [N/m, N].
    pub missing: f64,
    /// Resistance of a motion that is drawn to another one [kg/(m s), kg m/s], and how far that is from the one of the known
    /// slips.
    pub drawn: [f64; 2],
}

impl<const D: usize> FreeMotion<D> {
    /// Part of the shear of a line in the balance \[N/m, N], given its moments.
    fn pull(&self, line: usize, moments: &Polynomials<D>) -> f64 {
        self.pulls[line].as_flattened().iter().zip(moments.as_flattened()).map(|(pull, moment)| pull * moment).sum()
    }

    /// Part of the shear of all lines.
    pub fn pulls(&self, moments: &[Polynomials<D>]) -> f64 {
        moments.iter().enumerate().map(|(line, moments)| self.pull(line, moments)).sum()
    }

    /// Change of the force [N/m] or moment \[N] that it takes, by another motion.
    pub fn resistance(&self, other: Axis) -> f64 {
        let drawn = if self.axis == other { self.drawn[0] } else { 0.0 };
        self.resistance[other] + drawn
    }
}

/// Slips and forces that lines and motions give to each other under given pressures.
pub struct TangentialCoupling<const D: usize> {
    /// Slips of every line by the moments of every other one.
    pub between: Vec<ByPolynomials<D>>,
    /// Those that are free.
    pub motions: Vec<FreeMotion<D>>,
    /// Motions of the known slips.
    pub base: PerAxis<f64>,
    /// Rolling radius \[m], by which moments count as forces.
    pub radius: f64,
    /// Shares of the lines in the width \[1].
    pub shares: Vec<f64>,
    /// Force of friction on all lines [N/m].
    pub friction: f64,
}

/// Tangential problems of all lines, what they do to each other, and what the balances of the motions that are free miss
/// [N/m, N].
pub struct ConeProblems<'a, const N: usize, const D: usize> {
    pub lines: &'a [ConeProblem<N, D>],
    pub coupling: &'a TangentialCoupling<D>,
    pub unbalance: &'a [f64],
}

impl<const N: usize, const D: usize> Linearised<N, D> {
    /// Coefficients of the slips of a line.
    const SLIPS: usize = D * POINTS;

    /// Law about verdicts; `None`: the equations are singular.
    pub fn new(problems: &ConeProblems<N, D>, verdicts: &[ConeVerdict<N, D>]) -> Option<Self> {
        let lines: Option<Vec<_>> =
            problems.lines.iter().zip(verdicts).map(|(problem, verdict)| LinearLine::new(problem, verdict)).collect();
        let (lines, TangentialCoupling { between, motions, .. }) = (lines?, problems.coupling);
        let (count, all) = (lines.len(), Self::SLIPS * lines.len());
        let mut system = DenseSystem::default();
        system.reset(all + motions.len());
        let mut slips = [[[ByPowers::default(); D]; POINTS]; D];
        for at in 0..count {
            for (by, line) in lines.iter().enumerate() {
                slips_by_slips(&between[count * at + by], &line.moments, &mut slips);
                for (p, slips) in slips.as_flattened().iter().enumerate() {
                    let row = &mut system.row(Self::SLIPS * at + p).0[Self::SLIPS * by..];
                    row[..Self::SLIPS].copy_from_slice(slips.as_flattened());
                }
            }
            for p in 0..Self::SLIPS {
                system.row(Self::SLIPS * at + p).0[Self::SLIPS * at + p] += 1.0;
            }
            for (column, motion) in motions.iter().enumerate() {
                let slips = motion.slips[at].as_flattened().iter().enumerate();
                slips.for_each(|(p, slip)| system.row(Self::SLIPS * at + p).0[all + column] = -slip);
            }
        }
        for (i, motion) in motions.iter().enumerate() {
            let (row, _) = system.row(all + i);
            for (by, line) in lines.iter().enumerate() {
                let row = &mut row[Self::SLIPS * by..][..Self::SLIPS];
                for (pull, moments) in motion.pulls[by].as_flattened().iter().zip(line.moments.as_flattened()) {
                    row.iter_mut().zip(moments.as_flattened()).for_each(|(value, moment)| *value += pull * moment);
                }
            }
            for (column, other) in motions.iter().enumerate() {
                row[all + column] = motion.resistance(other.axis);
            }
        }
        system.factorise().then_some(Self { lines, system })
    }

    /// True if the same points stick.
    pub fn is_of(&self, verdicts: &[ConeVerdict<N, D>]) -> bool {
        self.lines.iter().zip(verdicts).all(|(line, verdict)| line.is_of(verdict))
    }

    /// Changes of the shear of all lines and of the free motions that take away what verdicts and balances miss.
    pub fn changes(
        &mut self,
        problems: &ConeProblems<N, D>,
        verdicts: &[ConeVerdict<N, D>],
    ) -> Option<(Vec<ByDirection<N, D>>, Vec<f64>)> {
        let alone = self.lines.iter_mut().zip(problems.lines).zip(verdicts);
        let alone: Option<Vec<_>> = alone.map(|((line, problem), verdict)| line.change(problem, verdict)).collect();
        let (mut changes, count) = (alone?, self.lines.len());
        let TangentialCoupling { between, motions, .. } = problems.coupling;
        let moments: Vec<_> =
            problems.lines.iter().zip(&changes).map(|(problem, change)| problem.moments(change)).collect();
        let mut right = vec![0.0; Self::SLIPS * count + problems.unbalance.len()];
        let (slips, balances) = right.split_at_mut(Self::SLIPS * count);
        for (at, slips) in slips.chunks_exact_mut(Self::SLIPS).enumerate() {
            slips.copy_from_slice(sum_between(between, at, &moments).as_flattened());
        }
        for ((balance, motion), missing) in balances.iter_mut().zip(motions).zip(problems.unbalance) {
            *balance = missing + motion.pulls(&moments);
        }
        if !self.system.solve_with(&mut right) {
            return None;
        }
        let (slips, moved) = right.split_at(Self::SLIPS * count);
        for ((change, line), slips) in changes.iter_mut().zip(&self.lines).zip(slips.chunks_exact(Self::SLIPS)) {
            for (slip, response) in slips.iter().zip(&line.responses) {
                let change = change.as_flattened_mut().iter_mut().zip(response.as_flattened());
                change.for_each(|(change, by)| *change -= slip * by);
            }
        }
        Some((changes, moved.to_vec()))
    }
}

vectorised! {
    /// Writes coefficients of slips, row by row, that a line takes from units of those of another one, with the moments of
    /// whose shear these come.
    fn slips_by_slips<'a, S, const D: usize>(
        _simd,
        between: &'a ByPolynomials<D>,
        moments: &'a ByPolynomials<D>,
        slips: &'a mut ByPolynomials<D>,
    ) {
        for (p, slips) in slips.as_flattened_mut().iter_mut().enumerate() {
            let mut sums = [ByPowers::default(); D];
            for (between, moments) in between.as_flattened().iter().zip(moments.as_flattened()) {
                let (by, sums) = (between.as_flattened()[p], sums.as_flattened_mut());
                sums.iter_mut().zip(moments.as_flattened()).for_each(|(sum, moment)| *sum += by * moment);
            }
            *slips = sums;
        }
    }
}

vectorised! {
    /// Slips of a line by the moments of all lines.
    fn sum_between<'a, S, const D: usize>(
        _simd,
        between: &'a [ByPolynomials<D>],
        at: usize,
        moments: &'a [Polynomials<D>],
    ) -> Polynomials<D> {
        let mut sum = [ByPowers::default(); D];
        for (between, moments) in between[moments.len() * at..].iter().zip(moments) {
            for (slips, moment) in between.as_flattened().iter().zip(moments.as_flattened()) {
                let sums = sum.as_flattened_mut().iter_mut().zip(slips.as_flattened());
                sums.for_each(|(sum, slip)| *sum += moment * slip);
            }
        }
        sum
    }
}
