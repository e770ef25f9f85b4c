//! Waves in the rail and its ends, by the product's bodies.

use super::{Figure, curve, must};
use crate::plot::{Plot, Source};
use crate::quoted::Status;
use crate::waves::{Push, deviation, steel};
use wheelrail::config::RailEnds;

/// Elements of Paper A with the three steps in a quarter period that come next to its 10 µs; half the size with eight
/// steps.
const COARSE: (f64, i32) = (1.0 / 30.0, 3);
const FINE: (f64, i32) = (1.0 / 60.0, 8);
/// Paper A's velocity [m/s].
const SPEED: f64 = 100.0 / 3.6;

/// Four metres with free ends, one metre with quiet ones and one with free ones.
const CASES: [(f64, RailEnds, &str); 3] = [
    (4.0, RailEnds::Free, "4 m, free ends"),
    (1.0, RailEnds::Nonreflecting, "1 m, non-reflecting ends"),
    (1.0, RailEnds::Free, "1 m, free ends"),
];

/// Energy in the central metre of all cases.
fn energies((size, quarter): (f64, i32), speed: f64) -> Result<[Vec<f64>; 3], String> {
    let run = |i: usize| {
        let (length, ends, _) = CASES[i];
        Push { length, ends, speed, size, quarter }.energies().map_err(|error| error.to_string())
    };
    Ok([run(0)?, run(1)?, run(2)?])
}

/// Figures A 5 and 6: energy that stays in the central metre of the rail.
pub fn energy() -> Result<Figure, String> {
    let (rest, fine) = (energies(COARSE, 0.0)?, energies(FINE, 0.0)?);
    let [off, finer] = [&rest, &fine].map(|[four, quiet, _]| deviation(quiet, four));
    let moving = [SPEED, -SPEED].map(|speed| energies(COARSE, speed).map(|[four, quiet, _]| deviation(&quiet, &four)));
    let [along, against] = [moving[0].clone()?, moving[1].clone()?];
    let left = |history: &[f64]| history[history.len() - 1] / history[0];
    let [four, quiet, free] = [0, 1, 2].map(|i| left(&fine[i]));
    let material = steel();
    let arrival = [material.pressure_wave_speed(), material.shear_wave_speed()].map(|speed| 0.5e6 / speed);
    let step = Push { length: 1.0, ends: RailEnds::Free, speed: 0.0, size: FINE.0, quarter: FINE.1 }.step();
    let time = |k: usize| 1e6 * step * (k + FINE.1 as usize) as f64;
    let before = (0..fine[0].len()).filter(|k| time(*k) < arrival[0]).map(|k| (fine[0][k] / fine[0][0] - 1.0).abs());
    let leak = before.fold(0.0, f64::max);
    let curves = CASES.iter().zip(&fine).map(|((_, _, name), history)| {
        let points = history.iter().enumerate().map(|(k, energy)| [time(k), energy / history[0]]).collect();
        curve(Source::Ours, *name, points)
    });
    let mut curves: Vec<_> = curves.collect();
    let line = |x: f64, name: &str| curve(Source::Exact, name, (0..=40).map(|i| [x, f64::from(i) / 40.0]).collect());
    curves.extend([line(arrival[0], "pressure waves reach the end of 1 m"), line(arrival[1], "shear waves do")]);
    Ok(Figure {
        item: "A 5–6",
        title: "Energy in the central metre of the rail after a push",
        status: Status::Qualitative,
        parameters: "Plate 0.1 m high, point load of 5e4 rad/s for a quarter period, bilinear elements of 1/60 m (1/30 m, as the thesis, \
                     beside it), steps of 31.4 µs over 3 and 8: the 10 µs of the thesis do not divide the quarter period. Size of the \
                     load and velocity are not stated: the energy is relative, 0 and ±100 km/h assumed.",
        finding: format!(
            "Quiet ends follow the middle of four metres within {:.1} % of the energy ({:.1} % on elements of 1/30 m; {:.1} and {:.1} % \
             with the stream and against it). After 345 µs {:.0} % are left, and {:.0} % in four metres: the push excites a mode \
             near the first cut-off of the clamped layer that hardly travels. Free ends keep {:.0} %.",
            100.0 * finer,
            100.0 * off,
            100.0 * along,
            100.0 * against,
            100.0 * quiet,
            100.0 * four,
            100.0 * free
        ),
        plots: vec![Plot { axes: ["time in µs".into(), "energy over that at 31.4 µs".into()], curves }],
        values: vec![
            ("a56.off".into(), off),
            ("a56.off_fine".into(), finer),
            ("a56.left.four".into(), four),
            ("a56.left.quiet".into(), quiet),
            ("a56.arrival.pressure".into(), 1e-6 * arrival[0]),
            ("a56.arrival.shear".into(), 1e-6 * arrival[1]),
        ],
        predicates: vec![
            must(
                format!("quiet ends within 3 % of four metres on both meshes: {off:.4}, {finer:.4}"),
                off.max(finer) < 0.03,
            ),
            must(
                format!("a stream of ±100 km/h makes that not 5 % worse: {along:.4}, {against:.4}"),
                along.max(against) < 1.05 * off,
            ),
            must(format!("free ends keep all energy: {free:.9}"), (free - 1.0).abs() < 1e-9),
            must(format!("between 40 and 50 % are left in four metres: {four:.3}"), (0.4..0.5).contains(&four)),
            must(format!("nothing leaves four metres' middle before pressure waves can: {leak:.1e}"), leak < 1e-2),
        ],
    })
}
