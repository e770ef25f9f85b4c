//! Flexibility of vibration modes that are even or odd: half of the surface tells the whole.
//!
//! A reflection of the surface about its middle gives a component across it the other sign. Even modes are their own
//! images, odd ones become negative, so that `Σ φ φᵀ / a` between two places of the same half is `E + O`, and between one
//! of them and the image of the other `E − O`, up to signs, with the sums E of the even and O of the odd modes.

use super::reduction::scale_columns;
use nalgebra::{DMatrix, DVector};

/// Difference of a mode from its image that is round-off, relative to its largest value \[1].
const ROUND_OFF: f64 = 1e-12;

/// Signs of the components of a node in a mirror.
const SIGNS: [f64; 2] = [-1.0, 1.0];

/// Surface values of even and odd modes.
pub struct MirroredModes {
    even: ModeHalf,
    odd: ModeHalf,
    /// Components of the surface.
    components: usize,
}

/// Modes of one parity on the first half of the surface, the middle included.
struct ModeHalf {
    /// Numbers among all modes.
    numbers: Vec<usize>,
    /// Components by modes, and transposed.
    shapes: DMatrix<f64>,
    transposed: DMatrix<f64>,
}

impl ModeHalf {
    /// The modes with the given `numbers` of the surface `shapes`.
    fn new(numbers: Vec<usize>, shapes: &DMatrix<f64>) -> Self {
        let half = 2 * (shapes.nrows() / 2).div_ceil(2);
        let shapes = DMatrix::from_fn(half, numbers.len(), |i, k| shapes[(i, numbers[k])]);
        Self { numbers, transposed: shapes.transpose(), shapes }
    }

    /// Sum of their flexibilities on this half, each times its weight among those of all modes.
    fn flexibility(&self, weights: &DVector<f64>) -> DMatrix<f64> {
        let own = DVector::from_iterator(self.numbers.len(), self.numbers.iter().map(|&k| weights[k]));
        symmetric_product(&scale_columns(&self.shapes, &own), &self.transposed)
    }
}

/// Component of the surface that takes the place of `i` of `n` ones in a mirror.
fn image(i: usize, n: usize) -> usize {
    n - 2 - i + 2 * (i % 2)
}

impl MirroredModes {
    /// The modes of the surface `shapes`, two components a node; `None` if one of them is neither even nor odd.
    pub fn new(shapes: &DMatrix<f64>) -> Option<Self> {
        let n = shapes.nrows();
        let apart = |k: usize, parity: f64| {
            let column = shapes.column(k);
            let missed = (0..n).map(|i| (column[image(i, n)] - parity * SIGNS[i % 2] * column[i]).abs());
            missed.fold(0.0, f64::max) <= ROUND_OFF * column.amax()
        };
        let of = |parity: f64| (0..shapes.ncols()).filter(move |&k| apart(k, parity)).collect::<Vec<_>>();
        let [even, odd] = [of(1.0), of(-1.0)].map(|numbers| ModeHalf::new(numbers, shapes));
        let mut all: Vec<_> = even.numbers.iter().chain(&odd.numbers).collect();
        all.sort_unstable();
        all.into_iter().copied().eq(0..shapes.ncols()).then_some(Self { even, odd, components: n })
    }

    /// Sum of the modes' flexibilities, each times its weight.
    pub fn flexibility(&self, weights: &DVector<f64>) -> DMatrix<f64> {
        let [even, odd] = [&self.even, &self.odd].map(|half| half.flexibility(weights));
        let (half, n) = (even.nrows(), self.components);
        let mut out = DMatrix::zeros(n, n);
        let all = out.as_mut_slice();
        for j in 0..half {
            let (even, odd) = (&even.as_slice()[j * half..][..half], &odd.as_slice()[j * half..][..half]);
            let (near, far) = all[j * n..][..n].split_at_mut(half);
            near.iter_mut().zip(even.iter().zip(odd)).for_each(|(near, (even, odd))| *near = even + odd);
            // The nodes of the second half from the last one on.
            let pairs = even.as_chunks::<2>().0.iter().zip(odd.as_chunks::<2>().0);
            let images = far.as_chunks_mut::<2>().0.iter_mut().rev();
            images.zip(pairs).for_each(|(far, (even, odd))| *far = [odd[0] - even[0], even[1] - odd[1]]);
        }
        // The columns of the second half are images of those of the first.
        let (first, second) = all.split_at_mut(n * half);
        for (images, columns) in second.rchunks_exact_mut(2 * n).zip(first.chunks_exact(2 * n)) {
            for (sign, (image, column)) in
                SIGNS.into_iter().zip(images.chunks_exact_mut(n).zip(columns.chunks_exact(n)))
            {
                let nodes = image.as_chunks_mut::<2>().0.iter_mut().rev().zip(column.as_chunks::<2>().0);
                nodes.for_each(|(image, node)| *image = [SIGNS[0] * sign * node[0], SIGNS[1] * sign * node[1]]);
            }
        }
        out
    }
}

/// `A B`, which is symmetric: the lower half is computed in blocks of columns and mirrored.
pub(super) fn symmetric_product(a: &DMatrix<f64>, b: &DMatrix<f64>) -> DMatrix<f64> {
    let n = a.nrows();
    let mut out = DMatrix::zeros(n, n);
    for first in (0..n).step_by(COLUMNS) {
        let width = COLUMNS.min(n - first);
        let mut part = out.view_mut((first, first), (n - first, width));
        part.gemm(1.0, &a.rows(first, n - first), &b.columns(first, width), 0.0);
    }
    let all = out.as_mut_slice();
    for j in 0..n {
        let (above, own) = all.split_at_mut(j * n);
        above.chunks_exact(n).zip(own).for_each(|(column, entry)| *entry = column[j]);
    }
    out
}

/// Columns of a symmetric product that are computed together.
const COLUMNS: usize = 32;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn halves_of_even_and_odd_modes_give_the_flexibility_of_the_whole() {
        for nodes in [6, 7] {
            let n = 2 * nodes;
            let value = |i: usize, k: usize| ((3 * i + 7 * k + i * k) as f64).sin();
            let mirrored = |i: usize, k: usize| {
                let parity = if k.is_multiple_of(3) { 1.0 } else { -1.0 };
                value(i, k) + parity * SIGNS[i % 2] * value(image(i, n), k)
            };
            let shapes = DMatrix::from_fn(n, 5, mirrored);
            let weights = DVector::from_fn(5, |k, _| 1.0 + k as f64);
            let whole = scale_columns(&shapes, &weights) * shapes.transpose();
            let found = MirroredModes::new(&shapes).unwrap().flexibility(&weights);
            let apart = (found - &whole).amax() / whole.amax();
            println!("{nodes} nodes: {apart:.1e} apart");
            assert!(apart < 1e-14);
            let oblique = DMatrix::from_fn(n, 5, value);
            assert!(MirroredModes::new(&oblique).is_none());
        }
    }
}
