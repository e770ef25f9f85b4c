//! Lowest modes of `K φ = Ω² M φ` by a block Lanczos iteration with shift-invert.
//!
//! The operator `T = K⁻¹ M` is self-adjoint in the inner product of `M`; its largest eigenvalues are `1/Ω²`. A Krylov
//! space of blocks is built with full reorthogonalisation (Golub & Van Loan, *Matrix Computations*, 4th ed., 10.3.6),
//! followed by one inverse iteration and a Rayleigh–Ritz projection of the pencil, both within that space.
//!
//! The iteration is not `partial_self_adjoint_eigen` of faer 0.24.4, which finds the same frequencies to 1e-11 but
//! takes 1.7 s in place of 0.8 s for the even modes of the default wheel, did not end within 40 s for its odd ones and
//! for 40 modes of a rail of 20 m × 0.02 m (tolerance 1e-9), and panics where the space reaches the matrix size.

use super::dense::symmetrise;
use super::krylov::{Krylov, Oscillator, RitzPairs, dense_eigen, noise};
use super::side_by_side::{join, side_by_side};
use super::{Cholesky, CsrMatrix, LinalgError};
use nalgebra::{DMatrix, DVector};

pub use super::krylov::{largest_space, usual_space};

/// Modes `Φᵀ M Φ = 1`, `Φᵀ K Φ = diag(Ω²)`, ascending.
#[derive(Clone, Debug)]
pub struct VibrationModes {
    /// Squared natural frequencies `Ω²` [rad²/s²].
    pub squared_frequencies: DVector<f64>,
    /// One mode per column.
    pub shapes: DMatrix<f64>,
}

/// The `count` lowest modes; `factor` is the Cholesky factor of the stiffness.
///
/// Start vectors are fixed and every mode has a positive product with a fixed vector, so that the result is
/// reproducible. `progress` receives the share of the work done, 0 to 1.
pub fn lowest_modes(
    factor: &Cholesky,
    mass: &CsrMatrix,
    count: usize,
    progress: &mut dyn FnMut(f64),
) -> Result<VibrationModes, LinalgError> {
    let modes = lowest_modes_of_parts(&[Oscillator { mass, factor }], count, progress)?;
    modes.into_iter().next().ok_or(LinalgError::TooManyModes { wanted: count, size: 0 })
}

/// Those of the `count` lowest modes of several oscillators together that belong to each. Each has a thread of its own;
/// `progress` receives the share that the first one has done.
pub fn lowest_modes_of_parts(
    parts: &[Oscillator<'_>],
    count: usize,
    progress: &mut dyn FnMut(f64),
) -> Result<Vec<VibrationModes>, LinalgError> {
    let size: usize = parts.iter().map(|part| part.factor.size()).sum();
    if count > size {
        return Err(LinalgError::TooManyModes { wanted: count, size });
    }
    for Oscillator { mass, factor } in parts {
        if mass.rows() != factor.size() {
            return Err(LinalgError::SizeMismatch { left: factor.size(), right: mass.rows() });
        }
    }
    let (spaces, counts) = lowest_ritz_pairs(parts, count, progress)?;
    let modes = side_by_side(parts.len(), |k| polished(&parts[k], &spaces[k].0, &spaces[k].1, counts[k]));
    progress(1.0);
    modes.into_iter().collect()
}

/// Space of a part, and the Ritz pairs that were asked for.
type Searched<'a> = (Krylov<'a>, RitzPairs);

/// Spaces and Ritz pairs of every part, and how many of each belong to the `count` lowest of all.
fn lowest_ritz_pairs<'a>(
    parts: &[Oscillator<'a>],
    count: usize,
    progress: &mut dyn FnMut(f64),
) -> Result<(Vec<Searched<'a>>, Vec<usize>), LinalgError> {
    // Of several parts, one may have more than its share; its last known mode must not be among the lowest.
    let several = usize::from(parts.len() > 1);
    let mut wanted: Vec<usize> =
        parts.iter().map(|part| (count.div_ceil(parts.len()) + 2 * several).min(part.factor.size())).collect();
    let converged = |k: usize, report: &mut dyn FnMut(usize)| {
        let mut space = Krylov::new(parts[k]);
        space.converge(wanted[k], report).map(|pairs| (space, pairs))
    };
    let expected = 3.2 * wanted.first().map_or(0.0, |wanted| *wanted as f64) + 20.0;
    let mut report = |size| progress(0.9 * (size as f64 / expected).min(1.0));
    let others = || side_by_side(parts.len().saturating_sub(1), |k| converged(k + 1, &mut |_| {}));
    let (first, others) = join(|| (!parts.is_empty()).then(|| converged(0, &mut report)), others);
    let mut found = first.into_iter().chain(others).collect::<Result<Vec<_>, _>>()?;
    loop {
        let values = |(k, (_, pairs)): (usize, &(_, RitzPairs))| -> Vec<(f64, usize)> {
            pairs.values.iter().map(|value| (*value, k)).collect()
        };
        let mut lowest: Vec<(f64, usize)> = found.iter().enumerate().flat_map(values).collect();
        lowest.sort_by(|a, b| b.0.total_cmp(&a.0));
        lowest.truncate(count);
        let counts: Vec<usize> = (0..parts.len()).map(|k| lowest.iter().filter(|pair| pair.1 == k).count()).collect();
        let short = |k: &usize| several > 0 && counts[*k] == wanted[*k] && wanted[*k] < parts[*k].factor.size();
        let Some(k) = (0..parts.len()).find(short) else { return Ok((found, counts)) };
        wanted[k] = (wanted[k] + 2).min(parts[k].factor.size());
        let (space, pairs) = &mut found[k];
        *pairs = space.converge(wanted[k], &mut |_| {})?;
    }
}

/// Modes from Ritz pairs. The Ritz vectors are [images](Krylov::images) under `T` first, an inverse iteration, which leaves
/// less of what is rough and of higher modes; then comes the Rayleigh–Ritz projection of the pencil on them.
fn polished(
    part: &Oscillator<'_>,
    space: &Krylov<'_>,
    pairs: &RitzPairs,
    count: usize,
) -> Result<VibrationModes, LinalgError> {
    let n = part.factor.size();
    if count == 0 {
        return Ok(VibrationModes { squared_frequencies: DVector::zeros(0), shapes: DMatrix::zeros(n, 0) });
    }
    let (images, [gram, stiffness]) = space.images(pairs, count);
    let (squared_frequencies, rotation) = rayleigh_ritz(&gram, &stiffness)?;
    let mut shapes = space.combinations(&(images * rotation));
    let mut reference = vec![0.0; n];
    part.mass.multiply(&noise(n, 0), &mut reference);
    let reference = DVector::from_vec(reference);
    for mut shape in shapes.column_iter_mut() {
        if shape.dot(&reference) < 0.0 {
            shape.neg_mut();
        }
    }
    Ok(VibrationModes { squared_frequencies, shapes })
}

/// Rayleigh–Ritz projection on vectors X from `gram = Xᵀ M X` and `stiffness = Xᵀ K X`: ascending `Ω²`, and the
/// combinations of X that are `M`-orthonormal modes.
fn rayleigh_ritz(gram: &DMatrix<f64>, stiffness: &DMatrix<f64>) -> Result<(DVector<f64>, DMatrix<f64>), LinalgError> {
    let m = gram.ncols();
    // Whitening of the (nearly diagonal) Gram matrix, after scaling by its diagonal.
    let scale: Vec<f64> = (0..m).map(|i| gram[(i, i)].sqrt().recip()).collect();
    let scaled = DMatrix::from_fn(m, m, |i, j| 0.5 * (gram[(i, j)] + gram[(j, i)]) * scale[i] * scale[j]);
    let (values, vectors) = dense_eigen(scaled)?;
    let whitening = DMatrix::from_fn(m, m, |i, j| scale[i] * vectors[(i, j)] / values[j].sqrt());
    let mut h = whitening.tr_mul(stiffness) * &whitening;
    symmetrise(&mut h);
    let (squared, rotation) = dense_eigen(h)?;
    Ok((DVector::from_vec(squared), whitening * rotation))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

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
        let modes = lowest_modes(&Cholesky::new(&k).unwrap(), &m, 20, &mut |_| {}).unwrap();
        for (i, value) in modes.squared_frequencies.iter().enumerate() {
            let exact = 4.0 * ((i + 1) as f64 * PI / (2.0 * (n + 1) as f64)).sin().powi(2);
            assert!((value / exact - 1.0).abs() < 1e-11, "mode {i}: {value} against {exact}");
        }
        let identity = modes.shapes.transpose() * m.multiply_columns(&modes.shapes);
        assert!((identity - DMatrix::identity(20, 20)).amax() < 1e-12);
    }

    #[test]
    fn all_modes_of_a_small_system_and_no_more() {
        let (k, m) = chain(12);
        let factor = Cholesky::new(&k).unwrap();
        let modes = lowest_modes(&factor, &m, 12, &mut |_| {}).unwrap();
        assert!((modes.squared_frequencies.sum() - 24.0).abs() < 1e-10);
        let refused = lowest_modes(&factor, &m, 13, &mut |_| {});
        assert_eq!(refused.err(), Some(LinalgError::TooManyModes { wanted: 13, size: 12 }));
    }
}
