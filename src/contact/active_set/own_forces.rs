//! Forces of one line as affine functions of what it feels of bodies, other lines and motions.
//!
//! Bodies and other lines displace a line as polynomials of the place, rim angle and motions as given functions of it. So a
//! line answers them by a few columns of forces around the factors of its own flexibility: that of the pressures at closed
//! nodes, and that of the shear at stuck ones, which pressures reach through friction at those that slip.

use super::axes::Axes;
use super::unknowns::LineUnknowns;
use crate::axes::Axis;
use crate::contact::flexibility::ByPowers;
use crate::contact::kernel::Logarithm;
use crate::contact::line::contact_line::ContactLine;
use crate::contact::line::rows::BodyRows;
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
/// Columns by the coefficients of the slip that the lines of the patch cause, by powers of the place.
pub const FELT: Range<usize> = PORTS.end..PORTS.end + POINTS;
/// Column by the rim angle, as far as it makes a line slip.
pub const ANGLE: usize = FELT.end;
/// Columns by the motions that are sought, as far as they make a line slip.
pub const MOTIONS: Range<usize> = ANGLE + 1..ANGLE + 1 + Axis::COUNT;
/// Columns, in whole registers.
pub const COLUMNS: usize = MOTIONS.end.next_multiple_of(4);
/// Columns of pressures: known ones and [`OPENED`], in whole registers.
const PRESSED: usize = OPENED.end.next_multiple_of(4);

/// Affine function of what a line feels, by columns.
pub type Felt = [f64; COLUMNS];
/// The columns of pressures alone.
type PressureColumns = [f64; PRESSED];

/// Forces of one line.
#[derive(Default)]
pub struct OwnForces {
    /// Factors of the flexibility of closed nodes, which belong to [`Self::kept`], and of the stuck ones.
    pressures: DenseSystem,
    shear: DenseSystem,
    kept: Option<PressureKey>,
    /// Normal forces at the closed nodes, and the known ones among them.
    pressed: Vec<[PressureColumns; 1]>,
    known: Vec<f64>,
    /// Tangential over normal forces at the closed nodes where they slip \[1], and places of the stuck ones among them.
    friction: Vec<f64>,
    stuck: Vec<usize>,
    /// Tangential forces at the stuck nodes.
    sheared: Vec<[Felt; 1]>,
    /// Closed nodes, then open ones with given tangential forces.
    pub nodes: Vec<usize>,
    /// Given tangential forces at these [N/m]; empty: there are none.
    given: Vec<f64>,
    /// Powers of their places \[1]; empty: the line is in no patch.
    powers: Vec<ByPowers>,
    row: Vec<f64>,
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

impl OwnForces {
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
        self.stuck.clear();
        self.sheared.clear();
        self.given.clear();
        if let Some(given) = given {
            let open = |(i, force): &(usize, &f64)| **force != 0.0 && !line.state.status[*i].is_active();
            self.nodes.extend(given.iter().enumerate().filter(open).map(|(i, _)| i));
            self.given.extend(self.nodes.iter().map(|&i| given[i]));
        }
        self.powers.clear();
        if let Some(patch) = line.problem.patch {
            self.powers.extend(self.nodes.iter().map(|&i| patch.powers(line.grid.x[i])));
        }
        let bodies = line.body_rows();
        let pressed = self.press(line, unknowns, (axes, &bodies));
        pressed && (given.is_some() || unknowns.stuck.is_empty() || self.shear(line, unknowns, (axes, sought), &bodies))
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

    /// Takes the shear that keeps stuck nodes from slipping.
    #[inline(never)]
    fn shear(
        &mut self,
        line: &ContactLine,
        unknowns: &LineUnknowns,
        (axes, sought): (&Axes, &[Axis]),
        bodies: &BodyRows,
    ) -> bool {
        let Self { shear, sheared, stuck, row, pressed, friction, powers, .. } = self;
        let closed = &unknowns.closed;
        stuck.extend(closed.iter().enumerate().filter(|(_, i)| line.state.status[**i].is_stuck()).map(|(k, _)| k));
        shear.reset(stuck.len());
        for (r, &place) in stuck.iter().enumerate() {
            let (affine, upwind) = line.slip_row(closed[place], bodies);
            let equation = axes.equation(affine);
            let mut sides = [0.0; COLUMNS];
            sides[KNOWN] = -(equation.constant + equation.motions.dot(line.traction.rigid));
            sides[PORTS].iter_mut().zip(&affine.ports).for_each(|(side, by)| *side = -by);
            if let Some(powers) = powers.get(place) {
                sides[FELT].iter_mut().zip(powers).for_each(|(side, power)| *side = -power);
            }
            sides[ANGLE] = -affine.angle;
            sides[MOTIONS].iter_mut().zip(sought).for_each(|(side, &axis)| *side = -equation.motions[axis]);
            line.slips_by_own(closed[place], &upwind, closed, row);
            for ((slip, friction), [pressed]) in row.iter().zip(&*friction).zip(&*pressed) {
                add(-slip * friction, pressed, &mut sides[..PRESSED]);
            }
            for (at, slip) in line.slips_by_pressure(&upwind) {
                if let Ok(place) = closed.binary_search_by_key(&at, |&j| line.grid.component(j)) {
                    add(-slip, &pressed[place][0], &mut sides[..PRESSED]);
                }
            }
            shear.row(r).0.iter_mut().zip(&*stuck).for_each(|(value, &place)| *value = row[place]);
            sheared.push([sides]);
        }
        shear.factorise() && shear.solve_with_all(sheared)
    }

    /// Sum over the nodes of tangential and normal forces, times factors.
    pub fn sum(&self, factors: impl Fn(usize) -> [f64; 2]) -> Felt {
        let (mut sum, mut of_pressures) = ([0.0; COLUMNS], [0.0; PRESSED]);
        for (place, (friction, [pressed])) in self.friction.iter().zip(&self.pressed).enumerate() {
            let [tangential, normal] = factors(place);
            add(normal + friction * tangential, pressed, &mut of_pressures);
        }
        for (&place, [sheared]) in self.stuck.iter().zip(&self.sheared) {
            add(factors(place)[0], sheared, &mut sum);
        }
        add(1.0, &of_pressures, &mut sum[..PRESSED]);
        sum[KNOWN] += self.given.iter().enumerate().map(|(place, force)| factors(place)[0] * force).sum::<f64>();
        sum
    }

    /// Sums over the nodes of tangential and of normal forces, times values there.
    #[inline(never)]
    pub fn sums(&self, values: impl Fn(usize) -> [f64; POINTS]) -> [[Felt; 2]; POINTS] {
        let (mut sums, mut slipping, mut normal) =
            ([[[0.0; COLUMNS]; 2]; POINTS], [[0.0; PRESSED]; POINTS], [[0.0; PRESSED]; POINTS]);
        for (place, (friction, [pressed])) in self.friction.iter().zip(&self.pressed).enumerate() {
            for ((slipping, normal), value) in slipping.iter_mut().zip(&mut normal).zip(values(place)) {
                add(value, pressed, normal);
                if *friction != 0.0 {
                    add(friction * value, pressed, slipping);
                }
            }
        }
        for (&place, [sheared]) in self.stuck.iter().zip(&self.sheared) {
            sums.iter_mut().zip(values(place)).for_each(|(sum, value)| add(value, sheared, &mut sum[0]));
        }
        for (place, force) in self.given.iter().enumerate() {
            sums.iter_mut().zip(values(place)).for_each(|(sum, value)| sum[0][KNOWN] += value * force);
        }
        for ((sum, slipping), normal) in sums.iter_mut().zip(&slipping).zip(&normal) {
            add(1.0, slipping, &mut sum[0][..PRESSED]);
            add(1.0, normal, &mut sum[1][..PRESSED]);
        }
        sums
    }

    /// Moments of the tangential forces with the powers of their places, if the line is in a patch.
    pub fn moments(&self) -> Option<[[Felt; 2]; POINTS]> {
        (!self.powers.is_empty()).then(|| self.sums(|place| self.powers[place]))
    }

    /// Hands tangential and normal forces at all nodes over, given what the line feels.
    pub fn take(&self, felt: &Felt, mut give: impl FnMut(usize, [f64; 2])) {
        let value = |of: &[f64]| of.iter().zip(felt).map(|(of, by)| of * by).sum::<f64>();
        let mut stuck = self.stuck.iter().zip(&self.sheared).peekable();
        for (place, &i) in self.nodes.iter().enumerate() {
            let normal = self.pressed.get(place).map_or(0.0, |[pressed]| value(pressed));
            let sheared = stuck.next_if(|(at, _)| **at == place).map(|(_, [sheared])| value(sheared));
            let slipping = self.friction.get(place).map_or(0.0, |friction| friction * normal);
            give(i, [self.given.get(place).copied().or(sheared).unwrap_or(slipping), normal]);
        }
    }
}
