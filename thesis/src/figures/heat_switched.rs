//! Paper B, figure 17: the heat of the tread switched on and off, by the product, the thesis's own steps in time, and
//! an annulus that conducts along the radius.

use super::mesh_heat::{self, Thermal};
use super::paper_b::{CAPACITY, HEAT, LOAD, SPEED, heated, paper_b};
use super::tread_heat::temperatures;
use super::{Figure, balanced, curve, largest, must};
use crate::annulus::{CONDUCTIVITY, OUTER};
use crate::contact::Law;
use crate::plot::Source;
use crate::quoted::Status;
use crate::warming::Warming;
use std::f64::consts::PI;

/// Mean temperatures of wheel and rail over time \[s] with the heat on for `on` \[s] and off as long, in equal steps,
/// and the largest residual of the heat balance.
fn on_and_off(on: f64, step: f64) -> Result<(Vec<[f64; 3]>, f64), String> {
    let product = paper_b(|config| (config.tuning.max_step, config.tuning.tolerance) = (500.0, 0.0))?;
    let mut run = product.rolling(SPEED, 0.0, |_| ())?;
    let (mut history, mut residual) = (vec![[0.0; 3]], 0.0_f64);
    let steps = (2.0 * on / step).round() as usize;
    for k in 1..=steps {
        run.inputs.drive.tread_heat = if 2 * k <= steps { HEAT } else { 0.0 };
        run.advance(step)?;
        let warmth = run.warmth();
        history.push([k as f64 * step, warmth.wheel_mean, warmth.rail_mean]);
        residual = residual.max(run.outputs().heat_residual.abs());
    }
    Ok((history, residual))
}

/// Mean temperature \[K] every 5 s of an annulus that is heated at its rim for `on` \[s] and as long not, loses `loss`
/// [W/(m K)] there, and conducts along the radius alone: finite volumes, backward Euler.
fn radial(on: f64, loss: f64, inner: f64) -> Vec<f64> {
    const CELLS: usize = 200;
    const STEP: f64 = 5.0;
    let width = (OUTER - inner) / CELLS as f64;
    let radius = |i: usize| inner + width * i as f64;
    let volume = |i: usize| PI * (radius(i + 1).powi(2) - radius(i).powi(2));
    let passing = |i: usize| if i == 0 || i == CELLS { 0.0 } else { 2.0 * PI * radius(i) * CONDUCTIVITY / width };
    // The last half cell conducts, too.
    let lost = 1.0 / (1.0 / loss + 0.5 * width / (2.0 * PI * OUTER * CONDUCTIVITY));
    let total: f64 = (0..CELLS).map(volume).sum();
    let (mut t, mut means) = (vec![0.0; CELLS], vec![0.0]);
    for k in 1..=(2.0 * on / STEP).round() as usize {
        let heat = if k as f64 * STEP <= on + 1e-6 { HEAT } else { 0.0 };
        let (mut diagonal, mut right) = (vec![0.0; CELLS], vec![0.0; CELLS]);
        for i in 0..CELLS {
            let stored = CAPACITY * volume(i) / STEP;
            diagonal[i] = stored + passing(i) + passing(i + 1);
            right[i] = stored * t[i];
        }
        diagonal[CELLS - 1] += lost;
        // The heat enters at the rim, beside what is lost from there.
        right[CELLS - 1] += heat * lost / loss;
        for i in 1..CELLS {
            let factor = passing(i) / diagonal[i - 1];
            diagonal[i] -= factor * passing(i);
            right[i] += factor * right[i - 1];
        }
        t[CELLS - 1] = right[CELLS - 1] / diagonal[CELLS - 1];
        for i in (0..CELLS - 1).rev() {
            t[i] = (right[i] + passing(i + 1) * t[i + 1]) / diagonal[i];
        }
        means.push((0..CELLS).map(|i| volume(i) * t[i]).sum::<f64>() / total);
    }
    means
}

/// Temperatures by the thesis's own steps in time, bubbles in a quadratic wheel and contact without friction, so many
/// seconds each; the last entries of a row are what is missing in the heat balance and what the chords of the rims let
/// in [W/m].
fn by_method(on: f64, step: f64) -> Result<Vec<[f64; 5]>, String> {
    let bodies = mesh_heat::meshes(LOAD, mesh_heat::BASE, 1)?;
    let law = Law { penalty: 5e12, friction: 0.0, regularisation: 1.0 };
    let (_, spots) = mesh_heat::roll(LOAD, law, &bodies, 0.0)?;
    let thermal = Thermal { arcs: 0.5 * HEAT, contact: [1e7, 0.0], cold_hub: false, ..Thermal::paper_c() };
    let heating = mesh_heat::heating(&bodies, &spots, thermal);
    let (mut warming, mut rows) = (Warming::new(heating, 0.05, None), vec![[0.0; 5]]);
    let steps = (2.0 * on / step).round() as usize;
    for k in 1..=steps {
        let arcs = if 2 * k <= steps { 0.5 * HEAT } else { 0.0 };
        let flows = warming.advance(step, thermal.motion, &spots, arcs).map_err(|error| error.to_string())?;
        let [wheel, rail] = warming.means();
        rows.push([k as f64 * step, wheel, rail, flows.imbalance(), flows.let_in]);
    }
    Ok(rows)
}

/// Figure B 17: the heat is switched on and off.
pub fn transient() -> Result<Figure, String> {
    const ON: f64 = 30e3;
    let (coarse, residual) = on_and_off(ON, 500.0)?;
    let (fine, _) = on_and_off(ON, 125.0)?;
    let product = paper_b(|_| ())?;
    let end = heated(&product, SPEED, LOAD)?.warmth().wheel_mean;
    let radial = radial(ON, HEAT / end, product.config().wheel.hub_radius);
    // Every step of 125 s holds 25 of the radial solution.
    let worst = (0..fine.len()).fold(0.0_f64, |worst, k| worst.max((fine[k][1] - radial[25 * k]).abs() / end));
    let steps = (0..coarse.len()).fold(0.0_f64, |worst, k| worst.max((coarse[k][1] - fine[4 * k][1]).abs() / end));
    let warm = coarse[coarse.len() / 2][1];
    let theirs = by_method(ON, 500.0)?;
    let [_, their_warm, _, _, let_in] = theirs[theirs.len() / 2];
    let shape = (0..theirs.len()).map(|k| (theirs[k][1] / their_warm - coarse[k][1] / warm).abs()).fold(0.0, f64::max);
    let method = |column: usize| theirs.iter().map(|row| [row[0] / 3600.0, row[column]]).collect();
    let hours = |column: usize| coarse.iter().map(|row| [row[0] / 3600.0, row[column]]).collect();
    let closed = (0..coarse.len()).map(|k| [coarse[k][0] / 3600.0, radial[100 * k]]).collect();
    let half = coarse.iter().find(|row| row[0] > ON && row[1] < 0.5 * warm).map_or(f64::NAN, |row| row[0] - ON);
    Ok(Figure {
        item: "B 17",
        title: "Mean temperatures with the heat switched on and off",
        status: Status::NotStated,
        parameters: "Base of Paper B, P = 10 kN/m, 50 km/h, steps of 500 s. The duration, 30 000 s on and as long off, and the places of \
                     the arcs, ±90°, are assumed.",
        finding: format!(
            "The wheel warms to {warm:.4} K ({end:.4} K in the end) and has lost half of it {:.0} min after the heat is off. An annulus that \
             conducts along the radius and loses in the contact what a stationary one loses there does the same within {:.2} %. Steps of \
             125 s change {:.2} %. The thesis's own steps in time (backward Euler of 500 s, quadratic bubbles) warm the wheel to {their_warm:.4} K, and over that they are within \
             {shape:.4} of ours all the time: the chords of its rims let in {let_in:.1} W/m by then, so that it cools more slowly.",
            half / 60.0,
            100.0 * worst,
            100.0 * steps
        ),
        plots: vec![
            temperatures(
                vec![
                    curve(Source::Ours, "wheel", hours(1)),
                    curve(Source::Method, "thesis's method, wheel", method(1)),
                    curve(Source::Exact, "annulus that conducts along the radius", closed),
                ],
                "time in h",
            ),
            temperatures(
                vec![curve(Source::Ours, "rail", hours(2)), curve(Source::Method, "thesis's method, rail", method(2))],
                "time in h",
            ),
        ],
        values: vec![
            ("b17.warm".into(), warm),
            ("b17.half_time".into(), half),
            ("b17.method.warm".into(), their_warm),
            ("b17.method.off".into(), shape),
        ],
        predicates: vec![
            must(format!("within 1 % of the annulus that conducts along the radius: {worst:.4}"), worst < 0.01),
            must(format!("a quarter of the step changes less than 1 %: {steps:.4}"), steps < 0.01),
            must(format!("heat is balanced to 1e-8: {residual:.1e}"), residual < 1e-8),
            balanced(largest(theirs[1..].iter().map(|row| row[3]))),
            must(format!("the thesis's method warms and cools as ours within 0.05: {shape:.4}"), shape < 0.05),
            must("the stationary mean is never exceeded", coarse.iter().all(|row| row[1] <= end * (1.0 + 1e-6))),
        ],
    })
}
