//! `modelDescription.xml` and the GUID, both made from the table of variables.

use crate::fmi::MODEL_IDENTIFIER;
use crate::fmi::description::{
    XmlText, borrowed, default_experiment, description_attributes, document, empty, items, list, log_categories,
    measure_attributes, measures, retired_parameters, type_attributes, type_name, unit_definitions,
};
use crate::fmi::instance::derivatives::{INPUT_DERIVATIVE_ORDER, OUTPUT_DERIVATIVE_ORDER};
use crate::fmi::table::enumerations;
use crate::fmi::v2::variables::variables;
use crate::fmi::variable::{Group, Kind, Start, Variable};
use std::io;
use std::sync::OnceLock;
use uuid::Uuid;

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
    document([("fmiVersion", "2.0"), ("guid", guid)], |xml| {
        capabilities(xml)?;
        unit_definitions(xml)?;
        type_definitions(xml)?;
        log_categories(xml)?;
        default_experiment(xml)?;
        list(xml, "VendorAnnotations", |xml| {
            let tool = xml.create_element("Tool").with_attribute(("name", MODEL_IDENTIFIER));
            tool.write_inner_content(retired_parameters).map(drop)
        })?;
        list(xml, "ModelVariables", |xml| extent.variables().try_for_each(|variable| scalar_variable(xml, variable)))?;
        list(xml, "ModelStructure", |xml| model_structure(xml, extent))
    })
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

fn type_definitions(xml: &mut XmlText) -> io::Result<()> {
    list(xml, "TypeDefinitions", |xml| {
        for measure in measures() {
            let element = xml.create_element("SimpleType").with_attribute(("name", type_name(measure).as_str()));
            element.write_inner_content(|xml| empty(xml, "Real", &measure_attributes(measure)))?;
        }
        for enumeration in enumerations() {
            let attributes = [("name", enumeration.name), ("description", enumeration.description)];
            let element = xml.create_element("SimpleType").with_attributes(attributes);
            element.write_inner_content(|xml| list(xml, "Enumeration", |xml| items(xml, enumeration)))?;
        }
        Ok(())
    })
}

fn scalar_variable(xml: &mut XmlText, variable: &Variable) -> io::Result<()> {
    let kind = match variable.kind {
        Kind::Real { .. } => "Real",
        Kind::Integer { .. } => "Integer",
        Kind::Boolean => "Boolean",
        Kind::String => "String",
        Kind::Enumeration(_) => "Enumeration",
    };
    let (attributes, typed) = (description_attributes(variable), type_attributes(variable));
    let element = xml.create_element("ScalarVariable").with_attributes(borrowed(&attributes));
    let content =
        |xml: &mut XmlText| xml.create_element(kind).with_attributes(borrowed(&typed)).write_empty().map(drop);
    element.write_inner_content(content).map(drop)
}

/// Outputs, which points of profiles are not, depend on every input, which the standard expresses by leaving the list out: the derivatives of
/// `fmi2GetDirectionalDerivative` are those by the inputs of the step that led to the communication point. Initially
/// outputs depend on everything, too, or are zero by definition.
fn model_structure(xml: &mut XmlText, extent: Extent) -> io::Result<()> {
    let outputs: Vec<_> = (1usize..)
        .zip(extent.variables())
        .filter(|(_, variable)| variable.group() == Group::Output)
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
