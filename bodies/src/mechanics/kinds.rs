//! Two kinds of vibration modes, those that are even in a mirror and those that are odd.
//!
//! The stream and its acceleration couple modes of different kinds only, its square couples modes of the same kind. With all
//! modes of a kind one after the other, half of such a matrix is zero and stays out of products.

use crate::linalg::vectorised;
use nalgebra::{DMatrix, DVector};
use std::ops::Range;

/// Numbers of modes of two kinds, of which one comes first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct ModeKinds {
    first: usize,
    all: usize,
}

/// Modes that a product is taken for, and modes from which it comes.
type Coupled = (Range<usize>, Range<usize>);

impl ModeKinds {
    /// Modes that are all of one kind.
    pub fn one(all: usize) -> Self {
        Self { first: all, all }
    }

    /// Kinds of the modes that an `even` matrix and `odd` ones couple, and the modes kind by kind, in each as they come; all
    /// are of one kind where a matrix couples others.
    pub fn of(even: &DMatrix<f64>, odd: &[&DMatrix<f64>]) -> (Self, Vec<usize>) {
        let all = even.nrows();
        let [first, second]: [Vec<usize>; 2] =
            [true, false].map(|own| (0..all).filter(|&i| (i == 0 || even[(0, i)] != 0.0) == own).collect());
        let zero = |matrix: &DMatrix<f64>, rows: &[usize], columns: &[usize]| {
            rows.iter().all(|&i| columns.iter().all(|&j| matrix[(i, j)] == 0.0))
        };
        let apart = zero(even, &first, &second) && zero(even, &second, &first);
        if apart && odd.iter().all(|odd| zero(odd, &first, &first) && zero(odd, &second, &second)) {
            (Self { first: first.len(), all }, first.into_iter().chain(second).collect())
        } else {
            (Self::one(all), (0..all).collect())
        }
    }

    fn kinds(self) -> [Range<usize>; 2] {
        [0..self.first, self.first..self.all]
    }

    /// Modes that a matrix couples which is even.
    fn within(self) -> [Coupled; 2] {
        self.kinds().map(|kind| (kind.clone(), kind))
    }

    /// Modes that a matrix couples which is odd; all where there is one kind.
    fn across(self) -> [Coupled; 2] {
        let [first, second] = self.kinds();
        if second.is_empty() { self.within() } else { [(first.clone(), second.clone()), (second, first)] }
    }

    /// `out ← out + factor · A x` for an even matrix.
    pub fn add_even(self, factor: f64, a: &DMatrix<f64>, x: &DVector<f64>, out: &mut DVector<f64>) {
        self.add(self.within(), factor, a, x, out);
    }

    /// `out ← out + factor · A x` for an odd matrix.
    pub fn add_odd(self, factor: f64, a: &DMatrix<f64>, x: &DVector<f64>, out: &mut DVector<f64>) {
        self.add(self.across(), factor, a, x, out);
    }

    fn add(self, coupled: [Coupled; 2], factor: f64, a: &DMatrix<f64>, x: &DVector<f64>, out: &mut DVector<f64>) {
        for (rows, columns) in coupled.into_iter().filter(|(rows, columns)| !rows.is_empty() && !columns.is_empty()) {
            let block = &a.as_slice()[columns.start * self.all + rows.start..];
            let (x, out) = (&x.as_slice()[columns], &mut out.as_mut_slice()[rows]);
            vectorised::add_columns(factor, block, self.all, x, out);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mechanics::testing::paper_d;
    use crate::mechanics::{ReducedBasis, rail_system, wheel_system};

    /// Products with halves of the matrices of both bodies are those with the whole ones, and each kind is a real part.
    #[test]
    fn halves_of_the_matrices_of_the_stream_act_as_the_whole_ones() {
        let bodies = paper_d(4);
        for system in [wheel_system(&bodies).unwrap(), rail_system(&bodies).unwrap()] {
            let sorted = ReducedBasis::compute(&system, 21, &mut |_| {}).unwrap();
            let (kinds, basis) = sorted.clone().by_kinds();
            assert!(kinds.first > 5 && kinds.first < 16 && sorted == basis, "{kinds:?}");
            let squares = basis.squared_frequencies.as_slice();
            assert!(kinds.kinds().into_iter().all(|kind| squares[kind].is_sorted()));
            // In any order, modes are found kind by kind.
            let mixed: Vec<usize> = (0..21).map(|i| 8 * i % 21).collect();
            let (again, of_mixed) = basis.in_order(&mixed).by_kinds();
            assert!(again == kinds && of_mixed.gyroscopic.amax() == basis.gyroscopic.amax());
            let x = DVector::from_fn(21, |i, _| (1.0 + i as f64).sin());
            let apart = |found: DVector<f64>, matrix: &DMatrix<f64>| {
                let exact = matrix * &x * 3.0;
                (found - &exact).amax() / exact.amax()
            };
            let mut out = [(); 3].map(|()| DVector::zeros(21));
            kinds.add_odd(3.0, &basis.gyroscopic, &x, &mut out[0]);
            kinds.add_even(3.0, &basis.ale_inertia, &x, &mut out[1]);
            kinds.add_odd(3.0, &basis.character.transport, &x, &mut out[2]);
            let [gyroscopic, ale_inertia, whole] = out;
            let found = [
                (gyroscopic, &basis.gyroscopic),
                (ale_inertia, &basis.ale_inertia),
                (whole, &basis.character.transport),
            ];
            let apart = found.map(|(found, matrix)| apart(found, matrix));
            println!("{kinds:?}: {apart:?} apart");
            assert!(apart.iter().all(|apart| *apart < 1e-13));
        }
    }

    /// A body without a mirror keeps its modes as they are.
    #[test]
    fn modes_that_are_neither_even_nor_odd_are_of_one_kind() {
        let mut basis = ReducedBasis::compute(&rail_system(&paper_d(4)).unwrap(), 8, &mut |_| {}).unwrap();
        basis.gyroscopic[(2, 2)] = 1.0;
        let (kinds, same) = basis.clone().by_kinds();
        assert_eq!((kinds, &same), (ModeKinds::one(8), &basis));
        let x = DVector::from_fn(8, |i, _| (1.0 + i as f64).cos());
        let mut found = DVector::zeros(8);
        kinds.add_odd(1.0, &basis.gyroscopic, &x, &mut found);
        assert!((found - &basis.gyroscopic * x).amax() < 1e-13 * basis.gyroscopic.amax());
    }
}
