//! Temperature of wheel and rail: resolved under the contact, coupled, at any speed and step size.
//!
//! Both fields live on tensor meshes of their own (streamlines × depth), graded from the thermal boundary layer
//! `δ = √(2κa/V)` (tens of micrometres) to the size of the bodies. Everything is per metre of width; temperatures are
//! excess temperatures over the reference \[K]. Forward rolling is positive: at the contact the material of both bodies
//! flows towards −x.
//!
//! ```text
//! wheel    ρc (∂_t T − ω ∂_φ T) = k ΔT      hub: T = 0 or insulated; tread: q_tread, h (T − T_air)
//! rail     ρc (∂_t T − V ∂_x T) = k ΔT      inflow: ρc|V|T − k ∂_n T = 0; outflow: k ∂_n T = 0; base insulated
//! contact  q → wheel = β γ_f |τ s| − k_c (T_w − T_r),   q → rail = (1 − β) γ_f |τ s| + k_c (T_w − T_r)
//! ```
//!
//! A. Draganis, PhD thesis, Chalmers 2014: Paper B, section 4 (energy balance in the moving frame), Paper C, section
//! 4.2 (conductance, friction heat). The tensor meshes with streamwise upwinding in every term replace its triangles.
//!
//! Limits: line contact in the plane; what acts is held over a step, so that a run under changing loads and speeds is first
//! order in time, although the formula is of second order under constant ones; a hot spot carried round the wheel is smeared where the mesh along the tread is
//! coarse; distances along the surface stand for x in the contact zone (they differ by `x²/6r²`); convection to the air
//! acts under the contact, too.

mod exchange;
mod model;
mod parameters;
mod tensor;

pub use crate::piecewise::Interval;
pub use exchange::{Exchange, TreadHeat};
pub use model::{HeatFlows, HeatModel, Observation, Temperatures};
pub use parameters::HeatConfig;
pub use tensor::{Heat, HeatState, LARGEST_STEP, SMALLEST_STEP, Scratch, TemperatureField};

use crate::config::ConfigError;
use crate::piecewise::PiecewiseError;

/// A heat computation that has no answer.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum HeatError {
    /// A parameter out of its range.
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// An infinite or undefined input.
    #[error("{name} is {value}: not a usable number")]
    Input {
        /// What it is.
        name: &'static str,
        /// Its value, in the unit of the input.
        value: f64,
    },
    /// A profile that is no function of x.
    #[error("{name}: {why}")]
    Profile {
        /// What it is a profile of.
        name: &'static str,
        /// What is wrong with it.
        why: PiecewiseError,
    },
    /// An interval of the surface without meaning.
    #[error("contact patch from {low} m to {high} m: its ends must be numbers and ascend")]
    Patch {
        /// First end \[m].
        low: f64,
        /// Second end \[m].
        high: f64,
    },
    /// Something that acts beyond the finely meshed surface.
    #[error("{name} reaches x = {x} m, outside the contact zone of ±{zone} m")]
    OutsideZone {
        /// What acts there.
        name: &'static str,
        /// Where it ends \[m].
        x: f64,
        /// Half-length of the zone \[m].
        zone: f64,
    },
    /// A step too short or too long to compute.
    #[error("heat step of {dt} s is outside {SMALLEST_STEP} to {LARGEST_STEP} s")]
    StepSize {
        /// Its size \[s].
        dt: f64,
    },
    /// A state of another model.
    #[error("temperature fields of {found} values do not belong to this mesh of {expected}")]
    StateSize {
        /// Number of values of this model.
        expected: usize,
        /// Number of values found.
        found: usize,
    },
    /// Modes over the depth that were not found.
    #[error(
        "the {size} temperature modes over the depth of a body were not found; wheel.hub_radius, rail.height and \
         thermal.max_speed set its layers"
    )]
    Eigen {
        /// Number of unknowns.
        size: usize,
    },
    /// Coefficients beyond the range of numbers.
    #[error(
        "the heat equations of {unknowns} unknowns have no finite solution; material.conductivity, thermal.conductance \
         and thermal.convection enter them"
    )]
    Singular {
        /// Number of unknowns.
        unknowns: usize,
    },
    /// Heat that is supplied for ever and not removed.
    #[error(
        "no stationary temperatures were found (relative residual {residual:.2e} after {iterations} iterations): \
         thermal.hub = fixed, thermal.convection > 0 or a rail that moves under the contact lets heat out"
    )]
    NoStationaryState {
        /// Relative residual reached \[1].
        residual: f64,
        /// Iterations done.
        iterations: usize,
    },
    /// The correction for the curvature of a nearly standing wheel stopped early.
    #[error(
        "temperatures of a wheel that hardly turns were found to a relative residual of {residual:.2e} only, in \
         {iterations} iterations; steps shorter than {} s (solver.max_step) need none",
        tensor::CURVED_STEP
    )]
    NotConverged {
        /// Relative residual reached \[1].
        residual: f64,
        /// Iterations done.
        iterations: usize,
    },
    /// Temperatures beyond the range of numbers.
    #[error("temperatures are not finite after a step of {dt} s at V = {velocity} m/s, ω = {omega} rad/s")]
    NotFinite {
        /// Step \[s].
        dt: f64,
        /// Velocity [m/s].
        velocity: f64,
        /// Angular velocity [rad/s].
        omega: f64,
    },
}
