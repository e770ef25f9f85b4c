//! Hot layers of the surfaces under a patch: they swell, and their membrane forces pull along the bodies.
//!
//! Bodies exchange heat under the patch only, so that the content of a layer is constant ahead of it and behind it. On
//! the patch of the last step, `x = c + b cos θ`, it is `base + turn θ + Σ n_k sin kθ`: heat that flows on contact
//! rises like a root at the edges, as these functions do. The membrane force N pulls with `−N′` at a half-plane, which
//! it displaces by `κ [∫ n/(x − s) ds − π turn ln(b/2)]` with the part n of the sines. The layers move with the edges
//! of the patch.

use super::chebyshev::{Arch, TERMS};
use super::constants::{Constants, LayerSamples, LayerTables, PARTS};
use super::surface::AtPoints;
use super::tables::{QUADRATURE, SLOPE, SMOOTH};
use crate::contact::kernel::Logarithm;
use crate::contact::problem::OneLine;
use crate::linalg::POINTS;
use crate::piecewise::Piecewise;
use nalgebra::Complex;
use std::f64::consts::PI;

/// Distance from the middle at which the content of a layer ahead of the patch and behind it is taken, in half-widths
/// \[1]: elements and the depth of the heat round off the root at the edges themselves.
const BESIDE: f64 = 1.1;
/// Depth of the heat, in half-widths \[1]. It smooths the effect of the pulls, as a Poisson kernel does. Without any,
/// the strain would have a root at the leading edge whose other side, ahead of the patch, the sticking surfaces never
/// meet; with any, however thin, they meet it. Its size hardly matters: this one is what a series of the shear still
/// resolves.
const DEPTH: f64 = 0.03;
/// Smallest `sin θ` that slopes are taken at: nearer to the edges they grow without bound, and there is next to no
/// traction.
const EDGE: f64 = 1e-3;

/// A function on the patch.
#[derive(Clone, Copy, Debug)]
pub struct LayerProfile {
    /// Value at the end in `+x`.
    base: f64,
    /// Change from there to the other end over π.
    turn: f64,
    /// The sines.
    sines: Arch,
    /// The sines, each times its number.
    rates: Arch,
}

impl LayerProfile {
    fn new(tables: &LayerTables, patch: &Arch, samples: &LayerSamples) -> Self {
        let base = samples[0];
        let turn = (samples[PARTS] - base) / PI;
        let inner: [f64; PARTS - 1] =
            std::array::from_fn(|m| samples[m + 1] - base - turn * (m + 1) as f64 * PI / PARTS as f64);
        let terms = tables.sines.map(|weights| weights.iter().zip(&inner).map(|(w, v)| w * v).sum());
        let rates = std::array::from_fn(|k| (k + 1) as f64 * terms[k]);
        let arch = |terms| Arch { count: TERMS, terms, ..*patch };
        Self { base, turn, sines: arch(terms), rates: arch(rates) }
    }

    /// Moves it to the edges of another patch.
    fn fit(&mut self, patch: &Arch) {
        for arch in [&mut self.sines, &mut self.rates] {
            (arch.centre, arch.half_width) = (patch.centre, patch.half_width);
        }
    }

    /// Its values.
    pub fn at<const N: usize>(&self, x: &[f64; N]) -> [f64; N] {
        let sines = self.sines.density(x);
        std::array::from_fn(|i| {
            let t = (x[i] - self.sines.centre) / self.sines.half_width;
            self.base + self.turn * libm::acos(t.clamp(-1.0, 1.0)) + sines[i]
        })
    }

    /// Its slopes.
    pub fn slope<const N: usize>(&self, x: &[f64; N]) -> [f64; N] {
        let cosines = self.rates.cauchy(x);
        let roots = self.roots(x);
        std::array::from_fn(|i| -(self.turn + cosines[i] / PI) / roots[i])
    }

    /// `b sin θ`, and no less than a little near the edges.
    fn roots<const N: usize>(&self, x: &[f64; N]) -> [f64; N] {
        let Arch { centre, half_width, .. } = self.sines;
        x.map(|x| (half_width.powi(2) - (x - centre).powi(2)).max((EDGE * half_width).powi(2)).sqrt())
    }
}

/// Hot layer of one body and its effects.
#[derive(Clone, Copy, Debug)]
pub struct SeriesLayer {
    /// Membrane force [N/m].
    force: LayerProfile,
    /// Swelling \[m].
    pub swelling: LayerProfile,
    /// Normal displacement of the half-plane \[m].
    pub lift: LayerProfile,
    /// Displacement of the line along a tangential force.
    kernel: Logarithm,
    /// Moments of the pull with the polynomials of the points [N/m].
    pub pull: AtPoints,
}

impl SeriesLayer {
    /// Tangential displacement of the half-plane \[m].
    fn along<const N: usize>(&self, x: &[f64; N]) -> [f64; N] {
        let LayerProfile { turn, sines, .. } = &self.force;
        let (base, _) = depth(sines, x);
        let sums = powers(&sines.terms, &base);
        std::array::from_fn(|i| {
            // ½ (z + √(z² − 1)) is ½ over the base of the powers.
            let ends = libm::log(sines.half_width) - 0.5 * libm::log(4.0 * base[i].norm_sqr()) - self.kernel.reach;
            self.kernel.factor * PI * ((sums[i] * base[i]).re - turn * ends)
        })
    }
}

/// `z − √(z² − 1)` and `√(z² − 1)` at places in the depth below a patch.
fn depth<const N: usize>(patch: &Arch, x: &[f64; N]) -> ([Complex<f64>; N], [Complex<f64>; N]) {
    let root = |z: Complex<f64>| {
        let square = z * z - 1.0;
        let larger = (0.5 * (square.norm_sqr().sqrt() + square.re.abs())).sqrt();
        let smaller = 0.5 * square.im / larger;
        let root = if square.re >= 0.0 { Complex::new(larger, smaller) } else { Complex::new(smaller, larger) };
        // Far away the root is z itself.
        if root.re * z.re + root.im * z.im < 0.0 { -root } else { root }
    };
    let place = x.map(|x| Complex::new((x - patch.centre) / patch.half_width, DEPTH));
    let roots = place.map(root);
    (std::array::from_fn(|i| place[i] - roots[i]), roots)
}

/// `Σ f_k z^k`.
fn powers<const N: usize>(f: &[f64; TERMS], z: &[Complex<f64>; N]) -> [Complex<f64>; N] {
    let (mut re, mut im) = ([0.0; N], [0.0; N]);
    for f in f.iter().rev() {
        for i in 0..N {
            (re[i], im[i]) = (re[i] * z[i].re - im[i] * z[i].im + f, re[i] * z[i].im + im[i] * z[i].re);
        }
    }
    std::array::from_fn(|i| Complex::new(re[i], im[i]))
}

/// Both layers.
#[derive(Clone, Copy, Debug)]
pub struct SeriesLayers {
    /// Of the wheel.
    pub wheel: SeriesLayer,
    /// Of the rail.
    pub rail: SeriesLayer,
    /// Part of the gap that the layers add \[m].
    pub gap: LayerProfile,
    /// Its slope as a series in `T_n`, times the half-width \[m].
    pub slope: [f64; SLOPE],
    /// Tangential displacement of the half-plane of the wheel less that of the rail, at the points of the polynomials
    /// \[m].
    pub relative: AtPoints,
    /// Tangential displacements of both half-planes at the places of the pressure \[m].
    pub along: [[f64; QUADRATURE]; 2],
}

impl SeriesLayers {
    /// Layers of a problem that come from contact on `patch`; `None` where nothing is warm.
    pub fn new(constants: &Constants, problem: &OneLine, patch: &Arch) -> Option<Self> {
        let (force, swelling) = (problem.line.membrane, problem.line.placement.swelling);
        if force.iter().chain(&swelling).all(|layer| layer.is_empty()) {
            return None;
        }
        let (Constants { layers: tables, points, .. }, line) = (constants, &problem.line.kernel);
        let samples = |layer: &Piecewise| {
            let at = |t: f64| layer.at(patch.centre + patch.half_width * if t.abs() < 1.0 { t } else { BESIDE * t });
            tables.places.map(at)
        };
        let (force, swelling) = (force.map(samples), swelling.map(samples));
        let profile = |samples: &LayerSamples| LayerProfile::new(tables, patch, samples);
        let lift = |body: usize| lift(line.coupling, &force[body], 1.0 - 2.0 * body as f64);
        let layer = |body: usize| SeriesLayer {
            force: profile(&force[body]),
            swelling: profile(&swelling[body]),
            lift: profile(&lift(body)),
            kernel: line.tangential,
            pull: pull(constants, patch, &force[body]),
        };
        let (wheel, rail, [up, down]) = (layer(0), layer(1), [lift(0), lift(1)]);
        let gap = std::array::from_fn(|m| up[m] - down[m] - swelling[0][m] - swelling[1][m]);
        let nodes = points.nodes();
        let [of_wheel, of_rail] = [&wheel, &rail].map(|layer| layer.along(&nodes));
        let relative = std::array::from_fn(|k| of_wheel[k] - of_rail[k]);
        let gap = profile(&gap);
        // Sums over the zeros of T_16 are integrals; those over the few places at which the gap is closed are none.
        let zeros = tables.zeros.map(|t| patch.centre + patch.half_width * t);
        let steep = gap.slope(&zeros).map(|slope| slope * patch.half_width);
        let slope = tables.zeros_terms.map(|terms| terms.iter().zip(&steep).map(|(t, s)| t * s).sum());
        let places = constants.tables.places.map(|t| patch.centre + patch.half_width * t);
        let along = [wheel.along(&places), rail.along(&places)];
        Some(Self { wheel, rail, gap, slope, relative, along })
    }

    /// Slopes of the tangential displacements of the half-planes of wheel and rail, each times its factor.
    pub fn stretch<const N: usize>(&self, x: &[f64; N], factors: [f64; 2]) -> [f64; N] {
        let (wheel, rail) = (&self.wheel.force, &self.rail.force);
        let both = |of_wheel: f64, of_rail: f64| factors[0] * of_wheel + factors[1] * of_rail;
        let rates = std::array::from_fn(|k| both(wheel.rates.terms[k], rail.rates.terms[k]));
        let (turn, (base, root)) = (both(wheel.turn, rail.turn), depth(&wheel.rates, x));
        let (sums, scale) = (powers(&rates, &base), -self.wheel.kernel.factor * PI / wheel.rates.half_width);
        std::array::from_fn(|i| scale * ((sums[i] * base[i] + turn) / root[i]).re)
    }

    /// Lets the effect of a line's own forces end at another distance, the logarithm of which is larger `by` so much.
    pub fn reach_further(&mut self, by: f64) {
        let mut shifts = [0.0; 2];
        for (shift, layer) in shifts.iter_mut().zip([&mut self.wheel, &mut self.rail]) {
            layer.kernel.reach += by;
            *shift = layer.kernel.factor * PI * layer.force.turn * by;
        }
        self.relative.iter_mut().for_each(|moved| *moved += shifts[0] - shifts[1]);
        self.along.iter_mut().zip(shifts).for_each(|(along, shift)| along.iter_mut().for_each(|moved| *moved += shift));
    }

    /// Largest term of the slope of the gap that the pressure does not follow, times the half-width \[m].
    pub fn unresolved(&self) -> f64 {
        self.slope[SMOOTH..].iter().fold(0.0, |most, term| most.max(term.abs()))
    }

    /// Moves both layers to the edges of another patch.
    pub fn fit(&mut self, patch: &Arch) {
        for layer in [&mut self.wheel, &mut self.rail] {
            [&mut layer.force, &mut layer.swelling, &mut layer.lift].into_iter().for_each(|profile| profile.fit(patch));
        }
        self.gap.fit(patch);
    }
}

/// The moments of both pulls; none where nothing is warm.
pub fn pulls(layers: &Option<SeriesLayers>) -> [AtPoints; 2] {
    layers.as_ref().map_or([[0.0; POINTS]; 2], |layers| [layers.wheel.pull, layers.rail.pull])
}

/// Normal displacement of a half-plane above its surface (`side` 1) or below it (−1) by the pull of a membrane force.
fn lift(coupling: f64, force: &LayerSamples, side: f64) -> LayerSamples {
    force.map(|n| 0.5 * side * coupling * (force[0] + force[PARTS] - 2.0 * n))
}

/// Moments of the pull of a membrane force with the polynomials.
fn pull(constants: &Constants, patch: &Arch, force: &LayerSamples) -> AtPoints {
    let mut moments = AtPoints::default();
    for (force, places) in force.windows(2).zip(constants.layers.places.windows(2)) {
        let values = constants.points.values(patch.centre + 0.5 * patch.half_width * (places[0] + places[1]));
        moments.iter_mut().zip(values).for_each(|(moment, value)| *moment += (force[1] - force[0]) * value);
    }
    moments
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::Lagrange;

    const PATCH: Arch = Arch { centre: 1e-3, half_width: 6e-3, count: 0, terms: [0.0; TERMS] };

    /// Layers in which the wheel is chilled and the rail warmed with the root of the way through the patch.
    fn layer() -> SeriesLayer {
        let kernel = Logarithm { factor: 2.8e-12, reach: 0.0 };
        let constants = Constants::new(Lagrange::new(0.012));
        let force = constants.layers.places.map(|t| -4e4 * (1.0 - t).sqrt());
        let [profile, swelling] = [force, force].map(|samples| LayerProfile::new(&constants.layers, &PATCH, &samples));
        let lift = LayerProfile::new(&constants.layers, &PATCH, &lift(2.5e-12, &force, 1.0));
        let pull = pull(&constants, &PATCH, &force);
        SeriesLayer { force: profile, swelling, lift, kernel, pull }
    }

    /// `∫ −N′ f(s) ds` with `N = −4e4 √(1 − t)`, over `r = √(1 − t)`.
    fn pulled(f: impl Fn(f64) -> f64) -> f64 {
        let n = 20_000;
        let part = 2.0_f64.sqrt() / f64::from(n);
        let places = (0..n).map(|i| part * (f64::from(i) + 0.5));
        -4e4 * part * places.map(|r| f(PATCH.centre + PATCH.half_width * (1.0 - r * r))).sum::<f64>()
    }

    #[test]
    fn pulls_displace_a_half_plane_as_their_integral_in_the_depth_does() {
        let (layer, depth) = (layer(), DEPTH * PATCH.half_width);
        let x = [-0.9, -0.5, 0.0, 0.4, 0.8, 0.95].map(|t| PATCH.centre + t * PATCH.half_width);
        let scale = 4e4 * layer.kernel.factor;
        for (x, along) in x.into_iter().zip(layer.along(&x)) {
            let expected = -layer.kernel.factor * pulled(|s| 0.5 * ((x - s).powi(2) + depth * depth).ln());
            println!("{x:.4}: {along:.5e}, integral {expected:.5e}");
            assert!((along - expected).abs() < 5e-4 * scale);
        }
        let layers = SeriesLayers {
            wheel: layer,
            rail: layer,
            gap: layer.lift,
            slope: [0.0; SLOPE],
            relative: [0.0; POINTS],
            along: [[0.0; QUADRATURE]; 2],
        };
        for (x, stretch) in x.into_iter().zip(layers.stretch(&x, [1.0, 0.0])) {
            let expected = -layer.kernel.factor * pulled(|s| (x - s) / ((x - s).powi(2) + depth * depth));
            println!("{x:.4}: {stretch:.5e}, integral {expected:.5e}");
            assert!((stretch - expected).abs() < 5e-3 * scale / PATCH.half_width);
        }
        assert!((layer.pull.iter().sum::<f64>() - pulled(|_| 1.0)).abs() < 1e-6 * 4e4);
    }

    #[test]
    fn a_profile_and_its_slope_are_found_again_between_its_samples() {
        let layer = layer();
        let t: [f64; 5] = [-0.8, -0.3, 0.1, 0.6, 0.9];
        let x = t.map(|t| PATCH.centre + t * PATCH.half_width);
        for ((t, value), slope) in t.into_iter().zip(layer.force.at(&x)).zip(layer.force.slope(&x)) {
            let (expected, steep) = (-4e4 * (1.0 - t).sqrt(), 2e4 / (1.0 - t).sqrt() / PATCH.half_width);
            println!("{t}: {value:.2} for {expected:.2}, {slope:.3e} for {steep:.3e}");
            assert!((value / expected - 1.0).abs() < 2e-3 && (slope / steep - 1.0).abs() < 0.05);
        }
    }
}
