//! The track below the rail: its base moves in x and y as a rigid line on springs, dampers and a mass.
//!
//! The displacement `b` of the base is condensed into the answer of the rail, as its deformation is. In a step
//! `ḃ = a0 b + h_v` and `b̈ = a0² b + h_a`. The rail feels `b̈` as its wheel feels the acceleration of the hub, so that
//! its surface moves by `N b` with `N = E − Pᵀ`: `E` is the rigid shift, `P` the rate of deformation momentum per unit
//! force. The momentum of mass, rail and its deformation balances contact forces `λ` on the rail, damper and spring:
//!
//! `Z b = Nᵀ λ − q`, `Z = a0² (m + D) + a0 c + k`, `q = (m + D) h_a + c h_v + π_free`,
//!
//! with the `D` of [`StepOperator::deformation_inertia`] and the momentum `π_free` of [`FreeResponse::momentum`]. A
//! direction without spring is rigid: it has no unknown. Derivation: `docs/theory/track-support.md`. Per metre of
//! width.

use crate::config::Config;
use crate::mechanics::response::{FreeResponse, StepOperator};
use crate::multistep::{History, TimeDerivative};
use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};

/// Motion of the rail base: x, y.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct BaseMotion {
    /// Displacement from the place of the unloaded track \[m].
    pub displacement: [History; 2],
    /// Its rate [m/s].
    pub velocity: [History; 2],
}

impl BaseMotion {
    /// Velocity [m/s].
    pub fn velocities(&self) -> [f64; 2] {
        self.displacement.map(|b| b.rate)
    }

    /// Acceleration [m/s²].
    pub fn accelerations(&self) -> [f64; 2] {
        self.velocity.map(|v| v.rate)
    }

    /// Known parts of velocity and acceleration before a step: `h_v`, `h_a`.
    fn offsets(&self, td: &TimeDerivative) -> [[f64; 2]; 2] {
        let velocity = self.displacement.map(|b| b.offset(td));
        [velocity, [0, 1].map(|k| td.a0 * velocity[k] + self.velocity[k].offset(td))]
    }

    /// The motion after a step that ends with the displacement `b`; stationary: at rest there.
    fn moved(mut self, td: &TimeDerivative, b: [f64; 2]) -> Self {
        if td.is_stationary() {
            return Self { displacement: b.map(History::constant), velocity: Default::default() };
        }
        for (k, value) in b.into_iter().enumerate() {
            self.displacement[k].push(td, value);
            self.velocity[k].push(td, self.displacement[k].rate);
        }
        self
    }
}

/// Springs, dampers and mass below the rail.
#[derive(Clone, Debug)]
pub struct TrackSupport {
    /// In x, y [N/m per m]; 0: rigid.
    stiffness: [f64; 2],
    /// In x, y [N s/m per m].
    damping: [f64; 2],
    /// Mass of the track and of the rail above it [kg/m].
    mass: f64,
}

impl TrackSupport {
    /// From the parameters; `None` if the base is fixed.
    pub fn new(config: &Config) -> Option<Self> {
        let (rail, width) = (&config.rail, config.width());
        let stiffness = [rail.restraint_stiffness, rail.support_stiffness].map(|k| k / width);
        let damping = [rail.restraint_damping, rail.support_damping].map(|c| c / width);
        let mass = rail.support_mass / width + config.material.density * rail.length * rail.height;
        (stiffness != [0.0; 2]).then_some(Self { stiffness, damping, mass })
    }

    /// Adds the motion of the base to the surface compliance of the rail.
    pub fn condense(&self, rail: &mut StepOperator) -> CondensedBase {
        let (a0, coupled) = (rail.a0, &rail.deformation_inertia);
        let diagonal = |k: usize, l: usize, value: f64| if k == l { value } else { 0.0 };
        let both = |entry: &dyn Fn(usize, usize) -> f64| [0, 1].map(|k| [0, 1].map(|l| entry(k, l)));
        let inertia = both(&|k, l| coupled[(k, l)] + diagonal(k, l, self.mass));
        let held = |k: usize| a0 * self.damping[k] + self.stiffness[k];
        let balance = both(&|k, l| a0 * a0 * inertia[k][l] + diagonal(k, l, held(k)));
        let directions = self.directions(&balance);
        let shift = |i: usize, k: usize| f64::from(i % 2 == k);
        let lever = DMatrix::from_fn(rail.surface.nrows(), 2, |i, k| shift(i, k) - rail.momentum[(k, i)]);
        for [x, y] in directions {
            let answer = lever.column(0) * x + lever.column(1) * y;
            rail.surface.ger(1.0, &answer, &answer, 1.0);
        }
        CondensedBase { a0, inertia, damping: self.damping, directions, lever }
    }

    /// Directions `d` in which the base can move with `Σ d dᵀ` = inverse of the `balance`; zero where it cannot.
    fn directions(&self, balance: &[[f64; 2]; 2]) -> [[f64; 2]; 2] {
        let times = |d: [f64; 2]| balance.map(|row| dot(row, d));
        let mut found = [[0.0; 2]; 2];
        for k in (0..2).filter(|&k| self.stiffness[k] > 0.0) {
            let mut direction = [0.0; 2];
            direction[k] = 1.0;
            for other in found {
                let along = dot(other, times(direction));
                direction = [0, 1].map(|i| direction[i] - along * other[i]);
            }
            let length = dot(direction, times(direction)).sqrt();
            found[k] = direction.map(|component| component / length);
        }
        found
    }

    /// Kinetic energy of the mass and elastic energy of the springs [J/m].
    pub fn energy(&self, motion: &BaseMotion) -> f64 {
        let (b, v) = (motion.displacement, motion.velocities());
        (0..2).map(|k| 0.5 * (self.mass * v[k] * v[k] + self.stiffness[k] * b[k].now * b[k].now)).sum()
    }

    /// Power that the dampers take [W/m].
    pub fn dissipation(&self, motion: &BaseMotion) -> f64 {
        let v = motion.velocities();
        (0..2).map(|k| self.damping[k] * v[k] * v[k]).sum()
    }
}

/// The equations of the base for one step size.
pub struct CondensedBase {
    /// Weight of the new value in the time formula [1/s].
    a0: f64,
    /// `m + D` [kg/m].
    inertia: [[f64; 2]; 2],
    /// `c` [N s/m per m].
    damping: [f64; 2],
    /// `Z⁻¹ = Σ d dᵀ`.
    directions: [[f64; 2]; 2],
    /// `N`: displacement of the surface ports of the rail per unit displacement of the base.
    lever: DMatrix<f64>,
}

impl CondensedBase {
    /// Displacement of the base under the generalised force `g`: `Z⁻¹ g`.
    fn answer(&self, g: [f64; 2]) -> [f64; 2] {
        let shares = self.directions.map(|d| dot(d, g));
        [0, 1].map(|k| shares[0] * self.directions[0][k] + shares[1] * self.directions[1][k])
    }

    /// Minus `q`: the force on the base that is known before the contact is solved.
    fn known(&self, motion: &BaseMotion, td: &TimeDerivative, free: &FreeResponse) -> [f64; 2] {
        let [velocity, acceleration] = motion.offsets(td);
        let momentum = [free.momentum.travel, free.momentum.height];
        [0, 1].map(|k| -dot(self.inertia[k], acceleration) - self.damping[k] * velocity[k] - momentum[k])
    }

    /// Adds to the free response of the rail what the base does without contact forces.
    pub fn move_free(&self, motion: &BaseMotion, td: &TimeDerivative, free: &mut FreeResponse) {
        let b = self.answer(self.known(motion, td, free));
        let acceleration = motion.offsets(td)[1];
        for k in 0..2 {
            // N belongs to a displacement that begins without acceleration, E to one without any.
            let history = if self.a0 > 0.0 { acceleration[k] / (self.a0 * self.a0) } else { 0.0 };
            free.surface.axpy(b[k] + history, &self.lever.column(k), 1.0);
            free.surface.iter_mut().skip(k).step_by(2).for_each(|u| *u -= history);
        }
    }

    /// Motion of the base after a step with the nodal `forces` on the rail [N/m]; `free` is the response of this step.
    pub fn advance(
        &self,
        motion: &BaseMotion,
        td: &TimeDerivative,
        free: &FreeResponse,
        forces: &DVector<f64>,
    ) -> BaseMotion {
        let known = self.known(motion, td, free);
        let b = self.answer([0, 1].map(|k| known[k] + self.lever.column(k).dot(forces)));
        motion.moved(td, b)
    }
}

fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rail_rests_on_springs_dampers_and_mass_of_the_parameters() {
        let mut config = Config::default();
        let rail = &mut config.rail;
        (rail.support_stiffness, rail.support_damping, rail.support_mass) = (5e7, 2e5, 300.0);
        let TrackSupport { stiffness, damping, mass } = TrackSupport::new(&config).unwrap();
        let width = config.width();
        let found = [stiffness, damping].into_iter().flatten().chain([mass]).map(|value| value * width);
        // Of the rail, a metre long and 0.1 m high, and of 14 mm of its width.
        let steel = 7850.0 * 1.0 * 0.1 * 0.014;
        for (found, expected) in found.zip([4e8, 5e7, 1e6, 2e5, 300.0 + steel]) {
            assert!((found / expected - 1.0).abs() < 1e-12, "{found} for {expected}");
        }
    }
}
