//! Values of inputs within a step, as FMI 3.0 has it: intermediate update.
//!
//! A master is asked for them before a step is computed, at a quarter, a half, three quarters and the end of the step. Where an
//! input bends more than its slave cares for, the master is asked for values in the middle of the pieces, again and again. So
//! nothing is computed while the master has control, and what it sets is kept apart until the step begins.

use crate::array_access::{ArrayAccess, check_length};
use crate::instance::Instance;
use crate::lifecycle::{Call, Phase};
use crate::log::{CallError, Outcome, Status};
use crate::value::{ElementType, Reference, Scalar};
use std::collections::VecDeque;

/// Shortest piece of a step in whose middle a master is asked, as a share of the step.
const SHORTEST: f64 = 1.0 / 32.0;

/// Values at a time.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// Time since the start of the step \[s].
    pub time: f64,
    /// Values of the variables.
    pub values: Vec<f64>,
}

/// Course of variables over a step: values at two or more times, from the start of the step to its end, straight lines between.
#[derive(Clone, Debug, PartialEq)]
pub struct Course {
    /// Variables for which the master has given values.
    pub references: Vec<Reference>,
    /// Their values, in the order of time.
    pub points: Vec<Point>,
}

/// Largest distance between value and straight line at a time between two points, over the distance that matters.
fn bend(from: &Point, at: &Point, to: &Point, matters: &[f64]) -> f64 {
    let share = (at.time - from.time) / (to.time - from.time);
    let distance = |k: usize| {
        let line = from.values[k] + share * (to.values[k] - from.values[k]);
        (at.values[k] - line).abs() / matters[k]
    };
    (0..matters.len()).map(distance).fold(0.0, f64::max)
}

/// Points without those that lie between others on a straight line.
fn simplified(points: &[Point], matters: &[f64]) -> Vec<Point> {
    let (mut kept, mut from) = (vec![points[0].clone()], 0);
    while from + 1 < points.len() {
        let straight =
            |to: &usize| (from + 1..*to).all(|at| bend(&points[from], &points[at], &points[*to], matters) <= 1.0);
        from = (from + 1..points.len()).rev().find(straight).unwrap_or(from + 1);
        kept.push(points[from].clone());
    }
    kept
}

/// Questions to a master about a step, and what it has answered.
pub(crate) struct Inquiry {
    references: Vec<Reference>,
    /// Distance from a straight line that matters, of each variable.
    matters: Vec<f64>,
    start: f64,
    length: f64,
    /// Phase in which the instance was before.
    before: Phase,
    /// Values that hold at the time of the open question: those set last.
    values: Vec<f64>,
    /// Variables that the master has set at any time.
    set: Vec<bool>,
    /// Answers in the order of time; times are shares of the step.
    points: Vec<Point>,
    /// Question that is open.
    open: Option<f64>,
    /// Questions to come.
    waiting: VecDeque<f64>,
    /// Pieces whose middles have been asked for and not looked at yet.
    pieces: Vec<[f64; 2]>,
}

impl Inquiry {
    /// Questions about a step of some length \[s]; of every variable the present value and the distance that matters are given.
    fn new(references: Vec<Reference>, present: Vec<(f64, f64)>, (start, length): (f64, f64), before: Phase) -> Self {
        let (values, matters): (Vec<f64>, Vec<f64>) = present.into_iter().unzip();
        Inquiry {
            set: vec![false; references.len()],
            points: vec![Point { time: 0.0, values: values.clone() }],
            open: None,
            waiting: VecDeque::from([0.25, 0.5, 0.75, 1.0]),
            pieces: vec![[0.0, 0.5], [0.5, 1.0]],
            references,
            matters,
            start,
            length,
            before,
            values,
        }
    }

    /// Takes the answer to the open question, and returns the next one, a share of the step.
    fn next(&mut self) -> Option<f64> {
        if let Some(time) = self.open.take() {
            let place = self.points.partition_point(|point| point.time < time);
            self.points.insert(place, Point { time, values: self.values.clone() });
        }
        if self.waiting.is_empty() {
            self.refine();
        }
        self.open = self.waiting.pop_front();
        self.open
    }

    /// Asks for more where pieces are bent.
    fn refine(&mut self) {
        let at = |time: f64| self.points.partition_point(|point| point.time < time);
        let bent = |[from, to]: &[f64; 2]| {
            let [from, middle, to] = [*from, 0.5 * (from + to), *to].map(at);
            bend(&self.points[from], &self.points[middle], &self.points[to], &self.matters) > 1.0
        };
        let halves = |[from, to]: &[f64; 2]| [[*from, 0.5 * (from + to)], [0.5 * (from + to), *to]];
        let bent = self.pieces.iter().filter(|piece| bent(piece) && piece[1] - piece[0] > SHORTEST);
        let pieces: Vec<_> = bent.flat_map(halves).collect();
        self.waiting = pieces.iter().map(|[from, to]| 0.5 * (from + to)).collect();
        self.pieces = pieces;
    }

    /// Course of the variables that the master has set.
    fn course(self) -> Course {
        let chosen: Vec<usize> = (0..self.set.len()).filter(|k| self.set[*k]).collect();
        let of = |values: &[f64]| chosen.iter().map(|k| values[*k]).collect::<Vec<_>>();
        let point = |point: &Point| Point { time: point.time * self.length, values: of(&point.values) };
        let points: Vec<_> = self.points.iter().map(point).collect();
        let references = chosen.iter().map(|k| self.references[*k]).collect();
        Course { references, points: simplified(&points, &of(&self.matters)) }
    }
}

impl<S: ArrayAccess> Instance<S> {
    /// Takes the variables that a master may set within steps; others that it names are told and left out.
    pub fn require_intermediate(&mut self, references: &[Reference]) -> Outcome {
        if let Some(first) = references.first()
            && !S::INTERMEDIATE_UPDATE
        {
            let why = "this FMU has no intermediate update (providesIntermediateUpdate = false): require no variables";
            return Err(CallError::error(format!("requiredIntermediateVariables begins with {first}, but {why}")));
        }
        let (mut chosen, others): (Vec<_>, Vec<_>) =
            references.iter().partition(|reference| S::is_intermediate(**reference));
        if let Some(first) = others.first() {
            let message = format!(
                "requiredIntermediateVariables has {} variables without intermediateUpdate = true, such as {first}: they are not \
                 accessed within steps",
                others.len()
            );
            self.log().report(Status::Warning, &message);
        }
        chosen.sort_unstable();
        chosen.dedup();
        self.intermediate = chosen;
        Ok(())
    }

    /// Begins to ask for values within a step.
    pub fn begin_inquiry(&mut self, start: f64, h: f64) -> Outcome {
        self.life().allow(Call::DoStep)?;
        self.life().check_step(start, h, S::LONGEST_STEP)?;
        let references = self.intermediate.clone();
        let (slave, life) = self.parts();
        let present = slave.present(&references, life)?;
        self.inquiry = Some(Inquiry::new(references, present, (start, h), self.life().phase()));
        Ok(())
    }

    /// Takes what the master has set since the last question and returns the time of the next one \[s]; until then the instance
    /// is in Intermediate Update Mode. `None` if there are no more questions.
    pub fn next_question(&mut self) -> Option<f64> {
        let inquiry = self.inquiry.as_mut()?;
        let time = inquiry.next().map(|share| inquiry.start + share * inquiry.length);
        let phase = if time.is_some() { Phase::Intermediate } else { inquiry.before };
        self.enter(phase);
        time
    }

    /// Keeps values of variables at the time of the open question, all or none.
    pub(crate) fn write_intermediate(
        &mut self,
        references: &[Reference],
        wanted: ElementType,
        values: Vec<Scalar>,
    ) -> Outcome {
        self.life().allow(Call::SetIntermediate)?;
        check_length("nValues", values.len(), references.len())?;
        let Some(inquiry) = &self.inquiry else { return Err(CallError::error("no value is asked for")) };
        let place = |reference: &Reference| {
            let missing = || {
                format!(
                    "{reference} is none of the inputs in requiredIntermediateVariables: only these can be set within a step"
                )
            };
            inquiry.references.binary_search(reference).map_err(|_| CallError::error(missing()))
        };
        let places = references.iter().map(place).collect::<Outcome<Vec<usize>>>()?;
        let numbers = values.into_iter().map(|value| match value {
            Scalar::Real(number) if wanted == ElementType::Float64 => Ok(number),
            _ => Err(CallError::error("only real inputs can be set within a step")),
        });
        let numbers = numbers.collect::<Outcome<Vec<f64>>>()?;
        references
            .iter()
            .zip(&numbers)
            .try_for_each(|(reference, number)| self.slave().check_present(*reference, *number))?;
        if let Some(inquiry) = &mut self.inquiry {
            for (place, number) in places.into_iter().zip(numbers) {
                (inquiry.values[place], inquiry.set[place]) = (number, true);
            }
        }
        Ok(())
    }

    /// Simulates one step, along the course for which the master has been asked if it has.
    pub fn do_step_as_asked(&mut self, start: f64, h: f64) -> Outcome {
        match self.inquiry.take().map(Inquiry::course) {
            Some(course) if !course.references.is_empty() => {
                self.step_by(start, h, |slave, life| slave.step_along(start, &course, life))
            }
            _ => self.do_step(start, h),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Course of one variable that follows `f` over a step of 2 s; a bend of 1e-3 matters. And the times that were asked for.
    fn asked(f: impl Fn(f64) -> f64) -> (Course, Vec<f64>) {
        let mut inquiry = Inquiry::new(vec![7], vec![(f(0.0), 1e-3)], (10.0, 2.0), Phase::StepComplete);
        let mut times = Vec::new();
        while let Some(share) = inquiry.next() {
            times.push(2.0 * share);
            (inquiry.values[0], inquiry.set[0]) = (f(2.0 * share), true);
        }
        (inquiry.course(), times)
    }

    #[test]
    fn a_straight_input_is_asked_for_four_times_and_has_two_points() {
        let (course, times) = asked(|t| 3.0 - 5.0 * t);
        assert_eq!(times, [0.5, 1.0, 1.5, 2.0]);
        let points = [(0.0, 3.0), (2.0, -7.0)].map(|(time, value)| Point { time, values: vec![value] });
        assert_eq!(course, Course { references: vec![7], points: points.to_vec() });
    }

    #[test]
    fn a_bent_input_is_within_the_distance_that_matters_of_its_course() {
        let f = |t: f64| (3.0 * t).sin();
        let (course, times) = asked(f);
        assert!(times.len() > 30 && times.len() < 65, "{}", times.len());
        for pair in course.points.windows(2) {
            let at = 0.5 * (pair[0].time + pair[1].time);
            let line = 0.5 * (pair[0].values[0] + pair[1].values[0]);
            assert!((f(at) - line).abs() < 3e-3, "{at}");
        }
        assert_eq!(course.points.last().map(|point| (point.time, point.values[0])), Some((2.0, f(2.0))));
    }

    #[test]
    fn an_input_with_a_kink_at_a_question_is_asked_for_no_further() {
        let (course, times) = asked(|t| (t - 1.0).abs());
        assert_eq!((times.len(), course.points.len()), (4, 3));
        assert_eq!(course.points[1], Point { time: 1.0, values: vec![0.0] });
    }

    #[test]
    fn an_input_that_jumps_is_asked_for_until_pieces_are_short() {
        let (course, times) = asked(|t| if t < 0.3 { 0.0 } else { 1.0 });
        assert!(times.len() < 16, "{times:?}");
        let jump = course
            .points
            .windows(2)
            .find(|pair| pair[0].values != pair[1].values)
            .map(|pair| [pair[0].time, pair[1].time]);
        assert!(jump.is_some_and(|[from, to]| from < 0.3 && to >= 0.3 && to - from <= 2.0 * SHORTEST), "{jump:?}");
    }

    #[test]
    fn variables_that_are_never_set_are_no_part_of_the_course() {
        let mut inquiry = Inquiry::new(vec![7, 9], vec![(1.0, 1.0), (2.0, 1.0)], (0.0, 1.0), Phase::StepComplete);
        while inquiry.next().is_some() {
            (inquiry.values[1], inquiry.set[1]) = (5.0, true);
        }
        assert_eq!(inquiry.course().references, [9]);
    }
}
