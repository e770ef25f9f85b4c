//! Heat of the contact and of the brake blocks on the temperature fields.

use crate::config::Config;
use crate::contact::Traction;
use crate::contact::film;
use crate::heat::{Exchange, HeatConfig, TreadHeat};
use crate::piecewise::Piecewise;

/// Arrangement of the brake blocks on the tread.
#[derive(Clone, Debug)]
pub struct BrakeBlocks {
    /// Angle of the leading one from the contact point [rad], arc of each [rad].
    angle: f64,
    arc: f64,
    /// One, or two mirrored ones that share the heat.
    sides: &'static [f64],
    /// Width of the line contact [m].
    width: f64,
}

impl BrakeBlocks {
    /// Arrangement for the parameters.
    pub fn new(config: &Config) -> Self {
        let thermal = &config.thermal;
        Self {
            angle: thermal.tread_angle,
            arc: thermal.tread_width,
            sides: if thermal.tread_blocks == 2 { &[1.0, -1.0] } else { &[1.0] },
            width: config.nominal_patch().width,
        }
    }

    /// Writes the heat of all blocks together [W] as segments of the tread.
    fn fill(&self, heat: f64, tread: &mut Vec<TreadHeat>) {
        if heat == 0.0 {
            return;
        }
        let share = heat / self.width / self.sides.len() as f64;
        tread.extend(self.sides.iter().map(|side| TreadHeat {
            angle: side * self.angle,
            width: self.arc,
            heat: share,
        }));
    }
}

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
    /// Writes the exchange of the contact and of the brake blocks with the heat `tread_heat` [W]. Patches of the new
    /// time act over the whole step; the heat of friction is the energy that the mechanical step has dissipated. Within
    /// the reach of a contact node it arises where the `film` of molten steel leaves friction.
    pub(super) fn fill(&self, blocks: &BrakeBlocks, tread_heat: f64, film: &Piecewise, exchange: &mut Exchange) {
        let contact = self.traction;
        exchange.clear();
        exchange.patches.extend(&contact.edges);
        copy(&contact.pressure, &mut exchange.pressure);
        if film.is_empty() {
            copy(&contact.friction.dissipation, &mut exchange.friction_power);
        } else {
            film::divided(&contact.friction.dissipation, film, &mut exchange.friction_power);
        }
        exchange.friction_excess = contact.friction.excess;
        blocks.fill(tread_heat, &mut exchange.tread);
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
