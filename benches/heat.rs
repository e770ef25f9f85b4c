//! Cost of one two-body heat step and of the set-up, one core, default mesh.

use criterion::{Criterion, criterion_group, criterion_main};
use std::hint::black_box;
use wheelrail::heat::{Conductance, Exchange, Heat, HeatConfig, HeatTimeScheme, HubCondition, Patch, Scratch};
use wheelrail::piecewise::Piecewise;

const HALF_WIDTH: f64 = 0.761e-3;
const SPEED: f64 = 50.0 / 3.6;

fn config() -> HeatConfig {
    HeatConfig {
        conductivity: 45.0,
        specific_heat: 460.0,
        density: 8000.0,
        wheel_radius: 0.5,
        hub_radius: 0.05,
        rail_length: 1.0,
        rail_height: 0.1,
        half_width: HALF_WIDTH,
        smallest_half_width: HALF_WIDTH,
        zone: 1.5 * HALF_WIDTH,
        max_speed: SPEED,
        elements_per_half_width: 20,
        hub: HubCondition::Fixed,
        conductance: Conductance::Constant { value: 1e7 },
        friction_fraction: 0.1,
        wheel_share: 0.5,
        convection: 0.0,
        time_scheme: HeatTimeScheme::Sdirk2,
    }
}

fn heat(c: &mut Criterion) {
    c.bench_function("heat: meshes and modes", |b| b.iter(|| Heat::new(black_box(&config())).expect("meshes")));
    let heat = Heat::new(&config()).expect("meshes");
    let exchange = Exchange {
        patches: vec![Patch { low: -HALF_WIDTH, high: HALF_WIDTH }],
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
        let mut state = heat.initial(0.0);
        let mut scratch = Scratch::default();
        let mut k = 0_u32;
        c.bench_function(name, |b| {
            b.iter(|| {
                k += 1;
                let factor = 1.0 + change * f64::from(k % 7);
                let (dt, v) = (1e-3 * factor, SPEED * factor);
                heat.step(&mut state, dt, v, rolling * v / 0.5, &exchange, &mut scratch).expect("step")
            })
        });
    }
}

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(50);
    targets = heat
}
criterion_main!(benches);
