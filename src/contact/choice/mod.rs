//! The choice between kinds of nodes on which a contact is looked for.
//!
//! There are two: points that move with a smooth patch ([`series`](super::series)), and fixed nodes
//! ([`active_set`](super::active_set)). Fixed nodes describe more contacts and cost more, so that a contact leaves its points
//! when it does not find a solution on them, and returns when it would find one. The solvers know nothing of each other.
//! [`node_choice`] decides, [`stay`] says how long a decision holds, [`transfer`] leads from points to fixed nodes and back.
//! Theory: `docs/theory/patch-contact.md`.

mod node_choice;
pub(super) mod stay;
mod transfer;

pub use node_choice::NodeChoice;
pub use stay::Stay;
