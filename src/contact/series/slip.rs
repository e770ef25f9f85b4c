//! Slip velocity of the surfaces of a line.

use super::chebyshev::Arch;
use super::constants::Constants;
use super::series_line::SeriesLine;
use super::state::Tractions;
use super::surface::{AtPoints, SmoothSurfaces};
use crate::contact::flexibility::values;

impl SeriesLine<'_> {
    /// Velocity of the wheel surface relative to that of the rail at x [m/s] with the smooth displacements `surface`,
    /// under the pressure, the friction of slip and, if `sticks`, the part that sticking takes away from it.
    pub fn slip<const N: usize>(&self, x: &[f64; N], surface: &SmoothSurfaces, sticks: bool) -> [f64; N] {
        let (Constants { points, .. }, kernel) = (self.constants, self.problem.line.kernel);
        let (v, rim, radius) = (self.rigid.travel, self.rim_velocity(), self.problem.line.surfaces.radius);
        let (time, along) = (&self.problem.line.time, kernel.tangential.factor);
        let stick = if sticks { self.tractions.stick } else { Arch::default() };
        let tractions = Tractions { stick, ..self.tractions };
        let (cauchy, pressure) = (tractions.shear_cauchy(x), tractions.pressure.density(x));
        let SmoothSurfaces { wheel, rail } = surface;
        let carried: AtPoints = std::array::from_fn(|k| v * rail.tangential[k] - rim * wheel.tangential[k]);
        let carried = points.polynomial(&carried);
        let rigid = v - self.problem.line.radius() * self.rigid.rotation - self.spin() * self.problem.line.position;
        let warm = self.warm(x, |layers, x| layers.stretch(x, [-rim, v]));
        let by_lines = match self.problem.line.patch {
            Some(_) => values(&self.field.slip(self.slip_of_field()), x, self.half_length),
            None => [0.0; N],
        };
        let mut slip: [f64; N] = std::array::from_fn(|i| {
            let tilt = self.rim_angle * x[i] / (radius * radius - x[i] * x[i]).sqrt();
            let strains = (v + rim) * along * cauchy[i] + (rim - v) * kernel.coupling * pressure[i];
            rigid + strains + carried.slope(x[i]) - rim * tilt + warm[i] + by_lines[i]
        });
        if !time.is_stationary() {
            let (smooth, logarithm) =
                (points.polynomial(&self.relative(surface, sticks)), tractions.shear_logarithm(x));
            let past = self.before.kernel.tangential.factor;
            let own = (past, Some(self.problem.line.share));
            let [last, before] = self.before.past.each_ref().map(|time| time.at(x, own, points));
            for i in 0..N {
                let now = smooth.at(x[i]) - 2.0 * along * logarithm[i];
                slip[i] += time.a0 * now + time.a1 * last[i] + time.a2 * before[i];
            }
        }
        self.add_layer(&stick, x, &mut slip);
        slip
    }

    /// Adds the rate of the shear of an elastic layer between the surfaces [m/s], of which earlier times are in the past;
    /// half of the sum of both speeds carries it.
    pub fn add_layer<const N: usize>(&self, shear: &Arch, x: &[f64; N], slip: &mut [f64; N]) {
        if self.problem.line.layer == 0.0 || shear.half_width == 0.0 {
            return;
        }
        let ([_, by_shear], carried, density) = (self.slip_of_layer(), self.carried(shear, x), shear.density(x));
        (0..N).for_each(|i| slip[i] += carried[i] + by_shear * density[i]);
    }

    /// Part of the slip by which the layer is carried through the patch [m/s]. On the whole it does no work on the shear.
    pub fn carried<const N: usize>(&self, shear: &Arch, x: &[f64; N]) -> [f64; N] {
        if self.problem.line.layer == 0.0 || shear.half_width == 0.0 {
            return [0.0; N];
        }
        let [by_slope, _] = self.slip_of_layer();
        shear.slope(x).map(|slope| by_slope * slope)
    }

    /// Changes of the slip with the slope of the shear of the layer [m²/s/Pa], and with the shear [m/s/Pa].
    pub fn slip_of_layer(&self) -> [f64; 2] {
        let speed = self.rigid.travel + self.rim_velocity();
        [-0.5 * speed, self.problem.line.time.a0].map(|by| by * self.problem.line.layer)
    }
}
