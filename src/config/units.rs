//! Units: their SI exponents and what people like to read instead.

/// A unit and the unit in which a master should show the value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Measure {
    /// Name of the unit in which values cross the interface; always coherent SI.
    pub unit: &'static str,
    /// Name of one of the unit's [`Unit::displays`].
    pub display: Option<&'static str>,
}

impl Measure {
    /// True for differences: temperatures that are not shown in degrees Celsius.
    pub fn is_relative(self) -> bool {
        self.unit == "K" && self.display.is_none()
    }
}

/// A unit for people: `display = factor · value + offset`.
#[derive(Clone, Copy, Debug)]
pub struct Display {
    /// Its name.
    pub name: &'static str,
    /// How many of it make one SI unit.
    pub factor: f64,
    /// Value in it of the zero of the SI unit.
    pub offset: f64,
}

/// A multiple of the SI unit.
const fn times(name: &'static str, factor: f64) -> Display {
    Display { name, factor, offset: 0.0 }
}

/// A coherent SI unit as a product of powers of base units.
#[derive(Clone, Copy, Debug)]
pub struct Unit {
    /// Its name.
    pub name: &'static str,
    /// The physical quantity that is measured in it.
    pub quantity: &'static str,
    /// Exponents of [`BASE_UNITS`].
    pub exponents: [i32; 5],
    /// Units that people like to read instead.
    pub displays: &'static [Display],
}

/// Names of the base units to which [`Unit::exponents`] belong, as the FMI schema spells them.
pub const BASE_UNITS: [&str; 5] = ["kg", "m", "s", "rad", "K"];

/// Every unit of the tables.
pub const UNITS: &[Unit] = &[
    Unit { name: "1", quantity: "Dimensionless", exponents: [0, 0, 0, 0, 0], displays: &[times("%", 100.0)] },
    Unit { name: "m", quantity: "Length", exponents: [0, 1, 0, 0, 0], displays: &[times("mm", 1e3)] },
    Unit { name: "s", quantity: "Time", exponents: [0, 0, 1, 0, 0], displays: &[times("ms", 1e3)] },
    Unit { name: "kg", quantity: "Mass", exponents: [1, 0, 0, 0, 0], displays: &[times("t", 1e-3), times("g", 1e3)] },
    Unit {
        name: "rad",
        quantity: "Angle",
        exponents: [0, 0, 0, 1, 0],
        displays: &[times("deg", 180.0 / std::f64::consts::PI), times("mrad", 1e3)],
    },
    Unit {
        name: "m/s",
        quantity: "Velocity",
        exponents: [0, 1, -1, 0, 0],
        displays: &[times("km/h", 3.6), times("mm/s", 1e3)],
    },
    Unit { name: "m/s2", quantity: "Acceleration", exponents: [0, 1, -2, 0, 0], displays: &[] },
    Unit {
        name: "rad/s",
        quantity: "AngularVelocity",
        exponents: [0, 0, -1, 1, 0],
        displays: &[times("rpm", 30.0 / std::f64::consts::PI), times("mrad/s", 1e3)],
    },
    Unit { name: "rad/s2", quantity: "AngularAcceleration", exponents: [0, 0, -2, 1, 0], displays: &[] },
    Unit { name: "N", quantity: "Force", exponents: [1, 1, -2, 0, 0], displays: &[times("kN", 1e-3)] },
    Unit { name: "N.s", quantity: "Impulse", exponents: [1, 1, -1, 0, 0], displays: &[] },
    Unit { name: "N/m", quantity: "Stiffness", exponents: [1, 0, -2, 0, 0], displays: &[times("MN/m", 1e-6)] },
    Unit { name: "N.s/m", quantity: "Damping", exponents: [1, 0, -1, 0, 0], displays: &[times("kN.s/m", 1e-3)] },
    Unit { name: "N.m", quantity: "Moment", exponents: [1, 2, -2, 0, 0], displays: &[times("kN.m", 1e-3)] },
    Unit {
        name: "Pa",
        quantity: "Pressure",
        exponents: [1, -1, -2, 0, 0],
        displays: &[times("MPa", 1e-6), times("GPa", 1e-9)],
    },
    Unit { name: "J", quantity: "Energy", exponents: [1, 2, -2, 0, 0], displays: &[times("kJ", 1e-3)] },
    Unit { name: "W", quantity: "Power", exponents: [1, 2, -3, 0, 0], displays: &[times("kW", 1e-3)] },
    Unit { name: "kg/m", quantity: "MassPerLength", exponents: [1, -1, 0, 0, 0], displays: &[times("mg/m", 1e6)] },
    Unit { name: "kg/m3", quantity: "Density", exponents: [1, -3, 0, 0, 0], displays: &[] },
    Unit { name: "kg/J", quantity: "MassPerEnergy", exponents: [0, -2, 2, 0, 0], displays: &[times("g/MJ", 1e9)] },
    Unit { name: "kg.m2", quantity: "MomentOfInertia", exponents: [1, 2, 0, 0, 0], displays: &[] },
    Unit {
        name: "K",
        quantity: "Temperature",
        exponents: [0, 0, 0, 0, 1],
        displays: &[Display { name: "degC", factor: 1.0, offset: -273.15 }],
    },
    Unit { name: "1/K", quantity: "ChangePerTemperature", exponents: [0, 0, 0, 0, -1], displays: &[] },
    Unit { name: "K/s", quantity: "CoolingRate", exponents: [0, 0, -1, 0, 1], displays: &[] },
    Unit { name: "J/m", quantity: "EnergyPerLength", exponents: [1, 1, -2, 0, 0], displays: &[times("kJ/m", 1e-3)] },
    Unit { name: "W/(m.K)", quantity: "ThermalConductivity", exponents: [1, 1, -3, 0, -1], displays: &[] },
    Unit { name: "W/(m2.K)", quantity: "HeatTransferCoefficient", exponents: [1, 0, -3, 0, -1], displays: &[] },
    Unit { name: "J/(kg.K)", quantity: "SpecificHeat", exponents: [0, 2, -2, 0, -1], displays: &[] },
    Unit { name: "J/kg", quantity: "SpecificEnergy", exponents: [0, 2, -2, 0, 0], displays: &[times("kJ/kg", 1e-3)] },
    Unit { name: "1/m", quantity: "Curvature", exponents: [0, -1, 0, 0, 0], displays: &[] },
    Unit { name: "1/(m.s)", quantity: "CurvatureRate", exponents: [0, -1, -1, 0, 0], displays: &[] },
    Unit { name: "N/s", quantity: "ForceRate", exponents: [1, 1, -3, 0, 0], displays: &[] },
    Unit { name: "N.m/s", quantity: "MomentRate", exponents: [1, 2, -3, 0, 0], displays: &[] },
    Unit { name: "W/s", quantity: "PowerRate", exponents: [1, 2, -4, 0, 0], displays: &[] },
    Unit { name: "1/s", quantity: "Rate", exponents: [0, 0, -1, 0, 0], displays: &[] },
    Unit {
        name: "m/Pa",
        quantity: "LayerFlexibility",
        exponents: [-1, 2, 2, 0, 0],
        displays: &[times("um/MPa", 1e12)],
    },
    Unit { name: "s/m", quantity: "ChangePerVelocity", exponents: [0, -1, 1, 0, 0], displays: &[] },
];
