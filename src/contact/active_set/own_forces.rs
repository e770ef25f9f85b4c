//! Forces of one line as affine functions of what it feels of bodies, other lines and motions.
//!
//! Bodies and other lines displace a line as polynomials of the place, rim angle and motions as given functions of it. So a
//! line answers them by a few columns of forces around the factors of its own flexibility: that of the pressures at closed
//! nodes, and that of the shear at stuck ones, which pressures reach through friction at those that slip.

use super::axes::{Axes, Equation};
use super::unknowns::{LineUnknowns, ShearUnknown};
use crate::axes::Axis;
use crate::contact::flexibility::ByPowers;
use crate::contact::kernel::Logarithm;
use crate::contact::line::contact_line::ContactLine;
use crate::contact::line::rows::{AffineRow, BodyRows, UpwindSlip};
use crate::linalg::vectorised::{add_multiples, vectorised};
use crate::linalg::{DenseSystem, POINTS};
use nalgebra::DMatrix;
use std::ops::Range;
use std::sync::Arc;

/// Column of the forces that are known.
pub const KNOWN: usize = 0;
/// Columns by the gap that bodies and motions open at the points of the polynomial.
pub const OPENED: Range<usize> = 1..1 + POINTS;
/// Columns by the forces of all lines on the ports, as far as they make a line slip.
pub const PORTS: Range<usize> = OPENED.end..OPENED.end + 2 * POINTS;
/// Column by the rim angle, as far as it makes a line slip.
pub const ANGLE: usize = PORTS.end;
/// Columns by the motions that are sought, as far as they make a line slip.
pub const MOTIONS: Range<usize> = ANGLE + 1..ANGLE + 1 + Axis::COUNT;
/// Columns by the coefficients of the slips along and across that the lines of the patch cause, by powers of the place.
pub const FELT: [Range<usize>; 2] = [MOTIONS.end..MOTIONS.end + POINTS, MOTIONS.end + POINTS..MOTIONS.end + 2 * POINTS];
/// Numbers of columns, in whole registers: along, and along and across.
pub const ALONG: usize = FELT[0].end.next_multiple_of(4);
pub const ACROSS: usize = FELT[1].end.next_multiple_of(4);
/// Columns of pressures: known ones and [`OPENED`], in whole registers.
const PRESSED: usize = OPENED.end.next_multiple_of(4);

/// Affine function of what a line feels, by columns.
pub type Felt<const C: usize> = [f64; C];
/// The columns of pressures alone.
type PressureColumns = [f64; PRESSED];

/// Forces of one line.
#[derive(Default)]
pub struct OwnForces<const C: usize> {
    /// Factors of the flexibility of closed nodes, which belong to [`Self::kept`], and of the stuck ones.
    pressures: DenseSystem,
    shear: DenseSystem,
    kept: Option<PressureKey>,
    /// Normal forces at the closed nodes, and the known ones among them.
    pressed: Vec<[PressureColumns; 1]>,
    known: Vec<f64>,
    /// Shear along and across over normal forces at the closed nodes where they slip \[1], and further shear at them.
    friction: Vec<[f64; 2]>,
    unknown: Vec<ShearUnknown>,
    sheared: Vec<[Felt<C>; 1]>,
    /// Closed nodes, then open ones with given tangential forces.
    pub nodes: Vec<usize>,
    /// Given tangential forces at these [N/m]; empty: there are none.
    given: Vec<f64>,
    /// Powers of their places \[1]; empty: the line is in no patch.
    powers: Vec<ByPowers>,
    rows: [Vec<f64>; 2],
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
        for (factors, column) in factors.iter().zip(columns) {
            for k in 0..N {
                add_multiples(simd, [factors[k]], column, &mut sums[k]);
            }
        }
    }
}

impl<const C: usize> OwnForces<C> {
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
        self.powers.clear();
        if line.problem.patch.is_some() {
            self.powers.extend(self.nodes.iter().map(|&i| line.given.powers[i]));
        }
        let bodies = line.body_rows();
        let pressed = self.press(line, unknowns, (axes, &bodies));
        pressed && (unknowns.shear.is_empty() || self.shear(line, unknowns, (axes, sought), &bodies))
    }

    /// Takes the pressures that close the gap.
    #[inline(never)]
    fn press(&mut self, line: &ContactLine, unknowns: &LineUnknowns, (axes, bodies): (&Axes, &BodyRows)) -> bool {
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
            let equation = axes.equation(line.gap_row(i, bodies));
            let known = -(equation.constant + equation.motions.dot(line.traction.rigid));
            let yielding = if line.state.yielded[i] { line.creep(i) * line.given.strength.limit[i] } else { 0.0 };
            self.known.push(known + yielding);
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
        (axes, sought): (&Axes, &[Axis]),
        bodies: &BodyRows,
    ) -> bool {
        self.unknown.extend_from_slice(&unknowns.shear);
        self.shear.reset(self.unknown.len());
        let mut at: Option<(usize, NodeRows)> = None;
        for r in 0..self.unknown.len() {
            let ShearUnknown { place, direction, turn } = self.unknown[r];
            let i = unknowns.closed[place];
            if at.as_ref().is_none_or(|(before, _)| *before != place) {
                at = Some((place, self.node_rows(line, axes, (i, &unknowns.closed), bodies)));
            }
            let Some((_, node)) = &at else { return false };
            let mut sides = [0.0; C];
            for (d, (part, (equation, angle))) in direction.into_iter().zip(&node.equations).enumerate() {
                if part == 0.0 {
                    continue;
                }
                sides[KNOWN] -= part * (equation.constant + equation.motions.dot(line.traction.rigid));
                add(-part, &equation.ports, &mut sides[PORTS]);
                sides[ANGLE] -= part * angle;
                sides[MOTIONS].iter_mut().zip(sought).for_each(|(side, &axis)| *side -= part * equation.motions[axis]);
                if let Some(powers) = self.powers.get(place) {
                    add(-part, powers, &mut sides[FELT[d].clone()]);
                }
                for ((slip, friction), [pressed]) in self.rows[d].iter().zip(&self.friction).zip(&self.pressed) {
                    if friction[d] != 0.0 {
                        add(-part * slip * friction[d], pressed, &mut sides[..PRESSED]);
                    }
                }
            }
            for (at, slip) in line.slips_by_pressure(&node.upwind) {
                if let Ok(place) = unknowns.closed.binary_search_by_key(&at, |&j| line.grid.component(j)) {
                    add(-direction[0] * slip, &self.pressed[place][0], &mut sides[..PRESSED]);
                }
            }
            let row = self.shear.row(r).0;
            for (d, slips) in self.rows.iter().enumerate().filter(|(d, _)| direction[*d] != 0.0) {
                let part = direction[d];
                row.iter_mut()
                    .zip(&self.unknown)
                    .for_each(|(value, of)| *value += part * of.direction[d] * slips[of.place]);
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
    fn node_rows(
        &mut self,
        line: &ContactLine,
        axes: &Axes,
        (i, closed): (usize, &[usize]),
        bodies: &BodyRows,
    ) -> NodeRows {
        let (along, upwind) = line.slip_row(i, bodies);
        let mut affine = [along, AffineRow::default()];
        for direction in 0..line.state.directions() {
            line.slips_by_own(direction, (i, &upwind), closed, &mut self.rows[direction]);
        }
        if line.state.directions() > 1 {
            affine[1] = line.slip_row_across(i, &upwind);
        }
        NodeRows { equations: affine.map(|row| (axes.equation(row), row.angle)), upwind }
    }

    /// Sum over the nodes of normal forces and shear along and across, times factors.
    pub fn sum(&self, factors: impl Fn(usize) -> (f64, [f64; 2])) -> Felt<C> {
        let (mut sum, mut of_pressures) = ([0.0; C], [0.0; PRESSED]);
        for (place, (friction, [pressed])) in self.friction.iter().zip(&self.pressed).enumerate() {
            let (normal, shear) = factors(place);
            add(normal + friction[0] * shear[0] + friction[1] * shear[1], pressed, &mut of_pressures);
        }
        for (ShearUnknown { place, direction, .. }, [sheared]) in self.unknown.iter().zip(&self.sheared) {
            let (_, shear) = factors(*place);
            add(direction[0] * shear[0] + direction[1] * shear[1], sheared, &mut sum);
        }
        add(1.0, &of_pressures, &mut sum[..PRESSED]);
        sum[KNOWN] += self.given.iter().enumerate().map(|(place, force)| factors(place).1[0] * force).sum::<f64>();
        sum
    }

    /// Sums over the nodes of normal forces, times values there.
    pub fn sums_of_pressures(&self, values: impl Fn(usize) -> [f64; POINTS]) -> [Felt<C>; POINTS] {
        let (factors, mut sums) = ((0..self.pressed.len()).map(values).collect::<Vec<_>>(), [[0.0; PRESSED]; POINTS]);
        add_products(&factors, &self.pressed, &mut sums);
        sums.map(widened)
    }

    /// Sums over the nodes of shear along (0) or across (1), times values there.
    #[inline(never)]
    pub fn sums_of_shear(&self, direction: usize, values: impl Fn(usize) -> [f64; POINTS]) -> [Felt<C>; POINTS] {
        let of_pressures = |(k, by): (usize, &[f64; 2])| values(k).map(|value| value * by[direction]);
        let mut slipping = [[0.0; PRESSED]; POINTS];
        let mut factors: Vec<_> = self.friction.iter().enumerate().map(of_pressures).collect();
        add_products(&factors, &self.pressed, &mut slipping);
        let mut sums = slipping.map(widened);
        factors.clear();
        factors.extend(self.unknown.iter().map(|of| values(of.place).map(|value| value * of.direction[direction])));
        add_products(&factors, &self.sheared, &mut sums);
        for (place, force) in self.given.iter().enumerate().filter(|_| direction == 0) {
            sums.iter_mut().zip(values(place)).for_each(|(sum, value)| sum[KNOWN] += value * force);
        }
        sums
    }

    /// Moments of the shear along (0) or across (1) with the powers of the places.
    pub fn moments(&self, direction: usize) -> [Felt<C>; POINTS] {
        self.sums_of_shear(direction, |place| self.powers[place])
    }

    /// Hands normal forces and shear along and across at all nodes over, given what the line feels.
    pub fn take(&self, felt: &Felt<C>, mut give: impl FnMut(usize, f64, [f64; 2])) {
        let value = |of: &[f64]| of.iter().zip(felt).map(|(of, by)| of * by).sum::<f64>();
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

/// Slips of a node along and across by what its line feels.
struct NodeRows {
    /// As equations, with their coefficients of the rim angle.
    equations: [(Equation, f64); 2],
    upwind: UpwindSlip,
}

/// Columns of pressures among all columns.
fn widened<const C: usize>(pressed: PressureColumns) -> Felt<C> {
    let mut all = [0.0; C];
    all[..PRESSED].copy_from_slice(&pressed);
    all
}
