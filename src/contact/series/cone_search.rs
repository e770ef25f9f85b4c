//! The search for the shear of all lines along and across: Newton's method on the law of [`super::cone`], all lines at once.

use super::across::Vectors;
use super::chebyshev::{Arch, TERMS};
use super::cone::{ConeAnswer, ConeProblem, SLIPS, Verdict};
use super::contact::{MOST_LINES, SeriesContact};
use super::places::total;
use super::points::COUNT;
use super::series_line::SeriesLine;
use super::stick::{Motions, Settling};
use super::together::Answer;
use crate::axes::PerAxis;
use crate::contact::error::ContactError;
use crate::contact::flexibility::polynomial;

/// Iterations of normal and tangential problem.
const MOST: usize = 40;
/// Violation of friction that ends Newton's method \[1], and the share of the last change of the pressure that does.
const TOLERANCE: f64 = 1e-12;
const ROUGHEST: f64 = 1e-2;
const SHARE: f64 = 0.03;
/// Steps of Newton's method that are tried whole, and with a search along each.
const WHOLE: usize = 12;
const SEARCHED: usize = 30;
/// Share of the promised fall of the violations that a step has to keep, and the shortest step \[1].
const KEPT: f64 = 0.1;
/// Violation of friction that ends searches on the way \[1].
const ROUGH: f64 = 1e-4;
/// Rounds of a search that draws the shear to the one before, and how strongly it begins to \[1].
const ROUNDS: usize = 16;
const DRAG: f64 = 1.0;
/// Share of the correction below which a search does without \[1].
const LEAST_SHARE: f64 = 0.3;
/// Violations of friction that end a search where whole steps, and where all else has failed \[1].
const UNSEEN: [f64; 2] = [1e-5, 5e-3];
/// Relative difference of violations that repeat themselves \[1].
const REPEATED: f64 = 1e-6;
const SHORTEST: f64 = 0.01;

/// Finds tractions and motions of lines that slip along and across.
pub fn solve(contact: &mut SeriesContact) -> Result<(), ContactError> {
    let mut search = ConeSearch::new(contact);
    search.write(contact);
    let (mut normal, mut settling) = (contact.press()?, Settling::new(contact));
    let mut moved = f64::INFINITY;
    for _ in 0..MOST {
        let before = Motions::of(contact);
        let change = search.advance(contact, [normal, moved])?;
        moved = before.moved(contact);
        if settling.is_last(normal, moved.max(change)) {
            search.finish(contact);
            return Ok(());
        }
        normal = contact.press()?;
    }
    Err(ContactError::Unsuited { reason: "normal contact and that of points along and across do not settle" })
}

/// Ways to search for a first shear.
#[derive(Clone, Copy)]
enum Search {
    Whole,
    Along,
    Drawn,
}

/// Shears, slips by all but the known ones, and motions.
type Begun = (Vec<Vectors>, Vec<[f64; SLIPS]>, PerAxis<f64>);

/// Shear of all lines: without the correction of the slips, and with it.
struct ConeSearch {
    uncorrected: Vec<Vectors>,
    /// Motions without the correction less those with it.
    uncorrected_motion: PerAxis<f64>,
    shears: Vec<Vectors>,
    states: Vec<[i8; COUNT]>,
    /// Radius of the discs at the peak of the pressure to which the shears belong \[Pa].
    most: Vec<f64>,
    /// True until a first correction has been found.
    first: bool,
    /// Share of the correction: whole but where no shear is found with that.
    share: f64,
}

/// The tangential problem of all lines under given pressures, and where the search is in it.
struct Newton<'a> {
    problems: &'a mut [ConeProblem],
    /// Motions of the known slip.
    base: PerAxis<f64>,
    shears: Vec<Vectors>,
    /// Slips by all but the known one, as polynomials.
    slips: Vec<[f64; SLIPS]>,
    /// Present motions.
    rigid: PerAxis<f64>,
    verdicts: Vec<Verdict>,
}

impl ConeSearch {
    /// Begins with the last tractions.
    fn new(contact: &mut SeriesContact) -> Self {
        let shear = |line: &SeriesLine| match line.tractions.directions {
            Some(_) => line.points_of([&line.tractions.stick, &line.tractions.lateral]),
            None => [[0.0; COUNT]; 2],
        };
        let shears: Vec<_> = contact.lines.iter().map(shear).collect();
        let most = contact.lines.iter().map(|line| line.before_friction * line.tractions.pressure.terms[0]);
        Self {
            uncorrected: shears.clone(),
            uncorrected_motion: PerAxis::default(),
            shears,
            states: vec![[0; COUNT]; contact.lines.len()],
            most: most.collect(),
            first: true,
            share: 1.0,
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

    /// Finds shear and motions under the present pressures, the last change of which was `normal`, while motions have `moved`
    /// in the last round; returns the largest violation of friction before, none where it has stayed unseen.
    fn advance(&mut self, contact: &mut SeriesContact, [normal, moved]: [f64; 2]) -> Result<f64, ContactError> {
        let mut problems = contact.cone_problems();
        for (k, (line, problem)) in contact.lines.iter().zip(&problems).enumerate() {
            let (now, most) = (line.friction * line.tractions.pressure.terms[0], self.most[k]);
            let ratio = if most > 0.0 { now / most } else { 1.0 };
            for shear in [&mut self.uncorrected[k], &mut self.shears[k]] {
                *shear = problem.within(shear, ratio);
            }
            self.most[k] = now;
        }
        let tolerance = (SHARE * normal).clamp(TOLERANCE, ROUGHEST);
        let moved = moved > TOLERANCE && contact.free_axes().next().is_some();
        let mut newton = Newton::new(contact, &mut problems);
        newton.take(contact, &self.uncorrected, self.uncorrected_motion);
        let mut violation = newton.largest();
        newton.run(contact, tolerance, moved)?;
        self.uncorrected.clone_from(&newton.shears);
        let (motion, found, corrections) = (newton.rigid, newton.now(), newton.corrections());
        newton.correct(self.share, &corrections);
        if !std::mem::replace(&mut self.first, false) {
            newton.take(contact, &self.shears, PerAxis::default());
        }
        violation = violation.max(newton.largest());
        while let Err(error) = newton.run(contact, tolerance, moved) {
            if self.share == 0.0 {
                return Err(error);
            }
            newton.correct(-self.share, &corrections);
            self.share = if self.share > LEAST_SHARE { 0.5 * self.share } else { 0.0 };
            newton.correct(self.share, &corrections);
            newton.restart(&found);
        }
        self.uncorrected_motion = PerAxis::from_fn(|axis| motion[axis] - newton.rigid[axis]);
        let left = newton.largest();
        self.shears = newton.shears;
        self.states = newton.verdicts.iter().map(Verdict::states).collect();
        let rigid = newton.rigid;
        contact.lines.iter_mut().for_each(|line| line.rigid = rigid);
        self.write(contact);
        // What is left unseen stays from round to round.
        let stays = left > tolerance && violation <= UNSEEN[1];
        Ok(if stays { 0.0 } else { violation })
    }

    /// Takes the slips of the solution.
    fn finish(&self, contact: &mut SeriesContact) {
        contact.exchange();
        for line in &mut contact.lines {
            let (places, _) = line.slipping();
            line.slips = line.slip(&places, &line.surface, true);
            line.across.slips = line.lateral_slip(&places, true);
        }
    }
}

impl<'a> Newton<'a> {
    fn new(contact: &SeriesContact, problems: &'a mut [ConeProblem]) -> Self {
        let rigid = contact.lines[0].rigid;
        Self { problems, base: rigid, shears: vec![], slips: vec![], rigid, verdicts: vec![] }
    }

    /// Goes on from given shears, with motions that differ from those of the known slip by `motion`.
    fn take(&mut self, contact: &mut SeriesContact, shears: &[Vectors], motion: PerAxis<f64>) {
        contact.lines.iter_mut().for_each(|line| line.rigid = self.base);
        let moments: Vec<_> = self.problems.iter().zip(shears).map(|(problem, shear)| problem.moments(shear)).collect();
        let contact = &*contact;
        let slips = |at: usize| {
            let mut sum = [0.0; SLIPS];
            for (by, moments) in moments.iter().enumerate() {
                let slips = polynomial(&ConeAnswer::between(contact, [at, by]), moments);
                sum.iter_mut().zip(slips).for_each(|(sum, slip)| *sum += slip);
            }
            for axis in contact.free_axes() {
                let slips = ConeAnswer::by_motion(&contact.lines[at], axis);
                sum.iter_mut().zip(slips).for_each(|(sum, slip)| *sum += motion[axis] * slip);
            }
            sum
        };
        self.slips = (0..self.problems.len()).map(slips).collect();
        self.shears = shears.to_vec();
        self.rigid = PerAxis::from_fn(|axis| self.base[axis] + motion[axis]);
        self.verdicts = self.judge(&self.shears, &self.slips);
    }

    fn judge(&self, shears: &[Vectors], slips: &[[f64; SLIPS]]) -> Vec<Verdict> {
        self.problems.iter().zip(shears).zip(slips).map(|((problem, q), slips)| problem.verdict(q, slips)).collect()
    }

    /// Largest violation of friction \[1].
    fn largest(&self) -> f64 {
        self.verdicts.iter().map(|verdict| verdict.largest).fold(0.0, f64::max)
    }

    /// Goes on until friction is violated by no more than the `tolerance`: by whole steps, or else with a search along
    /// steps, or drawn to the shear before in every round. Where a single point neither sticks nor slips, next to
    /// the pole of a spin, what is left of it has no more to tell; so a violation that nobody sees is a solution, too.
    fn run(&mut self, contact: &mut SeriesContact, tolerance: f64, moved: bool) -> Result<(), ContactError> {
        let begun = self.now();
        let mut best = (self.largest(), begun.clone());
        for (search, unseen) in [(Search::Whole, UNSEEN[0]), (Search::Along, UNSEEN[1]), (Search::Drawn, UNSEEN[1])] {
            let found = match search {
                Search::Whole => self.steps(contact, tolerance, (WHOLE, false, moved), &mut best),
                Search::Along => self.steps(contact, tolerance, (SEARCHED, true, moved), &mut best),
                Search::Drawn => self.approach(contact, tolerance, &mut best),
            };
            if found {
                return Ok(());
            }
            if best.0 <= unseen {
                self.restart(&best.1);
                return Ok(());
            }
            self.restart(&begun);
        }
        Err(ContactError::Unsuited { reason: "the shear of points along and across is not found" })
    }

    /// Present shears, slips and motions.
    fn now(&self) -> Begun {
        (self.shears.clone(), self.slips.clone(), self.rigid)
    }

    /// Begins anew with shears, slips and motions.
    fn restart(&mut self, begun: &Begun) {
        (self.shears, self.slips, self.rigid) = begun.clone();
        self.verdicts = self.judge(&self.shears, &self.slips);
    }

    /// Corrections of the slips by those in the places of the present shear.
    fn corrections(&self) -> Vec<Vectors> {
        let all = self.problems.iter().zip(&self.shears).zip(&self.slips);
        all.map(|((problem, shear), slips)| problem.correction(shear, slips)).collect()
    }

    /// Corrects the known slips by a share.
    fn correct(&mut self, share: f64, corrections: &[Vectors]) {
        self.problems.iter_mut().zip(corrections).for_each(|(problem, slips)| problem.add(share, slips));
        self.verdicts = self.judge(&self.shears, &self.slips);
    }

    /// Draws the shear to that before, round by round; true if whole steps find the solution from one of these shears on.
    fn approach(&mut self, contact: &mut SeriesContact, tolerance: f64, best: &mut (f64, Begun)) -> bool {
        let draw = |newton: &mut Self, drag: f64| {
            newton.problems.iter_mut().zip(&newton.shears).for_each(|(problem, shear)| problem.draw(drag, shear));
            newton.verdicts = newton.judge(&newton.shears, &newton.slips);
        };
        let mut drag = DRAG;
        for _ in 0..ROUNDS {
            let begun = self.now();
            draw(self, drag);
            let drawn = self.steps(contact, ROUGH, (WHOLE, false, false), &mut (0.0, Begun::default()));
            if !drawn {
                self.restart(&begun);
                drag *= 8.0;
            }
            draw(self, 0.0);
            let begun = self.now();
            if drawn && self.steps(contact, tolerance, (WHOLE, false, false), best) {
                return true;
            }
            self.restart(&begun);
        }
        false
    }

    /// True if at most `most` steps were enough, of which one is taken in any case if motions may have `moved`; the iterate
    /// that violates friction least becomes the `best`.
    fn steps(
        &mut self,
        contact: &mut SeriesContact,
        tolerance: f64,
        (most, search, mut moved): (usize, bool, bool),
        best: &mut (f64, Begun),
    ) -> bool {
        let mut before = [f64::INFINITY; 2];
        for _ in 0..most {
            let largest = self.largest();
            if largest <= tolerance && !moved {
                return true;
            }
            // Two states that ask for each other have the same violations again and again.
            if (largest / before[0] - 1.0).abs() < REPEATED || self.step(contact, search).is_none() {
                return false;
            }
            (before, moved) = ([before[1], largest], false);
            if self.largest() < best.0 {
                *best = (self.largest(), self.now());
            }
        }
        self.largest() <= tolerance
    }

    /// One step; `None`: there is none.
    fn step(&mut self, contact: &mut SeriesContact, search: bool) -> Option<()> {
        contact.newton_steps += 1;
        let answers = self.problems.iter().zip(&self.verdicts).map(|(problem, verdict)| problem.answer(verdict));
        let answers: Vec<_> = answers.collect();
        if answers.iter().any(Option::is_none) {
            return None;
        }
        contact.lines.iter_mut().for_each(|line| line.rigid = self.base);
        let found: [_; MOST_LINES] = contact.share(&answers).ok()?;
        let (rigid, slips) = (contact.lines[0].rigid, &found[..answers.len()]);
        let shears: Vec<_> = answers.iter().flatten().zip(slips).map(|(answer, slips)| answer.shear(slips)).collect();
        let squares = |verdicts: &[Verdict]| verdicts.iter().map(|verdict| verdict.squares).sum::<f64>();
        let before = squares(&self.verdicts).sqrt();
        let mut part = 1.0;
        loop {
            let mix = |old: f64, new: f64| old + part * (new - old);
            let mut tried = self.shears.clone();
            for (old, new) in
                tried.as_flattened_mut().as_flattened_mut().iter_mut().zip(shears.as_flattened().as_flattened())
            {
                *old = mix(*old, *new);
            }
            let mut moved = self.slips.clone();
            for (old, new) in moved.as_flattened_mut().iter_mut().zip(slips.as_flattened()) {
                *old = mix(*old, *new);
            }
            let verdicts = self.judge(&tried, &moved);
            let enough = squares(&verdicts).sqrt() <= before * (1.0 - KEPT * part);
            if !search || enough || part < SHORTEST {
                let rigid = PerAxis::from_fn(|axis| mix(self.rigid[axis], rigid[axis]));
                (self.shears, self.slips, self.rigid, self.verdicts) = (tried, moved, rigid, verdicts);
                return self.largest().is_finite().then_some(());
            }
            part *= 0.5;
        }
    }
}

impl SeriesContact<'_> {
    /// Problems of all lines, which have no shear from now on.
    fn cone_problems(&mut self) -> Vec<ConeProblem> {
        self.lines.iter_mut().for_each(SeriesLine::release_points);
        self.exchange();
        let surface = self.surface();
        self.lines.iter().map(|line| line.cone_problem(&surface)).collect()
    }
}

impl SeriesLine<'_> {
    /// Shear at the points of two series on the patch.
    fn points_of(&self, series: [&Arch; 2]) -> Vectors {
        let (tables, upstream) = (&self.constants.of_points, self.upstream());
        series.map(|series| {
            let on_unit = Arch { centre: 0.0, half_width: 1.0, ..*series };
            on_unit.density(&tables.tractions.map(|t| upstream * t))
        })
    }

    /// Takes the shear at all points.
    fn take_points(&mut self, shear: &Vectors) {
        let (tables, upstream) = (&self.constants.of_points, self.upstream());
        let [along, across] = shear.each_ref().map(|shear| {
            let terms = tables.terms_of(shear, upstream);
            Arch { count: COUNT, terms: std::array::from_fn(|k| terms[k]), ..self.tractions.pressure }
        });
        (self.tractions.stick, self.tractions.lateral, self.tractions.slide) = (along, across, 0.0);
        self.place_shear();
        let (places, force) = self.slipping_across();
        self.across.powers = self.powers_at(&places).map(|power| total(&power, &force));
    }

    /// Takes all shear away, but its places.
    fn release_points(&mut self) {
        let none = Arch { count: COUNT, terms: [0.0; TERMS], ..self.tractions.pressure };
        (self.tractions.stick, self.tractions.lateral, self.tractions.slide) = (none, none, 0.0);
        self.across.powers = Default::default();
        self.slide_all();
    }
}
