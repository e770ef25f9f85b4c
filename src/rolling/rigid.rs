//! The rigid motion of the wheel: inertia, what drives its three axes, reactions.

use super::control::{Drive, InputError, Inputs, Rotation, Translation, Vertical};
use super::error::StepError;
use super::state::{Motion, State};
use crate::config::Config;
use crate::contact::{AxisDrive, RigidMotion};
use crate::material::Isotropic;
use crate::mechanics;
use crate::mechanics::response::{FreeResponse, StepOperator};
use crate::multistep::TimeDerivative;
use nalgebra::DVector;

/// Standard gravity [m/s²].
const GRAVITY: f64 = 9.80665;

/// How far a motion may leave the range of the input that could prescribe it, as a factor.
const MOTION_MARGIN: f64 = 1.05;

/// The wheel as a rigid body on its axle, per metre of width.
#[derive(Clone, Debug)]
pub struct RigidWheel {
    /// Cold outer radius \[m].
    pub radius: f64,
    /// Width of the line contact \[m]: forces of the wheel = width × forces per metre.
    pub width: f64,
    /// Inertia in x (with vehicle) and in y [kg/m], about the axle [kg m].
    pub inertia: [f64; 3],
    /// Damper between the hub and the vehicle in y [N s/m per m].
    damping: f64,
    /// Speed of surface waves in its material [m/s].
    wave_speed: f64,
}

impl RigidWheel {
    /// From the parameters.
    pub fn new(config: &Config) -> Self {
        let width = config.width();
        let mass = mechanics::wheel_mass(config) + config.wheel.hub_mass / width;
        let moment = mechanics::wheel_inertia(config) + config.wheel.hub_inertia / width;
        Self {
            radius: config.wheel.radius,
            width,
            inertia: [mass + config.vehicle.mass / width, mass, moment],
            damping: config.vehicle.damping / width,
            wave_speed: Isotropic::from(&config.material).rayleigh_speed(),
        }
    }

    /// Drives of translation, hub height and rotation when the inputs have the values `target`.
    pub fn drives(&self, inputs: &Inputs, target: &Drive) -> [AxisDrive; 3] {
        [
            match inputs.translation {
                Translation::Force => AxisDrive::Free { load: target.force / self.width + self.gravity(target) },
                Translation::Velocity => AxisDrive::Prescribed { target: target.velocity },
            },
            match inputs.vertical {
                Vertical::Force => AxisDrive::Free { load: -target.pressing() / self.width },
                Vertical::Displacement => AxisDrive::Prescribed { target: target.displacement },
            },
            match inputs.rotation {
                Rotation::Moment => AxisDrive::of(target.moment / self.width, target.torque / self.width),
                Rotation::Velocity => AxisDrive::Prescribed { target: target.omega },
            },
        ]
    }

    /// Force of gravity along the track, positive in x [N/m].
    pub fn gravity(&self, target: &Drive) -> f64 {
        -GRAVITY * self.inertia[0] * target.slope / libm::hypot(target.slope, 1.0)
    }

    /// Velocity V [m/s] and angular velocity Ω [rad/s] expected after a step `dt` \[s].
    pub fn predicted_speeds(&self, motion: &Motion, drives: &[AxisDrive; 3], dt: f64) -> [f64; 2] {
        [(&motion.velocity, drives[0]), (&motion.omega, drives[2])].map(|(history, drive)| match drive {
            AxisDrive::Free { .. } => history.now + dt * history.rate,
            AxisDrive::Prescribed { target } => target,
            AxisDrive::Braked { .. } => match history.now + dt * history.rate {
                speed if speed * history.now > 0.0 => speed,
                _ => 0.0,
            },
        })
    }

    /// The three rigid motions of a step as unknowns of the contact problem, by the time formulas of velocities and of
    /// the hub height; `speeds` are the predicted ones, `momentum` is that of the free deformation.
    ///
    /// The damper resists `U̇`. In the time formula `Ü = a0 U̇ + h` with what is known of the velocity, h, so that
    /// `c U̇ = c/a0 (Ü − h)`: a mass more, and a known momentum.
    pub fn motions(
        &self,
        motion: &Motion,
        drives: &[AxisDrive; 3],
        [td, of_height]: [&TimeDerivative; 2],
        speeds: [f64; 2],
        momentum: [f64; 3],
    ) -> [RigidMotion; 3] {
        let known = motion.hub_velocity.offset(td);
        let axis = |k: usize, guess: f64, gain: f64, offset: f64| RigidMotion {
            drive: drives[k],
            guess,
            gain,
            offset,
            inertia: self.inertia[k],
            momentum: momentum[k],
        };
        let mut hub = axis(1, motion.height.now, td.a0 * of_height.a0, td.a0 * motion.height.offset(of_height) + known);
        hub.inertia += self.damping / td.a0;
        hub.momentum -= self.damping / td.a0 * known;
        [axis(0, speeds[0], td.a0, motion.velocity.offset(td)), hub, axis(2, speeds[1], td.a0, motion.omega.offset(td))]
    }

    /// Forces that drive the hub (x, y, moment): those prescribed, with the brake, and the reactions where a motion is
    /// prescribed or a brake holds the wheel at rest.
    pub fn hub_forces(
        &self,
        drives: &[AxisDrive; 3],
        motion: &Motion,
        operator: &StepOperator,
        free: &FreeResponse,
        forces: &DVector<f64>,
        resultant: [f64; 3],
    ) -> [f64; 3] {
        let (speeds, accelerations) = (motion.velocities(), motion.accelerations());
        std::array::from_fn(|k| match drives[k] {
            AxisDrive::Free { load } => load,
            AxisDrive::Braked { load, limit } if speeds[k] != 0.0 => load - limit * speeds[k].signum(),
            AxisDrive::Prescribed { .. } | AxisDrive::Braked { .. } => {
                let of_forces: f64 = operator.momentum.row(k).iter().zip(forces.iter()).map(|(m, f)| m * f).sum();
                let of_motion: f64 = (0..3).map(|l| operator.deformation_inertia[(k, l)] * accelerations[l]).sum();
                let deformation = free.momentum[k] + of_forces + of_motion;
                self.inertia[k] * accelerations[k] + deformation - resultant[k]
            }
        })
    }

    /// Force of the damper on the vehicle, up positive, where the load drives the hub [N/m].
    pub fn damper_force(&self, state: &State) -> f64 {
        if state.hub.prescribed[1] { 0.0 } else { self.damping * state.motion.hub_velocity.now }
    }

    /// Kinetic energy of the rigid motion [J/m].
    pub fn energy(&self, velocities: [f64; 3]) -> f64 {
        (0..3).map(|k| 0.5 * self.inertia[k] * velocities[k] * velocities[k]).sum()
    }

    /// Refuses motions (V, U, Ω) well outside the ranges of the inputs that could prescribe them, and velocities at
    /// which loads outrun the surface waves of rail or wheel: the moving frames have no stable solution there.
    pub fn check(&self, [velocity, displacement, omega]: [f64; 3]) -> Result<(), StepError> {
        // What is prescribed ends within its range; a free wheel that starts at its end may drift a little.
        let motion = Drive { velocity, displacement, omega, ..Drive::default() };
        motion.zip(&motion, |value, _| value / MOTION_MARGIN).validate().map_err(|error| {
            let [value, low, high] = [error.value, error.low, error.high].map(|limit| limit * MOTION_MARGIN);
            StepError::Motion(InputError { value, low, high, ..error })
        })?;
        let wave = self.wave_speed;
        for (name, value, limit, unit) in
            [("drive.velocity", velocity, wave, "m/s"), ("drive.omega", omega, wave / self.radius, "rad/s")]
        {
            if value.abs() >= limit {
                return Err(StepError::Motion(InputError { name, value, low: -limit, high: limit, unit }));
            }
        }
        Ok(())
    }

    /// [`Self::check`] of a state.
    pub fn check_state(&self, state: &State) -> Result<(), StepError> {
        self.check(state.motion.values())
    }
}
