//! Steps: order in time, any size, balances, restored states; conservative resampling; refused input.

use crate::heat_common::*;
use wheelrail::heat::*;
use wheelrail::piecewise::Piecewise;

/// Temperatures after one second of smoothly changing speed, load and tread heat, from the stationary state.
fn manoeuvre(heat: &Heat, steps: usize) -> [f64; 4] {
    let v = |t: f64| 14.0 - 6.0 * (1.0 - (2.0 * t).cos());
    let exchange = |t: f64| Exchange {
        sources: vec![HeatSource::on_tread(1.5, 0.8, 1e4 * (1.0 + 0.5 * (3.0 * t).sin()))],
        ..carter(1e5, v(t), -8e-4)
    };
    let (mut state, _) = heat.stationary(v(0.0), omega(v(0.0), -8e-4), &exchange(0.0)).unwrap();
    let mut scratch = HeatScratch::default();
    for k in 1..=steps {
        let t = k as f64 / steps as f64;
        heat.advance(&mut state, 1.0 / steps as f64, v(t), omega(v(t), -8e-4), &exchange(t), &mut scratch);
    }
    let t = heat.temperatures(&state);
    [t.wheel_mean, t.rail_mean, t.wheel_max, t.rail_max]
}

/// Orders of convergence from results with n, 2n, 4n … steps.
fn orders(results: &[f64]) -> Vec<f64> {
    let changes: Vec<f64> = results.windows(2).map(|r| r[0] - r[1]).collect();
    changes.windows(2).map(|c| (c[0] / c[1]).abs().log2()).collect()
}

#[test]
fn under_constant_exchange_the_field_converges_with_order_two() {
    // A wheel slides locked for a second: heat soaks into it, the rail streams past.
    let v = 50.0 * KMH;
    let heat = heat(&config(1e5, v));
    let exchange = carter(1e5, v, 2.0);
    let run = |steps: u32| {
        let (mut state, mut scratch) = (heat.initial(0.0, 0.0), HeatScratch::default());
        for _ in 0..steps {
            heat.advance(&mut state, 1.0 / f64::from(steps), v, 0.0, &exchange, &mut scratch);
        }
        let t = heat.temperatures(&state);
        let inside = |z: f64| heat.wheel_temperature(&state, 0.0, z).unwrap();
        [t.wheel_max, t.rail_max, inside(1e-3), inside(3e-3)]
    };
    // Steps of at least 10 ms, in which conduction around the standing wheel is computed exactly.
    let results = [10, 20, 40, 80].map(run);
    for (i, name) in ["wheel maximum", "rail maximum", "1 mm deep", "3 mm deep"].into_iter().enumerate() {
        let observed = orders(&results.map(|r| r[i]));
        println!("{name}: {:?}, orders {observed:.3?}", results.map(|r| r[i]));
        assert!((observed[1] - 2.0).abs() < 0.15, "{name}: observed orders {observed:.3?}");
    }
}

#[test]
fn under_varying_exchange_held_over_the_steps_the_order_is_one() {
    let heat = heat(&config(1e5, 50.0 * KMH));
    let results = [20, 40, 80, 160].map(|n| manoeuvre(&heat, n));
    for (i, name) in ["wheel mean", "rail mean", "wheel maximum", "rail maximum"].into_iter().enumerate() {
        let observed = orders(&results.map(|r| r[i]));
        println!("{name}: {:?}, orders {observed:.3?}", results.map(|r| r[i]));
        assert!((observed[1] - 1.0).abs() < 0.1, "{name}: observed orders {observed:.3?}");
    }
}

#[test]
fn steps_from_a_microsecond_to_500_seconds_stay_finite_and_balance() {
    let configs = [
        config(1e5, 50.0 * KMH),
        with(config(1e5, 50.0 * KMH), |c| (c.hub_held, c.convection) = (false, 30.0)),
        with(config(1e4, 80.0), |c| c.wheel_share = 0.8),
    ];
    for config in configs {
        let load = if config.half_width < 5e-4 { 1e4 } else { 1e5 };
        let heat = heat(&config);
        let mut state = heat.initial(50.0, 0.0);
        let mut scratch = HeatScratch::default();
        let mut worst = 0.0_f64;
        let mut highest = 0.0_f64;
        let rolling = [(14.0, -8e-4), (14.0, 2.0), (0.0, 0.0), (-5.0, 1e-3), (0.3, 0.05), (40.0, -0.5)];
        for (k, dt) in
            [1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 0.1, 1.0, 10.0, 100.0, 500.0].into_iter().cycle().take(60).enumerate()
        {
            let (v, creepage) = rolling[(k / 10 + k) % rolling.len()];
            let mut exchange = carter(load, v, creepage);
            exchange.sources = brake_blocks(200.0 * (k % 3) as f64);
            if k % 5 == 4 {
                exchange.patches.clear();
                exchange.friction_power = Piecewise::default();
            }
            let before = heat.heat_content(&state).unwrap();
            let flows = heat.advance(&mut state, dt, v, omega(v, creepage), &exchange, &mut scratch);
            let after = heat.heat_content(&state).unwrap();
            worst = worst.max(flows.relative_imbalance());
            let stored = [flows.stored_wheel, flows.stored_rail];
            for i in 0..2 {
                let error = (after[i] - before[i] - dt * stored[i]).abs();
                assert!(error < 1e-12 * (after[i].abs() + before[i].abs()) + 1e-10 * dt * stored[i].abs());
            }
            let t = heat.temperatures(&state);
            highest = highest.max(t.wheel_max.abs().max(t.rail_max.abs()));
            assert!(t.wheel_max.is_finite() && t.rail_max.is_finite());
        }
        println!("largest imbalance {worst:.1e}, highest temperature {highest:.1} K");
        assert!(worst < 1e-10 && highest < 1e3);
    }
}

#[test]
fn peak_temperature_of_a_sudden_lock_does_not_depend_on_the_step() {
    let v = 100.0 * KMH;
    let heat = heat(&config(1e5, v));
    let exchange = carter(1e5, v, 2.0);
    let peak = |dt: f64| {
        let rolling = carter(1e5, v, -4e-4);
        let (mut state, _) = heat.stationary(v, omega(v, -4e-4), &rolling).unwrap();
        let mut scratch = HeatScratch::default();
        let mut peak = 0.0_f64;
        for _ in 0..(0.02 / dt).round() as usize {
            heat.advance(&mut state, dt, v, 0.0, &exchange, &mut scratch);
            peak = peak.max(heat.temperatures(&state).wheel_max);
        }
        peak
    };
    let [fine, coarse] = [1e-5, 1e-3].map(peak);
    println!("peak {fine:.4} K at 1e-5 s, {coarse:.4} K at 1e-3 s ({:+.3} %)", 100.0 * deviation(coarse, fine));
    assert!(deviation(coarse, fine).abs() < 0.01);
}

#[test]
fn resampled_friction_heat_keeps_its_total() {
    let heat = heat(&config(1e5, 20.0));
    let mut scratch = HeatScratch::default();
    let mut seed = 12345_u64;
    let mut random = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 11) as f64 / (1_u64 << 53) as f64
    };
    let zone = heat.config().zone;
    for count in [2, 3, 17, 200] {
        let mut x: Vec<f64> = (0..count).map(|_| zone * (2.0 * random() - 1.0)).collect();
        x.sort_by(f64::total_cmp);
        if count > 3 {
            x[5] = x[4];
        }
        let value = x.iter().map(|_| 1e6 * random()).collect();
        let friction_power = Piecewise { x, value };
        let total = 0.1 * friction_power.integral();
        let exchange = Exchange { friction_power, ..Exchange::default() };
        let flows = heat.advance(&mut heat.initial(0.0, 0.0), 1e-3, 10.0, 20.0, &exchange, &mut scratch);
        println!("{count} points: {:.3e} W/m, deviation {:+.1e}", total, deviation(flows.friction, total));
        assert!(deviation(flows.friction, total).abs() < 1e-14);
    }
}

#[test]
fn a_restored_state_continues_bit_for_bit() {
    let heat = heat(&config(1e5, 20.0));
    let mut state = heat.initial(20.0, 0.0);
    let mut scratch = HeatScratch::default();
    let advance = |state: &mut HeatState, scratch: &mut HeatScratch, k: u32| {
        let v = 14.0 - 0.3 * f64::from(k);
        heat.advance(state, 1e-3 * f64::from(1 + k % 3), v, omega(v, -6e-4), &carter(1e5, v, -6e-4), scratch)
    };
    (0..10).for_each(|k| _ = advance(&mut state, &mut scratch, k));
    let bytes = postcard::to_stdvec(&state).unwrap();
    let mut restored: HeatState = postcard::from_bytes(&bytes).unwrap();
    println!("state of {} kB", bytes.len() / 1024);
    let mut fresh = HeatScratch::default();
    for k in 10..20 {
        assert_eq!(advance(&mut state, &mut scratch, k), advance(&mut restored, &mut fresh, k));
    }
    assert_eq!(state, restored);
}

#[test]
fn bad_input_is_refused_by_name_with_its_value() {
    let heat = heat(&config(1e5, 20.0));
    let good = carter(1e5, 14.0, -4e-4);
    let state = heat.initial(3.0, 0.0);
    let (mut next, mut scratch) = (HeatState::default(), HeatScratch::default());
    let mut refuse = |dt: f64, v: f64, omega: f64, exchange: &Exchange, words: &str| {
        let mut line = [HeatLine::new(&state, &mut next, exchange)];
        let message = heat.step(&mut line, dt, v, omega, &mut scratch).unwrap_err().to_string();
        println!("{message}");
        assert!(message.contains(words), "{message}");
    };
    refuse(0.0, 14.0, 28.0, &good, "step of 0 s");
    refuse(f64::NAN, 14.0, 28.0, &good, "step of NaN s");
    refuse(1e-3, f64::NAN, 28.0, &good, "velocity is NaN");
    refuse(1e-3, 14.0, f64::INFINITY, &good, "angular velocity is inf");
    let mut bad = good.clone();
    bad.friction_power.value[3] = f64::NAN;
    refuse(1e-3, 14.0, 28.0, &bad, "friction power: NaN is no finite number");
    let mut bad = good.clone();
    bad.friction_power.x.swap(3, 4);
    refuse(1e-3, 14.0, 28.0, &bad, "positions must ascend");
    let bad = Exchange { patches: vec![Interval { low: -1.0, high: 0.0 }], ..good.clone() };
    refuse(1e-3, 14.0, 28.0, &bad, "contact patch reaches x = -1 m");
    let bad = Exchange { sources: vec![HeatSource::on_tread(1.0, 0.1, f64::NAN)], ..good.clone() };
    refuse(1e-3, 14.0, 28.0, &bad, "heat of a source is NaN");
    let bad = Exchange { sources: vec![HeatSource::on_tread(f64::INFINITY, 0.1, 1.0)], ..good.clone() };
    refuse(1e-3, 14.0, 28.0, &bad, "angle of a heat source is inf");
    let bad = Exchange { patches: vec![Interval { low: 1e-4, high: -1e-4 }], ..good.clone() };
    refuse(1e-3, 14.0, 28.0, &bad, "contact patch from 0.0001 m to -0.0001 m");
    for (config, word) in [
        (with(config(1e5, 20.0), |c| c.rail_length = 1e-3), "rail.length = 0.001"),
        (HeatParameters { half_width: f64::NAN, ..config(1e5, 20.0) }, "half-width at model.nominal_load = NaN"),
        (with(config(1e5, 20.0), |c| c.smallest_load_ratio = 1e-6), "thermal.smallest_load_ratio"),
    ] {
        let message = Heat::new(&config).unwrap_err().to_string();
        println!("{message}");
        assert!(message.contains(word), "{message}");
    }
}

#[test]
fn heat_without_a_way_out_has_no_stationary_state() {
    let closed = heat(&with(config(1e5, 20.0), |c| c.hub_held = false));
    let a = half_width(1e5);
    let patches = vec![Interval { low: -a, high: a }];
    let heating = Exchange { sources: brake_blocks(60.0), patches, ..Exchange::default() };
    let refused = closed.stationary(0.0, 0.0, &heating).unwrap_err();
    println!("{refused}");
    assert!(matches!(refused, HeatError::NoStationaryState { .. }), "{refused:?}");
    assert!(refused.to_string().contains("thermal.hub") && refused.to_string().contains("thermal.convection"));
}

#[test]
fn a_state_of_another_mesh_is_refused() {
    let (ours, other) = (heat(&config(1e5, 20.0)), heat(&config(1e5, 2.0)));
    let foreign = other.initial(0.0, 0.0);
    let refused = ours.observe(&foreign, &mut Observation::default()).unwrap_err();
    assert!(matches!(refused, HeatError::StateSize { .. }) && !ours.fits(&foreign));
}

#[test]
fn rail_ahead_of_the_contact_is_not_undercooled_wherever_the_edge_lies() {
    let speed = 50.0 * KMH;
    let heat = heat(&with(config(1e5, speed), |c| c.conductance = 1e8));
    let a = half_width(1e5);
    for shift in [0.0, 0.004, 0.011, 0.023, 0.037, 0.049] {
        let patches = vec![Interval { low: -a * (1.0 - shift), high: a * (1.0 + shift) }];
        let exchange = Exchange { patches, ..Exchange::default() };
        let mut state = heat.initial(100.0, 0.0);
        let mut scratch = HeatScratch::default();
        for _ in 0..20 {
            heat.advance(&mut state, 1e-3, speed, omega(speed, 0.0), &exchange, &mut scratch);
        }
        let [_, rail] = heat.observed(&state).surface;
        let (lowest, highest) = rail.iter().fold((0.0f64, 0.0f64), |(l, h), t| (l.min(*t), h.max(*t)));
        println!("edge at {:.3} a: rail from {lowest:.3} to {highest:.1} K", 1.0 + shift);
        assert!(highest > 40.0 && lowest > -2e-3 * highest);
    }
}
