//! Ends of the grid: a contact that reaches them is refused.

use super::contact_line::ContactLine;
use crate::contact::error::ContactError;

/// Distance beyond the grid up to which uneven surfaces are watched, over half of its length \[1]: as far as their
/// wings.
const WATCHED: f64 = 3.0;
/// Relative deviation of a place from the end that counts as none \[1].
const ROUND_OFF: f64 = 1e-9;
/// Distance of the places that are watched [spacings].
const STRIDE: f64 = 2.0;

/// Refuses patches that reach the end of the grid, and surfaces that would touch beyond it.
pub fn check(line: &ContactLine) -> Result<(), ContactError> {
    // Nodes that are farther apart than those of the grid reach farther than the bodies do.
    let zone = line.grid.x.last().map_or(0.0, |last| last / line.grid.size.max(1.0));
    let at_end = |i: usize| line.state.status[i].is_active() && line.grid.x[i].abs() > (1.0 - ROUND_OFF) * zone;
    if (0..line.grid.len()).any(at_end) || touches_beyond(line) {
        let load = line.traction.port_forces.iter().skip(1).step_by(2).sum();
        return Err(ContactError::ZoneExceeded { zone, load });
    }
    Ok(())
}

/// True if uneven surfaces that are displaced as at the ends of the grid would overlap beyond them.
fn touches_beyond(line: &ContactLine) -> bool {
    let (grid, surfaces) = (line.grid, &line.problem.surfaces);
    if surfaces.uneven.is_none() {
        return false;
    }
    let (last, stride) = (grid.len() - 1, STRIDE * grid.spacing);
    [(0, -stride), (last, stride)].into_iter().any(|(end, stride)| {
        let parted = line.state.gap[end] - line.given.gap[end];
        let places = (WATCHED * grid.x[end] / stride) as usize;
        (1..=places).any(|k| surfaces.gap(grid.x[end] + k as f64 * stride) + parted < 0.0)
    })
}
