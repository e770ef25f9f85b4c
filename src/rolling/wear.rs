//! Wear that changes the surfaces: what friction takes off wheel and rail in a step.
//!
//! The mass follows from the energy that friction dissipates per distance and area of the contact ([`WearLaw`]); it is
//! taken off where friction dissipates, from the material that has passed there in the step. The wheel keeps all of it.
//! The rail, from which one passage takes a negligible depth, keeps it where the contact stays.

use super::creepages::{STANDSTILL, per_metre};
use super::flattening::Passing;
use super::line::Line;
use super::model::RollingModel;
use super::state::State;
use crate::material::Isotropic;
use crate::piecewise::weighted_mean;
use crate::surface::{WearIncrement, WearLaw};

/// Smoothing length of a step, in cells, below which nothing is smoothed \[1].
const SHORTEST_SMOOTHING: f64 = 0.1;

/// Smallest cell in which wear is counted \[m]: the cells of a way of metres have room in memory, however small the
/// contact.
const FINEST: f64 = 1e-5;

/// Takes off what friction wears in the step of `dt` seconds from `state` to `next`, whose motion and contact are
/// complete, and notes mass and work.
pub fn wear(model: &RollingModel, state: &State, dt: f64, next: &mut State) {
    next.lines.iter_mut().zip(&state.lines).for_each(|(next, line)| next.worn = line.worn);
    if !model.config.damage.wear.is_on() {
        return;
    }
    let (velocity, rim) = (next.motion.velocity.now, next.motion.omega.now * model.rolling_radius(state));
    let (passing, motion) = (Passing::of(next), next.motion);
    for (before, line) in state.lines.iter().zip(&mut next.lines) {
        let [from, to] = [(before, state.motion), (&*line, motion)].map(|(line, motion)| {
            let [distance, angle] = line.place([motion.distance, motion.angle]);
            [angle * model.wheel.radius, distance]
        });
        wear_line(model, &Way { dt, velocity, rim, from, to }, &passing, line);
    }
}

/// Way of the material in a step.
struct Way {
    /// Length of the step \[s].
    dt: f64,
    /// V and the peripheral velocity at its end [m/s].
    velocity: f64,
    rim: f64,
    /// Positions on wheel and rail under the line at its beginning and end \[m].
    from: [f64; 2],
    to: [f64; 2],
}

/// Takes off what friction wears under one line.
fn wear_line(model: &RollingModel, way: &Way, passing: &Passing, next: &mut Line) {
    let (Way { dt, velocity, rim, from, to }, traction) = (way, &next.contact.traction);
    let t_gamma = per_metre(traction.friction.work / dt, *velocity, *rim);
    let law = WearLaw::r8t().scaled(model.config.damage.wear_factor);
    let mass = law.rate(t_gamma, traction.touching()) * velocity.abs().max(STANDSTILL) * dt;
    let volume = mass / model.config.material.density;
    let load = traction.resultant.height;
    if volume.is_nan() || volume <= 0.0 || load <= 0.0 || traction.friction.dissipation.is_empty() {
        return;
    }
    let distribution = traction.friction.dissipation.clone();
    let wears_rail = traction.extent().is_some_and(|patch| passing.stand(model, patch)[1]);
    let spacing = model.spacing.max(FINEST);
    let smoothing = smoothing_length(model, volume / load).min(model.wheel.radius);
    let smoothing = if smoothing > SHORTEST_SMOOTHING * spacing { smoothing } else { 0.0 };
    let increment =
        |body: usize| WearIncrement { path: [from[body], to[body]], distribution: &distribution, volume, smoothing };
    let mut work = weighted_mean(&distribution, &traction.pressure.x, &traction.pressure.value) * volume;
    next.flattening[0].wear(&increment(0), spacing);
    next.worn += mass;
    if wears_rail {
        next.flattening[1].wear(&increment(1), spacing);
        next.flattening[1].forget_beyond(to[1], model.config.rail.length);
        work *= 2.0;
    }
    next.contact.traction.yielding.plastic_work += work;
}

/// Length over which the wear of a step is smoothed \[m], so that the wear under a wave of the pressure does not exceed
/// that wave: wear per load `dh/dp` \[m/Pa], stiffness `½E*k` of the half-planes under a wave k, and of the waves that
/// pass the filter `1/(1 + (k ℓ)²)` the stiffest, kℓ = 1. It vanishes with the step.
fn smoothing_length(model: &RollingModel, wear: f64) -> f64 {
    Isotropic::from(&model.config.material).contact_modulus() * wear
}
