//! One implicit step: predict → solve the contact → commit → audit → heat.

use super::audit;
use super::contact_step::ContactStep;
use super::control::{Drive, Inputs};
use super::error::StepError;
use super::flattening;
use super::line::Line;
use super::model::{RollingModel, Workspace};
use super::spreading;
use super::state::{Brake, Controlled, HubForces, Motion, State};
use super::thermal::{self, HeatStep, HeatSupply, ThermalLine, ThermalScratch};
use super::wear;
use super::wheelset::Pose;
use crate::axes::PerAxis;
use crate::config::Tuning;
use crate::contact::{AxisDrive, Friction, FrictionLaw, Heating};
use crate::mechanics::response::Convection;
use crate::multistep::{History, TimeDerivative, formula, position, settled};

/// How often a step is taken again with less friction where it leaves the contact hotter than molten steel can be. Each
/// time the share of friction on the hottest places falls to a quarter or less.
const COOLER: usize = 6;
/// Longest step that is taken again \[s]: longer ones are divided, so that friction can follow the temperature.
const LONGEST_AGAIN: f64 = 1e-3;

/// Share of friction that comes back where a film freezes for which a step is taken again \[1].
const FROZEN: f64 = 1e-3;

/// Largest change of the weights at the contact edges that counts as converged in a step [1].
const EDGE_TOLERANCE: f64 = 0.02;

/// Decisions of a step that are taken before anything is solved.
struct Plan {
    /// Length of the step [s].
    dt: f64,
    td: TimeDerivative,
    /// Time formula of the hub height.
    of_height: TimeDerivative,
    /// True if the time formula starts afresh.
    restarted: bool,
    /// Which motions are prescribed, and the forces whose impulses drive the others.
    drives: PerAxis<AxisDrive>,
    /// Forces that the inputs give at the end of the step, where they give any.
    given: PerAxis<AxisDrive>,
    /// Predicted V [m/s] and Ω [rad/s].
    speeds: [f64; 2],
    /// Friction of every line.
    friction: Vec<Friction>,
    /// Change of the contact force \[N/m], if it goes on as in the step before.
    rise: f64,
}

/// Demand that leads from one state to the next.
#[derive(Clone, Copy)]
pub struct Demand<'a> {
    /// Which partners are prescribed.
    pub inputs: &'a Inputs,
    /// Values of the inputs at the beginning of the step.
    pub begin: &'a Drive,
    /// Values of the inputs at the end of the step.
    pub target: &'a Drive,
    /// Tunable parameters.
    pub tuning: &'a Tuning,
    /// True if another internal step follows before a communication point.
    pub interim: bool,
    /// Length of the step before \[s]; 0: the time formula starts afresh.
    pub last_step: f64,
    /// Quantities at its beginning.
    pub before: Controlled,
}

/// Computes the state `next` one internal step of `dt` seconds after `state`, and tells whether it counts: not if the
/// judge refuses its motion, before its heat is computed. Then, and on error, `next` is meaningless. The control of the
/// step size and the counts of the communication step are left to [`super::substeps`].
pub fn step(
    model: &RollingModel,
    state: &State,
    demand: &Demand,
    dt: f64,
    judge: &mut dyn FnMut(&State) -> bool,
    workspace: &mut Workspace,
    next: &mut State,
) -> Result<bool, StepError> {
    let plan = Plan::new(model, state, demand, dt);
    let (before, eased) = (state, eased(state, plan.dt));
    let state = eased.as_deref().unwrap_or(state);
    if !attempt(model, state, demand, &plan, judge, workspace, next)? {
        return Ok(false);
    }
    let mut again: Option<Box<State>> = None;
    for _ in 0..COOLER {
        let short = plan.dt <= LONGEST_AGAIN * (1.0 + 1e-9);
        if !(short && overheats(model, state, next) || freezes(model, again.as_deref().unwrap_or(state), next)) {
            break;
        }
        let again = again.get_or_insert_with(|| boxed(state));
        for (line, found) in again.lines.iter_mut().zip(&next.lines) {
            if let (Some(thermal), Some(found)) = (&mut line.thermal, &found.thermal) {
                thermal.weakening.film.clone_from(&found.weakening.film);
            }
        }
        if !attempt(model, again, demand, &plan, judge, workspace, next)? {
            return Ok(false);
        }
    }
    audit::expand(before, next);
    Ok(true)
}

/// The state in which a step of `dt` seconds begins whose hot layers lag, if it is shorter than the last one.
fn eased(state: &State, dt: f64) -> Option<Box<State>> {
    let share = dt / state.clock.last_step;
    let lags = |line: &Line| line.deformation().lag > 0.0;
    if share > 1.0 - 1e-9 || !share.is_finite() || !state.lines.iter().any(lags) {
        return None;
    }
    let mut eased = boxed(state);
    eased.lines.iter_mut().filter_map(|line| line.thermal.as_mut()).for_each(|thermal| thermal.deformation.ease(share));
    Some(eased)
}

/// A copy on the heap: states are large, and hosts may have small stacks.
#[inline(never)]
fn boxed(state: &State) -> Box<State> {
    let mut copy = Box::<State>::default();
    (*copy).clone_from(state);
    copy
}

/// True if friction has heated the contact beyond what a molten film lets it: within a step the film is that of its
/// beginning. Where it has been beyond before, other heat is at work.
fn overheats(model: &RollingModel, state: &State, next: &State) -> bool {
    let Some(model) = &model.thermal else { return false };
    let [before, after] = [state, next].map(|state| model.reference() + state.largest(Line::hottest));
    after > before && after > model.frictionless() && before <= model.hottest()
}

/// True if the contact is solid everywhere at the end, but has gone without friction under the film with which `state` began.
fn freezes(model: &RollingModel, state: &State, next: &State) -> bool {
    let Some(thermal) = &model.thermal else { return false };
    let gains = |(before, after): (&Line, &Line)| {
        let (acted, found, traction) = (before.weakening(), after.weakening(), &after.contact.traction);
        let missed = traction.load_times(|x| (found.film_at(x) - acted.film_at(x)).max(0.0));
        !acted.film.is_empty() && missed > FROZEN * traction.resultant.height
    };
    let solid = thermal.reference() + next.largest(Line::hottest) <= model.config.material.solidus;
    solid && state.lines.iter().zip(&next.lines).any(gains)
}

/// Takes the step with the film of `state`, its heat only if the judge lets its motion pass; tells whether it does.
fn attempt(
    model: &RollingModel,
    state: &State,
    demand: &Demand,
    plan: &Plan,
    judge: &mut dyn FnMut(&State) -> bool,
    workspace: &mut Workspace,
    next: &mut State,
) -> Result<bool, StepError> {
    solve_and_commit(model, state, demand, plan, workspace, next)?;
    next.audit = audit::advance(model, &plan.td, state, next);
    next.audit.plastic += next.sum(|line| line.contact.traction.yielding.plastic_work);
    let numbers = [next.motion.values(), next.resultant(), next.hub.force].map(PerAxis::values);
    if !numbers.as_flattened().iter().chain([&next.audit.energy]).all(|v| v.is_finite()) {
        return Err(StepError::NotFinite { time: state.clock.time, step: plan.dt });
    }
    model.wheel.check_state(next)?;
    if !judge(next) {
        return Ok(false);
    }
    heat(model, state, demand, plan.dt, &mut workspace.heat, next)?;
    Ok(true)
}

/// The heat step of all lines.
fn heat(
    model: &RollingModel,
    state: &State,
    demand: &Demand,
    dt: f64,
    scratch: &mut ThermalScratch,
    next: &mut State,
) -> Result<(), StepError> {
    let step = heat_step(model, state, demand, dt, next);
    next.tread_point = demand.tuning.tread_point;
    let taken: Vec<_> = next.lines.iter_mut().map(|line| line.thermal.take().unwrap_or_default()).collect();
    if let Some(thermal) = &model.thermal {
        let lines = state.lines.iter().zip(&next.lines).zip(taken).filter_map(|((before, line), temperatures)| {
            let contact = thermal.contact(&model.contact, &line.contact, demand.target.temperature);
            Some(ThermalLine { before: before.thermal.as_ref()?, contact, thermal: temperatures })
        });
        let mut lines: Vec<_> = lines.collect();
        thermal.step(&mut lines, &next.motion, step, scratch)?;
        let found: Vec<_> = lines.into_iter().map(|line| line.thermal).collect();
        for (line, found) in next.lines.iter_mut().zip(found) {
            line.thermal = Some(found);
        }
    }
    spreading::spread(model, state, dt, next)?;
    thermal::share_growth(&mut next.lines);
    Ok(())
}

/// The heat step from a `state` to the `next` one, whose motion is known.
fn heat_step<'a>(model: &RollingModel, state: &State, demand: &Demand<'a>, dt: f64, next: &State) -> HeatStep<'a> {
    let brake_power = (next.audit.brake - state.audit.brake) / dt;
    let supply = HeatSupply { drive: demand.target, brake_power, narrowing: model.narrowing(next) };
    HeatStep { dt, interim: demand.interim, supply, criteria: thermal::criteria(demand.tuning) }
}

/// Adds the history of the material to the state `next` that the last [`step`], one of `dt` seconds, led to from `state`: once it
/// is known that it counts.
pub fn remember(
    model: &RollingModel,
    state: &State,
    demand: &Demand,
    dt: f64,
    workspace: &mut Workspace,
    next: &mut State,
) {
    let Some(thermal) = &model.thermal else { return };
    let step = heat_step(model, state, demand, dt, next);
    let lines =
        state.lines.iter().zip(&mut next.lines).filter_map(|(before, line)| {
            Some((before.thermal.as_ref()?, &line.contact.traction, line.thermal.as_mut()?))
        });
    thermal.remember(lines, &next.motion, step, &mut workspace.heat);
}

impl Plan {
    fn new(model: &RollingModel, state: &State, demand: &Demand, dt: f64) -> Self {
        let [begin, given] = [demand.begin, demand.target].map(|drive| model.wheel.drives(demand.inputs, drive));
        let available = demand.target.friction;
        let stopped = state.hub.brake.locked && state.motion.omega.before != 0.0;
        let jumped = stopped || model.contact.jumped(state, &begin, available);
        let before = if jumped { 0.0 } else { demand.last_step };
        let dt = settled(dt, before);
        let td = formula(dt, before);
        let drives = PerAxis::from_fn(|axis| match (begin[axis].loads(), given[axis].loads()) {
            (Some([from, brake_from]), Some([to, brake_to])) => {
                let [impulse, of_brake] = [from + to, brake_from + brake_to].map(|sum| 0.5 * dt * sum);
                // The impulse of the brake comes on top, up to its own: what is known of the past counts once.
                AxisDrive::of(td.force(impulse, state.hub.driving[axis], state.audit.impulse[axis]), td.a0 * of_brake)
            }
            _ => given[axis],
        });
        let of_height = match drives.height {
            AxisDrive::Prescribed { .. } => td,
            _ => position(&td, dt, before),
        };
        let speeds = model.wheel.predicted_speeds(&state.motion, &drives, dt);
        let ratio = if before > 0.0 { (dt / before).min(2.0) } else { 0.0 };
        let law = FrictionLaw::from(demand.tuning);
        let friction = state.lines.iter().map(|line| {
            let heating = line.thermal.as_ref().map_or(Heating::default(), |thermal| thermal.heating);
            let traction = &line.contact.traction;
            let before = &traction.friction;
            let rise = || model.thermal.as_ref().map_or(0.0, |thermal| thermal.warming.by_friction(traction, dt));
            let friction = Friction::remembering(law, available, heating, ratio, before.coefficient, rise);
            friction.after(dt, (before.coefficient, state.available_friction), before.slip_speed, heating)
        });
        let friction = friction.collect();
        let rise = ratio * (state.resultant().height - demand.before.forces.height);
        Self { rise, dt, td, of_height, restarted: before == 0.0, drives, given, speeds, friction }
    }
}

impl Plan {
    /// Forces on the hub after the step that ends with a `motion`, given those as the time formula takes them.
    fn hub(&self, model: &RollingModel, demand: &Demand, driving: PerAxis<f64>, motion: &Motion) -> HubForces {
        let Self { td, dt, drives, given, .. } = self;
        let brake = Brake::applied(given.rotation, drives.rotation, motion, driving.rotation, [td.a0, *dt]);
        let mut force = PerAxis::from_fn(|axis| given[axis].loads().map_or(driving[axis], |[load, _]| load));
        force.rotation += brake.moment;
        HubForces {
            force,
            driving,
            gravity: model.wheel.gravity(demand.target),
            brake,
            prescribed: drives.map(|drive| matches!(drive, AxisDrive::Prescribed { .. })),
        }
    }
}

/// Everything mechanical of a step but the energy balance.
fn solve_and_commit(
    model: &RollingModel,
    state: &State,
    demand: &Demand,
    plan: &Plan,
    workspace: &mut Workspace,
    next: &mut State,
) -> Result<(), StepError> {
    let Plan { dt, td, of_height, drives, speeds, .. } = plan;
    let operators = model.bodies.operators(td.a0, &mut workspace.operators)?;
    let streams = [
        Convection { speed: speeds[1], acceleration: state.motion.omega.rate },
        Convection { speed: speeds[0], acceleration: state.motion.velocity.rate },
    ];
    model.bodies.free_responses(&operators, state, td, streams, &mut workspace.free);
    let free = &workspace.free;
    let place = place(&state.motion, *speeds, *dt);
    let side = model.wheel.sideways.step(&state.motion.lateral, drives.lateral, td);
    let lateral = side.motion(state.resultant().lateral);
    let contact = ContactStep {
        operators: &operators,
        free,
        rigid: model.wheel.motions(&state.motion, drives, [td, of_height], *speeds, free[0].momentum, lateral),
        drift: model.wheel.wheelset.drift(demand.target),
        shift: demand.target.lateral,
        radius: model.wheel.wheelset.radius(demand.target.lateral),
        time: *td,
        duration: *dt,
        rise: plan.rise,
        place,
        elevation: demand.target.elevation,
        firm: 0.0,
        friction: &plan.friction,
        edge_tolerance: EDGE_TOLERANCE,
    };
    let solved = model.contact.solve(&contact, &state.lines, &mut next.lines, &mut workspace.contact);
    solved.map_err(|error| model.contact.failure(error, state.clock.time, *dt))?;

    let rigid = next.rigid();
    next.motion = moved(&state.motion, [td, of_height], rigid, *dt);
    next.motion.guide(&contact.drift, rigid, Pose::of(demand.target));
    let aside = side.advance(next.resultant().lateral, td, &mut next.motion.lateral);
    next.motion.aside = moved_by(state.motion.aside, &state.motion.lateral, next.motion.lateral.now, *dt);
    model.bodies.commit(&operators, free, next.motion.accelerations(), td, state, next);
    let mut driving = {
        let (forces, resultant) = (next.loads(0), next.resultant());
        model.wheel.hub_forces(drives, &next.motion, &operators.wheel, &free[0], &forces, resultant)
    };
    if let AxisDrive::Prescribed { .. } = drives.lateral {
        driving.lateral = aside;
    }
    next.hub = plan.hub(model, demand, driving, &next.motion);
    (next.elevation, next.available_friction) = (demand.target.elevation, demand.target.friction);
    (next.clock.time, next.clock.pending, next.clock.last_step) = (state.clock.time + dt, 0.0, *dt);
    flattening::indent(model, state, place, next);
    wear::wear(model, state, *dt, next);
    next.clock.restarted = plan.restarted;
    Ok(())
}

/// Distance and angle after a step of `dt` seconds that ends with the speeds V and Ω.
fn place(motion: &Motion, [travel, rotation]: [f64; 2], dt: f64) -> [f64; 2] {
    [moved_by(motion.distance, &motion.velocity, travel, dt), moved_by(motion.angle, &motion.omega, rotation, dt)]
}

/// Distance or angle after a step that ends with the speed `to`: the trapezoidal rule.
fn moved_by(place: f64, speed: &History, to: f64, dt: f64) -> f64 {
    place + 0.5 * dt * (speed.now + to)
}

/// Rigid motion but that to the side after a step of `dt` seconds that ends with the values `end`.
fn moved(motion: &Motion, [td, of_height]: [&TimeDerivative; 2], end: PerAxis<f64>, dt: f64) -> Motion {
    let mut next = *motion;
    next.distance = moved_by(motion.distance, &motion.velocity, end.travel, dt);
    next.angle = moved_by(motion.angle, &motion.omega, end.rotation, dt);
    next.velocity.push(td, end.travel);
    next.height.push(of_height, end.height);
    next.hub_velocity.push(td, next.height.rate);
    next.omega.push(td, end.rotation);
    next
}
