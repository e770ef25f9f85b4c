//! Shapes of features against their formulas, and profiles that are refused.

use super::*;

fn rail(text: &str) -> Profile {
    Profile::parse(text, None, Body::Rail).unwrap()
}

#[test]
fn features_add_up() {
    let profile =
        rail("sinusoid(amplitude = 5e-6, wavelength = 0.05) + hole(position = 2, length = 5e-3, depth = 1e-3)");
    let wave = |x: f64| 5e-6 * (TAU * x / 0.05).sin();
    for (x, hole) in [(0.0, 0.0), (0.0125, 0.0), (1.997, 0.0), (1.998, -1e-3), (2.0024, -1e-3), (2.003, 0.0)] {
        assert!((profile.height(x) - wave(x) - hole).abs() < 1e-18 + 1e-12 * wave(x).abs() + 1e-19, "{x}");
    }
    assert_eq!(profile.range(), [-1.005e-3, 5e-6]);
}
