//! Newton's iteration with halved steps (\[B] § 5.3), and what it asks of equations.

use crate::Error;
use crate::rolling::{State, System, Touch};
use crate::sparse::Matrix;

/// Residual over the load at which an iteration has converged \[1].
const TOLERANCE: f64 = 1e-9;
const ITERATIONS: usize = 80;
/// Halvings of a step at most.
const HALVINGS: usize = 14;
/// Full steps at most that are taken although the residual grows: nodes that change segments or touch anew make it
/// jump.
const JUMPS: usize = 6;

/// Equations that Newton's iteration solves.
pub trait Equations {
    /// Unknowns.
    type State: Clone;

    /// Residual of the equations in a state.
    fn residual(&self, state: &Self::State) -> Vec<f64>;

    /// Newton's step of a state.
    fn step(&self, state: &Self::State) -> Result<Vec<f64>, Error>;

    /// Size of a residual over the load \[1].
    fn size(&self, residual: &[f64]) -> f64;

    /// The state a share of a step further on.
    fn moved(&self, state: &Self::State, step: &[f64], share: f64) -> Self::State;
}

/// Equations of motion, to which those of heat can be joined.
pub trait Motions: Equations<State = State> {
    /// Wheel and rail.
    fn system(&self) -> &System;

    /// Derivative of the residual.
    fn tangent(&self, state: &State) -> Matrix;

    /// Where they touch.
    fn touches(&self, state: &State) -> Vec<Touch>;

    /// Velocities that are found, in the order of their equations: 0 for the angular velocity, 1 for that of travel.
    fn found(&self) -> Vec<usize>;
}

/// Solves from a start; returns the state and the number of steps. Steps are halved while the residual would grow.
pub fn iterate<E: Equations>(equations: &E, start: &E::State) -> Result<(E::State, usize), Error> {
    let mut state = start.clone();
    let imbalance = |state: &E::State| equations.size(&equations.residual(state));
    let mut residual = imbalance(&state);
    let mut jumps = 0;
    for iterations in 0..ITERATIONS {
        if residual < TOLERANCE {
            return Ok((state, iterations));
        }
        let step = equations.step(&state)?;
        let try_share = |k: usize| {
            let next = equations.moved(&state, &step, 0.5_f64.powi(k as i32));
            let size = imbalance(&next);
            (next, size)
        };
        let better = (0..HALVINGS).map(try_share).find(|(_, size)| *size < residual);
        jumps += usize::from(better.is_none());
        if jumps > JUMPS {
            return Err(Error::NotConverged { iterations, residual });
        }
        (state, residual) = better.unwrap_or_else(|| try_share(0));
    }
    if residual < TOLERANCE {
        Ok((state, ITERATIONS))
    } else {
        Err(Error::NotConverged { iterations: ITERATIONS, residual })
    }
}
