//! Data of a contact problem that distinguish it from others of the same model.

use super::bodies::Operators;
use crate::axes::PerAxis;
use crate::contact::{Drift, Friction, RigidMotion};
use crate::mechanics::response::FreeResponse;
use crate::multistep::TimeDerivative;

/// Data that distinguish one contact problem of a model from another.
pub struct ContactStep<'a> {
    /// Answers of the bodies for this step size.
    pub operators: &'a Operators,
    /// Their answers without contact forces: wheel, rail.
    pub free: &'a [FreeResponse; 2],
    /// The rigid motions.
    pub rigid: PerAxis<RigidMotion>,
    /// Drift of the wheel at the contact besides its rigid motions.
    pub drift: Drift,
    /// Shift of the wheelset \[m].
    pub shift: f64,
    /// Radius of rolling of the cold wheel \[m].
    pub radius: f64,
    /// Time formula; all zero: stationary.
    pub time: TimeDerivative,
    /// Length of the step \[s]; zero: stationary.
    pub duration: f64,
    /// Change of the contact force in the step \[N/m], if it goes on as in the one before.
    pub rise: f64,
    /// Distance travelled \[m] and angle by which the hub has turned \[rad] at the end of the step, as predicted.
    pub place: [f64; 2],
    /// Height of the rail \[m].
    pub elevation: f64,
    /// Smallest pressure under which steel yields, however hot it is \[Pa]; 0: it is as soft as it is.
    pub firm: f64,
    /// Friction coefficient of every line as a function of the slip at the end of the step.
    pub friction: &'a [Friction],
    /// Largest change of the weights at the contact edges that counts as converged \[1].
    pub edge_tolerance: f64,
}
