//! A run over time: the slave, its scenario and its communication steps.

use super::clock::time_after;
use super::scenario::{RATE, Scenario, Values};
use super::setting::{Setting, find};
use super::setup::{Setup, failed, wrong};
use super::{Failure, told};
use std::path::PathBuf;
use wheelrail::fmi::description::{DEFAULT_STEP_SIZE, DEFAULT_STOP_TIME};
use wheelrail::fmi::instance::Instance;
use wheelrail::fmi::variable::{Kind, Value};
use wheelrail::simulation::LONGEST_STEP;

/// Difference of times, in steps, that is rounding only.
const ROUNDING: f64 = 1e-6;

// How long a run is and what happens in it. (A doc comment here would become the help of the commands.)
#[derive(clap::Args)]
pub struct Course {
    /// Inputs over time: CSV with a column `time` [s] and columns named after inputs; numbers are linear between rows,
    /// choices (by name or number) hold until the next row, and the last row holds to the end. Two rows at the same
    /// time make a jump, at that time whatever the step; what varies within a step acts with its mean; lines that begin
    /// with # are skipped.
    #[arg(long, value_name = "FILE")]
    pub scenario: Option<PathBuf>,
    /// End of the run [s]; that of the scenario, or 1, if not given.
    #[arg(long, value_name = "SECONDS", allow_hyphen_values = true)]
    pub stop: Option<f64>,
    /// Communication step [s].
    #[arg(long, value_name = "SECONDS", default_value_t = DEFAULT_STEP_SIZE, allow_hyphen_values = true)]
    pub step: f64,
}

/// A slave that is ready for its next communication step.
pub struct Run {
    /// The slave.
    pub instance: Instance,
    scenario: Option<Scenario>,
    step: f64,
    stop: f64,
    /// Completed steps.
    pub done: usize,
    /// Their number at the end.
    pub steps: usize,
}

impl Run {
    /// The slave in its stationary start state; `fixed` are what the command decides.
    pub fn start(setup: &Setup, course: &Course, fixed: &[Setting]) -> Result<Run, Failure> {
        let scenario = course.scenario.as_deref().map(Scenario::read).transpose()?;
        let step = course.step;
        if !(step > 0.0 && step <= LONGEST_STEP) {
            let range = format!("more than 0, at most {LONGEST_STEP} s");
            return Err(Failure::Usage(format!("--step = {step} is outside its range: {range}")));
        }
        let stop = course.stop.or_else(|| scenario.as_ref().map(Scenario::end)).unwrap_or(DEFAULT_STOP_TIME);
        if !(stop >= 0.0 && stop.is_finite()) {
            return Err(Failure::Usage(format!("--stop = {stop} is outside its range: finite, at least 0 s")));
        }
        for text in scenario.iter().flat_map(|scenario| scenario.unseen(stop, step)) {
            told(&format!("warning: {text}"));
        }
        let instance = setup.initialize(fixed, Some(stop))?;
        let steps = (stop / step - ROUNDING).ceil().max(0.0) as usize;
        let mut run = Run { instance, scenario, step, stop, done: 0, steps };
        run.prescribe(0.0, 0.0)?;
        run.instance.exit_initialization().map_err(failed)?;
        Ok(run)
    }

    /// Present time [s].
    pub fn time(&self) -> f64 {
        if self.done == self.steps { self.stop } else { time_after(self.done, self.step) }
    }

    /// One communication step; the last one is shorter if need be, and one in which inputs jump is taken in parts, which
    /// end at the jumps. `false` at the end of the run.
    pub fn advance(&mut self) -> Result<bool, Failure> {
        if self.done == self.steps {
            return Ok(false);
        }
        let time = self.time();
        let rest = self.stop - time;
        // Only a last step that is really shorter differs from the others.
        let h = if rest < (1.0 - ROUNDING) * self.step { rest } else { self.step };
        let ends = self.scenario.as_ref().map_or_else(|| vec![time + h], |scenario| scenario.parts(time, time + h));
        let mut begin = time;
        for &end in &ends {
            let h = if ends.len() == 1 { h } else { end - begin };
            self.prescribe(begin, h)?;
            self.instance.do_step(begin, h).map_err(failed)?;
            begin = end;
        }
        self.done += 1;
        Ok(true)
    }

    /// Ends the run: writes what is asked for at its end.
    pub fn finish(&mut self) -> Result<(), Failure> {
        self.instance.terminate().map_err(failed)
    }

    /// Sets the inputs of the scenario for a step of `h` from `time` on [s], as ramps; for none yet if `h` is zero.
    fn prescribe(&mut self, time: f64, h: f64) -> Result<(), Failure> {
        let Some(scenario) = &self.scenario else { return Ok(()) };
        let (mut choices, mut reals, mut rates) = ((vec![], vec![]), (vec![], vec![]), (vec![], vec![]));
        for column in scenario.columns() {
            let reference = column.variable.reference;
            match (&column.values, column.variable.kind) {
                (Values::Real(values), Kind::Real { .. }) => {
                    let [now, then] = match h > 0.0 {
                        true => scenario.line(column, values, time, time + h),
                        false => [scenario.after(values, time); 2],
                    };
                    reals.0.push(reference);
                    reals.1.push(Value::Real(now));
                    let rate = if h > 0.0 { (then - now) / h } else { 0.0 };
                    if rate != 0.0 {
                        rates.0.push(reference);
                        rates.1.push(rate);
                    }
                }
                (Values::Choice(values), _) => {
                    choices.0.push(reference);
                    choices.1.push(Value::Integer(scenario.choice(values, time)));
                }
                _ => return Err(Failure::Usage(format!("{} is no input", column.variable.name))),
            }
        }
        if let Some(rate) = scenario.elevation_rate(time + h) {
            reals.0.push(find(RATE, |_| true)?.reference);
            reals.1.push(Value::Real(rate));
        }
        self.instance.set(&choices.0, choices.1).map_err(wrong)?;
        self.instance.set(&reals.0, reals.1).map_err(wrong)?;
        let first_order = vec![1; rates.0.len()];
        self.instance.set_input_derivatives(&rates.0, &first_order, &rates.1).map_err(wrong)
    }
}
