//! What heat leaves of the steel under the contact: less strength deep below the surface, less friction where the surface melts.

use crate::config::{Config, Material};
use crate::contact::Traction;
use crate::heat::{Heat, HeatModel, Observation};
use crate::material::{FILM_GROWS, SOFTENS, melted_share, yield_share};
use crate::piecewise::{Piecewise, interpolate, smear};
use crate::rolling::error::StepError;
use crate::rolling::state::ThermalState;
use std::f64::consts::PI;

/// Depth in which the pressure of a patch acts, in its half-widths: there the shear stress of a Hertzian line contact is near
/// its maximum, and a hotter but thinner skin does not yield on its own. Nor does a narrower strip: the steel that flows under
/// a punch down to some depth does so over more than that depth to both sides, and its strength counts everywhere on the way.
const LOADED_DEPTH: f64 = 0.5;

/// Share of friction below which temperatures say nothing about those without a film [1].
const LEAST: f64 = 1e-3;

/// How steel weakens.
#[derive(Clone, Debug)]
pub struct WeakSteel {
    material: Material,
    /// Absolute temperature of excess zero [K].
    reference: f64,
    /// Unless `physics.yielding` is off.
    yields: bool,
    /// Unless melting is left out.
    melts: bool,
    /// Distance up to which friction heats what lies beside it \[m]: two elements of the contact. The film at its nodes is that of
    /// all places within: where it is thick, friction on the colder node beside would go on heating what has no friction itself.
    reach: f64,
}

impl WeakSteel {
    /// From the parameters.
    pub fn new(config: &Config, spacing: f64) -> Self {
        let (material, reference) = (config.material.clone(), config.thermal.reference);
        let melts = material.latent_heat > 0.0 && reference < material.solidus;
        // Beyond the solidus nothing is known of strength, and bodies that are so hot as a whole are no steel.
        let start = reference + config.thermal.wheel_excess.max(0.0);
        Self {
            melts,
            reach: 2.0 * spacing,
            yields: config.physics.yielding && start < material.solidus,
            reference,
            material,
        }
    }

    /// Absolute temperature at which melting is complete \[K]; `None` where it does not act on friction.
    pub fn liquidus(&self) -> Option<f64> {
        (self.melts && self.material.film_friction < 1.0).then_some(self.material.liquidus)
    }

    /// Fills `thermal.weakening` from the temperatures `seen` after a step of `dt` \[s], infinite in the stationary state; its
    /// film is still that with which the step was taken. Returns how much of the friction power
    /// belongs to other temperatures than those at the end, or the largest share of friction on a place that bears none any more \[1].
    pub fn find(
        &self,
        heat: &Heat,
        traction: &Traction,
        dt: f64,
        thermal: &mut ThermalState,
        seen: &mut Observation,
    ) -> Result<f64, StepError> {
        let weakening = &mut thermal.weakening;
        weakening.strength.clear();
        weakening.warmer_wheel.clear();
        let hottest = self.reference + thermal.temperatures.wheel_max.max(thermal.temperatures.rail_max);
        let unsettled = match self.melts {
            true => self.melt(heat.zone_x(), [dt, hottest], traction, seen, &mut weakening.film),
            false => 0.0,
        };
        if !self.yields || hottest <= SOFTENS || traction.patches.is_empty() {
            return Ok(unsettled);
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
        Ok(unsettled)
    }

    /// Share of friction on molten places in a step of about `dt` \[s]: that at whose end each place has the temperature to which
    /// its share belongs. `film` is what a step was taken with, and `seen` is how it ended. The temperature at its end is taken as
    /// linear in the share, and the share that belongs to its own temperature is found; one from the temperature before would let
    /// the surface overheat and freeze in turns. In a long step the flash follows friction in full, as in
    /// [`crate::contact::Friction::local`]; in a short one it rises by what the power warms a half-space, `q √(Δt/π)/√(kρc)` with
    /// half of the power `q` of full friction for each body. Returns what [`Self::find`] does.
    fn melt(
        &self,
        zone: &[f64],
        [dt, hottest]: [f64; 2],
        traction: &Traction,
        seen: &Observation,
        film: &mut Piecewise,
    ) -> f64 {
        if film.is_empty() && hottest <= self.material.solidus {
            return 0.0;
        }
        let before = std::mem::take(film);
        let Material { conductivity, density, specific_heat, .. } = self.material;
        let warming = (dt / (PI * conductivity * density * specific_heat)).sqrt();
        let place = |(&at, (wheel, rail)): (&f64, (&f64, &f64))| {
            let (share, hot) = (share_at(&before, at), wheel.max(*rail));
            let whole = (traction.friction * traction.pressure.at(at) * traction.slip.at(at)).abs();
            let rise = (warming * whole).min(hot.max(0.0) / share.max(LEAST));
            Place { at, whole, share, temperature: self.reference + hot, rise }
        };
        let [wheel, rail] = &seen.surface;
        let places: Vec<Place> = zone.iter().zip(wheel.iter().zip(rail)).map(place).collect();
        let (mut missed, mut carried, mut overheated) = (0.0, 0.0, 0.0_f64);
        for (k, place) in places.iter().enumerate() {
            let Place { at, share, temperature, rise, .. } = *place;
            let mut own = melted_share(0.0, temperature, &self.material);
            let mut found = melted_share(rise, temperature - share * rise, &self.material);
            let near = |other: &&Place| (other.at - at).abs() <= self.reach;
            let before = places[..k].iter().rev().take_while(near);
            for beside in places[k + 1..].iter().take_while(near).chain(before) {
                own = own.min(self.borne(beside.temperature, 0.0));
                let rise = rise.max(beside.rise);
                found = found.min(self.borne(beside.temperature - share * rise, rise));
            }
            missed += place.whole * (own - share).abs();
            carried += place.whole * share;
            if own == 0.0 && place.whole > 0.0 {
                overheated = overheated.max(share);
            }
            film.push(at, found);
        }
        if film.value.iter().all(|share| *share == 1.0) {
            film.clear();
        }
        if carried > 0.0 { overheated.max(missed / carried) } else { 0.0 }
    }

    /// Share of friction that a place carries beside one with the temperature `rest` \[K] and `rise` \[K] times the share: nothing
    /// where the film there is so thick that it carries nothing, and all up to the liquidus.
    fn borne(&self, rest: f64, rise: f64) -> f64 {
        let Some(liquidus) = self.liquidus() else { return 1.0 };
        ((liquidus + FILM_GROWS - rest) / (FILM_GROWS + rise)).clamp(0.0, 1.0)
    }
}

/// A place of the surface where steel may melt.
struct Place {
    /// Where it lies \[m].
    at: f64,
    /// Power of friction without a film [W/m²].
    whole: f64,
    /// Share of it that is left \[1].
    share: f64,
    /// Temperature of the hotter surface \[K].
    temperature: f64,
    /// Part of it that full friction makes in a step \[K].
    rise: f64,
}

/// Share of friction at a place under a film.
fn share_at(film: &Piecewise, x: f64) -> f64 {
    if film.is_empty() { 1.0 } else { interpolate(&film.x, &film.value, x) }
}
