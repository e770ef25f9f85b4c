//! Files of the Visualization Toolkit for ParaView: unstructured grids whose numbers stand behind all elements as bytes.
//!
//! Source: *VTK File Formats*, XML formats, `UnstructuredGrid` and `Collection`.

use std::fmt::Write;
use std::path::Path;
use std::{fs, io};

/// Cell type of quadrilaterals.
const QUAD: u8 = 9;
const HEAD: &str = r#"version="1.0" byte_order="LittleEndian" header_type="UInt64""#;

/// A named quantity at the points; vectors are padded to three components.
pub struct Data {
    name: &'static str,
    kind: &'static str,
    components: usize,
    bytes: Vec<u8>,
}

impl Data {
    /// One number per point.
    pub fn scalar(name: &'static str, values: Vec<f64>) -> Data {
        Data { name, kind: "Float64", components: 1, bytes: values.iter().flat_map(|v| v.to_le_bytes()).collect() }
    }

    /// A vector in the plane.
    pub fn vector(name: &'static str, values: &[[f64; 2]]) -> Data {
        let flat = values.iter().flat_map(|[x, y]| [*x, *y, 0.0]).collect();
        Data { components: 3, ..Data::scalar(name, flat) }
    }

    fn counts(name: &'static str, values: impl Iterator<Item = usize>) -> Data {
        let bytes = values.flat_map(|value| (value as u64).to_le_bytes()).collect();
        Data { name, kind: "UInt64", components: 1, bytes }
    }
}

/// Writes quadrilaterals with data at their points.
pub fn write(path: &Path, points: &[[f64; 2]], cells: &[[usize; 4]], data: &[Data]) -> io::Result<()> {
    let places = [Data::vector("points", points)];
    let kinds = Data { name: "types", kind: "UInt8", components: 1, bytes: vec![QUAD; cells.len()] };
    let corners = cells.iter().flatten().copied();
    let shape =
        [Data::counts("connectivity", corners), Data::counts("offsets", (1..=cells.len()).map(|i| 4 * i)), kinds];
    let [count, number] = [points.len(), cells.len()];
    let mut text = format!(
        "<VTKFile type=\"UnstructuredGrid\" {HEAD}>\n<UnstructuredGrid>\n\
         <Piece NumberOfPoints=\"{count}\" NumberOfCells=\"{number}\">\n"
    );
    let mut raw: Vec<u8> = Vec::new();
    for (part, arrays) in [("PointData", data), ("Points", &places), ("Cells", &shape)] {
        let _ = writeln!(text, "<{part}>");
        for Data { name, kind, components, bytes } in arrays {
            let _ = writeln!(
                text,
                "<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{components}\" format=\"appended\" offset=\"{}\"/>",
                raw.len()
            );
            raw.extend((bytes.len() as u64).to_le_bytes());
            raw.extend(bytes);
        }
        let _ = writeln!(text, "</{part}>");
    }
    text += "</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_";
    fs::write(path, [text.as_bytes(), &raw, b"\n</AppendedData>\n</VTKFile>\n"].concat())
}

/// Writes an index of a series: at each time \[s] several files, each a part under its number.
pub fn write_index(path: &Path, frames: &[(f64, Vec<String>)]) -> io::Result<()> {
    let mut text = format!("<VTKFile type=\"Collection\" {HEAD}>\n<Collection>\n");
    for (time, files) in frames {
        for (part, file) in files.iter().enumerate() {
            let _ = writeln!(text, "<DataSet timestep=\"{time:?}\" group=\"\" part=\"{part}\" file=\"{file}\"/>");
        }
    }
    fs::write(path, text + "</Collection>\n</VTKFile>\n")
}
