//! History of a line that its next step refers to: rim angle and friction.

use crate::multistep::{History, TimeDerivative};
use serde::{Deserialize, Serialize};

/// Friction at the end of the last step, and the impulses that the time formula attributes to that step.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct FrictionHistory {
    /// Friction forces on the wheel at the nodes, those across after those along [N/m].
    pub force: Vec<f64>,
    /// Their impulses in the last step [N s/m].
    pub impulse: Vec<f64>,
    /// Slip velocities there [m/s].
    pub slip: Vec<f64>,
    /// Rest of the power [W/m]: that of pressure on the sliding slope of the rail, less that of expanding material.
    pub slope_power: f64,
    /// Its work in the last step [J/m].
    pub slope_work: f64,
}

impl FrictionHistory {
    /// Nothing has acted yet at `n` places.
    pub fn none(n: usize) -> Self {
        let zeros = || vec![0.0; n];
        Self { force: zeros(), impulse: zeros(), slip: zeros(), slope_power: 0.0, slope_work: 0.0 }
    }

    /// Takes force and slip of every place at the end of a step, and the rest of the power. Returns the power that
    /// friction turns from mechanical energy into heat [W/m], and its energy in the step [J/m]: the impulse of every
    /// force times the mean velocity.
    pub fn advance(
        &mut self,
        time: &TimeDerivative,
        slope_power: f64,
        force_and_slip: impl Fn(usize) -> [f64; 2],
    ) -> [f64; 2] {
        let (mut power, mut work) = (slope_power, 0.0);
        for i in 0..self.force.len() {
            let [force, slip] = force_and_slip(i);
            power -= force * slip;
            if !time.is_stationary() {
                self.impulse[i] = time.impulse(force, self.force[i], self.impulse[i]);
                work -= self.impulse[i] * 0.5 * (self.slip[i] + slip);
            }
            (self.force[i], self.slip[i]) = (force, slip);
        }
        if !time.is_stationary() {
            self.slope_work = time.impulse(slope_power, self.slope_power, self.slope_work);
            work += self.slope_work;
        }
        self.slope_power = slope_power;
        [power, work]
    }

    /// Makes room for friction at `n` places, of which further ones have had none.
    pub fn reach(&mut self, n: usize) {
        [&mut self.force, &mut self.impulse, &mut self.slip].into_iter().for_each(|values| values.resize(n, 0.0));
    }

    /// Takes away all slip: the state of a wheel at rest.
    pub fn rest(&mut self) {
        self.slip.fill(0.0);
        self.slope_power = 0.0;
    }

    /// True if it has `n` places.
    pub fn fits(&self, n: usize) -> bool {
        [&self.force, &self.impulse, &self.slip].into_iter().all(|values| values.len() == n)
    }

    /// Becomes equal to another one and keeps its memory.
    fn copy_from(&mut self, other: &Self) {
        self.force.clone_from(&other.force);
        self.impulse.clone_from(&other.impulse);
        self.slip.clone_from(&other.slip);
        (self.slope_power, self.slope_work) = (other.slope_power, other.slope_work);
    }
}

/// History of a line.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct LineHistory {
    /// Angle by which the rim under the contact has turned against the hub, positive where the tread moves towards `+x`
    /// \[rad].
    pub rim_angle: History,
    /// Friction.
    pub friction: FrictionHistory,
}

impl LineHistory {
    /// Nothing has acted yet at `n` places of friction.
    pub fn none(n: usize) -> Self {
        Self { rim_angle: History::default(), friction: FrictionHistory::none(n) }
    }

    /// Becomes equal to another one and keeps its memory.
    pub fn copy_from(&mut self, other: &Self) {
        self.rim_angle = other.rim_angle;
        self.friction.copy_from(&other.friction);
    }
}
