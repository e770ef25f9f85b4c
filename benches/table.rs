//! One table of what everything costs, as times and as multiples of a fixed reference computation of the same run, so
//! that tables of different machines and days can be compared: `make bench`.
//!
//! Every number is the smallest of many short batches: other programs can only add to it. Each run appends one line of
//! JSON to `results/bench.jsonl`.

use nalgebra::DMatrix;
use serde_json::{Map, Value, json};
use std::hint::black_box;
use std::path::Path;
use std::sync::Arc;
use std::time::{Instant, SystemTime, UNIX_EPOCH};
use wheelrail::config::Config;
use wheelrail::fmi::presets;
use wheelrail::simulation::{BasisStore, Inputs, Model, Simulation, Translation};
use wheelrail::wheels::advance_all;

/// Where the history of runs is kept.
const HISTORY: &str = "results/bench.jsonl";
/// Batches of every measurement, and their length \[s].
const BATCHES: usize = 40;
const BATCH: f64 = 0.02;
/// Communication step \[s].
const STEP: f64 = 1e-3;
/// Wheels of a four-axle vehicle.
const WHEELS: usize = 8;

/// Smallest time of a call \[s], over batches.
fn fastest(mut call: impl FnMut()) -> f64 {
    let start = Instant::now();
    call();
    let calls = (BATCH / start.elapsed().as_secs_f64()).ceil().max(1.0);
    let batch = |_| {
        let start = Instant::now();
        (0..calls as usize).for_each(|_| call());
        start.elapsed().as_secs_f64() / calls
    };
    (0..BATCHES).map(batch).fold(f64::INFINITY, f64::min)
}

/// Time of one call \[s], and its result.
fn once<T>(call: impl FnOnce() -> T) -> (f64, T) {
    let start = Instant::now();
    let result = call();
    (start.elapsed().as_secs_f64(), result)
}

/// The default wheel with `elements` per half-width of the contact, with or without heat.
fn model(elements: usize, heat: bool, store: &BasisStore) -> Arc<Model> {
    let mut config = Config::default();
    config.mesh.elements_per_half_width = elements;
    config.thermal.enabled = heat;
    let model = Model::prepare(config, store, &mut |_, _| {}).expect("model");
    if let Some((_, bytes)) = model.basis_file() {
        store.keep(model.config(), &bytes).expect("stored basis");
    }
    model
}

/// Braking moment of about half the adhesion limit \[N m].
const MOMENT: f64 = -7000.0;

/// A wheel that rolls under a moment \[N m], and its inputs.
fn braking(model: &Arc<Model>, moment: f64) -> (Simulation, Inputs) {
    let mut inputs = Inputs::rolling(model.config());
    let mut simulation = Simulation::new(model.clone(), &inputs).expect("stationary state");
    inputs.drive.moment = moment;
    (0..20).for_each(|_| simulation.advance(&inputs, STEP).expect("step"));
    (simulation, inputs)
}

/// Time of a step \[s].
fn step(model: &Arc<Model>) -> f64 {
    let (mut simulation, inputs) = braking(model, MOMENT);
    fastest(|| simulation.advance(&inputs, STEP).expect("step"))
}

/// Resident memory of this process \[MB]; zero where it cannot be read.
fn resident() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find(|line| line.starts_with("VmRSS:")).and_then(|line| line.split_whitespace().nth(1));
    line.and_then(|kilobytes| kilobytes.parse::<f64>().ok()).unwrap_or(0.0) / 1024.0
}

/// The rows as they are printed and kept.
struct Table {
    reference: f64,
    rows: Map<String, Value>,
}

impl Table {
    fn time(&mut self, name: &str, seconds: f64) {
        println!("{name:<58} {:>10.1} µs {:>10.3}", 1e6 * seconds, seconds / self.reference);
        self.rows.insert(name.into(), json!({"seconds": seconds, "ratio": seconds / self.reference}));
    }

    fn number(&mut self, name: &str, value: f64, unit: &str) {
        println!("{name:<58} {value:>10.2} {unit}");
        self.rows.insert(name.into(), json!({"value": value, "unit": unit}));
    }
}

/// Step with and without heat, and its growth with the number of contact nodes.
fn steps(table: &mut Table, store: &BasisStore) {
    let [mut before, mut coupled_before] = [0.0; 2];
    for elements in [10, 20, 40] {
        let [cold, coupled] = [false, true].map(|heat| step(&model(elements, heat, store)));
        table.time(&format!("step without heat, {elements} elements per half-width"), cold);
        table.time(&format!("coupled step, {elements} elements per half-width"), coupled);
        table.time(&format!("  of it heat, {elements} elements per half-width"), coupled - cold);
        if before > 0.0 {
            let growth = |now: f64, before: f64| (now / before).log2();
            table.number("  growth without heat: exponent of the nodes", growth(cold, before), "");
            table.number("  growth coupled: exponent of the nodes", growth(coupled, coupled_before), "");
        }
        [before, coupled_before] = [cold, coupled];
    }
}

/// Drives of eight wheels: moments that are held, that vary by ±30 % in 40 ms, and brakes that lock the wheels at a speed
/// that is held.
const DRIVES: [&str; 3] = ["held", "varying", "slide"];
/// Torque that locks a wheel on a dry rail \[N m], and steps before what is measured and in it.
const LOCKING: f64 = 40e3;
const SETTLING: usize = 300;
const MEASURED: usize = 200;

/// Sets what a drive demands of a wheel in a step. Moments differ: equal wheels would share what belongs to their speeds.
fn demand(drive: &str, wheel: usize, step: usize, inputs: &mut Inputs) {
    let share = |steps: usize| (step as f64 / steps as f64 + wheel as f64 / WHEELS as f64).rem_euclid(1.0);
    let change = if drive == "varying" { 0.3 * (1.0 - 4.0 * (share(40) - 0.5).abs()) } else { 0.0 };
    match drive {
        "slide" => inputs.drive.torque = LOCKING * (step as f64 / 100.0).min(1.0),
        _ => inputs.drive.moment = (MOMENT + 100.0 * wheel as f64) * (1.0 + change),
    }
}

/// Simulated over wall time of eight wheels of a model, one after the other or on all cores.
fn speed_of_eight(model: &Arc<Model>, drive: &str, together: bool) -> f64 {
    let mut start = Inputs::rolling(model.config());
    if drive == "slide" {
        start.translation = Translation::Velocity;
    }
    let wheel = |_| Simulation::new(model.clone(), &start).expect("stationary state");
    let mut wheels: Vec<Simulation> = (0..WHEELS).map(wheel).collect();
    let mut inputs = vec![start; WHEELS];
    let mut measured = 0.0;
    for step in 0..SETTLING + MEASURED {
        inputs.iter_mut().enumerate().for_each(|(k, inputs)| demand(drive, k, step, inputs));
        let start = Instant::now();
        if together {
            assert!(advance_all(&mut wheels, &inputs, STEP).iter().all(Result::is_ok));
        } else {
            wheels.iter_mut().zip(&inputs).for_each(|(wheel, inputs)| wheel.advance(inputs, STEP).expect("step"));
        }
        measured += if step < SETTLING { 0.0 } else { start.elapsed().as_secs_f64() };
    }
    MEASURED as f64 * STEP / measured
}

/// Eight wheels on one line of contact and on seven, one after the other and on all cores.
fn wheels(table: &mut Table, store: &BasisStore) {
    for (lines, preset) in [("one line", "railway"), ("seven lines", "railway_ellipse")] {
        for (heat, name) in [(true, "with heat"), (false, "without heat")] {
            for drive in DRIVES {
                let mut config = presets::load(Some(Path::new("resources")), preset).expect("preset");
                config.thermal.enabled = heat;
                let model = Model::prepare(config, store, &mut |_, _| {}).expect("model");
                for (cores, together) in [("one core", false), ("all cores", true)] {
                    let name = format!("{WHEELS} wheels, {lines}, {name}, {drive}, {cores}: simulated / wall");
                    table.number(&name, speed_of_eight(&model, drive, together), "");
                }
            }
        }
    }
}

/// From parameters to a wheel that is ready.
fn starts(table: &mut Table, store: &BasisStore) {
    let mut changed = Config::default();
    changed.model.nominal_load *= 1.07;
    let ready = |config: Config, store: &BasisStore| {
        let model = Model::prepare(config, store, &mut |_, _| {}).expect("model");
        let inputs = Inputs::rolling(model.config());
        Simulation::new(model, &inputs).expect("stationary state")
    };
    table.time("start with a load for which nothing is stored", once(|| ready(changed, &BasisStore::none())).0);
    let mut large = Config::default();
    (large.mesh.elements_per_half_width, large.thermal.smallest_load_ratio) = (80, 0.05);
    let refusal = || assert!(Model::prepare(large.clone(), &BasisStore::none(), &mut |_, _| {}).is_err());
    table.time("refusal of a model that is too large", fastest(refusal));
    table.time("start with a stored basis", fastest(|| drop(ready(Config::default(), store))));
    let shared = model(20, true, store);
    let inputs = Inputs::rolling(shared.config());
    let second = || drop(black_box(Simulation::new(shared.clone(), &inputs).expect("stationary state")));
    table.time("start of a further equal wheel", fastest(second));
}

/// Memory that a wheel adds to the process: the mean over many, after as many others have used up what earlier
/// work left to spare.
fn memory(table: &mut Table, store: &BasisStore) {
    let shared = model(20, true, store);
    let some = || (0..150).map(|_| braking(&shared, MOMENT)).collect::<Vec<_>>();
    let first = some();
    let before = resident();
    let wheels = some();
    table.number("memory of a further equal wheel", (resident() - before) / wheels.len() as f64, "MB");
    drop(first);
}

fn main() {
    let matrix = DMatrix::from_fn(120, 120, |i, j| 1.0 / (1.0 + i as f64 + j as f64) + f64::from(u8::from(i == j)));
    let reference = fastest(|| drop(black_box(black_box(&matrix).clone().lu())));
    println!("{:<58} {:>13} {:>10}", "", "time", "ratio");
    let mut table = Table { reference, rows: Map::new() };
    table.time("reference: LU factors of a matrix of 120 rows", reference);
    let store = BasisStore::within(&std::env::temp_dir().join("wheelrail-bench"));
    memory(&mut table, &store);
    steps(&mut table, &store);
    wheels(&mut table, &store);
    starts(&mut table, &store);
    let seconds = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_secs());
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let version = env!("CARGO_PKG_VERSION");
    let line = json!({"time": seconds, "version": version, "cores": cores, "rows": table.rows});
    let kept = std::fs::create_dir_all("results").and_then(|()| {
        use std::io::Write;
        let mut file = std::fs::OpenOptions::new().create(true).append(true).open(HISTORY)?;
        writeln!(file, "{line}")
    });
    match kept {
        Ok(()) => println!("appended to {HISTORY}"),
        Err(error) => eprintln!("{HISTORY} cannot be written: {error}"),
    }
}
