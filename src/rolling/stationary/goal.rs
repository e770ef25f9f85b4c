//! Conditions of a stationary state: the speeds that are given, and the one that is sought.

use super::super::brake;
use super::super::control::{Drive, Inputs, peripheral_velocity};
use super::super::error::StepError;
use super::super::model::RollingModel;
use crate::contact::{AxisDrive, RigidMotion};

/// Speed of both surfaces together below which the wheel stands [m/s].
const AT_REST: f64 = 1e-9;

/// Conditions of the stationary state.
pub(super) struct Goal {
    /// Values of the inputs.
    pub drive: Drive,
    /// Drives of the wheel, the brake included.
    pub drives: [AxisDrive; 3],
    /// Drives as the inputs give them.
    pub given: [AxisDrive; 3],
    /// V [m/s].
    velocity: f64,
    /// Ω [rad/s], if it is given.
    omega: Option<f64>,
    /// Creepage at which the wheel rolls where nothing else says it [1].
    creepage: f64,
    /// The axis whose speed is sought while its balance of forces holds: 0 travel, 2 rotation; `None`: both speeds are
    /// given.
    pub sought: Option<usize>,
    pub moving: bool,
}

/// Quantities that the passes of a search change.
#[derive(Clone, Copy)]
pub(super) struct Trial {
    /// V [m/s] and Ω [rad/s] as slip sees them. At standstill, where slip is a direction of motion, those of slow
    /// rolling.
    pub speeds: [f64; 2],
    /// Accelerations of the three axes.
    pub accelerations: [f64; 3],
}

impl Goal {
    /// From the inputs at the start. The travel velocity is that of the input or `initial.velocity`, the angular
    /// velocity that of the input or of `initial.creepage`, if it is set. Otherwise:
    /// - a wheel that moves rolls with the angular velocity that its moment needs;
    /// - a wheel at rest sticks, and the contact carries what moment or force put on it, nothing where both speeds are
    ///   prescribed. Such a contact is that of slow rolling, whose slip stands for the direction of motion;
    /// - without friction nothing holds the wheel, and it rolls without creepage.
    pub fn new(model: &RollingModel, inputs: &Inputs) -> Result<Self, StepError> {
        let (drive, initial, radius) = (inputs.at(0.0), &model.config.initial, model.wheel.radius);
        let given = model.wheel.drives(inputs, &drive);
        let target = |drive: AxisDrive| match drive {
            AxisDrive::Prescribed { target } => Some(target),
            AxisDrive::Free { .. } | AxisDrive::Braked { .. } => None,
        };
        let creepage = initial.creepage.unwrap_or(0.0);
        let velocity = target(given[0]).unwrap_or(initial.velocity);
        let rotation = brake::at_start(&given, velocity, peripheral_velocity(velocity, creepage), radius);
        let drives = [given[0], given[1], rotation];
        let prescribed = |k: usize| target(drives[k]);
        if prescribed(1).is_none() && drive.pressing() <= 0.0 {
            return Err(StepError::Unpressed { pressing: drive.pressing() });
        }
        let omega = prescribed(2);
        let moving = velocity.abs() + (radius * omega.unwrap_or(velocity / radius)).abs() > AT_REST;
        let axis = match (omega, moving) {
            (None, _) => Some(2),
            (Some(_), false) => Some(0),
            (Some(_), true) => None,
        };
        let sought = axis.filter(|_| initial.creepage.is_none() && drive.friction > 0.0);
        let goal = Self { drive, drives, given, velocity, omega, creepage, sought, moving };
        goal.check(model, goal.trial(radius).speeds)?;
        Ok(goal)
    }

    /// Refuses speeds beyond those of the model.
    pub fn check(&self, model: &RollingModel, speeds: [f64; 2]) -> Result<(), StepError> {
        let [velocity, omega] = self.actual(speeds);
        model.wheel.check([velocity, 0.0, omega])
    }

    /// Where the search starts: rolling with the rolling `radius` \[m].
    pub fn trial(&self, radius: f64) -> Trial {
        let rolling = |v: f64| peripheral_velocity(v, self.creepage) / radius;
        let speeds = if self.moving {
            [self.velocity, self.omega.unwrap_or(rolling(self.velocity))]
        } else {
            let direction = self.direction(radius);
            [direction, rolling(direction)]
        };
        Trial { speeds, accelerations: [0.0; 3] }
    }

    /// Direction in which a wheel at rest is about to roll: ±1.
    fn direction(&self, radius: f64) -> f64 {
        match (self.sought, self.free_loads()) {
            (Some(_), [Some(force), Some(moment)]) if radius * force + moment < 0.0 => -1.0,
            _ => 1.0,
        }
    }

    /// Force [N/m] and moment \[N] where they are prescribed.
    fn free_loads(&self) -> [Option<f64>; 2] {
        [0, 2].map(|k| self.drives[k].loads().map(|[load, _]| load))
    }

    /// V [m/s] and Ω [rad/s] of the state whose slip has the given speeds.
    pub fn actual(&self, speeds: [f64; 2]) -> [f64; 2] {
        if self.moving { speeds } else { [self.velocity, self.omega.unwrap_or(0.0)] }
    }

    /// Accelerations under the contact forces `resultant`.
    ///
    /// Where speeds are given, and off the rail, every free axis accelerates by what is left of its own balance. Where
    /// one is sought, the creepage stays constant, `Ω̇/V̇ = Ω/V = k`, and the sum of both balances,
    /// `m V̇ + k I Ω̇ = F + k M + (F_x + k M_c)`, gives the acceleration: the tangential force drops out, and what
    /// remains in brackets is the small loss of rolling.
    pub fn accelerations(&self, inertia: [f64; 3], speeds: [f64; 2], resultant: [f64; 3]) -> [f64; 3] {
        let [force, moment] = self.free_loads();
        if self.sought.is_none() || resultant[1] <= 0.0 {
            let own = |load: Option<f64>, k: usize| load.map_or(0.0, |load| (load + resultant[k]) / inertia[k]);
            return [own(force, 0), 0.0, own(moment, 2)];
        }
        let (Some(force), Some(moment)) = (force, moment) else { return [0.0; 3] };
        let k = speeds[1] / speeds[0];
        let driving = force + resultant[0] + k * (moment + resultant[2]);
        let translation = driving / (inertia[0] + k * k * inertia[2]);
        [translation, 0.0, k * translation]
    }

    /// Tangential force [N/m] that the contact has to carry where a speed is sought.
    pub fn tangential_force(&self, inertia: [f64; 3], trial: &Trial) -> f64 {
        let [force, moment] = self.free_loads();
        let needed = |load: Option<f64>, k: usize| inertia[k] * trial.accelerations[k] - load.unwrap_or(0.0);
        if self.sought == Some(0) { needed(force, 0) } else { -needed(moment, 2) * trial.speeds[1] / trial.speeds[0] }
    }

    /// The demand in words, for wheels of the given width \[m].
    pub fn demand(&self, width: f64) -> String {
        let [force, moment] = self.free_loads();
        let braked = matches!(self.given[2], AxisDrive::Braked { .. });
        let turning = if braked { "drive.moment less brake.torque" } else { "drive.moment" };
        let pulling = if self.drive.slope == 0.0 { "drive.force" } else { "drive.force on this rail.slope" };
        let parts = [(turning, moment, "N m"), (pulling, force, "N")];
        let named =
            parts.iter().filter_map(|(name, load, unit)| load.map(|load| format!("{name} = {} {unit}", load * width)));
        named.collect::<Vec<_>>().join(" and ")
    }

    /// The rigid motions of the contact problem: unknown are the hub height, unless it is prescribed, and the speed of
    /// the axis `sought`, whose acceleration is that of the trial whatever the speed.
    pub fn motions(
        &self,
        model: &RollingModel,
        trial: &Trial,
        sought: Option<usize>,
        height: f64,
        momentum: [f64; 3],
    ) -> [RigidMotion; 3] {
        let free = |k: usize, drive: AxisDrive, guess: f64| RigidMotion {
            drive,
            guess,
            gain: 0.0,
            offset: trial.accelerations[k],
            inertia: model.wheel.inertia[k],
            momentum: momentum[k],
        };
        let axis = |k: usize, speed: f64| match (sought == Some(k), self.drives[k]) {
            (false, _) => RigidMotion::held(speed, trial.accelerations[k]),
            (true, AxisDrive::Prescribed { .. }) => free(k, AxisDrive::Free { load: 0.0 }, speed),
            (true, drive) => free(k, drive, speed),
        };
        [axis(0, trial.speeds[0]), free(1, self.drives[1], height), axis(2, trial.speeds[1])]
    }
}
