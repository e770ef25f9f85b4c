//! Gap, slip and balances of momentum as rows of a linear system in contact forces and rigid motions.

use super::iterate::{Iterate, copy};
use super::streamline::Upwind;
use nalgebra::{DMatrix, DVector};

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
        let weights = row.stencil(to_right);
        std::array::from_fn(|k| ((port + k as isize * step) as usize, weights[k] / self.grid.spacing))
    }

    /// Upwind derivative `∂u_x/∂x` of a surface displacement at candidate `i`.
    fn stretch(&self, u: &DVector<f64>, i: usize, row: Upwind, to_right: bool) -> f64 {
        self.stencil(i, row, to_right).iter().map(|(port, weight)| weight * u[*port]).sum()
    }

    /// `g = 0` at a closed node; its force coefficients are the column of the relative compliance.
    pub(super) fn gap_row(&self, i: usize) -> (AffineRow, &[f64]) {
        let bodies = &self.problem.bodies;
        let port = self.grid.port(i) + 1;
        let mut rigid = [0.0, 1.0, 0.0];
        for (k, motion) in self.problem.rigid.iter().enumerate() {
            if motion.target().is_none() {
                rigid[k] += motion.gain * bodies.inertial[(port, k)];
            }
        }
        let [wheel, rail] = &self.scratch.known;
        let constant = self.scratch.gap[i] + wheel[port] - rail[port];
        (AffineRow { rigid, constant }, column(bodies.relative, port))
    }

    /// `s = 0` at a stuck node, linearised in V and Ω about the present iterate. Writes the force coefficients of the ports
    /// `window` to `forces`.
    pub(super) fn slip_row(&self, i: usize, window: std::ops::Range<usize>, forces: &mut [f64]) -> AffineRow {
        let problem = self.problem;
        let bodies = &problem.bodies;
        let to_right = problem.upstream_right(&self.traction.rigid);
        let port = self.grid.port(i);
        let (v, v_c) = (self.traction.rigid[0], problem.radius() * self.traction.rigid[2]);
        let gain = problem.time.a0;
        let [wheel, rail] = &self.scratch.known;
        let add = |forces: &mut [f64], factor: f64, matrix: &DMatrix<f64>, port: usize| {
            let source = &column(matrix, port)[window.clone()];
            forces[window.clone()].iter_mut().zip(source).for_each(|(f, c)| *f += factor * c);
        };
        forces[window.clone()].fill(0.0);
        add(forces, gain, bodies.relative, port);
        let mut inertial: [f64; 3] = std::array::from_fn(|k| gain * bodies.inertial[(port, k)]);
        let mut constant = gain * (wheel[port] - rail[port]) + self.scratch.slip_offset[i];
        let row = self.scratch.upwind[i];
        for (at, weight) in self.stencil(i, row, to_right) {
            add(forces, -v * weight, bodies.compliance[1], at);
            add(forces, -v_c * weight, bodies.compliance[0], at);
            for (k, load) in inertial.iter_mut().enumerate() {
                *load -= v_c * weight * bodies.inertial[(at, k)];
            }
            constant += weight * (v * rail[at] - v_c * wheel[at]);
        }
        let [stretch_wheel, stretch_rail] = [0, 1].map(|b| self.stretch(&self.traction.surface[b], i, row, to_right));
        let mut rigid = [1.0 + stretch_rail, 0.0, -problem.radius() * (1.0 + stretch_wheel)];
        constant += -v * stretch_rail + v_c * stretch_wheel;
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
                0 => forces[port] -= 1.0,
                1 => forces[port + 1] -= 1.0,
                _ => {
                    let [arm_t, arm_n] = self.lever_arms(i);
                    forces[port] += arm_t;
                    forces[port + 1] += arm_n;
                }
            }
        }
        let own = &self.problem.rigid[axis];
        let mut row = AffineRow { rigid: [0.0; 3], constant: own.momentum - load };
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
            let known = &mut self.scratch.known[body];
            copy(known, problem.bodies.free[body]);
            let membrane = problem.membrane[body];
            if membrane.x.is_empty() {
                continue;
            }
            let last = grid.len().saturating_sub(1);
            for i in 0..=last {
                let (before, after) = (grid.x[i.saturating_sub(1)], grid.x[(i + 1).min(last)]);
                let force = -0.5 * (membrane.at(after) - membrane.at(before));
                if force != 0.0 {
                    known.axpy(force, &problem.bodies.compliance[body].column(grid.port(i)), 1.0);
                }
            }
        }
        for (k, motion) in problem.rigid.iter().enumerate() {
            self.scratch.known[0].axpy(motion.known_acceleration(), &problem.bodies.inertial.column(k), 1.0);
        }
        self.scratch.gap.clear();
        self.scratch.gap.extend(grid.x.iter().map(|&x| problem.surfaces.gap(x, &problem.placement)));
        self.scratch.slip_offset.clear();
        self.scratch.slip_offset.extend(self.state.tangential_gap.iter().map(|h| h.offset(&problem.time)));
        self.scratch.row.resize(grid.ports(), 0.0);
        self.scratch.centred_slip.resize(grid.len(), 0.0);
    }

    /// Displacements, exact (bilinear) slips and gaps of the present forces and rigid values.
    pub(super) fn evaluate(&mut self) {
        let (grid, problem) = (self.grid, self.problem);
        let bodies = &problem.bodies;
        for (body, sign) in [(0, 1.0), (1, -1.0)] {
            let surface = &mut self.traction.surface[body];
            copy(surface, &self.scratch.known[body]);
            for (port, force) in self.traction.port_forces.iter().enumerate().filter(|(_, force)| **force != 0.0) {
                surface.axpy(sign * force, &bodies.compliance[body].column(port), 1.0);
            }
        }
        for (k, motion) in problem.rigid.iter().enumerate().filter(|(_, motion)| motion.target().is_none()) {
            let acceleration = motion.gain * self.traction.rigid[k];
            self.traction.surface[0].axpy(acceleration, &bodies.inertial.column(k), 1.0);
        }
        let [v, height, omega] = self.traction.rigid;
        let v_c = problem.radius() * omega;
        let to_right = problem.upstream_right(&self.traction.rigid);
        for i in 0..grid.len() {
            let port = grid.port(i);
            let [u_c, u_p] = &self.traction.surface;
            if self.state.status[i].is_active() {
                let dynamic = problem.time.a0 * (u_c[port] - u_p[port]) + self.scratch.slip_offset[i];
                let slip = |[d_c, d_p]: [f64; 2]| v * (1.0 + d_p) - v_c * (1.0 + d_c) + dynamic;
                let row = self.scratch.upwind[i];
                let centred = |u: &DVector<f64>| (u[port + 2] - u[port - 2]) / (2.0 * grid.spacing);
                let upwind = [u_c, u_p].map(|u| self.stretch(u, i, row, to_right));
                self.scratch.centred_slip[i] = slip([u_c, u_p].map(centred));
                (self.state.slip[i], self.state.gap[i]) = (slip(upwind), 0.0);
            } else {
                (self.state.slip[i], self.scratch.centred_slip[i]) = (0.0, 0.0);
                self.state.gap[i] = self.scratch.gap[i] + u_c[port + 1] - u_p[port + 1] + height;
            }
        }
    }
}

/// A column of a matrix; both are contiguous.
fn column(matrix: &DMatrix<f64>, j: usize) -> &[f64] {
    let n = matrix.nrows();
    &matrix.as_slice()[j * n..(j + 1) * n]
}
