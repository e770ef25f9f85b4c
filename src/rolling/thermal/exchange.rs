//! Exchange of the contact with the temperature fields.

use crate::config::{Config, CrossSection};
use crate::contact::Traction;
use crate::contact::film;
use crate::heat::{Exchange, HeatMaterial, HeatParameters, Widths};
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
/// `reach` of wide ones \[m].
pub fn heat_parameters(config: &Config, half_width: f64, zone: f64, reach: f64) -> HeatParameters {
    let Config { wheel, rail, material, thermal, .. } = config;
    let widths = match thermal.cross_section {
        CrossSection::Bodies => Some(Widths {
            rim: thermal.rim_width,
            rim_depth: thermal.rim_depth,
            web: thermal.web_width,
            boss_radius: thermal.boss_radius,
            boss: thermal.rim_width * thermal.boss,
            head: thermal.head_width,
            block: thermal.block_width,
        }),
        CrossSection::Contact => None,
    };
    HeatParameters {
        radius: wheel.radius,
        hub_radius: wheel.hub_radius,
        rail_length: rail.length,
        rail_height: rail.height,
        material: HeatMaterial {
            density: material.density,
            specific_heat: material.specific_heat,
            conductivity: material.conductivity,
            latent_heat: material.latent_heat,
            solidus: material.solidus,
            liquidus: material.liquidus,
        },
        widths,
        reference: thermal.reference,
        hub_held: thermal.hub.is_held(),
        convection: thermal.convection,
        conductance: thermal.conductance,
        heat_ratio: thermal.heat_ratio,
        wheel_share: thermal.wheel_share,
        max_speed: thermal.max_speed,
        smallest_load_ratio: thermal.smallest_load_ratio,
        contact_width: config.nominal_patch().width,
        elements_per_half_width: config.mesh.elements_per_half_width,
        half_width,
        zone,
        reach,
    }
}
