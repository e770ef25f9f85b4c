//! `modelDescription.xml` and the GUID, both made from the variables.

use crate::fmi::MODEL_IDENTIFIER;
use crate::fmi::variable::Variable;
use crate::fmi::variables::variables;
use std::fmt::Write;
use uuid::Uuid;
use wheelrail_slave::Type;
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

/// Name-based UUID of the description with an empty GUID.
pub fn guid() -> String {
    Uuid::new_v5(&Uuid::NAMESPACE_OID, written("").as_bytes()).to_string()
}

/// The model description as it stands in the FMU.
pub fn model_description() -> String {
    written(&guid())
}

fn written(guid: &str) -> String {
    let version = env!("CARGO_PKG_VERSION");
    let mut xml = format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n\
         <fmiModelDescription fmiVersion=\"2.0\" modelName=\"Coach\" guid=\"{guid}\" description=\"Four-axle coach in the \
         plane with disc brakes and wheel slide protection, for wheels of wheelrail.fmu\" author=\"The wheelrail authors\" \
         version=\"{version}\" license=\"{}\" generationTool=\"wheelrail-coach {version}\" \
         variableNamingConvention=\"structured\">\n\
         \x20 <CoSimulation modelIdentifier=\"{MODEL_IDENTIFIER}\" canHandleVariableCommunicationStepSize=\"true\" \
         canNotUseMemoryManagementFunctions=\"true\" canGetAndSetFMUstate=\"true\"/>\n",
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
    table.iter().for_each(|variable| scalar(&mut xml, variable));
    xml.push_str("  </ModelVariables>\n  <ModelStructure>\n");
    let outputs: Vec<usize> =
        (1..).zip(&table).filter(|(_, variable)| variable.causality() == "output").map(|(index, _)| index).collect();
    // The action of the coach in the next step follows from the steps before: outputs depend on no input of the moment.
    for list in ["Outputs", "InitialUnknowns"] {
        let _ = writeln!(xml, "    <{list}>");
        for index in &outputs {
            let _ = writeln!(xml, "      <Unknown index=\"{index}\" dependencies=\"\"/>");
        }
        let _ = writeln!(xml, "    </{list}>");
    }
    xml.push_str("  </ModelStructure>\n</fmiModelDescription>\n");
    xml
}

/// A `ScalarVariable`.
fn scalar(xml: &mut String, variable: &Variable) {
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
    let _ = writeln!(
        xml,
        "    <ScalarVariable name=\"{name}\" valueReference=\"{reference}\" description=\"{text}\" \
         causality=\"{causality}\" variability=\"{variability}\"{initial}><{kind:?}{attributes}/></ScalarVariable>"
    );
}
