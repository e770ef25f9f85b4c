//! Values that look like those of another unit, by their size.

use crate::config::units::{Measure, UNITS};
use crate::config::value::Kind;
use crate::display::display_number;
use std::f64::consts::TAU;

/// Temperature \[K] below which no wheel rolls: a lower one is probably meant in degrees Celsius.
const COLDEST: f64 = 200.0;
/// Ice \[K].
const FREEZING: f64 = 273.15;
/// Factor from which a unit is a multiple of another one, as kN of N: nobody mistakes m/s and km/h by size alone.
const MULTIPLE: f64 = 100.0;
/// Factor between a value of a mistaken unit and the usual size, at least, and between both in the right unit, at most
/// \[1].
const FAR: f64 = 200.0;
const NEAR: f64 = 10.0;
/// Speed \[m/s] that no wheel on a rail has: it is one in km/h.
const FASTEST: f64 = 100.0;
/// Spin [1/m] and angle of contact \[rad] that no wheel has: they look like degrees.
const TURNED: f64 = 4.0;
const STEEP: f64 = 1.3;
/// Friction coefficient \[1] that steel on steel does not have, and the smallest creepage of a wheel that nearly stands
/// still while it travels: both look like percentages.
const STICKIEST: f64 = 2.0;
const SLIDES: [f64; 2] = [0.5, 1.9];

/// Message about an absolute temperature that is too low.
pub fn cold(name: &str, kind: Kind, value: f64) -> Option<String> {
    let absolute = matches!(kind, Kind::Real { measure: Measure { unit: "K", display: Some(_) }, .. });
    (absolute && value < COLDEST).then(|| {
        format!(
            "{name} = {} K is {} degC, colder than any rail: temperatures are in kelvin; if {0} degC are meant, set {}",
            display_number(value),
            display_number(value - FREEZING),
            display_number(value + FREEZING)
        )
    })
}

/// Message about a value whose size is far from the `usual` one, and near it in the unit in which people read it, and
/// about a whole number of radians beyond a turn, which no angle that was read somewhere is.
pub fn unusual(name: &str, kind: Kind, value: f64, usual: f64) -> Option<String> {
    let Kind::Real { measure: Measure { unit, display }, .. } = kind else { return None };
    let percent = match name {
        "initial.creepage" => (SLIDES[0]..SLIDES[1]).contains(&value.abs()),
        "friction.coefficient" | "rail.friction" => value > STICKIEST,
        _ => false,
    };
    if percent {
        return Some(format!(
            "{name} = {} is a ratio and means {} %; if {0} % are meant, set {}",
            display_number(value),
            display_number(100.0 * value),
            display_number(0.01 * value)
        ));
    }
    if let Some(turned) = in_degrees(name, unit, value) {
        return Some(turned);
    }
    let shown = display?;
    if (unit, shown) == ("rad", "deg") && value.abs() > TAU && value.fract() == 0.0 {
        return Some(format!(
            "{name} = {} rad is {:.1} turns; if {0} deg are meant, set {}",
            display_number(value),
            value.abs() / TAU,
            display_number(value.to_radians())
        ));
    }
    let factor = UNITS.iter().find(|row| row.name == unit)?.displays.iter().find(|row| row.name == shown)?.factor;
    let meant = value / factor;
    let off = |number: f64, by: f64| !(usual.abs() / by..=usual.abs() * by).contains(&number.abs());
    let multiple = factor >= MULTIPLE || factor <= 1.0 / MULTIPLE;
    let another =
        if shown == "km/h" { value.abs() >= FASTEST } else { multiple && off(value, FAR) && !off(meant, NEAR) };
    (value != 0.0 && usual != 0.0 && another).then(|| {
        format!(
            "{name} = {} {unit} is of an unusual size; if {0} {shown} are meant, set {}",
            display_number(value),
            display_number(meant)
        )
    })
}

/// Message about spin or an angle of contact beyond those of wheels.
fn in_degrees(name: &str, unit: &str, value: f64) -> Option<String> {
    let (most, degrees) = match name {
        "drive.spin" => (TURNED, "deg/m"),
        "drive.contact_angle" => (STEEP, "deg"),
        _ => return None,
    };
    (value.abs() > most || value.abs() == 1.0 && name == "drive.contact_angle").then(|| {
        format!(
            "{name} = {} {unit} is more than a flange has; if {0} {degrees} are meant, set {}",
            display_number(value),
            display_number(value.to_radians())
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::Config;

    fn kind(name: &str) -> Kind {
        Config::rows().iter().find(|row| row.name == name).unwrap().kind
    }

    #[test]
    fn values_of_another_unit_are_told_by_their_size_with_the_value_that_is_meant() {
        for (name, value, usual, meant) in [
            ("model.nominal_load", 100.0, 100e3, "100000"),
            ("initial.velocity", 120.0, 27.8, "33.3333"),
            ("initial.creepage", 1.0, 0.0, "0.01"),
            ("friction.coefficient", 5.0, 0.3, "0.05"),
            ("material.yield_strength", 550.0, 550e6, "5.5e8"),
            ("material.latent_heat", 270.0, 270e3, "270000"),
            ("vehicle.mass", 9.872, 9872.0, "9872"),
            ("thermal.tread_point", 180.0, 0.0, "3.14159"),
            ("thermal.tread_point", -90.0, 0.0, "-1.5708"),
        ] {
            let text = unusual(name, kind(name), value, usual).unwrap();
            assert!(text.starts_with(&format!("{name} = ")) && text.ends_with(&format!("set {meant}")), "{text}");
        }
        for (name, value, unit, meant) in
            [("drive.spin", 5.0, "1/m", "0.0872665"), ("drive.contact_angle", -1.0, "rad", "-0.0174533")]
        {
            let text = in_degrees(name, unit, value).unwrap();
            assert!(text.ends_with(&format!("set {meant}")), "{text}");
            assert_eq!(in_degrees(name, unit, 0.5), None);
        }
        let text = cold("thermal.reference", kind("thermal.reference"), 20.0).unwrap();
        assert!(text.contains("-253.15 degC") && text.ends_with("set 293.15"), "{text}");
    }

    #[test]
    fn usual_and_merely_small_or_large_values_are_not() {
        for (name, value, usual) in [
            ("model.nominal_load", 2e3, 100e3),
            ("model.nominal_load", 1e6, 100e3),
            ("vehicle.mass", 0.0, 9872.0),
            ("initial.velocity", 80.0, 27.8),
            ("initial.creepage", 2.0, 0.0),
            ("initial.creepage", 0.2, 0.0),
            ("friction.coefficient", 1.0, 0.3),
            ("friction.memory_length", 1.0, 0.0),
            ("thermal.wheel_excess", 20.0, 0.0),
            ("thermal.tread_point", 6.0, 0.0),
            ("thermal.tread_point", -3.2, 0.0),
            ("thermal.tread_point", 1234.5678, 0.0),
        ] {
            assert_eq!(unusual(name, kind(name), value, usual), None);
            assert_eq!(cold(name, kind(name), value), None);
        }
        assert_eq!(cold("thermal.reference", kind("thermal.reference"), 263.0), None);
    }
}
