//! Temperatures at the start are data: what is given, whatever heats the wheel later.

use crate::common::{self, model, preset};
use wheelrail::config::{Config, StartTemperature};
use wheelrail::simulation::{Inputs, Outputs, Rotation, Simulation, StepError, Translation, advice};

/// A railway wheel on a coarse mesh, with the heat of brake blocks on its tread.
fn railway(change: impl Fn(&mut Config)) -> Config {
    let mut config = preset("railway", 10);
    change(&mut config);
    config
}

fn start(config: &Config, change: impl Fn(&mut Inputs)) -> Result<Simulation, StepError> {
    let mut inputs = Inputs::rolling(config);
    change(&mut inputs);
    Simulation::new(model(config.clone()), &inputs)
}

/// Coldest and hottest temperature \[K] of tread and rail head in the contact.
fn extremes(outputs: &Outputs) -> [(f64, f64); 2] {
    [common::range(&outputs.profile_temperature_wheel), common::range(&outputs.profile_temperature_rail)]
}

/// Tread heat, block brakes, friction heat at full slip, hot wheels and cold rails in both directions, and standstill.
#[test]
fn every_start_has_the_given_temperatures_whatever_heats_and_brakes_it() {
    let held = |inputs: &mut Inputs, v: f64, omega: f64| {
        (inputs.rotation, inputs.translation) = (Rotation::Velocity, Translation::Velocity);
        (inputs.drive.velocity, inputs.drive.omega) = (v, omega);
    };
    for (excess, rail) in [(0.0, 293.0), (120.0, 293.0), (0.0, 263.0), (-30.0, 320.0)] {
        let config = railway(|c| (c.thermal.wheel_excess, c.brake.tread_share) = (excess, 0.9));
        let cases: [&dyn Fn(&mut Inputs); 6] = [
            &|_| (),
            &|i| i.drive.tread_heat = 45e3,
            &|i| i.drive.torque = 5e3,
            &|i| held(i, 19.44, 0.0),
            &|i| held(i, -19.44, -42.27),
            &|i| held(i, 0.0, 0.0),
        ];
        for (k, case) in cases.iter().enumerate() {
            let simulation = start(&config, |inputs| {
                inputs.drive.temperature = rail;
                case(inputs);
            });
            let outputs = simulation.unwrap_or_else(|error| panic!("{k}: {error}")).outputs().clone();
            let [wheel, head] = extremes(&outputs);
            let given = (293.0 + excess, rail);
            let error = [wheel.0 - given.0, wheel.1 - given.0, head.0 - given.1, head.1 - given.1];
            let more = [outputs.temperature_wheel_max - given.0, outputs.temperature_rail_max - given.1];
            assert!(error.iter().chain(&more).all(|e| e.abs() < 1e-9), "{excess} K, {rail} K, {k}: {error:?} {more:?}");
            // The hub is held at the reference, so that the innermost layer of the wheel is not as warm.
            assert!((outputs.temperature_wheel_bulk - given.0).abs() <= 0.01 * excess.abs());
            assert_eq!((outputs.heat_to_wheel, outputs.heat_to_rail), (0.0, 0.0));
        }
    }
}

/// Friction and radius of the start are those of the uniform temperatures: `1 − K (T − T_ref)` of the mean of both
/// surfaces, here half of the excess, and the growth of a ring that is warm throughout.
#[test]
fn friction_and_radius_at_the_start_are_those_of_the_given_temperatures() {
    let slides = |excess: f64| {
        let config = railway(|c| c.thermal.wheel_excess = excess);
        let outputs = start(&config, |i| {
            (i.rotation, i.translation, i.drive.omega) = (Rotation::Velocity, Translation::Velocity, 0.0);
        });
        (outputs.unwrap().outputs().clone(), config)
    };
    let (warm, config) = slides(120.0);
    let softening = config.tuning.softening;
    let expected = config.friction.coefficient * (1.0 - softening * 0.5 * 120.0);
    assert!((warm.friction / expected - 1.0).abs() < 1e-6, "{} for {expected}", warm.friction);
    let (cold, _) = slides(0.0);
    assert!((cold.friction / config.friction.coefficient - 1.0).abs() < 1e-9 && cold.thermal_growth == 0.0);
    let [least, most] = [0.5, 1.5].map(|share| share * config.material.expansion * 120.0 * config.wheel.radius);
    assert!((least..most).contains(&warm.thermal_growth), "{:e}", warm.thermal_growth);
}

/// With the temperatures of endless tread heat, 472 K for 10 kW, it would be 21 kN at the start in place of 2.2 kN.
#[test]
fn tread_heat_that_begins_with_the_run_grows_the_wheel_by_what_it_has_brought_so_far() {
    let config = railway(|_| ());
    let held = |heat: f64| {
        let change = |i: &mut Inputs| {
            (i.rotation, i.translation) = (Rotation::Velocity, Translation::Velocity);
            (i.drive.velocity, i.drive.omega, i.drive.tread_heat) = (19.44, 42.27, heat);
        };
        let mut inputs = Inputs::rolling(&config);
        change(&mut inputs);
        let mut simulation = start(&config, change).unwrap();
        let first = simulation.outputs().contact_force_x;
        for _ in 0..20 {
            simulation.advance(&inputs, 1e-3).unwrap();
        }
        (first, simulation.outputs().clone())
    };
    let [(cold, without), (first, with)] = [0.0, 45e3].map(held);
    assert_eq!(first, cold);
    // 900 J on the wheel of some 50 kJ/K.
    assert!(with.temperature_wheel_bulk - without.temperature_wheel_bulk < 0.1);
    assert!((with.contact_force_x - without.contact_force_x).abs() < 20.0);
}

/// No wheel at 70 km/h that carries 45 kW on its tread for ever brakes with 9 kN m.
#[test]
fn a_start_that_only_its_endless_heat_forbids_is_refused_by_that_and_found_without() {
    let endless = railway(|c| (c.initial.temperature, c.initial.velocity) = (StartTemperature::Stationary, 19.44));
    let mut inputs = Inputs::rolling(&endless);
    (inputs.drive.moment, inputs.drive.tread_heat) = (-9e3, 45e3);
    let error = Simulation::new(model(endless.clone()), &inputs).err().unwrap();
    let text = advice::failed_start(&error, &endless, &inputs);
    for words in ["initial.temperature = stationary", "drive.tread_heat = 45000 W", "uniform"] {
        assert!(text.contains(words), "{text}");
    }
    assert!(!text.contains("model.nominal_load") && !text.contains("initial.creepage"), "{text}");
    assert!(Simulation::new(model(railway(|c| c.initial.velocity = 19.44)), &inputs).is_ok());
}

#[test]
fn a_wheel_that_nothing_presses_down_is_refused_by_its_loads_alone() {
    let config = railway(|_| ());
    let mut inputs = Inputs::rolling(&config);
    (inputs.drive.load, inputs.drive.load_change) = (5e3, -5e3);
    let error = Simulation::new(model(config.clone()), &inputs).err().unwrap();
    let text = advice::failed_start(&error, &config, &inputs);
    assert!(
        text.contains("drive.load and drive.load_change") && text.contains("0 N") && !text.contains("creepage"),
        "{text}"
    );
}

/// Both starts come to the same temperatures of the contact, the uniform one in the time in which the wheel turns some
/// times: the flash lies over a wheel that hardly warms.
#[test]
fn the_flash_temperature_of_a_uniform_start_becomes_the_stationary_one() {
    let flash = |temperature: StartTemperature, steps: usize| {
        let config = railway(|c| c.initial.temperature = temperature);
        let mut inputs = Inputs::rolling(&config);
        (inputs.rotation, inputs.translation) = (Rotation::Velocity, Translation::Velocity);
        inputs.drive.omega *= 0.99;
        let mut simulation = Simulation::new(model(config), &inputs).unwrap();
        (0..steps).for_each(|_| simulation.advance(&inputs, 1e-3).unwrap());
        let outputs = simulation.outputs();
        outputs.temperature_rail_max - 0.5 * (outputs.temperature_wheel_bulk + 293.0)
    };
    let [uniform, stationary] = [flash(StartTemperature::Uniform, 20), flash(StartTemperature::Stationary, 0)];
    println!("flash {uniform:.1} K after 20 ms, stationary {stationary:.1} K");
    assert!((uniform / stationary - 1.0).abs() < 0.12);
}

/// Steel 700 K hotter bears a fifth of the pressure under which it yields cold. A start with the patch of cold steel would lose a tenth of
/// its load on a line and two fifths on an ellipse within the first millisecond.
#[test]
fn very_hot_wheels_start_with_a_patch_that_bears_their_load_or_are_refused_by_what_they_bear() {
    let of = |name: &str, excess: f64| {
        let mut config = common::shipped(name);
        (config.thermal.wheel_excess, config.initial.velocity) = (excess, 20.0);
        config
    };
    for (name, excess) in
        [("railway", 700.0), ("railway", 1000.0), ("railway_ellipse", 700.0), ("railway_ellipse", 800.0)]
    {
        let config = of(name, excess);
        let (mut run, inputs) = (start(&config, |_| ()).unwrap(), Inputs::rolling(&config));
        let before = run.outputs().contact_force_y;
        run.advance(&inputs, 1e-3).unwrap();
        let kept = run.outputs().contact_force_y / before;
        println!("{name}, {excess} K: {kept:.3} of the load after 1 ms");
        assert!((kept - 1.0).abs() < 0.05, "{name}, {excess} K: {kept}");
    }
    let config = of("railway_ellipse", 1000.0);
    let error = start(&config, |_| ()).err().unwrap();
    assert!(matches!(error, StepError::Softened { bears, pressure } if pressure > 5.0 * bears), "{error}");
    let text = advice::failed_start(&error, &config, &Inputs::rolling(&config));
    assert!(text.contains("bears 125 MPa") && text.contains("thermal.wheel_excess = 1000 K"), "{text}");
}
