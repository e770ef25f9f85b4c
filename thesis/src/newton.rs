//! One Newton iteration for all unknowns (\[B] § 5.3, \[C] § 5.3, \[D] § 5.3), and the same iteration on the contact
//! alone.

use crate::Error;
use crate::contact::Law;
use crate::iteration::{Equations, Motions, iterate};
use crate::rolling::{Motion, State, System, Touch};
use crate::sparse::Matrix;
use nalgebra::{DMatrix, DVector};
use wheelrail::analytic::{contact_modulus, hertz_half_width, hertz_peak_pressure};

/// Drive of the wheel (\[D] (23) to (28)). Moment and force at once would prescribe the creepage twice and the
/// velocity not at all.
#[derive(Clone, Copy, Debug)]
pub enum Drive {
    /// Both velocities are prescribed.
    Velocity,
    /// The moment on its hub is prescribed, forward \[N], and the velocity of travel; the angular velocity is found.
    Moment(f64),
    /// The force on its hub is prescribed, forward [N/m], and the angular velocity; the velocity of travel is found.
    Force(f64),
}

/// Residual of a state [N/m], and its last entry with a prescribed moment \[N] or force [N/m].
pub type Residual = Vec<f64>;

/// An iteration on a system.
pub struct Newton<'a> {
    /// Problem that is solved.
    pub system: &'a System,
    /// Contact law, mostly the system's own.
    pub law: Law,
    /// Drive.
    pub drive: Drive,
}

impl Newton<'_> {
    /// Residual and contact of a state (\[D] (26), (27)).
    pub fn residual(&self, state: &State) -> (Residual, Vec<Touch>) {
        let system = self.system;
        let u = system.expand(&state.q);
        let touches = system.touches(&u, state.motion, self.law);
        let mut forces = system.stiffness(state.motion).multiply(&u);
        let square = state.motion.omega.powi(2);
        forces.iter_mut().zip(&system.centrifugal).for_each(|(force, load)| *force -= square * load);
        for touch in &touches {
            for (node, force) in [touch.nodes[0], touch.nodes[2], touch.nodes[3]].into_iter().zip(touch.forces.on) {
                (0..2).for_each(|axis| forces[2 * node + axis] -= force[axis].value);
            }
        }
        let mut residual = system.gather(&forces);
        residual[system.size - 1] += system.parameters.load;
        if let Some((weights, prescribed)) = self.prescribed() {
            let reaction: f64 = forces.iter().zip(weights).map(|(force, weight)| force * weight).sum();
            residual.push(reaction - prescribed);
        }
        (residual, touches)
    }

    /// Prescription instead of a velocity: weights of the forces on the hub, and what their sum must be.
    fn prescribed(&self) -> Option<(&[f64], f64)> {
        match self.drive {
            Drive::Velocity => None,
            Drive::Moment(moment) => Some((&self.system.arms, moment)),
            Drive::Force(force) => Some((&self.system.along, force)),
        }
    }

    /// Derivative of the residual (\[D] (40) to (44)): contact included, and with a prescribed moment or force one more
    /// column and row.
    pub fn tangent(&self, state: &State, touches: &[Touch]) -> Matrix {
        let system = self.system;
        let full = system.stiffness(state.motion);
        let mut tangent = system.reduce(&full);
        let last = system.size;
        // The velocity that is found and the place of its derivative in a contact element.
        let travels = matches!(self.drive, Drive::Force(_));
        let mut with_velocity = vec![0.0; system.arms.len()];
        for touch in touches {
            for (row, force) in [touch.nodes[0], touch.nodes[2], touch.nodes[3]].into_iter().zip(touch.forces.on) {
                for (axis, part) in force.iter().enumerate() {
                    let slopes = part.slopes;
                    with_velocity[2 * row + axis] -= slopes[if travels { 9 } else { 8 }];
                    let Some(i) = system.unknown[2 * row + axis] else { continue };
                    for (k, slope) in slopes[..8].iter().enumerate() {
                        system.unknown[2 * touch.nodes[k / 2] + k % 2].iter().for_each(|j| tangent.add(i, *j, -slope));
                    }
                }
            }
        }
        if let Some((weights, _)) = self.prescribed() {
            tangent.size += 1;
            let u = system.expand(&state.q);
            if travels {
                let streamed = system.streaming.multiply(&u);
                with_velocity.iter_mut().zip(&streamed).for_each(|(d, s)| *d -= 2.0 * state.motion.velocity * s);
            } else {
                let turned = system.turning.multiply(&u);
                let loads = turned.iter().zip(&system.centrifugal);
                with_velocity.iter_mut().zip(loads).for_each(|(d, (t, c))| *d -= 2.0 * state.motion.omega * (t + c));
            }
            let column = system.gather(&with_velocity);
            column.iter().enumerate().for_each(|(i, value)| tangent.add(i, last, *value));
            tangent.add(last, last, with_velocity.iter().zip(weights).map(|(value, weight)| value * weight).sum());
            for (i, j, value) in full.entries.iter().filter(|entry| weights[entry.0] != 0.0) {
                system.unknown[*j].iter().for_each(|j| tangent.add(last, *j, weights[*i] * value));
            }
        }
        tangent
    }

    /// Size of a residual over the load \[1]; moments over the radius.
    pub fn size(&self, residual: &[f64]) -> f64 {
        let parameters = &self.system.parameters;
        let arm = if matches!(self.drive, Drive::Moment(_)) { parameters.annulus.outer } else { 1.0 };
        let (forces, prescribed) = residual.split_at(self.system.size);
        let sum: f64 = forces.iter().map(|force| force * force).sum();
        let rest: f64 = prescribed.iter().map(|rest| (rest / arm).powi(2)).sum();
        (sum + rest).sqrt() / parameters.load
    }

    /// The state a share of a step further on.
    pub fn moved(&self, state: &State, step: &[f64], share: f64) -> State {
        let q = state.q.iter().zip(step).map(|(q, d)| q + share * d).collect();
        let change = share * step.get(state.q.len()).copied().unwrap_or_default();
        let Motion { omega, velocity } = state.motion;
        let motion = match self.drive {
            Drive::Force(_) => Motion { omega, velocity: velocity + change },
            _ => Motion { omega: omega + change, velocity },
        };
        State { q, motion }
    }

    /// Solves from a start; returns the state and the number of steps.
    pub fn solve(&self, start: &State) -> Result<(State, usize), Error> {
        iterate(self, start)
    }
}

impl Equations for Newton<'_> {
    type State = State;

    fn residual(&self, state: &State) -> Vec<f64> {
        Newton::residual(self, state).0
    }

    fn step(&self, state: &State) -> Result<Vec<f64>, Error> {
        Motions::tangent(self, state)
            .factorise()?
            .solve(Newton::residual(self, state).0.iter().map(|value| -value).collect())
    }

    fn size(&self, residual: &[f64]) -> f64 {
        Newton::size(self, residual)
    }

    fn moved(&self, state: &State, step: &[f64], share: f64) -> State {
        Newton::moved(self, state, step, share)
    }
}

impl Motions for Newton<'_> {
    fn system(&self) -> &System {
        self.system
    }

    fn tangent(&self, state: &State) -> Matrix {
        Newton::tangent(self, state, &Newton::residual(self, state).1)
    }

    fn touches(&self, state: &State) -> Vec<Touch> {
        self.system.touches(&self.system.expand(&state.q), state.motion, self.law)
    }

    fn found(&self) -> Vec<usize> {
        match self.drive {
            Drive::Velocity => Vec::new(),
            Drive::Moment(_) => vec![0],
            Drive::Force(_) => vec![1],
        }
    }
}

/// Contact without friction at rest: from bodies loaded by Hertz' pressure, brought together until they carry the load.
pub fn frictionless(system: &System) -> Result<State, Error> {
    let parameters = &system.parameters;
    let a = hertz_half_width(
        parameters.load,
        parameters.annulus.outer,
        contact_modulus(parameters.young, parameters.poisson),
    );
    let load = system.hertz(a, hertz_peak_pressure(parameters.load, a));
    let rest = Motion { omega: 0.0, velocity: 0.0 };
    let mut matrix = system.reduce(&system.stiffness(rest));
    matrix.fix(&[system.size - 1]);
    let mut right = system.gather(&load);
    right[system.size - 1] = 0.0;
    let mut q = matrix.factorise()?.solve(right)?;
    // The whole wheel comes down until the contact point penetrates as far as the penalty wants.
    let [tread, rail] = system.nearest();
    let u = system.expand(&q);
    let down = u[2 * rail + 1] - u[2 * tread + 1] - a.min(parameters.load / parameters.law.penalty * 0.2);
    let mut lowered = vec![false; system.size];
    (0..system.wheel_nodes).for_each(|node| system.unknown[2 * node + 1].iter().for_each(|i| lowered[*i] = true));
    q.iter_mut().zip(lowered).filter(|(_, lowered)| *lowered).for_each(|(q, _)| *q += down);
    let law = Law { friction: 0.0, ..parameters.law };
    let newton = Newton { system, law, drive: Drive::Velocity };
    newton.solve(&State { q, motion: rest }).map(|(state, _)| state)
}

/// Rolling by velocity stepping (\[C] § 5.3): velocities grow from a thousandth to their full values by factors of √10
/// with the creepage kept; a step that fails is halved on the logarithmic scale. The steps are taken on the contact
/// alone, which changes nothing but their cost. Returns the state and all Newton steps.
pub fn rolling(system: &System, motion: Motion) -> Result<(State, usize), Error> {
    let mut state = frictionless(system)?;
    let newton = Newton { system, law: system.parameters.law, drive: Drive::Velocity };
    let (mut reached, mut factor, mut count) = (1e-3 / 10.0_f64.sqrt(), 10.0_f64.sqrt(), 0);
    loop {
        let scale = (reached * factor).min(1.0);
        state.motion = Motion { omega: scale * motion.omega, velocity: scale * motion.velocity };
        let solved = Condensed::new(system, state.motion).and_then(|condensed| condensed.solve(&newton, &state));
        match solved {
            Ok((next, steps)) => {
                (state, reached, count) = (next, scale, count + steps);
                if scale == 1.0 {
                    // All other unknowns are linear: one assembled step finds them.
                    let step = newton.step(&state)?;
                    return newton
                        .solve(&newton.moved(&state, &step, 1.0))
                        .map(|(state, steps)| (state, count + steps));
                }
            }
            Err(error) if factor < 1.02 => return Err(error),
            Err(_) => factor = factor.sqrt(),
        }
    }
}

/// Forces of the contact on the wheel [N/m]: forward and up.
pub fn resultant(touches: &[Touch]) -> [f64; 2] {
    [0, 1].map(|axis| touches.iter().map(|touch| touch.forces.on[0][axis].value).sum())
}

/// Iteration on the unknowns of the contact and the hub: all others are linear and eliminated once.
pub struct Condensed {
    /// Unknowns that are kept.
    pub kept: Vec<usize>,
    stiffness: DMatrix<f64>,
    load: DVector<f64>,
}

impl Condensed {
    /// Eliminates what is linear, for a motion.
    pub fn new(system: &System, motion: Motion) -> Result<Self, Error> {
        let kept = system.contact_unknowns();
        let matrix = system.reduce(&system.stiffness(motion));
        let mut full_load = system.gather(&system.centrifugal);
        full_load.iter_mut().for_each(|load| *load *= motion.omega.powi(2));
        full_load[system.size - 1] -= system.parameters.load;
        let mut place = vec![None; system.size];
        kept.iter().enumerate().for_each(|(k, i)| place[*i] = Some(k));
        let mut inner = Matrix::new(system.size);
        let mut columns = vec![0.0; system.size * (kept.len() + 1)];
        let mut stiffness = DMatrix::zeros(kept.len(), kept.len());
        let mut rows = Vec::new();
        for &(i, j, value) in &matrix.entries {
            match (place[i], place[j]) {
                (None, None) => inner.add(i, j, value),
                (None, Some(column)) => columns[column * system.size + i] += value,
                (Some(row), None) => rows.push((row, j, value)),
                (Some(row), Some(column)) => stiffness[(row, column)] += value,
            }
        }
        kept.iter().for_each(|i| inner.add(*i, *i, 1.0));
        let mut load = DVector::from_iterator(kept.len(), kept.iter().map(|i| full_load[*i]));
        for (i, value) in full_load.iter().enumerate().filter(|(i, _)| place[*i].is_none()) {
            columns[kept.len() * system.size + i] = *value;
        }
        let solved = inner.factorise()?.solve(columns)?;
        for (row, j, value) in rows {
            (0..kept.len()).for_each(|column| stiffness[(row, column)] -= value * solved[column * system.size + j]);
            load[row] -= value * solved[kept.len() * system.size + j];
        }
        Ok(Self { kept, stiffness, load })
    }

    /// Values of the kept unknowns of a state.
    fn values(&self, state: &State) -> DVector<f64> {
        DVector::from_iterator(self.kept.len(), self.kept.iter().map(|i| state.q[*i]))
    }

    /// Residual on the kept unknowns, and its derivative.
    fn equations(&self, newton: &Newton<'_>, state: &State) -> (DVector<f64>, DMatrix<f64>) {
        let system = newton.system;
        let mut place = vec![None; system.size];
        self.kept.iter().enumerate().for_each(|(k, i)| place[*i] = Some(k));
        let mut tangent = self.stiffness.clone();
        let mut residual = &self.stiffness * self.values(state) - &self.load;
        for touch in system.touches(&system.expand(&state.q), state.motion, newton.law) {
            for (row, force) in [touch.nodes[0], touch.nodes[2], touch.nodes[3]].into_iter().zip(touch.forces.on) {
                for (axis, part) in force.iter().enumerate() {
                    let Some(i) = system.unknown[2 * row + axis].and_then(|i| place[i]) else { continue };
                    residual[i] -= part.value;
                    for (k, slope) in part.slopes[..8].iter().enumerate() {
                        let column = system.unknown[2 * touch.nodes[k / 2] + k % 2].and_then(|j| place[j]);
                        column.iter().for_each(|j| tangent[(i, *j)] -= slope);
                    }
                }
            }
        }
        (residual, tangent)
    }

    /// The next values of the kept unknowns after a full Newton step from a state.
    pub fn next(&self, newton: &Newton<'_>, state: &State) -> Option<DVector<f64>> {
        let (residual, tangent) = self.equations(newton, state);
        tangent.lu().solve(&residual).map(|step| self.values(state) - step)
    }

    /// Solves from a start as [`Newton::solve`] does, which takes the same steps; of the result only the kept unknowns
    /// are true.
    pub fn solve(&self, newton: &Newton<'_>, start: &State) -> Result<(State, usize), Error> {
        iterate(&OnContact { condensed: self, newton }, start)
    }
}

/// The equations on the kept unknowns.
struct OnContact<'a> {
    condensed: &'a Condensed,
    newton: &'a Newton<'a>,
}

impl Equations for OnContact<'_> {
    type State = State;

    fn residual(&self, state: &State) -> Vec<f64> {
        self.condensed.equations(self.newton, state).0.as_slice().to_vec()
    }

    fn step(&self, state: &State) -> Result<Vec<f64>, Error> {
        let (residual, tangent) = self.condensed.equations(self.newton, state);
        let singular = Error::Singular { size: residual.len(), reason: "contact".into() };
        tangent.lu().solve(&-residual).map(|step| step.as_slice().to_vec()).ok_or(singular)
    }

    fn size(&self, residual: &[f64]) -> f64 {
        residual.iter().map(|force| force * force).sum::<f64>().sqrt() / self.newton.system.parameters.load
    }

    fn moved(&self, state: &State, step: &[f64], share: f64) -> State {
        let mut next = state.clone();
        self.condensed.kept.iter().zip(step).for_each(|(i, change)| next.q[*i] += share * change);
        next
    }
}
