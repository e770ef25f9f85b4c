//! Paper D, figures 16 and 17: braking with a prescribed moment, by the product and the thesis's own method beside
//! balances of momentum and Carter.

use super::{Figure, curve, must, rolling};
use crate::annulus::{INNER, OUTER};
use crate::dynamic::{Prescribed, Rolling};
use crate::newton::{self, Drive, Newton};
use crate::ours::{Product, Run};
use crate::plot::{Curve, Plot, Source};
use crate::quoted::Status;
use crate::rolling::Motion;
use std::f64::consts::PI;
use wheelrail::analytic::{carter_force, carter_full_slip, contact_modulus, hertz_half_width};
use wheelrail::simulation::{Rotation, Translation};

pub(super) const LOAD: f64 = 100e3;
pub(super) const FRICTION: f64 = 0.4;
/// Velocities at the start and at the end [m/s].
pub(super) const START: f64 = 50.0 / 3.6;
pub(super) const END: f64 = 10.0 / 3.6;
/// Steps of ten seconds by the thesis's own method, as many as the thesis has.
const METHOD_STEPS: u32 = 100;

/// Mass \[kg] and moment of inertia [kg m²] of a metre of wheel.
pub(super) fn inertia() -> [f64; 2] {
    let mass = 8000.0 * PI * (OUTER * OUTER - INNER * INNER);
    [mass, 0.5 * mass * (OUTER * OUTER + INNER * INNER)]
}

/// Paper D on a coarser mesh without centrifugal load, as the references.
pub(super) fn paper_d() -> Result<Product, String> {
    Product::with("paper_d", |config| {
        (config.physics.centrifugal, config.mesh.elements_per_half_width) = (false, 10);
    })
}

/// Columns that are drawn of a motion: time, V, rω, moment, force, contact force, creepage, temperature of the wheel at
/// the contact point over the reference.
pub(super) type Row = [f64; 8];

pub(super) fn row(t: f64, run: &Run) -> Row {
    let o = run.outputs();
    let (tread, warm) = (o.wheel_omega * OUTER, run.warmth().wheel_centre);
    [t, o.wheel_velocity, tread, o.hub_moment, o.hub_force_x, o.contact_force_x, o.contact_creepage, warm]
}

pub(super) fn column(rows: &[Row], i: usize, scale: f64, source: Source, name: &str) -> Curve {
    curve(source, name, rows.iter().map(|row| [row[0], scale * row[i]]).collect())
}

/// The row at a time.
pub(super) fn at(rows: &[Row], t: f64) -> Row {
    rows.iter().copied().find(|row| row[0] >= t - 1e-9).unwrap_or(rows[rows.len() - 1])
}

/// Velocities, moment and forces of a motion.
fn drawings(rows: &[Row], name: &str) -> Vec<Plot> {
    let time = || "time in s".to_owned();
    let label = |what: &str| format!("{what}, {name}");
    vec![
        Plot {
            axes: [time(), "velocity in km/h".into()],
            curves: vec![
                column(rows, 1, 3.6, Source::Ours, &label("V")),
                column(rows, 2, 3.6, Source::Ours, &label("rω")),
            ],
        },
        Plot {
            axes: [time(), "moment in kN m, forces in kN".into()],
            curves: vec![
                column(rows, 3, 1e-3, Source::Ours, &label("moment")),
                column(rows, 4, 1e-3, Source::Ours, &label("force on the hub")),
                column(rows, 5, 1e-3, Source::Ours, &label("force of the contact")),
            ],
        },
    ]
}

/// Braking by a moment that grows in `ramp` \[s], holds for `hold` \[s] and goes back; ten seconds in steps \[s].
fn controlled(peak: f64, times: [f64; 2], step: f64) -> Result<Vec<Row>, String> {
    let product = paper_d()?;
    let held = product.rolling(START, 0.0, |_| ())?;
    let (force, moment) = (held.outputs().hub_force_x, held.outputs().hub_moment);
    let mut run = product.rolling(START, 0.0, |inputs| {
        (inputs.rotation, inputs.translation) = (Rotation::Moment, Translation::Force);
        (inputs.drive.force, inputs.drive.moment) = (force, moment);
    })?;
    let mut rows = vec![row(0.0, &run)];
    for k in 1..=(10.0 / step).round() as usize {
        let t = k as f64 * step;
        run.inputs.drive.moment = moment - share_of_peak(t, times) * (peak + moment);
        run.advance(step)?;
        rows.push(row(t, &run));
    }
    Ok(rows)
}

/// Share of the largest moment at a time, for a ramp and a time at the peak \[s].
fn share_of_peak(t: f64, [ramp, hold]: [f64; 2]) -> f64 {
    (t / ramp).min((2.0 * ramp + hold - t) / ramp).clamp(0.0, 1.0)
}

/// Motion by the thesis's own step in time, on linear triangles with edges of `edge` half-widths in the contact:
/// moment and no force on the hub prescribed at once. Rows as of the product, with the creepage over that of rolling
/// freely, which such a mesh has.
fn by_method(peak: f64, times: [f64; 2], edge: f64) -> Result<Vec<Row>, String> {
    let said = |error: crate::Error| error.to_string();
    let (system, [wheel, rail]) = rolling::triangles(edge, 1)?;
    let (held, _) = newton::rolling(&system, rolling::motion(START, 0.0)).map_err(said)?;
    let free = Newton { system: &system, law: system.parameters.law, drive: Drive::Moment(0.0) };
    let (start, _) = free.solve(&held).map_err(said)?;
    let mut run = Rolling::new(&system, &wheel, &rail, start);
    let row = |t: f64, run: &Rolling| {
        let Motion { omega, velocity } = run.state.motion;
        let creepage = 2.0 * (velocity - OUTER * omega) / (velocity + OUTER * omega);
        let [moment, force] = run.efforts;
        [t, velocity, OUTER * omega, moment, force, newton::resultant(&run.touches)[0], creepage, f64::NAN]
    };
    let mut rows = vec![row(0.0, &run)];
    for k in 1..=METHOD_STEPS {
        let t = 10.0 * f64::from(k) / f64::from(METHOD_STEPS);
        let given = [-share_of_peak(t, times) * peak, 0.0].map(Prescribed::Effort);
        run.advance(10.0 / f64::from(METHOD_STEPS), given).map_err(said)?;
        rows.push(row(t, &run));
    }
    let idle = rows[0][6];
    rows.iter_mut().for_each(|row| row[6] -= idle);
    Ok(rows)
}

/// Figures D 16 and 17: braking with a prescribed moment.
pub fn moment() -> Result<Figure, String> {
    let [mass, moment_of_inertia] = inertia();
    let creeping = controlled(15_950.0, [1.74, 1.52], 0.02)?;
    // The moment for 48 % of the limit.
    let share = 0.48 * FRICTION * LOAD;
    let peak = share * (OUTER + moment_of_inertia / (mass * OUTER));
    let lighter = controlled(peak, [1.4, 2.2], 0.02)?;
    let largest = |rows: &[Row], i: usize| rows.iter().fold(0.0_f64, |worst, row| worst.max(row[i].abs()));
    let limit = FRICTION * LOAD;
    let [used, less] = [&creeping, &lighter].map(|rows| largest(rows, 5) / limit);
    let [creep, slight] = [&creeping, &lighter].map(|rows| largest(rows, 6));
    let [end, other] = [&creeping, &lighter].map(|rows| 3.6 * rows[rows.len() - 1][1]);
    let still = at(&creeping, 5.4)[1] - creeping[creeping.len() - 1][1];
    let full = carter_full_slip(FRICTION, hertz_half_width(LOAD, OUTER, contact_modulus(200e9, 0.3)), OUTER);
    let carter = [creep, slight].map(|xi| carter_force(-xi, full));
    let theirs = by_method(15_950.0, [1.74, 1.52], 0.2)?;
    let (their_share, their_creep) = (largest(&theirs, 5) / limit, largest(&theirs, 6));
    let apart = (theirs[METHOD_STEPS as usize][1] - creeping[creeping.len() - 1][1]).abs();
    let mut plots = drawings(&creeping, "15.95 kN m");
    plots.push(Plot {
        axes: ["time in s".into(), "creepage in 1e-4".into()],
        curves: vec![
            column(&creeping, 6, 1e4, Source::Ours, "15.95 kN m"),
            column(&lighter, 6, 1e4, Source::Ours, "14.45 kN m"),
            column(&theirs, 6, 1e4, Source::Method, "thesis's method, 15.95 kN m"),
            curve(Source::Quoted, "stated 1.9e-4", vec![[0.0, 1.9], [5.0, 1.9]]),
        ],
    });
    Ok(Figure {
        item: "D 16–17",
        title: "Braking with a prescribed moment",
        status: Status::NotStated,
        parameters: "Base of Paper D, P = 100 kN/m, μ = 0.4, from 50 km/h, no force on the hub, 10 s. Largest moment and ramps are not \
                     stated: 15.95 kN m with ramps of 1.74 s about 1.52 s is fitted to the stated creepage of 1.9e-4, 14.45 kN m \
                     with 1.4 s about 2.2 s to the stated 48 % of the limit. Steps of 20 ms, without centrifugal load.",
        finding: format!(
            "With 15.95 kN m the creepage reaches {creep:.3e}, the force {:.1} % of its limit, and {end:.2} km/h remain after 5 s. With \
             14.45 kN m the force reaches {:.1} %, but the creepage only {slight:.3e}; {other:.2} km/h remain. Both stated numbers \
             exclude each other by exact friction. The thesis's own step in time with moment and force prescribed at once (100 steps, linear \
             triangles, edges of 0.2 a) needs {:.1} % of the limit, too, since this is Newton's law, at a creepage of {their_creep:.3e} over that of \
             rolling freely.",
            100.0 * used,
            100.0 * less,
            100.0 * their_share
        ),
        plots,
        values: vec![
            ("d16.final".into(), end),
            ("d16.creepage".into(), creep),
            ("d16.share".into(), used),
            ("d16.final.48".into(), other),
            ("d16.creepage.48".into(), slight),
            ("d16.moment.48".into(), peak),
            ("d16.method.creepage".into(), their_creep),
            ("d16.method.share".into(), their_share),
        ],
        predicates: vec![
            must(format!("end within 0.02 km/h of the reference 10.191 km/h: {end:.4}"), (end - 10.191).abs() < 0.02),
            must(format!("creepage within 2 % of 1.91e-4: {creep:.4e}"), (creep / 1.91e-4 - 1.0).abs() < 0.02),
            must(format!("0.531 of the limit within 0.005: {used:.4}"), (used - 0.531_2).abs() < 5e-3),
            must(format!("14.45 kN m give 48 % within 0.5 %: {peak:.0}, {less:.4}"), (less - 0.48).abs() < 5e-3),
            must(
                format!(
                    "both within 0.01 of Carter at their creepage: {:+.4}, {:+.4}",
                    used - carter[0],
                    less - carter[1]
                ),
                (used - carter[0]).abs() < 0.01 && (less - carter[1]).abs() < 0.01,
            ),
            must(
                format!(
                    "the thesis's method needs the same force within 0.005 and ends within 1 % of what both slow down: {their_share:.4}, {apart:.3} m/s"
                ),
                (their_share - used).abs() < 5e-3 && apart < 0.01 * (START - END),
            ),
            must(
                format!("its creepage is within a tenth of ours: {their_creep:.3e}"),
                (their_creep / creep - 1.0).abs() < 0.1,
            ),
            must(format!("nothing changes after 5.4 s: {still:.1e} m/s"), still.abs() < 0.01),
        ],
    })
}
