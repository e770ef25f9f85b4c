mod common;
use common::*;
use wheelrail::simulation::*;
#[test]
fn probe() {
    for step in [1e-3] {
    let model = model(preset("railway", 20));
    let c = model.config();
    let peak = 0.6 * c.friction.coefficient * c.model.nominal_load * c.wheel.radius;
    let mut inputs = Inputs::rolling(c);
    let mut s = Simulation::new(model.clone(), &inputs).unwrap();
    let t0 = std::time::Instant::now();
    let mut k = 0u64;
    while s.outputs().wheel_omega > 0.02 {
        inputs.drive.moment = -peak * (k as f64 * step / 0.5).min(1.0);
        s.advance(&inputs, step).unwrap();
        k += 1;
        if k % 1000 == 1 { let o = s.outputs(); println!("{:.2} s v {:.4} xi {:.3e} util {:.4} res {:+.3e} Tw {:.2} Tr {:.2} mean {:.2} bulk {:.4} P {:.2} toW {:.2} toR {:.2} cond {:.2} hres {:e} sum {:e} growth {:e}", s.time(), o.wheel_velocity, o.contact_creepage, o.contact_utilisation, o.energy_residual, o.temperature_wheel_max-293., o.temperature_rail_max-293., o.temperature_wheel_mean-293., o.temperature_wheel_bulk-293., o.friction_power, o.heat_to_wheel, o.heat_to_rail, o.heat_conduction, o.heat_residual, (o.heat_to_wheel+o.heat_to_rail)/o.friction_power-1.0, o.thermal_growth); }
    }
    println!("steps {k} wall {:?} per step {:?}", t0.elapsed(), t0.elapsed()/k as u32);
    }
}
