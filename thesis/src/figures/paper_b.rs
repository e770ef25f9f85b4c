//! Paper B: its wheel with a heated tread in the product.

use crate::ours::{Product, Run};
use wheelrail::config::Config;

/// Heat into the tread [W/m].
pub(super) const HEAT: f64 = 60.0;
/// Load [N/m].
pub(super) const LOAD: f64 = 10e3;
/// Velocity [m/s].
pub(super) const SPEED: f64 = 50.0 / 3.6;
/// Steps of the mesh across half a contact.
const MESH: usize = 10;
/// Creepage at which the thesis states mean temperatures \[1].
pub(super) const CREEPAGE: f64 = -5e-5;
/// Mean of the wheel there in the reference \[K].
pub(super) const REFERENCE: f64 = 7.5217e-5;
/// Heat capacity of steel by volume [J/(m³ K)].
pub(super) const CAPACITY: f64 = 8000.0 * 460.0;

/// Paper B on a coarser mesh, with changes.
pub(super) fn paper_b(change: impl FnOnce(&mut Config)) -> Result<Product, String> {
    Product::with("paper_b", |config| {
        config.mesh.elements_per_half_width = MESH;
        change(config);
    })
}

/// Stationary rolling with the tread heated.
pub(super) fn heated(product: &Product, velocity: f64, load: f64) -> Result<Run, String> {
    product.rolling(velocity, 0.0, |inputs| (inputs.drive.tread_heat, inputs.drive.load) = (HEAT, load))
}
