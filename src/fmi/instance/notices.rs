//! What a user should know although no call fails: each of it is said once in a run, by name, with what to do.

use super::Instance;
use super::warned::Subject;
use crate::config::{Config, Given, display_number};
use crate::fmi::log::Status;
use crate::fmi::presets;
use crate::fmi::settings::{of_preset, start_value};
use crate::fmi::variable::{Access, Causality, Kind, Value, Variable};
use crate::fmi::variables::{find, variables};
use crate::simulation::plausibility::{cold, unusual};
use crate::simulation::{Inputs, Outputs, Rotation, Simulation, Translation, Vertical};

/// Values that a message names, of those that it counts.
const NAMED: usize = 3;
/// Difference of an input without effect from what it would have to be \[1], up to which it is taken for a copy of that.
const COPIED: f64 = 1e-3;
/// Speed \[m/s] from which a wheel that turns against its travel is worth a word.
const TRAVELS: f64 = 0.5;

impl Instance {
    /// Warns of parameters and inputs that were written and do not act as they stand, and of values that look like another unit.
    pub(super) fn warn_of_settings(&mut self) {
        self.warn_of_preset();
        self.warn_of_start_values();
        self.warn_of_creepage();
        let parameters = self.parameters.iter().filter_map(|(reference, value)| Some((find(*reference)?, value)));
        let found: Vec<_> =
            parameters.filter_map(|(row, value)| Some((row, wrong_unit(row, value, &self.base)?))).collect();
        for (row, text) in found {
            self.warn_once(Subject::Unit, row, &text);
        }
    }

    /// Start values of the description are those of the default preset: who writes them back overrides any other one.
    fn warn_of_preset(&self) {
        if self.preset == presets::DEFAULT || self.config.initial.given == Given::Written {
            return;
        }
        let now = |row: &Variable| of_preset(row, &self.config);
        let inputs = self.given();
        let inputs = inputs.iter().filter(|(reference, value)| {
            find(**reference)
                .is_some_and(|row| is_used(row, &self.effective_inputs()) && now(row).as_ref() != Some(*value))
        });
        let overriding = self.parameters.iter().chain(inputs).filter_map(|(reference, value)| {
            let row = find(*reference)?;
            let preset = of_preset(row, &self.base)?;
            let overrides = start_value(row).as_ref() == Some(value) && preset != *value;
            overrides.then(|| format!("{} = {} (preset: {})", row.name, shown(row, value), shown(row, &preset)))
        });
        let overriding: Vec<_> = overriding.collect();
        if !overriding.is_empty() {
            let text = format!(
                "{} that were written with their declared start values, which are those of preset \"{}\", override preset \"{}\": \
                 {}; leave them out to have the values of the preset",
                counted(overriding.len(), "value"),
                presets::DEFAULT,
                self.preset,
                listed(&overriding)
            );
            self.log.report(Status::Warning, &text);
        }
    }

    /// Inputs that were written with their declared start values follow from the parameters.
    fn warn_of_start_values(&self) {
        let mut inputs = self.effective_inputs();
        let given = self.given();
        let dropped = self.inputs.iter().filter_map(|(reference, value)| {
            let row = find(*reference).filter(|_| !given.contains_key(reference))?;
            let now = row.input(&mut inputs)?;
            let differs = now != *value && is_used(row, &inputs);
            differs.then(|| format!("{} = {}, now {}", row.name, shown(row, value), shown(row, &now)))
        });
        let dropped: Vec<_> = dropped.collect();
        if !dropped.is_empty() {
            let text = format!(
                "{} that were written with their declared start values count as not given and follow from the parameters: {}; \
                 set initial.given = written to start with what is written",
                counted(dropped.len(), "input"),
                listed(&dropped)
            );
            self.log.report(Status::Warning, &text);
        }
    }

    /// A creepage of zero may be meant. Who writes back start values writes `initial.given` as well.
    fn warn_of_creepage(&self) {
        let set = |name: &str| named(name).is_some_and(|row| self.parameters.contains_key(&row.reference));
        if set("initial.creepage") && self.config.initial.creepage.is_none() && !set("initial.given") {
            let text = "initial.creepage = 0 is its declared start value and counts as not given: the run starts with the \
                        creepage that drive.moment and drive.force need; set initial.given = written to start with a creepage \
                        of 0, or to changed to confirm";
            self.log.report(Status::Warning, text);
        }
    }

    /// Warns of inputs of the coming step that have no effect, and of those that look like another unit.
    pub(super) fn warn_of_inputs(&mut self, inputs: &Inputs) {
        let Some(simulation) = &self.simulation else { return };
        let mut held = simulation.latest_inputs().drive;
        let (mut present, base) = (*inputs, Inputs::rolling(&self.config));
        let mut found = Vec::new();
        for reference in self.inputs.keys() {
            let Some(row) = find(*reference) else { continue };
            let (Access::RealInput(field), Some(Value::Real(value))) = (row.access, row.input(&mut present)) else {
                continue;
            };
            let follows = *field(&mut { base }.drive) == value || start_value(row) == Some(Value::Real(value));
            if let Some(why) = idle(row.name, inputs, &self.config)
                && !follows
                && !is_reaction(row, value, simulation.outputs(), inputs)
            {
                let shown = shown(row, &Value::Real(value));
                found.push((Subject::Idle, row, format!("{} = {shown} has no effect: {why}", row.name)));
            } else if cold(row.name, row.kind, value).is_some() || *field(&mut held) == value {
                // A ramp passes small values; what is held is meant.
                let text = wrong_unit(row, &Value::Real(value), &self.config);
                found.extend(text.map(|text| (Subject::Unit, row, text)));
            }
        }
        for (subject, row, text) in found {
            self.warn_once(subject, row, &text);
        }
    }

    /// Warns of a wheel that its moment turns against its travel.
    pub(super) fn warn_of_reversal(&mut self, inputs: &Inputs) {
        let Some(outputs) = self.simulation.as_ref().map(Simulation::outputs) else { return };
        let (velocity, omega, moment) = (outputs.wheel_velocity, outputs.wheel_omega, inputs.drive.moment);
        let rim = self.config.wheel.radius * omega;
        let driven = inputs.rotation == Rotation::Moment && moment * omega > 0.0;
        if driven && velocity.abs() > TRAVELS && rim.abs() > TRAVELS && velocity * omega < 0.0 {
            let text = format!(
                "drive.moment = {} N.m turns the wheel against its travel, at {} rad/s: a moment drives a wheel that it has \
                 stopped on; to brake it set brake.torque instead, which holds a wheel at rest",
                display_number(moment),
                display_number(omega)
            );
            if let Some(row) = named("drive.moment") {
                self.warn_once(Subject::Reversal, row, &text);
            }
        }
    }

    /// Warns of limits of the model that the run is beyond now, of each once in a run.
    pub(super) fn warn_of_limits(&mut self) {
        let Some(simulation) = &self.simulation else { return };
        let new: Vec<_> = simulation.exceeded_limits().filter(|limit| !self.warned.of_limit(*limit)).collect();
        for limit in new {
            self.warned.add_limit(limit);
            let text = simulation.describe_limit(limit);
            self.log.report(Status::Warning, &format!("t = {:?} s: {text}", self.time));
        }
    }

    fn warn_once(&mut self, subject: Subject, row: &Variable, text: &str) {
        if self.warned.is_new(subject, row.reference) {
            self.log.report(Status::Warning, &format!("t = {:?} s: {text}", self.time));
        }
    }
}

fn named(name: &str) -> Option<&'static Variable> {
    variables().iter().find(|row| row.name == name)
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

/// What is wrong with a number that looks like one of another unit; `usual` has the values that are usual.
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

/// Whether the choices between partners let an input act.
fn is_used(row: &Variable, inputs: &Inputs) -> bool {
    partner(row.name, inputs).is_none()
}

/// Why an input has no effect, and what to do about it.
fn idle(name: &str, inputs: &Inputs, config: &Config) -> Option<String> {
    if !config.thermal.enabled && ["drive.tread_heat", "rail.temperature"].contains(&name) {
        return Some("temperatures are not computed; set thermal.enabled = true".to_owned());
    }
    let [control, present, selected, wanted] = partner(name, inputs)?;
    let meaning = if name == "brake.torque" { "to let the brake act" } else { "to prescribe it" };
    Some(format!(
        "{control} = {present} prescribes {selected}; set {control} = {wanted} {meaning}, or leave it at its start value"
    ))
}

/// The choice that takes its effect from an input: its name, its item, the input that it selects, and the item which
/// would select this one.
fn partner(name: &str, inputs: &Inputs) -> Option<[&'static str; 4]> {
    let chosen = match name {
        "drive.omega" => {
            (inputs.rotation == Rotation::Moment, ["control.rotation", "moment", "drive.moment", "velocity"])
        }
        "drive.moment" | "brake.torque" => {
            (inputs.rotation == Rotation::Velocity, ["control.rotation", "velocity", "drive.omega", "moment"])
        }
        "drive.velocity" => {
            (inputs.translation == Translation::Force, ["control.translation", "force", "drive.force", "velocity"])
        }
        "drive.force" => (
            inputs.translation == Translation::Velocity,
            ["control.translation", "velocity", "drive.velocity", "force"],
        ),
        "drive.load" | "drive.load_change" => (
            inputs.vertical == Vertical::Displacement,
            ["control.vertical", "displacement", "drive.displacement", "force"],
        ),
        "drive.displacement" => {
            (inputs.vertical == Vertical::Force, ["control.vertical", "force", "drive.load", "displacement"])
        }
        _ => return None,
    };
    chosen.0.then_some(chosen.1)
}

/// Whether an input without effect is a copy of the reaction, as masters hand it back.
fn is_reaction(row: &Variable, value: f64, outputs: &Outputs, inputs: &Inputs) -> bool {
    let reaction = match row.name {
        "drive.omega" => outputs.wheel_omega,
        "drive.moment" => outputs.hub_moment,
        "drive.velocity" => outputs.wheel_velocity,
        "drive.force" => outputs.hub_force_x,
        "drive.load" => -outputs.hub_force_y - inputs.drive.load_change,
        "drive.load_change" => -outputs.hub_force_y - inputs.drive.load,
        "drive.displacement" => outputs.hub_height,
        _ => return false,
    };
    (value - reaction).abs() <= COPIED * value.abs().max(reaction.abs())
}
