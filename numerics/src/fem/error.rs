//! Why there is no mesh or matrix.

/// A geometry or mesh without meaning.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FemError {
    /// A quadrilateral turned inside out.
    #[error("cell at ({x:.4e}, {y:.4e}) m has Jacobian determinant {determinant:.3e} m² (must be positive)")]
    InvertedCell {
        /// x of its middle \[m].
        x: f64,
        /// y of its middle \[m].
        y: f64,
        /// The smallest determinant \[m²].
        determinant: f64,
    },
    /// The contact zone does not fit on the body.
    #[error("contact zone of {zone:.4e} m (half-width {half_width:.4e} m) exceeds {limit:.4e} m, {what}")]
    ZoneTooLarge {
        /// Half-length of the contact zone \[m].
        zone: f64,
        /// Half-width of the contact \[m].
        half_width: f64,
        /// Largest half-length that fits \[m].
        limit: f64,
        /// Length that it has to fit into.
        what: &'static str,
    },
    /// A length that must be positive and finite.
    #[error("{what} = {value} must be positive and finite")]
    BadLength {
        /// Which length.
        what: &'static str,
        /// Its value \[m].
        value: f64,
    },
    /// The matrix could not be built.
    #[error(transparent)]
    Linalg(#[from] crate::linalg::LinalgError),
}
