//! Mean over the patch of heights along the rail, as the normal force feels them.

use crate::patch::gauss::GaussLine;

/// Product of wave number and half-length below which the closed form loses digits and its series is used.
const SMALL: f64 = 1.0;
/// Terms of this series: enough for [`SMALL`].
const TERMS: i32 = 10;

/// Mean of a height over the ellipse, weighted with Hertz's pressure, `3/(4a) ∫ (1 − x²/a²) h(x) dx`, for heights that
/// do not depend on the lateral ordinate.
///
/// `half_length` is `a` \[m], `points` a whole rule ([`crate::patch::gauss::rule`]), `height` the height at
/// `x` from the middle of the patch \[m]. Exact for polynomials of degree `2 points − 3`; a constant stays what it is.
pub fn patch_mean(half_length: f64, points: &[GaussLine], height: impl Fn(f64) -> f64) -> f64 {
    let load = |point: &GaussLine| point.weight * (1.0 - point.ordinate) * (1.0 + point.ordinate);
    let sum: f64 = points.iter().map(|point| load(point) * height(half_length * point.ordinate)).sum();
    sum / points.iter().map(load).sum::<f64>()
}

/// Mean of a cosine wave over the ellipse in closed form, `3 (sin q − q cos q)/q³` with `q = ka` \[1]: wave number
/// times half-length; positive up to `q` = 4.49, where the patch is 1.43 waves long, with both signs beyond.
pub fn cosine_mean(q: f64) -> f64 {
    if q.abs() >= SMALL {
        return 3.0 * (q.sin() - q * q.cos()) / (q * q * q);
    }
    let mut term = 1.0;
    let mut sum = 1.0;
    for n in 1..=TERMS {
        term *= -q * q / f64::from(2 * n * (2 * n + 3));
        sum += term;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::patch::gauss;
    use std::f64::consts::PI;

    #[test]
    fn the_closed_form_and_its_series_meet() {
        assert_eq!(cosine_mean(0.0), 1.0);
        for q in [0.3_f64, 0.7, 0.999_999] {
            let closed = 3.0 * (q.sin() - q * q.cos()) / q.powi(3);
            assert!((cosine_mean(q) - closed).abs() < 1e-15 / (q * q), "{q}");
            assert_eq!(cosine_mean(q), cosine_mean(-q));
        }
        // First zero of tan q = q.
        assert!(cosine_mean(4.493_409_457_909_064).abs() < 1e-15);
    }

    /// Errors measured over the amplitude: 4.9e-8 (`q` = 1) and 3.9e-4 (a wave as long as the patch, `q` = π) for 5
    /// points, 3.1e-11 for 9 (`q` = π), 3.0e-11 for 15 (`q` = 10).
    #[test]
    fn a_few_points_average_waves_longer_than_the_patch() {
        for (points, q, tolerance) in [(5, 1.0, 6e-8), (5, PI, 5e-4), (9, PI, 4e-11), (15, 10.0, 4e-11)] {
            let a = 6e-3;
            let mean = patch_mean(a, &gauss::rule(points), |x| 3e-5 * (q / a * x + 0.4).cos());
            let exact = 3e-5 * 0.4_f64.cos() * cosine_mean(q);
            assert!((mean - exact).abs() < tolerance * 3e-5, "{points} points, q = {q}: {mean:e} for {exact:e}");
        }
    }

    /// `3/(4a) ∫ (1 − x²/a²) x² dx = a²/5`.
    #[test]
    fn constants_stay_and_parabolas_are_exact() {
        assert!((patch_mean(2.0, &gauss::rule(3), |x| 1.0 + x + x * x) - 1.8).abs() < 1e-15);
        for points in 1..6 {
            assert!((patch_mean(2.0, &gauss::rule(points), |_| 7.0) - 7.0).abs() < 4e-15);
        }
    }
}
