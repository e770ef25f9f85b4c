//! Moments of series with the powers of the place, and these powers as series.
//!
//! `t U_k = ½ (U_{k+1} + U_{k−1})`: the place moves terms by one, and `U_0` alone has a force. So a term has no moments with powers
//! lower than its number, and no quadrature is needed. Likewise `t T_n = ½ (T_{n+1} + T_{n−1})`, and `t T_0 = T_1`.

use super::chebyshev::Arch;
use crate::contact::flexibility::ByPowers;
use crate::linalg::POINTS;
use std::f64::consts::FRAC_PI_2;

/// Multiplication by a place over a length, `(centre + half t)/length`: by what it keeps a term, and by what it moves it
/// to either side.
#[derive(Clone, Copy)]
pub struct PlaceFactor {
    kept: f64,
    moved: f64,
}

impl PlaceFactor {
    /// That of places on the stretch of a traction, over a `length` \[m].
    pub fn new(stretch: &Arch, length: f64) -> Self {
        Self { kept: stretch.centre / length, moved: 0.5 * stretch.half_width / length }
    }

    /// Moments of the first terms on a stretch of half-length 1 with the powers, by term; further terms have none.
    pub fn moments(self) -> [ByPowers; POINTS] {
        let (mut moments, mut now) = ([ByPowers::default(); POINTS], [0.0; POINTS + 1]);
        now[0] = FRAC_PI_2;
        for power in 0..POINTS {
            moments.iter_mut().zip(&now).for_each(|(moments, now)| moments[power] = *now);
            let mut before = 0.0;
            for k in 0..POINTS {
                let moved = self.moved * (before + now[k + 1]);
                before = now[k];
                now[k] = self.kept * before + moved;
            }
        }
        moments
    }

    /// Powers of the place as series in `T_n`: coefficients by power.
    pub fn powers(self) -> [ByPowers; POINTS] {
        let mut now = ByPowers::default();
        now[0] = 1.0;
        std::array::from_fn(|_| {
            let all = now;
            for n in 0..POINTS {
                let lower = if n > 0 { all[n - 1] } else { 0.0 };
                // The term of order 0 goes to order 1 alone, and as a whole.
                let twice = if n == 1 { lower } else { 0.0 };
                let higher = all.get(n + 1).copied().unwrap_or(0.0);
                now[n] = self.kept * all[n] + self.moved * (lower + twice + higher);
            }
            all
        })
    }
}

impl Arch {
    /// Moments with the powers of the place over a `length` \[m], in N/m.
    pub fn moments(&self, length: f64) -> ByPowers {
        let PlaceFactor { kept, moved } = PlaceFactor::new(self, length);
        let (mut terms, scale) = ([0.0; POINTS + 1], FRAC_PI_2 * self.half_width);
        terms[..POINTS].copy_from_slice(&self.terms[..POINTS]);
        let mut moments = ByPowers::default();
        for (power, moment) in moments.iter_mut().enumerate() {
            *moment = scale * terms[0];
            // Terms that are too far away do not come to the first one any more.
            let mut before = 0.0;
            for k in 0..POINTS - power {
                let beside = before + terms[k + 1];
                before = terms[k];
                terms[k] = kept * before + moved * beside;
            }
        }
        moments
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::series::chebyshev::TERMS;
    use std::f64::consts::PI;

    fn arch() -> Arch {
        let mut terms = [0.0; TERMS];
        terms[..7].copy_from_slice(&[3.0, -1.0, 0.7, 0.2, -0.4, 0.9, -0.6]);
        Arch { centre: 0.3e-3, half_width: 4e-3, count: 7, terms }
    }

    #[test]
    fn moments_by_recursion_are_those_of_quadrature() {
        let (arch, length, n) = (arch(), 5e-3, 40);
        let moments = arch.moments(length);
        let of_terms = PlaceFactor::new(&arch, length).moments();
        for power in 0..POINTS {
            // The rule of Gauss and Chebyshev (second kind) is exact here.
            let mut sum = 0.0;
            for i in 1..=n {
                let angle = f64::from(i) * PI / f64::from(n + 1);
                let x = arch.centre + arch.half_width * angle.cos();
                let weight = PI / f64::from(n + 1) * angle.sin() * arch.half_width;
                sum += weight * arch.density(&[x])[0] * (x / length).powi(power as i32);
            }
            assert!((moments[power] - sum).abs() < 1e-15, "{power}: {} {sum}", moments[power]);
            let by_terms: f64 = of_terms.iter().zip(&arch.terms).map(|(of, term)| of[power] * term).sum();
            assert!((arch.half_width * by_terms - sum).abs() < 1e-15, "{power}");
        }
    }

    #[test]
    fn powers_as_series_are_powers() {
        let (arch, length) = (arch(), 5e-3);
        let powers = PlaceFactor::new(&arch, length).powers();
        for t in [-1.0, -0.3, 0.0, 0.8] {
            let place = (arch.centre + arch.half_width * t) / length;
            for (power, series) in powers.iter().enumerate() {
                let sum: f64 = series.iter().enumerate().map(|(n, c)| c * libm::cos(n as f64 * libm::acos(t))).sum();
                assert!((sum - place.powi(power as i32)).abs() < 1e-15, "{power}");
            }
        }
    }
}
