//! Flexibility of the lines of a patch under the tangential forces of all of them.
//!
//! Half-spaces displace a line by the forces on its own strip and on all others. Of the own ones the logarithm of the
//! distance is left to the line itself ([`super::LineKernel`]); the rest is smooth, and felt through moments:
//! displacements and strains are polynomials of the place over the half-length of the line, `t = x/a`, and forces act
//! by their moments with the powers of t. So all coefficients are the same under any load.
//! Derivation: `docs/theory/lines.md`, section 5.

use super::kernel::Logarithm;
pub use super::projection::{Between, ByMoments, ByPowers};
use super::projection::{MomentProjection, Symmetry};
use crate::linalg::POINTS;
use crate::patch::tiles::{Tile, TileInfluence};
use std::f64::consts::{LN_2, PI};

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
    /// Logarithms that are left to the lines.
    left: Vec<Left>,
    /// Tables across; `None`: forces and displacements have no lateral part.
    lateral: Option<LateralTables>,
}

/// Flexibility of all lines of a patch across, as [`PatchFlexibility`] orders it.
#[derive(Clone, Debug, Default, PartialEq)]
struct LateralTables {
    /// Displacements across by forces across.
    across: Vec<Between>,
    /// Logarithms that are left to the lines.
    left: Vec<Left>,
    /// Displacements across by forces along, and along by forces across.
    askew: Vec<Between>,
}

/// Logarithm of both bodies that the tables leave to a line.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Left {
    /// Its factor \[m²/N].
    factor: f64,
    /// Logarithm of its reach over the half-length of the line \[1].
    reach: f64,
}

impl Left {
    fn blended<'a>(parts: impl Iterator<Item = (&'a [Self], f64)>) -> Vec<Self> {
        let mut sum: Vec<Self> = Vec::new();
        for (part, weight) in parts {
            sum.resize(part.len(), Self { factor: 0.0, reach: 0.0 });
            for (sum, left) in sum.iter_mut().zip(part) {
                sum.factor += weight * left.factor;
                sum.reach += weight * left.reach;
            }
        }
        sum
    }
}

/// Sum of tables, times weights.
fn blended<'a>(parts: impl Iterator<Item = (&'a [Between], f64)>) -> Vec<Between> {
    let mut sum: Vec<Between> = Vec::new();
    for (part, weight) in parts {
        sum.resize(part.len(), Between::default());
        sum.iter_mut().zip(part).for_each(|(sum, between)| sum.add(weight, between));
    }
    sum
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
    /// Logarithms of the reaches of its own displacement along and across over 1 m \[1]. Where they are not those that the
    /// tables leave to it, the difference is a displacement by the patch.
    pub reaches: [f64; 2],
}

impl HalfSpace {
    /// `1/πG` \[m²/N], in which all displacements by forces are.
    pub fn factor(&self) -> f64 {
        1.0 / (PI * self.shear_modulus)
    }
}

impl PatchFlexibility {
    /// That of half-spaces under lines on `tiles`; with `mirrored` those beside the middle stand for a symmetric pair.
    pub fn new(tiles: &[Tile], mirrored: bool, material: HalfSpace) -> Self {
        let beside = |tile: &Tile| mirrored && tile.edges[0] + tile.edges[1] > LEAST_OFFSET * tile.width();
        let nu = material.poissons_ratio;
        let [mut pairs] = tables(tiles, material, &beside, [Symmetry::Even], |at, of, x| [at.displaced_by(of, x, nu)]);
        let left = leave(&mut pairs, tiles, 2.0 * (1.0 - material.poissons_ratio) * material.factor());
        Self { lines: tiles.len(), pairs, left, lateral: None }
    }

    /// That of [`Self::new`] with forces and displacements across, of lines that are not mirrored.
    pub fn sideways(tiles: &[Tile], material: HalfSpace) -> Self {
        let symmetries = [Symmetry::Even, Symmetry::Even, Symmetry::Odd];
        let every_way = |at: Tile, of: Tile, x: f64| at.displaced_every_way(of, x, material.poissons_ratio);
        let [mut pairs, mut across, askew] = tables(tiles, material, &|_| false, symmetries, every_way);
        let left = leave(&mut pairs, tiles, 2.0 * (1.0 - material.poissons_ratio) * material.factor());
        let lateral = LateralTables { left: leave(&mut across, tiles, 2.0 * material.factor()), across, askew };
        Self { lines: tiles.len(), pairs, left, lateral: Some(lateral) }
    }

    /// Sum of flexibilities of as many lines, times weights.
    ///
    /// # Panics
    /// Without parts.
    pub fn blend(parts: &[(&Self, f64)]) -> Self {
        let lateral: Option<Vec<_>> =
            parts.iter().map(|(part, weight)| Some((part.lateral.as_ref()?, *weight))).collect();
        let own: Vec<_> = parts.iter().map(|(part, weight)| (*part, *weight)).collect();
        Self {
            lines: parts[0].0.lines,
            pairs: blended(own.iter().map(|(part, weight)| (&part.pairs[..], *weight))),
            left: Left::blended(own.iter().map(|(part, weight)| (&part.left[..], *weight))),
            lateral: lateral.map(|parts| LateralTables {
                across: blended(parts.iter().map(|(part, weight)| (&part.across[..], *weight))),
                left: Left::blended(parts.iter().map(|(part, weight)| (&part.left[..], *weight))),
                askew: blended(parts.iter().map(|(part, weight)| (&part.askew[..], *weight))),
            }),
        }
    }

    /// Logarithm for the displacement of each body that is left to a line of the given half-length \[m], along (0) or
    /// across (1); none across without a lateral part.
    pub fn own(&self, line: usize, direction: usize, half_length: f64) -> Logarithm {
        let own = |left: &Left| Logarithm { factor: 0.5 * left.factor, reach: left.reach + libm::log(half_length) };
        self.left(line, direction).map_or_else(Logarithm::default, own)
    }

    fn left(&self, line: usize, direction: usize) -> Option<&Left> {
        if direction == 0 { self.left.get(line) } else { self.lateral.as_ref()?.left.get(line) }
    }

    /// Sums over the forces of all lines with the given moments along and across [N/m], by line, on the line `at`: along
    /// and across.
    pub fn sums(
        &self,
        at: usize,
        moments: impl IntoIterator<Item = [ByPowers; 2]>,
        of: impl Fn(&Between) -> &ByMoments,
    ) -> [ByPowers; 2] {
        let mut sums = [ByPowers::default(); 2];
        for (by, [along, across]) in moments.into_iter().enumerate() {
            add(of(self.between(at, by)), &along, &mut sums[0]);
            let Some([direct, askew]) = self.across(at, by).map(|tables| tables.map(&of)) else { continue };
            add(askew, &across, &mut sums[0]);
            add(direct, &across, &mut sums[1]);
            add(askew, &along, &mut sums[1]);
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
}

/// Adds the polynomial that belongs to moments.
pub fn add<const D: usize>(by_moments: &[[f64; D]; D], moments: &[f64; D], sum: &mut [f64; D]) {
    for (by_moment, moment) in by_moments.iter().zip(moments) {
        sum.iter_mut().zip(by_moment).for_each(|(sum, by)| *sum += by * moment);
    }
}

/// Powers of the place t of a line, and beyond its ends the displacements there of a plane body by forces on the line that
/// cause the powers on it; `depth` is `ln(2L/a)` of the reach L of the plane body and the half-length a.
///
/// Forces beyond the ends are felt likewise. By Betti's theorem they then add to the moments what the same forces on the
/// line would, whose energy is the least: a flexibility that is positive on the line is positive on every patch shorter
/// than 4L. Forces `T_n(t)/√(1 − t²)` displace the line by `T_n(t)/n`, and places t = cosh ξ beyond by `e^{−nξ}/n`; for
/// n = 0 by `depth` and `depth − ξ`.
pub fn powers(t: f64, depth: f64) -> ByPowers {
    let size = t.abs();
    if size <= 1.0 {
        return [1.0, t, t * t, t * t * t, t * t * t * t];
    }
    let fall = 1.0 / (size + (size * size - 1.0).sqrt());
    let (square, odd, even) = (fall * fall, t.signum() * fall, 1.0 + libm::log(fall) / depth);
    let fourth = 0.125 * (3.0 * even + square * (4.0 + square));
    [even, odd, 0.5 * (even + square), 0.25 * odd * (3.0 + square), fourth]
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

/// Changes of the slip [m/s] with the displacement of a field, which has the weight `rate` in its rate [1/s], and with
/// its strain: half of the sum `speed` of the speeds of both surfaces [m/s] carries it.
pub fn slip_of_field([rate, speed]: [f64; 2], half_length: f64) -> [f64; 2] {
    [rate, -0.5 * speed / half_length]
}

impl InPatch<'_> {
    /// Fields along and across of the forces of all lines with the given moments along and across on this one.
    pub fn fields(&self, moments: impl Iterator<Item = [ByPowers; 2]> + Clone) -> [Field; 2] {
        let sums = |of: fn(&Between) -> &ByMoments| self.flexibility.sums(self.line, moments.clone(), of);
        let (displacement, strain) = (sums(|by| &by.displacement), sums(|by| &by.strain));
        let mut fields = [0, 1].map(|k| Field { displacement: displacement[k], strain: strain[k] });
        let own = moments.clone().nth(self.line).map_or([0.0; 2], |moments| moments.map(|moments| moments[0]));
        (0..2).for_each(|k| fields[k].displacement[0] += self.by_reach(k) * own[k]);
        fields
    }

    /// Derivatives, by the size of this line, of the displacements along and across by the forces of all lines with the given
    /// moments along and across, but for those of its own logarithms \[m].
    pub fn growths(&self, moments: impl Iterator<Item = [ByPowers; 2]> + Clone) -> [ByPowers; 2] {
        let mut growths = self.flexibility.sums(self.line, moments.clone(), |by| &by.growth);
        let own = moments.clone().nth(self.line).map_or([0.0; 2], |moments| moments.map(|moments| moments[0]));
        (0..2).for_each(|k| growths[k][0] -= 0.5 * self.by_reach(k) * own[k]);
        growths
    }

    /// Effect of the forces of line number `by` in the `other` of two directions, along (0) and across (1), in one of them, but for
    /// [`Self::by_reach`]; `None`: there is no lateral part.
    pub fn between(&self, by: usize, [direction, other]: [usize; 2]) -> Option<&Between> {
        match (direction, other) {
            (0, 0) => Some(self.flexibility.between(self.line, by)),
            _ => self
                .flexibility
                .across(self.line, by)
                .map(|[across, askew]| if direction == other { across } else { askew }),
        }
    }

    /// Displacement by a unit of the own force along (0) or across (1) for which the line itself gives way too much, as it
    /// reaches farther than the tables leave to it [m²/N].
    pub fn by_reach(&self, direction: usize) -> f64 {
        let left = self.flexibility.left(self.line, direction);
        left.map_or(0.0, |left| left.factor * (left.reach + libm::log(self.half_length) - self.reaches[direction]))
    }

    /// Powers of places on the line, see [`powers`].
    pub fn powers(&self, x: &[f64]) -> impl Iterator<Item = ByPowers> {
        let (length, depth) = (self.half_length, LN_2 + (self.reaches[0] - libm::log(self.half_length)).max(0.0));
        x.iter().map(move |x| powers(x / length, depth))
    }
}

/// Effects of unit forces on `tiles` on each other by kernels, displacements of one tile by a force on another one at a
/// distance \[m], with their symmetries in it; those `beside` the middle stand for a symmetric pair.
fn tables<const K: usize>(
    tiles: &[Tile],
    material: HalfSpace,
    beside: &impl Fn(&Tile) -> bool,
    symmetries: [Symmetry; K],
    kernels: impl Fn(Tile, Tile, f64) -> [TileInfluence; K],
) -> [Vec<Between>; K] {
    let (projection, count) = (MomentProjection::new(), tiles.len());
    let mut tables = symmetries.map(|_| vec![Between::default(); count * count]);
    for (pair, (at, of)) in tiles.iter().flat_map(|at| tiles.iter().map(move |of| (at, of))).enumerate() {
        let image = beside(of).then(|| of.mirrored());
        let at_distance = |x: f64| {
            let mut influences = kernels(*at, *of, x);
            let others = image.map(|image| kernels(*at, image, x));
            others.iter().flatten().zip(&mut influences).for_each(|(other, influence)| influence.add(other));
            influences
        };
        let sums = tables.each_mut().map(|table| &mut table[pair]);
        projection.add([at, of], material.factor(), (symmetries, at_distance), sums);
    }
    let width = |tile: &Tile| if beside(tile) { 2.0 * tile.width() } else { tile.width() };
    for (i, j) in (0..count).flat_map(|i| (i..count).map(move |j| (i, j))) {
        let of = [&tiles[i], &tiles[j]];
        for pairs in &mut tables {
            let [mut first, mut second] = [pairs[i * count + j], pairs[j * count + i]];
            reconcile([&mut first, &mut second], of.map(width), of.map(|tile| tile.half_length));
            (pairs[i * count + j], pairs[j * count + i]) = (first, second);
        }
    }
    tables
}

/// Leaves the mean displacement of every line to its own logarithm, whose factor is `factor` \[m²/N]: a constant
/// displacement may belong to that as well. So it ends where a force of the line no longer displaces it by more than the
/// mean over all lines.
fn leave(pairs: &mut [Between], tiles: &[Tile], factor: f64) -> Vec<Left> {
    let count = tiles.len();
    let left = tiles.iter().enumerate().map(|(line, tile)| {
        let reach = pairs[line * count..][..count].iter().map(|pair| mean(&pair.displacement)).sum::<f64>() / factor;
        pairs[line * (count + 1)].displacement[0][0] -= factor * reach;
        pairs[line * (count + 1)].growth[0][0] += 0.5 * factor * reach;
        Left { factor, reach: reach - libm::log(tile.half_length) }
    });
    left.collect()
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
            let patch = PatchFlexibility::new(&tiles, mirrored, STEEL);
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
        let patch = PatchFlexibility::sideways(&tiles, STEEL);
        let forces = [
            [[1.0, 0.3, -0.2, 0.5, 0.1], [0.2, -0.7, 0.4, 0.1, 0.9]],
            [[0.4, -1.0, 0.7, 0.2, -0.3], [-0.5, 0.3, 0.8, -0.6, 0.2]],
            [[2.0, 0.1, 0.1, -0.6, 0.8], [1.1, 0.5, -0.9, 0.3, -0.1]],
        ];
        let none = [ByPowers::default(); 2];
        let work = |at: usize, by: usize, of: fn(&Between) -> &ByMoments| -> f64 {
            let moments = (0..tiles.len()).map(|line| if line == by { forces[line] } else { none });
            let fields = patch.sums(at, moments, of);
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
        assert!(moved.abs() < 1e-23, "{moved:e}");
    }

    #[test]
    fn tables_are_the_same_for_patches_of_every_size() {
        let [small, large] = [1e-3, 2e-3].map(|s| PatchFlexibility::new(&strips(s), true, STEEL));
        for (a, b) in small.pairs.iter().zip(&large.pairs) {
            for (a, b) in [(a.displacement, b.displacement), (a.strain, b.strain), (a.growth, b.growth)] {
                // Angles near the ends of lines are half as exact as places.
                let same = |(a, b): (&f64, &f64)| (a - b).abs() < 1e-18;
                assert!(a.as_flattened().iter().zip(b.as_flattened()).all(same));
            }
        }
        assert!(small.left.iter().zip(&large.left).all(|(a, b)| (a.reach - b.reach).abs() < 1e-9));
    }

    /// Displacement of a wide strip in its middle, far from its sides: that of the plane, in which only the distance at
    /// which a logarithm ends is the width's.
    #[test]
    fn a_wide_strip_is_displaced_as_the_plane() {
        let tile = Tile { edges: [-1.0, 1.0], half_length: 1e-3 };
        let patch = PatchFlexibility::new(&[tile], false, STEEL);
        let rest = field(patch.between(0, 0), &[1.0, 0.0, 0.0, 0.0, 0.0]);
        let logarithm = 2.0 * (1.0 - STEEL.poissons_ratio) * STEEL.factor();
        // `asinh(w/|x|) − (1 − 2ν)/(1 − ν)` for a width w = 2.
        let reach = 4.0_f64.ln() - (1.0 - 2.0 * STEEL.poissons_ratio) / (1.0 - STEEL.poissons_ratio);
        let own = patch.own(0, 0, tile.half_length);
        assert!((own.reach - reach).abs() < 1e-3);
        // That of one half-plane, `(1 − ν)/(πG)` (Flamant).
        assert!((own.factor * PI * 81e9 / 0.7 - 1.0).abs() < 1e-12, "{}", own.factor);
        assert!(rest.displacement.iter().all(|c| c.abs() < 1e-3 * logarithm), "{rest:?}");
    }

    /// Chebyshev's polynomials in each power, and the integral of the logarithm over the angles of forces.
    #[test]
    fn powers_go_on_beyond_a_line_as_the_displacement_of_a_plane_body_by_what_causes_them_on_it() {
        let in_chebyshev: [&[f64]; POINTS] =
            [&[1.0], &[0.0, 1.0], &[0.5, 0.0, 0.5], &[0.0, 0.75, 0.0, 0.25], &[0.375, 0.0, 0.5, 0.0, 0.125]];
        let (count, depth) = (1000, 1.3);
        for t in [0.4, 1.01, -1.3, 4.0, -9.0_f64] {
            let of_power = |k: usize| -> f64 {
                let displaced = |angle: f64| {
                    let forces = in_chebyshev[k].iter().enumerate().map(|(n, share)| {
                        let by_force = if n == 0 { depth } else { 1.0 / n as f64 };
                        share / by_force * (n as f64 * angle).cos()
                    });
                    forces.sum::<f64>() * (depth - LN_2 - (t - angle.cos()).abs().ln())
                };
                (0..count).map(|i| displaced(PI * (f64::from(i) + 0.5) / f64::from(count))).sum::<f64>()
                    / f64::from(count)
            };
            for (k, found) in powers(t, depth).into_iter().enumerate() {
                let expected = of_power(k);
                // The logarithm is less smooth on the line.
                let close = if t.abs() < 1.0 { 0.02 } else { 1e-6 };
                assert!((found - expected).abs() < close, "{k} at {t}: {found} {expected}");
            }
        }
    }
}
