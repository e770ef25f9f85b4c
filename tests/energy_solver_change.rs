//! The energy balance where the contact goes from the series to the grid and back.

mod common;

use common::{is_patch, model, preset};
use wheelrail::config::ContactMethod;
use wheelrail::simulation::{Inputs, Simulation};

/// Largest step of the energy residual from one output to the next where the contact solver has changed and where not, and
/// the number of changes.
fn steps(
    preset_name: &str,
    elements: usize,
    heat: bool,
    contact: ContactMethod,
    drive: impl Fn(&mut Inputs, usize),
) -> ([f64; 2], usize) {
    let mut config = preset(preset_name, elements);
    (config.solver.contact, config.initial.velocity, config.thermal.enabled) = (contact, 7.0, heat);
    let model = model(config);
    let mut inputs = Inputs::rolling(model.config());
    let mut simulation = Simulation::new(model, &inputs).unwrap();
    let (mut patch, mut residual) = (is_patch(&simulation), 0.0);
    let (mut largest, mut changes) = ([0.0f64; 2], 0);
    for k in 0..300 {
        drive(&mut inputs, k);
        simulation.advance(&inputs, 1e-3).unwrap();
        let now = simulation.outputs().energy_residual;
        let changed = is_patch(&simulation) != patch;
        // Before anything has been dissipated the residual is that of the start.
        let of = &mut largest[usize::from(!changed)];
        *of = of.max((now - residual).abs());
        changes += usize::from(changed);
        (patch, residual) = (changed != patch, now);
    }
    println!(
        "{preset_name}, {elements} elements, heat {heat}, {contact:?}: {changes} changes, residual steps by {largest:?}"
    );
    (largest, changes)
}

#[test]
fn the_energy_residual_does_not_jump_where_the_contact_solver_changes() {
    let friction = |moment: f64| {
        move |inputs: &mut Inputs, k: usize| {
            inputs.drive.moment = moment;
            inputs.drive.friction = if (k / 10).is_multiple_of(2) { 0.3 } else { 0.1 };
        }
    };
    let brake =
        |inputs: &mut Inputs, k: usize| inputs.drive.torque = if (k / 40).is_multiple_of(2) { 0.0 } else { 4000.0 };
    let load = |inputs: &mut Inputs, k: usize| {
        inputs.drive.moment = -6000.0;
        inputs.drive.load = 1e5 * (1.0 + 0.3 * (0.9 * k as f64).sin() * (0.37 * k as f64).cos());
    };
    let (mut all, mut worst) = (0, 0.0f64);
    let mut check = |name: &str, elements: usize, heat: bool, drive: &dyn Fn(&mut Inputs, usize)| {
        let (largest, changes) = steps(name, elements, heat, ContactMethod::Auto, drive);
        all += changes;
        worst = worst.max(largest[0]);
        // What both solvers make of the elastic energy of the contact differs with the mesh by some thousandths.
        assert!(largest[0] < 6e-3, "{name}, {elements} elements, heat {heat}: {largest:?}");
    };
    check("railway_wet", 10, true, &friction(-6000.0));
    for (name, elements) in [("railway_wet", 10), ("railway", 10), ("railway", 20)] {
        for moment in [0.0, -3000.0, -6000.0] {
            check(name, elements, false, &friction(moment));
        }
        check(name, elements, false, &brake);
        check(name, elements, false, &load);
    }
    println!("{all} changes, residual steps by {worst:.1e} at most");
    assert!(all > 100, "the contact solver must change: {all}");
}
