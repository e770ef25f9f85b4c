//! Outputs of every line, across the width of the patch.

use super::line::Line;
use super::model::RollingModel;
use super::output_rows::Outputs;
use super::profile::MOST_LINES;
use super::state::State;
use super::thermal_state::ThermalState;
use crate::contact::Traction;

/// A line that is seen, in the order of the lateral position.
#[derive(Clone, Copy)]
struct Seen<'a> {
    line: &'a Line,
    /// Lateral position \[m].
    position: f64,
    /// Width \[m].
    width: f64,
}

impl Seen<'_> {
    fn traction(&self) -> &Traction {
        &self.line.contact.traction
    }
}

/// All lines of a patch: those that stand for a symmetric pair twice.
fn seen<'a>(model: &RollingModel, state: &'a State) -> Vec<Seen<'a>> {
    let (width, lateral) = (model.wheel.width, 0.5 * model.wheel.width * state.covered());
    let centre = model.contact.patch.centre(state.motion.pose.lateral);
    let of = |(line, part, side): (&'a Line, f64, f64)| Seen {
        line,
        position: centre + side * lateral * line.layout.ordinate,
        width: part * width * line.layout.share,
    };
    let lines = state.lines.iter();
    if !model.contact.patch.symmetric {
        return lines.map(|line| of((line, 1.0, 1.0))).collect();
    }
    let middle = |line: &&Line| line.layout.ordinate == 0.0;
    let pairs = |side: f64| state.lines.iter().filter(move |line| !middle(line)).map(move |line| (line, 0.5, side));
    let single = lines.filter(middle).map(|line| (line, 1.0, 1.0));
    pairs(-1.0).rev().chain(single).chain(pairs(1.0)).map(of).collect()
}

/// The line of a number from 1 on, in the order of the lateral position.
pub fn line<'a>(model: &RollingModel, state: &'a State, number: usize) -> Option<&'a Line> {
    seen(model, state).get(number.checked_sub(1)?).map(|seen| seen.line)
}

/// Fills the outputs of every line.
pub fn outputs(model: &RollingModel, state: &State, others: Outputs) -> Outputs {
    let seen = seen(model, state);
    let all = |of: &dyn Fn(&Seen) -> f64| -> Vec<f64> {
        let mut values = Vec::with_capacity(MOST_LINES);
        values.extend(seen.iter().map(of));
        values.resize(MOST_LINES, 0.0);
        values
    };
    let temperature = |of: fn(&ThermalState) -> f64| {
        all(&|seen| match (&model.thermal, &seen.line.thermal) {
            (Some(heat), Some(thermal)) => heat.reference() + of(thermal),
            _ => 0.0,
        })
    };
    Outputs {
        contact_line_count: seen.len() as u64,
        line_position: all(&|seen| seen.position),
        line_width: all(&|seen| seen.width),
        line_half_length: all(&|seen| seen.traction().half_width()),
        line_force_x: all(&|seen| seen.width * seen.traction().resultant.travel),
        line_force_y: all(&|seen| seen.width * seen.traction().resultant.height),
        line_force_z: all(&|seen| seen.width * seen.traction().resultant.lateral),
        line_tread_slip_z: all(&|seen| seen.traction().friction.lateral_slip),
        line_pressure_max: all(&|seen| seen.traction().pressure_max),
        line_stick: all(&|seen| seen.traction().stick_fraction),
        line_friction: all(&|seen| seen.traction().friction.coefficient),
        line_tread_slip: all(&|seen| seen.traction().friction.tread_slip),
        line_friction_power: all(&|seen| seen.width * seen.traction().friction.power),
        line_temperature_wheel: temperature(|thermal| thermal.temperatures.wheel_max),
        line_temperature_rail: temperature(|thermal| thermal.temperatures.rail_max),
        ..others
    }
}
