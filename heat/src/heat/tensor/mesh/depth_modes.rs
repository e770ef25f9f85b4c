//! Factor of the tensor meshes across the streamlines: eigenmodes over the depth.

use super::section::Section;
use crate::heat::error::HeatError;
use crate::linalg::pencil::{Wide, WideModes, narrow, wide, wide_modes};
use nalgebra::DMatrix;

/// Eigenpairs of the direction across the streamlines.
///
/// `∫ G φₘ′φₙ′ + (α/k) (φₘ(0) φₙ(0) + ∫ b φₘ φₙ) = λₘ δₘₙ`, `∫ G φₘ φₙ = δₘₙ`. The weight `G = g w/w₀` is that of the
/// polar element times the width of the section over that of the contact, α the coefficient of convection to the air,
/// `b` the bare surface beside the contact. The eigenvalues span twelve decades (boundary layers of micrometres in
/// bodies of decimetres), and heat balances sum over all of them: the pencil is solved in double-double precision.
#[derive(Clone, Debug)]
pub struct DepthModes {
    /// Eigenvalues `λ` [1/m²], ascending.
    pub values: Vec<f64>,
    /// Value of each mode at the surface.
    pub surface: Vec<f64>,
    /// Share of each node in the surface that touches the air, over the width of the contact.
    pub exposed: Vec<f64>,
    /// Value of each mode summed over that surface, `φₘ(0) + ∫ b φₘ dz`.
    pub air: Vec<f64>,
    /// Mean of each mode over the width of a brake block, on whose way in heat spreads.
    pub block: Vec<f64>,
    /// `∫ G φₘ ψ dz` with ψ the interpolant that is 1 at all free nodes.
    pub free: Vec<f64>,
    /// `∫ G φₘ dz`.
    pub content: Vec<f64>,
    /// `∫ G dz`: the section over the width of the contact [m].
    pub section: f64,
    /// Nodal values, one mode per column; a fixed last node is left out.
    pub shapes: DMatrix<f64>,
    /// `∫ (1/g − g) w/w₀ φₘ φₙ dz`: part that the replacement of `1/g` by `g` neglects; empty for a straight body.
    pub curvature: DMatrix<f64>,
    /// Depth of the nodes [m].
    pub depths: Vec<f64>,
    /// Half the thickness of each layer times the coefficients of `G` as a polynomial of the place in it, from −1 to 1
    /// [m].
    pub weights: Vec<[f64; 3]>,
    /// True where the last node is held at the reference temperature.
    pub fixed: bool,
}

/// Modes are padded to a multiple of this number with empty ones, so that inner loops run on full registers. Wider ones
/// than those of four numbers need a multiple of theirs: the loops over rows leave out a rest that does not fill a
/// register.
pub const PADDING: usize = 4;

impl DepthModes {
    /// Quadratic elements on the layers of a section, `g = 1 − curvature z`; `fixed` holds the last node, `biot` is
    /// `α/k` [1/m].
    pub fn new(section: &Section, curvature: f64, fixed: bool, biot: f64) -> Result<Self, HeatError> {
        let layers = &section.layers;
        let n = 2 * layers.len() - 1;
        let size = if fixed { n - 1 } else { n };
        let (mass, mut stiffness) = matrices(section, curvature);
        add_convection(section, biot, &mut stiffness);
        let leading = |matrix: &[Wide]| -> Vec<Wide> {
            matrix.chunks_exact(n).take(size).flat_map(|row| &row[..size]).copied().collect()
        };
        let WideModes { values, shapes } =
            wide_modes(&leading(&mass), &leading(&stiffness), size).map_err(|_| HeatError::Eigen { size })?;
        let padded = size.div_ceil(PADDING) * PADDING;
        let mut modes = Self {
            values: vec![0.0; padded],
            surface: vec![0.0; padded],
            exposed: exposed(section),
            air: Vec::new(),
            block: Vec::new(),
            free: vec![0.0; padded],
            content: vec![0.0; padded],
            section: narrow(mass.iter().fold(Wide::ZERO, |sum, &entry| sum + entry)),
            shapes: DMatrix::zeros(size, padded),
            curvature: DMatrix::zeros(0, 0),
            depths: layers.windows(2).flat_map(|w| [w[0], 0.5 * (w[0] + w[1])]).chain(layers.last().copied()).collect(),
            weights: weights(section, curvature).iter().map(|weight| weight.map(narrow)).collect(),
            fixed,
        };
        let [of_free, of_all] = [size, n].map(|rows| column_sums(&mass[..rows * n], n));
        for m in 0..size {
            // Positive at the surface, so that the result is reproducible.
            let sign = if shapes[m].0 < 0.0 { wide(-1.0) } else { wide(1.0) };
            let product = |sums: &[Wide]| {
                let entries = sums.iter().take(size).enumerate();
                narrow(entries.fold(Wide::ZERO, |sum, (j, by)| sum + *by * shapes[j * size + m]) * sign)
            };
            modes.values[m] = narrow(values[m]).max(0.0);
            modes.surface[m] = narrow(shapes[m] * sign);
            (modes.free[m], modes.content[m]) = (product(&of_free), product(&of_all));
            for i in 0..size {
                modes.shapes[(i, m)] = narrow(shapes[i * size + m] * sign);
            }
        }
        if !fixed && biot == 0.0 {
            modes.values[0] = 0.0;
        }
        let last = modes.values[size - 1];
        modes.values[size..].fill(last);
        if curvature != 0.0 {
            modes.curvature = modes.shapes.transpose() * inverse_weight(section, size, curvature) * &modes.shapes;
        }
        modes.air = modes.shapes.row_iter().zip(&modes.exposed).fold(vec![0.0; padded], |mut air, (row, exposed)| {
            air.iter_mut().zip(row.iter()).for_each(|(air, shape)| *air += exposed * shape);
            air
        });
        modes.block = modes.under_block(section);
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

    /// Mean of every mode over the block: heat that enters beside the contact's strip joins where heat has spread that
    /// far.
    fn under_block(&self, section: &Section) -> Vec<f64> {
        let mut sums = self.surface.clone();
        let mut covered = 1.0;
        for (layer, [from, to]) in section.layers.windows(2).zip(&section.widths) {
            let widening = to.min(section.block) - covered;
            if widening <= 0.0 || to <= from {
                break;
            }
            let height = (layer[1] - layer[0]) * widening / (to - from);
            self.add_integral([layer[0], layer[0] + height], widening / height, &mut sums);
            covered += widening;
        }
        sums.iter_mut().for_each(|sum| *sum /= covered);
        sums
    }

    /// Adds `factor` times the integral of every mode over an interval within one layer.
    fn add_integral(&self, [from, to]: [f64; 2], factor: f64, sums: &mut [f64]) {
        for (z, share) in [(from, 1.0), (0.5 * (from + to), 4.0), (to, 1.0)] {
            for (sum, mode) in sums.iter_mut().zip(self.at(z)) {
                *sum += factor * share / 6.0 * (to - from) * mode;
            }
        }
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

/// Sums over rows of `width` numbers, by column.
fn column_sums(rows: &[Wide], width: usize) -> Vec<Wide> {
    rows.chunks_exact(width).fold(vec![Wide::ZERO; width], |mut sums, row| {
        sums.iter_mut().zip(row).for_each(|(sum, entry)| *sum += *entry);
        sums
    })
}

/// `∫ G N N dz` and `∫ G N′N′ dz`, row-major, of quadratic elements; `G` is the product of two linear functions.
fn matrices(section: &Section, curvature: f64) -> (Vec<Wide>, Vec<Wide>) {
    let n = 2 * section.layers.len() - 1;
    let (mut mass, mut stiffness) = (vec![Wide::ZERO; n * n], vec![Wide::ZERO; n * n]);
    for (e, (ends, weight)) in section.layers.windows(2).zip(weights(section, curvature)).enumerate() {
        let half = wide(0.5) * (wide(ends[1]) - wide(ends[0]));
        let [middle, slope, square] = weight;
        for i in 0..3 {
            for j in 0..3 {
                let at = (2 * e + i) * n + 2 * e + j;
                mass[at] += (middle * wide(MASS[i][j]) + slope * wide(MASS_SLOPE[i][j])) / wide(15.0);
                mass[at] += square * wide(MASS_SQUARE[i][j]) / wide(105.0);
                let rigid = middle * wide(STIFFNESS[i][j]) + slope * wide(STIFFNESS_SLOPE[i][j]);
                stiffness[at] += rigid / (wide(6.0) * half * half);
                stiffness[at] += square * wide(STIFFNESS_SQUARE[i][j]) / (wide(30.0) * half * half);
            }
        }
    }
    (mass, stiffness)
}

/// Half the thickness of each layer times the coefficients of `G`, the product of two linear functions.
fn weights(section: &Section, curvature: f64) -> Vec<[Wide; 3]> {
    let layers = section.layers.windows(2).zip(&section.widths);
    let weight = |(ends, widths): (&[f64], &[f64; 2])| {
        let (a, b) = (wide(ends[0]), wide(ends[1]));
        let half = wide(0.5) * (b - a);
        let polar = [wide(1.0) - wide(0.5) * (a + b) * wide(curvature), -(wide(curvature) * half)];
        let [from, to] = widths.map(wide);
        let width = [wide(0.5) * (from + to), wide(0.5) * (to - from)];
        let slope = polar[0] * width[1] + polar[1] * width[0];
        [polar[0] * width[0], slope, polar[1] * width[1]].map(|coefficient| half * coefficient)
    };
    layers.map(weight).collect()
}

/// Strip of the contact at the first node, and `∫ b N dz`.
fn exposed(section: &Section) -> Vec<f64> {
    let mut nodes = vec![0.0; 2 * section.layers.len() - 1];
    nodes[0] = 1.0;
    for (e, (ends, bare)) in section.layers.windows(2).zip(&section.bare).enumerate() {
        let part = bare * (ends[1] - ends[0]) / 6.0;
        nodes[2 * e..2 * e + 3].iter_mut().zip([1.0, 4.0, 1.0]).for_each(|(node, share)| *node += share * part);
    }
    nodes
}

/// Adds the convection of the contact's strip and of the bare surface beside the layers.
fn add_convection(section: &Section, biot: f64, stiffness: &mut [Wide]) {
    let n = 2 * section.layers.len() - 1;
    stiffness[0] += wide(biot);
    for (e, (ends, &bare)) in section.layers.windows(2).zip(&section.bare).enumerate() {
        let factor = wide(0.5) * (wide(ends[1]) - wide(ends[0])) * wide(bare) * wide(biot) / wide(15.0);
        for (i, j) in (0..3).flat_map(|i| (0..3).map(move |j| (i, j))) {
            stiffness[(2 * e + i) * n + 2 * e + j] += factor * wide(MASS[i][j]);
        }
    }
}

/// `15 ∫ N N dξ` of the quadratic element on (−1, 1).
const MASS: [[f64; 3]; 3] = [[4.0, 2.0, -1.0], [2.0, 16.0, 2.0], [-1.0, 2.0, 4.0]];
/// `15 ∫ ξ N N dξ`.
const MASS_SLOPE: [[f64; 3]; 3] = [[-3.0, -2.0, 0.0], [-2.0, 0.0, 2.0], [0.0, 2.0, 3.0]];
/// `105 ∫ ξ² N N dξ`.
const MASS_SQUARE: [[f64; 3]; 3] = [[18.0, 6.0, -3.0], [6.0, 16.0, 6.0], [-3.0, 6.0, 18.0]];
/// `6 ∫ N′N′ dξ`.
const STIFFNESS: [[f64; 3]; 3] = [[7.0, -8.0, 1.0], [-8.0, 16.0, -8.0], [1.0, -8.0, 7.0]];
/// `6 ∫ ξ N′N′ dξ`.
const STIFFNESS_SLOPE: [[f64; 3]; 3] = [[-4.0, 4.0, 0.0], [4.0, 0.0, -4.0], [0.0, -4.0, 4.0]];
/// `30 ∫ ξ² N′N′ dξ`.
const STIFFNESS_SQUARE: [[f64; 3]; 3] = [[17.0, -24.0, 7.0], [-24.0, 48.0, -24.0], [7.0, -24.0, 17.0]];

/// Quadratic shape functions of the three nodes of a layer at the place `xi` from −1 to 1.
pub fn quadratic(xi: f64) -> [f64; 3] {
    [0.5 * xi * (xi - 1.0), 1.0 - xi * xi, 0.5 * xi * (xi + 1.0)]
}

/// `∫ (1/g − g) w/w₀ N N dz` over all layers by Gauss quadrature (8 points), for the first `size` nodes.
fn inverse_weight(section: &Section, size: usize, curvature: f64) -> DMatrix<f64> {
    const POINTS: [(f64, f64); 4] = [
        (0.183_434_642_495_649_8, 0.362_683_783_378_362),
        (0.525_532_409_916_329, 0.313_706_645_877_887_3),
        (0.796_666_477_413_626_7, 0.222_381_034_453_374_48),
        (0.960_289_856_497_536_3, 0.101_228_536_290_376_26),
    ];
    let mut matrix = DMatrix::zeros(size, size);
    for (e, (ends, [from, to])) in section.layers.windows(2).zip(&section.widths).enumerate() {
        let (first, half) = (2 * e, 0.5 * (ends[1] - ends[0]));
        for (point, weight) in POINTS.iter().flat_map(|&(x, w)| [(x, w), (-x, w)]) {
            let g = 1.0 - curvature * (0.5 * (ends[0] + ends[1]) + half * point);
            let shape = quadratic(point);
            let width = 0.5 * (from + to) + 0.5 * (to - from) * point;
            let dv = weight * half * width * (1.0 / g - g);
            for (i, j) in (0..3).flat_map(|i| (0..3).map(move |j| (i, j))) {
                if first + i < size && first + j < size {
                    matrix[(first + i, first + j)] += dv * shape[i] * shape[j];
                }
            }
        }
    }
    matrix
}
