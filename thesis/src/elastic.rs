//! Linear triangles in plane strain, and what a stationary stream of material adds (\[B] 33, stationary): matrices without
//! velocities, as the decomposition of \[D] 20 wants them.

use crate::mesh::{Mesh, double_area};
use crate::rail::Plate;
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

/// `ρ ∫ N N` [kg/m]: the same in both directions.
pub fn mass(mesh: &Mesh, density: f64) -> Matrix {
    let mut matrix = Matrix::new(2 * mesh.nodes.len());
    for (t, triangle) in mesh.triangles.iter().enumerate() {
        let share = density * double_area(&mesh.corners(t)) / 24.0;
        for i in triangle {
            for j in triangle {
                let value = if i == j { 2.0 * share } else { share };
                (0..2).for_each(|axis| matrix.add(2 * i + axis, 2 * j + axis, value));
            }
        }
    }
    matrix
}

/// `ρ ∫ N (v·∇N)` [kg/(m s)] for a velocity field [m/s], to be taken twice the velocities of the nodes.
pub fn gyroscopic(mesh: &Mesh, density: f64, velocity: impl Fn([f64; 2]) -> [f64; 2]) -> Matrix {
    let mut matrix = Matrix::new(2 * mesh.nodes.len());
    for (t, triangle) in mesh.triangles.iter().enumerate() {
        let corners = mesh.corners(t);
        let slopes = linear_gradients(&corners);
        for point in points(&corners, Order::Linear) {
            let v = velocity(point.place);
            for (value, i) in point.shape.values.iter().zip(triangle) {
                for (slope, j) in slopes.iter().zip(triangle) {
                    let part = density * point.weight * value * (v[0] * slope[0] + v[1] * slope[1]);
                    (0..2).for_each(|axis| matrix.add(2 * i + axis, 2 * j + axis, part));
                }
            }
        }
    }
    matrix
}

/// `ρ ∮ (c_P n n + c_S t t) N N` [kg/(m s)] on the vertical ends of a plate (Lysmer and Kuhlemeyer; \[A] 2.5), for Young's modulus
/// \[Pa], Poisson's ratio and density [kg/m³].
pub fn dashpots(mesh: &Mesh, plate: Plate, [young, poisson, density]: [f64; 3]) -> Matrix {
    let shear = 0.5 * young / (1.0 + poisson);
    let pressure = 2.0 * shear * (1.0 - poisson) / (1.0 - 2.0 * poisson);
    let impedance = [pressure, shear].map(|modulus| (density * modulus).sqrt());
    let mut matrix = Matrix::new(2 * mesh.nodes.len());
    let at_end = |node: usize| mesh.nodes[node][0].abs() > 0.5 * plate.length - 1e-9;
    for (a, b) in mesh.boundary().into_iter().filter(|(a, b)| at_end(*a) && at_end(*b)) {
        let length = (mesh.nodes[a][1] - mesh.nodes[b][1]).abs();
        for (i, j, share) in [(a, a, 2.0), (b, b, 2.0), (a, b, 1.0), (b, a, 1.0)] {
            (0..2).for_each(|axis| matrix.add(2 * i + axis, 2 * j + axis, impedance[axis] * length * share / 6.0));
        }
    }
    matrix
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
