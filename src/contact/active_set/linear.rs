//! Linear problem of given states.
//!
//! Bodies and lines pass on forces by moments with polynomials. So the forces of every line are found around its own factors
//! ([`super::own_forces`]), and the forces on the bodies' ports, the moments of all lines, their rim angles and the motions
//! that are sought follow from one small system: any number of lines costs as often as much as one.

use super::axes::Axes;
use super::own_forces::{ANGLE, FELT, Felt, KNOWN, MOTIONS, OPENED, OwnForces, PORTS, add};
use super::unknowns::Unknowns;
use crate::axes::Axis;
use crate::contact::error::ContactError;
use crate::contact::line::contact_line::ContactLine;
use crate::contact::problem::SurfaceResponse;
use crate::linalg::{DenseSystem, POINTS};

/// Forces on the ports.
const ON_PORTS: usize = 2 * POINTS;

/// Solution of linear problems, and its memory.
#[derive(Default)]
pub(super) struct LinearSolver {
    lines: Vec<OwnForces>,
    /// Equations of the small system, row by row, and the values of its unknowns where they are zero, with their signs
    /// reversed.
    rows: Vec<f64>,
    constants: Vec<f64>,
    /// Units in which unknowns are counted.
    units: Vec<f64>,
    system: DenseSystem,
}

/// Numbering of the unknowns of the small system: forces on the ports, moments and rim angle of every line, motions.
#[derive(Clone, Copy)]
struct Numbering {
    lines: usize,
    /// Moments of a line.
    moments: usize,
    motions: usize,
}

impl Numbering {
    fn moment(self, line: usize, k: usize) -> usize {
        ON_PORTS + line * self.moments + k
    }

    fn angle(self, line: usize) -> usize {
        self.moment(self.lines, 0) + line
    }

    fn motion(self, number: usize) -> usize {
        self.angle(self.lines) + number
    }

    fn len(self) -> usize {
        self.motion(self.motions)
    }
}

/// A linear problem and the lines whose states are given.
struct Small<'a, 'b> {
    lines: &'a [ContactLine<'b>],
    axes: &'a Axes<'a>,
    sought: &'a [Axis],
    places: Numbering,
    /// Coefficients of the slip that every line feels by the moments of every line, by the one that feels, by the moments.
    between: Vec<[[f64; POINTS]; POINTS]>,
}

impl LinearSolver {
    /// Solves a linear problem and gives the lines their forces and motions. With `given` tangential forces at the candidates
    /// of every line, pressures alone are sought, and of the motions the height.
    pub fn solve(
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
        let small = Small::new(lines, axes, &unknowns.axes);
        self.write(&small);
        let solution = self.solution().ok_or_else(singular)?;
        let felt: Vec<Felt> = (0..small.places.lines).map(|k| small.felt(k, &solution)).collect();
        let changes = &solution[small.places.motion(0)..];
        for ((own, line), felt) in self.lines.iter().zip(&mut *lines).zip(&felt) {
            line.state.forces.fill(0.0);
            for (&i, forces) in own.nodes.iter().zip(&own.forces) {
                let at = line.grid.component(i);
                let [tangential, normal] = forces.map(|force| force.iter().zip(felt).map(|(f, by)| f * by).sum::<f64>());
                (line.state.forces[at], line.state.forces[at + 1]) = (tangential, normal);
            }
        }
        unknowns.move_by(changes, lines, axes);
        Ok(())
    }

    /// Writes the small system.
    fn write(&mut self, small: &Small) {
        let (size, lines) = (small.places.len(), small.lines);
        self.rows.clear();
        self.rows.resize(size * size, 0.0);
        self.constants.clear();
        self.constants.resize(size, 0.0);
        for k in 0..ON_PORTS {
            self.rows[k * size + k] = 1.0;
        }
        for (k, (own, line)) in self.lines.iter().zip(lines).enumerate() {
            let (nodes, grid) = (&own.nodes, line.grid);
            for (port, factor) in (0..ON_PORTS).map(|port| (port, -line.problem.share)) {
                let value = |place: usize| grid.values[nodes[place] + grid.guard][port / 2];
                let sum = match port % 2 {
                    0 => own.sum(|place| [value(place), 0.0]),
                    _ => own.sum(|place| [0.0, value(place)]),
                };
                small.add(k, &sum, factor, row(&mut self.rows, &mut self.constants, port));
            }
            for n in 0..small.places.moments {
                let power = |place: usize| line.problem.patch.map_or(0.0, |patch| patch.powers(grid.x[nodes[place]])[n]);
                let at = small.places.moment(k, n);
                self.rows[at * size + at] = 1.0;
                let sum = own.sum(|place| [power(place), 0.0]);
                small.add(k, &sum, -1.0, row(&mut self.rows, &mut self.constants, at));
            }
            let rim = &line.iterate.rim;
            let own_angle = own.sum(|place| {
                let node = nodes[place] + grid.guard;
                [rim.tangential[node], rim.normal[node]]
            });
            let at = small.places.angle(k);
            small.add(k, &own_angle, -1.0, row(&mut self.rows, &mut self.constants, at));
            small.add_angle(k, row(&mut self.rows, &mut self.constants, at));
        }
        for (number, &axis) in small.sought.iter().enumerate() {
            let at = small.places.motion(number);
            small.add_balance(axis, &self.lines, row(&mut self.rows, &mut self.constants, at));
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
            units.iter_mut().zip(row).for_each(|(unit, value)| *unit = unit.max(value.abs() / largest));
        }
        units.iter_mut().for_each(|unit| *unit = if *unit > 0.0 { 1.0 / *unit } else { 1.0 });
        for row in rows.chunks_exact_mut(size) {
            row.iter_mut().zip(&*units).for_each(|(value, unit)| *value *= unit);
        }
        system.set(size, rows.chunks_exact(size));
        let mut solution: Vec<f64> = constants.iter().map(|constant| -constant).collect();
        (system.factorise() && system.solve_with(&mut solution)).then(|| {
            solution.iter_mut().zip(&*units).for_each(|(value, unit)| *value *= unit);
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
    fn new(lines: &'a [ContactLine<'b>], axes: &'a Axes<'a>, sought: &'a [Axis]) -> Self {
        let felt = lines.iter().all(|line| line.problem.patch.is_some());
        let places = Numbering { lines: lines.len(), moments: if felt { POINTS } else { 0 }, motions: sought.len() };
        let pairs = (0..lines.len()).flat_map(|at| (0..lines.len()).map(move |by| (at, by)));
        let between = pairs.filter_map(|(at, by)| lines[at].slip_by_moments(by)).collect();
        Self { lines, axes, sought, places, between }
    }

    /// Adds `factor` times an affine function of what line `k` feels to an equation.
    fn add(&self, k: usize, of: &Felt, factor: f64, (row, constant): SmallRow) {
        let (line, places) = (&self.lines[k], self.places);
        let bodies = &line.problem.bodies;
        *constant += factor * of[KNOWN];
        let relative = bodies.shared.relative;
        for (point, opened) in of[OPENED].iter().map(|opened| factor * opened).enumerate() {
            let at = 2 * point + 1;
            for (port, value) in row[..ON_PORTS].iter_mut().enumerate() {
                *value += opened * relative[(at, port)];
            }
            row[places.angle(k)] -= opened * line.grid.points.nodes()[point];
            for (number, &axis) in self.sought.iter().enumerate() {
                row[places.motion(number)] += opened * self.lifts(bodies, axis, at);
            }
        }
        row[..ON_PORTS].iter_mut().zip(&of[PORTS]).for_each(|(value, by)| *value += factor * by);
        row[places.angle(k)] += factor * of[ANGLE];
        for (number, by) in of[MOTIONS][..places.motions].iter().enumerate() {
            row[places.motion(number)] += factor * by;
        }
        for j in 0..if places.moments > 0 { places.lines } else { 0 } {
            let between = &self.between[k * places.lines + j];
            for (n, by_moment) in between.iter().enumerate() {
                let felt: f64 = of[FELT].iter().zip(by_moment).map(|(by, slip)| by * slip).sum();
                row[places.moment(j, n)] += factor * felt;
            }
        }
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
            row[self.places.motion(number)] -= by_motion(axis);
        }
    }

    /// Adds the balance of a sought motion, or rest where a brake holds it.
    fn add_balance(&self, axis: Axis, own: &[OwnForces], (row, constant): SmallRow) {
        let balance = self.axes.row(axis, self.lines);
        *constant += balance.constant + balance.motions.dot(self.lines[0].traction.rigid);
        row[..ON_PORTS].iter_mut().zip(balance.ports).for_each(|(value, by)| *value += by);
        for (number, &axis) in self.sought.iter().enumerate() {
            row[self.places.motion(number)] += balance.motions[axis];
        }
        if self.axes.holds(axis) {
            return;
        }
        for (k, (own, line)) in own.iter().zip(self.lines).enumerate() {
            let sum = own.sum(|place| line.pull_of_forces(axis, own.nodes[place]));
            self.add(k, &sum, line.problem.share, (&mut *row, &mut *constant));
        }
    }

    /// Numbers that line `k` feels in a solution.
    fn felt(&self, k: usize, solution: &[f64]) -> Felt {
        let (line, places, mut felt) = (&self.lines[k], self.places, [0.0; _]);
        let (ports, motions, angle) = (&solution[..ON_PORTS], &solution[places.motion(0)..], solution[places.angle(k)]);
        let bodies = &line.problem.bodies;
        felt[KNOWN] = 1.0;
        felt[PORTS].copy_from_slice(ports);
        felt[ANGLE] = angle;
        felt[MOTIONS][..motions.len()].copy_from_slice(motions);
        for (point, x) in line.grid.points.nodes().into_iter().enumerate() {
            let at = 2 * point + 1;
            let by_ports = ports.iter().enumerate().map(|(port, force)| bodies.shared.relative[(at, port)] * force);
            let lifts = self.sought.iter().zip(motions).map(|(&axis, motion)| motion * self.lifts(bodies, axis, at));
            felt[OPENED.start + point] = by_ports.sum::<f64>() + lifts.sum::<f64>() - x * angle;
        }
        for (moment, value) in solution[places.moment(0, 0)..places.angle(0)].iter().enumerate() {
            let (j, n) = (moment / POINTS, moment % POINTS);
            add(*value, &self.between[k * places.lines + j][n], &mut felt[FELT]);
        }
        felt
    }

    /// Gap that a motion opens at a normal port, per unit of the motion.
    fn lifts(&self, bodies: &SurfaceResponse, axis: Axis, port: usize) -> f64 {
        let rigid = if axis == Axis::Height { 1.0 } else { 0.0 };
        rigid + self.axes.gain(axis) * bodies.inertial[(port, axis.number())]
    }
}
