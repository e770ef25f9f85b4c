//! Observables of a state, for the whole wheel in SI units.

use super::across;
use super::audit::drifting;
use super::creepages::{creepage, over_mean_speed, per_metre, slide};
use super::line::Line;
use super::model::RollingModel;
use super::output_rows::Outputs;
use super::profile::{PROFILE_POINTS, profile_depths, profile_points};
use super::state::State;
use super::suggested_step::suggested_step;
use super::thermal_state::ThermalState;
use super::wheelset::Wrench;
use crate::contact::Traction;
use crate::damage::surface_fatigue;
use crate::heat::HeatFlows;
use crate::piecewise::Piecewise;
use crate::surface::WearLaw;

/// Observables of a state.
///
/// Forces, energies and heat are those of all lines together, extremes the largest on any line, means those over the
/// area of the contact or, of friction and slip, over the load. Profiles are those of the line with the largest
/// pressure.
pub fn observe(model: &RollingModel, state: &State) -> Outputs {
    observe_over(model, state, Outputs::default())
}

/// Observables of a state. `others` gives what none of the functions below names: nothing but what [`complete`] fills,
/// which a test of [`crate::simulation`] tells from two kinds of `others`.
pub(crate) fn observe_over(model: &RollingModel, state: &State, others: Outputs) -> Outputs {
    let width = model.wheel.width;
    let none = Line::default();
    let pressed = state.line_of_largest(|line| line.contact.traction.pressure_max).unwrap_or(&none);
    let traction = &pressed.contact.traction;
    let force = state.resultant().map(|force| force * width);
    let friction_force = libm::hypot(state.sum(|line| line.contact.traction.friction_force()) * width, force.lateral);
    let [v, v_c] = speeds(model, state);
    let others = across::outputs(model, state, surface_outputs(model, state, pressed, others));
    let others = energy_outputs(model, state, traction.pressure_max, others);
    Outputs {
        contact_force_x: force.travel,
        contact_force_y: force.height,
        contact_moment: force.rotation,
        contact_creepage: creepage(v, v_c),
        contact_slide: slide(v, v_c),
        contact_slip_velocity: v - v_c,
        contact_adhesion: ratio(force.travel, force.height),
        contact_utilisation: ratio(friction_force, state.friction() * force.height),
        contact_stick_fraction: state.mean_over_area(|line| line.contact.traction.stick_fraction),
        contact_half_width: state.half_width(),
        contact_width: width * state.covered(),
        contact_pressure_max: traction.pressure_max,
        contact_approach: state.elevation - state.motion.height.now,
        contact_force_min: state.pressing.lowest * width,
        contact_force_max: state.pressing.highest * width,
        contact_impulse: state.pressing.impulse * width,
        contact_lost_time: state.pressing.lost,
        contact_patches: traction.patches.len() as u64,
        friction: state.friction(),
        contact_tread_slip: state.tread_slip()[0],
        yielded: state.mean_over_area(|line| line.contact.traction.yielding.share),
        molten: state.mean_over_area(|line| line.contact.traction.under_film),
        internal_steps: state.clock.internal_steps,
        limited_steps: state.clock.limited_steps,
        force_error: state.clock.errors[0] * width,
        temperature_error: state.clock.errors[1],
        iterations: state.clock.iterations,
        suggested_step: suggested_step(model, state),
        ..lateral_outputs(model, state, motion_outputs(model, state, traction_outputs(model, traction, others)))
    }
}

/// Profiles of the tractions of a line across the contact zone.
fn traction_outputs(model: &RollingModel, traction: &Traction, others: Outputs) -> Outputs {
    let points = profile_points(model.zone);
    Outputs {
        profile_pressure: sampled(&traction.pressure, &points),
        profile_shear: sampled(&traction.shear, &points),
        profile_slip: sampled(&traction.slip, &points),
        profile_shear_z: sampled(&traction.lateral_shear, &points),
        profile_slip_z: sampled(&traction.lateral_slip, &points),
        profile_x: points,
        ..others
    }
}

/// Observables with the profiles of a line of the patch, counted from 1 in the order of `line.*`: as they are for a line that
/// the patch does not have.
pub fn on_line(model: &RollingModel, state: &State, number: usize, outputs: Outputs) -> Outputs {
    let Some(line) = across::line(model, state, number) else { return outputs };
    let cold = || vec![0.0; PROFILE_POINTS];
    let mut surfaces = [cold(), cold(), cold()];
    if let (Some(heat), Some(thermal)) = (&model.thermal, &line.thermal) {
        let absolute = |surface: &[f64]| surface.iter().map(|t| heat.reference() + t).collect();
        surfaces = [absolute(&thermal.surface[0]), absolute(&thermal.surface[1]), heat.peaks(thermal)];
    }
    let [profile_temperature_wheel, profile_temperature_rail, profile_peak] = surfaces;
    let [profile_wheel_below, profile_rail_below, profile_tread_below] = columns(model, state, Some(line));
    let others = traction_outputs(model, &line.contact.traction, outputs);
    Outputs {
        profile_temperature_wheel,
        profile_temperature_rail,
        profile_peak,
        profile_wheel_below,
        profile_rail_below,
        profile_tread_below,
        ..others
    }
}

/// Outputs across the direction of travel, and about turning.
fn lateral_outputs(model: &RollingModel, state: &State, others: Outputs) -> Outputs {
    let (width, velocity, [_, drift, spin]) = (model.wheel.width, state.motion.lateral.now, state.motion.drift);
    let ([v, v_c], [along, aside]) = (speeds(model, state), state.tread_slip());
    let (force, moment) = (width * state.hub.force.lateral, width * state.spin_moment());
    Outputs {
        contact_force_z: width * state.resultant().lateral,
        contact_moment_y: moment,
        contact_lateral_creepage: over_mean_speed(velocity + drift, v, v_c),
        contact_spin: over_mean_speed(spin, v, v_c),
        contact_slip_direction: if model.wheel.sideways.enabled { libm::atan2(aside, along) } else { 0.0 },
        contact_tread_slip_z: aside,
        contact_load_position: model.contact.patch.centre(state.motion.pose.lateral),
        wheel_lateral_velocity: velocity,
        wheel_lateral_displacement: state.motion.aside,
        hub_force_z: force,
        hub_lateral_power: force * velocity,
        hub_spin_power: width * drifting_power(state),
        ..wheelset_outputs(model, state, moment, others)
    }
}

/// Power of what makes the wheel drift [W/m].
fn drifting_power(state: &State) -> f64 {
    let [along, across, spin] = state.motion.drift;
    let velocities = [along, across, spin, state.motion.height.rate];
    drifting(state).iter().zip(velocities).map(|(force, velocity)| force * velocity).sum()
}

/// Outputs about the middle of the wheelset, for the `moment` of the contact about its normal \[N m].
fn wheelset_outputs(model: &RollingModel, state: &State, moment: f64, others: Outputs) -> Outputs {
    let force = state.resultant().map(|force| force * model.wheel.width);
    let Wrench { force, moment } = model.wheel.wheelset.wrench(&state.motion.pose, force, moment);
    Outputs {
        wheelset_force_x: force.x,
        wheelset_force_y: force.y,
        wheelset_force_z: force.z,
        wheelset_moment_x: moment.x,
        wheelset_moment_y: moment.y,
        wheelset_moment_z: moment.z,
        ..others
    }
}

/// Velocity of the wheel and peripheral velocity at the contact [m/s].
fn speeds(model: &RollingModel, state: &State) -> [f64; 2] {
    [state.motion.velocity.now + state.motion.drift[0], model.rolling_radius(state) * state.motion.omega.now]
}

/// Outputs about the motion of the wheel and what moves it.
fn motion_outputs(model: &RollingModel, state: &State, others: Outputs) -> Outputs {
    let width = model.wheel.width;
    let [wheel_height, rail_height] = model.contact.surfaces.heights(state.place(model.wheel.radius));
    Outputs {
        wheel_profile_height: wheel_height,
        rail_profile_height: rail_height,
        wheel_velocity: state.motion.velocity.now,
        wheel_omega: state.motion.omega.now,
        wheel_distance: state.motion.distance,
        wheel_angle: state.motion.angle,
        wheel_acceleration: state.motion.velocity.rate,
        wheel_angular_acceleration: state.motion.omega.rate,
        wheel_mass: model.wheel.inertia.height * width,
        wheel_inertia: model.wheel.inertia.rotation * width,
        hub_height: state.motion.height.now,
        hub_vertical_velocity: state.motion.height.rate,
        hub_force_x: (state.hub.force.travel - state.hub.gravity) * width,
        hub_force_y: state.hub.force.height * width,
        hub_moment: state.hub.force.rotation * width,
        brake_moment: state.hub.brake.moment * width,
        brake_power: state.hub.brake.power * width,
        brake_locked: state.hub.brake.locked,
        ..others
    }
}

/// Outputs about energies and powers, and the damage that belongs to them under a largest pressure \[Pa].
fn energy_outputs(model: &RollingModel, state: &State, pressure_max: f64, others: Outputs) -> Outputs {
    let (width, audit, force) = (model.wheel.width, &state.audit, state.resultant().map(|f| f * model.wheel.width));
    let [v, v_c] = speeds(model, state);
    let t_gamma = per_metre(state.friction_power * width, v, v_c);
    let area = width * state.sum(|line| line.contact.traction.touching());
    let adhesion = ratio(libm::hypot(force.travel, force.lateral), force.height);
    Outputs {
        brake_energy: audit.brake * width,
        friction_power: state.friction_power * width,
        hub_work: (audit.work - audit.gravity) * width,
        gravity_work: audit.gravity * width,
        lift_work: audit.lift * width,
        thermal_work: audit.thermal_work * width,
        stored_energy: (audit.energy - audit.initial_energy) * width,
        friction_energy: audit.friction * width,
        plastic_energy: audit.plastic * width,
        damping_energy: audit.damping * width,
        energy_residual: audit.residual(model.contact.nominal_energy()),
        t_gamma,
        rail_energy: t_gamma,
        wear_rate: WearLaw::r8t().scaled(model.config.damage.wear_factor).rate(t_gamma, area),
        surface_fatigue: surface_fatigue(adhesion, model.contact.shear_yield, pressure_max),
        ..others
    }
}

/// Observables of a state, those included that [`observe`] leaves empty.
pub fn observe_all(model: &RollingModel, state: &State) -> Outputs {
    let mut outputs = observe(model, state);
    complete(model, state, &mut outputs);
    outputs
}

/// Fills the observables that [`observe`] leaves empty because few people ask for them: temperatures over the depth
/// under the line with the largest pressure.
pub fn complete(model: &RollingModel, state: &State, outputs: &mut Outputs) {
    let shown = state.line_of_largest(|line| line.contact.traction.pressure_max);
    let columns = columns(model, state, shown);
    [outputs.profile_wheel_below, outputs.profile_rail_below, outputs.profile_tread_below] = columns;
    let hottest = hottest_line(state).and_then(|line| line.thermal.as_ref());
    outputs.profile_hottest_below = match (&model.thermal, hottest) {
        (Some(heat), Some(thermal)) => {
            let angle = state.motion.angle;
            let [.., below] =
                heat.below(thermal, angle, heat.history().spots.hottest_angle(&thermal.damage).unwrap_or(angle));
            below
        }
        _ => vec![0.0; PROFILE_POINTS],
    };
}

/// Absolute temperatures \[K] over the depth at a line: of wheel and rail below the contact point, and below the point of
/// the tread that is looked at; zero without heat.
fn columns(model: &RollingModel, state: &State, line: Option<&Line>) -> [Vec<f64>; 3] {
    match (&model.thermal, line.and_then(|line| line.thermal.as_ref())) {
        (Some(heat), Some(thermal)) => heat.below(thermal, state.motion.angle, state.tread_point),
        _ => [(); 3].map(|()| vec![0.0; PROFILE_POINTS]),
    }
}

/// Empties what [`complete`] fills.
pub fn forget(outputs: &mut Outputs) {
    [outputs.profile_wheel_below, outputs.profile_rail_below, outputs.profile_tread_below] = Default::default();
    outputs.profile_hottest_below = Vec::new();
}

/// Values of a profile at ascending positions.
fn sampled(profile: &Piecewise, points: &[f64]) -> Vec<f64> {
    let mut values = Vec::with_capacity(points.len());
    profile.sample(points, &mut values);
    values
}

/// Outputs about the material that the surfaces have lost and about heat. Profiles are those of the line `shown`.
fn surface_outputs(model: &RollingModel, state: &State, shown: &Line, others: Outputs) -> Outputs {
    let none = Line::default();
    let flat = model.tread.flat(&model.contact.surfaces, &deepest_line(state, &none).flattening[0], model.spacing);
    Outputs {
        flat_length: flat.length,
        flat_depth: flat.depth,
        flattening: state.largest(|line| line.flattening[0].deepest_dent()),
        flattening_rail: state.largest(|line| line.flattening[1].deepest_dent()),
        worn_mass: state.sum(|line| line.worn) * model.wheel.width,
        worn_depth: state.largest(|line| line.flattening[0].worn().deepest()),
        worn_depth_rail: state.largest(|line| line.flattening[1].worn().deepest()),
        ..thermal_outputs(model, state, shown, others)
    }
}

/// Outputs about heat. Without heat, or with nothing under pressure, they are zero.
fn thermal_outputs(model: &RollingModel, state: &State, shown: &Line, others: Outputs) -> Outputs {
    let (Some(heat), Some(thermal)) = (&model.thermal, &shown.thermal) else {
        let cold = vec![0.0; PROFILE_POINTS];
        return Outputs {
            profile_temperature_wheel: cold.clone(),
            profile_temperature_rail: cold.clone(),
            profile_peak: cold.clone(),
            profile_martensite: cold,
            profile_depth: profile_depths(),
            ..Outputs::default()
        };
    };
    let kelvin = heat.reference();
    let of = |of: &dyn Fn(&ThermalState) -> f64, line: &Line| line.thermal.as_ref().map_or(0.0, of);
    let sum = |value: &dyn Fn(&ThermalState) -> f64| state.sum(|line| of(value, line));
    let mean = |value: &dyn Fn(&ThermalState) -> f64| state.mean(|line| of(value, line));
    let over_patch = |value: &dyn Fn(&ThermalState) -> f64| state.mean_over_area(|line| of(value, line));
    let most = |value: &dyn Fn(&ThermalState) -> f64| state.largest(|line| of(value, line));
    let absolute = |surface: &[f64]| surface.iter().map(|t| kelvin + t).collect();
    let damaged = hottest_line(state).and_then(|line| line.thermal.as_ref()).map(|thermal| &thermal.damage);
    Outputs {
        temperature_wheel_max: kelvin + most(&|thermal| thermal.temperatures.wheel_max),
        temperature_rail_max: kelvin + most(&|thermal| thermal.temperatures.rail_max),
        temperature_wheel_mean: kelvin + over_patch(&|thermal| thermal.patch_mean[0]),
        temperature_rail_mean: kelvin + over_patch(&|thermal| thermal.patch_mean[1]),
        temperature_friction: kelvin + state.mean_under_load(|line| of(&|thermal| thermal.friction_excess(), line)),
        temperature_wheel_nominal: kelvin + most(&|thermal| thermal.temperatures.wheel_centre),
        temperature_rail_nominal: kelvin + most(&|thermal| thermal.temperatures.rail_centre),
        temperature_wheel_bulk: kelvin + mean(&|thermal| thermal.temperatures.wheel_mean),
        melted: most(&|thermal| thermal.melted),
        heat_residual: ratio(sum(&|thermal| thermal.unaccounted), sum(&|thermal| thermal.turned_over)),
        thermal_growth: state.growth(),
        profile_temperature_wheel: absolute(&thermal.surface[0]),
        profile_temperature_rail: absolute(&thermal.surface[1]),
        profile_peak: heat.peaks(thermal),
        profile_martensite: damaged
            .map_or_else(|| vec![0.0; PROFILE_POINTS], |damage| heat.history().martensite(damage)),
        profile_depth: profile_depths(),
        hottest_point: damaged.and_then(|damage| heat.history().spots.hottest_angle(damage)).unwrap_or(0.0),
        ..flow_outputs(model, state, others)
    }
}

/// Outputs about heat that flows.
fn flow_outputs(model: &RollingModel, state: &State, others: Outputs) -> Outputs {
    let width = model.wheel.width;
    let flow = |of: &dyn Fn(&HeatFlows) -> f64| {
        width * state.sum(|line| line.thermal.as_ref().map_or(0.0, |thermal| of(&thermal.flows)))
    };
    let [v, v_c] = speeds(model, state);
    let heat_to_rail = flow(&|flows| flows.to_rail);
    let rail_heat = per_metre(heat_to_rail, v, v_c);
    Outputs {
        heat_to_wheel: flow(&|flows| flows.to_wheel),
        heat_to_rail,
        heat_conduction: flow(&|flows| flows.conduction),
        heat_to_hub: flow(&|flows| flows.to_hub),
        heat_to_air: flow(&|flows| flows.wheel_to_air),
        rail_heat,
        heat_per_metre: rail_heat,
        ..damage_outputs(state, others)
    }
}

/// Outputs about the structure of the steel, of the line with the hottest tread so far.
fn damage_outputs(state: &State, others: Outputs) -> Outputs {
    let Some(thermal) = hottest_line(state).and_then(|line| line.thermal.as_ref()) else {
        return Outputs::default();
    };
    let damage = &thermal.damage;
    let found = damage.findings();
    Outputs {
        austenitised_time: found.above_ac1,
        peak_temperature: damage.peak,
        ac1_depth: found.ac1_depth,
        cooling_rate: found.cooling_rate,
        martensite_depth: found.martensite_depth,
        flats: damage.places,
        hot_places: damage.hot_places() as u64,
        rail_peak: damage.rail_peak,
        ..others
    }
}

/// The line with the hottest tread so far.
fn hottest_line(state: &State) -> Option<&Line> {
    state.line_of_largest(|line| line.thermal.as_ref().map_or(0.0, |thermal| thermal.damage.peak))
}

/// `a/b`, zero where b is not positive.
fn ratio(a: f64, b: f64) -> f64 {
    if b > 0.0 { a / b } else { 0.0 }
}

/// Elements of the contact between the samples of the tread: as many as the contact resolves.
const SAMPLING: f64 = 2.0;

/// The line under which the wheel has lost most, `none` if there is no line.
fn deepest_line<'a>(state: &'a State, none: &'a Line) -> &'a Line {
    state.line_of_largest(|line| line.flattening[0].deepest()).unwrap_or(none)
}

/// Present profile of the wheel where it has lost most: positions around the tread and heights over the circle \[m], which
/// are those of `wheel.profile` less the depth that yielding and wear have taken off under that line.
pub fn tread(model: &RollingModel, state: &State) -> Vec<[f64; 2]> {
    let none = Line::default();
    let flattening = &deepest_line(state, &none).flattening[0];
    model.contact.surfaces.tread(flattening, SAMPLING * model.spacing)
}
