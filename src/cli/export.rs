//! `export`: fields in the whole bodies to files for ParaView.

use super::interrupt::Interrupt;
use super::run::{Course, Run};
use super::setting::Setting;
use super::setup::{Setup, failed};
use super::steady::{OperatingPoint, parse_creepage};
use super::vtu::{self, Data, Encoding};
use super::{Failure, model, told};
use std::path::PathBuf;
use wheelrail::fmi::instance::{Instance, simulation};
use wheelrail::simulation::{BodyField, Fields, Stress, TemperatureField};

/// Write displacement, velocity, stress and temperature of wheel and rail for ParaView (.vtu).
///
/// Of stationary rolling at --creepage (with --velocity), or of the end of a run (--scenario, --stop), or of the start
/// state of a run, or with --every of a whole run as a series in binary files. Displacement and stress need all
/// finite-element equations, so solver.response is full here, which costs seconds instead of milliseconds. They are
/// those of contact, inertia and centrifugal load, without thermal strain. Lengths are in metres with wheel and rail
/// just touching at the origin; the displacement brings them into contact. velocity is that of the material seen from
/// the wheel centre.
#[derive(clap::Args)]
pub struct Export {
    #[command(flatten)]
    setup: Setup,
    #[command(flatten)]
    course: Course,
    /// Travel velocity of a stationary state [m/s]; initial.velocity if not given.
    #[arg(long, value_name = "M/S", allow_hyphen_values = true)]
    velocity: Option<f64>,
    /// Creepage 2 (V - r omega)/(V + r omega) of a stationary state, braking positive.
    #[arg(long, value_name = "X", value_parser = parse_creepage, allow_hyphen_values = true)]
    creepage: Option<f64>,
    /// Write a series over the run: at its start, at the first communication point after every so many seconds, and at
    /// its end; fields.pvd opens all of it.
    #[arg(long, value_name = "SECONDS", allow_hyphen_values = true)]
    every: Option<f64>,
    /// Directory for the files; fields.vtm there, or fields.pvd, opens all of them.
    #[arg(long, default_value = "fields", value_name = "DIR")]
    out: PathBuf,
}

impl Export {
    /// Writes the files.
    pub fn run(self, interrupt: &Interrupt) -> Result<(), Failure> {
        if let Some(every) = self.every {
            return self.series(every, interrupt);
        }
        let (mut instance, when) = self.instance(interrupt)?;
        self.write(&fields(&mut instance)?, &when)
    }

    /// Settings that the command decides, for displacement and stress of the whole bodies.
    fn fixed() -> Result<[Setting; 1], Failure> {
        told("displacement and stress need all finite-element equations: using solver.response = full");
        Ok([Setting::new("solver.response", "full")?])
    }

    /// The slave in the state to be exported, and what that is.
    fn instance(&self, interrupt: &Interrupt) -> Result<(Instance, String), Failure> {
        let fixed = Self::fixed()?;
        if self.creepage.is_some() || self.velocity.is_some() {
            if self.course.scenario.is_some() || self.course.stop.is_some() {
                let why =
                    "a stationary state (--creepage, --velocity) and a run (--scenario, --stop) exclude each other";
                return Err(Failure::Usage(why.to_owned()));
            }
            let mut point = OperatingPoint::new(&self.setup, self.velocity, &fixed)?;
            let creepage = self.creepage.unwrap_or(0.0);
            point.set(creepage)?;
            let when = format!("stationary rolling at {} m/s, creepage {creepage}", point.velocity);
            return Ok((point.instance, when));
        }
        let running = self.course.scenario.is_some() || self.course.stop.is_some();
        let start = Course { scenario: None, stop: Some(0.0), step: self.course.step };
        let mut run = Run::start(&self.setup, if running { &self.course } else { &start }, &fixed)?;
        let bar = model::bar("simulate", run.steps as u64);
        while interrupt.check().and_then(|()| run.advance())? {
            bar.set_position(run.done as u64);
        }
        bar.finish_and_clear();
        let when = format!("time {} s", run.time());
        Ok((run.instance, when))
    }

    fn write(&self, fields: &Fields, when: &str) -> Result<(), Failure> {
        let blocks = self.grids(fields, Encoding::Text, "", when)?;
        let index = self.out.join("fields.vtm");
        vtu::write_index(&index, &comment("wheel and rail", when), &blocks)?;
        told(&format!("{when}: {} and {} files beside it", index.display(), blocks.len()));
        Ok(())
    }

    /// Writes the grids of one moment, whose file names end in `suffix`; their names and files.
    fn grids(
        &self,
        fields: &Fields,
        encoding: Encoding,
        suffix: &str,
        when: &str,
    ) -> Result<Vec<(&'static str, String)>, Failure> {
        let mut blocks = Vec::new();
        let mut grid = |name, nodes: &[_], cells: &[_], data: &[Data]| -> Result<(), Failure> {
            let file = format!("{name}{suffix}.vtu");
            vtu::write(&self.out.join(&file), encoding, &comment(name, when), nodes, cells, data)?;
            blocks.push((name, file));
            Ok(())
        };
        for (name, body) in [("wheel", &fields.wheel), ("rail", &fields.rail)] {
            grid(name, &body.mesh.nodes, &body.mesh.cells, &mechanical(body))?;
        }
        let names = ["wheel_temperature", "rail_temperature"];
        for (name, TemperatureField { mesh, temperature }) in names.into_iter().zip(fields.temperature.iter().flatten())
        {
            grid(name, &mesh.nodes, &mesh.cells, &[Data::scalar("temperature", temperature.clone())])?;
        }
        Ok(blocks)
    }

    /// Writes a series over a run. The index is complete after every moment, whatever happens then.
    fn series(&self, every: f64, interrupt: &Interrupt) -> Result<(), Failure> {
        let step = self.course.step;
        if !(every.is_finite() && every >= step) {
            let range = format!("finite, at least --step = {step} s");
            return Err(Failure::Usage(format!("--every = {every} is outside its range: {range}")));
        }
        if self.creepage.is_some() || self.velocity.is_some() {
            let why =
                "a stationary state (--creepage, --velocity) does not change: --every needs a run (--scenario, --stop)";
            return Err(Failure::Usage(why.to_owned()));
        }
        let mut run = Run::start(&self.setup, &self.course, &Self::fixed()?)?;
        let bar = model::bar("export", run.steps as u64);
        let (index, mut frames) = (self.out.join("fields.pvd"), Vec::new());
        let ended = loop {
            // A time that is short of a moment by rounding only counts as there.
            if run.time() >= frames.len() as f64 * every - ROUNDING * step || run.done == run.steps {
                let when = format!("time {} s", run.time());
                let suffix = format!("_{:04}", frames.len());
                let blocks = self.grids(&fields(&mut run.instance)?, Encoding::Raw, &suffix, &when)?;
                frames.push((run.time(), blocks.into_iter().map(|(_, file)| file).collect()));
                vtu::write_series(&index, &comment("wheel and rail", "a series over time"), &frames)?;
            }
            bar.set_position(run.done as u64);
            match interrupt.check().and_then(|()| run.advance()) {
                Ok(true) => {}
                Ok(false) => break Ok(()),
                Err(failure) => break Err(failure),
            }
        };
        bar.finish_and_clear();
        run.finish()?;
        told(&format!("time 0 to {} s: {} with {} moments", run.time(), index.display(), frames.len()));
        ended
    }
}

/// Difference of times, in steps, that is rounding only.
const ROUNDING: f64 = 1e-6;

/// Fields of the present state.
fn fields(instance: &mut Instance) -> Result<Fields, Failure> {
    simulation(instance).map_err(failed)?.fields().map_err(|error| Failure::Run(error.to_string()))
}

/// Comment of a file: its content, and the moment or run that it is of.
fn comment(what: &str, when: &str) -> String {
    format!(" wheelrail: {what}, {when}; SI units ")
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
