//! End of a solution: histories move on, power and traction are taken.

use super::hot_layers::SeriesLayers;
use super::places::{AtPlaces, total};
use super::series_line::SeriesLine;
use super::state::{AcrossPast, Past, SeriesPast, SeriesState, Tractions, layered};
use super::surface::{less, plus};
use super::tables::{POWER, PROFILE};
use crate::contact::flexibility::ByPowers;
use crate::contact::kernel::LineKernel;
use crate::contact::line::LineHistory;
use crate::contact::traction::{SolvedFriction, Traction};
use crate::linalg::POINTS;
use crate::multistep::History;
use crate::piecewise::{Interval, Piecewise};
use nalgebra::DVector;

/// Elastic energy of the line's own flexibility [J/m].
fn energy(line: &SeriesLine) -> f64 {
    let Tractions { slide, stick, .. } = line.tractions;
    let pressed = line.pressed.work;
    let own = stick.logarithm(&line.stuck.x);
    let both = std::array::from_fn(|q| 2.0 * slide * line.stuck.logarithm[q] + own[q]);
    let stuck = total(&line.stuck.force, &both);
    // Pulls do little beside friction: of the tangential part the mean under the pressure is enough.
    let along = line.over_pressure(|layers, _| less(&layers.along[0], &layers.along[1]));
    let along = if line.load() > 0.0 { along * line.resultant().travel / line.load() } else { 0.0 };
    let lift = line.over_pressure(|layers, x| less(&layers.wheel.lift.at(x), &layers.rail.lift.at(x)));
    let LineKernel { tangential, normal, .. } = line.problem.line.kernel;
    let pressing = normal.factor * (pressed - normal.reach * line.load().powi(2));
    let pulling =
        tangential.factor * (slide * slide * pressed + stuck - tangential.reach * line.friction_force().powi(2));
    let by_lines: f64 = line.powers[1].iter().zip(&line.field.displacement).map(|(moment, c)| 0.5 * moment * c).sum();
    let layer = 0.5 * total(&line.stuck.force, &layered(line.problem.line.layer, &stick, &line.stuck.x));
    along + lift + by_lines + layer + energy_across(line) - (pressing + pulling)
}

/// Elastic energy of the shear across [J/m].
fn energy_across(line: &SeriesLine) -> f64 {
    let (shear, kernel) = (&line.tractions.lateral, line.problem.line.kernel.lateral);
    if !line.is_sideways() {
        return 0.0;
    }
    let (places, force) = line.slipping_across();
    let own = kernel.factor * (kernel.reach * shear.total().powi(2) - total(&force, &shear.logarithm(&places)));
    let layer = 0.5 * total(&force, &layered(line.problem.line.layer, shear, &places));
    own + layer
        + line
            .across
            .powers
            .iter()
            .zip(&line.across.field.displacement)
            .map(|(moment, c)| 0.5 * moment * c)
            .sum::<f64>()
}

/// Power of pressure on the slope of the rail that slides past it [W/m].
fn slope_power(line: &SeriesLine) -> f64 {
    let (coupling, Tractions { pressure, slide, .. }) = (line.problem.line.kernel.coupling, &line.tractions);
    let smooth = line.constants.points.polynomial(&line.surface.rail.normal);
    let [pressed, stuck] = [&line.pressed, &line.stuck].map(|places| pressure.density(&places.x));
    let slopes: AtPlaces = std::array::from_fn(|q| smooth.slope(line.pressed.x[q]) + coupling * slide * pressed[q]);
    let (pressed, stuck) = (total(&line.pressed.force, &slopes), coupling * total(&line.stuck.force, &stuck));
    let warm = line.over_pressure(|SeriesLayers { rail, .. }, x| plus(&rail.lift.slope(x), &rail.swelling.slope(x)));
    (line.rim_velocity() - line.rigid.travel) * (pressed + stuck + warm) - expansion(line)
}

/// Power [W/m] that the passing material adds by expanding and shrinking against the contact forces.
fn expansion(line: &SeriesLine) -> f64 {
    if line.layers.is_none() {
        return 0.0;
    }
    let (v, rim) = (line.rigid.travel, line.rim_velocity());
    let (points, compliance) = (&line.constants.points, line.problem.line.bodies.shared.compliance);
    // What the pulls do to the bodies less the half-planes.
    let [[wheel, wheel_lift], [rail, rail_lift]] = [0, 1].map(|body| {
        [0, 1].map(|component| {
            let entry = |k: usize, l: usize| compliance[body][(2 * k + component, 2 * l)] * line.mean_pulls[body][l];
            points.polynomial(&std::array::from_fn(|k| (0..POINTS).map(|l| entry(k, l)).sum()))
        })
    });
    let turning = rim / line.problem.line.surfaces.radius;
    let along = line.over_shear(|layers, x| {
        let stretch = layers.stretch(x, [rim, -v]);
        let smooth = |x: f64| rim * wheel.slope(x) - v * rail.slope(x) + turning * wheel_lift.at(x);
        std::array::from_fn(|i| stretch[i] + smooth(x[i]))
    });
    let lift = line.over_pressure(|layers, x| {
        let of_wheel = less(&layers.wheel.lift.slope(x), &layers.wheel.swelling.slope(x));
        let of_rail = plus(&layers.rail.lift.slope(x), &layers.rail.swelling.slope(x));
        let smooth = |x: f64| rim * wheel_lift.slope(x) - v * rail_lift.slope(x) - turning * wheel.at(x);
        let along = layers.along[0];
        std::array::from_fn(|i| rim * of_wheel[i] - v * of_rail[i] - turning * along[i] + smooth(x[i]))
    });
    along + lift
}

/// Slips along and across [m/s] of a line with forces across that do the work of friction on the forces at the places.
///
/// That a layer is carried through the patch does no work by the integral, but by the sum over the places, which misses the
/// end of a layer where its slip has a root in the denominator. What points that stick seem to slip, and what is missed, belong to those
/// that slip, or to the last one.
fn layered_slips(line: &SeriesLine, forces: [&[f64; POWER]; 2]) -> [[f64; POWER]; 2] {
    let mut slips = [line.slips, line.across.slips];
    if line.problem.line.layer == 0.0 {
        return slips;
    }
    let places = line.slipping().0;
    let carried = [&line.tractions.stick, &line.tractions.lateral].map(|shear| line.carried(shear, &places));
    let all = work(forces, &slips) - work(forces, &carried);
    rest_where_points_stick(line, &mut slips);
    let seen = work(forces, &slips);
    if seen * all > 0.0 {
        slips.as_flattened_mut().iter_mut().for_each(|slip| *slip *= all / seen);
        return slips;
    }
    let last = if (places[0] < places[POWER - 1]) == (line.upstream() > 0.0) { 0 } else { POWER - 1 };
    slips = [[0.0; POWER]; 2];
    let square: f64 = forces.iter().map(|force| force[last] * force[last]).sum();
    for (slips, force) in slips.iter_mut().zip(forces).filter(|_| square > 0.0) {
        slips[last] = all * force[last] / square;
    }
    slips
}

/// Slips along and across [m/s] of a line with forces across, such that friction on the forces at the places gives nothing
/// back. Points that stick leave a little slip between them, whose work has any sign; in steps much shorter than the patch,
/// in which most points stick, it may be more than that of those that slip.
fn frictional_slips(line: &SeriesLine, forces: [&[f64; POWER]; 2]) -> [[f64; POWER]; 2] {
    let mut slips = layered_slips(line, forces);
    let heats = |slips: &[[f64; POWER]; 2]| work(forces, slips) <= 0.0;
    if heats(&slips) {
        return slips;
    }
    rest_where_points_stick(line, &mut slips);
    if heats(&slips) { slips } else { [[0.0; POWER]; 2] }
}

/// Work of forces along and across at the places on slips there [W/m].
fn work(forces: [&[f64; POWER]; 2], slips: &[[f64; POWER]; 2]) -> f64 {
    forces.iter().zip(slips).flat_map(|(f, s)| f.iter().zip(s)).map(|(force, slip)| force * slip).sum()
}

/// Takes away the slips at places next to points that stick.
fn rest_where_points_stick(line: &SeriesLine, slips: &mut [[f64; POWER]; 2]) {
    for (q, _) in line.slipping().0.iter().enumerate().filter(|(_, x)| line.sticks_at(**x)) {
        (slips[0][q], slips[1][q]) = (0.0, 0.0);
    }
}

/// Moves the histories on and takes the power: that of friction at the end of the step [W/m] and its energy in the step
/// [J/m].
fn remember(
    line: &SeriesLine,
    [growth, growth_across]: [ByPowers; 2],
    force: &[f64; POWER],
    state: &mut SeriesState,
    history: &mut LineHistory,
) -> [f64; 2] {
    let time = &line.problem.line.time;
    (state.tractions, state.kernel) = (line.tractions, line.problem.line.kernel);
    state.size = line.problem.line.size.map_or(1.0, |size| size.under_load);
    let now = Past::Series(SeriesPast {
        tractions: line.tractions,
        smooth: line.relative(&line.surface, true),
        field: [line.field.displacement, growth],
        half_length: line.half_length,
        reach: line.problem.line.kernel.tangential.reach,
        share: line.problem.line.share,
        layer: line.problem.line.layer,
        across: AcrossPast {
            field: [line.across.field.displacement, growth_across],
            kernel: line.problem.line.kernel.lateral,
        },
    });
    match time.is_stationary() {
        true => {
            history.rim_angle = History::constant(line.rim_angle);
            state.past[1].clone_from(&now);
        }
        false => {
            history.rim_angle.push(time, line.rim_angle);
            state.past.swap(0, 1);
        }
    }
    state.past[0] = now;
    (state.slope, state.law_slope, state.uncorrected) = (line.slope, line.law_slope, line.across.uncorrected);
    if !line.is_sideways() {
        return history.friction.advance(time, slope_power(line), |q| [force[q], line.slips[q]]);
    }
    let (_, across) = line.slipping_across();
    let slips = frictional_slips(line, [force, &across]);
    history.friction.reach(2 * POWER);
    history.friction.advance(time, slope_power(line), |q| match q.checked_sub(POWER) {
        None => [force[q], slips[0][q]],
        Some(q) => [across[q], slips[1][q]],
    })
}

/// Writes the traction, the history and the memory, for which `growth` is the change of the displacement by the lines
/// of the patch with the size of this one; returns the elastic energy of the line's own flexibility [J/m].
pub(super) fn finish(
    line: &SeriesLine,
    growth: [ByPowers; 2],
    state: &mut SeriesState,
    history: &mut LineHistory,
    traction: &mut Traction,
) -> f64 {
    let (_, force) = line.slipping();
    let [friction, work] = remember(line, growth, &force, state, history);
    traction.friction.coefficient = line.friction;
    let power = traction.friction.dissipate(friction, work, line.problem.line.duration);
    traction.friction.tread_slip = line.tread_slip();
    traction.friction.slip_speed = line.slip_speed();
    traction.spin_moment = if line.is_sideways() { line.spin_moment() } else { 0.0 };
    traction.rigid = line.rigid;
    traction.resultant = line.resultant();
    write_ports(line, traction);
    let [low, high] = line.tractions.pressure.ends();
    for patches in [&mut traction.edges, &mut traction.conducting, &mut traction.patches] {
        patches.clear();
        if line.load() > 0.0 {
            patches.push(Interval { low, high });
        }
    }
    traction.stick_fraction = line.tractions.share();
    traction.yielding.overlap.clear();
    (traction.yielding.plastic_work, traction.yielding.share, traction.iterations) = (0.0, 0.0, 1);
    traction.under_film = 0.0;
    write_profiles(line, traction);
    write_lateral_profiles(line, traction);
    traction.pressure_max = line.tractions.pressure.peak();
    traction.friction.dissipation.scale_to(power, &traction.pressure);
    energy(line)
}

fn write_ports(line: &SeriesLine, traction: &mut Traction) {
    let fit = |values: &mut DVector<f64>| {
        if values.len() != 2 * POINTS {
            *values = DVector::zeros(2 * POINTS);
        }
    };
    let Traction { port_forces, loads, surface, .. } = traction;
    loads.iter_mut().chain(surface.iter_mut()).chain([&mut *port_forces]).for_each(fit);
    for k in 0..POINTS {
        let forces = [line.moments.tangential[k], line.moments.normal[k]];
        let bodies = [&line.surface.wheel, &line.surface.rail];
        for (component, force) in forces.into_iter().enumerate() {
            let port = 2 * k + component;
            port_forces[port] = force;
            let pull = if component == 0 { line.pulls.map(|pull| pull[k]) } else { [0.0; 2] };
            (loads[0][port], loads[1][port]) = (force + pull[0], pull[1] - force);
            for (u, body) in surface.iter_mut().zip(bodies) {
                u[port] = if component == 0 { body.tangential[k] } else { body.normal[k] };
            }
        }
    }
}

/// Profiles of shear and slip across at the places of those along, whose dissipation they add to. Next to points that stick
/// nothing slips; between them the series leave a little.
fn write_lateral_profiles(line: &SeriesLine, traction: &mut Traction) {
    let Traction { lateral_shear, lateral_slip, shear, slip, friction: SolvedFriction { dissipation, .. }, .. } =
        traction;
    [&mut *lateral_shear, lateral_slip].into_iter().for_each(Piecewise::clear);
    if !line.is_sideways() || shear.x.is_empty() {
        return;
    }
    let last = shear.x.len() - 1;
    // All of the patch is one stretch, and nothing is where it ends.
    let places: [f64; PROFILE - 1] = std::array::from_fn(|i| shear.x[(i + 1).min(last)]);
    let (shears, slips) = (line.tractions.lateral.density(&places), line.lateral_slip(&places, true));
    for (i, &x) in shear.x.iter().enumerate() {
        let ends = i == 0 || i == last;
        let (q, s) = if ends { (0.0, 0.0) } else { (shears[i - 1], slips[i - 1]) };
        let sticks = line.sticks_at(x);
        lateral_shear.push(x, q);
        lateral_slip.push(x, if sticks { 0.0 } else { s });
        dissipation.value[i] = if sticks { 0.0 } else { (dissipation.value[i] - q * s).max(0.0) };
        slip.value[i] = if sticks { 0.0 } else { slip.value[i] };
    }
}

fn write_profiles(line: &SeriesLine, traction: &mut Traction) {
    let Traction { pressure, shear, slip, friction: SolvedFriction { dissipation, .. }, .. } = traction;
    [&mut *pressure, shear, slip, dissipation].into_iter().for_each(Piecewise::clear);
    let ([low, high], part) = (line.tractions.pressure.ends(), line.slipping_ends());
    if line.load() <= 0.0 {
        return;
    }
    let least = 1e-9 * (high - low);
    [&mut *pressure, shear, slip, dissipation].into_iter().for_each(|profile| profile.push(low, 0.0));
    let stretches = [(low, part[0], false), (part[0], part[1], true), (part[1], high, false)];
    for (from, to, slips) in stretches.into_iter().filter(|(from, to, _)| to - from > least) {
        let mut places = line.constants.tables.profile.map(|share| from + share * (to - from));
        places[PROFILE - 1] = to;
        let (mut p, mut q) = (line.tractions.pressure.density(&places), line.tractions.shear(&places));
        let mut s = if slips { line.slip(&places, &line.surface, true) } else { [0.0; PROFILE] };
        // Series vanish where their stretches end; the square root of their round-off there has eight digits only.
        let last = PROFILE - 1;
        p[last] = if high - to > least { p[last] } else { 0.0 };
        (q[last], s[last]) = (line.tractions.slide * p[last], 0.0);
        for (i, &x) in places.iter().enumerate() {
            pressure.push(x, p[i]);
            shear.push(x, q[i]);
            slip.push(x, s[i]);
            let heat = -q[i] * s[i];
            dissipation.push(x, if line.is_sideways() { heat } else { heat.max(0.0) });
        }
    }
}
