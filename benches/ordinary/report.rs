//! The table, and the same numbers as JSON.

use crate::cases::{CYCLE, Drive};
use crate::library::Library;
use crate::runner::Run;
use crate::starts::Starts;
use serde_json::{Map, Value, json};
use std::path::Path;

/// Times of the steps of a run \[s].
struct Times {
    mean: f64,
    median: f64,
    p99: f64,
    max: f64,
    /// Internal steps per communication step.
    internal: f64,
    /// Mean of the last second over that of the first, of a run of many.
    growth: Option<f64>,
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

impl Times {
    fn of(run: &Run, drive: &Drive) -> Times {
        let mut sorted = run.times.clone();
        sorted.sort_by(f64::total_cmp);
        let quantile = |share: f64| sorted[((share * sorted.len() as f64).ceil() as usize).clamp(1, sorted.len()) - 1];
        let second = (CYCLE / drive.step).round() as usize;
        let growth = (run.times.len() > 2 * second)
            .then(|| mean(&run.times[run.times.len() - second..]) / mean(&run.times[..second]));
        let internal = run.internal.iter().map(|&count| f64::from(count)).sum::<f64>() / run.internal.len() as f64;
        Times {
            mean: mean(&run.times),
            median: quantile(0.5),
            p99: quantile(0.99),
            max: quantile(1.0),
            internal,
            growth,
        }
    }

    fn json(&self, run: &Run) -> Value {
        json!({
            "mean": self.mean, "p50": self.median, "p99": self.p99, "max": self.max,
            "internal_steps_per_step": self.internal, "last_second_over_first": self.growth,
            "times": run.times, "internal_steps": run.internal,
            "end": run.end.iter().cloned().collect::<std::collections::BTreeMap<_, _>>(),
        })
    }
}

/// Rows as they are printed and kept.
pub struct Report {
    labels: Vec<&'static str>,
    rows: Map<String, Value>,
    programs: Map<String, Value>,
}

impl Report {
    pub fn new(libraries: &[Library]) -> Report {
        println!("times of a step in µs of CPU; p50, p99 and max over the mean; inner: internal steps per step");
        println!(
            "{:16} {:7} {:>8} {:>6} {:>6} {:>6} {:>9} {:>6} {:>6} {:>6}  at the end: m/s, rad/s, kN, K",
            "case", "", "mean", "p50", "p99", "max", "max µs", "inner", "ratio", "of max"
        );
        let program = |library: &Library| {
            let settings: Map<_, _> =
                library.settings.iter().map(|(name, value)| (name.clone(), value.clone().into())).collect();
            (library.label.to_owned(), json!({"library": library.binary, "settings": settings}))
        };
        Report {
            labels: libraries.iter().map(|library| library.label).collect(),
            rows: Map::new(),
            programs: libraries.iter().map(program).collect(),
        }
    }

    pub fn drive(&mut self, drive: &Drive, runs: &[Run]) {
        let mut row = Map::new();
        let times: Vec<_> = runs.iter().map(|run| Times::of(run, drive)).collect();
        let first = &times[0];
        let ratios = |times: &Times, first: &Times| [times.mean / first.mean, times.max / first.max];
        for (k, ((label, times), run)) in self.labels.iter().zip(&times).zip(runs).enumerate() {
            let [of_mean, of_max] = ratios(times, first);
            let ratio = if k > 0 { format!("{of_mean:6.3} {of_max:6.3}") } else { String::new() };
            let scaled = [times.median, times.p99, times.max].map(|time| time / times.mean);
            let end: Vec<f64> = run.end.iter().map(|(_, value)| *value).collect();
            println!(
                "{:16} {label:7} {:8.1} {:6.2} {:6.2} {:6.2} {:9.1} {:6.2} {ratio:13}  {:.3} {:.3} {:.2} {:.1}{}",
                if k == 0 { drive.name } else { "" },
                1e6 * times.mean,
                scaled[0],
                scaled[1],
                scaled[2],
                1e6 * times.max,
                times.internal,
                end[0],
                end[1],
                1e-3 * end[2],
                end[3],
                times.growth.map_or(String::new(), |growth| format!("; last second over first {growth:.2}")),
            );
            row.insert((*label).into(), times.json(run));
        }
        if times.len() > 1 {
            let [of_mean, of_max] = ratios(&times[1], &times[0]);
            row.insert("ratio".into(), of_mean.into());
            row.insert("ratio_of_max".into(), of_max.into());
        }
        self.rows.insert(drive.name.into(), row.into());
    }

    pub fn starts(&mut self, starts: &[Starts]) {
        let mut row = Map::new();
        for (name, of) in [("nothing stored", (|s| s.cold) as fn(&Starts) -> _), ("stored", |s| s.stored)] {
            for (k, (label, times)) in self.labels.iter().zip(starts).enumerate() {
                let (spent, before) = (of(times), of(&starts[0]));
                let ratio = if k > 0 { format!("; ratio {:.3}", spent.cpu / before.cpu) } else { String::new() };
                let title = format!("start, {name}");
                println!(
                    "{:22} {label:7} {:8.1} ms of CPU, {:8.1} ms{ratio}",
                    if k == 0 { title.as_str() } else { "" },
                    1e3 * spent.cpu,
                    1e3 * spent.wall
                );
                row.insert(format!("{label}, {name}"), json!({"cpu": spent.cpu, "wall": spent.wall}));
            }
        }
        self.rows.insert("start".into(), row.into());
    }

    /// Writes all numbers, times in seconds.
    pub fn write(&self, path: &Path) -> Result<(), String> {
        let text = json!({"programs": self.programs, "cases": self.rows});
        std::fs::write(path, format!("{text:#}\n")).map_err(|error| format!("{}: {error}", path.display()))
    }
}
