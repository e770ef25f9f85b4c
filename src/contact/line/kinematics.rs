//! Displacements, gaps and slips of a line under given forces and rigid motions.

use super::contact_line::{ContactLine, LineIterate};
use super::others::LineForces;
use super::rim::RimFrame;
use super::streamline::UpwindWeights;
use super::vectors::copy;
use crate::axes::PerAxis;
use crate::linalg::vectorised::add_columns;

impl ContactLine<'_> {
    /// Ports of the candidate nodes that an upwind difference at node `i` touches, with the weights of `∂u/∂x` [1/m].
    pub fn stencil(&self, i: usize, row: UpwindWeights, to_right: bool) -> [(usize, f64); 3] {
        let (port, step) = (self.grid.port(i) as isize, if to_right { 2 } else { -2 });
        let weights = row.stencil(to_right, self.grid.cells_beside(i, to_right));
        std::array::from_fn(|k| ((port + k as isize * step) as usize, weights[k]))
    }

    /// Upwind derivatives `∂û_x/∂x` of the surfaces of wheel and rail at candidate `i`.
    pub fn stretches(&self, i: usize, row: UpwindWeights, to_right: bool) -> [f64; 2] {
        let [wheel, rail] = &self.traction.surface;
        let stencil = self.stencil(i, row, to_right);
        let by_layer = stencil.iter().map(|(port, weight)| weight * self.moved_by_layer(*port)).sum::<f64>();
        let by_lines = self.stretch_by_lines(i) + 0.5 * by_layer;
        [
            stencil.iter().map(|(port, weight)| weight * self.frame.tangential(wheel, *port)).sum::<f64>() + by_lines,
            stencil.iter().map(|(port, weight)| weight * rail[*port]).sum::<f64>() - by_lines,
        ]
    }

    /// Centred derivatives `∂û_x/∂x` of the surfaces of wheel and rail at candidate `i`.
    fn centred_stretches(&self, i: usize) -> [f64; 2] {
        let port = self.grid.port(i);
        let [wheel, rail] = &self.traction.surface;
        let turned = self.frame.tangential(wheel, port + 2) - self.frame.tangential(wheel, port - 2);
        let by_layer = self.moved_by_layer(port + 2) - self.moved_by_layer(port - 2);
        let by_lines = self.stretch_by_lines(i) + 0.5 * by_layer / self.grid.span(i);
        [turned / self.grid.span(i) + by_lines, self.grid.slope(rail, i, 0) - by_lines]
    }

    /// Takes the rim angle that belongs to the surface displacements at hand.
    pub fn take_surface_angle(&mut self) {
        self.surface_angle = self.frame.angle_of(&self.traction.surface[0], &self.traction.port_forces);
    }

    /// Takes the rim angle as a function of the forces, about the present iterate.
    pub fn update_rim(&mut self) {
        let Self { frame, problem, given, traction, iterate, .. } = self;
        iterate.rim.update(frame, problem, &given.displacement[0], &traction.port_forces);
    }

    /// Displacements, exact (bilinear) slips and gaps of the present forces and rigid motions; `accelerations` are
    /// those rigid ones that were not known before, `None` the others.
    pub fn evaluate(&mut self, accelerations: PerAxis<Option<f64>>) {
        self.follow_forces(accelerations);
        self.take_surface_angle();
        self.frame.rim_angle = self.surface_angle;
        let (grid, problem) = (self.grid, self.problem);
        let (v, height) = (self.traction.rigid.travel, self.traction.rigid.height);
        let turning = self.spin_velocity() * problem.position;
        let (v_c, rim, to_right) =
            (problem.radius() * self.traction.rigid.rotation + turning, self.rim_velocity(), self.upstream_right());
        for i in 0..grid.len() {
            let port = grid.port(i);
            let [u_c, u_p] = &self.traction.surface;
            let excess = || self.traction.port_forces[port + 1] - self.given.strength.limit[i];
            self.iterate.overlap[i] = if self.state.yielded[i] { self.creep(i) * excess() } else { 0.0 };
            if self.state.status[i].is_active() {
                let relative = u_c[port] - u_p[port] + self.moved_by_lines(i) + self.moved_by_layer(port);
                let dynamic = problem.time.a0 * relative + self.given.slip_offset[i];
                let slip = |[d_c, d_p]: [f64; 2]| v * (1.0 + d_p) - v_c - rim * d_c + dynamic;
                let upwind = self.stretches(i, self.iterate.upwind.row(i), to_right);
                self.iterate.centred_slip[i] = slip(self.centred_stretches(i));
                (self.state.slip[i], self.state.gap[i]) = (slip(upwind), 0.0);
            } else {
                (self.state.slip[i], self.iterate.centred_slip[i]) = (0.0, 0.0);
                self.state.gap[i] = self.given.gap[i] + self.frame.normal(u_c, i) - u_p[port + 1] + height;
            }
        }
        if self.is_sideways() {
            self.evaluate_across();
        }
    }

    /// Displacements of the present forces, and the height that lever arms lack; `accelerations` as in [`Self::evaluate`].
    pub fn follow_forces(&mut self, accelerations: PerAxis<Option<f64>>) {
        self.displace(accelerations);
        self.lift();
    }

    /// Displacements of both surfaces, and the value of the affine rim angle.
    fn displace(&mut self, accelerations: PerAxis<Option<f64>>) {
        let Self { problem, given, traction, iterate, .. } = self;
        let LineIterate { others, rim, displaced, .. } = &mut **iterate;
        let bodies = &problem.bodies;
        let own = LineForces { contact: &traction.port_forces, pull: &given.layers.pull };
        let forces = others.mean(problem.share, own).contact.as_slice();
        let first = forces.iter().position(|force| *force != 0.0).unwrap_or(forces.len());
        let loaded = first..forces.iter().rposition(|force| *force != 0.0).map_or(first, |last| last + 1);
        for (body, sign) in [(0, 1.0), (1, -1.0)] {
            let surface = &mut traction.surface[body];
            copy(surface, &given.displacement[body]);
            let columns =
                &bodies.shared.compliance[body].as_slice()[loaded.start * surface.len()..loaded.end * surface.len()];
            add_columns(sign, columns, surface.len(), &forces[loaded.clone()], surface.as_mut_slice());
        }
        rim.value = rim.constant + rim.shared.iter().zip(forces).map(|(t, f)| t * f).sum::<f64>();
        if let Some(alone) = problem.alone() {
            let [forces, displaced] = displaced;
            for component in 0..2 {
                forces.clear();
                forces.extend(traction.port_forces.iter().skip(component).step_by(2));
                alone.displace(component, 0, forces, displaced);
                for (surface, sign) in traction.surface.iter_mut().zip([1.0, -1.0]) {
                    let nodes = surface.as_mut_slice().as_chunks_mut::<2>().0;
                    nodes.iter_mut().zip(&*displaced).for_each(|(node, moved)| node[component] += sign * moved);
                }
                if component == 0 {
                    rim.value += rim.alone.iter().zip(&*forces).map(|(t, f)| t * f).sum::<f64>();
                }
            }
        }
        for (axis, acceleration) in accelerations.iter() {
            let Some(acceleration) = acceleration else { continue };
            traction.surface[0].axpy(acceleration, &bodies.inertial.column(axis.number()), 1.0);
            rim.value += acceleration * rim.accelerations[axis];
        }
    }

    /// Takes the height that the flexibility of the line alone lacks in lever arms, see [`LineIterate::lift`].
    pub fn lift(&mut self) {
        let (grid, problem, load) = (self.grid, self.problem, self.load_of_all());
        let LineIterate { lift, displaced: [normal, displaced], .. } = &mut *self.iterate;
        lift.clear();
        let kernel = &problem.kernel;
        let Some(alone) = problem.alone().filter(|_| kernel.tangential != kernel.normal) else { return };
        lift.resize(grid.len(), problem.bodies.lift * load);
        let first = grid.port(0) / 2;
        normal.clear();
        normal.extend((0..grid.len()).map(|i| self.traction.port_forces[grid.port(i) + 1]));
        for (component, sign) in [(0, 1.0), (1, -1.0)] {
            alone.displace(component, first, normal, displaced);
            lift.iter_mut().zip(&displaced[first..]).for_each(|(lift, moved)| *lift += sign * moved);
        }
    }

    /// Lever arms about the hub centre of the tangential and the normal force at candidate `i` \[m].
    ///
    /// They are those of the *deformed* wheel: by Betti's theorem for a rotated load only these balance the power of
    /// hub, contact and friction. Derivation: `docs/theory/lever-arms.md`.
    pub fn lever_arms(&self, i: usize) -> [f64; 2] {
        let frame = RimFrame { rim_angle: self.surface_angle, ..self.frame };
        let (radius, grown) = (self.problem.radius(), self.problem.grown());
        let (u, port) = (&self.traction.surface[0], self.grid.port(i));
        let lift = self.iterate.lift.get(i).copied().unwrap_or(0.0);
        let along = grown * (self.grid.x[i] + frame.tangential(u, port)) + radius * self.slopes().arm(i);
        [radius - grown * frame.normal(u, i) - grown * lift, along]
    }

    /// Generalised contact forces on the wheel: force x, force y, forward moment about the hub centre.
    pub fn resultant(&self) -> PerAxis<f64> {
        let mut sum = PerAxis::default();
        for i in (0..self.grid.len()).filter(|&i| self.is_loaded(i)) {
            let (t, n) = (self.tangential(i), self.normal(i));
            let [arm_t, arm_n] = self.lever_arms(i);
            sum.travel += t + n * self.slopes().rail(i);
            sum.height += n;
            sum.rotation -= arm_t * t + arm_n * n;
        }
        sum.rotation -= self.problem.radius() * self.iterate.retarded.force.iter().sum::<f64>();
        sum.lateral = self.state.across.force.iter().sum();
        sum
    }
}
