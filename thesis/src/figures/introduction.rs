//! The heated rod in a stream, figures 4.2 and 5.1 of the introduction.

use super::{Figure, must};
use crate::one_dimension::Rod;
use crate::plot::{Curve, Plot, Source};
use crate::quoted::Status;
use crate::stabilise::Scheme;

/// Elements of figure 5.1.
const ELEMENTS: usize = 20;

/// Place of node `i` of `count` equal elements, in the thesis's coordinate from −1 to 1 against the stream.
fn node(i: usize, count: usize) -> f64 {
    1.0 - 2.0 * i as f64 / count as f64
}

/// Exact temperatures at `count` places.
fn exact(rod: &Rod, count: usize) -> Curve {
    let points = (0..=count).map(|i| [node(i, count), rod.exact(2.0 * i as f64 / count as f64)]).collect();
    Curve { source: Source::Exact, name: format!("exact, V = {}", rod.velocity), points }
}

/// Temperatures of a scheme.
fn computed(rod: &Rod, scheme: Scheme, name: &str) -> Curve {
    let theta = rod.solve(ELEMENTS, scheme);
    let points = theta.iter().enumerate().map(|(i, theta)| [node(i, ELEMENTS), *theta]).collect();
    Curve { source: Source::Method, name: name.into(), points }
}

fn plot(curves: Vec<Curve>) -> Plot {
    Plot { axes: ["place X̂".into(), "temperature θ".into()], curves }
}

/// Figure 4.2: exact temperatures at three velocities.
pub fn rod() -> Result<Figure, String> {
    let velocities = [2.0, 20.0, 200.0];
    let rods = velocities.map(Rod::of_the_thesis);
    let supg = |rod: &Rod| computed(rod, Scheme::Supg, &format!("SUPG, V = {}", rod.velocity));
    let curves = rods.iter().flat_map(|rod| [exact(rod, 80), supg(rod)]).collect();
    let worst = rods.iter().fold(0.0_f64, |worst, rod| worst.max(rod.nodal_error(ELEMENTS, Scheme::Supg)));
    let peaks = rods.map(|rod| (0..=4000).map(|i| rod.exact(f64::from(i) / 2000.0)).fold(0.0, f64::max));
    Ok(Figure {
        item: "I 4.2",
        title: "Rod in a stream, exact solution (4.6)",
        status: Status::NotStated,
        parameters: "L = ρ = c = k = 1, R = 1000, ends at ±L. V = 200; the two others, here 2 and 20, are assumed.",
        finding: format!("The peak falls with the velocity: {:.1}, {:.1}, {:.2}.", peaks[0], peaks[1], peaks[2]),
        plots: vec![plot(curves)],
        values: velocities.iter().zip(peaks).map(|(v, peak)| (format!("i42.peak.{v}"), peak)).collect(),
        predicates: vec![
            must(format!("SUPG is exact at the nodes: {worst:.1e} < 1e-11"), worst < 1e-11),
            must("the peak falls with the velocity", peaks[0] > peaks[1] && peaks[1] > peaks[2]),
        ],
    })
}

/// Figure 5.1: Galerkin, SUPG and quasi-residual-free bubble.
pub fn schemes() -> Result<Figure, String> {
    let rod = Rod::of_the_thesis(200.0);
    let [galerkin, supg, bubble] = Scheme::ALL.map(|scheme| rod.nodal_error(ELEMENTS, scheme));
    let names = ["Galerkin (a)", "SUPG (b)", "quasi-residual-free bubble (c)"];
    let drawing = |(scheme, name): (Scheme, &str)| plot(vec![exact(&rod, 200), computed(&rod, scheme, name)]);
    Ok(Figure {
        item: "I 5.1",
        title: "Rod in a stream with and without stabilisation",
        status: Status::Agrees,
        parameters: "As figure 4.2, V = 200, 20 equal elements: Péclet number of an element 20.",
        finding: format!(
            "Largest error at a node over the largest temperature: {galerkin:.3}, {supg:.0e}, {bubble:.3}. The thesis calls \
             SUPG nodally exact and the bubble free of oscillations but not exact."
        ),
        plots: Scheme::ALL.into_iter().zip(names).map(drawing).collect(),
        values: vec![("i51.galerkin".into(), galerkin), ("i51.supg".into(), supg), ("i51.bubble".into(), bubble)],
        predicates: vec![
            must("Galerkin .896 ± .002", (galerkin - 0.896).abs() < 0.002),
            must("SUPG below 1e-12", supg < 1e-12),
            must("bubble .166 ± .002", (bubble - 0.166).abs() < 0.002),
        ],
    })
}
