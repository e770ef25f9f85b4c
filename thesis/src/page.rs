//! Numbers of `docs/thesis.md`: its tables are written from a text with names in the place of numbers.
//!
//! A name stands in braces with the form in which its value is written, `{a12.peak .0}`: so many decimals, with a sign
//! (`+.3`), in scientific form (`.2e`), or times a factor (`{a8.deviation*1e-6 .3}`). Names are those of
//! `thesis/values.csv`; `{status.agrees .0}` is the number of quoted values of that status.

use crate::errors::{self, Kind};
use crate::quoted::{Quoted, Status};
use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::PathBuf;

/// The results in one table for each paper, with names for numbers.
const RESULTS: &str = include_str!("../results.txt");

/// Path of the page.
pub fn path() -> PathBuf {
    PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/thesis.md"))
}

/// Values by name of a table of values, and how many quoted numbers have each status.
pub fn names(table: &str, quoted: &[Quoted]) -> Result<BTreeMap<String, f64>, String> {
    let count = |status: Status| quoted.iter().filter(|entry| entry.status == status).count() as f64;
    let mut names: BTreeMap<String, f64> =
        Status::ALL.map(|status| (format!("status.{}", status.name()), count(status))).into();
    for line in table.lines().skip(1) {
        let fields: Vec<&str> = line.split(',').collect();
        let [_, name, value] = fields[..] else { return Err(format!("not item, name and value: {line}")) };
        names.insert(name.to_owned(), value.parse().map_err(|_| format!("not a number: {line}"))?);
    }
    Ok(names)
}

/// Text with the value of each name in its place.
pub fn filled(text: &str, names: &BTreeMap<String, f64>) -> Result<String, String> {
    let mut pieces = text.split('{');
    let mut filled = pieces.next().unwrap_or_default().to_owned();
    for piece in pieces {
        let (place, rest) = piece.split_once('}').ok_or_else(|| format!("no end of {{{piece}"))?;
        filled += &number(place, names)?;
        filled += rest;
    }
    Ok(filled)
}

/// Value of a place such as `a8.deviation*1e-6 .3` in the form that it asks for.
fn number(place: &str, names: &BTreeMap<String, f64>) -> Result<String, String> {
    let wrong = |what: &str| format!("{{{place}}}: {what}");
    let (source, form) = place.split_once(' ').ok_or_else(|| wrong("no form of the number, such as .3"))?;
    let (name, factor) = source.split_once('*').unwrap_or((source, "1"));
    let factor: f64 = factor.parse().map_err(|_| wrong("the factor is not a number"))?;
    let value = factor * names.get(name).ok_or_else(|| wrong("no such value"))?;
    let (signed, form) = form.strip_prefix('+').map_or((false, form), |form| (true, form));
    let (scientific, form) = form.strip_suffix('e').map_or((false, form), |form| (true, form));
    let digits = form.strip_prefix('.').and_then(|digits| digits.parse::<usize>().ok());
    let digits = digits.ok_or_else(|| wrong("the form is not [+].digits[e]"))?;
    let size = value.abs();
    let text = if scientific { format!("{size:.digits$e}") } else { format!("{size:.digits$}") };
    let nothing = text.chars().all(|c| !matches!(c, '1'..='9'));
    let sign = match (value < 0.0 && !nothing, signed) {
        (true, _) => "−",
        (false, true) => "+",
        (false, false) => "",
    };
    Ok(format!("{sign}{text}"))
}

/// Rows of the deviations of one kind.
fn deviations(kind: Kind) -> String {
    let mut text = format!("### {}\n\n{}\n\n", kind.title(), kind.meaning());
    text += "| place | says | right | because |\n|---|---|---|---|\n";
    for error in errors::ALL.iter().filter(|error| error.kind == kind) {
        // A bar within code would end the cell.
        let cells = [error.place, error.says, error.right, error.proof].map(|cell| cell.replace('|', "\\|"));
        let _ = writeln!(text, "| {} |", cells.join(" | "));
    }
    text
}

/// The page with everything between its marks written anew.
pub fn page(current: &str, names: &BTreeMap<String, f64>) -> Result<String, String> {
    let deviations = Kind::ALL.map(deviations).join("\n");
    let mut page = current.to_owned();
    for (mark, text) in [("results", RESULTS), ("deviations", deviations.as_str())] {
        let [begin, end] = ["begin", "end"].map(|word| format!("<!-- {mark}: {word} -->\n"));
        let missing = || format!("docs/thesis.md has no mark {}", begin.trim());
        let (before, rest) = page.split_once(&begin).ok_or_else(missing)?;
        let (_, after) = rest.split_once(&end).ok_or_else(missing)?;
        page = format!("{before}{begin}{}\n{end}{after}", filled(text, names)?.trim_end());
    }
    Ok(page)
}

/// The page as a table of values has it, and as it is.
pub fn current(table: &str) -> Result<[String; 2], String> {
    let file = path();
    let page_now = std::fs::read_to_string(&file).map_err(|error| format!("{}: {error}", file.display()))?;
    let names = names(table, &crate::quoted::all()?)?;
    Ok([page(&page_now, &names)?, page_now])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::COMMITTED;

    #[test]
    fn numbers_have_the_form_that_their_place_asks_for() {
        let names = BTreeMap::from([("x.1".to_owned(), -1234.5678), ("small".to_owned(), 7.5e-5)]);
        let text =
            filled("{x.1 .0} {x.1 .2} {x.1*-1e-3 +.1} {small .1e} {small*100 .2} {small*-1 .2}", &names).unwrap();
        println!("{text}");
        assert_eq!(text, "−1235 −1234.57 +1.2 7.5e-5 0.01 0.00");
        for wrong in ["{y .1}", "{x.1}", "{x.1 3}", "{x.1 .x}", "{x.1*a .3}", "{x.1 .3"] {
            println!("{}", filled(wrong, &names).unwrap_err());
        }
    }

    #[test]
    fn what_stands_between_the_marks_is_written_and_nothing_else() {
        let marks = |results: &str, deviations: &str| {
            format!(
                "a\n<!-- results: begin -->\n{results}<!-- results: end -->\nb\n<!-- deviations: begin -->\n{deviations}\
                 <!-- deviations: end -->\nc\n"
            )
        };
        let names = names(COMMITTED, &crate::quoted::all().unwrap()).unwrap();
        let once = page(&marks("", "OUTDATED\n"), &names).unwrap();
        assert!(once.starts_with("a\n<!-- results: begin -->\n") && once.ends_with("<!-- deviations: end -->\nc\n"));
        assert!(!once.contains("OUTDATED") && !once.contains('{'), "every name has its number");
        assert_eq!(page(&once, &names).unwrap(), once);
        assert!(page("no marks", &names).unwrap_err().contains("results: begin"));
    }

    /// `make thesis ACCEPT=1` writes both, `cargo run -p wheelrail-thesis -- --page` the page alone.
    #[test]
    fn the_tables_of_the_page_are_those_of_the_values_that_are_kept() {
        let [wanted, found] = current(COMMITTED).unwrap();
        let differs = wanted.lines().zip(found.lines()).find(|(wanted, found)| wanted != found);
        assert!(wanted == found, "docs/thesis.md is not what thesis/values.csv makes of it, from here on: {differs:?}");
    }
}
