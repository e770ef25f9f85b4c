//! Bodies that are their own mirror images: their fields split into even and odd ones, which do not know of each other.
//!
//! A reflection `R` (`R² = 1`) takes each unknown to another one, or to itself, with a sign. Whatever commutes with it
//! maps even fields (`R x = x`) on even ones and odd fields (`R x = −x`) on odd ones, so that a problem falls into two
//! of half the size; whatever changes its sign (`R A = −A R`) maps one kind on the other.

use super::CsrMatrix;
use std::f64::consts::FRAC_1_SQRT_2;

/// A reflection of unknowns.
#[derive(Clone, Debug, PartialEq)]
pub struct Reflection {
    /// The unknown that takes the place of each, and the sign it gets.
    pub images: Vec<(usize, f64)>,
}

/// Behaviour of a matrix under a reflection.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Parity {
    /// Both commute.
    Even,
    /// The matrix changes its sign.
    Odd,
}

/// A subspace with an orthonormal basis of single unknowns and pairs of them: even fields, odd ones, or all.
#[derive(Clone, Debug, PartialEq)]
pub struct ParityPart {
    /// One unknown of each basis vector.
    unknowns: Vec<usize>,
    /// Of each unknown: the basis vector that contains it and its weight there, which is zero if there is none.
    places: Vec<(usize, f64)>,
}

impl ParityPart {
    /// All fields of `n` unknowns.
    pub fn whole(n: usize) -> Self {
        Self { unknowns: (0..n).collect(), places: (0..n).map(|i| (i, 1.0)).collect() }
    }

    /// Even and odd fields.
    pub fn halves(reflection: &Reflection) -> [Self; 2] {
        [1.0, -1.0].map(|parity| {
            let mut part = Self { unknowns: Vec::new(), places: vec![(0, 0.0); reflection.images.len()] };
            for (i, &(image, sign)) in reflection.images.iter().enumerate() {
                let place = part.unknowns.len();
                if image > i {
                    part.places[i] = (place, FRAC_1_SQRT_2);
                    part.places[image] = (place, parity * sign * FRAC_1_SQRT_2);
                } else if image == i && parity * sign > 0.0 {
                    part.places[i] = (place, 1.0);
                } else {
                    continue;
                }
                part.unknowns.push(i);
            }
            part
        })
    }

    /// Number of basis vectors.
    pub fn size(&self) -> usize {
        self.unknowns.len()
    }

    /// The basis vector that contains an unknown, and its weight there.
    pub fn place(&self, unknown: usize) -> Option<(usize, f64)> {
        Some(self.places[unknown]).filter(|place| place.1 != 0.0)
    }

    /// `Qᵀ A P` with the basis `Q` of this part and `P` of another one, for an `A` that maps the other on this.
    pub fn fold(&self, matrix: &CsrMatrix, other: &Self) -> CsrMatrix {
        CsrMatrix::from_rows(
            [self.size(), other.size(), matrix.stored() * self.size() / matrix.rows().max(1)],
            |row, entries| {
                let unknown = self.unknowns[row];
                // Both unknowns of a pair contribute the same.
                let scale = self.places[unknown].1.recip();
                entries.extend(matrix.row(unknown).filter_map(|(column, value)| {
                    other.place(column).map(|(place, weight)| (place, scale * weight * value))
                }));
            },
        )
    }

    /// `Qᵀ x`.
    pub fn restrict(&self, x: &[f64]) -> Vec<f64> {
        let mut y = vec![0.0; self.size()];
        for (value, &(place, weight)) in x.iter().zip(&self.places) {
            if weight != 0.0 {
                y[place] += weight * value;
            }
        }
        y
    }

    /// Entry of `Q y` for one unknown.
    pub fn value(&self, y: &[f64], unknown: usize) -> f64 {
        self.place(unknown).map_or(0.0, |(place, weight)| weight * y[place])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::DMatrix;

    /// Five unknowns: two pairs, one of them with a change of sign, and one that rests.
    fn reflection() -> Reflection {
        Reflection { images: vec![(3, 1.0), (4, -1.0), (2, -1.0), (0, 1.0), (1, -1.0)] }
    }

    fn dense(matrix: &CsrMatrix) -> DMatrix<f64> {
        DMatrix::from_fn(matrix.rows(), matrix.columns(), |i, j| matrix.get(i, j))
    }

    /// Basis of a part, a vector per column.
    fn basis(part: &ParityPart) -> DMatrix<f64> {
        let unit = |j: usize| (0..part.size()).map(|k| f64::from(u8::from(k == j))).collect::<Vec<_>>();
        DMatrix::from_fn(5, part.size(), |i, j| part.value(&unit(j), i))
    }

    #[test]
    fn even_and_odd_fields_are_orthonormal_and_together_all() {
        let [even, odd] = ParityPart::halves(&reflection());
        assert_eq!((even.size(), odd.size(), ParityPart::whole(5).size()), (2, 3, 5));
        let q = DMatrix::from_columns(
            &[basis(&even), basis(&odd)]
                .iter()
                .flat_map(|q| q.column_iter().map(|c| c.into_owned()))
                .collect::<Vec<_>>(),
        );
        assert!((q.tr_mul(&q) - DMatrix::identity(5, 5)).amax() < 1e-15);
        let x = [1.0, -2.0, 3.0, 5.0, 7.0];
        let back = |i: usize| [&even, &odd].iter().map(|part| part.value(&part.restrict(&x), i)).sum::<f64>();
        assert!((0..5).all(|i| (back(i) - x[i]).abs() < 1e-15));
    }

    #[test]
    fn folded_matrices_are_those_between_the_parts() {
        let images = reflection().images;
        let mirror = DMatrix::from_fn(5, 5, |i, j| if images[j].0 == i { images[j].1 } else { 0.0 });
        let any = DMatrix::from_fn(5, 5, |i, j| ((3 * i + 7 * j) % 5) as f64 - 1.5);
        let halves = ParityPart::halves(&reflection());
        for (sign, flip) in [(1.0, 0), (-1.0, 1)] {
            let matrix = &any + &mirror * &any * &mirror * sign;
            let triplets: Vec<_> = (0..25).map(|k| (k / 5, k % 5, matrix[(k / 5, k % 5)])).collect();
            let sparse = CsrMatrix::from_triplets(5, 5, &triplets).unwrap();
            for (k, part) in halves.iter().enumerate() {
                let other = &halves[(k + flip) % 2];
                let exact = basis(part).tr_mul(&(&matrix * basis(other)));
                assert!((dense(&part.fold(&sparse, other)) - exact).amax() < 1e-14);
            }
            let whole = ParityPart::whole(5);
            assert_eq!(dense(&whole.fold(&sparse, &whole)), matrix);
        }
    }
}
