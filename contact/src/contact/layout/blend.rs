//! Patches between patches that follow each other, as a wheel moves sideways.

use super::{PatchFlexibility, PatchLayout, PatchRow};
use std::sync::Arc;

impl PatchLayout {
    /// Sum of patches of as many lines, times weights that add up to one: between patches that follow each other, as a wheel moves
    /// sideways.
    ///
    /// # Panics
    /// Without parts.
    pub fn blend(parts: &[(&Self, f64)]) -> Self {
        let sum = |of: &dyn Fn(&Self) -> f64| parts.iter().map(|(part, weight)| weight * of(part)).sum::<f64>();
        let first = parts[0].0;
        // Weights may be negative, sizes may not: those lie between those of the parts with the largest weights.
        let mut nearest: Vec<_> = parts.iter().collect();
        nearest.sort_by(|a, b| b.1.total_cmp(&a.1));
        let between = |of: &dyn Fn(&Self) -> f64| {
            let [low, high] =
                nearest.iter().take(2).fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], (part, _)| {
                    [low.min(of(part)), high.max(of(part))]
                });
            sum(of).clamp(low, high)
        };
        let row = |i: usize| PatchRow {
            position: sum(&|part| part.rows[i].position),
            width: between(&|part| part.rows[i].width),
            half_length: between(&|part| part.rows[i].half_length),
            line_load: between(&|part| part.rows[i].line_load),
            gap: between(&|part| part.rows[i].gap),
        };
        let flexibilities: Vec<_> = parts.iter().map(|(part, weight)| (&**part.flexibility(), *weight)).collect();
        let rows: Vec<_> = (0..first.len()).map(row).collect();
        Self {
            gaps: rows.iter().map(|row| row.gap).collect(),
            centre: sum(&|part| part.centre),
            load: sum(&|part| part.load),
            approach: sum(&|part| part.approach),
            lifted: sum(&|part| part.lifted),
            lateral: sum(&|part| part.lateral),
            flexibility: Arc::new(PatchFlexibility::blend(&flexibilities)).into(),
            couplings: (0..first.len()).map(|i| sum(&|part| part.couplings[i])).collect(),
            rows,
            ..*first
        }
    }
}
