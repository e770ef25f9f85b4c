//! The heat flows of a stage, from its end.

use super::layout::Heat;
use super::loads::SurfaceLoads;
use super::modal::{HeatBody, dot};
use super::stage::{BodyOperator, Stage};
use crate::heat::model::HeatFlows;

impl Stage {
    /// Adds `weight` times the heat flows of a stage to their mean.
    pub fn add_flows(
        &mut self,
        heat: &Heat,
        loads: &SurfaceLoads,
        ends: &StageEnd,
        weight: f64,
        flows: &mut HeatFlows,
    ) {
        let StageEnd { temperature, content, rate } = *ends;
        flows.friction += weight * loads.friction_heat();
        flows.tread += weight * loads.tread.iter().map(|q| q[0]).sum::<f64>();
        if self.coupled() {
            self.set_jump(heat, temperature);
            let moments = &loads.conductance[self.elements.clone()];
            let through = moments.iter().zip(self.jump.windows(2)).map(|(c, d)| (c[0] - c[1]) * d[0] + c[1] * d[1]);
            let reversible = loads.reversible.iter().map(|q| q[0]);
            flows.conduction += weight * (through.sum::<f64>() + reversible.sum::<f64>());
        }
        let share = heat.config.thermal.wheel_share;
        flows.to_wheel = share * flows.friction - flows.conduction;
        flows.to_rail = (1.0 - share) * flows.friction + flows.conduction;
        let size = heat.wheel.size();
        let (now, held, change) = (temperature.split_at(size), content.split_at(size), rate.map(|r| r.split_at(size)));
        let wheel = self.wheel.flows(&heat.wheel, now.0, held.0, change.map(|r| r.0));
        flows.stored_wheel += weight * wheel.stored;
        flows.wheel_to_air += weight * (wheel.air + loads.radiation[0].heat);
        flows.to_hub += if heat.wheel.modes.fixed { weight * wheel.fixed } else { 0.0 };
        let rail = self.rail.flows(&heat.rail, now.1, held.1, change.map(|r| r.1));
        flows.stored_rail += weight * rail.stored;
        flows.rail_to_air += weight * (rail.air + loads.radiation[1].heat);
        flows.outflow += weight * rail.out;
    }
}

/// Both bodies at the end of a stage.
#[derive(Clone, Copy)]
pub(super) struct StageEnd<'a> {
    /// Temperature.
    pub temperature: &'a [f64],
    /// Heat content over `ρc`: the temperature where nothing melts.
    pub content: &'a [f64],
    /// Its rate; `None`: it does not change.
    pub rate: Option<&'a [f64]>,
}

/// Heat flows of one body [W/m].
struct BodyFlows {
    stored: f64,
    air: f64,
    /// Into the fixed nodes.
    fixed: f64,
    /// With the stream.
    out: f64,
}

impl BodyOperator {
    /// Flows at the temperatures `x` and heat contents `content` that change at the rates `rate`.
    fn flows(&mut self, body: &HeatBody, x: &[f64], content: &[f64], rate: Option<&[f64]>) -> BodyFlows {
        let modes = &body.modes;
        let [now, change] = &mut self.sums;
        body.integrate(x, now);
        match rate {
            Some(rate) => body.integrate(rate, change),
            None => {
                change.clear();
                change.resize(modes.len(), 0.0);
            }
        }
        let (mut stored, mut air, mut fixed) = (0.0, 0.0, 0.0);
        for m in 0..modes.len() {
            stored += body.heat_capacity * modes.content[m] * change[m];
            let film = body.film * modes.air[m] * now[m];
            air += film;
            // Residual of the energy balance tested with 1 at the free nodes: what reaches the fixed ones.
            fixed += body.conductivity * modes.values[m] * modes.free[m] * now[m]
                - film
                - body.heat_capacity * (modes.content[m] - modes.free[m]) * change[m];
        }
        let out = self.transport.exit.map_or(0.0, |(node, flux)| {
            let nm = modes.len();
            flux * dot(&content[node * nm..(node + 1) * nm], &modes.content)
        });
        BodyFlows { stored, air, fixed, out }
    }
}
