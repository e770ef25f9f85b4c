//! Sub-grid observables of the contact patch: they vary smoothly while the edges move between nodes.

use super::streamline::edge_offset;
use super::{ContactGrid, ContactSolution, Status, patches};

/// What one wants to know of a contact patch.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Patch {
    /// Half of the distance between the outermost contact edges [m].
    pub half_width: f64,
    /// Largest pressure [Pa].
    pub pressure_max: f64,
    /// Share of the contact length that sticks [1].
    pub stick_fraction: f64,
}

/// Observables of a solution; zero without contact.
pub fn observe(grid: &ContactGrid, solution: &ContactSolution, friction: f64) -> Patch {
    let runs = patches(&solution.status);
    let (Some(first), Some(last)) = (runs.first(), runs.last()) else { return Patch::default() };
    let normal: Vec<f64> = (0..grid.len()).map(|i| solution.normal(grid, i)).collect();
    let h = grid.spacing;
    let offset = |edge: usize, inner: usize| edge_offset(normal[edge], if edge == inner { 0.0 } else { normal[inner] });
    let left = grid.x[first.start] - h * offset(first.start, (first.start + 1).min(first.end - 1));
    let right = grid.x[last.end - 1] + h * offset(last.end - 1, (last.end - 1).max(last.start + 1) - 1);
    let half_width = 0.5 * (right - left);

    let peak = normal.iter().cloned().fold(0.0, f64::max);
    let samples: Vec<(f64, f64)> =
        (0..grid.len()).filter(|&i| normal[i] > 0.3 * peak).map(|i| (grid.x[i] / h, (normal[i] / h).powi(2))).collect();
    let pressure_max = parabola_peak(&samples).map_or(peak / h, f64::sqrt);

    let length: f64 = runs.iter().map(|r| r.len() as f64).sum();
    let stick: f64 = runs.iter().map(|r| stick_length(grid, solution, r.clone(), friction)).sum();
    Patch { half_width, pressure_max, stick_fraction: (stick / length).clamp(0.0, 1.0) }
}

/// Length of the stick zone of one run in cells; its boundary between stick and slip is found below grid scale from
/// the quadratic through `(μp − |t|)²` at the three outermost stuck nodes.
fn stick_length(grid: &ContactGrid, solution: &ContactSolution, run: std::ops::Range<usize>, friction: f64) -> f64 {
    let stuck: Vec<usize> = run.clone().filter(|&i| solution.status[i] == Status::Stick).collect();
    let (Some(&low), Some(&high)) = (stuck.first(), stuck.last()) else { return 0.0 };
    let margin = |i: usize| (friction * solution.normal(grid, i) - solution.tangential(grid, i).abs()).max(0.0).powi(2);
    let beyond = |edge: usize, inward: isize| {
        let at_end = if inward < 0 { edge + 1 >= run.end } else { edge <= run.start };
        if at_end || high - low < 2 {
            return 0.5;
        }
        let at = |k: isize| margin((edge as isize + k * inward) as usize);
        let (f0, f1, f2) = (at(0), at(1), at(2));
        // f(s) = f0 + b s + c s² with s in cells towards the inside; its root lies at s in [−1, 0].
        let (b, c) = (2.0 * f1 - 1.5 * f0 - 0.5 * f2, 0.5 * (f0 + f2) - f1);
        let discriminant = b * b - 4.0 * c * f0;
        if b <= 0.0 || discriminant < 0.0 {
            return 0.5;
        }
        (2.0 * f0 / (b + discriminant.sqrt())).clamp(0.0, 1.0)
    };
    (high - low) as f64 + beyond(low, 1) + beyond(high, -1)
}

/// Maximum of the least-squares parabola through `(x, y)`; `None` if it has none.
fn parabola_peak(samples: &[(f64, f64)]) -> Option<f64> {
    if samples.len() < 3 {
        return None;
    }
    let mut normal = nalgebra::Matrix3::<f64>::zeros();
    let mut rhs = nalgebra::Vector3::<f64>::zeros();
    for &(x, y) in samples {
        let row = nalgebra::Vector3::new(1.0, x, x * x);
        normal += row * row.transpose();
        rhs += row * y;
    }
    let c = normal.lu().solve(&rhs)?;
    (c[2] < 0.0).then(|| c[0] - 0.25 * c[1] * c[1] / c[2]).filter(|p| *p > 0.0)
}
