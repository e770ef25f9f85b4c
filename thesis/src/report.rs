//! The report: one page without anything from elsewhere, and the recomputed values as a table.

use crate::errors::{self, Kind};
use crate::figures::{Figure, MISSING};
use crate::page;
use crate::quoted::{Quoted, Status};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;

const STYLE: &str = "body{font:16px/1.5 Georgia,serif;max-width:76rem;margin:2rem auto;padding:0 1rem;color:#1a1a1a}\
p,ul{max-width:52rem}h1,h2,h3,th,.status,svg,.legend,.items{font-family:system-ui,sans-serif}\
h3{border-top:1px solid #ccc;padding-top:1rem;margin-top:2rem}h3 .status{font-size:.8em;margin-left:.5em}\
table{border-collapse:collapse;width:100%;font-size:14px}\
td,th{border-bottom:1px solid #ccc;padding:.3rem .5rem;text-align:left;vertical-align:top}\
.plots{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(30rem,100%),1fr));gap:1rem 2rem}\
figure{margin:0;max-width:44rem}figure>svg{width:100%;font-size:15px}.grid{stroke:#e2e2e2}\
.legend{font-size:14px;padding-left:3.5rem}.legend span{display:inline-block;margin-right:1.2em}.key{width:28px;height:8px}\
.agrees{color:#1b6e2c}.thesis_error{color:#a3260f}.not_stated{color:#7a5b00}.misprint,.judgement{color:#6a3d9a}\
.open,.given,.follows,.fitted,.qualitative{color:#555}\
.legend .chip{display:inline-block;width:.9em;height:.9em;vertical-align:-.1em;margin:0}\
.items{columns:20rem;font-size:14px;max-width:none;list-style:none;padding:0}\
section,tr,figure{break-inside:avoid}@media print{body{max-width:none;margin:0}h2{break-before:page}}";

/// Status in words, and what it says.
fn words(status: Status) -> [&'static str; 2] {
    match status {
        Status::Agrees => ["agrees", "recomputed by simulation within its tolerance"],
        Status::Follows => {
            ["follows", "arithmetic or a closed form of other stated numbers gives it; no simulation could fail"]
        }
        Status::Fitted => ["fitted", "recomputed, but something of ours was chosen so that it comes out"],
        Status::Given => ["given", "a parameter that is used as it is, or one by definition"],
        Status::ThesisError => ["error of the thesis", "recomputed otherwise, with a proof"],
        Status::Misprint => ["misprint", "other places of the thesis show that it means something else"],
        Status::Judgement => ["judgement of ours", "differs from a measure that we chose"],
        Status::NotStated => ["not stated", "hangs on a value that the thesis does not state"],
        Status::Qualitative => ["qualitative", "a trend in words"],
        Status::Open => ["not recomputed", "nothing of it was computed"],
    }
}

fn badge(status: Status) -> String {
    format!("<span class=\"status {}\">{}</span>", status.name(), words(status)[0])
}

/// How many of the quoted numbers have each status, and what it means.
fn counts(quoted: &[Quoted]) -> String {
    let count = |status: Status| quoted.iter().filter(|entry| entry.status == status).count();
    let row = |status: &Status| format!("{} {}: {}", count(*status), badge(*status), words(*status)[1]);
    let rows: Vec<String> = Status::ALL.iter().filter(|status| count(**status) > 0).map(row).collect();
    format!("<p>Quoted numbers, {} in all, in the last table. {}.</p>", quoted.len(), rows.join("; "))
}

/// The deviations in one table for each kind, with the values of these figures, else with those that are kept.
fn deviations(figures: &[(Figure, f64)], quoted: &[Quoted]) -> Result<String, String> {
    let mut names = page::names(COMMITTED, quoted)?;
    names.extend(figures.iter().flat_map(|(figure, _)| figure.values.clone()));
    let mut text = String::from("<h2>Where text and recomputation differ</h2>");
    for kind in Kind::ALL {
        let _ = write!(text, "<h3>{}</h3><p>{}</p>", kind.title(), kind.meaning());
        text += "<table><tr><th>place</th><th>it says</th><th>right is</th><th>because</th></tr>";
        for error in errors::ALL.iter().filter(|error| error.kind == kind) {
            let mut cells = Vec::new();
            for cell in [error.place, error.says, error.right, error.proof] {
                cells.push(escape(&page::filled(cell, &names)?).replace('`', ""));
            }
            let _ = write!(text, "<tr><td>{}</td></tr>", cells.join("</td><td>"));
        }
        text += "</table>";
    }
    Ok(text)
}

/// Text with the characters that mean something in HTML replaced.
fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

/// A number as short as it can be.
fn number(value: f64) -> String {
    if (1e-3..1e5).contains(&value.abs()) { value.to_string() } else { format!("{value:e}") }
}

/// The page.
pub fn html(figures: &[(Figure, f64)], quoted: &[Quoted]) -> Result<String, String> {
    let mut page = format!(
        "<!DOCTYPE html><html lang=\"en\"><head><meta charset=\"utf-8\"><title>The thesis recomputed</title>\
         <style>{STYLE}</style></head><body><h1>The thesis recomputed</h1>\
         <p>A. Draganis, <i>Numerical simulation of thermomechanically coupled transient rolling contact</i>, Chalmers 2014. The \
         thesis's own method is dashed, ours solid, closed forms are circles, quoted numbers thin lines. I is the introduction, A to D \
         are the papers. Figures come first, then where text and recomputation differ, then every quoted number.</p>{}",
        counts(quoted)
    );
    page += "<ul class=\"items\">";
    for (figure, _) in figures {
        let item = figure.item.replace(' ', "");
        let _ = write!(page, "<li><a href=\"#{item}\">{}</a> {}</li>", figure.item, figure.title);
    }
    page += "</ul>";
    if !MISSING.is_empty() {
        let _ = write!(page, "<p class=\"open\">Not recomputed: {}.</p>", MISSING.join(", "));
    }
    page += "<h2>Figures</h2>";
    for (figure, seconds) in figures {
        let _ = write!(page, "<section id=\"{}\">", figure.item.replace(' ', ""));
        let _ = write!(page, "<h3>{}: {} {}</h3>", figure.item, figure.title, badge(figure.status));
        let _ = write!(page, "<p>{}</p><p><i>{}</i></p>", escape(&figure.finding), escape(figure.parameters));
        page += "<div class=\"plots\">";
        figure.plots.iter().for_each(|plot| page += &plot.svg());
        page += "</div><ul>";
        for predicate in &figure.predicates {
            let mark = if predicate.holds { "holds" } else { "<b>does not hold</b>" };
            let _ = write!(page, "<li>{}: {mark}</li>", escape(&predicate.says));
        }
        let _ = write!(page, "</ul><p class=\"open\">{seconds:.1} s</p></section>");
    }
    page += &deviations(figures, quoted)?;
    page += "<h2>Every quoted number</h2><table><tr><th>item</th><th>quantity</th><th>value</th><th>status</th><th>note</th></tr>";
    for q in quoted {
        let upper = q.to.map_or_else(String::new, |to| format!(" to {}", number(to)));
        let value = format!("{}{upper} {}", number(q.value), escape(&q.unit));
        let _ = write!(
            page,
            "<tr><td>{}</td><td>{}</td><td>{value}</td><td>{}</td><td>{}</td></tr>",
            q.item,
            escape(&q.quantity),
            badge(q.status),
            escape(&q.note)
        );
    }
    Ok(page + "</table></body></html>\n")
}

/// Recomputed values: item, name, value.
pub fn csv(figures: &[(Figure, f64)]) -> String {
    let mut text = String::from("item,name,value\n");
    for (figure, _) in figures {
        for (name, value) in &figure.values {
            let _ = writeln!(text, "{},{name},{value:.9e}", figure.item);
        }
    }
    text
}

/// The values that `make thesis` last gave, in the form of [`csv`].
pub const COMMITTED: &str = include_str!("../values.csv");
/// Largest relative difference to them \[1], and what counts as nothing whatever the unit.
const SAME: [f64; 2] = [1e-3, 1e-12];
/// End of the names of values that are a difference of two numbers over one of them, and by how much they may differ:
/// a thousandth of such a difference would be far less than a thousandth of either number.
const DIFFERENCE: (&str, f64) = (".off", 2e-5);

/// Rows of the committed table that belong to one of these items, in the form of [`csv`].
pub fn committed(items: &[&str]) -> String {
    let belongs = |line: &&str| line.split(',').next().is_some_and(|item| items.contains(&item));
    let rows = COMMITTED.lines().skip(1).filter(belongs);
    COMMITTED.lines().take(1).chain(rows).map(|line| format!("{line}\n")).collect()
}

/// Differences between two tables of values: numbers by more than a thousandth, and names that only one of them has.
pub fn departures(committed: &str, found: &str) -> Vec<String> {
    let table = |text: &str| -> BTreeMap<String, f64> {
        let rows = text.lines().skip(1).filter_map(|line| line.rsplit_once(','));
        rows.map(|(name, value)| (name.to_owned(), value.parse().unwrap_or(f64::NAN))).collect()
    };
    let (committed, found) = (table(committed), table(found));
    let names: BTreeSet<&String> = committed.keys().chain(found.keys()).collect();
    let least = |name: &str| if name.ends_with(DIFFERENCE.0) { DIFFERENCE.1 } else { SAME[1] };
    let differs = |name: &&String| match (committed.get(*name), found.get(*name)) {
        (Some(before), Some(now)) if (now - before).abs() <= SAME[0] * before.abs() + least(name) => None,
        (before, now) => Some(format!("{name}: committed {before:?}, now {now:?}")),
    };
    names.iter().filter_map(differs).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_summary_counts_every_quoted_number_once() {
        let page = html(&[], &crate::quoted::all().unwrap()).unwrap();
        let sentence = page.split("Quoted numbers, ").nth(1).unwrap().split("</p>").next().unwrap();
        println!("{sentence}");
        let number = |text: &str| text.split(' ').find_map(|word| word.parse::<usize>().ok());
        let (all, rest) = sentence.split_once("table. ").unwrap();
        let parts: Vec<usize> = rest.split("; ").filter_map(number).collect();
        assert!(parts.len() > 5 && number(all) == Some(parts.iter().sum::<usize>()));
    }

    /// No deviation is hidden, and none stands in two tables.
    #[test]
    fn deviations_of_three_kinds_stand_in_tables_of_their_own() {
        let page = html(&[], &crate::quoted::all().unwrap()).unwrap();
        let tables: Vec<&str> = Kind::ALL
            .iter()
            .map(|kind| {
                let table = page.split(&format!("<h3>{}</h3>", kind.title())).nth(1).unwrap();
                table.split("</table>").next().unwrap()
            })
            .collect();
        for error in errors::ALL {
            let found: Vec<bool> =
                tables.iter().map(|table| table.contains(&escape(error.says).replace('`', ""))).collect();
            let own: Vec<bool> = Kind::ALL.iter().map(|kind| *kind == error.kind).collect();
            assert_eq!(found, own, "{}: {}", error.place, error.says);
        }
    }

    #[test]
    fn values_that_changed_by_more_than_a_thousandth_are_found_and_so_are_names_of_one_table_only() {
        let table = |rows: &str| format!("item,name,value\n{rows}");
        let committed = table("A,x,1.0e3\nA,y,2.0e-9\nA,z,3e-16\n");
        assert!(departures(&committed, &table("A,z,5e-16\nA,y,2.001e-9\nA,x,1.0009e3\n")).is_empty());
        assert_eq!(departures(&committed, &table("A,x,1.0e3\nA,y,2.01e-9\nA,z,0\n")).len(), 1);
        assert_eq!(departures(&committed, &table("A,x,NaN\nA,y,2.0e-9\nB,z,0\n")).len(), 3);
        let off = [table("A,x.off,1e-4\n"), table("A,x.off,1.19e-4\n"), table("A,x.off,1.21e-4\n")];
        assert_eq!([1, 2].map(|i| departures(&off[0], &off[i]).len()), [0, 1]);
        assert!(departures(COMMITTED, COMMITTED).is_empty() && COMMITTED.lines().count() > 150);
        let rows = |items: &[&str]| super::committed(items).lines().count();
        assert!(rows(&["A 12"]) > 5 && rows(&[]) == 1);
    }
}
