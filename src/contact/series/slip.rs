//! Slip velocity of the surfaces of a line.

use super::chebyshev::Arch;
use super::constants::Constants;
use super::series_line::SeriesLine;
use super::state::Tractions;
use super::surface::{AtPoints, SmoothSurfaces, plus};
use crate::contact::flexibility::ByPowers;
use crate::linalg::vectorised::vectorised;

impl SeriesLine<'_> {
    /// Velocity of the wheel surface relative to that of the rail at x [m/s] with the smooth displacements `surface`,
    /// under the pressure, the friction of slip and, if `sticks`, the part that sticking takes away from it.
    pub fn slip<const N: usize>(&self, x: &[f64; N], surface: &SmoothSurfaces, sticks: bool) -> [f64; N] {
        let (Constants { points, .. }, kernel) = (self.constants, self.problem.line.kernel);
        let (v, rim, length) = (self.rigid.travel, self.rim_velocity(), self.half_length);
        let (time, along) = (&self.problem.line.time, kernel.tangential.factor);
        let stick = if sticks { self.tractions.stick } else { Arch::default() };
        let tractions = Tractions { stick, ..self.tractions };
        let SmoothSurfaces { wheel, rail } = surface;
        let carried: AtPoints = std::array::from_fn(|k| v * rail.tangential[k] - rim * wheel.tangential[k]);
        // What is a polynomial is added up before it is taken at the places.
        let mut smooth = points.polynomial(&carried).derivative().by_powers(length);
        smooth[0] += v - self.problem.line.radius() * self.rigid.rotation - self.spin() * self.problem.line.position;
        if self.problem.line.patch.is_some() {
            smooth = plus(&smooth, &self.field.slip(self.slip_of_field()));
        }
        let mut rest = self.warm(x, |layers, x| layers.stretch(x, [-rim, v]));
        let mut rate = 0.0;
        if !time.is_stationary() {
            rate = -2.0 * along * time.a0;
            let relative = points.polynomial(&self.relative(surface, sticks)).by_powers(length);
            smooth.iter_mut().zip(&relative).for_each(|(sum, relative)| *sum += time.a0 * relative);
            let own = (self.before.kernel.tangential.factor, Some(self.problem.line.share));
            for (past, weight) in self.before.past.iter().zip([time.a1, time.a2]) {
                past.add(weight, (x, own, points), length, (&mut smooth, &mut rest));
            }
        }
        let (shear, pressure) = (tractions.shear_effect([(v + rim) * along, rate], x), tractions.pressure.density(x));
        let (tilt, squeeze) = (rim * self.rim_angle, (rim - v) * kernel.coupling);
        let mut slip = add_up(x, &smooth, 1.0 / length, [tilt, self.problem.line.surfaces.radius], [&rest, &shear]);
        slip.iter_mut().zip(&pressure).for_each(|(slip, pressure)| *slip += squeeze * pressure);
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

vectorised! {
    /// Sums of others, of a polynomial of the places times `scale`, and of the slip of a round wheel that turns with a rim speed times
    /// the rim angle `tilt` [m/s].
    fn add_up<'a, S, const N: usize>(
        _simd,
        x: &'a [f64; N],
        polynomial: &'a ByPowers,
        scale: f64,
        wheel: [f64; 2],
        others: [&'a [f64; N]; 2],
    ) -> [f64; N] {
        let ([tilt, radius], [first, second], mut sums) = (wheel, others, [0.0; N]);
        for c in polynomial.iter().rev() {
            for i in 0..N {
                sums[i] = sums[i] * (x[i] * scale) + c;
            }
        }
        for i in 0..N {
            sums[i] += (first[i] + second[i]) - tilt * x[i] / (radius * radius - x[i] * x[i]).sqrt();
        }
        sums
    }
}
