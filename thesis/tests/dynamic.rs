//! The thesis's own step in time, with friction: matrix decomposition, Newton's tangent, control, order, momentum.

use wheelrail::analytic::{contact_modulus, hertz_half_width};
use wheelrail_thesis::contact::Law;
use wheelrail_thesis::dynamic::{Prescribed, Rolling};
use wheelrail_thesis::iteration::{Equations, Motions};
use wheelrail_thesis::mesh::Mesh;
use wheelrail_thesis::newton::{resultant, rolling};
use wheelrail_thesis::rail::{self, Plate};
use wheelrail_thesis::rolling::{Motion, Parameters, System};
use wheelrail_thesis::wheel::{self, Annulus};

/// Base of Paper D.
const PARAMETERS: Parameters = Parameters {
    annulus: Annulus { outer: 0.5, inner: 0.05 },
    plate: Plate { length: 1.0, height: 0.1 },
    young: 200e9,
    poisson: 0.3,
    density: 8000.0,
    load: 100e3,
    law: Law { penalty: 5e12, friction: 0.4, regularisation: 1e-3 },
};
const VELOCITY: f64 = 50.0 / 3.6;

/// Wheel and rail under a load over that of Paper D, with edges of half the half-width in the contact.
fn bodies(load: f64) -> (System, [Mesh; 2]) {
    let parameters = Parameters { load: load * PARAMETERS.load, ..PARAMETERS };
    let modulus = contact_modulus(PARAMETERS.young, PARAMETERS.poisson);
    let a = hertz_half_width(parameters.load, PARAMETERS.annulus.outer, modulus);
    let wheel = wheel::rolling(PARAMETERS.annulus, 1.5 * a, 0.5 * a, 1, PARAMETERS.poisson).unwrap();
    let rail = rail::rolling(PARAMETERS.plate, 31, 2.0 * a, 0.5 * a);
    (System::new(parameters, &wheel, &rail, 2.0 * a), [wheel, rail])
}

fn omega(creepage: f64, velocity: f64) -> f64 {
    velocity * (1.0 - 0.5 * creepage) / (1.0 + 0.5 * creepage) / PARAMETERS.annulus.outer
}

fn start<'a>(system: &'a System, [wheel, rail]: &[Mesh; 2], creepage: f64) -> Rolling<'a> {
    let motion = Motion { omega: omega(creepage, VELOCITY), velocity: VELOCITY };
    let (state, _) = rolling(system, motion).unwrap();
    Rolling::new(system, wheel, rail, state)
}

fn velocities(omega: f64, velocity: f64) -> [Prescribed; 2] {
    [Prescribed::Velocity(omega), Prescribed::Velocity(velocity)]
}

/// Contact force over the limit, traction positive.
fn utilisation(rolling: &Rolling) -> f64 {
    let [forward, up] = resultant(&rolling.touches);
    forward / (PARAMETERS.law.friction * up)
}

#[test]
fn stationary_rolling_goes_on_as_it_is_in_steps_of_any_size() {
    let (system, meshes) = bodies(1.0);
    for step in [1e-6, 1e-4, 1e-2] {
        let mut rolling = start(&system, &meshes, -3e-4);
        let (before, Motion { omega, velocity }) = (utilisation(&rolling), rolling.state.motion);
        for _ in 0..3 {
            rolling.advance(step, velocities(omega, velocity)).unwrap();
        }
        let [moment, force] = rolling.efforts;
        let [forward, _] = resultant(&rolling.touches);
        println!("{step} s: {:.1e}, moment {moment:.1}, force {force:.1}", utilisation(&rolling) - before);
        assert!((utilisation(&rolling) - before).abs() < 1e-6);
        assert!((force + forward).abs() < 1e-5 * PARAMETERS.load);
    }
}

#[test]
fn the_tangent_of_a_step_is_that_of_differences_with_moment_and_force_at_once() {
    let (system, meshes) = bodies(1.0);
    let mut rolling = start(&system, &meshes, -2e-4);
    let Motion { omega, velocity } = rolling.state.motion;
    rolling.advance(1e-4, velocities(1.0001 * omega, 1.0002 * velocity)).unwrap();
    let equations = rolling.equations(1e-4, [Prescribed::Effort(3000.0), Prescribed::Effort(-1000.0)]);
    let mut state = rolling.state.clone();
    state.motion = Motion { omega: 1.0003 * omega, velocity: 1.0001 * velocity };
    let moved = state.q[..system.size - 1].iter_mut().enumerate();
    moved.for_each(|(i, q)| *q *= 1.0 + 1e-3 * (i as f64).sin());
    assert!(equations.touches(&state).len() > 3, "{}", equations.touches(&state).len());
    let (tangent, contact) = (equations.tangent(&state), system.contact_unknowns());
    let size = system.size;
    let mut worst = 0.0_f64;
    for column in contact.into_iter().chain((0..size).step_by(97)).chain([size, size + 1]) {
        let h = if column >= size { 1e-6 } else { 1e-11 };
        let mut unit = vec![0.0; size + 2];
        unit[column] = 1.0;
        let [ahead, back] = [h, -h].map(|share| equations.residual(&equations.moved(&state, &unit, share)));
        let exact = tangent.multiply(&unit);
        let largest = exact.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
        for (i, value) in exact.iter().enumerate() {
            worst = worst.max((value - (ahead[i] - back[i]) / (2.0 * h)).abs() / largest);
        }
    }
    println!("worst difference {worst:.1e}");
    assert!(worst < 1e-6);
}

/// Prescribed velocities tell moment and force; these, prescribed at once, give back the velocities: braking and
/// traction, under a tenth and nearly twice of the load, and a wheel that is locked within eight steps and slides on.
#[test]
fn moment_and_force_at_once_give_back_the_velocities_that_need_them() {
    for (load, rate, locks) in
        [(1.0, 4e-5, false), (1.0, -4e-5, false), (0.1, 1.3e-5, false), (1.9, 5.3e-5, false), (1.0, 4e-5, true)]
    {
        let (system, meshes) = bodies(load);
        let (mut first, mut second) = (start(&system, &meshes, 0.0), start(&system, &meshes, 0.0));
        let (mut worst, mut largest) = (0.0_f64, 0.0_f64);
        for k in 1..=9 {
            let velocity = VELOCITY * (1.0 - 2e-5 * f64::from(k));
            let held = if locks { 1.0 - f64::from(k.min(8)) / 8.0 } else { 1.0 };
            let target = held * omega(rate * f64::from(k), velocity);
            first.advance(1e-3, velocities(target, velocity)).unwrap();
            second.advance(1e-3, first.efforts.map(Prescribed::Effort)).unwrap();
            let found = second.state.motion;
            largest = largest.max(utilisation(&first).abs());
            worst =
                worst.max((found.omega - target).abs() * 0.5 / VELOCITY).max((found.velocity / velocity - 1.0).abs());
        }
        println!("load {load}, {rate:e}: utilisation {:.4}, velocities off by {worst:.1e}", utilisation(&first));
        assert!(largest > 0.2 && largest < 1.001 && worst < 1e-9);
        assert!(!locks || (utilisation(&first) + 1.0).abs() < 1e-3);
    }
}

/// A wheel that is driven from rolling freely on: what its hub and its contact give it is the momentum of the rigid
/// wheel, but for what the deformation has.
#[test]
fn moment_and_force_at_once_speed_up_a_wheel_as_newton_says() {
    let (system, meshes) = bodies(1.0);
    let mut rolling = start(&system, &meshes, 0.0);
    let density = PARAMETERS.density;
    let integral = |f: fn([f64; 2]) -> f64| {
        let mesh = &meshes[0];
        let of = |t: usize| {
            let [a, b, c] = mesh.corners(t);
            let area = 0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]));
            let middle = |p: [f64; 2], q: [f64; 2]| [0.5 * (p[0] + q[0]), 0.5 * (p[1] + q[1])];
            area / 3.0 * (f(middle(a, b)) + f(middle(b, c)) + f(middle(c, a)))
        };
        density * (0..mesh.triangles.len()).map(of).sum::<f64>()
    };
    let [mass, inertia] = [integral(|_| 1.0), integral(|[x, y]| x * x + y * y)];
    let (moment, force, step) = (8000.0, 2000.0, 2e-3);
    let begin = rolling.state.motion;
    let mut impulse = [0.0; 2];
    for k in 1..=60 {
        // The moment grows within 20 steps.
        let share = (f64::from(k) / 20.0).min(1.0);
        rolling.advance(step, [Prescribed::Effort(share * moment), Prescribed::Effort(share * force)]).unwrap();
        let [forward, _] = resultant(&rolling.touches);
        impulse[0] += step * (share * moment - PARAMETERS.annulus.outer * forward);
        impulse[1] += step * (share * force + forward);
    }
    let Motion { omega, velocity } = rolling.state.motion;
    let gained = [inertia * (omega - begin.omega), mass * (velocity - begin.velocity)];
    let off = [gained[0] / impulse[0] - 1.0, gained[1] / impulse[1] - 1.0];
    println!("gained {gained:.3?}, off by {off:.5?}; utilisation {:.3}", utilisation(&rolling));
    // The deformation turns with the wheel and has its own angular momentum.
    assert!(off[0].abs() < 2e-3 && off[1].abs() < 1e-4);
    let rigid = (moment / PARAMETERS.annulus.outer + force) / (mass + inertia / PARAMETERS.annulus.outer.powi(2));
    let middle = 2e-3 * (60.0 - 9.5);
    assert!(((velocity - begin.velocity) / (rigid * middle) - 1.0).abs() < 0.02);
}

/// Backward Euler is of first order: each halving of the step halves what it changes.
#[test]
fn a_ramp_of_the_creepage_converges_with_the_order_of_backward_euler() {
    let (system, meshes) = bodies(1.0);
    let force = |steps: u32| {
        let mut rolling = start(&system, &meshes, 0.0);
        for k in 1..=steps {
            let creepage = -8e-4 * 0.5 * f64::from(k) / f64::from(steps);
            rolling.advance(0.01 / f64::from(steps), velocities(omega(creepage, VELOCITY), VELOCITY)).unwrap();
        }
        utilisation(&rolling)
    };
    let found = [10, 20, 40].map(force);
    let changes = [found[1] - found[0], found[2] - found[1]];
    let order = (changes[0] / changes[1]).log2();
    println!("{found:.5?}, changes {changes:.5?}, order {order:.3}");
    assert!((order - 1.0).abs() < 0.25);
}
