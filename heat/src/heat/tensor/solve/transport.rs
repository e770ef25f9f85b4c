//! Matrices along the streamlines for one stream velocity.

use crate::heat::tensor::mesh::streamline::Streamline;
use crate::linalg::vectorised::vectorised;

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
    /// Row by row the lower band of `M̃`, the sum of its row and its upper band; the lower and the upper band of `F`, among
    /// them the stream's entry: the link of an end with a node beyond it at zero.
    pub rows: Vec<[f64; 5]>,
    /// True on a closed streamline.
    pub closed: bool,
}

impl Transport {
    /// Matrices for the stream velocity `speed` [m/s] and a step whose implicit coefficient is `1/rate` [s].
    pub fn set(&mut self, streamline: &Streamline, speed: f64, rate: f64, heat_capacity: f64, conductivity: f64) {
        let (n, elements) = (streamline.len(), streamline.lengths.len());
        let Self { mass_lower, mass, mass_upper, flow_lower, flow_upper, upwind, .. } = self;
        for values in [&mut *mass_lower, mass, mass_upper, flow_lower, flow_upper] {
            values.resize(n, 0.0);
        }
        let advection = heat_capacity * speed;
        UpwindParameter::new(speed, conductivity / heat_capacity, rate).fill(streamline, upwind);
        let weights = [advection, conductivity];
        let rows = [&mut mass[..elements], &mut mass_upper[..elements], &mut flow_upper[..elements]];
        set_first_nodes(&streamline.lengths, upwind, weights, rows);
        // On an open streamline no element follows the last node, and none comes before the first one.
        for values in [&mut *mass, mass_upper, flow_upper] {
            values[elements..].fill(0.0);
        }
        (mass_lower[0], flow_lower[0]) = (0.0, 0.0);
        let [(before, closing), (sigma, closing_sigma)] =
            [&streamline.lengths, &*upwind].map(|values| values.split_at(n - 1));
        let rows = [&mut mass[1..], &mut mass_lower[1..], &mut flow_lower[1..]];
        add_second_nodes(before, sigma, weights, rows);
        let rows = [&mut mass[..1], &mut mass_lower[..1], &mut flow_lower[..1]];
        add_second_nodes(closing, closing_sigma, weights, rows);
        let ends = if speed > 0.0 { (0, n - 1) } else { (n - 1, 0) };
        let open = streamline.closed == 0.0 && speed != 0.0;
        self.entry = open.then_some((ends.0, advection.abs()));
        self.exit = open.then_some((ends.1, advection.abs()));
        self.closed = streamline.closed > 0.0;
        self.set_rows();
    }

    /// Fills [`Self::rows`].
    fn set_rows(&mut self) {
        let Self { mass_lower, mass, mass_upper, flow_lower, flow_upper, rows, .. } = self;
        let masses = mass_lower.iter().zip(&*mass).zip(&*mass_upper);
        rows.clear();
        rows.extend(
            masses
                .zip(flow_lower.iter().zip(&*flow_upper))
                .map(|(((&below, middle), &above), (&from, &to))| [below, below + middle + above, above, from, to]),
        );
        if let Some((node, stream)) = self.entry {
            rows[node][if node == 0 { 3 } else { 4 }] -= stream;
        }
    }

    /// Replaces the matrices by those of conduction alone: the tilted mass of `moving`, and `F = k K` without a stream.
    pub fn set_still(&mut self, moving: &Self, streamline: &Streamline, conductivity: f64) {
        self.mass_lower.clone_from(&moving.mass_lower);
        self.mass.clone_from(&moving.mass);
        self.mass_upper.clone_from(&moving.mass_upper);
        for values in [&mut self.flow_lower, &mut self.flow_upper] {
            values.clear();
            values.resize(streamline.len(), 0.0);
        }
        for (e, h) in streamline.lengths.iter().enumerate() {
            self.flow_upper[e] -= conductivity / h;
            self.flow_lower[streamline.after(e)] -= conductivity / h;
        }
        (self.entry, self.exit, self.closed) = (None, None, moving.closed);
        self.set_rows();
    }

    /// Row sum of `F`: heat that enters with the stream.
    pub fn entry(&self, row: usize) -> f64 {
        self.entry.map_or(0.0, |(node, value)| if node == row { value } else { 0.0 })
    }

    /// Adds the load `∫ q w̃ ds` of an element with the moments `∫ q ds` and `∫ q ξ ds`, ξ from 0 to 1.
    pub fn add_load(&self, streamline: &Streamline, element: usize, moments: [f64; 2], load: &mut [f64]) {
        add_tested(streamline, element, self.upwind[element], moments, load);
    }

    /// Adds the load of heat that is conducted through the contact in an element, where the conductance has the moments
    /// `conductance`: tested as the conduction of the fields is, so that only the temperatures of the surfaces count
    /// and not how they are split.
    pub fn add_conducted(
        &self,
        streamline: &Streamline,
        element: usize,
        moments: [f64; 2],
        conductance: [f64; 3],
        load: &mut [f64],
    ) {
        add_tested(streamline, element, upwind_within(self.upwind[element], conductance), moments, load);
    }
}

/// Elements that bear a load, with its moments: most of a surface bears none.
pub fn bearing(moments: &[[f64; 2]]) -> impl Iterator<Item = (usize, [f64; 2])> {
    moments.iter().copied().enumerate().filter(|(_, q)| *q != [0.0; 2])
}

vectorised! {
    /// Replaces the rows of the first node of every element by what the element adds to them: diagonal and upper band
    /// of `M̃`, upper band of `F`; the weights are `ρc v` and the conductivity.
    fn set_first_nodes<'a, S>(
        simd,
        lengths: &'a [f64],
        upwind: &'a [f64],
        weights: [f64; 2],
        rows: [&'a mut [f64]; 3],
    ) {
        let (_, [advection, conductivity], [mass, mass_upper, flow_upper]) = (simd, weights, rows);
        let elements = lengths.iter().zip(upwind).zip(mass).zip(mass_upper).zip(flow_upper);
        for ((((&h, &sigma), mass), mass_upper), flow_upper) in elements {
            let shift = 0.5 * sigma * h;
            *mass = h / 3.0 - shift;
            *mass_upper = h / 6.0 - shift;
            *flow_upper = advection * (0.5 - sigma) - conductivity / h;
        }
    }
}

vectorised! {
    /// Adds what every element adds to the row of its second node: diagonal and lower band of `M̃`, lower band of `F`.
    fn add_second_nodes<'a, S>(
        simd,
        lengths: &'a [f64],
        upwind: &'a [f64],
        weights: [f64; 2],
        rows: [&'a mut [f64]; 3],
    ) {
        let (_, [advection, conductivity], [mass, mass_lower, flow_lower]) = (simd, weights, rows);
        let elements = lengths.iter().zip(upwind).zip(mass).zip(mass_lower).zip(flow_lower);
        for ((((&h, &sigma), mass), mass_lower), flow_lower) in elements {
            let shift = 0.5 * sigma * h;
            *mass += h / 3.0 + shift;
            *mass_lower = h / 6.0 + shift;
            *flow_lower = -advection * (0.5 + sigma) - conductivity / h;
        }
    }
}

/// Adds `∫ q w̃ ds` of an element, whose test functions are tilted by `sigma`.
fn add_tested(streamline: &Streamline, element: usize, sigma: f64, moments: [f64; 2], load: &mut [f64]) {
    let shifted = sigma * moments[0];
    load[element] += moments[0] - moments[1] - shifted;
    load[streamline.after(element)] += moments[1] + shifted;
}

/// Distance of the centroid of a conductance from the middle of its element that is round-off \[1].
const ROUND_OFF: f64 = 1e-12;

/// Upwinding of the test functions on an element for a conductance with the moments `∫ k_c ds` and `∫ k_c ξ ds`,
/// instead of `sigma`.
///
/// Where the contact begins or ends within the element, full upwinding would give the node upstream a share below
/// zero, and its temperature would undershoot: both shares keep the sign of the whole.
pub fn upwind_within(sigma: f64, [whole, first, _]: [f64; 3]) -> f64 {
    // Where all of the element is in contact, nothing is changed.
    if (first - 0.5 * whole).abs() <= ROUND_OFF * whole {
        return sigma;
    }
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

    /// Replaces `out` by the parameters of the elements of `streamline`.
    fn fill(&self, streamline: &Streamline, out: &mut Vec<f64>) {
        out.resize(streamline.lengths.len(), 0.0);
        if self.peclet * streamline.shortest >= SATURATED {
            set_upwind(&streamline.lengths, self.peclet, self.transient, self.speed, out);
        } else {
            out.iter_mut().zip(&streamline.lengths).for_each(|(out, &h)| *out = self.of(h));
        }
    }

    /// Parameter of an element of the given length.
    fn of(&self, length: f64) -> f64 {
        let peclet = self.peclet * length;
        let magic = if peclet < 0.05 {
            peclet / 3.0 * (1.0 - peclet * peclet / 15.0)
        } else {
            (if peclet < SATURATED { 1.0 / libm::tanh(peclet) } else { 1.0 }) - 1.0 / peclet
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

/// Péclet number from which on the hyperbolic cotangent is 1 to the last bit.
const SATURATED: f64 = 20.0;

vectorised! {
    /// Parameters of elements whose Péclet numbers, `peclet` times their lengths, are saturated.
    fn set_upwind<'a, S>(
        simd,
        lengths: &'a [f64],
        peclet: f64,
        transient: f64,
        speed: f64,
        out: &'a mut [f64],
    ) {
        let _ = simd;
        for (out, &h) in out.iter_mut().zip(lengths) {
            let steady = 0.5 * (1.0 - 1.0 / (peclet * h));
            let transient = transient * h * steady;
            *out = (steady / (1.0 + transient * transient).sqrt()).copysign(speed);
        }
    }
}
