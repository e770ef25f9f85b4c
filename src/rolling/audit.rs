//! The energy balance: what the hub forces put in against what is stored, dissipated and radiated.
//!
//! Every force has the impulse that the time formula gives it (see [`crate::multistep::TimeDerivative::impulse`]), so
//! that all impulses add up to the change of momentum; the work of a force in a step is its impulse times the mean
//! velocity. Derivation: `docs/theory/lever-arms.md`.

use super::model::Model;
use super::state::{Audit, State};
use crate::multistep::TimeDerivative;

/// Kinetic and elastic energy of a state [J/m].
pub fn energy(model: &Model, state: &State) -> f64 {
    let velocities = state.motion.velocities();
    model.wheel.energy(velocities)
        + model.bodies.energy(state, velocities)
        + model.bodies.correction_energy(&*model.contact.solver, &state.contact.traction)
}

/// Power that leaves the mechanical balance of a state: friction, damping, radiation [W/m].
pub fn dissipated_power(model: &Model, state: &State) -> f64 {
    state.contact.traction.friction_power + model.bodies.dissipation(state)
}

/// Balance at a stationary start.
pub fn start(model: &Model, state: &State) -> Audit {
    let energy = energy(model, state);
    Audit { initial_energy: energy, energy, dissipated_power: dissipated_power(model, state), ..Audit::default() }
}

/// Balance after a step from `state` to `next`, whose motion, bodies, contact and hub forces are complete.
pub fn advance(model: &Model, td: &TimeDerivative, state: &State, next: &State) -> Audit {
    let before = &state.audit;
    let impulse: [f64; 3] = std::array::from_fn(|k| td.impulse(next.hub[k], state.hub[k], before.impulse[k]));
    let (from, to) = (state.motion.velocities(), next.motion.velocities());
    let work: f64 = (0..3).map(|k| impulse[k] * 0.5 * (from[k] + to[k])).sum();
    let power = dissipated_power(model, next);
    let dissipated = td.impulse(power, before.dissipated_power, before.dissipated);
    Audit {
        initial_energy: before.initial_energy,
        energy: energy(model, next),
        work: before.work + work,
        dissipation: before.dissipation + dissipated,
        throughput: before.throughput + work.abs(),
        dissipated_power: power,
        impulse,
        dissipated,
    }
}
