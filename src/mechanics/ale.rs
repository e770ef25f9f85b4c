//! Convective matrices of the streaming frame (arbitrary Lagrangian–Eulerian description).
//!
//! Material acceleration `(d_t + s ∂)² u` with stream speed `s` and streamline derivative `∂ = v̄·∇/s`:
//! `d_tt u + 2 s ∂ d_t u + ṡ ∂u + s² ∂∂u`. The weak form of the last term is `s² (−S + B)` with
//! `S = ρ ∫ ∂w·∂u dA` and the in/outflow (Robin) term `B = ρ ∮ (v̄·n/s) w·∂u ds` on ends that cross the stream
//! (Paper B, eq. 12). Source: Paper D, eq. 9 and appendix A.

use crate::fem::Point;
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
    pub fn convection(self, points: &[Point; 4], density: f64) -> ElementMatrix {
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

    /// `S = ρ ∫ ∂w·∂u dA`.
    pub fn curvature(self, points: &[Point; 4], density: f64) -> ElementMatrix {
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
