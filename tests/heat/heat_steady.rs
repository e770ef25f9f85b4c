//! Stationary two-body temperatures against independently computed, mesh-converged values.

use crate::common;
use crate::heat_common::*;
use wheelrail::heat::*;

/// Prints name, value, reference; then asserts the relative deviation accepted for each.
fn compare(name: &str, pairs: &[(&str, f64, f64, f64)]) {
    for (what, value, reference, _) in pairs {
        if let Some(kind) = ["maximum", "mean"].into_iter().find(|kind| what.contains(kind)) {
            common::figure(&format!("heat.steady.{kind}"), &[deviation(*value, *reference)]);
        }
        println!(
            "{name}: {what} {value:.6e} (reference {reference:.6e}, {:+.3} %)",
            100.0 * deviation(*value, *reference)
        );
    }
    for (what, value, reference, limit) in pairs {
        assert!(deviation(*value, *reference).abs() < *limit, "{name}: {what} = {value} against {reference}");
    }
}

fn stationary(
    name: &str,
    config: &HeatParameters,
    v: f64,
    omega: f64,
    exchange: &Exchange,
) -> (Temperatures, HeatFlows) {
    let heat = heat(config);
    let (state, flows) = heat.stationary(v, omega, exchange).unwrap();
    common::round_off("heat.steady.balance", &[flows.relative_imbalance()], 1e-11);
    println!(
        "{name}: {} unknowns, {} iterations, balance {:.1e}",
        heat.unknowns(),
        flows.iterations,
        flows.relative_imbalance()
    );
    assert!(flows.relative_imbalance() < 1e-8);
    (heat.temperatures(&state), flows)
}

/// Deviations accepted of maxima and centre values, of means and flows.
const MAXIMUM: f64 = 3e-3;
const MEAN: f64 = 5e-3;

#[test]
fn rolling_contact_with_friction_heat() {
    let cases = [
        (
            1e5,
            -4e-4,
            [0.0122757, 0.01196097, 0.006742015, 0.006315412, 0.006931474, 1.813181e-6, 8.73182, 1.073405, 18.53705],
        ),
        (
            1e5,
            -8e-4,
            [0.02517578, 0.02445375, 0.01873581, 0.01776866, 0.01571567, 4.111745e-6, 19.79739, 2.433722, 42.02851],
        ),
        (
            1e4,
            -5e-5,
            [
                0.0001832111,
                0.0001772862,
                5.145811e-5,
                4.328644e-5,
                7.521697e-5,
                1.113944e-8,
                0.05111869,
                0.01164807,
                0.1138854,
            ],
        ),
    ];
    for (load, creepage, r) in cases {
        let v = 50.0 * KMH;
        let name = format!("P = {load:.0e}, xi = {creepage:.0e}");
        let (t, f) = stationary(&name, &config(load, v), v, omega(v, creepage), &carter(load, v, creepage));
        compare(
            &name,
            &[
                ("wheel maximum", t.wheel_max, r[0], MAXIMUM),
                ("rail maximum", t.rail_max, r[1], MAXIMUM),
                ("wheel centre", t.wheel_centre, r[2], MAXIMUM),
                ("rail centre", t.rail_centre, r[3], MAXIMUM),
                ("wheel mean", t.wheel_mean, r[4], MEAN),
                ("rail mean", t.rail_mean, r[5], MEAN),
                ("conduction", f.conduction, r[6], MEAN),
                ("to hub", f.to_hub, r[7], MEAN),
                ("outflow", f.outflow, r[8], MEAN),
            ],
        );
    }
}

#[test]
fn rail_chill() {
    let cases = [
        (50.0, [0.06039787, 0.05080656, 0.1107899, 5.870357e-6]),
        (100.0, [0.04577975, 0.03592571, 0.0814123, 2.93515e-6]),
    ];
    for (speed, r) in cases {
        let v = speed * KMH;
        let name = format!("chill at {speed} km/h");
        let a = half_width(1e4);
        let exchange = Exchange {
            patches: vec![Interval { low: -a, high: a }],
            sources: brake_blocks(60.0),
            ..Exchange::default()
        };
        let config = with(config(1e4, v), |c| c.hub_held = false);
        let (t, f) = stationary(&name, &config, v, omega(v, 0.0), &exchange);
        compare(
            &name,
            &[
                ("wheel centre", t.wheel_centre, r[0], MEAN),
                ("rail centre", t.rail_centre, r[1], MEAN),
                ("wheel mean", t.wheel_mean, r[2], MEAN),
                ("rail mean", t.rail_mean, r[3], MEAN),
                ("conduction", f.conduction, 60.0, 1e-8),
                ("outflow", f.outflow, 60.0, 1e-8),
            ],
        );
    }
}

#[test]
fn locked_wheel() {
    let v = 50.0 * KMH;
    let exchange = carter(1e5, v, 2.0);
    let config = config(1e5, v);
    let name = "locked";
    let (t, f) = stationary(name, &config, v, 0.0, &exchange);
    compare(
        name,
        &[
            ("wheel maximum", t.wheel_max, 34.19127, MEAN),
            ("rail maximum", t.rail_max, 32.49291, MEAN),
            ("wheel centre", t.wheel_centre, 28.63917, MEAN),
            ("rail centre", t.rail_centre, 26.40203, MEAN),
            ("wheel mean", t.wheel_mean, 2.462275, MEAN),
            ("rail mean", t.rail_mean, 0.005397643, MEAN),
            ("conduction", f.conduction, 27396.47, MEAN),
            ("to hub", f.to_hub, 381.3069, MEAN),
            ("outflow", f.outflow, 55174.25, MEAN),
        ],
    );
}

#[test]
fn contact_edges_between_nodes_cost_little_accuracy() {
    let (v, creepage) = (50.0 * KMH, -8e-4);
    for nominal in [0.6e5, 0.8e5, 0.93e5, 1.1e5, 1.5e5, 2e5] {
        let config = with(config(nominal, 100.0 * KMH), |c| {
            c.smallest_load_ratio = 1e5_f64.min(nominal) / nominal;
            c.zone = 1.6 * half_width(1.1e5);
            c.reach = c.zone;
        });
        let name = format!("mesh for {nominal:.1e} N/m");
        let (t, _) = stationary(&name, &config, v, omega(v, creepage), &carter(1e5, v, creepage));
        compare(
            &name,
            &[
                ("wheel maximum", t.wheel_max, 0.02517578, MAXIMUM),
                ("rail maximum", t.rail_max, 0.02445375, MAXIMUM),
                ("wheel centre", t.wheel_centre, 0.01873581, MEAN),
                ("wheel mean", t.wheel_mean, 0.01571567, MEAN),
            ],
        );
    }
}
