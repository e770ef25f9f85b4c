//! Outputs of the model at a communication point. An output is one row here, and its value in [`super::outputs`].

use super::output_table::outputs;
use super::profile::points;
use crate::config::units::Measure;
use serde::{Deserialize, Serialize};

/// Where the value of an output is.
#[derive(Clone, Copy, Debug)]
pub enum Read {
    /// A number.
    Real(fn(&Outputs) -> f64),
    /// A count.
    Count(fn(&Outputs) -> u64),
    /// Yes or no.
    Flag(fn(&Outputs) -> bool),
    /// All points of a profile across the contact zone or over the depth, or all lines of the patch.
    Profile(fn(&Outputs) -> &[f64]),
    /// All points of a profile that is computed only when it is asked for; empty until then.
    Deferred(fn(&Outputs) -> &[f64]),
}

/// The row of one output.
#[derive(Clone, Copy, Debug)]
pub struct OutputRow {
    /// Fixed number of the output, which survives new ones: programs may know it. The points of a profile follow it.
    pub number: u32,
    /// Name in the form `group.name`.
    pub name: &'static str,
    /// Unit.
    pub measure: Measure,
    /// Smallest possible value.
    pub low: f64,
    /// Largest possible value.
    pub high: f64,
    /// Usual size.
    pub nominal: f64,
    /// True if it is zero at the start by definition; otherwise it follows from all inputs and parameters there.
    pub starts_at_zero: bool,
    /// Meaning, plain text.
    pub text: &'static str,
    /// The value.
    pub read: Read,
    /// Name and meaning of every point of a profile; empty for other outputs.
    pub points: &'static [(&'static str, &'static str)],
}

outputs! {
    300 contact_force_x: real "contact.force_x", in "N" as "kN", nominal 1e4,
        "Tangential contact force on the wheel, positive in x (traction)";
    301 contact_force_y: real "contact.force_y", in "N" as "kN", nominal 1e5,
        "Normal contact force on the wheel, up positive";
    302 contact_moment: real "contact.moment", in "N.m" as "kN.m", nominal 1e4,
        "Moment of the contact forces about the wheel centre, forward positive";
    303 contact_creepage: real "contact.creepage", in "1" as "%", nominal 1e-3,
        "Creepage 2 (V - r omega)/(V + r omega) with the radius r that the wheel has now, negative in traction; 0 at \
         standstill";
    304 contact_slide: real "contact.slide", in "1" as "%", nominal 1e-3,
        "Slide (V - r omega)/V, 1 when the wheel is locked; 0 at standstill";
    305 contact_slip_velocity: real "contact.slip_velocity", in "m/s" as "mm/s", nominal 1e-2,
        "Rigid slip velocity V - r omega with the radius r that the wheel has now, negative in traction";
    306 contact_adhesion: real "contact.adhesion", in "1", nominal 0.1,
        "Adhesion contact.force_x / contact.force_y; 0 without contact";
    307 contact_utilisation: real "contact.utilisation", in "1" as "%", from 0.0,
        "Share of the friction limit in use: friction force over contact.friction contact.force_y. The friction force is the amount of \
         contact.force_x and contact.force_z together without what pressure on slopes of the rail adds";
    308 contact_stick_fraction: real "contact.stick_fraction", in "1" as "%", from 0.0 to 1.0, nominal 0.5,
        "Sticking share of the contact width";
    309 contact_half_width: real "contact.half_width", in "m" as "mm", from 0.0, nominal 5e-3,
        "Half the distance between the outermost contact edges, on the longest line of the patch";
    319 contact_width: real "contact.width", in "m" as "mm", from 0.0, nominal 1e-2,
        "Width of the patch across the direction of rolling: model.contact_width, or with contact.shape = ellipse or \
         rows that under the present load";
    310 contact_pressure_max: real "contact.pressure_max", in "Pa" as "MPa", from 0.0, nominal 1e9,
        "Largest contact pressure: the peak between the nodes of the contact where they show one, and nowhere less than at a node";
    311 contact_approach: real "contact.approach", in "m" as "mm", nominal 1e-4,
        "Approach of hub and rail base since just touching, pressed positive: rail.elevation - hub.height";
    314 contact_force_min: real "contact.force_y_min", in "N" as "kN", nominal 1e5,
        "Smallest contact.force_y within the last communication step, at the ends of its internal steps";
    315 contact_force_max: real "contact.force_y_max", in "N" as "kN", nominal 1e5,
        "Largest contact.force_y within the last communication step";
    316 contact_impulse: real "contact.impulse_y", in "N.s", nominal 1e2, start zero,
        "Impulse of contact.force_y over the last communication step";
    317 contact_lost_time: real "contact.lost_time", in "s" as "ms", from 0.0, nominal 1e-3, start zero,
        "Time without contact since the start";
    320 contact_line_count: count "contact.line_count",
        "Number of lines on which the patch is computed, seen across its width: those of line.*";
    318 contact_patches: count "contact.patches",
        "Number of contact patches; contact.half_width reaches from the first to the last";
    321 contact_force_z: real "contact.force_z", in "N" as "kN", nominal 1e4,
        "Lateral contact force on the wheel in the plane of contact, to the right positive; without contact.lateral 0, as all of z";
    322 contact_moment_y: real "contact.moment_y", in "N.m", nominal 10.0,
        "Moment of the tractions on the wheel about the normal through the centre of load, z force_x - x force_z, upward positive";
    323 contact_lateral_creepage: real "contact.lateral_creepage", in "1" as "%", nominal 1e-3,
        "Lateral creepage 2 V_z/(V + r omega) with the lateral velocity of the hub; 0 at standstill";
    324 contact_spin: real "contact.spin", in "1/m", nominal 0.1,
        "Spin 2 sigma/(V + r omega), the angular velocity sigma about the normal clockwise from above positive; 0 at standstill";
    325 contact_slip_direction: real "contact.slip_direction", in "rad" as "deg", from -3.15 to 3.15,
        "Direction of the mean slip of the tread on the rail, from that of travel to the right positive; 0 where it sticks";
    326 contact_tread_slip_z: real "contact.tread_slip_z", in "m/s" as "mm/s", nominal 1e-2,
        "Lateral part of the mean slip velocity of the tread, to the right positive";
    327 contact_load_position: real "contact.load_position", in "m" as "mm", nominal 1e-3,
        "Lateral position of the centre of load in the coordinate of contact.rows (of line.position), which moves with wheelset.lateral alone: \
         drive.velocity, drive.lateral_velocity and the radius of rolling are those of this place, and contact.moment_y is about it; 0 on a \
         line and on an ellipse";
    257 rail_profile_height: real "rail.profile_height", in "m" as "mm", nominal 1e-5,
        "Height of rail.profile below the wheel centre, up positive";
    408 wheel_profile_height: real "wheel.profile_height", in "m" as "mm", nominal 1e-5,
        "Height of wheel.profile below the wheel centre, outward positive";
    400 wheel_velocity: real "wheel.velocity", in "m/s" as "km/h", nominal 30.0,
        "Travel velocity V of the wheel centre, positive in x";
    401 wheel_omega: real "wheel.omega", in "rad/s" as "rpm", nominal 60.0,
        "Angular velocity, forward rolling positive";
    402 wheel_distance: real "wheel.distance", in "m", nominal 100.0, start zero, "Distance travelled since the start";
    403 wheel_angle: real "wheel.angle", in "rad" as "deg", nominal 100.0, start zero,
        "Angle turned since the start, forward positive";
    404 wheel_acceleration: real "wheel.acceleration", in "m/s2", "Acceleration of the wheel centre in x";
    405 wheel_angular_acceleration: real "wheel.angular_acceleration", in "rad/s2",
        "Angular acceleration, forward positive";
    406 wheel_mass: real "wheel.mass", in "kg", from 0.0, nominal 100.0,
        "Mass of the wheel: wheel.hub_mass and that of the elastic annulus; vehicle.mass not included";
    407 wheel_inertia: real "wheel.inertia", in "kg.m2", from 0.0, nominal 10.0,
        "Moment of inertia of the wheel about its axle: wheel.hub_inertia and that of the elastic annulus";
    409 flat_length: real "wheel.flat_length", in "m" as "mm", from 0.0, nominal 1e-2,
        "Length of the deepest flat of the wheel along its tread: the stretch around the lowest place of its present profile, as \
         wheel.profile_save writes it, that lies more than 1 um below the level of the tread without waves and roughness; 0 without one";
    410 flat_depth: real "wheel.flat_depth", in "m" as "mm", from 0.0, nominal 1e-5,
        "Depth of that flat below the level of the tread, made by wheel.profile, yielding and wear";
    411 wheel_lateral_velocity: real "wheel.lateral_velocity", in "m/s" as "mm/s", nominal 1e-2,
        "Lateral velocity of the hub in the plane of contact, to the right positive";
    412 wheel_lateral_displacement: real "wheel.lateral_displacement", in "m" as "mm", nominal 1e-3, start zero,
        "Way of the hub to the right since the start";
    500 hub_force_x: real "hub.force_x", in "N" as "kN", nominal 1e4,
        "Horizontal force that drives the hub, prescribed or reaction, positive in x; conjugate to wheel.velocity; gravity \
         on a rail.slope acts besides. The wheel's inertia is between it and contact.force_x, which a master that owns the \
         wheel's mass takes";
    501 hub_force_y: real "hub.force_y", in "N" as "kN", nominal 1e5,
        "Vertical force on the hub, prescribed or reaction, up positive (minus drive.load and drive.load_change); with wheelset.side normal \
         to the plane of contact";
    502 hub_moment: real "hub.moment", in "N.m" as "kN.m", nominal 1e4,
        "Moment that drives the hub, prescribed (drive.moment + brake.torque_actual) or reaction, forward positive; \
         conjugate to wheel.omega";
    503 hub_height: real "hub.height", in "m" as "mm", nominal 1e-4,
        "Height of the hub above just touching a rail of elevation 0, up positive: the partner of drive.displacement";
    504 hub_vertical_velocity: real "hub.vertical_velocity", in "m/s" as "mm/s", nominal 1e-2,
        "Vertical velocity of the hub, up positive; conjugate to hub.force_y";
    505 hub_force_z: real "hub.force_z", in "N" as "kN", nominal 1e4,
        "Lateral force that drives the hub, prescribed or reaction, to the right positive; conjugate to wheel.lateral_velocity";
    506 hub_lateral_power: real "hub.lateral_power", in "W" as "kW", nominal 1e3,
        "Power of hub.force_z: that times wheel.lateral_velocity";
    507 hub_spin_power: real "hub.spin_power", in "W" as "kW", nominal 1e2,
        "Power of what turns the contact about its normal: contact.moment_y times the angular velocity of contact.spin; with \
         wheelset.side that of all that the pose of the wheelset adds to the velocities of the wheel";
    510 wheelset_force_x: real "wheelset.force_x", in "N" as "kN", nominal 1e4,
        "Force of the contact on the wheelset ahead, in the axes of the track; 0 without wheelset.side, as all of wheelset.*";
    511 wheelset_force_y: real "wheelset.force_y", in "N" as "kN", nominal 1e5,
        "Force of the contact on the wheelset upward";
    512 wheelset_force_z: real "wheelset.force_z", in "N" as "kN", nominal 1e4,
        "Force of the contact on the wheelset to the right";
    513 wheelset_moment_x: real "wheelset.moment_x", in "N.m" as "kN.m", nominal 1e5,
        "Moment of these forces about the axis ahead through the middle of the wheelset: positive ones lower its right end";
    514 wheelset_moment_y: real "wheelset.moment_y", in "N.m" as "kN.m", nominal 1e4,
        "Moment of these forces about the axis upward through the middle of the wheelset: positive ones turn it to the left, against \
         wheelset.yaw";
    515 wheelset_moment_z: real "wheelset.moment_z", in "N.m" as "kN.m", nominal 1e4,
        "Moment of these forces about the axis to the right through the middle of the wheelset: positive ones turn against \
         wheel.omega";
    255 rail_energy: real "rail.energy_per_metre", in "J/m" as "kJ/m", from 0.0, nominal 1e3,
        "Friction energy per metre of rail: heat.friction_power over |wheel.velocity|, or over 0.02 m/s if that is more; 0 at \
         standstill. Equal to damage.t_gamma, which means it as a load on the wheel";
    256 heat_per_metre: real "rail.heat_per_metre", in "J/m" as "kJ/m", from 0.0, nominal 1e3,
        "Heat left per metre of rail: heat.to_rail over |wheel.velocity|, or over 0.02 m/s if that is more; 0 at standstill \
         and where the rail gives heat to the wheel. Equal to damage.rail_heat";
    261 brake_moment: real "brake.torque_actual", in "N.m" as "kN.m", nominal 1e4,
        "Moment of the brake on the wheel, forward positive (negative while it brakes forward rolling): brake.torque \
         against the rotation, or while brake.locked the reaction, as its mean over the last internal step";
    262 brake_power: real "brake.power", in "W" as "kW", nominal 1e4,
        "Mean power that the brake took from the wheel in the last communication step";
    263 brake_locked: flag "brake.locked", "Whether the brake holds the wheel at rest";
    600 friction_power: real "heat.friction_power", in "W" as "kW", nominal 1e4,
        "Mean power that friction turned into heat in the last communication step, net of the work of hot material that \
         expands in the contact";
    312 friction: real "contact.friction", in "1", from 0.0, nominal 0.3,
        "Friction coefficient that holds now: rail.friction with the dependence on slip and temperature";
    313 contact_tread_slip: real "contact.tread_slip", in "m/s" as "mm/s", nominal 1e-2,
        "Slip velocity of the tread on the rail: pressure-weighted mean over the patch, deformation included, 0 where it \
         sticks and without contact; what friction that depends on slip follows, with contact.lateral together with \
         contact.tread_slip_z";
    610 temperature_wheel_max: real "temperature.wheel_max", in "K" as "degC", from 0.0, nominal 300.0,
        "Highest surface temperature of the wheel in the contact zone (temperatures are absolute; 0 without \
         thermal.enabled). Where friction melts steel it may be up to 50 K above material.liquidus: a molten film carries \
         no friction from 40 K above it on, and steps that would pass 50 K are refused";
    611 temperature_rail_max: real "temperature.rail_max", in "K" as "degC", from 0.0, nominal 300.0,
        "Highest surface temperature of the rail in the contact zone; of molten steel as for temperature.wheel_max";
    612 temperature_wheel_mean: real "temperature.wheel_mean", in "K" as "degC", from 0.0, nominal 300.0,
        "Mean surface temperature of the wheel over the contact patch";
    613 temperature_rail_mean: real "temperature.rail_mean", in "K" as "degC", from 0.0, nominal 300.0,
        "Mean surface temperature of the rail over the contact patch";
    617 temperature_friction: real "temperature.friction", in "K" as "degC", from 0.0, nominal 300.0,
        "Temperature at which friction acts: pressure-weighted mean over the contact patch of the surface temperatures of \
         wheel and rail; friction.softening counts from it, and contact.friction belongs to it; thermal.reference without contact";
    614 temperature_wheel_nominal: real "temperature.wheel_nominal", in "K" as "degC", from 0.0, nominal 300.0,
        "Surface temperature of the wheel below its centre";
    615 temperature_rail_nominal: real "temperature.rail_nominal", in "K" as "degC", from 0.0, nominal 300.0,
        "Surface temperature of the rail below the wheel centre";
    616 temperature_wheel_bulk: real "temperature.wheel_bulk", in "K" as "degC", from 0.0, nominal 300.0,
        "Mean temperature of the whole wheel over its volume: of rim, web and boss, or with thermal.cross_section = contact \
         of a slice as wide as the contact";
    601 heat_to_wheel: real "heat.to_wheel", in "W" as "kW", nominal 1e4, "Net heat into the wheel through the contact";
    602 heat_to_rail: real "heat.to_rail", in "W" as "kW", nominal 1e4,
        "Net heat into the rail through the contact; with heat.to_wheel it makes thermal.heat_ratio x \
         heat.friction_power";
    603 heat_conduction: real "heat.conduction", in "W" as "kW", nominal 1e3,
        "Heat conducted from wheel to rail across the interface";
    604 heat_to_hub: real "heat.to_hub", in "W" as "kW", nominal 1e3, "Heat from the wheel into the hub";
    605 heat_to_air: real "heat.to_air", in "W" as "kW", nominal 1e3,
        "Heat from the wheel to air by thermal.convection";
    620 thermal_growth: real "thermal.growth", in "m" as "mm", nominal 1e-5,
        "Growth of the wheel radius by its bulk temperature";
    701 austenitised_time: real "damage.time_above_ac1", in "s", from 0.0, nominal 1e-2, start zero,
        "Longest time that a point of the wheel's material was above thermal.austenitisation so far: all its passes \
         through the contact zone, and for a place that was heated in one piece what came after";
    702 peak_temperature: real "damage.peak_temperature", in "K" as "degC", from 0.0, nominal 300.0,
        "Temperature of the hottest point of the tread so far, absolute; 0 without thermal.enabled";
    703 ac1_depth: real "damage.ac1_depth", in "m" as "mm", from 0.0, nominal 1e-3, start zero,
        "Largest depth in the wheel to which thermal.austenitisation was exceeded so far, at places that the contact \
         heated while the wheel (nearly) stood still";
    704 cooling_rate: real "damage.cooling_rate", in "K/s", from 0.0, nominal 1e3, start zero,
        "Mean cooling rate from 800 to 500 degC (from thermal.austenitisation, if it was hotter than that but not than \
         800 degC) of the point of these places that was longest above it; 0 until it has cooled to 500 degC";
    705 martensite_depth: real "damage.martensite_depth", in "m" as "mm", from 0.0, nominal 1e-3, start zero,
        "Largest depth of at least half martensite that there is now at these places: austenitised, cooled at damage.critical_cooling or \
         faster, far enough below damage.martensite_start, and not austenite again. Places that made room for others, beyond eight, keep theirs";
    706 flats: count "damage.flats", start zero,
        "Places of the tread that the contact heated by more than damage.threshold while the wheel (nearly) stood still; places \
         that touch each other count once";
    720 hottest_point: real "damage.hottest_point", in "rad" as "deg", from 0.0, nominal 1.0, start zero,
        "Value of wheel.angle at which the place touches that became hottest over its depth, of those counted by damage.flats: where the \
         highest temperatures so far have the largest integral over the depth. For thermal.tread_point; 0 without any";
    721 hot_places: count "damage.hot_places", start zero,
        "Parts of the places counted by damage.flats that are still hot, up to 8: while there are any, steel cools, and \
         damage.cooling_rate and damage.martensite_depth may change";
    707 rail_peak: real "damage.rail_peak", in "K" as "degC", from 0.0, nominal 300.0,
        "Temperature of the hottest point of the rail that has passed the contact so far, absolute; 0 without \
         thermal.enabled";
    708 rail_heat: real "damage.rail_heat", in "J/m" as "kJ/m", from 0.0, nominal 1e3,
        "Heat that the contact leaves behind per metre of rail: heat.to_rail over |wheel.velocity|, or over 0.02 m/s if that \
         is more; 0 at standstill and where the rail gives heat to the wheel. Equal to rail.heat_per_metre";
    710 yielded: real "damage.yielded", in "1" as "%", from 0.0 to 1.0, nominal 0.1,
        "Share of the contact width in which the steel yields now";
    711 flattening: real "damage.flattening", in "m" as "mm", from 0.0, nominal 1e-5, start zero,
        "Depth of the deepest permanent flattening of the wheel so far";
    712 flattening_rail: real "damage.flattening_rail", in "m" as "mm", from 0.0, nominal 1e-5, start zero,
        "Depth of the deepest permanent flattening of the modelled piece of rail";
    713 melted: real "damage.melted", in "m" as "mm", from 0.0, nominal 1e-5, start zero,
        "Largest thickness of molten steel below the surface of wheel or rail so far";
    719 molten: real "damage.molten", in "1" as "%", from 0.0 to 1.0, nominal 0.1,
        "Share of the contact width in which a film of molten steel takes friction away now; 0 without contact, and where all of it is \
         colder than material.solidus";
    803 heat_residual: real "solver.heat_residual", in "1", nominal 1e-9, start zero,
        "Heat balance since the start: unaccounted heat over all heat that has flowed, from sources and from warm places to cold ones; \
         0 where none has";
    714 surface_fatigue: real "damage.fi_surf", in "1", from -1.0, nominal 0.1,
        "Surface fatigue index: contact.force_x and contact.force_z together over contact.force_y, less the yield strength in shear over contact.pressure_max; \
         fatigue of the surface is to be expected where it is positive; -1 without contact";
    715 wear_rate: real "damage.wear_rate", in "kg/m" as "mg/m", from 0.0, nominal 1e-6,
        "Mass that the wheel loses per distance rolled by wear: in three regimes of damage.t_gamma over the area of the \
         contact, times damage.wear_factor; damage.wear says whether its profile changes by it";
    716 worn_mass: real "damage.worn_mass", in "kg" as "g", from 0.0, nominal 1e-3, start zero,
        "Mass that wear has taken off the wheel since the start; 0 with damage.wear = off";
    717 worn_depth: real "damage.worn_depth", in "m" as "mm", from 0.0, nominal 1e-5, start zero,
        "Depth to which the most worn place of the tread is worn off since the start";
    718 worn_depth_rail: real "damage.worn_depth_rail", in "m" as "mm", from 0.0, nominal 1e-5, start zero,
        "The same of the modelled piece of rail, where the contact stayed";
    700 t_gamma: real "damage.t_gamma", in "N", from 0.0, nominal 10.0,
        "Friction energy per metre travelled: heat.friction_power over |wheel.velocity|, or over 0.02 m/s if that is more; 0 at \
         standstill. Equal to rail.energy_per_metre, which means it as a load on the rail";
    800 internal_steps: count "solver.internal_steps", start zero, "Internal time steps in the last communication step";
    806 limited_steps: count "solver.limited_steps", start zero,
        "Internal steps in the last communication step whose error solver.max_internal_steps let exceed solver.tolerance";
    807 force_error: real "solver.force_error", in "N", from 0.0, nominal 100.0, start zero,
        "Estimated error of the contact forces by the length of the internal steps: what the forces missed of a straight course in each one of the last \
         communication step, summed up, or what is left of earlier estimates, which fade in 5 ms. Mostly several times the error";
    808 temperature_error: real "solver.temperature_error", in "K", from 0.0, nominal 1.0, start zero,
        "The same of the mean temperatures of the patch";
    801 iterations: count "solver.iterations", start zero, "Contact iterations in the last communication step";
    804 suggested_step: real "solver.suggested_step", in "s", from 0.0, nominal 1e-3,
        "Largest communication step for explicit coupling: from creep damping and contact stiffness where velocities \
         or the hub height were prescribed in the last step, 1 s otherwise";
    802 energy_residual: real "solver.energy_residual", in "1", nominal 1e-2, start zero,
        "Energy balance since the start: unaccounted over dissipated energy, at least the elastic energy of the \
         contact";
    810 hub_work: real "energy.hub_work", in "J" as "kJ", nominal 1e5, start zero,
        "Work of the hub forces and the hub moment since the start, and of what turns the contact about its normal";
    811 thermal_work: real "energy.thermal_work", in "J" as "kJ", nominal 1e2, start zero,
        "Work of heat since the start: the wheel that grows lifts its load, hot layers swell and pull at the surfaces";
    812 stored_energy: real "energy.stored", in "J" as "kJ", nominal 1e5, start zero,
        "Growth of kinetic and elastic energy, less the work of the centrifugal load, since the start; with friction, damping and solver.energy_residual it \
         balances energy.hub_work + energy.thermal_work + energy.gravity + energy.rail_work";
    817 gravity_work: real "energy.gravity", in "J" as "kJ", nominal 1e5, start zero,
        "Work of gravity along the track since the start, negative uphill";
    818 lift_work: real "energy.rail_work", in "J" as "kJ", nominal 1e2, start zero,
        "Work of the rail that rises under the wheel by rail.elevation since the start";
    816 brake_energy: real "energy.brake", in "J" as "kJ", nominal 1e5, start zero,
        "Energy that the brake has taken from the wheel since the start; energy.hub_work is net of it";
    813 friction_energy: real "energy.friction", in "J" as "kJ", nominal 1e5, start zero,
        "Energy that friction has turned into heat since the start";
    815 plastic_energy: real "energy.plastic", in "J" as "kJ", nominal 1e2, start zero,
        "Work of permanent flattening since the start, and of the pressure on what wears off";
    814 damping_energy: real "energy.damping", in "J" as "kJ", nominal 1e2, start zero,
        "Energy dissipated by damping and radiated by quiet ends of the rail since the start";
    10000 profile_x: profile "profile.x", in "m" as "mm", nominal 5e-3,
        "Position across the contact patch, positive ahead of the wheel centre";
    11000 profile_pressure: profile "profile.pressure", in "Pa" as "MPa", nominal 1e9, "Contact pressure";
    12000 profile_shear: profile "profile.shear", in "Pa" as "MPa", nominal 1e8,
        "Shear traction on the wheel, positive in x";
    13000 profile_slip: profile "profile.slip", in "m/s" as "mm/s", nominal 1e-2, "Local slip velocity";
    24000 profile_shear_z: profile "profile.shear_z", in "Pa" as "MPa", nominal 1e8,
        "Lateral shear traction on the wheel, to the right positive";
    25000 profile_slip_z: profile "profile.slip_z", in "m/s" as "mm/s", nominal 1e-2,
        "Lateral part of the local slip velocity, to the right positive";
    14000 profile_temperature_wheel: profile "profile.temperature_wheel", in "K" as "degC", from 0.0, nominal 300.0,
        "Surface temperature of the wheel";
    15000 profile_temperature_rail: profile "profile.temperature_rail", in "K" as "degC", from 0.0, nominal 300.0,
        "Surface temperature of the rail";
    22000 line_position: lines "line.position", in "m" as "mm", nominal 5e-3,
        "Lateral position of a line of the patch, from its middle; 0 for lines beyond contact.lines, as all that follows";
    22100 line_half_length: lines "line.half_length", in "m" as "mm", from 0.0, nominal 5e-3,
        "Half the distance between the outermost contact edges of a line";
    22200 line_force_x: lines "line.force_x", in "N" as "kN", nominal 1e3,
        "Tangential force of a line on the wheel, positive in x; contact.force_x is their sum";
    22300 line_force_y: lines "line.force_y", in "N" as "kN", nominal 1e4,
        "Normal force of a line on the wheel; contact.force_y is their sum";
    22400 line_pressure_max: lines "line.pressure_max", in "Pa" as "MPa", from 0.0, nominal 1e9,
        "Largest pressure of a line";
    23200 line_force_z: lines "line.force_z", in "N" as "kN", nominal 1e3,
        "Lateral force of a line on the wheel, to the right positive; contact.force_z is their sum";
    23300 line_tread_slip_z: lines "line.tread_slip_z", in "m/s" as "mm/s", nominal 1e-2,
        "Lateral part of line.tread_slip, to the right positive";
    22500 line_stick: lines "line.stick_fraction", in "1" as "%", from 0.0 to 1.0, nominal 0.5, "Sticking share of a line";
    22600 line_friction: lines "line.friction", in "1", from 0.0, nominal 0.3, "Friction coefficient of a line";
    22700 line_tread_slip: lines "line.tread_slip", in "m/s" as "mm/s", nominal 1e-2,
        "Pressure-weighted mean slip velocity of a line";
    22800 line_friction_power: lines "line.friction_power", in "W" as "kW", nominal 1e3,
        "Power that friction on a line turns into heat at the end of the communication step";
    22900 line_temperature_wheel: lines "line.temperature_wheel_max", in "K" as "degC", from 0.0, nominal 300.0,
        "Highest surface temperature of the wheel on a line";
    23000 line_temperature_rail: lines "line.temperature_rail_max", in "K" as "degC", from 0.0, nominal 300.0,
        "Highest surface temperature of the rail on a line";
    23100 line_width: lines "line.width", in "m" as "mm", from 0.0, nominal 1e-3,
        "Width of a line across the direction of rolling; contact.width is their sum, without gaps between rows";
    17000 profile_depth: profile "profile.depth", in "m" as "mm", from 0.0 to 1.0, nominal 5e-3,
        "Depth below the tread";
    18000 profile_peak: profile "profile.peak_temperature", in "K" as "degC", from 0.0, nominal 300.0,
        "Highest temperature so far at that depth, of the places counted by damage.flats; thermal.reference without any";
    26000 profile_martensite: profile "profile.martensite", in "1" as "%", from 0.0 to 1.0, nominal 0.5,
        "Largest share of martensite that there is now at that depth, of the places counted by damage.flats: steel that is hot has none, \
         nor has what became austenite again; 0 without any";
    27000 profile_hottest_below: deferred "profile.temperature_hottest_below", in "K" as "degC", from 0.0, nominal 300.0,
        "Temperature of the wheel below damage.hottest_point, at profile.depth; below the contact point as long as there is none";
    19000 profile_wheel_below: deferred "profile.temperature_wheel_below", in "K" as "degC", from 0.0, nominal 300.0,
        "Temperature of the wheel below the contact point, at profile.depth";
    20000 profile_rail_below: deferred "profile.temperature_rail_below", in "K" as "degC", from 0.0, nominal 300.0,
        "Temperature of the rail below the contact point, at profile.depth";
    21000 profile_tread_below: deferred "profile.temperature_tread_below", in "K" as "degC", from 0.0, nominal 300.0,
        "Temperature of the wheel below the point of its tread at thermal.tread_point, at profile.depth";
}
