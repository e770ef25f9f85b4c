//! Paper D, section 6.2: braking with prescribed velocities and with a prescribed moment, by the product beside balances of
//! momentum and Carter.

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

const LOAD: f64 = 100e3;
const FRICTION: f64 = 0.4;
/// Velocities at the start and at the end [m/s].
const START: f64 = 50.0 / 3.6;
const END: f64 = 10.0 / 3.6;
/// Time in which the tread slows down in example a \[s], and length of the quadratic end of the travel velocity \[s], assumed.
const TREAD: f64 = 1.1;
const ROUNDING: f64 = 0.3;
/// Steps of ten seconds by the thesis's own method, as many as the thesis has.
const METHOD_STEPS: u32 = 100;

/// Mass \[kg] and moment of inertia [kg m²] of a metre of wheel.
fn inertia() -> [f64; 2] {
    let mass = 8000.0 * PI * (OUTER * OUTER - INNER * INNER);
    [mass, 0.5 * mass * (OUTER * OUTER + INNER * INNER)]
}

/// Paper D on a coarser mesh without centrifugal load, as the references.
fn paper_d() -> Result<Product, String> {
    Product::with("paper_d", |config| {
        (config.physics.centrifugal, config.mesh.elements_per_half_width) = (false, 10);
    })
}

/// A velocity that falls from the start at `rate` [m/s²] and rounds off into the end.
fn slowing(t: f64, rate: f64) -> f64 {
    // On a parabola of the length T the velocity falls by half of what the rate makes in T.
    let round = (START - END) / rate - 0.5 * ROUNDING;
    match t {
        t if t <= round => START - rate * t,
        t if t <= round + ROUNDING => END + 0.5 * rate / ROUNDING * (round + ROUNDING - t).powi(2),
        _ => END,
    }
}

/// What is drawn of a motion: time, V, rω, moment, force, contact force, creepage.
fn row(t: f64, run: &Run) -> [f64; 7] {
    let o = run.outputs();
    [t, o.wheel_velocity, o.wheel_omega * OUTER, o.hub_moment, o.hub_force_x, o.contact_force_x, o.contact_creepage]
}

/// Motion with both velocities prescribed, V and rω over time, in steps \[s] to `end` \[s].
fn prescribed(end: f64, step: f64, velocities: impl Fn(f64) -> [f64; 2]) -> Result<Vec<[f64; 7]>, String> {
    let mut run = paper_d()?.rolling(START, 0.0, |_| ())?;
    let mut rows = vec![row(0.0, &run)];
    for k in 1..=(end / step).round() as usize {
        let t = k as f64 * step;
        let [travel, tread] = velocities(t);
        (run.inputs.drive.velocity, run.inputs.drive.omega) = (travel, tread / OUTER);
        run.advance(step)?;
        rows.push(row(t, &run));
    }
    Ok(rows)
}

fn column(rows: &[[f64; 7]], i: usize, scale: f64, source: Source, name: &str) -> Curve {
    curve(source, name, rows.iter().map(|row| [row[0], scale * row[i]]).collect())
}

/// The row at a time.
fn at(rows: &[[f64; 7]], t: f64) -> [f64; 7] {
    rows.iter().copied().find(|row| row[0] >= t - 1e-9).unwrap_or(rows[rows.len() - 1])
}

/// Velocities, moment and forces of a motion.
fn drawings(rows: &[[f64; 7]], name: &str) -> Vec<Plot> {
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

/// Figures D 11 to 15: braking with prescribed velocities.
pub fn velocities() -> Result<Figure, String> {
    let [mass, moment_of_inertia] = inertia();
    let rate = FRICTION * LOAD / mass;
    let tread = |t: f64| START + (END - START) * (t / TREAD).min(1.0);
    let a = prescribed(2.5, 0.01, |t| [slowing(t, rate), tread(t)])?;
    // Example b, whose history is not stated: four seconds of slight creepage.
    let (time, creepage) = (4.0, 2e-4);
    let b = prescribed(10.0, 0.1, |t| {
        let v = START + (END - START) * (t / time).min(1.0);
        let xi = if t < time { creepage } else { 0.0 };
        [v, v * (1.0 - 0.5 * xi) / (1.0 + 0.5 * xi)]
    })?;
    let sliding = moment_of_inertia * (END - START) / TREAD / OUTER - FRICTION * LOAD * OUTER;
    let (first, second) = (at(&a, 0.6), at(&a, 1.25));
    let largest = a.iter().fold(0.0_f64, |worst, row| worst.max(row[6]));
    let limit = 1.05 * FRICTION * LOAD * OUTER;
    let leaves = a.iter().find(|row| row[0] > 0.6 && row[3].abs() < limit).map_or(f64::NAN, |row| row[0]);
    // Newton and Carter in the middle of b.
    let middle = at(&b, 2.0);
    let full = carter_full_slip(FRICTION, hertz_half_width(LOAD, OUTER, contact_modulus(200e9, 0.3)), OUTER);
    let contact = carter_force(creepage, full) * FRICTION * LOAD;
    let slowed = (END - START) / time;
    let force = mass * slowed - contact;
    let moment = moment_of_inertia * slowed / OUTER + contact * OUTER;
    let scale = FRICTION * LOAD;
    let off = [(middle[3] - moment) / (scale * OUTER), (middle[4] - force) / scale];
    let mut plots = drawings(&a, "a");
    plots.extend(drawings(&b, "b"));
    Ok(Figure {
        item: "D 11–15",
        title: "Braking with prescribed velocities from 50 to 10 km/h",
        status: Status::NotStated,
        parameters: "Base of Paper D, P = 100 kN/m, μ = 0.4. a: rω falls linearly in 1.1 s, V at μP/m with a quadratic end of 0.3 s \
                     (assumed), steps of 10 ms over 2.5 s. b: its history is not stated; V falls linearly in 4 s at ξ = 2e-4 (assumed), \
                     100 steps over 10 s. Without centrifugal load.",
        finding: format!(
            "a: moment {:.0} N m while the tread slows down, then {:.0} N m, which is μPr; the force on the hub is {:.0} N, since \
             friction alone brakes; the creepage reaches {largest:.3}. b: moment {:.0} N m and force {:.0} N in the middle.",
            first[3], second[3], first[4], middle[3], middle[4]
        ),
        plots,
        values: vec![
            ("d11.moment.first".into(), first[3]),
            ("d11.moment.second".into(), second[3]),
            ("d11.creepage".into(), largest),
            ("d11.plateau".into(), leaves),
        ],
        predicates: vec![
            must(
                format!("first moment within 0.5 % of Newton's {sliding:.0} and of the reference's −35 864 N m"),
                (first[3] / sliding - 1.0).abs() < 5e-3 && (first[3] / -35_864.0 - 1.0).abs() < 5e-3,
            ),
            must("second moment within 0.5 % of μPr, 20 000 N m", (second[3] / -20e3 - 1.0).abs() < 5e-3),
            must(format!("no force on the hub, within 1 % of μP: {:.0} N", first[4]), first[4].abs() < 0.01 * scale),
            must(format!("largest creepage within 1 % of 0.842: {largest:.4}"), (largest / 0.842 - 1.0).abs() < 0.01),
            must(
                format!(
                    "b: moment and force within 1 % of the limit of Newton and Carter: {:+.4}, {:+.4}",
                    off[0], off[1]
                ),
                off.iter().all(|off| off.abs() < 0.01),
            ),
        ],
    })
}

/// Braking by a moment that grows in `ramp` \[s], holds for `hold` \[s] and goes back; ten seconds in steps \[s].
fn controlled(peak: f64, times: [f64; 2], step: f64) -> Result<Vec<[f64; 7]>, String> {
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

/// The same by the thesis's own step in time, on linear triangles with edges of `edge` half-widths in the contact: moment and no force on the
/// hub prescribed at once. Rows as of the product, with the creepage over that of rolling freely, which such a mesh has.
fn by_method(peak: f64, times: [f64; 2], edge: f64) -> Result<Vec<[f64; 7]>, String> {
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
        [t, velocity, OUTER * omega, moment, force, newton::resultant(&run.touches)[0], creepage]
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
    let largest = |rows: &[[f64; 7]], i: usize| rows.iter().fold(0.0_f64, |worst, row| worst.max(row[i].abs()));
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
