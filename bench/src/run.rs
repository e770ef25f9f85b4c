//! A run of the bench: one wheel, its rail, and what is done to it.

use crate::rail::{Condition, Track};
use crate::record::{self, Column, Record};
use crate::script::Change;
use crate::settings::{STEP_MS, Settings};
use std::collections::VecDeque;
use wheelrail::simulation::{BasisStore, Inputs, Model, Outputs, Simulation, Translation, advice};

/// Torque of a brake that holds whatever comes \[N m].
const LOCKING: f64 = 100e3;
/// Length of a step \[s].
pub const STEP: f64 = 1e-3 * STEP_MS;

/// Variables of the FMU that are set together, with their values as Python writes them.
pub type Setting = Vec<(&'static str, String)>;

/// A run and all that repeats it.
pub struct Run {
    /// How it started, and what has been changed by whoever drives it.
    settings: Settings,
    /// Changes of its link that are still to come.
    pending: VecDeque<(u32, Change)>,
    simulation: Simulation,
    inputs: Inputs,
    track: Track,
    under: Condition,
    /// Torque to which a brake goes back that no longer holds \[N m].
    torque: f64,
    locked: bool,
    steps: u32,
    columns: Vec<Column>,
    record: Record,
    /// Settings, with the number of steps done before them.
    log: Vec<(u32, Setting)>,
}

impl Run {
    /// Starts a run in steady rolling; the changes of its link come in their time.
    ///
    /// # Errors
    /// A start that was not found, in the words of the user.
    pub fn start(settings: Settings, store: &BasisStore) -> Result<Self, String> {
        let config = settings.config()?;
        let model = Model::prepare(config.clone(), store, &mut |_, _| {})
            .map_err(|error| advice::failed_preparation(&error, &config))?;
        let mut inputs = Inputs::rolling(model.config());
        inputs.drive.load = 1e3 * settings.load;
        inputs.drive.lateral_velocity = settings.sideways() * inputs.drive.velocity;
        let simulation = Simulation::new(model, &inputs).map_err(|error| error.to_string())?;
        let pending = settings.changes.iter().copied().collect();
        let (rail, torque) = (settings.rail, 1e3 * settings.torque);
        let mut run = Self {
            settings: Settings { changes: Vec::new(), ..settings },
            pending,
            simulation,
            inputs,
            track: Track::uniform(rail),
            under: rail,
            torque,
            locked: false,
            steps: 0,
            columns: record::columns(),
            record: Record::new(STEP),
            log: Vec::new(),
        };
        run.note();
        run.brake();
        Ok(run)
    }

    /// Takes a change by hand, before the next step. Those of the link that are still to come are dropped.
    ///
    /// # Errors
    /// A text that is no change.
    pub fn change(&mut self, text: &str) -> Result<(), String> {
        let change = Change::parse(text).map_err(|error| error.to_string())?;
        let change = change.ok_or_else(|| format!("\"{text}\" is no change"))?;
        self.pending.clear();
        self.apply(change);
        Ok(())
    }

    /// One step.
    ///
    /// # Errors
    /// A step that was not found; the state stays as it was.
    pub fn step(&mut self) -> Result<(), String> {
        while self.pending.front().is_some_and(|(time, _)| f64::from(*time) <= f64::from(self.steps) * STEP_MS) {
            if let Some((_, change)) = self.pending.pop_front() {
                self.apply(change);
            }
        }
        self.come_under()?;
        self.inputs.drive.lateral_velocity = self.settings.sideways() * self.simulation.outputs().wheel_velocity;
        self.simulation.advance(&self.inputs, STEP).map_err(|error| error.to_string())?;
        self.steps += 1;
        self.note();
        Ok(())
    }

    fn apply(&mut self, change: Change) {
        match change {
            Change::Torque(torque) => {
                self.torque = 1e3 * torque;
                self.brake();
            }
            Change::Load(load) => {
                self.inputs.drive.load = 1e3 * load;
                self.set("drive.load", self.inputs.drive.load.to_string());
            }
            Change::Lock | Change::Release => {
                self.locked = change == Change::Lock;
                self.brake();
            }
            Change::Hold => {
                self.inputs.translation = Translation::Velocity;
                self.inputs.drive.velocity = self.simulation.outputs().wheel_velocity;
                self.set("control.translation", "\"velocity\"".to_owned());
                self.set("drive.velocity", self.inputs.drive.velocity.to_string());
            }
            Change::Coast => {
                self.inputs.translation = Translation::Force;
                self.set("control.translation", "\"force\"".to_owned());
            }
            Change::Rail(condition) => self.track.lay(self.simulation.outputs().wheel_distance, condition),
        }
        let time = (f64::from(self.steps) * STEP_MS).round() as u32;
        self.settings.changes.push((time, change));
    }

    /// Gives the brake the torque that it has now.
    fn brake(&mut self) {
        self.inputs.drive.torque = if self.locked { LOCKING } else { self.torque };
        self.set("brake.torque", self.inputs.drive.torque.to_string());
    }

    /// Gives the contact the friction of the rail that has come under the wheel.
    fn come_under(&mut self) -> Result<(), String> {
        let condition = self.track.at(self.simulation.outputs().wheel_distance);
        if condition == self.under {
            return Ok(());
        }
        let friction = condition.friction()?;
        let mut tuning = self.simulation.tuning().clone();
        (tuning.falling_ratio, tuning.falling_decay) = (friction.falling_ratio, friction.falling_decay);
        self.simulation.retune(&tuning);
        self.inputs.drive.friction = friction.coefficient;
        self.under = condition;
        self.set("rail.friction", friction.coefficient.to_string());
        self.set("friction.falling_ratio", friction.falling_ratio.to_string());
        self.set("friction.falling_decay", friction.falling_decay.to_string());
        Ok(())
    }

    /// Notes what is set before the next step; the last value of a variable counts.
    fn set(&mut self, name: &'static str, value: String) {
        if self.log.last().is_none_or(|(step, _)| *step != self.steps) {
            self.log.push((self.steps, Vec::new()));
        }
        if let Some((_, setting)) = self.log.last_mut() {
            setting.retain(|(other, _)| *other != name);
            setting.push((name, value));
        }
    }

    fn note(&mut self) {
        self.record.take(self.numbers());
    }

    /// Present numbers of all columns of the table.
    pub fn numbers(&self) -> Vec<f64> {
        let outputs = self.simulation.outputs();
        self.columns.iter().map(|(_, read)| read(outputs)).collect()
    }

    /// The run until now as a link.
    pub fn link(&self) -> String {
        let mut settings = self.settings.clone();
        settings.changes.extend(&self.pending);
        settings.to_string()
    }

    /// The numbers of the run until now.
    pub fn csv(&self) -> String {
        self.record.csv()
    }

    /// How the run started.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// Settings, with the number of steps done before them.
    pub fn log(&self) -> &[(u32, Setting)] {
        &self.log
    }

    /// Number of steps done.
    pub fn steps(&self) -> u32 {
        self.steps
    }

    /// Inputs of the next step.
    pub fn inputs(&self) -> &Inputs {
        &self.inputs
    }

    /// True while the brake holds whatever comes.
    pub fn locked(&self) -> bool {
        self.locked
    }

    /// Torque of the brake while it does not \[N m].
    pub fn torque(&self) -> f64 {
        self.torque
    }

    /// The rail.
    pub fn track(&self) -> &Track {
        &self.track
    }

    /// The wheel.
    pub fn simulation(&self) -> &Simulation {
        &self.simulation
    }

    /// Outputs of the wheel, temperatures over the depth included.
    pub fn outputs(&mut self) -> &Outputs {
        self.simulation.all_outputs()
    }
}
