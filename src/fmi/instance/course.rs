//! Steps along inputs that a master has given within them.

use super::{WheelSlave, derivatives};
use crate::config::Config;
use crate::fmi::variable::{Access, Value, Variable};
use wheelrail_slave::course::Point;
use wheelrail_slave::{CallError, Life, Outcome, Slave, Status};

impl WheelSlave {
    /// Present values of real inputs, each with the distance from a straight line that matters: `solver.tolerance`, or where that is
    /// switched off the usual one, of the usual size.
    pub fn present_inputs(&self, inputs: &[&Variable], life: &Life) -> Vec<(f64, f64)> {
        let tolerance = match self.config.tuning.tolerance {
            0.0 => Config::default().tuning.tolerance,
            tolerance => tolerance,
        };
        let present = self.inputs(life);
        let (mut values, mut sizes) = (present.drive, present.drive.sizes());
        let of = |variable: &&Variable| match variable.access {
            Access::RealInput(field) => Some((*field(&mut values), tolerance * *field(&mut sizes))),
            _ => None,
        };
        inputs.iter().filter_map(of).collect()
    }

    /// Refuses a value of an input within a step that is out of its range, or where the input has its time derivative.
    pub fn check_within_step(&self, input: &Variable, value: f64) -> Outcome {
        input.check(&Value::Real(value)).map_err(CallError::error)?;
        match self.settings.ramp_of(input) {
            Some(ramp) => {
                let why =
                    format!("changes within the step by {ramp}: set that to 0, or give no values within the step");
                Err(CallError::error(format!("{} {why}", input.name)))
            }
            None => Ok(()),
        }
    }

    /// Simulates from `start` along inputs that have values at some points of the step, straight lines between: as many steps with
    /// ramps as there are lines. Returns the time it took, less than that of the last point only where steps may end early. On
    /// error everything is as before.
    pub fn take_course(&mut self, start: f64, inputs: &[&Variable], points: &[Point], life: &Life) -> Outcome<f64> {
        let (settings, failure) = (self.settings.clone(), self.failure);
        let checkpoint = (points.len() > 2).then(|| self.save().checkpoint).flatten();
        let done = self.take_lines(start, inputs, points, life);
        if let Err(error) = &done {
            self.settings = settings;
            // The pieces before the one that failed have succeeded in between.
            if error.status == Status::Discard && points.len() > 2 {
                self.hopeless = failure.is_some() && failure == self.failure;
            }
            if checkpoint.is_some() {
                let config = self.config.clone();
                self.resume(checkpoint.as_ref(), &config, life)?;
            }
        }
        done
    }

    fn take_lines(&mut self, start: f64, inputs: &[&Variable], points: &[Point], life: &Life) -> Outcome<f64> {
        for line in points.windows(2) {
            let [from, to] = line else { continue };
            let h = to.time - from.time;
            let slopes = (0..inputs.len()).map(|k| (inputs[k], 1, (to.values[k] - from.values[k]) / h));
            derivatives::set_rates(&mut self.settings, &slopes.collect::<Vec<_>>())?;
            let took = match life.may_return_early() {
                true => self.step_to_event(start + from.time, h, life)?,
                false => self.step(start + from.time, h, life).map(|()| h)?,
            };
            if took < h {
                return Ok(from.time + took);
            }
            for (input, value) in inputs.iter().zip(&to.values) {
                self.settings.inputs.insert(input.reference, Value::Real(*value));
            }
        }
        Ok(points.last().map_or(0.0, |point| point.time))
    }
}
