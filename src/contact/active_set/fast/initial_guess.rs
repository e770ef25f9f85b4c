//! Guess of the closed nodes on uneven surfaces, from which the active set starts.
//!
//! New material comes under the contact in every step, so that the edges of the patches move, and the search for all
//! states takes two or three iterations where on smooth surfaces it takes one. Pressures hardly depend on the shear. So
//! closed nodes and normal forces are first found by themselves, with the shear forces and velocities of before and the
//! [kept factors](KeptInverses). The guess decides nothing; where it fails the search starts from the states of before.

use super::patch_inverse::{KeptInverses, compliance};
use crate::axes::Axis;
use crate::contact::active_set::axes::Axes;
use crate::contact::active_set::states::{Comparison, guess_state};
use crate::contact::active_set::unknowns::LineUnknowns;
use crate::contact::line::contact_line::ContactLine;
use crate::contact::line::state::NodeStatus;
use crate::linalg::InverseFactor;
use crate::linalg::vectorised::add_columns;
use nalgebra::DVector;

/// Guesses of the closed nodes at most.
const MAX_GUESSES: usize = 6;

/// Balance of the height of the hub without its coefficients of the port forces.
struct HeightBalance {
    /// Coefficient of the height.
    by_height: f64,
    /// Known side.
    known: f64,
}

/// Memory of the guess.
#[derive(Default)]
pub struct InitialGuess {
    /// Gap at the candidates without normal forces and height of the hub \[m].
    base: Vec<f64>,
    /// Its change with the height of the hub \[1]; zero if that is prescribed.
    by_height: Vec<f64>,
    /// Normal forces at the closed nodes without height and rim angle [N/m], and their change with either.
    normal: [Vec<f64>; 3],
    /// Displacement of all ports by forces at the candidates \[m].
    displaced: Vec<f64>,
    /// Forces at the candidates [N/m].
    forces: Vec<f64>,
    /// Inverse where the closed nodes are no single patch or some of them yield.
    factor: InverseFactor,
    product: Vec<f64>,
    /// Start of the guess.
    status: Vec<NodeStatus>,
    port_forces: DVector<f64>,
}

/// Memory that the search lends: unknowns, coefficients of all ports, states before, kept inverses.
type Lent<'a> = (&'a mut LineUnknowns, &'a mut [Vec<f64>], &'a mut Vec<NodeStatus>, &'a mut KeptInverses);

impl InitialGuess {
    /// Sets closed nodes, gaps, normal forces and height of the hub to those that belong to the shear forces and
    /// velocities at hand, where the surfaces are uneven.
    pub fn find(&mut self, line: &mut ContactLine, axes: &Axes, comparison: Comparison, lent: Lent) {
        if line.given.rail_slope.is_empty() || line.problem.time.is_stationary() {
            return;
        }
        self.status.clone_from(&line.state.status);
        self.port_forces.clone_from(&line.traction.port_forces);
        let height = line.traction.rigid.height;
        if !self.settle(line, axes, comparison, lent) {
            line.state.status.clone_from(&self.status);
            line.traction.port_forces.clone_from(&self.port_forces);
            line.traction.rigid.height = height;
        }
    }

    /// Guesses until the closed nodes stay; `false` if nothing is closed or they do not.
    fn settle(
        &mut self,
        line: &mut ContactLine,
        axes: &Axes,
        comparison: Comparison,
        (unknowns, rows, before, inverses): Lent,
    ) -> bool {
        line.update_rim();
        let balance = self.write_base(line, axes, rows);
        for _ in 0..MAX_GUESSES {
            unknowns.list_closed(line);
            let pressed = self.press(line, unknowns, inverses, (&rows[0], &balance));
            if pressed && !self.close(line, comparison, before) {
                return true;
            }
            if unknowns.closed.is_empty() {
                break;
            }
        }
        false
    }

    /// Writes the gap without normal forces and height, and the balance of the height, whose force coefficients go to
    /// `rows`; `None` if the height is prescribed.
    fn write_base(&mut self, line: &ContactLine, axes: &Axes, rows: &mut [Vec<f64>]) -> Option<HeightBalance> {
        let (free, mut motions) = (axes.seeks(Axis::Height), line.traction.rigid);
        if free {
            motions.height = 0.0;
        }
        let Self { base, by_height, displaced, forces, .. } = self;
        forces.clear();
        forces.extend((0..line.grid.len()).map(|i| line.tangential(i)));
        displace(line, 0, forces, displaced);
        let turned = turned(line, 0, forces);
        base.clear();
        by_height.clear();
        for i in 0..line.grid.len() {
            let row = line.gap_terms(i);
            let by_motions = axes.equation(row).motions;
            let of_forces = displaced[line.grid.port(i) + 1] - line.grid.x[i] * turned;
            base.push(row.constant + by_motions.dot(motions) + of_forces);
            by_height.push(if free { by_motions.height } else { 0.0 });
        }
        free.then(|| {
            let balance = axes.row(Axis::Height, std::slice::from_ref(line), rows);
            let of_shear: f64 = forces.iter().enumerate().map(|(i, force)| rows[0][line.grid.port(i)] * force).sum();
            let known = -balance.constant - balance.motions.dot(motions) - of_shear;
            HeightBalance { by_height: balance.motions.height, known }
        })
    }

    /// Solves for the normal forces of the closed nodes, and for the height of the hub if that is sought, with its
    /// balance and the force coefficients of that; `false` without a solution.
    fn press(
        &mut self,
        line: &mut ContactLine,
        unknowns: &LineUnknowns,
        inverses: &mut KeptInverses,
        (row, balance): (&[f64], &Option<HeightBalance>),
    ) -> bool {
        let (grid, closed) = (line.grid, &unknowns.closed);
        let [known, raised, tilted] = &mut self.normal;
        [&mut *known, &mut *raised, &mut *tilted].into_iter().for_each(Vec::clear);
        known.extend(closed.iter().map(|&i| {
            let yields = if line.state.yielded[i] { line.creep(i) * line.given.strength.limit[i] } else { 0.0 };
            yields - self.base[i]
        }));
        raised.extend(closed.iter().map(|&i| -self.by_height[i]));
        tilted.extend(closed.iter().map(|&i| grid.x[i]));
        if self.solve_pressures(line, unknowns, inverses).is_none() {
            return false;
        }
        let normal = &self.normal;
        let sums = |coefficient: &dyn Fn(usize) -> f64| {
            let sum = |forces: &Vec<f64>| -> f64 {
                closed.iter().zip(forces).map(|(&i, force)| coefficient(grid.port(i) + 1) * force).sum()
            };
            normal.each_ref().map(sum)
        };
        // Height and rim angle by these forces: two equations.
        let turned = sums(&|port| line.rim.by_force(line.problem.share, port));
        let (height, angle) = match balance {
            Some(balance) => {
                let of = sums(&|port| row[port]);
                let (side, by_height) = (balance.known - of[0], balance.by_height + of[1]);
                let angle =
                    (turned[0] * by_height + turned[1] * side) / ((1.0 - turned[2]) * by_height + turned[1] * of[2]);
                let height = (side - of[2] * angle) / by_height;
                line.traction.rigid.height = height;
                (height, angle)
            }
            None => (0.0, turned[0] / (1.0 - turned[2])),
        };
        for i in 0..grid.len() {
            let port = grid.port(i);
            line.traction.port_forces[port + 1] = 0.0;
            if !line.state.status[i].is_active() {
                line.traction.port_forces[port] = 0.0;
            }
        }
        let [known, raised, tilted] = normal;
        for (n, &i) in closed.iter().enumerate() {
            line.traction.port_forces[grid.port(i) + 1] = known[n] + height * raised[n] + angle * tilted[n];
        }
        (height + angle).is_finite()
    }

    /// Replaces gaps to be closed by the forces that close them.
    fn solve_pressures(
        &mut self,
        line: &ContactLine,
        unknowns: &LineUnknowns,
        inverses: &mut KeptInverses,
    ) -> Option<()> {
        let Self { normal, factor, product, .. } = self;
        let patch = unknowns.single_patch(line);
        let factor = match patch.and_then(|patch| inverses.factor(line.problem, line.grid, &patch)) {
            Some(factor) => factor,
            None => {
                factorise(line, unknowns, factor)?;
                factor
            }
        };
        normal.iter_mut().for_each(|forces| factor.solve(forces, product));
        Some(())
    }

    /// Opens closed nodes that pull and closes open ones that overlap; returns whether there were any.
    fn close(&mut self, line: &mut ContactLine, comparison: Comparison, before: &mut Vec<NodeStatus>) -> bool {
        let Self { base, by_height, displaced, forces, .. } = self;
        let grid = line.grid;
        forces.clear();
        forces.extend((0..grid.len()).map(|i| line.normal(i)));
        displace(line, 1, forces, displaced);
        let turned = turned(line, 1, forces);
        before.clone_from(&line.state.status);
        let mut changed = false;
        for i in 0..grid.len() {
            let gap =
                base[i] + by_height[i] * line.traction.rigid.height + displaced[grid.port(i) + 1] - grid.x[i] * turned;
            changed |= guess_state(line, i, gap, comparison, before);
        }
        changed
    }
}

/// Displacements of all ports by normal (`offset` 1) or tangential (0) forces at the candidates.
fn displace(line: &ContactLine, offset: usize, forces: &[f64], displaced: &mut Vec<f64>) {
    let relative = line.problem.bodies.shared.relative;
    displaced.clear();
    displaced.resize(relative.nrows(), 0.0);
    let first = line.grid.port(0);
    let columns = &relative.as_slice()[(first + offset) * relative.nrows()..];
    add_columns(line.problem.share, columns, 2 * relative.nrows(), forces, displaced);
    if let Some(alone) = line.problem.alone() {
        let mut moved = Vec::new();
        alone.displace(offset, (first / 2, forces), &mut moved);
        let nodes = displaced.as_chunks_mut::<2>().0;
        nodes.iter_mut().zip(moved).for_each(|(node, moved)| node[offset] += 2.0 * moved);
    }
}

/// Rim angle by such forces \[rad].
fn turned(line: &ContactLine, offset: usize, forces: &[f64]) -> f64 {
    let by_force = |i: usize| line.rim.by_force(line.problem.share, line.grid.port(i) + offset);
    forces.iter().enumerate().map(|(i, force)| by_force(i) * force).sum()
}

/// Factorises the compliance of the closed nodes, of which some may yield.
fn factorise(line: &ContactLine, unknowns: &LineUnknowns, factor: &mut InverseFactor) -> Option<()> {
    let (closed, compliance) = (&unknowns.closed, |i, j| compliance(line.problem, line.grid, i, j));
    factor.truncate(0);
    for (n, &i) in closed.iter().enumerate() {
        let creep = if line.state.yielded[i] { line.creep(i) } else { 0.0 };
        factor.append(closed[..n].iter().map(|&j| compliance(i, j)), compliance(i, i) + creep)?;
    }
    Some(())
}
