//! Reduced bodies as data that can be stored: what takes a second to compute is packed once.
//!
//! Layout of the bytes: 8 of magic, 8 of [checksum] of the rest, then the postcard form of [`Basis`], whose first field is
//! its key.

use super::reduction::ReducedBasis;
use super::{BodySystem, MechanicsError, check_size, contact_zone, rail_system, wheel_system};
use crate::config::{Config, ContactShape};
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
    /// [`key`] of the configuration it was computed for.
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

/// Name of the basis for a configuration: UUID version 5 of the parameters it depends on.
///
/// Geometry, ends of the rail, elasticity, density, mesh, nominal line load, numbers of modes and the code; not masses,
/// friction or time scheme.
pub fn key(config: &Config) -> String {
    let Config { model, wheel, rail, material, mesh, solver, .. } = config;
    let lengths = [wheel.radius, wheel.hub_radius, rail.length, rail.height];
    let elastic = [material.youngs_modulus, material.poissons_ratio, material.density];
    let zone = [contact_zone(config).reach];
    let line_load = match config.contact.shape {
        ContactShape::Line => [model.nominal_load / model.contact_width],
        // No load is negative.
        ContactShape::Ellipse | ContactShape::Rows => [-config.nominal_patch().half_length],
    };
    let counts = [mesh.elements_per_half_width, solver.modes_wheel, solver.modes_rail, rail.ends as usize];
    let mut bytes = CODE.as_bytes().to_vec();
    bytes.extend(lengths.iter().chain(&elastic).chain(&line_load).chain(&zone).flat_map(|value| value.to_le_bytes()));
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
    pub fn compute(config: &Config, progress: &mut dyn FnMut(&str, f64)) -> Result<Self, MechanicsError> {
        check_size(config)?;
        let (wheel_modes, rail_modes) = (config.solver.modes_wheel, config.solver.modes_rail);
        let rail = |report: &mut dyn FnMut(f64)| reduced("rail", rail_modes, || rail_system(config), report);
        let (sender, shares) = mpsc::channel();
        thread::scope(|scope| {
            // Nobody listens where the wheel has failed.
            let elsewhere =
                thread::Builder::new().spawn_scoped(scope, move || rail(&mut |share| _ = sender.send(share)));
            let wheel = reduced("wheel", wheel_modes, || wheel_system(config), &mut |share| {
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
            Ok(Self { key: key(config), wheel, rail })
        })
    }

    /// True if this basis belongs to a configuration.
    pub fn fits(&self, config: &Config) -> bool {
        let ports = 2 * contact_zone(config).surface_x().len();
        self.key == key(config) && self.wheel.is_consistent(ports) && self.rail.is_consistent(ports)
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

    fn small() -> Config {
        let mut config = paper_d(4);
        (config.solver.modes_wheel, config.solver.modes_rail) = (6, 5);
        config
    }

    #[test]
    fn bytes_round_trip_and_corruption_is_refused() {
        let config = small();
        let mut seen = Vec::new();
        let basis = Basis::compute(&config, &mut |what, share| seen.push((what.to_owned(), share))).unwrap();
        assert!(seen.iter().all(|s| (0.0..=1.0).contains(&s.1)) && seen.last().is_some_and(|s| s.1 == 1.0));
        assert!(basis.fits(&config));
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
        let mut same = base.clone();
        same.vehicle.mass = 1e4;
        same.wheel.hub_inertia = 3.0;
        same.friction.coefficient = 0.1;
        same.tuning.max_step = 1e-5;
        same.physics.centrifugal = false;
        (same.model.nominal_load, same.model.contact_width) = (2e5, 2.0);
        assert_eq!(key(&base), key(&same));
        let changes: [fn(&mut Config); 7] = [
            |c| c.mesh.reach = 0.1,
            |c| c.wheel.profile = "flat(length = 0.1)".into(),
            |c| c.wheel.hub_radius = 0.06,
            |c| c.material.density = 7800.0,
            |c| c.model.nominal_load = 1.1e5,
            |c| c.mesh.elements_per_half_width = 5,
            |c| c.solver.modes_rail = 6,
        ];
        for change in changes {
            let mut other = base.clone();
            change(&mut other);
            assert_ne!(key(&base), key(&other));
        }
    }

    #[test]
    fn a_basis_fits_its_own_configuration_only() {
        let config = small();
        let mut other = config.clone();
        other.solver.modes_wheel = 4;
        let basis = Basis::compute(&other, &mut |_, _| {}).unwrap();
        assert!(basis.fits(&other) && !basis.fits(&config));
        let pair = bodies(&other, Some(basis), &mut |_, _| {}).unwrap();
        assert_eq!((pair.wheel.state_len(), pair.rail.state_len()), (4, 5));
        // 34 elements, wings included, with three cells between contact nodes each.
        assert_eq!((pair.surface_x.len(), pair.candidates), (103, 3..100));
    }

    #[test]
    fn production_mesh_is_small_enough_and_has_the_torsion_frequency_of_the_annulus() {
        let config = paper_d(20);
        let unknowns = |mesh: crate::fem::Mesh| 2 * (mesh.nodes.len() - mesh.fixed.len());
        let dofs = unknowns(wheel_mesh(&config).unwrap()) + unknowns(rail_mesh(&config).unwrap());
        assert!(dofs < 70_000, "{dofs} unknowns");
        let basis = Basis::compute(&config, &mut |_, _| {}).unwrap();
        let size = basis.to_bytes().unwrap().len();
        assert!(size < 1_500_000, "{size} bytes");
        let mode = basis.wheel.rigid.column(crate::axes::Axis::Rotation.number()).iamax();
        let omega = basis.wheel.squared_frequencies[mode].sqrt();
        let exact = exact_torsion(&config).frequency;
        println!("figure: torsion.frequency [rad/s] = {exact:.1}, {omega:.1} ± 0.001");
        assert!((omega / exact - 1.0).abs() < 1e-3, "{omega} rad/s instead of {exact}");
    }

    #[test]
    fn bodies_of_extreme_but_valid_configurations_can_be_meshed() {
        let changes: [fn(&mut Config); 6] = [
            |c| c.model.nominal_load = 10.0,
            |c| c.mesh.elements_per_half_width = 80,
            |c| c.wheel.hub_radius = 0.4,
            |c| (c.wheel.hub_radius, c.rail.height, c.rail.length) = (0.01, 0.02, 0.12),
            |c| (c.model.nominal_load, c.wheel.radius) = (4.7e6, 0.46),
            |c| (c.rail.length, c.rail.height) = (2.0, 2.0),
        ];
        for change in changes {
            let mut config = paper_d(10);
            change(&mut config);
            assert_eq!(config.validate(), Ok(()));
            let mut dofs = Vec::new();
            for mesh in [wheel_mesh(&config).unwrap(), rail_mesh(&config).unwrap()] {
                assert!((0..mesh.cells.len()).all(|c| crate::fem::element::points(&mesh.corners(c)).is_ok()));
                dofs.push(2 * (mesh.nodes.len() - mesh.fixed.len()));
            }
            assert!(dofs.iter().all(|n| *n < 200_000));
            println!("{dofs:?} dofs, a = {:.2e} m", nominal_half_width(&config));
        }
    }
}
