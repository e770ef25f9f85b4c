//! Fixed points of nonlinear maps, found faster than by iteration alone.

use super::vectorised::dot;
use nalgebra::{SMatrix, SVector};

/// Steps that are remembered.
const MEMORY: usize = 6;
/// Regularisation of the small least-squares problem, relative to its trace [1].
const REGULARISATION: f64 = 1e-12;

/// Mixing after D. G. Anderson, *J. ACM* 12 (1965): the next point is that of the remembered combination whose change
/// is smallest. Memory is kept from one problem to the next.
#[derive(Clone, Debug, Default)]
pub struct Anderson {
    point: Vec<f64>,
    change: Vec<f64>,
    /// Differences of points and of changes between consecutive iterations.
    points: Vec<Vec<f64>>,
    changes: Vec<Vec<f64>>,
    /// Scalar products of the remembered differences of changes.
    products: SMatrix<f64, MEMORY, MEMORY>,
    /// Iterations since the start.
    count: usize,
}

impl Anderson {
    /// Forgets what was before.
    pub fn restart(&mut self) {
        self.count = 0;
    }

    /// Moves `x` on, given the image `image` of the map at `x`.
    pub fn mix(&mut self, x: &mut [f64], image: &[f64]) {
        let n = x.len();
        if self.points.is_empty() {
            self.points.resize(MEMORY, Vec::new());
            self.changes.resize(MEMORY, Vec::new());
        }
        if self.count > 0 {
            let slot = (self.count - 1) % MEMORY;
            let (dx, df) = (&mut self.points[slot], &mut self.changes[slot]);
            dx.clear();
            dx.extend(x.iter().zip(&self.point).map(|(now, before)| now - before));
            df.clear();
            df.extend(x.iter().zip(image).zip(&self.change).map(|((x, g), before)| g - x - before));
            for k in 0..self.count.min(MEMORY) {
                let product = dot(&self.changes[slot], &self.changes[k]);
                (self.products[(slot, k)], self.products[(k, slot)]) = (product, product);
            }
        }
        self.point.clear();
        self.point.extend_from_slice(x);
        self.change.clear();
        self.change.extend(x.iter().zip(image).map(|(x, g)| g - x));
        let kept = self.count.min(MEMORY);
        let shares = self.shares(kept);
        x.copy_from_slice(image);
        for (share, (dx, df)) in shares.iter().zip(self.points.iter().zip(&self.changes)).take(kept) {
            for i in 0..n {
                x[i] -= share * (dx[i] + df[i]);
            }
        }
        self.count += 1;
    }

    /// Shares of the remembered differences that make the change smallest; zero where they depend on each other.
    fn shares(&self, kept: usize) -> [f64; MEMORY] {
        let mut matrix = SMatrix::<f64, MEMORY, MEMORY>::zeros();
        let mut rhs = SVector::<f64, MEMORY>::zeros();
        for i in 0..kept {
            for j in 0..kept {
                matrix[(i, j)] = self.products[(i, j)];
            }
            rhs[i] = dot(&self.changes[i], &self.change);
        }
        let shift = REGULARISATION * matrix.trace();
        for i in 0..MEMORY {
            // Rows that are not in use solve for a zero.
            matrix[(i, i)] += if i < kept { shift } else { 1.0 };
        }
        matrix.cholesky().map_or([0.0; MEMORY], |factors| factors.solve(&rhs).into())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mixing_finds_the_fixed_point_of_a_slow_contraction_with_kinks_within_a_few_iterations() {
        // Symmetric like the diffusion behind the fixed points of this program; iteration alone takes 120 steps. A
        // rotation of the unknowns, whose eigenvalues lie on a circle, would be the worst case of any short memory: 128
        // steps.
        let source = |i: usize| 0.05 + 0.5 * (i as f64).sin();
        let map = |x: &[f64]| -> Vec<f64> {
            let n = x.len();
            let beside = |i: usize| 0.475 * (x[(i + 1) % n] + x[(i + n - 1) % n]);
            (0..n).map(|i| (beside(i) + source(i)).clamp(-0.4, 2.0)).collect()
        };
        let mut anderson = Anderson::default();
        for _ in 0..2 {
            let mut x = vec![0.0; 12];
            anderson.restart();
            let mut count = 0;
            loop {
                let image = map(&x);
                let change = x.iter().zip(&image).fold(0.0_f64, |m, (x, g)| m.max((x - g).abs()));
                if change < 1e-9 {
                    break;
                }
                anderson.mix(&mut x, &image);
                count += 1;
                assert!(count < 40, "change {change}");
            }
            println!("{count} iterations");
        }
    }
}
