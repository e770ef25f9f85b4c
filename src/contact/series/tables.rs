//! Constants of the series: places on a stretch `|t| < 1` and the values of all terms there.

use super::chebyshev::TERMS;
use std::f64::consts::PI;

/// Terms of the pressure.
pub const PRESSURE: usize = 4;
/// Terms of the shear where it sticks.
pub const SHEAR: usize = 10;
/// Places at which the pressure holds the surfaces together: one more than terms.
pub const SMOOTH: usize = PRESSURE + 1;
/// Terms of the slope of a hot layer: those that the pressure follows, and as many beyond.
pub const SLOPE: usize = 2 * SMOOTH;
/// Places at which the surfaces stick: one more than terms.
pub const STICK: usize = SHEAR + 1;
/// Places of the rule that integrates tractions.
pub const QUADRATURE: usize = 12;
/// Room for the places at which the surfaces stick: whole vector registers.
pub const STICK_ROOM: usize = 12;
/// Places of the rule that integrates the power of friction.
pub const POWER: usize = QUADRATURE;

/// Points of the profiles over the part that slips and the part that sticks.
pub const PROFILE: usize = 20;

/// Places and values of the terms.
#[derive(Clone, Debug)]
pub struct Tables {
    /// Zeros of `T_5`, where the gap is to stay closed.
    pub closed: [f64; SMOOTH],
    /// `T_n` there, by n.
    pub closed_terms: [[f64; SMOOTH]; SMOOTH],
    /// Zeros of `T_{SHEAR+1}`, where the surfaces stick; the last one fills the room.
    pub stick: [f64; STICK_ROOM],
    /// Weights of values there in the coefficients of `T_n`, by place and n.
    pub stick_terms: [[f64; STICK_ROOM]; STICK],
    /// Places of the rule of Gauss and Chebyshev (second kind).
    pub places: [f64; QUADRATURE],
    /// Its weights for whole functions that rise like a root at both ends.
    pub weights: [f64; QUADRATURE],
    /// `√(1 − t²) U_k` at the places times their weights, by k.
    pub moments: [[f64; QUADRATURE]; TERMS],
    /// Points of the profiles: shares of a stretch, denser towards its ends.
    pub profile: [f64; PROFILE],
}

impl Tables {
    /// All constants.
    pub fn new() -> Self {
        let zeros = |n: usize, i: usize| libm::cos((i as f64 + 0.5) * PI / n as f64);
        let closed: [f64; SMOOTH] = std::array::from_fn(|i| zeros(SMOOTH, i));
        let stick: [f64; STICK_ROOM] = std::array::from_fn(|i| zeros(STICK, i.min(STICK - 1)));
        let weight = |i: usize, n: usize| {
            let mean = if n == 0 { 1.0 } else { 2.0 } / STICK as f64;
            if n < STICK { mean * libm::cos(n as f64 * (i as f64 + 0.5) * PI / STICK as f64) } else { 0.0 }
        };
        let angle = |q: usize| (q + 1) as f64 * PI / (QUADRATURE + 1) as f64;
        let weights = std::array::from_fn(|q| PI / (QUADRATURE + 1) as f64 * libm::sin(angle(q)));
        Self {
            closed,
            closed_terms: std::array::from_fn(|n| closed.map(|t| libm::cos(n as f64 * libm::acos(t)))),
            stick,
            stick_terms: std::array::from_fn(|i| std::array::from_fn(|n| weight(i, n))),
            places: std::array::from_fn(|q| libm::cos(angle(q))),
            weights,
            moments: std::array::from_fn(|k| {
                std::array::from_fn(|q: usize| weights[q] * libm::sin((k + 1) as f64 * angle(q)))
            }),
            profile: std::array::from_fn(|i| 0.5 - 0.5 * libm::cos((i + 1) as f64 * PI / PROFILE as f64)),
        }
    }
}

impl Default for Tables {
    fn default() -> Self {
        Self::new()
    }
}
