//! Permanent flattening: the overlap of yielding surfaces in a step becomes part of their shape.
//!
//! Pressure at its limit lets the surfaces overlap, and the softer one gives way. Steel that stands under the contact,
//! or moves slowly through it, keeps the overlap as a dent. Steel that rolls through keeps none: it flows forward at
//! the leading edge and back at the trailing one, and since its volume stays, the same depth all around the wheel would
//! be no dent.

use super::line::Line;
use super::model::RollingModel;
use super::standing;
use super::state::State;
use crate::piecewise::Interval;
use crate::surface::Flattening;

/// Difference of the mean temperatures of wheel and rail above which only the warmer body gives way [K].
const WARMER: f64 = 1.0;

/// Undamaged surfaces of wheel and rail.
pub fn none(model: &RollingModel) -> [Flattening; 2] {
    [Flattening::none(std::f64::consts::TAU * model.contact.surfaces.radius), Flattening::none(0.0)]
}

/// Adds the overlap of the contact in `next` to the dents of the material under every line, where the wheel has
/// travelled and turned `place` (distance \[m], angle of the hub \[rad]), and notes the work.
pub fn indent(model: &RollingModel, state: &State, place: [f64; 2], next: &mut State) {
    let passing = Passing::of(next);
    for (before, line) in state.lines.iter().zip(&mut next.lines) {
        indent_line(model, before, before.place(place), &passing, line);
    }
}

/// Adds the overlap of one line to the dents of the material at `place` (distance \[m], angle of the rim \[rad]).
fn indent_line(model: &RollingModel, state: &Line, place: [f64; 2], passing: &Passing, next: &mut Line) {
    next.flattening.clone_from(&state.flattening);
    let traction = &mut next.contact.traction;
    traction.yielding.plastic_work = 0.0;
    let whole = traction.overlap_work();
    if whole <= 0.0 {
        traction.yielding.springing_work = 0.0;
    }
    let traction = &next.contact.traction;
    let Some(patch) = traction.extent().filter(|_| !traction.yielding.overlap.is_empty()) else { return };
    let stands = passing.stand(model, patch);
    if stands == [false; 2] {
        return;
    }
    let (traction, radius) = (&mut next.contact.traction, model.contact.surfaces.radius);
    let spacing = traction.yielding.overlap.x.windows(2).map(|x| x[1] - x[0]).fold(f64::INFINITY, f64::min);
    let warmer = &state.weakening().warmer_wheel;
    for (body, at) in [place[1] * radius, place[0]].into_iter().enumerate() {
        let share = |x: f64| share(body, stands, warmer.at(x));
        let overlap = &traction.yielding.overlap;
        let mut added = overlap.clone();
        added.value.iter_mut().zip(&overlap.x).for_each(|(depth, &x)| *depth *= share(x));
        if added.value.iter().any(|depth| *depth > 0.0) {
            next.flattening[body].indent(at, &added, spacing);
        }
    }
    traction.yielding.plastic_work = traction.work_of(|x| {
        let deeper = |body: usize, at: f64| next.flattening[body].depth(at + x) - state.flattening[body].depth(at + x);
        deeper(0, place[1] * radius) + deeper(1, place[0])
    });
    if whole > 0.0 {
        traction.yielding.springing_work *= 1.0 - traction.yielding.plastic_work / whole;
    }
    next.flattening[1].forget_beyond(place[0], model.config.rail.length);
}

/// How the material of both bodies passes the contact at the end of a step.
pub struct Passing {
    /// V [m/s] and Ω [rad/s].
    speeds: [f64; 2],
    /// Length of the step \[s].
    step: f64,
}

impl Passing {
    /// That of a state.
    pub fn of(state: &State) -> Self {
        Self { speeds: [state.motion.velocity.now, state.motion.omega.now], step: state.clock.last_step }
    }

    /// Bodies, wheel and rail, whose material stays so long under a patch that it keeps a dent.
    pub fn stand(&self, model: &RollingModel, patch: Interval) -> [bool; 2] {
        let slowest = standing::slowest(patch, self.step);
        let [velocity, omega] = self.speeds;
        [omega * model.contact.surfaces.radius, velocity].map(|speed| speed.abs() < slowest)
    }
}

/// Share of the overlap that the wheel (0) or the rail (1) takes \[1], of those that stand the softer one.
fn share(body: usize, stands: [bool; 2], warmer_wheel: f64) -> f64 {
    let wheel = match stands {
        [true, true] if warmer_wheel.abs() < WARMER => 0.5,
        [true, true] if warmer_wheel > 0.0 => 1.0,
        [true, false] => 1.0,
        _ => 0.0,
    };
    if body == 0 { wheel } else { 1.0 - wheel }
}
