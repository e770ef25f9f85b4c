//! Example 3: endurance. A million steps of mixed driving with the shipped `railway` wheel, through the Rust library.
//!
//! 1. A model from a configuration, a simulation from the model, starting from rest.
//! 2. A scenario of traction, coasting, braking, locked slides, wet and dry (`scenario.rs`), step by step.
//! 3. Failures, growth of memory and the energy audit, counted by phase of driving.
//!
//! `cargo run --release --example ex03_endurance -- --steps 1000000` prints failures, growth of memory and the energy
//! audit, by phase of driving, and fails if a limit is exceeded.

#[path = "../../tests/heap/mod.rs"]
mod heap;
mod scenario;

use clap::Parser;
use scenario::{Drive, PHASES};
use std::error::Error;
use std::time::Instant;
use wheelrail::config::Config;
use wheelrail::simulation::{BasisStore, Model};

/// Largest growth of the memory held after [`WARM_UP`] steps [kB].
const MEMORY: i64 = 256;
/// Steps until every buffer has its size: by then everything has happened twice.
const WARM_UP: u64 = 20_000;
/// Largest energy residual, from the end of the first cycle on [1].
const RESIDUAL: f64 = 0.01;

/// Mixed driving: failures, memory, energy audit.
#[derive(Parser)]
struct Arguments {
    /// Number of communication steps.
    #[arg(long, default_value_t = 1_000_000)]
    steps: u64,
    /// Communication step [s].
    #[arg(long, default_value_t = 1e-3)]
    step: f64,
}

fn main() -> Result<(), Box<dyn Error>> {
    let Arguments { steps, step } = Arguments::parse();
    let mut config = Config::default();
    config.initial.velocity = 0.0;
    let model = Model::shared(config, &BasisStore::of_user(), &mut |_, _| {})?;
    let mut drive = Drive::new(model, step)?;

    let (start, mut memory, mut failures, mut worst) = (Instant::now(), 0, 0u64, 0.0f64);
    for k in 0..steps {
        if let Err(error) = drive.step() {
            failures += 1;
            eprintln!("step {k}, {:?}: {error}", drive.phase);
        }
        if drive.cycles > 0 {
            worst = worst.max(drive.simulation.outputs().energy_residual.abs());
        }
        if k == WARM_UP.min(steps.saturating_sub(1)) {
            memory = heap::held();
        }
        if (k + 1).is_multiple_of(100_000) {
            eprintln!("{} of {steps} steps, {} cycles, {failures} failures", k + 1, drive.cycles);
        }
    }

    let (wall, outputs) = (start.elapsed().as_secs_f64(), drive.simulation.outputs());
    let growth = (heap::held() - memory) / 1024;
    println!("steps            {steps} of {step} s, {} cycles, {:.0} m", drive.cycles, outputs.wheel_distance);
    println!("wall time        {wall:.0} s, {:.3} ms per step", 1e3 * wall / steps as f64);
    println!("failures         {failures}");
    println!("memory growth    {growth} kB");
    println!("energy residual  {:+.2e} at the end, {worst:.2e} at worst after one cycle", outputs.energy_residual);
    println!("heat residual    {:+.2e}", outputs.heat_residual);
    println!("\nphase            steps   dissipated [J]   unaccounted [J]   share of all dissipation");
    let all: f64 = drive.balances.iter().map(|balance| balance.dissipation).sum();
    for (phase, b) in PHASES.iter().zip(&drive.balances) {
        let share = b.imbalance / all;
        println!(
            "{:<12} {:>9} {:>16.1} {:>17.2} {share:>+26.1e}",
            format!("{phase:?}"),
            b.steps,
            b.dissipation,
            b.imbalance
        );
    }
    let passed = failures == 0 && worst < RESIDUAL && growth < MEMORY;
    if passed { Ok(()) } else { Err("a limit is exceeded".into()) }
}
