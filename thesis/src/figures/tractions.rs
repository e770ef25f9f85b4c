//! Paper D, figure 9: pressures and tractions during two ramps of the creepage, beside stationary rolling, Hertz and
//! Carter.

use super::mesh_heat::half_width;
use super::ramp_steps::{Bodies, GROWTH, SPEED, creepage};
use super::ramps::{DURATIONS, EDGE, METHOD_STEPS, paper_d, ramp};
use super::{Figure, carter, curve, largest, must};
use crate::ours::Run;
use crate::plot::{Plot, Source};
use crate::quoted::Status;
use wheelrail::analytic::hertz_peak_pressure;
use wheelrail::piecewise::Piecewise;

/// Load [N/m] and friction coefficient.
const LOAD: f64 = 100e3;
const FRICTION: f64 = 0.4;

/// Figure D 9: pressure and traction at three instants of simulations 3 and 5.
pub fn profiles() -> Result<Figure, String> {
    const INSTANTS: [f64; 3] = [0.2, 0.35, 0.5];
    let product = paper_d()?;
    let bodies = Bodies::new(0.5 * EDGE, 2)?;
    let at = INSTANTS.map(|share| (share * METHOD_STEPS as f64).round() as usize);
    let limit = FRICTION * hertz_peak_pressure(LOAD, product.rolling(SPEED, 0.0, |_| ())?.traction().half_width());
    let shown = |profile: &Piecewise| {
        profile.x.iter().zip(&profile.value).map(|(x, q)| [1e3 * x, 1e-6 * q]).collect::<Vec<_>>()
    };
    let points = |run: &Run| shown(&run.traction().shear);
    let a = half_width(LOAD);
    let places = || (-40..=40).map(|i| a * f64::from(i) / 40.0);
    let closed = |f: &dyn Fn(f64) -> f64| places().map(|x| [1e3 * x, 1e-6 * f(x)]).collect::<Vec<_>>();
    let hertz = |x: f64| hertz_peak_pressure(LOAD, a) * (1.0 - (x / a).powi(2)).max(0.0).sqrt();
    let mut stresses = vec![curve(Source::Exact, "Hertz", closed(&hertz))];
    let mut from_carter = 0.0_f64;
    let mut plots = Vec::new();
    let (mut joins, mut pressures, mut apart) = (Vec::new(), 0.0_f64, Vec::new());
    for sim in [3, 5] {
        let mut theirs = bodies.tractions(DURATIONS[sim - 1], METHOD_STEPS, &at)?.into_iter();
        let (mut curves, mut join, mut failed) = (Vec::new(), 1.0, None);
        let (mut before, mut joined) = (0.0, false);
        ramp(&product, DURATIONS[sim - 1], 200, |share, run| {
            if !((share * 200.0).round() as usize).is_multiple_of(10) {
                return;
            }
            match product.rolling(SPEED, creepage(share), |_| ()) {
                Ok(slow) => {
                    let (ours, still) = (&run.traction().shear, &slow.traction().shear);
                    let off = still.x.iter().zip(&still.value).map(|(x, q)| (ours.at(*x) - q).abs() / limit);
                    let off = off.fold(0.0, f64::max);
                    // From here on within a twentieth of the limit, where it crosses on a straight line.
                    if off >= 0.05 {
                        joined = false;
                    } else if !joined {
                        join = if share > 0.0 && before > off {
                            share - 0.05 * (0.05 - off) / (before - off)
                        } else {
                            share
                        };
                        joined = true;
                    }
                    before = off;
                    let ratio = run.traction().pressure_max / slow.traction().pressure_max - 1.0;
                    pressures = pressures.max(ratio.abs());
                    if INSTANTS.iter().any(|t| (t - share).abs() < 1e-9) {
                        let pressure = shown(&run.traction().pressure);
                        stresses.push(curve(Source::Ours, format!("simulation {sim} at {share}"), pressure));
                        curves.push(curve(Source::Ours, format!("simulation {sim} at {share}"), points(run)));
                        curves.push(curve(Source::Exact, format!("stationary at {share}"), points(&slow)));
                        let law = |x: f64| carter::traction(x, creepage(share), FRICTION, LOAD);
                        curves.push(curve(Source::Exact, format!("Carter at {share}"), closed(&law)));
                        let off = still.x.iter().zip(&still.value).map(|(x, q)| (q - law(*x)).abs() / limit);
                        from_carter = from_carter.max(off.sum::<f64>() / still.x.len() as f64);
                        let nodes = theirs.next().unwrap_or_default();
                        let off: f64 = nodes.iter().map(|[x, q]| (1e6 * q - ours.at(1e-3 * x)).abs() / limit).sum();
                        apart.push(off / nodes.len() as f64);
                        curves.push(curve(Source::Method, format!("thesis's method at {share}"), nodes));
                    }
                }
                Err(error) => failed = Some(error),
            }
        })?;
        failed.map_or(Ok(()), Err)?;
        joins.push(join);
        plots.push(Plot { axes: ["place in mm".into(), "traction in MPa".into()], curves });
    }
    plots.push(Plot { axes: ["place in mm".into(), "pressure in MPa".into()], curves: stresses });
    let farthest = largest(apart.iter().copied());
    Ok(Figure {
        item: "D 9",
        title: "Pressures and tractions at three instants of simulations 3 and 5",
        status: Status::NotStated,
        parameters: "As table D 1, 200 steps. The instants, 0.2, 0.35 and 0.5 of the duration, are assumed.",
        finding: format!(
            "Tractions stay within 5 % of the limit of the stationary ones from {:.2} of the duration on in simulation 3 and from {:.2} in \
             simulation 5; the thesis says 0.65 and 0.5 without a measure, on a regularised law. The pressure is the stationary one \
             within {:.1e}, and stationary tractions are those of Carter within {from_carter:.4} of the limit in the mean of their nodes, with all deformations of both bodies. The thesis's own step in time (40 steps, linear triangles with edges of 0.2 a) has them at its nodes within {:.3} of \
             the limit in the mean of the nodes, with the force that an uneven mesh has by itself.",
            joins[0], joins[1], pressures, farthest
        ),
        plots,
        values: vec![
            ("d9.join.3".into(), joins[0]),
            ("d9.join.5".into(), joins[1]),
            ("d9.method.apart".into(), farthest),
        ],
        predicates: vec![
            must("the slower simulation joins earlier", joins[1] < joins[0]),
            must("both have joined when the creepage stops growing, 0.7", joins.iter().all(|join| *join < GROWTH)),
            must(
                format!(
                    "stationary tractions within 0.012 of the limit of Carter's in the mean of their nodes: {from_carter:.4}"
                ),
                from_carter < 0.012,
            ),
            must(format!("the pressure is that of stationary rolling within 1 %: {pressures:.1e}"), pressures < 0.01),
            must(
                format!(
                    "the thesis's method at six instants within 0.15 of the limit in the mean of its nodes: {apart:.3?}"
                ),
                apart.len() == 6 && farthest < 0.15,
            ),
        ],
    })
}
