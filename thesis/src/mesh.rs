//! Conforming meshes of triangles.

use std::collections::BTreeMap;

/// Triangles with corners counter-clockwise; each edge belongs to one triangle (boundary) or two.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// Places of the nodes \[m].
    pub nodes: Vec<[f64; 2]>,
    /// Corners of each triangle.
    pub triangles: Vec<[usize; 3]>,
}

/// An edge by its nodes, the smaller one first: the same from both sides.
pub fn edge(a: usize, b: usize) -> (usize, usize) {
    (a.min(b), a.max(b))
}

/// Edges of a triangle; the one with index i runs from corner i to the next.
pub fn edges(triangle: [usize; 3]) -> [(usize, usize); 3] {
    let [a, b, c] = triangle;
    [edge(a, b), edge(b, c), edge(c, a)]
}

/// Twice the area of a triangle \[m²], positive if its corners run counter-clockwise.
pub fn double_area(corners: &[[f64; 2]; 3]) -> f64 {
    let [a, b, c] = corners;
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// Smallest angle of a triangle \[rad].
pub fn smallest_angle(corners: &[[f64; 2]; 3]) -> f64 {
    let angle = |i: usize| {
        let [a, b, c] = [corners[i], corners[(i + 1) % 3], corners[(i + 2) % 3]];
        let (p, q) = ([b[0] - a[0], b[1] - a[1]], [c[0] - a[0], c[1] - a[1]]);
        (p[0] * q[1] - p[1] * q[0]).atan2(p[0] * q[0] + p[1] * q[1])
    };
    angle(0).min(angle(1)).min(angle(2))
}

impl Mesh {
    /// Corners of triangle `t` \[m].
    pub fn corners(&self, t: usize) -> [[f64; 2]; 3] {
        self.triangles[t].map(|node| self.nodes[node])
    }

    /// Area \[m²].
    pub fn area(&self) -> f64 {
        (0..self.triangles.len()).map(|t| 0.5 * double_area(&self.corners(t))).sum()
    }

    /// Centroid \[m].
    pub fn centroid(&self) -> [f64; 2] {
        let mut sum = [0.0; 2];
        for corners in (0..self.triangles.len()).map(|t| self.corners(t)) {
            let weight = double_area(&corners) / 6.0;
            corners.iter().for_each(|corner| (0..2).for_each(|i| sum[i] += weight * corner[i]));
        }
        sum.map(|value| value / self.area())
    }

    /// Smallest angle of all triangles \[rad].
    pub fn smallest_angle(&self) -> f64 {
        (0..self.triangles.len()).fold(f64::INFINITY, |least, t| least.min(smallest_angle(&self.corners(t))))
    }

    /// How many triangles each edge has.
    pub fn edge_counts(&self) -> BTreeMap<(usize, usize), usize> {
        let mut counts = BTreeMap::new();
        for triangle in &self.triangles {
            edges(*triangle).into_iter().for_each(|edge| *counts.entry(edge).or_insert(0) += 1);
        }
        counts
    }

    /// Edges of the boundary.
    pub fn boundary(&self) -> Vec<(usize, usize)> {
        self.edge_counts().into_iter().filter(|(_, count)| *count == 1).map(|(edge, _)| edge).collect()
    }

    /// True if no edge belongs to more than two triangles, every triangle runs counter-clockwise and no node lies on an
    /// edge of the boundary without being one of its ends, which is what a hanging node looks like.
    pub fn is_conforming(&self) -> bool {
        let sound = (0..self.triangles.len()).all(|t| double_area(&self.corners(t)) > 0.0);
        let boundary = self.boundary();
        let hangs = |&(a, b): &(usize, usize)| {
            let on = |node: usize| {
                let corners = [self.nodes[a], self.nodes[b], self.nodes[node]];
                let [p, q, x] = corners;
                let (along, length) = (
                    (x[0] - p[0]) * (q[0] - p[0]) + (x[1] - p[1]) * (q[1] - p[1]),
                    (q[0] - p[0]).powi(2) + (q[1] - p[1]).powi(2),
                );
                node != a
                    && node != b
                    && double_area(&corners).abs() < 1e-9 * length
                    && along > 1e-9 * length
                    && along < (1.0 - 1e-9) * length
            };
            boundary.iter().any(|(c, d)| on(*c) || on(*d))
        };
        sound && self.edge_counts().values().all(|count| *count <= 2) && !boundary.iter().any(hangs)
    }
}
