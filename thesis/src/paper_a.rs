//! Paper A as it was computed: meshes, parameters and waves of its studies, for the thesis's own scheme and for the
//! product.

use crate::Error;
use crate::mesh::Mesh;
use crate::ours::{Product, Run};
use crate::rail::{self, Plate};
use crate::rivara;
use crate::transient::{Case, Rolling};
use crate::wheel::{self, Annulus};
use std::f64::consts::TAU;
use wheelrail::config::{Config, RailEnds};
use wheelrail::surface::{Body, Profile};

/// Radii \[m].
pub const ANNULUS: Annulus = Annulus { outer: 0.46, inner: 0.046 };
/// Length and height of the rail \[m].
pub const PLATE: Plate = Plate { length: 1.0, height: 0.1 };
/// Load [N/m].
pub const LOAD: f64 = 4.7e6;
/// 100 km/h.
pub const SPEED: f64 = 100.0 / 3.6;
/// Stiffness-proportional damping of the thesis's scheme, α₁ \[s].
pub const DAMPING: f64 = 1e-4;
/// Mass of the wheel [kg/m] and angular frequency at which it bounces on its contact [rad/s], from an independent
/// eigenvalue analysis.
pub const BOUNCE: [f64; 2] = [5265.0, 2922.0];
/// Time step \[s].
pub const STEP: f64 = 5e-5;
/// Amplitude and length of the waves \[m].
pub const WAVE: [f64; 2] = [5e-6, 0.05];
/// Width of the contact \[m].
pub const PATCH: f64 = 0.01;
/// Edges under the contact before the whole wheel is refined \[m]: with this, meshes have about the sizes of table A 1.
pub const BASE: f64 = 10e-3;

/// Wheel and rail.
pub struct Meshes {
    /// Wheel.
    pub wheel: Mesh,
    /// Rail.
    pub rail: Mesh,
}

impl Meshes {
    /// Number of triangles.
    pub fn count(&self) -> usize {
        self.wheel.triangles.len() + self.rail.triangles.len()
    }
}

/// Meshes of \[A] § 3.1: `global` refinements of the wheel, `columns` nodes along a rail of seven rows at 0.1 m,
/// refined under the contact down to one and a half of the wheel's smallest element.
pub fn meshes(base: f64, global: usize, columns: usize, plate: Plate) -> Meshes {
    let wheel = wheel::early(ANNULUS, PATCH, base, global);
    let sizes = (0..wheel.triangles.len()).map(|t| rivara::longest(&wheel.corners(t)));
    let smallest = sizes.fold(f64::INFINITY, f64::min).sqrt();
    let rows = (6.0 * plate.height / PLATE.height).round() as usize + 1;
    // An edge that is halved last had been √2 of what its triangles are then.
    let rail = rail::refined(rail::coarse(plate, columns, rows), PATCH, 1.5 * std::f64::consts::SQRT_2 * smallest);
    Meshes { wheel, rail }
}

/// The standard case.
pub fn case() -> Case {
    Case {
        annulus: ANNULUS,
        plate: PLATE,
        ends: RailEnds::Nonreflecting,
        load: LOAD,
        hub_mass: 0.0,
        velocity: SPEED,
        damping: DAMPING,
        step: STEP,
        theta: 0.5,
        reach: 1.3 * PATCH,
    }
}

/// A profile of the rail from its text.
pub fn profile(text: &str) -> Result<Profile, String> {
    Profile::parse(text, None, Body::Rail).map_err(|error| error.to_string())
}

/// Waves of an amplitude and the length of the studies \[m], as text.
pub fn waves(amplitude: f64) -> String {
    waves_of([amplitude, WAVE[1]])
}

/// Waves of an amplitude and a length \[m], as text.
fn waves_of([amplitude, length]: [f64; 2]) -> String {
    format!("sinusoid(amplitude = {amplitude:?}, wavelength = {length:?})")
}

/// Way \[m] and force [N/m] after each of so many steps of the thesis's scheme.
pub fn history(case: Case, meshes: &Meshes, text: &str, steps: usize) -> Result<Vec<[f64; 2]>, String> {
    let profile = profile(text)?;
    let height = |x: f64| profile.height(x);
    let said = |error: Error| error.to_string();
    let mut rolling = Rolling::new(case, &meshes.wheel, &meshes.rail, &height).map_err(said)?;
    let mut points = Vec::with_capacity(steps);
    for _ in 0..steps {
        rolling.advance(&height).map_err(said)?;
        points.push([rolling.way, rolling.force()]);
    }
    Ok(points)
}

/// Amplitude [N/m] of a force over the way at the `length` \[m] of the waves, over the last five of them.
pub fn harmonic(points: &[[f64; 2]], length: f64) -> f64 {
    let end = points.last().map_or(0.0, |point| point[0]);
    let kept: Vec<_> = points.iter().filter(|point| point[0] > end - 5.0 * length + 1e-9).collect();
    let sum = kept.iter().fold([0.0; 2], |[a, b], [way, force]| {
        let (sin, cos) = (TAU * way / length).sin_cos();
        [a + force * sin, b + force * cos]
    });
    2.0 * sum[0].hypot(sum[1]) / kept.len() as f64
}

/// Steps of equal length nearest to `step` that divide a wave of `length` \[m] at this velocity, and how many of them:
/// 25 ms, and five waves.
fn division(length: f64, velocity: f64, step: f64) -> (f64, usize) {
    let period = length / velocity;
    let per_wave = (period / step).round().max(1.0);
    let waves = (0.025 / period).ceil() + 5.0;
    (period / per_wave, (waves * per_wave) as usize)
}

/// Amplitude on waves by the thesis's scheme.
pub fn amplitude(case: Case, meshes: &Meshes) -> Result<f64, String> {
    let (step, steps) = division(WAVE[1], case.velocity, case.step);
    Ok(harmonic(&history(Case { step, ..case }, meshes, &waves(WAVE[0]), steps)?, WAVE[1]))
}

/// The product as Paper A wants it, on a profile, with changes. It has no damping in proportion to the stiffness: a damper
/// between hub and vehicle gives the bounce of the wheel the same damping ratio, `c = α₁ m ω₀²`.
pub fn product(text: &str, change: impl FnOnce(&mut Config)) -> Result<Product, String> {
    Product::with("paper_a", |config| {
        config.thermal.enabled = false;
        config.vehicle.damping = DAMPING * BOUNCE[0] * BOUNCE[1] * BOUNCE[1];
        config.mesh.elements_per_half_width = 10;
        config.tuning.tolerance = 0.0;
        config.rail.ends = RailEnds::Nonreflecting;
        config.rail.profile = text.into();
        change(config);
    })
}

/// Way \[m] and force [N/m] of the product after each of so many steps \[s].
pub fn follow(run: &mut Run, step: f64, steps: usize) -> Result<Vec<[f64; 2]>, String> {
    let mut points = Vec::with_capacity(steps);
    for _ in 0..steps {
        run.advance(step)?;
        points.push([run.outputs().wheel_distance, run.outputs().contact_force_y]);
    }
    Ok(points)
}

/// Force on waves of a mass on a spring with the loss factor `ω α₁` over that of one that a damper `c = α₁ m ω₀²` holds:
/// `|1 + i ω α₁| / |1 − i α₁ ω₀²/ω|`, which is 1 at the angular frequency ω₀ of the bounce.
fn within_the_steel(omega: f64) -> f64 {
    1f64.hypot(omega * DAMPING) / 1f64.hypot(DAMPING * BOUNCE[1] * BOUNCE[1] / omega)
}

/// Amplitude on waves by the product, with damping of the contact in place of its damper.
pub fn our_amplitude(product: &Product, velocity: f64, step: f64) -> Result<f64, String> {
    answer(product, WAVE[1], velocity, step)
}

fn answer(product: &Product, length: f64, velocity: f64, step: f64) -> Result<f64, String> {
    let (step, steps) = division(length, velocity, step);
    let force = harmonic(&follow(&mut product.rolling(velocity, 0.0, |_| ())?, step, steps)?, length);
    Ok(force * within_the_steel(TAU * velocity / length))
}

/// Amplitude on waves of the given amplitude and length \[m] that pass with the angular frequency `omega` [rad/s], by
/// the product with 20 elements in half a contact.
pub fn our_answer(wave: [f64; 2], omega: f64) -> Result<f64, String> {
    let velocity = omega * wave[1] / TAU;
    let product = product(&waves_of(wave), |config| config.mesh.elements_per_half_width = 20)?;
    answer(&product, wave[1], velocity, wave[1] / velocity / 80.0)
}
