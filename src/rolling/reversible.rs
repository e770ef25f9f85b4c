//! Reversible (Gough–Joule) heating: compressed material warms, released material cools again.
//!
//! Draganis, thesis eq. (3.6): the heat source `−T₀ β tr ε̇`, `β = α(3λ + 2μ)`, moves with the material. Deformation under
//! a rolling contact varies over the patch length a, heat diffuses over `√(2κa/V)`, tens of micrometres: the change of
//! temperature `−T₀ β tr ε/ρc` is adiabatic, but for the share `1/Pe` (`Pe = aV/2κ`), and over the depth of the thermal
//! layer it is that of the surface. It is therefore added to the temperature fields, and its difference between the
//! bodies, opposite tangential strains, conducts through the interface. Below about `Pe = 1` (millimetres per second) it
//! would diffuse away, which is not modelled.

use super::Model;
use crate::contact::ContactSolution;
use crate::material::Isotropic;

impl Model {
    /// Reversible temperatures of the surfaces of wheel and rail at the candidates [K]; zero unless
    /// `physics.thermoelastic_heating`.
    pub(super) fn reversible_temperatures(&self, contact: &ContactSolution) -> [Vec<f64>; 2] {
        let grid = &self.grid;
        if !self.config.physics.thermoelastic_heating {
            return [vec![0.0; grid.len()], vec![0.0; grid.len()]];
        }
        let material = Isotropic::from(&self.config.material);
        let (shear, modulus) = (material.shear_modulus(), material.wave_modulus());
        let heating = material.gough_joule(self.config.thermal.reference);
        [&contact.wheel_surface, &contact.rail_surface].map(|u| {
            let temperature = |i: usize| {
                let d = grid.dof(i);
                let stretch = (u[d + 2] - u[d - 2]) / (2.0 * grid.spacing);
                let pressure = contact.normal(grid, i) / grid.spacing;
                // Plane strain with σ_n = −p: the normal strain is (−p − λ ε_t)/(λ + 2μ).
                heating * (pressure - 2.0 * shear * stretch) / modulus
            };
            (0..grid.len()).map(temperature).collect()
        })
    }
}
