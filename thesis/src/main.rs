//! `wheelrail-thesis [--full] [--accept] [--page] [--out DIR] [ITEM…]`: recomputes figures of the thesis on two threads
//! and writes the report.
//!
//! Ends with an error if a figure shows something else than it must, a quoted number has the wrong status, a value is
//! not the one of `thesis/values.csv` (without `--full`), or the tables of `docs/thesis.md` are not those of these
//! values. `--accept` writes both anew, if nothing else is wrong; `--page` writes the page from the values that are
//! there and recomputes nothing. How long it took is said, and fails nothing.

use std::collections::BTreeMap;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;
use wheelrail_thesis::figures::{self, ALL, Extent, Figure};
use wheelrail_thesis::{page, paper_a, quoted, report};

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("{message}");
            ExitCode::FAILURE
        }
    }
}

/// Writes a file and says so.
fn write(file: &Path, text: &str) -> Result<(), String> {
    std::fs::write(file, text).map_err(|error| format!("{}: {error}", file.display()))?;
    say(&file.display().to_string());
    Ok(())
}

/// Wishes of the command line.
struct Options {
    out: PathBuf,
    wanted: Vec<String>,
    extent: Extent,
    accept: bool,
    page: bool,
}

fn options() -> Result<Options, String> {
    let mut options = Options {
        out: PathBuf::from("results/thesis"),
        wanted: Vec::new(),
        extent: Extent::Quick,
        accept: false,
        page: false,
    };
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        match argument.as_str() {
            "--full" => options.extent = Extent::Full,
            "--accept" => options.accept = true,
            "--page" => options.page = true,
            "--out" => options.out = arguments.next().ok_or("--out needs a directory")?.into(),
            item if ALL.iter().any(|(name, _)| *name == item) => options.wanted.push(argument),
            other => {
                let names: Vec<&str> = ALL.iter().map(|(name, _)| *name).collect();
                return Err(format!("{other} is not recomputed; there are {names:?}"));
            }
        }
    }
    if options.accept && (options.extent == Extent::Full || !options.wanted.is_empty()) {
        return Err("--accept keeps the values of all figures in their quick extent: neither --full nor items".into());
    }
    Ok(options)
}

fn run() -> Result<(), String> {
    let Options { out, wanted, extent, accept, page: only_page } = options()?;
    if only_page {
        let [written, _] = page::current(report::COMMITTED)?;
        return write(&page::path(), &written);
    }
    let recipes: Vec<_> =
        ALL.iter().filter(|(name, _)| wanted.is_empty() || wanted.iter().any(|w| w == name)).collect();
    let start = Instant::now();
    let figures = figures::compute(&recipes, extent, say)?;
    let (seconds, computed) = (start.elapsed().as_secs_f64(), figures.iter().map(|(_, time)| time).sum::<f64>());
    say(&format!("{seconds:.0} s in all, {computed:.0} s of computing; {}", slowest(&figures)));
    let values: BTreeMap<String, f64> = figures.iter().flat_map(|(figure, _)| figure.values.clone()).collect();
    let quoted = quoted::all()?;
    std::fs::create_dir_all(&out).map_err(|error| format!("{}: {error}", out.display()))?;
    let pace = pace()?;
    say(&format!("a step of the product takes {:.0} µs", 1e6 * pace));
    // The last file is for thesis/baseline.m.
    for (name, text) in [
        ("index.html", report::html(&figures, &quoted)?),
        ("values.csv", report::csv(&figures)),
        ("step.txt", format!("{pace:e}\n")),
    ] {
        write(&out.join(name), &text)?;
    }
    let mut wrong: Vec<String> = figures.iter().flat_map(|(figure, _)| figure.flaws()).collect();
    if wanted.is_empty() {
        for entry in &quoted {
            if !entry.holds(&values)? {
                wrong.push(format!("{} {}: {} is the wrong status", entry.item, entry.quantity, entry.status.name()));
            }
        }
    }
    if accept && wrong.is_empty() {
        return keep(&report::csv(&figures), &quoted);
    }
    if wanted.is_empty() && extent == Extent::Quick {
        wrong.extend(report::departures(report::COMMITTED, &report::csv(&figures)));
        let [written, there] = page::current(report::COMMITTED)?;
        if written != there {
            wrong.push("the tables of docs/thesis.md are not those of thesis/values.csv: --page writes them".into());
        }
    }
    if wrong.is_empty() { Ok(()) } else { Err(wrong.join("\n")) }
}

/// Writes the values that later runs are compared with, and the page that tells them.
fn keep(values: &str, quoted: &[quoted::Quoted]) -> Result<(), String> {
    write(Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/values.csv")), values)?;
    let there = std::fs::read_to_string(page::path()).map_err(|error| error.to_string())?;
    write(&page::path(), &page::page(&there, &page::names(values, quoted)?)?)
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
