//! Tables as text (CSV): a line of names, and below it lines with one cell for each name.
//!
//! Cells are separated by commas, numbers have decimal points. Blank lines and lines that begin with `#` are skipped, a
//! mark of byte order and any ending of lines are taken, cells may stand in quotes. Everything else is refused, with
//! line and column.

/// Line of names and lines of cells.
pub struct Table<'a> {
    names: Vec<&'a str>,
    /// Line of the names, from 1.
    line: usize,
    rest: Vec<(usize, &'a str)>,
}

/// Cells of a line.
pub struct TableRow<'a> {
    /// Number of the line in the text, from 1.
    pub line: usize,
    cells: Vec<&'a str>,
}

/// A text that is no table.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("line {line}: {problem}")]
pub struct TableError {
    /// Line of the text, from 1.
    pub line: usize,
    /// Problem and remedy.
    pub problem: String,
}

impl TableError {
    /// Problem in a line.
    pub fn new(line: usize, problem: impl Into<String>) -> Self {
        Self { line, problem: problem.into() }
    }
}

impl<'a> Table<'a> {
    /// Reads the line of names.
    pub fn read(text: &'a str) -> Result<Self, TableError> {
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let mut lines = numbered(text).collect::<Vec<_>>().into_iter();
        let (line, first) = lines.next().ok_or_else(|| TableError::new(1, "no line of names of columns"))?;
        let names = cells(first).map_err(|why| TableError::new(line, why))?;
        if let [only] = names.as_slice()
            && let Some(separator) = [(';', "semicolons"), ('\t', "tabs")].iter().find(|found| only.contains(found.0))
        {
            let problem =
                format!("columns are separated by {}; write commas, and decimal points in numbers", separator.1);
            return Err(TableError::new(line, problem));
        }
        if let Some(k) = names.iter().position(|name| name.is_empty()) {
            return Err(TableError::new(line, format!("column {} has no name", k + 1)));
        }
        if let Some(name) = names.iter().enumerate().find_map(|(k, name)| names[..k].contains(name).then_some(name)) {
            let problem = match name.parse::<f64>() {
                Ok(_) => format!("{first} are no names of columns, which the first line must have"),
                Err(_) => format!("two columns {name}; leave one of them out"),
            };
            return Err(TableError::new(line, problem));
        }
        Ok(Self { names, line, rest: lines.collect() })
    }

    /// Names of the columns, and the line in which they stand.
    pub fn names(&self) -> (&[&'a str], usize) {
        (&self.names, self.line)
    }

    /// Place of a column, from 0.
    pub fn column(&self, name: &str) -> Option<usize> {
        self.names.iter().position(|found| *found == name)
    }

    /// Places of columns that must be there; `also` are those that may be.
    pub fn columns<const N: usize>(&self, needed: [&str; N], also: &[&str]) -> Result<[usize; N], TableError> {
        let mut places = [0; N];
        for (place, name) in places.iter_mut().zip(needed) {
            let problem = || {
                let may = if also.is_empty() { String::new() } else { format!(", and may have {}", also.join(",")) };
                let (needed, given) = (needed.join(","), self.names.join(","));
                format!("column {name} is missing; the line of names must be {needed}{may}, not {given}")
            };
            *place = self.column(name).ok_or_else(|| TableError::new(self.line, problem()))?;
        }
        Ok(places)
    }

    /// Rows one after the other; one with other cells than names is refused.
    pub fn rows(&self) -> impl Iterator<Item = Result<TableRow<'a>, TableError>> {
        self.rest.iter().map(move |&(line, text)| {
            let cells = cells(text).map_err(|why| TableError::new(line, why))?;
            if cells.len() == self.names.len() {
                return Ok(TableRow { line, cells });
            }
            let advice = match cells.len() > self.names.len() {
                true => "commas separate cells, numbers have decimal points: 1.5, not 1,5",
                false => "write a value for each",
            };
            let (found, wanted) = (counted(cells.len(), "cell"), counted(self.names.len(), "column"));
            Err(TableError::new(line, format!("{found}, but line {} names {wanted}; {advice}", self.line)))
        })
    }
}

impl<'a> TableRow<'a> {
    /// Text of a cell by the number of its column, from 0.
    pub fn text(&self, column: usize) -> &'a str {
        self.cells.get(column).copied().unwrap_or_default()
    }

    /// Finite number in a cell; the error names it as a quantity `name` in `unit`.
    pub fn number(&self, column: usize, name: &str, unit: &str) -> Result<f64, TableError> {
        let text = self.text(column);
        text.parse().ok().filter(|number: &f64| number.is_finite()).ok_or_else(|| {
            let advice = comma(text).unwrap_or_else(|| "correct or leave out the line".to_owned());
            TableError::new(self.line, format!("{name} = {text:?} is no finite number [{unit}]; {advice}"))
        })
    }
}

/// Advice on a cell with commas, which stand in the place of a decimal point or between thousands.
fn comma(cell: &str) -> Option<String> {
    let digits = cell.strip_prefix(['-', '+']).unwrap_or(cell);
    let sign = &cell[..cell.len() - digits.len()];
    let (whole, rest) = digits.split_once('.').map_or((digits, ""), |(whole, _)| (whole, &digits[whole.len()..]));
    let groups: Vec<&str> = whole.split(',').collect();
    let are_digits = groups.iter().all(|group| !group.is_empty() && group.bytes().all(|byte| byte.is_ascii_digit()));
    let thousands = are_digits
        && (1..=3).contains(&groups[0].len())
        && !groups[0].starts_with('0')
        && groups[1..].iter().all(|group| group.len() == 3);
    let joined = sign.to_owned() + &groups.concat() + rest;
    match groups[..] {
        [_] => None,
        [_, _] if thousands && rest.is_empty() => Some(format!(
            "write {joined} if the comma separates thousands, {sign}{} if it is a decimal comma",
            groups.join(".")
        )),
        _ if thousands => Some(format!("write {joined}: thousands are not separated")),
        _ => Some("write a decimal point in the place of the comma".to_owned()),
    }
}

/// Number of things in words.
fn counted(number: usize, thing: &str) -> String {
    format!("{number} {thing}{}", if number == 1 { "" } else { "s" })
}

/// Lines that are neither blank nor remarks, with their numbers from 1; they end with LF, CR LF or CR.
fn numbered(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let ends = move |c: char| if text.contains('\n') { c == '\n' } else { c == '\r' };
    let lines = text.split(ends).zip(1..).map(|(line, number)| (number, line.trim()));
    lines.filter(|(_, line)| !line.is_empty() && !line.starts_with('#'))
}

/// Cells of a line without the blanks and the quotes around them.
fn cells(line: &str) -> Result<Vec<&str>, &'static str> {
    let mut quoted = false;
    let cells = line.split(|c: char| {
        quoted ^= c == '"';
        c == ',' && !quoted
    });
    let bare = |cell: &str| cell.strip_prefix('"').and_then(|cell| cell.strip_suffix('"')).map(str::len);
    let cells = cells.map(str::trim).map(|cell| bare(cell).map_or(cell, |length| cell[1..=length].trim())).collect();
    if quoted { Err("a quote is not closed in this line") } else { Ok(cells) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// All numbers of a table, or what is wrong.
    fn numbers(text: &str) -> Result<Vec<Vec<f64>>, String> {
        let table = Table::read(text).map_err(|error| error.to_string())?;
        let (names, _) = table.names();
        let row = |row: TableRow| (0..names.len()).map(|k| row.number(k, names[k], "m")).collect::<Result<Vec<_>, _>>();
        table.rows().map(|found| found.and_then(row).map_err(|error| error.to_string())).collect()
    }

    #[test]
    fn marks_endings_remarks_blanks_and_quotes_do_not_change_a_table() {
        for text in [
            "a,b\n1,2\n3,4",
            "a,b\n1,2\n3,4\n\n\n",
            "\u{feff}a,b\r\n1,2\r\n3,4\r\n",
            "a,b\r1,2\r3,4\r",
            "# what it is\n\n a , b \n1,2\n# a remark, with a comma\n  \n 3 ,\t4 \n",
            "\"a\",\"b\"\n\"1\",2\n3,\" 4\"\n",
            "a,b\n+1,2.\n3e0,.4E1\n",
        ] {
            assert_eq!(numbers(text), Ok(vec![vec![1.0, 2.0], vec![3.0, 4.0]]), "{text:?}");
        }
    }

    #[test]
    fn what_is_no_table_is_refused_with_line_and_column() {
        for (text, words) in [
            ("", &["line 1", "no line of names"][..]),
            ("# only\n", &["no line of names"]),
            ("a,b\n1,0,00005\n", &["line 2", "3 cells", "line 1 names 2 columns", "decimal points"]),
            ("a,b\n\n1,2\n3\n", &["line 4", "1 cell,", "a value for each"]),
            ("a,b\n1,2,\n", &["line 2", "3 cells"]),
            ("a,b,a\n1,2,3\n", &["line 1", "two columns a"]),
            ("a,,b\n1,2,3\n", &["line 1", "column 2 has no name"]),
            ("0,0\n1,2\n", &["line 1", "0,0 are no names of columns"]),
            ("a;b\n1;2\n", &["line 1", "semicolons", "write commas"]),
            ("a;b\n1,5;2\n", &["line 1", "semicolons"]),
            ("a\tb\n1\t2\n", &["line 1", "tabs"]),
            ("a,b\n1,\"0,5\"\n", &["line 2", "b = \"0,5\"", "decimal point"]),
            (
                "a,b\n1,\"8,000\"\n",
                &["line 2", "write 8000 if the comma separates thousands, 8.000 if it is a decimal comma"],
            ),
            ("a,b\n1,\"-8,000.5\"\n", &["write -8000.5: thousands are not separated"]),
            ("a,b\n1,\"1,250,000\"\n", &["write 1250000: thousands are not separated"]),
            ("a,b\n1,\"0,375\"\n", &["write a decimal point in the place of the comma"]),
            ("a,b\n1,\"8,00\"\n", &["write a decimal point in the place of the comma"]),
            ("a,b\n1;2,3\n", &["line 2", "a = \"1;2\""]),
            ("a,b\n1,nan\n", &["line 2", "b = \"nan\" is no finite number [m]"]),
            ("a,b\n1,1_000\n", &["line 2", "b = \"1_000\""]),
            ("a,b\n1,\n", &["line 2", "b = \"\""]),
            ("a,b\n1,\"2\n3,4\n", &["line 2", "a quote is not closed"]),
        ] {
            let message = numbers(text).unwrap_err();
            println!("{message}");
            assert!(words.iter().all(|word| message.contains(word)), "{text:?}: {message}");
        }
    }
}
