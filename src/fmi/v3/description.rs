//! `modelDescription.xml` and the instantiation token, both made from the table of variables.

use crate::fmi::MODEL_IDENTIFIER;
use crate::fmi::description::{
    XmlText, borrowed, default_experiment, description_attributes, document, empty, items, list, log_categories,
    measure_attributes, measures, retired_parameters, type_attributes, type_name, unit_definitions,
};
use crate::fmi::instance::derivatives::OUTPUT_DERIVATIVE_ORDER;
use crate::fmi::table::{enumerations, table};
use crate::fmi::variable::{Causality, Kind, Start, Variable};
use std::io;
use std::sync::OnceLock;
use uuid::Uuid;
use wheelrail_slave::array_access::TIME;

/// Name-based UUID of the description with an empty token: changes with the interface and only with it.
pub fn token() -> String {
    static TOKEN: OnceLock<Uuid> = OnceLock::new();
    let compute = || Uuid::new_v5(&Uuid::NAMESPACE_OID, write("").unwrap_or_default().as_bytes());
    TOKEN.get_or_init(compute).to_string()
}

/// The model description as it stands in the FMU.
pub fn model_description() -> io::Result<String> {
    write(&token())
}

fn write(token: &str) -> io::Result<String> {
    document([("fmiVersion", "3.0"), ("instantiationToken", token)], |xml| {
        capabilities(xml)?;
        unit_definitions(xml)?;
        type_definitions(xml)?;
        log_categories(xml)?;
        default_experiment(xml)?;
        list(xml, "ModelVariables", |xml| {
            time(xml)?;
            table().iter().try_for_each(|row| variable(xml, row))
        })?;
        list(xml, "ModelStructure", model_structure)?;
        list(xml, "Annotations", |xml| {
            let annotation = xml.create_element("Annotation").with_attribute(("type", MODEL_IDENTIFIER));
            annotation.write_inner_content(retired_parameters).map(drop)
        })
    })
}

fn capabilities(xml: &mut XmlText) -> io::Result<()> {
    let output_order = OUTPUT_DERIVATIVE_ORDER.to_string();
    let attributes = [
        ("modelIdentifier", MODEL_IDENTIFIER),
        ("needsExecutionTool", "false"),
        ("canBeInstantiatedOnlyOncePerProcess", "false"),
        ("canGetAndSetFMUState", "true"),
        ("canSerializeFMUState", "true"),
        ("providesDirectionalDerivatives", "true"),
        ("providesAdjointDerivatives", "true"),
        ("providesPerElementDependencies", "false"),
        ("canHandleVariableCommunicationStepSize", "true"),
        ("maxOutputDerivativeOrder", output_order.as_str()),
        ("providesIntermediateUpdate", "true"),
        ("mightReturnEarlyFromDoStep", "true"),
        ("hasEventMode", "false"),
    ];
    empty(xml, "CoSimulation", &attributes)
}

fn type_definitions(xml: &mut XmlText) -> io::Result<()> {
    list(xml, "TypeDefinitions", |xml| {
        for measure in measures() {
            let name = type_name(measure);
            let attributes = std::iter::once(("name", name.as_str())).chain(measure_attributes(measure));
            xml.create_element("Float64Type").with_attributes(attributes).write_empty()?;
        }
        for enumeration in enumerations() {
            // Without the description that the standard allows: fmpy up to 0.3.23 fails at one.
            let element = xml.create_element("EnumerationType").with_attribute(("name", enumeration.name));
            element.write_inner_content(|xml| items(xml, enumeration))?;
        }
        Ok(())
    })
}

/// The independent variable, which FMI 2.0 does not list.
fn time(xml: &mut XmlText) -> io::Result<()> {
    let reference = TIME.to_string();
    let attributes = [
        ("name", "time"),
        ("valueReference", reference.as_str()),
        ("description", "Communication point"),
        ("causality", "independent"),
        ("variability", "continuous"),
        ("unit", "s"),
    ];
    empty(xml, "Float64", &attributes)
}

/// A row of the table; an array has its size, and a text its start, as an element inside.
fn variable(xml: &mut XmlText, row: &Variable) -> io::Result<()> {
    let kind = match row.kind {
        Kind::Real { .. } => "Float64",
        Kind::Integer { .. } => "Int32",
        Kind::Boolean => "Boolean",
        Kind::String => "String",
        Kind::Enumeration(_) => "Enumeration",
    };
    let (mut attributes, typed) = (description_attributes(row), type_attributes(row));
    let (starts, typed): (Vec<_>, Vec<_>) =
        typed.into_iter().partition(|(name, _)| kind == "String" && *name == "start");
    attributes.extend(typed);
    attributes.extend(row.is_ramped().then(|| ("intermediateUpdate", "true".to_owned())));
    let element = xml.create_element(kind).with_attributes(borrowed(&attributes));
    if row.dimension.is_none() && starts.is_empty() {
        return element.write_empty().map(drop);
    }
    let content = |xml: &mut XmlText| {
        if let Some(size) = row.dimension {
            empty(xml, "Dimension", &[("start", &size.to_string())])?;
        }
        starts.iter().try_for_each(|(_, start)| empty(xml, "Start", &[("value", start)]))
    };
    element.write_inner_content(content).map(drop)
}

/// Outputs depend on every input, which the standard expresses by leaving the list out: the derivatives of
/// `fmi3GetDirectionalDerivative` are those by the inputs of the step that led to the communication point. Initially
/// outputs depend on everything, too, or are zero by definition.
fn model_structure(xml: &mut XmlText) -> io::Result<()> {
    let outputs = || table().iter().filter(|row| row.causality() == Causality::Output);
    outputs().try_for_each(|row| empty(xml, "Output", &[("valueReference", &row.reference.to_string())]))?;
    outputs().try_for_each(|row| {
        let reference = row.reference.to_string();
        match row.start {
            Start::Zero => empty(xml, "InitialUnknown", &[("valueReference", &reference), ("dependencies", "")]),
            Start::Stationary => empty(xml, "InitialUnknown", &[("valueReference", &reference)]),
        }
    })
}
