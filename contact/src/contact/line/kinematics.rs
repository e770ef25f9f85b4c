//! Displacements, gaps and slips of a line under given forces and rigid motions.

use super::alone::Alone;
use super::contact_line::{ContactLine, LineIterate};
use super::rim::RimFrame;
use super::streamline::UpwindWeights;
use super::vectors::copy;
use crate::axes::{Axis, PerAxis};
use crate::contact::kernel::LineKernel;

impl ContactLine<'_> {
    /// Ports of the candidate nodes that an upwind difference at node `i` touches, with the weights of `∂u/∂x` [1/m].
    pub fn stencil(&self, i: usize, row: UpwindWeights, to_right: bool) -> [(usize, f64); 3] {
        let (port, step) = (self.grid.component(i) as isize, if to_right { 2 } else { -2 });
        let weights = row.stencil(to_right, self.grid.cells_beside(i, to_right));
        std::array::from_fn(|k| ((port + k as isize * step) as usize, weights[k]))
    }

    /// Upwind derivatives `∂û_x/∂x` of the surfaces of wheel and rail at candidate `i`.
    pub fn stretches(&self, i: usize, row: UpwindWeights, to_right: bool) -> [f64; 2] {
        let [wheel, rail] = &self.state.surface;
        let stencil = self.stencil(i, row, to_right);
        let by_layer = stencil.iter().map(|(port, weight)| weight * self.moved_by_layer(*port)).sum::<f64>();
        let by_lines = 0.5 * self.stretch_by_lines(0, i) + 0.5 * by_layer;
        [
            stencil.iter().map(|(port, weight)| weight * self.frame.tangential(wheel, *port)).sum::<f64>() + by_lines,
            stencil.iter().map(|(port, weight)| weight * rail[*port]).sum::<f64>() - by_lines,
        ]
    }

    /// Centred derivatives `∂û_x/∂x` of the surfaces of wheel and rail at candidate `i`.
    fn centred_stretches(&self, i: usize) -> [f64; 2] {
        let port = self.grid.component(i);
        let [wheel, rail] = &self.state.surface;
        let turned = self.frame.tangential(wheel, port + 2) - self.frame.tangential(wheel, port - 2);
        let by_layer = self.moved_by_layer(port + 2) - self.moved_by_layer(port - 2);
        let by_lines = 0.5 * self.stretch_by_lines(0, i) + 0.5 * by_layer / self.grid.span(i);
        [turned / self.grid.span(i) + by_lines, self.grid.slope(rail, i, 0) - by_lines]
    }

    /// Takes the rim angle that belongs to the surface displacements at hand.
    pub fn take_surface_angle(&mut self) {
        self.surface_angle = self.frame.angle_of(&self.state.surface[0], &self.state.forces);
    }

    /// Takes the rim angle as a function of the forces, about the present iterate.
    pub fn update_rim(&mut self) {
        let Self { frame, problem, given, state, iterate, kernel, .. } = self;
        iterate.rim.update(frame, (problem, kernel), &given.displacement[0], &state.forces);
    }

    /// Displacements, exact (bilinear) slips and gaps of the present forces and rigid motions; `accelerations` are
    /// those rigid ones that were not known before, `None` the others.
    pub fn evaluate(&mut self, accelerations: PerAxis<Option<f64>>) {
        self.follow_forces(accelerations);
        self.take_surface_angle();
        self.frame.rim_angle = self.surface_angle;
        let (grid, problem) = (self.grid, self.problem);
        let (v, height) = (self.traction.rigid.travel, self.traction.rigid.height);
        let [along, _, spin] = self.drift.velocities(self.traction.rigid);
        let turning = spin * problem.position - along;
        let (v_c, rim, to_right) =
            (problem.radius() * self.traction.rigid.rotation + turning, self.rim_velocity(), self.upstream_right());
        for i in 0..grid.len() {
            let port = grid.component(i);
            let [u_c, u_p] = &self.state.surface;
            let excess = || self.state.forces[port + 1] - self.given.strength.limit[i];
            self.iterate.overlap[i] = if self.state.yielded[i] { self.creep(i) * excess() } else { 0.0 };
            if self.state.status[i].is_active() {
                let dynamic = problem.time.a0 * self.moved(0, i) + self.given.slip_offset[i];
                let slip = |[d_c, d_p]: [f64; 2]| v * (1.0 + d_p) - v_c - rim * d_c + dynamic;
                let upwind = self.stretches(i, self.iterate.upwind.row(i), to_right);
                self.iterate.centred_slip[0][i] = slip(self.centred_stretches(i));
                (self.state.slip[0][i], self.state.gap[i]) = (slip(upwind), 0.0);
            } else {
                (self.state.slip[0][i], self.iterate.centred_slip[0][i]) = (0.0, 0.0);
                self.state.gap[i] = self.given.gap[i] + self.frame.normal(u_c, i) - u_p[port + 1] + height;
            }
        }
        if self.state.directions() > 1 {
            self.evaluate_across();
        }
        self.draw();
    }

    /// Adds to the slips what the line is away from the shear to which it is drawn.
    fn draw(&mut self) {
        let Some(drawn) = &self.iterate.drawn else { return };
        for i in (0..self.grid.len()).filter(|&i| self.state.status[i].is_active()) {
            let slips = drawn.slip(i, self.shear(i));
            let slips = self.state.slip.iter_mut().zip(slips);
            slips.for_each(|(slip, drawn)| slip.get_mut(i).into_iter().for_each(|slip| *slip += drawn));
        }
    }

    /// Gaps at open candidates under the present displacements and weights of the rim angle.
    pub fn take_gaps(&mut self) {
        let [wheel, rail] = &self.state.surface;
        let (angle, height) = (self.iterate.rim.value, self.traction.rigid.height);
        for i in 0..self.grid.len() {
            let at = self.grid.component(i) + 1;
            let parted = self.given.gap[i] + wheel[at] - angle * self.grid.x[i] - rail[at] + height;
            self.state.gap[i] = if self.state.status[i].is_active() { 0.0 } else { parted };
        }
    }

    /// Displacements of the present forces, and the height that lever arms lack; `accelerations` as in [`Self::evaluate`].
    pub fn follow_forces(&mut self, accelerations: PerAxis<Option<f64>>) {
        self.displace(accelerations);
        self.lift();
    }

    /// Displacements of both surfaces, and the value of the affine rim angle.
    fn displace(&mut self, accelerations: PerAxis<Option<f64>>) {
        let Self { grid, problem, given, state, traction, iterate, kernel, .. } = self;
        let LineIterate { all, rim, own, moved, .. } = &mut **iterate;
        let bodies = &problem.bodies;
        rim.value = rim.constant + rim.by_ports.dot(&all.contact) + rim.by_own(grid, &state.forces);
        for (body, sign) in [(0, 1.0), (1, -1.0)] {
            let ports = &mut traction.surface[body];
            copy(ports, &given.ports[body]);
            ports.gemv(sign, bodies.shared.compliance[body], &all.contact, 1.0);
        }
        for (axis, acceleration) in accelerations.iter() {
            let Some(acceleration) = acceleration else { continue };
            traction.surface[0].axpy(acceleration, &bodies.inertial.column(axis.number()), 1.0);
            rim.value += acceleration * rim.accelerations[axis];
        }
        Alone { kernel: *kernel, grid }.find(state.forces.as_slice(), own);
        let [wheel, rail] = &mut state.surface;
        for (body, surface) in [&mut *wheel, &mut *rail].into_iter().enumerate() {
            copy(surface, &given.displacement[body]);
            // What is known of the ports is in the displacements of all nodes.
            copy(moved, &traction.surface[body]);
            *moved -= &given.ports[body];
            grid.add_expanded(moved, surface);
        }
        own.add_between([wheel, rail]);
    }

    /// Takes the height that the flexibility of the line alone lacks in lever arms, see [`LineIterate::lift`].
    pub fn lift(&mut self) {
        let (grid, load, LineKernel { tangential, normal, .. }) = (self.grid, self.load_of_all(), self.kernel);
        self.iterate.lift = [0.0; 2];
        if tangential == normal {
            return;
        }
        let carried: f64 = (0..grid.len()).map(|i| self.state.forces[grid.component(i) + 1]).sum();
        // The logarithms of the distances by normal forces displace the line along these already.
        self.iterate.lift = [
            tangential.factor * (tangential.reach - normal.reach) * carried + self.problem.bodies.lift * load,
            tangential.factor / normal.factor - 1.0,
        ];
    }

    /// Lever arms about the hub centre of the tangential and the normal force at candidate `i` \[m].
    ///
    /// They are those of the *deformed* wheel: by Betti's theorem for a rotated load only these balance the power of
    /// hub, contact and friction. Derivation: `docs/theory/lever-arms.md`.
    pub fn lever_arms(&self, i: usize) -> [f64; 2] {
        let frame = RimFrame { rim_angle: self.surface_angle, ..self.frame };
        let (radius, grown) = (self.problem.radius(), self.problem.grown());
        let (u, port) = (&self.state.surface[0], self.grid.component(i));
        let [constant, by_force] = self.iterate.lift;
        let lift = constant + by_force * self.iterate.own.along[port + 1];
        let along = grown * (self.grid.x[i] + frame.tangential(u, port)) + radius * self.slopes().arm(i);
        [radius - grown * frame.normal(u, i) - grown * lift, along]
    }

    /// Parts of the balance of an axis that a unit normal force and unit forces along and across at candidate `i` have, with
    /// the sign of inertia.
    pub fn pull_of_forces(&self, axis: Axis, i: usize) -> (f64, [f64; 2]) {
        match axis {
            Axis::Travel => (-self.slopes().rail(i), [-1.0, 0.0]),
            Axis::Height => (-1.0, [0.0, -self.drift.rise]),
            Axis::Rotation => {
                let [tangential, normal] = self.lever_arms(i);
                (normal, [tangential, 0.0])
            }
            Axis::Lateral => (0.0, [0.0, -1.0]),
        }
    }

    /// Generalised contact forces on the wheel: force x, force y, forward moment about the hub centre.
    pub fn resultant(&self) -> PerAxis<f64> {
        let mut sum = PerAxis::default();
        for i in self.loaded() {
            let (t, n) = (self.tangential(i), self.normal(i));
            let [arm_t, arm_n] = self.lever_arms(i);
            sum.travel += t + n * self.slopes().rail(i);
            sum.height += n;
            sum.rotation -= arm_t * t + arm_n * n;
        }
        sum.lateral = self.state.lateral.iter().sum();
        sum
    }
}
