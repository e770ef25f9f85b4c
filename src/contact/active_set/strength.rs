//! What the steel under the contact bears at each node, and the friction that is left of it.
//!
//! The largest normal force depends on the shear of friction, and friction on the normal force. It is that of the ratio of both in the
//! solution before: where a node slips, this is the friction coefficient, and hardly changes in a step. A limit that depended on the
//! forces or states at hand would leave steps without a solution where a node begins to slip.

use super::iterate::{ActiveSetScratch, Iterate};

/// Share of its largest pressure from which on a node goes over to the friction of yielding steel, which it has reached at the
/// largest pressure \[1]. A node at the limit yields in one step, and in the next one its dent keeps it below: with a friction
/// that jumped, force and temperature jumped from step to step.
const NEARLY_PLASTIC: f64 = 0.95;

impl Iterate<'_> {
    /// Finds strengths, largest normal forces and molten films at the candidates, and what these bear at the start.
    pub(super) fn find_strength(&mut self) {
        let (grid, limits) = (self.grid, &self.problem.limits);
        let ActiveSetScratch { strength, limit, pressed, film, .. } = &mut *self.scratch;
        [&mut *strength, limit, pressed, film].into_iter().for_each(Vec::clear);
        if limits.is_limited() {
            strength.extend(grid.x.iter().enumerate().map(|(i, &x)| grid.width(i) * limits.strength_at(x)));
            pressed.extend((0..grid.len()).map(|i| self.traction.port_forces[grid.port(i) + 1]));
            let ratio = |i: usize| self.traction.port_forces[grid.port(i)].abs() / pressed[i];
            // Nodes that close take the shear of the nearest ones.
            let closed = |i: &usize| pressed[*i] > 0.0;
            let ends = (0..grid.len()).find(closed).zip((0..grid.len()).rfind(closed));
            limit.extend(grid.x.iter().enumerate().map(|(i, &x)| {
                let nearest = ends.map_or(0.0, |(first, last)| ratio(i.clamp(first, last)));
                grid.width(i) * limits.sheared_at(x, if nearest.is_finite() { nearest } else { 0.0 })
            }));
        } else {
            self.state.yielded.fill(false);
        }
        if !limits.film.is_empty() {
            film.extend(grid.x.iter().map(|&x| limits.film_at(x)));
        }
    }

    /// Whether the steel at a node yields: where it bears more than its limit.
    pub(super) fn yields(&self, i: usize, tolerance: f64) -> bool {
        let Some(limit) = self.scratch.limit.get(i) else { return false };
        let excess = self.normal(i) - limit;
        if excess.abs() <= tolerance { self.state.yielded[i] } else { excess > 0.0 }
    }

    /// Friction force that candidate `i` can bear over its normal force [1]. Steel at its limit bears its strength in shear.
    pub fn coefficient(&self, i: usize) -> f64 {
        let coefficient = self.scratch.film.get(i).copied().unwrap_or(1.0) * self.traction.friction;
        let ActiveSetScratch { strength, limit, pressed, .. } = &*self.scratch;
        let (Some(strength), Some(limit)) = (strength.get(i), limit.get(i)) else { return coefficient };
        let plastic = ((pressed[i] / limit - NEARLY_PLASTIC) / (1.0 - NEARLY_PLASTIC)).clamp(0.0, 1.0);
        coefficient - plastic * (coefficient - strength / limit).max(0.0)
    }
}
