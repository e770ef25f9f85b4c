//! Strength of the steel under the candidates, and the friction that is left of it.
//!
//! The largest normal force depends on the shear of friction, and friction on the normal force. It is that of the ratio
//! of both in the solution before: where a node slips, this is the friction coefficient, and hardly changes in a step.
//! A limit that depended on the forces or states at hand would leave steps without a solution where a node begins to
//! slip.

use super::grid::ContactGrid;
use crate::contact::film;
use crate::contact::limits::SteelLimits;
use nalgebra::DVector;

/// Share of its largest pressure from which on a node goes over to the friction of yielding steel, which it has reached
/// at the largest pressure \[1]. A node at the limit yields in one step, and in the next one its dent keeps it below:
/// with a friction that jumped, force and temperature jumped from step to step.
const NEARLY_PLASTIC: f64 = 0.95;

/// Difference of two ratios of shear and pressure that is rounding \[1].
const SAME_RATIO: f64 = 1e-14;

/// Share of friction that a film takes from a place from which on it counts as being there \[1].
const NOTICED: f64 = 1e-3;

/// Limits of the nodal forces.
#[derive(Default)]
pub struct Strength {
    /// Normal force at the candidates above which steel yields [N/m]; empty: it does not.
    pub limit: Vec<f64>,
    /// Yield strength in shear at the candidates [N/m]; empty: steel does not yield.
    in_shear: Vec<f64>,
    /// Normal forces of the start [N/m]; empty: nothing yields.
    pressed: Vec<f64>,
    /// Share of the friction coefficient at the candidates where the surface melts \[1]; empty: all of it everywhere.
    film: Vec<f64>,
}

impl Strength {
    /// Finds all limits; `forces` are the port forces of the start, `lateral` those across at the candidates [N/m]; empty:
    /// there are none.
    pub fn find(&mut self, grid: &ContactGrid, limits: &SteelLimits, forces: &DVector<f64>, lateral: &[f64]) {
        let Self { limit, in_shear, pressed, film: of_film } = self;
        [&mut *in_shear, limit, pressed, of_film].into_iter().for_each(Vec::clear);
        if limits.is_limited() {
            in_shear.extend(grid.x.iter().enumerate().map(|(i, &x)| grid.width(i) * limits.strength_at(x)));
            pressed.extend((0..grid.len()).map(|i| forces[grid.component(i) + 1]));
            let across = |i: usize| lateral.get(i).copied().unwrap_or(0.0);
            let sheared = |i: usize| match across(i) {
                0.0 => forces[grid.component(i)].abs(),
                lateral => libm::hypot(forces[grid.component(i)], lateral),
            };
            let ratio = |i: usize| sheared(i) / pressed[i];
            // Nodes that close take the shear of the nearest ones.
            let closed = |i: &usize| pressed[*i] > 0.0;
            let ends = (0..grid.len()).find(closed).zip((0..grid.len()).rfind(closed));
            // All nodes that slip have one ratio, but for rounding, and so have all beyond an edge.
            let mut last = (f64::INFINITY, None);
            limit.extend(grid.x.iter().enumerate().map(|(i, &x)| {
                let nearest = ends.map_or(0.0, |(first, last)| ratio(i.clamp(first, last)));
                let nearest = if nearest.is_finite() { nearest } else { 0.0 };
                if (nearest - last.0).abs() > SAME_RATIO {
                    last = (nearest, limits.borne(nearest));
                }
                grid.width(i) * limits.sheared_at(x, last.1)
            }));
        }
        if !limits.film.is_empty() {
            of_film.extend(film::means(grid.around(), limits.film));
        }
    }

    /// Force of candidate `i` above the limit of its steel, given its normal force [N/m]; `None` where nothing yields.
    pub fn excess(&self, i: usize, normal: f64) -> Option<f64> {
        self.limit.get(i).map(|limit| normal - limit)
    }

    /// True if a film takes friction from candidate `i`.
    pub fn is_molten(&self, i: usize) -> bool {
        self.film.get(i).is_some_and(|share| *share < 1.0 - NOTICED)
    }

    /// Friction force that candidate `i` can bear over its normal force at the friction coefficient of the line \[1].
    /// Steel at its limit bears its strength in shear.
    pub fn friction(&self, i: usize, coefficient: f64) -> f64 {
        let coefficient = self.film.get(i).copied().unwrap_or(1.0) * coefficient;
        let (Some(in_shear), Some(limit)) = (self.in_shear.get(i), self.limit.get(i)) else { return coefficient };
        let plastic = ((self.pressed[i] / limit - NEARLY_PLASTIC) / (1.0 - NEARLY_PLASTIC)).clamp(0.0, 1.0);
        coefficient - plastic * (coefficient - in_shear / limit).max(0.0)
    }
}
