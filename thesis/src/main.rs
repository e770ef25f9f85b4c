//! `wheelrail-thesis [--full] [--out DIR] [ITEM…]`: recomputes figures of the thesis on two threads and writes the report.
//!
//! Ends with an error if a figure shows something else than it must, a quoted number has the wrong status, or, of all figures without `--full`, if
//! a value is not the one of `thesis/values.csv` or they took longer than they may.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;
use wheelrail_thesis::figures::{ALL, Extent, Figure, Recipe};
use wheelrail_thesis::{paper_a, quoted, report};

const THREADS: usize = 2;
/// Longest time for all figures without `--full` \[s].
const LONGEST: f64 = 720.0;

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("{message}");
            ExitCode::FAILURE
        }
    }
}

fn run() -> Result<(), String> {
    let (mut out, mut wanted) = (PathBuf::from("results/thesis"), Vec::new());
    let mut extent = Extent::Quick;
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        match argument.as_str() {
            "--full" => extent = Extent::Full,
            "--out" => out = arguments.next().ok_or("--out needs a directory")?.into(),
            item if ALL.iter().any(|(name, _)| *name == item) => wanted.push(argument),
            other => {
                let names: Vec<&str> = ALL.iter().map(|(name, _)| *name).collect();
                return Err(format!("{other} is not recomputed; there are {names:?}"));
            }
        }
    }
    let recipes: Vec<_> =
        ALL.iter().filter(|(name, _)| wanted.is_empty() || wanted.iter().any(|w| w == name)).collect();
    let start = Instant::now();
    let figures = compute(&recipes, extent)?;
    let seconds = start.elapsed().as_secs_f64();
    println!("{seconds:.0} s in all; {}", slowest(&figures));
    let values: BTreeMap<String, f64> = figures.iter().flat_map(|(figure, _)| figure.values.clone()).collect();
    let quoted = quoted::all()?;
    std::fs::create_dir_all(&out).map_err(|error| format!("{}: {error}", out.display()))?;
    let pace = pace()?;
    println!("a step of the product takes {:.0} µs", 1e6 * pace);
    // The last file is for thesis/baseline.m.
    for (name, text) in [
        ("index.html", report::html(&figures, &quoted)),
        ("values.csv", report::csv(&figures)),
        ("step.txt", format!("{pace:e}\n")),
    ] {
        let file = out.join(name);
        std::fs::write(&file, text).map_err(|error| format!("{}: {error}", file.display()))?;
        println!("{}", file.display());
    }
    let mut wrong: Vec<String> = figures.iter().flat_map(|(figure, _)| figure.flaws()).collect();
    if wanted.is_empty() {
        for entry in &quoted {
            if !entry.holds(&values)? {
                wrong.push(format!("{} {}: {} is the wrong status", entry.item, entry.quantity, entry.status.name()));
            }
        }
    }
    if wanted.is_empty() && extent == Extent::Quick {
        wrong.extend(report::departures(report::COMMITTED, &report::csv(&figures)));
        if seconds > LONGEST {
            wrong.push(format!("{seconds:.0} s instead of at most {LONGEST} s; {}", slowest(&figures)));
        }
    }
    if wrong.is_empty() { Ok(()) } else { Err(wrong.join("\n")) }
}

/// Time that the product takes for a step of Paper A on a smooth rail \[s]: the shortest of some runs.
fn pace() -> Result<f64, String> {
    let product = paper_a::product("", |_| ())?;
    let run = || -> Result<f64, String> {
        let mut run = product.rolling(paper_a::SPEED, 0.0, |_| ())?;
        let start = Instant::now();
        paper_a::follow(&mut run, paper_a::STEP, 200)?;
        Ok(start.elapsed().as_secs_f64() / 200.0)
    };
    (0..5).try_fold(f64::INFINITY, |least, _| Ok(least.min(run()?)))
}

/// The three figures that took longest.
fn slowest(figures: &[(Figure, f64)]) -> String {
    let mut times: Vec<_> = figures.iter().map(|(figure, seconds)| (*seconds, figure.item)).collect();
    times.sort_by(|a, b| b.0.total_cmp(&a.0));
    let named: Vec<String> = times.iter().take(3).map(|(seconds, item)| format!("{item} {seconds:.0} s")).collect();
    format!("slowest: {}", named.join(", "))
}

/// All figures in their order, each with its time \[s].
fn compute(recipes: &[&(&'static str, Recipe)], extent: Extent) -> Result<Vec<(Figure, f64)>, String> {
    // Those that grow in full take longest and begin; later papers have the larger ones.
    let (mut queue, fixed): (Vec<_>, Vec<_>) = recipes.iter().rev().copied().partition(|(_, recipe)| recipe.grows());
    queue.extend(fixed);
    let next = AtomicUsize::new(0);
    let done = Mutex::new(BTreeMap::new());
    std::thread::scope(|scope| {
        for _ in 0..THREADS {
            scope.spawn(|| {
                while let Some((name, recipe)) = queue.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let start = Instant::now();
                    let outcome = recipe.compute(extent).map_err(|error| format!("{name}: {error}"));
                    let seconds = start.elapsed().as_secs_f64();
                    if let Ok(mut done) = done.lock() {
                        done.insert(*name, outcome.map(|figure| (figure, seconds)));
                        println!("{} of {}: {name}, {seconds:.1} s", done.len(), recipes.len());
                    }
                }
            });
        }
    });
    let mut done = done.into_inner().map_err(|error| error.to_string())?;
    recipes
        .iter()
        .map(|(name, _)| done.remove(name).unwrap_or_else(|| Err(format!("{name} was not computed"))))
        .collect()
}
