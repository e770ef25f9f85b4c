//! The ramps of Paper D, section 6.1, by the thesis's own steps in time, with friction and with heat.

use super::mesh_heat::{Thermal, heating};
use super::rolling;
use crate::coupled::{self, Expansion};
use crate::dynamic::{Prescribed, Rolling};
use crate::mesh::Mesh;
use crate::newton;
use crate::rolling::{State, System};
use crate::stabilise::Scheme;
use crate::triangle::Order;
use crate::warming::Warming;

/// Share of the duration in which the creepage grows to its end.
pub(super) const GROWTH: f64 = 0.7;
pub(super) const CREEPAGE: f64 = -8e-4;
pub(super) const SPEED: f64 = 50.0 / 3.6;
/// Linear expansion in the presets of the papers [1/K]; steel has 1.2e-5.
const EXPANSION: f64 = 4.8e-6;

/// Creepage at a share of the duration.
pub(super) fn creepage(share: f64) -> f64 {
    CREEPAGE * (share / GROWTH).min(1.0)
}

/// Something for every place or instant.
pub(super) type Points = Vec<[f64; 2]>;

fn said(error: crate::Error) -> String {
    error.to_string()
}

/// Wheel and rail that roll without creepage: linear triangles with `edge` half-widths in the contact, so many
/// refinements of the whole wheel.
pub(super) struct Bodies {
    system: System,
    meshes: [Mesh; 2],
    start: State,
}

impl Bodies {
    pub(super) fn new(edge: f64, global: usize) -> Result<Self, String> {
        let (system, meshes) = rolling::triangles(edge, global)?;
        let (start, _) = newton::rolling(&system, rolling::motion(SPEED, 0.0)).map_err(said)?;
        Ok(Self { system, meshes, start })
    }

    fn rolling(&self) -> Rolling<'_> {
        let [wheel, rail] = &self.meshes;
        Rolling::new(&self.system, wheel, rail, self.start.clone())
    }

    /// Utilisation over the share of the duration in so many steps, the mean of traction and braking, which leaves out
    /// the force that an uneven mesh has by itself.
    pub(super) fn forces(&self, duration: f64, steps: usize) -> Result<Points, String> {
        let one_way = |sign: f64| {
            let mut run = self.rolling();
            let mut forces = vec![rolling::share_of_limit(&self.system, &run.touches)];
            for k in 1..=steps {
                run.advance(duration / steps as f64, velocities(sign, k, steps)).map_err(said)?;
                forces.push(rolling::share_of_limit(&self.system, &run.touches));
            }
            Ok::<_, String>(forces)
        };
        let (traction, braking) = (one_way(1.0)?, one_way(-1.0)?);
        let pairs = traction.iter().zip(&braking).enumerate();
        Ok(pairs.map(|(k, (forward, back))| [k as f64 / steps as f64, 0.5 * (forward - back)]).collect())
    }

    /// Tractions \[MPa] over the place \[mm] at some steps.
    pub(super) fn tractions(&self, duration: f64, steps: usize, at: &[usize]) -> Result<Vec<Points>, String> {
        let (mut run, mut all) = (self.rolling(), Vec::new());
        for k in 1..=at.iter().copied().max().unwrap_or_default() {
            run.advance(duration / steps as f64, velocities(1.0, k, steps)).map_err(said)?;
            if at.contains(&k) {
                let point = |touch: &crate::rolling::Touch| {
                    let slave = touch.nodes[0];
                    [1e3 * self.system.places[slave][0], 1e-6 * touch.forces.on[0][0].value / self.system.length(slave)]
                };
                let mut points: Points = run.touches.iter().map(point).collect();
                points.sort_by(|a, b| a[0].total_cmp(&b[0]));
                all.push(points);
            }
        }
        Ok(all)
    }

    /// Temperatures over the reference \[K] of the node of the tread that is nearest to the nominal contact point over
    /// the share of the duration: displacements and temperatures in one iteration, upwinding in both bodies.
    pub(super) fn temperatures(&self, duration: f64, steps: usize) -> Result<Points, String> {
        let motion = self.start.motion;
        let thermal = Thermal {
            wheel: (Order::Linear, Scheme::Supg),
            motion: [motion.omega, motion.velocity],
            ..Thermal::paper_c()
        };
        let mut warming = Warming::new(heating(&self.meshes, &[], thermal), 0.05, None);
        let expansion = Expansion::new(&self.system, &warming, EXPANSION);
        let (mut run, [node, _]) = (self.rolling(), self.system.nearest());
        let mut points = vec![[0.0, 0.0]];
        for k in 1..=steps {
            let prescribed = velocities(1.0, k, steps);
            coupled::advance(&mut run, &mut warming, &expansion, duration / steps as f64, prescribed).map_err(said)?;
            points.push([k as f64 / steps as f64, warming.theta[node]]);
        }
        Ok(points)
    }
}

/// Velocities at the end of a step of a ramp, in traction or braking.
fn velocities(sign: f64, k: usize, steps: usize) -> [Prescribed; 2] {
    let target = rolling::motion(SPEED, sign * creepage(k as f64 / steps as f64));
    [target.omega, target.velocity].map(Prescribed::Velocity)
}
