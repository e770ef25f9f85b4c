//! End of a solution: histories move on, loads and power are taken, the traction is read off.

use super::contact_line::{ContactLine, LineIterate};
use super::observe;
use super::vectors::copy;
use crate::multistep::History;

/// Moves the histories of a line on and reads off its traction.
pub fn finish(line: &mut ContactLine) {
    // The velocity of the rim in it is that before the histories move on.
    let [friction, work] = line.take_friction_power();
    remember(line);
    let ContactLine { grid, problem, given, traction, .. } = line;
    for (body, sign) in [(0, 1.0), (1, -1.0)] {
        let loads = &mut traction.loads[body];
        copy(loads, &traction.port_forces);
        *loads *= sign;
        given.layers.pull[body].iter().enumerate().for_each(|(i, pull)| loads[grid.port(i)] += pull);
    }
    let power = traction.friction.dissipate(friction, work, problem.duration);
    line.traction.resultant = line.resultant();
    if line.is_sideways() {
        line.traction.friction.slip_speed = line.slip_speed();
        line.traction.spin_moment = line.spin_moment();
    }
    let ContactLine { grid, given, iterate, state, traction, .. } = line;
    let LineIterate { overlap, centred_slip, across, .. } = &**iterate;
    observe::overlap(grid, state, overlap, traction);
    traction.under_film = observe::under_film(grid, state, &given.strength);
    let limits = &given.strength.limit;
    traction.yielding.springing_work = observe::springing_work(grid, overlap, limits, traction);
    let pressures = limits.iter().enumerate().map(|(i, force)| force / grid.width(i));
    let limit = pressures.reduce(f64::max).unwrap_or(f64::INFINITY);
    observe::read_off(grid, [power, limit], state, [centred_slip, &across.centred_slip], traction);
}

/// Moves the histories of displacements and rim angle on, and takes the energy that lines have by each other.
fn remember(line: &mut ContactLine) {
    let time = line.problem.time;
    let push = |values: &mut History, value: f64| match time.is_stationary() {
        true => *values = History::constant(value),
        false => values.push(&time, value),
    };
    for i in 0..line.grid.len() {
        let (port, [wheel, rail]) = (line.grid.port(i), &line.traction.surface);
        let relative = wheel[port] - rail[port] + line.moved_by_lines(i) + line.moved_by_layer(port);
        push(&mut line.state.tangential_gap[i], relative);
    }
    push(&mut line.history.rim_angle, line.frame.rim_angle);
    let others = &line.iterate.others;
    let by_lines = others.moments.iter().zip(&others.field.displacement).map(|(moment, by)| moment * by).sum::<f64>();
    *line.energy = 0.5 * by_lines + line.energy_of_layer();
    if line.is_sideways() {
        *line.energy += line.remember_across();
    }
}
