//! Longest-edge refinement of triangles after M. C. Rivara, *Int. J. Numer. Methods Engng* 20 (1984) 745–756: the only
//! refinement of the thesis (\[A] § 3.1, \[B] § 6.2).
//!
//! From a triangle that is to be cut one follows longest edges, each to the neighbour behind it, until both sides agree
//! on the longest one or the boundary is reached. That edge is halved on both sides, and the walk begins again until
//! the triangle itself is cut. Meshes stay conforming, and no angle falls below half the smallest one at the beginning.

use crate::mesh::{Mesh, edge, edges};
use std::collections::HashMap;

/// Triangles beside each edge.
type Neighbours = HashMap<(usize, usize), [Option<usize>; 2]>;

/// Cuts each of the `marked` triangles at least once; one that a neighbour's walk has cut already is done.
pub fn refine(mesh: &mut Mesh, marked: &[usize]) {
    let mut beside = Neighbours::new();
    for (t, triangle) in mesh.triangles.iter().enumerate() {
        edges(*triangle).into_iter().for_each(|edge| replace(&mut beside, edge, None, Some(t)));
    }
    let before: Vec<[usize; 3]> = marked.iter().map(|t| mesh.triangles[*t]).collect();
    for (&t, before) in marked.iter().zip(before) {
        while mesh.triangles[t] == before {
            let terminal = terminal_edge(mesh, &beside, t);
            bisect(mesh, &mut beside, terminal);
        }
    }
}

/// Cuts every triangle at least `times` times.
pub fn refine_all(mesh: &mut Mesh, times: usize) {
    for _ in 0..times {
        refine(mesh, &(0..mesh.triangles.len()).collect::<Vec<_>>());
    }
}

/// Refines until no triangle satisfies `coarse`, which sees its corners.
pub fn refine_while(mesh: &mut Mesh, coarse: impl Fn(&[[f64; 2]; 3]) -> bool) {
    loop {
        let marked: Vec<usize> = (0..mesh.triangles.len()).filter(|t| coarse(&mesh.corners(*t))).collect();
        if marked.is_empty() {
            return;
        }
        refine(mesh, &marked);
    }
}

/// Squared length of the longest edge \[m²].
pub fn longest(corners: &[[f64; 2]; 3]) -> f64 {
    (0..3).fold(0.0, |most, i| {
        let (a, b) = (corners[i], corners[(i + 1) % 3]);
        f64::max(most, (a[0] - b[0]).powi(2) + (a[1] - b[1]).powi(2))
    })
}

/// The longest edge of a triangle. Edges of equal length are told apart by their nodes: all triangles agree on one
/// order of all edges, so that walks along growing edges end even where whole meshes have equal diagonals.
fn longest_edge(mesh: &Mesh, t: usize) -> (usize, usize) {
    let length = |(a, b): (usize, usize)| {
        let (a, b) = (mesh.nodes[a], mesh.nodes[b]);
        (a[0] - b[0]).powi(2) + (a[1] - b[1]).powi(2)
    };
    let [a, b, c] = edges(mesh.triangles[t]);
    let longer = |a, b| if (length(a), a) > (length(b), b) { a } else { b };
    longer(longer(a, b), c)
}

/// End of the walk along longest edges that begins in triangle `t`.
fn terminal_edge(mesh: &Mesh, beside: &Neighbours, mut t: usize) -> (usize, usize) {
    let mut edge = longest_edge(mesh, t);
    loop {
        let Some(behind) = beside[&edge].iter().flatten().copied().find(|other| *other != t) else { return edge };
        let next = longest_edge(mesh, behind);
        if next == edge {
            return edge;
        }
        (t, edge) = (behind, next);
    }
}

/// Halves an edge and the triangles beside it. One half keeps the number of its triangle.
fn bisect(mesh: &mut Mesh, beside: &mut Neighbours, cut: (usize, usize)) {
    let middle = mesh.nodes.len();
    let (p, q) = (mesh.nodes[cut.0], mesh.nodes[cut.1]);
    mesh.nodes.push([0.5 * (p[0] + q[0]), 0.5 * (p[1] + q[1])]);
    let both = beside.remove(&cut).unwrap_or_default();
    for t in both.into_iter().flatten() {
        let triangle = mesh.triangles[t];
        // Turned so that the edge runs from the first corner to the second.
        let turn = (0..3).find(|i| edges(triangle)[*i] == cut).unwrap_or_default();
        let [a, b, c] = [triangle[turn], triangle[(turn + 1) % 3], triangle[(turn + 2) % 3]];
        let new = mesh.triangles.len();
        mesh.triangles[t] = [a, middle, c];
        mesh.triangles.push([middle, b, c]);
        replace(beside, edge(b, c), Some(t), Some(new));
        replace(beside, edge(a, middle), None, Some(t));
        replace(beside, edge(middle, b), None, Some(new));
        beside.insert(edge(middle, c), [Some(t), Some(new)]);
    }
}

/// Puts `new` in the place of `old` beside an edge.
fn replace(beside: &mut Neighbours, edge: (usize, usize), old: Option<usize>, new: Option<usize>) {
    if let Some(slot) = beside.entry(edge).or_default().iter_mut().find(|slot| **slot == old) {
        *slot = new;
    }
}
