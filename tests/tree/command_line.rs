//! The built binary from outside: what it writes, what it refuses, and the fields against contact mechanics.

use crate::common::{self, model};
use quick_xml::Reader;
use quick_xml::events::Event;
use std::collections::HashMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use wheelrail::analytic::{contact_modulus, hertz_half_width, hertz_peak_pressure};
use wheelrail::config::Config;
use wheelrail::fmi::v2::variables::variables;
use wheelrail::mechanics::{rail_mesh, wheel_mesh};
use wheelrail::simulation::{Inputs, PROFILE_POINTS, Simulation};

/// Small meshes and modes enough for tests.
const SMALL: [&str; 6] =
    ["--preset", "paper_d", "--set", "mesh.elements_per_half_width=8", "--set", "mesh.grid_elements_per_half_width=8"];

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// The configuration of `SMALL`.
fn small() -> Config {
    common::preset("paper_d", 8)
}

/// Runs the binary in the directory of the package, with its bases kept where the other tests keep theirs.
fn wheelrail(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_wheelrail")).current_dir(root()).args(arguments).output().unwrap()
}

/// Standard output of a run that must succeed.
fn succeed(arguments: &[&str]) -> String {
    let output = wheelrail(arguments);
    let messages = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{arguments:?}: {messages}");
    String::from_utf8(output.stdout).unwrap()
}

/// A directory of its own for a test, empty.
fn directory(name: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("command_line").join(name);
    let _ = fs::remove_dir_all(&path);
    fs::create_dir_all(&path).unwrap();
    path
}

fn file(name: &str, text: &str) -> String {
    let path = directory(name).join("scenario.csv");
    fs::write(&path, text).unwrap();
    path.to_str().unwrap().to_owned()
}

/// Columns of a CSV by name.
struct Table(HashMap<String, Vec<f64>>);

impl Table {
    fn parse(text: &str) -> Table {
        let mut lines = text.lines();
        let names: Vec<_> = lines.next().expect("a header").split(',').collect();
        let mut columns: HashMap<_, Vec<f64>> = names.iter().map(|name| (name.to_string(), Vec::new())).collect();
        for line in lines {
            let cells: Vec<_> = line.split(',').collect();
            assert_eq!(cells.len(), names.len(), "{line}");
            for (name, cell) in names.iter().zip(cells) {
                columns.get_mut(*name).unwrap().push(cell.parse().unwrap());
            }
        }
        Table(columns)
    }

    fn column(&self, name: &str) -> &[f64] {
        &self.0[name]
    }

    fn last(&self, name: &str) -> f64 {
        *self.0[name].last().unwrap()
    }
}

fn assert_close(found: f64, expected: f64, tolerance: f64, what: &str) {
    let error = (found - expected).abs();
    assert!(error <= tolerance * expected.abs().max(1e-9), "{what}: {found} against {expected}");
}

#[test]
fn simulated_numbers_are_those_of_the_library() {
    let (step, steps) = (1e-3, 20);
    let (moment, ramp) =
        (|t: f64| -8000.0 * (t / 0.01).min(1.0), file("library", "time,drive.moment\n0,0\n0.01,-8e3\n"));
    let out = directory("library_out").join("new").join("run.csv");
    let mut arguments = vec!["simulate"];
    arguments.extend(SMALL);
    arguments.extend(["--set", "initial.velocity=10", "--scenario", &ramp, "--stop", "0.02"]);
    let outputs = "wheel.velocity,contact.force_x,contact.creepage,temperature.wheel_max,solver.energy_residual";
    arguments.extend(["--outputs", outputs, "--out", out.to_str().unwrap()]);
    assert_eq!(succeed(&arguments), "", "with --out nothing goes to standard output");
    let text = fs::read_to_string(&out).unwrap();
    assert_eq!(text.lines().next().unwrap(), format!("time,{outputs}"));
    let table = Table::parse(&text);
    assert_eq!(table.column("time").len(), steps + 1);

    let mut config = small();
    config.initial.velocity = 10.0;
    let model = model(config);
    let mut inputs = Inputs::rolling(model.config());
    let mut simulation = Simulation::new(model, &inputs).unwrap();
    for i in 0..=steps {
        let o = simulation.outputs();
        for (name, value) in [
            ("time", i as f64 * step),
            ("wheel.velocity", o.wheel_velocity),
            ("contact.force_x", o.contact_force_x),
            ("contact.creepage", o.contact_creepage),
            ("temperature.wheel_max", o.temperature_wheel_max),
            ("solver.energy_residual", o.energy_residual),
        ] {
            // The residual is a small difference of large sums, in which the last bits of the moment tell.
            let found = table.column(name)[i];
            if name == "solver.energy_residual" {
                assert!((found - value).abs() < 1e-10, "{name} after {i} steps: {found} against {value}");
            } else {
                assert_close(found, value, 1e-12, &format!("{name} after {i} steps"));
            }
        }
        let (now, end) = (i as f64 * step, (i + 1) as f64 * step);
        inputs.drive.moment = moment(now);
        inputs.rate.moment = (moment(end) - moment(now)) / step;
        simulation.advance(&inputs, step).unwrap();
    }
    assert!(table.last("contact.force_x") < -1000.0, "the brake acts: {} N", table.last("contact.force_x"));
}

#[test]
fn scenarios_are_linear_between_rows_and_choices_switch_on_time() {
    let rows = "time,control.rotation,drive.moment,control.translation,drive.velocity,drive.force\n\
        0,moment,0,velocity,10,0\n0.004,moment,-4000,velocity,10.02,0\n0.004,moment,-2000,velocity,10.02,0\n\
        0.008,2,-2000,1,10,0\n0.01,moment,-2000,force,9.99,0\n";
    let mut arguments = vec!["simulate", "--scenario"];
    let path = file("interpolation", rows);
    arguments.push(&path);
    arguments.extend(SMALL);
    arguments.extend(["--set", "initial.velocity=10", "--stop", "0.012"]);
    arguments.extend(["--outputs", "hub.moment,wheel.velocity,hub.force_x"]);
    let table = Table::parse(&succeed(&arguments));
    assert_eq!(table.column("time").len(), 13);
    for (i, t) in table.column("time").iter().enumerate() {
        // Outputs after a step are those at its end, before a jump.
        let moment = if *t < 4.5e-3 { -1e6 * t } else { -2000.0 };
        assert_close(table.column("hub.moment")[i], moment, 1e-9, &format!("moment at {t} s"));
        let velocity = if *t < 4.5e-3 { 10.0 + 5.0 * t } else { 10.02 - 5.0 * (t - 0.004) };
        if *t < 8.5e-3 {
            assert_close(table.column("wheel.velocity")[i], velocity, 1e-12, &format!("velocity at {t} s"));
        }
        if *t > 10.5e-3 {
            assert_eq!(table.column("hub.force_x")[i], 0.0, "the force is prescribed from 0.01 s on");
        }
    }
}

#[test]
fn runs_end_with_a_shorter_step_and_write_every_nth_point() {
    let mut arguments = vec!["simulate", "--stop", "0.0025", "--every", "2", "--outputs", "profile.pressure,preset"];
    arguments.extend(SMALL);
    let text = succeed(&arguments);
    let times: Vec<_> = text.lines().skip(1).map(|line| line.split(',').next().unwrap()).collect();
    assert_eq!(times, ["0.0", "0.002", "0.0025"]);
    let header: Vec<_> = text.lines().next().unwrap().split(',').collect();
    assert_eq!(
        (header.len(), header[1], header[61]),
        (PROFILE_POINTS + 2, "profile.pressure[1]", "profile.pressure[61]")
    );
    assert!(text.lines().nth(1).unwrap().ends_with(",paper_d"));
}

#[test]
fn default_outputs_exist_and_the_summary_is_on_standard_error() {
    let mut arguments = vec!["simulate", "--stop", "0.003"];
    arguments.extend(SMALL);
    let output = wheelrail(&arguments);
    let (out, messages) = (String::from_utf8(output.stdout).unwrap(), String::from_utf8(output.stderr).unwrap());
    assert!(output.status.success(), "{messages}");
    let names: Vec<_> = out.lines().next().unwrap().split(',').skip(1).collect();
    assert!(names.len() > 10 && names.iter().all(|name| variables().iter().any(|v| v.name == *name)), "{names:?}");
    assert_eq!(out.lines().count(), 1 + 4);
    // 50 km/h for 3 ms.
    for line in ["50.00 km/h", "0.04167 m", "peak creepage", "degC", "heat residual", "energy residual", "real-time"] {
        assert!(messages.contains(line), "{line} in\n{messages}");
    }
}

#[test]
fn the_profile_of_the_wheel_at_the_end_is_written_and_read_again() {
    let path = directory("left_profile").join("left.csv");
    let path = path.to_str().unwrap();
    let mut arguments =
        vec!["simulate", "--stop", "0.002", "--outputs", "wheel.profile_height", "--wheel-profile", path];
    arguments.extend(SMALL);
    arguments.extend(["--set", "wheel.profile=squat(position = 0, length = 0.01, depth = 1e-5)", "--set"]);
    let first = succeed(&[&arguments[..], &["damage.wear=t_gamma"]].concat());
    let profile = std::fs::read_to_string(path).unwrap();
    assert!(profile.starts_with("position,height\n0.0,-1") && profile.lines().count() > 3, "{profile}");
    let loaded = format!("wheel.profile={path}");
    let again = Table::parse(&succeed(&[&arguments[..5], &SMALL, &["--set", &loaded]].concat()));
    assert_close(again.column("wheel.profile_height")[0], -1e-5, 1e-3, "height of the squat");
    assert_eq!(Table::parse(&first).column("wheel.profile_height").len(), 3);
    let refused = wheelrail(&[&["simulate", "--wheel-profile", "profile.txt", "--stop", "0"], &SMALL[..]].concat());
    assert!(!refused.status.success() && String::from_utf8_lossy(&refused.stderr).contains("must end in .csv"));
}

#[test]
fn settings_take_the_place_of_the_preset_and_of_start_values_of_inputs() {
    let mut arguments = vec!["simulate", "--stop", "0", "--outputs"];
    arguments.push("wheel.radius,wheel.velocity,control.rotation,hub.moment,thermal.enabled");
    arguments.extend(SMALL);
    for setting in ["wheel.radius=0.45", "drive.velocity=7", "control.translation=1", "thermal.enabled=false"] {
        arguments.extend(["--set", setting]);
    }
    arguments.extend(["--set", "drive.moment=-123.5"]);
    let text = succeed(&arguments);
    assert_eq!(text.lines().last().unwrap(), "0.0,0.45,7.0,moment,-123.5,false");
}

#[test]
fn wrong_arguments_end_with_code_2_and_say_what_is_possible() {
    let scenario = file("wrong", "time,drive.load\n0,1e5\n1,-5\n");
    let cases: [(&[&str], &[&str]); 20] = [
        (&["simulate", "--set", "drive.laod=1"], &["drive.laod", "drive.load"]),
        (&["simulate", "--set", "drive.load"], &["drive.load", "NAME=VALUE"]),
        (&["simulate", "--set", "drive.load=-1"], &["drive.load = -1", "0 to 1e9 N"]),
        (&["simulate", "--set", "drive.load=much"], &["drive.load", "\"much\"", "[N]"]),
        (&["simulate", "--set", "contact.force_x=1"], &["contact.force_x", "output"]),
        (&["simulate", "--set", "control.rotation=torque"], &["control.rotation", "velocity (1) or moment (2)"]),
        (
            &["simulate", "--set", "wheel.hub_radius=0.45"],
            &["wheel.hub_radius = 0.45", "0.0092 to 0.414 m with wheel.radius"],
        ),
        (&["simulate", "--preset", "tram"], &["\"tram\"", "railway", "paper_d"]),
        (&["simulate", "--preset", "railway_elipse"], &["is unknown; did you mean \"railway_ellipse\"?"]),
        (&["simulate", "--step", "-1"], &["--step = -1", "more than 0"]),
        (&["simulate", "--stop", "-1"], &["--stop = -1", "at least 0"]),
        (&["simulate", "--every", "0"], &["--every", "0"]),
        (&["simulate", "--outputs", "contact.force_xx"], &["contact.force_xx", "contact.force_x"]),
        (&["simulate", "--scenario", &scenario], &["scenario.csv", "line 3", "drive.load = -5"]),
        (&["simulate", "--scenario", "absent.csv"], &["absent.csv", "No such file"]),
        (&["steady", "--creepage", "0:1"], &["0:1", "FROM:TO:COUNT"]),
        (&["steady", "--velocity", "300"], &["--velocity = 300", "-200 to 200"]),
        (
            &["steady", "--set", "rail.friction=0", "--set", "mesh.elements_per_half_width=4"],
            &["friction", "--creepage"],
        ),
        (&["steady", "--set", "drive.omega=1"], &["drive.omega", "--creepage"]),
        (&["export", "--creepage", "0", "--stop", "1"], &["--creepage", "--stop", "exclude"]),
    ];
    for (arguments, words) in cases {
        let output = wheelrail(arguments);
        let messages = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {messages}");
        assert!(words.iter().all(|word| messages.contains(word)), "{arguments:?}: {messages}");
        assert!(output.stdout.is_empty(), "{arguments:?} wrote to standard output");
    }
}

/// Warnings of a short run with some settings.
fn warnings(settings: &[&str], more: &[&str]) -> Vec<String> {
    let set = settings.iter().flat_map(|setting| ["--set", setting]);
    let arguments: Vec<_> =
        ["simulate", "--set", "initial.velocity=20", "--set", "thermal.enabled=false"].into_iter().chain(set).collect();
    let output = wheelrail(&[&arguments, more].concat());
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let messages = String::from_utf8(output.stderr).unwrap();
    messages.lines().filter(|line| line.starts_with("warning: ")).map(str::to_owned).collect()
}

#[test]
fn profiles_beside_the_way_and_gaps_in_them_are_told_with_both_ranges() {
    let folder = directory("beside");
    let profile = |name: &str, place: &dyn Fn(usize) -> f64| {
        let rows: String = (0..40).map(|k| format!("{:?},{:?}\n", place(k), 1e-7 * (k % 3) as f64)).collect();
        let path = folder.join(name);
        fs::write(&path, format!("position,height\n{rows}")).unwrap();
        format!("rail.profile={}", path.to_str().unwrap())
    };
    let at = |begin: f64| move |k: usize| begin + 0.01 * k as f64;
    for (name, text, velocity, words) in [
        (
            "chainage",
            profile("chainage.csv", &at(12000.0)),
            20.0,
            &["from 12000 to 12000.4 m", "position = -12000)"][..],
        ),
        ("ahead", profile("ahead.csv", &at(5.0)), 20.0, &["from 5 to 5.39 m", "has been between 0 and 0.1", "= -5)"]),
        ("backwards", profile("backwards.csv", &at(-9.0)), -20.0, &["from -9 to -8.61 m", "-0.1", "= 8.61)"]),
        ("behind", profile("behind.csv", &at(-5.0)), 20.0, &["passed the last sample", "-5.000 to -4.610 m"]),
        ("met", profile("met.csv", &at(-0.1)), 20.0, &[]),
        (
            "gap",
            profile("gap.csv", &|k| at(-0.2)(k) + if k > 20 { 0.1 } else { 0.0 }),
            20.0,
            &["no samples between 0 and 0.11 m", "0.01 m apart"],
        ),
        (
            "hole",
            "rail.profile=hole(position = 50, length = 0.005, depth = 0.0001)".to_owned(),
            20.0,
            &["no effect", "0.1"],
        ),
    ] {
        let velocity = format!("initial.velocity={velocity}");
        let found = warnings(&[&velocity, &text], &["--stop", "0.005", "--step", "0.0002"]);
        println!("{name}: {found:?}");
        assert!(words.is_empty() == found.is_empty(), "{name}: {found:?}");
        assert!(words.iter().all(|word| found.iter().any(|text| text.contains(word))), "{name}: {found:?}");
        assert!(found.len() <= 1, "{name}: {found:?}");
    }
}

#[test]
fn a_cross_section_in_the_place_of_a_profile_is_told() {
    let row = |k: i32| {
        let z = 1e-3 * f64::from(k);
        format!("{z:?},{:?}\n", -z * z / 0.16)
    };
    let path = directory("section").join("head.csv");
    fs::write(&path, format!("position,height\n{}", (-36..=36).map(row).collect::<String>())).unwrap();
    let found = warnings(&[&format!("rail.profile={}", path.display())], &["--stop", "0"]);
    println!("{found:?}");
    let words = ["differ by 8.1 mm in height on a length of 72 mm", "cross-section", "contact.rail_lateral_radius"];
    assert!(words.iter().all(|word| found.iter().any(|text| text.contains(word))), "{found:?}");
}

#[test]
fn a_width_that_is_that_of_the_wheel_is_told_and_that_of_a_wheelset_is_not() {
    let found = warnings(&["model.contact_width=0.135"], &["--stop", "0.001"]);
    println!("{found:?}");
    let words =
        ["model.contact_width = 0.135 m", "0.32 times the pressure", "the width is 0.014 m", "thermal.rim_width"];
    assert!(found.len() == 1 && words.iter().all(|word| found[0].contains(word)), "{found:?}");
    let wheelset = ["model.contact_width=0.028", "model.nominal_load=200000"];
    assert_eq!(warnings(&wheelset, &["--stop", "0.001"]), Vec::<String>::new());
}

#[test]
fn a_pulse_within_a_step_keeps_its_impulse_and_what_is_not_seen_is_told() {
    let pulse = file("pulse", "time,drive.force\n0,0\n0.0051,0\n0.0051,5e4\n0.0058,5e4\n0.0058,0\n");
    let last = |step: &str| {
        let arguments =
            ["simulate", "--set", "initial.velocity=20", "--set", "thermal.enabled=false", "--stop", "0.01"];
        let run = Table::parse(&succeed(&[&arguments[..], &["--scenario", &pulse, "--step", step]].concat()));
        run.last("wheel.velocity") - 20.0
    };
    let (exact, found) = (last("1e-4"), ["1e-3", "2e-3", "1e-2"].map(last));
    println!("{exact:e}: {found:?}");
    assert!(exact > 1e-3);
    found.iter().for_each(|found| assert_close(*found, exact, 0.01, "change of speed"));
    let rows: String = (0..=100).map(|k| format!("{},{:e}\n", 1e-4 * k as f64, 1e-5 * f64::sin(k as f64))).collect();
    let fine = file("fine", &format!("time,rail.elevation\n{rows}"));
    let found = warnings(&[], &["--scenario", &fine, "--stop", "0.01"]);
    assert!(
        found.iter().any(|text| text.contains("89 of 101 rows lie within communication steps of 0.001 s")),
        "{found:?}"
    );
    let late = file("late", "time,drive.load\n100,1e5\n101,1e5\n");
    let found = warnings(&[], &["--scenario", &late, "--stop", "0.001"]);
    assert!(found[0].contains("from 100 to 101 s lie outside of the run from 0 to 0.001 s"), "{found:?}");
}

#[test]
fn failed_runs_end_with_code_1_and_keep_what_was_computed() {
    let overload = file("overload", "time,drive.load\n0,1e5\n0.002,1e5\n0.01,9e6\n");
    let mut arguments = vec!["simulate", "--scenario", &overload];
    arguments.extend(SMALL);
    let output = wheelrail(&arguments);
    let (out, messages) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    assert_eq!(output.status.code(), Some(1), "{messages}");
    assert!(messages.contains("model.nominal_load"), "{messages}");
    let table = Table::parse(&out);
    assert!(table.column("time").len() >= 3 && table.last("time") < 0.01, "up to {} s", table.last("time"));
    assert!(table.column("contact.force_y").iter().all(|f| *f > 9e4));

    let mut arguments = vec!["steady", "--creepage", "0", "--out", "Cargo.toml/steady.csv"];
    arguments.extend(SMALL);
    let output = wheelrail(&arguments);
    assert_eq!(output.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&output.stderr).contains("Cargo.toml/steady.csv cannot be written"));
}

#[test]
fn every_command_explains_its_arguments() {
    for (command, words) in [
        ("pack", &["--library", "--cache"][..]),
        ("simulate", &["--preset", "--set", "--scenario", "--stop", "--step", "--out", "--outputs", "--every"]),
        ("steady", &["--velocity", "--creepage", "--table"]),
        ("export", &["--creepage", "--scenario", "solver.response"]),
    ] {
        let help = succeed(&[command, "--help"]);
        assert!(words.iter().all(|word| help.contains(word)), "{help}");
    }
    let description = fs::read_to_string(root().join("modelDescription.xml")).unwrap();
    assert!(succeed(&["describe"]) == description);
}

/// Hertzian half-width [m] and peak pressure [Pa] under the nominal load.
fn hertz(config: &Config) -> (f64, f64) {
    let load = config.model.nominal_load / config.model.contact_width;
    let modulus = contact_modulus(config.material.youngs_modulus, config.material.poissons_ratio);
    let a = hertz_half_width(load, config.wheel.radius, modulus);
    (a, hertz_peak_pressure(load, a))
}

#[test]
fn steady_rolling_has_the_patch_of_hertz_and_adhesion_rises_to_full_slip() {
    let mut arguments = vec!["steady", "--velocity", "13.9", "--creepage", "0:1e-3:11"];
    arguments.extend(SMALL);
    let table = Table::parse(&succeed(&arguments));
    let (a, p0) = hertz(&small());
    for (half_width, pressure) in table.column("contact.half_width").iter().zip(table.column("contact.pressure_max")) {
        assert_close(*half_width, a, 0.01, "half-width");
        assert_close(*pressure, p0, 0.01, "peak pressure");
    }
    let used = table.column("contact.utilisation");
    let stick = table.column("contact.stick_fraction");
    for (k, creepage) in table.column("contact.creepage").iter().enumerate() {
        assert!((creepage - 1e-4 * k as f64).abs() < 1e-12, "creepage: {creepage}");
        // Carter's full slip is at 6.1e-4.
        assert!(
            k == 0 || *creepage > 6.5e-4 || (used[k] > used[k - 1] && stick[k] < stick[k - 1]),
            "{used:?} {stick:?}"
        );
        assert!(*creepage < 6.5e-4 || ((used[k] - 1.0).abs() < 1e-9 && stick[k] == 0.0), "{used:?} {stick:?}");
    }
    let power = table.last("heat.friction_power");
    let slip = 13.9 - 13.9 * (1.0 - 0.5e-3) / (1.0 + 0.5e-3);
    assert_close(power, -table.last("contact.force_x") * slip, 0.01, "friction power");
    assert!(table.last("temperature.rail_max") > 293.02 && table.last("contact.moment") > 0.0);

    let mut arguments = vec!["steady", "--velocity", "13.9", "--creepage", "3e-4"];
    arguments.extend(SMALL);
    let point = Table::parse(&succeed(&arguments));
    assert_eq!(point.column("contact.force_x"), &table.column("contact.force_x")[3..4]);
    let shown = succeed(&[&arguments[..], &["--table"]].concat());
    assert!(shown.contains("force_x") && shown.contains("[kN]") && shown.lines().count() == 3, "{shown}");
}

/// Contents of a `.vtu` file.
struct Grid {
    points: Vec<[f64; 3]>,
    cells: Vec<[usize; 4]>,
    data: HashMap<String, Vec<f64>>,
}

impl Grid {
    /// Reads the file as XML and checks what it says of itself.
    fn read(path: &Path) -> Grid {
        let mut reader = Reader::from_file(path).unwrap();
        let (mut buffer, mut declared) = (Vec::new(), Vec::new());
        let (mut array, mut arrays) = (None, HashMap::new());
        loop {
            match reader.read_event_into(&mut buffer).unwrap() {
                Event::Start(element) => {
                    let attributes: HashMap<String, String> = element
                        .attributes()
                        .map(|attribute| {
                            let attribute = attribute.unwrap();
                            (attribute.key.as_ref().to_owned(), attribute.value.into_owned())
                        })
                        .collect();
                    match element.name().as_ref() {
                        "VTKFile" => assert_eq!(attributes["type"], "UnstructuredGrid"),
                        "Piece" => {
                            declared = vec![attributes["NumberOfPoints"].clone(), attributes["NumberOfCells"].clone()];
                        }
                        "DataArray" => array = Some(attributes),
                        _ => {}
                    }
                }
                Event::Text(text) => {
                    if let Some(attributes) = array.take() {
                        let values: Vec<f64> = text.split_whitespace().map(|number| number.parse().unwrap()).collect();
                        let components: usize = attributes["NumberOfComponents"].parse().unwrap();
                        assert_eq!(values.len() % components, 0);
                        arrays.insert(attributes["Name"].clone(), values);
                    }
                }
                Event::Eof => break,
                _ => {}
            }
        }
        let points: Vec<_> = arrays.remove("points").unwrap().chunks_exact(3).map(|p| [p[0], p[1], p[2]]).collect();
        let corners = arrays.remove("connectivity").unwrap();
        let cells: Vec<_> = corners.chunks_exact(4).map(|c| [0, 1, 2, 3].map(|i| c[i] as usize)).collect();
        assert_eq!(declared, [points.len().to_string(), cells.len().to_string()]);
        assert_eq!(arrays.remove("offsets").unwrap(), (1..=cells.len()).map(|i| 4.0 * i as f64).collect::<Vec<_>>());
        assert!(arrays.remove("types").unwrap().iter().all(|t| *t == 9.0));
        for (name, values) in &arrays {
            assert!(values.len() == points.len() || values.len() == 3 * points.len(), "{name}");
            assert!(values.iter().all(|v| v.is_finite()), "{name}");
        }
        let grid = Grid { points, cells, data: arrays };
        assert!(grid.cells.iter().all(|cell| grid.area(cell) > 0.0), "cells are counter-clockwise");
        grid
    }

    fn area(&self, cell: &[usize; 4]) -> f64 {
        let [a, b, c, d] = cell.map(|i| self.points[i]);
        0.5 * ((c[0] - a[0]) * (d[1] - b[1]) - (d[0] - b[0]) * (c[1] - a[1]))
    }

    /// Nodes below (or above) the contact point within `reach` of the axis, as (depth, node), ascending.
    fn axis(&self, reach: f64, limit: f64) -> Vec<(f64, usize)> {
        let on_axis = |&(_, p): &(usize, &[f64; 3])| p[0].abs() < reach && p[1].abs() < limit;
        let mut nodes: Vec<_> = self.points.iter().enumerate().filter(on_axis).map(|(i, p)| (p[1].abs(), i)).collect();
        nodes.sort_by(|a, b| a.0.total_cmp(&b.0));
        nodes
    }

    /// Nodes on the surface within `reach`, as (x, node), ascending; `radius` of the wheel, infinite for the rail.
    fn surface(&self, radius: f64, reach: f64) -> Vec<(f64, usize)> {
        let height = |x: f64| if radius.is_finite() { radius - (radius * radius - x * x).sqrt() } else { 0.0 };
        let on_surface = |&(_, p): &(usize, &[f64; 3])| p[0].abs() < reach && (p[1] - height(p[0])).abs() < 1e-12;
        let mut nodes: Vec<_> = self.points.iter().enumerate().filter(on_surface).map(|(i, p)| (p[0], i)).collect();
        nodes.sort_by(|a, b| a.0.total_cmp(&b.0));
        nodes
    }

    /// `∫ field dx` over the surface by the trapezoidal rule.
    fn integral(&self, field: &str, surface: &[(f64, usize)]) -> f64 {
        let value = |k: usize| self.data[field][surface[k].1];
        (1..surface.len()).map(|k| 0.5 * (surface[k].0 - surface[k - 1].0) * (value(k) + value(k - 1))).sum()
    }
}

/// Vertex of the parabola through the largest of the values and its neighbours.
fn vertex(values: &[(f64, f64)]) -> (f64, f64) {
    let at = (1..values.len() - 1).max_by(|&i, &j| values[i].1.total_cmp(&values[j].1)).unwrap();
    let [(x0, y0), (x1, y1), (x2, y2)] = [values[at - 1], values[at], values[at + 1]];
    let (fall, rise) = ((y1 - y0) / (x1 - x0), (y2 - y1) / (x2 - x1));
    let bend = (rise - fall) / (x2 - x0);
    let slope = (fall * (x2 - x1) + rise * (x1 - x0)) / (x2 - x0);
    (x1 - 0.5 * slope / bend, y1 - 0.25 * slope * slope / bend)
}

/// Runs `export` into a directory of the test and reads a file of it.
fn export(name: &str, arguments: &[&str]) -> impl Fn(&str) -> Grid + use<> {
    let out = directory(name);
    let output = wheelrail(&[&["export", "--out", out.to_str().unwrap()], &SMALL[..], arguments].concat());
    let messages = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && messages.contains("solver.response = full"), "{messages}");
    let index = fs::read_to_string(out.join("fields.vtm")).unwrap();
    move |block| {
        assert!(index.contains(&format!("file=\"{block}.vtu\"")), "{index}");
        Grid::read(&out.join(format!("{block}.vtu")))
    }
}

#[test]
fn exported_stress_without_friction_is_that_of_hertz() {
    let config = small();
    let (a, p0) = hertz(&config);
    let settings = ["--set", "rail.friction=0", "--set", "thermal.enabled=false"];
    let read = export("hertz", &[&settings[..], &["--creepage", "0"]].concat());
    let (wheel, rail) = (read("wheel"), read("rail"));
    assert_eq!(wheel.points.len(), wheel_mesh(&config).unwrap().nodes.len());
    assert_eq!(rail.points.len(), rail_mesh(&config).unwrap().nodes.len());
    let load = config.model.nominal_load / config.model.contact_width;
    for (grid, radius, name) in [(&wheel, config.wheel.radius, "wheel"), (&rail, f64::INFINITY, "rail")] {
        let stress = |field: &str, node: usize| grid.data[field][node];
        let axis = grid.axis(1e-9, 4.0 * a);
        let centre = axis[0].1;
        assert!(axis[0].0 < 1e-15, "{name}: the contact point is at the origin");
        assert_close(stress("sigma_yy", centre), -p0, 0.02, name);
        // Plane strain below a Hertzian contact: σ_x = −p0 ((a² + 2z²)/√(a² + z²)/a − 2z/a), σ_y = −p0 a/√(a² + z²)
        // (Johnson, 4.46).
        for &(z, node) in axis.iter().skip(1) {
            let root = a.hypot(z);
            let exact = [-p0 * ((a * a + 2.0 * z * z) / root - 2.0 * z) / a, -p0 * a / root];
            for (field, exact) in ["sigma_xx", "sigma_yy"].iter().zip(exact) {
                let found = stress(field, node);
                assert!((found - exact).abs() < 0.025 * p0, "{name} {field} at {} a: {found} against {exact}", z / a);
            }
            let sum = stress("sigma_xx", node) + stress("sigma_yy", node);
            assert_close(stress("sigma_zz", node), config.material.poissons_ratio * sum, 1e-12, "plane strain");
        }
        // Vertex of the parabola through the largest nodal value and its neighbours.
        let (depth, von_mises) = vertex(&axis.iter().map(|(z, n)| (*z, stress("von_mises", *n))).collect::<Vec<_>>());
        common::figure("exported.stress", &[von_mises / (0.558 * p0) - 1.0, depth / (0.704 * a) - 1.0]);
        println!("{name}: von Mises {:.4} p0 at {:.3} a", von_mises / p0, depth / a);
        assert_close(von_mises, 0.558 * p0, 0.02, "largest von Mises stress");
        assert_close(depth, 0.704 * a, 0.04, "its depth");
        let surface = grid.surface(radius, 1.5 * a);
        let pressed = grid.integral("sigma_yy", &surface);
        common::figure("exported.load", &[-pressed / load - 1.0]);
        println!("{name}: load {:.5}", -pressed / load);
        assert_close(pressed, -load, 0.015, name);
        assert!(grid.integral("sigma_xy", &surface).abs() < 0.01 * load, "{name} carries no shear");
    }
    // The displacement brings the surfaces together, and only there.
    let (above, below) = (wheel.surface(config.wheel.radius, 1.4 * a), rail.surface(f64::INFINITY, 1.4 * a));
    assert_eq!(above.len(), below.len());
    for ((x, w), (_, r)) in above.iter().zip(&below) {
        let height = |grid: &Grid, node: usize| grid.points[node][1] + grid.data["displacement"][3 * node + 1];
        let gap = height(&wheel, *w) - height(&rail, *r);
        let scale = a * a / (2.0 * config.wheel.radius);
        assert!(x.abs() > 0.9 * a || gap.abs() < 0.02 * scale, "gap {gap} at {} a", x / a);
        assert!(x.abs() < 1.2 * a || gap > 0.02 * scale, "gap {gap} at {} a", x / a);
    }
}

#[test]
fn exported_shear_velocity_and_temperature_agree_with_the_outputs() {
    let config = small();
    let (a, _) = hertz(&config);
    let point = ["--velocity", "13.9", "--creepage", "3e-4"];
    let read = export("braking", &point);
    let [wheel, rail, hot_wheel, hot_rail] = ["wheel", "rail", "wheel_temperature", "rail_temperature"].map(read);
    let full = ["--set", "solver.response=full"];
    let outputs = Table::parse(&succeed(&[&["steady"], &SMALL[..], &point, &full].concat()));
    let force = outputs.last("contact.force_x");
    let surfaces = [wheel.surface(config.wheel.radius, 1.5 * a), rail.surface(f64::INFINITY, 1.5 * a)];
    // The outward normal of the rail is +y: its shear stress is the traction that the wheel exerts on it.
    for (grid, surface) in [&wheel, &rail].into_iter().zip(&surfaces) {
        assert_close(grid.integral("sigma_xy", surface), -force, 0.03, "tangential force");
    }
    // Material flows to −x with the speed of the wheel; where it sticks, in the leading half, the surfaces move
    // together.
    let rigid = 3e-4 * 13.9;
    let velocity = |grid: &Grid, k: usize, body: usize| grid.data["velocity"][3 * surfaces[body][k].1];
    let (mut stuck, mut slipping) = (0, 0);
    for (k, (x, _)) in surfaces[1].iter().enumerate() {
        let slip = velocity(&wheel, k, 0) - velocity(&rail, k, 1);
        assert!((velocity(&rail, k, 1) + 13.9).abs() < 1e-2 * 13.9);
        if (0.2 * a..0.8 * a).contains(x) {
            assert!(slip.abs() < 0.05 * rigid, "slip {slip} of {rigid} m/s at {} a", x / a);
            stuck += 1;
        }
        if (-0.95 * a..-0.8 * a).contains(x) {
            assert!(slip > 0.3 * rigid, "slip {slip} of {rigid} m/s at {} a", x / a);
            slipping += 1;
        }
    }
    assert!(stuck >= 4 && slipping >= 1);
    for (grid, name) in [(&hot_wheel, "temperature.wheel_max"), (&hot_rail, "temperature.rail_max")] {
        let temperature = &grid.data["temperature"];
        let rise = temperature.iter().copied().fold(0.0, f64::max) - 293.0;
        assert_close(rise, outputs.last(name) - 293.0, 0.01, name);
        assert!(temperature.iter().all(|t| *t > 293.0 - 0.05 * rise), "nothing is colder than the reference");
    }
    // Area of the cells: the rail exactly, the wheel as the polygon it is.
    let area = |grid: &Grid| grid.cells.iter().map(|cell| grid.area(cell)).sum::<f64>();
    let circle = std::f64::consts::PI * (config.wheel.radius.powi(2) - config.wheel.hub_radius.powi(2));
    for (grid, exact, tolerance) in [
        (&rail, config.rail.length * config.rail.height, 1e-9),
        (&hot_rail, config.rail.length * config.rail.height, 1e-9),
        (&wheel, circle, 1e-3),
        (&hot_wheel, circle, 1e-2),
    ] {
        assert_close(area(grid), exact, tolerance, "area");
    }
}

#[test]
fn fields_after_a_scenario_are_those_of_its_end() {
    let ramp = file("transient", "time,drive.moment\n0,0\n0.002,-8000\n");
    let course = ["--scenario", &ramp, "--step", "5e-4", "--set", "solver.tolerance=0"];
    let rail = export("transient_fields", &course)("rail");
    let full = ["--set", "solver.response=full"];
    let outputs = Table::parse(&succeed(&[&["simulate"], &SMALL[..], &course, &full].concat()));
    let (a, _) = hertz(&small());
    let surface = rail.surface(f64::INFINITY, 1.5 * a);
    let force = outputs.last("contact.force_x");
    assert!(force < -1000.0, "{force} N");
    assert_close(rail.integral("sigma_xy", &surface), -force, 0.03, "tangential force");
    assert_close(rail.integral("sigma_yy", &surface), -outputs.last("contact.force_y"), 0.015, "normal force");
}
