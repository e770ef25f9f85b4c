//! Lowest modes of `K φ = Ω² M φ` by a block Lanczos iteration with shift-invert.
//!
//! The operator `T = K⁻¹ M` is self-adjoint in the inner product of `M`; its largest eigenvalues are `1/Ω²`. A Krylov
//! space of blocks is built with full reorthogonalisation (Golub & Van Loan, *Matrix Computations*, 4th ed., 10.3.6),
//! followed by one inverse iteration and a Rayleigh–Ritz projection on the pencil itself.

use super::blocks::{apply, orthonormalise, solve};
use super::{Cholesky, CsrMatrix, LinalgError};
use faer::Mat;
use nalgebra::{DMatrix, DVector, SymmetricEigen};

/// Vectors added to the Krylov space at a time.
const BLOCK: usize = 8;
/// Accepted residual `‖T φ − θ φ‖_M / θ` before the final inverse iteration.
const TOLERANCE: f64 = 1e-9;

/// Modes `Φᵀ M Φ = 1`, `Φᵀ K Φ = diag(Ω²)`, ascending.
#[derive(Clone, Debug)]
pub struct VibrationModes {
    /// Squared natural frequencies `Ω²` [rad²/s²].
    pub squared_frequencies: DVector<f64>,
    /// One mode per column.
    pub shapes: DMatrix<f64>,
}

/// The `count` lowest modes; `factor` is the Cholesky factor of `stiffness`.
///
/// Start vectors are fixed and every mode has a positive product with a fixed vector, so that the result is
/// reproducible. `progress` receives the share of the work done, 0 to 1.
pub fn lowest_modes(
    stiffness: &CsrMatrix,
    factor: &Cholesky,
    mass: &CsrMatrix,
    count: usize,
    progress: &mut dyn FnMut(f64),
) -> Result<VibrationModes, LinalgError> {
    let n = factor.size();
    if count > n {
        return Err(LinalgError::TooManyModes { wanted: count, size: n });
    }
    if mass.rows() != n || stiffness.rows() != n {
        return Err(LinalgError::SizeMismatch { left: n, right: mass.rows() });
    }
    let mut ritz = krylov(factor, mass, count, progress)?;
    // One inverse iteration removes rough error, which K would magnify.
    apply(mass, &mut ritz);
    solve(factor, &mut ritz);
    let (squared_frequencies, mut shapes) = rayleigh_ritz(stiffness, mass, &ritz)?;
    let mut reference = DMatrix::from_column_slice(n, 1, &noise(n, 0));
    reference = mass.multiply_columns(&reference);
    for mut shape in shapes.column_iter_mut() {
        if shape.dot(&reference.column(0)) < 0.0 {
            shape.neg_mut();
        }
    }
    progress(1.0);
    Ok(VibrationModes { squared_frequencies, shapes })
}

/// Number of vectors in the Krylov space that suffices for `count` modes of bodies as long as they are high, or ten times
/// as long.
pub fn usual_space(count: usize) -> usize {
    6 * count + 60
}

/// Largest number of vectors in the Krylov space for `count` modes.
///
/// A long body on a fixed base has a cut-off frequency, above which its modes crowd: their distance falls with the square of
/// the length, and the space has to grow with the length to tell them apart, however few of them are wanted. A rail of
/// 100 m with a height of 0.1 m took 384 vectors for one mode and 848 for 200.
pub fn largest_space(count: usize) -> usize {
    usual_space(count) + 800
}

/// `count` Ritz vectors of `T` with residuals below [`TOLERANCE`], largest eigenvalue first.
fn krylov(
    factor: &Cholesky,
    mass: &CsrMatrix,
    count: usize,
    progress: &mut dyn FnMut(f64),
) -> Result<Mat<f64>, LinalgError> {
    let n = factor.size();
    let limit = largest_space(count).min(n);
    let mut next_check = (3 * count + 3 * BLOCK).min(limit);
    let mut basis = Mat::<f64>::zeros(n, usual_space(count).min(n) + BLOCK);
    let mut projected = DMatrix::<f64>::zeros(limit + BLOCK, limit + BLOCK);
    let (mut block, _) = orthonormalise(mass, &basis, 0, start_block(factor, mass, 0));
    let (mut size, mut restarts) = (0, 0);
    loop {
        let width = block.ncols().min(limit - size);
        let columns = size..size + width;
        if columns.end > basis.ncols() {
            basis = enlarged(&basis, (basis.ncols() + basis.ncols() / 2).min(limit + BLOCK));
        }
        basis.subcols_mut(size, width).copy_from(block.subcols(0, width));
        size += width;
        let mut image = block.subcols(0, width).to_owned();
        apply(mass, &mut image);
        solve(factor, &mut image);
        let (next, coefficients) = orthonormalise(mass, &basis, size, image);
        for (j, column) in columns.clone().enumerate() {
            for i in 0..size + next.ncols() {
                projected[(i, column)] = coefficients[(i, j)];
            }
        }
        progress(0.9 * (size as f64 / (3.2 * count as f64 + 20.0)).min(1.0));
        let exhausted = next.ncols() == 0;
        if size >= next_check || size == limit || (exhausted && size >= count) {
            next_check = (size + 4 * BLOCK).min(limit);
            let (vectors, residuals) = ritz_pairs(&projected, size, width, next.ncols())?;
            let kept = count.min(size);
            let converged = residuals.iter().take(kept).take_while(|r| **r <= TOLERANCE).count();
            if converged == count {
                return Ok(basis.subcols(0, size) * vectors.subcols(0, count));
            }
            if size == limit {
                let residual = residuals.get(converged).copied().unwrap_or(f64::NAN);
                return Err(LinalgError::ModesNotConverged { wanted: count, converged, space: size, residual });
            }
        }
        block = next;
        while block.ncols() == 0 && restarts < limit {
            restarts += 1;
            block = orthonormalise(mass, &basis, size, start_block(factor, mass, restarts)).0;
        }
        if block.ncols() == 0 {
            let residual = f64::NAN;
            return Err(LinalgError::ModesNotConverged { wanted: count, converged: 0, space: size, residual });
        }
    }
}

/// The same columns with room for more, `columns` in all.
fn enlarged(basis: &Mat<f64>, columns: usize) -> Mat<f64> {
    let mut larger = Mat::zeros(basis.nrows(), columns);
    larger.subcols_mut(0, basis.ncols()).copy_from(basis);
    larger
}

/// Eigenvectors of the projected operator, largest eigenvalue first, and the relative residuals of the Ritz pairs.
fn ritz_pairs(
    projected: &DMatrix<f64>,
    size: usize,
    last: usize,
    next: usize,
) -> Result<(Mat<f64>, Vec<f64>), LinalgError> {
    let symmetric = Mat::from_fn(size, size, |i, j| if i <= j { projected[(i, j)] } else { projected[(j, i)] });
    let (values, vectors) = dense_eigen(&symmetric)?;
    let reversed = Mat::from_fn(size, size, |i, j| vectors[(i, size - 1 - j)]);
    let residuals = (0..size)
        .map(|k| {
            let squared: f64 = (0..next)
                .map(|i| {
                    let row = size + i;
                    (size - last..size).map(|j| projected[(row, j)] * reversed[(j, k)]).sum::<f64>().powi(2)
                })
                .sum();
            squared.sqrt() / values[size - 1 - k].abs().max(f64::MIN_POSITIVE)
        })
        .collect();
    Ok((reversed, residuals))
}

/// Rayleigh–Ritz projection of the pencil `(K, M)` on the columns of `x`: ascending `Ω²` and `M`-orthonormal modes.
fn rayleigh_ritz(
    stiffness: &CsrMatrix,
    mass: &CsrMatrix,
    x: &Mat<f64>,
) -> Result<(DVector<f64>, DMatrix<f64>), LinalgError> {
    let mut mx = x.clone();
    apply(mass, &mut mx);
    let mut kx = x.clone();
    apply(stiffness, &mut kx);
    let m = x.ncols();
    let gram = x.transpose() * &mx;
    // Whitening of the (nearly diagonal) Gram matrix, after scaling by its diagonal.
    let scale: Vec<f64> = (0..m).map(|i| gram[(i, i)].sqrt().recip()).collect();
    let (values, vectors) =
        dense_eigen(&Mat::from_fn(m, m, |i, j| 0.5 * (gram[(i, j)] + gram[(j, i)]) * scale[i] * scale[j]))?;
    let whitening = Mat::from_fn(m, m, |i, j| scale[i] * vectors[(i, j)] / values[j].sqrt());
    let h = whitening.transpose() * (x.transpose() * &kx) * &whitening;
    let (squared, rotation) = dense_eigen(&Mat::from_fn(m, m, |i, j| 0.5 * (h[(i, j)] + h[(j, i)])))?;
    let shapes = x * (whitening * rotation);
    let shapes = DMatrix::from_fn(x.nrows(), m, |i, j| shapes[(i, j)]);
    Ok((DVector::from_vec(squared), shapes))
}

/// Eigenvalues (ascending) and eigenvectors of a dense symmetric matrix.
///
/// nalgebra's QR iteration: on the projected operators the divide and conquer of faer 0.24.4 leaves relative residuals of
/// 1e-6, nine digits more than round-off (see also faer-rs issue 273).
fn dense_eigen(a: &Mat<f64>) -> Result<(Vec<f64>, Mat<f64>), LinalgError> {
    let size = a.nrows();
    let dense = DMatrix::from_fn(size, size, |i, j| a[(i, j)]);
    let eigen = SymmetricEigen::try_new(dense, f64::EPSILON, 100 * size).ok_or(LinalgError::Eigen { size })?;
    let mut order: Vec<usize> = (0..size).collect();
    order.sort_by(|&i, &j| eigen.eigenvalues[i].total_cmp(&eigen.eigenvalues[j]));
    let values = order.iter().map(|&i| eigen.eigenvalues[i]).collect();
    Ok((values, Mat::from_fn(size, size, |i, j| eigen.eigenvectors[(i, order[j])])))
}

/// Smoothed pseudo-random start vectors, the same in every run.
fn start_block(factor: &Cholesky, mass: &CsrMatrix, seed: usize) -> Mat<f64> {
    let n = factor.size();
    let width = BLOCK.min(n);
    let columns: Vec<Vec<f64>> = (0..width).map(|j| noise(n, seed * BLOCK + j + 1)).collect();
    let mut block = Mat::from_fn(n, width, |i, j| columns[j][i]);
    apply(mass, &mut block);
    solve(factor, &mut block);
    block
}

/// Uniform pseudo-random numbers in (−1, 1) (linear congruential generator of Knuth's MMIX).
fn noise(n: usize, seed: usize) -> Vec<f64> {
    let mut state = 0x9E37_79B9_7F4A_7C15_u64.wrapping_mul(seed as u64 + 1);
    (0..n)
        .map(|_| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mechanics::testing::paper_d;
    use crate::mechanics::{BodySystem, rail_system};
    use faer::MatRef;
    use std::f64::consts::PI;

    /// The operator `K⁻¹ M` in a Krylov space of `size` vectors: what [`krylov`] hands to [`dense_eigen`].
    fn projected_operator(k: &CsrMatrix, m: &CsrMatrix, size: usize) -> Mat<f64> {
        let n = k.rows();
        let factor = Cholesky::new(k).unwrap();
        let mut basis = Mat::<f64>::zeros(n, size + BLOCK);
        let mut projected = Mat::<f64>::zeros(size, size);
        let (mut block, _) = orthonormalise(m, &basis, 0, start_block(&factor, m, 0));
        for first in (0..size).step_by(BLOCK) {
            basis.subcols_mut(first, BLOCK).copy_from(&block);
            let mut image = block.clone();
            apply(m, &mut image);
            solve(&factor, &mut image);
            let (next, coefficients) = orthonormalise(m, &basis, first + BLOCK, image);
            for j in 0..BLOCK {
                for i in 0..first + BLOCK {
                    projected[(i, first + j)] = coefficients[(i, j)];
                    projected[(first + j, i)] = coefficients[(i, j)];
                }
            }
            block = next;
        }
        projected
    }

    /// Largest relative residual `‖A v − λ v‖/‖A‖` of the eigenpairs.
    fn residual(a: &Mat<f64>, values: &[f64], vectors: MatRef<'_, f64>) -> f64 {
        let image = a * vectors;
        let norm = values.iter().fold(0.0_f64, |norm, value| norm.max(value.abs()));
        let pairs = values.iter().enumerate();
        pairs
            .map(|(j, value)| (image.col(j) - vectors.col(j) * faer::Scale(*value)).norm_l2() / norm)
            .fold(0.0, f64::max)
    }

    /// Why [`dense_eigen`] is nalgebra's: on the projected operator of a rail faer loses digits. Once this test fails because
    /// faer is accurate, its own eigenvalue solver can take over.
    #[test]
    fn dense_eigenpairs_are_accurate_to_round_off_where_divide_and_conquer_loses_digits() {
        let system = rail_system(&paper_d(5)).unwrap();
        let a = projected_operator(&system.stiffness, &system.mass, 264);
        let (values, vectors) = dense_eigen(&a).unwrap();
        let ours = residual(&a, &values, vectors.as_ref());
        let other = a.self_adjoint_eigen(faer::Side::Lower).unwrap();
        let values: Vec<f64> = other.S().column_vector().iter().copied().collect();
        let theirs = residual(&a, &values, other.U());
        println!("relative residual: nalgebra {ours:.1e}, faer {theirs:.1e}");
        assert!(ours < 1e-13 && theirs > 1e-12);
    }

    /// Fixed string of `n` unit masses and unit springs.
    fn chain(n: usize) -> (CsrMatrix, CsrMatrix) {
        let (mut k, mut m) = (Vec::new(), Vec::new());
        for i in 0..n {
            k.push((i, i, 2.0));
            m.push((i, i, 1.0));
            if i > 0 {
                k.push((i, i - 1, -1.0));
                k.push((i - 1, i, -1.0));
            }
        }
        (CsrMatrix::from_triplets(n, n, &k).unwrap(), CsrMatrix::from_triplets(n, n, &m).unwrap())
    }

    #[test]
    fn chain_frequencies_are_two_sine_of_half_the_wave_number() {
        let n = 400;
        let (k, m) = chain(n);
        let modes = lowest_modes(&k, &Cholesky::new(&k).unwrap(), &m, 20, &mut |_| {}).unwrap();
        for (i, value) in modes.squared_frequencies.iter().enumerate() {
            let exact = 4.0 * ((i + 1) as f64 * PI / (2.0 * (n + 1) as f64)).sin().powi(2);
            assert!((value / exact - 1.0).abs() < 1e-11, "mode {i}: {value} against {exact}");
        }
        let identity = modes.shapes.transpose() * m.multiply_columns(&modes.shapes);
        assert!((identity - DMatrix::identity(20, 20)).amax() < 1e-12);
    }

    /// Close to the cut-off frequency of a long body on a fixed base, modes crowd. That they are modes shows in the residual of
    /// the pencil, that the lowest is there in the Cholesky factorisation of `K − σM`, which exists below it only, and that
    /// none is left out in the same frequencies from a larger space (a high column is so soft that its lowest frequency carries
    /// the round-off of the stiffest cells).
    #[test]
    fn modes_of_long_low_rails_are_found_although_they_crowd() {
        for (length, height) in [(0.12, 2.0), (5.0, 0.1), (20.0, 0.02), (100.0, 0.02)] {
            let mut config = paper_d(4);
            (config.rail.length, config.rail.height) = (length, height);
            let BodySystem { stiffness, mass, .. } = rail_system(&config).unwrap();
            let factor = Cholesky::new(&stiffness).unwrap();
            let [one, twenty, forty] =
                [1, 20, 40].map(|count| lowest_modes(&stiffness, &factor, &mass, count, &mut |_| {}).unwrap());
            let (kx, mx) = (stiffness.multiply_columns(&forty.shapes), mass.multiply_columns(&forty.shapes));
            for (j, square) in forty.squared_frequencies.iter().enumerate() {
                let residual = (kx.column(j) - mx.column(j) * *square).norm() / kx.column(j).norm();
                assert!(residual < 1e-6, "rail of {length} m, mode {j}: {residual:e}");
            }
            for fewer in [one, twenty] {
                for (few, many) in fewer.squared_frequencies.iter().zip(&forty.squared_frequencies) {
                    assert!((few / many - 1.0).abs() < 1e-7, "rail of {length} m: {few} against {many}");
                }
            }
            let shifted =
                |square: f64| Cholesky::new(&CsrMatrix::combination(1.0, &stiffness, -square, &mass).unwrap());
            let lowest = forty.squared_frequencies[0];
            assert!(shifted(lowest * (1.0 - 1e-6)).is_ok() && shifted(lowest * (1.0 + 1e-6)).is_err());
        }
    }

    /// What `rail.length` and `solver.modes_rail` allow; prints the time.
    #[test]
    #[ignore = "minutes; run by hand after changes to the iteration"]
    fn any_number_of_modes_is_found_for_rails_of_any_size() {
        for (length, height) in [(0.12, 0.02), (0.12, 2.0), (2.0, 2.0), (20.0, 0.02), (100.0, 0.02), (100.0, 2.0)] {
            for count in [1, 20, 80, 200] {
                let mut config = paper_d(4);
                (config.rail.length, config.rail.height) = (length, height);
                let system = rail_system(&config).unwrap();
                let factor = Cholesky::new(&system.stiffness).unwrap();
                let start = std::time::Instant::now();
                let modes = lowest_modes(&system.stiffness, &factor, &system.mass, count, &mut |_| {});
                println!("rail {length} m x {height} m, {count} modes: {:.1} s", start.elapsed().as_secs_f64());
                assert_eq!(modes.map(|modes| modes.squared_frequencies.len()), Ok(count));
            }
        }
    }

    #[test]
    fn all_modes_of_a_small_system_and_no_more() {
        let (k, m) = chain(12);
        let factor = Cholesky::new(&k).unwrap();
        let modes = lowest_modes(&k, &factor, &m, 12, &mut |_| {}).unwrap();
        assert!((modes.squared_frequencies.sum() - 24.0).abs() < 1e-10);
        let refused = lowest_modes(&k, &factor, &m, 13, &mut |_| {});
        assert_eq!(refused.err(), Some(LinalgError::TooManyModes { wanted: 13, size: 12 }));
    }
}
