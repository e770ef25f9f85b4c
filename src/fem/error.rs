//! Why there is no mesh or matrix.

/// A geometry or mesh without meaning.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FemError {
    /// A quadrilateral turned inside out.
    #[error("cell at ({x:.4e}, {y:.4e}) m has Jacobian determinant {determinant:.3e} m² (must be positive)")]
    InvertedCell { x: f64, y: f64, determinant: f64 },
    /// The contact zone does not fit on the body.
    #[error("contact zone of {zone:.4e} m (half-width {half_width:.4e} m) exceeds {limit:.4e} m, {what}")]
    ZoneTooLarge { zone: f64, half_width: f64, limit: f64, what: &'static str },
    /// A length that must be positive and finite.
    #[error("{what} = {value} must be positive and finite")]
    BadLength { what: &'static str, value: f64 },
    /// The matrix could not be built.
    #[error(transparent)]
    Linalg(#[from] crate::linalg::LinalgError),
}
