//! Saved states: what an instance must remember to continue bit for bit, and the container of its bytes.

mod schema;

pub use schema::layout;

use crate::lifecycle::Phase;
use serde::{Deserialize, Serialize};
use uuid::Uuid;

/// Phase and times of an instance with the state of its model.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Snapshot<T> {
    /// Phase of life.
    pub phase: Phase,
    /// Current communication point \[s].
    pub time: f64,
    /// Stop time \[s] if the master defined one.
    pub stop: Option<f64>,
    /// Memory of the model.
    pub state: T,
}

const CHECKSUM: usize = 16;

/// A 128-bit digest (SHA-1, truncated as UUID version 5) of the identity and the payload.
fn checksum(identity: &str, payload: &[u8]) -> [u8; CHECKSUM] {
    let namespace = Uuid::new_v5(&Uuid::NAMESPACE_OID, identity.as_bytes());
    *Uuid::new_v5(&namespace, payload).as_bytes()
}

/// Container of serialized states: magic, length of the identity (one byte), identity, checksum of the payload,
/// payload.
pub struct Container {
    /// First bytes of every state, which tell programs of a kind apart.
    pub magic: &'static [u8; 8],
    /// Text that changes with everything that the meaning of the payload depends on, of at most 255 bytes.
    pub identity: String,
}

impl Container {
    /// The payload in its container.
    pub fn seal(&self, payload: &[u8]) -> Result<Vec<u8>, String> {
        let length = u8::try_from(self.identity.len()).map_err(|error| error.to_string())?;
        let sum = checksum(&self.identity, payload);
        Ok([self.magic, [length].as_slice(), self.identity.as_bytes(), &sum, payload].concat())
    }

    /// The payload of a container; refuses bytes that are damaged, cut, lengthened or of another identity.
    pub fn open<'a>(&self, bytes: &'a [u8]) -> Result<&'a [u8], String> {
        const SHORT: &str = "serialized state is cut short";
        let rest = bytes.strip_prefix(self.magic).ok_or("serialized state is not from this FMU")?;
        let (length, rest) = rest.split_first().ok_or(SHORT)?;
        let (theirs, rest) = rest.split_at_checked(*length as usize).ok_or(SHORT)?;
        let ours = &self.identity;
        if theirs != ours.as_bytes() {
            let theirs = String::from_utf8_lossy(theirs);
            return Err(format!("serialized state is of version \"{theirs}\", this FMU is \"{ours}\""));
        }
        let (sum, payload) = rest.split_at_checked(CHECKSUM).ok_or(SHORT)?;
        if sum != checksum(ours, payload) {
            return Err("serialized state is damaged: checksum does not match".to_owned());
        }
        Ok(payload)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_payload_comes_back_and_every_damaged_byte_is_seen() {
        let container = Container { magic: b"TESTING\x01", identity: "1.0 of this".to_owned() };
        let sealed = container.seal(b"payload").unwrap();
        assert_eq!(container.open(&sealed).unwrap(), b"payload");
        for at in 0..sealed.len() {
            let mut damaged = sealed.clone();
            damaged[at] ^= 1;
            assert!(container.open(&damaged).is_err(), "byte {at}");
            assert!(container.open(&sealed[..at]).is_err(), "{at} bytes");
        }
        assert!(container.open(&[&sealed[..], b"x"].concat()).is_err());
    }

    #[test]
    fn another_identity_is_refused_by_name() {
        let container = |identity: &str| Container { magic: b"TESTING\x01", identity: identity.to_owned() };
        let refusal = container("2.0").open(&container("1.0").seal(b"payload").unwrap()).unwrap_err();
        assert_eq!(refusal, "serialized state is of version \"1.0\", this FMU is \"2.0\"");
        assert!(container(&"x".repeat(256)).seal(b"").is_err());
    }
}
