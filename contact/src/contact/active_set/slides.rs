//! Directions of friction where it may have any, along and across.
//!
//! A node that slips has the friction `μp n`; its slip is against the direction n. With `z = q − s/b`, of the shear q, the slip
//! s and a slip b per force of the size of its own, the direction is that of z, and Newton's method on `q = μp z/|z|` leaves to
//! the shear across n what turns it: the slip across n is `−(|z| − μp) b/μp` times that. At a solution this is `|s|/μp`, whatever
//! b. Derivation: `docs/theory/contact.md`, section 7.

use super::states::{nearest_closed, size};
use crate::contact::line::contact_line::ContactLine;
use crate::contact::line::state::NodeStatus;
use crate::contact::line::state::Slide;

/// Takes the directions and turns of the step before, each changed on as in that step; on rough surfaces every
/// step is another one, and a stationary state follows none.
pub(super) fn begin(line: &mut ContactLine) {
    if line.state.directions() == 1 {
        return;
    }
    let ratio = line.problem.time.ratio().unwrap_or(1.0);
    let follows = line.given.rail_slope.is_empty() && !line.problem.time.is_stationary();
    let sum = (0..line.grid.len()).map(|i| line.shear(i)).fold([0.0; 2], |sum, q| [sum[0] + q[0], sum[1] + q[1]]);
    let mut slid = std::mem::take(&mut line.state.slid);
    slid.resize(if follows { line.grid.len() } else { 0 }, Slide::default());
    line.iterate.slides.clear();
    for i in 0..line.grid.len() {
        let [shear, slip] = [line.shear(i), [line.state.slip[0][i], line.state.slip[1][i]]].map(Polar::of);
        let direction = shear.direction.or(Polar::of(sum).direction).unwrap_or([1.0, 0.0]);
        let now = Slide { direction, turn: if shear.size > 0.0 { slip.size / shear.size } else { 0.0 } };
        let before = slid.get_mut(i).map(|before| std::mem::replace(before, now));
        line.iterate.slides.push(before.map_or(now, |before| went_on(before, now, ratio)));
    }
    line.state.slid = slid;
}

/// The slide after a step that is `ratio` times as long as the one from `before` to `now`, if it goes on changing; a direction that
/// turns by more than 60° is kept.
fn went_on(before: Slide, now: Slide, ratio: f64) -> Slide {
    let cosine: f64 = before.direction.iter().zip(now.direction).map(|(a, b)| a * b).sum();
    let further = Polar::of([0, 1].map(|d| now.direction[d] + ratio * (now.direction[d] - before.direction[d])));
    match further.direction.filter(|_| cosine > 0.5) {
        Some(direction) => Slide { direction, turn: (now.turn + ratio * (now.turn - before.turn)).max(0.0) },
        None => now,
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
