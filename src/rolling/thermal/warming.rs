//! How far friction warms the contact within a step.

use crate::config::{Config, Material};
use crate::contact::Traction;
use crate::piecewise::weighted_mean;
use std::f64::consts::PI;

/// Rise of the surface temperature of two half-spaces that share a power per area.
#[derive(Clone, Copy, Debug)]
pub struct Warming {
    /// `πkρc` [W² s/(m⁴ K²)].
    inertia: f64,
    /// Part of the friction power that becomes heat here \[1].
    heat_ratio: f64,
}

impl Warming {
    /// Rise for the material of the parameters.
    pub fn new(config: &Config) -> Self {
        let Material { conductivity, density, specific_heat, .. } = config.material;
        Self { inertia: PI * conductivity * density * specific_heat, heat_ratio: config.thermal.heat_ratio }
    }

    /// Rise after `dt` \[s] under a unit of power per area, half of it in each body: `√(Δt/π)/√(kρc)` [K m²/W].
    pub fn unit(&self, dt: f64) -> f64 {
        (dt / self.inertia).sqrt()
    }

    /// Rise of the temperature of friction within `dt` \[s] per unit of friction coefficient \[K], under the slip and the
    /// pressure of a solved contact.
    pub fn by_friction(&self, traction: &Traction, dt: f64) -> f64 {
        let friction = &traction.friction;
        if friction.coefficient == 0.0 {
            return 0.0;
        }
        let dissipation = weighted_mean(&traction.pressure, &friction.dissipation.x, &friction.dissipation.value);
        self.heat_ratio * self.unit(dt) * dissipation / friction.coefficient
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::piecewise::Piecewise;

    /// A half-space under the flux q warms by `2q √(t/(π kρc))` (Carslaw & Jaeger, *Conduction of Heat in Solids*, 2.9), and each
    /// of two takes half of the power.
    #[test]
    fn two_half_spaces_warm_by_the_closed_form_of_half_the_flux_in_each() {
        let (flux, time) = (0.5, 4e-3);
        let expected = 2.0 * flux * (time / (PI * 50.0 * 7850.0 * 470.0)).sqrt();
        assert!((Warming::new(&Config::default()).unit(time) / expected - 1.0).abs() < 1e-12);
    }

    /// 2 MW/m² at a friction coefficient of 0.4, of which 90 % become heat.
    #[test]
    fn friction_warms_by_its_heat_over_its_coefficient() {
        let even = |value: f64| Piecewise { x: vec![-1e-3, 1e-3], value: vec![value; 2] };
        let mut traction = Traction { pressure: even(5e8), ..Traction::default() };
        (traction.friction.coefficient, traction.friction.dissipation) = (0.4, even(2e6));
        let mut config = Config::default();
        config.thermal.heat_ratio = 0.9;
        let warming = Warming::new(&config);
        let expected = 0.9 * 2e6 / 0.4 * warming.unit(4e-3);
        assert!((warming.by_friction(&traction, 4e-3) / expected - 1.0).abs() < 1e-12);
    }
}
