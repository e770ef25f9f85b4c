//! The simulation behind an instance: prepared when it is needed, saved and restored.

use super::aside::{self, Report};
use super::{Instance, Outcome};
use crate::config::{Config, Files, Response};
use crate::fmi::lifecycle::Call;
use crate::fmi::log::{CallError, Status};
use crate::fmi::settings::with_parameters;
use crate::fmi::snapshot::Snapshot;
use crate::fmi::variable::{Reference, Value};
use crate::fmi::variables::{find, variables};
use crate::simulation::{BasisStore, Inputs, Model, Simulation, Vertical, advice};
use std::sync::Arc;

impl Instance {
    /// Copy of everything that is needed to continue from here.
    pub fn snapshot(&self) -> Outcome<Snapshot> {
        self.allow(Call::FmuState)?;
        Ok(Snapshot {
            phase: self.phase,
            preset: self.preset.clone(),
            base: self.base.clone(),
            experiment: self.experiment.clone(),
            parameters: self.parameters.clone(),
            inputs: self.inputs.clone(),
            bumpless: self.bumpless.clone(),
            rates: self.rates,
            time: self.time,
            stop: self.stop,
            checkpoint: self.simulation.as_ref().map(|simulation| simulation.checkpoint().clone()),
        })
    }

    /// Continues from a snapshot, of this instance or another; on failure nothing changes.
    pub fn restore(&mut self, snapshot: &Snapshot) -> Outcome {
        self.allow(Call::FmuState)?;
        let config = with_parameters(&snapshot.base, &snapshot.experiment, &snapshot.parameters);
        let refused = |error| CallError::error(format!("state cannot be set: {error}"));
        match (&snapshot.checkpoint, &mut self.simulation) {
            (None, _) => self.simulation = None,
            (Some(checkpoint), Some(simulation)) if simulation.model().serves(&config) => {
                simulation.recall(checkpoint.clone()).map_err(refused)?;
                simulation.retune(&config.tuning);
            }
            (Some(checkpoint), _) => {
                let model = self.model(config.clone())?;
                let resumed = Simulation::resume(model, config.tuning.clone(), checkpoint.clone());
                self.simulation = Some(resumed.map_err(refused)?);
            }
        }
        self.phase = snapshot.phase;
        self.preset.clone_from(&snapshot.preset);
        self.base.clone_from(&snapshot.base);
        self.experiment.clone_from(&snapshot.experiment);
        self.parameters.clone_from(&snapshot.parameters);
        self.config = config;
        self.inputs.clone_from(&snapshot.inputs);
        self.bumpless.clone_from(&snapshot.bumpless);
        self.rates = snapshot.rates;
        (self.time, self.stop) = (snapshot.time, snapshot.stop);
        // A master may restore and repeat a discarded step for ever: the failure is remembered.
        (self.last_step, self.hopeless) = (Status::Ok, false);
        Ok(())
    }

    /// The simulation, brought up to date with parameters and inputs if it is not running yet.
    pub fn simulation(&mut self) -> Outcome<&mut Simulation> {
        if self.simulation.is_none() {
            self.check_settings()?;
            let model = self.model(self.config.clone())?;
            let mut inputs = self.effective_inputs();
            let config = self.config.clone();
            let failed = |error, inputs: &Inputs| {
                let why = advice::failed_start(&error, &config, inputs);
                CallError::error(format!("no stationary state for these inputs: {why}"))
            };
            let tuning = self.config.tuning.clone();
            let start = |inputs: &Inputs| {
                let (model, tuning) = (model.clone(), tuning.clone());
                aside::run(self.aside, &mut |_, _| {}, |_| Simulation::start(model, tuning, inputs))
            };
            if let Some(reference) = self.height_to_find(&inputs) {
                let pressed = Inputs { vertical: Vertical::Force, ..inputs };
                let loaded = start(&pressed)?.map_err(|error| failed(error, &pressed))?;
                inputs.drive.displacement = loaded.outputs().hub_height;
                self.bumpless.insert(reference, Value::Real(inputs.drive.displacement));
            }
            self.simulation = Some(start(&inputs)?.map_err(|error| failed(error, &inputs))?);
        }
        self.simulation.as_mut().ok_or_else(|| CallError::error("no simulation"))
    }

    /// What the simulation computes; aside where it factorises matrices.
    pub(super) fn compute<R: Send>(&mut self, work: impl FnOnce(&mut Simulation) -> R + Send) -> Outcome<R> {
        let full = self.config.solver.response == Response::Full;
        let aside = if full { self.aside } else { aside::here };
        let simulation = self.simulation()?;
        aside::run(aside, &mut |_, _| {}, |_| work(simulation))
    }

    /// Reference of the hub height, if it is prescribed at the start and has not been set.
    fn height_to_find(&self, inputs: &Inputs) -> Option<Reference> {
        let reference = variables().iter().find(|row| row.name == "drive.displacement")?.reference;
        let unset = inputs.vertical == Vertical::Displacement && !self.given().contains_key(&reference);
        unset.then_some(reference)
    }

    /// Refuses parameters and inputs that do not go together. Each is within its own range since it was set; what follows
    /// from several can only be judged when all have been set, in whatever order.
    fn check_settings(&self) -> Outcome {
        self.config.validate().map_err(|error| {
            let set = self.parameters.keys().filter_map(|reference| find(*reference));
            let names: Vec<_> = set.filter(|row| row.name != error.name).map(|row| row.name).collect();
            let own = match names.as_slice() {
                [] => String::new(),
                names => format!("; with preset \"{}\" and {} as you have set them", self.preset, names.join(", ")),
            };
            CallError::error(format!("{error}{own}"))
        })?;
        self.effective_inputs().validate().map_err(|error| {
            let set = self.given().keys().filter_map(|reference| find(*reference)).any(|row| row.name == error.name);
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

    /// The model with these parameters; prepared now, with logged progress, unless it is the present one.
    fn model(&mut self, config: Config) -> Outcome<Arc<Model>> {
        if let Some(model) = self.model.as_ref().filter(|model| model.serves(&config)) {
            return Ok(model.clone());
        }
        let log = &self.log;
        let mut last = (String::new(), 0.0);
        let mut progress = |what: &str, share: f64| {
            if what != last.0 || share >= last.1 + 0.1 {
                log.progress(&format!("{what}: {:.0} %", 100.0 * share));
                last = (what.to_owned(), share);
            }
        };
        // Wheels that leave different files behind share a model.
        let config = Config { files: Files::default(), ..config };
        let store = BasisStore::of_user().with_packed(self.resources.as_deref());
        let failed = |error| CallError::error(advice::failed_preparation(&error, &config));
        let prepare =
            |report: &mut Report| Model::shared(config.clone(), &store, &mut |what, share| report(what, share));
        let model = aside::run(self.aside, &mut progress, prepare)?.map_err(failed)?;
        if let Some(why) = model.not_kept() {
            self.log.report(Status::Warning, why);
        }
        self.model = Some(model.clone());
        Ok(model)
    }
}
