//! Convective matrices of the streaming frame (arbitrary Lagrangian–Eulerian description).
//!
//! Material acceleration `(d_t + s ∂)² u` with stream speed `s` and streamline derivative `∂ = v̄·∇/s`:
//! `d_tt u + 2 s ∂ d_t u + ṡ ∂u + s² ∂∂u`. The weak form of the last term is `s² (−S + B)` with
//! `S = ρ ∫ ∂w·∂u dA` and the in/outflow (Robin) term `B = ρ ∮ (v̄·n/s) w·∂u ds` on ends that cross the stream
//! (Paper B, eq. 12). Source: Paper D, eq. 9 and appendix A.

use crate::fem::CellPoint;
use crate::fem::assembly::{ElementMatrix, both_components};
use crate::fem::element::EdgePoint;

/// How the material streams through a body; the speed is `Ω` or `V`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stream {
    /// Wheel rolling forward (clockwise): `v̄/Ω = (y, −x)`.
    Rotation,
    /// Rail seen from the wheel: `v̄/V = (−1, 0)`.
    Translation,
}

impl Stream {
    /// `v̄` per unit speed.
    pub fn direction(self, [x, y]: [f64; 2]) -> [f64; 2] {
        match self {
            Self::Rotation => [y, -x],
            Self::Translation => [-1.0, 0.0],
        }
    }

    /// `∂N_i`.
    fn derivative(self, position: [f64; 2], gradient: &[[f64; 2]; 4]) -> [f64; 4] {
        let v = self.direction(position);
        gradient.map(|g| v[0] * g[0] + v[1] * g[1])
    }

    /// `C = ρ ∫ w·∂u dA`.
    pub fn gyroscopic(self, points: &[CellPoint; 4], density: f64) -> ElementMatrix {
        let mut matrix = [[0.0; 4]; 4];
        for p in points {
            let derivative = self.derivative(p.position, &p.gradient);
            for (row, n) in matrix.iter_mut().zip(p.shape) {
                for (c, d) in row.iter_mut().zip(derivative) {
                    *c += density * n * d * p.dv;
                }
            }
        }
        both_components(&matrix)
    }

    /// `T = ρ ∫ w·(∂u − W u) dA`: the streamline derivative as the material sees it. `W a = (a_y, −a_x)` turns a vector
    /// with the wheel; a field that only turns with the wheel has `∂u = W u`. Nothing turns in the rail.
    pub fn transport(self, points: &[CellPoint; 4], density: f64) -> ElementMatrix {
        let mut matrix = self.gyroscopic(points, density);
        if self == Self::Rotation {
            for p in points {
                for (i, ni) in p.shape.iter().enumerate() {
                    for (j, nj) in p.shape.iter().enumerate() {
                        let mass = density * ni * nj * p.dv;
                        matrix[2 * i][2 * j + 1] -= mass;
                        matrix[2 * i + 1][2 * j] += mass;
                    }
                }
            }
        }
        matrix
    }

    /// `ρ ∫ (∂w − W w)·(∂u − W u) dA` of the wheel: `n²` times the mass for a field with `n` nodal diameters.
    pub fn squared_diameters(points: &[CellPoint; 4], density: f64) -> ElementMatrix {
        const TURN: [[f64; 2]; 2] = [[0.0, 1.0], [-1.0, 0.0]];
        let mut matrix = [[0.0; 8]; 8];
        for p in points {
            let derivative = Self::Rotation.derivative(p.position, &p.gradient);
            for (i, (ni, di)) in p.shape.iter().zip(derivative).enumerate() {
                for (j, (nj, dj)) in p.shape.iter().zip(derivative).enumerate() {
                    for (a, turn) in TURN.iter().enumerate() {
                        for (b, w) in turn.iter().enumerate() {
                            let alike = if a == b { di * dj + ni * nj } else { 0.0 };
                            matrix[2 * i + a][2 * j + b] += density * (alike + w * (ni * dj - di * nj)) * p.dv;
                        }
                    }
                }
            }
        }
        matrix
    }

    /// `ρ ∫ (w·t)(u·t) dA` of the wheel with the unit vector `t` along the circles.
    pub fn circumferential_mass(points: &[CellPoint; 4], density: f64) -> ElementMatrix {
        let mut matrix = [[0.0; 8]; 8];
        for p in points {
            let v = Self::Rotation.direction(p.position);
            let square = v[0] * v[0] + v[1] * v[1];
            for (row, line) in matrix.iter_mut().enumerate() {
                for (column, value) in line.iter_mut().enumerate() {
                    let shapes = p.shape[row / 2] * p.shape[column / 2];
                    *value += density * shapes * v[row % 2] * v[column % 2] / square * p.dv;
                }
            }
        }
        matrix
    }

    /// `S = ρ ∫ ∂w·∂u dA`.
    pub fn ale_inertia(self, points: &[CellPoint; 4], density: f64) -> ElementMatrix {
        let mut matrix = [[0.0; 4]; 4];
        for p in points {
            let derivative = self.derivative(p.position, &p.gradient);
            for (row, di) in matrix.iter_mut().zip(derivative) {
                for (s, dj) in row.iter_mut().zip(derivative) {
                    *s += density * di * dj * p.dv;
                }
            }
        }
        both_components(&matrix)
    }

    /// `B = ρ ∮ (v̄·n) w·∂u ds` on one face, per unit speed squared.
    pub fn outflow(self, points: &[EdgePoint; 2], density: f64) -> ElementMatrix {
        let mut matrix = [[0.0; 4]; 4];
        for p in points {
            let v = self.direction(p.position);
            let flux = v[0] * p.normal[0] + v[1] * p.normal[1];
            let derivative = self.derivative(p.position, &p.gradient);
            for (row, n) in matrix.iter_mut().zip(p.shape) {
                for (b, d) in row.iter_mut().zip(derivative) {
                    *b += density * flux * n * d;
                }
            }
        }
        both_components(&matrix)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fem::{DofMap, assemble, assemble_faces, assemble_vector};
    use crate::mechanics::elasticity::mass;
    use crate::mechanics::testing::{annulus, paper_d};
    use crate::mechanics::{rail_mesh, wheel_system};

    #[test]
    fn gyroscopic_matrix_of_the_wheel_is_antisymmetric() {
        let (outer, around) = (0.5, 48);
        let mesh = annulus(outer, 0.05, around, 8);
        let dofs = DofMap::new(&mesh);
        let c = assemble(&mesh, &dofs, |p| Stream::Rotation.gyroscopic(p, 8000.0)).unwrap();
        let boundary = |i: usize| i / 2 < around || i / 2 >= 8 * around;
        let (mut largest, mut inside, mut rim) = (0.0_f64, 0.0_f64, 0.0_f64);
        for i in 0..c.rows() {
            for (j, value) in c.row(i) {
                let sum = (value + c.get(j, i)).abs();
                largest = largest.max(value.abs());
                if boundary(i) && boundary(j) { rim = rim.max(sum) } else { inside = inside.max(sum) }
            }
        }
        assert!(inside < 1e-14 * largest, "inside {:e}", inside / largest);
        // Chords let v̄·n ≠ 0 through, with zero mean over each chord.
        assert!(rim < 0.05 * largest, "rim {:e}", rim / largest);
    }

    #[test]
    fn ale_inertia_of_the_wheel_is_symmetric_and_not_negative() {
        let system = wheel_system(&paper_d(4)).unwrap();
        let s = &system.ale_inertia;
        let largest = (0..s.rows()).map(|i| s.get(i, i)).fold(0.0, f64::max);
        for i in 0..s.rows() {
            for (j, value) in s.row(i) {
                assert!((value - s.get(j, i)).abs() < 1e-13 * largest);
            }
        }
        let x: Vec<f64> = (0..s.rows()).map(|i| ((i * 37) % 101) as f64 - 50.0).collect();
        assert!(s.bilinear(&x, &x) > 0.0);
    }

    #[test]
    fn streamline_derivative_of_a_linear_field_is_exact() {
        let wheel = annulus(0.5, 0.1, 20, 4);
        let rail = rail_mesh(&paper_d(4)).unwrap();
        let field = |[x, y]: [f64; 2]| [2.0 * x + 3.0 * y, 5.0 * x - y];
        let in_wheel = |[x, y]: [f64; 2]| [2.0 * y - 3.0 * x, 5.0 * y + x];
        let in_rail = |_: [f64; 2]| [-2.0, -5.0];
        for (mesh, stream, derivative) in [
            (&wheel, Stream::Rotation, &in_wheel as &dyn Fn([f64; 2]) -> [f64; 2]),
            (&rail, Stream::Translation, &in_rail),
        ] {
            let dofs = DofMap::new(mesh);
            let convected = assemble_vector(mesh, &dofs, |p| stream.gyroscopic(p, 8e3), field).unwrap();
            let exact = assemble_vector(mesh, &dofs, |p| mass(p, 8e3), derivative).unwrap();
            assert!((convected - &exact).amax() < 1e-13 * exact.amax());
        }
    }

    #[test]
    fn robin_term_makes_the_free_ends_blind_to_uniform_stretch() {
        let mesh = rail_mesh(&paper_d(4)).unwrap();
        let dofs = DofMap::new(&mesh);
        let inner = assemble(&mesh, &dofs, |p| Stream::Translation.ale_inertia(p, 1.0)).unwrap();
        let ends = assemble_faces(&mesh, &dofs, |p| Stream::Translation.outflow(p, 1.0)).unwrap();
        // Rows away from the fixed base of (S − B) times u = (x, 0), for which ∂∂u = 0.
        let mut u = vec![0.0; dofs.len()];
        for (k, node) in mesh.nodes.iter().enumerate() {
            if let Some(i) = dofs.unknown(k, 0) {
                u[i] = node[0];
            }
        }
        let (mut s, mut b) = (vec![0.0; u.len()], vec![0.0; u.len()]);
        inner.multiply(&u, &mut s);
        ends.multiply(&u, &mut b);
        let row_above_base = mesh.nodes[mesh.fixed[0] - mesh.fixed.len()][1];
        let (mut difference, mut size) = (0.0_f64, 0.0_f64);
        for (k, node) in mesh.nodes.iter().enumerate() {
            if let (Some(i), true) = (dofs.unknown(k, 0), node[1] > row_above_base) {
                difference = difference.max((s[i] - b[i]).abs());
                size = size.max(b[i].abs());
            }
        }
        assert!(difference < 1e-12 * size, "{difference:e} against {size:e}");
    }
}
