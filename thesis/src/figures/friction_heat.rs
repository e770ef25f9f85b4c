//! Paper C: tractions and friction heat of stationary rolling and sliding, by the product beside Carter, references and
//! balances.

use super::mesh_heat::half_width;
use super::{Extent, Figure, balanced, carter, curve, largest, maps, must};
use crate::annulus::{CONDUCTIVITY, INNER, OUTER};
use crate::ours::{Product, Run};
use crate::plot::{Curve, Plot, Source};
use crate::quoted::Status;
use std::f64::consts::TAU;
use wheelrail::analytic::{flash_temperature, hertz_peak_pressure};
use wheelrail::config::Config;

/// Load [N/m], velocity [m/s] and friction coefficient, which Paper C does not state.
const LOAD: f64 = 10e3;
const SPEED: f64 = 50.0 / 3.6;
const FRICTION: f64 = 0.4;
/// Creepages whose tractions the thesis shows.
const CREEPAGES: [f64; 3] = [-5e-5, -1.25e-4, -2.5e-4];
/// Heat capacity of steel by volume [J/(m³ K)], height of the rail \[m].
const CAPACITY: f64 = 8000.0 * 460.0;
const HEIGHT: f64 = 0.1;

/// Paper C on a coarser mesh without centrifugal load, as the references, with changes.
fn paper_c(change: impl FnOnce(&mut Config)) -> Result<Product, String> {
    Product::with("paper_c", |config| {
        (config.mesh.elements_per_half_width, config.physics.centrifugal) = (10, false);
        change(config);
    })
}

/// Figures C 8 to 11: pressure, traction and slip at three creepages.
pub fn profiles() -> Result<Figure, String> {
    let product = Product::with("paper_c", |config| {
        (config.physics.centrifugal, config.thermal.enabled) = (false, false);
    })?;
    let run =
        |creepage: f64, friction: f64| product.rolling(SPEED, creepage, |inputs| inputs.drive.friction = friction);
    let runs = CREEPAGES.map(|creepage| run(creepage, FRICTION)).into_iter().collect::<Result<Vec<_>, _>>()?;
    let a = half_width(LOAD);
    let peak = hertz_peak_pressure(LOAD, a);
    let (mut pressure, mut shear, mut slip, mut worst) = (Vec::new(), Vec::new(), Vec::new(), [0.0_f64; 2]);
    for (creepage, run) in CREEPAGES.into_iter().zip(&runs) {
        let traction = run.traction();
        let shown = |profile: &wheelrail::piecewise::Piecewise, scale: f64| -> Vec<[f64; 2]> {
            profile.x.iter().zip(&profile.value).map(|(x, v)| [1e3 * x, scale * v]).collect()
        };
        let exact = |x: f64| carter::traction(x, creepage, FRICTION, LOAD);
        let hertz = |x: f64| peak * (1.0 - (x / a).powi(2)).max(0.0).sqrt();
        let closed = |f: &dyn Fn(f64) -> f64| {
            (-40..=40).map(|i| a * f64::from(i) / 40.0).map(|x| [1e3 * x, 1e-6 * f(x)]).collect::<Vec<_>>()
        };
        if pressure.is_empty() {
            pressure.push(curve(Source::Exact, "Hertz", closed(&hertz)));
        }
        pressure.push(curve(Source::Ours, format!("ours, ξ = {creepage:e}"), shown(&traction.pressure, 1e-6)));
        shear.push(curve(Source::Ours, format!("ours, ξ = {creepage:e}"), shown(&traction.shear, 1e-6)));
        shear.push(curve(Source::Exact, format!("Carter, ξ = {creepage:e}"), closed(&exact)));
        slip.push(curve(Source::Ours, format!("ours, ξ = {creepage:e}"), shown(&traction.slip, 1e3)));
        let profiles: [(_, &dyn Fn(f64) -> f64, f64); 2] =
            [(&traction.shear, &exact, FRICTION * peak), (&traction.pressure, &hertz, peak)];
        for (worst, (profile, wanted, scale)) in worst.iter_mut().zip(profiles) {
            let points = profile.x.iter().zip(&profile.value).filter(|(x, _)| x.abs() < 0.9 * a);
            *worst = points.fold(*worst, |worst, (x, q)| worst.max((q - wanted(*x)).abs() / scale));
        }
    }
    // Where the traction leaves its limit, and the share of the contact that sticks, for both friction coefficients.
    let end = |run: &Run| run.traction().half_width() * (1.0 - 2.0 * run.traction().stick_fraction);
    let other = run(CREEPAGES[0], 0.5)?;
    let (weak, strong) = (end(&runs[0]), end(&other));
    let element = a / 20.0;
    let plot = |name: &str, curves| Plot { axes: ["place in mm".into(), name.into()], curves };
    let stuck =
        [weak - carter::slip_end(CREEPAGES[0], FRICTION, LOAD), strong - carter::slip_end(CREEPAGES[0], 0.5, LOAD)];
    let sliding = runs[2].traction().stick_fraction;
    Ok(Figure {
        item: "C 8–11",
        title: "Pressure, traction and slip in the contact",
        status: Status::NotStated,
        parameters: "Base of Paper C, P = 10 kN/m, 50 km/h, ξ = −5e-5, −1.25e-4, −2.5e-4; μ is not stated: 0.4 in the drawings. Without \
                     centrifugal load and heat, which Carter's law does not know.",
        finding: format!(
            "At −5e-5 the contact slips from −{:.4} to −{:.4} mm with μ = 0.4 and to −{:.4} mm with μ = 0.5; stated −0.25 to −0.14 mm. \
             So the thesis must have had about 0.5. At −2.5e-4 all of it slips with both.",
            1e3 * runs[0].traction().half_width(),
            -1e3 * weak,
            -1e3 * strong
        ),
        plots: vec![
            plot("pressure in MPa", pressure),
            plot("traction in MPa", shear),
            plot("slip velocity in mm/s", slip),
        ],
        values: vec![
            ("c8.slip_end.04".into(), weak),
            ("c8.slip_end.05".into(), strong),
            ("c8.slip_begin".into(), -runs[0].traction().half_width()),
        ],
        predicates: vec![
            must(
                format!("traction within 3 % of its limit of Carter's inside of 0.9 a: {:.4}", worst[0]),
                worst[0] < 0.03,
            ),
            must(
                format!("pressure within 1 % of Hertz' peak of his inside of 0.9 a: {:.4}", worst[1]),
                worst[1] < 0.01,
            ),
            must(
                format!(
                    "ends of the slip zones within half an element, 6e-6 m, of Carter's: {:.1e}, {:.1e} m",
                    stuck[0], stuck[1]
                ),
                stuck.iter().all(|off| off.abs() < 0.5 * element),
            ),
            must(format!("nothing sticks at −2.5e-4: {sliding}"), sliding == 0.0),
            must(
                "0.4511 and 0.8765 of the limit within 0.002",
                (runs[0].utilisation() - 0.451_08).abs() < 2e-3 && (runs[1].utilisation() - 0.876_526).abs() < 2e-3,
            ),
        ],
    })
}

/// Mean temperature of an annulus over the heat that it conducts to its hub [K m/W]: rim heated, hub cold.
fn per_heat() -> f64 {
    let square = OUTER * OUTER;
    (square * (OUTER / INNER).ln() / (square - INNER * INNER) - 0.5) / (TAU * CONDUCTIVITY)
}

/// How far the mean temperatures are from what the heat to the hub, along the radius, and the heat to the rail make
/// \[1].
fn imbalance(run: &Run) -> [f64; 2] {
    let (outputs, warmth) = (run.outputs(), run.warmth());
    let rail = outputs.heat_to_rail / (2.0 * CAPACITY * outputs.wheel_velocity * HEIGHT);
    [warmth.wheel_mean / (outputs.heat_to_hub * per_heat()) - 1.0, warmth.rail_mean / rail - 1.0]
}

/// Maps of wheel and rail, 1.5 mm along the surface and 0.3 mm deep, as in figures C 12 and C 13.
pub(super) fn pictures(run: &Run) -> Result<Vec<Plot>, String> {
    let (fields, contact) = (run.fields()?, run.outputs().contact_half_width);
    let map = |body: usize| {
        let nodes = maps::nodes(&fields[body], body == 0, [1.5e-3, 0.5e-3]);
        maps::map(&nodes, body == 0, [-1e-3, 0.5e-3], 0.3e-3, contact)
    };
    Ok(vec![map(0), map(1)])
}

/// Figure C 13: temperatures of the locked wheel, ξ = 2.
pub fn locked() -> Result<Figure, String> {
    let run = paper_c(|_| ())?.rolling(SPEED, 2.0, |_| ())?;
    let warmth = run.warmth();
    // The reference is of a tenfold load.
    let heavy = Product::with("paper_d", |config| {
        (config.physics.centrifugal, config.material.expansion) = (false, 0.0);
        config.thermal.max_speed = 30.0;
    })?;
    let heavy = heavy.rolling(SPEED, 2.0, |_| ())?;
    let (reference, heavy_imbalance) = (heavy.warmth(), heavy.heat_imbalance());
    let off = [reference.wheel_centre / 28.639_17 - 1.0, reference.rail_centre / 26.402_03 - 1.0];
    // A rail that takes all heat in, with the root of the velocity.
    let power = 0.1 * FRICTION * LOAD * SPEED;
    let flash = flash_temperature(power, half_width(LOAD), SPEED, (CONDUCTIVITY * CAPACITY).sqrt());
    let (outputs, share) = (run.outputs(), warmth.rail_max / flash);
    let points = |values: &[f64]| -> Vec<[f64; 2]> {
        outputs.profile_x.iter().zip(values).map(|(x, t)| [1e3 * x, t - 293.0]).collect()
    };
    let mut plots = pictures(&run)?;
    plots.push(Plot {
        axes: ["place in mm".into(), "temperature in K".into()],
        curves: vec![
            curve(Source::Ours, "wheel", points(&outputs.profile_temperature_wheel)),
            curve(Source::Ours, "rail", points(&outputs.profile_temperature_rail)),
        ],
    });
    let to_hub = outputs.heat_to_hub / power;
    let arrives = (outputs.heat_to_wheel + outputs.heat_to_rail) / power;
    Ok(Figure {
        item: "C 13",
        title: "Temperatures of a locked wheel",
        status: Status::NotStated,
        parameters: "Base of Paper C, P = 10 kN/m, 50 km/h, ξ = 2, stationary, without centrifugal load; μ = 0.4 \
                     assumed. The thesis shows a map without a number.",
        finding: format!(
            "Wheel {:.2} K and rail {:.2} K at the contact point, at most {:.2} and {:.2} K. {:.1} % of the heat leaves through the hub, \
             the rest with the rail.",
            warmth.wheel_centre,
            warmth.rail_centre,
            warmth.wheel_max,
            warmth.rail_max,
            100.0 * to_hub
        ),
        plots,
        values: vec![
            ("c13.wheel".into(), warmth.wheel_centre),
            ("c13.rail".into(), warmth.rail_centre),
            ("c13.wheel_max".into(), warmth.wheel_max),
            ("c13.rail_max".into(), warmth.rail_max),
        ],
        predicates: vec![
            must(
                format!(
                    "under 100 kN/m within 1 % of the reference, 28.64 and 26.40 K: {:+.4}, {:+.4}",
                    off[0], off[1]
                ),
                off.iter().all(|off| off.abs() < 0.01),
            ),
            balanced(largest([run.heat_imbalance(), heavy_imbalance])),
            must(
                format!("hottest rail 0.9 to 1 of that which takes all heat: {share:.3}"),
                (0.9..1.0).contains(&share),
            ),
            must(
                format!("a tenth of the friction power arrives in both bodies within 0.1 %: {:+.1e}", arrives - 1.0),
                (arrives - 1.0).abs() < 1e-3,
            ),
        ],
    })
}

/// Mean temperatures of wheel and rail as curves over an axis.
fn means(axis: &[f64], warmth: &[[f64; 2]], name: &str) -> [Curve; 2] {
    let over = |body: usize| axis.iter().zip(warmth).map(|(x, t)| [*x, t[body].log10()]).collect();
    [curve(Source::Ours, name, over(0)), curve(Source::Ours, name, over(1))]
}

/// Figure C 14: mean temperatures over the velocity at four creepages.
pub fn velocity(extent: Extent) -> Result<Figure, String> {
    let product = paper_c(|_| ())?;
    let axis = extent.axis(&[10.0, 20.0, 35.0, 50.0, 75.0, 100.0]);
    let kmh = &axis.values;
    let creepages = [-5e-5, -1.25e-4, -2.5e-4, 2.0];
    let (mut all, mut balance, mut plots) = (Vec::new(), [0.0_f64; 2], [Vec::new(), Vec::new()]);
    let mut lost = Vec::new();
    for creepage in creepages {
        let mut warmth = Vec::new();
        for v in kmh {
            let run = product.rolling(v / 3.6, creepage, |_| ())?;
            let mean = run.warmth();
            warmth.push([mean.wheel_mean, mean.rail_mean]);
            lost.push(run.heat_imbalance());
            let off = imbalance(&run);
            // A locked wheel does not turn its heat round.
            balance[0] = if creepage < 1.0 { balance[0].max(off[0].abs()) } else { balance[0] };
            balance[1] = balance[1].max(off[1].abs());
        }
        let [wheel, rail] = means(kmh, &warmth, &format!("ξ = {creepage:e}"));
        plots[0].push(wheel);
        plots[1].push(rail);
        all.push(warmth);
    }
    let rises = |body: usize| all.iter().all(|w| w.windows(2).all(|pair| pair[1][body] > pair[0][body]));
    let more = |i: usize| (0..kmh.len()).all(|k| (0..2).all(|body| all[i + 1][k][body] > all[i][k][body]));
    let at_50: Vec<[f64; 2]> = all.iter().map(|warmth| *axis.listed(warmth, 3)).collect();
    let [wheel, rail] = at_50[0];
    let [wheels, rails] = plots;
    let plot = |body: &str, curves| Plot {
        axes: ["velocity in km/h".into(), format!("lg of the mean temperature of the {body} in K")],
        curves,
    };
    let off = [wheel / 7.521_697e-5 - 1.0, rail / 1.113_944e-8 - 1.0];
    let spread = axis.listed(&all[0], 5)[1] / all[0][0][1] - 1.0;
    Ok(Figure {
        item: "C 14",
        title: "Mean temperatures over the velocity",
        status: Status::NotStated,
        parameters: "Base of Paper C, P = 10 kN/m; velocities of 10 to 100 km/h, creepages −1.25e-4 and −2.5e-4 beside −5e-5 and 2, and \
                     μ = 0.4 are assumed. Without centrifugal load. The caption names cylinder and plate: both are shown.",
        finding: format!(
            "At −5e-5 and 50 km/h {wheel:.2e} K in the wheel, {rail:.2e} K in the rail (reference 7.52e-5 and 1.11e-8 K; the text states \
             2.26e-6 and 4.45e-9 K). The wheel's mean rises with the velocity; the rail's by {:.1} % from 10 to 100 km/h at −5e-5: \
             heat and stream grow alike, but the hub takes less of the heat.",
            100.0 * spread
        ),
        plots: vec![plot("wheel", wheels), plot("rail", rails)],
        values: vec![
            ("c14.wheel".into(), wheel),
            ("c14.rail".into(), rail),
            ("c14.wheel.locked".into(), at_50[3][0]),
            ("c14.rail.locked".into(), at_50[3][1]),
            ("c14.wheel.off".into(), off[0]),
            ("c14.rail.off".into(), off[1]),
        ],
        predicates: vec![
            must(
                format!("within 1 % of the references 7.5217e-5 and 1.1139e-8 K: {:+.4}, {:+.4}", off[0], off[1]),
                off.iter().all(|off| off.abs() < 0.01),
            ),
            balanced(largest(lost)),
            must("the wheel's mean rises with the velocity at all creepages", rises(0)),
            must("both means rise with |ξ|", (0..3).all(more)),
            must(
                format!(
                    "rolling wheels have the mean that the heat to the hub makes, within 0.5 %: {:.1e}",
                    balance[0]
                ),
                balance[0] < 5e-3,
            ),
            must(
                format!("rails have the mean that their heat makes, within 0.5 %: {:.1e}", balance[1]),
                balance[1] < 5e-3,
            ),
        ],
    })
}

/// Figure C 15: mean temperatures over the conductance of the contact.
pub fn conductance(extent: Extent) -> Result<Figure, String> {
    let axis = extent.axis(&[5.0, 5.5, 6.0, 6.5, 7.0, 7.5, 8.0, 8.5, 9.0]);
    let powers = &axis.values;
    let at = |power: &f64| {
        let product = paper_c(|config| config.thermal.conductance = 10f64.powf(*power))?;
        let run = product.rolling(SPEED, -5e-5, |_| ())?;
        let warmth = run.warmth();
        Ok(([warmth.wheel_mean, warmth.rail_mean], imbalance(&run), run.heat_imbalance()))
    };
    let all = powers.iter().map(at).collect::<Result<Vec<_>, String>>()?;
    let warmth: Vec<[f64; 2]> = all.iter().map(|(warmth, ..)| *warmth).collect();
    let balance = all.iter().flat_map(|(_, off, _)| off).fold(0.0_f64, |worst, off| worst.max(off.abs()));
    let [first, last] = [warmth[0], warmth[powers.len() - 1]];
    let falls = warmth.windows(2).all(|pair| pair[1][0] < pair[0][0] && pair[1][1] > pair[0][1]);
    let (saturated, stated) = (axis.listed(&warmth, 7)[0] / last[0] - 1.0, 1.0 - last[0] / axis.listed(&warmth, 4)[0]);
    // Without conduction the wheel keeps its half of the friction heat.
    let product = paper_c(|config| config.thermal.conductance = 1.0)?;
    let apart = product.rolling(SPEED, -5e-5, |_| ())?;
    let kept = apart.outputs().heat_to_wheel / (0.05 * apart.outputs().friction_power);
    let [wheel, rail] = means(powers, &warmth, "ours");
    let plot = |body: &str, line| Plot {
        axes: ["lg of the conductance in W/(m² K)".into(), format!("lg of the mean temperature of the {body} in K")],
        curves: vec![line],
    };
    Ok(Figure {
        item: "C 15",
        title: "Mean temperatures over the thermal conductance of the contact",
        status: Status::NotStated,
        parameters: "Base of Paper C, P = 10 kN/m, 50 km/h, ξ = −5e-5; conductances of 1e5 to 1e9 W/(m² K) and μ = 0.4 are assumed. Without \
                     centrifugal load.",
        finding: format!(
            "The mean of the wheel falls from {:.2e} K at 1e5 to {:.2e} K at 1e9 and saturates; at 1e7 {:.1} % of it are owed to the \
             contact's resistance. The rail takes what the wheel does not.",
            first[0],
            last[0],
            100.0 * stated
        ),
        plots: vec![plot("wheel", wheel), plot("rail", rail)],
        values: vec![("c15.insulated".into(), first[0]), ("c15.perfect".into(), last[0]), ("c15.left".into(), stated)],
        predicates: vec![
            must("the wheel's mean falls and the rail's rises with the conductance", falls),
            balanced(largest(all.iter().map(|(.., lost)| *lost).chain([apart.heat_imbalance()]))),
            must(format!("saturated: 1e8.5 within 1 % of 1e9: {saturated:.4}"), saturated < 0.01),
            must(format!("means follow from the heat flows within 0.5 %: {balance:.1e}"), balance < 5e-3),
            must(
                format!("without conduction the wheel keeps its half of the heat: {kept:.5}"),
                (kept - 1.0).abs() < 2e-3,
            ),
        ],
    })
}
