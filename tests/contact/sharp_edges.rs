//! Sharp edges of rail and wheel: what lies deeper than anything touches counts neither in forces nor in the energy.

use crate::common::{self, model, prescribed, preset};
use wheelrail::simulation::{Rotation, Simulation, Translation};

/// Speed [m/s], distance of the edge \[m], steps for the hole, elements per half-width and length of the hole over it.
const SPEED: f64 = 20.0;
const PLACE: f64 = 0.01;
const STEPS: f64 = 20.0;
const ELEMENTS: usize = 10;
/// Mesh on which edges are sharper, elements per half-width.
const FINE: usize = 40;
const SIZE: f64 = 0.8;

/// Largest force x and moment over the load and load times radius, largest energy residual and that in the end, over a
/// shape of depth `depth`.
fn over(shape: &str, depth: f64, wheel: bool, free: bool) -> [f64; 4] {
    on_mesh(shape, depth, wheel, free, (ELEMENTS, STEPS), false)
}

/// Passage of an edge with so many elements per half-width and steps for the hole, on elastic or on yielding steel.
fn on_mesh(shape: &str, depth: f64, wheel: bool, free: bool, mesh: (usize, f64), yields: bool) -> [f64; 4] {
    let (elements, steps) = mesh;
    let mut config = preset("railway", elements);
    (config.thermal.enabled, config.tuning.tolerance, config.physics.yielding) = (false, 0.0, yields);
    let length = SIZE * config.nominal_patch().half_length;
    let text = shape.replace("DEPTH", &format!("{depth:?}")).replace("LENGTH", &format!("{length:?}"));
    *(if wheel { &mut config.wheel.profile } else { &mut config.rail.profile }) = text;
    let model = model(config);
    let mut inputs = prescribed(&model, SPEED, 0.0);
    if free {
        inputs.translation = Translation::Force;
        inputs.rotation = Rotation::Moment;
    }
    let mut simulation = Simulation::new(model.clone(), &inputs).unwrap();
    let load = inputs.drive.load;
    let moment = load * model.config().wheel.radius;
    let mut most = [0.0f64; 4];
    for _ in 0..(3.0 * PLACE / length * steps) as usize {
        simulation.advance(&inputs, length / steps / SPEED).unwrap();
        let o = simulation.outputs();
        let now = [o.contact_force_x / load, o.contact_moment / moment, o.energy_residual];
        most[3] = o.energy_residual.abs();
        most.iter_mut().zip(now).for_each(|(most, now)| *most = most.max(now.abs()));
    }
    most
}

#[test]
fn neither_force_nor_energy_depends_on_the_depth_of_a_hole_beyond_what_touches() {
    let rail = "hole(position = 0.01, length = LENGTH, depth = DEPTH)";
    let wheel = "hole(position = 0.01, length = LENGTH, depth = DEPTH, every = 0.1, count = 1)";
    for (shape, of_wheel) in [(rail, false), (wheel, true)] {
        for free in [true, false] {
            let [shallow, deep] = [1e-4, 1e-2].map(|depth| over(shape, depth, of_wheel, free));
            shallow.iter().zip(deep).for_each(|(a, b)| common::round_off("edges.depth", &[a - b], 1e-9));
            common::figure("edges.residual", &deep[3..]);
            println!("{shape}, free hub: {free}: force x, moment, residuals {shallow:?}, 10 mm deep {deep:?}");
            for (shallow, deep) in shallow.iter().zip(deep) {
                // Strikes magnify what iterations leave, 1e-11 of friction.
                assert!((shallow - deep).abs() < 1e-3 * deep.abs().max(1e-3), "{shallow:e} {deep:e}");
            }
            assert!(deep[2] < 0.05 && deep[3] < 0.01, "{deep:?}");
        }
    }
}

/// Energy that the balance misses while an edge passes belongs to the elements beside it: a third of the step changes
/// it by little, a quarter of the element takes more than half of it away.
#[test]
fn what_is_missing_while_an_edge_passes_falls_with_the_element_and_not_with_the_step() {
    let hole = "hole(position = 0.01, length = LENGTH, depth = DEPTH)";
    let raised = "step(position = 0.01, height = DEPTH, length = LENGTH)";
    for (shape, depth) in [(hole, 1e-4), (raised, 1e-5), (raised, 1e-4)] {
        let missing = |elements: usize, steps: f64| on_mesh(shape, depth, false, true, (elements, steps), false)[2];
        let [coarse, short, fine] =
            [(ELEMENTS, STEPS), (ELEMENTS, 3.0 * STEPS), (FINE, 3.0 * STEPS)].map(|(n, steps)| missing(n, steps));
        let name = if shape == hole { "hole".into() } else { format!("raised.{}", (1e6 * depth).round()) };
        common::figure(&format!("edges.{name}"), &[fine / short]);
        println!(
            "{shape}, {depth:e} m: residual {coarse:.4}, a third of the step {short:.4}, on the fine mesh {fine:.4}"
        );
        assert!((short / coarse - 1.0).abs() < 0.2 && fine < 0.5 * short, "{coarse} {short} {fine}");
    }
}

/// Down a step of the rail, and over a raised piece of it; while the edges pass the balance is off by more than
/// afterwards.
#[test]
fn the_energy_balance_closes_after_steps_down_and_up() {
    for shape in ["step(position = 0.01, height = -DEPTH)", "step(position = 0.01, height = DEPTH, length = LENGTH)"] {
        for (free, depth) in [(true, 2e-5), (false, 2e-5), (true, 1e-4)] {
            let found = over(shape, depth, false, free);
            println!("{shape}, {depth:e} m, free hub: {free}: force x, moment, residuals {found:?}");
            assert!(found[2] < 0.2 && found[3] < 0.05, "{found:?}");
        }
    }
}

/// Steel that rolls through keeps no dent: what an edge presses in springs back behind it, and the pressure on it does
/// the work.
#[test]
fn steel_that_yields_under_a_passing_edge_gives_its_work_back() {
    let step = "step(position = 0.01, height = DEPTH, length = 0.5)";
    let raised = "step(position = 0.01, height = DEPTH, length = LENGTH)";
    // While the high piece bears all of the load all of the contact yields: there the balance is worse.
    for (shape, depth, wheel, free, [passing, end]) in [
        (step, 5e-5, false, true, [0.2, 0.07]),
        (step, -5e-5, false, true, [0.2, 0.07]),
        (step, 5e-5, false, false, [0.2, 0.07]),
        (step, 5e-5, true, true, [0.2, 0.07]),
        (step, -5e-5, true, true, [0.2, 0.07]),
        (raised, 2e-5, false, true, [0.2, 0.07]),
        (raised, 1e-4, false, true, [0.6, 0.15]),
    ] {
        for elements in [ELEMENTS, 2 * ELEMENTS] {
            let found = on_mesh(shape, depth, wheel, free, (elements, 3.0 * STEPS), true);
            let high = end > 0.1;
            common::figure(
                &if high { format!("edges.yielding.high.{elements}") } else { "edges.yielding".into() },
                &found[3..],
            );
            println!("{shape}, {depth:e} m, wheel: {wheel}, free hub: {free}, {elements} elements: {found:?}");
            assert!(found[2] < passing && found[3] < end, "{found:?}");
        }
    }
}
