//! `documentation/index.html` of the FMU: conventions with a figure, use, and the table of variables; the theory is beside it.

use super::units::Measure;
use super::variable::{Causality, Kind, Value, Variable};
use super::variables::{ENUMERATIONS, variables};
use super::{description, presets};
use std::fmt::Write;

/// Text before the tables.
const INTRODUCTION: &str = include_str!("../../docs/fmu.html");

/// Figure of the sign conventions; README links it, too.
const SIGNS: &str = include_str!("../../docs/signs.svg");

/// The page as it stands in the FMU. Only the first point of every profile is listed.
pub fn index_html() -> String {
    let mut html = INTRODUCTION
        .replace("{version}", env!("CARGO_PKG_VERSION"))
        .replace("{guid}", description::guid())
        .replace("{signs}", SIGNS)
        .replace("{preset}", presets::DEFAULT)
        .replace("{mit}", &escaped(include_str!("../../LICENSE-MIT")))
        .replace("{apache}", &escaped(include_str!("../../LICENSE-APACHE")));
    for (title, causality) in
        [("Inputs", Causality::Input), ("Outputs", Causality::Output), ("Parameters", Causality::Parameter)]
    {
        let _ = write!(html, "<h3>{title}</h3>\n<table>\n<tr><th>name</th><th>reference</th><th>unit</th>");
        let _ = writeln!(html, "<th>range</th><th>default</th><th>meaning</th></tr>");
        let listed = |v: &&Variable| v.causality() == causality && (!v.name.contains('[') || v.name.ends_with("[1]"));
        variables().iter().filter(listed).for_each(|variable| row(&mut html, variable));
        html.push_str("</table>\n");
    }
    html.push_str(
        "<h3>Enumerations</h3>\n<table>\n<tr><th>type</th><th>value</th><th>item</th><th>meaning</th></tr>\n",
    );
    for list in ENUMERATIONS {
        for (value, (item, text)) in (1..).zip(list.items) {
            let value: i32 = value;
            let _ = writeln!(html, "<tr><td>{}</td><td>{value}</td><td>{item}</td><td>{text}</td></tr>", list.name);
        }
    }
    html.push_str("</table>\n</body>\n</html>\n");
    html
}

fn row(html: &mut String, variable: &Variable) {
    let (unit, range) = match variable.kind {
        Kind::Real { measure: Measure { unit, display }, min, max, .. } => {
            let unit = display.map_or(unit.to_owned(), |display| format!("{unit} (shown in {display})"));
            let range = match (min.is_finite(), max.is_finite()) {
                (true, true) => format!("{min:?} … {max:?}"),
                (true, false) => format!("≥ {min:?}"),
                _ => String::new(),
            };
            (unit, range)
        }
        Kind::Integer { min, max: i32::MAX } => (String::new(), format!("≥ {min}")),
        Kind::Integer { min, max } => (String::new(), format!("{min} … {max}")),
        Kind::Enumeration(list) => (String::new(), list.name.to_owned()),
        Kind::Boolean => (String::new(), "false, true".to_owned()),
        Kind::String => (String::new(), String::new()),
    };
    let start = match (description::start_value(variable), variable.kind) {
        (Some(Value::Integer(item)), Kind::Enumeration(list)) => {
            list.items.get(item as usize - 1).map_or(String::new(), |(name, _)| (*name).to_owned())
        }
        (Some(Value::Real(value)), _) => format!("{value:?}"),
        (Some(Value::Integer(value)), _) => value.to_string(),
        (Some(Value::Boolean(value)), _) => value.to_string(),
        (Some(Value::String(value)), _) => value,
        (None, _) => String::new(),
    };
    let (name, text) = match variable.name.strip_suffix("[1]") {
        Some(stem) => (
            format!("{stem}[1 … {}]", crate::simulation::PROFILE_POINTS),
            variable.description.replace(", point 1", ", evenly spaced points"),
        ),
        None => (variable.name.clone(), variable.description.clone()),
    };
    let text = escaped(&text);
    let reference = variable.reference;
    let _ = writeln!(
        html,
        "<tr><td><code>{name}</code></td><td>{reference}</td><td>{unit}</td><td>{range}</td><td>{start}</td><td>{text}</td></tr>"
    );
}

/// Plain text for HTML.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}
