//! Heat that spreads sideways between lines, against closed forms in three dimensions.

use crate::heat_common::*;
use std::f64::consts::PI;
use wheelrail::heat::*;
use wheelrail::piecewise::Piecewise;

/// Gauss–Legendre weights of seven points, from the middle outwards.
const WEIGHT: [f64; 4] =
    [0.417_959_183_673_469_4, 0.381_830_050_505_118_9, 0.279_705_391_489_276_6, 0.129_484_966_168_869_7];

/// Half-width of the patch along and across the rail \[m].
const A: f64 = 5e-3;
const B: f64 = 5e-3;

/// `erf(x) = 2/√π ∫₀ˣ e^{−t²} dt` by Simpson's rule.
fn erf(x: f64) -> f64 {
    let end = x.clamp(-7.0, 7.0);
    let (n, h) = (400, end / 400.0);
    let weight = |i: i32| if i == 0 || i == n { 1.0 } else { f64::from(2 + 2 * (i % 2)) };
    2.0 / PI.sqrt() * h / 3.0 * (0..=n).map(|i| weight(i) * (-(f64::from(i) * h).powi(2)).exp()).sum::<f64>()
}

/// Widths of the four lines of seven that are computed under a symmetric patch.
fn lines() -> [f64; 4] {
    WEIGHT.map(|weight| weight * B)
}

fn thick(rail: bool) -> HeatParameters {
    with(config(1e5, 20.0), |c| {
        (c.half_width, c.zone, c.reach) = (A, 1.5 * A, 1.5 * A);
        c.elements_per_half_width = 10;
        (c.heat_ratio, c.widths) = (1.0, None);
        c.wheel_share = if rail { 0.0 } else { 1.0 };
    })
}

fn content(heat: &Heat, cells: &LateralCells, states: &[HeatState]) -> f64 {
    let of = |state: &HeatState| heat.heat_content(state).unwrap().iter().sum::<f64>();
    states.iter().enumerate().map(|(i, state)| cells.width(i) * of(state)).sum()
}

fn mix(mixing: &LateralMixing, states: &mut [HeatState]) {
    mixing.apply(&mut states.iter_mut().collect::<Vec<_>>()).unwrap();
}

/// A band that is hot at the start, `½[erf((b−y)/√4αt) + erf((b+y)/√4αt)]`, as means over the cells.
#[test]
fn a_hot_band_spreads_as_the_error_function_and_keeps_its_heat() {
    let heat = heat(&thick(false));
    let alpha = heat.config().diffusivity();
    let mut errors = Vec::new();
    for count in [5, 10, 20] {
        let widths: Vec<f64> = vec![B / f64::from(count); 4 * count as usize];
        let cells = LateralCells::side_by_side(&widths).unwrap();
        let start = |i: usize| heat.initial(if i < count as usize { 100.0 } else { 0.0 }, 0.0);
        let mut states: Vec<HeatState> = (0..cells.len()).map(start).collect();
        let (before, mut time, mut worst) = (content(&heat, &cells, &states), 0.0, 0.0_f64);
        for _ in 0..20 {
            mix(&cells.conduction(alpha, 0.02), &mut states);
            time += 0.02;
        }
        let s = (4.0 * alpha * time).sqrt();
        let mut seen = Observation::default();
        for (i, state) in states.iter().enumerate() {
            heat.observe(state, &mut seen).unwrap();
            let y = (i as f64 + 0.5) * widths[i];
            let exact = 50.0 * (erf((B - y) / s) + erf((B + y) / s));
            let found = seen.temperatures.wheel_centre;
            assert!((0.0..=100.0).contains(&found), "{found}");
            worst = worst.max((found - exact).abs() / 100.0);
        }
        let lost = content(&heat, &cells, &states) / before - 1.0;
        println!("{count} cells in the half-width after {time:.2} s: largest error {worst:.1e}, heat {lost:+.1e}");
        assert!(lost.abs() < 1e-12);
        errors.push(worst);
    }
    let order = (errors[1] / errors[2]).log2();
    println!("order {order:.2}");
    assert!(order > 1.8 && errors[2] < 1e-3);
}

/// Mean of a unit box of the half-length `l` over itself after conduction for `t` seconds.
fn box_mean(l: f64, alpha: f64, t: f64) -> f64 {
    let u = l / (alpha * t).sqrt();
    erf(u) - (1.0 - (-u * u).exp()) / (PI.sqrt() * u)
}

/// Mean temperature under unit flux on a patch of a half-space since `time`: `√(α/π)/k ∫ M(a) M(b) dt/√t`; with `b`
/// infinite that of the plane.
fn patch_mean(b: f64, alpha: f64, conductivity: f64, time: f64) -> f64 {
    let n = 2000;
    let h = time.sqrt() / f64::from(n);
    // In r = √t the integrand is smooth.
    let f = |i: i32| {
        let t = (h * (f64::from(i) + 0.5)).powi(2);
        2.0 * box_mean(A, alpha, t) * if b.is_finite() { box_mean(b, alpha, t) } else { 1.0 }
    };
    (alpha / PI).sqrt() / conductivity * h * (0..n).map(f).sum::<f64>()
}

/// Mean temperature of the patch at 0.1, 1 and 10 s under unit flux on a standing wheel, by lines and the cells `rest`.
fn standing(rest: &[f64], share: f64) -> [f64; 3] {
    let heat = heat(&thick(false));
    let alpha = heat.config().diffusivity();
    let cells = LateralCells::half(&lines(), rest).unwrap();
    let heated = Exchange { friction_power: Piecewise::sampled(-A, A, 41, |_| 1e6), ..Exchange::default() };
    let idle = Exchange::default();
    let mut states = vec![heat.initial(0.0, 0.0); cells.len()];
    let (mut scratch, mut seen, mut mean) = (HeatScratch::default(), Observation::default(), [0.0; 3]);
    let (mut time, mut waited, mut entered) = (0.0, 0.0, 0.0);
    for (k, end) in [0.1, 1.0, 10.0].into_iter().enumerate() {
        let steps = if k == 0 { 50 } else { 90 };
        let dt = (end - time) / f64::from(steps);
        for _ in 0..steps {
            let mut next = vec![HeatState::default(); cells.len()];
            let exchange = |i: usize| if i < 4 { &heated } else { &idle };
            let fields = states.iter().zip(&mut next).enumerate();
            let fields = fields.map(|(i, (state, next))| HeatLine::new(state, next, exchange(i)));
            let mut fields: Vec<_> = fields.collect();
            heat.step(&mut fields, dt, 0.0, 0.0, &mut scratch).unwrap();
            entered += dt * fields.iter().enumerate().map(|(i, f)| cells.width(i) * f.flows.to_wheel).sum::<f64>();
            states = next;
            waited += dt;
            if !rest.is_empty() && waited >= cells.spreading_time(alpha, share) {
                mix(&cells.conduction(alpha, waited), &mut states);
                waited = 0.0;
            }
        }
        time = end;
        for (i, state) in states[..4].iter().enumerate() {
            heat.observe(state, &mut seen).unwrap();
            let width = cells.width(i) / B;
            let found = wheelrail::piecewise::mean(heat.zone_x(), &seen.surface[0], -A, A);
            mean[k] += width * found / 1e6;
        }
    }
    let lost = content(&heat, &cells, &states) / entered - 1.0;
    println!("heat {lost:+.1e}");
    assert!(lost.abs() < 1e-9, "{lost:e}");
    mean
}

#[test]
fn a_standing_patch_warms_as_the_three_dimensional_half_space() {
    let c = thick(false);
    let (alpha, k) = (c.diffusivity(), c.material.conductivity);
    let times = [0.1, 1.0, 10.0];
    let exact = times.map(|t| patch_mean(B, alpha, k, t));
    let plane = times.map(|t| patch_mean(f64::INFINITY, alpha, k, t));
    let off = |found: [f64; 3]| [0, 1, 2].map(|i| 100.0 * (found[i] / exact[i] - 1.0));
    println!("plane, closed form: {:+.2?} % of the temperature", off(plane));
    println!("lines alone: {:+.2?} %", off(standing(&[], 1.0)));
    let half = 36.5e-3 - B;
    let [often, three] = [0.05, MIXED_AT].map(|share| off(standing(&[0.3 * B, 0.9 * B, half - 1.2 * B], share)));
    println!("three cells beside: {three:+.2?} %, mixed at 0.05 d²/α: {often:+.2?} %");
    assert!(often.iter().all(|off| off.abs() < 2.5), "{often:?}");
    // Heat of up to one interval has not spread yet.
    assert!(three.iter().all(|off| off.abs() < 3.5), "{three:?}");
}

/// Wide and narrow patches in turn: the heat stays, and no temperature leaves its bounds.
#[test]
fn lines_that_move_with_the_width_of_the_patch_keep_the_heat() {
    let heat = heat(&thick(false));
    let alpha = heat.config().diffusivity();
    let cells = |factor: f64| {
        let lines = lines().map(|width| factor * width);
        let used: f64 = lines.iter().sum::<f64>() - 0.5 * lines[0];
        LateralCells::half(&lines, &[5e-3, 36.5e-3 - 5e-3 - used]).unwrap()
    };
    let mut states: Vec<HeatState> = (0..6).map(|i| heat.initial(if i < 4 { 100.0 } else { 0.0 }, 0.0)).collect();
    let mut history = LateralHistory { waited: 0.0, cells: cells(1.0) };
    let (before, mut mixed) = (content(&heat, &cells(1.0), &states), 0);
    let mut last = cells(1.0);
    for k in 0..400 {
        let now = cells(1.0 + 0.07 * (0.3 * f64::from(k)).sin());
        if let Some(mixing) = history.advance(1e-3, &now, 0.0, alpha) {
            mix(&mixing, &mut states);
            mixed += 1;
            last = now;
        }
    }
    let lost = content(&heat, &last, &states) / before - 1.0;
    println!("{mixed} mixings, heat {lost:+.1e}");
    assert!(lost.abs() < 1e-12);
    let mut seen = Observation::default();
    for state in &states {
        heat.observe(state, &mut seen).unwrap();
        let found = seen.temperatures.wheel_centre;
        assert!((0.0..=100.0).contains(&found), "{found}");
    }
}

/// A hot line between colder ones: mixed as seldom as cells that differ little, it cooled by tens of kelvin at once.
#[test]
fn a_line_cools_to_its_neighbours_little_by_little_however_much_hotter_it_is() {
    let heat = heat(&thick(false));
    let alpha = heat.config().diffusivity();
    let cells = LateralCells::side_by_side(&[1.6e-3; 3]).unwrap();
    for excess in [3.0, 30.0, 800.0] {
        let mut states: Vec<HeatState> = [0.0, excess, 0.0].map(|t| heat.initial(t, 0.0)).into();
        let (mut history, mut seen, h) = (LateralHistory::default(), Observation::default(), 1e-4);
        let mut temperatures = |states: &[HeatState]| {
            let one = |state: &HeatState| {
                heat.observe(state, &mut seen).unwrap();
                seen.temperatures.wheel_centre
            };
            states.iter().map(one).collect::<Vec<_>>()
        };
        let (mut hot, mut fall, mut mixings) = (excess, 0.0_f64, 0);
        for _ in 0..1000 {
            let apart = temperatures(&states);
            if let Some(mixing) = history.advance(h, &cells, apart[1] - apart[0], alpha) {
                mix(&mixing, &mut states);
                mixings += 1;
                let now = temperatures(&states)[1];
                fall = fall.max(hot - now);
                hot = now;
            }
        }
        // Of three cells the middle one keeps 1/3 + 2/3 e^{−3αt/w²}.
        let left = excess * (1.0 + 2.0 * (-3.0 * alpha * (0.1 - history.waited) / 1.6e-3_f64.powi(2)).exp()) / 3.0;
        println!("{excess} K: {mixings} mixings, falls of at most {fall:.2} K, {hot:.4} K left of {left:.4} K");
        assert!((hot / left - 1.0).abs() < 1e-9);
        assert!(fall < 5.0);
        assert!(excess > 3.0 || mixings < 5, "small differences are mixed seldom");
    }
}

/// Between two lines of the width w whose middles lie d apart, a difference decays with the rate 2α/(wd).
#[test]
fn heat_crosses_a_gap_by_the_way_from_line_to_line_and_leaves_nothing_in_it() {
    let (width, diffusivity, time) = (1e-3, 1.36e-5, 0.05);
    for gap in [0.0, 1e-3, 27e-3] {
        let cells = LateralCells::side_by_side(&[width; 2]).unwrap().apart(&[0.0, gap]);
        let mixing = cells.conduction(diffusivity, time);
        let decayed = (-2.0 * diffusivity * time / (width * (width + gap))).exp();
        let errors = [mixing.share(0, 1) - 0.5 * (1.0 - decayed), mixing.share(1, 1) - 0.5 * (1.0 + decayed)];
        println!("gap {gap} m: {decayed:.3} of a difference left, errors {errors:?}");
        assert!(errors.iter().all(|error| error.abs() < 1e-14));
        assert!((cells.width(0) + cells.width(1) - 2.0 * width).abs() < 1e-18);
    }
}

/// Lines of a cold wheel that slide unevenly, mixed in every step: each field may lie below its coldest datum by the
/// margin of 0.09 K, and mixing adds nothing to it.
#[test]
fn undershoots_of_lines_do_not_add_up_when_their_heat_mixes() {
    let (heat, v) = (heat(&config(1e5, 20.0)), 15.0);
    let cells = LateralCells::side_by_side(&[2e-3; 3]).unwrap();
    let mixing = cells.conduction(heat.config().diffusivity(), 1e-3);
    let mut states = vec![heat.initial(0.0, 0.0); cells.len()];
    let (mut scratch, mut seen, mut lowest) = (HeatScratch::default(), Observation::default(), 0.0_f64);
    for k in 0..400 {
        let creepage = |line: usize| -1e-3 * (1.0 + ((k * (line + 1)) % 7) as f64);
        let exchanges: Vec<Exchange> = (0..cells.len()).map(|line| carter(1e5, v, creepage(line))).collect();
        let mut next = vec![HeatState::default(); cells.len()];
        let lines = states.iter().zip(&mut next).zip(&exchanges);
        let mut lines: Vec<_> = lines.map(|((state, next), exchange)| HeatLine::new(state, next, exchange)).collect();
        heat.step(&mut lines, 1e-3, v, v / RADIUS, &mut scratch).unwrap();
        states = next;
        mix(&mixing, &mut states);
        for state in &states {
            heat.observe(state, &mut seen).unwrap();
            lowest = lowest.min(seen.lowest);
        }
    }
    println!("coldest {lowest:.3} K");
    assert!((-0.0901..0.0).contains(&lowest), "{lowest}");
}
