//! Coupling of lines and free motions, as polynomials.
//!
//! The bodies pass on forces smoothly, so that slips by forces of other lines, slips by motions and parts in the balances
//! are taken at a few nodes and interpolated. What that leaves out comes back with the exact slips of the next turn.

use super::super::search::ActiveSet;
use crate::axes::{Axis, PerAxis};
use crate::contact::cone::{ByPolynomials, FreeMotion, Polynomials, TangentialCoupling};
use crate::contact::flexibility::{Between, ByMoments, ByPowers, slip_of_field};
use crate::contact::line::contact_line::ContactLine;
use crate::linalg::vectorised::dot;
use crate::linalg::{DenseSystem, POINTS};
use std::f64::consts::PI;

/// Least force by which balances are judged, over the nominal load \[1]: lines may carry nothing.
const LEAST_FRICTION: f64 = 1e-3;

/// Nodes of a line by whose values polynomials are found, and how they are.
struct Sampled {
    nodes: Vec<usize>,
    /// Coefficients of the polynomial by a unit value at each of the nodes.
    by_values: Vec<ByPowers>,
}

impl Sampled {
    /// Nodes next to Chebyshev's places on the line.
    fn new(line: &ContactLine) -> Self {
        let (x, half_length) = (&line.grid.x, line.problem.patch.map_or(1.0, |patch| patch.half_length));
        let places = (0..POINTS).map(|k| -half_length * libm::cos((k as f64 + 0.5) * PI / POINTS as f64));
        let mut nodes: Vec<usize> =
            places.map(|place| x.partition_point(|x| *x < place - 0.5 * line.grid.spacing).min(x.len() - 1)).collect();
        nodes.dedup();
        let count = nodes.len();
        let mut system = DenseSystem::default();
        system.reset(count);
        for (r, &i) in nodes.iter().enumerate() {
            let powers = line.problem.patch.map_or([0.0; POINTS], |patch| patch.powers(x[i]));
            system.row(r).0.copy_from_slice(&powers[..count]);
        }
        let mut by_values = vec![ByPowers::default(); count];
        if system.factorise() {
            for (node, by_value) in by_values.iter_mut().enumerate() {
                let mut values = vec![0.0; count];
                values[node] = 1.0;
                if system.solve_with(&mut values) {
                    by_value[..count].copy_from_slice(&values);
                }
            }
        }
        Self { nodes, by_values }
    }

    /// Coefficients of the polynomial with given values at the nodes.
    fn polynomial(&self, value: impl Fn(usize) -> f64) -> ByPowers {
        let mut sum = ByPowers::default();
        for (&node, by_value) in self.nodes.iter().zip(&self.by_values) {
            let value = value(node);
            sum.iter_mut().zip(by_value).for_each(|(sum, by)| *sum += value * by);
        }
        sum
    }
}

/// Smooth slips of a line and what it takes from motions.
struct SmoothSlips {
    sampled: Sampled,
    /// Slips along at the nodes by unit forces on the bodies at all ports, row by row [m/s/(N/m)].
    by_bodies: Vec<Vec<f64>>,
    /// Slips along by unit motions.
    by_motions: PerAxis<ByPowers>,
}

impl ActiveSet<'_> {
    /// Coupling of all lines and free motions in the present iterate, but for what their balances miss.
    pub fn coupling(&mut self) -> TangentialCoupling<2> {
        let smooth: Vec<_> = self.lines.iter().map(|line| self.smooth_slips(line)).collect();
        let axes: Vec<Axis> = self.free_axes().collect();
        TangentialCoupling {
            between: self.between(&smooth),
            motions: axes.into_iter().map(|axis| self.free_motion(axis, &smooth)).collect(),
            base: self.lines[0].traction.rigid,
            radius: self.lines[0].problem.radius(),
            shares: self.lines.iter().map(|line| line.problem.share).collect(),
            friction: 0.0,
        }
    }

    /// Axes along the surfaces whose motions are sought and not held by a brake.
    pub fn free_axes(&self) -> impl Iterator<Item = Axis> {
        Axis::along().filter(|axis| self.axes.seeks(*axis) && !self.axes.holds(*axis))
    }

    /// Takes present motions, friction and what balances miss without the present shear, which has these moments.
    pub fn take_balances(&mut self, coupling: &mut TangentialCoupling<2>, moments: &[Polynomials<2>]) {
        coupling.base = self.lines[0].traction.rigid;
        coupling.friction = self.friction_of_all().max(LEAST_FRICTION * self.problem.nominal_load);
        for motion in &mut coupling.motions {
            motion.missing = -self.residual(motion.axis) - motion.pulls(moments);
        }
    }

    /// Residual of the balance of a motion in the present iterate [N/m, N].
    fn residual(&mut self, axis: Axis) -> f64 {
        let Self { lines, axes, memory, .. } = self;
        let balance = axes.row(axis, lines, &mut memory.rows);
        let by_forces = |(line, row): (&ContactLine, &Vec<f64>)| dot(row, line.traction.port_forces.as_slice());
        let of_forces: f64 = lines.iter().zip(&memory.rows).map(by_forces).sum();
        balance.constant + balance.motions.dot(lines[0].traction.rigid) + of_forces
    }

    /// Force of friction that all lines together bear [N/m].
    fn friction_of_all(&self) -> f64 {
        let of_line = |line: &ContactLine| {
            (0..line.grid.len()).map(|i| line.friction(i) * line.normal(i).max(0.0)).sum::<f64>() * line.problem.share
        };
        self.lines.iter().map(of_line).sum()
    }

    fn smooth_slips(&self, line: &ContactLine) -> SmoothSlips {
        let sampled = Sampled::new(line);
        let all = 0..line.grid.ports();
        let by_bodies = |&i: &usize| {
            let mut forces = vec![0.0; line.grid.ports()];
            line.slip_by_shared(i, 1.0, all.clone(), &mut forces);
            forces
        };
        let equation = |i: usize| self.axes.equation(line.add_slip(i, 0..0, &mut [])).motions;
        let by_motions = PerAxis::from_fn(|axis| sampled.polynomial(|i| equation(i)[axis]));
        SmoothSlips { by_bodies: sampled.nodes.iter().map(by_bodies).collect(), by_motions, sampled }
    }

    /// Slips of every line by unit moments of every other one: through the bodies, and as lines of a patch. A line itself
    /// has what its lateral forces do along, and those along across.
    fn between(&self, smooth: &[SmoothSlips]) -> Vec<ByPolynomials<2>> {
        let count = self.lines.len();
        (0..count * count)
            .map(|pair| {
                let (at, by) = (pair / count, pair % count);
                let (line, other) = (&self.lines[at], &self.lines[by]);
                let mut slips = ByPolynomials::default();
                if at != by {
                    let by_bodies = through_bodies(line, &smooth[at], other, &smooth[by]);
                    add(&by_bodies, [0, 0], &mut slips);
                }
                let Some(patch) = line.problem.patch else { return slips };
                let rates = [line.problem.time.a0, line.traction.rigid.travel + line.rim_velocity()];
                let slip = |between: &Between| between.slips(slip_of_field(rates, patch.half_length));
                if at != by {
                    add(&slip(patch.flexibility.between(at, by)), [0, 0], &mut slips);
                }
                let Some([across, askew]) = patch.flexibility.across(at, by) else { return slips };
                if at != by {
                    add(&slip(across), [1, 1], &mut slips);
                }
                let askew = slip(askew);
                add(&askew, [0, 1], &mut slips);
                add(&askew, [1, 0], &mut slips);
                slips
            })
            .collect()
    }

    /// A motion that is free, about the present iterate.
    fn free_motion(&mut self, axis: Axis, smooth: &[SmoothSlips]) -> FreeMotion<2> {
        let Self { lines, axes, memory, problem, .. } = self;
        let resistance = axes.row(axis, lines, &mut memory.rows).motions;
        let pull = |((line, smooth), row): ((&ContactLine, &SmoothSlips), &Vec<f64>)| match axis {
            Axis::Lateral => [ByPowers::default(), first_two([line.problem.share, 0.0])],
            _ => [smooth.sampled.polynomial(|i| -row[line.grid.port(i)]), ByPowers::default()],
        };
        let slip = |(line, smooth): (&ContactLine, &SmoothSlips)| {
            let turned = problem.spin.by(axis) * line.problem.patch.map_or(0.0, |patch| patch.half_length);
            [smooth.by_motions[axis], first_two([if axis == Axis::Lateral { 1.0 } else { 0.0 }, turned])]
        };
        FreeMotion {
            axis,
            slips: lines.iter().zip(smooth).map(slip).collect(),
            pulls: lines.iter().zip(smooth).zip(&memory.rows).map(pull).collect(),
            resistance,
            missing: 0.0,
            drawn: [0.0; 2],
        }
    }
}

/// Polynomial of the first two coefficients.
fn first_two([first, second]: [f64; 2]) -> ByPowers {
    let mut polynomial = ByPowers::default();
    (polynomial[0], polynomial[1]) = (first, second);
    polynomial
}

/// Slips along of a line by unit moments of another one through the bodies.
fn through_bodies(line: &ContactLine, at: &SmoothSlips, other: &ContactLine, by: &SmoothSlips) -> ByMoments {
    let share = other.problem.share;
    let of_node = |row: &Vec<f64>| by.sampled.polynomial(|j| share * row[line.grid.port(j)]);
    let at_nodes: Vec<ByPowers> = at.by_bodies.iter().map(of_node).collect();
    std::array::from_fn(|moment| {
        let mut sum = ByPowers::default();
        for (values, by_value) in at_nodes.iter().zip(&at.sampled.by_values) {
            sum.iter_mut().zip(by_value).for_each(|(sum, by)| *sum += values[moment] * by);
        }
        sum
    })
}

/// Adds slips in a direction by moments of a direction, those along before those across.
fn add(by_moments: &ByMoments, [at, by]: [usize; 2], slips: &mut ByPolynomials<2>) {
    for (slips, by_moment) in slips[by].iter_mut().zip(by_moments) {
        slips[at].iter_mut().zip(by_moment).for_each(|(slip, by)| *slip += by);
    }
}
