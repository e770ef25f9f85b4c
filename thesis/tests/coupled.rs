//! Displacements and temperatures in one iteration: thermal expansion, tangent, agreement with motion and heat one
//! after the other, balances.

use wheelrail::analytic::annulus_growth;
use wheelrail_thesis::contact::Law;
use wheelrail_thesis::coupled::{Coupled, Expansion, Warm, advance};
use wheelrail_thesis::dynamic::{Prescribed, Rolling};
use wheelrail_thesis::elastic;
use wheelrail_thesis::heat::{Heating, spots};
use wheelrail_thesis::iteration::{Equations, Motions, iterate};
use wheelrail_thesis::mesh::Mesh;
use wheelrail_thesis::newton::{self, Drive, Newton, resultant};
use wheelrail_thesis::rail::{self, Plate};
use wheelrail_thesis::rolling::{Motion, Parameters, State, System};
use wheelrail_thesis::stabilise::Scheme;
use wheelrail_thesis::triangle::{Order, Space};
use wheelrail_thesis::warming::Warming;
use wheelrail_thesis::wheel::{self, Annulus};

/// Base of Paper D, with a wider law of friction.
const PARAMETERS: Parameters = Parameters {
    annulus: Annulus { outer: 0.5, inner: 0.05 },
    plate: Plate { length: 1.0, height: 0.1 },
    young: 200e9,
    poisson: 0.3,
    density: 8000.0,
    load: 100e3,
    law: Law { penalty: 5e12, friction: 0.4, regularisation: 1e-3 },
};
/// Linear expansion in the presets of the papers [1/K]; steel has 1.2e-5.
const EXPANSION: f64 = 4.8e-6;
const VELOCITY: f64 = 50.0 / 3.6;
const LINEAR: (Order, Scheme) = (Order::Linear, Scheme::Supg);
const QUADRATIC: (Order, Scheme) = (Order::Quadratic, Scheme::Bubble);

/// Wheel and rail with edges of half the half-width in the contact.
fn bodies(order: Order) -> (System, [Mesh; 2]) {
    bodies_under(PARAMETERS, order)
}

fn bodies_under(parameters: Parameters, order: Order) -> (System, [Mesh; 2]) {
    let half = 1.2e-3 * (parameters.load / PARAMETERS.load).sqrt();
    let wheel = wheel::rolling(PARAMETERS.annulus, 1.5 * half, 0.5 * half, 1, PARAMETERS.poisson).unwrap();
    let rail = rail::rolling(PARAMETERS.plate, 31, 2.0 * half, 0.5 * half);
    (System::with_order(parameters, &wheel, &rail, 2.0 * half, order), [wheel, rail])
}

/// Motion with a creepage, braking positive.
fn motion(creepage: f64) -> Motion {
    let share = (1.0 - 0.5 * creepage) / (1.0 + 0.5 * creepage);
    Motion { omega: VELOCITY * share / PARAMETERS.annulus.outer, velocity: VELOCITY }
}

/// Heat of these bodies, cold at the start; with heated arcs, so that the wheel becomes warm.
fn warming<'a>([wheel, rail]: &'a [Mesh; 2], of: (Order, Scheme), Motion { omega, velocity }: Motion) -> Warming<'a> {
    let heating = Heating {
        meshes: [wheel, rail],
        annulus: PARAMETERS.annulus,
        wheel: of,
        material: [8000.0 * 460.0, 45.0],
        motion: [omega, velocity],
        spots: &[],
        contact: [1e7, 0.1],
        arcs: 3000.0,
        cold_hub: true,
    };
    let mut warming = Warming::new(heating, 0.05, None);
    warming.renew([omega, velocity]);
    warming
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most, value| most.max(value.abs()))
}

/// Largest difference over the largest value.
fn apart(a: &[f64], b: &[f64]) -> f64 {
    let off: Vec<f64> = a.iter().zip(b).map(|(a, b)| a - b).collect();
    largest(&off) / largest(b)
}

/// Growth of the tread \[m] of a ring on a rigid hub over the mean temperature \[K], by the closed form of the product.
fn growth(mean: f64) -> f64 {
    let Parameters { annulus: Annulus { outer, inner }, poisson, .. } = PARAMETERS;
    annulus_growth(mean, EXPANSION * (1.0 + poisson) / (1.0 - poisson), poisson, outer, inner)
}

/// An annulus of one temperature, held on its rigid hub, in plane strain.
#[test]
fn a_warm_wheel_grows_as_the_closed_form_of_a_ring_on_a_rigid_hub() {
    let Parameters { annulus: Annulus { outer, inner }, young, poisson, .. } = PARAMETERS;
    let (warm, exact) = (100.0, growth(100.0));
    for order in [Order::Linear, Order::Quadratic] {
        let off = [1, 2].map(|n| {
            let radii: Vec<f64> =
                (0..=8 * n).map(|k| inner * (outer / inner).powf(k as f64 / (8 * n) as f64)).collect();
            let mesh = wheel::coarse(&radii, 24 * n);
            let space = Space::new(&mesh, order);
            let mut matrix = elastic::stiffness(&space, young, poisson);
            let thermal = elastic::expansion(&space, [young, poisson, EXPANSION]);
            let mut load = thermal.multiply(&vec![warm; 2 * space.places.len()]);
            let total = [0, 1].map(|axis| load.iter().skip(axis).step_by(2).sum::<f64>());
            assert!(largest(&total) < 1e-9 * largest(&load), "thermal stress has no resultant");
            let held = |node: &usize| space.places[*node][0].hypot(space.places[*node][1]) < 1.01 * inner;
            let fixed: Vec<usize> =
                (0..space.places.len()).filter(held).flat_map(|node| [2 * node, 2 * node + 1]).collect();
            matrix.fix(&fixed);
            fixed.iter().for_each(|row| load[*row] = 0.0);
            let u = matrix.factorise().unwrap().solve(load).unwrap();
            let bottom = (0..space.places.len()).find(|n| (space.places[*n][1] + outer).abs() < 1e-12).unwrap();
            -u[2 * bottom + 1] / exact - 1.0
        });
        println!("{order:?}: {exact:.4e} m, off by {off:.8?}");
        assert!(off[1].abs() < 1e-4 && off[1].abs() < 0.5 * off[0].abs());
    }
}

/// Largest difference of the tangent from differences where every unknown is away from its solution: of each block of
/// forces, efforts of the hub and heat by displacements, velocities and temperatures, over its largest entry.
fn tangent_error<M: Motions>(coupled: &Coupled<M>, at: &Warm) -> f64 {
    let system = coupled.motions.system();
    let first = system.size + coupled.motions.found().len();
    let mut warm = at.clone();
    let moved = warm.state.q[..system.size - 1].iter_mut().enumerate();
    moved.for_each(|(i, q)| *q *= 1.0 + 1e-3 * (i as f64).sin());
    warm.theta.iter_mut().enumerate().for_each(|(i, theta)| *theta += 0.1 * (0.7 * i as f64).sin());
    let touching =
        coupled.motions.touches(&warm.state).iter().flat_map(|t| t.nodes).map(|n| first + n).collect::<Vec<_>>();
    assert!(touching.len() > 8);
    let tangent = coupled.tangent(&warm);
    let near_hub = |node: &usize| system.places[*node][0].hypot(system.places[*node][1] - 0.5) < 0.1;
    let hub = (0..system.wheel_nodes)
        .filter(near_hub)
        .step_by(7)
        .flat_map(|node| [system.unknown[2 * node], Some(first + node)]);
    let some = (0..tangent.size).step_by(263).chain(system.size..first).chain(hub.flatten());
    let kind = |i: usize| usize::from(i >= system.size) + usize::from(i >= first);
    let (mut entry, mut off) = ([[0.0_f64; 3]; 3], [[0.0_f64; 3]; 3]);
    for column in system.contact_unknowns().into_iter().step_by(7).chain(touching).chain(some) {
        let h = [1e-11, 1e-6, 1e-3][kind(column)];
        let mut unit = vec![0.0; tangent.size];
        unit[column] = 1.0;
        let [ahead, back] = [h, -h].map(|share| coupled.residual(&coupled.moved(&warm, &unit, share)));
        for (i, exact) in tangent.multiply(&unit).into_iter().enumerate() {
            let (entry, off) = (&mut entry[kind(i)][kind(column)], &mut off[kind(i)][kind(column)]);
            let difference = (ahead[i] - back[i]) / (2.0 * h);
            *entry = entry.max(exact.abs()).max(difference.abs());
            *off = off.max((exact - difference).abs());
        }
    }
    // Without unknown velocities there are no efforts; in stationary rolling they do not depend on the velocities but
    // by the contact.
    let exists = |i: usize, j: usize| match (i, j) {
        (1, 1) => coupled.rate > 0.0,
        _ => (i != 1 && j != 1) || !coupled.motions.found().is_empty(),
    };
    let blocks = (0..9).map(|block| (block / 3, block % 3)).filter(|(i, j)| exists(*i, *j));
    blocks.fold(0.0, |worst: f64, (i, j)| {
        assert!(entry[i][j] > 1.0 && off[i][j].is_finite(), "block {i}, {j}: {:e}", entry[i][j]);
        worst.max(off[i][j] / entry[i][j])
    })
}

#[test]
fn the_tangent_is_that_of_differences_stationary_and_in_time() {
    for of in [LINEAR, QUADRATIC] {
        let (system, meshes) = bodies(of.0);
        let given = motion(-3e-4);
        let (state, _) = newton::rolling(&system, given).unwrap();
        let warming = warming(&meshes, of, given);
        let expansion = Expansion::new(&system, &warming, EXPANSION);
        let at = Warm { state, theta: vec![1.0; system.places.len()] };
        let law = PARAMETERS.law;
        for drive in [Drive::Velocity, Drive::Moment(3000.0), Drive::Force(-5000.0)] {
            let motions = Newton { system: &system, law, drive };
            let error = tangent_error(&Coupled { motions, warming: &warming, expansion: &expansion, rate: 0.0 }, &at);
            println!("{of:?}, {drive:?}: {error:.1e}");
            assert!(error < 1e-6);
        }
        let rolling = Rolling::new(&system, &meshes[0], &meshes[1], at.state.clone());
        let motions = rolling.equations(1e-3, [Prescribed::Effort(3000.0), Prescribed::Effort(-1000.0)]);
        let error = tangent_error(&Coupled { motions, warming: &warming, expansion: &expansion, rate: 1e3 }, &at);
        println!("{of:?}, in time: {error:.1e}");
        assert!(error < 1e-6);
    }
}

/// Motion under given thermal forces, for iterations that take motion and heat in turn.
struct Held<'a> {
    newton: Newton<'a>,
    thermal: Vec<f64>,
}

impl Equations for Held<'_> {
    type State = State;

    fn residual(&self, state: &State) -> Vec<f64> {
        let mut residual = Equations::residual(&self.newton, state);
        residual.iter_mut().zip(&self.thermal).for_each(|(residual, force)| *residual -= force);
        residual
    }

    fn step(&self, state: &State) -> Result<Vec<f64>, wheelrail_thesis::Error> {
        let lacking = self.residual(state).iter().map(|value| -value).collect();
        Motions::tangent(&self.newton, state).factorise()?.solve(lacking)
    }

    fn size(&self, residual: &[f64]) -> f64 {
        Equations::size(&self.newton, residual)
    }

    fn moved(&self, state: &State, step: &[f64], share: f64) -> State {
        Equations::moved(&self.newton, state, step, share)
    }
}

/// One iteration for all ends where motion and heat, computed in turn until nothing changes, end; without expansion the
/// second turn changes nothing.
#[test]
fn one_iteration_ends_where_motion_and_heat_in_turn_end() {
    for (of, expansion) in [(LINEAR, 0.0), (QUADRATIC, 0.0), (LINEAR, EXPANSION), (QUADRATIC, EXPANSION)] {
        let (system, meshes) = bodies(of.0);
        let given = motion(-3e-4);
        let (start, _) = newton::rolling(&system, given).unwrap();
        let warming = warming(&meshes, of, given);
        let forces = Expansion::new(&system, &warming, expansion);
        let newton = || Newton { system: &system, law: PARAMETERS.law, drive: Drive::Velocity };
        let (mut in_turn, mut turns) = (Warm { state: start.clone(), theta: vec![0.0; system.places.len()] }, 0);
        loop {
            let mut thermal = forces.forces(&in_turn.theta);
            thermal.truncate(system.size);
            let (state, _) = iterate(&Held { newton: newton(), thermal }, &in_turn.state).unwrap();
            let spots = spots(&system, &state);
            let theta = Heating { spots: &spots, ..warming.heating }.solve().unwrap().theta;
            let change = apart(&in_turn.theta, &theta);
            in_turn = Warm { state, theta };
            turns += 1;
            assert!(turns < 60);
            if change < 1e-11 {
                break;
            }
        }
        let coupled = Coupled { motions: newton(), warming: &warming, expansion: &forces, rate: 0.0 };
        let cold = Warm { state: start.clone(), theta: vec![0.0; system.places.len()] };
        let (warm, steps) = iterate(&coupled, &cold).unwrap();
        let off = [apart(&warm.state.q, &in_turn.state.q), apart(&warm.theta, &in_turn.theta)];
        let moved = apart(&warm.state.q, &start.q);
        let balance = coupled.flows(&warm).imbalance();
        println!(
            "{of:?}, {expansion}: {steps} steps, {turns} turns, off by {off:.12?}, heat {balance:.1e}, moved by {moved:.1e}"
        );
        assert!(largest(&off) < 1e-8 && balance < 1e-8);
        assert_eq!(expansion > 0.0, moved > 1e-4);
        assert_eq!(expansion > 0.0, turns > 2);
    }
}

/// Under a tenth and nearly twice of the load, in braking, sliding and a hundred times as warm the iteration ends, heat
/// balances, the contact carries the load, and a step in time from there on changes nothing.
#[test]
fn light_heavy_braked_sliding_and_hot_wheels_end_in_balance_and_stay_there() {
    let cases = [(0.1, -2e-4, 3e3), (1.9, -2e-4, 3e3), (1.0, 2e-4, 3e3), (1.0, 0.1, 3e3), (1.0, -2e-4, 3e5)];
    for (load, creepage, arcs) in cases {
        let parameters = Parameters { load: load * PARAMETERS.load, ..PARAMETERS };
        let (system, meshes) = bodies_under(parameters, Order::Linear);
        let given = motion(creepage);
        let (start, _) = newton::rolling(&system, given).unwrap();
        let mut heat = warming(&meshes, LINEAR, given);
        heat.heating.arcs = arcs;
        let forces = Expansion::new(&system, &heat, EXPANSION);
        let motions = Newton { system: &system, law: PARAMETERS.law, drive: Drive::Velocity };
        let coupled = Coupled { motions, warming: &heat, expansion: &forces, rate: 0.0 };
        let (warm, steps) = iterate(&coupled, &Warm { state: start, theta: vec![0.0; system.places.len()] }).unwrap();
        let [forward, up] = resultant(&coupled.motions.touches(&warm.state));
        let balance = coupled.flows(&warm).imbalance();
        heat.theta = warm.theta.clone();
        let mut rolling = Rolling::new(&system, &meshes[0], &meshes[1], warm.state.clone());
        let velocities = [given.omega, given.velocity].map(Prescribed::Velocity);
        let (_, flows) = advance(&mut rolling, &mut heat, &forces, 1e-4, velocities).unwrap();
        let moved = [apart(&rolling.state.q, &warm.state.q), apart(&heat.theta, &warm.theta)];
        println!(
            "load {load}, {creepage}, {arcs} W/m: {steps} steps, {:.4} of the limit, hottest {:.2} K, heat {balance:.1e} and {:.1e}, moved {moved:.1?}",
            forward / (0.4 * parameters.load),
            largest(&warm.theta),
            flows.imbalance()
        );
        assert!((up / parameters.load - 1.0).abs() < 1e-8 && balance < 1e-8 && flows.imbalance() < 1e-8);
        assert!(largest(&moved) < 1e-8);
        assert!(creepage < 0.1 || (forward / (0.4 * parameters.load) + 1.0).abs() < 1e-3, "it slides");
        assert!(arcs < 3e5 || largest(&warm.theta) > 40.0, "it is hot");
    }
}

/// A wheel that is locked within eight steps slides on at the limit. Its heat balances in every step, and what it has
/// grown where it slides lifts the hub.
#[test]
fn a_wheel_that_locks_slides_on_in_balance_and_its_warm_contact_lifts_the_hub() {
    let (system, meshes) = bodies(Order::Linear);
    let given = motion(0.0);
    let (start, _) = newton::rolling(&system, given).unwrap();
    let run = |expansion: f64| {
        let mut heat = warming(&meshes, LINEAR, given);
        heat.heating.arcs = 0.0;
        let forces = Expansion::new(&system, &heat, expansion);
        let mut rolling = Rolling::new(&system, &meshes[0], &meshes[1], start.clone());
        let (mut worst, mut steps) = (0.0_f64, 0);
        for k in 1..=14 {
            let held = 1.0 - f64::from(k.min(8)) / 8.0;
            let velocities = [held * given.omega, given.velocity].map(Prescribed::Velocity);
            let (taken, flows) = advance(&mut rolling, &mut heat, &forces, 1e-3, velocities).unwrap();
            worst = worst.max(flows.imbalance());
            steps += taken;
        }
        let [forward, up] = resultant(&rolling.touches);
        let [hub, hottest] = [rolling.state.q[system.size - 1], largest(&heat.theta)];
        println!(
            "expansion {expansion:.1e}: {steps} steps, heat {worst:.1e}, {:.4} of the limit, {:.4} of the load, hottest {hottest:.1} K, hub {hub:.4e} m, {} nodes",
            forward / (0.4 * up),
            up / PARAMETERS.load,
            rolling.touches.len()
        );
        assert!(hottest > 1.0);
        (worst, forward / (0.4 * up), hub)
    };
    let (cold, warm) = (run(0.0), run(EXPANSION));
    assert!(cold.0.max(warm.0) < 1e-8);
    assert!((cold.1 + 1.0).abs() < 1e-3 && (warm.1 + 1.0).abs() < 1e-3);
    assert!(warm.2 > cold.2);
}

/// Moments and forces on the hub, with the forces of thermal stress on it, give back the velocities that need them, and
/// the temperatures with them.
#[test]
fn moment_and_force_give_back_velocities_and_temperatures() {
    let (system, meshes) = bodies(Order::Linear);
    let given = motion(-2e-4);
    let (start, _) = newton::rolling(&system, given).unwrap();
    let held = warming(&meshes, LINEAR, given);
    let forces = Expansion::new(&system, &held, EXPANSION);
    let cold = Warm { state: start.clone(), theta: vec![0.0; system.places.len()] };
    let law = PARAMETERS.law;
    let with = |drive: Drive| Newton { system: &system, law, drive };
    let equations = |drive: Drive| Coupled { motions: with(drive), warming: &held, expansion: &forces, rate: 0.0 };
    let (exact, _) = iterate(&equations(Drive::Velocity), &cold).unwrap();
    for (drive, axis) in [(Drive::Moment(0.0), 0), (Drive::Force(0.0), 1)] {
        let needed = *equations(drive).residual(&exact).get(system.size).unwrap();
        let drive = if axis == 0 { Drive::Moment(needed) } else { Drive::Force(needed) };
        let mut guess = exact.clone();
        guess.state.motion.omega *= if axis == 0 { 1.0 + 1e-5 } else { 1.0 };
        guess.state.motion.velocity *= if axis == 1 { 1.0 + 1e-5 } else { 1.0 };
        let (found, steps) = iterate(&equations(drive), &guess).unwrap();
        let Motion { omega, velocity } = found.state.motion;
        let off = [omega / given.omega - 1.0, velocity / given.velocity - 1.0, apart(&found.theta, &exact.theta)];
        println!("{drive:?}: {steps} steps, off by {off:.8?}");
        assert!(largest(&off) < 1e-8);
    }
    // In time, with both at once, from a cold wheel on.
    let [wheel, rail] = &meshes;
    let (mut first, mut second) =
        (Rolling::new(&system, wheel, rail, start.clone()), Rolling::new(&system, wheel, rail, start));
    let (mut heat, mut again) = (warming(&meshes, LINEAR, given), warming(&meshes, LINEAR, given));
    let mut worst = 0.0_f64;
    for k in 1..=6 {
        let Motion { omega, velocity } = motion(-2e-4 - 2e-5 * f64::from(k));
        let velocities = [omega, velocity].map(Prescribed::Velocity);
        advance(&mut first, &mut heat, &forces, 1e-3, velocities).unwrap();
        advance(&mut second, &mut again, &forces, 1e-3, first.efforts.map(Prescribed::Effort)).unwrap();
        let found = second.state.motion;
        worst = worst.max((found.omega / omega - 1.0).abs()).max((found.velocity / velocity - 1.0).abs());
        worst = worst.max(apart(&again.theta, &heat.theta));
    }
    println!("in time: off by {worst:.1e}");
    assert!(worst < 1e-8);
}

/// In steps from ten microseconds to three years all heat is stored or leaves; in the end the contact carries the load.
#[test]
fn heat_balances_in_every_step_and_long_steps_end_in_stationary_rolling() {
    let (system, meshes) = bodies(Order::Linear);
    let given = motion(-2e-4);
    let (start, _) = newton::rolling(&system, given).unwrap();
    let mut heat = warming(&meshes, LINEAR, given);
    let forces = Expansion::new(&system, &heat, EXPANSION);
    let cold = Warm { state: start.clone(), theta: vec![0.0; system.places.len()] };
    let motions = Newton { system: &system, law: PARAMETERS.law, drive: Drive::Velocity };
    let coupled = Coupled { motions, warming: &heat, expansion: &forces, rate: 0.0 };
    let (still, _) = iterate(&coupled, &cold).unwrap();
    let mut rolling = Rolling::new(&system, &meshes[0], &meshes[1], start);
    let velocities = [given.omega, given.velocity].map(Prescribed::Velocity);
    let mut worst = 0.0_f64;
    for step in [1e-5, 1e-3, 1.0, 60.0, 3600.0, 1e6, 1e6, 1e8] {
        let (_, flows) = advance(&mut rolling, &mut heat, &forces, step, velocities).unwrap();
        worst = worst.max(flows.imbalance());
    }
    let [_, up] = resultant(&rolling.touches);
    let off = [apart(&rolling.state.q, &still.state.q), apart(&heat.theta, &still.theta), up / PARAMETERS.load - 1.0];
    println!("heat {worst:.1e}, off by {off:.8?}, mean {:.3} K", heat.means()[0]);
    assert!(worst < 1e-8 && largest(&off) < 1e-6);
}

/// The whole model with heated arcs: the hub rises by what a ring of the same mean temperature grows, the closed form
/// of the product for its bulk, although the heat lies in the tread and arrives in two arcs. An evenly warm wheel then
/// rolls on its larger radius, with the creep force that a cold one has at a creepage larger by growth over radius.
#[test]
fn the_hub_rises_by_the_growth_of_a_ring_of_the_mean_temperature_and_the_wheel_rolls_on_the_larger_radius() {
    let (system, meshes) = bodies(Order::Quadratic);
    let creepage = -2e-4;
    let given = motion(creepage);
    let (start, _) = newton::rolling(&system, given).unwrap();
    let newton = || Newton { system: &system, law: PARAMETERS.law, drive: Drive::Velocity };
    let share = |state: &State| resultant(&Motions::touches(&newton(), state))[0] / (0.4 * PARAMETERS.load);
    for arcs in [300.0, 3000.0] {
        let mut heat = warming(&meshes, QUADRATIC, given);
        heat.heating.arcs = arcs;
        let forces = Expansion::new(&system, &heat, EXPANSION);
        let cold = Warm { state: start.clone(), theta: vec![0.0; system.places.len()] };
        let coupled = Coupled { motions: newton(), warming: &heat, expansion: &forces, rate: 0.0 };
        let (warm, _) = iterate(&coupled, &cold).unwrap();
        let rise = warm.state.q[system.size - 1] - start.q[system.size - 1];
        heat.theta = warm.theta;
        let mean = heat.means()[0];
        let grown = growth(mean);
        let mut even = vec![0.0; system.places.len()];
        even[..system.wheel_nodes].fill(mean);
        let mut thermal = forces.forces(&even);
        thermal.truncate(system.size);
        let (evenly, _) = iterate(&Held { newton: newton(), thermal }, &start).unwrap();
        let (larger, _) = newton::rolling(&system, motion(creepage - grown / PARAMETERS.annulus.outer)).unwrap();
        let [none, real, evenly, larger] = [&start, &warm.state, &evenly, &larger].map(share);
        println!("{arcs} W/m: mean {mean:.3} K, hub rises by {:.6} of the growth", rise / grown);
        println!(
            "share of the limit: cold {none:.5}, warm {real:.5}, evenly warm {evenly:.5}, cold on the larger radius {larger:.5}"
        );
        assert!((rise / grown - 1.0).abs() < 1e-4);
        assert!((evenly - larger).abs() < 0.01 * (larger - none));
        // The layer that the contact heats slides a little more still: on these coarse meshes by a fifth of the
        // growth's part.
        assert!(real > evenly && real - evenly < 0.3 * (evenly - none));
    }
}

/// A locked wheel that slides in a stationary state. A node at the edge of its contact exchanges heat at full
/// conductance as soon as it touches: it cools, shrinks and opens; open, it is warm, grows and touches. Newton's
/// iteration finds a state for expansions that leave it closed and for those that leave it open, and none between;
/// Barber (*Journal of Elasticity* 8, 1978) found that cooled punches have none. Friction heat alone begins at zero
/// where a node touches: one is found.
#[test]
fn newton_finds_no_stationary_state_of_a_locked_wheel_where_a_node_that_touches_cools_and_opens() {
    let (system, meshes) = bodies(Order::Linear);
    let given = Motion { omega: 0.0, velocity: VELOCITY };
    let (mut state, _) = newton::rolling(&system, motion(0.0)).unwrap();
    state.motion.omega = 0.0;
    let motions = || Newton { system: &system, law: PARAMETERS.law, drive: Drive::Velocity };
    let (cold, _) = motions().solve(&state).unwrap();
    let touching = |conductance: f64, share: f64| {
        let mut heat = warming(&meshes, LINEAR, given);
        (heat.heating.arcs, heat.heating.contact[0]) = (0.0, conductance);
        let expansion = Expansion::new(&system, &heat, share * EXPANSION);
        let coupled = Coupled { motions: motions(), warming: &heat, expansion: &expansion, rate: 0.0 };
        let start = Warm { state: cold.clone(), theta: vec![0.0; system.places.len()] };
        let warm = match iterate(&coupled, &start) {
            Ok((warm, _)) => warm,
            Err(error) => {
                assert!(matches!(error, wheelrail_thesis::Error::NotConverged { .. }), "{error}");
                return None;
            }
        };
        assert!(coupled.flows(&warm).imbalance() < 1e-8);
        Some(coupled.motions.touches(&warm.state).len())
    };
    let found = [0.7, 1.0, 1.4].map(|share| [1e7, 0.0].map(|conductance| touching(conductance, share)));
    println!("nodes in contact with conductance and without: {found:?}");
    assert_eq!(found.map(|[exchanging, _]| exchanging), [Some(5), None, Some(4)]);
    assert!(found.iter().all(|[_, friction_alone]| friction_alone.is_some()));
}
