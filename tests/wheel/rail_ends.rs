//! Ends of the rail: free, fixed, or such that waves leave (Paper A, section 4.3 and figures 5 and 6).

#[path = "../../thesis/src/waves.rs"]
mod waves;

use crate::common::*;
use nalgebra::{Complex, Matrix2, Vector2};
use std::f64::consts::PI;
use waves::{Push, deviation, plate, steel, system};
use wheelrail::config::{Damping, RailEnds};
use wheelrail::fem::DofMap;
use wheelrail::linalg::CsrMatrix;
use wheelrail::mechanics::{BodyResponse, FullBody};
use wheelrail::simulation::Simulation;

/// Paper A, figures 5 and 6: the energy that a quarter period of load leaves in the central metre, 31 to 345 µs.
#[test]
fn a_metre_with_quiet_ends_loses_energy_as_the_middle_of_four_metres_does() {
    // Paper A's elements and about its step of 10 µs; half and a quarter of them.
    for (h, quarter) in [(1.0 / 30.0, 3), (1.0 / 60.0, 8)] {
        let mut at_rest = f64::NAN;
        for speed in [0.0, 100.0 * KMH, -100.0 * KMH] {
            let run = |length: f64, ends: RailEnds| Push { length, ends, speed, size: h, quarter }.energies().unwrap();
            let four = run(4.0, RailEnds::Free);
            let off = deviation(&run(1.0, RailEnds::Nonreflecting), &four);
            let kept = [&four, &run(1.0, RailEnds::Free)].map(|energy| energy[energy.len() - 1] / energy[0]);
            println!("1/{:.0} m, {speed:.1} m/s: quiet against four metres {off:.4}, kept {kept:.4?}", 1.0 / h);
            assert!(off < 0.03 && kept[0] < 0.6);
            if speed == 0.0 {
                at_rest = off;
                assert!((kept[1] - 1.0).abs() < 1e-9);
            }
            assert!(off < 1.05 * at_rest);
        }
    }
}

/// Energy of pressure waves that come back from a dashpot as pressure waves, by their angle to the normal: the
/// amplitudes of both reflected plane waves from the balance of the assembled nodal forces at the end.
#[test]
fn reflected_pressure_waves_follow_the_formula_for_plane_waves() {
    let (material, h) = (steel(), 2e-3);
    let [pressure, shear] = [material.pressure_wave_speed(), material.shear_wave_speed()];
    let wavelength = 0.2;
    let omega = 2.0 * PI * pressure / wavelength;
    let mesh = plate(12.0 * h, 100.0 * h, h);
    let (system, dofs) = (system(&mesh, RailEnds::Nonreflecting).unwrap(), DofMap::new(&mesh));
    // Nodes of the right end without the corners.
    let end: Vec<usize> = (0..mesh.nodes.len())
        .filter(|&k| mesh.nodes[k][0] > 5.9 * h && (mesh.nodes[k][1] + 50.0 * h).abs() < 48.5 * h)
        .collect();
    for (angle, expected) in [(0.0_f64, 0.0), (30.0, 2e-4), (45.0, 5.5e-3), (60.0, 0.043), (75.0, 0.22)] {
        let (sin, cos) = angle.to_radians().sin_cos();
        let across = omega / pressure * sin;
        let along = [omega / pressure * cos, ((omega / shear).powi(2) - across * across).sqrt()];
        // Displacements of the incident and the reflected pressure wave, and of the reflected shear wave.
        let (p, s) = ([cos, sin], [across * shear / omega, along[1] * shear / omega]);
        let waves = [(along[0], p), (-along[0], [-p[0], p[1]]), (-along[1], s)];
        let forces = waves.map(|(k, direction)| {
            let field = |part: fn(Complex<f64>) -> f64| {
                let mut field = vec![0.0; dofs.len()];
                for (node, [x, y]) in mesh.nodes.iter().enumerate() {
                    let phase = Complex::new(0.0, -(k * (x - 6.0 * h) + across * y)).exp();
                    for (c, amplitude) in direction.iter().enumerate() {
                        if let Some(i) = dofs.unknown(node, c) {
                            field[i] = amplitude * part(phase);
                        }
                    }
                }
                field
            };
            let product = |matrix: &CsrMatrix, x: &[f64]| {
                let mut y = vec![0.0; x.len()];
                matrix.multiply(x, &mut y);
                y
            };
            let (re, im) = (field(|z| z.re), field(|z| z.im));
            let damping = system.damping.as_ref().unwrap();
            let [a, b] = [&re, &im].map(|x| {
                let (k, m) = (product(&system.stiffness, x), product(&system.mass, x));
                (0..x.len()).map(|i| k[i] - omega * omega * m[i]).collect::<Vec<_>>()
            });
            let [c, d] = [&re, &im].map(|x| product(damping, x));
            // e^{iωt}: the velocity is iω times the displacement.
            (0..a.len()).map(|i| Complex::new(a[i] - omega * d[i], b[i] + omega * c[i])).collect::<Vec<_>>()
        });
        let (mut matrix, mut right) = (Matrix2::<Complex<f64>>::zeros(), Vector2::<Complex<f64>>::zeros());
        for i in end.iter().flat_map(|&node| [0, 1].map(|c| dofs.unknown(node, c).unwrap())) {
            for row in 0..2 {
                right[row] -= forces[row + 1][i].conj() * forces[0][i];
                for column in 0..2 {
                    matrix[(row, column)] += forces[row + 1][i].conj() * forces[column + 1][i];
                }
            }
        }
        let amplitudes = matrix.lu().solve(&right).unwrap();
        let shear_share = along[1] * shear * shear / (along[0] * pressure * pressure);
        let energy = amplitudes[0].norm_sqr() + amplitudes[1].norm_sqr() * shear_share;
        println!("{angle:2.0}°: {energy:.2e} of the energy comes back ({expected:.1e})");
        assert!((energy - expected).abs() < 2e-3);
    }
}

/// A wheel that bounces on a high rail, in which its waves can travel, after a jump of its load: force over load,
/// energy that damping and ends have taken, and what is missing in the balance [J], in steps of `h` [s] over 10 ms.
fn bounce(ends: RailEnds, speed: f64, h: f64) -> (Vec<f64>, [f64; 2]) {
    let mut config = preset("paper_d", 4);
    config.thermal.enabled = false;
    config.rail.ends = ends;
    (config.rail.length, config.rail.height, config.damping) = (3.0, 2.0, Damping::default());
    let model = model(config);
    let mut inputs = prescribed(&model, speed, 0.0);
    inputs.drive.friction = 0.0;
    let mut simulation = Simulation::new(model.clone(), &inputs).unwrap();
    inputs.drive.load *= 1.2;
    let advance = |_| {
        simulation.advance(&inputs, h).unwrap();
        simulation.outputs().contact_force_y / inputs.drive.load
    };
    let history = (0..(0.01 / h).round() as usize).map(advance).collect();
    let outputs = simulation.outputs();
    let (gain, taken) = (outputs.hub_work - outputs.stored_energy, outputs.damping_energy);
    (history, [taken, gain - taken - outputs.friction_energy])
}

/// Energy that is missing in the balance belongs to the jump of the load and falls with the square of the step: 1.8 %
/// of what is radiated in steps of 50 µs, 0.42 % in half as long ones. Rolling changes little of what is radiated.
#[test]
fn the_energy_that_the_ends_radiate_closes_the_balance() {
    let [coarse, fine] = [5e-5, 2.5e-5].map(|h| {
        let (free, lost) = bounce(RailEnds::Free, 0.0, h);
        let (quiet, taken) = bounce(RailEnds::Nonreflecting, 0.0, h);
        let (radiated, differ) = (taken[0] - lost[0], deviation(&free, &quiet));
        let missing = (taken[1] - lost[1]) / radiated;
        println!(
            "{h} s: {radiated:.3e} J radiated, of which {missing:.1e} are missing; free against quiet force {differ:.1e}"
        );
        assert!(radiated > 0.5 * lost[0]);
        [missing.abs(), taken[0]]
    });
    assert!(fine[0] < 0.01 && fine[0] < 0.35 * coarse[0], "{coarse:?} {fine:?}");
    let (_, rolling) = bounce(RailEnds::Nonreflecting, 30.0, 2.5e-5);
    println!("rolling at 30 m/s: {:.4} of the energy", rolling[0] / fine[1]);
    assert!((rolling[0] / fine[1] - 1.0).abs() < 0.05);
}

/// Fixed ends hold the rail; far from the contact they are as good as free ones.
#[test]
fn a_rail_with_fixed_ends_is_stiffer_than_a_free_one() {
    let compliance = |ends: RailEnds, length: f64| {
        let mut mesh = plate(length, 0.1, 1.0 / 30.0);
        if ends == RailEnds::Fixed {
            mesh.fix_ends();
        }
        let op = FullBody::new(system(&mesh, ends).unwrap(), false).unwrap().operator(0.0).unwrap();
        let middle = op.surface.nrows() / 4 * 2 + 1;
        1e12 * op.surface[(middle, middle)]
    };
    let short = [RailEnds::Free, RailEnds::Fixed].map(|ends| compliance(ends, 0.2));
    let long = [RailEnds::Free, RailEnds::Fixed].map(|ends| compliance(ends, 1.0));
    println!("short {short:.4?}, long {long:.8?} m/(TN/m)");
    assert!(short[1] < 0.99 * short[0]);
    assert!((long[1] / long[0] - 1.0).abs() < 1e-4 && long[1] < long[0]);
}
