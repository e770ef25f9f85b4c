//! The present iterate of a contact solution, on which rows and active set work.

use super::{ContactGrid, GridScratch, GridState};
use crate::contact::{ContactProblem, Traction};

/// One contact problem on its way to the solution: `state` and `traction` (port forces, surface displacements and rigid
/// motions) hold the present iterate.
pub(super) struct Iteration<'a> {
    pub grid: &'a ContactGrid,
    pub problem: &'a ContactProblem<'a>,
    pub state: &'a mut GridState,
    pub traction: &'a mut Traction,
    pub scratch: &'a mut GridScratch,
}
