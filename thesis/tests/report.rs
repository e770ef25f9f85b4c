//! The report as a whole.

use std::collections::{BTreeMap, BTreeSet};
use wheelrail_thesis::figures::{ALL, Figure, MISSING};
use wheelrail_thesis::{errors, quoted, report};

/// All figures, each with a time.
fn figures() -> Vec<(Figure, f64)> {
    ALL.iter().map(|(_, recipe)| (recipe().unwrap(), 0.0)).collect()
}

#[test]
fn every_figure_shows_what_it_must_and_every_quoted_number_has_its_status() {
    let figures = figures();
    for ((name, _), (figure, _)) in ALL.iter().zip(&figures) {
        assert_eq!(*name, figure.item);
        assert!(!figure.predicates.is_empty(), "{name} tests nothing");
        println!("{name}: {}", figure.finding);
        for predicate in &figure.predicates {
            println!("    {}: {}", predicate.says, predicate.holds);
        }
    }
    assert!(figures.iter().flat_map(|(figure, _)| &figure.predicates).all(|predicate| predicate.holds));
    let values: BTreeMap<String, f64> = figures.iter().flat_map(|(figure, _)| figure.values.clone()).collect();
    for entry in quoted::all().unwrap() {
        assert_eq!(entry.holds(&values), Ok(true), "{} {}", entry.item, entry.quantity);
    }
    let page = report::html(&figures, &quoted::all().unwrap());
    // Nothing is fetched: no address, script or picture of its own.
    for foreign in ["http", "<script", "<img", "<link", "@import", "url("] {
        assert!(!page.contains(foreign), "{foreign}");
    }
    assert!(figures.iter().all(|(figure, _)| page.contains(figure.title)));
    assert_eq!(page.matches("<svg").count(), figures.iter().map(|(figure, _)| figure.plots.len()).sum::<usize>());
    assert!(errors::ALL.iter().all(|mistake| !mistake.proof.is_empty() && page.contains(mistake.place)));
    assert_eq!(report::csv(&figures).lines().count(), 1 + values.len());
}

#[test]
fn what_is_recomputed_is_not_called_missing_and_open_numbers_belong_to_what_is_missing() {
    let done: BTreeSet<&str> = ALL.iter().map(|(name, _)| *name).collect();
    assert!(MISSING.iter().all(|name| !done.contains(name)));
    for entry in quoted::all().unwrap() {
        let known = done.contains(entry.item.as_str()) || MISSING.contains(&entry.item.as_str());
        assert!(known || entry.item == "B text", "{}", entry.item);
    }
}
