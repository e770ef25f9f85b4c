//! A wheel that knows its wheelset: signs, mirror images, power from outside, hunting against linear theory, and what is refused.

use crate::common::*;
use nalgebra::Matrix4;
use std::sync::Arc;
use wheelrail::config::{Config, ContactShape, WheelsetSide};
use wheelrail::simulation::{Drive, Inputs, Lateral, Model, Outputs, Rotation, Simulation, Translation};

/// Speed \[m/s] and half of the distance of the running circles \[m].
const V: f64 = 20.0;
const B: f64 = 0.75;
/// Friction times load \[N].
const LIMIT: f64 = 0.3 * 1e5;

/// A wheel of a wheelset with an elliptical patch.
fn wheel(side: WheelsetSide, change: impl Fn(&mut Config)) -> Arc<Model> {
    let mut config = preset("railway_ellipse", 8);
    (config.contact.lines, config.contact.lateral) = (5, true);
    (config.thermal.enabled, config.physics.yielding, config.initial.velocity) = (false, false, V);
    (config.wheelset.side, config.wheelset.half_spacing) = (side, B);
    config.tuning.softening = 0.0;
    change(&mut config);
    model(config)
}

fn both() -> [Arc<Model>; 2] {
    [WheelsetSide::Right, WheelsetSide::Left].map(|side| wheel(side, |_| {}))
}

/// Forces of the contact on the wheelset along x, y and z, and moments about them.
fn wrench(seen: &Outputs) -> [f64; 6] {
    [
        seen.wheelset_force_x,
        seen.wheelset_force_y,
        seen.wheelset_force_z,
        seen.wheelset_moment_x,
        seen.wheelset_moment_y,
        seen.wheelset_moment_z,
    ]
}

/// Stationary rolling at a creepage in a pose.
fn rolling(model: &Arc<Model>, creepage: f64, pose: impl Fn(&mut Drive)) -> Outputs {
    let mut inputs = prescribed(model, V, creepage);
    pose(&mut inputs.drive);
    Simulation::new(model.clone(), &inputs).unwrap().outputs().clone()
}

#[test]
fn a_wheelset_turned_to_the_right_is_pushed_to_the_right_and_every_motion_is_opposed() {
    for (sign, model) in [1.0, -1.0].into_iter().zip(both()) {
        let [still, turned, shifting, turning, leaning] = [
            rolling(&model, 0.0, |_| {}),
            rolling(&model, 0.0, |drive| drive.yaw = 1e-3),
            rolling(&model, 0.0, |drive| drive.lateral_rate = 1e-3 * V),
            rolling(&model, 0.0, |drive| drive.yaw_rate = 1e-3 * V / B),
            rolling(&model, 0.0, |drive| drive.roll_rate = 1e-3 * V / 0.46),
        ];
        let change = |seen: &Outputs, k: usize| (wrench(seen)[k] - wrench(&still)[k]) / LIMIT;
        let (pushed, opposed) = (change(&turned, 2), change(&shifting, 2));
        println!("side {sign}: yaw {pushed:.4}, shift {opposed:.4} of friction");
        assert!(pushed > 0.2 && (pushed + opposed).abs() < 1e-3, "what V ψ pushes, a rate as large opposes");
        assert!(
            (change(&leaning, 2) - pushed).abs() < 1e-3,
            "a wheelset that leans to the right moves its wheels to the left"
        );
        // The right wheel of a wheelset that turns to the right falls back, so that its contact pulls it ahead.
        assert!(sign * change(&turning, 0) > 0.2 && change(&turning, 4) > 0.2 * B);
        assert!(wrench(&still)[3] * -sign > 0.99 * B * 1e5, "the load on the right wheel lifts its end");
    }
}

/// Mirror images of motion and wheel have those of forces and moments, all terms at once.
#[test]
fn the_left_wheel_is_the_mirror_image_of_the_right_one() {
    let [right, left] = both();
    let run = |model: &Arc<Model>, sign: f64| {
        let seen = run(model, prescribed(model, V, 5e-4), (1e-3, 30), |inputs, t| {
            inputs.drive.lateral = sign * 1e-3 * (100.0 * t).sin();
            inputs.drive.lateral_rate = sign * 0.1 * (100.0 * t).cos();
            (inputs.drive.yaw, inputs.drive.yaw_rate) =
                (sign * 2e-3 * (60.0 * t).sin(), sign * 0.12 * (60.0 * t).cos());
            (inputs.drive.roll, inputs.drive.roll_rate) = (sign * 1e-3, sign * 0.02 * (90.0 * t).sin());
        });
        wrench(&seen[30])
    };
    let [of_right, of_left] = [run(&right, 1.0), run(&left, -1.0)];
    let sizes = [LIMIT, 1e5, LIMIT, B * 1e5, B * LIMIT, 0.46 * LIMIT];
    let missed = std::array::from_fn::<f64, 6, _>(|k| {
        let mirrored = if [2, 3, 4].contains(&k) { -1.0 } else { 1.0 };
        (of_right[k] - mirrored * of_left[k]) / sizes[k]
    });
    println!("{of_right:.1?} missed by {missed:?}");
    round_off("wheelset.mirror", &[missed.iter().fold(0.0, |most: f64, missed| most.max(missed.abs()))], 1e-10);
    assert!(missed.iter().all(|missed| missed.abs() < 1e-9) && of_right[2].abs() > 0.05 * LIMIT);
}

/// Forces and moments on the wheelset, times its velocities and turns, are what friction takes.
#[test]
fn an_outside_observer_finds_the_power_of_friction_in_the_forces_on_the_wheelset() {
    for model in both() {
        let (yaw, lateral_rate, yaw_rate) = (3e-3_f64, -0.02, 0.015);
        let seen = rolling(&model, 7e-4, |drive| {
            (drive.yaw, drive.lateral_rate, drive.yaw_rate) = (yaw, lateral_rate, yaw_rate);
        });
        let [x, _, z, mx, my, mz] = wrench(&seen);
        // On a level plane of contact the wheelset neither rises nor leans: `fmpy_tests/test_hunting.py` has all terms.
        let spins = [yaw.sin(), 0.0, -yaw.cos()].map(|part| seen.wheel_omega * part);
        let power = x * V + z * lateral_rate + mx * spins[0] + my * (spins[1] - yaw_rate) + mz * spins[2];
        let missed = power / -seen.friction_power - 1.0;
        println!("{power:.3} W on the wheelset, friction {:.3} W", seen.friction_power);
        figure("wheelset.power", &[missed.abs()]);
        assert!(seen.friction_power > 100.0 && missed.abs() < 5e-3, "{missed}");
    }
}

#[test]
fn a_locked_wheel_slides_where_the_wheelset_goes_however_it_is_turned() {
    let model = wheel(WheelsetSide::Right, |_| {});
    let inputs = prescribed(&model, V, 0.0);
    let omega = inputs.drive.omega;
    let seen = run(&model, inputs, (2e-4, 300), |inputs, t| {
        (inputs.drive.omega, inputs.drive.yaw) = (omega * (1.0 - t / 0.03).max(0.0), 0.02);
    });
    let last = &seen[300];
    println!("{:.1} N ahead, {:.3} N to the right", last.wheelset_force_x, last.wheelset_force_z);
    round_off("wheelset.locked", &[(last.wheelset_force_z / LIMIT).abs()], 1e-6);
    assert!((last.wheelset_force_x / -LIMIT - 1.0).abs() < 5e-3 && last.wheelset_force_z.abs() < 1e-3 * LIMIT);
}

/// A pose given for the end of a step of a millisecond is reached linearly: as in ten steps in which it is given in tenths.
#[test]
fn a_pose_moves_linearly_within_a_step() {
    let model = wheel(WheelsetSide::Right, |config| config.tuning.tolerance = 0.0);
    let end = |steps: usize| {
        let duration = 4e-3 / steps as f64;
        let seen = run(&model, prescribed(&model, V, 3e-4), (duration, steps), |inputs, t| {
            let whole = (t / 1e-3 - 1e-9).floor();
            let at = |of: fn(f64) -> f64| of(whole) + (t / 1e-3 - whole) * (of(whole + 1.0) - of(whole));
            inputs.drive.yaw = at(|k| 4e-4 * (1.3 * k).sin());
            inputs.drive.lateral_rate = at(|k| 0.01 * (0.9 * k).sin());
        });
        wrench(&seen[steps])[2] / LIMIT
    };
    let [coarse, fine, finer] = [4, 16, 64].map(end);
    println!("{coarse:.5} {fine:.5} {finer:.5}");
    figure("wheelset.linear", &[(coarse - finer).abs(), (fine - finer).abs()]);
    assert!((coarse - finer).abs() < 4e-3 && (fine - finer).abs() < 4e-3 && finer.abs() > 0.02);
}

/// Rows of an elliptical patch that becomes longer, narrower and steeper as the wheelset shifts to the right \[m], on a cone.
fn block(shift: f64) -> String {
    let (count, longer, angle) = (7, 1.0 + 40.0 * shift, 0.05 + 8.0 * shift);
    let row = |k: i32| {
        let z = (f64::from(k) + 0.5) * 2.0 / f64::from(count) - 1.0;
        let half_length = 5.8e-3 * longer * (1.0 - z * z).sqrt();
        let (place, width) = (4.6e-3 / longer, 9.2e-3 / (longer * f64::from(count)));
        let (position, radius) = (place * z + 0.5 * shift, 0.46 + CONE * shift);
        format!("{shift},{position},{half_length},{},{width},{angle},{radius},0\n", 1.0 - z * z)
    };
    (0..count).map(row).collect()
}

/// A right wheel with the patches of some shifts \[m].
fn on_table(shifts: &[f64]) -> Arc<Model> {
    on_table_of(WheelsetSide::Right, shifts)
}

fn on_table_of(side: WheelsetSide, shifts: &[f64]) -> Arc<Model> {
    let rows: String = shifts.iter().map(|shift| block(*shift)).collect();
    wheel(side, |config| {
        (config.contact.shape, config.contact.lines) = (ContactShape::Rows, 7);
        config.contact.rows = format!("shift,position,half_length,load_share,width,angle,radius,lateral\n{rows}");
    })
}

#[test]
fn the_patch_of_a_shift_is_that_of_its_rows_alone() {
    let shifts = [-4e-3, -2e-3, 0.0, 1e-3, 3e-3];
    let table = on_table(&shifts);
    let mut most: f64 = 0.0;
    for shift in [0.0, 1e-3, -2e-3] {
        let alone = on_table(&[shift]);
        let [of_table, expected] = [&table, &alone].map(|model| {
            wrench(&rolling(model, 4e-4, |drive| {
                (drive.lateral, drive.yaw, drive.lateral_rate) = (shift, 5e-4, 2e-3);
            }))
        });
        let missed = (0..6).map(|k| (of_table[k] - expected[k]).abs() / LIMIT).fold(0.0, f64::max);
        println!("shift {shift}: {of_table:.1?}, missed {missed:.1e}");
        most = most.max(missed);
        // Nodes have the size that suits the patch in the middle of the table.
        assert!(missed < if shift == 0.0 { 1e-9 } else { 1e-4 } && expected[0].abs() > 0.05 * LIMIT);
    }
    figure("wheelset.table", &[most]);
}

/// Elastic energy that a contact gains from patch to patch is what load and lateral force put in, there and back; friction of .02 hides
/// nothing.
#[test]
fn a_wheel_that_moves_to_another_patch_gains_the_energy_that_is_put_in() {
    let model = on_table(&[-2e-3, -1e-3, 0.0, 1e-3, 2e-3]);
    for (from, to) in [(0.0, 1.8e-3), (1.8e-3, 0.0), (0.0, -1.8e-3)] {
        let mut inputs = prescribed(&model, V, 0.0);
        (inputs.drive.lateral, inputs.drive.friction) = (from, 0.02);
        let time = 0.2;
        let seen = run(&model, inputs, (1e-3, 200), |inputs, t| {
            let s = (t / time).clamp(0.0, 1.0);
            inputs.drive.lateral = from + (to - from) * s * s * (3.0 - 2.0 * s);
            inputs.drive.lateral_rate = (to - from) * 6.0 * s * (1.0 - s) / time;
        });
        let residual = seen[200].energy_residual;
        println!("from {from} to {to} m: {residual:.1e} of the energy is missing");
        assert!(residual.abs() < 1.5e-3);
    }
}

/// A table is of the right wheel: the left one under the opposite pose has its mirror image.
#[test]
fn a_left_wheel_has_the_mirror_image_of_the_table() {
    // Of the second table two patches are as far from the middle of the track.
    for shifts in [&[-4e-3, -2e-3, 0.0, 1e-3, 3e-3][..], &[-1e-3, 1e-3, 3e-3]] {
        let [right, left] = [(WheelsetSide::Right, 1.0), (WheelsetSide::Left, -1.0)].map(|(side, sign)| {
            wrench(&rolling(&on_table_of(side, shifts), 4e-4, |drive| {
                (drive.lateral, drive.yaw, drive.lateral_rate) = (sign * 1.4e-3, sign * 5e-4, sign * 2e-3);
            }))
        });
        let mirror = [1.0, 1.0, -1.0, -1.0, -1.0, 1.0];
        let missed = (0..6).map(|k| (right[k] - mirror[k] * left[k]).abs() / LIMIT).fold(0.0, f64::max);
        println!("right {right:.1?}, left {left:.1?}, apart {missed:.1e}");
        assert!(missed < 1e-9 && right[2].abs() > 5e-3 * LIMIT);
    }
}

/// From patch to patch of the table, forces change without steps or kinks.
#[test]
fn forces_follow_the_shift_smoothly() {
    let model = on_table(&[-2e-3, -1e-3, 0.0, 1e-3, 2e-3]);
    let forces: Vec<f64> = (0..60)
        .map(|k| {
            rolling(&model, 4e-4, |drive| (drive.lateral, drive.yaw) = (-1.5e-3 + 5e-5 * f64::from(k), 5e-4))
                .wheelset_force_z
        })
        .collect();
    let mut steps: Vec<f64> = forces.windows(2).map(|pair| (pair[1] - pair[0]).abs()).collect();
    let bends = forces.windows(3).map(|v| (v[2] - 2.0 * v[1] + v[0]).abs()).fold(0.0, f64::max);
    steps.sort_by(f64::total_cmp);
    let (median, largest) = (steps[steps.len() / 2], steps[steps.len() - 1]);
    println!("steps of {median:.2} N in the median, {largest:.2} N at most, bends of {bends:.2} N");
    assert!(
        median > 1.0 && largest < 3.0 * median && bends < 0.3 * median.max(0.3 * largest),
        "{largest} {median} {bends}"
    );
}

#[test]
fn shifts_outside_the_table_and_tables_that_are_none_are_refused_by_name() {
    let model = on_table(&[-1e-3, 0.0, 1e-3]);
    let mut inputs = prescribed(&model, V, 0.0);
    let mut simulation = Simulation::new(model, &inputs).unwrap();
    inputs.drive.lateral = 1.2e-3;
    let text = simulation.advance(&inputs, 1e-3).unwrap_err().to_string();
    assert!(
        text.contains("wheelset.lateral = 0.0012 m is outside the shifts of contact.rows: -0.001 to 0.001 m"),
        "{text}"
    );
    inputs.drive.lateral = 1e-3;
    simulation.advance(&inputs, 1e-3).unwrap();
    let refused = |rows: String, side: WheelsetSide| {
        let mut config = preset("railway_ellipse", 8);
        (config.contact.lateral, config.contact.shape, config.wheelset.side) = (true, ContactShape::Rows, side);
        config.contact.rows = format!("shift,position,half_length,load_share,width,angle,radius,lateral\n{rows}");
        config.validate().unwrap_err().to_string()
    };
    let [left, right] = [block(-1e-3), block(1e-3)];
    let fewer = right.lines().skip(1).map(|line| format!("{line}\n")).collect::<String>();
    for (rows, side, words) in [
        (format!("{right}{left}"), WheelsetSide::Right, "sort the blocks"),
        (format!("{left}{fewer}"), WheelsetSide::Right, "the block of shift = 0.001 m has 6 rows, the first one 7"),
        (format!("{left}{right}"), WheelsetSide::None, "set wheelset.side = left or right"),
    ] {
        let text = refused(rows, side);
        assert!(text.contains(words), "{text}");
    }
}

/// Conicity \[1], mass \[kg] and moment of inertia [kg m²] of a wheelset on springs [N/m, N m].
const CONE: f64 = 0.1;
const MASS: f64 = 1500.0;
const INERTIA: f64 = 900.0;
const SPRING: f64 = 1e6;
const TURNING_SPRING: f64 = 2e6;

/// Creep coefficients of one wheel at `speed` and the fastest growing motion of linear theory: growth [1/s] and frequency \[Hz].
fn linear_theory(model: &Arc<Model>, speed: f64) -> [f64; 2] {
    let moving = |creepage: f64, pose: &dyn Fn(&mut Drive)| {
        let mut inputs = prescribed(model, speed, creepage);
        pose(&mut inputs.drive);
        Simulation::new(model.clone(), &inputs).unwrap().outputs().clone()
    };
    let along = [-2e-5, 2e-5].map(|creepage| moving(creepage, &|_| {}));
    let aside = moving(0.0, &|drive| drive.lateral_rate = 2e-5 * speed);
    // The turn alone, without what it does to the wheel beside the middle.
    let spun = moving(0.0, &|drive| drive.yaw_rate = 0.0);
    let spin = 0.01;
    let spun = {
        let mut inputs = prescribed(model, speed, 0.0);
        inputs.drive.yaw_rate = spin * speed;
        inputs.drive.omega = spun.wheel_omega * (1.0 - B * spin);
        Simulation::new(model.clone(), &inputs).unwrap().outputs().clone()
    };
    let between = |of: fn(&Outputs) -> f64| of(&along[1]) - of(&along[0]);
    let f11 = -between(|seen| seen.contact_force_x) / between(|seen| seen.contact_creepage);
    let [f22, g] = [-aside.contact_force_z, aside.contact_moment_y].map(|of| of / aside.contact_lateral_creepage);
    let [f23, f33] = [-spun.contact_force_z, spun.contact_moment_y].map(|of| of / spun.contact_spin);
    println!("f11 {f11:.4e}, f22 {f22:.4e}, f23 {f23:.4e}, f33 {f33:.4e}, moment by lateral creepage {g:.4e}");
    let radius = model.config().wheel.radius;
    let damping = [[2.0 * f22, 2.0 * f23], [2.0 * g, 2.0 * f11 * B * B + 2.0 * f33]];
    let stiffness = [[SPRING, -2.0 * f22], [2.0 * f11 * CONE * B / radius, TURNING_SPRING - 2.0 * g]];
    let mut matrix = Matrix4::zeros();
    for (row, inertia) in [MASS, INERTIA].into_iter().enumerate() {
        matrix[(row, row + 2)] = 1.0;
        for k in 0..2 {
            matrix[(row + 2, k)] = -stiffness[row][k] / inertia;
            matrix[(row + 2, k + 2)] = -damping[row][k] / (speed * inertia);
        }
    }
    let fastest = matrix.complex_eigenvalues().iter().copied().max_by(|a, b| a.re.total_cmp(&b.re)).unwrap();
    [fastest.re, fastest.im.abs() / std::f64::consts::TAU]
}

/// Shifts of a wheelset on springs with two conical wheels, from an explicit master that takes forces at the middle of its steps.
fn hunting(speed: f64, step: f64, time: f64) -> Vec<f64> {
    let models =
        [WheelsetSide::Right, WheelsetSide::Left].map(|side| wheel(side, |config| config.initial.velocity = speed));
    let (mut inputs, radius) = (prescribed(&models[0], speed, 0.0), models[0].config().wheel.radius);
    let mut wheels = models.each_ref().map(|model| Simulation::new(model.clone(), &inputs).unwrap());
    let omega = inputs.drive.omega;
    let mut pose = [2e-4, 0.0, 0.0, 0.0];
    let loads = |wheels: &[Simulation; 2]| {
        let sum = |k: usize| wheels.iter().map(|wheel| wrench(wheel.outputs())[k]).sum::<f64>();
        [sum(2), -sum(4)]
    };
    let (mut now, mut before) = (loads(&wheels), loads(&wheels));
    let mut shifts = vec![pose[0]];
    for _ in 0..(time / step) as usize {
        let [shift, yaw, shifting, turning] = &mut pose;
        for (k, (place, rate, inertia, spring)) in
            [(shift, shifting, MASS, SPRING), (yaw, turning, INERTIA, TURNING_SPRING)].into_iter().enumerate()
        {
            let middle = 1.5 * now[k] - 0.5 * before[k];
            let (was, held) = (*rate, step * step * spring / 4.0);
            *rate = (*rate * (inertia - held) + step * (middle - spring * *place)) / (inertia + held);
            *place += 0.5 * step * (was + *rate);
        }
        before = now;
        let drive = &mut inputs.drive;
        [drive.lateral, drive.yaw, drive.lateral_rate, drive.yaw_rate] = pose;
        for (side, wheel) in [1.0, -1.0].into_iter().zip(&mut wheels) {
            inputs.drive.omega = omega * (1.0 + side * CONE * pose[0] / radius);
            wheel.advance(&inputs, step).unwrap();
        }
        now = loads(&wheels);
        shifts.push(pose[0]);
    }
    shifts
}

/// Growth [1/s] and frequency \[Hz] of the last two thirds of an oscillation, from its extremes.
fn seen(shifts: &[f64], step: f64) -> [f64; 2] {
    let late = &shifts[shifts.len() / 3..];
    let peaks: Vec<(f64, f64)> = late
        .windows(3)
        .enumerate()
        .filter(|(_, v)| v[1].abs() > v[0].abs() && v[1].abs() >= v[2].abs())
        .map(|(k, v)| {
            let at = 0.5 * (v[2] - v[0]) / (2.0 * v[1] - v[0] - v[2]);
            (step * (k as f64 + at), (v[1] + 0.25 * at * (v[2] - v[0])).abs())
        })
        .collect();
    let (first, last) = (peaks[0], peaks[peaks.len() - 1]);
    [(last.1 / first.1).ln() / (last.0 - first.0), 0.5 * (peaks.len() - 1) as f64 / (last.0 - first.0)]
}

#[test]
fn two_wheels_hunt_as_the_wheelset_of_linear_theory() {
    for speed in [50.0, 65.0] {
        let model = wheel(WheelsetSide::Right, |config| config.initial.velocity = speed);
        let [growth, frequency] = linear_theory(&model, speed);
        for step in [1e-3, 5e-4] {
            let found = seen(&hunting(speed, step, 1.5), step);
            println!(
                "{speed} m/s, steps of {step}: growth {:.4} of {growth:.4} 1/s, {:.4} of {frequency:.4} Hz",
                found[0], found[1]
            );
            figure("wheelset.hunting", &[(found[1] / frequency - 1.0).abs()]);
            figure("wheelset.growth", &[(found[0] - growth).abs()]);
            assert!((found[1] / frequency - 1.0).abs() < 0.015 && (found[0] - growth).abs() < 0.2, "{found:?}");
        }
    }
}

#[test]
fn a_pose_gone_back_to_is_the_same_to_the_bit() {
    let model = wheel(WheelsetSide::Left, |_| {});
    let mut inputs = prescribed(&model, V, 3e-4);
    (inputs.drive.yaw, inputs.drive.yaw_rate) = (1e-3, 0.1);
    let mut simulation = Simulation::new(model, &inputs).unwrap();
    simulation.advance(&inputs, 1e-3).unwrap();
    let saved = simulation.checkpoint().clone();
    let ends = [0, 1].map(|_| {
        simulation.recall(saved.clone()).unwrap();
        (inputs.drive.yaw, inputs.drive.lateral_rate) = (3e-3, 0.02);
        simulation.advance(&inputs, 1e-3).unwrap();
        simulation.outputs().clone()
    });
    assert!(ends[0] == ends[1]);
}

/// Derivatives by yaw and rates are those of two states beside the present one.
#[test]
fn derivatives_by_the_pose_are_those_of_two_states_beside_it() {
    let model = wheel(WheelsetSide::Right, |_| {});
    let mut inputs = prescribed(&model, V, 2e-4);
    (inputs.drive.yaw, inputs.drive.yaw_rate) = (2e-4, 5e-3);
    let mut simulation = Simulation::new(model.clone(), &inputs).unwrap();
    type Input = fn(&mut Drive) -> &mut f64;
    let directions: [(&str, Input, f64); 3] = [
        ("yaw", |drive| &mut drive.yaw, 2e-6),
        ("yaw rate", |drive| &mut drive.yaw_rate, 3e-5),
        ("shift rate", |drive| &mut drive.lateral_rate, 1e-4),
    ];
    for (name, input, size) in directions {
        let mut direction = Drive::default();
        *input(&mut direction) = 1.0;
        let found = simulation.difference(&direction).unwrap().quotient(|seen| seen.wheelset_force_z);
        let ends = [-1.0, 1.0].map(|sign| {
            let mut inputs = inputs;
            *input(&mut inputs.drive) += sign * size;
            Simulation::new(model.clone(), &inputs).unwrap().outputs().wheelset_force_z
        });
        let difference = (ends[1] - ends[0]) / (2.0 * size);
        println!("{name}: derivative {found:.5e}, difference {difference:.5e}");
        assert!((found / difference - 1.0).abs() < 1e-3);
    }
}

/// The derivative by the shift holds on the way from patch to patch of a table, where angle, radius and patch move.
#[test]
fn a_derivative_by_the_shift_is_that_of_two_states_beside_it() {
    let model = on_table(&[-2e-3, -1e-3, 0.0, 1e-3, 2e-3]);
    let mut inputs = prescribed(&model, V, 4e-4);
    (inputs.drive.lateral, inputs.drive.yaw) = (0.4e-3, 5e-4);
    let mut simulation = Simulation::new(model.clone(), &inputs).unwrap();
    let direction = Drive { lateral: 1.0, ..Drive::default() };
    let found = simulation.difference(&direction).unwrap().quotient(|seen| seen.wheelset_force_z);
    let size = 1e-7;
    let ends = [-size, size].map(|change| {
        let mut inputs = inputs;
        inputs.drive.lateral += change;
        Simulation::new(model.clone(), &inputs).unwrap().outputs().wheelset_force_z
    });
    let difference = (ends[1] - ends[0]) / (2.0 * size);
    println!("derivative {found:.6e}, difference {difference:.6e} N/m");
    assert!((found / difference - 1.0).abs() < 1e-3);
    // At the end of the table it is that towards its middle.
    let slope = |lateral: f64, sign: f64| {
        let mut inputs = inputs;
        inputs.drive.lateral = lateral;
        let mut simulation = Simulation::new(model.clone(), &inputs).unwrap();
        let found = simulation.difference(&direction).unwrap().quotient(|seen| seen.wheelset_force_z);
        let at = |lateral: f64| {
            inputs.drive.lateral = lateral;
            Simulation::new(model.clone(), &inputs).unwrap().outputs().wheelset_force_z
        };
        let [end, within] = [lateral, lateral - sign * 1e-6].map(at);
        (found, sign * (end - within) / 1e-6)
    };
    for (lateral, sign) in [(2e-3, 1.0), (-2e-3, -1.0)] {
        let (found, difference) = slope(lateral, sign);
        println!("at {lateral} m: derivative {found:.5e}, difference {difference:.5e} N/m");
        assert!((found / difference - 1.0).abs() < 2e-2);
    }
}

#[test]
fn what_belongs_to_the_other_kind_of_host_is_refused_by_name() {
    let [with, without] = [WheelsetSide::Right, WheelsetSide::None].map(|side| wheel(side, |_| {}));
    let refused = |model: &Arc<Model>, change: fn(&mut Inputs)| {
        let mut inputs = Inputs::rolling(model.config());
        (inputs.rotation, inputs.translation) = (Rotation::Velocity, Translation::Velocity);
        change(&mut inputs);
        Simulation::new(model.clone(), &inputs).err().unwrap().to_string()
    };
    type Change = fn(&mut Inputs);
    let of_the_wheel: [(Change, &str); 4] = [
        (|inputs| inputs.drive.lateral_velocity = 0.1, "drive.lateral_velocity = 0.1"),
        (|inputs| inputs.drive.spin = 0.2, "drive.spin = 0.2"),
        (|inputs| inputs.drive.contact_angle = 0.1, "drive.contact_angle = 0.1"),
        (|inputs| inputs.lateral = Lateral::Force, "control.lateral = force"),
    ];
    for (change, words) in of_the_wheel {
        let text = refused(&with, change);
        assert!(text.contains(words) && text.contains("set wheelset.side = none"), "{text}");
    }
    let of_the_wheelset: [(Change, &str); 2] = [
        (|inputs| inputs.drive.yaw = 0.1, "wheelset.yaw = 0.1"),
        (|inputs| inputs.rate.roll = 0.2, "wheelset.roll = 0.2"),
    ];
    for (change, words) in of_the_wheelset {
        let text = refused(&without, change);
        assert!(text.contains(words) && text.contains("set wheelset.side = left or right"), "{text}");
    }
    let mut config = preset("railway_ellipse", 8);
    config.wheelset.side = WheelsetSide::Left;
    let text = config.validate().unwrap_err().to_string();
    assert!(text.contains("wheelset.side") && text.contains("set contact.lateral = true"), "{text}");
}
