//! Conduction through the contact in an implicit stage.
//!
//! The difference that it leaves of one between the surface temperatures is the solution of `A d = d₀`,
//! `A = 1 + β (G_w C̃_w + G_r C̃_r)`. Under a conductance that is the same all over the patch only the two elements in
//! which the patch ends differ from those of a patch that ends at nodes. The factors of `A₀`, with full conductance in
//! all elements, belong to the inverses of both bodies and are kept with them; the two elements change four columns of
//! it (Sherman, Morrison & Woodbury; W. W. Hager, *SIAM Review* 31 (1989) 221–239).

use super::conductance::{ContactBands, of_element};
use super::inverse::{Inverse, InverseKey};
use super::transport::upwind_within;
use crate::heat::error::HeatError;
use crate::heat::tensor::mesh::kernels::add;
use crate::linalg::DenseSystem;
use crate::lru::Lru;
use nalgebra::{Matrix4, Vector4};

/// Data of a coupling.
pub struct Conduction<'a> {
    /// Moments of the conductance on the elements of the contact [W/(m K)].
    pub moments: &'a [[f64; 3]],
    /// Lengths of these elements [m].
    pub lengths: &'a [f64],
    /// Conductance of all places in contact [W/(m² K)].
    pub even: f64,
    /// Implicit coefficient β of the stage [s].
    pub flow: f64,
    /// Inverses of wheel and rail, and the matrices of the conductance that go with them.
    pub sides: [(&'a Inverse, &'a ContactBands); 2],
    /// First node of the contact, counted from the first one whose surface response the inverses know.
    pub first: usize,
}

impl Conduction<'_> {
    /// Surface temperatures at the nodes of the contact under unit loads there, at the node `i` of it.
    fn response<'b>(&self, inverse: &'b Inverse, i: usize) -> &'b [f64] {
        &inverse.response.row(self.first + i)[self.first..][..self.moments.len() + 1]
    }

    /// Upwinding on the elements of the contact.
    fn upwind<'b>(&self, inverse: &'b Inverse) -> &'b [f64] {
        &inverse.upwind[self.first..][..self.moments.len()]
    }

    /// Moments on an element that is in contact all over.
    fn full(&self, value: f64, element: usize) -> [f64; 3] {
        let whole = value * self.lengths[element];
        [whole, 0.5 * whole, whole / 3.0]
    }

    /// The conductance, if all elements but the first and the last one conduct all over.
    fn even_within(&self) -> Option<f64> {
        let (value, last) = (self.even, self.moments.len().checked_sub(1)?);
        let fills = |e: usize| {
            let pairs = self.moments[e].into_iter().zip(self.full(value, e));
            pairs.into_iter().all(|(moment, full)| (moment - full).abs() <= ROUND_OFF * full)
        };
        (self.moments.len() >= FEWEST && (1..last).all(fills)).then_some(value)
    }

    /// Fills `system` with `A` under the given matrices of the conductance, and factorises it.
    fn factorise(&self, bands: [&ContactBands; 2], system: &mut DenseSystem) -> Result<(), HeatError> {
        let n = self.moments.len() + 1;
        system.reset(n);
        for i in 0..n {
            let (row, _) = system.row(i);
            row[i] = 1.0;
            for ((inverse, _), bands) in self.sides.iter().zip(bands) {
                bands.add_coupling(self.flow, self.response(inverse, i), row);
            }
        }
        if system.factorise() { Ok(()) } else { Err(HeatError::Singular { unknowns: n }) }
    }
}

/// Elements of a contact whose ends are apart.
const FEWEST: usize = 3;
/// Relative difference of moments that is round-off [1].
const ROUND_OFF: f64 = 1e-12;

/// Factors of `A₀`.
#[derive(Default)]
struct Full {
    system: DenseSystem,
    /// `A₀⁻¹ G` of both bodies at the nodes of the first and the last element, column after column.
    ends: [Vec<f64>; 2],
}

impl Full {
    /// Replaces the factors by those for the conductance `value` in all elements.
    fn set(&mut self, conduction: &Conduction, value: f64) -> Result<(), HeatError> {
        let moments: Vec<_> = (0..conduction.lengths.len()).map(|e| conduction.full(value, e)).collect();
        let bands = conduction.sides.map(|(inverse, _)| {
            let mut bands = ContactBands::default();
            bands.set(&moments, conduction.upwind(inverse));
            bands
        });
        conduction.factorise([&bands[0], &bands[1]], &mut self.system)?;
        let n = moments.len() + 1;
        for ((inverse, _), ends) in conduction.sides.iter().zip(&mut self.ends) {
            ends.clear();
            for node in ends_of(n) {
                ends.extend((0..n).map(|i| conduction.response(inverse, i)[node]));
            }
            for column in ends.chunks_exact_mut(n) {
                self.system.solve_with(column);
            }
        }
        Ok(())
    }
}

/// Nodes of the first and of the last element between `n` nodes.
fn ends_of(n: usize) -> [usize; 4] {
    [0, 1, n - 2, n - 1]
}

/// Change by the first and the last element: `A = A₀ + U Sᵀ`, where `S` picks their nodes.
#[derive(Default)]
struct Change {
    /// `A₀⁻¹ U`, column after column.
    columns: Vec<f64>,
    /// `(1 + Sᵀ A₀⁻¹ U)⁻¹`.
    small: Matrix4<f64>,
}

impl Change {
    /// Replaces the change by that of the elements that lack a part of the conductance `value`, and tells whether `A`
    /// has an inverse.
    fn set(&mut self, full: &Full, conduction: &Conduction, value: f64) -> bool {
        let (last, n) = (conduction.moments.len() - 1, conduction.moments.len() + 1);
        self.columns.clear();
        self.columns.resize(4 * n, 0.0);
        for ((inverse, _), solved) in conduction.sides.iter().zip(&full.ends) {
            for (end, element) in [0, last].into_iter().enumerate() {
                let of = |moments| of_element(moments, upwind_within(conduction.upwind(inverse)[element], moments));
                let (now, all) = (of(conduction.moments[element]), of(conduction.full(value, element)));
                for (row, column) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                    let factor = conduction.flow * (now[row][column] - all[row][column]);
                    let [from, to] = [row, column].map(|node| (2 * end + node) * n);
                    add(factor, &solved[from..from + n], &mut self.columns[to..to + n]);
                }
            }
        }
        let ends = ends_of(n);
        let small = Matrix4::from_fn(|i, j| self.columns[j * n + ends[i]]) + Matrix4::identity();
        let inverse = small.try_inverse();
        self.small = inverse.unwrap_or_default();
        inverse.is_some()
    }

    /// Turns `A₀⁻¹ x` into `A⁻¹ x`.
    fn apply(&self, x: &mut [f64]) {
        let weights = self.small * Vector4::from(ends_of(x.len()).map(|node| x[node]));
        for (column, weight) in self.columns.chunks_exact(x.len()).zip(&weights) {
            add(-weight, column, x);
        }
    }
}

/// Factors of `A`.
#[derive(Default)]
pub struct Coupling {
    /// Those of `A₀`, by the inverses of the bodies and the first and the number of the elements of the contact.
    full: Lru<([InverseKey; 2], [usize; 2]), Full>,
    change: Change,
    /// True where these two hold; else `direct` does.
    kept: bool,
    /// Factors of `A` itself.
    direct: DenseSystem,
}

impl Coupling {
    /// Prepares the factors for inverses with the given keys.
    pub fn set(&mut self, keys: [InverseKey; 2], conduction: &Conduction) -> Result<(), HeatError> {
        self.kept = false;
        if let Some(value) = conduction.even_within() {
            let place = [conduction.first, conduction.moments.len()];
            self.full.select((keys, place), |full| full.set(conduction, value))?;
            self.kept = self.change.set(self.full.present(), conduction, value);
        }
        if self.kept {
            return Ok(());
        }
        conduction.factorise(conduction.sides.map(|(_, bands)| bands), &mut self.direct)
    }

    /// `x ← A⁻¹ x`.
    pub fn solve(&mut self, x: &mut [f64]) {
        if self.kept {
            self.full.present_mut().system.solve_with(x);
            self.change.apply(x);
        } else {
            self.direct.solve_with(x);
        }
    }

    /// True where kept factors hold.
    #[cfg(test)]
    pub fn is_kept(&self) -> bool {
        self.kept
    }
}
