//! The search for the places where slip begins.

use super::coefficients::FrictionSearches;
use super::contact::{MOST_LINES, SeriesContact};
use super::series_line::SeriesLine;
use super::state::Tractions;
use crate::axes::{Axis, PerAxis};
use crate::contact::error::ContactError;

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
/// Share of the root that a step along the slope leaves if the slope is wrong \[1].
const LEFT: f64 = 0.2;
/// Root over friction at the peak of the pressure below which all sticks, whatever direction slip would have \[1].
const NEITHER: f64 = 1e-10;
/// Smallest change of the length of stick that says how the root depends on it \[1]; over the change of the pressure
/// meanwhile, too: roots after shorter ones are those of other changes.
const LONG: f64 = 1e-6;
const NOTICED: f64 = 10.0;
/// Largest change of the length of stick, over this length, that is a step of Newton's method \[1].
const NEAR: f64 = 0.02;
/// Proposed changes of the length over the right ones beyond which they ring \[1].
const RINGING: f64 = 1.3;
/// Change of the root with the share, over that of Carter's tractions, with which it is one \[1].
const BELIEVED: std::ops::Range<f64> = 0.2..5.0;
/// Error that a pass leaves, over its changes of pressures, motions and places where slip begins \[1]: pressures follow shears,
/// and shears pressures, one pass behind.
const BEHIND: f64 = 0.03;

/// Largest relative error that a solution with one direction leaves, and that of one with two \[1]: friction forces are off by
/// about twice as much. In equilibria, which others improve from solution to solution, it is smaller.
const LEFT_OVER: f64 = 1e-10;
const LEFT_OF_SHEAR: f64 = 1e-8;
const AT_REST: f64 = 1e-12;
/// Largest change that ends it where rounding allows no more.
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
    let mut normal = contact.press_under_shear(WARM, CLOSE)?;
    let (mut search, mut settling) = (Search::new(contact), Settling::by_errors(contact));
    let (mut coefficients, mut friction) = (FrictionSearches::new(contact), 0.0_f64);
    // Normal and tangential problem improve each other by turns, and friction with them.
    for _ in 0..coefficients.rounds(MOST) {
        let error = settling.error(normal, search.advance(contact, normal.max(friction))?);
        friction = coefficients.follow(contact, error)?;
        if settling.is_last(error.max(friction)) && search.check(contact)? {
            if coefficients.settle(contact)? {
                return Ok(());
            }
            search.begin_anew();
        }
        normal = contact.press()?;
    }
    Err(ContactError::Unsuited { reason: "normal and tangential contact do not settle" })
}

impl SeriesContact<'_> {
    /// Improves the pressure under the present shear at most `most` times, until its relative change is `close` enough \[1];
    /// returns the last one.
    pub fn press_under_shear(&mut self, most: usize, close: f64) -> Result<f64, ContactError> {
        let mut change = self.press()?;
        for _ in 1..most {
            if change < close {
                break;
            }
            change = self.press()?;
        }
        Ok(change)
    }
}

/// When iterations end.
pub struct Settling {
    tolerance: f64,
    /// Change of the last iteration.
    last: f64,
}

impl Settling {
    /// An end by the errors that iterations leave.
    pub fn by_errors(contact: &SeriesContact) -> Self {
        Self::within(LEFT_OVER, contact)
    }

    /// An end by the errors that iterations with shear at points in one or two `directions` leave.
    pub fn of_shear(contact: &SeriesContact, directions: usize) -> Self {
        Self::within(if directions == 1 { LEFT_OVER } else { LEFT_OF_SHEAR }, contact)
    }

    fn within(tolerance: f64, contact: &SeriesContact) -> Self {
        let stationary = contact.lines[0].problem.line.time.is_stationary();
        Self { tolerance: if stationary { AT_REST } else { tolerance }, last: f64::INFINITY }
    }

    /// Error that an iteration leaves, by the relative change of the pressure and the change or error of all else \[1].
    pub fn error(&self, normal: f64, tangential: f64) -> f64 {
        tangential.max(BEHIND * normal)
    }

    /// True if an error is the last one that counts.
    pub fn is_last(&mut self, change: f64) -> bool {
        let last = std::mem::replace(&mut self.last, change);
        change <= self.tolerance || change <= ROUNDING && change >= last
    }
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

    /// Improves shear and motions after a relative change `normal` of the pressure; returns the largest relative error that is
    /// left, infinite where a search begins anew: how errors fall is not known then.
    fn advance(&mut self, contact: &mut SeriesContact, normal: f64) -> Result<f64, ContactError> {
        let before = Motions::of(contact);
        let mut halves = [None; MOST_LINES];
        for ((half, search), line) in halves.iter_mut().zip(&self.lines).zip(&contact.lines) {
            *half = search.share.map(|share| share * line.tractions.pressure.half_width);
        }
        if halves.iter().all(Option::is_none) {
            contact.glide()?;
            return Ok(BEHIND * before.moved(contact));
        }
        let mut roots = [0.0; MOST_LINES];
        let count = contact.lines.len();
        contact.stick(&halves[..count], &mut roots)?;
        let (moved, mut left) = (before.moved(contact), 0.0_f64);
        let lines = contact.lines.iter_mut().zip(&mut self.lines);
        for ((line, search), root) in lines.zip(roots) {
            left = left.max(search.improve(line, root, [normal, moved])?);
            line.place_shear();
        }
        contact.displace();
        Ok(left)
    }

    /// Forgets what is of other friction coefficients.
    fn begin_anew(&mut self) {
        for line in &mut self.lines {
            (line.last, line.proposed, line.changes, line.torn) = (None, None, 0, false);
        }
    }

    /// True if the solution obeys friction on every line; `false`: the search has to go on.
    fn check(&mut self, contact: &mut SeriesContact) -> Result<bool, ContactError> {
        let mut obeyed = true;
        contact.find_slips();
        for (line, search) in contact.lines.iter_mut().zip(&mut self.lines) {
            obeyed &= search.check(line)?;
            line.slope = search.slope(line);
        }
        Ok(obeyed)
    }
}

/// Motions before an iteration.
pub struct Motions {
    rigid: PerAxis<f64>,
    /// Slip at which rolling becomes sliding [m/s].
    scale: f64,
}

impl Motions {
    pub fn of(contact: &SeriesContact) -> Self {
        let scale = |it: &SeriesLine| {
            let speed = it.speed() + if it.is_sideways() { it.speed_to_the_side() } else { 0.0 };
            speed * it.friction.max(1e-6) * it.tractions.pressure.half_width / it.problem.line.surfaces.radius
        };
        let scale = contact.lines.iter().map(scale).fold(0.0, f64::max);
        Self { rigid: contact.lines[0].rigid, scale }
    }

    /// Change of motions relative to the slip at which rolling becomes sliding.
    pub fn moved(&self, contact: &SeriesContact) -> f64 {
        let first = &contact.lines[0];
        let change = |axis: Axis| axis.arm(first.problem.line.radius()) * (first.rigid[axis] - self.rigid[axis]).abs();
        let moved: f64 = Axis::along().map(change).sum();
        // Velocities are rounded.
        moved / self.scale.max(1e-3 * first.speed())
    }
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
    /// Last change of the length that a root proposed, and the one made \[1].
    proposed: Option<[f64; 2]>,
    /// Factor by which the last proposal was too large \[1].
    beyond: f64,
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
        let share = (!tractions.slides()).then(|| tractions.share());
        let sign = if tractions.slide < 0.0 { -1.0 } else { 1.0 };
        tractions.slide = sign * mu;
        let share = share.filter(|_| mu > 0.0).map(|share| share.clamp(SHORTEST, 1.0));
        let known = it.slope;
        let slope = Self::quasistatic(it) * if known > 0.0 { known } else { 1.0 };
        Self { share, last: None, slope, moving: 0.0, changes: 0, proposed: None, beyond: 1.0, torn: false }
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

    /// Improves the length of stick after a solution with a `root`; returns the largest relative error that is left, infinite
    /// where the search begins anew. Pressures have changed by `normal` and motions by `moved` \[1].
    fn improve(&mut self, it: &mut SeriesLine, root: f64, [normal, moved]: [f64; 2]) -> Result<f64, ContactError> {
        let Some(share) = self.share else { return Ok(BEHIND * moved) };
        if let Some([other, there]) = self.last
            && let moved = (share - other).abs()
            && (moved > LONG || (root / there).abs() > LEFT)
            && moved > NOTICED * normal
        {
            let slope = (root - there) / (share - other);
            if slope * self.slope > 0.0 && slope.is_finite() {
                self.slope = slope;
            }
        }
        self.last = Some([share, root]);
        let peak = it.friction * it.tractions.pressure.terms[0];
        if let Some(left) = self.absorb(it, root, [normal, moved]) {
            return Ok(left);
        }
        let next = share - root / self.slope;
        let lasting = root.abs() > peak * NEITHER.max(LEFT * self.moving);
        if next >= 1.0 && share >= 1.0 && lasting {
            // Sticking everywhere asks for slip in the other direction, and not for the changes of other lines alone; the
            // shear stays as it is.
            let Tractions { pressure, slide, stick, .. } = &mut it.tractions;
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
        it.restretch(next / share);
        let change = (root / peak).abs().max((next - share).abs());
        self.moving = change.max(moved);
        Ok(self.moving)
    }

    /// Takes a weak root for another length of the stretch, and returns the relative error that is left; `None`: it is not weak.
    ///
    /// A traction with its root is, to first order, one without on another length, whose slip, moments and motions are the
    /// same. So this is a step of Newton's method for all lines together.
    fn absorb(&mut self, it: &mut SeriesLine, root: f64, [normal, moved]: [f64; 2]) -> Option<f64> {
        let (share, slope) = (self.share?, it.root_by_share());
        let change = self.calmed(-root / slope, normal);
        let near = change.abs() <= NEAR * share && share + change < 1.0 && share + change > SHORTEST;
        if !near || !BELIEVED.contains(&(slope / Self::quasistatic(it))) {
            return None;
        }
        self.share = Some(share + change);
        it.absorb_root(1.0 + change / share);
        self.moving = change.abs().max(moved);
        Some((change * change / share).max(BEHIND * self.moving))
    }

    /// A proposed change of the length, in proportion to what the last one has led to where it went beyond the solution.
    fn calmed(&mut self, proposed: f64, normal: f64) -> f64 {
        let gone = |[last, step]: [f64; 2]| (step.abs() > LONG.max(NOTICED * normal)).then(|| (last - proposed) / step);
        if let Some(beyond) = self.proposed.and_then(gone) {
            self.beyond = if beyond > RINGING { beyond } else { 1.0 };
        }
        let step = proposed / self.beyond;
        self.proposed = Some([proposed, step]);
        step
    }

    fn turn_over(&mut self, it: &mut SeriesLine, share: Option<f64>) -> Result<(), ContactError> {
        self.changes += 1;
        if self.changes > CHANGES {
            return Err(ContactError::Unsuited { reason: "stick and slip change places" });
        }
        (self.share, self.last, self.slope) = (share, None, Self::quasistatic(it));
        (self.proposed, self.beyond) = (None, 1.0);
        Ok(())
    }

    /// True if the solution obeys friction; `false`: the search has to go on.
    fn check(&mut self, it: &mut SeriesLine) -> Result<bool, ContactError> {
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
        let Tractions { pressure, slide, stick, .. } = &it.tractions;
        let places = &it.stuck.x;
        let (shear, bears) = (it.tractions.shear(places), pressure.density(places));
        let beyond = |q: usize| (shear[q].abs() - it.friction * bears[q]).max(0.0) * it.constants.tables.weights[q];
        let excess = stick.half_width * (0..places.len()).map(beyond).sum::<f64>();
        let (total, limit) = (slide * pressure.total() + stick.total(), it.friction * pressure.total());
        excess > OVERSHOOT * limit || total.abs() > limit * (1.0 + ROUND_OFF)
    }
}
