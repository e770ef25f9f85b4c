//! The normal problem: pressures, edges and height of the hub under the present shear.

use super::constants::Constants;
use super::contact::{MOST_LINES, SeriesContact};
use super::series_line::SeriesLine;
use super::surface::{answer, dot};
use super::tables::{PRESSURE, SLOPE, SMOOTH};
use crate::axes::Axis;
use crate::contact::error::ContactError;
use crate::linalg::POINTS;
use std::f64::consts::PI;

/// Largest factor by which an iteration changes the load.
const LARGEST_FACTOR: f64 = 4.0;
/// Part of the zone that a patch may take while its load still jumps, by more than a factor \[1].
const ROOM: f64 = 0.95;
const JUMPS: f64 = 1.5;
/// Part of the load with which a line may stay although its surfaces are apart \[1].
const LIGHT: f64 = 1e-6;
/// Times that a patch may seem to open, at most, and beside lines that hold the wheel.
const MOST_OPENED: usize = 6;
const MOST_BESIDE: usize = 24;

/// Gap in the middle of a line, and how it depends on loads.
pub struct MiddleGap {
    /// Gap \[m].
    pub gap: f64,
    /// Change of the gap by the load of the line, by its own flexibility [m/(N/m)].
    own: f64,
}

impl SeriesLine<'_> {
    /// Gives the pressure the form that holds the gap closed; returns the shift of its middle \[m].
    ///
    /// The gap stays closed where its slope vanishes. As a series in `T_n(t)` the slope without pressure gives the
    /// terms of the pressure one by one, `p_k = A_{k+1}/(2πκ)`; `A_0 = 0` is the condition for the middle of the patch.
    pub fn shape_pressure(&mut self) -> Result<f64, ContactError> {
        let Constants { tables, points, zone, .. } = self.constants;
        let radius = self.problem.line.surfaces.radius;
        let gap = points.polynomial(&self.surface.gap());
        let pressure = self.tractions.pressure;
        let (centre, half_width) = (pressure.centre, pressure.half_width);
        if centre.abs() + half_width >= *zone {
            let load = pressure.total();
            return Err(ContactError::ZoneExceeded { zone: *zone, load });
        }
        let slope = |x: f64| x / (radius * radius - x * x).sqrt() + gap.slope(x) - self.rim_angle;
        let places = tables.closed.map(|t| centre + half_width * t);
        let slopes = places.map(slope);
        let warm = self.layers.as_ref().map_or([0.0; SLOPE], |layers| layers.slope);
        let series: [f64; SLOPE] = std::array::from_fn(|n| {
            let smooth = tables.closed_terms.get(n).map_or(0.0, |terms| {
                let sum: f64 = slopes.iter().zip(terms).map(|(s, t)| s * t).sum();
                sum * if n == 0 { 1.0 } else { 2.0 } / SMOOTH as f64
            });
            smooth + warm[n] / half_width
        });
        let kernel = self.problem.line.kernel.normal.factor;
        let count = self.pressure_terms();
        let pressure = &mut self.tractions.pressure;
        pressure.count = count;
        for k in 0..count {
            pressure.terms[k] = series[k + 1] / (2.0 * PI * kernel);
        }
        let shift = -series[0] * radius;
        if shift.abs() > half_width || pressure.terms[0] <= 0.0 {
            return Err(ContactError::Unsuited { reason: "the patch moves by more than its width" });
        }
        Ok(shift)
    }

    /// Number of the terms of the pressure: lines that no grid takes over follow all that is known of hot layers.
    fn pressure_terms(&self) -> usize {
        if self.is_sideways() && self.layers.is_some() { SLOPE - 1 } else { PRESSURE }
    }

    /// Factor of the load of a line that nothing else takes over, where patches have seemed to open so many times before: loads
    /// may fall to a part of themselves at once, patches that jump stay within the zone, and where some lines may be apart,
    /// given the `load` of all [N/m], these carry next to nothing.
    fn eased(&self, factor: f64, load: Option<f64>, opened: usize) -> f64 {
        let pressure = &self.tractions.pressure;
        if factor > JUMPS {
            let room = ROOM * (self.constants.zone - pressure.centre.abs()) / pressure.half_width;
            return factor.min(room.powi(2).max(JUMPS));
        }
        match factor <= 0.0 {
            true if load.is_some_and(|load| self.problem.line.share * self.load() <= LIGHT * load) => 1.0,
            true if opened < load.map_or(MOST_OPENED, |_| MOST_BESIDE) => 1.0 / LARGEST_FACTOR,
            _ => factor,
        }
    }

    /// Gap in the middle under the present load.
    pub fn middle_gap(&self) -> MiddleGap {
        let (pressure, kernel) = (&self.tractions.pressure, self.problem.line.kernel.normal);
        let at = pressure.centre;
        let values = self.constants.points.values(at);
        let round = self.problem.line.surfaces.round_gap(at, &self.problem.line.placement)
            + self.warm(&[at], |layers, x| layers.gap.at(x))[0];
        let own = -2.0 * kernel.factor * (pressure.logarithm(&[at])[0] - kernel.reach * pressure.total());
        let gap = round + dot(&values, &self.surface.gap()) - self.rim_angle * at + self.rigid.height + own;
        MiddleGap { gap, own: -2.0 * kernel.factor * (libm::log(0.5 * pressure.half_width) - kernel.reach) }
    }

    /// Moves the patch, and scales it to its load times `factor`; returns the largest relative change.
    pub fn resize(&mut self, shift: f64, factor: f64) -> f64 {
        let pressure = &mut self.tractions.pressure;
        let moved = shift.abs() / pressure.half_width;
        pressure.centre += shift;
        pressure.half_width *= factor.sqrt();
        pressure.terms[..pressure.count].iter_mut().for_each(|p| *p *= factor.sqrt());
        self.place_pressure();
        self.place_shear();
        (factor - 1.0).abs().max(moved)
    }
}

impl SeriesContact<'_> {
    /// Improves edges, pressures and height of the hub; returns the largest relative change.
    ///
    /// The width of a patch belongs to its load, and loads and height to each other by the gaps in the middle of all
    /// lines and the balance of the hub.
    pub fn press(&mut self) -> Result<f64, ContactError> {
        let mut shifts = [0.0; MOST_LINES];
        for (shift, line) in shifts.iter_mut().zip(&mut self.lines) {
            *shift = line.shape_pressure()?;
        }
        let mut factors = [1.0; MOST_LINES];
        self.carry(&mut factors)?;
        let changes = self.lines.iter_mut().zip(shifts).zip(factors);
        let change = changes.map(|((line, shift), factor)| line.resize(shift, factor)).fold(0.0, f64::max);
        let change = change.max(self.follow_load());
        self.displace();
        Ok(change)
    }

    /// Finds the factors by which the loads of the lines have to change \[1]; sets the height of the hub.
    fn carry(&mut self, factors: &mut [f64; MOST_LINES]) -> Result<(), ContactError> {
        let (first, motion) = (&self.lines[0], &self.rigid.height);
        let bodies = &first.problem.line.bodies;
        let values = first.constants.points.values(first.tractions.pressure.centre);
        let smooth: f64 =
            bodies.shared.compliance.iter().map(|matrix| dot(&answer(matrix, 1, 1, &values), &values)).sum();
        let middles: Vec<_> = self.lines.iter().map(SeriesLine::middle_gap).collect();
        let shares = || self.lines.iter().map(|line| line.problem.line.share).zip(&middles);
        // The lines side by side are springs in parallel.
        let stiffness: f64 = shares().map(|(share, middle)| share / middle.own).sum();
        let gap = shares().map(|(share, middle)| share * middle.gap / middle.own).sum::<f64>() / stiffness;
        let by_load = 1.0 / stiffness + smooth;
        let lifted: f64 = (0..POINTS).map(|k| values[k] * bodies.inertial[(2 * k + 1, 1)]).sum();
        let by_height = 1.0 + motion.gain * lifted;
        let (change, rise) = if let Some(target) = motion.target() {
            let rise = target - first.rigid.height;
            (-(gap + rise) / by_load, rise)
        } else {
            let momentum: f64 = (0..POINTS).map(|k| values[k] * bodies.momentum[(1, 2 * k + 1)]).sum();
            let left = self.unbalance(Axis::Height, self.load());
            let (balance_load, inertia) = (momentum - 1.0, motion.inertia + bodies.deformation_inertia[(1, 1)]);
            let balance_height = motion.gain * inertia;
            // Two linear equations in the changes of load and height.
            let determinant = by_load * balance_height - by_height * balance_load;
            let change = (by_height * left - gap * balance_height) / determinant;
            (change, -(gap * -balance_load + left * by_load) / determinant)
        };
        let by_height = if motion.target().is_some() { 1.0 } else { by_height };
        let (mut opens, load) = (false, self.partly.then(|| self.load()));
        for ((line, middle), factor) in self.lines.iter().zip(&middles).zip(factors) {
            let own = match self.lines.len() {
                1 => change / line.problem.line.share,
                _ => -(middle.gap + smooth * change + by_height * rise) / middle.own,
            };
            *factor = 1.0 + own / line.load();
            if line.is_sideways() {
                let eased = line.eased(*factor, load, self.opened);
                opens |= *factor <= 0.0 && eased < 1.0;
                *factor = eased;
            }
            if !(*factor > 0.0 && factor.is_finite()) {
                return Err(ContactError::Unsuited { reason: "the patch opens" });
            }
            *factor = factor.clamp(1.0 / LARGEST_FACTOR, LARGEST_FACTOR);
        }
        let height = motion.target().unwrap_or(first.rigid.height + rise);
        self.lines.iter_mut().for_each(|line| line.rigid.height = height);
        self.opened += usize::from(opens);
        Ok(())
    }
}
