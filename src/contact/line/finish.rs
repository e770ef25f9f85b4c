//! End of a solution: histories move on, loads and power are taken, the traction is read off.

use super::contact_line::ContactLine;
use super::observe::{self, WheelShape};
use super::power::Power;
use super::slopes::Slopes;
use super::vectors::copy;
use crate::contact::flexibility::at;
use crate::multistep::History;

/// Moves the histories of a line on and reads off its traction.
pub fn finish(line: ContactLine) {
    let (rim_velocity, load) = (line.rim_velocity(), line.load_of_all());
    let ContactLine {
        grid,
        problem,
        given,
        others,
        state,
        history,
        traction,
        energy,
        frame,
        retarded,
        overlap,
        lift,
        centred_slip: slip,
        displaced,
        ..
    } = line;
    let [wheel, rail] = &traction.surface;
    let push = |values: &mut History, value: f64| match problem.time.is_stationary() {
        true => *values = History::constant(value),
        false => values.push(&problem.time, value),
    };
    for (i, gap) in state.tangential_gap.iter_mut().enumerate() {
        let port = grid.port(i);
        let by_lines = problem.patch.map_or(0.0, |patch| at(&others.field.displacement, &patch.powers(grid.x[i])));
        push(gap, wheel[port] - rail[port] + by_lines);
    }
    *energy = 0.5 * others.moments.iter().zip(&others.field.displacement).map(|(moment, by)| moment * by).sum::<f64>();
    push(&mut history.rim_angle, frame.rim_angle);
    for (body, sign) in [(0, 1.0), (1, -1.0)] {
        let loads = &mut traction.loads[body];
        copy(loads, &traction.port_forces);
        *loads *= sign;
        given.layers.pull[body].iter().enumerate().for_each(|(i, pull)| loads[grid.port(i)] += pull);
    }
    let power = Power {
        grid,
        traction: &*traction,
        frame: &frame,
        rim_velocity,
        slip: slip.as_slice(),
        layers: &given.layers,
        retarded: retarded.force[1],
    };
    let [friction, work] = power.friction(&problem.time, &mut history.friction);
    let power = traction.friction.dissipate(friction, work, problem.duration);
    let slopes = Slopes { grid, gap: &state.gap, overlap, rail_slope: &given.rail_slope, depth: &given.depth };
    observe::lift(grid, problem, &traction.port_forces, load, lift, displaced);
    let wheel = WheelShape { radius: problem.radius(), frame: &frame, surface: &traction.surface[0], lift };
    traction.resultant = observe::resultant(wheel, slopes, traction);
    traction.resultant.rotation -= problem.radius() * retarded.force.iter().sum::<f64>();
    observe::overlap(grid, state, overlap, traction);
    let limits = &given.strength.limit;
    traction.yielding.springing_work = observe::springing_work(grid, overlap, limits, traction);
    let pressures = limits.iter().enumerate().map(|(i, force)| force / grid.width(i));
    let limit = pressures.reduce(f64::max).unwrap_or(f64::INFINITY);
    observe::read_off(grid, power, limit, state, slip, traction);
}
