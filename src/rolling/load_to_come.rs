//! Load for which the lines of a patch are laid out at first in a step.

use super::contact_step::ContactStep;
use super::line::Line;
use super::patch_lines::PatchLines;
use crate::contact::RigidMotion;

/// Largest factor by which a load is expected to grow or fall.
const LARGEST_RISE: f64 = 2.0;
/// Load over that of the approach of free bodies and over the nominal one, below which the former tells what is to come \[1].
const FAINT: f64 = 0.1;
/// Difference of a stationary load from that of the layout, over the latter, that is none \[1].
const SETTLED: f64 = 2e-5;
/// Largest load that is expected of a landing, over the nominal one \[1]: in long steps free bodies fall any distance.
const BLOW: f64 = 10.0;

/// Load \[N] that is expected at the end of a step from the lines `start`, which carry the load `before` \[N], given
/// the `nominal` one \[N]; `width` \[m] is that of the bodies.
///
/// It goes on as in the step before. Where there is next to none it becomes
/// that of the approach with which the bodies would end without contact forces: lines that are laid out for far less are
/// pushed up by their own pressures, and have no solution.
pub fn expected(
    patch: &PatchLines,
    step: &ContactStep,
    start: &[Line],
    [before, nominal]: [f64; 2],
    width: f64,
) -> f64 {
    let going_on = match before > 0.0 {
        true => (before + width * step.rise).clamp(before / LARGEST_RISE, before * LARGEST_RISE),
        // Lines without forces have been laid out for those that are expected.
        false => patch.load_laid_out(start),
    };
    if step.time.is_stationary() {
        // Where lateral forces carry a part of the load, it and the layout would follow each other for ever over the least step of
        // these forces, in which a node lets go.
        let laid_out = patch.load_laid_out(start);
        let same = step.drift.rise != 0.0 && (before - laid_out).abs() < SETTLED * laid_out;
        return if same { laid_out } else { going_on };
    }
    let met = patch.load_under(free_approach(step, start)).min(BLOW * nominal);
    if before < FAINT * met.min(nominal) { going_on.max(met) } else { going_on }
}

/// Distance \[m] by which the bodies overlap in the middle at the end of a step without contact forces.
fn free_approach(step: &ContactStep, start: &[Line]) -> f64 {
    let RigidMotion { gain, offset, inertia, momentum, .. } = step.rigid.height;
    let falling = |load: f64| ((load - momentum) / inertia - offset) / gain;
    let height = step.rigid.height.target().or_else(|| step.rigid.height.drive.loads().map(|[load, _]| falling(load)));
    let [wheel, rail] = step.free.each_ref().map(|free| free.surface[(free.surface.len() / 4) * 2 + 1]);
    let growth = start.first().map_or(0.0, |line| line.deformation().radius_growth);
    step.elevation + growth + rail - wheel - height.unwrap_or(0.0)
}
