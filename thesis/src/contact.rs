//! Contact of a node of the wheel with a segment of the rail's surface: penalty and regularised friction
//! (\[B] (36)–(40), \[C] (12)–(16)).

use crate::dual::Dual;

/// Constants of the contact.
#[derive(Clone, Copy, Debug)]
pub struct Law {
    /// Penalty stiffness `ε_n` \[Pa]. The traction on a gap is `ε_n/h` times it, the force of a node that times its
    /// length: with that length as `h` it drops out.
    pub penalty: f64,
    /// Friction coefficient \[1].
    pub friction: f64,
    /// Slip velocity `ε_r` over which friction builds up [m/s].
    pub regularisation: f64,
}

/// Places of a contact element at rest \[m], in the frame of the rail.
#[derive(Clone, Copy, Debug)]
pub struct Pair {
    /// Node of the wheel.
    pub slave: [f64; 2],
    /// Node of the tread upstream of it.
    pub upstream: [f64; 2],
    /// Ends of the segment of the rail, left and right.
    pub master: [[f64; 2]; 2],
    /// Centre of the wheel.
    pub centre: [f64; 2],
}

/// How the nodes of a contact element came where they are within a time step: backward differences give `d_t u` (\[D]
/// (17)).
#[derive(Clone, Copy, Debug, Default)]
pub struct Past {
    /// Displacements of slave, upstream node and both masters at the beginning of the step \[m].
    pub from: [[f64; 2]; 4],
    /// Inverse of the step \[1/s]; zero in stationary rolling.
    pub rate: f64,
}

/// Answer of a contact element: forces [N/m] on the slave node and the two ends of the segment.
#[derive(Clone, Copy, Debug)]
pub struct Forces {
    /// Gap \[m].
    pub gap: Dual,
    /// Slip velocity `ṡ` [m/s].
    pub slip: Dual,
    /// Friction force on the slave node along the segment [N/m].
    pub tangential: Dual,
    /// Forces on slave and master nodes.
    pub on: [[Dual; 2]; 3],
}

impl Forces {
    /// Place of the slave node on the segment, from 0 at its left end to 1 at its right \[1].
    pub fn share(&self) -> Dual {
        -self.on[2][1] / self.on[0][1]
    }

    /// Friction power [W/m], never negative: friction is against the slip.
    pub fn friction_power(&self) -> Dual {
        -self.tangential * self.slip
    }
}

type Vector = [Dual; 2];

fn plus(a: Vector, b: Vector) -> Vector {
    [a[0] + b[0], a[1] + b[1]]
}

fn minus(a: Vector, b: Vector) -> Vector {
    [a[0] - b[0], a[1] - b[1]]
}

fn dot(a: Vector, b: Vector) -> Dual {
    a[0] * b[0] + a[1] * b[1]
}

fn scaled(a: Vector, factor: Dual) -> Vector {
    a.map(|part| part * factor)
}

impl Law {
    /// Forces of a pair for the displacements \[m] of slave, upstream node and both masters, angular velocity forward
    /// [rad/s] and velocity [m/s]; `None` where the gap is open.
    ///
    /// Normal and tangent are those of the deformed segment. The velocity of deformed material is `(1 + ∇u)·v̄`, with
    /// ∇u of the boundary element upstream on the wheel and of the segment on the rail.
    pub fn forces(&self, pair: &Pair, u: &[[f64; 2]; 4], omega: f64, velocity: f64) -> Option<Forces> {
        self.forces_in_time(pair, u, &Past::default(), omega, velocity)
    }

    /// Answer in a time step: the slip has a part of the rates, too.
    pub fn forces_in_time(
        &self,
        pair: &Pair,
        u: &[[f64; 2]; 4],
        past: &Past,
        omega: f64,
        velocity: f64,
    ) -> Option<Forces> {
        let moved: [Vector; 4] = std::array::from_fn(|k| [0, 1].map(|axis| Dual::variable(u[k][axis], 2 * k + axis)));
        let (omega, velocity) = (Dual::variable(omega, 8), Dual::variable(velocity, 9));
        let fixed = |place: [f64; 2]| place.map(Dual::constant);
        let slave = plus(fixed(pair.slave), moved[0]);
        let (left, right) = (plus(fixed(pair.master[0]), moved[2]), plus(fixed(pair.master[1]), moved[3]));
        let along = minus(right, left);
        let length = dot(along, along).sqrt();
        let tangent = along.map(|part| part / length);
        let normal = [-tangent[1], tangent[0]];
        let from_left = minus(slave, left);
        let gap = dot(from_left, normal);
        if gap.value >= 0.0 {
            return None;
        }
        let share = dot(from_left, tangent) / length;
        let rate = |k: usize| minus(moved[k], fixed(past.from[k])).map(|way| way * Dual::constant(past.rate));
        let below = plus(scaled(rate(2), Dual::constant(1.0) - share), scaled(rate(3), share));
        let wheel = plus(self.wheel_velocity(pair, &moved, omega), rate(0));
        let rail = plus(rail_velocity(pair, &moved, velocity), below);
        let slip = dot(minus(wheel, rail), tangent);
        let normal_force = -gap * Dual::constant(self.penalty);
        let tangential =
            -normal_force * (slip / Dual::constant(self.regularisation)).tanh() * Dual::constant(self.friction);
        let force = plus(scaled(normal, normal_force), scaled(tangent, tangential));
        let on = [force, scaled(force, share - Dual::constant(1.0)), scaled(force, -share)];
        Some(Forces { gap, slip, tangential, on })
    }

    /// `(1 + ∇u)·v̄` of the wheel: its material turns forward about the centre.
    fn wheel_velocity(&self, pair: &Pair, moved: &[Vector; 4], omega: Dual) -> Vector {
        let arm = [pair.slave[0] - pair.centre[0], pair.slave[1] - pair.centre[1]];
        let edge = (pair.slave[0] - pair.upstream[0]).hypot(pair.slave[1] - pair.upstream[1]);
        let stretch = minus(moved[0], moved[1]).map(|part| part * Dual::constant(arm[0].hypot(arm[1]) / edge));
        scaled(plus([Dual::constant(arm[1]), Dual::constant(-arm[0])], stretch), omega)
    }
}

/// `(1 + ∇u)·v̄` of the rail: its material streams backward.
fn rail_velocity(pair: &Pair, moved: &[Vector; 4], velocity: Dual) -> Vector {
    let edge = Dual::constant(pair.master[1][0] - pair.master[0][0]);
    let slope = minus(moved[3], moved[2]).map(|part| part / edge);
    scaled([slope[0] + Dual::constant(1.0), slope[1]], -velocity)
}
