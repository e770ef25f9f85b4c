//! The linear problem of one line of which a given stretch sticks, as a function of what it shares with other lines.

use super::chebyshev::{Arch, TERMS};
use super::equations::{Coefficients, ROOM, eliminate};
use super::places::moments;
use super::series_line::SeriesLine;
use super::surface::{AtPoints, SmoothSurfaces};
use super::tables::{SHEAR, STICK, STICK_ROOM, Tables};
use crate::contact::error::ContactError;
use crate::linalg::vectorised::vectorised;
use crate::linalg::{Lagrange, POINTS};
use std::f64::consts::{FRAC_PI_2, LN_2, PI};

/// Shared unknowns: moments of the shear of all lines with the polynomials, V and Ω.
pub const SHARED: usize = POINTS + 2;

/// Tractions of a stretch that sticks: ten terms of the shear and the strength of a root at the end where slip begins
/// \[Pa], for the known part of the slip and per unit of every shared unknown.
pub struct Stretch {
    /// Half of its length \[m].
    half: f64,
    /// Moments of the terms of the shear with the polynomials \[m].
    moments: [AtPoints; SHEAR],
    /// Solutions: of the known part, then those that a unit of the shared unknowns takes away.
    solutions: [Coefficients; 1 + SHARED],
}

impl Stretch {
    /// Moments with the polynomials [N/m] of the tractions of a solution.
    fn moments_of(&self, x: &Coefficients) -> AtPoints {
        let mut sums = self.moments[0].map(|moment| 2.0 * x[SHEAR] * moment);
        for (term, moments) in x[..SHEAR].iter().zip(&self.moments) {
            sums.iter_mut().zip(moments).for_each(|(sum, moment)| *sum += term * moment);
        }
        sums
    }

    /// Moments of the tractions without shared unknowns, and those that a unit of each takes away.
    pub fn moments(&self) -> [AtPoints; 1 + SHARED] {
        self.solutions.each_ref().map(|x| self.moments_of(x))
    }

    /// Force of the tractions without shared unknowns [N/m], and those that a unit of each takes away.
    pub fn forces(&self) -> [f64; 1 + SHARED] {
        self.solutions.each_ref().map(|x| FRAC_PI_2 * self.half * (x[0] + 2.0 * x[SHEAR]))
    }

    /// Terms of the shear and the root under given shared unknowns \[Pa].
    pub fn tractions(&self, shared: &[f64; SHARED]) -> Coefficients {
        let mut x = self.solutions[0];
        for (value, solution) in shared.iter().zip(&self.solutions[1..]) {
            x.iter_mut().zip(solution).for_each(|(x, by)| *x -= value * by);
        }
        x
    }
}

impl SeriesLine<'_> {
    /// Begins a stretch of half-length `half` \[m] that sticks from the leading edge on, without shear yet; `None`:
    /// nothing sticks.
    pub fn begin_stretch(&mut self, half: Option<f64>) {
        let (pressure, upstream) = (&self.tractions.pressure, self.upstream());
        self.tractions.stick = half.map_or_else(Arch::default, |half| {
            let centre = pressure.centre + upstream * (pressure.half_width - half);
            Arch { centre, half_width: half, count: SHEAR, terms: [0.0; TERMS] }
        });
        self.moments.tangential = self.moments.normal.map(|m| self.tractions.slide * m);
    }

    /// Tractions of the stretch that sticks, with the smooth displacements `surface` of the friction of slip.
    pub fn stretch(
        &self,
        surface: &SmoothSurfaces,
        axes: impl Iterator<Item = usize>,
    ) -> Result<Stretch, ContactError> {
        let (tables, points) = (&self.constants.tables, &self.constants.points);
        let Arch { centre, half_width: half, .. } = self.tractions.stick;
        let x = tables.stick.map(|t| centre + half * t);
        let values = points.values_at(&tables.places.map(|t| centre + half * t));
        let mut columns = [[0.0; ROOM]; STICK + 1 + SHARED];
        let kernel = self.problem.line.kernel.tangential;
        let factors = SlipFactors {
            convection: (self.rigid[0] + self.rim_velocity()) * kernel.factor * PI,
            rate: -2.0 * kernel.factor * self.problem.line.time.a0 * half,
            size: libm::log(half) - kernel.reach,
            upstream: self.upstream(),
        };
        write_columns(tables, points, &x, &self.convected(), &factors, &mut columns);
        let slips = self.slip(&x, surface, false);
        columns[STICK][..STICK].iter_mut().zip(slips).for_each(|(right, slip)| *right = -slip);
        for axis in axes {
            let column = &mut columns[STICK + 1 + POINTS + axis / 2];
            column[..STICK].copy_from_slice(&self.motion_terms(axis, &x)[..STICK]);
        }
        if !eliminate(&mut columns, STICK) {
            return Err(ContactError::Unsuited { reason: "the equations of stick are singular" });
        }
        let solutions = std::array::from_fn(|k| columns[STICK + k]);
        Ok(Stretch { half, moments: moments(&tables.moments, &values, half), solutions })
    }

    /// Takes the terms of the shear; returns the strength of the traction `√((1 − t)/(1 + t))` that holds the end of
    /// the stretch \[Pa]: no friction can, so that it vanishes in a solution.
    pub fn take(&mut self, x: &Coefficients) -> f64 {
        self.tractions.stick.terms[..SHEAR].copy_from_slice(&x[..SHEAR]);
        x[SHEAR]
    }

    /// Effect of tangential forces of all lines on the slip by the smooth displacements: by their values and by their
    /// slopes.
    fn convected(&self) -> [[AtPoints; POINTS]; 2] {
        let ([wheel, rail], v) = (self.problem.line.bodies.shared.compliance, self.rigid[0]);
        let (rim, a0) = (self.rim_velocity(), self.problem.line.time.a0);
        let entry = |matrix: &nalgebra::DMatrix<f64>, k: usize, l: usize| matrix[(2 * k, 2 * l)];
        let value = |k, l| a0 * (entry(wheel, k, l) + entry(rail, k, l));
        let slope = |k, l| -rim * entry(wheel, k, l) - v * entry(rail, k, l);
        [
            std::array::from_fn(|k| std::array::from_fn(|l| value(k, l))),
            std::array::from_fn(|k| std::array::from_fn(|l| slope(k, l))),
        ]
    }

    /// Change of the slip at x per unit of V or Ω, the small effect of the strains left out.
    fn motion_terms(&self, axis: usize, x: &[f64; STICK_ROOM]) -> [f64; STICK_ROOM] {
        let (bodies, rim) = (&self.problem.line.bodies, self.rim_velocity());
        let answer: AtPoints = std::array::from_fn(|k| bodies.inertial[(2 * k, axis)]);
        let shape = self.constants.points.polynomial(&answer);
        let own = if axis == 0 { 1.0 } else { -self.problem.line.radius() };
        let (a0, gain) = (self.problem.line.time.a0, self.problem.rigid[axis].gain);
        x.map(|x| own + gain * (a0 * shape.at(x) - rim * shape.slope(x)))
    }
}

/// Common parts of the coefficients of all terms.
pub(super) struct SlipFactors {
    /// Of the Cauchy integrals over π, and of the logarithmic ones.
    convection: f64,
    rate: f64,
    /// Logarithm of the half-length of the stretch over the reach of the line.
    size: f64,
    upstream: f64,
}

vectorised! {
    /// Writes the coefficients of the terms of the shear, of the root and of the shared moments in the slip at the
    /// places x.
    fn write_columns<'a, S>(
        _simd,
        tables: &'a Tables,
        points: &'a Lagrange,
        x: &'a [f64; STICK_ROOM],
        kernels: &'a [[AtPoints; POINTS]; 2],
        factors: &'a SlipFactors,
        columns: &'a mut [Coefficients; STICK + 1 + SHARED],
    ) {
        let SlipFactors { convection, rate, size, upstream } = *factors;
        let (values, slopes) = (points.values_at(x), points.slopes_at(x));
        // Slip at the places by a tangential force with a unit moment, by point.
        for (l, column) in columns[STICK + 1..STICK + 1 + POINTS].iter_mut().enumerate() {
            for k in 0..POINTS {
                let (of_value, of_slope) = (kernels[0][k][l], kernels[1][k][l]);
                for i in 0..STICK {
                    column[i] += values[k][i] * of_value + slopes[k][i] * of_slope;
                }
            }
        }
        let (terms, others) = columns.split_at_mut(SHEAR);
        let of_terms = tables.stick_cauchy.iter().zip(&tables.stick_logarithm);
        for (column, (cauchy, logarithm)) in terms.iter_mut().zip(of_terms) {
            for i in 0..STICK {
                column[i] = convection * cauchy[i] + rate * logarithm[i];
            }
        }
        for ((first, root), t) in terms[0].iter_mut().zip(&mut others[0]).zip(&tables.stick[..STICK]) {
            *first += rate * FRAC_PI_2 * size;
            *root = convection * upstream + rate * PI * (-LN_2 + upstream * t + size);
        }
    }
}
