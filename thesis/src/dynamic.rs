//! Rolling in time with friction as \[D] § 5.3.2 computes it: backward Euler, matrices as sums with coefficients of the
//! velocities, contact at the end of the step, and one Newton iteration for the displacements and for the velocities
//! that are found.
//!
//! Moment and force may be prescribed at once here: the wheel's own inertia tells its velocity, which no stationary
//! state does.

use crate::Error;
use crate::contact::Law;
use crate::decomposition::{Course, Decomposition, Part};
use crate::iteration::{Equations, Motions, iterate};
use crate::mesh::Mesh;
use crate::rolling::{Motion, State, System, Touch};
use crate::sparse::Matrix;

/// Prescription of rotation or travel at the end of a step.
#[derive(Clone, Copy, Debug)]
pub enum Prescribed {
    /// Angular velocity, forward [rad/s], or velocity [m/s]; what drives the hub is found.
    Velocity(f64),
    /// Moment, forward \[N], or force [N/m] on the hub; the velocity is found.
    Effort(f64),
}

/// A wheel that rolls, from a state of stationary rolling on.
pub struct Rolling<'a> {
    system: &'a System,
    parts: Decomposition,
    /// Displacements and motion.
    pub state: State,
    /// Rates of the displacements [m/s].
    pub rates: Vec<f64>,
    /// Moment, forward \[N], and force [N/m] on the hub in the last step.
    pub efforts: [f64; 2],
    /// Where the bodies touch.
    pub touches: Vec<Touch>,
}

impl<'a> Rolling<'a> {
    /// Starts from a stationary state of a system that was made of these meshes.
    pub fn new(system: &'a System, wheel: &Mesh, rail: &Mesh, start: State) -> Self {
        let touches = system.touches(&system.expand(&start.q), start.motion, system.parameters.law);
        let rates = vec![0.0; start.q.len()];
        let parts = Decomposition::new(system, wheel, rail);
        Self { system, parts, state: start, rates, efforts: [0.0; 2], touches }
    }

    /// A step \[s] under what is prescribed of rotation and travel; returns the number of Newton's steps.
    pub fn advance(&mut self, step: f64, prescribed: [Prescribed; 2]) -> Result<usize, Error> {
        let equations = self.equations(step, prescribed);
        let (state, iterations) = iterate(&equations, &self.guess(prescribed))?;
        let end = equations.end(state);
        self.take(end);
        Ok(iterations)
    }

    /// The present state with the velocities that are prescribed.
    pub fn guess(&self, prescribed: [Prescribed; 2]) -> State {
        let mut guess = self.state.clone();
        for (velocity, given) in [&mut guess.motion.omega, &mut guess.motion.velocity].into_iter().zip(prescribed) {
            if let Prescribed::Velocity(value) = given {
                *velocity = value;
            }
        }
        guess
    }

    /// Goes on from the end of a step.
    pub fn take(&mut self, End { state, rates, efforts, touches }: End) {
        (self.state, self.rates, self.efforts, self.touches) = (state, rates, efforts, touches);
    }

    /// The equations of a step from here.
    pub fn equations(&self, step: f64, prescribed: [Prescribed; 2]) -> TimeStep<'_> {
        TimeStep { before: self, step, prescribed }
    }
}

/// Result of a time step; as in [`Rolling`].
pub struct End {
    state: State,
    rates: Vec<f64>,
    efforts: [f64; 2],
    touches: Vec<Touch>,
}

/// The equations of a time step (\[D] (27), (28)).
pub struct TimeStep<'a> {
    before: &'a Rolling<'a>,
    step: f64,
    prescribed: [Prescribed; 2],
}

impl TimeStep<'_> {
    fn law(&self) -> Law {
        self.before.system.parameters.law
    }

    /// Result of the step where this state solves its equations.
    pub fn end(&self, state: State) -> End {
        let (forces, touches) = self.forces(&state);
        let size = self.before.system.size;
        End { rates: self.rates(&state), efforts: [forces[size], forces[size + 1]], touches, state }
    }

    fn course(&self, motion: Motion) -> Course {
        let before = self.before.state.motion;
        Course {
            motion,
            spin_up: (motion.omega - before.omega) / self.step,
            speed_up: (motion.velocity - before.velocity) / self.step,
        }
    }

    /// Rates of the displacements at the end of the step [m/s].
    fn rates(&self, state: &State) -> Vec<f64> {
        state.q.iter().zip(&self.before.state.q).map(|(now, before)| (now - before) / self.step).collect()
    }

    /// Forces that are missing on the unknowns, moment and force on the hub [N/m, N], and the contact.
    fn forces(&self, state: &State) -> (Vec<f64>, Vec<Touch>) {
        let (system, v) = (self.before.system, self.rates(state));
        let a: Vec<f64> = v.iter().zip(&self.before.rates).map(|(now, before)| (now - before) / self.step).collect();
        let mut forces = self.before.parts.forces(self.course(state.motion), [&state.q, &v, &a]);
        let (u, past) = (system.expand(&state.q), system.expand(&self.before.state.q));
        let touches = system.touches_in_time(&u, Some((&past, 1.0 / self.step)), state.motion, self.law());
        for touch in &touches {
            for (node, force) in [touch.nodes[0], touch.nodes[2], touch.nodes[3]].into_iter().zip(touch.forces.on) {
                for (axis, part) in force.iter().enumerate() {
                    system.unknown[2 * node + axis].iter().for_each(|i| forces[*i] -= part.value);
                }
            }
        }
        forces[system.size - 1] += system.parameters.load;
        (forces, touches)
    }

    /// Rows of the hub that are equations, with what they prescribe.
    fn found(&self) -> impl Iterator<Item = (usize, f64)> {
        self.prescribed.into_iter().enumerate().filter_map(|(k, given)| match given {
            Prescribed::Effort(value) => Some((k, value)),
            Prescribed::Velocity(_) => None,
        })
    }

    /// Derivatives of the forces without contact by angular velocity and velocity.
    fn velocity_columns(&self, state: &State) -> [Vec<f64>; 2] {
        let (parts, v, Motion { omega, velocity }) = (&self.before.parts, self.rates(state), state.motion);
        let rolled = [
            (omega, Part::Turning, Part::Gyroscopic, &parts.spun),
            (velocity, Part::Streaming, Part::Passing, &parts.sped),
        ];
        let mut columns = rolled.map(|(speed, squared, convected, load)| {
            // The rates are convected, twice, and with the acceleration the displacements.
            let carried: Vec<f64> = v.iter().zip(&state.q).map(|(v, u)| 2.0 * v + u / self.step).collect();
            let (first, second) = (parts.multiply(squared, &state.q), parts.multiply(convected, &carried));
            let terms = first.iter().zip(second).zip(load.iter());
            terms.map(|((a, b), load)| -2.0 * speed * a + b + load / self.step).collect::<Vec<_>>()
        });
        columns[0].iter_mut().zip(&parts.squared).for_each(|(sum, load)| *sum += 2.0 * omega * load);
        columns
    }
}

impl Equations for TimeStep<'_> {
    type State = State;

    /// On the unknowns [N/m], then moment \[N] and force [N/m] as far as they are prescribed.
    fn residual(&self, state: &State) -> Vec<f64> {
        let (forces, size) = (self.forces(state).0, self.before.system.size);
        let hub = self.found().map(|(k, value)| forces[size + k] - value);
        forces[..size].iter().copied().chain(hub).collect()
    }

    fn step(&self, state: &State) -> Result<Vec<f64>, Error> {
        self.tangent(state).factorise()?.solve(self.residual(state).iter().map(|value| -value).collect())
    }

    fn size(&self, residual: &[f64]) -> f64 {
        let (parameters, size) = (&self.before.system.parameters, self.before.system.size);
        let forces: f64 = residual[..size].iter().map(|force| force * force).sum();
        let arm = |k: usize| if k == 0 { parameters.annulus.outer } else { 1.0 };
        let hub: f64 = residual[size..].iter().zip(self.found()).map(|(rest, (k, _))| (rest / arm(k)).powi(2)).sum();
        (forces + hub).sqrt() / parameters.load
    }

    fn moved(&self, state: &State, step: &[f64], share: f64) -> State {
        let mut next = state.clone();
        next.q.iter_mut().zip(step).for_each(|(q, d)| *q += share * d);
        for ((k, _), change) in self.found().zip(&step[state.q.len()..]) {
            *[&mut next.motion.omega, &mut next.motion.velocity][k] += share * change;
        }
        next
    }
}

impl Motions for TimeStep<'_> {
    fn system(&self) -> &System {
        self.before.system
    }

    fn tangent(&self, state: &State) -> Matrix {
        let (system, parts) = (self.before.system, &self.before.parts);
        let size = system.size;
        let mut row_of = [None; 2];
        self.found().enumerate().for_each(|(place, (k, _))| row_of[k] = Some(size + place));
        let row = |i: usize| if i < size { Some(i) } else { row_of[i - size] };
        let mut tangent = Matrix::new(size + self.found().count());
        let linear = parts.of_step(self.course(state.motion), self.step);
        linear.for_each(|(i, j, value)| row(i).iter().for_each(|i| tangent.add(*i, j, value)));
        let mut by_velocity = self.velocity_columns(state);
        for touch in self.forces(state).1 {
            for (node, force) in [touch.nodes[0], touch.nodes[2], touch.nodes[3]].into_iter().zip(touch.forces.on) {
                for (axis, part) in force.iter().enumerate() {
                    let Some(i) = system.unknown[2 * node + axis] else { continue };
                    for (k, slope) in part.slopes[..8].iter().enumerate() {
                        system.unknown[2 * touch.nodes[k / 2] + k % 2].iter().for_each(|j| tangent.add(i, *j, -slope));
                    }
                    (0..2).for_each(|k| by_velocity[k][i] -= part.slopes[8 + k]);
                }
            }
        }
        for (k, column) in by_velocity.iter().enumerate() {
            let Some(j) = row_of[k] else { continue };
            for (i, value) in column.iter().enumerate() {
                row(i).iter().for_each(|i| tangent.add(*i, j, *value));
            }
        }
        tangent
    }

    fn touches(&self, state: &State) -> Vec<Touch> {
        self.forces(state).1
    }

    fn found(&self) -> Vec<usize> {
        TimeStep::found(self).map(|(k, _)| k).collect()
    }
}
