//! Stationary rolling: the state in which nothing changes in the moving frame (`d_t = 0`).

use super::control::{Inputs, Rotation, Translation, Vertical, peripheral_velocity};
use super::state::{Audit, State};
use super::stepping::StepControl;
use super::thermal::ThermalState;
use super::{Model, StepError, Workspace};
use crate::analytic;
use crate::contact::{ContactError, ContactProblem, ContactSolution, RigidMotion, Status, SurfaceResponse};
use crate::mechanics;
use crate::mechanics::response::{BodyState, Convection};
use crate::multistep::{History, TimeDerivative};

/// Passes that bring in convective terms and the accelerations of unbalanced forces.
const MAX_PASSES: usize = 30;
/// Passes after which the feedback of the temperatures is averaged: friction that softens and swelling that lifts parts of
/// a very hot contact off make it go back and forth.
const PLAIN_PASSES: usize = 5;
/// Relative change of the nodal contact forces at which they are brought in.
const TOLERANCE: f64 = 1e-6;
/// Relative change of the contact force at which temperatures and friction are settled: further passes repeat rounding.
const THERMAL_TOLERANCE: f64 = 1e-9;
/// The same where averages are all there is.
const THERMAL_SCATTER: f64 = 1e-3;

impl Model {
    /// Stationary state for inputs. Velocities that are not prescribed start from `initial.velocity` and
    /// `initial.creepage`; an unbalanced force or moment shows as acceleration, with the deformation it causes.
    pub fn stationary(&self, inputs: &Inputs, workspace: &mut Workspace) -> Result<State, StepError> {
        inputs.validate()?;
        let mut state = self.stationary_contact(inputs, None, workspace)?;
        let Some(heat) = &self.heat else { return Ok(state) };
        let mut change = f64::INFINITY;
        for pass in 0..MAX_PASSES {
            let mut thermal = self.stationary_heat(heat, &state, inputs.at(0.0).tread_heat)?;
            if let (Some(before), Some(averaged)) = (&state.thermal, pass.checked_sub(PLAIN_PASSES)) {
                thermal.average(before, 1.0 / (averaged + 2) as f64);
            }
            let force = state.contact.resultant(&self.grid);
            state = self.stationary_contact(inputs, Some(thermal), workspace)?;
            let settled = state.contact.resultant(&self.grid);
            let scale = force[1].abs().max(1e-9 * self.nominal_line_load());
            change = (0..2).map(|k| (settled[k] - force[k]).abs()).fold(0.0, f64::max) / scale;
            if change <= THERMAL_TOLERANCE {
                break;
            }
        }
        let unsettled = StepError::NoEquilibrium("contact and temperatures do not settle");
        if change <= THERMAL_SCATTER { Ok(state) } else { Err(unsettled) }
    }

    /// Stationary contact at given temperatures.
    fn stationary_contact(
        &self,
        inputs: &Inputs,
        thermal: Option<ThermalState>,
        workspace: &mut Workspace,
    ) -> Result<State, StepError> {
        let width = self.config.model.contact_width;
        let drive = inputs.at(0.0);
        let initial = &self.config.initial;
        let prescribed_x = inputs.translation == Translation::Velocity;
        let prescribed_r = inputs.rotation == Rotation::Velocity;
        let velocity = if prescribed_x { drive.velocity } else { initial.velocity };
        let omega =
            if prescribed_r { drive.omega } else { peripheral_velocity(velocity, initial.creepage) / self.grid.radius };
        self.check_motion([velocity, 0.0, omega])?;
        let load = drive.load / width;
        let slip = velocity - self.grid.radius * omega;
        let friction = self.friction(drive.friction, slip, thermal.as_ref(), 0.0);
        if inputs.vertical == Vertical::Force && load <= 0.0 {
            return Err(StepError::NoEquilibrium("drive.load must be positive for a stationary start state"));
        }

        // Slip is a direction of motion: at standstill use the limit of slow forward rolling.
        let radius = self.grid.radius;
        let moving = velocity.abs() + (radius * omega).abs() > 1e-9;
        let (slip_v, slip_omega) =
            if moving { (velocity, omega) } else { (1.0, peripheral_velocity(1.0, initial.creepage) / radius) };

        let td = TimeDerivative::default();
        let operators = self.operators(0.0, workspace)?;
        let mut wheel = BodyState::zeros(self.wheel.state_len());
        let mut rail = BodyState::zeros(self.rail.state_len());
        let mut contact = self.hertzian_guess(load);
        let mut acceleration = [0.0; 3];
        let no_offset = vec![0.0; self.grid.len()];
        let gap = self.thermal_gap(thermal.as_ref());
        let mut hub = [0.0; 3];
        for pass in 0..MAX_PASSES {
            let stream_wheel = Convection { speed: omega, acceleration: acceleration[2] };
            let stream_rail = Convection { speed: velocity, acceleration: acceleration[0] };
            let mut free_wheel = self.wheel.free(&operators.wheel, &wheel, &td, stream_wheel, &wheel);
            let mut free_rail = self.rail.free(&operators.rail, &rail, &td, stream_rail, &rail);
            if let Some(thermal) = &thermal {
                self.add_membrane(&mut free_wheel.surface, &operators.wheel.surface, &thermal.membrane[0]);
                self.add_membrane(&mut free_rail.surface, &operators.rail.surface, &thermal.membrane[1]);
            }
            let vertical = RigidMotion {
                value: if inputs.vertical == Vertical::Displacement { drive.displacement } else { contact.rigid[1] },
                prescribed: inputs.vertical == Vertical::Displacement,
                load: -load,
                inertia: self.inertia[1],
                momentum: free_wheel.momentum[1],
                ..RigidMotion::default()
            };
            let fixed = |value, offset| RigidMotion { value, offset, prescribed: true, ..RigidMotion::default() };
            let problem = ContactProblem {
                grid: &self.grid,
                radius: self.grid.radius + thermal.as_ref().map_or(0.0, |t| t.growth),
                wheel: SurfaceResponse { compliance: &operators.wheel.surface, free: &free_wheel.surface },
                rail: SurfaceResponse { compliance: &operators.rail.surface, free: &free_rail.surface },
                wheel_loads: &operators.wheel.loads,
                momentum: &operators.wheel.momentum,
                momentum_loads: &operators.wheel.momentum_loads,
                rigid: [fixed(slip_v, acceleration[0]), vertical, fixed(slip_omega, acceleration[2])],
                slip_gain: 0.0,
                slip_offset: &no_offset,
                gap: &gap,
                friction,
                nominal_load: self.nominal_line_load(),
                edge_tolerance: 1e-5,
            };
            let solved = problem.solve(&contact).map_err(|e| self.contact_failure(e, 0.0, 0.0))?;
            let change = (&solved.forces - &contact.forces).amax();
            contact = solved;
            self.wheel.commit(&operators.wheel, &free_wheel, &contact.forces, acceleration, &td, &mut wheel);
            self.rail.commit(&operators.rail, &free_rail, &(-&contact.forces), [0.0; 3], &td, &mut rail);

            let force = contact.resultant(&self.grid);
            let scale = force[1].abs().max(1e-9 * self.nominal_line_load());
            let previous = acceleration;
            for (k, prescribed, external) in [(0, prescribed_x, drive.force), (2, prescribed_r, drive.moment)] {
                if prescribed {
                    hub[k] = -force[k];
                } else {
                    hub[k] = external / width;
                    acceleration[k] = (hub[k] + force[k]) / self.inertia[k];
                }
            }
            hub[1] = -force[1];
            let unsettled = (0..3).map(|k| (acceleration[k] - previous[k]).abs() * self.inertia[k]).fold(0.0, f64::max);
            if change <= TOLERANCE * scale && unsettled <= TOLERANCE * scale {
                break;
            }
            if pass + 1 == MAX_PASSES {
                let source = ContactError::NotConverged { iterations: MAX_PASSES };
                return Err(StepError::Contact { time: 0.0, step: 0.0, source });
            }
        }
        if !moving {
            contact.slip.fill(0.0);
            contact.centred_slip.fill(0.0);
        }
        contact.rigid = [velocity, contact.rigid[1], omega];
        let shift = (0..self.grid.len())
            .map(|i| self.grid.dof(i))
            .map(|d| History::constant(contact.wheel_surface[d] - contact.rail_surface[d]))
            .collect();
        let mut state = State {
            time: 0.0,
            pending: 0.0,
            distance: 0.0,
            angle: 0.0,
            velocity: History { rate: acceleration[0], ..History::constant(velocity) },
            omega: History { rate: acceleration[2], ..History::constant(omega) },
            height: History::constant(contact.rigid[1]),
            climb: History::default(),
            wheel,
            rail,
            shift,
            contact,
            thermal,
            hub,
            prescribed: [prescribed_x, inputs.vertical == Vertical::Displacement, prescribed_r],
            friction,
            available_friction: drive.friction,
            last_step: 0.0,
            restarted: true,
            control: StepControl { step: f64::INFINITY, before: [0.0; 3] },
            internal_steps: 0,
            iterations: 0,
            audit: Audit::default(),
        };
        state.control = StepControl::stationary(&state);
        state.audit.energy = self.energy(&state);
        state.audit.initial_energy = state.audit.energy;
        state.audit.friction_power = state.contact.friction_power(&self.grid);
        Ok(state)
    }

    /// Contact set of the Hertzian patch under a line load (the nominal load where none is given), all stuck.
    fn hertzian_guess(&self, load: f64) -> ContactSolution {
        let load = if load > 0.0 { load } else { self.nominal_line_load() };
        let half_width = analytic::hertz_half_width(load, self.grid.radius, mechanics::contact_modulus(&self.config));
        let mut guess = ContactSolution::open(&self.grid);
        for (status, x) in guess.status.iter_mut().zip(&self.grid.x) {
            if x.abs() < half_width.max(0.5 * self.grid.spacing) {
                *status = Status::Stick;
            }
        }
        guess
    }
}
