//! Linear problem of a single patch, solved by alternation of pressure and shear. Measured: 0.68 of the time of a step
//! without heat at 20 elements per half-width, 0.46 at 50.
//!
//! For bodies of equal material pressure hardly shears the contact and shear hardly opens it: the dents of wheel and
//! rail cancel. So the pressures, with the height of the hub, are found for given shear, then the shear of the stuck
//! nodes, with the velocities of the hub, for these pressures, and so on until nothing changes any more
//! ([`PressureShear`]). The matrix of the pressures is a part of the compliance, whose inverse belongs to the place of
//! the patch alone and is kept ([`KeptInverses`]). Only the equations of the stuck nodes and of the motions are written
//! and factorised in a step.

use super::patch_inverse::KeptInverses;
use super::pressure_shear::PressureShear;
use crate::axes::Axis;
use crate::contact::active_set::axes::Axes;
use crate::contact::active_set::unknowns::{LineUnknowns, Unknowns};
use crate::contact::line::contact_line::ContactLine;
use std::ops::Range;

/// Solves the linear problem of a single patch and gives the line its forces and motions; `false`: the closed nodes are
/// none, or the alternation does not converge. `rows` is memory for the coefficients of all ports.
pub fn solve(
    lines: &mut [ContactLine],
    axes: &Axes,
    unknowns: &Unknowns,
    rows: &mut [Vec<f64>],
    (inverses, equations): (&mut KeptInverses, &mut PressureShear),
) -> bool {
    let ([line], [own]) = (&*lines, unknowns.lines.as_slice()) else { return false };
    let Some(patch) = own.single_patch(line) else { return false };
    let Some(inverse) = inverses.of(line.problem, line.grid, &patch) else { return false };
    write_gaps(line, axes, (own, &unknowns.axes), patch, equations);
    write_shear(line, axes, (own, unknowns), rows, equations);
    let solved = equations.solve(inverse);
    if solved {
        unknowns.accept(&equations.unknowns, lines, axes);
    }
    solved
}

/// Writes the gaps, and the present unknowns as a guess.
fn write_gaps(
    line: &ContactLine,
    axes: &Axes,
    (own, sought): (&LineUnknowns, &[Axis]),
    patch: Range<usize>,
    equations: &mut PressureShear,
) {
    let LineUnknowns { closed, stuck, friction } = own;
    equations.place.clear();
    equations.place.extend_from_slice(&line.grid.x[patch.clone()]);
    equations.friction.clone_from(friction);
    equations.stuck.clear();
    equations.stuck.extend(stuck.iter().map(|i| i - patch.start));
    equations.gap.clear();
    equations.motions.iter_mut().for_each(Vec::clear);
    for &i in closed {
        let gap = axes.equation(line.gap_terms(i));
        equations.gap.push(axes.constant(&gap));
        equations.motions.iter_mut().zip(sought).for_each(|(motion, &axis)| motion.push(gap.motions[axis]));
    }
    for (of, offset) in equations.rim_angle.iter_mut().zip([1, 0]) {
        of.clear();
        of.extend(closed.iter().map(|&i| line.rim.by_force(line.problem.share, line.grid.port(i) + offset)));
    }
    let height = sought.last() == Some(&Axis::Height);
    equations.reset(stuck.len() + sought.len() - usize::from(height), height);
    let guess = closed.iter().map(|&i| line.normal(i)).chain(stuck.iter().map(|&i| line.tangential(i)));
    let motions = sought.iter().map(|&axis| line.traction.rigid[axis]);
    equations.unknowns.iter_mut().zip(guess.chain(motions)).for_each(|(value, guess)| *value = guess);
}

/// Writes the equations of the stuck nodes and of the motions.
fn write_shear(
    line: &ContactLine,
    axes: &Axes,
    (own, unknowns): (&LineUnknowns, &Unknowns),
    rows: &mut [Vec<f64>],
    equations: &mut PressureShear,
) {
    let window = own.window(line.grid);
    for (r, &i) in own.stuck.iter().enumerate() {
        let slip = axes.equation(line.slip_row(i, window.clone(), &mut rows[0]));
        unknowns.write(equations.row(r), (&slip, rows), line.grid, axes);
    }
    for (r, &axis) in unknowns.axes.iter().enumerate() {
        let balance = axes.row(axis, std::slice::from_ref(line), rows);
        unknowns.write(equations.row(own.stuck.len() + r), (&balance, rows), line.grid, axes);
    }
}
