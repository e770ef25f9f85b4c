//! Prints the `modelDescription.xml` of the coach: `coach` that of FMI 2.0, `coach 3` that of FMI 3.0.

use coach::fmi::description::{Version, model_description};
use std::process::ExitCode;

fn main() -> ExitCode {
    let version = match std::env::args().nth(1).as_deref() {
        None | Some("2") => Version::Two,
        Some("3") => Version::Three,
        Some(other) => {
            eprintln!("{other} is no version of FMI: coach 2, coach 3");
            return ExitCode::from(2);
        }
    };
    print!("{}", model_description(version));
    ExitCode::SUCCESS
}
