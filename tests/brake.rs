//! The brake: dry friction between wheel and vehicle that slips, holds and is released, exactly and at every step.

mod common;

use common::{model, preset};
use std::f64::consts::PI;
use std::sync::Arc;
use wheelrail::config::Config;
use wheelrail::simulation::{Drive, Inputs, Model, Outputs, Simulation};

/// A railway wheel on a coarse mesh, without heat.
fn wheel(change: impl Fn(&mut Config)) -> Arc<Model> {
    let mut config = preset("railway", 6);
    (config.solver.modes_wheel, config.solver.modes_rail) = (20, 10);
    config.thermal.enabled = false;
    change(&mut config);
    model(config)
}

/// Mass moving in x and moment of inertia of the whole wheel [kg, kg m²].
fn inertia(config: &Config) -> [f64; 2] {
    let (r, i) = (config.wheel.radius, config.wheel.hub_radius);
    let surface = PI * config.material.density * config.model.contact_width;
    let mass = surface * (r * r - i * i) + config.wheel.hub_mass + config.vehicle.mass;
    [mass, 0.5 * surface * (r.powi(4) - i.powi(4)) + config.wheel.hub_inertia]
}

/// A run under the forces that `course` gives for a time; every point is handed to `see`.
fn run(
    simulation: &mut Simulation,
    inputs: &Inputs,
    step: f64,
    duration: f64,
    course: impl Fn(f64, &mut Drive),
    mut see: impl FnMut(f64, &Outputs),
) {
    let mut inputs = *inputs;
    for k in 0..(duration / step).round() as usize {
        course(k as f64 * step, &mut inputs.drive);
        simulation.advance(&inputs, step).unwrap();
        see((k + 1) as f64 * step, simulation.outputs());
    }
}

#[test]
fn explore_stop() {
    let model = wheel(|_| {});
    let inputs = Inputs::rolling(model.config());
    let [mass, moment] = inertia(model.config());
    println!("m {mass} I {moment}");
    for step in [1e-3, 1e-4] {
        let mut s = Simulation::new(model.clone(), &inputs).unwrap();
        let t0 = std::time::Instant::now();
        let (mut locked, mut brake, mut friction) = (None, 0.0, 0.0);
        let (mut back, mut fwd) = (0.0f64, 0.0f64);
        run(&mut s, &inputs, step, 17.2, |_, d| d.torque = 8e3, |t, o| {
            brake += step * o.brake_power;
            friction += step * o.friction_power;
            if o.brake_locked && locked.is_none() {
                locked = Some((t, o.wheel_distance));
                println!("locked {t} V {} Fx {} moment {} resid {}", o.wheel_velocity, o.contact_force_x, o.hub_moment, o.energy_residual);
            }
            if let Some((at, _)) = locked {
                assert!(o.wheel_omega.abs() < 1e-9 && o.brake_locked);
                if t < at + 0.005 { println!("{t:.4} V {:.6} Fx {:.1} brake {:.1} Mc {:.1} acc {:.3}", o.wheel_velocity, o.contact_force_x, o.brake_moment, o.contact_moment, o.wheel_angular_acceleration); }
                back = back.min(o.wheel_velocity);
                fwd = fwd.max(o.wheel_velocity);
            }
        });
        let o = s.outputs();
        let kinetic = 0.5 * mass * (100.0/3.6f64).powi(2) + 0.5 * moment * (100.0/3.6/0.46f64).powi(2);
        println!("step {step} took {:?} back {back} fwd {fwd} brake {brake} friction {friction} sum/kinetic {} stored {} hubwork {} brake {} residual {}", t0.elapsed(), (brake + friction) / kinetic, o.stored_energy, o.hub_work, o.brake_energy, o.energy_residual);
    }
}

#[test]
fn explore_lock() {
    let model = wheel(|_| {});
    let inputs = Inputs::rolling(model.config());
    for step in [1e-3, 1e-4] {
        let mut s = Simulation::new(model.clone(), &inputs).unwrap();
        let mut last = false;
        let t0 = std::time::Instant::now();
        run(&mut s, &inputs, step, 1.6, |t, d| d.torque = if t < 0.8 { 25e3 * (t / 0.2).min(1.0) } else { 25e3 * (1.0 - (t-0.8)/0.8) }, |t, o| {
            if o.brake_locked != last { println!("step {step} t {t:.4} locked {} V {} om {} Fx {} brake {} rFx {}", o.brake_locked, o.wheel_velocity, o.wheel_omega, o.contact_force_x, o.brake_moment, 0.46*o.contact_force_x); last = o.brake_locked; }
        });
        println!("took {:?} resid {}", t0.elapsed(), s.outputs().energy_residual);
    }
}
