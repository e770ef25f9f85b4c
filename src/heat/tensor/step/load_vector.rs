//! Load vector of a stage.

use super::loads::SurfaceLoads;
use crate::heat::tensor::mesh::layout::HeatLayout;
use crate::heat::tensor::solve::operators::StageOperators;
use crate::heat::tensor::solve::stage::LineField;
use crate::heat::tensor::solve::transport::bearing;

/// Adds everything that does not depend on the temperature of a line to `out`.
pub fn add_loads(stage: &StageOperators, layout: &HeatLayout, loads: &SurfaceLoads, (line, out): LineField) {
    let [wheel, rail] = layout.split_mut(out);
    let [of_wheel, of_rail] = &mut line.sides;
    let share = layout.config.thermal.wheel_share;
    let bodies = [
        (&layout.wheel, &stage.wheel.transport, &mut of_wheel.load, share, -1.0, wheel),
        (&layout.rail, &stage.rail.transport, &mut of_rail.load, 1.0 - share, 1.0, rail),
    ];
    for ((body, transport, surface, share, sign, out), radiation) in bodies.into_iter().zip(&loads.radiation) {
        surface.clear();
        surface.resize(body.streamline.len(), 0.0);
        let first = body.streamline.zone;
        for (e, q) in bearing(&loads.friction) {
            let share = share * loads.friction_share;
            transport.add_load(&body.streamline, first + e, [share * q[0], share * q[1]], surface);
        }
        for (e, q) in bearing(&loads.reversible) {
            let q = [sign * q[0], sign * q[1]];
            transport.add_conducted(&body.streamline, first + e, q, loads.conductance[e], surface);
        }
        body.add_surface_load(0, surface, out);
        if let Some((node, stream)) = transport.entry
            && loads.arriving != 0.0
        {
            body.add_load(node, &[stream * loads.arriving], &body.modes.content, out);
        }
        if body.streamline.closed > 0.0 {
            loads.sources.add(layout, transport, surface, out);
        }
        if !radiation.load.is_empty() {
            surface.fill(0.0);
            for (e, h) in body.streamline.lengths.iter().enumerate() {
                transport.add_load(&body.streamline, e, [*h, 0.5 * h], surface);
            }
            body.add_load(0, surface, &radiation.load, out);
        }
    }
}
