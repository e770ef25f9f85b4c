//! Melting under a constant heat flux against closed forms and a fine one-dimensional enthalpy solution.

use crate::common;
use crate::heat_common::{self, KMH, Run, config, with};
use std::f64::consts::PI;
use wheelrail::heat::{Exchange, Heat, HeatModel, HeatParameters, HeatScratch, HeatSource, HeatState};

const FLUX: f64 = 2e8;

fn molten_steel() -> HeatParameters {
    with(config(1e6, 200.0 * KMH), |c| {
        // Even heat knows no cells along the tread: temperatures and thicknesses are those of 20 elements in every
        // digit.
        c.elements_per_half_width = 4;
        c.reference = 293.0;
        (c.material.solidus, c.material.liquidus, c.material.latent_heat) = (1723.0, 1803.0, 270e3);
    })
}

/// Even heat on the whole tread of a standing wheel without contact.
fn even_heat(config: &HeatParameters) -> Exchange {
    let width = 2.0 * PI;
    let heat = FLUX * width * config.radius;
    Exchange { sources: vec![HeatSource::on_tread(0.0, width, heat)], ..Exchange::default() }
}

/// Conductivity, heat capacity, solidus, mushy interval, latent heat over specific heat.
fn constants(c: &HeatParameters) -> [f64; 5] {
    let m = &c.material;
    let solidus = m.solidus - c.reference;
    [m.conductivity, m.density * m.specific_heat, solidus, m.liquidus - m.solidus, m.latent_heat / m.specific_heat]
}

/// Surface temperature and molten thickness at `times` from explicit finite volumes of the heat content.
fn enthalpy_solution(c: &HeatParameters, times: &[f64]) -> Vec<[f64; 2]> {
    let [conductivity, capacity, solidus, interval, latent] = constants(c);
    let (cell, depth) = (2e-6, 3e-3);
    let mut content = vec![0.0; (depth / cell) as usize];
    let step = 0.4 * cell * cell * capacity / conductivity;
    let share = |h: f64| ((h - solidus) / (interval + latent)).clamp(0.0, 1.0);
    let mut temperature = content.clone();
    let (mut now, mut out) = (0.0, Vec::new());
    for &time in times {
        while now < time {
            let dt = step.min(time - now);
            now = if dt < step { time } else { now + step };
            let mut inflow = FLUX;
            for i in 0..content.len() {
                let next = temperature.get(i + 1).copied().unwrap_or(0.0);
                let outflow = conductivity * (temperature[i] - next) / cell;
                content[i] += dt * (inflow - outflow) / (capacity * cell);
                inflow = outflow;
            }
            temperature.iter_mut().zip(&content).for_each(|(t, h)| *t = h - latent * share(*h));
        }
        let surface = temperature[0] + FLUX * 0.5 * cell / conductivity;
        out.push([surface, content.iter().map(|h| share(*h) * cell).sum()]);
    }
    out
}

/// Surface temperature, molten thickness, and error of the heat balance at `times`, in `steps` steps up to each of
/// them.
fn heat_model(heat: &Heat, times: &[f64], steps: usize) -> (Vec<[f64; 2]>, f64) {
    let (mut state, mut scratch) = (heat.initial(0.0, 0.0), HeatScratch::default());
    let exchange = even_heat(heat.config());
    let (mut before, mut out, mut error) = (0.0, Vec::new(), 0.0_f64);
    for time in times {
        let dt = (time - before) / steps as f64;
        for _ in 0..steps {
            let content = heat.heat_content(&state).unwrap()[0];
            let flows = heat.advance(&mut state, dt, 0.0, 0.0, &exchange, &mut scratch);
            let gain = (heat.heat_content(&state).unwrap()[0] - content) / dt;
            error = error.max(flows.relative_imbalance()).max((gain / flows.stored_wheel - 1.0).abs());
        }
        let seen = heat.temperatures(&state);
        out.push([seen.wheel_centre, seen.melted[0]]);
        before = *time;
    }
    (out, error)
}

/// Time at which a half-space under a constant flux begins to melt, `π k ρc T²/(4 q²)`.
fn start_of_melting(config: &HeatParameters) -> f64 {
    let [conductivity, capacity, solidus, ..] = constants(config);
    PI * conductivity * capacity * solidus.powi(2) / (4.0 * FLUX * FLUX)
}

#[test]
fn melting_begins_when_the_closed_form_reaches_the_solidus() {
    let config = molten_steel();
    let start = start_of_melting(&config);
    let (seen, _) = heat_model(&Heat::new(&config).unwrap(), &[0.97 * start, 1.05 * start], 100);
    println!("start {start:.4e} s: {seen:?}");
    assert!(seen[0][1] == 0.0 && seen[1][1] > 0.0);
    let expected = (config.material.solidus - config.reference) * 0.97_f64.sqrt();
    assert!((seen[0][0] / expected - 1.0).abs() < 2e-3, "{} K, closed form {expected} K", seen[0][0]);
}

#[test]
fn surface_and_molten_thickness_under_a_constant_flux_are_those_of_a_fine_enthalpy_solution() {
    let config = molten_steel();
    let start = start_of_melting(&config);
    let times = [1.0, 1.2, 1.5, 1.7, 2.0, 2.5, 3.0, 3.5, 4.0].map(|share| share * start);
    let expected = enthalpy_solution(&config, &times);
    // Layers finer than the default, and the default, in which a deep front lies within one or two layers.
    for (growth, steps) in [(1.3, 10), (1.3, 20), (1.8, 25), (1.8, 50)] {
        let (found, error) = heat_model(&Heat::with_layers(&config, growth).unwrap(), &times, steps);
        assert!(error < 1e-10, "heat balance {error}");
        for ((time, found), expected) in times.iter().zip(&found).zip(&expected) {
            let [kelvin, molten] = expected;
            let deviation = [found[0] / kelvin - 1.0, if *molten > 0.0 { found[1] / molten - 1.0 } else { 0.0 }];
            let [share, micrometres] = [time / start, 1e6 * molten];
            let [kelvin_off, micrometres_off] = deviation;
            common::figure(if growth < 1.5 { "melting.fine" } else { "melting" }, &deviation);
            println!(
                "growth {growth}, {steps} steps, {share:.1} t_m: {kelvin:.1} K ({kelvin_off:+.1e}), {micrometres:.2} µm \
                 ({micrometres_off:+.1e})"
            );
            assert!(deviation[0].abs() < 0.001 && deviation[1].abs() < 0.01);
        }
    }
}

#[test]
fn molten_steel_that_cools_freezes_and_gives_its_latent_heat_back() {
    // A held hub would take the little heat that coarse deep layers let through.
    let config = with(molten_steel(), |c| c.hub_held = false);
    let heat = Heat::new(&config).unwrap();
    let start = start_of_melting(&config);
    let (mut state, mut scratch) = (heat.initial(0.0, 0.0), HeatScratch::default());
    for (exchange, count) in [(even_heat(&config), 60), (Exchange::default(), 200)] {
        for _ in 0..count {
            heat.advance(&mut state, 0.05 * start, 0.0, 0.0, &exchange, &mut scratch);
        }
    }
    let supplied = FLUX * 2.0 * PI * config.radius * 3.0 * start;
    let stored = heat.heat_content(&state).unwrap()[0];
    assert_eq!(heat.temperatures(&state).melted, [0.0; 2]);
    assert!((stored / supplied - 1.0).abs() < 1e-10, "{stored} J/m of {supplied} J/m");
}

/// A rail that runs under a hot standing wheel carries molten steel away, and the stream holds the heat balance.
#[test]
fn a_restored_molten_state_continues_bit_for_bit_and_balances_its_heat() {
    let config = with(molten_steel(), |c| c.heat_ratio = 1.0);
    let heat = Heat::new(&config).unwrap();
    let exchange = heat_common::carter(1e6, 60.0 * KMH, 2.0);
    let (mut state, mut scratch) = (heat.initial(0.0, 0.0), HeatScratch::default());
    let mut worst = 0.0_f64;
    for _ in 0..40 {
        let flows = heat.advance(&mut state, 1e-3, 60.0 * KMH, 0.0, &exchange, &mut scratch);
        worst = worst.max(flows.relative_imbalance());
    }
    let seen = heat.temperatures(&state);
    println!("{:.0} K, {:?} m molten, balance {worst:.1e}", seen.wheel_max, seen.melted);
    assert!(seen.melted[0] > 0.0 && worst < 1e-9);
    let mut restored: HeatState = postcard::from_bytes(&postcard::to_allocvec(&state).unwrap()).unwrap();
    heat.advance(&mut state, 1e-3, 60.0 * KMH, 0.0, &exchange, &mut scratch);
    heat.advance(&mut restored, 1e-3, 60.0 * KMH, 0.0, &exchange, &mut HeatScratch::default());
    assert_eq!(state, restored);
}
