//! Reversible (Gough–Joule) heating: compressed material warms, released material cools again.
//!
//! Draganis, thesis eq. (3.6): the heat source `−T₀ β tr ε̇`, `β = α(3λ + 2μ)`, moves with the material. Deformation
//! under a rolling contact varies over the patch length a, heat diffuses over `√(2κa/V)`, tens of micrometres: the
//! change of temperature `−T₀ β tr ε/ρc` is adiabatic, but for the share `1/Pe` (`Pe = aV/2κ`), and over the depth of
//! the thermal layer it is that of the surface. It is therefore added to the temperature fields, and its difference
//! between the bodies, opposite tangential strains, conducts through the interface. Below about `Pe = 1` (millimetres
//! per second) it would diffuse away, which is not modelled.
//!
//! The linear law knows no absolute zero. Cooling beyond a tenth of the reference temperature, which steel does not
//! reach, therefore continues as an exponential, like that of the exact law `dT/T = −β/(ρc) d tr ε`, and tends to it.

use crate::config::Config;
use crate::contact::Traction;
use crate::material::Isotropic;
use crate::piecewise::Piecewise;

/// Cooling relative to the reference temperature up to which the law is linear [1].
const LINEAR: f64 = 0.1;

/// Reversible heating of both surfaces.
#[derive(Clone, Debug)]
pub struct Thermoelastic {
    /// Absolute temperature of the undeformed surface [K].
    reference: f64,
    /// Temperature rise per compression `−tr ε` [K].
    heating: f64,
    /// Shear modulus [Pa].
    shear: f64,
    /// P-wave modulus λ + 2μ [Pa].
    modulus: f64,
}

impl Thermoelastic {
    /// Heating for the parameters.
    pub fn new(config: &Config) -> Self {
        let material = Isotropic::from(&config.material);
        Self {
            reference: config.thermal.reference,
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
            let linear = self.heating * (contact.pressure.at(x) - 2.0 * self.shear * *value) / self.modulus;
            *value = bounded(linear, self.reference);
        }
        Piecewise { x, value }
    }
}

/// A change of temperature by the linear law, above absolute zero for any strain: `reference` [K] is where it starts.
fn bounded(linear: f64, reference: f64) -> f64 {
    let least = -LINEAR * reference;
    if linear >= least {
        return linear;
    }
    let left = reference + least;
    least - left * (1.0 - libm::exp((linear - least) / left))
}

#[cfg(test)]
mod tests {
    use super::bounded;

    #[test]
    fn reversible_cooling_is_linear_for_steel_smooth_at_its_limit_and_never_reaches_absolute_zero() {
        for linear in [-29.0, -5.0, 0.0, 400.0] {
            assert_eq!(bounded(linear, 293.0), linear);
        }
        let slope = (bounded(-29.3 - 1e-4, 293.0) + 29.3) / -1e-4;
        assert!((slope - 1.0).abs() < 1e-5, "{slope}");
        assert!((-293.0..-200.0).contains(&bounded(-700.0, 293.0)));
        assert!(bounded(-1e5, 293.0) >= -293.0);
    }
}
