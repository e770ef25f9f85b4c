//! Solution of the equations of an implicit stage.

use super::coefficients::StageCoefficients;
use super::line_conduction::LineConduction;
use super::stage::{LineField, Stage};
use crate::heat::error::HeatError;
use crate::heat::tensor::mesh::layout::HeatLayout;
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

/// Matrix of a stage and the iteration that corrects its approximate inverse.
#[derive(Default)]
pub struct StageSolver {
    /// Matrix of the stage.
    pub stage: Stage,
    gmres: Gmres,
}

impl StageSolver {
    /// `x ← S⁻¹ x` for the fields x of some lines, with the exact operator where it matters; the numbers of iterations
    /// of its correction.
    pub fn solve<const L: usize>(
        &mut self,
        layout: &HeatLayout,
        coefficients: StageCoefficients,
        lines: [LineField; L],
    ) -> Result<[usize; L], HeatError> {
        let Self { stage, gmres } = self;
        let mut iterations = [0; L];
        if !stage.operators.is_curved() {
            stage.invert(layout, lines);
            return Ok(iterations);
        }
        let tolerance = if coefficients.storage > 0.0 { STEP_TOLERANCE } else { STATIONARY_TOLERANCE };
        for ((line, x), iterations) in lines.into_iter().zip(&mut iterations) {
            let mut system = ExactOperator { stage, layout, coefficients, line };
            let solved = gmres.solve(&mut system, x, tolerance, ACCEPTED);
            *iterations = solved.map_err(|stopped| HeatError::NotConverged {
                residual: stopped.residual,
                iterations: stopped.iterations,
                direct_below: CURVED_STEP,
            })?;
        }
        Ok(iterations)
    }
}

/// Exact operator with the modal solver as its preconditioner.
struct ExactOperator<'a> {
    stage: &'a mut Stage,
    layout: &'a HeatLayout,
    coefficients: StageCoefficients,
    line: &'a mut LineConduction,
}

impl LinearSystem for ExactOperator<'_> {
    fn apply(&mut self, x: &[f64], out: &mut [f64]) {
        self.stage.multiply(self.layout, self.coefficients, [x], [(&mut *self.line, out)]);
    }

    fn precondition(&mut self, x: &mut [f64]) {
        self.stage.invert(self.layout, [(&mut *self.line, x)]);
    }
}
