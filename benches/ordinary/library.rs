//! Libraries of any version: where they lie, and what their model descriptions say.

use crate::worker::slave;
use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};
use std::collections::{BTreeMap, HashMap};
use std::fs::{self, File};
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Path, PathBuf};
use wheelrail::fmi::v2::description::{self, Extent};
use zip::ZipArchive;

/// A version of the program whose cost is measured.
pub struct Library {
    /// Name in the table.
    pub label: &'static str,
    /// The shared library, its model description, the resources of its FMU and the cache of its bases.
    pub binary: PathBuf,
    pub description: PathBuf,
    pub resources: Option<PathBuf>,
    pub cache: PathBuf,
    /// Variables that the command line sets.
    pub settings: Vec<(String, String)>,
}

impl Library {
    /// The library of an FMU, or the one that was built with this program.
    pub fn open(label: &'static str, file: Option<&Path>, settings: &[(String, String)]) -> Result<Library, String> {
        let own = slave::library();
        let path = file.unwrap_or(&own);
        let explained = |error: std::io::Error| format!("{}: {error}", path.display());
        let path = path.canonicalize().map_err(explained)?;
        let mut hasher = DefaultHasher::new();
        fs::read(&path).map_err(explained)?.hash(&mut hasher);
        let place = std::env::temp_dir().join("wheelrail-ordinary").join(format!("{:016x}", hasher.finish()));
        let cache = place.join("cache");
        fs::create_dir_all(&cache).map_err(explained)?;
        let settings = settings.to_vec();
        if path.extension().is_some_and(|extension| extension == "fmu") {
            let fmu = place.join("fmu");
            unpack(&path, &fmu)?;
            let binary = fmu.join("binaries/linux64/wheelrail.so");
            let (description, resources) = (fmu.join("modelDescription.xml"), Some(fmu.join("resources")));
            return Ok(Library { label, binary, description, resources, cache, settings });
        }
        if file.is_some() {
            return Err(format!("{}: expected an FMU, which has its model description", path.display()));
        }
        let text = description::model_description(Extent::Full).map_err(explained)?;
        let description = place.join("modelDescription.xml");
        fs::write(&description, text).map_err(explained)?;
        Ok(Library { label, binary: path, description, resources: None, cache, settings })
    }
}

/// Unpacks an FMU, unless it has been unpacked.
fn unpack(file: &Path, place: &Path) -> Result<(), String> {
    if place.is_dir() {
        return Ok(());
    }
    let unfinished = place.with_extension(std::process::id().to_string());
    let explained = |error: &dyn std::fmt::Display| format!("{}: {error}", file.display());
    let archive = File::open(file).map_err(|error| explained(&error))?;
    let mut archive = ZipArchive::new(archive).map_err(|error| explained(&error))?;
    archive.extract(&unfinished).map_err(|error| explained(&error))?;
    fs::rename(&unfinished, place).map_err(|error| explained(&error))
}

/// Type of a variable, with the values of an enumeration by name.
pub enum Kind {
    Real,
    Integer,
    Boolean,
    Text,
    Enumeration(BTreeMap<String, i32>),
}

/// Identity and variables of a model description.
#[derive(Default)]
pub struct Description {
    pub guid: String,
    pub variables: HashMap<String, (u32, Kind)>,
    types: HashMap<String, BTreeMap<String, i32>>,
    /// Type and variable whose elements are being read.
    open_type: String,
    open_variable: Option<(String, u32)>,
}

impl Description {
    pub fn read(path: &Path) -> Result<Description, String> {
        let explained = |error: &dyn std::fmt::Display| format!("{}: {error}", path.display());
        let mut reader = Reader::from_file(path).map_err(|error| explained(&error))?;
        let (mut description, mut buffer) = (Description::default(), Vec::new());
        loop {
            match reader.read_event_into(&mut buffer).map_err(|error| explained(&error))? {
                Event::Start(element) | Event::Empty(element) => {
                    description.take(&element).map_err(|error| explained(&error))?;
                }
                Event::Eof => return Ok(description),
                _ => {}
            }
            buffer.clear();
        }
    }

    fn take(&mut self, element: &BytesStart) -> Result<(), String> {
        let mut attributes = HashMap::new();
        for attribute in element.attributes() {
            let attribute = attribute.map_err(|error| error.to_string())?;
            attributes.insert(attribute.key.as_ref().to_owned(), attribute.value.to_string());
        }
        let attribute = |name: &str| attributes.get(name).cloned().unwrap_or_default();
        let number = |name: &str| {
            attribute(name).parse::<i32>().map_err(|_| format!("{name} = \"{}\" is no number", attribute(name)))
        };
        let kind = match element.name().as_ref() {
            "fmiModelDescription" => {
                self.guid = attribute("guid");
                return Ok(());
            }
            "SimpleType" => {
                self.open_type = attribute("name");
                return Ok(());
            }
            "Item" => {
                self.types.entry(self.open_type.clone()).or_default().insert(attribute("name"), number("value")?);
                return Ok(());
            }
            "ScalarVariable" => {
                self.open_variable = Some((attribute("name"), number("valueReference")? as u32));
                return Ok(());
            }
            "Real" => Kind::Real,
            "Integer" => Kind::Integer,
            "Boolean" => Kind::Boolean,
            "String" => Kind::Text,
            "Enumeration" => Kind::Enumeration(self.types.get(&attribute("declaredType")).cloned().unwrap_or_default()),
            _ => return Ok(()),
        };
        if let Some((name, reference)) = self.open_variable.take() {
            self.variables.insert(name, (reference, kind));
        }
        Ok(())
    }

    /// Reference and type of a variable.
    pub fn variable(&self, name: &str) -> Result<&(u32, Kind), String> {
        self.variables.get(name).ok_or_else(|| format!("variable \"{name}\" is not in the model description"))
    }
}
