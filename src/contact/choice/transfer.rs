//! From points to a grid and back: both describe the same surfaces, and what the slip of the next step refers to, the
//! tangential displacement at the last two times, goes over as a function of x.

use crate::contact::line::{ContactGrid, FrictionHistory, GridState, LineHistory, NodeStatus};
use crate::contact::series::chebyshev::TERMS;
use crate::contact::series::constants::Constants;
use crate::contact::series::tables::{POWER, PRESSURE};
use crate::contact::series::{Arch, GridPast, Past, SeriesState, Tractions};
use crate::contact::solver::{ContactState, SolverState};
use crate::contact::traction::Traction;
use crate::linalg::POINTS;
use crate::multistep::History;
use crate::piecewise::Piecewise;
use nalgebra::DVector;
use std::f64::consts::PI;
use std::ops::Range;

/// Share of the zone of the points that a patch may take when it comes from the grid \[1].
const ROOM: f64 = 0.9;

/// Side from which the material arrives: 1 from `+x`.
fn upstream(traction: &Traction) -> f64 {
    if traction.rigid.travel < 0.0 { -1.0 } else { 1.0 }
}

/// Impulse per force in the last step \[s].
fn duration(force: &[f64], impulse: &[f64]) -> f64 {
    let ratio = impulse.iter().sum::<f64>() / force.iter().sum::<f64>();
    if ratio.is_finite() { ratio } else { 0.0 }
}

/// The state of a line on points as that of a `target` on a grid, which touches there without forces; `None` where one
/// of both is of another solver.
pub(super) fn to_grid(
    constants: &Constants,
    from: &ContactState,
    grid: &ContactGrid,
    mut target: ContactState,
) -> Option<ContactState> {
    let traction = &from.traction;
    let (SolverState::Series(patch), SolverState::Grid(state)) = (&from.solver, &mut target.solver) else {
        return None;
    };
    state.size = if patch.size > 0.0 { patch.size } else { 1.0 };
    if let Past::Series(past) = &patch.past[0] {
        state.share = if past.share > 0.0 { past.share } else { 1.0 };
    }
    let grid = &grid.scaled(state.size);
    let Tractions { pressure, slide, stick, directions, .. } = &patch.tractions;
    let ([low, high], [stick_low, stick_high]) = (pressure.ends(), stick.ends());
    let slips = |sign: f64| if sign < 0.0 { NodeStatus::SlipBackward } else { NodeStatus::SlipForward };
    let status = |x: f64| match directions {
        _ if x <= low || x >= high => NodeStatus::Open,
        Some(directions) => {
            let place = upstream(traction) * (x - pressure.centre) / pressure.half_width;
            match directions[constants.of_points.nearest(place)] {
                0 => NodeStatus::Stick,
                direction => slips(f64::from(direction)),
            }
        }
        None if x > stick_low && x < stick_high => NodeStatus::Stick,
        None => slips(*slide),
    };
    state.status = grid.x.iter().map(|&x| status(x)).collect();
    let past = |k: usize, x: f64| patch.past[k].at(&[x], (patch.kernel.tangential.factor, None), &constants.points)[0];
    state.moved[0] = grid.x.iter().map(|&x| History { now: past(0, x), before: past(1, x), rate: 0.0 }).collect();
    let closed = |i: usize| status(grid.x[i]).is_active();
    let force = |i: usize| if closed(i) { patch.tractions.shear(&[grid.x[i]])[0] * grid.width(i) } else { 0.0 };
    let friction = &from.history.friction;
    let span = duration(&friction.force, &friction.impulse);
    let slips = |i: usize| status(grid.x[i]).friction_direction() != 0.0;
    let slip = |i: usize| if slips(i) { traction.slip.at(grid.x[i]) } else { 0.0 };
    state.slip[0] = (0..grid.len()).map(slip).collect();
    if friction.fits(2 * POWER) {
        take_across(state, (patch, traction), grid, &closed, &slips);
    }
    target.history.rim_angle = from.history.rim_angle;
    let forces_of_all: Vec<f64> = (0..grid.len()).map(force).chain(state.lateral.iter().copied()).collect();
    target.history.friction = FrictionHistory {
        impulse: forces_of_all.iter().map(|force| span * force).collect(),
        force: forces_of_all,
        slip: state.slip.iter().flatten().copied().collect(),
        slope_power: friction.slope_power,
        slope_work: friction.slope_work,
    };
    for i in (0..grid.len()).filter(|&i| closed(i)) {
        state.forces[grid.component(i)] = force(i);
        state.forces[grid.component(i) + 1] = pressure.density(&[grid.x[i]])[0] * grid.width(i);
    }
    state.surface = [0, 1].map(|body| surface(constants, patch, &traction.surface[body], grid, body));
    target.traction = traction.clone();
    Some(target)
}

/// Takes the lateral part of a line at the nodes that are `closed`, and of those that slip.
fn take_across(
    state: &mut GridState,
    (patch, traction): (&SeriesState, &Traction),
    grid: &ContactGrid,
    closed: &impl Fn(usize) -> bool,
    slips: &impl Fn(usize) -> bool,
) {
    let force =
        |i: usize| if closed(i) { patch.tractions.lateral.density(&[grid.x[i]])[0] * grid.width(i) } else { 0.0 };
    let slip = |i: usize| if slips(i) { traction.lateral_slip.at(grid.x[i]) } else { 0.0 };
    let past = |k: usize, x: f64| match &patch.past[k] {
        Past::Series(past) => past.across(&[x], past.share)[0],
        past => past.across(&[x], 0.0)[0],
    };
    state.lateral = (0..grid.len()).map(force).collect();
    state.slip[1] = (0..grid.len()).map(slip).collect();
    state.moved[1] = grid.x.iter().map(|&x| History { now: past(0, x), before: past(1, x), rate: 0.0 }).collect();
}

/// Displacements of a body at all nodes, but for a constant and the small strains under pressure.
fn surface(
    constants: &Constants,
    patch: &SeriesState,
    smooth: &DVector<f64>,
    grid: &ContactGrid,
    body: usize,
) -> DVector<f64> {
    let SeriesState { tractions, kernel, .. } = patch;
    let side = if body == 0 { -1.0 } else { 1.0 };
    let [along, normal] = [kernel.tangential.factor, kernel.normal.factor].map(|factor| side * factor);
    let mut all = DVector::zeros(grid.components());
    for (node, &x) in grid.nodes().iter().enumerate() {
        let values = constants.points.values(x);
        let rest = |component: usize| (0..POINTS).map(|k| values[k] * smooth[2 * k + component]).sum::<f64>();
        all[2 * node] = rest(0) + along * tractions.shear_logarithm(&[x])[0];
        all[2 * node + 1] = rest(1) + normal * tractions.pressure.logarithm(&[x])[0];
    }
    all
}

/// Half-length of the stretch that sticks from the leading edge on, over that of the patch, if the states of a grid are
/// those of a single patch of which a part at the trailing edge slips in one direction; and this direction.
fn share(state: &GridState, upstream: f64) -> Option<(f64, f64)> {
    let closed: Vec<NodeStatus> = state.status.iter().copied().filter(|s| s.is_active()).collect();
    let stuck = closed.iter().filter(|s| s.is_stuck()).count();
    let from_edge = |s: &&NodeStatus| s.is_stuck();
    let at_edge = match upstream > 0.0 {
        true => closed.iter().rev().take_while(from_edge).count(),
        false => closed.iter().take_while(from_edge).count(),
    };
    let directions: f64 = closed.iter().map(|s| s.friction_direction()).sum();
    let slips = (closed.len() - stuck) as f64;
    let single = at_edge == stuck && directions.abs() == slips;
    single.then(|| (stuck as f64 / closed.len() as f64, directions.signum()))
}

/// Tractions at points in the states of the nodes next to them, on a patch with the given pressure.
fn on_points(
    constants: &Constants,
    grid: &ContactGrid,
    from: &ContactState,
    state: &GridState,
    pressure: Arch,
) -> Tractions {
    let upstream = upstream(&from.traction);
    let x = constants.of_points.tractions.map(|t| pressure.centre + upstream * pressure.half_width * t);
    let next = |x: f64| grid.x.partition_point(|node| *node < x - 0.5 * grid.spacing).min(grid.len() - 1);
    let sideways = state.directions() > 1;
    let direction = |x: f64| state.status[next(x)].friction_direction();
    let directions = x.map(|x| if sideways { direction(x).abs() as i8 } else { direction(x) as i8 });
    let series = |shear: &Piecewise| {
        let terms = constants.of_points.terms_of(&x.map(|x| shear.at(x)), upstream);
        Arch { count: TERMS, terms, ..pressure }
    };
    let lateral = if sideways { series(&from.traction.lateral_shear) } else { Arch::default() };
    Tractions { pressure, slide: 0.0, stick: series(&from.traction.shear), directions: Some(directions), lateral }
}

/// Nodes in the middle of a grid that have one spacing; those of a wide grid grow apart outside of them.
fn even(grid: &ContactGrid) -> Range<usize> {
    let x = &grid.x;
    let uneven = |i: &usize| (x[i + 1] - x[*i] - grid.spacing).abs() > 1e-6 * grid.spacing;
    let middle = x.len() / 2;
    let first = (0..middle).rev().find(uneven).map_or(0, |i| i + 1);
    first..(middle..x.len() - 1).find(uneven).map_or(x.len(), |i| i + 1)
}

/// The state of a line on a grid as that on points; `None` where it has not a single patch, or one that reaches nodes
/// that lie farther apart.
pub(super) fn to_points(constants: &Constants, grid: &ContactGrid, from: &ContactState) -> Option<ContactState> {
    let (state, traction) = (from.solver.grid()?, &from.traction);
    let grid = &grid.scaled(state.size);
    let ([edges], load) = (traction.edges.as_slice(), traction.resultant.height) else { return None };
    let reach = ROOM * constants.zone;
    if load <= 0.0 || traction.yielding.share > 0.0 || edges.low < -reach || edges.high > reach {
        return None;
    }
    let even = even(grid);
    if edges.low < grid.x[even.start] || edges.high > grid.x[even.end - 1] {
        return None;
    }
    let (centre, half_width) = (edges.middle(), edges.half_length());
    let mut pressure = Arch { centre, half_width, count: PRESSURE, ..Arch::default() };
    pressure.terms[0] = 2.0 * load / (PI * half_width);
    let side = upstream(traction);
    let sideways = state.directions() > 1;
    let tractions = match share(state, side).filter(|_| !sideways) {
        Some((share, direction)) => {
            let mut stick = Arch::default();
            if share > 0.0 {
                (stick.half_width, stick.centre) = (share * half_width, centre + side * (1.0 - share) * half_width);
            }
            Tractions {
                pressure,
                slide: direction * traction.friction.coefficient,
                stick,
                directions: None,
                lateral: Arch::default(),
            }
        }
        None => on_points(constants, grid, from, state, pressure),
    };
    let history = |before: bool| {
        let value = |h: &History| if before { h.before } else { h.now };
        let values = |gap: &[History]| gap.get(even.clone()).unwrap_or_default().iter().map(value).collect();
        let [along, across] = state.moved.each_ref().map(|moved| values(moved));
        Past::Grid(GridPast { first: grid.x[even.start], spacing: grid.spacing, along, across })
    };
    let friction = friction_history(constants, &tractions, side, from);
    let patch = SeriesState { tractions, past: [history(false), history(true)], ..SeriesState::default() };
    let moved = ContactState {
        traction: traction.clone(),
        history: LineHistory { rim_angle: from.history.rim_angle, friction },
        solver: SolverState::Series(Box::new(patch)),
        ..ContactState::default()
    };
    Some(moved)
}

/// Friction at the places of the slipping part, read off the profiles.
fn friction_history(constants: &Constants, tractions: &Tractions, side: f64, from: &ContactState) -> FrictionHistory {
    let before = &from.history.friction;
    let Tractions { pressure, stick, directions, .. } = tractions;
    // Where points have the shear they slip throughout.
    let stuck = if directions.is_some() { 0.0 } else { stick.half_width };
    let (half, centre) = (pressure.half_width - stuck, pressure.centre - side * stuck);
    let tables = &constants.tables;
    let places = tables.places.map(|t| centre + half * t);
    let shear = tractions.shear(&places);
    let force: [f64; POWER] = std::array::from_fn(|q| half * tables.weights[q] * shear[q]);
    let span = duration(&before.force, &before.impulse);
    let (mut force, mut slip) = (force.to_vec(), places.map(|x| from.traction.slip.at(x)).to_vec());
    if tractions.lateral.half_width > 0.0 {
        let across = tractions.lateral.density(&places);
        force.extend((0..POWER).map(|q| half * tables.weights[q] * across[q]));
        slip.extend(places.map(|x| from.traction.lateral_slip.at(x)));
    }
    FrictionHistory {
        impulse: force.iter().map(|f| span * f).collect(),
        force,
        slip,
        slope_power: before.slope_power,
        slope_work: before.slope_work,
    }
}
