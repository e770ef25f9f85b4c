//! All that a restart needs, and nothing else. Per metre of width.

use super::stepping::StepControl;
use super::thermal::ThermalState;
use crate::contact::ContactSolution;
use crate::mechanics::response::BodyState;
use crate::multistep::History;
use serde::{Deserialize, Serialize};

/// State of a wheel on its rail at a communication point.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct State {
    /// Time since the start [s].
    pub time: f64,
    /// Communication steps too short to be computed on their own since then; the next one makes up for them [s].
    pub pending: f64,
    /// Distance travelled [m].
    pub distance: f64,
    /// Angle of rotation, forward positive [rad].
    pub angle: f64,
    /// Translational velocity V [m/s].
    pub velocity: History,
    /// Angular velocity Ω, forward positive [rad/s].
    pub omega: History,
    /// Hub height above just touching U [m].
    pub height: History,
    /// Its rate of change [m/s].
    pub climb: History,
    pub wheel: BodyState,
    pub rail: BodyState,
    /// Tangential displacement difference `u_c − u_p` at the contact candidates [m].
    pub shift: Vec<History>,
    /// Contact state, forces and surface displacements: results and warm start.
    pub contact: ContactSolution,
    /// Temperatures, unless the thermal part is switched off.
    pub thermal: Option<ThermalState>,
    /// Generalised hub forces (x, y, forward moment) that drive the wheel, prescribed or reactions [N/m, N/m, N].
    pub hub: [f64; 3],
    /// Which motions (V, U, Ω) were prescribed in the last step.
    pub prescribed: [bool; 3],
    /// Friction coefficient of the last step [1].
    pub friction: f64,
    /// Friction coefficient that was available in the last step [1].
    pub available_friction: f64,
    /// Length of the last internal step [s]; 0 restarts the multistep formula.
    pub last_step: f64,
    /// Whether that step restarted the formula.
    pub restarted: bool,
    pub control: StepControl,
    /// Internal steps and contact iterations of the last communication step.
    pub internal_steps: u64,
    pub iterations: u64,
    pub audit: Audit,
}

/// Energy balance since the start, per metre of width.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Audit {
    /// Energy at the start [J/m].
    pub initial_energy: f64,
    /// Present kinetic and elastic energy [J/m].
    pub energy: f64,
    /// Work of the hub forces [J/m].
    pub work: f64,
    /// Frictional dissipation [J/m].
    pub dissipation: f64,
    /// Sum of the absolute work of all steps [J/m]: the scale of the round-off.
    pub throughput: f64,
    /// Present power of friction [W/m].
    pub friction_power: f64,
    /// Impulses of the hub forces (x, y, moment) in the last step [N s/m, N s/m, N s].
    pub impulse: [f64; 3],
    /// Energy that friction dissipated in it [J/m].
    pub dissipated: f64,
}

impl Audit {
    /// Energy that has vanished, in the numerics [J/m].
    pub fn imbalance(&self) -> f64 {
        self.work - (self.energy - self.initial_energy) - self.dissipation
    }

    /// Imbalance relative to the dissipated energy [1], or to the energy `stored` [J/m] in the loaded contact or a
    /// millionth of the energy moved, where those are more.
    pub fn residual(&self, stored: f64) -> f64 {
        self.imbalance() / self.dissipation.max(1e-6 * self.throughput).max(stored)
    }
}
