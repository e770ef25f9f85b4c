//! Tolerance of an experiment.

use crate::config::Config;
use crate::fmi::settings::{Settings, TOLERANCE};
use crate::fmi::table::named;
use crate::fmi::variable::Value;
use wheelrail_slave::{Log, Status};

/// Tolerances up to this one are those of a master's own solver, which it hands on unasked: 1e-3, 1e-4 and 1e-6 are
/// usual defaults there [1].
const OF_MASTERS: f64 = 1e-3;
/// Largest meaningful tolerance [1].
const LARGEST: f64 = 1.0;

/// Takes the tolerance of an experiment.
///
/// It becomes `solver.tolerance`, unless that is set explicitly, if it was given deliberately: it is neither the one of
/// the model description, which masters hand back unasked, nor so small that it must be that of the master's own
/// solver.
pub(super) fn take_tolerance(settings: &mut Settings, given: Option<f64>, log: &Log) {
    settings.experiment.clear();
    let (Some(given), Some(parameter)) = (given, named(TOLERANCE)) else { return };
    if given == Config::default().tuning.tolerance {
        return;
    }
    if given > OF_MASTERS && given <= LARGEST {
        settings.experiment.insert(parameter.reference, Value::Real(given));
    } else if !settings.parameters.contains_key(&parameter.reference) {
        let range = format!("more than {OF_MASTERS:?}, at most {LARGEST:?}");
        let why = "smaller ones are taken for that of the master's own solver";
        log.report(
            Status::Warning,
            &format!(
                "tolerance = {given:?} is not used, because it is outside its range: {range}; {why}. Set \
                 {TOLERANCE} to ask for it"
            ),
        );
    }
}
