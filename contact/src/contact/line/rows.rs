//! Gap and slip of a line as affine functions of contact forces, rigid motions, their accelerations and the rim angle.

use super::contact_line::ContactLine;
use crate::axes::{Axis, PerAxis};
use crate::contact::problem::Influence;
use crate::linalg::POINTS;
use crate::linalg::vectorised::add_columns;

/// An affine function without its coefficients of the line's own forces.
#[derive(Clone, Copy, Debug, Default)]
pub struct AffineRow {
    /// Coefficients of the displacements along of the wheel less those of the rail at the points of the bodies.
    pub moved: [f64; POINTS],
    /// Coefficients of the displacements of both along there, times the velocities that carry them [m/s].
    pub carried: [f64; POINTS],
    /// Coefficient of the rim angle [1/rad].
    pub angle: f64,
    /// Coefficients of the rigid motions.
    pub motions: PerAxis<f64>,
    /// Constant at the rim angle of the present iterate; it contains the accelerations that are known.
    pub constant: f64,
}

/// Upwind difference of the slip at a candidate.
pub struct UpwindSlip {
    /// Components x of its nodes, with the weights of `∂u/∂x` [1/m].
    pub stencil: [(usize, f64); 3],
    /// Stretches of wheel and rail by it \[1].
    stretches: [f64; 2],
    /// Change of the slip with the rim angle [m/s/rad].
    by_angle: f64,
}

/// Effects of the bodies on a line at their points: gaps that they open, displacements of the wheel less those of the rail along,
/// and displacements of both along, times the velocities that carry them.
pub const BODY_ROWS: usize = 3 * POINTS;
/// Causes of these: forces on the ports, then rigid motions, in whole registers.
pub const BODY_CAUSES: usize = (2 * POINTS + Axis::COUNT).next_multiple_of(4);
/// Effects by causes.
pub type BodyRows = [[f64; BODY_CAUSES]; BODY_ROWS];

impl ContactLine<'_> {
    /// Effects at the points of the bodies of forces on the ports and of the `motions` that are sought, whose accelerations are
    /// `gains` [1/s] times the motions.
    pub fn body_rows(&self, motions: &[Axis], gains: PerAxis<f64>) -> BodyRows {
        let (bodies, v, velocity) = (&self.problem.bodies, self.traction.rigid.travel, self.rim_velocity());
        let Influence { compliance: [wheel, rail], relative } = bodies.shared;
        let mut rows = [[0.0; BODY_CAUSES]; BODY_ROWS];
        for (k, port) in (0..POINTS).flat_map(|k| (0..2 * POINTS).map(move |port| (k, port))) {
            rows[k][port] = relative[(2 * k + 1, port)];
            rows[POINTS + k][port] = relative[(2 * k, port)];
            rows[2 * POINTS + k][port] = velocity * wheel[(2 * k, port)] + v * rail[(2 * k, port)];
        }
        for (number, &axis) in motions.iter().enumerate() {
            let (at, gain) = (2 * POINTS + number, gains[axis]);
            for k in 0..POINTS {
                let [along, up] = [0, 1].map(|component| gain * bodies.inertial[(2 * k + component, axis.number())]);
                rows[k][at] = up + if axis == Axis::Height { 1.0 } else { 0.0 };
                (rows[POINTS + k][at], rows[2 * POINTS + k][at]) = (along, velocity * along);
            }
        }
        rows
    }

    /// Effects of the accelerations that are sought at the points of the bodies in the present iterate.
    pub fn accelerated(&self, gains: PerAxis<f64>) -> [f64; BODY_ROWS] {
        let (velocity, mut rows) = (self.rim_velocity(), [0.0; BODY_ROWS]);
        for (axis, gain) in gains.iter().filter(|(_, gain)| *gain != 0.0) {
            let acceleration = gain * self.traction.rigid[axis];
            for k in 0..POINTS {
                let moved = |component: usize| self.problem.bodies.inertial[(2 * k + component, axis.number())];
                let [along, up] = [0, 1].map(|component| acceleration * moved(component));
                rows[k] += up;
                rows[POINTS + k] += along;
                rows[2 * POINTS + k] += velocity * along;
            }
        }
        rows
    }

    /// The gap at a candidate without that by forces and accelerations that are sought \[m].
    pub fn known_gap(&self, i: usize) -> f64 {
        let (at, [wheel, rail]) = (self.grid.component(i) + 1, &self.given.displacement);
        let tilt = self.grid.x[i] * self.frame.rim_angle;
        self.given.gap[i] + wheel[at] - tilt - rail[at] + self.traction.rigid.height
    }

    /// The slip at a candidate without that by own forces [m/s], linearised in V, Ω and the rim angle about the present
    /// iterate, and its upwind difference.
    pub fn slip_row(&self, i: usize) -> (AffineRow, UpwindSlip) {
        let (problem, at) = (self.problem, self.grid.component(i));
        let (v, velocity, gain) = (self.traction.rigid.travel, self.rim_velocity(), problem.time.a0);
        let [wheel, rail] = &self.given.displacement;
        let mut constant = gain * (wheel[at] - rail[at]) + self.given.slip_offset[i];
        let upwind = self.upwind_slip(i);
        let mut carried = [0.0; POINTS];
        for (at, weight) in upwind.stencil {
            constant += weight * (v * rail[at] - velocity * self.frame.tangential(wheel, at));
            carried.iter_mut().zip(&self.grid.values[at / 2]).for_each(|(slope, value)| *slope -= weight * value);
        }
        let moved = self.grid.values[at / 2].map(|value| gain * value);
        let [stretch_wheel, stretch_rail] = upwind.stretches;
        let (travel, rotation) = (1.0 + stretch_rail, -problem.radius() * (1.0 + stretch_wheel));
        let mut motions = PerAxis { travel, rotation, ..PerAxis::default() };
        motions.add(1.0, PerAxis::from_fn(|axis| self.drift.along.by(axis)));
        motions.add(-problem.position, PerAxis::from_fn(|axis| self.drift.spin.by(axis)));
        constant += self.drift.along.constant - problem.position * self.drift.spin.constant;
        constant += -v * stretch_rail + problem.radius() * self.traction.rigid.rotation * stretch_wheel;
        (AffineRow { moved, carried, angle: upwind.by_angle, motions, constant }, upwind)
    }

    /// The upwind difference of the slip at a candidate: a turn of the rim tilts the surface and slows the rim.
    pub fn upwind_slip(&self, i: usize) -> UpwindSlip {
        let (row, to_right) = (self.iterate.upwind.row(i), self.upstream_right());
        let (stencil, stretches) = (self.stencil(i, row, to_right), self.stretches(i, row, to_right));
        let height = |at: usize| self.frame.radius - self.frame.sagitta[at / 2];
        let tilt: f64 = stencil.iter().map(|(at, weight)| weight * height(*at)).sum();
        let by_angle = self.rim_velocity() * tilt + self.problem.radius() * self.problem.time.a0 * stretches[0];
        UpwindSlip { stencil, stretches, by_angle }
    }

    /// The slip across at a candidate without that by own forces [m/s], linearised like [`Self::slip_row`]: plane bodies do not
    /// feel it.
    pub fn slip_row_across(&self, i: usize, upwind: &UpwindSlip) -> AffineRow {
        let (x, radius, time) = (self.grid.x[i], self.problem.radius(), &self.problem.time);
        let own = upwind.stencil.iter().map(|(port, weight)| weight * self.iterate.displaced[port / 2]).sum::<f64>();
        let by_speed = -0.5 * (own + self.stretch_by_lines(1, i));
        let mut motions = PerAxis { travel: by_speed, rotation: by_speed * radius, ..PerAxis::unit(Axis::Lateral) };
        let constant = self.state.moved[1][i].offset(time)
            - motions.travel * self.traction.rigid.travel
            - motions.rotation * self.traction.rigid.rotation;
        motions.add(1.0, PerAxis::from_fn(|axis| self.drift.across.by(axis)));
        motions.add(x, PerAxis::from_fn(|axis| self.drift.spin.by(axis)));
        let constant = constant + self.drift.across.constant + x * self.drift.spin.constant;
        AffineRow { motions, angle: -by_speed * radius * time.a0, constant, ..AffineRow::default() }
    }

    /// Writes changes of the slip along (0) or across (1) at a candidate with unit forces in this direction at the `closed`
    /// candidates, as far as the line alone is displaced, in the order of these.
    pub fn slips_by_own(
        &self,
        direction: usize,
        (i, upwind): (usize, &UpwindSlip),
        closed: &[usize],
        slips: &mut Vec<f64>,
    ) {
        let (grid, gain) = (self.grid, self.problem.time.a0);
        let along = grid.unscaled(self.kernel.along(2 * direction));
        let carried = self.traction.rigid.travel + self.rim_velocity();
        let nodes = grid.logarithms.nrows();
        let constant = 2.0 * gain * along.factor * along.reach;
        // The difference is one of three neighbours, of which the first is the candidate itself.
        let [(a, near), (_, middle), (c, far)] = upwind.stencil;
        let mut weights = [2.0 * gain - carried * near, -carried * middle, -carried * far];
        if c < a {
            weights.reverse();
        }
        let columns = &grid.logarithms.as_slice()[a.min(c) / 2 * nodes..];
        slips.clear();
        match closed {
            [first, .., last] if last - first < closed.len() => {
                slips.resize(closed.len(), constant);
                add_columns(along.factor, &columns[first + grid.guard..], nodes, &weights, slips);
            }
            _ => slips.extend(closed.iter().map(|j| {
                let of_column = |(k, weight): (usize, &f64)| weight * columns[k * nodes + j + grid.guard];
                constant + along.factor * weights.iter().enumerate().map(of_column).sum::<f64>()
            })),
        }
        self.add_slips_by_layer((i, upwind), closed, slips);
    }

    /// Changes of the slip at a candidate with unit normal forces at the nodes of its upwind difference: pressure strains both
    /// surfaces alike, which slip feels where they pass the contact with different velocities [m/s/(N/m)].
    pub fn slips_by_pressure(&self, upwind: &UpwindSlip) -> [(usize, f64); 3] {
        let [(a, near), (b, middle), (c, far)] = upwind.stencil;
        let half = 0.5 * self.kernel.coupling * (self.traction.rigid.travel - self.rim_velocity());
        // Forces on one of three neighbours have the others before or behind them.
        let towards = if b > a { 1.0 } else { -1.0 } * half;
        let of = [-(middle + far), near - far, near + middle];
        [(a, towards * of[0]), (b, towards * of[1]), (c, towards * of[2])]
    }
}
