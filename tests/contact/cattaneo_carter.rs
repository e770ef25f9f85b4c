//! From Cattaneo's shift to Carter's rolling: a wheel at rest is loaded by a moment below the friction limit, then
//! rolls slowly under the constant moment.
//!
//! The creepage is compared over the distance rolled, under a prescribed tangential force. With prescribed
//! creepage the force would build up over a distance that grows with the logarithm of the size of the bodies, because
//! the tangential displacement of a half-plane under a line load is known only up to a constant times the force. Under
//! constant force that constant has no rate: the creepage depends on s/a, F/μP and the full slip μa/R alone. What is
//! left of the finite bodies is the creepage of free rolling, which is subtracted.
//!
//! The reference is Kalker's incremental method (J. J. Kalker, *Wear* 16 (1971), for two half-planes): the rod of cells
//! moves by exactly one cell per increment, so that the displacement before is known at the nodes.

use crate::common::{self, model, prescribed, preset};
use nalgebra::{DMatrix, DVector};
use wheelrail::analytic::{carter_full_slip, contact_modulus, hertz_half_width};
use wheelrail::simulation::{Inputs, Rotation, Simulation, Translation};

/// Distances rolled over half-width.
const DISTANCES: [f64; 8] = [0.04, 0.25, 0.5, 1.0, 1.5, 2.0, 3.0, 4.0];
/// Tangential force over its limit.
const SHARE: f64 = 0.6;

/// Two half-planes with a patch of half-width 1, pressure `√(1 − x²)`, μ = 1; constant shear in `n` cells.
struct Rods {
    n: usize,
    h: f64,
    limit: Vec<f64>,
    /// `u_i = Σ_j A_(i−j) q_j`, scaled so that full slip has the creepage 1.
    kernel: Vec<f64>,
}

impl Rods {
    fn new(n: usize) -> Self {
        let h = 2.0 / n as f64;
        // −∫ ln|x − s| ds over a cell at a distance of k cells, without constants.
        let part = |x: f64| x * x.abs().max(1e-300).ln();
        let kernel = (0..=n).map(|k| k as f64 * h);
        let kernel = kernel.map(|x| (part(x - 0.5 * h) - part(x + 0.5 * h)) / std::f64::consts::PI).collect();
        let x = |i: usize| -1.0 + (i as f64 + 0.5) * h;
        Self { n, h, limit: (0..n).map(|i| (1.0 - x(i) * x(i)).sqrt()).collect(), kernel }
    }

    /// Displacement at cell `i` by shear in the cells, with `i = n` one cell ahead of the patch.
    fn displacement(&self, i: usize, q: &DVector<f64>) -> f64 {
        (0..self.n).map(|j| self.kernel[i.abs_diff(j)] * q[j]).sum()
    }

    /// Shear under the force `SHARE` of the limit: every cell either keeps its distance from `before` but for a common
    /// shift, or slips forward. Returns the shear and the shift.
    fn solve(&self, before: &DVector<f64>, stuck: &mut [bool]) -> (DVector<f64>, f64) {
        let force = SHARE * self.limit.iter().sum::<f64>();
        for _ in 0..100 {
            let cells: Vec<usize> = (0..self.n).filter(|&i| stuck[i]).collect();
            let m = cells.len();
            let slipping = DVector::from_fn(self.n, |i, _| if stuck[i] { 0.0 } else { self.limit[i] });
            let system = DMatrix::from_fn(m + 1, m + 1, |r, c| match (r < m, c < m) {
                (true, true) => self.kernel[cells[r].abs_diff(cells[c])],
                (false, false) => 0.0,
                _ => 1.0,
            });
            let rhs = DVector::from_fn(m + 1, |r, _| match cells.get(r) {
                Some(&i) => before[i] - self.displacement(i, &slipping),
                None => force - slipping.sum(),
            });
            let solution = system.lu().solve(&rhs).unwrap();
            let (mut q, shift) = (slipping, solution[m]);
            cells.iter().enumerate().for_each(|(r, &i)| q[i] = solution[r]);
            let mut changed = false;
            for i in 0..self.n {
                let stays = if stuck[i] {
                    q[i] <= self.limit[i]
                } else {
                    // A cell that would be dragged backwards by more than the common shift sticks.
                    self.displacement(i, &q) + shift > before[i]
                };
                changed |= stays != stuck[i];
                stuck[i] = stays;
            }
            if !changed {
                return (q, shift);
            }
        }
        panic!("no consistent stick zone")
    }
}

/// Creepage over that of full slip after each distance.
fn reference(n: usize) -> Vec<f64> {
    let rods = Rods::new(n);
    let mut stuck = vec![true; n];
    let (mut q, _) = rods.solve(&DVector::zeros(n), &mut stuck);
    let steps = (DISTANCES[7] / rods.h).round() as usize;
    let creepage: Vec<f64> = (0..steps)
        .map(|_| {
            // The material moves backwards by one cell; what was ahead of the patch enters it.
            let before = DVector::from_fn(n, |i, _| rods.displacement(i + 1, &q));
            let (next, shift) = rods.solve(&before, &mut stuck);
            q = next;
            -shift / rods.h
        })
        .collect();
    // The creepage of an increment is that at its middle.
    DISTANCES.iter().map(|s| interpolate(&creepage, s / rods.h - 0.5)).collect()
}

fn interpolate(values: &[f64], position: f64) -> f64 {
    let i = (position.max(0.0) as usize).min(values.len() - 2);
    values[i] + (position - i as f64) * (values[i + 1] - values[i])
}

/// Answer of the model under a tangential force of `load` times its limit, with steps of `share` half-widths.
fn rolled(load: f64, share: f64) -> Vec<f64> {
    let mut config = preset("paper_d", 20);
    config.physics.centrifugal = false;
    config.thermal.enabled = false;
    let model = model(config);
    let config = model.config();
    let (radius, friction) = (config.wheel.radius, config.friction.coefficient);
    let modulus = contact_modulus(config.material.youngs_modulus, config.material.poissons_ratio);
    let half_width = hertz_half_width(config.model.nominal_load / config.model.contact_width, radius, modulus);
    let full_slip = carter_full_slip(friction, half_width, radius);
    // So slow that inertia means nothing.
    let velocity = 1e-4;
    let dt = share * half_width / velocity;

    let mut inputs: Inputs = prescribed(&model, 0.0, 0.0);
    let mut simulation = Simulation::new(model.clone(), &inputs).unwrap();
    inputs.rotation = Rotation::Moment;
    inputs.translation = Translation::Velocity;
    for k in 1..=40 {
        inputs.drive.moment = load * friction * config.model.nominal_load * radius * k as f64 / 40.0;
        simulation.advance(&inputs, dt).unwrap();
    }
    let utilisation = || common::signed_utilisation(&simulation, friction);
    assert!((utilisation() - load).abs() < 1e-4, "at rest {}", utilisation());
    inputs.drive.velocity = velocity;
    let steps = (DISTANCES[7] / share).round() as usize;
    let creepage: Vec<f64> = (0..steps)
        .map(|_| {
            simulation.advance(&inputs, dt).unwrap();
            let outputs = simulation.outputs();
            (radius * outputs.wheel_omega - outputs.wheel_velocity) / outputs.wheel_velocity / full_slip
        })
        .collect();
    let utilisation = common::signed_utilisation(&simulation, friction);
    assert!((utilisation - load).abs() < 1e-4, "rolled {utilisation}");
    DISTANCES.iter().map(|s| interpolate(&creepage, s / share - 0.5)).collect()
}

#[test]
fn creepage_after_cattaneo_develops_to_carter() {
    let carter = 1.0 - (1.0 - SHARE).sqrt();
    let [coarse, fine] = [100, 200].map(reference);
    let (loaded, free) = (rolled(SHARE, 0.02), rolled(0.0, 0.02));
    // Near s = a the edge of the slip zone that the shift left at the leading edge reaches the stick zone of rolling:
    // the creepage has a sharp peak, which a spacing of a/20 rounds off.
    let tolerances = [0.003, 0.003, 0.003, 0.03, 0.007, 0.005, 0.003, 0.003];
    for (k, tolerance) in tolerances.into_iter().enumerate() {
        let found = loaded[k] - free[k];
        println!("s = {:4.2} a: {found:.5}, reference {:.5} (coarse {:.5})", DISTANCES[k], fine[k], coarse[k]);
        assert!((fine[k] - coarse[k]).abs() < 1.5e-3, "the reference has not converged at {} a", DISTANCES[k]);
        assert!((found - fine[k]).abs() < tolerance, "s = {} a: {found} against {}", DISTANCES[k], fine[k]);
    }
    let found = loaded[7] - free[7];
    let off = |k: usize| loaded[k] - free[k] - fine[k];
    common::figure("cattaneo", &[0, 1, 2, 4, 5, 6, 7].map(off));
    common::figure_within(0.01, "cattaneo.peak", &[loaded[3] - free[3]]);
    common::figure_within(1e-3, "cattaneo.late", &[found]);
    println!("after 4 a: {found:.5}, Carter {carter:.5}");
    assert!((found - carter).abs() < 2e-3, "{found} against Carter's {carter}");
}
