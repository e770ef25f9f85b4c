//! The simulation behind a wheel, prepared when it is needed.

use super::{WheelSlave, derivatives};
use crate::config::{Config, Files};
use crate::fmi::table::{find, named};
use crate::fmi::variable::{Reference, Value, Variable};
use crate::simulation::{BasisStore, Checkpoint, Inputs, Model, Simulation, Vertical, advice};
use std::sync::Arc;
use wheelrail_slave::aside::{self, Report};
use wheelrail_slave::{CallError, Life, Outcome, Status};

impl WheelSlave {
    /// Continues from a checkpoint under `config`; without one, from what the settings say.
    pub(super) fn resume(&mut self, checkpoint: Option<&Checkpoint>, config: &Config, life: &Life) -> Outcome {
        let refused = |error| CallError::error(format!("state cannot be set: {error}"));
        match (checkpoint, &mut self.simulation) {
            (None, _) => self.simulation = None,
            (Some(checkpoint), Some(simulation)) if simulation.model().serves(config) => {
                simulation.recall(checkpoint.clone()).map_err(refused)?;
                simulation.retune(&config.tuning);
            }
            (Some(checkpoint), _) => {
                let model = self.model(config.clone(), life)?;
                let resumed = Simulation::resume(model, config.tuning.clone(), checkpoint.clone());
                self.simulation = Some(resumed.map_err(refused)?);
            }
        }
        Ok(())
    }

    /// The simulation, brought up to date with parameters and inputs if it is not running yet.
    pub fn simulation(&mut self, life: &Life) -> Outcome<&mut Simulation> {
        if self.simulation.is_none() {
            self.check_settings(life)?;
            let store = self.store();
            self.model = self.model.take().filter(|model| model.is_up_to_date(&store));
            let model = self.model(self.config.clone(), life)?;
            let mut inputs = self.inputs(life);
            let config = self.config.clone();
            let failed = |error, inputs: &Inputs| {
                let why = advice::failed_start(&error, &config, inputs);
                CallError::error(format!("no stationary state for these inputs: {why}"))
            };
            let tuning = self.config.tuning.clone();
            let start = |inputs: &Inputs| {
                let (model, tuning) = (model.clone(), tuning.clone());
                aside::run(life.aside(), &mut |_, _| {}, |_| Simulation::start(model, tuning, inputs))
            };
            if let Some(reference) = self.height_to_find(&inputs, life) {
                let pressed = Inputs { vertical: Vertical::Force, ..inputs };
                let loaded = start(&pressed)?.map_err(|error| failed(error, &pressed))?;
                inputs.drive.displacement = loaded.outputs().hub_height;
                self.settings.bumpless.insert(reference, Value::Real(inputs.drive.displacement));
            }
            self.simulation = Some(start(&inputs)?.map_err(|error| failed(error, &inputs))?);
        }
        self.simulation.as_mut().ok_or_else(|| CallError::error("no simulation"))
    }

    /// Result of a computation by the simulation.
    pub(super) fn compute<R>(&mut self, life: &Life, work: impl FnOnce(&mut Simulation) -> R) -> Outcome<R> {
        self.simulation(life).map(work)
    }

    /// Derivatives of outputs along a direction of inputs, of which each has its component (see
    /// [`Simulation::difference`]).
    pub fn directional_derivative(
        &mut self,
        unknown: &[&Variable],
        known: &[(&Variable, f64)],
        life: &Life,
    ) -> Outcome<Vec<f64>> {
        let direction = derivatives::direction(known)?;
        derivatives::check_outputs(unknown)?;
        derivatives::check_shown(self.config.tuning.shown_line, unknown.iter().copied())?;
        let failed = |error| CallError::error(format!("directional derivative: {error}"));
        // It needs the most stack of all, and much longer than a thread takes to start.
        let simulation = self.simulation(life)?;
        let difference =
            aside::run(life.aside(), &mut |_, _| {}, |_| simulation.difference(direction))?.map_err(failed)?;
        derivatives::quotients(&difference, unknown)
    }

    /// Time derivatives of outputs, each of an order (see [`Simulation::rate`]).
    pub fn output_derivatives(&mut self, outputs: &[(&Variable, i32)], life: &Life) -> Outcome<Vec<f64>> {
        derivatives::check_orders(outputs)?;
        derivatives::check_shown(self.config.tuning.shown_line, outputs.iter().map(|(variable, _)| *variable))?;
        Ok(derivatives::rates(self.simulation(life)?, outputs))
    }

    /// Reference of the hub height, if it is prescribed at the start and has not been set.
    fn height_to_find(&self, inputs: &Inputs, life: &Life) -> Option<Reference> {
        let reference = named("drive.displacement")?.reference;
        let unset = inputs.vertical.prescribes_motion() && !self.given(life).contains_key(&reference);
        unset.then_some(reference)
    }

    /// Refuses parameters and inputs that do not go together. Each is within its own range since it was set; what
    /// follows from several can only be judged when all have been set, in whatever order.
    fn check_settings(&self, life: &Life) -> Outcome {
        self.config.validate().map_err(|error| {
            let set = self.settings.parameters.keys().filter_map(|reference| find(*reference));
            let names: Vec<_> = set.filter(|row| row.name != error.name()).map(|row| row.name).collect();
            let own = match names.as_slice() {
                [] => String::new(),
                names => {
                    format!("; with preset \"{}\" and {} as you have set them", self.settings.preset, names.join(", "))
                }
            };
            CallError::error(format!("{error}{own}"))
        })?;
        self.inputs(life).validate().map_err(|error| {
            let set =
                self.given(life).keys().filter_map(|reference| find(*reference)).any(|row| row.name == error.name);
            let initial = &self.config.initial;
            let source = match error.name {
                _ if set => return CallError::error(error.to_string()),
                "drive.omega" => format!(
                    "initial.velocity = {:?} m/s and initial.creepage = {:?} with wheel.radius = {:?} m",
                    initial.velocity,
                    initial.creepage.unwrap_or(0.0),
                    self.config.wheel.radius
                ),
                "drive.velocity" => format!("initial.velocity = {:?} m/s", initial.velocity),
                "drive.load" => format!("model.nominal_load = {:?} N", self.config.model.nominal_load),
                "rail.friction" => format!("friction.coefficient = {:?}", self.config.friction.coefficient),
                "rail.temperature" => format!("thermal.reference = {:?} K", self.config.thermal.reference),
                _ => return CallError::error(error.to_string()),
            };
            CallError::error(format!("{error}; it follows from {source} unless it is set"))
        })
    }

    /// Where bases, profiles and rows lie.
    fn store(&self) -> BasisStore {
        BasisStore::of_user().with_packed(self.resources.as_deref())
    }

    /// The model with these parameters; prepared now, with logged progress, unless it is the present one.
    fn model(&mut self, config: Config, life: &Life) -> Outcome<Arc<Model>> {
        if let Some(model) = self.model.as_ref().filter(|model| model.serves(&config)) {
            return Ok(model.clone());
        }
        let mut last = (String::new(), 0.0);
        let mut progress = |what: &str, share: f64| {
            if what != last.0 || share >= last.1 + 0.1 {
                life.log().progress(&format!("{what}: {:.0} %", 100.0 * share));
                last = (what.to_owned(), share);
            }
        };
        // Wheels that leave different files behind share a model.
        let config = Config { files: Files::default(), ..config };
        let store = self.store();
        let failed = |error| CallError::error(advice::failed_preparation(&error, &config));
        let prepare =
            |report: &mut Report| Model::shared(config.clone(), &store, &mut |what, share| report(what, share));
        let model = aside::run(life.aside(), &mut progress, prepare)?.map_err(failed)?;
        if let Some(why) = model.not_kept() {
            life.log().report(Status::Warning, why);
        }
        self.model = Some(model.clone());
        Ok(model)
    }
}
