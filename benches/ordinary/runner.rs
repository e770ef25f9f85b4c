//! A drive on every library, a few steps in turn.

use crate::cases::Drive;
use crate::library::Library;
use crate::options::Options;
use crate::worker::{Answer, Job, Step};
use std::io::{BufRead, BufReader, Write};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::time::Instant;

/// Cost of a drive with a library.
pub struct Run {
    /// Smallest time of every step \[s], and its number of internal steps.
    pub times: Vec<f64>,
    pub internal: Vec<i32>,
    /// Outputs at the end.
    pub end: Vec<(String, f64)>,
}

/// A process with a library.
pub struct Process {
    child: Child,
    input: Option<ChildStdin>,
    output: BufReader<ChildStdout>,
    label: &'static str,
}

impl Drop for Process {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

impl Process {
    /// Starts this program again with a library, its cache in `cache`.
    pub fn start(library: &Library, job: &Job, cache: &std::path::Path) -> Result<Process, String> {
        let failed = |error: std::io::Error| format!("{}: {error}", library.label);
        let job = serde_json::to_string(job).map_err(|error| error.to_string())?;
        let mut child = Command::new(std::env::current_exe().map_err(failed)?)
            .args(["--worker", &job])
            .env(wheelrail::simulation::CACHE_VARIABLE, cache)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .map_err(failed)?;
        let (input, output) = (child.stdin.take(), child.stdout.take());
        let output = BufReader::new(output.ok_or("process without output")?);
        Ok(Process { child, input, output, label: library.label })
    }

    /// The next answer.
    pub fn answer(&mut self) -> Result<Answer, String> {
        let mut line = String::new();
        self.output.read_line(&mut line).map_err(|error| format!("{}: {error}", self.label))?;
        match serde_json::from_str(&line) {
            Ok(Answer::Failed(problem)) => Err(format!("{}: {problem}", self.label)),
            Ok(answer) => Ok(answer),
            Err(_) => Err(format!("{}: its process ended early; last line: \"{}\"", self.label, line.trim())),
        }
    }

    fn steps(&mut self, count: u32) -> Result<Vec<Step>, String> {
        let input = self.input.as_mut().ok_or("process without input")?;
        // A process that has ended tells why in its answer.
        let _ = writeln!(input, "{count}");
        match self.answer()? {
            Answer::Steps(steps) => Ok(steps),
            _ => Err(format!("{}: not the steps that were asked for", self.label)),
        }
    }

    fn end(mut self) -> Result<Vec<(String, f64)>, String> {
        self.input = None;
        match self.answer()? {
            Answer::End(outputs) => Ok(outputs),
            _ => Err(format!("{}: no outputs at the end", self.label)),
        }
    }
}

/// Job of a library; parameters of the case come last.
pub fn job(library: &Library, case: Vec<(String, String)>, drive: Option<&Drive>) -> Job {
    Job {
        library: library.binary.clone(),
        description: library.description.clone(),
        resources: library.resources.clone(),
        settings: library.settings.iter().cloned().chain(case).collect(),
        drive: drive.map(|drive| drive.name.to_owned()),
    }
}

/// Runs a drive on all libraries as often and as long as asked.
pub fn measure(drive: &Drive, libraries: &[Library], options: &Options) -> Result<Vec<Run>, String> {
    let (begin, mut runs) = (Instant::now(), Vec::<Run>::new());
    for repeat in 0.. {
        if repeat >= options.repeats && begin.elapsed().as_secs_f64() >= options.seconds {
            break;
        }
        // The first step after a change of turns finds cold caches: every time another one.
        let first = 1 + 7 * repeat % options.batch;
        let fresh = once(drive, libraries, first, options.batch).map_err(|e| format!("{}: {e}", drive.name))?;
        if runs.is_empty() {
            runs = fresh;
            continue;
        }
        for ((run, fresh), library) in runs.iter_mut().zip(fresh).zip(libraries) {
            if run.internal != fresh.internal || run.end != fresh.end {
                return Err(format!("{}: {}: a second run is not the first again", drive.name, library.label));
            }
            run.times.iter_mut().zip(fresh.times).for_each(|(least, time)| *least = least.min(time));
        }
    }
    Ok(runs)
}

/// One run on all libraries, in turn from its start on; the first turn has `first` steps.
fn once(drive: &Drive, libraries: &[Library], first: u32, batch: u32) -> Result<Vec<Run>, String> {
    let mut processes = Vec::new();
    for library in libraries {
        let mut process = Process::start(library, &job(library, drive.parameters(), Some(drive)), &library.cache)?;
        process.answer()?;
        processes.push(process);
    }
    let [settling, measured] = drive.steps();
    let mut steps = vec![Vec::new(); libraries.len()];
    let (mut left, mut turn) = (settling + measured, first);
    while left > 0 {
        for (process, steps) in processes.iter_mut().zip(&mut steps) {
            steps.extend(process.steps(turn)?);
        }
        left -= turn;
        turn = batch.min(left);
    }
    let finished = |(process, steps): (Process, Vec<Step>)| {
        let end = process.end()?;
        if drive.ends_locked && !slides(&end) {
            return Err(format!("the wheel is not locked at the end: {end:?}"));
        }
        let counted = steps.into_iter().skip(settling as usize);
        let (times, internal) = counted.map(|(time, internal)| (1e-9 * time as f64, internal)).unzip();
        Ok(Run { times, internal, end })
    };
    processes.into_iter().zip(steps).map(finished).collect()
}

/// True where the wheel stands still while its centre moves.
fn slides(end: &[(String, f64)]) -> bool {
    let value = |name: &str| end.iter().find(|(known, _)| known == name).map_or(f64::NAN, |(_, value)| value.abs());
    value("wheel.omega") < 1e-3 && value("wheel.velocity") > 1.0
}
