//! Exchange of heat at the surfaces during a step: patches, pressure, frictional heat, heat on the tread.

use crate::piecewise::{Interval, Piecewise};
use serde::{Deserialize, Serialize};

/// Prescribed heat on an arc of the tread that is fixed in space (a brake block).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct TreadHeat {
    /// Angle of its middle from the contact point, positive on the leading side \[rad].
    pub angle: f64,
    /// Angle that it covers \[rad].
    pub width: f64,
    /// Heat into the wheel [W/m], uniform over the arc.
    pub heat: f64,
}

/// Contact and heat at the surfaces per metre of width at the end of a step; all but the friction power holds over the
/// step.
///
/// It may be refilled for every step without new memory, see [`Exchange::clear`].
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Exchange {
    /// Intervals in which the bodies touch, without overlap; none: lifted off.
    pub patches: Vec<Interval>,
    /// Contact pressure over x \[Pa]; used by the pressure-dependent conductance only.
    pub pressure: Piecewise,
    /// Friction power per area `|τ s|` over x [W/m²], of which the fraction `γ_f` becomes heat in the bodies.
    pub friction_power: Piecewise,
    /// By how much the mean of the friction power over the step exceeds that at its end, relative to the latter \[1];
    /// zero: it holds over the step.
    pub friction_excess: f64,
    /// Heat on the tread of the wheel.
    pub tread: Vec<TreadHeat>,
    /// Reversible temperatures over x that conduct besides those of the fields: wheel less rail \[K].
    pub reversible: Piecewise,
    /// Temperature of the rail that arrives with the stream, over the reference \[K].
    pub arriving: f64,
}

impl Exchange {
    /// Removes everything and keeps the memory.
    pub fn clear(&mut self) {
        self.patches.clear();
        self.pressure.clear();
        self.friction_power.clear();
        self.friction_excess = 0.0;
        self.tread.clear();
        self.reversible.clear();
        self.arriving = 0.0;
    }
}
