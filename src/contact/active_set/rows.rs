//! Gap, slip and balances of momentum as rows of a linear system in contact forces and rigid motions.

use super::iterate::{ActiveSetScratch, Iterate, copy};
use crate::contact::line::observe;
use crate::contact::line::rim::RimFrame;
use crate::contact::line::slopes::Slopes;
use crate::contact::line::streamline::Upwind;
use crate::linalg::vectorised::{add_columns, vectorised};
use nalgebra::{DMatrix, DVector};
use std::ops::Range;

/// A row: coefficients of the rigid motions and the constant; those of the port forces come beside it.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct AffineRow {
    pub rigid: [f64; 3],
    pub constant: f64,
}

impl Iterate<'_> {
    /// Ports of the candidate nodes that an upwind difference at node `i` touches, with the weights of `∂u/∂x` [1/m].
    fn stencil(&self, i: usize, row: Upwind, to_right: bool) -> [(usize, f64); 3] {
        let (port, step) = (self.grid.port(i) as isize, if to_right { 2 } else { -2 });
        let weights = row.stencil(to_right, self.grid.cells_beside(i, to_right));
        std::array::from_fn(|k| ((port + k as isize * step) as usize, weights[k]))
    }

    /// Upwind derivatives `∂û_x/∂x` of the surfaces of wheel and rail at candidate `i`.
    fn stretches(&self, i: usize, row: Upwind, to_right: bool) -> [f64; 2] {
        let [wheel, rail] = &self.traction.surface;
        let stencil = self.stencil(i, row, to_right);
        [
            stencil.iter().map(|(port, weight)| weight * self.frame.tangential(wheel, *port)).sum(),
            stencil.iter().map(|(port, weight)| weight * rail[*port]).sum(),
        ]
    }

    /// Centred derivatives `∂û_x/∂x` of the surfaces of wheel and rail at candidate `i`.
    fn centred_stretches(&self, i: usize) -> [f64; 2] {
        let (port, length) = (self.grid.port(i), self.grid.span(i));
        let [wheel, rail] = &self.traction.surface;
        let turned = self.frame.tangential(wheel, port + 2) - self.frame.tangential(wheel, port - 2);
        [turned / length, (rail[port + 2] - rail[port - 2]) / length]
    }

    /// Writes the turn of the rim as an affine function of port forces and accelerations of the rigid motions to the scratch
    /// space: the mean of [`RimFrame::angle`](crate::contact::line::rim::RimFrame::angle) with the weights of the present iterate.
    pub(super) fn write_rim_angle(&mut self) {
        let (grid, bodies) = (self.grid, &self.problem.bodies);
        let mut turn = std::mem::take(&mut self.scratch.rim_angle);
        turn.forces.clear();
        turn.forces.resize(grid.ports(), 0.0);
        (turn.inertial, turn.known) = ([0.0; 3], 0.0);
        turn.weights.clear();
        let mut first = 0;
        for (port, weight) in self.frame.weights(&self.traction.port_forces) {
            if turn.weights.is_empty() {
                first = port;
            }
            // Nodes without force weigh nothing.
            turn.weights.resize((port - first) / 2, 0.0);
            turn.weights.push(weight);
            turn.inertial.iter_mut().enumerate().for_each(|(k, t)| *t += weight * bodies.inertial[(port, k)]);
            turn.known += weight * self.scratch.known[0][port];
        }
        // Every other column belongs to a normal force.
        let columns = &bodies.compliance[0].as_slice()[first * grid.ports()..];
        add_columns(1.0, columns, 2 * grid.ports(), &turn.weights, &mut turn.forces);
        self.scratch.rim_angle = turn;
    }

    /// `g = 0` at a closed node, `g + c (λ_n − Λ) = 0` at one that yields above the force `Λ`. Writes the force coefficients of the ports `window` to `forces`.
    pub(super) fn gap_row(&self, i: usize, window: Range<usize>, forces: &mut [f64]) -> AffineRow {
        let (turn, x, port) = (&self.scratch.rim_angle, self.grid.x[i], self.grid.port(i) + 1);
        let compliance =
            column(self.problem.bodies.relative, port)[window.clone()].iter().zip(&turn.forces[window.clone()]);
        forces[window].iter_mut().zip(compliance).for_each(|(f, (c, t))| *f = c - x * t);
        let mut row = self.gap_terms(i);
        if self.state.yielded[i] {
            let creep = self.creep(i);
            forces[port] += creep;
            row.constant -= creep * self.scratch.limit[i];
        }
        row
    }

    /// The gap at a node without that by contact forces and by the turn of the rim with them.
    pub(super) fn gap_terms(&self, i: usize) -> AffineRow {
        let (bodies, turn, x) = (&self.problem.bodies, &self.scratch.rim_angle, self.grid.x[i]);
        let port = self.grid.port(i) + 1;
        let mut rigid = [0.0, 1.0, 0.0];
        for (k, motion) in self.problem.rigid.iter().enumerate() {
            if motion.target().is_none() {
                rigid[k] += motion.gain * (bodies.inertial[(port, k)] - x * turn.inertial[k]);
            }
        }
        let [wheel, rail] = &self.scratch.known;
        let constant = self.scratch.gap[i] + wheel[port] - x * turn.known - rail[port];
        AffineRow { rigid, constant }
    }

    /// `s = 0` at a stuck node, linearised in V, Ω and the turn of the rim about the present iterate. Writes the force
    /// coefficients of the ports `window` to `forces`.
    pub(super) fn slip_row(&self, i: usize, window: Range<usize>, forces: &mut [f64]) -> AffineRow {
        let problem = self.problem;
        let bodies = &problem.bodies;
        let to_right = self.upstream_right();
        let port = self.grid.port(i);
        let (v, rim) = (self.traction.rigid[0], self.rim_velocity());
        let gain = problem.time.a0;
        let [wheel, rail] = &self.scratch.known;
        let mut inertial: [f64; 3] = std::array::from_fn(|k| gain * bodies.inertial[(port, k)]);
        let mut constant = gain * (wheel[port] - rail[port]) + self.scratch.slip_offset[i];
        let row = self.scratch.upwind[i];
        let stencil = self.stencil(i, row, to_right);
        for (at, weight) in stencil {
            for (k, load) in inertial.iter_mut().enumerate() {
                *load -= rim * weight * bodies.inertial[(at, k)];
            }
            constant += weight * (v * rail[at] - rim * self.frame.tangential(wheel, at));
        }
        let [stretch_wheel, stretch_rail] = self.stretches(i, row, to_right);
        // A turn of the rim tilts the surface and slows the rim.
        let height = |at: usize| self.frame.radius - self.frame.sagitta[at / 2];
        let tilt: f64 = stencil.iter().map(|(at, weight)| weight * height(*at)).sum();
        let by_turn = rim * tilt + problem.radius() * gain * stretch_wheel;
        let turn = &self.scratch.rim_angle;
        let of_node = |matrix, at: usize| &column(matrix, at)[window.clone()];
        let upstream = stencil.map(|(at, weight)| {
            let [wheel, rail] = bodies.compliance.map(|matrix| of_node(matrix, at));
            [(rail, -v * weight), (wheel, -rim * weight)]
        });
        let [[a, b], [c, d], [e, f]] = upstream;
        let own = (of_node(bodies.relative, port), gain);
        combine(&mut forces[window.clone()], [own, a, b, c, d, e, f, (&turn.forces[window.clone()], by_turn)]);
        inertial.iter_mut().zip(turn.inertial).for_each(|(load, t)| *load += by_turn * t);
        constant += by_turn * (turn.known - self.frame.rim_angle);
        let mut rigid = [1.0 + stretch_rail, 0.0, -problem.radius() * (1.0 + stretch_wheel)];
        constant += -v * stretch_rail + problem.radius() * self.traction.rigid[2] * stretch_wheel;
        for (k, motion) in problem.rigid.iter().enumerate() {
            if motion.target().is_none() {
                rigid[k] += motion.gain * inertial[k];
            }
        }
        AffineRow { rigid, constant }
    }

    /// Balance of momentum of an unknown rigid motion; lever arms are those of the present iterate. Writes the coefficients
    /// of all port forces to `forces`.
    pub(super) fn balance_row(&self, axis: usize, load: f64, forces: &mut [f64]) -> AffineRow {
        let (grid, bodies) = (self.grid, &self.problem.bodies);
        forces.iter_mut().zip(bodies.momentum.row(axis).iter()).for_each(|(f, m)| *f = *m);
        for i in 0..grid.len() {
            let port = grid.port(i);
            match axis {
                0 => {
                    forces[port] -= 1.0;
                    forces[port + 1] -= self.slopes().rail(i);
                }
                1 => forces[port + 1] -= 1.0,
                _ => {
                    let [arm_t, arm_n] = self.lever_arms(i);
                    forces[port] += arm_t;
                    forces[port + 1] += arm_n;
                }
            }
        }
        let own = &self.problem.rigid[axis];
        let late =
            if axis == 2 { self.problem.radius() * self.scratch.retarded.force.iter().sum::<f64>() } else { 0.0 };
        let mut row = AffineRow { rigid: [0.0; 3], constant: own.momentum - load + late };
        for (i, pull) in self.scratch.pull[0].iter().enumerate() {
            row.constant += bodies.momentum[(axis, grid.port(i))] * pull;
        }
        for (l, motion) in self.problem.rigid.iter().enumerate() {
            let inertia = bodies.deformation_inertia[(axis, l)] + if l == axis { own.inertia } else { 0.0 };
            row.constant += inertia * motion.known_acceleration();
            if motion.target().is_none() {
                row.rigid[l] = inertia * motion.gain;
            }
        }
        row
    }

    /// Displacements of both surfaces with zero contact forces and zero unknown motions, gaps and known slips, in the
    /// scratch space.
    pub(super) fn prepare(&mut self) {
        let (grid, problem) = (self.grid, self.problem);
        for body in 0..2 {
            copy(&mut self.scratch.known[body], problem.bodies.free[body]);
            self.warm(body);
        }
        for (k, motion) in problem.rigid.iter().enumerate() {
            self.scratch.known[0].axpy(motion.known_acceleration(), &problem.bodies.inertial.column(k), 1.0);
        }
        self.scratch.gap.clear();
        let swelling = &self.scratch.swelling;
        self.scratch.gap.extend(grid.x.iter().enumerate().map(|(i, &x)| {
            let swollen = |body: usize| swelling[body].get(i).copied().unwrap_or(0.0);
            problem.surfaces.round_gap(x, &problem.placement) - (swollen(0) + swollen(1))
        }));
        self.scratch.slip_offset.clear();
        self.scratch.slip_offset.extend(self.state.tangential_gap.iter().map(|h| h.offset(&problem.time)));
        self.scratch.row.resize(grid.ports(), 0.0);
        self.scratch.overlap.clear();
        self.scratch.overlap.resize(grid.len(), 0.0);
        self.find_strength();
        self.carve();
        self.scratch.centred_slip.resize(grid.len(), 0.0);
    }

    /// Adds what wheel and rail lack from circle and plane to the gap, and takes the slope of the rail.
    fn carve(&mut self) {
        let (grid, surfaces, placement) = (self.grid, self.problem.surfaces, &self.problem.placement);
        let ActiveSetScratch { gap, dents, depth, .. } = &mut *self.scratch;
        dents.clear();
        if !surfaces.is_uneven(placement) {
            return;
        }
        let around = &grid.nodes()[grid.guard - 1..=grid.guard + grid.len()];
        depth.clear();
        depth.extend(around.iter().map(|&x| surfaces.depth(x, placement)));
        gap.iter_mut().zip(&depth[1..]).for_each(|(gap, [wheel, rail])| *gap += wheel + rail);
        dents.extend((0..grid.len()).map(|i| (depth[i + 2][1] - depth[i][1]) / grid.span(i)));
    }

    /// Thermal displacement of one body: swelling at the candidates, and what the gradients of the membrane force cause.
    fn warm(&mut self, body: usize) {
        let (grid, problem) = (self.grid, self.problem);
        let (force, layer) = (problem.membrane[body], problem.placement.swelling[body]);
        let ActiveSetScratch { known, swelling, pull, along, membrane, .. } = &mut *self.scratch;
        let (known, swelling, membrane) = (&mut known[body], &mut swelling[body], &mut membrane[body]);
        let pull = &mut pull[body];
        pull.clear();
        swelling.clear();
        if !layer.is_empty() {
            layer.sample(&grid.x, swelling);
        }
        if force.is_empty() {
            *membrane = DVector::zeros(0);
            return;
        }
        copy(membrane, known);
        membrane.fill(0.0);
        force.sample(&grid.x, along);
        let last = grid.len().saturating_sub(1);
        for i in 0..=last {
            pull.push(-0.5 * (along[(i + 1).min(last)] - along[i.saturating_sub(1)]));
        }
        // Every other column belongs to a normal force.
        let columns = &problem.bodies.compliance[body].as_slice()[grid.port(0) * membrane.len()..];
        add_columns(1.0, columns, 2 * membrane.len(), pull, membrane.as_mut_slice());
        *known += &*membrane;
    }

    /// Displacements, exact (bilinear) slips and gaps of the present forces and rigid values.
    pub(super) fn evaluate(&mut self) {
        let (grid, problem) = (self.grid, self.problem);
        let bodies = &problem.bodies;
        let forces = self.traction.port_forces.as_slice();
        let first = forces.iter().position(|force| *force != 0.0).unwrap_or(forces.len());
        let loaded = first..forces.iter().rposition(|force| *force != 0.0).map_or(first, |last| last + 1);
        for (body, sign) in [(0, 1.0), (1, -1.0)] {
            let surface = &mut self.traction.surface[body];
            copy(surface, &self.scratch.known[body]);
            let columns = &bodies.compliance[body].as_slice()[loaded.start * surface.len()..loaded.end * surface.len()];
            add_columns(sign, columns, surface.len(), &forces[loaded.clone()], surface.as_mut_slice());
        }
        let turn = &mut self.scratch.rim_angle;
        turn.expected = turn.known;
        turn.expected += turn.forces.iter().zip(self.traction.port_forces.iter()).map(|(t, f)| t * f).sum::<f64>();
        for (k, motion) in problem.rigid.iter().enumerate().filter(|(_, motion)| motion.target().is_none()) {
            let acceleration = motion.gain * self.traction.rigid[k];
            self.traction.surface[0].axpy(acceleration, &bodies.inertial.column(k), 1.0);
            turn.expected += acceleration * turn.inertial[k];
        }
        self.surface_angle = self.frame.angle_of(&self.traction.surface[0], &self.traction.port_forces);
        self.frame.rim_angle = self.surface_angle;
        let [v, height, omega] = self.traction.rigid;
        let (v_c, rim, to_right) = (problem.radius() * omega, self.rim_velocity(), self.upstream_right());
        for i in 0..grid.len() {
            let port = grid.port(i);
            let [u_c, u_p] = &self.traction.surface;
            let excess = || self.traction.port_forces[port + 1] - self.scratch.limit[i];
            self.scratch.overlap[i] = if self.state.yielded[i] { self.creep(i) * excess() } else { 0.0 };
            if self.state.status[i].is_active() {
                let dynamic = problem.time.a0 * (u_c[port] - u_p[port]) + self.scratch.slip_offset[i];
                let slip = |[d_c, d_p]: [f64; 2]| v * (1.0 + d_p) - v_c - rim * d_c + dynamic;
                let upwind = self.stretches(i, self.scratch.upwind[i], to_right);
                self.scratch.centred_slip[i] = slip(self.centred_stretches(i));
                (self.state.slip[i], self.state.gap[i]) = (slip(upwind), 0.0);
            } else {
                (self.state.slip[i], self.scratch.centred_slip[i]) = (0.0, 0.0);
                self.state.gap[i] = self.scratch.gap[i] + self.frame.normal(u_c, i) - u_p[port + 1] + height;
            }
        }
    }

    /// Lever arms about the hub centre, see [`observe::lever_arms`] [m].
    fn lever_arms(&self, i: usize) -> [f64; 2] {
        let frame = RimFrame { rim_angle: self.surface_angle, ..self.frame };
        let wheel = (self.problem.radius(), &frame, &self.traction.surface[0]);
        observe::lever_arms(wheel, self.slopes(), i)
    }

    fn slopes(&self) -> Slopes<'_> {
        let ActiveSetScratch { overlap, dents, depth, .. } = &*self.scratch;
        Slopes { grid: self.grid, gap: &self.state.gap, overlap, dents, depth }
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
    /// Writes the sum of all terms. All at once: passes over the memory, one for each, are what the contact on uneven surfaces waits
    /// for.
    fn combine<'a, S>(simd, sum: &'a mut [f64], terms: [Term<'a>; TERMS]) {
        let count = sum.len();
        let terms = terms.map(|(values, factor)| (S::as_simd_f64s(&values[..count]), factor));
        let (sum, sum_rest) = S::as_mut_simd_f64s(sum);
        let many = terms.map(|((values, _), factor)| (&values[..sum.len()], simd.splat_f64s(factor)));
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
