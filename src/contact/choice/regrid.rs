//! Changes between a grid and a wider one about the same middle, whose innermost nodes are those of the first.
//!
//! Both see the same bodies, so that a contact within the smaller grid is the same on both: to widen a state is to add
//! open nodes without forces. Gaps and displacements of new nodes start as those of the outermost old one: nodes that
//! close in the very step of the change lie next to it, and after it all are known.

use crate::contact::line::{AcrossNodes, ContactGrid, FrictionHistory, GridState, NodeStatus};
use crate::contact::solver::{ContactState, Ports, SolverState};
use crate::contact::traction::Traction;
use nalgebra::DVector;

/// Share of a grid within which all patches must lie before a wider one is left for it \[1]: a patch that breathes
/// about the end of the grid does not change it from step to step.
const LEAVING: f64 = 0.8;
/// Pull of hot layers on the nodes that would be cut off, in nominal loads, below which the bodies hardly notice the
/// cut \[1].
const SLIGHT_PULL: f64 = 0.01;

/// Index of a value about a middle in a longer or shorter list about the same middle; beyond its ends `Err` with the
/// nearer end.
fn place(i: usize, len: usize, source: usize) -> Result<usize, usize> {
    match (i + source / 2).checked_sub(len / 2) {
        Some(k) if k < source => Ok(k),
        Some(_) => Err(source - 1),
        None => Err(0),
    }
}

/// Values of the common nodes, and outside of them those of the nearest.
fn nearest<T: Copy>(values: &[T], len: usize) -> Vec<T> {
    (0..len).map(|i| values[place(i, len, values.len()).unwrap_or_else(|end| end)]).collect()
}

/// Values of the common nodes, and another one `outside` of them.
fn padded<T: Copy>(values: &[T], len: usize, outside: T) -> Vec<T> {
    (0..len).map(|i| place(i, len, values.len()).map_or(outside, |k| values[k])).collect()
}

/// Components x and y of every node by [`nearest`] or, with a value for those outside, [`padded`].
fn components(values: &DVector<f64>, ports: usize, outside: Option<[f64; 2]>) -> DVector<f64> {
    let pairs: Vec<[f64; 2]> = values.as_slice().chunks_exact(2).map(|pair| [pair[0], pair[1]]).collect();
    let resized = match outside {
        Some(outside) => padded(&pairs, ports / 2, outside),
        None => nearest(&pairs, ports / 2),
    };
    DVector::from_iterator(ports, resized.into_iter().flatten())
}

/// The state of a line on the nodes of `grid`, which belong to the given ports; `None` for one of another solver.
pub(super) fn moved(line: &ContactState, grid: &ContactGrid, to: Ports) -> Option<ContactState> {
    let (n, ports) = (grid.len(), grid.ports());
    let mut moved = ContactState { ports: to, ..line.clone() };
    let SolverState::Grid(state) = &mut moved.solver else { return None };
    let GridState { status, yielded, slip, gap, tangential_gap, across } = &mut **state;
    *status = padded(status, n, NodeStatus::Open);
    *yielded = padded(yielded, n, false);
    *slip = padded(slip, n, 0.0);
    *gap = nearest(gap, n);
    *tangential_gap = nearest(tangential_gap, n);
    let directions = if across.force.is_empty() { 1 } else { 2 };
    if directions == 2 {
        let AcrossNodes { force, slip, gap } = across;
        *force = padded(force, n, 0.0);
        *slip = padded(slip, n, 0.0);
        *gap = nearest(gap, n);
    }
    let FrictionHistory { force, impulse, slip, slope_power: _, slope_work: _ } = &mut moved.history.friction;
    for values in [force, impulse, slip] {
        let of_direction = values.chunks(values.len() / directions).flat_map(|values| padded(values, n, 0.0));
        *values = of_direction.collect();
    }
    let Traction { port_forces, loads, surface, .. } = &mut moved.traction;
    for forces in loads.iter_mut().chain([port_forces]) {
        *forces = components(forces, ports, Some([0.0; 2]));
    }
    surface.iter_mut().for_each(|u| *u = components(u, ports, None));
    Some(moved)
}

/// True if the state of a line on a `wide` grid may as well live on a `narrow` one, under about the `nominal_load`
/// [N/m].
pub(super) fn fits_into([narrow, wide]: [&ContactGrid; 2], line: &ContactState, nominal_load: f64) -> bool {
    let Some(state) = line.solver.grid() else { return false };
    let end = LEAVING * narrow.x.last().copied().unwrap_or(0.0);
    let beyond = |(x, status): (&f64, &NodeStatus)| status.is_active() && x.abs() > end;
    if wide.x.iter().zip(&state.status).any(beyond) {
        return false;
    }
    let inner = place(0, narrow.ports() / 2, wide.ports() / 2).map_or(0, |first| 2 * first);
    let pull = |loads: &DVector<f64>| -> f64 {
        let (before, from_first) = loads.as_slice().split_at(inner);
        before.iter().chain(&from_first[narrow.ports()..]).map(|force| force.abs()).sum()
    };
    line.traction.loads.iter().all(|loads| pull(loads) <= SLIGHT_PULL * nominal_load)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::line::LineHistory;

    #[test]
    fn a_state_that_goes_to_a_wider_grid_and_back_is_the_same() {
        let narrow = ContactGrid::uniform((-4..=4).map(f64::from).collect(), 1.0, 2);
        let wide = ContactGrid::uniform((-9..=9).map(f64::from).collect(), 1.0, 2);
        let values = |n: usize, from: f64| (0..n).map(|i| from + i as f64).collect::<Vec<_>>();
        let vector = |from| DVector::from_vec(values(narrow.ports(), from));
        let mut state = GridState {
            status: vec![NodeStatus::Open; 9],
            yielded: vec![false; 9],
            slip: values(9, 1.0),
            gap: values(9, 2.0),
            tangential_gap: values(9, 3.0).into_iter().map(crate::multistep::History::constant).collect(),
            across: AcrossNodes {
                force: values(9, 3.5),
                slip: values(9, 4.5),
                gap: values(9, 5.5).into_iter().map(crate::multistep::History::constant).collect(),
            },
        };
        state.status[4] = NodeStatus::Stick;
        let friction = FrictionHistory {
            force: values(18, 4.0),
            impulse: values(18, 5.0),
            slip: values(18, 6.0),
            ..FrictionHistory::default()
        };
        let traction = Traction {
            port_forces: vector(7.0),
            loads: [vector(8.0), vector(9.0)],
            surface: [vector(10.0), vector(11.0)],
            ..Traction::default()
        };
        let history = LineHistory { friction, ..LineHistory::none(9) };
        let before =
            ContactState { traction, history, solver: SolverState::Grid(Box::new(state)), ..ContactState::default() };
        let mut line = moved(&before, &wide, Ports::Wide).unwrap();
        let (on_wide, traction) = (line.solver.grid().unwrap().clone(), &line.traction);
        assert_eq!((on_wide.status.len(), on_wide.status[9], traction.port_forces.len()), (19, NodeStatus::Stick, 46));
        assert_eq!((traction.loads[0][0], traction.surface[0][1], on_wide.slip[18]), (0.0, 11.0, 0.0));
        let fits = |line: &ContactState| fits_into([&narrow, &wide], line, 1.0);
        assert!(fits(&line));
        let mut longer = on_wide;
        longer.status[5] = NodeStatus::Stick;
        assert!(!fits(&ContactState { solver: SolverState::Grid(Box::new(longer)), ..line.clone() }));
        line.traction.loads[1][2] = 0.02;
        assert!(!fits(&line));
        assert_eq!(moved(&line, &narrow, Ports::Narrow), Some(before));
    }
}
