//! Energy on waves with stiffness-proportional damping: what is missing within a wave is the work of the contact on the slope of the
//! late dent, which the damped layer, fixed in the frame, does not take up.

mod common;

use common::{KMH, model, prescribed, preset};
use nalgebra::{DMatrix, DVector};
use wheelrail::config::Config;
use wheelrail::mechanics::{self, Basis};
use wheelrail::simulation::{Outputs, Simulation};

const LENGTH: f64 = 0.05;
const STEPS: usize = 80;

fn waved(damping: f64) -> Config {
    let mut config = preset("paper_a", 10);
    config.thermal.enabled = false;
    config.damping.rayleigh_stiffness = damping;
    config.tuning.tolerance = 0.0;
    config.rail.profile = format!("sinusoid(amplitude = 5e-6, wavelength = {LENGTH:?})");
    config
}

/// Residual flexibility of wheel and rail [m/(N/m)], and the distances of the nodes beside each node [m].
fn layers() -> ([DMatrix<f64>; 2], Vec<f64>) {
    let config = waved(0.0);
    let basis = Basis::compute(&config, &mut |_, _| {}).unwrap();
    let pair = mechanics::bodies(&config, Some(basis), &mut |_, _| {}).unwrap();
    // In very short steps the modes do not answer.
    let stiff = [&pair.wheel, &pair.rail].map(|body| body.operator(1e9).unwrap().surface);
    let x = &pair.surface_x;
    let span = (0..x.len()).map(|i| x[(i + 1).min(x.len() - 1)] - x[i.saturating_sub(1)]).collect();
    (stiff, span)
}

/// `Σ λ·D u` [N].
fn on_slope(forces: &DVector<f64>, u: &DVector<f64>, span: &[f64]) -> f64 {
    (2..forces.len() - 2).map(|p| forces[p] * (u[p + 2] - u[p - 2]) / span[p / 2]).sum()
}

/// `Σ (λ_n u_x − λ_t u_y)` [N].
fn on_turn(forces: &DVector<f64>, u: &DVector<f64>) -> f64 {
    (0..forces.len() / 2).map(|i| forces[2 * i + 1] * u[2 * i] - forces[2 * i] * u[2 * i + 1]).sum()
}

fn missing(o: &Outputs) -> f64 {
    o.hub_work - o.stored_energy - o.friction_energy - o.damping_energy
}

#[test]
fn the_energy_that_is_missing_within_a_wave_is_that_of_the_late_dent_in_the_stream() {
    let (flexibility, span) = layers();
    let model = model(waved(1e-4));
    let (velocity, radius) = (75.0 * KMH, model.config().wheel.radius);
    let mut inputs = prescribed(&model, velocity, 0.0);
    inputs.drive.friction = 0.0;
    let mut simulation = Simulation::new(model, &inputs).unwrap();
    let step = LENGTH / velocity / STEPS as f64;
    let power = |simulation: &Simulation| -> f64 {
        let state = simulation.state();
        let of = |body: usize, late: &DVector<f64>| {
            let (forces, u) = (&state.contact.traction.loads[body], &flexibility[body] * late);
            let turn = if body == 0 { on_turn(forces, &u) / radius } else { 0.0 };
            -velocity * (on_slope(forces, &u, &span) - turn)
        };
        of(0, &state.wheel.retarded.now) + of(1, &state.rail.retarded.now)
    };
    let (mut taken, mut before) = (0.0, power(&simulation));
    let (mut worst, mut largest) = (0.0f64, 0.0f64);
    for k in 1..=5 * STEPS {
        simulation.advance(&inputs, step).unwrap();
        let now = power(&simulation);
        taken += 0.5 * step * (before + now);
        before = now;
        let o = simulation.outputs();
        if k % (STEPS / 8) == 0 {
            println!(
                "{:.3} waves: dissipated {:9.4} J, missing {:9.4} J, late dent {:9.4} J, rest {:9.4} J",
                k as f64 / STEPS as f64,
                o.damping_energy,
                missing(o),
                taken,
                missing(o) - taken
            );
        }
        worst = worst.max((missing(o) - taken).abs());
        largest = largest.max(missing(o).abs());
    }
    println!("missing at most {largest:.4} J, without the late dent {worst:.4} J");
    assert!(worst < 0.2 * largest, "{worst} {largest}");
}
