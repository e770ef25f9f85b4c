//! The wheelset that a wheel belongs to: what its pose makes the surface of the wheel do at the contact, and what the forces
//! there do to it.
//!
//! Axes are those of the track, x ahead, y up, z to the right. The wheelset stands to the right of the track's middle by its
//! `lateral` shift, is turned to the right by its `yaw`, and leans to the right by its `roll`. Its axle points along
//! `e = (−sin ψ cos φ, −sin φ, cos ψ cos φ)`, about which the wheel turns by −Ω, so that the surface of the wheel at the
//! place `(0, −r, a)` of the contact moves by `V + ω × r`, and turns about the normal `n = (0, cos γ, −sin γ)` of the plane of
//! contact, which rises to the right by `γ`. The contact acts along x, along `(0, sin γ, cos γ)` and along n. Derivation:
//! `docs/theory/sideways.md`.

use super::control::{Drive, Inputs};
use super::error::StepError;
use super::patch_lines::PatchLines;
use crate::axes::PerAxis;
use crate::config::{Config, OnWheel, WheelsetSide, display_number};
use crate::contact::{BySpeed, Drift};
use crate::piecewise;
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
    pub force: [f64; 3],
    /// Moments about them, right-handed.
    pub moment: [f64; 3],
}

/// Where a wheel touches its rail.
#[derive(Clone, Copy, Debug)]
struct Stand {
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
    stands: Vec<Stand>,
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
            (shift, Stand { arm, radius: radius.unwrap_or(config.wheel.radius), angle })
        };
        let (shifts, stands) = patch.places().into_iter().map(place).unzip();
        Self { side, shifts, stands }
    }

    /// Where the wheel touches under a shift of the wheelset \[m].
    fn stand(&self, shift: f64) -> Stand {
        let beside = piecewise::cubic(&self.shifts, shift);
        let sum = |of: fn(&Stand) -> f64| beside.iter().map(|(k, weight)| weight * of(&self.stands[*k])).sum();
        Stand { arm: sum(|stand| stand.arm), radius: sum(|stand| stand.radius), angle: sum(|stand| stand.angle) }
    }

    /// Radius of rolling under a shift of the wheelset \[m].
    pub fn radius(&self, shift: f64) -> f64 {
        self.stand(shift).radius
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

    /// Where the wheel touches in a pose, and the angle between the plane of contact and the track \[rad].
    fn touches(&self, pose: &Pose) -> (Stand, f64) {
        let stand = self.stand(pose.lateral);
        (stand, stand.angle - pose.roll)
    }

    /// Drift of the surface of the wheel at the centre of load besides its rigid motions under inputs.
    pub fn drift(&self, drive: &Drive) -> Drift {
        if self.side.is_none() {
            let spin = BySpeed { per_travel: drive.spin, per_rotation: -libm::sin(drive.contact_angle), constant: 0.0 };
            return Drift { spin, ..Drift::default() };
        }
        let pose = Pose::of(drive);
        let (Stand { arm, radius, .. }, slope) = self.touches(&pose);
        let ([yaw, cos_yaw], [slope, rises]) = (both(pose.yaw), both(slope));
        let [roll, level] = both(pose.roll);
        let along = BySpeed { constant: -arm * pose.yaw_rate, per_rotation: radius * (1.0 - cos_yaw), per_travel: 0.0 };
        let across = BySpeed { per_rotation: -radius * yaw / rises, ..BySpeed::default() };
        let turn = roll * rises + cos_yaw * level * slope;
        let spin = BySpeed { constant: pose.yaw_rate * rises, per_rotation: -turn, per_travel: 0.0 };
        Drift { along, across, spin, rise: slope / rises }
    }

    /// Lateral velocity of the wheel in the plane of contact, which its turning adds to, under inputs [m/s]: what does not leave
    /// this plane is longer by its slope than what is level.
    pub fn lateral_velocity(&self, drive: &Drive) -> f64 {
        if self.side.is_none() {
            return drive.lateral_velocity;
        }
        let pose = Pose::of(drive);
        let (Stand { radius, .. }, slope) = self.touches(&pose);
        (pose.lateral_rate - radius * pose.roll_rate) / libm::cos(slope)
    }

    /// Cosine of the angle between the plane of contact and the track: a vertical load presses on this plane with the load over it,
    /// less what lifts the wheel along the plane, see [`Drift::rise`].
    pub fn level(&self, drive: &Drive) -> f64 {
        if self.side.is_none() { 1.0 } else { libm::cos(self.touches(&Pose::of(drive)).1) }
    }

    /// Wrench of contact forces on the wheelset: `force` on the wheel along, normal to and across in the plane of contact, with
    /// their forward moment about the hub, and the `spin` moment about the normal.
    pub fn wrench(&self, pose: &Pose, force: PerAxis<f64>, spin: f64) -> Wrench {
        if self.side.is_none() {
            return Wrench::default();
        }
        let (Stand { arm, radius, .. }, slope) = self.touches(pose);
        let ([slope, rises], [yaw, _]) = (both(slope), both(pose.yaw));
        let [x, y, z] =
            [force.travel, force.height * rises + force.lateral * slope, force.lateral * rises - force.height * slope];
        // A turned wheel touches ahead of or behind its axle.
        let ahead = yaw * (radius * slope / rises - arm);
        let below = -radius - arm * pose.roll;
        let moment =
            [below * z - arm * y, arm * x - ahead * z + spin * rises, ahead * y - force.rotation - spin * slope];
        Wrench { force: [x, y, z], moment }
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
