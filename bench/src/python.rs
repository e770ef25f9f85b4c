//! A run as the lines of Python that repeat it on the FMU.

use crate::record::COLUMNS;
use crate::run::{Run, STEP};
use wheelrail::config::Config;

/// A program that prints the table of [`Run::csv`].
///
/// # Errors
/// A preset that cannot be read.
pub fn program(run: &Run) -> Result<String, String> {
    let settings = run.settings();
    let Config { friction, tuning, .. } = settings.config()?;
    let mut changes = String::new();
    for (step, setting) in run.log().iter().filter(|(step, _)| *step < run.steps().max(1)) {
        let pairs: Vec<_> = setting.iter().map(|(name, value)| format!("\"{name}\": {value}")).collect();
        changes += &format!("    {step}: {{{}}},\n", pairs.join(", "));
    }
    let outputs = COLUMNS.map(|name| format!("    \"{name}\",\n")).concat();
    let (link, patch, velocity) = (run.link(), settings.patch.preset_name(), settings.speed / 3.6);
    let (load, steps) = (1e3 * settings.load, run.steps());
    let (mut sideways, mut inputs, mut turned) = (String::new(), format!("\"drive.load\": {load}"), String::new());
    if settings.angle != 0.0 {
        let share = settings.sideways();
        sideways = "    \"contact.lateral\": True,\n".to_owned();
        inputs += &format!(", \"drive.lateral_velocity\": {}", share * velocity);
        turned =
            format!("        wheel.set({{\"drive.lateral_velocity\": {share} * wheel.get(\"wheel.velocity\")}})\n");
    }
    Ok(format!(
        r#""""A run of the bench: #{link}"""

from wheelrail import Fmu, Wheel

PARAMETERS = {{
    "preset": "{patch}",
    "initial.velocity": {velocity},
    "friction.coefficient": {},
    "friction.falling_ratio": {},
    "friction.falling_decay": {},
    "friction.softening": {},
    "friction.memory_length": {},
{sideways}}}
INPUTS = {{{inputs}}}
# Before the step of this number
CHANGES = {{
{changes}}}
OUTPUTS = [
{outputs}]
STEP, STEPS = {STEP}, {steps}

with Fmu() as fmu, Wheel(fmu, PARAMETERS, INPUTS) as wheel:
    print("time", *OUTPUTS, sep=",")
    print(0.0, *wheel.get(*OUTPUTS), sep=",")
    for step in range(STEPS):
        wheel.set(CHANGES.get(step, {{}}))
{turned}        wheel.step(STEP)
        print(wheel.time, *wheel.get(*OUTPUTS), sep=",")
"#,
        friction.coefficient, tuning.falling_ratio, tuning.falling_decay, tuning.softening, tuning.memory_length
    ))
}
