//! Where the output profiles across the contact are sampled.

/// Number of points of the output profiles, spread evenly over the candidate contact zone.
pub const PROFILE_POINTS: usize = 61;

/// Positions of the output profiles \[m], spread evenly over the candidate zone of ±`zone` \[m].
pub fn profile_points(zone: f64) -> Vec<f64> {
    let last = (PROFILE_POINTS - 1) as f64;
    (0..PROFILE_POINTS).map(|k| zone * (2.0 * k as f64 / last - 1.0)).collect()
}
