//! The state of a line on nodes that have come apart or together with its patch.
//!
//! On a patch that grows with its load every node keeps its state and its pressure. What belongs to places, as
//! displacements and their histories do, goes over as a function of x. Derivation: `docs/theory/lines.md`, section 5.

use super::grid::ContactGrid;
use super::state::GridState;
use crate::contact::layout::NodeSize;
use crate::contact::problem::LineProblem;
use crate::multistep::History;
use std::ops::Range;

/// Way of the material in a step over the distance of the nodes, below which these stay, and sizes asked for over that at hand with
/// which nodes stay at all \[1].
const LEAST_WAY: f64 = 0.02;
const SUITABLE: Range<f64> = 0.5..2.0;
/// Relative change of the size that is none \[1]: a load that is held differs by less from step to step, and factors of the
/// nodes at hand go on being right.
const SAME_SIZE: f64 = 1e-6;

/// Choice of the nodes of all lines.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Nodes {
    /// They follow the load.
    Following,
    /// They stay where they are as long as they suit: on dented surfaces.
    Staying,
    /// They are those of the grid: under steel that has softened patches become longer than their loads say, the displacement of an
    /// elastic layer has the kinks of the shear.
    OfTheGrid,
}

/// Places from which a cubic polynomial follows.
const CUBIC: usize = 4;

/// Cubic interpolation between ascending places, at places that are by a ratio as far from the middle.
struct Interpolation {
    /// First of the places between which every value lies, and their weights.
    stencils: Vec<(usize, [f64; CUBIC])>,
}

impl Interpolation {
    /// Beyond all but the outermost places of `x` values are those at the last one.
    fn new(x: &[f64], ratio: f64) -> Self {
        let mut first = 0;
        let stencils = x.iter().map(|place| {
            let place = (ratio * place).clamp(x[1], x[x.len() - 2]);
            while first + CUBIC < x.len() && x[first + 2] <= place {
                first += 1;
            }
            (first, weights(&std::array::from_fn(|k| x[first + k]), place))
        });
        Self { stencils: stencils.collect() }
    }

    fn at(&self, i: usize, value: impl Fn(usize) -> f64) -> f64 {
        let (first, weights) = &self.stencils[i];
        weights.iter().enumerate().map(|(k, weight)| weight * value(first + k)).sum()
    }

    fn histories(&self, histories: &mut Vec<History>) {
        if histories.is_empty() {
            return;
        }
        let carried = |(first, weights): &(usize, [f64; CUBIC])| {
            let mut carried = History { now: 0.0, before: 0.0, rate: 0.0 };
            for (weight, history) in weights.iter().zip(&histories[*first..]) {
                carried.now += weight * history.now;
                carried.before += weight * history.before;
                carried.rate += weight * history.rate;
            }
            carried
        };
        *histories = self.stencils.iter().map(carried).collect();
    }
}

/// Weights of values at four places in the value between the middle ones of the cubic polynomial that has there the slopes of the
/// parabolas through three of them: it has no kink from one stretch to the next, so that results are smooth in the ratio.
fn weights(x: &[f64; CUBIC], place: f64) -> [f64; CUBIC] {
    let [before, length, after] = std::array::from_fn(|k| x[k + 1] - x[k]);
    let t = (place - x[1]) / length;
    let slopes = |near: f64, far: f64| [-far / near, far / near - near / far, near / far].map(|by| by / (near + far));
    let (first, second) = (slopes(before, length), slopes(length, after));
    let [of_first, of_second] = [t * (1.0 - t) * (1.0 - t), -t * t * (1.0 - t)].map(|by| length * by);
    let rise = t * t * (3.0 - 2.0 * t);
    [
        of_first * first[0],
        1.0 - rise + of_first * first[1] + of_second * second[0],
        rise + of_first * first[2] + of_second * second[1],
        of_second * second[2],
    ]
}

impl GridState {
    /// Goes over to the nodes of a problem, those of `grid` in another size; see [`Self::next_size`].
    #[inline(never)]
    pub fn resize(&mut self, grid: &ContactGrid, problem: &LineProblem, course: ([f64; 2], Nodes)) {
        let size = self.next_size(grid, problem, course);
        let ratio = size / self.size;
        self.size = size;
        let share = std::mem::replace(&mut self.share, problem.share);
        if ratio == 1.0 || grid.len() < CUBIC {
            return;
        }
        self.forces *= ratio;
        self.lateral.iter_mut().for_each(|force| *force *= ratio);
        let candidates = Interpolation::new(&grid.x, ratio);
        self.take_histories(&candidates, (share / problem.share).sqrt());
        // Tractions between nodes of other distances.
        for pull in &mut self.pull {
            let density = |i: usize| candidates.at(i, |j| pull[j] / grid.width(j));
            *pull = (0..pull.len()).map(|i| density(i) * ratio * grid.width(i)).collect();
        }
        let nodes = Interpolation::new(grid.nodes(), ratio);
        for surface in &mut self.surface {
            let (before, now) = (surface.clone(), surface.as_mut_slice().as_chunks_mut::<2>().0);
            let before = before.as_slice().as_chunks::<2>().0;
            for (node, (first, weights)) in now.iter_mut().zip(&nodes.stencils) {
                let of_first = before[*first].map(|moved| weights[0] * moved);
                let rest = weights[1..].iter().zip(&before[first + 1..]);
                *node = rest.fold(of_first, |sum, (by, moved)| [sum[0] + by * moved[0], sum[1] + by * moved[1]]);
            }
        }
    }

    /// Size of the nodes in a problem, for the velocities V [m/s] and Ω [rad/s] with which the search begins: that of the patch
    /// under the load, or the present one where that is the same within [`SAME_SIZE`]. Sticking surfaces remember at every place
    /// what has been before, and dents have the shape of the nodes that pressed them: under material that hardly moves and on dents
    /// nodes stay as long as they suit, and where they do not they become at least as large as under the nominal load.
    fn next_size(
        &self,
        grid: &ContactGrid,
        problem: &LineProblem,
        ([velocity, omega], nodes): ([f64; 2], Nodes),
    ) -> f64 {
        let Some(NodeSize { under_load, nominal }) = problem.size.filter(|_| nodes != Nodes::OfTheGrid) else {
            return 1.0;
        };
        let way = 0.5 * problem.duration * (velocity.abs() + problem.radius() * omega.abs());
        let moves = way >= LEAST_WAY * self.size * grid.spacing || problem.time.is_stationary() && velocity != 0.0;
        if moves && nodes == Nodes::Following {
            return if (under_load / self.size - 1.0).abs() < SAME_SIZE { self.size } else { under_load };
        }
        let size = under_load.max(nominal);
        if SUITABLE.contains(&(size / self.size)) { self.size } else { size }
    }

    /// Choice of nodes that suits a line, as far as its surfaces and its steel are concerned.
    pub fn suited(&self, problem: &LineProblem) -> Nodes {
        if problem.layer.gives_way() || !problem.limits.softened.is_empty() {
            Nodes::OfTheGrid
        } else if self.yielded.contains(&true) || problem.surfaces.uneven.is_some() {
            Nodes::Staying
        } else {
            Nodes::Following
        }
    }

    /// Displacements of before go over as functions of x; those by the lines of a patch whose width has changed become
    /// smaller by the factor `kept`, see [`Self::widened`].
    fn take_histories(&mut self, candidates: &Interpolation, kept: f64) {
        for (moved, widened) in self.moved.iter_mut().zip(&mut self.widened) {
            candidates.histories(moved);
            candidates.histories(widened);
            if kept == 1.0 || !kept.is_finite() {
                continue;
            }
            for (moved, widened) in moved.iter_mut().zip(widened) {
                moved.now += (kept - 1.0) * widened.now;
                moved.before += (kept - 1.0) * widened.before;
                *widened =
                    History { now: kept * widened.now, before: kept * widened.before, rate: kept * widened.rate };
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quadratic_function_goes_over_to_nodes_of_every_size_exactly_and_none_has_a_kink() {
        let x = [-9.0, -5.0, -3.0, -2.0, -1.0, 0.0, 1.0, 2.0, 3.0, 5.0, 9.0];
        let quadratic = |x: f64| 1.0 + x * (0.5 - 0.25 * x);
        for ratio in [0.2, 0.97, 1.0, 1.03, 2.5] {
            let interpolation = Interpolation::new(&x, ratio);
            for i in 0..x.len() {
                let found = interpolation.at(i, |j| quadratic(x[j]));
                let expected = quadratic((ratio * x[i]).clamp(-5.0, 5.0));
                assert!((found - expected).abs() < 1e-12, "{ratio} {i}: {found} {expected}");
            }
        }
        let rough = |j: usize| if j.is_multiple_of(2) { 1.0 } else { -0.5 };
        let at = |ratio: f64, i: usize| Interpolation::new(&x, ratio).at(i, rough);
        for (i, place) in x.iter().enumerate().take(9).skip(2) {
            let (now, h) = (at(1.0, i), 1e-6);
            assert_eq!(now, rough(i));
            let slopes = [(at(1.0 + h, i) - now) / h, (now - at(1.0 - h, i)) / h];
            assert!((slopes[0] - slopes[1]).abs() <= 1e-4 * place.abs(), "{i}: {slopes:?}");
        }
    }
}
