//! How much of the surfaces the contact sees: a narrow zone while patches are ordinary, a wide one while they are not.
//!
//! Softened steel carries its load on a patch several times as wide as a cold one. The wide zone costs time, and only
//! while it is needed: a step whose patch reaches the end of the narrow zone is repeated in the wide one, and the state
//! returns when its patch fits again. Which zone it is in follows from the state alone. The coordinates of the bodies
//! are the same in both.

use super::bodies::ports;
use super::model::RollingModel;
use super::state::State;
use crate::contact::ContactState;

/// The state in the wide zone; `None` if it is there, or there is none.
pub fn widened(model: &RollingModel, state: &State) -> Option<State> {
    let lines = state.lines.iter().map(|line| model.contact.solver.widened(&line.contact));
    let contacts = lines.collect::<Option<Vec<_>>>()?;
    let mut wide = state.clone();
    place(&mut wide, contacts);
    Some(wide)
}

/// Returns a state to the narrow zone, or to patches, if none of its lines needs more any longer.
pub fn narrow(model: &RollingModel, state: &mut State) {
    let load = model.contact.nominal_line_load();
    let lines = state.lines.iter().map(|line| model.contact.solver.narrowed(&line.contact, load));
    let Some(contacts) = lines.collect::<Option<Vec<_>>>() else { return };
    // All lines are where the bodies are, so they go together or stay.
    if contacts.windows(2).all(|pair| pair[0].ports == pair[1].ports) {
        place(state, contacts);
    }
}

fn place(state: &mut State, contacts: Vec<ContactState>) {
    state.lines.iter_mut().zip(contacts).for_each(|(line, contact)| line.contact = contact);
    let ports = ports(state);
    state.wheel.retarded.fit_to(ports);
    state.rail.retarded.fit_to(ports);
}
