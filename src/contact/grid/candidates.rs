//! The surface nodes at which contact is looked for.

/// Uniformly spaced pairs of surface nodes: candidates for contact with guard nodes on both sides.
///
/// Guard nodes never come into contact; the slip of the outermost candidates needs their displacements.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactGrid {
    /// Positions of the candidates \[m], ascending.
    pub x: Vec<f64>,
    /// Their spacing \[m].
    pub spacing: f64,
    /// Number of guard nodes on each side.
    pub guard: usize,
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

    /// Number of ports, the surface displacement components: `2·(candidates + 2·guard)`.
    pub fn ports(&self) -> usize {
        2 * (self.len() + 2 * self.guard)
    }

    /// Port of the x component of candidate `i`; y follows it.
    pub fn port(&self, i: usize) -> usize {
        2 * (i + self.guard)
    }
}
