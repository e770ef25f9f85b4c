//! Exchange of heat at the surfaces during a step: patches, frictional heat, other sources.

use crate::piecewise::{Interval, Piecewise};
use serde::{Deserialize, Serialize};

/// Source of prescribed heat into the wheel, beside friction in the contact.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct HeatSource {
    /// Where it enters, uniformly.
    pub place: HeatPlace,
    /// Heat into the wheel [W/m].
    pub heat: f64,
}

impl HeatSource {
    /// Source on an arc of the tread around the `angle` \[rad] of the `width` \[rad].
    pub fn on_tread(angle: f64, width: f64, heat: f64) -> Self {
        Self { place: HeatPlace::Tread { angle, width }, heat }
    }
}

/// Part of the wheel that a source heats; it is fixed in space, and the wheel turns through it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum HeatPlace {
    /// Arc of the tread, of the width of a brake block.
    Tread {
        /// Angle of its middle from the contact point, positive on the leading side \[rad].
        angle: f64,
        /// Angle that it covers \[rad].
        width: f64,
    },
}

/// Contact and heat at the surfaces per metre of width at the end of a step; all but the friction power holds over the
/// step.
///
/// It may be refilled for every step without new memory, see [`Exchange::clear`].
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Exchange {
    /// Intervals in which the bodies touch, without overlap; none: lifted off.
    pub patches: Vec<Interval>,
    /// Friction power per area `|τ s|` over x [W/m²], of which the fraction `γ_f` becomes heat in the bodies.
    pub friction_power: Piecewise,
    /// Share of the friction power that a molten film leaves at the nodes of the surfaces \[1], constant beyond its ends; empty: all
    /// of it.
    pub film: Piecewise,
    /// By how much the mean of the friction power over the step exceeds that at its end, relative to the latter \[1];
    /// zero: it holds over the step.
    pub friction_excess: f64,
    /// Sources of heat beside friction.
    pub sources: Vec<HeatSource>,
    /// Reversible temperatures over x that conduct besides those of the fields: wheel less rail \[K].
    pub reversible: Piecewise,
    /// Temperature of the rail that arrives with the stream, over the reference \[K].
    pub arriving: f64,
}

impl Exchange {
    /// Removes everything and keeps the memory.
    pub fn clear(&mut self) {
        self.patches.clear();
        self.friction_power.clear();
        self.film.clear();
        self.friction_excess = 0.0;
        self.sources.clear();
        self.reversible.clear();
        self.arriving = 0.0;
    }
}
