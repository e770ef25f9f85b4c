//! Complete elliptic integrals by the arithmetic-geometric mean, to round-off.

use std::f64::consts::FRAC_PI_2;

/// Relative difference of both means that ends the iteration: it converges quadratically, so the next one is exact.
const CLOSE: f64 = 1e-8;

/// Integral `∫₀^{π/2} (c cos²φ + s sin²φ)/√(cos²φ + m₁ sin²φ) dφ`, from which all others follow.
///
/// `complement` is the complementary parameter `m₁ = 1 − k²`, positive and also above 1 (then `k` is imaginary);
/// `cosine` and `sine` are `c` and `s`. With both at least 0 only positive numbers are added, so that no digit is lost,
/// however close `k` is to 0 or to 1. `m₁ = 0` gives infinity where `s > 0`. Bulirsch's `cel` for `p = 1` (Numer. Math.
/// 7 (1965) 78; DLMF 19.2.11).
pub fn complete(complement: f64, cosine: f64, sine: f64) -> f64 {
    if complement == 0.0 {
        return if sine > 0.0 { f64::INFINITY } else { cosine };
    }
    let (mut upper, mut lower) = (1.0, complement.sqrt());
    let (mut product, mut divisor) = (lower, 1.0);
    let (mut c, mut s) = (cosine, sine);
    loop {
        let (before, ratio) = (c, product / divisor);
        c += s / divisor;
        s = 2.0 * (s + before * ratio);
        divisor += ratio;
        let last = upper;
        upper += lower;
        if (last - lower).abs() <= CLOSE * last {
            return FRAC_PI_2 * (s + c * upper) / (upper * (upper + divisor));
        }
        lower = 2.0 * product.sqrt();
        product = lower * upper;
    }
}

/// Complete elliptic integral of the first kind, `K(k) = ∫₀^{π/2} dφ/√(1 − k² sin²φ)`, of `complement = 1 − k²`.
pub fn first_kind(complement: f64) -> f64 {
    complete(complement, 1.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    /// Integral of the second kind `E(k)`, of `complement = 1 − k²`.
    fn second_kind(complement: f64) -> f64 {
        complete(complement, 1.0, complement)
    }

    fn close(found: f64, exact: f64) {
        assert!((found / exact - 1.0).abs() < 2e-15, "{found} for {exact}");
    }

    /// Abramowitz & Stegun, tables 17.1 and 17.2 (parameter `m = k²`: ten digits); all digits by the trapezoidal rule.
    #[test]
    fn elliptic_integrals_are_the_tabulated_ones() {
        close(first_kind(1.0), FRAC_PI_2);
        close(second_kind(1.0), FRAC_PI_2);
        close(first_kind(0.5), 1.854_074_677_301_371_9);
        close(second_kind(0.5), 1.350_643_881_047_675_5);
        close(first_kind(0.75), 1.685_750_354_812_596);
        close(second_kind(0.75), 1.467_462_209_339_427_2);
        close(first_kind(0.01), 3.695_637_362_989_874_6);
        close(second_kind(0.01), 1.015_993_545_025_224);
        assert_eq!((second_kind(0.0), first_kind(0.0)), (1.0, f64::INFINITY));
    }

    /// Legendre's relation `E K′ + E′ K − K K′ = π/2`.
    #[test]
    fn elliptic_integrals_obey_the_relation_of_legendre() {
        for complement in [1e-6, 1e-3, 0.1, 0.3, 0.5, 0.9] {
            let [k, e] = [first_kind(complement), second_kind(complement)];
            let [k_other, e_other] = [first_kind(1.0 - complement), second_kind(1.0 - complement)];
            let sum = e * k_other + e_other * k - k * k_other;
            assert!((sum - FRAC_PI_2).abs() < 4e-15 * k * k_other, "{complement}: {sum}");
        }
    }

    /// `K = Λ + k′²/4 (Λ − 1) + 9k′⁴/64 (Λ − 7/6) + …` with `Λ = ln(4/k′)` (DLMF 19.12.1), and the swap of the axes for
    /// parameters above 1.
    #[test]
    fn slender_ellipses_lose_no_digits() {
        for ratio in [1e-3_f64, 1e-6, 1e-9] {
            let square = ratio * ratio;
            let logarithm = (4.0 / ratio).ln();
            let second = 9.0 / 64.0 * square * square * (logarithm - 7.0 / 6.0);
            let series = logarithm + 0.25 * square * (logarithm - 1.0) + second;
            close(first_kind(square), series);
            close(complete(square, 0.0, 1.0), series - complete(square, 1.0, 0.0));
        }
        for complement in [0.0025, 0.3, 4.0, 400.0_f64] {
            let swapped = complete(1.0 / complement, 0.7, 1.0) / complement.sqrt();
            close(complete(complement, 1.0, 0.7), swapped);
        }
    }

    /// The trapezoidal rule converges exponentially for a periodic function.
    #[test]
    fn the_general_integral_is_its_quadrature() {
        for (complement, cosine, sine) in [(0.04, 1.0, 0.7), (0.5, 0.2, 3.0), (9.0, 1.0, 0.0), (0.1, 0.0, 1.0)] {
            let n = 400;
            let part = |i: i32| {
                let (s, c) = (PI * (f64::from(i) + 0.5) / f64::from(2 * n)).sin_cos();
                (cosine * c * c + sine * s * s) / (c * c + complement * s * s).sqrt()
            };
            let quadrature = (0..n).map(part).sum::<f64>() * PI / f64::from(2 * n);
            assert!((complete(complement, cosine, sine) / quadrature - 1.0).abs() < 1e-14);
        }
    }
}
