//! The finite-element equations of one body before any reduction.

use super::ale::Stream;
use super::elasticity::{self, Lame};
use crate::axes::PerAxis;
use crate::fem::{AssemblyPattern, DofMap, FemError, Mesh, assemble_vector};
use crate::linalg::dense::symmetrise;
use crate::linalg::{Cholesky, CsrMatrix, ParityPart, Reflection, join};
use crate::material::Isotropic;
use nalgebra::{DMatrix, DVector};

/// Matrices of one body on its free degrees of freedom, per metre of width.
#[derive(Clone, Debug)]
pub struct BodySystem {
    /// `K` [N/m per m].
    pub stiffness: CsrMatrix,
    /// Consistent mass `M` [kg/m].
    pub mass: CsrMatrix,
    /// Damping `D` [N s/m per m], symmetric and positive semidefinite; it acts on the velocity relative to hub or base.
    /// `None`: undamped.
    pub damping: Option<CsrMatrix>,
    /// `C = ρ ∫ w·∂u` (per unit stream speed).
    pub gyroscopic: CsrMatrix,
    /// `T = ρ ∫ w·(∂u − W u)` (per unit stream speed): the part of the material rate that the stream carries.
    pub transport: CsrMatrix,
    /// Matrices that tell vibration modes of the wheel apart: `n²`-weighted and circumferential mass (see
    /// [`Stream::squared_diameters`], [`Stream::circumferential_mass`]); `None` for the rail.
    pub circles: Option<[CsrMatrix; 2]>,
    /// `S − B`: minus the weak form of `ρ ∂∂u` (per unit stream speed squared); `B` is the Robin term of free ends.
    pub ale_inertia: CsrMatrix,
    /// `M r_k` for unit rigid accelerations in x, y, Ω (`r_Ω = (y, −x)`) and z (none in the plane), hub or base nodes included;
    /// the rail has no `r_Ω`.
    pub rigid: DMatrix<f64>,
    /// Centrifugal load `M X` per `Ω²`; zero for the rail.
    pub centrifugal: DVector<f64>,
    /// Unknown of each surface component, `2·node + component`.
    pub surface: Vec<usize>,
    /// The reflection at the vertical line through the contact point that leaves the body as it is; `None`: there is
    /// none. [`Self::damping`] need not follow it.
    pub reflection: Option<Reflection>,
}

impl BodySystem {
    /// Integrates all matrices of a body whose material streams as `stream`, without those of its [ends](super::ends).
    pub fn assemble(mesh: &Mesh, material: &Isotropic, stream: Stream) -> Result<Self, FemError> {
        let dofs = DofMap::new(mesh);
        let pattern = AssemblyPattern::new(mesh, &dofs)?;
        let (lame, density) = (Lame::from(material), material.density);
        let mass = |p: &_| elasticity::mass(p, density);
        let load = |field: fn([f64; 2]) -> [f64; 2]| assemble_vector(mesh, &dofs, mass, field);
        let turning = |field: fn([f64; 2]) -> [f64; 2]| match stream {
            Stream::Rotation => load(field),
            Stream::Translation => Ok(DVector::zeros(dofs.len())),
        };
        let loads = || -> Result<_, FemError> {
            let rigid = PerAxis {
                travel: load(|_| [1.0, 0.0])?,
                height: load(|_| [0.0, 1.0])?,
                rotation: turning(|[x, y]| [y, -x])?,
                lateral: DVector::zeros(dofs.len()),
            };
            Ok((DMatrix::from_columns(&rigid.values()), turning(|x| x)?))
        };
        let circles = || match stream {
            Stream::Rotation => Some([
                pattern.assemble(|p| Stream::squared_diameters(p, density)),
                pattern.assemble(|p| Stream::circumferential_mass(p, density)),
            ]),
            Stream::Translation => None,
        };
        let of_stream = || {
            let gyroscopic = pattern.assemble(|p| stream.gyroscopic(p, density));
            let transport = pattern.assemble(|p| stream.transport(p, density));
            (gyroscopic, transport, pattern.assemble(|p| stream.ale_inertia(p, density)))
        };
        let still = || (pattern.assemble(|p| elasticity::stiffness(p, lame)), pattern.assemble(mass), circles());
        let ((stiffness, mass, circles), (streaming, loads)) = join(still, || (of_stream(), loads()));
        let ((gyroscopic, transport, ale_inertia), (rigid, centrifugal)) = (streaming, loads?);
        let unknowns = |&node: &usize| [dofs.unknown(node, 0), dofs.unknown(node, 1)];
        Ok(Self {
            stiffness,
            mass,
            damping: None,
            gyroscopic,
            transport,
            circles,
            ale_inertia,
            rigid,
            centrifugal,
            surface: mesh.surface.iter().flat_map(unknowns).flatten().collect(),
            reflection: reflection(mesh, &dofs),
        })
    }

    /// Even and odd displacements, which do not know of each other; or all of them.
    pub fn parts(&self) -> Vec<ParityPart> {
        match &self.reflection {
            Some(reflection) => ParityPart::halves(reflection).into(),
            None => vec![ParityPart::whole(self.unknowns())],
        }
    }

    /// Number of unknowns.
    pub fn unknowns(&self) -> usize {
        self.mass.rows()
    }

    /// Picks the surface components of several fields.
    pub fn rows_on_surface(&self, fields: &DMatrix<f64>) -> DMatrix<f64> {
        fields.select_rows(self.surface.iter())
    }

    /// `S A⁻¹ Sᵀ` [m/(N/m)]: answer of the surface to unit nodal forces on it; `factor` is that of `A`. It costs least
    /// if the unknowns of the surface were eliminated last, in their order.
    pub fn surface_compliance(&self, factor: &Cholesky) -> DMatrix<f64> {
        /// Right-hand sides solved together.
        const BATCH: usize = 16;
        let (n, ports) = (self.unknowns(), self.surface.len());
        if let Some(mut compliance) = factor.last_block_of_inverse().filter(|_| factor.last() == self.surface) {
            symmetrise(&mut compliance);
            return compliance;
        }
        let mut compliance = DMatrix::zeros(ports, ports);
        for first in (0..ports).step_by(BATCH) {
            let width = BATCH.min(ports - first);
            let mut columns = DMatrix::zeros(n, width);
            for j in 0..width {
                columns[(self.surface[first + j], j)] = 1.0;
            }
            factor.solve_columns(&mut columns);
            compliance.columns_mut(first, width).copy_from(&self.rows_on_surface(&columns));
        }
        symmetrise(&mut compliance);
        compliance
    }
}

/// Reflection of the unknowns of a mirrored mesh: x components change their sign.
fn reflection(mesh: &Mesh, dofs: &DofMap) -> Option<Reflection> {
    let image = |k: usize| -> Option<(usize, f64)> {
        let (node, component) = (k / 2, k % 2);
        let image = dofs.unknown(*mesh.mirror.get(node)?, component)?;
        Some((image, if component == 0 { -1.0 } else { 1.0 }))
    };
    let free = (0..2 * mesh.nodes.len()).filter(|k| dofs.unknown(k / 2, k % 2).is_some());
    free.map(image).collect::<Option<Vec<_>>>().map(|images| Reflection { images })
}

#[cfg(test)]
mod tests {
    use crate::fem::{DofMap, assemble_vector};
    use crate::linalg::{Cholesky, lowest_modes};
    use crate::mechanics::elasticity::mass;
    use crate::mechanics::testing::{annulus, exact_torsion, paper_d};
    use crate::mechanics::*;

    #[test]
    fn mass_and_inertia_of_the_wheel_converge_to_the_circle_with_order_two() {
        let bodies = paper_d(4);
        let error = |around: usize| -> [f64; 2] {
            let mesh = annulus(0.5, 0.05, around, 4);
            let dofs = DofMap::new(&mesh);
            let product = |field: fn([f64; 2]) -> [f64; 2]| -> f64 {
                let m = assemble_vector(&mesh, &dofs, |p| mass(p, 8000.0), field).unwrap();
                mesh.nodes
                    .iter()
                    .enumerate()
                    .flat_map(|(k, x)| [0, 1].map(|c| (dofs.unknown(k, c), field(*x)[c])))
                    .map(|(unknown, value)| unknown.map_or(0.0, |i| m[i] * value))
                    .sum()
            };
            [
                product(|_| [1.0, 0.0]) / bodies.wheel_mass() - 1.0,
                product(|[x, y]| [y, -x]) / bodies.wheel_inertia() - 1.0,
            ]
        };
        let (coarse, fine) = (error(24), error(48));
        for k in 0..2 {
            let order = (coarse[k] / fine[k]).log2();
            assert!((order - 2.0).abs() < 0.05, "observed order {order:.3}, error {:e}", fine[k]);
        }
    }

    #[test]
    fn torsion_frequency_of_the_wheel_on_its_hub_is_the_bessel_value() {
        let system = wheel_system(&paper_d(8)).unwrap();
        let factor = Cholesky::new(&system.stiffness).unwrap();
        let modes = lowest_modes(&factor, &system.mass, 6, &mut |_| {}).unwrap();
        let participation = modes.shapes.tr_mul(&system.rigid.column(crate::axes::Axis::Rotation.number()));
        let omega = modes.squared_frequencies[participation.iamax()].sqrt();
        let exact = exact_torsion(&paper_d(8));
        assert!((omega / exact.frequency - 1.0).abs() < 1e-3, "{omega} rad/s, {exact:?}");
        let share = participation.amax().powi(2) / paper_d(8).wheel_inertia();
        assert!((share - exact.inertia_share).abs() < 2e-3, "{share}, {exact:?}");
    }

    #[test]
    fn modes_are_mass_orthonormal_and_satisfy_the_eigenproblem() {
        let system = rail_system(&paper_d(6)).unwrap();
        let factor = Cholesky::new(&system.stiffness).unwrap();
        let modes = lowest_modes(&factor, &system.mass, 30, &mut |_| {}).unwrap();
        let m_phi = system.mass.multiply_columns(&modes.shapes);
        let gram = modes.shapes.tr_mul(&m_phi);
        assert!((gram - nalgebra::DMatrix::identity(30, 30)).amax() < 1e-11);
        let k_phi = system.stiffness.multiply_columns(&modes.shapes);
        for j in 0..30 {
            let residual = k_phi.column(j) - m_phi.column(j) * modes.squared_frequencies[j];
            let relative = residual.norm() / k_phi.column(j).norm();
            assert!(relative < 1e-8, "mode {j}: {relative:e}");
        }
        assert!(modes.squared_frequencies.as_slice().windows(2).all(|w| w[0] <= w[1]));
        let again = lowest_modes(&factor, &system.mass, 30, &mut |_| {}).unwrap();
        assert_eq!(modes.shapes, again.shapes);
    }

    #[test]
    fn static_compliance_of_the_surface_is_symmetric_and_positive_definite() {
        for system in [wheel_system(&paper_d(6)).unwrap(), rail_system(&paper_d(6)).unwrap()] {
            let factor = Cholesky::new(&system.stiffness).unwrap();
            let g = system.surface_compliance(&factor);
            assert!((&g - g.transpose()).amax() <= 1e-15 * g.amax());
            let last = Cholesky::with_last(&system.stiffness, &system.surface).unwrap();
            assert!((&g - system.surface_compliance(&last)).amax() < 1e-10 * g.amax());
            assert!(g.cholesky().is_some());
        }
    }

    /// `s_k = G_{j+k} − G_{j+k+1}` of both bodies against the half-plane's `2/(πE*)/(k + ½)`, `1/E* = 2 (1 − ν²)/E`.
    #[test]
    fn surface_kernel_follows_the_half_plane_beyond_the_grid_scale() {
        let bodies = paper_d(20);
        let modulus = bodies.material.contact_modulus();
        let zone = contact_zone(&bodies);
        let (nodes, middle) = (zone.surface_nodes(), zone.surface_nodes() / 2);
        let mut sum = nalgebra::DMatrix::<f64>::zeros(2 * nodes, 2 * nodes);
        for system in [wheel_system(&bodies).unwrap(), rail_system(&bodies).unwrap()] {
            sum += system.surface_compliance(&Cholesky::new(&system.stiffness).unwrap());
        }
        for component in [0, 1] {
            let g = |i: usize| sum[(2 * i + component, 2 * middle + component)];
            let ratio = |k: usize| {
                (g(middle + k) - g(middle + k + 1)) * (k as f64 + 0.5) * std::f64::consts::PI * modulus / 2.0
            };
            let ratios: Vec<f64> = (0..20).map(ratio).collect();
            println!("component {component}: {ratios:.4?}");
            assert!(ratios[3..].iter().all(|r| (r - 1.0).abs() < 0.05));
        }
    }

    /// Frictionless contact by active set on the paired nodes: half-width and peak pressure of Hertz.
    #[test]
    fn pressed_bodies_give_the_hertzian_half_width_and_pressure() {
        let bodies = paper_d(10);
        let (h, a) = (contact_zone(&bodies).spacing(), bodies.half_width);
        let mut g = nalgebra::DMatrix::<f64>::zeros(0, 0);
        for system in [wheel_system(&bodies).unwrap(), rail_system(&bodies).unwrap()] {
            let full = system.surface_compliance(&Cholesky::new(&system.stiffness).unwrap());
            let n = full.nrows() / 2;
            let normal = nalgebra::DMatrix::from_fn(n, n, |i, j| full[(2 * i + 1, 2 * j + 1)]);
            g = if g.is_empty() { normal } else { g + normal };
        }
        let x = contact_zone(&bodies).surface_x();
        let gap = |i: usize| 0.5 - (0.25 - x[i] * x[i]).sqrt();
        let mut active: Vec<usize> = (0..x.len()).filter(|&i| x[i].abs() < 1.2 * a).collect();
        let (mut force, mut approach) = (nalgebra::DVector::zeros(0), 0.0);
        for _ in 0..20 {
            let m = active.len();
            let matrix = nalgebra::DMatrix::from_fn(m + 1, m + 1, |i, j| match (i < m, j < m) {
                (true, true) => g[(active[i], active[j])],
                (false, false) => 0.0,
                (true, false) => -1.0,
                (false, true) => 1.0,
            });
            let rhs = nalgebra::DVector::from_fn(m + 1, |i, _| if i < m { -gap(active[i]) } else { 1e5 });
            let solution = matrix.lu().solve(&rhs).unwrap();
            approach = solution[m];
            force = solution.rows(0, m).into_owned();
            let kept: Vec<usize> = (0..m).filter(|&i| force[i] > 0.0).map(|i| active[i]).collect();
            if kept.len() == m {
                break;
            }
            active = kept;
        }
        // Parabola p² = p0² (1 − x²/a²) through the middle of the patch.
        let peak = force.amax();
        let (mut sums, mut rhs) = ([0.0; 3], [0.0; 2]);
        for (k, &i) in active.iter().enumerate().filter(|(k, _)| force[*k] > 0.3 * peak) {
            let (p2, x2) = ((force[k] / h).powi(2), x[i] * x[i]);
            sums = [sums[0] + 1.0, sums[1] + x2, sums[2] + x2 * x2];
            rhs = [rhs[0] + p2, rhs[1] + p2 * x2];
        }
        let determinant = sums[0] * sums[2] - sums[1] * sums[1];
        let constant = (rhs[0] * sums[2] - rhs[1] * sums[1]) / determinant;
        let slope = (rhs[1] * sums[0] - rhs[0] * sums[1]) / determinant;
        let (half_width, pressure) = ((-constant / slope).sqrt(), constant.sqrt());
        let hertz = 2e5 / (std::f64::consts::PI * a);
        println!(
            "half-width {half_width:.5e} m (Hertz {a:.5e}), pressure {pressure:.5e} Pa (Hertz {hertz:.5e}), approach {approach:.4e} m"
        );
        assert!((half_width / a - 1.0).abs() < 4e-3 && (pressure / hertz - 1.0).abs() < 4e-3);
        // Converged finite-element reference of the same geometry: 3.852e-6 m, error 6e-9 m.
        assert!((approach - 3.852e-6).abs() < 0.01e-6, "{approach:e} m");
    }
}
