//! Coupling of lines and free motions, as polynomials.
//!
//! The bodies pass on forces as polynomials. What that leaves out of motions and balances comes back with the exact slips of
//! the next turn.

use super::super::search::ActiveSet;
use crate::axes::{Axis, PerAxis};
use crate::contact::cone::{ByPolynomials, FreeMotion, Polynomials, TangentialCoupling};
use crate::contact::flexibility::{Between, ByMoments, ByPowers, slip_of_field};
use crate::contact::line::contact_line::ContactLine;
use crate::contact::problem::Influence;
use crate::linalg::POINTS;

/// Least force by which balances are judged, over the nominal load \[1]: lines may carry nothing.
const LEAST_FRICTION: f64 = 1e-3;

/// Slips of a line by bodies and motions, as polynomials of the place over its half-length.
struct SmoothSlips {
    half_length: f64,
    /// Slips along by unit forces on the ports along [m/s/(N/m)].
    by_ports: [ByPowers; POINTS],
    /// Slips along by unit motions.
    by_motions: PerAxis<ByPowers>,
}

impl ActiveSet<'_> {
    /// Coupling of all lines and free motions in the present iterate, but for what their balances miss.
    pub fn coupling(&mut self) -> TangentialCoupling<2> {
        let smooth: Vec<_> = self.lines.iter().map(|line| self.smooth_slips(line)).collect();
        let axes: Vec<Axis> = self.free_axes().collect();
        TangentialCoupling {
            between: self.between(&smooth),
            motions: axes.into_iter().map(|axis| self.free_motion(axis, &smooth)).collect(),
            base: self.lines[0].traction.rigid,
            radius: self.lines[0].problem.radius(),
            shares: self.lines.iter().map(|line| line.problem.share).collect(),
            friction: 0.0,
        }
    }

    /// Axes along the surfaces whose motions are sought and not held by a brake.
    pub fn free_axes(&self) -> impl Iterator<Item = Axis> {
        Axis::along().filter(|axis| self.axes.seeks(*axis) && !self.axes.holds(*axis))
    }

    /// Takes present motions, friction and what balances miss without the present shear, which has these moments.
    pub fn take_balances(&mut self, coupling: &mut TangentialCoupling<2>, moments: &[Polynomials<2>]) {
        coupling.base = self.lines[0].traction.rigid;
        coupling.friction = self.friction_of_all().max(LEAST_FRICTION * self.problem.nominal_load);
        for motion in &mut coupling.motions {
            motion.missing = -self.axes.residual(motion.axis, &self.lines) - motion.pulls(moments);
        }
    }

    /// Force of friction that all lines together bear [N/m].
    fn friction_of_all(&self) -> f64 {
        let of_line = |line: &ContactLine| {
            (0..line.grid.len()).map(|i| line.friction(i) * line.normal(i).max(0.0)).sum::<f64>() * line.problem.share
        };
        self.lines.iter().map(of_line).sum()
    }

    /// Bodies carry their polynomials through the contact as they are; the frame that turns with the rim bends them by little,
    /// which comes back with the exact slips.
    fn smooth_slips(&self, line: &ContactLine) -> SmoothSlips {
        let half_length = line.problem.patch.map_or(1.0, |patch| patch.half_length);
        let (points, bodies) = (&line.grid.points, &line.problem.bodies);
        let (v, velocity, gain) = (line.traction.rigid.travel, line.rim_velocity(), line.problem.time.a0);
        let slip = |moved: [f64; POINTS], carried: [f64; POINTS]| {
            let slopes = points.polynomial(&carried).derivative().by_powers(half_length);
            let rates = points.polynomial(&moved).by_powers(half_length);
            std::array::from_fn(|k| gain * rates[k] - slopes[k])
        };
        let by_port = |port: usize| {
            let Influence { compliance: [wheel, rail], relative } = bodies.shared;
            let carried = |k: usize| velocity * wheel[(2 * k, 2 * port)] + v * rail[(2 * k, 2 * port)];
            slip(std::array::from_fn(|k| relative[(2 * k, 2 * port)]), std::array::from_fn(carried))
        };
        let by_motion = |axis: Axis| {
            let moved: [f64; POINTS] =
                std::array::from_fn(|k| self.axes.gain(axis) * bodies.inertial[(2 * k, axis.number())]);
            let mut slip = slip(moved, moved.map(|moved| velocity * moved));
            slip[0] += line.problem.sliding(axis) - line.problem.position * self.problem.spin.by(axis);
            slip
        };
        SmoothSlips { half_length, by_ports: std::array::from_fn(by_port), by_motions: PerAxis::from_fn(by_motion) }
    }

    /// Slips of every line by unit moments of every other one: through the bodies, and as lines of a patch. A line itself
    /// has what its lateral forces do along, and those along across.
    fn between(&self, smooth: &[SmoothSlips]) -> Vec<ByPolynomials<2>> {
        let count = self.lines.len();
        (0..count * count)
            .map(|pair| {
                let (at, by) = (pair / count, pair % count);
                let (line, other) = (&self.lines[at], &self.lines[by]);
                let mut slips = ByPolynomials::default();
                if at != by {
                    let by_bodies = through_bodies(&smooth[at], (other, &smooth[by]));
                    add(&by_bodies, [0, 0], &mut slips);
                }
                let Some(patch) = line.problem.patch else { return slips };
                let rates = [line.problem.time.a0, line.traction.rigid.travel + line.rim_velocity()];
                let slip = |between: &Between| between.slips(slip_of_field(rates, patch.half_length));
                if at != by {
                    add(&slip(patch.flexibility.between(at, by)), [0, 0], &mut slips);
                }
                let Some([across, askew]) = patch.flexibility.across(at, by) else { return slips };
                if at != by {
                    add(&slip(across), [1, 1], &mut slips);
                }
                let askew = slip(askew);
                add(&askew, [0, 1], &mut slips);
                add(&askew, [1, 0], &mut slips);
                slips
            })
            .collect()
    }

    /// A motion that is free, about the present iterate.
    fn free_motion(&mut self, axis: Axis, smooth: &[SmoothSlips]) -> FreeMotion<2> {
        let Self { lines, axes, problem, .. } = self;
        let balance = axes.row(axis, lines);
        let pull = |(line, smooth): (&ContactLine, &SmoothSlips)| match axis {
            Axis::Lateral => [ByPowers::default(), first_two([line.problem.share, 0.0])],
            _ => {
                let arm = mean_pull(line, axis);
                let momentum = std::array::from_fn(|k| balance.ports[2 * k] + arm);
                let polynomial = line.grid.points.polynomial(&momentum).by_powers(smooth.half_length);
                [polynomial.map(|c| -line.problem.share * c), ByPowers::default()]
            }
        };
        let slip = |(line, smooth): (&ContactLine, &SmoothSlips)| {
            let turned = problem.spin.by(axis) * line.problem.patch.map_or(0.0, |patch| patch.half_length);
            [smooth.by_motions[axis], first_two([if axis == Axis::Lateral { 1.0 } else { 0.0 }, turned])]
        };
        FreeMotion {
            axis,
            slips: lines.iter().zip(smooth).map(slip).collect(),
            pulls: lines.iter().zip(smooth).map(pull).collect(),
            resistance: balance.motions,
            missing: 0.0,
            drawn: [0.0; 2],
        }
    }
}

/// Polynomial of the first two coefficients.
fn first_two([first, second]: [f64; 2]) -> ByPowers {
    let mut polynomial = ByPowers::default();
    (polynomial[0], polynomial[1]) = (first, second);
    polynomial
}

/// Part of the balance of an axis that tangential forces have on the mean, by normal forces: lever arms hardly differ.
fn mean_pull(line: &ContactLine, axis: Axis) -> f64 {
    let loaded = (0..line.grid.len()).filter(|&i| line.normal(i) > 0.0);
    let [sum, load] = loaded.fold([0.0; 2], |[sum, load], i| {
        let normal = line.normal(i);
        [sum + normal * line.pull_of_forces(axis, i)[0], load + normal]
    });
    if load > 0.0 { sum / load } else { line.pull_of_forces(axis, line.grid.len() / 2)[0] }
}

/// Slips along of a line by unit moments of another one through the bodies.
fn through_bodies(at: &SmoothSlips, (other, by): (&ContactLine, &SmoothSlips)) -> ByMoments {
    std::array::from_fn(|moment| {
        let mut unit = ByPowers::default();
        unit[moment] = other.problem.share;
        let mut sum = ByPowers::default();
        for (slips, force) in at.by_ports.iter().zip(other.grid.points.moments_over(&unit, by.half_length)) {
            sum.iter_mut().zip(slips).for_each(|(sum, slip)| *sum += force * slip);
        }
        sum
    })
}

/// Adds slips in a direction by moments of a direction, those along before those across.
fn add(by_moments: &ByMoments, [at, by]: [usize; 2], slips: &mut ByPolynomials<2>) {
    for (slips, by_moment) in slips[by].iter_mut().zip(by_moments) {
        slips[at].iter_mut().zip(by_moment).for_each(|(slip, by)| *slip += by);
    }
}
