//! States of a wheel as bytes.

use super::settings::Settings;
use super::table::table;
use crate::simulation::Checkpoint;
use serde::{Deserialize, Serialize};
use std::sync::OnceLock;
use uuid::Uuid;
use wheelrail_slave::Snapshot;
use wheelrail_slave::snapshot::{Container, layout};

/// Memory of a wheel without its model, which follows from the settings.
#[derive(Clone, Serialize, Deserialize)]
pub struct WheelState {
    /// Settings of the master.
    pub settings: Settings,
    /// `None` before the stationary state has been computed.
    pub checkpoint: Option<Checkpoint>,
}

/// The container of serialized states. Its identity is the version of the program, with a digest of the layout of a
/// state and of the rows that value references in it stand for.
fn container() -> Result<Container, String> {
    static DIGEST: OnceLock<Uuid> = OnceLock::new();
    let compute = || -> Result<Uuid, String> {
        let layout = layout::<Snapshot<WheelState>>().map_err(|error| format!("states have no layout: {error}"))?;
        let rows = table().iter().map(|row| format!("{} {} {}", row.reference, row.name, row.kind.sort()));
        let text = rows.chain([layout]).collect::<Vec<_>>().join("\n");
        Ok(Uuid::new_v5(&Uuid::NAMESPACE_OID, text.as_bytes()))
    };
    let digest = match DIGEST.get() {
        Some(digest) => *digest,
        None => *DIGEST.get_or_init({
            let digest = compute()?;
            move || digest
        }),
    };
    Ok(Container { magic: b"WRSTATE\x01", identity: format!("{} {digest}", env!("CARGO_PKG_VERSION")) })
}

/// A state in its container; the payload is that of postcard.
pub fn to_bytes(snapshot: &Snapshot<WheelState>) -> Result<Vec<u8>, String> {
    let payload = postcard::to_stdvec(snapshot).map_err(|error| format!("state cannot be serialized: {error}"))?;
    container()?.seal(&payload)
}

/// The state in a container; refuses bytes that are damaged, cut, lengthened or written by another version.
pub fn from_bytes(bytes: &[u8]) -> Result<Snapshot<WheelState>, String> {
    postcard::from_bytes(container()?.open(bytes)?).map_err(|error| format!("serialized state is damaged: {error}"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fmi::instance::Instance;
    use crate::fmi::table::named;
    use crate::fmi::v2::variables::variables;
    use crate::fmi::variable::{Causality, Kind, Value};
    use wheelrail_slave::{Log, Type};

    /// A coarse wheel after one step, with everything a snapshot can hold.
    fn snapshot() -> Snapshot<WheelState> {
        let mut instance = Instance::new(None, Log::new(Box::new(|_, _, _| {}), false)).unwrap();
        let reference = |name: &str| named(name).unwrap().reference;
        instance.set(&[reference("mesh.elements_per_half_width")], vec![Value::Integer(4)]).unwrap();
        instance.enter_initialization().unwrap();
        instance.exit_initialization().unwrap();
        instance.set(&[reference("drive.moment")], vec![Value::Real(-100.0)]).unwrap();
        instance.do_step(0.0, 1e-3).unwrap();
        instance.snapshot().unwrap()
    }

    #[test]
    fn the_layout_of_states_is_part_of_their_identity() {
        let layout = layout::<Snapshot<WheelState>>().unwrap();
        // Names of every storey: interface, checkpoint, state, heat.
        for name in ["Snapshot phase", "internal_steps visit_u64", "membrane", "Origin:Stationary|Step variant 1"] {
            assert!(layout.contains(name), "{name} is missing in {layout}");
        }
        let (identity, bytes) = (container().unwrap().identity, to_bytes(&snapshot()).unwrap());
        let at = bytes.windows(identity.len()).position(|window| window == identity.as_bytes()).unwrap();
        let mut other = bytes.clone();
        other[at + identity.len() - 1] ^= 1;
        assert!(from_bytes(&bytes).is_ok());
        assert!(from_bytes(&other).err().unwrap().contains("version"));
    }

    /// SplitMix64 (Steele et al., OOPSLA 2014).
    struct Random(u64);

    impl Random {
        fn below(&mut self, end: usize) -> usize {
            self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
            let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
            ((z ^ (z >> 31)) % end as u64) as usize
        }
    }

    /// A payload with other bits, other numbers, or of another length.
    fn mutated(payload: &[u8], random: &mut Random) -> Vec<u8> {
        const NUMBERS: [f64; 8] = [0.0, -1.0, 1e-300, 1e300, f64::MAX, f64::NAN, f64::INFINITY, f64::NEG_INFINITY];
        let mut bytes = payload.to_vec();
        // The fields before the large arrays decide what happens: every other change is made there.
        let reach = [bytes.len(), 2000.min(bytes.len())][random.below(2)];
        match random.below(4) {
            0 => bytes[random.below(reach)] ^= 1 << random.below(8),
            1 => bytes[random.below(reach)] = random.below(256) as u8,
            2 => {
                let (at, number) = (random.below(reach), NUMBERS[random.below(NUMBERS.len())]);
                bytes.iter_mut().skip(at).zip(number.to_le_bytes()).for_each(|(byte, new)| *byte = new);
            }
            _ => bytes.truncate(random.below(reach)),
        }
        bytes
    }

    /// `WHEELRAIL_FUZZ` asks for more states than the usual 2,000.
    #[test]
    fn a_made_up_state_with_a_valid_checksum_is_refused_or_steps_or_is_refused_a_step() {
        let original = snapshot();
        let config = original.state.settings.config();
        let payload = postcard::to_stdvec(&original).unwrap();
        let container = container().unwrap();
        assert_eq!(container.seal(&payload).unwrap(), to_bytes(&original).unwrap());
        let mut instance = Instance::new(None, Log::new(Box::new(|_, _, _| {}), false)).unwrap();
        let outputs: Vec<_> = variables().iter().filter(|v| v.causality() == Causality::Output).collect();
        let outputs: Vec<_> =
            outputs.iter().filter(|v| matches!(v.kind, Kind::Real { .. })).map(|v| v.reference).collect();
        let cases = std::env::var("WHEELRAIL_FUZZ").ok().and_then(|n| n.parse().ok()).unwrap_or(2000);
        let (mut read, mut restored, mut stepped) = (0, 0, 0);
        let mut random = Random(1);
        for _ in 0..cases {
            let Ok(state) = from_bytes(&container.seal(&mutated(&payload, &mut random)).unwrap()) else { continue };
            read += 1;
            // Another configuration is a model of its own, judged by its ranges and long to prepare.
            let theirs = state.state.settings.config();
            if theirs != config {
                let _ = theirs.validate();
                continue;
            }
            if instance.restore(&state).is_err() {
                continue;
            }
            restored += 1;
            let _ = instance.get(&outputs, Type::Real);
            if instance.do_step(instance.last_successful_time(), 1e-3).is_ok() {
                stepped += 1;
                instance.get(&outputs, Type::Real).unwrap();
            }
        }
        println!("{cases} states: {read} read, {restored} restored, {stepped} stepped");
        assert!(read > cases / 10 && restored > cases / 20 && stepped > cases / 50 && stepped < cases);
        instance.restore(&original).unwrap();
        instance.do_step(original.time, 1e-3).unwrap();
    }
}
