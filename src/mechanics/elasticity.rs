//! Linear elasticity in plane strain: stiffness and mass of one cell.

use crate::config::Material;
use crate::fem::Point;
use crate::fem::assembly::{ElementMatrix, both_components};

/// Lamé constants `λ`, `μ` [Pa].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lame {
    pub lambda: f64,
    pub mu: f64,
}

impl From<&Material> for Lame {
    fn from(material: &Material) -> Self {
        let (e, nu) = (material.youngs_modulus, material.poissons_ratio);
        Self { lambda: e * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)), mu: 0.5 * e / (1.0 + nu) }
    }
}

impl Lame {
    /// `σ = λ tr(ε) 1 + 2 μ ε` [Pa] for a displacement gradient `∂u_a/∂x_b`.
    pub fn stress(&self, gradient: [[f64; 2]; 2]) -> [[f64; 2]; 2] {
        let volume = self.lambda * (gradient[0][0] + gradient[1][1]);
        let shear = self.mu * (gradient[0][1] + gradient[1][0]);
        [[volume + 2.0 * self.mu * gradient[0][0], shear], [shear, volume + 2.0 * self.mu * gradient[1][1]]]
    }
}

/// `∫ ε(w) : σ(u) dA` [N/m per m].
pub fn stiffness(points: &[Point; 4], lame: Lame) -> ElementMatrix {
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
pub fn mass(points: &[Point; 4], density: f64) -> ElementMatrix {
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
