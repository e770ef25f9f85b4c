//! Mindlin's stiffness of a sticking patch under a shear force, and contact lines that have it.

use crate::patch::{elliptic, k11::k11, reach::common_length};
use std::f64::consts::PI;

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

/// Length `L` \[m] in the shear kernel `2(1 − ν)/(πG k₁₁) ln(L/|x − s|)` of contact lines (relative displacement of both
/// bodies) for which lines that stick everywhere are as stiff as the ellipse with the half axes `a` and `b` \[m].
///
/// A line of the half-length `a_k` bears `u/(2(1 − ν)/(πG k₁₁) ln(2L/a_k))` per width when it is shifted by `u`. `lines`
/// are the widths and half-lengths \[m] of at least one line.
pub fn kernel_length([a, b]: [f64; 2], poissons_ratio: f64, lines: impl Iterator<Item = [f64; 2]>) -> f64 {
    let shape = elliptic::complete((a / b).powi(2), 1.0, 1.0 - poissons_ratio) / b;
    common_length(2.0 * (1.0 - poissons_ratio) / (k11(a / b) * shape), lines)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::patch::gauss::{self, GaussLine};

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

    /// Half-length of a line of the ellipse with the half axis `a`.
    fn half_length(a: f64, line: &GaussLine) -> f64 {
        a * (1.0 - line.ordinate.powi(2)).sqrt()
    }

    fn of_ellipse([a, b]: [f64; 2], lines: &[GaussLine]) -> f64 {
        kernel_length([a, b], 0.3, lines.iter().map(|line| [b * line.weight, half_length(a, line)]))
    }

    #[test]
    fn lines_that_stick_are_as_stiff_as_the_ellipse() {
        let nu = 0.3;
        for count in 1..=15 {
            for aspect in [0.05, 0.25, 1.0, 3.0, 20.0] {
                let (shear, b) = (81e9, 4e-3);
                let a = aspect * b;
                let length = of_ellipse([a, b], &gauss::rule(count));
                close(of_ellipse([a, b], &gauss::half(count)), length, 1e-14);
                let kernel = 2.0 * (1.0 - nu) / (PI * shear * k11(aspect));
                let force = |line: &GaussLine| b * line.weight / (kernel * (2.0 * length / half_length(a, line)).ln());
                let stiffness: f64 = gauss::rule(count).iter().map(force).sum();
                close(stiffness * rolling_compliance(a, b, shear, nu), 1.0, 1e-14);
            }
        }
    }

    /// Lengths over `√(ab)` of 401 lines, found by bisection in an independent program. 5 lines differ by 1.1 % for `a/b` = 0.05 and
    /// by at most 0.8 % from 0.5 on, 9 lines by 0.3 and 0.2 %.
    #[test]
    fn the_length_depends_little_on_the_number_of_lines() {
        for (aspect, exact) in [(0.05, 10.4211), (0.5, 4.2425), (1.0, 3.9433), (4.0 / 3.0, 3.9461), (2.0, 4.0944)] {
            let axes = [f64::sqrt(aspect), 1.0 / f64::sqrt(aspect)];
            for (count, tolerance) in [(401, 2e-5), (5, 0.012), (9, 0.004)] {
                close(of_ellipse(axes, &gauss::rule(count)), exact, tolerance);
            }
        }
    }
}
