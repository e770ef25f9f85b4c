//! One communication step of the coach beside wheels that are stepped at the same time by a master that holds inputs.
//!
//! The wheels own their inertia. What the master hands over at the beginning of a step is where the wheelsets are then,
//! and what contacts and brakes do to them. The coach takes an implicit step in which wheelsets are masses under the
//! suspension and these forces, and a second one ahead: the mean of the suspension's forces over that second step is
//! what the wheels get, and hold, while it happens. Forces of the beginning of a step, held, would swing up in a stiff
//! primary suspension.
//!
//! In the first step wheels roll at the initial speed without force, whatever the inputs say: some masters hand over
//! nothing before it.

use crate::AXLES;
use crate::brake::Brakes;
use crate::parameters::Parameters;
use crate::vehicle::{Coach, Motion, Wheelsets};

/// Slide below which a wheelset counts as rolling in the prediction.
const ROLLING: f64 = 0.01;
/// Speed of a wheelset that does not turn: slower, or so slow that friction stops it soon, the rail holds it \[m/s].
const STANDING: f64 = 0.02;
/// Times its mass counts a wheelset that is held.
const IMMOBILE: f64 = 1e6;

/// Input of an axle from outside.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Seen {
    /// Way since the start \[m].
    pub distance: f64,
    /// Travel velocity \[m/s].
    pub velocity: f64,
    /// Angular velocity \[rad/s].
    pub omega: f64,
    /// Force of the contact on the wheelset along the track \[N].
    pub force: f64,
    /// Moment of the brake on the wheelset, forward positive \[N m].
    pub torque: f64,
}

/// Action of the coach on an axle during the next step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Driven {
    /// Force of the suspension along the track \[N].
    pub force: f64,
    /// Load on the rail beside the static one \[N].
    pub load_change: f64,
    /// Strength of the brake \[N m].
    pub torque: f64,
}

/// A coach that runs.
#[derive(Clone, Debug)]
pub struct Running {
    coach: Coach,
    /// Where the bodies are.
    pub motion: Motion,
    /// Its brakes.
    pub brakes: Brakes,
    /// Actions on the axles during the next step.
    pub driven: [Driven; AXLES],
    met: bool,
}

impl Running {
    /// At the start: nothing brakes, springs as under the weight.
    pub fn start(p: &Parameters) -> Self {
        let (coach, motion, brakes) = (Coach::new(p), Motion::start(p.speed), Brakes::new(p.speed));
        Self { coach, motion, brakes, driven: [Driven::default(); AXLES], met: false }
    }

    /// Advances by `h` \[s] under a demand of 0 to 1.
    pub fn step(&mut self, p: &Parameters, h: f64, demand: f64, seen: &[Seen; AXLES]) {
        let rolling = Seen { velocity: p.speed, omega: p.speed / p.radius, ..Seen::default() };
        let seen = if self.met { *seen } else { [rolling; AXLES] };
        let mut wheels = Wheelsets { masses: [p.wheelset_mass; AXLES], forces: [0.0; AXLES] };
        if self.met {
            self.motion.correct(seen.map(|s| s.distance), seen.map(|s| s.velocity));
            let [pulls, _] = self.coach.forces(&self.motion);
            wheels = predicted(p, h, &seen, &pulls);
        }
        self.met = true;
        let torques = self.brakes.step(p, h, demand, seen.map(|s| p.radius * s.omega));
        let reaction = seen.map(|s| s.torque);
        self.coach.advance(&mut self.motion, h, &reaction, &wheels);
        let now = self.coach.forces(&self.motion);
        let mut ahead = self.motion.clone();
        self.coach.advance(&mut ahead, h, &reaction, &wheels);
        let then = self.coach.forces(&ahead);
        let mean = |which: usize, axle: usize| 0.5 * (now[which][axle] + then[which][axle]);
        self.driven = std::array::from_fn(|axle| Driven {
            force: mean(0, axle),
            load_change: mean(1, axle),
            torque: torques[axle],
        });
    }
}

/// Wheelsets in the vehicle's step. While one rolls, its mass counts with its rotation; when it stands, it does not
/// move.
fn predicted(p: &Parameters, h: f64, seen: &[Seen; AXLES], pulls: &[f64; AXLES]) -> Wheelsets {
    let mut wheels = Wheelsets { masses: [p.wheelset_mass; AXLES], forces: seen.map(|s| s.force) };
    for (k, s) in seen.iter().enumerate() {
        let peripheral = p.radius * s.omega;
        let slow = STANDING + 2.0 * h * s.force.abs() / p.wheelset_mass;
        if s.omega.abs() < 1e-9 && s.velocity.abs() < slow {
            (wheels.masses[k], wheels.forces[k]) = (IMMOBILE * p.wheelset_mass, -pulls[k]);
        } else if (s.velocity - peripheral).abs() < ROLLING * s.velocity.abs().max(peripheral.abs()) {
            wheels.masses[k] = p.wheelset_mass + p.wheelset_inertia / (p.radius * p.radius);
            wheels.forces[k] = wheels.masses[k] / p.wheelset_mass * (pulls[k] + s.force) - pulls[k];
        }
    }
    wheels
}
