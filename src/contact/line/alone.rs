//! Displacements by the flexibility that a line has for itself.

use crate::contact::kernel::LineKernel;
use crate::contact::problem::LineProblem;
use crate::linalg::vectorised::add_columns;
use nalgebra::DMatrix;

/// Flexibility of one body under the forces of a line, as far as only the line itself feels it.
#[derive(Clone, Copy)]
pub struct Alone<'a> {
    kernel: &'a LineKernel,
    logarithms: &'a DMatrix<f64>,
}

impl<'a> LineProblem<'a> {
    /// Flexibility that the line has for itself; `None`: it has none.
    pub fn alone(&self) -> Option<Alone<'_>> {
        Some(Alone { kernel: &self.kernel, logarithms: self.bodies.alone? })
    }
}

impl Alone<'_> {
    /// Writes the displacements of all nodes by tangential (`component` 0) or normal forces (1) at neighbouring nodes,
    /// from the node `first` on \[m].
    pub fn displace(&self, component: usize, first: usize, forces: &[f64], displaced: &mut Vec<f64>) {
        let (along, nodes) = (self.kernel.along(component), self.logarithms.nrows());
        displaced.clear();
        displaced.resize(nodes, along.factor * along.reach * forces.iter().sum::<f64>());
        let Some(start) = forces.iter().position(|force| *force != 0.0) else { return };
        let end = forces.iter().rposition(|force| *force != 0.0).map_or(start, |last| last + 1);
        let columns = &self.logarithms.as_slice()[(first + start) * nodes..];
        add_columns(along.factor, columns, nodes, &forces[start..end], displaced);
    }

    /// Displacements of neighbouring nodes, from the node `first` on, by forces at the given nodes \[m].
    pub fn by_nodes<const N: usize>(
        &self,
        component: usize,
        forces: [(usize, f64); N],
        first: usize,
    ) -> impl Iterator<Item = f64> {
        let (along, nodes) = (self.kernel.along(component), self.logarithms.nrows());
        let constant = along.factor * along.reach * forces.iter().map(|(_, force)| force).sum::<f64>();
        let columns = forces.map(|(node, force)| {
            (&self.logarithms.as_slice()[node * nodes + first..(node + 1) * nodes], along.factor * force)
        });
        (0..nodes - first).map(move |i| columns.iter().fold(constant, |sum, (column, force)| sum + force * column[i]))
    }
}
