//! All data that a restart needs, and nothing else. Per metre of width.

use super::elevation::Rise;
use super::line::Line;
use super::support::BaseMotion;
use super::wheelset::Pose;
use crate::axes::PerAxis;
use crate::contact::Drift;
use crate::heat::LateralHistory;
use crate::mechanics::response::BodyState;
use crate::multistep::History;
use serde::{Deserialize, Serialize};

/// State of a wheel on its rail.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct State {
    /// Time, and how it advances.
    pub clock: Clock,
    /// Rigid motion of the wheel, with the way it has made.
    pub motion: Motion,
    /// Deformation of the wheel.
    pub wheel: BodyState,
    /// Deformation of the rail.
    pub rail: BodyState,
    /// Height of the rail under the wheel \[m].
    pub elevation: f64,
    /// Rates of that height.
    pub rise: Rise,
    /// Motion of the base of the rail.
    pub base: BaseMotion,
    /// Contact lines side by side.
    pub lines: Vec<Line>,
    /// How long heat has not spread from line to line.
    pub spreading: LateralHistory,
    /// Friction coefficient that was available in the last step \[1].
    pub available_friction: f64,
    /// Angle of the wheel at which the point of the tread touches that is looked at \[rad].
    pub tread_point: f64,
    /// Forces on the hub in the last step.
    pub hub: HubForces,
    /// Mean power of friction over the last communication step; at the start the stationary one [W/m].
    pub friction_power: f64,
    /// Vertical contact force over the last communication step.
    pub pressing: Pressing,
    /// Energy balance.
    pub audit: Audit,
}

/// Time since the start, and the steps in which it advances.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Clock {
    /// Time since the start \[s].
    pub time: f64,
    /// Communication steps too short to be computed on their own since then; the next one makes up for them \[s].
    pub pending: f64,
    /// Length of the last internal step \[s]; 0: the time formula starts afresh.
    pub last_step: f64,
    /// True if the last internal step started the time formula afresh.
    pub restarted: bool,
    /// Memory of the control of the step size.
    pub control: StepControl,
    /// Internal steps of the last communication step.
    pub internal_steps: u64,
    /// Those among them whose errors exceed the tolerance because no more internal steps were allowed.
    pub limited_steps: u64,
    /// Estimated errors of force [N/m] and temperature \[K] by the lengths of its internal steps and of those just before.
    pub errors: [f64; 2],
    /// Contact iterations of the last communication step.
    pub iterations: u64,
    /// Fingerprint of the decisions of the last communication step.
    pub decisions: u64,
}

/// Forces on the hub in a step: generalised ones, in x, in y and the forward moment [N/m, N/m, N].
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct HubForces {
    /// Forces that drive the wheel at the end of the step, prescribed or reactions, with gravity and the brake.
    pub force: PerAxis<f64>,
    /// Forces as the time formula takes them: those whose impulses are the exact ones of prescribed forces.
    pub driving: PerAxis<f64>,
    /// Part of the force in x: gravity along the track [N/m].
    pub gravity: f64,
    /// The brake.
    pub brake: Brake,
    /// Motions that were prescribed.
    pub prescribed: PerAxis<bool>,
}

/// Vertical contact force between two communication points, so that what happens between them is not lost.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Pressing {
    /// Smallest force at the end of an internal step [N/m]; at the start the stationary one.
    pub lowest: f64,
    /// Largest one [N/m].
    pub highest: f64,
    /// Impulse of the force over the communication step [N s/m].
    pub impulse: f64,
    /// Time without contact since the start \[s].
    pub lost: f64,
}

impl Pressing {
    /// Under a constant force [N/m].
    pub fn constant(force: f64) -> Self {
        Self { lowest: force, highest: force, ..Self::default() }
    }

    /// That of a communication step that begins after this one.
    pub fn begun(&self) -> Self {
        Self { lowest: f64::INFINITY, highest: f64::NEG_INFINITY, impulse: 0.0, lost: self.lost }
    }

    /// Takes note of an internal step of `dt` seconds that ended in `state`.
    pub fn add(&mut self, state: &State, dt: f64) {
        let force = state.resultant().height;
        self.lowest = self.lowest.min(force);
        self.highest = self.highest.max(force);
        self.impulse += state.audit.pressed;
        self.lost += if state.touches() { 0.0 } else { dt };
    }
}

/// Action of the brake; all zero where there is none.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Brake {
    /// Its moment on the wheel, forward positive: at the end of the last step, or its mean over that step if it
    /// holds \[N].
    pub moment: f64,
    /// Its impulse in that step [N s].
    pub impulse: f64,
    /// True while it holds the wheel at rest.
    pub locked: bool,
    /// Its mean power over the last communication step; at the start the stationary one [W/m].
    pub power: f64,
}

/// Rigid motion of the wheel with the history that the time formula needs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Motion {
    /// Distance travelled \[m].
    pub distance: f64,
    /// Angle of rotation, forward positive \[rad].
    pub angle: f64,
    /// Translational velocity V [m/s].
    pub velocity: History,
    /// Angular velocity Ω, forward positive [rad/s].
    pub omega: History,
    /// Hub height above just touching U \[m].
    pub height: History,
    /// Vertical velocity of the hub U̇ [m/s].
    pub hub_velocity: History,
    /// Lateral displacement of the hub since the start, to the right positive \[m].
    pub aside: f64,
    /// Its lateral velocity V_z [m/s].
    pub lateral: History,
    /// Drift of its surface at the contact besides these motions, see [`Drift`]: velocities along and
    /// across [m/s], and angular velocity about the normal of the contact, clockwise from above positive [rad/s].
    pub drift: [f64; 3],
    /// Part of the lateral force that lifts the wheel, see [`Drift::rise`] \[1].
    pub rise: f64,
    /// Pose of the wheelset; all zero without one.
    pub pose: Pose,
}

impl Motion {
    /// Takes the drift of the wheel with the `rigid` motions V and Ω, and the pose of the wheelset.
    pub fn guide(&mut self, drift: &Drift, rigid: PerAxis<f64>, pose: Pose) {
        (self.drift, self.rise, self.pose) = (drift.velocities(rigid), drift.rise, pose);
    }

    /// Values of the rigid motions (V [m/s], U \[m], Ω [rad/s], V_z [m/s]).
    pub fn values(&self) -> PerAxis<f64> {
        PerAxis { height: self.height.now, ..self.velocities() }
    }

    /// Velocities conjugate to the hub forces (V, U̇ [m/s], Ω [rad/s], V_z [m/s]).
    pub fn velocities(&self) -> PerAxis<f64> {
        PerAxis {
            travel: self.velocity.now,
            height: self.height.rate,
            rotation: self.omega.now,
            lateral: self.lateral.now,
        }
    }

    /// Rigid accelerations (V̇, Ü [m/s²], Ω̇ [rad/s²], V̇_z [m/s²]).
    pub fn accelerations(&self) -> PerAxis<f64> {
        PerAxis {
            travel: self.velocity.rate,
            height: self.hub_velocity.rate,
            rotation: self.omega.rate,
            lateral: self.lateral.rate,
        }
    }
}

/// Memory of the control of the step size.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct StepControl {
    /// Largest internal step that the errors so far allow \[s].
    pub step: f64,
    /// Controlled quantities one internal step before.
    pub before: Controlled,
    /// Largest error that shorter steps were lately seen not to cure \[1].
    pub noise: f64,
    /// Internal steps taken of late while the contact yielded or was beyond Ac1 \[1].
    pub effort: f64,
    /// Error of a doubled step that failed, until it is clear whether its halves are quiet; zero: none \[1].
    pub suspect: f64,
    /// How many quiet steps have followed it.
    pub quiet: u32,
}

/// Quantities by which the error of a step is measured.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Controlled {
    /// Contact forces on the wheel (x, y, moment) [N/m, N/m, N].
    pub forces: PerAxis<f64>,
    /// Forces that move the hub besides those on it: of contact, damper and deformation (x, y, moment) [N/m, N/m, N].
    pub resisting: PerAxis<f64>,
    /// Force of the damper between hub and vehicle on the latter [N/m].
    pub damper: f64,
    /// Mean slip of the tread in the patch: x, z [m/s].
    pub slip: [f64; 2],
    /// Pressure-weighted mean rises of temperature of wheel and rail in the patch \[K].
    pub temperatures: [f64; 2],
    /// Translational velocity [m/s].
    pub velocity: f64,
    /// Angular velocity [rad/s].
    pub omega: f64,
    /// Lateral velocity of the hub [m/s].
    pub lateral: f64,
}

/// Energy balance since the start, per metre of width.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Audit {
    /// Energy at the start [J/m].
    pub initial_energy: f64,
    /// Present kinetic and elastic energy [J/m].
    pub energy: f64,
    /// Work of the hub forces, and of what makes the wheel drift, see [`Motion::drift`] [J/m].
    pub work: f64,
    /// Work of what makes the wheel drift; part of the work of the hub forces [J/m].
    pub spinning: f64,
    /// Work of the wheel that grows with its temperature and lifts its load [J/m].
    pub thermal_work: f64,
    /// Work of gravity along the track; part of the work of the hub forces [J/m].
    pub gravity: f64,
    /// Work of the rail that rises under the load [J/m].
    pub lift: f64,
    /// Energy that the brake has taken; part of the work of the hub forces [J/m].
    pub brake: f64,
    /// Energy that friction has turned into heat [J/m].
    pub friction: f64,
    /// Work of plastic flattening, and of the pressure on what wears off [J/m].
    pub plastic: f64,
    /// Energy lost to damping and radiation [J/m].
    pub damping: f64,
    /// Sum of the absolute work of all steps [J/m]: the scale of the round-off.
    pub throughput: f64,
    /// Present power of damping and radiation in the bodies and the track [W/m].
    pub damping_power: f64,
    /// Impulses of the hub forces (x, y, moment, z) in the last step [N s/m, N s/m, N s, N s/m].
    pub impulse: PerAxis<f64>,
    /// Impulses of the forces and the moment on the drift of the wheel in it, see [`audit::drifting`](super::audit::drifting)
    /// [N s/m and N s].
    pub drifting: [f64; 4],
    /// Impulse of the vertical contact force in it [N s/m].
    pub pressed: f64,
    /// Energy lost to damping and radiation in the bodies and the track in it [J/m].
    pub damped: f64,
    /// Impulse of the damper between hub and vehicle in it [N s/m].
    pub damper: f64,
}

impl Audit {
    /// Energy lost to friction, plastic flattening, damping and radiation [J/m].
    pub fn dissipation(&self) -> f64 {
        self.friction + self.plastic + self.damping
    }

    /// Energy that has vanished in the numerics [J/m].
    pub fn imbalance(&self) -> f64 {
        self.work + self.thermal_work + self.lift - (self.energy - self.initial_energy) - self.dissipation()
    }

    /// Imbalance relative to the dissipated energy \[1], or to the energy `stored` [J/m] in the loaded contact or a
    /// millionth of the energy moved, where those are more.
    pub fn residual(&self, stored: f64) -> f64 {
        self.imbalance() / self.dissipation().max(1e-6 * self.throughput).max(stored)
    }
}
