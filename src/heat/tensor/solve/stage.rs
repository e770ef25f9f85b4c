//! Matrix of an implicit stage: applied exactly, inverted mode by mode, coupled through the contact of every line.

use super::coefficients::StageCoefficients;
use super::line_conduction::LineConduction;
use super::operators::{StageKey, StageOperators};
use crate::heat::tensor::mesh::layout::HeatLayout;
use crate::linalg::Update;

/// Everything needed to apply and to invert the matrix of an implicit stage, but for the contact of each line.
#[derive(Default)]
pub struct Stage {
    pub operators: StageOperators,
}

/// A field of both bodies, one after the other, and the contact of its line.
pub type LineField<'a> = (&'a mut LineConduction, &'a mut [f64]);

impl Stage {
    /// `out ← S x` with the exact operator for the fields x of some lines.
    pub fn multiply<const L: usize>(
        &mut self,
        layout: &HeatLayout,
        coefficients: StageCoefficients,
        fields: [&[f64]; L],
        mut out: [LineField; L],
    ) {
        for (i, operator) in self.operators.bodies().into_iter().enumerate() {
            let x = fields.map(|x| layout.part(i, x));
            let products = out.each_mut().map(|(_, out)| layout.part_mut(i, out));
            coefficients.multiply(layout.bodies()[i], &operator.transport, x, products, Update::Replace);
        }
        for (x, (line, out)) in fields.into_iter().zip(out) {
            self.add_conduction(layout, coefficients, x, (line, out));
        }
    }

    /// `out ← out + S x` for the field x of a line without the heat that the stream carries; after
    /// [`StageOperators::set_still`].
    pub fn multiply_still(
        &mut self,
        layout: &HeatLayout,
        coefficients: StageCoefficients,
        x: &[f64],
        (line, out): LineField,
    ) {
        for (i, operator) in self.operators.bodies().into_iter().enumerate() {
            let (body, x, out) = (layout.bodies()[i], layout.part(i, x), layout.part_mut(i, out));
            coefficients.multiply(body, &operator.still, [x], [out], Update::Add);
        }
        self.add_conduction(layout, coefficients, x, (line, out));
    }

    /// Adds the conduction that is no part of the modal solver: exact conduction along the streamlines, and that
    /// through the contact.
    fn add_conduction(
        &mut self,
        layout: &HeatLayout,
        coefficients: StageCoefficients,
        x: &[f64],
        (line, out): LineField,
    ) {
        if self.operators.is_curved() {
            let (x, wheel) = (layout.part(0, x), layout.part_mut(0, out));
            coefficients.add_curvature(&layout.wheel, x, wheel, &mut self.operators.wheel.work);
        }
        line.add_conduction(layout, coefficients.flow, x, out);
    }

    /// `x ← P⁻¹ x` with the operator of the modal solver for the fields x of some lines.
    pub fn invert<const L: usize>(&mut self, layout: &HeatLayout, mut lines: [LineField; L]) {
        let Some(StageKey { coefficients, .. }) = self.operators.key() else { return };
        for (i, operator) in [&mut self.operators.wheel, &mut self.operators.rail].into_iter().enumerate() {
            let (body, factor) = (layout.bodies()[i], operator.inverses.factor());
            factor.eliminate(body, lines.each_mut().map(|(_, x)| layout.part_mut(i, x)));
            for (line, x) in lines.iter_mut().filter(|(line, _)| line.coupled()) {
                let nodes = line.nodes(body);
                factor.trace(body, &nodes, layout.part(i, x), &mut line.sides[i].trace);
            }
        }
        for (line, _) in lines.iter_mut().filter(|(line, _)| line.coupled()) {
            line.conduct(coefficients.flow);
        }
        for (i, operator) in [&mut self.operators.wheel, &mut self.operators.rail].into_iter().enumerate() {
            let (body, factor) = (layout.bodies()[i], operator.inverses.factor());
            for (line, x) in lines.iter_mut().filter(|(line, _)| line.coupled()) {
                let first = line.nodes(body).start;
                factor.add_eliminated(body, first, &mut line.sides[i].load, layout.part_mut(i, x));
            }
            factor.substitute(body, lines.each_mut().map(|(_, x)| layout.part_mut(i, x)));
        }
    }
}
