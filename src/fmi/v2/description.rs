//! `modelDescription.xml` and the GUID, both made from the table of variables.

use crate::config::Config;
use crate::config::retired::{RETIRED, Retired};
use crate::fmi::MODEL_IDENTIFIER;
use crate::fmi::instance::derivatives::{INPUT_DERIVATIVE_ORDER, OUTPUT_DERIVATIVE_ORDER};
use crate::fmi::settings::start_value;
use crate::fmi::table::enumerations;
use crate::fmi::units::{BASE_UNITS, Measure, UNITS};
use crate::fmi::v2::variables::variables;
use crate::fmi::variable::{Access, Causality, Kind, Start, Variable};
use crate::simulation::Read;
use quick_xml::Writer;
use quick_xml::events::{BytesDecl, Event};
use std::io;
use std::sync::OnceLock;
use uuid::Uuid;
use wheelrail_slave::log::CATEGORIES;

/// End of the default experiment \[s].
pub const DEFAULT_STOP_TIME: f64 = 1.0;
/// Communication step of the default experiment \[s].
pub const DEFAULT_STEP_SIZE: f64 = 1e-3;

const DESCRIPTION: &str = "Transient rolling contact of an elastic wheel on an elastic rail: plane finite elements in \
    a moving frame, exact Coulomb friction. x in travel direction, y up, omega > 0 rolls forward; contact forces act \
    on the wheel. Plane model: no lateral force, no spin.";

/// Date of the last change of the interface. A date of the build would make equal builds unequal.
const GENERATED: &str = "2026-11-26T00:00:00Z";

const COPYRIGHT: &str = "Copyright 2026 The wheelrail authors";

/// Extent of a description: the variables that it lists. Value references are the same in both, and so is the library.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Extent {
    /// All variables.
    #[default]
    Full,
    /// All but the points of profiles across the patch and into the tread, for masters that record everything they see.
    WithoutProfiles,
}

impl Extent {
    /// The variables that are listed, in the order of their indices.
    pub fn variables(self) -> impl Iterator<Item = &'static Variable> + Clone {
        let listed = move |v: &&Variable| self == Extent::Full || v.element.is_none();
        variables().iter().filter(listed)
    }
}

/// Writer of the description.
type XmlText = Writer<Vec<u8>>;

/// Name-based UUID of the description with an empty GUID: changes with the interface and only with it. One without
/// profiles says less of the same interface and has the GUID of the full one.
pub fn guid() -> String {
    static GUID: OnceLock<Uuid> = OnceLock::new();
    let compute = || Uuid::new_v5(&Uuid::NAMESPACE_OID, write("", Extent::Full).unwrap_or_default().as_bytes());
    GUID.get_or_init(compute).to_string()
}

/// The model description as it stands in the FMU.
pub fn model_description(extent: Extent) -> io::Result<String> {
    write(&guid(), extent)
}

fn write(guid: &str, extent: Extent) -> io::Result<String> {
    let mut xml = Writer::new_with_indent(Vec::new(), b' ', 2);
    xml.write_event(Event::Decl(BytesDecl::new("1.0", Some("UTF-8"), None)))?;
    let root = xml.create_element("fmiModelDescription").with_attributes([
        ("fmiVersion", "2.0"),
        ("modelName", "Wheel on rail"),
        ("guid", guid),
        ("description", DESCRIPTION),
        ("author", env!("CARGO_PKG_AUTHORS")),
        ("version", env!("CARGO_PKG_VERSION")),
        ("copyright", COPYRIGHT),
        ("license", env!("CARGO_PKG_LICENSE")),
        ("generationTool", concat!("wheelrail ", env!("CARGO_PKG_VERSION"))),
        ("generationDateAndTime", GENERATED),
        ("variableNamingConvention", "structured"),
    ]);
    root.write_inner_content(|xml| {
        capabilities(xml)?;
        unit_definitions(xml)?;
        type_definitions(xml)?;
        list(xml, "LogCategories", |xml| {
            CATEGORIES.iter().try_for_each(|c| empty(xml, "Category", &[("name", c.0), ("description", c.1)]))
        })?;
        let (stop, step) = (format!("{DEFAULT_STOP_TIME:?}"), format!("{DEFAULT_STEP_SIZE:?}"));
        let tolerance = number(Config::default().tuning.tolerance);
        let attributes = [("startTime", "0.0"), ("stopTime", &*stop), ("tolerance", &*tolerance), ("stepSize", &*step)];
        empty(xml, "DefaultExperiment", &attributes)?;
        list(xml, "VendorAnnotations", retired_parameters)?;
        list(xml, "ModelVariables", |xml| model_variables(xml, extent))?;
        list(xml, "ModelStructure", |xml| model_structure(xml, extent))
    })?;
    let mut text = String::from_utf8(xml.into_inner()).map_err(io::Error::other)?;
    text.push('\n');
    Ok(text)
}

fn empty(xml: &mut XmlText, name: &str, attributes: &[(&str, &str)]) -> io::Result<()> {
    xml.create_element(name).with_attributes(attributes.iter().copied()).write_empty().map(drop)
}

fn list(xml: &mut XmlText, name: &str, content: impl FnOnce(&mut XmlText) -> io::Result<()>) -> io::Result<()> {
    xml.create_element(name).write_inner_content(content).map(drop)
}

/// Shortest decimal form that reads back to the same number.
fn number(value: f64) -> String {
    format!("{value:?}")
}

/// The retired parameters with the texts of their refusals, for programs that know variables by name only.
fn retired_parameters(xml: &mut XmlText) -> io::Result<()> {
    let parameter = |xml: &mut XmlText, retired: &Retired| {
        let (reference, refusal) = (retired.number.to_string(), retired.to_string());
        empty(xml, "Retired", &[("name", retired.name), ("valueReference", &reference), ("refusal", &refusal)])
    };
    let tool = xml.create_element("Tool").with_attribute(("name", MODEL_IDENTIFIER));
    let content = |xml: &mut XmlText| {
        list(xml, "RetiredParameters", |xml| RETIRED.iter().try_for_each(|retired| parameter(xml, retired)))
    };
    tool.write_inner_content(content).map(drop)
}

fn capabilities(xml: &mut XmlText) -> io::Result<()> {
    let output_order = OUTPUT_DERIVATIVE_ORDER.to_string();
    let attributes = [
        ("modelIdentifier", MODEL_IDENTIFIER),
        ("needsExecutionTool", "false"),
        ("canHandleVariableCommunicationStepSize", "true"),
        ("canInterpolateInputs", if INPUT_DERIVATIVE_ORDER > 0 { "true" } else { "false" }),
        ("maxOutputDerivativeOrder", output_order.as_str()),
        ("canRunAsynchronuously", "false"),
        ("canBeInstantiatedOnlyOncePerProcess", "false"),
        ("canNotUseMemoryManagementFunctions", "true"),
        ("canGetAndSetFMUstate", "true"),
        ("canSerializeFMUstate", "true"),
        ("providesDirectionalDerivative", "true"),
    ];
    empty(xml, "CoSimulation", &attributes)
}

fn unit_definitions(xml: &mut XmlText) -> io::Result<()> {
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
fn measures() -> Vec<Measure> {
    let mut found = Vec::new();
    for variable in variables() {
        if let Kind::Real { measure, .. } = variable.kind
            && !found.contains(&measure)
        {
            found.push(measure);
        }
    }
    found
}

/// The quantity of a measure.
fn quantity(measure: Measure) -> &'static str {
    UNITS.iter().find(|unit| unit.name == measure.unit).map_or("", |unit| unit.quantity)
}

/// Name of the declared type of a measure: its quantity, and the unit in which it is shown.
fn type_name(measure: Measure) -> String {
    match (quantity(measure), measure.display) {
        (quantity, _) if measure.is_relative() => format!("{quantity}Difference"),
        (quantity, Some(display)) => format!("{quantity} in {display}"),
        (quantity, None) => quantity.to_owned(),
    }
}

fn real_type(xml: &mut XmlText, measure: Measure) -> io::Result<()> {
    let mut attributes = vec![("quantity", quantity(measure)), ("unit", measure.unit)];
    attributes.extend(measure.display.map(|display| ("displayUnit", display)));
    attributes.extend(measure.is_relative().then_some(("relativeQuantity", "true")));
    let element = xml.create_element("SimpleType").with_attribute(("name", type_name(measure).as_str()));
    element.write_inner_content(|xml| empty(xml, "Real", &attributes)).map(drop)
}

fn type_definitions(xml: &mut XmlText) -> io::Result<()> {
    list(xml, "TypeDefinitions", |xml| {
        measures().into_iter().try_for_each(|measure| real_type(xml, measure))?;
        for list in enumerations() {
            let element = xml
                .create_element("SimpleType")
                .with_attributes([("name", list.name), ("description", list.description)]);
            element.write_inner_content(|xml| {
                xml.create_element("Enumeration").write_inner_content(|xml| {
                    for (value, (name, text)) in (1..).zip(list.items) {
                        let value: i32 = value;
                        let attributes = [("name", *name), ("value", &value.to_string()), ("description", *text)];
                        empty(xml, "Item", &attributes)?;
                    }
                    Ok(())
                })?;
                Ok(())
            })?;
        }
        Ok(())
    })
}

/// FMI variability of a variable.
pub fn variability(variable: &Variable) -> &'static str {
    match variable.access {
        Access::ChoiceInput(..) => "discrete",
        Access::Output(row) if matches!(row.read, Read::Count(_) | Read::Flag(_)) => "discrete",
        Access::RealInput(_) | Access::Output(_) => "continuous",
        _ if variable.tunable => "tunable",
        _ => "fixed",
    }
}

fn model_variables(xml: &mut XmlText, extent: Extent) -> io::Result<()> {
    extent.variables().try_for_each(|variable| {
        let reference = variable.reference.to_string();
        let (causality, initial) = match variable.causality() {
            Causality::Parameter => ("parameter", Some("exact")),
            Causality::Input => ("input", None),
            Causality::Output => ("output", Some("calculated")),
        };
        let mut attributes = vec![
            ("name", variable.name),
            ("valueReference", &reference),
            ("description", variable.description),
            ("causality", causality),
            ("variability", variability(variable)),
        ];
        attributes.extend(initial.map(|initial| ("initial", initial)));
        let element = xml.create_element("ScalarVariable").with_attributes(attributes);
        element.write_inner_content(|xml| typed(xml, variable)).map(drop)
    })
}

/// The element inside a `ScalarVariable` that gives the type.
fn typed(xml: &mut XmlText, variable: &Variable) -> io::Result<()> {
    let mut attributes: Vec<(&str, String)> = Vec::new();
    let element = match variable.kind {
        Kind::Real { measure, min, max, nominal } => {
            attributes.push(("declaredType", type_name(measure)));
            attributes.push(("unit", measure.unit.to_owned()));
            attributes.extend(measure.display.map(|display| ("displayUnit", display.to_owned())));
            attributes.extend(measure.is_relative().then(|| ("relativeQuantity", "true".to_owned())));
            attributes.extend(min.is_finite().then(|| ("min", number(min))));
            attributes.extend(max.is_finite().then(|| ("max", number(max))));
            attributes.extend((nominal != 1.0).then(|| ("nominal", number(nominal))));
            "Real"
        }
        Kind::Integer { min, max } => {
            attributes.push(("min", min.to_string()));
            attributes.extend((max < i32::MAX).then(|| ("max", max.to_string())));
            "Integer"
        }
        Kind::Boolean => "Boolean",
        Kind::String => "String",
        Kind::Enumeration(list) => {
            attributes.push(("declaredType", list.name.to_owned()));
            "Enumeration"
        }
    };
    let start = start_value(variable).map(|value| value.to_string());
    attributes.extend(start.map(|start| ("start", start)));
    let attributes: Vec<_> = attributes.iter().map(|(name, value)| (*name, value.as_str())).collect();
    empty(xml, element, &attributes)
}

/// Outputs depend on every input, which the standard expresses by leaving the list out: the derivatives of
/// `fmi2GetDirectionalDerivative` are those by the inputs of the step that led to the communication point. Initially
/// outputs depend on everything, too, or are zero by definition.
fn model_structure(xml: &mut XmlText, extent: Extent) -> io::Result<()> {
    let outputs: Vec<_> = (1usize..)
        .zip(extent.variables())
        .filter(|(_, variable)| variable.causality() == Causality::Output)
        .map(|(index, variable)| (index.to_string(), variable.start))
        .collect();
    list(xml, "Outputs", |xml| outputs.iter().try_for_each(|(index, _)| empty(xml, "Unknown", &[("index", index)])))?;
    list(xml, "InitialUnknowns", |xml| {
        outputs.iter().try_for_each(|(index, start)| match start {
            Start::Zero => empty(xml, "Unknown", &[("index", index), ("dependencies", "")]),
            Start::Stationary => empty(xml, "Unknown", &[("index", index)]),
        })
    })
}
