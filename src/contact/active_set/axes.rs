//! Rigid axes of the wheel: their balances, and the motions that are sought.

use crate::contact::brake::{self, BrakeState};
use crate::contact::line::contact_line::ContactLine;
use crate::contact::line::rows::AffineRow;
use crate::contact::problem::{AxisDrive, RigidMotion};

/// The three rigid motions, and the states of their brakes.
pub(super) struct Axes<'a> {
    rigid: &'a [RigidMotion; 3],
    /// States of the brakes; without meaning where there is none.
    brakes: [BrakeState; 3],
}

/// A linear equation without its coefficients of the port forces, which stand beside it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Equation {
    /// Coefficients of the rigid motions V, U, Ω.
    pub motions: [f64; 3],
    /// Constant, prescribed motions apart.
    pub constant: f64,
}

impl<'a> Axes<'a> {
    /// Axes whose brakes are in the states of the motions that are expected.
    pub fn new(rigid: &'a [RigidMotion; 3]) -> Self {
        Self { rigid, brakes: brake::founding(rigid) }
    }

    /// True if a brake holds an axis at rest.
    pub fn holds(&self, axis: usize) -> bool {
        matches!((self.rigid[axis].drive, self.brakes[axis]), (AxisDrive::Braked { .. }, BrakeState::Holding))
    }

    /// Takes new states of the brakes from motions and reactions; returns whether any changed. A brake keeps its hold
    /// within a `tolerance` [N/m], at the rim; `forces` is memory for all ports of all lines.
    pub fn update_brakes(&mut self, lines: &[ContactLine], forces: &mut [Vec<f64>], tolerance: f64) -> bool {
        let mut changed = false;
        for axis in 0..3 {
            let AxisDrive::Braked { load, limit } = self.rigid[axis].drive else { continue };
            let Some(first) = lines.first() else { continue };
            let arm = if axis == 2 { first.problem.radius() } else { 1.0 };
            let (before, speed) = (self.brakes[axis], first.traction.rigid[axis]);
            let reaction = || self.reaction(axis, lines, forces);
            let new = brake::next(before, [load, limit], reaction, speed, tolerance * arm);
            changed |= new != before;
            self.brakes[axis] = new;
        }
        changed
    }

    /// True if the motion of an axis is sought.
    pub fn seeks(&self, axis: usize) -> bool {
        self.rigid[axis].target().is_none()
    }

    /// Axes whose motions are sought; the height of the hub comes last.
    pub fn sought(&self) -> impl Iterator<Item = usize> {
        [0, 2, 1].into_iter().filter(|&axis| self.seeks(axis))
    }

    /// Accelerations that belong to `motions`, of the axes whose motions are sought.
    pub fn sought_accelerations(&self, motions: [f64; 3]) -> [Option<f64>; 3] {
        std::array::from_fn(|k| self.seeks(k).then(|| self.rigid[k].gain * motions[k]))
    }

    /// A row of the line, set to zero, as an equation: accelerations that are sought follow from the motions.
    pub fn equation(&self, row: AffineRow) -> Equation {
        let mut motions = row.motions;
        for (k, motion) in self.rigid.iter().enumerate() {
            if motion.target().is_none() {
                motions[k] += motion.gain * row.accelerations[k];
            }
        }
        Equation { motions, constant: row.constant }
    }

    /// Constant of an equation with the prescribed motions.
    pub fn constant(&self, equation: &Equation) -> f64 {
        let prescribed =
            self.rigid.iter().zip(equation.motions).map(|(motion, by)| by * motion.target().unwrap_or(0.0));
        equation.constant + prescribed.sum::<f64>()
    }

    /// Equation of a motion that is sought: its balance, or rest where a brake holds it. Writes the coefficients of all
    /// port forces of every line to `forces`.
    pub fn row(&self, axis: usize, lines: &[ContactLine], forces: &mut [Vec<f64>]) -> Equation {
        if self.holds(axis) {
            forces.iter_mut().for_each(|forces| forces.fill(0.0));
            return Equation { motions: std::array::from_fn(|k| if k == axis { 1.0 } else { 0.0 }), constant: 0.0 };
        }
        let [load, limit] = self.rigid[axis].drive.loads().unwrap_or_default();
        self.balance(axis, load + self.brakes[axis].direction() * limit, lines, forces)
    }

    /// Balance of momentum of an axis under an external `load`; lever arms are those of the present iterate. Writes the
    /// coefficients of all port forces of every line to `forces`.
    fn balance(&self, axis: usize, load: f64, lines: &[ContactLine], forces: &mut [Vec<f64>]) -> Equation {
        let own = &self.rigid[axis];
        let mut equation = Equation { motions: [0.0; 3], constant: own.momentum - load };
        for (line, forces) in lines.iter().zip(forces) {
            add_line(axis, line, forces, &mut equation.constant);
        }
        let Some(bodies) = lines.first().map(|line| &line.problem.bodies) else { return equation };
        for (l, motion) in self.rigid.iter().enumerate() {
            let inertia = bodies.deformation_inertia[(axis, l)] + if l == axis { own.inertia } else { 0.0 };
            equation.constant += inertia * motion.known_acceleration();
            if motion.target().is_none() {
                equation.motions[l] = inertia * motion.gain;
            }
        }
        equation
    }

    /// Moment \[N] that is missing from the balance of the rotation in the present iterate; 0 where it is prescribed or held.
    /// `forces` is memory for all ports of all lines.
    pub fn missing_moment(&self, lines: &[ContactLine], forces: &mut [Vec<f64>]) -> f64 {
        if !self.seeks(2) || self.holds(2) {
            return 0.0;
        }
        let [load, limit] = self.rigid[2].drive.loads().unwrap_or_default();
        self.reaction(2, lines, forces) - load - self.brakes[2].direction() * limit
    }

    /// Force [N/m] or moment \[N] that the motion of an axis takes in the present iterate; `forces` is memory for all
    /// ports of all lines.
    fn reaction(&self, axis: usize, lines: &[ContactLine], forces: &mut [Vec<f64>]) -> f64 {
        let balance = self.balance(axis, 0.0, lines, forces);
        let (mut of_contact, mut motions) = (0.0, [0.0; 3]);
        for (line, forces) in lines.iter().zip(forces) {
            of_contact += forces.iter().zip(line.traction.port_forces.iter()).map(|(c, f)| c * f).sum::<f64>();
            motions = line.traction.rigid;
        }
        let of_motion: f64 = balance.motions.iter().zip(motions).map(|(c, v)| c * v).sum();
        of_contact + of_motion + balance.constant
    }
}

/// Adds a line to the balance of an axis, by its share of the width: writes the coefficients of its port forces to
/// `forces` and adds to the `constant`.
fn add_line(axis: usize, line: &ContactLine, forces: &mut [f64], constant: &mut f64) {
    let (grid, bodies, share) = (line.grid, &line.problem.bodies, line.problem.share);
    forces.iter_mut().zip(bodies.momentum.row(axis).iter()).for_each(|(f, m)| *f = *m);
    for i in 0..grid.len() {
        let port = grid.port(i);
        match axis {
            0 => {
                forces[port] -= 1.0;
                forces[port + 1] -= line.slopes().rail(i);
            }
            1 => forces[port + 1] -= 1.0,
            _ => {
                let [arm_t, arm_n] = line.lever_arms(i);
                forces[port] += arm_t;
                forces[port + 1] += arm_n;
            }
        }
    }
    let relief = if axis == 2 { line.problem.radius() * line.retarded.force.iter().sum::<f64>() } else { 0.0 };
    *constant += share * relief;
    for (i, pull) in line.given.layers.pull[0].iter().enumerate() {
        *constant += share * (bodies.momentum[(axis, grid.port(i))] * pull);
    }
    if share != 1.0 {
        forces.iter_mut().for_each(|force| *force *= share);
    }
}
