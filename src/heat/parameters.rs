//! Parameters of the heat model.

use super::Conductance;
use crate::config::{ConfigError, display_range};
use serde::{Deserialize, Serialize};

/// Parameters of both bodies and of the meshes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HeatConfig {
    /// `k` [W/(m K)].
    pub conductivity: f64,
    /// `c` [J/(kg K)].
    pub specific_heat: f64,
    /// `ρ` [kg/m³].
    pub density: f64,
    /// `r_o` [m].
    pub wheel_radius: f64,
    /// `r_i` [m].
    pub hub_radius: f64,
    /// Length of the modelled rail [m], contact point in its middle.
    pub rail_length: f64,
    /// Height of the rail [m].
    pub rail_height: f64,
    /// Half-width of the contact at the nominal load [m]; the mesh is finest at its edges.
    pub half_width: f64,
    /// Smallest half-width that has to be resolved [m].
    pub smallest_half_width: f64,
    /// Half-length of the finely meshed zone that every patch and all friction heat stay within [m].
    pub zone: f64,
    /// Largest `|V|` or `|ω| r_o` [m/s] for which the thermal layer is resolved.
    pub max_speed: f64,
    /// Surface elements per smallest half-width (away from the edges).
    pub elements_per_half_width: usize,
    pub hub: HubCondition,
    pub conductance: Conductance,
    /// Fraction `γ_f` of the friction power that becomes heat in the two bodies [1].
    pub friction_fraction: f64,
    /// Share β of that heat that is put into the wheel; conduction through the contact decides where it goes [1].
    pub wheel_share: f64,
    /// Coefficient of convection from tread and rail head to the air [W/(m² K)]; zero: insulated.
    pub convection: f64,
    pub time_scheme: HeatTimeScheme,
}

/// Inner boundary of the wheel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum HubCondition {
    /// Held at the reference temperature.
    Fixed,
    Insulated,
}

/// Time discretisation of the energy balance.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum HeatTimeScheme {
    /// Two-stage, second order, L-stable.
    Sdirk2,
    BackwardEuler,
}

impl HeatConfig {
    /// Refuses geometry on which no mesh can be laid.
    pub fn validate(&self) -> Result<(), ConfigError> {
        let c = self;
        let within = |name, value: f64, low: f64, high: f64| {
            if value >= low && value <= high {
                Ok(())
            } else {
                Err(ConfigError { name, value, range: display_range([low, high], "1") })
            }
        };
        within("rail.length", c.rail_length, 4.0 * c.zone, f64::INFINITY)?;
        within("half-width at model.nominal_load", c.half_width, 1e-6, 0.1 * c.wheel_radius)?;
        within("half-length of the contact zone", c.zone, c.half_width, 0.2 * c.wheel_radius)?;
        let elements = c.zone / c.smallest_half_width * c.elements_per_half_width as f64;
        let name = "contact zone in elements, from thermal.smallest_load_ratio and mesh.elements_per_half_width";
        within(name, elements, 2.0, 500.0)
    }
}
