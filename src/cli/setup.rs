//! From preset and settings to a slave: the arguments that all runs share.

use super::setting::Setting;
use super::{Failure, model, told};
use std::path::{Path, PathBuf};
use wheelrail::fmi::instance::Instance;
use wheelrail::fmi::log::{CallError, Log, Status};

/// Default directory with the presets; `railway` works without.
const RESOURCES: &str = "resources";

// Preset and settings. (A doc comment here would become the help of the commands.)
#[derive(clap::Args)]
pub struct Setup {
    /// Parameter set <RESOURCES>/<NAME>.json; `railway` if none is named.
    #[arg(long, value_name = "NAME")]
    preset: Option<String>,
    /// Directory with the presets.
    #[arg(long, value_name = "DIR", default_value = RESOURCES)]
    resources: PathBuf,
    /// Directory that keeps computed bases for the next time, in its subdirectory `basis`; if it does not
    /// exist, the cache of the user takes its place.
    #[arg(long, default_value = "target", value_name = "DIR")]
    cache: PathBuf,
    /// Any parameter, or the start value of an input, by its FMI name in SI units; enumeration items by name or number.
    #[arg(long = "set", value_name = "NAME=VALUE", allow_hyphen_values = true)]
    settings: Vec<String>,
}

/// A refusal of what the user has set.
pub fn wrong(refusal: CallError) -> Failure {
    Failure::Usage(refusal.message)
}

/// A refusal because the model could not do it.
pub fn failed(refusal: CallError) -> Failure {
    Failure::Run(refusal.message)
}

/// Shows warnings on standard error; errors are returned as well.
fn warn(status: Status, _category: &str, message: &str) {
    if status == Status::Warning {
        told(&format!("warning: {message}"));
    }
}

impl Setup {
    /// Settings in their order, the preset first.
    pub fn settings(&self) -> Result<Vec<Setting>, Failure> {
        let preset = self.preset.iter().map(|name| Setting::new("preset", name));
        // What a shell does not name is not set.
        let given = std::iter::once(Setting::new("initial.given", "written"));
        given.chain(preset).chain(self.settings.iter().map(|text| Setting::parse(text))).collect()
    }

    /// A slave in Initialization Mode with the settings, then `fixed` ones, and its model prepared.
    ///
    /// `fixed` are what the command itself decides. `stop` is the end of the run [s].
    pub fn initialize(&self, fixed: &[Setting], stop: Option<f64>) -> Result<Instance, Failure> {
        if self.resources != Path::new(RESOURCES) && !self.resources.is_dir() {
            return Err(Failure::Usage(format!("--resources {} is not a directory", self.resources.display())));
        }
        let resources = Some(self.resources.clone());
        let mut instance = Instance::new(resources, Log::new(Box::new(warn), false)).map_err(wrong)?;
        instance.setup_experiment(None, 0.0, stop).map_err(wrong)?;
        for Setting { variable, value } in self.settings()? {
            if fixed.iter().any(|decided| decided.variable.name == variable.name && decided.value != value) {
                return Err(Failure::Usage(format!("{} is decided by the command and cannot be set", variable.name)));
            }
            instance.set(&[variable.reference], vec![value]).map_err(wrong)?;
        }
        for Setting { variable, value } in fixed {
            instance.set(&[variable.reference], vec![value.clone()]).map_err(wrong)?;
        }
        let bar = model::bar("preparing", 100);
        let model = model::prepare(instance.slave().config().clone(), &self.resources, &self.cache, &bar)?;
        bar.finish_and_clear();
        instance.parts().0.offer_model(model);
        instance.enter_initialization().map_err(failed)?;
        Ok(instance)
    }
}
