//! Depth that wear has taken off a surface, on cells that are fixed to the material.

use crate::piecewise::Piecewise;
use serde::{Deserialize, Serialize};
use std::collections::VecDeque;

/// Path of a step over the length on which wear is distributed \[1], below which all of it is taken off at the middle
/// of the path: the difference of two integrals would lose digits.
const SHORT_PATH: f64 = 1e-3;

/// Mean depths over cells of one length that are fixed to the material, around a wheel or along an open surface. The
/// surface is linear between the middles of cells, so that its volume is the sum of those of the cells.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Worn {
    /// Circumference [m]; zero: the surface is open.
    circumference: f64,
    /// Length of a cell [m]; zero while nothing is worn.
    spacing: f64,
    /// Number of the first cell; the middle of cell k is at k · spacing.
    first: i64,
    /// Depth of the cells [m].
    depth: VecDeque<f64>,
}

/// Wear of a step: a volume, and its distribution about a contact point that moves along the material.
pub struct WearIncrement<'a> {
    /// Positions of the contact point on the material at the beginning and at the end of the step \[m].
    pub path: [f64; 2],
    /// Distribution of wear about the contact point, over x, of any scale; zero outside its ends.
    pub distribution: &'a Piecewise,
    /// Volume per width \[m²].
    pub volume: f64,
    /// Length over which the depth of the step is smoothed \[m]; zero: not at all.
    pub smoothing: f64,
}

impl Worn {
    /// A surface without wear: closed with a circumference \[m], or open with zero.
    pub fn none(circumference: f64) -> Self {
        Self { circumference, ..Self::default() }
    }

    /// Absence of wear.
    pub fn is_empty(&self) -> bool {
        self.depth.is_empty()
    }

    /// Depth \[m] at the position `s` \[m].
    pub fn depth(&self, s: f64) -> f64 {
        if self.is_empty() {
            return 0.0;
        }
        let index = s / self.spacing;
        let (whole, share) = (index.floor(), index - index.floor());
        let [here, next] = [whole as i64, (whole as i64).saturating_add(1)].map(|k| self.cell(k));
        here + share * (next - here)
    }

    /// Largest depth \[m].
    pub fn deepest(&self) -> f64 {
        self.depth.iter().copied().fold(0.0, f64::max)
    }

    /// Depth \[m] that all of a wheel has lost; nothing on an open surface, which goes on.
    pub fn shallowest(&self) -> f64 {
        match self.circumference > 0.0 && !self.is_empty() {
            true => self.depth.iter().copied().fold(f64::INFINITY, f64::min),
            false => 0.0,
        }
    }

    /// Position \[m] of the most worn cell.
    pub fn deepest_place(&self) -> Option<f64> {
        let deepest = self.depth.iter().zip(self.first..).max_by(|a, b| a.0.total_cmp(b.0));
        deepest.map(|(_, cell)| cell as f64 * self.spacing)
    }

    /// Volume worn off per width \[m²].
    pub fn volume(&self) -> f64 {
        self.spacing * self.depth.iter().sum::<f64>()
    }

    /// Takes off the wear of a step. The first one fixes the length of the cells: at most `spacing` \[m] around a
    /// wheel, `spacing` on an open surface.
    pub fn remove(&mut self, increment: &WearIncrement, spacing: f64) {
        let (Some(&low), Some(&high)) = (increment.distribution.x.first(), increment.distribution.x.last()) else {
            return;
        };
        let mut integral = [0.0, 0.0];
        integrals(increment.distribution, high, &mut integral);
        if integral[0] <= 0.0 || increment.volume <= 0.0 {
            return;
        }
        self.allocate_cells(spacing);
        let [from, mut to] = increment.path;
        let mut volume = increment.volume;
        if self.circumference > 0.0 {
            // Whole turns wear evenly.
            let turns = ((to - from) / self.circumference).trunc();
            let even = volume * turns * self.circumference / if turns == 0.0 { 1.0 } else { to - from };
            let each = even / self.circumference;
            self.depth.iter_mut().filter(|_| each > 0.0).for_each(|depth| *depth += each);
            (to, volume) = (to - turns * self.circumference, volume - even);
        }
        let rest = WearIncrement { path: [from, to], volume, ..*increment };
        let cells = [from.min(to) + low, from.max(to) + high].map(|s| (s / self.spacing).round() as i64);
        let shares = rest.shares(self.spacing, cells, integral[0]);
        let beyond = shares.1;
        for (k, share) in (cells[0] - beyond..).zip(shares.0) {
            self.add(k, volume * share / self.spacing);
        }
    }

    /// Forgets cells of an open surface that lie farther than `reach` \[m] from the position `s` \[m].
    pub fn forget_beyond(&mut self, s: f64, reach: f64) {
        let place = |k: i64| k as f64 * self.spacing;
        while !self.depth.is_empty() && place(self.first) < s - reach {
            self.depth.pop_front();
            self.first += 1;
        }
        while !self.depth.is_empty() && place(self.first + self.depth.len() as i64 - 1) > s + reach {
            self.depth.pop_back();
        }
    }

    /// Finiteness of all numbers, and cells that close around a wheel.
    pub fn is_sound(&self) -> bool {
        let cells = self.depth.len() as f64 * self.spacing;
        let closed = self.circumference == 0.0 || (cells - self.circumference).abs() <= 1e-9 * self.circumference;
        self.is_empty()
            || (self.spacing > 0.0
                && self.spacing.is_finite()
                && closed
                && self.first.unsigned_abs() < i64::MAX as u64 / 2
                && self.depth.iter().all(|depth| depth.is_finite()))
    }

    fn allocate_cells(&mut self, spacing: f64) {
        if !self.is_empty() {
            return;
        }
        let cells = (self.circumference / spacing).ceil();
        self.spacing = if cells > 0.0 { self.circumference / cells } else { spacing };
        self.first = 0;
        self.depth.resize(cells as usize, 0.0);
    }

    fn cell(&self, k: i64) -> f64 {
        let count = self.depth.len() as i64;
        let index = match self.circumference > 0.0 {
            true => k.rem_euclid(count.max(1)),
            false => k.saturating_sub(self.first),
        };
        usize::try_from(index).ok().and_then(|index| self.depth.get(index)).copied().unwrap_or(0.0)
    }

    fn add(&mut self, k: i64, depth: f64) {
        if self.circumference > 0.0 {
            let index = k.rem_euclid(self.depth.len().max(1) as i64) as usize;
            self.depth[index] += depth;
            return;
        }
        if self.depth.is_empty() {
            self.first = k;
        }
        while k < self.first {
            self.depth.push_front(0.0);
            self.first -= 1;
        }
        let index = (k - self.first) as usize;
        if index >= self.depth.len() {
            self.depth.resize(index + 1, 0.0);
        }
        self.depth[index] += depth;
    }
}

impl WearIncrement<'_> {
    /// Shares of the volume on the cells of a length `spacing` \[m] from the first to the last of `cells`, and on
    /// further ones on both sides, whose number is returned besides; they add up to one. `total` is the integral of the
    /// distribution.
    fn shares(&self, spacing: f64, cells: [i64; 2], total: f64) -> (Vec<f64>, i64) {
        let [from, to] = self.path;
        let beyond = if self.smoothing > 0.0 { (6.0 * self.smoothing / spacing).ceil() as i64 } else { 0 };
        let edge = |k: i64| (k as f64 + 0.5) * spacing;
        let stands = (to - from).abs() <= SHORT_PATH * (cells[1] - cells[0] + 1) as f64 * spacing;
        let worn = |s: f64| {
            let at = |place: f64| {
                let mut integral = [0.0; 2];
                integrals(self.distribution, s - place, &mut integral);
                integral
            };
            let sum = if stands { at(0.5 * (from + to))[0] } else { (at(from)[1] - at(to)[1]) / (to - from) };
            sum / total
        };
        let mut shares = vec![0.0; (cells[1] - cells[0] + 1 + 2 * beyond) as usize];
        let mut before = 0.0;
        for k in cells[0]..=cells[1] {
            let up_to = if k == cells[1] { 1.0 } else { worn(edge(k)) };
            shares[(k - cells[0] + beyond) as usize] = up_to - before;
            before = up_to;
        }
        if self.smoothing > 0.0 {
            smooth(&mut shares, (self.smoothing / spacing).powi(2));
        }
        (shares, beyond)
    }
}

/// Integral of a piecewise linear function up to x, and that of this integral.
fn integrals(function: &Piecewise, x: f64, found: &mut [f64; 2]) {
    *found = [0.0; 2];
    for (ends, values) in function.x.windows(2).zip(function.value.windows(2)) {
        let length = ends[1] - ends[0];
        let part = (x - ends[0]).min(length);
        if part <= 0.0 {
            return;
        }
        let slope = if length > 0.0 { (values[1] - values[0]) / length } else { 0.0 };
        let first = part * (values[0] + 0.5 * slope * part);
        let second = part * (found[0] + part * (0.5 * values[0] + slope * part / 6.0));
        *found = [found[0] + first, found[1] + second];
    }
    if let Some(&last) = function.x.last() {
        found[1] += found[0] * (x - last).max(0.0);
    }
}

/// Solves `(1 − α d²) u = given` on cells, with `d` the difference of neighbours and no flux through the ends: the sum
/// of all values stays, and waves shorter than `√α` cells are smoothed out.
fn smooth(values: &mut [f64], alpha: f64) {
    let last = values.len().saturating_sub(1);
    let mut factor = vec![0.0; values.len()];
    for i in 0..=last {
        let neighbours = f64::from(u8::from(i > 0)) + f64::from(u8::from(i < last));
        let (above, before) = if i > 0 { (factor[i - 1], values[i - 1]) } else { (0.0, 0.0) };
        let pivot = 1.0 + alpha * (neighbours - above);
        factor[i] = if i < last { alpha / pivot } else { 0.0 };
        values[i] = (values[i] + alpha * before) / pivot;
    }
    for i in (0..last).rev() {
        values[i] += factor[i] * values[i + 1];
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn hat() -> Piecewise {
        Piecewise { x: vec![-3e-3, 1e-3, 3e-3], value: vec![0.0, 5.0, 0.0] }
    }

    /// Standing, rolling by less and more than the spread, backwards, over the seam, several turns.
    #[test]
    fn the_cells_lose_exactly_the_volume_whatever_the_way() {
        let spread = hat();
        for circumference in [0.0, 1.3] {
            for even in [0.0, 4e-3] {
                let mut worn = Worn::none(circumference);
                let ways = [
                    [0.1, 0.1],
                    [0.1, 0.1 + 1e-9],
                    [0.2, 0.203],
                    [0.25, 0.31],
                    [0.31, 0.0],
                    [-0.1, 3.0],
                    [4e5, 4e5 - 2e-3],
                ];
                for (count, way) in (1..).zip(ways.into_iter().take(if circumference > 0.0 { 7 } else { 6 })) {
                    worn.remove(
                        &WearIncrement { path: way, distribution: &spread, volume: 2e-6, smoothing: even },
                        3.1e-4,
                    );
                    let volume = f64::from(count) * 2e-6;
                    assert!((worn.volume() / volume - 1.0).abs() < 1e-12, "{circumference} {way:?}: {}", worn.volume());
                    assert!(worn.depth.iter().all(|depth| *depth >= -1e-18) && worn.is_sound());
                }
            }
        }
    }

    /// A patch that moves by a multiple of its length leaves the same depth everywhere on its way.
    #[test]
    fn a_patch_that_rolls_on_leaves_an_even_depth_in_any_steps() {
        let (spread, way, volume) = (hat(), 0.05, 1e-6);
        for steps in [1, 7, 100] {
            let mut worn = Worn::none(0.0);
            let place = |k: i32| 2.0 + way * f64::from(k) / f64::from(steps);
            for k in 0..steps {
                let volume = volume / f64::from(steps);
                worn.remove(
                    &WearIncrement { path: [place(k), place(k + 1)], distribution: &spread, volume, smoothing: 0.0 },
                    3e-4,
                );
            }
            for s in [2.01, 2.025, 2.04] {
                assert!((worn.depth(s) / (volume / way) - 1.0).abs() < 1e-9, "{steps} {s} {}", worn.depth(s));
            }
            assert_eq!([worn.depth(1.99), worn.depth(2.06)], [0.0; 2]);
        }
    }

    #[test]
    fn smoothing_keeps_the_sum_and_takes_the_roughness() {
        let mut values: Vec<f64> =
            (0..200).map(|k| if (80..120).contains(&k) { f64::from(k % 2) } else { 0.0 }).collect();
        smooth(&mut values, 16.0);
        assert!((values.iter().sum::<f64>() - 20.0).abs() < 1e-12 && values.iter().all(|value| *value > 0.0));
        assert!((values[100] - values[101]).abs() < 0.02 && (values[100] - 0.5).abs() < 0.02, "{}", values[100]);
    }

    #[test]
    fn an_open_surface_forgets_what_is_far() {
        let (spread, mut worn) = (hat(), Worn::none(0.0));
        worn.remove(&WearIncrement { path: [1.0, 2.0], distribution: &spread, volume: 1e-6, smoothing: 0.0 }, 1e-3);
        worn.forget_beyond(2.0, 0.5);
        assert!(worn.depth(1.4) == 0.0 && worn.depth(1.6) > 0.0 && worn.is_sound());
        worn.forget_beyond(9.0, 0.5);
        assert!(worn.is_empty() && worn.depth(2.0) == 0.0);
    }
}
