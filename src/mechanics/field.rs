//! Displacement, velocity and stress of a whole body, from the state of its full finite-element response.

use super::ale::Stream;
use super::elasticity::Lame;
use super::response::BodyState;
use super::{MechanicsError, rail_mesh, wheel_mesh};
use crate::config::{Config, Material};
use crate::fem::{DofMap, Mesh, element};

/// Corners of the reference cell in the order of a cell's nodes.
const CORNERS: [[f64; 2]; 4] = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];

/// Plane-strain stress [Pa].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Stress {
    pub xx: f64,
    pub yy: f64,
    pub xy: f64,
    /// Out of plane, `ν (σ_xx + σ_yy)`.
    pub zz: f64,
}

impl Stress {
    /// Equivalent stress of von Mises [Pa].
    pub fn von_mises(&self) -> f64 {
        let Self { xx, yy, xy, zz } = *self;
        (0.5 * ((xx - yy).powi(2) + (yy - zz).powi(2) + (zz - xx).powi(2)) + 3.0 * xy * xy).sqrt()
    }
}

/// Fields of one body at the nodes of its mesh, in the frame that moves with the wheel centre.
///
/// They answer contact tractions, inertia and centrifugal load; thermal strain is no part of them.
#[derive(Clone, Debug)]
pub struct BodyField {
    /// Undeformed; the wheel about its centre, the rail with the contact point at the origin.
    pub mesh: Mesh,
    /// Relative to hub or base [m].
    pub displacement: Vec<[f64; 2]>,
    /// Of the material, `v̄ + d_t u + v̄·∇u` with the stream `v̄` [m/s].
    pub velocity: Vec<[f64; 2]>,
    /// From displacement gradients averaged over the cells at a node.
    pub stress: Vec<Stress>,
}

/// Fields of the wheel that turns with `omega` [rad/s]; `None` if the state is not one of the full response.
pub fn wheel_field(config: &Config, state: &BodyState, omega: f64) -> Result<Option<BodyField>, MechanicsError> {
    BodyField::recover(wheel_mesh(config)?, &config.material, Stream::Rotation, state, omega)
}

/// Fields of the rail under a wheel that travels with `velocity` [m/s]; `None` as for the wheel.
pub fn rail_field(config: &Config, state: &BodyState, velocity: f64) -> Result<Option<BodyField>, MechanicsError> {
    BodyField::recover(rail_mesh(config)?, &config.material, Stream::Translation, state, velocity)
}

impl BodyField {
    fn recover(
        mesh: Mesh,
        material: &Material,
        stream: Stream,
        state: &BodyState,
        speed: f64,
    ) -> Result<Option<Self>, MechanicsError> {
        let dofs = DofMap::new(&mesh);
        if state.displacement.len() != dofs.len() {
            return Ok(None);
        }
        let nodal = |values: &[f64]| -> Vec<[f64; 2]> {
            let value = |node, component| dofs.unknown(node, component).map_or(0.0, |i| values[i]);
            (0..mesh.nodes.len()).map(|node| [value(node, 0), value(node, 1)]).collect()
        };
        let displacement = nodal(state.displacement.as_slice());
        let mut velocity = nodal(state.velocity.as_slice());
        let gradient = nodal_gradient(&mesh, &displacement)?;
        for ((velocity, position), gradient) in velocity.iter_mut().zip(&mesh.nodes).zip(&gradient) {
            let flow = stream.direction(*position).map(|v| speed * v);
            for (v, (own, row)) in velocity.iter_mut().zip(flow.iter().zip(gradient)) {
                *v += own + row[0] * flow[0] + row[1] * flow[1];
            }
        }
        let lame = Lame::from(material);
        let stress = gradient.iter().map(|gradient| {
            let [[xx, xy], [_, yy]] = lame.stress(*gradient);
            Stress { xx, yy, xy, zz: material.poissons_ratio * (xx + yy) }
        });
        Ok(Some(Self { displacement, velocity, stress: stress.collect(), mesh }))
    }
}

/// `∂u_a/∂x_b` at the nodes: corner values of the cells weighted by their inverse size, which on a graded tensor mesh is
/// exact for quadratic displacements at inner nodes.
fn nodal_gradient(mesh: &Mesh, displacement: &[[f64; 2]]) -> Result<Vec<[[f64; 2]; 2]>, MechanicsError> {
    let mut sums = vec![[[0.0; 2]; 2]; mesh.nodes.len()];
    let mut weights = vec![0.0; mesh.nodes.len()];
    for (cell, nodes) in mesh.cells.iter().enumerate() {
        let corners = mesh.corners(cell);
        for (node, [xi, eta]) in nodes.iter().zip(CORNERS) {
            let point = element::point_at(&corners, xi, eta)?;
            let weight = 1.0 / point.dv;
            weights[*node] += weight;
            for (a, row) in sums[*node].iter_mut().enumerate() {
                for (b, sum) in row.iter_mut().enumerate() {
                    *sum += weight * (0..4).map(|i| displacement[nodes[i]][a] * point.gradient[i][b]).sum::<f64>();
                }
            }
        }
    }
    Ok(sums.iter().zip(weights).map(|(sum, weight)| sum.map(|row| row.map(|v| v / weight))).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fem::ContactZone;
    use crate::fem::graded;

    #[test]
    fn gradients_of_quadratic_displacements_are_exact_at_inner_nodes_of_a_graded_mesh() {
        let mesh = graded::rail(1.0, 0.1, 0.02, ContactZone { half_width: 1e-2, elements: 4 }).unwrap();
        let field: Vec<_> = mesh.nodes.iter().map(|[x, y]| [x * x + 3.0 * y, x * y - y * y]).collect();
        let gradient = nodal_gradient(&mesh, &field).unwrap();
        let inner = |[x, y]: [f64; 2]| x.abs() < 0.499 && y < -1e-6 && y > -0.0999;
        let mut seen = 0;
        for (&[x, y], g) in mesh.nodes.iter().zip(&gradient).filter(|(at, _)| inner(**at)) {
            let exact = [[2.0 * x, 3.0], [y, x - 2.0 * y]];
            let error = (0..4).map(|k| (g[k / 2][k % 2] - exact[k / 2][k % 2]).abs()).fold(0.0, f64::max);
            assert!(error < 1e-11, "({x}, {y}): {g:?} against {exact:?}");
            seen += 1;
        }
        assert!(seen > 500, "{seen} inner nodes");
    }

    #[test]
    fn von_mises_stress_of_pure_shear_is_root_three_times_it() {
        let shear = Stress { xy: 2.0, ..Stress::default() };
        assert!((shear.von_mises() - 2.0 * 3f64.sqrt()).abs() < 1e-15);
        let hydrostatic = Stress { xx: -1.0, yy: -1.0, zz: -1.0, xy: 0.0 };
        assert_eq!(hydrostatic.von_mises(), 0.0);
    }
}
