//! Undeformed surfaces of wheel and rail: the gap between the bodies before they deform.

use crate::piecewise::{self, Piecewise};

/// Unevenness of wheel and rail where the wheel stands, such as profiles, dents and wear.
pub trait Unevenness {
    /// Depths \[m] by which the material of wheel and rail that lies at `x` \[m] from the contact point is missing from
    /// circle and plane; negative: it stands out.
    fn depth(&self, x: f64) -> [f64; 2];

    /// Depth \[m] of the dents that yielding has pressed into wheel and rail together at `x` \[m].
    fn dented(&self, x: f64) -> f64;

    /// Presence of such dents.
    fn is_dented(&self) -> bool;
}

/// Undeformed surfaces under a line: a circle over a plane, as heat has changed them, and their unevenness.
#[derive(Clone, Copy)]
pub struct Undeformed<'a> {
    /// Radius of the cold, round wheel \[m].
    pub radius: f64,
    /// Thermal growth of the wheel radius \[m].
    pub growth: f64,
    /// Height of the rail \[m].
    pub elevation: f64,
    /// Swelling of the hot layers of wheel and rail under the contact \[m].
    pub swelling: [&'a Piecewise; 2],
    /// Their unevenness; `None`: both are smooth.
    pub uneven: Option<&'a dyn Unevenness>,
}

impl Undeformed<'_> {
    /// A cold round wheel on a plane rail.
    pub fn smooth(radius: f64) -> Self {
        Self { radius, growth: 0.0, elevation: 0.0, swelling: [&piecewise::EMPTY; 2], uneven: None }
    }

    /// Distance \[m] at `x` \[m] from the contact point between the bodies, undeformed and with the hub at the height
    /// at which the cold, smooth bodies just touch: `r − √(r² − x²)` less everything that has grown into it.
    pub fn gap(&self, x: f64) -> f64 {
        let [wheel, rail] = self.uneven.map_or([0.0; 2], |uneven| uneven.depth(x));
        let swelling = self.swelling.iter().map(|layer| layer.at(x)).sum::<f64>();
        self.round_gap(x) - swelling + wheel + rail
    }

    /// Gap \[m] between circle and plane at `x` \[m], less thermal growth of the radius and elevation of the rail.
    pub fn round_gap(&self, x: f64) -> f64 {
        // The form of r − √(r² − x²) without cancellation.
        let circle = x * x / (self.radius + (self.radius * self.radius - x * x).max(0.0).sqrt());
        circle - self.growth - self.elevation
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_gap_is_that_of_a_circle_less_what_heat_adds() {
        let smooth = Undeformed::smooth(0.46);
        let circle = |x: f64| 0.46 - (0.46f64 * 0.46 - x * x).sqrt();
        for x in [-5e-3, 0.0, 1e-2] {
            assert!((smooth.gap(x) - circle(x)).abs() < 1e-15);
        }
        let swelling = Piecewise { x: vec![-1e-2, 1e-2], value: vec![0.0, 2e-6] };
        let hot = Undeformed { growth: 3e-6, swelling: [&swelling, &piecewise::EMPTY], ..smooth }.gap(0.0);
        assert!((hot + 4e-6).abs() < 1e-18, "{hot:e}");
    }
}
