//! HalfStored form of symmetric matrices: number of rows, and the columns from the top down to the diagonal.

use nalgebra::DMatrix;
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// Writes the upper triangle.
pub fn serialize<S: Serializer>(matrix: &DMatrix<f64>, serializer: S) -> Result<S::Ok, S::Error> {
    let n = matrix.nrows();
    let upper: Vec<f64> = (0..n).flat_map(|j| (0..=j).map(move |i| matrix[(i, j)])).collect();
    (n, upper).serialize(serializer)
}

/// Reads the upper triangle and mirrors it.
pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<DMatrix<f64>, D::Error> {
    let (n, upper) = <(usize, Vec<f64>)>::deserialize(deserializer)?;
    if n.checked_add(1).and_then(|m| m.checked_mul(n)) != upper.len().checked_mul(2) {
        return Err(D::Error::custom(format!("{} numbers are no triangle of {n} rows", upper.len())));
    }
    let entry = |i: usize, j: usize| upper[j * (j + 1) / 2 + i];
    Ok(DMatrix::from_fn(n, n, |i, j| if i <= j { entry(i, j) } else { entry(j, i) }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Debug, PartialEq, Serialize, Deserialize)]
    struct HalfStored(#[serde(with = "super")] DMatrix<f64>);

    #[test]
    fn a_symmetric_matrix_comes_back_bit_by_bit_from_half_of_it() {
        for n in [0, 1, 2, 7] {
            let matrix = HalfStored(DMatrix::from_fn(n, n, |i, j| 1.0 / (1.0 + (i + j) as f64) - (i * j) as f64));
            let bytes = postcard::to_stdvec(&matrix).unwrap();
            assert_eq!((bytes.len(), postcard::from_bytes(&bytes)), (2 + 4 * n * (n + 1), Ok(matrix)));
        }
        assert!(postcard::from_bytes::<HalfStored>(&postcard::to_stdvec(&(3_usize, vec![1.0; 5])).unwrap()).is_err());
    }
}
