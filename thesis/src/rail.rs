//! Mesh of the rail: a plate whose top runs from `(−b/2, 0)` to `(b/2, 0)`, refined under the contact (\[A] § 3.1, \[C]
//! § 5.1).

use crate::mesh::Mesh;
use crate::rivara;

/// Length and height of the plate \[m].
#[derive(Clone, Copy, Debug)]
pub struct Plate {
    /// Length `b`.
    pub length: f64,
    /// Height `h`.
    pub height: f64,
}

/// Right triangles on `columns` by `rows` nodes, whose diagonals alternate.
pub fn coarse(plate: Plate, columns: usize, rows: usize) -> Mesh {
    let mut mesh = Mesh::default();
    let share = |i: usize, count: usize| i as f64 / (count - 1) as f64;
    for j in 0..rows {
        for i in 0..columns {
            mesh.nodes.push([plate.length * (share(i, columns) - 0.5), plate.height * (share(j, rows) - 1.0)]);
        }
    }
    for j in 0..rows - 1 {
        for i in 0..columns - 1 {
            let a = j * columns + i;
            let (b, c, d) = (a + 1, a + columns, a + columns + 1);
            mesh.triangles.extend(if (i + j) % 2 == 0 { [[a, b, d], [a, d, c]] } else { [[a, b, c], [b, d, c]] });
        }
    }
    mesh
}

/// The thesis's plate: `columns` by seven nodes, refined in a box of `2 patch × patch` \[m] under the contact until
/// edges are shorter than `size` \[m].
pub fn rolling(plate: Plate, columns: usize, patch: f64, size: f64) -> Mesh {
    refined(coarse(plate, columns, 7), patch, size)
}

/// A mesh refined in a box of `2 patch × patch` \[m] about the origin until edges are shorter than `size` \[m].
pub fn refined(mut mesh: Mesh, patch: f64, size: f64) -> Mesh {
    let reaches = |corners: &[[f64; 2]; 3]| {
        let (left, right) = (corners.iter().map(|c| c[0]), corners.iter().map(|c| c[0]));
        let (left, right) = (left.fold(f64::INFINITY, f64::min), right.fold(f64::NEG_INFINITY, f64::max));
        let top = corners.iter().fold(f64::NEG_INFINITY, |most, c| most.max(c[1]));
        left < patch && right > -patch && top > -patch
    };
    rivara::refine_while(&mut mesh, |corners| reaches(corners) && rivara::longest(corners) > size * size);
    mesh
}
