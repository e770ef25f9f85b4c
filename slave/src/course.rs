//! Courses of inputs over a step, and the questions to a master from which they are made.

use crate::lifecycle::Phase;
use crate::value::Reference;
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
    pub(crate) references: Vec<Reference>,
    /// Distance from a straight line that matters, of each variable.
    matters: Vec<f64>,
    pub(crate) start: f64,
    pub(crate) length: f64,
    /// Phase in which the instance was before.
    pub(crate) before: Phase,
    /// Values that hold at the time of the open question: those set last.
    pub(crate) values: Vec<f64>,
    /// Variables that the master has set at any time.
    pub(crate) set: Vec<bool>,
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
    pub(crate) fn new(
        references: Vec<Reference>,
        present: Vec<(f64, f64)>,
        (start, length): (f64, f64),
        before: Phase,
    ) -> Self {
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
    pub(crate) fn next(&mut self) -> Option<f64> {
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
    pub(crate) fn course(self) -> Course {
        let chosen: Vec<usize> = (0..self.set.len()).filter(|k| self.set[*k]).collect();
        let of = |values: &[f64]| chosen.iter().map(|k| values[*k]).collect::<Vec<_>>();
        let point = |point: &Point| Point { time: point.time * self.length, values: of(&point.values) };
        let points: Vec<_> = self.points.iter().map(point).collect();
        let references = chosen.iter().map(|k| self.references[*k]).collect();
        Course { references, points: simplified(&points, &of(&self.matters)) }
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
