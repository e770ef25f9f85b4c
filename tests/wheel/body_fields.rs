//! Fields in the whole bodies against contact mechanics and against the outputs of the same state.

use crate::common::{figure, model, prescribed, preset};
use wheelrail::analytic::{contact_modulus, hertz_half_width, hertz_peak_pressure};
use wheelrail::config::{Config, StartTemperature};
use wheelrail::fem::mesh::Mesh;
use wheelrail::mechanics::{rail_mesh, wheel_mesh};
use wheelrail::simulation::{BodyField, Inputs, Simulation, Stress};

/// The wheel of Papers D on a small mesh, with the response of all nodes.
fn small() -> Config {
    let mut config = preset("paper_d", 8);
    (config.solver.reduced, config.initial.temperature) = (false, StartTemperature::Stationary);
    config
}

#[track_caller]
fn assert_close(found: f64, expected: f64, tolerance: f64, what: &str) {
    let error = (found - expected).abs();
    assert!(error <= tolerance * expected.abs().max(1e-9), "{what}: {found} against {expected}");
}

/// Hertzian half-width [m] and peak pressure [Pa] under the nominal load.
fn hertz(config: &Config) -> (f64, f64) {
    let load = config.model.nominal_load / config.model.contact_width;
    let modulus = contact_modulus(config.material.youngs_modulus, config.material.poissons_ratio);
    let a = hertz_half_width(load, config.wheel.radius, modulus);
    (a, hertz_peak_pressure(load, a))
}

/// Area of the cells, all of which are counter-clockwise.
fn area(mesh: &Mesh) -> f64 {
    let of_cell = |cell: &[usize; 4]| {
        let [a, b, c, d] = cell.map(|i| mesh.nodes[i]);
        0.5 * ((c[0] - a[0]) * (d[1] - b[1]) - (d[0] - b[0]) * (c[1] - a[1]))
    };
    mesh.cells.iter().map(of_cell).inspect(|area| assert!(*area > 0.0)).sum()
}

/// Nodes as (distance from the contact point, node) below or above it, ascending.
fn axis(mesh: &Mesh, limit: f64) -> Vec<(f64, usize)> {
    let on_axis = |&(_, p): &(usize, &[f64; 2])| p[0].abs() < 1e-9 && p[1].abs() < limit;
    let mut nodes: Vec<_> = mesh.nodes.iter().enumerate().filter(on_axis).map(|(i, p)| (p[1].abs(), i)).collect();
    nodes.sort_by(|a, b| a.0.total_cmp(&b.0));
    nodes
}

/// Nodes as (x, node) on the surface within `reach`, ascending; `radius` of the wheel, infinite for the rail.
fn surface(mesh: &Mesh, radius: f64, reach: f64) -> Vec<(f64, usize)> {
    let height = |x: f64| if radius.is_finite() { radius - (radius * radius - x * x).sqrt() } else { 0.0 };
    let on_surface = |&(_, p): &(usize, &[f64; 2])| p[0].abs() < reach && (p[1] - height(p[0])).abs() < 1e-12;
    let mut nodes: Vec<_> = mesh.nodes.iter().enumerate().filter(on_surface).map(|(i, p)| (p[0], i)).collect();
    nodes.sort_by(|a, b| a.0.total_cmp(&b.0));
    nodes
}

/// `∫ stress dx` over the surface by the trapezoidal rule.
fn integral(body: &BodyField, surface: &[(f64, usize)], of: fn(&Stress) -> f64) -> f64 {
    let value = |k: usize| of(&body.stress[surface[k].1]);
    (1..surface.len()).map(|k| 0.5 * (surface[k].0 - surface[k - 1].0) * (value(k) + value(k - 1))).sum()
}

/// Vertex of the parabola through the largest of the values and its neighbours.
fn vertex(values: &[(f64, f64)]) -> (f64, f64) {
    let at = (1..values.len() - 1).max_by(|&i, &j| values[i].1.total_cmp(&values[j].1)).unwrap();
    let [(x0, y0), (x1, y1), (x2, y2)] = [values[at - 1], values[at], values[at + 1]];
    let (fall, rise) = ((y1 - y0) / (x1 - x0), (y2 - y1) / (x2 - x1));
    let bend = (rise - fall) / (x2 - x0);
    let slope = (fall * (x2 - x1) + rise * (x1 - x0)) / (x2 - x0);
    (x1 - 0.5 * slope / bend, y1 - 0.25 * slope * slope / bend)
}

#[test]
fn stress_without_friction_is_that_of_hertz() {
    let mut config = small();
    (config.friction.coefficient, config.physics.centrifugal, config.thermal.enabled) = (0.0, false, false);
    let (a, p0) = hertz(&config);
    let model = model(config.clone());
    let inputs = prescribed(&model, config.initial.velocity, 0.0);
    let fields = Simulation::new(model, &inputs).unwrap().fields().unwrap();
    assert_eq!(fields.wheel.mesh.nodes.len(), wheel_mesh(&(&config).into()).unwrap().nodes.len());
    assert_eq!(fields.rail.mesh.nodes.len(), rail_mesh(&(&config).into()).unwrap().nodes.len());
    let load = config.model.nominal_load / config.model.contact_width;
    for (body, radius, name) in [(&fields.wheel, config.wheel.radius, "wheel"), (&fields.rail, f64::INFINITY, "rail")] {
        let axis = axis(&body.mesh, 4.0 * a);
        assert!(axis[0].0 < 1e-15, "{name}: the contact point is at the origin");
        assert_close(body.stress[axis[0].1].yy, -p0, 0.02, name);
        // Plane strain below a Hertzian contact: σ_x = −p0 ((a² + 2z²)/√(a² + z²)/a − 2z/a), σ_y = −p0 a/√(a² + z²)
        // (Johnson, 4.46).
        for &(z, node) in axis.iter().skip(1) {
            let (root, stress) = (a.hypot(z), &body.stress[node]);
            let exact = [-p0 * ((a * a + 2.0 * z * z) / root - 2.0 * z) / a, -p0 * a / root];
            for (found, exact) in [stress.xx, stress.yy].into_iter().zip(exact) {
                assert!((found - exact).abs() < 0.025 * p0, "{name} at {} a: {found} against {exact}", z / a);
            }
            let plane = config.material.poissons_ratio * (stress.xx + stress.yy);
            assert_close(stress.zz, plane, 1e-12, "plane strain");
        }
        let (depth, von_mises) =
            vertex(&axis.iter().map(|(z, n)| (*z, body.stress[*n].von_mises())).collect::<Vec<_>>());
        figure("exported.stress", &[von_mises / (0.558 * p0) - 1.0, depth / (0.704 * a) - 1.0]);
        assert_close(von_mises, 0.558 * p0, 0.02, "largest von Mises stress");
        assert_close(depth, 0.704 * a, 0.04, "its depth");
        let surface = surface(&body.mesh, radius, 1.5 * a);
        let pressed = integral(body, &surface, |s| s.yy);
        figure("exported.load", &[-pressed / load - 1.0]);
        assert_close(pressed, -load, 0.015, name);
        assert!(integral(body, &surface, |s| s.xy).abs() < 0.01 * load, "{name} carries no shear");
    }
    // The displacement brings the surfaces together, and only there.
    let [above, below] = [(&fields.wheel, config.wheel.radius), (&fields.rail, f64::INFINITY)].map(|(body, radius)| {
        let height = |node: usize| body.mesh.nodes[node][1] + body.displacement[node][1];
        surface(&body.mesh, radius, 1.4 * a).into_iter().map(|(x, node)| (x, height(node))).collect::<Vec<_>>()
    });
    assert_eq!(above.len(), below.len());
    for ((x, upper), (_, lower)) in above.iter().zip(&below) {
        let (gap, scale) = (upper - lower, a * a / (2.0 * config.wheel.radius));
        assert!(x.abs() > 0.9 * a || gap.abs() < 0.02 * scale, "gap {gap} at {} a", x / a);
        assert!(x.abs() < 1.2 * a || gap > 0.02 * scale, "gap {gap} at {} a", x / a);
    }
}

#[test]
fn shear_velocity_and_temperature_agree_with_the_outputs() {
    let config = small();
    let (a, _) = hertz(&config);
    let (speed, creepage) = (13.9, 3e-4);
    let model = model(config.clone());
    let simulation = Simulation::new(model.clone(), &prescribed(&model, speed, creepage)).unwrap();
    let (fields, outputs) = (simulation.fields().unwrap(), simulation.outputs());
    let force = outputs.contact_force_x / config.model.contact_width;
    let bodies = [(&fields.wheel, config.wheel.radius), (&fields.rail, f64::INFINITY)];
    let surfaces = bodies.map(|(body, radius)| surface(&body.mesh, radius, 1.5 * a));
    // The outward normal of the rail is +y: its shear stress is the traction that the wheel exerts on it.
    for ((body, _), surface) in bodies.iter().zip(&surfaces) {
        assert_close(integral(body, surface, |s| s.xy), -force, 0.03, "tangential force");
    }
    // Material flows to −x with the speed of the wheel; where it sticks, in the leading half, the surfaces move
    // together.
    let rigid = creepage * speed;
    let velocity = |k: usize, body: usize| bodies[body].0.velocity[surfaces[body][k].1][0];
    let (mut stuck, mut slipping) = (0, 0);
    for (k, (x, _)) in surfaces[1].iter().enumerate() {
        let slip = velocity(k, 0) - velocity(k, 1);
        assert!((velocity(k, 1) + speed).abs() < 1e-2 * speed);
        if (0.2 * a..0.8 * a).contains(x) {
            assert!(slip.abs() < 0.05 * rigid, "slip {slip} of {rigid} m/s at {} a", x / a);
            stuck += 1;
        }
        if (-0.95 * a..-0.8 * a).contains(x) {
            assert!(slip > 0.3 * rigid, "slip {slip} of {rigid} m/s at {} a", x / a);
            slipping += 1;
        }
    }
    assert!(stuck >= 4 && slipping >= 1);
    let temperatures = fields.temperature.unwrap();
    for (field, hottest) in temperatures.iter().zip([outputs.temperature_wheel_max, outputs.temperature_rail_max]) {
        let rise = field.temperature.iter().copied().fold(0.0, f64::max) - 293.0;
        assert_close(rise, hottest - 293.0, 0.01, "hottest place");
        assert!(field.temperature.iter().all(|t| *t > 293.0 - 0.05 * rise), "nothing is colder than the reference");
    }
    // The rail exactly, the wheel as the polygon it is.
    let circle = std::f64::consts::PI * (config.wheel.radius.powi(2) - config.wheel.hub_radius.powi(2));
    let block = config.rail.length * config.rail.height;
    let [hot_wheel, hot_rail] = &temperatures;
    for (mesh, exact, tolerance) in [
        (&fields.rail.mesh, block, 1e-9),
        (&hot_rail.mesh, block, 1e-9),
        (&fields.wheel.mesh, circle, 1e-3),
        (&hot_wheel.mesh, circle, 1e-2),
    ] {
        assert_close(area(mesh), exact, tolerance, "area");
    }
}

#[test]
fn fields_after_steps_are_those_of_their_end() {
    let mut config = small();
    config.tuning.tolerance = 0.0;
    let (a, _) = hertz(&config);
    let mut inputs = Inputs::rolling(&config);
    inputs.rate.moment = -8000.0 / 2e-3;
    let mut simulation = Simulation::new(model(config.clone()), &inputs).unwrap();
    for k in 0..4 {
        inputs.drive.moment = inputs.rate.moment * 5e-4 * f64::from(k);
        simulation.advance(&inputs, 5e-4).unwrap();
    }
    let (rail, outputs) = (simulation.fields().unwrap().rail, simulation.outputs());
    let (surface, width) = (surface(&rail.mesh, f64::INFINITY, 1.5 * a), config.model.contact_width);
    assert!(outputs.contact_force_x < -1000.0, "{} N", outputs.contact_force_x);
    assert_close(width * integral(&rail, &surface, |s| s.xy), -outputs.contact_force_x, 0.03, "tangential force");
    assert_close(width * integral(&rail, &surface, |s| s.yy), -outputs.contact_force_y, 0.015, "normal force");
}
