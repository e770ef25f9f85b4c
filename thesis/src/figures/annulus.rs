//! Heat in a rotating annulus, figures 5 to 7 of Paper B.

use super::{Figure, must};
use crate::annulus::{INNER, OUTER, exact, solve};
use crate::plot::{Curve, Plot, Source};
use crate::quoted::Status;
use crate::stabilise::Scheme;
use crate::triangle::Order;
use crate::wheel::{Annulus, unstructured};

/// Angular velocities [rad/s]: at rest, a tenth of 50 km/h and 50 km/h. The thesis does not list its own.
const OMEGAS: [f64; 3] = [0.0, 2.78, 27.8];

/// Sizes \[m] and disorders of the meshes over which linear elements scatter.
const MESHES: [(f64, f64); 8] =
    [(0.09, 0.0), (0.09, 0.1), (0.09, 0.2), (0.07, 0.0), (0.07, 0.1), (0.05, 0.0), (0.05, 0.1), (0.05, 0.2)];

/// Least and largest temperature at mid radius over the exact one at 50 km/h, linear elements on all meshes.
fn scatter(scheme: Scheme) -> Result<(f64, f64), String> {
    let middle = 0.5 * (OUTER + INNER);
    MESHES.iter().try_fold((f64::MAX, f64::MIN), |(low, high), (size, disorder)| {
        let mesh = unstructured(Annulus { outer: OUTER, inner: INNER }, *size, *disorder);
        let field = solve(mesh, Order::Linear, scheme, OMEGAS[2]).map_err(|error| error.to_string())?;
        let ratio = field.mean_on_circle(middle) / exact(middle);
        Ok((low.min(ratio), high.max(ratio)))
    })
}

/// Figure 5.
pub fn galerkin() -> Result<Figure, String> {
    figure("B 5", "Rotating annulus without stabilisation", Scheme::Galerkin)
}

/// Figure 6.
pub fn supg() -> Result<Figure, String> {
    figure("B 6", "Rotating annulus with SUPG", Scheme::Supg)
}

/// Figure 7.
pub fn bubble() -> Result<Figure, String> {
    figure("B 7", "Rotating annulus with quasi-residual-free bubbles", Scheme::Bubble)
}

fn figure(item: &'static str, title: &'static str, scheme: Scheme) -> Result<Figure, String> {
    let mesh = unstructured(Annulus { outer: OUTER, inner: INNER }, 0.05, 0.1);
    let radius = |i: usize, count: usize| INNER + (OUTER - INNER) * i as f64 / count as f64;
    let (middle, mut plots, mut values) = (0.5 * (OUTER + INNER), Vec::new(), Vec::new());
    let mut ratios = [[0.0; OMEGAS.len()]; 2];
    for (k, (order, name)) in [(Order::Linear, "linear"), (Order::Quadratic, "quadratic")].into_iter().enumerate() {
        let points = (0..=40).map(|i| radius(i, 40)).map(|r| [r, exact(r)]).collect();
        let mut curves = vec![Curve { source: Source::Exact, name: "exact for every ω".into(), points }];
        for (omega, ratio) in OMEGAS.into_iter().zip(&mut ratios[k]) {
            let field = solve(mesh.clone(), order, scheme, omega).map_err(|error| error.to_string())?;
            *ratio = field.mean_on_circle(middle) / exact(middle);
            values.push((format!("{}.{name}.{omega}", item.replace(' ', "").to_lowercase()), *ratio));
            // The segment of the figure, x = 0 and y < 0.
            let places = (0..=90).map(|i| radius(i, 90));
            let points = places.filter_map(|r| field.at([0.0, -r]).map(|theta| [r, theta])).collect();
            curves.push(Curve { source: Source::Method, name: format!("{name}, ω = {omega} rad/s"), points });
        }
        plots.push(Plot { axes: ["radius in m".into(), "temperature in K".into()], curves });
    }
    let [linear, quadratic] = ratios.map(|row| row[OMEGAS.len() - 1]);
    let (at_rest, quadratic_at_rest) = (ratios[0][0], ratios[1][0]);
    let (low, high) = scatter(scheme)?;
    values.push((format!("{}.low", item.replace(' ', "").to_lowercase()), low));
    values.push((format!("{}.high", item.replace(' ', "").to_lowercase()), high));
    Ok(Figure {
        item,
        title,
        status: Status::Qualitative,
        parameters: "r 0.5/0.05 m, s = 1000 W/m³, ρ 8000, c 460; k = 45 W/(m K) and the list of ω are assumed; own mesh of 2595 \
                     triangles.",
        finding: format!(
            "Temperature at mid radius over the exact one at 27.8 rad/s: linear {linear:.3}, quadratic {quadratic:.3}. Over {} meshes of 757 to 2595 \
             triangles linear elements have {low:.2} to {high:.2} of it: a number of the thesis would hang on its mesh.",
            MESHES.len()
        ),
        plots,
        values,
        predicates: vec![
            must(format!("linear elements lose a tenth of it or more on every mesh: {high:.3}"), high < 0.9),
            must("linear elements are right at rest", (at_rest - 1.0).abs() < 5e-3),
            must("quadratic elements are right at rest", (quadratic_at_rest - 1.0).abs() < 1e-2),
            must("rotation makes linear elements lose temperature", linear < at_rest - 0.1),
            must("quadratic elements keep more of it", quadratic > linear + 0.1),
        ],
    })
}
