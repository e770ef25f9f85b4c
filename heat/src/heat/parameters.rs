//! Parameters of the heat model.

use crate::heat::error::HeatError;

/// Parameters of both bodies, and the contact that their meshes are laid out for.
#[derive(Clone, Debug, PartialEq)]
pub struct HeatParameters {
    /// Radius of the tread \[m].
    pub radius: f64,
    /// Radius of the hub \[m].
    pub hub_radius: f64,
    /// Length of the rail, whose middle is the contact point \[m].
    pub rail_length: f64,
    /// Height of the rail \[m].
    pub rail_height: f64,
    /// Density, heat and melting of both bodies.
    pub material: HeatMaterial,
    /// Widths of the bodies; `None`: both are as wide as the contact everywhere.
    pub widths: Option<Widths>,
    /// Absolute temperature of hub, air and arriving rail \[K].
    pub reference: f64,
    /// True if the hub has the reference temperature, false if it is insulated.
    pub hub_held: bool,
    /// Coefficient of convection to the air [W/(m² K)].
    pub convection: f64,
    /// Contact conductance between wheel and rail [W/(m² K)].
    pub conductance: f64,
    /// Fraction of the friction power that heats wheel and rail \[1].
    pub heat_ratio: f64,
    /// Share of the heat of friction that is put into the wheel first \[1]; conduction decides where it goes.
    pub wheel_share: f64,
    /// Largest speed at which the thermal layer is resolved [m/s].
    pub max_speed: f64,
    /// Smallest load over the nominal one at which the patch is resolved \[1].
    pub smallest_load_ratio: f64,
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

/// Steel as heat sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeatMaterial {
    /// Density [kg/m³].
    pub density: f64,
    /// Specific heat [J/(kg K)].
    pub specific_heat: f64,
    /// Conductivity [W/(m K)].
    pub conductivity: f64,
    /// Heat of melting [J/kg]; 0: melting is left out.
    pub latent_heat: f64,
    /// Absolute temperature at which melting begins \[K].
    pub solidus: f64,
    /// Absolute temperature at which melting is complete \[K].
    pub liquidus: f64,
}

/// Widths of the bodies below the contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Widths {
    /// Width of the wheel's rim \[m].
    pub rim: f64,
    /// Depth of the rim below the tread \[m].
    pub rim_depth: f64,
    /// Width of the wheel's web \[m].
    pub web: f64,
    /// Outer radius of the boss \[m]; below the radius of the hub there is none.
    pub boss_radius: f64,
    /// Width of the boss \[m].
    pub boss: f64,
    /// Width of the rail's head \[m].
    pub head: f64,
    /// Width of brake blocks \[m].
    pub block: f64,
}

impl HeatParameters {
    /// Smallest half-width that has to be resolved \[m]: that of a line contact at the smallest load.
    pub fn smallest_half_width(&self) -> f64 {
        self.half_width * self.smallest_load_ratio.sqrt()
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
    pub fn validate(&self) -> Result<(), HeatError> {
        let c = self;
        let within = |name, value: f64, low: f64, high: f64| {
            if value >= low && value <= high {
                Ok(())
            } else {
                Err(HeatError::Range { name, value, range: [low, high] })
            }
        };
        let material = &c.material;
        // The molten fraction rises from the solidus to the liquidus; the other way round it has no meaning.
        within("material.liquidus", material.liquidus, material.solidus.next_up(), f64::INFINITY)?;
        let longest = c.zone.max(c.reach);
        within("rail.length", c.rail_length, 4.0 * longest, f64::INFINITY)?;
        within("half-width at model.nominal_load", c.half_width, 1e-6, 0.1 * c.radius)?;
        within("half-length of the contact zone", c.zone, c.half_width, 0.2 * c.radius)?;
        within("half-length of the zone for wide patches", c.reach, c.zone, 0.2 * c.radius)?;
        let elements = c.zone / c.smallest_half_width() * c.elements_per_half_width as f64;
        let name = "contact zone in elements, from thermal.smallest_load_ratio and mesh.elements_per_half_width";
        within(name, elements, 2.0, 500.0)
    }
}
