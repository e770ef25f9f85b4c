//! Hertz's elliptical contact, exactly.
//!
//! Under the pressure `p₀ √(1 − x²/a² − z²/b²)` the surfaces of two half-spaces move together by
//! `p₀/E* · (a K̂ − x² B̂/a − z² κ D̂/b)` with `κ = a/b` and the integrals `K̂, B̂, D̂ = ∫ (1, cos²φ, sin²φ)/√(cos²φ +
//! κ² sin²φ) dφ` over a quarter turn (Johnson, *Contact Mechanics* (1985), section 4.2, in a form that
//! holds for either axis being the longer one). The bodies then touch where `x²/(2R) + z²/(2R_z)` is taken up.

use crate::patch::elliptic;
use std::f64::consts::PI;

/// Relative step that ends the search for the ratio of the axes: a few times its round-off.
const CLOSE: f64 = 1e-14;
/// Steps of this search at most; it needs at most six.
const MOST_STEPS: usize = 60;
/// Bounds of `d ln(R/R_z)/d ln κ`: 3/2 for the circle, rising to 2 for the slenderest ellipses.
const SLOPES: [f64; 2] = [1.5, 2.0];

/// Contact of two smooth bodies with known curvatures; every load gives an ellipse of the same shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hertz {
    radius: f64,
    modulus: f64,
    aspect: f64,
    /// The integrals `K̂` and `B̂`.
    approach: f64,
    curvature: f64,
}

/// Ellipse of contact under one load.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Ellipse {
    /// Half axis along the direction of rolling \[m].
    pub a: f64,
    /// Lateral half axis \[m].
    pub b: f64,
    /// Largest pressure \[Pa].
    pub peak: f64,
    /// Approach of distant points of both bodies, if they were half-spaces \[m].
    pub approach: f64,
}

impl Hertz {
    /// Contact with the relative radii of curvature `longitudinal_radius` and `lateral_radius` \[m] and the modulus
    /// `contact_modulus` `E*` \[Pa] ([`crate::analytic::contact_modulus`]); all positive and finite.
    ///
    /// `1/R = 1/R_wheel` for a straight rail, `1/R_z = 1/R_wheel,lateral + 1/R_rail,lateral`.
    pub fn new(longitudinal_radius: f64, lateral_radius: f64, contact_modulus: f64) -> Self {
        let aspect = aspect(longitudinal_radius / lateral_radius);
        let square = aspect * aspect;
        Self {
            radius: longitudinal_radius,
            modulus: contact_modulus,
            aspect,
            approach: elliptic::first_kind(square),
            curvature: elliptic::complete(square, 1.0, 0.0),
        }
    }

    /// Ratio `a/b` of the half axis along the direction of rolling over the lateral one \[1].
    pub fn aspect(&self) -> f64 {
        self.aspect
    }

    /// Ellipse under a load \[N]; zeros without a load.
    pub fn under(&self, load: f64) -> Ellipse {
        if load <= 0.0 {
            return Ellipse::default();
        }
        let cube = 3.0 * load * self.radius * self.aspect * self.curvature / (PI * self.modulus);
        let a = libm::cbrt(cube);
        let b = a / self.aspect;
        let approach = 0.5 * a * a * self.approach / (self.radius * self.curvature);
        Ellipse { a, b, peak: 0.5 * a * self.modulus / (self.radius * self.curvature), approach }
    }
}

/// Approach \[m] of two half-spaces with the modulus `contact_modulus` `E*` \[Pa] that touch under a load \[N] in an
/// ellipse with the half axes `a` along and `b` across the direction of rolling \[m].
pub fn approach([a, b]: [f64; 2], load: f64, contact_modulus: f64) -> f64 {
    1.5 * load * elliptic::first_kind((a / b).powi(2)) / (PI * b * contact_modulus)
}

/// Ratio `a/b` of the ellipse whose relative radii of curvature have the ratio `R/R_z = κ² D̂/B̂`.
///
/// Newton's method in logarithms with the slope of the last step, kept within [`SLOPES`], so that every step shortens
/// the error at least to a third.
fn aspect(radii: f64) -> f64 {
    let miss = |logarithm: f64| {
        let square = libm::exp(2.0 * logarithm);
        let share = elliptic::complete(square, 0.0, 1.0) / elliptic::complete(square, 1.0, 0.0);
        libm::log(square * share / radii)
    };
    let mut logarithm = libm::log(radii) / SLOPES[0];
    let (mut error, mut slope) = (miss(logarithm), SLOPES[0]);
    for _ in 0..MOST_STEPS {
        let step = -error / slope;
        logarithm += step;
        if step.abs() <= CLOSE * (1.0 + logarithm.abs()) {
            break;
        }
        let before = error;
        error = miss(logarithm);
        slope = ((error - before) / step).clamp(SLOPES[0], SLOPES[1]);
    }
    libm::exp(logarithm)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analytic;

    fn close(found: f64, exact: f64, tolerance: f64) {
        assert!((found / exact - 1.0).abs() < tolerance, "{found:e} for {exact:e}");
    }

    fn steel() -> f64 {
        analytic::contact_modulus(210e9, 0.3)
    }

    #[test]
    fn equal_radii_give_the_circle_in_closed_form() {
        let (radius, load) = (0.46, 1e5);
        let hertz = Hertz::new(radius, radius, steel());
        let Ellipse { a, b, peak, approach } = hertz.under(load);
        close(a, (0.75 * load * radius / steel()).cbrt(), 1e-15);
        close(b, a, 1e-15);
        close(peak, 1.5 * load / (PI * a * a), 2e-15);
        close(approach, a * a / radius, 1e-15);
    }

    /// The displacement under the ellipse from Boussinesq's `∫ p/r dA/(πE*)`, in polar coordinates about the point:
    /// along a ray the integral is elementary, and over the angle the midpoint rule converges exponentially. Radii,
    /// approach and load of two given ellipses, computed so in double precision with 400 to 20000 angles (equal to
    /// 3e-14).
    #[test]
    fn elongated_ellipses_are_those_of_direct_integration() {
        let long = ([0.815_505_584_038_08, 0.153_947_874_736_12], 67_858.401_317_539_52, [9e-3, 3e-3]);
        let wide = ([0.064_820_356_484_619_3, 2.368_282_606_669_01], 18_849.555_921_538_76, [1e-3, 1e-2]);
        let peaks = [1.2e9, 0.9e9];
        let approaches = [7.889_311_660_522_9e-5, 2.882_597_143_132_1e-5];
        for (i, ([radius, lateral], load, [a, b])) in [long, wide].into_iter().enumerate() {
            let hertz = Hertz::new(radius, lateral, steel());
            let found = hertz.under(load);
            close(found.a, a, 1e-13);
            close(found.b, b, 1e-13);
            close(found.peak, peaks[i], 1e-13);
            close(found.approach, approaches[i], 1e-13);
            close(super::approach([a, b], load, steel()), approaches[i], 1e-13);
        }
    }

    #[test]
    fn the_shape_is_found_for_every_ratio_of_the_axes_and_turns_with_the_bodies() {
        for i in 0..=60 {
            let wanted = 0.05 * 400_f64.powf(f64::from(i) / 60.0);
            let [sine, cosine] = [[0.0, 1.0], [1.0, 0.0]].map(|[c, s]| elliptic::complete(wanted * wanted, c, s));
            let radii = wanted * wanted * sine / cosine;
            let hertz = Hertz::new(0.46, 0.46 / radii, steel());
            close(hertz.aspect(), wanted, 3e-15);
            let turned = Hertz::new(0.46 / radii, 0.46, steel()).under(1e5);
            let Ellipse { a, b, peak, approach } = hertz.under(1e5);
            for (found, other) in [(turned.b, a), (turned.a, b), (turned.peak, peak), (turned.approach, approach)] {
                close(found, other, 4e-15);
            }
            close(peak, 1.5e5 / (PI * a * b), 4e-15);
        }
    }

    /// The middle of a very wide patch carries `3N/(4b)` per width, like a plane contact.
    #[test]
    fn a_wide_patch_is_a_line_contact_in_its_middle() {
        for (curvature, tolerance) in [(1e-3, 5e-3), (1e-6, 1e-5), (1e-9, 2e-8)] {
            let (radius, load) = (0.46, 1e5);
            let Ellipse { a, b, peak, .. } = Hertz::new(radius, radius / curvature, steel()).under(load);
            let line = 0.75 * load / b;
            let width = analytic::hertz_half_width(line, radius, steel());
            close(a, width, tolerance);
            close(peak, analytic::hertz_peak_pressure(line, width), tolerance);
        }
    }

    #[test]
    fn no_load_is_no_patch_and_size_grows_with_the_cube_root() {
        let hertz = Hertz::new(0.46, 0.3, steel());
        for load in [0.0, -1.0] {
            assert_eq!(hertz.under(load), Ellipse::default());
        }
        let [small, large] = [hertz.under(1e3), hertz.under(8e3)];
        close(large.a, 2.0 * small.a, 1e-15);
        close(large.peak, 2.0 * small.peak, 1e-15);
        close(large.approach, 4.0 * small.approach, 1e-15);
    }
}
