//! Factor of the tensor meshes along the streamlines: nodes and elements.

use crate::fem::grading::graded;

/// Linear elements along the streamlines.
///
/// Element `e` joins node `e` to node `e + 1`; on a closed streamline the last one joins the last node to the first.
#[derive(Clone, Debug)]
pub struct Streamline {
    /// Node positions along the surface, ascending [m].
    pub nodes: Vec<f64>,
    /// Element lengths [m].
    pub lengths: Vec<f64>,
    /// Length of the shortest element [m].
    pub shortest: f64,
    /// Circumference of a closed streamline [m]; zero: open.
    pub closed: f64,
    /// `∫ Nᵢ ds` [m].
    pub weights: Vec<f64>,
    /// First node (and element) of the contact zone.
    pub zone: usize,
}

impl Streamline {
    /// Nodes of an open streamline, or of a closed one of the given circumference.
    pub fn new(nodes: Vec<f64>, closed: f64) -> Self {
        let mut lengths: Vec<f64> = nodes.windows(2).map(|w| w[1] - w[0]).collect();
        if closed > 0.0
            && let (Some(first), Some(last)) = (nodes.first(), nodes.last())
        {
            lengths.push(first + closed - last);
        }
        let n = nodes.len();
        let mut weights = vec![0.0; n];
        for (e, h) in lengths.iter().enumerate() {
            weights[e] += 0.5 * h;
            weights[(e + 1) % n] += 0.5 * h;
        }
        let shortest = lengths.iter().copied().fold(f64::INFINITY, f64::min);
        Self { nodes, lengths, shortest, closed, weights, zone: 0 }
    }

    /// Nodes `zone` (from zero on) and growing elements beyond to the distance `half`, mirrored.
    ///
    /// On a closed streamline the two far ends are the same node, which comes last.
    pub fn around_contact(zone: &[f64], half: f64, growth: f64, largest: f64, closed: bool) -> Self {
        let (reach, cells) = (zone.last().copied().unwrap_or(0.0), zone.len().saturating_sub(1));
        let spacing = if cells > 0 { reach - zone[cells - 1] } else { largest };
        let mut side = zone.to_vec();
        side.extend(graded(spacing * growth, growth, largest, half - reach).iter().skip(1).map(|s| reach + s));
        let skipped = usize::from(closed);
        let mut nodes: Vec<f64> = side.iter().rev().skip(skipped).map(|s| -s).collect();
        nodes.pop();
        let first = nodes.len().saturating_sub(cells);
        nodes.extend(&side);
        Self { zone: first, ..Self::new(nodes, if closed { 2.0 * half } else { 0.0 }) }
    }

    /// Number of nodes.
    pub fn len(&self) -> usize {
        self.nodes.len()
    }

    /// Node after an element's first one.
    pub fn after(&self, element: usize) -> usize {
        (element + 1) % self.len()
    }
}
