//! Cost of a step, of a start and of the reduced basis on the default mesh, one core.
//!
//! `cargo bench` prints medians; `make bench` (`table.rs`) is the table that docs/speed.md quotes.

use criterion::{Criterion, criterion_group, criterion_main};
use std::time::{Duration, Instant};
use wheelrail::config::Config;
use wheelrail::simulation::{BasisStore, Inputs, Model, Simulation};

/// A rolling wheel under a braking moment of about half the adhesion limit.
fn braking(model: std::sync::Arc<Model>) -> (Simulation, Inputs) {
    let mut inputs = Inputs::rolling(model.config());
    let mut simulation = Simulation::new(model, &inputs).expect("stationary state");
    inputs.drive.moment = -7000.0;
    for _ in 0..20 {
        simulation.advance(&inputs, 1e-3).expect("step");
    }
    (simulation, inputs)
}

/// Resident memory of this process [MB]; zero where it cannot be read.
fn resident() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find(|l| l.starts_with("VmRSS:")).and_then(|l| l.split_whitespace().nth(1));
    line.and_then(|kb| kb.parse::<f64>().ok()).unwrap_or(0.0) / 1024.0
}

fn steps(c: &mut Criterion) {
    let mut quiet = |_: &str, _: f64| {};
    let start = Instant::now();
    let model = Model::prepare(Config::default(), &BasisStore::none(), &mut quiet).expect("model");
    println!("reduced basis computed in {:.2} s", start.elapsed().as_secs_f64());
    let store = BasisStore::within(&std::env::temp_dir().join("wheelrail-bench"));
    let (_, bytes) = model.basis_file().expect("reduced model");
    println!("stored basis: {} kB", bytes.len() / 1024);
    store.keep(model.config(), &bytes).expect("stored basis");

    c.bench_function("start of a second simulation with a shared model", |b| {
        let inputs = Inputs::rolling(model.config());
        b.iter(|| Simulation::new(model.clone(), &inputs).expect("stationary state"))
    });
    c.bench_function("instantiate to ready with the stored basis", |b| {
        b.iter(|| {
            let model = Model::prepare(Config::default(), &store, &mut |_, _| {}).expect("model");
            let inputs = Inputs::rolling(model.config());
            Simulation::new(model, &inputs).expect("stationary state")
        })
    });
    let before = resident();
    let prepare = |_| braking(Model::prepare(Config::default(), &store, &mut |_, _| {}).expect("model"));
    let several: Vec<_> = (0..20).map(prepare).collect();
    println!("memory of a reduced simulation: {:.1} MB", (resident() - before) / several.len() as f64);
    let (mut simulation, inputs) = braking(model.clone());
    c.bench_function("reduced step 1 ms, braking", |b| b.iter(|| simulation.advance(&inputs, 1e-3).expect("step")));
    let (mut simulation, inputs) = braking(model);
    let mut k = 0u32;
    c.bench_function("reduced step of varying length, braking", |b| {
        b.iter(|| {
            k += 1;
            simulation.advance(&inputs, 1e-3 * (1.0 + 0.01 * f64::from(k % 50))).expect("step")
        })
    });
    let mut config = Config::default();
    config.thermal.enabled = false;
    let (mut simulation, inputs) = braking(Model::prepare(config, &store, &mut |_, _| {}).expect("model"));
    c.bench_function("step without heat 1 ms, braking", |b| {
        b.iter(|| simulation.advance(&inputs, 1e-3).expect("step"));
    });
    println!("state: {} kB", postcard::to_stdvec(simulation.state()).expect("bytes").len() / 1024);

    let mut config = Config::default();
    config.solver.reduced = false;
    let before = resident();
    let (mut simulation, inputs) = braking(Model::prepare(config, &BasisStore::none(), &mut quiet).expect("model"));
    println!("memory of a full simulation: {:.0} MB", resident() - before);
    c.bench_function("full step 1 ms, braking", |b| b.iter(|| simulation.advance(&inputs, 1e-3).expect("step")));
}

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(20).measurement_time(Duration::from_secs(3));
    targets = steps
}
criterion_main!(benches);
