//! Rolling in time as \[A] §§ 2 and 3 compute it: linear triangles, no friction, Lagrange multipliers on the nodes of
//! the tread, an irregular profile as offset of the gaps, Rayleigh damping, free or non-reflecting ends, one θ scheme.
//!
//! Velocities are prescribed and constant, so that all matrices are: they are factorised once, and a step is one
//! solution and a small search for the nodes in contact. Gaps are vertical and linear in the displacements.

use crate::Error;
use crate::contact::Law;
use crate::elastic;
use crate::mesh::Mesh;
use crate::rail::Plate;
use crate::rolling::{Motion, Parameters, System};
use crate::sparse::{Factors, Matrix};
use crate::triangle::{Order, Space, linear_gradients};
use crate::wheel::Annulus;
use nalgebra::{DMatrix, DVector};
use wheelrail::config::RailEnds;

/// Bodies and numbers of a computation.
#[derive(Clone, Copy, Debug)]
pub struct Case {
    /// Wheel.
    pub annulus: Annulus,
    /// Rail.
    pub plate: Plate,
    /// Its ends: free or non-reflecting.
    pub ends: RailEnds,
    /// Load on the hub, downward [N/m].
    pub load: f64,
    /// Mass in the hub, without weight [kg/m].
    pub hub_mass: f64,
    /// Velocity [m/s]; the wheel rolls.
    pub velocity: f64,
    /// Stiffness-proportional damping `α₁` \[s].
    pub damping: f64,
    /// Time step \[s].
    pub step: f64,
    /// Share of the new state: ½ is Crank–Nicolson, 1 backward Euler.
    pub theta: f64,
    /// Nodes within this distance of the contact point may touch \[m].
    pub reach: f64,
}

/// Young's modulus \[Pa], Poisson's ratio \[1] and density [kg/m³] of all papers.
pub const STEEL: [f64; 3] = [200e9, 0.3, 8000.0];

/// A node of the tread and the segment of the rail below it.
struct Pair {
    /// Place along the rail, height above it \[m] and length that the node stands for \[m].
    place: [f64; 3],
    /// Unknowns with the factors by which they open the gap.
    opens: Vec<(usize, f64)>,
}

/// A wheel that rolls.
pub struct Rolling {
    case: Case,
    pairs: Vec<Pair>,
    /// Unknowns of the wheel's nodes, along and upward.
    wheel: Vec<Option<usize>>,
    /// Constant forces on the unknowns.
    load: Vec<f64>,
    factors: Factors,
    /// History of displacements and velocities that a step needs.
    before: [Matrix; 2],
    /// Displacements that a unit force on each pair makes within a step, and gaps.
    columns: Vec<Vec<f64>>,
    gaps: DMatrix<f64>,
    displacement: Vec<f64>,
    velocity: Vec<f64>,
    /// Contact forces on the nodes of the tread [N/m].
    pub forces: Vec<f64>,
    /// Way rolled \[m].
    pub way: f64,
}

/// Largest number of searches for the nodes in contact.
const SEARCHES: usize = 200;

impl Rolling {
    /// Starts from the static state, velocities zero, on a profile whose height \[m] over the way is `profile`.
    pub fn new(case: Case, wheel: &Mesh, rail: &Mesh, profile: &dyn Fn(f64) -> f64) -> Result<Self, Error> {
        let [young, poisson, density] = STEEL;
        let law = Law { penalty: 1.0, friction: 0.0, regularisation: 1.0 };
        let Case { annulus, plate, load, velocity, .. } = case;
        let parameters = Parameters { annulus, plate, young, poisson, density, load, law };
        let system = System::new(parameters, wheel, rail, case.reach);
        let motion = Motion { omega: velocity / annulus.outer, velocity };
        let mut stiffness = system.stiffness(motion);
        if case.ends == RailEnds::Nonreflecting {
            // Dashpots take the place of the Robin term.
            let by = 2 * system.wheel_nodes;
            let ends = elastic::open_ends(rail, plate, density).entries.into_iter();
            stiffness.entries.extend(ends.map(|(i, j, value)| (i + by, j + by, -velocity * velocity * value)));
        }
        let stiffness = system.reduce(&stiffness).compressed();
        let [mass, damping] = inertia(&system, &case, wheel, rail, motion);
        let pairs = pairs(&system);
        let numbers = system.unknown[..2 * system.wheel_nodes].to_vec();
        let mut load = system.gather(&system.centrifugal);
        load.iter_mut().for_each(|force| *force *= motion.omega.powi(2));
        load[system.size - 1] -= case.load;
        let (theta, dt) = (case.theta, case.step);
        let sum = |m: f64, c: f64, k: f64| Matrix::sum(&[(m, &mass), (c, &damping), (k, &stiffness)]);
        let factors = sum(1.0 / (theta * dt * dt), 1.0 / dt, theta).factorise()?;
        let before = [sum(1.0 / (theta * dt * dt), 1.0 / dt, theta - 1.0), sum(1.0 / (theta * dt), 0.0, 0.0)];
        let (columns, gaps) = answers(&factors, &pairs, system.size)?;
        let (displacement, forces) = rest(&system, &stiffness, &pairs, &load, case.load, profile)?;
        let velocity = vec![0.0; displacement.len()];
        let (wheel, way) = (numbers, 0.0);
        Ok(Self { case, pairs, wheel, load, factors, before, columns, gaps, displacement, velocity, forces, way })
    }

    /// A time step.
    pub fn advance(&mut self, profile: &dyn Fn(f64) -> f64) -> Result<(), Error> {
        self.way += self.case.velocity * self.case.step;
        let [of_place, of_velocity] = &self.before;
        let mut right = of_place.multiply(&self.displacement);
        let moving = of_velocity.multiply(&self.velocity);
        right.iter_mut().zip(moving.iter().zip(&self.load)).for_each(|(sum, (a, b))| *sum += a + b);
        let mut next = self.factors.solve(right)?;
        let free = free_gaps(&self.pairs, &next, self.way, profile);
        self.forces = touch(&self.gaps, &free, &self.forces)?;
        for (force, column) in self.forces.iter().zip(&self.columns).filter(|(force, _)| **force != 0.0) {
            next.iter_mut().zip(column).for_each(|(u, answer)| *u += force * answer);
        }
        let (theta, dt) = (self.case.theta, self.case.step);
        for ((v, old), new) in self.velocity.iter_mut().zip(&self.displacement).zip(&next) {
            *v = (new - old) / (theta * dt) - (1.0 - theta) / theta * *v;
        }
        self.displacement = next;
        Ok(())
    }

    /// Contact force [N/m].
    pub fn force(&self) -> f64 {
        self.forces.iter().sum()
    }

    /// Place \[m] and pressure \[Pa] of the nodes of the tread.
    pub fn pressure(&self) -> Vec<[f64; 2]> {
        self.pairs.iter().zip(&self.forces).map(|(pair, force)| [pair.place[0], force / pair.place[2]]).collect()
    }
}

impl Rolling {
    /// Largest vertical pressure in a triangle of the wheel, and largest mean over the triangles at a node \[Pa].
    pub fn stresses(&self, wheel: &Mesh) -> [f64; 2] {
        let [young, poisson, _] = STEEL;
        let shear = 0.5 * young / (1.0 + poisson);
        let lame = 2.0 * shear * poisson / (1.0 - 2.0 * poisson);
        let moved = |node: usize, axis: usize| self.wheel[2 * node + axis].map_or(0.0, |i| self.displacement[i]);
        let (mut most, mut sums) = (0.0_f64, vec![[0.0; 2]; wheel.nodes.len()]);
        for (t, nodes) in wheel.triangles.iter().enumerate() {
            let slopes = linear_gradients(&wheel.corners(t));
            let strain = |axis: usize| (0..3).map(|i| slopes[i][axis] * moved(nodes[i], axis)).sum::<f64>();
            let pressure = -lame * strain(0) - (lame + 2.0 * shear) * strain(1);
            most = most.max(pressure);
            nodes.iter().for_each(|node| sums[*node] = [sums[*node][0] + pressure, sums[*node][1] + 1.0]);
        }
        [most, sums.iter().fold(0.0, |most, [sum, count]| f64::max(most, sum / count))]
    }
}

/// Mass and damping with the convection of velocities, over the unknowns.
fn inertia(system: &System, case: &Case, wheel: &Mesh, rail: &Mesh, motion: Motion) -> [Matrix; 2] {
    let (density, by) = (STEEL[2], 2 * system.wheel_nodes);
    let size = system.unknown.len();
    let joined = |first: Matrix, second: Matrix| {
        let moved = second.entries.into_iter().map(|(i, j, value)| (i + by, j + by, value));
        Matrix { size, entries: first.entries.into_iter().chain(moved).collect() }
    };
    let spaces = [wheel, rail].map(|mesh| Space::new(mesh, Order::Linear));
    let mass = joined(elastic::mass(&spaces[0], density), elastic::mass(&spaces[1], density));
    let turning = elastic::gyroscopic(&spaces[0], density, |[x, y]| [motion.omega * y, -motion.omega * x]);
    let mut streaming = elastic::gyroscopic(&spaces[1], density, |_| [-motion.velocity, 0.0]);
    let mut dashpots = Matrix::new(2 * rail.nodes.len());
    if case.ends == RailEnds::Nonreflecting {
        // The antisymmetric half of the convection leaves ρc for both ends.
        let turned = streaming.entries.iter().map(|(i, j, value)| (*j, *i, -0.5 * value)).collect::<Vec<_>>();
        streaming.entries.iter_mut().for_each(|entry| entry.2 *= 0.5);
        streaming.entries.extend(turned);
        dashpots = elastic::dashpots(rail, case.plate, STEEL);
    }
    let convection = joined(turning, streaming);
    let empty = Matrix::new(2 * wheel.nodes.len());
    let dashpots = joined(empty, dashpots);
    let mut mass = system.reduce(&mass);
    mass.add(system.size - 1, system.size - 1, case.hub_mass);
    let all = Matrix::sum(&[(2.0, &convection), (1.0, &dashpots), (case.damping, &system.elastic)]);
    [mass.compressed(), system.reduce(&all).compressed()]
}

/// Nodes that may touch, and the segments below them.
fn pairs(system: &System) -> Vec<Pair> {
    let (tread, masters) = system.candidates();
    let x = |node: usize| system.places[node][0];
    let beyond = |i: usize| if i + 1 < tread.len() { x(tread[i + 1]) } else { 2.0 * x(tread[i]) - x(tread[i - 1]) };
    let pair = |(i, node): (usize, &usize)| {
        let [along, height] = system.places[*node];
        let right = masters.partition_point(|master| x(*master) <= along).clamp(1, masters.len() - 1);
        let (a, b) = (masters[right - 1], masters[right]);
        let share = (along - x(a)) / (x(b) - x(a));
        let opening = [(*node, 1.0), (a, share - 1.0), (b, -share)];
        let opens = opening.iter().filter_map(|(n, factor)| system.unknown[2 * n + 1].map(|j| (j, *factor))).collect();
        let before = if i > 0 { x(tread[i - 1]) } else { 2.0 * along - beyond(i) };
        Pair { place: [along, height, 0.5 * (beyond(i) - before)], opens }
    };
    tread.iter().enumerate().map(pair).collect()
}

/// Answers of displacements and gaps to unit forces that open each pair.
fn answers(factors: &Factors, pairs: &[Pair], size: usize) -> Result<(Vec<Vec<f64>>, DMatrix<f64>), Error> {
    let column = |pair: &Pair| {
        let mut right = vec![0.0; size];
        pair.opens.iter().for_each(|(i, factor)| right[*i] += factor);
        factors.solve(right)
    };
    let columns = pairs.iter().map(column).collect::<Result<Vec<_>, _>>()?;
    let gaps = DMatrix::from_fn(pairs.len(), pairs.len(), |i, j| opening(&pairs[i], &columns[j]));
    Ok((columns, gaps))
}

fn opening(pair: &Pair, u: &[f64]) -> f64 {
    pair.opens.iter().map(|(i, factor)| factor * u[*i]).sum()
}

/// Gaps without contact forces of the step.
fn free_gaps(pairs: &[Pair], u: &[f64], way: f64, profile: &dyn Fn(f64) -> f64) -> DVector<f64> {
    let gap = |pair: &Pair| pair.place[1] + opening(pair, u) - profile(way + pair.place[0]);
    DVector::from_iterator(pairs.len(), pairs.iter().map(gap))
}

/// Forces that keep all gaps open: those of the nodes in contact close theirs, none pulls.
fn touch(gaps: &DMatrix<f64>, free: &DVector<f64>, guess: &[f64]) -> Result<Vec<f64>, Error> {
    let count = guess.len();
    let scale = free.amax().max(1e-12);
    let mut active: Vec<bool> = guess.iter().map(|force| *force > 0.0).collect();
    for search in 0..SEARCHES {
        let nodes: Vec<usize> = (0..count).filter(|i| active[*i]).collect();
        let matrix = DMatrix::from_fn(nodes.len(), nodes.len(), |i, j| gaps[(nodes[i], nodes[j])]);
        let right = DVector::from_iterator(nodes.len(), nodes.iter().map(|i| -free[*i]));
        let singular = Error::Singular { size: nodes.len(), reason: "nodes in contact".into() };
        let found = if nodes.is_empty() { right } else { matrix.lu().solve(&right).ok_or(singular)? };
        let mut forces = vec![0.0; count];
        nodes.iter().zip(found.iter()).for_each(|(i, force)| forces[*i] = *force);
        let gap = free + gaps * DVector::from_column_slice(&forces);
        let pulls = (0..count).filter(|i| active[*i] && forces[*i] < 0.0).map(|i| (i, -forces[i] * gaps[(i, i)]));
        let overlaps = (0..count).filter(|i| !active[*i] && gap[*i] < -1e-12 * scale).map(|i| (i, -gap[i]));
        let wrong: Vec<(usize, f64)> = pulls.chain(overlaps).collect();
        let Some(worst) = wrong.iter().max_by(|a, b| a.1.total_cmp(&b.1)) else { return Ok(forces) };
        // All at once is fast; one at a time ends where that runs in circles.
        let changed = if search < 20 { wrong.clone() } else { vec![*worst] };
        changed.iter().for_each(|(i, _)| active[*i] = !active[*i]);
    }
    Err(Error::NotConverged { iterations: SEARCHES, residual: f64::NAN })
}

/// The static state: the wheel sinks until the contact carries the load. Returns displacements and contact forces.
fn rest(
    system: &System,
    stiffness: &Matrix,
    pairs: &[Pair],
    load: &[f64],
    weight: f64,
    profile: &dyn Fn(f64) -> f64,
) -> Result<(Vec<f64>, Vec<f64>), Error> {
    let hub = system.size - 1;
    let mut held = stiffness.clone();
    held.fix(&[hub]);
    let factors = held.factorise()?;
    let mut right = load.to_vec();
    right[hub] = 0.0;
    let loaded = factors.solve(right)?;
    let (columns, gaps) = answers(&factors, pairs, system.size)?;
    let mut down = vec![0.0; system.size];
    down[hub] = 1.0;
    let shift = factors.solve(down)?;
    let free = free_gaps(pairs, &loaded, 0.0, profile);
    let lift = DVector::from_iterator(pairs.len(), pairs.iter().map(|pair| opening(pair, &shift)));
    // Load that the contact has to carry: that without the resultant of an uneven mesh's centrifugal forces.
    let total = |u: &[f64]| stiffness.multiply(u)[hub] - load[hub];
    let (mut low, mut high) = (-0.01 * system.parameters.annulus.outer, 0.01 * system.parameters.annulus.outer);
    let mut best = (loaded.clone(), vec![0.0; pairs.len()]);
    let mut guess: Vec<f64> = pairs.iter().map(|pair| if pair.place[0].abs() < 1e-3 { 1.0 } else { 0.0 }).collect();
    for _ in 0..80 {
        let height = 0.5 * (low + high);
        let forces = touch(&gaps, &(&free + height * &lift), &guess)?;
        let mut u: Vec<f64> = loaded.iter().zip(&shift).map(|(u, s)| u + height * s).collect();
        for (force, column) in forces.iter().zip(&columns) {
            u.iter_mut().zip(column).for_each(|(u, answer)| *u += force * answer);
        }
        // Positive: the hub would still have to be pushed down.
        let missing = total(&u);
        if missing > 0.0 {
            high = height
        } else {
            low = height
        }
        best = (u, forces.clone());
        guess = forces;
        if missing.abs() < 1e-10 * weight {
            break;
        }
    }
    Ok(best)
}
