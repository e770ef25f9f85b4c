//! Temperature of wheel and rail: resolved under the contact, coupled, at any speed and step size.
//!
//! Both fields live on tensor meshes of their own (streamlines × depth), graded from the thermal boundary layer
//! `δ = √(2κa/V)` (tens of micrometres) to the size of the bodies. Everything is per metre of width; temperatures are
//! excess temperatures over the reference [K]. Forward rolling is positive: at the contact the material of both bodies
//! flows towards −x.
//!
//! ```text
//! wheel    ρc (∂_t T − ω ∂_φ T) = k ΔT      hub: T = 0 or insulated; tread: q_tread, h (T − T_air)
//! rail     ρc (∂_t T − V ∂_x T) = k ΔT      inflow: ρc|V|T − k ∂_n T = 0; outflow: k ∂_n T = 0; base insulated
//! contact  q → wheel = β γ_f |τ s| − k_c (T_w − T_r),   q → rail = (1 − β) γ_f |τ s| + k_c (T_w − T_r)
//! ```
//!
//! A. Draganis, PhD thesis, Chalmers 2014: Paper B, section 4 (energy balance in the moving frame), Paper C, section
//! 4.2 (conductance, friction heat). The tensor meshes with streamwise upwinding in every term replace its triangles.
//!
//! Limits: line contact in the plane; a hot spot carried round the wheel is smeared where the mesh along the tread is
//! coarse; distances along the surface stand for x in the contact zone (they differ by `x²/6r²`); convection to the air
//! acts under the contact, too.

mod field;
mod interface;
mod krylov;
mod modal;
mod parameters;
mod step;
mod tensor;
#[cfg(test)]
mod tests;

pub use field::TemperatureField;
pub use interface::{Conductance, Exchange, Patch, TreadHeat};
pub use parameters::{HeatConfig, HeatTimeScheme, HubCondition};
pub use step::{LARGEST_STEP, SMALLEST_STEP, Scratch};

use crate::config::ConfigError;
use crate::piecewise::{PiecewiseError, interpolate, peak};
use modal::Body;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;
use step::Moment;
use tensor::{Modes, Streamline, graded};

/// A heat computation that has no answer.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum HeatError {
    #[error(transparent)]
    Config(#[from] ConfigError),
    #[error("{name} is {value}: not a usable number")]
    Input { name: &'static str, value: f64 },
    #[error("{name}: {why}")]
    Profile { name: &'static str, why: PiecewiseError },
    #[error("contact patch from {low} m to {high} m: its ends must be numbers and ascend")]
    Patch { low: f64, high: f64 },
    #[error("{name} reaches x = {x} m, outside the contact zone of ±{zone} m")]
    OutsideZone { name: &'static str, x: f64, zone: f64 },
    #[error("heat step of {dt} s is outside {SMALLEST_STEP} to {LARGEST_STEP} s")]
    StepSize { dt: f64 },
    #[error("temperature fields of {found} values do not belong to this mesh of {expected}")]
    StateSize { expected: usize, found: usize },
    #[error("eigenproblem of {size} unknowns across the streamlines did not converge")]
    Eigen { size: usize },
    #[error("the heat equations of {unknowns} unknowns have no unique solution")]
    Singular { unknowns: usize },
    #[error("heat solver stopped at relative residual {residual:.2e} after {iterations} iterations")]
    NotConverged { residual: f64, iterations: usize },
    #[error("temperatures are not finite after a step of {dt} s at V = {velocity} m/s, ω = {omega} rad/s")]
    NotFinite { dt: f64, velocity: f64, omega: f64 },
}

/// Both temperature fields and what the next step needs to know of the last one.
///
/// The fields are coefficients of the modes across the streamlines; see [`Heat::wheel_temperature`].
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct HeatState {
    wheel: Vec<f64>,
    rail: Vec<f64>,
    history: Option<Moment>,
}

impl HeatState {
    /// Forgets speeds and exchange of the last step: the coming one starts after a jump of them.
    pub fn restart(&mut self) {
        self.history = None;
    }
}

/// Mean heat flows over a step, or in the stationary state [W/m].
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct HeatFlows {
    /// Friction heat into both bodies, `γ_f ∫|τs| dx`.
    pub friction: f64,
    /// Prescribed heat on the tread.
    pub tread: f64,
    /// Wheel to rail through the contact conductance.
    pub conduction: f64,
    /// Net heat into wheel and rail through the contact: friction share and conduction.
    pub to_wheel: f64,
    pub to_rail: f64,
    /// Wheel to hub.
    pub to_hub: f64,
    /// Carried out of the modelled rail by the stream.
    pub outflow: f64,
    pub wheel_to_air: f64,
    pub rail_to_air: f64,
    /// Growth of the heat content.
    pub stored_wheel: f64,
    pub stored_rail: f64,
    /// Iterations of the correction to the exact operator (none in rolling).
    pub iterations: usize,
}

impl HeatFlows {
    /// What the wheel receives less what it passes on and stores [W/m]; zero but for round-off.
    pub fn wheel_imbalance(&self) -> f64 {
        self.to_wheel + self.tread - self.to_hub - self.wheel_to_air - self.stored_wheel
    }

    /// The same for the rail.
    pub fn rail_imbalance(&self) -> f64 {
        self.to_rail - self.outflow - self.rail_to_air - self.stored_rail
    }

    /// Largest imbalance relative to the largest flow.
    pub fn relative_imbalance(&self) -> f64 {
        let largest = self.all().into_iter().fold(0.0_f64, |m, f| m.max(f.abs()));
        let worst = self.wheel_imbalance().abs().max(self.rail_imbalance().abs());
        if largest > 0.0 { worst / largest } else { 0.0 }
    }

    fn all(&self) -> [f64; 9] {
        [
            self.friction,
            self.tread,
            self.conduction,
            self.to_hub,
            self.outflow,
            self.wheel_to_air,
            self.rail_to_air,
            self.stored_wheel,
            self.stored_rail,
        ]
    }

    fn is_finite(&self) -> bool {
        self.all().iter().all(|f| f.is_finite())
    }
}

/// Temperatures that a run reports [K].
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Temperatures {
    /// Surface maxima in the contact zone.
    pub wheel_max: f64,
    pub rail_max: f64,
    /// Surface temperatures at the contact point.
    pub wheel_centre: f64,
    pub rail_centre: f64,
    /// Area means of the bodies.
    pub wheel_mean: f64,
    pub rail_mean: f64,
}

/// Operators of both bodies; immutable.
#[derive(Clone, Debug)]
pub struct Heat {
    config: HeatConfig,
    wheel: Body,
    rail: Body,
    /// Elements of the contact zone on each side of the contact point.
    zone_cells: usize,
}

/// First layer across the streamlines in thicknesses of the thermal boundary layer, and at most in half-widths.
const FIRST_LAYER: f64 = 0.25;
const FIRST_LAYER_HALF_WIDTHS: f64 = 0.25;
/// Growth of the layers, and the largest one in thicknesses of the body.
const LAYER_GROWTH: f64 = 1.8;
const LARGEST_LAYER: f64 = 0.15;
/// Growth of the elements along the streamlines, largest one in wheel radii and rail lengths.
const GROWTH: f64 = 1.5;
/// Elements at the edges of the contact, where the temperature starts as a square root, in ordinary ones, and growth.
const EDGE: f64 = 0.2;
const EDGE_GROWTH: f64 = 1.3;
const LARGEST_ALONG: f64 = 0.15;
const LARGEST_ALONG_RAIL: f64 = 0.05;
/// Angular velocity [rad/s] below which, and step size [s] above which the modal solver's approximation `1/r → r/r_o²` in
/// the conduction along the streamlines is corrected.
///
/// Measured without correction, relative: faster rolling 1e-6 in all stationary temperatures; locked wheel 4e-5 in the
/// maxima and 2e-3 in the wheel's mean after 10 s (stationary 5e-4 and 8e-2).
const CURVED_BELOW: f64 = 1.0;
const CURVED_STEP: f64 = 0.01;

/// Depth of the layer whose expansion acts on the contact, in half-widths at the nominal load.
const FLASH_DEPTH: f64 = 0.25;

impl Heat {
    /// Meshes and modes for the given parameters.
    pub fn new(config: &HeatConfig) -> Result<Self, HeatError> {
        config.validate()?;
        let c = config.clone();
        let heat_capacity = c.density * c.specific_heat;
        let diffusivity = c.conductivity / heat_capacity;
        let layer = (2.0 * diffusivity * c.smallest_half_width / c.max_speed).sqrt();
        let first = (FIRST_LAYER * layer).min(FIRST_LAYER_HALF_WIDTHS * c.smallest_half_width);
        let film = c.convection / c.conductivity;
        let modes = |thickness: f64, curvature: f64, fixed: bool| {
            let layers = graded(first.min(0.1 * thickness), LAYER_GROWTH, LARGEST_LAYER * thickness, thickness);
            Modes::new(&layers, curvature, fixed, film)
        };
        let zone = zone_nodes(&c);
        let line =
            |half: f64, largest: f64, closed: bool| Streamline::around_contact(&zone, half, GROWTH, largest, closed);
        let body = |line: Streamline, modes: Modes| Body {
            line,
            modes,
            heat_capacity,
            conductivity: c.conductivity,
            film: c.convection,
        };
        Ok(Self {
            wheel: body(
                line(PI * c.wheel_radius, LARGEST_ALONG * c.wheel_radius, true),
                modes(c.wheel_radius - c.hub_radius, 1.0 / c.wheel_radius, c.hub == HubCondition::Fixed)?,
            ),
            rail: body(
                line(0.5 * c.rail_length, LARGEST_ALONG_RAIL * c.rail_length, false),
                modes(c.rail_height, 0.0, false)?,
            ),
            zone_cells: zone.len() - 1,
            config: c,
        })
    }

    /// The parameters this was made from.
    pub fn config(&self) -> &HeatConfig {
        &self.config
    }

    /// A wheel at the uniform excess temperature `bulk` [K] (but for a fixed hub) on a rail at the reference temperature.
    pub fn initial(&self, bulk: f64) -> HeatState {
        let row: Vec<f64> = self.wheel.modes.free.iter().map(|c| bulk * c).collect();
        let wheel = row.iter().copied().cycle().take(self.wheel.size()).collect();
        HeatState { wheel, rail: vec![0.0; self.rail.size()], history: None }
    }

    /// Number of unknown temperatures.
    pub fn unknowns(&self) -> usize {
        let count = |b: &Body| b.line.len() * b.modes.shapes.nrows();
        count(&self.wheel) + count(&self.rail)
    }

    /// Surface positions of the common nodes in the contact zone [m], ascending.
    pub fn zone_x(&self) -> &[f64] {
        &self.rail.line.nodes[self.zone_nodes(&self.rail)]
    }

    fn zone_elements(&self) -> usize {
        2 * self.zone_cells
    }

    /// Surface temperatures of wheel and rail at the nodes of the contact zone [K].
    pub fn zone_temperatures(&self, state: &HeatState) -> Result<(Vec<f64>, Vec<f64>), HeatError> {
        self.check_state(state)?;
        let (mut wheel, mut rail) = (Vec::new(), Vec::new());
        self.wheel.trace(self.zone_nodes(&self.wheel), &state.wheel, &mut wheel);
        self.rail.trace(self.zone_nodes(&self.rail), &state.rail, &mut rail);
        Ok((wheel, rail))
    }

    /// Surface temperatures of wheel and rail at x [m] within the contact zone, linear between nodes [K].
    pub fn surface_temperatures(&self, state: &HeatState, x: f64) -> Result<[f64; 2], HeatError> {
        Ok([self.wheel_temperature(state, x, 0.0)?, self.rail_temperature(state, x, 0.0)?])
    }

    /// Temperature of the wheel at the distance `s` along the tread from the contact point and the depth `z` below it.
    pub fn wheel_temperature(&self, state: &HeatState, s: f64, z: f64) -> Result<f64, HeatError> {
        self.check_state(state)?;
        Ok(evaluate(&self.wheel, &state.wheel, s, z))
    }

    /// Temperature of the rail at `x` and the depth `z`.
    pub fn rail_temperature(&self, state: &HeatState, x: f64, z: f64) -> Result<f64, HeatError> {
        self.check_state(state)?;
        Ok(evaluate(&self.rail, &state.rail, x, z))
    }

    /// Maxima, values at the contact point and means.
    pub fn temperatures(&self, state: &HeatState) -> Result<Temperatures, HeatError> {
        let (wheel, rail) = self.zone_temperatures(state)?;
        let content = self.heat_content(state)?;
        let volume = |body: &Body| body.heat_capacity * self.area(body);
        Ok(Temperatures {
            wheel_max: peak(self.zone_x(), &wheel),
            rail_max: peak(self.zone_x(), &rail),
            wheel_centre: wheel[self.zone_cells],
            rail_centre: rail[self.zone_cells],
            wheel_mean: content[0] / volume(&self.wheel),
            rail_mean: content[1] / volume(&self.rail),
        })
    }

    /// Heat contents of wheel and rail over the reference temperature [J/m].
    pub fn heat_content(&self, state: &HeatState) -> Result<[f64; 2], HeatError> {
        self.check_state(state)?;
        let content = |body: &Body, field: &[f64]| {
            let mut sums = Vec::new();
            body.integrate(field, &mut sums);
            body.heat_capacity * modal::dot(&sums, &body.modes.content)
        };
        Ok([content(&self.wheel, &state.wheel), content(&self.rail, &state.rail)])
    }

    /// Sum of two temperature fields; speeds and exchange of the last step are forgotten.
    pub fn sum(&self, a: &HeatState, b: &HeatState) -> Result<HeatState, HeatError> {
        self.check_state(a)?;
        self.check_state(b)?;
        let add = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a + b).collect();
        Ok(HeatState { wheel: add(&a.wheel, &b.wheel), rail: add(&a.rail, &b.rail), history: None })
    }

    /// Surface temperatures of wheel and rail at the given positions in the contact zone [K].
    pub fn at_zone(&self, state: &HeatState, x: &[f64]) -> Result<[Vec<f64>; 2], HeatError> {
        let (wheel, rail) = self.zone_temperatures(state)?;
        Ok([wheel, rail].map(|values| x.iter().map(|&x| interpolate(self.zone_x(), &values, x)).collect()))
    }

    /// Temperature integrated over the uppermost [`FLASH_DEPTH`] at the given positions in the contact zone [K m]: of the
    /// wheel less its mean along the tread, of the rail.
    pub fn layers(&self, state: &HeatState, x: &[f64]) -> Result<[Vec<f64>; 2], HeatError> {
        self.check_state(state)?;
        let layer = |body: &Body, field: &[f64], mean: f64| {
            let nm = body.modes.content.len();
            let nodes = self.zone_nodes(body);
            let weights = self.layer_weights(body);
            let depth = |node: usize| modal::dot(&field[node * nm..(node + 1) * nm], &weights) - mean;
            let values: Vec<f64> = nodes.map(depth).collect();
            x.iter().map(|&x| interpolate(self.zone_x(), &values, x)).collect()
        };
        let mut sums = Vec::new();
        self.wheel.integrate(&state.wheel, &mut sums);
        let mean = modal::dot(&sums, &self.layer_weights(&self.wheel)) / self.wheel.line.closed;
        Ok([layer(&self.wheel, &state.wheel, mean), layer(&self.rail, &state.rail, 0.0)])
    }

    /// Integrals of the modes over the uppermost layer (Simpson's rule on intervals that grow with depth).
    fn layer_weights(&self, body: &Body) -> Vec<f64> {
        let depth = FLASH_DEPTH * self.config.half_width;
        let mut weights = vec![0.0; body.modes.content.len()];
        let (mut from, mut step) = (0.0, 1e-3 * depth);
        while from < depth {
            let to = (from + step).min(depth);
            for (z, share) in [(from, 1.0), (0.5 * (from + to), 4.0), (to, 1.0)] {
                for (w, mode) in weights.iter_mut().zip(body.modes.at(z)) {
                    *w += share / 6.0 * (to - from) * mode;
                }
            }
            (from, step) = (to, 1.3 * step);
        }
        weights
    }

    fn area(&self, body: &Body) -> f64 {
        let c = &self.config;
        if body.line.closed > 0.0 {
            PI * (c.wheel_radius * c.wheel_radius - c.hub_radius * c.hub_radius)
        } else {
            c.rail_length * c.rail_height
        }
    }

    fn zone_nodes(&self, body: &Body) -> std::ops::Range<usize> {
        body.line.zone..body.line.zone + self.zone_elements() + 1
    }

    /// Whether a state has the dimensions of this model.
    pub fn fits(&self, state: &HeatState) -> bool {
        let history = state.history.as_ref().is_none_or(|moment| {
            let (supply, zone) = (&moment.supply, self.zone_elements());
            supply.conductance.len() == zone
                && supply.friction.len() == zone
                && (supply.reversible.is_empty() || supply.reversible.len() == zone)
                && (supply.tread.is_empty() || supply.tread.len() == self.wheel.line.lengths.len())
        });
        history && state.wheel.len() == self.wheel.size() && state.rail.len() == self.rail.size()
    }

    fn check_state(&self, state: &HeatState) -> Result<(), HeatError> {
        let (expected, found) = (self.wheel.size() + self.rail.size(), state.wheel.len() + state.rail.len());
        self.fits(state).then_some(()).ok_or(HeatError::StateSize { expected, found })
    }
}

/// Temperature at one point; outside an open streamline that of its end.
fn evaluate(body: &Body, field: &[f64], s: f64, z: f64) -> f64 {
    let line = &body.line;
    let n = line.len();
    let mut s = s;
    if line.closed > 0.0 {
        s = line.nodes[0] + (s - line.nodes[0]).rem_euclid(line.closed);
    }
    let element = line.nodes.partition_point(|&x| x <= s).saturating_sub(1).min(line.lengths.len() - 1);
    let xi = ((s - line.nodes[element]) / line.lengths[element]).clamp(0.0, 1.0);
    let across = body.modes.at(z);
    let nm = across.len();
    let value = |node: usize| modal::dot(&field[node * nm..(node + 1) * nm], &across);
    (1.0 - xi) * value(element) + xi * value((element + 1) % n)
}

/// Nodes of the contact zone from the contact point outwards: finest at the edge of the nominal contact.
fn zone_nodes(c: &HeatConfig) -> Vec<f64> {
    let spacing = c.smallest_half_width / c.elements_per_half_width as f64;
    let inside = graded(EDGE * spacing, EDGE_GROWTH, spacing, c.half_width);
    let mut nodes: Vec<f64> = inside.iter().rev().map(|s| c.half_width - s).collect();
    if c.zone > c.half_width {
        let outside = graded(EDGE * spacing, EDGE_GROWTH, spacing, c.zone - c.half_width);
        nodes.extend(outside.iter().skip(1).map(|s| c.half_width + s));
    }
    nodes
}
