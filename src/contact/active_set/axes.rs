//! Rigid axes of the wheel: their balances, and the motions that are sought.

use crate::axes::{Axis, PerAxis};
use crate::contact::brake::{self, BrakeState};
use crate::contact::line::contact_line::ContactLine;
use crate::contact::line::rows::AffineRow;
use crate::contact::problem::{AxisDrive, RigidMotion};

/// The rigid motions, and the states of their brakes.
pub(super) struct Axes<'a> {
    rigid: &'a PerAxis<RigidMotion>,
    /// States of the brakes; without meaning where there is none.
    brakes: PerAxis<BrakeState>,
}

/// A linear equation without its coefficients of the port forces, which stand beside it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Equation {
    /// Coefficients of the rigid motions.
    pub motions: PerAxis<f64>,
    /// Constant, motions apart.
    pub constant: f64,
}

impl<'a> Axes<'a> {
    /// Axes whose brakes are in the states of the motions that are expected.
    pub fn new(rigid: &'a PerAxis<RigidMotion>) -> Self {
        Self { rigid, brakes: brake::founding(rigid) }
    }

    /// True if a brake holds an axis at rest.
    pub fn holds(&self, axis: Axis) -> bool {
        matches!((self.rigid[axis].drive, self.brakes[axis]), (AxisDrive::Braked { .. }, BrakeState::Holding))
    }

    /// Takes new states of the brakes from motions and reactions; returns whether any changed. A brake keeps its hold
    /// within a `tolerance` [N/m], at the rim; `forces` is memory for all ports of all lines.
    pub fn update_brakes(&mut self, lines: &[ContactLine], forces: &mut [Vec<f64>], tolerance: f64) -> bool {
        let mut changed = false;
        for axis in Axis::ALL {
            let AxisDrive::Braked { load, limit } = self.rigid[axis].drive else { continue };
            let Some(first) = lines.first() else { continue };
            let (before, speed) = (self.brakes[axis], first.traction.rigid[axis]);
            let reaction = || self.reaction(axis, lines, forces);
            let new = brake::next(before, [load, limit], reaction, speed, tolerance * axis.arm(first.problem.radius()));
            changed |= new != before;
            self.brakes[axis] = new;
        }
        changed
    }

    /// True if the motion of an axis is sought.
    pub fn seeks(&self, axis: Axis) -> bool {
        self.rigid[axis].target().is_none()
    }

    /// Axes whose motions are sought; the height of the hub comes last.
    pub fn sought(&self) -> impl Iterator<Item = Axis> {
        Axis::along().chain([Axis::Height]).filter(|&axis| self.seeks(axis))
    }

    /// Accelerations that belong to `motions`, of the axes whose motions are sought.
    pub fn sought_accelerations(&self, motions: PerAxis<f64>) -> PerAxis<Option<f64>> {
        PerAxis::from_fn(|axis| self.seeks(axis).then(|| self.rigid[axis].gain * motions[axis]))
    }

    /// A row of the line, set to zero, as an equation: accelerations that are sought follow from the motions.
    pub fn equation(&self, row: AffineRow) -> Equation {
        let mut motions = row.motions;
        for axis in Axis::ALL.into_iter().filter(|&axis| self.seeks(axis)) {
            motions[axis] += self.rigid[axis].gain * row.accelerations[axis];
        }
        Equation { motions, constant: row.constant }
    }

    /// Equation of a motion that is sought: its balance, or rest where a brake holds it. Writes the coefficients of all
    /// port forces of every line to `forces`.
    pub fn row(&self, axis: Axis, lines: &[ContactLine], forces: &mut [Vec<f64>]) -> Equation {
        if self.holds(axis) {
            forces.iter_mut().for_each(|forces| forces.fill(0.0));
            return Equation { motions: PerAxis::unit(axis), constant: 0.0 };
        }
        let [load, limit] = self.rigid[axis].drive.loads().unwrap_or_default();
        self.balance(axis, load + self.brakes[axis].direction() * limit, lines, forces)
    }

    /// Balance of momentum of an axis under an external `load`; lever arms are those of the present iterate. Writes the
    /// coefficients of all port forces of every line to `forces`.
    fn balance(&self, axis: Axis, load: f64, lines: &[ContactLine], forces: &mut [Vec<f64>]) -> Equation {
        let own = &self.rigid[axis];
        let mut equation = Equation { motions: PerAxis::default(), constant: own.momentum - load };
        for (line, forces) in lines.iter().zip(forces) {
            add_line(axis, line, forces, &mut equation.constant);
        }
        let Some(bodies) = lines.first().map(|line| &line.problem.bodies) else { return equation };
        for (other, motion) in self.rigid.iter() {
            let of_deformation = bodies.deformation_inertia[(axis.number(), other.number())];
            let inertia = of_deformation + if other == axis { own.inertia } else { 0.0 };
            equation.constant += inertia * motion.known_acceleration();
            if motion.target().is_none() {
                equation.motions[other] = inertia * motion.gain;
            }
        }
        equation
    }

    /// Moment \[N] that is missing from the balance of the rotation in the present iterate; 0 where it is prescribed or
    /// held. `forces` is memory for all ports of all lines.
    pub fn missing_moment(&self, lines: &[ContactLine], forces: &mut [Vec<f64>]) -> f64 {
        let axis = Axis::Rotation;
        if !self.seeks(axis) || self.holds(axis) {
            return 0.0;
        }
        let [load, limit] = self.rigid[axis].drive.loads().unwrap_or_default();
        self.reaction(axis, lines, forces) - load - self.brakes[axis].direction() * limit
    }

    /// Force [N/m] or moment \[N] that the motion of an axis takes in the present iterate; `forces` is memory for all
    /// ports of all lines.
    fn reaction(&self, axis: Axis, lines: &[ContactLine], forces: &mut [Vec<f64>]) -> f64 {
        let balance = self.balance(axis, 0.0, lines, forces);
        let (mut of_contact, mut motions) = (0.0, PerAxis::default());
        for (line, forces) in lines.iter().zip(forces) {
            of_contact += forces.iter().zip(line.traction.port_forces.iter()).map(|(c, f)| c * f).sum::<f64>();
            motions = line.traction.rigid;
        }
        of_contact + balance.motions.dot(motions) + balance.constant
    }
}

/// Adds a line to the balance of an axis, by its share of the width: writes the coefficients of its port forces to
/// `forces` and adds to the `constant`, in which its lateral forces are.
fn add_line(axis: Axis, line: &ContactLine, forces: &mut [f64], constant: &mut f64) {
    let (grid, bodies, share) = (line.grid, &line.problem.bodies, line.problem.share);
    let columns = bodies.momentum.as_slice().chunks_exact(bodies.momentum.nrows());
    forces.iter_mut().zip(columns).for_each(|(force, momentum)| *force = momentum[axis.number()]);
    // Open nodes without forces neither are unknown nor act on the hub.
    for i in (0..grid.len()).filter(|&i| line.state.status[i].is_active() || line.is_loaded(i)) {
        let port = grid.port(i);
        match axis {
            Axis::Travel => {
                forces[port] -= 1.0;
                forces[port + 1] -= line.slopes().rail(i);
            }
            Axis::Height => forces[port + 1] -= 1.0,
            Axis::Lateral => *constant -= share * line.lateral(i),
            Axis::Rotation => {
                let [arm_t, arm_n] = line.lever_arms(i);
                forces[port] += arm_t;
                forces[port + 1] += arm_n;
            }
        }
    }
    if axis == Axis::Rotation {
        *constant += share * (line.problem.radius() * line.iterate.retarded.force.iter().sum::<f64>());
    }
    for (i, pull) in line.given.layers.pull[0].iter().enumerate() {
        *constant += share * (bodies.momentum[(axis.number(), grid.port(i))] * pull);
    }
    if share != 1.0 {
        forces.iter_mut().for_each(|force| *force *= share);
    }
}
