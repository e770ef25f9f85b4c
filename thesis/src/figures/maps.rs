//! Temperatures of the product beside the contact as maps.

use crate::annulus::OUTER;
use crate::plot::{Curve, GAP, LEVELS, Plot, Source};
use wheelrail::heat::TemperatureField;

/// Place along the surface \[m], depth \[m] and temperature \[K] of a node.
pub(super) type Node = [f64; 3];

/// Nodes of wheel (about its centre) or rail within `reach` \[m] of the contact and of the surface.
pub(super) fn nodes(field: &TemperatureField, wheel: bool, reach: [f64; 2]) -> Vec<Node> {
    let place = |[x, y]: [f64; 2]| if wheel { [OUTER * x.atan2(-y), OUTER - x.hypot(y)] } else { [x, -y] };
    let all = field.mesh.nodes.iter().zip(&field.temperature).map(|(node, t)| {
        let [s, z] = place(*node);
        [s, z, *t]
    });
    all.filter(|[s, z, _]| s.abs() < reach[0] && *z < reach[1]).collect()
}

/// Temperatures between the columns of a mesh, which go straight down.
struct Columns {
    /// Place of each \[m], and its depths \[m] and temperatures \[K].
    all: Vec<(f64, Vec<[f64; 2]>)>,
}

impl Columns {
    fn new(nodes: &[Node]) -> Self {
        let mut sorted = nodes.to_vec();
        sorted.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
        let mut all: Vec<(f64, Vec<[f64; 2]>)> = Vec::new();
        for [s, z, t] in sorted {
            match all.last_mut() {
                Some((place, column)) if (s - *place).abs() < 1e-9 => column.push([z, t]),
                _ => all.push((s, vec![[z, t]])),
            }
        }
        all.iter_mut().for_each(|(_, column)| column.sort_by(|a, b| a[0].total_cmp(&b[0])));
        Self { all }
    }

    /// Temperature at a place and depth \[m], linear between nodes.
    fn at(&self, place: f64, depth: f64) -> f64 {
        let k = self.all.partition_point(|(s, _)| *s <= place).clamp(1, self.all.len() - 1);
        let [(left, before), (right, after)] = [&self.all[k - 1], &self.all[k]];
        let share = ((place - left) / (right - left)).clamp(0.0, 1.0);
        (1.0 - share) * between(before, depth) + share * between(after, depth)
    }
}

/// Linear between the points of a column, constant beyond them.
fn between(column: &[[f64; 2]], depth: f64) -> f64 {
    let k = column.partition_point(|[z, _]| *z <= depth);
    if k == 0 || k == column.len() {
        return column[k.saturating_sub(1)][1];
    }
    let ([a, p], [b, q]) = (column[k - 1], column[k]);
    p + (q - p) * (depth - a) / (b - a)
}

/// Cells of a map along the surface and in depth.
const CELLS: [usize; 2] = [150, 60];

/// A map from `from` to `to` \[m] along the surface and `depth` \[m] deep, in equal levels of the temperature;
/// `contact` is where half of it ends \[m].
pub(super) fn map(nodes: &[Node], wheel: bool, [from, to]: [f64; 2], depth: f64, contact: f64) -> Plot {
    let columns = Columns::new(nodes);
    let cell = [(to - from) / CELLS[0] as f64, depth / CELLS[1] as f64];
    let value = |i: usize, j: usize| columns.at(from + (i as f64 + 0.5) * cell[0], (j as f64 + 0.5) * cell[1]);
    let all: Vec<Vec<f64>> = (0..CELLS[1]).map(|j| (0..CELLS[0]).map(|i| value(i, j)).collect()).collect();
    let (low, high) =
        all.iter().flatten().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), t| (low.min(*t), high.max(*t)));
    let width = (high - low).max(f64::MIN_POSITIVE) / LEVELS as f64;
    let level = |t: f64| (((t - low) / width) as usize).min(LEVELS - 1);
    let mut outlines = vec![Vec::new(); LEVELS];
    for (j, row) in all.iter().enumerate() {
        for run in runs(&row.iter().map(|t| level(*t)).collect::<Vec<_>>()) {
            let [left, right] = [run.1, run.2].map(|i| 1e3 * (from + i as f64 * cell[0]));
            // The wheel is above its surface.
            let up = if wheel { 1e3 } else { -1e3 };
            let [near, far] = [j, j + 1].map(|j| up * j as f64 * cell[1]);
            outlines[run.0].extend([[left, near], [right, near], [right, far], [left, far], GAP]);
        }
    }
    let name = |k: usize| {
        let [from, to] = [k, k + 1].map(|k| low + k as f64 * width);
        format!("{from:.2e} to {to:.2e} K")
    };
    let mut curves: Vec<Curve> = (0..LEVELS)
        .map(|k| Curve { source: Source::Level(k), name: name(k), points: std::mem::take(&mut outlines[k]) })
        .collect();
    let deep = if wheel { 1e3 * depth } else { -1e3 * depth };
    for x in [-contact, contact] {
        curves.push(Curve { source: Source::Mesh, name: String::new(), points: vec![[1e3 * x, 0.0], [1e3 * x, deep]] });
    }
    let body = if wheel { "wheel" } else { "rail" };
    Plot { axes: ["place along the surface in mm".into(), format!("{body}: height in mm")], curves }
}

/// Runs of equal values: the value, and from where to where it goes.
fn runs(values: &[usize]) -> Vec<(usize, usize, usize)> {
    let mut found: Vec<(usize, usize, usize)> = Vec::new();
    for (i, value) in values.iter().enumerate() {
        match found.last_mut() {
            Some((same, _, end)) if same == value => *end = i + 1,
            _ => found.push((*value, i, i + 1)),
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_map_covers_its_window_once_and_has_each_temperature_where_it_is() {
        let grid = (0..=20).flat_map(|i| (0..=10).map(move |j| (f64::from(i), f64::from(j))));
        let nodes: Vec<Node> = grid.map(|(i, j)| [1e-4 * (i - 10.0), 1e-4 * j, i + 2.0 * j]).collect();
        let plot = map(&nodes, false, [-5e-4, 5e-4], 5e-4, 1e-4);
        let mut area = 0.0;
        for curve in &plot.curves {
            let Source::Level(level) = curve.source else { continue };
            let [low, high] = [level, level + 1].map(|k| 5.0 + 20.0 * k as f64 / 10.0);
            for cell in curve.points.split(|p| p[0].is_nan()).filter(|cell| !cell.is_empty()) {
                area += ((cell[1][0] - cell[0][0]) * (cell[2][1] - cell[1][1])).abs();
                let there = |p: [f64; 2]| 10.0 * p[0] + 10.0 - 20.0 * p[1];
                assert!(cell.iter().all(|p| (low - 0.5..high + 0.5).contains(&there(*p))), "{cell:?} {low} {high}");
            }
        }
        assert!((area - 0.5).abs() < 1e-9, "{area}");
    }
}
