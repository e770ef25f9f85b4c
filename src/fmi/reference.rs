//! The reference of all variables as text: cells of a row, and `docs/reference.md`.

use super::settings::start_value;
use super::table::{enumerations, table};
use super::units::Measure;
use super::variable::{Causality, Group, Kind, Reference, Value, Variable};
use crate::config::retired::{RETIRED, Retired};
use crate::display::display_number;
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
            format!("{}, at {points} points", variable.description),
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

/// Sentence below the heading of retired parameters.
pub const RETIREMENT: &str =
    "Earlier versions had them; they are refused by name, and their references are never used again.";

/// Text before the tables.
const INTRODUCTION: &str = "# Reference of all variables

Generated from the table of variables by `make describe`; do not edit. Defaults are those of the preset `railway`.
Values cross the interface in SI units. x points in travel direction, y up, `omega > 0` rolls forward; contact forces
act on the wheel. Tunable parameters may change during a run, the others only before its start.
";

/// A table of some of the variables.
pub struct ReferenceTable {
    /// Its heading.
    pub title: &'static str,
    /// Sentence below the heading; may be empty.
    pub about: &'static str,
    /// Groups of its rows.
    shows: &'static [Group],
}

impl ReferenceTable {
    /// The rows of the section, in the order of the table.
    pub fn rows(&self) -> impl Iterator<Item = &'static Variable> {
        table().iter().filter(|variable| self.shows.contains(&variable.group()))
    }

    /// Columns of the section in `docs/reference.md`.
    fn columns(&self) -> &'static [&'static str] {
        match self.rows().next().map(Variable::causality) {
            Some(Causality::Parameter) => &["name", "reference", "unit", "default", "range", "tunable", "meaning"],
            Some(Causality::Input) => &["name", "reference", "unit", "default", "range", "meaning"],
            Some(Causality::Output) | None => &["name", "reference", "unit", "range", "meaning"],
        }
    }
}

/// The tables of all variables, in the order in which people read them: what every run sets comes first.
pub const SECTIONS: [ReferenceTable; 4] = [
    ReferenceTable {
        title: "Basic parameters",
        about: "They describe wheel, vehicle, track, material and run.",
        shows: &[Group::Basic],
    },
    ReferenceTable { title: "Inputs", about: "", shows: &[Group::Input, Group::Rate] },
    ReferenceTable { title: "Outputs", about: "", shows: &[Group::Output] },
    ReferenceTable {
        title: "Expert parameters",
        about: "Their defaults are meant to be kept, unless one knows the theory behind them.",
        shows: &[Group::Expert],
    },
];

/// The reference as Markdown.
pub fn markdown() -> String {
    let mut text = INTRODUCTION.to_owned();
    for section in &SECTIONS {
        let columns = section.columns();
        heading(&mut text, section.title, section.about, columns);
        for variable in section.rows() {
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
    heading(&mut text, "Enumerations", "", &["type", "value", "item", "meaning"]);
    for list in enumerations() {
        for (value, (item, meaning)) in (1..).zip(list.items) {
            let value: i32 = value;
            let cells = [list.name.to_owned(), value.to_string(), format!("`{item}`"), (*meaning).to_owned()];
            line(&mut text, cells);
        }
    }
    heading(&mut text, "Retired parameters", RETIREMENT, &["name", "reference", "last in", "instead"]);
    for Retired { name, number, last, instead, .. } in RETIRED {
        line(&mut text, [format!("`{name}`"), number.to_string(), (*last).to_owned(), (*instead).to_owned()]);
    }
    text
}

/// Title of a table, a sentence about it, and its head.
fn heading(text: &mut String, title: &str, about: &str, columns: &[&str]) {
    let _ = writeln!(text, "\n## {title}\n");
    if !about.is_empty() {
        let _ = writeln!(text, "{about}\n");
    }
    line(text, columns.iter().map(|column| (*column).to_owned()));
    line(text, columns.iter().map(|_| "---".to_owned()));
}

/// One row of a table.
fn line(text: &mut String, cells: impl IntoIterator<Item = String>) {
    let cells: Vec<_> = cells.into_iter().collect();
    let _ = writeln!(text, "| {} |", cells.join(" | "));
}
