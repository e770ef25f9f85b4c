//! Strength of the steel under the candidates, and the friction that is left of it.
//!
//! Yielding limits the pressure, and friction stays Coulomb's. Where steel stands under friction beyond [`SLIDES`], it bears its
//! strength in shear as far as it has flowed: by the depth of its dents, which, unlike a state or a pressure, neither jumps nor
//! goes back.
//!
//! The largest normal force depends on the shear of friction, and friction on the normal force. It is that of the ratio
//! of both in the solution before: where a node slips, this is the friction coefficient, and hardly changes in a step.
//! A limit that depended on the forces or states at hand would leave steps without a solution where a node begins to
//! slip.

use super::grid::ContactGrid;
use super::state::GridState;
use crate::contact::film;
use crate::contact::limits::SLIDES;
use crate::contact::problem::LineProblem;

/// Difference of two ratios of shear and pressure that is rounding \[1].
const SAME_RATIO: f64 = 1e-14;

/// Share of friction that a film takes from a place from which on it counts as being there \[1].
const NOTICED: f64 = 1e-3;

/// Limits of the nodal forces.
#[derive(Default)]
pub struct Strength {
    /// Normal force at the candidates above which steel yields [N/m]; empty: it does not.
    pub limit: Vec<f64>,
    /// Share in which the candidates bear the strength of flowing steel in shear, and that over their normal forces of the
    /// start \[1]; empty: none does.
    flowed: Vec<[f64; 2]>,
    /// Share of the friction coefficient at the candidates where the surface melts \[1]; empty: all of it everywhere.
    film: Vec<f64>,
}

impl Strength {
    /// Finds all limits in a problem that starts from `state`.
    pub fn find(&mut self, grid: &ContactGrid, problem: &LineProblem, state: &GridState) {
        let Self { limit, flowed, film: of_film } = self;
        [&mut *limit, of_film].into_iter().for_each(Vec::clear);
        flowed.clear();
        let limits = &problem.limits;
        if limits.is_limited() {
            let pressed = |i: usize| state.forces[grid.component(i) + 1];
            let across = |i: usize| state.lateral.get(i).copied().unwrap_or(0.0);
            let sheared = |i: usize| match across(i) {
                0.0 => state.forces[grid.component(i)].abs(),
                lateral => libm::hypot(state.forces[grid.component(i)], lateral),
            };
            let ratio = |i: usize| sheared(i) / pressed(i);
            // Nodes that close take the shear of the nearest ones.
            let closed = |i: &usize| pressed(*i) > 0.0;
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
            if let Some(uneven) = problem.surfaces.uneven.filter(|uneven| limits.sheared > 0.0 && uneven.is_dented()) {
                flowed.extend(grid.x.iter().enumerate().map(|(i, &x)| {
                    let bears = grid.width(i) * limits.strength_at(x) / pressed(i).max(0.0);
                    [limits.sheared * limits.flowed(x, uneven.dented(x)), bears.max(SLIDES)]
                }));
            }
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
    pub fn friction(&self, i: usize, coefficient: f64) -> f64 {
        let coefficient = self.film.get(i).copied().unwrap_or(1.0) * coefficient;
        let less = |[share, bears]: &[f64; 2]| share * (coefficient - bears).max(0.0);
        coefficient - self.flowed.get(i).map_or(0.0, less)
    }
}
