//! Presets: what differs from the defaults, as JSON text of the form `{"group": {"parameter": value}}`.

use super::Config;
use super::row::Row;
use super::value::{Kind, Value};
use serde_json::Value as Json;

/// The defaults with the changes that the text makes. Refuses names that do not exist, with the nearest ones, values of
/// another type or out of range and combinations without meaning; the error names parameter, value and range.
pub fn parse(text: &str) -> Result<Config, String> {
    let json: Json = serde_json::from_str(text).map_err(|error| format!("is malformed ({error})"))?;
    let mut config = Config::default();
    apply(&mut config, Config::rows(), &json)?;
    config.validate().map_err(|error| format!("is invalid ({error})"))?;
    Ok(config)
}

/// Writes the values of the JSON object over those of `config`.
fn apply<T>(config: &mut T, rows: &'static [Row<T>], json: &Json) -> Result<(), String> {
    let object = |json: &Json, what: &str| {
        let shape = || format!("is malformed ({what} is not an object in braces)");
        json.as_object().cloned().ok_or_else(shape)
    };
    for (group, content) in object(json, "the whole")? {
        for (field, given) in object(&content, &group)? {
            let name = format!("{group}.{field}");
            let Some(row) = rows.iter().find(|row| row.name == name) else {
                return Err(format!("is invalid ({})", no_such_parameter(&name, rows.iter().map(|row| row.name))));
            };
            let value = value(row.kind, &given).ok_or_else(|| {
                let range = possible(row.kind);
                format!("is invalid ({name} = {given} is outside its range: {range})")
            })?;
            row.kind.check(&name, &value).map_err(|error| format!("is invalid ({error})"))?;
            (row.write)(config, &value);
        }
    }
    Ok(())
}

/// The refusal of a name that no parameter has: a retired one, or one with its nearest neighbours.
fn no_such_parameter(name: &str, names: impl Iterator<Item = &'static str>) -> String {
    let near = || format!("parameter {name} is unknown; nearest: {}", crate::display::nearest(name, names));
    super::retired::named(name).map_or_else(near, ToString::to_string)
}

/// A JSON value as value of a row; `None` if it is of another type.
fn value(kind: Kind, json: &Json) -> Option<Value> {
    match kind {
        Kind::Real { .. } => json.as_f64().map(Value::Real),
        Kind::Integer { .. } => json.as_i64().and_then(|number| i32::try_from(number).ok()).map(Value::Integer),
        Kind::Boolean => json.as_bool().map(Value::Boolean),
        Kind::String => json.as_str().map(|text| Value::String(text.to_owned())),
        Kind::Enumeration(list) => json.as_str().and_then(|name| list.number(name)).map(Value::Integer),
    }
}

/// The values that a preset can give, in words.
fn possible(kind: Kind) -> String {
    match kind {
        Kind::Enumeration(list) => list.items.iter().map(|item| item.0).collect::<Vec<_>>().join(" or "),
        other => other.range(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::Hub;

    #[test]
    fn a_preset_changes_what_it_names_and_nothing_else() {
        let text = r#"{"wheel": {"radius": 0.5}, "thermal": {"hub": "insulated", "tread_blocks": 1, "enabled": false},
            "friction": {"softening": 0}}"#;
        let mut expected = Config::default();
        expected.wheel.radius = 0.5;
        (expected.thermal.hub, expected.thermal.tread_blocks, expected.thermal.enabled) = (Hub::Insulated, 1, false);
        expected.tuning.softening = 0.0;
        assert_eq!(parse(text), Ok(expected));
        assert_eq!(parse("{}"), Ok(Config::default()));
    }

    #[test]
    fn refusals_name_parameter_value_and_range() {
        for (text, words) in [
            ("{", &["malformed"][..]),
            ("[]", &["malformed", "the whole"]),
            (r#"{"wheel": 3}"#, &["malformed", "wheel"]),
            (r#"{"wheel": {"radios": 1}}"#, &["wheel.radios", "unknown", "wheel.radius"]),
            (r#"{"whel": {"radius": 1}}"#, &["whel.radius", "wheel.radius"]),
            (r#"{"solver": {"theta": 0.5}}"#, &["solver.theta was retired in 0.2.0 (last in 0.1.1)", "remove it"]),
            (r#"{"tuning": {"softening": 0}}"#, &["tuning.softening", "friction.softening"]),
            (r#"{"wheel": {"radius": 50}}"#, &["wheel.radius = 50", "0.01 to 10 m"]),
            (r#"{"wheel": {"radius": "big"}}"#, &["wheel.radius = \"big\"", "0.01 to 10 m"]),
            (r#"{"thermal": {"hub": "warm"}}"#, &["thermal.hub = \"warm\"", "fixed or insulated"]),
            (r#"{"thermal": {"tread_blocks": 1.5}}"#, &["thermal.tread_blocks = 1.5", "1 to 2"]),
            (r#"{"contact": {"lines": 99999999999}}"#, &["contact.lines = 99999999999", "1 to 13"]),
            (r#"{"wheel": {"radius": 2.0, "hub_radius": 0.01}}"#, &["wheel.hub_radius = 0.01", "wheel.radius = 2 m"]),
        ] {
            let message = parse(text).unwrap_err();
            assert!(words.iter().all(|word| message.contains(word)), "{message}");
        }
    }
}
