//! The problem of friction on one line under given normal forces: slips of its closed nodes by their own shear.

use crate::contact::cone::{ByDirection, ConeProblem, Polynomials, SlipRows};
use crate::contact::flexibility::{at, slip_of_field};
use crate::contact::line::contact_line::ContactLine;
use crate::contact::line::state::NodeStatus;
use crate::linalg::POINTS;

/// Shear at the closed `nodes` of a line, along and across [N/m].
pub fn shears<const N: usize>(line: &ContactLine, nodes: &[usize]) -> ByDirection<N, 2> {
    let mut shears = [[0.0; N]; 2];
    for (place, &i) in nodes.iter().enumerate() {
        let shear = line.shear(i);
        (shears[0][place], shears[1][place]) = (shear[0], shear[1]);
    }
    shears
}

/// Gives a line the shear at its closed `nodes`, and their states.
pub fn give<const N: usize>(line: &mut ContactLine, nodes: &[usize], shear: &ByDirection<N, 2>, states: &[i8; N]) {
    line.state.lateral.fill(0.0);
    for (place, &i) in nodes.iter().enumerate() {
        let port = line.grid.component(i);
        line.state.forces[port] = shear[0][place];
        line.state.lateral[i] = shear[1][place];
        line.state.status[i] = match states[place] {
            0 => NodeStatus::Stick,
            _ if shear[0][place] < 0.0 => NodeStatus::SlipBackward,
            _ => NodeStatus::SlipForward,
        };
    }
}

/// Problem of a line with the slips of its closed `nodes` by their own shear.
pub fn problem<const N: usize>(line: &ContactLine, nodes: &[usize]) -> ConeProblem<N, 2> {
    let weights = std::array::from_fn(|place| if place < nodes.len() { 1.0 } else { 0.0 });
    ConeProblem::new(slip_rows(line, nodes), None, &weights, [0.0; N], 0.0)
}

/// Takes slips and friction of the present iterate, in which the closed `nodes` have the given shear and slip by other lines
/// as given polynomials.
pub fn take<const N: usize>(
    line: &ContactLine,
    nodes: &[usize],
    problem: &mut ConeProblem<N, 2>,
    shear: &ByDirection<N, 2>,
    others: &Polynomials<2>,
) {
    let (mut slips, mut bears) = ([[0.0; N]; 2], [0.0; N]);
    for (place, &i) in nodes.iter().enumerate() {
        (slips[0][place], slips[1][place]) = (line.state.slip[0][i], line.state.slip[1][i]);
        bears[place] = line.friction(i) * line.normal(i).max(0.0);
    }
    problem.renew(slips, bears, shear, others);
}

/// Weight of a new displacement in its rate [1/s], and the sum of the speeds that carry strain [m/s].
fn rates(line: &ContactLine) -> [f64; 2] {
    [line.problem.time.a0, line.traction.rigid.travel + line.rim_velocity()]
}

/// Slips of the closed `nodes` by their own shear.
fn slip_rows<const N: usize>(line: &ContactLine, nodes: &[usize]) -> SlipRows<N, 2> {
    let mut rows = SlipRows {
        by_shear: [vec![[0.0; N]; N], vec![[0.0; N]; N]],
        known: [[0.0; N]; 2],
        powers: vec![[0.0; N]; POINTS],
    };
    let Some(patch) = line.problem.patch else { return rows };
    let (bodies, mut by_own) = (line.body_rows(), Vec::new());
    let of_moments = patch.own(0).map(|own| own.slips(slip_of_field(rates(line), patch.half_length)));
    for (place, &i) in nodes.iter().enumerate() {
        let (affine, upwind) = line.slip_row(i, &bodies);
        line.slips_by_own(i, &upwind, nodes, &mut by_own);
        by_own.iter().enumerate().for_each(|(by, slip)| rows.by_shear[0][by][place] += slip);
        let powers = patch.powers(line.grid.x[i]);
        let felt = of_moments.map(|slips| slips.map(|slip| at(&slip, &powers)));
        for (by, &j) in nodes.iter().enumerate() {
            let node = j + line.grid.guard;
            let (values, rim) = (&line.grid.values[node], &line.iterate.rim);
            let by_port =
                |(k, value): (usize, &f64)| value * (affine.ports[2 * k] + affine.angle * rim.by_ports[2 * k]);
            let by_bodies: f64 = values.iter().enumerate().map(by_port).sum();
            let by_lines = felt.map_or(0.0, |felt| at(&felt, &patch.powers(line.grid.x[j])));
            rows.by_shear[0][by][place] +=
                line.problem.share * by_bodies + affine.angle * rim.tangential[node] + by_lines;
        }
        (0..POINTS).for_each(|k| rows.powers[k][place] = powers[k]);
        slips_across(line, nodes, i, |by, slip| rows.by_shear[1][by][place] = slip);
    }
    rows
}

/// Hands slips across of a candidate by units of lateral force at the closed `nodes` over, with their places in these.
fn slips_across(line: &ContactLine, nodes: &[usize], i: usize, mut give: impl FnMut(usize, f64)) {
    let [rate, speed] = rates(line);
    let (node, to_right) = (line.grid.component(i) / 2, line.upstream_right());
    let stencil = line.stencil(i, line.iterate.upwind.row(i), to_right);
    let own = line.problem.patch.and_then(|patch| Some((patch, patch.own(1)?)));
    let of_moments = own.map(|(patch, across)| {
        let ([by_displacement, by_strain], here) =
            (slip_of_field([rate, speed], patch.half_length), patch.powers(line.grid.x[i]));
        let of_moment =
            |n: usize| by_displacement * at(&across.displacement[n], &here) + by_strain * at(&across.strain[n], &here);
        (patch, std::array::from_fn::<f64, POINTS, _>(of_moment))
    });
    for (by, &j) in nodes.iter().enumerate() {
        let strain: f64 = stencil.iter().map(|(port, weight)| weight * line.lateral_flexibility(port / 2, j)).sum();
        let smooth = of_moments.as_ref().map_or(0.0, |(patch, slips)| at(slips, &patch.powers(line.grid.x[j])));
        give(by, rate * line.lateral_flexibility(node, j) - 0.5 * speed * strain + smooth);
    }
}
