//! Weakening of the shear kernel of a line by the finite width of the patch.

/// Factor `k₁₁` of a patch with the ratio `aspect = a/b` \[1]: contact lines with the shear kernel
/// `2(1 − ν)/(πG k₁₁) ln(L/|x − s|)` have the creep coefficient of the ellipse at small creepages.
///
/// Fit `0.945 + 0.27 a/b` to Kalker's `C₁₁ = k₁₁ π²/(4(1 − ν))` (Kalker, *Three-Dimensional Elastic Bodies in Rolling
/// Contact* (1990), table E3), within 2 % for `a/b` from 0.25 to 3; 1, plane strain, for wide patches.
pub fn k11(aspect: f64) -> f64 {
    (0.945 + 0.27 * aspect).max(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    /// Secants at 2 % of saturation, for ν = 0.3, computed with CONTACT r2707 on 61 × 41 elements, so up to 1 % below
    /// the slope at rest; and Kalker's table at b/a = 0.752, interpolated.
    #[test]
    fn creep_coefficient_is_that_of_three_dimensional_rolling_contact() {
        for (aspect, coefficient) in [(0.5, 3.8057), (1.0, 4.2769), (2.0, 5.2573), (1.0 / 0.752, 4.63)] {
            let found = k11(aspect) * PI * PI / (4.0 * (1.0 - 0.3));
            assert!((found / coefficient - 1.0).abs() < 0.01, "{found} for {coefficient}");
        }
        assert_eq!(k11(0.0), 1.0);
    }
}
