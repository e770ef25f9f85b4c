//! Streams and factors of an implicit stage: all of its matrix that lines side by side have in common.

use super::coefficients::StageCoefficients;
use super::inverse::{InverseKey, Inverses};
use super::transport::Transport;
use crate::heat::error::HeatError;
use crate::heat::tensor::mesh::layout::HeatLayout;

/// Stream and factors of one body, and its buffer.
#[derive(Clone, Debug, Default)]
pub struct BodyOperator {
    pub transport: Transport,
    /// Conduction alone; set where steel melts.
    pub still: Transport,
    pub inverses: Inverses,
    /// Buffer of a field.
    pub work: Vec<f64>,
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
    /// First node that any line touches, and one past the last, counted from the first of the zone; equal: none.
    pub contact: [usize; 2],
}

impl StageKey {
    /// Keys of the inverses of wheel and rail.
    pub fn inverses(&self, layout: &HeatLayout) -> [InverseKey; 2] {
        let Self { coefficients, rate, contact: [start, end], .. } = *self;
        let streams = streams(layout, self.inverted);
        [(&layout.wheel, streams[0]), (&layout.rail, streams[1])].map(|(body, speed)| {
            let first = body.streamline.zone;
            InverseKey { speed, coefficients, rate, nodes: first + start..first + end }
        })
    }
}

/// Velocities of the streams of wheel and rail at the speeds V and Ω [m/s].
pub fn streams(layout: &HeatLayout, [velocity, omega]: [f64; 2]) -> [f64; 2] {
    [-omega * layout.config.radius, -velocity]
}

/// Matrices and inverses of both bodies in a stage.
#[derive(Default)]
pub struct StageOperators {
    /// Key of the operators below; `None`: there are none.
    key: Option<StageKey>,
    pub wheel: BodyOperator,
    pub rail: BodyOperator,
}

impl StageOperators {
    /// Prepares the operators; does nothing where they have not changed.
    pub fn set(&mut self, layout: &HeatLayout, key: StageKey) -> Result<(), HeatError> {
        if self.key == Some(key) {
            return Ok(());
        }
        self.key = None;
        let bodies = [(&layout.wheel, &mut self.wheel), (&layout.rail, &mut self.rail)];
        let present = streams(layout, key.speeds);
        for (((body, operator), speed), inverse) in bodies.into_iter().zip(present).zip(&key.inverses(layout)) {
            operator.transport.set(&body.streamline, speed, key.rate, body.heat_capacity, body.conductivity);
            operator.inverses.set(body, inverse)?;
        }
        self.key = Some(key);
        Ok(())
    }

    /// Key of the present operators.
    pub fn key(&self) -> Option<StageKey> {
        self.key
    }

    /// Operators of wheel and rail.
    pub fn bodies(&self) -> [&BodyOperator; 2] {
        [&self.wheel, &self.rail]
    }

    /// True where conduction along the streamlines of the wheel is exact.
    pub fn is_curved(&self) -> bool {
        self.key.is_some_and(|key| key.curved)
    }

    /// Prepares conduction alone for the present operators.
    pub fn set_still(&mut self, layout: &HeatLayout) {
        for (body, operator) in [(&layout.wheel, &mut self.wheel), (&layout.rail, &mut self.rail)] {
            operator.still.set_still(&operator.transport, &body.streamline, body.conductivity);
        }
    }
}
