//! Random transients of lines that slip along and across, and the symmetries of their forces.

mod half_spaces;
#[path = "common/random.rs"]
mod random;

use half_spaces::{FRICTION, HalfSpaces, LOAD, Lines, SPEED, formula};
use random::Random;
use wheelrail::contact::{ContactScratch, Friction, RigidMotion, SolverState, Spin};
use wheelrail::multistep::TimeDerivative;

/// Motion of the wheel in a step.
#[derive(Clone, Copy, Debug)]
struct Step {
    /// Speeds of hub and rim and across [m/s].
    speeds: [f64; 3],
    /// Spin [1/m].
    spin: f64,
    /// Load [N]; none: the wheel is in the air.
    load: f64,
    /// Length of the step [s].
    dt: f64,
}

/// Creepage at which all slips, about \[1].
const SATURATION: f64 = 5e-3;

fn solve(spaces: &HalfSpaces, step: &Step, first: bool, start: &Lines, scratch: &mut ContactScratch) -> Option<Lines> {
    let [travel, rim, across] = step.speeds;
    let motion = [travel, rim / spaces.radius, across].map(|value| RigidMotion::held(value, 0.0));
    let spin = Spin { per_travel: step.spin, per_rotation: 0.0 };
    let laws = (formula(step.dt, first), Friction::constant(FRICTION));
    let found = spaces.solve_with(step.load, motion, spin, laws, start, scratch);
    if let Err(error) = &found {
        println!("{step:?}: {error}");
    }
    found.ok()
}

/// Largest shear of a line at its points over friction.
fn beyond(lines: &Lines) -> f64 {
    let of = |line: &wheelrail::contact::ContactState| {
        let SolverState::Series(state) = &line.solver else { panic!("not on points") };
        let (pressure, mu) = (&state.tractions.pressure, line.traction.friction.coefficient);
        let places: [f64; 12] = std::array::from_fn(|i| {
            pressure.centre + pressure.half_width * (std::f64::consts::PI * (i + 1) as f64 / 13.0).cos()
        });
        let (p, q, r) =
            (pressure.density(&places), state.tractions.shear(&places), state.tractions.lateral.density(&places));
        (0..12).map(|i| (q[i].hypot(r[i]) - mu * p[i]) / (mu * pressure.terms[0].max(1.0))).fold(0.0, f64::max)
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

/// Numbers of steps, failures and steps of Newton's method of random transients.
#[derive(Debug, Default)]
struct Count {
    steps: usize,
    failures: usize,
    newton: usize,
    most: usize,
    beyond: f64,
    least_power: f64,
}

fn transients(count: u64, lines: usize) -> Count {
    let spaces = HalfSpaces::sideways(1.0, lines);
    let mut seen = Count::default();
    for seed in 0..count {
        let (mut random, mut state) = (Random(seed), spaces.start());
        let mut step = Step { speeds: [SPEED, SPEED, 0.0], spin: 0.0, load: LOAD, dt: 1e-3 };
        for k in 0..10 {
            let mut scratch = ContactScratch::default();
            step = next(&mut random, &spaces, step);
            let Some(found) = solve(&spaces, &step, k == 0, &state, &mut scratch) else {
                seen.failures += 1;
                break;
            };
            let power = spaces.sum(step.load.max(1.0), &found, |line| line.traction.friction.power);
            (seen.steps, seen.newton) = (seen.steps + 1, seen.newton + scratch.newton_steps);
            seen.most = seen.most.max(scratch.newton_steps);
            (seen.beyond, seen.least_power) =
                (seen.beyond.max(beyond(&found)), seen.least_power.min(power / (FRICTION * LOAD * SPEED * SATURATION)));
            state = found;
        }
    }
    seen
}

/// In steps much shorter than the patch the power of friction, taken between the places where friction acts, may be less
/// than nothing.
fn check(count: u64, lines: usize) {
    let seen = transients(count, lines);
    println!("{lines} lines: {seen:?}, {:.2} a step", seen.newton as f64 / seen.steps as f64);
    assert!(seen.failures == 0 && seen.beyond < 1e-9);
}

#[test]
fn random_transients_are_solved_within_the_cone_and_cost_some_steps() {
    check(60, 5);
    check(20, 7);
}

/// Forces along and across and spin moment over friction times load, times a metre.
fn forces(spaces: &HalfSpaces, lines: &Lines) -> [f64; 3] {
    let sum = |of: &dyn Fn(&wheelrail::contact::Traction) -> f64| {
        spaces.sum(LOAD, lines, |line| of(&line.traction)) / (FRICTION * LOAD)
    };
    [sum(&|it| it.resultant.travel), sum(&|it| it.resultant.lateral), sum(&|it| it.spin_moment)]
}

#[test]
fn mirror_images_have_mirrored_forces() {
    let spaces = HalfSpaces::sideways(1.5, 7);
    let run = |side: f64| {
        let mut state = spaces.start();
        for (k, slip) in [[1e-3, 2e-3, 0.3], [-2e-3, 1e-3, -0.5], [1e-4, -1e-3, 0.2]].into_iter().enumerate() {
            let [xi, eta, phi] = slip;
            let speeds = [SPEED * (1.0 + 0.5 * xi), SPEED * (1.0 - 0.5 * xi), side * SPEED * eta];
            let step = Step { speeds, spin: side * phi, load: LOAD, dt: 2e-4 };
            state = solve(&spaces, &step, k == 0, &state, &mut ContactScratch::default()).unwrap();
        }
        forces(&spaces, &state)
    };
    let [right, left] = [run(1.0), run(-1.0)];
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
        let motion = [SPEED * (1.0 + 0.5 * xi), SPEED * (1.0 - 0.5 * xi) / spaces.radius, SPEED * eta];
        let motion = motion.map(|value| RigidMotion::held(value, 0.0));
        let laws = (TimeDerivative::default(), Friction::constant(FRICTION));
        let found = spaces.solve_sideways(LOAD, motion, Spin::default(), laws, &spaces.start()).unwrap();
        let [along, across, _] = forces(&spaces, &found);
        [along.hypot(across), across.atan2(along) - angle]
    };
    let all: Vec<_> = (0..=6).map(|k| size(0.25 * f64::from(k) * std::f64::consts::FRAC_PI_6)).collect();
    println!("{all:.4?}");
    assert!(all.windows(2).all(|pair| (pair[0][0] - pair[1][0]).abs() < 0.03 && pair[1][1].abs() < 0.08));
}
