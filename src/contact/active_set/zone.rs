//! Whether the contact stays within the grid.

use super::iterate::Iterate;
use crate::contact::error::ContactError;

/// How far beyond the grid uneven surfaces are watched, over half of its length \[1]: as far as the wings of the surfaces.
const WATCHED: f64 = 3.0;
/// Distance of the places that are watched [spacings].
const STRIDE: f64 = 2.0;

impl Iterate<'_> {
    /// Refuses patches that reach the end of the grid, and surfaces that would touch beyond it.
    pub(super) fn check_zone(&self) -> Result<(), ContactError> {
        let ends = [self.state.status.first(), self.state.status.last()];
        if ends.iter().flatten().any(|s| s.is_active()) || self.touches_beyond() {
            let zone = self.grid.x.last().copied().unwrap_or(0.0);
            let load = self.traction.port_forces.iter().skip(1).step_by(2).sum();
            return Err(ContactError::ZoneExceeded { zone, load });
        }
        Ok(())
    }

    /// Whether uneven surfaces that are displaced as at the ends of the grid would overlap beyond them.
    fn touches_beyond(&self) -> bool {
        let (grid, surfaces, placement) = (self.grid, self.problem.surfaces, &self.problem.placement);
        if !surfaces.is_uneven(placement) {
            return false;
        }
        let (last, stride) = (grid.len() - 1, STRIDE * grid.spacing);
        [(0, -stride), (last, stride)].into_iter().any(|(end, stride)| {
            let parted = self.state.gap[end] - self.scratch.gap[end];
            let places = (WATCHED * grid.x[end] / stride) as usize;
            (1..=places).any(|k| surfaces.gap(grid.x[end] + k as f64 * stride, placement) + parted < 0.0)
        })
    }
}
