//! Maximum principle of the temperatures: without a source nothing is colder than the coldest or hotter than the
//! hottest of wheel, arriving rail, hub and air; with friction nothing is colder than the coldest of them.
//!
//! `WHEELRAIL_EVERY_ROW=1` runs all rows on 10, 20 and 40 elements with more steps and prints their table.

use crate::common;
use std::f64::consts::TAU;
use wheelrail::simulation::{Drive, Inputs, Rotation, Simulation, Translation};

/// Excess over the data that counts as none \[K], and the same relative to the span of the data \[1].
const SLIGHT: f64 = 0.1;
const SLIGHT_SHARE: f64 = 0.005;

/// One run: what differs from the railway preset at 15 m/s without friction on a rail 30 K colder.
#[derive(Clone)]
struct Row {
    name: String,
    /// Temperatures of the arriving rail and of the wheel at the start over the reference \[K].
    rail: f64,
    wheel: f64,
    conductance: f64,
    elements: usize,
    velocity: f64,
    step: f64,
    /// Changes what acts after the time \[s] and the way \[m].
    drive: fn(&mut Drive, f64, f64),
    locked: bool,
    friction: f64,
}

fn row(name: &str) -> Row {
    Row {
        name: name.into(),
        rail: -30.0,
        wheel: 0.0,
        conductance: 0.0,
        elements: 10,
        velocity: 15.0,
        step: 1e-3,
        drive: |_, _, _| {},
        locked: false,
        friction: 0.0,
    }
}

fn rows() -> Vec<Row> {
    let mut rows = vec![row("nominal load")];
    let mut add = |name: &str, change: &dyn Fn(&mut Row)| {
        let mut next = row(name);
        change(&mut next);
        rows.push(next);
    };
    add("load 0.99", &|r| r.drive = |d, _, _| d.load *= 0.99);
    add("load 0.9", &|r| r.drive = |d, _, _| d.load *= 0.9);
    add("load 0.8", &|r| r.drive = |d, _, _| d.load *= 0.8);
    add("load 1.1", &|r| r.drive = |d, _, _| d.load *= 1.1);
    add("load 0.1", &|r| r.drive = |d, _, _| d.load *= 0.1);
    add("load 1.9", &|r| r.drive = |d, _, _| d.load *= 1.9);
    add("load in steps of 30 %", &|r| {
        r.drive = |d, t, _| d.load *= if (t / 0.02) as i64 % 2 == 0 { 0.7 } else { 1.3 };
    });
    add("load in ramps of 30 %", &|r| r.drive = |d, t, _| d.load *= 0.7 + 0.6 * (t / 0.1).fract());
    add("load at 5 Hz", &|r| r.drive = |d, t, _| d.load *= 1.0 + 0.3 * (TAU * 5.0 * t).sin());
    for rail in [3.0, 30.0, 100.0, -3.0, -100.0] {
        add(&format!("rail {rail:+} K, load at 5 Hz"), &|r| {
            r.rail = rail;
            r.drive = |d, t, _| d.load *= 1.0 + 0.3 * (TAU * 5.0 * t).sin();
        });
    }
    for wheel in [30.0, 200.0] {
        add(&format!("wheel {wheel:+} K, load 0.9"), &|r| {
            (r.rail, r.wheel) = (0.0, wheel);
            r.drive = |d, _, _| d.load *= 0.9;
        });
    }
    for conductance in [1e6, 1e7, 1e8, 1e9, 1e10] {
        add(&format!("conductance {conductance:e}, load 0.9"), &|r| {
            r.conductance = conductance;
            r.drive = |d, _, _| d.load *= 0.9;
        });
    }
    for step in [5e-5, 2e-4, 5e-3, 2e-2] {
        add(&format!("steps of {step} s, load 0.9"), &|r| {
            r.step = step;
            r.drive = |d, _, _| d.load *= 0.9;
        });
    }
    add("reversed, load 0.9", &|r| {
        r.velocity = -15.0;
        r.drive = |d, _, _| d.load *= 0.9;
    });
    add("crawling, load 0.9", &|r| {
        r.velocity = 0.05;
        r.drive = |d, _, _| d.load *= 0.9;
    });
    add("moment -8 kN m", &|r| {
        r.friction = 0.3;
        r.drive = |d, _, _| d.moment = -8e3;
    });
    add("locked without friction, load 0.9", &|r| {
        r.locked = true;
        r.drive = |d, _, _| d.load *= 0.9;
    });
    add("locked with friction", &|r| (r.locked, r.friction) = (true, 0.3));
    for step in [1e-3, 1e-4, 1e-5] {
        add(&format!("rail temperature steps every 0.15 m, steps of {step} s"), &|r| {
            (r.rail, r.step) = (0.0, step);
            r.drive = |d, _, way| d.temperature -= if (way / 0.15) as i64 % 2 == 0 { 0.0 } else { 30.0 };
        });
    }
    add("rail temperature steps every 5 m", &|r| {
        r.rail = 0.0;
        r.drive = |d, _, way| d.temperature -= if (way / 5.0) as i64 % 2 == 0 { 0.0 } else { 30.0 };
    });
    add("rail temperature rises by 100 K in 5 m", &|r| {
        r.rail = 0.0;
        r.drive = |d, _, way| d.temperature += 100.0 * (way / 5.0).fract();
    });
    rows
}

/// Worst excess \[K] of a run over what the data allow, and how large it may be.
fn excess(row: &Row, duration: f64) -> [f64; 2] {
    let mut config = common::preset("railway", row.elements);
    (config.solver.modes_wheel, config.solver.modes_rail) = (12, 20);
    (config.initial.velocity, config.thermal.wheel_excess) = (row.velocity, row.wheel);
    config.tuning.tolerance = 0.0;
    if row.conductance > 0.0 {
        config.thermal.conductance = row.conductance;
    }
    let reference = config.thermal.reference;
    let base = Inputs::rolling(&config);
    let mut inputs = base;
    let at = |t: f64, way: f64, inputs: &mut Inputs| {
        inputs.drive = base.drive;
        (inputs.drive.friction, inputs.drive.temperature) = (row.friction, reference + row.rail);
        (row.drive)(&mut inputs.drive, t, way);
        if row.locked {
            (inputs.rotation, inputs.translation, inputs.drive.omega) =
                (Rotation::Velocity, Translation::Velocity, 0.0);
        }
    };
    at(0.0, 0.0, &mut inputs);
    (inputs.rotation, inputs.drive.omega) = (base.rotation, base.drive.omega);
    let mut simulation = Simulation::new(common::model(config), &inputs).unwrap();
    let data = |drive: &Drive| [reference, reference + row.wheel, drive.temperature];
    let join = |range: [f64; 2], values: &[f64]| {
        values.iter().fold(range, |[low, high], value| [low.min(*value), high.max(*value)])
    };
    let mut allowed = join([f64::MAX, f64::MIN], &data(&inputs.drive));
    let mut worst = 0.0_f64;
    let steps = (duration / row.step).ceil().max(5.0) as usize;
    for k in 0..=steps {
        allowed = join(allowed, &data(&inputs.drive));
        let outputs = simulation.outputs();
        let mut seen = join([f64::MAX, f64::MIN], &outputs.profile_temperature_wheel);
        seen = join(seen, &outputs.profile_temperature_rail);
        seen = join(seen, &[outputs.temperature_wheel_max, outputs.temperature_rail_max]);
        seen = join(seen, &[outputs.temperature_wheel_mean, outputs.temperature_rail_mean]);
        if k % 5 == 0 {
            for field in simulation.temperature_fields().unwrap().iter().flatten() {
                seen = join(seen, &field.temperature);
            }
        }
        let above = if row.friction > 0.0 { 0.0 } else { seen[1] - allowed[1] };
        worst = worst.max(allowed[0] - seen[0]).max(above);
        let way = simulation.outputs().wheel_distance.abs();
        at(row.step * (k + 1) as f64, way, &mut inputs);
        simulation.advance(&inputs, row.step).unwrap_or_else(|error| panic!("{}, step {k}: {error}", row.name));
    }
    [worst, SLIGHT.max(SLIGHT_SHARE * (allowed[1] - allowed[0]))]
}

#[test]
fn no_temperature_leaves_the_interval_of_its_sources() {
    let every = std::env::var_os("WHEELRAIL_EVERY_ROW").is_some();
    let (meshes, duration): (&[usize], f64) = if every { (&[10, 20, 40], 0.4) } else { (&[6], 0.06) };
    let mut wrong = Vec::new();
    for mut row in rows() {
        for &elements in meshes {
            row.elements = elements;
            let [worst, allowed] = excess(&row, duration.min(2000.0 * row.step));
            println!("{:55} {elements:2} elements {worst:9.4} K", row.name);
            if worst > allowed || worst.is_nan() {
                wrong.push(format!("{} on {elements} elements: {worst} K", row.name));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// The speed of a wheel at rest is round-off of either sign, so that rail ahead of it would be rail behind it in the next
/// step. Rail of another temperature comes with the way, once it rolls.
#[test]
fn a_standing_wheel_meets_rail_of_another_temperature_only_once_it_rolls() {
    let mut config = common::preset("railway", 10);
    config.initial.velocity = 0.0;
    let model = common::model(config);
    let mut inputs = Inputs::rolling(model.config());
    let (load, own) = (inputs.drive.load, inputs.drive.temperature);
    let mut simulation = Simulation::new(model.clone(), &inputs).unwrap();
    let mut farthest = [0.0_f64; 2];
    for k in 0..400 {
        let time = f64::from(k) * 1e-3;
        inputs.drive.load = load * (1.0 + 0.1 * (60.0 * time).sin());
        inputs.drive.temperature = own + 20.0 * (15.0 * time).sin();
        simulation.advance(&inputs, 1e-3).unwrap();
        let o = simulation.outputs();
        for temperature in [o.temperature_rail_mean, o.temperature_rail_max, o.temperature_wheel_max] {
            farthest[0] = farthest[0].max((temperature - own).abs());
        }
        farthest[1] = farthest[1].max(o.wheel_velocity.abs());
    }
    println!("{:.1e} K from its own temperature, at up to {:.1e} m/s", farthest[0], farthest[1]);
    assert!(farthest[0] < 0.01);
    (inputs.rotation, inputs.translation) = (Rotation::Velocity, Translation::Velocity);
    (inputs.drive.load, inputs.drive.temperature) = (load, own + 20.0);
    (inputs.drive.velocity, inputs.drive.omega) = (1.0, 1.0 / model.config().wheel.radius);
    for _ in 0..100 {
        simulation.advance(&inputs, 1e-3).unwrap();
    }
    let mean = simulation.outputs().temperature_rail_mean - own;
    println!("{mean:.2} K on rail that is 20 K hotter");
    assert!((5.0..20.05).contains(&mean));
}
