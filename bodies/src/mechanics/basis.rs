//! Reduced bodies as data that can be stored: what takes a second to compute is packed once.
//!
//! Layout of the bytes: 8 of magic, 8 of [checksum] of the rest, then the postcard form of [`Basis`], whose first field is
//! its key.

use super::parameters::BodyParameters;
use super::reduction::ReducedBasis;
use super::{BodySystem, MechanicsError, check_size, contact_zone, rail_system, wheel_system};
use serde::{Deserialize, Serialize};
use std::sync::mpsc;
use std::{panic, thread};
use uuid::Uuid;

const MAGIC: &[u8; 8] = b"WHLRAIL4";
/// Digest of the code that the data depend on (meshes, elements, reduction), from the build script.
pub const CODE: &str = env!("BASIS_CODE");
/// Name space of keys.
const NAMESPACE: Uuid = Uuid::from_u128(0x6f1d_2d0a_5c1e_4f0e_9b57_1f0c_7a5e_33d1);

/// Both reduced bodies.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Basis {
    /// [`key`] of the parameters that it was computed for.
    pub key: String,
    /// The wheel.
    pub wheel: ReducedBasis,
    /// The rail.
    pub rail: ReducedBasis,
}

/// Bytes that are not a basis.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum BasisError {
    /// Something else than a basis.
    #[error("not a basis: {length} bytes without the expected header")]
    Foreign {
        /// Number of bytes.
        length: usize,
    },
    /// A basis that was altered or cut.
    #[error("corrupt basis: checksum {found:016x} instead of {expected:016x}")]
    Corrupt {
        /// Checksum in the header.
        expected: u64,
        /// Checksum of the content.
        found: u64,
    },
    /// A content that cannot be read or written.
    #[error("unreadable basis: {0}")]
    Encoding(String),
    /// Arrays whose sizes contradict each other.
    #[error("inconsistent basis: arrays of {modes_wheel} wheel and {modes_rail} rail modes do not fit together")]
    Inconsistent {
        /// Modes of the wheel.
        modes_wheel: usize,
        /// Modes of the rail.
        modes_rail: usize,
    },
}

/// Name of the basis of parameters: UUID version 5 of those that it depends on.
///
/// Geometry, ends of the rail, elasticity, density, mesh, nominal contact, numbers of modes and the code; not damping or
/// centrifugal forces.
pub fn key(c: &BodyParameters) -> String {
    let material = &c.material;
    let lengths = [c.radius, c.hub_radius, c.rail_length, c.rail_height, c.half_width, contact_zone(c).reach];
    let elastic = [material.youngs_modulus, material.poissons_ratio, material.density];
    let counts = [c.elements, c.modes[0], c.modes[1], c.rail_ends as usize];
    let mut bytes = CODE.as_bytes().to_vec();
    bytes.extend(lengths.iter().chain(&elastic).flat_map(|value| value.to_le_bytes()));
    bytes.extend(counts.iter().flat_map(|&count| (count as u64).to_le_bytes()));
    Uuid::new_v5(&NAMESPACE, &bytes).to_string()
}

/// Checksum of bytes: FNV-1a, by eight bytes at a time, of which the last are filled with zeros, and of their number. Every
/// change within eight bytes changes it; others do but for one in 2⁶⁴.
fn checksum(bytes: &[u8]) -> u64 {
    const PRIME: u64 = 0x0000_0100_0000_01b3;
    let mix = |hash: u64, word: u64| (hash ^ word).wrapping_mul(PRIME).rotate_left(29);
    let (words, rest) = bytes.as_chunks::<8>();
    let hash = words.iter().fold(0xcbf2_9ce4_8422_2325, |hash, word| mix(hash, u64::from_le_bytes(*word)));
    let mut last = [0; 8];
    last[..rest.len()].copy_from_slice(rest);
    mix(mix(hash, u64::from_le_bytes(last)), bytes.len() as u64)
}

/// One `body`, reduced to a number of `modes`.
fn reduced(
    body: &'static str,
    modes: usize,
    system: impl Fn() -> Result<BodySystem, MechanicsError>,
    progress: &mut dyn FnMut(f64),
) -> Result<ReducedBasis, MechanicsError> {
    progress(0.0);
    ReducedBasis::compute(&system()?, modes, progress).map_err(|error| match error {
        MechanicsError::Linalg(source) => MechanicsError::Modes { body, modes, source },
        other => other,
    })
}

impl Basis {
    /// Meshes, assembles and reduces both bodies, each on a thread of its own (about a second); `progress` receives the
    /// activity and its share done.
    pub fn compute(c: &BodyParameters, progress: &mut dyn FnMut(&str, f64)) -> Result<Self, MechanicsError> {
        check_size(c)?;
        let [wheel_modes, rail_modes] = c.modes;
        let rail = |report: &mut dyn FnMut(f64)| reduced("rail", rail_modes, || rail_system(c), report);
        let (sender, shares) = mpsc::channel();
        thread::scope(|scope| {
            // Nobody listens where the wheel has failed.
            let elsewhere =
                thread::Builder::new().spawn_scoped(scope, move || rail(&mut |share| _ = sender.send(share)));
            let wheel = reduced("wheel", wheel_modes, || wheel_system(c), &mut |share| {
                progress("vibration modes of the wheel", share);
            })?;
            let mut report = |share| progress("vibration modes of the rail", share);
            let rail = match elsewhere {
                Ok(thread) => {
                    shares.iter().for_each(&mut report);
                    thread.join().unwrap_or_else(|panic| panic::resume_unwind(panic))?
                }
                // The system grants no thread.
                Err(_) => rail(&mut report)?,
            };
            Ok(Self { key: key(c), wheel, rail })
        })
    }

    /// True if this basis belongs to parameters.
    pub fn fits(&self, c: &BodyParameters) -> bool {
        let ports = 2 * contact_zone(c).surface_x().len();
        self.key == key(c) && self.wheel.is_consistent(ports) && self.rail.is_consistent(ports)
    }

    /// Serialised form with header and checksum.
    pub fn to_bytes(&self) -> Result<Vec<u8>, BasisError> {
        let payload = postcard::to_stdvec(self).map_err(|e| BasisError::Encoding(e.to_string()))?;
        let mut bytes = MAGIC.to_vec();
        bytes.extend(checksum(&payload).to_le_bytes());
        bytes.extend(payload);
        Ok(bytes)
    }

    /// Reads what [`Self::to_bytes`] wrote; refuses anything else.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, BasisError> {
        let foreign = BasisError::Foreign { length: bytes.len() };
        let Some((expected, payload)) = bytes.strip_prefix(MAGIC).and_then(|rest| rest.split_first_chunk()) else {
            return Err(foreign);
        };
        let (expected, found) = (u64::from_le_bytes(*expected), checksum(payload));
        if expected != found {
            return Err(BasisError::Corrupt { expected, found });
        }
        let basis: Self = postcard::from_bytes(payload).map_err(|e| BasisError::Encoding(e.to_string()))?;
        let ports = basis.wheel.shapes.nrows();
        if basis.wheel.is_consistent(ports) && basis.rail.is_consistent(ports) {
            Ok(basis)
        } else {
            let (modes_wheel, modes_rail) = (basis.wheel.modes(), basis.rail.modes());
            Err(BasisError::Inconsistent { modes_wheel, modes_rail })
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mechanics::testing::{exact_torsion, paper_d};
    use crate::mechanics::*;

    fn small() -> BodyParameters {
        BodyParameters { modes: [6, 5], ..paper_d(4) }
    }

    #[test]
    fn bytes_round_trip_and_corruption_is_refused() {
        let small = small();
        let mut seen = Vec::new();
        let basis = Basis::compute(&small, &mut |what, share| seen.push((what.to_owned(), share))).unwrap();
        assert!(seen.iter().all(|s| (0.0..=1.0).contains(&s.1)) && seen.last().is_some_and(|s| s.1 == 1.0));
        assert!(basis.fits(&small));
        let bytes = basis.to_bytes().unwrap();
        assert_eq!(Basis::from_bytes(&bytes), Ok(basis));
        for position in [30, bytes.len() / 2, bytes.len() - 1] {
            let mut damaged = bytes.clone();
            damaged[position] ^= 1;
            assert!(matches!(Basis::from_bytes(&damaged), Err(BasisError::Corrupt { .. })));
        }
        assert!(matches!(Basis::from_bytes(&bytes[..bytes.len() - 5]), Err(BasisError::Corrupt { .. })));
        assert_eq!(Basis::from_bytes(b"PK\x03\x04 something else"), Err(BasisError::Foreign { length: 19 }));
        assert_eq!(Basis::from_bytes(&bytes[..10]), Err(BasisError::Foreign { length: 10 }));
    }

    /// Bytes behind a valid checksum, changed at random places: single bits, bytes, lengths and shapes of arrays, cuts,
    /// repetitions.
    #[test]
    fn altered_payloads_with_a_valid_checksum_are_refused_or_consistent() {
        let bytes = Basis::compute(&small(), &mut |_, _| {}).unwrap().to_bytes().unwrap();
        let payload = &bytes[16..];
        let mut state = 1_u64;
        let mut random = |below: usize| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) as usize % below
        };
        // Places of small numbers: lengths and shapes, among the bytes of floating-point numbers.
        let small_numbers: Vec<usize> = (0..payload.len()).filter(|&i| payload[i] < 64).collect();
        let (mut refused, mut read) = (0, 0);
        for round in 0..3000 {
            let mut altered = payload.to_vec();
            let at = if round % 2 == 0 { small_numbers[random(small_numbers.len())] } else { random(payload.len()) };
            match round % 5 {
                0 => altered[at] ^= 1 << random(8),
                1 => altered[at] = random(256) as u8,
                2 => altered.truncate(at),
                3 => drop(altered.splice(at..at, [0xff; 9].into_iter().chain([1]).take(1 + random(10)))),
                _ => drop(altered.drain(at..(at + 1 + random(16)).min(payload.len()))),
            }
            let mut file = MAGIC.to_vec();
            file.extend(checksum(&altered).to_le_bytes());
            file.extend(&altered);
            match Basis::from_bytes(&file) {
                Ok(basis) => {
                    read += 1;
                    for body in [basis.wheel, basis.rail] {
                        assert!(body.is_consistent(body.shapes.nrows()));
                        let _ =
                            ReducedBody::new(body, true, &BodyDamping::NONE).operator(1e3).map(|op| op.surface.amax());
                    }
                }
                Err(BasisError::Encoding(_) | BasisError::Inconsistent { .. }) => refused += 1,
                Err(other) => panic!("{other}"),
            }
        }
        println!("{refused} refused, {read} read");
        assert!(refused > 1000 && read > 100);
    }

    #[test]
    fn key_depends_on_what_the_basis_depends_on_and_nothing_else() {
        let base = small();
        let damping = [BodyDamping::even(0.1); 2];
        assert_eq!(key(&base), key(&BodyParameters { damping, centrifugal: false, ..base.clone() }));
        let changes: [fn(&mut BodyParameters); 6] = [
            |c| c.reach = 0.1,
            |c| c.hub_radius = 0.06,
            |c| c.material.density = 7800.0,
            |c| c.half_width *= 1.1,
            |c| c.elements = 5,
            |c| c.modes[1] = 6,
        ];
        for change in changes {
            let mut other = base.clone();
            change(&mut other);
            assert_ne!(key(&base), key(&other));
        }
    }

    #[test]
    fn a_basis_fits_its_own_configuration_only() {
        let small = small();
        let mut other = small.clone();
        other.modes[0] = 4;
        let basis = Basis::compute(&other, &mut |_, _| {}).unwrap();
        assert!(basis.fits(&other) && !basis.fits(&small));
        let pair = bodies(&other, Some(basis), &mut |_, _| {}).unwrap();
        assert_eq!((pair.wheel.state_len(), pair.rail.state_len()), (4, 5));
        // 34 elements, wings included, with three cells between contact nodes each.
        assert_eq!((pair.surface_x.len(), pair.candidates), (103, 3..100));
    }

    #[test]
    fn production_mesh_is_small_enough_and_has_the_torsion_frequency_of_the_annulus() {
        let bodies = paper_d(20);
        let unknowns = |mesh: crate::fem::Mesh| 2 * (mesh.nodes.len() - mesh.fixed.len());
        let dofs = unknowns(wheel_mesh(&bodies).unwrap()) + unknowns(rail_mesh(&bodies).unwrap());
        assert!(dofs < 70_000, "{dofs} unknowns");
        let basis = Basis::compute(&bodies, &mut |_, _| {}).unwrap();
        let size = basis.to_bytes().unwrap().len();
        assert!(size < 1_500_000, "{size} bytes");
        let mode = basis.wheel.rigid.column(crate::axes::Axis::Rotation.number()).iamax();
        let omega = basis.wheel.squared_frequencies[mode].sqrt();
        let exact = exact_torsion(&bodies).frequency;
        println!("figure: torsion.frequency [rad/s] = {exact:.1}, {omega:.1} ± 0.001");
        assert!((omega / exact - 1.0).abs() < 1e-3, "{omega} rad/s instead of {exact}");
    }
}
