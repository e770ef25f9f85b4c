//! Sample points of the output profiles.

/// Number of points of the output profiles, spread evenly over the candidate contact zone.
pub const PROFILE_POINTS: usize = 61;

/// Positions of the output profiles \[m], spread evenly over the candidate zone of ±`zone` \[m].
pub fn profile_points(zone: f64) -> Vec<f64> {
    let last = (PROFILE_POINTS - 1) as f64;
    (0..PROFILE_POINTS).map(|k| zone * (2.0 * k as f64 / last - 1.0)).collect()
}

/// Largest number of lines of a patch.
pub const MOST_LINES: usize = 13;

/// Largest depth of profiles below the tread [m].
const DEEPEST: f64 = 0.02;

/// Depths of the points of profiles below the tread \[m]: denser towards the surface, as the square of their number.
pub fn profile_depths() -> Vec<f64> {
    (0..PROFILE_POINTS).map(|k| DEEPEST * (k as f64 / (PROFILE_POINTS - 1) as f64).powi(2)).collect()
}

/// Name and meaning of the points of a profile or of the lines of the patch, counted from 1.
macro_rules! points {
    ($name:literal, $text:literal) => {
        points!(@numbers $name, $text, 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 21 22 23 24 25 26 27 28 29 30
            31 32 33 34 35 36 37 38 39 40 41 42 43 44 45 46 47 48 49 50 51 52 53 54 55 56 57 58 59 60 61)
    };
    (@numbers $name:literal, $text:literal, $($number:literal)*) => {{
        const POINTS: [(&str, &str); $crate::rolling::profile::PROFILE_POINTS] =
            [$( (concat!($name, "[", $number, "]"), concat!($text, ", point ", $number)) ),*];
        &POINTS
    }};
    (lines $name:literal, $text:literal) => { points!(@lines $name, $text, 1 2 3 4 5 6 7 8 9 10 11 12 13) };
    (@lines $name:literal, $text:literal, $($number:literal)*) => {{
        const POINTS: [(&str, &str); $crate::rolling::profile::MOST_LINES] =
            [$( (concat!($name, "[", $number, "]"), concat!($text, ", line ", $number)) ),*];
        &POINTS
    }};
}
pub(super) use points;
