//! Stationary rolling of wheel and rail on triangles: what is linear, and the search for contact (\[C] §§ 3 to 5, \[D]
//! § 5).
//!
//! Both bodies are of linear triangles, as in Paper A, or the wheel of quadratic ones, as in Papers B to D; contact is
//! between corners in both cases. The hub is rigid, held in x and free in y, where it carries the load; the base of the
//! rail is held; its ends let material pass free of traction, by the Robin term of \[B] (33) and \[D] (35).

use crate::contact::{Forces, Law, Pair, Past};
use crate::mesh::Mesh;
use crate::sparse::Matrix;
use crate::triangle::{Order, Space};
use crate::wheel::{self, Annulus};
use crate::{elastic, rail};

/// Nodes nearer to each other than this along the rail lie above one another \[m].
const SAME: f64 = 1e-12;

/// Wheel and rail.
#[derive(Clone, Copy, Debug)]
pub struct Parameters {
    /// Wheel.
    pub annulus: Annulus,
    /// Rail.
    pub plate: rail::Plate,
    /// Young's modulus \[Pa].
    pub young: f64,
    /// Poisson's ratio \[1].
    pub poisson: f64,
    /// Density [kg/m³].
    pub density: f64,
    /// Load on the hub, downward [N/m].
    pub load: f64,
    /// Contact.
    pub law: Law,
}

/// Where a body moves: translation and rotation prescribed or found.
#[derive(Clone, Copy, Debug)]
pub struct Motion {
    /// Angular velocity, forward [rad/s].
    pub omega: f64,
    /// Velocity [m/s].
    pub velocity: f64,
}

/// Unknowns and motion.
#[derive(Clone, Debug)]
pub struct State {
    /// Unknown displacements \[m].
    pub q: Vec<f64>,
    /// Velocities.
    pub motion: Motion,
}

/// Linear part of the system, without velocities, and the nodes that may touch.
pub struct System {
    /// Its parameters.
    pub parameters: Parameters,
    /// Stiffness of both bodies: all nodes of the wheel, then all of the rail.
    pub elastic: Matrix,
    /// To be taken `−ω²` times.
    pub turning: Matrix,
    /// To be taken `−V²` times; with the term of the ends.
    pub streaming: Matrix,
    /// To be taken `ω²` times [N/m · s²].
    pub centrifugal: Vec<f64>,
    /// Unknown of each displacement; none where it is held. All vertical ones of the hub are one.
    pub unknown: Vec<Option<usize>>,
    /// Number of unknowns, the hub's being the last.
    pub size: usize,
    /// Lever arms of each displacement of the hub about the centre, forward moments positive \[m].
    pub arms: Vec<f64>,
    /// One for each displacement of the hub along the rail \[1].
    pub along: Vec<f64>,
    /// Functions of the wheel; the rail's are linear.
    pub order: Order,
    /// Number of the wheel's nodes, after which those of the rail come.
    pub wheel_nodes: usize,
    /// Places \[m] in the frame of the rail.
    pub places: Vec<[f64; 2]>,
    /// Nodes of the tread that may touch, each with the one upstream.
    slaves: Vec<[usize; 2]>,
    /// Nodes of the rail's surface from left to right.
    masters: Vec<usize>,
}

/// A contact element in place: its nodes (slave, upstream, left, right) and forces.
pub struct Touch {
    /// Nodes of the system.
    pub nodes: [usize; 4],
    /// Forces.
    pub forces: Forces,
}

impl System {
    /// Assembles both bodies. `wheel` lies about the origin, the surface of `rail` at y = 0; nodes of the tread within
    /// `reach` \[m] of the contact may touch.
    pub fn new(parameters: Parameters, wheel: &Mesh, rail: &Mesh, reach: f64) -> Self {
        Self::with_order(parameters, wheel, rail, reach, Order::Linear)
    }

    /// Wheel and rail with linear or quadratic triangles in the wheel.
    pub fn with_order(parameters: Parameters, wheel: &Mesh, rail: &Mesh, reach: f64, order: Order) -> Self {
        let [turned, streamed] = [Space::new(wheel, order), Space::new(rail, Order::Linear)];
        let Parameters { young, poisson, density, annulus, .. } = parameters;
        let (first, count) = (turned.places.len(), turned.places.len() + rail.nodes.len());
        let shifted = |matrix: Matrix, by: usize| {
            let entries = matrix.entries.into_iter().map(|(i, j, value)| (i + 2 * by, j + 2 * by, value)).collect();
            Matrix { size: 2 * count, entries }
        };
        let mut elastic = shifted(elastic::stiffness(&turned, young, poisson), 0);
        elastic.entries.extend(shifted(elastic::stiffness(&streamed, young, poisson), first).entries);
        let turning = shifted(elastic::convection(&turned, density, |[x, y]| [y, -x]), 0);
        let mut streaming = shifted(elastic::convection(&streamed, density, |_| [-1.0, 0.0]), first);
        // Its ends are free of traction, which the stream's own would not be.
        let ends = shifted(elastic::open_ends(rail, parameters.plate, density), first);
        streaming.entries.extend(ends.entries.into_iter().map(|(i, j, value)| (i, j, -value)));
        let mut centrifugal = elastic::centrifugal(&turned, density);
        centrifugal.resize(2 * count, 0.0);
        let lift = |[x, y]: &[f64; 2]| [*x, y + annulus.outer];
        let places = turned.places.iter().map(lift).chain(rail.nodes.iter().copied()).collect();
        let (unknown, size, [arms, along]) = unknowns(wheel, &turned, rail, annulus, parameters.plate);
        let slaves = slaves(wheel, annulus, reach);
        let top = |n: &usize| rail.nodes[*n][1].abs() < 1e-9 && rail.nodes[*n][0].abs() < 4.0 * reach;
        let mut masters: Vec<usize> = (0..rail.nodes.len()).filter(top).collect();
        masters.sort_by(|a, b| rail.nodes[*a][0].total_cmp(&rail.nodes[*b][0]));
        masters.iter_mut().for_each(|node| *node += first);
        let wheel_nodes = first;
        Self {
            parameters,
            elastic,
            turning,
            streaming,
            centrifugal,
            unknown,
            size,
            arms,
            along,
            order,
            wheel_nodes,
            places,
            slaves,
            masters,
        }
    }

    /// Stiffness for a motion, over all displacements.
    pub fn stiffness(&self, motion: Motion) -> Matrix {
        let mut sum = self.elastic.clone();
        for (part, factor) in [(&self.turning, motion.omega.powi(2)), (&self.streaming, motion.velocity.powi(2))] {
            sum.entries.extend(part.entries.iter().map(|(i, j, value)| (*i, *j, -factor * value)));
        }
        sum
    }

    /// Displacements of all nodes from the unknowns.
    pub fn expand(&self, q: &[f64]) -> Vec<f64> {
        self.unknown.iter().map(|unknown| unknown.map_or(0.0, |i| q[i])).collect()
    }

    /// Sums of forces on all displacements as forces on the unknowns.
    pub fn gather(&self, forces: &[f64]) -> Vec<f64> {
        let mut sums = vec![0.0; self.size];
        for (unknown, force) in self.unknown.iter().zip(forces) {
            unknown.iter().for_each(|i| sums[*i] += force);
        }
        sums
    }

    /// A matrix over all displacements as one over the unknowns.
    pub fn reduce(&self, full: &Matrix) -> Matrix {
        let entry = |&(i, j, value): &(usize, usize, f64)| Some((self.unknown[i]?, self.unknown[j]?, value));
        Matrix { size: self.size, entries: full.entries.iter().filter_map(entry).collect() }
    }

    /// Where the bodies touch in stationary rolling; `law` replaces the system's own.
    pub fn touches(&self, u: &[f64], motion: Motion, law: Law) -> Vec<Touch> {
        self.touches_in_time(u, None, motion, law)
    }

    /// Equations at the end of a time step; `past`: displacements at its beginning, and its inverse \[1/s].
    pub fn touches_in_time(&self, u: &[f64], past: Option<(&[f64], f64)>, motion: Motion, law: Law) -> Vec<Touch> {
        let at = |node: usize| [u[2 * node], u[2 * node + 1]];
        // Displacements are a hundredth of a segment. If they chose it, a node above the end of one would jump between
        // two normals.
        let x = |node: usize| self.places[node][0];
        let touch = |&[slave, upstream]: &[usize; 2]| {
            // A node right above one of the rail has the segment upstream, whatever the last digits of their places.
            let right =
                self.masters.partition_point(|node| x(*node) <= x(slave) + SAME).clamp(1, self.masters.len() - 1);
            let nodes = [slave, upstream, self.masters[right - 1], self.masters[right]];
            let [slave, upstream, left, right] = nodes.map(|node| self.places[node]);
            let centre = [0.0, self.parameters.annulus.outer];
            let pair = Pair { slave, upstream, master: [left, right], centre };
            let past = past.map_or_else(Past::default, |(before, rate)| Past {
                from: nodes.map(|node| [before[2 * node], before[2 * node + 1]]),
                rate,
            });
            let forces = law.forces_in_time(&pair, &nodes.map(at), &past, motion.omega, motion.velocity);
            forces.map(|forces| Touch { nodes, forces })
        };
        self.slaves.iter().filter_map(touch).collect()
    }

    /// Nodes of the tread that may touch, and those of the rail's surface, each from left to right.
    pub fn candidates(&self) -> (Vec<usize>, &[usize]) {
        (self.slaves.iter().map(|[slave, _]| *slave).collect(), &self.masters)
    }

    /// Length of the tread for which one of its nodes that may touch stands \[m].
    pub fn length(&self, slave: usize) -> f64 {
        let at = self.slaves.iter().position(|pair| pair[0] == slave).unwrap_or_default();
        let [before, after] = [at.saturating_sub(1), (at + 1).min(self.slaves.len() - 1)];
        0.5 * (self.places[self.slaves[after][0]][0] - self.places[self.slaves[before][0]][0])
    }

    /// Unknowns on which contact forces can act or depend.
    pub fn contact_unknowns(&self) -> Vec<usize> {
        let nodes = self.slaves.iter().flatten().chain(&self.masters);
        let mut found: Vec<usize> =
            nodes.flat_map(|node| [self.unknown[2 * node], self.unknown[2 * node + 1]]).flatten().collect();
        found.push(self.size - 1);
        found.sort_unstable();
        found.dedup();
        found
    }

    /// Places of the tread's nodes that may touch \[m], and the forces of a Hertzian pressure on them; the same of the
    /// rail.
    pub fn hertz(&self, half_width: f64, peak: f64) -> Vec<f64> {
        let mut load = vec![0.0; self.places.len() * 2];
        let pressure = |x: f64| peak * (1.0 - (x / half_width).powi(2)).max(0.0).sqrt();
        let mut tread: Vec<usize> = self.slaves.iter().map(|[slave, _]| *slave).collect();
        tread.sort_by(|a, b| self.places[*a][0].total_cmp(&self.places[*b][0]));
        for (nodes, sign) in [(tread, 1.0), (self.masters.clone(), -1.0)] {
            for window in nodes.windows(3) {
                let [left, middle, right] = [window[0], window[1], window[2]].map(|node| self.places[node][0]);
                load[2 * window[1] + 1] += sign * 0.5 * (right - left) * pressure(middle);
            }
        }
        load
    }

    /// The node of the tread nearest to the contact point, and the one of the rail.
    pub fn nearest(&self) -> [usize; 2] {
        let nearest = |nodes: &mut dyn Iterator<Item = usize>| {
            nodes.min_by(|a, b| self.places[*a][0].abs().total_cmp(&self.places[*b][0].abs())).unwrap_or_default()
        };
        [nearest(&mut self.slaves.iter().map(|pair| pair[0])), nearest(&mut self.masters.iter().copied())]
    }
}

/// Unknown of each displacement, their number, and for those of the hub lever arms and directions along the rail.
fn unknowns(
    wheel: &Mesh,
    turned: &Space,
    rail: &Mesh,
    annulus: Annulus,
    plate: rail::Plate,
) -> (Vec<Option<usize>>, usize, [Vec<f64>; 2]) {
    let first = turned.places.len();
    let (_, corners) = wheel::rims(wheel, annulus);
    let middles = turned.sides.iter().filter(|(a, ..)| corners.contains(a)).filter_map(|side| side.2);
    let hub: Vec<usize> = corners.iter().copied().chain(middles).collect();
    let mut free = vec![true; 2 * (first + rail.nodes.len())];
    let [mut arms, mut along] = [vec![0.0; free.len()], vec![0.0; free.len()]];
    for node in &hub {
        let [x, y] = turned.places[*node];
        (free[2 * node], free[2 * node + 1]) = (false, false);
        // A force on the hub turns it forward by y F_x − x F_y.
        (arms[2 * node], arms[2 * node + 1]) = (y, -x);
        along[2 * node] = 1.0;
    }
    let base = (0..rail.nodes.len()).filter(|n| rail.nodes[*n][1] < 1e-9 - plate.height);
    for node in base.map(|node| node + first) {
        (free[2 * node], free[2 * node + 1]) = (false, false);
    }
    let mut next = 0..;
    let mut unknown: Vec<Option<usize>> = free.iter().map(|free| if *free { next.next() } else { None }).collect();
    let last = next.start;
    hub.iter().for_each(|node| unknown[2 * node + 1] = Some(last));
    (unknown, last + 1, [arms, along])
}

/// Nodes of the tread within `reach` of the contact, each with the one upstream: material comes from the right.
fn slaves(wheel: &Mesh, annulus: Annulus, reach: f64) -> Vec<[usize; 2]> {
    let (tread, _) = wheel::rims(wheel, annulus);
    let below = |n: &usize| wheel.nodes[*n][1] < 0.0 && wheel.nodes[*n][0].abs() < annulus.outer * 0.5;
    let mut tread: Vec<usize> = tread.into_iter().filter(below).collect();
    tread.sort_by(|a, b| wheel.nodes[*a][0].total_cmp(&wheel.nodes[*b][0]));
    let pairs = tread.windows(2).map(|pair| [pair[0], pair[1]]);
    pairs.filter(|[slave, _]| wheel.nodes[*slave][0].abs() <= reach).collect()
}
