//! The force of a fresh flat on a wheel that keeps contact, against a mass on two half-planes and against `v Δ √(K m)`.
//!
//! A rigid wheel of radius r turns about one edge of its flat of length L, then about the other: the path of its centre
//! has a kink of the angle `Δ = L/r`. A mass m that follows it through a spring K adds `v Δ √(K m)`, if it rings many
//! times while it passes the flat (`√(K/m) L/v` large) and if the kink is sharp for it: the tilted flat lies on the
//! rail while the contact gives by more than the lifted edge, for the way `2 δ r/L`.

use crate::common::{self, model, prescribed, preset};
use nalgebra::{Cholesky, DMatrix, DVector};
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::sync::Arc;
use wheelrail::config::{Config, Damping};
use wheelrail::material::Isotropic;
use wheelrail::simulation::{Inputs, Model, Simulation};

const LENGTH: f64 = 0.04;
/// Middle of the flat [m].
const MIDDLE: f64 = 0.08;

/// A cold elastic wheel without damping or friction, on a heavy hub. The round wheel has the grid of that with a flat.
fn heavy(hub_mass: f64, elements: usize) -> Config {
    let mut config = preset("railway", elements);
    config.thermal.enabled = false;
    (config.tuning.tolerance, config.physics.yielding) = (0.0, false);
    (config.wheel.hub_mass, config.vehicle.damping, config.damping) = (hub_mass, 0.0, Damping::NONE);
    config
}

fn rolling(model: &Model, velocity: f64, load: f64) -> Inputs {
    let mut inputs = prescribed(model, velocity, 0.0);
    (inputs.drive.friction, inputs.drive.load) = (0.0, load);
    inputs
}

/// Approach under a load [m], and stiffness about it [N/m].
fn spring(model: &Arc<Model>, load: f64) -> (f64, f64) {
    let approach = |share: f64| {
        let inputs = rolling(model, 0.1, share * load);
        Simulation::new(model.clone(), &inputs).unwrap().outputs().contact_approach
    };
    (approach(1.0), 0.02 * load / (approach(1.01) - approach(0.99)))
}

/// Forces [N] at the communication points while the wheel passes its flat and for `after` \[s], and its mass [kg].
fn pass(config: &Config, velocity: f64, load: f64, step: f64, after: f64) -> (Vec<f64>, f64) {
    let mut config = config.clone();
    config.wheel.profile = format!("flat(length = {LENGTH:?}, position = {MIDDLE:?})");
    let model = model(config);
    let inputs = rolling(&model, velocity, load);
    let mut simulation = Simulation::new(model, &inputs).unwrap();
    let steps = ((MIDDLE / velocity + after) / step) as usize;
    let mut force = || {
        simulation.advance(&inputs, step).unwrap();
        simulation.outputs().contact_force_y
    };
    let forces = (0..steps).map(|_| force()).collect();
    (forces, simulation.outputs().wheel_mass)
}

/// A mass on the contact of two half-planes: pressures that are constant over cells, without tension. The rest of the
/// wheel and of its track is a spring, which takes the approach to that of the whole.
struct Lumped {
    x: Vec<f64>,
    /// Displacement of the cells by forces on them [m/N].
    compliance: DMatrix<f64>,
    radius: f64,
    pressed: Vec<bool>,
}

impl Lumped {
    fn new(config: &Config, cell: f64) -> Self {
        let count = (0.03 / cell) as i32;
        let x: Vec<f64> = (-count..=count).map(|k| f64::from(k) * cell).collect();
        let kernel = 2.0 / (PI * Isotropic::from(&config.material).contact_modulus() * config.model.contact_width);
        // The mean of −ln|x| over a cell.
        let part = |s: f64| if s == 0.0 { 0.0 } else { s * (s.abs().ln() - 1.0) };
        let mean = |d: f64| -(part(d + 0.5 * cell) - part(d - 0.5 * cell)) / cell;
        let compliance = DMatrix::from_fn(x.len(), x.len(), |i, j| kernel * mean(x[i] - x[j]));
        Self { pressed: vec![true; x.len()], x, compliance, radius: config.wheel.radius }
    }

    /// Gap of the undeformed wheel, turned so far that the place `s` of its tread is lowest; with a flat or without.
    fn gap(&self, s: f64, flat: bool) -> Vec<f64> {
        let r = self.radius;
        let chord = |at: f64| {
            let angle = at / r;
            let half = 0.5 * LENGTH / r;
            if angle.abs() < half { r - r * half.cos() / angle.cos() } else { 0.0 }
        };
        let at = |&x: &f64| x * x / (r + (r * r - x * x).sqrt()) + if flat { chord(s + x - MIDDLE) } else { 0.0 };
        self.x.iter().map(at).collect()
    }

    /// Force [N] at which the wheel, held `height` \[m] above just touching by a spring of `give` [m/N], rests on the
    /// rail.
    fn force(&mut self, gap: &[f64], height: f64, give: f64) -> f64 {
        for _ in 0..50 {
            let active: Vec<usize> = (0..self.x.len()).filter(|&i| self.pressed[i]).collect();
            let matrix =
                DMatrix::from_fn(active.len(), active.len(), |i, j| self.compliance[(active[i], active[j])] + give);
            let right = DVector::from_fn(active.len(), |i, _| -gap[active[i]] - height);
            let found = Cholesky::new(matrix).map(|factor| factor.solve(&right)).unwrap_or_default();
            let total = found.sum();
            let apart = |i: usize| {
                let pressed: f64 = active.iter().zip(found.iter()).map(|(&j, f)| self.compliance[(i, j)] * f).sum();
                gap[i] + height + give * total + pressed
            };
            let mut next = vec![false; self.x.len()];
            active.iter().zip(found.iter()).for_each(|(&i, f)| next[i] = *f > 0.0);
            (0..next.len()).filter(|&i| !self.pressed[i]).for_each(|i| next[i] = apart(i) < 0.0);
            let settled = next == self.pressed;
            self.pressed = next;
            if settled {
                return total;
            }
        }
        panic!("the contact of the half-planes does not settle")
    }

    /// The spring that takes the approach under a load to a given one [m/N].
    fn rest(&mut self, load: f64, approach: f64) -> f64 {
        let gap = self.gap(0.0, false);
        let (mut low, mut high) = (-2.0 * approach, 2.0 * approach);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            let stiff = self.force(&gap, -middle, 1e-12);
            if stiff < load { low = middle } else { high = middle }
        }
        (approach - low) / load
    }

    /// Forces [N] as in [`pass`], by the trapezoidal rule.
    fn pass(
        &mut self,
        mass: f64,
        give: f64,
        [velocity, load]: [f64; 2],
        approach: f64,
        [step, after]: [f64; 2],
    ) -> Vec<f64> {
        let (mut height, mut speed, mut force) = (-approach, 0.0, load);
        let own = step * step / (4.0 * mass);
        let mut advance = |k: usize| {
            let gap = self.gap(velocity * step * k as f64, true);
            let without = height + step * speed + own * (force - 2.0 * load);
            let next = self.force(&gap, without, give + own);
            height = without + own * next;
            speed += 0.5 * step / mass * (force + next - 2.0 * load);
            force = next;
            force
        };
        (1..=((MIDDLE / velocity + after) / step) as usize).map(&mut advance).collect()
    }
}

fn largest(forces: &[f64]) -> f64 {
    forces.iter().copied().fold(f64::MIN, f64::max)
}

/// On a rigid base the spring of the formula is the contact itself. Its own approach under the strike blunts the kink,
/// whatever speed, mass and stiffness: the force stays below the formula, by a share that half-planes with a mass say
/// as well. Where the edges of the flat lie between nodes matters: with 10 elements per half-width the slowest strike
/// comes out 25 % too hard.
#[test]
fn a_flat_on_its_contact_spring_strikes_as_a_mass_on_half_planes_does() {
    let load = 1e5;
    let config = heavy(3000.0, 20);
    let (approach, stiffness) = spring(&model(config.clone()), load);
    let mut lumped = Lumped::new(&config, 0.25e-3);
    let rest = lumped.rest(load, approach);
    for velocity in [0.3, 0.6, 1.2] {
        let [coarse, fine] = [1e-4, 5e-5].map(|step| pass(&config, velocity, load, step * (0.6 / velocity), 0.03));
        let mass = fine.1;
        let formula = velocity * LENGTH / config.wheel.radius * (stiffness * mass).sqrt();
        let half_planes = lumped.pass(mass, rest, [velocity, load], approach, [1e-4, 0.03]);
        let [found, coarse, expected] = [&fine.0, &coarse.0, &half_planes].map(|forces| largest(forces) - load);
        common::figure(&format!("rigid.base.{velocity}"), &[found / expected - 1.0]);
        common::figure_within(0.02, &format!("rigid.base.force.{velocity} [kN]"), &[1e-3 * found, 1e-3 * expected]);
        common::figure_within(0.02, &format!("rigid.base.share.{velocity}"), &[found / formula]);
        println!(
            "{velocity} m/s, rings {:.1} rad on the flat: {found:.0} N ({coarse:.0} in steps of twice the length), mass on half-planes \
             {expected:.0} N, formula {formula:.0} N: {:.3} of it",
            (stiffness / mass).sqrt() * LENGTH / velocity,
            found / formula
        );
        assert!((found / expected - 1.0).abs() < 0.05 && (found / coarse - 1.0).abs() < 0.01, "{found} {expected}");
        assert!(found < 0.8 * formula);
    }
}

/// The stiff limit: a spring of the track beside which the contact hardly gives. The wheel is as fast as it rings
/// `3π/2` while it turns about one edge, so that what it falls behind on the arcs has come back when the strike is
/// largest.
#[test]
fn a_flat_on_a_track_much_softer_than_its_contact_strikes_by_the_formula() {
    let (load, after) = (3e3, 0.25);
    // Nodes of the flat are twice as far apart as those of the smooth wheel whose stiffness is in the formula.
    for (stiffness, tolerance) in [(1e6, 0.055), (4e6, 0.055)] {
        let mut config = heavy(5e-3 * stiffness, 10);
        config.rail.support_stiffness = stiffness;
        let (_, whole) = spring(&model(config.clone()), load);
        let mass = config.wheel.hub_mass + 72.0;
        let ring = (whole / mass).sqrt();
        let velocity = ring * 0.5 * LENGTH / (TAU - FRAC_PI_2);
        let (forces, mass) = pass(&config, velocity, load, 1e-3, after);
        let added = largest(&forces) - load;
        let formula = velocity * LENGTH / config.wheel.radius * (whole * mass).sqrt();
        common::figure(&format!("soft.track.{}", 1e-6 * stiffness), &[added / formula - 1.0]);
        common::figure_within(0.02, &format!("soft.track.force.{} [N]", 1e-6 * stiffness), &[added, formula]);
        println!(
            "track of {stiffness:.0e} N/m, K {whole:.3e} N/m, {velocity:.4} m/s: {added:.1} N, formula {formula:.1} N: {:.3}",
            added / formula
        );
        assert!((added / formula - 1.0).abs() < tolerance, "{added} {formula}");
    }
}
