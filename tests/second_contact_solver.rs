//! A second contact solver behind the seam of the first: a smooth Hertzian line contact without friction. It knows
//! nothing of a grid; what it needs it takes from the contact problem, and the rolling motion runs on it unchanged.

mod common;

use common::preset;
use nalgebra::DVector;
use std::f64::consts::PI;
use std::sync::{Arc, Mutex};
use wheelrail::analytic::{hertz_half_width, hertz_peak_pressure};
use wheelrail::axes::{Axis, PerAxis};
use wheelrail::config::{Config, Response};
use wheelrail::contact::{
    AxisDrive, ContactError, ContactProblem, ContactScratch, ContactSolver, ContactState, OneLine, SolvedFriction,
    SolverState, Traction, Yielding,
};
use wheelrail::linalg::Lagrange;
use wheelrail::material::Isotropic;
use wheelrail::mechanics::{Basis, Pair, bodies};
use wheelrail::piecewise::{Interval, Piecewise};
use wheelrail::rolling::outputs::observe;
use wheelrail::rolling::{Inputs, RollingModel, Rotation, State, Translation, Workspace, stationary, substeps};
use wheelrail::simulation::Outputs;
use wheelrail::surface::Surfaces;

/// Displacement components at the points of the bodies.
const PORTS: usize = 10;
/// Points of the reported profiles.
const PROFILE: usize = 401;

/// Line contact of a cylinder on a plane with the pressure of Hertz on half-planes, of which the bodies feel its moments.
struct Hertz {
    /// Polynomials through whose points the bodies see it, two ports each.
    points: Lagrange,
    /// Contact modulus [Pa].
    modulus: f64,
    /// Distance and angle of the last problem.
    place: Arc<Mutex<[f64; 2]>>,
}

/// Parts of the pressure by which its moments are taken.
const PARTS: usize = 2000;

impl Hertz {
    /// Forces on the ports under a line load [N/m]: moments of the Hertzian pressure with the polynomials.
    fn forces(&self, load: f64, radius: f64) -> DVector<f64> {
        let a = hertz_half_width(load, radius, self.modulus);
        let mut forces = DVector::zeros(PORTS);
        for part in 0..PARTS {
            // Equal angles of the ellipse: `p dx = 2P/π sin² φ dφ`.
            let angle = PI * (part as f64 + 0.5) / PARTS as f64;
            let force = 2.0 * load / PARTS as f64 * angle.sin().powi(2);
            for (k, value) in self.points.values(a * angle.cos()).into_iter().enumerate() {
                forces[2 * k + 1] += force * value;
            }
        }
        forces
    }

    /// Approach of the half-planes of both bodies below the middle of the pressure [m], whose displacement ends at 1 m.
    fn pressed(&self, load: f64, radius: f64) -> f64 {
        let a = hertz_half_width(load, radius, self.modulus);
        2.0 * load / (PI * self.modulus) * ((2.0 / a).ln() + 0.5)
    }

    /// Displacements of both surfaces under forces and known motions.
    fn surfaces(&self, problem: &OneLine, forces: &DVector<f64>, rigid: &PerAxis<f64>) -> [DVector<f64>; 2] {
        let bodies = &problem.line.bodies;
        let mut wheel = bodies.free[0] + bodies.shared.compliance[0] * forces;
        for (axis, motion) in problem.rigid.iter() {
            wheel.axpy(motion.acceleration(rigid[axis]), &bodies.inertial.column(axis.number()), 1.0);
        }
        [wheel, bodies.free[1] - bodies.shared.compliance[1] * forces]
    }

    /// Distance of the surfaces below the wheel centre under a load [N/m] \[m]; zero in a solution.
    fn gap(&self, problem: &OneLine, surfaces: &[DVector<f64>; 2], (load, height): (f64, f64)) -> f64 {
        let port = PORTS / 4 * 2 + 1;
        let pressed = self.pressed(load, problem.line.radius());
        height + problem.line.surfaces.gap(0.0, &problem.line.placement) + surfaces[0][port] - surfaces[1][port]
            + pressed
    }

    /// Unbalance of a free axis [N/m, N].
    fn unbalance(&self, problem: &OneLine, axis: Axis, forces: &DVector<f64>, rigid: &PerAxis<f64>) -> f64 {
        let motion = &problem.rigid[axis];
        let mut sum = motion.momentum + (problem.line.bodies.momentum.row(axis.number()) * forces)[0];
        for (other, of_other) in problem.rigid.iter() {
            let of_deformation = problem.line.bodies.deformation_inertia[(axis.number(), other.number())];
            let inertia = of_deformation + if other == axis { motion.inertia } else { 0.0 };
            sum += inertia * of_other.acceleration(rigid[other]);
        }
        sum - self.resultant(forces)[axis]
    }

    /// Force and moment about the hub centre: the pressure is symmetric about the point below it.
    fn resultant(&self, forces: &DVector<f64>) -> PerAxis<f64> {
        PerAxis { height: forces.iter().skip(1).step_by(2).sum(), ..PerAxis::default() }
    }

    /// Rigid motions and residuals of the free axes for a load: the equations are linear.
    fn motion(&self, problem: &OneLine, load: f64, radius: f64) -> PerAxis<f64> {
        let forces = self.forces(load, radius);
        let mut rigid = problem.rigid.map(|motion| motion.start());
        for _ in 0..4 {
            for axis in Axis::along() {
                // The start seeks the speed at which friction holds a balance; without friction any speed does.
                let sought = problem.rigid[axis].gain == 0.0;
                if let (AxisDrive::Free { load }, false) = (problem.rigid[axis].drive, sought) {
                    let residual = self.unbalance(problem, axis, &forces, &rigid) - load;
                    let diagonal = (axis.number(), axis.number());
                    let inertia = problem.rigid[axis].inertia + problem.line.bodies.deformation_inertia[diagonal];
                    rigid[axis] -= residual / (inertia * problem.rigid[axis].gain);
                }
            }
            // The height at which the surfaces just touch.
            if problem.rigid.height.target().is_none() {
                let touch = |height: f64| {
                    let rigid = PerAxis { height, ..rigid };
                    self.gap(problem, &self.surfaces(problem, &forces, &rigid), (load, height))
                };
                let (at, slope) = (touch(rigid.height), touch(rigid.height + 1e-6) - touch(rigid.height));
                rigid.height -= at * 1e-6 / slope;
            }
        }
        rigid
    }
}

impl ContactSolver for Hertz {
    fn touching(&self, _half_width: f64) -> ContactState {
        ContactState { traction: Traction::without_forces(), ..ContactState::default() }
    }

    fn solve(
        &self,
        problem: &ContactProblem,
        _start: &[&ContactState],
        found: &mut [&mut ContactState],
        _scratch: &mut ContactScratch,
    ) -> Result<(), ContactError> {
        let (nominal_load, problem) = (problem.nominal_load, &problem.single()?);
        let [found] = found else { return Err(ContactError::ForeignState) };
        let radius = problem.line.radius();
        *self.place.lock().unwrap() = [problem.line.placement.distance, problem.line.placement.angle];
        // The load at which what presses the wheel down is what holds it up; a secant of an almost linear function.
        let missing = |load: f64| {
            let rigid = self.motion(problem, load, radius);
            let forces = self.forces(load, radius);
            match problem.rigid.height.drive {
                AxisDrive::Free { load } | AxisDrive::Braked { load, .. } => {
                    self.unbalance(problem, Axis::Height, &forces, &rigid) - load
                }
                AxisDrive::Prescribed { target } => {
                    self.gap(problem, &self.surfaces(problem, &forces, &rigid), (load, target)) * nominal_load * 1e4
                }
            }
        };
        let (mut a, mut b) = (0.9 * nominal_load, nominal_load);
        let (mut at_a, mut iterations) = (missing(a), 0);
        loop {
            let at_b = missing(b);
            iterations += 1;
            if at_b.abs() <= 1e-11 * nominal_load {
                break;
            }
            if iterations > 40 {
                return Err(ContactError::NotConverged { iterations });
            }
            let next = b - at_b * (b - a) / (at_b - at_a);
            (a, at_a, b) = (b, at_b, next.max(1e-3 * nominal_load));
        }
        let (rigid, half_width) = (self.motion(problem, b, radius), hertz_half_width(b, radius, self.modulus));
        let forces = self.forces(b, radius);
        let peak = hertz_peak_pressure(b, half_width);
        let at = |k: usize| half_width * (2.0 * k as f64 / (PROFILE - 1) as f64 - 1.0);
        let x: Vec<f64> = (0..PROFILE).map(at).collect();
        let pressure = x.iter().map(|x| peak * (1.0 - (x / half_width).powi(2)).max(0.0).sqrt()).collect();
        let profile = |value: Vec<f64>| Piecewise { x: x.clone(), value };
        let slip = rigid.travel - radius * rigid.rotation;
        found.traction = Traction {
            resultant: self.resultant(&forces),
            surface: self.surfaces(problem, &forces, &rigid),
            loads: [forces.clone(), -&forces],
            port_forces: forces,
            rigid,
            friction: SolvedFriction {
                coefficient: problem.line.friction.coefficient(slip),
                tread_slip: slip,
                law_slope: 0.0,
                slip_speed: slip.abs(),
                power: 0.0,
                work: 0.0,
                dissipation: profile(vec![0.0; PROFILE]),
                excess: 0.0,
            },
            edges: vec![Interval { low: -half_width, high: half_width }],
            patches: vec![Interval { low: -half_width, high: half_width }],
            stick_fraction: 0.0,
            pressure_max: peak,
            pressure: profile(pressure),
            shear: profile(vec![0.0; PROFILE]),
            slip: profile(vec![slip; PROFILE]),
            yielding: Yielding::default(),
            iterations,
            ..Traction::default()
        };
        found.solver = SolverState::Stateless;
        Ok(())
    }

    fn fits(&self, state: &ContactState) -> bool {
        state.solver == SolverState::Stateless && state.traction.fits()
    }
}

/// The model on the toy solver, and one on the solver on the grid.
fn models() -> [RollingModel; 2] {
    models_with_place().0
}

/// Models on the toy solver and on the grid, with the place of the last problem of the toy solver.
fn models_with_place() -> ([RollingModel; 2], Arc<Mutex<[f64; 2]>>) {
    let mut config = preset("railway", 10);
    config.thermal.enabled = false;
    // Damping takes power from a rolling wheel by a resistance: a skewed pressure, unlike that of the toy.
    config.damping.modal = false;
    config.solver.response = Response::Reduced;
    let basis = common::store().find(&config).unwrap();
    let basis = basis.map_or_else(|| Basis::compute(&config, &mut |_, _| {}).unwrap(), |(basis, _)| basis);
    let pair = |config: &Config| -> Pair { bodies(config, Some(basis.clone()), &mut |_, _| {}).unwrap() };
    let (toys, grids) = (pair(&config), pair(&config));
    let place = Arc::default();
    let toy = Hertz {
        points: Lagrange::new(toys.reach),
        modulus: Isotropic::from(&config.material).contact_modulus(),
        place: Arc::clone(&place),
    };
    let smooth = || Surfaces::smooth(config.wheel.radius);
    let toys = RollingModel::with_solver(config.clone(), toys, smooth(), Box::new(toy)).unwrap();
    let models = [toys, RollingModel::new(config.clone(), grids, smooth()).unwrap()];
    (models, place)
}

/// Rolling under a moment [N m], without the friction that the toy solver does not have: a start with friction is that
/// of a wheel which friction holds.
fn driven(model: &RollingModel, moment: f64) -> Inputs {
    let mut inputs = Inputs::rolling(&model.config);
    (inputs.drive.moment, inputs.drive.friction) = (moment, 0.0);
    inputs
}

fn start(model: &RollingModel, inputs: &Inputs) -> (State, Workspace) {
    let mut workspace = Workspace::default();
    let state = stationary::start(model, &model.config.tuning, inputs, &mut workspace).unwrap();
    (state, workspace)
}

/// Outputs of the start and after each of `steps` steps of 1 ms.
fn run(model: &RollingModel, inputs: &Inputs, steps: usize) -> Vec<Outputs> {
    let (mut state, mut workspace) = start(model, inputs);
    let mut seen = vec![observe(model, &state)];
    for _ in 0..steps {
        let mut next = State::default();
        substeps::advance(model, &model.config.tuning, &state, inputs, 1e-3, &mut workspace, &mut next).unwrap();
        state = next;
        assert!(model.fits(&state) && state.lines[0].contact.solver == SolverState::Stateless);
        seen.push(observe(model, &state));
    }
    seen
}

#[test]
fn stationary_contact_of_the_second_solver_is_that_of_hertz() {
    let [model, on_grid] = models();
    let mut inputs = Inputs::rolling(&model.config);
    inputs.rotation = Rotation::Velocity;
    inputs.translation = Translation::Velocity;
    // The solver on the grid is frictionless, too, for comparison.
    let (ours, theirs) = (observe(&model, &start(&model, &inputs).0), {
        let mut smooth = inputs;
        smooth.drive.friction = 0.0;
        observe(&on_grid, &start(&on_grid, &smooth).0)
    });
    let config = &model.config;
    let line_load = inputs.drive.load / config.model.contact_width;
    let a = hertz_half_width(line_load, config.wheel.radius, Isotropic::from(&config.material).contact_modulus());
    assert!((ours.contact_force_y / inputs.drive.load - 1.0).abs() < 1e-9, "{}", ours.contact_force_y);
    assert!((ours.contact_half_width / a - 1.0).abs() < 1e-9);
    assert!((ours.contact_pressure_max / hertz_peak_pressure(line_load, a) - 1.0).abs() < 1e-9);
    assert_eq!((ours.contact_force_x, ours.friction_power, ours.contact_stick_fraction), (0.0, 0.0, 0.0));
    println!("approach {:.4e} m, on the grid {:.4e} m", ours.contact_approach, theirs.contact_approach);
    assert!((ours.contact_approach / theirs.contact_approach - 1.0).abs() < 0.02);
    assert!((ours.contact_half_width / theirs.contact_half_width - 1.0).abs() < 5e-3);
}

#[test]
fn a_wheel_on_the_second_solver_accelerates_under_its_moment_alone() {
    let [model, _] = models();
    let inputs = driven(&model, 500.0);
    let seen = run(&model, &inputs, 40);
    let (first, last) = (&seen[0], &seen[40]);
    for outputs in &seen {
        assert_eq!(outputs.contact_force_x, 0.0);
        assert_eq!(outputs.friction_power, 0.0);
        // Of a wheel that is spun up the rim moves a little, and its inertia takes part of the load.
        assert!((outputs.contact_force_y / inputs.drive.load - 1.0).abs() < 1e-4, "{}", outputs.contact_force_y);
    }
    // Without friction the moment turns the wheel, and nothing drives the vehicle.
    let turned = model.wheel.inertia.rotation * model.wheel.width * (last.wheel_omega - first.wheel_omega);
    println!("angular momentum {turned:.6} N m s under {:.6} N m s", 500.0 * 0.04);
    println!("velocity {:e}, energy residual {:e}", last.wheel_velocity - first.wheel_velocity, last.energy_residual);
    assert!((turned / (500.0 * 0.04) - 1.0).abs() < 1e-6);
    assert!((last.wheel_velocity - first.wheel_velocity).abs() < 1e-6);
    assert!(last.energy_residual.abs() < 5e-3);
}

#[test]
fn states_do_not_pass_from_one_solver_to_the_other() {
    let [model, on_grid] = models();
    let inputs = Inputs::rolling(&model.config);
    let (ours, theirs) = (start(&model, &inputs).0, start(&on_grid, &inputs).0);
    assert!(model.fits(&ours) && on_grid.fits(&theirs));
    assert!(!model.fits(&theirs) && !on_grid.fits(&ours));
    assert_ne!(ours.clock.decisions, theirs.clock.decisions);
}

#[test]
fn the_contact_is_solved_where_the_step_ends() {
    let ([model, _], place) = models_with_place();
    let inputs = driven(&model, -500.0);
    let (state, mut workspace) = start(&model, &inputs);
    assert_eq!(*place.lock().unwrap(), [0.0, 0.0]);
    let mut next = State::default();
    substeps::advance(&model, &model.config.tuning, &state, &inputs, 1e-3, &mut workspace, &mut next).unwrap();
    let [distance, angle] = *place.lock().unwrap();
    println!("{distance:.9} m of {:.9} m, {angle:.9} of {:.9}", next.motion.distance, next.motion.angle);
    assert!(next.motion.distance > 0.02 && (distance / next.motion.distance - 1.0).abs() < 1e-9);
    assert!((angle / next.motion.angle - 1.0).abs() < 1e-6);
}
