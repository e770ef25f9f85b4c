//! Quadrilateral mesh with named sets.

/// A mesh of quadrilaterals.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Coordinates \[m].
    pub nodes: Vec<[f64; 2]>,
    /// Corner nodes, counter-clockwise.
    pub cells: Vec<[usize; 4]>,
    /// Nodes that can touch the other body (candidates and guards), x ascending.
    pub surface: Vec<usize>,
    /// Nodes that do not move relative to the body's rigid frame (hub or base).
    pub fixed: Vec<usize>,
    /// Free faces through which material streams in or out.
    pub ends: Vec<Face>,
    /// The node at the mirror image `(−x, y)` of each node's place; empty: the mesh is not its own mirror image.
    pub mirror: Vec<usize>,
}

/// Edge `edge` of a cell, from corner `edge` to corner `edge + 1`; its outward normal lies to the right.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Face {
    /// Index of the cell.
    pub cell: usize,
    /// Its edge, 0 to 3.
    pub edge: usize,
}

impl Mesh {
    /// Corner coordinates of a cell.
    pub fn corners(&self, cell: usize) -> [[f64; 2]; 4] {
        self.cells[cell].map(|node| self.nodes[node])
    }

    /// Fixes the nodes of the ends, which are none from then on.
    pub fn fix_ends(&mut self) {
        let corner = |face: &Face, next: usize| self.cells[face.cell][(face.edge + next) % 4];
        let held: Vec<usize> = self.ends.iter().flat_map(|face| [corner(face, 0), corner(face, 1)]).collect();
        self.fixed.extend(held);
        self.fixed.sort_unstable();
        self.fixed.dedup();
        self.ends.clear();
    }

    /// x of the surface nodes \[m].
    pub fn surface_x(&self) -> Vec<f64> {
        self.surface.iter().map(|&node| self.nodes[node][0]).collect()
    }
}
