//! Linear triangles in plane strain, and what a stationary stream of material adds (\[B] 33, stationary): matrices without
//! velocities, as the decomposition of \[D] 20 wants them.

use crate::mesh::{Mesh, double_area};
use crate::sparse::Matrix;
use crate::triangle::{Order, linear_gradients, points};

/// `∫ Bᵀ E B` \[Pa] for Young's modulus \[Pa] and Poisson's ratio; unknowns 2i and 2i + 1 of node i.
pub fn stiffness(mesh: &Mesh, young: f64, poisson: f64) -> Matrix {
    let shear = 0.5 * young / (1.0 + poisson);
    let lame = 2.0 * shear * poisson / (1.0 - 2.0 * poisson);
    assemble(mesh, |a, b, p, q, _| {
        let product = if p == q { a[0] * b[0] + a[1] * b[1] } else { 0.0 };
        lame * a[p] * b[q] + shear * (a[q] * b[p] + product)
    })
}

/// `ρ ∫ (v·∇N)ᵀ (v·∇N)` for a velocity field of unit coefficient; the stiffness of the stream is minus its square
/// times this.
pub fn convection(mesh: &Mesh, density: f64, velocity: impl Fn([f64; 2]) -> [f64; 2]) -> Matrix {
    // Linear functions have constant slopes: only the squares of the velocity are averaged, exactly.
    let squares = |t: usize| {
        let corners = mesh.corners(t);
        let area = 0.5 * double_area(&corners);
        let mut mean = [[0.0; 2]; 2];
        for point in points(&corners, Order::Linear) {
            let v = velocity(point.place);
            (0..2).for_each(|p| (0..2).for_each(|q| mean[p][q] += point.weight / area * v[p] * v[q]));
        }
        mean
    };
    assemble(mesh, |a, b, p, q, t| {
        let v = squares(t);
        let along: f64 = (0..2).map(|i| (0..2).map(|j| a[i] * v[i][j] * b[j]).sum::<f64>()).sum();
        if p == q { density * along } else { 0.0 }
    })
}

/// `ρ ∫ N X` \[kg]: the centrifugal load for a unit angular velocity about the origin.
pub fn centrifugal(mesh: &Mesh, density: f64) -> Vec<f64> {
    let mut load = vec![0.0; 2 * mesh.nodes.len()];
    for (t, triangle) in mesh.triangles.iter().enumerate() {
        for point in points(&mesh.corners(t), Order::Linear) {
            for (node, value) in triangle.iter().zip(point.shape.values) {
                (0..2).for_each(|axis| load[2 * node + axis] += density * point.weight * value * point.place[axis]);
            }
        }
    }
    load
}

/// Sums area times `entry(∇N_a, ∇N_b, p, q, triangle)` over all pairs of nodes and directions.
fn assemble(mesh: &Mesh, entry: impl Fn([f64; 2], [f64; 2], usize, usize, usize) -> f64) -> Matrix {
    let mut matrix = Matrix::new(2 * mesh.nodes.len());
    for (t, triangle) in mesh.triangles.iter().enumerate() {
        let corners = mesh.corners(t);
        let (area, slopes) = (0.5 * double_area(&corners), linear_gradients(&corners));
        for (a, i) in slopes.iter().zip(triangle) {
            for (b, j) in slopes.iter().zip(triangle) {
                for p in 0..2 {
                    for q in 0..2 {
                        matrix.add(2 * i + p, 2 * j + q, area * entry(*a, *b, p, q, t));
                    }
                }
            }
        }
    }
    matrix
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::wheel::coarse;

    #[test]
    fn rigid_motions_strain_nothing_and_a_turn_convects_like_its_own_centrifugal_load() {
        let mesh = coarse(&[0.1, 0.3, 0.5], 24);
        let stiffness = stiffness(&mesh, 200e9, 0.3);
        let field = |f: &dyn Fn([f64; 2]) -> [f64; 2]| mesh.nodes.iter().flat_map(|n| f(*n)).collect::<Vec<f64>>();
        for rigid in [field(&|_| [1.0, 0.0]), field(&|_| [0.0, 1.0]), field(&|[x, y]| [y, -x])] {
            assert!(stiffness.multiply(&rigid).iter().all(|force| force.abs() < 1e-2), "of 1e11");
        }
        // (v·∇)X = v and ∫ (v·∇N)·v = −∫ N (v·∇)v = ∫ N X for v = (y, −x), up to the chords of the rims.
        let turn = |[x, y]: [f64; 2]| [y, -x];
        let left = convection(&mesh, 8000.0, turn).multiply(&field(&|place| place));
        let right = centrifugal(&mesh, 8000.0);
        let inner = 24..48;
        let error = inner.map(|n| (left[2 * n] - right[2 * n]).abs()).fold(0.0, f64::max);
        let scale = right.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
        println!("{:.1e}", error / scale);
        assert!(error < 1e-12 * scale);
    }
}
