//! Points around the tread, and the time for which each of them was hot in the contact.

use serde::{Deserialize, Serialize};

/// Fewest and most points.
const POINTS: [f64; 2] = [64.0, 8192.0];

/// Time above a temperature of equidistant points of the tread; without memory while nothing was hot.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Tread {
    /// Circumference \[m].
    round: f64,
    /// Time of each point \[s].
    time: Vec<f64>,
    /// The longest of them \[s].
    longest: f64,
}

impl Tread {
    /// Makes about `points` points on a circumference of `round` metres unless there are some.
    pub fn allocate(&mut self, round: f64, points: f64) {
        if self.time.is_empty() {
            self.time = vec![0.0; points.clamp(POINTS[0], POINTS[1]) as usize];
            self.round = round;
        }
    }

    /// Longest time of a point \[s].
    pub fn longest(&self) -> f64 {
        self.longest
    }

    /// Adds the time during which points lie where a surface, given by positions \[m] and values there, exceeds
    /// `level`. In the step of `dt` \[s] the tread turns by `turned` metres, forward positive, to the distance `to`
    /// \[m].
    pub fn pass(&mut self, (x, values): (&[f64], &[f64]), level: f64, to: f64, turned: f64, dt: f64) {
        let mut hot: Option<[f64; 2]> = None;
        for (x, v) in x.windows(2).zip(values.windows(2)) {
            let at = |level: f64| x[0] + (level - v[0]) / (v[1] - v[0]) * (x[1] - x[0]);
            let piece = match (v[0] > level, v[1] > level) {
                (true, true) => [x[0], x[1]],
                (true, false) => [x[0], at(level)],
                (false, true) => [at(level), x[1]],
                (false, false) => continue,
            };
            match &mut hot {
                Some(whole) if whole[1] == piece[0] => whole[1] = piece[1],
                _ => {
                    if let Some(whole) = hot.replace(piece) {
                        self.add(whole, to, turned, dt);
                    }
                }
            }
        }
        if let Some(whole) = hot {
            self.add(whole, to, turned, dt);
        }
    }

    /// Adds the time that points spend in one interval. Where the interval lies in the material moves with the tread.
    fn add(&mut self, [low, high]: [f64; 2], to: f64, turned: f64, dt: f64) {
        let (first, last) = (to.min(to - turned), to.max(to - turned));
        let count = self.time.len();
        if count == 0 || self.round <= 0.0 || !(first + last).is_finite() {
            return;
        }
        if last - first > 2.0 * self.round {
            // Many turns in one step: all points are alike.
            let each = dt * (high - low) / self.round;
            self.time.iter_mut().for_each(|time| *time += each);
            self.longest = self.time.iter().copied().fold(self.longest, f64::max);
            return;
        }
        let spacing = self.round / count as f64;
        let (from, to) = (((low + first) / spacing).ceil(), ((high + last) / spacing).floor());
        for k in 0..=(to - from).max(-1.0) as i64 {
            let point = (from + k as f64) * spacing;
            // The point is inside while the tread has turned by between point − high and point − low.
            let inside = (point - low).min(last) - (point - high).max(first);
            let share = if last > first { inside / (last - first) } else { 1.0 };
            let index = ((from + k as f64).rem_euclid(count as f64) as usize).min(count - 1);
            self.time[index] += dt * share.clamp(0.0, 1.0);
            self.longest = self.longest.max(self.time[index]);
        }
    }

    /// Replaces this by a copy, reusing memory.
    pub fn copy_from(&mut self, other: &Self) {
        (self.round, self.longest) = (other.round, other.longest);
        self.time.clone_from(&other.time);
    }
}
