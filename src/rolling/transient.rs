//! One implicit step.

use super::control::{Drive, Inputs, Rotation, Translation, Vertical};
use super::state::{Audit, State};
use super::{Model, StepError, Workspace};
use crate::contact::{ContactProblem, RigidMotion, SurfaceResponse};
use crate::mechanics::response::Convection;
use crate::multistep::{History, formula, settled};

/// Jump of a driving force relative to the nominal load, or of the friction coefficient relative to itself, that
/// restarts the multistep formula.
const JUMP: f64 = 0.02;

impl Model {
    /// One implicit step `dt` to the given targets at its end.
    pub(super) fn step(
        &self,
        state: &State,
        inputs: &Inputs,
        target: &Drive,
        dt: f64,
        workspace: &mut Workspace,
    ) -> Result<State, StepError> {
        let width = self.config.model.contact_width;
        let thermal = state.thermal.as_ref();
        let load = [target.force / width, -target.load / width, target.moment / width];
        let free = [
            inputs.translation == Translation::Force,
            inputs.vertical == Vertical::Force,
            inputs.rotation == Rotation::Moment,
        ];
        let [free_v, free_y, free_r] = free;
        let jumped = self.jumped(state, &load, free, target.friction);
        let before = if jumped { 0.0 } else { state.last_step };
        let dt = settled(dt, before);
        let td = formula(&self.config.solver, dt, before);
        let operators = self.operators(td.a0, workspace)?;

        let predicted = |sample: &History, free: bool, target: f64| {
            if free { sample.now + dt * sample.rate } else { target }
        };
        let v = predicted(&state.velocity, free_v, target.velocity);
        let omega = predicted(&state.omega, free_r, target.omega);
        let ratio = if before > 0.0 { (dt / before).min(2.0) } else { 0.0 };
        let friction = self.friction(target.friction, v - self.grid.radius * omega, thermal, ratio);
        let stream_wheel = Convection { speed: omega, acceleration: state.omega.rate };
        let stream_rail = Convection { speed: v, acceleration: state.velocity.rate };
        let mut free_wheel = self.wheel.free(&operators.wheel, &state.wheel, &td, stream_wheel, &state.wheel);
        let mut free_rail = self.rail.free(&operators.rail, &state.rail, &td, stream_rail, &state.rail);

        let speed = |sample: &History, value: f64, free: bool, load: f64, k: usize| RigidMotion {
            value,
            prescribed: !free,
            gain: td.a0,
            offset: sample.offset(&td),
            inertia: self.inertia[k],
            load,
            momentum: free_wheel.momentum[k],
        };
        let hub_height = RigidMotion {
            value: if free_y { state.height.now } else { target.displacement },
            prescribed: !free_y,
            gain: td.a0 * td.a0,
            offset: td.a0 * state.height.offset(&td) + state.climb.offset(&td),
            inertia: self.inertia[1],
            load: load[1],
            momentum: free_wheel.momentum[1],
        };
        if let Some(thermal) = thermal {
            self.add_membrane(&mut free_wheel.surface, &operators.wheel.surface, &thermal.membrane[0]);
            self.add_membrane(&mut free_rail.surface, &operators.rail.surface, &thermal.membrane[1]);
        }
        let gap = self.thermal_gap(thermal);
        let slip_offset: Vec<f64> = state.shift.iter().map(|s| s.offset(&td)).collect();
        let problem = ContactProblem {
            grid: &self.grid,
            radius: self.grid.radius + thermal.map_or(0.0, |t| t.growth),
            wheel: SurfaceResponse { compliance: &operators.wheel.surface, free: &free_wheel.surface },
            rail: SurfaceResponse { compliance: &operators.rail.surface, free: &free_rail.surface },
            wheel_loads: &operators.wheel.loads,
            momentum: &operators.wheel.momentum,
            momentum_loads: &operators.wheel.momentum_loads,
            rigid: [
                speed(&state.velocity, v, free_v, load[0], 0),
                hub_height,
                speed(&state.omega, omega, free_r, load[2], 2),
            ],
            slip_gain: td.a0,
            slip_offset: &slip_offset,
            gap: &gap,
            friction,
            nominal_load: self.nominal_line_load(),
            edge_tolerance: 0.02,
        };
        let contact = problem.solve(&state.contact).map_err(|e| self.contact_failure(e, state.time, dt))?;

        let mut next = state.clone();
        next.velocity.push(&td, contact.rigid[0]);
        next.height.push(&td, contact.rigid[1]);
        next.climb.push(&td, next.height.rate);
        next.omega.push(&td, contact.rigid[2]);
        let acceleration = [next.velocity.rate, next.climb.rate, next.omega.rate];
        self.wheel.commit(&operators.wheel, &free_wheel, &contact.forces, acceleration, &td, &mut next.wheel);
        self.rail.commit(&operators.rail, &free_rail, &(-&contact.forces), [0.0; 3], &td, &mut next.rail);
        for (i, sample) in next.shift.iter_mut().enumerate() {
            let d = self.grid.dof(i);
            sample.push(&td, contact.wheel_surface[d] - contact.rail_surface[d]);
        }

        let force = contact.resultant(&self.grid);
        for k in 0..3 {
            let deformation: f64 = free_wheel.momentum[k]
                + (operators.wheel.momentum.row(k) * &contact.forces)[0]
                + (0..3).map(|l| operators.wheel.momentum_loads[(k, l)] * acceleration[l]).sum::<f64>();
            let reaction = self.inertia[k] * acceleration[k] + deformation - force[k];
            next.hub[k] = if free[k] { load[k] } else { reaction };
        }
        next.time += dt;
        next.distance += 0.5 * dt * (state.velocity.now + next.velocity.now);
        next.angle += 0.5 * dt * (state.omega.now + next.omega.now);
        next.friction = friction;
        next.prescribed = free.map(|free| !free);
        next.available_friction = target.friction;
        next.last_step = dt;
        next.restarted = before == 0.0;
        next.internal_steps += 1;
        next.iterations += contact.iterations as u64;
        next.contact = contact;

        // The formula gives every force an impulse, by which the momenta change; its work is that times the mean velocity.
        let (before, friction_power) = (&state.audit, next.contact.friction_power(&self.grid));
        let impulse = [0, 1, 2].map(|k| td.impulse(next.hub[k], state.hub[k], before.impulse[k]));
        let work: f64 = impulse.iter().zip(midway(state, &next)).map(|(j, v)| j * v).sum();
        let dissipated = td.impulse(friction_power, before.friction_power, before.dissipated);
        next.audit = Audit {
            initial_energy: before.initial_energy,
            energy: self.energy(&next),
            work: before.work + work,
            dissipation: before.dissipation + dissipated,
            throughput: before.throughput + work.abs(),
            friction_power,
            impulse,
            dissipated,
        };
        let motion = [next.velocity.now, next.height.now, next.omega.now];
        if !force.iter().chain(&motion).chain(&next.hub).all(|v| v.is_finite()) || !next.audit.energy.is_finite() {
            return Err(StepError::NotFinite { time: state.time, step: dt });
        }
        self.check_motion(motion)?;
        if let (Some(heat), Some(before)) = (&self.heat, thermal) {
            next.thermal = Some(self.step_heat(heat, before, &next, target.tread_heat, dt, workspace)?);
        }
        Ok(next)
    }

    /// Whether a driving force has jumped from what drove the hub in the last step, prescribed or reaction, or the
    /// friction coefficient; `acts`: which forces (x, y, moment) are prescribed now.
    fn jumped(&self, state: &State, load: &[f64; 3], acts: [bool; 3], friction: f64) -> bool {
        let limit = JUMP * self.nominal_line_load();
        let limits = [limit, limit, limit * self.grid.radius];
        let available = state.available_friction;
        (friction - available).abs() > JUMP * available.max(friction)
            || (0..3).any(|k| acts[k] && (load[k] - state.hub[k]).abs() > limits[k])
    }

    /// Kinetic and elastic energy [J/m].
    pub(super) fn energy(&self, state: &State) -> f64 {
        let velocity = [state.velocity.now, state.height.rate, state.omega.now];
        let rigid: f64 = (0..3).map(|k| 0.5 * self.inertia[k] * velocity[k] * velocity[k]).sum();
        let forces = &state.contact.forces;
        rigid
            + self.wheel.energy(&state.wheel, forces, velocity)
            + self.rail.energy(&state.rail, &(-forces), [0.0; 3])
            + self.kernel.energy(forces)
    }
}

/// Mean rigid velocities (V, U̇, Ω) over a step.
fn midway(state: &State, next: &State) -> [f64; 3] {
    let mean = |a: &History, b: &History| 0.5 * (a.now + b.now);
    [
        mean(&state.velocity, &next.velocity),
        0.5 * (state.height.rate + next.height.rate),
        mean(&state.omega, &next.omega),
    ]
}
