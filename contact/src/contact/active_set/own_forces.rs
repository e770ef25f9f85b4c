//! Forces of one line as affine functions of what it feels of bodies, other lines and motions.
//!
//! Bodies and other lines displace a line as polynomials of the place, rim angle and motions as given functions of it. So a
//! line answers them by a few columns of forces around the factors of its own flexibility: that of the pressures at closed
//! nodes, and that of the shear at stuck ones, which pressures reach through friction at those that slip.

use super::axes::Axes;
use super::unknowns::{LineUnknowns, ShearUnknown};
use crate::axes::Axis;
use crate::contact::kernel::Logarithm;
use crate::contact::line::contact_line::ContactLine;
use crate::contact::line::rows::{AffineRow, BODY_ROWS, UpwindSlip};
use crate::linalg::vectorised::vectorised;
use crate::linalg::{DenseSystem, POINTS};
use nalgebra::DMatrix;
use std::ops::Range;
use std::sync::Arc;

/// Column of the forces that are known.
pub const KNOWN: usize = 0;
/// Columns by what the bodies do at their points: by the gap that they open, which the rim angle opens as well, and by their
/// displacements along and those that are carried, see [`BODY_ROWS`], as far as they make a line slip.
pub const BODIES: Range<usize> = 1..1 + BODY_ROWS;
pub const OPENED: Range<usize> = 1..1 + POINTS;
const MOVED: Range<usize> = OPENED.end..OPENED.end + POINTS;
const CARRIED: Range<usize> = MOVED.end..BODIES.end;
/// Column by the rim angle, as far as it makes a line slip.
pub const ANGLE: usize = BODIES.end;
/// Columns by the motions that are sought, as far as they make a line slip.
pub const MOTIONS: Range<usize> = ANGLE + 1..ANGLE + 1 + Axis::COUNT;
/// Columns by the coefficients of the slips along and across that the lines of the patch cause, by powers of the place.
pub const FELT: [Range<usize>; 2] = [MOTIONS.end..MOTIONS.end + POINTS, MOTIONS.end + POINTS..MOTIONS.end + 2 * POINTS];
/// Numbers of columns, in whole registers: along, and along and across.
pub const ALONG: usize = FELT[0].end.next_multiple_of(4);
pub const ACROSS: usize = FELT[1].end.next_multiple_of(4);
/// Columns of pressures: known ones and [`OPENED`], in whole registers.
const PRESSED: usize = OPENED.end.next_multiple_of(4);

/// Numbers by which a line acts on others, sums over its nodes: forces on the ports along, and normal to them, rim angle, and pull
/// on the motions that are sought.
pub const SHEAR: Range<usize> = 0..POINTS;
pub const LOAD: Range<usize> = SHEAR.end..SHEAR.end + POINTS;
pub const TURN: usize = LOAD.end;
pub const PULL: Range<usize> = TURN + 1..TURN + 1 + Axis::COUNT;
/// Moments along and across with the powers of the places.
pub const MOMENTS: [Range<usize>; 2] = [PULL.end..PULL.end + POINTS, PULL.end + POINTS..PULL.end + 2 * POINTS];
/// Numbers of sums, in whole blocks of [`add_products`]: along, and along and across.
pub const SUMS_ALONG: usize = MOMENTS[0].end.next_multiple_of(SUMMED);
pub const SUMS_ACROSS: usize = MOMENTS[1].end.next_multiple_of(SUMMED);
/// Sums that are taken at a time.
const SUMMED: usize = 8;

/// Affine function of what a line feels, by columns.
pub type Felt<const C: usize> = [f64; C];
/// The columns of pressures alone.
type PressureColumns = [f64; PRESSED];

/// Forces of one line.
#[derive(Default)]
pub struct OwnForces<const C: usize, const N: usize> {
    /// Factors of the flexibility of closed nodes, which belong to [`Self::kept`], and of the stuck ones.
    pressures: DenseSystem,
    pub(super) shear: DenseSystem,
    kept: Option<PressureKey>,
    /// Normal forces at the closed nodes, and the known ones among them.
    pressed: Vec<[PressureColumns; 1]>,
    known: Vec<f64>,
    /// Shear along and across over normal forces at the closed nodes where they slip \[1], and further shear at them.
    friction: Vec<[f64; 2]>,
    pub(super) unknown: Vec<ShearUnknown>,
    /// From the first to the last of the closed nodes that slip.
    sliding: Range<usize>,
    sheared: Vec<[Felt<C>; 1]>,
    /// Closed nodes, then open ones with given tangential forces.
    pub nodes: Vec<usize>,
    /// Given tangential forces at these [N/m]; empty: there are none.
    given: Vec<f64>,
    /// Slips along and across of the node at hand by shear in these directions at the closed nodes, and by further shear.
    rows: [Vec<f64>; 2],
    by_unknown: [Vec<f64>; 2],
    /// Factors of the pressures and of the shear in the sums.
    factors: [Vec<[f64; N]>; 2],
    /// Corrections of the unknown shear, and of the shear along and across at [`Self::nodes`], see [`super::corrections`] [N/m].
    pub(super) corrected: Vec<f64>,
    pub(super) corrections: Vec<[f64; 2]>,
}

/// Closed nodes and flexibility of a factor of pressures, and of their answer to what bodies and motions open.
struct PressureKey {
    closed: Vec<usize>,
    along: Logarithm,
    size: f64,
    logarithms: Arc<DMatrix<f64>>,
}

impl PressureKey {
    fn fits(&self, line: &ContactLine, closed: &[usize]) -> bool {
        let same = self.along == line.kernel.normal && self.size == line.grid.size;
        same && Arc::ptr_eq(&self.logarithms, &line.grid.logarithms) && self.closed == closed
    }
}

/// Adds a multiple of an affine function.
pub fn add(factor: f64, of: &[f64], sum: &mut [f64]) {
    sum.iter_mut().zip(of).for_each(|(sum, value)| *sum += factor * value);
}

vectorised! {
    /// Adds sums over the nodes of their columns, times factors.
    fn add_products<'a, S, const W: usize, const N: usize>(
        simd,
        factors: &'a [[f64; N]],
        columns: &'a [[[f64; W]; 1]],
        sums: &'a mut [[f64; W]; N],
    ) {
        for (block, sums) in sums.chunks_exact_mut(SUMMED).enumerate() {
            for q in 0..W / S::F64_LANES {
                let mut added = [simd.splat_f64s(0.0); SUMMED];
                for (factors, [column]) in factors.iter().zip(columns) {
                    let value = S::as_simd_f64s(column).0[q];
                    for (sum, factor) in added.iter_mut().zip(&factors[block * SUMMED..][..SUMMED]) {
                        *sum = simd.mul_add_e_f64s(simd.splat_f64s(*factor), value, *sum);
                    }
                }
                for (sum, added) in sums.iter_mut().zip(added) {
                    let sum = &mut S::as_mut_simd_f64s(sum).0[q];
                    *sum = simd.add_f64s(*sum, added);
                }
            }
        }
    }
}

vectorised! {
    /// Adds slips by the friction that pressures cause in the direction `d`.
    fn add_sliding<'a, S>(
        simd,
        slips: &'a [f64],
        friction: &'a [[f64; 2]],
        d: usize,
        pressed: &'a [[PressureColumns; 1]],
        sum: &'a mut PressureColumns,
    ) {
        for (q, sum) in S::as_mut_simd_f64s(sum).0.iter_mut().enumerate() {
            for ((slip, friction), [pressed]) in slips.iter().zip(friction).zip(pressed) {
                let by_pressure = simd.splat_f64s(slip * friction[d]);
                *sum = simd.mul_add_e_f64s(by_pressure, S::as_simd_f64s(pressed).0[q], *sum);
            }
        }
    }
}

impl<const C: usize, const N: usize> OwnForces<C, N> {
    /// Takes the forces in given states; whether there are any that are finite. With `given` tangential forces at the
    /// candidates, only the pressures are unknown.
    pub fn find(
        &mut self,
        line: &ContactLine,
        unknowns: &LineUnknowns,
        (axes, sought): (&Axes, &[Axis]),
        given: Option<&[f64]>,
    ) -> bool {
        self.friction.clone_from(&unknowns.friction);
        self.nodes.clone_from(&unknowns.closed);
        self.unknown.clear();
        self.sheared.clear();
        self.given.clear();
        if let Some(given) = given {
            let open = |(i, force): &(usize, &f64)| **force != 0.0 && !line.state.status[*i].is_active();
            self.nodes.extend(given.iter().enumerate().filter(open).map(|(i, _)| i));
            self.given.extend(self.nodes.iter().map(|&i| given[i]));
        }
        let accelerated = line.accelerated(axes.gains());
        self.press(line, unknowns, &accelerated)
            && (unknowns.shear.is_empty() || self.shear(line, unknowns, sought, &accelerated))
    }

    /// Takes the pressures that close the gap.
    #[inline(never)]
    fn press(&mut self, line: &ContactLine, unknowns: &LineUnknowns, accelerated: &[f64; BODY_ROWS]) -> bool {
        let (closed, grid) = (&unknowns.closed, line.grid);
        let yields = closed.iter().any(|&i| line.state.yielded[i]);
        let kept = !yields && self.kept.as_ref().is_some_and(|kept| kept.fits(line, closed));
        if !kept {
            self.kept = None;
            if !self.factorise(line, closed) {
                return false;
            }
        }
        self.known.clear();
        for &i in closed {
            let gap = line.known_gap(i) + product(&grid.values[i + grid.guard], accelerated);
            let yielding = if line.state.yielded[i] { line.creep(i) * line.given.strength.limit[i] } else { 0.0 };
            self.known.push(yielding - gap);
        }
        if !kept && !yields {
            let logarithms = Arc::clone(&grid.logarithms);
            self.kept =
                Some(PressureKey { closed: closed.clone(), along: line.kernel.normal, size: grid.size, logarithms });
        }
        let solved = self.pressures.solve_with(&mut self.known);
        self.pressed.iter_mut().zip(&self.known).for_each(|([pressed], known)| pressed[KNOWN] = *known);
        solved
    }

    /// Takes the factor of the pressures, and how they answer to what bodies and motions open.
    fn factorise(&mut self, line: &ContactLine, closed: &[usize]) -> bool {
        let Self { pressures, pressed, .. } = self;
        let (along, grid) = (line.grid.unscaled(line.kernel.normal), line.grid);
        let nodes = grid.logarithms.nrows();
        pressures.reset(closed.len());
        pressed.clear();
        for (k, &i) in closed.iter().enumerate() {
            let node = i + grid.guard;
            let logarithms = &grid.logarithms.as_slice()[node * nodes..][..nodes];
            let row = pressures.row(k).0;
            for (value, &j) in row.iter_mut().zip(closed) {
                *value = 2.0 * along.displacement(logarithms[j + grid.guard]);
            }
            row[k] += if line.state.yielded[i] { line.creep(i) } else { 0.0 };
            let mut sides = [0.0; PRESSED];
            sides[OPENED].iter_mut().zip(&grid.values[node]).for_each(|(side, value)| *side = -value);
            pressed.push([sides]);
        }
        pressures.factorise() && pressures.solve_with_all(pressed)
    }

    /// Takes the shear that keeps stuck nodes from slipping, and that which turns against the slip.
    #[inline(never)]
    fn shear(
        &mut self,
        line: &ContactLine,
        unknowns: &LineUnknowns,
        sought: &[Axis],
        accelerated: &[f64; BODY_ROWS],
    ) -> bool {
        self.unknown.extend_from_slice(&unknowns.shear);
        let slides = |friction: &[f64; 2]| *friction != [0.0; 2];
        let first = self.friction.iter().position(slides).unwrap_or_default();
        self.sliding = first..self.friction.iter().rposition(slides).map_or(first, |last| last + 1);
        self.shear.reset(self.unknown.len());
        let mut at: Option<(usize, NodeRows)> = None;
        for r in 0..self.unknown.len() {
            let ShearUnknown { place, direction, turn } = self.unknown[r];
            let i = unknowns.closed[place];
            if at.as_ref().is_none_or(|(before, _)| *before != place) {
                at = Some((place, self.node_rows(line, (i, &unknowns.closed))));
            }
            let Some((_, node)) = &at else { return false };
            let mut sides = [0.0; C];
            for (d, (part, slip)) in direction.into_iter().zip(&node.slips).enumerate() {
                if part == 0.0 {
                    continue;
                }
                let by_accelerations =
                    product(&slip.moved, &accelerated[POINTS..]) + product(&slip.carried, &accelerated[2 * POINTS..]);
                sides[KNOWN] -= part * (slip.constant + slip.motions.dot(line.traction.rigid) + by_accelerations);
                add(-part, &slip.moved, &mut sides[MOVED]);
                add(-part, &slip.carried, &mut sides[CARRIED]);
                sides[ANGLE] -= part * slip.angle;
                sides[MOTIONS].iter_mut().zip(sought).for_each(|(side, &axis)| *side -= part * slip.motions[axis]);
                if let Some(powers) = line.given.powers.get(i) {
                    add(-part, powers, &mut sides[FELT[d].clone()]);
                }
                let (mut by_friction, sliding) = ([0.0; PRESSED], self.sliding.clone());
                let (slips, friction) = (&self.rows[d][sliding.clone()], &self.friction[sliding.clone()]);
                add_sliding(slips, friction, d, &self.pressed[sliding], &mut by_friction);
                add(-part, &by_friction, &mut sides[..PRESSED]);
            }
            for (at, slip) in line.slips_by_pressure(&node.upwind).into_iter().filter(|(_, slip)| *slip != 0.0) {
                if let Ok(place) = unknowns.closed.binary_search_by_key(&at, |&j| line.grid.component(j)) {
                    add(-direction[0] * slip, &self.pressed[place][0], &mut sides[..PRESSED]);
                }
            }
            let row = self.shear.row(r).0;
            for (part, slips) in direction.into_iter().zip(&self.by_unknown).filter(|(part, _)| *part != 0.0) {
                add(part, slips, row);
            }
            row[r] += turn;
            if let Some(drawn) = &line.iterate.drawn {
                row[r] += drawn.strength;
                sides[KNOWN] += drawn.strength * (direction[0] * drawn.shear[i][0] + direction[1] * drawn.shear[i][1]);
            }
            self.sheared.push([sides]);
        }
        self.shear.factorise() && self.shear.solve_with_all(&mut self.sheared)
    }

    /// Slips of closed node `i` by what the line feels; those by the shear of the closed nodes go into [`Self::rows`].
    fn node_rows(&mut self, line: &ContactLine, (i, closed): (usize, &[usize])) -> NodeRows {
        let (along, upwind) = line.slip_row(i);
        let mut slips = [along, AffineRow::default()];
        for direction in 0..line.state.directions() {
            let slips = &mut self.rows[direction];
            line.slips_by_own(direction, (i, &upwind), closed, slips);
            let of_unknown = self.unknown.iter().map(|of| of.direction[direction] * slips[of.place]);
            self.by_unknown[direction].clear();
            self.by_unknown[direction].extend(of_unknown);
        }
        if line.state.directions() > 1 {
            slips[1] = line.slip_row_across(i, &upwind);
        }
        NodeRows { slips, upwind }
    }

    /// Sums over the nodes of pressures and shear by which the line acts on others and on the motions that are `sought`.
    #[inline(never)]
    pub fn sums(&mut self, line: &ContactLine, sought: &[Axis]) -> [Felt<C>; N] {
        let (mut of_pressures, mut sums) = ([[0.0; PRESSED]; N], [[0.0; C]; N]);
        let [pressures, shear] = &mut self.factors;
        pressures.clear();
        shear.clear();
        let (mut unknown, mut pulls) = (self.unknown.iter().peekable(), [(0.0, [0.0; 2]); Axis::COUNT]);
        for (place, &i) in self.nodes.iter().enumerate() {
            pulls.iter_mut().zip(sought).for_each(|(pull, &axis)| *pull = line.pull_of_forces(axis, i));
            let add = |forces, to: &mut [f64; N]| add_factors(line, (i, &pulls), forces, to);
            while let Some(ShearUnknown { direction, .. }) = unknown.next_if(|unknown| unknown.place == place) {
                shear.push([0.0; N]);
                shear.last_mut().into_iter().for_each(|factors| add((0.0, *direction), factors));
            }
            if let Some(friction) = self.friction.get(place) {
                pressures.push([0.0; N]);
                pressures.last_mut().into_iter().for_each(|factors| add((1.0, *friction), factors));
            }
            if let Some(given) = self.given.get(place) {
                let mut factors = [0.0; N];
                add((0.0, [*given, 0.0]), &mut factors);
                sums.iter_mut().zip(factors).for_each(|(sum, force)| sum[KNOWN] += force);
            }
        }
        add_products(pressures, &self.pressed, &mut of_pressures);
        add_products(shear, &self.sheared, &mut sums);
        sums.iter_mut().zip(&of_pressures).for_each(|(sum, pressed)| add(1.0, pressed, &mut sum[..PRESSED]));
        sums
    }

    /// Hands normal forces and shear along and across at all nodes over, given what the line feels.
    pub fn take(&self, felt: &Felt<C>, mut give: impl FnMut(usize, f64, [f64; 2])) {
        let value = |of: &[f64]| product_by_fours(of, felt);
        let mut unknown = self.unknown.iter().zip(&self.sheared).peekable();
        for (place, &i) in self.nodes.iter().enumerate() {
            let normal = self.pressed.get(place).map_or(0.0, |[pressed]| value(pressed));
            let mut shear = self.friction.get(place).map_or([0.0; 2], |friction| friction.map(|part| part * normal));
            while let Some((unknown, [sheared])) = unknown.next_if(|(unknown, _)| unknown.place == place) {
                add(value(sheared), &unknown.direction, &mut shear);
            }
            shear[0] += self.given.get(place).copied().unwrap_or(0.0);
            give(i, normal, shear);
        }
    }
}

/// Adds the factors of a normal force and of shear along and across at a candidate in the sums, times these.
pub(super) fn add_factors<const N: usize>(
    line: &ContactLine,
    (i, pulls): (usize, &[(f64, [f64; 2])]),
    (normal, [along, across]): (f64, [f64; 2]),
    factors: &mut [f64; N],
) {
    let (node, rim) = (i + line.grid.guard, &line.iterate.rim);
    let values = &line.grid.values[node];
    add(along, values, &mut factors[SHEAR]);
    add(normal, values, &mut factors[LOAD]);
    factors[TURN] += normal * rim.normal[node] + along * rim.tangential[node];
    for (factor, (by_normal, by_shear)) in factors[PULL].iter_mut().zip(pulls) {
        *factor += normal * by_normal + along * by_shear[0] + across * by_shear[1];
    }
    let Some(powers) = line.given.powers.get(i) else { return };
    add(along, powers, &mut factors[MOMENTS[0].clone()]);
    if let Some(factors) = factors.get_mut(MOMENTS[1].clone()) {
        add(across, powers, factors);
    }
}

/// Scalar product of the first numbers.
pub fn product(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// [`product`] of fours of numbers: sums of their own for each of the four, which registers hold side by side.
fn product_by_fours(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; 4];
    for (a, b) in a.as_chunks::<4>().0.iter().zip(b.as_chunks::<4>().0) {
        (0..4).for_each(|k| sums[k] += a[k] * b[k]);
    }
    sums.iter().sum()
}

/// Slips of a node along and across by what its line feels.
struct NodeRows {
    slips: [AffineRow; 2],
    upwind: UpwindSlip,
}
