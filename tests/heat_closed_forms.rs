//! Moving heat sources on a half-space; what a body without exchange keeps; mirror images.

mod common;
mod heat_common;
use heat_common::*;
use wheelrail::analytic::moving_source;
use wheelrail::config::Hub;
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
        (c.thermal.heat_ratio, c.thermal.wheel_share) = (1.0, 0.0);
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

#[test]
fn a_warm_insulated_wheel_without_contact_keeps_its_temperature() {
    let heat = heat(&with(config(1e5, 50.0), |c| c.thermal.hub = Hub::Insulated));
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
