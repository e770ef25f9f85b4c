//! Closed forms: start guesses, tests and reports.

use std::f64::consts::PI;

/// Contact modulus `E* = E/(2(1 − ν²))` of two bodies of the same material \[Pa] (Johnson, *Contact Mechanics*, 4.2).
pub fn contact_modulus(youngs_modulus: f64, poissons_ratio: f64) -> f64 {
    0.5 * youngs_modulus / (1.0 - poissons_ratio * poissons_ratio)
}

/// Half-width of the Hertzian line contact `a = √(4PR/(πE*))` \[m]; `load` [N/m] (Johnson, 4.43).
pub fn hertz_half_width(load: f64, radius: f64, contact_modulus: f64) -> f64 {
    (4.0 * load * radius / (PI * contact_modulus)).sqrt()
}

/// Peak pressure of the Hertzian line contact `p0 = 2P/(πa)` \[Pa] (Johnson, 4.44).
pub fn hertz_peak_pressure(load: f64, half_width: f64) -> f64 {
    2.0 * load / (PI * half_width)
}

/// Load of a Hertzian line contact with that half-width, `P = πE*a²/(4R)` [N/m]; the inverse of [`hertz_half_width`].
pub fn hertz_load(half_width: f64, radius: f64, contact_modulus: f64) -> f64 {
    PI * contact_modulus * half_width * half_width / (4.0 * radius)
}

/// Speed of Rayleigh waves [m/s] from that of shear waves [m/s] (Viktorov, *Rayleigh and Lamb Waves* (1967): 0.5 % for
/// any Poisson's ratio).
pub fn rayleigh_speed(shear_wave_speed: f64, poissons_ratio: f64) -> f64 {
    shear_wave_speed * (0.87 + 1.12 * poissons_ratio) / (1.0 + poissons_ratio)
}

/// Magnitude of the creepage at which Carter's contact slips fully: `μ a/R` for a cylinder on a plane of the same
/// material with half-width `a` (Johnson, 8.3: `ξ = μ a/R · (1 − √(1 − F/μP))`).
pub fn carter_full_slip(friction: f64, half_width: f64, radius: f64) -> f64 {
    friction * half_width / radius
}

/// Carter's force–creepage law `|F|/(μP) = 1 − (1 − |ξ|/ξ_fs)²`, 1 beyond full slip; traction (`ξ < 0`) positive.
pub fn carter_force(creepage: f64, full_slip: f64) -> f64 {
    let rest = (1.0 - creepage.abs() / full_slip).max(0.0);
    -(1.0 - rest * rest).copysign(creepage)
}

/// Growth of the radius \[m] of an annulus in plane strain, fixed at its inner radius, by a temperature with the mean
/// `temperature` \[K] over its area.
///
/// `expansion` is `α (1 + ν)/(1 − ν)` [1/K], Poisson's ratio ν, the radii `outer` and `inner` \[m]. From the radial
/// displacement `u = expansion · m(r)/r + c (r − r_i²/r)` with `m(r) = ∫ T r dr` from `r_i`; free of stress at the rim
/// (Timoshenko & Goodier, *Theory of Elasticity*, 3rd ed., section 150).
pub fn annulus_growth(temperature: f64, expansion: f64, poissons_ratio: f64, outer: f64, inner: f64) -> f64 {
    let (square, inner_square) = (outer * outer, inner * inner);
    let moment = 0.5 * temperature * (square - inner_square);
    let c = expansion * moment / square / (1.0 / (1.0 - 2.0 * poissons_ratio) + inner_square / square);
    expansion * moment / outer + c * (outer - inner_square / outer)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rim of a uniformly heated annulus: `σ_r = (λ + 2μ) u′ + λ u/r − (3λ + 2μ) α T = 0` with `u(r_i) = 0`.
    #[test]
    fn rim_of_the_heated_annulus_is_free_of_stress() {
        let (nu, alpha, temperature, outer, inner) = (0.3, 1.2e-5, 50.0, 0.46, 0.2);
        let (lame, shear) = (nu / ((1.0 + nu) * (1.0 - 2.0 * nu)), 0.5 / (1.0 + nu));
        let expansion = alpha * (1.0 + nu) / (1.0 - nu);
        let growth = annulus_growth(temperature, expansion, nu, outer, inner);
        // u = A r + B/r with the equilibrium of a uniform temperature, and u(r_i) = 0.
        let a = growth * outer / (outer * outer - inner * inner);
        let b = -a * inner * inner;
        let slope = a - b / (outer * outer);
        let thermal = (3.0 * lame + 2.0 * shear) * alpha * temperature;
        let stress = (lame + 2.0 * shear) * slope + lame * growth / outer - thermal;
        assert!(stress.abs() < 1e-12 * thermal, "{stress:e} against {thermal:e}");
    }
}
