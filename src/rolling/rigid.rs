//! The rigid motion of the wheel: inertia, what drives its axes, reactions.

use super::control::{Drive, InputError, Inputs, Lateral, Rotation, Translation, Vertical};
use super::error::StepError;
use super::sideways::Sideways;
use super::state::{Motion, State};
use super::wheelset::Wheelset;
use crate::axes::{Axis, PerAxis};
use crate::config::Config;
use crate::contact::{AxisDrive, RigidMotion};
use crate::material::Isotropic;
use crate::mechanics::BodyParameters;
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
    /// Inertia in x (with vehicle), in y and in z (with what moves with the hub) [kg/m], about the axle [kg m].
    pub inertia: PerAxis<f64>,
    /// Damper between the hub and the vehicle in y [N s/m per m].
    damping: f64,
    /// Parts that carry the contact in z.
    pub sideways: Sideways,
    /// Its place in its wheelset.
    pub wheelset: Wheelset,
    /// Speed of surface waves in its material [m/s].
    wave_speed: f64,
}

impl RigidWheel {
    /// From the parameters.
    pub fn new(config: &Config, wheelset: Wheelset) -> Self {
        let (width, bodies) = (config.width(), BodyParameters::from(config));
        let mass = bodies.wheel_mass() + config.wheel.hub_mass / width;
        let lateral = mass + config.wheel.lateral_mass / width;
        let moment = bodies.wheel_inertia() + config.wheel.hub_inertia / width;
        Self {
            radius: config.wheel.radius,
            width,
            inertia: PerAxis { travel: mass + config.vehicle.mass / width, height: mass, rotation: moment, lateral },
            sideways: Sideways::new(config, lateral),
            wheelset,
            damping: config.vehicle.damping / width,
            wave_speed: Isotropic::from(&config.material).rayleigh_speed(),
        }
    }

    /// Drives of the axes when the inputs have the values `target`.
    pub fn drives(&self, inputs: &Inputs, target: &Drive) -> PerAxis<AxisDrive> {
        PerAxis {
            travel: match inputs.translation {
                Translation::Force => AxisDrive::Free { load: target.force / self.width + self.gravity(target) },
                Translation::Velocity => AxisDrive::Prescribed { target: target.velocity },
            },
            height: match inputs.vertical {
                Vertical::Force => {
                    let level = self.wheelset.level(target);
                    AxisDrive::Free { load: -target.pressing() / (level * self.width) }
                }
                Vertical::Displacement => AxisDrive::Prescribed { target: target.displacement },
            },
            rotation: match inputs.rotation {
                Rotation::Moment => AxisDrive::of(target.moment / self.width, target.torque / self.width),
                Rotation::Velocity => AxisDrive::Prescribed { target: target.omega },
            },
            lateral: match inputs.lateral {
                Lateral::Force => AxisDrive::Free { load: target.lateral_force / self.width },
                Lateral::Velocity => AxisDrive::Prescribed { target: self.wheelset.lateral_velocity(target) },
            },
        }
    }

    /// Force of gravity along the track, positive in x [N/m].
    pub fn gravity(&self, target: &Drive) -> f64 {
        -GRAVITY * self.inertia.travel * target.slope / libm::hypot(target.slope, 1.0)
    }

    /// Velocity V [m/s] and angular velocity Ω [rad/s] expected after a step `dt` \[s].
    pub fn predicted_speeds(&self, motion: &Motion, drives: &PerAxis<AxisDrive>, dt: f64) -> [f64; 2] {
        [(&motion.velocity, drives.travel), (&motion.omega, drives.rotation)].map(|(history, drive)| match drive {
            AxisDrive::Free { .. } => history.now + dt * history.rate,
            AxisDrive::Prescribed { target } => target,
            AxisDrive::Braked { .. } => match history.now + dt * history.rate {
                speed if speed * history.now > 0.0 => speed,
                _ => 0.0,
            },
        })
    }

    /// The rigid motions of a step as unknowns of the contact problem, by the time formulas of velocities and of
    /// the hub height; `speeds` are the predicted ones, `momentum` is that of the free deformation, and `lateral` the motion in z.
    ///
    /// The damper resists `U̇`. In the time formula `Ü = a0 U̇ + h` with what is known of the velocity, h, so that
    /// `c U̇ = c/a0 (Ü − h)`: a mass more, and a known momentum.
    pub fn motions(
        &self,
        motion: &Motion,
        drives: &PerAxis<AxisDrive>,
        [td, of_height]: [&TimeDerivative; 2],
        speeds: [f64; 2],
        momentum: PerAxis<f64>,
        lateral: RigidMotion,
    ) -> PerAxis<RigidMotion> {
        let known = motion.hub_velocity.offset(td);
        let motion_of = |axis: Axis, guess: f64, gain: f64, offset: f64| RigidMotion {
            drive: drives[axis],
            guess,
            gain,
            offset,
            inertia: self.inertia[axis],
            momentum: momentum[axis],
        };
        let (gain, offset) = (td.a0 * of_height.a0, td.a0 * motion.height.offset(of_height) + known);
        let mut hub = motion_of(Axis::Height, motion.height.now, gain, offset);
        hub.inertia += self.damping / td.a0;
        hub.momentum -= self.damping / td.a0 * known;
        PerAxis {
            travel: motion_of(Axis::Travel, speeds[0], td.a0, motion.velocity.offset(td)),
            height: hub,
            rotation: motion_of(Axis::Rotation, speeds[1], td.a0, motion.omega.offset(td)),
            lateral,
        }
    }

    /// Forces that drive the hub (x, y, moment): those prescribed, with the brake, and the reactions where a motion is
    /// prescribed or a brake holds the wheel at rest.
    pub fn hub_forces(
        &self,
        drives: &PerAxis<AxisDrive>,
        motion: &Motion,
        operator: &StepOperator,
        free: &FreeResponse,
        forces: &DVector<f64>,
        resultant: PerAxis<f64>,
    ) -> PerAxis<f64> {
        let (speeds, accelerations) = (motion.velocities(), motion.accelerations());
        PerAxis::from_fn(|axis| match drives[axis] {
            AxisDrive::Free { load } => load,
            AxisDrive::Braked { load, limit } if speeds[axis] != 0.0 => load - limit * speeds[axis].signum(),
            AxisDrive::Prescribed { .. } | AxisDrive::Braked { .. } => {
                let k = axis.number();
                let of_forces: f64 = operator.momentum.row(k).iter().zip(forces.iter()).map(|(m, f)| m * f).sum();
                let coupled = |(other, acceleration): (Axis, f64)| {
                    operator.deformation_inertia[(k, other.number())] * acceleration
                };
                let of_motion: f64 = accelerations.iter().map(coupled).sum();
                let deformation = free.momentum[axis] + of_forces + of_motion;
                self.inertia[axis] * accelerations[axis] + deformation - resultant[axis]
            }
        })
    }

    /// Force of the damper on the vehicle, up positive, where the load drives the hub [N/m].
    pub fn damper_force(&self, state: &State) -> f64 {
        if state.hub.prescribed.height { 0.0 } else { self.damping * state.motion.hub_velocity.now }
    }

    /// Kinetic energy of the rigid motion [J/m].
    pub fn energy(&self, velocities: PerAxis<f64>) -> f64 {
        velocities.iter().map(|(axis, velocity)| 0.5 * self.inertia[axis] * velocity * velocity).sum()
    }

    /// Refuses motions well outside the ranges of the inputs that could prescribe them, and velocities at
    /// which loads outrun the surface waves of rail or wheel: the moving frames have no stable solution there.
    pub fn check(&self, motions: PerAxis<f64>) -> Result<(), StepError> {
        let PerAxis { travel: velocity, height: displacement, rotation: omega, lateral: lateral_velocity } = motions;
        // What is prescribed ends within its range; a free wheel that starts at its end may drift a little.
        let motion = Drive { velocity, displacement, omega, lateral_velocity, ..Drive::default() };
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
