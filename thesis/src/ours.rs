//! Rolling by the product.

use std::path::Path;
use std::sync::Arc;
use wheelrail::config::{Config, StartTemperature, presets};
use wheelrail::contact::Traction;
use wheelrail::heat::{TemperatureField, Temperatures};
use wheelrail::simulation::{BasisStore, Inputs, Model, Outputs, Rotation, Simulation, Translation};

/// Readings of a stationary state.
#[derive(Clone, Copy, Debug)]
pub struct Stationary {
    /// `F_x/(μ F_y)`, traction positive \[1].
    pub utilisation: f64,
    /// Mean temperature of the wheel over the reference \[K].
    pub wheel_mean: f64,
}

/// The product with a preset of the thesis.
pub struct Product(Arc<Model>);

impl Product {
    /// Preset `paper_a` to `paper_d`, with or without the centrifugal load.
    pub fn new(preset: &str, centrifugal: bool) -> Result<Self, String> {
        Self::with(preset, |config| config.physics.centrifugal = centrifugal)
    }

    /// A preset with changes, of steel that does not yield, as in the thesis. Reduced bases are kept in the target
    /// directory.
    pub fn with(preset: &str, change: impl FnOnce(&mut Config)) -> Result<Self, String> {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
        let file = root.join("resources").join(format!("{preset}.json"));
        let text = std::fs::read_to_string(&file).map_err(|error| format!("{}: {error}", file.display()))?;
        let store = BasisStore::within(&root.join("target"));
        let mut config = presets::parse(&text)?;
        config.physics.yielding = false;
        config.initial.temperature = StartTemperature::Stationary;
        change(&mut config);
        Model::shared(config, &store, &mut |_, _| {}).map(Self).map_err(|error| error.to_string())
    }

    /// Its parameters.
    pub fn config(&self) -> &Config {
        self.0.config()
    }

    /// Rolling at prescribed velocity [m/s] and creepage under the nominal load, with other inputs changed.
    pub fn rolling(&self, velocity: f64, creepage: f64, change: impl FnOnce(&mut Inputs)) -> Result<Run, String> {
        let mut config = self.config().clone();
        (config.initial.velocity, config.initial.creepage) = (velocity, Some(creepage));
        let mut inputs = Inputs::rolling(&config);
        (inputs.rotation, inputs.translation) = (Rotation::Velocity, Translation::Velocity);
        change(&mut inputs);
        let simulation = Simulation::new(self.0.clone(), &inputs).map_err(|error| error.to_string())?;
        Ok(Run { simulation, inputs })
    }

    /// Stationary rolling at a creepage and the preset's velocity, with another friction coefficient if given.
    pub fn stationary(&self, creepage: f64, friction: Option<f64>) -> Result<Stationary, String> {
        let run = self.rolling(self.config().initial.velocity, creepage, |inputs| {
            inputs.drive.friction = friction.unwrap_or(inputs.drive.friction);
        })?;
        Ok(Stationary { utilisation: run.utilisation(), wheel_mean: run.warmth().wheel_mean })
    }
}

/// A motion from a stationary state on.
pub struct Run {
    simulation: Simulation,
    /// Prescription of the next steps.
    pub inputs: Inputs,
}

impl Run {
    /// A time step \[s] under the present inputs.
    pub fn advance(&mut self, dt: f64) -> Result<(), String> {
        self.simulation.advance(&self.inputs, dt).map_err(|error| error.to_string())
    }

    /// Prescribes velocity [m/s] and creepage at the end of the next step.
    pub fn roll(&mut self, velocity: f64, creepage: f64) {
        let radius = self.simulation.model().config().wheel.radius;
        self.inputs.drive.velocity = velocity;
        self.inputs.drive.omega = velocity * (1.0 - 0.5 * creepage) / (1.0 + 0.5 * creepage) / radius;
    }

    /// Outputs of the present state.
    pub fn outputs(&self) -> &Outputs {
        self.simulation.outputs()
    }

    /// `F_x/(μ F_y)`, traction positive \[1].
    pub fn utilisation(&self) -> f64 {
        let outputs = self.outputs();
        outputs.contact_force_x / (self.inputs.drive.friction * outputs.contact_force_y)
    }

    /// Temperatures over the reference.
    pub fn warmth(&self) -> Temperatures {
        self.simulation.state().lines[0].thermal.as_ref().map(|thermal| thermal.temperatures).unwrap_or_default()
    }

    /// Largest part of the heat put in that a body neither passes on nor stores \[1], by the nodal reactions of its
    /// equations; NaN without heat.
    pub fn heat_imbalance(&self) -> f64 {
        let Some(thermal) = &self.simulation.state().lines[0].thermal else { return f64::NAN };
        let flows = &thermal.flows;
        flows.wheel_imbalance().abs().max(flows.rail_imbalance().abs()) / (flows.friction + flows.supplied)
    }

    /// Temperatures over the reference \[K] at all nodes of wheel (about its centre) and rail.
    pub fn fields(&self) -> Result<[TemperatureField; 2], String> {
        let fields = self.simulation.temperature_fields().map_err(|error| error.to_string())?;
        let mut fields = fields.ok_or("no temperatures are computed")?;
        let reference = self.simulation.model().config().thermal.reference;
        fields.iter_mut().flat_map(|field| &mut field.temperature).for_each(|t| *t -= reference);
        Ok(fields)
    }

    /// Tractions in the contact.
    pub fn traction(&self) -> &Traction {
        &self.simulation.state().lines[0].contact.traction
    }
}
