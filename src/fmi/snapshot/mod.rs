//! Everything an instance must remember to continue bit for bit, and its form as bytes.

mod schema;

use super::lifecycle::Phase;
use super::settings::SetValues;
use super::variables::variables;
use crate::config::Config;
use crate::simulation::{Checkpoint, Drive};
use serde::{Deserialize, Serialize};
use std::sync::OnceLock;
use uuid::Uuid;

/// Memory of an instance without its model, which follows from `config`.
#[derive(Clone, Serialize, Deserialize)]
pub struct Snapshot {
    pub phase: Phase,
    pub preset: String,
    /// Parameters of the preset before explicit ones override them.
    pub base: Config,
    pub parameters: SetValues,
    pub inputs: SetValues,
    pub bumpless: SetValues,
    pub rates: Drive,
    /// Current communication point \[s].
    pub time: f64,
    /// Stop time \[s] if the master defined one.
    pub stop: Option<f64>,
    /// `None` before the stationary state has been computed.
    pub checkpoint: Option<Checkpoint>,
}

const MAGIC: &[u8; 8] = b"WRSTATE\x01";
const CHECKSUM: usize = 16;

/// What identifies bytes as ours: version of the program, and a digest of the layout of a snapshot and of the variables
/// that its value references stand for.
fn identity() -> Result<&'static str, String> {
    static IDENTITY: OnceLock<Result<String, String>> = OnceLock::new();
    let compute = || {
        let layout = schema::layout::<Snapshot>().map_err(|error| format!("states have no layout: {error}"))?;
        let rows = variables().iter().map(|row| format!("{} {} {}", row.reference, row.name, row.kind.type_name()));
        let text = rows.chain([layout]).collect::<Vec<_>>().join("\n");
        Ok(format!("{} {}", env!("CARGO_PKG_VERSION"), Uuid::new_v5(&Uuid::NAMESPACE_OID, text.as_bytes())))
    };
    IDENTITY.get_or_init(compute).as_deref().map_err(Clone::clone)
}

/// A 128-bit digest (SHA-1, truncated as UUID version 5) of the identity and the payload.
fn checksum(identity: &str, payload: &[u8]) -> [u8; CHECKSUM] {
    let namespace = Uuid::new_v5(&Uuid::NAMESPACE_OID, identity.as_bytes());
    *Uuid::new_v5(&namespace, payload).as_bytes()
}

impl Snapshot {
    /// Layout: magic, length of the identity (one byte), identity, checksum of the payload, payload (postcard).
    pub fn to_bytes(&self) -> Result<Vec<u8>, String> {
        let payload = postcard::to_stdvec(self).map_err(|error| format!("state cannot be serialized: {error}"))?;
        let identity = identity()?;
        let length = u8::try_from(identity.len()).map_err(|error| error.to_string())?;
        Ok([MAGIC, [length].as_slice(), identity.as_bytes(), &checksum(identity, &payload), &payload].concat())
    }

    /// Refuses bytes that are damaged, cut, lengthened or written by another version.
    pub fn from_bytes(bytes: &[u8]) -> Result<Snapshot, String> {
        let rest = bytes.strip_prefix(MAGIC).ok_or("serialized state is not from this FMU")?;
        let (length, rest) = rest.split_first().ok_or("serialized state is cut short")?;
        let (theirs, rest) = rest.split_at_checked(*length as usize).ok_or("serialized state is cut short")?;
        let ours = identity()?;
        if theirs != ours.as_bytes() {
            let theirs = String::from_utf8_lossy(theirs);
            return Err(format!("serialized state is of version \"{theirs}\", this FMU is \"{ours}\""));
        }
        let (sum, payload) = rest.split_at_checked(CHECKSUM).ok_or("serialized state is cut short")?;
        if sum != checksum(ours, payload) {
            return Err("serialized state is damaged: checksum does not match".to_owned());
        }
        postcard::from_bytes(payload).map_err(|error| format!("serialized state is damaged: {error}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fmi::instance::Instance;
    use crate::fmi::log::Log;
    use crate::fmi::variable::Value;

    /// A coarse wheel after one step, with everything a snapshot can hold.
    fn snapshot() -> Snapshot {
        let mut instance = Instance::new(None, Log::new(Box::new(|_, _, _| {}), false)).unwrap();
        let reference = |name: &str| variables().iter().find(|variable| variable.name == name).unwrap().reference;
        for (name, value) in [("mesh.elements_per_half_width", 4), ("solver.modes_wheel", 2), ("solver.modes_rail", 2)]
        {
            instance.set(&[reference(name)], vec![Value::Integer(value)]).unwrap();
        }
        instance.enter_initialization().unwrap();
        instance.exit_initialization().unwrap();
        instance.set(&[reference("drive.moment")], vec![Value::Real(-100.0)]).unwrap();
        instance.do_step(0.0, 1e-3).unwrap();
        instance.snapshot().unwrap()
    }

    #[test]
    fn the_layout_of_states_is_part_of_their_identity() {
        let layout = schema::layout::<Snapshot>().unwrap();
        // Names of every storey: interface, checkpoint, state, heat.
        for name in ["Snapshot phase", "internal_steps visit_u64", "membrane", "Origin:Stationary|Step variant 1"] {
            assert!(layout.contains(name), "{name} is missing in {layout}");
        }
        let (identity, bytes) = (identity().unwrap(), snapshot().to_bytes().unwrap());
        let at = bytes.windows(identity.len()).position(|window| window == identity.as_bytes()).unwrap();
        let mut other = bytes.clone();
        other[at + identity.len() - 1] ^= 1;
        assert!(Snapshot::from_bytes(&bytes).is_ok());
        assert!(Snapshot::from_bytes(&other).err().unwrap().contains("version"));
    }
}
