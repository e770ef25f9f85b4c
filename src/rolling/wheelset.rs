//! The wheelset that a wheel belongs to: what its pose makes the surface of the wheel do at the contact, and what the forces
//! there do to it.
//!
//! Axes are those of the track, x ahead, y up, z to the right. The wheelset stands to the right of the track's middle by its
//! `lateral` shift, is turned to the right by its `yaw`, and leans to the right by its `roll`. Its axle points along
//! `e = (−sin ψ cos φ, −sin φ, cos ψ cos φ)`, about which the wheel turns by −Ω, so that the surface of the wheel at the
//! place P of the contact, about `(0, −r, a)` from the middle, moves by `V + ω × P`, and turns about the normal
//! `n = (0, cos γ, −sin γ)` of the plane of contact, which rises to the right by `γ`. The contact acts along x, along
//! `(0, sin γ, cos γ)` and along n. Derivation: `docs/theory/sideways.md`.

use super::control::{Drive, Inputs};
use super::error::StepError;
use super::patch_lines::PatchLines;
use crate::axes::PerAxis;
use crate::config::{Config, OnWheel, WheelsetSide};
use crate::contact::{BySpeed, Drift};
use crate::display::display_number;
use crate::piecewise;
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

/// Pose of a wheelset in the axes of the track, and its rates.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Pose {
    /// Shift to the right \[m].
    pub lateral: f64,
    /// Turn to the right \[rad].
    pub yaw: f64,
    /// Lean to the right \[rad].
    pub roll: f64,
    /// Rate of the shift [m/s].
    pub lateral_rate: f64,
    /// Rate of the turn [rad/s].
    pub yaw_rate: f64,
    /// Rate of the lean [rad/s].
    pub roll_rate: f64,
}

impl Pose {
    /// The pose that inputs give.
    pub fn of(drive: &Drive) -> Self {
        let Drive { lateral, yaw, roll, lateral_rate, yaw_rate, roll_rate, .. } = *drive;
        Self { lateral, yaw, roll, lateral_rate, yaw_rate, roll_rate }
    }

    /// Angular velocity by the rates of turn and lean [rad/s].
    fn turning(&self) -> Vector3<f64> {
        Vector3::new(self.roll_rate, -self.yaw_rate, 0.0)
    }

    /// Inputs that give this pose.
    pub fn into(self, drive: Drive) -> Drive {
        let Self { lateral, yaw, roll, lateral_rate, yaw_rate, roll_rate } = self;
        Drive { lateral, yaw, roll, lateral_rate, yaw_rate, roll_rate, ..drive }
    }
}

/// Forces and moments about the middle of the wheelset, in the axes of the track.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Wrench {
    /// Forces along x, y and z.
    pub force: Vector3<f64>,
    /// Moments about them, right-handed.
    pub moment: Vector3<f64>,
}

/// A wheel in a pose, in the axes of the track.
struct Stand {
    /// Direction of the axle.
    axle: Vector3<f64>,
    /// Upward normal of the plane of contact.
    normal: Vector3<f64>,
    /// Direction to the right in this plane.
    across: Vector3<f64>,
    /// Centre of load from the middle of the wheelset \[m].
    place: Vector3<f64>,
}

/// Where a wheel touches its rail in a wheelset that neither turns nor leans.
#[derive(Clone, Copy, Debug)]
struct TouchPoint {
    /// Lateral place of the centre of load from the middle of the wheelset \[m].
    arm: f64,
    /// Radius of rolling \[m].
    radius: f64,
    /// Angle between the plane of contact and the axle \[rad].
    angle: f64,
}

/// Place of a wheel in its wheelset.
#[derive(Clone, Debug)]
pub struct Wheelset {
    /// 1 for the right wheel, −1 for the left one; `None`: the host says what the wheel does at the contact.
    side: Option<f64>,
    /// Shifts of the wheelset, ascending \[m], and where the wheel touches under them.
    shifts: Vec<f64>,
    points: Vec<TouchPoint>,
}

impl Wheelset {
    /// From the parameters and the lines of the patch. A wheel without a wheelset rolls on its own radius, whatever its rows say.
    pub fn new(config: &Config, patch: &PatchLines) -> Self {
        let side = match config.wheelset.side {
            WheelsetSide::None => None,
            WheelsetSide::Left => Some(-1.0),
            WheelsetSide::Right => Some(1.0),
        };
        let place = |(shift, centre, on_wheel): (f64, f64, OnWheel)| {
            let OnWheel { angle, radius, lateral } = if side.is_some() { on_wheel } else { OnWheel::default() };
            let arm = side.map_or(0.0, |side| side * config.wheelset.half_spacing + lateral.unwrap_or(centre));
            (shift, TouchPoint { arm, radius: radius.unwrap_or(config.wheel.radius), angle })
        };
        let (shifts, points) = patch.places().into_iter().map(place).unzip();
        Self { side, shifts, points }
    }

    /// Where the wheel touches under a shift of the wheelset \[m].
    fn touch(&self, shift: f64) -> TouchPoint {
        if let [always] = self.points[..] {
            return always;
        }
        let beside = piecewise::cubic(&self.shifts, shift);
        let sum = |of: fn(&TouchPoint) -> f64| beside.iter().map(|(k, weight)| weight * of(&self.points[*k])).sum();
        TouchPoint { arm: sum(|point| point.arm), radius: sum(|point| point.radius), angle: sum(|point| point.angle) }
    }

    /// Radius of rolling under a shift of the wheelset \[m].
    pub fn radius(&self, shift: f64) -> f64 {
        self.touch(shift).radius
    }

    /// Refuses shifts for which there is no patch.
    pub fn within(&self, drive: &Drive) -> Result<(), StepError> {
        let (Some(&low), Some(&high)) = (self.shifts.first(), self.shifts.last()) else { return Ok(()) };
        let shift = drive.lateral;
        match low == high || (low..=high).contains(&shift) {
            true => Ok(()),
            false => Err(StepError::Shifted { shift, low, high }),
        }
    }

    /// Refuses inputs of the one kind of host where the other one is told of.
    pub fn check(&self, inputs: &Inputs) -> Result<(), StepError> {
        let of_wheel = self.side.is_none();
        if !of_wheel && !inputs.lateral.prescribes_motion() {
            return Err(StepError::OfTheWheel { input: "control.lateral = force".to_owned() });
        }
        for values in [&inputs.drive, &inputs.rate] {
            let found = if of_wheel { of_a_pose(values) } else { of_a_wheel(values) };
            if let Some((name, value)) = found.into_iter().find(|(_, value)| *value != 0.0) {
                let input = format!("{name} = {}", display_number(value));
                return Err(if of_wheel {
                    StepError::OfTheWheelset { input }
                } else {
                    StepError::OfTheWheel { input }
                });
            }
        }
        Ok(())
    }

    /// Part of a direction of inputs that acts.
    pub fn acting(&self, direction: &Drive) -> Drive {
        match self.side {
            None => Pose::default().into(*direction),
            Some(_) => Drive { lateral_velocity: 0.0, spin: 0.0, contact_angle: 0.0, ..*direction },
        }
    }

    /// The wheel in a pose. It is a cone about its axle, whose normal is that of the plane of contact where it touches: a turned wheel
    /// touches ahead of or behind its axle.
    fn stand(&self, pose: &Pose) -> Stand {
        let ([yaw, cos_yaw], [roll, cos_roll]) = (both(pose.yaw), both(pose.roll));
        let TouchPoint { arm, radius, angle } = self.touch(pose.lateral);
        let [slope, rises] = both(angle - pose.roll);
        let axle = Vector3::new(-yaw * cos_roll, -roll, cos_yaw * cos_roll);
        let normal = Vector3::new(0.0, rises, -slope);
        let steep = -normal.dot(&axle);
        let down = -(normal + steep * axle) / (1.0 - steep * steep).sqrt();
        Stand { axle, normal, across: Vector3::new(0.0, slope, rises), place: radius * down + arm * axle }
    }

    /// Drift of the surface of the wheel at the centre of load besides its rigid motions under inputs.
    pub fn drift(&self, drive: &Drive) -> Drift {
        if self.side.is_none() {
            let spin = BySpeed { per_travel: drive.spin, per_rotation: -libm::sin(drive.contact_angle), constant: 0.0 };
            return Drift { spin, ..Drift::default() };
        }
        let pose = Pose::of(drive);
        let Stand { axle, normal, across, place } = self.stand(&pose);
        let (turning, rolling, rises) = (pose.turning().cross(&place), axle.cross(&place), across.z);
        let by_rotation = |per_rotation: f64| BySpeed { per_rotation, ..BySpeed::default() };
        Drift {
            along: BySpeed { constant: turning.x, ..by_rotation(self.radius(drive.lateral) - rolling.x) },
            across: by_rotation(-rolling.z / rises),
            spin: BySpeed { constant: -pose.turning().dot(&normal), ..by_rotation(axle.dot(&normal)) },
            rise: across.y / rises,
        }
    }

    /// Lateral velocity of the wheel in the plane of contact, which its turning adds to, under inputs [m/s]: what does not leave
    /// this plane is longer by its slope than what is level.
    pub fn lateral_velocity(&self, drive: &Drive) -> f64 {
        if self.side.is_none() {
            return drive.lateral_velocity;
        }
        let pose = Pose::of(drive);
        let Stand { across, place, .. } = self.stand(&pose);
        (pose.lateral_rate + pose.turning().cross(&place).z) / across.z
    }

    /// Cosine of the angle between the plane of contact and the track: a vertical load presses on this plane with the load over it,
    /// less what lifts the wheel along the plane, see [`Drift::rise`].
    pub fn level(&self, drive: &Drive) -> f64 {
        if self.side.is_none() { 1.0 } else { self.stand(&Pose::of(drive)).across.z }
    }

    /// Wrench of contact forces on the wheelset: `force` on the wheel along, normal to and across in the plane of contact, with
    /// their forward moment about the hub, and the `spin` moment about the normal.
    pub fn wrench(&self, pose: &Pose, force: PerAxis<f64>, spin: f64) -> Wrench {
        let PerAxis { travel, height, lateral, rotation } = force;
        if self.side.is_none() {
            return Wrench::default();
        }
        let Stand { axle, normal, across, place } = self.stand(pose);
        let force = Vector3::x() * travel + normal * height + across * lateral;
        // The force along acts on the axle with the lever arms of deformed bodies, as in the balance of the wheel.
        let by_deformation = -rotation - self.radius(pose.lateral) * travel;
        let moment = place.cross(&force) + axle * by_deformation + normal * spin;
        Wrench { force, moment }
    }
}

/// Sine and cosine.
fn both(angle: f64) -> [f64; 2] {
    let (sin, cos) = libm::sincos(angle);
    [sin, cos]
}

/// Inputs of a host that knows the wheelset.
fn of_a_pose(drive: &Drive) -> Vec<(&'static str, f64)> {
    let Pose { lateral, yaw, roll, lateral_rate, yaw_rate, roll_rate } = Pose::of(drive);
    vec![
        ("wheelset.lateral", lateral),
        ("wheelset.yaw", yaw),
        ("wheelset.roll", roll),
        ("wheelset.lateral_rate", lateral_rate),
        ("wheelset.yaw_rate", yaw_rate),
        ("wheelset.roll_rate", roll_rate),
    ]
}

/// Inputs of a host that knows the wheel alone.
fn of_a_wheel(drive: &Drive) -> Vec<(&'static str, f64)> {
    let Drive { lateral_velocity, lateral_force, spin, contact_angle, .. } = *drive;
    vec![
        ("drive.lateral_velocity", lateral_velocity),
        ("drive.lateral_force", lateral_force),
        ("drive.spin", spin),
        ("drive.contact_angle", contact_angle),
    ]
}
