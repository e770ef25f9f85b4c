//! Meshes of the wheel: an annulus about the origin, refined after Rivara, with round rims and its centre of gravity
//! corrected (\[C] § 5.1).

use crate::Error;
use crate::elastic;
use crate::mesh::Mesh;
use crate::rivara;
use crate::triangle::{Order, Space};
use std::f64::consts::TAU;

/// Radii of an annulus \[m].
#[derive(Clone, Copy, Debug)]
pub struct Annulus {
    /// Of the tread.
    pub outer: f64,
    /// Of the hub.
    pub inner: f64,
}

/// Coarse mesh: two triangles for each of `sectors` and each of the rings between the `radii` \[m], from the hub
/// outward. A node of every ring lies on the negative y axis, where the contact is.
pub fn coarse(radii: &[f64], sectors: usize) -> Mesh {
    let mut mesh = Mesh::default();
    for (k, radius) in radii.iter().enumerate() {
        for i in 0..sectors {
            let angle = TAU * i as f64 / sectors as f64;
            mesh.nodes.push([radius * angle.sin(), -radius * angle.cos()]);
            if k + 1 < radii.len() {
                let (a, b) = (k * sectors + i, k * sectors + (i + 1) % sectors);
                let (c, d) = (a + sectors, b + sectors);
                // Diagonals alternate, so that the mesh has no sense of rotation.
                mesh.triangles.extend(if (i + k) % 2 == 0 { [[a, c, d], [a, d, b]] } else { [[a, c, b], [c, d, b]] });
            }
        }
    }
    mesh
}

/// Nodes of the rims: of the tread, then of the hub.
pub fn rims(mesh: &Mesh, annulus: Annulus) -> (Vec<usize>, Vec<usize>) {
    let mut nodes: Vec<usize> = mesh.boundary().into_iter().flat_map(|(a, b)| [a, b]).collect();
    nodes.sort_unstable();
    nodes.dedup();
    let middle = (annulus.outer * annulus.inner).sqrt();
    nodes.into_iter().partition(|node| mesh.nodes[*node][0].hypot(mesh.nodes[*node][1]) > middle)
}

/// Moves all nodes radially so that the tread becomes a circle, `r ← r_i + (r − r_i)(r_o − r_i)/(ρ(φ) − r_i)` with the
/// radius ρ of the polygon; then the nodes of the hub onto theirs.
pub fn make_round(mesh: &mut Mesh, annulus: Annulus) {
    let (tread, hub) = rims(mesh, annulus);
    let angle = |node: [f64; 2]| node[0].atan2(-node[1]).rem_euclid(TAU);
    let mut corners: Vec<(f64, [f64; 2])> = tread.iter().map(|n| (angle(mesh.nodes[*n]), mesh.nodes[*n])).collect();
    corners.sort_by(|a, b| a.0.total_cmp(&b.0));
    let polygon = |phi: f64| {
        let above = corners.partition_point(|corner| corner.0 <= phi) % corners.len();
        let (a, b) = (corners[(above + corners.len() - 1) % corners.len()].1, corners[above].1);
        // Where the ray from the centre meets the line through a and b.
        let (s, c) = phi.sin_cos();
        (a[0] * b[1] - a[1] * b[0]) / (s * (b[1] - a[1]) + c * (b[0] - a[0]))
    };
    let width = annulus.outer - annulus.inner;
    for node in &mut mesh.nodes {
        let (radius, phi) = (node[0].hypot(node[1]), angle(*node));
        let round = annulus.inner + (radius - annulus.inner) * width / (polygon(phi) - annulus.inner);
        *node = [round * phi.sin(), -round * phi.cos()];
    }
    for (rim, radius) in [(tread, annulus.outer), (hub, annulus.inner)] {
        for node in rim {
            let phi = angle(mesh.nodes[node]);
            mesh.nodes[node] = [radius * phi.sin(), -radius * phi.cos()];
        }
    }
}

/// Moves the hub so that the centre of gravity of the mesh is where that of the annulus is, in the origin; inside,
/// nodes follow as an elastic body whose tread is held (Poisson's ratio `poisson`). Returns the way of the hub \[m].
///
/// A mesh without hub of area `A_h` has `A c = A_full c_full − A_h c_hub`; the full polygon stays, so the hub moves by
/// `A c/A_h`: a hundred times the error itself for a hub of a tenth of the radius.
pub fn centre(mesh: &mut Mesh, annulus: Annulus, poisson: f64) -> Result<[f64; 2], Error> {
    let (tread, hub) = rims(mesh, annulus);
    let hub_area = polygon_area(mesh, &hub);
    let (area, centroid) = (mesh.area(), mesh.centroid());
    let way = centroid.map(|c| area * c / hub_area);
    let mut matrix = elastic::stiffness(&Space::new(mesh, Order::Linear), 1.0, poisson);
    let fixed: Vec<usize> = tread.iter().chain(&hub).flat_map(|node| [2 * node, 2 * node + 1]).collect();
    let mut load = vec![0.0; matrix.size];
    hub.iter().for_each(|node| (0..2).for_each(|axis| load[2 * node + axis] = way[axis]));
    matrix.fix(&fixed);
    let moved = matrix.factorise()?.solve(load)?;
    for (node, shift) in mesh.nodes.iter_mut().zip(moved.as_chunks::<2>().0) {
        node[0] += shift[0];
        node[1] += shift[1];
    }
    Ok(way)
}

/// Area \[m²] within nodes of a circle about the origin.
fn polygon_area(mesh: &Mesh, nodes: &[usize]) -> f64 {
    let mut corners: Vec<[f64; 2]> = nodes.iter().map(|node| mesh.nodes[*node]).collect();
    corners.sort_by(|a, b| a[1].atan2(a[0]).total_cmp(&b[1].atan2(b[0])));
    let next = |i: usize| corners[(i + 1) % corners.len()];
    corners.iter().enumerate().map(|(i, a)| 0.5 * (a[0] * next(i)[1] - a[1] * next(i)[0])).sum()
}

/// Mesh of a rolling wheel as \[C] § 5.1 builds it: refined about the contact, as `graded` does, until the edges there
/// would be shorter than `size` \[m] after `global` refinements of everything, each of which halves areas; then the
/// longest edges of the tread, the round rims, and the centre of gravity.
pub fn rolling(annulus: Annulus, patch: f64, size: f64, global: usize, poisson: f64) -> Result<Mesh, Error> {
    let mut mesh = graded(annulus, patch, size * 2.0_f64.powf(0.5 * global as f64), global);
    refine_tread(&mut mesh, annulus);
    make_round(&mut mesh, annulus);
    centre(&mut mesh, annulus, poisson)?;
    Ok(mesh)
}

/// Mesh of a rolling wheel as \[A] § 3.1 builds it: refined about the contact, then as a whole, then with round rims.
pub fn early(annulus: Annulus, patch: f64, base: f64, global: usize) -> Mesh {
    let mut mesh = graded(annulus, patch, base, global);
    make_round(&mut mesh, annulus);
    mesh
}

/// Refined in ever smaller discs about the contact, the last one with a radius of at least `patch` \[m], until edges
/// there are shorter than `base` \[m]; then `global` refinements of everything.
fn graded(annulus: Annulus, patch: f64, base: f64, global: usize) -> Mesh {
    let mut mesh = coarse(&[annulus.inner, (annulus.inner * annulus.outer).sqrt(), annulus.outer], 12);
    let mut disc = 0.5 * annulus.outer;
    while disc > patch {
        let within = |corner: &[f64; 2]| corner[0].hypot(corner[1] + annulus.outer) < disc;
        let coarse = if disc < 2.0 * patch { base } else { 0.5 * disc };
        rivara::refine_while(&mut mesh, |corners| {
            corners.iter().any(within) && rivara::longest(corners) > coarse * coarse
        });
        disc *= 0.5;
    }
    rivara::refine_all(&mut mesh, global);
    mesh
}

/// Cuts triangles at the tread until no edge of it is longer than a fiftieth of its length.
fn refine_tread(mesh: &mut Mesh, annulus: Annulus) {
    let (longest, middle) = (TAU * annulus.outer / 50.0, (annulus.outer * annulus.inner).sqrt());
    loop {
        let on_tread = |node: usize| mesh.nodes[node][0].hypot(mesh.nodes[node][1]) > middle;
        let length =
            |(a, b): (usize, usize)| (mesh.nodes[a][0] - mesh.nodes[b][0]).hypot(mesh.nodes[a][1] - mesh.nodes[b][1]);
        let boundary = mesh.boundary();
        let long: std::collections::BTreeSet<_> =
            boundary.into_iter().filter(|e| on_tread(e.0) && on_tread(e.1) && length(*e) > longest).collect();
        let marked: Vec<usize> = (0..mesh.triangles.len())
            .filter(|t| crate::mesh::edges(mesh.triangles[*t]).iter().any(|edge| long.contains(edge)))
            .collect();
        if marked.is_empty() {
            return;
        }
        rivara::refine(mesh, &marked);
    }
}
