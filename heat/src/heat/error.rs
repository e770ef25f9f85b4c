//! Errors of heat computations.

use crate::display::{display_number, display_range};

/// Reason why a heat computation has no answer.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum HeatError {
    /// A parameter out of its range.
    #[error("{name} = {} is outside its range: {}", display_number(*value), display_range(*range, "1"))]
    Range {
        /// Name of the parameter, or what follows from parameters.
        name: &'static str,
        /// Its value, in SI units.
        value: f64,
        /// Smallest and largest value.
        range: [f64; 2],
    },
    /// An infinite or undefined input.
    #[error("{name} is {value}: not a usable number")]
    Input {
        /// Its name.
        name: &'static str,
        /// Its value, in the unit of the input.
        value: f64,
    },
    /// Profiles and intervals of the surface that cannot be computed with, in words.
    #[error("{0}")]
    Exchange(String),
    /// A step too short or too long to compute.
    #[error("heat step of {dt} s is outside {shortest} to {longest} s")]
    StepSize {
        /// Its size \[s].
        dt: f64,
        /// Shortest step \[s].
        shortest: f64,
        /// Longest step \[s].
        longest: f64,
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
         {iterations} iterations; steps shorter than {direct_below} s (solver.max_step) need none"
    )]
    NotConverged {
        /// Relative residual reached \[1].
        residual: f64,
        /// Iterations done.
        iterations: usize,
        /// Steps below this one need no correction \[s].
        direct_below: f64,
    },
    /// Temperatures beyond those of everything that acts, without the heat or the room for it in the body that would
    /// bring them back.
    #[error(
        "temperatures reach {found} K over thermal.reference where {datum} K is the {extreme} that acts; a smaller \
         solver.max_step or thermal.conductance resolves the step"
    )]
    OutOfBounds {
        /// Lowest or highest excess temperature \[K].
        found: f64,
        /// Lowest or highest one that is possible \[K].
        datum: f64,
        /// Which of both: `coldest` or `hottest`.
        extreme: &'static str,
    },
    /// Melting whose extent was not found.
    #[error(
        "melting was found to within {change} K only; a smaller solver.max_step resolves the step, and \
         material.latent_heat = 0 leaves melting out"
    )]
    MeltingNotConverged {
        /// Last change of the latent part of the heat content, over the heat capacity \[K].
        change: f64,
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
