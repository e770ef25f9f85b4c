//! Inverses of the matrices of one body, kept for the steps that share them.

use super::coefficients::StageCoefficients;
use super::response::SurfaceInfluence;
use super::transport::Transport;
use super::tridiagonal::TridiagonalFactor;
use crate::heat::error::HeatError;
use crate::heat::tensor::mesh::body::HeatBody;
use crate::lru::Lru;
use std::ops::Range;

/// Data on which the matrix of an implicit stage in one body depends.
#[derive(Clone, Debug, PartialEq)]
pub struct InverseKey {
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
pub struct Inverse {
    pub factor: TridiagonalFactor,
    /// Surface temperatures at the contact nodes under unit loads there.
    pub response: SurfaceInfluence,
    /// Upwinding `τ v / h` on the elements of the contact [1].
    pub upwind: Vec<f64>,
    /// `ρc|v|` where the stream leaves an open streamline [W/(m² K)].
    pub exit: f64,
}

/// Inverses that were used last.
#[derive(Clone, Debug, Default)]
pub struct Inverses {
    kept: Lru<InverseKey, Inverse>,
    /// Matrices along the streamlines from which the last inverse was made.
    transport: Transport,
}

impl Inverses {
    /// Makes the inverse of `key` the present one; computes it unless it is kept.
    pub fn set(&mut self, body: &HeatBody, key: &InverseKey) -> Result<(), HeatError> {
        let transport = &mut self.transport;
        self.kept.select(key.clone(), |inverse| {
            let InverseKey { speed, coefficients, rate, ref nodes } = *key;
            transport.set(&body.streamline, speed, rate, body.heat_capacity, body.conductivity);
            inverse.exit = transport.exit.map_or(0.0, |(_, flux)| flux);
            inverse.factor.set(body, transport, coefficients, nodes)?;
            inverse.upwind.clear();
            if !nodes.is_empty() {
                inverse.upwind.extend_from_slice(&transport.upwind[nodes.start..nodes.end - 1]);
                inverse.response.set(&inverse.factor, body, nodes.clone());
            }
            Ok(())
        })
    }

    /// Present inverse.
    ///
    /// # Panics
    /// If none was ever set.
    pub fn present(&self) -> &Inverse {
        self.kept.present()
    }

    /// Factors of the present inverse, with their buffers.
    ///
    /// # Panics
    /// If none was ever set.
    pub fn factor(&mut self) -> &mut TridiagonalFactor {
        &mut self.kept.present_mut().factor
    }
}
