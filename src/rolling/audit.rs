//! The energy balance: what the hub forces put in against what is stored, dissipated and radiated.
//!
//! Every force has the impulse that the time formula gives it (see [`crate::multistep::TimeDerivative::impulse`]), so
//! that all impulses add up to the change of momentum; the work of a force in a step is its impulse times the way over
//! the time: that of distance, angle and height as the outputs show them. The wheel that grows in a heat step lifts its
//! load, and its hot layers move the contact: work of the heat. Derivation: `docs/theory/lever-arms.md`.

use super::line::Line;
use super::model::RollingModel;
use super::state::{Audit, State};
use crate::axes::PerAxis;
use crate::multistep::TimeDerivative;
use crate::piecewise::Piecewise;

/// Kinetic and elastic energy of a state, with that of steel which yields and springs back [J/m].
pub fn energy(model: &RollingModel, state: &State) -> f64 {
    let velocities = state.motion.velocities();
    model.wheel.energy(velocities)
        + model.bodies.energy(state, velocities)
        + model.bodies.energy_of_contact(state)
        + state.sum(|line| line.contact.traction.yielding.springing_work)
}

/// Forces and moment on the wheel, by whoever holds it, that work on its [`drift`](super::state::Motion::drift), and what lifts it
/// along an inclined plane of contact, which works on its height [N/m and N].
pub fn drifting(state: &State) -> [f64; 4] {
    let PerAxis { travel, lateral, .. } = state.resultant();
    [-travel, -lateral, state.spin_moment(), state.motion.rise * lateral]
}

/// Balance at a stationary start.
pub fn start(model: &RollingModel, state: &State) -> Audit {
    let energy = energy(model, state);
    Audit { initial_energy: energy, energy, damping_power: model.bodies.dissipation(state), ..Audit::default() }
}

/// Balance after a step from `state` to `next`, whose motion, bodies, contact and hub forces are complete.
pub fn advance(model: &RollingModel, td: &TimeDerivative, state: &State, next: &State) -> Audit {
    let before = &state.audit;
    let impulse =
        PerAxis::from_fn(|axis| td.impulse(next.hub.driving[axis], state.hub.driving[axis], before.impulse[axis]));
    let (from, to) = (state.motion.velocities(), next.motion.velocities());
    let mut mean = PerAxis::from_fn(|axis| 0.5 * (from[axis] + to[axis]));
    if !next.hub.prescribed.height {
        mean.height = (next.motion.height.now - state.motion.height.now) / next.clock.last_step;
    }
    let [from, to] = [state, next].map(drifting);
    let drifting = std::array::from_fn(|k| td.impulse(to[k], from[k], before.drifting[k]));
    let [of_along, of_across, of_spin] = [0, 1, 2].map(|k| 0.5 * (state.motion.drift[k] + next.motion.drift[k]));
    let drifts = [of_along, of_across, of_spin, mean.height];
    let spinning = drifts.iter().zip(&drifting).map(|(velocity, impulse)| velocity * impulse).sum::<f64>();
    let work = impulse.dot(mean) + spinning;
    let forces = [state, next].map(|state| state.resultant().height);
    let damper = [state, next].map(|state| model.wheel.damper_force(state));
    let damper = td.impulse(damper[1], damper[0], before.damper);
    let damping_power = model.bodies.dissipation(next);
    let damped = td.impulse(damping_power, before.damping_power, before.damped);
    Audit {
        initial_energy: before.initial_energy,
        energy: energy(model, next),
        work: before.work + work,
        spinning: before.spinning + spinning,
        gravity: before.gravity
            + 0.5 * (next.clock.time - state.clock.time) * (state.hub.gravity + next.hub.gravity) * mean.travel,
        lift: before.lift + 0.5 * (next.elevation - state.elevation) * (forces[0] + forces[1]),
        brake: before.brake - next.hub.brake.impulse * mean.rotation,
        thermal_work: before.thermal_work,
        friction: before.friction + next.sum(|line| line.contact.traction.friction.work),
        plastic: before.plastic,
        damping: before.damping + damped + damper * mean.height,
        throughput: before.throughput + work.abs(),
        damping_power,
        impulse,
        drifting,
        pressed: td.impulse(forces[1], forces[0], before.pressed),
        damped,
        damper,
    }
}

/// Adds the work of heat in the step from `before` to `state`, whose heat step is done: the wheel that grows lifts its
/// load, and hot layers that swell and pull more than before move the surfaces under the contact.
pub fn expand(before: &State, state: &mut State) {
    let growth = (state.growth() - before.growth()) * state.resultant().height;
    let of_line =
        |(old, new): (&Line, &Line)| new.layout.share * (swelling_work(old, new) + new.contact.traction.pull_work);
    let layers: f64 = before.lines.iter().zip(&state.lines).map(of_line).sum();
    state.audit.thermal_work += growth + layers;
}

/// Work of the pressure on what the hot layers of a line swell in a step from `before` to `line` [J/m].
fn swelling_work(before: &Line, line: &Line) -> f64 {
    let layers = before.deformation().swelling.iter().zip(&line.deformation().swelling);
    let of_layer = |(old, new): (&Piecewise, &Piecewise)| {
        let (mut old, mut new) = (old.ascending(), new.ascending());
        line.contact.traction.load_times(|x| new(x) - old(x))
    };
    layers.map(of_layer).sum()
}
