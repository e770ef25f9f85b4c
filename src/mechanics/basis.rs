//! Reduced bodies as data that can be stored: what takes seconds to compute is packed once.
//!
//! Layout of the bytes: 8 of magic, 16 of checksum (UUID version 5 of the rest), then the postcard form of [`Basis`],
//! whose first field is its key.

use super::reduced::ReducedBasis;
use super::{MechanicsError, contact_zone, rail_system, wheel_system};
use crate::config::Config;
use serde::{Deserialize, Serialize};
use uuid::Uuid;

const MAGIC: &[u8; 8] = b"WHLRAIL1";
/// Changes whenever the meaning of the data changes (mesh rules, reduction, layout).
const VERSION: u64 = 1;
/// Name space of keys and checksums.
const NAMESPACE: Uuid = Uuid::from_u128(0x6f1d_2d0a_5c1e_4f0e_9b57_1f0c_7a5e_33d1);

/// Both reduced bodies.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Basis {
    /// [`key`] of the configuration it was computed for.
    pub key: String,
    pub wheel: ReducedBasis,
    pub rail: ReducedBasis,
}

/// Bytes that are not a basis.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum BasisError {
    #[error("not a basis: {length} bytes without the expected header")]
    Foreign { length: usize },
    #[error("corrupt basis: checksum {found} instead of {expected}")]
    Corrupt { expected: Uuid, found: Uuid },
    #[error("unreadable basis: {0}")]
    Encoding(String),
    #[error("inconsistent basis: arrays of {modes_wheel} wheel and {modes_rail} rail modes do not fit together")]
    Inconsistent { modes_wheel: usize, modes_rail: usize },
}

/// Name of the basis for a configuration: UUID version 5 of the parameters it depends on.
///
/// Geometry, elasticity, density, mesh, nominal line load and numbers of modes; not masses, friction or time scheme.
pub fn key(config: &Config) -> String {
    let Config { model, wheel, rail, material, mesh, solver, .. } = config;
    let lengths = [wheel.radius, wheel.hub_radius, rail.length, rail.height];
    let elastic = [material.youngs_modulus, material.poissons_ratio, material.density];
    let line_load = [model.nominal_load / model.contact_width];
    let counts = [mesh.elements_per_half_width, solver.modes_wheel, solver.modes_rail];
    let mut bytes = VERSION.to_le_bytes().to_vec();
    bytes.extend(lengths.iter().chain(&elastic).chain(&line_load).flat_map(|value| value.to_le_bytes()));
    bytes.extend(counts.iter().flat_map(|&count| (count as u64).to_le_bytes()));
    Uuid::new_v5(&NAMESPACE, &bytes).to_string()
}

impl Basis {
    /// Meshes, assembles and reduces both bodies (seconds); `progress` receives the activity and its share done.
    pub fn compute(config: &Config, progress: &mut dyn FnMut(&str, f64)) -> Result<Self, MechanicsError> {
        let what = "vibration modes of the wheel";
        progress(what, 0.0);
        let system = wheel_system(config)?;
        let wheel = ReducedBasis::compute(&system, config.solver.modes_wheel, &mut |share| progress(what, share))?;
        let what = "vibration modes of the rail";
        progress(what, 0.0);
        let system = rail_system(config)?;
        let rail = ReducedBasis::compute(&system, config.solver.modes_rail, &mut |share| progress(what, share))?;
        Ok(Self { key: key(config), wheel, rail })
    }

    /// Whether this basis belongs to a configuration.
    pub fn fits(&self, config: &Config) -> bool {
        let ports = 2 * contact_zone(config).surface_x().len();
        self.key == key(config) && self.wheel.is_consistent(ports) && self.rail.is_consistent(ports)
    }

    /// Serialised form with header and checksum.
    pub fn to_bytes(&self) -> Result<Vec<u8>, BasisError> {
        let payload = postcard::to_stdvec(self).map_err(|e| BasisError::Encoding(e.to_string()))?;
        let mut bytes = MAGIC.to_vec();
        bytes.extend(Uuid::new_v5(&NAMESPACE, &payload).as_bytes());
        bytes.extend(payload);
        Ok(bytes)
    }

    /// Reads what [`Self::to_bytes`] wrote; refuses anything else.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, BasisError> {
        let foreign = BasisError::Foreign { length: bytes.len() };
        let Some((checksum, payload)) = bytes.strip_prefix(MAGIC).and_then(|rest| rest.split_first_chunk::<16>())
        else {
            return Err(foreign);
        };
        let (expected, found) = (Uuid::from_bytes(*checksum), Uuid::new_v5(&NAMESPACE, payload));
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
    use crate::mechanics::testing::paper_d;
    use crate::mechanics::*;
    use nalgebra::DVector;
    use std::time::Instant;

    #[test]
    fn size_and_time_of_the_production_mesh() {
        let config = paper_d(20);
        for (name, mesh) in [("wheel", wheel_mesh(&config).unwrap()), ("rail", rail_mesh(&config).unwrap())] {
            println!("{name}: {} dofs", 2 * (mesh.nodes.len() - mesh.fixed.len()));
        }
        let start = Instant::now();
        let system = wheel_system(&config).unwrap();
        println!("assembly {:?}", start.elapsed());
        let start = Instant::now();
        let factor = crate::linalg::Cholesky::new(&system.stiffness).unwrap();
        println!("factor {:?}", start.elapsed());
        let start = Instant::now();
        let mut x = system.centrifugal.clone();
        factor.solve_in_place(x.as_mut_slice());
        println!("solve {:?}", start.elapsed());

        let modes = crate::linalg::lowest_modes(&system.stiffness, &factor, &system.mass, 24, &mut |_| {}).unwrap();
        let p = modes.shapes.tr_mul(&system.rigid);
        let k = p.column(2).map(|x| x * x).imax();
        println!("RES torsion {:.3e}", modes.squared_frequencies[k].sqrt() / 1777.27 - 1.0);
        println!(
            "RES freqs {:?}",
            modes.squared_frequencies.map(f64::sqrt).iter().map(|x| (x * 100.0).round() / 100.0).collect::<Vec<_>>()
        );
        for (name, system) in [("wheel", system), ("rail", rail_system(&config).unwrap())] {
            let factor = crate::linalg::Cholesky::new(&system.stiffness).unwrap();
            let g = system.surface_compliance(&factor);
            let n = g.nrows() / 2;
            let mut x = vec![];
            let e = 1e11 / 0.91;
            // hertz-like patch load on 41 nodes (elements fixed)
            let f = nalgebra::DVector::from_fn(2 * n, |i, _| {
                let s = (i / 2) as f64 - (n / 2) as f64;
                let s = s / 20.0;
                if i % 2 == 1 && s.abs() < 1.0 { (1.0 - s * s).sqrt() } else { 0.0 }
            });
            let ft = nalgebra::DVector::from_fn(2 * n, |i, _| {
                let s = (i / 2) as f64 - (n / 2) as f64;
                let s = s / 20.0;
                if i % 2 == 0 && s.abs() < 1.0 { (1.0 - s * s).sqrt() } else { 0.0 }
            });
            let (u, ut) = (&g * &f, &g * &ft);
            let (total,) = (f.sum(),);
            let c = n / 2;
            x.push(u[2 * c + 1] / total * e);
            x.push((u[2 * c + 1] - u[2 * (c + 20) + 1]) / total * e);
            x.push((u[2 * c + 1] - u[2 * (c + 30) + 1]) / total * e);
            x.push(ut[2 * c] / total * e);
            x.push((ut[2 * c] - ut[2 * (c + 20)]) / total * e);
            x.push((ut[2 * c] - ut[2 * (c + 30)]) / total * e);
            x.push((ut[2 * (c + 1) + 1] - ut[2 * (c - 1) + 1]) / total * e);
            println!("RES {name} {:?}", x.iter().map(|v| (v * 1e5).round() / 1e5).collect::<Vec<_>>());
        }
    }
}
