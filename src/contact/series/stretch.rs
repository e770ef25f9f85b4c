//! The linear problem of one line of which a given stretch sticks, as a function of what it shares with other lines.
//!
//! The slip at the places where the surfaces stick vanishes as a series in `T_n`, `n ≤ 10`. A term of the shear `U_k` adds
//! `T_{k+1}` by convection, and `T_{k+2}/(k + 2) − T_k/k` by its rate ([`super::chebyshev`]). So the equations of order
//! n ≥ 1, multiplied by n, hold the terms n − 2, n − 1 and n, with opposite coefficients of both outer ones: elimination
//! without pivots keeps the sign of the diagonal and makes it larger.

use super::chebyshev::{Arch, TERMS};
use super::moments::PlaceFactor;
use super::series_line::SeriesLine;
use super::state::Tractions;
use super::surface::SmoothSurfaces;
use super::tables::{SHEAR, STICK, STICK_ROOM, Tables};
use crate::contact::error::ContactError;
use crate::contact::flexibility::ByPowers;
use crate::linalg::POINTS;
use crate::linalg::vectorised::vectorised;
use std::f64::consts::{FRAC_PI_2, LN_2, PI};

/// Places of the rule that integrates a root times a power exactly: zeros of `T_4`, `cos(π/8)` and `cos(3π/8)`.
const ROOT_PLACES: [f64; 4] =
    [0.923_879_532_511_286_7, 0.382_683_432_365_089_8, -0.382_683_432_365_089_8, -0.923_879_532_511_286_7];

/// Place of the root behind the terms of the shear.
const ROOT: usize = TERMS;

/// A number for each solution: that of the known part of the slip, those for each power, and room for whole registers.
pub type BySolution = [f64; 8];
/// Place of the solution for the root in [`solve`].
const OF_ROOT: usize = 1 + POINTS;

/// Tractions of a stretch that sticks: terms of the shear and the strength of a root at the end where slip begins
/// \[Pa], for the known part of the slip and for the slip of all else, which is a polynomial: per unit of every power of
/// the place over the half-length of the line.
pub struct Stretch {
    /// Half of its length \[m].
    half: f64,
    /// Moments of the first terms of the shear and, behind them, of the root with the powers \[m]; further terms have none.
    moments: [ByPowers; POINTS + 1],
    /// Terms and root in all solutions: of the known part, then those that a unit of each power takes away.
    terms: [BySolution; ROOT + 1],
}

impl Stretch {
    /// Tractions on a `stretch` of a line of a half-length `length` \[m], with the given terms and moments of the root with the
    /// powers \[m].
    #[inline]
    fn of_terms(stretch: &Arch, length: f64, root: ByPowers, terms: [BySolution; ROOT + 1]) -> Self {
        let (half, of_terms) = (stretch.half_width, PlaceFactor::new(stretch, length).moments());
        let mut moments = [root; POINTS + 1];
        moments[..POINTS].copy_from_slice(&of_terms.map(|moments| moments.map(|moment| half * moment)));
        Self { half, moments, terms }
    }

    /// Moments of the tractions by power [N/m].
    pub fn moments(&self) -> [BySolution; POINTS] {
        moments_of(&self.moments, &self.terms)
    }

    /// Forces of the tractions [N/m].
    pub fn forces(&self) -> BySolution {
        let [first, root] = [&self.terms[0], &self.terms[ROOT]];
        std::array::from_fn(|j| FRAC_PI_2 * self.half * (first[j] + 2.0 * root[j]))
    }

    /// Terms of the shear and the root under a slip besides the known one \[Pa].
    pub fn tractions(&self, slip: &ByPowers) -> [f64; ROOT + 1] {
        let mut x = [0.0; ROOT + 1];
        for (x, [known, by @ ..]) in x.iter_mut().zip(&self.terms) {
            *x = known - slip.iter().zip(by).map(|(slip, by)| slip * by).sum::<f64>();
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
        self.slide_all();
    }

    /// Makes the stretch that sticks longer by a factor, and its shear stronger, as that of Carter's solution is.
    pub fn restretch(&mut self, factor: f64) {
        let (upstream, Tractions { pressure, stick, .. }) = (self.upstream(), &mut self.tractions);
        stick.half_width *= factor;
        stick.centre = pressure.centre + upstream * (pressure.half_width - stick.half_width);
        stick.terms.iter_mut().for_each(|term| *term *= factor);
    }

    /// Makes the stretch that sticks longer by a factor, with a shear that differs from the present one and its root by the
    /// square of the change.
    pub fn absorb_root(&mut self, factor: f64) {
        self.tractions.stick = self.tractions.stick.stretched(factor, self.upstream());
    }

    /// Change of the root per share of the patch that sticks as far as the tractions stay the same \[Pa]: to first order they
    /// do, around a solution.
    pub fn root_by_share(&self) -> f64 {
        let Tractions { pressure, stick, .. } = &self.tractions;
        -stick.root_by_length(self.upstream()) * pressure.half_width / stick.half_width
    }

    /// Tractions of the stretch that sticks, with the smooth displacements `surface` of the friction of slip.
    pub fn stretch(&self, surface: &SmoothSurfaces) -> Result<Stretch, ContactError> {
        let tables = &self.constants.tables;
        let Arch { centre, half_width: half, .. } = self.tractions.stick;
        let kernel = self.problem.line.kernel.tangential;
        let equations = StickEquations {
            convection: (self.rigid.travel + self.rim_velocity()) * kernel.factor * PI,
            rate: -PI * kernel.factor * self.problem.line.time.a0 * half,
            size: libm::log(half) - kernel.reach - LN_2,
            upstream: self.upstream(),
        };
        let slips = self.slip(&tables.stick.map(|t| centre + half * t), surface, false);
        let powers = PlaceFactor::new(&self.tractions.stick, self.half_length).powers();
        let (mut right, mut terms) = ([BySolution::default(); STICK], [BySolution::default(); ROOT + 1]);
        right.iter_mut().zip(as_series(tables, &slips)).for_each(|(right, slip)| right[0] = -slip);
        for (power, series) in powers.iter().enumerate() {
            right.iter_mut().zip(series).for_each(|(right, coefficient)| right[1 + power] = *coefficient);
        }
        right[1][OF_ROOT] = 1.0;
        if !solve(&equations, &mut right, &mut terms) {
            return Err(ContactError::Unsuited { reason: "the equations of stick are singular" });
        }
        // Moments of the root are exact: so those of the whole stretch, by which lines feel each other, hardly depend on
        // where slip begins.
        Ok(Stretch::of_terms(&self.tractions.stick, self.half_length, self.root_moments(), terms))
    }

    /// Moments of the traction `√((1 − t)/(1 + t))` with the powers, by the rule of Gauss and Chebyshev \[m].
    fn root_moments(&self) -> ByPowers {
        let Arch { centre, half_width: half, .. } = self.tractions.stick;
        let weights = ROOT_PLACES.map(|t| PI / ROOT_PLACES.len() as f64 * half * (1.0 - self.upstream() * t));
        let powers = self.powers_at(&ROOT_PLACES.map(|t| centre + half * t));
        powers.map(|power| power.iter().zip(&weights).map(|(power, weight)| power * weight).sum())
    }

    /// Powers of the place over the half-length of the line, by power.
    pub fn powers_at<const N: usize>(&self, x: &[f64; N]) -> [[f64; N]; POINTS] {
        let (mut power, scale) = ([1.0; N], 1.0 / self.half_length);
        std::array::from_fn(|_| {
            let now = power;
            power.iter_mut().zip(x).for_each(|(power, x)| *power *= scale * x);
            now
        })
    }

    /// Takes the terms of the shear; returns the strength of the traction `√((1 − t)/(1 + t))` that holds the end of
    /// the stretch \[Pa]: no friction can, so that it vanishes in a solution.
    pub fn take(&mut self, x: &[f64; ROOT + 1]) -> f64 {
        self.tractions.stick.terms.copy_from_slice(&x[..TERMS]);
        x[ROOT]
    }
}

/// The equations of stick, but for their right-hand sides.
pub(super) struct StickEquations {
    /// Slip of `T_{k+1}` by a term of the shear that is carried through the patch [m/s/Pa].
    convection: f64,
    /// Slip of `T_{k+2}/(k + 2) − T_k/k` by its rate [m/s/Pa].
    rate: f64,
    /// Logarithm of half of the half-length of the stretch over the reach of the line, which stands for `−1/k` of the first term.
    size: f64,
    upstream: f64,
}

vectorised! {
    /// Coefficients of `T_n` from values at the places of stick.
    fn as_series<'a, S>(_simd, tables: &'a Tables, values: &'a [f64; STICK_ROOM]) -> [f64; STICK_ROOM] {
        let mut series = [0.0; STICK_ROOM];
        for (value, weights) in values.iter().zip(&tables.stick_terms) {
            for n in 0..STICK_ROOM {
                series[n] += value * weights[n];
            }
        }
        series
    }
}

vectorised! {
    /// Writes the terms and the root that make the slips on the right, of which those of [`OF_ROOT`] are 1 in order 1 alone;
    /// false: they are not finite.
    fn solve<'a, S>(
        _simd,
        equations: &'a StickEquations,
        right: &'a mut [BySolution; STICK],
        terms: &'a mut [BySolution; ROOT + 1],
    ) -> bool {
        let StickEquations { convection, rate, size, upstream } = *equations;
        let (mut pivot, mut over) = (convection, [0.0; STICK]);
        over[1] = 1.0 / pivot;
        for n in 2..STICK {
            let (order, factor) = (n as f64, rate * over[n - 1]);
            let (above, below) = right.split_at_mut(n);
            for j in 0..below[0].len() {
                below[0][j] = order * below[0][j] - factor * above[n - 1][j];
            }
            pivot = order * convection + rate * factor;
            over[n] = 1.0 / pivot;
        }
        let mut last = BySolution::default();
        for n in (1..STICK).rev() {
            for j in 0..last.len() {
                last[j] = over[n] * (right[n][j] + rate * last[j]);
            }
            terms[n - 1] = last;
        }
        // What is left: the equation of order 0, and the root in that of order 1.
        let (by_first, of_root) = (rate * size, 2.0 * rate * upstream);
        let by_root = convection * upstream + 2.0 * by_first - by_first * of_root * last[OF_ROOT];
        let (mut root, mut finite) = (BySolution::default(), true);
        for j in 0..root.len() {
            root[j] = (right[0][j] - by_first * last[j]) / by_root;
        }
        finite &= root[..OF_ROOT].iter().all(|value| value.is_finite());
        for terms in &mut terms[..SHEAR] {
            let by = of_root * terms[OF_ROOT];
            for j in 0..root.len() {
                terms[j] -= by * root[j];
            }
        }
        terms[ROOT] = root;
        finite
    }
}

vectorised! {
    /// Moments of terms by power, given those of single ones.
    fn moments_of<'a, S>(
        _simd,
        of_terms: &'a [ByPowers; POINTS + 1],
        terms: &'a [BySolution; ROOT + 1],
    ) -> [BySolution; POINTS] {
        let mut sums = [BySolution::default(); POINTS];
        for (power, sums) in sums.iter_mut().enumerate() {
            // Terms of higher numbers have no such moments.
            for k in 0..=power {
                for j in 0..sums.len() {
                    sums[j] += of_terms[k][power] * terms[k][j];
                }
            }
            for j in 0..sums.len() {
                sums[j] += of_terms[POINTS][power] * terms[ROOT][j];
            }
        }
        sums
    }
}
