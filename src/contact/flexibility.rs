//! Flexibility of the lines of a patch under the tangential forces of all of them.
//!
//! Half-spaces displace a line by the forces on its own strip and on all others. Of the own ones the logarithm of the
//! distance is left to the line itself ([`super::LineKernel`]); the rest is smooth, and felt through moments:
//! displacements and strains are polynomials of the place over the half-length of the line, `t = x/a`, and forces act
//! by their moments with the powers of t. So all coefficients are the same under any load.
//! Derivation: `docs/theory/lines.md`, section 5.

use super::projection::MomentProjection;
pub use super::projection::{Between, ByMoments, ByPowers};
use crate::linalg::POINTS;
use crate::patch::tiles::{Tile, TileInfluence};
use std::f64::consts::PI;

/// Length beyond the ends of a line, over its half-length, on which the effect of the patch fades out \[1].
const FADING: f64 = 0.5;

/// Offset of a strip from the middle over its width beyond which it has a mirror image \[1].
const LEAST_OFFSET: f64 = 1e-9;
/// Displacement and strain of one line by the forces of all lines of its patch.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Field {
    /// Displacement of the wheel less that of the rail \[m].
    pub displacement: ByPowers,
    /// Its strain times the half-length of the line \[m].
    pub strain: ByPowers,
}

/// Elastic material that fills the half-spaces of both bodies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HalfSpace {
    /// Shear modulus \[Pa].
    pub shear_modulus: f64,
    /// Poisson's ratio \[1].
    pub poissons_ratio: f64,
}

/// Flexibility of all lines of a patch.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PatchFlexibility {
    lines: usize,
    /// By displaced line, then by line of the force.
    pairs: Vec<Between>,
    /// Tables across; `None`: forces and displacements have no lateral part.
    lateral: Option<LateralTables>,
}

/// Flexibility of all lines of a patch across, as [`PatchFlexibility`] orders it.
#[derive(Clone, Debug, Default, PartialEq)]
struct LateralTables {
    /// Displacements across by forces across.
    across: Vec<Between>,
    /// Displacements across by forces along, and along by forces across.
    askew: Vec<Between>,
}

/// A line as part of a patch that displaces it.
#[derive(Clone, Copy)]
pub struct InPatch<'a> {
    /// Flexibility of the patch.
    pub flexibility: &'a PatchFlexibility,
    /// Number of the line in it.
    pub line: usize,
    /// Half-length of the line in the layout \[m].
    pub half_length: f64,
}

impl HalfSpace {
    /// `1/πG` \[m²/N], in which all displacements by forces are.
    pub fn factor(&self) -> f64 {
        1.0 / (PI * self.shear_modulus)
    }
}

impl PatchFlexibility {
    /// That of half-spaces under lines on `tiles`; with `mirrored` those beside the middle stand for a symmetric pair. Besides, for every line the logarithm of the distance over 1
    /// m at which a force of its own no longer displaces it by more than the mean over all lines.
    pub fn new(tiles: &[Tile], mirrored: bool, material: HalfSpace) -> (Self, Vec<f64>) {
        let (factor, nu) = (material.factor(), material.poissons_ratio);
        let beside = |tile: &Tile| mirrored && tile.edges[0] + tile.edges[1] > LEAST_OFFSET * tile.width();
        let mut pairs = table(tiles, factor, &beside, |at, of, x| at.displaced_by(of, x, nu));
        let reaches = take_reaches(&mut pairs, tiles.len(), 2.0 * (1.0 - nu) * factor);
        (Self { lines: tiles.len(), pairs, lateral: None }, reaches)
    }

    /// With forces and displacements across of the lines of [`Self::new`] on `tiles` that are not mirrored; and the
    /// logarithms for those.
    pub fn sideways(self, tiles: &[Tile], material: HalfSpace) -> (Self, Vec<f64>) {
        let (factor, nu) = (material.factor(), material.poissons_ratio);
        let mut across = table(tiles, factor, &|_| false, |at, of, x| at.displaced_across_by(of, x, nu));
        let askew = table(tiles, factor, &|_| false, |at, of, x| at.displaced_askew_by(of, x, nu));
        let reaches = take_reaches(&mut across, tiles.len(), 2.0 * factor);
        (Self { lateral: Some(LateralTables { across, askew }), ..self }, reaches)
    }

    /// Sums over the forces of all lines with the given moments along and across [N/m], by line, on the line `at`: along
    /// and across.
    pub fn sums<'a>(
        &self,
        at: usize,
        moments: impl IntoIterator<Item = [&'a ByPowers; 2]>,
        of: impl Fn(&Between) -> &ByMoments,
    ) -> [ByPowers; 2] {
        let mut sums = [ByPowers::default(); 2];
        for (by, [along, across]) in moments.into_iter().enumerate() {
            add(of(self.between(at, by)), along, &mut sums[0]);
            let Some([direct, askew]) = self.across(at, by).map(|tables| tables.map(&of)) else { continue };
            add(askew, across, &mut sums[0]);
            add(direct, across, &mut sums[1]);
            add(askew, along, &mut sums[1]);
        }
        sums
    }

    /// True if forces and displacements have a lateral part.
    pub fn is_sideways(&self) -> bool {
        self.lateral.is_some()
    }

    /// Effects of the forces of a line `by` on a line `at`: across by forces across, and across by forces along, which is
    /// that along by forces across; `None`: there is no lateral part.
    pub fn across(&self, at: usize, by: usize) -> Option<[&Between; 2]> {
        let pair = at * self.lines + by;
        self.lateral.as_ref().map(|lateral| [&lateral.across[pair], &lateral.askew[pair]])
    }

    /// Effect of the forces of a line `by` on a line `at`.
    pub fn between(&self, at: usize, by: usize) -> &Between {
        &self.pairs[at * self.lines + by]
    }

    /// Sum over the forces of all lines with the given moments [N/m], by line, on the line `at`.
    pub fn sum<'a>(
        &self,
        at: usize,
        moments: impl IntoIterator<Item = &'a ByPowers>,
        of: impl Fn(&Between) -> &ByMoments,
    ) -> ByPowers {
        let mut sum = ByPowers::default();
        for (by, moments) in moments.into_iter().enumerate() {
            add(of(self.between(at, by)), moments, &mut sum);
        }
        sum
    }
}

/// Adds the polynomial that belongs to moments.
pub fn add<const D: usize>(by_moments: &[[f64; D]; D], moments: &[f64; D], sum: &mut [f64; D]) {
    for (by_moment, moment) in by_moments.iter().zip(moments) {
        sum.iter_mut().zip(by_moment).for_each(|(sum, by)| *sum += by * moment);
    }
}

/// Values of a polynomial at places x, whose unit is `length` \[m].
pub fn values<const N: usize>(polynomial: &ByPowers, x: &[f64; N], length: f64) -> [f64; N] {
    let (mut sums, scale) = ([0.0; N], 1.0 / length);
    for c in polynomial.iter().rev() {
        for i in 0..N {
            sums[i] = sums[i] * (x[i] * scale) + c;
        }
    }
    sums
}

/// Powers of the place t. Beyond the ends of the line those at the ends fade out: polynomials grow there without bound,
/// and would push a longer patch up by its own forces.
pub fn powers(t: f64) -> ByPowers {
    let beyond = ((t.abs() - 1.0) / FADING).clamp(0.0, 1.0);
    let (mut power, t) = (1.0 - beyond * beyond * (3.0 - 2.0 * beyond), t.clamp(-1.0, 1.0));
    std::array::from_fn(|_| {
        let now = power;
        power *= t;
        now
    })
}

/// Value of a polynomial, given the powers of the place.
pub fn at(polynomial: &ByPowers, powers: &ByPowers) -> f64 {
    polynomial.iter().zip(powers).map(|(c, power)| c * power).sum()
}

impl Between {
    /// Slips [m/s] by units of the moments as polynomials, given their changes with displacement and strain, see
    /// [`slip_of_field`].
    pub fn slips(&self, [by_displacement, by_strain]: [f64; 2]) -> ByMoments {
        let (mut slips, by_field) = (ByMoments::default(), self.displacement.iter().zip(&self.strain));
        for (slips, (displacements, strains)) in slips.iter_mut().zip(by_field) {
            for (slip, (displacement, strain)) in slips.iter_mut().zip(displacements.iter().zip(strains)) {
                *slip = by_displacement * displacement + by_strain * strain;
            }
        }
        slips
    }
}

impl Field {
    /// Slip [m/s] as a polynomial, given its changes with displacement and strain, see [`slip_of_field`].
    pub fn slip(&self, [by_displacement, by_strain]: [f64; 2]) -> ByPowers {
        std::array::from_fn(|k| by_displacement * self.displacement[k] + by_strain * self.strain[k])
    }
}

/// Changes of the slip [m/s] with the displacement of a field, which has the weight `rate` in its rate [1/s], and with
/// its strain: half of the sum `speed` of the speeds of both surfaces [m/s] carries it.
pub fn slip_of_field([rate, speed]: [f64; 2], half_length: f64) -> [f64; 2] {
    [rate, -0.5 * speed / half_length]
}

impl InPatch<'_> {
    /// Field of the forces of all lines with the given moments on this one.
    pub fn field<'a>(&self, moments: impl Iterator<Item = &'a ByPowers> + Clone) -> Field {
        let sum = |of: fn(&Between) -> &ByMoments| self.flexibility.sum(self.line, moments.clone(), of);
        Field { displacement: sum(|by| &by.displacement), strain: sum(|by| &by.strain) }
    }

    /// Fields along and across of the forces of all lines with the given moments along and across on this one.
    pub fn fields<'a>(&self, moments: impl Iterator<Item = [&'a ByPowers; 2]> + Clone) -> [Field; 2] {
        let sums = |of: fn(&Between) -> &ByMoments| self.flexibility.sums(self.line, moments.clone(), of);
        let (displacement, strain) = (sums(|by| &by.displacement), sums(|by| &by.strain));
        [0, 1].map(|k| Field { displacement: displacement[k], strain: strain[k] })
    }

    /// Powers of a place on the line, see [`powers`].
    pub fn powers(&self, x: f64) -> ByPowers {
        powers(x / self.half_length)
    }
}

/// Effects of unit forces on `tiles` on each other by a kernel, times `factor`; those `beside` the middle stand for a
/// symmetric pair.
fn table(
    tiles: &[Tile],
    factor: f64,
    beside: &impl Fn(&Tile) -> bool,
    kernel: impl Fn(&Tile, Tile, f64) -> TileInfluence,
) -> Vec<Between> {
    let (projection, count) = (MomentProjection::new(), tiles.len());
    let mut pairs = vec![Between::default(); count * count];
    for (pair, (at, of)) in pairs.iter_mut().zip(tiles.iter().flat_map(|at| tiles.iter().map(move |of| (at, of)))) {
        for image in [Some(*of), beside(of).then(|| of.mirrored())].into_iter().flatten() {
            projection.add([at, of], factor, |x| kernel(at, image, x), pair);
        }
    }
    let width = |tile: &Tile| if beside(tile) { 2.0 * tile.width() } else { tile.width() };
    for (i, j) in (0..count).flat_map(|i| (i..count).map(move |j| (i, j))) {
        let [mut first, mut second] = [pairs[i * count + j], pairs[j * count + i]];
        let of = [&tiles[i], &tiles[j]];
        reconcile([&mut first, &mut second], of.map(width), of.map(|tile| tile.half_length));
        (pairs[i * count + j], pairs[j * count + i]) = (first, second);
    }
    pairs
}

/// Leaves the mean displacement of every line to its own logarithm, whose factor is `logarithm` \[m²/N]: a constant
/// displacement may belong to that as well. Returns the logarithms of the distances at which they end over 1 m.
fn take_reaches(pairs: &mut [Between], count: usize, logarithm: f64) -> Vec<f64> {
    let reaches = (0..count).map(|line| {
        let reach = pairs[line * count..][..count].iter().map(|pair| mean(&pair.displacement)).sum::<f64>() / logarithm;
        pairs[line * (count + 1)].displacement[0][0] -= logarithm * reach;
        pairs[line * (count + 1)].growth[0][0] += 0.5 * logarithm * reach;
        reach
    });
    reaches.collect()
}

/// Makes tables of two lines that displace each other, which stand for the given widths, obey Betti's theorem to
/// round-off: displacements symmetric, strains antisymmetric.
fn reconcile([first, second]: [&mut Between; 2], widths: [f64; 2], lengths: [f64; 2]) {
    for n in 0..POINTS {
        for k in 0..POINTS {
            let [there, back] = [widths[0] * first.displacement[n][k], widths[1] * second.displacement[k][n]];
            let mean = 0.5 * (there + back);
            (first.displacement[n][k], second.displacement[k][n]) = (mean / widths[0], mean / widths[1]);
            let scales = [widths[0] / lengths[0], widths[1] / lengths[1]];
            let [there, back] = [scales[0] * first.strain[n][k], scales[1] * second.strain[k][n]];
            let mean = 0.5 * (there - back);
            (first.strain[n][k], second.strain[k][n]) = (mean / scales[0], -mean / scales[1]);
        }
    }
}

/// Mean over a line of its displacement by a unit force that is spread over the other one.
fn mean(displacement: &ByMoments) -> f64 {
    let of_power = |k: usize| if k.is_multiple_of(2) { 1.0 / (k + 1) as f64 } else { 0.0 };
    let of_moment = |by: &ByPowers| by.iter().enumerate().map(|(k, by)| of_power(k) * by).sum::<f64>();
    displacement.iter().enumerate().map(|(n, by)| of_power(n) * of_moment(by)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    const STEEL: HalfSpace = HalfSpace { shear_modulus: 81e9, poissons_ratio: 0.3 };

    /// Field of a line with given moments.
    fn field(by: &Between, moments: &ByPowers) -> Field {
        let mut field = Field::default();
        add(&by.displacement, moments, &mut field.displacement);
        add(&by.strain, moments, &mut field.strain);
        field
    }

    /// Strips beside each other, `scale` times as large as millimetres.
    fn strips(scale: f64) -> Vec<Tile> {
        let edges = [0.0, 1.0, 3.0, 4.5].map(|z| z * scale);
        let tile =
            |(pair, half_length): (&[f64], f64)| Tile { edges: [pair[0], pair[1]], half_length: half_length * scale };
        edges.windows(2).zip([6.0, 5.0, 3.0]).map(tile).collect()
    }

    /// Betti: a displacement by the forces of another line does the same work as theirs on that by the own ones, and
    /// forces do none on the strains that they cause together.
    #[test]
    fn works_of_two_lines_on_each_other_are_the_same_and_a_load_moves_along_without_work() {
        let tiles = strips(1e-3);
        for mirrored in [false, true] {
            let (patch, _) = PatchFlexibility::new(&tiles, mirrored, STEEL);
            let width = |k: usize| tiles[k].width() * if mirrored { 2.0 } else { 1.0 };
            let forces = [[1.0, 0.3, -0.2, 0.5, 0.1], [0.4, -1.0, 0.7, 0.2, -0.3], [2.0, 0.1, 0.1, -0.6, 0.8]];
            let work = |k: usize, field: &ByPowers| -> f64 { forces[k].iter().zip(field).map(|(f, c)| f * c).sum() };
            let mut moved = 0.0;
            for (k, tile) in tiles.iter().enumerate() {
                for j in 0..tiles.len() {
                    let [there, back] =
                        [field(patch.between(k, j), &forces[j]), field(patch.between(j, k), &forces[k])];
                    let works = [width(k) * work(k, &there.displacement), width(j) * work(j, &back.displacement)];
                    assert!((works[0] - works[1]).abs() < 1e-12 * works[0].abs() + 1e-26, "{works:?}");
                    moved += width(k) * work(k, &there.strain) / tile.half_length;
                }
            }
            assert!(moved.abs() < 1e-23, "{moved:e}");
        }
    }

    /// Betti along and across: the works of two lines on each other are the same, and a load that moves along does none.
    #[test]
    fn works_along_and_across_of_two_lines_on_each_other_are_the_same() {
        let tiles = strips(1e-3);
        let (patch, reaches) = PatchFlexibility::new(&tiles, false, STEEL).0.sideways(&tiles, STEEL);
        let forces = [
            [[1.0, 0.3, -0.2, 0.5, 0.1], [0.2, -0.7, 0.4, 0.1, 0.9]],
            [[0.4, -1.0, 0.7, 0.2, -0.3], [-0.5, 0.3, 0.8, -0.6, 0.2]],
            [[2.0, 0.1, 0.1, -0.6, 0.8], [1.1, 0.5, -0.9, 0.3, -0.1]],
        ];
        let none = [ByPowers::default(); 2];
        let work = |at: usize, by: usize, of: fn(&Between) -> &ByMoments| -> f64 {
            let moments = (0..tiles.len()).map(|line| if line == by { &forces[line] } else { &none });
            let fields = patch.sums(at, moments.map(|[along, across]| [along, across]), of);
            let product = forces[at].as_flattened().iter().zip(fields.as_flattened()).map(|(f, c)| f * c).sum::<f64>();
            tiles[at].width() * product
        };
        let mut moved = 0.0;
        for (k, tile) in tiles.iter().enumerate() {
            for j in 0..tiles.len() {
                let works = [work(k, j, |by| &by.displacement), work(j, k, |by| &by.displacement)];
                assert!((works[0] - works[1]).abs() < 1e-12 * works[0].abs() + 1e-26, "{works:?}");
                moved += work(k, j, |by| &by.strain) / tile.half_length;
            }
        }
        assert!(moved.abs() < 1e-23 && reaches.iter().all(|reach| reach.is_finite()), "{moved:e}");
    }

    #[test]
    fn tables_are_the_same_for_patches_of_every_size() {
        let [(small, reaches), (large, others)] = [1e-3, 2e-3].map(|s| PatchFlexibility::new(&strips(s), true, STEEL));
        for (a, b) in small.pairs.iter().zip(&large.pairs) {
            for (a, b) in [(a.displacement, b.displacement), (a.strain, b.strain), (a.growth, b.growth)] {
                // Angles near the ends of lines are half as exact as places.
                let same = |(a, b): (&f64, &f64)| (a - b).abs() < 1e-18;
                assert!(a.as_flattened().iter().zip(b.as_flattened()).all(same));
            }
        }
        assert!(reaches.iter().zip(others).all(|(a, b)| (a + 2.0_f64.ln() - b).abs() < 1e-9));
    }

    /// Displacement of a wide strip in its middle, far from its sides: that of the plane, in which only the distance at
    /// which a logarithm ends is the width's.
    #[test]
    fn a_wide_strip_is_displaced_as_the_plane() {
        let tile = Tile { edges: [-1.0, 1.0], half_length: 1e-3 };
        let (patch, reaches) = PatchFlexibility::new(&[tile], false, STEEL);
        let rest = field(patch.between(0, 0), &[1.0, 0.0, 0.0, 0.0, 0.0]);
        let logarithm = 2.0 * (1.0 - STEEL.poissons_ratio) * STEEL.factor();
        // `asinh(w/|x|) − (1 − 2ν)/(1 − ν)` for a width w = 2.
        let reach = 4.0_f64.ln() - (1.0 - 2.0 * STEEL.poissons_ratio) / (1.0 - STEEL.poissons_ratio);
        assert!((reaches[0] - reach).abs() < 1e-3);
        assert!(rest.displacement.iter().all(|c| c.abs() < 1e-3 * logarithm), "{rest:?}");
    }
}
