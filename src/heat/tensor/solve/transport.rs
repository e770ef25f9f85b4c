//! Matrices along the streamlines for one stream velocity.

use crate::heat::tensor::mesh::streamline::Streamline;

/// Tridiagonal matrices of one stream velocity: `M̃` and `F = ρc v D̃ + k K`, with `D̃ = D + τvK`, `M̃ = M + τv Dᵀ`.
///
/// `M = ∫NN`, `D = ∫N N′`, `K = ∫N′N′` along `s`: the streamline-upwind test function `w + τ v w′` in every term
/// (Brooks & Hughes, *Comput. Methods Appl. Mech. Eng.* 32 (1982)). Row sums of `F` vanish but for the entry of the
/// stream, so that a uniform temperature is not touched by round-off: `F T` is evaluated from differences.
#[derive(Clone, Debug, Default)]
pub struct Transport {
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
        let upwind = UpwindParameter::new(speed, conductivity / heat_capacity, rate);
        for (e, &h) in line.lengths.iter().enumerate() {
            let (a, b) = (e, line.after(e));
            let sigma = upwind.of(h);
            self.upwind.push(sigma);
            let (shift, conduction) = (sigma * h, conductivity / h);
            self.mass[a] += h / 3.0 - 0.5 * shift;
            self.mass_upper[a] += h / 6.0 - 0.5 * shift;
            self.mass_lower[b] += h / 6.0 + 0.5 * shift;
            self.mass[b] += h / 3.0 + 0.5 * shift;
            self.flow_upper[a] += advection * (0.5 - sigma) - conduction;
            self.flow_lower[b] += -advection * (0.5 + sigma) - conduction;
        }
        let ends = if speed > 0.0 { (0, n - 1) } else { (n - 1, 0) };
        let open = line.closed == 0.0 && speed != 0.0;
        self.entry = open.then_some((ends.0, advection.abs()));
        self.exit = open.then_some((ends.1, advection.abs()));
    }

    /// Replaces the matrices by those of conduction alone: the tilted mass of `moving`, and `F = k K` without a stream.
    pub fn set_still(&mut self, moving: &Self, line: &Streamline, conductivity: f64) {
        self.mass_lower.clone_from(&moving.mass_lower);
        self.mass.clone_from(&moving.mass);
        self.mass_upper.clone_from(&moving.mass_upper);
        for values in [&mut self.flow_lower, &mut self.flow_upper] {
            values.clear();
            values.resize(line.len(), 0.0);
        }
        for (e, h) in line.lengths.iter().enumerate() {
            self.flow_upper[e] -= conductivity / h;
            self.flow_lower[line.after(e)] -= conductivity / h;
        }
        (self.entry, self.exit) = (None, None);
    }

    /// Row sum of `F`: heat that enters with the stream.
    pub fn entry(&self, row: usize) -> f64 {
        self.entry.map_or(0.0, |(node, value)| if node == row { value } else { 0.0 })
    }

    /// Adds the load `∫ q w̃ ds` of an element with the moments `∫ q ds` and `∫ q ξ ds`, ξ from 0 to 1.
    pub fn add_load(&self, line: &Streamline, element: usize, moments: [f64; 2], load: &mut [f64]) {
        add_tested(line, element, self.upwind[element], moments, load);
    }

    /// Adds the load of heat that is conducted through the contact in an element, where the conductance has the moments
    /// `conductance`: tested as the conduction of the fields is, so that only the temperatures of the surfaces count
    /// and not how they are split.
    pub fn add_conducted(
        &self,
        line: &Streamline,
        element: usize,
        moments: [f64; 2],
        conductance: [f64; 3],
        load: &mut [f64],
    ) {
        add_tested(line, element, upwind_within(self.upwind[element], conductance), moments, load);
    }
}

/// Adds `∫ q w̃ ds` of an element, whose test functions are tilted by `sigma`.
fn add_tested(line: &Streamline, element: usize, sigma: f64, moments: [f64; 2], load: &mut [f64]) {
    let shifted = sigma * moments[0];
    load[element] += moments[0] - moments[1] - shifted;
    load[line.after(element)] += moments[1] + shifted;
}

/// Upwinding of the test functions on an element for a conductance with the moments `∫ k_c ds` and `∫ k_c ξ ds`,
/// instead of `sigma`.
///
/// Where the contact begins or ends within the element, full upwinding would give the node upstream a share below
/// zero, and its temperature would undershoot: both shares keep the sign of the whole.
pub fn upwind_within(sigma: f64, [whole, first, _]: [f64; 3]) -> f64 {
    let centroid = first / whole;
    if centroid.is_finite() { sigma.max(-centroid).min(1.0 - centroid) } else { sigma }
}

/// `τ v / h` with `τ⁻² = [h/(2|v|)(coth Pe − 1/Pe)]⁻² + (2/Δt)²`, `Pe = |v|h/2κ`; zero at `v = 0`.
///
/// Shakib, Hughes & Johan, *Comput. Methods Appl. Mech. Eng.* 89 (1991), with the exact one-dimensional parameter.
struct UpwindParameter {
    speed: f64,
    /// `Pe/h` [1/m].
    peclet: f64,
    /// `2 rate/|v|` [1/m].
    transient: f64,
}

impl UpwindParameter {
    fn new(speed: f64, diffusivity: f64, rate: f64) -> Self {
        Self { speed, peclet: 0.5 * speed.abs() / diffusivity, transient: 2.0 * rate / speed.abs() }
    }

    /// Parameter of an element of the given length.
    fn of(&self, length: f64) -> f64 {
        let peclet = self.peclet * length;
        let magic = if peclet < 0.05 {
            peclet / 3.0 * (1.0 - peclet * peclet / 15.0)
        } else {
            // Beyond 20 the hyperbolic cotangent is 1 to the last bit.
            (if peclet < 20.0 { 1.0 / peclet.tanh() } else { 1.0 }) - 1.0 / peclet
        };
        let steady = 0.5 * magic;
        if steady == 0.0 {
            return 0.0;
        }
        // In units of h/|v|: τ = 1/√(1/steady² + (2 rate h/|v|)²).
        let transient = self.transient * length * steady;
        (steady / (1.0 + transient * transient).sqrt()).copysign(self.speed)
    }
}
