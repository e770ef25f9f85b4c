//! The law of [`super::law`] made linear, on one line and for all lines and motions together.

use super::law::{AlongAcross, ConeProblem, ConeVerdict, PointState, SLIPS};
use crate::axes::{Axis, PerAxis};
use crate::linalg::vectorised::vectorised;
use crate::linalg::{DenseSystem, POINTS};

/// One unknown of the linear law with its equation: part of the shear of a point in a direction.
#[derive(Clone, Copy)]
struct Unknown {
    point: usize,
    along: [f64; 2],
    turn: f64,
}

/// The linear law of one line.
#[derive(Clone)]
struct LinearLine<const N: usize> {
    points: [PointState; N],
    unknowns: Vec<Unknown>,
    /// Factors of the equations of the unknowns.
    system: DenseSystem,
    /// Shear that a unit of each coefficient of the polynomials of the slip takes away \[Pa], and its moments.
    responses: Vec<AlongAcross<N>>,
    moments: [[f64; SLIPS]; SLIPS],
}

/// The linear law of all lines and motions.
#[derive(Clone)]
pub struct Linearised<const N: usize> {
    lines: Vec<LinearLine<N>>,
    /// Factors of the equations of the slips that lines and motions give to each other.
    system: DenseSystem,
}

impl Unknown {
    /// Two of each point that sticks, and one of each that slips and bears anything.
    fn of<const N: usize>(points: &[PointState; N]) -> Vec<Self> {
        let mut all = Vec::with_capacity(2 * N);
        for (point, state) in points.iter().enumerate() {
            match *state {
                PointState::Stick { .. } => {
                    all.extend([[1.0, 0.0], [0.0, 1.0]].map(|along| Self { point, along, turn: 0.0 }));
                }
                PointState::Slip { turn, .. } if !turn.is_finite() => {}
                PointState::Slip { direction, turn, .. } => {
                    all.push(Self { point, along: [-direction[1], direction[0]], turn });
                }
            }
        }
        all
    }

    /// Part of a vector of its point.
    fn part(&self, of: [f64; 2]) -> f64 {
        self.along[0] * of[0] + self.along[1] * of[1]
    }
}

impl<const N: usize> LinearLine<N> {
    /// Law about a verdict; `None`: the equations are singular.
    fn new(problem: &ConeProblem<N>, verdict: &ConeVerdict<N>) -> Option<Self> {
        let (points, unknowns, rows) = (verdict.points, Unknown::of(&verdict.points), &problem.rows);
        let mut system = DenseSystem::default();
        system.reset(unknowns.len());
        for (i, unknown) in unknowns.iter().enumerate() {
            let (coefficients, _) = system.row(i);
            for (value, by) in coefficients.iter_mut().zip(&unknowns) {
                *value = unknown.part([0, 1].map(|c| by.along[c] * rows.by_shear[c][by.point][unknown.point]));
            }
            coefficients[i] += unknown.turn;
        }
        if !system.factorise() {
            return None;
        }
        let responses = vec![[[0.0; N]; 2]; SLIPS];
        let mut line = Self { points, unknowns, system, responses, moments: [[0.0; SLIPS]; SLIPS] };
        let mut values = vec![[0.0; SLIPS]; line.unknowns.len()];
        for (value, Unknown { point, along, .. }) in values.iter_mut().zip(&line.unknowns) {
            *value = std::array::from_fn(|k| along[k / POINTS] * rows.powers[k % POINTS][*point]);
        }
        if !line.system.solve_with_all(&mut values) {
            return None;
        }
        for (value, Unknown { point, along, .. }) in values.iter().zip(&line.unknowns) {
            for (response, value) in line.responses.iter_mut().zip(value) {
                response.iter_mut().zip(along).for_each(|(shear, along)| shear[*point] += along * value);
            }
        }
        line.moments = std::array::from_fn(|k| problem.moments(&line.responses[k]));
        Some(line)
    }

    /// Shear of the unknowns under a right-hand side.
    fn solve(&mut self, right: impl Fn(&Unknown) -> f64) -> Option<AlongAcross<N>> {
        let mut values = [[0.0; 2]; N];
        let values = &mut values.as_flattened_mut()[..self.unknowns.len()];
        values.iter_mut().zip(&self.unknowns).for_each(|(value, unknown)| *value = right(unknown));
        if !self.system.solve_with(values) {
            return None;
        }
        let mut shear = [[0.0; N]; 2];
        for (unknown, value) in self.unknowns.iter().zip(values) {
            shear.iter_mut().zip(unknown.along).for_each(|(shear, along)| shear[unknown.point] += along * *value);
        }
        Some(shear)
    }

    /// True if the same points stick.
    fn is_of(&self, verdict: &ConeVerdict<N>) -> bool {
        let sticks = |state: &PointState| matches!(state, PointState::Stick { .. });
        self.points.iter().zip(&verdict.points).all(|(mine, other)| sticks(mine) == sticks(other))
    }

    /// Change of the shear that takes away what a verdict misses, while nothing else changes.
    fn change(&mut self, problem: &ConeProblem<N>, verdict: &ConeVerdict<N>) -> Option<AlongAcross<N>> {
        let mut given = [[0.0; N]; 2];
        for (i, (mine, state)) in self.points.iter().zip(&verdict.points).enumerate() {
            let (PointState::Slip { direction, turn, .. }, PointState::Slip { excess, .. }) = (mine, state) else {
                continue;
            };
            let outward = direction[0] * excess[0] + direction[1] * excess[1];
            for c in 0..2 {
                given[c][i] = if turn.is_finite() { -outward * direction[c] } else { -excess[c] };
            }
        }
        let slips = problem.rows.slips_of(&given);
        let missing = |unknown: &Unknown| {
            let i = unknown.point;
            let missing = match verdict.points[i] {
                PointState::Stick { slip } => unknown.part(slip),
                PointState::Slip { excess, .. } => (unknown.turn + problem.least[i]) * unknown.part(excess),
            };
            -missing - unknown.part([slips[0][i], slips[1][i]])
        };
        let mut change = self.solve(missing)?;
        change.as_flattened_mut().iter_mut().zip(given.as_flattened()).for_each(|(change, given)| *change += given);
        Some(change)
    }
}

/// A free motion and the lines.
pub struct FreeMotion {
    pub axis: Axis,
    /// Slips of every line by a unit of it, as coefficients of polynomials along, then across.
    pub slips: Vec<[f64; SLIPS]>,
    /// Part that a unit of each moment of the shear of every line has in its balance.
    pub pulls: Vec<[f64; SLIPS]>,
    /// Change of the force [N/m] or moment \[N] that it takes, by all motions.
    pub resistance: PerAxis<f64>,
    /// Missing part of its balance without shear, where motions are those of the known slips [N/m, N].
    pub missing: f64,
    /// Resistance of a motion that is drawn to another one [kg/(m s), kg m/s], and how far that is from the one of the known
    /// slips.
    pub drawn: [f64; 2],
}

impl FreeMotion {
    /// Part of the shear of a line in the balance \[N/m, N], given its moments along, then across.
    fn pull(&self, line: usize, moments: &[f64; SLIPS]) -> f64 {
        self.pulls[line].iter().zip(moments).map(|(pull, moment)| pull * moment).sum()
    }

    /// Part of the shear of all lines.
    pub fn pulls(&self, moments: &[[f64; SLIPS]]) -> f64 {
        moments.iter().enumerate().map(|(line, moments)| self.pull(line, moments)).sum()
    }

    /// Change of the force [N/m] or moment \[N] that it takes, by another motion.
    pub fn resistance(&self, other: Axis) -> f64 {
        let drawn = if self.axis == other { self.drawn[0] } else { 0.0 };
        self.resistance[other] + drawn
    }
}

/// Slips and forces that lines and motions give to each other under given pressures.
pub struct TangentialCoupling {
    /// Slips of every line by the moments of every other one.
    pub between: Vec<[[f64; SLIPS]; SLIPS]>,
    /// Those that are free.
    pub motions: Vec<FreeMotion>,
    /// Motions of the known slips.
    pub base: PerAxis<f64>,
    /// Rolling radius \[m], by which moments count as forces.
    pub radius: f64,
    /// Shares of the lines in the width \[1].
    pub shares: Vec<f64>,
    /// Force of friction on all lines [N/m].
    pub friction: f64,
}

impl TangentialCoupling {
    /// Slips of a line by given moments of the shear of all lines, as coefficients of polynomials along, then across.
    pub fn by_lines(&self, at: usize, moments: &[[f64; SLIPS]]) -> [f64; SLIPS] {
        sum_between(&self.between, at, moments)
    }
}

/// Tangential problems of all lines, what they do to each other, and what the balances of the motions that are free miss
/// [N/m, N].
pub struct ConeProblems<'a, const N: usize> {
    pub lines: &'a [ConeProblem<N>],
    pub coupling: &'a TangentialCoupling,
    pub unbalance: &'a [f64],
}

impl<const N: usize> Linearised<N> {
    /// Law about verdicts; `None`: the equations are singular.
    pub fn new(problems: &ConeProblems<N>, verdicts: &[ConeVerdict<N>]) -> Option<Self> {
        let lines: Option<Vec<_>> =
            problems.lines.iter().zip(verdicts).map(|(problem, verdict)| LinearLine::new(problem, verdict)).collect();
        let (lines, TangentialCoupling { between, motions, .. }) = (lines?, problems.coupling);
        let (count, all) = (lines.len(), SLIPS * lines.len());
        let mut system = DenseSystem::default();
        system.reset(all + motions.len());
        for at in 0..count {
            for (by, line) in lines.iter().enumerate() {
                let slips = slips_by_slips(&between[count * at + by], &line.moments);
                for (p, slips) in slips.iter().enumerate() {
                    system.row(SLIPS * at + p).0[SLIPS * by..][..SLIPS].copy_from_slice(slips);
                }
            }
            for p in 0..SLIPS {
                system.row(SLIPS * at + p).0[SLIPS * at + p] += 1.0;
            }
            for (column, motion) in motions.iter().enumerate() {
                let slips = motion.slips[at].iter().enumerate();
                slips.for_each(|(p, slip)| system.row(SLIPS * at + p).0[all + column] = -slip);
            }
        }
        for (i, motion) in motions.iter().enumerate() {
            let (row, _) = system.row(all + i);
            for (by, line) in lines.iter().enumerate() {
                let row = row[SLIPS * by..][..SLIPS].iter_mut();
                row.zip(&line.moments).for_each(|(value, moments)| *value = motion.pull(by, moments));
            }
            for (column, other) in motions.iter().enumerate() {
                row[all + column] = motion.resistance(other.axis);
            }
        }
        system.factorise().then_some(Self { lines, system })
    }

    /// True if the same points stick.
    pub fn is_of(&self, verdicts: &[ConeVerdict<N>]) -> bool {
        self.lines.iter().zip(verdicts).all(|(line, verdict)| line.is_of(verdict))
    }

    /// Changes of the shear of all lines and of the free motions that take away what verdicts and balances miss.
    pub fn changes(
        &mut self,
        problems: &ConeProblems<N>,
        verdicts: &[ConeVerdict<N>],
    ) -> Option<(Vec<AlongAcross<N>>, Vec<f64>)> {
        let alone = self.lines.iter_mut().zip(problems.lines).zip(verdicts);
        let alone: Option<Vec<_>> = alone.map(|((line, problem), verdict)| line.change(problem, verdict)).collect();
        let (mut changes, count) = (alone?, self.lines.len());
        let TangentialCoupling { between, motions, .. } = problems.coupling;
        let moments: Vec<_> =
            problems.lines.iter().zip(&changes).map(|(problem, change)| problem.moments(change)).collect();
        let mut right = vec![0.0; SLIPS * count + problems.unbalance.len()];
        let (slips, balances) = right.split_at_mut(SLIPS * count);
        for (at, slips) in slips.as_chunks_mut::<SLIPS>().0.iter_mut().enumerate() {
            *slips = sum_between(between, at, &moments);
        }
        for ((balance, motion), missing) in balances.iter_mut().zip(motions).zip(problems.unbalance) {
            *balance = missing + motion.pulls(&moments);
        }
        if !self.system.solve_with(&mut right) {
            return None;
        }
        let (slips, moved) = right.split_at(SLIPS * count);
        for ((change, line), slips) in changes.iter_mut().zip(&self.lines).zip(slips.as_chunks::<SLIPS>().0) {
            for (slip, response) in slips.iter().zip(&line.responses) {
                let change = change.as_flattened_mut().iter_mut().zip(response.as_flattened());
                change.for_each(|(change, by)| *change -= slip * by);
            }
        }
        Some((changes, moved.to_vec()))
    }
}

vectorised! {
    /// Coefficients of slips, row by row, that a line takes from units of those of another one, with the moments of whose
    /// shear these come.
    fn slips_by_slips<'a, S>(
        _simd,
        between: &'a [[f64; SLIPS]; SLIPS],
        moments: &'a [[f64; SLIPS]; SLIPS],
    ) -> [[f64; SLIPS]; SLIPS] {
        let (mut by_moment, mut slips) = ([[0.0; SLIPS]; SLIPS], [[0.0; SLIPS]; SLIPS]);
        for m in 0..SLIPS {
            for k in 0..SLIPS {
                by_moment[m][k] = moments[k][m];
            }
        }
        for (p, slips) in slips.iter_mut().enumerate() {
            let mut sums = [0.0; SLIPS];
            for m in 0..SLIPS {
                let by = between[m][p];
                for k in 0..SLIPS {
                    sums[k] += by * by_moment[m][k];
                }
            }
            *slips = sums;
        }
        slips
    }
}

vectorised! {
    /// Slips of a line by the moments of all lines, as coefficients of polynomials along and across.
    fn sum_between<'a, S>(
        _simd,
        between: &'a [[[f64; SLIPS]; SLIPS]],
        at: usize,
        moments: &'a [[f64; SLIPS]],
    ) -> [f64; SLIPS] {
        let mut sum = [0.0; SLIPS];
        for (between, moments) in between[moments.len() * at..].iter().zip(moments) {
            for (slips, moment) in between.iter().zip(moments) {
                sum.iter_mut().zip(slips).for_each(|(sum, slip)| *sum += moment * slip);
            }
        }
        sum
    }
}
