//! Displacements by the flexibility that a line has for itself: that of a half-plane under its own forces.

use super::grid::ContactGrid;
use crate::contact::kernel::LineKernel;
use crate::linalg::vectorised::add_columns;
use nalgebra::DVector;
use std::ops::Range;

/// Flexibility of one body under the forces of a line, as far as only the line itself feels it.
#[derive(Clone, Copy)]
pub struct Alone<'a> {
    pub kernel: LineKernel,
    pub grid: &'a ContactGrid,
}

/// Displacements of all nodes of a body above its surface by forces there, x and y of every node \[m].
#[derive(Default)]
pub struct OwnDisplacement {
    /// Along the forces.
    pub along: DVector<f64>,
    /// Across them. A body below its surface moves the other way.
    pub across: DVector<f64>,
    forces: Vec<f64>,
    displaced: [Vec<f64>; 2],
}

impl Alone<'_> {
    /// Writes the displacements of all nodes by tangential (`component` 0), normal (1) or lateral forces (2) at neighbouring
    /// nodes, from the node `first` on \[m].
    pub fn displace(&self, component: usize, first: usize, forces: &[f64], displaced: &mut Vec<f64>) {
        let (along, logarithms) = (self.grid.unscaled(self.kernel.along(component)), &self.grid.logarithms);
        let nodes = logarithms.nrows();
        displaced.clear();
        displaced.resize(nodes, along.factor * along.reach * forces.iter().sum::<f64>());
        let loaded = loaded(forces);
        let columns = &logarithms.as_slice()[(first + loaded.start) * nodes..];
        add_columns(along.factor, columns, nodes, &forces[loaded], displaced);
    }

    /// Displacement of node `at` along a unit force of a component at the node `by` [m/(N/m)].
    pub fn by_force(&self, component: usize, at: usize, by: usize) -> f64 {
        self.grid.unscaled(self.kernel.along(component)).displacement(self.grid.logarithms[(at, by)])
    }

    /// Writes the displacements by `forces` on a body, x and y of every node [N/m].
    pub fn find(&self, forces: &[f64], own: &mut OwnDisplacement) {
        let OwnDisplacement { along, across, forces: of_component, displaced } = own;
        for values in [&mut *along, &mut *across].into_iter().filter(|values| values.len() != forces.len()) {
            *values = DVector::zeros(forces.len());
        }
        let (forces, mut sums, mut before) = (forces.as_chunks::<2>().0, [0.0; 2], [0.0; 2]);
        for (component, displaced) in displaced.iter_mut().enumerate() {
            of_component.clear();
            of_component.extend(forces.iter().map(|force| force[component]));
            sums[component] = of_component.iter().sum();
            self.displace(component, 0, of_component, displaced);
        }
        let (along, across) =
            (along.as_mut_slice().as_chunks_mut::<2>().0, across.as_mut_slice().as_chunks_mut::<2>().0);
        let ([x, y], half) = (&*displaced, 0.5 * self.kernel.coupling);
        for ((((along, across), force), x), y) in along.iter_mut().zip(across).zip(forces).zip(x).zip(y) {
            *along = [*x, *y];
            // Pressure draws the surface towards it, and tangential forces raise it before them.
            let signs = [2.0 * before[0] + force[0] - sums[0], 2.0 * before[1] + force[1] - sums[1]];
            *across = [-half * signs[1], half * signs[0]];
            before = [before[0] + force[0], before[1] + force[1]];
        }
    }
}

impl OwnDisplacement {
    /// Adds the displacement of wheel (0) or rail (1) by these forces on it.
    pub fn add_to(&self, body: usize, displacement: &mut DVector<f64>) {
        let side = if body == 0 { 1.0 } else { -1.0 };
        let moved = self.along.iter().zip(self.across.iter()).map(|(along, across)| along + side * across);
        displacement.iter_mut().zip(moved).for_each(|(value, moved)| *value += moved);
    }

    /// Adds the displacements of wheel and rail by these forces on the wheel and their opposites on the rail.
    pub fn add_between(&self, [wheel, rail]: [&mut DVector<f64>; 2]) {
        let (wheel, rail) = (wheel.as_mut_slice().iter_mut(), rail.as_mut_slice().iter_mut());
        let own = self.along.as_slice().iter().zip(self.across.as_slice());
        for ((wheel, rail), (along, across)) in wheel.zip(rail).zip(own) {
            *wheel += along + across;
            *rail += across - along;
        }
    }

    /// Work of forces on the way of wheel (0) or rail (1) [N/m times m].
    pub fn work(&self, body: usize, forces: &[f64]) -> f64 {
        let side = if body == 0 { 1.0 } else { -1.0 };
        let moved = self.along.iter().zip(self.across.iter()).map(|(along, across)| along + side * across);
        forces.iter().zip(moved).map(|(force, moved)| force * moved).sum()
    }
}

/// From the first to the last force that is not zero.
pub fn loaded(forces: &[f64]) -> Range<usize> {
    let first = forces.iter().position(|force| *force != 0.0).unwrap_or(forces.len());
    first..forces.iter().rposition(|force| *force != 0.0).map_or(first, |last| last + 1)
}

/// Forces before every node less those behind it [N/m].
pub fn signs(forces: &[f64]) -> impl Iterator<Item = f64> {
    let total: f64 = forces.iter().sum();
    let mut before = 0.0;
    forces.iter().map(move |force| {
        let sign = 2.0 * before + force - total;
        before += force;
        sign
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analytic::HalfPlane;

    /// Forces along and normal on three nodes displace all nodes as a half-plane on each side of the surface.
    #[test]
    fn a_line_is_displaced_along_and_across_its_forces_as_a_half_plane() {
        let half_plane = HalfPlane { kernel: 3e-12, coupling: 1e-12 };
        let grid = ContactGrid::uniform((-6..=6).map(f64::from).collect(), 1.0, 2);
        let alone = Alone { kernel: LineKernel::of_half_plane(half_plane, 1.0), grid: &grid };
        let mut forces = vec![0.0; grid.components()];
        for (k, force) in [(8, 2.0), (9, 1.0), (11, -3.0), (12, 0.5)] {
            forces[k] = force;
        }
        let mut own = OwnDisplacement::default();
        alone.find(&forces, &mut own);
        for body in 0..2 {
            let (side, mut found) = ([1.0, -1.0][body], DVector::zeros(forces.len()));
            own.add_to(body, &mut found);
            for (at, by) in [(1, 4), (15, 6), (2, 5)] {
                let mut single = vec![0.0; forces.len()];
                (single[2 * by], single[2 * by + 1]) = (2.0, 3.0);
                alone.find(&single, &mut own);
                let mut moved = DVector::zeros(forces.len());
                own.add_to(body, &mut moved);
                let x = at as f64 - by as f64;
                let of = |c: usize, d: usize| half_plane.displacement(c, d, x, side);
                let expected = [2.0 * of(0, 0) + 3.0 * of(0, 1), 2.0 * of(1, 0) + 3.0 * of(1, 1)];
                // Logarithms are those of the discrete kernel.
                assert!((moved[2 * at] - expected[0]).abs() < 0.01 * half_plane.kernel);
                assert!((moved[2 * at + 1] - expected[1]).abs() < 0.02 * half_plane.kernel);
            }
            alone.find(&forces, &mut own);
            let work = own.work(body, &forces);
            assert!((work - found.iter().zip(&forces).map(|(u, f)| u * f).sum::<f64>()).abs() < 1e-24);
        }
    }
}
