//! The reference of all variables as text: cells of a row, and `docs/reference.md`.

use super::settings::start_value;
use super::table::{enumerations, table};
use super::units::Measure;
use super::variable::{Causality, Kind, Reference, Value, Variable};
use crate::config::display_number;
use std::fmt::Write;

/// Cells about a variable in a table for people.
pub struct Cells {
    /// Name; of an array with its points.
    pub name: String,
    /// Value reference; of an array that of the first point.
    pub reference: Reference,
    /// SI unit, and that in which masters show the value.
    pub unit: String,
    /// Admitted values.
    pub range: String,
    /// Default of inputs and parameters, numbers with six digits.
    pub start: String,
    /// "yes" if a parameter may change during a run.
    pub tunable: &'static str,
    /// Meaning.
    pub text: String,
}

/// The cells of a row of the table.
pub fn cells(variable: &Variable) -> Cells {
    let (unit, range) = match variable.kind {
        Kind::Real { measure: Measure { unit, display }, min, max, .. } => {
            let unit = display.map_or(unit.to_owned(), |display| format!("{unit} (shown in {display})"));
            let range = match (min.is_finite(), max.is_finite()) {
                (true, true) => format!("{} … {}", display_number(min), display_number(max)),
                (true, false) => format!("≥ {}", display_number(min)),
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
    let (name, reference, text) = match variable.dimension {
        Some(points) => (
            format!("{}[1 … {points}]", variable.name),
            variable.reference + 1,
            format!("{}, evenly spaced points", variable.description),
        ),
        None => (variable.name.to_owned(), variable.reference, variable.description.to_owned()),
    };
    let start = match start_value(variable) {
        Some(Value::Real(value)) => display_number(value),
        Some(value) => variable.kind.print(&value),
        None => String::new(),
    };
    let tunable = if variable.tunable { "yes" } else { "no" };
    Cells { name, reference, unit, range, start, tunable, text }
}

/// Text before the tables.
const INTRODUCTION: &str = "# Reference of all variables

Generated from the table of variables by `make describe`; do not edit. Defaults are those of the preset `railway`.
Values cross the interface in SI units. x points in travel direction, y up, `omega > 0` rolls forward; contact forces
act on the wheel. Tunable parameters may change during a run, the others only before its start.
";

/// Title, causality and columns of the tables.
const TABLES: [(&str, Causality, &[&str]); 3] = [
    ("Inputs", Causality::Input, &["name", "reference", "unit", "default", "range", "meaning"]),
    ("Outputs", Causality::Output, &["name", "reference", "unit", "range", "meaning"]),
    ("Parameters", Causality::Parameter, &["name", "reference", "unit", "default", "range", "tunable", "meaning"]),
];

/// The reference as Markdown.
pub fn markdown() -> String {
    let mut text = INTRODUCTION.to_owned();
    for (title, causality, columns) in TABLES {
        heading(&mut text, title, columns);
        for variable in table().iter().filter(|v| v.causality() == causality) {
            let cells = cells(variable);
            let cell = |column: &&str| match *column {
                "name" => format!("`{}`", cells.name),
                "reference" => cells.reference.to_string(),
                "unit" => cells.unit.clone(),
                "default" => cells.start.clone(),
                "range" => cells.range.clone(),
                "tunable" => cells.tunable.to_owned(),
                _ => cells.text.replace('|', "\\|"),
            };
            line(&mut text, columns.iter().map(cell));
        }
    }
    heading(&mut text, "Enumerations", &["type", "value", "item", "meaning"]);
    for list in enumerations() {
        for (value, (item, meaning)) in (1..).zip(list.items) {
            let value: i32 = value;
            let cells = [list.name.to_owned(), value.to_string(), format!("`{item}`"), (*meaning).to_owned()];
            line(&mut text, cells);
        }
    }
    text
}

/// Title and head of a table.
fn heading(text: &mut String, title: &str, columns: &[&str]) {
    let _ = writeln!(text, "\n## {title}\n");
    line(text, columns.iter().map(|column| (*column).to_owned()));
    line(text, columns.iter().map(|_| "---".to_owned()));
}

/// One row of a table.
fn line(text: &mut String, cells: impl IntoIterator<Item = String>) {
    let cells: Vec<_> = cells.into_iter().collect();
    let _ = writeln!(text, "| {} |", cells.join(" | "));
}
