//! Linear problem of given states.
//!
//! Bodies and lines pass on forces by moments with polynomials. So the forces of every line are found around its own factors
//! ([`super::own_forces`]), and the forces on the bodies' ports, the moments of all lines, their rim angles and the motions
//! that are sought follow from one small system: any number of lines costs as often as much as one.

use super::axes::Axes;
use super::own_forces::{ACROSS, ALONG, ANGLE, FELT, Felt, KNOWN, MOTIONS, OPENED, OwnForces, PORTS, add};
use super::unknowns::Unknowns;
use crate::axes::Axis;
use crate::contact::error::ContactError;
use crate::contact::flexibility::ByMoments;
use crate::contact::line::contact_line::ContactLine;
use crate::linalg::{DenseSystem, POINTS};

/// Forces on the ports.
const ON_PORTS: usize = 2 * POINTS;

/// Solution of linear problems, and its memory.
#[derive(Default)]
pub(super) struct LinearSolver {
    along: Solver<ALONG>,
    across: Solver<ACROSS>,
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
}

/// Solution of linear problems in which what a line feels has C columns.
#[derive(Default)]
struct Solver<const C: usize> {
    lines: Vec<OwnForces<C>>,
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
    /// Directions of the shear whose moments lines feel.
    directions: usize,
    motions: usize,
}

impl Numbering {
    fn moment(self, line: usize, direction: usize, k: usize) -> usize {
        ON_PORTS + (line * self.directions + direction) * POINTS + k
    }

    fn angle(self, line: usize) -> usize {
        self.moment(self.lines, 0, 0) + line
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
    /// Coefficients of the slip that every line feels in every direction by the moments of every line in every direction.
    between: Vec<ByMoments>,
    /// Gaps that unit forces on the ports open at the points, those that sought motions open, and the places of the points.
    by_ports: [[f64; ON_PORTS]; POINTS],
    by_motions: [[f64; Axis::COUNT]; POINTS],
    points: [f64; POINTS],
}

impl<const C: usize> Solver<C> {
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
        let small = Small::new(lines, axes, &unknowns.axes);
        self.write(&small);
        let solution = self.solution().ok_or_else(singular)?;
        let felt: Vec<Felt<C>> = (0..small.places.lines).map(|k| small.felt(k, &solution)).collect();
        let changes = &solution[small.places.motion(0)..];
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

    /// Writes the small system.
    #[inline(never)]
    fn write(&mut self, small: &Small) {
        let (size, lines) = (small.places.len(), small.lines);
        self.rows.clear();
        self.rows.resize(size * size, 0.0);
        self.constants.clear();
        self.constants.resize(size, 0.0);
        for k in 0..small.places.angle(0) {
            self.rows[k * size + k] = 1.0;
        }
        for (k, (own, line)) in self.lines.iter().zip(lines).enumerate() {
            let (nodes, grid) = (&own.nodes, line.grid);
            let at_points = |place: usize| grid.values[nodes[place] + grid.guard];
            let on_points = [own.sums_of_shear(0, at_points), own.sums_of_pressures(at_points)];
            for (component, sums) in on_points.iter().enumerate() {
                for (point, sum) in sums.iter().enumerate() {
                    let at = row(&mut self.rows, &mut self.constants, 2 * point + component);
                    small.add(k, sum, -line.problem.share, at);
                }
            }
            for direction in 0..small.places.directions {
                for (n, moment) in own.moments(direction).iter().enumerate() {
                    let at = small.places.moment(k, direction, n);
                    small.add(k, moment, -1.0, row(&mut self.rows, &mut self.constants, at));
                }
            }
            let rim = &line.iterate.rim;
            let own_angle = own.sum(|place| {
                let node = nodes[place] + grid.guard;
                (rim.normal[node], [rim.tangential[node], 0.0])
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
        let directions = if felt { lines[0].state.directions() } else { 0 };
        let places = Numbering { lines: lines.len(), directions, motions: sought.len() };
        let each = |at: usize| (0..directions).map(move |direction| (at, direction));
        let all = || (0..lines.len()).flat_map(each);
        let pairs = all().flat_map(|(at, of)| all().map(move |(by, other)| (at, of, by, other)));
        let between = pairs.filter_map(|(at, of, by, other)| lines[at].slip_by_moments(of, by, other)).collect();
        let (bodies, points) = (&lines[0].problem.bodies, lines[0].grid.points.nodes());
        let lifts = |axis: Axis, point: usize| {
            let rigid = if axis == Axis::Height { 1.0 } else { 0.0 };
            rigid + axes.gain(axis) * bodies.inertial[(2 * point + 1, axis.number())]
        };
        let by_ports = |point: usize| std::array::from_fn(|port| bodies.shared.relative[(2 * point + 1, port)]);
        let by_motions =
            |point: usize| std::array::from_fn(|number| sought.get(number).map_or(0.0, |axis| lifts(*axis, point)));
        let (by_ports, by_motions) = (std::array::from_fn(by_ports), std::array::from_fn(by_motions));
        Self { lines, axes, sought, places, between, by_ports, by_motions, points }
    }

    /// Adds `factor` times an affine function of what line `k` feels to an equation.
    fn add<const C: usize>(&self, k: usize, of: &Felt<C>, factor: f64, (row, constant): SmallRow) {
        let places = self.places;
        *constant += factor * of[KNOWN];
        for (point, opened) in of[OPENED].iter().map(|opened| factor * opened).enumerate() {
            add(opened, &self.by_ports[point], &mut row[..ON_PORTS]);
            row[places.angle(k)] -= opened * self.points[point];
            add(opened, &self.by_motions[point], &mut row[places.motion(0)..]);
        }
        add(factor, &of[PORTS], &mut row[..ON_PORTS]);
        row[places.angle(k)] += factor * of[ANGLE];
        add(factor, &of[MOTIONS], &mut row[places.motion(0)..]);
        for direction in 0..places.directions {
            let felt = &of[FELT[direction].clone()];
            for (at, between) in self.between_of(k, direction).as_flattened().iter().enumerate() {
                let by_moment: f64 = felt.iter().zip(between).map(|(by, slip)| by * slip).sum();
                row[places.moment(0, 0, 0) + at] += factor * by_moment;
            }
        }
    }

    /// Coefficients of the slip that line `k` feels in a direction, by the moments of all lines in all directions.
    fn between_of(&self, k: usize, direction: usize) -> &[ByMoments] {
        let Numbering { lines, directions, .. } = self.places;
        &self.between[(k * directions + direction) * lines * directions..][..lines * directions]
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
    fn add_balance<const C: usize>(&self, axis: Axis, own: &[OwnForces<C>], (row, constant): SmallRow) {
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
    fn felt<const C: usize>(&self, k: usize, solution: &[f64]) -> Felt<C> {
        let (places, mut felt) = (self.places, [0.0; C]);
        let (ports, motions, angle) = (&solution[..ON_PORTS], &solution[places.motion(0)..], solution[places.angle(k)]);
        felt[KNOWN] = 1.0;
        felt[PORTS].copy_from_slice(ports);
        felt[ANGLE] = angle;
        felt[MOTIONS][..motions.len()].copy_from_slice(motions);
        let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        for (point, x) in self.points.into_iter().enumerate() {
            let opened = product(&self.by_ports[point], ports) + product(&self.by_motions[point], motions);
            felt[OPENED.start + point] = opened - x * angle;
        }
        for direction in 0..places.directions {
            let moments = &solution[places.moment(0, 0, 0)..places.angle(0)];
            for (moment, by_moment) in moments.iter().zip(self.between_of(k, direction).as_flattened()) {
                add(*moment, by_moment, &mut felt[FELT[direction].clone()]);
            }
        }
        felt
    }
}
