//! The table of parameters: a parameter is one row here, and its use in the code.
//!
//! Struct field with documentation, default (the preset `railway`), range check, access by name, the interface and the
//! reference pages follow from the row. A range holds all values that make sense with some values of the others; ranges
//! that depend on other parameters are checked by [`Config::validate`]. `basic` rows are those that most users set;
//! they come first in the reference. A row that is taken out moves to [`super::retired`]. Fields that are `inside` are no
//! parameters: only code sets them, that of tests and of the thesis.

use super::choices::*;
use super::row::parameters;
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

parameters! {
    /// All parameters of one wheel on one rail.
    pub struct Config {
        /// Map between the two-dimensional model and the whole wheel, and size of the contact zone.
        model: ModelParameters fixed {
            1010 basic contact_width: f64 = 0.014, in "m" as "mm", from 1e-4 to 10.0,
                "Width of the line contact: forces of the wheel = width x forces of the plane model. It counts with \
                 contact.shape = line only";
            1200 expert structural_width: f64 = 0.073, in "m" as "mm", from 1e-3 to 10.0,
                "Width of the bodies of wheel and rail where the patch has a width of its own (contact.shape = ellipse or rows): forces \
                 of the wheel = width x forces of the plane bodies";
            1011 basic nominal_load: f64 = 100e3, in "N" as "kN", from 1e-3 to 1e9,
                "Wheel load for which the mesh is laid out, with a contact that fits wheel and rail; the candidate \
                 contact zone carries at least twice this load";
        }
        /// Deformable annulus on a rigid hub.
        wheel: Wheel fixed {
            1020 basic radius: f64 = 0.46, in "m", from 0.01 to 10.0, "Outer radius of the wheel";
            1021 expert hub_radius: f64 = 0.046, in "m", from 2e-4 to 9.0,
                "Radius of the rigid hub, 0.02 to 0.9 of wheel.radius";
            1022 basic hub_mass: f64 = 250.0, in "kg", from 0.0 to 1e6, "Unsprung mass fixed to the hub, moving in x and y";
            1190 basic profile: String = String::new(),
                "Shape of the tread besides the circle, fixed to the wheel and closed after a turn: shapes with parameters, or \
                 the name of a file, see docs/profiles.md; empty: round";
            1023 basic hub_inertia: f64 = 15.0, in "kg.m2", from 0.0 to 1e6, "Moment of inertia of that mass about the axle";
            1204 expert lateral_mass: f64 = 0.0, in "kg", from 0.0 to 1e6,
                "Mass that moves sideways with the hub besides the wheel and wheel.hub_mass: what the wheelset adds; it counts with \
                 contact.lateral only";
        }
        /// Vehicle that the wheel pulls along; the suspension carries it vertically.
        vehicle: Vehicle fixed {
            1030 basic mass: f64 = 9872.0, in "kg" as "t", from 0.0 to 1e9,
                "The wheel's share of the vehicle, moving in x only";
            1031 basic damping: f64 = 20e3, in "N.s/m" as "kN.s/m", from 0.0 to 1e12,
                "Vertical damper between hub and vehicle, which does not move vertically; acts where drive.load drives the hub";
        }
        /// Plate below the wheel, and the track that carries it.
        rail: Rail fixed {
            1040 expert length: f64 = 1.0, in "m", from 2e-3 to 100.0,
                "Modelled length of the rail, at least 0.2 wheel.radius";
            1041 expert height: f64 = 0.1, in "m", from 2e-4 to 10.0,
                "Height of the rail, at least 0.02 wheel.radius; its base is a rigid line";
            1191 basic profile: String = String::new(),
                "Shape of the rail head besides the plane, fixed to the rail: shapes with parameters, or the name of a file, see \
                 docs/profiles.md; empty: plane";
            1042 basic support_stiffness: f64 = 0.0, in "N/m" as "MN/m", from 0.0 to 1e15,
                "Vertical stiffness of the track below the rail base; 0: rigid";
            1043 expert support_damping: f64 = 0.0, in "N.s/m" as "kN.s/m", from 0.0 to 1e12,
                "Vertical damping of the track, 0 if it is rigid";
            1044 expert support_mass: f64 = 0.0, in "kg", from 0.0 to 1e6,
                "Mass of the track that moves with the rail base, 0 if it is rigid in both directions";
            1045 expert restraint_stiffness: f64 = 4e8, in "N/m" as "MN/m", from 0.0 to 1e15,
                "Longitudinal stiffness of the rail's restraint; 0: rigid";
            1046 expert restraint_damping: f64 = 1e6, in "N.s/m" as "kN.s/m", from 0.0 to 1e12,
                "Longitudinal damping of the restraint, 0 if it is rigid";
            1048 expert ends: RailEnds = RailEnds::Free, "What the ends of the modelled rail do to waves";
        }
        /// Brake of the wheel; its strength is the input `brake.torque`.
        brake: BrakeParameters fixed {
            1170 basic tread_share: f64 = 0.0, from 0.0 to 1.0,
                "Share of brake.power that heats the tread, where thermal.tread_angle and the like put it, besides \
                 drive.tread_heat: 0 for discs, about 0.9 for blocks";
        }
        /// Patch in which wheel and rail touch.
        contact: ContactParameters fixed {
            1196 basic shape: ContactShape = ContactShape::Line, "Shape of the patch in which wheel and rail touch";
            1197 basic lines: usize = 7, from 1 to 13,
                "Lines of the patch across its width; those of a symmetric pair are computed once";
            1203 basic lateral: bool = false,
                "Whether the contact has lateral creepage, spin, lateral force and spin moment, with contact.shape = ellipse or rows; \
                 without it drive.lateral_velocity, drive.lateral_force, drive.spin and drive.contact_angle are refused";
            1212 expert layer_flexibility: f64 = 0.0, in "m/Pa" as "um/MPa", from 0.0 to 1e-9,
                "Flexibility of an elastic layer of dirt, oxide or leaves between wheel and rail along the surfaces: thickness over \
                 shear modulus; it lowers the slope of the creep curve. 0: the surfaces touch";
            1198 expert wheel_lateral_radius: f64 = 0.0, in "m" as "mm", from -100.0 to 100.0,
                "Radius of curvature of the tread across the direction of rolling, positive where it is convex, negative \
                 where it is hollow; 0: straight, as a cone is";
            1201 basic rows: String = String::new(),
                "Patch under contact.rows_load with contact.shape = rows: the name of a .csv file, or its content with ; between \
                 the lines, with the columns position,half_length,load_share and, where distances differ, width; with wheelset.side also \
                 angle,radius,lateral, and shift for patches that move with the wheelset, see docs/patches.md";
            1202 expert rows_load: f64 = 100e3, in "N" as "kN", from 1e-3 to 1e9,
                "Load of the patch that contact.rows describes; under other loads its lengths go with the third root of the load";
            1199 basic rail_lateral_radius: f64 = 0.3, in "m" as "mm", from -100.0 to 100.0,
                "Radius of curvature of the rail head across the direction of rolling, positive where it is convex; 0: straight. \
                 Wheel and rail together must be convex";
        }
        /// Wheelset to which the wheel belongs.
        wheelset: WheelsetParameters fixed {
            1220 basic side: WheelsetSide = WheelsetSide::None,
                "Which wheel of a wheelset it is, with contact.lateral: hosts then give the pose of the wheelset, wheelset.lateral and \
                 the like, and take wheelset.force_x and the like";
            1221 expert half_spacing: f64 = 0.75, in "m", from 0.1 to 2.0,
                "Half of the distance of the running circles, from the middle of the wheelset to the zero of contact.rows";
        }
        /// Isotropic linear elastic material of both bodies.
        material: Material fixed {
            1050 basic youngs_modulus: f64 = 210e9, in "Pa" as "GPa", from 1e5 to 1e13, "Young's modulus of both bodies";
            1051 basic poissons_ratio: f64 = 0.3, from 0.0 to 0.49, "Poisson's ratio of both bodies";
            1052 basic density: f64 = 7850.0, in "kg/m3", from 1.0 to 1e5, "Density of both bodies";
            1053 basic expansion: f64 = 1.2e-5, in "1/K", from 0.0 to 1e-3,
                "Coefficient of linear thermal expansion of both bodies";
            1054 basic conductivity: f64 = 50.0, in "W/(m.K)", from 1e-3 to 1e5, "Thermal conductivity of both bodies";
            1055 basic specific_heat: f64 = 470.0, in "J/(kg.K)", from 1.0 to 1e5, "Specific heat capacity of both bodies";
            1056 basic yield_strength: f64 = 550e6, in "Pa" as "MPa", from 1e5 to 1e12,
                "Yield strength of cold steel; up to 400 degC it is kept, at 600 degC 47 %, at 800 degC 11 % of it are left";
            1165 expert solidus: f64 = 1723.0, in "K" as "degC", from 300.0 to 1e4, "Temperature at which melting begins";
            1166 expert liquidus: f64 = 1803.0, in "K" as "degC", from 310.0 to 1.1e4,
                "Temperature at which melting is complete, at least 10 K above material.solidus";
            1167 expert latent_heat: f64 = 270e3, in "J/kg" as "kJ/kg", from 0.0 to 1e7,
                "Heat of melting; 0, or thermal.reference above material.solidus: melting is left out";
            1168 expert film_friction: f64 = 0.02, from 0.0 to 1.0,
                "Share of the friction coefficient that remains on molten steel; 1: melting leaves friction alone";
        }
        /// Damping ratios of the vibration modes of both bodies, on the rate of the *material*; all zero: none.
        damping: Damping fixed {
            1131 expert wheel_torsion: f64 = 1e-2, from 0.0 to 1.0,
                "Damping ratio of the wheel's circumferential modes without nodal diameters (torsion on the hub)";
            1132 expert wheel_radial: f64 = 1e-3, from 0.0 to 1.0,
                "Damping ratio of the wheel's radial modes without nodal diameters";
            1133 expert wheel_one_diameter: f64 = 1e-2, from 0.0 to 1.0,
                "Damping ratio of the wheel's modes with one nodal diameter (the rim shifts against the hub)";
            1134 expert wheel_more_diameters: f64 = 1e-4, from 0.0 to 1.0,
                "Damping ratio of the wheel's modes with two and more nodal diameters";
            1135 expert rail: f64 = 1e-2, from 0.0 to 1.0, "Damping ratio of the modes of the rail";
        }
        /// Coulomb friction; the law that lowers the coefficient is part of [`Tuning`].
        friction: Friction fixed {
            1060 basic coefficient: f64 = 0.3, from 0.0 to 10.0, "Friction coefficient; default of the input rail.friction";
        }
        /// Heat in wheel, rail and contact.
        thermal: Thermal fixed {
            1110 basic enabled: bool = true, "Whether temperatures are computed";
            1111 basic reference: f64 = 293.0, in "K" as "degC", from 1.0 to 1e4,
                "Absolute temperature of hub, air and arriving rail";
            1112 basic wheel_excess: f64 = 0.0, in "K", from -1e3 to 5e3,
                "Excess temperature of the whole wheel over the reference at the start (a warm wheel), above absolute zero";
            1113 expert conductance: f64 = 1e8, in "W/(m2.K)", from 0.0 to 1e12, "Contact conductance between wheel and rail";
            1116 expert heat_ratio: f64 = 1.0, from 0.0 to 1.0, "Fraction of the friction power that heats wheel and rail";
            1118 expert hub: Hub = Hub::Fixed, "Thermal boundary condition of the hub";
            1119 basic convection: f64 = 0.0, in "W/(m2.K)", from 0.0 to 1e5,
                "Coefficient of convection to air at the reference temperature, from tread, rim, web and rail head; with \
                 thermal.cross_section = contact from the width of the contact on tread and rail head";
            1120 expert max_speed: f64 = 60.0, in "m/s" as "km/h", from 0.1 to 200.0,
                "Largest speed at which the thermal layer is resolved";
            1121 expert smallest_load_ratio: f64 = 0.5, from 0.05 to 1.0,
                "Smallest load over model.nominal_load at which the patch is thermally resolved";
            1122 expert tread_angle: f64 = FRAC_PI_2, in "rad" as "deg", from -3.2 to 3.2,
                "Angle of a brake block from the contact point, leading side positive";
            1123 expert tread_width: f64 = FRAC_PI_4, in "rad" as "deg", from 1e-3 to 6.2, "Arc covered by a brake block";
            1124 expert tread_blocks: usize = 2, from 1 to 2,
                "Brake blocks: one, or two mirrored ones that share drive.tread_heat";
            1150 expert cross_section: CrossSection = CrossSection::Bodies, "How wide the bodies conduct heat";
            1151 expert rim_width: f64 = 0.135, in "m" as "mm", from 1e-3 to 1.0,
                "Width of the wheel's rim; a rim narrower than the contact counts as wide as that";
            1152 expert rim_depth: f64 = 0.06, in "m" as "mm", from 1e-4 to 10.0,
                "Depth of the rim below the tread; down to the hub where that is nearer";
            1153 expert web_width: f64 = 0.025, in "m" as "mm", from 1e-4 to 1.0, "Width of the wheel's web";
            1155 expert boss_radius: f64 = 0.13, in "m", from 0.0 to 10.0,
                "Outer radius of the boss; below wheel.hub_radius there is none";
            1156 expert head_width: f64 = 0.072, in "m" as "mm", from 1e-3 to 1.0,
                "Width of the rail head, down to the base of the rail; at least that of the contact";
            1157 expert block_width: f64 = 0.08, in "m" as "mm", from 1e-3 to 1.0,
                "Width of a brake block on the tread, at least that of the contact and at most that of the rim";
            inside wheel_share: f64 = 0.5, "Share of the heat of friction first put into the wheel; conduction decides where it goes";
            inside boss: f64 = 0.17 / 0.135, "Width of the wheel's boss over that of its rim";
        }
        /// History of hot material; what decides about the structure of steel is part of [`Tuning`].
        damage: DamageParameters fixed {
            1163 expert resolution: f64 = 1.0, from 0.25 to 4.0,
                "Size of the elements and time steps in which hot places of the tread are followed, relative to the \
                 usual one";
            1171 basic wear: Wear = Wear::Off, "Whether wear changes the profile of the wheel, and of the rail where the contact stays";
            1177 expert wear_factor: f64 = 1.0, from 0.0 to 1e3,
                "Mass that wears off over that of the wheel steel R8T on rails of grade 900A, dry, in twin-disc tests, Braghin, Lewis, \
                 Dwyer-Joyce, Bruni, Wear 261 (2006): for other steels and for lubricated rails; damage.wear_rate has it, too, where \
                 damage.wear is off";
        }
        /// Switches for parts of the physics.
        physics: Physics fixed {
            1072 expert thermoelastic_heating: bool = false, "Reversible (Gough-Joule) heating of compressed material";
            1073 expert yielding: bool = true,
                "Steel yields: the pressure stays below 2.97 times the yield strength, less under the friction of a locked wheel, what it \
                 cannot carry flattens the surface for good";
            inside centrifugal: bool = true, "Centrifugal load of the spinning wheel";
        }
        /// Layout of the graded meshes.
        mesh: MeshParameters fixed {
            1080 basic elements_per_half_width: usize = 10, from 4 to 80,
                "Elements of bodies and heat per Hertzian half-width at model.nominal_load";
            1193 expert grid_elements_per_half_width: usize = 10, from 4 to 80,
                "Contact nodes per Hertzian half-width: at least as many, since nodes divide every element of the surface \
                 evenly, and one per element where there are more elements";
            1081 expert reach: f64 = 0.0, in "m" as "mm", from 0.0 to 1.0,
                "Distance from the contact point up to which contact is looked for at least where a patch needs it, as far as wheel \
                 and rail have room; 0: about six half-widths at model.nominal_load, and the edges of every flat in wheel.profile";
        }
        /// Numerical choices.
        solver: SolverParameters fixed {
            inside reduced: bool = true, "Bodies answer contact tractions by vibration modes, else by all finite elements";
            inside modes_wheel: usize = 80, "Vibration modes kept for the wheel";
            inside modes_rail: usize = 40, "Vibration modes kept for the rail";
        }
        /// Stationary rolling state from which the run starts.
        initial: Initial fixed {
            1100 basic velocity: f64 = 100.0 / 3.6, in "m/s" as "km/h", from -200.0 to 200.0,
                "Travel velocity of the stationary rolling state at the start, slower than surface waves";
            1101 basic creepage: Option<f64> = None, in "1" as "%", from -1.99 to 2.0,
                "Its creepage 2 (V - r omega)/(V + r omega), with a rim slower than surface waves; unset: that of \
                 quasi-steady rolling under drive.moment and drive.force, free of tangential force without them. The start \
                 value 0 counts as unset unless initial.given says otherwise";
            1103 expert given: Given = Given::Changed,
                "Which inputs count that are written before the end of initialization, and whether initial.creepage does; the \
                 others follow from the parameters. During the run every input counts that is written";
            1102 basic temperature: StartTemperature = StartTemperature::Uniform,
                "Temperatures at the start; its friction and thermal deformation are those of these temperatures";
        }
        /// Parameters that may change during a run: nothing that is computed in advance depends on them.
        ///
        /// The friction coefficient of a step is
        ///
        /// `μ(s, T) = rail.friction · (A + (1 − A) e^{−B|s|}) · max(m, 1 − K (T − T_ref))`
        ///
        /// with `A` the falling ratio, `B` the falling decay, `K` the softening, `m` the softening floor, the mean slip
        /// velocity `s` of the tread, and the mean contact temperature `T`, weighted with the pressure
        /// (`temperature.friction`), both at the end of the step. The falling part is that of O. Polach, *Wear* 258
        /// (2005). The slip velocity is solved for with the contact; the temperature is `T − T_ref = θ μ` with the
        /// heating θ extrapolated, which makes the last factor `1/(1 + K θ · rail.friction · (…))`. Within a step the
        /// friction cone is exact.
        tuning: Tuning tunable {
            1061 basic falling_ratio: f64 = 1.0, of "friction", from 0.0 to 1.0,
                "Share of the friction coefficient that remains at high slip velocity (Polach's A); 1: constant";
            1062 basic falling_decay: f64 = 0.0, of "friction", in "s/m", from 0.0 to 1e3,
                "Decay of the rest with the slip velocity of the tread (Polach's B)";
            1063 basic softening: f64 = 0.001, of "friction", in "1/K", from 0.0 to 1.0,
                "Decrease of the friction coefficient per kelvin by which temperature.friction, the pressure-weighted mean of \
                 both surfaces, exceeds thermal.reference; 0: constant";
            1064 expert softening_floor: f64 = 0.1, of "friction", from 0.0 to 1.0,
                "Share of the friction coefficient that remains in a hot contact";
            1065 expert memory_length: f64 = 0.0, of "friction", in "m" as "mm", from 0.0 to 1e3,
                "Sliding distance over which the coefficient follows the law of slip and temperature; 0: 25 um where friction falls \
                 with the slip, else at once. A tiny length makes falling friction follow at once, too: it jumps in short steps";
            1095 basic max_step: f64 = 0.1, of "solver", in "s", from 0.0 to 500.0,
                "Largest internal time step; longer communication steps are divided evenly; 0: 0.1 s, and a fortieth of the \
                 time in which the shortest wave of wheel.profile and rail.profile near the contact passes. While rail.elevation \
                 varies, a step of up to 20 ms is divided to 2 ms in any case";
            1096 basic tolerance: f64 = 0.002, of "solver", from 0.0 to 1.0,
                "Error that halves an internal step: contact force over load, moment over load times radius, slip over \
                 that of a sliding patch, temperature over its rise or 100 K; 0: no error control";
            1194 basic max_internal_steps: usize = 100_000, of "solver", from 1 to 100_000,
                "Most internal steps of a communication step that solver.tolerance asks for, those included that turned out \
                 too long: a bound on the computing time. solver.limited_steps counts those it spoils";
            1125 expert austenitisation: f64 = 1000.0, of "thermal", in "K" as "degC", from 1.0 to 1e4,
                "Austenitisation temperature Ac1";
            1195 expert tread_point: f64 = 0.0, of "thermal", in "rad" as "deg", from -1e9 to 1e9,
                "Value of wheel.angle at which the point of the tread touches the rail below which temperatures are given over the \
                 depth; 0: the point that touches at the start. For a place that the locked wheel heats, the angle at which it is \
                 locked. Elsewhere these temperatures are means over the length of an element along the tread";
            1211 expert shown_line: usize = 0, of "contact", from 0 to 13,
                "Line of the patch whose profiles across the contact and over the depth are shown, counted from 1 as those of line.*; 0: the \
                 line with the largest pressure. It counts at once and changes nothing but what is shown";
            1160 expert martensite_start: f64 = 575.0, of "damage", in "K" as "degC", from 1.0 to 1e4,
                "Temperature Ms below which quickly cooled austenite becomes martensite";
            1161 expert critical_cooling: f64 = 50.0, of "damage", in "K/s", from 0.0 to 1e6,
                "Cooling rate between 800 and 500 degC from which austenite becomes martensite";
            1162 expert threshold: f64 = 300.0, of "damage", in "K", from 1.0 to 1e4,
                "Excess temperature of the tread over the wheel's mean above which a place that the contact heats in \
                 one piece is followed";
        }
        /// Files that a run leaves behind. No result depends on them, and a state remembers only that the parameter was
        /// set.
        files: Files tunable {
            1192 expert profile_save: String = String::new(), of "wheel",
                "File to which the present profile of the wheel is written when the run is terminated, for wheel.profile of \
                 another run: its path, absolute or from the working directory, ending in .csv; tried before the run begins, \
                 and a file that is there stays until then; empty: none";
        }
    }
}
