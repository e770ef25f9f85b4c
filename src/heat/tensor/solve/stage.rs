//! Matrix of an implicit stage: applied exactly, inverted mode by mode, coupled through the contact.

use super::coefficients::StageCoefficients;
use super::conductance::{ContactBands, conducting, even_conductance};
use super::coupling::{Conduction, Coupling};
use super::inverse::{InverseKey, Inverses};
use super::transport::Transport;
use crate::heat::error::HeatError;
use crate::heat::tensor::mesh::body::HeatBody;
use crate::heat::tensor::mesh::layout::HeatLayout;
use crate::linalg::Update;
use std::ops::Range;

/// Stream, factors and coupling matrices of one body, and its buffers.
#[derive(Clone, Debug, Default)]
pub struct BodyOperator {
    pub transport: Transport,
    /// Conduction alone; set where steel melts.
    still: Transport,
    pub inverses: Inverses,
    /// Conductance on the contact nodes: of the present stream, and of that of the inverse.
    contact: ContactBands,
    inverted: ContactBands,
    /// Buffer of a field.
    work: Vec<f64>,
    /// Surface temperatures at the contact nodes.
    trace: Vec<f64>,
    /// Load at surface nodes.
    pub load: Vec<f64>,
    /// Field and its rate, summed along the streamlines.
    pub sums: [Vec<f64>; 2],
}

/// Speeds and coefficients that the matrices of a stage belong to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StageKey {
    /// Velocity of the wheel's centre [m/s] and angular velocity [rad/s].
    pub speeds: [f64; 2],
    /// Velocities of the matrix that is inverted.
    pub inverted: [f64; 2],
    /// Weights of storage and flow.
    pub coefficients: StageCoefficients,
    /// Inverse of the step that upwinding sees [1/s].
    pub rate: f64,
    /// True where conduction along the streamlines of the wheel is exact.
    pub curved: bool,
}

/// Everything needed to apply and to invert the matrix of an implicit stage.
#[derive(Default)]
pub struct Stage {
    /// Key of the operators below; `None`: there are none.
    key: Option<StageKey>,
    conductance: Vec<[f64; 3]>,
    pub wheel: BodyOperator,
    pub rail: BodyOperator,
    /// Contact elements and nodes, counted from the first of the zone.
    pub elements: Range<usize>,
    nodes: Range<usize>,
    /// `1 + β (G_wheel C̃_wheel + G_rail C̃_rail)`: its inverse turns a temperature difference into the part that
    /// conduction through the contact leaves.
    coupling: Coupling,
    /// Temperature of the wheel less that of the rail at the contact nodes, of the field that was multiplied last.
    pub jump: Vec<f64>,
    /// Rate of that jump, from the field that was solved for last.
    pub growth: Vec<f64>,
}

impl Stage {
    /// Prepares the operators; does nothing where they have not changed.
    pub fn set(&mut self, layout: &HeatLayout, conductance: &[[f64; 3]], key: StageKey) -> Result<(), HeatError> {
        if self.key == Some(key) && self.conductance == conductance {
            return Ok(());
        }
        self.key = None;
        self.conductance.clear();
        self.conductance.extend_from_slice(conductance);
        self.elements = conducting(conductance);
        self.nodes = if self.elements.is_empty() { 0..0 } else { self.elements.start..self.elements.end + 1 };
        let StageKey { speeds, inverted, coefficients, rate, .. } = key;
        let radius = layout.config.wheel.radius;
        let streams = |[velocity, omega]: [f64; 2]| [-omega * radius, -velocity];
        let (present, shared) = (streams(speeds), streams(inverted));
        let keys = [(&layout.wheel, shared[0]), (&layout.rail, shared[1])].map(|(body, speed)| InverseKey {
            speed,
            coefficients,
            rate,
            nodes: self.contact_nodes(body),
        });
        let moments = &self.conductance[self.elements.clone()];
        let bodies = [(&layout.wheel, &mut self.wheel), (&layout.rail, &mut self.rail)];
        for (((body, operator), speed), key) in bodies.into_iter().zip(present).zip(&keys) {
            operator.transport.set(&body.line, speed, rate, body.heat_capacity, body.conductivity);
            operator.inverses.set(body, key)?;
            if !moments.is_empty() {
                operator.contact.set(moments, &operator.transport.upwind[key.nodes.start..]);
                operator.inverted.set(moments, &operator.inverses.present().upwind);
            }
        }
        if !moments.is_empty() {
            self.set_coupling(layout, keys, even_conductance(&layout.config.thermal))?;
        }
        self.key = Some(key);
        Ok(())
    }

    /// Prepares conduction through the contact between the present inverses; `even` is the conductance of all places.
    fn set_coupling(&mut self, layout: &HeatLayout, keys: [InverseKey; 2], even: Option<f64>) -> Result<(), HeatError> {
        let conduction = Conduction {
            moments: &self.conductance[self.elements.clone()],
            lengths: &layout.wheel.line.lengths[keys[0].nodes.start..keys[0].nodes.end - 1],
            even,
            flow: keys[0].coefficients.flow,
            sides: [&self.wheel, &self.rail].map(|body| (body.inverses.present(), &body.inverted)),
        };
        self.coupling.set(keys, &conduction)
    }

    /// True where conduction along the streamlines of the wheel is exact.
    pub fn is_curved(&self) -> bool {
        self.key.is_some_and(|key| key.curved)
    }

    /// True where heat is conducted through the contact.
    pub fn coupled(&self) -> bool {
        !self.nodes.is_empty()
    }

    /// Contact nodes counted in a body.
    fn contact_nodes(&self, body: &HeatBody) -> Range<usize> {
        let first = body.line.zone;
        first + self.nodes.start..first + self.nodes.end
    }

    /// `out ← S x` with the exact operator, both bodies one after the other in `x`.
    pub fn multiply(&mut self, layout: &HeatLayout, coefficients: StageCoefficients, x: &[f64], out: &mut [f64]) {
        let [x_wheel, x_rail] = layout.split(x);
        let [wheel, rail] = layout.split_mut(out);
        coefficients.multiply(&layout.wheel, &self.wheel.transport, x_wheel, wheel, Update::Replace);
        coefficients.multiply(&layout.rail, &self.rail.transport, x_rail, rail, Update::Replace);
        self.add_conduction(layout, coefficients, x, out);
    }

    /// Prepares [`Self::multiply_still`] for the present operators.
    pub fn set_still(&mut self, layout: &HeatLayout) {
        for (body, operator) in [(&layout.wheel, &mut self.wheel), (&layout.rail, &mut self.rail)] {
            operator.still.set_still(&operator.transport, &body.line, body.conductivity);
        }
    }

    /// `out ← out + S x` without the heat that the stream carries.
    pub fn multiply_still(&mut self, layout: &HeatLayout, coefficients: StageCoefficients, x: &[f64], out: &mut [f64]) {
        let [x_wheel, x_rail] = layout.split(x);
        let [wheel, rail] = layout.split_mut(out);
        coefficients.multiply(&layout.wheel, &self.wheel.still, x_wheel, wheel, Update::Add);
        coefficients.multiply(&layout.rail, &self.rail.still, x_rail, rail, Update::Add);
        self.add_conduction(layout, coefficients, x, out);
    }

    /// Adds the conduction that is no part of the modal solver: exact conduction along the streamlines, and that
    /// through the contact.
    fn add_conduction(&mut self, layout: &HeatLayout, coefficients: StageCoefficients, x: &[f64], out: &mut [f64]) {
        let x_wheel = &x[..layout.wheel.size()];
        let [wheel, rail] = layout.split_mut(out);
        if self.is_curved() {
            coefficients.add_curvature(&layout.wheel, x_wheel, wheel, &mut self.wheel.work);
        }
        if self.coupled() {
            self.set_jump(layout, x);
            for (body, operator, factor, out) in [
                (&layout.wheel, &mut self.wheel, coefficients.flow, wheel),
                (&layout.rail, &mut self.rail, -coefficients.flow, rail),
            ] {
                operator.contact.set_load(factor, &self.jump, &mut operator.load);
                body.add_surface_load(body.line.zone + self.nodes.start, &operator.load, out);
            }
        }
    }

    /// Fills [`Self::jump`] for the field `x`.
    pub fn set_jump(&mut self, layout: &HeatLayout, x: &[f64]) {
        let [wheel, rail] = layout.split(x);
        let (at_wheel, at_rail) = (self.contact_nodes(&layout.wheel), self.contact_nodes(&layout.rail));
        layout.wheel.trace(at_wheel, wheel, &mut self.wheel.trace);
        layout.rail.trace(at_rail, rail, &mut self.rail.trace);
        self.jump.clear();
        self.jump.extend(self.wheel.trace.iter().zip(&self.rail.trace).map(|(a, b)| a - b));
    }

    /// Fills [`Self::jump`] for the field `x` and `ahead` times its rate, which a stage from `x` has just been solved
    /// for.
    pub fn set_jump_ahead(&mut self, layout: &HeatLayout, x: &[f64], rate: Option<&[f64]>, ahead: f64) {
        let Some(rate) = rate.filter(|_| ahead != 0.0) else { return self.set_jump(layout, x) };
        // The modal solver leaves both; an iteration around it does not.
        if self.is_curved() {
            self.set_jump(layout, rate);
            std::mem::swap(&mut self.jump, &mut self.growth);
            self.set_jump(layout, x);
        }
        self.jump.iter_mut().zip(&self.growth).for_each(|(jump, growth)| *jump += ahead * growth);
    }

    /// `x ← P⁻¹ x` with the operator of the modal solver.
    pub fn invert(&mut self, layout: &HeatLayout, x: &mut [f64]) {
        let Some(StageKey { coefficients, .. }) = self.key else { return };
        let nodes = layout.bodies().map(|body| self.contact_nodes(body));
        let coupled = self.coupled();
        let [wheel, rail] = layout.split_mut(x);
        let bodies = [(&layout.wheel, &mut self.wheel, wheel), (&layout.rail, &mut self.rail, rail)];
        for ((body, operator, x), nodes) in bodies.into_iter().zip(&nodes) {
            let BodyOperator { inverses, trace, .. } = operator;
            let factor = inverses.factor();
            factor.eliminate(body, x);
            if coupled {
                factor.trace(body, nodes, x, trace);
            }
        }
        if coupled {
            self.growth.clear();
            self.growth.extend(self.wheel.trace.iter().zip(&self.rail.trace).map(|(a, b)| a - b));
            self.coupling.solve(&mut self.growth);
        }
        let [wheel, rail] = layout.split_mut(x);
        let bodies = [
            (&layout.wheel, &mut self.wheel, -coefficients.flow, wheel),
            (&layout.rail, &mut self.rail, coefficients.flow, rail),
        ];
        for ((body, operator, flow, x), nodes) in bodies.into_iter().zip(&nodes) {
            if coupled {
                operator.inverted.set_load(flow, &self.growth, &mut operator.load);
            }
            let factor = operator.inverses.factor();
            if coupled {
                factor.add_eliminated(body, nodes, &operator.load, x);
            }
            factor.substitute(body, x);
        }
    }
}

#[cfg(test)]
impl Stage {
    /// Temperature difference that conduction through the contact leaves of `jump`, by kept factors where it is `even`,
    /// else by those of the matrix itself.
    pub fn left_of(&mut self, layout: &HeatLayout, even: Option<f64>, jump: &[f64]) -> Vec<f64> {
        let key = |operator: &BodyOperator| operator.inverses.key().clone();
        let keys = [key(&self.wheel), key(&self.rail)];
        self.set_coupling(layout, keys, even).unwrap();
        assert_eq!(self.coupling.is_kept(), even.is_some());
        let mut left = jump.to_vec();
        self.coupling.solve(&mut left);
        left
    }

    /// Surface temperatures of the rail at the contact nodes under a wheel at a uniform temperature; the nodes.
    pub fn rail_under_uniform_wheel(&mut self, wheel: f64) -> (Range<usize>, Vec<f64>) {
        let n = self.nodes.len();
        let (mut matrix, mut surface) = (crate::linalg::DenseSystem::default(), vec![0.0; n]);
        matrix.reset(n);
        for (i, gain) in surface.iter_mut().enumerate() {
            let row = matrix.row(i).0;
            self.rail.inverted.add_coupling(1.0, self.rail.inverses.present().response.row(i), row);
            *gain = wheel * row.iter().sum::<f64>();
            row[i] += 1.0;
        }
        assert!(matrix.factorise() && matrix.solve_with(&mut surface));
        (self.nodes.clone(), surface)
    }
}
