//! Points that move with the patch, at which shear stands: any of them sticks, or slips in any direction.
//!
//! Tractions stand at the zeros of `U_N`, `t_i = cos θ_i` with `θ_i = iπ/(N + 1)` from the leading edge on, slips at
//! `θ_i − π/(2N + 2)`, half a point upstream. For steady rolling the matrix of slips by tractions is that of Cauchy for
//! interlacing points, of which every principal minor is positive: there is one solution, which [`crate::contact::cone`]
//! finds. Where tractions and slips have the same places odd minors vanish, and searches go in circles. Theory:
//! `docs/theory/patch-contact.md`, section 3.

use super::chebyshev::{TERMS, cauchy_terms, logarithm_terms};
use crate::linalg::vectorised::vectorised;
use std::f64::consts::{FRAC_PI_2, PI};

/// Number of points: that of the terms of a traction.
pub const COUNT: usize = TERMS;
/// Signs of the shear of points that slip, from the leading edge on, or 1 where they slip in two directions; 0 where they
/// stick.
pub type Directions = [i8; COUNT];

/// Places of the points, and what tractions there do; places are counted from the middle to the leading edge, over the
/// half-width of the patch.
#[derive(Clone, Debug)]
pub struct PointTables {
    /// Places of tractions and of slips.
    pub tractions: [f64; COUNT],
    pub slips: [f64; COUNT],
    /// Terms of a traction by its values: `c_k = 2/(N + 1) Σ_j q_j sin (k + 1)θ_j`, by k.
    terms: [[f64; COUNT]; COUNT],
    /// Cauchy integrals over π, and logarithmic ones, at the places of the slips, by point of the traction.
    cauchy: [[f64; COUNT]; COUNT],
    logarithm: [[f64; COUNT]; COUNT],
    /// Slopes and values of the traction there, by point of the traction.
    slope: [[f64; COUNT]; COUNT],
    value: [[f64; COUNT]; COUNT],
}

impl PointTables {
    /// All constants, with slips half a point upstream.
    pub fn new() -> Self {
        Self::upstream_by(0.5)
    }

    /// All constants, with slips a `part` of a point upstream of the tractions.
    pub fn upstream_by(part: f64) -> Self {
        let ahead = 1.0 - part;
        let part = PI / (COUNT + 1) as f64;
        let slips = std::array::from_fn(|i| libm::cos((i as f64 + ahead) * part));
        let term = |k: usize, j: usize| 2.0 / (COUNT + 1) as f64 * libm::sin((k + 1) as f64 * (j + 1) as f64 * part);
        let terms: [[f64; COUNT]; COUNT] = std::array::from_fn(|k| std::array::from_fn(|j| term(k, j)));
        let by_point = |of: fn(f64, usize) -> [f64; TERMS]| {
            let at: [[f64; TERMS]; COUNT] = slips.map(|t| of(t, TERMS));
            let value = |i: usize, j: usize| (0..COUNT).map(|k| at[i][k] * terms[k][j]).sum();
            std::array::from_fn(|j| std::array::from_fn(|i| value(i, j)))
        };
        Self {
            tractions: std::array::from_fn(|i| libm::cos((i + 1) as f64 * part)),
            slips,
            terms,
            cauchy: by_point(cauchy_terms),
            logarithm: by_point(logarithm_terms),
            slope: by_point(slope_terms),
            value: by_point(value_terms),
        }
    }

    /// Adds the slips of an elastic layer [m/s/Pa]: by the slope of the shear by t, and by the shear.
    pub fn add_layer(&self, [by_slope, by_shear]: [f64; 2], slips: &mut [[f64; COUNT]; COUNT]) {
        if by_slope == 0.0 && by_shear == 0.0 {
            return;
        }
        for (slips, (slope, value)) in slips.iter_mut().zip(self.slope.iter().zip(&self.value)) {
            (0..COUNT).for_each(|i| slips[i] += by_slope * slope[i] + by_shear * value[i]);
        }
    }

    /// Point of the traction next to a place.
    pub fn nearest(&self, place: f64) -> usize {
        let angle = libm::acos(place.clamp(-1.0, 1.0)) * (COUNT + 1) as f64 / PI;
        (angle.round() as usize).clamp(1, COUNT) - 1
    }

    /// Slips [m/s/Pa] by shear at every point of a patch of half-width `half` \[m]: `convection` times the Cauchy integrals
    /// over π, and `rate` times the logarithmic ones, of which the line takes those at its `reach` away.
    pub fn slips_by_shear(&self, [convection, rate]: [f64; 2], [half, reach]: [f64; 2]) -> [[f64; COUNT]; COUNT] {
        mixed_slips(self, [convection, rate], FRAC_PI_2 * (libm::log(half) - reach))
    }

    /// Terms of the traction with values `q` at the points; the leading edge lies at `t = upstream`.
    pub fn terms_of(&self, q: &[f64; COUNT], upstream: f64) -> [f64; TERMS] {
        let mut sign = upstream;
        std::array::from_fn(|k| {
            sign *= upstream;
            sign * self.terms[k].iter().zip(q).map(|(by, q)| by * q).sum::<f64>()
        })
    }
}

vectorised! {
    /// See [`PointTables::slips_by_shear`]; a unit of the first term has the logarithm `size` besides.
    fn mixed_slips<'a, S>(
        _simd,
        tables: &'a PointTables,
        rates: [f64; 2],
        size: f64,
    ) -> [[f64; COUNT]; COUNT] {
        let ([convection, rate], mut slips) = (rates, [[0.0; COUNT]; COUNT]);
        for (j, slips) in slips.iter_mut().enumerate() {
            let total = rate * tables.terms[0][j] * size;
            for ((slip, cauchy), logarithm) in slips.iter_mut().zip(&tables.cauchy[j]).zip(&tables.logarithm[j]) {
                *slip = convection * cauchy + (rate * logarithm + total);
            }
        }
        slips
    }
}

/// Values of the terms `sin (k + 1)θ` at a place.
fn value_terms(t: f64, _: usize) -> [f64; TERMS] {
    let angle = libm::acos(t);
    std::array::from_fn(|k| libm::sin((k + 1) as f64 * angle))
}

/// Their slopes by t.
fn slope_terms(t: f64, _: usize) -> [f64; TERMS] {
    let angle = libm::acos(t);
    std::array::from_fn(|k| -((k + 1) as f64) * libm::cos((k + 1) as f64 * angle) / libm::sin(angle))
}

impl Default for PointTables {
    fn default() -> Self {
        Self::new()
    }
}

#[cfg(test)]
mod tests {
    use super::super::chebyshev::Arch;
    use super::*;
    use crate::axes::{Axis, PerAxis};
    use crate::contact::cone::{ConeProblem, FreeMotion, Newton, SlipRows, TangentialCoupling};
    use crate::linalg::POINTS;
    use crate::multistep::formula;

    /// Shear of half-planes in units of friction at the peak of the pressure, rolling to the leading edge with a creepage over
    /// that at which all slips; and the times that the law of friction was made linear.
    fn steady(creepage: f64) -> ([f64; COUNT], usize) {
        of_bodies([1.0, 0.0], creepage)
    }

    /// Shear as of [`steady`] of half-planes and a layer with parts of their flexibilities, `1` and `2L/κπa`.
    fn of_bodies([half_planes, layer]: [f64; 2], creepage: f64) -> ([f64; COUNT], usize) {
        let tables = PointTables::new();
        let mut by_shear = tables.slips_by_shear([half_planes, 0.0], [1.0, 0.0]);
        tables.add_layer([-layer, 0.0], &mut by_shear);
        let ([shear], _, laws) = solve(cone(by_shear, [creepage; COUNT], 1.0), [[0.0; COUNT]], vec![]).unwrap();
        (shear, laws)
    }

    /// Problem of a patch of half-width `half` under Hertz's pressure.
    fn cone(by_shear: [[f64; COUNT]; COUNT], known: [f64; COUNT], half: f64) -> ConeProblem<COUNT, 1> {
        let mut powers = vec![[0.0; COUNT]; POINTS];
        powers[0] = [1.0; COUNT];
        let rows = SlipRows { by_shear: [by_shear.to_vec()], known: [known], powers };
        let part = PI / (COUNT + 1) as f64;
        let sines: [f64; COUNT] = std::array::from_fn(|i| libm::sin((i + 1) as f64 * part));
        ConeProblem::new(rows, None, &sines.map(|sine| half * part * sine), sines.map(|sine| half * sine), half)
    }

    /// Shear with what changes of a motion, and the times that the law of friction was made linear.
    fn solve(
        problem: ConeProblem<COUNT, 1>,
        start: [[f64; COUNT]; 1],
        motions: Vec<FreeMotion<1>>,
    ) -> Option<([[f64; COUNT]; 1], f64, usize)> {
        let mut coupling = TangentialCoupling {
            between: vec![[[[[0.0; POINTS]]; POINTS]]],
            motions,
            base: PerAxis::default(),
            radius: 1.0,
            shares: vec![1.0],
            friction: FRAC_PI_2,
        };
        let mut problems = [problem];
        let mut newton = Newton::new(&mut coupling, &mut problems, &[start], PerAxis::default());
        newton.run(1e-11).ok()?;
        Some((newton.shears[0], newton.rigid.travel, newton.linear_laws))
    }

    /// Carter: `F/μP = 1 − (1 − ξ/ξ_s)²`; see `docs/theory/patch-contact.md`, section 3.
    #[test]
    fn the_force_of_steady_rolling_is_that_of_carter_at_every_creepage() {
        let tables = PointTables::new();
        let (mut worst, mut most) = (0.0_f64, 0);
        for k in -120..=120 {
            let creepage = f64::from(k) / 100.0;
            let (shear, laws) = steady(creepage);
            let force = tables.terms_of(&shear, 1.0)[0];
            let carter = -creepage.signum() * (1.0 - (1.0 - creepage.abs().min(1.0)).powi(2));
            (worst, most) = (worst.max((force - carter).abs()), most.max(laws));
            assert!(shear.iter().zip(&tables.tractions).all(|(q, t)| q.abs() <= (1.0 - t * t).sqrt() + 1e-8));
        }
        println!("Carter {worst:.1e} of friction, at most {most} linear laws");
        assert!(worst < 2e-3 && most <= 12);
    }

    /// Elastic layer between rigid bodies under Hertz's pressure: shear grows as `k(1 − t)` until it is that of friction, at
    /// `t = (k² − 1)/(k² + 1)`.
    #[test]
    fn the_force_on_a_layer_alone_is_that_of_a_brush_at_every_creepage() {
        let tables = PointTables::new();
        let brush = |k: f64| {
            let t = (k * k - 1.0) / (k * k + 1.0);
            let slips = 0.5 * (t * (1.0 - t * t).sqrt() + t.asin() + FRAC_PI_2);
            -(0.5 * k * (1.0 - t) * (1.0 - t) + slips) / FRAC_PI_2
        };
        let mut worst = 0.0_f64;
        for k in [0.02, 0.1, 0.3, 0.6, 1.0, 1.5, 2.5, 5.0, 20.0] {
            for sign in [1.0, -1.0] {
                let (shear, laws) = of_bodies([0.0, 1.0], sign * k);
                let force = sign * tables.terms_of(&shear, 1.0)[0];
                println!("k {k}: {force:.4}, brush {:.4}, {laws} linear laws", brush(k));
                worst = worst.max((force - brush(k)).abs());
            }
        }
        assert!(worst < 0.01, "{worst}");
    }

    /// Drive of the half-planes of [`Rolling`].
    #[derive(Clone, Copy, Debug)]
    enum RollingDrive {
        Creepage(f64),
        /// Force over that of sliding.
        Force(f64),
    }

    /// Half-planes that roll on each other, in units of a half-width, and of its friction at the peak of the pressure; their
    /// creepage is that over the one at which all slips.
    struct Rolling {
        tables: PointTables,
        /// Flexibility of the layer over that of the half-planes.
        layer: f64,
        past: [Arch; 2],
        /// Way of the step before; the creepage and the shear after it.
        way: f64,
        creepage: f64,
        shear: [f64; COUNT],
    }

    /// Length over half-widths at which the half-planes end, and mass over that which they move along.
    const REACH: f64 = 20.0;
    const MASS: f64 = 1e-3;

    impl Rolling {
        fn new(layer: f64) -> Self {
            let past = [Arch { half_width: 1.0, count: COUNT, ..Arch::default() }; 2];
            Self { tables: PointTables::new(), layer, past, way: 0.0, creepage: 0.0, shear: [0.0; COUNT] }
        }

        /// Displacement under a shear.
        fn displacement(&self, shear: &Arch, x: &[f64; COUNT]) -> [f64; COUNT] {
            let (logarithm, density) = (shear.logarithm(x), shear.density(x));
            let by_planes = |log: f64| (libm::log(REACH) * shear.total() - log) / PI;
            std::array::from_fn(|i| by_planes(logarithm[i]) + self.layer * density[i])
        }

        /// A step on a patch of half-width `half` with speed 1, or one of the duration `way` at rest; the times that the law of
        /// friction was made linear, or `None` if nothing is found.
        fn advance(&mut self, (way, half, rolls): (f64, f64, bool), drive: RollingDrive) -> Option<usize> {
            let time = formula(way, self.way);
            let places = self.tables.slips.map(|t| half * t);
            let [now, before] = self.past.each_ref().map(|shear| self.displacement(shear, &places));
            let given = if let RollingDrive::Creepage(creepage) = drive { creepage } else { 0.0 };
            let convection = if rolls { 1.0 } else { 0.0 };
            let mut by_shear = self.tables.slips_by_shear([convection, -time.a0 * half / PI], [half, libm::log(REACH)]);
            self.tables.add_layer([-convection * self.layer / half, time.a0 * self.layer], &mut by_shear);
            let known = std::array::from_fn(|i| given + time.a1 * now[i] + time.a2 * before[i]);
            let unit = [std::array::from_fn(|p| if p == 0 { 1.0 } else { 0.0 })];
            let inertia = MASS * time.a0;
            let motion = |share: f64| FreeMotion {
                axis: Axis::Travel,
                slips: vec![unit],
                pulls: vec![unit],
                resistance: PerAxis { travel: inertia, ..PerAxis::default() },
                missing: inertia * self.creepage - share * FRAC_PI_2 * half * half,
                drawn: [0.0; 2],
            };
            let motions = match drive {
                RollingDrive::Creepage(_) => vec![],
                RollingDrive::Force(share) => vec![motion(share)],
            };
            let (shear, further, laws) = solve(cone(by_shear, known, half), [self.shear], motions)?;
            let terms = self.tables.terms_of(&shear[0], 1.0);
            self.past = [Arch { centre: 0.0, half_width: half, count: COUNT, terms }, self.past[0]];
            (self.way, self.creepage, self.shear) = (way, given + further, shear[0]);
            Some(laws)
        }
    }

    /// Jumps of creepage and load, a held force, standing, steps of a hundredth to ten half-widths.
    #[test]
    fn states_are_found_in_all_of_ten_thousand_random_transients() {
        transients(0.0, 10_000);
    }

    #[test]
    fn states_are_found_in_all_random_transients_under_a_layer() {
        [0.01, 0.1, 1.0, 10.0].into_iter().for_each(|layer| transients(layer, 2_500));
    }

    fn transients(layer: f64, runs: usize) {
        let mut seed = 7_u64;
        let mut random = || {
            seed = seed.wrapping_mul(0x5851_f42d_4c95_7f2d).wrapping_add(0x1405_7b7e_f767_814f);
            (seed >> 11) as f64 / (1_u64 << 53) as f64
        };
        let (mut failed, mut most, mut sum, mut count) = (0, 0, 0, 0);
        for _ in 0..runs {
            let (mut rolling, mut half) = (Rolling::new(layer), 1.0);
            for _ in 0..5 {
                let way = half * libm::exp(random() * libm::log(1e3)) / 100.0;
                half = if random() < 0.3 { (0.2 + 1.8 * random()).sqrt() } else { half };
                let (held, rolls) = (random() < 0.3, random() < 0.8);
                let drive = if held {
                    RollingDrive::Force(1.8 * random() - 0.9)
                } else {
                    RollingDrive::Creepage(3.0 * random() - 1.5)
                };
                match rolling.advance((way, half, rolls), drive) {
                    Some(laws) => (most, sum, count) = (most.max(laws), sum + laws, count + 1),
                    None => failed += 1,
                }
            }
        }
        println!(
            "layer {layer}: {count} steps, {:.2} linear laws each, at most {most}; {failed} failed",
            sum as f64 / count as f64
        );
        assert_eq!(failed, 0);
    }
}
