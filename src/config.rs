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
    /// Parts of the physics.
    pub physics: Physics,
    /// Meshes.
    pub mesh: MeshParameters,
    /// Numerical choices.
    pub solver: SolverParameters,
    /// Start state.
    pub initial: Initial,
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
}

/// Coulomb friction.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Friction {
    /// Friction coefficient μ [1]; start value of the input `rail.friction`.
    pub coefficient: f64,
}

/// Switches for parts of the physics.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Physics {
    /// Centrifugal load of the spinning wheel.
    pub centrifugal: bool,
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
    /// Largest internal step [s]; longer communication steps are divided evenly.
    pub max_step: f64,
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

/// A parameter outside its range.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{name} = {value} is outside its range: {range}")]
pub struct ConfigError {
    /// FMI name of the parameter.
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
        within("model.contact_width", c.model.contact_width, 1e-4, 10.0)?;
        within("model.nominal_load", c.model.nominal_load, 1e-3, 1e9)?;
        within("wheel.radius", c.wheel.radius, 1e-2, 10.0)?;
        within("wheel.hub_radius", c.wheel.hub_radius, 0.02 * c.wheel.radius, 0.9 * c.wheel.radius)?;
        within("wheel.hub_mass", c.wheel.hub_mass, 0.0, 1e6)?;
        within("wheel.hub_inertia", c.wheel.hub_inertia, 0.0, 1e6)?;
        within("vehicle.mass", c.vehicle.mass, 0.0, 1e9)?;
        within("rail.length", c.rail.length, 0.2 * c.wheel.radius, 100.0)?;
        within("rail.height", c.rail.height, 0.02 * c.wheel.radius, 10.0)?;
        within("material.youngs_modulus", c.material.youngs_modulus, 1e5, 1e13)?;
        within("material.poissons_ratio", c.material.poissons_ratio, 0.0, 0.49)?;
        within("material.density", c.material.density, 1.0, 1e5)?;
        within("friction.coefficient", c.friction.coefficient, 0.0, 10.0)?;
        within("mesh.elements_per_half_width", c.mesh.elements_per_half_width as f64, 4.0, 80.0)?;
        within("solver.modes_wheel", c.solver.modes_wheel as f64, 1.0, 200.0)?;
        within("solver.modes_rail", c.solver.modes_rail as f64, 1.0, 200.0)?;
        within("solver.theta", c.solver.theta, 0.5, 1.0)?;
        within("solver.max_step", c.solver.max_step, 1e-7, 1.0)?;
        within("initial.velocity", c.initial.velocity, -200.0, 200.0)?;
        within("initial.creepage", c.initial.creepage, -2.0, 2.0)
    }
}
