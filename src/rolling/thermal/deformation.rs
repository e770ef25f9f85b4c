//! How heat deforms the bodies, as far as it acts on the contact.
//!
//! The temperature of the wheel is split into its bulk and the layer under the contact.
//! - The bulk is taken as axisymmetric. An annulus on a rigid cold hub in plane strain grows by
//!   `u(r_o) = (1+ν)/(1−ν) α I/r_o + C (r_o − r_i²/r_o)`, `I = ∫ T r dr`, with `C` from `σ_r(r_o) = 0` (Timoshenko &
//!   Goodier, *Theory of Elasticity*, section 150). It lifts the hub and raises the peripheral velocity.
//! - The layer (tens of micrometres, much thinner than the patch) is held by the cold material below: it swells by
//!   `(1+ν)/(1−ν) α ∫T dz`, and its membrane force `Eα/(1−ν) ∫T dz` pulls tangentially at the body by its gradient.

use crate::analytic::annulus_growth;
use crate::config::Config;
use crate::heat::Observation;
use crate::material::Isotropic;
use crate::rolling::state::ThermalDeformation;

/// Thermal expansion of wheel and rail.
#[derive(Clone, Debug)]
pub struct Expansion {
    outer_radius: f64,
    hub_radius: f64,
    poissons_ratio: f64,
    /// Swelling of a held layer per temperature times depth [1/K].
    swelling: f64,
    /// Membrane force of a held layer per temperature times depth [N/(m² K)].
    membrane: f64,
}

impl Expansion {
    /// From the parameters.
    pub fn new(config: &Config) -> Self {
        let (wheel, material) = (&config.wheel, Isotropic::from(&config.material));
        Self {
            outer_radius: wheel.radius,
            hub_radius: wheel.hub_radius,
            poissons_ratio: config.material.poissons_ratio,
            swelling: material.layer_expansion(),
            membrane: material.layer_pressure(),
        }
    }

    /// Growth [m] of the outer radius at a mean temperature [K] of the annulus over that of the hub.
    fn radius_growth(&self, mean: f64) -> f64 {
        annulus_growth(mean, self.swelling, self.poissons_ratio, self.outer_radius, self.hub_radius)
    }

    /// Writes the deformation that belongs to the temperatures `seen` at the positions `x` [m].
    pub fn deform(&self, x: &[f64], seen: &Observation, out: &mut ThermalDeformation) {
        out.radius_growth = self.radius_growth(seen.temperatures.wheel_mean);
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
