//! Gap and slip of a line as affine functions of contact forces, rigid motions and their accelerations.

use super::contact_line::ContactLine;
use crate::axes::{Axis, PerAxis};
use crate::contact::problem::Influence;
use crate::linalg::vectorised::vectorised;
use nalgebra::DMatrix;
use std::ops::Range;

/// An affine function without its coefficients of the port forces, which stand beside it.
#[derive(Clone, Copy, Debug, Default)]
pub struct AffineRow {
    /// Coefficients of the rigid motions.
    pub motions: PerAxis<f64>,
    /// Coefficients of their accelerations.
    pub accelerations: PerAxis<f64>,
    /// Constant; it contains the accelerations that are known.
    pub constant: f64,
}

/// Upwind difference of the slip at a candidate.
struct UpwindSlip {
    /// Its ports, with the weights of `∂u/∂x` [1/m].
    stencil: [(usize, f64); 3],
    /// Stretches of wheel and rail by it \[1].
    stretches: [f64; 2],
    /// Change of the slip with the rim angle [m/s/rad].
    by_angle: f64,
}

/// Kind of the equation of a node.
#[derive(Clone, Copy)]
pub enum NodeEquation {
    /// A closed node has no gap.
    Gap,
    /// A stuck node does not slip.
    Slip,
}

impl NodeEquation {
    /// Writes the change of the value at a candidate with the forces of a line, a `share` of which the bodies feel, at
    /// the ports `window` to `forces`: as far as the bodies are displaced.
    pub fn by_shared(self, line: &ContactLine, i: usize, share: f64, window: Range<usize>, forces: &mut [f64]) {
        match self {
            Self::Gap => line.gap_by_shared(i, share, window, forces),
            Self::Slip => line.slip_by_shared(i, share, window, forces),
        }
    }

    /// Adds to the coefficients of the line's own forces what only the line feels of them; returns the rest.
    pub fn add_own(self, line: &ContactLine, i: usize, window: Range<usize>, forces: &mut [f64]) -> AffineRow {
        match self {
            Self::Gap => line.add_gap(i, window, forces),
            Self::Slip => line.add_slip(i, window, forces),
        }
    }
}

impl ContactLine<'_> {
    /// Adds to the coefficients of the line's own forces in the gap `g` what only the line feels of them; returns the
    /// rest of the gap. Where a candidate yields above the force `Λ` it is `g + c (λ_n − Λ)` \[m].
    pub fn add_gap(&self, i: usize, window: Range<usize>, forces: &mut [f64]) -> AffineRow {
        let port = self.grid.port(i) + 1;
        self.add_alone(1, -self.grid.x[i], [(port, 2.0)], window, forces);
        let mut row = self.gap_terms(i);
        if self.state.yielded[i] {
            let creep = self.creep(i);
            forces[port] += creep;
            row.constant -= creep * self.given.strength.limit[i];
        }
        row
    }

    /// Writes the change of the gap at a candidate with the forces of a line, a `share` of which the bodies feel, at
    /// the ports `window` to `forces`: as far as the bodies are displaced.
    pub fn gap_by_shared(&self, i: usize, share: f64, window: Range<usize>, forces: &mut [f64]) {
        let (x, port) = (self.grid.x[i], self.grid.port(i) + 1);
        let compliance = column(self.problem.bodies.shared.relative, port)[window.clone()].iter();
        let both = compliance.zip(&self.iterate.rim.shared[window.clone()]);
        forces[window].iter_mut().zip(both).for_each(|(f, (c, t))| *f = share * (c - x * t));
    }

    /// Writes the change of the slip at a candidate with the forces of a line, a `share` of which the bodies feel, at
    /// the ports `window` to `forces`: as far as the bodies are displaced.
    pub fn slip_by_shared(&self, i: usize, share: f64, window: Range<usize>, forces: &mut [f64]) {
        let UpwindSlip { stencil, by_angle, .. } = self.upwind_slip(i);
        let (v, velocity, gain) = (self.traction.rigid.travel, self.rim_velocity(), self.problem.time.a0);
        let Influence { compliance, relative } = self.problem.bodies.shared;
        let of_node = |matrix, at: usize| &column(matrix, at)[window.clone()];
        let upstream = stencil.map(|(at, weight)| {
            let [wheel, rail] = compliance.map(|matrix| of_node(matrix, at));
            [(rail, -share * v * weight), (wheel, -share * velocity * weight)]
        });
        let [[a, b], [c, d], [e, f]] = upstream;
        let own = (of_node(relative, self.grid.port(i)), share * gain);
        let turned = (&self.iterate.rim.shared[window.clone()], share * by_angle);
        combine(&mut forces[window.clone()], [own, a, b, c, d, e, f, turned]);
    }

    /// Adds what the line alone feels of its forces at the ports `window`: displacement of a component at given ports
    /// times the factors beside them, and the rim angle times `turned`.
    fn add_alone<const N: usize>(
        &self,
        component: usize,
        turned: f64,
        ports: [(usize, f64); N],
        window: Range<usize>,
        forces: &mut [f64],
    ) {
        let Some(alone) = self.problem.alone() else { return };
        let first = window.start / 2;
        let nodes = forces[window].as_chunks_mut::<2>().0;
        let moved = alone.by_nodes(component, ports.map(|(port, factor)| (port / 2, factor)), first);
        for ((node, moved), by_force) in nodes.iter_mut().zip(moved).zip(&self.iterate.rim.alone[first..]) {
            node[component] += moved;
            node[0] += turned * by_force;
        }
    }

    /// The upwind difference of the slip at a candidate: a turn of the rim tilts the surface and slows the rim.
    fn upwind_slip(&self, i: usize) -> UpwindSlip {
        let (row, to_right) = (self.iterate.upwind.row(i), self.upstream_right());
        let (stencil, stretches) = (self.stencil(i, row, to_right), self.stretches(i, row, to_right));
        let height = |at: usize| self.frame.radius - self.frame.sagitta[at / 2];
        let tilt: f64 = stencil.iter().map(|(at, weight)| weight * height(*at)).sum();
        let by_angle = self.rim_velocity() * tilt + self.problem.radius() * self.problem.time.a0 * stretches[0];
        UpwindSlip { stencil, stretches, by_angle }
    }

    /// The gap at a candidate without that by contact forces and by the rim angle with them \[m].
    pub fn gap_terms(&self, i: usize) -> AffineRow {
        let (bodies, rim, x) = (&self.problem.bodies, &self.iterate.rim, self.grid.x[i]);
        let port = self.grid.port(i) + 1;
        let mut accelerations = bodies.inertial_at(port);
        accelerations.add(-x, rim.accelerations);
        let [wheel, rail] = &self.given.displacement;
        let constant = self.given.gap[i] + wheel[port] - x * rim.constant - rail[port];
        AffineRow { motions: PerAxis::unit(Axis::Height), accelerations, constant }
    }

    /// Adds to the coefficients of the line's own forces in the slip what only the line feels of them; returns the rest
    /// of the slip [m/s], linearised in V, Ω and the rim angle about the present iterate.
    pub fn add_slip(&self, i: usize, window: Range<usize>, forces: &mut [f64]) -> AffineRow {
        let problem = self.problem;
        let bodies = &problem.bodies;
        let port = self.grid.port(i);
        let (v, velocity) = (self.traction.rigid.travel, self.rim_velocity());
        let gain = problem.time.a0;
        let [wheel, rail] = &self.given.displacement;
        let mut accelerations = bodies.inertial_at(port).map(|by| gain * by);
        let mut constant = gain * (wheel[port] - rail[port]) + self.given.slip_offset[i];
        let UpwindSlip { stencil, stretches, by_angle } = self.upwind_slip(i);
        for (at, weight) in stencil {
            accelerations.add(-velocity * weight, bodies.inertial_at(at));
            constant += weight * (v * rail[at] - velocity * self.frame.tangential(wheel, at));
        }
        let [stretch_wheel, stretch_rail] = stretches;
        self.add_slip_of_layer(i, stencil, window.clone(), forces);
        let [a, b, c] = stencil.map(|(at, weight)| (at, -(v + velocity) * weight));
        self.add_alone(0, by_angle, [(port, 2.0 * gain), a, b, c], window.clone(), forces);
        self.add_slip_by(i, self, window, forces);
        let rim = &self.iterate.rim;
        accelerations.add(by_angle, rim.accelerations);
        constant += by_angle * (rim.constant - self.frame.rim_angle);
        let (travel, rotation) = (1.0 + stretch_rail, -problem.radius() * (1.0 + stretch_wheel));
        let mut motions = PerAxis { travel, rotation, ..PerAxis::default() };
        if self.is_sideways() {
            motions.add(-problem.position, PerAxis::from_fn(|axis| self.spin.by(axis)));
        }
        constant += -v * stretch_rail + problem.radius() * self.traction.rigid.rotation * stretch_wheel;
        AffineRow { motions, accelerations, constant }
    }
}

/// A column of a matrix; both are contiguous.
fn column(matrix: &DMatrix<f64>, j: usize) -> &[f64] {
    let n = matrix.nrows();
    &matrix.as_slice()[j * n..(j + 1) * n]
}

/// A multiple of values.
type Term<'a> = (&'a [f64], f64);

vectorised! {
    /// Writes the sum of all terms. All at once: passes over the memory, one for each, are what the contact on uneven
    /// surfaces waits for.
    fn combine<'a, S>(simd, sum: &'a mut [f64], terms: [Term<'a>; TERMS]) {
        let count = sum.len();
        let terms: [_; TERMS] = std::array::from_fn(|k| (S::as_simd_f64s(&terms[k].0[..count]), terms[k].1));
        let (sum, sum_rest) = S::as_mut_simd_f64s(sum);
        let many: [_; TERMS] = std::array::from_fn(|k| {
            let ((values, _), factor) = terms[k];
            (&values[..sum.len()], simd.splat_f64s(factor))
        });
        for (k, sum) in sum.iter_mut().enumerate() {
            let zero = simd.splat_f64s(0.0);
            *sum = many.iter().fold(zero, |sum, (values, factor)| simd.mul_add_e_f64s(*factor, values[k], sum));
        }
        for (k, sum) in sum_rest.iter_mut().enumerate() {
            *sum = terms.iter().map(|((_, rest), factor)| factor * rest[k]).sum();
        }
    }
}

/// Terms of the row of a stuck node.
const TERMS: usize = 8;
