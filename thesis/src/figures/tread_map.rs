//! Paper B, figure 12: temperatures beside the contact, by the product.

use super::maps::{self, Node};
use super::paper_b::{CAPACITY, HEAT, LOAD, SPEED, heated, paper_b};
use super::{Figure, balanced, curve, must};
use crate::plot::{Plot, Source};
use crate::quoted::Status;

/// Half of the length and depth of the map \[m].
const REACH: f64 = 1e-3;

/// Temperature over the depth in the column next to a place \[m].
fn column(nodes: &[Node], place: f64) -> Vec<[f64; 2]> {
    let nearest = nodes.iter().min_by(|a, b| (a[0] - place).abs().total_cmp(&(b[0] - place).abs()));
    let at = nearest.map_or(place, |node| node[0]);
    let mut column: Vec<_> = nodes.iter().filter(|n| (n[0] - at).abs() < 1e-9).map(|n| [n[1], n[2]]).collect();
    column.sort_by(|a, b| a[0].total_cmp(&b[0]));
    column
}

/// Heat that streams through a column [W/m]: Simpson's rule on the quadratic layers of the mesh.
fn carried(column: &[[f64; 2]]) -> f64 {
    let layer = |n: &[[f64; 2]]| (n[2][0] - n[0][0]) / 6.0 * (n[0][1] + 4.0 * n[1][1] + n[2][1]);
    CAPACITY * SPEED * column.windows(3).step_by(2).map(layer).sum::<f64>()
}

/// Figure B 12: temperatures beside the contact.
pub fn map() -> Result<Figure, String> {
    let run = heated(&paper_b(|_| ())?, SPEED, LOAD)?;
    let (warmth, [wheel, rail]) = (run.warmth(), run.fields()?);
    let reach = [2.0 * REACH, 1.5 * REACH];
    let bodies = [maps::nodes(&wheel, true, reach), maps::nodes(&rail, false, reach)];
    let (window, contact) = ([-1.5 * REACH, 0.5 * REACH], run.outputs().contact_half_width);
    let maps = [0, 1].map(|body| maps::map(&bodies[body], body == 0, window, REACH, contact));
    let (mut plots, mut gains) = (maps.to_vec(), Vec::new());
    for (body, name) in bodies.iter().zip(["wheel", "rail"]) {
        let mut surface: Vec<_> = body.iter().filter(|n| n[1].abs() < 1e-9).map(|n| [1e3 * n[0], n[2]]).collect();
        surface.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let shown = |place: f64| column(body, place).iter().map(|[z, t]| [1e3 * z, *t]).collect();
        let below = |place: f64, what: &str| curve(Source::Ours, format!("{name}, {what}"), shown(place));
        let axis = || format!("temperature of the {name} in K");
        plots.push(Plot {
            axes: ["place along the surface in mm".into(), axis()],
            curves: vec![curve(Source::Ours, format!("surface of the {name}"), surface)],
        });
        plots.push(Plot {
            axes: ["depth in mm".into(), axis()],
            curves: vec![below(REACH, "1 mm ahead"), below(0.0, "contact"), below(-REACH, "1 mm behind")],
        });
        gains.push((carried(&column(body, -REACH)) - carried(&column(body, REACH))) / HEAT);
    }
    let (lost, gained) = (-gains[0], gains[1]);
    let deep =
        bodies[0].iter().filter(|n| n[1] > REACH).fold(0.0_f64, |w, n| w.max((n[2] / warmth.wheel_mean - 1.0).abs()));
    let ahead = column(&bodies[1], REACH).iter().fold(0.0_f64, |worst, [_, t]| worst.max(t.abs()));
    let off = [warmth.wheel_centre / 0.060_397_87 - 1.0, warmth.rail_centre / 0.050_806_56 - 1.0];
    Ok(Figure {
        item: "B 12",
        title: "Temperatures beside the contact",
        status: Status::Qualitative,
        parameters: "Base of Paper B, P = 10 kN/m, 50 km/h, 2 × 30 W/m at ±90° (assumed); 2 mm along the surface, 1 mm deep, the contact between grey lines a quarter from the right (the thesis: displaced to the left).",
        finding: format!(
            "At the contact point {:.4} K in the wheel and {:.4} K in the rail; the wheel comes in with {:.4} K. These fit the colours at \
             hand of the thesis's maps, 0.06 to 0.12 K and 0 to 0.05 K; no number is stated.",
            warmth.wheel_centre, warmth.rail_centre, warmth.wheel_mean
        ),
        plots,
        values: vec![("b12.wheel".into(), warmth.wheel_centre), ("b12.rail".into(), warmth.rail_centre)],
        predicates: vec![
            balanced(run.heat_imbalance()),
            must(
                format!("within 1 % of the references 0.06040 and 0.05081 K: {:+.4}, {:+.4}", off[0], off[1]),
                off.iter().all(|off| off.abs() < 0.01),
            ),
            must(
                format!(
                    "1 mm behind the contact the wheel carries 60 W/m less than ahead, the rail 60 W/m more, within 1 %: {lost:.4}, {gained:.4}"
                ),
                (lost - 1.0).abs() < 0.01 && (gained - 1.0).abs() < 0.01,
            ),
            must(format!("1 mm deep the wheel is as warm as in the mean within 1 %: {deep:.1e}"), deep < 0.01),
            must(format!("1 mm ahead the rail is cold: {ahead:.1e} K"), ahead < 1e-3 * warmth.rail_centre),
        ],
    })
}
