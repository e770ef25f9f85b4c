//! Warnings of what a user should know although no call fails: each is given once in a run, by name, with a remedy.

use super::partners::{idle, is_reaction, is_used};
use crate::config::Config;
use crate::display::display_number;
use crate::fmi::presets;
use crate::fmi::settings::{Settings, of_preset, start_value};
use crate::fmi::table::{find, named};
use crate::fmi::variable::{Access, Causality, Kind, Reference, Value, Variable};
use crate::simulation::mistaken_units::{cold, unusual};
use crate::simulation::validity::Limit;
use crate::simulation::{Inputs, Outputs, Simulation};
use wheelrail_slave::{Life, Log, Status};

/// Share of the heat by which a patch of another width warms the bodies otherwise that is worth a word \[1].
const WARMS_OTHERWISE: f64 = 0.05;
/// Factor between the pressure by the width that is set and that of the preset that is worth a word \[1].
const FAR_PRESSURE: f64 = 2.0;
/// Values that a message names, of those that it counts.
const NAMED: usize = 3;
/// Speed \[m/s] from which a wheel that turns against its travel is worth a word.
const TRAVELS: f64 = 0.5;

/// Subject of a warning about a variable.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Subject {
    /// A value of another unit.
    Unit,
    /// An input without effect.
    Idle,
    /// A moment that drives a wheel backwards.
    Reversal,
}

/// Warnings that have been given in a run.
#[derive(Default)]
pub(super) struct Notices {
    limits: Vec<Limit>,
    /// Subjects, with the variable that each is about.
    subjects: Vec<(Subject, Reference)>,
    /// Inputs that had a value of usual size, each with the largest one: their unit is known, and a smaller value is meant.
    sized: Vec<(Reference, f64)>,
    /// Inputs that acted, each with its last value then: one that another control leaves as it was is no mistake.
    acted: Vec<(Reference, f64)>,
    /// Least and largest distance at which the wheel has been \[m].
    way: [f64; 2],
    /// Least and largest height at which the hub has been \[m].
    heights: Option<[f64; 2]>,
}

impl Notices {
    /// Warns of parameters and inputs that were written and do not act as they stand, and of values that look like
    /// another unit.
    pub fn of_settings(&mut self, settings: &Settings, config: &Config, life: &Life) {
        let texts = [
            of_preset_values(settings, config),
            of_start_values(settings, config),
            of_creepage(settings, config),
            of_load(settings, config),
            of_width(settings, config),
            of_idle_rows(settings, config),
            of_idle_sideways(settings, config),
            of_rows_load(settings, config),
        ];
        texts.into_iter().flatten().for_each(|text| life.log().report(Status::Warning, &text));
        for (reference, value) in &settings.parameters {
            if let Some(row) = find(*reference)
                && let Some(text) = wrong_unit(row, value, &settings.base)
            {
                self.once(Subject::Unit, row, life.time(), &text, life.log());
            }
        }
    }

    /// Warns of inputs of the coming step that have no effect, and of those that look like another unit.
    pub fn of_inputs(
        &mut self,
        inputs: &Inputs,
        simulation: &Simulation,
        settings: &Settings,
        config: &Config,
        life: &Life,
    ) {
        let mut held = simulation.latest_inputs().drive;
        let (mut present, base) = (*inputs, Inputs::rolling(config));
        for reference in settings.inputs.keys() {
            let Some(row) = find(*reference) else { continue };
            let (Access::RealInput(field), Some(Value::Real(value))) = (row.access, row.input(&mut present)) else {
                continue;
            };
            let follows = *field(&mut { base }.drive) == value || start_value(row) == Some(Value::Real(value));
            let idle = idle(row.name, inputs, config);
            if idle.is_none() {
                self.acted.retain(|(known, _)| known != reference);
                self.acted.push((*reference, value));
            }
            let doubt = wrong_unit(row, &Value::Real(value), config);
            let meant = self.sized.iter().any(|(known, size)| known == reference && value.abs() <= *size);
            if doubt.is_none() && value != 0.0 && !meant {
                self.sized.retain(|(known, _)| known != reference);
                self.sized.push((*reference, value.abs()));
            }
            if let Some(why) = idle
                && !follows
                && !self.acted.contains(&(*reference, value))
                && !is_reaction(row, value, simulation.outputs(), inputs)
            {
                let text = format!("{} = {} has no effect: {why}", row.name, shown(row, &Value::Real(value)));
                self.once(Subject::Idle, row, life.time(), &text, life.log());
            } else if let Some(text) = doubt
                // A ramp passes small values; what is held is meant.
                && (cold(row.name, row.kind, value).is_some()
                    || *field(&mut held) == value && !meant)
            {
                self.once(Subject::Unit, row, life.time(), &text, life.log());
            }
        }
    }

    /// Warns of a wheel that its moment turns against its travel, at a time \[s].
    pub fn of_reversal(&mut self, inputs: &Inputs, outputs: &Outputs, config: &Config, time: f64, log: &Log) {
        let (velocity, omega, moment) = (outputs.wheel_velocity, outputs.wheel_omega, inputs.drive.moment);
        let rim = config.wheel.radius * omega;
        let driven = !inputs.rotation.prescribes_motion() && moment * omega > 0.0;
        if driven && velocity.abs() > TRAVELS && rim.abs() > TRAVELS && velocity * omega < 0.0 {
            let text = format!(
                "drive.moment = {} N.m turns the wheel against its travel, at {} rad/s: a moment drives a wheel that it has \
                 stopped on; to brake it set brake.torque instead, which holds a wheel at rest",
                display_number(moment),
                display_number(omega)
            );
            if let Some(row) = named("drive.moment") {
                self.once(Subject::Reversal, row, time, &text, log);
            }
        }
    }

    /// Warns of profiles that have gaps or lie far from the start.
    pub fn of_profiles(&self, simulation: &Simulation, log: &Log) {
        simulation.doubts_of_profiles().iter().for_each(|text| log.report(Status::Warning, text));
    }

    /// Warns of a profile that the run has not met, at its end.
    pub fn of_way(&self, simulation: &Simulation, log: &Log) {
        if let Some(text) = simulation.doubt_of_way(self.way).filter(|_| self.way != [0.0; 2]) {
            log.report(Status::Warning, &text);
        }
    }

    /// Warns of limits of the model that the run is beyond at a time \[s].
    pub fn of_limits(&mut self, simulation: &Simulation, time: f64, log: &Log) {
        let at = simulation.outputs().wheel_distance;
        self.way = [self.way[0].min(at), self.way[1].max(at)];
        let height = simulation.outputs().hub_height;
        let [lowest, highest] = self.heights.map_or([height; 2], |[low, high]| [low.min(height), high.max(height)]);
        self.heights = Some([lowest, highest]);
        let is_new = |limit: &Limit| {
            !self.limits.contains(limit) && (*limit != Limit::Energy || simulation.loses_energy(highest - lowest))
        };
        let new: Vec<_> = simulation.exceeded_limits().filter(is_new).collect();
        for limit in new {
            self.limits.push(limit);
            log.report(Status::Warning, &format!("t = {:?} s: {}", written(time), simulation.describe_limit(limit)));
        }
    }

    fn once(&mut self, subject: Subject, row: &Variable, time: f64, text: &str, log: &Log) {
        if !self.subjects.contains(&(subject, row.reference)) {
            self.subjects.push((subject, row.reference));
            log.report(Status::Warning, &format!("t = {:?} s: {text}", written(time)));
        }
    }
}

/// A time \[s] without the rounding of the sum that it is of start and step.
fn written(time: f64) -> f64 {
    format!("{time:.14e}").parse().unwrap_or(time)
}

/// Warning of declared start values, which are those of the default preset, that a master writes back under another
/// one.
fn of_preset_values(settings: &Settings, config: &Config) -> Option<String> {
    if settings.preset == presets::DEFAULT || config.initial.given.counts_start_values() {
        return None;
    }
    let (given, acting) = (settings.given(config, true), settings.inputs(config, true));
    let inputs = given.iter().filter(|(reference, value)| {
        let differs = |row| is_used(row, &acting) && of_preset(row, config).as_ref() != Some(*value);
        find(**reference).is_some_and(differs)
    });
    let overriding = settings.parameters.iter().chain(inputs).filter_map(|(reference, value)| {
        let row = find(*reference)?;
        let preset = of_preset(row, &settings.base)?;
        let overrides = start_value(row).as_ref() == Some(value) && preset != *value;
        overrides.then(|| format!("{} = {} (preset: {})", row.name, shown(row, value), shown(row, &preset)))
    });
    let overriding: Vec<_> = overriding.collect();
    (!overriding.is_empty()).then(|| {
        format!(
            "{} that were written with their declared start values, which are those of preset \"{}\", override preset \"{}\": \
             {}; leave them out to have the values of the preset",
            counted(overriding.len(), "value"),
            presets::DEFAULT,
            settings.preset,
            listed(&overriding)
        )
    })
}

/// Warning of inputs that were written with their declared start values and follow from the parameters instead.
fn of_start_values(settings: &Settings, config: &Config) -> Option<String> {
    let (given, mut inputs) = (settings.given(config, true), settings.inputs(config, true));
    let dropped = settings.inputs.iter().filter_map(|(reference, value)| {
        let row = find(*reference).filter(|_| !given.contains_key(reference))?;
        let now = row.input(&mut inputs)?;
        let differs = now != *value && is_used(row, &inputs);
        differs.then(|| format!("{} = {}, now {}", row.name, shown(row, value), shown(row, &now)))
    });
    let dropped: Vec<_> = dropped.collect();
    (!dropped.is_empty()).then(|| {
        format!(
            "{} that were written with their declared start values count as not given and follow from the parameters: {}; \
             set initial.given = written to start with what is written",
            counted(dropped.len(), "input"),
            listed(&dropped)
        )
    })
}

/// Warning of a creepage of zero, which may be meant. Who writes back start values writes `initial.given` as well.
fn of_creepage(settings: &Settings, config: &Config) -> Option<String> {
    let set = |name: &str| is_set(settings, name);
    let doubtful = set("initial.creepage") && config.initial.creepage.is_none() && !set("initial.given");
    doubtful.then(|| {
        "initial.creepage = 0 is its declared start value and counts as not given: the run starts with the creepage that \
         drive.moment and drive.force need; set initial.given = written to start with a creepage of 0, or to changed to confirm"
            .to_owned()
    })
}

/// Warning of a load at the start by which the patch has another width than that with which the bodies take up heat.
fn of_load(settings: &Settings, config: &Config) -> Option<String> {
    let (inputs, nominal) = (settings.inputs(config, true), config.model.nominal_load);
    let load = inputs.drive.load;
    let spreads = config.thermal.enabled && !config.contact.shape.is_line() && !inputs.vertical.prescribes_motion();
    let warms = libm::cbrt(nominal / load);
    let wrong = spreads && load > 0.0 && (warms - 1.0).abs() > WARMS_OTHERWISE;
    wrong.then(|| {
        config.told(&format!(
            "drive.load = {} N, but wheel and rail take up heat as under a patch that belongs to {{model.nominal_load}}: as a \
             whole they warm {warms:.2} times as much as they should; set model.nominal_load to the mean load of the run",
            display_number(load)
        ))
    })
}

/// True if a master has written a parameter.
fn is_set(settings: &Settings, name: &str) -> bool {
    named(name).is_some_and(|row| settings.parameters.contains_key(&row.reference))
}

/// Warning of rows of a patch that has another shape, and of their load.
fn of_idle_rows(settings: &Settings, config: &Config) -> Option<String> {
    if config.contact.shape.has_rows() {
        return None;
    }
    let (contact, base) = (&config.contact, &settings.base.contact);
    let idle = [("contact.rows", !contact.rows.is_empty()), ("contact.rows_load", contact.rows_load != base.rows_load)];
    let (name, _) = idle.into_iter().find(|(name, says)| *says && is_set(settings, name))?;
    Some(format!("{name} has no effect: contact.shape is another; set contact.shape = rows"))
}

/// Warning of what moves sideways under a contact that has no lateral direction.
fn of_idle_sideways(settings: &Settings, config: &Config) -> Option<String> {
    let set = config.wheel.lateral_mass > 0.0 && is_set(settings, "wheel.lateral_mass");
    (set && !config.contact.lateral)
        .then(|| "wheel.lateral_mass has no effect without lateral forces; set contact.lateral = true".to_owned())
}

/// Warning of rows whose load is not said, under a nominal load for which they may be meant.
fn of_rows_load(settings: &Settings, config: &Config) -> Option<String> {
    let (rows_load, nominal) = (config.contact.rows_load, config.model.nominal_load);
    let unsaid = is_set(settings, "contact.rows") && !is_set(settings, "contact.rows_load");
    (config.contact.shape.has_rows() && unsaid && rows_load != nominal).then(|| {
        config.told(
            "contact.rows counts as the patch under {contact.rows_load}, its default, and not under {model.nominal_load}: \
             set contact.rows_load to the load of the table",
        )
    })
}

/// Warning of a width that is not that of the patch.
fn of_width(settings: &Settings, config: &Config) -> Option<String> {
    let set = is_set(settings, "model.contact_width");
    let pressure = |config: &Config| (config.model.nominal_load / config.model.contact_width).sqrt();
    let (share, usual) = (pressure(config) / pressure(&settings.base), settings.base.model.contact_width);
    let doubtful = set && config.contact.shape.is_line() && !(1.0 / FAR_PRESSURE..FAR_PRESSURE).contains(&share);
    doubtful.then(|| {
        config.told(&format!(
            "{{model.contact_width}} gives {{model.nominal_load}} {share:.2} times the pressure of preset \"{}\", in which \
             the width is {} m: it is the width of the patch, not that of wheel or rail (thermal.rim_width, \
             thermal.head_width); two wheels have twice the width under twice the load",
            settings.preset,
            display_number(usual)
        ))
    })
}

/// The number of things, in words.
fn counted(number: usize, thing: &str) -> String {
    format!("{number} {thing}{}", if number == 1 { "" } else { "s" })
}

/// The first of some texts, and how many there are besides.
fn listed(texts: &[String]) -> String {
    let first = texts.iter().take(NAMED).cloned().collect::<Vec<_>>().join(", ");
    match texts.len().saturating_sub(NAMED) {
        0 => first,
        more => format!("{first} and {more} more"),
    }
}

/// A value with its unit, for messages.
fn shown(row: &Variable, value: &Value) -> String {
    match (row.kind, value) {
        (Kind::Real { measure, .. }, Value::Real(number)) if measure.unit != "1" => {
            format!("{} {}", display_number(*number), measure.unit)
        }
        (_, Value::Real(number)) => display_number(*number),
        (kind, value) => kind.print(value),
    }
}

/// Doubt about a number that looks like one of another unit; `usual` has the values that are usual.
fn wrong_unit(row: &Variable, value: &Value, usual: &Config) -> Option<String> {
    let Value::Real(number) = *value else { return None };
    let size = match (row.causality(), row.name) {
        (Causality::Input, "drive.load") => Some(usual.model.nominal_load),
        (Causality::Input, _) => row.kind.nominal(),
        _ => match of_preset(row, usual) {
            Some(Value::Real(size)) => Some(size),
            _ => None,
        },
    };
    cold(row.name, row.kind, number).or_else(|| unusual(row.name, row.kind, number, size?))
}
