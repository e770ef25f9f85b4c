//! Every number that the text of the thesis quotes, with what became of it: `thesis/quoted.toml`.

use std::collections::BTreeMap;

/// What a recomputation says about a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// Recomputed, within the tolerance of its entry.
    Agrees,
    /// Recomputed, outside of the tolerance; the note says which proof shows it.
    ThesisError,
    /// Its figure needs a value that the thesis does not state; the note says what is assumed.
    NotStated,
    /// A trend in words.
    Qualitative,
    /// Not recomputed yet.
    Open,
}

impl Status {
    /// Name in `quoted.toml`, and in the report.
    pub fn name(self) -> &'static str {
        match self {
            Self::Agrees => "agrees",
            Self::ThesisError => "thesis_error",
            Self::NotStated => "not_stated",
            Self::Qualitative => "qualitative",
            Self::Open => "open",
        }
    }
}

/// A quoted number.
#[derive(Clone, Debug)]
pub struct Quoted {
    /// Figure, table or text: `A 12`, `D 18`.
    pub item: String,
    /// What it is.
    pub quantity: String,
    /// The number, in `unit`.
    pub value: f64,
    /// Unit.
    pub unit: String,
    /// What became of it.
    pub status: Status,
    /// Name of the recomputed value, where there is one.
    pub computed: Option<String>,
    /// Largest relative difference that still agrees \[1].
    pub tolerance: Option<f64>,
    /// Proof, assumption or what is missing.
    pub note: String,
}

/// All entries of `quoted.toml`.
pub fn all() -> Result<Vec<Quoted>, String> {
    parse(include_str!("../quoted.toml"))
}

/// Reads the part of TOML that the file uses: tables `[[quoted]]` of strings and numbers, one key a line.
pub fn parse(text: &str) -> Result<Vec<Quoted>, String> {
    let mut tables: Vec<BTreeMap<&str, &str>> = Vec::new();
    for (number, line) in text.lines().map(str::trim).enumerate() {
        let wrong = || format!("line {}: {line}", number + 1);
        if line == "[[quoted]]" {
            tables.push(BTreeMap::new());
        } else if !line.is_empty() && !line.starts_with('#') {
            let (key, value) = line.split_once(" = ").ok_or_else(wrong)?;
            let before = tables.last_mut().ok_or_else(wrong)?.insert(key, value.trim_matches('"'));
            before.map_or(Ok(()), |_| Err(wrong()))?;
        }
    }
    tables.iter().map(entry).collect()
}

/// One entry from its keys.
fn entry(table: &BTreeMap<&str, &str>) -> Result<Quoted, String> {
    const KEYS: [&str; 8] = ["item", "quantity", "value", "unit", "status", "computed", "tolerance", "note"];
    let wrong = |what: &str| format!("{what} in {table:?}");
    if let Some(unknown) = table.keys().find(|key| !KEYS.contains(key)) {
        return Err(wrong(unknown));
    }
    let text = |key: &str| table.get(key).map(|value| (*value).to_owned()).ok_or_else(|| wrong(key));
    let number = |key: &str| text(key)?.parse::<f64>().map_err(|_| wrong(key));
    let known = [Status::Agrees, Status::ThesisError, Status::NotStated, Status::Qualitative, Status::Open];
    let name = text("status")?;
    let status = known.into_iter().find(|status| status.name() == name).ok_or_else(|| wrong("status"))?;
    let tolerance = table.contains_key("tolerance").then(|| number("tolerance")).transpose()?;
    let quoted = Quoted {
        item: text("item")?,
        quantity: text("quantity")?,
        value: number("value")?,
        unit: text("unit")?,
        status,
        computed: text("computed").ok(),
        tolerance,
        note: text("note")?,
    };
    let compared = quoted.computed.is_some() && quoted.tolerance.is_some();
    match status {
        Status::Agrees | Status::ThesisError if !compared => Err(wrong("computed and tolerance are missing")),
        Status::Agrees if quoted.tolerance.is_some_and(|tolerance| tolerance > 0.05) => {
            Err(wrong("tolerance above 5 %"))
        }
        _ => Ok(quoted),
    }
}

impl Quoted {
    /// Whether the status is what the recomputed value says; an error where that value does not exist.
    pub fn holds(&self, values: &BTreeMap<String, f64>) -> Result<bool, String> {
        let (Some(name), Some(tolerance)) = (&self.computed, self.tolerance) else { return Ok(true) };
        let value = values.get(name).ok_or_else(|| format!("{}: no figure computes {name}", self.item))?;
        let agrees = (value / self.value - 1.0).abs() <= tolerance;
        Ok(match self.status {
            Status::Agrees => agrees,
            Status::ThesisError => !agrees,
            _ => true,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ENTRY: &str = "[[quoted]]\nitem = \"A\"\nquantity = \"q\"\nvalue = 2e3\nunit = \"Pa\"\nnote = \"n\"\n";

    #[test]
    fn the_file_is_complete_and_every_entry_sound() {
        let all = all().unwrap();
        assert!(all.len() > 50, "{}", all.len());
        assert!(all.iter().all(|quoted| !quoted.note.is_empty() && quoted.value.is_finite()));
    }

    #[test]
    fn entries_without_proof_wide_tolerances_and_unknown_keys_are_refused() {
        let with = |lines: &str| parse(&format!("{ENTRY}{lines}"));
        assert!(with("status = \"open\"").is_ok());
        assert!(with("status = \"agrees\"").is_err());
        assert!(with("status = \"agrees\"\ncomputed = \"x\"\ntolerance = 0.05").is_ok());
        assert!(with("status = \"agrees\"\ncomputed = \"x\"\ntolerance = 0.06").is_err());
        assert!(with("status = \"fine\"").is_err());
        assert!(with("status = \"open\"\ncolour = \"red\"").is_err());
        assert!(with("status = \"open\"\nstatus = \"open\"").is_err());
        assert!(with("").is_err());
    }

    #[test]
    fn a_status_that_the_recomputed_value_contradicts_does_not_hold() {
        let values = |x: f64| BTreeMap::from([("x".to_owned(), x)]);
        let entry = |status: &str| {
            let lines = format!("{ENTRY}status = \"{status}\"\ncomputed = \"x\"\ntolerance = 0.01");
            parse(&lines).unwrap().remove(0)
        };
        assert_eq!(entry("agrees").holds(&values(2010.0)), Ok(true));
        assert_eq!(entry("agrees").holds(&values(2030.0)), Ok(false));
        assert_eq!(entry("thesis_error").holds(&values(2030.0)), Ok(true));
        assert_eq!(entry("thesis_error").holds(&values(2010.0)), Ok(false));
        assert!(entry("agrees").holds(&BTreeMap::new()).is_err());
    }
}
