//! Vibration modes of a body that falls into parts, and what is integrated over them.

use super::MechanicsError;
use super::system::BodySystem;
use crate::linalg::{
    Cholesky, CsrMatrix, Oscillator, Parity, ParityPart, VibrationModes, lowest_modes_of_parts, side_by_side,
};
use nalgebra::{DMatrix, DVector};

/// The fields of one parity, with their stiffness factorised.
pub(super) struct StaticPart {
    /// Which fields.
    pub part: ParityPart,
    mass: CsrMatrix,
    factor: Cholesky,
    /// The unknowns of the part on the surface, as they come in [`Cholesky::last_block_of_inverse`].
    ports: Vec<usize>,
}

impl StaticPart {
    /// One for each part of a body.
    pub fn all(system: &BodySystem) -> Result<Vec<Self>, MechanicsError> {
        let parts = system.parts();
        side_by_side(parts.len(), |k| Self::new(system, &parts[k])).into_iter().collect()
    }

    fn new(system: &BodySystem, part: &ParityPart) -> Result<Self, MechanicsError> {
        let stiffness = part.fold(&system.stiffness, part);
        let mut ports: Vec<usize> = system.surface.iter().filter_map(|&i| part.place(i)).map(|p| p.0).collect();
        ports.sort_unstable();
        ports.dedup();
        let factor = Cholesky::with_last(&stiffness, &ports)?;
        let mass = part.fold(&system.mass, part);
        Ok(Self { part: part.clone(), mass, factor, ports })
    }

    /// Adds this part's share of `S K⁻¹ Sᵀ` [m/(N/m)].
    pub fn add_surface_compliance(&self, system: &BodySystem, compliance: &mut DMatrix<f64>) {
        let Some(block) = self.factor.last_block_of_inverse() else { return };
        let mut numbers = vec![0; self.part.size()];
        self.ports.iter().enumerate().for_each(|(number, &port)| numbers[port] = number);
        let places: Vec<_> = system.surface.iter().map(|&i| self.part.place(i)).collect();
        for (i, at) in places.iter().enumerate() {
            for (j, to) in places.iter().enumerate() {
                if let (Some((row, a)), Some((column, b))) = (at, to) {
                    compliance[(i, j)] += a * b * block[(numbers[*row], numbers[*column])];
                }
            }
        }
    }

    /// Adds this part's share of `S K⁻¹ f` for loads `f`, one per column.
    pub fn add_surface_answer(&self, system: &BodySystem, loads: &DMatrix<f64>, answer: &mut DMatrix<f64>) {
        for (load, mut answer) in loads.column_iter().zip(answer.column_iter_mut()) {
            let mut field = self.part.restrict(load.as_slice());
            self.factor.solve_in_place(&mut field);
            for (value, &unknown) in answer.iter_mut().zip(&system.surface) {
                *value += self.part.value(&field, unknown);
            }
        }
    }
}

/// Mass-normalised fields, each of which has one parity.
pub(super) struct Shapes {
    parts: Vec<ParityPart>,
    /// Of each part: its fields, one per column.
    fields: Vec<DMatrix<f64>>,
    /// Place of each part's fields among all.
    places: Vec<Vec<usize>>,
}

impl Shapes {
    /// The `count` lowest modes, with their squared frequencies [rad²/s²].
    pub fn lowest(
        parts: &[StaticPart],
        count: usize,
        progress: &mut dyn FnMut(f64),
    ) -> Result<(DVector<f64>, Self), MechanicsError> {
        let oscillators: Vec<_> =
            parts.iter().map(|StaticPart { mass, factor, .. }| Oscillator { mass, factor }).collect();
        let modes = lowest_modes_of_parts(&oscillators, count, progress)?;
        let of_part = |(k, modes): (usize, &VibrationModes)| -> Vec<(f64, usize)> {
            modes.squared_frequencies.iter().map(|square| (*square, k)).collect()
        };
        let mut order: Vec<(f64, usize)> = modes.iter().enumerate().flat_map(of_part).collect();
        order.sort_by(|a, b| a.0.total_cmp(&b.0));
        let places = (0..parts.len()).map(|k| (0..count).filter(|&place| order[place].1 == k).collect()).collect();
        let squares = DVector::from_iterator(count, order.iter().map(|mode| mode.0));
        let fields = modes.into_iter().map(|modes| modes.shapes).collect();
        Ok((squares, Self { parts: parts.iter().map(|part| part.part.clone()).collect(), fields, places }))
    }

    /// Fields of any parity, one per column.
    pub fn whole(fields: DMatrix<f64>) -> Self {
        let (n, count) = fields.shape();
        Self { parts: vec![ParityPart::whole(n)], fields: vec![fields], places: vec![(0..count).collect()] }
    }

    /// Number of fields.
    pub fn count(&self) -> usize {
        self.places.iter().map(Vec::len).sum()
    }

    /// `Φᵀ A Φ` for a matrix of the body with a parity.
    pub fn project(&self, matrix: &CsrMatrix, parity: Parity) -> DMatrix<f64> {
        let mut projected = DMatrix::zeros(self.count(), self.count());
        let flip = usize::from(parity == Parity::Odd && self.parts.len() > 1);
        let other = |k: usize| (k + flip) % self.parts.len();
        let blocks = side_by_side(self.parts.len(), |k| {
            let image = self.parts[k].fold(matrix, &self.parts[other(k)]).multiply_columns(&self.fields[other(k)]);
            product(&self.fields[k], &image)
        });
        for (k, block) in blocks.iter().enumerate() {
            for (i, &row) in self.places[k].iter().enumerate() {
                for (j, &column) in self.places[other(k)].iter().enumerate() {
                    projected[(row, column)] = block[(i, j)];
                }
            }
        }
        projected
    }

    /// `φᵀ A φ` of each field for an even matrix.
    pub fn squares(&self, matrix: &CsrMatrix) -> DVector<f64> {
        let mut squares = DVector::zeros(self.count());
        let images = side_by_side(self.parts.len(), |k| {
            self.parts[k].fold(matrix, &self.parts[k]).multiply_columns(&self.fields[k])
        });
        for ((image, fields), places) in images.iter().zip(&self.fields).zip(&self.places) {
            for (j, &place) in places.iter().enumerate() {
                squares[place] = fields.column(j).dot(&image.column(j)).max(0.0);
            }
        }
        squares
    }

    /// `Φᵀ F` for loads, one per column.
    pub fn project_loads(&self, loads: &DMatrix<f64>) -> DMatrix<f64> {
        let mut projected = DMatrix::zeros(self.count(), loads.ncols());
        for ((part, fields), places) in self.parts.iter().zip(&self.fields).zip(&self.places) {
            for (j, load) in loads.column_iter().enumerate() {
                let load = DVector::from_vec(part.restrict(load.as_slice()));
                for (field, &place) in fields.column_iter().zip(places) {
                    projected[(place, j)] = field.dot(&load);
                }
            }
        }
        projected
    }

    /// `S Φ` for some unknowns `S`, all of them if they are `0..n`.
    pub fn rows(&self, unknowns: impl Iterator<Item = usize> + Clone) -> DMatrix<f64> {
        let mut rows = DMatrix::zeros(unknowns.clone().count(), self.count());
        for ((part, fields), places) in self.parts.iter().zip(&self.fields).zip(&self.places) {
            for (i, unknown) in unknowns.clone().enumerate() {
                if let Some((row, weight)) = part.place(unknown) {
                    for (j, &place) in places.iter().enumerate() {
                        rows[(i, place)] = weight * fields[(row, j)];
                    }
                }
            }
        }
        rows
    }
}

/// `Aᵀ B`.
fn product(a: &DMatrix<f64>, b: &DMatrix<f64>) -> DMatrix<f64> {
    a.transpose() * b
}
