//! Moving heat sources on a half-space; what a body without exchange keeps; mirror images.

use crate::common;
use crate::heat_common::*;
use wheelrail::analytic::moving_source;
use wheelrail::heat::*;
use wheelrail::piecewise::Piecewise;

const A: f64 = 0.761e-3;

#[test]
fn moving_sources_at_peclet_864_reach_the_temperatures_of_the_half_space() {
    let v = 50.0 * KMH;
    let elliptic = |xi: f64| (1.0 - xi * xi).max(0.0).sqrt();
    let parabolic = |xi: f64| (1.0 - xi * xi).max(0.0);
    let cases = [("elliptic", &elliptic as &dyn Fn(f64) -> f64, 7.101686e-7), ("parabolic", &parabolic, 6.35944e-7)];
    let config = with(config(1e5, v), |c| {
        (c.half_width, c.zone) = (A, 1.5 * A);
        (c.heat_ratio, c.wheel_share) = (1.0, 0.0);
    });
    let heat = heat(&config);
    let effusivity = (config.material.conductivity * config.heat_capacity()).sqrt();
    for (name, q, reference) in cases {
        let friction_power = Piecewise::sampled(-A, A, 400, |x| q(x / A));
        let exchange = Exchange { friction_power, ..Exchange::default() };
        let (state, _) = heat.stationary(v, 0.0, &exchange).unwrap();
        let t = heat.temperatures(&state);
        common::figure(&format!("jaeger.{name}"), &[deviation(t.rail_max, reference)]);
        println!("{name}: maximum {:.6e} ({:+.3} %)", t.rail_max, 100.0 * deviation(t.rail_max, reference));
        assert!(deviation(t.rail_max, reference).abs() < 2e-3);
        let mut worst = 0.0_f64;
        for i in 0..=200 {
            let x = A * (1.0 - 2.5 * f64::from(i) / 200.0);
            let [_, rail] = heat.surface_temperatures(&state, x).unwrap();
            worst = worst.max((rail - moving_source(x, A, v, effusivity, &|x| q(x / A))).abs() / reference);
        }
        println!("{name}: largest deviation of the profile {:.3} % of the maximum", 100.0 * worst);
        assert!(worst < 1e-2);
    }
}

/// Without conduction between the bodies each keeps its share of the heat: `2q √(t/(π kρc))` far from the edges of the source,
/// while both stand; down to the depth d there are `q t (1 − 4 i²erfc(d/√(4κt)))` (Carslaw & Jaeger, *Conduction of Heat in
/// Solids*, 2.9). The layer that swells is a quarter of the half-width deep.
#[test]
fn bodies_that_do_not_conduct_to_each_other_warm_by_their_shares_of_the_heat() {
    let (flux, share, ratio, steps, step) = (1e8, 0.3, 0.6, 20, 5e-5);
    let config = with(config(1e5, 50.0), |c| {
        (c.wheel_share, c.heat_ratio, c.conductance) = (share, ratio, 0.0);
    });
    let (heat, mut scratch) = (heat(&config), HeatScratch::default());
    let friction_power = Piecewise { x: vec![-A, A], value: vec![flux; 2] };
    let exchange = Exchange { patches: vec![Interval { low: -A, high: A }], friction_power, ..Exchange::default() };
    let mut state = heat.initial(0.0, 0.0);
    let (mut to_wheel, mut to_rail) = (0.0, 0.0);
    for _ in 0..steps {
        let flows = heat.advance(&mut state, step, 0.0, 0.0, &exchange, &mut scratch);
        (to_wheel, to_rail) = (flows.to_wheel, flows.to_rail);
    }
    let time = f64::from(steps) * step;
    let whole = 2.0 * ratio * flux * (time / (std::f64::consts::PI * 45.0 * 8000.0 * 460.0)).sqrt();
    let (seen, mut means) = (heat.observed(&state), Default::default());
    let within = |depth: f64| {
        let x = depth / (4.0 * time * config.diffusivity()).sqrt();
        let twice =
            0.25 * ((1.0 + 2.0 * x * x) * libm::erfc(x) - 2.0 * x / std::f64::consts::PI.sqrt() * (-x * x).exp());
        ratio * flux * time / config.heat_capacity() * (1.0 - 4.0 * twice)
    };
    let (layer, core) = (0.25 * config.half_width, 0.16 * config.half_width);
    heat.mean_over_depth(&state, core, &mut means).unwrap();
    let t = seen.temperatures;
    for (body, (name, found, flow, part)) in
        [("wheel", t.wheel_centre, to_wheel, share), ("rail", t.rail_centre, to_rail, 1.0 - share)]
            .into_iter()
            .enumerate()
    {
        let middle = seen.layer[body].len() / 2;
        let (content, mean) = (seen.layer[body][middle], means[body][middle]);
        println!(
            "{name}: layer {content:.4e} for {:.4e} K m, mean {mean:.3} for {:.3} K",
            part * within(layer),
            part * within(core) / core
        );
        assert!(deviation(content, part * within(layer)).abs() < 5e-3);
        assert!(deviation(mean, part * within(core) / core).abs() < 5e-3);
        println!("{name}: {found:.4} K for {:.4} K, {flow:.3} W/m", part * whole);
        assert!(deviation(found, part * whole).abs() < 5e-3);
        assert!(deviation(flow, part * ratio * flux * 2.0 * A).abs() < 1e-9);
    }
}

/// Two half-spaces with a resistance between them that dominates: the heat that has passed in the time t is
/// `h ΔT t (e^{z²} erfc z − 1 + 2z/√π)/z²`, `z = 2h √t/√(kρc)` (Carslaw & Jaeger, 2.7, each surface against the mean of both).
#[test]
fn standing_bodies_exchange_heat_by_the_conductance_of_their_contact() {
    let (conductance, time, warm) = (2e5, 2e-5, 100.0);
    let config = with(config(1e5, 50.0), |c| c.conductance = conductance);
    let (heat, mut scratch) = (heat(&config), HeatScratch::default());
    let exchange = Exchange { patches: vec![Interval { low: -A, high: A }], ..Exchange::default() };
    let (mut state, mut passed, steps) = (heat.initial(warm, 0.0), 0.0, 40);
    for _ in 0..steps {
        let step = time / f64::from(steps);
        passed += step * heat.advance(&mut state, step, 0.0, 0.0, &exchange, &mut scratch).conduction;
    }
    let z = 2.0 * conductance * time.sqrt() / (45.0_f64 * 8000.0 * 460.0).sqrt();
    // (e^{z²} erfc z − 1 + 2z/√π)/z² = Σ (−z)^n/Γ(2 + n/2).
    let (mut sum, mut terms, mut power) = (0.0, [1.0, 0.75 * std::f64::consts::PI.sqrt()], 1.0);
    for n in 0..30 {
        sum += power / terms[n % 2];
        terms[n % 2] *= 2.0 + 0.5 * n as f64;
        power *= -z;
    }
    let expected = conductance * warm * time * 2.0 * A * sum;
    println!("{passed:.5e} J/m for {expected:.5e} J/m, {sum:.4} of a contact whose surfaces stay as they are");
    assert!(deviation(passed, expected).abs() < 0.01);
}

#[test]
fn a_warm_insulated_wheel_without_contact_keeps_its_temperature() {
    let heat = heat(&with(config(1e5, 50.0), |c| c.hub_held = false));
    let mut state = heat.initial(100.0, 0.0);
    let mut scratch = HeatScratch::default();
    let content = heat.heat_content(&state).unwrap()[0];
    for (k, dt) in [1e-6, 1e-3, 1.0, 500.0].into_iter().cycle().take(40).enumerate() {
        let omega = [0.0, 30.0, -100.0][k % 3];
        let flows = heat.advance(&mut state, dt, 10.0, omega, &Exchange::default(), &mut scratch);
        assert!(flows.stored_wheel.abs() < 1e-6, "{flows:?}");
    }
    let t = heat.temperatures(&state);
    let [surface, _] = heat.surface_temperatures(&state, 1.0).unwrap();
    println!(
        "mean {:+.1e}, contact {:+.1e}, tread {:+.1e} K off",
        t.wheel_mean - 100.0,
        t.wheel_centre - 100.0,
        surface - 100.0
    );
    assert!((t.wheel_mean - 100.0).abs() < 1e-9 && (t.wheel_centre - 100.0).abs() < 1e-9);
    assert!((surface - 100.0).abs() < 1e-9 && (heat.heat_content(&state).unwrap()[0] / content - 1.0).abs() < 1e-12);
}

#[test]
fn reversal_of_both_speeds_mirrors_the_temperatures() {
    let (load, v, creepage) = (1e5, 50.0 * KMH, -6e-4);
    let config = config(load, v);
    let heat = heat(&config);
    let forward = Exchange { sources: vec![HeatSource::on_tread(1.0, 0.3, 100.0)], ..carter(load, v, creepage) };
    let mirrored = |profile: &Piecewise| Piecewise {
        x: profile.x.iter().rev().map(|x| -x).collect(),
        value: profile.value.iter().rev().copied().collect(),
    };
    let backward = Exchange {
        friction_power: mirrored(&forward.friction_power),
        sources: vec![HeatSource::on_tread(-1.0, 0.3, 100.0)],
        ..forward.clone()
    };
    let omega = omega(v, creepage);
    let (mut one, mut two) = (heat.initial(5.0, 0.0), heat.initial(5.0, 0.0));
    let mut scratch = HeatScratch::default();
    for dt in [1e-4, 1e-2, 1.0] {
        let f = heat.advance(&mut one, dt, v, omega, &forward, &mut scratch);
        let b = heat.advance(&mut two, dt, -v, -omega, &backward, &mut scratch);
        let (t, u) = (heat.temperatures(&one), heat.temperatures(&two));
        println!("dt = {dt}: conduction {:.12e} and {:.12e}", f.conduction, b.conduction);
        assert!((f.conduction / b.conduction - 1.0).abs() < 1e-10);
        assert!((t.wheel_max / u.wheel_max - 1.0).abs() < 1e-10 && (t.rail_max / u.rail_max - 1.0).abs() < 1e-10);
        for x in [-1.2e-3, -3e-4, 0.0, 5e-4, 1e-2, 0.3] {
            let (p, q) = (heat.surface_temperatures(&one, x).unwrap(), heat.surface_temperatures(&two, -x).unwrap());
            assert!((0..2).all(|i| (p[i] - q[i]).abs() < 1e-10 * t.wheel_max), "x = {x}: {p:?} and {q:?}");
        }
    }
}
