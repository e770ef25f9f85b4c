//! Sparse Cholesky factorisation `A = L Lᵀ` of symmetric positive definite matrices (faer).

use super::vectorised::add_multiples;
use super::{CsrMatrix, LinalgError};
use faer::dyn_stack::{MemBuffer, MemStack, StackReq};
use faer::perm::PermRef;
use faer::sparse::SparseColMatRef;
use faer::sparse::SymbolicSparseColMatRef;
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::amd;
use faer::sparse::linalg::cholesky::supernodal::SupernodalLltRef;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LltRef, SymbolicCholesky, SymbolicCholeskyRaw, SymmetricOrdering,
    factorize_symbolic_cholesky,
};
use faer::{Conj, MatMut, Par, Side};
use nalgebra::DMatrix;
use std::sync::Arc;

/// Fill-reducing ordering and pattern of a Cholesky factor, shared by all matrices of one pattern.
#[derive(Clone, Debug)]
pub struct CholeskyPattern {
    size: usize,
    symbolic: Arc<SymbolicCholesky<usize>>,
    /// The unknowns that were asked to come last.
    last: Arc<[usize]>,
}

impl CholeskyPattern {
    /// Analyses the pattern of a symmetric matrix.
    pub fn new(a: &CsrMatrix) -> Result<Self, LinalgError> {
        Self::analyse(a, &[], SymmetricOrdering::Amd, SupernodalThreshold::AUTO)
    }

    /// Pattern with an order in which the unknowns `last` come last, one after the other. They must be different.
    pub fn with_last(a: &CsrMatrix, last: &[usize]) -> Result<Self, LinalgError> {
        let order = order_with_last(a, last)?;
        let mut inverse = vec![0; order.len()];
        order.iter().enumerate().for_each(|(place, &unknown)| inverse[unknown] = place);
        let order = PermRef::new_checked(&order, &inverse, inverse.len());
        Self::analyse(a, last, SymmetricOrdering::Custom(order), SupernodalThreshold::FORCE_SUPERNODAL)
    }

    fn analyse(
        a: &CsrMatrix,
        last: &[usize],
        order: SymmetricOrdering<'_, usize>,
        threshold: SupernodalThreshold,
    ) -> Result<Self, LinalgError> {
        let size = a.rows();
        if size != a.columns() {
            return Err(LinalgError::SizeMismatch { left: size, right: a.columns() });
        }
        let params = CholeskySymbolicParams { supernodal_flop_ratio_threshold: threshold, ..Default::default() };
        let symbolic = factorize_symbolic_cholesky(a.pattern(), Side::Lower, order, params)
            .map_err(|e| LinalgError::Symbolic { size, reason: format!("{e:?}") })?;
        Ok(Self { size, symbolic: Arc::new(symbolic), last: last.into() })
    }

    /// Factorises a symmetric positive definite matrix of this pattern.
    pub fn factorise(&self, a: &CsrMatrix) -> Result<Cholesky, LinalgError> {
        let (size, symbolic) = (self.size, &self.symbolic);
        if a.rows() != size || a.columns() != size {
            return Err(LinalgError::SizeMismatch { left: size, right: a.rows() });
        }
        let mut memory = buffer(size, symbolic.factorize_numeric_llt_scratch::<f64>(Par::Seq, Default::default()))?;
        let mut values = vec![0.0; symbolic.len_val()];
        let matrix = SparseColMatRef::new(a.pattern(), a.values());
        let (stack, params) = (MemStack::new(&mut memory), Default::default());
        symbolic
            .factorize_numeric_llt(&mut values, matrix, Side::Lower, Default::default(), Par::Seq, stack, params)
            .map_err(|e| LinalgError::NotPositiveDefinite { size, reason: format!("{e:?}") })?;
        Ok(Cholesky { pattern: self.clone(), values })
    }
}

/// Working memory, or an error if there is not enough.
fn buffer(size: usize, request: StackReq) -> Result<MemBuffer, LinalgError> {
    MemBuffer::try_new(request).map_err(|e| LinalgError::Symbolic { size, reason: format!("{e:?}") })
}

/// An order of elimination: approximate minimum degree of all unknowns but `last`, then these.
fn order_with_last(a: &CsrMatrix, last: &[usize]) -> Result<Vec<usize>, LinalgError> {
    let mut inner = vec![true; a.rows()];
    last.iter().for_each(|&unknown| inner[unknown] = false);
    let unknowns: Vec<usize> = (0..a.rows()).filter(|&i| inner[i]).collect();
    let mut places = vec![0; a.rows()];
    unknowns.iter().enumerate().for_each(|(place, &unknown)| places[unknown] = place);
    let (mut starts, mut indices) = (vec![0], Vec::with_capacity(a.stored()));
    for &i in &unknowns {
        indices.extend(a.row(i).filter(|entry| inner[entry.0]).map(|entry| places[entry.0]));
        starts.push(indices.len());
    }
    let size = unknowns.len();
    let (mut order, mut inverse) = (vec![0; size], vec![0; size]);
    let mut memory = buffer(size, amd::order_maybe_unsorted_scratch::<usize>(size, indices.len()))?;
    let pattern = SymbolicSparseColMatRef::new_checked(size, size, &starts, None, &indices);
    let control = amd::Control::default();
    amd::order_maybe_unsorted(&mut order, &mut inverse, pattern, control, MemStack::new(&mut memory))
        .map_err(|e| LinalgError::Symbolic { size, reason: format!("{e:?}") })?;
    Ok(order.iter().map(|&place| unknowns[place]).chain(last.iter().copied()).collect())
}

/// Factor `L` of a symmetric positive definite matrix.
#[derive(Clone, Debug)]
pub struct Cholesky {
    pattern: CholeskyPattern,
    values: Vec<f64>,
}

impl Cholesky {
    /// Analyses and factorises.
    pub fn new(a: &CsrMatrix) -> Result<Self, LinalgError> {
        CholeskyPattern::new(a)?.factorise(a)
    }

    /// Factor of `a` with the unknowns `last` at the end of the elimination.
    pub fn with_last(a: &CsrMatrix, last: &[usize]) -> Result<Self, LinalgError> {
        CholeskyPattern::with_last(a, last)?.factorise(a)
    }

    /// The unknowns that were asked to come last.
    pub fn last(&self) -> &[usize] {
        &self.pattern.last
    }

    /// Number of unknowns.
    pub fn size(&self) -> usize {
        self.pattern.size
    }

    /// Replaces each column of length `size` in `columns` by `A⁻¹` times it.
    pub fn solve_in_place(&self, columns: &mut [f64]) {
        let n = self.size();
        if n == 0 || columns.is_empty() {
            return;
        }
        match self.pattern.symbolic.raw() {
            SymbolicCholeskyRaw::Supernodal(symbolic) if columns.len() > n => {
                let factor = SupernodalLltRef::new(symbolic, &self.values);
                let order = self.pattern.symbolic.perm().map(|order| order.arrays().0);
                let (mut rest, mut lines) = (columns, Vec::new());
                while rest.len() > 4 * n {
                    let (some, others) = rest.split_at_mut(rest.len().min(8 * n));
                    solve_together::<8>(factor, order, some, &mut lines);
                    rest = others;
                }
                if !rest.is_empty() {
                    solve_together::<4>(factor, order, rest, &mut Vec::new());
                }
            }
            // Of one column, the library makes more.
            _ => {
                let (symbolic, count) = (&self.pattern.symbolic, columns.len() / n);
                let view = MatMut::from_column_major_slice_mut(columns, n, count);
                let mut memory = MemBuffer::new(symbolic.solve_in_place_scratch::<f64>(count, Par::Seq));
                let factor = LltRef::<'_, usize, f64>::new(symbolic, &self.values);
                factor.solve_in_place_with_conj(Conj::No, view, Par::Seq, MemStack::new(&mut memory));
            }
        }
    }

    /// `X ← A⁻¹ X`.
    pub fn solve_columns(&self, x: &mut DMatrix<f64>) {
        self.solve_in_place(x.as_mut_slice());
    }

    /// The block of `A⁻¹` that belongs to the unknowns that were asked to come last: `(L_ss L_ssᵀ)⁻¹` with their
    /// triangle `L_ss` at the end of the factor. `None` if no order was asked for.
    pub fn last_block_of_inverse(&self) -> Option<DMatrix<f64>> {
        let SymbolicCholeskyRaw::Supernodal(symbolic) = self.pattern.symbolic.raw() else { return None };
        let count = self.pattern.last.len();
        let first = self.size() - count;
        let factor = SupernodalLltRef::new(symbolic, &self.values);
        let mut triangle = DMatrix::zeros(count, count);
        for s in 0..symbolic.n_supernodes() {
            let node = factor.supernode(s);
            let (start, values) = (node.start(), node.val());
            let rows: Vec<usize> = (start..start + values.ncols()).chain(node.pattern().iter().copied()).collect();
            for j in first.saturating_sub(start)..values.ncols() {
                for i in j..rows.len() {
                    triangle[(rows[i] - first, start + j - first)] = values[(i, j)];
                }
            }
        }
        let inverse = triangle.solve_lower_triangular(&DMatrix::identity(count, count))?;
        Some(inverse.tr_mul(&inverse))
    }
}

/// Solves for at most `W` columns, whose entries are put side by side in `lines`, in the order of elimination.
fn solve_together<const W: usize>(
    factor: SupernodalLltRef<'_, usize, f64>,
    order: Option<&[usize]>,
    columns: &mut [f64],
    lines: &mut Vec<[f64; W]>,
) {
    let n = factor.symbolic().nrows();
    lines.clear();
    lines.resize(n, [0.0; W]);
    let unknown = |place: usize| order.map_or(place, |order| order[place]);
    for (k, column) in columns.chunks(n).enumerate() {
        lines.iter_mut().enumerate().for_each(|(place, line)| line[k] = column[unknown(place)]);
    }
    pulp::Arch::new().dispatch(Substitution { factor, lines });
    for (k, column) in columns.chunks_mut(n).enumerate() {
        lines.iter().enumerate().for_each(|(place, line)| column[unknown(place)] = line[k]);
    }
}

/// `L Lᵀ X = B` in place.
struct Substitution<'a, const W: usize> {
    factor: SupernodalLltRef<'a, usize, f64>,
    lines: &'a mut [[f64; W]],
}

impl<const W: usize> pulp::WithSimd for Substitution<'_, W> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, simd: S) {
        let Self { factor, lines } = self;
        for s in 0..factor.symbolic().n_supernodes() {
            let node = factor.supernode(s);
            let (start, height) = (node.start(), node.val().nrows());
            let values = &factor.values()[factor.symbolic().col_ptr_for_val()[s]..];
            let columns = values.chunks_exact(height).take(node.val().ncols());
            forward(simd, columns, start, node.pattern(), lines);
        }
        for s in (0..factor.symbolic().n_supernodes()).rev() {
            let node = factor.supernode(s);
            let (start, height) = (node.start(), node.val().nrows());
            let values = &factor.values()[factor.symbolic().col_ptr_for_val()[s]..];
            backward(simd, &values[..height * node.val().ncols()], height, (start, node.pattern()), lines);
        }
    }
}

/// `y ← y − a x`.
#[inline(always)]
fn subtract<const W: usize>(y: &mut [f64; W], a: f64, x: &[f64; W]) {
    y.iter_mut().zip(x).for_each(|(y, x)| *y -= a * x);
}

/// Columns of a supernode that are used together.
const TOGETHER: usize = 4;

/// Forward substitution with the columns of one supernode, each with its diagonal block first.
#[inline(always)]
fn forward<'a, S: pulp::Simd, const W: usize>(
    simd: S,
    columns: impl ExactSizeIterator<Item = &'a [f64]> + Clone,
    start: usize,
    pattern: &[usize],
    lines: &mut [[f64; W]],
) {
    let count = columns.len();
    let (_, own) = lines.split_at_mut(start);
    for (j, column) in columns.clone().enumerate() {
        let (head, tail) = own[j..count].split_at_mut(1);
        head[0].iter_mut().for_each(|x| *x /= column[j]);
        tail.iter_mut().zip(&column[j + 1..count]).for_each(|(x, a)| subtract(x, *a, &head[0]));
    }
    let mut columns = columns.map(|column| &column[count..]);
    let mut j = start;
    while let Some(a) = columns.next() {
        match (columns.next(), columns.next(), columns.next()) {
            (Some(b), Some(c), Some(d)) => {
                let mut less = [lines[j], lines[j + 1], lines[j + 2], lines[j + 3]];
                less.as_flattened_mut().iter_mut().for_each(|x| *x = -*x);
                for ((((&row, a), b), c), d) in pattern.iter().zip(a).zip(b).zip(c).zip(d) {
                    add_multiples(simd, [*a, *b, *c, *d], &less, &mut lines[row]);
                }
            }
            (b, c, _) => {
                for (column, at) in [Some(a), b, c].into_iter().flatten().zip(j..) {
                    let x = lines[at];
                    pattern.iter().zip(column).for_each(|(&row, a)| subtract(&mut lines[row], *a, &x));
                }
            }
        }
        j += TOGETHER;
    }
}

/// Backward substitution with the columns of one supernode, `height` numbers each.
#[inline(always)]
fn backward<S: pulp::Simd, const W: usize>(
    simd: S,
    values: &[f64],
    height: usize,
    (start, pattern): (usize, &[usize]),
    lines: &mut [[f64; W]],
) {
    let count = values.len() / height;
    for first in (0..count).step_by(TOGETHER) {
        let few = TOGETHER.min(count - first);
        // Columns beyond the last repeat it; their sums are not used.
        let column = |k: usize| &values[(first + k.min(few - 1)) * height..][count..height];
        let [a, b, c, d] = [column(0), column(1), column(2), column(3)];
        let mut sums = [[0.0; W]; TOGETHER];
        for ((((&row, a), b), c), d) in pattern.iter().zip(a).zip(b).zip(c).zip(d) {
            let line = [lines[row]];
            for (sum, a) in sums.iter_mut().zip([a, b, c, d]) {
                add_multiples(simd, [*a], &line, sum);
            }
        }
        for (line, sum) in lines[start + first..start + first + few].iter_mut().zip(&sums) {
            subtract(line, 1.0, sum);
        }
    }
    let own = &mut lines[start..start + count];
    for j in (0..count).rev() {
        let column = &values[j * height..];
        let (head, tail) = own[j..].split_at_mut(1);
        tail.iter().zip(&column[j + 1..count]).for_each(|(x, a)| subtract(&mut head[0], *a, x));
        head[0].iter_mut().for_each(|x| *x /= column[j]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn laplacian(n: usize) -> CsrMatrix {
        let mut t = Vec::new();
        for i in 0..n {
            t.push((i, i, 1.0));
            t.push((i, i, 1.0 + 1.0 / n as f64));
            if i > 0 {
                t.push((i, i - 1, -1.0));
                t.push((i - 1, i, -1.0));
            }
        }
        CsrMatrix::from_triplets(n, n, &t).unwrap()
    }

    #[test]
    fn cholesky_solution_satisfies_the_equations() {
        let a = laplacian(50);
        let x = DMatrix::from_fn(50, 3, |i, j| ((i * 7 + j * 3) % 11) as f64 - 5.0);
        let b = a.multiply_columns(&x);
        for factor in [Cholesky::new(&a), Cholesky::with_last(&a, &[3, 40, 7])] {
            let mut found = b.clone();
            factor.unwrap().solve_columns(&mut found);
            assert!((found - &x).amax() < 1e-10);
        }
    }

    #[test]
    fn block_of_the_inverse_is_read_off_the_factor() {
        let a = laplacian(50);
        let inverse = DMatrix::from_fn(50, 50, |i, j| a.get(i, j)).try_inverse().unwrap();
        for last in [&[12, 13, 30, 4, 49][..], &(0..50).collect::<Vec<_>>(), &[]] {
            let block = Cholesky::with_last(&a, last).unwrap().last_block_of_inverse().unwrap();
            let exact = DMatrix::from_fn(last.len(), last.len(), |i, j| inverse[(last[i], last[j])]);
            assert!((block - exact).iter().all(|error| error.abs() < 1e-12 * inverse.amax()), "{last:?}");
        }
    }

    #[test]
    fn indefinite_matrices_are_refused() {
        let a = CsrMatrix::from_triplets(2, 2, &[(0, 0, 1.0), (1, 1, -1.0)]).unwrap();
        assert!(matches!(Cholesky::new(&a), Err(LinalgError::NotPositiveDefinite { size: 2, .. })));
    }
}
