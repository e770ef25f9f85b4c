//! Stationary rolling by the product.

use std::path::Path;
use std::sync::Arc;
use wheelrail::config::presets;
use wheelrail::simulation::{BasisStore, Inputs, Model, Rotation, Simulation, Translation};

/// What is read off a stationary state.
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
    /// Preset `paper_a` to `paper_d`, with or without the centrifugal load. Reduced bases are kept in the target directory.
    pub fn new(preset: &str, centrifugal: bool) -> Result<Self, String> {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
        let file = root.join("resources").join(format!("{preset}.json"));
        let text = std::fs::read_to_string(&file).map_err(|error| format!("{}: {error}", file.display()))?;
        let store = BasisStore::within(&root.join("target"));
        let mut config = presets::parse(&text)?;
        config.physics.centrifugal = centrifugal;
        Model::shared(config, &store, &mut |_, _| {}).map(Self).map_err(|error| error.to_string())
    }

    /// Stationary rolling at a creepage and the preset's velocity, with another friction coefficient if given.
    pub fn stationary(&self, creepage: f64, friction: Option<f64>) -> Result<Stationary, String> {
        let mut config = self.0.config().clone();
        config.initial.creepage = Some(creepage);
        let mut inputs = Inputs::rolling(&config);
        (inputs.rotation, inputs.translation) = (Rotation::Velocity, Translation::Velocity);
        inputs.drive.friction = friction.unwrap_or(inputs.drive.friction);
        let simulation = Simulation::new(self.0.clone(), &inputs).map_err(|error| error.to_string())?;
        let outputs = simulation.outputs();
        Ok(Stationary {
            utilisation: outputs.contact_force_x / (inputs.drive.friction * outputs.contact_force_y),
            wheel_mean: outputs.temperature_wheel_bulk - config.thermal.reference,
        })
    }
}
