//! Flexibility that a contact line has for itself, and that of a layer between the surfaces.

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
    /// Along lateral forces; zero where there are none.
    pub lateral: Logarithm,
    /// A pressure p strains the surface by `−g p`; `g` [1/Pa].
    pub coupling: f64,
}

impl Logarithm {
    /// Displacement along a unit nodal force [m/(N/m)], given the logarithm of the distance with its sign reversed
    /// ([`crate::contact::line::kernel::logarithms`]).
    pub fn displacement(&self, logarithm: f64) -> f64 {
        self.factor * (self.reach + logarithm)
    }
}

impl LineKernel {
    /// Flexibility along tangential (0), normal (1) or lateral forces (2).
    pub fn along(&self, component: usize) -> Logarithm {
        [self.tangential, self.normal, self.lateral][component]
    }

    /// That of a half-plane whose displacement ends at the distance `length` \[m].
    pub fn of_half_plane(half_plane: HalfPlane, length: f64) -> Self {
        let along = Logarithm { factor: half_plane.kernel, reach: libm::log(length) };
        Self { tangential: along, normal: along, lateral: Logarithm::default(), coupling: half_plane.coupling }
    }

    /// That of a half-plane whose displacement ends at 1 m, as bodies lack it: the rest of a reach is a constant.
    pub fn without_reach(self) -> Self {
        let short = |along: Logarithm| Logarithm { reach: 0.0, ..along };
        Self { tangential: short(self.tangential), normal: short(self.normal), ..self }
    }

    /// Elastic energy of the constants of one body under the sums of tangential and normal forces [J/m].
    pub fn energy_of_reach(&self, sums: [f64; 2]) -> f64 {
        [self.tangential, self.normal]
            .iter()
            .zip(sums)
            .map(|(along, sum)| 0.5 * along.displacement(0.0) * sum * sum)
            .sum()
    }

    /// True if all numbers are finite.
    pub fn is_sound(&self) -> bool {
        let Self { tangential, normal, lateral, coupling } = self;
        let along = [tangential, normal, lateral].map(|along| [along.factor, along.reach]);
        along.as_flattened().iter().chain([coupling]).all(|v| v.is_finite())
    }
}

/// Elastic layer between the surfaces.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Layer {
    /// Displacement of the surfaces against each other, along and across, over the shear there \[m/Pa]; 0: there is none.
    pub shear: f64,
}

impl Layer {
    /// True if there is a layer.
    pub fn gives_way(self) -> bool {
        self.shear > 0.0
    }
}
