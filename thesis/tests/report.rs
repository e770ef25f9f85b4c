//! The report as a whole.

use std::collections::{BTreeMap, BTreeSet};
use wheelrail_thesis::figures::{self, ALL, Extent, Figure, ITEMS, MISSING};
use wheelrail_thesis::quoted::Status;
use wheelrail_thesis::{errors, quoted, report};

/// Figures that are computed here; `make thesis` computes all of them, also those that take long (ends and resonance of
/// A T3 and A 12, the thesis's own steps in time of D 7 to D 10).
const QUICK: [&str; 30] = [
    "I 4.2",
    "I 5.1",
    "A text",
    "A 4",
    "A T2",
    "A 5–6",
    "A 7",
    "B 4",
    "B 5",
    "B 6",
    "B 7",
    "B 10",
    "B 11",
    "B 12",
    "B 13",
    "B 14",
    "B 15",
    "B 17",
    "B 18–19",
    "C 4",
    "C 7",
    "C 8–11",
    "C 13",
    "C 14",
    "C 15",
    "D 4",
    "D 6",
    "D T1",
    "D 11–15",
    "D 19–21",
];

/// The quick figures, each with its time \[s].
fn figures() -> Vec<(Figure, f64)> {
    let quick: Vec<_> = ALL.iter().filter(|(name, _)| QUICK.contains(name)).collect();
    figures::compute(&quick, Extent::Quick, |done| println!("{done}")).unwrap()
}

#[test]
fn every_figure_shows_what_it_must_and_every_quoted_number_has_its_status() {
    let figures = figures();
    assert_eq!(figures.len(), QUICK.len());
    for (figure, _) in &figures {
        assert!(QUICK.contains(&figure.item));
        println!("{}: {}", figure.item, figure.finding);
        for predicate in &figure.predicates {
            println!("    {}: {}", predicate.says, predicate.holds);
        }
    }
    assert_eq!(figures.iter().flat_map(|(figure, _)| figure.flaws()).collect::<Vec<_>>(), [""; 0]);
    let values: BTreeMap<String, f64> = figures.iter().flat_map(|(figure, _)| figure.values.clone()).collect();
    let known = |entry: &quoted::Quoted| entry.computed.as_ref().is_none_or(|name| values.contains_key(name));
    let compared: Vec<_> = quoted::all().unwrap().into_iter().filter(known).collect();
    let count = compared.iter().filter(|entry| entry.computed.is_some()).count();
    println!("{count} quoted numbers compared");
    assert!(count >= 32);
    for entry in &compared {
        assert_eq!(entry.holds(&values), Ok(true), "{} {}", entry.item, entry.quantity);
    }
    let page = report::html(&figures, &quoted::all().unwrap());
    // Nothing is fetched: no address, script or picture of its own.
    for foreign in ["http", "<script", "<img", "<link", "@import", "url("] {
        assert!(!page.contains(foreign), "{foreign}");
    }
    assert!(figures.iter().all(|(figure, _)| page.contains(figure.title)));
    assert_eq!(
        page.matches("<figure><svg").count(),
        figures.iter().map(|(figure, _)| figure.plots.len()).sum::<usize>()
    );
    assert!(errors::ALL.iter().all(|mistake| !mistake.proof.is_empty() && page.contains(mistake.place)));
    assert_eq!(report::csv(&figures).lines().count(), 1 + values.len());
}

/// Every item of the thesis is either recomputed or said to be missing, and none is both.
#[test]
fn every_item_is_in_exactly_one_list() {
    let done = ALL.iter().map(|(name, _)| *name);
    let mut listed: Vec<&str> = done.chain(MISSING.iter().copied()).collect();
    let mut items = ITEMS.to_vec();
    listed.sort_unstable();
    items.sort_unstable();
    assert_eq!(listed, items);
}

#[test]
fn a_figure_that_nothing_tests_is_refused() {
    let mut figure = ALL[0].1.compute(Extent::Quick).unwrap();
    assert!(figure.flaws().is_empty());
    figure.predicates[0].holds = false;
    assert_eq!(figure.flaws().len(), 1);
    figure.predicates.clear();
    assert_eq!(figure.flaws(), ["I 4.2: nothing tests it"]);
}

/// A number is open exactly where its item is not recomputed.
#[test]
fn quoted_numbers_belong_to_items_and_open_ones_to_what_is_missing() {
    let done: BTreeSet<&str> = ALL.iter().map(|(name, _)| *name).collect();
    for entry in quoted::all().unwrap() {
        let item = entry.item.as_str();
        assert!(ITEMS.contains(&item), "{item}");
        let open = entry.status == Status::Open;
        assert!(open != done.contains(item), "{item} {}", entry.quantity);
    }
}

/// `make thesis FULL=1`: more points on the same curves, finer meshes beside the same ones, and every number of the
/// quick report.
#[test]
fn in_full_figures_have_sixteen_points_a_curve_and_the_numbers_of_the_quick_report() {
    let grow: Vec<&str> = ALL.iter().filter(|(_, recipe)| recipe.grows()).map(|(name, _)| *name).collect();
    assert_eq!(grow, ["A 12", "B 11", "B 14", "B 15", "B 16", "C 6", "C 12", "C 14", "C 15", "D 6", "D 18"]);
    let (_, recipe) = ALL.iter().find(|(name, _)| *name == "B 14").unwrap();
    let [quick, full] = [Extent::Quick, Extent::Full].map(|extent| recipe.compute(extent).unwrap());
    assert!(full.flaws().is_empty(), "{:?}", full.flaws());
    let points = |figure: &Figure| figure.plots[0].curves[0].points.clone();
    assert_eq!((points(&quick).len(), points(&full).len()), (7, 19));
    assert!(points(&quick).iter().all(|point| points(&full).contains(point)));
    assert_eq!(quick.values, full.values);
}
