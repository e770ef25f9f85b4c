//! The search for states of [`super::points`] that obey friction, on all lines together.

use super::chebyshev::{Arch, TERMS};
use super::coefficients::FrictionSearches;
use super::contact::{MOST_LINES, SeriesContact};
use super::points::{COUNT, Directions, Pivoting, PointProblem, Shears};
use super::series_line::SeriesLine;
use super::state::Tractions;
use super::stick::{self, Motions, Settling};
use super::stretch::Stretch;
use super::surface::SmoothSurfaces;
use crate::contact::error::ContactError;
use std::f64::consts::PI;

/// Changes of states that are tried.
const MOST_TRIALS: usize = 60;
/// Shortest way of the material in a step, over the half-width of the patch \[1]: below, the creepage under a held force
/// remembers every place where slip has begun, and twelve points miss it by some per cent.
const SHORTEST_WAY: f64 = 0.25;
/// Iterations of normal and tangential problem.
const MOST: usize = 30;

impl SeriesLine<'_> {
    /// True if points resolve what the line remembers.
    fn suits_points(&self) -> bool {
        let way = 0.5 * self.speed() / self.problem.line.time.a0;
        self.problem.line.time.is_stationary() || way > SHORTEST_WAY * self.before.tractions.pressure.half_width
    }

    /// States of the points in which the present tractions are.
    fn directions(&self) -> Directions {
        let (pressure, [low, high]) = (&self.tractions.pressure, self.tractions.stick.ends());
        let slides = if self.tractions.slide < 0.0 { -1 } else { 1 };
        self.tractions.directions.unwrap_or_else(|| {
            self.constants.of_points.tractions.map(|t| {
                let x = pressure.centre + self.upstream() * pressure.half_width * t;
                if x > low && x < high { 0 } else { slides }
            })
        })
    }

    /// Tractions with an arch in the place of points that stick from the leading edge on and slip in one direction behind
    /// it; `None` if they do not.
    fn as_arch(&self) -> Option<Tractions> {
        let states = self.tractions.directions?;
        let stuck = states.iter().take_while(|state| **state == 0).count();
        let sign = *states.get(stuck).unwrap_or(&1);
        if stuck == 0 && states.iter().all(|state| *state == sign) {
            let (slide, stick) = (f64::from(sign) * self.friction, Arch::default());
            return Some(Tractions { slide, stick, directions: None, ..self.tractions });
        }
        if stuck == 0 || states[stuck..].iter().any(|state| *state != sign) {
            return None;
        }
        let Tractions { pressure, stick: shear, .. } = self.tractions;
        let (slide, share) = (f64::from(sign) * self.friction, (stuck as f64 / COUNT as f64).min(0.99));
        let half_width = share * pressure.half_width;
        let centre = pressure.centre + self.upstream() * (pressure.half_width - half_width);
        let mut stick = Arch { centre, half_width, ..shear };
        // Of Carter's form, with the force of the points.
        let total = 2.0 * (shear.total() - slide * pressure.total()) / (PI * half_width);
        stick.terms = std::array::from_fn(|k| if k == 0 { total } else { 0.0 });
        Some(Tractions { slide, stick, directions: None, ..self.tractions })
    }

    /// Leaves the shear to points; it has none yet.
    fn begin_points(&mut self) {
        let terms = [0.0; TERMS];
        self.tractions.stick = Arch { count: COUNT, terms, ..self.tractions.pressure };
        self.tractions.slide = 0.0;
        self.slide_all();
    }

    fn point_problem(&self, surface: &SmoothSurfaces) -> PointProblem {
        let (tables, upstream) = (&self.constants.of_points, self.upstream());
        let Arch { centre, half_width: half, terms, .. } = self.tractions.pressure;
        let at = |t: &f64| centre + upstream * half * t;
        let x = tables.slips.each_ref().map(at);
        let density = self.tractions.pressure.density(&tables.tractions.each_ref().map(at));
        PointProblem {
            by_shear: self.slips_by_points(tables, self.problem.line.kernel.tangential),
            known: self.slip(&x, surface, false),
            powers: self.powers_at(&x),
            bears: density.map(|p| self.friction * p),
            most: self.friction * terms[0],
        }
    }

    /// Stretch over the whole patch with the given shears.
    fn stretch_of(&self, shears: &Shears) -> Stretch {
        let upstream = self.upstream();
        let solutions = shears.each_ref().map(|q| self.constants.of_points.terms_of(q, upstream));
        Stretch::new(&self.tractions.stick, self.half_length, &solutions)
    }
}

/// Finds tractions and motions: on arches where slip is one stretch in one direction on every line, else on points.
pub fn solve(contact: &mut SeriesContact) -> Result<(), ContactError> {
    // Under a layer shear begins with a slope, and ends without a root where slip begins: arches have neither.
    if contact.lines.iter().any(|line| line.problem.line.layer > 0.0) {
        return Err(ContactError::Unsuited { reason: "there is an elastic layer" });
    }
    if contact.lines.iter().all(|line| line.tractions.directions.is_none()) {
        let Err(error) = stick::solve(contact) else { return Ok(()) };
        contact.lines.iter_mut().for_each(SeriesLine::begin_anew);
        if !contact.lines.iter().all(SeriesLine::suits_points) {
            return Err(error);
        }
    } else if !contact.lines.iter().all(SeriesLine::suits_points) {
        return Err(ContactError::Unsuited {
            reason: "slip has no single beginning, and the material moves too little in the step",
        });
    }
    on_points(contact)?;
    let arches: Option<Vec<Tractions>> = contact.lines.iter().map(SeriesLine::as_arch).collect();
    let Some(arches) = arches else { return Ok(()) };
    // Points have decided, and arches are more exact.
    let found: Vec<_> = contact.lines.iter().map(|line| (line.tractions, line.rigid)).collect();
    contact.lines.iter_mut().zip(arches).for_each(|(line, arch)| line.tractions = arch);
    if stick::solve(contact).is_ok() {
        return Ok(());
    }
    for (line, (tractions, rigid)) in contact.lines.iter_mut().zip(found) {
        (line.tractions, line.rigid) = (tractions, rigid);
    }
    on_points(contact)
}

/// Finds tractions and motions from the states of points in which the present tractions are.
fn on_points(contact: &mut SeriesContact) -> Result<(), ContactError> {
    for line in &mut contact.lines {
        line.place_pressure();
        line.place_shear();
    }
    contact.displace();
    let states: Vec<Directions> = contact.lines.iter().map(SeriesLine::directions).collect();
    contact.lines.iter_mut().zip(states).for_each(|(line, states)| line.tractions.directions = Some(states));
    let (mut normal, mut settling) = (contact.press()?, Settling::new(contact));
    let mut coefficients = FrictionSearches::new(contact);
    for _ in 0..coefficients.rounds(MOST) {
        let before = Motions::of(contact);
        let terms =
            |contact: &SeriesContact| -> Vec<_> { contact.lines.iter().map(|it| it.tractions.stick.terms).collect() };
        let sheared = terms(contact);
        find_states(contact)?;
        let change = contact.lines.iter().zip(&sheared).map(|(line, before)| {
            let most = line.friction * line.tractions.pressure.terms[0];
            let changes = line.tractions.stick.terms.iter().zip(before).map(|(new, old)| (new - old).abs());
            changes.fold(0.0, f64::max) / most.max(f64::MIN_POSITIVE)
        });
        let change = change.fold(before.moved(contact), f64::max);
        let error = settling.error(normal, change);
        if settling.is_last(error.max(coefficients.follow(contact, error)?)) {
            contact.find_slips();
            if coefficients.settle(contact)? {
                return Ok(());
            }
        }
        normal = contact.press()?;
    }
    Err(ContactError::Unsuited { reason: "normal contact and that of points do not settle" })
}

/// Finds the states of all points under the present pressures, with shear and motions.
fn find_states(contact: &mut SeriesContact) -> Result<(), ContactError> {
    let mut pivoting = Pivoting::default();
    for _ in 0..MOST_TRIALS {
        let asked = contact.try_states()?;
        let states = contact.lines.iter_mut().filter_map(|line| line.tractions.directions.as_mut());
        if !pivoting.change(states.zip(&asked)) {
            return Ok(());
        }
    }
    Err(ContactError::Unsuited { reason: "the states of points go in circles" })
}

impl SeriesContact<'_> {
    /// Finds shear and motions with the present states of points; returns those that friction asks for.
    fn try_states(&mut self) -> Result<Vec<Directions>, ContactError> {
        self.lines.iter_mut().for_each(SeriesLine::begin_points);
        self.exchange();
        let surface = self.surface();
        let mut found: Vec<(PointProblem, Directions, Shears)> = Vec::with_capacity(MOST_LINES);
        for line in &self.lines {
            let (problem, states) = (line.point_problem(&surface), line.directions());
            let shears = problem.shears(&states);
            let shears = shears.ok_or(ContactError::Unsuited { reason: "the equations of points are singular" })?;
            found.push((problem, states, shears));
        }
        let stretch = |(line, (.., shears)): (&SeriesLine, &(_, _, Shears))| Some(line.stretch_of(shears));
        let stretches: Vec<_> = self.lines.iter().zip(&found).map(stretch).collect();
        let slips = self.share(&stretches)?;
        let mut asked = Vec::with_capacity(self.lines.len());
        for (((line, stretch), slips), (problem, states, shears)) in
            self.lines.iter_mut().zip(&stretches).zip(&slips).zip(&found)
        {
            let mut shear = shears[0];
            for (value, by) in slips.iter().zip(&shears[1..]) {
                shear.iter_mut().zip(by).for_each(|(q, by)| *q -= value * by);
            }
            asked.push(problem.asked(states, &shear, slips));
            if let Some(stretch) = stretch {
                line.take(&stretch.tractions(slips));
            }
            line.place_shear();
        }
        self.displace();
        Ok(asked)
    }
}
