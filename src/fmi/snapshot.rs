//! Everything an instance must remember to continue bit for bit, and its form as bytes.

use super::description::guid;
use super::lifecycle::Phase;
use super::settings::Explicit;
use crate::config::Config;
use crate::simulation::{Drive, Memory};
use serde::{Deserialize, Serialize};
use uuid::Uuid;

/// Memory of an instance without its model, which follows from `config`.
#[derive(Clone, Serialize, Deserialize)]
pub struct Snapshot {
    pub phase: Phase,
    pub preset: String,
    /// Parameters of the preset before explicit ones override them.
    pub base: Config,
    pub parameters: Explicit,
    pub inputs: Explicit,
    pub taken: Explicit,
    pub rates: Drive,
    /// Current communication point [s].
    pub time: f64,
    /// Stop time [s] if the master defined one.
    pub stop: Option<f64>,
    /// `None` before the stationary state has been computed.
    pub memory: Option<Memory>,
}

const MAGIC: &[u8; 8] = b"WRSTATE\x01";
const CHECKSUM: usize = 16;

/// What identifies bytes as ours: version of the program and variable table.
fn identity() -> String {
    format!("{} {}", env!("CARGO_PKG_VERSION"), guid())
}

/// A 128-bit digest (SHA-1, truncated as UUID version 5) of the identity and the payload.
fn checksum(payload: &[u8]) -> [u8; CHECKSUM] {
    let namespace = Uuid::new_v5(&Uuid::NAMESPACE_OID, identity().as_bytes());
    *Uuid::new_v5(&namespace, payload).as_bytes()
}

impl Snapshot {
    /// Layout: magic, length of the identity (one byte), identity, checksum of the payload, payload (postcard).
    pub fn to_bytes(&self) -> Result<Vec<u8>, String> {
        let payload = postcard::to_stdvec(self).map_err(|error| format!("state cannot be serialized: {error}"))?;
        let identity = identity();
        let length = u8::try_from(identity.len()).map_err(|error| error.to_string())?;
        Ok([MAGIC, [length].as_slice(), identity.as_bytes(), &checksum(&payload), &payload].concat())
    }

    /// Refuses bytes that are damaged, cut, lengthened or written by another version.
    pub fn from_bytes(bytes: &[u8]) -> Result<Snapshot, String> {
        let rest = bytes.strip_prefix(MAGIC).ok_or("serialized state is not from this FMU")?;
        let (length, rest) = rest.split_first().ok_or("serialized state is cut short")?;
        let (theirs, rest) = rest.split_at_checked(*length as usize).ok_or("serialized state is cut short")?;
        let ours = identity();
        if theirs != ours.as_bytes() {
            let theirs = String::from_utf8_lossy(theirs);
            return Err(format!("serialized state is of version \"{theirs}\", this FMU is \"{ours}\""));
        }
        let (sum, payload) = rest.split_at_checked(CHECKSUM).ok_or("serialized state is cut short")?;
        if sum != checksum(payload) {
            return Err("serialized state is damaged: checksum does not match".to_owned());
        }
        postcard::from_bytes(payload).map_err(|error| format!("serialized state is damaged: {error}"))
    }
}
