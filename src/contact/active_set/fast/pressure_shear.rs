//! Equations of a single patch, solved by alternation: pressures for given shear, shear for given pressures.
//!
//! Unknowns are the normal forces of the closed nodes, the *sheared* unknowns (tangential forces of the stuck nodes,
//! velocities of the hub that are free), and the height of the hub where it is free, in this order.

use super::patch_factor::PatchMatrices;
use crate::axes::Axis;
use crate::linalg::DenseSystem;
use crate::linalg::vectorised::{add_columns, dot};

/// Alternations allowed: ordinary steps take three or four.
const MOST_ALTERNATIONS: usize = 10;
/// Error that counts as none, over the largest nodal force \[1].
const PRECISION: f64 = 1e-13;

/// Equations and unknowns of one patch, and the memory to solve them.
#[derive(Default)]
pub struct PressureShear {
    /// Gap at the closed nodes without contact forces and free motions [m].
    pub gap: Vec<f64>,
    /// Its change with each of the free motions, in their order.
    pub motions: [Vec<f64>; Axis::COUNT],
    /// Place of the closed nodes \[m]: the rim angle tilts the gap about the contact point.
    pub place: Vec<f64>,
    /// Rim angle by the normal and by the tangential force at each closed node [rad/(N/m)].
    pub rim_angle: [Vec<f64>; 2],
    /// Tangential over normal force at the closed nodes that slip, zero at the stuck ones [1].
    pub friction: Vec<f64>,
    /// Stuck nodes, counted among the closed ones.
    pub stuck: Vec<usize>,
    /// Number of sheared unknowns.
    sheared: usize,
    /// Rows of the sheared unknowns and of the height, one after the other, and their right-hand sides.
    rows: Vec<f64>,
    constants: Vec<f64>,
    /// All unknowns: at first a guess, then the solution.
    pub unknowns: Vec<f64>,
    /// Equations of the sheared unknowns, and their right-hand sides.
    system: DenseSystem,
    sides: Vec<f64>,
    /// Change of the normal forces with the height while the gap stays closed.
    raised: Vec<f64>,
    /// Tangential forces at the closed nodes [N/m].
    shear: Vec<f64>,
    /// Gap to be closed \[m], and the normal forces that close it [N/m].
    open: Vec<f64>,
    normal: Vec<f64>,
    product: Vec<f64>,
}

impl PressureShear {
    /// Makes room for the rows of `sheared` unknowns and for that of the height, if it is free.
    pub fn reset(&mut self, sheared: usize, height_is_free: bool) {
        let rows = sheared + usize::from(height_is_free);
        let unknowns = self.gap.len() + rows;
        self.sheared = sheared;
        // Longer ones of before are kept: to fill them again costs as much as a tenth of the solution.
        self.rows.resize(self.rows.len().max(rows * unknowns), 0.0);
        self.constants.resize(rows, 0.0);
        self.unknowns.resize(unknowns, 0.0);
    }

    /// Row `r`, and its right-hand side.
    pub fn row(&mut self, r: usize) -> (&mut [f64], &mut f64) {
        let width = self.unknowns.len();
        (&mut self.rows[r * width..(r + 1) * width], &mut self.constants[r])
    }

    /// Solves by alternation; `false`: it does not converge.
    pub fn solve(&mut self, patch: PatchMatrices) -> bool {
        if !self.factorise() {
            return false;
        }
        self.raise(patch);
        let mut before = None;
        for _ in 0..MOST_ALTERNATIONS {
            // A sum, so that a NaN is not lost.
            let change = self.find_pressure(patch) + self.find_shear();
            // Change of the next alternation, if they go on converging so.
            let next = before.map_or(change, |before| change * f64::min(change / before, 1.0));
            if next <= PRECISION {
                return true;
            }
            before = Some(change);
        }
        false
    }

    /// Factorises the equations of the sheared unknowns.
    fn factorise(&mut self) -> bool {
        let (width, closed, sheared) = (self.unknowns.len(), self.gap.len(), self.sheared);
        let rows = self.rows.chunks(width).take(sheared);
        self.system.set(sheared, rows.map(|row| &row[closed..closed + sheared]));
        self.system.factorise()
    }

    /// Effect of the height of the hub on the normal forces.
    fn raise(&mut self, patch: PatchMatrices) {
        let height = self.constants.len() > self.sheared;
        self.raised.clear();
        if height && let Some(by_height) = self.motions.iter().rfind(|motion| !motion.is_empty()) {
            self.raised.extend(by_height.iter().map(|by_height| -by_height));
            patch.factor.solve(&mut self.raised, &mut self.product);
        }
    }

    /// Finds normal forces and height for the present shear; returns the largest change of the forces over the largest
    /// force.
    fn find_pressure(&mut self, patch: PatchMatrices) -> f64 {
        let (closed, width) = (self.gap.len(), self.unknowns.len());
        let (normal, others) = self.unknowns.split_at_mut(closed);
        self.shear.clear();
        self.shear.extend(normal.iter().zip(&self.friction).map(|(normal, friction)| friction * normal));
        self.stuck.iter().zip(&*others).for_each(|(&i, force)| self.shear[i] = *force);
        let turned = dot(&self.rim_angle[0], normal) + dot(&self.rim_angle[1], &self.shear);
        self.open.clear();
        self.open.extend(self.gap.iter().zip(&self.place).map(|(gap, x)| gap - x * turned));
        if self.shear.iter().any(|force| *force != 0.0) {
            add_columns(1.0, patch.coupling, patch.apart, &self.shear, &mut self.open);
        }
        let free_velocities = &others[self.stuck.len()..self.sheared];
        for (motion, value) in self.motions.iter().zip(free_velocities) {
            self.open.iter_mut().zip(motion).for_each(|(open, by_motion)| *open += by_motion * value);
        }
        self.normal.clear();
        self.normal.extend(self.open.iter().map(|open| -open));
        patch.factor.solve(&mut self.normal, &mut self.product);
        if let (Some(constant), Some(row)) =
            (self.constants.get(self.sheared), self.rows.chunks(width).nth(self.sheared))
        {
            let (of_normal, of_others) = row.split_at(closed);
            let known =
                constant - dot(of_normal, &self.normal) - dot(&of_others[..self.sheared], &others[..self.sheared]);
            let height = known / (of_others[self.sheared] + dot(of_normal, &self.raised));
            others[self.sheared] = height;
            self.normal.iter_mut().zip(&self.raised).for_each(|(force, raised)| *force += raised * height);
        }
        take(normal, &self.normal, &self.normal)
    }

    /// Finds the sheared unknowns for the present normal forces and height; returns the largest change of the
    /// tangential forces over the largest normal force.
    fn find_shear(&mut self) -> f64 {
        let (closed, width, sheared) = (self.gap.len(), self.unknowns.len(), self.sheared);
        let (normal, others) = self.unknowns.split_at_mut(closed);
        self.sides.clear();
        self.sides.extend(self.rows.chunks(width).take(sheared).zip(&self.constants).map(|(row, constant)| {
            let by_height = row[closed + sheared..].iter().zip(&others[sheared..]).map(|(c, height)| c * height);
            constant - dot(&row[..closed], normal) - by_height.sum::<f64>()
        }));
        if !self.system.solve_with(&mut self.sides) {
            return f64::NAN;
        }
        let (stuck, velocities) = others[..sheared].split_at_mut(self.stuck.len());
        velocities.copy_from_slice(&self.sides[stuck.len()..]);
        take(stuck, &self.sides[..stuck.len()], normal)
    }
}

/// Takes new `forces`; returns their largest change over the largest of the forces `scale`, NaN where they are not
/// finite.
fn take(forces: &mut [f64], new: &[f64], scale: &[f64]) -> f64 {
    let most = scale.iter().fold(0.0, |most: f64, force| most.max(force.abs()));
    let change = forces.iter().zip(new).fold(0.0, |most: f64, (force, new)| {
        let change = (new - force).abs();
        // A NaN must not be lost.
        if change > most || change.is_nan() { change } else { most }
    });
    forces.copy_from_slice(new);
    change / most
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::InverseFactor;
    use nalgebra::DMatrix;

    const CLOSED: usize = 12;
    const STUCK: usize = 7;

    /// A made-up patch whose shear opens the gap by `share` of the effect of pressure: a free velocity, a free height.
    /// Beside its equations those of all unknowns together.
    fn patch(share: f64) -> (PressureShear, [DMatrix<f64>; 2], DMatrix<f64>, Vec<f64>) {
        let wave = |i: usize, j: usize| ((3 * i + 5 * j) as f64).sin();
        let near = |i: usize, j: usize| (-0.7 * (i as f64 - j as f64).abs()).exp();
        let compliance = DMatrix::from_fn(CLOSED, CLOSED, near);
        let coupling = DMatrix::from_fn(CLOSED, CLOSED, |i, j| share * wave(i, j));
        let mut equations = PressureShear {
            gap: (0..CLOSED).map(|i| 0.1 * (i as f64 - 5.5).powi(2) - 3.0).collect(),
            place: (0..CLOSED).map(|i| i as f64 - 5.5).collect(),
            rim_angle: [0.001, 0.002].map(|by| (0..CLOSED).map(|i| by * wave(i, 1)).collect()),
            friction: (0..CLOSED).map(|i| if i < STUCK { 0.0 } else { 0.3 }).collect(),
            stuck: (0..STUCK).collect(),
            motions: [vec![0.01; CLOSED], vec![1.0; CLOSED], vec![], vec![]],
            ..PressureShear::default()
        };
        equations.reset(STUCK + 1, true);
        let count = equations.unknowns.len();
        for r in 0..STUCK + 2 {
            let own = CLOSED + r;
            let (row, side) = equations.row(r);
            row.iter_mut().enumerate().for_each(|(c, value)| *value = 0.05 * wave(r, c));
            row[own] += if own + 1 == count { -0.2 } else { 2.0 };
            // The balance of the height is that of the normal forces.
            if own + 1 == count {
                row[..CLOSED].fill(1.0);
            }
            *side = wave(r, 0) + if own + 1 == count { 9.0 } else { 0.0 };
        }
        let mut all = DMatrix::zeros(count, count);
        for i in 0..CLOSED {
            for j in 0..CLOSED {
                let by_shear = coupling[(i, j)] - equations.place[i] * equations.rim_angle[1][j];
                all[(i, j)] = compliance[(i, j)] - equations.place[i] * equations.rim_angle[0][j]
                    + equations.friction[j] * by_shear;
                if j < STUCK {
                    all[(i, CLOSED + j)] = by_shear;
                }
            }
            (all[(i, count - 2)], all[(i, count - 1)]) = (0.01, 1.0);
        }
        for r in 0..STUCK + 2 {
            all.row_mut(CLOSED + r).iter_mut().zip(equations.row(r).0).for_each(|(a, value)| *a = *value);
        }
        let sides = equations.gap.iter().map(|gap| -gap).chain(equations.constants.iter().copied()).collect();
        (equations, [compliance, coupling], all, sides)
    }

    fn solve(equations: &mut PressureShear, [compliance, coupling]: &[DMatrix<f64>; 2]) -> bool {
        let mut factor = InverseFactor::default();
        for i in 0..CLOSED {
            factor.append((0..i).map(|j| compliance[(i, j)]), compliance[(i, i)]).unwrap();
        }
        equations.solve(PatchMatrices { factor: &factor, coupling: coupling.as_slice(), apart: CLOSED })
    }

    #[test]
    fn alternation_ends_at_the_solution_of_all_equations_together() {
        for share in [0.0, 1e-3, 0.01] {
            let (mut equations, matrices, all, sides) = patch(share);
            assert!(solve(&mut equations, &matrices), "{share}");
            let exact = all.lu().solve(&nalgebra::DVector::from_vec(sides)).unwrap();
            let error = (nalgebra::DVector::from_vec(equations.unknowns.clone()) - &exact).amax() / exact.amax();
            assert!(error < 1e-12, "{share}: {error:e}");
            // From the solution itself hardly an alternation is needed, and nothing moves.
            let found = equations.unknowns.clone();
            assert!(solve(&mut equations, &matrices));
            assert!(equations.unknowns.iter().zip(&found).all(|(a, b)| (a - b).abs() < 1e-12 * exact.amax()));
        }
    }

    #[test]
    fn an_alternation_that_does_not_settle_is_given_up() {
        let (mut equations, matrices, ..) = patch(10.0);
        assert!(!solve(&mut equations, &matrices));
        let (mut equations, matrices, ..) = patch(1e-3);
        equations.gap[3] = f64::NAN;
        assert!(!solve(&mut equations, &matrices));
    }
}
