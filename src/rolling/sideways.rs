//! Sideways motion of the wheel: its hub, and what yields between hub, contact and track.
//!
//! The plane bodies do not move sideways. In their place the tread stands beside the hub, and the head of the rail beside
//! the track, on a spring with a damper and a mass of its own; without a spring they are rigid. The lateral force F of the contact on
//! the wheel moves the hub (velocity V), the tread against it (`u_w`) and the head (`u_r`):
//!
//! `M V̇ + m_w u̇_w = L + F`, `m_w (V̇ + u̇_w) + d_w u_w + k_w q_w = F`, `m_r u̇_r + d_r u_r + k_r q_r = −F`
//!
//! with the mass M of all that moves with the hub, the tread included, and the force L on it. In a step all rates are linear in the
//! velocities, so that the contact sees one mass: its lateral velocity `V + u_w − u_r` is linear in F. Derivation:
//! `docs/theory/sideways.md`. Per metre of width.

use super::control::{Drive, Inputs};
use super::error::StepError;
use crate::config::{Config, display_number};
use crate::contact::{AxisDrive, RigidMotion};
use crate::multistep::{History, TimeDerivative};
use serde::{Deserialize, Serialize};

/// Deflections of tread and rail head.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SideMotion {
    /// Displacements from where they are without force \[m].
    pub deflection: [History; 2],
    /// Their rates [m/s].
    pub velocity: [History; 2],
}

impl SideMotion {
    /// Velocities of tread against hub and of the rail head [m/s].
    pub fn velocities(&self) -> [f64; 2] {
        self.velocity.map(|velocity| velocity.now)
    }
}

/// Spring with damper and mass between the contact and what carries it; all zero: rigid.
#[derive(Clone, Copy, Debug, Default)]
struct Mount {
    /// [N/m per m].
    stiffness: f64,
    /// [N s/m per m].
    damping: f64,
    /// [kg/m].
    mass: f64,
}

/// Hub, tread and rail head that carry the contact sideways.
#[derive(Clone, Copy, Debug)]
pub struct Sideways {
    /// True if the contact has two directions.
    pub enabled: bool,
    /// Mass that moves with the hub, that of the tread included [kg/m].
    mass: f64,
    /// Of the tread on the hub, and of the rail head.
    mounts: [Mount; 2],
}

impl Sideways {
    /// From the parameters; `mass` is that of all that moves with the hub [kg/m].
    pub fn new(config: &Config, mass: f64) -> Self {
        let (wheel, rail, width) = (&config.wheel, &config.rail, config.width());
        let mount = |stiffness: f64, damping: f64, mass: f64| match config.contact.lateral && stiffness > 0.0 {
            true => Mount { stiffness: stiffness / width, damping: damping / width, mass: mass / width },
            false => Mount::default(),
        };
        let tread = mount(wheel.lateral_stiffness, wheel.lateral_damping, wheel.lateral_tread_mass);
        let head = mount(rail.lateral_stiffness, rail.lateral_damping, rail.lateral_mass);
        Self { enabled: config.contact.lateral, mass, mounts: [tread, head] }
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

    /// Step from a hub with the lateral velocity `hub` and deflections `motion` under a `drive`.
    pub fn step(&self, hub: &History, motion: &SideMotion, drive: AxisDrive, td: &TimeDerivative) -> SideStep {
        let known = |k: usize| {
            let Mount { stiffness, damping, mass } = self.mounts[k];
            let (of_deflection, of_velocity) = (motion.deflection[k].offset(td), motion.velocity[k].offset(td));
            MountAnswer {
                mass,
                compliance: match stiffness > 0.0 {
                    true => 1.0 / (mass * td.a0 + damping + stiffness / td.a0),
                    false => 0.0,
                },
                known: mass * of_velocity - stiffness * of_deflection / td.a0,
                offset: of_velocity,
            }
        };
        SideStep { a0: td.a0, mass: self.mass, offset: hub.offset(td), drive, answers: [known(0), known(1)] }
    }

    /// Kinetic energy of tread and rail head beyond that which moves with the hub at the velocity `hub` [m/s], and elastic
    /// energy of both springs [J/m].
    pub fn energy(&self, hub: f64, motion: &SideMotion) -> f64 {
        let carried = [hub, 0.0];
        let of = |k: usize| {
            let (Mount { stiffness, mass, .. }, velocity) = (self.mounts[k], motion.velocity[k].now);
            mass * velocity * (carried[k] + 0.5 * velocity) + 0.5 * stiffness * motion.deflection[k].now.powi(2)
        };
        of(0) + of(1)
    }

    /// Power that both dampers take [W/m].
    pub fn dissipation(&self, motion: &SideMotion) -> f64 {
        self.mounts.iter().zip(motion.velocities()).map(|(mount, velocity)| mount.damping * velocity * velocity).sum()
    }

    /// Deflections at rest under the lateral `force` of the contact on the wheel [N/m].
    pub fn at_rest(&self, force: f64) -> SideMotion {
        let of = |mount: Mount, force: f64| if mount.stiffness > 0.0 { force / mount.stiffness } else { 0.0 };
        let deflection = [of(self.mounts[0], force), of(self.mounts[1], -force)].map(History::constant);
        SideMotion { deflection, ..SideMotion::default() }
    }
}

/// Answer of a mount in a step: `m u̇ + d u + k q = u/compliance + known`, `u̇ = a0 u + offset`.
#[derive(Clone, Copy)]
struct MountAnswer {
    mass: f64,
    /// Zero if it is rigid.
    compliance: f64,
    known: f64,
    offset: f64,
}

/// Sideways motion in one step as a function of the lateral force of the contact.
pub struct SideStep {
    a0: f64,
    mass: f64,
    /// Known part of the acceleration of the hub [m/s²].
    offset: f64,
    drive: AxisDrive,
    answers: [MountAnswer; 2],
}

/// Velocities at the end of a step [m/s].
#[derive(Clone, Copy)]
struct Velocities {
    hub: f64,
    mounts: [f64; 2],
}

impl SideStep {
    /// Velocities under the lateral force of the contact on the wheel [N/m].
    fn under(&self, force: f64) -> Velocities {
        let (a0, [tread, head]) = (self.a0, &self.answers);
        let yielding = tread.mass * tread.compliance;
        let acceleration = match self.drive {
            AxisDrive::Prescribed { target } => a0 * target + self.offset,
            AxisDrive::Free { load } | AxisDrive::Braked { load, .. } => {
                let left = load + force - tread.mass * tread.offset - a0 * yielding * (force - tread.known);
                left / (self.mass - tread.mass * a0 * yielding)
            }
        };
        let hub = match self.drive {
            AxisDrive::Prescribed { target } => target,
            AxisDrive::Free { .. } | AxisDrive::Braked { .. } => (acceleration - self.offset) / a0,
        };
        let of_tread = tread.compliance * (force - tread.known - tread.mass * acceleration);
        Velocities { hub, mounts: [of_tread, -head.compliance * (force + head.known)] }
    }

    /// Change of the lateral velocity of the contact with its force [m/s per N/m].
    fn mobility(&self) -> f64 {
        let [tread, head] = &self.answers;
        let yielding = tread.mass * tread.compliance;
        let of_hub = match self.drive {
            AxisDrive::Prescribed { .. } => 0.0,
            AxisDrive::Free { .. } | AxisDrive::Braked { .. } => {
                (1.0 - self.a0 * yielding) / (self.mass - tread.mass * self.a0 * yielding)
            }
        };
        of_hub / self.a0 + tread.compliance * (1.0 - tread.mass * of_hub) + head.compliance
    }

    /// Lateral motion as the contact sees it: prescribed where nothing yields, or that of one mass. `force` is the one of the
    /// step before [N/m].
    pub fn motion(&self, force: f64) -> RigidMotion {
        let velocity = |force: f64| {
            let Velocities { hub, mounts } = self.under(force);
            hub + mounts[0] - mounts[1]
        };
        let mobility = self.mobility();
        if mobility == 0.0 {
            return RigidMotion::held(velocity(0.0), 0.0);
        }
        RigidMotion {
            drive: AxisDrive::Free { load: 0.0 },
            guess: velocity(force),
            gain: self.a0,
            offset: 0.0,
            inertia: 1.0 / (mobility * self.a0),
            momentum: -velocity(0.0) / mobility,
        }
    }

    /// Brings hub and deflections to the end of the step under the lateral `force` of the contact [N/m]. Returns the
    /// force on the hub [N/m].
    pub fn advance(&self, force: f64, td: &TimeDerivative, hub: &mut History, motion: &mut SideMotion) -> f64 {
        let velocities = self.under(force);
        hub.push(td, velocities.hub);
        for (k, velocity) in velocities.mounts.into_iter().enumerate() {
            if self.answers[k].compliance > 0.0 {
                let deflection = (velocity - motion.deflection[k].offset(td)) / td.a0;
                motion.deflection[k].push(td, deflection);
                motion.velocity[k].push(td, velocity);
            }
        }
        self.mass * hub.rate + self.answers[0].mass * motion.velocity[0].rate - force
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::multistep::formula;

    /// Contact that resists with this force over its lateral velocity [N s/m per m].
    const CREEP: f64 = 3e5;

    fn yielding() -> Sideways {
        let mount = |stiffness, damping, mass| Mount { stiffness, damping, mass };
        Sideways { enabled: true, mass: 4e3, mounts: [mount(2e9, 4e4, 1e3), mount(1e9, 2e5, 1.5e3)] }
    }

    /// Balance of a run under a constant force or velocity of the hub: energy, work on the hub, losses in dampers and contact
    /// [J/m], impulse of hub and contact, and change of momentum [N s/m].
    struct RunBalance {
        energy: f64,
        work: f64,
        lost: f64,
        impulse: f64,
        momentum: f64,
        deflections: [f64; 2],
    }

    fn run(sideways: &Sideways, drive: AxisDrive, steps: usize, end: f64) -> RunBalance {
        let dt = end / steps as f64;
        let (mut hub, mut motion) = (History::constant(0.0), SideMotion::default());
        let (mut driving, mut resisting) = (History::default(), History::default());
        let (mut before, mut out) = (0.0, [0.0; 4]);
        for _ in 0..steps {
            let td = formula(dt, before);
            let step = sideways.step(&hub, &motion, drive, &td);
            let seen = step.motion(resisting.now);
            let velocity = match seen.drive {
                AxisDrive::Prescribed { target } => target,
                _ => -seen.momentum / (seen.inertia * seen.gain + CREEP),
            };
            let (force, was) = (-CREEP * velocity, hub.now);
            let on_hub = step.advance(force, &td, &mut hub, &mut motion);
            let velocities = motion.velocities();
            assert!((hub.now + velocities[0] - velocities[1] - velocity).abs() < 1e-12 * (1.0 + velocity.abs()));
            // `rate` holds the impulse of the step before.
            let impulses = [(&mut driving, on_hub), (&mut resisting, force)].map(|(history, now)| {
                let impulse = td.impulse(now, history.now, history.rate);
                *history = History { now, before: 0.0, rate: impulse };
                impulse
            });
            out[0] += 0.5 * (was + hub.now) * impulses[0];
            out[1] += dt * (sideways.dissipation(&motion) + CREEP * velocity * velocity);
            out[2] += impulses[0] + impulses[1];
            before = dt;
        }
        let [tread, _] = sideways.mounts;
        RunBalance {
            energy: 0.5 * sideways.mass * hub.now * hub.now + sideways.energy(hub.now, &motion),
            work: out[0],
            lost: out[1],
            impulse: out[2],
            momentum: sideways.mass * hub.now + tread.mass * motion.velocities()[0],
            deflections: motion.deflection.map(|deflection| deflection.now),
        }
    }

    #[test]
    fn impulses_are_the_change_of_momentum_and_work_is_energy_and_loss_to_the_order_of_the_step() {
        for drive in [AxisDrive::Free { load: 1e5 }, AxisDrive::Prescribed { target: 0.1 }] {
            let missing = |steps: usize| {
                let run = run(&yielding(), drive, steps, 0.02);
                assert!((run.impulse - run.momentum).abs() < 1e-9 * run.momentum.abs(), "{}", run.impulse);
                (run.work - run.lost - run.energy).abs() / run.work
            };
            let [coarse, fine] = [2000, 4000].map(missing);
            println!("{drive:?}: energy missed {coarse:.2e}, {fine:.2e} of the work");
            assert!(fine < 2e-3 && fine < 0.6 * coarse);
        }
    }

    #[test]
    fn a_hub_on_its_way_ends_with_the_force_that_the_contact_carries_in_both_springs() {
        let run = run(&yielding(), AxisDrive::Prescribed { target: 0.1 }, 4000, 0.4);
        let force = 0.1 * CREEP;
        for (deflection, stiffness) in run.deflections.iter().zip([2e9, -1e9]) {
            assert!((deflection * stiffness + force).abs() < 1e-3 * force, "{deflection:e}");
        }
        let rigid = Sideways { mounts: [Mount::default(); 2], ..yielding() };
        let step = rigid.step(
            &History::constant(0.1),
            &SideMotion::default(),
            AxisDrive::Prescribed { target: 0.1 },
            &formula(1e-3, 0.0),
        );
        assert_eq!(step.motion(1e4).target(), Some(0.1));
    }
}
