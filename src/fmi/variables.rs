//! THE table: every variable of the interface, once. Getters, setters, `modelDescription.xml` and the documentation
//! are all made from it.
//!
//! Value references are fixed numbers by group, so that other people's scripts survive new variables: 100 control,
//! 200 drive, 250 rail, 300 contact, 400 wheel, 500 hub, 600 heat, 700 damage, 800 solver, 1000 parameters,
//! 10000 profiles. Signs: x in travel direction, y up, `omega > 0` rolls forward, `contact.*` forces act on the wheel.

use super::units::{self, Measure};
use super::variable::{Access, Enumeration, Kind, Reference, Start, Variable};
use crate::config::{ConductanceLaw, Config, Hub, Response, TimeScheme, parameter_range};
use crate::simulation::{Drive, INPUT_RANGES, Inputs, Outputs, PROFILE_POINTS, Rotation, Translation, Vertical};
use std::sync::OnceLock;

pub const ROTATION_CONTROL: Enumeration = Enumeration {
    name: "RotationControl",
    description: "Which of driving moment and angular velocity is prescribed; the other is the reaction",
    items: &[("velocity", "drive.omega is prescribed"), ("moment", "drive.moment is prescribed")],
};
pub const TRANSLATION_CONTROL: Enumeration = Enumeration {
    name: "TranslationControl",
    description: "Which of horizontal force and travel velocity is prescribed; the other is the reaction",
    items: &[("velocity", "drive.velocity is prescribed"), ("force", "drive.force is prescribed")],
};
pub const VERTICAL_CONTROL: Enumeration = Enumeration {
    name: "VerticalControl",
    description: "Which of vertical load and hub height is prescribed; the other is the reaction",
    items: &[("force", "drive.load is prescribed"), ("displacement", "drive.displacement is prescribed")],
};
pub const RESPONSE: Enumeration = Enumeration {
    name: "Response",
    description: "How the bodies answer contact tractions",
    items: &[("reduced", "vibration modes plus residual flexibility"), ("full", "all finite-element equations")],
};
pub const TIME_SCHEME: Enumeration = Enumeration {
    name: "TimeScheme",
    description: "Implicit time discretisation of momentum and slip",
    items: &[
        ("bdf2", "second-order backward differences, restarted by backward Euler"),
        ("backward_euler", "backward Euler"),
        ("theta", "theta family with weight solver.theta"),
    ],
};

pub const CONDUCTANCE_LAW: Enumeration = Enumeration {
    name: "ConductanceLaw",
    description: "How the contact conductance depends on pressure",
    items: &[("constant", "independent of pressure"), ("pressure", "proportional to pressure^0.95")],
};
pub const HUB: Enumeration = Enumeration {
    name: "Hub",
    description: "Thermal boundary condition of the hub",
    items: &[("fixed", "held at thermal.reference"), ("insulated", "no heat passes")],
};

/// Enumerations in the order of the model description.
pub const ENUMERATIONS: [&Enumeration; 7] =
    [&ROTATION_CONTROL, &TRANSLATION_CONTROL, &VERTICAL_CONTROL, &RESPONSE, &TIME_SCHEME, &CONDUCTANCE_LAW, &HUB];

/// All variables, in the order of the model description.
pub fn variables() -> &'static [Variable] {
    static TABLE: OnceLock<Vec<Variable>> = OnceLock::new();
    TABLE.get_or_init(|| {
        let mut rows = inputs();
        rows.extend(outputs());
        rows.extend(parameters());
        rows.extend(profiles());
        rows
    })
}

/// Row with the given value reference.
pub fn find(reference: Reference) -> Option<&'static Variable> {
    static ORDER: OnceLock<Vec<(Reference, usize)>> = OnceLock::new();
    let order = ORDER.get_or_init(|| {
        let mut order: Vec<_> = variables().iter().enumerate().map(|(i, v)| (v.reference, i)).collect();
        order.sort_unstable();
        order
    });
    let position = order.binary_search_by_key(&reference, |entry| entry.0).ok()?;
    Some(&variables()[order[position].1])
}

const FREE: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];
const POSITIVE: [f64; 2] = [0.0, f64::INFINITY];

fn row(reference: Reference, name: &str, kind: Kind, access: Access, text: &str) -> Variable {
    Variable {
        reference,
        name: name.into(),
        kind,
        access,
        start: Start::Stationary,
        tunable: false,
        description: text.into(),
    }
}

fn real(measure: Measure, [min, max]: [f64; 2], nominal: f64) -> Kind {
    Kind::Real { measure, min, max, nominal }
}

fn inputs() -> Vec<Variable> {
    let choice = |r, name, list, get: fn(&Inputs) -> i32, set: fn(&mut Inputs, i32), text| {
        row(r, name, Kind::Enumeration(list), Access::ChoiceInput(get, set), text)
    };
    let value = |r, name: &str, measure, nominal, field: fn(&mut Drive) -> &mut f64, text| {
        let range = INPUT_RANGES.iter().find(|limits| limits.0 == name).map_or(FREE, |&(_, low, high)| [low, high]);
        row(r, name, real(measure, range, nominal), Access::RealInput(field), text)
    };
    vec![
        choice(
            100,
            "control.rotation",
            &ROTATION_CONTROL,
            |i| if i.rotation == Rotation::Velocity { 1 } else { 2 },
            |i, item| i.rotation = if item == 1 { Rotation::Velocity } else { Rotation::Moment },
            "Prescribed partner of (moment, angular velocity); switching between steps is bumpless",
        ),
        choice(
            101,
            "control.translation",
            &TRANSLATION_CONTROL,
            |i| if i.translation == Translation::Velocity { 1 } else { 2 },
            |i, item| i.translation = if item == 1 { Translation::Velocity } else { Translation::Force },
            "Prescribed partner of (horizontal force, travel velocity); switching between steps is bumpless",
        ),
        choice(
            102,
            "control.vertical",
            &VERTICAL_CONTROL,
            |i| if i.vertical == Vertical::Force { 1 } else { 2 },
            |i, item| i.vertical = if item == 1 { Vertical::Force } else { Vertical::Displacement },
            "Prescribed partner of (load, hub height); switching between steps is bumpless",
        ),
        value(
            200,
            "drive.omega",
            units::ROTATION,
            60.0,
            |d| &mut d.omega,
            "Angular velocity, forward rolling positive; unset: from initial.velocity and initial.creepage",
        ),
        value(
            201,
            "drive.moment",
            units::MOMENT,
            1e4,
            |d| &mut d.moment,
            "Driving moment on the hub, forward positive (braking negative)",
        ),
        value(
            202,
            "drive.velocity",
            units::SPEED,
            30.0,
            |d| &mut d.velocity,
            "Travel velocity of the wheel centre, positive in x; unset: initial.velocity",
        ),
        value(
            203,
            "drive.force",
            units::FORCE,
            1e4,
            |d| &mut d.force,
            "Horizontal driving force on the hub, positive in x",
        ),
        value(
            204,
            "drive.load",
            units::FORCE,
            1e5,
            |d| &mut d.load,
            "Vertical load on the hub, pressing down positive; unset: model.nominal_load",
        ),
        value(
            205,
            "drive.displacement",
            units::MILLIMETRE,
            1e-4,
            |d| &mut d.displacement,
            "Hub height above just touching, up positive (pressed: negative)",
        ),
        value(
            206,
            "drive.tread_heat",
            units::POWER,
            1e4,
            |d| &mut d.tread_heat,
            "Heat of the brake blocks into the tread",
        ),
        value(
            250,
            "rail.friction",
            units::NUMBER,
            0.3,
            |d| &mut d.friction,
            "Friction coefficient available now; unset: friction.coefficient",
        ),
    ]
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

fn parameters() -> Vec<Variable> {
    let value = |r, name, measure, field: fn(&mut Config) -> &mut f64, text| {
        row(r, name, real(measure, parameter_range(name), 1.0), Access::RealParameter(field), text)
    };
    let tunable = |variable: Variable| Variable { tunable: true, ..variable };
    let count = |r, name, field: fn(&mut Config) -> &mut usize, text| {
        let [min, max] = parameter_range(name).map(|bound| bound as i32);
        row(r, name, Kind::Integer { min, max }, Access::CountParameter(field), text)
    };
    let response = Access::ChoiceParameter(
        |c| if c.solver.response == Response::Reduced { 1 } else { 2 },
        |c, item| c.solver.response = if item == 1 { Response::Reduced } else { Response::Full },
    );
    let scheme = Access::ChoiceParameter(
        |c| match c.solver.time_scheme {
            TimeScheme::Bdf2 => 1,
            TimeScheme::BackwardEuler => 2,
            TimeScheme::Theta => 3,
        },
        |c, item| {
            c.solver.time_scheme = match item {
                1 => TimeScheme::Bdf2,
                2 => TimeScheme::BackwardEuler,
                _ => TimeScheme::Theta,
            }
        },
    );
    let conductance = Access::ChoiceParameter(
        |c| if c.thermal.conductance_law == ConductanceLaw::Constant { 1 } else { 2 },
        |c, item| {
            c.thermal.conductance_law = if item == 1 { ConductanceLaw::Constant } else { ConductanceLaw::Pressure }
        },
    );
    let hub = Access::ChoiceParameter(
        |c| if c.thermal.hub == Hub::Fixed { 1 } else { 2 },
        |c, item| c.thermal.hub = if item == 1 { Hub::Fixed } else { Hub::Insulated },
    );
    use units::*;
    #[rustfmt::skip]
    let rows = vec![
        row(1000, "preset", Kind::String, Access::Preset, "Name of a parameter set resources/<preset>.json; parameters that are set explicitly override it"),
        value(1010, "model.contact_width", MILLIMETRE, |c| &mut c.model.contact_width, "Width of the line contact: forces of the wheel = width x forces of the plane model"),
        value(1011, "model.nominal_load", FORCE, |c| &mut c.model.nominal_load, "Wheel load for which the mesh is laid out; the candidate contact zone carries at least twice this load"),
        value(1020, "wheel.radius", METRE, |c| &mut c.wheel.radius, "Outer radius of the wheel"),
        value(1021, "wheel.hub_radius", METRE, |c| &mut c.wheel.hub_radius, "Radius of the rigid hub, 0.02 to 0.9 of wheel.radius"),
        value(1022, "wheel.hub_mass", KILOGRAM, |c| &mut c.wheel.hub_mass, "Unsprung mass fixed to the hub, moving in x and y"),
        value(1023, "wheel.hub_inertia", INERTIA, |c| &mut c.wheel.hub_inertia, "Moment of inertia of that mass about the axle"),
        value(1030, "vehicle.mass", TONNE, |c| &mut c.vehicle.mass, "The wheel's share of the vehicle, moving in x only"),
        value(1040, "rail.length", METRE, |c| &mut c.rail.length, "Modelled length of the rail, at least 0.2 wheel.radius"),
        value(1041, "rail.height", METRE, |c| &mut c.rail.height, "Height of the rail, at least 0.02 wheel.radius; its base is fixed"),
        value(1050, "material.youngs_modulus", MODULUS, |c| &mut c.material.youngs_modulus, "Young's modulus of both bodies"),
        value(1051, "material.poissons_ratio", NUMBER, |c| &mut c.material.poissons_ratio, "Poisson's ratio of both bodies"),
        value(1052, "material.density", DENSITY, |c| &mut c.material.density, "Density of both bodies"),
        value(1060, "friction.coefficient", NUMBER, |c| &mut c.friction.coefficient, "Friction coefficient; default of the input rail.friction"),
        value(1053, "material.expansion", PER_KELVIN, |c| &mut c.material.expansion, "Coefficient of linear thermal expansion of both bodies"),
        value(1054, "material.conductivity", CONDUCTIVITY, |c| &mut c.material.conductivity, "Thermal conductivity of both bodies"),
        value(1055, "material.specific_heat", SPECIFIC_HEAT, |c| &mut c.material.specific_heat, "Specific heat capacity of both bodies"),
        tunable(value(1061, "friction.falling_ratio", NUMBER, |c| &mut c.tuning.falling_ratio, "Share of the friction coefficient that remains at high slip velocity (Polach's A); 1: constant")),
        tunable(value(1062, "friction.falling_decay", DECAY, |c| &mut c.tuning.falling_decay, "Decay of the rest with the slip velocity V - r omega (Polach's B)")),
        tunable(value(1063, "friction.softening", PER_KELVIN, |c| &mut c.tuning.softening, "Decrease of the friction coefficient per kelvin of mean contact temperature over thermal.reference; 0: constant")),
        tunable(value(1064, "friction.softening_floor", NUMBER, |c| &mut c.tuning.softening_floor, "Share of the friction coefficient that remains in a hot contact")),
        row(1110, "thermal.enabled", Kind::Boolean, Access::FlagParameter(|c| &mut c.thermal.enabled), "Whether temperatures are computed"),
        value(1111, "thermal.reference", TEMPERATURE, |c| &mut c.thermal.reference, "Absolute temperature of hub, air and arriving rail"),
        value(1112, "thermal.wheel_excess", DIFFERENCE, |c| &mut c.thermal.wheel_excess, "Excess temperature of the whole wheel over the reference at the start (a warm wheel)"),
        value(1113, "thermal.conductance", CONDUCTANCE, |c| &mut c.thermal.conductance, "Contact conductance between wheel and rail"),
        row(1114, "thermal.conductance_law", Kind::Enumeration(&CONDUCTANCE_LAW), conductance, "How the contact conductance depends on pressure"),
        value(1115, "thermal.reference_pressure", PRESSURE, |c| &mut c.thermal.reference_pressure, "Pressure at which the pressure-dependent conductance is thermal.conductance"),
        value(1116, "thermal.heat_ratio", NUMBER, |c| &mut c.thermal.heat_ratio, "Fraction of the friction power that heats wheel and rail"),
        value(1117, "thermal.wheel_share", NUMBER, |c| &mut c.thermal.wheel_share, "Share of that heat first put into the wheel; conduction decides where it goes"),
        row(1118, "thermal.hub", Kind::Enumeration(&HUB), hub, "Thermal boundary condition of the hub"),
        value(1119, "thermal.convection", CONDUCTANCE, |c| &mut c.thermal.convection, "Coefficient of convection from tread and rail head to air at the reference temperature"),
        value(1120, "thermal.max_speed", SPEED, |c| &mut c.thermal.max_speed, "Largest speed at which the thermal layer is resolved"),
        value(1121, "thermal.smallest_load_ratio", NUMBER, |c| &mut c.thermal.smallest_load_ratio, "Smallest load over model.nominal_load at which the patch is thermally resolved"),
        value(1122, "thermal.tread_angle", DEGREE, |c| &mut c.thermal.tread_angle, "Angle of a brake block from the contact point, leading side positive"),
        value(1123, "thermal.tread_width", DEGREE, |c| &mut c.thermal.tread_width, "Arc covered by a brake block"),
        count(1124, "thermal.tread_blocks", |c| &mut c.thermal.tread_blocks, "Brake blocks: one, or two mirrored ones that share drive.tread_heat"),
        tunable(value(1125, "thermal.austenitisation", TEMPERATURE, |c| &mut c.tuning.austenitisation, "Austenitisation temperature Ac1")),
        row(1071, "physics.thermal_expansion", Kind::Boolean, Access::FlagParameter(|c| &mut c.physics.thermal_expansion), "Thermal expansion and stress act back on the contact"),
        row(1072, "physics.thermoelastic_heating", Kind::Boolean, Access::FlagParameter(|c| &mut c.physics.thermoelastic_heating), "Reversible (Gough-Joule) heating of compressed material"),
        row(1070, "physics.centrifugal", Kind::Boolean, Access::FlagParameter(|c| &mut c.physics.centrifugal), "Centrifugal load of the spinning wheel"),
        count(1080, "mesh.elements_per_half_width", |c| &mut c.mesh.elements_per_half_width, "Elements per Hertzian half-width at model.nominal_load"),
        row(1090, "solver.response", Kind::Enumeration(&RESPONSE), response, "How the bodies answer contact tractions"),
        count(1091, "solver.modes_wheel", |c| &mut c.solver.modes_wheel, "Vibration modes kept for the wheel (reduced response)"),
        count(1092, "solver.modes_rail", |c| &mut c.solver.modes_rail, "Vibration modes kept for the rail (reduced response)"),
        row(1093, "solver.time_scheme", Kind::Enumeration(&TIME_SCHEME), scheme, "Implicit time discretisation of momentum and slip"),
        value(1094, "solver.theta", NUMBER, |c| &mut c.solver.theta, "Weight of the new time level in the theta scheme (1: backward Euler, 0.5: Crank-Nicolson)"),
        tunable(value(1095, "solver.max_step", SECOND, |c| &mut c.tuning.max_step, "Largest internal time step; longer communication steps are divided evenly")),
        tunable(value(1096, "solver.tolerance", NUMBER, |c| &mut c.tuning.tolerance, "Error that halves an internal step: contact force over model.nominal_load, contact temperature over its rise or 100 K; 0: no error control")),
        value(1100, "initial.velocity", SPEED, |c| &mut c.initial.velocity, "Travel velocity of the stationary rolling state at the start"),
        value(1101, "initial.creepage", PERCENT, |c| &mut c.initial.creepage, "Its creepage 2 (V - r omega)/(V + r omega)"),
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
    let point = |(first, name, kind, get, text): Profile, i: usize| {
        let (reference, name) = (first + 1 + i as Reference, format!("profile.{name}[{}]", i + 1));
        row(reference, &name, kind, Access::ProfileOutput(get, i), &format!("{text}, point {}", i + 1))
    };
    profiles.into_iter().flat_map(|p| (0..PROFILE_POINTS).map(move |i| point(p, i))).collect()
}
