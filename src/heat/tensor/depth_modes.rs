//! The factor of the tensor meshes across the streamlines: eigenmodes over the depth.

use crate::heat::error::HeatError;
use crate::linalg::pencil::{Wide, WideModes, narrow, wide, wide_modes};
use nalgebra::DMatrix;

/// Eigenpairs of the direction across the streamlines.
///
/// `∫ g φₘ′φₙ′ + (α/k) φₘ(0) φₙ(0) = λₘ δₘₙ`, `∫ g φₘ φₙ = δₘₙ`, α the coefficient of convection to the air. The
/// eigenvalues span twelve decades (boundary layers of micrometres in bodies of decimetres), and heat balances sum over
/// all of them: the pencil is solved in double-double precision.
#[derive(Clone, Debug)]
pub(super) struct DepthModes {
    /// Eigenvalues `λ` [1/m²], ascending.
    pub values: Vec<f64>,
    /// Value of each mode at the surface.
    pub surface: Vec<f64>,
    /// `∫ g φₘ ψ dz` with ψ the interpolant that is 1 at all free nodes.
    pub free: Vec<f64>,
    /// `∫ g φₘ dz`.
    pub content: Vec<f64>,
    /// Nodal values, one mode per column; a fixed last node is left out.
    pub shapes: DMatrix<f64>,
    /// `∫ (1/g − g) φₘ φₙ dz`: what the replacement of `1/g` by `g` neglects; empty for a straight body.
    pub curvature: DMatrix<f64>,
    /// Depth of the nodes [m].
    pub depths: Vec<f64>,
    /// Whether the last node is held at the reference temperature.
    pub fixed: bool,
}

/// Modes are padded to a multiple of this number with empty ones, so that inner loops run on full registers.
const PADDING: usize = 4;

impl DepthModes {
    /// Quadratic elements between `layers` (depths from zero on [m]) under the weight `1 − curvature z`; `fixed` holds the
    /// last node, `film` is `α/k` [1/m].
    pub fn new(layers: &[f64], curvature: f64, fixed: bool, film: f64) -> Result<Self, HeatError> {
        let n = 2 * layers.len() - 1;
        let size = if fixed { n - 1 } else { n };
        let (mass, mut stiffness) = matrices(layers, curvature);
        stiffness[0] += wide(film);
        let leading = |matrix: &[Wide]| -> Vec<Wide> {
            matrix.chunks_exact(n).take(size).flat_map(|row| &row[..size]).copied().collect()
        };
        let WideModes { values, shapes } =
            wide_modes(&leading(&mass), &leading(&stiffness), size).map_err(|_| HeatError::Eigen { size })?;
        let padded = size.div_ceil(PADDING) * PADDING;
        let mut modes = Self {
            values: vec![0.0; padded],
            surface: vec![0.0; padded],
            free: vec![0.0; padded],
            content: vec![0.0; padded],
            shapes: DMatrix::zeros(size, padded),
            curvature: DMatrix::zeros(0, 0),
            depths: layers.windows(2).flat_map(|w| [w[0], 0.5 * (w[0] + w[1])]).chain(layers.last().copied()).collect(),
            fixed,
        };
        for m in 0..size {
            // Positive at the surface, so that the result is reproducible.
            let sign = if shapes[m].0 < 0.0 { wide(-1.0) } else { wide(1.0) };
            let product = |rows: usize| {
                let entries = (0..rows).flat_map(|i| (0..size).map(move |j| (i, j)));
                narrow(entries.fold(Wide::ZERO, |sum, (i, j)| sum + mass[i * n + j] * shapes[j * size + m]) * sign)
            };
            modes.values[m] = narrow(values[m]).max(0.0);
            modes.surface[m] = narrow(shapes[m] * sign);
            (modes.free[m], modes.content[m]) = (product(size), product(n));
            for i in 0..size {
                modes.shapes[(i, m)] = narrow(shapes[i * size + m] * sign);
            }
        }
        if !fixed && film == 0.0 {
            modes.values[0] = 0.0;
        }
        let last = modes.values[size - 1];
        modes.values[size..].fill(last);
        if curvature != 0.0 {
            modes.curvature = modes.shapes.transpose() * inverse_weight(layers, size, curvature) * &modes.shapes;
        }
        Ok(modes)
    }

    /// Number of modes, padding included.
    pub fn len(&self) -> usize {
        self.values.len()
    }

    /// Value of all modes at depth `z`.
    pub fn at(&self, z: f64) -> Vec<f64> {
        let last = self.depths.len() - 1;
        let element = (self.depths.partition_point(|&d| d <= z).saturating_sub(1) / 2).min(last / 2 - 1);
        let (a, b) = (self.depths[2 * element], self.depths[2 * element + 2]);
        let shape = quadratic((2.0 * z - a - b) / (b - a));
        let node = |i: usize, m: usize| if i < self.shapes.nrows() { self.shapes[(i, m)] } else { 0.0 };
        (0..self.len()).map(|m| (0..3).map(|i| shape[i] * node(2 * element + i, m)).sum()).collect()
    }

    /// Integral of every mode from the surface down to `depth` \[m].
    pub fn integrals(&self, depth: f64) -> Vec<f64> {
        self.weighted_integrals(depth, |_| 1.0)
    }

    /// Integral of every mode times the depth, down to `depth` [m²].
    pub fn moments(&self, depth: f64) -> Vec<f64> {
        self.weighted_integrals(depth, |z| z)
    }

    /// Integrals of all modes times a weight (Simpson's rule on intervals that grow with depth).
    fn weighted_integrals(&self, depth: f64, weight: impl Fn(f64) -> f64) -> Vec<f64> {
        let mut integrals = vec![0.0; self.len()];
        let (mut from, mut step) = (0.0, 1e-3 * depth);
        while from < depth {
            let to = (from + step).min(depth);
            for (z, share) in [(from, 1.0), (0.5 * (from + to), 4.0), (to, 1.0)] {
                for (integral, mode) in integrals.iter_mut().zip(self.at(z)) {
                    *integral += share / 6.0 * (to - from) * weight(z) * mode;
                }
            }
            (from, step) = (to, 1.3 * step);
        }
        integrals
    }
}

/// `∫ g N N dz` and `∫ g N′N′ dz`, row-major, of quadratic elements between `layers`, `g = 1 − curvature z`.
fn matrices(layers: &[f64], curvature: f64) -> (Vec<Wide>, Vec<Wide>) {
    let n = 2 * layers.len() - 1;
    let (mut mass, mut stiffness) = (vec![Wide::ZERO; n * n], vec![Wide::ZERO; n * n]);
    for (e, ends) in layers.windows(2).enumerate() {
        let (a, b) = (wide(ends[0]), wide(ends[1]));
        let half = wide(0.5) * (b - a);
        let middle = wide(1.0) - wide(0.5) * (a + b) * wide(curvature);
        let slope = -(wide(curvature) * half);
        for i in 0..3 {
            for j in 0..3 {
                let at = (2 * e + i) * n + 2 * e + j;
                mass[at] += half * (middle * wide(MASS[i][j]) + slope * wide(MASS_SLOPE[i][j])) / wide(15.0);
                stiffness[at] +=
                    (middle * wide(STIFFNESS[i][j]) + slope * wide(STIFFNESS_SLOPE[i][j])) / (wide(6.0) * half);
            }
        }
    }
    (mass, stiffness)
}

/// `15 ∫ N N dξ` of the quadratic element on (−1, 1).
const MASS: [[f64; 3]; 3] = [[4.0, 2.0, -1.0], [2.0, 16.0, 2.0], [-1.0, 2.0, 4.0]];
/// `15 ∫ ξ N N dξ`.
const MASS_SLOPE: [[f64; 3]; 3] = [[-3.0, -2.0, 0.0], [-2.0, 0.0, 2.0], [0.0, 2.0, 3.0]];
/// `6 ∫ N′N′ dξ`.
const STIFFNESS: [[f64; 3]; 3] = [[7.0, -8.0, 1.0], [-8.0, 16.0, -8.0], [1.0, -8.0, 7.0]];
/// `6 ∫ ξ N′N′ dξ`.
const STIFFNESS_SLOPE: [[f64; 3]; 3] = [[-4.0, 4.0, 0.0], [4.0, 0.0, -4.0], [0.0, -4.0, 4.0]];

fn quadratic(xi: f64) -> [f64; 3] {
    [0.5 * xi * (xi - 1.0), 1.0 - xi * xi, 0.5 * xi * (xi + 1.0)]
}

/// `∫ (1/g − g) N N dz` over all layers by Gauss quadrature (8 points), for the first `size` nodes.
fn inverse_weight(layers: &[f64], size: usize, curvature: f64) -> DMatrix<f64> {
    const POINTS: [(f64, f64); 4] = [
        (0.183_434_642_495_649_8, 0.362_683_783_378_362),
        (0.525_532_409_916_329, 0.313_706_645_877_887_3),
        (0.796_666_477_413_626_7, 0.222_381_034_453_374_48),
        (0.960_289_856_497_536_3, 0.101_228_536_290_376_26),
    ];
    let mut matrix = DMatrix::zeros(size, size);
    for (e, ends) in layers.windows(2).enumerate() {
        let (first, half) = (2 * e, 0.5 * (ends[1] - ends[0]));
        for (point, weight) in POINTS.iter().flat_map(|&(x, w)| [(x, w), (-x, w)]) {
            let g = 1.0 - curvature * (0.5 * (ends[0] + ends[1]) + half * point);
            let shape = quadratic(point);
            let dv = weight * half * (1.0 / g - g);
            for (i, j) in (0..3).flat_map(|i| (0..3).map(move |j| (i, j))) {
                if first + i < size && first + j < size {
                    matrix[(first + i, first + j)] += dv * shape[i] * shape[j];
                }
            }
        }
    }
    matrix
}
