//! Stationary temperatures at constant speeds and exchange.

use super::bounds::{data, search};
use super::flows::StageEnd;
use super::limiter::keep_bounds;
use super::load_vector::{add_others, add_surface_loads, set_surface_loads};
use super::loads::SurfaceLoads;
use crate::heat::error::HeatError;
use crate::heat::exchange::{Exchange, HeatSource};
use crate::heat::flows::HeatFlows;
use crate::heat::limits::check_speeds;
use crate::heat::state::HeatState;
use crate::heat::tensor::heat::Heat;
use crate::heat::tensor::mesh::kernels::dot;
use crate::heat::tensor::mesh::layout::HeatLayout;
use crate::heat::tensor::solve::coefficients::StageCoefficients;
use crate::heat::tensor::solve::line_conduction::{LineConduction, contact_nodes};
use crate::heat::tensor::solve::operators::StageKey;
use crate::heat::tensor::solve::stage::Stage;
use std::f64::consts::PI;

/// Storage that keeps the preconditioner of the stationary state regular, relative to `κ/r_o²` [1].
const REGULARISATION: f64 = 1e-3;

/// Speed of a surface below which nothing carries heat away and no stationary temperatures exist [m/s].
const AT_REST: f64 = 1e-3;

/// Stationary temperatures of the heat of `exchange`, before the limiter.
pub fn stationary(heat: &Heat, speeds: [f64; 2], exchange: &Exchange) -> Result<(HeatState, HeatFlows), HeatError> {
    let layout = &heat.layout;
    let mut loads = SurfaceLoads::default();
    let (mut stage, mut line, mut field, _) = prepared(heat, speeds, exchange, &mut loads, true)?;
    let exact = StageCoefficients { storage: 0.0, flow: 1.0 };
    let solved = stage.solve(layout, exact, (&mut line, &mut field));
    let iterations = solved.map_err(|error| match error {
        HeatError::NotConverged { residual, iterations, .. } => HeatError::NoStationaryState { residual, iterations },
        other => other,
    })?;
    let mut flows = HeatFlows { iterations, ..HeatFlows::default() };
    line.set_sums(layout, &field);
    let ends = StageEnd { temperature: &field, content: &field, rate: None, ahead: 0.0 };
    line.add_flows(&stage.operators, layout, &loads, &ends, 1.0, &mut flows);
    if !flows.is_finite() {
        return Err(not_finite(speeds));
    }
    let (last, arriving) = (Some(loads.boundary(speeds)), loads.arriving);
    let mut state = HeatState { values: field, last, arriving, ..HeatState::default() };
    state.data = data(layout, &state, exchange);
    state.range = layout.extremes(&state.values);
    Ok((state, flows))
}

/// Temperatures after long rolling: those of the heat of `exchange`, over a wheel at the temperature `wheel` \[K] on a
/// rail at that of the arriving one, with the heat that these two exchange in passing.
pub fn after_long_rolling(
    heat: &Heat,
    speeds: [f64; 2],
    exchange: &Exchange,
    wheel: f64,
) -> Result<(HeatState, HeatFlows), HeatError> {
    let (rail, layout) = (exchange.arriving, &heat.layout);
    let mut parts = vec![heat.uniform(wheel, rail)];
    let moving = [speeds[0], speeds[1] * layout.config.radius].map(|speed| speed.abs() > AT_REST);
    if moving == [false; 2] {
        return Ok((superposed(layout, &parts)?, HeatFlows::default()));
    }
    // The temperature of the arriving rail belongs to the uniform bodies, not to the stationary heat.
    let (heated, flows) = stationary(heat, speeds, &Exchange { arriving: 0.0, ..exchange.clone() })?;
    // Where one of both surfaces stays, it warms or cools for ever.
    let excess = wheel - rail;
    if moving == [true; 2] && excess != 0.0 && !exchange.patches.is_empty() {
        parts.push(passing(heat, speeds, exchange, excess)?);
    }
    // The exchange between the bodies keeps their bounds by itself; heat comes on top.
    let warm = superposed(layout, &parts)?;
    Ok((superposed(layout, &[warm, heated])?, flows))
}

/// Temperatures that a wheel loses and the rail gains where they touch, as after many turns, if the mean temperature of
/// the tread is `tread` \[K]; of `exchange` only patches count.
///
/// They are the stationary state of a wheel that is kept warm by even heat on its tread, less the mean along every
/// streamline of the wheel, which changes within minutes. The modal solver is exact enough for it: its error acts on
/// the mean.
fn passing(heat: &Heat, speeds: [f64; 2], exchange: &Exchange, tread: f64) -> Result<HeatState, HeatError> {
    let layout = &heat.layout;
    let even = Exchange {
        patches: exchange.patches.clone(),
        sources: vec![HeatSource::on_tread(0.0, 2.0 * PI, 1.0)],
        ..Exchange::default()
    };
    let mut loads = SurfaceLoads::default();
    let (mut stage, mut line, mut field, coefficients) = prepared(heat, speeds, &even, &mut loads, false)?;
    stage.solve(layout, coefficients, (&mut line, &mut field))?;
    let (body, mut mean) = (&layout.wheel, Vec::new());
    let [wheel, _] = layout.split_mut(&mut field);
    body.integrate(wheel, &mut mean);
    mean.iter_mut().for_each(|sum| *sum /= body.streamline.closed);
    for row in wheel.chunks_exact_mut(body.modes.len()) {
        row.iter_mut().zip(&mean).for_each(|(value, mean)| *value -= mean);
    }
    let scale = tread / dot(&mean, &body.modes.surface);
    field.iter_mut().for_each(|value| *value *= scale);
    if !field.iter().all(|value| value.is_finite()) {
        return Err(not_finite(speeds));
    }
    let range = layout.extremes(&field);
    Ok(HeatState { values: field, range, ..HeatState::default() })
}

/// Equations of the stationary state under `exchange` with their right-hand side, and the coefficients of the matrix
/// that is inverted; `curved`: conduction along the streamlines of the wheel is exact.
fn prepared(
    heat: &Heat,
    speeds: [f64; 2],
    exchange: &Exchange,
    loads: &mut SurfaceLoads,
    curved: bool,
) -> Result<(Stage, LineConduction, Vec<f64>, StageCoefficients), HeatError> {
    check_speeds(speeds)?;
    let (layout, mut stage, mut line) = (&heat.layout, Stage::default(), LineConduction::default());
    loads.set(layout, exchange, heat.content(exchange.arriving))?;
    let storage = REGULARISATION * layout.config.diffusivity() / layout.config.radius.powi(2);
    let coefficients = StageCoefficients { storage, flow: 1.0 };
    let contact = contact_nodes(&loads.conductance);
    let key = StageKey { speeds, inverted: speeds, coefficients, rate: 0.0, curved, contact };
    let operators = &mut stage.operators;
    operators.set(layout, key)?;
    line.set(operators, layout, &loads.conductance)?;
    let mut field = vec![0.0; layout.size()];
    set_surface_loads(operators, layout, loads, &mut line);
    add_surface_loads(layout, (&mut line, &mut field));
    add_others(operators, layout, loads, (&mut line, &mut field));
    Ok((stage, line, field, coefficients))
}

fn not_finite([velocity, omega]: [f64; 2]) -> HeatError {
    HeatError::NotFinite { dt: f64::INFINITY, velocity, omega }
}

/// Sum of temperature fields that hold at the same time, as if no step had led to it. Only the sum has to keep the
/// bounds: the loss of a wheel in passing is far below its datum, and the bounds of the parts say little about it.
fn superposed(layout: &HeatLayout, parts: &[HeatState]) -> Result<HeatState, HeatError> {
    let mut sum = HeatState::new(vec![0.0; layout.size()]);
    for part in parts {
        sum.values.iter_mut().zip(&part.values).for_each(|(sum, value)| *sum += value);
        sum.arriving += part.arriving;
        sum.data = [0, 1].map(|end| sum.data[end] + part.data[end]);
    }
    bounded(layout, sum)
}

/// A state found without a step, with its extremes and within its bounds.
pub fn bounded(layout: &HeatLayout, mut state: HeatState) -> Result<HeatState, HeatError> {
    search(layout, &mut state);
    keep_bounds(layout, &mut state, &mut Vec::new())?;
    Ok(state)
}
