//! Paper A, figures 7 to 10: a wheel on a rough rail. The measured rail is not at hand; ours has its own spectrum and
//! seed.

use super::{Figure, corrugation::standard, curve, must};
use crate::paper_a::{self as a, LOAD, SPEED, STEP, case};
use crate::plot::{Curve, Plot, Source};
use crate::quoted::Status;
use crate::transient::Case;
use std::f64::consts::TAU;

/// Levels in dB re 1 µm of the one-third octaves from 12.5 cm to 4 cm, with peaks at 8 and 5 cm as the thesis's source
/// has them.
const LEVELS: [f64; 6] = [0.0, 2.0, 7.0, 2.0, 7.0, 0.0];
/// Length of the rail that is analysed, and what is rolled before it \[m].
const WAY: f64 = 8.3;
const START: f64 = 0.6;
/// Period of the seeded rail \[m].
const PERIOD: f64 = 40.0;

fn rail() -> String {
    let levels = LEVELS.map(|level| level.to_string()).join(", ");
    format!("roughness(levels = [{levels}], longest = 0.125, seed = 3, length = {PERIOD:?}, from = 0.1, blend = 0.2)")
}

/// Wavelengths \[m] of the bands and their levels in dB, from the mean squares of their Fourier lines.
fn bands() -> Result<Vec<[f64; 2]>, String> {
    let profile = a::profile(&rail())?;
    let (count, from) = (8192, 1.0);
    let height: Vec<f64> =
        (0..count).map(|i| profile.height(from + PERIOD * f64::from(i) / f64::from(count))).collect();
    let line = |k: usize| {
        let phase = |i: usize| TAU * ((k * i) % count as usize) as f64 / f64::from(count);
        let sum =
            height.iter().enumerate().fold([0.0; 2], |[c, s], (i, h)| [c + h * phase(i).cos(), s + h * phase(i).sin()]);
        2.0 * (sum[0] * sum[0] + sum[1] * sum[1]) / f64::from(count).powi(2)
    };
    let band = |i: usize| {
        let middle = 10f64.powf(-0.1 * (9.0 + i as f64));
        let [low, high] = [-0.05, 0.05].map(|tenth: f64| (PERIOD / middle * 10f64.powf(tenth)).ceil() as usize);
        let square: f64 = (low..high).map(line).sum();
        [middle, 10.0 * (square / 1e-12).log10()]
    };
    Ok((0..LEVELS.len()).map(band).collect())
}

/// Figure A 7: spectrum of the rail.
pub fn spectrum() -> Result<Figure, String> {
    let found = bands()?;
    let worst = found.iter().zip(LEVELS).fold(0.0_f64, |worst, ([_, level], wanted)| worst.max((level - wanted).abs()));
    let profile = a::profile(&rail())?;
    let highest = (0..40_000).map(|i| profile.height(1.0 + 1e-3 * f64::from(i)).abs()).fold(0.0, f64::max);
    let deviation = LEVELS.iter().map(|level| 10f64.powf(0.1 * level)).sum::<f64>().sqrt();
    let band = 1e-6 * (2.0 * 10f64.powf(0.7)).sqrt();
    let wanted = found.iter().zip(LEVELS).map(|([length, _], level)| [1e3 * length, level]).collect();
    Ok(Figure {
        item: "A 7",
        title: "Spectrum of the rough rail",
        status: Status::Qualitative,
        parameters: "The measured spectrum is not at hand. Assumed: one-third octaves of 0, 2, 7, 2, 7, 0 dB re 1 µm from 12.5 to 4 cm, seed 3, \
                     so that the peaks lie at 8 and 5 cm as its source says.",
        finding: format!(
            "{deviation:.1} µm root mean square, at most {:.1} µm. The thesis rescaled its rail to a highest amplitude of about 5 µm and does not \
             say whether that of the profile or of a line of the spectrum: the largest of our bands has {:.1} µm.",
            1e6 * highest,
            1e6 * band
        ),
        plots: vec![Plot {
            axes: ["wavelength in mm".into(), "level in dB re 1 µm".into()],
            curves: vec![
                curve(
                    Source::Ours,
                    "seeded rail, analysed",
                    found.iter().map(|[length, level]| [1e3 * length, *level]).collect(),
                ),
                curve(Source::Exact, "what it was made from", wanted),
            ],
        }],
        values: vec![("a7.highest".into(), highest), ("a7.worst_band".into(), worst), ("closed.a7.band".into(), band)],
        predicates: vec![must(format!("the seeded rail has its bands within 0.5 dB: {worst:.3}"), worst < 0.5)],
    })
}

/// Mean and standard deviation of forces.
fn moments(forces: &[f64]) -> [f64; 2] {
    let count = forces.len() as f64;
    let mean = forces.iter().sum::<f64>() / count;
    [mean, (forces.iter().map(|force| (force - mean).powi(2)).sum::<f64>() / count).sqrt()]
}

/// Probability density [m/MN] over the force [MN/m] as \[A] (7) has it, in forty classes.
fn density(forces: &[f64]) -> Vec<[f64; 2]> {
    let (low, high) = forces.iter().fold((f64::MAX, f64::MIN), |(low, high), f| (low.min(*f), high.max(*f)));
    let width = (high - low) / 40.0;
    let mut counts = [0usize; 40];
    forces.iter().for_each(|force| counts[(((force - low) / width) as usize).min(39)] += 1);
    let class = |(k, count): (usize, &usize)| {
        [1e-6 * (low + (k as f64 + 0.5) * width), *count as f64 / (1e-6 * width * forces.len() as f64)]
    };
    counts.iter().enumerate().map(class).collect()
}

/// The integral of a density.
fn integral(points: &[[f64; 2]]) -> f64 {
    points.iter().map(|point| point[1]).sum::<f64>() * (points[1][0] - points[0][0])
}

/// Forces of the product behind the start, at every step of the length that 100 km/h and 5e-5 s make.
fn ours(velocity: f64, load: f64, mass: f64) -> Result<Vec<f64>, String> {
    let product = a::product(&rail(), |config| config.wheel.hub_mass = mass)?;
    let mut run = product.rolling(velocity, 0.0, |inputs| inputs.drive.load = load)?;
    let (step, steps) = (SPEED * STEP / velocity, ((START + WAY) / (SPEED * STEP)).ceil() as usize);
    let points = a::follow(&mut run, step, steps)?;
    Ok(points.into_iter().filter(|point| point[0] > START).map(|point| point[1]).collect())
}

/// Figures A 8 to 10: probability density of the force over velocity, load and mass.
pub fn densities() -> Result<Figure, String> {
    const GROUPS: [(&str, [[f64; 3]; 3]); 3] = [
        ("velocity", [[50.0, 1.0, 0.0], [75.0, 1.0, 0.0], [100.0, 1.0, 0.0]]),
        ("load", [[100.0, 0.5, 0.0], [100.0, 1.0, 0.0], [100.0, 1.5, 0.0]]),
        ("mass", [[100.0, 1.0, 0.0], [100.0, 1.0, 1e3], [100.0, 1.0, 2e3]]),
    ];
    let base = ours(SPEED, LOAD, 0.0)?;
    let steps = ((START + WAY) / (SPEED * STEP)).ceil() as usize;
    let history = a::history(Case { step: STEP, ..case() }, &standard(), &rail(), steps)?;
    let theirs: Vec<f64> = history.iter().filter(|point| point[0] > START).map(|point| point[1]).collect();
    let (mut plots, mut found, mut areas) = (Vec::new(), Vec::new(), Vec::new());
    for (name, group) in GROUPS {
        let mut curves: Vec<Curve> = Vec::new();
        for [kmh, share, mass] in group {
            let standard = (kmh, share, mass) == (100.0, 1.0, 0.0);
            let forces = if standard { base.clone() } else { ours(kmh / 3.6, share * LOAD, mass)? };
            let points = density(&forces);
            areas.push(integral(&points));
            found.push(moments(&forces));
            let label = format!("{kmh} km/h, {:.2} MN/m, {mass:.0} kg/m more", 1e-6 * share * LOAD);
            curves.push(curve(Source::Ours, label, points));
            if standard {
                curves.push(curve(Source::Method, "thesis's method", density(&theirs)));
            }
        }
        plots.push(Plot { axes: [format!("force in MN/m, by {name}"), "probability density in m/MN".into()], curves });
    }
    let deviation = |i: usize| found[i][1];
    let own = moments(&theirs);
    let off = own[1] / deviation(2) - 1.0;
    let shift = (3..6).map(|i| (found[i][0] / (LOAD * GROUPS[1].1[i - 3][1]) - 1.0).abs()).fold(0.0, f64::max);
    let list =
        |from: usize| (from..from + 3).map(|i| format!("{:.3}", 1e-6 * deviation(i))).collect::<Vec<_>>().join(", ");
    Ok(Figure {
        item: "A 8–10",
        title: "Probability density of the force on a rough rail",
        status: Status::Qualitative,
        parameters: "Rail of figure A 7, 8.3 m behind a start of 0.6 m, steps of 1.39 mm (5e-5 s at 100 km/h), 6000 of them. Assumed: 50, 75, \
                     100 km/h; 2.35, 4.7, 7.05 MN/m; point masses of 0, 1, 2 t/m; classes of a fortieth of the range. Ours has a damper of the hub of the ratio that α₁ gives the bounce.",
        finding: format!(
            "Standard deviations in MN/m: {} over the velocity, {} over the load, {} over the mass. As stated, the density narrows at low \
             velocity, shifts with the load and changes with the mass. The thesis's method on a mesh of its size has {:.3} MN/m. It took 50 \
             min then.",
            list(0),
            list(3),
            list(6),
            1e-6 * own[1]
        ),
        plots,
        values: vec![("a8.deviation".into(), deviation(2)), ("a8.deviation.method".into(), own[1])],
        predicates: vec![
            must("every density integrates to 1", areas.iter().all(|area| (area - 1.0).abs() < 1e-9)),
            must("it narrows with lower velocity", deviation(0) < deviation(1) && deviation(1) < deviation(2)),
            must(format!("its mean is the load within 0.5 %: {shift:.4}"), shift < 5e-3),
            must("a mass widens it", deviation(6) < deviation(7) && deviation(6) < deviation(8)),
            must(format!("the thesis's method has our deviation within 10 %: {off:+.4}"), off.abs() < 0.1),
        ],
    })
}
