//! `simulate`: a run over time to a CSV file.

use super::interrupt::Interrupt;
use super::run::{Course, Run};
use super::setting::{Setting, find};
use super::setup::Setup;
use super::table::{self, Csv, significant};
use super::{Failure, model, told};
use indicatif::ProgressBar;
use std::io::{self, IsTerminal};
use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::time::{Duration, Instant};
use wheelrail::files;
use wheelrail::fmi::v2::variables::variables;
use wheelrail::fmi::variable::{Value, Variable};

/// Variables in the file unless others are named.
const OUTPUTS: &str = "wheel.velocity,wheel.omega,wheel.distance,contact.force_x,contact.force_y,contact.moment,\
    contact.creepage,contact.utilisation,contact.stick_fraction,contact.half_width,contact.pressure_max,\
    temperature.wheel_max,temperature.rail_max,heat.friction_power,hub.force_x,hub.moment,solver.energy_residual";

/// Speed [m/s] below which the peak of the creepage is not of interest: it is a ratio of speeds.
const ROLLING: f64 = 1.0;

/// Simulate over time: the slave inside the FMU, driven from here. CSV on standard output or to a file.
#[derive(clap::Args)]
pub struct Simulate {
    #[command(flatten)]
    setup: Setup,
    #[command(flatten)]
    course: Course,
    /// File for the results instead of standard output.
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// File for the names, units and meanings of the columns.
    #[arg(long, value_name = "FILE.csv")]
    columns: Option<PathBuf>,
    /// Variables to write, by FMI name; `profile.pressure` stands for all its points. If not given: speeds, forces,
    /// creepage, patch, temperatures, friction power, energy residual.
    #[arg(long, value_name = "NAMES", value_delimiter = ',', default_value = OUTPUTS, hide_default_value = true)]
    outputs: Vec<String>,
    /// Write every Nth communication point only (first and last always).
    #[arg(long, value_name = "N", default_value = "1")]
    every: NonZeroUsize,
    /// File for the profile of the wheel at the end of the run, worn and flattened as it is, for wheel.profile of
    /// another run.
    #[arg(long, value_name = "FILE.csv")]
    wheel_profile: Option<String>,
}

impl Simulate {
    /// Takes all steps; results go to the CSV, a summary to standard error.
    pub fn run(self, interrupt: &Interrupt) -> Result<(), Failure> {
        let columns = columns(&self.outputs)?;
        self.refuse_lost_files()?;
        let saved = self.wheel_profile.iter().map(|file| Setting::new("wheel.profile_save", file));
        let mut run = Run::start(&self.setup, &self.course, &saved.collect::<Result<Vec<_>, _>>()?)?;
        if let Some(path) = &self.columns {
            table::write_columns(path, &columns)?;
        }
        let mut csv = Csv::create(self.out.as_deref())?;
        csv.header(["time"].into_iter().chain(columns.iter().map(|v| v.name)))?;
        // A bar and results on the same terminal would overwrite each other.
        let shared = self.out.is_none() && io::stdout().is_terminal();
        let bar = if shared { ProgressBar::hidden() } else { model::bar("simulate", run.steps as u64) };
        let mut summary = Summary::new()?;
        loop {
            summary.see(&mut run)?;
            let due = run.done.is_multiple_of(self.every.get()) || run.done == run.steps;
            if due {
                csv.row(Some(run.time()), &columns, &table::read(&mut run.instance, &columns)?)?;
            }
            bar.set_position(run.done as u64);
            let began = Instant::now();
            match interrupt.check().and_then(|()| run.advance()) {
                Ok(true) => summary.wall += began.elapsed(),
                Ok(false) => break,
                Err(failure) => {
                    // What has been computed is kept.
                    bar.abandon();
                    if !due {
                        csv.row(Some(run.time()), &columns, &table::read(&mut run.instance, &columns)?)?;
                    }
                    csv.finish()?;
                    match run.finish() {
                        Ok(()) => self.tell_kept(run.time()),
                        Err(other) => told(&format!("error: {other}")),
                    }
                    return Err(failure);
                }
            }
        }
        bar.finish_and_clear();
        csv.finish()?;
        run.finish()?;
        summary.print(&mut run)
    }
}

impl Simulate {
    /// Says where what was computed until the end of a run \[s] that came too early lies.
    fn tell_kept(&self, time: f64) {
        let kept = [self.out.as_ref().map(|path| path.display().to_string()), self.wheel_profile.clone()];
        kept.into_iter().flatten().for_each(|file| told(&format!("{file} holds what was computed up to {time} s")));
    }

    /// Refuses two files in one place: results over the scenario, or under the profile of the wheel.
    fn refuse_lost_files(&self) -> Result<(), Failure> {
        let files = [
            ("--out", self.out.clone()),
            ("--scenario", self.course.scenario.clone()),
            ("--columns", self.columns.clone()),
            ("--wheel-profile", self.wheel_profile.as_ref().map(PathBuf::from)),
        ];
        let given: Vec<_> = files.into_iter().filter_map(|(option, path)| Some((option, path?))).collect();
        for (k, (option, path)) in given.iter().enumerate() {
            let same = |other: &&(&str, PathBuf)| files::place(&other.1) == files::place(path);
            if let Some((first, _)) = given.iter().take(k).find(same) {
                let file = path.display();
                return Err(Failure::Usage(format!(
                    "{first} and {option} are one file, {file}; give each a path of its own"
                )));
            }
        }
        Ok(())
    }
}

/// Variables by name; the name of a profile stands for its points.
fn columns(names: &[String]) -> Result<Vec<&'static Variable>, Failure> {
    let mut columns = Vec::new();
    for name in names.iter().map(|name| name.trim()) {
        let points: Vec<_> = variables().iter().filter(|v| v.name.split('[').next() == Some(name)).collect();
        if points.is_empty() { columns.push(find(name, |_| true)?) } else { columns.extend(points) }
    }
    Ok(columns)
}

/// Summary of a run, printed at its end.
struct Summary {
    /// Velocity, creepage, maximum temperatures of wheel and rail.
    watched: Vec<&'static Variable>,
    peak_creepage: f64,
    peak_temperature: f64,
    /// Spent in communication steps.
    wall: Duration,
}

impl Summary {
    fn new() -> Result<Summary, Failure> {
        let names = ["wheel.velocity", "contact.creepage", "temperature.wheel_max", "temperature.rail_max"];
        let watched = names.into_iter().map(|name| find(name, |_| true)).collect::<Result<_, _>>()?;
        Ok(Summary { watched, peak_creepage: 0.0, peak_temperature: 0.0, wall: Duration::ZERO })
    }

    fn see(&mut self, run: &mut Run) -> Result<(), Failure> {
        let values = table::read(&mut run.instance, &self.watched)?;
        let real = |i: usize| if let Some(Value::Real(v)) = values.get(i) { *v } else { 0.0 };
        if real(0).abs() > ROLLING && real(1).abs() > self.peak_creepage.abs() {
            self.peak_creepage = real(1);
        }
        self.peak_temperature = self.peak_temperature.max(real(2)).max(real(3));
        Ok(())
    }

    /// The table on standard error.
    fn print(&self, run: &mut Run) -> Result<(), Failure> {
        let (simulated, wall) = (run.time(), self.wall.as_secs_f64());
        let mut line = |what: &str, name: &str, value: Option<f64>| -> Result<(), Failure> {
            let variable = find(name, |_| true)?;
            let value = match value {
                Some(value) => vec![Value::Real(value)],
                None => table::read(&mut run.instance, &[variable])?,
            };
            let value = value.first().map_or_else(String::new, |value| table::shown(variable, value));
            let unit = Some(table::unit(variable)).filter(|unit| *unit != "1").unwrap_or_default();
            told(&format!("  {what:<28}{value:>11} {unit}"));
            Ok(())
        };
        line("speed at the end", "wheel.velocity", None)?;
        line("distance", "wheel.distance", None)?;
        line("peak creepage (above 1 m/s)", "contact.creepage", Some(self.peak_creepage))?;
        if self.peak_temperature > 0.0 {
            line("peak temperature", "temperature.wheel_max", Some(self.peak_temperature))?;
            line("heat residual", "solver.heat_residual", None)?;
        }
        line("energy residual", "solver.energy_residual", None)?;
        let factor = if wall > 0.0 { significant(simulated / wall) } else { "-".to_owned() };
        told(&format!("  {:<28}{factor:>11} x ({simulated} s in {} s)", "real-time factor", significant(wall)));
        Ok(())
    }
}
