//! THE table: every variable of the interface, once. Getters, setters, `modelDescription.xml` and the documentation
//! are all made from it.
//!
//! Inputs and parameters have their rows where they live, [`Drive::ROWS`], [`Inputs::controls`] and [`Config::rows`];
//! outputs have theirs here. A profile is one row, an array; [`super::variables`] spreads it over scalars.
//!
//! Value references are fixed numbers by group, so that other people's scripts survive new variables: 100 control,
//! 200 drive, 250 rail, 300 contact, 400 wheel, 500 hub, 600 heat, 700 damage, 800 solver, 1000 parameters,
//! 10000 profiles. Signs: x in travel direction, y up, `omega > 0` rolls forward, `contact.*` forces act on the wheel.

use super::units;
use super::variable::{Access, Enumeration, Kind, Reference, Start, Variable};
use crate::config::Config;
use crate::simulation::{Drive, Inputs, Outputs, PROFILE_POINTS};
use std::sync::OnceLock;

/// All rows: inputs, outputs, parameters by their numbers, profiles.
pub fn table() -> &'static [Variable] {
    static TABLE: OnceLock<Vec<Variable>> = OnceLock::new();
    TABLE.get_or_init(|| {
        let mut rows = inputs();
        rows.extend(outputs());
        rows.extend(parameters());
        rows.extend(profiles());
        rows
    })
}

/// The enumerations of the table, each once, in the order of their first row.
pub fn enumerations() -> Vec<&'static Enumeration> {
    let mut lists: Vec<&'static Enumeration> = Vec::new();
    for variable in table() {
        if let Kind::Enumeration(list) = variable.kind
            && !lists.contains(&list)
        {
            lists.push(list);
        }
    }
    lists
}

const FREE: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];
const POSITIVE: [f64; 2] = [0.0, f64::INFINITY];

fn row(reference: Reference, name: &str, kind: Kind, access: Access, text: &str) -> Variable {
    Variable {
        reference,
        name: name.into(),
        kind,
        dimension: None,
        access,
        start: Start::Stationary,
        tunable: false,
        description: text.into(),
    }
}

fn real(measure: units::Measure, [min, max]: [f64; 2], nominal: f64) -> Kind {
    Kind::Real { measure, min, max, nominal }
}

fn inputs() -> Vec<Variable> {
    let controls = Inputs::controls().into_iter();
    let controls = controls.map(|c| row(c.number, c.name, c.kind, Access::ChoiceInput(c.read, c.write), c.text));
    let values = Drive::ROWS.iter().map(|d| {
        row(d.number, d.name, real(d.measure, [d.low, d.high], d.nominal), Access::RealInput(d.field), d.text)
    });
    let mut rows: Vec<Variable> = controls.chain(values).collect();
    rows.sort_by_key(|row| row.reference);
    rows
}

fn parameters() -> Vec<Variable> {
    let text = "Name of a parameter set resources/<preset>.json; parameters that are set explicitly override it";
    let preset = row(1000, "preset", Kind::String, Access::Preset, text);
    let parameter = |p: &'static crate::config::row::Row<Config>| Variable {
        tunable: p.tunable,
        ..row(p.number, p.name, p.kind, Access::Parameter(p), p.text)
    };
    std::iter::once(preset).chain(Config::rows().iter().map(parameter)).collect()
}

fn outputs() -> Vec<Variable> {
    let value = |r, name, measure, range, nominal, get: fn(&Outputs) -> f64, text| {
        row(r, name, real(measure, range, nominal), Access::RealOutput(get), text)
    };
    let zero = |variable: Variable| Variable { start: Start::Zero, ..variable };
    let count = |r, name, get: fn(&Outputs) -> u64, text| {
        zero(row(r, name, Kind::Integer { min: 0, max: i32::MAX }, Access::CountOutput(get), text))
    };
    use units::*;
    #[rustfmt::skip]
    let rows = vec![
        value(300, "contact.force_x", FORCE, FREE, 1e4, |o| o.contact_force_x, "Tangential contact force on the wheel, positive in x (traction)"),
        value(301, "contact.force_y", FORCE, FREE, 1e5, |o| o.contact_force_y, "Normal contact force on the wheel, up positive"),
        value(302, "contact.moment", MOMENT, FREE, 1e4, |o| o.contact_moment, "Moment of the contact forces about the wheel centre, forward positive"),
        value(303, "contact.creepage", PERCENT, FREE, 1e-3, |o| o.contact_creepage, "Creepage 2 (V - r omega)/(V + r omega), negative in traction; 0 at standstill"),
        value(304, "contact.slide", PERCENT, FREE, 1e-3, |o| o.contact_slide, "Slide (V - r omega)/V, 1 when the wheel is locked; 0 at standstill"),
        value(305, "contact.slip_velocity", SLIP, FREE, 1e-2, |o| o.contact_slip_velocity, "Rigid slip velocity V - r omega, negative in traction"),
        value(306, "contact.adhesion", NUMBER, FREE, 0.1, |o| o.contact_adhesion, "Adhesion contact.force_x / contact.force_y; 0 without contact"),
        value(307, "contact.utilisation", PERCENT, POSITIVE, 1.0, |o| o.contact_utilisation, "Share of the friction limit in use, |contact.force_x| / (mu contact.force_y)"),
        value(308, "contact.stick_fraction", PERCENT, [0.0, 1.0], 1.0, |o| o.contact_stick_fraction, "Sticking share of the contact width"),
        value(309, "contact.half_width", MILLIMETRE, POSITIVE, 5e-3, |o| o.contact_half_width, "Half the length of the contact patch in x"),
        value(310, "contact.pressure_max", PRESSURE, POSITIVE, 1e9, |o| o.contact_pressure_max, "Peak contact pressure"),
        value(311, "contact.approach", MILLIMETRE, FREE, 1e-4, |o| o.contact_approach, "Approach of hub and rail base since just touching, pressed positive"),
        value(400, "wheel.velocity", SPEED, FREE, 30.0, |o| o.wheel_velocity, "Travel velocity V of the wheel centre, positive in x"),
        value(401, "wheel.omega", ROTATION, FREE, 60.0, |o| o.wheel_omega, "Angular velocity, forward rolling positive"),
        zero(value(402, "wheel.distance", METRE, FREE, 100.0, |o| o.wheel_distance, "Distance travelled since the start")),
        zero(value(403, "wheel.angle", DEGREE, FREE, 100.0, |o| o.wheel_angle, "Angle turned since the start, forward positive")),
        value(404, "wheel.acceleration", ACCELERATION, FREE, 1.0, |o| o.wheel_acceleration, "Acceleration of the wheel centre in x"),
        value(405, "wheel.angular_acceleration", ANGULAR_ACCELERATION, FREE, 1.0, |o| o.wheel_angular_acceleration, "Angular acceleration, forward positive"),
        value(500, "hub.force_x", FORCE, FREE, 1e4, |o| o.hub_force_x, "Horizontal force that drives the hub, prescribed or reaction, positive in x; conjugate to wheel.velocity"),
        value(501, "hub.force_y", FORCE, FREE, 1e5, |o| o.hub_force_y, "Vertical force on the hub, prescribed or reaction, up positive (-drive.load)"),
        value(502, "hub.moment", MOMENT, FREE, 1e4, |o| o.hub_moment, "Moment that drives the hub, prescribed or reaction, forward positive; conjugate to wheel.omega"),
        value(600, "heat.friction_power", POWER, FREE, 1e4, |o| o.friction_power, "Power dissipated by friction in the contact patch"),
        value(312, "contact.friction", NUMBER, POSITIVE, 0.3, |o| o.friction, "Friction coefficient that holds now: rail.friction with the dependence on slip and temperature"),
        value(610, "temperature.wheel_max", TEMPERATURE, POSITIVE, 300.0, |o| o.temperature_wheel_max, "Highest surface temperature of the wheel in the contact zone (temperatures are absolute; 0 without thermal.enabled)"),
        value(611, "temperature.rail_max", TEMPERATURE, POSITIVE, 300.0, |o| o.temperature_rail_max, "Highest surface temperature of the rail in the contact zone"),
        value(612, "temperature.wheel_mean", TEMPERATURE, POSITIVE, 300.0, |o| o.temperature_wheel_mean, "Mean surface temperature of the wheel over the contact patch"),
        value(613, "temperature.rail_mean", TEMPERATURE, POSITIVE, 300.0, |o| o.temperature_rail_mean, "Mean surface temperature of the rail over the contact patch"),
        value(614, "temperature.wheel_nominal", TEMPERATURE, POSITIVE, 300.0, |o| o.temperature_wheel_nominal, "Surface temperature of the wheel below its centre"),
        value(615, "temperature.rail_nominal", TEMPERATURE, POSITIVE, 300.0, |o| o.temperature_rail_nominal, "Surface temperature of the rail below the wheel centre"),
        value(616, "temperature.wheel_bulk", TEMPERATURE, POSITIVE, 300.0, |o| o.temperature_wheel_bulk, "Mean temperature of the whole wheel"),
        value(601, "heat.to_wheel", POWER, FREE, 1e4, |o| o.heat_to_wheel, "Net heat into the wheel through the contact"),
        value(602, "heat.to_rail", POWER, FREE, 1e4, |o| o.heat_to_rail, "Net heat into the rail through the contact; with heat.to_wheel it makes thermal.heat_ratio x heat.friction_power"),
        value(603, "heat.conduction", POWER, FREE, 1e3, |o| o.heat_conduction, "Heat conducted from wheel to rail across the interface"),
        value(604, "heat.to_hub", POWER, FREE, 1e3, |o| o.heat_to_hub, "Heat from the wheel into the hub"),
        value(620, "thermal.growth", MILLIMETRE, FREE, 1e-5, |o| o.thermal_growth, "Growth of the wheel radius by its bulk temperature"),
        zero(value(701, "damage.time_above_ac1", SECOND, POSITIVE, 1e-2, |o| o.austenitised_time, "Time during which the hottest contact point was above thermal.austenitisation")),
        zero(value(803, "solver.heat_residual", NUMBER, FREE, 1e-9, |o| o.heat_residual, "Heat balance since the start: unaccounted heat over heat supplied")),
        value(700, "damage.t_gamma", NEWTON, POSITIVE, 10.0, |o| o.t_gamma, "Wear number |contact.force_x contact.creepage|: energy dissipated per metre travelled"),
        count(800, "solver.internal_steps", |o| o.internal_steps, "Internal time steps in the last communication step"),
        count(801, "solver.iterations", |o| o.iterations, "Contact iterations in the last communication step"),
        value(804, "solver.suggested_step", SECOND, POSITIVE, 1e-3, |o| o.suggested_step, "Largest communication step for explicit coupling: from creep damping and contact stiffness where velocities or the hub height were prescribed in the last step, 1 s otherwise"),
        zero(value(802, "solver.energy_residual", NUMBER, FREE, 1e-2, |o| o.energy_residual, "Energy balance since the start: unaccounted over dissipated energy, at least the elastic energy of the contact")),
    ];
    rows
}

fn profiles() -> Vec<Variable> {
    type Profile = (Reference, &'static str, Kind, fn(&Outputs) -> &[f64], &'static str);
    #[rustfmt::skip]
    let profiles: [Profile; 6] = [
        (10000, "x", real(units::MILLIMETRE, FREE, 5e-3), |o| &o.profile_x, "Position across the contact patch, positive ahead of the wheel centre"),
        (11000, "pressure", real(units::PRESSURE, FREE, 1e9), |o| &o.profile_pressure, "Contact pressure"),
        (12000, "shear", real(units::PRESSURE, FREE, 1e8), |o| &o.profile_shear, "Shear traction on the wheel, positive in x"),
        (13000, "slip", real(units::SLIP, FREE, 1e-2), |o| &o.profile_slip, "Local slip velocity"),
        (14000, "temperature_wheel", real(units::TEMPERATURE, POSITIVE, 300.0), |o| &o.profile_temperature_wheel, "Surface temperature of the wheel"),
        (15000, "temperature_rail", real(units::TEMPERATURE, POSITIVE, 300.0), |o| &o.profile_temperature_rail, "Surface temperature of the rail"),
    ];
    let array = |(first, name, kind, get, text): Profile| Variable {
        dimension: Some(PROFILE_POINTS),
        ..row(first, &format!("profile.{name}"), kind, Access::ArrayOutput(get), text)
    };
    profiles.into_iter().map(array).collect()
}
