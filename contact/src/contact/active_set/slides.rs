//! Directions of friction where it may have any, along and across.
//!
//! A node that slips has the friction `μp n`; its slip is against the direction n. With `z = q − s/b`, of the shear q, the slip
//! s and a slip b per force of the size of its own, the direction is that of z, and Newton's method on `q = μp z/|z|` leaves to
//! the shear across n what turns it: the slip across n is `−(|z| − μp) b/μp` times that. At a solution this is `|s|/μp`, whatever
//! b. Derivation: `docs/theory/contact.md`, section 7.

use super::states::{nearest_closed, size};
use crate::contact::line::contact_line::{ContactLine, Slide};
use crate::contact::line::state::NodeStatus;

/// Takes the directions of the shear and the slips of the step before.
pub(super) fn begin(line: &mut ContactLine) {
    if line.state.directions() == 1 {
        return;
    }
    let sum = (0..line.grid.len()).map(|i| line.shear(i)).fold([0.0; 2], |sum, q| [sum[0] + q[0], sum[1] + q[1]]);
    line.iterate.slides.clear();
    for i in 0..line.grid.len() {
        let [shear, slip] = [line.shear(i), [line.state.slip[0][i], line.state.slip[1][i]]].map(Polar::of);
        let direction = shear.direction.or(Polar::of(sum).direction).unwrap_or([1.0, 0.0]);
        let turn = if shear.size > 0.0 { slip.size / shear.size } else { 0.0 };
        line.iterate.slides.push(Slide { direction, turn });
    }
}

/// Takes new directions at the nodes that slip, which had these states `before`; returns how far friction is from those, over
/// the largest of the line \[1].
pub(super) fn turn(line: &mut ContactLine, before: &[NodeStatus]) -> f64 {
    if line.state.directions() == 1 {
        return 0.0;
    }
    let bears = |line: &ContactLine, i: usize| line.friction(i) * line.normal(i).max(0.0);
    let most = (0..line.grid.len()).map(|i| bears(line, i)).fold(0.0, f64::max);
    let (slides, own_slip, mut missed) = (line.iterate.slides.clone(), line.iterate.own_slip, 0.0_f64);
    for i in (0..line.grid.len()).filter(|&i| line.state.status[i].friction_direction() != 0.0) {
        let (friction, shear) = (bears(line, i), line.shear(i));
        let drawn = Polar::of(line.shear_without_slip(i).unwrap_or(shear));
        line.iterate.slides[i] = match (before[i].is_active(), drawn.direction) {
            (true, Some(direction)) if friction > 0.0 => {
                let off = [0, 1].map(|d| shear[d] - friction * direction[d]);
                if before[i].friction_direction() != 0.0 {
                    missed = missed.max(Polar::of(off).size / most);
                }
                Slide { direction, turn: own_slip * ((drawn.size - friction) / friction).max(0.0) }
            }
            (true, _) => Slide { turn: f64::INFINITY, ..slides[i] },
            (false, _) => match nearest_closed(before, i) {
                Some(nearest) if before[nearest].friction_direction() != 0.0 => slides[nearest],
                _ => Slide { direction: [line.state.status[i].friction_direction(), 0.0], turn: 0.0 },
            },
        };
    }
    missed
}

/// A pair of numbers as its length and direction; `None`: it has none.
struct Polar {
    size: f64,
    direction: Option<[f64; 2]>,
}

impl Polar {
    fn of(pair: [f64; 2]) -> Self {
        let size = size(pair);
        Self { size, direction: (size > 0.0).then(|| pair.map(|part| part / size)) }
    }
}
