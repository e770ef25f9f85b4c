//! Variables by name and their values as text.

use super::Failure;
use wheelrail::config::{nearest, retired};
use wheelrail::files::table::comma;
use wheelrail::fmi::units::Measure;
use wheelrail::fmi::v2::variables::variables;
use wheelrail::fmi::variable::{Enumeration, Kind, Value, Variable};

/// A variable and the value it is to have.
#[derive(Clone)]
pub struct Setting {
    /// Its row in the table of variables.
    pub variable: &'static Variable,
    /// The value, of its type.
    pub value: Value,
}

impl Setting {
    /// Reads `name=value`.
    pub fn parse(text: &str) -> Result<Setting, Failure> {
        let (name, value) = text
            .split_once('=')
            .ok_or_else(|| Failure::Usage(format!("--set {text}: expected NAME=VALUE, such as drive.load=8e4")))?;
        Setting::new(name.trim(), value.trim())
    }

    /// Variable and value, each as text.
    pub fn new(name: &str, value: &str) -> Result<Setting, Failure> {
        let variable = find(name, |_| true)?;
        Ok(Setting { variable, value: parse(variable, value).map_err(Failure::Usage)? })
    }
}

/// The variable with this name among those allowed; otherwise an error with the nearest names.
pub fn find(name: &str, allowed: impl Fn(&Variable) -> bool) -> Result<&'static Variable, Failure> {
    let candidates = || variables().iter().filter(|v| allowed(v));
    if let Some(variable) = candidates().find(|v| v.name == name) {
        return Ok(variable);
    }
    if let Some(variable) = variables().iter().find(|v| v.name == name) {
        let what = format!("{:?}", variable.causality()).to_lowercase();
        return Err(Failure::Usage(format!("{name} is of causality {what} and has no place here")));
    }
    if let Some(retired) = retired::named(name) {
        return Err(Failure::Usage(retired.to_string()));
    }
    // Points of profiles would crowd out everything else.
    let listed = candidates().filter(|v| !v.name.contains('[') || name.contains('['));
    let names = nearest(name, listed.map(|v| v.name));
    Err(Failure::Usage(format!("variable \"{name}\" is unknown; nearest: {names}")))
}

/// A value for a variable; errors name variable, text and what is possible.
pub fn parse(variable: &Variable, text: &str) -> Result<Value, String> {
    let refused = |expected: String| format!("{} = \"{text}\" is not {expected}", variable.name);
    let value = match variable.kind {
        Kind::Real { measure: Measure { unit, .. }, .. } => {
            let advice = || comma(text).map_or_else(String::new, |advice| format!("; {advice}"));
            text.parse().map(Value::Real).map_err(|_| refused(format!("a number [{unit}]{}", advice())))?
        }
        Kind::Integer { min, max } => {
            text.parse().map(Value::Integer).map_err(|_| refused(format!("a whole number from {min} to {max}")))?
        }
        Kind::Boolean => text.parse().map(Value::Boolean).map_err(|_| refused("true or false".to_owned()))?,
        Kind::String => Value::String(text.to_owned()),
        Kind::Enumeration(list) => item(list, text).map(Value::Integer).ok_or_else(|| {
            let items: Vec<_> =
                list.items.iter().map(|item| item.0).zip(1..).map(|(item, i)| format!("{item} ({i})")).collect();
            refused(items.join(" or "))
        })?,
    };
    variable.check(&value).map(|()| value)
}

/// Number of an enumeration item given by name or number.
fn item(list: &Enumeration, text: &str) -> Option<i32> {
    list.number(text).or_else(|| text.parse().ok().filter(|number| list.item(*number).is_some()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn printed_values_read_back_exactly() {
        for (name, text) in [
            ("drive.load", "81234.56789012345"),
            ("drive.moment", "-1e-300"),
            ("control.rotation", "velocity"),
            ("mesh.elements_per_half_width", "8"),
            ("thermal.enabled", "false"),
            ("preset", "paper_d"),
        ] {
            let Setting { variable, value } = Setting::new(name, text).unwrap();
            assert_eq!(parse(variable, &variable.kind.print(&value)), Ok(value));
        }
        assert_eq!(Setting::new("control.rotation", "1").unwrap().value, Value::Integer(1));
    }

    #[test]
    fn unknown_names_get_their_neighbours() {
        for (wrong, right) in [
            ("drive.laod", "drive.load"),
            ("load", "drive.load"),
            ("wheel.radios", "wheel.radius"),
            ("friction", "rail.friction"),
            ("elements_per_half_width", "mesh.elements_per_half_width"),
        ] {
            let message = find(wrong, |_| true).err().unwrap().to_string();
            assert!(message.contains(wrong) && message.contains(right), "{message}");
        }
    }

    #[test]
    fn retired_names_are_refused_with_the_version_that_had_them() {
        let message = Setting::parse("solver.theta=0.5").err().unwrap().to_string();
        assert!(message.contains("solver.theta was retired in 0.2.0 (last in 0.1.1)"), "{message}");
    }

    #[test]
    fn wrong_values_are_refused_with_what_is_possible() {
        for (name, text, expected) in [
            ("drive.load", "heavy", "a number [N]"),
            ("drive.load", "-1", "0 to"),
            ("drive.load", "nan", "0 to"),
            ("control.rotation", "torque", "velocity (1) or moment (2)"),
            ("control.rotation", "3", "velocity (1) or moment (2)"),
            ("mesh.elements_per_half_width", "2.5", "4 to 80"),
            ("thermal.enabled", "yes", "true or false"),
        ] {
            let message = Setting::new(name, text).err().unwrap().to_string();
            assert!(message.contains(name) && message.contains(expected), "{message}");
        }
    }
}
