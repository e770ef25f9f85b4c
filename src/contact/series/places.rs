//! Places of integration of a traction.

use super::chebyshev::Arch;
use super::surface::{AtPoints, dot};
use super::tables::{QUADRATURE, Tables};
use crate::contact::flexibility::ByPowers;
use crate::linalg::Lagrange;
use crate::linalg::vectorised::vectorised;

/// A number at every place.
pub type AtPlaces = [f64; QUADRATURE];

/// Places of integration with everything that does not depend on shear.
#[derive(Clone, Copy, Debug, Default)]
pub struct Places {
    /// Positions \[m].
    pub x: AtPlaces,
    /// Tractions of the series there times the weights [N/m].
    pub force: AtPlaces,
    /// `∫ p ln|x − s| ds` there, and its sum with the forces [N/m].
    pub logarithm: AtPlaces,
    pub work: f64,
    /// Moments of the forces with the powers of the place over the half-length of the line [N/m], and with the polynomials of
    /// the points.
    pub powers: ByPowers,
    pub moments: AtPoints,
}

/// `Σ a b`.
#[inline(always)]
pub fn total(a: &AtPlaces, b: &AtPlaces) -> f64 {
    let mut sums = [0.0; 4];
    for (a, b) in a.chunks_exact(4).zip(b.chunks_exact(4)) {
        for l in 0..4 {
            sums[l] += a[l] * b[l];
        }
    }
    (sums[0] + sums[1]) + (sums[2] + sums[3])
}

impl Places {
    /// Puts the places on the stretch of a traction `arch`, on which the logarithms are those of the `pressure`; the line has the half-length
    /// `length` \[m].
    pub fn put(&mut self, tables: &Tables, points: &Lagrange, [arch, pressure]: [&Arch; 2], length: f64) {
        place(tables, arch, self);
        self.logarithm = pressure.logarithm(&self.x);
        self.work = total(&self.force, &self.logarithm);
        self.powers = arch.moments(length);
        self.moments = points.moments_over(&self.powers, length);
    }

    /// `Σ` of the forces times a smooth displacement, with the values `u` at the points, less `factor` times the logarithms.
    pub fn moved(&self, u: &AtPoints, factor: f64) -> f64 {
        dot(u, &self.moments) - factor * self.work
    }
}

vectorised! {
    /// Puts the places on the stretch of a traction, with its forces.
    fn place<'a, S>(_simd, tables: &'a Tables, arch: &'a Arch, places: &'a mut Places) {
        for (x, t) in places.x.iter_mut().zip(&tables.places) {
            *x = arch.centre + arch.half_width * t;
        }
        let mut force = [0.0; QUADRATURE];
        for (term, moments) in arch.terms[..arch.count].iter().zip(&tables.moments) {
            for q in 0..QUADRATURE {
                force[q] += term * moments[q];
            }
        }
        for force in &mut force {
            *force *= arch.half_width;
        }
        places.force = force;
    }
}

vectorised! {
    /// `Σ` of the forces times the height of the hub of a wheel of this radius \[m].
    fn hub_arm<'a, S>(_simd, places: &'a Places, radius: f64) -> f64 {
        let mut height = places.x;
        for height in &mut height {
            *height = (radius * radius - *height * *height).sqrt();
        }
        total(&places.force, &height)
    }
}
