//! Rolling contact on triangles: penalty, regularised friction, velocity stepping, one Newton iteration.

use wheelrail::analytic::{carter_force, carter_full_slip, contact_modulus, hertz_half_width};
use wheelrail_thesis::contact::{Law, Pair};
use wheelrail_thesis::iteration::Equations;
use wheelrail_thesis::mesh::Mesh;
use wheelrail_thesis::newton::{Condensed, Drive, Newton, frictionless, resultant, rolling};
use wheelrail_thesis::rail::{self, Plate};
use wheelrail_thesis::rolling::{Motion, Parameters, State, System};
use wheelrail_thesis::triangle::Order;
use wheelrail_thesis::wheel::{self, Annulus};

/// Base of Paper D, with the friction of the regularised law.
const PARAMETERS: Parameters = Parameters {
    annulus: Annulus { outer: 0.5, inner: 0.05 },
    plate: Plate { length: 1.0, height: 0.1 },
    young: 200e9,
    poisson: 0.3,
    density: 8000.0,
    load: 100e3,
    law: Law { penalty: 5e12, friction: 0.4, regularisation: 1e-4 },
};
const VELOCITY: f64 = 50.0 / 3.6;

fn half_width() -> f64 {
    hertz_half_width(PARAMETERS.load, PARAMETERS.annulus.outer, contact_modulus(PARAMETERS.young, PARAMETERS.poisson))
}

/// Wheel and rail with edges of `share` half-widths in the contact, and the wheel's mesh.
fn bodies(share: f64, law: Law) -> (System, Mesh) {
    let (a, parameters) = (half_width(), Parameters { law, ..PARAMETERS });
    let wheel = wheel::rolling(parameters.annulus, 1.5 * a, share * a, 1, parameters.poisson).unwrap();
    let rail = rail::rolling(parameters.plate, 31, 2.0 * a, share * a);
    println!("{} + {} triangles", wheel.triangles.len(), rail.triangles.len());
    (System::new(parameters, &wheel, &rail, 2.0 * a), wheel)
}

fn system(share: f64, law: Law) -> System {
    bodies(share, law).0
}

fn motion(creepage: f64) -> Motion {
    let peripheral = VELOCITY * (1.0 - 0.5 * creepage) / (1.0 + 0.5 * creepage);
    Motion { omega: peripheral / PARAMETERS.annulus.outer, velocity: VELOCITY }
}

#[test]
fn the_tangent_of_a_contact_element_is_that_of_differences() {
    let law = Law { penalty: 5e12, friction: 0.4, regularisation: 1e-2 };
    let pair =
        Pair { slave: [2e-4, 5e-8], upstream: [4e-4, 2e-7], master: [[1e-4, 0.0], [5e-4, 0.0]], centre: [0.0, 0.5] };
    let base = [2e-7, -3e-6, 3e-7, -2.5e-6, -1e-7, -1e-6, 2e-7, -1.2e-6, 27.78, 13.89];
    let forces = |x: &[f64; 10]| {
        let u = [[x[0], x[1]], [x[2], x[3]], [x[4], x[5]], [x[6], x[7]]];
        law.forces(&pair, &u, x[8], x[9]).unwrap()
    };
    let exact = forces(&base);
    for variable in 0..10 {
        let h = if variable < 8 { 1e-11 } else { 1e-6 };
        let moved = |sign: f64| {
            let mut x = base;
            x[variable] += sign * h;
            forces(&x)
        };
        let (ahead, back) = (moved(1.0), moved(-1.0));
        let largest = exact.on.iter().flatten().fold(0.0_f64, |most, f| most.max(f.slopes[variable].abs()));
        for node in 0..3 {
            for axis in 0..2 {
                let difference = (ahead.on[node][axis].value - back.on[node][axis].value) / (2.0 * h);
                let error = (exact.on[node][axis].slopes[variable] - difference).abs() / largest;
                assert!(error < 1e-6, "variable {variable}, node {node}, axis {axis}: {error:.1e}");
            }
        }
    }
    // Forces on the wheel act back on the rail.
    for axis in 0..2 {
        let sum: f64 = exact.on.iter().map(|force| force[axis].value).sum();
        assert!(sum.abs() < 1e-9 * exact.on[0][1].value);
    }
}

#[test]
fn friction_follows_the_slip_up_to_its_limit_and_open_gaps_carry_nothing() {
    let law = PARAMETERS.law;
    let pair =
        Pair { slave: [0.0, 0.0], upstream: [1e-4, 0.0], master: [[-1e-4, 0.0], [1e-4, 0.0]], centre: [0.0, 0.5] };
    let force =
        |down: f64, omega: f64| law.forces(&pair, &[[0.0, -down], [0.0, -down], [0.0; 2], [0.0; 2]], omega, VELOCITY);
    assert!(force(-1e-9, 20.0).is_none());
    for (omega, sign) in [(20.0, -1.0), (40.0, 1.0)] {
        let on = force(1e-6, omega).unwrap().on[0];
        assert!((on[1].value / (1e-6 * law.penalty) - 1.0).abs() < 1e-12);
        assert!((on[0].value / (sign * law.friction * on[1].value) - 1.0).abs() < 1e-12);
    }
}

/// Moments with an unknown angular velocity and forces with an unknown velocity of travel.
#[test]
fn the_tangent_of_the_system_is_that_of_differences_with_its_column_and_row_of_the_moment_or_force() {
    let system = system(0.5, Law { regularisation: 1e-2, ..PARAMETERS.law });
    let mut state = frictionless(&system).unwrap();
    state.motion = motion(-2e-4);
    for drive in [Drive::Moment(1000.0), Drive::Force(-1000.0)] {
        let newton = Newton { system: &system, law: system.parameters.law, drive };
        let (_, touches) = newton.residual(&state);
        assert!(touches.len() > 2);
        let tangent = newton.tangent(&state, &touches);
        let contact = system.contact_unknowns();
        // Unknowns of the contact, some others, and the velocity.
        let columns = contact.iter().copied().chain((0..system.size).step_by(97)).chain([system.size]);
        let mut worst = 0.0_f64;
        for column in columns {
            let h = if column == system.size { 1e-5 } else { 1e-10 };
            let mut unit = vec![0.0; system.size + 1];
            unit[column] = 1.0;
            let [ahead, back] = [h, -h].map(|share| newton.residual(&newton.moved(&state, &unit, share)).0);
            let exact = tangent.multiply(&unit);
            let largest = exact.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
            for (i, value) in exact.iter().enumerate() {
                let difference = (ahead[i] - back[i]) / (2.0 * h);
                worst = worst.max((value - difference).abs() / largest);
            }
        }
        println!("{drive:?}: worst difference {worst:.1e}");
        assert!(worst < 1e-6);
    }
}

#[test]
fn newton_on_the_contact_alone_takes_the_steps_of_the_assembled_one() {
    let system = system(0.5, Law { regularisation: 1e-2, ..PARAMETERS.law });
    let mut state = frictionless(&system).unwrap();
    state.motion = motion(-2e-4);
    let newton = Newton { system: &system, law: system.parameters.law, drive: Drive::Velocity };
    let condensed = Condensed::new(&system, state.motion).unwrap();
    let mut alone = state.clone();
    for iteration in 0..6 {
        let step = newton.step(&state).unwrap();
        state = newton.moved(&state, &step, 1.0);
        let next = condensed.next(&newton, &alone).unwrap();
        condensed.kept.iter().zip(next.iter()).for_each(|(i, value)| alone.q[*i] = *value);
        let largest = condensed.kept.iter().fold(0.0_f64, |most, i| most.max(state.q[*i].abs()));
        let difference = condensed.kept.iter().fold(0.0_f64, |most, i| most.max((state.q[*i] - alone.q[*i]).abs()));
        println!(
            "step {iteration}: residual {:.1e}, difference {:.1e}",
            newton.size(&newton.residual(&state).0),
            difference / largest
        );
        assert!(difference < 1e-9 * largest);
    }
}

#[test]
fn frictionless_contact_carries_the_load_over_the_width_of_hertz() {
    for (share, tolerance) in [(0.4, 0.05), (0.2, 0.02)] {
        let (system, wheel) = bodies(share, PARAMETERS.law);
        let state = frictionless(&system).unwrap();
        let newton = Newton { system: &system, law: Law { friction: 0.0, ..PARAMETERS.law }, drive: Drive::Velocity };
        let (_, touches) = newton.residual(&state);
        let [forward, up] = resultant(&touches);
        assert!((up / PARAMETERS.load - 1.0).abs() < 1e-8 && forward.abs() < 1e-3 * up);
        // The square of a Hertzian half-width is four times the variance of the pressure.
        let moment = |power: i32| {
            let terms = touches.iter().map(|t| t.forces.on[0][1].value * wheel.nodes[t.nodes[0]][0].powi(power));
            terms.sum::<f64>() / up
        };
        let (centre, width) = (moment(1), 2.0 * (moment(2) - moment(1).powi(2)).sqrt());
        println!(
            "{} nodes, half-width {:.4}, centre {:.4} of Hertz",
            touches.len(),
            width / half_width(),
            centre / half_width()
        );
        assert!((width / half_width() - 1.0).abs() < tolerance && centre.abs() < tolerance * half_width());
    }
}

/// Utilisation of the limit, traction positive, and the Newton steps it took.
fn utilisation(system: &System, creepage: f64) -> (State, f64, usize) {
    let (state, steps) = rolling(system, motion(creepage)).unwrap();
    let newton = Newton { system, law: system.parameters.law, drive: Drive::Velocity };
    let [forward, up] = resultant(&newton.residual(&state).1);
    (state, forward / (0.4 * up), steps)
}

/// The mean of traction and braking leaves out the bias of an uneven mesh, which is of first order in its edges.
#[test]
fn velocity_stepping_reaches_rolling_near_carter_and_a_wider_regularisation_softens_it() {
    let full = carter_full_slip(0.4, half_width(), PARAMETERS.annulus.outer);
    let mut before = f64::INFINITY;
    for regularisation in [1e-4, 1e-3, 1e-2] {
        let system = system(0.2, Law { regularisation, ..PARAMETERS.law });
        let [traction, braking] = [-1.9e-4, 1.9e-4].map(|creepage| utilisation(&system, creepage));
        let mean = 0.5 * (traction.1 - braking.1);
        let exact = carter_force(-1.9e-4, full);
        println!(
            "{regularisation:e} m/s: {:.4} in {} steps, {:.4} in {}, mean {mean:.4}, Carter {exact:.4}",
            traction.1, traction.2, braking.1, braking.2
        );
        assert!(mean < before);
        assert!(regularisation > 1e-4 || (mean - exact).abs() < 0.02);
        before = mean;
    }
    let (_, sliding, _) = utilisation(&system(0.4, PARAMETERS.law), -8e-4);
    println!("beyond full slip {sliding:.4}");
    assert!((sliding - 1.0).abs() < 1e-3);
}

#[test]
fn a_prescribed_moment_gives_back_the_creepage_that_needs_it() {
    let system = system(0.5, Law { regularisation: 1e-3, ..PARAMETERS.law });
    let (state, _, _) = utilisation(&system, -3e-4);
    let free = Newton { system: &system, law: system.parameters.law, drive: Drive::Moment(0.0) };
    let moment = *free.residual(&state).0.last().unwrap();
    let newton = Newton { drive: Drive::Moment(moment), ..free };
    let mut start = state.clone();
    start.motion.omega = motion(-2.8e-4).omega;
    let (found, steps) = newton.solve(&start).unwrap();
    let error = found.motion.omega / state.motion.omega - 1.0;
    println!("moment {moment:.1} N, angular velocity off by {error:.1e} after {steps} steps");
    assert!(error.abs() < 1e-8);
}

/// Prescribed by a run under prescribed velocities: the force on the hub that it finds, and from there the velocity
/// that the force finds.
#[test]
fn a_prescribed_force_gives_back_the_velocity_that_needs_it_and_that_velocity_the_force() {
    for (load, creepage, mistaken) in
        [(1.0, -3e-4, -2.8e-4), (1.0, 3e-4, 2.8e-4), (0.1, -8e-5, -7e-5), (1.9, -3e-4, -2.8e-4)]
    {
        let parameters = Parameters {
            load: load * PARAMETERS.load,
            law: Law { regularisation: 1e-3, ..PARAMETERS.law },
            ..PARAMETERS
        };
        let a = half_width() * load.sqrt();
        let wheel = wheel::rolling(parameters.annulus, 1.5 * a, 0.5 * a, 1, parameters.poisson).unwrap();
        let rail = rail::rolling(parameters.plate, 31, 2.0 * a, 0.5 * a);
        let system = System::new(parameters, &wheel, &rail, 2.0 * a);
        let (state, _) = rolling(&system, motion(creepage)).unwrap();
        let free = Newton { system: &system, law: parameters.law, drive: Drive::Force(0.0) };
        let (residual, touches) = free.residual(&state);
        let force = *residual.last().unwrap();
        // The hub is pushed against what the contact does to the wheel; momentum that streams through the rail is its
        // own affair.
        let [forward, _] = resultant(&touches);
        assert!((force + forward).abs() < 1e-6 * parameters.load, "{force} {forward}");
        let mut start = state.clone();
        start.motion.velocity *= motion(mistaken).omega / motion(creepage).omega;
        let newton = Newton { drive: Drive::Force(force), ..free };
        let (found, steps) = newton.solve(&start).unwrap();
        let error = found.motion.velocity / VELOCITY - 1.0;
        let held = Newton { drive: Drive::Velocity, ..newton };
        let (again, _) = held.solve(&State { q: start.q.clone(), motion: found.motion }).unwrap();
        let back = -resultant(&held.residual(&again).1)[0] / force - 1.0;
        println!(
            "load {load}, creepage {creepage:e}: force {force:.1} N/m, velocity off by {error:.1e} after {steps} steps, force by {back:.1e}"
        );
        assert!(error.abs() < 1e-8 && back.abs() < 1e-6);
    }
}

#[test]
fn a_force_beyond_friction_finds_no_velocity_and_is_refused() {
    let system = system(0.5, Law { regularisation: 1e-3, ..PARAMETERS.law });
    let (state, _, _) = utilisation(&system, -3e-4);
    let newton =
        Newton { system: &system, law: system.parameters.law, drive: Drive::Force(-1.1 * 0.4 * PARAMETERS.load) };
    let outcome = newton.solve(&state).map(|(found, _)| found.motion.velocity);
    println!("{outcome:?}");
    assert!(outcome.is_err());
}

/// Hub's way down \[m] under the load at rest, and unknowns, with so many refinements of the whole wheel and the same
/// edges in the contact.
fn approach(order: Order, share: f64, global: usize) -> (f64, usize) {
    let a = half_width();
    let wheel = wheel::rolling(PARAMETERS.annulus, 1.5 * a, share * a, global, PARAMETERS.poisson).unwrap();
    let rail = rail::rolling(PARAMETERS.plate, 31, 2.0 * a, share * a);
    let system = System::with_order(PARAMETERS, &wheel, &rail, 2.0 * a, order);
    (-frictionless(&system).unwrap().q[system.size - 1], system.size)
}

/// Away from the contact quadratic triangles need no refinement. In it, where both touch at corners only, they are
/// softer, and less so on shorter edges.
#[test]
fn a_quadratic_wheel_is_right_on_a_coarse_mesh_but_for_its_contact() {
    let way = |order, share, global| approach(order, share, global).0;
    let [linear, quadratic] =
        [Order::Linear, Order::Quadratic].map(|order| way(order, 0.4, 3) / way(order, 0.4, 0) - 1.0);
    let off = [0.4, 0.2].map(|share| way(Order::Quadratic, share, 0) / way(Order::Linear, share, 3) - 1.0);
    println!("three refinements of the whole wheel change linear {linear:+.4}, quadratic {quadratic:+.4}");
    println!("a coarse quadratic wheel over a fine linear one, edges of 0.4 and 0.2 half-widths: {off:+.4?}");
    assert!(linear > 0.04 && quadratic.abs() < 0.01);
    assert!(off[0] > off[1] && off[1] > 0.0 && off[0] < 0.02);
}

/// Wheels with about as many unknowns: neither is nearer to what both approach.
#[test]
fn a_quadratic_wheel_rolls_like_a_linear_one_with_as_many_unknowns() {
    let (a, parameters) =
        (half_width(), Parameters { law: Law { regularisation: 1e-3, ..PARAMETERS.law }, ..PARAMETERS });
    let [linear, quadratic] = [(Order::Linear, 0.2), (Order::Quadratic, 0.4)].map(|(order, share)| {
        let wheel = wheel::rolling(parameters.annulus, 1.5 * a, share * a, 1, parameters.poisson).unwrap();
        let rail = rail::rolling(parameters.plate, 31, 2.0 * a, share * a);
        let system = System::with_order(parameters, &wheel, &rail, 2.0 * a, order);
        let [traction, braking] = [-1.9e-4, 1.9e-4].map(|creepage| utilisation(&system, creepage).1);
        println!("{order:?}, {} unknowns: traction {traction:.4}, braking {braking:.4}", system.size);
        0.5 * (traction - braking)
    });
    println!("mean of both signs: linear {linear:.4}, quadratic {quadratic:.4}");
    assert!((linear - quadratic).abs() < 0.01);
}

/// Force that the meshes of wheel and rail add. It is the same on mirrored meshes.
#[test]
fn the_force_without_creepage_fades_with_the_edges_in_the_contact() {
    let a = half_width();
    let law = Law { regularisation: 1e-3, ..PARAMETERS.law };
    let bias = [0.4, 0.2, 0.1].map(|share| {
        let wheel = wheel::rolling(PARAMETERS.annulus, 1.5 * a, share * a, 1, PARAMETERS.poisson).unwrap();
        let rail = rail::rolling(PARAMETERS.plate, 61, 2.0 * a, share * a);
        utilisation(&System::new(Parameters { law, ..PARAMETERS }, &wheel, &rail, 2.0 * a), 0.0).1
    });
    println!("over the limit, edges of 0.4, 0.2 and 0.1 a: {bias:+.4?}");
    assert!(bias.windows(2).all(|pair| pair[1] > 0.0 && pair[1] < 0.6 * pair[0]) && bias[2] < 0.02);
}
