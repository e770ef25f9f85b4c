//! Grading of one-dimensional meshes: positions of nodes on a line whose cells grow from one end or from both.
//!
//! Two families serve different purposes. [`Grading`] places a given density of cells, grows from both ends and leaves
//! no jump of size in between: for meshes that vibrate. [`graded`] grows by an exact factor from one end: for thermal
//! layers, whose size is known at the surface. Both meet the ends of the line exactly.

/// Cell size along a line: `min(first + α s, largest, last + β (length − s))`.
///
/// α and β are the logarithms of the growth factors per cell.
#[derive(Clone, Copy, Debug)]
pub struct Grading {
    /// Cell size at the start \[m].
    pub first: f64,
    /// Growth factor per cell from the start on.
    pub growth: f64,
    /// Largest cell size \[m].
    pub largest: f64,
    /// Cell size at the end \[m].
    pub last: f64,
    /// Growth factor per cell backwards from the end.
    pub growth_last: f64,
}

/// A [`Grading`] on a line: its three pieces, rising, flat and falling, and how many cells each takes.
struct Pieces {
    first: f64,
    last: f64,
    alpha: f64,
    beta: f64,
    /// Where the rising piece ends.
    rising: f64,
    rise: f64,
    flat: f64,
    fall: f64,
}

impl Grading {
    /// Growth by the factor `growth` from the start only.
    pub fn one_sided(first: f64, growth: f64, largest: f64) -> Self {
        Self { first, growth, largest, last: largest, growth_last: growth }
    }

    fn pieces(&self, length: f64) -> Pieces {
        let (first, last) = (self.first.min(self.largest), self.last.min(self.largest));
        let (alpha, beta, top) = (libm::log(self.growth), libm::log(self.growth_last), self.largest);
        let crossing = (last + beta * length - first) / (alpha + beta);
        let rising = ((top - first) / alpha).min(crossing).clamp(0.0, length);
        let falling = (length - (top - last) / beta).max(crossing).clamp(rising, length);
        let rise = libm::log1p(alpha * rising / first) / alpha;
        let flat = (falling - rising) / top;
        let fall = libm::log1p(beta * (length - falling) / last) / beta;
        Pieces { first, last, alpha, beta, rising, rise, flat, fall }
    }

    /// Number of cells on a line of the given length, without placing them; a float, since it may be beyond all
    /// integers.
    pub fn cells(&self, length: f64) -> f64 {
        let Pieces { rise, flat, fall, .. } = self.pieces(length);
        (rise + flat + fall - 1e-9).ceil().max(1.0)
    }

    /// Nodes on `[0, length]`, both ends included: [`Self::cells`] and one.
    ///
    /// Equidistributes the cell count `∫ ds / h(s)` of the cell size `h`; the ends are met exactly.
    pub fn positions(&self, length: f64) -> Vec<f64> {
        let Pieces { first, last, alpha, beta, rising, rise, flat, fall } = self.pieces(length);
        let total = rise + flat + fall;
        let cells = self.cells(length);
        let place = |k: f64| {
            let t = total * k / cells;
            if t <= rise {
                first * libm::expm1(alpha * t) / alpha
            } else if t <= rise + flat {
                rising + (t - rise) * self.largest
            } else {
                length - last * libm::expm1(beta * (total - t)) / beta
            }
        };
        let mut positions: Vec<f64> = (0..=cells as usize).map(|k| place(k as f64)).collect();
        let end = positions.len() - 1;
        (positions[0], positions[end]) = (0.0, length);
        positions
    }
}

/// Positions from zero to `length` whose cells have the sizes `first·growth^k`, at most `largest`, all shrunk by one
/// factor so that they fill `length` \[m].
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
    fn grading_meets_both_ends_and_grows_by_the_given_factor() {
        let grading = Grading { last: 0.01, growth_last: 1.1, ..Grading::one_sided(1e-4, 1.2, 0.05) };
        let s = grading.positions(1.0);
        let h: Vec<f64> = s.windows(2).map(|w| w[1] - w[0]).collect();
        assert_eq!((s[0], s[s.len() - 1]), (0.0, 1.0));
        assert_eq!(h.len() as f64, grading.cells(1.0));
        assert!(h[0] < 1.1e-4 && h[h.len() - 1] < 0.0105 && h.iter().all(|h| *h > 0.0 && *h <= 0.05));
        assert!(h.windows(2).all(|w| w[1] / w[0] < 1.2 + 1e-6 && w[0] / w[1] < 1.1 + 1e-6));
        assert_eq!(Grading::one_sided(2.0, 1.2, 3.0).positions(1.0), [0.0, 1.0]);
    }

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
