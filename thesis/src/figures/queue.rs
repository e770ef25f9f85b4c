//! Figures computed side by side.

use super::{Extent, Figure, Recipe};
use std::collections::BTreeMap;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

const THREADS: usize = 2;

/// Time \[s] that this thread has computed, as Linux counts it; elsewhere time that has passed since `start`.
fn computed(start: Instant) -> f64 {
    let counted = std::fs::read_to_string("/proc/thread-self/schedstat").ok();
    let nanoseconds = counted.and_then(|text| text.split(' ').next()?.parse::<f64>().ok());
    nanoseconds.map_or_else(|| start.elapsed().as_secs_f64(), |time| 1e-9 * time)
}

/// Figures in the order of their recipes, each with its computing time \[s], computed on two threads. A line is said
/// after each.
pub fn compute(
    recipes: &[&(&'static str, Recipe)],
    extent: Extent,
    say: impl Fn(&str) + Sync,
) -> Result<Vec<(Figure, f64)>, String> {
    // Those that grow in full take longest and begin; later papers have the larger ones.
    let (mut queue, fixed): (Vec<_>, Vec<_>) = recipes.iter().rev().copied().partition(|(_, recipe)| recipe.grows());
    queue.extend(fixed);
    let (next, start) = (AtomicUsize::new(0), Instant::now());
    let done = Mutex::new(BTreeMap::new());
    std::thread::scope(|scope| {
        for _ in 0..THREADS {
            scope.spawn(|| {
                while let Some((name, recipe)) = queue.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let before = computed(start);
                    let outcome = recipe.compute(extent).map_err(|error| format!("{name}: {error}"));
                    let seconds = computed(start) - before;
                    if let Ok(mut done) = done.lock() {
                        done.insert(*name, outcome.map(|figure| (figure, seconds)));
                        say(&format!("{} of {}: {name}, {seconds:.1} s", done.len(), recipes.len()));
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
