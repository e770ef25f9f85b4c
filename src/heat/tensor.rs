//! One-dimensional factors of the tensor meshes: along the streamlines and across them.
//!
//! Both bodies are described by the distance `s` along their surface (positive in travel direction, contact point at
//! zero) and the depth `z` below it. With the weight `g(z) = 1 − z/r_o` in the wheel (true polar elements) and `g = 1`
//! in the rail, the energy balance of the stream `v = −ω r_o` or `v = −V` reads
//!
//! ```text
//! ρc g (∂_t T + v ∂_s T) = k ∂_z(g ∂_z T) + k g⁻¹ ∂_s² T
//! ```
//!
//! and a tensor-product Galerkin method needs only `∫ g N N dz`, `∫ g N′N′ dz`, `∫ g⁻¹ N N dz` (quadratic) and the
//! linear elements along `s`.

use super::HeatError;
use faer::fx128 as Wide;
use nalgebra::DMatrix;

/// Sizes `first·growth^k`, at most `largest`, shrunk a little so that they fill `length`; positions from zero on.
pub(super) fn graded(first: f64, growth: f64, largest: f64, length: f64) -> Vec<f64> {
    let mut positions = vec![0.0];
    let (mut size, mut end) = (first.min(largest), 0.0);
    while end < length * (1.0 - 1e-9) {
        end += size;
        positions.push(end);
        size = (size * growth).min(largest);
    }
    let scale = length / end;
    positions.iter_mut().for_each(|p| *p *= scale);
    if let Some(last) = positions.last_mut() {
        *last = length;
    }
    positions
}

/// Linear elements along the streamlines.
///
/// Element `e` joins node `e` to node `e + 1`; on a closed streamline the last one joins the last node to the first.
#[derive(Clone, Debug)]
pub(super) struct Streamline {
    /// Node positions along the surface, ascending [m].
    pub nodes: Vec<f64>,
    /// Element lengths [m].
    pub lengths: Vec<f64>,
    /// Circumference of a closed streamline [m]; zero: open.
    pub closed: f64,
    /// `∫ Nᵢ ds` [m].
    pub weights: Vec<f64>,
    /// First node (and element) of the contact zone.
    pub zone: usize,
}

impl Streamline {
    /// Nodes of an open streamline, or of a closed one of the given circumference.
    pub fn new(nodes: Vec<f64>, closed: f64) -> Self {
        let mut lengths: Vec<f64> = nodes.windows(2).map(|w| w[1] - w[0]).collect();
        if closed > 0.0
            && let (Some(first), Some(last)) = (nodes.first(), nodes.last())
        {
            lengths.push(first + closed - last);
        }
        let n = nodes.len();
        let mut weights = vec![0.0; n];
        for (e, h) in lengths.iter().enumerate() {
            weights[e] += 0.5 * h;
            weights[(e + 1) % n] += 0.5 * h;
        }
        Self { nodes, lengths, closed, weights, zone: 0 }
    }

    /// Nodes `zone` (from zero on) and growing elements beyond to the distance `half`, mirrored.
    ///
    /// On a closed streamline the two far ends are the same node, which comes last.
    pub fn around_contact(zone: &[f64], half: f64, growth: f64, largest: f64, closed: bool) -> Self {
        let (reach, cells) = (zone.last().copied().unwrap_or(0.0), zone.len().saturating_sub(1));
        let spacing = if cells > 0 { reach - zone[cells - 1] } else { largest };
        let mut side = zone.to_vec();
        side.extend(graded(spacing * growth, growth, largest, half - reach).iter().skip(1).map(|s| reach + s));
        let skipped = usize::from(closed);
        let mut nodes: Vec<f64> = side.iter().rev().skip(skipped).map(|s| -s).collect();
        nodes.pop();
        let first = nodes.len().saturating_sub(cells);
        nodes.extend(&side);
        Self { zone: first, ..Self::new(nodes, if closed { 2.0 * half } else { 0.0 }) }
    }

    pub fn len(&self) -> usize {
        self.nodes.len()
    }

    /// Node after an element's first one.
    pub fn after(&self, element: usize) -> usize {
        (element + 1) % self.len()
    }
}

/// Tridiagonal matrices of one stream velocity: `M̃` and `F = ρc v D̃ + k K`, with `D̃ = D + τvK`, `M̃ = M + τv Dᵀ`.
///
/// `M = ∫NN`, `D = ∫N N′`, `K = ∫N′N′` along `s`: the streamline-upwind test function `w + τ v w′` in every term
/// (Brooks & Hughes, *Comput. Methods Appl. Mech. Eng.* 32 (1982)). Row sums of `F` vanish but for the entry of the
/// stream, so that a uniform temperature is not touched by round-off: `F T` is evaluated from differences.
#[derive(Clone, Debug, Default)]
pub(super) struct Transport {
    pub mass_lower: Vec<f64>,
    pub mass: Vec<f64>,
    pub mass_upper: Vec<f64>,
    pub flow_lower: Vec<f64>,
    pub flow_upper: Vec<f64>,
    /// Node where cold material enters and `ρc|v|` there (Danckwerts' condition: the flux enters, not the temperature).
    pub entry: Option<(usize, f64)>,
    /// Node where material leaves and `ρc|v|` there.
    pub exit: Option<(usize, f64)>,
    /// `τ v / h` per element [1].
    pub upwind: Vec<f64>,
}

impl Transport {
    /// Matrices for the stream velocity `speed` [m/s] and a step whose implicit coefficient is `1/rate` [s].
    pub fn set(&mut self, line: &Streamline, speed: f64, rate: f64, heat_capacity: f64, conductivity: f64) {
        let n = line.len();
        for values in
            [&mut self.mass_lower, &mut self.mass, &mut self.mass_upper, &mut self.flow_lower, &mut self.flow_upper]
        {
            values.clear();
            values.resize(n, 0.0);
        }
        self.upwind.clear();
        let advection = heat_capacity * speed;
        for (e, &h) in line.lengths.iter().enumerate() {
            let (a, b) = (e, line.after(e));
            let sigma = upwind(speed, h, conductivity / heat_capacity, rate);
            self.upwind.push(sigma);
            let shift = sigma * h;
            self.mass[a] += h / 3.0 - 0.5 * shift;
            self.mass_upper[a] += h / 6.0 - 0.5 * shift;
            self.mass_lower[b] += h / 6.0 + 0.5 * shift;
            self.mass[b] += h / 3.0 + 0.5 * shift;
            self.flow_upper[a] += advection * (0.5 - sigma) - conductivity / h;
            self.flow_lower[b] += -advection * (0.5 + sigma) - conductivity / h;
        }
        let ends = if speed > 0.0 { (0, n - 1) } else { (n - 1, 0) };
        let open = line.closed == 0.0 && speed != 0.0;
        self.entry = open.then_some((ends.0, advection.abs()));
        self.exit = open.then_some((ends.1, advection.abs()));
    }

    /// Row sum of `F`: what enters with the stream.
    pub fn entry(&self, row: usize) -> f64 {
        self.entry.map_or(0.0, |(node, value)| if node == row { value } else { 0.0 })
    }

    /// Adds the load `∫ q w̃ ds` of an element with the moments `∫ q ds` and `∫ q ξ ds`, ξ from 0 to 1.
    pub fn add_load(&self, line: &Streamline, element: usize, moments: [f64; 2], load: &mut [f64]) {
        let shifted = self.upwind[element] * moments[0];
        load[element] += moments[0] - moments[1] - shifted;
        load[line.after(element)] += moments[1] + shifted;
    }

    /// Upwinding of the test functions for a conductance with the moments `∫ k_c ds` and `∫ k_c ξ ds` on an element.
    ///
    /// Where the contact begins or ends within the element, full upwinding would give the node upstream a share below
    /// zero, and its temperature would undershoot: both shares keep the sign of the whole.
    pub fn upwind_of(&self, element: usize, [whole, first]: [f64; 2]) -> f64 {
        let sigma = self.upwind[element];
        let centroid = first / whole;
        if centroid.is_finite() { sigma.max(-centroid).min(1.0 - centroid) } else { sigma }
    }
}

/// `τ v / h` with `τ⁻² = [h/(2|v|)(coth Pe − 1/Pe)]⁻² + (2/Δt)²`, `Pe = |v|h/2κ`; zero at `v = 0`.
///
/// Shakib, Hughes & Johan, *Comput. Methods Appl. Mech. Eng.* 89 (1991), with the exact one-dimensional parameter.
fn upwind(speed: f64, length: f64, diffusivity: f64, rate: f64) -> f64 {
    let peclet = 0.5 * speed.abs() * length / diffusivity;
    let magic =
        if peclet < 0.05 { peclet / 3.0 * (1.0 - peclet * peclet / 15.0) } else { 1.0 / peclet.tanh() - 1.0 / peclet };
    let steady = 0.5 * magic;
    if steady == 0.0 {
        return 0.0;
    }
    // In units of h/|v|: τ = 1/√(1/steady² + (2 rate h/|v|)²).
    let transient = 2.0 * rate * length / speed.abs() * steady;
    (steady / 1.0_f64.hypot(transient)).copysign(speed)
}

/// Eigenpairs of the direction across the streamlines.
///
/// `∫ g φₘ′φₙ′ + (α/k) φₘ(0) φₙ(0) = λₘ δₘₙ`, `∫ g φₘ φₙ = δₘₙ`, α the coefficient of convection to the air. The
/// eigenvalues span twelve decades (boundary layers of micrometres in bodies of decimetres), and heat balances sum over
/// all of them: the pencil is solved in double-double precision.
#[derive(Clone, Debug)]
pub(super) struct Modes {
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

impl Modes {
    /// Quadratic elements between `layers` (depths from zero on) under the weight `1 − curvature z`.
    pub fn new(layers: &[f64], curvature: f64, fixed: bool, film: f64) -> Result<Self, HeatError> {
        let n = 2 * layers.len() - 1;
        let size = if fixed { n - 1 } else { n };
        let (mut mass, mut stiffness) = (vec![Wide::ZERO; n * n], vec![Wide::ZERO; n * n]);
        let mut inverse_weight = DMatrix::zeros(size, size);
        for (e, ends) in layers.windows(2).enumerate() {
            let (a, b) = (Wide::from_f64(ends[0]), Wide::from_f64(ends[1]));
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
            add_inverse_weight(&mut inverse_weight, 2 * e, ends, curvature);
        }
        stiffness[0] += wide(film);
        let mut reduced = reduce(&mass, &stiffness, n, size).ok_or(HeatError::Eigen { size })?;
        let rotation = jacobi(&mut reduced.matrix, size).ok_or(HeatError::Eigen { size })?;
        let mut order: Vec<usize> = (0..size).collect();
        order.sort_by(|&i, &j| reduced.matrix[i * size + i].0.total_cmp(&reduced.matrix[j * size + j].0));
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
        let shapes = reduced.shapes(&rotation, size);
        for (m, &column) in order.iter().enumerate() {
            let shape = |i: usize| shapes[i * size + column];
            let sign = if shape(0).0 < 0.0 { wide(-1.0) } else { wide(1.0) };
            let product = |rows: usize| {
                let mut sum = Wide::ZERO;
                for i in 0..rows {
                    for j in 0..size {
                        sum += mass[i * n + j] * shape(j);
                    }
                }
                narrow(sum * sign)
            };
            modes.values[m] = narrow(reduced.matrix[column * size + column]).max(0.0);
            modes.surface[m] = narrow(shape(0) * sign);
            (modes.free[m], modes.content[m]) = (product(size), product(n));
            for i in 0..size {
                modes.shapes[(i, m)] = narrow(shape(i) * sign);
            }
        }
        if !fixed && film == 0.0 {
            modes.values[0] = 0.0;
        }
        let last = modes.values[size - 1];
        modes.values[size..].fill(last);
        if curvature != 0.0 {
            modes.curvature = modes.shapes.transpose() * inverse_weight * &modes.shapes;
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

/// Adds `∫ (1/g − g) N N dz` of one element by Gauss quadrature (8 points).
fn add_inverse_weight(matrix: &mut DMatrix<f64>, first: usize, ends: &[f64], curvature: f64) {
    const POINTS: [(f64, f64); 4] = [
        (0.183_434_642_495_649_8, 0.362_683_783_378_362),
        (0.525_532_409_916_329, 0.313_706_645_877_887_3),
        (0.796_666_477_413_626_7, 0.222_381_034_453_374_48),
        (0.960_289_856_497_536_3, 0.101_228_536_290_376_26),
    ];
    let half = 0.5 * (ends[1] - ends[0]);
    for (point, weight) in POINTS.iter().flat_map(|&(x, w)| [(x, w), (-x, w)]) {
        let g = 1.0 - curvature * (0.5 * (ends[0] + ends[1]) + half * point);
        let shape = quadratic(point);
        let dv = weight * half * (1.0 / g - g);
        for i in 0..3 {
            for j in 0..3 {
                if first + i < matrix.nrows() && first + j < matrix.nrows() {
                    matrix[(first + i, first + j)] += dv * shape[i] * shape[j];
                }
            }
        }
    }
}

fn wide(value: f64) -> Wide {
    Wide::from_f64(value)
}

fn narrow(value: Wide) -> f64 {
    value.0 + value.1
}

/// `L⁻¹ K L⁻ᵀ` and the Cholesky factor `M = L Lᵀ`, row-major.
struct Reduced {
    factor: Vec<Wide>,
    matrix: Vec<Wide>,
}

/// Leading block of `size` rows of a pencil of `n` rows; `None` if the mass is not positive definite.
fn reduce(mass: &[Wide], stiffness: &[Wide], n: usize, size: usize) -> Option<Reduced> {
    let mut factor = vec![Wide::ZERO; size * size];
    for i in 0..size {
        for j in 0..=i {
            let mut sum = mass[i * n + j];
            for l in 0..j {
                sum -= factor[i * size + l] * factor[j * size + l];
            }
            if i == j {
                if sum.0.is_nan() || sum.0 <= 0.0 {
                    return None;
                }
                factor[i * size + i] = sum.sqrt();
            } else {
                factor[i * size + j] = sum / factor[j * size + j];
            }
        }
    }
    let mut matrix: Vec<Wide> = (0..size * size).map(|at| stiffness[at / size * n + at % size]).collect();
    // L⁻¹ K, then the same on the transposed result.
    for _ in 0..2 {
        for column in 0..size {
            for i in 0..size {
                let mut sum = matrix[i * size + column];
                for l in 0..i {
                    sum -= factor[i * size + l] * matrix[l * size + column];
                }
                matrix[i * size + column] = sum / factor[i * size + i];
            }
        }
        for i in 0..size {
            for j in 0..i {
                matrix.swap(i * size + j, j * size + i);
            }
        }
    }
    Some(Reduced { factor, matrix })
}

impl Reduced {
    /// `L⁻ᵀ V`.
    fn shapes(&self, rotation: &[Wide], size: usize) -> Vec<Wide> {
        let mut shapes = rotation.to_vec();
        for column in 0..size {
            for i in (0..size).rev() {
                let mut sum = shapes[i * size + column];
                for l in i + 1..size {
                    sum -= self.factor[l * size + i] * shapes[l * size + column];
                }
                shapes[i * size + column] = sum / self.factor[i * size + i];
            }
        }
        shapes
    }
}

/// Cyclic Jacobi iteration (Golub & Van Loan, *Matrix Computations*, 4th ed., 8.5): leaves the eigenvalues on the
/// diagonal of `a` and returns the eigenvectors as columns; `None` without convergence.
fn jacobi(a: &mut [Wide], n: usize) -> Option<Vec<Wide>> {
    const SWEEPS: usize = 60;
    let mut v = vec![Wide::ZERO; n * n];
    for i in 0..n {
        v[i * n + i] = Wide::ONE;
    }
    // Entries at the round-off of the matrix are zero, whatever the diagonal (eigenvalue zero of an insulated body).
    let floor = 1e-31 * (0..n).map(|i| a[i * n + i].0).fold(0.0, f64::max);
    for _ in 0..SWEEPS {
        let mut largest: f64 = 0.0;
        for p in 0..n {
            for q in p + 1..n {
                let (app, aqq, apq) = (a[p * n + p], a[q * n + q], a[p * n + q]);
                let scale = (app.0.abs() * aqq.0.abs()).sqrt();
                if apq.0.abs() <= floor.max(1e-28 * scale) {
                    continue;
                }
                let relative = apq.0.abs() / scale.max(floor);
                largest = largest.max(relative);
                let theta = (aqq - app) / (wide(2.0) * apq);
                let root = (theta * theta + Wide::ONE).sqrt();
                let t = if theta.0 >= 0.0 { Wide::ONE / (theta + root) } else { Wide::ONE / (theta - root) };
                let c = Wide::ONE / (t * t + Wide::ONE).sqrt();
                let s = t * c;
                for l in 0..n {
                    let (x, y) = (a[l * n + p], a[l * n + q]);
                    (a[l * n + p], a[l * n + q]) = (c * x - s * y, s * x + c * y);
                }
                for l in 0..n {
                    let (x, y) = (a[p * n + l], a[q * n + l]);
                    (a[p * n + l], a[q * n + l]) = (c * x - s * y, s * x + c * y);
                    let (x, y) = (v[l * n + p], v[l * n + q]);
                    (v[l * n + p], v[l * n + q]) = (c * x - s * y, s * x + c * y);
                }
                (a[p * n + q], a[q * n + p]) = (Wide::ZERO, Wide::ZERO);
            }
        }
        if largest.is_nan() {
            return None;
        }
        if largest < 1e-20 {
            return Some(v);
        }
    }
    None
}
