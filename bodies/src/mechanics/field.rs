//! Displacement, velocity and stress of a whole body, from the state of its full finite-element response.

use super::ale::Stream;
use super::elasticity::Lame;
use super::parameters::BodyParameters;
use super::response::BodyState;
use super::smooth::SmoothPorts;
use super::{BodySystem, MechanicsError, contact_zone, rail_mesh, rail_system, wheel_mesh, wheel_system};
use crate::fem::{DofMap, Mesh, element};
use crate::linalg::Cholesky;
use nalgebra::{DVector, Matrix3x4, Matrix4, Matrix4x3, RowVector3};

/// Plane-strain stress \[Pa].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Stress {
    /// `σ_xx` \[Pa].
    pub xx: f64,
    /// `σ_yy` \[Pa].
    pub yy: f64,
    /// `σ_xy` \[Pa].
    pub xy: f64,
    /// Out of plane, `ν (σ_xx + σ_yy)`.
    pub zz: f64,
}

impl Stress {
    /// Equivalent stress of von Mises \[Pa].
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
    /// Relative to hub or base \[m].
    pub displacement: Vec<[f64; 2]>,
    /// Of the material, `v̄ + d_t u + v̄·∇u` with the stream `v̄` [m/s].
    pub velocity: Vec<[f64; 2]>,
    /// Recovered from the displacement gradients in the cells.
    pub stress: Vec<Stress>,
}

/// Fields of the wheel that turns with `omega` [rad/s] under `loads`; `None` if the state is not one of the full response.
pub fn wheel_field(
    c: &BodyParameters,
    state: &BodyState,
    omega: f64,
    loads: NodalLoads,
) -> Result<Option<BodyField>, MechanicsError> {
    let body = (wheel_mesh(c)?, wheel_system as fn(&BodyParameters) -> _);
    BodyField::recover(c, body, Stream::Rotation, (state, omega), loads)
}

/// Fields of the rail under a wheel that travels with `velocity` [m/s]; `None` as for the wheel.
pub fn rail_field(
    c: &BodyParameters,
    state: &BodyState,
    velocity: f64,
    loads: NodalLoads,
) -> Result<Option<BodyField>, MechanicsError> {
    let body = (rail_mesh(c)?, rail_system as fn(&BodyParameters) -> _);
    BodyField::recover(c, body, Stream::Translation, (state, velocity), loads)
}

/// Loads on the surface of a body: at its nodes, x and y of each, and their moments, which the state of the body has answered
/// [N/m].
#[derive(Clone, Copy)]
pub struct NodalLoads<'a> {
    /// At all surface nodes of its mesh.
    pub nodes: &'a DVector<f64>,
    /// At the ports.
    pub ports: &'a DVector<f64>,
}

/// Adds loads at the nodes of a contact grid, which are `size` times as far apart as the surface nodes of the bodies, to those at
/// these, x and y of each: every load acts on both nodes beside it, with the same force and moment.
pub fn add_loads(
    c: &BodyParameters,
    size: f64,
    loads: &DVector<f64>,
    sum: &mut DVector<f64>,
) -> Result<(), MechanicsError> {
    let x = contact_zone(c).surface_x();
    if sum.is_empty() {
        *sum = DVector::zeros(2 * x.len());
    }
    let loaded = loads.as_slice().as_chunks::<2>().0.iter().zip(&x).filter(|(load, _)| **load != [0.0; 2]);
    for (load, place) in loaded {
        let place = size * place;
        let above = x.partition_point(|x| *x < place).clamp(1, x.len() - 1);
        let share = ((place - x[above - 1]) / (x[above] - x[above - 1])).clamp(0.0, 1.0);
        for (node, share) in [(above - 1, 1.0 - share), (above, share)] {
            load.iter().enumerate().for_each(|(component, load)| sum[2 * node + component] += share * load);
        }
    }
    Ok(())
}

impl NodalLoads<'_> {
    /// Displacement of all unknowns of a body by what its state has not answered, at rest \[m]: close to the contact the
    /// answer to moments is not that to the loads.
    fn local(&self, c: &BodyParameters, system: &BodySystem) -> Result<DVector<f64>, MechanicsError> {
        let answered = SmoothPorts::new(&contact_zone(c).surface_x())?.components().tr_mul(self.ports);
        let mut displacement = DVector::zeros(system.unknowns());
        if self.nodes.is_empty() {
            return Ok(displacement);
        }
        for (&unknown, load) in system.surface.iter().zip((self.nodes - answered).iter()) {
            displacement[unknown] += load;
        }
        Cholesky::new(&system.stiffness)?.solve_in_place(displacement.as_mut_slice());
        Ok(displacement)
    }
}

/// Mesh of a body, and how its finite elements are assembled.
type MeshedBody = (Mesh, fn(&BodyParameters) -> Result<BodySystem, MechanicsError>);

impl BodyField {
    fn recover(
        c: &BodyParameters,
        (mesh, assemble): MeshedBody,
        stream: Stream,
        (state, speed): (&BodyState, f64),
        loads: NodalLoads,
    ) -> Result<Option<Self>, MechanicsError> {
        let dofs = DofMap::new(&mesh);
        if state.displacement.len() != dofs.len() {
            return Ok(None);
        }
        let local = loads.local(c, &assemble(c)?)?;
        let nodal = |values: &[f64]| -> Vec<[f64; 2]> {
            let value = |node, component| dofs.unknown(node, component).map_or(0.0, |i| values[i]);
            (0..mesh.nodes.len()).map(|node| [value(node, 0), value(node, 1)]).collect()
        };
        let displacement = nodal((&state.displacement + local).as_slice());
        let mut velocity = nodal(state.velocity.as_slice());
        let gradient = nodal_gradient(&mesh, &displacement)?;
        for ((velocity, position), gradient) in velocity.iter_mut().zip(&mesh.nodes).zip(&gradient) {
            let flow = stream.direction(*position).map(|v| speed * v);
            for (v, (own, row)) in velocity.iter_mut().zip(flow.iter().zip(gradient)) {
                *v += own + row[0] * flow[0] + row[1] * flow[1];
            }
        }
        let lame = Lame::from(&c.material);
        let stress = gradient.iter().map(|gradient| {
            let [[xx, xy], [_, yy]] = lame.stress(*gradient);
            Stress { xx, yy, xy, zz: c.material.poissons_ratio * (xx + yy) }
        });
        Ok(Some(Self { displacement, velocity, stress: stress.collect(), mesh }))
    }
}

/// `∂u_a/∂x_b` at the nodes by superconvergent patch recovery: around every inner node the values in the centres of its
/// cells are fitted by a linear function, which gives the value there; nodes on the boundary take the mean of the
/// functions around.
///
/// Source: Zienkiewicz & Zhu, *Int. J. Numer. Methods Eng.* 33 (1992) 1331–1364.
fn nodal_gradient(mesh: &Mesh, displacement: &[[f64; 2]]) -> Result<Vec<Gradient>, MechanicsError> {
    let mut around = vec![Vec::with_capacity(INNER); mesh.nodes.len()];
    let mut centres = Vec::with_capacity(mesh.cells.len());
    for (cell, nodes) in mesh.cells.iter().enumerate() {
        nodes.iter().for_each(|&node| around[node].push(cell));
        let point = element::point_at(&mesh.corners(cell), 0.0, 0.0)?;
        let slope = |a: usize, b: usize| (0..4).map(|i| displacement[nodes[i]][a] * point.gradient[i][b]).sum();
        centres.push((point.position, [slope(0, 0), slope(0, 1), slope(1, 0), slope(1, 1)]));
    }
    let mut sums = vec![[0.0; 4]; mesh.nodes.len()];
    let mut patches = vec![0.0; mesh.nodes.len()];
    for (node, cells) in around.iter().enumerate().filter(|(_, cells)| cells.len() == INNER) {
        let samples: [CellSample; INNER] = std::array::from_fn(|k| centres[cells[k]]);
        let fit = LinearFit::new(mesh.nodes[node], &samples);
        let outer = cells.iter().flat_map(|&cell| mesh.cells[cell]).filter(|&n| around[n].len() < INNER);
        for target in std::iter::once(node).chain(outer) {
            patches[target] += 1.0;
            sums[target].iter_mut().zip(fit.at(mesh.nodes[target])).for_each(|(sum, value)| *sum += value);
        }
    }
    Ok(sums.iter().zip(patches).map(|(sum, n)| [[sum[0] / n, sum[1] / n], [sum[2] / n, sum[3] / n]]).collect())
}

type Gradient = [[f64; 2]; 2];
/// Position and values.
type CellSample = ([f64; 2], [f64; 4]);
/// Number of cells at an inner node.
const INNER: usize = 4;

/// `c₀ + c₁ x + c₂ y` through samples by least squares, about an origin.
struct LinearFit {
    origin: [f64; 2],
    coefficients: Matrix3x4<f64>,
}

impl LinearFit {
    fn new(origin: [f64; 2], samples: &[CellSample; INNER]) -> Self {
        let row = |k: usize| samples[k].0;
        let size = (0..INNER).map(|k| libm::hypot(row(k)[0] - origin[0], row(k)[1] - origin[1])).fold(0.0, f64::max);
        let basis = Matrix4x3::from_fn(|k, j| if j == 0 { size } else { row(k)[j - 1] - origin[j - 1] });
        let values = Matrix4::from_fn(|k, j| samples[k].1[j]);
        let mut coefficients = basis.svd(true, true).solve(&values, f64::EPSILON * size).unwrap_or_default();
        coefficients.row_mut(0).scale_mut(size);
        Self { origin, coefficients }
    }

    fn at(&self, [x, y]: [f64; 2]) -> [f64; 4] {
        let place = RowVector3::new(1.0, x - self.origin[0], y - self.origin[1]);
        (place * self.coefficients).into()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mechanics::testing::{annulus, square};

    #[test]
    fn gradients_of_quadratic_displacements_are_exact_on_a_uniform_mesh_up_to_the_boundary() {
        let mesh = square(8, 0.0);
        let field: Vec<_> = mesh.nodes.iter().map(|[x, y]| [x * x + 3.0 * y, x * y - y * y]).collect();
        let gradient = nodal_gradient(&mesh, &field).unwrap();
        for (&[x, y], g) in mesh.nodes.iter().zip(&gradient) {
            let exact = [[2.0 * x, 3.0], [y, x - 2.0 * y]];
            let error = (0..4).map(|k| (g[k / 2][k % 2] - exact[k / 2][k % 2]).abs()).fold(0.0, f64::max);
            assert!(error < 1e-12, "({x}, {y}): {g:?} against {exact:?}");
        }
    }

    #[test]
    fn gradients_converge_with_order_two_at_the_rim_of_a_ring() {
        let error = |around: usize| -> f64 {
            let mesh = annulus(0.5, 0.05, around, around / 2);
            let field: Vec<_> = mesh.nodes.iter().map(|[x, y]| [(4.0 * x).sin(), (3.0 * x * y).cos()]).collect();
            let gradient = nodal_gradient(&mesh, &field).unwrap();
            let on_rim = |at: [f64; 2]| at[0].hypot(at[1]) > 0.4999;
            let errors = mesh.nodes.iter().zip(gradient).filter(|(at, _)| on_rim(**at)).map(|(&[x, y], g)| {
                let s = (3.0 * x * y).sin();
                let exact = [[4.0 * (4.0 * x).cos(), 0.0], [-3.0 * y * s, -3.0 * x * s]];
                (0..4).map(|k| (g[k / 2][k % 2] - exact[k / 2][k % 2]).abs()).fold(0.0, f64::max)
            });
            errors.fold(0.0, f64::max)
        };
        let order = (error(48) / error(96)).log2();
        assert!((order - 2.0).abs() < 0.3, "observed order {order:.3}");
    }

    #[test]
    fn von_mises_stress_of_pure_shear_is_root_three_times_it() {
        let shear = Stress { xy: 2.0, ..Stress::default() };
        assert!((shear.von_mises() - 2.0 * 3f64.sqrt()).abs() < 1e-15);
        let hydrostatic = Stress { xx: -1.0, yy: -1.0, zz: -1.0, xy: 0.0 };
        assert_eq!(hydrostatic.von_mises(), 0.0);
    }
}
