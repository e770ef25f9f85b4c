//! Forces of one line as affine functions of what it feels of bodies, other lines and motions.
//!
//! Bodies and other lines displace a line as polynomials of the place, rim angle and motions as given functions of it. So a
//! line answers them by a few columns of forces around the factors of its own flexibility: that of the pressures at closed
//! nodes, and that of the shear at stuck ones, which pressures reach through friction at those that slip.

use super::axes::Axes;
use super::unknowns::LineUnknowns;
use crate::axes::Axis;
use crate::contact::flexibility::ByPowers;
use crate::contact::line::contact_line::ContactLine;
use crate::contact::line::rows::BodyRows;
use crate::linalg::{DenseSystem, POINTS};
use std::ops::Range;

/// Column of the forces that are known.
pub const KNOWN: usize = 0;
/// Columns by the gap that bodies and motions open at the points of the polynomial.
pub const OPENED: Range<usize> = 1..1 + POINTS;
/// Columns by the forces of all lines on the ports, as far as they make a line slip.
pub const PORTS: Range<usize> = OPENED.end..OPENED.end + 2 * POINTS;
/// Columns by the coefficients of the slip that the lines of the patch cause, by powers of the place.
pub const FELT: Range<usize> = PORTS.end..PORTS.end + POINTS;
/// Column by the rim angle, as far as it makes a line slip.
pub const ANGLE: usize = FELT.end;
/// Columns by the motions that are sought, as far as they make a line slip.
pub const MOTIONS: Range<usize> = ANGLE + 1..ANGLE + 1 + Axis::COUNT;
/// Columns, in whole registers.
pub const COLUMNS: usize = MOTIONS.end.next_multiple_of(4);
/// Columns of pressures: known ones and [`OPENED`], in whole registers.
const PRESSED: usize = OPENED.end.next_multiple_of(4);

/// Affine function of what a line feels, by columns.
pub type Felt = [f64; COLUMNS];

/// Forces of one line.
#[derive(Default)]
pub struct OwnForces {
    pressures: DenseSystem,
    shear: DenseSystem,
    /// Normal forces at the closed nodes.
    pressed: Vec<[[f64; PRESSED]; 1]>,
    /// Tangential forces at the stuck nodes.
    sheared: Vec<[[f64; COLUMNS]; 1]>,
    /// Closed nodes, then open ones with given tangential forces, and tangential and normal forces at all of them.
    pub nodes: Vec<usize>,
    pub forces: Vec<[Felt; 2]>,
    /// Places of the stuck nodes among the closed ones, and their equations by unit tangential forces at these.
    stuck: Vec<usize>,
    row: Vec<f64>,
}

/// Adds a multiple of an affine function.
pub fn add(factor: f64, of: &[f64], sum: &mut [f64]) {
    sum.iter_mut().zip(of).for_each(|(sum, value)| *sum += factor * value);
}

impl OwnForces {
    /// Takes the forces in given states; whether there are any that are finite. With `given` tangential forces at the
    /// candidates, only the pressures are unknown.
    pub fn find(
        &mut self,
        line: &ContactLine,
        unknowns: &LineUnknowns,
        axes: (&Axes, &[Axis]),
        given: Option<&[f64]>,
    ) -> bool {
        let bodies = line.body_rows();
        self.press(line, unknowns, (axes.0, &bodies)) && {
            let Self { pressed, nodes, forces, .. } = self;
            nodes.clone_from(&unknowns.closed);
            forces.clear();
            let of_node = |(k, pressed): (usize, &[[f64; PRESSED]; 1])| {
                let mut forces = [[0.0; COLUMNS]; 2];
                forces[1][..PRESSED].copy_from_slice(&pressed[0]);
                match given {
                    Some(given) => forces[0][KNOWN] = given[unknowns.closed[k]],
                    None => forces[0] = forces[1].map(|force| unknowns.friction[k] * force),
                }
                forces
            };
            forces.extend(pressed.iter().enumerate().map(of_node));
            for (i, force) in given.unwrap_or_default().iter().enumerate() {
                if *force != 0.0 && !line.state.status[i].is_active() {
                    let mut felt = [[0.0; COLUMNS]; 2];
                    felt[0][KNOWN] = *force;
                    nodes.push(i);
                    forces.push(felt);
                }
            }
            given.is_some() || unknowns.stuck.is_empty() || self.shear(line, unknowns, axes, &bodies)
        }
    }

    /// Takes the pressures that close the gap.
    fn press(&mut self, line: &ContactLine, unknowns: &LineUnknowns, (axes, bodies): (&Axes, &BodyRows)) -> bool {
        let Self { pressures, pressed, .. } = self;
        let (closed, along, grid) = (&unknowns.closed, line.kernel.normal, line.grid);
        pressures.reset(closed.len());
        pressed.clear();
        let nodes = grid.logarithms.nrows();
        for (k, &i) in closed.iter().enumerate() {
            let node = i + grid.guard;
            let logarithms = &grid.logarithms.as_slice()[node * nodes..][..nodes];
            let row = pressures.row(k).0;
            for (value, &j) in row.iter_mut().zip(closed) {
                *value = 2.0 * along.displacement(logarithms[j + grid.guard]);
            }
            let equation = axes.equation(line.gap_row(i, bodies));
            let mut sides = [0.0; PRESSED];
            sides[KNOWN] = -(equation.constant + equation.motions.dot(line.traction.rigid));
            sides[OPENED].iter_mut().zip(&grid.values[node]).for_each(|(side, value)| *side = -value);
            if line.state.yielded[i] {
                let creep = line.creep(i);
                row[k] += creep;
                sides[KNOWN] += creep * line.given.strength.limit[i];
            }
            pressed.push([sides]);
        }
        pressures.factorise() && pressures.solve_with_all(pressed)
    }

    /// Takes the shear that keeps stuck nodes from slipping.
    fn shear(
        &mut self,
        line: &ContactLine,
        unknowns: &LineUnknowns,
        (axes, sought): (&Axes, &[Axis]),
        bodies: &BodyRows,
    ) -> bool {
        let Self { shear, sheared, forces, stuck, row, .. } = self;
        let (closed, count) = (&unknowns.closed, unknowns.stuck.len());
        stuck.clear();
        stuck.extend(closed.iter().enumerate().filter(|(_, i)| line.state.status[**i].is_stuck()).map(|(k, _)| k));
        shear.reset(count);
        sheared.clear();
        for (r, &i) in unknowns.stuck.iter().enumerate() {
            let (affine, upwind) = line.slip_row(i, bodies);
            let equation = axes.equation(affine);
            let mut sides = [0.0; COLUMNS];
            sides[KNOWN] = -(equation.constant + equation.motions.dot(line.traction.rigid));
            sides[PORTS].iter_mut().zip(&affine.ports).for_each(|(side, by)| *side = -by);
            let powers = line.problem.patch.map_or(ByPowers::default(), |patch| patch.powers(line.grid.x[i]));
            sides[FELT].iter_mut().zip(&powers).for_each(|(side, power)| *side = -power);
            sides[ANGLE] = -affine.angle;
            sides[MOTIONS].iter_mut().zip(sought).for_each(|(side, &axis)| *side = -equation.motions[axis]);
            row.clear();
            row.resize(closed.len(), 0.0);
            line.slips_by_own(i, &upwind, closed, |place, slip| row[place] += slip);
            for (by, slip) in forces.iter().zip(&*row).filter(|(by, _)| by[0][KNOWN] != 0.0 || by[0][OPENED.start] != 0.0) {
                add(-slip, &by[0], &mut sides);
            }
            for (at, slip) in line.slips_by_pressure(&upwind) {
                if let Some(place) = closed.iter().position(|&j| line.grid.component(j) == at) {
                    add(-slip, &forces[place][1], &mut sides);
                }
            }
            shear.row(r).0.iter_mut().zip(&*stuck).for_each(|(value, &place)| *value = row[place]);
            sheared.push([sides]);
        }
        if !(shear.factorise() && shear.solve_with_all(sheared)) {
            return false;
        }
        stuck.iter().zip(&*sheared).for_each(|(&place, [sheared])| forces[place][0] = *sheared);
        true
    }

    /// Sum over the nodes of tangential and normal forces, times factors.
    pub fn sum(&self, factors: impl Fn(usize) -> [f64; 2]) -> Felt {
        let mut sum = [0.0; COLUMNS];
        for (k, [tangential, normal]) in self.forces.iter().enumerate() {
            let [of_tangential, of_normal] = factors(k);
            if of_tangential != 0.0 {
                add(of_tangential, tangential, &mut sum);
            }
            if of_normal != 0.0 {
                for (sum, force) in sum[..PRESSED].iter_mut().zip(normal) {
                    *sum += of_normal * force;
                }
            }
        }
        sum
    }
}
