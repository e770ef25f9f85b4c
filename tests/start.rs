//! The stationary start.
mod common;
use common::*;
use std::sync::Arc;
use wheelrail::config::Config;
use wheelrail::simulation::{Inputs, Model, Simulation};

#[test]
fn probe() {
    for (heat, excess) in [(false, 0.0), (true, 0.0), (true, 100.0), (true, 300.0)] {
        for v in [0.0, 0.1, 5.0, 30.0, 80.0, -30.0] {
            let mut config = preset("railway", 20);
            config.thermal.enabled = heat;
            config.thermal.wheel_excess = excess;
            config.initial.velocity = v;
            config.thermal.max_speed = 90.0;
            let model = model(config);
            for dt in [1e-4, 1e-3] {
                for moment in [0.0, -2e3, -8e3, 8e3] {
                    let mut inputs = Inputs::rolling(model.config());
                    inputs.drive.moment = moment;
                    let t = std::time::Instant::now();
                    let mut s = match Simulation::new(model.clone(), &inputs) {
                        Ok(s) => s,
                        Err(e) => {
                            println!("v {v} M {moment} FAILED {e}");
                            continue;
                        }
                    };
                    let took = t.elapsed().as_secs_f64();
                    let o = s.outputs().clone();
                    let (mut f, mut xi, mut a) = (0.0f64, 0.0f64, 0.0f64);
                    let n = if moment == 0.0 { 0.2 } else { 0.1 };
                    for _ in 0..(n / dt) as usize {
                        if let Err(e) = s.advance(&inputs, dt) {
                            println!("step failed {e}");
                            break;
                        }
                        let p = s.outputs();
                        f = f.max((p.contact_force_x - o.contact_force_x).abs());
                        xi = xi.max((p.contact_creepage - o.contact_creepage).abs());
                        a = a.max((p.wheel_acceleration - o.wheel_acceleration).abs());
                    }
                    println!(
                        "heat {heat} {excess} v {v} dt {dt} M {moment}: {:.1} ms F {:.4} xi {:.6e} a {:.6} alpha {:.6}; dF {f:.3e} ({:.1e}) dxi {xi:.2e} ({:.1e}) da {a:.2e} ({:.1e})",
                        took * 1e3,
                        o.contact_force_x,
                        o.contact_creepage,
                        o.wheel_acceleration,
                        o.wheel_angular_acceleration,
                        f / o.contact_force_x.abs(),
                        xi / o.contact_creepage.abs(),
                        a / o.wheel_acceleration.abs()
                    );
                }
            }
        }
    }
}
