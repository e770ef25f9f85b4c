//! Observables of a state, for the whole wheel in SI units.

use super::control::{creepage, slide};
use super::model::Model;
use super::profile::{PROFILE_POINTS, profile_points};
use super::state::State;
use super::suggested_step::suggested_step;
use crate::piecewise::Piecewise;
use serde::{Deserialize, Serialize};

/// Everything the model returns at a communication point.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Outputs {
    /// Contact force on the wheel in travel direction \[N].
    pub contact_force_x: f64,
    /// Contact force on the wheel upward \[N].
    pub contact_force_y: f64,
    /// Moment of the contact forces about the wheel centre, forward positive [N m].
    pub contact_moment: f64,
    /// Creepage `2 (V − rω)/(V + rω)`, braking positive \[1].
    pub contact_creepage: f64,
    /// Slide `(V − rω)/V` of EN 15595 \[1].
    pub contact_slide: f64,
    /// Nominal slip velocity `V − rω` [m/s].
    pub contact_slip_velocity: f64,
    /// Adhesion `F_x/F_y` \[1].
    pub contact_adhesion: f64,
    /// Utilisation `|F_x|/(μ F_y)` \[1].
    pub contact_utilisation: f64,
    /// Share of the contact length that sticks \[1].
    pub contact_stick_fraction: f64,
    /// Half-width of the contact patch \[m].
    pub contact_half_width: f64,
    /// Largest contact pressure \[Pa].
    pub contact_pressure_max: f64,
    /// Approach of hub and rail base beyond just touching \[m].
    pub contact_approach: f64,
    /// Translational velocity [m/s].
    pub wheel_velocity: f64,
    /// Angular velocity, forward positive [rad/s].
    pub wheel_omega: f64,
    /// Distance travelled \[m].
    pub wheel_distance: f64,
    /// Angle of rotation \[rad].
    pub wheel_angle: f64,
    /// Translational acceleration [m/s²].
    pub wheel_acceleration: f64,
    /// Angular acceleration [rad/s²].
    pub wheel_angular_acceleration: f64,
    /// Horizontal force that drives the hub, prescribed or reaction \[N].
    pub hub_force_x: f64,
    /// Vertical force on the hub, up positive: minus the load \[N].
    pub hub_force_y: f64,
    /// Moment that drives the hub, forward positive [N m].
    pub hub_moment: f64,
    /// Frictional dissipation in the contact \[W].
    pub friction_power: f64,
    /// Wear number `|F_x ξ|` \[N].
    pub t_gamma: f64,
    /// Highest surface temperature of the wheel in the contact zone \[K]; temperatures are absolute, zero if not computed.
    pub temperature_wheel_max: f64,
    /// The same of the rail \[K].
    pub temperature_rail_max: f64,
    /// Mean surface temperature of the wheel over the patch \[K].
    pub temperature_wheel_mean: f64,
    /// The same of the rail \[K].
    pub temperature_rail_mean: f64,
    /// Surface temperature of the wheel below its centre \[K].
    pub temperature_wheel_nominal: f64,
    /// The same of the rail \[K].
    pub temperature_rail_nominal: f64,
    /// Mean temperature of the whole wheel \[K].
    pub temperature_wheel_bulk: f64,
    /// Net heat into the wheel through the contact, mean over the last internal step \[W].
    pub heat_to_wheel: f64,
    /// The same into the rail \[W].
    pub heat_to_rail: f64,
    /// Heat conducted from wheel to rail through the interface \[W].
    pub heat_conduction: f64,
    /// Heat from the wheel into the hub \[W].
    pub heat_to_hub: f64,
    /// Heat imbalance since the start relative to the heat supplied \[1].
    pub heat_residual: f64,
    /// Time during which the hottest contact point was above Ac1 \[s].
    pub austenitised_time: f64,
    /// Growth of the wheel radius by its bulk temperature \[m].
    pub thermal_growth: f64,
    /// Friction coefficient that held in the last step \[1].
    pub friction: f64,
    /// Internal steps in the last communication step.
    pub internal_steps: u64,
    /// Contact iterations in the last communication step.
    pub iterations: u64,
    /// Largest communication step for explicit coupling in this state \[s].
    pub suggested_step: f64,
    /// Energy imbalance since the start relative to the frictional dissipation, at least to the elastic energy of a loaded
    /// contact \[1].
    pub energy_residual: f64,
    /// Positions of the profile points, x forward from below the wheel centre \[m].
    pub profile_x: Vec<f64>,
    /// Contact pressure \[Pa].
    pub profile_pressure: Vec<f64>,
    /// Friction traction on the wheel, forward positive \[Pa].
    pub profile_shear: Vec<f64>,
    /// Slip velocity of the wheel surface relative to the rail; traction times slip integrates to the friction power
    /// [m/s].
    pub profile_slip: Vec<f64>,
    /// Surface temperature of the wheel \[K].
    pub profile_temperature_wheel: Vec<f64>,
    /// Surface temperature of the rail \[K].
    pub profile_temperature_rail: Vec<f64>,
}

/// Observables of a state.
pub fn observe(model: &Model, state: &State) -> Outputs {
    let width = model.wheel.width;
    let traction = &state.contact.traction;
    let [force_x, force_y, moment] = traction.resultant.map(|force| force * width);
    let (v, omega) = (state.motion.velocity.now, state.motion.omega.now);
    let v_c = model.wheel.radius * omega;
    let xi = creepage(v, v_c);
    let points = profile_points(model.zone);
    let sampled = |profile: &Piecewise| points.iter().map(|&x| profile.at(x)).collect();
    Outputs {
        contact_force_x: force_x,
        contact_force_y: force_y,
        contact_moment: moment,
        contact_creepage: xi,
        contact_slide: slide(v, v_c),
        contact_slip_velocity: v - v_c,
        contact_adhesion: ratio(force_x, force_y),
        contact_utilisation: ratio(force_x.abs(), state.friction * force_y),
        contact_stick_fraction: traction.stick_fraction,
        contact_half_width: traction.half_width(),
        contact_pressure_max: traction.pressure_max,
        contact_approach: -state.motion.height.now,
        friction: state.friction,
        wheel_velocity: v,
        wheel_omega: omega,
        wheel_distance: state.distance,
        wheel_angle: state.angle,
        wheel_acceleration: state.motion.velocity.rate,
        wheel_angular_acceleration: state.motion.omega.rate,
        hub_force_x: state.hub[0] * width,
        hub_force_y: state.hub[1] * width,
        hub_moment: state.hub[2] * width,
        friction_power: traction.friction_power * width,
        t_gamma: (force_x * xi).abs(),
        internal_steps: state.internal_steps,
        iterations: state.iterations,
        energy_residual: state.audit.residual(model.contact.nominal_energy()),
        suggested_step: suggested_step(model, state),
        profile_pressure: sampled(&traction.pressure),
        profile_shear: sampled(&traction.shear),
        profile_slip: sampled(&traction.slip),
        profile_x: points,
        ..thermal_outputs(model, state)
    }
}

/// The outputs about heat, everything else zero.
fn thermal_outputs(model: &Model, state: &State) -> Outputs {
    let (Some(heat), Some(thermal)) = (&model.thermal, &state.thermal) else {
        let cold = vec![0.0; PROFILE_POINTS];
        return Outputs {
            profile_temperature_wheel: cold.clone(),
            profile_temperature_rail: cold,
            ..Outputs::default()
        };
    };
    let (width, kelvin) = (model.wheel.width, heat.reference());
    let (temperatures, flows) = (&thermal.temperatures, &thermal.flows);
    let absolute = |surface: &[f64]| surface.iter().map(|t| kelvin + t).collect();
    Outputs {
        temperature_wheel_max: kelvin + temperatures.wheel_max,
        temperature_rail_max: kelvin + temperatures.rail_max,
        temperature_wheel_mean: kelvin + thermal.patch_mean[0],
        temperature_rail_mean: kelvin + thermal.patch_mean[1],
        temperature_wheel_nominal: kelvin + temperatures.wheel_centre,
        temperature_rail_nominal: kelvin + temperatures.rail_centre,
        temperature_wheel_bulk: kelvin + temperatures.wheel_mean,
        heat_to_wheel: width * flows.to_wheel,
        heat_to_rail: width * flows.to_rail,
        heat_conduction: width * flows.conduction,
        heat_to_hub: width * flows.to_hub,
        heat_residual: ratio(thermal.supplied - thermal.received, thermal.supplied.abs()),
        austenitised_time: thermal.austenitised,
        thermal_growth: thermal.deformation.radius_growth,
        profile_temperature_wheel: absolute(&thermal.surface[0]),
        profile_temperature_rail: absolute(&thermal.surface[1]),
        ..Outputs::default()
    }
}

/// `a/b`, zero where b is not positive.
fn ratio(a: f64, b: f64) -> f64 {
    if b > 0.0 { a / b } else { 0.0 }
}
