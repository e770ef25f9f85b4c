//! The normal problem: pressure, edges and height of the hub under the present shear.

use super::constants::Constants;
use super::series_line::SeriesLine;
use super::surface::{answer, dot};
use super::tables::{PRESSURE, SMOOTH};
use crate::contact::error::ContactError;
use crate::linalg::POINTS;
use std::f64::consts::PI;

/// Largest factor by which an iteration changes the load.
const LARGEST_FACTOR: f64 = 4.0;

impl SeriesLine<'_> {
    /// Improves edges, pressure and height of the hub; returns the largest relative change.
    ///
    /// The gap stays closed where its slope vanishes. As a series in `T_n(t)` the slope without pressure gives the
    /// terms of the pressure one by one, `p_k = A_{k+1}/(2πκ)`; `A_0 = 0` is the condition for the middle of the patch.
    /// Its width belongs to the load, and load and height to each other by the gap in the middle and the balance of the
    /// hub.
    pub fn press(&mut self) -> Result<f64, ContactError> {
        let Constants { tables, points, half_plane, .. } = self.constants;
        let radius = self.problem.line.surfaces.radius;
        let gap = points.polynomial(&self.surface.gap());
        let pressure = self.tractions.pressure;
        let (centre, half_width) = (pressure.centre, pressure.half_width);
        if centre.abs() + half_width >= points.reach {
            let load = pressure.total();
            return Err(ContactError::ZoneExceeded { zone: points.reach, load });
        }
        let slope = |x: f64| x / (radius * radius - x * x).sqrt() + gap.slope(x) - self.rim_angle;
        let places = tables.closed.map(|t| centre + half_width * t);
        let slopes = places.map(slope);
        let warm = self.layers.as_ref().map_or([0.0; SMOOTH], |layers| std::array::from_fn(|n| layers.slope[n]));
        let series: [f64; SMOOTH] = std::array::from_fn(|n| {
            let sum: f64 = slopes.iter().zip(&tables.closed_terms[n]).map(|(s, t)| s * t).sum();
            sum * if n == 0 { 1.0 } else { 2.0 } / SMOOTH as f64 + warm[n] / half_width
        });
        let kernel = half_plane.kernel;
        let pressure = &mut self.tractions.pressure;
        pressure.count = PRESSURE;
        for k in 0..PRESSURE {
            pressure.terms[k] = series[k + 1] / (2.0 * PI * kernel);
        }
        let shift = -series[0] * radius;
        if shift.abs() > half_width || pressure.terms[0] <= 0.0 {
            return Err(ContactError::Unsuited { reason: "the patch moves by more than its width" });
        }
        let factor = self.carry()?;
        let pressure = &mut self.tractions.pressure;
        pressure.centre += shift;
        pressure.half_width *= factor.sqrt();
        pressure.terms[..PRESSURE].iter_mut().for_each(|p| *p *= factor.sqrt());
        self.place_pressure();
        self.place_shear();
        self.displace();

        Ok((factor - 1.0).abs().max(shift.abs() / half_width))
    }

    /// Factor by which the load has to change \[1]; sets the height of the hub.
    fn carry(&mut self) -> Result<f64, ContactError> {
        let Constants { points, half_plane, .. } = self.constants;
        let (problem, pressure) = (self.problem, &self.tractions.pressure);
        let (load, at, motion) = (pressure.total(), pressure.centre, &problem.rigid[1]);
        let values = points.values(at);
        let round = problem.line.surfaces.round_gap(at, &problem.line.placement)
            + self.warm(&[at], |layers, x| layers.gap.at(x))[0];
        let half_planes = -2.0 * half_plane.kernel * pressure.logarithm(&[at])[0];
        let gap = round + dot(&values, &self.surface.gap()) - self.rim_angle * at + self.rigid[1] + half_planes;
        let compliances = problem.line.bodies.own.compliance;
        let smooth: f64 = compliances.iter().map(|matrix| dot(&answer(matrix, 1, 1, &values), &values)).sum();
        let by_load = smooth - 2.0 * half_plane.kernel * (0.5 * pressure.half_width).ln();
        let lifted: f64 = (0..POINTS).map(|k| values[k] * problem.line.bodies.inertial[(2 * k + 1, 1)]).sum();
        let by_height = 1.0 + motion.gain * lifted;
        let change = if let Some(target) = motion.target() {
            let rise = target - self.rigid[1];
            self.rigid[1] = target;
            -(gap + rise) / by_load
        } else {
            let momentum: f64 = (0..POINTS).map(|k| values[k] * problem.line.bodies.momentum[(1, 2 * k + 1)]).sum();
            let left = self.unbalance(1, [0.0, load, 0.0]);
            let (balance_load, inertia) =
                (momentum - 1.0, motion.inertia + problem.line.bodies.deformation_inertia[(1, 1)]);
            let balance_height = motion.gain * inertia;
            // Two linear equations in the changes of load and height.
            let determinant = by_load * balance_height - by_height * balance_load;
            let change = (by_height * left - gap * balance_height) / determinant;
            self.rigid[1] -= (gap * -balance_load + left * by_load) / determinant;
            change
        };
        let factor = 1.0 + change / load;
        if !(factor > 0.0 && factor.is_finite()) {
            return Err(ContactError::Unsuited { reason: "the patch opens" });
        }
        Ok(factor.clamp(1.0 / LARGEST_FACTOR, LARGEST_FACTOR))
    }
}
