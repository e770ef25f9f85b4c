//! Slip velocity of the surfaces, and the linear problem of one stretch that sticks.

use super::chebyshev::{Arch, TERMS};
use super::constants::Constants;
use super::series_line::SeriesLine;
use super::state::Tractions;
use super::surface::{AtPoints, Moments, SmoothSurfaces, dot};
use super::tables::{QUADRATURE, SHEAR, STICK};
use crate::contact::error::ContactError;
use crate::linalg::POINTS;
use std::f64::consts::{FRAC_PI_2, LN_2, PI};

/// Most unknowns: terms of the shear, the strength of a root at the end where slip begins, V and Ω.
const UNKNOWNS: usize = STICK + 2;

/// Equations as rows; the last column is the right-hand side.
pub(super) struct StickEquations {
    pub rows: [[f64; UNKNOWNS + 1]; UNKNOWNS],
    pub count: usize,
}

impl StickEquations {
    fn new(count: usize) -> Self {
        Self { rows: [[0.0; UNKNOWNS + 1]; UNKNOWNS], count }
    }

    /// Solution by elimination with the largest pivot of each column; every row is scaled first.
    pub fn solve(mut self) -> Option<[f64; UNKNOWNS]> {
        let n = self.count;
        for row in &mut self.rows[..n] {
            let scale = 1.0 / row[..n].iter().fold(0.0_f64, |m, v| m.max(v.abs()));
            row.iter_mut().for_each(|v| *v *= scale);
        }
        for k in 0..n {
            let best = (k..n).max_by(|&i, &j| self.rows[i][k].abs().total_cmp(&self.rows[j][k].abs()))?;
            self.rows.swap(k, best);
            let pivot = self.rows[k];
            if pivot[k] == 0.0 || !pivot[k].is_finite() {
                return None;
            }
            // Whole rows, whose length is known beforehand, are quicker than the parts that matter.
            for row in &mut self.rows[k + 1..n] {
                let factor = row[k] / pivot[k];
                row.iter_mut().zip(&pivot).for_each(|(v, p)| *v -= factor * p);
            }
        }
        let mut x = [0.0; UNKNOWNS];
        for k in (0..n).rev() {
            let known: f64 = (k + 1..n).map(|j| self.rows[k][j] * x[j]).sum();
            x[k] = (self.rows[k][UNKNOWNS] - known) / self.rows[k][k];
        }
        x[..n].iter().all(|v| v.is_finite()).then_some(x)
    }
}

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
        let moments = self.terms();
        let base = Moments { tangential: self.moments.normal.map(|m| self.tractions.slide * m), ..self.moments };
        let surface = SmoothSurfaces::new(&self.problem, &base, &self.pulls, self.accelerations());
        let mut rows = StickEquations::new(STICK + axes.len());
        let kernels = self.convected();
        let places = tables.stick.map(|t| centre + half * t);
        let slips = self.slip(&places, &surface, false);
        for (i, row) in rows.rows[..STICK].iter_mut().enumerate() {
            let x = places[i];
            self.stick_row(i, x, upstream, &kernels, &moments, row);
            for (column, &axis) in axes.iter().enumerate() {
                row[STICK + column] = self.motion_term(axis, x);
            }
            row[UNKNOWNS] = -slips[i];
        }
        let all = std::mem::replace(&mut self.moments, base);
        let slide = self.tractions.slide * pressure.total();
        let lifted = self.resultant()[2] + self.problem.line.radius() * (slide + self.tractions.stick.total());
        for (number, &axis) in axes.iter().enumerate() {
            let resultant = [slide, 0.0, lifted - self.problem.line.radius() * slide];
            let row = &mut rows.rows[STICK + number];
            self.balance_row(axis, half, &moments, &axes, row);
            row[UNKNOWNS] = -self.unbalance(axis, resultant);
        }
        self.moments = all;
        let x = rows.solve().ok_or(ContactError::Unsuited { reason: "the equations of stick are singular" })?;
        self.tractions.stick.terms[..SHEAR].copy_from_slice(&x[..SHEAR]);
        for (column, &axis) in axes.iter().enumerate() {
            self.rigid[axis] += x[STICK + column];
        }
        self.place_shear();
        self.displace();
        Ok(x[SHEAR])
    }

    /// Moments of the single terms of the shear [m].
    fn terms(&self) -> [AtPoints; SHEAR] {
        let Constants { tables, points, .. } = self.constants;
        let Arch { centre, half_width, .. } = self.tractions.stick;
        let values: [AtPoints; QUADRATURE] = tables.places.map(|t| points.values(centre + half_width * t));
        std::array::from_fn(|k| {
            let mut sum = AtPoints::default();
            for (weight, values) in tables.moments[k].iter().zip(&values) {
                sum.iter_mut().zip(values).for_each(|(s, v)| *s += half_width * weight * v);
            }
            sum
        })
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

    /// Coefficients of the terms of the shear and of the root in the slip at the place i of the stretch.
    fn stick_row(
        &self,
        i: usize,
        x: f64,
        upstream: f64,
        kernels: &[[AtPoints; POINTS]; 2],
        moments: &[AtPoints; SHEAR],
        row: &mut [f64],
    ) {
        let Constants { tables, points, half_plane, .. } = self.constants;
        let half = self.tractions.stick.half_width;
        let (values, slopes) = (points.values(x), points.slopes(x));
        let mut by_force = AtPoints::default();
        for k in 0..POINTS {
            for l in 0..POINTS {
                by_force[l] += values[k] * kernels[0][k][l] + slopes[k] * kernels[1][k][l];
            }
        }
        let convection = (self.rigid[0] + self.rim_velocity()) * half_plane.kernel * PI;
        let rate = -2.0 * half_plane.kernel * self.problem.line.time.a0 * half;
        for k in 0..SHEAR {
            row[k] = convection * tables.stick_cauchy[i][k] + rate * tables.stick_logarithm[i][k];
            row[k] += dot(&by_force, &moments[k]);
        }
        row[0] += rate * FRAC_PI_2 * half.ln();
        let root = -LN_2 + upstream * tables.stick[i] + half.ln();
        row[SHEAR] = convection * upstream + rate * PI * root + 2.0 * dot(&by_force, &moments[0]);
    }

    /// Change of the slip at x per unit of V or Ω, the small effect of the strains left out.
    fn motion_term(&self, axis: usize, x: f64) -> f64 {
        let points = &self.constants.points;
        let (values, slopes, rim) = (points.values(x), points.slopes(x), self.rim_velocity());
        let inertial = &self.problem.line.bodies.inertial;
        let shape = |at: &AtPoints| (0..POINTS).map(|k| at[k] * inertial[(2 * k, axis)]).sum::<f64>();
        let by_acceleration = self.problem.line.time.a0 * shape(&values) - rim * shape(&slopes);
        let own = if axis == 0 { 1.0 } else { -self.problem.line.radius() };
        own + self.problem.rigid[axis].gain * by_acceleration
    }

    /// Coefficients of the shear and of the free motions in the balance of one of them.
    fn balance_row(&self, axis: usize, half: f64, moments: &[AtPoints; SHEAR], axes: &[usize], row: &mut [f64]) {
        let (bodies, problem) = (&self.problem.line.bodies, self.problem);
        let arm = if axis == 0 { 1.0 } else { -problem.line.radius() };
        let total = FRAC_PI_2 * half;
        for (k, moment) in moments.iter().enumerate() {
            row[k] = (0..POINTS).map(|l| bodies.momentum[(axis, 2 * l)] * moment[l]).sum();
        }
        row[SHEAR] = 2.0 * (row[0] - arm * total);
        row[0] -= arm * total;
        for (column, &other) in axes.iter().enumerate() {
            row[STICK + column] = self.inertia(axis, other) * problem.rigid[other].gain;
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
        let mut rows = StickEquations::new(axes.len());
        for (row, &axis) in rows.rows.iter_mut().zip(&axes) {
            for (column, &other) in axes.iter().enumerate() {
                row[column] = self.inertia(axis, other) * self.problem.rigid[other].gain;
            }
            row[UNKNOWNS] = -self.unbalance(axis, resultant);
        }
        if axes.is_empty() {
            return Ok(0.0);
        }
        let x = rows.solve().ok_or(ContactError::Unsuited { reason: "a sliding wheel has no balance" })?;
        let mut largest = 0.0_f64;
        for (column, &axis) in axes.iter().enumerate() {
            self.rigid[axis] += x[column];
            largest = largest.max(x[column].abs() * if axis == 0 { 1.0 } else { self.problem.line.radius() });
        }
        self.displace();
        Ok(largest)
    }
}
