//! The matrix of an implicit stage: applied exactly, inverted mode by mode, coupled through the contact.

use super::coupling::{Conduction, ContactBands, Coupling};
use super::inverse::{InverseKey, Inverses};
use super::layout::Heat;
use super::loads::SurfaceLoads;
use super::modal::{HeatBody, StageCoefficients};
use super::streamline::Transport;
use crate::heat::error::HeatError;
use crate::linalg::Update;
use crate::linalg::gmres::{Gmres, LinearSystem};
use std::ops::Range;

/// Angular velocity [rad/s] below which, and step [s] from which on, conduction along the streamlines is computed exactly.
///
/// The direct solver works mode by mode. For that it replaces the factor `1/r` of conduction around the wheel by `r/r_o²`,
/// which is right at the tread. In a wheel that turns, the stream outweighs conduction around it, and nothing is lost. In
/// a standing wheel heat spreads around the hub, too, and an iteration (GMRES) corrects the solution; short steps do not
/// need it, since heat does not come far. Measured without correction, relative: faster rolling 1e-6 in all stationary
/// temperatures; locked wheel 4e-5 in the maxima and 2e-3 in the wheel's mean after 10 s (stationary 5e-4 and 8e-2).
pub(super) const CURVED_BELOW: f64 = 1.0;
pub(super) const CURVED_STEP: f64 = 0.01;

/// Relative residual of the exact operator at which its correction stops, in steps and in the stationary state, and at
/// which it is accepted where round-off stops it. In steps the heat balance holds at any residual: what the modal solver
/// leaves out moves heat along the streamlines only.
const STEP_TOLERANCE: f64 = 1e-10;
const STATIONARY_TOLERANCE: f64 = 1e-13;
const ACCEPTED: f64 = 1e-9;

/// Stream, factors and coupling matrices of one body, and its buffers.
#[derive(Clone, Debug, Default)]
pub(super) struct BodyOperator {
    pub(super) transport: Transport,
    /// Conduction alone; set where steel melts.
    still: Transport,
    pub(super) inverses: Inverses,
    /// Conductance on the contact nodes: of the present stream, and of that of the inverse.
    contact: ContactBands,
    inverted: ContactBands,
    /// Buffer of a field.
    work: Vec<f64>,
    /// Surface temperatures at the contact nodes.
    trace: Vec<f64>,
    /// Load at surface nodes.
    load: Vec<f64>,
    /// Field and its rate, summed along the streamlines.
    pub(super) sums: [Vec<f64>; 2],
}

/// Speeds and coefficients that the matrices of a stage belong to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct StageKey {
    /// Velocity of the wheel's centre [m/s] and angular velocity [rad/s].
    pub speeds: [f64; 2],
    /// The same of the matrix that is inverted.
    pub inverted: [f64; 2],
    /// Weights of storage and flow.
    pub coefficients: StageCoefficients,
    /// Inverse of the step that upwinding sees [1/s].
    pub rate: f64,
    /// Whether conduction along the streamlines of the wheel is exact.
    pub curved: bool,
}

/// Everything needed to apply and to invert the matrix of an implicit stage.
#[derive(Default)]
pub(super) struct Stage {
    /// What the operators below were made for; `None`: there are none.
    key: Option<StageKey>,
    conductance: Vec<[f64; 3]>,
    pub(super) wheel: BodyOperator,
    pub(super) rail: BodyOperator,
    /// Contact elements and nodes, counted from the first of the zone.
    pub(super) elements: Range<usize>,
    nodes: Range<usize>,
    /// `1 + β (G_wheel C̃_wheel + G_rail C̃_rail)`: what conduction through the contact leaves of a temperature difference.
    coupling: Coupling,
    /// Temperature of the wheel less that of the rail at the contact nodes, of the field that was multiplied last.
    pub(super) jump: Vec<f64>,
    /// The same of the field that was solved for last: the rate of the jump.
    pub(super) growth: Vec<f64>,
    gmres: Gmres,
}

impl Stage {
    /// Prepares the operators; does nothing where they have not changed.
    pub fn set(&mut self, heat: &Heat, loads: &SurfaceLoads, key: StageKey) -> Result<(), HeatError> {
        if self.key == Some(key) && self.conductance == loads.conductance {
            return Ok(());
        }
        self.key = None;
        self.conductance.clone_from(&loads.conductance);
        self.elements = loads.contact();
        self.nodes = if self.elements.is_empty() { 0..0 } else { self.elements.start..self.elements.end + 1 };
        let StageKey { speeds, inverted, coefficients, rate, .. } = key;
        let radius = heat.config.wheel.radius;
        let streams = |[velocity, omega]: [f64; 2]| [-omega * radius, -velocity];
        let (present, shared) = (streams(speeds), streams(inverted));
        let keys = [(&heat.wheel, shared[0]), (&heat.rail, shared[1])].map(|(body, speed)| InverseKey {
            speed,
            coefficients,
            rate,
            nodes: self.contact_nodes(body),
        });
        let moments = &self.conductance[self.elements.clone()];
        let bodies = [(&heat.wheel, &mut self.wheel), (&heat.rail, &mut self.rail)];
        for (((body, operator), speed), key) in bodies.into_iter().zip(present).zip(&keys) {
            operator.transport.set(&body.line, speed, rate, body.heat_capacity, body.conductivity);
            operator.inverses.set(body, key)?;
            if !moments.is_empty() {
                operator.contact.set(moments, &operator.transport.upwind[key.nodes.start..]);
                operator.inverted.set(moments, &operator.inverses.present().upwind);
            }
        }
        if !moments.is_empty() {
            self.set_coupling(heat, keys, heat.even_conductance())?;
        }
        self.key = Some(key);
        Ok(())
    }

    /// Prepares conduction through the contact between the present inverses; `even` is the conductance of all places.
    fn set_coupling(&mut self, heat: &Heat, keys: [InverseKey; 2], even: Option<f64>) -> Result<(), HeatError> {
        let conduction = Conduction {
            moments: &self.conductance[self.elements.clone()],
            lengths: &heat.wheel.line.lengths[keys[0].nodes.start..keys[0].nodes.end - 1],
            even,
            flow: keys[0].coefficients.flow,
            sides: [&self.wheel, &self.rail].map(|body| (body.inverses.present(), &body.inverted)),
        };
        self.coupling.set(keys, &conduction)
    }

    /// Whether heat is conducted through the contact.
    pub(super) fn coupled(&self) -> bool {
        !self.nodes.is_empty()
    }

    /// Contact nodes counted in a body.
    fn contact_nodes(&self, body: &HeatBody) -> Range<usize> {
        let first = body.line.zone;
        first + self.nodes.start..first + self.nodes.end
    }

    /// Adds everything that does not depend on the temperature to `load`.
    pub fn add_loads(&mut self, heat: &Heat, loads: &SurfaceLoads, load: &mut [f64]) {
        let (wheel, rail) = load.split_at_mut(heat.wheel.size());
        let share = heat.config.thermal.wheel_share;
        let bodies =
            [(&heat.wheel, &mut self.wheel, share, -1.0, wheel), (&heat.rail, &mut self.rail, 1.0 - share, 1.0, rail)];
        for ((body, operator, share, sign, out), radiation) in bodies.into_iter().zip(&loads.radiation) {
            let BodyOperator { transport, load: surface, .. } = operator;
            surface.clear();
            surface.resize(body.line.len(), 0.0);
            let first = body.line.zone;
            for (e, q) in loads.friction.iter().enumerate() {
                transport.add_load(&body.line, first + e, q.map(|q| share * loads.friction_share * q), surface);
            }
            for (e, (q, conductance)) in loads.reversible.iter().zip(&loads.conductance).enumerate() {
                transport.add_conducted(&body.line, first + e, q.map(|q| sign * q), *conductance, surface);
            }
            body.add_surface_load(0, surface, out);
            if let Some((node, stream)) = transport.entry
                && loads.arriving != 0.0
            {
                body.add_load(node, &[stream * loads.arriving], &body.modes.content, out);
            }
            if body.line.closed > 0.0 && !loads.tread.is_empty() {
                surface.fill(0.0);
                for (e, q) in loads.tread.iter().enumerate() {
                    transport.add_load(&body.line, e, *q, surface);
                }
                body.add_load(0, surface, &body.modes.block, out);
            }
            if !radiation.load.is_empty() {
                surface.fill(0.0);
                for (e, h) in body.line.lengths.iter().enumerate() {
                    transport.add_load(&body.line, e, [*h, 0.5 * h], surface);
                }
                body.add_load(0, surface, &radiation.load, out);
            }
        }
    }

    /// `out ← S x` with the exact operator, both bodies one after the other in `x`.
    pub fn multiply(&mut self, heat: &Heat, coefficients: StageCoefficients, x: &[f64], out: &mut [f64]) {
        let (x_wheel, x_rail) = x.split_at(heat.wheel.size());
        let (wheel, rail) = out.split_at_mut(heat.wheel.size());
        heat.wheel.multiply(&self.wheel.transport, coefficients, x_wheel, wheel, Update::Replace);
        heat.rail.multiply(&self.rail.transport, coefficients, x_rail, rail, Update::Replace);
        self.add_conduction(heat, coefficients, x, out);
    }

    /// Prepares [`Self::multiply_still`] for the present operators.
    pub fn set_still(&mut self, heat: &Heat) {
        for (body, operator) in [(&heat.wheel, &mut self.wheel), (&heat.rail, &mut self.rail)] {
            operator.still.set_still(&operator.transport, &body.line, body.conductivity);
        }
    }

    /// `out ← out + S x` without what the stream carries.
    pub fn multiply_still(&mut self, heat: &Heat, coefficients: StageCoefficients, x: &[f64], out: &mut [f64]) {
        let (x_wheel, x_rail) = x.split_at(heat.wheel.size());
        let (wheel, rail) = out.split_at_mut(heat.wheel.size());
        heat.wheel.multiply(&self.wheel.still, coefficients, x_wheel, wheel, Update::Add);
        heat.rail.multiply(&self.rail.still, coefficients, x_rail, rail, Update::Add);
        self.add_conduction(heat, coefficients, x, out);
    }

    /// Adds what is no part of the modal solver: exact conduction along the streamlines, and that through the contact.
    fn add_conduction(&mut self, heat: &Heat, coefficients: StageCoefficients, x: &[f64], out: &mut [f64]) {
        let x_wheel = &x[..heat.wheel.size()];
        let (wheel, rail) = out.split_at_mut(heat.wheel.size());
        if self.key.is_some_and(|key| key.curved) {
            heat.wheel.add_curvature(coefficients, x_wheel, wheel, &mut self.wheel.work);
        }
        if self.coupled() {
            self.set_jump(heat, x);
            for (body, operator, factor, out) in [
                (&heat.wheel, &mut self.wheel, coefficients.flow, wheel),
                (&heat.rail, &mut self.rail, -coefficients.flow, rail),
            ] {
                operator.contact.set_load(factor, &self.jump, &mut operator.load);
                body.add_surface_load(body.line.zone + self.nodes.start, &operator.load, out);
            }
        }
    }

    /// Fills [`Self::jump`] for the field `x`.
    pub(super) fn set_jump(&mut self, heat: &Heat, x: &[f64]) {
        let (wheel, rail) = x.split_at(heat.wheel.size());
        let (at_wheel, at_rail) = (self.contact_nodes(&heat.wheel), self.contact_nodes(&heat.rail));
        heat.wheel.trace(at_wheel, wheel, &mut self.wheel.trace);
        heat.rail.trace(at_rail, rail, &mut self.rail.trace);
        self.jump.clear();
        self.jump.extend(self.wheel.trace.iter().zip(&self.rail.trace).map(|(a, b)| a - b));
    }

    /// The same for `x` and `ahead` times its rate, which a stage from `x` has just been solved for.
    pub(super) fn set_jump_ahead(&mut self, heat: &Heat, x: &[f64], rate: Option<&[f64]>, ahead: f64) {
        let Some(rate) = rate.filter(|_| ahead != 0.0) else { return self.set_jump(heat, x) };
        // The modal solver leaves both; an iteration around it does not.
        if self.key.is_some_and(|key| key.curved) {
            self.set_jump(heat, rate);
            std::mem::swap(&mut self.jump, &mut self.growth);
            self.set_jump(heat, x);
        }
        self.jump.iter_mut().zip(&self.growth).for_each(|(jump, growth)| *jump += ahead * growth);
    }

    /// `x ← P⁻¹ x` with the operator of the modal solver.
    fn invert(&mut self, heat: &Heat, x: &mut [f64]) {
        let (Some(StageKey { coefficients, .. }), size) = (self.key, heat.wheel.size()) else { return };
        let nodes = [&heat.wheel, &heat.rail].map(|body| self.contact_nodes(body));
        let coupled = self.coupled();
        let (wheel, rail) = x.split_at_mut(size);
        let bodies = [(&heat.wheel, &mut self.wheel, wheel), (&heat.rail, &mut self.rail, rail)];
        for ((body, operator, x), nodes) in bodies.into_iter().zip(&nodes) {
            let BodyOperator { inverses, trace, .. } = operator;
            let factor = inverses.factor();
            factor.eliminate(body, x);
            if coupled {
                factor.trace(body, nodes, x, trace);
            }
        }
        if coupled {
            self.growth.clear();
            self.growth.extend(self.wheel.trace.iter().zip(&self.rail.trace).map(|(a, b)| a - b));
            self.coupling.solve(&mut self.growth);
        }
        let (wheel, rail) = x.split_at_mut(size);
        let bodies = [
            (&heat.wheel, &mut self.wheel, -coefficients.flow, wheel),
            (&heat.rail, &mut self.rail, coefficients.flow, rail),
        ];
        for ((body, operator, flow, x), nodes) in bodies.into_iter().zip(&nodes) {
            if coupled {
                operator.inverted.set_load(flow, &self.growth, &mut operator.load);
            }
            let factor = operator.inverses.factor();
            if coupled {
                factor.add_eliminated(body, nodes, &operator.load, x);
            }
            factor.substitute(body, x);
        }
    }

    /// `x ← S⁻¹ x` with the exact operator where it matters; iterations of its correction.
    pub fn solve(&mut self, heat: &Heat, coefficients: StageCoefficients, x: &mut [f64]) -> Result<usize, HeatError> {
        if !self.key.is_some_and(|key| key.curved) {
            self.invert(heat, x);
            return Ok(0);
        }
        let tolerance = if coefficients.storage > 0.0 { STEP_TOLERANCE } else { STATIONARY_TOLERANCE };
        let mut gmres = std::mem::take(&mut self.gmres);
        let solved = gmres.solve(&mut Exact { stage: self, heat, coefficients }, x, tolerance, ACCEPTED);
        self.gmres = gmres;
        solved.map_err(|stopped| HeatError::NotConverged {
            residual: stopped.residual,
            iterations: stopped.iterations,
            direct_below: CURVED_STEP,
        })
    }
}

/// The exact operator with the modal solver as its preconditioner.
struct Exact<'a> {
    stage: &'a mut Stage,
    heat: &'a Heat,
    coefficients: StageCoefficients,
}

impl LinearSystem for Exact<'_> {
    fn apply(&mut self, x: &[f64], out: &mut [f64]) {
        self.stage.multiply(self.heat, self.coefficients, x, out);
    }

    fn precondition(&mut self, x: &mut [f64]) {
        self.stage.invert(self.heat, x);
    }
}

#[cfg(test)]
impl Stage {
    /// What conduction through the contact leaves of `jump`, by kept factors where it is `even`, else by those of the matrix itself.
    pub fn left_of(&mut self, heat: &Heat, even: Option<f64>, jump: &[f64]) -> Vec<f64> {
        let key = |operator: &BodyOperator| operator.inverses.key().clone();
        let keys = [key(&self.wheel), key(&self.rail)];
        self.set_coupling(heat, keys, even).unwrap();
        assert_eq!(self.coupling.is_kept(), even.is_some());
        let mut left = jump.to_vec();
        self.coupling.solve(&mut left);
        left
    }

    /// Surface temperatures of the rail at the contact nodes under a wheel at a uniform temperature; the nodes.
    pub fn rail_under_uniform_wheel(&mut self, wheel: f64) -> (Range<usize>, Vec<f64>) {
        let n = self.nodes.len();
        let (mut matrix, mut surface) = (crate::linalg::DenseSystem::default(), vec![0.0; n]);
        matrix.reset(n);
        for (i, gain) in surface.iter_mut().enumerate() {
            let row = matrix.row(i).0;
            self.rail.inverted.add_coupling(1.0, self.rail.inverses.present().response.row(i), row);
            *gain = wheel * row.iter().sum::<f64>();
            row[i] += 1.0;
        }
        assert!(matrix.factorise() && matrix.solve_with(&mut surface));
        (self.nodes.clone(), surface)
    }
}
