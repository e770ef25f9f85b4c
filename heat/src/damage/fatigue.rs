//! Fatigue of the surface by the present contact.

/// Surface fatigue index `FI_surf = μ_util − k/p₀` \[1], not below −1: fatigue of the surface is to be expected where
/// it is positive.
///
/// `utilised` is the tangential over the normal force \[1], `shear_yield` k the yield strength in shear \[Pa] and
/// `peak` p₀ the peak pressure \[Pa]; −1 without contact. Source: A. Ekberg, E. Kabo, H. Andersson, *Fatigue Fract.
/// Eng. Mater. Struct.* 25 (2002) 899–909, `μ_util − 2πabk/3F_z` for an ellipse with the half-axes a and b, of which
/// `3F_z/2πab` is the peak pressure.
pub fn surface_fatigue(utilised: f64, shear_yield: f64, peak: f64) -> f64 {
    if peak > 0.0 { (utilised - shear_yield / peak).max(-1.0) } else { -1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Contact of 100 kN with the half-axes 7.16 and 5.39 mm; limits of a line contact of 755 MPa.
    #[test]
    fn the_index_is_that_of_the_ellipse() {
        let (a, b, load, k) = (7.16e-3, 5.39e-3, 100e3, 300e6);
        let peak = 3.0 * load / (2.0 * std::f64::consts::PI * a * b);
        let ellipse = 0.35 - 2.0 * std::f64::consts::PI * a * b * k / (3.0 * load);
        assert!((surface_fatigue(0.35, k, peak) - ellipse).abs() < 1e-12);
        assert!(surface_fatigue(0.45, 300e6, 755e6) > 0.0 && surface_fatigue(0.35, 300e6, 755e6) < 0.0);
        assert_eq!([surface_fatigue(0.3, k, 0.0), surface_fatigue(0.0, k, 1e6)], [-1.0; 2]);
    }
}
