//! Parts of the model description that both versions of FMI have.

use super::settings::start_value;
use super::table::table;
use super::units::{BASE_UNITS, Measure, UNITS};
use super::variable::{Access, Causality, Enumeration, Kind, Variable};
use crate::config::Config;
use crate::config::retired::{RETIRED, Retired};
use crate::simulation::Read;
use quick_xml::Writer;
use quick_xml::events::{BytesDecl, Event};
use std::io;
use wheelrail_slave::log::CATEGORIES;

/// End of the default experiment \[s].
pub const DEFAULT_STOP_TIME: f64 = 1.0;
/// Communication step of the default experiment \[s].
pub const DEFAULT_STEP_SIZE: f64 = 1e-3;

const DESCRIPTION: &str = "Transient rolling contact of an elastic wheel on an elastic rail: plane finite elements in \
    a moving frame, exact Coulomb friction. x in travel direction, y up, omega > 0 rolls forward; contact forces act \
    on the wheel. Plane bodies; with contact.lateral the contact has lateral creepage and spin.";

/// Date of the last change of the interface. A date of the build would make equal builds unequal.
const GENERATED: &str = "2026-11-29T12:00:00Z";

const COPYRIGHT: &str = "Copyright 2026 The wheelrail authors";

/// Writer of the description.
pub type XmlText = Writer<Vec<u8>>;

/// An element with attributes and nothing inside.
pub fn empty(xml: &mut XmlText, name: &str, attributes: &[(&str, &str)]) -> io::Result<()> {
    xml.create_element(name).with_attributes(attributes.iter().copied()).write_empty().map(drop)
}

/// An element without attributes around its content.
pub fn list(xml: &mut XmlText, name: &str, content: impl FnOnce(&mut XmlText) -> io::Result<()>) -> io::Result<()> {
    xml.create_element(name).write_inner_content(content).map(drop)
}

/// Shortest decimal form that reads back to the same number.
pub fn number(value: f64) -> String {
    format!("{value:?}")
}

/// Attributes of the root element that name the version of FMI and the description.
pub type Identity<'a> = [(&'a str, &'a str); 2];

/// A whole description: the root element with its attributes, `identity` among them, around its content.
pub fn document(identity: Identity, content: impl FnOnce(&mut XmlText) -> io::Result<()>) -> io::Result<String> {
    let [version, identity] = identity;
    let mut xml = Writer::new_with_indent(Vec::new(), b' ', 2);
    xml.write_event(Event::Decl(BytesDecl::new("1.0", Some("UTF-8"), None)))?;
    let root = xml.create_element("fmiModelDescription").with_attributes([
        version,
        ("modelName", "Wheel on rail"),
        identity,
        ("description", DESCRIPTION),
        ("author", env!("CARGO_PKG_AUTHORS")),
        ("version", env!("CARGO_PKG_VERSION")),
        ("copyright", COPYRIGHT),
        ("license", env!("CARGO_PKG_LICENSE")),
        ("generationTool", concat!("wheelrail ", env!("CARGO_PKG_VERSION"))),
        ("generationDateAndTime", GENERATED),
        ("variableNamingConvention", "structured"),
    ]);
    root.write_inner_content(content)?;
    let mut text = String::from_utf8(xml.into_inner()).map_err(io::Error::other)?;
    text.push('\n');
    Ok(text)
}

/// Log categories.
pub fn log_categories(xml: &mut XmlText) -> io::Result<()> {
    list(xml, "LogCategories", |xml| {
        CATEGORIES.iter().try_for_each(|c| empty(xml, "Category", &[("name", c.0), ("description", c.1)]))
    })
}

/// Times and tolerance of the default experiment.
pub fn default_experiment(xml: &mut XmlText) -> io::Result<()> {
    let (stop, step) = (format!("{DEFAULT_STOP_TIME:?}"), format!("{DEFAULT_STEP_SIZE:?}"));
    let tolerance = number(Config::default().tuning.tolerance);
    let attributes = [("startTime", "0.0"), ("stopTime", &*stop), ("tolerance", &*tolerance), ("stepSize", &*step)];
    empty(xml, "DefaultExperiment", &attributes)
}

/// The retired parameters with the texts of their refusals, for programs that know variables by name only.
pub fn retired_parameters(xml: &mut XmlText) -> io::Result<()> {
    let parameter = |xml: &mut XmlText, retired: &Retired| {
        let (reference, refusal) = (retired.number.to_string(), retired.to_string());
        empty(xml, "Retired", &[("name", retired.name), ("valueReference", &reference), ("refusal", &refusal)])
    };
    list(xml, "RetiredParameters", |xml| RETIRED.iter().try_for_each(|retired| parameter(xml, retired)))
}

/// Units, with their exponents and the units in which their values are shown.
pub fn unit_definitions(xml: &mut XmlText) -> io::Result<()> {
    list(xml, "UnitDefinitions", |xml| {
        for unit in UNITS {
            xml.create_element("Unit").with_attribute(("name", unit.name)).write_inner_content(|xml| {
                let exponents: Vec<_> = BASE_UNITS.into_iter().zip(unit.exponents.map(|e| e.to_string())).collect();
                let present: Vec<_> =
                    exponents.iter().filter(|(_, e)| e != "0").map(|(name, e)| (*name, e.as_str())).collect();
                empty(xml, "BaseUnit", &present)?;
                for display in unit.displays {
                    let (factor, offset) = (number(display.factor), number(display.offset));
                    let mut attributes = vec![("name", display.name), ("factor", factor.as_str())];
                    if display.offset != 0.0 {
                        attributes.push(("offset", offset.as_str()));
                    }
                    empty(xml, "DisplayUnit", &attributes)?;
                }
                Ok(())
            })?;
        }
        Ok(())
    })
}

/// Units of the variables with the units in which they are shown, each pair once.
pub fn measures() -> Vec<Measure> {
    let mut found = Vec::new();
    for variable in table() {
        if let Kind::Real { measure, .. } = variable.kind
            && !found.contains(&measure)
        {
            found.push(measure);
        }
    }
    found
}

/// The quantity of a measure.
pub fn quantity(measure: Measure) -> &'static str {
    UNITS.iter().find(|unit| unit.name == measure.unit).map_or("", |unit| unit.quantity)
}

/// Name of the declared type of a measure: its quantity, and the unit in which it is shown.
pub fn type_name(measure: Measure) -> String {
    match (quantity(measure), measure.display) {
        (quantity, _) if measure.is_relative() => format!("{quantity}Difference"),
        (quantity, Some(display)) => format!("{quantity} in {display}"),
        (quantity, None) => quantity.to_owned(),
    }
}

/// FMI variability of a variable.
pub fn variability(variable: &Variable) -> &'static str {
    match variable.access {
        Access::ChoiceInput(..) => "discrete",
        Access::Output(row) if matches!(row.read, Read::Count(_) | Read::Flag(_)) => "discrete",
        Access::RealInput(_) | Access::Ramp(_) | Access::Output(_) => "continuous",
        _ if variable.tunable => "tunable",
        _ => "fixed",
    }
}

/// Attributes of a declared type of a measure.
pub fn measure_attributes(measure: Measure) -> Vec<(&'static str, &'static str)> {
    let mut attributes = vec![("quantity", quantity(measure)), ("unit", measure.unit)];
    attributes.extend(measure.display.map(|display| ("displayUnit", display)));
    attributes.extend(measure.is_relative().then_some(("relativeQuantity", "true")));
    attributes
}

/// Items of an enumeration.
pub fn items(xml: &mut XmlText, list: &Enumeration) -> io::Result<()> {
    (1..).zip(list.items).try_for_each(|(value, (name, text))| {
        let value: i32 = value;
        empty(xml, "Item", &[("name", *name), ("value", &value.to_string()), ("description", *text)])
    })
}

/// Attributes of the type of a variable: unit, range and start.
pub fn type_attributes(variable: &Variable) -> Vec<(&'static str, String)> {
    let mut attributes: Vec<(&str, String)> = Vec::new();
    match variable.kind {
        Kind::Real { measure, min, max, nominal } => {
            attributes.push(("declaredType", type_name(measure)));
            attributes.push(("unit", measure.unit.to_owned()));
            attributes.extend(measure.display.map(|display| ("displayUnit", display.to_owned())));
            attributes.extend(measure.is_relative().then(|| ("relativeQuantity", "true".to_owned())));
            attributes.extend(min.is_finite().then(|| ("min", number(min))));
            attributes.extend(max.is_finite().then(|| ("max", number(max))));
            let says_nothing = nominal == 1.0 && variable.causality() == Causality::Parameter;
            attributes.extend((!says_nothing).then(|| ("nominal", number(nominal))));
        }
        Kind::Integer { min, max } => {
            attributes.push(("min", min.to_string()));
            attributes.extend((max < i32::MAX).then(|| ("max", max.to_string())));
        }
        Kind::Boolean | Kind::String => {}
        Kind::Enumeration(list) => attributes.push(("declaredType", list.name.to_owned())),
    }
    attributes.extend(start_value(variable).map(|value| ("start", value.to_string())));
    attributes
}

/// Attributes that say what a variable is: name, reference, meaning, causality, variability.
pub fn description_attributes(variable: &Variable) -> Vec<(&'static str, String)> {
    let (causality, initial) = match variable.causality() {
        Causality::Parameter => ("parameter", Some("exact")),
        Causality::Input => ("input", None),
        Causality::Output if variable.element.is_some() => ("local", Some("calculated")),
        Causality::Output => ("output", Some("calculated")),
    };
    let mut attributes = vec![
        ("name", variable.name.to_owned()),
        ("valueReference", variable.reference.to_string()),
        ("description", variable.description.to_owned()),
        ("causality", causality.to_owned()),
        ("variability", variability(variable).to_owned()),
    ];
    attributes.extend(initial.map(|initial| ("initial", initial.to_owned())));
    attributes
}

/// Attributes as the writer takes them.
pub fn borrowed<'a>(attributes: &'a [(&'static str, String)]) -> impl Iterator<Item = (&'a str, &'a str)> {
    attributes.iter().map(|(name, value)| (*name, value.as_str()))
}
