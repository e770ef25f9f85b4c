//! Heat that enters over the width of the contact spreads into rim, web, boss and rail head.

use crate::common;
use crate::heat_common::{self, Run, deviation, heat};
use std::f64::consts::PI;
use wheelrail::analytic::{contact_modulus, hertz_half_width};
use wheelrail::config::Hub;
use wheelrail::heat::{Exchange, HeatModel, HeatParameters, HeatScratch, HeatSource, Widths};
use wheelrail::piecewise::Piecewise;
use wheelrail::rolling::thermal::heat_parameters;
use wheelrail::simulation::{Inputs, Simulation};

/// The heat model of the default parameters with an insulated hub, for a contact of the given width \[m].
fn config(contact_width: f64) -> HeatParameters {
    let mut config = common::preset("railway", 10);
    config.thermal.hub = Hub::Insulated;
    let modulus = contact_modulus(config.material.youngs_modulus, config.material.poissons_ratio);
    let half_width = hertz_half_width(100e3 / 0.014, config.wheel.radius, modulus);
    let zone = 1.5 * half_width;
    HeatParameters { contact_width, elements_per_half_width: 10, ..heat_parameters(&config, half_width, zone, zone) }
}

/// Widths of the bodies.
fn widths(c: &mut HeatParameters) -> &mut Widths {
    c.widths.as_mut().unwrap()
}

/// `∫ f dx` from 0 to `end` by the midpoint rule.
fn integral(end: f64, f: impl Fn(f64) -> f64) -> f64 {
    const POINTS: u32 = 4000;
    let h = end / f64::from(POINTS);
    h * (0..POINTS).map(|i| f(h * (f64::from(i) + 0.5))).sum::<f64>()
}

/// `∫₀ˣ erf(u) du`.
fn integral_of_erf(x: f64) -> f64 {
    // ∫₀ˣ (x − u) 2/√π e^{−u²} du, in which the integrand is nothing beyond 7.
    let end = x.min(7.0);
    2.0 / PI.sqrt() * integral(end, |u| (x - u) * (-u * u).exp())
}

/// Mean temperature of a strip of the width `w` \[m] under the flux 1 W/m² since `time` \[s], on a half-space.
///
/// A strip source that is held for dτ leaves `dτ/(ρc √(πκτ))` times the share of its heat that is still below the
/// strip, a Gaussian in the distance across (Carslaw & Jaeger, *Conduction of Heat in Solids*, 2nd ed., 10.5), whose
/// mean over the strip is `(L/w) ∫ erf(u) du` from 0 to `w/L`, `L = √(4κτ)`.
fn mean_of_the_strip(w: f64, time: f64, diffusivity: f64, heat_capacity: f64) -> f64 {
    const STEPS: i32 = 400;
    let h = time.sqrt() / f64::from(STEPS);
    let stays = |root: f64| {
        let reach = w / (2.0 * root * diffusivity.sqrt());
        integral_of_erf(reach) / reach
    };
    let sum: f64 = (0..STEPS).map(|i| stays(h * (f64::from(i) + 0.5))).sum();
    2.0 * h * sum / (heat_capacity * (PI * diffusivity).sqrt())
}

/// Heat over the whole circumference spreads like that of an endless strip. The closed form knows no model of ours; the
/// wheel is made so large that neither its curvature nor its ends are felt.
#[test]
fn mean_temperature_of_a_strip_on_a_half_space_is_right_within_3_percent_up_to_60_seconds() {
    for width in [0.003, 0.005, 0.014, 0.04] {
        let config = heat_common::with(config(width), |c| {
            (c.radius, c.hub_radius) = (20.0, 18.0);
            *widths(c) = Widths { rim: 10.0, rim_depth: 2.0, block: width, boss: 10.0 * 0.17 / 0.135, ..*widths(c) };
        });
        let heat = heat(&config);
        let (mut state, mut scratch) = (heat.initial(0.0, 0.0), HeatScratch::default());
        // 1 W/m² all around.
        let sources = vec![HeatSource::on_tread(0.0, 2.0 * PI, 2.0 * PI * config.radius)];
        let exchange = Exchange { sources, ..Exchange::default() };
        let (mut time, mut worst) = (0.0, 0.0_f64);
        for after in [1e-3, 1e-2, 0.1, 0.3, 1.0, 3.0, 10.0, 20.0, 60.0] {
            let h = (after - time) / 100.0;
            (0..100).for_each(|_| _ = heat.advance(&mut state, h, 0.0, 2.0, &exchange, &mut scratch));
            time = after;
            let exact = mean_of_the_strip(width, time, config.diffusivity(), config.heat_capacity());
            let off = deviation(heat.temperatures(&state).wheel_centre, exact);
            common::figure("strip", &[off]);
            println!("width {:.0} mm, {time} s: {:+.2} %", 1e3 * width, 100.0 * off);
            worst = worst.max(off.abs());
        }
        assert!(worst < 0.03, "{worst}");
    }
}

/// Section of the real wheel times its circumferences: rim, web and boss. The part that conducts ends a little deeper
/// than the real rim, whose flanks are further from the contact; the web is shorter by that.
#[test]
fn a_warm_wheel_holds_the_heat_of_its_rim_web_and_boss() {
    let content = |config: &HeatParameters| {
        let heat = heat(config);
        heat.heat_content(&heat.initial(1.0, 0.0)).unwrap()[0] * config.contact_width / config.heat_capacity()
    };
    let config = config(0.014);
    let (r, t) = (config.radius, config.widths.unwrap());
    let ring = |outer: f64, inner: f64| PI * (outer * outer - inner * inner);
    let inside = r - t.rim_depth;
    let rim = t.rim * ring(r, inside);
    let whole = rim + t.web * ring(inside, t.boss_radius) + t.boss * ring(t.boss_radius, config.hub_radius);
    let mass = config.material.density * content(&config);
    println!(
        "{mass:.1} kg, {:.1} kg of it rim; drawn {:.1} kg",
        config.material.density * rim,
        config.material.density * whole
    );
    assert!((content(&config) / whole - 1.0).abs() < 0.05);
    // Next to nothing but rim.
    let alone = heat_common::with(config.clone(), |c| (widths(c).web, widths(c).boss) = (1e-4, 1e-4));
    let bare = 1e-4 * ring(inside, config.hub_radius);
    assert!((content(&alone) / (rim + bare) - 1.0).abs() < 2e-3, "{}", content(&alone) / rim);
    let narrow = heat_common::with(config.clone(), |c| c.widths = None);
    let slice = 0.014 * ring(r, config.hub_radius);
    assert!((content(&narrow) / slice - 1.0).abs() < 1e-12);
    // At next to no cost.
    let unknowns = [&config, &narrow].map(|config| heat(config).unknowns());
    println!("{unknowns:?} unknown temperatures");
    assert!(unknowns[0] as f64 / (unknowns[1] as f64) < 1.15);
}

/// A wheel as wide as the contact throughout, whose web or boss is twice as wide, holds that much more; below the cone in which
/// heat spreads the rail is as wide as its head.
#[test]
fn web_boss_and_head_hold_the_heat_of_their_own_widths() {
    let content = |body: usize, change: &dyn Fn(&mut HeatParameters)| {
        let config = heat_common::with(config(0.014), |c| {
            *widths(c) = Widths { rim: 0.014, web: 0.014, boss: 0.014, ..*widths(c) };
            change(c);
        });
        let heat = heat(&config);
        heat.heat_content(&heat.initial(1.0, 1.0)).unwrap()[body] * config.contact_width / config.heat_capacity()
    };
    let ring = |outer: f64, inner: f64| PI * (outer * outer - inner * inner);
    let even = content(0, &|_| ());
    let web = content(0, &|c| widths(c).web = 0.028) - even;
    let boss = content(0, &|c| widths(c).boss = 0.028) - even;
    let tall = |height: f64| content(1, &|c| c.rail_height = height);
    let (head, length) = (tall(0.12) - tall(0.1), config(0.014).rail_length);
    for (name, found, expected) in [
        ("wheel", even, 0.014 * ring(0.46, 0.046)),
        ("web", web, 0.014 * ring(0.46 - 0.06, 0.13)),
        ("boss", boss, 0.014 * ring(0.13, 0.046)),
        ("head", head, 0.072 * 0.02 * length),
    ] {
        println!("{name}: {found:.6e} for {expected:.6e} m3");
        assert!((found / expected - 1.0).abs() < 1e-6, "{name}: {found:e} for {expected:e} m3");
    }
}

/// Area of tread, rim sides and both sides of the web times the coefficient.
#[test]
fn a_warm_wheel_loses_heat_to_the_air_from_tread_rim_and_web() {
    let config = heat_common::with(config(0.014), |c| c.convection = 20.0);
    let heat = heat(&config);
    let mut state = heat.initial(100.0, 0.0);
    let flows = heat.advance(&mut state, 1e-3, 10.0, 20.0, &Exchange::default(), &mut HeatScratch::default());
    let (r, t) = (config.radius, config.widths.unwrap());
    let ring = |outer: f64, inner: f64| PI * (outer * outer - inner * inner);
    let area = 2.0 * PI * r * t.rim + 2.0 * ring(r, t.boss_radius);
    let ratio = flows.wheel_to_air * config.contact_width / (20.0 * 100.0 * area);
    println!("{:.1} W from {area:.3} m2, ratio {ratio:.4}", flows.wheel_to_air * config.contact_width);
    assert!((ratio - 1.0).abs() < 1e-3, "{ratio}");
    assert!(flows.relative_imbalance() < 1e-9);
}

/// A rail that streams through the friction heat of an elliptic pressure. To first order the mean over the strip loses
/// `√(κt/π)/w` to the sides, `t` the time since the leading edge: half a per cent at 36 km/h. That is physics of a
/// strip, which an infinitely wide contact does not have; nothing else changes.
#[test]
fn the_flash_temperature_loses_little_to_the_sides() {
    for speed in [10.0, 30.0, 60.0] {
        let rise = |spreads: bool| {
            let config = heat_common::with(config(0.014), |c| {
                (c.widths, c.wheel_share) = (c.widths.filter(|_| spreads), 0.0);
            });
            let (heat, a) = (heat(&config), config.half_width);
            let power = |x: f64| 2e6 * speed * (1.0 - (x / a).powi(2)).max(0.0).sqrt();
            let friction_power = Piecewise::sampled(-a, a, 200, power);
            let exchange = Exchange { friction_power, ..Exchange::default() };
            let (state, _) = heat.stationary(speed, 0.0, &exchange).unwrap();
            heat.temperatures(&state).rail_max
        };
        let off = rise(true) / rise(false) - 1.0;
        let config = config(0.014);
        // The hottest place lies 0.65 a behind the middle.
        let time = 1.65 * config.half_width / speed;
        let expected = -(config.diffusivity() * time / PI).sqrt() / config.contact_width;
        println!("{speed} m/s: flash temperature {:+.4} %, expected {:+.4} %", 100.0 * off, 100.0 * expected);
        assert!((off / expected - 1.0).abs() < 0.2, "{off}");
    }
}

/// In plane strain it would grow by 1 + ν times as much. Only its hub is cold here.
#[test]
fn a_warm_free_wheel_grows_by_expansion_times_temperature_times_radius() {
    let mut config = common::preset("railway", 10);
    config.thermal.wheel_excess = 100.0;
    let inputs = Inputs::rolling(&config);
    let simulation = Simulation::new(common::model(config), &inputs).unwrap();
    let o = simulation.outputs();
    let bulk = o.temperature_wheel_bulk - 293.0;
    println!("growth {:.6e} m at {bulk:.3} K", o.thermal_growth);
    assert!((o.thermal_growth / (1.2e-5 * bulk * 0.46) - 1.0).abs() < 1e-9);
    assert!((bulk / 100.0 - 1.0).abs() < 0.03);
}
