//! The one-dimensional example of the introduction (\[I] § 4.2, 5.3): heated rod in a stream,
//! `ρc V dθ/dx − k d²θ/dx² = R`, `θ = 0` at both ends, by three schemes.

use crate::stabilise::{Scheme, bubble_position, upwind};

/// A rod in a stream. The thesis takes 1 for all but length, source and velocity.
#[derive(Clone, Copy, Debug)]
pub struct Rod {
    /// Length \[m].
    pub length: f64,
    /// Heat capacity of the volume `ρc` [J/(m³ K)].
    pub capacity: f64,
    /// Conductivity `k` [W/(m K)].
    pub conductivity: f64,
    /// Source `R` [W/m³].
    pub source: f64,
    /// Velocity `V` [m/s].
    pub velocity: f64,
}

impl Rod {
    /// The rod of the introduction: `L = 1`, and its ends are at `±L`.
    pub fn of_the_thesis(velocity: f64) -> Self {
        Self { length: 2.0, capacity: 1.0, conductivity: 1.0, source: 1000.0, velocity }
    }

    /// Exact temperature \[K] at `x` \[m], \[I] (4.6).
    pub fn exact(&self, x: f64) -> f64 {
        let stream = self.capacity * self.velocity / self.conductivity;
        if stream == 0.0 {
            return 0.5 * self.source / self.conductivity * x * (self.length - x);
        }
        // (e^{sx} − 1)/(e^{sL} − 1) without overflow.
        let skew =
            ((stream * (x - self.length)).exp() - (-stream * self.length).exp()) / -(-stream * self.length).exp_m1();
        self.source / (self.capacity * self.velocity) * (x - self.length * skew)
    }

    /// Temperatures \[K] at the `elements + 1` nodes of equal elements, for a velocity that is not negative.
    pub fn solve(&self, elements: usize, scheme: Scheme) -> Vec<f64> {
        let h = self.length / elements as f64;
        let ([[a, b], [c, d]], [f, g]) = self.element(h, scheme);
        // The tridiagonal system of the inner nodes: lower entry c, diagonal d + a, upper entry b.
        let inner = elements - 1;
        let (mut diagonal, mut theta) = (vec![d + a; inner], vec![f + g; inner]);
        for i in 1..inner {
            let factor = c / diagonal[i - 1];
            diagonal[i] -= factor * b;
            theta[i] -= factor * theta[i - 1];
        }
        for i in (0..inner).rev() {
            let above = if i + 1 < inner { b * theta[i + 1] } else { 0.0 };
            theta[i] = (theta[i] - above) / diagonal[i];
        }
        [&[0.0][..], &theta, &[0.0]].concat()
    }

    /// Matrix and load of one element of length `h` \[m].
    fn element(&self, h: f64, scheme: Scheme) -> ([[f64; 2]; 2], [f64; 2]) {
        let peclet = self.capacity * self.velocity * h / self.conductivity;
        match scheme {
            Scheme::Galerkin => self.galerkin(h),
            Scheme::Supg => {
                // The weight grows upstream by ± half of the upwind function; its slope is constant.
                let ([[a, b], [c, d]], [f, g]) = self.galerkin(h);
                let shift = 0.5 * upwind(0.5 * peclet);
                let (k, s) = (self.capacity * self.velocity * shift, self.source * h * shift);
                ([[a + k, b - k], [c - k, d + k]], [f - s, g + s])
            }
            Scheme::Bubble => {
                let share = bubble_position(peclet);
                let ([[a, b], [c, d]], [f, g]) = self.galerkin(share * h);
                let ([[p, q], [r, t]], [u, v]) = self.galerkin((1.0 - share) * h);
                let (pivot, load) = (d + p, g + u);
                (
                    [[a - b * c / pivot, -b * q / pivot], [-r * c / pivot, t - r * q / pivot]],
                    [f - b * load / pivot, v - r * load / pivot],
                )
            }
        }
    }

    /// Linear element of length `h` \[m] with equal weight and trial functions.
    fn galerkin(&self, h: f64) -> ([[f64; 2]; 2], [f64; 2]) {
        let (k, v, s) = (self.conductivity / h, 0.5 * self.capacity * self.velocity, 0.5 * self.source * h);
        ([[k - v, -k + v], [-k - v, k + v]], [s, s])
    }

    /// Largest error at a node, relative to the largest exact temperature at one.
    pub fn nodal_error(&self, elements: usize, scheme: Scheme) -> f64 {
        let exact = |i: usize| self.exact(self.length * i as f64 / elements as f64);
        let theta = self.solve(elements, scheme);
        let error = theta.iter().enumerate().fold(0.0_f64, |worst, (i, theta)| worst.max((theta - exact(i)).abs()));
        error / (0..=elements).fold(0.0_f64, |most, i| most.max(exact(i)))
    }
}
