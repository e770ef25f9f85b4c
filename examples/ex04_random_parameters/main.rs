//! Example 4: random parameter sets inside the declared ranges, each in a process of its own. None may crash, hang, eat
//! the memory or return values outside the declared ranges. A set is simulated, or refused with a message that names a
//! variable.
//!
//! `ex04_random_parameters [count] [first seed]` runs the cases and exits with 1 if one of them fails;
//! `ex04_random_parameters case <seed>` runs one of them and prints it.

#[path = "../../tests/common/random.rs"]
mod random;

mod case;

use case::Case;
use std::process::{Child, Command, ExitCode, Stdio};
use std::time::{Duration, Instant};

/// Processor time after which a case counts as hanging [s].
const PATIENCE: f64 = 30.0;
/// Time after which it does so in any case, on a machine that is busy with other things [s].
const LONGEST: f64 = 300.0;
/// Resident memory above which a case counts as eating it [kB].
const MEMORY: u64 = 2_000_000;
/// Exit code of a case that failed without crashing.
const FAILED: u8 = 3;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let number = |k: usize, default: u64| arguments.get(k).map_or(Ok(default), |text| text.parse());
    if arguments.first().is_some_and(|word| word == "case") {
        return number(1, 0).map_or(ExitCode::FAILURE, one);
    }
    match (number(0, 1000), number(1, 0)) {
        (Ok(count), Ok(first)) => all(count, first),
        _ => {
            eprintln!("usage: ex04_random_parameters [count] [first seed] | case <seed>");
            ExitCode::FAILURE
        }
    }
}

/// Runs one case in this process.
fn one(seed: u64) -> ExitCode {
    let case = Case::new(seed);
    let verdict = case.run();
    println!("{verdict:?}");
    println!("{case}");
    if verdict.acceptable() { ExitCode::SUCCESS } else { ExitCode::from(FAILED) }
}

/// Runs every case in a child process, several at a time.
fn all(count: u64, first: u64) -> ExitCode {
    let workers = std::thread::available_parallelism().map_or(1, usize::from) as u64;
    let results = std::sync::Mutex::new(std::collections::BTreeMap::<String, u64>::new());
    let failures = std::sync::atomic::AtomicU64::new(0);
    std::thread::scope(|scope| {
        for worker in 0..workers {
            let (results, failures) = (&results, &failures);
            scope.spawn(move || {
                for seed in (first + worker..first + count).step_by(workers as usize) {
                    let (kind, text, good) = isolated(seed);
                    if !good {
                        failures.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
                        println!("seed {seed}: {kind}\n{text}");
                    }
                    if let Ok(mut results) = results.lock() {
                        *results.entry(kind).or_default() += 1;
                    }
                }
            });
        }
    });
    println!("{count} parameter sets: {:?}", results.lock().map(|r| r.clone()).unwrap_or_default());
    if failures.into_inner() == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

/// Outcome of a case in a child process: kind, output and whether it is acceptable.
fn isolated(seed: u64) -> (String, String, bool) {
    let spawned = std::env::current_exe().and_then(|program| {
        let seed = seed.to_string();
        Command::new(program).args(["case", &seed]).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn()
    });
    let mut child = match spawned {
        Ok(child) => child,
        Err(error) => return ("not started".to_owned(), error.to_string(), false),
    };
    let stopped = wait(&mut child);
    let output = match child.wait_with_output() {
        Ok(output) => output,
        Err(error) => return ("lost".to_owned(), error.to_string(), false),
    };
    let text = String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr);
    if let Some(why) = stopped {
        return (why.to_owned(), format!("{text}{}", Case::new(seed)), false);
    }
    let kind = || text.split(['(', '\n']).next().unwrap_or_default().to_owned();
    match output.status.code() {
        Some(0) => (kind(), text, true),
        Some(code) if code == i32::from(FAILED) => (kind(), text, false),
        _ => ("crashed".to_owned(), format!("{text}{}\n{}", output.status, Case::new(seed)), false),
    }
}

/// Waits for the end of a case; one that hangs or eats the memory is stopped, with the reason.
fn wait(child: &mut Child) -> Option<&'static str> {
    let start = Instant::now();
    while let Ok(None) = child.try_wait() {
        let why = match () {
            () if busy(child.id()).unwrap_or(0.0) > PATIENCE || start.elapsed().as_secs_f64() > LONGEST => "hangs",
            () if resident(child.id()) > MEMORY => "eats the memory",
            () => {
                std::thread::sleep(Duration::from_millis(5));
                continue;
            }
        };
        // A child that ended in between is no longer there to be stopped.
        let _ = child.kill();
        return Some(why);
    }
    None
}

/// Processor time of a process [s]; nothing where it is not known.
fn busy(id: u32) -> Option<f64> {
    let status = std::fs::read_to_string(format!("/proc/{id}/stat")).ok()?;
    // Behind the name in brackets: user and system time are the twelfth and thirteenth field, in hundredths of a
    // second.
    let fields = status.rsplit(')').next()?.split_whitespace().skip(11).take(2);
    Some(fields.filter_map(|text| text.parse::<f64>().ok()).sum::<f64>() / 100.0)
}

/// Resident memory of a process [kB]; 0 where it is not known.
fn resident(id: u32) -> u64 {
    let status = std::fs::read_to_string(format!("/proc/{id}/status")).unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"));
    line.and_then(|text| text.split_whitespace().next()?.parse().ok()).unwrap_or(0)
}
