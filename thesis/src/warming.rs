//! Heat in time steps as \[D] § 5.3.2 computes it: backward Euler, matrices as sums with coefficients of the
//! velocities, and stabilisation that is assembled again only when a velocity has changed by a given share (\[D] §
//! 5.2.2), but for SUPG in the rail where it joins the sums (\[D] § 5.2.3). The capacity is not stabilised, as in \[D]
//! (28).

use crate::Error;
use crate::flow::Flow;
use crate::heat::{Heating, Spot};
use crate::sparse::{Factors, Matrix};
use crate::stabilise::{Scheme, split_time, stream_length};
use crate::triangle::{Space, linear_gradients, points};
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
    /// Contribution of SUPG in the rail where it is a sum, if it is one anywhere.
    split: Option<Split>,
    /// Contribution of other stabilisation, and the velocities for which it was assembled.
    stabilisation: ([f64; 2], Matrix),
    /// Relative change of a velocity that it outlasts \[1].
    tolerance: f64,
    /// Nodes that are held at the reference, in ascending order.
    fixed: Vec<usize>,
    /// Share of a watt in each arc that every node gets \[1].
    arcs: Vec<f64>,
    /// How often it was assembled.
    pub assemblies: usize,
    /// The last factors and rows of the held nodes, and what they belong to.
    kept: Option<(Key, Factors, Matrix)>,
    /// Temperatures over the reference \[K] of the wheel's nodes, then of the rail's.
    pub theta: Vec<f64>,
}

/// SUPG of the rail's elements as a sum with the coefficients 1, `|V|` and `V²`.
struct Split {
    /// Speeds for which it holds [m/s]; beyond them it is given up.
    speeds: [f64; 2],
    parts: [Matrix; 3],
    /// Which elements of the rail are in it.
    within: Vec<bool>,
}

impl Split {
    fn new(heating: &Heating, spaces: &[Space; 2], speeds: [f64; 2]) -> Self {
        let [capacity, conductivity] = heating.material;
        let (first, rail) = (spaces[0].places.len(), &spaces[1]);
        let mut parts = [0; 3].map(|_| Matrix::new(first + rail.places.len()));
        let element = |(t, nodes): (usize, &Vec<usize>)| {
            let corners = heating.meshes[1].corners(t);
            let slopes = linear_gradients(&corners);
            let factors = split_time(stream_length(&slopes, [-1.0, 0.0]), capacity, speeds, conductivity);
            let area = 0.5 * crate::mesh::double_area(&corners);
            for (part, factor) in parts.iter_mut().zip(factors.into_iter().flatten()) {
                for (row, a) in nodes.iter().zip(&slopes) {
                    for (column, b) in nodes.iter().zip(&slopes) {
                        part.add(first + row, first + column, factor * area * a[0] * b[0]);
                    }
                }
            }
            factors.is_some()
        };
        let within = rail.elements.iter().enumerate().map(element).collect();
        Self { speeds, parts: parts.map(Matrix::compressed), within }
    }

    /// Coefficients of the parts.
    fn factors(&self, velocity: f64) -> [f64; 3] {
        [1.0, velocity.abs(), velocity * velocity]
    }
}

/// Step \[s], velocities, and places in contact.
type Key = (f64, [f64; 2], Vec<Spot>);

impl<'a> Warming<'a> {
    /// Starts from temperatures over the reference \[K], or cold. Bodies, material and contact are those of `heating`;
    /// its velocities, places in contact and arcs are given anew in every step.
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
        let (split, assemblies, kept) = (None, 0, None);
        Self { heating, spaces, parts, split, stabilisation, tolerance, fixed, arcs, assemblies, kept, theta }
    }

    /// Takes SUPG of the rail into the sums, for all speeds [m/s] from the first to the second, where the half Péclet
    /// number of an element stays small or large. Other elements are assembled as before. Returns the share of the
    /// elements that need not be.
    pub fn split(&mut self, speeds: [f64; 2]) -> f64 {
        let split = Split::new(&self.heating, &self.spaces, speeds);
        let share = split.within.iter().filter(|within| **within).count() as f64 / split.within.len() as f64;
        (self.split, self.stabilisation.0) = (Some(split), [f64::NAN; 2]);
        share
    }

    /// Contribution of stabilisation that is no sum.
    fn lagging(&self, motion: [f64; 2]) -> Matrix {
        let [omega, velocity] = motion;
        let (heating, schemes) = (&self.heating, [self.heating.wheel.1, Scheme::Supg]);
        let turning = |[x, y]: [f64; 2]| [omega * y, -omega * x];
        let streaming = |_: [f64; 2]| [-velocity, 0.0];
        let flows: [&dyn Fn([f64; 2]) -> [f64; 2]; 2] = [&turning, &streaming];
        let [capacity, conductivity] = heating.material;
        heating.assemble_some(&self.spaces, |body, t, corners| {
            let within = body == 1 && self.split.as_ref().is_some_and(|split| split.within[t]);
            let flow = Flow { capacity, conductivity, velocity: flows[body], source: 0.0, degree: 5 };
            let order = self.spaces[body].order;
            let element = |scheme: Scheme| flow.element(corners, order, scheme).0;
            (!within).then(|| element(schemes[body]) - element(Scheme::Galerkin))
        })
    }

    /// Assembles the stabilisation for velocities, if one of them has left the tolerance.
    pub fn renew(&mut self, motion: [f64; 2]) {
        let [slowest, fastest] = self.split.as_ref().map_or([0.0, f64::INFINITY], |split| split.speeds);
        if !(slowest..=fastest).contains(&motion[1].abs()) {
            (self.split, self.stabilisation.0) = (None, [f64::NAN; 2]);
        }
        let of = self.stabilisation.0;
        let lasts = |k: usize| (motion[k] - of[k]).abs() <= self.tolerance * of[k].abs();
        if !(lasts(0) && lasts(1)) {
            self.stabilisation = (motion, self.lagging(motion).compressed());
            self.assemblies += 1;
        }
    }

    /// The constant matrices and their coefficients for velocities, with the stabilisation that is at hand.
    fn terms(&self, [omega, velocity]: [f64; 2]) -> Vec<(f64, &Matrix)> {
        let [still, turning, streaming, _] = &self.parts;
        let mut terms = vec![(1.0, still), (omega, turning), (velocity, streaming), (1.0, &self.stabilisation.1)];
        terms.extend(self.split.iter().flat_map(|split| split.factors(velocity).into_iter().zip(&split.parts)));
        terms
    }

    /// Conduction and convection for velocities, with the stabilisation that is at hand.
    pub fn matrix(&self, motion: [f64; 2]) -> Matrix {
        Matrix::sum(&self.terms(motion))
    }

    /// Heat that conduction and convection take from every node [W/m]: the matrix for velocities times temperatures
    /// over the reference \[K].
    pub fn flow(&self, motion: [f64; 2], theta: &[f64]) -> Vec<f64> {
        let mut flow = vec![0.0; theta.len()];
        for (factor, part) in self.terms(motion) {
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

    /// Change of the matrix with the angular velocity (0) or the velocity (1), without stabilisation (\[D] § 5.3.1).
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
