//! Brakes of the rigid motions: dry friction beside the force that drives an axis, one more pair of stick and slip.
//!
//! With the speed `v` of the axis at the end of the step and the force `b` of the brake, `|b| ≤ L` and `b = −L sign v`
//! where the axis moves. A holding brake has the row `v = 0` instead of the balance of the axis, which then gives `b`; a
//! slipping one has the balance with the known force. A brake that holds slips where more than `L` is needed to hold it; one
//! whose force no longer opposes the motion holds, so that a reversal passes through rest.

use super::iterate::Iterate;
use super::rows::AffineRow;
use crate::contact::line::state::Status;
use crate::contact::problem::{AxisDrive, ContactProblem};

/// States of the brakes at which the search begins: those of the motions that are expected.
pub(super) fn founding_brakes(problem: &ContactProblem) -> [Status; 3] {
    problem.rigid.map(|motion| match motion.guess {
        speed if speed > 0.0 => Status::SlipBackward,
        speed if speed < 0.0 => Status::SlipForward,
        _ => Status::Stick,
    })
}

impl Iterate<'_> {
    /// Whether a brake holds an axis at rest.
    pub(super) fn holds(&self, axis: usize) -> bool {
        matches!((self.problem.rigid[axis].drive, self.brakes[axis]), (AxisDrive::Braked { .. }, Status::Stick))
    }

    /// The equation of an unknown motion: its balance, or rest where a brake holds it. Writes the coefficients of all port
    /// forces to `forces`.
    pub(super) fn axis_row(&self, axis: usize, forces: &mut [f64]) -> AffineRow {
        if self.holds(axis) {
            forces.fill(0.0);
            return AffineRow { rigid: std::array::from_fn(|k| if k == axis { 1.0 } else { 0.0 }), constant: 0.0 };
        }
        let [load, limit] = self.problem.rigid[axis].drive.loads().unwrap_or_default();
        self.balance_row(axis, load + self.brakes[axis].friction_direction() * limit, forces)
    }

    /// New states of the brakes from motions and reactions; returns whether any changed. A brake keeps its hold within a
    /// `tolerance` [N/m], at the rim.
    pub(super) fn update_brakes(&mut self, tolerance: f64) -> bool {
        let mut changed = false;
        for axis in 0..3 {
            let AxisDrive::Braked { load, limit } = self.problem.rigid[axis].drive else { continue };
            let arm = if axis == 2 { self.problem.radius() } else { 1.0 };
            let (old, speed) = (self.brakes[axis], self.traction.rigid[axis]);
            let new = match old {
                Status::Stick => match self.reaction(axis) - load {
                    held if held.abs() <= limit + tolerance * arm => Status::Stick,
                    held if held > 0.0 => Status::SlipForward,
                    _ => Status::SlipBackward,
                },
                slipping if slipping.friction_direction() * speed > 0.0 => Status::Stick,
                slipping => slipping,
            };
            changed |= new != old;
            self.brakes[axis] = new;
        }
        changed
    }

    /// Force [N/m] or moment [N] that the motion of an axis takes in the present iterate.
    fn reaction(&mut self, axis: usize) -> f64 {
        let mut forces = std::mem::take(&mut self.scratch.row);
        let row = self.balance_row(axis, 0.0, &mut forces);
        let of_contact: f64 = forces.iter().zip(self.traction.port_forces.iter()).map(|(c, f)| c * f).sum();
        let of_motion: f64 = row.rigid.iter().zip(self.traction.rigid).map(|(c, v)| c * v).sum();
        self.scratch.row = forces;
        of_contact + of_motion + row.constant
    }
}
