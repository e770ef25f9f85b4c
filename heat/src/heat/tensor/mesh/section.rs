//! The cross-section of a body as conduction into the depth sees it: how wide it is, and where it touches the air.
//!
//! Heat enters over the width `w₀` of the contact and spreads sideways until it fills rim or rail head. Material at the
//! distance `z` from the contact conducts over the width `w(z)` of [`spread`]; the rim ends where it holds the volume
//! of the real one. Below it are web and boss. Derivation and measured errors: `docs/theory/width-of-conduction.md`.

use crate::fem::grading::graded;
use crate::heat::parameters::{HeatParameters, Widths};
use std::f64::consts::PI;

/// The largest layer in thicknesses of the body.
const LARGEST_LAYER: f64 = 0.15;
/// The largest layer where layers end with the parts of a section, in thicknesses of the body.
const LARGEST_OF_PARTS: f64 = 0.2;
/// Thickness in which a part of the section counts, in thicknesses of the body.
const SLIGHT: f64 = 1e-3;

/// Layers of a body, with widths and bare surfaces.
#[derive(Clone, Debug)]
pub struct Section {
    /// Depths of the ends of the layers, from zero on [m].
    pub layers: Vec<f64>,
    /// Widths at both ends of each layer, over that of the contact [1].
    pub widths: Vec<[f64; 2]>,
    /// Length of bare surface beside each layer per depth, over the width of the contact [1/m]; the contact's own strip
    /// is not part of it.
    pub bare: Vec<f64>,
    /// Width of the heat of brake blocks over that of the contact, at least 1 [1].
    pub block: f64,
}

/// Grading of the layers.
#[derive(Clone, Copy, Debug)]
pub struct LayerGrading {
    /// Thickness of the first layer [m].
    pub first: f64,
    /// Growth from one to the next [1].
    pub growth: f64,
}

/// A part of a section from where the one before ends.
struct SectionPart {
    /// Lower end [m].
    end: f64,
    /// Width over that of the contact, unless heat still spreads in it [1].
    width: Option<f64>,
    /// Bare sides per depth and width of the contact, before the polar weight [1/m].
    bare: f64,
    /// Bare surface on top of the part beside the strip of the contact, over the width of the latter [1].
    top: f64,
}

impl Section {
    /// Section that is as wide as the contact everywhere.
    pub fn even(layers: Vec<f64>) -> Self {
        let n = layers.len() - 1;
        Self { layers, widths: vec![[1.0; 2]; n], bare: vec![0.0; n], block: 1.0 }
    }

    /// Section of the wheel.
    pub fn wheel(c: &HeatParameters, grading: LayerGrading) -> Self {
        match &c.widths {
            Some(widths) => Self::rim_and_web(c, widths, grading),
            None => Self::even(layers(grading, c.radius - c.hub_radius)),
        }
    }

    /// Section of rim, web and boss, into which heat spreads.
    fn rim_and_web(c: &HeatParameters, widths: &Widths, grading: LayerGrading) -> Self {
        let (radius, thickness) = (c.radius, c.radius - c.hub_radius);
        let strip = c.contact_width;
        let rim = (widths.rim / strip).max(1.0);
        let depth = widths.rim_depth.min(thickness);
        let area = |z: f64| z - 0.5 * z * z / radius;
        let width = |z: f64| spread(z / strip).min(rim);
        let bottom = depth_of(rim * area(depth), thickness, |z| width(z) * (1.0 - z / radius));
        let cone = (strip * spread_depth(rim)).min(bottom);
        let boss = (radius - widths.boss_radius).clamp(bottom, thickness);
        // Bare sides of rim and web as large as the real ones, beside layers that are not quite where those are.
        let sides = |real: f64, layers: f64| if layers > 0.0 { 2.0 / strip * real / layers } else { 0.0 };
        let rim_sides = sides(area(depth), area(bottom));
        let foot = (radius - widths.boss_radius).clamp(depth, thickness);
        let web_sides = sides(area(foot) - area(depth), area(boss) - area(bottom));
        let parts = [
            SectionPart { end: cone, width: None, bare: rim_sides, top: rim - 1.0 },
            SectionPart { end: bottom, width: Some(rim), bare: rim_sides, top: 0.0 },
            SectionPart { end: boss, width: Some(widths.web / strip), bare: web_sides, top: 0.0 },
            SectionPart { end: thickness, width: Some(widths.boss / strip), bare: 0.0, top: 0.0 },
        ];
        Self { block: (widths.block / strip).clamp(1.0, rim), ..Self::of_parts(&parts, strip, grading, 1.0 / radius) }
    }

    /// Section of the rail, from the top of its head down to the base.
    pub fn rail(c: &HeatParameters, grading: LayerGrading) -> Self {
        match &c.widths {
            Some(widths) => Self::head(c, widths, grading),
            None => Self::even(layers(grading, c.rail_height)),
        }
    }

    /// Section of the rail's head, into which heat spreads.
    fn head(c: &HeatParameters, widths: &Widths, grading: LayerGrading) -> Self {
        let (height, strip) = (c.rail_height, c.contact_width);
        let head = (widths.head / strip).max(1.0);
        let cone = (strip * spread_depth(head)).min(height);
        let sides = 2.0 / strip;
        let parts = [
            SectionPart { end: cone, width: None, bare: sides, top: head - 1.0 },
            SectionPart { end: height, width: Some(head), bare: sides, top: 0.0 },
        ];
        Self::of_parts(&parts, strip, grading, 0.0)
    }

    /// Lays layers through all parts that are thick enough to count; `curvature` is that of the surface [1/m].
    fn of_parts(parts: &[SectionPart], strip: f64, grading: LayerGrading, curvature: f64) -> Self {
        let thickness = parts.last().map_or(0.0, |part| part.end);
        let slight = SLIGHT * thickness;
        let mut section = Self { layers: vec![0.0], widths: Vec::new(), bare: Vec::new(), block: 1.0 };
        let LayerGrading { first, growth } = grading;
        let mut size = first.min(0.1 * thickness) / growth;
        let mut top = 0.0;
        for part in parts {
            let start = section.layers.last().copied().unwrap_or(0.0);
            let end = if thickness - part.end < slight { thickness } else { part.end };
            top += part.top;
            if end - start < slight {
                continue;
            }
            let places = graded(size * growth, growth, LARGEST_OF_PARTS * thickness, end - start);
            let ends: Vec<[f64; 2]> = places.windows(2).map(|z| [start + z[0], start + z[1]]).collect();
            let width = |z: f64| part.width.unwrap_or_else(|| spread(z / strip));
            // Bare surface on top counts from where heat has spread that far.
            let opened = width(end) - width(start);
            for &[from, to] in &ends {
                let (widths, height) = ([width(from), width(to)], to - from);
                let share = if opened > 0.0 { (widths[1] - widths[0]) / opened } else { height / (end - start) };
                section.widths.push(widths);
                section.bare.push(part.bare * (1.0 - 0.5 * curvature * (from + to)) + top * share / height);
                section.layers.push(to);
                size = height;
            }
            top = 0.0;
        }
        section
    }
}

/// Layers of a body in which heat does not spread.
fn layers(LayerGrading { first, growth }: LayerGrading, thickness: f64) -> Vec<f64> {
    graded(first.min(0.1 * thickness), growth, LARGEST_LAYER * thickness, thickness)
}

/// Width `w/w₀` over which a half-space conducts at the distance `z = ζ w₀` from a heated strip of the width `w₀`:
/// `1 + πζ − (π − 4/π) ζ/(1 + 2ζ)`.
///
/// The slope at the strip, 4/π, makes the mean temperature of the strip exact to first order in `√(κt)/w₀`; far from it
/// heat flows through half-circles, with the slope π. The 2 is chosen such that the mean temperature of the strip under
/// constant flux is within 2.5 % of the three-dimensional one at all times.
pub fn spread(zeta: f64) -> f64 {
    1.0 + PI * zeta - (PI - 4.0 / PI) * zeta / (1.0 + 2.0 * zeta)
}

/// Distance `z/w₀` at which [`spread`] reaches a width `w/w₀` of at least 1.
fn spread_depth(width: f64) -> f64 {
    let half = 1.0 + 2.0 / PI - width;
    let root = (half * half + 2.0 * PI * (width - 1.0)).sqrt();
    // Of `2π ζ² + 2 half ζ + 1 − width = 0`, without cancellation.
    if half > 0.0 { (width - 1.0) / (half + root) } else { (root - half) / (2.0 * PI) }
}

/// Depth at which the integral of a positive `width` reaches `volume`, at most `thickness`.
fn depth_of(volume: f64, thickness: f64, width: impl Fn(f64) -> f64) -> f64 {
    const STEPS: usize = 2000;
    let step = thickness / STEPS as f64;
    let mut filled = 0.0;
    for i in 0..STEPS {
        let slice = step * width((i as f64 + 0.5) * step);
        if filled + slice >= volume {
            return step * (i as f64 + (volume - filled) / slice);
        }
        filled += slice;
    }
    thickness
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spread_has_the_slopes_of_early_and_late_heat_and_its_inverse() {
        let slope = |z: f64| (spread(z + 1e-6) - spread(z - 1e-6)) / 2e-6;
        assert!((slope(0.0) - 4.0 / PI).abs() < 1e-5 && (slope(1e3) - PI).abs() < 1e-5);
        for zeta in [0.0, 1e-9, 1e-3, 0.1, 0.7, 3.0, 100.0] {
            let found = spread_depth(spread(zeta));
            assert!((found - zeta).abs() <= 1e-7 * zeta + 1e-15, "{found} for {zeta}");
        }
    }
}
