//! A locked wheel slides over a sharp hole: Paper D figures 19 to 21.

use super::holes::{extremes, hole};
use super::mesh_heat::half_width;
use super::{Figure, curve, largest, must};
use crate::ours::{Product, Run};
use crate::plot::{Curve, Plot, Source};
use crate::quoted::Status;
use wheelrail::config::Config;

/// Load [N/m] and velocity [m/s].
const LOAD: f64 = 100e3;
const SPEED: f64 = 50.0 / 3.6;
/// Place of the hole's middle, its length and its depth \[m]; the depth is assumed, the place follows from the first
/// instant.
const HOLE: [f64; 3] = [2.26e-3, 0.5e-3, 20e-6];

/// How a run is computed: elements across half of the contact, time step \[s]. There is no damping.
#[derive(Clone, Copy)]
struct Numerics {
    elements: usize,
    step: f64,
}

/// Numerics of what is shown, with twice its step, and with half its elements.
const SHOWN: Numerics = Numerics { elements: 40, step: 1e-6 };
const COARSER: [Numerics; 2] = [Numerics { step: 2e-6, ..SHOWN }, Numerics { elements: 20, ..SHOWN }];

/// A state: time \[s], force over load, temperatures over the reference at the contact point of wheel and rail \[K],
/// length in contact \[m].
type Instant = [f64; 5];

/// Length of the contact that carries pressure \[m].
fn touching(run: &Run) -> f64 {
    let pressure = &run.traction().pressure;
    let part = |i: usize| {
        let carries = [i, i + 1].iter().filter(|i| pressure.value[**i] > 0.0).count();
        0.5 * carries as f64 * (pressure.x[i + 1] - pressure.x[i])
    };
    (0..pressure.x.len().saturating_sub(1)).map(part).sum()
}

/// A locked wheel over the hole.
fn locked(numerics: Numerics, heat: bool, duration: f64) -> Result<Vec<Instant>, String> {
    locked_with(numerics, duration, |config| config.thermal.enabled = heat)
}

/// A locked wheel over the hole, with changes of its parameters.
fn locked_with(
    Numerics { elements, step }: Numerics,
    duration: f64,
    change: impl Fn(&mut Config),
) -> Result<Vec<Instant>, String> {
    let product = Product::with("paper_d", |config| {
        change(config);
        config.mesh.elements_per_half_width = elements;
        config.tuning.tolerance = 0.0;
        config.rail.profile = hole(HOLE[0], HOLE[1], HOLE[2]);
    })?;
    let mut run = product.rolling(SPEED, 2.0, |inputs| inputs.drive.omega = 0.0)?;
    let see = |time: f64, run: &Run| {
        let warmth = run.warmth();
        [time, run.outputs().contact_force_y / LOAD, warmth.wheel_centre, warmth.rail_centre, touching(run)]
    };
    let mut points = vec![see(0.0, &run)];
    for k in 1..=(duration / step).round() as usize {
        run.advance(step)?;
        points.push(see(k as f64 * step, &run));
    }
    Ok(points)
}

/// When the contact reaches the hole and leaves it \[s]: it is shorter by a tenth of the hole after a tenth of it has
/// come in, and before the last tenth goes out.
fn passage(points: &[Instant]) -> [f64; 2] {
    let part = 0.1 * HOLE[1];
    let short = || points.iter().filter(|point| point[4] < points[0][4] - part).map(|point| point[0]);
    let [first, last] = [short().fold(f64::INFINITY, f64::min), short().fold(f64::NEG_INFINITY, f64::max)];
    [first - part / SPEED, last + part / SPEED]
}

/// Temperatures of wheel and rail over those at the start while the contact is on the hole \[K].
struct Change {
    /// Their means.
    mean: [f64; 2],
    /// The lowest and the highest of each.
    swing: [[f64; 2]; 2],
}

impl Change {
    fn new(points: &[Instant], [reaches, leaves]: [f64; 2]) -> Self {
        let of = |body: usize| {
            let inside = points.iter().filter(|point| point[0] > reaches && point[0] <= leaves);
            inside.map(|point| point[2 + body] - points[0][2 + body]).collect::<Vec<_>>()
        };
        let all = [of(0), of(1)];
        let extreme = |values: &[f64], pick: fn(f64, f64) -> f64| values.iter().copied().fold(0.0, pick);
        Self {
            mean: all.each_ref().map(|values| values.iter().sum::<f64>() / values.len() as f64),
            swing: all.each_ref().map(|values| [extreme(values, f64::min), extreme(values, f64::max)]),
        }
    }

    /// In words.
    fn finding(&self) -> String {
        let body = |i: usize| {
            format!("{:+.1} K in the mean ({:+.1} to {:+.1})", self.mean[i], self.swing[i][0], self.swing[i][1])
        };
        format!("wheel {}, rail {}", body(0), body(1))
    }
}

fn plot(axis: &str, curves: Vec<Curve>) -> Plot {
    Plot { axes: ["time in ms".into(), axis.into()], curves }
}

/// Temperatures of both bodies until a time \[s].
fn temperatures(runs: &[(&str, &[Instant])], until: f64) -> Vec<Curve> {
    let line = |points: &[Instant], body: usize| {
        points.iter().filter(|p| p[0] <= until).map(|p| [1e3 * p[0], p[2 + body]]).collect()
    };
    let of = |(name, points): &(&str, &[Instant])| {
        ["wheel", "rail"]
            .into_iter()
            .enumerate()
            .map(|(i, body)| curve(Source::Ours, format!("{body}, {name}"), line(points, i)))
            .collect::<Vec<_>>()
    };
    runs.iter().flat_map(of).collect()
}

/// Smallest and largest force over the load.
fn forces(points: &[Instant]) -> [f64; 2] {
    extremes(&points.iter().map(|p| [p[0], p[1]]).collect::<Vec<_>>(), 1.0)
}

/// Figures D 19 to 21.
pub fn sharp() -> Result<Figure, String> {
    let cold = |step: f64| locked(Numerics { step, ..SHOWN }, false, 1e-3).map(|points| forces(&points));
    let (coarse, fine) = (cold(5e-6)?, cold(2.5e-6)?);
    let a = half_width(LOAD);
    let [reaches, leaves] = [-1.0, 1.0].map(|sign| (HOLE[0] + sign * (0.5 * HOLE[1] + a)) / SPEED);
    let exact = locked(SHOWN, true, leaves + 2e-5)?;
    let coarser =
        COARSER.iter().map(|numerics| locked(*numerics, true, leaves + 1e-5)).collect::<Result<Vec<_>, _>>()?;
    let change = |points: &[Instant]| Change::new(points, [reaches, leaves]);
    let (shown, others) = (change(&exact), coarser.iter().map(|points| change(points)).collect::<Vec<_>>());
    let apart = |body: usize| largest(others.iter().map(|other| (other.mean[body] - shown.mean[body]).abs()));
    let (seen, start) = (passage(&exact), exact[0]);
    let unswollen = locked_with(SHOWN, 0.0, |config| config.material.expansion = 0.0)?[0];
    let settles = (fine[0] - coarse[0]).abs().max((fine[1] - coarse[1]).abs());
    let mut zoom = temperatures(&[("undamped", &exact)], 4.6e-4);
    let marks = [(reaches, "hole reached"), (leaves, "hole left")];
    let [low, high] = [start[3] + shown.swing[1][0], start[2] + shown.swing[0][1]];
    zoom.extend(marks.map(|(t, name)| {
        curve(Source::Exact, name, (0..=20).map(|i| [1e3 * t, low + (high - low) * f64::from(i) / 20.0]).collect())
    }));
    let all = || others.iter().chain([&shown]);
    Ok(Figure {
        item: "D 19–21",
        title: "Temperatures and force as a locked wheel slides over a hole of 0.5 mm",
        status: Status::Agrees,
        parameters: "Base of Paper D, locked, 50 km/h; depth of the hole, 20 µm, assumed (5 µm to 1 mm give the same), its middle at 2.26 mm follows from \
                     t₁. No damping, 40 elements in half the contact, steps of 1 µs; beside it 2 µs, and 20 elements. The thesis has α₁ = 1e-4 s and 1e-5 s.",
        finding: format!(
            "The contact reaches the hole after {:.0} µs and leaves it after {:.0} µs, by its length (stated about 90 and 230; Hertz' width gives {:.1} and {:.1}). Meanwhile: \
             {}; from {:.2} and {:.2} K. So the wheel warms and the rail cools by more, as stated, in the mean: both swing, and extremes say nothing. Half the elements or twice the step change these \
             means by {:.2} K in the wheel and {:.2} K in the rail at most. The force goes \
             from {:.4} to {:.4} of the load, half the step changes {settles:.4}.",
            1e6 * seen[0],
            1e6 * seen[1],
            1e6 * reaches,
            1e6 * leaves,
            shown.finding(),
            start[2],
            start[3],
            apart(0),
            apart(1),
            fine[0],
            fine[1]
        ),
        plots: vec![
            plot("temperature over the reference in K", zoom),
            plot(
                "force in kN",
                vec![curve(Source::Ours, "undamped", exact.iter().map(|p| [1e3 * p[0], 1e-3 * LOAD * p[1]]).collect())],
            ),
        ],
        values: vec![
            ("d19.reaches".into(), seen[0]),
            ("d19.leaves".into(), seen[1]),
            ("d19.share".into(), HOLE[1] / start[4]),
            ("d19.wheel".into(), shown.mean[0]),
            ("d19.rail".into(), shown.mean[1]),
            ("d21.least".into(), fine[0]),
            ("d21.largest".into(), fine[1]),
        ],
        predicates: vec![
            must(
                format!("undamped 0.974 and 1.0058 within 0.003: {:.4}, {:.4}", fine[0], fine[1]),
                (fine[0] - 0.974).abs() < 3e-3 && (fine[1] - 1.0058).abs() < 3e-3,
            ),
            must(format!("undamped, half the step changes less than 0.2 %: {settles:.4}"), settles < 2e-3),
            must(
                format!(
                    "starts, if heat does not swell the steel, within 1 % of the references 28.64 and 26.40 K, which do \
                     without: {:.3}, {:.3}",
                    unswollen[2], unswollen[3]
                ),
                (unswollen[2] / 28.639 - 1.0).abs() < 0.01 && (unswollen[3] / 26.402 - 1.0).abs() < 0.01,
            ),
            must(
                format!(
                    "undamped the wheel is warmer over the hole in the mean, with each step and mesh: {:+.2} K",
                    shown.mean[0]
                ),
                all().all(|change| change.mean[0] > 0.0),
            ),
            must(
                format!(
                    "undamped the rail is colder over the hole in the mean, with each step and mesh: {:+.2} K",
                    shown.mean[1]
                ),
                all().all(|change| change.mean[1] < 0.0),
            ),
            must(
                "the rail's mean changes by more than the wheel's",
                all().all(|change| -change.mean[1] > change.mean[0]),
            ),
            must(
                format!(
                    "half the elements or twice the step change these means by less than half of them: {:.2}, {:.2} K",
                    apart(0),
                    apart(1)
                ),
                apart(0) < 0.5 * shown.mean[0] && apart(1) < -0.5 * shown.mean[1],
            ),
        ],
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A swing about the start has no mean, whatever its size, and each body has its own sign.
    #[test]
    fn the_change_over_the_hole_is_a_mean_that_a_swing_does_not_make() {
        let at = |k: i32, wheel: f64, rail: f64| [1e-6 * f64::from(k), 1.0, 30.0 + wheel, 20.0 + rail, 1.0];
        let swing = |k: i32| if k % 2 == 0 { -9.0 } else { 9.0 };
        let points: Vec<Instant> =
            (0..=20).map(|k| if (5..=14).contains(&k) { at(k, swing(k), -1.0) } else { at(k, 0.0, 0.0) }).collect();
        let change = Change::new(&points, [4.5e-6, 14.5e-6]);
        assert_eq!((change.mean, change.swing), ([0.0, -1.0], [[-9.0, 9.0], [-1.0, 0.0]]));
    }
}
