//! Arrival of rail of another temperature.
//!
//! The rail ahead of the contact has one temperature. Where it changes, the whole rail ahead changes at once and stays
//! as it is under the wheel and behind it; the stream carries the front through the contact. The same equations thus
//! see the rail as it is, whatever it was before.

use crate::heat::exchange::Exchange;
use crate::heat::state::HeatState;
use crate::heat::tensor::mesh::layout::HeatLayout;

/// Length of the front in half-widths at the nominal load: elements resolve it \[1].
const FRONT: f64 = 1.0;
/// Speed below which a wheel stands [m/s]: heat goes faster than the rail then, and the direction may be round-off.
const STANDS: f64 = 1e-5;

/// Fills `begin` with `state` under the rail that arrives now with the heat content `arriving` over `ρc` \[K], and
/// tells whether it differs from `state`. A standing wheel meets no other rail.
pub fn arrive(
    layout: &HeatLayout,
    state: &HeatState,
    arriving: f64,
    velocity: f64,
    exchange: &Exchange,
    begin: &mut HeatState,
) -> bool {
    let change = arriving - state.arriving;
    if change == 0.0 || velocity.abs() < STANDS {
        return false;
    }
    begin.clone_from(state);
    begin.arriving = arriving;
    begin.forget_sums();
    let ahead = |x: f64| x * velocity.signum();
    let ends = exchange.patches.iter().flat_map(|patch| [ahead(patch.low), ahead(patch.high)]);
    let from = ends.fold(layout.config.zone, f64::max);
    let (modes, nodes) = (&layout.rail.modes, &layout.rail.streamline.nodes);
    let first = begin.rows.len().min(layout.wheel.streamline.len());
    let mut known = begin.rows[first..].iter_mut();
    let [_, rail] = layout.split_mut(&mut begin.values);
    for (row, &x) in rail.chunks_exact_mut(modes.len()).zip(nodes) {
        let known = known.next();
        let share = ((ahead(x) - from) / (FRONT * layout.config.half_width)).clamp(0.0, 1.0);
        let risen = change * share * share * (3.0 - 2.0 * share);
        if risen != 0.0 {
            row.iter_mut().zip(&modes.free).for_each(|(value, one)| *value += risen * one);
            known.into_iter().for_each(|known| known.found.iter_mut().for_each(|end| *end += risen));
        }
    }
    begin.range = [begin.range[0] + change.min(0.0), begin.range[1] + change.max(0.0)];
    true
}
