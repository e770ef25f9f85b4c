//! The linear problem of one line of which a given stretch sticks, as a function of what it shares with other lines.

use super::chebyshev::{Arch, TERMS};
use super::equations::{Coefficients, ROOM, eliminate};
use super::places::{AtPlaces, moments};
use super::series_line::SeriesLine;
use super::state::Tractions;
use super::surface::SmoothSurfaces;
use super::tables::{SHEAR, STICK, Tables};
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

/// Tractions of a stretch that sticks: terms of the shear and the strength of a root at the end where slip begins
/// \[Pa], for the known part of the slip and for the slip of all else, which is a polynomial: per unit of every power of
/// the place over the half-length of the line.
pub struct Stretch {
    /// Half of its length \[m].
    half: f64,
    /// Moments of the terms of the shear and, behind them, of the root with the powers \[m].
    moments: [ByPowers; ROOT + 1],
    /// Solutions: of the known part, then those that a unit of each power takes away.
    solutions: [Coefficients; 1 + POINTS],
}

impl Stretch {
    /// Tractions on half of a length `half` \[m] with the given terms; `of_terms` times `powers` are summed to the moments of
    /// the terms.
    pub fn new(
        half: f64,
        of_terms: &[AtPlaces; TERMS],
        powers: &[AtPlaces; POINTS],
        solutions: [Coefficients; 1 + POINTS],
    ) -> Self {
        let mut all = [ByPowers::default(); ROOT + 1];
        all[..TERMS].copy_from_slice(&moments(of_terms, powers, half));
        Self { half, moments: all, solutions }
    }

    /// Moments with the powers [N/m] of the tractions of a solution.
    fn moments_of(&self, x: &Coefficients) -> ByPowers {
        let mut sums = ByPowers::default();
        for (term, moments) in x.iter().zip(&self.moments) {
            sums.iter_mut().zip(moments).for_each(|(sum, moment)| *sum += term * moment);
        }
        sums
    }

    /// Moments of the tractions under the known slip, and those that a unit of each power takes away.
    pub fn moments(&self) -> [ByPowers; 1 + POINTS] {
        self.solutions.each_ref().map(|x| self.moments_of(x))
    }

    /// Force of the tractions under the known slip [N/m], and those that a unit of each power takes away.
    pub fn forces(&self) -> [f64; 1 + POINTS] {
        self.solutions.each_ref().map(|x| FRAC_PI_2 * self.half * (x[0] + 2.0 * x[ROOT]))
    }

    /// Terms of the shear and the root under a slip besides the known one \[Pa].
    pub fn tractions(&self, slip: &ByPowers) -> Coefficients {
        let mut x = self.solutions[0];
        for (value, solution) in slip.iter().zip(&self.solutions[1..]) {
            x.iter_mut().zip(solution).for_each(|(x, by)| *x -= value * by);
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
        let x = tables.stick.map(|t| centre + half * t);
        let mut columns = [[0.0; ROOM]; STICK + 1 + POINTS];
        let kernel = self.problem.line.kernel.tangential;
        let factors = SlipFactors {
            convection: (self.rigid.travel + self.rim_velocity()) * kernel.factor * PI,
            rate: -2.0 * kernel.factor * self.problem.line.time.a0 * half,
            size: libm::log(half) - kernel.reach,
            upstream: self.upstream(),
        };
        write_columns(tables, &factors, &mut columns);
        let slips = self.slip(&x, surface, false);
        columns[STICK][..STICK].iter_mut().zip(slips).for_each(|(right, slip)| *right = -slip);
        let powers = self.powers_at(&x);
        for (column, power) in columns[STICK + 1..].iter_mut().zip(&powers) {
            column[..STICK].copy_from_slice(&power[..STICK]);
        }
        if !eliminate(&mut columns, STICK) {
            return Err(ContactError::Unsuited { reason: "the equations of stick are singular" });
        }
        let values = self.powers_at(&tables.places.map(|t| centre + half * t));
        let mut solutions: [Coefficients; 1 + POINTS] = std::array::from_fn(|k| columns[STICK + k]);
        solutions.iter_mut().for_each(|x| x.swap(SHEAR, ROOT));
        let mut stretch = Stretch::new(half, &tables.moments, &values, solutions);
        // That of the root is exact: so those of the whole stretch, by which lines feel each other, hardly depend on where
        // slip begins.
        stretch.moments[ROOT] = self.root_moments();
        Ok(stretch)
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
    pub fn take(&mut self, x: &Coefficients) -> f64 {
        self.tractions.stick.terms.copy_from_slice(&x[..TERMS]);
        x[ROOT]
    }
}

/// Common parts of the coefficients of all terms.
pub(super) struct SlipFactors {
    /// Of the Cauchy integrals over π, and of the logarithmic ones.
    convection: f64,
    rate: f64,
    /// Logarithm of the half-length of the stretch over the reach of the line.
    size: f64,
    upstream: f64,
}

vectorised! {
    /// Writes the coefficients of the terms of the shear and of the root in the slip at the places of stick.
    fn write_columns<'a, S>(
        _simd,
        tables: &'a Tables,
        factors: &'a SlipFactors,
        columns: &'a mut [Coefficients; STICK + 1 + POINTS],
    ) {
        let SlipFactors { convection, rate, size, upstream } = *factors;
        let (terms, others) = columns.split_at_mut(SHEAR);
        let of_terms = tables.stick_cauchy.iter().zip(&tables.stick_logarithm);
        for (column, (cauchy, logarithm)) in terms.iter_mut().zip(of_terms) {
            for i in 0..STICK {
                column[i] = convection * cauchy[i] + rate * logarithm[i];
            }
        }
        for ((first, root), t) in terms[0].iter_mut().zip(&mut others[0]).zip(&tables.stick[..STICK]) {
            *first += rate * FRAC_PI_2 * size;
            *root = convection * upstream + rate * PI * (-LN_2 + upstream * t + size);
        }
    }
}
