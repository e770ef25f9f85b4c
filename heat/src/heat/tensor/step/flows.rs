//! The heat flows of a stage, from its end.

use super::loads::SurfaceLoads;
use crate::heat::flows::HeatFlows;
use crate::heat::state::HeatState;
use crate::heat::tensor::mesh::body::HeatBody;
use crate::heat::tensor::mesh::kernels::dot;
use crate::heat::tensor::mesh::layout::HeatLayout;
use crate::heat::tensor::solve::line_conduction::LineConduction;
use crate::heat::tensor::solve::operators::{BodyOperator, StageOperators};

impl LineConduction {
    /// Sums the field of `state` along the streamlines, unless its sums are known.
    pub fn take_sums(&mut self, layout: &HeatLayout, state: &HeatState) {
        if state.sums.iter().any(Vec::is_empty) {
            return self.set_sums(layout, &state.values);
        }
        for (side, sums) in self.sides.iter_mut().zip(&state.sums) {
            side.sums[0].clone_from(sums);
        }
    }

    /// Leaves the sums of the field at the end of a step to its state.
    pub fn leave_sums(&self, state: &mut HeatState) {
        for (sums, side) in state.sums.iter_mut().zip(&self.sides) {
            sums.clone_from(&side.sums[0]);
        }
    }

    /// Sums the field from which a stage starts along the streamlines.
    pub fn set_sums(&mut self, layout: &HeatLayout, field: &[f64]) {
        for ((body, field), side) in layout.bodies().into_iter().zip(layout.split(field)).zip(&mut self.sides) {
            body.integrate(field, &mut side.sums[0]);
        }
    }

    /// Takes these sums on by `dt` seconds, at the rates of the last stage.
    pub fn advance_sums(&mut self, dt: f64) {
        for side in &mut self.sides {
            let [now, change] = &mut side.sums;
            now.iter_mut().zip(change).for_each(|(now, change)| *now += dt * *change);
        }
    }

    /// Adds `weight` times the heat flows of a stage to their mean; the sums are those of `ends.temperature` and of its
    /// rate, if it has one.
    pub fn add_flows(
        &mut self,
        stage: &StageOperators,
        layout: &HeatLayout,
        loads: &SurfaceLoads,
        ends: &StageEnd,
        weight: f64,
        flows: &mut HeatFlows,
    ) {
        let StageEnd { temperature, content, rate, ahead } = *ends;
        flows.friction += weight * loads.friction_heat();
        flows.supplied += weight * loads.sources.heat();
        if self.coupled() {
            self.set_jump_ahead(stage, layout, temperature, rate, ahead);
            let moments = &loads.conductance[self.elements.clone()];
            let through = moments.iter().zip(self.jump.windows(2)).map(|(c, d)| (c[0] - c[1]) * d[0] + c[1] * d[1]);
            let reversible = loads.reversible.iter().map(|q| q[0]);
            flows.conduction += weight * (through.sum::<f64>() + reversible.sum::<f64>());
        }
        let share = layout.config.wheel_share;
        flows.to_wheel = share * flows.friction - flows.conduction;
        flows.to_rail = (1.0 - share) * flows.friction + flows.conduction;
        let (held, change) = (layout.split(content), rate.map(|rate| layout.split(rate)));
        let [of_wheel, of_rail] = &mut self.sides;
        let sums = &mut of_wheel.sums;
        let wheel = stage.wheel.flows(&layout.wheel, sums, held[0], change.map(|rate| rate[0]), ahead);
        flows.stored_wheel += weight * wheel.stored;
        flows.wheel_to_air += weight * wheel.air;
        flows.to_hub += if layout.wheel.modes.fixed { weight * wheel.fixed } else { 0.0 };
        let sums = &mut of_rail.sums;
        let rail = stage.rail.flows(&layout.rail, sums, held[1], change.map(|rate| rate[1]), ahead);
        flows.stored_rail += weight * rail.stored;
        flows.rail_to_air += weight * rail.air;
        let entered = stage.rail.transport.entry.map_or(0.0, |(_, stream)| stream * loads.arriving);
        flows.outflow += weight * (rail.out - entered * layout.rail.modes.section);
    }
}

/// State of both bodies at the end of a stage: temperature and heat content there are the given ones and `ahead` times
/// the rate.
#[derive(Clone, Copy)]
pub struct StageEnd<'a> {
    /// Temperature.
    pub temperature: &'a [f64],
    /// Heat content over `ρc`: the temperature where nothing melts.
    pub content: &'a [f64],
    /// Rate of the heat content; `None`: it does not change.
    pub rate: Option<&'a [f64]>,
    /// \[s]
    pub ahead: f64,
}

/// Heat flows of one body [W/m].
struct BodyFlows {
    stored: f64,
    air: f64,
    /// Into the fixed nodes.
    fixed: f64,
    /// Heat that leaves with the stream.
    out: f64,
}

impl BodyOperator {
    /// Flows at the temperatures whose `sums` are known and heat contents `content`, `ahead` seconds on at the rates
    /// `rate`.
    fn flows(
        &self,
        body: &HeatBody,
        sums: &mut [Vec<f64>; 2],
        content: &[f64],
        rate: Option<&[f64]>,
        ahead: f64,
    ) -> BodyFlows {
        let modes = &body.modes;
        let [now, change] = sums;
        if rate.is_none() {
            change.clear();
            change.resize(modes.len(), 0.0);
        }
        let (mut stored, mut air, mut fixed) = (0.0, 0.0, 0.0);
        for m in 0..modes.len() {
            let now = now[m] + ahead * change[m];
            stored += body.heat_capacity * modes.content[m] * change[m];
            let to_air = body.convection * modes.air[m] * now;
            air += to_air;
            // Residual of the energy balance tested with 1 at the free nodes: heat that reaches the fixed ones.
            fixed += body.conductivity * modes.values[m] * modes.free[m] * now
                - to_air
                - body.heat_capacity * (modes.content[m] - modes.free[m]) * change[m];
        }
        let ahead_exit = self.inverses.present().exit;
        let out = self.transport.exit.map_or(0.0, |(node, exit)| {
            let nm = modes.len();
            let held = |field: &[f64]| dot(&field[node * nm..(node + 1) * nm], &modes.content);
            // The change of the stage leaves with the stream of the matrix that is inverted.
            exit * held(content) + ahead_exit * ahead * rate.map_or(0.0, held)
        });
        BodyFlows { stored, air, fixed, out }
    }
}
