//! Outputs that keep to their texts where steel yields, surfaces slope and nothing heats.

use crate::common::{KMH, model, preset};
use wheelrail::config::Config;
use wheelrail::simulation::{Inputs, Outputs, Rotation, Simulation, Translation};

/// Rotates with the angular velocity `omega` of the rolling wheel, which falls to zero in `stop` seconds, while the
/// wheel travels on; `seen` sees every step of 1 ms.
fn locked(config: Config, [stop, end]: [f64; 2], mut seen: impl FnMut(&Simulation, &Outputs)) {
    let model = model(config);
    let mut inputs = Inputs::rolling(model.config());
    (inputs.rotation, inputs.translation) = (Rotation::Velocity, Translation::Velocity);
    let omega = inputs.drive.omega;
    let mut simulation = Simulation::new(model, &inputs).unwrap();
    for k in 1..=(end * 1e3).round() as usize {
        inputs.drive.omega = omega * (1.0 - k as f64 * 1e-3 / stop).max(0.0);
        simulation.advance(&inputs, 1e-3).unwrap();
        seen(&simulation, simulation.outputs());
    }
}

/// The peak of a smooth pressure lies between nodes, a little above them; that of steel which yields follows its
/// strength from node to node. The parabola through the squares of three nodes, none of them negative, rises above the
/// middle one by an eighth at most; it comes near where a hot patch is pressed most beside a steep edge.
#[test]
fn the_largest_pressure_is_nowhere_below_the_profile() {
    for name in ["railway", "railway_wet"] {
        let mut config = preset(name, 10);
        config.initial.velocity = 60.0 * KMH;
        let (mut least, mut most, mut yielding) = (f64::INFINITY, 0.0f64, 0);
        locked(config, [0.02, 0.2], |simulation, o| {
            let nodes = simulation.state().lines[0].contact.traction.pressure.value.iter().copied().fold(0.0, f64::max);
            let points = o.profile_pressure.iter().copied().fold(0.0, f64::max);
            assert!(o.contact_pressure_max >= points && o.contact_pressure_max >= nodes);
            (least, most) = (least.min(o.contact_pressure_max / nodes), most.max(o.contact_pressure_max / nodes));
            // Steel may yield elsewhere than beside the peak: the bound of a parabola holds in all steps.
            yielding += usize::from(o.yielded > 0.2);
        });
        println!("{name}: {least:.5} to {most:.5} of the largest nodal pressure, {yielding} steps yield");
        assert!(least >= 1.0 && most * most < 1.125 && yielding > 5);
    }
}

/// Pressure on a slope pushes along the rail, and that is no friction.
#[test]
fn a_slide_over_waves_uses_all_of_the_friction_and_no_more() {
    let mut config = preset("railway", 10);
    config.initial.velocity = 60.0 * KMH;
    config.rail.profile = "sinusoid(amplitude = 1e-5, wavelength = 0.05)".into();
    let mut pushed = 0.0f64;
    locked(config, [0.02, 0.06], |_, o| {
        assert!(o.contact_utilisation <= 1.0 + 1e-12, "{}", o.contact_utilisation);
        if o.contact_stick_fraction == 0.0 && o.contact_lost_time == 0.0 {
            assert!(o.contact_utilisation > 1.0 - 1e-12, "{}", o.contact_utilisation);
            pushed = pushed.max(o.contact_force_x.abs() / (o.friction * o.contact_force_y));
        }
    });
    println!("force along the rail up to {pushed:.4} of the friction limit");
    assert!(pushed > 1.01);
}

/// Heat that flows from a warm place to a cold one is what the balance is measured with, whether or not a source
/// supplies any.
#[test]
fn the_heat_residual_is_round_off_without_a_source() {
    for (excess, rail, velocity) in
        [(100.0, 293.15, 0.0), (100.0, 293.15, 15.0), (0.0, 263.15, 0.0), (0.0, 263.15, 15.0)]
    {
        for friction in [0.0, 0.3] {
            let mut config = preset("railway", 10);
            (config.thermal.wheel_excess, config.initial.velocity) = (excess, velocity);
            let model = model(config);
            let mut inputs = Inputs::rolling(model.config());
            (inputs.drive.friction, inputs.drive.temperature) = (friction, rail);
            let mut simulation = Simulation::new(model, &inputs).unwrap();
            let mut worst = 0.0f64;
            for _ in 0..100 {
                simulation.advance(&inputs, 1e-3).unwrap();
                worst = worst.max(simulation.outputs().heat_residual.abs());
            }
            println!("excess {excess} K, rail {rail} K, {velocity} m/s, friction {friction}: {worst:.1e}");
            assert!(worst < 1e-9);
        }
    }
}
