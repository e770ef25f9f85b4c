//! Displacements, temperatures and velocities in one Newton iteration (\[B] (33) and § 5.3, \[D] (21) to (28)): thermal
//! strain acts on the bodies and their contact, contact and friction act on the temperatures. The Gough–Joule term is
//! left out, as in \[D] § 3.

use crate::Error;
use crate::dual::Dual;
use crate::dynamic::{Prescribed, Rolling};
use crate::elastic;
use crate::heat::Heating;
use crate::iteration::{Equations, Motions, iterate};
use crate::rolling::{State, System, Touch};
use crate::sparse::Matrix;
use crate::warming::{Flows, Warming};
use std::ops::Add;

/// Temperatures beside displacements and velocities.
#[derive(Clone, Debug)]
pub struct Warm {
    /// Displacements and velocities.
    pub state: State,
    /// Temperatures over the reference \[K] of the wheel's nodes, then of the rail's.
    pub theta: Vec<f64>,
}

/// Forces of temperatures (`−K_uθ` of \[B] (33)).
pub struct Expansion {
    size: usize,
    /// Unknown, or after all unknowns the moment and the force on the hub; node; force [N/(m K)].
    entries: Vec<(usize, usize, f64)>,
}

impl Expansion {
    /// Assembles them for a thermal expansion \[1/K] of the system and the nodes of its temperatures.
    pub fn new(system: &System, warming: &Warming, expansion: f64) -> Self {
        let material = [system.parameters.young, system.parameters.poisson, expansion];
        let mut entries = Vec::new();
        for (space, first) in warming.spaces.iter().zip([0, system.wheel_nodes]) {
            for (i, node, force) in elastic::expansion(space, material).entries {
                let (i, node) = (i + 2 * first, node + first);
                system.unknown[i].iter().for_each(|row| entries.push((*row, node, force)));
                for (row, weights) in [(system.size, &system.arms), (system.size + 1, &system.along)] {
                    if weights[i] != 0.0 {
                        entries.push((row, node, weights[i] * force));
                    }
                }
            }
        }
        Self { size: system.size + 2, entries }
    }

    /// Forces on the unknowns [N/m], then moment \[N] and force [N/m] on the hub.
    pub fn forces(&self, theta: &[f64]) -> Vec<f64> {
        let mut forces = vec![0.0; self.size];
        self.entries.iter().for_each(|(row, node, force)| forces[*row] += force * theta[*node]);
        forces
    }
}

/// The equations of motion and heat, stationary or of a time step.
pub struct Coupled<'a, M> {
    /// Motion.
    pub motions: M,
    /// Heat; its temperatures are those at the beginning of a time step.
    pub warming: &'a Warming<'a>,
    /// Forces of temperatures.
    pub expansion: &'a Expansion,
    /// Inverse of the time step \[1/s], zero in stationary rolling.
    pub rate: f64,
}

impl<M: Motions> Coupled<'_, M> {
    /// Unknowns of the motion, after which those of heat come.
    fn first(&self) -> usize {
        self.motions.system().size + self.motions.found().len()
    }

    /// Row of an unknown, of the moment or of the force among the equations, if it is one of them.
    fn row(&self, row: usize) -> Option<usize> {
        let size = self.motions.system().size;
        if row < size {
            return Some(row);
        }
        self.motions.found().iter().position(|k| size + k == row).map(|place| size + place)
    }

    /// Heat that every node lacks or, where it is held at the reference, takes away [W/m].
    fn heat(&self, warm: &Warm) -> Vec<f64> {
        let (warming, theta) = (self.warming, &warm.theta);
        let motion = [warm.state.motion.omega, warm.state.motion.velocity];
        let mut lacking = warming.flow(motion, theta);
        let change: Vec<f64> = theta.iter().zip(&warming.theta).map(|(now, before)| now - before).collect();
        let stored = warming.capacity().multiply(&change);
        lacking.iter_mut().zip(stored).for_each(|(lacking, stored)| *lacking += self.rate * stored);
        lacking.iter_mut().zip(warming.arcs()).for_each(|(lacking, heat)| *lacking -= heat);
        for touch in self.motions.touches(&warm.state) {
            for (node, flow) in self.exchange(&touch, theta).flows {
                lacking[node] += flow.value;
            }
        }
        lacking
    }

    /// Quantities of a place in contact from its nodes, with derivatives (\[B] (44), \[C] (17) to (19), \[D] § 4).
    fn exchange(&self, touch: &Touch, theta: &[f64]) -> Exchange {
        let [conductance, heated] = self.warming.heating.contact;
        let [slave, _, left, right] = touch.nodes;
        let constant = Dual::constant;
        let share = touch.forces.share();
        let weights = [constant(1.0), share - constant(1.0), -share];
        let nodes = [slave, left, right];
        let conductance = constant(conductance * self.motions.system().length(slave));
        let warmer = (0..3).map(|k| weights[k] * constant(theta[nodes[k]])).fold(constant(0.0), Add::add);
        let friction = touch.forces.friction_power() * constant(0.5 * heated);
        let flow = |k: usize| {
            let side = if k == 0 { weights[k] } else { -weights[k] };
            (nodes[k], weights[k] * conductance * warmer - side * friction)
        };
        let by_theta = |i: usize, j: usize| (weights[i] * conductance * weights[j]).value;
        Exchange { flows: [0, 1, 2].map(flow), by_theta: [0, 1, 2].map(|i| [0, 1, 2].map(|j| by_theta(i, j))) }
    }

    /// Derivative of the residual (\[D] App. B.2), without that of the stabilisation by the velocities (\[D] § 5.3.1).
    pub fn tangent(&self, warm: &Warm) -> Matrix {
        let (warming, system, first) = (self.warming, self.motions.system(), self.first());
        let motion = [warm.state.motion.omega, warm.state.motion.velocity];
        let mut heat = Matrix::sum(&[(1.0, &warming.matrix(motion)), (self.rate, warming.capacity())]);
        let found = self.motions.found();
        let mut by_motion = Vec::new();
        for (place, k) in found.iter().enumerate() {
            let column = warming.by_velocity(*k).multiply(&warm.theta);
            by_motion.extend(column.into_iter().enumerate().map(|(node, heat)| (node, system.size + place, heat)));
        }
        for touch in self.motions.touches(&warm.state) {
            let exchange = self.exchange(&touch, &warm.theta);
            for (i, (node, flow)) in exchange.flows.iter().enumerate() {
                for (j, (other, _)) in exchange.flows.iter().enumerate() {
                    heat.add(*node, *other, exchange.by_theta[i][j]);
                }
                for (k, slope) in flow.slopes[..8].iter().enumerate() {
                    let unknown = system.unknown[2 * touch.nodes[k / 2] + k % 2];
                    by_motion.extend(unknown.map(|column| (*node, column, *slope)));
                }
                let slopes =
                    found.iter().enumerate().map(|(place, k)| (*node, system.size + place, flow.slopes[8 + k]));
                by_motion.extend(slopes);
            }
        }
        let fixed = warming.fixed();
        heat.fix(fixed);
        let mut tangent = self.motions.tangent(&warm.state);
        tangent.size = first + warm.theta.len();
        for (row, node, force) in &self.expansion.entries {
            self.row(*row).iter().for_each(|row| tangent.add(*row, first + node, -force));
        }
        let free = by_motion.into_iter().filter(|(node, ..)| fixed.binary_search(node).is_err());
        free.for_each(|(node, column, slope)| tangent.add(first + node, column, slope));
        heat.entries.iter().for_each(|(i, j, value)| tangent.add(first + i, first + j, *value));
        tangent
    }

    /// Heat of a state.
    pub fn flows(&self, warm: &Warm) -> Flows {
        let (warming, theta) = (self.warming, &warm.theta);
        let [omega, velocity] = [warm.state.motion.omega, warm.state.motion.velocity];
        let heating = Heating { motion: [omega, velocity], ..warming.heating };
        let friction: f64 =
            self.motions.touches(&warm.state).iter().map(|touch| touch.forces.friction_power().value).sum();
        let capacity = |theta: &[f64]| warming.capacity().multiply(theta).iter().sum::<f64>();
        let lacking = self.heat(warm);
        Flows {
            given: 2.0 * heating.arcs + heating.contact[1] * friction,
            let_in: heating.let_in(&warming.spaces[0], &theta[..warming.spaces[0].places.len()]),
            stored: self.rate * (capacity(theta) - capacity(&warming.theta)),
            leaves: -warming.fixed().iter().map(|node| lacking[*node]).sum::<f64>(),
        }
    }

    /// Heat by which residuals are measured [W/m]: that of the arcs and of a contact that slides with the creep
    /// velocity, or, where nothing heats, what a kelvin conducts.
    fn scale(&self) -> f64 {
        let parameters = &self.motions.system().parameters;
        let [omega, velocity] = self.warming.heating.motion;
        let slip = (velocity - parameters.annulus.outer * omega).abs().max(parameters.law.regularisation);
        let heating = &self.warming.heating;
        let given = 2.0 * heating.arcs + heating.contact[1] * parameters.law.friction * parameters.load * slip;
        given.max(heating.material[1])
    }
}

/// Heat of the nodes of a place in contact (slave, left, right) [W/m], and its derivatives by their temperatures
/// [W/(m K)].
struct Exchange {
    flows: [(usize, Dual); 3],
    by_theta: [[f64; 3]; 3],
}

impl<M: Motions> Equations for Coupled<'_, M> {
    type State = Warm;

    /// That of the motion, then of heat [W/m].
    fn residual(&self, warm: &Warm) -> Vec<f64> {
        let mut residual = self.motions.residual(&warm.state);
        for (row, force) in self.expansion.forces(&warm.theta).into_iter().enumerate() {
            self.row(row).iter().for_each(|row| residual[*row] -= force);
        }
        let mut heat = self.heat(warm);
        self.warming.fixed().iter().for_each(|node| heat[*node] = warm.theta[*node]);
        residual.extend(heat);
        residual
    }

    fn step(&self, warm: &Warm) -> Result<Vec<f64>, Error> {
        self.tangent(warm).factorise()?.solve(self.residual(warm).iter().map(|value| -value).collect())
    }

    fn size(&self, residual: &[f64]) -> f64 {
        let (motion, heat) = residual.split_at(self.first());
        let heat = heat.iter().map(|heat| heat * heat).sum::<f64>().sqrt() / self.scale();
        self.motions.size(motion).hypot(heat)
    }

    fn moved(&self, warm: &Warm, step: &[f64], share: f64) -> Warm {
        let (motion, heat) = step.split_at(self.first());
        let theta = warm.theta.iter().zip(heat).map(|(theta, change)| theta + share * change).collect();
        Warm { state: self.motions.moved(&warm.state, motion, share), theta }
    }
}

/// A step \[s] of wheel, rail and their temperatures under what is prescribed of rotation and travel; returns the
/// number of Newton's steps and the heat.
pub fn advance(
    rolling: &mut Rolling,
    warming: &mut Warming,
    expansion: &Expansion,
    step: f64,
    prescribed: [Prescribed; 2],
) -> Result<(usize, Flows), Error> {
    let start = Warm { state: rolling.guess(prescribed), theta: warming.theta.clone() };
    let motion = [start.state.motion.omega, start.state.motion.velocity];
    warming.heating.motion = motion;
    warming.renew(motion);
    let coupled = Coupled { motions: rolling.equations(step, prescribed), warming, expansion, rate: step.recip() };
    let (warm, iterations) = iterate(&coupled, &start)?;
    let flows = coupled.flows(&warm);
    let end = coupled.motions.end(warm.state);
    let hub = expansion.forces(&warm.theta).split_off(expansion.size - 2);
    rolling.take(end);
    rolling.efforts.iter_mut().zip(hub).for_each(|(effort, force)| *effort -= force);
    warming.theta = warm.theta;
    Ok((iterations, flows))
}
