//! States of an instance.

use super::lifecycle::Phase;
use crate::AXLES;
use crate::coupling::{Running, Seen};
use crate::parameters::Parameters;

/// Everything that is needed to continue a run.
#[derive(Clone, Debug)]
pub struct Snapshot {
    pub(super) phase: Phase,
    pub(super) parameters: Parameters,
    pub(super) seen: [Seen; AXLES],
    pub(super) demand: f64,
    pub(super) running: Option<Running>,
    pub(super) time: f64,
}

/// Why there are no bytes.
const NONE: &str = "states of the coach cannot be serialized";

impl Snapshot {
    /// Refuses: the description promises no serialization.
    pub fn to_bytes(&self) -> Result<Vec<u8>, String> {
        Err(NONE.to_owned())
    }

    /// Refuses, as [`Snapshot::to_bytes`].
    pub fn from_bytes(_bytes: &[u8]) -> Result<Self, String> {
        Err(NONE.to_owned())
    }
}
