//! Places of integration of a traction.

use super::chebyshev::Arch;
use super::surface::AtPoints;
use super::tables::{QUADRATURE, Tables};
use crate::linalg::vectorised::vectorised;
use crate::linalg::{Lagrange, POINTS};

/// A number at every place.
pub type AtPlaces = [f64; QUADRATURE];

/// Places of integration with everything that does not depend on shear.
#[derive(Clone, Copy, Debug, Default)]
pub struct Places {
    /// Positions \[m].
    pub x: AtPlaces,
    /// Polynomials of the points there, by point.
    pub values: [AtPlaces; POINTS],
    /// Tractions of the series there times the weights [N/m].
    pub force: AtPlaces,
    /// `∫ p ln|x − s| ds` there [N/m].
    pub logarithm: AtPlaces,
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

/// Values of the polynomial with the values `u` at the points.
#[inline(always)]
fn polynomial(values: &[AtPlaces; POINTS], u: &AtPoints) -> AtPlaces {
    let mut sums = [0.0; QUADRATURE];
    for (values, u) in values.iter().zip(u) {
        for q in 0..QUADRATURE {
            sums[q] += u * values[q];
        }
    }
    sums
}

vectorised! {
    /// Puts the places on the stretch of a traction; returns its moments with the polynomials [N/m]. The logarithms are
    /// those of the `pressure`.
    fn place<'a, S>(_simd, tables: &'a Tables, points: &'a Lagrange, arch: &'a Arch, places: &'a mut Places) -> AtPoints {
        for (x, t) in places.x.iter_mut().zip(&tables.places) {
            *x = arch.centre + arch.half_width * t;
        }
        places.values = points.values_at(&places.x);
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
        let mut moments = [0.0; POINTS];
        for (moment, values) in moments.iter_mut().zip(&places.values) {
            *moment = total(values, &places.force);
        }
        moments
    }
}

vectorised! {
    /// `Σ` of the forces times a smooth displacement, with the values `u` at the points, less `factor` times the
    /// logarithms; and `Σ` of the forces times the height of the hub of a wheel of this radius \[m].
    fn turns<'a, S>(_simd, places: &'a Places, u: &'a AtPoints, factor: f64, radius: f64) -> [f64; 2] {
        let (mut along, mut height) = (polynomial(&places.values, u), places.x);
        for q in 0..QUADRATURE {
            along[q] -= factor * places.logarithm[q];
            height[q] = (radius * radius - height[q] * height[q]).sqrt();
        }
        [total(&places.force, &along), total(&places.force, &height)]
    }
}

vectorised! {
    /// `Σ` of the forces times a smooth displacement, with the values `u` at the points, less `slope x` and less
    /// `factor` times the logarithms.
    fn lifts<'a, S>(_simd, places: &'a Places, u: &'a AtPoints, slope: f64, factor: f64) -> f64 {
        let mut lift = polynomial(&places.values, u);
        for (lift, (x, logarithm)) in lift.iter_mut().zip(places.x.iter().zip(&places.logarithm)) {
            *lift -= slope * x + factor * logarithm;
        }
        total(&places.force, &lift)
    }
}

vectorised! {
    /// Moments of the single terms of a series on the stretch of these places with the polynomials \[m].
    fn moments<'a, S, const N: usize>(
        _simd,
        terms: &'a [AtPlaces; N],
        values: &'a [AtPlaces; POINTS],
        half_width: f64,
    ) -> [AtPoints; N] {
        let mut moments = [[0.0; POINTS]; N];
        for (moments, term) in moments.iter_mut().zip(terms) {
            for (moment, values) in moments.iter_mut().zip(values) {
                *moment = half_width * total(term, values);
            }
        }
        moments
    }
}
