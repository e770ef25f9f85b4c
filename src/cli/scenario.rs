//! Inputs over time from a CSV file.

use super::Failure;
use super::setting::{find, parse};
use std::io::Read;
use std::path::Path;
use wheelrail::config::display_number;
use wheelrail::files;
use wheelrail::fmi::variable::{Causality, Kind, Value, Variable};
use wheelrail::piecewise::between;

/// Shorter times than this are rounding [s].
const ROUNDING: f64 = 1e-10;

/// Values of inputs at given times. Real inputs are linear between rows, choices hold until the next row; before the
/// first and after the last row everything is held. Two rows at the same time make a jump.
pub struct Scenario {
    /// Ascending [s].
    times: Vec<f64>,
    columns: Vec<Column>,
}

/// One input.
pub struct Column {
    /// Its row in the table of variables.
    pub variable: &'static Variable,
    /// Its values at the times of the scenario.
    pub values: Values,
}

/// One value per row.
pub enum Values {
    /// Numbers in SI units.
    Real(Vec<f64>),
    /// Numbers of items of an enumeration.
    Choice(Vec<i32>),
}

impl Scenario {
    /// Reads a file with the column `time` [s] and columns named after inputs.
    pub fn read(path: &Path) -> Result<Scenario, Failure> {
        let wrong = |why: String| Failure::Usage(format!("scenario {}: {why}", path.display()));
        let text = files::read_text(path).map_err(|error| wrong(error.to_string()))?;
        Scenario::parse(text.as_bytes()).map_err(wrong)
    }

    /// Reads CSV text; an error says what is wrong in it.
    fn parse(text: impl Read) -> Result<Scenario, String> {
        let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).comment(Some(b'#')).from_reader(text);
        let header = reader.headers().map_err(|error| error.to_string())?.clone();
        let time = header.iter().position(|name| name == "time").ok_or("has no column time")?;
        let mut columns = columns(&header, time)?;
        let mut times: Vec<f64> = Vec::new();
        for row in reader.records() {
            let row = row.map_err(|error| error.to_string())?;
            let line = row.position().map_or(0, csv::Position::line);
            let at_line = |why: String| format!("line {line}: {why}");
            times.push(next_time(&row[time], times.last().copied()).map_err(at_line)?);
            for (index, column) in &mut columns {
                match (&mut column.values, parse(column.variable, &row[*index]).map_err(at_line)?) {
                    (Values::Real(values), Value::Real(value)) => values.push(value),
                    (Values::Choice(values), Value::Integer(value)) => values.push(value),
                    _ => return Err(at_line(format!("{} is no input", column.variable.name))),
                }
            }
        }
        if times.is_empty() {
            return Err("has no rows".to_owned());
        }
        Ok(Scenario { times, columns: columns.into_iter().map(|(_, column)| column).collect() })
    }

    /// Time of the last row [s].
    pub fn end(&self) -> f64 {
        self.times.last().copied().unwrap_or(0.0)
    }

    /// The inputs that it prescribes.
    pub fn columns(&self) -> &[Column] {
        &self.columns
    }

    /// Value at a time; at a jump that after it.
    pub fn after(&self, values: &[f64], time: f64) -> f64 {
        between(&self.times, values, time, self.times.partition_point(|&t| t <= time + ROUNDING))
    }

    /// Value at a time; at a jump that before it.
    pub fn before(&self, values: &[f64], time: f64) -> f64 {
        between(&self.times, values, time, self.times.partition_point(|&t| t < time - ROUNDING))
    }

    /// Choice that holds from a time on.
    pub fn choice(&self, values: &[i32], time: f64) -> i32 {
        values[self.times.partition_point(|&t| t <= time + ROUNDING).max(1) - 1]
    }
}

/// Empty columns for the names besides `time`, with their positions.
fn columns(header: &csv::StringRecord, time: usize) -> Result<Vec<(usize, Column)>, String> {
    let mut columns: Vec<(usize, Column)> = Vec::new();
    for (index, name) in header.iter().enumerate().filter(|(index, _)| *index != time) {
        let input = |v: &Variable| v.causality() == Causality::Input;
        let variable =
            find(name, input).map_err(|why| format!("column {}: {why} (columns are time and inputs)", index + 1))?;
        if columns.iter().any(|(_, column)| column.variable.name == name) {
            return Err(format!("has two columns {name}"));
        }
        let real = matches!(variable.kind, Kind::Real { .. });
        let values = if real { Values::Real(Vec::new()) } else { Values::Choice(Vec::new()) };
        columns.push((index, Column { variable, values }));
    }
    Ok(columns)
}

/// Time of a row [s], not before that of the row above.
fn next_time(text: &str, before: Option<f64>) -> Result<f64, String> {
    let now: f64 = text.parse().unwrap_or(f64::NAN);
    if now.is_finite() && before.is_none_or(|before| now >= before) {
        return Ok(now);
    }
    let range = before.map_or_else(|| "finite numbers".to_owned(), |t| format!("at least {} s", display_number(t)));
    Err(format!("time = \"{text}\" is outside its range: {range}"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Text that is nearly a scenario: cells from words that occur in one and others that should not.
    fn nearly() -> impl Strategy<Value = String> {
        let cell = prop_oneof![
            Just("time".to_owned()),
            Just("drive.load".to_owned()),
            Just("control.rotation".to_owned()),
            Just("moment".to_owned()),
            Just("\"".to_owned()),
            any::<f64>().prop_map(|number| number.to_string()),
            (0u8..4).prop_map(|number| number.to_string()),
            ".{0,6}",
        ];
        let line = prop::collection::vec(cell, 0..4).prop_map(|cells| cells.join(","));
        prop::collection::vec(line, 0..5).prop_map(|lines| format!("time,drive.load\n{}", lines.join("\n")))
    }

    proptest! {
        #[test]
        fn any_bytes_are_a_scenario_or_refused_with_a_reason(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
            if let Err(why) = Scenario::parse(bytes.as_slice()) {
                prop_assert!(!why.is_empty());
            }
        }

        #[test]
        fn what_is_nearly_a_scenario_is_refused_by_line_or_column_or_can_be_evaluated(text in nearly()) {
            match Scenario::parse(text.as_bytes()) {
                Ok(scenario) => {
                    for column in scenario.columns() {
                        let Values::Real(values) = &column.values else { continue };
                        for time in [-1.0, 0.0, scenario.end(), 1e300] {
                            prop_assert!(scenario.before(values, time) >= 0.0 && scenario.after(values, time) <= 1e9);
                        }
                    }
                }
                Err(why) => prop_assert!(["line", "column", "no rows", "UTF-8"].iter().any(|word| why.contains(word)), "{why}"),
            }
        }

        #[test]
        fn a_printed_scenario_reads_back(loads in prop::collection::vec(0.0..1e9_f64, 1..20)) {
            let rows: Vec<_> = loads.iter().enumerate().map(|(time, load)| format!("{time},{load:?}")).collect();
            let scenario = Scenario::parse(format!("time,drive.load\n{}\n", rows.join("\n")).as_bytes()).unwrap();
            let Values::Real(read) = &scenario.columns()[0].values else { panic!("a real input") };
            prop_assert_eq!(read, &loads);
        }
    }

    /// Reads a scenario from text; the message of the refusal.
    fn scenario(text: &str) -> Result<Scenario, String> {
        Scenario::parse(text.as_bytes())
    }

    #[test]
    fn reals_are_linear_between_rows_held_outside_and_jump_at_double_rows() {
        let s = scenario("time, drive.moment\n1,0\n2,100\n2,50\n3,50\n").unwrap();
        let Values::Real(m) = &s.columns()[0].values else { panic!("a real input") };
        let after: Vec<f64> = [0.0, 1.0, 1.25, 2.0, 2.5, 9.0].iter().map(|&t| s.after(m, t)).collect();
        assert_eq!(after, [0.0, 0.0, 25.0, 50.0, 50.0, 50.0]);
        let before: Vec<f64> = [0.0, 1.25, 2.0, 3.0].iter().map(|&t| s.before(m, t)).collect();
        assert_eq!(before, [0.0, 25.0, 100.0, 50.0]);
        // A communication point that rounding has moved past or before the row is that of the row.
        assert_eq!((s.after(m, 2.0 - 1e-13), s.before(m, 2.0 + 1e-13)), (50.0, 100.0));
        assert_eq!(s.end(), 3.0);
    }

    #[test]
    fn choices_hold_until_the_next_row() {
        let s = scenario("control.rotation,time\n2,0\nvelocity,0.3\nmoment,0.5\n").unwrap();
        let Values::Choice(c) = &s.columns()[0].values else { panic!("a choice") };
        let held: Vec<i32> = [-1.0, 0.29, 3.0 * 0.1, 0.3 - 1e-13, 0.49, 7.0].iter().map(|&t| s.choice(c, t)).collect();
        assert_eq!(held, [2, 2, 1, 1, 1, 2]);
    }

    #[test]
    fn refusals_name_line_column_value_and_range() {
        for (text, words) in [
            ("t,drive.load\n0,1\n", &["no column time"][..]),
            ("time,drive.lod\n0,1\n", &["column 2", "drive.lod", "drive.load"]),
            ("time,contact.force_x\n0,1\n", &["column 2", "contact.force_x", "output"]),
            ("time,drive.load\n0,1\n2,1\n1,1\n", &["line 4", "time = \"1\"", "at least 2 s"]),
            ("time,drive.load\n0,1\n2,-1\n", &["line 3", "drive.load = -1", "0 to"]),
            ("time,drive.load\n0,\n", &["line 2", "drive.load", "a number [N]"]),
            ("time,control.vertical\n0,up\n", &["line 2", "force (1) or displacement (2)"]),
            ("time,drive.load\n0\n", &["line: 2"]),
            ("time,drive.load\n", &["no rows"]),
            ("time,drive.load,drive.load\n0,1,1\n", &["two columns drive.load"]),
        ] {
            let message = scenario(text).err().unwrap();
            assert!(words.iter().all(|word| message.contains(word)), "{message}");
        }
    }
}
