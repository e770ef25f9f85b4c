//! The process that drives one library: it reads from its input how many steps to take and answers with a line of times.

#[path = "../../tests/slave/mod.rs"]
pub mod slave;

use crate::cases::{self, Drive};
use crate::library::{Description, Kind};
use nix::time::{ClockId, clock_gettime};
use serde::{Deserialize, Serialize};
use slave::{Arguments, Slave, fmi2OK, fmi2Status, fmi2Warning};
use std::io::{BufRead, Write};
use std::path::PathBuf;
use std::time::{Duration, Instant};

/// Task of a process with a library.
#[derive(Serialize, Deserialize)]
pub struct Job {
    pub library: PathBuf,
    pub description: PathBuf,
    pub resources: Option<PathBuf>,
    /// Variables that are set before initialization, in this order.
    pub settings: Vec<(String, String)>,
    /// The drive to run, or none: it is the start that is measured.
    pub drive: Option<String>,
}

/// Time of a step \[ns] and its number of internal steps.
pub type Step = (u64, i32);

/// Answer of a process.
#[derive(Serialize, Deserialize)]
pub enum Answer {
    /// The wheel is ready: wall time and CPU time of all threads since before it was instantiated \[s].
    Ready { wall: f64, cpu: f64 },
    /// Steps that were asked for.
    Steps(Vec<Step>),
    /// Outputs at the end, by name.
    End(Vec<(String, f64)>),
    /// Nothing more will come.
    Failed(String),
}

/// Outputs that tell whether two versions did the same.
const OUTPUTS: [&str; 5] =
    ["wheel.velocity", "wheel.omega", "contact.force_x", "temperature.wheel_max", "wheel.distance"];

fn clock(id: ClockId) -> Duration {
    Duration::from(clock_gettime(id).expect("clock of CPU time"))
}

fn tell(answer: &Answer) {
    let mut output = std::io::stdout().lock();
    let line = serde_json::to_string(answer).expect("answer as JSON");
    writeln!(output, "{line}").and_then(|()| output.flush()).expect("answer is read");
}

/// Runs a job; what goes wrong is told as an answer.
pub fn serve(job: &str) -> Result<(), String> {
    let job: Job = serde_json::from_str(job).map_err(|error| format!("--worker: {error}"))?;
    if let Err(problem) = run(&job) {
        tell(&Answer::Failed(problem));
    }
    Ok(())
}

fn run(job: &Job) -> Result<(), String> {
    let description = Description::read(&job.description)?;
    let dll = slave::load_from(&job.library)?;
    let resources = job.resources.as_ref().map(|path| format!("file://{}", path.display()));
    let arguments =
        Arguments { guid: Some(&description.guid), resources: resources.as_deref(), ..Arguments::default() };
    let (wall, cpu) = (Instant::now(), clock(ClockId::CLOCK_PROCESS_CPUTIME_ID));
    let slave = Slave::try_new(&dll, &arguments).map_err(|messages| format!("not instantiated: {messages:?}"))?;
    let wheel = Wheel { slave, description };
    for (name, value) in &job.settings {
        wheel.set(name, value)?;
    }
    wheel.checked(wheel.slave.setup(0.0, None), "set-up")?;
    wheel.checked(wheel.slave.enter(), "initialization")?;
    wheel.checked(wheel.slave.exit(), "end of initialization")?;
    let cpu = clock(ClockId::CLOCK_PROCESS_CPUTIME_ID) - cpu;
    tell(&Answer::Ready { wall: wall.elapsed().as_secs_f64(), cpu: cpu.as_secs_f64() });
    let Some(name) = &job.drive else { return Ok(()) };
    let drive = cases::drive(name).ok_or_else(|| format!("no case \"{name}\""))?;
    wheel.drive(&drive)
}

/// An instance with its variables by name.
struct Wheel<'a> {
    slave: Slave<'a>,
    description: Description,
}

impl Wheel<'_> {
    fn checked(&self, status: fmi2Status, what: &str) -> Result<(), String> {
        if status == fmi2OK || status == fmi2Warning {
            return Ok(());
        }
        let texts: Vec<_> = self.slave.messages().into_iter().map(|message| message.text).collect();
        Err(format!("{what} failed: {}", texts.join("; ")))
    }

    fn set(&self, name: &str, text: &str) -> Result<(), String> {
        let (reference, kind) = self.description.variable(name)?;
        let refused = |expected: &str| format!("{name} = \"{text}\" is not {expected}");
        let status = match kind {
            Kind::Real => self.slave.set_reals(&[*reference], &[text.parse().map_err(|_| refused("a number"))?]),
            Kind::Integer => {
                self.slave.set_integer_at(*reference, text.parse().map_err(|_| refused("a whole number"))?)
            }
            Kind::Boolean => self.slave.set_boolean_at(*reference, text.parse().map_err(|_| refused("true or false"))?),
            Kind::Text => self.slave.set_string_at(*reference, text),
            Kind::Enumeration(items) => {
                let names: Vec<_> = items.keys().map(String::as_str).collect();
                let value = items.get(text).ok_or_else(|| refused(&format!("one of {}", names.join(", "))))?;
                self.slave.set_integer_at(*reference, *value)
            }
        };
        self.checked(status, &format!("{name} = {text}"))
    }

    /// Steps as many as each line of the input asks for, until it ends.
    fn drive(&self, drive: &Drive) -> Result<(), String> {
        let names: Vec<_> = (drive.course)(0.0).into_iter().map(|(name, _)| name).collect();
        let references: Result<Vec<u32>, String> =
            names.iter().map(|name| Ok(self.description.variable(name)?.0)).collect();
        let (references, internal) = (references?, self.description.variable("solver.internal_steps")?.0);
        let mut values = vec![0.0; references.len()];
        let spent = overhead();
        let mut count = 0;
        for line in std::io::stdin().lock().lines() {
            let line = line.map_err(|error| error.to_string())?;
            let wanted: usize = line.trim().parse().map_err(|_| format!("\"{line}\" is no number of steps"))?;
            let mut steps = Vec::with_capacity(wanted);
            for _ in 0..wanted {
                let time = f64::from(count) * drive.step;
                values.iter_mut().zip((drive.course)(time)).for_each(|(value, (_, new))| *value = new);
                let begin = clock(ClockId::CLOCK_THREAD_CPUTIME_ID);
                let set = self.slave.set_reals(&references, &values);
                let stepped = self.slave.step(time, drive.step);
                let taken = (clock(ClockId::CLOCK_THREAD_CPUTIME_ID) - begin).saturating_sub(spent);
                self.checked(set, "inputs").and_then(|()| self.checked(stepped, &format!("the step at {time} s")))?;
                steps.push((taken.as_nanos() as u64, self.slave.integer_at(internal)));
                count += 1;
            }
            tell(&Answer::Steps(steps));
        }
        self.end()
    }

    fn end(&self) -> Result<(), String> {
        let mut outputs = Vec::new();
        for name in OUTPUTS {
            let reference = self.description.variable(name)?.0;
            let value = self.slave.get_reals(&[reference]).map_err(|status| format!("{name}: {status:?}"))?[0];
            outputs.push((name.to_owned(), value));
        }
        tell(&Answer::End(outputs));
        Ok(())
    }
}

/// Time that reading the clock twice adds to what lies between.
fn overhead() -> Duration {
    let read = || clock(ClockId::CLOCK_THREAD_CPUTIME_ID);
    (0..1000).map(|_| read()).map(|begin| read() - begin).min().unwrap_or_default()
}
