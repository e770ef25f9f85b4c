//! The contact grid and the undeformed gap.

/// Uniformly spaced pairs of surface nodes: candidates for contact with guard nodes on both sides.
///
/// Guard nodes never come into contact; the slip of the outermost candidates needs their displacements.
#[derive(Clone, Debug)]
pub struct ContactGrid {
    /// Positions of the candidates [m], ascending.
    pub x: Vec<f64>,
    /// Their spacing [m].
    pub spacing: f64,
    /// Number of guard nodes on each side.
    pub guard: usize,
    /// Wheel radius [m].
    pub radius: f64,
}

impl ContactGrid {
    /// Number of candidates.
    pub fn len(&self) -> usize {
        self.x.len()
    }

    /// Whether there is no candidate.
    pub fn is_empty(&self) -> bool {
        self.x.is_empty()
    }

    /// Surface displacement components: `2·(candidates + 2·guard)`.
    pub fn surface_dofs(&self) -> usize {
        2 * (self.len() + 2 * self.guard)
    }

    /// Index of the x component of candidate `i` among the surface displacements; y follows it.
    pub fn dof(&self, i: usize) -> usize {
        2 * (i + self.guard)
    }

    /// Distance between the undeformed, just touching bodies at candidate `i` [m]: `r − √(r² − x²)`.
    pub fn undeformed_gap(&self, i: usize) -> f64 {
        let x = self.x[i];
        // The equivalent form without cancellation.
        x * x / (self.radius + (self.radius * self.radius - x * x).max(0.0).sqrt())
    }
}
