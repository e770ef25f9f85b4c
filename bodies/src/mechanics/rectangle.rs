//! Stored form of matrices: the numbers column by column, and the numbers of rows and columns.

use nalgebra::DMatrix;
use serde::de::Error;
use serde::{Deserialize, Deserializer};

/// Reads a matrix as `nalgebra` writes it; sizes whose product is no number are refused, too.
pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<DMatrix<f64>, D::Error> {
    let (values, rows, columns) = <(Vec<f64>, usize, usize)>::deserialize(deserializer)?;
    if rows.checked_mul(columns) != Some(values.len()) {
        return Err(D::Error::custom(format!("{} numbers are no matrix of {rows} by {columns}", values.len())));
    }
    Ok(DMatrix::from_vec(rows, columns, values))
}

/// Reads a matrix that may be missing.
pub fn optional<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<DMatrix<f64>>, D::Error> {
    #[derive(Deserialize)]
    struct Stored(#[serde(deserialize_with = "deserialize")] DMatrix<f64>);
    Ok(Option::<Stored>::deserialize(deserializer)?.map(|Stored(matrix)| matrix))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Debug, PartialEq, Deserialize)]
    struct Both(
        #[serde(deserialize_with = "deserialize")] DMatrix<f64>,
        #[serde(deserialize_with = "optional")] Option<DMatrix<f64>>,
    );

    #[test]
    fn matrices_come_back_and_absurd_sizes_are_refused() {
        let matrix = DMatrix::from_fn(3, 2, |i, j| 1.0 / (1.0 + (i + 2 * j) as f64));
        for second in [None, Some(matrix.clone())] {
            let bytes = postcard::to_stdvec(&(&matrix, &second)).unwrap();
            assert_eq!(postcard::from_bytes(&bytes), Ok(Both(matrix.clone(), second)));
        }
        let absurd = (vec![1.0; 4], usize::MAX / 2, 6_usize);
        assert!(postcard::from_bytes::<Both>(&postcard::to_stdvec(&(absurd, None::<u8>)).unwrap()).is_err());
    }
}
