//! The computation of the example `strip`, and its like on an ellipse, against closed forms.

use wheelrail_contact::numerics::analytic::{carter_force, carter_full_slip, hertz_half_width};
use wheelrail_contact::patch::Hertz;
use wheelrail_contact::{ContactError, Creepages, ElasticMaterial, Friction, RollingContact, RollingStep};

const STEEL: ElasticMaterial = ElasticMaterial { youngs_modulus: 210e9, poissons_ratio: 0.3 };
/// Radius of the wheel \[m], load of a strip [N/m] and friction coefficient \[1].
const RADIUS: f64 = 0.46;
const LOAD: f64 = 1e6;
const FRICTION: f64 = 0.3;

/// A step of rolling under a load with creepages.
fn step(load: f64, creepages: Creepages, distance: f64) -> RollingStep {
    RollingStep { load, speed: 20.0, creepages, friction: Friction::constant(FRICTION), distance }
}

/// Creepage along alone.
fn along(creepage: f64) -> Creepages {
    Creepages { along: creepage, ..Creepages::default() }
}

fn half_width(load: f64) -> f64 {
    hertz_half_width(load, RADIUS, STEEL.contact_modulus())
}

#[test]
fn forces_and_stick_of_a_strip_are_those_of_carter_in_both_directions() {
    let mut wheel = RollingContact::cylinder(STEEL, RADIUS, LOAD, 0.1);
    for load in [0.7 * LOAD, LOAD, 1.5 * LOAD] {
        let full_slip = carter_full_slip(FRICTION, half_width(load), RADIUS);
        for share in [0.1, 0.3, 0.5, 0.7, 0.9, 1.1, -0.2, -0.6, -1.5] {
            wheel.roll(&step(load, along(share * full_slip), 0.0)).unwrap();
            let force = wheel.forces().travel / (FRICTION * load);
            let errors =
                [force / carter_force(share, 1.0) - 1.0, wheel.stick_fraction() - (1.0 - share.abs()).max(0.0)];
            let (_, line) = wheel.lines().next().unwrap();
            let width = line.half_width() / half_width(load) - 1.0;
            println!("{share}: force {:+.1e}, stick {:+.1e}, half-width {width:+.1e}", errors[0], errors[1]);
            assert!((wheel.forces().height / load - 1.0).abs() < 1e-6, "{}", wheel.forces().height);
            assert!(errors[0].abs() < 0.01 && errors[1].abs() < 0.005 && width.abs() < 0.005, "{share}: {errors:?}");
        }
    }
}

#[test]
fn a_strip_that_rolls_on_under_a_new_creepage_arrives_at_the_force_of_carter() {
    let mut wheel = RollingContact::cylinder(STEEL, RADIUS, LOAD, 0.1);
    let creepage = 0.5 * carter_full_slip(FRICTION, half_width(LOAD), RADIUS);
    wheel.roll(&step(LOAD, along(0.0), 0.0)).unwrap();
    assert!(wheel.forces().travel.abs() < 1e-3 * FRICTION * LOAD);
    let mut before = 0.0;
    for _ in 0..120 {
        wheel.roll(&step(LOAD, along(creepage), 0.25 * half_width(LOAD))).unwrap();
        let force = -wheel.forces().travel / (FRICTION * LOAD);
        assert!(force > before - 1e-3, "{force} after {before}");
        before = force;
    }
    println!("after 30 a: {before:.5}");
    assert!((before / 0.75 - 1.0).abs() < 0.01 && (wheel.stick_fraction() - 0.5).abs() < 0.005, "{before}");
}

/// Half axes of Hertz, and Kalker's coefficients for ν = 0.3 on a circle by CONTACT on 61 × 41 elements at 2 % of
/// friction: C₁₁, C₂₂ and C₂₃.
#[test]
fn an_ellipse_has_the_axes_of_hertz_and_the_creep_coefficients_of_kalker() {
    let (load, radius) = (80e3, 0.4);
    let mut wheel = RollingContact::ellipse(STEEL, [radius, radius], load, 7);
    let ellipse = Hertz::new(radius, radius, STEEL.contact_modulus()).under(load);
    let shear_modulus = 0.5 * STEEL.youngs_modulus / (1.0 + STEEL.poissons_ratio);
    let unit = shear_modulus * ellipse.a * ellipse.b;
    let small = 0.01 * FRICTION * load / (4.0 * unit);
    let linear = |wheel: &mut RollingContact, creepages: Creepages| {
        wheel.roll(&step(load, creepages, 0.0)).unwrap();
        let forces = wheel.forces();
        [-forces.travel / (unit * small), -forces.lateral / (unit * small), forces.height / load]
    };
    let [c11, _, carried] = linear(&mut wheel, along(small));
    let middle = wheel.lines().map(|(_, line)| line.half_width()).fold(0.0, f64::max) / ellipse.a - 1.0;
    let [_, c22, _] = linear(&mut wheel, Creepages { across: small, ..Creepages::default() });
    println!("C11 {c11:.3}, C22 {c22:.3}, half axis {middle:+.1e}, load {carried:.6}");
    assert!((c11 / 4.2769 - 1.0).abs() < 0.02 && (c22 / 3.7151 - 1.0).abs() < 0.02, "{c11} {c22}");
    assert!(middle.abs() < 2e-3 && (carried - 1.0).abs() < 1e-6, "{middle} {carried}");
    let spin = small / ellipse.a;
    wheel.roll(&step(load, Creepages { spin, ..Creepages::default() }, 0.0)).unwrap();
    let c23 = wheel.forces().lateral.abs() / (unit * (ellipse.a * ellipse.b).sqrt() * spin);
    println!("C23 {c23:.4}");
    assert!((c23 / 1.5055 - 1.0).abs() < 0.02 && wheel.spin_moment() != 0.0, "{c23}");
}

#[test]
fn a_patch_longer_than_the_grid_is_refused_and_the_contact_stays_as_it_was() {
    let mut wheel = RollingContact::cylinder(STEEL, RADIUS, LOAD, 0.1);
    wheel.roll(&step(LOAD, along(1e-3), 0.0)).unwrap();
    let before = wheel.forces();
    let refused = wheel.roll(&step(10.0 * LOAD, along(1e-3), 0.0));
    assert!(matches!(refused, Err(ContactError::ZoneExceeded { .. })), "{refused:?}");
    assert_eq!(wheel.forces(), before);
    wheel.roll(&step(LOAD, along(1e-3), 0.0)).unwrap();
}
