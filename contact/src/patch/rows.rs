//! Patches that are no ellipse: rows side by side, each with its length and its load. Where rows do not touch, a patch
//! ends and the next one begins.

use std::f64::consts::PI;

/// One row of a patch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PatchRow {
    /// Lateral position `z` of its middle \[m].
    pub position: f64,
    /// Width \[m].
    pub width: f64,
    /// Half-length in the direction of rolling \[m].
    pub half_length: f64,
    /// Load per width [N/m].
    pub line_load: f64,
    /// Free width between this row and the one before it \[m]; zero where they touch, and for the first row.
    pub gap: f64,
}

/// Ellipse with the second moments of area of a patch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EquivalentEllipse {
    /// Half axis along the direction of rolling \[m].
    pub a: f64,
    /// Lateral half axis \[m].
    pub b: f64,
    /// Lateral position of the centre of area \[m].
    pub centre: f64,
}

/// Widths \[m] of rows at rising positions \[m] that touch: each reaches halfway to its neighbours, the outer ones as
/// far outwards as inwards. Zero for a single row, whose width its position does not tell.
pub fn widths(positions: &[f64]) -> Vec<f64> {
    let gaps: Vec<f64> = positions.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let width = |i: usize| {
        let right = gaps.get(i).copied();
        let left = i.checked_sub(1).and_then(|before| gaps.get(before)).copied();
        0.5 * (left.or(right).unwrap_or(0.0) + right.or(left).unwrap_or(0.0))
    };
    (0..positions.len()).map(width).collect()
}

/// Rows that touch each other, patch by patch.
pub fn patches(rows: &[PatchRow]) -> impl Iterator<Item = &[PatchRow]> {
    rows.chunk_by(|_, next| next.gap == 0.0)
}

/// Load of all rows \[N].
pub fn load(rows: &[PatchRow]) -> f64 {
    rows.iter().map(|row| row.width * row.line_load).sum()
}

/// Ellipse whose second moments of area, `πa³b/4` about the lateral axis and `πab³/4` about the direction of rolling,
/// are those of the rows; none where a moment vanishes, as without rows.
///
/// Rows are samples of an outline, with the widths as weights of the quadrature: the area of a row counts at its
/// middle. That of a single row counts over its width.
pub fn equivalent_ellipse(rows: &[PatchRow]) -> Option<EquivalentEllipse> {
    let sum = |part: &dyn Fn(&PatchRow) -> f64| -> f64 { rows.iter().map(|row| row.width * part(row)).sum() };
    let area = sum(&|row| 2.0 * row.half_length);
    let centre = sum(&|row| 2.0 * row.half_length * row.position) / area;
    let along = sum(&|row| 2.0 / 3.0 * row.half_length.powi(3));
    let across = match rows {
        [alone] => alone.half_length * alone.width.powi(3) / 6.0,
        _ => sum(&|row| 2.0 * row.half_length * (row.position - centre).powi(2)),
    };
    if !(along > 0.0 && across > 0.0) {
        return None;
    }
    let aspect = (along / across).sqrt();
    // `√(I_x I_z) = π (ab)²/4`.
    let product = (4.0 / PI * (along * across).sqrt()).sqrt();
    Some(EquivalentEllipse { a: (product * aspect).sqrt(), b: (product / aspect).sqrt(), centre })
}

/// Lateral position \[m] of the resultant load of rows of which at least one carries something.
pub fn centre_of_load(rows: &[PatchRow]) -> f64 {
    rows.iter().map(|row| row.width * row.line_load * row.position).sum::<f64>() / load(rows)
}

/// At most `count` rows, but at least one for each patch, with the widths, areas and loads of all given ones, which lie
/// in ascending order: neighbours that touch become one, each time those two whose mean pressures `p` differ least, in
/// the measure `(p₁ − p₂)² g₁g₂/(g₁ + g₂)` of Ward with the weights `g = F p³`, `F` the load of a row. With these
/// weights peaks of pressure keep lines of their own: on seven lines, two real patches keep their largest pressure to
/// 0.7 %, with the weights `F` to 3.6 %.
pub fn merged(mut rows: Vec<PatchRow>, count: usize) -> Vec<PatchRow> {
    while rows.len() > count.max(1) {
        let touching = rows.windows(2).enumerate().filter(|(_, pair)| pair[1].gap == 0.0);
        let differences = touching.map(|(i, pair)| (i, difference(pair[0], pair[1])));
        let Some((first, _)) = differences.min_by(|a, b| a.1.total_cmp(&b.1)) else { break };
        let second = rows.remove(first + 1);
        rows[first] = together(rows[first], second);
    }
    rows
}

/// Difference of two rows in the measure of [`merged`].
fn difference(first: PatchRow, second: PatchRow) -> f64 {
    let pressure = |row: PatchRow| row.line_load / row.half_length;
    let weight = |row: PatchRow| row.width * row.line_load * pressure(row).powi(3);
    let [g, h] = [first, second].map(weight);
    (pressure(first) - pressure(second)).powi(2) * g * h / (g + h)
}

/// One row in the place of two neighbours.
fn together(first: PatchRow, second: PatchRow) -> PatchRow {
    let mean = |of: &dyn Fn(&PatchRow) -> f64| {
        (first.width * of(&first) + second.width * of(&second)) / (first.width + second.width)
    };
    let line_load = mean(&|row| row.line_load);
    PatchRow {
        position: mean(&|row| row.line_load * row.position) / line_load,
        width: first.width + second.width,
        half_length: mean(&|row| row.half_length),
        line_load,
        gap: first.gap,
    }
}

/// Rows of a patch whose lengths are `scale` times those of the given ones, whose positions are those about the centre
/// of load.
pub fn scaled(rows: &[PatchRow], scale: f64) -> impl Iterator<Item = PatchRow> {
    rows.iter().map(move |row| PatchRow {
        position: scale * row.position,
        width: scale * row.width,
        half_length: scale * row.half_length,
        line_load: scale * scale * row.line_load,
        gap: scale * row.gap,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::patch::{Ellipse, Hertz, gauss};

    /// Rows of Hertz's ellipse on `lines` Gauss lines, about `centre`.
    fn ellipse_rows(hertz: &Hertz, load: f64, lines: usize, centre: f64) -> Vec<PatchRow> {
        let Ellipse { a, b, peak, .. } = hertz.under(load);
        let row = |line: &gauss::GaussLine| {
            let share = (1.0 - line.ordinate.powi(2)).sqrt();
            let (half_length, pressure) = (a * share, peak * share);
            let line_load = 0.5 * PI * half_length * pressure;
            PatchRow { position: centre + b * line.ordinate, width: b * line.weight, half_length, line_load, gap: 0.0 }
        };
        gauss::rule(lines).iter().map(row).collect()
    }

    /// Errors measured: 2.8 % for 3 lines, 0.55 % for 5, 0.02 % for 15: the outline is no polynomial.
    #[test]
    fn rows_of_an_ellipse_give_it_back() {
        let hertz = Hertz::new(0.46, 0.3, 115e9);
        let Ellipse { a, b, .. } = hertz.under(1e5);
        for (lines, tolerance) in [(3, 0.03), (5, 6e-3), (15, 3e-4), (101, 1e-6)] {
            let rows = ellipse_rows(&hertz, 1e5, lines, 2e-3);
            assert!((load(&rows) / 1e5 - 1.0).abs() < 4e-15);
            let found = equivalent_ellipse(&rows).unwrap();
            assert!(
                (found.a / a - 1.0).abs() < tolerance && (found.b / b - 1.0).abs() < tolerance,
                "{lines}: {found:?}"
            );
            assert!((found.centre - 2e-3).abs() < 1e-15);
        }
    }

    #[test]
    fn rows_under_another_load_are_those_of_the_other_ellipse() {
        let hertz = Hertz::new(0.46, 0.3, 115e9);
        let rows = ellipse_rows(&hertz, 1e5, 7, 0.0);
        for (found, exact) in scaled(&rows, 0.6_f64.cbrt()).zip(ellipse_rows(&hertz, 6e4, 7, 0.0)) {
            assert!((found.position - exact.position).abs() < 1e-17);
            assert!((found.width / exact.width - 1.0).abs() < 1e-14);
            assert!((found.half_length / exact.half_length - 1.0).abs() < 1e-14);
            assert!((found.line_load / exact.line_load - 1.0).abs() < 1e-14);
        }
        assert_eq!(equivalent_ellipse(&[]), None);
    }

    #[test]
    fn merged_rows_keep_load_area_centre_and_peaks() {
        let row = |(i, line_load): (u8, f64)| PatchRow {
            position: 1e-3 * f64::from(i),
            width: 1e-3,
            half_length: 5e-3,
            line_load: 1e6 * line_load,
            gap: 0.0,
        };
        let rows: Vec<_> = (0..).zip([3.0, 3.1, 9.0, 3.2, 3.3, 6.0, 6.2]).map(row).collect();
        let merged_rows = merged(rows.clone(), 4);
        let widths: Vec<f64> = merged_rows.iter().map(|row| (1e3 * row.width).round()).collect();
        assert_eq!(widths, [2.0, 1.0, 2.0, 2.0]);
        assert_eq!(merged_rows[1], rows[2]);
        for count in 1..=8 {
            let found = merged(rows.clone(), count);
            assert_eq!(found.len(), count.min(7));
            let area = |rows: &[PatchRow]| rows.iter().map(|row| row.width * row.half_length).sum::<f64>();
            assert!((load(&found) / load(&rows) - 1.0).abs() < 1e-14);
            assert!((area(&found) / area(&rows) - 1.0).abs() < 1e-14);
            assert!((centre_of_load(&found) / centre_of_load(&rows) - 1.0).abs() < 1e-14);
        }
        assert!(merged(Vec::new(), 3).is_empty());
    }

    /// Wheel S1002 on rail UIC60, wheelset 3 mm towards the flange, 100.41 kN: 25 rows of a computation with
    /// CONTACT r2707 (module 1, elements of 0.2 mm), all of whose elements give 7.535 and 4.646 mm.
    #[test]
    fn a_real_patch_has_the_ellipse_of_its_moments() {
        let rows = [
            (-4.4, 0.5, 19.5),
            (-4.0, 3.3, 2886.6),
            (-3.6, 4.5, 5767.6),
            (-3.2, 5.3, 8438.8),
            (-2.8, 6.1, 10877.0),
            (-2.4, 6.5, 13041.0),
            (-2.0, 7.1, 14930.0),
            (-1.6, 7.3, 16492.0),
            (-1.2, 7.7, 17695.0),
            (-0.8, 7.7, 18549.0),
            (-0.4, 7.9, 19005.0),
            (0.0, 7.9, 19036.0),
            (0.4, 7.7, 18624.0),
            (1.0, 7.5, 17101.0),
            (1.4, 7.1, 15439.0),
            (1.8, 6.5, 13186.0),
            (2.2, 5.9, 9840.7),
            (2.6, 5.1, 6590.1),
            (3.0, 4.7, 4890.1),
            (3.4, 4.1, 3566.8),
            (3.8, 3.5, 2558.4),
            (4.2, 2.9, 1737.5),
            (4.6, 2.3, 1063.8),
            (5.0, 1.7, 493.7),
            (5.4, 0.5, 17.5),
        ];
        let positions: Vec<f64> = rows.iter().map(|row| 1e-3 * row.0).collect();
        let row = |((_, half_length, line_load), (position, width)): (&(f64, f64, f64), (&f64, f64))| PatchRow {
            position: *position,
            width,
            half_length: 1e-3 * half_length,
            line_load: 1e3 * line_load,
            gap: 0.0,
        };
        let rows: Vec<_> = rows.iter().zip(positions.iter().zip(widths(&positions))).map(row).collect();
        let found = equivalent_ellipse(&rows).unwrap();
        assert!((load(&rows) / 100.41e3 - 1.0).abs() < 0.01);
        assert!((found.a / 7.535e-3 - 1.0).abs() < 0.01 && (found.b / 4.646e-3 - 1.0).abs() < 0.01, "{found:?}");
    }

    #[test]
    fn rows_that_touch_share_the_gaps_between_them() {
        assert_eq!(widths(&[0.0, 1.0, 3.0]), [1.0, 1.5, 2.0]);
        assert_eq!(widths(&[0.7]), [0.0]);
        assert!(widths(&[]).is_empty());
    }

    #[test]
    fn rows_on_both_sides_of_a_gap_never_become_one() {
        let row = |(position, gap): (f64, f64)| PatchRow {
            position,
            width: 1.0,
            half_length: 1.0,
            line_load: 1.0 + 0.1 * position,
            gap,
        };
        let rows: Vec<_> = [(0.0, 0.0), (1.0, 0.0), (3.0, 1.0), (4.0, 0.0), (9.0, 4.0)].map(row).to_vec();
        assert_eq!(patches(&rows).map(<[PatchRow]>::len).collect::<Vec<_>>(), [2, 2, 1]);
        for count in 1..=5 {
            let found = merged(rows.clone(), count);
            assert_eq!(found.len(), count.max(3));
            assert!((load(&found) / load(&rows) - 1.0).abs() < 1e-14);
            assert_eq!(found.iter().map(|row| row.gap).sum::<f64>(), 5.0);
        }
        // A row alone is a rectangle.
        let EquivalentEllipse { a, b, .. } = equivalent_ellipse(&rows[4..]).unwrap();
        assert!((PI * a.powi(3) * b / 4.0 - 2.0 / 3.0).abs() < 1e-14);
        assert!((PI * a * b.powi(3) / 4.0 - 1.0 / 6.0).abs() < 1e-14);
    }
}
