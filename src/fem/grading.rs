//! Grading of one-dimensional meshes: cells that grow from one end.

/// Positions from zero to `length` whose cells have the sizes `first·growth^k`, at most `largest`, all shrunk by one factor
/// so that they fill `length` \[m].
pub fn graded(first: f64, growth: f64, largest: f64, length: f64) -> Vec<f64> {
    let mut positions = vec![0.0];
    let (mut size, mut end) = (first.min(largest), 0.0);
    while end < length * (1.0 - 1e-9) {
        end += size;
        positions.push(end);
        size = (size * growth).min(largest);
    }
    let scale = length / end;
    positions.iter_mut().for_each(|p| *p *= scale);
    if let Some(last) = positions.last_mut() {
        *last = length;
    }
    positions
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_grow_by_the_factor_up_to_the_largest_and_meet_the_end() {
        let x = graded(1e-3, 1.5, 0.1, 1.0);
        let h: Vec<f64> = x.windows(2).map(|w| w[1] - w[0]).collect();
        assert_eq!((x[0], x[x.len() - 1]), (0.0, 1.0));
        assert!(h[0] <= 1e-3 && h.iter().all(|h| *h <= 0.1 * (1.0 + 1e-12)));
        let growing = h.windows(2).filter(|h| h[1] < 0.09);
        assert!(growing.clone().count() > 5 && growing.into_iter().all(|h| (h[1] / h[0] - 1.5).abs() < 1e-9));
        assert_eq!(graded(2.0, 1.5, 3.0, 1.0), [0.0, 1.0]);
    }
}
