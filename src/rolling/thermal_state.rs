//! Temperatures under a contact line and their effects on the contact: the thermal part of a state.

use crate::contact::Heating;
use crate::damage::Damage;
use crate::heat::{HeatFlows, HeatState, Temperatures};
use crate::piecewise::{self, Piecewise};
use serde::{Deserialize, Serialize};

/// Temperature fields and what the last step found about them, per metre of width.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ThermalState {
    /// Both temperature fields.
    pub fields: HeatState,
    /// Mean heat flows over the last communication step [W/m].
    pub flows: HeatFlows,
    /// Excess temperatures \[K].
    pub temperatures: Temperatures,
    /// Mean excess temperatures of the surfaces in the patch: wheel, rail \[K].
    pub patch_mean: [f64; 2],
    /// Means weighted with the pressure: the temperatures at which friction acts. The edges of the patch, where nothing
    /// presses, do not disturb them.
    pub loaded_mean: [f64; 2],
    /// Mean of these over the friction coefficient \[K].
    pub heating: Heating,
    /// Largest molten thickness so far \[m].
    pub melted: f64,
    /// Excess surface temperatures of wheel and rail at the profile points, reversible heating included \[K].
    pub surface: [Vec<f64>; 2],
    /// Thermal history of the hot material.
    pub damage: Damage,
    /// Heat put in less heat passed on or stored since the start [J/m].
    pub unaccounted: f64,
    /// Heat that has gone from one place to another since the start [J/m].
    pub turned_over: f64,
    /// How the heat deforms the bodies.
    pub deformation: ThermalDeformation,
    /// Strength of the bodies after heat has weakened them.
    pub weakening: Weakening,
}

impl ThermalState {
    /// Excess temperature at which friction acts \[K]: the pressure-weighted mean of both surfaces.
    pub fn friction_excess(&self) -> f64 {
        0.5 * (self.loaded_mean[0] + self.loaded_mean[1])
    }
}

/// Strength of the steel under the contact after heat has weakened it, over x.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Weakening {
    /// Share of the yield strength, of the softer body \[1]; empty: all of it.
    pub strength: Piecewise,
    /// Share of the friction coefficient, where a surface melts \[1]; empty: all of it.
    pub film: Piecewise,
    /// Mean temperature of the wheel less that of the rail over the depth in which the contact pressure acts \[K]:
    /// which of them is softer; empty: neither.
    pub warmer_wheel: Piecewise,
}

impl Weakening {
    /// None at all.
    pub const NONE: Self = {
        const EMPTY: Piecewise = Piecewise::EMPTY;
        Self { strength: EMPTY, film: EMPTY, warmer_wheel: EMPTY }
    };

    /// Share of the friction coefficient that a film leaves at x \[1].
    pub fn film_at(&self, x: f64) -> f64 {
        if self.film.is_empty() { 1.0 } else { piecewise::interpolate(&self.film.x, &self.film.value, x) }
    }
}

/// Deformation by heat, as far as it acts on the contact.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ThermalDeformation {
    /// Growth of the wheel radius by the bulk temperature \[m].
    pub radius_growth: f64,
    /// Swelling of the hot layers of wheel and rail under the contact \[m].
    pub swelling: [Piecewise; 2],
    /// Membrane force of the hot layers of wheel and rail [N/m].
    pub membrane_force: [Piecewise; 2],
    /// Time in which the hot layers follow their heat besides the length of the step \[s]; zero: they do not lag.
    pub lag: f64,
    /// Swelling and membrane force that acted in the last step, wheel and rail each, at the same places; empty: nothing lags.
    pub acted: [Vec<f64>; 4],
}

/// Time that passes while a lag shortens by its own unit, over the latter \[1]: under a wheel that stands, and under one that
/// turns and carries its hot layers out of the contact. A lag that ended at once would let the layers swell in one short step by
/// what they missed in long ones, and throw the wheel up.
const CATCHING_UP: [f64; 2] = [2.0, 0.5];
/// Share of the last change of a layer that lags by which it goes on changing \[1]: layers that swell evenly lag less, and those
/// that alternate are held back more.
const MOMENTUM: f64 = 0.75;
/// Longest lag that is left after a step \[s]: the wheel swings on the rail within less.
const LONGEST_LAG: f64 = 1e-2;

impl ThermalDeformation {
    /// None at all.
    pub const NONE: Self = {
        const EMPTY: Piecewise = Piecewise::EMPTY;
        Self {
            radius_growth: 0.0,
            swelling: [EMPTY, EMPTY],
            membrane_force: [EMPTY, EMPTY],
            lag: 0.0,
            acted: [const { Vec::new() }; 4],
        }
    };

    /// Lets the hot layers lag behind in a step of `dt` \[s] from `before`, in which the wheel `turns` or stands: by `lag` \[s],
    /// and by what is left of the lag before.
    /// The growth of the wheel does not lag: held back in long steps it would press the wheel onto the rail in the next short one.
    pub fn relax(&mut self, before: &Self, (dt, turns): (f64, bool), lag: f64) {
        self.lag = lag.max(before.lag.min(LONGEST_LAG) - dt / CATCHING_UP[usize::from(turns)]);
        self.acted.iter_mut().for_each(Vec::clear);
        if self.lag > 0.0 {
            let share = dt / (dt + self.lag);
            let Self { swelling, membrane_force, acted, .. } = self;
            let layers = swelling.iter_mut().chain(membrane_force).zip(before.layers());
            for ((now, before), (acted, earlier)) in layers.zip(acted.iter_mut().zip(&before.acted)) {
                acted.extend_from_slice(&before.value);
                for (k, (now, acting)) in now.value.iter_mut().zip(&before.value).enumerate() {
                    let going_on = acting + earlier.get(k).map_or(0.0, |earlier| MOMENTUM * (acting - earlier));
                    *now = going_on + share * (*now - going_on);
                }
            }
        }
    }

    /// Lets what has changed in the last step act to this `share` only in one that is as much shorter: it changes no faster than
    /// before.
    pub fn ease(&mut self, share: f64) {
        let Self { swelling, membrane_force, acted, .. } = self;
        for (now, acted) in swelling.iter_mut().chain(membrane_force).zip(acted) {
            now.value.iter_mut().zip(acted).for_each(|(now, acted)| *now = *acted + share * (*now - *acted));
        }
    }

    fn layers(&self) -> impl Iterator<Item = &Piecewise> {
        self.swelling.iter().chain(&self.membrane_force)
    }

    /// Moves it by `share` of the way from `before` to where it is.
    pub fn average(&mut self, before: &Self, share: f64) {
        let mix = |now: &mut f64, before: f64| *now = before + share * (*now - before);
        mix(&mut self.radius_growth, before.radius_growth);
        let layers = self.swelling.iter_mut().chain(&mut self.membrane_force);
        for (now, before) in layers.zip(before.layers()) {
            now.value.iter_mut().zip(&before.value).for_each(|(now, before)| mix(now, *before));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Layers whose heat grows at an even rate, in 30 steps of 1 ms and then in steps of 10 µs: what acts never changes at more
    /// than 2.5 times that rate, and has caught up in the end.
    #[test]
    fn layers_that_swell_evenly_go_on_so_where_steps_become_shorter() {
        let (rate, unit) = (3.0, 0.2e-3);
        let mut state = ThermalDeformation::NONE;
        state.swelling[0].push(0.0, 0.0);
        let (mut time, mut last, mut acting, mut fastest) = (0.0, 1e-3, 0.0, 0.0_f64);
        for dt in std::iter::repeat_n(1e-3, 30).chain(std::iter::repeat_n(1e-5, 2000)) {
            if dt < last {
                state.ease(dt / last);
            }
            let now = state.swelling[0].value[0];
            fastest = fastest.max((now - acting) / dt);
            (time, acting, last) = (time + dt, now, dt);
            let mut next = ThermalDeformation::NONE;
            next.swelling[0].push(0.0, rate * time);
            next.relax(&state, (dt, false), dt * dt / unit);
            state = next;
        }
        let behind = time - acting / rate;
        println!("{:.2} times the rate at most, {behind:.1e} s behind in the end", fastest / rate);
        assert!((1.0..2.5).contains(&(fastest / rate)) && behind < 5e-5);
    }
}
