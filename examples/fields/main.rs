//! Displacement, velocity, stress and temperature in the whole of wheel and rail, for ParaView.
//!
//!     cargo run --release --example fields -- --creepage 2e-3 --out fields
//!     cargo run --release --example fields -- --torque 4000 --stop 0.05 --every 0.01 --out film
//!
//! The first writes a state of stationary rolling, the second a series over a run that begins with it and in which a brake acts:
//! open `fields.pvd`. Displacement and stress need all finite-element equations (`solver.reduced` is false), and are those of contact,
//! inertia and centrifugal load, without thermal strain. Lengths are in metres with wheel and rail just touching at the origin; the
//! displacement brings them into contact. The velocity is that of the material seen from the wheel centre.

mod vtu;

use clap::Parser;
use serde_json::{Value, json};
use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};
use vtu::Data;
use wheelrail::config::{Config, StartTemperature, presets};
use wheelrail::simulation::{
    BasisStore, BodyField, Inputs, Model, Rotation, Simulation, Stress, TemperatureField, Translation,
    peripheral_velocity,
};

/// Passes that find the growth of a warm wheel, and what they may miss of its radius.
const GROWTH: (usize, f64) = (8, 1e-12);

/// Fields in the whole bodies for ParaView.
#[derive(Parser)]
struct Options {
    /// Parameter set resources/NAME.json.
    #[arg(long, default_value = "railway", value_name = "NAME")]
    preset: String,
    /// Any parameter; may be repeated.
    #[arg(long = "set", value_name = "NAME=VALUE")]
    settings: Vec<String>,
    /// Creepage 2 (V - r omega)/(V + r omega), braking positive.
    #[arg(long, default_value_t = 0.0, allow_hyphen_values = true)]
    creepage: f64,
    /// Torque of the brake in a run [N m].
    #[arg(long, default_value_t = 0.0)]
    torque: f64,
    /// End of a run [s].
    #[arg(long, default_value_t = 0.0)]
    stop: f64,
    /// Step of a run [s].
    #[arg(long, default_value_t = 1e-3)]
    step: f64,
    /// Time between two moments that are written [s], a multiple of the step; if not given, start and end of a run are.
    #[arg(long)]
    every: Option<f64>,
    /// Directory for the files.
    #[arg(long, default_value = "fields")]
    out: PathBuf,
}

impl Options {
    /// The preset with what is set.
    fn config(&self) -> Result<Config, Box<dyn Error>> {
        let path = Path::new("resources").join(format!("{}.json", self.preset));
        let text = fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()))?;
        let mut groups: Value = serde_json::from_str(&text)?;
        for setting in &self.settings {
            let named = setting.split_once('=').and_then(|(name, value)| Some((name.split_once('.')?, value)));
            let ((group, name), value) = named.ok_or_else(|| format!("--set {setting}: expected GROUP.NAME=VALUE"))?;
            groups[group][name] = serde_json::from_str(value).unwrap_or_else(|_| json!(value));
        }
        let mut config = presets::parse(&groups.to_string())?;
        (config.solver.reduced, config.initial.temperature) = (false, StartTemperature::Stationary);
        Ok(config)
    }

    /// Numbers of steps in all and between two moments that are written.
    fn steps(&self) -> Result<[usize; 2], String> {
        let count = |time: f64| (time / self.step).round() as usize;
        let [all, every] = [count(self.stop), count(self.every.unwrap_or(self.stop))];
        let valid = self.step > 0.0 && self.stop >= 0.0 && (every > 0 || all == 0);
        valid
            .then_some([all, every.max(1)])
            .ok_or_else(|| "--step and --every are more than 0, --stop at least 0".to_owned())
    }
}

/// Stationary rolling at a creepage, that of the radius to which the wheel then grows.
fn stationary(config: Config, creepage: f64) -> Result<(Simulation, Inputs), Box<dyn Error>> {
    let (radius, velocity) = (config.wheel.radius, config.initial.velocity);
    let mut inputs = Inputs::rolling(&config);
    (inputs.rotation, inputs.translation) = (Rotation::Velocity, Translation::Velocity);
    let mut simulation = Simulation::new(Model::shared(config, &BasisStore::none(), &mut |_, _| {})?, &inputs)?;
    let mut growth = 0.0;
    for _ in 0..GROWTH.0 {
        inputs.drive.omega = peripheral_velocity(velocity, creepage) / (radius + growth);
        simulation.restart(&inputs)?;
        let before = std::mem::replace(&mut growth, simulation.outputs().thermal_growth);
        if (growth - before).abs() <= GROWTH.1 * radius {
            break;
        }
    }
    Ok((simulation, inputs))
}

/// Displacement, velocity and stress of a body.
fn mechanical(body: &BodyField) -> Vec<Data> {
    let stress = |name, of: fn(&Stress) -> f64| Data::scalar(name, body.stress.iter().map(of).collect());
    vec![
        Data::vector("displacement", &body.displacement),
        Data::vector("velocity", &body.velocity),
        stress("sigma_xx", |s| s.xx),
        stress("sigma_yy", |s| s.yy),
        stress("sigma_xy", |s| s.xy),
        stress("sigma_zz", |s| s.zz),
        stress("von_mises", Stress::von_mises),
    ]
}

/// Writes the present state; names of the files.
fn write(simulation: &Simulation, out: &Path, moment: usize) -> Result<Vec<String>, Box<dyn Error>> {
    let (fields, mut files) = (simulation.fields()?, Vec::new());
    let mut grid = |name, nodes: &[_], cells: &[_], data: &[Data]| {
        files.push(format!("{name}_{moment:04}.vtu"));
        vtu::write(&out.join(&files[files.len() - 1]), nodes, cells, data)
    };
    for (name, body) in [("wheel", &fields.wheel), ("rail", &fields.rail)] {
        grid(name, &body.mesh.nodes, &body.mesh.cells, &mechanical(body))?;
    }
    let names = ["wheel_temperature", "rail_temperature"];
    for (name, TemperatureField { mesh, temperature }) in names.into_iter().zip(fields.temperature.iter().flatten()) {
        grid(name, &mesh.nodes, &mesh.cells, &[Data::scalar("temperature", temperature.clone())])?;
    }
    Ok(files)
}

fn main() -> Result<(), Box<dyn Error>> {
    let options = Options::parse();
    let [steps, every] = options.steps()?;
    let (mut simulation, mut inputs) = stationary(options.config()?, options.creepage)?;
    (inputs.rotation, inputs.translation) = (Rotation::Moment, Translation::Force);
    inputs.drive.torque = options.torque;
    fs::create_dir_all(&options.out)?;
    let (index, mut frames) = (options.out.join("fields.pvd"), Vec::new());
    for k in 0..=steps {
        if k > 0 {
            simulation.advance(&inputs, options.step)?;
        }
        if k.is_multiple_of(every) || k == steps {
            frames.push((simulation.time(), write(&simulation, &options.out, frames.len())?));
            vtu::write_index(&index, &frames)?;
        }
    }
    println!("written: {} with {} moments", index.display(), frames.len());
    Ok(())
}
