//! Weakening of the steel under the contact by heat: less strength deep below the surface, less friction where the
//! surface melts.

use crate::config::Config;
use crate::contact::Traction;
use crate::heat::{HeatModel, Observation};
use crate::material::{FILM_GROWS, MeltingFilm, SOFTENS, melted_share, yield_share};
use crate::piecewise::{Piecewise, interpolate, smear};
use crate::rolling::error::StepError;
use crate::rolling::thermal_state::ThermalState;

/// Depth in which the pressure of a patch acts, in its half-widths: there the shear stress of a Hertzian line contact
/// is near its maximum, and a hotter but thinner skin does not yield on its own. Nor does a narrower strip: the steel
/// that flows under a punch down to some depth does so over more than that depth to both sides, and its strength counts
/// everywhere on the way.
const LOADED_DEPTH: f64 = 0.5;

/// Share of friction below which temperatures say nothing about those without a film [1].
const LEAST: f64 = 1e-3;

/// Least share of friction on a molten place \[1]: as good as none, but its heat keeps its place.
const REMAINS: f64 = 1e-6;

/// Time in which the friction of a place that freezes grows by as much as there was, while the contact is molten elsewhere \[s].
/// The slip that waves of the wheel bring there is not known before the step.
const FREEZES: f64 = 1e-3;

/// Largest part of the friction on a place that one step takes away because it is overheated [1].
const CUT: f64 = 0.75;

/// Law by which steel weakens.
#[derive(Clone, Debug)]
pub struct WeakSteel {
    film: MeltingFilm,
    /// Absolute temperature of excess zero [K].
    reference: f64,
    /// See [`Config::yields`].
    yields: bool,
    /// Unless melting is left out.
    melts: bool,
}

impl WeakSteel {
    /// Law for the parameters.
    pub fn new(config: &Config) -> Self {
        let (material, reference) = (&config.material, config.thermal.reference);
        let melts = material.latent_heat > 0.0 && reference < material.solidus;
        // Beyond the solidus nothing is known of strength, and bodies that are so hot as a whole are no steel.
        let start = reference + config.thermal.wheel_excess.max(0.0);
        let film =
            MeltingFilm { solidus: material.solidus, liquidus: material.liquidus, friction: material.film_friction };
        Self { melts, yields: config.physics.yielding && start < material.solidus, reference, film }
    }

    /// Absolute temperature at which melting is complete \[K]; `None` where it does not act on friction.
    pub fn liquidus(&self) -> Option<f64> {
        (self.melts && self.film.friction < 1.0).then_some(self.film.liquidus)
    }

    /// Fills `thermal.weakening` from the temperatures `seen` after a step of `dt` \[s] within which a unit of power per area
    /// warms the surfaces by `warming` [K m²/W], both infinite in the stationary state; its film is still that of the step
    /// before.
    pub fn find(
        &self,
        heat: &dyn HeatModel,
        traction: &Traction,
        [dt, warming]: [f64; 2],
        thermal: &mut ThermalState,
        seen: &mut Observation,
    ) -> Result<(), StepError> {
        let weakening = &mut thermal.weakening;
        weakening.strength.clear();
        weakening.warmer_wheel.clear();
        let hottest = self.reference + thermal.temperatures.wheel_max.max(thermal.temperatures.rail_max);
        if self.melts {
            match hottest <= SOFTENS || weakening.film.is_empty() && hottest <= self.film.solidus {
                true => weakening.film.clear(),
                false => self.melt(heat.zone_x(), [dt, warming], traction, seen, &mut weakening.film),
            }
        }
        if !self.yields || hottest <= SOFTENS || traction.patches.is_empty() {
            return Ok(());
        }
        let length: f64 = traction.patches.iter().map(|patch| patch.high - patch.low).sum();
        let depth = LOADED_DEPTH * 0.5 * length;
        heat.mean_over_depth(&thermal.fields, depth, &mut seen.core)?;
        let [wheel, rail] = &mut seen.core;
        for ((&x, wheel), rail) in heat.zone_x().iter().zip(wheel).zip(rail) {
            weakening.strength.push(x, yield_share(self.reference + wheel.max(*rail)));
            weakening.warmer_wheel.push(x, *wheel - *rail);
        }
        let Piecewise { x, value } = &mut weakening.strength;
        smear(x, value, depth);
        Ok(())
    }

    /// Largest share of friction on a place at the excess temperature `hot` \[K] after a step with `share` of it: a
    /// place that has overheated carries less than before, whatever the prediction says.
    fn overheated(&self, share: f64, hot: f64) -> f64 {
        let excess = self.liquidus().map_or(0.0, |liquidus| (self.reference + hot - liquidus).max(0.0));
        share * (1.0 - CUT * (excess / FILM_GROWS).min(1.0))
    }

    /// Share of friction on molten places in the coming step, which takes about as long as the last one. The temperature
    /// at its end is taken as linear in the share, and the share that belongs to its own temperature is found; a share
    /// from the temperature before would let the surface overheat and freeze in turns. In a long step the flash follows
    /// friction in full; in a short one it rises by `warming` [K m²/W] times the power of friction without a film.
    ///
    /// Above the solidus a film only grows. A place that freezes beside molten ones gets its friction back by and by
    /// ([`FREEZES`]), and no film outlasts the last molten place.
    fn melt(
        &self,
        zone: &[f64],
        [dt, warming]: [f64; 2],
        traction: &Traction,
        seen: &Observation,
        film: &mut Piecewise,
    ) {
        let before = film.clone();
        film.clear();
        let [wheel, rail] = &seen.surface;
        let pressed = |at: f64| traction.patches.iter().any(|patch| patch.low <= at && at <= patch.high);
        let places = zone.iter().zip(wheel.iter().zip(rail).map(|(wheel, rail)| wheel.max(*rail)));
        let places = places.filter(|(at, _)| pressed(**at));
        let is_solid = |hot: f64| self.reference + hot <= self.film.solidus;
        let all_solid = places.clone().all(|(_, hot)| is_solid(hot));
        for (&at, hot) in places {
            let share = if before.is_empty() { 1.0 } else { interpolate(&before.x, &before.value, at) };
            let slip = libm::hypot(traction.slip.at(at), traction.lateral_slip.at(at));
            let whole = (traction.friction.coefficient * traction.pressure.at(at) * slip).abs();
            let rise = (warming * whole).min(hot.max(0.0) / share.max(LEAST));
            let rest = self.reference + hot - share * rise;
            let found = melted_share(rise, rest, &self.film);
            let most = match is_solid(hot) {
                true if all_solid => 1.0,
                true => share.max(LEAST) * (1.0 + dt / FREEZES),
                false => self.overheated(share, hot),
            };
            film.push(at, found.min(most).max(REMAINS));
        }
        if film.value.iter().all(|share| *share == 1.0) {
            film.clear();
        }
    }
}
