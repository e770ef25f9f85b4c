//! The passes of a stage over a body alone, for measurements beside other loops over the same arrays.

use super::heat::Heat;
use super::mesh::kernels::{self, Advance};
use super::solve::coefficients::StageCoefficients;
use super::solve::stage::RATE;
use super::solve::transport::Transport;
use super::solve::tridiagonal::TridiagonalFactor;
use crate::heat::error::HeatError;
use crate::linalg::Update;

/// Stage of the wheel without a rail.
pub struct WheelStage<'a> {
    heat: &'a Heat,
    transport: Transport,
    factor: TridiagonalFactor,
    /// Step that upwinding sees, and by which the field is taken on \[s].
    dt: f64,
}

impl<'a> WheelStage<'a> {
    /// Stage of `dt` \[s] at the stream velocity `speed` [m/s].
    pub fn new(heat: &'a Heat, speed: f64, dt: f64) -> Result<Self, HeatError> {
        let (body, mut transport, mut factor) =
            (&heat.layout.wheel, Transport::default(), TridiagonalFactor::default());
        transport.set(&body.streamline, speed, 1.0 / dt, body.heat_capacity, body.conductivity);
        factor.set(body, &transport, StageCoefficients { storage: 1.0, flow: dt }, &(0..0))?;
        Ok(Self { heat, transport, factor, dt })
    }

    /// Rows `[below, sum, above, from, to]` of the matrices, of nodes.
    pub fn rows(&self) -> &[[f64; 5]] {
        &self.transport.rows
    }

    /// Factors w, r and inverse pivots of the nodes, row and column of the last node of the first ones.
    pub fn factors(&self) -> [&[f64]; 5] {
        let TridiagonalFactor { w, r, inverse, row, column, .. } = &self.factor;
        [w, r, inverse, row, column]
    }

    /// Weights α of the modes in the rate, their surface values and peaks, and the weights of the nodes.
    pub fn weights(&self) -> [Vec<f64>; 4] {
        let body = &self.heat.layout.wheel;
        let alpha = body.modes.values.iter().map(|value| -body.conductivity * value).collect();
        [alpha, body.modes.surface.clone(), body.nodal.peaks.clone(), body.streamline.weights.clone()]
    }

    /// The passes: from the field `from` under surface loads to its rate, the field `next`, the sums of the rate and
    /// how far values have `moved`.
    pub fn run(&mut self, loads: &[f64], from: &[f64], [rate, next, sums, moved]: [&mut [f64]; 4]) {
        let Self { heat, transport, factor, dt } = self;
        let body = &heat.layout.wheel;
        factor.load(body, &RATE.operator(body, transport), loads, from, rate, Update::Replace);
        factor.substitute(body, rate);
        let (weights, peaks) = (&body.streamline.weights, &body.nodal.peaks);
        let stage = Advance { rate, ahead: *dt, from, begin: from, weights, peaks };
        kernels::advance(true, &stage, next, sums, moved);
    }
}
