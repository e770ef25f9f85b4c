//! What is done once with a solution: histories move on, loads and power are taken, the traction is read off.

use super::iterate::{ActiveSetScratch, Iterate, copy};
use crate::contact::line::observe;
use crate::contact::line::power::Power;
use crate::contact::line::slopes::Slopes;
use crate::multistep::History;

impl Iterate<'_> {
    /// Moves the histories on and reads off the traction.
    pub(super) fn finish(self) {
        let rim_velocity = self.rim_velocity();
        let Self { grid, problem, state, traction, scratch, frame, .. } = self;
        let [wheel, rail] = &traction.surface;
        let push = |history: &mut History, value: f64| match problem.time.is_stationary() {
            true => *history = History::constant(value),
            false => history.push(&problem.time, value),
        };
        for (i, history) in state.tangential_gap.iter_mut().enumerate() {
            let port = grid.port(i);
            push(history, wheel[port] - rail[port]);
        }
        push(&mut state.rim_angle, frame.rim_angle);
        for (body, sign) in [(0, 1.0), (1, -1.0)] {
            let loads = &mut traction.loads[body];
            copy(loads, &traction.port_forces);
            *loads *= sign;
            scratch.pull[body].iter().enumerate().for_each(|(i, pull)| loads[grid.port(i)] += pull);
        }
        let ActiveSetScratch { swelling, membrane, centred_slip: slip, .. } = &*scratch;
        let late = scratch.retarded.force;
        let power =
            Power { grid, traction: &*traction, frame: &frame, rim_velocity, slip, swelling, membrane, late: late[1] };
        let [friction, work] = power.friction(&problem.time, &mut state.friction);
        let power = traction.dissipate(friction, work, problem.duration);
        let slopes =
            Slopes { grid, gap: &state.gap, overlap: &scratch.overlap, dents: &scratch.dents, depth: &scratch.depth };
        traction.resultant = observe::resultant(problem.radius(), &frame, slopes, traction);
        traction.resultant[2] -= problem.radius() * late.iter().sum::<f64>();
        observe::overlap(grid, state, &scratch.overlap, traction);
        let moving = if problem.time.is_stationary() { 0.0 } else { 1.0 };
        traction.springing_work = moving * observe::springing_work(grid, &scratch.overlap, &scratch.limit, traction);
        let pressures = scratch.limit.iter().enumerate().map(|(i, force)| force / grid.width(i));
        let limit = pressures.reduce(f64::max).unwrap_or(f64::INFINITY);
        observe::read_off(grid, (power, limit), state, &scratch.centred_slip, traction);
    }
}
