//! `wheelrail-thesis [--full] [--out DIR] [ITEM…]`: recomputes figures of the thesis on two threads and writes the
//! report.
//!
//! Ends with an error if a figure shows something else than it must, a quoted number has the wrong status, or, of all
//! figures without `--full`, if a value is not the one of `thesis/values.csv`. How long it took is said, and fails
//! nothing.

use std::collections::BTreeMap;
use std::io::Write;
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Instant;
use wheelrail_thesis::figures::{self, ALL, Extent, Figure};
use wheelrail_thesis::{paper_a, quoted, report};

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
    let figures = figures::compute(&recipes, extent, say)?;
    let seconds = start.elapsed().as_secs_f64();
    say(&format!("{seconds:.0} s in all; {}", slowest(&figures)));
    let values: BTreeMap<String, f64> = figures.iter().flat_map(|(figure, _)| figure.values.clone()).collect();
    let quoted = quoted::all()?;
    std::fs::create_dir_all(&out).map_err(|error| format!("{}: {error}", out.display()))?;
    let pace = pace()?;
    say(&format!("a step of the product takes {:.0} µs", 1e6 * pace));
    // The last file is for thesis/baseline.m.
    for (name, text) in [
        ("index.html", report::html(&figures, &quoted)),
        ("values.csv", report::csv(&figures)),
        ("step.txt", format!("{pace:e}\n")),
    ] {
        let file = out.join(name);
        std::fs::write(&file, text).map_err(|error| format!("{}: {error}", file.display()))?;
        say(&file.display().to_string());
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
    }
    if wrong.is_empty() { Ok(()) } else { Err(wrong.join("\n")) }
}

/// Writes a line. If nobody reads any more, the work goes on.
fn say(line: &str) {
    let _ = writeln!(std::io::stdout(), "{line}");
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
