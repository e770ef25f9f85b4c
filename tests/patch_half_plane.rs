//! The contact on a single patch between two elastic half-planes, where Hertz and Carter have closed forms.

mod common;
mod rigid_bodies;

use rigid_bodies::{RigidBodies, Step};
use wheelrail::analytic::{
    HalfPlane, carter_force, carter_full_slip, contact_modulus, hertz_half_width, hertz_peak_pressure,
};
use wheelrail::contact::series::SeriesSolver;
use wheelrail::contact::{
    ContactError, ContactSolver, ContactState, Friction, LineKernel, LineLayout, RigidMotion, SolverState, Spin,
};
use wheelrail::multistep::TimeDerivative;

const RADIUS: f64 = 0.5;
const FRICTION: f64 = 0.3;
const LOAD: f64 = 4e6;
const NU: f64 = 0.3;
const YOUNG: f64 = 2.1e11;

fn modulus() -> f64 {
    contact_modulus(YOUNG, NU)
}

/// Two half-planes and nothing else.
struct HalfPlanes {
    solver: SeriesSolver,
    line: LineLayout,
    bodies: RigidBodies,
}

impl HalfPlanes {
    /// With Poisson's `coupling` between pressure and strain, or without, as Carter has it.
    fn new(coupling: bool) -> Self {
        let half_plane = HalfPlane {
            kernel: 1.0 / (std::f64::consts::PI * modulus()),
            coupling: if coupling { (1.0 - 2.0 * NU) * (1.0 + NU) / YOUNG } else { 0.0 },
        };
        let line =
            LineLayout { share: 1.0, kernel: LineKernel::of_half_plane(half_plane, 1.0), ..LineLayout::default() };
        Self { solver: SeriesSolver::new(0.02), line, bodies: RigidBodies::new() }
    }

    /// Rolling at mean speed `speed` with prescribed creepage, in a step with the time formula `time`.
    fn roll(
        &self,
        (load, friction): (f64, f64),
        (speed, creepage): (f64, f64),
        time: TimeDerivative,
        start: &ContactState,
    ) -> Result<ContactState, ContactError> {
        let omega = speed * (1.0 - 0.5 * creepage) / RADIUS;
        let motion = [speed * (1.0 + 0.5 * creepage), omega, 0.0].map(|value| RigidMotion::held(value, 0.0));
        let step = Step {
            radius: RADIUS,
            lines: &[self.line],
            flexibility: None,
            load: [load, LOAD],
            motion,
            spin: Spin::default(),
            laws: (time, Friction::constant(friction)),
        };
        self.bodies.solve(&self.solver, &step, std::slice::from_ref(start)).map(|mut lines| lines.remove(0))
    }

    fn steady(&self, load: f64, share: f64) -> ContactState {
        let xi = share * carter_full_slip(FRICTION, hertz_half_width(load, RADIUS, modulus()), RADIUS);
        let start = self.solver.touching(hertz_half_width(LOAD, RADIUS, modulus()));
        self.roll((load, FRICTION), (10.0, xi), TimeDerivative::default(), &start).unwrap()
    }
}

/// The radius is that of a circle, whose curvature grows by `3x²/2r²` towards the edges: 1e-4 here. Compared with the
/// circle that osculates, forces and pressure agree to that; between loads of a hundredth and a quarter the difference
/// falls with the square of the half-width.
#[test]
fn pressure_is_that_of_hertz_on_a_parabola_to_the_square_of_half_width_over_radius() {
    let planes = HalfPlanes::new(true);
    let mut errors = Vec::new();
    for load in [LOAD, 0.01 * LOAD, 1e-4 * LOAD] {
        let start = planes.solver.touching(hertz_half_width(load, RADIUS, modulus()));
        let found = planes.roll((load, 0.0), (10.0, 0.0), TimeDerivative::default(), &start).unwrap();
        let a = hertz_half_width(load, RADIUS, modulus());
        let traction = &found.traction;
        let peak = hertz_peak_pressure(load, a);
        let error = (traction.half_width() / a - 1.0).abs().max((traction.pressure_max / peak - 1.0).abs());
        if load == LOAD {
            common::figure("points.hertz", &[error]);
        }
        println!("load {load:e}: {error:.2e} where a²/r² is {:.2e}", (a / RADIUS).powi(2));
        assert!((traction.resultant.height / load - 1.0).abs() < 1e-11);
        assert!(error < 0.5 * (a / RADIUS).powi(2) + 1e-12);
        errors.push(error);
    }
    assert!(errors[2] < 1e-7);
}

/// Carter's solution is in the space of the series, so that nothing but the curvature of the circle and the difference
/// of the speeds of both surfaces, which he leaves out, is left.
#[test]
fn force_and_stick_are_those_of_carter() {
    let planes = HalfPlanes::new(false);
    for load in [0.1 * LOAD, LOAD, 1.9 * LOAD] {
        for share in [-1.5, -0.9, -0.5, -0.1, -0.01, 0.01, 0.3, 0.7, 0.95, 1.2] {
            let found = planes.steady(load, share);
            let utilisation = found.traction.resultant.travel / (FRICTION * load);
            let full = carter_full_slip(FRICTION, hertz_half_width(load, RADIUS, modulus()), RADIUS);
            let error = utilisation - carter_force(share * full, full);
            let stick = found.traction.stick_fraction - (1.0 - f64::abs(share)).max(0.0);
            common::figure("points.carter", &[error]);
            println!("load {load:.1e}, {share:5.2} of full slip: force {error:9.2e}, stick {stick:9.2e}");
            assert!(error.abs() < 6e-4 && stick.abs() < 6e-4, "{error} {stick}");
        }
    }
}

/// No grid, no ripple: between loads that differ by less than a cell of any grid the force follows its smooth curve.
#[test]
fn force_has_no_ripple_while_the_load_varies() {
    let planes = HalfPlanes::new(true);
    let xi = 0.6 * carter_full_slip(FRICTION, hertz_half_width(LOAD, RADIUS, modulus()), RADIUS);
    let start = planes.solver.touching(hertz_half_width(LOAD, RADIUS, modulus()));
    let force = |k: i32| {
        let load = LOAD * (1.0 + 0.001 * f64::from(k));
        let found = planes.roll((load, FRICTION), (10.0, xi), TimeDerivative::default(), &start).unwrap();
        found.traction.resultant.travel / (FRICTION * LOAD)
    };
    let forces: Vec<f64> = (-150..=150).map(force).collect();
    // Fourth differences of a smooth curve over steps of 1e-3 vanish; a ripple of the amplitude A leaves up to 16 A.
    let fourth = |w: &[f64]| (w[0] - 4.0 * w[1] + 6.0 * w[2] - 4.0 * w[3] + w[4]).abs() / 16.0;
    let ripple = forces.windows(5).map(fourth).fold(0.0, f64::max);
    common::round_off("points.ripple", &[ripple], 1e-11);
    println!("ripple {ripple:.1e} of the friction limit");
    assert!(ripple < 1e-9);
}

/// From free rolling into creepage at once: the force tends to its steady value within a few half-widths of rolling,
/// from steps of a fiftieth of one as from steps of a half.
#[test]
fn a_step_of_creepage_ends_in_carters_state_whatever_the_steps() {
    let planes = HalfPlanes::new(false);
    let a = hertz_half_width(LOAD, RADIUS, modulus());
    let xi = 0.5 * carter_full_slip(FRICTION, a, RADIUS);
    let steady = planes.steady(LOAD, 0.5).traction.resultant.travel / (FRICTION * LOAD);
    let mut halfway = Vec::new();
    for steps_per_half_width in [50.0, 25.0, 12.0, 2.0] {
        let dt = a / (10.0 * steps_per_half_width);
        let first = TimeDerivative { a0: 1.0 / dt, a1: -1.0 / dt, a2: 0.0, b1: 0.0 };
        let bdf2 = TimeDerivative { a0: 1.5 / dt, a1: -2.0 / dt, a2: 0.5 / dt, b1: 0.0 };
        let mut state = planes.steady(LOAD, 0.001);
        let count = (20.0 * steps_per_half_width) as usize;
        for k in 0..count {
            state = planes.roll((LOAD, FRICTION), (10.0, xi), if k == 0 { first } else { bdf2 }, &state).unwrap();
            if k + 1 == steps_per_half_width as usize {
                halfway.push(state.traction.resultant.travel / (FRICTION * LOAD));
            }
        }
        let end = state.traction.resultant.travel / (FRICTION * LOAD);
        println!(
            "{steps_per_half_width} steps: after a half-width {:.4}, at the end {end:.5} of {steady:.5}",
            halfway[halfway.len() - 1]
        );
        assert!((end / steady - 1.0).abs() < 0.02);
    }
    assert!(
        (halfway[0] - halfway[1]).abs() < 0.02 * halfway[0].abs()
            && (halfway[0] - halfway[2]).abs() < 0.04 * halfway[0].abs()
    );
}

#[test]
fn what_is_no_single_smooth_patch_is_refused() {
    let planes = HalfPlanes::new(true);
    let start = planes.steady(LOAD, 0.3);
    let slow = TimeDerivative { a0: 1e6, a1: -1e6, a2: 0.0, b1: 0.0 };
    let refused = planes.roll((LOAD, FRICTION), (1.0, 1e-3), slow, &start);
    assert!(matches!(refused, Err(ContactError::Unsuited { .. })));
    let theta = TimeDerivative { a0: 2e3, a1: -2e3, a2: 0.0, b1: -1.0 };
    assert!(matches!(planes.roll((LOAD, FRICTION), (10.0, 1e-3), theta, &start), Err(ContactError::Unsuited { .. })));
    let wide = planes.roll((100.0 * LOAD, FRICTION), (10.0, 1e-3), TimeDerivative::default(), &start);
    assert!(matches!(wide, Err(ContactError::ZoneExceeded { .. })), "{wide:?}");
    assert!(matches!(start.solver, SolverState::Series(_)) && planes.solver.fits(&start));
}
