//! Paper D, figures 11 to 15: braking with prescribed velocities, by the product beside balances of momentum.

use super::braking::{END, FRICTION, LOAD, Row, START, at, column, inertia, paper_d, row};
use super::{Figure, must};
use crate::annulus::OUTER;
use crate::plot::{Curve, Plot, Source};
use crate::quoted::Status;
use wheelrail::analytic::{carter_full_slip, contact_modulus, hertz_half_width};

/// Time in which the tread slows down in both examples \[s].
const TREAD: f64 = 1.1;
/// Time in which the velocity of travel falls linearly in example b, and length of its quadratic end in both \[s];
/// assumed. In example a friction alone slows the wheel down.
const TRAVEL: f64 = 2.5;
const ROUNDING: f64 = 0.3;
/// Time that is looked at, and step \[s]; the thesis has 100 steps of 0.1 s.
const LOOKED_AT: f64 = 3.2;
const STEP: f64 = 0.01;
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

/// Motion with both velocities prescribed, V and rω over time, in steps \[s] to `end` \[s].
fn prescribed(end: f64, step: f64, velocities: impl Fn(f64) -> [f64; 2]) -> Result<Vec<Row>, String> {
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

/// Both examples, in steps \[s] to `end` \[s]: the tread slows down alike, only the travel differs.
fn examples(end: f64, step: f64) -> Result<[Vec<Row>; 2], String> {
    let [mass, _] = inertia();
    let tread = |t: f64| START + (END - START) * (t / TREAD).min(1.0);
    let run = |rate: f64| prescribed(end, step, |t| [slowing(t, rate), tread(t)]);
    Ok([run(FRICTION * LOAD / mass)?, run((START - END) / TRAVEL)?])
}

/// Correlation of creepage and temperature over time \[1].
fn likeness(rows: &[Row]) -> f64 {
    let mean = |i: usize| rows.iter().map(|row| row[i]).sum::<f64>() / rows.len() as f64;
    let means = [mean(6), mean(7)];
    let product = |i: usize, j: usize| {
        rows.iter().map(|row| (row[6 + i] - means[i]) * (row[6 + j] - means[j])).sum::<f64>() / rows.len() as f64
    };
    product(0, 1) / (product(0, 0) * product(1, 1)).sqrt()
}

/// Velocities, creepage (figure D 12), forces and moments, and temperature (D 15) of both examples.
fn both(examples: &[Vec<Row>; 2]) -> Vec<Plot> {
    let pair = |i: usize, scale: f64, what: &str| -> Vec<Curve> {
        let named = examples.iter().zip(["a", "b"]);
        named.map(|(rows, name)| column(rows, i, scale, Source::Ours, &format!("{what}, {name}"))).collect()
    };
    let plot = |axis: &str, curves: Vec<Vec<Curve>>| Plot {
        axes: ["time in s".into(), axis.into()],
        curves: curves.into_iter().flatten().collect(),
    };
    vec![
        plot("velocity in km/h", vec![pair(1, 3.6, "V"), pair(2, 3.6, "rω")]),
        plot("creepage ξ", vec![pair(6, 1.0, "creepage")]),
        plot("force in kN", vec![pair(4, 1e-3, "on the hub"), pair(5, 1e-3, "of the contact")]),
        plot("moment on the hub in kN m", vec![pair(3, 1e-3, "moment")]),
        plot("temperature over the reference in K", vec![pair(7, 1.0, "wheel at the contact point")]),
    ]
}

/// Figures D 11 to 15: braking with prescribed velocities.
pub fn velocities() -> Result<Figure, String> {
    let [mass, moment_of_inertia] = inertia();
    let [fine, thesis] = [examples(LOOKED_AT, STEP)?, examples(10.0, 0.1)?];
    let scale = FRICTION * LOAD;
    let sliding = moment_of_inertia * (END - START) / TREAD / OUTER - scale * OUTER;
    let (middle, later) = (fine.each_ref().map(|rows| at(rows, 0.6)), fine.each_ref().map(|rows| at(rows, 1.25)));
    let over = |rows: &[Row], i: usize| rows.iter().fold(f64::NEG_INFINITY, |most, row| most.max(row[i]));
    let largest = fine.each_ref().map(|rows| over(rows, 6));
    let hub = [0.0, scale - mass * (START - END) / TRAVEL];
    let spikes = fine.each_ref().map(|rows| over(rows, 4));
    let full = carter_full_slip(FRICTION, hertz_half_width(LOAD, OUTER, contact_modulus(200e9, 0.3)), OUTER);
    // While the travel is still above its end the creepage is not zero.
    let slow = |rows: &[Row]| {
        let creeping = rows.iter().skip(1).filter(|row| row[1] > END + 1e-9).map(|row| row[6]);
        creeping.fold(f64::INFINITY, f64::min)
    };
    let least = thesis.each_ref().map(|rows| slow(rows));
    let slides = |rows: &[Row]| {
        let creeping = rows.iter().skip(1).filter(|row| row[6] > 10.0 * full);
        creeping.map(|row| (row[5] / scale + 1.0).abs()).fold(0.0, f64::max)
    };
    let force = fine.iter().chain(&thesis).map(|rows| slides(rows)).fold(0.0, f64::max);
    let likeness = fine.each_ref().map(|rows| likeness(rows));
    let heat = fine.each_ref().map(|rows| [rows[1][7], over(rows, 7), rows[rows.len() - 1][7]]);
    // Backward differences of velocities that are linear are exact in steps of any length.
    let steps = [0, 1].map(|i| (at(&thesis[i], 0.6)[3] / middle[i][3] - 1.0).abs());
    let near = |found: f64, wanted: f64, share: f64| (found / wanted - 1.0).abs() < share;
    Ok(Figure {
        item: "D 11–15",
        title: "Braking with prescribed velocities from 50 to 10 km/h",
        status: Status::NotStated,
        parameters: "Base of Paper D, P = 100 kN/m, μ = 0.4. rω falls linearly in 1.1 s in both examples. a: V falls at μP/m, as friction alone brakes it; b: linearly in \
                     2.5 s (assumed: the text has no number); both with a quadratic end of 0.3 s (assumed). Steps of 10 ms; beside them the thesis's 100 steps of 0.1 s. Without \
                     centrifugal load.",
        finding: format!(
            "Both: moment {:.0} and {:.0} N m while the tread slows down, then {:.0} and {:.0} N m, which is μPr, from 1.1 s on as stated; the contact has μP all the time. The force \
             on the hub is {:.0} N in a, since friction alone brakes, and {:.0} N in b; at the end of V it rises to {:.1} and {:.1} kN, the stated spike. The creepage reaches {:.3} and \
             {:.3}; in the thesis's steps its smallest value but zero is {:.4} and {:.4}, well above full slip as stated, {full:.2e}. The temperature follows the creepage \
             (correlation {:.3} and {:.3}): b has {:.1} K after 10 ms, {:.1} K at most and {:.1} K after {LOOKED_AT} s.",
            middle[0][3],
            middle[1][3],
            later[0][3],
            later[1][3],
            middle[0][4],
            middle[1][4],
            1e-3 * spikes[0],
            1e-3 * spikes[1],
            largest[0],
            largest[1],
            least[0],
            least[1],
            likeness[0],
            likeness[1],
            heat[1][0],
            heat[1][1],
            heat[1][2]
        ),
        plots: both(&fine),
        values: vec![
            ("d11.moment.first".into(), middle[0][3]),
            ("d11.moment.second".into(), later[0][3]),
            ("d11.creepage".into(), largest[0]),
            ("d11.b.moment.first".into(), middle[1][3]),
            ("d11.b.force".into(), middle[1][4]),
            ("d11.b.creepage".into(), largest[1]),
            ("d15.a.warmest".into(), heat[0][1]),
            ("d15.b.warmest".into(), heat[1][1]),
        ],
        predicates: vec![
            must(
                format!(
                    "first moment of both within 0.5 % of Newton's {sliding:.0} and of the reference's −35 864 N m"
                ),
                middle.iter().all(|row| near(row[3], sliding, 5e-3) && near(row[3], -35_864.0, 5e-3)),
            ),
            must(
                "second moment of both, from 1.1 s on, within 0.5 % of μPr, 20 000 N m",
                later.iter().all(|row| near(row[3], -20e3, 5e-3)),
            ),
            must(format!("the contact has μP within 0.5 % in all steps with creepage: {force:.1e}"), force < 5e-3),
            must(
                format!(
                    "force on the hub within 1 % of μP of Newton's {:.0} and {:.0} N: {:.0} and {:.0} N",
                    hub[0], hub[1], middle[0][4], middle[1][4]
                ),
                [0, 1].iter().all(|i| (middle[*i][4] - hub[*i]).abs() < 0.01 * scale),
            ),
            must(
                format!("at the end of V it comes to 0.9 to 1 of μP in both: {:.0}, {:.0} N", spikes[0], spikes[1]),
                spikes.iter().all(|spike| (0.9..1.005).contains(&(spike / scale))),
            ),
            must(
                format!(
                    "largest creepage of a within 1 % of 0.842, that of b larger: {:.4}, {:.4}",
                    largest[0], largest[1]
                ),
                near(largest[0], 0.842, 0.01) && largest[1] > largest[0],
            ),
            must(
                format!(
                    "in the thesis's steps the smallest creepage but zero is ten times that of full slip or more: {:.4}, {:.4}",
                    least[0], least[1]
                ),
                least.iter().all(|least| *least > 10.0 * full),
            ),
            must(
                format!("the temperature follows the creepage with a correlation above 0.9: {likeness:.4?}"),
                likeness.iter().all(|likeness| *likeness > 0.9),
            ),
            must(
                format!("b is warmer than a and both are cool again at the end, below a tenth: {heat:.2?} K"),
                heat[1][1] > heat[0][1] && heat.iter().all(|heat| heat[2] < 0.1 * heat[1]),
            ),
            must(
                format!("the thesis's steps have the first moment within 0.5 %: {:.1e}, {:.1e}", steps[0], steps[1]),
                steps.iter().all(|off| *off < 5e-3),
            ),
        ],
    })
}
