//! Paper D, section 6.1: six ramps of the creepage at constant velocity, by the product beside references and
//! stationary rolling.

use super::ramp_steps::{Bodies, CREEPAGE, GROWTH, Points, SPEED, creepage};
use super::{Figure, curve, largest, must};
use crate::ours::{Product, Run};
use crate::plot::{Curve, Plot, Source};
use crate::quoted::Status;

/// Durations of the six simulations \[s]. The first and the last are stated; half decades between them are assumed.
pub(super) const DURATIONS: [f64; 6] = [1e-3, 3.2e-3, 1e-2, 3.2e-2, 1e-1, 3.2e-1];
/// Time steps of a ramp.
const STEPS: usize = 400;

/// References of `F/μP` at tenths of the duration, for simulations 1, 3 and 5.
const REFERENCES: [(usize, [f64; 10]); 3] = [
    (0, [-0.0025, -0.0008, 0.0062, 0.0232, 0.0561, 0.1088, 0.1853, 0.2853, 0.4091, 0.5491]),
    (2, [0.0558, 0.3206, 0.5996, 0.8415, 0.9818, 1.0, 1.0, 1.0, 1.0, 1.0]),
    (4, [0.3034, 0.5891, 0.7975, 0.9326, 0.9949, 1.0, 1.0, 1.0, 1.0, 1.0]),
];

/// Paper D without centrifugal load, as the references.
pub(super) fn paper_d() -> Result<Product, String> {
    Product::with("paper_d", |config| {
        config.physics.centrifugal = false;
        config.tuning.tolerance = 0.0;
    })
}

/// A ramp in equal steps; `see` looks at the state after each, with the share of the duration.
pub(super) fn ramp(
    product: &Product,
    duration: f64,
    steps: usize,
    mut see: impl FnMut(f64, &Run),
) -> Result<(), String> {
    let mut run = product.rolling(SPEED, 0.0, |_| ())?;
    see(0.0, &run);
    for k in 1..=steps {
        let share = k as f64 / steps as f64;
        run.roll(SPEED, creepage(share));
        run.advance(duration / steps as f64)?;
        see(share, &run);
    }
    Ok(())
}

/// Utilisation over the share of the duration.
fn utilisation(product: &Product, duration: f64, steps: usize) -> Result<Vec<[f64; 2]>, String> {
    let mut points = Vec::new();
    ramp(product, duration, steps, |share, run| points.push([share, run.utilisation()]))?;
    Ok(points)
}

/// All six ramps, and stationary rolling at the same creepages, at every fortieth of the duration.
fn forces(product: &Product) -> Result<(Vec<Points>, Points), String> {
    let all = DURATIONS.iter().map(|te| utilisation(product, *te, STEPS)).collect::<Result<Vec<_>, _>>()?;
    let shares = (0..=40).map(|i| f64::from(i) / 40.0);
    let slow = |share: f64| product.stationary(creepage(share), None).map(|state| [share, state.utilisation]);
    Ok((all, shares.map(slow).collect::<Result<Vec<_>, _>>()?))
}

/// Edges in the contact over its half-width, and steps of a ramp, by the thesis's own method.
pub(super) const EDGE: f64 = 0.4;
const COARSE: usize = 50;
/// Steps of a ramp whose tractions or temperatures are shown.
pub(super) const METHOD_STEPS: usize = 40;

/// Largest difference of a ramp from stationary rolling.
fn lag(points: &[[f64; 2]], slow: &[[f64; 2]]) -> f64 {
    let every = (points.len() - 1) / (slow.len() - 1);
    slow.iter().enumerate().fold(0.0_f64, |worst, (i, s)| worst.max((points[every * i][1] - s[1]).abs()))
}

/// Rate of the creepage [1/s].
fn rate(duration: f64) -> f64 {
    CREEPAGE.abs() / (GROWTH * duration)
}

fn plot(axis: &str, curves: Vec<Curve>) -> Plot {
    Plot { axes: ["time over duration".into(), axis.into()], curves }
}

/// Table D 1: rates of the six ramps and how far each is from stationary rolling.
pub fn table() -> Result<Figure, String> {
    let product = paper_d()?;
    let (all, slow) = forces(&product)?;
    let lags: Vec<f64> = all.iter().map(|points| lag(points, &slow)).collect();
    let halves = DURATIONS.map(|te| {
        let coarse = utilisation(&product, te, STEPS / 4)?;
        let fine = utilisation(&product, te, STEPS / 2)?;
        Ok::<f64, String>((coarse[STEPS / 4][1] - fine[STEPS / 2][1]).abs().max((coarse[50][1] - fine[100][1]).abs()))
    });
    let halves = halves.into_iter().collect::<Result<Vec<_>, _>>()?;
    let step = halves.iter().fold(0.0_f64, |worst, off| worst.max(*off));
    let rows: Vec<String> =
        DURATIONS.iter().zip(&lags).map(|(te, lag)| format!("{te:.1e} s, {:.1e} 1/s, {lag:.3}", rate(*te))).collect();
    let points = DURATIONS.iter().zip(&lags).map(|(te, lag)| [rate(*te).log10(), *lag]).collect();
    Ok(Figure {
        item: "D T1",
        title: "Six ramps of the creepage: duration, rate, largest difference from stationary rolling",
        status: Status::NotStated,
        parameters: "Base of Paper D, P = 100 kN/m, μ = 0.4, 50 km/h, ξ from 0 to −8e-4 in 70 % of the duration; durations as the \
                     table has them. 400 steps, BDF2; without centrifugal load.",
        finding: format!("Duration, rate of the creepage, largest difference of F/μP: {}.", rows.join("; ")),
        plots: vec![Plot {
            axes: ["lg of the rate of creepage in 1/s".into(), "largest difference of F/μP".into()],
            curves: vec![curve(Source::Ours, "ours", points)],
        }],
        values: DURATIONS
            .iter()
            .zip(&lags)
            .flat_map(|(te, lag)| [(format!("dt1.lag.{te}"), *lag), (format!("closed.dt1.rate.{te}"), rate(*te))])
            .collect(),
        predicates: vec![
            must(
                "the slower the ramp, the nearer to stationary rolling",
                lags.windows(2).all(|pair| pair[1] < pair[0]),
            ),
            must(
                format!(
                    "the thesis's 100 and 200 steps differ by less than 0.02 at half the time and at the end: {step:.4}"
                ),
                step < 0.02,
            ),
            must(format!("the slowest within 0.02: {:.4}", lags[5]), lags[5] < 0.02),
        ],
    })
}

/// Figures D 7 and 8: force over time of the six ramps.
pub fn force() -> Result<Figure, String> {
    let product = paper_d()?;
    let (all, slow) = forces(&product)?;
    let off = |(i, reference): &(usize, [f64; 10])| {
        let tenth = |k: usize| all[*i][(k + 1) * STEPS / 10][1];
        (0..10).fold(0.0_f64, |worst, k| worst.max((tenth(k) - reference[k]).abs()))
    };
    let tenths = |points: &Points, reference: &[f64; 10]| {
        let tenth = |k: usize| points[(k + 1) * COARSE / 10][1] - reference[k];
        largest((0..10).map(|k| tenth(k).abs()))
    };
    // The thesis's own method; the middle one of its ramps also on a wheel that is refined once less.
    let (fine, coarse) = (Bodies::new(EDGE, 2)?, Bodies::new(EDGE, 1)?);
    let theirs = REFERENCES[1..]
        .iter()
        .map(|(i, reference)| fine.forces(DURATIONS[*i], COARSE).map(|points| (*i, points, reference)));
    let theirs = theirs.collect::<Result<Vec<_>, _>>()?;
    let far = largest(theirs.iter().map(|(_, points, reference)| tenths(points, reference)));
    let (_, middle) = &REFERENCES[1];
    let stiff = tenths(&coarse.forces(DURATIONS[2], COARSE)?, middle);
    let near = tenths(&theirs[0].1, middle);
    let full = theirs.iter().map(|(_, points, _)| points[COARSE][1]).fold(f64::INFINITY, f64::min);
    let worst = REFERENCES.iter().map(off).fold(0.0, f64::max);
    let exceeds = all.iter().flatten().fold(0.0_f64, |worst, point| worst.max(point[1] - 1.0));
    let (last, before) = (lag(&all[5], &slow), lag(&all[4], &slow));
    let mut curves: Vec<Curve> = all
        .iter()
        .enumerate()
        .map(|(i, points)| curve(Source::Ours, format!("{}: {} s", i + 1, DURATIONS[i]), points.clone()))
        .collect();
    curves.push(curve(Source::Exact, "stationary", slow));
    let points = |(_, reference): &(usize, [f64; 10])| (0..10).map(|k| [0.1 * (k + 1) as f64, reference[k]]).collect();
    curves.extend(REFERENCES.iter().map(|r| curve(Source::Exact, format!("reference {}", r.0 + 1), points(r))));
    let drawn = |(i, points, _): &(usize, Points, _)| {
        curve(Source::Method, format!("thesis's method, {}", i + 1), points.clone())
    };
    curves.extend(theirs.iter().map(drawn));
    Ok(Figure {
        item: "D 7–8",
        title: "Tangential force during six ramps of the creepage",
        status: Status::Agrees,
        parameters: "As table D 1.",
        finding: format!(
            "Simulation 6, {:.1e} 1/s, is within {last:.3} of the limit of stationary rolling, simulation 5, {:.1e} 1/s, within {before:.3}: \
             the stated 4e-3 1/s, below which rolling is called quasi-static, is a rate of creepage. The thesis's own step in time (backward \
             Euler, 50 steps, linear triangles with edges of 0.4 a, mean of traction and braking) follows within {far:.3}; simulation 3 \
             within {near:.3}, but {stiff:.3} where the whole wheel is refined once less: long linear triangles twist too little.",
            rate(DURATIONS[5]),
            rate(DURATIONS[4])
        ),
        plots: vec![plot("F/μP", curves)],
        values: vec![
            ("d78.lag.6".into(), last),
            ("d78.lag.5".into(), before),
            ("d78.method.3".into(), near),
            ("d78.method.3.coarse".into(), stiff),
        ],
        predicates: vec![
            must(format!("simulations 1, 3 and 5 within 0.01 of the references: {worst:.4}"), worst < 0.01),
            must(
                format!("below 4e-3 1/s within 0.02 of stationary rolling, at 1.1e-2 1/s not: {last:.4}, {before:.4}"),
                last < 0.02 && before > 0.02,
            ),
            must(format!("the thesis's method within 0.05 of the references: {far:.4}"), far < 0.05),
            must(
                format!("a wheel refined once less follows simulation 3 worse by half or more: {stiff:.4}, {near:.4}"),
                stiff > 1.5 * near,
            ),
            must(format!("the thesis's method ends in full slip: {full:.4}"), full > 0.999),
            must(format!("the limit is never exceeded: {exceeds:.1e}"), exceeds < 1e-9),
        ],
    })
}

/// Figure D 10: temperature at the nominal contact point.
pub fn temperature() -> Result<Figure, String> {
    let product = paper_d()?;
    let mut all = Vec::new();
    for duration in DURATIONS {
        let mut points = Vec::new();
        ramp(&product, duration, STEPS, |share, run| {
            let warmth = run.warmth();
            let outputs = run.outputs();
            let slip = if share > 0.0 { outputs.contact_tread_slip / outputs.contact_slip_velocity } else { 0.0 };
            points.push([share, warmth.wheel_centre, warmth.rail_centre, slip]);
        })?;
        all.push(points);
    }
    let ends: Vec<[f64; 2]> = all.iter().map(|points| [points[STEPS][1], points[STEPS][2]]).collect();
    // The two fastest are still cold in the first half.
    let cold = all[..2].iter().all(|points| points[STEPS / 2][1] < 0.01 * all[5][STEPS / 2][1]);
    let ordered = |k: usize| all[1..].windows(2).all(|pair| pair[0][k][1] < pair[1][k][1]);
    let first_half = (STEPS * 2 / 5..=STEPS / 2).all(ordered);
    let at_end = [0, 2, 3, 4].into_iter().zip([2, 3, 4, 5]).all(|(i, j)| ends[i][0] < ends[j][0]);
    let slips: Vec<f64> = all.iter().map(|points| points[STEPS][3]).collect();
    let of = |body: usize| {
        let points = |points: &Vec<[f64; 4]>| points.iter().map(|p| [p[0], p[body]]).collect();
        let lines = all
            .iter()
            .enumerate()
            .map(|(i, p)| curve(Source::Ours, format!("{}: {} s", i + 1, DURATIONS[i]), points(p)));
        lines.collect::<Vec<_>>()
    };
    // A body that comes in cold and is heated since; the warm wheel of stationary rolling has come round before.
    let still = product.rolling(SPEED, CREEPAGE, |_| ())?.warmth();
    let references = [still.wheel_centre / 0.018_735_81 - 1.0, still.rail_centre / 0.017_768_66 - 1.0];
    let slowest = ends[5];
    // The thesis's own method, displacements and temperatures in one iteration: simulations 2 and 6, the last also on a
    // finer mesh.
    let (bodies, finer) = (Bodies::new(EDGE, 1)?, Bodies::new(0.5 * EDGE, 1)?);
    let [quick, slow] =
        [bodies.temperatures(DURATIONS[1], METHOD_STEPS)?, bodies.temperatures(DURATIONS[5], METHOD_STEPS)?];
    let fine = finer.temperatures(DURATIONS[5], METHOD_STEPS)?;
    let [quick_end, slow_end, fine_end] = [&quick, &slow, &fine].map(|points| points[METHOD_STEPS][1]);
    let mut wheel = of(1);
    let theirs = [("2, edges of 0.4 a", quick), ("6, edges of 0.4 a", slow), ("6, edges of 0.2 a", fine)];
    wheel.extend(theirs.map(|(name, points)| curve(Source::Method, format!("thesis's method, {name}"), points)));
    let values = ends.iter().enumerate().map(|(i, end)| (format!("d10.wheel.{}", i + 1), end[0]));
    let values = values.chain([
        ("d10.method.2".into(), quick_end),
        ("d10.method.6".into(), slow_end),
        ("d10.method.6.fine".into(), fine_end),
        ("d10.method.share".into(), slow_end / slowest[0]),
        ("d10.method.share.fine".into(), fine_end / slowest[0]),
        ("d10.method.over".into(), quick_end / slow_end),
        ("d10.over".into(), ends[1][0] / slowest[0]),
    ]);
    Ok(Figure {
        item: "D 10",
        title: "Temperature at the nominal contact point during six ramps",
        status: Status::Qualitative,
        parameters: "As table D 1.",
        finding: format!(
            "From bottom to top 1 to 6, as in the thesis, until half of the duration. Then simulations 3 and 2 swing over the slow ones: at the \
             end simulation 2 has {:.2e} K, the slowest {:.2e} K, since the tread, which swings on the hub in 3.5 ms, has {:.2} of the \
             prescribed slip. Stationary rolling has {:.2e} K, more than half of it a warm wheel, for which all ramps are too short. The thesis's \
             own step in time (40 steps, displacements and temperatures in one iteration) has {:.2} of our temperature at the end of \
             simulation 6 with edges of 0.4 a, {:.2} with 0.2 a: such edges are ten and five times as long as the layer that is warm, and what they \
             show is theirs. Simulation 2 ends {:.2} times warmer than 6 there, too (ours {:.2}).",
            ends[1][0],
            slowest[0],
            slips[1],
            still.wheel_centre,
            slow_end / slowest[0],
            fine_end / slowest[0],
            quick_end / slow_end,
            ends[1][0] / slowest[0]
        ),
        plots: vec![plot("wheel, K over the reference", wheel), plot("rail, K over the reference", of(2))],
        values: values.collect(),
        predicates: vec![
            must("from bottom to top 1 to 6 from 0.4 to 0.5 of the duration, 1 and 2 still cold", cold && first_half),
            must("so at the end, too, without simulation 2", at_end),
            must(
                format!(
                    "simulation 2 ends with 1.2 times the prescribed slip or more, 5 and 6 with that within 1 %: {slips:.3?}"
                ),
                slips[1] > 1.2 && slips[4..].iter().all(|slip| (slip - 1.0).abs() < 0.01),
            ),
            must(
                format!(
                    "stationary within 2 % of the reference, 0.01874 and 0.01777 K: {:+.4}, {:+.4}",
                    references[0], references[1]
                ),
                references.iter().all(|off| off.abs() < 0.02),
            ),
            must(
                format!(
                    "the thesis's method is too cold, and less so on edges half as long: {slow_end:.2e}, {fine_end:.2e} K"
                ),
                slow_end < fine_end && fine_end < slowest[0],
            ),
            must(
                format!(
                    "simulation 2 ends warmer than 6 by its own method, too, by 1.3 to 1.7: {:.2}",
                    quick_end / slow_end
                ),
                (1.3..1.7).contains(&(quick_end / slow_end)),
            ),
            must("no ramp reaches it at its end", ends.iter().all(|end| end[0] < still.wheel_centre)),
        ],
    })
}
