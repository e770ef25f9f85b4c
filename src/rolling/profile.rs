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
