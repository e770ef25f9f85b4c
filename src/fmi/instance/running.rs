//! The simulation behind an instance: prepared when it is needed, saved and restored.

use super::{Instance, Outcome};
use crate::config::Config;
use crate::fmi::lifecycle::Call;
use crate::fmi::log::{CallError, Status};
use crate::fmi::settings::with_parameters;
use crate::fmi::snapshot::Snapshot;
use crate::simulation::{Model, Simulation};
use std::sync::Arc;

impl Instance {
    /// Copy of everything that is needed to continue from here.
    pub fn snapshot(&self) -> Outcome<Snapshot> {
        self.allow(Call::FmuState)?;
        Ok(Snapshot {
            phase: self.phase,
            preset: self.preset.clone(),
            base: self.base.clone(),
            parameters: self.parameters.clone(),
            inputs: self.inputs.clone(),
            bumpless: self.bumpless.clone(),
            rates: self.rates,
            time: self.time,
            stop: self.stop,
            memory: self.simulation.as_ref().map(|simulation| simulation.memory().clone()),
        })
    }

    /// Continues from a snapshot, of this instance or another; on failure nothing changes.
    pub fn restore(&mut self, snapshot: &Snapshot) -> Outcome {
        self.allow(Call::FmuState)?;
        let config = with_parameters(&snapshot.base, &snapshot.parameters);
        let refused = |error| CallError::error(format!("state cannot be set: {error}"));
        match (&snapshot.memory, &mut self.simulation) {
            (None, _) => self.simulation = None,
            (Some(memory), Some(simulation)) if config == self.config => {
                simulation.recall(memory.clone()).map_err(refused)?;
            }
            (Some(memory), _) => {
                let model = self.model(config.clone())?;
                self.simulation = Some(Simulation::resume(model, memory.clone()).map_err(refused)?);
            }
        }
        self.phase = snapshot.phase;
        self.preset.clone_from(&snapshot.preset);
        self.base.clone_from(&snapshot.base);
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
            let model = self.model(self.config.clone())?;
            let inputs = self.effective_inputs();
            let failed = |error| CallError::error(format!("no stationary state for these inputs: {error}"));
            self.simulation = Some(Simulation::new(model, &inputs).map_err(failed)?);
        }
        self.simulation.as_mut().ok_or_else(|| CallError::error("no simulation"))
    }

    /// The model with these parameters; prepared now, with logged progress, unless it is the present one.
    fn model(&mut self, config: Config) -> Outcome<Arc<Model>> {
        if let Some(model) = self.model.as_ref().filter(|model| *model.config() == config) {
            return Ok(model.clone());
        }
        if let Some(model) = self.model.as_ref().and_then(|model| model.retuned(&config)) {
            self.model = Some(model.clone());
            return Ok(model);
        }
        let log = &self.log;
        let mut last = (String::new(), 0.0);
        let mut progress = |what: &str, share: f64| {
            if what != last.0 || share >= last.1 + 0.1 {
                log.progress(&format!("{what}: {:.0} %", 100.0 * share));
                last = (what.to_owned(), share);
            }
        };
        let model = Model::prepare(config, self.resources.as_deref(), &mut progress);
        let model = model.map_err(|error| CallError::error(error.to_string()))?;
        self.model = Some(model.clone());
        Ok(model)
    }
}
