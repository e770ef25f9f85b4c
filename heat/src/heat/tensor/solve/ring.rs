//! Elimination around the ring of a streamline: factors of the tridiagonal systems of all modes, row by row.

use super::decay::{faded, less};
use super::transport::Transport;
use crate::linalg::vectorised::vectorised;
use pulp::Simd;
use std::ops::Range;

/// The matrices `α M̃ + β F` of all modes, and the node that is eliminated last.
pub struct Ring<'a> {
    pub transport: &'a Transport,
    /// α, mode by mode.
    pub alpha: &'a [f64],
    /// β \[s].
    pub flow: f64,
    pub last: usize,
}

/// Entries of a row of [`Ring`] before anything is eliminated: the sum of the row, and both neighbours, each the part
/// that goes with α and the other one.
struct Entries {
    sum: [f64; 2],
    below: [f64; 2],
    above: [f64; 2],
}

impl Ring<'_> {
    /// Node that is eliminated in a step, the first one after the last in step 0.
    fn node(&self, step: usize) -> usize {
        let node = self.last + 1 + step;
        let n = self.transport.mass.len();
        if node < n { node } else { node - n }
    }

    fn entries(&self, i: usize) -> Entries {
        let Transport { mass_lower, mass, mass_upper, flow_lower, flow_upper, .. } = self.transport;
        Entries {
            sum: [mass_lower[i] + mass[i] + mass_upper[i], self.flow * self.transport.entry(i)],
            below: [mass_lower[i], self.flow * flow_lower[i]],
            above: [mass_upper[i], self.flow * flow_upper[i]],
        }
    }
}

/// Numbers that an elimination carries from row to row, mode by mode.
#[derive(Clone, Debug, Default)]
pub struct Carried {
    /// True while the last node has entries with the present one.
    pub alive: bool,
    /// Sum and inverse pivot of the row before.
    sum: Vec<f64>,
    inverse: Vec<f64>,
    /// The column of the last node over the pivot in the row before, and the entry of its row with the next one.
    column: Vec<f64>,
    row: Vec<f64>,
    /// Sum that filled rows take from that of the last one.
    taken: Vec<f64>,
}

impl Carried {
    /// Before the first step.
    pub fn begin(&mut self, nm: usize) {
        self.alive = true;
        for row in [&mut self.sum, &mut self.inverse, &mut self.column, &mut self.row, &mut self.taken] {
            row.clear();
            row.resize(nm, 0.0);
        }
    }
}

vectorised! {
    /// Factors `wᵢ`, `rᵢ` and `1/dᵢ` of the rows of some steps, and the filled column and row of the last node there.
    ///
    /// Elimination in terms of row sums e (Grassmann, Taksar & Heyman, *Oper. Res.* 33 (1985)): nothing cancels in a
    /// fast stream, `eᵢ = sᵢ − Lᵢ eᵢ₋₁/dᵢ₋₁`, `dᵢ = eᵢ − Uᵢ − cᵢ` with the row sums s, of the mass alone, and the
    /// column c.
    fn factorise_filled<'a, S>(
        simd,
        ring: &'a Ring<'a>,
        steps: Range<usize>,
        factors: [&'a mut [f64]; 3],
        fill: [&'a mut [f64]; 2],
        carried: &'a mut Carried,
    ) {
        let Carried { alive, sum, inverse, column, row, taken } = carried;
        let carried = [sum, inverse, column, row, taken].map(|carried| S::as_mut_simd_f64s(carried).0);
        let alpha = S::as_simd_f64s(ring.alpha).0;
        let mut filled = Filled {
            factors: factors.map(|f| S::as_mut_simd_f64s(f).0),
            fill: fill.map(|f| S::as_mut_simd_f64s(f).0),
            carried,
            left: simd.splat_f64s(0.0),
        };
        for at in (0..alpha.len()).step_by(BLOCK) {
            match alpha.len() - at {
                1 => filled.eliminate::<1>(simd, ring, alpha, at, steps.clone()),
                2 => filled.eliminate::<2>(simd, ring, alpha, at, steps.clone()),
                3 => filled.eliminate::<3>(simd, ring, alpha, at, steps.clone()),
                _ => filled.eliminate::<BLOCK>(simd, ring, alpha, at, steps.clone()),
            }
        }
        *alive = simd.reduce_sum_f64s(filled.left) != 0.0;
    }
}

vectorised! {
    /// Factors of the rows of the steps up to the last one, without fill.
    fn factorise<'a, S>(
        simd,
        ring: &'a Ring<'a>,
        steps: Range<usize>,
        factors: [&'a mut [f64]; 3],
        carried: &'a mut Carried,
    ) {
        let Carried { sum, inverse, column, row, taken, .. } = carried;
        let carried = [sum, inverse, column, row, taken].map(|carried| S::as_mut_simd_f64s(carried).0);
        let alpha = S::as_simd_f64s(ring.alpha).0;
        let mut plain = Filled {
            factors: factors.map(|f| S::as_mut_simd_f64s(f).0),
            fill: [&mut [], &mut []],
            carried,
            left: simd.splat_f64s(0.0),
        };
        for at in (0..alpha.len()).step_by(BLOCK) {
            match alpha.len() - at {
                1 => plain.finish::<1>(simd, ring, alpha, at, steps.clone()),
                2 => plain.finish::<2>(simd, ring, alpha, at, steps.clone()),
                3 => plain.finish::<3>(simd, ring, alpha, at, steps.clone()),
                _ => plain.finish::<BLOCK>(simd, ring, alpha, at, steps.clone()),
            }
        }
    }
}

/// Registers of modes that go from row to row together. Every division waits for that of the row before: one register
/// alone would wait, and with more there is no room for the carried numbers.
const BLOCK: usize = 4;

/// Factors of all modes while they are computed, in registers of type `V`.
struct Filled<'a, V> {
    factors: [&'a mut [V]; 3],
    fill: [&'a mut [V]; 2],
    /// Sum, inverse pivot, column, row and part taken from the last sum, of the row before.
    carried: [&'a mut [V]; 5],
    /// Magnitude of column and row after the last step.
    left: V,
}

/// Both parts of an entry in all lanes. A function that is always inlined: `map` of arrays need not be.
#[inline(always)]
fn both<V>(simd: impl Simd<f64s = V>, [by_alpha, other]: [f64; 2]) -> [V; 2] {
    [simd.splat_f64s(by_alpha), simd.splat_f64s(other)]
}

impl<V: Copy> Filled<'_, V> {
    /// The carried numbers of `B` registers from `at` on.
    #[inline(always)]
    fn carried<const B: usize>(&self, at: usize) -> [[V; B]; 5] {
        std::array::from_fn(|c| std::array::from_fn(|q| self.carried[c][at + q]))
    }

    /// The steps of [`factorise_filled`] for the registers `at..at + B`.
    #[inline(always)]
    fn eliminate<const B: usize>(
        &mut self,
        simd: impl Simd<f64s = V>,
        ring: &Ring,
        alpha: &[V],
        at: usize,
        steps: Range<usize>,
    ) {
        let (k, alpha): (usize, [V; B]) = (alpha.len(), std::array::from_fn(|q| alpha[at + q]));
        let [mut sums, mut before, mut column, mut row, mut taken] = self.carried::<B>(at);
        let closing = both(simd, ring.entries(ring.last).above);
        let (one, zero) = (simd.splat_f64s(1.0), simd.splat_f64s(0.0));
        let part = |entry: [V; 2], alpha: V| simd.mul_add_e_f64s(alpha, entry[0], entry[1]);
        let mut left = zero;
        for (number, step) in steps.enumerate() {
            let i = ring.node(step);
            let Entries { sum, below, above } = ring.entries(i);
            let (sum, below, above) = (both(simd, sum), both(simd, below), both(simd, above));
            let [w, r, inverse] = self.factors.each_mut().map(|factor| &mut factor[i * k + at..][..B]);
            let [columns, rows] = self.fill.each_mut().map(|fill| &mut fill[number * k + at..][..B]);
            left = zero;
            for q in 0..B {
                let (below, above) = (part(below, alpha[q]), part(above, alpha[q]));
                let (link, filled, entry) = if step == 0 {
                    (zero, below, part(closing, alpha[q]))
                } else {
                    (simd.mul_f64s(below, before[q]), simd.neg_f64s(simd.mul_f64s(below, column[q])), row[q])
                };
                let excess = less(simd, part(sum, alpha[q]), link, sums[q]);
                let pivot = simd.div_f64s(one, simd.sub_f64s(simd.sub_f64s(excess, above), filled));
                let share = faded(simd, simd.mul_f64s(entry, pivot));
                (w[q], r[q], inverse[q]) = (link, simd.mul_f64s(above, pivot), pivot);
                (columns[q], rows[q]) = (filled, share);
                (sums[q], before[q]) = (excess, pivot);
                column[q] = faded(simd, simd.mul_f64s(filled, pivot));
                row[q] = simd.neg_f64s(simd.mul_f64s(above, share));
                taken[q] = simd.mul_add_e_f64s(share, excess, taken[q]);
                left = simd.add_f64s(left, simd.add_f64s(simd.abs_f64s(column[q]), simd.abs_f64s(share)));
            }
        }
        self.left = simd.add_f64s(self.left, left);
        for (carried, now) in self.carried.iter_mut().zip([sums, before, column, row, taken]) {
            carried[at..at + B].copy_from_slice(&now);
        }
    }

    /// The steps of [`factorise`] for the registers `at..at + B`.
    ///
    /// A function of its own beside [`Self::eliminate`]: both share the pivot alone, and one for both would ask in
    /// every row of the vectorised loop which of them it is.
    #[inline(always)]
    fn finish<const B: usize>(
        &mut self,
        simd: impl Simd<f64s = V>,
        ring: &Ring,
        alpha: &[V],
        at: usize,
        steps: Range<usize>,
    ) {
        let (k, alpha): (usize, [V; B]) = (alpha.len(), std::array::from_fn(|q| alpha[at + q]));
        let [mut sums, mut before, column, row, taken] = self.carried::<B>(at);
        let (one, end) = (simd.splat_f64s(1.0), steps.end);
        let part = |entry: [V; 2], alpha: V| simd.mul_add_e_f64s(alpha, entry[0], entry[1]);
        for step in steps {
            let i = ring.node(step);
            let Entries { sum, below, above } = ring.entries(i);
            let (sum, below, above) = (both(simd, sum), both(simd, below), both(simd, above));
            let [w, r, inverse] = self.factors.each_mut().map(|factor| &mut factor[i * k + at..][..B]);
            for q in 0..B {
                let (mut below, mut above) = (part(below, alpha[q]), part(above, alpha[q]));
                let mut excess = part(sum, alpha[q]);
                if step + 2 == end {
                    // The filled entry is the neighbour's here.
                    above = less(simd, above, below, column[q]);
                } else if step + 1 == end {
                    (below, above) = (simd.add_f64s(below, row[q]), simd.splat_f64s(0.0));
                    excess = simd.sub_f64s(excess, taken[q]);
                }
                let link = simd.mul_f64s(below, before[q]);
                let excess = less(simd, excess, link, sums[q]);
                let pivot = simd.div_f64s(one, simd.sub_f64s(excess, above));
                (w[q], r[q], inverse[q]) = (link, simd.mul_f64s(above, pivot), pivot);
                (sums[q], before[q]) = (excess, pivot);
            }
        }
    }
}
