//! The problem of friction on one line under given normal forces: slips of its closed nodes by their own shear.

use super::super::search::ActiveSet;
use super::status;
use crate::contact::cone::{AlongAcross, ConeProblem, SLIPS, SlipRows, TangentialCoupling};
use crate::contact::flexibility::{at, slip_of_field};
use crate::contact::line::contact_line::ContactLine;
use crate::linalg::POINTS;

/// Shear at the closed `nodes` of a line, along and across [N/m].
pub fn shears<const N: usize>(line: &ContactLine, nodes: &[usize]) -> AlongAcross<N> {
    let mut shears = [[0.0; N]; 2];
    for (place, &i) in nodes.iter().enumerate() {
        let shear = line.shear(i);
        (shears[0][place], shears[1][place]) = (shear[0], shear[1]);
    }
    shears
}

/// Gives a line the shear at its closed `nodes`, and their states.
pub fn take<const N: usize>(line: &mut ContactLine, nodes: &[usize], shear: &AlongAcross<N>, states: &[i8; N]) {
    line.state.across.force.fill(0.0);
    for (place, &i) in nodes.iter().enumerate() {
        let port = line.grid.port(i);
        line.traction.port_forces[port] = shear[0][place];
        line.state.across.force[i] = shear[1][place];
        line.state.status[i] = status(states[place] == 0, shear[0][place]);
    }
}

impl ActiveSet<'_> {
    /// Problems of all lines with the slips of the present iterate, in which the closed `nodes` have the given shears.
    pub fn cone_problems<const N: usize>(
        &mut self,
        nodes: &[Vec<usize>],
        shears: &[AlongAcross<N>],
        coupling: &TangentialCoupling,
    ) -> Vec<ConeProblem<N>> {
        let forces = &mut self.memory.rows[0];
        let lines = self.lines.iter().zip(nodes);
        let rows: Vec<_> = lines.map(|(line, nodes)| slip_rows::<N>(line, nodes, forces)).collect();
        let moments: Vec<[f64; SLIPS]> = rows.iter().zip(shears).map(|(rows, shear)| moments(rows, shear)).collect();
        let parts = self.lines.iter().zip(nodes).zip(rows).zip(shears).enumerate();
        parts
            .map(|(k, (((line, nodes), mut rows), shear))| {
                let linear = rows.slips(shear, &coupling.by_lines(k, &moments));
                let (mut bears, mut weights) = ([0.0; N], [0.0; N]);
                for (place, &i) in nodes.iter().enumerate() {
                    rows.known[0][place] = line.state.slip[i] - linear[0][place];
                    rows.known[1][place] = line.state.across.slip[i] - linear[1][place];
                    bears[place] = line.friction(i) * line.normal(i).max(0.0);
                    weights[place] = 1.0;
                }
                let most = bears.iter().fold(0.0_f64, |most, bears| most.max(*bears));
                ConeProblem::new(rows, None, &weights, bears, most)
            })
            .collect()
    }
}

fn moments<const N: usize>(rows: &SlipRows<N>, shear: &AlongAcross<N>) -> [f64; SLIPS] {
    std::array::from_fn(|k| rows.powers[k % POINTS].iter().zip(&shear[k / POINTS]).map(|(by, q)| by * q).sum())
}

/// Slips of the closed `nodes` by their own shear, without known parts; `forces` is memory for the coefficients of all
/// ports.
fn slip_rows<const N: usize>(line: &ContactLine, nodes: &[usize], forces: &mut [f64]) -> SlipRows<N> {
    let mut rows =
        SlipRows { by_shear: [vec![[0.0; N]; N], vec![[0.0; N]; N]], known: [[0.0; N]; 2], powers: [[0.0; N]; POINTS] };
    let (Some(first), Some(last), Some(patch)) = (nodes.first(), nodes.last(), line.problem.patch) else { return rows };
    let window = line.grid.port(*first)..line.grid.port(*last) + 2;
    for (place, &i) in nodes.iter().enumerate() {
        line.slip_by_shared(i, line.problem.share, window.clone(), forces);
        line.add_slip(i, window.clone(), forces);
        for (by, &j) in nodes.iter().enumerate() {
            rows.by_shear[0][by][place] = forces[line.grid.port(j)];
        }
        let powers = patch.powers(line.grid.x[i]);
        (0..POINTS).for_each(|k| rows.powers[k][place] = powers[k]);
        slips_across(line, nodes, i, |by, slip| rows.by_shear[1][by][place] = slip);
    }
    rows
}

/// Hands slips across of a candidate by units of lateral force at the closed `nodes` over, with their places in these.
fn slips_across(line: &ContactLine, nodes: &[usize], i: usize, mut give: impl FnMut(usize, f64)) {
    let (rate, speed) = (line.problem.time.a0, line.traction.rigid.travel + line.rim_velocity());
    let (node, to_right) = (line.grid.port(i) / 2, line.upstream_right());
    let stencil = line.stencil(i, line.iterate.upwind.row(i), to_right);
    let own = line.problem.patch.and_then(|patch| Some((patch, patch.flexibility.across(patch.line, patch.line)?)));
    let of_moments = own.map(|(patch, [across, _])| {
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
