//! Values of variables as CSV and as text for people.

use super::Failure;
use super::setup::failed;
use std::io::{self, Write};
use std::path::Path;
use wheelrail::files::NewFile;
use wheelrail::fmi::instance::Instance;
use wheelrail::fmi::units::UNITS;
use wheelrail::fmi::v2::access::type_of;
use wheelrail::fmi::variable::{Kind, Value, Variable};
use wheelrail_slave::Type;

/// Values of variables, in their order.
pub fn read(instance: &mut Instance, variables: &[&Variable]) -> Result<Vec<Value>, Failure> {
    let mut values = vec![None; variables.len()];
    for wanted in Type::ALL {
        let of_type: Vec<usize> = (0..variables.len()).filter(|&i| type_of(variables[i].kind) == wanted).collect();
        let references: Vec<_> = of_type.iter().map(|&i| variables[i].reference).collect();
        for (i, value) in of_type.into_iter().zip(instance.get(&references, wanted).map_err(failed)?) {
            values[i] = Some(value);
        }
    }
    Ok(values.into_iter().flatten().collect())
}

/// Place of results: a file that is moved to its place at the end, or standard output.
enum Sink {
    File(NewFile),
    Standard(io::StdoutLock<'static>),
}

impl Write for Sink {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match self {
            Sink::File(file) => file.write(bytes),
            Sink::Standard(output) => output.write(bytes),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match self {
            Sink::File(file) => file.flush(),
            Sink::Standard(output) => output.flush(),
        }
    }
}

/// A CSV file, or standard output, with a header of names. Numbers read back exactly.
pub struct Csv(csv::Writer<Sink>);

impl Csv {
    /// A new file, or standard output where no path is given.
    pub fn create(out: Option<&Path>) -> Result<Csv, Failure> {
        let sink = match out {
            Some(path) => Sink::File(create(path)?),
            None => Sink::Standard(io::stdout().lock()),
        };
        Ok(Csv(csv::Writer::from_writer(sink)))
    }

    /// The first row.
    pub fn header<'a>(&mut self, names: impl IntoIterator<Item = &'a str>) -> Result<(), Failure> {
        Ok(self.0.write_record(names)?)
    }

    /// One row, behind a first cell if there is one.
    pub fn row(&mut self, first: Option<f64>, variables: &[&Variable], values: &[Value]) -> Result<(), Failure> {
        let first = first.map(|number| format!("{number:?}"));
        let cells = variables.iter().zip(values).map(|(variable, value)| variable.kind.print(value));
        Ok(self.0.write_record(first.into_iter().chain(cells))?)
    }

    /// Writes what is still buffered, and puts a file in its place.
    pub fn finish(self) -> Result<(), Failure> {
        match self.0.into_inner().map_err(csv::IntoInnerError::into_error)? {
            Sink::File(file) => Ok(file.finish()?),
            Sink::Standard(mut output) => Ok(output.flush()?),
        }
    }
}

/// Writes the columns of a file over time: name, SI unit and meaning, the time first.
pub fn write_columns(path: &Path, variables: &[&Variable]) -> Result<(), Failure> {
    let mut rows = csv::Writer::from_writer(Sink::File(create(path)?));
    rows.write_record(["column", "unit", "description"])?;
    rows.write_record(["time", "s", "Time"])?;
    for variable in variables {
        let unit = if let Kind::Real { measure, .. } = variable.kind { measure.unit } else { "" };
        rows.write_record([variable.name, unit, variable.description])?;
    }
    Csv(rows).finish()
}

/// A new file; its directory is made if it is missing.
pub fn create(path: &Path) -> Result<NewFile, Failure> {
    if let Some(parent) = path.parent() {
        let failed = |error| Failure::Run(format!("{} cannot be written: {error}", path.display()));
        std::fs::create_dir_all(parent).map_err(failed)?;
    }
    Ok(NewFile::create(path)?)
}

/// Unit for people.
pub fn unit(variable: &Variable) -> &'static str {
    match variable.kind {
        Kind::Real { measure, .. } => measure.display.unwrap_or(measure.unit),
        _ => "",
    }
}

/// Value in the unit for people.
pub fn shown(variable: &Variable, value: &Value) -> String {
    match (variable.kind, value) {
        (Kind::Real { measure, .. }, Value::Real(v)) => {
            let displays = UNITS.iter().find(|unit| unit.name == measure.unit).map_or(&[][..], |unit| unit.displays);
            let display = displays.iter().find(|display| Some(display.name) == measure.display);
            significant(display.map_or(*v, |display| display.factor * v + display.offset))
        }
        _ => variable.kind.print(value),
    }
}

/// A number with four significant digits.
pub fn significant(value: f64) -> String {
    let text = format!("{value:.3e}");
    let exponent = text.rsplit('e').next().and_then(|e| e.parse::<i32>().ok()).unwrap_or(0);
    match exponent {
        0 if value == 0.0 => "0".to_owned(),
        -3..6 => format!("{value:.*}", usize::try_from(3 - exponent).unwrap_or(0)),
        _ => text,
    }
}

#[cfg(test)]
mod tests {
    use super::super::setting::find;
    use super::*;

    #[test]
    fn numbers_for_people_have_four_digits() {
        let shown: Vec<_> =
            [0.0, 1.0, 99.99999, -27.77777, 12345.6, 0.00123456, 1.5e-4, 7.25e6].map(significant).into();
        assert_eq!(shown, ["0", "1.000", "100.0", "-27.78", "12346", "0.001235", "1.500e-4", "7.250e6"]);
    }

    #[test]
    fn values_for_people_are_in_display_units() {
        for (name, value, text) in
            [("temperature.wheel_max", 373.15, "100.0 degC"), ("contact.half_width", 7.5e-3, "7.500 mm")]
        {
            let variable = find(name, |_| true).unwrap();
            assert_eq!(format!("{} {}", shown(variable, &Value::Real(value)), unit(variable)), text);
        }
    }
}
