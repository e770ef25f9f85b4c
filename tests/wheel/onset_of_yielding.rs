//! Onset of yielding under friction: below its limit steel that could yield is elastic steel, and where pressures reach the
//! limit, node by node, the force of friction goes on without steps.

use crate::common::{HARDLY, figure, model, prescribed, preset, round_off};
use wheelrail::config::Config;
use wheelrail::simulation::Simulation;

/// Largest pressure over the yield strength: `(2 + π)/√3`, and that of steel that stands under friction of `2/(2 + π)` and
/// more: `(1 + π/2)/√3`.
const ROLLS: f64 = 2.968_449_6;
const STANDS: f64 = 0.5 * ROLLS;

/// A wheel under a load that leads from one value to another one [N] within a time in steps [s].
struct Course {
    preset: &'static str,
    friction: f64,
    /// Velocity [m/s] and creepage; 2: the wheel is locked.
    motion: [f64; 2],
    loads: [f64; 2],
    time: [f64; 2],
}

impl Course {
    /// Force along over friction after every step, and the largest pressure [Pa], with a yield strength [Pa] or without;
    /// the share of the nodes that yield in the end.
    fn run(&self, change: impl Fn(&mut Config), strength: Option<f64>) -> (Vec<f64>, f64, f64) {
        let mut config = preset(self.preset, 10);
        config.friction.coefficient = self.friction;
        config.physics.yielding = strength.is_some();
        config.material.yield_strength = strength.unwrap_or(config.material.yield_strength);
        change(&mut config);
        let model = model(config);
        let mut inputs = prescribed(&model, self.motion[0], self.motion[1]);
        inputs.drive.lateral_velocity = if model.config().contact.lateral { HARDLY } else { 0.0 };
        let [time, h] = self.time;
        let steps = (time / h).round();
        let load = |k: usize| self.loads[0] + (self.loads[1] - self.loads[0]) * k as f64 / steps;
        inputs.drive.load = load(0);
        let mut simulation = Simulation::new(model, &inputs).unwrap();
        let (mut forces, mut most) = (Vec::new(), 0.0f64);
        for k in 0..steps as usize {
            (inputs.drive.load, inputs.rate.load) = (load(k), (load(k + 1) - load(k)) / h);
            simulation.advance(&inputs, h).unwrap();
            let o = simulation.outputs();
            most = most.max(o.contact_pressure_max);
            forces.push(o.contact_force_x / (inputs.drive.friction * load(k + 1)));
        }
        (forces, most, simulation.outputs().yielded)
    }
}

/// Up to .999 of the yield pressure, partly and wholly slipping, along and in all directions, and where the wheel stands.
#[test]
fn steel_below_its_yield_pressure_is_elastic_steel() {
    let [s1002, dry] = ["railway_s1002_3mm", "railway_dry"];
    let mut worst = [0.0f64; 2];
    for (preset, friction, motion, lateral) in [
        ("railway", 0.3, [20.0, -0.003], false),
        (s1002, 0.3, [20.0, -0.003], false),
        (s1002, 0.3, [20.0, -0.003], true),
        (s1002, 0.3, [20.0, -0.1], false),
        (dry, 0.55, [20.0, -0.1], false),
        (dry, 0.55, [0.5, 2.0], false),
    ] {
        let course = Course { preset, friction, motion, loads: [1e5, 1.05e5], time: [0.02, 1e-3] };
        let change = |config: &mut Config| {
            config.contact.lateral = lateral;
            config.thermal.enabled = false;
        };
        let (elastic, most, _) = course.run(change, None);
        let stands = motion[1] == 2.0;
        for share in [0.9, 0.95, 0.97, 0.99, 0.999] {
            let strength = most / share / if stands { STANDS } else { ROLLS };
            let (forces, _, yielded) = course.run(change, Some(strength));
            let off = forces.iter().zip(&elastic).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            println!(
                "{preset}, {motion:?}, lateral {lateral}, {share} of {:.0} MPa: {off:.1e} of friction",
                most / 1e6 / share
            );
            worst[usize::from(stands)] = worst[usize::from(stands)].max(off);
            assert_eq!(yielded, 0.0);
        }
    }
    round_off("onset.elastic", &worst, 1e-8);
    assert!(worst.iter().all(|off| *off < 1e-4), "{worst:?}");
}

/// From 100 to 160 kN in 60 ms: more and more nodes yield. Steps of the force beyond those of elastic steel become smaller with
/// those of the load.
#[test]
fn force_of_friction_has_no_steps_where_steel_begins_to_yield() {
    for lateral in [false, true] {
        let steps = [1e-3, 2.5e-4].map(|h| {
            let (preset, motion) = ("railway_s1002_3mm", [20.0, -0.003]);
            let course = Course { preset, friction: 0.3, motion, loads: [1e5, 1.6e5], time: [0.06, h] };
            let change = |config: &mut Config| config.contact.lateral = lateral;
            let (elastic, _, _) = course.run(change, None);
            let (forces, most, yielded) = course.run(change, Some(550e6));
            let off: Vec<f64> = forces.iter().zip(&elastic).map(|(a, b)| a - b).collect();
            let most_of = |values: &[f64]| values.windows(2).map(|v| (v[1] - v[0]).abs()).fold(0.0, f64::max);
            let [step, whole, last] = [most_of(&off), most_of(&forces), off[off.len() - 1]];
            println!(
                "lateral {lateral}, steps of {h} s: {:.0} MPa, {yielded:.2} yields, force off by {last:+.1e}, steps of at \
                 most {step:.1e}, {whole:.1e} in all",
                most / 1e6
            );
            assert!(yielded > 0.1);
            step
        });
        figure(if lateral { "onset.lateral" } else { "onset.steps" }, &steps);
        assert!(steps[0] < 1e-3 && steps[1] < 0.7 * steps[0], "{steps:?}");
    }
}
