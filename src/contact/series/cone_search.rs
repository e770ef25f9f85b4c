//! The search for the shear of all lines in D directions, along or along and across, by turns with the pressure. In two
//! directions shear is found without the correction of the slips and with it.

use super::across::Vectors;
use super::chebyshev::{Arch, TERMS};
use super::coefficients::FrictionSearches;
use super::contact::SeriesContact;
use super::places::total;
use super::points::COUNT;
use super::series_line::SeriesLine;
use super::state::{Tractions, Uncorrected};
use super::stick::{Motions, Settling};
use crate::axes::PerAxis;
use crate::contact::cone::{ConeProblem, ConeVerdict, Linearised, Newton};
use crate::contact::error::ContactError;

/// Iterations of normal and tangential problem.
const MOST: usize = 40;
/// Iterations of the normal problem at most between those of the tangential one, which take ten times as long, and the
/// relative change that ends them \[1].
const PRESSED: usize = 40;
const CLOSE: f64 = 1e-9;
/// Violation of friction that ends Newton's method \[1], in equilibria, and at most; and the share of that before which does:
/// about what the change of the pressure with the shear brings back.
const TOLERANCE: f64 = 1e-9;
const AT_REST: f64 = 1e-12;
const ROUGHEST: f64 = 1e-2;
const SHARE: f64 = 1e-3;

/// Finds tractions and motions of lines that slip in D directions.
pub fn solve<const D: usize>(contact: &mut SeriesContact) -> Result<(), ContactError> {
    let mut search = ConeSearch::<D>::new(contact);
    search.write(contact);
    let (mut normal, mut settling) = (contact.press_under_shear(PRESSED, CLOSE)?, Settling::of_shear(contact, D));
    let (mut last, mut coefficients) = (None, FrictionSearches::new(contact));
    for _ in 0..coefficients.rounds(MOST) {
        let before = Motions::of(contact);
        let violation = search.advance(contact)?;
        // The next round changes as much less than this one as this one less than the last, and far less than this one.
        let change = violation.max(before.moved(contact));
        let next = change * last.map_or(SHARE, |last: f64| (change / last).min(SHARE));
        last = Some(change.max(f64::MIN_POSITIVE));
        let error = settling.error(normal, next);
        if settling.is_last(error.max(coefficients.follow(contact, error)?)) {
            contact.find_slips();
            if coefficients.settle(contact)? {
                search.finish(contact);
                return Ok(());
            }
        }
        normal = contact.press_under_shear(PRESSED, CLOSE)?;
    }
    Err(ContactError::Unsuited { reason: "normal contact and that of points do not settle" })
}

/// Shear of all lines: without the correction of the slips, and with it.
struct ConeSearch<const D: usize> {
    uncorrected: Vec<Vectors<D>>,
    /// Motions without the correction less those with it.
    uncorrected_motion: PerAxis<f64>,
    shears: Vec<Vectors<D>>,
    states: Vec<[i8; COUNT]>,
    /// Radius of the discs at the peak of the pressure to which the shears belong \[Pa].
    most: Vec<f64>,
    /// True until a first correction has been found.
    first: bool,
    /// Violation of friction that ends Newton's method \[1].
    tolerance: f64,
    /// Linear laws of both searches.
    linear: [Option<Linearised<COUNT, D>>; 2],
}

impl<const D: usize> ConeSearch<D> {
    /// Begins with the last tractions.
    fn new(contact: &mut SeriesContact) -> Self {
        let shears: Vec<_> = contact.lines.iter().map(SeriesLine::shear_at_points).collect();
        let uncorrected = |(shear, line): (&Vectors<D>, &SeriesLine)| {
            let further = &line.across.uncorrected.shear;
            std::array::from_fn(|c| std::array::from_fn(|i| shear[c][i] + further[c][i]))
        };
        let uncorrected = shears.iter().zip(&contact.lines).map(uncorrected).collect();
        let most = contact.lines.iter().map(|line| line.before_friction * line.tractions.pressure.terms[0]);
        Self {
            uncorrected,
            uncorrected_motion: contact.lines[0].across.uncorrected.motion,
            shears,
            states: vec![[0; COUNT]; contact.lines.len()],
            most: most.collect(),
            first: true,
            tolerance: if D == 1 || contact.lines[0].problem.line.time.is_stationary() { AT_REST } else { TOLERANCE },
            linear: [None, None],
        }
    }

    /// Gives all lines the tractions of the search on their present patches.
    fn write(&self, contact: &mut SeriesContact) {
        for ((line, shear), states) in contact.lines.iter_mut().zip(&self.shears).zip(&self.states) {
            line.place_pressure();
            line.take_points(shear);
            line.tractions.directions = Some(*states);
        }
        contact.displace();
    }

    /// Finds shear and motions under the present pressures; returns the largest violation of friction and balances before.
    fn advance(&mut self, contact: &mut SeriesContact) -> Result<f64, ContactError> {
        let mut problems = contact.cone_problems();
        for (k, (line, problem)) in contact.lines.iter().zip(&problems).enumerate() {
            let (now, most) = (line.friction * line.tractions.pressure.terms[0], self.most[k]);
            let ratio = if most > 0.0 { now / most } else { 1.0 };
            for shear in [&mut self.uncorrected[k], &mut self.shears[k]] {
                *shear = problem.within(shear, ratio);
            }
            self.most[k] = now;
        }
        let mut coupling = contact.coupling();
        let mut newton = Newton::new(&mut coupling, &mut problems, &self.uncorrected, self.uncorrected_motion);
        let [without, with] = &mut self.linear;
        newton.linear = without.take();
        let mut violation = newton.largest();
        newton.run((SHARE * violation).clamp(self.tolerance, ROUGHEST))?;
        *without = newton.linear.take();
        self.uncorrected.clone_from(&newton.shears);
        if D > 1 {
            let motion = newton.rigid;
            // A first law with the correction: that without it may lead on.
            newton.linear = with.take().or_else(|| without.clone());
            newton.correct();
            // At first the shear of the step before may be farther than that without the correction.
            let begun = newton.now();
            newton.take(&self.shears);
            if std::mem::replace(&mut self.first, false) && newton.largest() > begun.largest {
                newton.restart(&begun);
            }
            let further = newton.largest();
            violation = violation.max(further);
            newton.run((SHARE * further).clamp(self.tolerance, ROUGHEST))?;
            *with = newton.linear.take();
            self.uncorrected_motion = PerAxis::from_fn(|axis| motion[axis] - newton.rigid[axis]);
        }
        self.states = newton.verdicts.iter().map(ConeVerdict::states).collect();
        contact.linear_laws += newton.linear_laws;
        let (shears, rigid) = (newton.shears, newton.rigid);
        // No shear leaves its disc, whatever the tolerance.
        self.shears = shears.iter().zip(&problems).map(|(shear, problem)| problem.within(shear, 1.0)).collect();
        contact.lines.iter_mut().for_each(|line| line.rigid = rigid);
        self.write(contact);
        Ok(violation)
    }

    /// Leaves the solution without the correction to the next step.
    fn finish(&self, contact: &mut SeriesContact) {
        for ((line, shear), uncorrected) in contact.lines.iter_mut().zip(&self.shears).zip(&self.uncorrected) {
            let mut further = Uncorrected { motion: self.uncorrected_motion, ..Uncorrected::default() };
            for (c, further) in further.shear.iter_mut().enumerate().take(D) {
                *further = std::array::from_fn(|i| uncorrected[c][i] - shear[c][i]);
            }
            line.across.uncorrected = further;
        }
    }
}

impl SeriesContact<'_> {
    /// Problems of all lines, which have no shear from now on.
    fn cone_problems<const D: usize>(&mut self) -> Vec<ConeProblem<COUNT, D>> {
        self.lines.iter_mut().for_each(SeriesLine::release_points);
        self.exchange();
        let surface = self.surface();
        self.lines.iter().map(|line| line.cone_problem(&surface)).collect()
    }
}

impl SeriesLine<'_> {
    /// Present shear at the points of the patch; none where lines begin to slip in two directions.
    fn shear_at_points<const D: usize>(&self) -> Vectors<D> {
        let (tables, Tractions { pressure, stick, lateral, directions, .. }) =
            (&self.constants.of_points, &self.tractions);
        let places = tables.tractions.map(|t| self.upstream() * t);
        if directions.is_none() {
            let mut shear = [[0.0; COUNT]; D];
            if D == 1 {
                shear[0] = self.tractions.shear(&places.map(|t| pressure.centre + pressure.half_width * t));
            }
            return shear;
        }
        std::array::from_fn(|direction| {
            let series = [stick, lateral][direction];
            Arch { centre: 0.0, half_width: 1.0, ..*series }.density(&places)
        })
    }

    /// Takes the shear at all points.
    fn take_points<const D: usize>(&mut self, shear: &Vectors<D>) {
        let (tables, upstream) = (&self.constants.of_points, self.upstream());
        let series = shear.each_ref().map(|shear| {
            let terms = tables.terms_of(shear, upstream);
            Arch { count: COUNT, terms, ..self.tractions.pressure }
        });
        (self.tractions.stick, self.tractions.slide) = (series[0], 0.0);
        self.place_shear();
        if let Some(across) = series.get(1) {
            self.tractions.lateral = *across;
            let (places, force) = self.slipping_across();
            self.across.powers = self.powers_at(&places).map(|power| total(&power, &force));
        }
    }

    /// Takes all shear away, but its places.
    fn release_points(&mut self) {
        let none = Arch { count: COUNT, terms: [0.0; TERMS], ..self.tractions.pressure };
        let lateral = if self.is_sideways() { none } else { Arch::default() };
        (self.tractions.stick, self.tractions.lateral, self.tractions.slide) = (none, lateral, 0.0);
        self.across.powers = Default::default();
        self.slide_all();
    }
}
