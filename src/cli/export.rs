//! `export`: fields in the whole bodies to files for ParaView.

use super::run::{Course, Run};
use super::setting::Setting;
use super::setup::{Setup, failed};
use super::steady::{OperatingPoint, Velocity, parse_creepage};
use super::vtu::{self, Data};
use super::{Failure, model};
use std::path::PathBuf;
use wheelrail::fmi::instance::{Instance, simulation};
use wheelrail::simulation::{BodyField, Fields, Stress, TemperatureField};

/// Write displacement, velocity, stress and temperature of wheel and rail for ParaView (.vtu).
///
/// Of stationary rolling at --creepage (with --velocity), or of the end of a run (--scenario, --stop), or of the start
/// state of a run. Displacement and stress need all finite-element equations, so solver.response is full here, which
/// costs seconds instead of milliseconds. They are those of contact, inertia and centrifugal load, without thermal
/// strain. Lengths are in metres with wheel and rail just touching at the origin; the displacement brings them into
/// contact. velocity is that of the material seen from the wheel centre.
#[derive(clap::Args)]
pub struct Export {
    #[command(flatten)]
    setup: Setup,
    #[command(flatten)]
    course: Course,
    #[command(flatten)]
    velocity: Velocity,
    /// Creepage 2 (V - r omega)/(V + r omega) of a stationary state, braking positive.
    #[arg(long, value_name = "X", value_parser = parse_creepage, allow_hyphen_values = true)]
    creepage: Option<f64>,
    /// Directory for the files; fields.vtm there opens all of them.
    #[arg(long, default_value = "fields", value_name = "DIR")]
    out: PathBuf,
}

impl Export {
    /// Writes the files.
    pub fn run(self) -> Result<(), Failure> {
        eprintln!("displacement and stress need all finite-element equations: using solver.response = full");
        let (mut instance, when) = self.instance()?;
        let fields = simulation(&mut instance).map_err(failed)?.fields().map_err(|e| Failure::Run(e.to_string()))?;
        self.write(&fields, &when)
    }

    /// The slave in the state to be exported, and what that is.
    fn instance(&self) -> Result<(Instance, String), Failure> {
        let fixed = [Setting::new("solver.response", "full")?];
        if self.creepage.is_some() || self.velocity.is_given() {
            if self.course.scenario.is_some() || self.course.stop.is_some() {
                let why =
                    "a stationary state (--creepage, --velocity) and a run (--scenario, --stop) exclude each other";
                return Err(Failure::Usage(why.to_owned()));
            }
            let mut point = OperatingPoint::new(&self.setup, &self.velocity, &fixed)?;
            let creepage = self.creepage.unwrap_or(0.0);
            point.set(creepage)?;
            let when = format!("stationary rolling at {} m/s, creepage {creepage}", point.velocity);
            return Ok((point.instance, when));
        }
        let running = self.course.scenario.is_some() || self.course.stop.is_some();
        let start = Course { scenario: None, stop: Some(0.0), step: self.course.step };
        let mut run = Run::start(&self.setup, if running { &self.course } else { &start }, &fixed)?;
        let bar = model::bar("simulate", run.steps as u64);
        while run.advance()? {
            bar.set_position(run.done as u64);
        }
        bar.finish_and_clear();
        let when = format!("time {} s", run.time());
        Ok((run.instance, when))
    }

    fn write(&self, fields: &Fields, when: &str) -> Result<(), Failure> {
        let mut blocks = Vec::new();
        let comment = |what: &str| format!(" wheelrail: {what}, {when}; SI units ");
        for (name, body) in [("wheel", &fields.wheel), ("rail", &fields.rail)] {
            let file = format!("{name}.vtu");
            let (path, mesh) = (self.out.join(&file), &body.mesh);
            vtu::write(&path, &comment(name), &mesh.nodes, &mesh.cells, &mechanical(body))?;
            blocks.push((name, file));
        }
        let names = ["wheel_temperature", "rail_temperature"];
        for (name, TemperatureField { mesh, temperature }) in names.into_iter().zip(fields.temperature.iter().flatten())
        {
            let file = format!("{name}.vtu");
            let data = [Data::scalar("temperature", temperature.clone())];
            vtu::write(&self.out.join(&file), &comment(name), &mesh.nodes, &mesh.cells, &data)?;
            blocks.push((name, file));
        }
        let index = self.out.join("fields.vtm");
        vtu::write_index(&index, &comment("wheel and rail"), &blocks)?;
        eprintln!("{when}: {} and {} files beside it", index.display(), blocks.len());
        Ok(())
    }
}

/// Displacement, velocity and stress.
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
