//! Inputs over time from a CSV file.

use super::Failure;
use super::setting::{find, parse};
use super::track::{Heights, bend};
use std::path::Path;
use wheelrail::config::display_number;
use wheelrail::files;
use wheelrail::files::table::{Table, TableError, comma};
use wheelrail::fmi::variable::{Causality, Kind, Value, Variable};
use wheelrail::piecewise::{between, straight};

/// Shorter times than this are rounding [s].
const ROUNDING: f64 = 1e-9;
/// Steps are divided into no shorter ones than this [s].
const SHORTEST: f64 = 1e-6;
/// Share of its largest value by which a value may be off the line that takes its place.
const SEEN: f64 = 1e-6;
/// Latest time \[s]: a later one is a date, or counts something else than seconds.
const LATEST: f64 = 1e8;
/// Inputs that move to their value at the end of a step: their mean over it has no meaning.
const MOTIONS: [&str; 6] =
    ["drive.omega", "drive.velocity", "drive.displacement", "drive.lateral_velocity", HEIGHT, RATE];
/// The height of the rail, which is smooth between rows.
const HEIGHT: &str = "rail.elevation";
/// Its rate at the end of a step.
pub const RATE: &str = "rail.elevation_rate";
/// Share of the largest height by which a row may be off the cubic that the FMU follows.
const UNEVEN: f64 = 1e-2;

/// Values of inputs at given times. Real inputs are linear between rows, the height of the rail is smooth, choices hold
/// until the next row; before the first and after the last row everything is held. Two rows at the same time make a jump.
pub struct Scenario {
    /// Ascending [s].
    times: Vec<f64>,
    columns: Vec<Column>,
    /// Times at which a number jumps or a choice changes, ascending [s].
    jumps: Vec<f64>,
    /// The height of the rail, if it has a column.
    heights: Option<Heights>,
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
        Scenario::parse(&text).map_err(|error| wrong(error.to_string()))
    }

    /// Reads CSV text; an error says what is wrong in it.
    fn parse(text: &str) -> Result<Scenario, TableError> {
        let table = Table::read(text)?;
        let (names, header) = table.names();
        let at_header = |why: String| TableError::new(header, why);
        let time = table.column("time").ok_or_else(|| at_header("no column time".to_owned()))?;
        let mut columns = columns(names, time).map_err(at_header)?;
        let mut times: Vec<f64> = Vec::new();
        for row in table.rows() {
            let row = row?;
            let refused = |text: &str, why: String| {
                let advice = comma(text).map_or_else(String::new, |advice| format!("; {advice}"));
                TableError::new(row.line, why + &advice)
            };
            let text = row.text(time);
            times.push(next_time(text, times.last().copied()).map_err(|why| refused(text, why))?);
            for (index, column) in &mut columns {
                let text = row.text(*index);
                match (&mut column.values, parse(column.variable, text).map_err(|why| refused(text, why))?) {
                    (Values::Real(values), Value::Real(value)) => values.push(value),
                    (Values::Choice(values), Value::Integer(value)) => values.push(value),
                    _ => return Err(refused(text, format!("{} is no input", column.variable.name))),
                }
            }
        }
        if times.is_empty() {
            return Err(at_header("no rows follow".to_owned()));
        }
        let columns: Vec<_> = columns.into_iter().map(|(_, column)| column).collect();
        let jumps = jumps(&times, &columns);
        let heights =
            columns.iter().find(|column| column.variable.name == HEIGHT).and_then(|column| match &column.values {
                Values::Real(values) => Some(Heights::new(&times, values)),
                Values::Choice(_) => None,
            });
        Ok(Scenario { times, columns, jumps, heights })
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
        between(&self.times, values, time, self.rows_until(time))
    }

    /// Value at a time; at a jump that before it.
    pub fn before(&self, values: &[f64], time: f64) -> f64 {
        between(&self.times, values, time, self.rows_before(time))
    }

    /// Number of rows up to a time.
    fn rows_until(&self, time: f64) -> usize {
        self.times.partition_point(|&t| t <= time + ROUNDING)
    }

    /// Number of rows before a time.
    fn rows_before(&self, time: f64) -> usize {
        self.times.partition_point(|&t| t < time - ROUNDING)
    }

    /// Rate of the height of the rail up to a time [m/s]; `None` where no column has heights, or one has rates.
    pub fn elevation_rate(&self, time: f64) -> Option<f64> {
        let given = self.columns.iter().any(|column| column.variable.name == RATE);
        self.heights.as_ref().filter(|_| !given).map(|heights| heights.at(time, self.rows_before(time))[1])
    }

    /// Ends of the parts into which a step from `begin` to `end` [s] is divided at jumps, `end` the last one. What jumps
    /// closer to another end than [`SHORTEST`] stays within its part.
    pub fn parts(&self, begin: f64, end: f64) -> Vec<f64> {
        let (mut last, mut ends) = (begin, Vec::new());
        let first = self.jumps.partition_point(|&jump| jump <= begin);
        for &jump in self.jumps[first..].iter().take_while(|jump| **jump < end - SHORTEST) {
            if jump > last + SHORTEST {
                ends.push(jump);
                last = jump;
            }
        }
        ends.push(end);
        ends
    }

    /// Values at the beginning and the end [s] of a part of a step between which an input is straight: those that it
    /// has there, or where it varies within the part, of a line with the same mean and the same first moment.
    pub fn line(&self, column: &Column, values: &[f64], begin: f64, end: f64) -> [f64; 2] {
        if let (HEIGHT, Some(heights)) = (column.variable.name, &self.heights) {
            return [heights.at(begin, self.rows_until(begin))[0], heights.at(end, self.rows_before(end))[0]];
        }
        let ends = [self.after(values, begin), self.before(values, end)];
        let within = self.rows_until(begin)..self.rows_before(end);
        if within.is_empty() || MOTIONS.contains(&column.variable.name) {
            return ends;
        }
        let mut points = vec![[0.0, ends[0]]];
        points.extend(within.map(|row| [self.times[row] - begin, values[row]]));
        points.push([end - begin, ends[1]]);
        straight(&points)
    }

    /// Warnings of what a run from 0 to `stop` in steps of `step` [s] does not see.
    pub fn unseen(&self, stop: f64, step: f64) -> Vec<String> {
        let mut texts = Vec::new();
        let [first, last] = [self.times[0], self.end()].map(display_number);
        if self.times[0] > stop || (self.end() < 0.0 && stop > 0.0) {
            texts.push(format!(
                "scenario: its times from {first} to {last} s lie outside of the run from 0 to {} s, in which inputs hold",
                display_number(stop)
            ));
        }
        for column in &self.columns {
            let Values::Real(values) = &column.values else { continue };
            let hidden =
                if MOTIONS.contains(&column.variable.name) { self.hidden(column, values, stop, step) } else { 0 };
            if hidden > 0 {
                texts.push(format!(
                    "{}: {hidden} of {} rows lie within communication steps of {} s and off the line through the ends of \
                     their step, and are not seen; take a shorter --step",
                    column.variable.name,
                    values.len(),
                    display_number(step)
                ));
            }
        }
        texts
    }

    /// Number of values within steps that are off the straight line through the ends of their step, heights off the cubic.
    fn hidden(&self, column: &Column, values: &[f64], stop: f64, step: f64) -> usize {
        let size = values.iter().fold(0.0, |size: f64, value| size.max(value.abs()));
        let heights = self.heights.as_ref().filter(|_| column.variable.name == HEIGHT);
        let may = if heights.is_some() { UNEVEN } else { SEEN };
        let off = |(&time, &value): (&f64, &f64)| {
            let begin = step * ((time + ROUNDING) / step).floor();
            let end = (begin + step).min(stop);
            let inside = time > begin + ROUNDING && time < end - ROUNDING;
            let [from, to] = self.line(column, values, begin, end);
            let bent = heights.map_or(0.0, |heights| {
                let rates = [begin, end].map(|at| heights.at(at, self.rows_before(at))[1]);
                bend([(to - from) / (end - begin), rates[0], rates[1]], (time - begin) / (end - begin)) * (end - begin)
            });
            let line = from + (to - from) * (time - begin) / (end - begin);
            inside && time > 0.0 && (line + bent - value).abs() > may * size
        };
        self.times.iter().zip(values).filter(|row| off(*row)).count()
    }

    /// Choice that holds from a time on.
    pub fn choice(&self, values: &[i32], time: f64) -> i32 {
        values[self.times.partition_point(|&t| t <= time + ROUNDING).max(1) - 1]
    }
}

/// Empty columns for the names besides `time`, with their positions.
fn columns(names: &[&str], time: usize) -> Result<Vec<(usize, Column)>, String> {
    let others = names.iter().enumerate().filter(|(index, _)| *index != time);
    let column = |(index, name): (usize, &&str)| {
        let input = |v: &Variable| v.causality() == Causality::Input;
        let variable =
            find(name, input).map_err(|why| format!("column {}: {why} (columns are time and inputs)", index + 1))?;
        let real = matches!(variable.kind, Kind::Real { .. });
        let values = if real { Values::Real(Vec::new()) } else { Values::Choice(Vec::new()) };
        Ok((index, Column { variable, values }))
    };
    others.map(column).collect()
}

/// Times at which a number jumps or a choice changes [s].
fn jumps(times: &[f64], columns: &[Column]) -> Vec<f64> {
    let jumps = |row: usize| {
        columns.iter().any(|column| match &column.values {
            Values::Real(values) => times[row] == times[row - 1] && values[row] != values[row - 1],
            Values::Choice(values) => values[row] != values[row - 1],
        })
    };
    let mut found: Vec<_> = (1..times.len()).filter(|&row| jumps(row)).map(|row| times[row]).collect();
    found.dedup();
    found
}

/// Time of a row [s], not before that of the row above.
fn next_time(text: &str, before: Option<f64>) -> Result<f64, String> {
    let now: f64 = text.parse().unwrap_or(f64::NAN);
    if now.abs() <= LATEST && before.is_none_or(|before| now >= before) {
        return Ok(now);
    }
    let least = before.map_or_else(String::new, |t| format!("at least {} s, ", display_number(t)));
    Err(format!("time = \"{text}\" is outside its range: {least}at most {LATEST:e} s; times are seconds of the run"))
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
            if let Err(why) = Scenario::parse(&String::from_utf8_lossy(&bytes)) {
                prop_assert!(!why.problem.is_empty());
            }
        }

        #[test]
        fn what_is_nearly_a_scenario_is_refused_by_line_or_column_or_can_be_evaluated(text in nearly()) {
            match Scenario::parse(&text) {
                Ok(scenario) => {
                    for column in scenario.columns() {
                        let Values::Real(values) = &column.values else { continue };
                        for time in [-1.0, 0.0, scenario.end(), 1e300] {
                            prop_assert!(scenario.before(values, time) >= 0.0 && scenario.after(values, time) <= 1e9);
                        }
                    }
                }
                Err(why) => prop_assert!(why.line > 0, "{why}"),
            }
        }

        #[test]
        fn a_printed_scenario_reads_back(loads in prop::collection::vec(0.0..1e9_f64, 1..20)) {
            let rows: Vec<_> = loads.iter().enumerate().map(|(time, load)| format!("{time},{load:?}")).collect();
            let scenario = Scenario::parse(&format!("time,drive.load\n{}\n", rows.join("\n"))).unwrap();
            let Values::Real(read) = &scenario.columns()[0].values else { panic!("a real input") };
            prop_assert_eq!(read, &loads);
        }
    }

    /// Reads a scenario from text; the message of the refusal.
    fn scenario(text: &str) -> Result<Scenario, String> {
        Scenario::parse(text).map_err(|error| error.to_string())
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
    fn a_jump_at_any_whole_millisecond_acts_at_its_time_for_every_step() {
        for (jump, step) in (1..=200).flat_map(|k| [5e-4, 1e-3, 2e-3, 1e-2, 0.1].map(|step| (f64::from(k) / 1e3, step)))
        {
            let s = scenario(&format!("time,drive.force\n0,0\n{jump:?},0\n{jump:?},5e4\n1,5e4\n")).unwrap();
            let Values::Real(force) = &s.columns()[0].values else { panic!("a real input") };
            for k in 0..(0.3 / step) as usize {
                let mut begin = k as f64 * step;
                for end in s.parts(begin, begin + step) {
                    let expected = if begin > jump - 1e-9 { 5e4 } else { 0.0 };
                    assert_eq!(s.line(&s.columns()[0], force, begin, end), [expected; 2], "{jump} in {step}, {begin}");
                    begin = end;
                }
            }
        }
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
            ("time,drive.load\n0\n", &["line 2", "1 cell, but line 1 names 2 columns"]),
            ("time,drive.load\n0,1,5\n", &["line 2", "3 cells", "decimal points"]),
            ("time,drive.load\n\"0,5\",1\n", &["line 2", "time = \"0,5\"", "a decimal point"]),
            ("time,drive.load\n0,\"1,5\"\n", &["line 2", "drive.load = \"1,5\"", "a decimal point"]),
            ("time;drive.load\n0;1\n", &["line 1", "semicolons"]),
            ("time,drive.load\n1700000000,1\n", &["line 2", "at most 1e8 s", "seconds of the run"]),
            ("time,drive.load\n", &["no rows"]),
            ("time,drive.load,drive.load\n0,1,1\n", &["two columns drive.load"]),
        ] {
            let message = scenario(text).err().unwrap();
            assert!(words.iter().all(|word| message.contains(word)), "{message}");
        }
    }
}
