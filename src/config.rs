//! Parameters of a run: plain data, validated, no derived quantities.
//!
//! Everything is SI. Masses, inertias and forces are those of the *whole wheel*; the two-dimensional model works per
//! metre of width and [`ModelParameters::contact_width`] maps one to the other. The presets under `resources/` are
//! complete [`Config`] files.

use serde::{Deserialize, Serialize};

/// All parameters of one wheel on one rail.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Config {
    /// Map to the whole wheel and size of the contact zone.
    pub model: ModelParameters,
    /// The wheel.
    pub wheel: Wheel,
    /// The vehicle.
    pub vehicle: Vehicle,
    /// The rail.
    pub rail: Rail,
    /// Material of both bodies.
    pub material: Material,
    /// Friction.
    pub friction: Friction,
    /// Heat.
    pub thermal: Thermal,
    /// Parts of the physics.
    pub physics: Physics,
    /// Meshes.
    pub mesh: MeshParameters,
    /// Numerical choices.
    pub solver: SolverParameters,
    /// Start state.
    pub initial: Initial,
    /// What may change during a run.
    pub tuning: Tuning,
}

/// Map between the two-dimensional model and the wheel.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ModelParameters {
    /// Width of the line contact [m]: forces of the wheel = width × forces of the plane model.
    pub contact_width: f64,
    /// Wheel load [N] for which the mesh is laid out; the candidate contact zone carries at least twice this load.
    pub nominal_load: f64,
}

/// Deformable annulus on a rigid hub.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Wheel {
    /// Outer radius `r_o` [m].
    pub radius: f64,
    /// Radius of the rigid hub `r_i` [m].
    pub hub_radius: f64,
    /// Unsprung mass fixed to the hub (axle, discs, gears) [kg], moving in x and y.
    pub hub_mass: f64,
    /// Its moment of inertia about the axle [kg m²].
    pub hub_inertia: f64,
}

/// What the wheel pulls along.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Vehicle {
    /// The wheel's share of the vehicle [kg], moving in x only (the suspension carries it vertically).
    pub mass: f64,
}

/// Plate below the wheel, fixed at its base.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Rail {
    /// Modelled length `b` [m].
    pub length: f64,
    /// Height `h` [m].
    pub height: f64,
}

/// Isotropic linear elastic material of both bodies.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Material {
    /// Young's modulus [Pa].
    pub youngs_modulus: f64,
    /// Poisson's ratio [1].
    pub poissons_ratio: f64,
    /// Density [kg/m³].
    pub density: f64,
    /// Coefficient of linear thermal expansion [1/K].
    pub expansion: f64,
    /// Thermal conductivity [W/(m K)].
    pub conductivity: f64,
    /// Specific heat capacity [J/(kg K)].
    pub specific_heat: f64,
}

/// Coulomb friction.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Friction {
    /// Friction coefficient μ [1]; start value of the input `rail.friction`.
    pub coefficient: f64,
}

/// Heat in wheel, rail and contact.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Thermal {
    /// Whether temperatures are computed at all.
    pub enabled: bool,
    /// Temperature of hub, air and arriving rail [K].
    pub reference: f64,
    /// Excess temperature of the wheel over the reference at the start [K].
    pub wheel_excess: f64,
    /// Contact conductance `k_c` [W/(m² K)].
    pub conductance: f64,
    /// How the conductance depends on pressure.
    pub conductance_law: ConductanceLaw,
    /// Pressure at which the pressure-dependent conductance has the value above [Pa].
    pub reference_pressure: f64,
    /// Fraction `γ_f` of the friction power that heats wheel and rail [1].
    pub heat_ratio: f64,
    /// Share of that heat first put into the wheel [1]; conduction through the contact decides where it goes.
    pub wheel_share: f64,
    /// Hub of the wheel.
    pub hub: Hub,
    /// Coefficient of convection from tread and rail head to the air [W/(m² K)].
    pub convection: f64,
    /// Largest speed at which the thermal layer is resolved [m/s].
    pub max_speed: f64,
    /// Smallest load relative to the nominal one at which the patch is resolved [1].
    pub smallest_load_ratio: f64,
    /// Angle of a brake block from the contact point, leading side positive [rad].
    pub tread_angle: f64,
    /// Arc covered by a brake block [rad].
    pub tread_width: f64,
    /// Number of brake blocks: one, or two mirrored ones that share `drive.tread_heat`.
    pub tread_blocks: usize,
}

/// Contact conductance law.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ConductanceLaw {
    /// Independent of pressure.
    Constant,
    /// Proportional to `p^0.95`.
    Pressure,
}

/// Thermal boundary condition of the hub.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Hub {
    /// Held at the reference temperature.
    Fixed,
    /// No heat passes.
    Insulated,
}

/// Switches for parts of the physics.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Physics {
    /// Centrifugal load of the spinning wheel.
    pub centrifugal: bool,
    /// Thermal expansion and stress act back on the contact.
    pub thermal_expansion: bool,
    /// Reversible (Gough–Joule) heating of compressed material.
    pub thermoelastic_heating: bool,
}

/// Layout of the graded meshes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MeshParameters {
    /// Elements per Hertzian half-width at the nominal load.
    pub elements_per_half_width: usize,
}

/// Numerical choices.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SolverParameters {
    /// How the bodies answer contact tractions.
    pub response: Response,
    /// Number of vibration modes kept for the wheel (reduced response).
    pub modes_wheel: usize,
    /// Number of vibration modes kept for the rail (reduced response).
    pub modes_rail: usize,
    /// Implicit time discretisation.
    pub time_scheme: TimeScheme,
    /// Weight of the new time level in the θ scheme (1: backward Euler, 0.5: Crank–Nicolson).
    pub theta: f64,
}

/// Body response behind the contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Response {
    /// Vibration modes plus residual flexibility.
    Reduced,
    /// The full finite-element equations.
    Full,
}

/// Implicit time discretisation of momentum and slip.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum TimeScheme {
    /// Second-order backward differences, restarted by backward Euler.
    Bdf2,
    /// Backward Euler.
    BackwardEuler,
    /// The thesis's θ family (Paper D, section 5.3.2).
    Theta,
}

/// Stationary rolling state from which the run starts.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Initial {
    /// Translational velocity [m/s].
    pub velocity: f64,
    /// Creepage `2 (V − rω)/(V + rω)` [1].
    pub creepage: f64,
}

/// What may change during a run: nothing that is computed in advance depends on it.
///
/// The friction coefficient of a step is
///
/// `μ(s, T) = rail.friction · (A + (1 − A) e^{−B|V − rω|}) · max(m, 1 − K (T − T_ref))`
///
/// with nominal slip velocity and mean contact temperature (O. Polach, *Wear* 258 (2005), for the falling part). Both are
/// predicted for the coming step: the slip velocity from its rate, the temperature as `T − T_ref = θ μ` with the heating
/// θ extrapolated, which makes the last factor `1/(1 + K θ · rail.friction · (…))`. Within a step the friction cone is
/// exact.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Tuning {
    /// `A`: share of the friction coefficient that remains at high slip velocity [1]; 1 for constant friction.
    pub falling_ratio: f64,
    /// `B`: decay with the slip velocity [s/m].
    pub falling_decay: f64,
    /// `K`: decay with the contact temperature [1/K]; 0 for constant friction.
    pub softening: f64,
    /// `m`: share of the coefficient that remains at high temperature [1].
    pub softening_floor: f64,
    /// Austenitisation temperature Ac1 [K], above which contact time is counted.
    pub austenitisation: f64,
    /// Largest internal step [s]; longer communication steps are divided evenly.
    pub max_step: f64,
    /// Local error of an internal step that halves it: contact force relative to the nominal load, contact temperature
    /// relative to its rise or 100 K [1]; 0: no error control.
    pub tolerance: f64,
}

/// FMI name, value, smallest and largest meaningful value of each numeric parameter; some depend on others besides, see
/// [`Config::validate`].
type NumericParameter = (&'static str, fn(&Config) -> f64, f64, f64);

const NUMERIC_PARAMETERS: [NumericParameter; 41] = [
    ("model.contact_width", |c| c.model.contact_width, 1e-4, 10.0),
    ("model.nominal_load", |c| c.model.nominal_load, 1e-3, 1e9),
    ("wheel.radius", |c| c.wheel.radius, 1e-2, 10.0),
    ("wheel.hub_radius", |c| c.wheel.hub_radius, 2e-4, 9.0),
    ("wheel.hub_mass", |c| c.wheel.hub_mass, 0.0, 1e6),
    ("wheel.hub_inertia", |c| c.wheel.hub_inertia, 0.0, 1e6),
    ("vehicle.mass", |c| c.vehicle.mass, 0.0, 1e9),
    ("rail.length", |c| c.rail.length, 2e-3, 100.0),
    ("rail.height", |c| c.rail.height, 2e-4, 10.0),
    ("material.youngs_modulus", |c| c.material.youngs_modulus, 1e5, 1e13),
    ("material.poissons_ratio", |c| c.material.poissons_ratio, 0.0, 0.49),
    ("material.density", |c| c.material.density, 1.0, 1e5),
    ("material.expansion", |c| c.material.expansion, 0.0, 1e-3),
    ("material.conductivity", |c| c.material.conductivity, 1e-3, 1e5),
    ("material.specific_heat", |c| c.material.specific_heat, 1.0, 1e5),
    ("friction.coefficient", |c| c.friction.coefficient, 0.0, 10.0),
    ("friction.falling_ratio", |c| c.tuning.falling_ratio, 0.0, 1.0),
    ("friction.falling_decay", |c| c.tuning.falling_decay, 0.0, 1e3),
    ("friction.softening", |c| c.tuning.softening, 0.0, 1.0),
    ("friction.softening_floor", |c| c.tuning.softening_floor, 0.0, 1.0),
    ("thermal.reference", |c| c.thermal.reference, 1.0, 1e4),
    ("thermal.wheel_excess", |c| c.thermal.wheel_excess, -1e3, 5e3),
    ("thermal.conductance", |c| c.thermal.conductance, 0.0, 1e12),
    ("thermal.reference_pressure", |c| c.thermal.reference_pressure, 1.0, 1e12),
    ("thermal.heat_ratio", |c| c.thermal.heat_ratio, 0.0, 1.0),
    ("thermal.wheel_share", |c| c.thermal.wheel_share, 0.0, 1.0),
    ("thermal.convection", |c| c.thermal.convection, 0.0, 1e5),
    ("thermal.max_speed", |c| c.thermal.max_speed, 0.1, 200.0),
    ("thermal.smallest_load_ratio", |c| c.thermal.smallest_load_ratio, 0.05, 1.0),
    ("thermal.tread_angle", |c| c.thermal.tread_angle, -3.2, 3.2),
    ("thermal.tread_width", |c| c.thermal.tread_width, 1e-3, 6.2),
    ("thermal.tread_blocks", |c| c.thermal.tread_blocks as f64, 1.0, 2.0),
    ("thermal.austenitisation", |c| c.tuning.austenitisation, 1.0, 1e4),
    ("mesh.elements_per_half_width", |c| c.mesh.elements_per_half_width as f64, 4.0, 80.0),
    ("solver.modes_wheel", |c| c.solver.modes_wheel as f64, 1.0, 200.0),
    ("solver.modes_rail", |c| c.solver.modes_rail as f64, 1.0, 200.0),
    ("solver.theta", |c| c.solver.theta, 0.5, 1.0),
    ("solver.max_step", |c| c.tuning.max_step, 1e-6, 1.0),
    ("solver.tolerance", |c| c.tuning.tolerance, 0.0, 1.0),
    ("initial.velocity", |c| c.initial.velocity, -200.0, 200.0),
    ("initial.creepage", |c| c.initial.creepage, -1.99, 2.0),
];

/// Smallest and largest meaningful value of the numeric parameter of that FMI name; without limits if there is none.
pub fn parameter_range(name: &str) -> [f64; 2] {
    let row = NUMERIC_PARAMETERS.iter().find(|row| row.0 == name);
    row.map_or([f64::NEG_INFINITY, f64::INFINITY], |&(_, _, low, high)| [low, high])
}

/// A parameter outside its range.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{name} = {value} is outside its range: {range}")]
pub struct ConfigError {
    /// FMI name of the parameter, or what follows from parameters.
    pub name: &'static str,
    pub value: f64,
    /// Allowed range, in words.
    pub range: String,
}

/// Ten significant digits: limits that follow from other parameters carry rounding errors.
fn rounded(value: f64) -> f64 {
    format!("{value:.9e}").parse().unwrap_or(value)
}

impl Config {
    /// This configuration with those values of another one that may change during a run: nothing that has been
    /// computed in advance depends on them.
    pub fn tuned_like(&self, other: &Config) -> Config {
        Config { tuning: other.tuning.clone(), ..self.clone() }
    }

    /// Refuses values for which the model has no meaning; the message names parameter, value and range.
    pub fn validate(&self) -> Result<(), ConfigError> {
        let c = self;
        let within = |name, value: f64, low: f64, high: f64| {
            if value >= low && value <= high {
                Ok(())
            } else {
                let range = format!("{} to {}", rounded(low), rounded(high));
                Err(ConfigError { name, value, range })
            }
        };
        for (name, value, low, high) in NUMERIC_PARAMETERS {
            within(name, value(c), low, high)?;
        }
        let radius = c.wheel.radius;
        within("wheel.hub_radius", c.wheel.hub_radius, 0.02 * radius, 0.9 * radius)?;
        within("rail.length", c.rail.length, 0.2 * radius, f64::INFINITY)?;
        within("rail.height", c.rail.height, 0.02 * radius, f64::INFINITY)?;
        if c.thermal.reference + c.thermal.wheel_excess <= 0.0 {
            let range = format!("above {} K (absolute zero)", -c.thermal.reference);
            return Err(ConfigError { name: "thermal.wheel_excess", value: c.thermal.wheel_excess, range });
        }
        Ok(())
    }
}
