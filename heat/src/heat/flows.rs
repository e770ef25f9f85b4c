//! Heat flows of a step.

use serde::{Deserialize, Serialize};

/// Mean heat flows over a step, or in the stationary state [W/m].
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct HeatFlows {
    /// Friction heat into both bodies, `γ_f ∫|τs| dx`.
    pub friction: f64,
    /// Heat of the sources into the wheel.
    pub supplied: f64,
    /// Wheel to rail through the contact conductance.
    pub conduction: f64,
    /// Net heat into the wheel through the contact: friction share and conduction.
    pub to_wheel: f64,
    /// Net heat into the rail through the contact.
    pub to_rail: f64,
    /// Wheel to hub.
    pub to_hub: f64,
    /// Heat that the stream carries out of the modelled rail, less the heat that enters with it.
    pub outflow: f64,
    /// Heat from the wheel to the air.
    pub wheel_to_air: f64,
    /// Heat from the rail to the air.
    pub rail_to_air: f64,
    /// Growth of the wheel's heat content.
    pub stored_wheel: f64,
    /// Growth of the rail's heat content.
    pub stored_rail: f64,
    /// Iterations of the correction to the exact operator (none in rolling).
    pub iterations: usize,
}

impl HeatFlows {
    /// Heat that the wheel receives, less the heat that it passes on and stores [W/m]; zero but for round-off.
    pub fn wheel_imbalance(&self) -> f64 {
        self.to_wheel + self.supplied - self.to_hub - self.wheel_to_air - self.stored_wheel
    }

    /// Heat that the rail receives, less the heat that it passes on and stores [W/m]; zero but for round-off.
    pub fn rail_imbalance(&self) -> f64 {
        self.to_rail - self.outflow - self.rail_to_air - self.stored_rail
    }

    /// Largest imbalance relative to the largest flow.
    pub fn relative_imbalance(&self) -> f64 {
        let largest = self.all().into_iter().fold(0.0_f64, |m, f| m.max(f.abs()));
        let worst = self.wheel_imbalance().abs().max(self.rail_imbalance().abs());
        if largest > 0.0 { worst / largest } else { 0.0 }
    }

    /// Heat put in less heat passed on or stored, and half the sum of the amounts of all flows [W/m]: each flow is
    /// counted at its source and at its sink.
    pub fn balance(&self) -> [f64; 2] {
        let sources = [self.friction, self.supplied];
        let Self { stored_wheel, stored_rail, to_hub, outflow, wheel_to_air, rail_to_air, .. } = *self;
        let sinks = [stored_wheel, stored_rail, to_hub, outflow, wheel_to_air, rail_to_air];
        let amount: f64 = sources.iter().chain(&sinks).map(|flow| flow.abs()).sum();
        [sources.iter().sum::<f64>() - sinks.iter().sum::<f64>(), 0.5 * amount]
    }

    /// Adds a share of other flows: the sum over all steps with their shares of the time is the mean.
    pub fn add(&mut self, share: f64, other: &Self) {
        let Self { friction, supplied, conduction, to_wheel, to_rail, to_hub, outflow, .. } = self;
        let Self { wheel_to_air, rail_to_air, stored_wheel, stored_rail, iterations, .. } = other;
        for (mean, flow) in [
            (friction, other.friction),
            (supplied, other.supplied),
            (conduction, other.conduction),
            (to_wheel, other.to_wheel),
            (to_rail, other.to_rail),
            (to_hub, other.to_hub),
            (outflow, other.outflow),
            (&mut self.wheel_to_air, *wheel_to_air),
            (&mut self.rail_to_air, *rail_to_air),
            (&mut self.stored_wheel, *stored_wheel),
            (&mut self.stored_rail, *stored_rail),
        ] {
            *mean += share * flow;
        }
        self.iterations += iterations;
    }

    fn all(&self) -> [f64; 9] {
        [
            self.friction,
            self.supplied,
            self.conduction,
            self.to_hub,
            self.outflow,
            self.wheel_to_air,
            self.rail_to_air,
            self.stored_wheel,
            self.stored_rail,
        ]
    }

    pub(super) fn is_finite(&self) -> bool {
        self.all().iter().all(|f| f.is_finite())
    }
}
