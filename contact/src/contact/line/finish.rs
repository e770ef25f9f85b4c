//! End of a solution: histories move on, loads and power are taken, the traction is read off.

use super::alone::Alone;
use super::contact_line::{ContactLine, LineIterate};
use super::grid::ContactGrid;
use super::{exchange, observe};
use nalgebra::DVector;

/// Moves the histories of all lines on and reads off their tractions.
pub fn finish(lines: &mut [ContactLine]) {
    exchange::growths(lines);
    lines.iter_mut().for_each(finish_line);
}

/// Moves the histories of a line on and reads off its traction.
fn finish_line(line: &mut ContactLine) {
    // The velocity of the rim in it is that before the histories move on.
    let [friction, work] = line.take_friction_power();
    // The displacement by the contact forces alone, which lever arms need, is that before loads are taken.
    line.traction.resultant = line.resultant();
    remember(line);
    load(line);
    let ContactLine { problem, traction, .. } = line;
    let power = traction.friction.dissipate(friction, work, problem.duration);
    if line.state.directions() > 1 {
        let [along, across] = line.mean_slips();
        line.traction.friction.slip_speed = libm::hypot(along, across);
        line.traction.friction.lateral_slip = across;
        line.traction.spin_moment = line.spin_moment();
    } else {
        line.traction.clear_across();
    }
    let to_right = line.upstream_right();
    let ContactLine { grid, given, iterate, state, traction, .. } = line;
    let LineIterate { overlap, centred_slip, .. } = &**iterate;
    observe::overlap(grid, state, overlap, traction);
    traction.under_film = observe::under_film(grid, state, &given.strength);
    let limits = &given.strength.limit;
    traction.yielding.springing_work = observe::springing_work(grid, overlap, limits, &state.forces);
    let pressures = limits.iter().enumerate().map(|(i, force)| force / grid.width(i));
    let limit = pressures.reduce(f64::max).unwrap_or(f64::INFINITY);
    let coefficient = traction.friction.coefficient;
    let friction = |i: usize| given.strength.friction(i, coefficient);
    let slips = [&*centred_slip[0], &*centred_slip[1]];
    observe::read_off(grid, ([power, limit], &friction), (state, to_right), slips, traction);
}

/// Moves the histories of displacements and rim angle on, and takes the energy that lines have by each other.
fn remember(line: &mut ContactLine) {
    *line.energy = line.energy_of_layer();
    for direction in 0..line.state.directions() {
        line.remember(direction);
        *line.energy += line.energy_of_shear(direction);
    }
    line.history.rim_angle.reach(&line.problem.time, line.frame.rim_angle);
}

/// Takes the loads on the bodies, the work of the pulls among them, and the energy of the line's own flexibility under them.
fn load(line: &mut ContactLine) {
    let ContactLine { grid, problem, given, state, before, traction, energy, iterate, .. } = line;
    let (mut loads, alone) = (Vec::new(), Alone { kernel: problem.kernel.without_reach(), grid });
    traction.pull_work = 0.0;
    if given.layers.pull.iter().chain(&before.pull).all(Vec::is_empty) {
        // Both bodies are displaced alike by the contact forces, as in the last iterate.
        **energy += iterate.own.along.dot(&state.forces);
        traction.loads = [traction.port_forces.clone(), -&traction.port_forces];
        state.pull.iter_mut().for_each(Vec::clear);
        return;
    }
    for (body, sign) in [(0, 1.0), (1, -1.0)] {
        let layers = &given.layers;
        traction.loads[body] = &traction.port_forces * sign;
        if !layers.on_ports[body].is_empty() {
            traction.loads[body] += &layers.on_ports[body];
        }
        let pulls = [&layers.pull[body], &before.pull[body]];
        let pull = |pulls: &Vec<f64>, i: usize| pulls.get(i).copied().unwrap_or(0.0);
        for i in 0..pulls[0].len().max(pulls[1].len()) {
            let (at, mean) = (grid.component(i), 0.5 * (pull(pulls[0], i) + pull(pulls[1], i)));
            traction.pull_work += mean * (state.surface[body][at] - before.surface[body][at]);
        }
        nodal_loads(grid, &state.forces, &layers.pull[body], body, &mut loads);
        let sum = |component: usize| loads.iter().skip(component).step_by(2).sum::<f64>();
        **energy += problem.kernel.energy_of_reach([0, 1].map(sum));
        alone.find(&loads, &mut iterate.own);
        **energy += 0.5 * iterate.own.work(body, &loads);
        state.pull[body].clone_from(&layers.pull[body]);
    }
}

/// Writes the forces of a line on wheel (0) or rail (1), x and y of every node [N/m].
fn nodal_loads(grid: &ContactGrid, contact: &DVector<f64>, pull: &[f64], body: usize, loads: &mut Vec<f64>) {
    let sign = if body == 0 { 1.0 } else { -1.0 };
    loads.clear();
    loads.extend(contact.iter().map(|force| sign * force));
    pull.iter().enumerate().for_each(|(i, pull)| loads[grid.component(i)] += pull);
}
