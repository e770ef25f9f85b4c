//! Stationary rolling: the state in which nothing changes in the moving frame (`d_t = 0`).
//!
//! Contact forces, convective terms and the accelerations of unbalanced forces depend on each other; they are brought
//! together by passes of the linear contact problem at fixed temperatures ([`settle`]). Around them, temperatures and
//! contact follow each other until the forces no longer change ([`start`]).

use super::audit;
use super::contact_model::{ContactStep, friction_law};
use super::control::{Drive, Inputs, peripheral_velocity};
use super::error::StepError;
use super::model::{Model, Workspace};
use super::state::{Motion, State, ThermalState};
use super::substeps;
use crate::config::Tuning;
use crate::contact::{AxisDrive, ContactError, Friction, FrictionLaw, Heating, RigidMotion};
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
/// Largest change of the weights at the contact edges that counts as converged [1].
const EDGE_TOLERANCE: f64 = 1e-5;
/// Load relative to the nominal one below which forces do not count [1].
const SLIGHT: f64 = 1e-9;
/// Speed of both surfaces together below which the wheel stands [m/s].
const AT_REST: f64 = 1e-9;

/// Stationary state for inputs. Velocities that are not prescribed start from `initial.velocity` and
/// `initial.creepage`; an unbalanced force or moment shows as acceleration, with the deformation it causes.
pub fn start(model: &Model, tuning: &Tuning, inputs: &Inputs, workspace: &mut Workspace) -> Result<State, StepError> {
    inputs.validate()?;
    let mut goal = Goal::new(model, inputs)?;
    let mut state = settle(model, tuning, &goal, None, workspace)?;
    let Some(thermal) = &model.thermal else { return Ok(state) };
    let mut change = f64::INFINITY;
    for pass in 0..MAX_PASSES {
        let touch = thermal.touch(&model.contact, &state.contact.traction);
        let mut temperatures = thermal.stationary(&state, &touch, goal.drive.tread_heat)?;
        if let (Some(before), Some(averaged)) = (&state.thermal, pass.checked_sub(PLAIN_PASSES)) {
            thermal.average(&mut temperatures, before, 1.0 / (averaged + 2) as f64);
        }
        let force = state.contact.traction.resultant;
        goal.roll(model, temperatures.deformation.radius_growth);
        state = settle(model, tuning, &goal, Some(temperatures), workspace)?;
        let settled = state.contact.traction.resultant;
        change = (0..2).map(|k| (settled[k] - force[k]).abs()).fold(0.0, f64::max) / scale(model, settled);
        if change <= THERMAL_TOLERANCE {
            break;
        }
    }
    let unsettled = StepError::NoEquilibrium("contact and temperatures do not settle");
    if change <= THERMAL_SCATTER { Ok(state) } else { Err(unsettled) }
}

/// Contact force that changes are compared with [N/m].
fn scale(model: &Model, resultant: [f64; 3]) -> f64 {
    resultant[1].abs().max(SLIGHT * model.contact.nominal_line_load())
}

/// What the stationary state has to satisfy.
struct Goal {
    /// Values of the inputs.
    drive: Drive,
    drives: [AxisDrive; 3],
    /// V [m/s] and Ω [rad/s].
    velocity: f64,
    omega: f64,
    /// Creepage that gives Ω where it is not prescribed.
    creepage: Option<f64>,
    /// V and Ω where the wheel moves; at standstill, where slip is a direction of motion, those of slow forward rolling.
    slip_speeds: [f64; 2],
    moving: bool,
}

impl Goal {
    fn new(model: &Model, inputs: &Inputs) -> Result<Self, StepError> {
        let (drive, initial, radius) = (inputs.at(0.0), &model.config.initial, model.wheel.radius);
        let drives = model.wheel.drives(inputs, &drive);
        let prescribed = |k: usize| match drives[k] {
            AxisDrive::Prescribed { target } => Some(target),
            AxisDrive::Free { .. } => None,
        };
        let velocity = prescribed(0).unwrap_or(initial.velocity);
        let creepage = prescribed(2).is_none().then_some(initial.creepage);
        let omega = prescribed(2).unwrap_or(peripheral_velocity(velocity, initial.creepage) / radius);
        model.wheel.check([velocity, 0.0, omega])?;
        if prescribed(1).is_none() && drive.load <= 0.0 {
            return Err(StepError::NoEquilibrium("drive.load must be positive for a stationary start state"));
        }
        let moving = velocity.abs() + (radius * omega).abs() > AT_REST;
        let slow = [1.0, peripheral_velocity(1.0, initial.creepage) / radius];
        let slip_speeds = if moving { [velocity, omega] } else { slow };
        Ok(Self { drive, drives, velocity, omega, creepage, slip_speeds, moving })
    }

    /// Gives a wheel that has grown by `growth` \[m] the rotation that belongs to its creepage.
    fn roll(&mut self, model: &Model, growth: f64) {
        let Some(creepage) = self.creepage else { return };
        let radius = model.wheel.radius + growth;
        self.omega = peripheral_velocity(self.velocity, creepage) / radius;
        self.slip_speeds[1] = peripheral_velocity(self.slip_speeds[0], creepage) / radius;
    }

    /// The rigid motions of the contact problem at given accelerations: only the hub height can be unknown.
    fn motions(&self, model: &Model, acceleration: [f64; 3], height: f64, momentum: f64) -> [RigidMotion; 3] {
        let vertical = RigidMotion {
            drive: self.drives[1],
            guess: height,
            gain: 0.0,
            offset: 0.0,
            inertia: model.wheel.inertia[1],
            momentum,
        };
        let [v, omega] = self.slip_speeds;
        [RigidMotion::held(v, acceleration[0]), vertical, RigidMotion::held(omega, acceleration[2])]
    }
}

/// Stationary contact at given temperatures.
fn settle(
    model: &Model,
    tuning: &Tuning,
    goal: &Goal,
    thermal: Option<ThermalState>,
    workspace: &mut Workspace,
) -> Result<State, StepError> {
    let heating = thermal.as_ref().map_or(Heating::default(), |thermal| thermal.heating);
    // A wheel at rest does not slip, although its contact is that of slow rolling.
    let falling_ratio = if goal.moving { tuning.falling_ratio } else { 1.0 };
    let law = FrictionLaw { falling_ratio, ..friction_law(tuning) };
    let friction = Friction::local(law, goal.drive.friction, heating, 0.0);
    let load = goal.drive.load / model.wheel.width;
    let mut state = State {
        wheel: BodyState::zeros(model.bodies.wheel.state_len()),
        rail: BodyState::zeros(model.bodies.rail.state_len()),
        contact: model.contact.hertzian_guess(load),
        available_friction: goal.drive.friction,
        prescribed: goal.drives.map(|drive| matches!(drive, AxisDrive::Prescribed { .. })),
        restarted: true,
        thermal,
        ..State::default()
    };
    let mut next = state.clone();
    let mut accelerations = [0.0; 3];
    let mut settled = false;
    for _ in 0..MAX_PASSES {
        settled = pass(model, goal, friction, &state, &mut accelerations, workspace, &mut next)?;
        std::mem::swap(&mut state, &mut next);
        if settled {
            break;
        }
    }
    if !settled {
        let source = ContactError::NotConverged { iterations: MAX_PASSES };
        return Err(StepError::Contact { time: 0.0, step: 0.0, source });
    }
    Ok(complete(model, goal, accelerations, state))
}

/// One pass: contact at the present deformation and accelerations, then deformation and accelerations of its forces.
/// Returns whether nothing has changed.
fn pass(
    model: &Model,
    goal: &Goal,
    friction: Friction,
    state: &State,
    accelerations: &mut [f64; 3],
    workspace: &mut Workspace,
    next: &mut State,
) -> Result<bool, StepError> {
    let td = TimeDerivative::default();
    let operators = model.bodies.operators(td.a0, &*model.contact.solver, &mut workspace.operators)?;
    let streams = [
        Convection { speed: goal.omega, acceleration: accelerations[2] },
        Convection { speed: goal.velocity, acceleration: accelerations[0] },
    ];
    model.bodies.free_responses(&operators, state, &td, streams, &mut workspace.free);
    let free = &workspace.free;
    let height = state.contact.traction.rigid[1];
    let contact = ContactStep {
        operators: &operators,
        free,
        rigid: goal.motions(model, *accelerations, height, free[0].momentum[1]),
        time: td,
        duration: 0.0,
        place: [0.0; 2],
        deformation: state.deformation(),
        friction,
        edge_tolerance: EDGE_TOLERANCE,
    };
    let solved = model.contact.solve(&contact, &state.contact, &mut next.contact, &mut workspace.contact);
    solved.map_err(|error| model.contact.failure(error, 0.0, 0.0))?;
    model.bodies.commit(&operators, free, *accelerations, &td, state, next, &mut workspace.opposite);

    let resultant = next.contact.traction.resultant;
    let previous = *accelerations;
    for k in 0..3 {
        next.hub[k] = -resultant[k];
        if let (AxisDrive::Free { load }, true) = (goal.drives[k], k != 1) {
            next.hub[k] = load;
            accelerations[k] = (load + resultant[k]) / model.wheel.inertia[k];
        }
    }
    next.driving = next.hub;
    let unbalanced = |k: usize| (accelerations[k] - previous[k]).abs() * model.wheel.inertia[k];
    let (now, before) = (&next.contact.traction.port_forces, &state.contact.traction.port_forces);
    let change = now.iter().zip(before.iter()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    let tolerance = TOLERANCE * scale(model, resultant);
    Ok(change <= tolerance && (0..3).map(unbalanced).fold(0.0, f64::max) <= tolerance)
}

/// Everything of the state that follows from the settled contact.
fn complete(model: &Model, goal: &Goal, accelerations: [f64; 3], mut state: State) -> State {
    if !goal.moving {
        state.contact.rest();
    }
    let traction = &mut state.contact.traction;
    traction.rigid = [goal.velocity, traction.rigid[1], goal.omega];
    state.motion = Motion {
        velocity: History { rate: accelerations[0], ..History::constant(goal.velocity) },
        omega: History { rate: accelerations[2], ..History::constant(goal.omega) },
        height: History::constant(traction.rigid[1]),
        hub_velocity: History::default(),
    };
    state.control = substeps::unlimited(&state);
    state.friction_power = state.contact.traction.friction_power;
    state.audit = audit::start(model, &state);
    state
}
