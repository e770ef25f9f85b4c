//! Linear elasticity in plane strain: stiffness and mass of one cell.

use crate::fem::CellPoint;
use crate::fem::assembly::{ElementMatrix, both_components};
use crate::material::Isotropic;

/// Lamé constants `λ`, `μ` \[Pa].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lame {
    /// First constant \[Pa].
    pub lambda: f64,
    /// Second constant, the shear modulus \[Pa].
    pub mu: f64,
}

impl From<&Isotropic> for Lame {
    fn from(material: &Isotropic) -> Self {
        Self { lambda: material.lame(), mu: material.shear_modulus() }
    }
}

impl Lame {
    /// `σ = λ tr(ε) 1 + 2 μ ε` \[Pa] for a displacement gradient `∂u_a/∂x_b`.
    pub fn stress(&self, gradient: [[f64; 2]; 2]) -> [[f64; 2]; 2] {
        let volume = self.lambda * (gradient[0][0] + gradient[1][1]);
        let shear = self.mu * (gradient[0][1] + gradient[1][0]);
        [[volume + 2.0 * self.mu * gradient[0][0], shear], [shear, volume + 2.0 * self.mu * gradient[1][1]]]
    }
}

/// `∫ ε(w) : σ(u) dA` [N/m per m].
pub fn stiffness(points: &[CellPoint; 4], lame: Lame) -> ElementMatrix {
    let mut matrix = [[0.0; 8]; 8];
    for p in points {
        for (i, gi) in p.gradient.iter().enumerate() {
            for (j, gj) in p.gradient.iter().enumerate() {
                let scalar = gi[0] * gj[0] + gi[1] * gj[1];
                for a in 0..2 {
                    for b in 0..2 {
                        let mut k = lame.lambda * gi[a] * gj[b] + lame.mu * gi[b] * gj[a];
                        if a == b {
                            k += lame.mu * scalar;
                        }
                        matrix[2 * i + a][2 * j + b] += k * p.dv;
                    }
                }
            }
        }
    }
    matrix
}

/// Consistent mass `ρ ∫ w·u dA` [kg/m].
pub fn mass(points: &[CellPoint; 4], density: f64) -> ElementMatrix {
    let mut matrix = [[0.0; 4]; 4];
    for p in points {
        for (row, ni) in matrix.iter_mut().zip(p.shape) {
            for (m, nj) in row.iter_mut().zip(p.shape) {
                *m += density * ni * nj * p.dv;
            }
        }
    }
    both_components(&matrix)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fem::{DofMap, Mesh, assemble, assemble_vector, element};
    use crate::linalg::Cholesky;
    use crate::mechanics::testing::{annulus, paper_d, square, square_boundary};
    use std::f64::consts::PI;

    fn lame() -> Lame {
        Lame::from(&paper_d(4).material)
    }

    fn linear([x, y]: [f64; 2]) -> [f64; 2] {
        [1e-3 * (1.0 + 2.0 * x - 3.0 * y), 1e-3 * (-2.0 + 0.5 * x + 4.0 * y)]
    }

    /// Solution of `−div σ = force` with the given displacement on the boundary, at all nodes.
    fn solve(mesh: &mut Mesh, boundary: fn([f64; 2]) -> [f64; 2], force: fn([f64; 2]) -> [f64; 2]) -> Vec<[f64; 2]> {
        mesh.fixed = square_boundary(mesh);
        let dofs = DofMap::new(mesh);
        let stiff = |p: &[CellPoint; 4]| stiffness(p, lame());
        let on_edge = |x: [f64; 2]| x.iter().any(|v| v.abs() < 1e-12 || (v - 1.0).abs() < 1e-12);
        let lifted = |x| if on_edge(x) { boundary(x) } else { [0.0; 2] };
        let k = assemble(mesh, &dofs, stiff).unwrap();
        let mut u = assemble_vector(mesh, &dofs, |p| mass(p, 1.0), force).unwrap();
        u -= assemble_vector(mesh, &dofs, stiff, lifted).unwrap();
        Cholesky::new(&k).unwrap().solve_in_place(u.as_mut_slice());
        let value = |node: usize, c| dofs.unknown(node, c).map_or(boundary(mesh.nodes[node])[c], |i| u[i]);
        (0..mesh.nodes.len()).map(|node| [value(node, 0), value(node, 1)]).collect()
    }

    #[test]
    fn patch_test_constant_strain_is_reproduced_on_a_distorted_mesh() {
        let mut mesh = square(6, 0.25);
        let u = solve(&mut mesh, linear, |_| [0.0; 2]);
        for (value, x) in u.iter().zip(&mesh.nodes) {
            let exact = linear(*x);
            assert!((value[0] - exact[0]).abs() < 1e-15 && (value[1] - exact[1]).abs() < 1e-15);
        }
        let stress = lame().stress([[2e-3, -3e-3], [0.5e-3, 4e-3]]);
        assert!((stress[0][1] - 2e11 / 2.6 * -2.5e-3).abs() < 1e-3);
        // Plane strain: σ_xx = E/((1+ν)(1−2ν)) ((1−ν) ε_x + ν ε_y).
        assert!((stress[0][0] / (2e11 / 0.52 * (0.7 * 2e-3 + 0.3 * 4e-3)) - 1.0).abs() < 1e-13);
    }

    #[test]
    fn rigid_motions_are_free_of_stress() {
        let mesh = annulus(0.5, 0.05, 24, 6);
        let dofs = DofMap::new(&mesh);
        for field in [|_| [1.0, 0.0], |_| [0.0, 1.0], |[x, y]: [f64; 2]| [y, -x]] {
            let f = assemble_vector(&mesh, &dofs, |p| stiffness(p, lame()), field).unwrap();
            assert!(f.amax() < 1e-14 * 2e11, "{:e} N/m", f.amax());
        }
    }

    #[test]
    fn manufactured_displacement_converges_with_order_two() {
        fn exact([x, y]: [f64; 2]) -> [f64; 2] {
            let s = (PI * x).sin() * (PI * y).sin();
            [s, -s]
        }
        fn force([x, y]: [f64; 2]) -> [f64; 2] {
            let Lame { lambda, mu } = lame();
            let (s, c) = ((PI * x).sin() * (PI * y).sin(), (PI * x).cos() * (PI * y).cos());
            let each = PI * PI * ((lambda + mu) * (s + c) + 2.0 * mu * s);
            [each, -each]
        }
        let error = |n: usize| -> f64 {
            let mut mesh = square(n, 0.1);
            let u = solve(&mut mesh, |_| [0.0; 2], force);
            let mut sum = 0.0;
            for (cell, nodes) in mesh.cells.iter().enumerate() {
                for p in element::points(&mesh.corners(cell)).unwrap() {
                    for (c, exact) in exact(p.position).iter().enumerate() {
                        let value: f64 = (0..4).map(|i| p.shape[i] * u[nodes[i]][c]).sum();
                        sum += (value - exact).powi(2) * p.dv;
                    }
                }
            }
            sum.sqrt()
        };
        let order = (error(24) / error(48)).log2();
        assert!((order - 2.0).abs() < 0.1, "observed order {order:.3}");
    }
}
