//! A second heat model behind the seam of the first: flash temperatures of half-planes that move fast, on a wheel of
//! one temperature. It has no mesh; what it needs it takes from the exchange, and the rolling motion runs on it
//! unchanged.

use crate::common::{self, preset};
use std::f64::consts::PI;
use wheelrail::config::{Config, StartTemperature};
use wheelrail::heat::{
    Exchange, HeatError, HeatFlows, HeatLine, HeatModel, HeatParameters, HeatScratch, HeatState, Observation,
    TemperatureField, Temperatures,
};
use wheelrail::mechanics::{Basis, bodies};
use wheelrail::piecewise::{Interval, Piecewise};
use wheelrail::rolling::outputs::observe;
use wheelrail::rolling::{Inputs, RollingModel, Rotation, State, Translation, Workspace, stationary, substeps};
use wheelrail::simulation::Outputs;
use wheelrail::surface::Surfaces;

/// Surface positions at which flashes are known, on each side of the contact point.
const POINTS: usize = 400;
/// Creepage at which all of the patch slides.
const CREEPAGE: f64 = 0.2;
/// Velocity of the wheel [m/s].
const VELOCITY: f64 = 20.0;

/// Lumped wheel under flashes: `T(x) = T_wheel + ∫ q(ξ) / √(π kρc V (ξ − x)) dξ` over all ξ upstream of x, each surface
/// with half of the friction heat (Carslaw and Jaeger, *Conduction of Heat in Solids*, 10.7, at a high Péclet number).
///
/// Unknowns: temperature of the wheel, temperature of the arriving rail, flashes of the wheel, flashes of the rail.
struct FlashModel {
    zone: Vec<f64>,
    radius: f64,
    /// Share of the friction power that becomes heat.
    heat_ratio: f64,
    /// `√(kρc)` [J/(m² K √s)].
    effusivity: f64,
    /// Heat capacity of the wheel [J/(m K)].
    capacity: f64,
}

impl FlashModel {
    fn new(config: &HeatParameters) -> Self {
        let place = |i: usize| config.reach * (i as f64 / POINTS as f64 - 1.0);
        let (outer, inner) = (config.radius, config.hub_radius);
        Self {
            zone: (0..=2 * POINTS).map(place).collect(),
            radius: outer,
            heat_ratio: config.heat_ratio,
            effusivity: (config.material.conductivity * config.heat_capacity()).sqrt(),
            capacity: config.heat_capacity() * PI * (outer * outer - inner * inner),
        }
    }

    /// Flashes at all positions of a surface that moves with `speed` [m/s] under the flux `q` [W/m²]: exact integrals
    /// over the pieces of a piecewise linear flux.
    fn flashes(&self, q: &Piecewise, speed: f64, share: f64, out: &mut Vec<f64>) {
        let scale = share / (self.effusivity * (PI * speed).sqrt());
        for &x in &self.zone {
            let mut sum = 0.0;
            for (ends, flux) in q.segments() {
                let slope = (flux[1] - flux[0]) / (ends[1] - ends[0]);
                let at_x = flux[0] + slope * (x - ends[0]);
                let primitive = |end: f64| {
                    let ahead = (end - x).max(0.0);
                    ahead.sqrt() * (2.0 * at_x + 2.0 / 3.0 * slope * ahead)
                };
                sum += primitive(ends[1]) - primitive(ends[0]);
            }
            out.push(scale * sum);
        }
    }

    /// Unknowns of the wheel temperature `wheel` and what acts, and the flows into both bodies.
    fn evaluate(&self, wheel: f64, speeds: [f64; 2], exchange: &Exchange) -> Result<(HeatState, HeatFlows), HeatError> {
        let [velocity, omega] = speeds;
        for (name, value) in [("velocity", velocity), ("angular velocity", omega)] {
            if value <= 0.0 {
                return Err(HeatError::Input { name, value });
            }
        }
        let mut values = vec![wheel, exchange.arriving];
        for speed in [omega * self.radius, velocity] {
            self.flashes(&exchange.friction_power, speed, 0.5 * self.heat_ratio, &mut values);
        }
        let power: f64 = exchange.friction_power.segments().map(|(x, q)| 0.5 * (x[1] - x[0]) * (q[0] + q[1])).sum();
        let friction = self.heat_ratio * power * (1.0 + exchange.friction_excess);
        let supplied: f64 = exchange.sources.iter().map(|source| source.heat).sum();
        let flows = HeatFlows {
            friction,
            supplied,
            to_wheel: 0.5 * friction,
            to_rail: 0.5 * friction,
            outflow: 0.5 * friction,
            stored_wheel: 0.5 * friction + supplied,
            ..HeatFlows::default()
        };
        Ok((HeatState::new(values), flows))
    }

    /// Temperature of a body (0: wheel, 1: rail) without flashes, and its flashes.
    fn split<'a>(&self, state: &'a HeatState, body: usize) -> (f64, &'a [f64]) {
        let n = self.zone.len();
        (state.values[body], &state.values[2 + body * n..][..n])
    }
}

impl HeatModel for FlashModel {
    fn initial(&self, wheel: f64, rail: f64) -> HeatState {
        HeatState::new([vec![wheel, rail], vec![0.0; 2 * self.zone.len()]].concat())
    }

    fn after_long_rolling(
        &self,
        velocity: f64,
        omega: f64,
        exchange: &Exchange,
        wheel: f64,
    ) -> Result<(HeatState, HeatFlows), HeatError> {
        self.evaluate(wheel, [velocity, omega], exchange)
    }

    fn step(
        &self,
        lines: &mut [HeatLine],
        dt: f64,
        velocity: f64,
        omega: f64,
        _scratch: &mut HeatScratch,
    ) -> Result<(), HeatError> {
        for line in lines {
            (*line.next, line.flows) = self.evaluate(line.state.values[0], [velocity, omega], line.exchange)?;
            line.next.values[0] += dt * line.flows.stored_wheel / self.capacity;
        }
        Ok(())
    }

    fn fits(&self, state: &HeatState) -> bool {
        state.values.len() == 2 + 2 * self.zone.len()
    }

    fn zone_x(&self) -> &[f64] {
        &self.zone
    }

    fn observe(&self, state: &HeatState, seen: &mut Observation) -> Result<(), HeatError> {
        for body in [0, 1] {
            let (mean, flashes) = self.split(state, body);
            seen.surface[body] = flashes.iter().map(|flash| mean + flash).collect();
            seen.layer[body] = vec![0.0; self.zone.len()];
        }
        let highest = |body: usize| seen.surface[body].iter().copied().fold(f64::NEG_INFINITY, f64::max);
        seen.temperatures = Temperatures {
            wheel_max: highest(0),
            rail_max: highest(1),
            wheel_centre: seen.surface[0][POINTS],
            rail_centre: seen.surface[1][POINTS],
            wheel_mean: state.values[0],
            rail_mean: state.values[1],
            melted: [0.0; 2],
        };
        seen.lowest = state.values[0].min(state.values[1]);
        Ok(())
    }

    fn mean_over_depth(&self, state: &HeatState, _depth: f64, out: &mut [Vec<f64>; 2]) -> Result<(), HeatError> {
        *out = [0, 1].map(|body| vec![state.values[body]; self.zone.len()]);
        Ok(())
    }

    fn depth_weights(&self, _body: usize, depths: &[f64]) -> Vec<f64> {
        depths.to_vec()
    }

    fn column(&self, body: usize, state: &HeatState, _s: f64, _weights: &[f64], column: &mut [f64]) {
        column.fill(if self.fits(state) { state.values[body] } else { 0.0 });
    }

    fn fields(&self, state: &HeatState) -> Result<[TemperatureField; 2], HeatError> {
        Ok([0, 1].map(|body| TemperatureField { mesh: Default::default(), temperature: vec![state.values[body]] }))
    }
}

/// RollingModel on flash temperatures, and one on tensor meshes.
fn models(start: StartTemperature) -> [RollingModel; 2] {
    let mut config = preset("railway", 20);
    config.solver.reduced = true;
    config.initial.temperature = start;
    // The flash model has no swelling, and a friction that follows the flash varies from step to step.
    (config.material.expansion, config.tuning.softening) = (0.0, 0.0);
    let basis = common::store().find(&config).unwrap();
    let basis = basis.map_or_else(|| Basis::compute(&(&config).into(), &mut |_, _| {}).unwrap(), |(basis, _)| basis);
    let [flash, tensor] = [(); 2].map(|()| {
        let pair = bodies(&(&config).into(), Some(basis.clone()), &mut |_, _| {}).unwrap();
        RollingModel::new(config.clone(), pair, Surfaces::smooth(config.wheel.radius)).unwrap()
    });
    [flash.with_heat(|config| Ok(Box::new(FlashModel::new(config)))).unwrap(), tensor]
}

/// Rolling at a given creepage.
fn sliding(config: &Config, creepage: f64) -> Inputs {
    let mut config = config.clone();
    (config.initial.velocity, config.initial.creepage) = (VELOCITY, Some(creepage));
    let mut inputs = Inputs::rolling(&config);
    (inputs.rotation, inputs.translation) = (Rotation::Velocity, Translation::Velocity);
    inputs
}

fn start(model: &RollingModel, inputs: &Inputs) -> (State, Workspace) {
    let mut workspace = Workspace::default();
    let state = stationary::start(model, &model.config.tuning, inputs, &mut workspace).unwrap();
    (state, workspace)
}

/// Takes a state on by 20 steps of 1 ms; `seen` looks at each.
fn roll(model: &RollingModel, inputs: &Inputs, mut seen: impl FnMut(Outputs)) -> State {
    let (mut state, mut workspace) = start(model, inputs);
    for _ in 0..20 {
        let mut next = State::default();
        substeps::advance(model, &model.config.tuning, &state, inputs, 1e-3, &mut workspace, &mut next).unwrap();
        state = next;
        assert!(model.fits(&state));
        seen(observe(model, &state));
    }
    state
}

/// Largest `∫ₓ¹ √(1 − ξ²)/√(ξ − x) dξ` of all x, by Simpson's rule in `u = √(ξ − x)`.
fn elliptical_peak() -> f64 {
    let integral = |x: f64| {
        let (n, end) = (2000, (1.0 - x).sqrt());
        let h = end / f64::from(n);
        let f = |u: f64| 2.0 * (1.0 - (x + u * u).powi(2)).max(0.0).sqrt();
        let weight = |i: i32| if i == 0 || i == n { 1.0 } else { f64::from(2 + 2 * (i % 2)) };
        h / 3.0 * (0..=n).map(|i| weight(i) * f(f64::from(i) * h)).sum::<f64>()
    };
    (0..=2000).map(|i| integral(f64::from(i) / 1000.0 - 1.0)).fold(0.0, f64::max)
}

/// A sliding patch has the pressure of Hertz, and its friction heat is an ellipse but for the elastic slip, which is
/// some percent of the rigid one.
#[test]
fn stationary_flash_of_a_sliding_patch_is_that_of_an_elliptical_source() {
    let [model, _] = models(StartTemperature::Stationary);
    let seen = observe(&model, &start(&model, &sliding(&model.config, CREEPAGE)).0);
    let (material, a) = (&model.config.material, seen.contact_half_width);
    let effusivity = (material.conductivity * material.density * material.specific_heat).sqrt();
    let peak = elliptical_peak();
    for (heat, speed, highest) in [
        (seen.heat_to_wheel, seen.wheel_omega * model.config.wheel.radius, seen.temperature_wheel_max),
        (seen.heat_to_rail, seen.wheel_velocity, seen.temperature_rail_max),
    ] {
        let flux = 2.0 * heat / (PI * a * model.config.model.contact_width);
        let expected = flux / effusivity * (a / (PI * speed)).sqrt() * peak;
        let rise = highest - model.config.thermal.reference;
        println!("rise {rise:.3} K, ellipse {expected:.3} K ({:+.2} %)", 100.0 * (rise / expected - 1.0));
        assert!(rise > 100.0 && (rise / expected - 1.0).abs() < 0.01);
    }
}

/// Equal bodies that hardly slip share the heat in equal parts: both models then see the same flash, while the bulk is
/// cold.
#[test]
fn flashes_of_both_models_agree_while_the_bodies_share_the_heat_in_equal_parts() {
    let rises = models(StartTemperature::Uniform).map(|model| {
        let state = roll(&model, &sliding(&model.config, 0.01), |_| ());
        let seen = observe(&model, &state);
        let rise = seen.temperature_wheel_max - model.config.thermal.reference;
        println!("flash {rise:.3} K under {:.3e} W", seen.heat_to_wheel + seen.heat_to_rail);
        rise / (seen.heat_to_wheel + seen.heat_to_rail)
    });
    assert!(rises[0] > 0.0 && (rises[0] / rises[1] - 1.0).abs() < 0.02, "{rises:?}");
}

#[test]
fn a_lumped_wheel_keeps_the_heat_of_its_friction() {
    let [model, _] = models(StartTemperature::Stationary);
    let (width, mut heat) = (model.config.model.contact_width, 0.0);
    let state = roll(&model, &sliding(&model.config, CREEPAGE), |seen| heat += 1e-3 * seen.heat_to_wheel);
    let (seen, wheel) = (observe(&model, &state), &model.config.wheel);
    let area = PI * (wheel.radius.powi(2) - wheel.hub_radius.powi(2));
    let capacity = model.config.material.density * model.config.material.specific_heat * area * width;
    let warmed = seen.temperature_wheel_bulk - model.config.thermal.reference;
    println!("wheel warmed by {warmed:.6e} K, heat {heat:.1} J over capacity {:.6e} K", heat / capacity);
    assert!(heat > 500.0 && (warmed * capacity / heat - 1.0).abs() < 1e-9, "{:e}", warmed * capacity / heat - 1.0);
    assert!(seen.heat_residual.abs() < 1e-12, "{:e}", seen.heat_residual);
}

#[test]
fn states_do_not_pass_from_one_heat_model_to_the_other() {
    let [flash, tensor] = models(StartTemperature::Stationary);
    let inputs = sliding(&flash.config, 0.01);
    let (ours, theirs) = (start(&flash, &inputs).0, start(&tensor, &inputs).0);
    assert!(flash.fits(&ours) && tensor.fits(&theirs));
    assert!(!flash.fits(&theirs) && !tensor.fits(&ours));
}

/// Rolling heat on a flux that is even over a strip: `2 q √(2a)/(√(π kρc V))` at its trailing edge.
#[test]
fn flash_of_an_even_strip_follows_its_closed_form() {
    let (a, flux) = (5e-3, 1e8);
    let [model, _] = models(StartTemperature::Stationary);
    let [mut found, mut parameters] = [None, None];
    model
        .with_heat(|config| {
            let flash = FlashModel::new(config);
            let exchange = Exchange {
                patches: vec![Interval { low: -a, high: a }],
                friction_power: Piecewise { x: vec![-a, a], value: vec![flux; 2] },
                ..Exchange::default()
            };
            let (state, _) = flash.after_long_rolling(VELOCITY, VELOCITY / flash.radius, &exchange, 0.0)?;
            let mut seen = Observation::default();
            flash.observe(&state, &mut seen)?;
            found = Some(seen.temperatures.rail_max);
            parameters = Some(flash.heat_ratio / flash.effusivity);
            Ok(Box::new(flash))
        })
        .unwrap();
    let exact = flux * parameters.unwrap() * (2.0 * a / (PI * VELOCITY)).sqrt();
    // The trailing edge lies between two positions.
    assert!((found.unwrap() / exact - 1.0).abs() < 5e-3, "{found:?} for {exact}");
}
