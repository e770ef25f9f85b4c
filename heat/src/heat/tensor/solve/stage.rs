//! Matrix of an implicit stage: applied exactly, inverted mode by mode, coupled through the contact of every line.

use super::coefficients::StageCoefficients;
use super::line_conduction::LineConduction;
use super::operators::{StageKey, StageOperators};
use crate::heat::error::HeatError;
use crate::heat::tensor::mesh::layout::HeatLayout;
use crate::linalg::Update;
use crate::linalg::gmres::{Gmres, LinearSystem};

/// Angular velocity [rad/s] below which, and step [s] from which on, conduction along the streamlines is computed
/// exactly.
///
/// The direct solver works mode by mode. For that it replaces the factor `1/r` of conduction around the wheel by
/// `r/r_o²`, which is right at the tread. In a wheel that turns, the stream outweighs conduction around it, and nothing
/// is lost. In a standing wheel heat spreads around the hub, too, and an iteration (GMRES) corrects the solution; short
/// steps do not need it, since heat does not come far. Measured without correction, relative: faster rolling 1e-6 in
/// all stationary temperatures; locked wheel 4e-5 in the maxima and 2e-3 in the wheel's mean after 10 s (stationary
/// 5e-4 and 8e-2).
pub const CURVED_BELOW: f64 = 1.0;
pub const CURVED_STEP: f64 = 0.01;

/// Relative residual of the exact operator at which its correction stops, in steps and in the stationary state, and at
/// which it is accepted where round-off stops it. In steps the heat balance holds at any residual: the part that the
/// modal solver leaves out moves heat along the streamlines only.
const STEP_TOLERANCE: f64 = 1e-10;
const STATIONARY_TOLERANCE: f64 = 1e-13;
const ACCEPTED: f64 = 1e-9;

/// Weights of a rate: what flows in the field takes from it.
pub const RATE: StageCoefficients = StageCoefficients { storage: 0.0, flow: -1.0 };

/// A field of both bodies, one after the other, and the contact of its line.
pub type LineField<'a> = (&'a mut LineConduction, &'a mut [f64]);

impl StageOperators {
    /// `out ← S x` with the exact operator for the field x of a line.
    pub fn multiply(
        &mut self,
        layout: &HeatLayout,
        coefficients: StageCoefficients,
        x: &[f64],
        (line, out): LineField,
    ) {
        for (i, operator) in self.bodies().into_iter().enumerate() {
            let (body, x, out) = (layout.bodies()[i], layout.part(i, x), layout.part_mut(i, out));
            coefficients.multiply(body, &operator.transport, x, out, Update::Replace);
        }
        self.add_conduction(layout, coefficients, x, (line, out));
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
        for (i, operator) in self.bodies().into_iter().enumerate() {
            let (body, x, out) = (layout.bodies()[i], layout.part(i, x), layout.part_mut(i, out));
            coefficients.multiply(body, &operator.still, x, out, Update::Add);
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
        if self.is_curved() {
            let (x, wheel) = (layout.part(0, x), layout.part_mut(0, out));
            coefficients.add_curvature(&layout.wheel, x, wheel, &mut self.wheel.work);
        }
        line.add_conduction(layout, coefficients.flow, x, out);
    }

    /// `x ← P⁻¹ x` with the operator of the modal solver for the field x of a line.
    pub fn invert(&mut self, layout: &HeatLayout, (line, x): LineField) {
        for (i, operator) in [&mut self.wheel, &mut self.rail].into_iter().enumerate() {
            operator.inverses.factor().eliminate(layout.bodies()[i], layout.part_mut(i, x));
        }
        self.finish(layout, (line, x));
    }

    /// Replaces `out` by the rate of the field x of a line under its surface loads and, with [`Update::Add`], the loads that
    /// `out` holds. Only where the modal solver is exact.
    pub fn find_rate(&mut self, layout: &HeatLayout, x: &[f64], (line, out): LineField, update: Update) {
        for (i, operator) in [&mut self.wheel, &mut self.rail].into_iter().enumerate() {
            let (body, x, out) = (layout.bodies()[i], layout.part(i, x), layout.part_mut(i, out));
            let product = RATE.operator(body, &operator.transport);
            operator.inverses.factor().load(body, &product, &line.sides[i].surface, x, out, update);
        }
        self.finish(layout, (line, out));
    }

    /// Turns loads that have been eliminated into the field that bears them, conduction through the contact included.
    fn finish(&mut self, layout: &HeatLayout, (line, x): LineField) {
        let Some(StageKey { coefficients, .. }) = self.key() else { return };
        let operators = [&mut self.wheel, &mut self.rail];
        if line.coupled() {
            for (i, operator) in operators.iter().enumerate() {
                let body = layout.bodies()[i];
                let (nodes, factor) = (line.nodes(body), &operator.inverses.present().factor);
                factor.surface(body, &nodes, layout.part(i, x), &mut line.sides[i].trace);
            }
            line.conduct(coefficients.flow);
        }
        for (i, operator) in operators.into_iter().enumerate() {
            let (body, factor, x) = (layout.bodies()[i], operator.inverses.factor(), layout.part_mut(i, x));
            if line.coupled() {
                factor.add_load(body, line.nodes(body).start, &mut line.sides[i].load, x);
            }
            factor.substitute(body, x);
        }
    }
}

/// Equations of an implicit stage, and the iteration that corrects their approximate solution.
#[derive(Default)]
pub struct Stage {
    pub operators: StageOperators,
    gmres: Gmres,
}

impl Stage {
    /// `x ← S⁻¹ x` for the field x of a line, with the exact operator where it matters; the number of iterations of its
    /// correction.
    pub fn solve(
        &mut self,
        layout: &HeatLayout,
        coefficients: StageCoefficients,
        (line, x): LineField,
    ) -> Result<usize, HeatError> {
        let Self { operators, gmres } = self;
        if !operators.is_curved() {
            operators.invert(layout, (line, x));
            return Ok(0);
        }
        let tolerance = if coefficients.storage > 0.0 { STEP_TOLERANCE } else { STATIONARY_TOLERANCE };
        let mut system = ExactOperator { operators, layout, coefficients, line };
        gmres.solve(&mut system, x, tolerance, ACCEPTED).map_err(|stopped| HeatError::NotConverged {
            residual: stopped.residual,
            iterations: stopped.iterations,
            direct_below: CURVED_STEP,
        })
    }
}

/// Exact operator with the modal solver as its preconditioner.
struct ExactOperator<'a> {
    operators: &'a mut StageOperators,
    layout: &'a HeatLayout,
    coefficients: StageCoefficients,
    line: &'a mut LineConduction,
}

impl LinearSystem for ExactOperator<'_> {
    fn apply(&mut self, x: &[f64], out: &mut [f64]) {
        self.operators.multiply(self.layout, self.coefficients, x, (&mut *self.line, out));
    }

    fn precondition(&mut self, x: &mut [f64]) {
        self.operators.invert(self.layout, (&mut *self.line, x));
    }
}
