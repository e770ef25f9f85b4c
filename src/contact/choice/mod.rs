//! The choice between kinds of nodes on which a contact is looked for.
//!
//! There are three: points that move with a smooth patch ([`series`](super::series)), and fixed nodes of a narrow or of
//! a wide zone ([`active_set`](super::active_set)). Further on in this list nodes describe more contacts and cost more,
//! so that a contact leaves its nodes when it does not find a solution on them, and returns when it would find one on
//! those before. The solvers know nothing of each other. [`node_choice`] decides, [`stay`] says how long a decision
//! holds, [`transfer`] leads from points to fixed nodes and back, [`regrid`] from one zone to the other. Theory:
//! `docs/theory/patch-contact.md`.

mod node_choice;
mod regrid;
pub(super) mod stay;
mod transfer;

pub use node_choice::NodeChoice;
pub use stay::Stay;
