//! The table of parameters: names, units, ranges and defaults. Names are those of the files of the Python package
//! (vehicle; brake under `brake`), defaults those of its examples: Manchester benchmark vehicle 1 with a disc brake,
//! whose sources stand in `examples/train/`.

/// A row of the table.
#[derive(Clone, Copy, Debug)]
pub struct Parameter {
    /// Name.
    pub name: &'static str,
    /// SI unit.
    pub unit: &'static str,
    /// Smallest and largest value.
    pub range: [f64; 2],
    /// Value unless it is set.
    pub start: f64,
    /// Meaning, plain text.
    pub text: &'static str,
}

/// Defines a struct of real parameters and its table.
macro_rules! parameters {
    ($( $field:ident: $name:literal, $unit:literal, $low:literal to $high:literal, $start:literal, $text:literal; )*) => {
        /// Parameters of the coach and its brake.
        #[derive(Clone, Debug, PartialEq)]
        pub struct Parameters { $( #[doc = concat!($text, " \\[", $unit, "].")] pub $field: f64, )* }

        impl Default for Parameters {
            fn default() -> Self {
                Self { $( $field: $start, )* }
            }
        }

        impl Parameters {
            /// Rows of the table, in the order of their value references.
            pub const ROWS: &[Parameter] = &[$( Parameter {
                name: $name, unit: $unit, range: [$low, $high], start: $start, text: $text,
            }, )*];

            /// The value of a row.
            pub fn value(&mut self, row: usize) -> Option<&mut f64> {
                let values: [&mut f64; Self::ROWS.len()] = [$( &mut self.$field ),*];
                values.into_iter().nth(row)
            }
        }
    };
}

parameters! {
    speed: "initial.speed", "m/s", 0.5 to 60.0, 38.8889, "Speed at the start";
    body_mass: "body.mass", "kg", 100.0 to 1e6, 32000.0, "Car body, empty";
    payload: "body.payload", "kg", 0.0 to 1e6, 0.0, "Load, spread like the body";
    body_inertia: "body.pitch_inertia", "kg.m2", 10.0 to 1e9, 1.97e6, "Empty body about its centre of gravity";
    body_height: "body.height", "m", 0.1 to 10.0, 1.8, "Centre of gravity of the body above the rail";
    bogie_mass: "bogie.mass", "kg", 10.0 to 1e5, 2615.0, "Frame of one bogie";
    bogie_inertia: "bogie.pitch_inertia", "kg.m2", 1.0 to 1e6, 1476.0, "Bogie about its centre of gravity";
    bogie_height: "bogie.height", "m", 0.1 to 5.0, 0.6, "Centre of gravity of a bogie above the rail";
    wheelset_mass: "wheelset.mass", "kg", 50.0 to 2e4, 1813.0, "One wheelset, as the wheel FMU has it";
    wheelset_inertia: "wheelset.inertia", "kg.m2", 1.0 to 1e4, 112.0, "One wheelset about its axle, as the wheel FMU has it";
    radius: "wheelset.radius", "m", 0.1 to 2.0, 0.46, "Radius of the wheels";
    front: "bogie_half_distance", "m", 0.5 to 50.0, 9.5, "Between bogie centre and middle of the body";
    wheel: "axle_half_distance", "m", 0.1 to 5.0, 1.28, "Between axle and bogie centre";
    pull_stiffness: "primary.longitudinal_stiffness", "N/m", 1e4 to 1e10, 62.782e6, "One wheelset, both boxes";
    pull_damping: "primary.longitudinal_damping", "N.s/m", 0.0 to 1e8, 30e3, "One wheelset, both boxes";
    lift_stiffness: "primary.vertical_stiffness", "N/m", 1e4 to 1e10, 2.4e6, "One wheelset, both boxes";
    lift_damping: "primary.vertical_damping", "N.s/m", 0.0 to 1e8, 8e3, "One wheelset, both boxes";
    shear_stiffness: "secondary.longitudinal_stiffness", "N/m", 0.0 to 1e9, 320e3, "One bogie, both sides";
    shear_damping: "secondary.longitudinal_damping", "N.s/m", 0.0 to 1e8, 80e3, "One bogie, both sides";
    bounce_stiffness: "secondary.vertical_stiffness", "N/m", 1e3 to 1e9, 860e3, "One bogie, both sides";
    bounce_damping: "secondary.vertical_damping", "N.s/m", 0.0 to 1e8, 40e3, "One bogie, both sides";
    shear_height: "secondary.height", "m", 0.0 to 5.0, 0.83, "Shear of the secondary suspension above the rail";
    rod_stiffness: "traction_rod.stiffness", "N/m", 1e3 to 1e10, 5e6, "Between one bogie and the body";
    rod_damping: "traction_rod.damping", "N.s/m", 0.0 to 1e8, 25e3, "Bushes of the traction rod";
    rod_height: "traction_rod.height", "m", 0.0 to 5.0, 0.6, "Traction rod above the rail";
    constant: "resistance.constant", "1", 0.0 to 0.1, 0.0, "Running resistance over weight";
    quadratic: "resistance.quadratic", "s2/m2", 0.0 to 0.01, 0.0, "Running resistance over weight and speed squared";
    torque: "brake.torque", "N.m", 0.0 to 1e6, 6450.0, "One axle at full pressure";
    pressure: "brake.pressure", "Pa", 1e4 to 2e6, 3.8e5, "Full cylinder pressure over ambient";
    delay: "brake.delay", "s", 0.0 to 60.0, 0.4, "Between demand and first pressure";
    fill_time: "brake.fill_time", "s", 0.01 to 120.0, 4.0, "In which 95 % of the full pressure builds up";
    release_time: "brake.release_time", "s", 0.01 to 240.0, 16.0, "In which the pressure falls to 5 %";
    cylinder_volume: "brake.cylinder_volume", "m3", 0.0 to 1.0, 0.01, "Cylinders and pipes of one axle";
    wsp_active: "brake.wsp.active", "1", 0.0 to 1.0, 1.0, "Whether wheels are protected: 1, or 0";
    period: "brake.wsp.period", "s", 1e-3 to 1.0, 0.02, "Between decisions of the slide protection";
    slide_low: "brake.wsp.slide_low", "1", 0.0 to 1.0, 0.05, "Slide from which an axle is held";
    slide_high: "brake.wsp.slide_high", "1", 0.0 to 1.0, 0.15, "Slide from which an axle is vented";
    least_slide: "brake.wsp.least_slide", "m/s", 0.0 to 5.0, 0.3, "No slide below this counts";
    deceleration: "brake.wsp.deceleration", "m/s2", 0.0 to 100.0, 3.0, "Of a sliding axle, from which it is vented";
    recovery: "brake.wsp.recovery", "m/s2", 0.0 to 100.0, 1.0, "Acceleration of an axle that comes back";
    reference_deceleration: "brake.wsp.reference_deceleration", "m/s2", 0.01 to 10.0, 1.5, "Largest fall of the reference speed";
    sounding: "brake.wsp.sounding", "s", 0.1 to 1e6, 2.0, "After which an axle is released to find the train's speed";
    longest_sounding: "brake.wsp.longest_sounding", "s", 0.1 to 60.0, 2.0, "That an axle is released to find the speed";
    off_speed: "brake.wsp.off_speed", "m/s", 0.0 to 20.0, 1.0, "Below which nothing is controlled";
    vent_time: "brake.wsp.vent_time", "s", 0.01 to 10.0, 0.25, "Time constant of venting";
    valve_fill_time: "brake.wsp.fill_time", "s", 0.01 to 10.0, 0.3, "Time constant of filling through the valve";
}
