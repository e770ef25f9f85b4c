//! Parameters of the heat model.

use crate::config::{ConfigError, Material, Rail, Thermal, Wheel, display_range};
use serde::{Deserialize, Serialize};

/// Parameters of both bodies, and the contact that their meshes are laid out for.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HeatConfig {
    /// Radii of the wheel.
    pub wheel: Wheel,
    /// Length (contact point in its middle) and height of the rail.
    pub rail: Rail,
    /// Density, specific heat and conductivity of both bodies.
    pub material: Material,
    /// Hub, air, contact conductance, friction heat, and the speed and load that are resolved.
    pub thermal: Thermal,
    /// Width over which heat enters at the contact \[m]; all heat is given and returned over this width.
    pub contact_width: f64,
    /// Surface elements per smallest half-width, away from its edges.
    pub elements_per_half_width: usize,
    /// Half-width of the contact at the nominal load \[m]; the mesh is finest at its edges.
    pub half_width: f64,
    /// Half-length of the finely meshed zone that ordinary patches and their friction heat stay within \[m].
    pub zone: f64,
    /// Half-length of the zone that every patch and all friction heat stay within \[m]; beyond [`Self::zone`] the
    /// elements grow.
    pub reach: f64,
}

impl HeatConfig {
    /// Smallest half-width that has to be resolved \[m]: that of a line contact at the smallest load.
    pub fn smallest_half_width(&self) -> f64 {
        self.half_width * self.thermal.smallest_load_ratio.sqrt()
    }

    /// Heat capacity `ρc` [J/(m³ K)].
    pub fn heat_capacity(&self) -> f64 {
        self.material.density * self.material.specific_heat
    }

    /// Thermal diffusivity `κ = k/ρc` [m²/s].
    pub fn diffusivity(&self) -> f64 {
        self.material.conductivity / self.heat_capacity()
    }

    /// Refuses geometry on which no mesh can be laid, and steel that is molten before it begins to melt; the error
    /// names the parameter and its range.
    pub fn validate(&self) -> Result<(), ConfigError> {
        let c = self;
        let radius = c.wheel.radius;
        let within = |name, value: f64, low: f64, high: f64| {
            if value >= low && value <= high {
                Ok(())
            } else {
                Err(ConfigError::Range { name, value, range: display_range([low, high], "1") })
            }
        };
        let material = &c.material;
        // The molten fraction rises from the solidus to the liquidus; the other way round it has no meaning.
        within("material.liquidus", material.liquidus, material.solidus.next_up(), f64::INFINITY)?;
        let longest = c.zone.max(c.reach);
        within("rail.length", c.rail.length, 4.0 * longest, f64::INFINITY)?;
        within("half-width at model.nominal_load", c.half_width, 1e-6, 0.1 * radius)?;
        within("half-length of the contact zone", c.zone, c.half_width, 0.2 * radius)?;
        within("half-length of the zone for wide patches", c.reach, c.zone, 0.2 * radius)?;
        let elements = c.zone / c.smallest_half_width() * c.elements_per_half_width as f64;
        let name = "contact zone in elements, from thermal.smallest_load_ratio and mesh.elements_per_half_width";
        within(name, elements, 2.0, 500.0)
    }
}
