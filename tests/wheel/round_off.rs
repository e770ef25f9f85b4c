//! Round-off stays round-off: a load that differs in its last digits gives outputs that differ in their last digits, at
//! every point of the profiles. No square root of a rounded zero, no switch that a last digit decides.

use crate::common::{model, shipped};
use wheelrail::simulation::{Inputs, Outputs, Simulation};

/// Largest difference allowed, relative to the largest value of the output in the run: ten times less than two systems
/// may differ by.
const BOUND: f64 = 1e-9;

/// Profiles and forces of a wheel that is braked beyond adhesion, slides and recovers, under a load with this factor.
fn braked(preset: &str, factor: f64) -> Vec<Vec<(&'static str, Vec<f64>)>> {
    let model = model(shipped(preset));
    let mut inputs = Inputs::rolling(model.config());
    let load = inputs.drive.load * factor;
    let seen = |o: &Outputs| {
        vec![
            ("contact.force_x", vec![o.contact_force_x]),
            ("contact.pressure_max", vec![o.contact_pressure_max]),
            ("profile.pressure", o.profile_pressure.clone()),
            ("profile.shear", o.profile_shear.clone()),
            ("profile.temperature_wheel", o.profile_temperature_wheel.clone()),
            ("profile.temperature_rail", o.profile_temperature_rail.clone()),
        ]
    };
    inputs.drive.load = load;
    let mut simulation = Simulation::new(model.clone(), &inputs).unwrap();
    let mut found = vec![seen(simulation.outputs())];
    for k in 0..400 {
        let applied = if (200..250).contains(&k) { 2.0 } else { (f64::from(k) / 100.0).min(1.0) };
        inputs.drive.moment = -9000.0 * applied;
        inputs.drive.load = load * (1.0 + 0.1 * libm::sin(0.05 * f64::from(k)));
        simulation.advance(&inputs, 1e-3).unwrap();
        found.push(seen(simulation.outputs()));
    }
    found
}

#[test]
fn outputs_differ_in_last_digits_where_the_load_does() {
    for preset in ["railway", "paper_d"] {
        let run = braked(preset, 1.0);
        for digits in [2.0, -3.0] {
            let other = braked(preset, 1.0 + digits * f64::EPSILON);
            for (output, (name, _)) in run[0].iter().enumerate() {
                let values = run.iter().flat_map(|seen| &seen[output].1);
                let largest = values.fold(0.0f64, |most, value| most.max(value.abs()));
                let pairs = run.iter().zip(&other).flat_map(|(a, b)| a[output].1.iter().zip(&b[output].1));
                let apart = pairs.fold(0.0f64, |most, (a, b)| most.max((a - b).abs())) / largest;
                println!("{preset} {name} {digits:+}: {apart:.1e}");
                assert!(largest > 0.0 && apart <= BOUND, "{preset} {name}: {apart:.1e} of {largest:.3e}");
            }
        }
    }
}
