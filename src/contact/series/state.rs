//! State of a line as series: its tractions, and the displacements that the slip of the next step refers to.

use super::chebyshev::{Arch, effect_of_both};
use super::points::{COUNT, Directions};
use crate::axes::PerAxis;
use crate::contact::flexibility::{ByPowers, at, faded, values};
use crate::contact::kernel::{LineKernel, Logarithm};
use crate::linalg::{Lagrange, POINTS};
use crate::multistep::TimeDerivative;
use serde::{Deserialize, Serialize};

/// Largest change of the share in a step that is expected to go on \[1]: beyond, slip comes and goes.
const EXPECTED: f64 = 0.05;
/// Share of stick or slip at which it is \[1].
const SURE: f64 = 0.1;

/// Tractions of a single patch: pressure on all of it, friction in slip, and the part of it that sticking takes away.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Tractions {
    /// Pressure p \[Pa].
    pub pressure: Arch,
    /// Shear over pressure where it slips, `±μ` \[1].
    pub slide: f64,
    /// Shear less that of slip where it sticks \[Pa].
    pub stick: Arch,
    /// States of the points where slip is not one stretch in one direction: `stick` is all of the shear then, `slide` zero.
    pub directions: Option<Directions>,
    /// Shear across \[Pa]; it has no length where there is none.
    pub lateral: Arch,
}

// A run on a patch keeps the larger variant, without memory to allocate in every step.
#[allow(clippy::large_enum_variant)]
/// Tangential displacement of the wheel less that of the rail, as a function of x.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Past {
    /// Found on a patch.
    Series(SeriesPast),
    /// Found on a grid.
    Grid(GridPast),
}

/// Displacements of the nodes of a grid.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct GridPast {
    /// Place of the first node \[m].
    pub first: f64,
    /// Distance of the nodes \[m].
    pub spacing: f64,
    /// Displacements along \[m].
    pub along: Vec<f64>,
    /// Displacements across \[m]; empty: there are none.
    pub across: Vec<f64>,
}

impl GridPast {
    /// Displacements at x by those of the nodes \[m].
    fn between<const N: usize>(&self, nodes: &[f64], x: &[f64; N]) -> [f64; N] {
        if nodes.len() > 3 { x.map(|x| cubic((x - self.first) / self.spacing, nodes)) } else { [0.0; N] }
    }
}

/// Displacement by the half-planes under tractions, `−2κ ∫ q ln|x − s| ds`, and by all else.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SeriesPast {
    /// The tractions.
    pub tractions: Tractions,
    /// All else at the points of the polynomial \[m].
    pub smooth: [f64; POINTS],
    /// Displacement by the lines of the patch \[m] as a polynomial of the place over `half_length` \[m], and its derivative
    /// by the size of this line.
    pub field: [ByPowers; 2],
    pub half_length: f64,
    /// `ln(L/1 m)` of the reach of the line, by which that contains `2κ ln L ∫ q ds` \[1].
    pub reach: f64,
    /// Share of the line in the width of the bodies \[1].
    pub share: f64,
    /// Flexibility of the layer between the surfaces [m/Pa].
    pub layer: f64,
    /// Displacement across.
    pub across: AcrossPast,
}

/// Displacement across by all lines of the patch as [`SeriesPast::field`], and the line's own flexibility across.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct AcrossPast {
    pub field: [ByPowers; 2],
    pub kernel: Logarithm,
}

impl Default for SeriesPast {
    fn default() -> Self {
        let (tractions, smooth, field, across) = Default::default();
        Self { tractions, smooth, field, half_length: 1.0, reach: 0.0, share: 0.0, layer: 0.0, across }
    }
}

impl SeriesPast {
    /// Displacement across at x \[m], carried on by a line with the given share of the width.
    pub fn across<const N: usize>(&self, x: &[f64; N], share: f64) -> [f64; N] {
        let (carried, AcrossPast { field, kernel }) = (self.carried(share), self.across);
        let (by_lines, shear) = (self.field_at(&self.by_lines(&field, carried), x), &self.tractions.lateral);
        let (own, total, layer) = (shear.logarithm(x), kernel.reach * shear.total(), layered(self.layer, shear, x));
        std::array::from_fn(|i| by_lines[i] + layer[i] + 2.0 * carried * kernel.factor * (total - own[i]))
    }

    /// Displacement by the lines of the patch, carried on with a factor, as a polynomial of the place over the half-length \[m].
    fn by_lines(&self, [field, growth]: &[ByPowers; 2], carried: f64) -> ByPowers {
        std::array::from_fn(|k| field[k] + 2.0 * (1.0 - carried) * growth[k])
    }

    /// Such a displacement at x \[m].
    fn field_at<const N: usize>(&self, field: &ByPowers, x: &[f64; N]) -> [f64; N] {
        match x.iter().all(|x| x.abs() <= self.half_length) {
            true => values(field, x, self.half_length),
            false => x.map(|x| at(field, &faded(x / self.half_length))),
        }
    }

    /// Factor with which the logarithm of the line's own displacement is carried on by a line with another share of the
    /// width \[1]: its energy stays.
    fn carried(&self, share: f64) -> f64 {
        let square = self.share / share;
        if square > 0.0 && square.is_finite() { square.sqrt() } else { 1.0 }
    }
}

/// State of a line as series, from step to step.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SeriesState {
    /// Tractions of the last solution.
    pub tractions: Tractions,
    /// Flexibility that the line has for itself.
    pub kernel: LineKernel,
    /// Size of the nodes on which it would be solved over those of the grid \[1]; zero: not known yet.
    pub size: f64,
    /// Tangential displacement at its end, and one step earlier.
    pub past: [Past; 2],
    /// How the root at the place where slip begins depends on this place: change of its strength over the friction at
    /// the peak of the pressure, per share of the patch \[1]; where the search of the next step starts.
    pub slope: f64,
    /// How the excess of friction over its law depends on the coefficient \[1]; where the search of the next step starts.
    pub law_slope: f64,
    /// Solution without the correction of the slips less that with it.
    pub uncorrected: Uncorrected,
}

/// Shear and motions along and across without the correction of the slips ([`super::cone`]) less those with it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Uncorrected {
    /// Shear at the points \[Pa].
    pub shear: [[f64; COUNT]; 2],
    /// Motions, which all lines have in common [m/s, m, rad/s].
    pub motion: PerAxis<f64>,
}

impl Uncorrected {
    /// True if all numbers are finite.
    pub fn is_sound(&self) -> bool {
        self.shear.as_flattened().iter().all(|q| q.is_finite()) && self.motion.iter().all(|(_, rate)| rate.is_finite())
    }
}

impl Default for Past {
    fn default() -> Self {
        Self::Grid(GridPast { spacing: 1.0, ..GridPast::default() })
    }
}

impl SeriesState {
    /// Tractions that are expected after a step: the part that sticks goes on changing as it did in the last one.
    pub fn expected(&self, time: &TimeDerivative) -> Tractions {
        let now = self.tractions;
        let Past::Series(SeriesPast { tractions: earlier, .. }) = &self.past[1] else { return now };
        let (ratio, share) = (time.step_ratio(), now.share());
        if now.is_sideways() && now.same_branch(earlier) {
            let onwards = |now: &Arch, earlier: &Arch| Arch { terms: now.onwards(earlier, ratio).terms, ..*now };
            let lateral = onwards(&now.lateral, &earlier.lateral);
            return Tractions { stick: onwards(&now.stick, &earlier.stick), lateral, ..now };
        }
        let change = ratio * (share - earlier.share());
        // Where nearly all or nothing sticks, slip may come from the other side or go.
        let steady = change.abs() <= EXPECTED && (SURE..=1.0 - SURE).contains(&(share + change));
        if !now.same_branch(earlier) || now.slides() || now.directions.is_some() || !steady {
            return now;
        }
        let half_width = (share + change) * now.pressure.half_width;
        let stick = Arch { half_width, ..now.stick.onwards(&earlier.stick, ratio) };
        Tractions { stick, ..now }
    }
}

impl Tractions {
    /// True if the shear has a lateral part.
    fn is_sideways(&self) -> bool {
        self.lateral.terms != Arch::default().terms
    }

    /// Half-length of the stretch that sticks over that of the patch \[1].
    pub fn share(&self) -> f64 {
        let sticks =
            |points: Directions| points.iter().filter(|state| **state == 0).count() as f64 / points.len() as f64;
        self.directions.map_or(self.stick.half_width / self.pressure.half_width, sticks)
    }

    /// Shear on the wheel at x \[Pa].
    pub fn shear<const N: usize>(&self, x: &[f64; N]) -> [f64; N] {
        self.together(self.pressure.density(x), self.stick.density(x))
    }

    /// `weights[0] ∫ q/(x − s) ds + weights[1] ∫ q ln|x − s| ds`.
    pub fn shear_effect<const N: usize>(&self, weights: [f64; 2], x: &[f64; N]) -> [f64; N] {
        effect_of_both(self.slide, [&self.pressure, &self.stick], weights, x)
    }

    /// `∫ q ln|x − s| ds` [N/m].
    pub fn shear_logarithm<const N: usize>(&self, x: &[f64; N]) -> [f64; N] {
        self.shear_effect([0.0, 1.0], x)
    }

    /// Force on the wheel `∫ q ds` [N/m].
    pub fn total(&self) -> f64 {
        self.slide * self.pressure.total() + self.stick.total()
    }

    /// Effect of the shear from the effects of pressure and stick.
    fn together<const N: usize>(&self, pressure: [f64; N], stick: [f64; N]) -> [f64; N] {
        std::array::from_fn(|i| self.slide * pressure[i] + stick[i])
    }

    /// True if slip and stick are the same but for their lengths.
    pub fn same_branch(&self, other: &Self) -> bool {
        self.branch() == other.branch()
    }

    /// Slip and stick but for their lengths.
    pub fn branch(&self) -> (bool, bool, Option<Directions>) {
        (self.slides(), self.slide < 0.0, self.directions)
    }

    /// True if all of the patch slips.
    pub fn slides(&self) -> bool {
        self.stick.half_width == 0.0
    }
}

impl Past {
    /// True if all numbers are finite and in range.
    pub fn is_sound(&self) -> bool {
        match self {
            Past::Series(SeriesPast { tractions, smooth, field, half_length, reach, share, layer, across }) => {
                *half_length > 0.0
                    && layer.is_finite()
                    && half_length.is_finite()
                    && field.iter().chain(&across.field).all(|by| by.iter().all(|c| c.is_finite()))
                    && across.kernel.factor.is_finite()
                    && across.kernel.reach.is_finite()
                    && tractions.lateral.is_sound()
                    && reach.is_finite()
                    && share.is_finite()
                    && tractions.pressure.is_sound()
                    && tractions.stick.is_sound()
                    && smooth.iter().all(|u| u.is_finite())
            }
            Past::Grid(GridPast { first, spacing, along, across }) => {
                first.is_finite() && *spacing > 0.0 && along.iter().chain(across).all(|u| u.is_finite())
            }
        }
    }

    /// Displacement at x \[m]; `kernel` of one half-plane [m/(N/m)]. It is carried on by the line with the given share of
    /// the width; `None`: by one like that which had it.
    pub fn at<const N: usize>(&self, x: &[f64; N], own: (f64, Option<f64>), points: &Lagrange) -> [f64; N] {
        let (mut polynomial, mut rest) = (ByPowers::default(), [0.0; N]);
        self.add(1.0, (x, own, points), points.reach, (&mut polynomial, &mut rest));
        let smooth = values(&polynomial, x, points.reach);
        std::array::from_fn(|i| smooth[i] + rest[i])
    }

    /// Adds `weight` times the displacement, see [`Self::at`]: what is a polynomial to one by powers of the place over a
    /// `length` \[m], and the rest at the places x.
    pub fn add<const N: usize>(
        &self,
        weight: f64,
        (x, (kernel, share), points): (&[f64; N], (f64, Option<f64>), &Lagrange),
        length: f64,
        (polynomial, rest): (&mut ByPowers, &mut [f64; N]),
    ) {
        let past = match self {
            Past::Series(past) => past,
            Past::Grid(past) => {
                let along = past.between(&past.along, x);
                rest.iter_mut().zip(&along).for_each(|(rest, along)| *rest += weight * along);
                return;
            }
        };
        let carried = share.map_or(1.0, |share| past.carried(share));
        let smooth = points.polynomial(&past.smooth).by_powers(length);
        polynomial.iter_mut().zip(&smooth).for_each(|(sum, smooth)| *sum += weight * smooth);
        polynomial[0] += weight * (carried - 1.0) * 2.0 * kernel * past.reach * past.tractions.total();
        let field = past.by_lines(&past.field, carried);
        if x.iter().all(|x| x.abs() <= past.half_length) {
            let (ratio, mut scale) = (length / past.half_length, weight);
            for (sum, by) in polynomial.iter_mut().zip(&field) {
                *sum += scale * by;
                scale *= ratio;
            }
        } else {
            let field = past.field_at(&field, x);
            rest.iter_mut().zip(&field).for_each(|(rest, by)| *rest += weight * by);
        }
        let own = past.tractions.shear_effect([0.0, -2.0 * carried * kernel * weight], x);
        rest.iter_mut().zip(&own).for_each(|(rest, own)| *rest += own);
        if past.layer != 0.0 {
            let layer = layered(past.layer, &past.tractions.stick, x);
            rest.iter_mut().zip(&layer).for_each(|(rest, layer)| *rest += weight * layer);
        }
    }

    /// Displacement across at x \[m], carried on by a line with the given share of the width.
    pub fn across<const N: usize>(&self, x: &[f64; N], share: f64) -> [f64; N] {
        match self {
            Past::Series(past) => past.across(x, share),
            Past::Grid(past) => past.between(&past.across, x),
        }
    }
}

/// Displacement by an elastic layer under a shear \[m]. Shear on it is that of points, all of which is
/// [`Tractions::stick`].
pub fn layered<const N: usize>(layer: f64, shear: &Arch, x: &[f64; N]) -> [f64; N] {
    if layer == 0.0 || shear.half_width == 0.0 { [0.0; N] } else { shear.density(x).map(|q| layer * q) }
}

/// Lagrange's cubic through the four nodes about a place; the nodes lie at 0, 1, 2 and so on.
fn cubic(place: f64, values: &[f64]) -> f64 {
    let cell = (place.floor().max(1.0) as usize).min(values.len() - 3);
    let s = place - cell as f64;
    let weights = [
        -s * (s - 1.0) * (s - 2.0) / 6.0,
        (s + 1.0) * (s - 1.0) * (s - 2.0) / 2.0,
        -(s + 1.0) * s * (s - 2.0) / 2.0,
        (s + 1.0) * s * (s - 1.0) / 6.0,
    ];
    weights.iter().zip(&values[cell - 1..]).map(|(w, u)| w * u).sum()
}
