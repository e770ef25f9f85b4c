//! Flexibility that a contact line has for itself.

use crate::analytic::HalfPlane;
use serde::{Deserialize, Serialize};

/// Displacement of the surface of a body along a line force of the line itself, `κ ln(L/|x|)` at the distance x.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Logarithm {
    /// `κ` [m/(N/m)].
    pub factor: f64,
    /// `ln(L/1 m)` of the distance L at which a force of the line no longer displaces it by more than forces of other
    /// lines do \[1].
    pub reach: f64,
}

/// Flexibility of each of both bodies under the forces of one line, beside that of the bodies under the forces of all.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct LineKernel {
    /// Along tangential forces.
    pub tangential: Logarithm,
    /// Along normal forces.
    pub normal: Logarithm,
    /// A pressure p strains the surface by `−g p`; `g` [1/Pa].
    pub coupling: f64,
    /// Distance from which on both stay what they are there \[m]: beyond, where no patch on smooth surfaces reaches, a
    /// logarithm would lift the surface ever higher, and a long patch would gain energy by being pressed. Up to a
    /// constant the rest is convex and falls to zero, so that it is positive definite (Pólya). Infinite: nowhere.
    pub end: f64,
}

impl LineKernel {
    /// That of a half-plane whose displacement ends at the distance `length` \[m].
    pub fn of_half_plane(half_plane: HalfPlane, length: f64) -> Self {
        let along = Logarithm { factor: half_plane.kernel, reach: length.ln() };
        Self { tangential: along, normal: along, coupling: half_plane.coupling, end: f64::INFINITY }
    }

    /// True if all numbers are finite.
    pub fn is_sound(&self) -> bool {
        let Self { tangential, normal, coupling, end } = self;
        *end > 0.0
            && [tangential.factor, tangential.reach, normal.factor, normal.reach, *coupling]
                .iter()
                .all(|v| v.is_finite())
    }
}
