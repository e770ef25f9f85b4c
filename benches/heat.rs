//! Cost of one two-body heat step and of the set-up, one core, default mesh.

use criterion::{Criterion, criterion_group, criterion_main};
use std::hint::black_box;
use wheelrail::config::{ConductanceLaw, Config, Hub};
use wheelrail::heat::{Exchange, Heat, HeatConfig, HeatLine, HeatModel, HeatScratch, HeatState};
use wheelrail::piecewise::Interval;
use wheelrail::piecewise::Piecewise;

const HALF_WIDTH: f64 = 0.761e-3;
const SPEED: f64 = 50.0 / 3.6;

fn config() -> HeatConfig {
    let preset = wheelrail::config::presets::parse(include_str!("../resources/paper_b.json")).expect("preset");
    let Config { wheel, rail, material, thermal, .. } = preset;
    let (contact_width, half_width, zone) = (1.0, HALF_WIDTH, 1.5 * HALF_WIDTH);
    let mut config = HeatConfig {
        wheel,
        rail,
        material,
        thermal,
        contact_width,
        elements_per_half_width: 20,
        half_width,
        zone,
        reach: zone,
    };
    (config.wheel.radius, config.wheel.hub_radius) = (0.5, 0.05);
    (config.rail.length, config.rail.height) = (1.0, 0.1);
    let material = &mut config.material;
    (material.conductivity, material.specific_heat, material.density) = (45.0, 460.0, 8000.0);
    let thermal = &mut config.thermal;
    (thermal.conductance_law, thermal.conductance) = (ConductanceLaw::Constant, 1e7);
    (thermal.heat_ratio, thermal.wheel_share, thermal.convection, thermal.hub) = (0.1, 0.5, 0.0, Hub::Fixed);
    (thermal.max_speed, thermal.smallest_load_ratio) = (SPEED, 1.0);
    config
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

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(50);
    targets = heat
}
criterion_main!(benches);
