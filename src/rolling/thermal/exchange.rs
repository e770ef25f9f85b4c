//! Exchange of the contact with the temperature fields.

use crate::config::Config;
use crate::contact::Traction;
use crate::contact::film;
use crate::heat::{Exchange, HeatConfig};
use crate::piecewise::Piecewise;

/// A contact as the temperatures see it.
pub struct ThermalContact<'a> {
    /// Forces of the contact.
    pub traction: &'a Traction,
    /// Reversible temperatures of the surfaces of wheel and rail besides those of the fields \[K]; empty without.
    pub reversible: [Piecewise; 2],
    /// Temperature of the arriving rail over the reference \[K].
    pub arriving: f64,
}

impl ThermalContact<'_> {
    /// Writes the exchange of the contact, which has no other sources than friction. Patches of the new time act over
    /// the whole step; the heat of friction is the energy that the mechanical step has dissipated. Within
    /// the reach of a contact node it arises where the `film` of molten steel leaves friction.
    pub(super) fn fill(&self, film: &Piecewise, exchange: &mut Exchange) {
        let contact = self.traction;
        exchange.clear();
        exchange.patches.extend(&contact.conducting);
        if film.is_empty() {
            copy(&contact.friction.dissipation, &mut exchange.friction_power);
        } else {
            film::undone(&contact.friction.dissipation, film, &mut exchange.friction_power);
            copy(film, &mut exchange.film);
        }
        exchange.friction_excess = contact.friction.excess;
        exchange.arriving = self.arriving;
        let [wheel, rail] = &self.reversible;
        for ((&x, of_wheel), of_rail) in wheel.x.iter().zip(&wheel.value).zip(&rail.value) {
            exchange.reversible.push(x, of_wheel - of_rail);
        }
    }
}

fn copy(from: &Piecewise, to: &mut Piecewise) {
    to.x.clone_from(&from.x);
    to.value.clone_from(&from.value);
}

/// Parameters of the heat model for a configuration; `half_width` at the nominal load, `zone` of ordinary patches and
/// `reach` of wide ones [m].
pub fn heat_config(config: &Config, half_width: f64, zone: f64, reach: f64) -> HeatConfig {
    HeatConfig {
        wheel: config.wheel.clone(),
        rail: config.rail.clone(),
        material: config.material.clone(),
        thermal: config.thermal.clone(),
        contact_width: config.nominal_patch().width,
        elements_per_half_width: config.mesh.elements_per_half_width,
        half_width,
        zone,
        reach,
    }
}
