//! Runs of the bench: what a link says happens, a link and a program repeat it, and the picture of the patch carries
//! the forces.

use bench::bench::{Bench, Reply};
use bench::frame;
use bench::patch_map::{GridSize, PatchMap, QUANTITIES, STATE, STATES};
use bench::rail::{AHEAD, Condition};
use bench::record::COLUMNS;
use bench::run::{Run, STEP};
use bench::settings::{Patch, Settings};
use serde_json::Value;
use wheelrail::simulation::{BasisStore, Inputs, Model, Simulation};

fn run(link: &str) -> Run {
    Run::start(Settings::from_link(link).unwrap(), &BasisStore::of_user()).unwrap()
}

fn steps(run: &mut Run, count: usize) {
    (0..count).for_each(|_| run.step().unwrap());
}

/// Rows of a table by column, the header apart.
fn columns(csv: &str) -> impl Fn(&str) -> Vec<f64> + use<> {
    let mut lines = csv.lines();
    let names: Vec<String> = lines.next().unwrap().split(',').map(str::to_owned).collect();
    let rows: Vec<Vec<f64>> = lines.map(|line| line.split(',').map(|text| text.parse().unwrap()).collect()).collect();
    move |name| {
        let column = names.iter().position(|other| other == name).unwrap();
        rows.iter().map(|row| row[column]).collect()
    }
}

#[test]
fn the_table_is_that_of_the_library() {
    let mut bench = run("patch=line&rail=wet&speed=72&load=90&torque=3");
    steps(&mut bench, 50);
    let column = columns(&bench.csv());

    let config = Settings::from_link("rail=wet&speed=72").unwrap().config().unwrap();
    let model = Model::prepare(config, &BasisStore::of_user(), &mut |_, _| {}).unwrap();
    let mut inputs = Inputs::rolling(model.config());
    inputs.drive.load = 90e3;
    let mut simulation = Simulation::new(model, &inputs).unwrap();
    inputs.drive.torque = 3e3;
    for k in 0..=50 {
        let outputs = simulation.outputs();
        assert_eq!(column("time")[k], k as f64 / 1000.0);
        assert_eq!(column("wheel.velocity")[k], outputs.wheel_velocity);
        assert_eq!(column("contact.force_x")[k], outputs.contact_force_x);
        assert_eq!(column("temperature.wheel_max")[k], outputs.temperature_wheel_max);
        simulation.advance(&inputs, STEP).unwrap();
    }
    assert!(column("contact.force_x")[50] < -3e3, "it brakes");
}

#[test]
fn a_wheel_locks_and_rolls_again_and_the_link_of_the_run_repeats_it_bit_for_bit() {
    let mut by_hand = run("patch=line&rail=leaves&speed=50&torque=0");
    steps(&mut by_hand, 10);
    by_hand.change("lock").unwrap();
    steps(&mut by_hand, 120);
    by_hand.change("load=80").unwrap();
    by_hand.change("hold").unwrap();
    steps(&mut by_hand, 20);
    by_hand.change("torque=1").unwrap();
    by_hand.change("release").unwrap();
    by_hand.change("coast").unwrap();
    by_hand.change("rail=dry").unwrap();
    steps(&mut by_hand, 500);
    let link = by_hand.link();
    assert_eq!(
        link,
        "patch=line&rail=leaves&speed=50&load=100&torque=0&at=10:lock&at=130:load=80&at=130:hold&at=150:torque=1\
         &at=150:release&at=150:coast&at=150:rail=dry"
    );

    let csv = by_hand.csv();
    let column = columns(&csv);
    let [omega, velocity] = ["wheel.omega", "wheel.velocity"].map(&column);
    assert!(omega[129].abs() < 1e-6, "the wheel stands: {} rad/s", omega[129]);
    assert!((velocity[149] - velocity[131]).abs() < 1e-9, "the speed is held");
    assert!(velocity[149] > velocity[649], "and let go");
    assert!(column("contact.creepage")[649].abs() < 0.01, "it rolls again");
    let (distance, friction) = (column("wheel.distance"), column("contact.friction"));
    let begin = distance[150] + AHEAD;
    let arrived = distance.iter().position(|place| *place >= begin).unwrap();
    let [leaves, dry] = [Condition::Leaves, Condition::Dry].map(|rail| rail.friction().unwrap().coefficient);
    assert!(friction[..=arrived].iter().all(|friction| *friction <= leaves));
    assert!(friction[arrived + 1] > leaves && friction[649] > 0.8 * dry, "the dry rail has come");

    let mut again = run(&link);
    steps(&mut again, 650);
    assert_eq!(again.csv(), csv);
    assert_eq!((again.link(), again.log()), (link, by_hand.log()));
}

#[test]
fn a_change_by_hand_takes_the_place_of_what_the_link_has_still_to_come() {
    let mut taken_over = run("torque=0&at=2:torque=1&at=5:lock");
    steps(&mut taken_over, 3);
    assert!(taken_over.link().ends_with("torque=0&at=2:torque=1&at=5:lock"));
    taken_over.change("torque=2").unwrap();
    steps(&mut taken_over, 5);
    assert!(!taken_over.locked() && taken_over.torque() == 2e3);
    assert!(taken_over.link().ends_with("torque=0&at=2:torque=1&at=3:torque=2"), "{}", taken_over.link());
    for text in ["", "jump", "torque=1e9", "torque", "rail=ice", "at=5:lock"] {
        assert!(taken_over.change(text).is_err(), "{text}");
    }
    assert!(taken_over.link().ends_with("at=3:torque=2"), "a refused change is none");
}

#[test]
fn the_picture_of_the_patch_carries_load_and_brake_force() {
    // Between its nodes a profile is straight; between lines the peak of shear, where slip turns to stick, is smeared; and the
    // outermost rows of S1002, which bear load on all of their width, taper to the edge.
    let bounds = [(Patch::Line, [1e-2, 0.03]), (Patch::Ellipse, [1e-2, 0.03]), (Patch::S1002, [0.06, 0.07])];
    for (patch, bounds) in bounds {
        let mut bench = run(&format!("patch={}&torque=4", patch.name()));
        steps(&mut bench, 40);
        let (state, outputs) = (bench.simulation().state().clone(), bench.outputs().clone());
        let map = PatchMap::new(&state, &outputs, patch, 293.15);
        let [low, high] = map.ends();
        let (size, x) = (
            GridSize { along: 400, across: if patch == Patch::Line { 1 } else { 200 } },
            1.2 * outputs.contact_half_width,
        );
        let mut values = Vec::new();
        map.fill(size, [[-x, x], [low, high]], &mut values);
        let cells = size.along * size.across;
        let area = 2.0 * x * (high - low) / cells as f64;
        let force = |quantity: usize| area * values[quantity * cells..][..cells].iter().sum::<f64>();
        let found = [force(0) / outputs.contact_force_y - 1.0, force(1) / outputs.contact_force_x - 1.0];
        println!("{patch:?}: load and brake force of the picture are off by {:.1e} and {:.1e}", found[0], found[1]);
        assert!(found.iter().zip(bounds).all(|(off, bound)| off.abs() < bound), "{found:?}");
        let sticks = values[STATE * cells..][..cells].iter().filter(|state| **state == STATES[1]).count() as f64;
        let touches = values[STATE * cells..][..cells].iter().filter(|state| **state != STATES[0]).count() as f64;
        println!("sticks on {:.3}, {:.3} by the output", sticks / touches, outputs.contact_stick_fraction);
        assert!((sticks / touches - outputs.contact_stick_fraction).abs() < 0.05);
    }
}

#[test]
fn the_picture_of_an_ellipse_has_the_pressure_of_hertz() {
    let mut bench = run("patch=ellipse&torque=0");
    let (state, outputs) = (bench.simulation().state().clone(), bench.outputs().clone());
    let map = PatchMap::new(&state, &outputs, Patch::Ellipse, 293.15);
    let (a, b) = (outputs.contact_half_width, 0.5 * outputs.contact_width);
    let peak = 1.5 * outputs.contact_force_y / (std::f64::consts::PI * a * b);
    let (size, mut values) = (GridSize { along: 61, across: 31 }, Vec::new());
    map.fill(size, [[-a, a], [-b, b]], &mut values);
    let mut worst = 0.0_f64;
    for row in 0..size.across {
        for column in 0..size.along {
            let at = |k: usize, n: usize| 2.0 * (k as f64 + 0.5) / n as f64 - 1.0;
            let rest = 1.0 - at(column, size.along).powi(2) - at(row, size.across).powi(2);
            let exact = peak * rest.max(0.0).sqrt();
            worst = worst.max((values[row * size.along + column] - exact).abs() / peak);
        }
    }
    println!("largest difference from Hertz: {worst:.1e} of the peak");
    assert!(worst < 0.05, "{worst}");
    let mut ends = Vec::new();
    map.outline(size.across, [-b, b], &mut ends);
    for (row, [rear, front]) in (0..size.across).map(|row| (row, [ends[row], ends[size.across + row]])) {
        let exact = a * (1.0 - (2.0 * (row as f64 + 0.5) / size.across as f64 - 1.0).powi(2)).sqrt();
        assert!((front - exact).abs() < 0.02 * a && (rear + exact).abs() < 0.02 * a, "{rear} {front} {exact}");
    }
}

#[test]
fn a_wheel_turned_to_the_right_is_pushed_to_the_right_and_the_picture_carries_that_force() {
    let mut bench = run("patch=ellipse&torque=4&angle=2");
    steps(&mut bench, 30);
    let (state, outputs) = (bench.simulation().state().clone(), bench.outputs().clone());
    assert!((outputs.contact_lateral_creepage + 2e-3).abs() < 1e-4, "{}", outputs.contact_lateral_creepage);
    assert!(outputs.contact_force_z > 5e3, "it slides to the left: {} N", outputs.contact_force_z);
    let map = PatchMap::new(&state, &outputs, Patch::Ellipse, 293.15);
    let ([low, high], x) = (map.ends(), 1.1 * outputs.contact_half_width);
    let (size, mut values) = (GridSize { along: 200, across: 200 }, Vec::new());
    map.fill(size, [[-x, x], [low, high]], &mut values);
    let cells = size.along * size.across;
    let force = 2.0 * x * (high - low) / cells as f64 * values[2 * cells..][..cells].iter().sum::<f64>();
    let states = &values[STATE * cells..][..cells];
    let count = |of: f64| states.iter().filter(|state| **state == of).count() as f64;
    let sticks = count(STATES[1]) / (count(STATES[1]) + count(STATES[2]));
    println!("sticks on {sticks:.3}, {:.3} by the output", outputs.contact_stick_fraction);
    assert!((sticks - outputs.contact_stick_fraction).abs() < 0.05);
    println!("lateral force of the picture is off by {:.1e}", force / outputs.contact_force_z - 1.0);
    assert!((force / outputs.contact_force_z - 1.0).abs() < 0.01);
}

#[test]
fn a_turned_wheel_that_locks_slides_on_when_its_steel_melts() {
    let mut bench = run("patch=ellipse&rail=wet&speed=80&torque=3&angle=4&at=5:lock");
    steps(&mut bench, 200);
    let outputs = bench.outputs();
    let turned = outputs.contact_force_z / outputs.contact_force_x;
    println!("{:.0} K, force turned by {turned:.5}", outputs.temperature_wheel_max);
    assert!(outputs.temperature_wheel_max > 1400.0, "its steel stays cold");
    assert!((turned + 4e-3).abs() < 1e-4, "the slide turns into the direction of the slip");
}

#[test]
fn a_frame_is_as_long_as_its_description_says_and_its_columns_are_those_of_the_table() {
    for patch in Patch::ALL {
        let mut bench = Bench::with_store(BasisStore::of_user());
        let Ok(Reply::Text(text)) = bench.with(&format!("patch={}", patch.name()), Bench::start) else { panic!() };
        let told: Value = serde_json::from_str(&text).unwrap();
        assert_eq!(told, frame::description(patch));
        let count = |path: &str| told.pointer(path).unwrap().as_u64().unwrap() as usize;
        let length = |path: &str| told.pointer(path).unwrap().as_array().unwrap().len();
        assert_eq!([length("/columns"), length("/map/quantities")], [COLUMNS.len(), QUANTITIES.len()]);
        let expected = length("/columns")
            + length("/status")
            + 2 * count("/stretches")
            + length("/map/quantities") * count("/map/along") * count("/map/across")
            + length("/map/outline") * count("/map/across")
            + length("/depth/quantities") * count("/depth/points");
        bench.step(3).unwrap();
        let Ok(Reply::Numbers(numbers)) = bench.frame() else { panic!() };
        assert_eq!(numbers.len(), expected);
        let Ok(Reply::Text(csv)) = bench.text(|run| Ok(run.csv())) else { panic!() };
        let last: Vec<f64> = csv.lines().last().unwrap().split(',').map(|text| text.parse().unwrap()).collect();
        assert_eq!(numbers[..COLUMNS.len()], last[1..]);
        assert!(numbers.iter().all(|number| number.is_finite()));
    }
}

#[test]
fn a_bench_without_a_run_says_so_and_a_refused_start_leaves_the_run_before() {
    let mut bench = Bench::with_store(BasisStore::of_user());
    for refused in [bench.frame(), bench.step(1), bench.text(|run| Ok(run.link()))] {
        assert_eq!(refused.unwrap_err(), "no run has been started");
    }
    bench.with("speed=30", Bench::start).unwrap();
    assert!(bench.with("speed=-3", Bench::start).unwrap_err().contains("1 to 250 km/h"));
    assert!(bench.with("not a basis", Bench::hold_basis).unwrap_err().contains("not a basis"));
    let Ok(Reply::Text(link)) = bench.text(|run| Ok(run.link())) else { panic!() };
    assert_eq!(link, "patch=line&rail=dry&speed=30&load=100&torque=2");
}

#[test]
fn a_start_takes_the_basis_that_was_handed_over() {
    let config = Settings::default().config().unwrap();
    let model = Model::prepare(config, &BasisStore::of_user(), &mut |_, _| {}).unwrap();
    let (name, bytes) = model.basis_file().unwrap();
    let mut bench = Bench::default();
    bench.input = bytes;
    assert_eq!(bench.hold_basis(), Ok(Reply::Text(name.clone())));
    assert_eq!(bench.with("", |bench| bench.basis_name()), Ok(Reply::Text(name)));
    bench.with("", Bench::start).unwrap();
}
