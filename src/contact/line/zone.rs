//! Ends of the grid: a contact that reaches them is refused.

use super::contact_line::ContactLine;
use crate::contact::error::ContactError;

/// Distance beyond the grid up to which uneven surfaces are watched, over half of its length \[1]: as far as their
/// wings.
const WATCHED: f64 = 3.0;
/// Distance of the places that are watched [spacings].
const STRIDE: f64 = 2.0;

/// Refuses patches that reach the end of the grid, and surfaces that would touch beyond it.
pub fn check(line: &ContactLine) -> Result<(), ContactError> {
    let ends = [line.state.status.first(), line.state.status.last()];
    if ends.iter().flatten().any(|s| s.is_active()) || touches_beyond(line) {
        let zone = line.grid.x.last().copied().unwrap_or(0.0);
        let load = line.traction.port_forces.iter().skip(1).step_by(2).sum();
        return Err(ContactError::ZoneExceeded { zone, load });
    }
    Ok(())
}

/// True if uneven surfaces that are displaced as at the ends of the grid would overlap beyond them.
fn touches_beyond(line: &ContactLine) -> bool {
    let (grid, surfaces, placement) = (line.grid, line.problem.surfaces, &line.problem.placement);
    if !surfaces.is_uneven(placement) {
        return false;
    }
    let (last, stride) = (grid.len() - 1, STRIDE * grid.spacing);
    [(0, -stride), (last, stride)].into_iter().any(|(end, stride)| {
        let parted = line.state.gap[end] - line.given.gap[end];
        let places = (WATCHED * grid.x[end] / stride) as usize;
        (1..=places).any(|k| surfaces.gap(grid.x[end] + k as f64 * stride, placement) + parted < 0.0)
    })
}
