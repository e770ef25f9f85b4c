//! The history of the wheel's material beside the temperatures of the contact.

use super::exchange::ThermalContact;
use crate::config::{Config, Tuning};
use crate::damage::{ConductionScratch, Criteria, Damage, HotSpots, SpotLayout, TreadStep};
use crate::heat::{HeatModel, HeatState, Observation};
use crate::piecewise::interpolate;
use crate::rolling::state::Motion;

/// Follows the material of the wheel through the temperature field of the contact.
#[derive(Clone, Debug)]
pub struct MaterialHistory {
    spots: HotSpots,
    /// Weights of the heat model's modes at the depths of the spots' mesh.
    weights: Vec<f64>,
}

/// End of a step as the heat model found it.
pub struct ObservedStep<'a> {
    /// Length of the step \[s].
    pub dt: f64,
    /// The heat model with its state.
    pub field: (&'a dyn HeatModel, &'a HeatState),
    /// Observation of that state.
    pub observation: &'a Observation,
    /// Positions at which the surface is known \[m].
    pub zone: &'a [f64],
}

impl MaterialHistory {
    /// History for contact within `zone` \[m] of the contact point, at the half-width `half_width` \[m] under the
    /// nominal load.
    pub fn new(config: &Config, heat: &dyn HeatModel, half_width: f64, zone: f64) -> Self {
        let (wheel, material, thermal) = (&config.wheel, &config.material, &config.thermal);
        let spots = HotSpots::new(&SpotLayout {
            radius: wheel.radius,
            hub_radius: wheel.hub_radius,
            half_width,
            zone,
            conductivity: material.conductivity,
            heat_capacity: material.density * material.specific_heat,
            convection: thermal.convection,
            reference: thermal.reference,
            resolution: config.damage.resolution,
        });
        let weights = heat.depth_weights(&spots.mesh().depth);
        Self { spots, weights }
    }

    /// Damage of a wheel at the start.
    pub fn begin(&self, observation: &Observation) -> Damage {
        let temperatures = &observation.temperatures;
        self.spots.begin([temperatures.wheel_max, temperatures.rail_max])
    }

    /// Advances a history by a step that ended with the `motion` of the wheel.
    pub fn advance(
        &self,
        damage: &mut Damage,
        motion: &Motion,
        criteria: Criteria,
        contact: &ThermalContact,
        seen: &ObservedStep,
        scratch: &mut ConductionScratch,
    ) {
        let temperatures = &seen.observation.temperatures;
        let patch = contact.traction.extent();
        let moment = TreadStep {
            dt: seen.dt,
            angle: motion.angle,
            omega: motion.omega.now,
            contact_length: patch.map_or(0.0, |patch| patch.high - patch.low),
            contact_reach: patch.map_or(0.0, |patch| patch.high.max(-patch.low)),
            hottest: [temperatures.wheel_max, temperatures.rail_max],
            bulk: temperatures.wheel_mean,
            surface: (seen.zone, &seen.observation.surface[0]),
            criteria,
        };
        let (heat, state) = seen.field;
        let column = |s: f64, out: &mut [f64]| heat.wheel_column(state, s, &self.weights, out);
        self.spots.advance(damage, &moment, &column, scratch);
    }

    /// Highest temperature at given depths \[m] of places that were heated in one piece \[K]; none: the reference.
    pub fn peaks(&self, damage: &Damage, depths: &[f64], reference: f64) -> Vec<f64> {
        let known = &damage.peaks;
        let at = |z: &f64| if known.is_empty() { reference } else { interpolate(&self.spots.mesh().depth, known, *z) };
        depths.iter().map(at).collect()
    }

    /// Test that a history has the dimensions of this model.
    pub fn fits(&self, damage: &Damage) -> bool {
        self.spots.fits(damage)
    }
}

/// Limits that decide about the structure of the steel.
pub fn criteria(tuning: &Tuning) -> Criteria {
    Criteria {
        austenitisation: tuning.austenitisation,
        martensite_start: tuning.martensite_start,
        critical_cooling: tuning.critical_cooling,
        threshold: tuning.threshold,
    }
}
