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
    /// Where in its life the instance is.
    pub phase: Phase,
    /// Name of the preset.
    pub preset: String,
    /// Parameters of the preset before explicit ones override them.
    pub base: Config,
    /// Parameters that follow from `fmi2SetupExperiment`.
    pub experiment: SetValues,
    /// Explicitly set parameters.
    pub parameters: SetValues,
    /// Explicitly set inputs.
    pub inputs: SetValues,
    /// Present values that inputs took over when a control was switched to them.
    pub bumpless: SetValues,
    /// Time derivatives of the inputs during the next step.
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
fn identity() -> Result<String, String> {
    static DIGEST: OnceLock<Uuid> = OnceLock::new();
    let compute = || -> Result<Uuid, String> {
        let layout = schema::layout::<Snapshot>().map_err(|error| format!("states have no layout: {error}"))?;
        let rows = variables().iter().map(|row| format!("{} {} {}", row.reference, row.name, row.kind.type_name()));
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
    Ok(format!("{} {digest}", env!("CARGO_PKG_VERSION")))
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
        Ok([MAGIC, [length].as_slice(), identity.as_bytes(), &checksum(&identity, &payload), &payload].concat())
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
        if sum != checksum(&ours, payload) {
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
    use crate::fmi::settings::with_parameters;
    use crate::fmi::variable::{Causality, Value};

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

    /// Bytes of a made-up state, whose checksum is right.
    fn sealed(payload: &[u8]) -> Vec<u8> {
        let identity = identity().unwrap();
        let sum = checksum(&identity, payload);
        [MAGIC, [identity.len() as u8].as_slice(), identity.as_bytes(), &sum, payload].concat()
    }

    /// `WHEELRAIL_FUZZ` asks for more states than the usual 2,000.
    #[test]
    fn a_made_up_state_with_a_valid_checksum_is_refused_or_steps_or_is_refused_a_step() {
        let original = snapshot();
        let config = with_parameters(&original.base, &original.experiment, &original.parameters);
        let payload = postcard::to_stdvec(&original).unwrap();
        assert_eq!(sealed(&payload), original.to_bytes().unwrap());
        let mut instance = Instance::new(None, Log::new(Box::new(|_, _, _| {}), false)).unwrap();
        let outputs: Vec<_> = variables().iter().filter(|v| v.causality() == Causality::Output).collect();
        let outputs: Vec<_> = outputs.iter().filter(|v| v.kind.type_name() == "Real").map(|v| v.reference).collect();
        let cases = std::env::var("WHEELRAIL_FUZZ").ok().and_then(|n| n.parse().ok()).unwrap_or(2000);
        let (mut read, mut restored, mut stepped) = (0, 0, 0);
        let mut random = Random(1);
        for _ in 0..cases {
            let Ok(state) = Snapshot::from_bytes(&sealed(&mutated(&payload, &mut random))) else { continue };
            read += 1;
            // Another configuration is a model of its own, judged by its ranges and long to prepare.
            let theirs = with_parameters(&state.base, &state.experiment, &state.parameters);
            if theirs != config {
                let _ = theirs.validate();
                continue;
            }
            if instance.restore(&state).is_err() {
                continue;
            }
            restored += 1;
            let _ = instance.get(&outputs, "Real");
            if instance.do_step(instance.last_successful_time(), 1e-3).is_ok() {
                stepped += 1;
                instance.get(&outputs, "Real").unwrap();
            }
        }
        println!("{cases} states: {read} read, {restored} restored, {stepped} stepped");
        assert!(read > cases / 10 && restored > cases / 20 && stepped > cases / 50 && stepped < cases);
        instance.restore(&original).unwrap();
        instance.do_step(original.time, 1e-3).unwrap();
    }
}
