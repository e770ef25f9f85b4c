//! The thesis's wheel and rail under given Hertz–Carter contact, and Hertz–Carter friction power.
#![allow(dead_code)]

use wheelrail::analytic::{contact_modulus, hertz_half_width, hertz_peak_pressure};
use wheelrail::config::presets;
use wheelrail::heat::{
    Exchange, Heat, HeatFlows, HeatLine, HeatModel, HeatParameters, HeatScratch, HeatSource, HeatState, Observation,
    Temperatures,
};
pub use wheelrail::piecewise::Interval;
use wheelrail::piecewise::Piecewise;
use wheelrail::rolling::thermal::heat_parameters;

pub const KMH: f64 = 1.0 / 3.6;
pub const RADIUS: f64 = 0.5;
pub const FRICTION: f64 = 0.4;
pub const YOUNG: f64 = 200e9;
pub const POISSON: f64 = 0.3;

pub fn half_width(load: f64) -> f64 {
    hertz_half_width(load, RADIUS, contact_modulus(YOUNG, POISSON))
}

/// Set-up of the reference values, laid out for one load [N/m] and up to `max_speed` [m/s].
pub fn config(load: f64, max_speed: f64) -> HeatParameters {
    let half_width = half_width(load);
    let zone = 1.5 * half_width;
    let preset = presets::parse(include_str!("../../resources/paper_b.json")).unwrap();
    HeatParameters {
        hub_held: true,
        max_speed,
        smallest_load_ratio: 1.0,
        elements_per_half_width: 20,
        ..heat_parameters(&preset, half_width, zone, zone)
    }
}

/// Parameters with changes.
pub fn with(mut config: HeatParameters, change: impl FnOnce(&mut HeatParameters)) -> HeatParameters {
    change(&mut config);
    config
}

/// Steps and observations that must succeed.
pub trait Run {
    /// Replaces `state` by the state `dt` later.
    fn advance(
        &self,
        state: &mut HeatState,
        dt: f64,
        velocity: f64,
        omega: f64,
        exchange: &Exchange,
        scratch: &mut HeatScratch,
    ) -> HeatFlows;

    fn observed(&self, state: &HeatState) -> Observation;

    fn temperatures(&self, state: &HeatState) -> Temperatures {
        self.observed(state).temperatures
    }
}

impl Run for Heat {
    fn advance(
        &self,
        state: &mut HeatState,
        dt: f64,
        velocity: f64,
        omega: f64,
        exchange: &Exchange,
        scratch: &mut HeatScratch,
    ) -> HeatFlows {
        let mut next = HeatState::default();
        let mut line = HeatLine::new(state, &mut next, exchange);
        self.step(std::slice::from_mut(&mut line), dt, velocity, omega, scratch).unwrap();
        let flows = line.flows;
        *state = next;
        flows
    }

    fn observed(&self, state: &HeatState) -> Observation {
        let mut seen = Observation::default();
        self.observe(state, &mut seen).unwrap();
        seen
    }
}

/// Angular velocity that rolls with the given creepage [rad/s].
pub fn omega(velocity: f64, creepage: f64) -> f64 {
    velocity * (2.0 - creepage) / (2.0 + creepage) / RADIUS
}

/// Friction power of Carter's contact; full slip beyond the limit, sliding at creepage 2.
///
/// Slip of two equal cylinders `|s| = V_m (μ/r) √((x − d)² − b²)` behind the stick zone of half-width `b` centred at
/// `d = a − b` (Johnson, *Contact Mechanics*, 8.3).
pub fn carter(load: f64, velocity: f64, creepage: f64) -> Exchange {
    let a = half_width(load);
    let p0 = hertz_peak_pressure(load, a);
    let circumferential = omega(velocity, creepage) * RADIUS;
    let mean = 0.5 * (velocity + circumferential);
    let d = creepage.abs() * RADIUS / FRICTION;
    let ellipse = |x: f64, half: f64| (1.0 - x * x / (half * half)).max(0.0).sqrt();
    let patches = vec![Interval { low: -a, high: a }];
    let friction_power = if circumferential == 0.0 {
        Piecewise::sampled(-a, a, 400, |x| FRICTION * p0 * ellipse(x, a) * velocity.abs())
    } else if d >= a {
        let slip = |x: f64| mean * (creepage.abs() - FRICTION * x / RADIUS);
        Piecewise::sampled(-a, a, 400, |x| FRICTION * p0 * ellipse(x, a) * slip(x))
    } else {
        let b = a - d;
        // x = d − b − t² near the stick zone: dense sampling at the square-root kink.
        Piecewise::sampled(-a, d - b, 400, |x| {
            let slip = mean * FRICTION / RADIUS * ((x - d) * (x - d) - b * b).max(0.0).sqrt();
            FRICTION * p0 * ellipse(x, a) * slip
        })
    };
    Exchange { patches, friction_power, ..Exchange::default() }
}

/// Two brake blocks of 45° at ±90° from the contact.
pub fn brake_blocks(total: f64) -> Vec<HeatSource> {
    use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};
    [1.0, -1.0].map(|side| HeatSource::on_tread(side * FRAC_PI_2, FRAC_PI_4, 0.5 * total)).to_vec()
}

pub fn heat(config: &HeatParameters) -> Heat {
    Heat::new(config).unwrap()
}

/// Relative deviation from a reference value.
pub fn deviation(value: f64, reference: f64) -> f64 {
    value / reference - 1.0
}
