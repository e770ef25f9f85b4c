//! Slip velocity of the surfaces, and the linear problem of one stretch that sticks.

use super::chebyshev::{Arch, TERMS};
use super::constants::Constants;
use super::equations::{Coefficients, StickEquations};
use super::places::moments;
use super::series_line::SeriesLine;
use super::state::Tractions;
use super::surface::{AtPoints, Moments, SmoothSurfaces};
use super::tables::{SHEAR, STICK, STICK_ROOM, Tables};
use crate::contact::error::ContactError;
use crate::linalg::vectorised::vectorised;
use crate::linalg::{Lagrange, POINTS};
use std::f64::consts::{FRAC_PI_2, LN_2, PI};

impl SeriesLine<'_> {
    /// Velocity of the wheel surface relative to that of the rail at x [m/s] with the smooth displacements `surface`,
    /// under the pressure, the friction of slip and, if `sticks`, the part that sticking takes away from it.
    pub fn slip<const N: usize>(&self, x: &[f64; N], surface: &SmoothSurfaces, sticks: bool) -> [f64; N] {
        let Constants { points, half_plane, .. } = self.constants;
        let ([v, _, omega], rim, radius) = (self.rigid, self.rim_velocity(), self.problem.line.surfaces.radius);
        let time = &self.problem.line.time;
        let stick = if sticks { self.tractions.stick } else { Arch::default() };
        let tractions = Tractions { stick, ..self.tractions };
        let (cauchy, pressure) = (tractions.shear_cauchy(x), tractions.pressure.density(x));
        let SmoothSurfaces { wheel, rail } = surface;
        let carried: AtPoints = std::array::from_fn(|k| v * rail.tangential[k] - rim * wheel.tangential[k]);
        let carried = points.polynomial(&carried);
        let rigid = v - self.problem.line.radius() * omega;
        let warm = self.warm(x, |layers, x| layers.stretch(x, [-rim, v]));
        let mut slip: [f64; N] = std::array::from_fn(|i| {
            let tilt = self.rim_angle * x[i] / (radius * radius - x[i] * x[i]).sqrt();
            let strains = (v + rim) * half_plane.kernel * cauchy[i] + (rim - v) * half_plane.coupling * pressure[i];
            rigid + strains + carried.slope(x[i]) - rim * tilt + warm[i]
        });
        if !time.is_stationary() {
            let (smooth, logarithm) = (points.polynomial(&self.relative(surface)), tractions.shear_logarithm(x));
            let [last, before] = self.before.past.each_ref().map(|past| past.at(x, half_plane.kernel, points));
            for i in 0..N {
                let now = smooth.at(x[i]) - 2.0 * half_plane.kernel * logarithm[i];
                slip[i] += time.a0 * now + time.a1 * last[i] + time.a2 * before[i];
            }
        }
        slip
    }

    /// Solves for the shear of a stretch of half-length `half` \[m] that sticks from the leading edge on, and for the
    /// motions that are not prescribed. Returns the strength of the traction `√((1 − t)/(1 + t))` that holds the other
    /// end \[Pa]: no friction can, so that it vanishes in a solution.
    pub(super) fn stick(&mut self, half: f64, upstream: f64) -> Result<f64, ContactError> {
        let tables = &self.constants.tables;
        let pressure = self.tractions.pressure;
        let centre = pressure.centre + upstream * (pressure.half_width - half);
        self.tractions.stick = Arch { centre, half_width: half, count: SHEAR, terms: [0.0; TERMS] };
        let axes: Vec<usize> = [0, 2].into_iter().filter(|&k| self.problem.rigid[k].target().is_none()).collect();
        let x = tables.stick.map(|t| centre + half * t);
        let values = self.constants.points.values_at(&tables.places.map(|t| centre + half * t));
        let moments = moments(&tables.moments, &values, half);
        let base = Moments { tangential: self.moments.normal.map(|m| self.tractions.slide * m), ..self.moments };
        let surface = SmoothSurfaces::new(&self.problem, &base, &self.pulls, self.accelerations());
        let mut equations = StickEquations::new(STICK + axes.len());
        let slips = self.slip(&x, &surface, false);
        self.shear_columns(&x, upstream, &moments, &mut equations.columns);
        for (column, &axis) in equations.columns[STICK..].iter_mut().zip(&axes) {
            column[..STICK_ROOM].copy_from_slice(&self.motion_terms(axis, &x));
        }
        equations.right()[..STICK].iter_mut().zip(slips).for_each(|(right, slip)| *right = -slip);
        let all = std::mem::replace(&mut self.moments, base);
        let slide = self.tractions.slide * pressure.total();
        let lifted = self.resultant()[2] + self.problem.line.radius() * (slide + self.tractions.stick.total());
        let count = equations.count;
        equations.columns[..count].iter_mut().for_each(|column| column[STICK..].fill(0.0));
        for (number, &axis) in axes.iter().enumerate() {
            let resultant = [slide, 0.0, lifted - self.problem.line.radius() * slide];
            self.balance_row(axis, half, &moments, &axes, (STICK + number, &mut equations.columns));
            equations.right()[STICK + number] = -self.unbalance(axis, resultant);
        }
        self.moments = all;
        let x = equations.solve().ok_or(ContactError::Unsuited { reason: "the equations of stick are singular" })?;
        self.tractions.stick.terms[..SHEAR].copy_from_slice(&x[..SHEAR]);
        for (column, &axis) in axes.iter().enumerate() {
            self.rigid[axis] += x[STICK + column];
        }
        self.place_shear();
        self.displace();
        Ok(x[SHEAR])
    }

    /// Effect of tangential forces on the slip by the smooth displacements: by their values and by their slopes.
    fn convected(&self) -> [[AtPoints; POINTS]; 2] {
        let ([wheel, rail], v, rim) = (self.problem.line.bodies.own.compliance, self.rigid[0], self.rim_velocity());
        let a0 = self.problem.line.time.a0;
        let entry = |matrix: &nalgebra::DMatrix<f64>, k: usize, l: usize| matrix[(2 * k, 2 * l)];
        let value = |k, l| a0 * (entry(wheel, k, l) + entry(rail, k, l));
        let slope = |k, l| -rim * entry(wheel, k, l) - v * entry(rail, k, l);
        [
            std::array::from_fn(|k| std::array::from_fn(|l| value(k, l))),
            std::array::from_fn(|k| std::array::from_fn(|l| slope(k, l))),
        ]
    }

    /// Coefficients of the terms of the shear and of the root in the slip at all places of the stretch.
    fn shear_columns(
        &self,
        x: &[f64; STICK_ROOM],
        upstream: f64,
        moments: &[AtPoints; SHEAR],
        columns: &mut [Coefficients],
    ) {
        let Constants { tables, points, half_plane, .. } = self.constants;
        let half = self.tractions.stick.half_width;
        let rate = -2.0 * half_plane.kernel * self.problem.line.time.a0 * half;
        let speed = self.rigid[0] + self.rim_velocity();
        let factors = SlipFactors { convection: speed * half_plane.kernel * PI, rate, size: half.ln(), upstream };
        write_columns(tables, points, x, &self.convected(), moments, &factors, columns);
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

    /// Coefficients of the shear and of the free motions in the balance of one of them.
    fn balance_row(
        &self,
        axis: usize,
        half: f64,
        moments: &[AtPoints; SHEAR],
        axes: &[usize],
        (row, columns): (usize, &mut [Coefficients]),
    ) {
        let (bodies, problem) = (&self.problem.line.bodies, self.problem);
        let arm = if axis == 0 { 1.0 } else { -problem.line.radius() };
        let total = FRAC_PI_2 * half;
        for (column, moment) in columns.iter_mut().zip(moments) {
            column[row] = (0..POINTS).map(|l| bodies.momentum[(axis, 2 * l)] * moment[l]).sum();
        }
        columns[SHEAR][row] = 2.0 * (columns[0][row] - arm * total);
        columns[0][row] -= arm * total;
        for (column, &other) in columns[STICK..].iter_mut().zip(axes) {
            column[row] = self.inertia(axis, other) * problem.rigid[other].gain;
        }
    }

    /// Inertia of an axis against the acceleration of another [kg/m, kg, kg m].
    fn inertia(&self, axis: usize, other: usize) -> f64 {
        let own = if axis == other { self.problem.rigid[axis].inertia } else { 0.0 };
        own + self.problem.line.bodies.deformation_inertia[(axis, other)]
    }

    /// Free motions of a patch that slips everywhere; returns the largest change [m/s].
    pub(super) fn glide(&mut self) -> Result<f64, ContactError> {
        self.tractions.stick = Arch::default();
        self.place_shear();
        self.displace();
        let axes: Vec<usize> = [0, 2].into_iter().filter(|&k| self.problem.rigid[k].target().is_none()).collect();
        let resultant = self.resultant();
        let mut equations = StickEquations::new(axes.len());
        for (row, &axis) in axes.iter().enumerate() {
            for (column, &other) in equations.columns.iter_mut().zip(&axes) {
                column[row] = self.inertia(axis, other) * self.problem.rigid[other].gain;
            }
            equations.right()[row] = -self.unbalance(axis, resultant);
        }
        if axes.is_empty() {
            return Ok(0.0);
        }
        let x = equations.solve().ok_or(ContactError::Unsuited { reason: "a sliding wheel has no balance" })?;
        let mut largest = 0.0_f64;
        for (column, &axis) in axes.iter().enumerate() {
            self.rigid[axis] += x[column];
            largest = largest.max(x[column].abs() * if axis == 0 { 1.0 } else { self.problem.line.radius() });
        }
        self.displace();
        Ok(largest)
    }
}

/// Common parts of the coefficients of all terms.
pub(super) struct SlipFactors {
    /// Of the Cauchy integrals over π, and of the logarithmic ones.
    convection: f64,
    rate: f64,
    /// Logarithm of the half-length of the stretch.
    size: f64,
    upstream: f64,
}

vectorised! {
    /// Writes the coefficients of the terms of the shear and of the root in the slip at the places x.
    fn write_columns<'a, S>(
        _simd,
        tables: &'a Tables,
        points: &'a Lagrange,
        x: &'a [f64; STICK_ROOM],
        kernels: &'a [[AtPoints; POINTS]; 2],
        moments: &'a [AtPoints; SHEAR],
        factors: &'a SlipFactors,
        columns: &'a mut [Coefficients],
    ) {
        let SlipFactors { convection, rate, size, upstream } = *factors;
        let (values, slopes) = (points.values_at(x), points.slopes_at(x));
        // Slip at the places by a tangential force with a unit moment, by point.
        let mut by_force = [[0.0; STICK_ROOM]; POINTS];
        for (l, sum) in by_force.iter_mut().enumerate() {
            for k in 0..POINTS {
                let (of_value, of_slope) = (kernels[0][k][l], kernels[1][k][l]);
                for i in 0..STICK_ROOM {
                    sum[i] += values[k][i] * of_value + slopes[k][i] * of_slope;
                }
            }
        }
        let mut of_first = [0.0; STICK_ROOM];
        for k in 0..SHEAR {
            let mut sum = [0.0; STICK_ROOM];
            for (by_force, moment) in by_force.iter().zip(&moments[k]) {
                for i in 0..STICK_ROOM {
                    sum[i] += by_force[i] * moment;
                }
            }
            if k == 0 {
                of_first = sum;
            }
            let (cauchy, logarithm) = (&tables.stick_cauchy[k], &tables.stick_logarithm[k]);
            for i in 0..STICK_ROOM {
                columns[k][i] = sum[i] + convection * cauchy[i] + rate * logarithm[i];
            }
        }
        for i in 0..STICK_ROOM {
            columns[0][i] += rate * FRAC_PI_2 * size;
            let root = -LN_2 + upstream * tables.stick[i] + size;
            columns[SHEAR][i] = convection * upstream + rate * PI * root + 2.0 * of_first[i];
        }
    }
}
