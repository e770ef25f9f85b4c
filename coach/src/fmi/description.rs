//! `modelDescription.xml` of both versions of FMI, and the identities in them, made from the variables.

use crate::fmi::MODEL_IDENTIFIER;
use crate::fmi::variable::Variable;
use crate::fmi::variables::variables;
use std::fmt::Write;
use uuid::Uuid;
use wheelrail_slave::Type;
use wheelrail_slave::array_access::TIME;
use wheelrail_slave::log::CATEGORIES;

/// Units of the variables with their attributes of `BaseUnit`.
const UNITS: [(&str, &str); 15] = [
    ("1", ""),
    ("m", r#" m="1""#),
    ("s", r#" s="1""#),
    ("kg", r#" kg="1""#),
    ("m/s", r#" m="1" s="-1""#),
    ("m/s2", r#" m="1" s="-2""#),
    ("m3", r#" m="3""#),
    ("rad/s", r#" s="-1" rad="1""#),
    ("N", r#" kg="1" m="1" s="-2""#),
    ("N.m", r#" kg="1" m="2" s="-2""#),
    ("N/m", r#" kg="1" s="-2""#),
    ("N.s/m", r#" kg="1" s="-1""#),
    ("kg.m2", r#" kg="1" m="2""#),
    ("s2/m2", r#" m="-2" s="2""#),
    ("Pa", r#" kg="1" m="-1" s="-2""#),
];

/// Version of FMI.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Version {
    /// FMI 2.0.
    Two,
    /// FMI 3.0.
    Three,
}

/// Identity of the description, a name-based UUID: GUID of FMI 2.0, instantiation token of FMI 3.0.
pub fn identity(version: Version) -> String {
    Uuid::new_v5(&Uuid::NAMESPACE_OID, written(version, "").as_bytes()).to_string()
}

/// The model description as it stands in the FMU.
pub fn model_description(version: Version) -> String {
    written(version, &identity(version))
}

fn written(fmi: Version, identity: &str) -> String {
    let version = env!("CARGO_PKG_VERSION");
    let (number, argument, capabilities) = match fmi {
        Version::Two => ("2.0", "guid", "canNotUseMemoryManagementFunctions=\"true\" canGetAndSetFMUstate=\"true\""),
        Version::Three => ("3.0", "instantiationToken", "canGetAndSetFMUState=\"true\""),
    };
    let mut xml = format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n\
         <fmiModelDescription fmiVersion=\"{number}\" modelName=\"Coach\" {argument}=\"{identity}\" description=\"Four-axle coach in the \
         plane with disc brakes and wheel slide protection, for wheels of wheelrail.fmu\" author=\"The wheelrail authors\" \
         version=\"{version}\" license=\"{}\" generationTool=\"wheelrail-coach {version}\" \
         variableNamingConvention=\"structured\">\n\
         \x20 <CoSimulation modelIdentifier=\"{MODEL_IDENTIFIER}\" canHandleVariableCommunicationStepSize=\"true\" \
         {capabilities}/>\n",
        env!("CARGO_PKG_LICENSE"),
    );
    xml.push_str("  <UnitDefinitions>\n");
    for (name, base) in UNITS {
        let _ = writeln!(xml, "    <Unit name=\"{name}\"><BaseUnit{base}/></Unit>");
    }
    xml.push_str("  </UnitDefinitions>\n  <LogCategories>\n");
    for (name, text) in CATEGORIES {
        let _ = writeln!(xml, "    <Category name=\"{name}\" description=\"{text}\"/>");
    }
    xml.push_str("  </LogCategories>\n  <DefaultExperiment startTime=\"0.0\" stopTime=\"1.0\" stepSize=\"0.001\"/>\n");
    xml.push_str("  <ModelVariables>\n");
    let table = variables();
    if fmi == Version::Three {
        let _ = writeln!(
            xml,
            "    <Float64 name=\"time\" valueReference=\"{TIME}\" description=\"Communication point\" \
             causality=\"independent\" variability=\"continuous\" unit=\"s\"/>"
        );
    }
    table.iter().for_each(|variable| described(&mut xml, fmi, variable));
    xml.push_str("  </ModelVariables>\n  <ModelStructure>\n");
    structure(&mut xml, fmi, &table);
    xml.push_str("  </ModelStructure>\n</fmiModelDescription>\n");
    xml
}

/// The outputs. The action of the coach in the next step follows from the steps before: outputs depend on no input of the
/// moment.
fn structure(xml: &mut String, fmi: Version, table: &[Variable]) {
    let outputs = || (1..).zip(table).filter(|(_, variable)| variable.causality() == "output");
    for (list, element) in [("Outputs", "Output"), ("InitialUnknowns", "InitialUnknown")] {
        match fmi {
            Version::Two => {
                let _ = writeln!(xml, "    <{list}>");
                for (index, _) in outputs() {
                    let index: usize = index;
                    let _ = writeln!(xml, "      <Unknown index=\"{index}\" dependencies=\"\"/>");
                }
                let _ = writeln!(xml, "    </{list}>");
            }
            Version::Three => {
                for (_, Variable { reference, .. }) in outputs() {
                    let _ = writeln!(xml, "    <{element} valueReference=\"{reference}\" dependencies=\"\"/>");
                }
            }
        }
    }
}

/// The element of a variable.
fn described(xml: &mut String, fmi: Version, variable: &Variable) {
    let Variable { reference, name, unit, range: [low, high], start, text, .. } = variable;
    let causality = variable.causality();
    let kind = variable.kind();
    let (variability, initial) = match (causality, kind) {
        ("parameter", _) => ("fixed", " initial=\"exact\""),
        ("output", Type::Integer) => ("discrete", " initial=\"calculated\""),
        ("output", _) => ("continuous", " initial=\"calculated\""),
        _ => ("continuous", ""),
    };
    let mut attributes = String::new();
    if kind == Type::Real {
        let _ = write!(attributes, " unit=\"{unit}\"");
    }
    if causality != "output" {
        let _ = write!(attributes, " min=\"{low:?}\" max=\"{high:?}\" start=\"{start:?}\"");
    }
    let what = format!(
        "name=\"{name}\" valueReference=\"{reference}\" description=\"{text}\" causality=\"{causality}\" \
         variability=\"{variability}\"{initial}"
    );
    let _ = match fmi {
        Version::Two => writeln!(xml, "    <ScalarVariable {what}><{kind:?}{attributes}/></ScalarVariable>"),
        Version::Three => writeln!(xml, "    <{:?} {what}{attributes}/>", variable.element_type()),
    };
}
