//! The stationary contact at given temperatures.

use super::super::audit;
use super::super::contact_step::ContactStep;
use super::super::error::StepError;
use super::super::flattening;
use super::super::line::Line;
use super::super::model::{RollingModel, Workspace};
use super::super::state::{Brake, Clock, HubForces, Motion, Pressing, State};
use super::super::substeps;
use super::super::thermal;
use super::super::thermal_state::ThermalState;
use super::super::wheelset::Pose;
use super::goal::{Goal, Trial};
use crate::axes::{Axis, PerAxis};
use crate::config::Tuning;
use crate::contact::{
    ActiveSetScratch, AxisDrive, ContactError, ContactState, Drift, Friction, FrictionLaw, Heating, LineLayout,
};
use crate::mechanics::response::Convection;
use crate::multistep::{History, TimeDerivative};

/// Passes that bring in convective terms, creepage and accelerations.
const MAX_PASSES: usize = 30;
/// Relative change of the nodal contact forces at which they are brought in: derivatives by the inputs are differences
/// of such states.
const TOLERANCE: f64 = 1e-11;
/// Tolerance where rounding allows no more.
const ROUNDING: f64 = 1e-6;
/// Largest change of the weights at the contact edges that counts as converged [1].
const EDGE_TOLERANCE: f64 = 1e-5;
/// Load relative to the nominal one below which forces do not count [1].
const SLIGHT: f64 = 1e-9;
/// Share of what friction carries beyond which a contact that finds no state fails for want of adhesion.
const NEARLY_ALL: f64 = 0.99;

/// Factor by which the pressure under which very hot steel yields falls from one contact to the next \[1], where none was found
/// from that of cold steel.
const FALL: f64 = 0.8;
/// Such a factor at which the search for softer steel ends \[1].
const LEAST_FALL: f64 = 0.96;

/// Passes in which softer steel is sought.
const SOFTENED: usize = 2;

/// Smallest pressure under which the steel of a stationary contact yields, however hot it is \[Pa]. It is 0 unless no contact was
/// found then; if it stays above to the end, the first steps yield.
pub(super) type Firm = f64;

/// Contact force that changes are compared with [N/m].
pub(super) fn scale(model: &RollingModel, resultant: PerAxis<f64>) -> f64 {
    resultant.height.abs().max(SLIGHT * model.contact.nominal_line_load())
}

/// Stationary contact at the temperatures of the lines, from their contact on: that of cold steel where none is found in which very
/// hot steel yields.
pub(super) fn settle(
    model: &RollingModel,
    tuning: &Tuning,
    goal: &Goal,
    lines: Vec<Line>,
    firm: &mut Firm,
    workspace: &mut Workspace,
) -> Result<State, StepError> {
    let cold = model.contact.yield_pressure;
    match settle_yielding(model, tuning, goal, lines.clone(), firm, workspace) {
        Err(StepError::Contact { source: ContactError::NotConverged { .. }, .. })
            if *firm < cold && are_hot(&lines) =>
        {
            *firm = cold;
            settle_yielding(model, tuning, goal, lines, firm, workspace)
        }
        settled => settled,
    }
}

/// Stationary contact of steel that is no softer than `firm`.
fn settle_yielding(
    model: &RollingModel,
    tuning: &Tuning,
    goal: &Goal,
    lines: Vec<Line>,
    firm: &mut Firm,
    workspace: &mut Workspace,
) -> Result<State, StepError> {
    let [wheel, rail] = model.bodies.at_rest();
    let prescribed = goal.given.map(|drive| matches!(drive, AxisDrive::Prescribed { .. }));
    let mut state = State {
        clock: Clock { restarted: true, ..Clock::default() },
        hub: HubForces { prescribed, ..HubForces::default() },
        wheel,
        rail,
        lines,
        available_friction: goal.drive.friction,
        tread_point: tuning.tread_point,
        ..State::default()
    };
    let radius = model.rolling_radius(&state);
    let mut trial = goal.trial(radius);
    let friction = &friction(tuning, goal, &state);
    let mut next = state.clone();
    let mut change = f64::INFINITY;
    for number in 0..MAX_PASSES {
        // The first pass finds out where wheel and rail touch, and whether they do.
        let touching = number > 0 && state.resultant().height > 0.0;
        let pass = Pass { model, goal, friction, touching, softens: number < SOFTENED };
        let passed = pass.run(&state, &mut trial, firm, workspace, &mut next)?;
        // Convective terms come in with the second pass, and whether a speed is sought is decided there, too. A first one that
        // begins with the contact of a settled state finds the same forces without them.
        change = if number > 0 { passed } else { f64::INFINITY };
        std::mem::swap(&mut state, &mut next);
        if change <= TOLERANCE {
            break;
        }
    }
    if change > ROUNDING {
        let source = ContactError::NotConverged { iterations: MAX_PASSES };
        return Err(StepError::Contact { time: 0.0, step: 0.0, source });
    }
    goal.check(model, trial.speeds)?;
    Ok(complete(model, goal, &trial, state))
}

/// True if steel under one of the lines has softened.
fn are_hot(lines: &[Line]) -> bool {
    lines.iter().any(|line| !line.weakening().strength.is_empty())
}

/// Cold lines that touch and stick under about the load.
pub(super) fn lines(model: &RollingModel, goal: &Goal) -> Vec<Line> {
    let load = goal.drive.pressing() / model.wheel.width;
    let line = |_| Line {
        layout: LineLayout::default(),
        contact: ContactState::default(),
        flattening: flattening::none(model),
        worn: 0.0,
        thermal: None,
    };
    let mut lines: Vec<_> = (0..model.contact.patch.count).map(line).collect();
    model.contact.patch.at(goal.drive.lateral).lay_out(load * model.wheel.width, &mut lines);
    lines.iter_mut().for_each(|line| line.contact = model.contact.hertzian_guess(load, &line.layout));
    lines
}

/// Lines with the contact of other ones, which a settled contact at other temperatures is near, and with temperatures of
/// their own.
pub(super) fn heated(model: &RollingModel, lines: &[Line], temperatures: Vec<Option<ThermalState>>) -> Vec<Line> {
    let heated = |(line, thermal): (&Line, _)| Line { flattening: flattening::none(model), thermal, ..line.clone() };
    let mut lines: Vec<_> = lines.iter().zip(temperatures).map(heated).collect();
    thermal::share_growth(&mut lines);
    lines
}

/// Friction of every line at given temperatures. A wheel at rest does not slip, although its contact is that of slow
/// rolling.
fn friction(tuning: &Tuning, goal: &Goal, state: &State) -> Vec<Friction> {
    let law = FrictionLaw::from(tuning);
    let law = if goal.moving { law } else { law.at_rest() };
    let heating = |line: &Line| line.thermal.as_ref().map_or(Heating::default(), |thermal| thermal.heating);
    state.lines.iter().map(|line| Friction::local(law, goal.drive.friction, heating(line), 0.0)).collect()
}

/// One pass: contact at the present deformation and accelerations, then deformation and accelerations of its forces.
struct Pass<'a> {
    model: &'a RollingModel,
    goal: &'a Goal,
    /// Friction of every line.
    friction: &'a [Friction],
    /// True if wheel and rail touch, so that speeds can be sought.
    touching: bool,
    /// True if contacts of ever softer steel are sought where none yields at once.
    softens: bool,
}

impl Pass<'_> {
    /// Drift of the wheel at the contact. Surfaces that all stick, as they do at first, might lift a wheel off an inclined plane of
    /// contact with any force.
    fn drift(&self) -> Drift {
        let drift = self.goal.drift(self.model);
        if self.touching { drift } else { Drift { rise: 0.0, ..drift } }
    }

    /// Returns the change of the contact forces relative to the load.
    fn run(
        &self,
        state: &State,
        trial: &mut Trial,
        firm: &mut Firm,
        workspace: &mut Workspace,
        next: &mut State,
    ) -> Result<f64, StepError> {
        let (model, goal) = (self.model, self.goal);
        self.check_adhesion(state, trial, 1.0)?;
        let td = TimeDerivative::default();
        let operators = model.bodies.operators(td.a0, &mut workspace.operators)?;
        let [velocity, omega] = goal.actual(trial.speeds);
        let streams = [
            Convection { speed: omega, acceleration: trial.accelerations.rotation },
            Convection { speed: velocity, acceleration: trial.accelerations.travel },
        ];
        model.bodies.free_responses(&operators, state, &td, streams, &mut workspace.free);
        let free = &workspace.free;
        let contact = ContactStep {
            operators: &operators,
            free,
            rigid: goal.motions(model, trial, self.touching, state.rigid(), free[0].momentum),
            drift: self.drift(),
            shift: goal.drive.lateral,
            radius: model.wheel.wheelset.radius(goal.drive.lateral),
            time: td,
            duration: 0.0,
            rise: 0.0,
            place: [0.0; 2],
            elevation: goal.drive.elevation,
            firm: *firm,
            friction: self.friction,
            edge_tolerance: EDGE_TOLERANCE,
        };
        self.solve(contact, (state, trial), firm, &mut workspace.contact, next)?;
        let accelerations = trial.accelerations;
        model.bodies.commit(&operators, free, accelerations, &td, state, next);

        let resultant = next.resultant();
        let rigid = next.rigid();
        trial.speeds = [rigid.travel, rigid.rotation];
        trial.accelerations = goal.accelerations(model.wheel.inertia, trial.speeds, resultant);
        next.hub.force = PerAxis::from_fn(|axis| match goal.drives[axis] {
            AxisDrive::Free { load } if axis != Axis::Height => load,
            _ => -resultant[axis],
        });
        // What lifts the wheel along an inclined plane of contact carries a part of its load.
        next.hub.force.height -= goal.drift(model).rise * resultant.lateral;
        next.hub.driving = next.hub.force;
        let unbalanced =
            |axis: Axis| (trial.accelerations[axis] - accelerations[axis]).abs() * model.wheel.inertia[axis];
        let lines = next.lines.iter().zip(&state.lines).map(|(next, line)| {
            let (now, before) = (&next.contact.traction.port_forces, &line.contact.traction.port_forces);
            now.iter().zip(before.iter()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
        });
        let change = lines.fold(0.0, f64::max);
        Ok(Axis::ALL.into_iter().map(unbalanced).fold(change, f64::max) / scale(model, resultant))
    }

    /// Solves the contact; `contact` is its problem.
    fn solve(
        &self,
        contact: ContactStep,
        (state, trial): (&State, &Trial),
        firm: &mut Firm,
        scratch: &mut ActiveSetScratch,
        next: &mut State,
    ) -> Result<(), StepError> {
        let model = self.model;
        let mut solved = model.contact.solve(&contact, &state.lines, &mut next.lines, scratch);
        if let Err(ContactError::NotConverged { .. }) = solved
            && self.softens
            && *firm == 0.0
            && are_hot(&state.lines)
        {
            solved = self.soften(&contact, state, firm, scratch, &mut next.lines);
        }
        solved.map_err(|error| match self.check_adhesion(state, trial, NEARLY_ALL) {
            Err(beyond) if !matches!(error, ContactError::ZoneExceeded { .. }) => beyond,
            _ => model.contact.failure(error, 0.0, 0.0),
        })
    }

    /// Solves the contact of cold steel, and from there those of ever softer steel, as far as there are any.
    fn soften(
        &self,
        contact: &ContactStep,
        state: &State,
        firm: &mut Firm,
        scratch: &mut ActiveSetScratch,
        found: &mut Vec<Line>,
    ) -> Result<(), ContactError> {
        let model = &self.model.contact;
        *firm = model.yield_pressure;
        model.solve(&ContactStep { firm: *firm, ..*contact }, &state.lines, found, scratch)?;
        let warm = |found: &[Line]| -> Vec<Line> {
            let lines = found.iter().zip(&state.lines);
            lines.map(|(found, line)| Line { thermal: line.thermal.clone(), ..found.clone() }).collect()
        };
        let (mut softer, mut start) = (Vec::new(), warm(found));
        let (softest, mut fall) = (model.softest_steel(&start), FALL);
        while *firm > 0.0 && fall < LEAST_FALL {
            let next = if fall * *firm > softest { fall * *firm } else { 0.0 };
            match model.solve(&ContactStep { firm: next, ..*contact }, &start, &mut softer, scratch) {
                Ok(()) => {
                    *firm = next;
                    start = warm(&softer);
                    std::mem::swap(found, &mut softer);
                }
                Err(_) => fall = fall.sqrt(),
            }
        }
        Ok(())
    }

    /// Refuses a tangential force beyond a `share` of what friction carries.
    fn check_adhesion(&self, state: &State, trial: &Trial, share: f64) -> Result<(), StepError> {
        let width = self.model.wheel.width;
        let asked = self.goal.tangential_force(self.model.wheel.inertia, trial) * width;
        let load = state.resultant().height * width;
        let friction = state.friction();
        let carried = friction * load;
        let sought = self.touching && (self.goal.sought.is_some() || self.goal.seeks_aside);
        if !sought || asked.abs() < share * carried {
            return Ok(());
        }
        let demand = self.goal.demand(width);
        Err(StepError::BeyondAdhesion { demand, asked, carried, friction, load })
    }
}

/// Everything of the state that follows from the settled contact.
fn complete(model: &RollingModel, goal: &Goal, trial: &Trial, mut state: State) -> State {
    if !goal.moving {
        state.lines.iter_mut().for_each(|line| line.contact.rest());
    }
    let ([travel, rotation], accelerations) = (goal.actual(trial.speeds), trial.accelerations);
    let lateral = if goal.seeks_aside && goal.moving { state.rigid().lateral } else { goal.aside() };
    let rigid = PerAxis { travel, rotation, lateral, ..state.rigid() };
    state.lines.iter_mut().for_each(|line| line.contact.traction.rigid = rigid);
    state.motion = Motion {
        velocity: History { rate: accelerations.travel, ..History::constant(rigid.travel) },
        omega: History { rate: accelerations.rotation, ..History::constant(rigid.rotation) },
        height: History::constant(rigid.height),
        hub_velocity: History::default(),
        lateral: History { rate: accelerations.lateral, ..History::constant(rigid.lateral) },
        drift: goal.drift(model).velocities(rigid),
        rise: goal.drift(model).rise,
        pose: Pose::of(&goal.drive),
        ..state.motion
    };
    (state.hub.gravity, state.elevation) = (model.wheel.gravity(&goal.drive), goal.drive.elevation);
    state.hub.brake = Brake::stationary(goal.given.rotation, rotation, state.hub.force.rotation);
    let moment = &mut state.hub.force.rotation;
    *moment = goal.given.rotation.loads().map_or(*moment, |[load, _]| load + state.hub.brake.moment);
    state.hub.driving = state.hub.force;
    state.clock.control = substeps::unlimited(model, &state);
    state.friction_power = state.sum(|line| line.contact.traction.friction.power);
    state.audit = audit::start(model, &state);
    state.pressing = Pressing::constant(state.resultant().height);
    state
}
