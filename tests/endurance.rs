//! Half a minute of mixed driving; `examples/ex03_endurance` is the same without end.

#[path = "../examples/ex03_endurance/scenario.rs"]
mod scenario;

mod common;
mod heap;
use scenario::{Drive, PHASES};

#[test]
fn thirty_thousand_steps_of_mixed_driving_keep_energy_and_memory() {
    let mut config = common::preset("railway", 10);
    config.initial.velocity = 0.0;
    let mut drive = Drive::new(common::model(config), 1e-3).unwrap();
    let (mut worst, mut start) = (0.0f64, 0);
    for k in 0..30_000 {
        drive.step().unwrap_or_else(|error| panic!("step {k}, {:?}: {error}", drive.phase));
        // By then everything has happened twice: wide patches, hot places of the tread.
        if k == 20_000 {
            start = heap::held();
        }
        if drive.cycles > 0 {
            worst = worst.max(drive.simulation.outputs().energy_residual.abs());
        }
    }
    let growth = (heap::held() - start) / 1024;
    println!("{} cycles, energy residual {worst:.2e}, memory growth {growth} kB", drive.cycles);
    for (phase, balance) in PHASES.iter().zip(drive.balances) {
        assert!(balance.steps > 0, "{phase:?} never happened");
    }
    assert!(drive.cycles >= 2, "{}", drive.cycles);
    assert!(worst < 0.01, "{worst}");
    // Every slide may leave one more hot place, of which eight are kept.
    assert!(growth < 256, "{growth} kB");
    let outputs = drive.simulation.outputs();
    assert!(outputs.heat_residual.abs() < 1e-9, "{}", outputs.heat_residual);
}
