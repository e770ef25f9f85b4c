//! The report as a whole.

use std::collections::{BTreeMap, BTreeSet};
use wheelrail_thesis::figures::{self, ALL, Extent, Figure, ITEMS, MISSING};
use wheelrail_thesis::quoted::Status;
use wheelrail_thesis::{errors, quoted, report};

/// Items that only `make thesis` computes and compares: 30 to 60 s of CPU each. All others are computed here and compared
/// with `thesis/values.csv`, in about 100 s of CPU.
const SLOW: [&str; 5] = ["C 12", "D 7–8", "D 9", "D 10", "D 18"];

/// Items that are computed here.
fn quick() -> Vec<&'static str> {
    ALL.iter().map(|(name, _)| *name).filter(|name| !SLOW.contains(name)).collect()
}

/// The figures that are computed here, each with its computing time \[s].
fn figures() -> Vec<(Figure, f64)> {
    let quick: Vec<_> = ALL.iter().filter(|(name, _)| !SLOW.contains(name)).collect();
    figures::compute(&quick, Extent::Quick, |done| println!("{done}")).unwrap()
}

#[test]
fn every_figure_shows_what_it_must_and_every_quoted_number_has_its_status() {
    let figures = figures();
    assert_eq!(figures.len(), ALL.len() - SLOW.len());
    println!("{:.0} s of computing", figures.iter().map(|(_, seconds)| seconds).sum::<f64>());
    for (figure, _) in &figures {
        assert!(!SLOW.contains(&figure.item));
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
    assert!(count >= 35);
    for entry in &compared {
        assert_eq!(entry.holds(&values), Ok(true), "{} {}", entry.item, entry.quantity);
    }
    let committed = report::committed(&quick());
    println!("{} values compared with those that are kept", committed.lines().count() - 1);
    assert_eq!(report::departures(&committed, &report::csv(&figures)), [""; 0]);
    let page = report::html(&figures, &quoted::all().unwrap()).unwrap();
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

/// Names between two characters, without repetition.
fn between(text: &str, mark: char) -> BTreeSet<&str> {
    text.split(mark).skip(1).step_by(2).collect()
}

/// The page of coverage has the eight rows of the thesis's Table 6.1, with files that exist and a command each, whose
/// items exist.
#[test]
fn every_feature_of_table_6_1_has_files_and_a_command() {
    const FEATURES: [&str; 8] = [
        "Thermomechanical coupling",
        "Friction",
        "Transient dynamics",
        "Non-smooth surfaces",
        "Non-reflecting boundary conditions",
        "Numerical stabilization",
        "Variable rolling velocities",
        "Control of driving forces",
    ];
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let page = std::fs::read_to_string(root.join("docs/thesis-coverage.md")).unwrap();
    for feature in FEATURES {
        let rows: Vec<&str> = page.lines().filter(|line| line.starts_with(&format!("| {feature} |"))).collect();
        let [files, command] = rows[..] else { panic!("{feature}: {rows:?}") };
        let cells: Vec<&str> = files.split('|').map(str::trim).collect();
        let paths = between(files, '`').into_iter().filter(|word| word.contains('/')).collect::<Vec<_>>();
        assert!(cells.len() == 7 && paths.len() >= 2, "{files}");
        for path in paths {
            assert!(root.join(path).exists(), "{path}");
        }
        let named = between(command, '"');
        println!("{feature}: {named:?}");
        assert!(command.contains("-p wheelrail-thesis -- ") && !named.is_empty());
        assert!(named.iter().all(|item| ALL.iter().any(|(name, _)| name == item)), "{command}");
    }
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
