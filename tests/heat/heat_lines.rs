//! Lines side by side in one heat step: each as if it were alone.

use crate::heat_common::*;
use wheelrail::heat::*;
use wheelrail::piecewise::Piecewise;

/// Exchange of a patch of the half-width `a` \[m] about `middle` \[m] with the friction power `power` [W/m²].
fn patch(a: f64, middle: f64, power: f64) -> Exchange {
    Exchange {
        patches: vec![Interval { low: middle - a, high: middle + a }],
        friction_power: Piecewise::sampled(middle - a, middle + a, 31, |x| power * (1.0 - (x - middle) / a)),
        ..Exchange::default()
    }
}

/// Largest difference of two fields relative to the largest value.
fn apart(a: &HeatState, b: &HeatState) -> f64 {
    let largest = a.values.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    a.values.iter().zip(&b.values).fold(0.0_f64, |most, (a, b)| most.max((a - b).abs())) / largest
}

/// Steps of all lines in one call against steps of each alone; the largest relative difference of fields and heat flows.
fn compare(name: &str, heat: &Heat, steps: usize, dt: f64, at: impl Fn(usize) -> ([f64; 2], Vec<Exchange>)) -> f64 {
    let count = at(0).1.len();
    let mut joined = vec![heat.initial(60.0, 0.0); count];
    let mut alone = joined.clone();
    let mut own: Vec<HeatScratch> = (0..count).map(|_| HeatScratch::default()).collect();
    let (mut scratch, mut worst, mut balance) = (HeatScratch::default(), 0.0_f64, 0.0_f64);
    for k in 0..steps {
        let ([v, omega], exchanges) = at(k);
        let mut next = vec![HeatState::default(); count];
        let mut lines: Vec<HeatLine> = joined
            .iter()
            .zip(&mut next)
            .zip(&exchanges)
            .map(|((state, next), exchange)| HeatLine::new(state, next, exchange))
            .collect();
        heat.step(&mut lines, dt, v, omega, &mut scratch).unwrap();
        let flows: Vec<HeatFlows> = lines.iter().map(|line| line.flows).collect();
        joined = next;
        for (l, exchange) in exchanges.iter().enumerate() {
            let mut next = HeatState::default();
            let mut line = [HeatLine::new(&alone[l], &mut next, exchange)];
            heat.step(&mut line, dt, v, omega, &mut own[l]).unwrap();
            let flow = line[0].flows;
            alone[l] = next;
            let scale = flow.friction.abs().max(flow.to_rail.abs()).max(1.0);
            worst = worst.max(apart(&alone[l], &joined[l])).max((flow.to_wheel - flows[l].to_wheel).abs() / scale);
            balance = balance.max(flows[l].relative_imbalance());
        }
    }
    println!("{name}: {worst:.1e} from each line alone, heat balance {balance:.1e}");
    assert!(balance < 1e-11, "{name}: {balance:e}");
    worst
}

/// Different patches and powers, one that lifts off, another rail, speeds that vary, a locked wheel in long steps, where
/// an iteration takes over: different orders of elimination leave round-off.
#[test]
fn lines_in_one_step_are_the_lines_alone() {
    let (load, v) = (1e5, 50.0 * KMH);
    let heat = heat(&config(load, 1.1 * v));
    let a = half_width(load);
    let lines = |f: f64| {
        vec![
            patch(a, 0.0, 1e6 * f),
            patch(0.8 * a, 0.1 * a, 3e6 * f),
            patch(0.3 * a, -0.4 * a, 2e5),
            Exchange::default(),
            patch(0.55 * a, 0.0, 0.0),
        ]
    };
    let rolling = compare("rolling", &heat, 40, 1e-3, |k| {
        let f = 1.0 + 0.01 * (k as f64).sin();
        ([v * f, 1.002 * v * f / RADIUS], lines(f))
    });
    let jumps = compare("jumps", &heat, 20, 1e-3, |k| {
        let f = if k % 7 == 6 { 2.0 } else { 1.0 };
        let mut exchanges = lines(f);
        exchanges[1].arriving = if k > 10 { 20.0 } else { 0.0 };
        if k % 5 == 4 {
            exchanges[2] = Exchange::default();
        }
        ([v, v / RADIUS], exchanges)
    });
    let locked = compare("locked", &heat, 10, 2e-2, |_| ([v, 0.0], lines(1.0)));
    assert!(rolling < 1e-13 && jumps < 1e-13, "{rolling:e} {jumps:e}");
    assert!(locked < 1e-11, "{locked:e}");
}

/// A molten line beside cold ones, and lines in any order.
#[test]
fn a_line_that_melts_leaves_the_others_alone() {
    let (load, v) = (1e5, 50.0 * KMH);
    let heat = heat(&with(config(load, 1.1 * v), |c| c.heat_ratio = 1.0));
    let a = half_width(load);
    let found = compare("melting", &heat, 30, 1e-3, |k| {
        let hot = if k < 20 { 2.5e9 } else { 0.0 };
        ([v, 0.0], vec![patch(a, 0.0, 1e6), patch(0.9 * a, 0.0, hot), patch(0.5 * a, 0.0, 2e6)])
    });
    assert!(found < 1e-12, "{found:e}");
}
