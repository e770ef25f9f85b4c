//! The height of a rail, sampled over time: a smooth curve, for straight pieces would ring a wheel at each sample.

/// Cubic spline through heights at ascending times, level at both ends and beyond. Two samples at one time are a step,
/// with a spline on either side.
pub struct Heights {
    times: Vec<f64>,
    heights: Vec<f64>,
    /// Rates at the samples [m/s].
    rates: Vec<f64>,
}

impl Heights {
    /// The spline through heights \[m] at times [s], as many of both.
    pub fn new(times: &[f64], heights: &[f64]) -> Self {
        let mut rates = Vec::with_capacity(times.len());
        let mut begin = 0;
        for piece in times.chunk_by(|a, b| a < b) {
            let end = begin + piece.len();
            rates.extend(slopes(piece, &heights[begin..end]));
            begin = end;
        }
        Self { times: times.to_vec(), heights: heights.to_vec(), rates }
    }

    /// Height \[m] and rate [m/s] at a time [s], on the piece that ends with the sample `end`.
    pub fn at(&self, time: f64, end: usize) -> [f64; 2] {
        let Self { times, heights, rates } = self;
        if end == 0 || end >= times.len() {
            return [heights[end.max(1) - 1], 0.0];
        }
        let (k, width) = (end - 1, times[end] - times[end - 1]);
        if width <= 0.0 {
            return [heights[end], 0.0];
        }
        let t = ((time - times[k]) / width).clamp(0.0, 1.0);
        let (mean, first, last) = ((heights[end] - heights[k]) / width, rates[k], rates[end]);
        let bent = bend([mean, first, last], t);
        let height = if t == 1.0 { heights[end] } else { heights[k] + width * (t * mean + bent) };
        [height, first + t * (2.0 * (3.0 * mean - 2.0 * first - last) + 3.0 * t * (first + last - 2.0 * mean))]
    }
}

/// Distance of a cubic from the straight line through its ends, over its length, at a share `t` of it, by its mean rate and
/// those at both ends.
pub fn bend([mean, first, last]: [f64; 3], t: f64) -> f64 {
    t * (1.0 - t) * ((1.0 - t) * (first - mean) - t * (last - mean))
}

/// Derivatives at the samples: 0 at both ends, and such that the curvature is continuous between them.
fn slopes(x: &[f64], y: &[f64]) -> Vec<f64> {
    let mut slopes = vec![0.0; x.len()];
    if x.len() < 3 {
        return slopes;
    }
    let inner = x.len() - 2;
    let inverse: Vec<f64> = x.windows(2).map(|x| 1.0 / (x[1] - x[0])).collect();
    let bent = |k: usize| (y[k + 1] - y[k]) * inverse[k] * inverse[k];
    let mut middle: Vec<f64> = (0..inner).map(|k| 2.0 * (inverse[k] + inverse[k + 1])).collect();
    let mut right: Vec<f64> = (0..inner).map(|k| 3.0 * (bent(k) + bent(k + 1))).collect();
    // Elimination of the tridiagonal, symmetric and dominant equations.
    for k in 1..inner {
        let factor = inverse[k] / middle[k - 1];
        middle[k] -= factor * inverse[k];
        right[k] -= factor * right[k - 1];
    }
    for k in (0..inner).rev() {
        slopes[k + 1] = (right[k] - inverse[k + 1] * slopes[k + 2]) / middle[k];
    }
    slopes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_curve_through_samples_of_a_wave_is_the_wave_with_order_four_and_its_rate_with_order_three() {
        let f = |t: f64| (1.0 - t.cos(), t.sin());
        let errors = [20u32, 40].map(|n| {
            let h = 4.0 * std::f64::consts::PI / f64::from(n);
            let times: Vec<f64> = (0..=n).map(|k| h * f64::from(k)).collect();
            let curve = Heights::new(&times, &times.iter().map(|&t| f(t).0).collect::<Vec<_>>());
            let mut worst = [0.0f64; 2];
            for k in 0..(10 * n) {
                let time = 0.1 * h * (f64::from(k) + 0.5);
                let [height, rate] = curve.at(time, times.partition_point(|&t| t <= time));
                worst = [worst[0].max((height - f(time).0).abs()), worst[1].max((rate - f(time).1).abs())];
            }
            worst
        });
        println!("{errors:?}");
        assert!((errors[0][0] / errors[1][0]).log2() > 3.7 && (errors[0][1] / errors[1][1]).log2() > 2.7);
    }

    #[test]
    fn two_heights_at_one_time_are_a_step_between_level_ends() {
        let curve = Heights::new(&[0.0, 1.0, 1.0, 2.0], &[0.0, 1.0, 3.0, 3.0]);
        assert_eq!([curve.at(1.0, 1), curve.at(1.0, 3)], [[1.0, 0.0], [3.0, 0.0]]);
        assert_eq!([curve.at(1.5, 3), curve.at(9.0, 4), curve.at(-1.0, 0)], [[3.0, 0.0], [3.0, 0.0], [0.0, 0.0]]);
        assert_eq!(Heights::new(&[1.0], &[2.0]).at(1.0, 1), [2.0, 0.0]);
    }
}
