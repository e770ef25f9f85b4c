//! Files of the Visualization Toolkit for ParaView: unstructured grids as text, which any reader of XML understands, or
//! with appended raw data, which are smaller and read without parsing.
//!
//! Source: *VTK File Formats*, XML formats, `UnstructuredGrid`, `vtkMultiBlockDataSet` and `Collection`.

use super::Failure;
use super::table::create;
use quick_xml::Writer;
use quick_xml::events::{BytesDecl, BytesText, Event};
use std::fmt::Write as _;
use std::io::{self, Write};
use std::path::Path;
use wheelrail::files::NewFile;

/// Cell type of quadrilaterals.
const QUAD: u8 = 9;

/// Encoding of the numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Encoding {
    /// Text that reads back exactly.
    Text,
    /// Bytes behind all elements, little-endian, each array after its length.
    Raw,
}

/// A named quantity at the points; vectors are padded to three components.
pub struct Data {
    /// Name under which ParaView shows it.
    pub name: &'static str,
    /// Numbers per point: 1 or 3.
    pub components: usize,
    /// All components of a point together.
    pub values: Vec<f64>,
}

impl Data {
    /// One number per point.
    pub fn scalar(name: &'static str, values: Vec<f64>) -> Data {
        Data { name, components: 1, values }
    }

    /// A vector in the plane.
    pub fn vector(name: &'static str, values: &[[f64; 2]]) -> Data {
        Data { name, components: 3, values: values.iter().flat_map(|[x, y]| [*x, *y, 0.0]).collect() }
    }
}

/// Writes quadrilaterals with data at their points. `comment` says what the file holds.
pub fn write(
    path: &Path,
    encoding: Encoding,
    comment: &str,
    points: &[[f64; 2]],
    cells: &[[usize; 4]],
    data: &[Data],
) -> Result<(), Failure> {
    let sizes = [points.len().to_string(), cells.len().to_string()];
    let mut arrays = Arrays { encoding, appended: Vec::new() };
    document(path, "UnstructuredGrid", comment, |xml| {
        xml.create_element("UnstructuredGrid").write_inner_content(|xml| {
            let piece = xml.create_element("Piece");
            let piece = piece.with_attributes([("NumberOfPoints", &*sizes[0]), ("NumberOfCells", &*sizes[1])]);
            piece.write_inner_content(|xml| {
                xml.create_element("PointData").write_inner_content(|xml| {
                    data.iter().try_for_each(|d| arrays.write(xml, d.name, d.components, &d.values))
                })?;
                xml.create_element("Points").write_inner_content(|xml| {
                    let Data { values, .. } = Data::vector("points", points);
                    arrays.write(xml, "points", 3, &values)
                })?;
                xml.create_element("Cells").write_inner_content(|xml| {
                    let corners: Vec<_> = cells.iter().flatten().map(|&corner| corner as i64).collect();
                    arrays.write(xml, "connectivity", 1, &corners)?;
                    let offsets: Vec<_> = (1..=cells.len()).map(|i| 4 * i as i64).collect();
                    arrays.write(xml, "offsets", 1, &offsets)?;
                    arrays.write(xml, "types", 1, &vec![QUAD; cells.len()])
                })?;
                Ok(())
            })?;
            Ok(())
        })?;
        arrays.finish(xml)
    })
}

/// Writes an index that opens several files at once, each under its name.
pub fn write_index(path: &Path, comment: &str, blocks: &[(&str, String)]) -> Result<(), Failure> {
    document(path, "vtkMultiBlockDataSet", comment, |xml| {
        xml.create_element("vtkMultiBlockDataSet").write_inner_content(|xml| {
            for (i, (name, file)) in blocks.iter().enumerate() {
                let index = i.to_string();
                let element = xml.create_element("DataSet");
                element.with_attributes([("index", &*index), ("name", name), ("file", file)]).write_empty()?;
            }
            Ok(())
        })?;
        Ok(())
    })
}

/// Writes an index of a series: at each time \[s] several files, each a part under its number.
pub fn write_series(path: &Path, comment: &str, frames: &[(f64, Vec<String>)]) -> Result<(), Failure> {
    document(path, "Collection", comment, |xml| {
        xml.create_element("Collection").write_inner_content(|xml| {
            for (time, files) in frames {
                let time = format!("{time:?}");
                for (part, file) in files.iter().enumerate() {
                    let part = part.to_string();
                    let attributes = [("timestep", &*time), ("group", ""), ("part", &*part), ("file", file)];
                    xml.create_element("DataSet").with_attributes(attributes).write_empty()?;
                }
            }
            Ok(())
        })?;
        Ok(())
    })
}

type Xml = Writer<NewFile>;

fn document(
    path: &Path,
    kind: &str,
    comment: &str,
    content: impl FnOnce(&mut Xml) -> io::Result<()>,
) -> Result<(), Failure> {
    let mut xml = Writer::new_with_indent(create(path)?, b' ', 1);
    let written = xml.write_event(Event::Decl(BytesDecl::new("1.0", None, None))).and_then(|()| {
        xml.write_event(Event::Comment(BytesText::new(comment)))?;
        let attributes =
            [("type", kind), ("version", "1.0"), ("byte_order", "LittleEndian"), ("header_type", "UInt64")];
        let root = xml.create_element("VTKFile").with_attributes(attributes);
        root.write_inner_content(content).map(drop)
    });
    Ok(written.and_then(|()| xml.into_inner().finish())?)
}

/// A type of numbers in arrays.
trait Number: std::fmt::Debug {
    /// Name of the type.
    const KIND: &'static str;

    /// Appends its bytes, little-endian.
    fn append(&self, bytes: &mut Vec<u8>);
}

/// Implements [`Number`].
macro_rules! numbers {
    ($($number:ty: $kind:literal),*) => { $(
        impl Number for $number {
            const KIND: &'static str = $kind;

            fn append(&self, bytes: &mut Vec<u8>) {
                bytes.extend_from_slice(&self.to_le_bytes());
            }
        }
    )* };
}

numbers!(f64: "Float64", i64: "Int64", u8: "UInt8");

/// Arrays of a file in one encoding.
struct Arrays {
    encoding: Encoding,
    /// Bytes that are written behind all elements.
    appended: Vec<u8>,
}

impl Arrays {
    /// Writes an array, or where it will be found.
    fn write<T: Number>(&mut self, xml: &mut Xml, name: &str, components: usize, values: &[T]) -> io::Result<()> {
        let number = components.to_string();
        let element = xml.create_element("DataArray");
        let element = element.with_attributes([("type", T::KIND), ("Name", name), ("NumberOfComponents", &*number)]);
        match self.encoding {
            Encoding::Text => {
                let mut text = String::new();
                for (i, value) in values.iter().enumerate() {
                    let end = if (i + 1) % components == 0 { '\n' } else { ' ' };
                    write!(text, "{value:?}{end}").map_err(io::Error::other)?;
                }
                element.with_attribute(("format", "ascii")).write_text_content(BytesText::from_escaped(text))?;
            }
            Encoding::Raw => {
                let bytes = &mut self.appended;
                let offset = bytes.len().to_string();
                bytes.extend_from_slice(&(std::mem::size_of_val(values) as u64).to_le_bytes());
                values.iter().for_each(|value| value.append(bytes));
                element.with_attributes([("format", "appended"), ("offset", &*offset)]).write_empty()?;
            }
        }
        Ok(())
    }

    /// Writes what was to be appended.
    fn finish(&self, xml: &mut Xml) -> io::Result<()> {
        if self.encoding == Encoding::Text {
            return Ok(());
        }
        // The data begin behind an underscore and are no XML.
        let file = xml.get_mut();
        file.write_all(b"\n <AppendedData encoding=\"raw\">\n_")?;
        file.write_all(&self.appended)?;
        file.write_all(b"\n </AppendedData>")
    }
}
