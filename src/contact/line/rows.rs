//! Gap and slip of a line as affine functions of contact forces, rigid motions, their accelerations and the rim angle.

use super::contact_line::ContactLine;
use crate::axes::{Axis, PerAxis};
use crate::contact::problem::Influence;
use crate::linalg::POINTS;

/// An affine function without its coefficients of the line's own forces.
#[derive(Clone, Copy, Debug, Default)]
pub struct AffineRow {
    /// Coefficients of the forces of all lines on the ports [1/(N/m)].
    pub ports: [f64; 2 * POINTS],
    /// Coefficient of the rim angle [1/rad].
    pub angle: f64,
    /// Coefficients of the rigid motions.
    pub motions: PerAxis<f64>,
    /// Coefficients of their accelerations.
    pub accelerations: PerAxis<f64>,
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

/// Displacements of the points of the bodies by forces on the ports and rigid accelerations, for all rows of a line.
pub struct BodyRows {
    /// Displacement of the wheel less that of the rail, along.
    moved: [[f64; BODY_COLUMNS]; POINTS],
    /// Displacements of both along, times the velocities that carry them [m/s].
    carried: [[f64; BODY_COLUMNS]; POINTS],
    /// Rise of the wheel by rigid accelerations.
    raised: [[f64; Axis::COUNT]; POINTS],
}

/// Forces on the ports, then rigid accelerations.
const BODY_COLUMNS: usize = 2 * POINTS + Axis::COUNT;

/// Sum of columns times factors.
fn combine<const N: usize>(factors: &[f64; POINTS], columns: &[[f64; N]; POINTS], sum: &mut [f64; N]) {
    for (factor, columns) in factors.iter().zip(columns) {
        sum.iter_mut().zip(columns).for_each(|(sum, value)| *sum += factor * value);
    }
}

impl ContactLine<'_> {
    /// Part of the bodies in the rows of this line.
    pub fn body_rows(&self) -> BodyRows {
        let (bodies, v, velocity) = (&self.problem.bodies, self.traction.rigid.travel, self.rim_velocity());
        let Influence { compliance: [wheel, rail], relative } = bodies.shared;
        let of = |k: usize, by: usize| match by.checked_sub(2 * POINTS) {
            None => (relative[(2 * k, by)], velocity * wheel[(2 * k, by)] + v * rail[(2 * k, by)]),
            Some(axis) => (bodies.inertial[(2 * k, axis)], velocity * bodies.inertial[(2 * k, axis)]),
        };
        BodyRows {
            moved: std::array::from_fn(|k| std::array::from_fn(|by| of(k, by).0)),
            carried: std::array::from_fn(|k| std::array::from_fn(|by| of(k, by).1)),
            raised: std::array::from_fn(|k| std::array::from_fn(|axis| bodies.inertial[(2 * k + 1, axis)])),
        }
    }

    /// The gap at a candidate without that by forces \[m].
    pub fn gap_row(&self, i: usize, bodies: &BodyRows) -> AffineRow {
        let (at, x) = (self.grid.component(i) + 1, self.grid.x[i]);
        let mut raised = [0.0; Axis::COUNT];
        combine(&self.grid.values[at / 2], &bodies.raised, &mut raised);
        let accelerations = PerAxis::from_fn(|axis| raised[axis.number()]);
        let [wheel, rail] = &self.given.displacement;
        let constant = self.given.gap[i] + wheel[at] - x * self.frame.rim_angle - rail[at];
        let motions = PerAxis::unit(Axis::Height);
        AffineRow { motions, accelerations, angle: -x, constant, ..AffineRow::default() }
    }

    /// The slip at a candidate without that by own forces [m/s], linearised in V, Ω and the rim angle about the present
    /// iterate, and its upwind difference.
    pub fn slip_row(&self, i: usize, bodies: &BodyRows) -> (AffineRow, UpwindSlip) {
        let (problem, at) = (self.problem, self.grid.component(i));
        let (v, velocity, gain) = (self.traction.rigid.travel, self.rim_velocity(), problem.time.a0);
        let [wheel, rail] = &self.given.displacement;
        let mut constant = gain * (wheel[at] - rail[at]) + self.given.slip_offset[i];
        let upwind = self.upwind_slip(i);
        let mut slopes = [0.0; POINTS];
        for (at, weight) in upwind.stencil {
            constant += weight * (v * rail[at] - velocity * self.frame.tangential(wheel, at));
            slopes.iter_mut().zip(self.grid.values[at / 2]).for_each(|(slope, value)| *slope -= weight * value);
        }
        let mut by_bodies = [0.0; BODY_COLUMNS];
        combine(&self.grid.values[at / 2].map(|value| gain * value), &bodies.moved, &mut by_bodies);
        combine(&slopes, &bodies.carried, &mut by_bodies);
        let accelerations = PerAxis::from_fn(|axis| by_bodies[2 * POINTS + axis.number()]);
        let [stretch_wheel, stretch_rail] = upwind.stretches;
        let (travel, rotation) = (1.0 + stretch_rail, -problem.radius() * (1.0 + stretch_wheel));
        let mut motions = PerAxis { travel, rotation, ..PerAxis::default() };
        motions.add(-problem.position, PerAxis::from_fn(|axis| self.spin.by(axis)));
        constant += -v * stretch_rail + problem.radius() * self.traction.rigid.rotation * stretch_wheel;
        let ports = std::array::from_fn(|port| by_bodies[port]);
        (AffineRow { ports, angle: upwind.by_angle, motions, accelerations, constant }, upwind)
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
        motions.add(x, PerAxis::from_fn(|axis| self.spin.by(axis)));
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
        let (node, nodes) = (i + grid.guard, grid.logarithms.nrows());
        let constant = 2.0 * gain * along.factor * along.reach;
        let by_node = |node: usize, factor: f64| (&grid.logarithms.as_slice()[node * nodes..][..nodes], factor);
        let [a, b, c] = upwind.stencil.map(|(at, weight)| by_node(at / 2, -carried * weight * along.factor));
        let columns = [by_node(node, 2.0 * gain * along.factor), a, b, c];
        slips.clear();
        match closed {
            // Neighbours: loops over them run several at a time.
            [first, .., last] if last - first < closed.len() => {
                slips.resize(closed.len(), constant);
                for (column, factor) in columns {
                    let column = &column[first + grid.guard..][..closed.len()];
                    slips.iter_mut().zip(column).for_each(|(slip, logarithm)| *slip += factor * logarithm);
                }
            }
            _ => slips.extend(closed.iter().map(|j| {
                columns.iter().fold(constant, |slip, (column, factor)| slip + factor * column[j + grid.guard])
            })),
        }
        if self.problem.layer > 0.0 {
            let rate = (grid.component(i), gain);
            let stencil = upwind.stencil.map(|(at, weight)| (at, -0.5 * carried * weight));
            for (at, factor) in [rate].into_iter().chain(stencil) {
                if let Ok(place) = closed.binary_search_by_key(&at, |&j| grid.component(j)) {
                    slips[place] += factor * self.layer_by_force(at);
                }
            }
        }
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
