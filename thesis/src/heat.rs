//! Stationary heat of rolling wheel and rail on triangles (\[B] §§ 2 to 5, \[C] § 4): bubbles or SUPG in the wheel,
//! SUPG in the rail, conductance and friction heat at the nodes in contact.
//!
//! The contact is given: its expansion by these temperatures, some micrometres at most, does not act back.

use crate::Error;
use crate::contact::Law;
use crate::flow::Flow;
use crate::mesh::Mesh;
use crate::newton::{Drive, Newton};
use crate::rolling::{State, System};
use crate::sparse::Matrix;
use crate::stabilise::Scheme;
use crate::triangle::{Order, Space, points};
use crate::wheel::{Annulus, rims};
use nalgebra::DMatrix;
use std::f64::consts::{FRAC_PI_2, FRAC_PI_8};

/// A node of the tread in contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spot {
    /// Node of the wheel.
    pub slave: usize,
    /// Ends of the segment of the rail below, with their shares of the node.
    pub masters: [(usize, f64); 2],
    /// Length of the tread that it stands for \[m].
    pub length: f64,
    /// Friction power [W/m].
    pub friction: f64,
}

/// Heated body and its heating.
#[derive(Clone, Copy)]
pub struct Heating<'a> {
    /// Wheel and rail.
    pub meshes: [&'a Mesh; 2],
    /// Radii \[m].
    pub annulus: Annulus,
    /// Functions and stabilisation of the wheel; the rail is linear with SUPG.
    pub wheel: (Order, Scheme),
    /// Heat capacity of the volume [J/(m³ K)] and conductivity [W/(m K)].
    pub material: [f64; 2],
    /// Angular velocity [rad/s] and velocity [m/s].
    pub motion: [f64; 2],
    /// Nodes in contact.
    pub spots: &'a [Spot],
    /// Conductance of the contact [W/(m² K)] and share of the friction power that becomes heat \[1].
    pub contact: [f64; 2],
    /// Heat into each of the arcs of 45° at ±90° from the contact [W/m].
    pub arcs: f64,
    /// True with the hub held at the reference.
    pub cold_hub: bool,
}

/// Temperatures over the reference.
pub struct Warmth {
    /// Nodes of the wheel.
    pub space: Space,
    /// Temperatures \[K] of the wheel's nodes, then of the rail's.
    pub theta: Vec<f64>,
    /// Mean temperatures of wheel and rail \[K].
    pub means: [f64; 2],
    /// Heat from the wheel to the rail by conduction, and friction heat into both bodies [W/m].
    pub flows: [f64; 2],
    /// Heat that leaves through nodes at the reference, those of the wheel and those of the rail, by their reactions
    /// [W/m].
    pub leaves: [f64; 2],
}

/// Nodes in contact of a mechanical solution, with their friction power.
pub fn spots(system: &System, state: &State) -> Vec<Spot> {
    let newton = Newton { system, law: Law { ..system.parameters.law }, drive: Drive::Velocity };
    let (_, touches) = newton.residual(state);
    let spot = |touch: &crate::rolling::Touch| {
        let [slave, _, left, right] = touch.nodes;
        let share = touch.forces.share().value;
        Spot {
            slave,
            masters: [(left - system.wheel_nodes, 1.0 - share), (right - system.wheel_nodes, share)],
            length: system.length(slave),
            friction: touch.forces.friction_power().value,
        }
    };
    touches.iter().map(spot).collect()
}

impl Heating<'_> {
    /// Stationary temperatures.
    pub fn solve(&self) -> Result<Warmth, Error> {
        let spaces = self.spaces();
        let first = spaces[0].places.len();
        let mut matrix = self.stabilised(&spaces);
        let mut load = vec![0.0; matrix.size];
        self.exchange(first, &mut matrix, &mut load);
        self.heat_arcs(&spaces[0], &mut load);
        let fixed = self.fixed(&spaces);
        let rows = matrix.fix(&fixed);
        let free = load.clone();
        fixed.iter().for_each(|node| load[*node] = 0.0);
        let theta = matrix.compressed().factorise()?.solve(load)?;
        let held = rows.multiply(&theta);
        let mut leaves = [0.0; 2];
        fixed.iter().for_each(|node| leaves[usize::from(*node >= first)] += free[*node] - held[*node]);
        let means = self.means(&spaces, &theta);
        let conducted =
            self.spots.iter().map(|spot| self.contact[0] * spot.length * difference(spot, &theta, first)).sum();
        let friction = self.contact[1] * self.spots.iter().map(|spot| spot.friction).sum::<f64>();
        let [space, _] = spaces;
        Ok(Warmth { space, theta, means, flows: [conducted, friction], leaves })
    }

    /// Nodes of wheel and rail.
    pub fn spaces(&self) -> [Space; 2] {
        let [wheel, rail] = self.meshes;
        [Space::new(wheel, self.wheel.0), Space::new(rail, Order::Linear)]
    }

    /// Conduction and convection of both bodies with their stabilisation.
    pub fn stabilised(&self, spaces: &[Space; 2]) -> Matrix {
        self.flowing(spaces, [self.wheel.1, Scheme::Supg], self.material[1], self.motion)
    }

    /// Assembly with given schemes, conductivity and velocities.
    pub(crate) fn flowing(&self, spaces: &[Space; 2], schemes: [Scheme; 2], k: f64, motion: [f64; 2]) -> Matrix {
        let [omega, velocity] = motion;
        let turning = |[x, y]: [f64; 2]| [omega * y, -omega * x];
        let streaming = |_: [f64; 2]| [-velocity, 0.0];
        let flows: [&dyn Fn([f64; 2]) -> [f64; 2]; 2] = [&turning, &streaming];
        self.assemble(spaces, |body, corners| {
            let velocity = flows[body];
            let flow = Flow { capacity: self.material[0], conductivity: k, velocity, source: 0.0, degree: 5 };
            flow.element(corners, spaces[body].order, schemes[body]).0
        })
    }

    /// Sums up elements of both bodies.
    pub(crate) fn assemble(
        &self,
        spaces: &[Space; 2],
        element: impl Fn(usize, &[[f64; 2]; 3]) -> DMatrix<f64>,
    ) -> Matrix {
        self.assemble_some(spaces, |body, _, corners| Some(element(body, corners)))
    }

    /// Assembly over the elements that take part, by their number.
    pub(crate) fn assemble_some(
        &self,
        spaces: &[Space; 2],
        element: impl Fn(usize, usize, &[[f64; 2]; 3]) -> Option<DMatrix<f64>>,
    ) -> Matrix {
        let first = spaces[0].places.len();
        let mut matrix = Matrix::new(first + spaces[1].places.len());
        for (body, space) in spaces.iter().enumerate() {
            for (t, nodes) in space.elements.iter().enumerate() {
                let Some(part) = element(body, t, &self.meshes[body].corners(t)) else { continue };
                for (a, row) in nodes.iter().enumerate() {
                    nodes.iter().enumerate().for_each(|(b, column)| {
                        matrix.add(row + body * first, column + body * first, part[(a, b)]);
                    });
                }
            }
        }
        matrix
    }

    /// Mean temperatures of wheel and rail \[K].
    pub(crate) fn means(&self, spaces: &[Space; 2], theta: &[f64]) -> [f64; 2] {
        let (wheel, rail) = theta.split_at(spaces[0].places.len());
        [mean(self.meshes[0], &spaces[0], wheel), mean(self.meshes[1], &spaces[1], rail)]
    }

    /// Heat put in, by the arcs, friction and the chords, less that which leaves, over that of arcs and friction \[1].
    pub fn imbalance(&self, warmth: &Warmth) -> f64 {
        let given = 2.0 * self.arcs + warmth.flows[1];
        ((given + self.let_in(&warmth.space, &warmth.theta) - warmth.leaves.iter().sum::<f64>()) / given).abs()
    }

    /// Heat that the chords of the rims let in [W/m], `−ρc ∮ v·n θ`: the convective form has no term on them, and they
    /// are no streamlines.
    pub fn let_in(&self, space: &Space, theta: &[f64]) -> f64 {
        let mut sum = 0.0;
        for &(a, b, middle) in &space.sides {
            let (p, q) = (space.places[a], space.places[b]);
            let along = [q[0] - p[0], q[1] - p[1]];
            let value = |[x, y]: [f64; 2], theta: f64| (x * along[0] + y * along[1]) * theta;
            let there = middle.map_or(0.5 * (theta[a] + theta[b]), |node| theta[node]);
            let half = value([0.5 * (p[0] + q[0]), 0.5 * (p[1] + q[1])], there);
            // Simpson's rule, exact up to cubics: temperatures are quadratic at most, the velocity is linear.
            sum += (value(p, theta[a]) + 4.0 * half + value(q, theta[b])) / 6.0;
        }
        -self.material[0] * self.motion[0] * sum
    }

    /// Conductance and friction heat, half of it to each side.
    pub(crate) fn exchange(&self, first: usize, matrix: &mut Matrix, load: &mut [f64]) {
        for spot in self.spots {
            let [(left, a), (right, b)] = spot.masters;
            // Weights in the difference of the temperatures, and of the heat of their side.
            let nodes = [(spot.slave, 1.0, 1.0), (first + left, -a, a), (first + right, -b, b)];
            for (row, weight, share) in nodes {
                for (column, other, _) in nodes {
                    matrix.add(row, column, self.contact[0] * spot.length * weight * other);
                }
                load[row] += 0.5 * self.contact[1] * spot.friction * share;
            }
        }
    }

    /// Heat of both arcs by edges of the tread whose middle lies on them.
    pub(crate) fn heat_arcs(&self, space: &Space, load: &mut [f64]) {
        let (tread, _) = rims(self.meshes[0], self.annulus);
        let on_tread: std::collections::HashSet<usize> = tread.into_iter().collect();
        let mut parts = Vec::new();
        for &(a, b, middle) in space.sides.iter().filter(|(a, b, _)| on_tread.contains(a) && on_tread.contains(b)) {
            let (p, q) = (space.places[a], space.places[b]);
            let angle = (p[0] + q[0]).atan2(-p[1] - q[1]).abs();
            if (angle - FRAC_PI_2).abs() < FRAC_PI_8 {
                parts.push((a, b, middle, (p[0] - q[0]).hypot(p[1] - q[1])));
            }
        }
        let total: f64 = parts.iter().map(|part| part.3).sum();
        for (a, b, middle, length) in parts {
            let heat = 2.0 * self.arcs * length / total;
            let ends = if middle.is_some() { heat / 6.0 } else { 0.5 * heat };
            (load[a], load[b]) = (load[a] + ends, load[b] + ends);
            middle.iter().for_each(|node| load[*node] += heat * 4.0 / 6.0);
        }
    }

    /// Nodes at the reference: the rail's ends, and the hub where it is cold.
    pub(crate) fn fixed(&self, spaces: &[Space; 2]) -> Vec<usize> {
        let end = spaces[1].places.iter().fold(0.0_f64, |most, place| most.max(place[0].abs())) - 1e-9;
        let first = spaces[0].places.len();
        let ends = (0..spaces[1].places.len()).filter(|n| spaces[1].places[*n][0].abs() > end).map(|n| n + first);
        let (_, hub) = rims(self.meshes[0], self.annulus);
        let sides = spaces[0].sides.iter().filter(|(a, ..)| self.cold_hub && hub.contains(a));
        let cold = sides.flat_map(|(a, _, middle)| [Some(*a), *middle]).flatten();
        let mut fixed: Vec<usize> = ends.chain(cold).collect();
        fixed.sort_unstable();
        fixed.dedup();
        fixed
    }
}

/// How much warmer the wheel is than the rail at a spot \[K].
fn difference(spot: &Spot, theta: &[f64], first: usize) -> f64 {
    theta[spot.slave] - spot.masters.iter().map(|(node, share)| share * theta[first + node]).sum::<f64>()
}

/// Mean over a body \[K].
fn mean(mesh: &Mesh, space: &Space, theta: &[f64]) -> f64 {
    let part = |(t, nodes): (usize, &Vec<usize>)| -> f64 {
        let value =
            |p: &crate::triangle::Point| nodes.iter().zip(p.shape.values).map(|(n, v)| v * theta[*n]).sum::<f64>();
        points(&mesh.corners(t), space.order).iter().map(|point| point.weight * value(point)).sum()
    };
    space.elements.iter().enumerate().map(part).sum::<f64>() / mesh.area()
}
