//! Reasons for which a contact problem has no solution.

/// Reason for which no contact state was found.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ContactError {
    /// The states of the contact did not settle.
    #[error("the contact states did not settle in {iterations} iterations")]
    NotConverged {
        /// Iterations made.
        iterations: usize,
    },
    /// Loads or motions that cannot be balanced.
    #[error("the contact equations of {closed} closed nodes are singular")]
    Singular {
        /// Nodes in contact.
        closed: usize,
    },
    /// The contact is longer than the zone in which it is looked for.
    #[error("the contact patch reached the end of the candidate zone (±{zone:.3e} m) at a line load of {load:.6e} N/m")]
    ZoneExceeded {
        /// Half-length of the zone \[m].
        zone: f64,
        /// Contact force [N/m].
        load: f64,
    },
    /// The start state belongs to another mesh.
    #[error("the contact state belongs to another mesh")]
    ForeignState,
}
