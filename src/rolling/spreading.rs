//! Heat that spreads from line to line of a patch.
//!
//! Within a passage lines do not exchange heat: it goes 0.1 mm while a line is millimetres wide. Within a second it
//! evens out over the patch, so that what has gone deep is the same under all lines. Into the bodies beside the patch
//! it spreads as that of a contact of this width does, by the sections of the heat model. Between patches with a gap it
//! has the way from line to line, and steel in the gap stores none of it.

use super::error::StepError;
use super::line::Line;
use super::model::RollingModel;
use super::state::State;
use crate::heat::{HeatState, LateralCells};
use crate::material::Isotropic;

/// Lets the heat of a step of `dt` seconds from `state` to `next` spread between the lines.
pub fn spread(model: &RollingModel, state: &State, dt: f64, next: &mut State) -> Result<(), StepError> {
    next.spreading.clone_from(&state.spreading);
    if next.lines.len() < 2 || model.thermal.is_none() {
        return Ok(());
    }
    // Fields belong to z/b: cells are those of the nominal patch, and a wider patch evens out more slowly.
    let (nominal, covered, symmetric) = (model.patch_width, next.covered(), model.contact.patch.symmetric);
    let in_the_middle = |k: usize, line: &Line| k == 0 && symmetric && line.layout.ordinate == 0.0;
    let width = |(k, line): (usize, &Line)| {
        let of_pair = if symmetric && !in_the_middle(k, line) { 0.5 } else { 1.0 };
        of_pair * nominal * line.layout.share / covered
    };
    let widths: Vec<f64> = next.lines.iter().enumerate().map(width).collect();
    let cells = match in_the_middle(0, &next.lines[0]) {
        true => LateralCells::half(&widths, &[])?,
        false => LateralCells::side_by_side(&widths)?.apart(&model.contact.patch.gaps(next.motion.pose.lateral)),
    };
    let diffusivity = model.narrowing(next).powi(2) * Isotropic::from(&model.config.material).diffusivity();
    let hottest = next.lines.iter().map(Line::hottest);
    let [coolest, hottest] =
        hottest.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], t| [low.min(t), high.max(t)]);
    let Some(mixing) = next.spreading.advance(dt, &cells, hottest - coolest, diffusivity) else { return Ok(()) };
    let mut fields: Vec<&mut HeatState> =
        next.lines.iter_mut().filter_map(|line| line.thermal.as_mut()).map(|thermal| &mut thermal.fields).collect();
    Ok(mixing.apply(&mut fields)?)
}
