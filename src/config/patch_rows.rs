//! Rows of a patch that is no ellipse, as the text of `contact.rows`.

use crate::patch::rows::{self, EquivalentEllipse, PatchRow};

/// End of a text that names a file.
const FILE: &str = ".csv";
/// Columns, in metres and as shares.
const COLUMNS: [&str; 3] = ["position", "half_length", "load_share"];
/// Largest distance from the middle and largest half-length [m].
const LARGEST: [f64; 2] = [0.5, 0.1];
/// Largest number of rows.
const MOST_ROWS: usize = 1000;

/// Rows without meaning.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum RowsError {
    /// Too few or too many of them.
    #[error(
        "contact.rows has {0} rows, but contact.shape = rows needs 2 to {MOST_ROWS}: the name of a {FILE} file or a text with the \
         columns position,half_length,load_share, rows separated by ; or new lines"
    )]
    Count(usize),
    /// A text that is no table.
    #[error("contact.rows, line {line}: {problem}")]
    Text {
        /// Line of the text, from 1.
        line: u64,
        /// Problem and remedy.
        problem: String,
    },
    /// A file that nobody has read yet.
    #[error("contact.rows: file {0} has not been read; give its content")]
    Unread(String),
    /// A file that cannot be read.
    #[error(
        "contact.rows: file {path} cannot be read ({reason}); looked for {tried}; give a path that is absolute or relative \
         to the working directory"
    )]
    Unreadable {
        /// File that is there, or the name of one that is not.
        path: String,
        /// Reason.
        reason: String,
        /// Places where it was looked for.
        tried: String,
    },
}

/// Patch that is described by rows side by side.
#[derive(Clone, Debug, PartialEq)]
pub struct PatchRows {
    /// The rows, at ascending positions.
    pub rows: Vec<PatchRow>,
    /// Ellipse with their second moments of area.
    pub shape: EquivalentEllipse,
}

/// True if a text names a file.
pub fn is_file(text: &str) -> bool {
    text.trim().ends_with(FILE)
}

impl PatchRows {
    /// Reads rows that together carry `load` \[N]: a table with the columns `position` and `half_length` \[m] and
    /// `load_share`, any measure of the load of a row; only its ratios count. Rows touch: each reaches halfway to its
    /// neighbours.
    ///
    /// # Errors
    /// Tables without meaning: the error names line, column, value, allowed range and what to do.
    pub fn parse(text: &str, load: f64) -> Result<Self, RowsError> {
        let table = text.replace(';', "\n");
        let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).flexible(true).from_reader(table.as_bytes());
        let header = reader.headers().map_err(|error| wrong(1, error.to_string()))?.clone();
        if header.is_empty() {
            return Err(RowsError::Count(0));
        }
        let mut columns = [0; 3];
        for (column, name) in columns.iter_mut().zip(COLUMNS) {
            let found = header.iter().position(|given| given.trim_start_matches('\u{feff}') == name);
            let given = header.iter().collect::<Vec<_>>().join(",");
            let problem = || format!("column {name} is missing; the header must be {}, not {given}", COLUMNS.join(","));
            *column = found.ok_or_else(|| wrong(1, problem()))?;
        }
        let mut given: Vec<[f64; 3]> = Vec::new();
        for record in reader.records() {
            let record =
                record.map_err(|error| wrong(error.position().map_or(0, csv::Position::line), error.to_string()))?;
            let before = given.last().map(|row| row[0]);
            let row = row(&record, columns, before);
            given.push(row.map_err(|problem| wrong(record.position().map_or(0, csv::Position::line), problem))?);
        }
        Self::new(&given, load)
    }

    fn new(given: &[[f64; 3]], load: f64) -> Result<Self, RowsError> {
        let positions: Vec<f64> = given.iter().map(|row| row[0]).collect();
        let sum: f64 = given.iter().map(|row| row[2]).sum();
        let row = |(&[position, half_length, share], width): (&[f64; 3], f64)| PatchRow {
            position,
            width,
            half_length,
            line_load: load * share / (sum * width),
        };
        let rows: Vec<_> = given.iter().zip(rows::widths(&positions)).map(row).collect();
        let shape = rows::equivalent_ellipse(&rows).filter(|_| (2..=MOST_ROWS).contains(&rows.len()));
        shape.map(|shape| Self { rows, shape }).ok_or(RowsError::Count(given.len()))
    }

    /// Width of all rows \[m].
    pub fn width(&self) -> f64 {
        self.rows.iter().map(|row| row.width).sum()
    }

    /// Largest half-length of a row \[m].
    pub fn half_length(&self) -> f64 {
        self.rows.iter().fold(0.0, |longest: f64, row| longest.max(row.half_length))
    }
}

fn wrong(line: u64, problem: String) -> RowsError {
    RowsError::Text { line, problem }
}

/// Position, half-length and load share of a record behind the position `before`; the error is problem and remedy.
fn row(record: &csv::StringRecord, columns: [usize; 3], before: Option<f64>) -> Result<[f64; 3], String> {
    let mut numbers = [0.0; 3];
    for ((number, column), name) in numbers.iter_mut().zip(columns).zip(COLUMNS) {
        let given = record.get(column).unwrap_or_default();
        let finite = given.parse().ok().filter(|value: &f64| value.is_finite());
        *number =
            finite.ok_or_else(|| format!("{name} = {given:?} is no finite number; correct or leave out the line"))?;
    }
    let [position, half_length, share] = numbers;
    let [farthest, longest] = LARGEST;
    if position.abs() > farthest {
        return Err(format!("position = {position} m is outside -{farthest} to {farthest} m; columns are in metres"));
    }
    if !(half_length > 0.0 && half_length <= longest) {
        return Err(format!(
            "half_length = {half_length} m is outside 0 (excluded) to {longest} m; columns are in metres, and rows without \
             contact are left out"
        ));
    }
    if share <= 0.0 {
        return Err(format!("load_share = {share} must be positive; leave out rows without load"));
    }
    match before.filter(|before| *before >= position) {
        Some(before) => {
            Err(format!("position = {position} m must be larger than {before} m before it; sort the lines"))
        }
        None => Ok(numbers),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_on_lines_or_between_semicolons_share_the_load_by_their_ratios() {
        let found = PatchRows::parse("position, half_length, load_share; -1e-3, 4e-3, 3; 1e-3, 5e-3, 1", 8e4).unwrap();
        let expected = [
            PatchRow { position: -1e-3, width: 2e-3, half_length: 4e-3, line_load: 3e7 },
            PatchRow { position: 1e-3, width: 2e-3, half_length: 5e-3, line_load: 1e7 },
        ];
        assert_eq!(found.rows, expected);
        assert_eq!((found.width(), found.half_length()), (4e-3, 5e-3));
        let lines = "\u{feff}load_share,unused,position,half_length\n3,,-1e-3,4e-3\n1,,1e-3,5e-3\n";
        assert_eq!(PatchRows::parse(lines, 8e4), Ok(found));
    }

    #[test]
    fn refusals_name_line_column_value_and_remedy() {
        let head = "position,half_length,load_share\n";
        for (text, words) in [
            (String::new(), &["0 rows", "needs 2 to 1000", "position,half_length,load_share"][..]),
            (format!("{head}0,5e-3,1"), &["1 rows", "needs 2"]),
            ("position,length,load_share\n0,1,1".to_owned(), &["line 1", "half_length is missing"]),
            (format!("{head}0,5e-3,1\n1e-3,long,1"), &["line 3", "half_length = \"long\"", "finite"]),
            (format!("{head}0,5e-3,1\n1e-3,5e-3"), &["line 3", "load_share = \"\""]),
            (format!("{head}0,5e-3,1\n0,5e-3,1"), &["line 3", "position = 0 m", "sort"]),
            (format!("{head}0,5,1"), &["line 2", "half_length = 5 m", "in metres"]),
            (format!("{head}-10,5e-3,1"), &["line 2", "position = -10 m", "in metres"]),
            (format!("{head}0,0,1"), &["line 2", "half_length = 0 m", "left out"]),
            (format!("{head}0,5e-3,-1"), &["line 2", "load_share = -1", "positive"]),
        ] {
            let message = PatchRows::parse(&text, 1e5).unwrap_err().to_string();
            assert!(words.iter().all(|word| message.contains(word)), "{message}");
        }
        let many: String = (0..1001).map(|i| format!("{:e},1e-3,1\n", 1e-5 * f64::from(i))).collect();
        assert_eq!(PatchRows::parse(&format!("{head}{many}"), 1e5), Err(RowsError::Count(1001)));
    }
}
