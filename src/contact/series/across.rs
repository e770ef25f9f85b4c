//! The lateral direction of a line: slip and forces across, which plane bodies do not feel.

use super::chebyshev::Arch;
use super::points::COUNT;
use super::series_line::SeriesLine;
use super::tables::POWER;
use crate::contact::cone::ByDirection;
use crate::contact::flexibility::values;

/// Values at all points by direction.
pub type Vectors<const D: usize> = ByDirection<COUNT, D>;

impl SeriesLine<'_> {
    /// True if tractions and slips have a lateral part.
    pub fn is_sideways(&self) -> bool {
        self.problem.line.is_sideways()
    }

    /// Spin velocity [rad/s].
    pub fn spin(&self) -> f64 {
        self.problem.spin.velocity(self.rigid)
    }

    /// Speed of a motion that counts besides rolling \[m/s]: to the side, and over the patch within a step.
    pub fn speed_to_the_side(&self) -> f64 {
        self.rigid.lateral.abs() + self.problem.line.time.a0.abs() * self.tractions.pressure.half_width
    }

    /// Velocity across of the wheel surface relative to that of the rail at x [m/s]; without the shear of the line itself
    /// if it is not `sheared`.
    pub fn lateral_slip<const N: usize>(&self, x: &[f64; N], sheared: bool) -> [f64; N] {
        let (line, spin) = (self.problem.line, self.spin());
        let (time, kernel) = (&line.time, line.kernel.lateral);
        let shear = if sheared { self.tractions.lateral } else { Arch::default() };
        let (cauchy, speed) = (shear.cauchy(x), self.rigid.travel + self.rim_velocity());
        let by_lines = values(&self.across.field.slip(self.slip_of_field()), x, self.half_length);
        let mut slip: [f64; N] =
            std::array::from_fn(|i| self.rigid.lateral + spin * x[i] + speed * kernel.factor * cauchy[i] + by_lines[i]);
        if !time.is_stationary() {
            let (own, total) = (shear.logarithm(x), kernel.reach * shear.total());
            let [last, before] = self.before.past.each_ref().map(|past| past.across(x, line.share));
            for i in 0..N {
                let now = 2.0 * kernel.factor * (total - own[i]);
                slip[i] += time.a0 * now + time.a1 * last[i] + time.a2 * before[i];
            }
        }
        self.add_layer(&shear, x, &mut slip);
        slip
    }

    /// True if the point of the shear next to the place x \[m] sticks.
    pub fn sticks_at(&self, x: f64) -> bool {
        let Arch { centre, half_width, .. } = self.tractions.pressure;
        let place = self.upstream() * (x - centre) / half_width;
        self.tractions.directions.is_some_and(|states| states[self.constants.of_points.nearest(place)] == 0)
    }

    /// Places of the shear across \[m], and the forces that belong to them [N/m].
    pub fn slipping_across(&self) -> ([f64; POWER], [f64; POWER]) {
        let (tables, Arch { centre, half_width, .. }) = (&self.constants.tables, self.tractions.lateral);
        let places = tables.places.map(|t| centre + half_width * t);
        let density = self.tractions.lateral.density(&places);
        (places, std::array::from_fn(|q| half_width * tables.weights[q] * density[q]))
    }

    /// Length of the mean slip [m/s] over the pressure, once the solution has been checked.
    pub fn slip_speed(&self) -> f64 {
        match self.is_sideways() {
            true => libm::hypot(self.tread_slip(), self.mean_under_pressure(&self.across.slips)),
            false => self.tread_slip().abs(),
        }
    }

    /// Moment of the tractions about the vertical through the centre of load, `z F_x − ∫ x q_z dx` \[N].
    pub fn spin_moment(&self) -> f64 {
        let Arch { centre, half_width, terms, .. } = self.tractions.lateral;
        // `∫ √(1 − t²) U_1 t dt = π/4`.
        let about_centre = 0.25 * std::f64::consts::PI * half_width * half_width * terms[1];
        let lateral = self.tractions.lateral.total();
        self.problem.line.position * self.friction_force() - centre * lateral - about_centre
    }
}
