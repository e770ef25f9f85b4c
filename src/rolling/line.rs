//! One of the contact lines side by side.

use super::thermal_state::{ThermalDeformation, ThermalState, Weakening};
use crate::contact::{ContactState, LineLayout};
use crate::surface::Flattening;
use serde::{Deserialize, Serialize};

/// One contact line, per metre of its own width.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Line {
    /// Its part of the patch.
    pub layout: LineLayout,
    /// Contact: result of the last step and start of the next one.
    pub contact: ContactState,
    /// Material that wheel and rail have lost to yield and wear.
    pub flattening: [Flattening; 2],
    /// Mass that wear has taken off the wheel since the start [kg/m].
    pub worn: f64,
    /// Temperatures, unless the thermal part is switched off.
    pub thermal: Option<ThermalState>,
}

impl Line {
    /// Thermal deformation that acts on the contact.
    pub fn deformation(&self) -> &ThermalDeformation {
        static NONE: ThermalDeformation = ThermalDeformation::NONE;
        self.thermal.as_ref().map_or(&NONE, |thermal| &thermal.deformation)
    }

    /// Strength of the steel after heat has weakened it.
    pub fn weakening(&self) -> &Weakening {
        static NONE: Weakening = Weakening::NONE;
        self.thermal.as_ref().map_or(&NONE, |thermal| &thermal.weakening)
    }

    /// Distance \[m] and angle of the rim \[rad] under this line where the wheel has travelled and turned `[distance,
    /// angle]`.
    pub fn place(&self, [distance, angle]: [f64; 2]) -> [f64; 2] {
        [distance, angle - self.contact.rim_angle()]
    }

    /// Highest rise of temperature in the contact \[K].
    pub fn hottest(&self) -> f64 {
        self.thermal.as_ref().map_or(0.0, |thermal| thermal.temperatures.wheel_max.max(thermal.temperatures.rail_max))
    }
}
