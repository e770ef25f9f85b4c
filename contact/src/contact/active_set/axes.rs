//! Rigid axes of the wheel: their balances, and the motions that are sought.

use crate::axes::{Axis, PerAxis};
use crate::contact::brake::{self, BrakeState};
use crate::contact::line::contact_line::ContactLine;
use crate::contact::problem::{AxisDrive, RigidMotion};
use crate::linalg::POINTS;

/// The rigid motions, and the states of their brakes.
pub(super) struct Axes<'a> {
    rigid: &'a PerAxis<RigidMotion>,
    /// States of the brakes; without meaning where there is none.
    brakes: PerAxis<BrakeState>,
}

/// The balance of an axis without its coefficients of the lines' own forces.
#[derive(Clone, Copy, Debug)]
pub(super) struct Equation {
    /// Coefficients of the forces of all lines on the ports.
    pub ports: [f64; 2 * POINTS],
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
    /// within a `tolerance` [N/m], at the rim.
    pub fn update_brakes(&mut self, lines: &[ContactLine], tolerance: f64) -> bool {
        let mut changed = false;
        for axis in Axis::ALL {
            let AxisDrive::Braked { load, limit } = self.rigid[axis].drive else { continue };
            let Some(first) = lines.first() else { continue };
            let (before, speed) = (self.brakes[axis], first.traction.rigid[axis]);
            let reaction = || self.reaction(axis, lines);
            let new = brake::next(before, [load, limit], reaction, speed, tolerance * axis.arm(first.problem.radius()));
            changed |= new != before;
            self.brakes[axis] = new;
        }
        changed
    }

    /// Acceleration of a motion by the motion itself, if it is sought [1/s]; zero otherwise.
    pub fn gain(&self, axis: Axis) -> f64 {
        if self.seeks(axis) { self.rigid[axis].gain } else { 0.0 }
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

    /// Accelerations of the motions by the motions themselves, see [`Self::gain`].
    pub fn gains(&self) -> PerAxis<f64> {
        PerAxis::from_fn(|axis| self.gain(axis))
    }

    /// Equation of a motion that is sought: its balance, or rest where a brake holds it.
    pub fn row(&self, axis: Axis, lines: &[ContactLine]) -> Equation {
        if self.holds(axis) {
            return Equation { ports: [0.0; _], motions: PerAxis::unit(axis), constant: 0.0 };
        }
        let [load, limit] = self.rigid[axis].drive.loads().unwrap_or_default();
        self.balance(axis, load + self.brakes[axis].direction() * limit, lines)
    }

    /// Balance of momentum of an axis under an external `load`, to which every line adds its
    /// [`pull_of_forces`](ContactLine::pull_of_forces), by its share of the width.
    fn balance(&self, axis: Axis, load: f64, lines: &[ContactLine]) -> Equation {
        let own = &self.rigid[axis];
        let mut equation = Equation { ports: [0.0; _], motions: PerAxis::default(), constant: own.momentum - load };
        let Some(first) = lines.first() else { return equation };
        let bodies = &first.problem.bodies;
        equation.ports = std::array::from_fn(|port| bodies.momentum[(axis.number(), port)]);
        let pulls = first.iterate.all.pull.iter().zip(&equation.ports);
        equation.constant += pulls.map(|(pull, momentum)| pull * momentum).sum::<f64>();
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
    /// held.
    pub fn missing_moment(&self, lines: &[ContactLine]) -> f64 {
        let axis = Axis::Rotation;
        if !self.seeks(axis) || self.holds(axis) {
            return 0.0;
        }
        let [load, limit] = self.rigid[axis].drive.loads().unwrap_or_default();
        self.reaction(axis, lines) - load - self.brakes[axis].direction() * limit
    }

    /// Force [N/m] or moment \[N] that the motion of an axis takes in the present iterate.
    fn reaction(&self, axis: Axis, lines: &[ContactLine]) -> f64 {
        self.value((axis, true), &self.balance(axis, 0.0, lines), lines)
    }

    /// Value of an equation of an axis in the present iterate, with the forces of all lines where it is that of its `balance`.
    fn value(&self, (axis, balance): (Axis, bool), equation: &Equation, lines: &[ContactLine]) -> f64 {
        let Some(first) = lines.first() else { return equation.constant };
        let of_line = |line: &ContactLine| {
            let of_node = |i: usize| {
                let (normal, shear) = line.pull_of_forces(axis, i);
                let of_shear = shear.iter().zip(line.shear(i)).map(|(by, force)| by * force).sum::<f64>();
                normal * line.normal(i) + of_shear
            };
            line.problem.share * line.loaded().map(of_node).sum::<f64>()
        };
        let of_forces = if balance { lines.iter().map(of_line).sum() } else { 0.0 };
        let of_ports: f64 = equation.ports.iter().zip(first.iterate.all.contact.iter()).map(|(by, f)| by * f).sum();
        of_forces + of_ports + equation.motions.dot(first.traction.rigid) + equation.constant
    }
}
