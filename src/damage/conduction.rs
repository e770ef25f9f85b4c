//! Conduction of heat in a spot: both directions in turn, arc – depth – arc (Strang's splitting, second order), each by
//! an L-stable implicit formula of second order. Stable for any step; insulated below and at the sides, where nothing
//! is hot.

use super::mesh::{ConductionLine, SpotMesh};

/// Coefficient of the two-stage formula [1]: `1 − 1/√2` (Alexander, *SIAM J. Numer. Anal.* 14 (1977)).
const GAMMA: f64 = 1.0 - std::f64::consts::FRAC_1_SQRT_2;

/// Memory that steps reuse.
#[derive(Default)]
pub(super) struct ConductionScratch {
    along: Factors,
    across: Factors,
    stage: Vec<f64>,
}

/// Direction of the mesh: `nodes` in a row, `stride` apart in memory, and as many `lanes` of them side by side.
#[derive(Clone, Copy, Default)]
struct Lanes {
    nodes: usize,
    stride: usize,
    lanes: usize,
    apart: usize,
}

/// Factors of `1 − θ L` for all lanes of one direction.
#[derive(Default)]
struct Factors {
    rows: Lanes,
    lower: Vec<f64>,
    upper: Vec<f64>,
    inverse: Vec<f64>,
}

/// Advances excess temperatures `values` by `dt` \[s], with heat transfer from the surface to a medium without excess
/// temperature by the coefficient `convection` [W/(m² K)].
pub(super) fn conduct(mesh: &SpotMesh, values: &mut [f64], dt: f64, convection: f64, scratch: &mut ConductionScratch) {
    let (columns, layers) = (mesh.arc.len(), mesh.depth.len());
    let ConductionScratch { along, across, stage } = scratch;
    let theta = GAMMA * dt * mesh.diffusivity();
    along.rows = Lanes { nodes: columns, stride: layers, lanes: layers, apart: 1 };
    along.set(&mesh.along, 0.0, |lane| 0.5 * theta * mesh.stretch[lane]);
    across.rows = Lanes { nodes: layers, stride: 1, lanes: columns, apart: layers };
    across.set(&mesh.across, GAMMA * dt * mesh.cooling(convection), |_| theta);
    along.advance(values, stage);
    across.advance(values, stage);
    along.advance(values, stage);
}

impl Factors {
    /// Factors of a line with a sink at its first node, with the coefficient `theta` of each lane.
    fn set(&mut self, line: &ConductionLine, sink: f64, theta: impl Fn(usize) -> f64) {
        let Lanes { nodes, stride, lanes, apart } = self.rows;
        for values in [&mut self.lower, &mut self.upper, &mut self.inverse] {
            values.clear();
            values.resize(nodes * lanes, 0.0);
        }
        for node in 0..nodes {
            let sink = if node == 0 { sink } else { 0.0 };
            for lane in 0..lanes {
                let (at, theta) = (node * stride + lane * apart, theta(lane));
                let (lower, upper) = (theta * line.lower[node], theta * line.upper[node]);
                let before = if node > 0 { self.upper[at - stride] } else { 0.0 };
                let inverse = 1.0 / (1.0 + lower + upper + sink - lower * before);
                (self.lower[at], self.upper[at], self.inverse[at]) = (lower, upper * inverse, inverse);
            }
        }
    }

    /// Replaces `values` by the solution of `(1 − θ L) x = values`.
    fn solve(&self, values: &mut [f64]) {
        let Lanes { nodes, stride, lanes, apart } = self.rows;
        for node in 0..nodes {
            for at in (0..lanes).map(|lane| node * stride + lane * apart) {
                let before = if node > 0 { values[at - stride] } else { 0.0 };
                values[at] = (values[at] + self.lower[at] * before) * self.inverse[at];
            }
        }
        for node in (0..nodes.saturating_sub(1)).rev() {
            for at in (0..lanes).map(|lane| node * stride + lane * apart) {
                values[at] += self.upper[at] * values[at + stride];
            }
        }
    }

    /// Two stages: the second starts from the result of the first.
    fn advance(&self, values: &mut [f64], stage: &mut Vec<f64>) {
        stage.clear();
        stage.extend_from_slice(values);
        self.solve(stage);
        const SHARE: f64 = (1.0 - GAMMA) / GAMMA;
        values.iter_mut().zip(stage.iter()).for_each(|(value, stage)| *value += SHARE * (stage - *value));
        self.solve(values);
    }
}
