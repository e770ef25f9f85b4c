//! Heat in time steps as \[D] 5.3.2 computes it: backward Euler, matrices as sums with coefficients of the velocities, and stabilisation
//! that is assembled again only when a velocity has changed by a given share (\[D] 5.2.2). The capacity is not stabilised, as in \[D] 28.

use crate::Error;
use crate::heat::{Heating, Spot};
use crate::sparse::{Factors, Matrix};
use crate::stabilise::Scheme;
use crate::triangle::{Space, points};
use nalgebra::DMatrix;

/// Heat of a time step [W/m].
#[derive(Clone, Copy, Debug)]
pub struct Flows {
    /// Put in by the arcs and by friction.
    pub given: f64,
    /// Let in by the chords of the rims ([`Heating::let_in`]).
    pub let_in: f64,
    /// Stored.
    pub stored: f64,
    /// Through nodes at the reference.
    pub leaves: f64,
}

impl Flows {
    /// Heat that is neither stored nor has left, over the larger of what was put in and what was stored \[1].
    pub fn imbalance(&self) -> f64 {
        (self.given + self.let_in - self.stored - self.leaves).abs() / self.given.abs().max(self.stored.abs())
    }
}

/// Temperatures of wheel and rail over time.
pub struct Warming<'a> {
    /// Bodies, material and contact.
    pub heating: Heating<'a>,
    /// Nodes of wheel and rail.
    pub spaces: [Space; 2],
    /// Conduction, convection for a unit angular velocity and for a unit velocity, and heat capacity.
    parts: [Matrix; 4],
    /// What stabilisation adds, and the velocities for which it was assembled.
    stabilisation: ([f64; 2], Matrix),
    /// Relative change of a velocity that it outlasts \[1].
    tolerance: f64,
    /// Nodes that are held at the reference, in ascending order.
    fixed: Vec<usize>,
    /// What a watt in each arc gives to every node \[1].
    arcs: Vec<f64>,
    /// How often it was assembled.
    pub assemblies: usize,
    /// The last factors and rows of the held nodes, and what they belong to.
    kept: Option<(Key, Factors, Matrix)>,
    /// Temperatures over the reference \[K] of the wheel's nodes, then of the rail's.
    pub theta: Vec<f64>,
}

/// Step \[s], velocities, and places in contact.
type Key = (f64, [f64; 2], Vec<Spot>);

impl<'a> Warming<'a> {
    /// Starts from temperatures over the reference \[K], or cold. Bodies, material and contact are those of `heating`; its velocities, places
    /// in contact and arcs are given anew in every step.
    pub fn new(heating: Heating<'a>, tolerance: f64, theta: Option<Vec<f64>>) -> Self {
        let spaces = heating.spaces();
        let galerkin =
            |k: f64, motion: [f64; 2]| heating.flowing(&spaces, [Scheme::Galerkin; 2], k, motion).compressed();
        let capacity = heating.assemble(&spaces, |body, corners| capacity(heating.material[0], &spaces[body], corners));
        let still = galerkin(heating.material[1], [0.0; 2]);
        let parts = [still, galerkin(0.0, [1.0, 0.0]), galerkin(0.0, [0.0, 1.0]), capacity.compressed()];
        let theta = theta.unwrap_or_else(|| vec![0.0; parts[0].size]);
        let stabilisation = ([f64::NAN; 2], Matrix::default());
        let fixed = heating.fixed(&spaces);
        let mut arcs = vec![0.0; parts[0].size];
        Heating { arcs: 1.0, ..heating }.heat_arcs(&spaces[0], &mut arcs);
        Self { heating, spaces, parts, stabilisation, tolerance, fixed, arcs, assemblies: 0, kept: None, theta }
    }

    /// Assembles the stabilisation for velocities, if one of them has left the tolerance.
    pub fn renew(&mut self, motion: [f64; 2]) {
        let of = self.stabilisation.0;
        let lasts = |k: usize| (motion[k] - of[k]).abs() <= self.tolerance * of[k].abs();
        if !(lasts(0) && lasts(1)) {
            let heating = Heating { motion, ..self.heating };
            let plain = heating.flowing(&self.spaces, [Scheme::Galerkin; 2], heating.material[1], motion);
            let added = Matrix::sum(&[(1.0, &heating.stabilised(&self.spaces)), (-1.0, &plain)]);
            self.stabilisation = (motion, added);
            self.assemblies += 1;
        }
    }

    /// Conduction and convection for velocities, with the stabilisation that is at hand.
    pub fn matrix(&self, motion: [f64; 2]) -> Matrix {
        let [still, turning, streaming, _] = &self.parts;
        Matrix::sum(&[(1.0, still), (motion[0], turning), (motion[1], streaming), (1.0, &self.stabilisation.1)])
    }

    /// Heat that conduction and convection take from every node [W/m]: the matrix for velocities times temperatures over the reference \[K].
    pub fn flow(&self, motion: [f64; 2], theta: &[f64]) -> Vec<f64> {
        let [still, turning, streaming, _] = &self.parts;
        let mut flow = still.multiply(theta);
        for (factor, part) in [(motion[0], turning), (motion[1], streaming), (1.0, &self.stabilisation.1)] {
            flow.iter_mut().zip(part.multiply(theta)).for_each(|(flow, more)| *flow += factor * more);
        }
        flow
    }

    /// Nodes that are held at the reference, in ascending order.
    pub fn fixed(&self) -> &[usize] {
        &self.fixed
    }

    /// Heat of both arcs into every node [W/m].
    pub fn arcs(&self) -> impl Iterator<Item = f64> + '_ {
        self.arcs.iter().map(|share| self.heating.arcs * share)
    }

    /// What changes the matrix with the angular velocity (0) or the velocity (1), without stabilisation (\[D] 5.3.1).
    pub fn by_velocity(&self, k: usize) -> &Matrix {
        &self.parts[1 + k]
    }

    /// Heat capacity [J/(m K)].
    pub fn capacity(&self) -> &Matrix {
        &self.parts[3]
    }

    /// A step \[s] under velocities, places in contact and heat into each arc [W/m].
    pub fn advance(&mut self, step: f64, motion: [f64; 2], spots: &[Spot], arcs: f64) -> Result<Flows, Error> {
        let heating = Heating { motion, spots, arcs, ..self.heating };
        let first = self.spaces[0].places.len();
        let mut load = vec![0.0; self.theta.len()];
        let mut contact = Matrix::new(load.len());
        heating.exchange(first, &mut contact, &mut load);
        load.iter_mut().zip(&self.arcs).for_each(|(load, share)| *load += arcs * share);
        let given = load.iter().sum();
        let stored = self.parts[3].multiply(&self.theta);
        load.iter_mut().zip(&stored).for_each(|(load, stored)| *load += stored / step);
        let key = (step, motion, spots.iter().map(|spot| Spot { friction: 0.0, ..*spot }).collect());
        let (key, factors, rows) = match self.kept.take() {
            Some(kept) if kept.0 == key => kept,
            _ => {
                self.renew(motion);
                let linear = self.matrix(motion);
                let mut matrix = Matrix::sum(&[(1.0, &linear), (1.0, &contact), (1.0 / step, &self.parts[3])]);
                let rows = matrix.fix(&self.fixed);
                (key, matrix.factorise()?, rows)
            }
        };
        let held_load: f64 = self.fixed.iter().map(|node| std::mem::take(&mut load[*node])).sum();
        self.theta = factors.solve(load)?;
        let held: f64 = rows.multiply(&self.theta).iter().sum();
        self.kept = Some((key, factors, rows));
        let change = self.parts[3].multiply(&self.theta).iter().sum::<f64>() - stored.iter().sum::<f64>();
        let let_in = heating.let_in(&self.spaces[0], &self.theta[..first]);
        Ok(Flows { given, let_in, stored: change / step, leaves: held_load - held })
    }

    /// Mean temperatures of wheel and rail over the reference \[K].
    pub fn means(&self) -> [f64; 2] {
        self.heating.means(&self.spaces, &self.theta)
    }
}

/// `ρc ∫ N N` of a triangle [J/(m K)].
fn capacity(capacity: f64, space: &Space, corners: &[[f64; 2]; 3]) -> DMatrix<f64> {
    let n = space.order.count();
    let mut matrix = DMatrix::zeros(n, n);
    for point in points(corners, space.order) {
        let values = point.shape.values;
        matrix += DMatrix::from_fn(n, n, |i, j| capacity * point.weight * values[i] * values[j]);
    }
    matrix
}
