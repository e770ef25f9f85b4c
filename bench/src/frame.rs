//! Picture of a run at one time for the page: a row of numbers, and the description of that row.

use crate::patch_map::{GridSize, PatchMap, QUANTITIES};
use crate::rail::Condition;
use crate::record::COLUMNS;
use crate::run::Run;
use crate::settings::Patch;
use serde_json::{Value, json};
use wheelrail::simulation::PROFILE_POINTS;

/// Numbers that are not in the table of the run, in this order, after those that are.
const STATUS: [&str; 11] =
    ["time", "torque_set", "load_set", "locked", "held", "angle", "stretches", "x_low", "x_high", "z_low", "z_high"];
/// Most stretches of rail in a frame, the one under the wheel included.
const STRETCHES: usize = 4;
/// Places of the patch along the rail, and across it where it is not of constant width.
const ALONG: usize = 121;
const ACROSS: usize = 61;
/// Room around the patch, over its half-length and width \[1].
const ROOM: [f64; 2] = [0.35, 0.05];

/// Ends of the picture of a patch, which grow with it and do not shrink \[m].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Window {
    /// Along the rail.
    pub x: f64,
    /// Across it: low, high.
    pub z: [f64; 2],
}

/// Size of the grid of a patch.
pub fn grid(patch: Patch) -> GridSize {
    GridSize { along: ALONG, across: if patch == Patch::Line { 1 } else { ACROSS } }
}

/// Description of a frame as JSON.
pub fn description(patch: Patch) -> Value {
    let GridSize { along, across } = grid(patch);
    json!({
        "columns": COLUMNS.as_slice(),
        "status": STATUS,
        "stretches": STRETCHES,
        "conditions": Condition::ALL.map(Condition::name),
        "map": {"along": along, "across": across, "quantities": QUANTITIES, "outline": ["rear", "front"]},
        "depth": {"points": PROFILE_POINTS, "quantities": ["depth", "wheel", "rail"]},
    })
}

/// Appends the frame of a run: the columns of its table, [`STATUS`], stretches of rail as pairs of the distance from the
/// wheel \[m] and the number of the condition, the map of the patch and its outline, and the temperatures over the depth.
pub fn fill(run: &mut Run, window: &mut Window, out: &mut Vec<f64>) {
    let outputs = run.outputs().clone();
    out.extend(run.numbers());
    let (simulation, patch) = (run.simulation(), run.settings().patch);
    let config = simulation.model().config();
    let map = PatchMap::new(simulation.state(), &outputs, patch, config.thermal.reference);
    widen(window, outputs.contact_half_width, map.ends());
    let stretches: Vec<_> = run.track().beyond(outputs.wheel_distance).iter().take(STRETCHES).collect();
    let flag = |is: bool| f64::from(u8::from(is));
    let x = [-window.x, window.x];
    out.extend([
        simulation.time(),
        run.torque(),
        run.inputs().drive.load,
        flag(run.locked()),
        flag(run.inputs().translation.prescribes_motion()),
        outputs.wheel_angle,
        stretches.len() as f64,
        x[0],
        x[1],
        window.z[0],
        window.z[1],
    ]);
    for k in 0..STRETCHES {
        let none = (f64::NEG_INFINITY, Condition::Dry);
        let (begin, condition) = stretches.get(k).map_or(none, |stretch| **stretch);
        let number = Condition::ALL.iter().position(|other| *other == condition).unwrap_or(0);
        out.extend([(begin - outputs.wheel_distance).max(-1e9), number as f64]);
    }
    map.fill(grid(patch), [x, window.z], out);
    map.outline(grid(patch).across, window.z, out);
    out.extend(outputs.profile_depth.iter().chain(&outputs.profile_wheel_below).chain(&outputs.profile_rail_below));
}

/// Makes room for a patch of a half-length and with ends across \[m].
fn widen(window: &mut Window, half_length: f64, [low, high]: [f64; 2]) {
    if half_length > 0.97 * window.x {
        window.x = (1.0 + ROOM[0]) * half_length;
    }
    if low < window.z[0] || high > window.z[1] {
        let room = ROOM[1] * (high - low);
        window.z = [window.z[0].min(low - room), window.z[1].max(high + room)];
    }
}
