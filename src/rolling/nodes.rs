//! Nodes on which the contact of a state is looked for.
//!
//! A step is taken on the nodes of its start, and again on others as long as the contact solver does not find the contact
//! on them. After it the state goes to the nodes that the solver prefers. Which nodes it is on follows from the state
//! alone.

use super::error::StepError;
use super::model::RollingModel;
use super::state::State;
use crate::contact::ContactState;

/// Hands a `state` to `solve`, and then the state on other nodes, as long as the error says that they may help and there
/// are others.
pub fn try_in_turn<T>(
    model: &RollingModel,
    state: &State,
    mut solve: impl FnMut(&State) -> Result<T, StepError>,
) -> Result<T, StepError> {
    let mut solved = solve(state);
    let mut moved: Option<State> = None;
    while let Err(error) = &solved
        && error.asks_for_other_nodes()
        && let Some(other) = on_other_nodes(model, moved.as_ref().unwrap_or(state))
    {
        solved = solve(&other);
        moved = Some(other);
    }
    solved
}

fn on_other_nodes(model: &RollingModel, state: &State) -> Option<State> {
    let contacts = model.contact.solver.on_other_nodes(&contacts(state))?;
    let mut moved = state.clone();
    place(&mut moved, contacts);
    Some(moved)
}

/// Takes a state to the nodes that its contact solver prefers.
pub fn prefer(model: &RollingModel, state: &mut State) {
    if let Some(contacts) = model.contact.solver.on_preferred_nodes(&contacts(state)) {
        place(state, contacts);
    }
}

fn contacts(state: &State) -> Vec<&ContactState> {
    state.lines.iter().map(|line| &line.contact).collect()
}

fn place(state: &mut State, contacts: Vec<ContactState>) {
    state.lines.iter_mut().zip(contacts).for_each(|(line, contact)| line.contact = contact);
}
