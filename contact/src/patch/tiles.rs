//! Half-spaces under tangential tractions on tiles: strips across the direction of rolling, each as wide as the contact
//! line that stands for it.
//!
//! A force `f` per width on the tile γ < z < δ, constant across it, displaces half-spaces along x; the displacement of
//! another tile α < z < β is the mean over it. With unit point forces, times `1/(πG)` for both bodies of equal material
//! (Johnson, *Contact Mechanics* (1985), section 3.6), and their second antiderivatives in the lateral distance s,
//!
//! ```text
//! x by x   (1 − ν)/r + ν x²/r³     H(x, s) = (1 − ν) s asinh(s/|x|) − (1 − 2ν) r,      r² = x² + s²
//! z by z        1/r − ν x²/r³      H(x, s) =         s asinh(s/|x|) − (1 + ν) r
//! x by z, z by x    ν x s/r³       H(x, s) = −ν x asinh(s/|x|)
//! G(x) = [H(β − γ) − H(β − δ) − H(α − γ) + H(α − δ)]/(β − α)/(πG)
//! ```
//!
//! Derivation: `docs/theory/lines.md`.

/// The strip of the half-spaces for which a contact line stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tile {
    /// Lateral edges \[m].
    pub edges: [f64; 2],
    /// Half of the length of the line \[m].
    pub half_length: f64,
}

/// Displacement of a tile by a unit force per width on another one at a distance x, times `πG` \[1], and what follows
/// from it. Of a tile's own displacement the logarithm is left out, lengths in metres: `2 (1 − ν) ln(1/|x|)` along,
/// `2 ln(1/|x|)` across.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TileInfluence {
    /// The displacement \[1].
    pub displacement: f64,
    /// Its derivative by x [1/m].
    pub strain: f64,
    /// Its derivative by the size of the displaced tile, whose edges move away from z = 0 in proportion, while the
    /// force stays where it is \[1].
    pub growth: f64,
}

impl TileInfluence {
    /// Adds that of another force.
    pub fn add(&mut self, other: &Self) {
        self.displacement += other.displacement;
        self.strain += other.strain;
        self.growth += other.growth;
    }
}

/// An edge of a displaced tile and one of the tile of the force, at a distance x.
struct Corner {
    /// Sign in the second difference.
    sign: f64,
    /// Place of the displaced edge \[m].
    here: f64,
    /// Its lateral distance s from the other one, and its distance r \[m].
    s: f64,
    r: f64,
    /// `x/r`, `s/r` and `|s|/(|s| + r)`.
    along: f64,
    aside: f64,
    flat: f64,
    /// `ln(|s| + r)`, which is `asinh(|s|/|x|)` and the logarithm of |x|.
    steep: f64,
    /// That logarithm; 0 in a tile's own displacement.
    logarithm: f64,
}

/// Smallest distance whose logarithm is taken \[m].
const LEAST: f64 = 1e-12;

impl Tile {
    /// The tile on the other side of z = 0.
    pub fn mirrored(self) -> Self {
        let [low, high] = self.edges;
        Self { edges: [-high, -low], ..self }
    }

    /// Width \[m].
    pub fn width(self) -> f64 {
        self.edges[1] - self.edges[0]
    }

    /// Its displacement along by a force along on the tile `of` at the distance x \[m] on half-spaces with Poisson's
    /// ratio ν \[1].
    pub fn displaced_by(self, of: Self, x: f64, nu: f64) -> TileInfluence {
        self.displaced(&self.corners(of, x), [1.0 - nu, 1.0 - 2.0 * nu, nu])
    }

    /// Its displacements along by a force along, across by one across, and across by one along, which is that along by
    /// one across, as [`Self::displaced_by`]. None of the last by its own force.
    pub fn displaced_every_way(self, of: Self, x: f64, nu: f64) -> [TileInfluence; 3] {
        let corners = self.corners(of, x);
        let [along, across] =
            [[1.0 - nu, 1.0 - 2.0 * nu, nu], [1.0, 1.0 + nu, -nu]].map(|by| self.displaced(&corners, by));
        let askew = if self == of { TileInfluence::default() } else { self.displaced_askew(&corners, x, nu) };
        [along, across, askew]
    }

    /// Its edges beside those of the tile `of` at the distance x.
    fn corners(self, of: Self, x: f64) -> [Corner; 4] {
        let logarithm = if self == of { 0.0 } else { libm::log(x.abs().max(LEAST)) };
        let corner = |i: usize, j: usize| {
            let (here, s) = (self.edges[i], self.edges[i] - of.edges[j]);
            let (r, size) = ((x * x + s * s).sqrt(), s.abs());
            let apart = r > 0.0;
            Corner {
                sign: if i == j { -1.0 } else { 1.0 },
                here,
                s,
                r,
                along: if apart { x / r } else { 0.0 },
                aside: if apart { s / r } else { 0.0 },
                flat: if apart { size / (size + r) } else { 0.0 },
                steep: if size > 0.0 { libm::log(size + r) } else { 0.0 },
                logarithm,
            }
        };
        [corner(0, 0), corner(0, 1), corner(1, 0), corner(1, 1)]
    }

    /// Displacement whose second antiderivative is `−ν x asinh(s/|x|)`.
    fn displaced_askew(self, corners: &[Corner; 4], x: f64, nu: f64) -> TileInfluence {
        let mut sum = TileInfluence::default();
        for &Corner { sign, here, s, along, aside, steep, logarithm, .. } in corners {
            sum.growth -= sign * here * nu * along;
            if s != 0.0 {
                let steep = (steep - logarithm) * s.signum();
                sum.displacement -= sign * nu * x * steep;
                sum.strain -= sign * nu * (steep - aside);
            }
        }
        self.mean(sum)
    }

    /// Displacement whose second antiderivative is `c s asinh(s/|x|) − d r`, and `e = c − d`. The logarithm of x cancels in
    /// all but a tile's own displacement.
    fn displaced(self, corners: &[Corner; 4], [c, d, e]: [f64; 3]) -> TileInfluence {
        let mut sum = TileInfluence::default();
        for &Corner { sign, here, s, r, along, aside, flat, steep, logarithm } in corners {
            let size = s.abs();
            sum.displacement += sign * (c * size * steep - d * r);
            sum.strain += sign * along * (c * flat - d);
            if size > 0.0 {
                sum.growth += sign * here * (c * (steep - logarithm) * s.signum() + e * aside);
            }
        }
        self.mean(sum)
    }

    /// Mean over the tile, given the sums over its edges.
    fn mean(self, sum: TileInfluence) -> TileInfluence {
        let width = self.width();
        let [displacement, strain] = [sum.displacement, sum.strain].map(|sum| sum / width);
        TileInfluence { displacement, strain, growth: sum.growth / width - displacement }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const NU: f64 = 0.3;

    fn tile(low: f64, high: f64) -> Tile {
        Tile { edges: [low, high], half_length: 1.0 }
    }

    /// Double integral of the displacement by point forces over both tiles by the rule of the middle.
    fn integral(at: Tile, of: Tile, x: f64) -> f64 {
        integral_of(at, of, |s| {
            let r = x.hypot(s);
            (1.0 - NU) / r + NU * x * x / r.powi(3)
        })
    }

    /// Mean over a tile of the integral over another one of a function of their lateral distance.
    fn integral_of(at: Tile, of: Tile, kernel: impl Fn(f64) -> f64) -> f64 {
        let n = 400;
        let place = |tile: Tile, i: i32| tile.edges[0] + tile.width() * (f64::from(i) + 0.5) / f64::from(n);
        let mut sum = 0.0;
        for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
            sum += kernel(place(at, i) - place(of, j));
        }
        sum * of.width() / f64::from(n * n)
    }

    #[test]
    fn a_tile_is_displaced_as_the_integral_over_point_forces_says() {
        for (at, of) in
            [(tile(-1.0, 0.5), tile(-1.0, 0.5)), (tile(0.5, 1.0), tile(-1.0, 0.5)), (tile(0.2, 1.0), tile(3.0, 5.0))]
        {
            for x in [0.1, -0.7, 4.0_f64] {
                let own = if at == of { -2.0 * (1.0 - NU) * x.abs().ln() } else { 0.0 };
                let (found, exact) = (at.displaced_by(of, x, NU).displacement + own, integral(at, of, x));
                assert!((found / exact - 1.0).abs() < 1e-4, "{at:?} {of:?} {x}: {found} {exact}");
            }
        }
    }

    #[test]
    fn tiles_are_displaced_across_and_askew_as_the_integrals_over_point_forces_say() {
        for (at, of) in
            [(tile(-1.0, 0.5), tile(-1.0, 0.5)), (tile(0.5, 1.0), tile(-1.0, 0.5)), (tile(0.2, 1.0), tile(3.0, 5.0))]
        {
            for x in [0.1, -0.7, 4.0_f64] {
                let own = if at == of { -2.0 * x.abs().ln() } else { 0.0 };
                let across = integral_of(at, of, |s| 1.0 / x.hypot(s) - NU * x * x / x.hypot(s).powi(3));
                let askew = integral_of(at, of, |s| NU * x * s / x.hypot(s).powi(3));
                let [_, found @ ..] = at.displaced_every_way(of, x, NU).map(|it| it.displacement);
                assert!(((found[0] + own) / across - 1.0).abs() < 2e-4, "{at:?} {of:?} {x}: {found:?} {across}");
                assert!((found[1] - askew).abs() < 1e-4 * across, "{at:?} {of:?} {x}: {found:?} {askew}");
            }
        }
    }

    #[test]
    fn strains_and_growth_across_and_askew_are_those_of_differences() {
        let (step, of) = (1e-5, tile(-0.5, 0.7));
        for (at, x) in [(tile(0.7, 1.0), 0.2), (tile(1.2, 1.4), -0.6_f64)] {
            for way in [1, 2] {
                let displaced = |x: f64| at.displaced_every_way(of, x, NU)[way];
                let (found, by_place) = (displaced(x), [x + step, x - step].map(|x| displaced(x).displacement));
                assert!((found.strain - (by_place[0] - by_place[1]) / (2.0 * step)).abs() < 1e-8);
            }
            // Sizes change the logarithms of what is left out of one another's, which cancel askew.
            let sized = |scale: f64| Tile { edges: at.edges.map(|z| z * scale), ..at };
            let by_size =
                [1.0 + step, 1.0 - step].map(|scale| sized(scale).displaced_every_way(of, x, NU)[2].displacement);
            let growth = at.displaced_every_way(of, x, NU)[2].growth;
            assert!((growth - (by_size[0] - by_size[1]) / (2.0 * step)).abs() < 1e-6);
        }
    }

    /// Betti: the works of two forces on each other's displacements are the same.
    #[test]
    fn tiles_displace_each_other_in_proportion_to_their_widths() {
        let [a, b] = [tile(-1.0, 0.5), tile(0.5, 1.2)];
        for x in [0.0, 0.3, -2.0] {
            let [there, back] = [a.displaced_by(b, x, NU), b.displaced_by(a, -x, NU)];
            assert!((a.width() * there.displacement - b.width() * back.displacement).abs() < 1e-14);
            assert!((a.width() * there.strain + b.width() * back.strain).abs() < 1e-14);
            for way in [1, 2] {
                let [there, back] =
                    [a.displaced_every_way(b, x, NU), b.displaced_every_way(a, -x, NU)].map(|ways| ways[way]);
                assert!((a.width() * there.displacement - b.width() * back.displacement).abs() < 1e-14);
                assert!(x == 0.0 || (a.width() * there.strain + b.width() * back.strain).abs() < 1e-14);
            }
        }
    }

    #[test]
    fn derivatives_by_place_and_size_are_those_of_differences() {
        let step = 1e-5;
        for (at, of) in
            [(tile(-0.5, 0.7), tile(-0.5, 0.7)), (tile(0.7, 1.0), tile(-0.5, 0.7)), (tile(0.7, 1.0), tile(1.0, 1.4))]
        {
            for x in [0.2, -0.6_f64] {
                let found = at.displaced_by(of, x, NU);
                let by_place = [x + step, x - step].map(|x| at.displaced_by(of, x, NU).displacement);
                assert!((found.strain - (by_place[0] - by_place[1]) / (2.0 * step)).abs() < 1e-8);
                let of_size = |scale: f64| integral_free(Tile { edges: at.edges.map(|z| z * scale), ..at }, of, x);
                let own = if at == of { (1.0 - NU) * x.abs().ln() } else { 0.0 };
                let by_size = (of_size(1.0 + step) - of_size(1.0 - step)) / (2.0 * step);
                assert!((found.growth + own - by_size).abs() < 1e-6, "{at:?} {of:?} {x}: {found:?} {own} {by_size}");
            }
        }
    }

    /// The displacement of tiles that are not the same, all logarithms included.
    fn integral_free(at: Tile, of: Tile, x: f64) -> f64 {
        let h = |s: f64| (1.0 - NU) * s * (s / x.abs()).asinh() - (1.0 - 2.0 * NU) * x.hypot(s);
        let [[a, b], [c, d]] = [at.edges, of.edges];
        (h(b - c) - h(b - d) - h(a - c) + h(a - d)) / at.width()
    }
}
