//! One implicit step of both bodies, and their stationary state.

use super::interface::{Exchange, Supply};
use super::krylov::{self, System};
use super::modal::{Blend, Body, Factor};
use super::tensor::Transport;
use super::{CURVED_BELOW, CURVED_STEP, Heat, HeatConfig, HeatError, HeatFlows, HeatState, HeatTimeScheme};
use nalgebra::linalg::LU;
use nalgebra::{DMatrix, DVector, Dyn};
use serde::{Deserialize, Serialize};
use std::f64::consts::FRAC_1_SQRT_2;
use std::ops::Range;

/// Range of step sizes [s].
pub const SMALLEST_STEP: f64 = 1e-9;
pub const LARGEST_STEP: f64 = 1e6;
/// Relative residual of the exact operator at which its correction stops, in steps and in the stationary state, and at
/// which it is accepted where round-off stops it. In steps the heat balance holds at any residual: what the modal solver
/// leaves out moves heat along the streamlines only.
const STEP_TOLERANCE: f64 = 1e-10;
const STATIONARY_TOLERANCE: f64 = 1e-13;
const ACCEPTED: f64 = 1e-9;
/// Storage that keeps the preconditioner of the stationary state regular, relative to `κ/r_o²` [1].
const REGULARISATION: f64 = 1e-3;

/// Relative change of speeds or conductance over a step up to which both stages use the operator of its end. The stiff
/// surface temperatures do not notice, the slow ones err by a fraction of this number.
const SAME_OPERATOR: f64 = 1e-3;

/// Relative change of speeds, conductance or heat over a step that counts as a jump.
const JUMP: f64 = 0.3;
/// Heat whose changes do not count [W/m]: it warms a rolling contact by less than a kelvin.
const SLIGHT_HEAT: f64 = 1e4;

/// Speeds and boundary data at one time.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Moment {
    /// Velocity of the wheel's centre [m/s] and angular velocity [rad/s], forward rolling positive.
    pub velocity: f64,
    pub omega: f64,
    pub supply: Supply,
}

/// Stream, factors and coupling matrices of one body.
#[derive(Clone, Debug, Default)]
struct Side {
    transport: Transport,
    factor: Factor,
    /// Rows of `∫ k_c N w̃` on the contact nodes: lower, diagonal, upper.
    contact: Vec<[f64; 3]>,
    response: Vec<f64>,
    work: Vec<f64>,
    trace: Vec<f64>,
    sums: [Vec<f64>; 2],
}

/// Everything needed to apply and to invert the matrix of an implicit stage.
#[derive(Clone, Debug, Default)]
struct Stage {
    moment: Moment,
    blend: Option<Blend>,
    wheel: Side,
    rail: Side,
    /// Contact nodes, counted from the first node of the zone.
    nodes: Range<usize>,
    coupling: Option<LU<f64, Dyn, Dyn>>,
    curved: bool,
}

/// Buffers of a step; holds nothing that outlives it.
#[derive(Clone, Debug, Default)]
pub struct Scratch {
    /// Whose operators `stage` holds.
    owner: Option<HeatConfig>,
    stage: Stage,
    moment: Moment,
    known: Vec<f64>,
    rate: Vec<f64>,
    load: Vec<f64>,
}

impl Heat {
    /// Advances `state` by `dt` [s] to the velocity `velocity` [m/s], the angular velocity `omega` [rad/s] and the
    /// exchange at the end of the step; in between everything varies linearly from the end of the step before (speeds and
    /// conductance that change by less than 1e-3 are taken from the end).
    ///
    /// With [`Exchange::held`] the values of the end hold throughout. After a jump of them, and without a step before (see
    /// [`HeatState::restart`]), they hold, too, and the step is one of backward Euler, which does not overshoot. The flows
    /// are means over the step. On error `state` is untouched.
    ///
    /// SDIRK2, `γ = 1 − 1/√2`, stiffly accurate and L-stable (Alexander, *SIAM J. Numer. Anal.* 14 (1977)):
    /// `ρcM̃ k₁ = f − A(T + γΔt k₁)`, `ρcM̃ k₂ = f − A(T + (1−γ)Δt k₁ + γΔt k₂)`, `T ← T + (1−γ)Δt k₁ + γΔt k₂`.
    pub fn step(
        &self,
        state: &mut HeatState,
        dt: f64,
        velocity: f64,
        omega: f64,
        exchange: &Exchange,
        scratch: &mut Scratch,
    ) -> Result<HeatFlows, HeatError> {
        if !(SMALLEST_STEP..=LARGEST_STEP).contains(&dt) {
            return Err(HeatError::StepSize { dt });
        }
        self.check_state(state)?;
        let end = self.moment(velocity, omega, exchange)?;
        let steady = state.history.as_ref().filter(|before| !before.jumps_to(&end));
        let start = if exchange.held { steady.map(|_| &end) } else { steady };
        let (gamma, stages): (f64, &[f64]) = match (self.config.time_scheme, start) {
            (HeatTimeScheme::Sdirk2, Some(_)) => (1.0 - FRAC_1_SQRT_2, &[1.0 - FRAC_1_SQRT_2, 1.0]),
            _ => (1.0, &[1.0]),
        };
        let start = start.unwrap_or(&end);
        let blend = Blend { storage: 1.0, flow: gamma * dt };
        if scratch.owner.as_ref() != Some(&self.config) {
            *scratch = Scratch { owner: Some(self.config.clone()), ..Scratch::default() };
        }
        let Scratch { stage, moment, known, rate, load, .. } = scratch;
        known.clear();
        known.extend(state.wheel.iter().chain(&state.rail));
        let mut flows = HeatFlows::default();
        for (index, &time) in stages.iter().enumerate() {
            moment.mix(start, &end, time);
            let curved = moment.omega.abs() < CURVED_BELOW && dt >= CURVED_STEP;
            stage.set(self, moment, blend, 1.0 / (gamma * dt), curved)?;
            let (weight, next) =
                if index + 1 == stages.len() { (gamma, 0.0) } else { (1.0 - gamma, 1.0 - 2.0 * gamma) };
            stage.add_loads(self, load);
            stage.multiply(self, Blend { storage: 0.0, flow: -1.0 }, known, load);
            std::mem::swap(rate, load);
            flows.iterations += stage.solve(self, blend, rate)?;
            // Temperature at this stage, then the known part of the next one.
            known.iter_mut().zip(&*rate).for_each(|(t, k)| *t += gamma * dt * k);
            stage.add_flows(self, known, Some(rate), weight, &mut flows);
            if next != 0.0 {
                known.iter_mut().zip(&*rate).for_each(|(t, k)| *t += next * dt * k);
            }
        }
        if !flows.is_finite() {
            return Err(HeatError::NotFinite { dt, velocity, omega });
        }
        let (wheel, rail) = known.split_at(self.wheel.size());
        state.wheel.copy_from_slice(wheel);
        state.rail.copy_from_slice(rail);
        state.history = Some(end);
        Ok(flows)
    }

    /// Stationary temperatures at constant speeds and exchange.
    ///
    /// Fails where heat is supplied and nothing removes it (insulated hub, no air, standing wheel on a standing rail).
    pub fn stationary(
        &self,
        velocity: f64,
        omega: f64,
        exchange: &Exchange,
    ) -> Result<(HeatState, HeatFlows), HeatError> {
        let end = self.moment(velocity, omega, exchange)?;
        let mut stage = Stage::default();
        let diffusivity = self.wheel.conductivity / self.wheel.heat_capacity;
        let storage = REGULARISATION * diffusivity / (self.config.wheel_radius.powi(2));
        stage.set(self, &end, Blend { storage, flow: 1.0 }, 0.0, true)?;
        let mut field = Vec::new();
        stage.add_loads(self, &mut field);
        let iterations = stage.solve(self, Blend { storage: 0.0, flow: 1.0 }, &mut field)?;
        let mut flows = HeatFlows { iterations, ..HeatFlows::default() };
        stage.add_flows(self, &field, None, 1.0, &mut flows);
        if !flows.is_finite() {
            return Err(HeatError::NotFinite { dt: f64::INFINITY, velocity, omega });
        }
        let rail = field.split_off(self.wheel.size());
        Ok((HeatState { wheel: field, rail, history: Some(end) }, flows))
    }

    fn moment(&self, velocity: f64, omega: f64, exchange: &Exchange) -> Result<Moment, HeatError> {
        for (name, value) in [("velocity", velocity), ("angular velocity", omega)] {
            if !value.is_finite() {
                return Err(HeatError::Input { name, value });
            }
        }
        Ok(Moment { velocity, omega, supply: self.supply(exchange)? })
    }
}

impl Moment {
    fn mix(&mut self, a: &Self, b: &Self, f: f64) {
        let between = |a: f64, b: f64| if a == b { a } else { (1.0 - f) * a + f * b };
        self.velocity = between(a.velocity, b.velocity);
        self.omega = between(a.omega, b.omega);
        Supply::mix(&a.supply, &b.supply, f, &mut self.supply);
        if a.close(b) {
            (self.velocity, self.omega) = (b.velocity, b.omega);
            self.supply.conductance.clone_from(&b.supply.conductance);
        }
    }

    /// Whether speeds, conductance or heat change too much within a step to be taken as varying linearly.
    fn jumps_to(&self, other: &Self) -> bool {
        let jump = |a: f64, b: f64| (a - b).abs() > JUMP * a.abs().max(b.abs());
        let (a, b) = (&self.supply, &other.supply);
        let conductance = |s: &Supply| s.conductance.iter().map(|c| c[0]).sum::<f64>();
        let total = |q: &[[f64; 2]]| q.iter().map(|q| q[0]).sum::<f64>();
        let heat = [a, b].map(|s| [total(&s.friction), total(&s.tread)]);
        let change = (heat[0][0] - heat[1][0]).abs() + (heat[0][1] - heat[1][1]).abs();
        self.speed_change(other) > JUMP
            || jump(conductance(a), conductance(b))
            || change > SLIGHT_HEAT + JUMP * heat.map(|h| h[0] + h[1]).into_iter().fold(0.0, f64::max)
    }

    /// Whether speeds and conductance differ so little that the operator of the end serves for the whole step.
    fn close(&self, other: &Self) -> bool {
        let (mut change, mut sum) = (0.0, 0.0);
        for (a, b) in self.supply.conductance.iter().zip(&other.supply.conductance) {
            change += (a[0] - b[0]).abs();
            sum += b[0];
        }
        self.speed_change(other) <= SAME_OPERATOR && change <= SAME_OPERATOR * sum
    }

    /// Largest change of a speed relative to the largest speed of its body and of the other one.
    fn speed_change(&self, other: &Self) -> f64 {
        let change = |a: f64, b: f64| if a == b { 0.0 } else { (a - b).abs() / a.abs().max(b.abs()) };
        change(self.velocity, other.velocity).max(change(self.omega, other.omega))
    }

    fn same_operator(&self, other: &Self) -> bool {
        self.velocity == other.velocity
            && self.omega == other.omega
            && self.supply.conductance == other.supply.conductance
    }
}

impl Side {
    /// `∫ k_c Nⱼ w̃ᵢ` on the contact nodes `first..` from the moments of the elements between them.
    fn set_contact(&mut self, moments: &[[f64; 3]], element: usize) {
        self.contact.clear();
        self.contact.resize(moments.len() + 1, [0.0; 3]);
        for (i, c) in moments.iter().enumerate() {
            let sigma = self.transport.upwind_of(element + i, [c[0], c[1]]);
            let (left, right) = (c[0] - c[1], c[1]);
            self.contact[i][1] += left - right + c[2] - sigma * left;
            self.contact[i][2] += right - c[2] - sigma * right;
            self.contact[i + 1][0] += right - c[2] + sigma * left;
            self.contact[i + 1][1] += c[2] + sigma * right;
        }
    }

    /// `factor · ∫ k_c d w̃`, `d` given at the contact nodes.
    fn contact_load(&self, factor: f64, jump: &[f64]) -> Vec<f64> {
        let last = jump.len().saturating_sub(1);
        let row = |(i, c): (usize, &[f64; 3])| {
            let before = if i > 0 { c[0] * jump[i - 1] } else { 0.0 };
            let after = if i < last { c[2] * jump[i + 1] } else { 0.0 };
            factor * (before + c[1] * jump[i] + after)
        };
        self.contact.iter().enumerate().map(row).collect()
    }

    /// Adds `β G C̃` to the coupling matrix.
    fn add_coupling(&self, flow: f64, matrix: &mut DMatrix<f64>) {
        let n = self.contact.len();
        for (j, mut column) in matrix.column_iter_mut().enumerate() {
            let above = if j > 0 { self.contact[j - 1][2] } else { 0.0 };
            let below = if j + 1 < n { self.contact[j + 1][0] } else { 0.0 };
            let (first, last) = (j.saturating_sub(1), (j + 1).min(n - 1));
            for (value, row) in column.iter_mut().zip(self.response.chunks_exact(n)) {
                *value += flow * (above * row[first] + self.contact[j][1] * row[j] + below * row[last]);
            }
        }
    }
}

impl Stage {
    /// Prepares the operators; does nothing where they have not changed.
    fn set(&mut self, heat: &Heat, moment: &Moment, blend: Blend, rate: f64, curved: bool) -> Result<(), HeatError> {
        let same = self.blend == Some(blend) && self.curved == curved && self.moment.same_operator(moment);
        self.moment.clone_from(moment);
        if same {
            return Ok(());
        }
        self.blend = None;
        self.curved = curved;
        let elements = moment.supply.contact();
        self.nodes = if elements.is_empty() { 0..0 } else { elements.start..elements.end + 1 };
        let moments = &self.moment.supply.conductance[elements.clone()];
        for (body, side, speed) in [
            (&heat.wheel, &mut self.wheel, -moment.omega * heat.config.wheel_radius),
            (&heat.rail, &mut self.rail, -moment.velocity),
        ] {
            side.transport.set(&body.line, speed, rate, body.heat_capacity, body.conductivity);
            side.factor.set(body, &side.transport, blend)?;
            if !elements.is_empty() {
                let first = body.line.zone;
                side.set_contact(moments, first + elements.start);
                let range = first + self.nodes.start..first + self.nodes.end;
                side.factor.surface_response(body, range, &mut side.response);
            }
        }
        self.coupling = None;
        if !elements.is_empty() {
            let n = self.nodes.len();
            let mut matrix = DMatrix::identity(n, n);
            self.wheel.add_coupling(blend.flow, &mut matrix);
            self.rail.add_coupling(blend.flow, &mut matrix);
            let factors = matrix.lu();
            if !factors.is_invertible() {
                return Err(HeatError::Singular { unknowns: n });
            }
            self.coupling = Some(factors);
        }
        self.blend = Some(blend);
        Ok(())
    }

    /// Contact nodes counted in a body.
    fn contact_nodes(&self, body: &Body) -> Range<usize> {
        let first = body.line.zone;
        first + self.nodes.start..first + self.nodes.end
    }

    /// Replaces `load` by everything that does not depend on the temperature.
    fn add_loads(&self, heat: &Heat, load: &mut Vec<f64>) {
        let size = heat.wheel.size();
        load.clear();
        load.resize(size + heat.rail.size(), 0.0);
        let (wheel, rail) = load.split_at_mut(size);
        let supply = &self.moment.supply;
        for (body, side, share, sign, out) in [
            (&heat.wheel, &self.wheel, heat.config.wheel_share, -1.0, wheel),
            (&heat.rail, &self.rail, 1.0 - heat.config.wheel_share, 1.0, rail),
        ] {
            let mut surface = vec![0.0; body.line.len()];
            let first = body.line.zone;
            for (e, q) in supply.friction.iter().enumerate() {
                side.transport.add_load(&body.line, first + e, q.map(|q| share * q), &mut surface);
            }
            for (e, q) in supply.reversible.iter().enumerate() {
                side.transport.add_load(&body.line, first + e, q.map(|q| sign * q), &mut surface);
            }
            let air = body.film * supply.ambient;
            if air != 0.0 {
                for (e, h) in body.line.lengths.iter().enumerate() {
                    side.transport.add_load(&body.line, e, [air * h, 0.5 * air * h], &mut surface);
                }
            }
            if body.line.closed > 0.0 {
                for (e, q) in supply.tread.iter().enumerate() {
                    side.transport.add_load(&body.line, e, *q, &mut surface);
                }
            }
            body.add_surface_load(0, &surface, out);
        }
    }

    /// `out ← out + S x` with the exact operator, both bodies one after the other in `x`.
    fn multiply(&mut self, heat: &Heat, blend: Blend, x: &[f64], out: &mut [f64]) {
        let size = heat.wheel.size();
        let (x_wheel, x_rail) = x.split_at(size);
        let (wheel, rail) = out.split_at_mut(size);
        heat.wheel.multiply(&self.wheel.transport, blend, x_wheel, wheel);
        heat.rail.multiply(&self.rail.transport, blend, x_rail, rail);
        if self.curved {
            heat.wheel.add_curvature(blend, x_wheel, wheel, &mut self.wheel.work);
        }
        if self.coupling.is_some() {
            let jump = self.jump(heat, x);
            let load = self.wheel.contact_load(blend.flow, &jump);
            heat.wheel.add_surface_load(self.contact_nodes(&heat.wheel).start, &load, wheel);
            let load = self.rail.contact_load(-blend.flow, &jump);
            heat.rail.add_surface_load(self.contact_nodes(&heat.rail).start, &load, rail);
        }
    }

    /// Temperature of the wheel less that of the rail at the contact nodes.
    fn jump(&mut self, heat: &Heat, x: &[f64]) -> Vec<f64> {
        let (wheel, rail) = x.split_at(heat.wheel.size());
        let (at_wheel, at_rail) = (self.contact_nodes(&heat.wheel), self.contact_nodes(&heat.rail));
        heat.wheel.trace(at_wheel, wheel, &mut self.wheel.trace);
        heat.rail.trace(at_rail, rail, &mut self.rail.trace);
        self.wheel.trace.iter().zip(&self.rail.trace).map(|(a, b)| a - b).collect()
    }

    /// `x ← P⁻¹ x` with the operator of the modal solver.
    fn invert(&mut self, heat: &Heat, x: &mut [f64]) {
        let (Some(blend), size) = (self.blend, heat.wheel.size()) else { return };
        let (wheel, rail) = x.split_at_mut(size);
        self.wheel.factor.solve(&heat.wheel, wheel, 0);
        self.rail.factor.solve(&heat.rail, rail, 0);
        if self.coupling.is_none() {
            return;
        }
        let mut jump = DVector::from_vec(self.jump(heat, x));
        if let Some(coupling) = &self.coupling {
            coupling.solve_mut(&mut jump);
        }
        let (wheel, rail) = x.split_at_mut(size);
        for (body, side, factor, x) in
            [(&heat.wheel, &mut self.wheel, -blend.flow, wheel), (&heat.rail, &mut self.rail, blend.flow, rail)]
        {
            let load = side.contact_load(factor, jump.as_slice());
            side.work.clear();
            side.work.resize(body.size(), 0.0);
            let first = body.line.zone + self.nodes.start;
            body.add_surface_load(first, &load, &mut side.work);
            side.factor.solve(body, &mut side.work, first);
            x.iter_mut().zip(&side.work).for_each(|(x, dx)| *x += dx);
        }
    }

    /// `x ← S⁻¹ x` with the exact operator where it matters; iterations of its correction.
    fn solve(&mut self, heat: &Heat, blend: Blend, x: &mut Vec<f64>) -> Result<usize, HeatError> {
        if !self.curved {
            self.invert(heat, x);
            return Ok(0);
        }
        let tolerance = if blend.storage > 0.0 { STEP_TOLERANCE } else { STATIONARY_TOLERANCE };
        krylov::solve(&mut Exact { stage: self, heat, blend }, x, tolerance, ACCEPTED)
    }

    /// Adds `weight` times the heat flows at the temperatures `x`, changing at the rates `rate`.
    fn add_flows(&mut self, heat: &Heat, x: &[f64], rate: Option<&Vec<f64>>, weight: f64, flows: &mut HeatFlows) {
        let size = heat.wheel.size();
        let supply = &self.moment.supply;
        flows.friction += weight * supply.friction.iter().map(|q| q[0]).sum::<f64>();
        flows.tread += weight * supply.tread.iter().map(|q| q[0]).sum::<f64>();
        if self.coupling.is_some() {
            let jump = self.jump(heat, x);
            let moments = &self.moment.supply.conductance[self.moment.supply.contact()];
            let through = moments.iter().zip(jump.windows(2)).map(|(c, d)| (c[0] - c[1]) * d[0] + c[1] * d[1]);
            let reversible = self.moment.supply.reversible.iter().map(|q| q[0]);
            flows.conduction += weight * (through.sum::<f64>() + reversible.sum::<f64>());
        }
        let share = heat.config.wheel_share;
        flows.to_wheel = share * flows.friction - flows.conduction;
        flows.to_rail = (1.0 - share) * flows.friction + flows.conduction;
        let ambient = self.moment.supply.ambient;
        for (body, side, range) in
            [(&heat.wheel, &mut self.wheel, 0..size), (&heat.rail, &mut self.rail, size..x.len())]
        {
            let (modes, field) = (&body.modes, &x[range.clone()]);
            let [now, change] = &mut side.sums;
            body.integrate(field, now);
            match rate {
                Some(rate) => body.integrate(&rate[range], change),
                None => *change = vec![0.0; modes.len()],
            }
            let mut stored = 0.0;
            let (mut air, mut hub) = (0.0, 0.0);
            for m in 0..modes.len() {
                stored += body.heat_capacity * modes.content[m] * change[m];
                let film = body.film * modes.surface[m] * now[m];
                air += film;
                // Residual of the energy balance tested with 1 at the free nodes: what reaches the fixed ones.
                hub += body.conductivity * modes.values[m] * modes.free[m] * now[m]
                    - film
                    - body.heat_capacity * (modes.content[m] - modes.free[m]) * change[m];
            }
            air -= body.film * ambient * body.line.weights.iter().sum::<f64>();
            let out = side.transport.exit.map_or(0.0, |(node, flux)| {
                let nm = modes.len();
                flux * super::modal::dot(&field[node * nm..(node + 1) * nm], &modes.content)
            });
            if body.line.closed > 0.0 {
                flows.stored_wheel += weight * stored;
                flows.wheel_to_air += weight * air;
                flows.to_hub += if modes.fixed { weight * hub } else { 0.0 };
            } else {
                flows.stored_rail += weight * stored;
                flows.rail_to_air += weight * air;
                flows.outflow += weight * out;
            }
        }
    }
}

/// The exact operator with the modal solver as its preconditioner.
struct Exact<'a> {
    stage: &'a mut Stage,
    heat: &'a Heat,
    blend: Blend,
}

impl System for Exact<'_> {
    fn apply(&mut self, x: &[f64], out: &mut [f64]) {
        out.fill(0.0);
        self.stage.multiply(self.heat, self.blend, x, out);
    }

    fn precondition(&mut self, x: &mut [f64]) {
        self.stage.invert(self.heat, x);
    }
}

#[cfg(test)]
impl Heat {
    /// Stationary surface temperatures `[x, T]` of the rail at the contact nodes under a wheel at uniform temperature.
    pub(super) fn rail_under_uniform_wheel(
        &self,
        velocity: f64,
        exchange: &Exchange,
        wheel: f64,
    ) -> Result<Vec<[f64; 2]>, HeatError> {
        let mut stage = Stage::default();
        let blend = Blend { storage: 0.0, flow: 1.0 };
        stage.set(self, &self.moment(velocity, velocity / self.config.wheel_radius, exchange)?, blend, 0.0, false)?;
        let n = stage.nodes.len();
        let mut matrix = DMatrix::identity(n, n);
        stage.rail.add_coupling(1.0, &mut matrix);
        let gain = &matrix - DMatrix::identity(n, n);
        let mut surface = gain * DVector::from_element(n, wheel);
        matrix.lu().solve_mut(&mut surface);
        let x = &self.zone_x()[stage.nodes.clone()];
        Ok(x.iter().zip(&surface).map(|(&x, &t)| [x, t]).collect())
    }
}
