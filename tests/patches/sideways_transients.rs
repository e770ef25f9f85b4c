//! Random transients of lines that slip along and across, and the symmetries of their forces.

use crate::common;
use crate::common::random::Random;
use crate::half_spaces::{FRICTION, HalfSpaces, LOAD, Lines, SPEED, formula, turning};
use wheelrail::contact::{ActiveSetScratch, AxisDrive, Friction, RigidMotion};
use wheelrail::multistep::TimeDerivative;

/// Motion of the wheel in a step.
#[derive(Clone, Copy, Debug)]
struct Step {
    /// Speeds of hub and rim and across [m/s].
    speeds: [f64; 3],
    /// Drift [1/m].
    spin: f64,
    /// Load [N]; none: the wheel is in the air.
    load: f64,
    /// Length of the step [s].
    dt: f64,
}

/// Creepage at which all slips, about \[1].
const SATURATION: f64 = 5e-3;
/// Cost of a step but for its linear laws, over that of one of them (instructions) \[1].
const OTHER_COST: f64 = 3.0;
/// Width of the bodies [m].
const WIDTH: f64 = 0.05;

/// Speeds of hub and rim and across that are held.
fn held(spaces: &HalfSpaces, [travel, rim, across]: [f64; 3]) -> [RigidMotion; 3] {
    [travel, rim / spaces.radius, across].map(|value| RigidMotion::held(value, 0.0))
}

/// A velocity that follows from a `force` [N] on a `mass` \[kg], or without a mass, from `guess` on.
fn driven(guess: f64, force: f64, mass: f64, time: &TimeDerivative) -> RigidMotion {
    let drive = AxisDrive::Free { load: force / WIDTH };
    let gain = if mass > 0.0 { time.a0 } else { 0.0 };
    RigidMotion { drive, guess, gain, offset: -gain * guess, inertia: mass / WIDTH, momentum: 0.0 }
}

/// Largest shear of a line at its nodes over friction.
fn beyond(lines: &Lines) -> f64 {
    let of = |line: &wheelrail::contact::ContactState| {
        let traction = &line.traction;
        let (shear, across, p) = (&traction.shear.value, &traction.lateral_shear.value, &traction.pressure.value);
        let over =
            |i: usize| shear[i].hypot(across.get(i).copied().unwrap_or(0.0)) - traction.friction.coefficient * p[i];
        let most = traction.friction.coefficient * traction.pressure_max.max(1.0);
        (0..p.len()).map(|i| over(i) / most).fold(0.0, f64::max)
    };
    lines.iter().map(of).fold(0.0, f64::max)
}

/// The next step of a random transient.
fn next(random: &mut Random, spaces: &HalfSpaces, before: Step) -> Step {
    let half = spaces.hertz.under(LOAD).a;
    let mut step =
        Step { load: LOAD * random.between(0.7, 1.3), dt: half / SPEED * random.logarithmic(0.01, 10.0), ..before };
    match random.below(12) {
        0 => step.speeds = [0.0; 3],
        1 => step.speeds = [SPEED, 0.0, step.speeds[2]],
        2 => step.load = 0.0,
        3 => step.spin = -step.spin,
        4 => step.speeds = step.speeds.map(|speed| -speed),
        5..8 => {}
        _ => {
            let (size, angle) = (SATURATION * random.between(0.0, 1.5), random.between(-3.2, 3.2));
            let (xi, eta) = (size * angle.cos(), size * angle.sin());
            step.speeds = [SPEED * (1.0 + 0.5 * xi), SPEED * (1.0 - 0.5 * xi), SPEED * eta];
            step.spin = random.between(-1.0, 1.0);
        }
    }
    step
}

/// Numbers of steps, failures and linear laws of random transients.
#[derive(Debug, Default)]
struct Count {
    steps: usize,
    failures: usize,
    newton: usize,
    most: usize,
    beyond: f64,
    least_power: f64,
}

impl Count {
    /// Solves a contact and counts; `None`: it has no solution.
    fn solve(
        &mut self,
        spaces: &HalfSpaces,
        (load, spin, time): (f64, f64, TimeDerivative),
        motion: [RigidMotion; 3],
        start: &Lines,
    ) -> Option<Lines> {
        let (mut scratch, spin) = (ActiveSetScratch::default(), turning(spin));
        let laws = (time, Friction::constant(FRICTION));
        let found = spaces.solve_with(load, motion, spin, laws, start, &mut scratch);
        let solved = scratch.solved() as usize;
        self.newton += solved;
        self.most = self.most.max(solved);
        self.steps += 1;
        match found {
            Ok(found) => {
                let power = spaces.sum(load.max(1.0), &found, |line| line.traction.friction.power);
                self.beyond = self.beyond.max(beyond(&found));
                self.least_power = self.least_power.min(power / (FRICTION * LOAD * SPEED * SATURATION));
                Some(found)
            }
            Err(error) => {
                println!("{load} N, spin {spin:?}, {motion:?}, {time:?}: {error}");
                self.failures += 1;
                None
            }
        }
    }

    /// Friction gives nothing back; of its power thousandths, those of pressure on the inclined surface, have any sign.
    fn check(&self, what: &str, most: f64) {
        let mean = self.newton as f64 / self.steps as f64;
        if what == "held" {
            common::figure("sideways.newton", &[mean, self.most as f64]);
        }
        // A node keeps its state within 1e-9 of the mean force of the nodes.
        common::round_off("sideways.random", &[self.least_power.min(0.0), self.beyond], 1e-9);
        println!("{what}: {self:?}, {mean:.2} a step");
        assert!(self.failures == 0 && self.beyond < 1e-9 && self.least_power > -2e-3);
        assert!(self.most as f64 + OTHER_COST < most * (mean + OTHER_COST));
    }
}

/// Transients of ten steps each; with a `mass` \[kg] the lateral velocity follows from forces now and then.
fn transients(count: u64, spaces: &HalfSpaces, mass: f64) -> Count {
    let mut seen = Count::default();
    for seed in 0..count {
        let (mut random, mut state) = (Random(seed), spaces.start());
        let mut step = Step { speeds: [SPEED, SPEED, 0.0], spin: 0.0, load: LOAD, dt: 1e-3 };
        for k in 0..10 {
            step = next(&mut random, spaces, step);
            let (mut motion, time) = (held(spaces, step.speeds), formula(step.dt, k == 0));
            if mass > 0.0 && step.load > 0.0 && random.below(2) == 0 {
                let force = FRICTION * step.load * random.between(-0.65, 0.65);
                motion[2] = driven(step.speeds[2], force, mass * random.logarithmic(0.1, 10.0), &time);
            }
            let Some(found) = seen.solve(spaces, (step.load, step.spin, time), motion, &state) else { break };
            state = found;
        }
    }
    seen
}

/// Directions turn, reverse and vanish, the spin changes its sign, loads change by 30 %, the wheel stands, locks and leaves
/// the rail, in steps of a hundredth to ten half-lengths of the patch.
#[test]
fn three_thousand_random_steps_are_solved_within_the_cone_and_none_costs_twelve_times_the_mean() {
    transients(300, &HalfSpaces::sideways_on_nodes(1.0, 5, 10), 0.0).check("held", 12.0);
}

/// Six to nine linear problems a step.
#[test]
fn random_steps_are_solved_on_patches_of_every_shape_with_velocities_held_and_free() {
    for (aspect, lines, nodes) in
        [(0.5, 7, 10), (1.0, 7, 20), (2.0, 7, 20), (0.5, 9, 10), (1.0, 9, 10), (2.0, 9, 10), (1.0, 13, 10)]
    {
        let spaces = HalfSpaces::sideways_on_nodes(aspect, lines, nodes);
        transients(20, &spaces, 0.0).check(&format!("{aspect}, {lines} lines, {nodes} nodes, held"), 12.0);
        transients(20, &spaces, 500.0).check(&format!("{aspect}, {lines} lines, {nodes} nodes, free"), 12.0);
    }
}

/// Loads from a twentieth to thrice that of the start, creepages from far below to far above those of rolling.
#[test]
fn random_steady_states_are_found_from_a_wheel_that_touches() {
    for aspect in [0.5, 1.0, 2.0] {
        let (spaces, mut seen) = (HalfSpaces::sideways_on_nodes(aspect, 7, 10), Count::default());
        for seed in 0..60 {
            let mut random = Random(seed);
            let load = LOAD * random.logarithmic(0.05, 3.0);
            let mut creepage = || SATURATION * random.logarithmic(0.01, 20.0) * [-1.0, 1.0][random.below(2)];
            let (xi, eta) = (creepage(), creepage());
            let (speed, spin) = (random.logarithmic(0.1, 50.0), random.between(-3.0, 3.0));
            let mut motion = held(&spaces, [1.0 + 0.5 * xi, 1.0 - 0.5 * xi, eta].map(|part| speed * part));
            let time = TimeDerivative::default();
            for (axis, guess) in [(0, speed), (2, 0.0)] {
                if random.below(2) == 0 {
                    let force = FRICTION * load * random.between(-0.65, 0.65);
                    motion[axis] = driven(guess, force, 0.0, &time);
                }
            }
            seen.solve(&spaces, (load, spin, time), motion, &spaces.start());
        }
        seen.check(&format!("{aspect}, steady"), f64::INFINITY);
    }
}

/// Forces along and across and spin moment over friction times load, times a metre.
fn forces(spaces: &HalfSpaces, lines: &Lines) -> [f64; 3] {
    let sum = |of: &dyn Fn(&wheelrail::contact::Traction) -> f64| {
        spaces.sum(LOAD, lines, |line| of(&line.traction)) / (FRICTION * LOAD)
    };
    [sum(&|it| it.resultant.travel), sum(&|it| it.resultant.lateral), sum(&|it| it.spin_moment)]
}

/// Largest part across friction of the slip of a node, over the largest slip of all, and number of nodes that slip.
fn askew(lines: &Lines) -> (f64, usize) {
    let (mut askew, mut slips, mut most) = (0.0_f64, 0, 0.0_f64);
    for grid in lines.iter().map(|line| &line.grid) {
        let (n, nodes) = (grid.status.len(), grid.forces.len() / 2);
        for i in (0..n).filter(|&i| grid.status[i].friction_direction() != 0.0) {
            let (slip, shear) = ([grid.slip[0][i], grid.slip[1][i]], [grid.forces[nodes - n + 2 * i], grid.lateral[i]]);
            let size = shear[0].hypot(shear[1]);
            askew = askew.max((slip[0] * shear[1] - slip[1] * shear[0]).abs() / size);
            // Friction on the wheel is against its slip.
            assert!(slip[0] * shear[0] + slip[1] * shear[1] < 1e-9 * size * SPEED);
            (slips, most) = (slips + 1, most.max(slip[0].hypot(slip[1])));
        }
    }
    (askew / most, slips)
}

/// Creepage along is held, creepage across a triangle, spin a sine: each step turns the friction of all nodes that slip.
#[test]
fn friction_of_a_swaying_wheel_opposes_its_slip_after_less_than_four_linear_problems_a_step() {
    let spaces = HalfSpaces::sideways_on_nodes(1.0, 7, 10);
    let (mut seen, mut state, mut worst, mut least) = (Count::default(), spaces.start(), 0.0_f64, usize::MAX);
    for k in 0..80 {
        let phase = f64::from(k) / 40.0;
        let across = 2e-3 * (1.0 - 4.0 * (phase.rem_euclid(1.0) - 0.5).abs());
        let motion = held(&spaces, [SPEED * 1.0005, SPEED * 0.9995, SPEED * across]);
        let spin = 0.3 * (std::f64::consts::TAU * phase).sin();
        state = seen.solve(&spaces, (LOAD, spin, formula(1e-3, k == 0)), motion, &state).unwrap();
        let (askew, slips) = askew(&state);
        (worst, least) = (worst.max(askew), least.min(slips));
    }
    let problems = seen.newton as f64 / seen.steps as f64;
    println!("{problems:.2} linear problems a step, slip across friction {worst:.1e}, at least {least} nodes slip");
    assert!(worst < 1e-8 && least > 20 && problems < 3.8, "{problems} {worst:e}");
}

#[test]
fn mirror_images_have_mirrored_forces() {
    let spaces = HalfSpaces::sideways(1.5, 7);
    let run = |side: f64| {
        let mut state = spaces.start();
        for (k, slip) in [[1e-3, 2e-3, 0.3], [-2e-3, 1e-3, -0.5], [1e-4, -1e-3, 0.2]].into_iter().enumerate() {
            let [xi, eta, phi] = slip;
            let motion = held(&spaces, [1.0 + 0.5 * xi, 1.0 - 0.5 * xi, side * eta].map(|part| SPEED * part));
            let given = (LOAD, side * phi, formula(2e-4, k == 0));
            state = Count::default().solve(&spaces, given, motion, &state).unwrap();
        }
        forces(&spaces, &state)
    };
    let [right, left] = [run(1.0), run(-1.0)];
    common::round_off("sideways.mirror", &[right[0] - left[0]], 1e-12);
    common::round_off("sideways.mirror", &[right[1] + left[1]], 1e-12);
    println!("{right:?} {left:?}");
    assert!((right[0] - left[0]).abs() < 1e-9 && (right[1] + left[1]).abs() < 1e-9);
    assert!((right[2] + left[2]).abs() < 1e-9 && right[1].abs() > 0.1 && right[2].abs() > 1e-5);
}

/// Along and across a circle differ only by Poisson's ratio: C₁₁ and C₂₂ by a seventh.
#[test]
fn turning_the_creepage_on_a_circle_turns_the_force() {
    let spaces = HalfSpaces::sideways(1.0, 9);
    let size = |angle: f64| {
        let (xi, eta) = (-2e-3 * angle.cos(), -2e-3 * angle.sin());
        let motion = held(&spaces, [1.0 + 0.5 * xi, 1.0 - 0.5 * xi, eta].map(|part| SPEED * part));
        let given = (LOAD, 0.0, TimeDerivative::default());
        let found = Count::default().solve(&spaces, given, motion, &spaces.start()).unwrap();
        let [along, across, _] = forces(&spaces, &found);
        [along.hypot(across), across.atan2(along) - angle]
    };
    let all: Vec<_> = (0..=6).map(|k| size(0.25 * f64::from(k) * std::f64::consts::FRAC_PI_6)).collect();
    println!("{all:.4?}");
    assert!(all.windows(2).all(|pair| (pair[0][0] - pair[1][0]).abs() < 0.03 && pair[1][1].abs() < 0.08));
}
