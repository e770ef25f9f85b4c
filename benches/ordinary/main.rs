//! Cost of a step in ordinary driving, of the present library beside an older one: `make bench NAME=ordinary BEFORE=…`.
//!
//! Both libraries are driven through their C functions, each in a process of its own, a few steps in turn, so that both
//! see the same load of the machine. Times are CPU times of the stepping thread; since a run repeats itself exactly,
//! every step counts with its smallest time of several runs.

mod cases;
mod library;
mod options;
mod report;
mod runner;
mod starts;
mod worker;

use cases::Case;
use clap::Parser;
use library::Library;
use options::Options;
use report::Report;
use std::process::ExitCode;

/// Names of the present library and of the older one in the table.
const PRESENT: &str = "after";
const OLDER: &str = "before";

fn compare(options: &Options) -> Result<(), String> {
    let cases = options.cases()?;
    let present = Library::open(PRESENT, options.after.as_deref(), &options.set)?;
    let older = options.before.as_deref().map(|path| Library::open(OLDER, Some(path), &options.set_before));
    let mut libraries: Vec<Library> = older.transpose()?.into_iter().collect();
    libraries.push(present);
    let mut report = Report::new(&libraries);
    // A file that cannot be written is refused before the work.
    options.json.as_deref().map_or(Ok(()), |path| report.write(path))?;
    for case in cases {
        match case {
            Case::Drive(drive) => report.drive(&drive, &runner::measure(&drive, &libraries, options)?),
            Case::Start => report.starts(&starts::measure(&libraries, options.repeats)?),
        }
    }
    options.json.as_deref().map_or(Ok(()), |path| report.write(path))
}

fn main() -> ExitCode {
    let options = Options::parse();
    let done = if let Some(job) = &options.worker {
        worker::serve(job)
    } else if options.list {
        cases::list();
        Ok(())
    } else {
        compare(&options)
    };
    done.map_or_else(
        |problem| {
            eprintln!("{problem}");
            ExitCode::FAILURE
        },
        |()| ExitCode::SUCCESS,
    )
}
