//! Symmetries of the equations, as properties over random runs: they hold for any parameters, on any mesh.

use crate::common::{self, model, prescribed, preset};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use std::sync::{Arc, OnceLock};
use wheelrail::config::Config;
use wheelrail::simulation::{BasisStore, Inputs, Model, Outputs, Rotation, Simulation, Translation};

/// A coarse mesh and few modes: the symmetries do not care.
fn coarse() -> Config {
    let mut config = preset("railway", 6);
    (config.solver.modes_wheel, config.solver.modes_rail) = (10, 6);
    // Undivided steps, so that two runs show every change of solver.
    config.tuning.tolerance = 0.0;
    config
}

/// Limit of the mirrored runs; ten times as much where it is not a mean that is compared.
const MIRROR: f64 = 1e-8;

fn few(cases: u32) -> ProptestConfig {
    ProptestConfig { cases, rng_seed: RngSeed::Fixed(9), failure_persistence: None, ..ProptestConfig::default() }
}

/// Starts from stationary rolling and goes on under a moment and a force; outputs after the start and each step.
fn drive(model: &Arc<Model>, start: &Inputs, moment: f64, force: f64, dt: f64) -> Vec<Outputs> {
    let mut inputs = *start;
    let mut simulation = Simulation::new(model.clone(), &inputs).unwrap();
    (inputs.rotation, inputs.translation) = (Rotation::Moment, Translation::Force);
    (inputs.drive.moment, inputs.drive.force) = (moment, force);
    let mut seen = vec![simulation.outputs().clone()];
    for _ in 0..8 {
        simulation.advance(&inputs, dt).unwrap();
        seen.push(simulation.outputs().clone());
    }
    seen
}

/// An output with its name.
type Output = (&'static str, fn(&Outputs) -> f64);

/// Horizontal forces, moments and velocities: they change their sign with the direction of travel.
const DIRECTED: [Output; 9] = [
    ("contact force x", |o| o.contact_force_x),
    ("contact moment", |o| o.contact_moment),
    ("velocity", |o| o.wheel_velocity),
    ("angular velocity", |o| o.wheel_omega),
    ("distance", |o| o.wheel_distance),
    ("angle", |o| o.wheel_angle),
    ("hub force x", |o| o.hub_force_x),
    ("hub moment", |o| o.hub_moment),
    ("slip velocity", |o| o.contact_slip_velocity),
];

/// Outputs that do not know the direction of travel.
const UNDIRECTED: [Output; 11] = [
    ("contact force y", |o| o.contact_force_y),
    ("creepage", |o| o.contact_creepage),
    ("half-width", |o| o.contact_half_width),
    ("peak pressure", |o| o.contact_pressure_max),
    ("stick fraction", |o| o.contact_stick_fraction),
    ("approach", |o| o.contact_approach),
    ("friction power", |o| o.friction_power),
    ("wheel temperature", |o| o.temperature_wheel_max),
    ("rail temperature", |o| o.temperature_rail_max),
    ("heat to the wheel", |o| o.heat_to_wheel),
    ("friction coefficient", |o| o.friction),
];

/// Scale with which an output of a run is compared: its largest value, but forces and moments at least with the load,
/// powers with that of the load at a creepage of one per cent, and small differences of velocities with the velocities.
fn scale(run: &[Outputs], (name, of): Output) -> f64 {
    let largest = |of: fn(&Outputs) -> f64| run.iter().map(|o| of(o).abs()).fold(0.0, f64::max);
    let (load, velocity) = (largest(|o| o.contact_force_y), largest(|o| o.wheel_velocity));
    let least = match name {
        _ if name.contains("force") || name.contains("moment") => load,
        "friction power" | "heat to the wheel" => 1e-2 * load * velocity,
        "slip velocity" => velocity,
        "creepage" => 1.0,
        _ => 1e-9,
    };
    least.max(largest(of))
}

/// Fails unless the outputs of `b` are those of `a` times `factor`.
fn scaled([a, b]: &[Vec<Outputs>; 2], (name, of): Output, factor: f64, limit: f64) -> Result<(), TestCaseError> {
    prop_assert!(!a.is_empty());
    let scale = scale(a, (name, of));
    let worst = a.iter().zip(b).map(|(a, b)| (of(b) / factor - of(a)).abs() / scale).fold(0.0, f64::max);
    prop_assert!(worst <= limit, "{} differs by {:e} of {:e}", name, worst, scale);
    Ok(())
}

/// Fails unless the profiles of `b` are those of `a`, seen from the other side.
fn profiles_mirrored(a: &Outputs, b: &Outputs) -> Result<(), TestCaseError> {
    let mirrored = |of: &[f64], a: &[f64], b: &[f64], sign: f64| {
        let scale = of.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
        a.iter().zip(b.iter().rev()).all(|(a, b)| (a - sign * b).abs() <= 10.0 * MIRROR * scale)
    };
    prop_assert!(mirrored(&a.profile_pressure, &a.profile_pressure, &b.profile_pressure, 1.0), "pressure profile");
    prop_assert!(mirrored(&a.profile_pressure, &a.profile_shear, &b.profile_shear, -1.0), "shear profile");
    let temperatures = [&a.profile_temperature_wheel, &b.profile_temperature_wheel];
    prop_assert!(mirrored(temperatures[0], temperatures[0], temperatures[1], 1.0), "temperature profile");
    Ok(())
}

proptest! {
    #![proptest_config(few(12))]

    #[test]
    fn a_reversed_direction_of_travel_mirrors_mechanics_and_heat(
        velocity in 1.0..40.0f64, creepage in -4e-3..4e-3f64, load in 0.6..1.3f64, friction in 0.05..0.6f64,
        moment in -8e3..8e3f64, force in -5e3..5e3f64, dt in 1e-4..5e-3f64,
    ) {
        static MODELS: OnceLock<[Arc<Model>; 2]> = OnceLock::new();
        let models = MODELS.get_or_init(|| [0.0, 2e-3].map(|tolerance| {
            let mut config = coarse();
            config.tuning.tolerance = tolerance;
            common::model(config)
        }));
        for model in models {
            let run = |direction: f64| {
                let mut start = prescribed(model, direction * velocity, creepage);
                start.drive.load *= load;
                start.drive.friction = friction;
                drive(model, &start, direction * moment, direction * force, dt)
            };
            let runs = [run(1.0), run(-1.0)];
            for output in DIRECTED {
                scaled(&runs, output, -1.0, MIRROR)?;
            }
            for output in UNDIRECTED {
                scaled(&runs, output, 1.0, MIRROR)?;
            }
            for (a, b) in runs[0].iter().zip(&runs[1]) {
                profiles_mirrored(a, b)?;
            }
        }
    }
}

/// The model of a configuration; random ones are not worth keeping on disk.
fn fresh(config: Config) -> Arc<Model> {
    Model::prepare(config, &BasisStore::none(), &mut |_, _| {}).unwrap()
}

proptest! {
    #![proptest_config(few(5))]

    /// The plane model knows forces and masses per metre only.
    #[test]
    fn a_wider_contact_with_as_much_more_load_and_mass_carries_as_much_more_force(
        factor in 0.2..5.0f64, velocity in 1.0..40.0f64, creepage in -4e-3..4e-3f64,
        moment in -8e3..8e3f64, dt in 1e-4..5e-3f64,
    ) {
        let run = |k: f64| {
            let mut config = coarse();
            // Rim and rail head do not widen with the contact.
            config.thermal.cross_section = wheelrail::config::CrossSection::Contact;
            config.model.contact_width *= k;
            config.model.nominal_load *= k;
            config.wheel.hub_mass *= k;
            config.wheel.hub_inertia *= k;
            config.vehicle.mass *= k;
            config.vehicle.damping *= k;
            config.rail.restraint_stiffness *= k;
            config.rail.restraint_damping *= k;
            let model = if k == 1.0 { model(config) } else { fresh(config) };
            drive(&model, &prescribed(&model, velocity, creepage), k * moment, 0.0, dt)
        };
        let runs = [run(1.0), run(factor)];
        let forces = ["contact force x", "contact moment", "contact force y", "hub force x", "hub moment",
            "friction power", "heat to the wheel"];
        for output in DIRECTED.into_iter().chain(UNDIRECTED) {
            scaled(&runs, output, if forces.contains(&output.0) { factor } else { 1.0 }, 1e-9)?;
        }
    }

    /// Mechanics has no scale of its own: another unit of length, time and stress describes the same run.
    #[test]
    fn mechanics_does_not_depend_on_the_units_of_length_time_and_stress(
        length in 0.5..2.0f64, time in 0.5..1.6f64, stress in 0.3..1.0f64,
        velocity in 5.0..40.0f64, creepage in -4e-3..4e-3f64, moment in -8e3..8e3f64, dt in 1e-4..5e-3f64,
    ) {
        let run = |l: f64, t: f64, e: f64| {
            let mut config = coarse();
            config.thermal.enabled = false;
            config.tuning.softening = 0.0;
            let mass = e * t * t * l;
            for size in [&mut config.model.contact_width, &mut config.wheel.radius, &mut config.wheel.hub_radius,
                &mut config.rail.length, &mut config.rail.height] {
                *size *= l;
            }
            config.model.nominal_load *= e * l * l;
            config.wheel.hub_mass *= mass;
            config.vehicle.mass *= mass;
            config.vehicle.damping *= mass / t;
            config.rail.restraint_stiffness *= e * l;
            config.rail.restraint_damping *= e * l * t;
            config.wheel.hub_inertia *= mass * l * l;
            config.material.youngs_modulus *= e;
            config.material.density *= e * t * t / (l * l);
            let model = if [l, t, e] == [1.0; 3] { model(config) } else { fresh(config) };
            drive(&model, &prescribed(&model, velocity * l / t, creepage), moment * e * l.powi(3), 0.0, dt * t)
        };
        let runs = [run(1.0, 1.0, 1.0), run(length, time, stress)];
        let force = stress * length * length;
        for output in DIRECTED.into_iter().chain(UNDIRECTED) {
            let factor = match output.0 {
                "contact force x" | "contact force y" | "hub force x" => force,
                "contact moment" | "hub moment" => force * length,
                "velocity" | "slip velocity" => length / time,
                "angular velocity" => 1.0 / time,
                "distance" | "half-width" | "approach" => length,
                "peak pressure" => stress,
                "friction power" => force * length / time,
                _ => 1.0,
            };
            scaled(&runs, output, factor, 1e-8)?;
        }
    }
}
