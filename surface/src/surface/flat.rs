//! Length and depth of the flat of a wheel, as one measures them on its profile.

use super::flattening::Flattening;
use super::shape::Surfaces;
use std::f64::consts::TAU;

/// Depth below the level of the tread from which a place belongs to a flat \[m].
const FLAT_FROM: f64 = 1e-6;
/// Samples of the profile around the tread, from which its level and lowest place are taken: a quarter of a millimetre
/// apart on a wheel of a railway.
const SAMPLES: usize = 12_000;
/// Halvings of a step in which an end of the flat lies.
const HALVINGS: usize = 20;

/// Flat of a wheel.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Flat {
    /// Length of the stretch of tread around the deepest place that lies more than 1 µm below the level \[m].
    pub length: f64,
    /// Depth of the deepest place below the level \[m].
    pub depth: f64,
}

/// Tread of a wheel as it is made, without waves and roughness: these swing about the level.
#[derive(Clone, Copy, Debug, Default)]
pub struct TreadLevel {
    /// Length of the tread [m].
    circumference: f64,
    /// Level over the circle [m]: half of the tread lies lower. A file has another one than 0 if it is of a worn wheel.
    level: f64,
    /// Position of the lowest place [m].
    lowest: f64,
}

impl TreadLevel {
    /// That of the wheel of `surfaces`.
    pub fn of(surfaces: &Surfaces) -> Self {
        let circumference = TAU * surfaces.radius;
        if surfaces.wheel.is_smooth() {
            return Self { circumference, ..Self::default() };
        }
        let sample = |k: usize| {
            let s = circumference * k as f64 / SAMPLES as f64;
            [surfaces.wheel.local_height(s), s]
        };
        let mut samples: Vec<_> = (0..SAMPLES).map(sample).collect();
        let (_, [level, _], _) = samples.select_nth_unstable_by(SAMPLES / 2, |a, b| a[0].total_cmp(&b[0]));
        let level = *level;
        let lowest = samples.iter().min_by(|a, b| a[0].total_cmp(&b[0])).map_or(0.0, |[_, s]| *s);
        Self { circumference, level, lowest }
    }

    /// The deepest flat of the wheel of `surfaces`, with what `flattening` has taken off it; the ends are sought in
    /// steps of `spacing` \[m]. Wear that the whole tread has in common lowers the level.
    pub fn flat(&self, surfaces: &Surfaces, flattening: &Flattening, spacing: f64) -> Flat {
        if surfaces.wheel.is_smooth() && flattening.is_empty() {
            return Flat::default();
        }
        let level = self.level - flattening.worn().shallowest();
        let depth = |s: f64| level - surfaces.wheel.local_height(s) + flattening.depth(s);
        let places = flattening.deepest_places().chain([self.lowest]);
        let Some(place) = places.max_by(|a, b| depth(*a).total_cmp(&depth(*b))).filter(|s| depth(*s) > FLAT_FROM)
        else {
            return Flat::default();
        };
        let mut flat = Flat { length: 0.0, depth: depth(place) };
        for direction in [-1.0, 1.0] {
            let at = |way: f64| depth(place + direction * way);
            let mut way = spacing;
            while at(way) > FLAT_FROM && flat.length + way < self.circumference {
                flat.depth = flat.depth.max(at(way));
                way += spacing;
            }
            let (mut inside, mut outside) = (way - spacing, way);
            for _ in 0..HALVINGS {
                let middle = 0.5 * (inside + outside);
                *(if at(middle) > FLAT_FROM { &mut inside } else { &mut outside }) = middle;
            }
            flat.length = (flat.length + inside).min(self.circumference);
        }
        flat
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::piecewise::Piecewise;
    use crate::surface::{Body, Profile, WearIncrement};

    const RADIUS: f64 = 0.46;

    fn made(text: &str) -> Surfaces {
        let wheel = Profile::parse(text, None, Body::Wheel { radius: RADIUS }).unwrap();
        Surfaces { wheel, ..Surfaces::smooth(RADIUS) }
    }

    fn flat(surfaces: &Surfaces, flattening: &Flattening) -> Flat {
        TreadLevel::of(surfaces).flat(surfaces, flattening, 1e-3)
    }

    /// A chord of length L is L²/8r deep, and √(1 − t/d) of it lies more than t below the circle. Waves and roughness,
    /// also deep ones, are no flats, and neither hide one nor lengthen it.
    #[test]
    fn a_chord_has_its_length_and_depth_and_waves_are_no_flats() {
        let none = Flattening::none(TAU * RADIUS);
        let waves = "polygon(order = 7, amplitude = 1e-4) + roughness(spectrum = EN_ISO_3095, seed = 3)";
        for (length, position) in [(0.06, 0.0), (0.04, 1.3), (0.01, 2.885)] {
            for waves in ["", &format!(" + {waves}")] {
                let made = made(&format!("flat(length = {length}, position = {position}){waves}"));
                let Flat { length: found, depth } = flat(&made, &none);
                let chord = (8.0 * RADIUS * depth).sqrt();
                let beyond = (1.0 - FLAT_FROM / depth).sqrt();
                assert!((chord / length - 1.0).abs() < 1e-3, "{length}: {depth}");
                assert!((found / (length * beyond) - 1.0).abs() < 1e-3, "{length}: {found}");
            }
        }
        for text in ["", waves] {
            assert_eq!(flat(&made(text), &none), Flat::default());
        }
    }

    /// The level is that of most of the tread: even wear moves it, in the profile and on top of it.
    #[test]
    fn a_flat_of_a_worn_wheel_counts_from_the_worn_tread() {
        let circumference = TAU * RADIUS;
        let chord = |s: f64| if s.abs() < 0.02 { (0.02f64.powi(2) - s * s) / (2.0 * RADIUS) } else { 0.0 };
        let mut samples = Piecewise::default();
        for k in 0..5000 {
            let s = circumference * f64::from(k) / 5000.0;
            samples.push(s, -3e-5 - chord(s - 1.0));
        }
        let worn = Surfaces { wheel: Profile::from_samples(samples), ..Surfaces::smooth(RADIUS) };
        let mut flattening = Flattening::none(circumference);
        let before = flat(&worn, &flattening);
        assert!((before.length - 0.04).abs() < 6e-4 && (before.depth / chord(0.0) - 1.0).abs() < 1e-3, "{before:?}");
        let hat = Piecewise { x: vec![-5e-3, 0.0, 5e-3], value: vec![0.0, 1.0, 0.0] };
        let increment = WearIncrement {
            path: [0.0, 4.0 * circumference],
            distribution: &hat,
            volume: 2e-5 * circumference,
            smoothing: 0.0,
        };
        flattening.wear(&increment, 5e-4);
        let after = flat(&worn, &flattening);
        assert!((after.length - before.length).abs() < 1e-9 && (after.depth - before.depth).abs() < 1e-12, "{after:?}");
        // A dent beside it that is deeper is the flat.
        let dent = Piecewise { x: vec![-4e-3, -3e-3, 3e-3, 4e-3], value: vec![0.0, 5e-4, 5e-4, 0.0] };
        flattening.indent(2.0, &dent, 1e-3);
        let dented = flat(&worn, &flattening);
        assert!((dented.length - 8e-3).abs() < 1e-5 && (dented.depth - 5e-4).abs() < 1e-9, "{dented:?}");
    }
}
