//! Piecewise linear functions of one variable: profiles over a surface, inputs over time, nodal values of a mesh.
//!
//! Free functions work on slices of ascending positions and of values there, as a mesh has them. [`Piecewise`] owns
//! both; it is zero outside its ends, and a repeated position is a jump.

use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// Piecewise linear function of x, zero outside its first and last point; a repeated x is a jump.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Piecewise {
    /// Ascending positions.
    pub x: Vec<f64>,
    /// Values at the positions.
    pub value: Vec<f64>,
}

/// A stretch of the axis on which a function lives, such as a contact patch.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Interval {
    /// End at the smaller x.
    pub low: f64,
    /// End at the larger x.
    pub high: f64,
}

impl Interval {
    /// Place in the middle.
    pub fn middle(self) -> f64 {
        0.5 * (self.low + self.high)
    }

    /// Half of the length.
    pub fn half_length(self) -> f64 {
        0.5 * (self.high - self.low)
    }
}

/// Positions and values that make no piecewise linear function.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum PiecewiseError {
    /// Every position needs one value.
    #[error("{positions} positions but {values} values")]
    Length {
        /// Number of positions.
        positions: usize,
        /// Number of values.
        values: usize,
    },
    /// A position or value that is infinite or no number.
    #[error("{value} is no finite number")]
    NotFinite {
        /// The offending number.
        value: f64,
    },
    /// Positions that do not ascend.
    #[error("positions must ascend, {after} follows {before}")]
    Order {
        /// The position that comes first.
        before: f64,
        /// The smaller one after it.
        after: f64,
    },
}

/// One linear piece: both positions and both values.
pub type Segment = ([f64; 2], [f64; 2]);

/// Function without any points.
pub static EMPTY: Piecewise = Piecewise::EMPTY;

impl Piecewise {
    /// Without any points.
    pub const EMPTY: Self = Self { x: Vec::new(), value: Vec::new() };

    /// Removes all points and keeps the memory.
    pub fn clear(&mut self) {
        self.x.clear();
        self.value.clear();
    }

    /// Appends a point.
    pub fn push(&mut self, x: f64, value: f64) {
        self.x.push(x);
        self.value.push(value);
    }

    /// True if there are no points: the function is zero everywhere.
    pub fn is_empty(&self) -> bool {
        self.x.is_empty()
    }

    /// Samples of a function at `count` points between `low` and `high`, denser towards both ends (cosine spacing).
    pub fn sampled(low: f64, high: f64, count: usize, f: impl Fn(f64) -> f64) -> Self {
        let mut function = Self::default();
        function.take_samples(low, high, count, f);
        function
    }

    /// Becomes the samples of a function, see [`Self::sampled`], and keeps its memory.
    pub fn take_samples(&mut self, low: f64, high: f64, count: usize, f: impl Fn(f64) -> f64) {
        self.clear();
        let last = count.max(2) - 1;
        for i in 0..=last {
            let c = libm::cos(PI * i as f64 / last as f64);
            let x = 0.5 * (low * (1.0 + c) + high * (1.0 - c));
            self.push(x, f(x));
        }
    }

    /// The linear pieces in ascending order; a jump is one of zero length.
    pub fn segments(&self) -> impl Iterator<Item = Segment> + '_ {
        segments(&self.x, &self.value)
    }

    /// `∫ f dx` over everything.
    pub fn integral(&self) -> f64 {
        self.segments().map(|(x, v)| 0.5 * (x[1] - x[0]) * (v[0] + v[1])).sum()
    }

    /// Mean over an interval, see [`mean`].
    pub fn mean(&self, low: f64, high: f64) -> f64 {
        mean(&self.x, &self.value, low, high)
    }

    /// Value at a position: zero outside the ends, at a jump the value after it.
    pub fn at(&self, x: f64) -> f64 {
        match (self.x.first(), self.x.last()) {
            (Some(&first), Some(&last)) if x >= first && x <= last => interpolate(&self.x, &self.value, x),
            _ => 0.0,
        }
    }

    /// Value at ascending positions, one after the other, see [`Self::at`].
    pub fn ascending(&self) -> impl FnMut(f64) -> f64 + '_ {
        let inside = self.x.first().zip(self.x.last()).map(|(first, last)| *first..=*last);
        let mut value = ascending(&self.x, &self.value);
        move |x| if inside.as_ref().is_some_and(|inside| inside.contains(&x)) { value(x) } else { 0.0 }
    }

    /// Replaces `out` by the values at ascending positions, see [`Self::at`].
    pub fn sample(&self, at: &[f64], out: &mut Vec<f64>) {
        let ends = self.x.first().zip(self.x.last());
        let inside = ends.map_or(0..0, |(&first, &last)| {
            let from = at.partition_point(|&x| x < first);
            from..at.partition_point(|&x| x <= last).max(from)
        });
        let mut value = ascending(&self.x, &self.value);
        out.clear();
        out.resize(inside.start, 0.0);
        out.extend(at[inside].iter().map(|&at| value(at)));
        out.resize(at.len(), 0.0);
    }

    /// Multiplies all values by a factor.
    pub fn scale(&mut self, factor: f64) {
        self.value.iter_mut().for_each(|v| *v *= factor);
    }

    /// Scales it to the given integral; where it is zero itself, or too small to be scaled, it takes the shape of the
    /// `fallback`.
    pub fn scale_to(&mut self, integral: f64, fallback: &Self) {
        let factor = integral / self.integral();
        if factor.is_finite() {
            return self.scale(factor);
        }
        self.x.iter().zip(&mut self.value).for_each(|(&x, value)| *value = fallback.at(x));
        let own = self.integral();
        self.scale(if own > 0.0 { integral / own } else { 0.0 });
    }

    /// This function times a factor.
    pub fn scaled(mut self, factor: f64) -> Self {
        self.scale(factor);
        self
    }

    /// Refuses what is no function: lengths that differ, positions that descend, anything that is not finite.
    pub fn check(&self) -> Result<(), PiecewiseError> {
        if self.x.len() != self.value.len() {
            return Err(PiecewiseError::Length { positions: self.x.len(), values: self.value.len() });
        }
        if let Some(&value) = self.x.iter().chain(&self.value).find(|v| !v.is_finite()) {
            return Err(PiecewiseError::NotFinite { value });
        }
        match self.x.windows(2).find(|w| w[1] < w[0]) {
            Some(w) => Err(PiecewiseError::Order { before: w[0], after: w[1] }),
            None => Ok(()),
        }
    }
}

/// The linear pieces between nodes with values.
pub fn segments<'a>(x: &'a [f64], values: &'a [f64]) -> impl Iterator<Item = Segment> + 'a {
    x.windows(2).zip(values.windows(2)).map(|(x, v)| ([x[0], x[1]], [v[0], v[1]]))
}

/// Value at a position between nodes with values, constant outside the ends; at a jump the value after it.
///
/// Zero without nodes.
pub fn interpolate(x: &[f64], values: &[f64], at: f64) -> f64 {
    between(x, values, at, x.partition_point(|&node| node <= at))
}

/// Value at a position on the piece that ends at node `next`; before the first node its value, after the last its.
///
/// Lets a caller decide on which side of a jump, or within which rounding, a position lies. Zero without nodes.
fn between(x: &[f64], values: &[f64], at: f64, next: usize) -> f64 {
    let last = x.len().min(values.len());
    if next == 0 || next >= last {
        return if last == 0 { 0.0 } else { values[next.clamp(1, last) - 1] };
    }
    let (from, to) = (x[next - 1], x[next]);
    let share = ((at - from) / (to - from)).clamp(0.0, 1.0);
    if share == 1.0 { values[next] } else { values[next - 1] + share * (values[next] - values[next - 1]) }
}

/// Numbers and weights of the values at ascending nodes in that of the piecewise cubic function that has at every node the slope of
/// the chord between its neighbours, and at the ends that of the chord there: without kinks, and beyond the values beside by no more
/// than .15 of the differences of their neighbours, however uneven the distances are. One node has its value everywhere.
pub fn cubic(x: &[f64], at: f64) -> Vec<(usize, f64)> {
    let Some(last) = x.len().checked_sub(2) else { return (0..x.len()).map(|node| (node, 1.0)).collect() };
    let k = x.partition_point(|node| *node <= at).saturating_sub(1).min(last);
    let length = x[k + 1] - x[k];
    let t = ((at - x[k]) / length).clamp(0.0, 1.0);
    let rise = t * t * (3.0 - 2.0 * t);
    let first = k.saturating_sub(1);
    let mut weights: Vec<_> = (first..(k + 3).min(x.len())).map(|node| (node, 0.0)).collect();
    let mut add = |node: usize, weight: f64| weights[node - first].1 += weight;
    add(k, 1.0 - rise);
    add(k + 1, rise);
    for (node, of_slope) in [(k, length * t * (1.0 - t) * (1.0 - t)), (k + 1, -length * t * t * (1.0 - t))] {
        let [before, after] = [node.saturating_sub(1), (node + 1).min(x.len() - 1)];
        let by = of_slope / (x[after] - x[before]);
        add(before, -by);
        add(after, by);
    }
    weights
}

/// Replaces `out` by the values at the ascending positions `at`, see [`interpolate`].
pub fn resample(x: &[f64], values: &[f64], at: &[f64], out: &mut Vec<f64>) {
    let mut value = ascending(x, values);
    out.clear();
    out.extend(at.iter().map(|&at| value(at)));
}

/// Value at ascending positions, one after the other, see [`interpolate`]: each costs the nodes since the one before.
pub fn ascending<'a>(x: &'a [f64], values: &'a [f64]) -> impl FnMut(f64) -> f64 + 'a {
    let mut next = 0;
    move |at| {
        next += x[next..].iter().take_while(|&&node| node <= at).count();
        between(x, values, at, next)
    }
}

/// Mean over an interval of the function that is linear between nodes and zero outside; zero for an empty interval.
pub fn mean(x: &[f64], values: &[f64], low: f64, high: f64) -> f64 {
    let mut integral = 0.0;
    for (ends, v) in segments(x, values) {
        let (a, b) = (low.max(ends[0]), high.min(ends[1]));
        if b > a {
            let at = |x: f64| v[0] + (x - ends[0]) / (ends[1] - ends[0]) * (v[1] - v[0]);
            integral += 0.5 * (b - a) * (at(a) + at(b));
        }
    }
    if high > low { integral / (high - low) } else { 0.0 }
}

/// Replaces `values` by their means over `reach` to both sides, of the function that is constant beyond its ends.
pub fn smear(x: &[f64], values: &mut [f64], reach: f64) {
    let (Some(&first), Some(&last)) = (x.first(), x.last()) else { return };
    let mut below = vec![0.0];
    for (ends, v) in segments(x, values) {
        below.push(below[below.len() - 1] + 0.5 * (ends[1] - ends[0]) * (v[0] + v[1]));
    }
    // Both ends of the stretch ascend with its middle: `next` is the first node beyond.
    let integral = |at: f64, next: &mut usize| {
        let inside = at.clamp(first, last);
        *next += x[*next..].iter().take_while(|&&node| node <= inside).count();
        let node = (*next).max(1) - 1;
        let value = between(x, values, inside, *next);
        below[node] + (inside - x[node]) * (0.5 * (values[node] + value)) + (at - inside) * value
    };
    let [mut low, mut high] = [0; 2];
    let mean = |&x: &f64| (integral(x + reach, &mut high) - integral(x - reach, &mut low)) / (2.0 * reach);
    let means: Vec<f64> = x.iter().map(mean).collect();
    values.copy_from_slice(&means);
}

/// Mean of the function through `values` at `x`, constant outside the ends, weighted with `weight`: the integrals of both and
/// of their product are exact, so that it has no kinks where nodes of the one pass those of the other. Zero without weight.
pub fn weighted_mean(weight: &Piecewise, x: &[f64], values: &[f64]) -> f64 {
    if values.is_empty() {
        return 0.0;
    }
    let (mut sum, mut total, mut next) = (0.0, 0.0, 0);
    for ([from, to], [w, w_end]) in weight.segments().filter(|(ends, _)| ends[1] > ends[0]) {
        total += 0.5 * (to - from) * (w + w_end);
        let slope = (w_end - w) / (to - from);
        next += x[next..].iter().take_while(|&&node| node <= from).count();
        let mut begin = [from, w, between(x, values, from, next)];
        while begin[0] < to {
            let at = x.get(next).map_or(to, |node| node.min(to));
            let end = [at, w + slope * (at - from), between(x, values, at, next)];
            let ([a, wa, va], [b, wb, vb]) = (begin, end);
            sum += (b - a) / 6.0 * (wa * (2.0 * va + vb) + wb * (va + 2.0 * vb));
            begin = end;
            next += usize::from(x.get(next).is_some_and(|node| *node <= at));
        }
    }
    if total != 0.0 { sum / total } else { 0.0 }
}

/// Share that rises from 0 to 1 with `t` from 0 to 1, without a kink, and is constant beyond.
pub fn smooth_step(t: f64) -> f64 {
    let t = t.clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// Maximum of a piecewise parabola through the values, whose curvature in a cell is the smaller one of those at both
/// its nodes and zero where these differ in sign: beside a jump it stays between the values, and it is continuous in
/// them, wherever the maximum moves. Nodes are distinct; `−∞` without any.
///
/// Uniformly non-oscillatory interpolation: A. Harten, S. Osher, *SIAM J. Numer. Anal.* 24 (1987) 279–309.
pub fn peak(x: &[f64], values: &[f64]) -> f64 {
    let n = x.len().min(values.len());
    let mut top = values[..n].iter().fold(f64::NEG_INFINITY, |top, v| top.max(*v));
    let chord = |i: usize| (values[i + 1] - values[i]) / (x[i + 1] - x[i]);
    let curvature = |i: usize| 2.0 * (chord(i) - chord(i - 1)) / (x[i + 1] - x[i - 1]);
    // The outermost cells have no curvature at one end and no maximum inside.
    for i in 1..n.saturating_sub(2) {
        // In a cell without a maximum at an end or beside it there is none.
        let (left, right) = (chord(i - 1), chord(i + 1));
        if left <= 0.0 || right >= 0.0 {
            continue;
        }
        let bend = curvature(i).max(curvature(i + 1)) * (x[i + 1] - x[i]).powi(2);
        let rise = values[i + 1] - values[i];
        if bend < -2.0 * rise.abs() {
            // v(ξ) = v₀ + rise ξ − ½ bend ξ (1 − ξ), largest at ξ = ½ − rise/bend.
            top = top.max(values[i] + 0.5 * rise - 0.125 * bend - 0.5 * rise * rise / bend);
        }
    }
    top
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A ramp to 2 at x = 1, a jump down to −1, level until x = 3.
    fn ramp_and_jump() -> Piecewise {
        Piecewise { x: vec![0.0, 1.0, 1.0, 3.0], value: vec![0.0, 2.0, -1.0, -1.0] }
    }

    #[test]
    fn a_cubic_function_through_uneven_nodes_is_linear_where_they_are_has_no_kinks_and_stays_beside_its_values() {
        let x = [0.0, 0.1, 3.0, 3.02, 4.0];
        let value = |of: &dyn Fn(usize) -> f64, at: f64| cubic(&x, at).iter().map(|(k, by)| by * of(*k)).sum::<f64>();
        let jumps = |k: usize| if k.is_multiple_of(2) { 1.0 } else { -1.0 };
        for i in 0..=400 {
            let at = 0.01 * f64::from(i);
            assert!((value(&|k| 2.0 - 3.0 * x[k], at) - (2.0 - 3.0 * at)).abs() < 1e-12);
            assert!(value(&jumps, at).abs() < 1.3);
        }
        for (node, place) in x.iter().enumerate().take(4).skip(1) {
            let (now, h) = (value(&jumps, *place), 1e-7);
            assert_eq!(now, jumps(node));
            let slopes = [now - value(&jumps, place - h), value(&jumps, place + h) - now].map(|rise| rise / h);
            assert!((slopes[0] - slopes[1]).abs() < 1e-2, "{slopes:?}");
        }
        assert_eq!(cubic(&[5.0], 7.0), [(0, 1.0)]);
    }

    #[test]
    fn samples_are_the_values_at_each_place() {
        let (f, at) = (ramp_and_jump(), [-1.0, 0.0, 0.5, 1.0, 2.0, 3.0, 4.0]);
        let mut out = vec![7.0; 2];
        for part in [&at[..], &at[3..], &at[..1], &at[6..]] {
            f.sample(part, &mut out);
            assert_eq!(out, part.iter().map(|&x| f.at(x)).collect::<Vec<_>>());
        }
        Piecewise::EMPTY.sample(&at, &mut out);
        assert_eq!(out, [0.0; 7]);
    }

    #[test]
    fn integral_and_mean_count_every_piece_and_nothing_outside() {
        let f = ramp_and_jump();
        assert_eq!(f.integral(), 1.0 - 2.0);
        assert_eq!(f.mean(0.0, 1.0), 1.0);
        assert_eq!(f.mean(0.5, 2.0), (0.75 - 1.0) / 1.5);
        assert_eq!(f.mean(-1.0, 1.0), 0.5);
        assert_eq!(f.mean(5.0, 6.0), 0.0);
        assert_eq!((f.mean(1.0, 1.0), f.mean(2.0, 1.0)), (0.0, 0.0));
        assert_eq!((Piecewise::default().integral(), Piecewise::default().mean(0.0, 1.0)), (0.0, 0.0));
    }

    #[test]
    fn values_are_linear_inside_zero_outside_and_those_after_a_jump() {
        let f = ramp_and_jump();
        let found: Vec<f64> = [-0.1, 0.0, 0.25, 1.0, 2.0, 3.0, 3.1].iter().map(|&x| f.at(x)).collect();
        assert_eq!(found, [0.0, 0.0, 0.5, -1.0, -1.0, -1.0, 0.0]);
        assert_eq!(Piecewise::default().at(0.0), 0.0);
    }

    #[test]
    fn nodal_values_are_constant_outside_and_the_caller_chooses_the_side_of_a_jump() {
        let Piecewise { x, value } = ramp_and_jump();
        assert_eq!([-1.0, 0.5, 9.0].map(|at| interpolate(&x, &value, at)), [0.0, 1.0, -1.0]);
        assert_eq!((between(&x, &value, 1.0, 1), between(&x, &value, 1.0, 3)), (2.0, -1.0));
        assert_eq!((between(&x, &value, 7.0, 0), between(&x, &value, 7.0, 4)), (0.0, -1.0));
        assert_eq!((interpolate(&[], &[], 1.0), interpolate(&[2.0], &[5.0], 1.0)), (0.0, 5.0));
        let mut out = vec![9.0; 7];
        resample(&x, &value, &[0.25, 2.0], &mut out);
        assert_eq!(out, [0.5, -1.0]);
    }

    #[test]
    fn a_smeared_step_is_a_ramp_and_a_smeared_ramp_stays() {
        let x: Vec<f64> = (0..41).map(|i| 0.1 * f64::from(i)).collect();
        let mut step: Vec<f64> = x.iter().map(|&x| if x < 1.95 { 1.0 } else { 3.0 }).collect();
        smear(&x, &mut step, 0.5);
        for (&x, value) in x.iter().zip(&step).filter(|(x, _)| (**x - 1.95).abs() > 0.6 || (**x - 1.95).abs() < 0.4) {
            assert!((value - (2.0 + 2.0 * (x - 1.95)).clamp(1.0, 3.0)).abs() < 1e-12, "{x}: {value}");
        }
        let mut ramp = x.clone();
        smear(&x, &mut ramp, 0.3);
        assert!(x.iter().zip(&ramp).filter(|(x, _)| (0.3..=3.7).contains(*x)).all(|(x, v)| (x - v).abs() < 1e-12));
        assert!((ramp[0] - 0.5 * 0.3 * 0.5).abs() < 1e-12, "{}", ramp[0]);
        smear(&[], &mut [], 1.0);
    }

    #[test]
    fn scaling_is_linear_and_segments_ascend() {
        let f = ramp_and_jump().scaled(-3.0);
        assert_eq!(f.integral(), 3.0);
        let pieces: Vec<Segment> = f.segments().collect();
        assert_eq!(pieces[1], ([1.0, 1.0], [-6.0, 3.0]));
        assert_eq!(pieces.len(), 3);
    }

    #[test]
    fn cosine_samples_meet_both_ends_and_are_densest_there() {
        let f = Piecewise::sampled(-1.0, 1.0, 201, |x| (1.0 - x * x).max(0.0).sqrt());
        assert_eq!((f.x[0], f.x[200], f.x.len()), (-1.0, 1.0, 201));
        assert!(f.x[1] - f.x[0] < 0.02 * (f.x[101] - f.x[100]));
        assert!((f.integral() / (0.5 * PI) - 1.0).abs() < 1e-4, "{}", f.integral());
    }

    /// Closed forms of a line, of a function that bends within a piece of the weight and is constant beyond its ends, and of a
    /// weight that jumps.
    #[test]
    fn weighted_means_are_exact_and_have_no_kink_where_nodes_pass_each_other() {
        let hat = Piecewise { x: vec![-1.0, 0.0, 1.0], value: vec![0.0, 1.0, 0.0] };
        assert!((weighted_mean(&hat, &[-5.0, 5.0], &[-3.0, 7.0]) - 2.0).abs() < 1e-14);
        let edge = |at: f64| weighted_mean(&hat, &[at, at + 1.0], &[0.0, 1.0]);
        // Beyond 0 the hat has the weight ½ and the mean x of ⅓.
        assert!((edge(0.0) - 1.0 / 6.0).abs() < 1e-15);
        assert!((weighted_mean(&hat, &[0.25], &[4.0]) - 4.0).abs() < 1e-15);
        let slope = |from: f64, to: f64| (edge(to) - edge(from)) / (to - from);
        assert!((slope(-1e-5, 0.0) - slope(0.0, 1e-5)).abs() < 1e-4);
        let jump = Piecewise { x: vec![0.0, 1.0, 1.0, 2.0], value: vec![1.0, 1.0, 3.0, 3.0] };
        assert!((weighted_mean(&jump, &[0.0, 2.0], &[0.0, 2.0]) - 1.25).abs() < 1e-15);
        assert_eq!(weighted_mean(&hat, &[], &[]), 0.0);
    }

    #[test]
    fn what_is_no_function_is_refused_with_its_numbers() {
        assert_eq!(ramp_and_jump().check(), Ok(()));
        let with = |x: &[f64], value: &[f64]| Piecewise { x: x.to_vec(), value: value.to_vec() }.check();
        assert_eq!(with(&[0.0, 1.0], &[1.0]), Err(PiecewiseError::Length { positions: 2, values: 1 }));
        assert_eq!(with(&[0.0, -1.0], &[1.0, 1.0]), Err(PiecewiseError::Order { before: 0.0, after: -1.0 }));
        assert!(matches!(with(&[0.0, 1.0], &[1.0, f64::NAN]), Err(PiecewiseError::NotFinite { .. })));
        assert!(matches!(with(&[0.0, f64::INFINITY], &[1.0, 1.0]), Err(PiecewiseError::NotFinite { .. })));
    }

    #[test]
    fn memory_is_kept_when_points_are_replaced() {
        let mut f = ramp_and_jump();
        let capacity = f.x.capacity();
        f.clear();
        assert!(f.is_empty());
        f.push(1.0, 2.0);
        assert_eq!((f.x.capacity(), f.at(1.0)), (capacity, 2.0));
    }

    #[test]
    fn peak_of_a_sampled_parabola_is_its_vertex_between_the_nodes() {
        let x: Vec<f64> = (0..9).map(|i| f64::from(i) * 0.25 + 0.01 * f64::from(i % 3)).collect();
        for vertex in [0.6, 0.9, 1.234] {
            let values: Vec<f64> = x.iter().map(|x| 3.0 - (x - vertex) * (x - vertex)).collect();
            assert!((peak(&x, &values) - 3.0).abs() < 1e-14);
        }
        // A maximum at the end is the value there.
        assert_eq!(peak(&[0.0, 1.0, 2.0], &[5.0, 1.0, 0.0]), 5.0);
        assert_eq!(peak(&[], &[]), f64::NEG_INFINITY);
    }

    #[test]
    fn a_kink_beside_a_maximum_does_not_raise_it_and_a_parabola_keeps_its_own() {
        // The leading edge of a molten contact [mm], [K]: the cubic alone reaches 1855 K.
        let (x, hot) = ([2.9, 3.32, 3.73, 4.15, 4.56], [1785.6, 1726.7, 1792.8, 1731.0, 367.3]);
        let found = peak(&x, &hot);
        assert!((1792.8..1800.0).contains(&found), "{found}");
        let parabola: Vec<f64> = x.iter().map(|x| 5.0 - (x - 3.6) * (x - 3.6)).collect();
        assert!((peak(&x, &parabola) - 5.0).abs() < 1e-12);
    }
}
