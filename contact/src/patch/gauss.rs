//! Ordinates of the contact lines across the patch: Gauss–Legendre.

use std::f64::consts::PI;

/// Newton steps for a node at most; it needs three to five.
const MOST_STEPS: usize = 20;

/// A contact line across the patch, or any other node of a Gauss–Legendre rule on \[−1, 1].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GaussLine {
    /// Ordinate `η = z/b` \[1].
    pub ordinate: f64,
    /// Weight `ω` \[1]: the line is `b ω` wide.
    pub weight: f64,
}

/// Rule of `lines` nodes on \[−1, 1] in rising order, exact for polynomials of degree `2 lines − 1`; the weights add up
/// to 2. Nodes to round-off; empty without lines.
pub fn rule(lines: usize) -> Vec<GaussLine> {
    let half = half(lines);
    let middle = lines % 2;
    let one = |line: &GaussLine| GaussLine { weight: 0.5 * line.weight, ..*line };
    let mirrored = half.iter().skip(middle).rev().map(|line| GaussLine { ordinate: -line.ordinate, ..one(line) });
    let upper = half.iter().skip(middle).map(one);
    mirrored.chain(half.iter().take(middle).copied()).chain(upper).collect()
}

/// Nodes of [`rule`] with `η ≥ 0` in rising order, for what is symmetric: with twice the weight, but the middle one of
/// an odd number, which is its own mirror image.
pub fn half(lines: usize) -> Vec<GaussLine> {
    let upper = (0..lines / 2).rev().map(|i| {
        let GaussLine { ordinate, weight } = node(lines, i);
        GaussLine { ordinate, weight: 2.0 * weight }
    });
    let middle = (lines % 2 == 1).then(|| {
        let (_, slope) = legendre(lines, 0.0);
        GaussLine { ordinate: 0.0, weight: 2.0 / (slope * slope) }
    });
    middle.into_iter().chain(upper).collect()
}

/// Node `i` from above by Newton's method (Abramowitz & Stegun, 25.4.29), from Tricomi's start.
fn node(lines: usize, i: usize) -> GaussLine {
    let mut x = libm::cos(PI * (i as f64 + 0.75) / (lines as f64 + 0.5));
    for _ in 0..MOST_STEPS {
        let (value, slope) = legendre(lines, x);
        let step = value / slope;
        x -= step;
        if step.abs() <= f64::EPSILON {
            break;
        }
    }
    let (_, slope) = legendre(lines, x);
    GaussLine { ordinate: x, weight: 2.0 / ((1.0 - x) * (1.0 + x) * slope * slope) }
}

/// Legendre polynomial of degree `n ≥ 1` and its slope, by the recurrence.
fn legendre(n: usize, x: f64) -> (f64, f64) {
    let (mut before, mut value) = (1.0, x);
    for k in 2..=n {
        let k = k as f64;
        (before, value) = (value, ((2.0 * k - 1.0) * x * value - (k - 1.0) * before) / k);
    }
    (value, n as f64 * (before - x * value) / ((1.0 - x) * (1.0 + x)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Abramowitz & Stegun, table 25.4.
    #[test]
    fn nodes_and_weights_are_the_tabulated_ones() {
        let five = [
            (0.0, 0.568_888_888_888_888_9),
            (0.538_469_310_105_683_1, 2.0 * 0.478_628_670_499_366_5),
            (0.906_179_845_938_664, 2.0 * 0.236_926_885_056_189_1),
        ];
        for (line, (ordinate, weight)) in half(5).iter().zip(five) {
            assert!((line.ordinate - ordinate).abs() < 2e-16 && (line.weight / weight - 1.0).abs() < 1e-15, "{line:?}");
        }
        let last = rule(12)[11];
        assert!((last.ordinate - 0.981_560_634_246_719).abs() < 3e-16, "{last:?}");
        assert!((last.weight - 0.047_175_336_386_512).abs() < 1e-15, "{last:?}");
        assert_eq!(half(1), [GaussLine { ordinate: 0.0, weight: 2.0 }]);
        assert!(rule(0).is_empty());
    }

    #[test]
    fn polynomials_are_integrated_exactly_by_all_lines_and_by_half_of_them() {
        for lines in 1..=15 {
            let (all, half) = (rule(lines), half(lines));
            assert_eq!((all.len(), half.len()), (lines, lines.div_ceil(2)));
            assert!(all.is_sorted_by(|a, b| a.ordinate < b.ordinate) && half.iter().all(|line| line.ordinate >= 0.0));
            let sum = |rule: &[GaussLine], power| -> f64 {
                rule.iter().map(|line| line.weight * line.ordinate.powi(power)).sum()
            };
            for power in 0..2 * lines as i32 {
                let exact = if power % 2 == 0 { 2.0 / f64::from(power + 1) } else { 0.0 };
                assert!((sum(&all, power) - exact).abs() < 2e-15, "{lines} {power}");
                if power % 2 == 0 {
                    assert!((sum(&half, power) - exact).abs() < 2e-15, "{lines} {power}");
                }
            }
        }
    }

    /// Line loads `P ∝ 1 − η²` of Hertz's ellipse.
    #[test]
    fn two_lines_carry_the_load_of_the_ellipse_exactly() {
        for lines in 2..=15 {
            let load: f64 = rule(lines).iter().map(|line| line.weight * (1.0 - line.ordinate.powi(2))).sum();
            assert!((load - 4.0 / 3.0).abs() < 2e-15);
        }
    }
}
