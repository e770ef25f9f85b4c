//! Linear problem of given states.
//!
//! Bodies and lines pass on forces by moments with polynomials. So the forces of every line are found around its own factors
//! ([`super::own_forces`]), and the forces on the bodies' ports, the moments of all lines, their rim angles and the motions
//! that are sought follow from one small system: any number of lines costs as often as much as one.

use super::axes::Axes;
use super::own_forces::{
    ACROSS, ALONG, ANGLE, BODIES, FELT, Felt, KNOWN, LOAD, MOMENTS, MOTIONS, OPENED, OwnForces, PULL, SHEAR,
    SUMS_ACROSS, SUMS_ALONG, TURN, add, product,
};
use super::unknowns::Unknowns;
use crate::axes::Axis;
use crate::contact::error::ContactError;
use crate::contact::line::contact_line::ContactLine;
use crate::contact::line::rows::{BODY_CAUSES, BodyRows};
use crate::linalg::vectorised::{add_columns, dot, vectorised};
use crate::linalg::{DenseSystem, POINTS};
use std::ops::Range;

/// Forces on the ports.
const ON_PORTS: usize = 2 * POINTS;

/// Solution of linear problems, and its memory.
#[derive(Default)]
pub(super) struct LinearSolver {
    along: Solver<ALONG, SUMS_ALONG>,
    across: Solver<ACROSS, SUMS_ACROSS>,
}

impl LinearSolver {
    /// Solves a linear problem and gives the lines their forces and motions. With `given` tangential forces at the candidates
    /// of every line, pressures alone are sought, and of the motions the height.
    pub fn solve(
        &mut self,
        lines: &mut [ContactLine],
        with: (&Axes, &Unknowns),
        given: Option<&[Vec<f64>]>,
    ) -> Result<(), ContactError> {
        match lines.iter().any(|line| line.state.directions() > 1) {
            false => self.along.solve(lines, with, given),
            true => self.across.solve(lines, with, given),
        }
    }

    /// Corrects the solution of the last linear problem for new directions of friction; false: that problem has none, or there is
    /// no finite correction.
    pub fn correct(&mut self, lines: &mut [ContactLine], with: (&Axes, &Unknowns)) -> bool {
        lines.iter().any(|line| line.state.directions() > 1) && self.across.correct(lines, with).is_some()
    }
}

/// Solution of linear problems in which what a line feels has C columns, and what it does N.
#[derive(Default)]
struct Solver<const C: usize, const N: usize> {
    lines: Vec<OwnForces<C, N>>,
    /// Equations of the small system, row by row, and the values of its unknowns where they are zero, with their signs
    /// reversed.
    rows: Vec<f64>,
    constants: Vec<f64>,
    /// Units in which unknowns are counted.
    units: Vec<f64>,
    system: DenseSystem,
    memory: SmallMemory,
}

/// Memory of [`Small`].
#[derive(Default)]
struct SmallMemory {
    between: Vec<f64>,
    bodies: Vec<BodyRows>,
}

/// Numbering of the unknowns of the small system: forces on the ports and motions, moments and rim angle of every line.
#[derive(Clone, Copy)]
struct Numbering {
    lines: usize,
    /// Directions of the shear whose moments lines feel.
    directions: usize,
    motions: usize,
}

impl Numbering {
    fn motions(self) -> Range<usize> {
        ON_PORTS..ON_PORTS + self.motions
    }

    /// Moments of all lines in all directions.
    fn moments(self) -> Range<usize> {
        let first = ON_PORTS + self.motions;
        first..first + self.lines * self.directions * POINTS
    }

    fn moment(self, line: usize, direction: usize) -> usize {
        self.moments().start + (line * self.directions + direction) * POINTS
    }

    fn angle(self, line: usize) -> usize {
        self.moments().end + line
    }

    fn len(self) -> usize {
        self.angle(self.lines)
    }
}

/// A linear problem and the lines whose states are given.
struct Small<'a, 'b> {
    lines: &'a [ContactLine<'b>],
    axes: &'a Axes<'a>,
    sought: &'a [Axis],
    places: Numbering,
    /// Coefficients of the slip that every line feels in every direction, one after the other and each by the moments of every
    /// line in every direction.
    between: Vec<f64>,
    /// Effects of the bodies on every line.
    bodies: Vec<BodyRows>,
    /// Places of their points \[m].
    points: [f64; POINTS],
}

impl<const C: usize, const N: usize> Solver<C, N> {
    /// Solves a linear problem and gives the lines their forces and motions. With `given` tangential forces at the candidates
    /// of every line, pressures alone are sought, and of the motions the height.
    #[inline(never)]
    fn solve(
        &mut self,
        lines: &mut [ContactLine],
        (axes, unknowns): (&Axes, &Unknowns),
        given: Option<&[Vec<f64>]>,
    ) -> Result<(), ContactError> {
        let singular = || ContactError::Singular { closed: unknowns.closed() };
        self.lines.resize_with(lines.len(), OwnForces::default);
        for (k, (own, line)) in self.lines.iter_mut().zip(&*lines).enumerate() {
            let given = given.map(|given| given[k].as_slice());
            if !own.find(line, &unknowns.lines[k], (axes, &unknowns.axes), given) {
                return Err(singular());
            }
        }
        let small = Small::new(lines, axes, &unknowns.axes, std::mem::take(&mut self.memory));
        self.write(&small);
        let solution = self.solution().ok_or_else(singular)?;
        let felt: Vec<Felt<C>> = small.all_felt(&solution, 1.0).collect();
        let changes = &solution[small.places.motions()];
        self.memory = small.memory();
        for ((own, line), felt) in self.lines.iter().zip(&mut *lines).zip(&felt) {
            line.state.forces.fill(0.0);
            if given.is_none() {
                line.state.lateral.fill(0.0);
            }
            own.take(felt, |i, normal, [along, across]| {
                let at = line.grid.component(i);
                (line.state.forces[at], line.state.forces[at + 1]) = (along, normal);
                if let Some(lateral) = line.state.lateral.get_mut(i).filter(|_| given.is_none()) {
                    *lateral = across;
                }
            });
        }
        unknowns.move_by(changes, lines, axes);
        Ok(())
    }

    /// Corrects the solution of the last linear problem, whose factors it takes, for new directions of friction; `None`: it is left
    /// as it is, since there is no finite correction.
    #[inline(never)]
    fn correct(&mut self, lines: &mut [ContactLine], (axes, unknowns): (&Axes, &Unknowns)) -> Option<()> {
        let sought = &unknowns.axes;
        let of_lines = self.lines.iter_mut().zip(&*lines);
        let sums: Vec<[f64; N]> = of_lines.map(|(own, line)| own.correct(line, sought)).collect::<Option<_>>()?;
        let small = Small::kept(lines, axes, sought, std::mem::take(&mut self.memory));
        self.constants.fill(0.0);
        for (k, sums) in sums.iter().enumerate() {
            small.equations(k).for_each(|(sum, factor, at)| self.constants[at] += factor * sums[sum]);
        }
        let solution = self.substitute();
        let felt: Vec<Felt<C>> = solution.iter().flat_map(|solution| small.all_felt(solution, 0.0)).collect();
        let (motions, memory) = (small.places.motions(), small.memory());
        self.memory = memory;
        for ((own, line), felt) in self.lines.iter().zip(&mut *lines).zip(&felt) {
            let mut corrections = own.corrections.iter();
            own.take(felt, |i, normal, shear| {
                let at = line.grid.component(i);
                let corrected = corrections.next().copied().unwrap_or_default();
                line.state.forces[at] += shear[0] + corrected[0];
                line.state.forces[at + 1] += normal;
                line.state.lateral[i] += shear[1] + corrected[1];
            });
        }
        unknowns.move_by(&solution?[motions], lines, axes);
        Some(())
    }

    /// Writes the small system.
    #[inline(never)]
    fn write(&mut self, small: &Small) {
        let (size, lines) = (small.places.len(), small.lines);
        self.rows.clear();
        self.rows.resize(size * size, 0.0);
        self.constants.clear();
        self.constants.resize(size, 0.0);
        (0..ON_PORTS).chain(small.places.moments()).for_each(|k| self.rows[k * size + k] = 1.0);
        for (number, &axis) in small.sought.iter().enumerate() {
            small.add_balance(axis, row(&mut self.rows, &mut self.constants, ON_PORTS + number));
        }
        for (k, (own, line)) in self.lines.iter_mut().zip(lines).enumerate() {
            let sums = own.sums(line, small.sought);
            for (sum, factor, at) in small.equations(k) {
                small.add(k, &sums[sum], factor, row(&mut self.rows, &mut self.constants, at));
            }
            let at = small.places.angle(k);
            small.add_angle(k, row(&mut self.rows, &mut self.constants, at));
        }
    }

    /// Solution of the small system; `None`: there is none.
    fn solution(&mut self) -> Option<Vec<f64>> {
        let Self { rows, constants, units, system, .. } = self;
        let size = constants.len();
        units.clear();
        units.resize(size, 0.0);
        for row in rows.chunks_exact(size) {
            let largest = row.iter().fold(0.0, |most: f64, value| most.max(value.abs()));
            let over = 1.0 / largest;
            units.iter_mut().zip(row).for_each(|(unit, value)| *unit = unit.max(value.abs() * over));
        }
        units.iter_mut().for_each(|unit| *unit = if *unit > 0.0 { 1.0 / *unit } else { 1.0 });
        for row in rows.chunks_exact_mut(size) {
            row.iter_mut().zip(&*units).for_each(|(value, unit)| *value *= unit);
        }
        system.set(size, rows.chunks_exact(size));
        if system.factorise() { self.substitute() } else { None }
    }

    /// Solution of the small system with the factors at hand and the present constants; `None`: it is not finite.
    fn substitute(&mut self) -> Option<Vec<f64>> {
        let mut solution: Vec<f64> = self.constants.iter().map(|constant| -constant).collect();
        self.system.solve_with(&mut solution).then(|| {
            solution.iter_mut().zip(&self.units).for_each(|(value, unit)| *value *= unit);
            solution
        })
    }
}

/// An equation of the small system and its constant.
type SmallRow<'a> = (&'a mut [f64], &'a mut f64);

fn row<'a>(rows: &'a mut [f64], constants: &'a mut [f64], at: usize) -> SmallRow<'a> {
    let size = constants.len();
    (&mut rows[at * size..][..size], &mut constants[at])
}

impl<'a, 'b> Small<'a, 'b> {
    fn new(lines: &'a [ContactLine<'b>], axes: &'a Axes<'a>, sought: &'a [Axis], memory: SmallMemory) -> Self {
        let mut small = Self::kept(lines, axes, sought, memory);
        let Self { places, between, bodies, .. } = &mut small;
        between.clear();
        bodies.clear();
        let directions = places.directions;
        for (line, direction) in lines.iter().flat_map(|line| (0..directions).map(move |direction| (line, direction))) {
            line.slips_by_moments(direction, [lines.len(), directions], between);
        }
        bodies.extend(lines.iter().map(|line| line.body_rows(sought, axes.gains())));
        small
    }

    /// The problem to which the `memory` belongs.
    fn kept(lines: &'a [ContactLine<'b>], axes: &'a Axes<'a>, sought: &'a [Axis], memory: SmallMemory) -> Self {
        let felt = lines.iter().all(|line| line.problem.patch.is_some());
        let directions = if felt { lines[0].state.directions() } else { 0 };
        let places = Numbering { lines: lines.len(), directions, motions: sought.len() };
        let SmallMemory { between, bodies } = memory;
        Self { lines, axes, sought, places, between, bodies, points: lines[0].grid.points.nodes() }
    }

    fn memory(self) -> SmallMemory {
        SmallMemory { between: self.between, bodies: self.bodies }
    }

    /// Sums over line `k` with their factors and the equations in which they stand.
    fn equations(&self, k: usize) -> impl Iterator<Item = (usize, f64, usize)> {
        let (places, share) = (self.places, self.lines[k].problem.share);
        let ports =
            move |point| [(SHEAR.start + point, -share, 2 * point), (LOAD.start + point, -share, 2 * point + 1)];
        let acts = |number: &usize| !self.axes.holds(self.sought[*number]);
        let pulls = (0..places.motions).filter(acts).map(move |number| (PULL.start + number, share, ON_PORTS + number));
        let moment = move |direction, (n, moment)| (moment, -1.0, places.moment(k, direction) + n);
        let directions = MOMENTS.into_iter().enumerate().take(places.directions);
        let moments = directions.flat_map(move |(d, moments)| moments.enumerate().map(move |of| moment(d, of)));
        (0..POINTS).flat_map(ports).chain(pulls).chain(moments).chain([(TURN, -1.0, places.angle(k))])
    }

    /// Adds `factor` times an affine function of what line `k` feels to an equation.
    fn add<const C: usize>(&self, k: usize, of: &Felt<C>, factor: f64, (row, constant): SmallRow) {
        let (places, mut by_bodies) = (self.places, [0.0; BODY_CAUSES]);
        *constant += factor * of[KNOWN];
        add_rows(&of[BODIES], &self.bodies[k], &mut by_bodies);
        add(factor, &by_bodies, &mut row[..places.moments().start]);
        row[places.angle(k)] += factor * (of[ANGLE] - product(&of[OPENED], &self.points));
        add(factor, &of[MOTIONS], &mut row[places.motions()]);
        let felt = &of[FELT[0].start..][..places.directions * POINTS];
        add_columns(factor, self.between_of(k), places.moments().len(), felt, &mut row[places.moments()]);
    }

    /// Coefficients of the slips that line `k` feels, each by the moments of all lines in all directions.
    fn between_of(&self, k: usize) -> &[f64] {
        let count = self.places.moments().len() * self.places.directions * POINTS;
        &self.between[k * count..][..count]
    }

    /// Adds what the rim angle of line `k` has by bodies and motions to its equation.
    fn add_angle(&self, k: usize, (row, constant): SmallRow) {
        let line = &self.lines[k];
        let rim = &line.iterate.rim;
        row[self.places.angle(k)] += 1.0;
        *constant += line.frame.rim_angle - rim.constant;
        row[..ON_PORTS].iter_mut().zip(rim.by_ports.iter()).for_each(|(value, by)| *value -= by);
        let by_motion = |axis: Axis| self.axes.gain(axis) * rim.accelerations[axis];
        *constant -= Axis::ALL.into_iter().map(|axis| by_motion(axis) * line.traction.rigid[axis]).sum::<f64>();
        for (number, &axis) in self.sought.iter().enumerate() {
            row[ON_PORTS + number] -= by_motion(axis);
        }
    }

    /// Adds the balance of a sought motion without the pull of the lines, or rest where a brake holds it.
    fn add_balance(&self, axis: Axis, (row, constant): SmallRow) {
        let balance = self.axes.row(axis, self.lines);
        *constant += balance.constant + balance.motions.dot(self.lines[0].traction.rigid);
        add(1.0, &balance.ports, &mut row[..ON_PORTS]);
        for (number, &axis) in self.sought.iter().enumerate() {
            row[ON_PORTS + number] += balance.motions[axis];
        }
    }

    /// Numbers that the lines feel in a solution, with this one of the known column.
    fn all_felt<const C: usize>(&self, solution: &[f64], known: f64) -> impl Iterator<Item = Felt<C>> {
        (0..self.places.lines).map(move |k| self.felt(k, solution, known))
    }

    /// Numbers that line `k` feels in a solution, with this one of the known column.
    fn felt<const C: usize>(&self, k: usize, solution: &[f64], known: f64) -> Felt<C> {
        let (places, mut felt) = (self.places, [0.0; C]);
        let (causes, angle) = (&solution[..places.moments().start], solution[places.angle(k)]);
        felt[KNOWN] = known;
        felt[BODIES].iter_mut().zip(&self.bodies[k]).for_each(|(felt, by)| *felt = product(causes, by));
        felt[OPENED].iter_mut().zip(self.points).for_each(|(opened, x)| *opened -= x * angle);
        felt[ANGLE] = angle;
        felt[MOTIONS][..places.motions].copy_from_slice(&solution[places.motions()]);
        let moments = &solution[places.moments()];
        if !moments.is_empty() {
            let of_line = felt[FELT[0].start..].iter_mut().zip(self.between_of(k).chunks_exact(moments.len()));
            of_line.for_each(|(felt, by)| *felt = dot(moments, by));
        }
        felt
    }
}

vectorised! {
    /// Adds rows, times factors.
    fn add_rows<'a, S>(simd, factors: &'a [f64], rows: &'a BodyRows, sum: &'a mut [f64; BODY_CAUSES]) {
        for (q, sum) in S::as_mut_simd_f64s(sum).0.iter_mut().enumerate() {
            for (factor, row) in factors.iter().zip(rows) {
                *sum = simd.mul_add_e_f64s(simd.splat_f64s(*factor), S::as_simd_f64s(row).0[q], *sum);
            }
        }
    }
}
