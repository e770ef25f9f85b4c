//! Sideways motion of the wheel: its hub moves under the lateral force F of the contact and the force L on it,
//!
//! `M V̇ = L + F`
//!
//! with the mass M of all that moves with the hub. The plane bodies do not move sideways. Theory: `docs/theory/sideways.md`. Per
//! metre of width.

use super::control::{Drive, Inputs};
use super::error::StepError;
use crate::config::Config;
use crate::contact::{AxisDrive, RigidMotion};
use crate::display::display_number;
use crate::multistep::{History, TimeDerivative};

/// Hub that carries the contact sideways.
#[derive(Clone, Copy, Debug)]
pub struct Sideways {
    /// True if the contact has two directions.
    pub enabled: bool,
    /// Mass that moves with the hub [kg/m].
    mass: f64,
}

impl Sideways {
    /// From the parameters; `mass` is that of all that moves with the hub [kg/m].
    pub fn new(config: &Config, mass: f64) -> Self {
        Self { enabled: config.contact.lateral, mass }
    }

    /// Refuses inputs across the direction of travel where the contact has no such direction.
    pub fn check(&self, inputs: &Inputs) -> Result<(), StepError> {
        if self.enabled {
            return Ok(());
        }
        if !inputs.lateral.prescribes_motion() {
            return Err(StepError::Longitudinal { input: "control.lateral = force".to_owned() });
        }
        for values in [&inputs.drive, &inputs.rate] {
            let Drive { lateral_velocity, lateral_force, spin, contact_angle, .. } = *values;
            let inputs = [
                ("drive.lateral_velocity", lateral_velocity),
                ("drive.lateral_force", lateral_force),
                ("drive.spin", spin),
                ("drive.contact_angle", contact_angle),
            ];
            if let Some((name, value)) = inputs.into_iter().find(|(_, value)| *value != 0.0) {
                return Err(StepError::Longitudinal { input: format!("{name} = {}", display_number(value)) });
            }
        }
        Ok(())
    }

    /// Part of a direction of inputs that acts: nothing across where the contact has no such direction.
    pub fn acting(&self, direction: &Drive) -> Drive {
        match self.enabled {
            true => *direction,
            false => Drive { lateral_velocity: 0.0, lateral_force: 0.0, spin: 0.0, contact_angle: 0.0, ..*direction },
        }
    }

    /// Step from a hub with the lateral velocity `hub` under a `drive`.
    pub fn step(&self, hub: &History, drive: AxisDrive, td: &TimeDerivative) -> SideStep {
        SideStep { a0: td.a0, mass: self.mass, offset: hub.offset(td), drive }
    }
}

/// Sideways motion in one step as a function of the lateral force of the contact.
pub struct SideStep {
    a0: f64,
    mass: f64,
    /// Known part of the acceleration of the hub [m/s²].
    offset: f64,
    drive: AxisDrive,
}

impl SideStep {
    /// Velocity at the end of the step under the lateral force of the contact on the wheel [m/s].
    fn under(&self, force: f64) -> f64 {
        match self.drive {
            AxisDrive::Prescribed { target } => target,
            AxisDrive::Free { load } | AxisDrive::Braked { load, .. } => {
                ((load + force) / self.mass - self.offset) / self.a0
            }
        }
    }

    /// Lateral motion as the contact sees it: prescribed, or that of one mass. `force` is the one of the step before [N/m].
    pub fn motion(&self, force: f64) -> RigidMotion {
        if let AxisDrive::Prescribed { target } = self.drive {
            return RigidMotion::held(target, 0.0);
        }
        // Change of the velocity with the force [m/s per N/m].
        let mobility = 1.0 / self.mass / self.a0;
        RigidMotion {
            drive: AxisDrive::Free { load: 0.0 },
            guess: self.under(force),
            gain: self.a0,
            offset: 0.0,
            inertia: 1.0 / (mobility * self.a0),
            momentum: -self.under(0.0) / mobility,
        }
    }

    /// Brings the hub to the end of the step under the lateral `force` of the contact [N/m]. Returns the force on the hub [N/m].
    pub fn advance(&self, force: f64, td: &TimeDerivative, hub: &mut History) -> f64 {
        hub.push(td, self.under(force));
        self.mass * hub.rate - force
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::multistep::formula;

    /// Contact that resists with this force over its lateral velocity [N s/m per m].
    const CREEP: f64 = 3e5;

    #[test]
    fn impulses_are_the_change_of_momentum_and_a_held_hub_goes_its_way() {
        let sideways = Sideways { enabled: true, mass: 4e3 };
        let (drive, mut hub, mut impulse) = (AxisDrive::Free { load: 1e5 }, History::constant(0.0), 0.0);
        let (mut forces, dt) = ([History::default(); 2], 1e-5);
        for k in 0..2000 {
            let td = formula(dt, if k == 0 { 0.0 } else { dt });
            let step = sideways.step(&hub, drive, &td);
            let seen = step.motion(forces[1].now);
            let velocity = -seen.momentum / (seen.inertia * seen.gain + CREEP);
            let force = -CREEP * velocity;
            let on_hub = step.advance(force, &td, &mut hub);
            assert!((hub.now - velocity).abs() < 1e-12 * (1.0 + velocity.abs()));
            // `rate` holds the impulse of the step before.
            for (history, now) in forces.iter_mut().zip([on_hub, force]) {
                *history = History { now, before: 0.0, rate: td.impulse(now, history.now, history.rate) };
                impulse += history.rate;
            }
        }
        assert!((impulse - sideways.mass * hub.now).abs() < 1e-9 * sideways.mass * hub.now, "{impulse}");
        let held = sideways.step(&hub, AxisDrive::Prescribed { target: 0.1 }, &formula(1e-3, 0.0));
        assert_eq!(held.motion(1e4).target(), Some(0.1));
    }
}
