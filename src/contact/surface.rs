//! Shapes of the surfaces: the gap between the bodies before they deform.

use super::flattening::Flattening;
use crate::piecewise::Piecewise;

/// Undeformed surfaces of wheel and rail.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Surfaces {
    /// Radius of the round wheel \[m].
    pub radius: f64,
    /// Material-fixed deviation of the wheel from the circle over the angle \[rad], outward positive \[m].
    pub wheel: Piecewise,
    /// Material-fixed deviation of the rail from the plane over the distance \[m], upward positive \[m].
    pub rail: Piecewise,
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
    ///
    /// Rolling brings the material ahead under the contact: at `x` lie the angle `angle + x/r` of the wheel (0: below its
    /// centre at the start) and the distance `distance + x` of the rail.
    pub fn gap(&self, x: f64, at: &Placement) -> f64 {
        // The form of r − √(r² − x²) without cancellation.
        let circle = x * x / (self.radius + (self.radius * self.radius - x * x).max(0.0).sqrt());
        let mut gap = circle - at.swelling.iter().map(|layer| layer.at(x)).sum::<f64>() - at.growth - at.elevation;
        if !self.wheel.x.is_empty() {
            let turn = std::f64::consts::TAU;
            gap -= self.wheel.at((at.angle + x / self.radius).rem_euclid(turn));
        }
        if !self.rail.x.is_empty() {
            gap -= self.rail.at(at.distance + x);
        }
        let [wheel, rail] = at.flattening;
        if !wheel.is_empty() {
            gap += wheel.depth(at.angle * self.radius + x);
        }
        if !rail.is_empty() {
            gap += rail.depth(at.distance + x);
        }
        gap
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
    fn a_bump_on_the_rail_is_met_where_it_lies_and_one_on_the_wheel_once_a_turn() {
        let bump = |at: f64| Piecewise { x: vec![at - 0.01, at, at + 0.01], value: vec![0.0, 1e-4, 0.0] };
        let none = Piecewise::default();
        let rail = Surfaces { rail: bump(2.0), ..Surfaces::smooth(0.5) };
        assert!((rail.gap(0.0, &place(2.0, 0.0, 0.0, &none)) + 1e-4).abs() < 1e-15);
        assert!(
            (rail.gap(0.005, &place(1.995, 0.0, 0.0, &none)) - rail.gap(0.005, &place(0.0, 0.0, 0.0, &none))).abs()
                > 9e-5
        );
        assert_eq!(rail.gap(0.0, &place(1.9, 0.0, 0.0, &none)), 0.0);
        let wheel = Surfaces { wheel: bump(1.0), ..Surfaces::smooth(0.5) };
        for turns in [0.0, 3.0] {
            let angle = std::f64::consts::TAU * turns + 1.0;
            assert!((wheel.gap(0.0, &place(0.0, angle, 0.0, &none)) + 1e-4).abs() < 1e-12);
        }
        assert_eq!(wheel.gap(0.0, &place(0.0, 2.0, 0.0, &none)), 0.0);
        assert!((wheel.gap(0.01, &place(0.0, 0.98, 0.0, &none)) + 1e-4 - 0.01 * 0.01).abs() < 1e-7);
    }
}
