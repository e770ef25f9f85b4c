//! Melting of steel: latent heat as a plateau of the heat capacity between solidus and liquidus.
//!
//! The fields of the heat model are heat contents over `ρc`: `h = T + (L/c) f(T)` with the molten fraction f, linear
//! from the solidus to the liquidus. Where nothing melts, `h` is the temperature itself. All temperatures here are
//! excess temperatures over the reference \[K].

use super::parameters::HeatParameters;

/// Relation of heat content and temperature.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Melting {
    /// Excess temperature at which melting begins \[K].
    pub solidus: f64,
    /// Excess temperature at which it is complete \[K].
    pub liquidus: f64,
    /// Latent heat over specific heat \[K].
    pub latent: f64,
}

impl Melting {
    /// Relation for the material and the reference temperature; `None` without latent heat, and if everything is molten
    /// anyway.
    pub fn new(config: &HeatParameters) -> Option<Self> {
        let (material, reference) = (&config.material, config.reference);
        let solidus = material.solidus - reference;
        (material.latent_heat > 0.0 && solidus > 0.0).then(|| Self {
            solidus,
            liquidus: material.liquidus - reference,
            latent: material.latent_heat / material.specific_heat,
        })
    }

    /// Molten fraction at a heat content over `ρc` \[1].
    pub fn fraction(&self, content: f64) -> f64 {
        ((content - self.solidus) / (self.liquidus - self.solidus + self.latent)).clamp(0.0, 1.0)
    }

    /// Part of the heat content that is no temperature, over `ρc` \[K].
    pub fn latent_part(&self, content: f64) -> f64 {
        self.latent * self.fraction(content)
    }

    /// Temperature at a heat content over `ρc` \[K].
    pub fn temperature(&self, content: f64) -> f64 {
        content - self.latent_part(content)
    }

    /// Molten fraction at a temperature \[1].
    pub fn molten_fraction(&self, temperature: f64) -> f64 {
        ((temperature - self.solidus) / (self.liquidus - self.solidus)).clamp(0.0, 1.0)
    }

    /// Heat content over `ρc` at a temperature \[K].
    pub fn content(&self, temperature: f64) -> f64 {
        temperature + self.latent * self.molten_fraction(temperature)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn heat_content_and_temperature_are_inverse_and_the_plateau_holds_the_latent_heat() {
        let melting = Melting { solidus: 1430.0, liquidus: 1510.0, latent: 574.0 };
        for temperature in [-20.0, 0.0, 1430.0, 1450.0, 1510.0, 1600.0] {
            assert!((melting.temperature(melting.content(temperature)) - temperature).abs() < 1e-9);
        }
        let plateau = melting.content(1510.0) - melting.content(1430.0);
        assert!((plateau - (80.0 + 574.0)).abs() < 1e-9);
        assert_eq!(melting.content(1429.0), 1429.0);
        assert!((melting.fraction(melting.content(1470.0)) - 0.5).abs() < 1e-12);
    }
}
