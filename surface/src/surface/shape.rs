//! Shapes of the surfaces: the gap between the bodies before they deform.

use super::flattening::Flattening;
use super::profile::{Body, Profile, ProfileError};
use crate::contact::Unevenness;
use std::path::Path;

/// Places at which a surface is read within a step, or a half-width of the contact, and at most in all \[1].
const PLACES_PER_LENGTH: f64 = 4.0;
const MOST_PLACES: f64 = 2048.0;
/// Part of a step behind which its surface is compared with a straight line \[1]: the golden section, for in the middle a
/// step of two whole waves meets the height of its ends again.
const SECTION: f64 = 0.382;

/// Parameter that describes no surface.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{parameter}: {source}")]
pub struct SurfaceError {
    /// Name of the parameter.
    pub parameter: &'static str,
    /// Reason.
    pub source: ProfileError,
}

/// Undeformed surfaces of wheel and rail as they are made.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Surfaces {
    /// Radius of the round wheel \[m].
    pub radius: f64,
    /// Deviation of the wheel from the circle over angle times radius.
    pub wheel: Profile,
    /// Deviation of the rail from the plane over the distance.
    pub rail: Profile,
}

/// Position of the wheel on the surfaces, and what yielding and wear have changed of them.
#[derive(Clone, Copy, Debug)]
pub struct Placement<'a> {
    /// Surfaces as they are made.
    pub surfaces: &'a Surfaces,
    /// Distance travelled by the wheel centre \[m].
    pub distance: f64,
    /// Angle of rotation, forward positive \[rad].
    pub angle: f64,
    /// Depths that yielding and wear have taken off wheel and rail.
    pub flattening: [&'a Flattening; 2],
}

impl<'a> Placement<'a> {
    /// Unevenness as the contact reads it; `None`: no profiles, and nothing has flattened wheel or rail.
    pub fn unevenness(&'a self) -> Option<&'a dyn Unevenness> {
        let is_flattened = self.flattening.iter().any(|flattening| !flattening.is_empty());
        (is_flattened || !self.surfaces.is_smooth()).then_some(self)
    }
}

impl Unevenness for Placement<'_> {
    /// Rolling brings the material ahead under the contact: at `x` lie the angle `angle + x/r` of the wheel (0: below
    /// its centre at the start) and the distance `distance + x` of the rail.
    fn depth(&self, x: f64) -> [f64; 2] {
        let positions = self.positions(x);
        let [wheel, rail] = self.surfaces.heights(positions);
        let depth = |body: usize| match self.flattening[body] {
            flattening if flattening.is_empty() => 0.0,
            flattening => flattening.depth(positions[body]),
        };
        [depth(0) - wheel, depth(1) - rail]
    }

    fn dented(&self, x: f64) -> f64 {
        self.flattening.iter().zip(self.positions(x)).map(|(flattening, s)| flattening.dent(s)).sum()
    }

    fn is_dented(&self) -> bool {
        self.flattening.iter().any(|flattening| flattening.is_dented())
    }
}

impl Placement<'_> {
    /// Positions \[m] of what lies at `x` \[m] along the surfaces of wheel and rail.
    fn positions(&self, x: f64) -> [f64; 2] {
        [self.angle * self.surfaces.radius + x, self.distance + x]
    }
}

impl Surfaces {
    /// A round wheel on a plane rail.
    pub fn smooth(radius: f64) -> Self {
        Self { radius, ..Self::default() }
    }

    /// A wheel of the given radius \[m] and a rail with the profiles that texts describe, of `wheel.profile` and `rail.profile`;
    /// files of profiles are looked for in the working directory, then in `folder`.
    ///
    /// # Errors
    /// A profile without meaning, with the name of its parameter.
    pub fn parse(radius: f64, [wheel, rail]: [&str; 2], folder: Option<&Path>) -> Result<Self, SurfaceError> {
        let profile = |parameter, text: &str, body| {
            Profile::parse(text, folder, body).map_err(|source| SurfaceError { parameter, source })
        };
        Ok(Self {
            radius,
            wheel: profile("wheel.profile", wheel, Body::Wheel { radius })?,
            rail: profile("rail.profile", rail, Body::Rail)?,
        })
    }

    /// Heights \[m] of the profiles of wheel and rail at positions \[m] along their surfaces.
    pub fn heights(&self, positions: [f64; 2]) -> [f64; 2] {
        [self.wheel.height(positions[0]), self.rail.height(positions[1])]
    }

    /// Shortest wavelength \[m] within `reach` \[m] of positions \[m] along the surfaces of wheel and rail; infinite
    /// without any. A jump counts as a wave of the length `patch` \[m] of the contact, through which it passes.
    pub fn shortest_wavelength(&self, positions: [f64; 2], reach: f64, patch: f64) -> f64 {
        let shortest = |profile: &Profile, s: f64| {
            let (low, high) = (s - reach, s + reach);
            let jump = if profile.jumps_between(low, high) { patch } else { f64::INFINITY };
            profile.shortest_wavelength_between(low, high).min(jump)
        };
        shortest(&self.wheel, positions[0]).min(shortest(&self.rail, positions[1]))
    }

    /// Height \[m] that steps of a length `stride` \[m] miss between two places each \[m] of wheel and rail: that of the
    /// surfaces, evened out over a contact of the half-width `patch` \[m], off straight lines from step to step.
    pub fn missed(&self, places: [[f64; 2]; 2], stride: f64, patch: f64) -> f64 {
        let of_profile = |profile: &Profile, [low, high]: [f64; 2]| {
            let spacing =
                (stride.min(patch) / PLACES_PER_LENGTH).max((high - low + stride + 2.0 * patch) / MOST_PLACES);
            let lengths = [SECTION * stride, (1.0 - SECTION) * stride, patch];
            let [before, behind, even] = lengths.map(|length| (length / spacing).round().max(1.0) as usize);
            let (margin, share) = (before.max(behind) + even, before as f64 / (before + behind) as f64);
            let count = ((high - low) / spacing).ceil() as usize + 2 * margin + 1;
            let place = |k: usize| low + (k as f64 - margin as f64) * spacing;
            let mut sums = vec![0.0];
            (0..count).for_each(|k| sums.push(sums[k] + profile.height(place(k))));
            let mean = |k: usize| (sums[k + even + 1] - sums[k - even]) / (2 * even + 1) as f64;
            let line = |k: usize| (1.0 - share) * mean(k - before) + share * mean(k + behind);
            (margin..count - margin).map(|k| (mean(k) - line(k)).abs()).fold(0.0, f64::max)
        };
        let profiles = [&self.wheel, &self.rail].into_iter().zip(places).filter(|(profile, _)| !profile.is_smooth());
        profiles.map(|(profile, places)| of_profile(profile, places)).sum()
    }

    /// Present profile of the wheel with what `flattening` has taken off it: positions around the tread and heights
    /// over the circle \[m], `spacing` \[m] apart or a little more. Samples on level stretches are left out.
    pub fn tread(&self, flattening: &Flattening, spacing: f64) -> Vec<[f64; 2]> {
        let circumference = std::f64::consts::TAU * self.radius;
        let count = (circumference / spacing).floor().max(3.0) as usize;
        let sample = |k: usize| {
            let s = circumference * k as f64 / count as f64;
            [s, self.wheel.height(s) - flattening.depth(s)]
        };
        let samples: Vec<_> = (0..count).map(sample).collect();
        let level = |k: usize| k > 0 && k + 1 < count && (k - 1..k + 2).all(|i| samples[i][1] == samples[k][1]);
        (0..count).filter(|&k| !level(k)).map(|k| samples[k]).collect()
    }

    /// Absence of profiles: circle and plane, while nothing has flattened them.
    pub fn is_smooth(&self) -> bool {
        self.wheel.is_smooth() && self.rail.is_smooth()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::Undeformed;
    use crate::piecewise::Piecewise;

    #[test]
    fn a_bump_is_met_where_its_material_lies() {
        let none = Flattening::none(0.0);
        let gap = |surfaces: &Surfaces, distance: f64, angle: f64, x: f64| {
            let placement = Placement { surfaces, distance, angle, flattening: [&none; 2] };
            Undeformed { uneven: placement.unevenness(), ..Undeformed::smooth(surfaces.radius) }.gap(x)
        };
        let bump = |at: f64| Piecewise { x: vec![at - 0.01, at, at + 0.01], value: vec![0.0, 1e-4, 0.0] };
        let rail = Surfaces { rail: Profile::from_samples(bump(2.0)), ..Surfaces::smooth(0.5) };
        assert!((gap(&rail, 2.0, 0.0, 0.0) + 1e-4).abs() < 1e-15);
        assert!((gap(&rail, 1.995, 0.0, 0.005) - gap(&rail, 0.0, 0.0, 0.005)).abs() > 9e-5);
        assert_eq!(gap(&rail, 1.9, 0.0, 0.0), 0.0);
        let wheel = Surfaces { wheel: Profile::from_samples(bump(0.5)), ..Surfaces::smooth(0.5) };
        assert!((gap(&wheel, 0.0, 1.0, 0.0) + 1e-4).abs() < 1e-12);
        assert_eq!(gap(&wheel, 0.0, 2.0, 0.0), 0.0);
        assert!((gap(&wheel, 0.0, 0.98, 0.01) + 1e-4 - 0.01 * 0.01).abs() < 1e-7);
    }

    /// Waves of 0.01 mm, of which the bound of the warning is a twenty-fifth, and a ramp that steps follow.
    #[test]
    fn steps_of_whole_waves_miss_their_height_and_a_straight_slope_has_none() {
        let samples = |height: &dyn Fn(f64) -> f64| {
            let x: Vec<_> = (-1000..=2000).map(|k| 1e-3 * f64::from(k)).collect();
            let value = x.iter().map(|x| height(*x)).collect();
            Surfaces { rail: Profile::from_samples(Piecewise { x, value }), ..Surfaces::smooth(0.46) }
        };
        for wave in [0.1, 0.05, 0.1 / 3.0, 0.025] {
            let surfaces = samples(&|x| 1e-5 * (std::f64::consts::TAU * x / wave).sin());
            let missed = surfaces.missed([[0.0; 2], [0.0, 0.1]], 0.1, 6e-3);
            println!("waves of {wave} m: {missed:.2e} m");
            assert!((4e-6..2e-5).contains(&missed), "{wave}: {missed:e}");
        }
        assert!(samples(&|x| 1e-3 * x).missed([[0.0; 2], [0.0, 0.1]], 0.1, 6e-3) < 1e-12);
    }
}
