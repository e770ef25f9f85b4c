//! Load vector of a stage.

use super::loads::SurfaceLoads;
use crate::heat::tensor::mesh::layout::HeatLayout;
use crate::heat::tensor::solve::stage::{BodyOperator, Stage};

/// Adds everything that does not depend on the temperature to `out`.
pub fn add_loads(stage: &mut Stage, layout: &HeatLayout, loads: &SurfaceLoads, out: &mut [f64]) {
    let [wheel, rail] = layout.split_mut(out);
    let share = layout.config.thermal.wheel_share;
    let bodies = [
        (&layout.wheel, &mut stage.wheel, share, -1.0, wheel),
        (&layout.rail, &mut stage.rail, 1.0 - share, 1.0, rail),
    ];
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
