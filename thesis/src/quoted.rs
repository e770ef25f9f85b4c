//! Every number that the text of the thesis quotes, with what became of it: `thesis/quoted.toml`.

use std::collections::BTreeMap;

/// Verdict of a recomputation on a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// Recomputed by simulation, within the tolerance of its entry: it could have failed.
    Agrees,
    /// Recomputed within the tolerance from other stated numbers alone, by arithmetic or a closed form: no simulation
    /// can fail it.
    Follows,
    /// Recomputed within the tolerance, but something of ours was chosen so that it comes out.
    Fitted,
    /// Put in, not found: a parameter that is used as it is, or a ratio that is one by definition.
    Given,
    /// An error of the thesis: recomputed, outside of the tolerance; the note says which proof shows it.
    ThesisError,
    /// A misprint of the text at hand: other places of the thesis show that it means something else.
    Misprint,
    /// A judgement of ours: the number differs from a measure that we chose, not from anything that the thesis says.
    Judgement,
    /// Its figure needs a value that the thesis does not state; the note says what is assumed.
    NotStated,
    /// A trend in words.
    Qualitative,
    /// Not recomputed.
    Open,
}

impl Status {
    /// All of them.
    pub const ALL: [Self; 10] = [
        Self::Agrees,
        Self::Follows,
        Self::Fitted,
        Self::Given,
        Self::ThesisError,
        Self::Misprint,
        Self::Judgement,
        Self::NotStated,
        Self::Qualitative,
        Self::Open,
    ];

    /// Name in `quoted.toml`, and in the report.
    pub fn name(self) -> &'static str {
        match self {
            Self::Agrees => "agrees",
            Self::Follows => "follows",
            Self::Fitted => "fitted",
            Self::Given => "given",
            Self::ThesisError => "thesis_error",
            Self::Misprint => "misprint",
            Self::Judgement => "judgement",
            Self::NotStated => "not_stated",
            Self::Qualitative => "qualitative",
            Self::Open => "open",
        }
    }

    /// Relation of the recomputed value to the quoted one: it must be equal (`Some(true)`), must differ from it, or is
    /// not compared.
    fn demands(self) -> Option<bool> {
        match self {
            Self::Agrees | Self::Follows | Self::Fitted => Some(true),
            Self::ThesisError | Self::Judgement => Some(false),
            _ => None,
        }
    }
}

/// Beginning of the names of recomputed values that come from stated numbers alone.
pub const ARITHMETIC: &str = "closed.";

/// A quoted number.
#[derive(Clone, Debug)]
pub struct Quoted {
    /// Figure, table or text: `A 12`, `D 18`.
    pub item: String,
    /// Quantity.
    pub quantity: String,
    /// The number, in `unit`.
    pub value: f64,
    /// Its upper end, where the thesis states a range.
    pub to: Option<f64>,
    /// Unit.
    pub unit: String,
    /// Status.
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
    const KEYS: [&str; 9] = ["item", "quantity", "value", "to", "unit", "status", "computed", "tolerance", "note"];
    let wrong = |what: &str| format!("{what} in {table:?}");
    if let Some(unknown) = table.keys().find(|key| !KEYS.contains(key)) {
        return Err(wrong(unknown));
    }
    let text = |key: &str| table.get(key).map(|value| (*value).to_owned()).ok_or_else(|| wrong(key));
    let number = |key: &str| text(key)?.parse::<f64>().map_err(|_| wrong(key));
    let optional = |key: &str| table.contains_key(key).then(|| number(key)).transpose();
    let name = text("status")?;
    let status = Status::ALL.into_iter().find(|status| status.name() == name).ok_or_else(|| wrong("status"))?;
    let quoted = Quoted {
        item: text("item")?,
        quantity: text("quantity")?,
        value: number("value")?,
        to: optional("to")?,
        unit: text("unit")?,
        status,
        computed: text("computed").ok(),
        tolerance: optional("tolerance")?,
        note: text("note")?,
    };
    quoted.sound().map_or(Ok(quoted), |flaw| Err(wrong(flaw)))
}

impl Quoted {
    /// Contradictions to its status, whatever is recomputed.
    fn sound(&self) -> Option<&'static str> {
        let (demands, computed) = (self.status.demands(), self.computed.as_deref());
        let arithmetic = computed.is_some_and(|name| name.starts_with(ARITHMETIC));
        if demands.is_some() && (computed.is_none() || self.tolerance.is_none()) {
            return Some("computed and tolerance are missing");
        }
        if demands == Some(true) && self.tolerance.is_some_and(|tolerance| tolerance > 0.05) {
            return Some("tolerance above 5 %");
        }
        match self.status {
            Status::Agrees if arithmetic => Some("what arithmetic alone gives cannot fail: follows"),
            Status::Follows if !arithmetic => Some("a simulation can fail: agrees"),
            Status::Given if computed.is_some() => Some("what was put in is not compared"),
            _ => None,
        }
    }

    /// True if the status is what the recomputed value says; an error where that value does not exist.
    pub fn holds(&self, values: &BTreeMap<String, f64>) -> Result<bool, String> {
        let (Some(name), Some(tolerance)) = (&self.computed, self.tolerance) else { return Ok(true) };
        let value = values.get(name).ok_or_else(|| format!("{}: no figure computes {name}", self.item))?;
        let [low, high] = [self.value, self.to.unwrap_or(self.value)];
        let agrees = (low - tolerance * low.abs()..=high + tolerance * high.abs()).contains(value);
        Ok(value.is_finite() && self.status.demands().is_none_or(|wanted| wanted == agrees))
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
        // A statement that cannot fail does not agree, and one that can fail does not follow.
        let closed = "computed = \"closed.x\"\ntolerance = 0.01";
        assert!(with(&format!("status = \"agrees\"\n{closed}")).is_err());
        assert!(with(&format!("status = \"follows\"\n{closed}")).is_ok());
        assert!(with("status = \"follows\"\ncomputed = \"x\"\ntolerance = 0.01").is_err());
        assert!(with("status = \"given\"").is_ok());
        assert!(with("status = \"given\"\ncomputed = \"x\"\ntolerance = 0.01").is_err());
        assert!(with("status = \"judgement\"").is_err());
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
        assert_eq!(
            [entry("judgement").holds(&values(2030.0)), entry("fitted").holds(&values(2030.0))],
            [Ok(true), Ok(false)]
        );
        assert!(
            entry("agrees").holds(&BTreeMap::new()).is_err() && entry("agrees").holds(&values(f64::NAN)) == Ok(false)
        );
    }

    #[test]
    fn a_range_agrees_from_its_lower_to_its_upper_end() {
        let text = ENTRY.replace("2e3", "3");
        let entry =
            parse(&format!("{text}to = 5\nstatus = \"agrees\"\ncomputed = \"x\"\ntolerance = 0")).unwrap().remove(0);
        let holds = |x: f64| entry.holds(&BTreeMap::from([("x".to_owned(), x)])) == Ok(true);
        assert!([3.0, 4.2, 5.0].into_iter().all(holds) && ![2.9, 5.1].into_iter().any(holds));
    }
}
