//! Brakes of the rigid motions: dry friction beside the force that drives an axis, one more pair of stick and slip.
//!
//! With the speed `v` of the axis at the end of the step and the force `b` of the brake, `|b| ≤ L` and `b = −L sign v`
//! where the axis moves. A holding brake has the row `v = 0` instead of the balance of the axis, which then gives `b`;
//! a slipping one has the balance with the known force. A brake that holds slips where more than `L` is needed to hold
//! it; one whose force no longer opposes the motion holds, so that a reversal passes through rest.

use super::axes::Axes;
use crate::contact::line::contact_line::ContactLine;
use crate::contact::line::state::NodeStatus;
use crate::contact::problem::{AxisDrive, RigidMotion};

impl<'a> Axes<'a> {
    /// Axes whose brakes are in the states of the motions that are expected.
    pub fn new(rigid: &'a [RigidMotion; 3]) -> Self {
        let brakes = rigid.map(|motion| match motion.guess {
            speed if speed > 0.0 => NodeStatus::SlipBackward,
            speed if speed < 0.0 => NodeStatus::SlipForward,
            _ => NodeStatus::Stick,
        });
        Self { rigid, brakes }
    }

    /// True if a brake holds an axis at rest.
    pub fn holds(&self, axis: usize) -> bool {
        matches!((self.rigid[axis].drive, self.brakes[axis]), (AxisDrive::Braked { .. }, NodeStatus::Stick))
    }

    /// Takes new states of the brakes from motions and reactions; returns whether any changed. A brake keeps its hold
    /// within a `tolerance` [N/m], at the rim; `forces` is memory for all ports.
    pub fn update_brakes(&mut self, line: &ContactLine, forces: &mut [f64], tolerance: f64) -> bool {
        let mut changed = false;
        for axis in 0..3 {
            let AxisDrive::Braked { load, limit } = self.rigid[axis].drive else { continue };
            let arm = if axis == 2 { line.problem.radius() } else { 1.0 };
            let (old, speed) = (self.brakes[axis], line.traction.rigid[axis]);
            let new = match old {
                NodeStatus::Stick => match self.reaction(axis, line, forces) - load {
                    held if held.abs() <= limit + tolerance * arm => NodeStatus::Stick,
                    held if held > 0.0 => NodeStatus::SlipForward,
                    _ => NodeStatus::SlipBackward,
                },
                slipping if slipping.friction_direction() * speed > 0.0 => NodeStatus::Stick,
                slipping => slipping,
            };
            changed |= new != old;
            self.brakes[axis] = new;
        }
        changed
    }
}
