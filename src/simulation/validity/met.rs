//! Profiles against the way of a run: samples that it does not meet, and gaps between them.

use super::Simulation;
use crate::display::display_number;

/// Distance \[m] of samples ahead of the start from which a word is due at once; nearer ones may be meant.
const FAR: f64 = 1000.0;

impl Simulation {
    /// Doubts about the profiles at the start: gaps in samples, cross-sections, and samples far ahead.
    pub fn doubts_of_profiles(&self) -> Vec<String> {
        let surfaces = &self.model().rolling.contact.surfaces;
        let gap = |(name, profile): (&str, &crate::surface::Profile)| {
            profile.gap().map(|([from, to], usual)| {
                format!(
                    "{name}: no samples between {} and {} m of the file, where they usually are {} m apart: the surface is \
                     straight there; fill the gap, or confirm it by samples",
                    display_number(from),
                    display_number(to),
                    display_number(usual)
                )
            })
        };
        let section = |(name, profile): (&str, &crate::surface::Profile)| {
            profile.cross_section().map(|size| {
                let [height, length] = size.map(|size| display_number(1e3 * size));
                format!(
                    "{name}: the samples differ by {height} mm in height on a length of {length} mm, as those of a cross-section do, \
                     but {name} lies along the direction of rolling; the shape across it is given by contact.wheel_lateral_radius \
                     and contact.rail_lateral_radius, or as a patch by contact.rows"
                )
            })
        };
        let both = [("rail.profile", &surfaces.rail), ("wheel.profile", &surfaces.wheel)];
        let gaps = both.into_iter().filter_map(gap).chain(both.into_iter().filter_map(section));
        let ahead = surfaces.rail.sample_ends().filter(|ends| self.are_far(*ends));
        gaps.chain(ahead.map(|ends| self.far(ends, [0.0; 2]))).collect()
    }

    /// Doubt about the profile of the rail after a run between two distances \[m], nothing of which it has met.
    pub fn doubt_of_way(&self, way: [f64; 2]) -> Option<String> {
        let rail = &self.model().rolling.contact.surfaces.rail;
        let reach = self.model().rolling.reach;
        // Of samples far ahead and behind the start a word was said there.
        let said = rail.sample_ends().any(|ends| self.are_far(ends))
            || rail.end(self.sense() > 0.0).is_some_and(|end| self.sense() * end < 0.0);
        let unmet = !said && !rail.is_smooth() && !rail.meets(way[0] - reach, way[1] + reach);
        let nearest = || rail.sample_ends().next();
        unmet.then(|| match nearest() {
            Some(ends) => self.far(ends, way),
            None => format!(
                "rail.profile has had no effect: none of its features lies between {} and {} m, where the wheel has been; \
                 positions count from the start of the run, ahead positive",
                display_number(way[0]),
                display_number(way[1])
            ),
        })
    }

    /// Samples so far ahead of the start that they are hardly meant.
    fn are_far(&self, ends: [f64; 2]) -> bool {
        ends.iter().all(|end| self.sense() * end > FAR)
    }

    /// Words about samples beside the way of a run.
    fn far(&self, [first, last]: [f64; 2], [low, high]: [f64; 2]) -> String {
        let way = match low == high {
            true => format!("the run begins at {} m", display_number(low)),
            false => format!("the wheel has been between {} and {} m", display_number(low), display_number(high)),
        };
        let shift = if self.sense() > 0.0 { -first } else { -last };
        format!(
            "rail.profile: samples lie from {} to {} m, but {way}, where the rail is level: positions count from the start of the \
             run; if they are chainages, file(\"...\", position = {}) lets them begin there",
            display_number(first),
            display_number(last),
            display_number(shift)
        )
    }

    /// Sign of the direction of travel \[1].
    fn sense(&self) -> f64 {
        if self.outputs().wheel_velocity >= 0.0 { 1.0 } else { -1.0 }
    }
}
