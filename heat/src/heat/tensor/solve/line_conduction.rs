//! Conduction through the contact of one line, and its buffers: what lines that share a stage do not share.

use super::conductance::{ContactBands, conducting};
use super::coupling::{Conduction, Coupling};
use super::operators::{StageKey, StageOperators};
use crate::heat::error::HeatError;
use crate::heat::tensor::mesh::body::HeatBody;
use crate::heat::tensor::mesh::layout::HeatLayout;
use std::ops::Range;

/// One side of a contact, and buffers of the fields of that body.
#[derive(Clone, Debug, Default)]
pub struct ContactSide {
    /// Conductance on the contact nodes: of the present stream, and of that of the inverse.
    pub present: ContactBands,
    pub inverted: ContactBands,
    /// Surface temperatures at the contact nodes.
    pub trace: Vec<f64>,
    /// Load at surface nodes, of conduction through the contact and of a stage.
    pub load: Vec<f64>,
    pub surface: Vec<f64>,
    /// Field and its rate, summed along the streamlines.
    pub sums: [Vec<f64>; 2],
}

/// Contact of one line in a stage.
#[derive(Default)]
pub struct LineConduction {
    /// Key of the stage to which the matrices below belong; `None`: there are none.
    key: Option<StageKey>,
    conductance: Vec<[f64; 3]>,
    /// Contact elements and nodes, counted from the first of the zone.
    pub elements: Range<usize>,
    nodes: Range<usize>,
    /// Wheel and rail.
    pub sides: [ContactSide; 2],
    /// `1 + β (G_wheel C̃_wheel + G_rail C̃_rail)`: its inverse turns a temperature difference into the part that
    /// conduction through the contact leaves.
    coupling: Coupling,
    /// Temperature of the wheel less that of the rail at the contact nodes, of the field that was multiplied last.
    pub jump: Vec<f64>,
    /// Rate of that jump, from the field that was solved for last.
    pub growth: Vec<f64>,
}

/// First contact node and one past the last, counted from the first of the zone, under the moments of the conductance
/// on its elements; equal without contact.
pub fn contact_nodes(conductance: &[[f64; 3]]) -> [usize; 2] {
    let elements = conducting(conductance);
    if elements.is_empty() { [0; 2] } else { [elements.start, elements.end + 1] }
}

impl LineConduction {
    /// Prepares conduction under the moments `conductance` on the elements of the zone for the present operators of
    /// `stage`, among whose contact nodes are all of this line; does nothing where nothing has changed.
    pub fn set(
        &mut self,
        stage: &StageOperators,
        layout: &HeatLayout,
        conductance: &[[f64; 3]],
    ) -> Result<(), HeatError> {
        let Some(key) = stage.key() else { return Ok(()) };
        if self.key == Some(key) && self.conductance == conductance {
            return Ok(());
        }
        self.key = None;
        self.conductance.clear();
        self.conductance.extend_from_slice(conductance);
        self.elements = conducting(conductance);
        let [start, end] = contact_nodes(conductance);
        self.nodes = start..end;
        if self.coupled() {
            let first = self.nodes.start - key.contact[0];
            let moments = &self.conductance[self.elements.clone()];
            let bodies = layout.bodies().into_iter().zip(stage.bodies()).zip(&mut self.sides);
            for ((body, operator), side) in bodies {
                side.present.set(moments, &operator.transport.upwind[body.streamline.zone + self.nodes.start..]);
                side.inverted.set(moments, &operator.inverses.present().upwind[first..]);
            }
            self.set_coupling(stage, layout, key, layout.config.conductance)?;
        }
        self.key = Some(key);
        Ok(())
    }

    /// Prepares conduction through the contact between the present inverses; `even` is the conductance of all places.
    fn set_coupling(
        &mut self,
        stage: &StageOperators,
        layout: &HeatLayout,
        key: StageKey,
        even: f64,
    ) -> Result<(), HeatError> {
        let first = layout.wheel.streamline.zone + self.nodes.start;
        let [wheel, rail] = stage.bodies().map(|operator| &operator.inverses);
        let conduction = Conduction {
            moments: &self.conductance[self.elements.clone()],
            lengths: &layout.wheel.streamline.lengths[first..first + self.nodes.len() - 1],
            even,
            flow: key.coefficients.flow,
            sides: [(wheel.present(), &self.sides[0].inverted), (rail.present(), &self.sides[1].inverted)],
            first: self.nodes.start - key.contact[0],
        };
        self.coupling.set(key.inverses(layout), &conduction)
    }

    /// True where heat is conducted through the contact.
    pub fn coupled(&self) -> bool {
        !self.nodes.is_empty()
    }

    /// Contact nodes counted in a body.
    pub fn nodes(&self, body: &HeatBody) -> Range<usize> {
        let first = body.streamline.zone;
        first + self.nodes.start..first + self.nodes.end
    }

    /// Adds `flow` times the heat that leaves both bodies through the contact in the field `x` to `out`.
    pub fn add_conduction(&mut self, layout: &HeatLayout, flow: f64, x: &[f64], out: &mut [f64]) {
        if !self.coupled() {
            return;
        }
        self.set_jump(layout, x);
        let bodies = layout.bodies().into_iter().zip(&mut self.sides).zip([flow, -flow]).zip(layout.split_mut(out));
        for (((body, side), factor), out) in bodies {
            side.load.clear();
            side.load.resize(self.nodes.len(), 0.0);
            side.present.add_load(factor, &self.jump, &mut side.load);
            body.add_surface_load(body.streamline.zone + self.nodes.start, &side.load, out);
        }
    }

    /// Adds the heat that enters both bodies through the contact in the field `x` to their surface loads.
    pub fn load_conduction(&mut self, layout: &HeatLayout, x: &[f64]) {
        if !self.coupled() {
            return;
        }
        self.set_jump(layout, x);
        for ((body, side), factor) in layout.bodies().into_iter().zip(&mut self.sides).zip([-1.0, 1.0]) {
            side.present.add_load(factor, &self.jump, &mut side.surface[body.streamline.zone + self.nodes.start..]);
        }
    }

    /// Fills [`Self::jump`] for the field `x`.
    pub fn set_jump(&mut self, layout: &HeatLayout, x: &[f64]) {
        let nodes = layout.bodies().map(|body| self.nodes(body));
        let bodies = layout.bodies().into_iter().zip(layout.split(x)).zip(nodes).zip(&mut self.sides);
        for (((body, x), nodes), side) in bodies {
            body.trace(nodes, x, &mut side.trace);
        }
        difference(&self.sides, &mut self.jump);
    }

    /// Fills [`Self::jump`] for the field `x` and `ahead` times its rate, which a stage from `x` has just been solved
    /// for.
    pub fn set_jump_ahead(
        &mut self,
        stage: &StageOperators,
        layout: &HeatLayout,
        x: &[f64],
        rate: Option<&[f64]>,
        ahead: f64,
    ) {
        let Some(rate) = rate.filter(|_| ahead != 0.0) else { return self.set_jump(layout, x) };
        // The modal solver leaves both; an iteration around it does not.
        if stage.is_curved() {
            self.set_jump(layout, rate);
            std::mem::swap(&mut self.jump, &mut self.growth);
            self.set_jump(layout, x);
        }
        self.jump.iter_mut().zip(&self.growth).for_each(|(jump, growth)| *jump += ahead * growth);
    }

    /// Fills [`Self::growth`] with the difference of the traces that conduction leaves, and the loads of both bodies
    /// that follow from it under the implicit coefficient `flow`.
    pub fn conduct(&mut self, flow: f64) {
        difference(&self.sides, &mut self.growth);
        self.coupling.solve(&mut self.growth);
        for (side, flow) in self.sides.iter_mut().zip([-flow, flow]) {
            side.load.clear();
            side.load.resize(self.growth.len(), 0.0);
            side.inverted.add_load(flow, &self.growth, &mut side.load);
        }
    }
}

/// Replaces `out` by the trace of the wheel less that of the rail.
fn difference([wheel, rail]: &[ContactSide; 2], out: &mut Vec<f64>) {
    out.clear();
    out.extend(wheel.trace.iter().zip(&rail.trace).map(|(a, b)| a - b));
}

#[cfg(test)]
impl LineConduction {
    /// Temperature difference that conduction through the contact leaves of `jump`, by kept factors where `even` is its
    /// conductance, else by those of the matrix itself.
    pub fn left_of(
        &mut self,
        stage: &StageOperators,
        layout: &HeatLayout,
        (even, kept): (f64, bool),
        jump: &[f64],
    ) -> Vec<f64> {
        self.set_coupling(stage, layout, stage.key().unwrap(), even).unwrap();
        assert_eq!(self.coupling.is_kept(), kept);
        let mut left = jump.to_vec();
        self.coupling.solve(&mut left);
        left
    }

    /// Surface temperatures of the rail at the contact nodes under a wheel at a uniform temperature; the nodes.
    pub fn rail_under_uniform_wheel(&mut self, stage: &StageOperators, wheel: f64) -> (Range<usize>, Vec<f64>) {
        let n = self.nodes.len();
        let (mut matrix, mut surface) = (crate::linalg::DenseSystem::default(), vec![0.0; n]);
        matrix.reset(n);
        for (i, gain) in surface.iter_mut().enumerate() {
            let row = matrix.row(i).0;
            self.sides[1].inverted.add_coupling(1.0, stage.rail.inverses.present().response.row(i), row);
            *gain = wheel * row.iter().sum::<f64>();
            row[i] += 1.0;
        }
        assert!(matrix.factorise() && matrix.solve_with(&mut surface));
        (self.nodes.clone(), surface)
    }
}
