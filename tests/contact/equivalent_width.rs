//! Which width for what: the line contact against the elliptical contact of a wheel on a rail head that it stands for.

use crate::common::*;
use std::f64::consts::PI;
use wheelrail::analytic::{contact_modulus, hertz_half_width, hertz_peak_pressure, moving_source};
use wheelrail::config::{Config, StartTemperature};
use wheelrail::simulation::{Inputs, Simulation};

/// Radius of the rail head across the rail \[m].
const HEAD: f64 = 0.3;
/// Elements per half-width.
const ELEMENTS: usize = 8;
/// Creepage of the sliding cases \[1].
const CREEPAGE: f64 = 0.01;

/// Complete elliptic integrals `K` and `E` of the parameter `m = e²`, by the arithmetic-geometric mean (DLMF 19.8).
fn elliptic_integrals(m: f64) -> (f64, f64) {
    let (mut a, mut b, mut c) = (1.0f64, (1.0 - m).sqrt(), m.sqrt());
    let (mut sum, mut weight) = (0.5 * c * c, 1.0);
    while c.abs() > 1e-15 {
        (a, b, c) = (0.5 * (a + b), (a * b).sqrt(), 0.5 * (a - b));
        sum += weight * c * c;
        weight *= 2.0;
    }
    let k = 0.5 * PI / a;
    (k, k * (1.0 - sum))
}

/// Elliptical Hertzian contact of two bodies of the same material.
#[derive(Debug)]
struct Ellipse {
    /// Semi-axis in the direction of travel \[m].
    along: f64,
    /// Semi-axis across \[m].
    across: f64,
    /// Peak pressure \[Pa].
    pressure: f64,
}

impl Ellipse {
    /// A wheel of radius `wheel` on a head of the smaller radius `head`, both \[m] (Johnson, *Contact Mechanics*,
    /// 4.26-4.28).
    fn new(load: f64, wheel: f64, head: f64, modulus: f64) -> Self {
        // Ratio of the curvatures by the ratio of the axes: (E/q² − K)/(K − E), which grows with the eccentricity.
        let (mut low, mut high) = (1e-9, 1.0 - 1e-9);
        for _ in 0..100 {
            let m = 0.5 * (low + high);
            let (k, e) = elliptic_integrals(m);
            if (e / (1.0 - m) - k) / (k - e) < wheel / head { low = m } else { high = m }
        }
        let (k, e) = elliptic_integrals(low);
        let along = (1.5 * load / PI * (k - e) / (modulus * low * 0.5 / wheel)).cbrt();
        let across = along * (1.0 - low).sqrt();
        Self { along, across, pressure: 1.5 * load / (PI * along * across) }
    }

    /// Slope of the tangential force over the creepage \[N], `G a b C₁₁`. C₁₁ from Kalker's table (*Three-Dimensional
    /// Elastic Bodies in Rolling Contact*, Kluwer 1990, table E3) for b/a = 0.8 and 0.7, linear between, parabolic in
    /// Poisson's ratio.
    fn creep_slope(&self, config: &Config) -> f64 {
        let share = (0.8 - self.across / self.along) / 0.1;
        assert!((0.0..=1.0).contains(&share), "outside the tabulated ratios");
        // Poisson's ratio 0, 1/4 and 1/2.
        let table = [[3.65, 3.82], [4.36, 4.54], [5.42, 5.58]].map(|[wide, narrow]| wide + share * (narrow - wide));
        let x = config.material.poissons_ratio / 0.25;
        let weights = [0.5 * (x - 1.0) * (x - 2.0), x * (2.0 - x), 0.5 * x * (x - 1.0)];
        let coefficient: f64 = table.iter().zip(weights).map(|(c, w)| c * w).sum();
        shear_modulus(config) * self.along * self.across * coefficient
    }

    /// The strip in the middle. Under the shear `q₀ √(1 − x²/a² − y²/b²)` the surface of a half-space moves by
    /// `1/(2πG) ∬ q [(1 − ν)/s + ν (x − ξ)²/s³] dξ dη` (Johnson, 3.7); along the rays from the point, the integral over
    /// the distance `s` is elementary, which leaves `du/dx = −q₀ x/(2G a² b²) ∫ ((1 − ν) + ν cos²φ) sin²φ/A³ dφ` over
    /// half a turn with `A² = cos²φ/a² + sin²φ/b²` (derived here; a circle gives Johnson's 3.91).
    fn strip(&self, config: &Config) -> Strip {
        const RAYS: i32 = 200;
        let nu = config.material.poissons_ratio;
        let ray = |k: i32| {
            let (sine, cosine) = (PI * (f64::from(k) + 0.5) / f64::from(RAYS)).sin_cos();
            let stretch = ((cosine / self.along).powi(2) + (sine / self.across).powi(2)).sqrt();
            (1.0 - nu + nu * cosine * cosine) * sine * sine / stretch.powi(3)
        };
        let integral = (0..RAYS).map(ray).sum::<f64>() * PI / f64::from(RAYS);
        let shear = config.friction.coefficient * self.pressure;
        let gradient = shear * integral / (shear_modulus(config) * (self.along * self.across).powi(2));
        Strip { half_width: self.along, pressure: self.pressure, gradient }
    }
}

/// Widths at which the line contact equals the ellipse \[m]. With `P/w = πE*a²/(4R)`: peak pressure `√(P E*/(πRw))`,
/// half-width `√(4PR/(πE*w))`, slope of Carter's law `√(πE*PRw)`; the one of the flash temperature at 1 % creepage is
/// searched for.
struct Widths {
    pressure: f64,
    half_width: f64,
    slope: f64,
    flash: f64,
}

impl Widths {
    fn new(config: &Config, ellipse: &Ellipse) -> Self {
        let (load, radius, modulus) = (config.model.nominal_load, config.wheel.radius, modulus(config));
        let unit_half_width = hertz_half_width(load, radius, modulus);
        let unit_pressure = hertz_peak_pressure(load, unit_half_width);
        let flash = ellipse.strip(config).flash(config);
        let (mut low, mut high) = (1e-3, 0.1);
        for _ in 0..40 {
            let middle: f64 = 0.5 * (low + high);
            if Strip::of_line(config, middle).flash(config) > flash { low = middle } else { high = middle }
        }
        Self {
            pressure: (unit_pressure / ellipse.pressure).powi(2),
            half_width: (unit_half_width / ellipse.along).powi(2),
            slope: ellipse.creep_slope(config).powi(2) / (PI * modulus * load * radius),
            flash: low,
        }
    }
}

/// A strip along the travel that slips fully, at 1 % creepage: elliptical pressure, and a slip that grows towards the
/// trailing edge because friction compresses the surface in front and stretches it behind.
struct Strip {
    half_width: f64,
    pressure: f64,
    /// Decrease of the local creepage along the travel [1/m].
    gradient: f64,
}

impl Strip {
    /// The line contact of that width: Carter's slip in full sliding, `ξ − μx/R` (Johnson, 8.3).
    fn of_line(config: &Config, width: f64) -> Self {
        let half_width = hertz_half_width(config.model.nominal_load / width, config.wheel.radius, modulus(config));
        let pressure = hertz_peak_pressure(config.model.nominal_load / width, half_width);
        Self { half_width, pressure, gradient: config.friction.coefficient / config.wheel.radius }
    }

    /// Flash temperature at 1 % creepage \[K]: both bodies have the same temperature. Heat flows into the depth only
    /// (fast source), so every strip is as if alone (M. Ertz, K. Knothe, *Wear* 253 (2002) 498-508).
    fn flash(&self, config: &Config) -> f64 {
        let m = &config.material;
        let effusivity = (m.conductivity * m.density * m.specific_heat).sqrt();
        let (travel, a) = (config.initial.velocity, self.half_width);
        // The tread runs under the contact a little slower than the rail.
        let tread = travel * (1.0 - 0.5 * CREEPAGE) / (1.0 + 0.5 * CREEPAGE);
        let (mean, together) = (0.5 * (travel + tread), (travel.sqrt() + tread.sqrt()).powi(2));
        let flux = |x: f64| {
            let pressure = self.pressure * (1.0 - (x / a).powi(2)).max(0.0).sqrt();
            config.friction.coefficient * pressure * mean * (CREEPAGE - self.gradient * x)
        };
        let rise = |k: i32| moving_source(-0.005 * f64::from(k) * a, a, together, effusivity, &flux);
        (0..200).map(rise).fold(0.0, f64::max)
    }
}

fn shear_modulus(config: &Config) -> f64 {
    0.5 * config.material.youngs_modulus / (1.0 + config.material.poissons_ratio)
}

fn modulus(config: &Config) -> f64 {
    contact_modulus(config.material.youngs_modulus, config.material.poissons_ratio)
}

/// The railway wheel with that width, with constant friction and without what the closed forms do not have.
fn with_width(width: f64) -> Config {
    let mut config = preset("railway", ELEMENTS);
    config.model.contact_width = width;
    config.tuning.softening = 0.0;
    (config.physics.centrifugal, config.material.expansion) = (false, 0.0);
    config.initial.temperature = StartTemperature::Stationary;
    // Equal temperatures of both surfaces.
    config.thermal.conductance = 1e9;
    config
}

/// Line contact as a model computes it.
#[derive(Debug)]
struct Line {
    /// Peak pressure \[Pa].
    pressure: f64,
    /// Half-width \[m].
    half_width: f64,
    /// Slope of the tangential force over the creepage \[N].
    slope: f64,
    /// Largest rise of the rail's temperature at 1 % creepage \[K], less the share of the tread's warmth on arrival.
    flash: f64,
}

impl Line {
    fn computed(width: f64) -> Self {
        let config = with_width(width);
        let reference = config.thermal.reference;
        let model = model(config);
        let at = |creepage: f64| {
            let inputs: Inputs = prescribed(&model, model.config().initial.velocity, creepage);
            Simulation::new(model.clone(), &inputs).unwrap().outputs().clone()
        };
        // The law of Carter has a kink in its curvature where the wheel rolls freely: the slope is taken on both sides
        // of it.
        let [trial, rolling] = [1e-5, 0.0].map(at);
        let free = 1e-5 * rolling.contact_force_x / (rolling.contact_force_x - trial.contact_force_x);
        let [back, forth, sliding] = [free - 1e-5, free + 1e-5, CREEPAGE].map(at);
        let arriving = sliding.profile_temperature_wheel.last().unwrap() - reference;
        Self {
            pressure: rolling.contact_pressure_max,
            half_width: rolling.contact_half_width,
            slope: (back.contact_force_x - forth.contact_force_x) / 2e-5,
            flash: sliding.temperature_rail_max - reference - 0.5 * arriving,
        }
    }
}

#[test]
fn the_patch_under_100_kn_has_semi_axes_of_7_2_and_5_4_mm_and_1238_mpa() {
    let config = with_width(0.014);
    let ellipse = Ellipse::new(1e5, config.wheel.radius, HEAD, modulus(&config));
    println!("{ellipse:?}");
    assert!((ellipse.along / 7.2e-3 - 1.0).abs() < 0.01 && (ellipse.across / 5.4e-3 - 1.0).abs() < 0.01);
    assert!((ellipse.pressure / 1238e6 - 1.0).abs() < 1e-3);
    // Equal radii: a circle with a = (3PR/(4E*))^(1/3), Johnson 4.22, where the two radii R make the curvature 1/R.
    let circle = Ellipse::new(1e5, 0.46, 0.46 * (1.0 - 1e-9), modulus(&config));
    let radius = (0.75 * 1e5 * 0.46 / modulus(&config)).cbrt();
    assert!((circle.along / radius - 1.0).abs() < 1e-6, "{:e} for {radius:e}", circle.along);
}

#[test]
fn each_equivalent_width_reproduces_its_property_of_the_elliptical_contact() {
    let config = with_width(0.014);
    let ellipse = Ellipse::new(config.model.nominal_load, config.wheel.radius, HEAD, modulus(&config));
    let (slope, flash) = (ellipse.creep_slope(&config), ellipse.strip(&config).flash(&config));
    let widths = Widths::new(&config, &ellipse);
    figure_within(0.002, "width.ellipse", &[ellipse.pressure / 1e6, 1e3 * ellipse.along, slope / 1e6, flash]);
    println!("ellipse: {:.1} MPa, {:.3} mm", ellipse.pressure / 1e6, ellipse.along * 1e3);
    println!("         slope {:.3} MN, flash {flash:.2} K at 1 % and {:.2} m/s", slope / 1e6, config.initial.velocity);
    // Model over ellipse: pressure, half-width, slope, flash.
    let ratios = |name: &str, width: f64| {
        let line = Line::computed(width);
        let given = [line.pressure, line.half_width, line.slope, line.flash];
        let ratios: Vec<f64> =
            given.iter().zip([ellipse.pressure, ellipse.along, slope, flash]).map(|(a, b)| a / b).collect();
        figure_within(
            0.005,
            &format!("width.{}", name.replace('-', ".")),
            &[line.pressure / 1e6, 1e3 * line.half_width, line.slope / 1e6, line.flash],
        );
        println!(
            "{name:10} {:6.3} mm: {:.1} MPa, {:.3} mm, {:.3} MN, {:.2} K; over the ellipse {ratios:.4?}",
            width * 1e3,
            line.pressure / 1e6,
            line.half_width * 1e3,
            line.slope / 1e6,
            line.flash
        );
        ratios
    };
    let named = [
        ("pressure", widths.pressure, 0.0052, 0, 0.003),
        ("half-width", widths.half_width, 0.0099, 1, 0.003),
        ("slope", widths.slope, 0.0125, 2, 0.02),
        ("flash", widths.flash, 0.0065, 3, 0.02),
    ];
    for (name, width, documented, property, tolerance) in named {
        let found = ratios(name, width)[property];
        figure(&format!("equivalent.{}", property + 1), &[found - 1.0]);
        assert!((width - documented).abs() < 1e-4, "{name}: {width:e} m, documented {documented:e} m");
        assert!((found - 1.0).abs() < tolerance, "{name}: {found}");
    }
    let forces = ratios("railway", config.model.contact_width);
    assert!((forces[2] - 1.0).abs() < 0.08 && forces[0] < 0.62 && forces[3] < 0.6, "{forces:?}");
}

#[test]
fn the_preset_for_damage_has_the_peak_pressure_of_the_ellipse_and_the_mass_of_the_other_preset() {
    let [railway, damage] = ["railway", "railway_damage"].map(|name| preset(name, ELEMENTS));
    let ellipse = Ellipse::new(railway.model.nominal_load, railway.wheel.radius, HEAD, modulus(&railway));
    assert!((damage.model.contact_width / Widths::new(&railway, &ellipse).pressure - 1.0).abs() < 0.005);
    // Annulus and hub together weigh the same.
    let total = |config: &Config| {
        let w = &config.wheel;
        let (outer, inner) = (w.radius * w.radius, w.hub_radius * w.hub_radius);
        let annulus = config.material.density * PI * (outer - inner) * config.model.contact_width;
        [w.hub_mass + annulus, w.hub_inertia + 0.5 * annulus * (outer + inner)]
    };
    let [[mass, inertia], [expected_mass, expected_inertia]] = [total(&damage), total(&railway)];
    assert!((mass / expected_mass - 1.0).abs() < 1e-4 && (inertia / expected_inertia - 1.0).abs() < 1e-4);
    let outputs = Simulation::new(model(damage.clone()), &Inputs::rolling(&damage)).unwrap().outputs().clone();
    println!("{:.1} MPa, half-width {:.3} mm", outputs.contact_pressure_max / 1e6, outputs.contact_half_width * 1e3);
    assert!((outputs.contact_pressure_max / ellipse.pressure - 1.0).abs() < 0.01);
}
