//! Tractions as series of Chebyshev polynomials under a square root, and their effect on a half-plane.
//!
//! On the stretch `x = c + b t`, `|t| < 1`, let `f = √(1 − t²) Σ f_k U_k(t)`. With `Z_n = T_n(t)` on the stretch and
//! `Z_n = (t − sgn(t) √(t² − 1))^n` beyond it (F. W. King, *Hilbert Transforms*, Cambridge 2009, ch. 11)
//!
//! ```text
//! ∫ f/(x − s) ds    = π Σ f_k Z_{k+1}(t)
//! ∫ f ln|x − s| ds  = b Σ f_k I_k(t) + ½ π b ln b f_0,     I_k = ½ π (Z_{k+2}/(k + 2) − Z_k/k)
//! ```
//!
//! where `−Z_0/0` stands for `−ln 2` on the stretch and for `ln ½(|t| + √(t² − 1))` beyond it.

use crate::linalg::vectorised::{logarithms, vectorised};
use serde::{Deserialize, Serialize};
use std::f64::consts::{FRAC_PI_2, LN_2, PI};

/// Largest number of terms of a series.
pub const TERMS: usize = 12;

/// One traction of this form.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Arch {
    /// Middle of the stretch \[m].
    pub centre: f64,
    /// Half of its length \[m]; zero: there is none.
    pub half_width: f64,
    /// Number of terms.
    pub count: usize,
    /// Coefficients \[Pa]; zero from the number of terms on.
    pub terms: [f64; TERMS],
}

/// Writes `Z_n(t)` for all n that fit.
fn powers(t: f64, z: &mut [f64]) {
    z[0] = 1.0;
    if t.abs() <= 1.0 {
        z[1] = t;
        for n in 2..z.len() {
            z[n] = 2.0 * t * z[n - 1] - z[n - 2];
        }
    } else {
        let base = 1.0 / (t + t.signum() * (t * t - 1.0).sqrt());
        for n in 1..z.len() {
            z[n] = base * z[n - 1];
        }
    }
}

/// Stand-in for `−Z_0/0`.
fn zeroth(t: f64) -> f64 {
    let t = t.abs();
    if t <= 1.0 { -LN_2 } else { libm::log(0.5 * (t + (t * t - 1.0).sqrt())) }
}

/// `Z_1 … Z_count` at t: the Cauchy integrals of the terms over π.
pub fn cauchy_terms(t: f64, count: usize) -> [f64; TERMS] {
    let mut z = [0.0; TERMS + 2];
    powers(t, &mut z[..count + 2]);
    std::array::from_fn(|k| z[k + 1])
}

/// `I_0 …` at t: the logarithmic integrals of the terms on a stretch of half-length 1.
pub fn logarithm_terms(t: f64, count: usize) -> [f64; TERMS] {
    let mut z = [0.0; TERMS + 2];
    powers(t, &mut z[..count + 2]);
    std::array::from_fn(|k| {
        let lower = if k == 0 { zeroth(t) } else { -z[k] / k as f64 };
        if k < count { FRAC_PI_2 * (z[k + 2] / (k + 2) as f64 + lower) } else { 0.0 }
    })
}

impl Arch {
    /// The traction on a stretch that is longer by a `factor`, its edge at `t = edge` staying where it is: to first order it
    /// differs by [`Self::root_by_length`].
    ///
    /// With the place τ from that edge `∂/∂ln(half) √(1 − τ²) U_k = −(k + 1) T_{k+1} √((1 − τ)/(1 + τ))`, of which
    /// `T_{k+1}(−1)` makes the root, and the rest, divided by `1 + τ`, is `U_k − 2U_{k−1} + 2U_{k−2} − …`
    pub fn stretched(&self, factor: f64, edge: f64) -> Self {
        let (mut longer, mut higher) = (*self, 0.0);
        longer.half_width *= factor;
        longer.centre += edge * (self.half_width - longer.half_width);
        for (k, term) in longer.terms.iter_mut().enumerate().rev() {
            let change = (factor - 1.0) * (k + 1) as f64 * *term;
            *term += change + higher;
            higher = -edge * (higher + 2.0 * change);
        }
        longer
    }

    /// Strength of the root `√((1 − τ)/(1 + τ))`, τ counted to the edge, that the traction needs besides to be the same as on
    /// a longer stretch, per relative change of the length \[Pa].
    pub fn root_by_length(&self, edge: f64) -> f64 {
        let (mut sign, mut sum) = (1.0, 0.0);
        for (k, term) in self.terms.iter().enumerate() {
            sum += sign * (k + 1) as f64 * term;
            sign *= -edge;
        }
        sum
    }

    /// Traction that changes on as it did from an `earlier` one, by `ratio` times as much.
    pub fn onwards(&self, earlier: &Self, ratio: f64) -> Self {
        let onwards = |now: f64, earlier: f64| now + ratio * (now - earlier);
        Self {
            centre: onwards(self.centre, earlier.centre),
            half_width: onwards(self.half_width, earlier.half_width),
            count: self.count,
            terms: std::array::from_fn(|k| onwards(self.terms[k], earlier.terms[k])),
        }
    }

    /// Ends of the stretch \[m].
    pub fn ends(&self) -> [f64; 2] {
        [self.centre - self.half_width, self.centre + self.half_width]
    }

    /// Places on the stretch.
    #[inline(always)]
    fn places<const N: usize>(&self, x: &[f64; N]) -> [f64; N] {
        let (scale, mut t) = (1.0 / self.half_width, [0.0; N]);
        for i in 0..N {
            t[i] = (x[i] - self.centre) * scale;
        }
        t
    }

    /// Traction at x \[Pa].
    pub fn density<const N: usize>(&self, x: &[f64; N]) -> [f64; N] {
        if self.half_width == 0.0 { [0.0; N] } else { density(self, x) }
    }

    /// `∫ f/(x − s) ds` \[Pa].
    pub fn cauchy<const N: usize>(&self, x: &[f64; N]) -> [f64; N] {
        effect(self, [1.0, 0.0], x)
    }

    /// `∫ f ln|x − s| ds` [N/m], lengths in metres.
    pub fn logarithm<const N: usize>(&self, x: &[f64; N]) -> [f64; N] {
        effect(self, [0.0, 1.0], x)
    }

    /// True if all numbers are finite and in range.
    pub fn is_sound(&self) -> bool {
        self.count <= TERMS
            && self.half_width >= 0.0
            && self.centre.is_finite()
            && self.half_width.is_finite()
            && self.terms.iter().all(|term| term.is_finite())
    }

    /// Slope of the traction at x [Pa/m]; beyond the stretch there is none.
    pub fn slope<const N: usize>(&self, x: &[f64; N]) -> [f64; N] {
        self.places(x).map(|t| {
            let sin = (1.0 - t * t).max(0.0).sqrt();
            if sin == 0.0 {
                return 0.0;
            }
            // `d/dt sin (k + 1)θ = −(k + 1) cos (k + 1)θ / sin θ`, the cosines by their recursion.
            let (mut before, mut now, mut sum) = (1.0, t, 0.0);
            for (k, f) in self.terms[..self.count].iter().enumerate() {
                sum += (k + 1) as f64 * f * now;
                (before, now) = (now, 2.0 * t * now - before);
            }
            -sum / (sin * self.half_width)
        })
    }

    /// `∫ f ds` [N/m].
    pub fn total(&self) -> f64 {
        FRAC_PI_2 * self.half_width * self.terms[0]
    }

    /// Largest traction \[Pa], by Newton's method from the middle on `Σ f_k sin (k + 1)θ`; that in the middle where it
    /// bends upwards there.
    pub fn peak(&self) -> f64 {
        let (mut value, mut angle) = (0.0, FRAC_PI_2);
        for _ in 0..4 {
            let (mut slope, mut bend) = (0.0, 0.0);
            value = 0.0;
            // Sines and cosines of multiples of the angle, by those of one less.
            let (sin_one, cos_one) = libm::sincos(angle);
            let (mut sin, mut cos) = (sin_one, cos_one);
            for (k, f) in self.terms[..self.count].iter().enumerate() {
                let n = (k + 1) as f64;
                value += f * sin;
                slope += n * f * cos;
                bend -= n * n * f * sin;
                (sin, cos) = (sin * cos_one + cos * sin_one, cos * cos_one - sin * sin_one);
            }
            if bend >= 0.0 {
                break;
            }
            angle = (angle - slope / bend).clamp(FRAC_PI_2 / 1.5, FRAC_PI_2 * 4.0 / 3.0);
        }
        value
    }
}

vectorised! {
    /// See [`Arch::density`].
    fn density<'a, S, const N: usize>(_simd, arch: &'a Arch, x: &'a [f64; N]) -> [f64; N] {
        let t = arch.places(x);
        let (mut next, mut now) = ([0.0; N], [0.0; N]);
        for f in arch.terms[..arch.count].iter().rev() {
            for i in 0..N {
                (next[i], now[i]) = (now[i], f + 2.0 * t[i] * now[i] - next[i]);
            }
        }
        for i in 0..N {
            now[i] *= (1.0 - t[i] * t[i]).max(0.0).sqrt();
        }
        now
    }
}

vectorised! {
    /// `weights[0] ∫ f/(x − s) ds + weights[1] ∫ f ln|x − s| ds`.
    fn effect<'a, S, const N: usize>(_simd, arch: &'a Arch, weights: [f64; 2], x: &'a [f64; N]) -> [f64; N] {
        effect_of(arch, weights, x)
    }
}

vectorised! {
    /// [`effect`] of `factor` times the first traction and of the second.
    fn effect_of_both<'a, S, const N: usize>(
        _simd,
        factor: f64,
        tractions: [&'a Arch; 2],
        weights: [f64; 2],
        x: &'a [f64; N],
    ) -> [f64; N] {
        let mut sums = effect_of(tractions[0], weights.map(|weight| factor * weight), x);
        if tractions[1].half_width != 0.0 {
            let second = effect_of(tractions[1], weights, x);
            for i in 0..N {
                sums[i] += second[i];
            }
        }
        sums
    }
}

#[inline(always)]
fn effect_of<const N: usize>(arch: &Arch, [by_cauchy, by_logarithm]: [f64; 2], x: &[f64; N]) -> [f64; N] {
    if arch.half_width == 0.0 {
        return [0.0; N];
    }
    let (f, mut orders) = (&arch.terms, [0.0; TERMS + 1]);
    let (own, scale) = (PI * by_cauchy, FRAC_PI_2 * arch.half_width * by_logarithm);
    // By orders n from 1 on: π f_{n−1} of the first, ½ π b (f_{n−2} − f_n)/n of the second.
    orders[0] = own * f[0] - scale * f[1];
    for k in 1..TERMS - 1 {
        orders[k] = own * f[k] + scale * ((f[k - 1] - f[k + 1]) * SHARES[k]);
    }
    orders[TERMS - 1] = own * f[TERMS - 1] + scale * (f[TERMS - 2] * SHARES[TERMS - 1]);
    orders[TERMS] = scale * (f[TERMS - 1] * SHARES[TERMS]);
    let (t, orders, first) = (arch.places(x), &orders[..=arch.count], scale * f[0]);
    let size = if first == 0.0 { 0.0 } else { libm::log(arch.half_width) };
    if within(&t) {
        let (mut sums, first) = (sum_within(&t, orders), (size - LN_2) * first);
        for sum in &mut sums {
            *sum += first;
        }
        return sums;
    }
    let powers = Powers::at(&t);
    let mut sums = sum(&powers, orders);
    if first != 0.0 {
        let zeroth = powers.zeroth();
        for i in 0..N {
            sums[i] += (zeroth[i] + size) * first;
        }
    }
    sums
}

/// True if all places are on the stretch.
#[inline(always)]
fn within<const N: usize>(t: &[f64; N]) -> bool {
    // Without a branch for each: the sign of what is left to the end.
    let mut beyond = 0;
    for t in t {
        beyond |= (1.0 - t.abs()).to_bits();
    }
    beyond >> 63 == 0
}

/// `Σ f_k T_{k+1}` at places on the stretch.
#[inline(always)]
fn sum_within<const N: usize>(t: &[f64; N], f: &[f64]) -> [f64; N] {
    let (mut next, mut now) = ([0.0; N], [0.0; N]);
    for f in f.iter().rev() {
        for i in 0..N {
            (next[i], now[i]) = (now[i], f + 2.0 * t[i] * now[i] - next[i]);
        }
    }
    for i in 0..N {
        now[i] = t[i] * now[i] - next[i];
    }
    now
}

/// How the `Z_n` of several places follow from each other.
struct Powers<const N: usize> {
    /// Factors of Clenshaw's recursion on the stretch and of Horner's beyond it: of the last sum, of the one before,
    /// and of the last one in the result.
    now: [f64; N],
    next: [f64; N],
    end: [f64; N],
}

impl<const N: usize> Powers<N> {
    #[inline(always)]
    fn at(t: &[f64; N]) -> Self {
        let (mut now, mut next, mut end) = ([0.0; N], [0.0; N], [0.0; N]);
        for i in 0..N {
            let (t, inside) = (t[i], t[i].abs() <= 1.0);
            let base = 1.0 / (t + (t * t - 1.0).max(0.0).sqrt().copysign(t));
            now[i] = if inside { 2.0 * t } else { base };
            next[i] = if inside { 1.0 } else { 0.0 };
            end[i] = if inside { t } else { base };
        }
        Self { now, next, end }
    }

    /// Stand-in for `−Z_0/0`.
    #[inline(always)]
    fn zeroth(&self) -> [f64; N] {
        // Without a branch: on the stretch 2 stands for the place.
        let mut zeroth = [2.0; N];
        for (zeroth, (next, end)) in zeroth.iter_mut().zip(self.next.iter().zip(&self.end)) {
            *zeroth = if *next == 0.0 { 2.0 * end.abs() } else { *zeroth };
        }
        zeroth = logarithms(&zeroth);
        for zeroth in &mut zeroth {
            *zeroth = -*zeroth;
        }
        zeroth
    }
}

/// `Σ f_k Z_{k+1}` at all places.
#[inline(always)]
fn sum<const N: usize>(powers: &Powers<N>, f: &[f64]) -> [f64; N] {
    let (mut next, mut now) = ([0.0; N], [0.0; N]);
    for f in f.iter().rev() {
        for i in 0..N {
            (next[i], now[i]) = (now[i], f + powers.now[i] * now[i] - powers.next[i] * next[i]);
        }
    }
    for i in 0..N {
        now[i] = powers.end[i] * now[i] - powers.next[i] * next[i];
    }
    now
}

/// 1, ½, ⅓, …
const SHARES: [f64; TERMS + 1] = {
    let (mut shares, mut k) = ([1.0; TERMS + 1], 0);
    while k <= TERMS {
        shares[k] = 1.0 / (k + 1) as f64;
        k += 1;
    }
    shares
};

#[cfg(test)]
mod tests {
    use super::*;

    fn arch() -> Arch {
        let mut terms = [0.0; TERMS];
        terms[..5].copy_from_slice(&[3.0, -1.0, 0.7, 0.2, -0.4]);
        Arch { centre: 0.3, half_width: 0.02, count: 5, terms }
    }

    /// `∫ f w ds` by the rule of Gauss and Chebyshev over `s = c + b cos θ`.
    fn integral(arch: &Arch, weight: impl Fn(f64) -> f64) -> f64 {
        let n = 20_000;
        let sum: f64 = (0..n)
            .map(|i| {
                let theta = (f64::from(i) + 0.5) * PI / f64::from(n);
                let s = arch.centre + arch.half_width * theta.cos();
                arch.density(&[s])[0] * weight(s) * arch.half_width * theta.sin()
            })
            .sum();
        sum * PI / f64::from(n)
    }

    #[test]
    fn integrals_of_a_series_are_those_of_quadrature_beyond_its_stretch() {
        let arch = arch();
        assert!((integral(&arch, |_| 1.0) - arch.total()).abs() < 1e-12);
        for x in [0.1, 0.27, 0.2795, 0.3205, 0.34, 0.9] {
            let (cauchy, logarithm) = (integral(&arch, |s| 1.0 / (x - s)), integral(&arch, |s| (x - s).abs().ln()));
            assert!((arch.cauchy(&[x])[0] - cauchy).abs() < 1e-9 * 3.0, "{x}: {} {cauchy}", arch.cauchy(&[x])[0]);
            assert!(
                (arch.logarithm(&[x])[0] - logarithm).abs() < 1e-12,
                "{x}: {} {logarithm}",
                arch.logarithm(&[x])[0]
            );
        }
    }

    /// The principal value is an ordinary integral of `(f(s) − f(x))/(x − s)` and a logarithm.
    #[test]
    fn on_its_stretch_the_principal_value_and_the_logarithm_agree_with_quadrature() {
        let arch = arch();
        let [low, high] = arch.ends();
        let n = 400_000;
        for x in [0.2841, 0.3, 0.3107, 0.3193] {
            let f = arch.density(&[x])[0];
            let (mut cauchy, mut logarithm) = (f * ((x - low) / (high - x)).ln(), 0.0);
            for i in 0..n {
                let theta = (f64::from(i) + 0.5) * PI / f64::from(n);
                let (s, ds) =
                    (arch.centre + arch.half_width * theta.cos(), PI / f64::from(n) * arch.half_width * theta.sin());
                cauchy += (arch.density(&[s])[0] - f) / (x - s) * ds;
                logarithm += (arch.density(&[s])[0] - f) * (x - s).abs().ln() * ds;
            }
            logarithm += f * ((x - low) * (x - low).ln() + (high - x) * (high - x).ln() - (high - low));
            assert!((arch.cauchy(&[x])[0] - cauchy).abs() < 1e-5, "{x}: {} {cauchy}", arch.cauchy(&[x])[0]);
            assert!((arch.logarithm(&[x])[0] - logarithm).abs() < 1e-9, "{x}: {} {logarithm}", arch.logarithm(&[x])[0]);
        }
    }

    #[test]
    fn the_logarithm_is_continuous_at_the_ends_and_its_slope_is_the_principal_value() {
        let arch = arch();
        for end in arch.ends() {
            assert!((arch.logarithm(&[end - 1e-12])[0] - arch.logarithm(&[end + 1e-12])[0]).abs() < 1e-9);
        }
        for x in [0.25, 0.285, 0.3, 0.317, 0.35] {
            let slope = (arch.logarithm(&[x + 1e-6])[0] - arch.logarithm(&[x - 1e-6])[0]) / 2e-6;
            assert!((slope - arch.cauchy(&[x])[0]).abs() < 1e-5 * arch.terms[0], "{x}");
        }
    }
    /// The error falls with the square of the change of the length, at either edge.
    #[test]
    fn a_traction_with_its_root_is_the_one_on_a_longer_stretch() {
        let mut arch = Arch { centre: 0.3, half_width: 2.0, count: 6, ..Arch::default() };
        arch.terms[..6].copy_from_slice(&[1.0, -0.3, 0.2, 0.1, -0.05, 0.02]);
        let places: [f64; 7] = std::array::from_fn(|k| 0.3 * k as f64 - 0.9);
        for edge in [1.0, -1.0] {
            let error = |change: f64| {
                let longer = arch.stretched(1.0 + change, edge);
                assert!((longer.centre + edge * longer.half_width - (0.3 + edge * 2.0)).abs() < 1e-14);
                let root = change * arch.root_by_length(edge);
                let x = places.map(|t| 0.3 + 2.0 * t);
                let both = longer.density(&x).into_iter().zip(arch.density(&x)).zip(places);
                let of_root = |t: f64| root * ((1.0 - edge * t) / (1.0 + edge * t)).sqrt();
                both.map(|((longer, before), t)| (longer - before - of_root(t)).abs()).fold(0.0, f64::max)
            };
            let errors = [1e-3, 1e-4].map(error);
            println!("edge {edge}: {errors:?}");
            assert!(errors[0] < 1e-4 && (errors[0] / errors[1] / 100.0 - 1.0).abs() < 0.1);
        }
    }
}
