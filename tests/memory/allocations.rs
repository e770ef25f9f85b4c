//! Heap allocations of a step: time spent in the allocator is time the model does not compute.

use crate::common::{self, model, preset};
use crate::heap;
use wheelrail::simulation::{Inputs, Simulation};

/// Allocations and bytes per step of 1 ms in a braking run, after the workspace has been filled.
fn per_step(thermal: bool) -> (f64, f64) {
    const STEPS: u64 = 200;
    let mut config = preset("railway", 20);
    config.thermal.enabled = thermal;
    let model = model(config);
    let mut inputs = Inputs::rolling(model.config());
    let mut simulation = Simulation::new(model, &inputs).unwrap();
    let mut run = |steps: u64| {
        for _ in 0..steps {
            inputs.drive.moment -= 20.0;
            simulation.advance(&inputs, 1e-3).unwrap();
        }
    };
    run(20);
    let (calls, bytes) = (heap::requests(), heap::requested_bytes());
    run(STEPS);
    let each = |now: u64, before: u64| (now - before) as f64 / STEPS as f64;
    (each(heap::requests(), calls), each(heap::requested_bytes(), bytes))
}

#[test]
fn a_reduced_coupled_step_allocates_less_than_sixty_eight_times() {
    let (calls, bytes) = per_step(true);
    let (mechanical, _) = per_step(false);
    common::figure("allocations", &[calls, mechanical]);
    println!("with heat {calls:.1} allocations, {bytes:.0} bytes; mechanics alone {mechanical:.1} allocations");
    assert!(calls < 68.0, "{calls} allocations per step");
}
