//! Observables of a state, for the whole wheel in SI units.

use super::control::{STANDSTILL, creepage};
use super::thermal::ThermalState;
use super::{Model, State};
use crate::contact::patch;
use serde::{Deserialize, Serialize};

/// Number of points of the output profiles, spread evenly over the candidate contact zone.
pub const PROFILE_POINTS: usize = 61;

/// Everything the model returns at a communication point.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Outputs {
    /// Contact force on the wheel in travel direction [N].
    pub contact_force_x: f64,
    /// Contact force on the wheel upward [N].
    pub contact_force_y: f64,
    /// Moment of the contact forces about the wheel centre, forward positive [N m].
    pub contact_moment: f64,
    /// Creepage `2 (V − rω)/(V + rω)`, braking positive [1].
    pub contact_creepage: f64,
    /// Slide `(V − rω)/V` of EN 15595 [1].
    pub contact_slide: f64,
    /// Nominal slip velocity `V − rω` [m/s].
    pub contact_slip_velocity: f64,
    /// Adhesion `F_x/F_y` [1].
    pub contact_adhesion: f64,
    /// Utilisation `|F_x|/(μ F_y)` [1].
    pub contact_utilisation: f64,
    /// Share of the contact length that sticks [1].
    pub contact_stick_fraction: f64,
    /// Half-width of the contact patch [m].
    pub contact_half_width: f64,
    /// Largest contact pressure [Pa].
    pub contact_pressure_max: f64,
    /// Approach of hub and rail base beyond just touching [m].
    pub contact_approach: f64,
    /// Translational velocity [m/s].
    pub wheel_velocity: f64,
    /// Angular velocity, forward positive [rad/s].
    pub wheel_omega: f64,
    /// Distance travelled [m].
    pub wheel_distance: f64,
    /// Angle of rotation [rad].
    pub wheel_angle: f64,
    /// Translational acceleration [m/s²].
    pub wheel_acceleration: f64,
    /// Angular acceleration [rad/s²].
    pub wheel_angular_acceleration: f64,
    /// Horizontal force that drives the hub, prescribed or reaction [N].
    pub hub_force_x: f64,
    /// Vertical force on the hub, up positive: minus the load [N].
    pub hub_force_y: f64,
    /// Moment that drives the hub, forward positive [N m].
    pub hub_moment: f64,
    /// Frictional dissipation in the contact [W].
    pub friction_power: f64,
    /// Wear number `|F_x ξ|` [N].
    pub t_gamma: f64,
    /// Highest surface temperature of the wheel in the contact zone [K]; temperatures are absolute, zero if not computed.
    pub temperature_wheel_max: f64,
    /// The same of the rail [K].
    pub temperature_rail_max: f64,
    /// Mean surface temperature of the wheel over the patch [K].
    pub temperature_wheel_mean: f64,
    /// The same of the rail [K].
    pub temperature_rail_mean: f64,
    /// Surface temperature of the wheel below its centre [K].
    pub temperature_wheel_nominal: f64,
    /// The same of the rail [K].
    pub temperature_rail_nominal: f64,
    /// Mean temperature of the whole wheel [K].
    pub temperature_wheel_bulk: f64,
    /// Net heat into the wheel through the contact, mean over the last internal step [W].
    pub heat_to_wheel: f64,
    /// The same into the rail [W].
    pub heat_to_rail: f64,
    /// Heat conducted from wheel to rail through the interface [W].
    pub heat_conduction: f64,
    /// Heat from the wheel into the hub [W].
    pub heat_to_hub: f64,
    /// Heat imbalance since the start relative to the heat supplied [1].
    pub heat_residual: f64,
    /// Time during which the hottest contact point was above Ac1 [s].
    pub austenitised_time: f64,
    /// Growth of the wheel radius by its bulk temperature [m].
    pub thermal_growth: f64,
    /// Friction coefficient that held in the last step [1].
    pub friction: f64,
    /// Internal steps in the last communication step.
    pub internal_steps: u64,
    /// Contact iterations in the last communication step.
    pub iterations: u64,
    /// Largest communication step for explicit coupling in this state [s].
    pub suggested_step: f64,
    /// Energy imbalance since the start relative to the frictional dissipation, at least to the elastic energy of a loaded
    /// contact [1].
    pub energy_residual: f64,
    /// Positions of the profile points, x forward from below the wheel centre [m].
    pub profile_x: Vec<f64>,
    /// Contact pressure [Pa].
    pub profile_pressure: Vec<f64>,
    /// Friction traction on the wheel, forward positive [Pa].
    pub profile_shear: Vec<f64>,
    /// Slip velocity of the wheel surface relative to the rail; traction times slip integrates to the friction power
    /// [m/s].
    pub profile_slip: Vec<f64>,
    /// Surface temperature of the wheel [K].
    pub profile_temperature_wheel: Vec<f64>,
    /// Surface temperature of the rail [K].
    pub profile_temperature_rail: Vec<f64>,
}

impl Model {
    /// Observables of a state.
    pub fn outputs(&self, state: &State) -> Outputs {
        let width = self.config.model.contact_width;
        let contact = &state.contact;
        let [force_x, force_y, moment] = contact.resultant(&self.grid).map(|f| f * width);
        let (v, omega) = (state.velocity.now, state.omega.now);
        let slip_velocity = v - self.grid.radius * omega;
        let xi = creepage(v, self.grid.radius * omega);
        let ratio = |a: f64, b: f64| if b > 0.0 { a / b } else { 0.0 };
        let seen = patch::observe(&self.grid, contact, state.friction);
        let profile = |value: &dyn Fn(usize) -> f64| self.profile(value);
        let h = self.grid.spacing;
        let surfaces = |i: usize| self.surface_temperatures(state, i);
        let kelvin = self.config.thermal.reference;
        let thermal = state.thermal.as_ref();
        let absolute = |of: fn(&ThermalState) -> f64| thermal.map_or(0.0, |t| kelvin + of(t));
        let flow = |of: fn(&ThermalState) -> f64| thermal.map_or(0.0, |t| width * of(t));
        let heat_residual = thermal.map_or(0.0, |t| ratio(t.supplied - t.received, t.supplied.abs()));
        let mut outputs = Outputs {
            temperature_wheel_max: absolute(|t| t.temperatures.wheel_max),
            temperature_rail_max: absolute(|t| t.temperatures.rail_max),
            temperature_wheel_mean: absolute(|t| t.patch_mean[0]),
            temperature_rail_mean: absolute(|t| t.patch_mean[1]),
            temperature_wheel_nominal: absolute(|t| t.temperatures.wheel_centre),
            temperature_rail_nominal: absolute(|t| t.temperatures.rail_centre),
            temperature_wheel_bulk: absolute(|t| t.temperatures.wheel_mean),
            heat_to_wheel: flow(|t| t.flows.to_wheel),
            heat_to_rail: flow(|t| t.flows.to_rail),
            heat_conduction: flow(|t| t.flows.conduction),
            heat_to_hub: flow(|t| t.flows.to_hub),
            heat_residual,
            austenitised_time: thermal.map_or(0.0, |t| t.austenitised),
            thermal_growth: thermal.map_or(0.0, |t| t.growth),
            friction: state.friction,
            profile_temperature_wheel: profile(&|i| surfaces(i)[0]),
            profile_temperature_rail: profile(&|i| surfaces(i)[1]),
            contact_force_x: force_x,
            contact_force_y: force_y,
            contact_moment: moment,
            contact_creepage: xi,
            contact_slide: if v.abs() > STANDSTILL { slip_velocity / v } else { 0.0 },
            contact_slip_velocity: slip_velocity,
            contact_adhesion: ratio(force_x, force_y),
            contact_utilisation: ratio(force_x.abs(), state.friction * force_y),
            contact_stick_fraction: seen.stick_fraction,
            contact_half_width: seen.half_width,
            contact_pressure_max: seen.pressure_max,
            contact_approach: -state.height.now,
            wheel_velocity: v,
            wheel_omega: omega,
            wheel_distance: state.distance,
            wheel_angle: state.angle,
            wheel_acceleration: state.velocity.rate,
            wheel_angular_acceleration: state.omega.rate,
            hub_force_x: state.hub[0] * width,
            hub_force_y: state.hub[1] * width,
            hub_moment: state.hub[2] * width,
            friction_power: state.audit.friction_power * width,
            t_gamma: (force_x * xi).abs(),
            internal_steps: state.internal_steps,
            iterations: state.iterations,
            energy_residual: state.audit.residual(self.contact_energy()),
            profile_x: profile(&|i| self.grid.x[i]),
            profile_pressure: profile(&|i| contact.normal(&self.grid, i) / h),
            profile_shear: profile(&|i| contact.tangential(&self.grid, i) / h),
            profile_slip: profile(&|i| contact.centred_slip[i]),
            suggested_step: 0.0,
        };
        outputs.suggested_step = self.suggested_step(state, &outputs);
        outputs
    }

    /// Absolute surface temperatures of wheel and rail at candidate `i` [K]; zero if not computed.
    fn surface_temperatures(&self, state: &State, i: usize) -> [f64; 2] {
        match &state.thermal {
            Some(thermal) => [0, 1].map(|body| self.config.thermal.reference + thermal.surface[body][i]),
            None => [0.0; 2],
        }
    }

    /// Nodal values resampled to the profile points.
    fn profile(&self, value: &dyn Fn(usize) -> f64) -> Vec<f64> {
        let last = self.grid.len() - 1;
        (0..PROFILE_POINTS)
            .map(|k| {
                let position = k as f64 * last as f64 / (PROFILE_POINTS - 1) as f64;
                let i = (position as usize).min(last - 1);
                let share = position - i as f64;
                if share == 0.0 { value(i) } else { value(i) + share * (value(i + 1) - value(i)) }
            })
            .collect()
    }
}
