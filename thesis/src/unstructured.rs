//! Meshes without any order for the rotating annulus of \[B] § 4, "deliberately unstructured" there: refined after
//! Rivara, relaxed to triangles of good shape, then disturbed at random.

use crate::mesh::{Mesh, edges};
use crate::rivara;
use crate::wheel::{Annulus, coarse, make_round};
use std::collections::{BTreeSet, HashMap};

/// Rounds of relaxation: after that many the smallest angle no longer grows.
const ROUNDS: usize = 20;

/// A mesh and how it is made.
#[derive(Clone, Copy, Debug)]
pub struct Unstructured {
    /// Longest edge before relaxation \[m].
    pub size: f64,
    /// Largest way of an inner node at random, over the distance to its nearest neighbour \[1].
    pub disorder: f64,
    /// Number that chooses among the random meshes.
    pub seed: u64,
}

impl Unstructured {
    /// The mesh of an annulus.
    pub fn mesh(self, annulus: Annulus) -> Mesh {
        // Rings that widen like the circles on which they lie: about equal sides everywhere.
        let rings = 4;
        let radius = |k: i32| annulus.inner * (annulus.outer / annulus.inner).powf(f64::from(k) / f64::from(rings));
        let mut mesh = coarse(&(0..=rings).map(radius).collect::<Vec<_>>(), 9);
        rivara::refine_while(&mut mesh, |corners| rivara::longest(corners) > self.size * self.size);
        make_round(&mut mesh, annulus);
        let inner = inner_nodes(&mesh);
        for _ in 0..ROUNDS {
            flip(&mut mesh);
            smooth(&mut mesh, &inner);
        }
        flip(&mut mesh);
        self.disturb(&mut mesh, &inner);
        flip(&mut mesh);
        mesh
    }

    fn disturb(self, mesh: &mut Mesh, inner: &[usize]) {
        let mut nearest = vec![f64::INFINITY; mesh.nodes.len()];
        for (a, b) in mesh.edge_counts().into_keys() {
            let (p, q) = (mesh.nodes[a], mesh.nodes[b]);
            let length = (p[0] - q[0]).hypot(p[1] - q[1]);
            nearest[a] = nearest[a].min(length);
            nearest[b] = nearest[b].min(length);
        }
        let mut state = self.seed;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
        };
        for &node in inner {
            let reach = self.disorder * nearest[node];
            mesh.nodes[node] = mesh.nodes[node].map(|x| x + reach * random());
        }
    }
}

/// Nodes that are not on the boundary.
fn inner_nodes(mesh: &Mesh) -> Vec<usize> {
    let boundary: BTreeSet<usize> = mesh.boundary().into_iter().flat_map(|(a, b)| [a, b]).collect();
    (0..mesh.nodes.len()).filter(|node| !boundary.contains(node)).collect()
}

/// Moves `inner` nodes, one after the other, to the mean of their neighbours.
fn smooth(mesh: &mut Mesh, inner: &[usize]) {
    let mut beside = vec![Vec::new(); mesh.nodes.len()];
    for (a, b) in mesh.edge_counts().into_keys() {
        beside[a].push(b);
        beside[b].push(a);
    }
    for &node in inner {
        let count = beside[node].len() as f64;
        mesh.nodes[node] =
            [0, 1].map(|axis| beside[node].iter().map(|other| mesh.nodes[*other][axis]).sum::<f64>() / count);
    }
}

/// Turns edges between two triangles until the mesh is one of Delaunay (Lawson 1977): no two angles that face each
/// other across an edge make more than half a turn.
fn flip(mesh: &mut Mesh) {
    loop {
        let mut beside: HashMap<(usize, usize), usize> = HashMap::new();
        let mut turned = BTreeSet::new();
        for t in 0..mesh.triangles.len() {
            for (k, edge) in edges(mesh.triangles[t]).into_iter().enumerate() {
                let Some(other) = beside.insert(edge, t) else { continue };
                if turned.contains(&t) || turned.contains(&other) {
                    continue;
                }
                let [a, b, c] = [0, 1, 2].map(|i| mesh.triangles[t][(k + i) % 3]);
                let Some(d) = mesh.triangles[other].into_iter().find(|node| *node != a && *node != b) else { continue };
                if cotangent(mesh, [c, a, b]) + cotangent(mesh, [d, b, a]) < -1e-9 {
                    (mesh.triangles[t], mesh.triangles[other]) = ([a, d, c], [d, b, c]);
                    turned.extend([t, other]);
                    break;
                }
            }
        }
        if turned.is_empty() {
            return;
        }
    }
}

/// Cotangent of the angle at the first of three nodes.
fn cotangent(mesh: &Mesh, [at, from, to]: [usize; 3]) -> f64 {
    let way = |node: usize| [0, 1].map(|axis| mesh.nodes[node][axis] - mesh.nodes[at][axis]);
    let (p, q) = (way(from), way(to));
    (p[0] * q[0] + p[1] * q[1]) / (p[0] * q[1] - p[1] * q[0])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn meshes_are_conforming_fill_the_annulus_have_good_angles_and_other_seeds_are_other_meshes() {
        let annulus = Annulus { outer: 0.5, inner: 0.05 };
        let [even, one, two] = [(0.0, 1), (0.2, 1), (0.2, 2)]
            .map(|(disorder, seed)| Unstructured { size: 0.085, disorder, seed }.mesh(annulus));
        for mesh in [&even, &one, &two] {
            println!("{} triangles, smallest angle {:.1}", mesh.triangles.len(), mesh.smallest_angle().to_degrees());
            assert!(mesh.is_conforming());
            assert!((mesh.area() / even.area() - 1.0).abs() < 1e-12);
            assert!(mesh.nodes.len() == even.nodes.len());
        }
        assert!(even.smallest_angle().to_degrees() > 30.0);
        let moved = |a: &Mesh, b: &Mesh| a.nodes.iter().zip(&b.nodes).filter(|(p, q)| p != q).count();
        assert_eq!(moved(&one, &two), inner_nodes(&even).len());
    }
}
