//! Files of the Visualization Toolkit for ParaView: unstructured grids as text, which any reader of XML understands.
//!
//! Source: *VTK File Formats*, XML formats, `UnstructuredGrid` and `vtkMultiBlockDataSet`.

use super::Failure;
use super::table::create;
use quick_xml::Writer;
use quick_xml::events::{BytesDecl, BytesText, Event};
use std::fmt::Write as _;
use std::io::{self, BufWriter, Write};
use std::path::Path;

/// Cell type of quadrilaterals.
const QUAD: &str = "9";

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
    comment: &str,
    points: &[[f64; 2]],
    cells: &[[usize; 4]],
    data: &[Data],
) -> Result<(), Failure> {
    let sizes = [points.len().to_string(), cells.len().to_string()];
    document(path, "UnstructuredGrid", comment, |xml| {
        xml.create_element("UnstructuredGrid").write_inner_content(|xml| {
            let piece = xml.create_element("Piece");
            let piece = piece.with_attributes([("NumberOfPoints", &*sizes[0]), ("NumberOfCells", &*sizes[1])]);
            piece.write_inner_content(|xml| {
                xml.create_element("PointData").write_inner_content(|xml| {
                    data.iter().try_for_each(|d| array(xml, d.name, "Float64", d.components, &d.values))
                })?;
                xml.create_element("Points").write_inner_content(|xml| {
                    let Data { values, .. } = Data::vector("points", points);
                    array(xml, "points", "Float64", 3, &values)
                })?;
                xml.create_element("Cells").write_inner_content(|xml| {
                    let corners: Vec<_> = cells.iter().flatten().collect();
                    array(xml, "connectivity", "Int64", 1, &corners)?;
                    let offsets: Vec<_> = (1..=cells.len()).map(|i| 4 * i).collect();
                    array(xml, "offsets", "Int64", 1, &offsets)?;
                    array(xml, "types", "UInt8", 1, &vec![format_args!("{QUAD}"); cells.len()])
                })?;
                Ok(())
            })?;
            Ok(())
        })?;
        Ok(())
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

type Xml = Writer<BufWriter<std::fs::File>>;

fn document(
    path: &Path,
    kind: &str,
    comment: &str,
    content: impl FnOnce(&mut Xml) -> io::Result<()>,
) -> Result<(), Failure> {
    let mut xml = Writer::new_with_indent(BufWriter::new(create(path)?), b' ', 1);
    let written = xml.write_event(Event::Decl(BytesDecl::new("1.0", None, None))).and_then(|()| {
        xml.write_event(Event::Comment(BytesText::new(comment)))?;
        let root = xml.create_element("VTKFile").with_attributes([("type", kind), ("version", "1.0")]);
        root.write_inner_content(content)?;
        xml.get_mut().flush()
    });
    written.map_err(|error| Failure::Run(format!("{} cannot be written: {error}", path.display())))
}

/// One value per number, as text that reads back exactly.
fn array<T: std::fmt::Debug>(xml: &mut Xml, name: &str, kind: &str, components: usize, values: &[T]) -> io::Result<()> {
    let mut text = String::new();
    for (i, value) in values.iter().enumerate() {
        let end = if (i + 1) % components == 0 { '\n' } else { ' ' };
        write!(text, "{value:?}{end}").map_err(io::Error::other)?;
    }
    let components = components.to_string();
    let element = xml.create_element("DataArray").with_attributes([
        ("type", kind),
        ("Name", name),
        ("NumberOfComponents", &*components),
        ("format", "ascii"),
    ]);
    element.write_text_content(BytesText::from_escaped(text)).map(drop)
}
