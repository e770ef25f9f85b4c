//! Patches that are no ellipse: rows side by side from a table.

use crate::common::*;
use std::sync::Arc;
use wheelrail::config::{Config, ContactShape};
use wheelrail::simulation::{Inputs, Model, Outputs, Rotation, Simulation, Translation};

/// Rows of the ellipse of a configuration, `count` equally wide ones, as a table.
fn rows_of_ellipse(config: &Config, count: usize) -> String {
    let ellipse = config.hertz().under(config.model.nominal_load);
    let row = |i: usize| {
        let ordinate = (2 * i + 1) as f64 / count as f64 - 1.0;
        let square = 1.0 - ordinate * ordinate;
        format!("{:e},{:e},{square}", ellipse.b * ordinate, ellipse.a * square.sqrt())
    };
    let rows: Vec<_> = (0..count).map(row).collect();
    format!("position,half_length,load_share\n{}\n", rows.join("\n"))
}

fn rows(table: String, lines: usize, heat: bool) -> Config {
    let mut config = preset("railway_ellipse", 10);
    config.contact.shape = ContactShape::Rows;
    (config.contact.rows, config.contact.lines, config.thermal.enabled) = (table, lines, heat);
    config
}

fn ellipse(lines: usize, heat: bool) -> Config {
    let mut config = preset("railway_ellipse", 10);
    (config.contact.lines, config.thermal.enabled) = (lines, heat);
    config
}

/// Steady rolling at 20 m/s before the tread comes round again.
fn rolling(model: &Arc<Model>, creepage: f64) -> Outputs {
    run(model, prescribed(model, 20.0, creepage), (2.5e-3, 20), |_, _| {}).pop().unwrap()
}

/// Wheel S1002 on rail UIC60, inclined 1:40, 100 kN, friction 0.3, by CONTACT (open version r2707, module 1, elements of
/// 0.4 mm in rolling, 0.2 mm for the pressure): creepage, creep force over friction times load, share that sticks. The
/// wheel there has conicity, so that the contact spins, which ours does not. Its largest pressures are those of the
/// given rows.
const REAL_PATCHES: [(&str, f64, [[f64; 3]; 3]); 2] = [
    ("railway_s1002_0mm", 989.3e6, [[4.774e-4, 0.2717, 0.805], [1.976e-3, 0.8426, 0.349], [4.965e-3, 0.9985, 0.0]]),
    ("railway_s1002_3mm", 1548.7e6, [[2.106e-3, 0.6970, 0.492], [3.604e-3, 0.9162, 0.195], [6.593e-3, 0.9926, 0.0]]),
];

#[test]
fn creep_forces_and_pressures_of_real_profiles_are_those_of_contact() {
    for (name, pressure, cases) in REAL_PATCHES {
        let mut config = preset(name, 10);
        (config.thermal.enabled, config.tuning.softening) = (false, 0.0);
        for lines in [7, 13] {
            config.contact.lines = lines;
            let model = model(config.clone());
            for [xi, expected, stick] in cases {
                let last = rolling(&model, -xi);
                let found = last.contact_force_x / (0.3 * last.contact_force_y);
                let of_pressure = last.contact_pressure_max / pressure - 1.0;
                figure(&format!("real.{name}"), &[found - expected, of_pressure]);
                println!(
                    "{name}, {lines} lines, {xi}: force {:+.4}, stick {:+.3}, pressure {of_pressure:+.4}",
                    found - expected,
                    last.contact_stick_fraction - stick
                );
                let case = cases.iter().position(|[other, ..]| *other == xi).unwrap() + 1;
                figure_within(1e-3, &format!("rows.{name}.{lines} [MPa]"), &[1e-6 * last.contact_pressure_max]);
                if lines == 7 {
                    figure(&format!("rows.force.{name}.{case}"), &[found - expected]);
                    figure(&format!("rows.stick.{name}.{case}"), &[last.contact_stick_fraction - stick]);
                }
                assert!((found - expected).abs() < 0.012, "{found} for {expected}");
                assert!((last.contact_stick_fraction - stick).abs() < 0.055);
                assert!(of_pressure.abs() < 0.012);
            }
        }
    }
}

#[test]
fn rows_of_an_ellipse_are_that_ellipse() {
    let ellipse = model(ellipse(13, true));
    let rows = model(rows(rows_of_ellipse(ellipse.config(), 61), 13, true));
    let braking = |model: &Arc<Model>| {
        let mut inputs = Inputs::rolling(model.config());
        inputs.drive.moment = -4000.0;
        run(model, inputs, (1e-3, 40), vary)
    };
    let [of_ellipse, of_rows] = [&ellipse, &rows].map(braking);
    let mut worst = [0.0_f64; 5];
    for (a, b) in of_ellipse.iter().zip(&of_rows) {
        let differences = [
            (a.contact_force_x - b.contact_force_x) / 3e4,
            a.contact_force_y / b.contact_force_y - 1.0,
            a.contact_pressure_max / b.contact_pressure_max - 1.0,
            a.contact_approach / b.contact_approach - 1.0,
            a.contact_width / b.contact_width - 1.0,
        ];
        worst.iter_mut().zip(differences).for_each(|(worst, d)| *worst = worst.max(d.abs()));
    }
    figure("rows.of.ellipse", &[worst[0].max(worst[1]), worst[3]]);
    println!("forces along x and y, pressure, approach, width: {worst:?}");
    assert!(worst[0] < 5e-3 && worst[1] < 1e-3 && worst[2] < 0.015 && worst[3] < 2e-3 && worst[4] < 2e-3);
    let residuals = [&of_ellipse, &of_rows].map(|seen| seen[40].energy_residual);
    println!("energy residuals {residuals:?}");
    assert!(residuals.iter().all(|residual| residual.abs() < 5e-3));
}

#[test]
fn a_patch_seen_from_the_other_side_rolls_the_same() {
    let config = shipped("railway_s1002_3mm");
    let table = std::fs::read_to_string(format!("{}/resources/{}", env!("CARGO_MANIFEST_DIR"), config.contact.rows));
    let table = table.unwrap();
    let (head, lines) = table.split_once('\n').unwrap();
    let turned: Vec<String> = lines
        .lines()
        .rev()
        .map(|line| {
            format!(
                "{:e}{}",
                {
                    let (position, _) = line.split_once(',').unwrap();
                    -position.parse::<f64>().unwrap()
                },
                &line[line.find(',').unwrap()..]
            )
        })
        .collect();
    let [right, left] = [table.clone(), format!("{head}; {}", turned.join("; "))].map(|table| {
        let model = model(rows(table, 7, true));
        let inputs = Inputs::rolling(model.config());
        run(&model, inputs, (1e-3, 20), vary).pop().unwrap()
    });
    let same = |a: f64, b: f64| assert!((a - b).abs() < 1e-7 * a.abs().max(1e-3), "{a} is not {b}");
    same(right.contact_force_x, left.contact_force_x);
    same(right.contact_pressure_max, left.contact_pressure_max);
    same(right.temperature_wheel_max, left.temperature_wheel_max);
    for k in 0..7 {
        same(right.line_position[k], -left.line_position[6 - k]);
        same(right.line_temperature_wheel[k] - 293.0, left.line_temperature_wheel[6 - k] - 293.0);
    }
}

/// Lengths grow with the third root of the load about the centre of load, and so does the pressure.
#[test]
fn a_real_patch_grows_with_its_load_as_hertz_s_does() {
    let mut config = preset("railway_s1002_3mm", 10);
    (config.thermal.enabled, config.physics.yielding) = (false, false);
    let model = model(config);
    let at = |share: f64| {
        let mut inputs = Inputs::rolling(model.config());
        inputs.drive.load = share * 1e5;
        Simulation::new(model.clone(), &inputs).unwrap().outputs().clone()
    };
    let nominal = at(1.0);
    for share in [0.1, 0.5, 1.9] {
        let (found, scale) = (at(share), f64::cbrt(share));
        println!("{share}: {:+.1e}", found.contact_pressure_max / nominal.contact_pressure_max / scale - 1.0);
        assert!((found.contact_pressure_max / nominal.contact_pressure_max / scale - 1.0).abs() < 2e-3);
        assert!((found.contact_half_width / nominal.contact_half_width / scale - 1.0).abs() < 2e-3);
        assert!((found.contact_width / nominal.contact_width / scale - 1.0).abs() < 2e-3);
    }
}

#[test]
fn a_real_patch_with_everything_varying_balances_energy() {
    let mut config = preset("railway_s1002_0mm", 10);
    config.contact.lines = 5;
    (config.tuning.tolerance, config.tuning.max_step) = (0.0, 2.5e-4);
    let model = model(config);
    let mut inputs = Inputs::rolling(model.config());
    inputs.drive.moment = -4000.0;
    let residual = run(&model, inputs, (2.5e-4, 80), vary)[80].energy_residual;
    println!("residual {residual:.1e}");
    assert!(residual.abs() < 5e-3);
}

#[test]
fn a_real_patch_locked_and_reversed_keeps_within_friction_and_heat_balances() {
    for speed in [10.0, -10.0] {
        let mut config = preset("railway_s1002_3mm", 8);
        (config.contact.lines, config.initial.velocity) = (5, speed);
        let model = model(config);
        let mut inputs = Inputs::rolling(model.config());
        (inputs.rotation, inputs.translation) = (Rotation::Velocity, Translation::Velocity);
        let start = inputs.drive.omega;
        let seen = run(&model, inputs, (1e-3, 60), |inputs, t| inputs.drive.omega = start * (1.0 - t / 0.03).max(0.0));
        for outputs in &seen {
            assert!(outputs.contact_force_x.abs() <= 1.01 * outputs.friction * outputs.contact_force_y);
        }
        let last = &seen[60];
        println!(
            "{speed}: {:.0} N, {:.0} K, heat {:.1e}",
            last.contact_force_x, last.temperature_wheel_max, last.heat_residual
        );
        assert!(last.contact_force_x * speed < 0.0 && last.heat_residual.abs() < 1e-6);
    }
}

#[test]
fn a_file_of_rows_is_read_beside_the_presets_and_a_missing_one_is_named() {
    let config = shipped("railway_s1002_3mm");
    let shared = model(config.clone());
    assert!(shared.serves(&config) && Arc::ptr_eq(&shared, &model(config.clone())));
    assert!(shared.config().contact.rows.starts_with("position,half_length,load_share\n"));
    let mut missing = config;
    missing.contact.rows = "missing.csv".to_owned();
    assert!(!shared.serves(&missing));
    let error = Model::shared(missing, &store(), &mut |_, _| {}).err().unwrap().to_string();
    assert!(
        ["contact.rows", "missing.csv", "cannot be read", "resources"].iter().all(|word| error.contains(word)),
        "{error}"
    );
    let mut senseless = rows("position,half_length,load_share; 0,9e-3,1; 1e-5,9e-3,1".to_owned(), 7, false);
    let error = senseless.validate().unwrap_err().to_string();
    assert!(error.contains("half axes' ratio a/b of contact.rows") && error.contains("0.05 to 25"), "{error}");
    senseless.contact.rows = String::new();
    let error = senseless.validate().unwrap_err().to_string();
    assert!(error.contains("contact.rows has 0 rows"), "{error}");
}

/// Inputs of a wheel that rolls at 20 m/s with a driving creepage of 0.3 % under a load \[N].
fn driven(model: &Model, load: f64) -> Inputs {
    let mut inputs = prescribed(model, 20.0, -0.003);
    inputs.drive.load = load;
    inputs
}

/// Largest pressure under a load is that under 100 kN times the third root of both loads, whatever the nominal load.
#[test]
fn rows_under_any_load_and_nominal_load_are_those_of_hertz_s_third_root() {
    let cases = [
        [100e3, 100e3],
        [100e3, 50e3],
        [50e3, 50e3],
        [100e3, 190e3],
        [190e3, 190e3],
        [20e3, 20e3],
        [5e3, 5e3],
        [60e3, 50e3],
    ];
    for name in ["railway_s1002_3mm", "railway_s1002_0mm"] {
        let mut reference: Option<[f64; 2]> = None;
        for [nominal, load] in cases {
            let mut config = preset(name, 10);
            // Steel that yields has no more than its own pressure.
            (config.model.nominal_load, config.physics.yielding) = (nominal, false);
            config.material.yield_strength = 900e6;
            let model = model(config);
            let simulation = Simulation::new(model.clone(), &driven(&model, load)).unwrap();
            let (found, limits) = (simulation.outputs(), simulation.exceeded_limits().collect::<Vec<_>>());
            let size = [found.contact_pressure_max, found.contact_width];
            let scale = (load / 1e5).cbrt();
            let errors = [0, 1].map(|k| size[k] / reference.get_or_insert(size)[k] / scale - 1.0);
            let force = found.contact_force_x / (0.3 * found.contact_force_y);
            println!(
                "{name}, {load} N, nominal {nominal} N: {:.0} MPa ({:+.1e}), width {:+.1e}, force {force:.4}, {limits:?}",
                1e-6 * size[0],
                errors[0],
                errors[1]
            );
            assert!(errors.iter().all(|error| error.abs() < 3e-3) && limits.is_empty());
            assert!((found.contact_force_y / load - 1.0).abs() < 1e-9);
        }
    }
}

#[test]
fn a_table_of_another_load_is_the_same_patch() {
    let found = [1e5, 4e4].map(|rows_load: f64| {
        let config = rows(rows_of_ellipse(&ellipse(7, false), 41), 7, false);
        let scale = (rows_load / 1e5).cbrt();
        let scaled = |line: &str| {
            let cells: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
            format!("{:e},{:e},{}", scale * cells[0], scale * cells[1], cells[2])
        };
        let (head, lines) = config.contact.rows.split_once('\n').unwrap();
        let table = lines.lines().map(scaled).collect::<Vec<_>>().join(";");
        let mut config = config.clone();
        (config.contact.rows, config.contact.rows_load) = (format!("{head};{table}"), rows_load);
        let model = model(config);
        Simulation::new(model.clone(), &driven(&model, 7e4)).unwrap().outputs().clone()
    });
    let [a, b] = &found;
    for (a, b) in [
        (a.contact_force_x, b.contact_force_x),
        (a.contact_pressure_max, b.contact_pressure_max),
        (a.contact_approach, b.contact_approach),
        (a.contact_width, b.contact_width),
    ] {
        println!("{a} {b}");
        assert!((a / b - 1.0).abs() < 1e-6);
    }
}

/// A table of rows that are 1 mm wide at positions \[mm], with half-lengths \[mm] and loads.
fn table(rows: &[(f64, f64, f64)]) -> String {
    let rows: Vec<_> = rows.iter().map(|(z, a, load)| format!("{z}e-3,{a}e-3,{load}")).collect();
    format!("position,half_length,load_share;{}", rows.join(";"))
}

/// Tread and flange: rows from -5.5 to 5.5 mm with 60 % of the load, and from 32.5 to 35.5 mm with 40 %.
fn tread_and_flange() -> Vec<(f64, f64, f64)> {
    let tread = (0..12).map(|k| (f64::from(k) - 5.5, 5.5, 0.6 / 12.0));
    let flange = (0..4).map(|k| (f64::from(k) + 32.5, 5.196, 0.4 / 4.0));
    tread.chain(flange).collect()
}

/// Sides of lines \[mm]: their middle, width, load \[kN] and pressure \[MPa].
fn seen(outputs: &Outputs) -> Vec<[f64; 4]> {
    let line = |k: usize| {
        let scaled = [1e3, 1e3, 1e-3, 1e-6];
        let values = [&outputs.line_position, &outputs.line_width, &outputs.line_force_y, &outputs.line_pressure_max];
        [0, 1, 2, 3].map(|i| scaled[i] * values[i][k])
    };
    (0..outputs.contact_line_count as usize).map(line).collect()
}

#[test]
fn two_patches_of_one_table_keep_load_pressure_and_the_gap_between_them() {
    for lines in [2, 7, 13] {
        let model = model(rows(table(&tread_and_flange()), lines, false));
        for load in [1e5, 5e4] {
            let simulation = Simulation::new(model.clone(), &driven(&model, load)).unwrap();
            let (found, scale) = (seen(simulation.outputs()), (load / 1e5).cbrt());
            println!("{lines} lines, {load} N: {found:.3?}");
            // About the centre of load, which is that of 0 and 34 mm.
            let at = |z: f64| 13.6 + scale * (z - 13.6);
            let [tread, flange] = [[at(-6.0), at(6.0)], [at(32.0), at(36.0)]];
            let within = |line: &[f64; 4], [low, high]: [f64; 2]| {
                line[0] - 0.5 * line[1] > low - 0.02 && line[0] + 0.5 * line[1] < high + 0.02
            };
            assert!(found.len() == lines && found.iter().all(|line| within(line, tread) != within(line, flange)));
            for (patch, share, width) in [(tread, 0.6, 12.0), (flange, 0.4, 4.0)] {
                let lines: Vec<_> = found.iter().filter(|line| within(line, patch)).collect();
                let sum = |k: usize| lines.iter().map(|line| line[k]).sum::<f64>();
                assert!((sum(2) / (1e-3 * load * share) - 1.0).abs() < 5e-3, "{}", sum(2));
                assert!((sum(1) / (scale * width) - 1.0).abs() < 2e-3, "{}", sum(1));
            }
            let highest = found[lines - 1][3];
            assert!((highest / (1225.0 * scale) - 1.0).abs() < 0.02, "{highest}");
        }
    }
}

/// Braking with everything varying keeps within friction and balances.
#[test]
fn two_patches_of_one_table_brake_with_balanced_heat_and_energy() {
    let model = model(rows(table(&tread_and_flange()), 5, true));
    let inputs = Inputs::rolling(model.config());
    let seen = run(&model, inputs, (1e-3, 60), vary);
    let last = &seen[60];
    println!(
        "heat {:.1e}, energy {:.1e}, hottest {:?}",
        last.heat_residual,
        last.energy_residual,
        &last.line_temperature_wheel[..5]
    );
    assert!(last.heat_residual.abs() < 1e-6 && last.energy_residual.abs() < 5e-3);
    for outputs in &seen {
        assert!(outputs.contact_force_x.abs() <= 1.01 * outputs.friction * outputs.contact_force_y);
    }
}

#[test]
fn a_groove_parts_a_patch_and_no_line_lies_over_it() {
    let ellipse = ellipse(7, false).hertz().under(1e5);
    let half = |i: u32| (f64::from(i) - 10.0) / 10.5;
    let row = |i: u32| {
        let square = 1.0 - half(i) * half(i);
        (1e3 * ellipse.b * half(i), 1e3 * ellipse.a * square.sqrt(), square)
    };
    let rows_without: Vec<_> = (0..21).filter(|i| *i != 10).map(row).collect();
    let [mut low, mut high] = [f64::NEG_INFINITY, f64::INFINITY];
    let model = model(rows(table(&rows_without), 6, false));
    let outputs = Simulation::new(model.clone(), &driven(&model, 1e5)).unwrap().outputs().clone();
    let found = seen(&outputs);
    for [position, width, ..] in &found {
        if *position < 0.0 {
            low = low.max(*position);
        } else {
            high = high.min(*position);
        }
        assert!(*width < 1e3 * ellipse.b);
    }
    let width: f64 = found.iter().map(|line| line[1]).sum();
    let peak = rows_without.iter().map(|(_, a, share)| share / a).fold(0.0, f64::max);
    let sum: f64 = rows_without.iter().map(|row| row.2).sum();
    let row_width = ellipse.b / 10.5;
    let pressure = 2.0 / std::f64::consts::PI * 1e5 * peak / (1e-3 * row_width * sum);
    println!("{found:.3?}, {:.4} of the largest pressure", outputs.contact_pressure_max / pressure);
    assert!((width / (20e3 * row_width) - 1.0).abs() < 2e-3);
    assert!(low < -0.5e3 * row_width && high > 0.5e3 * row_width);
    assert!((outputs.contact_pressure_max / pressure - 1.0).abs() < 0.03);
}

#[test]
fn more_patches_than_lines_are_refused_with_what_to_do() {
    let config = rows(table(&tread_and_flange()), 1, false);
    let error = config.validate().unwrap_err().to_string();
    assert!(
        ["number of patches in contact.rows = 2", "contact.lines = 1", "width"].iter().all(|w| error.contains(w)),
        "{error}"
    );
}
