//! Shapes of the surfaces: the gap between the bodies before they deform.

use super::flattening::Flattening;
use crate::piecewise::Piecewise;
use std::fmt::Debug;
use std::sync::Arc;

/// A deviation from the ideal shape that is fixed to the material.
pub trait Relief: Debug + Send + Sync {
    /// Height \[m] of the material added at the position `s` \[m] along the surface.
    fn height(&self, s: f64) -> f64;

    /// Shortest wavelength \[m] of what lies between two positions \[m]; infinite where nothing is known of it.
    fn wavelength(&self, _low: f64, _high: f64) -> f64 {
        f64::INFINITY
    }

    /// Whether the surface jumps somewhere between two positions \[m].
    fn jumps(&self, _low: f64, _high: f64) -> bool {
        false
    }

    /// Position \[m] beyond which nothing is known of it, in the direction of travel; `None` if it goes on.
    fn end(&self, _forward: bool) -> Option<f64> {
        None
    }
}

impl Relief for Piecewise {
    fn height(&self, s: f64) -> f64 {
        self.at(s)
    }
}

/// Undeformed surfaces of wheel and rail.
#[derive(Clone, Debug, Default)]
pub struct Surfaces {
    /// Radius of the round wheel \[m].
    pub radius: f64,
    /// Deviation of the wheel from the circle over angle times radius \[m]; none: round.
    pub wheel: Option<Arc<dyn Relief>>,
    /// Deviation of the rail from the plane over the distance \[m]; none: plane.
    pub rail: Option<Arc<dyn Relief>>,
}

/// Where the wheel stands on its surfaces, and how heat has changed them.
#[derive(Clone, Copy, Debug)]
pub struct Placement<'a> {
    /// Distance travelled by the wheel centre \[m].
    pub distance: f64,
    /// Angle of rotation, forward positive \[rad].
    pub angle: f64,
    /// Height of the rail \[m].
    pub elevation: f64,
    /// Thermal growth of the wheel radius \[m].
    pub growth: f64,
    /// Swelling of the hot layers of wheel and rail under the contact \[m].
    pub swelling: [&'a Piecewise; 2],
    /// Permanent flattening of wheel and rail.
    pub flattening: [&'a Flattening; 2],
}

impl Surfaces {
    /// A round wheel on a plane rail.
    pub fn smooth(radius: f64) -> Self {
        Self { radius, ..Self::default() }
    }

    /// Distance \[m] at `x` \[m] from the contact point between the bodies, undeformed and with the hub at the height at which
    /// the cold, smooth bodies just touch: `r − √(r² − x²)` less everything that has grown into it.
    pub fn gap(&self, x: f64, at: &Placement) -> f64 {
        let [wheel, rail] = self.depth(x, at);
        let swelling = at.swelling.iter().map(|layer| layer.at(x)).sum::<f64>();
        self.round_gap(x, at) - swelling + wheel + rail
    }

    /// The same between circle and plane, as elevation leaves them, without the swelling of the layers.
    pub fn round_gap(&self, x: f64, at: &Placement) -> f64 {
        // The form of r − √(r² − x²) without cancellation.
        let circle = x * x / (self.radius + (self.radius * self.radius - x * x).max(0.0).sqrt());
        circle - at.growth - at.elevation
    }

    /// Depths \[m] by which the material of wheel and rail that lies at `x` \[m] is missing from circle and plane.
    ///
    /// Rolling brings the material ahead under the contact: at `x` lie the angle `angle + x/r` of the wheel (0: below its
    /// centre at the start) and the distance `distance + x` of the rail.
    pub fn depth(&self, x: f64, at: &Placement) -> [f64; 2] {
        let place = [at.angle * self.radius + x, at.distance + x];
        let [wheel, rail] = self.heights(place);
        let depth = |flattening: &Flattening, s: f64| if flattening.is_empty() { 0.0 } else { flattening.depth(s) };
        [depth(at.flattening[0], place[0]) - wheel, depth(at.flattening[1], place[1]) - rail]
    }

    /// Heights \[m] of the reliefs of wheel and rail at positions \[m] along their surfaces.
    pub fn heights(&self, place: [f64; 2]) -> [f64; 2] {
        let height = |relief: &Option<Arc<dyn Relief>>, s: f64| relief.as_ref().map_or(0.0, |relief| relief.height(s));
        [height(&self.wheel, place[0]), height(&self.rail, place[1])]
    }

    /// Shortest wavelength \[m] within `reach` \[m] of positions \[m] along the surfaces of wheel and rail; infinite without any.
    /// A jump counts as a wave of the length `patch` \[m] of the contact, through which it passes.
    pub fn wavelength(&self, place: [f64; 2], reach: f64, patch: f64) -> f64 {
        let shortest = |relief: &Option<Arc<dyn Relief>>, s: f64| {
            let Some(relief) = relief else { return f64::INFINITY };
            let jump = if relief.jumps(s - reach, s + reach) { patch } else { f64::INFINITY };
            relief.wavelength(s - reach, s + reach).min(jump)
        };
        shortest(&self.wheel, place[0]).min(shortest(&self.rail, place[1]))
    }

    /// Whether both are circle and plane while nothing has flattened them.
    pub fn is_smooth(&self) -> bool {
        self.wheel.is_none() && self.rail.is_none()
    }

    /// Whether wheel or rail departs from circle and plane anywhere.
    pub fn is_uneven(&self, at: &Placement) -> bool {
        !self.is_smooth() || at.flattening.iter().any(|flattening| !flattening.is_empty())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const NONE: &Piecewise = &Piecewise { x: Vec::new(), value: Vec::new() };

    static UNDAMAGED: std::sync::LazyLock<Flattening> = std::sync::LazyLock::new(|| Flattening::none(0.0));

    fn place<'a>(distance: f64, angle: f64, growth: f64, swelling: &'a Piecewise) -> Placement<'a> {
        Placement {
            distance,
            angle,
            elevation: 0.0,
            growth,
            swelling: [swelling, NONE],
            flattening: [&UNDAMAGED, &UNDAMAGED],
        }
    }

    #[test]
    fn the_gap_is_that_of_a_circle_less_what_heat_adds() {
        let surfaces = Surfaces::smooth(0.46);
        let none = Piecewise::default();
        let circle = |x: f64| 0.46 - (0.46f64 * 0.46 - x * x).sqrt();
        for x in [-5e-3, 0.0, 1e-2] {
            assert!((surfaces.gap(x, &place(0.0, 0.0, 0.0, &none)) - circle(x)).abs() < 1e-15);
        }
        let swelling = Piecewise { x: vec![-1e-2, 1e-2], value: vec![0.0, 2e-6] };
        let hot = surfaces.gap(0.0, &place(0.0, 0.0, 3e-6, &swelling));
        assert!((hot + 4e-6).abs() < 1e-18, "{hot:e}");
    }

    #[test]
    fn a_bump_is_met_where_its_material_lies() {
        let bump = |at: f64| Piecewise { x: vec![at - 0.01, at, at + 0.01], value: vec![0.0, 1e-4, 0.0] };
        let none = Piecewise::default();
        let rail = Surfaces { rail: Some(Arc::new(bump(2.0))), ..Surfaces::smooth(0.5) };
        assert!((rail.gap(0.0, &place(2.0, 0.0, 0.0, &none)) + 1e-4).abs() < 1e-15);
        assert!(
            (rail.gap(0.005, &place(1.995, 0.0, 0.0, &none)) - rail.gap(0.005, &place(0.0, 0.0, 0.0, &none))).abs()
                > 9e-5
        );
        assert_eq!(rail.gap(0.0, &place(1.9, 0.0, 0.0, &none)), 0.0);
        let wheel = Surfaces { wheel: Some(Arc::new(bump(0.5))), ..Surfaces::smooth(0.5) };
        assert!((wheel.gap(0.0, &place(0.0, 1.0, 0.0, &none)) + 1e-4).abs() < 1e-12);
        assert_eq!(wheel.gap(0.0, &place(0.0, 2.0, 0.0, &none)), 0.0);
        assert!((wheel.gap(0.01, &place(0.0, 0.98, 0.0, &none)) + 1e-4 - 0.01 * 0.01).abs() < 1e-7);
    }
}
