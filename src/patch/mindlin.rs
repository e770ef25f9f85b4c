//! Mindlin's stiffness of a sticking patch under a shear force, and contact lines that have it.

use crate::patch::{elliptic, gauss::GaussLine, k11::k11};
use std::f64::consts::PI;

/// Relative step that ends the search for the length: it converges quadratically, so the result is exact.
const CLOSE: f64 = 1e-10;
/// Steps of this search at most; it needs at most four.
const MOST_STEPS: usize = 100;

/// Compliance `1/K_x` [m/N] of a sticking ellipse with the half axes `a` and `b` \[m] under a force in `x`, of **both**
/// bodies together, equal half-spaces with the shear modulus \[Pa] and Poisson's ratio \[1].
///
/// `1/K_x = 1/(4πG) ∮ (1 − ν sin²φ)/√(b² cos²φ + a² sin²φ) dφ`; for a circle `(2 − ν)/(4Ga)`, twice Mindlin's
/// `(2 − ν)/(8Ga)` of one body (Mindlin 1949; Johnson, *Contact Mechanics* (1985), section 7.2).
pub fn rolling_compliance(a: f64, b: f64, shear_modulus: f64, poissons_ratio: f64) -> f64 {
    elliptic::complete((a / b).powi(2), 1.0, 1.0 - poissons_ratio) / (PI * shear_modulus * b)
}

/// Compliance `1/K_z` [m/N] of both bodies under a lateral force, as [`rolling_compliance`] with `cos²φ` instead of
/// `sin²φ` in the numerator.
pub fn lateral_compliance(a: f64, b: f64, shear_modulus: f64, poissons_ratio: f64) -> f64 {
    rolling_compliance(b, a, shear_modulus, poissons_ratio)
}

/// Length `L` over `c = √(ab)` \[1] in the shear kernel `2(1 − ν)/(πG k₁₁) ln(L/|x − s|)` of contact lines (relative
/// displacement of both bodies) for which lines that stick everywhere are as stiff as the ellipse `aspect = a/b`.
///
/// A line of half-length `a_k = a √(1 − η²)` bears `u/(2(1 − ν)/(πG k₁₁) ln(2L/a_k))` per width when it is shifted by
/// `u`, and is `b ω` wide. `lines` is a whole rule or the half of it ([`crate::patch::gauss`]), at least one
/// line; the result depends little on their number.
pub fn kernel_length(aspect: f64, poissons_ratio: f64, lines: &[GaussLine]) -> f64 {
    let shape = elliptic::complete(aspect * aspect, 1.0, 1.0 - poissons_ratio);
    // `Σ ω/(t + o) = 1/wanted` with `t = ln(2L/a)`, `o = ln(a/a_k) ≥ 0`.
    let wanted = k11(aspect) * shape / (2.0 * (1.0 - poissons_ratio));
    let offset = |line: &GaussLine| -0.5 * ((1.0 - line.ordinate) * (1.0 + line.ordinate)).ln();
    let offsets: Vec<_> = lines.iter().map(|line| (line.weight, offset(line))).collect();
    let least = offsets.iter().fold(f64::INFINITY, |least, (_, offset)| least.min(*offset));
    // The harmonic mean of `t + o` is concave: from above, Newton's method comes below the root and then rises to it.
    let mut t = 2.0 * wanted - least;
    for _ in 0..MOST_STEPS {
        let sum: f64 = offsets.iter().map(|(weight, offset)| weight / (t + offset)).sum();
        let slope: f64 = offsets.iter().map(|(weight, offset)| weight / (t + offset).powi(2)).sum();
        let step = (wanted - 1.0 / sum) * sum * sum / slope;
        t = (t + step).max(0.5 * (t - least));
        if step.abs() <= CLOSE * (t + least) {
            break;
        }
    }
    0.5 * aspect.sqrt() * t.exp()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::patch::gauss;

    fn close(found: f64, exact: f64, tolerance: f64) {
        assert!((found / exact - 1.0).abs() < tolerance, "{found} for {exact}");
    }

    #[test]
    fn a_sticking_circle_is_twice_as_soft_as_one_body_of_mindlin() {
        let (a, shear, nu) = (6e-3, 81e9, 0.3);
        close(rolling_compliance(a, a, shear, nu), (2.0 - nu) / (4.0 * shear * a), 1e-15);
        close(lateral_compliance(a, a, shear, nu), (2.0 - nu) / (4.0 * shear * a), 1e-15);
    }

    /// The closed integral by the trapezoidal rule, which converges exponentially.
    #[test]
    fn a_sticking_ellipse_has_the_compliance_of_the_integral() {
        for (a, b) in [(9e-3, 3e-3), (2e-3, 8e-3)] {
            let (shear, nu, n) = (81e9, 0.3, 400);
            let mean = |numerator: &dyn Fn(f64, f64) -> f64| {
                let part = |i: i32| {
                    let (s, c) = (2.0 * PI * f64::from(i) / f64::from(n)).sin_cos();
                    numerator(s * s, c * c) / (b * b * c * c + a * a * s * s).sqrt()
                };
                (0..n).map(part).sum::<f64>() / f64::from(n) / (2.0 * shear)
            };
            close(rolling_compliance(a, b, shear, nu), mean(&|s, _| 1.0 - nu * s), 1e-14);
            close(lateral_compliance(a, b, shear, nu), mean(&|_, c| 1.0 - nu * c), 1e-14);
        }
    }

    #[test]
    fn lines_that_stick_are_as_stiff_as_the_ellipse() {
        let nu = 0.3;
        for count in 1..=15 {
            for aspect in [0.05, 0.25, 1.0, 3.0, 20.0] {
                let (shear, b) = (81e9, 4e-3);
                let a = aspect * b;
                let length = kernel_length(aspect, nu, &gauss::rule(count)) * (a * b).sqrt();
                close(kernel_length(aspect, nu, &gauss::half(count)) * (a * b).sqrt(), length, 4e-15);
                let kernel = 2.0 * (1.0 - nu) / (PI * shear * k11(aspect));
                let force = |line: &GaussLine| {
                    let half_length = a * (1.0 - line.ordinate.powi(2)).sqrt();
                    b * line.weight / (kernel * (2.0 * length / half_length).ln())
                };
                let stiffness: f64 = gauss::rule(count).iter().map(force).sum();
                close(stiffness * rolling_compliance(a, b, shear, nu), 1.0, 1e-14);
            }
        }
    }

    /// Lengths of 401 lines, found by bisection in an independent program. 5 lines differ by 1.1 % for `a/b` = 0.05 and
    /// by at most 0.8 % from 0.5 on, 9 lines by 0.3 and 0.2 %.
    #[test]
    fn the_length_depends_little_on_the_number_of_lines() {
        for (aspect, exact) in [(0.05, 10.4211), (0.5, 4.2425), (1.0, 3.9433), (4.0 / 3.0, 3.9461), (2.0, 4.0944)] {
            close(kernel_length(aspect, 0.3, &gauss::rule(401)), exact, 2e-5);
            close(kernel_length(aspect, 0.3, &gauss::rule(5)), exact, 0.012);
            close(kernel_length(aspect, 0.3, &gauss::rule(9)), exact, 0.004);
        }
    }
}
