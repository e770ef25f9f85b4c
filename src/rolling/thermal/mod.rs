//! Heat of the rolling contact: coupling of the mechanics with the temperature fields.
//!
//! The coupling is staggered: a mechanical step first, then one implicit heat step with the energy that friction has
//! dissipated in it, and with its pressure and patches held over the step. Friction coefficient and thermal deformation
//! of the next step follow from the new temperatures.

mod deformation;
mod exchange;
mod history;
mod smoothing;
mod sources;
mod thermoelastic;
mod warming;
mod weakening;

use super::contact_model::ContactModel;
use super::error::StepError;
use super::line::Line;
use super::profile::{PROFILE_POINTS, profile_points};
use super::state::Motion;
use super::thermal_state::{ThermalState, Weakening};
use crate::config::Config;
use crate::contact::{ContactState, Heating, Traction};
use crate::damage::ConductionScratch;
use crate::heat::{
    Exchange, Heat, HeatError, HeatLine, HeatModel, HeatParameters, HeatScratch, Observation, TemperatureField,
};
use crate::material::{FILM_GROWS, SOFTENS};
use crate::mechanics;
use crate::piecewise;
use deformation::Expansion;
pub use exchange::{ThermalContact, heat_parameters};
pub use history::criteria;
use history::{MaterialHistory, ObservedStep};
use smoothing::Smoothing;
use sources::HeatSources;
pub use sources::{HeatStep, HeatSupply};
use thermoelastic::Thermoelastic;
use warming::Warming;
use weakening::WeakSteel;

/// Excess over the liquidus that a molten contact may reach \[K]: a step that gets there from below was too long.
const OVERHEATING: f64 = 50.0;

/// Length of a step in which the deformation of a very hot contact goes half of the way to its new value, times the
/// expansion coefficient \[s/K]; 0.33 ms for steel. In steps of h it goes the share `1/(1 + h/`this`)`. Where the edge
/// of the patch cools the steel that it touches, the steel shrinks, the edge recedes, and steel warms and swells again,
/// one step later: a feedback from one step to the next of about −7 per millisecond for steel, measured, and
/// proportional to the expansion. It flips beyond `3.5/(2.5 + 7 h/ms)`.
const DAMPED: f64 = 3.9e-9;

/// Excess temperature of the hotter surface up to which the depth of the heat does not smooth its swelling, and that from which
/// on it does so wholly \[K]. Flashes of quiet rolling swell by nanometres, whatever their depth, and it changes with every
/// step.
const SMOOTHED: [f64; 2] = [10.0, 11.0];

/// Temperatures of wheel and rail and their coupling with the contact.
pub struct ThermalModel {
    heat: Box<dyn HeatModel>,
    /// Temperature of hub, air and arriving rail [K].
    reference: f64,
    /// Excess temperature of the wheel at the start [K].
    wheel_excess: f64,
    sources: HeatSources,
    /// Coefficient of thermal expansion [1/K].
    thermal_expansion: f64,
    expansion: Expansion,
    /// If `physics.thermoelastic_heating` is on.
    thermoelastic: Option<Thermoelastic>,
    /// Distance of the contact nodes [m].
    pub(super) spacing: f64,
    weakening: WeakSteel,
    /// How far friction warms the contact within a step.
    pub(super) warming: Warming,
    /// Positions at which the surface temperatures are reported [m].
    points: Vec<f64>,
    history: MaterialHistory,
}

/// Memory that heat steps reuse.
#[derive(Default)]
pub struct ThermalScratch {
    heat: HeatScratch,
    /// Exchange of each line.
    exchanges: Vec<Exchange>,
    /// Observation of each line after the last step.
    seen: Vec<Observation>,
    smoothing: [Smoothing; 2],
    history: ConductionScratch,
}

/// A line in a heat step.
pub struct ThermalLine<'a> {
    /// Temperatures at the beginning.
    pub before: &'a ThermalState,
    /// Contact at the end.
    pub contact: ThermalContact<'a>,
    /// Temperatures at the end, to be replaced; their memory is reused.
    pub thermal: ThermalState,
}

/// Refuses, before any memory is taken, a configuration on whose mesh [`ThermalModel::new`] would fail: too many
/// elements in the contact zone, on whose number the size of the heat model depends.
pub fn check_size(config: &Config) -> Result<(), HeatError> {
    let zone = mechanics::contact_zone(&config.into());
    let reach = (zone.candidates() / 2 + 1) as f64 * zone.spacing();
    heat_parameters(config, zone.half_width, reach, reach.max(zone.reach)).validate()
}

impl ThermalModel {
    /// Temperatures on tensor meshes for contact within `zone` \[m] of the contact point; the temperature is resolved
    /// up to `margin` \[m] beyond. Wide patches stay within `reach` \[m].
    pub fn new(config: &Config, zone: f64, margin: f64, reach: f64) -> Result<Self, HeatError> {
        Self::with_heat(config, zone, margin, reach, |parameters| Ok(Box::new(Heat::new(parameters)?)))
    }

    /// Temperatures by the heat model that `heat` makes for the given parameters.
    pub fn with_heat(
        config: &Config,
        zone: f64,
        margin: f64,
        reach: f64,
        heat: impl FnOnce(&HeatParameters) -> Result<Box<dyn HeatModel>, HeatError>,
    ) -> Result<Self, HeatError> {
        let half_width = config.nominal_patch().half_length;
        let heat = heat(&heat_parameters(config, half_width, zone + margin, reach.max(zone + margin)))?;
        Ok(Self {
            history: MaterialHistory::new(config, &*heat, half_width, zone),
            heat,
            reference: config.thermal.reference,
            wheel_excess: config.thermal.wheel_excess,
            sources: HeatSources::new(config),
            thermal_expansion: config.material.expansion,
            expansion: Expansion::new(config),
            thermoelastic: config.physics.thermoelastic_heating.then(|| Thermoelastic::new(config)),
            spacing: margin,
            weakening: WeakSteel::new(config),
            warming: Warming::new(config),
            points: profile_points(zone),
        })
    }

    /// Absolute temperature of hub, air and arriving rail \[K].
    pub fn reference(&self) -> f64 {
        self.reference
    }

    /// Absolute temperature \[K] that a contact with molten films does not exceed by itself: [`OVERHEATING`] above the
    /// liquidus, or that of the wheel at the start. Infinite where melting leaves friction alone.
    pub fn hottest(&self) -> f64 {
        self.above_liquidus(OVERHEATING)
    }

    /// Absolute temperature \[K] from which on a molten film carries no friction, or that of the wheel at the start: a
    /// step that heats the contact beyond had too much friction.
    pub fn frictionless(&self) -> f64 {
        self.above_liquidus(FILM_GROWS)
    }

    fn above_liquidus(&self, excess: f64) -> f64 {
        let start = self.reference + self.wheel_excess;
        self.weakening.liquidus().map_or(f64::INFINITY, |liquidus| (liquidus + excess).max(start))
    }

    /// A contact as the temperatures see it, with a rail that arrives with the absolute temperature `rail` \[K].
    pub fn contact<'a>(&self, model: &ContactModel, contact: &'a ContactState, rail: f64) -> ThermalContact<'a> {
        let traction = &contact.traction;
        let reversible = match &self.thermoelastic {
            Some(thermoelastic) => {
                model.solver.surface_strain(contact).map(|strain| thermoelastic.temperatures(strain, traction))
            }
            None => Default::default(),
        };
        ThermalContact { traction, reversible, arriving: rail - self.reference }
    }

    /// Uniform temperatures at the start: the initial one of the wheel, and that of the arriving rail. No heat has
    /// flowed yet.
    pub fn uniform(&self, contact: &ThermalContact) -> Result<ThermalState, StepError> {
        let fields = self.heat.initial(self.wheel_excess, contact.arriving);
        self.begun(contact, ThermalState { fields, ..ThermalState::default() })
    }

    /// Stationary temperatures of a stationary contact, with the initial excess temperature of the wheel and that of
    /// the arriving rail on top and their exchange in passing. At standstill, where nothing carries heat away, only
    /// the excess temperature.
    pub fn stationary(
        &self,
        motion: &Motion,
        contact: &ThermalContact,
        supply: HeatSupply,
    ) -> Result<ThermalState, StepError> {
        let (v, omega) = (motion.velocity.now, motion.omega.now);
        let mut exchange = Exchange::default();
        contact.fill(&Weakening::NONE.film, &mut exchange);
        self.sources.list(supply, &mut exchange.sources);
        let (fields, flows) = self.heat.after_long_rolling(v, omega, &exchange, self.wheel_excess)?;
        self.begun(contact, ThermalState { fields, flows, ..ThermalState::default() })
    }

    /// All of a start that follows from its temperature fields.
    fn begun(&self, contact: &ThermalContact, mut thermal: ThermalState) -> Result<ThermalState, StepError> {
        let (mut seen, mut smoothing) = Default::default();
        self.observe(contact, f64::INFINITY, &mut thermal, (&mut seen, &mut smoothing))?;
        thermal.damage = self.history.begin(&seen);
        thermal.heating.before = thermal.heating.now;
        Ok(thermal)
    }

    /// The heat step of all lines that belongs to a mechanical step with the `motion` at its end. What it means for the
    /// material waits for [`Self::remember`].
    pub fn step(
        &self,
        lines: &mut [ThermalLine],
        motion: &Motion,
        step: HeatStep,
        scratch: &mut ThermalScratch,
    ) -> Result<(), StepError> {
        let HeatStep { dt, supply, .. } = step;
        let ThermalScratch { heat, exchanges, seen, smoothing, .. } = scratch;
        exchanges.resize_with(lines.len().max(exchanges.len()), Exchange::default);
        for (line, exchange) in lines.iter().zip(&mut *exchanges) {
            line.contact.fill(&line.before.weakening.film, exchange);
            self.sources.list(supply, &mut exchange.sources);
        }
        let fields = lines.iter_mut().zip(&*exchanges).map(|(ThermalLine { before, thermal, .. }, exchange)| {
            HeatLine::new(&before.fields, &mut thermal.fields, exchange)
        });
        let mut fields: Vec<_> = fields.collect();
        self.heat.step(&mut fields, dt, motion.velocity.now, motion.omega.now, heat)?;
        let flows: Vec<_> = fields.into_iter().map(|field| field.flows).collect();
        seen.resize_with(lines.len().max(seen.len()), Observation::default);
        for ((line, flows), seen) in lines.iter_mut().zip(flows).zip(seen) {
            line.thermal.flows = flows;
            self.follow(line, (dt, motion.omega.now != 0.0), (seen, smoothing))?;
        }
        Ok(())
    }

    /// Takes the history of the material under the lines on by the last step, from the temperatures `before`.
    pub fn remember<'a>(
        &self,
        lines: impl Iterator<Item = (&'a ThermalState, &'a Traction, &'a mut ThermalState)>,
        motion: &Motion,
        step: HeatStep,
        scratch: &mut ThermalScratch,
    ) {
        let ThermalScratch { seen, history, .. } = scratch;
        for ((before, traction, thermal), observation) in lines.zip(seen) {
            thermal.damage.copy_from(&before.damage);
            let field = (&*self.heat, &thermal.fields);
            let seen = ObservedStep { step, field, observation, zone: self.heat.zone_x() };
            self.history.advance(&mut thermal.damage, motion, traction, &seen, history);
        }
    }

    /// Fills all that follows from the temperature fields of a line after a step.
    fn follow(
        &self,
        line: &mut ThermalLine,
        (dt, turns): (f64, bool),
        view: (&mut Observation, &mut [Smoothing; 2]),
    ) -> Result<(), StepError> {
        let ThermalLine { before, contact, thermal } = line;
        thermal.weakening.film.clone_from(&before.weakening.film);
        self.observe(contact, dt, thermal, view)?;
        thermal.heating.before = before.heating.now;
        thermal.melted = thermal.temperatures.melted.iter().copied().fold(before.melted, f64::max);
        let hottest = self.reference + thermal.temperatures.wheel_max.max(thermal.temperatures.rail_max);
        let lag = if hottest > SOFTENS { dt * dt * self.thermal_expansion / DAMPED } else { 0.0 };
        thermal.deformation.relax(&before.deformation, (dt, turns), lag);
        let [sum, amount] = thermal.flows.balance();
        thermal.unaccounted = before.unaccounted + dt * sum;
        thermal.turned_over = before.turned_over + dt * amount;
        Ok(())
    }

    /// Fills all that follows from the temperature fields after a step of `dt` \[s].
    fn observe(
        &self,
        contact: &ThermalContact,
        dt: f64,
        thermal: &mut ThermalState,
        (seen, smoothing): (&mut Observation, &mut [Smoothing; 2]),
    ) -> Result<(), StepError> {
        let zone = self.heat.zone_x();
        self.heat.observe(&thermal.fields, seen)?;
        if contact.reversible.iter().any(|surface| !surface.is_empty()) {
            for (field, reversible) in seen.surface.iter_mut().zip(&contact.reversible) {
                let rise = |x: f64| piecewise::interpolate(&reversible.x, &reversible.value, x);
                field.iter_mut().zip(zone).for_each(|(t, &x)| *t += rise(x));
            }
            let (temperatures, [wheel, rail]) = (&mut seen.temperatures, &seen.surface);
            (temperatures.wheel_max, temperatures.rail_max) =
                (piecewise::peak(zone, wheel), piecewise::peak(zone, rail));
            (temperatures.wheel_centre, temperatures.rail_centre) = (wheel[zone.len() / 2], rail[zone.len() / 2]);
        }
        let lowest = seen.surface.iter().flatten().copied().fold(seen.lowest, f64::min);
        if self.reference + lowest <= 0.0 {
            return Err(StepError::BelowAbsoluteZero { temperature: self.reference + lowest });
        }
        thermal.temperatures = seen.temperatures;
        for (surface, field) in thermal.surface.iter_mut().zip(&seen.surface) {
            piecewise::resample(zone, field, &self.points, surface);
        }
        thermal.patch_mean = contact.traction.extent().map_or([0.0; 2], |patch| {
            [0, 1].map(|body| piecewise::mean(zone, &seen.surface[body], patch.low, patch.high))
        });
        thermal.loaded_mean =
            [0, 1].map(|body| piecewise::weighted_mean(&contact.traction.pressure, zone, &seen.surface[body]));
        let mean = thermal.friction_excess();
        let friction = contact.traction.friction.coefficient;
        thermal.heating.now = if friction > 0.0 { mean / friction } else { 0.0 };
        let hottest = seen.temperatures.wheel_max.max(seen.temperatures.rail_max);
        let warm = piecewise::smooth_step((hottest - SMOOTHED[0]) / (SMOOTHED[1] - SMOOTHED[0]));
        let layers = seen.layer.iter_mut().zip(seen.layer_depth).zip(smoothing);
        for ((layer, depth), smoothing) in layers.filter(|_| warm > 0.0) {
            smoothing.apply(zone, layer, depth, (self.spacing, warm));
        }
        self.expansion.deform(zone, seen, &mut thermal.deformation);
        self.weakening.find(&*self.heat, contact.traction, [dt, self.warming.unit(dt)], thermal, seen)?;
        Ok(())
    }

    /// Moves the effects on the contact by `share` of the way from `before` to `thermal`.
    pub fn average(&self, thermal: &mut ThermalState, before: &ThermalState, share: f64) {
        let mix = |now: &mut f64, before: f64| *now = before + share * (*now - before);
        let Heating { now, before: earlier } = &mut thermal.heating;
        mix(now, before.heating.now);
        mix(earlier, before.heating.before);
        thermal.deformation.average(&before.deformation, share);
    }

    /// Elements in which the edges of the patches of a contact are: where one passes from one to the next the temperatures
    /// have a kink, since upwinded weights jump from element to element.
    pub fn elements(&self, contact: &ContactState) -> impl Iterator<Item = usize> {
        let edges = contact.traction.conducting.iter().flat_map(|edge| [edge.low, edge.high]);
        edges.map(|edge| self.heat.zone_x().partition_point(|&x| x <= edge))
    }

    /// Test that temperatures have the dimensions of this model.
    pub fn fits(&self, thermal: &ThermalState) -> bool {
        let deformation = &thermal.deformation;
        let profiles = deformation.membrane_force.iter().chain(&deformation.swelling);
        self.heat.fits(&thermal.fields)
            && self.history.spots.fits(&thermal.damage)
            && thermal.surface.iter().all(|surface| surface.len() == PROFILE_POINTS)
            && deformation.acted.iter().flatten().all(|value| value.is_finite())
            && profiles.clone().all(|profile| profile.check().is_ok())
    }

    /// Highest temperature \[K] so far at the depths of profiles, where the contact has heated the wheel in one piece.
    pub fn peaks(&self, thermal: &ThermalState) -> Vec<f64> {
        self.history.peaks(&thermal.damage, self.reference)
    }

    /// Where the contact has heated the wheel in one piece.
    pub fn history(&self) -> &MaterialHistory {
        &self.history
    }

    /// Absolute temperatures \[K] at the depths of profiles: of wheel and rail below the contact point, and of the wheel
    /// below the point of its tread that touches at the angle `point` of a wheel which is at `angle` now \[rad].
    pub fn below(&self, thermal: &ThermalState, angle: f64, point: f64) -> [Vec<f64>; 3] {
        let field = (&*self.heat, &thermal.fields);
        let columns = self.history.below(&thermal.damage, field, [angle, point]);
        columns.map(|column| column.into_iter().map(|excess| self.reference + excess).collect())
    }

    /// Absolute temperatures in the whole bodies \[K].
    pub fn fields(&self, thermal: &ThermalState) -> Result<[TemperatureField; 2], HeatError> {
        let mut fields = self.heat.fields(&thermal.fields)?;
        let kelvin = |t: &mut f64| *t += self.reference;
        fields.iter_mut().for_each(|field| field.temperature.iter_mut().for_each(kelvin));
        Ok(fields)
    }
}

/// Lets the wheel grow by the mean of its bulk temperatures under all lines.
pub fn share_growth(lines: &mut [Line]) {
    if lines.len() < 2 {
        return;
    }
    let sum = |of: &dyn Fn(&Line) -> f64| -> f64 { lines.iter().map(|line| line.layout.share * of(line)).sum() };
    let growth = sum(&|line| line.deformation().radius_growth) / sum(&|_| 1.0);
    for thermal in lines.iter_mut().filter_map(|line| line.thermal.as_mut()) {
        thermal.deformation.radius_growth = growth;
    }
}
