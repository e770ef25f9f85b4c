//! Wear that changes the wheel: what is taken off is what the wear rate says, it stays on the material, it makes a flat
//! of a slide, and the profile that is left can be loaded again.

use crate::common::{self, model, prescribed, preset};
use std::path::Path;
use std::sync::Arc;
use wheelrail::config::{Config, Wear};
use wheelrail::fmi::instance::{Instance, simulation};
use wheelrail::fmi::log::{CallError, Log};
use wheelrail::fmi::v2::variables::variables;
use wheelrail::fmi::variable::Value;
use wheelrail::simulation::{Inputs, Model, Outputs, Simulation};

/// A cold wheel with wear.
fn wearing(elements: usize) -> Config {
    let mut config = preset("railway", elements);
    config.thermal.enabled = false;
    config.tuning.tolerance = 0.0;
    config.damage.wear = Wear::TGamma;
    config
}

fn run(simulation: &mut Simulation, inputs: &Inputs, step: f64, steps: usize) -> Vec<Outputs> {
    let mut advance = || {
        simulation.advance(inputs, step).unwrap();
        simulation.outputs().clone()
    };
    (0..steps).map(|_| advance()).collect()
}

/// Mass of what is missing on the tread [kg].
fn missing(simulation: &Simulation) -> f64 {
    let config = simulation.model().config();
    simulation.state().lines[0].flattening[0].worn().volume() * config.material.density * config.model.contact_width
}

/// Mild and severe creepage forwards and backwards, several turns in long steps, and a slide.
#[test]
fn the_volume_taken_off_is_the_integrated_wear_rate() {
    for (velocity, creepage, step, steps) in
        [(20.0, 1e-3, 1e-3, 150), (-20.0, -0.02, 2.5e-4, 200), (40.0, 5e-3, 0.02, 60), (5.0, 2.0, 1e-3, 50)]
    {
        let model = model(wearing(6));
        let mut inputs = prescribed(&model, velocity, creepage);
        if creepage == 2.0 {
            inputs.drive.omega = 0.0;
        }
        let mut simulation = Simulation::new(model, &inputs).unwrap();
        let outputs = run(&mut simulation, &inputs, step, steps);
        let rate: f64 = outputs.iter().map(|o| o.wear_rate * o.wheel_velocity.abs() * step).sum();
        let last = &outputs[steps - 1];
        let (mass, store) = (last.worn_mass, missing(&simulation));
        common::round_off("wear.volume", &[store / mass - 1.0], 1e-11);
        common::round_off("wear.rate", &[rate / mass - 1.0], 1e-8);
        println!(
            "{velocity} m/s, creepage {creepage}: rate {rate:.6e} kg, worn {mass:.6e} kg, missing {store:.6e} kg, depth {:.3e} m",
            last.worn_depth
        );
        assert!(mass > 0.0 && (store / mass - 1.0).abs() < 1e-12, "{store} {mass}");
        assert!((rate / mass - 1.0).abs() < 1e-9 && last.worn_depth_rail == 0.0, "{rate} {mass}");
        // A wheel that has turned round is worn evenly.
        if step * steps as f64 * velocity.abs() > 10.0 {
            let even = store / (7850.0 * 0.014 * std::f64::consts::TAU * 0.46);
            assert!((last.worn_depth / even - 1.0).abs() < 0.1, "{} {even}", last.worn_depth);
        }
    }
}

#[test]
fn a_worn_state_returns_bit_for_bit_and_no_wear_changes_nothing() {
    let worn = model(wearing(6));
    let inputs = prescribed(&worn, 20.0, 0.02);
    let mut simulation = Simulation::new(worn.clone(), &inputs).unwrap();
    run(&mut simulation, &inputs, 5e-4, 20);
    let saved = simulation.checkpoint().clone();
    let first = run(&mut simulation, &inputs, 5e-4, 20);
    let state = simulation.state().clone();
    simulation.recall(saved.clone()).unwrap();
    assert_eq!(run(&mut simulation, &inputs, 5e-4, 20), first);
    assert!(*simulation.state() == state);
    let mut other = Simulation::resume(worn.clone(), worn.config().tuning.clone(), saved).unwrap();
    assert_eq!(run(&mut other, &inputs, 5e-4, 20), first);
    // Without wear, and with a law that takes nothing.
    let others = [|c: &mut Config| c.damage.wear = Wear::Off, |c: &mut Config| c.damage.wear_factor = 0.0];
    let [off, none] = others.map(|change| {
        let mut config = wearing(6);
        change(&mut config);
        let model = model(config);
        let mut simulation = Simulation::new(model, &inputs).unwrap();
        let outputs = run(&mut simulation, &inputs, 5e-4, 40);
        outputs.into_iter().map(|o| Outputs { wear_rate: 0.0, ..o }).collect::<Vec<_>>()
    });
    assert!(off == none && first[19].worn_mass > 0.0 && off[39].worn_mass == 0.0);
    assert!((first[19].contact_force_x / off[39].contact_force_x - 1.0).abs() < 1e-3);
}

/// A wheel after its slide, and what it was given.
type Slide = (Simulation, Inputs);

/// A wheel that slides 2 m with wear eight times as fast as that of the tests, so that it grinds a flat.
fn slide(elements: usize, step: f64) -> Slide {
    let mut config = wearing(elements);
    config.damage.wear_factor = 8.0;
    config.tuning.max_step = step;
    config.physics.yielding = false;
    let model = model(config);
    let mut inputs = prescribed(&model, 10.0, 0.0);
    inputs.drive.friction = 0.1;
    let mut simulation = Simulation::new(model, &inputs).unwrap();
    let rolling = inputs.drive.omega;
    let count = (0.01 / step).round() as usize;
    for k in 1..=count {
        inputs.drive.omega = rolling * (1.0 - k as f64 / count as f64);
        simulation.advance(&inputs, step).unwrap();
    }
    run(&mut simulation, &inputs, step, (0.2 / step).round() as usize);
    (simulation, inputs)
}

/// Archard's sum: the whole contact wears by the same depth. Shorter steps and finer meshes give the same flat, and
/// what the pressure does on the way of the steel that is gone is accounted for.
#[test]
fn a_slide_grinds_a_flat_that_does_not_depend_on_the_steps() {
    let found = [(6, 1e-3), (6, 2.5e-4), (12, 1e-3)].map(|(elements, step)| {
        let (simulation, _) = slide(elements, step);
        let (o, store) = (simulation.outputs().clone(), missing(&simulation));
        assert!((store / o.worn_mass - 1.0).abs() < 1e-12);
        let lost = o.hub_work - o.stored_energy - o.damping_energy - o.friction_energy;
        common::figure("wear.residual", &[o.energy_residual]);
        println!(
            "{elements} elements, {step} s: {:.2} um deep, contact half-width {:.2} mm, peak pressure {:.1} MPa, work {:.4} J of \
             {:.4} J, residual {:.1e}",
            1e6 * o.worn_depth,
            1e3 * o.contact_half_width,
            1e-6 * o.contact_pressure_max,
            o.plastic_energy,
            lost,
            o.energy_residual
        );
        assert!(o.energy_residual.abs() < 1e-3);
        [o.worn_depth, o.contact_half_width, o.worn_mass, o.contact_approach]
    });
    common::figure_within(0.01, "wear.depth [µm]", &found.map(|[depth, ..]| 1e6 * depth));
    for other in &found[1..] {
        for (quantity, (value, reference)) in other.iter().zip(&found[0]).enumerate() {
            // The edges lie between nodes: by less than one spacing on either side.
            assert!(
                (value / reference - 1.0).abs() < [0.02, 0.06, 0.02, 0.02][quantity],
                "{quantity}: {value} {reference}"
            );
        }
    }
}

/// Largest force [N] while the wheel rolls on by `way` at 10 m/s.
fn strike(simulation: &mut Simulation, inputs: &mut Inputs, way: f64) -> f64 {
    inputs.drive.omega = inputs.drive.velocity / simulation.model().config().wheel.radius;
    inputs.drive.friction = 0.0;
    let outputs = run(simulation, inputs, 1e-4, (way / 1e-3) as usize);
    outputs.iter().map(|o| o.contact_force_max).fold(0.0, f64::max)
}

/// Slide, flat, and the force of rolling on it: from the run itself, and from the file that it leaves.
#[test]
fn a_flat_from_a_slide_strikes_and_does_so_from_its_file() {
    let (mut simulation, mut inputs) = slide(6, 1e-3);
    // A place that is far from the flat now, so that the wheel has come to rest on round tread before it strikes.
    let flat = simulation.state().place(0.46)[0];
    let depth = simulation.outputs().worn_depth;
    strike(&mut simulation, &mut inputs, 1.5);
    let force = strike(&mut simulation, &mut inputs, 1.6);
    let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join("flat_from_a_slide.csv");
    std::fs::write(&file, simulation.wheel_profile_file()).unwrap();
    let loaded = |text: String| -> Arc<Model> {
        let mut config = wearing(6);
        (config.damage.wear, config.physics.yielding) = (Wear::Off, false);
        config.wheel.profile = text;
        model(config)
    };
    let model = loaded(format!("file({:?}, position = {:?})", file.to_str().unwrap(), 1.5 - flat));
    let mut again = Simulation::new(model, &inputs).unwrap();
    let strike_again = strike(&mut again, &mut inputs, 2.0);
    common::figure("wear.file", &[strike_again / force - 1.0]);
    common::figure_within(0.01, "wear.strike [kN]", &[1e-3 * force, 1e-3 * strike_again]);
    println!(
        "flat of {:.1} um at {flat:.4} m: {force:.0} N from the run, {strike_again:.0} N from its file",
        1e6 * depth
    );
    assert!(depth > 5e-5 && force > 1.2e5, "{depth} {force}");
    assert!((strike_again / force - 1.0).abs() < 0.02, "{strike_again} {force}");
    // Written and read again the file stays what it is.
    let bare = loaded(file.to_str().unwrap().to_owned());
    inputs.drive.load = 1e5;
    let copy = Simulation::new(bare, &inputs).unwrap().wheel_profile();
    let first = simulation.wheel_profile();
    let error = copy.iter().map(|[s, height]| (height - at(&first, *s)).abs()).fold(0.0, f64::max);
    println!("{} samples, copy within {error:.1e} m", first.len());
    assert!(error < 1e-12, "{error}");
}

/// Height of samples at a position, linear between them.
fn at(samples: &[[f64; 2]], s: f64) -> f64 {
    let next = samples.partition_point(|sample| sample[0] <= s).clamp(1, samples.len() - 1);
    let [a, b] = [samples[next - 1], samples[next]];
    a[1] + (b[1] - a[1]) * ((s - a[0]) / (b[0] - a[0])).clamp(0.0, 1.0)
}

/// Length and depth of the flat that one reads off the file of a profile: the stretch around its lowest sample that lies
/// more than a micrometre below the round tread.
fn read_off(text: &str) -> [f64; 2] {
    let number = |cell: &str| cell.parse::<f64>().unwrap();
    let rows = text.lines().skip(1).map(|line| line.split_once(',').unwrap());
    let turn = std::f64::consts::TAU * 0.46;
    let once: Vec<[f64; 2]> = rows.map(|(s, height)| [number(s), number(height)]).collect();
    // A flat may lie where the file ends and begins.
    let tread: Vec<_> = [-turn, 0.0, turn].iter().flat_map(|by| once.iter().map(move |[s, h]| [s + by, *h])).collect();
    let of_height = |k: &usize, j: &usize| tread[*k][1].total_cmp(&tread[*j][1]);
    let lowest = (once.len()..2 * once.len()).min_by(of_height).unwrap();
    let crossing =
        |[out, within]: [[f64; 2]; 2]| out[0] + (within[0] - out[0]) * (-1e-6 - out[1]) / (within[1] - out[1]);
    let first = (0..lowest).rev().find(|&k| tread[k][1] >= -1e-6).unwrap();
    let last = (lowest..tread.len()).find(|&k| tread[k][1] >= -1e-6).unwrap();
    let ends = [[tread[first], tread[first + 1]], [tread[last], tread[last - 1]]].map(crossing);
    [ends[1] - ends[0], -tread[lowest][1]]
}

/// A wheel that yields, locked at 60 km/h for 0.4 s.
fn soften(name: &str) -> Slide {
    let model = model(preset(name, 6));
    let mut inputs = prescribed(&model, 60.0 / 3.6, 0.0);
    let mut simulation = Simulation::new(model, &inputs).unwrap();
    inputs.drive.omega = 0.0;
    run(&mut simulation, &inputs, 2e-3, 200);
    (simulation, inputs)
}

/// Locked wheels get a flat by wear, and by yielding of hot steel on a line and on the middle line of a patch. Its
/// length is what one reads off the profile that is saved, within the distance of samples there, and stays when the wheel rolls on.
#[test]
fn the_flat_of_a_locked_wheel_is_as_long_as_its_saved_profile_shows() {
    let slides = [slide(6, 1e-3), soften("railway"), soften("railway_ellipse")];
    for (case, (mut simulation, mut inputs)) in ["worn", "soft", "patch"].into_iter().zip(slides) {
        let outputs = simulation.outputs().clone();
        let contact = 2.0 * outputs.contact_half_width;
        let [length, depth] = read_off(&simulation.wheel_profile_file());
        common::figure_within(0.02, &format!("wear.length.{case} [mm]"), &[1e3 * outputs.flat_length, 1e3 * length]);
        println!(
            "{case}: flat of {:.2} mm, {:.2} um deep; saved profile {:.2} mm, {:.2} um; contact {:.2} mm",
            1e3 * outputs.flat_length,
            1e6 * outputs.flat_depth,
            1e3 * length,
            1e6 * depth,
            1e3 * contact,
        );
        let spacing = contact / 6.0;
        common::figure(&format!("wear.flat.{case}"), &[(outputs.flat_length - length) / spacing]);
        assert!((outputs.flat_length - length).abs() < spacing, "{case}");
        assert!((outputs.flat_depth / depth - 1.0).abs() < 0.05, "{case}");
        assert!(outputs.flat_depth > (1.0 - 1e-12) * outputs.worn_depth.max(outputs.flattening), "{case}");
        // Steel yields in a part of the contact; beyond it lies what the wheel wore while it came to rest, on 50 mm.
        assert!((0.5..1.5).contains(&(outputs.flat_length / contact)), "{case}");
        inputs.drive.omega = inputs.drive.velocity / 0.46;
        inputs.drive.friction = 0.0;
        run(&mut simulation, &inputs, 1e-3, 30);
        let rolled = simulation.outputs();
        // Read off between nodes a sixth of the contact apart.
        assert!((rolled.flat_length / outputs.flat_length - 1.0).abs() < 0.03, "{case}: {}", rolled.flat_length);
    }
}

/// A chord as the text of a profile and as its file: the chord formula `L = √(8 r d)`, less what lies above a
/// micrometre, `√(1 − 1 µm/d)`.
#[test]
fn an_imposed_chord_has_the_length_of_the_chord() {
    let (length, radius) = (0.04, 0.46);
    let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join("chord.csv");
    let height = |s: f64| -(length * length / 4.0 - s * s).max(0.0) / (2.0 * radius);
    let rows = (0..=400).map(|k| 1.0 + 1e-4 * f64::from(k - 200));
    let text: String = rows.map(|s| format!("{s},{}\n", height(s - 1.0))).collect();
    std::fs::write(&file, format!("position,height\n{text}")).unwrap();
    for profile in [format!("flat(length = {length}, position = 1)"), file.to_str().unwrap().to_owned()] {
        let mut config = wearing(6);
        config.wheel.profile = profile;
        let model = model(config);
        let inputs = prescribed(&model, 10.0, 0.0);
        let simulation = Simulation::new(model, &inputs).unwrap();
        let outputs = simulation.outputs();
        let chord = (8.0 * radius * outputs.flat_depth).sqrt();
        let expected = length * (1.0 - 1e-6 / outputs.flat_depth).sqrt();
        common::figure("wear.chord", &[outputs.flat_length / expected - 1.0]);
        println!("flat of {:.4} mm, chord of its depth {:.4} mm", 1e3 * outputs.flat_length, 1e3 * chord);
        assert!((chord / length - 1.0).abs() < 1e-3 && (outputs.flat_length / expected - 1.0).abs() < 1e-3);
        let [saved, _] = read_off(&simulation.wheel_profile_file());
        let spacing = outputs.contact_half_width / 3.0;
        assert!((saved - outputs.flat_length).abs() < 2.0 * spacing, "{saved}");
    }
}

/// A wheel that spins on the spot burns a hollow into the rail, which a rolling one does not.
#[test]
fn a_wheel_that_spins_on_the_spot_wears_the_rail_as_well() {
    let mut config = wearing(6);
    config.initial.velocity = 0.0;
    let model = model(config);
    let mut inputs = prescribed(&model, 0.0, 0.0);
    inputs.drive.omega = 4.0;
    let mut simulation = Simulation::new(model, &inputs).unwrap();
    run(&mut simulation, &inputs, 1e-3, 100);
    let outputs = simulation.outputs();
    let rail = simulation.state().lines[0].flattening[1].worn().volume() * 7850.0 * 0.014;
    println!("wheel {:.3e} kg, rail {rail:.3e} kg, {:.3e} m deep", outputs.worn_mass, outputs.worn_depth_rail);
    assert!((rail / outputs.worn_mass - 1.0).abs() < 1e-12 && outputs.worn_depth_rail > 5.0 * outputs.worn_depth);
}

/// The FMU writes the profile when it is terminated, and reads it as that of another run; what could not be written is
/// refused before the run.
#[test]
fn the_fmu_saves_the_profile_of_its_wheel_and_loads_it() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let path = folder.join("saved_by_the_fmu.csv");
    let start = |settings: &[(&str, Value)]| -> Result<Instance, CallError> {
        let mut instance = Instance::new(None, Log::new(Box::new(|_, _, _| {}), false))?;
        let small = [("mesh.elements_per_half_width", Value::Integer(6)), ("thermal.enabled", Value::Boolean(false))];
        for (name, value) in small.iter().chain(settings) {
            let variable = variables().iter().find(|variable| variable.name == *name).unwrap();
            instance.set(&[variable.reference], vec![value.clone()])?;
        }
        let model = model(instance.slave().config().clone());
        instance.parts().0.offer_model(model);
        instance.enter_initialization()?;
        instance.exit_initialization()?;
        Ok(instance)
    };
    let text = |path: &Path| Value::String(path.to_str().unwrap().to_owned());
    let settings = [
        ("damage.wear", Value::Integer(2)),
        ("wheel.profile", Value::String("flat(length = 0.02, position = 1)".to_owned())),
        ("wheel.profile_save", text(&path)),
        ("initial.creepage", Value::Real(0.01)),
    ];
    let mut first = start(&settings).unwrap();
    for k in 0..20 {
        first.do_step(1e-3 * f64::from(k), 1e-3).unwrap();
    }
    std::fs::remove_file(&path).ok();
    first.terminate().unwrap();
    let left = simulation(&mut first).unwrap().wheel_profile();
    assert!(left.iter().any(|sample| sample[1] < -1e-4) && left.iter().any(|s| s[1] < 0.0 && s[1] > -1e-7));
    let mut second = start(&[("wheel.profile", text(&path))]).unwrap();
    assert_eq!(simulation(&mut second).unwrap().wheel_profile().len(), left.len());
    for [s, height] in simulation(&mut second).unwrap().wheel_profile() {
        assert!((height - at(&left, s)).abs() < 1e-15, "{s} {height}");
    }
    for (name, words) in [("profile.txt", "must end in .csv"), ("nowhere/profile.csv", "folder that exists")] {
        let refusal = start(&[("wheel.profile_save", text(&folder.join(name)))]).err().unwrap().message;
        assert!(refusal.contains("wheel.profile_save = ") && refusal.contains(words), "{refusal}");
    }
}

#[test]
fn wear_that_makes_no_sense_is_refused_by_name() {
    let refused = |change: fn(&mut Config), words: &[&str]| {
        let mut config = wearing(6);
        change(&mut config);
        let message = config.validate().unwrap_err().to_string();
        assert!(words.iter().all(|word| message.contains(word)), "{message}");
    };
    refused(|c| c.damage.wear_factor = -1.0, &["damage.wear_factor = -1"]);
}
