//! The layered standard fmi-ls-ref: a manifest of what else is in the FMU, presets as parameter sets among it.
//!
//! Source: *Layered Standard References (FMI-LS-REF)*, 1.0.0-alpha.1; *System Structure and Parameterization*, 1.0.

use quick_xml::Writer;
use quick_xml::events::{BytesDecl, Event};
use std::io;
use wheelrail::fmi::description::{XmlText, empty};

/// Folder of the standard in an FMU.
const FOLDER: &str = "extra/org.fmi-standard.fmi-ls-ref";

/// Attributes of the root element of the manifest.
const ROOT: [(&str, &str); 4] = [
    ("xmlns:fmi-ls", "http://fmi-standard.org/fmi-ls-manifest"),
    ("fmi-ls:fmi-ls-name", "org.fmi-standard.fmi-ls-ref"),
    ("fmi-ls:fmi-ls-version", "1.0.0-alpha.1"),
    ("fmi-ls:fmi-ls-description", "Layered Standard providing information on related files included in an FMU."),
];

/// Type, place beside the manifest, role and meaning of files that are in every FMU.
const FILES: [[&str; 4]; 4] = [
    ["text/html", "../../documentation/index.html", "document", "Conventions, use and all variables"],
    ["text/csv", "../../documentation/reference/wheelrail_in.csv", "testcase", "Inputs of the run to compare with"],
    ["text/plain", "../../documentation/reference/wheelrail_ref.opt", "testcase", "Times and tolerance of that run"],
    ["text/csv", "../../documentation/reference/wheelrail_ref.csv", "result", "Outputs of that run"],
];

fn related(xml: &mut XmlText, [kind, source, role, description]: [&str; 4]) -> io::Result<()> {
    empty(xml, "Related", &[("type", kind), ("source", source), ("role", role), ("description", description)])
}

/// A document with one root element.
fn document(
    root: &str,
    attributes: &[(&str, &str)],
    content: impl FnOnce(&mut XmlText) -> io::Result<()>,
) -> io::Result<Vec<u8>> {
    let mut xml = Writer::new_with_indent(Vec::new(), b' ', 2);
    xml.write_event(Event::Decl(BytesDecl::new("1.0", Some("UTF-8"), None)))?;
    xml.create_element(root).with_attributes(attributes.iter().copied()).write_inner_content(content)?;
    Ok([xml.into_inner(), b"\n".to_vec()].concat())
}

/// A parameter set that chooses a preset.
fn parameter_set(preset: &str) -> io::Result<Vec<u8>> {
    const SPACE: &str = "http://ssp-standard.org/SSP1/SystemStructureParameterValues";
    let attributes = [("xmlns:ssv", SPACE), ("version", "1.0"), ("name", preset)];
    document("ssv:ParameterSet", &attributes, |xml| {
        xml.create_element("ssv:Parameters").write_inner_content(|xml| {
            let parameter = xml.create_element("ssv:Parameter").with_attribute(("name", "preset"));
            parameter.write_inner_content(|xml| empty(xml, "ssv:String", &[("value", preset)])).map(drop)
        })?;
        Ok(())
    })
}

/// Paths in the FMU and contents of the manifest and of the parameter sets of all presets.
pub fn entries(presets: &[&str]) -> io::Result<Vec<(String, Vec<u8>)>> {
    let manifest = document("fmiReferences", &ROOT, |xml| {
        FILES.into_iter().try_for_each(|file| related(xml, file))?;
        presets.iter().try_for_each(|preset| {
            let (source, meaning) = (format!("presets/{preset}.ssv"), format!("Preset {preset}"));
            related(xml, ["application/x-ssp-parameter-set", &source, "parameter", &meaning])
        })
    })?;
    let mut entries = vec![(format!("{FOLDER}/fmi-ls-manifest.xml"), manifest)];
    for preset in presets {
        entries.push((format!("{FOLDER}/presets/{preset}.ssv"), parameter_set(preset)?));
    }
    Ok(entries)
}
