//! Deformation of the bodies by heat, as far as it acts on the contact.
//!
//! The temperature of the wheel is split into its bulk and the layer under the contact.
//! - The bulk is taken as axisymmetric. A free wheel grows by `α T̄ r_o` with the mean T̄ over its volume: exact at a
//!   uniform temperature, and for any in an annulus of one width that nothing holds. With
//!   `thermal.cross_section = contact` it is an annulus on a rigid cold hub in plane strain,
//!   `u(r_o) = (1+ν)/(1−ν) α I/r_o + C (r_o − r_i²/r_o)`, `I = ∫ T r dr`, with `C` from `σ_r(r_o) = 0` (Timoshenko &
//!   Goodier, *Theory of Elasticity*, section 150). The growth lifts the hub and raises the peripheral velocity.
//! - The layer (tens of micrometres, much thinner than the patch) is held by the cold material below: it swells by
//!   `(1+ν)/(1−ν) α ∫T dz`, and its membrane force `Eα/(1−ν) ∫T dz` pulls tangentially at the body by its gradient.

use crate::analytic::annulus_growth;
use crate::config::{Config, CrossSection};
use crate::heat::Observation;
use crate::material::Isotropic;
use crate::rolling::thermal_state::ThermalDeformation;

/// Thermal expansion of wheel and rail.
#[derive(Clone, Debug)]
pub struct Expansion {
    /// Growth of the outer radius per mean temperature of the wheel over that of the hub [m/K].
    growth: f64,
    /// Swelling of a held layer per temperature times depth [1/K].
    swelling: f64,
    /// Membrane force of a held layer per temperature times depth [N/(m² K)].
    membrane: f64,
}

impl Expansion {
    /// Expansion for the parameters.
    pub fn new(config: &Config) -> Self {
        let (wheel, material) = (&config.wheel, Isotropic::from(&config.material));
        let growth = match config.thermal.cross_section {
            CrossSection::Bodies => config.material.expansion * wheel.radius,
            CrossSection::Contact => {
                let (held, nu) = (material.layer_expansion(), config.material.poissons_ratio);
                annulus_growth(1.0, held, nu, wheel.radius, wheel.hub_radius)
            }
        };
        Self { growth, swelling: material.layer_expansion(), membrane: material.layer_pressure() }
    }

    /// Writes the deformation that belongs to the temperatures `seen` at the positions `x` [m].
    pub fn deform(&self, x: &[f64], seen: &Observation, out: &mut ThermalDeformation) {
        out.radius_growth = self.growth * seen.temperatures.wheel_mean;
        for (body, layer) in seen.layer.iter().enumerate() {
            let (swelling, force) = (&mut out.swelling[body], &mut out.membrane_force[body]);
            swelling.clear();
            force.clear();
            for (&x, heat) in x.iter().zip(layer) {
                swelling.push(x, self.swelling * heat);
                force.push(x, self.membrane * heat);
            }
        }
    }
}
