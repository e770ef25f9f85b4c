//! Local features: a form at its position, repeated if asked for.

use super::forms::Form;

/// Positions of a form: once, repeated, or once a turn of the wheel.
#[derive(Clone, Debug, PartialEq)]
pub struct Repetition {
    /// Position of the middle of the first one \[m].
    pub position: f64,
    /// Distance to the next one \[m].
    pub every: f64,
    /// Number of repetitions; infinite if they never end.
    pub count: f64,
    /// Circumference of the wheel \[m], after which all of them repeat; none on the rail.
    pub turn: Option<f64>,
}

/// A form with its positions.
#[derive(Clone, Debug, PartialEq)]
pub struct Defect {
    /// Height over the distance from the middle.
    pub form: Form,
    /// Positions of the middle.
    pub repetition: Repetition,
}

impl Defect {
    /// Last position \[m] of samples in the direction of travel, behind which nothing is known of the rail. Samples
    /// that are given a position and begin and end at height zero have none: behind them the smooth rail goes on.
    pub fn end(&self, forward: bool) -> Option<f64> {
        let ([begin, end], Form::Samples(samples)) = (self.sample_ends()?, &self.form) else { return None };
        let whole = self.repetition.position != 0.0 && samples.reach().iter().all(|&at| samples.height(at) == 0.0);
        let last = if forward { end } else { begin };
        (!whole && last.is_finite()).then_some(last)
    }

    /// First and last position \[m] of samples that lie on the rail; none of other forms.
    pub fn sample_ends(&self) -> Option<[f64; 2]> {
        let (Form::Samples(samples), Repetition { position, every, count, turn: None }) =
            (&self.form, &self.repetition)
        else {
            return None;
        };
        let [begin, end] = samples.reach();
        Some([position + begin, position + every * (count - 1.0) + end])
    }

    /// Ends \[m] of a gap in samples, and their usual distance.
    pub fn gap(&self) -> Option<([f64; 2], f64)> {
        match &self.form {
            Form::Samples(samples) => samples.gap(),
            _ => None,
        }
    }

    /// Height and length \[m] of samples that look like a cross-section.
    pub fn cross_section(&self) -> Option<[f64; 2]> {
        match &self.form {
            Form::Samples(samples) => samples.cross_section(),
            _ => None,
        }
    }

    /// Distance \[m] of a position from the middle of the one form that may reach it.
    fn local(&self, position: f64) -> f64 {
        let Repetition { position: first, every, count, turn } = self.repetition;
        let [begin, _] = self.form.reach();
        let along = position - first;
        let along = turn.map_or(along, |turn| along - turn * ((along - begin) / turn).floor());
        along - every * ((along - begin) / every).floor().clamp(0.0, count - 1.0)
    }

    /// Height at a position \[m].
    pub fn height(&self, position: f64) -> f64 {
        self.form.height(self.local(position))
    }

    /// Overlap of one of the forms with the stretch between two positions \[m].
    pub fn meets(&self, low: f64, high: f64) -> bool {
        self.overlaps(self.form.reach(), [low, high])
    }

    /// Presence of a jump between two positions \[m].
    pub fn jumps(&self, low: f64, high: f64) -> bool {
        self.form
            .jumps()
            .into_iter()
            .flatten()
            .filter(|at| at.is_finite())
            .any(|at| self.overlaps([at, at], [low, high]))
    }

    /// Overlap of the part from `begin` to `end` of one of the forms, distances from its middle \[m], with the stretch
    /// between two positions \[m].
    fn overlaps(&self, [begin, end]: [f64; 2], [low, high]: [f64; 2]) -> bool {
        let Repetition { position: first, every, count, turn } = self.repetition;
        let once = |low: f64, high: f64| {
            let from = ((low - first - end) / every).ceil().max(0.0);
            let to = ((high - first - begin) / every).floor().min(count - 1.0);
            from <= to
        };
        match turn {
            None => once(low, high),
            Some(turn) => {
                let shift = turn * ((low - first - begin) / turn).floor();
                [0.0, turn].iter().any(|back| once(low - shift - back, high - shift - back))
            }
        }
    }
}
