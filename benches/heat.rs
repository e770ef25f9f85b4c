//! Cost of one two-body heat step and of the set-up, one core, default mesh.

use criterion::{Criterion, criterion_group, criterion_main};
use std::hint::black_box;
use wheelrail::config::presets;
use wheelrail::heat::{Exchange, Heat, HeatLine, HeatModel, HeatParameters, HeatScratch, HeatState, WheelStage};
use wheelrail::piecewise::Interval;
use wheelrail::piecewise::Piecewise;
use wheelrail::rolling::thermal::heat_parameters;
use wheelrail_numerics::linalg::vectorised::vectorised;

const HALF_WIDTH: f64 = 0.761e-3;
const SPEED: f64 = 50.0 / 3.6;
/// Implicit part of a step of 1 ms \[s].
const STEP: f64 = 0.3e-3;

fn config() -> HeatParameters {
    let zone = 1.5 * HALF_WIDTH;
    let preset = presets::parse(include_str!("../resources/paper_b.json")).expect("preset");
    HeatParameters {
        hub_held: true,
        max_speed: SPEED,
        smallest_load_ratio: 1.0,
        elements_per_half_width: 20,
        ..heat_parameters(&preset, HALF_WIDTH, zone, zone)
    }
}

fn heat(c: &mut Criterion) {
    c.bench_function("heat: meshes and modes", |b| b.iter(|| Heat::new(black_box(&config())).expect("meshes")));
    let heat = Heat::new(&config()).expect("meshes");
    let exchange = Exchange {
        patches: vec![Interval { low: -HALF_WIDTH, high: HALF_WIDTH }],
        friction_power: Piecewise::sampled(-HALF_WIDTH, HALF_WIDTH, 41, |x| 1e6 * (1.0 - x / HALF_WIDTH)),
        ..Exchange::default()
    };
    c.bench_function("heat: stationary rolling", |b| {
        b.iter(|| heat.stationary(SPEED, SPEED / 0.5, black_box(&exchange)).expect("stationary state"))
    });
    for (name, change, rolling) in [
        ("heat: step, nothing changes", 0.0, 1.0),
        ("heat: step, new step size and speeds", 1e-4, 1.0),
        ("heat: step, speeds change by percents", 1e-2, 1.0),
        ("heat: step, locked wheel", 1e-4, 0.0),
    ] {
        let (mut state, mut next) = (heat.initial(0.0, 0.0), HeatState::default());
        let mut scratch = HeatScratch::default();
        let mut k = 0_u32;
        c.bench_function(name, |b| {
            b.iter(|| {
                k += 1;
                let factor = 1.0 + change * f64::from(k % 7);
                let (dt, v) = (1e-3 * factor, SPEED * factor);
                let omega = rolling * v / 0.5;
                let mut line = [HeatLine::new(&state, &mut next, &exchange)];
                heat.step(&mut line, dt, v, omega, &mut scratch).expect("step");
                let flows = line[0].flows;
                std::mem::swap(&mut state, &mut next);
                flows
            })
        });
    }
}

vectorised! {
    /// Plain loops that do what [`WheelStage::run`] does, over the same arrays.
    fn plain<'a, S>(
        simd,
        rows: &'a [[f64; 5]],
        factors: [&'a [f64]; 5],
        weights: &'a [Vec<f64>; 4],
        loads: &'a [f64],
        from: &'a [f64],
        out: [&'a mut [f64]; 4],
    ) {
        let _ = simd;
        let ([w, r, d, row, column], [alpha, surface, peaks, lengths], [rate, next, sums, moved]) = (factors, weights, out);
        let (n, nm) = (rows.len(), alpha.len());
        let at = |i: usize| i * nm..(i + 1) * nm;
        for (i, &[below, sum, above, up, down]) in rows.iter().enumerate() {
            let (done, rest) = rate.split_at_mut(i * nm);
            let (moving, y) = (if i > 0 { &done[(i - 1) * nm..] } else { &w[at(0)] }, &mut rest[..nm]);
            let (before, here, after) = (&from[at((i + n - 1) % n)], &from[at(i)], &from[at((i + 1) % n)]);
            let w = &w[at(i)];
            for m in 0..nm {
                let (back, ahead) = (here[m] - before[m], here[m] - after[m]);
                let mass = sum * here[m] - below * back - above * ahead;
                y[m] = alpha[m] * mass + up * back + down * ahead + loads[i] * surface[m] - w[m] * moving[m];
            }
        }
        let (before, last) = rate.split_at_mut((n - 1) * nm);
        for (fill, y) in row.chunks_exact(nm).zip(before.chunks_exact(nm)) {
            for m in 0..nm {
                last[m] -= fill[m] * y[m];
            }
        }
        for m in 0..nm {
            last[m] *= d[(n - 1) * nm + m];
        }
        for (fill, y) in column.chunks_exact(nm).zip(before.chunks_exact_mut(nm)) {
            for m in 0..nm {
                y[m] -= fill[m] * last[m];
            }
        }
        for i in (0..n - 1).rev() {
            let (rest, done) = rate.split_at_mut((i + 1) * nm);
            let (moving, y, d, r) = (&done[..nm], &mut rest[at(i)], &d[at(i)], &r[at(i)]);
            for m in 0..nm {
                y[m] = y[m] * d[m] - r[m] * moving[m];
            }
        }
        sums.fill(0.0);
        for i in 0..n {
            let (rate, from, next) = (&rate[at(i)], &from[at(i)], &mut next[at(i)]);
            let mut distance = 0.0;
            for m in 0..nm {
                next[m] = from[m] + STEP * rate[m];
                sums[m] += lengths[i] * rate[m];
                distance += (next[m] - from[m]).abs() * peaks[m];
            }
            moved[i] = distance;
        }
    }
}

/// The passes of a stage beside plain loops over the same arrays.
fn passes(c: &mut Criterion) {
    let heat = Heat::new(&config()).expect("meshes");
    let mut stage = WheelStage::new(&heat, -SPEED, STEP).expect("factors");
    let (weights, n) = (stage.weights(), stage.rows().len());
    let nm = weights[0].len();
    let loads: Vec<f64> = (0..n).map(|i| 1e3 * (1.0 + (i as f64).sin())).collect();
    let from: Vec<f64> = (0..n * nm).map(|i| (0.37 * i as f64).sin()).collect();
    let arrays = || [n * nm, n * nm, nm, n].map(|size| vec![0.0; size]);
    let (mut by_pass, mut by_loop) = (arrays(), arrays());
    c.bench_function("heat: passes of a stage of the wheel", |b| {
        b.iter(|| stage.run(black_box(&loads), &from, by_pass.each_mut().map(|array| &mut array[..])))
    });
    c.bench_function("heat: the same by plain loops", |b| {
        b.iter(|| {
            let out = by_loop.each_mut().map(|array| &mut array[..]);
            plain(stage.rows(), stage.factors(), &weights, black_box(&loads), &from, out);
        })
    });
    for (pass, by_loop) in by_pass.iter().zip(&by_loop) {
        let largest = pass.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
        assert!(pass.iter().zip(by_loop).all(|(a, b)| (a - b).abs() <= 1e-9 * largest), "pass and loop differ");
    }
}

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(50);
    targets = heat, passes
}
criterion_main!(benches);
