//! Reversible (Gough–Joule) heating: compressed material warms, released material cools again.
//!
//! Draganis, thesis eq. (3.6): the heat source `−T₀ β tr ε̇`, `β = α(3λ + 2μ)`, moves with the material. Deformation under
//! a rolling contact varies over the patch length a, heat diffuses over `√(2κa/V)`, tens of micrometres: the change of
//! temperature `−T₀ β tr ε/ρc` is adiabatic, but for the share `1/Pe` (`Pe = aV/2κ`), and over the depth of the thermal
//! layer it is that of the surface. It is therefore added to the temperature fields, and its difference between the
//! bodies, opposite tangential strains, conducts through the interface. Below about `Pe = 1` (millimetres per second) it
//! would diffuse away, which is not modelled.

use crate::config::Config;
use crate::contact::Traction;
use crate::material::Isotropic;
use crate::piecewise::Piecewise;

/// Reversible heating of both surfaces.
#[derive(Clone, Debug)]
pub struct Thermoelastic {
    /// Temperature rise per compression `−tr ε` [K].
    heating: f64,
    /// Shear modulus [Pa].
    shear: f64,
    /// P-wave modulus λ + 2μ [Pa].
    modulus: f64,
}

impl Thermoelastic {
    /// From the parameters.
    pub fn new(config: &Config) -> Self {
        let material = Isotropic::from(&config.material);
        Self {
            heating: material.gough_joule(config.thermal.reference),
            shear: material.shear_modulus(),
            modulus: material.wave_modulus(),
        }
    }

    /// Reversible temperatures [K] of a surface with the tangential strain `strain` under the contact pressure.
    pub fn temperatures(&self, strain: Piecewise, contact: &Traction) -> Piecewise {
        let Piecewise { x, mut value } = strain;
        for (value, &x) in value.iter_mut().zip(&x) {
            // Plane strain with σ_n = −p: the normal strain is (−p − λ ε_t)/(λ + 2μ).
            *value = self.heating * (contact.pressure.at(x) - 2.0 * self.shear * *value) / self.modulus;
        }
        Piecewise { x, value }
    }
}
