//! The history of the wheel's material beside the temperatures of the contact.

use super::sources::HeatStep;
use crate::config::{Config, Tuning};
use crate::contact::Traction;
use crate::damage::{ConductionScratch, Criteria, Damage, HotSpots, SpotLayout, TreadStep};
use crate::heat::{HeatModel, HeatState, Observation};
use crate::piecewise::interpolate;
use crate::rolling::profile::profile_depths;
use crate::rolling::state::Motion;

/// Follows the material of the wheel through the temperature field of the contact.
#[derive(Clone, Debug)]
pub struct MaterialHistory {
    /// Places that were heated in one piece, and the tread.
    pub spots: HotSpots,
    /// Weights of the heat model's modes at the depths of the spots' mesh.
    weights: Vec<f64>,
    /// Weights at the depths of profiles, of wheel and rail, and these depths [m].
    below: [Vec<f64>; 2],
    depths: Vec<f64>,
}

/// End of a step as the heat model found it.
pub struct ObservedStep<'a> {
    /// The step.
    pub step: HeatStep<'a>,
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
        let (weights, depths) = (heat.depth_weights(0, &spots.mesh().depth), profile_depths());
        let below = [0, 1].map(|body| heat.depth_weights(body, &depths));
        Self { spots, weights, below, depths }
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
        traction: &Traction,
        seen: &ObservedStep,
        scratch: &mut ConductionScratch,
    ) {
        let temperatures = &seen.observation.temperatures;
        let patch = traction.extent();
        let moment = TreadStep {
            dt: seen.step.dt,
            interim: seen.step.interim,
            angle: motion.angle,
            omega: motion.omega.now,
            contact_length: patch.map_or(0.0, |patch| patch.high - patch.low),
            contact_reach: patch.map_or(0.0, |patch| patch.high.max(-patch.low)),
            hottest: [temperatures.wheel_max, temperatures.rail_max],
            bulk: temperatures.wheel_mean,
            surface: (seen.zone, &seen.observation.surface[0]),
            criteria: seen.step.criteria,
        };
        let (heat, state) = seen.field;
        let column = |s: f64, out: &mut [f64]| heat.column(0, state, s, &self.weights, out);
        self.spots.advance(damage, &moment, &column, scratch);
    }

    /// Highest temperature at the depths of profiles of places that were heated in one piece \[K]; none: the reference.
    pub fn peaks(&self, damage: &Damage, reference: f64) -> Vec<f64> {
        self.over_depth(&damage.worst.peaks, reference)
    }

    /// Largest share of martensite that there is now at the depths of profiles, of the same places \[1].
    pub fn martensite(&self, damage: &Damage) -> Vec<f64> {
        self.over_depth(&damage.martensite(), 0.0)
    }

    /// Values at the depths of the spots' mesh at those of profiles; all are `none` if nothing is known.
    fn over_depth(&self, known: &[f64], none: f64) -> Vec<f64> {
        let at = |z: &f64| if known.is_empty() { none } else { interpolate(&self.spots.mesh().depth, known, *z) };
        self.depths.iter().map(at).collect()
    }

    /// Excess temperatures at the depths of profiles \[K]: of wheel and rail below the contact point, and of the wheel
    /// below the point of its tread that touches at the angle `point` of a wheel which is at `angle` now \[rad]. If that
    /// point lies on a place that is followed because the contact has heated it, they are those of that place.
    pub fn below(
        &self,
        damage: &Damage,
        (heat, state): (&dyn HeatModel, &HeatState),
        [angle, point]: [f64; 2],
    ) -> [Vec<f64>; 3] {
        let column = |body: usize, s: f64| {
            let mut column = vec![0.0; self.depths.len()];
            heat.column(body, state, s, &self.below[body], &mut column);
            column
        };
        let mesh = &self.spots.mesh().depth;
        let of_place = |place: Vec<f64>| self.depths.iter().map(|z| interpolate(mesh, &place, *z)).collect();
        let tread = self.spots.column(damage, point).map(of_place);
        let tread = tread.unwrap_or_else(|| column(0, self.spots.along_tread(point - angle)));
        [column(0, 0.0), column(1, 0.0), tread]
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::heat::Heat;
    use crate::rolling::thermal::exchange::heat_parameters;

    #[test]
    fn hot_places_conduct_as_the_material_does() {
        let (config, half_width) = (Config::default(), 6e-3);
        let zone = 1.5 * half_width;
        let heat = Heat::new(&heat_parameters(&config, half_width, zone, zone)).unwrap();
        let history = MaterialHistory::new(&config, &heat, half_width, zone);
        let (conductivity, capacity) = (50.0, 7850.0 * 470.0_f64);
        let mesh = history.spots.mesh();
        assert!((mesh.diffusivity() * capacity / conductivity - 1.0).abs() < 1e-12);
        assert!((mesh.effusivity() / (conductivity * capacity).sqrt() - 1.0).abs() < 1e-12);
        assert_eq!(history.spots.begin([0.0, 7.0]).peak, 293.0);
    }

    #[test]
    fn structures_are_told_by_the_temperatures_of_the_parameters() {
        let Criteria { austenitisation, martensite_start, critical_cooling, threshold } = criteria(&Tuning::default());
        assert_eq!([austenitisation, martensite_start, critical_cooling, threshold], [1000.0, 575.0, 50.0, 300.0]);
    }
}
