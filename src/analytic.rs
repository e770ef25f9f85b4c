//! Closed forms: start guesses, tests and reports.

use std::f64::consts::PI;

/// Contact modulus `E* = E/(2(1 − ν²))` of two bodies of the same material [Pa] (Johnson, *Contact Mechanics*, 4.2).
pub fn contact_modulus(youngs_modulus: f64, poissons_ratio: f64) -> f64 {
    0.5 * youngs_modulus / (1.0 - poissons_ratio * poissons_ratio)
}

/// Half-width of the Hertzian line contact `a = √(4PR/(πE*))` [m]; `load` [N/m] (Johnson, 4.43).
pub fn hertz_half_width(load: f64, radius: f64, contact_modulus: f64) -> f64 {
    (4.0 * load * radius / (PI * contact_modulus)).sqrt()
}

/// Peak pressure of the Hertzian line contact `p0 = 2P/(πa)` [Pa] (Johnson, 4.44).
pub fn hertz_peak_pressure(load: f64, half_width: f64) -> f64 {
    2.0 * load / (PI * half_width)
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
