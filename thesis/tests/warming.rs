//! Heat in the thesis's steps of time: balance, stationary states, decomposed matrices and stabilisation that lags
//! behind.

use wheelrail_thesis::contact::Law;
use wheelrail_thesis::heat::{Heating, Spot, spots};
use wheelrail_thesis::mesh::Mesh;
use wheelrail_thesis::newton;
use wheelrail_thesis::rail::{self, Plate};
use wheelrail_thesis::rolling::{Motion, Parameters, System};
use wheelrail_thesis::stabilise::Scheme;
use wheelrail_thesis::triangle::Order;
use wheelrail_thesis::warming::Warming;
use wheelrail_thesis::wheel::{self, Annulus};

const ANNULUS: Annulus = Annulus { outer: 0.5, inner: 0.05 };
const SPEED: f64 = 50.0 / 3.6;
const MOTION: [f64; 2] = [SPEED / 0.5, SPEED];

/// Wheel and rail of Paper D and their contact under traction.
fn bodies() -> ([Mesh; 2], Vec<Spot>) {
    let half = 1.2e-3;
    let plate = Plate { length: 1.0, height: 0.1 };
    let wheel = wheel::rolling(ANNULUS, 1.5 * half, 0.5 * half, 1, 0.3).unwrap();
    let rail = rail::rolling(plate, 31, 2.0 * half, 0.5 * half);
    let law = Law { penalty: 5e12, friction: 0.4, regularisation: 1e-3 };
    let parameters =
        Parameters { annulus: ANNULUS, plate, young: 200e9, poisson: 0.3, density: 8000.0, load: 100e3, law };
    let system = System::new(parameters, &wheel, &rail, 2.0 * half);
    let motion = Motion { omega: 1.0008 * MOTION[0], velocity: SPEED };
    let touching = spots(&system, &newton::rolling(&system, motion).unwrap().0);
    assert!(touching.iter().map(|spot| spot.friction).sum::<f64>() > 100.0);
    ([wheel, rail], touching)
}

fn heating<'a>([wheel, rail]: &'a [Mesh; 2], spots: &'a [Spot], of: (Order, Scheme)) -> Heating<'a> {
    Heating {
        meshes: [wheel, rail],
        annulus: ANNULUS,
        wheel: of,
        material: [8000.0 * 460.0, 45.0],
        motion: MOTION,
        spots,
        contact: [1e7, 0.1],
        arcs: 30.0,
        cold_hub: true,
    }
}

/// In steps from a microsecond to an hour, with velocities that change, stop and turn round.
#[test]
fn heat_that_is_put_in_is_stored_or_leaves_in_every_step() {
    let (meshes, spots) = bodies();
    for of in [(Order::Linear, Scheme::Supg), (Order::Quadratic, Scheme::Bubble)] {
        let mut warming = Warming::new(heating(&meshes, &spots, of), 0.0, None);
        let mut worst = 0.0_f64;
        for (step, share) in [(1e-6, 1.0), (1e-3, 0.9), (1e-3, 0.9), (1.0, 0.5), (10.0, 0.0), (3600.0, -1.0)] {
            let flows = warming.advance(step, MOTION.map(|v| share * v), &spots, 30.0).unwrap();
            worst = worst.max(flows.imbalance());
        }
        println!("{of:?}: imbalance {worst:.1e}, means {:.3?} K", warming.means());
        assert!(worst < 1e-8 && warming.means()[0] > 0.0);
    }
}

/// A stationary state stays so, and a cold wheel comes to it.
#[test]
fn the_stationary_temperatures_are_those_that_time_steps_keep_and_reach() {
    let (meshes, spots) = bodies();
    let of = heating(&meshes, &spots, (Order::Quadratic, Scheme::Bubble));
    let still = of.solve().unwrap();
    let largest = still.theta.iter().fold(0.0_f64, |most, t| most.max(t.abs()));
    for (start, step, count, tolerance) in [(Some(still.theta.clone()), 1e-3, 3, 1e-9), (None, 1e6, 12, 1e-6)] {
        let mut warming = Warming::new(of, 0.0, start);
        for _ in 0..count {
            warming.advance(step, MOTION, &spots, 30.0).unwrap();
        }
        let off = warming.theta.iter().zip(&still.theta).fold(0.0_f64, |worst, (a, b)| worst.max((a - b).abs()));
        println!("{step} s: off by {:.1e} of {largest:.3} K", off / largest);
        assert!(off < tolerance * largest);
        assert_eq!(warming.assemblies, 1);
    }
}

/// The sum of constant matrices is the matrix that would be assembled; stabilisation is as old as it may be.
#[test]
fn decomposed_matrices_are_those_assembled_anew_but_for_stabilisation_that_lags() {
    let (meshes, spots) = bodies();
    let apart = |tolerance: f64, of: (Order, Scheme)| {
        let mut warming = Warming::new(heating(&meshes, &spots, of), tolerance, None);
        let unit: Vec<f64> = (0..warming.theta.len()).map(|i| (1.7 * i as f64).sin()).collect();
        let mut worst = 0.0_f64;
        for k in 0..=20 {
            let motion = MOTION.map(|v| (1.0 - 0.01 * f64::from(k)) * v);
            let anew = Heating { motion, ..heating(&meshes, &spots, of) };
            let exact = anew.stabilised(&anew.spaces());
            warming.renew(motion);
            let (a, b) = (warming.matrix(motion).multiply(&unit), exact.multiply(&unit));
            let largest = b.iter().fold(0.0_f64, |most, b| most.max(b.abs()));
            worst = a.iter().zip(&b).fold(worst, |worst, (a, b)| worst.max((a - b).abs() / largest));
        }
        (worst, warming.assemblies)
    };
    for of in [(Order::Linear, Scheme::Supg), (Order::Quadratic, Scheme::Bubble)] {
        let (fresh, each) = apart(0.0, of);
        let (lagging, some) = apart(0.0499, of);
        println!("{of:?}: {fresh:.1e} with {each} assemblies, {lagging:.1e} with {some}");
        assert!(fresh < 1e-12 && each == 21);
        assert!(lagging > 1e-4 && lagging < 0.2 && some == 5);
    }
}

/// With a Galerkin wheel all stabilisation is the rail's. From 50 to 10 km/h every element has a large Péclet number,
/// so that nothing is assembled again and the sum is what would be; where the rail nearly stands small ones join, and
/// those between the ranges are assembled.
#[test]
fn supg_of_the_rail_joins_the_sums_where_peclet_numbers_are_small_or_large() {
    let (meshes, spots) = bodies();
    let of = (Order::Linear, Scheme::Galerkin);
    let apart = |speeds: [f64; 2], tolerance: f64| {
        let mut warming = Warming::new(heating(&meshes, &spots, of), tolerance, None);
        let share = warming.split(speeds);
        let unit: Vec<f64> = (0..warming.theta.len()).map(|i| (1.7 * i as f64).sin()).collect();
        let mut worst = 0.0_f64;
        for k in 0..=10 {
            let velocity = speeds[0] + 0.1 * f64::from(k) * (speeds[1] - speeds[0]);
            for motion in [[MOTION[0], velocity], [MOTION[0], -velocity]] {
                let anew = Heating { motion, ..heating(&meshes, &spots, of) };
                let (exact, plain) = (anew.stabilised(&anew.spaces()), anew);
                let plain = Heating { motion: [motion[0], 0.0], ..plain }.stabilised(&anew.spaces());
                warming.renew(motion);
                let [a, b, c] = [&warming.matrix(motion), &exact, &plain].map(|matrix| matrix.multiply(&unit));
                let largest = b.iter().zip(&c).fold(0.0_f64, |most, (b, c)| most.max((b - c).abs()));
                worst = a.iter().zip(&b).fold(worst, |worst, (a, b)| worst.max((a - b).abs() / largest));
            }
        }
        println!(
            "{speeds:?} m/s: {:.1} % of the elements, off by {worst:.1e}, {} assemblies",
            100.0 * share,
            warming.assemblies
        );
        (share, worst, warming.assemblies)
    };
    let fast = apart([10.0 / 3.6, 50.0 / 3.6], 1e3);
    assert!(fast.0 == 1.0 && fast.1 < 1e-9 && fast.2 == 1);
    let (share, off, _) = apart([1e-6, 1e-3], 0.0);
    assert!((0.3..1.0).contains(&share) && off < 2e-3);
}

/// Braking within ten seconds: how much a tolerance of 5 % changes the temperatures, and that half of it changes half.
#[test]
fn temperatures_of_braking_converge_with_the_tolerance_of_the_stabilisation() {
    let (meshes, spots) = bodies();
    let brake = |tolerance: f64| {
        let mut warming = Warming::new(heating(&meshes, &spots, (Order::Linear, Scheme::Supg)), tolerance, None);
        for k in 1..=100 {
            let motion = MOTION.map(|v| (1.0 - 0.008 * f64::from(k)) * v);
            assert!(warming.advance(0.1, motion, &spots, 0.0).unwrap().imbalance() < 1e-8);
        }
        (warming.theta, warming.assemblies)
    };
    let (exact, _) = brake(0.0);
    let largest = exact.iter().fold(0.0_f64, |most, t| most.max(t.abs()));
    let off = [0.2, 0.05].map(|tolerance| {
        let (theta, assemblies) = brake(tolerance);
        let off = theta.iter().zip(&exact).fold(0.0_f64, |worst, (a, b)| worst.max((a - b).abs())) / largest;
        println!("tolerance {tolerance}: {assemblies} assemblies, temperatures off by {off:.1e}");
        off
    });
    assert!(off[1] < 0.02 && off[1] < 0.6 * off[0]);
}
