//! Pairs of inputs of which a control chooses one: the other has no effect.

use crate::config::Config;
use crate::fmi::variable::Variable;
use crate::simulation::{Drive, Inputs, Outputs};

/// Difference of an input without effect from what it would have to be \[1], up to which it is taken for a copy of
/// that.
const COPIED: f64 = 1e-3;

/// True if the choices between partners let an input act.
pub(super) fn is_used(row: &Variable, inputs: &Inputs) -> bool {
    partner(row.name, inputs).is_none()
}

/// Reason why an input has no effect, and what to do about it; `None` if it has one.
pub(super) fn idle(name: &str, inputs: &Inputs, config: &Config) -> Option<String> {
    if !config.thermal.enabled && Drive::ROWS.iter().any(|row| row.name == name && row.is_thermal()) {
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
            (!inputs.rotation.prescribes_motion(), ["control.rotation", "moment", "drive.moment", "velocity"])
        }
        "drive.moment" | "brake.torque" => {
            (inputs.rotation.prescribes_motion(), ["control.rotation", "velocity", "drive.omega", "moment"])
        }
        "drive.velocity" => {
            (!inputs.translation.prescribes_motion(), ["control.translation", "force", "drive.force", "velocity"])
        }
        "drive.force" => {
            (inputs.translation.prescribes_motion(), ["control.translation", "velocity", "drive.velocity", "force"])
        }
        "drive.load" | "drive.load_change" => {
            (inputs.vertical.prescribes_motion(), ["control.vertical", "displacement", "drive.displacement", "force"])
        }
        "drive.displacement" => {
            (!inputs.vertical.prescribes_motion(), ["control.vertical", "force", "drive.load", "displacement"])
        }
        "drive.lateral_velocity" => {
            (!inputs.lateral.prescribes_motion(), ["control.lateral", "force", "drive.lateral_force", "velocity"])
        }
        "drive.lateral_force" => {
            (inputs.lateral.prescribes_motion(), ["control.lateral", "velocity", "drive.lateral_velocity", "force"])
        }
        _ => return None,
    };
    chosen.0.then_some(chosen.1)
}

/// True if an input without effect is a copy of the reaction, as masters hand it back.
pub(super) fn is_reaction(row: &Variable, value: f64, outputs: &Outputs, inputs: &Inputs) -> bool {
    let reaction = match row.name {
        "drive.omega" => outputs.wheel_omega,
        "drive.moment" => outputs.hub_moment,
        "drive.velocity" => outputs.wheel_velocity,
        "drive.force" => outputs.hub_force_x,
        "drive.load" => -outputs.hub_force_y - inputs.drive.load_change,
        "drive.load_change" => -outputs.hub_force_y - inputs.drive.load,
        "drive.displacement" => outputs.hub_height,
        "drive.lateral_velocity" => outputs.wheel_lateral_velocity,
        "drive.lateral_force" => outputs.hub_force_z,
        _ => return false,
    };
    (value - reaction).abs() <= COPIED * value.abs().max(reaction.abs())
}
