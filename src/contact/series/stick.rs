//! The search for the places where slip begins.

use super::contact::{MOST_LINES, SeriesContact};
use super::series_line::SeriesLine;
use super::state::{Past, PatchPast, SeriesState, Tractions};
use crate::axes::{Axis, PerAxis};
use crate::contact::error::ContactError;
use crate::multistep::TimeDerivative;

/// Shortest stretch that sticks, over the half-width of the patch \[1].
const SHORTEST: f64 = 2e-3;
/// Force above friction where it sticks, over all friction, that counts as an error of the series \[1].
const OVERSHOOT: f64 = 1e-3;
/// Force over friction that does \[1].
const ROUND_OFF: f64 = 1e-9;
/// Slip against the direction of friction, over that at which rolling becomes sliding, that does \[1].
const BACKWARD: f64 = 5e-3;
/// Times that slip and stick, or the directions of slip, change.
const CHANGES: usize = 6;
/// Change of the length of stick that says something about how the root depends on it, over all changes of the
/// iteration before: beside larger ones the root changes for other reasons \[1].
const TELLING: f64 = 0.2;
/// Share of the root that a step along the slope leaves if the slope is wrong \[1].
const LEFT: f64 = 0.2;
/// Root over friction at the peak of the pressure below which all sticks, whatever direction slip would have \[1].
const NEITHER: f64 = 1e-10;
/// Smallest step that says something without that \[1]: roots after shorter ones are noise of the other changes.
const LONG: f64 = 1e-6;
/// Smallest step over the change of the pressure after which a wrong slope is noticed \[1].
const NOTICED: f64 = 10.0;

/// Largest relative change expected of a further iteration that ends them; changes fall about as they fell last.
const TOLERANCE: f64 = 1e-10;
/// Largest change of the share in a step that is expected to go on \[1]: beyond, slip comes and goes.
const EXPECTED: f64 = 0.05;
/// Share of stick or slip at which it is \[1].
const SURE: f64 = 0.1;
/// Change of an iteration over that of the first one, at most: a step that is like the last one needs no more to know.
const FIRST: f64 = 0.1;
/// Largest relative change after which one is expected.
const SMALL: f64 = 1e-7;
/// Largest relative change that ends them where rounding allows no more.
const ROUNDING: f64 = 1e-9;
/// Iterations of the normal problem before those of both, and the change that makes them needless.
const WARM: usize = 3;
const CLOSE: f64 = 1e-3;
/// Iterations of normal and tangential problem.
const MOST: usize = 30;

/// Finds tractions and motions.
pub fn solve(contact: &mut SeriesContact) -> Result<(), ContactError> {
    for line in &mut contact.lines {
        line.place_pressure();
        line.place_shear();
    }
    contact.displace();
    let mut normal = contact.press()?;
    for _ in 1..WARM {
        if normal < CLOSE {
            break;
        }
        normal = contact.press()?;
    }
    let mut search = Search::new(contact);
    // Normal and tangential problem improve each other by turns: a change falls as that before the last one did.
    let mut last = [f64::INFINITY; 2];
    for _ in 0..MOST {
        let tangential = search.advance(contact, normal)?;
        let change = normal.max(tangential);
        let settled = is_settled(change, last);
        last = [change, last[0]];
        if settled {
            if search.check(contact)? {
                return Ok(());
            }
            last = [f64::INFINITY; 2];
        }
        normal = contact.press()?;
    }
    Err(ContactError::Unsuited { reason: "normal and tangential contact do not settle" })
}

/// The searches on all lines.
struct Search {
    lines: Vec<StickSearch>,
}

impl Search {
    fn new(contact: &mut SeriesContact) -> Self {
        let lines = contact.lines.iter_mut().map(StickSearch::new).collect();
        Self { lines }
    }

    /// Improves shear and motions after a relative change `normal` of the pressure; returns the largest relative change,
    /// infinite where a search begins anew: how changes fall is not known then.
    fn advance(&mut self, contact: &mut SeriesContact, normal: f64) -> Result<f64, ContactError> {
        let before = Motions::of(contact);
        let mut halves = [None; MOST_LINES];
        for ((half, search), line) in halves.iter_mut().zip(&self.lines).zip(&contact.lines) {
            *half = search.share.map(|share| share * line.tractions.pressure.half_width);
        }
        if halves.iter().all(Option::is_none) {
            contact.glide()?;
            return Ok(before.moved(contact));
        }
        let (mut roots, mut forces) = ([0.0; MOST_LINES], [0.0; MOST_LINES]);
        forces.iter_mut().zip(&contact.lines).for_each(|(force, line)| *force = line.tractions.stick.total());
        let count = contact.lines.len();
        contact.stick(&halves[..count], &mut roots)?;
        let (moved, mut largest) = (before.moved(contact), 0.0_f64);
        let lines = contact.lines.iter_mut().zip(&mut self.lines);
        for ((line, search), (root, force)) in lines.zip(roots.into_iter().zip(forces)) {
            largest = largest.max(search.improve(line, root, (force, normal, moved))?);
        }
        Ok(largest)
    }

    /// True if the solution obeys friction on every line; `false`: the search has to go on.
    fn check(&mut self, contact: &mut SeriesContact) -> Result<bool, ContactError> {
        let mut obeyed = true;
        contact.exchange();
        for (line, search) in contact.lines.iter_mut().zip(&mut self.lines) {
            obeyed &= search.check(line)?;
            line.slope = search.slope(line);
        }
        Ok(obeyed)
    }
}

/// Motions before an iteration.
struct Motions {
    rigid: PerAxis<f64>,
    rim_angles: [f64; MOST_LINES],
    /// Slip at which rolling becomes sliding [m/s].
    scale: f64,
}

impl Motions {
    fn of(contact: &SeriesContact) -> Self {
        let mut rim_angles = [0.0; MOST_LINES];
        rim_angles.iter_mut().zip(&contact.lines).for_each(|(angle, line)| *angle = line.rim_angle);
        let scale = |it: &SeriesLine| {
            it.speed() * it.friction.max(1e-6) * it.tractions.pressure.half_width / it.problem.line.surfaces.radius
        };
        let scale = contact.lines.iter().map(scale).fold(0.0, f64::max);
        Self { rigid: contact.lines[0].rigid, rim_angles, scale }
    }

    /// Change of motions and turn relative to the slip at which rolling becomes sliding.
    fn moved(&self, contact: &SeriesContact) -> f64 {
        let first = &contact.lines[0];
        let (radius, a0) = (first.problem.line.radius(), first.problem.line.time.a0);
        let change = |axis: Axis| axis.arm(radius) * (first.rigid[axis] - self.rigid[axis]).abs();
        let moved: f64 = Axis::along().map(change).sum();
        let turned = contact.lines.iter().zip(self.rim_angles).map(|(line, before)| (line.rim_angle - before).abs());
        let turned = radius * a0 * turned.fold(0.0, f64::max);
        // Velocities are rounded.
        (moved + turned) / self.scale.max(1e-3 * first.speed())
    }
}

/// True if the `change` of an iteration after the `last` two is the last one that counts.
fn is_settled(change: f64, [last, before]: [f64; 2]) -> bool {
    let falls = |from: f64| if from.is_finite() { (change / from).min(1.0) } else { FIRST };
    change * falls(last) <= TOLERANCE
        || change <= SMALL && last * falls(before) <= TOLERANCE
        || change <= ROUNDING && change >= last
}

/// Length of a step over that of the step before \[1]; zero where that says nothing.
fn step_ratio(time: &TimeDerivative) -> f64 {
    // `a1 = −(1 + r)/Δt` and `a2 = r²/((1 + r) Δt)`.
    let share = (-time.a2 / time.a1).sqrt();
    if share > 0.0 { share / (1.0 - share) } else { 0.0 }
}

/// The search on one line.
struct StickSearch {
    /// Half-length of the stretch that sticks over that of the patch; `None`: all slips.
    share: Option<f64>,
    /// Share and root of the evaluation before.
    last: Option<[f64; 2]>,
    /// Change of the root per change of the share.
    slope: f64,
    /// Largest relative change in the iteration before.
    moving: f64,
    changes: usize,
    /// Once the part that sticks would have carried more than friction.
    torn: bool,
}

impl StickSearch {
    fn new(it: &mut SeriesLine) -> Self {
        let (tractions, mu) = (&mut it.tractions, it.friction);
        let ratio = mu / tractions.slide.abs();
        if ratio.is_finite() {
            tractions.stick.terms.iter_mut().for_each(|term| *term *= ratio);
        }
        let share = (!tractions.slides()).then(|| Self::expected(tractions, it.before, &it.problem.line.time));
        let sign = if tractions.slide < 0.0 { -1.0 } else { 1.0 };
        tractions.slide = sign * mu;
        let share = share.filter(|_| mu > 0.0).map(|share| share.clamp(SHORTEST, 1.0));
        let known = it.slope;
        let slope = Self::quasistatic(it) * if known > 0.0 { known } else { 1.0 };
        Self { share, last: None, slope, moving: 0.0, changes: 0, torn: false }
    }

    /// Share that is expected: it goes on changing as it did in the last step.
    fn expected(now: &Tractions, before: &SeriesState, time: &TimeDerivative) -> f64 {
        let share = |tractions: &Tractions| tractions.stick.half_width / tractions.pressure.half_width;
        match &before.past[1] {
            Past::Patch(PatchPast { tractions: earlier, .. }) if earlier.same_branch(now) && !earlier.slides() => {
                let change = step_ratio(time) * (share(now) - share(earlier));
                // Where nearly all or nothing sticks, slip may come from the other side or go.
                let steady = change.abs() <= EXPECTED && (SURE..=1.0 - SURE).contains(&(share(now) + change));
                share(now) + if steady { change } else { 0.0 }
            }
            Past::Patch(..) | Past::Grid(..) => share(now),
        }
    }

    /// Change of the root per share in stationary rolling on half-planes: that of Carter's tractions \[Pa].
    fn quasistatic(it: &SeriesLine) -> f64 {
        it.tractions.slide * it.tractions.pressure.terms[0]
    }

    /// The slope over the quasistatic one \[1].
    fn slope(&self, it: &SeriesLine) -> f64 {
        let slope = self.slope / Self::quasistatic(it);
        if slope.is_finite() { slope } else { 0.0 }
    }

    /// Improves the length of stick after a solution with a `root`; returns the largest relative change, infinite where
    /// the search begins anew. The stretch that sticks had the `force` [N/m] before; pressures have changed by `normal`
    /// and motions by `moved` \[1].
    fn improve(
        &mut self,
        it: &mut SeriesLine,
        root: f64,
        (force, normal, moved): (f64, f64, f64),
    ) -> Result<f64, ContactError> {
        let Some(share) = self.share else { return Ok(moved) };
        if let Some([other, there]) = self.last
            && let moved = (share - other).abs()
            && (moved > LONG.max(TELLING * self.moving) || moved > NOTICED * normal && (root / there).abs() > LEFT)
        {
            let slope = (root - there) / (share - other);
            if slope * self.slope > 0.0 && slope.is_finite() {
                self.slope = slope;
            }
        }
        self.last = Some([share, root]);
        let peak = it.friction * it.tractions.pressure.terms[0];
        let next = share - root / self.slope;
        let lasting = root.abs() > peak * NEITHER.max(LEFT * self.moving);
        if next >= 1.0 && share >= 1.0 && lasting {
            // Sticking everywhere asks for slip in the other direction, and not for the changes of other lines alone; the
            // shear stays as it is.
            let Tractions { pressure, slide, stick } = &mut it.tractions;
            stick.terms.iter_mut().zip(&pressure.terms).for_each(|(q, p)| *q += 2.0 * *slide * p);
            *slide = -*slide;
            self.turn_over(it, Some(1.0))?;
            return Ok(f64::INFINITY);
        }
        if next < SHORTEST && share <= SHORTEST {
            self.turn_over(it, None)?;
            return Ok(f64::INFINITY);
        }
        let next = next.clamp((0.3 * share).max(SHORTEST), 1.0);
        self.share = Some(next);
        let change = (root / peak).abs().max((next - share).abs());
        let force = (it.tractions.stick.total() - force).abs() / (it.friction * it.load());
        self.moving = change.max(force).max(moved);
        Ok(self.moving)
    }

    fn turn_over(&mut self, it: &mut SeriesLine, share: Option<f64>) -> Result<(), ContactError> {
        self.changes += 1;
        if self.changes > CHANGES {
            return Err(ContactError::Unsuited { reason: "stick and slip change places" });
        }
        (self.share, self.last, self.slope) = (share, None, Self::quasistatic(it));
        Ok(())
    }

    /// True if the solution obeys friction; `false`: the search has to go on.
    fn check(&mut self, it: &mut SeriesLine) -> Result<bool, ContactError> {
        it.slips = it.slip(&it.slipping().0, &it.surface, true);
        if it.friction == 0.0 {
            return Ok(true);
        }
        let slide = it.tractions.slide;
        let scale = it.speed() * it.friction * it.tractions.pressure.half_width / it.problem.line.surfaces.radius;
        let backward = |slip: &&f64| *slip * slide.signum() > BACKWARD * scale;
        let looked_at = || it.slips.iter().step_by(3);
        let wrong = looked_at().filter(backward).count();
        if it.tractions.slides() && wrong > 0 {
            if self.torn {
                return Err(ContactError::Unsuited { reason: "slip at the leading edge" });
            }
            if wrong == looked_at().count() {
                it.tractions.slide = -slide;
                self.turn_over(it, None)?;
            } else {
                self.turn_over(it, Some(0.3))?;
            }
            return Ok(false);
        }
        if Self::is_torn(it) {
            // Where next to nothing sticks all of it may slip; otherwise it slips at the leading edge, too.
            if std::mem::replace(&mut self.torn, true) {
                return Err(ContactError::Unsuited { reason: "more than friction where it sticks" });
            }
            self.turn_over(it, None)?;
            return Ok(false);
        }
        if wrong > 0 {
            return Err(ContactError::Unsuited { reason: "slip against friction" });
        }
        Ok(true)
    }

    /// True if the part that sticks carries more than friction would.
    fn is_torn(it: &SeriesLine) -> bool {
        if it.tractions.slides() {
            return false;
        }
        let Tractions { pressure, slide, stick } = &it.tractions;
        let places = &it.stuck.x;
        let (shear, bears) = (it.tractions.shear(places), pressure.density(places));
        let beyond = |q: usize| (shear[q].abs() - it.friction * bears[q]).max(0.0) * it.constants.tables.weights[q];
        let excess = stick.half_width * (0..places.len()).map(beyond).sum::<f64>();
        let (total, limit) = (slide * pressure.total() + stick.total(), it.friction * pressure.total());
        excess > OVERSHOOT * limit || total.abs() > limit * (1.0 + ROUND_OFF)
    }
}
