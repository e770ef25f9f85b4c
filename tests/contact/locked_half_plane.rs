//! A locked wheel through the whole model, with heat that does not act back, against the closed solution of two
//! half-planes: strip sources in the wheel, which stands, moving sources in the rail, and a division of the heat node
//! by node.

use crate::common::*;
use nalgebra::{DMatrix, DVector};
use std::f64::consts::PI;
use wheelrail::config::{Config, CrossSection};
use wheelrail::simulation::{Inputs, Simulation};

/// Speed of the slide [m/s].
const SPEED: f64 = 60.0 * KMH;
/// Friction coefficient.
const FRICTION: f64 = 0.01;
/// Time in which friction sets in \[s].
const RISE: f64 = 2e-4;
/// Elements of the closed solution across the patch.
const ELEMENTS: usize = 60;
/// Steps up to the first of them.
const STEPS: u32 = 60;
/// Times of comparison \[s].
const TIMES: [f64; 6] = [0.003, 0.01, 0.03, 0.1, 0.3, 1.0];

/// Error function, by its series or the continued fraction of its complement (DLMF 7.6.1, 7.9.1).
fn erf(x: f64) -> f64 {
    if x.abs() < 2.5 {
        let mut term = x;
        let mut sum = x;
        for k in 1..60 {
            term *= -x * x / f64::from(k);
            sum += term / f64::from(2 * k + 1);
        }
        return 2.0 / PI.sqrt() * sum;
    }
    let y = x.abs();
    let tail = (1..60).rev().fold(0.0, |tail, k| 0.5 * f64::from(k) / (y + tail));
    (1.0 - (-y * y).exp() / (PI.sqrt() * (y + tail))).copysign(x)
}

/// Exponential integral `E₁(x) = ∫ e^{−t}/t dt` from x on, x > 0 (DLMF 6.6.2, 6.9.1).
fn exponential_integral(x: f64) -> f64 {
    if x < 1.0 {
        let (mut term, mut sum) = (1.0, -0.577_215_664_901_532_9 - x.ln());
        for k in 1..40 {
            term *= -x / f64::from(k);
            sum -= term / f64::from(k);
        }
        return sum;
    }
    let tail = (1..200).rev().fold(0.0, |tail, k| f64::from(k) / (1.0 + f64::from(k) / (x + tail)));
    (-x).exp() / (x + tail)
}

/// Rise \[K] of the surface of a half-plane at the distance `x` \[m] from the middle of a strip of half-width `half`
/// after the flux 1 W/m² for `time` \[s] (H. S. Carslaw, J. C. Jaeger, *Conduction of Heat in Solids*, 2nd ed., 10.3:
/// line sources `e^{−x²/4κt}/(2πkt)`, integrated over strip and time in closed form).
fn strip(x: f64, half: f64, time: f64, conductivity: f64, diffusivity: f64) -> f64 {
    if time <= 0.0 {
        return 0.0;
    }
    let root = time.sqrt();
    let side = |distance: f64| {
        let b = distance.abs() / (4.0 * diffusivity).sqrt();
        let part = root * erf(b / root) + b / PI.sqrt() * exponential_integral((b / root).powi(2).max(1e-300));
        part.copysign(distance)
    };
    (diffusivity / PI).sqrt() / conductivity * (side(half - x) + side(half + x))
}

/// The two steps between whose ends a time lies, by number from 0, and their shares; nothing before the first.
fn at(times: &[f64], then: f64) -> Vec<(usize, f64)> {
    let Some(k) = times.windows(2).position(|pair| then <= pair[1]).filter(|_| then > 0.0) else { return Vec::new() };
    let share = (then - times[k]) / (times[k + 1] - times[k]);
    if k == 0 { vec![(0, share)] } else { vec![(k, share), (k - 1, 1.0 - share)] }
}

/// Temperatures of wheel and rail over the reference \[K] in the middle and at their maximum, at [`TIMES`], under the
/// friction power `power` [W/m] over time with a Hertzian distribution over the half-width `a` \[m].
fn closed_solution(config: &Config, a: f64, power: &dyn Fn(f64) -> f64) -> Vec<[f64; 4]> {
    let (m, n) = (&config.material, ELEMENTS);
    let (diffusivity, effusivity) =
        (m.conductivity / (m.density * m.specific_heat), (m.conductivity * m.density * m.specific_heat).sqrt());
    let half = a / n as f64;
    let x: Vec<f64> = (0..n).map(|i| -a + half * (2.0 * i as f64 + 1.0)).collect();
    // Mean of √(1 − x²/a²) over each element, so that the heat is exact.
    let area = |u: f64| 0.5 * (u * (1.0 - u * u).max(0.0).sqrt() + u.clamp(-1.0, 1.0).asin());
    let shape: Vec<f64> = x.iter().map(|x| (area((x + half) / a) - area((x - half) / a)) / (PI * half)).collect();
    // The rail streams towards −x: T(x) = ∫ q/√(x′ − x) dx′/(e√(πV)) over what lies ahead.
    let ahead = |i: usize, j: usize| {
        let root = |edge: f64| (edge - x[i]).max(0.0).sqrt();
        2.0 * (root(x[j] + half) - root(x[j] - half)) / (effusivity * (PI * SPEED).sqrt())
    };
    let rail = DMatrix::from_fn(n, n, ahead);
    // Times that grow, through those of the comparison.
    let mut times = vec![0.0];
    for (&start, &end) in [1e-5_f64].iter().chain(&TIMES).zip(&TIMES) {
        let steps = ((end / start).ln() / 0.055).ceil();
        times.extend((0..steps as usize).map(|k| start * (end / start).powf(k as f64 / steps)));
    }
    times.push(TIMES[TIMES.len() - 1]);
    let unit = |time: f64| -> Vec<f64> {
        (0..n).map(|d| strip(2.0 * half * d as f64, half, time, m.conductivity, diffusivity)).collect()
    };
    let mut fluxes: Vec<DVector<f64>> = Vec::new();
    let mut seen = Vec::new();
    for step in 1..times.len() {
        let now = times[step];
        let since: Vec<Vec<f64>> = times[..=step].iter().map(|t| unit(now - t)).collect();
        let history = DVector::from_fn(n, |i, _| {
            let part = |(k, flux): (usize, &DVector<f64>)| -> f64 {
                (0..n).map(|j| (since[k][i.abs_diff(j)] - since[k + 1][i.abs_diff(j)]) * flux[j]).sum()
            };
            fluxes.iter().enumerate().map(part).sum::<f64>()
        });
        let own = DMatrix::from_fn(n, n, |i, j| since[step - 1][i.abs_diff(j)]);
        // The rail brings what it took up ahead a little earlier: friction heat less the wheel's share of that time.
        let (mut present, mut known) = (DMatrix::zeros(n, n), DVector::zeros(n));
        for i in 0..n {
            for (j, part) in shape.iter().enumerate().skip(i) {
                let then = now - (x[j] - x[i]) / SPEED;
                known[i] += rail[(i, j)] * part * power(then);
                for (k, share) in at(&times[..=step], then) {
                    match fluxes.get(k) {
                        Some(flux) => known[i] -= rail[(i, j)] * share * flux[j],
                        None => present[(i, j)] += rail[(i, j)] * share,
                    }
                }
            }
        }
        let heat = DVector::from_fn(n, |i, _| shape[i] * power(now));
        // q_w = ½q − k_c (T_w − T_r), T_w = history + own q_w, T_r = known − present q_w.
        let conductance = config.thermal.conductance;
        let matrix = DMatrix::identity(n, n) + conductance * (&own + &present);
        let right = 0.5 * &heat + conductance * (&known - &history);
        let wheel = matrix.lu().solve(&right).unwrap();
        let surface = [&history + &own * &wheel, &known - &present * &wheel];
        fluxes.push(wheel);
        if TIMES.iter().any(|time| (time / now - 1.0).abs() < 1e-9) {
            let middle = |t: &DVector<f64>| 0.5 * (t[n / 2 - 1] + t[n / 2]);
            seen.push([surface[0].max(), surface[1].max(), middle(&surface[0]), middle(&surface[1])]);
        }
    }
    seen
}

#[test]
fn a_locked_wheel_has_the_temperatures_of_two_half_planes_from_3_ms_to_1_s() {
    let mut config = preset("railway", 20);
    config.material.expansion = 0.0;
    // The closed solution is that of the plane.
    config.thermal.cross_section = CrossSection::Contact;
    (config.tuning.softening, config.tuning.tolerance) = (0.0, 0.0);
    let (reference, width) = (config.thermal.reference, config.model.contact_width);
    let model = model(config.clone());
    let mut inputs: Inputs = prescribed(&model, SPEED, 2.0);
    inputs.drive.friction = 0.0;
    let mut simulation = Simulation::new(model, &inputs).unwrap();
    let a = simulation.outputs().contact_half_width;
    let (mut power, mut computed) = (vec![(0.0, 0.0)], Vec::new());
    for (start, end) in [0.0].iter().chain(&TIMES).zip(&TIMES) {
        let steps = if *start == 0.0 { STEPS } else { 40 };
        for k in 1..=steps {
            let h = (end - start) / f64::from(steps);
            let time = start + h * f64::from(k);
            inputs.drive.friction = FRICTION * (time / RISE).min(1.0);
            simulation.advance(&inputs, h).unwrap();
            power.push((time, simulation.outputs().friction_power / width));
        }
        let o = simulation.outputs();
        computed.push(
            [o.temperature_wheel_max, o.temperature_rail_max, o.temperature_wheel_nominal, o.temperature_rail_nominal]
                .map(|t| t - reference),
        );
    }
    // The power is the mean of each step.
    let power = |time: f64| power.iter().find(|(end, _)| time <= *end + 1e-12).map_or(0.0, |(_, power)| *power);
    let expected = closed_solution(&config, a, &power);
    println!("steady friction power {:.5e} W/m, mu P V {:.5e}", power(0.9), FRICTION * 1e5 / width * SPEED);
    let mut worst = 0.0f64;
    for ((time, computed), expected) in TIMES.iter().zip(&computed).zip(&expected) {
        let errors: Vec<f64> = computed.iter().zip(expected).map(|(a, b)| 100.0 * (a / b - 1.0)).collect();
        println!("{time} s: {computed:.2?} K, closed {expected:.2?} K, {errors:+.3?} %");
        worst = errors.iter().fold(worst, |worst, error| worst.max(error.abs()));
    }
    assert!(worst < 0.5, "{worst} %");
}

#[test]
fn the_special_functions_are_the_tabulated_ones() {
    // Abramowitz & Stegun, tables 7.1 and 5.1.
    for (found, exact) in [
        (erf(0.5), 0.520_499_877_8),
        (erf(2.0), 0.995_322_265_0),
        (erf(-3.0), -0.999_977_909_5),
        (exponential_integral(0.5), 0.559_773_594_8),
        (exponential_integral(1.5), 0.100_019_582_4),
        (exponential_integral(4.0), 0.003_779_352_4),
    ] {
        assert!((found - exact).abs() < 1e-9, "{found} for {exact}");
    }
}
