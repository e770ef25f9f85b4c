//! History of hot material: spots that take over the field of a standing contact and conduct it on by themselves.

use crate::common;
use std::f64::consts::PI;
use wheelrail::damage::{Criteria, Damage, HotSpots, PointHistory, SpotLayout, TreadStep};

const REFERENCE: f64 = 293.0;
const CONDUCTIVITY: f64 = 50.0;
const HEAT_CAPACITY: f64 = 7850.0 * 470.0;
const DIFFUSIVITY: f64 = CONDUCTIVITY / HEAT_CAPACITY;
const RADIUS: f64 = 0.46;
const HALF_WIDTH: f64 = 7e-3;
const CRITERIA: Criteria =
    Criteria { austenitisation: 1000.0, martensite_start: 575.0, critical_cooling: 50.0, threshold: 300.0 };

fn wheel(resolution: f64) -> HotSpots {
    HotSpots::new(&SpotLayout {
        radius: RADIUS,
        hub_radius: 0.046,
        half_width: HALF_WIDTH,
        zone: 0.012,
        conductivity: CONDUCTIVITY,
        heat_capacity: HEAT_CAPACITY,
        convection: 0.0,
        reference: REFERENCE,
        resolution,
    })
}

/// Step of a wheel whose tread has the excess temperature `hottest` in the contact, with the angle `angle`. The contact
/// is known for all of a spot.
fn moment(dt: f64, angle: f64, omega: f64, hottest: f64) -> TreadStep<'static> {
    let hottest = [hottest, 0.0];
    let surface: (&[f64], &[f64]) = (&[], &[]);
    let (contact_length, contact_reach) = (0.0, 1.0);
    let (interim, bulk, criteria) = (false, 0.0, CRITERIA);
    TreadStep { dt, interim, angle, omega, contact_length, contact_reach, hottest, bulk, surface, criteria }
}

/// `erfc x` of a positive number: the series for small ones, the continued fraction for large ones.
fn erfc(x: f64) -> f64 {
    if x < 2.5 {
        let (mut term, mut sum) = (x, x);
        for n in 1..80 {
            term *= -x * x / n as f64;
            sum += term / (2 * n + 1) as f64;
        }
        1.0 - 2.0 / PI.sqrt() * sum
    } else {
        let fraction = (1..60).rev().fold(0.0, |f, n| 0.5 * n as f64 / (x + f));
        (-x * x).exp() / PI.sqrt() / (x + fraction)
    }
}

/// Excess temperature of a half-space at the depth `z` after the flux of `q` for the time `t0`, at the time `t`
/// (Carslaw & Jaeger, *Conduction of Heat in Solids*, section 2.9).
fn half_space(q: f64, t0: f64, z: f64, t: f64) -> f64 {
    let heated = |t: f64| {
        if t <= 0.0 {
            return 0.0;
        }
        let length = (DIFFUSIVITY * t).sqrt();
        let x = 0.5 * z / length;
        2.0 * q / CONDUCTIVITY * length * ((-x * x).exp() / PI.sqrt() - x * erfc(x))
    };
    heated(t) - heated(t - t0)
}

/// Flux that heats the surface of a half-space by `excess` within `t0`.
fn flux(excess: f64, t0: f64) -> f64 {
    0.5 * excess * CONDUCTIVITY * (PI / (DIFFUSIVITY * t0)).sqrt()
}

/// History of a half-space heated for `t0` in ten steps and then released, followed for `end` in steps of `dt`.
fn released(spots: &HotSpots, excess: f64, t0: f64, end: f64, dt: f64) -> Damage {
    let q = flux(excess, t0);
    let depth = spots.mesh().depth.clone();
    let mut damage = spots.begin([0.0; 2]);
    let steps = 200;
    for k in 1..=steps {
        let time = t0 * k as f64 / steps as f64;
        let sample = |_: f64, column: &mut [f64]| {
            column.iter_mut().zip(&depth).for_each(|(t, z)| *t = half_space(q, t0, *z, time));
        };
        spots.advance(
            &mut damage,
            &moment(t0 / steps as f64, 0.0, 0.0, half_space(q, t0, 0.0, time)),
            &sample,
            &mut Default::default(),
        );
    }
    for k in 1..=(end / dt).round() as usize {
        let untouched = |_: f64, _: &mut [f64]| panic!("the contact is far away");
        spots.advance(&mut damage, &moment(dt, 30.0 * dt * k as f64, 30.0, 0.0), &untouched, &mut Default::default());
    }
    damage
}

/// The time at which a falling function reaches a level.
fn falls_to(level: f64, mut low: f64, mut high: f64, f: impl Fn(f64) -> f64) -> f64 {
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if f(middle) > level { low = middle } else { high = middle }
    }
    low
}

/// Cooling rate 800 to 500 °C of the surface and depth of Ac1 in closed form.
fn closed_form(excess: f64, t0: f64) -> [f64; 2] {
    let q = flux(excess, t0);
    let surface = |t: f64| REFERENCE + half_space(q, t0, 0.0, t);
    let [from, to] = [1073.15, 773.15].map(|level| falls_to(level, t0, 100.0 * t0, surface));
    let peak = |z: f64| (0..4000).map(|k| half_space(q, t0, z, t0 * (1.0 + 1e-3 * k as f64))).fold(0.0, f64::max);
    let depth = falls_to(CRITERIA.austenitisation - REFERENCE, 0.0, 0.04, peak);
    [300.0 / (to - from), depth]
}

#[test]
fn a_released_half_space_cools_as_in_closed_form() {
    let spots = wheel(1.0);
    for (excess, t0, dt) in [(1100.0, 2.0, 1e-3), (1100.0, 0.2, 1e-3), (900.0, 5e-3, 1e-4), (1100.0, 2.0, 0.05)] {
        let found = released(&spots, excess, t0, 5.0 * t0, dt).findings();
        let [rate, depth] = closed_form(excess, t0);
        if dt == 1e-3 {
            common::figure(
                &format!("released.{t0}"),
                &[found.cooling_rate / rate - 1.0, found.ac1_depth / depth - 1.0],
            );
        }
        println!(
            "{t0} s, steps of {dt} s: peak {:.1} K ({:.1}), {:.1} K/s ({rate:.1}), Ac1 to {:.4} mm ({:.4}), martensite to {:.4} mm, \
             above Ac1 {:.4} s",
            found.peak,
            REFERENCE + excess,
            found.cooling_rate,
            1e3 * found.ac1_depth,
            1e3 * depth,
            1e3 * found.martensite_depth,
            found.above_ac1
        );
        assert!((found.peak / (REFERENCE + excess) - 1.0).abs() < 1e-9);
        assert!((found.cooling_rate / rate - 1.0).abs() < 0.05, "{} and {rate} K/s", found.cooling_rate);
        assert!((found.ac1_depth / depth - 1.0).abs() < 0.05, "{} and {depth} m", found.ac1_depth);
    }
}

/// Between communication points a standing place is looked at less often; what is known at them is the same.
#[test]
fn internal_steps_change_nothing_at_communication_points() {
    let spots = wheel(1.0);
    let (depth, q, dt) = (&spots.mesh().depth, flux(1100.0, 0.2), 2e-4);
    let [mut all, mut few] = [0, 1].map(|_| spots.begin([0.0; 2]));
    for k in 1..=1000 {
        let time = dt * f64::from(k);
        let sample = |_: f64, column: &mut [f64]| {
            column.iter_mut().zip(depth).for_each(|(t, z)| *t = half_space(q, 0.2, *z, time));
        };
        let now = moment(dt, 0.0, 0.0, half_space(q, 0.2, 0.0, time));
        spots.advance(&mut all, &now, &sample, &mut Default::default());
        let interim = TreadStep { interim: k % 5 != 0, ..now };
        spots.advance(&mut few, &interim, &sample, &mut Default::default());
        if k % 5 == 0 {
            let [a, b] = [&all, &few].map(|damage| damage.findings());
            assert!((a.peak, a.ac1_depth) == (b.peak, b.ac1_depth), "{time} s: {a:?} and {b:?}");
        }
    }
    let [a, b] = [&all, &few].map(|damage| damage.findings().above_ac1);
    println!("above Ac1 for {a} and {b} s");
    assert!(a > 0.1 && (a - b).abs() < 0.2 * dt);
}

#[test]
fn extremes_over_the_depth_are_those_of_the_place_that_took_most_heat() {
    let spots = wheel(1.0);
    let damage = released(&spots, 1100.0, 0.2, 4.0, 1e-3);
    let (worst, found, depth) = (&damage.worst, damage.findings(), &spots.mesh().depth);
    // All columns are heated alike, so that none is hotter than another; the place is one of them.
    let arcs = &spots.mesh().arc;
    assert!((arcs[0]..=arcs[arcs.len() - 1]).contains(&(worst.hottest - damage.spots[0].arc)), "{}", worst.hottest);
    let round = 2.0 * PI * RADIUS;
    let apart = (spots.hottest_angle(&damage).unwrap() * RADIUS - worst.hottest).rem_euclid(round);
    assert!(apart.min(round - apart) < 1e-9, "{apart}");
    assert_eq!(worst.peaks.iter().fold(0.0, |a: f64, b| a.max(*b)), found.peak);
    let excess: Vec<f64> = worst.peaks.iter().map(|peak| peak - REFERENCE).collect();
    let heat: f64 = (1..depth.len()).map(|k| 0.5 * (depth[k] - depth[k - 1]) * (excess[k] + excess[k - 1])).sum();
    assert!((worst.heat / heat - 1.0).abs() < 0.05, "{} and {heat} K m", worst.heat);
    let martensite = damage.martensite();
    let half = martensite.iter().rposition(|share| *share >= 0.5).unwrap();
    assert!(depth[half] <= found.martensite_depth && found.martensite_depth < depth[half + 1]);
    assert!(martensite.iter().all(|share| (0.0..1.0).contains(share)));
    // A wheel without such a place knows none.
    let cold = spots.begin([0.0; 2]);
    assert_eq!((spots.hottest_angle(&cold), cold.hot_places()), (None, 0));
    assert_eq!(damage.hot_places(), usize::from(damage.spots[0].is_hot()));
}

#[test]
fn what_was_found_converges_in_mesh_and_step() {
    let all = [2.0, 1.0, 0.5].map(|resolution| released(&wheel(resolution), 1100.0, 0.5, 8.0, 1e-3).findings());
    let [rate, depth] = closed_form(1100.0, 0.5);
    for found in &all {
        println!(
            "{:.2} K/s ({rate:.2}), Ac1 to {:.5} mm ({:.5}), martensite to {:.5} mm, above Ac1 {:.5} s",
            found.cooling_rate,
            1e3 * found.ac1_depth,
            1e3 * depth,
            1e3 * found.martensite_depth,
            found.above_ac1
        );
    }
    let errors = all.map(|found| (found.cooling_rate / rate - 1.0).abs().max((found.ac1_depth / depth - 1.0).abs()));
    common::figure("released.coarse", &errors);
    println!("errors {errors:.5?}");
    assert!(errors[1] < 0.05 && errors[2] < 0.02);
    let [_, usual, fine] = all;
    assert!(usual.martensite_depth > 0.0);
    for (a, b) in [(usual.martensite_depth, fine.martensite_depth), (usual.above_ac1, fine.above_ac1)] {
        assert!((a / b - 1.0).abs() < 0.05, "{a} and {b}");
    }
}

/// A Gaussian on the surface of a half-space spreads as a Gaussian.
#[test]
fn a_spot_conducts_in_both_directions_with_second_order() {
    let (size, end) = (4e-3f64, 0.5);
    let shape = |s: f64, z: f64, t: f64| {
        let wide = size * size + 4.0 * DIFFUSIVITY * t;
        1000.0 * size * size / wide * (-(s * s + z * z) / wide).exp()
    };
    let error = |resolution: f64| {
        let spots = wheel(resolution);
        let depth = spots.mesh().depth.clone();
        let sample = |s: f64, column: &mut [f64]| {
            column.iter_mut().zip(&depth).for_each(|(t, z)| *t = shape(s, *z, 0.0));
        };
        let mut damage = Damage::default();
        spots.advance(&mut damage, &moment(1e-3, 0.0, 0.0, 1000.0), &sample, &mut Default::default());
        for k in 1..=500 {
            spots.advance(
                &mut damage,
                &moment(end / 500.0, 0.03 * k as f64, 30.0, 0.0),
                &sample,
                &mut Default::default(),
            );
        }
        let field = damage.spots[0].field().unwrap();
        let (mesh, mut worst) = (spots.mesh(), 0.0f64);
        for (s, column) in mesh.arc.iter().zip(field.temperature.chunks_exact(depth.len())) {
            for (z, t) in depth.iter().zip(column) {
                worst = worst.max((t - shape(*s, *z, field.age)).abs());
            }
        }
        worst / shape(0.0, 0.0, field.age)
    };
    let errors = [4.0, 2.0, 1.0].map(error);
    println!("errors {errors:.5?} of the peak");
    assert!(errors[2] < 0.02);
    assert!(errors[0] / errors[1] > 2.5, "{errors:?}");
}

#[test]
fn nothing_hot_leaves_no_spot_and_no_memory() {
    let spots = wheel(1.0);
    let mut damage = spots.begin([0.0; 2]);
    let sample = |_: f64, _: &mut [f64]| panic!("nobody asks");
    for k in 0..100 {
        spots.advance(&mut damage, &moment(1e-3, 0.0, 0.0, 2.9 * k as f64), &sample, &mut Default::default());
    }
    assert!(damage.spots.is_empty() && damage.spots.capacity() == 0 && damage.places == 0);
    assert!((damage.peak - (REFERENCE + 2.9 * 99.0)).abs() < 1e-9);
    // Hot, but so fast that no place is heated on its own.
    spots.advance(&mut damage, &moment(1e-3, 0.0, 20.0, 600.0), &sample, &mut Default::default());
    assert!(damage.spots.is_empty());
}

/// Heats a place for a step at the angle given.
fn heat(spots: &HotSpots, damage: &mut Damage, angle: f64, excess: f64) {
    let depth = spots.mesh().depth.clone();
    let sample = move |s: f64, column: &mut [f64]| {
        let flank = (-(s / HALF_WIDTH).powi(2)).exp();
        column.iter_mut().zip(&depth).for_each(|(t, z)| *t = excess * flank * (-z / 1e-3).exp());
    };
    for _ in 0..2 {
        spots.advance(damage, &moment(1e-3, angle, 0.0, excess), &sample, &mut Default::default());
    }
}

#[test]
fn several_flats_are_kept_apart_and_the_same_place_is_found_again() {
    let spots = wheel(1.0);
    let mut damage = spots.begin([0.0; 2]);
    for (k, excess) in [800.0, 1000.0, 900.0].into_iter().enumerate() {
        heat(&spots, &mut damage, 1.3 * k as f64, excess);
    }
    assert_eq!(damage.places, 3);
    let peaks: Vec<f64> = damage.spots.iter().map(|spot| spot.findings().peak - REFERENCE).collect();
    assert!(peaks.iter().zip([800.0, 1000.0, 900.0]).all(|(a, b)| (a - b).abs() < 1e-9), "{peaks:?}");
    // Two turns on, half a half-width beside the second.
    let again = 1.3 + 4.0 * PI + 0.5 * HALF_WIDTH / RADIUS;
    heat(&spots, &mut damage, again, 1200.0);
    assert_eq!(damage.places, 3);
    assert!(damage.spots[1].findings().peak > REFERENCE + 1150.0);
    // The list is bounded; what is forgotten still counts.
    for k in 0..9 {
        heat(&spots, &mut damage, 4.0 + 0.2 * k as f64, 600.0);
    }
    assert_eq!((damage.places, damage.spots.len()), (12, 8));
    assert!(damage.findings().peak > REFERENCE + 1150.0);
}

#[test]
fn a_hot_place_that_comes_back_keeps_its_heat_without_a_jump() {
    let spots = wheel(1.0);
    let mut damage = spots.begin([0.0; 2]);
    heat(&spots, &mut damage, 0.0, 1000.0);
    let cold = |_: f64, column: &mut [f64]| column.fill(0.0);
    for k in 1..=100 {
        spots.advance(&mut damage, &moment(1e-4, 30.0 * 1e-4 * k as f64, 30.0, 0.0), &cold, &mut Default::default());
    }
    let centre = |damage: &Damage| damage.spots[0].field().unwrap().temperature.iter().copied().fold(0.0, f64::max);
    let before = centre(&damage);
    // Locked at the same place, where the contact now knows of 400 K at the surface only.
    let warm = |_: f64, column: &mut [f64]| {
        column.fill(0.0);
        column[0] = 400.0;
    };
    spots.advance(&mut damage, &moment(1e-6, 0.0, 0.0, 400.0), &warm, &mut Default::default());
    let after = centre(&damage);
    println!("{before:.2} K before, {after:.2} K after");
    assert!(damage.spots.len() == 1 && damage.spots[0].following);
    assert!((after / before - 1.0).abs() < 0.01);
}

#[test]
fn a_place_that_has_cooled_is_at_rest_and_what_was_found_stays() {
    let spots = wheel(1.0);
    let damage = released(&spots, 1000.0, 0.01, 20.0, 0.05);
    assert!(!damage.spots[0].is_hot());
    let found = damage.findings();
    println!("{found:?}");
    assert!(
        found.ac1_depth > 0.0
            && found.cooling_rate > 0.0
            && (found.martensite_depth / found.ac1_depth - 1.0).abs() < 1e-9
    );
}

/// A second slide on the same place: below Ac1 its martensite stays, above it there is none until it has cooled again. The depth and
/// the shares over the depth say the same.
#[test]
fn martensite_that_becomes_austenite_again_is_gone_until_it_has_cooled() {
    let spots = wheel(1.0);
    let agree = |damage: &Damage| {
        let (depth, shares) = (damage.findings().martensite_depth, damage.martensite());
        let most = shares.iter().fold(0.0_f64, |most, share| most.max(*share));
        println!("martensite to {:.4} mm, at most {most:.3}, {} hot places", 1e3 * depth, damage.hot_places());
        assert_eq!(depth > 0.0, most >= 0.5);
        depth
    };
    let cool = |damage: &mut Damage| {
        for k in 1..=400 {
            let now = moment(0.05, 1.5 * f64::from(k), 30.0, 0.0);
            spots.advance(damage, &now, &|_, _: &mut [f64]| panic!("far away"), &mut Default::default());
        }
        assert_eq!(damage.hot_places(), 0);
    };
    let mut damage = spots.begin([0.0; 2]);
    heat(&spots, &mut damage, 0.0, 1000.0);
    assert_eq!(agree(&damage), 0.0);
    cool(&mut damage);
    let first = agree(&damage);
    // Warm again, but no austenite.
    heat(&spots, &mut damage, 0.0, 500.0);
    assert_eq!((damage.hot_places(), agree(&damage)), (1, first));
    cool(&mut damage);
    assert_eq!(agree(&damage), first);
    heat(&spots, &mut damage, 0.0, 1200.0);
    assert!(agree(&damage) == 0.0 && damage.hot_places() == 1);
    cool(&mut damage);
    assert!(agree(&damage) > first && first > 0.0);
}

#[test]
fn every_point_of_a_rolling_tread_is_hot_for_its_passes_only() {
    let spots = wheel(1.0);
    let mut damage = spots.begin([0.0; 2]);
    // Hot on 6 mm of the contact, at a tread of 13.8 m/s: 0.435 ms per pass.
    let (x, values) = ([-0.012, -3e-3, -3e-3, 3e-3, 3e-3, 0.012], [0.0, 0.0, 900.0, 900.0, 0.0, 0.0]);
    let sample = |_: f64, _: &mut [f64]| panic!("too fast for a spot");
    let (omega, mut angle, mut dt) = (30.0, 0.0, 3e-4);
    let mut longest = Vec::new();
    for turn in 1..=3 {
        while angle < 2.0 * PI * turn as f64 - 1e-3 {
            dt = if dt > 2e-4 { 1e-4 } else { 3e-4 };
            angle += omega * dt;
            let surface: (&[f64], &[f64]) = (&x, &values);
            let now = TreadStep { surface, ..moment(dt, angle, omega, 900.0) };
            spots.advance(&mut damage, &now, &sample, &mut Default::default());
        }
        longest.push(damage.findings().above_ac1);
    }
    let pass = 6e-3 / (omega * RADIUS);
    println!("pass {:.5} ms, longest after 1, 2, 3 turns {longest:.7?} s, run {:.3} s", 1e3 * pass, angle / omega);
    for (turn, longest) in longest.iter().enumerate() {
        // A point may have begun one more pass.
        let passes = longest / pass;
        assert!(passes > 0.99 * (turn + 1) as f64 && passes < 1.01 * (turn + 2) as f64, "{passes}");
    }
}

/// Heat that a rolling place of 600 K gives to cold rail: bodies of equal effusivity e that touch for the time t exchange
/// `e ΔT √(t/π)` per pass, which as a mean is a film h; a half-space under it loses
/// `ΔT e²/h (e^{z²} erfc z − 1 + 2z/√π)`, `z = h √t/e` (Carslaw & Jaeger, *Conduction of Heat in Solids*, 2.7).
#[test]
fn the_rail_chills_a_rolling_hot_place_at_every_pass() {
    let spots = wheel(1.0);
    let mut damage = spots.begin([0.0; 2]);
    let sample = |_: f64, column: &mut [f64]| column.fill(600.0);
    spots.advance(&mut damage, &moment(1e-3, 0.0, 0.0, 600.0), &sample, &mut Default::default());
    let (omega, length) = (30.0, 0.012);
    let turns = 5;
    let end = turns as f64 * 2.0 * PI / omega;
    for k in 1..=1000 {
        let now = moment(end / 1000.0, omega * end * k as f64 / 1000.0, omega, 0.0);
        spots.advance(&mut damage, &TreadStep { contact_length: length, ..now }, &sample, &mut Default::default());
    }
    // Heat that the middle column has lost per area.
    let (mesh, field) = (spots.mesh(), damage.spots[0].field().unwrap());
    let layers = mesh.depth.len();
    let column = &field.temperature[mesh.arc.len() / 2 * layers..][..layers];
    let missing: Vec<f64> = column.iter().zip(&mesh.depth).map(|(t, z)| (600.0 - t) * (1.0 - z / RADIUS)).collect();
    let lost: f64 =
        mesh.depth.windows(2).zip(missing.windows(2)).map(|(z, t)| 0.5 * (z[1] - z[0]) * (t[0] + t[1])).sum();
    let effusivity = (CONDUCTIVITY * HEAT_CAPACITY).sqrt();
    let film = effusivity * (length / (omega * RADIUS) / PI).sqrt() * omega / (2.0 * PI);
    let z = film * field.age.sqrt() / effusivity;
    let lost_in_all = 600.0 * effusivity * effusivity / film * ((z * z).exp() * erfc(z) - 1.0 + 2.0 * z / PI.sqrt());
    println!(
        "lost {:.0} J/m2 for {lost_in_all:.0}, surface at {:.1} K, followed for {:.4} of {end:.4} s",
        HEAT_CAPACITY * lost,
        column[0],
        field.age
    );
    assert!((HEAT_CAPACITY * lost / lost_in_all - 1.0).abs() < 0.015);
}

/// A layer with the temperatures `T e^{−z²/s²}` keeps this shape below a surface without exchange, and its surface has
/// `T/√(1 + 4κt/s²)` after the time t.
#[test]
fn a_hot_layer_that_is_released_spreads_as_a_gaussian() {
    let spots = wheel(0.5);
    let depth = spots.mesh().depth.clone();
    let (hot, width) = (900.0, 5e-4);
    let mut damage = spots.begin([0.0; 2]);
    let sample = |_: f64, column: &mut [f64]| {
        column.iter_mut().zip(&depth).for_each(|(t, z)| *t = hot * (-(z / width).powi(2)).exp());
    };
    spots.advance(&mut damage, &moment(1e-3, 0.0, 0.0, hot), &sample, &mut Default::default());
    let untouched = |_: f64, _: &mut [f64]| panic!("the contact is far away");
    for k in 1..=400 {
        let now = moment(1e-4, 1e-2 * f64::from(k), 100.0, 0.0);
        spots.advance(&mut damage, &now, &untouched, &mut Default::default());
    }
    let field = damage.spots[0].field().unwrap();
    let found = field.temperature[spots.mesh().arc.len() / 2 * depth.len()];
    let expected = |diffusivity: f64| hot / (1.0 + 4.0 * diffusivity * field.age / (width * width)).sqrt();
    println!("{found:.3} K for {:.3} K; {:.3} K with 5 % more", expected(DIFFUSIVITY), expected(1.05 * DIFFUSIVITY));
    assert!((found / expected(DIFFUSIVITY) - 1.0).abs() < 5e-3, "{found}");
}

/// `1 − exp(−0.011 (Ms − T))`, D. P. Koistinen, R. E. Marburger, *Acta Metall.* 7 (1959) 59–60.
fn koistinen_marburger(temperature: f64) -> f64 {
    1.0 - (-0.011 * (CRITERIA.martensite_start - temperature)).exp()
}

/// History of a point after a course of times \[s] and temperatures \[K], linear between them, in steps of 1 ms.
fn point(course: &[(f64, f64)]) -> PointHistory {
    let mut history = PointHistory::default();
    for ends in course.windows(2) {
        let ((from, start), (to, end)) = (ends[0], ends[1]);
        let steps = ((to - from) / 1e-3).round();
        let at = |k: f64| start + (end - start) * k / steps;
        for k in 1..=steps as usize {
            let k = k as f64;
            history.record([at(k - 1.0), at(k)], from + k * 1e-3, 1e-3, &CRITERIA);
        }
    }
    history
}

#[test]
fn quenched_austenite_becomes_martensite_by_the_law_of_koistinen_and_marburger() {
    for end in [540.0, 512.0, 450.0, 293.0] {
        let history = point(&[(0.0, 300.0), (0.5, 1400.0), (1.5, end)]);
        println!("{end} K: {:.6} for {:.6}", history.martensite, koistinen_marburger(end));
        assert!((history.martensite / koistinen_marburger(end) - 1.0).abs() < 1e-9);
    }
}

/// The mean rate between 800 and 500 °C, as cooling times t8/5 are taken (EN 1011-2): 100 K/s above 650 °C, 40 K/s below.
#[test]
fn cooling_rates_are_means_from_800_to_500_degrees() {
    let found = point(&[(0.0, 300.0), (0.5, 1523.15), (6.5, 923.15), (12.75, 673.15)]).cooling_rate;
    let expected = 300.0 / (150.0 / 100.0 + 150.0 / 40.0);
    println!("{found:.4} for {expected:.4} K/s");
    assert!((found / expected - 1.0).abs() < 1e-3, "{found} for {expected}");
}

/// 51 K/s are faster than the critical 50 K/s, 49 K/s are not.
#[test]
fn austenite_that_cools_more_slowly_than_the_critical_rate_becomes_no_martensite() {
    let found = [51.0, 49.0].map(|rate| point(&[(0.0, 300.0), (0.5, 1400.0), (0.5 + 1000.0 / rate, 400.0)]).martensite);
    assert!(found[0] > 0.8 && found[1] == 0.0, "{found:?}");
}

/// A place is followed that is at least 300 K hotter than the mean of the wheel, of which moments here have none.
#[test]
fn places_are_hot_from_their_threshold_over_the_wheel() {
    let spots = wheel(1.0);
    let opened = [297.0, 303.0].map(|excess| {
        let mut damage = spots.begin([0.0; 2]);
        heat(&spots, &mut damage, 0.0, excess);
        damage.spots.len()
    });
    assert_eq!(opened, [0, 1]);
}

/// Up from 500 to 1500 K and down at 1000 K/s: half a second above 1000 K on either side.
#[test]
fn the_time_above_ac1_is_that_of_the_course() {
    let history = point(&[(0.0, 500.0), (1.0, 1500.0), (2.0, 500.0)]);
    assert!((history.above_ac1 - 1.0).abs() < 1e-9, "{}", history.above_ac1);
}

/// A place below which the temperature rises evenly with the depth when it has been quenched: steel is martensitic as far as
/// half of it is martensite, which is `ln 2/0.011` = 63 K below Ms.
#[test]
fn steel_counts_as_martensitic_where_half_of_it_is_martensite() {
    let spots = wheel(0.25);
    let mut damage = spots.begin([0.0; 2]);
    let depth = spots.mesh().depth.clone();
    // 66 K below Ms at the surface, and 4 K per millimetre less below it.
    let quenched = |z: f64| CRITERIA.martensite_start - 66.0 + 4e3 * z;
    let steps = 100;
    for k in 0..=steps {
        let cooled = f64::from(k) / f64::from(steps);
        let at = |z: f64| 1300.0 + cooled * (quenched(z) - 1300.0) - REFERENCE;
        let sample = |_: f64, column: &mut [f64]| column.iter_mut().zip(&depth).for_each(|(t, z)| *t = at(*z));
        let now = moment(1e-2, 0.0, 0.0, at(0.0).max(400.0));
        spots.advance(&mut damage, &now, &sample, &mut Default::default());
    }
    let found = damage.findings().martensite_depth;
    let expected = (66.0 - 2.0_f64.ln() / 0.011) / 4e3;
    println!("martensite to {:.4} mm, {:.4} mm where it is half", 1e3 * found, 1e3 * expected);
    assert!((found / expected - 1.0).abs() < 0.02, "{found:e} for {expected:e}");
}
