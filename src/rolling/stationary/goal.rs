//! Conditions of a stationary state: the speeds that are given, and the one that is sought.

use super::super::brake;
use super::super::control::{Drive, Inputs};
use super::super::creepages::peripheral_velocity;
use super::super::error::StepError;
use super::super::model::RollingModel;
use crate::axes::{Axis, PerAxis};
use crate::contact::{AxisDrive, Drift, RigidMotion};

/// Speed of both surfaces together below which the wheel stands [m/s].
const AT_REST: f64 = 1e-9;

/// Conditions of the stationary state.
pub(super) struct Goal {
    /// Values of the inputs.
    pub drive: Drive,
    /// Drives of the wheel, the brake included.
    pub drives: PerAxis<AxisDrive>,
    /// Drives as the inputs give them.
    pub given: PerAxis<AxisDrive>,
    /// V [m/s].
    velocity: f64,
    /// Ω [rad/s], if it is given.
    omega: Option<f64>,
    /// Creepage at which the wheel rolls where nothing else says it [1].
    creepage: f64,
    /// The axis whose speed is sought while its balance of forces holds, travel or rotation; `None`: both speeds are
    /// given.
    pub sought: Option<Axis>,
    /// True if the lateral velocity is sought under a given lateral force.
    pub seeks_aside: bool,
    pub moving: bool,
}

/// Quantities that the passes of a search change.
#[derive(Clone, Copy)]
pub(super) struct Trial {
    /// V [m/s] and Ω [rad/s] as slip sees them. At standstill, where slip is a direction of motion, those of slow
    /// rolling.
    pub speeds: [f64; 2],
    /// Accelerations of the axes.
    pub accelerations: PerAxis<f64>,
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
        let velocity = target(given.travel).unwrap_or(initial.velocity);
        let rotation = brake::at_start(&given, velocity, peripheral_velocity(velocity, creepage), radius);
        let drives = PerAxis { rotation, ..given };
        if target(drives.height).is_none() && drive.pressing() <= 0.0 {
            return Err(StepError::Unpressed { pressing: drive.pressing() });
        }
        let omega = target(drives.rotation);
        let moving = velocity.abs() + (radius * omega.unwrap_or(velocity / radius)).abs() > AT_REST;
        let axis = match (omega, moving) {
            (None, _) => Some(Axis::Rotation),
            (Some(_), false) => Some(Axis::Travel),
            (Some(_), true) => None,
        };
        let sought = axis.filter(|_| initial.creepage.is_none() && drive.friction > 0.0);
        let seeks_aside = target(drives.lateral).is_none() && drive.friction > 0.0;
        let goal = Self { drive, drives, given, velocity, omega, creepage, sought, seeks_aside, moving };
        goal.check(model, goal.trial(radius).speeds)?;
        Ok(goal)
    }

    /// Refuses speeds beyond those of the model.
    pub fn check(&self, model: &RollingModel, speeds: [f64; 2]) -> Result<(), StepError> {
        let [travel, rotation] = self.actual(speeds);
        model.wheel.check(PerAxis { travel, rotation, ..PerAxis::default() })
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
        Trial { speeds, accelerations: PerAxis::default() }
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
        [self.drives.travel, self.drives.rotation].map(|drive| drive.loads().map(|[load, _]| load))
    }

    /// Lateral velocity that is given [m/s]; zero where the force is.
    pub fn aside(&self) -> f64 {
        match self.drives.lateral {
            AxisDrive::Prescribed { target } => target,
            AxisDrive::Free { .. } | AxisDrive::Braked { .. } => 0.0,
        }
    }

    /// Drift of the wheel at the contact besides its rigid motions; nothing at rest.
    pub fn drift(&self, model: &RollingModel) -> Drift {
        if self.moving { model.wheel.wheelset.drift(&self.drive) } else { Drift::default() }
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
    pub fn accelerations(&self, inertia: PerAxis<f64>, speeds: [f64; 2], resultant: PerAxis<f64>) -> PerAxis<f64> {
        let [force, moment] = self.free_loads();
        let own = |load: Option<f64>, axis: Axis| load.map_or(0.0, |load| (load + resultant[axis]) / inertia[axis]);
        let aside = self.drives.lateral.loads().map(|[load, _]| load);
        let lateral = if self.seeks_aside && resultant.height > 0.0 { 0.0 } else { own(aside, Axis::Lateral) };
        let others = PerAxis { lateral, ..PerAxis::default() };
        if self.sought.is_none() || resultant.height <= 0.0 {
            let (travel, rotation) = (own(force, Axis::Travel), own(moment, Axis::Rotation));
            return PerAxis { travel, rotation, ..others };
        }
        let (Some(force), Some(moment)) = (force, moment) else { return others };
        let k = speeds[1] / speeds[0];
        let driving = force + resultant.travel + k * (moment + resultant.rotation);
        let travel = driving / (inertia.travel + k * k * inertia.rotation);
        PerAxis { travel, rotation: k * travel, ..others }
    }

    /// Tangential force [N/m] that the contact has to carry where speeds are sought.
    pub fn tangential_force(&self, inertia: PerAxis<f64>, trial: &Trial) -> f64 {
        let along = self.force_along(inertia, trial);
        match self.drives.lateral.loads().filter(|_| self.seeks_aside) {
            Some([aside, _]) if aside != 0.0 => libm::hypot(along, aside),
            _ => along,
        }
    }

    /// Force [N/m] along the direction of travel that it has to carry.
    fn force_along(&self, inertia: PerAxis<f64>, trial: &Trial) -> f64 {
        let [force, moment] = self.free_loads();
        let needed = |load: Option<f64>, axis: Axis| inertia[axis] * trial.accelerations[axis] - load.unwrap_or(0.0);
        match self.sought {
            None => 0.0,
            Some(Axis::Travel) => needed(force, Axis::Travel),
            Some(_) => -needed(moment, Axis::Rotation) * trial.speeds[1] / trial.speeds[0],
        }
    }

    /// The demand in words, for wheels of the given width \[m].
    pub fn demand(&self, width: f64) -> String {
        let [force, moment] = self.free_loads();
        let braked = matches!(self.given.rotation, AxisDrive::Braked { .. });
        let turning = if braked { "drive.moment less brake.torque" } else { "drive.moment" };
        let pulling = if self.drive.slope == 0.0 { "drive.force" } else { "drive.force on this rail.slope" };
        let parts = [(turning, moment, "N m"), (pulling, force, "N")];
        let aside = self.drives.lateral.loads().map(|[load, _]| load).filter(|load| *load != 0.0);
        let parts = parts.into_iter().chain([("drive.lateral_force", aside, "N")]);
        let named = parts.filter_map(|(name, load, unit)| load.map(|load| format!("{name} = {} {unit}", load * width)));
        named.collect::<Vec<_>>().join(" and ")
    }

    /// The rigid motions of the contact problem: unknown are the hub height, unless it is prescribed, and, where `touching`
    /// bodies hold them, the speed of the axis that is sought and the lateral one, whose accelerations are those of the
    /// trial whatever the speed. The search begins with the motions `start`.
    pub fn motions(
        &self,
        model: &RollingModel,
        trial: &Trial,
        touching: bool,
        start: PerAxis<f64>,
        momentum: PerAxis<f64>,
    ) -> PerAxis<RigidMotion> {
        let free = |axis: Axis, drive: AxisDrive, guess: f64| RigidMotion {
            drive,
            guess,
            gain: 0.0,
            offset: trial.accelerations[axis],
            inertia: model.wheel.inertia[axis],
            momentum: momentum[axis],
        };
        let motion = |axis: Axis, speed: f64| match (touching && self.sought == Some(axis), self.drives[axis]) {
            (false, _) => RigidMotion::held(speed, trial.accelerations[axis]),
            (true, AxisDrive::Prescribed { .. }) => free(axis, AxisDrive::Free { load: 0.0 }, speed),
            (true, drive) => free(axis, drive, speed),
        };
        PerAxis {
            travel: motion(Axis::Travel, trial.speeds[0]),
            height: free(Axis::Height, self.drives.height, start.height),
            rotation: motion(Axis::Rotation, trial.speeds[1]),
            lateral: match touching && self.seeks_aside {
                true => free(Axis::Lateral, self.drives.lateral, start.lateral),
                false => RigidMotion::held(if self.moving { self.aside() } else { 0.0 }, 0.0),
            },
        }
    }
}
