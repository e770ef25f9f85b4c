//! Height of the rail under the wheel between communication points.
//!
//! A track is smooth, and its samples are all that a master tells. Straight lines between them would have corners, which
//! ring the wheel on its contact: a corner of the rate ṡ \[m/s] is a blow of about ṡ √(k m) \[N]. The height therefore
//! follows a cubic, which goes on at the rate with which the last one ended, and ends at the rate that the master gives
//! by `rail.elevation_rate`, or else at that of the parabola through this height and the two before. Derived here.

use serde::{Deserialize, Serialize};

/// Longest step over the one before that a rate is carried into \[1]: a cubic would swing out over a longer one.
const LARGEST_RATIO: f64 = 4.0;

/// Internal step in which a wheel follows an uneven track \[s]: a wave of 20 Hz is then followed to 4 %.
const RESOLVED: f64 = 2e-3;
/// Most internal steps for it in a communication step \[1]; a track with fewer samples is not smooth to the wheel.
const MOST_PIECES: u64 = 10;
/// Change of the force of the wheel's inertia within an internal step, over the load, below which the track is followed
/// without shorter steps \[1], and time in which the jerk of the track is forgotten \[s]: a quarter of a wave of 10 Hz.
const SLIGHT: f64 = 5e-4;
const FORGOTTEN: f64 = 0.025;

/// Rates of the height at the last communication point.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Rise {
    /// Rate at the end of the last step \[m/s].
    rate: f64,
    /// Mean rate over that step \[m/s].
    mean: f64,
    /// Its length \[s]; 0 at the start, before which the rail is level.
    length: f64,
    /// Rate at its end that the parabola adds to the mean one [m/s].
    bend: f64,
    /// Error of the rate at its end [m/s], from the change of that; 0 where the rate was given.
    pub error: f64,
    /// Largest jerk of late [m/s³].
    jerk: f64,
}

/// Share of the change of the last part of a rate that its error is \[1]: the third term of a series beside the second.
const ERROR_OF_BEND: f64 = 2.0 / 3.0;

/// HeightCourse of the height over a communication step: a cubic with given heights and rates at both ends.
pub struct HeightCourse {
    /// Heights at both ends \[m].
    heights: [f64; 2],
    /// Rates at both ends \[m/s].
    rates: [f64; 2],
    /// Length of the step \[s].
    length: f64,
    /// Memory for the next step.
    rise: Rise,
}

impl Rise {
    /// HeightCourse between two heights \[m] in the `length` \[s] of a step, ending with a rate [m/s] if one is given, which
    /// is one other than 0.
    pub fn course(&self, heights: [f64; 2], given: f64, length: f64) -> HeightCourse {
        let mean = (heights[1] - heights[0]) / length;
        let before = if self.length > 0.0 { self.length } else { length };
        let carried = length <= LARGEST_RATIO * before;
        let bend = (mean - self.mean) * length / (length + before);
        let (rate, error) = match (given != 0.0, carried) {
            (true, _) => (given, 0.0),
            (false, true) => (mean + bend, ERROR_OF_BEND * (bend - self.bend).abs()),
            (false, false) => (mean, bend.abs()),
        };
        let begin = if carried { self.rate } else { mean };
        // Errors of rates that are not given bend the cubic more than the track does.
        let of_course = 6.0 * (begin + rate - 2.0 * mean).abs();
        let most = if error > 0.0 { 3.0 * error } else { f64::INFINITY };
        let jerk = of_course.min(most) / (length * length);
        let jerk = jerk.max(self.jerk * libm::exp(-length / FORGOTTEN));
        HeightCourse { heights, rates: [begin, rate], length, rise: Rise { rate, mean, length, bend, error, jerk } }
    }
}

impl HeightCourse {
    /// Height \[m] at a fraction of the step.
    pub fn at(&self, fraction: f64) -> f64 {
        let Self { heights: [from, to], rates: [begin, end], length, .. } = self;
        let (t, rest) = (fraction, 1.0 - fraction);
        if t == 1.0 {
            return *to;
        }
        // The straight line, and what the rates at both ends differ from it.
        let mean = (to - from) / length;
        from + t * (to - from) + length * t * rest * (rest * (begin - mean) - t * (end - mean))
    }

    /// Memory for the next step.
    pub fn rise(&self) -> Rise {
        self.rise
    }

    /// Internal steps that resolve it for a wheel of the `inertia` \[kg] under a `load` \[N], no more than
    /// [`MOST_PIECES`]: as many as keep changes of its force [slight](SLIGHT), or those of [`RESOLVED`] where these are
    /// fewer.
    pub fn pieces(&self, inertia: f64, load: f64) -> u64 {
        let change = inertia * self.rise.jerk * self.length;
        if change == 0.0 {
            return 1;
        }
        let pieces = (change / (SLIGHT * load.max(0.0))).min(self.length / RESOLVED);
        ((pieces - 1e-9).ceil() as u64).clamp(1, MOST_PIECES)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Largest error of a course through samples of `f` in steps of `h` from its formula; with its rates where `given`.
    fn error(f: impl Fn(f64) -> f64, rate: impl Fn(f64) -> f64, h: f64, given: bool) -> f64 {
        let mut rise = Rise { rate: rate(0.0), mean: (f(0.0) - f(-h)) / h, length: h, ..Rise::default() };
        let mut worst: f64 = 0.0;
        for k in 0..100 {
            let [from, to] = [k, k + 1].map(|k| f64::from(k) * h);
            let course = rise.course([f(from), f(to)], if given { rate(to) } else { 0.0 }, h);
            for i in 0..=10 {
                let fraction = f64::from(i) / 10.0;
                worst = worst.max((course.at(fraction) - f(from + fraction * h)).abs());
            }
            rise = course.rise();
        }
        worst
    }

    #[test]
    fn a_parabola_is_followed_to_round_off_and_a_sine_with_order_three_or_four() {
        let parabola = error(|t| 0.3 * t * t - 0.1 * t, |t| 0.6 * t - 0.1, 0.01, false);
        println!("parabola {parabola:e}");
        assert!(parabola < 1e-15);
        for (given, order) in [(false, 3), (true, 4)] {
            let errors = [0.04, 0.02].map(|h| error(f64::sin, f64::cos, h, given));
            println!("sine, rates given: {given}; errors {errors:?}");
            assert!((errors[0] / errors[1]).log2() > f64::from(order) - 0.2);
        }
    }

    #[test]
    fn the_error_of_a_rate_is_estimated_to_a_third() {
        let h = 0.2;
        let mut rise = Rise::default();
        let errors: Vec<[f64; 2]> = (0..100)
            .map(|k| {
                let [from, to] = [k, k + 1].map(|k| f64::from(k) * h);
                rise = rise.course([from.sin(), to.sin()], 0.0, h).rise();
                [(rise.rate - to.cos()).abs(), rise.error]
            })
            .collect();
        let [true_error, estimate] = [0, 1].map(|k| errors[10..].iter().map(|e| e[k]).fold(0.0, f64::max));
        println!("largest error {true_error:e}, estimate {estimate:e}");
        assert!((estimate / true_error - 1.0).abs() < 0.34);
        assert_eq!(rise.course([0.0, 1.0], 0.3, h).rise().error, 0.0);
    }

    #[test]
    fn heights_and_rates_go_on_from_step_to_step() {
        let first = Rise::default().course([0.0, 1e-3], 0.0, 1e-3);
        let second = first.rise().course([1e-3, 1.5e-3], 0.2, 2e-3);
        let slope = |course: &HeightCourse, from: f64, to: f64| {
            (course.at(to) - course.at(from)) / ((to - from) * course.length)
        };
        let rates = [slope(&first, 1.0 - 1e-7, 1.0), slope(&second, 0.0, 1e-7), slope(&second, 1.0 - 1e-7, 1.0)];
        println!("{rates:?}");
        assert!((rates[0] - rates[1]).abs() < 1e-5 && (rates[2] - 0.2).abs() < 1e-5);
        assert_eq!([first.at(0.0), first.at(1.0), second.at(0.0), second.at(1.0)], [0.0, 1e-3, 1e-3, 1.5e-3]);
    }

    #[test]
    fn a_smooth_track_takes_one_internal_step_and_a_rough_one_those_of_two_milliseconds() {
        let h = 0.01;
        let pieces = |frequency: f64, amplitude: f64, given: bool| {
            let height = |t: f64| amplitude * (1.0 - (frequency * t).cos());
            let mut rise = Rise::default();
            let all = (0..50).map(|k| {
                let [from, to] = [k, k + 1].map(|k| f64::from(k) * h);
                let rate = if given { amplitude * frequency * (frequency * to).sin() } else { 0.0 };
                let course = rise.course([height(from), height(to)], rate, h);
                rise = course.rise();
                course.pieces(360.0, 1e5)
            });
            let all: Vec<u64> = all.collect();
            (all.iter().max().copied(), all.iter().sum::<u64>())
        };
        let found = [pieces(17.0, 2.5e-3, true), pieces(126.0, 1e-4, true), pieces(0.0, 1.0, true)];
        println!("2.7 Hz, 2.5 mm; 20 Hz, 0.1 mm; level: {found:?}");
        assert_eq!(found.map(|(most, _)| most), [1, 5, 1].map(Some));
        let found = [(17.0, 2.5e-3), (60.0, 2e-4), (126.0, 1e-4)].map(|(frequency, amplitude)| {
            let [given, found] = [true, false].map(|given| pieces(frequency, amplitude, given).1);
            println!("{frequency} rad/s, {amplitude} m: {given} pieces with rates, {found} without");
            found as f64 / given as f64
        });
        assert!(found.iter().all(|ratio| (0.9..1.2).contains(ratio)), "{found:?}");
        let still = Rise::default().course([0.0; 2], 0.0, h);
        assert_eq!([still.pieces(360.0, 1e5), still.pieces(360.0, 0.0)], [1, 1]);
    }

    #[test]
    fn no_rate_is_carried_into_a_far_longer_step() {
        let last = Rise::default().course([0.0, 1e-3], 0.5, 1e-3).rise();
        let long = last.course([1e-3, 1e-3], 0.0, 10.0);
        assert!((0..=10).all(|k| long.at(f64::from(k) / 10.0) == 1e-3));
    }
}
