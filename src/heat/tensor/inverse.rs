//! Inverses of the matrices of one body, kept for the steps that share them.

use super::modal::{HeatBody, StageCoefficients};
use super::response::SurfaceResponse;
use super::streamline::Transport;
use super::tridiagonal::TridiagonalFactor;
use crate::heat::error::HeatError;
use std::ops::Range;

/// What the matrix of an implicit stage in one body depends on.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct InverseKey {
    /// Speed of the stream [m/s].
    pub speed: f64,
    /// Weights of storage and flow.
    pub coefficients: StageCoefficients,
    /// Inverse of the step that upwinding sees [1/s].
    pub rate: f64,
    /// Nodes of the contact, counted in the body.
    pub nodes: Range<usize>,
}

/// Factors of the matrix of one body, and how its surface responds to loads on the contact.
#[derive(Clone, Debug, Default)]
pub(super) struct Inverse {
    /// `None`: nothing is prepared.
    key: Option<InverseKey>,
    pub factor: TridiagonalFactor,
    /// Surface temperatures at the contact nodes under unit loads there.
    pub response: SurfaceResponse,
    /// `ρc|v|` where the stream leaves an open streamline [W/(m² K)].
    pub exit: f64,
}

/// The inverses that were used last, the present one first.
#[derive(Clone, Debug, Default)]
pub(super) struct Inverses {
    kept: Vec<Inverse>,
    /// Matrices along the streamlines from which the last inverse was made.
    transport: Transport,
}

/// Inverses that are kept of one body: eight wheels that drive in turn may need two each.
const KEPT: usize = 16;

impl Inverses {
    /// Makes the inverse of `key` the present one; computes it unless it is kept.
    pub fn set(&mut self, body: &HeatBody, key: InverseKey) -> Result<(), HeatError> {
        let known = self.kept.iter().position(|inverse| inverse.key.as_ref() == Some(&key));
        let place = known.unwrap_or_else(|| {
            if self.kept.len() < KEPT {
                self.kept.push(Inverse::default());
            }
            self.kept.len() - 1
        });
        self.kept[..=place].rotate_right(1);
        if known.is_some() {
            return Ok(());
        }
        let Self { kept, transport } = self;
        let present = &mut kept[0];
        present.key = None;
        transport.set(&body.line, key.speed, key.rate, body.heat_capacity, body.conductivity);
        present.exit = transport.exit.map_or(0.0, |(_, flux)| flux);
        present.factor.set(body, transport, key.coefficients, &key.nodes)?;
        if !key.nodes.is_empty() {
            present.response.set(&present.factor, body, key.nodes.clone());
        }
        present.key = Some(key);
        Ok(())
    }

    /// The present inverse.
    ///
    /// # Panics
    /// If none was ever set.
    pub fn present(&mut self) -> &mut Inverse {
        &mut self.kept[0]
    }
}
