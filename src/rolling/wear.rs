//! Wear that changes the surfaces: what friction takes off wheel and rail in a step.
//!
//! The mass follows from the energy that friction dissipates per distance and area of the contact ([`WearLaw`]); it is taken off
//! where friction dissipates, from the material that has passed there in the step. The wheel keeps all of it. The rail, from
//! which one passage takes nothing to speak of, keeps it where the contact stays.

use super::control::{STANDSTILL, per_metre};
use super::flattening;
use super::model::Model;
use super::state::State;
use crate::config::{Config, Wear};
use crate::contact::Loss;
use crate::damage::WearLaw;
use crate::material::Isotropic;
use crate::piecewise::Piecewise;

/// Length over which wear is evened out, in cells, below which it is not \[1].
const ROUGH: f64 = 0.1;

/// Smallest cell in which wear is counted \[m]: the cells of a way of metres have room in memory, however small the contact.
const FINEST: f64 = 1e-5;

/// The law with its parameters.
pub fn law(config: &Config) -> WearLaw {
    let damage = &config.damage;
    WearLaw {
        mild: damage.wear_mild,
        severe: damage.wear_severe,
        catastrophic: damage.wear_catastrophic,
        severe_from: damage.wear_severe_from,
        catastrophic_from: damage.wear_catastrophic_from,
    }
}

/// Takes off what friction wears in the step of `dt` seconds from `state` to `next`, whose motion and contact are complete, and
/// notes mass and work.
pub fn wear(model: &Model, state: &State, dt: f64, next: &mut State) {
    next.worn = state.worn;
    if model.config.damage.wear == Wear::Off {
        return;
    }
    let traction = &next.contact.traction;
    let (velocity, rim) = (next.motion.velocity.now, next.motion.omega.now * model.rolling_radius(state));
    let t_gamma = per_metre(traction.friction.work / dt, velocity, rim);
    let mass = law(&model.config).rate(t_gamma, traction.touching()) * velocity.abs().max(STANDSTILL) * dt;
    let volume = mass / model.config.material.density;
    let load = traction.resultant[1];
    if volume.is_nan() || volume <= 0.0 || load <= 0.0 || traction.friction.dissipation.is_empty() {
        return;
    }
    let spread = traction.friction.dissipation.clone();
    let worn_rail = flattening::stands(model, next)[1];
    let element = model.contact.nominal_half_width() / model.config.mesh.elements_per_half_width as f64;
    let spacing = element.max(FINEST);
    let even = even(model, volume / load).min(model.wheel.radius);
    let even = if even > ROUGH * spacing { even } else { 0.0 };
    let (from, to) = (state.place(model.wheel.radius), next.place(model.wheel.radius));
    let loss = |body: usize| Loss { way: [from[body], to[body]], spread: &spread, volume, even };
    let pressure = weighted(&spread, &traction.pressure);
    next.flattening[0].wear(&loss(0), spacing);
    next.worn += mass;
    let mut work = pressure * volume;
    if worn_rail {
        next.flattening[1].wear(&loss(1), spacing);
        next.flattening[1].forget_beyond(next.motion.distance, model.config.rail.length);
        work *= 2.0;
    }
    next.contact.traction.yielding.plastic_work += work;
}

/// Length over which the wear of a step is evened out \[m], so that what a wave of the pressure wears off does not take away more
/// than that wave: wear per load `dh/dp` \[m/Pa], stiffness `½E*k` of the half-planes under a wave k, and of the waves that pass the
/// filter `1/(1 + (k ℓ)²)` the stiffest, kℓ = 1. It vanishes with the step.
fn even(model: &Model, wear: f64) -> f64 {
    Isotropic::from(&model.config.material).contact_modulus() * wear
}

/// Mean of a function weighted with another one, which is not negative and not zero everywhere.
fn weighted(weight: &Piecewise, function: &Piecewise) -> f64 {
    let (mut sum, mut total) = (0.0, 0.0);
    for (x, value) in weight.x.windows(2).zip(weight.value.windows(2)) {
        let mid = 0.5 * (x[0] + x[1]);
        let part = (x[1] - x[0]) * 0.5 * (value[0] + value[1]);
        (sum, total) = (sum + part * function.at(mid), total + part);
    }
    if total > 0.0 { sum / total } else { 0.0 }
}
