//! Expected result of a step, and its distance from the result that was found.
//!
//! The prediction continues the line through the two states before, or the last state after a jump of the inputs. What
//! is missed is of second order in the step and larger than the error of the second-order formula.
//!
//! Four kinds of quantities are predicted, each with the scale that makes one tolerance meaningful for all:
//!
//! | quantity | scale |
//! |---|---|
//! | contact forces x, y, z | nominal load P |
//! | contact moment about the hub | P r |
//! | mean slip of the tread in the patch, x and z | `(a/r)(V + a/Δt)`, or the slip itself where that is more; 2.5 times the slip in a short step in which the brake has just locked |
//! | mean temperatures of wheel and rail in the patch | 100 K, or 2.5 times the temperature rise where that is more; without the 2.5 on a tread with dents |
//!
//! A wheel in the air has no contact forces. What acts on it besides its load are the damper and its own deformation,
//! which rings after a strike or a release and keeps some of its energy. So where the forces on the hub are given, what
//! its motion leaves of them is predicted in the place of the contact forces, on the scale of [`AIRBORNE`] loads; the
//! damper also by itself, on the scale of the load.
//!
//! With `V` the mean of travel and peripheral speed and `a` the nominal half-width, `μ(a/r)V` is the slip at which a
//! rolling wheel slides (Carter), so slip and force count alike. A slip that lasts for the step displaces the surfaces
//! by `Δt` times its value; `(a/r)a` is the displacement that breaks a standing wheel loose, over μ. So the scale holds
//! at standstill, too, and short steps need not follow what the elasticity of the patch takes up. What a prescribed
//! velocity explains of a missed slip is no error.

use crate::axes::{Axis, PerAxis};
use crate::rolling::error::StepError;
use crate::rolling::line::Line;
use crate::rolling::model::RollingModel;
use crate::rolling::state::{Controlled, State};

/// Temperature change that counts as much as the nominal load, unless the contact is hotter [K].
const WARM: f64 = 100.0;

/// Share of a temperature rise whose error counts as much as that of the same share of the nominal load, inverted \[1]: half a
/// per cent of it at the default tolerance. Likewise of the slip in the first step of a locked wheel, in which the whole change
/// counts and not what a line misses, if it is not longer than [`SWING`]. A tread with dents has hot spots that come and go:
/// there it is one.
const OWN: f64 = 2.5;

/// Step that follows the rim of a wheel whose brake has just locked, while it swings about the hub \[s].
pub const SWING: f64 = 2.5e-4;

/// Distance to the temperature without friction from which on a step may melt the contact [K].
const NEARLY_MOLTEN: f64 = 100.0;

/// Forces of the deformation in the air that count as much as a contact force of the nominal load does, over this
/// load \[1]: no contact force follows from their errors, but energy that the audit misses.
const AIRBORNE: f64 = 8.0;

/// The predicted quantities of a state.
pub fn controlled(model: &RollingModel, state: &State) -> Controlled {
    let accelerations = state.motion.accelerations();
    Controlled {
        forces: state.resultant(),
        resisting: PerAxis::from_fn(|axis| model.wheel.inertia[axis] * accelerations[axis] - state.hub.driving[axis]),
        damper: model.wheel.damper_force(state),
        slip: state.tread_slip(),
        temperatures: temperatures(state),
        velocity: state.motion.velocity.now,
        omega: state.motion.omega.now,
        lateral: state.motion.lateral.now,
    }
}

/// Distance of a quantity from the line through its values one step before and now, continued over a step of `ratio` times
/// the length.
fn missed<C>([before, now, found]: [&C; 3], ratio: f64, of: &dyn Fn(&C) -> f64) -> f64 {
    of(found) - of(now) - ratio * (of(now) - of(before))
}

/// Mean temperature rises of wheel and rail in the patch \[K].
fn temperatures(state: &State) -> [f64; 2] {
    [0, 1].map(|body| {
        state.mean_under_load(|line| line.thermal.as_ref().map_or(0.0, |thermal| thermal.loaded_mean[body]))
    })
}

/// How far an internal step was from its prediction.
#[derive(Clone, Copy, Debug, Default)]
pub struct Found {
    /// Largest deviation of the predicted forces and slip, relative to their scales \[1].
    pub error: f64,
    /// Largest deviation of the predicted temperatures, relative to theirs \[1].
    pub warming: f64,
    /// Largest deviation of a contact force, that of the moment over the radius, from its prediction [N/m].
    pub force: f64,
    /// Largest deviation of a mean temperature of the patch from its prediction \[K].
    pub temperature: f64,
    /// Change of the highest contact temperature \[K].
    pub heating: f64,
    /// Highest absolute contact temperature at the end \[K]; zero without heat.
    pub hottest: f64,
    /// True if it exceeds the bound of a molten contact, which it kept before.
    pub overheats: bool,
    /// True if it exceeds that bound at the end, and has become hotter.
    pub molten: bool,
    /// True if steel yields in the contact at the end.
    pub yields: bool,
    /// True if yielding has left dents in the tread.
    pub dented: bool,
    /// Contact was made or lost in it.
    pub strikes: bool,
    /// True if the brake holds the wheel at the end.
    pub locked: bool,
    /// True if it was the first step after a jump of the inputs: it has no history.
    pub first: bool,
    /// True if it was longer than the step before.
    pub doubled: bool,
    /// True if its heat is known.
    pub whole: bool,
    /// Length over that of the step before, zero without one \[1].
    ratio: f64,
}

impl Found {
    /// Judges the motion of the step of `dt` \[s] that led `from` one state `to` the next; the step before took `last_step`
    /// \[s]. `before` are the quantities at its beginning. Nothing is known of its heat.
    pub fn in_motion(
        model: &RollingModel,
        from: &State,
        to: &State,
        before: &Controlled,
        last_step: f64,
        dt: f64,
    ) -> Self {
        let (now, found) = (controlled(model, from), controlled(model, to));
        let first = to.clock.restarted || last_step == 0.0;
        // What the slopes of the step before explain is no error of a formula that starts afresh, either.
        let ratio = if last_step > 0.0 { dt / last_step } else { 0.0 };
        let missed = |of: &dyn Fn(&Controlled) -> f64| missed([before, &now, &found], ratio, of);
        let (load, radius) = (model.contact.nominal_line_load(), model.wheel.radius);
        let flies = !from.touches() && !to.touches();
        let of_contact = |axis: Axis| missed(&|c| c.forces[axis]).abs() / axis.arm(radius);
        let judged = |axis: Axis| match flies && !to.hub.prescribed[axis] {
            true => missed(&|c| c.resisting[axis]).abs() / (AIRBORNE * axis.arm(radius)),
            false => of_contact(axis),
        };
        let force = Axis::ALL.into_iter().map(of_contact).fold(0.0, f64::max);
        let mut error = Axis::ALL.into_iter().map(judged).fold(0.0, f64::max) / load;
        if flies {
            error = error.max(missed(&|c| c.damper).abs() / load);
        }
        // What the slip of the patch is without a patch is a convention.
        if from.touches() && to.touches() {
            let known = to.hub.prescribed.map(|prescribed| if prescribed { 1.0 } else { 0.0 });
            let explained = [
                missed(&|c| known.travel * c.velocity - known.rotation * radius * c.omega),
                missed(&|c| known.lateral * c.lateral),
            ];
            let half_width = model.contact.nominal_half_width();
            let speed = 0.5 * (found.velocity.abs() + (radius * found.omega).abs());
            let swings = first && to.hub.brake.locked && dt <= SWING * (1.0 + 1e-9);
            let own = if swings { OWN } else { 1.0 };
            let scale =
                (half_width / radius * (speed + half_width / dt)).max(own * libm::hypot(found.slip[0], found.slip[1]));
            for (k, explained) in explained.into_iter().enumerate() {
                error = error.max((missed(&|c| c.slip[k]).abs() - explained.abs()) / scale);
            }
        }
        let yields = to.lines.iter().any(|line| line.contact.traction.yielding.share > 0.0);
        let dented = to.lines.iter().any(|line| line.flattening[0].is_dented());
        let strikes = from.touches() != to.touches();
        let locked = to.hub.brake.locked;
        Self { error, force, yields, dented, strikes, locked, first, doubled: ratio > 1.5, ratio, ..Self::default() }
    }

    /// Adds what the heat of the same step tells.
    pub fn with_heat(self, model: &RollingModel, from: &State, to: &State, before: &Controlled) -> Self {
        let Some(thermal) = &model.thermal else { return Self { whole: true, ..self } };
        let [mut warming, mut temperature] = [0.0f64; 2];
        // Nor is there a temperature of a patch without one.
        if from.touches() && to.touches() {
            let (now, found) = (temperatures(from), temperatures(to));
            let own = if self.dented { 1.0 } else { OWN };
            for body in 0..2 {
                let missed = missed([&before.temperatures, &now, &found], self.ratio, &|rises| rises[body]);
                temperature = temperature.max(missed.abs());
                warming = warming.max(missed.abs() / WARM.max(own * found[body].abs()));
            }
        }
        let (rise, hottest) = (hottest(to) - hottest(from), thermal.reference() + hottest(to));
        let (heating, molten) = (rise.abs(), hottest > thermal.hottest() && rise > 0.0);
        let overheats = molten && hottest - rise <= thermal.hottest();
        Self { warming, temperature, heating, hottest, overheats, molten, whole: true, ..self }
    }

    /// Refuses a step that leaves the contact hotter than molten steel under friction can be.
    pub fn check(&self, model: &RollingModel) -> Result<(), StepError> {
        let highest = model.thermal.as_ref().map_or(f64::INFINITY, |thermal| thermal.hottest());
        if self.molten { Err(StepError::Overheated { temperature: self.hottest, highest }) } else { Ok(()) }
    }
}

/// True if a step from a state may melt the contact or freeze it: it is then taken again with another molten film, so that its
/// first motion tells nothing.
pub fn may_melt(model: &RollingModel, from: &State) -> bool {
    if from.lines.iter().any(|line| !line.weakening().film.is_empty()) {
        return true;
    }
    let hot = |limit: f64, reference: f64| reference + hottest(from) > limit - NEARLY_MOLTEN;
    model.thermal.as_ref().is_some_and(|thermal| hot(thermal.frictionless(), thermal.reference()))
}

/// Highest rise of temperature in the contact [K].
fn hottest(state: &State) -> f64 {
    state.largest(Line::hottest)
}
