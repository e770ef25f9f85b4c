//! Paper A's scheme in time and the stationary heat of rolling on triangles.

use wheelrail_thesis::contact::Law;
use wheelrail_thesis::elastic;
use wheelrail_thesis::heat::{Heating, spots};
use wheelrail_thesis::newton;
use wheelrail_thesis::paper_a::{self as a, BASE, PLATE, case, meshes};
use wheelrail_thesis::rail::{self, Plate};
use wheelrail_thesis::rolling::{Parameters, System};
use wheelrail_thesis::stabilise::Scheme;
use wheelrail_thesis::transient::{Case, Rolling, STEEL};
use wheelrail_thesis::triangle::{Order, Space};
use wheelrail_thesis::wheel::{self, Annulus};

#[test]
fn mass_convection_and_dashpots_have_their_totals() {
    let plate = Plate { length: 1.0, height: 0.1 };
    let mesh = rail::coarse(plate, 11, 4);
    let space = Space::new(&mesh, Order::Linear);
    let along = |matrix: &wheelrail_thesis::sparse::Matrix, axis: usize| {
        let unit: Vec<f64> = (0..matrix.size).map(|i| if i % 2 == axis { 1.0 } else { 0.0 }).collect();
        matrix.multiply(&unit).iter().zip(&unit).map(|(force, unit)| force * unit).sum::<f64>()
    };
    let [young, poisson, density] = STEEL;
    assert!((along(&elastic::mass(&space, density), 0) / 800.0 - 1.0).abs() < 1e-12);
    // A rigid motion is convected into nothing; C + Cᵀ acts on the ends alone.
    let convection = elastic::gyroscopic(&space, density, |_| [-20.0, 0.0]);
    let bump: Vec<f64> =
        mesh.nodes.iter().flat_map(|[x, _]| [if x.abs() < 0.4 { 0.16 - x * x } else { 0.0 }, 0.0]).collect();
    let power: f64 = convection.multiply(&bump).iter().zip(&bump).map(|(force, u)| force * u).sum();
    assert!(along(&convection, 0).abs() < 1e-9 && power.abs() < 1e-9, "{power}");
    let shear = 0.5 * young / (1.0 + poisson);
    let wave = 2.0 * shear * (1.0 - poisson) / (1.0 - 2.0 * poisson);
    let dashpots = elastic::dashpots(&mesh, plate, STEEL);
    for (axis, modulus) in [(0, wave), (1, shear)] {
        let both = 0.2 * (density * modulus).sqrt();
        assert!((along(&dashpots, axis) / both - 1.0).abs() < 1e-12);
    }
}

#[test]
fn a_wheel_at_rest_on_a_smooth_rail_stays_so_and_one_on_waves_swings_as_stated() {
    let bodies = meshes(BASE, 3, 31, PLATE);
    let mut rolling = Rolling::new(case(), &bodies.wheel, &bodies.rail, &|_| 0.0).unwrap();
    // Paper A does not correct the centre of gravity: its mesh adds a centrifugal force of its own to the load.
    let first = rolling.force();
    println!("{:.4} of the load", first / a::LOAD);
    assert!((first / a::LOAD - 1.0).abs() < 0.01);
    for _ in 0..50 {
        rolling.advance(&|_| 0.0).unwrap();
        assert!((rolling.force() / first - 1.0).abs() < 1e-6, "{} {first}", rolling.force());
        assert!(rolling.forces.iter().all(|force| *force >= 0.0));
    }
    // Closed form 0.5565 MN/m; the mesh is that of the thesis's size.
    let found = a::amplitude(case(), &bodies).unwrap();
    let fine = a::amplitude(Case { step: 1e-5, ..case() }, &bodies).unwrap();
    println!("{} triangles: {found:.0} N/m, {:.4} times as much with 1e-5 s", bodies.count(), fine / found);
    assert!((found / 0.5565e6 - 1.0).abs() < 0.04 && (fine / found - 1.01).abs() < 0.01);
}

#[test]
fn heat_of_the_arcs_leaves_through_the_contact_but_for_what_chords_let_in() {
    let (annulus, plate) = (Annulus { outer: 0.5, inner: 0.05 }, Plate { length: 1.0, height: 0.1 });
    let (half, load) = (0.24066e-3, 10e3);
    let law = Law { penalty: 5e12, friction: 0.0, regularisation: 1.0 };
    let wheel = wheel::rolling(annulus, 2.0 * half, 0.3 * half, 0, 0.3).unwrap();
    let rail = rail::rolling(plate, 31, 2.0 * half, 0.3 * half);
    let parameters = Parameters { annulus, plate, young: 200e9, poisson: 0.3, density: 8000.0, load, law };
    let system = System::new(parameters, &wheel, &rail, 2.0 * half);
    let touching = spots(&system, &newton::frictionless(&system).unwrap());
    let width: f64 = touching.iter().map(|spot| spot.length).sum();
    assert!((width / (2.0 * half) - 1.0).abs() < 0.35, "{width}");
    let speed = 50.0 / 3.6;
    for (order, scheme, omega) in [
        (Order::Linear, Scheme::Supg, speed / 0.5),
        (Order::Quadratic, Scheme::Bubble, speed / 0.5),
        (Order::Quadratic, Scheme::Bubble, 0.0),
    ] {
        let heating = Heating {
            meshes: [&wheel, &rail],
            annulus,
            wheel: (order, scheme),
            material: [8000.0 * 460.0, 45.0],
            motion: [omega, speed],
            spots: &touching,
            contact: [1e7, 0.1],
            arcs: 30.0,
            cold_hub: false,
        };
        let warmth = heating.solve().unwrap();
        let (arrives, let_in) = (warmth.flows[0], heating.let_in(&warmth.space, &warmth.theta));
        println!(
            "{order:?} {scheme:?} {omega:.1} rad/s: {arrives:.4} W/m arrive, {let_in:.4} let in, means {:.3?}",
            warmth.means
        );
        assert!(warmth.means[0] > warmth.means[1] && warmth.means[1] > 0.0);
        assert!(omega > 0.0 || let_in == 0.0);
        assert!(((arrives - let_in) / 60.0 - 1.0).abs() < 1e-6, "{arrives} {let_in}");
        // Reactions of the held nodes: nothing at the insulated hub, and what arrives at the ends of the rail.
        let imbalance = heating.imbalance(&warmth);
        println!("leaves {:.4?} W/m, imbalance {imbalance:.1e}", warmth.leaves);
        assert!(warmth.leaves[0] == 0.0 && imbalance < 1e-8);
        assert!((arrives / 60.0 - 1.0).abs() < 0.2);
    }
}
