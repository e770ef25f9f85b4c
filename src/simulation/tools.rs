//! Memory in which steps are computed: as much as simulations of a model compute at the same time, not as there are.
//!
//! Nothing in it outlives a computation, so that it does not matter who has used it before. Eight wheels on two threads
//! pass two sets from hand to hand, which stay in the caches of the processor.

use super::lock::lock;
use crate::rolling::{State, Workspace};
use std::sync::Mutex;

/// Memory that a computation needs besides the states it leads from and to.
#[derive(Default)]
pub(super) struct Tools {
    pub workspace: Workspace,
    /// Memory for the next state.
    pub spare: State,
}

/// The tools of a model that nobody uses at present.
#[derive(Default)]
pub(super) struct Shelf(Mutex<Vec<Box<Tools>>>);

impl Shelf {
    /// Lends tools to one computation.
    pub fn lend<T>(&self, compute: impl FnOnce(&mut Tools) -> T) -> T {
        let mut tools = lock(&self.0).pop().unwrap_or_default();
        let computed = compute(&mut tools);
        lock(&self.0).push(tools);
        computed
    }
}
