//! Loads of a stage: everything that does not depend on the temperature of a line.

use super::loads::SurfaceLoads;
use crate::heat::tensor::mesh::layout::HeatLayout;
use crate::heat::tensor::solve::line_conduction::LineConduction;
use crate::heat::tensor::solve::operators::StageOperators;
use crate::heat::tensor::solve::stage::LineField;
use crate::heat::tensor::solve::transport::bearing;

/// Replaces the surface loads of a line by those of friction and of reversible temperatures.
pub fn set_surface_loads(stage: &StageOperators, layout: &HeatLayout, loads: &SurfaceLoads, line: &mut LineConduction) {
    let share = layout.config.wheel_share;
    let bodies = layout.bodies().into_iter().zip(stage.bodies()).zip(&mut line.sides);
    for (((body, operator), side), (share, sign)) in bodies.zip([(share, -1.0), (1.0 - share, 1.0)]) {
        let (transport, first, share) = (&operator.transport, body.streamline.zone, share * loads.friction_share);
        side.surface.clear();
        side.surface.resize(body.streamline.len(), 0.0);
        for (e, q) in bearing(&loads.friction) {
            transport.add_load(&body.streamline, first + e, [share * q[0], share * q[1]], &mut side.surface);
        }
        for (e, q) in bearing(&loads.reversible) {
            let (q, conductance) = ([sign * q[0], sign * q[1]], loads.conductance[e]);
            transport.add_conducted(&body.streamline, first + e, q, conductance, &mut side.surface);
        }
    }
}

/// Adds the surface loads of a line to `out`.
pub fn add_surface_loads(layout: &HeatLayout, (line, out): LineField) {
    for ((body, side), out) in layout.bodies().into_iter().zip(&line.sides).zip(layout.split_mut(out)) {
        body.add_surface_load(0, &side.surface, out);
    }
}

/// Test that a line has other loads than those of [`set_surface_loads`].
pub fn has_others(loads: &SurfaceLoads) -> bool {
    loads.arriving != 0.0 || !loads.sources.is_empty()
}

/// Adds these other loads to `out`: heat that enters with the rail, and sources.
pub fn add_others(stage: &StageOperators, layout: &HeatLayout, loads: &SurfaceLoads, (line, out): LineField) {
    let bodies = layout.bodies().into_iter().zip(stage.bodies()).zip(&mut line.sides).zip(layout.split_mut(out));
    for (((body, operator), side), out) in bodies {
        let (transport, along) = (&operator.transport, &mut side.load);
        if let Some((node, stream)) = transport.entry
            && loads.arriving != 0.0
        {
            body.add_load(node, &[stream * loads.arriving], &body.modes.content, out);
        }
        along.resize(body.streamline.len(), 0.0);
        if body.streamline.closed > 0.0 {
            loads.sources.add(layout, transport, along, out);
        }
    }
}
