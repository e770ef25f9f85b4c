//! The report: one page without anything from elsewhere, and the recomputed values as a table.

use crate::errors;
use crate::figures::{Figure, MISSING};
use crate::quoted::{Quoted, Status};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;

const STYLE: &str = "body{font:15px/1.5 Georgia,serif;max-width:52rem;margin:2rem auto;padding:0 1rem;color:#1a1a1a}\
h1,h2,h3,th,.status,svg,.legend{font-family:system-ui,sans-serif}table{border-collapse:collapse;width:100%;font-size:13px}\
td,th{border-bottom:1px solid #ccc;padding:.3rem .5rem;text-align:left;vertical-align:top}\
svg{width:100%;font-size:12px}.grid{stroke:#e2e2e2}.legend{font-size:12px;margin-top:0}\
.agrees{color:#1b6e2c}.thesis_error{color:#a3260f}.not_stated{color:#7a5b00}.open{color:#666}\
section,tr{break-inside:avoid}@media print{body{max-width:none;margin:0}h2{break-before:page}}";

/// Status in words.
fn words(status: Status) -> &'static str {
    match status {
        Status::Agrees => "agrees",
        Status::ThesisError => "proven error",
        Status::NotStated => "not stated",
        Status::Qualitative => "qualitative",
        Status::Open => "not recomputed yet",
    }
}

fn badge(status: Status) -> String {
    format!("<span class=\"status {}\">{}</span>", status.name(), words(status))
}

/// How many of the quoted numbers have each status, in a sentence.
fn counts(quoted: &[Quoted]) -> String {
    let known = [Status::Agrees, Status::ThesisError, Status::NotStated, Status::Qualitative, Status::Open];
    let count = |status: Status| quoted.iter().filter(|entry| entry.status == status).count();
    let part = |status: &Status| format!("{} {}", count(*status), badge(*status));
    let parts: Vec<String> = known.iter().filter(|status| count(**status) > 0).map(part).collect();
    format!("<p>Quoted numbers, {} in all: {}. The last table lists them.</p>", quoted.len(), parts.join(", "))
}

/// Text with the characters that mean something in HTML replaced.
fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

/// The page.
pub fn html(figures: &[(Figure, f64)], quoted: &[Quoted]) -> String {
    let mut page = format!(
        "<!DOCTYPE html><html lang=\"en\"><head><meta charset=\"utf-8\"><title>The thesis recomputed</title>\
         <style>{STYLE}</style></head><body><h1>The thesis recomputed</h1>\
         <p>A. Draganis, <i>Numerical simulation of thermomechanically coupled transient rolling contact</i>, Chalmers 2014. The \
         thesis's own method is dashed, ours solid, closed forms are dots, quoted numbers thin lines. I is the introduction, A to D \
         are the papers.</p><h3>Summary</h3>{}<table><tr><th>item</th><th>shows</th><th>status</th><th>found</th></tr>",
        counts(quoted)
    );
    for (figure, _) in figures {
        let (item, finding) = (figure.item.replace(' ', ""), escape(&figure.finding));
        let _ = write!(
            page,
            "<tr><td><a href=\"#{item}\">{}</a></td><td>{}</td><td>{}</td><td>{finding}</td></tr>",
            figure.item,
            figure.title,
            badge(figure.status)
        );
    }
    page += "</table>";
    if !MISSING.is_empty() {
        let _ = write!(page, "<p class=\"open\">Not recomputed yet: {}.</p>", MISSING.join(", "));
    }
    page +=
        "<h2>Errors of the thesis</h2><table><tr><th>place</th><th>it says</th><th>right is</th><th>because</th></tr>";
    for error in errors::ALL {
        let cells = [error.place, error.says, error.right, error.proof].map(escape);
        let _ = write!(page, "<tr><td>{}</td></tr>", cells.join("</td><td>"));
    }
    page += "</table><h2>Figures</h2>";
    for (figure, seconds) in figures {
        let _ = write!(page, "<section id=\"{}\">", figure.item.replace(' ', ""));
        let _ = write!(page, "<h3>{}: {} {}</h3>", figure.item, figure.title, badge(figure.status));
        let _ = write!(page, "<p>{}</p><p><i>{}</i></p>", escape(&figure.finding), escape(figure.parameters));
        figure.plots.iter().for_each(|plot| page += &plot.svg());
        page += "<ul>";
        for predicate in &figure.predicates {
            let mark = if predicate.holds { "holds" } else { "<b>does not hold</b>" };
            let _ = write!(page, "<li>{}: {mark}</li>", escape(&predicate.says));
        }
        let _ = write!(page, "</ul><p class=\"open\">{seconds:.1} s</p></section>");
    }
    page += "<h2>Every quoted number</h2><table><tr><th>item</th><th>quantity</th><th>value</th><th>status</th><th>note</th></tr>";
    for q in quoted {
        let value = format!("{} {}", q.value, escape(&q.unit));
        let _ = write!(
            page,
            "<tr><td>{}</td><td>{}</td><td>{value}</td><td>{}</td><td>{}</td></tr>",
            q.item,
            escape(&q.quantity),
            badge(q.status),
            escape(&q.note)
        );
    }
    page + "</table></body></html>\n"
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

/// What differs between two tables of values: numbers by more than a thousandth, and names that only one of them has.
pub fn departures(committed: &str, found: &str) -> Vec<String> {
    let table = |text: &str| -> BTreeMap<String, f64> {
        let rows = text.lines().skip(1).filter_map(|line| line.rsplit_once(','));
        rows.map(|(name, value)| (name.to_owned(), value.parse().unwrap_or(f64::NAN))).collect()
    };
    let (committed, found) = (table(committed), table(found));
    let names: BTreeSet<&String> = committed.keys().chain(found.keys()).collect();
    let differs = |name: &&String| match (committed.get(*name), found.get(*name)) {
        (Some(before), Some(now)) if (now - before).abs() <= SAME[0] * before.abs() + SAME[1] => None,
        (before, now) => Some(format!("{name}: committed {before:?}, now {now:?}")),
    };
    names.iter().filter_map(differs).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_summary_counts_every_quoted_number_once() {
        let page = html(&[], &crate::quoted::all().unwrap());
        let sentence = page.split("Quoted numbers, ").nth(1).unwrap().split("</p>").next().unwrap();
        let parts = sentence.split(&[' ', '>'][..]).filter_map(|word| word.parse::<usize>().ok());
        let numbers: Vec<usize> = parts.collect();
        println!("{sentence}");
        assert!(numbers.len() > 3 && numbers[0] == numbers[1..].iter().sum::<usize>());
    }

    #[test]
    fn values_that_changed_by_more_than_a_thousandth_are_found_and_so_are_names_of_one_table_only() {
        let table = |rows: &str| format!("item,name,value\n{rows}");
        let committed = table("A,x,1.0e3\nA,y,2.0e-9\nA,z,3e-16\n");
        assert!(departures(&committed, &table("A,z,5e-16\nA,y,2.001e-9\nA,x,1.0009e3\n")).is_empty());
        assert_eq!(departures(&committed, &table("A,x,1.0e3\nA,y,2.01e-9\nA,z,0\n")).len(), 1);
        assert_eq!(departures(&committed, &table("A,x,NaN\nA,y,2.0e-9\nB,z,0\n")).len(), 3);
        assert!(departures(COMMITTED, COMMITTED).is_empty() && COMMITTED.lines().count() > 150);
    }
}
