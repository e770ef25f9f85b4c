//! From an instantiated wheel to one that is ready.

use crate::library::Library;
use crate::runner::{Process, job};
use crate::worker::Answer;
use std::fs;
use std::path::Path;

/// Wall time and CPU time of all threads \[s].
#[derive(Clone, Copy)]
pub struct Spent {
    pub wall: f64,
    pub cpu: f64,
}

/// Start of a library for which nothing is stored, and the next one.
pub struct Starts {
    pub cold: Spent,
    pub stored: Spent,
}

/// A load that no preset has \[N].
const LOAD: &str = "107000";

fn start(library: &Library, cache: &Path) -> Result<Spent, String> {
    let load = vec![("model.nominal_load".to_owned(), LOAD.to_owned())];
    match Process::start(library, &job(library, load, None), cache)?.answer()? {
        Answer::Ready { wall, cpu } => Ok(Spent { wall, cpu }),
        _ => Err(format!("{}: no times of the start", library.label)),
    }
}

/// Smallest times of several starts, in turn.
pub fn measure(libraries: &[Library], repeats: u32) -> Result<Vec<Starts>, String> {
    let never = Spent { wall: f64::INFINITY, cpu: f64::INFINITY };
    let mut least: Vec<_> = libraries.iter().map(|_| Starts { cold: never, stored: never }).collect();
    for _ in 0..repeats {
        for (library, least) in libraries.iter().zip(&mut least) {
            let cache = library.cache.with_extension(std::process::id().to_string());
            fs::create_dir_all(&cache).map_err(|error| format!("{}: {error}", cache.display()))?;
            let spent = start(library, &cache).and_then(|cold| Ok([cold, start(library, &cache)?]));
            fs::remove_dir_all(&cache).map_err(|error| format!("{}: {error}", cache.display()))?;
            for (least, spent) in [&mut least.cold, &mut least.stored].into_iter().zip(spent?) {
                *least = Spent { wall: least.wall.min(spent.wall), cpu: least.cpu.min(spent.cpu) };
            }
        }
    }
    Ok(least)
}
