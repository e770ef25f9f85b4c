//! Distances at which the displacement of contact lines by their own forces ends, from the stiffness of all together.
//!
//! A line of the half-length `a_k` and the weight `w_k` whose own displacement is a logarithm of the reach `L_k` has
//! the stiffness `w_k/ln(2L_k/a_k)`.

/// Relative step that ends the search for a common length: it converges quadratically, so the result is exact.
const CLOSE: f64 = 1e-10;
/// Steps of this search at most; it needs at most four.
const MOST_STEPS: usize = 100;
/// Halvings of the interval in which the ratio of lengths lies: to round-off.
const HALVINGS: usize = 60;

/// Length `L` \[m] with which contact lines of the half-lengths `a_k` \[m] and the weights `w_k` together are as stiff
/// as they have to be, `Σ w_k/ln(2L/a_k) = stiffness`. `lines` are weights and half-lengths of at least one line, the
/// stiffness is positive and has the unit of the weights.
pub fn common_length(stiffness: f64, lines: impl Iterator<Item = [f64; 2]>) -> f64 {
    let lines: Vec<_> = lines.collect();
    let longest = lines.iter().fold(0.0, |longest: f64, [_, half_length]| longest.max(*half_length));
    // `Σ w/(t + o) = 1/wanted` with `t = ln(2L/longest)`, `o = ln(longest/a_k) ≥ 0`.
    let wanted = 1.0 / stiffness;
    let offsets: Vec<_> =
        lines.iter().map(|[weight, half_length]| (weight, libm::log(longest / half_length))).collect();
    // The harmonic mean of `t + o` is concave: from above, Newton's method comes below the root and then rises to it.
    let mut t = wanted * lines.iter().map(|[weight, _]| weight).sum::<f64>();
    for _ in 0..MOST_STEPS {
        let sum: f64 = offsets.iter().map(|(weight, offset)| *weight / (t + offset)).sum();
        let slope: f64 = offsets.iter().map(|(weight, offset)| *weight / (t + offset).powi(2)).sum();
        let step = (wanted - 1.0 / sum) * sum * sum / slope;
        t = (t + step).max(0.5 * t);
        if step.abs() <= CLOSE * t {
            break;
        }
    }
    0.5 * longest * libm::exp(t)
}

/// Lengths `L_k` \[m] in proportion to the half-lengths of the lines, with which all are equally stiff, but none
/// shorter than `least` \[m], and together as stiff as in [`common_length`]. Where that asks for shorter ones, all have
/// the common length. `lines` are weights and half-lengths \[m].
pub fn proportional_lengths(stiffness: f64, lines: &[[f64; 2]], least: f64) -> Vec<f64> {
    let common = common_length(stiffness, lines.iter().copied());
    let least = least.min(common);
    let length = |ratio: f64, half_length: f64| (ratio * half_length).max(least);
    let stiff = |ratio: f64| -> f64 { lines.iter().map(|[w, a]| w / libm::log(2.0 * length(ratio, *a) / a)).sum() };
    // The ratio lies between a half, with which the longest line is rigid, and that of equally stiff lines.
    let weights: f64 = lines.iter().map(|[weight, _]| weight).sum();
    let (mut low, mut high) = (0.5, 0.5 * libm::exp(weights / stiffness));
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if stiff(middle) > stiffness { low = middle } else { high = middle }
    }
    lines.iter().map(|[_, half_length]| length(high, *half_length)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_have_the_stiffness_and_the_least_length_that_is_asked_for() {
        let lines = [[1.0, 3e-3], [2.0, 7e-3], [1.5, 1e-3]];
        let together = |lengths: &[f64]| -> f64 {
            lines.iter().zip(lengths).map(|([w, a], length)| w / (2.0 * length / a).ln()).sum()
        };
        let common = common_length(2.0, lines.into_iter());
        for least in [0.0, 5e-3, 0.5 * common, 0.99 * common, common, 10.0 * common] {
            let lengths = proportional_lengths(2.0, &lines, least);
            assert!((together(&lengths) - 2.0).abs() < 1e-8, "{lengths:?}");
            assert!(lengths.iter().all(|length| *length >= least.min(common)));
        }
        let [a, b, c] = proportional_lengths(2.0, &lines, 0.0).try_into().unwrap();
        assert!((a / 3e-3 - b / 7e-3).abs() < 1e-9 && (a / 3e-3 - c / 1e-3).abs() < 1e-9);
    }
}
