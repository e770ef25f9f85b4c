//! Reduction of a body to vibration modes and residual flexibility; see [`super::reduced`] for the theory.

use super::MechanicsError;
use super::damping::ModeCharacter;
use super::kinds::ModeKinds;
use super::shapes::{Shapes, StaticPart};
use super::system::BodySystem;
use crate::axes::Axis;
use crate::linalg::Parity;
use crate::linalg::dense::symmetrise;
use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};

/// Constant data of a reduced body with `m` modes and `n` surface nodes, per metre of width.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ReducedBasis {
    /// `Ω²` [rad²/s²], `m`: those of even modes and those of odd ones one after the other, ascending; where modes are neither,
    /// all ascending.
    pub squared_frequencies: DVector<f64>,
    /// Modes on the surface `Φ_s`, `2n × m` [√(m/kg)].
    #[serde(deserialize_with = "super::rectangle::deserialize")]
    pub shapes: DMatrix<f64>,
    /// Residual flexibility `F_res`, `2n × 2n`, symmetric: half of it is stored [m/(N/m)].
    #[serde(with = "super::triangle")]
    pub residual: DMatrix<f64>,
    /// `Φᵀ M r_k`, `m × 3`; the rail has no `r_Ω`.
    #[serde(deserialize_with = "super::rectangle::deserialize")]
    pub rigid: DMatrix<f64>,
    /// Static surface answer of the truncated modes to unit rigid accelerations, `2n × 3`.
    #[serde(deserialize_with = "super::rectangle::deserialize")]
    pub rigid_residual: DMatrix<f64>,
    /// `Φᵀ M X`, `m`.
    pub centrifugal: DVector<f64>,
    /// Static surface answer of the truncated modes to the centrifugal load per `Ω²`, `2n`.
    pub centrifugal_residual: DVector<f64>,
    /// `Φᵀ C Φ`, `m × m`.
    #[serde(deserialize_with = "super::rectangle::deserialize")]
    pub gyroscopic: DMatrix<f64>,
    /// `Φᵀ (S − B) Φ`, `m × m`.
    #[serde(deserialize_with = "super::rectangle::deserialize")]
    pub ale_inertia: DMatrix<f64>,
    /// `Φᵀ D Φ` of dashpots, `m × m` [1/s]; `None`: there are none.
    #[serde(deserialize_with = "super::rectangle::optional")]
    pub damping: Option<DMatrix<f64>>,
    /// Which ratios damp the modes, and their rate in the stream.
    pub character: ModeCharacter,
}

impl ReducedBasis {
    /// Reduces a body to its `count` lowest modes; `progress` receives the share of the work done.
    pub fn compute(system: &BodySystem, count: usize, progress: &mut dyn FnMut(f64)) -> Result<Self, MechanicsError> {
        let parts = StaticPart::all(system)?;
        let (squared_frequencies, modes) = Shapes::lowest(&parts, count, &mut |share| progress(0.9 * share))?;
        let flexibility = squared_frequencies.map(f64::recip);
        let shapes = modes.rows(system.surface.iter().copied());
        let weighted = scale_columns(&shapes, &flexibility);
        let (n, ports) = (system.unknowns(), system.surface.len());
        let mut residual = DMatrix::zeros(ports, ports);
        let mut rigid_static = DMatrix::zeros(ports, Axis::COUNT);
        let mut centrifugal_static = DMatrix::zeros(ports, 1);
        let centrifugal_load = DMatrix::from_column_slice(n, 1, system.centrifugal.as_slice());
        for part in &parts {
            part.add_surface_compliance(system, &mut residual);
            part.add_surface_answer(system, &system.rigid, &mut rigid_static);
            part.add_surface_answer(system, &centrifugal_load, &mut centrifugal_static);
        }
        residual.gemm(-1.0, &weighted, &shapes.transpose(), 1.0);
        symmetrise(&mut residual);
        let rigid = modes.project_loads(&system.rigid);
        let centrifugal = modes.project_loads(&centrifugal_load).column(0).into_owned();
        let character = ModeCharacter::new(system, &modes);
        let basis = Self {
            rigid_residual: rigid_static - &weighted * &rigid,
            centrifugal_residual: centrifugal_static.column(0) - &weighted * &centrifugal,
            gyroscopic: modes.project(&system.gyroscopic, Parity::Odd),
            ale_inertia: modes.project(&system.ale_inertia, Parity::Even),
            damping: system.damping.as_ref().map(|damping| {
                let whole = Shapes::whole(modes.rows(0..n));
                let mut damping = whole.project(damping, Parity::Even);
                symmetrise(&mut damping);
                damping
            }),
            character,
            squared_frequencies,
            shapes,
            residual,
            rigid,
            centrifugal,
        };
        progress(1.0);
        Ok(basis.by_kinds().1)
    }

    /// Basis with its modes kind by kind, and the kinds.
    ///
    /// The surface has no part in it, so that bodies that differ in their ports have the same coordinates.
    pub(super) fn by_kinds(self) -> (ModeKinds, Self) {
        if self.damping.is_some() {
            return (ModeKinds::one(self.modes()), self);
        }
        let (kinds, order) = ModeKinds::of(&self.ale_inertia, &[&self.gyroscopic, &self.character.transport]);
        let ordered = if order.is_sorted() { self } else { self.in_order(&order) };
        (kinds, ordered)
    }

    /// Basis with its modes in another order.
    pub(super) fn in_order(&self, order: &[usize]) -> Self {
        let columns = |matrix: &DMatrix<f64>| matrix.select_columns(order);
        let both = |matrix: &DMatrix<f64>| matrix.select_columns(order).select_rows(order);
        let values = |vector: &DVector<f64>| vector.select_rows(order);
        let character = &self.character;
        ReducedBasis {
            squared_frequencies: values(&self.squared_frequencies),
            shapes: columns(&self.shapes),
            rigid: self.rigid.select_rows(order),
            centrifugal: values(&self.centrifugal),
            gyroscopic: both(&self.gyroscopic),
            ale_inertia: both(&self.ale_inertia),
            damping: self.damping.as_ref().map(both),
            character: ModeCharacter {
                transport: both(&character.transport),
                diameters: values(&character.diameters),
                circumferential: values(&character.circumferential),
            },
            ..self.clone()
        }
    }

    /// Static displacements of the surface nodes by forces on them, x and y of every node [m/(N/m)].
    pub(super) fn compliance(&self) -> DMatrix<f64> {
        let weighted = scale_columns(&self.shapes, &self.squared_frequencies.map(f64::recip));
        let mut compliance = self.residual.clone();
        compliance.gemm(1.0, &weighted, &self.shapes.transpose(), 1.0);
        compliance
    }

    /// Number of modes.
    pub fn modes(&self) -> usize {
        self.squared_frequencies.len()
    }

    fn matrices(&self) -> impl Iterator<Item = &DMatrix<f64>> {
        let Self { shapes, residual, rigid, rigid_residual, gyroscopic, ale_inertia, damping, .. } = self;
        [shapes, residual, rigid, rigid_residual, gyroscopic, ale_inertia].into_iter().chain(damping)
    }

    /// True if all arrays belong to `ports` surface components and hold finite numbers.
    pub fn is_consistent(&self, ports: usize) -> bool {
        let m = self.modes();
        self.shapes.shape() == (ports, m)
            && self.residual.shape() == (ports, ports)
            && self.rigid.shape() == (m, Axis::COUNT)
            && self.rigid_residual.shape() == (ports, Axis::COUNT)
            && self.centrifugal.len() == m
            && self.centrifugal_residual.len() == ports
            && self.gyroscopic.shape() == (m, m)
            && self.ale_inertia.shape() == (m, m)
            && self.character.is_consistent(m)
            && self.damping.as_ref().is_none_or(|damping| damping.shape() == (m, m))
            && self.squared_frequencies.iter().all(|w| *w > 0.0 && w.is_finite())
            && self.matrices().all(|matrix| matrix.iter().all(|x| x.is_finite()))
            && self.centrifugal.iter().chain(&self.centrifugal_residual).all(|x| x.is_finite())
    }
}

/// Columns of `a` times the entries of `factors`.
pub(super) fn scale_columns(a: &DMatrix<f64>, factors: &DVector<f64>) -> DMatrix<f64> {
    let mut scaled = a.clone();
    for (mut column, factor) in scaled.column_iter_mut().zip(factors.iter()) {
        column *= *factor;
    }
    scaled
}
