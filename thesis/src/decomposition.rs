//! Matrices as sums of constant ones with coefficients of the velocities (\[D] § 5.2.1, (20) and Appendix A): assembled
//! once, combined in every step.

use crate::elastic;
use crate::mesh::Mesh;
use crate::rolling::{Motion, System};
use crate::sparse::Matrix;
use crate::triangle::{Order, Space};

/// A motion and how it changes.
#[derive(Clone, Copy, Debug)]
pub struct Course {
    /// Velocities.
    pub motion: Motion,
    /// Angular acceleration, forward [rad/s²].
    pub spin_up: f64,
    /// Acceleration of the travel [m/s²].
    pub speed_up: f64,
}

/// The constant matrices of wheel and rail; each is taken times a coefficient.
#[derive(Clone, Copy, Debug)]
pub enum Part {
    /// `K⁰`: elasticity.
    Elastic,
    /// Convection of velocities along the wheel, times `−ω²`.
    Turning,
    /// Convection along the rail, times `−V²`.
    Streaming,
    /// `ρ ∫ N (v·∇N)` in the wheel for a unit angular velocity: times `2ω` with rates, times `ω̇` with displacements.
    Gyroscopic,
    /// Convection in the rail for a unit velocity: `2V` and `V̇`.
    Passing,
    /// Mass.
    Mass,
}

const PARTS: usize = 6;

/// The parts over the unknowns. Two rows more sum up what acts on the hub: the moment about the centre, forward, and
/// the force along the rail (`A_M` and `A_F` of \[D] (24)).
pub struct Decomposition {
    /// Number of unknowns.
    pub size: usize,
    /// Rows and columns of all entries, and the value of each part there.
    entries: Vec<(usize, usize, [f64; PARTS])>,
    /// Forces of the accelerated frame [N/m] for a unit square of the angular velocity, angular acceleration and
    /// acceleration, on the left side of the equations.
    pub squared: Vec<f64>,
    /// For a unit angular acceleration.
    pub spun: Vec<f64>,
    /// For a unit acceleration of the travel: the rail passes at rest, so that only the wheel has it.
    pub sped: Vec<f64>,
}

impl Decomposition {
    /// Assembles the parts of a system from the meshes it was made of.
    pub fn new(system: &System, wheel: &Mesh, rail: &Mesh) -> Self {
        let (density, by) = (system.parameters.density, 2 * system.wheel_nodes);
        let size = system.unknown.len();
        let of_wheel = |matrix: Matrix| Matrix { size, ..matrix };
        let of_rail = |matrix: Matrix| {
            let moved = matrix.entries.into_iter().map(|(i, j, value)| (i + by, j + by, value));
            Matrix { size, entries: moved.collect() }
        };
        let [wheel, rail] = [Space::new(wheel, system.order), Space::new(rail, Order::Linear)];
        let gyroscopic = of_wheel(elastic::gyroscopic(&wheel, density, |[x, y]| [y, -x]));
        let passing = of_rail(elastic::gyroscopic(&rail, density, |_| [-1.0, 0.0]));
        let mass = of_wheel(elastic::mass(&wheel, density));
        // A linear field is its own interpolation: products with places and with a unit motion are the integrals of the
        // loads.
        let places: Vec<f64> = wheel.places.iter().flatten().copied().chain(vec![0.0; size - by]).collect();
        let forward: Vec<f64> = (0..size).map(|i| if i < by && i % 2 == 0 { 1.0 } else { 0.0 }).collect();
        let (spun, sped) = (gyroscopic.multiply(&places), mass.multiply(&forward));
        let mut mass = mass;
        mass.entries.extend(of_rail(elastic::mass(&rail, density)).entries);
        let squared: Vec<f64> = system.centrifugal.iter().map(|load| -load).collect();
        let parts = [&system.elastic, &system.turning, &system.streaming, &gyroscopic, &passing, &mass];
        let [squared, spun, sped] = [squared, spun, sped].map(|load| extended(system, &load));
        Self { size: system.size, entries: merged(system, parts), squared, spun, sped }
    }

    /// `A x` of a part, with the rows of the hub.
    pub fn multiply(&self, part: Part, x: &[f64]) -> Vec<f64> {
        let mut y = vec![0.0; self.size + 2];
        for (row, column, values) in &self.entries {
            y[*row] += values[part as usize] * x[*column];
        }
        y
    }

    /// Forces of displacements \[m], rates [m/s] and their rates [m/s²] in a course, with the rows of the hub \[N/m].
    pub fn forces(&self, course: Course, [u, v, a]: [&[f64]; 3]) -> Vec<f64> {
        let Course { motion: Motion { omega, .. }, spin_up, speed_up } = course;
        let mut sum: Vec<f64> = (0..self.size + 2)
            .map(|i| omega * omega * self.squared[i] + spin_up * self.spun[i] + speed_up * self.sped[i])
            .collect();
        let (of_u, of_v) = (self.of_displacements(course), self.of_rates(course.motion));
        for (row, column, values) in &self.entries {
            let dot = |c: &[f64; PARTS]| c.iter().zip(values).map(|(c, value)| c * value).sum::<f64>();
            sum[*row] += dot(&of_u) * u[*column] + dot(&of_v) * v[*column] + values[Part::Mass as usize] * a[*column];
        }
        sum
    }

    /// The derivative of these forces by the displacements at the end of a step of backward Euler \[s], with the rows
    /// of the hub.
    pub fn of_step(&self, course: Course, step: f64) -> impl Iterator<Item = (usize, usize, f64)> {
        let (mut sum, of_v) = (self.of_displacements(course), self.of_rates(course.motion));
        sum.iter_mut().zip(of_v).for_each(|(sum, v)| *sum += v / step);
        sum[Part::Mass as usize] = 1.0 / (step * step);
        self.entries.iter().map(move |(row, column, values)| {
            (*row, *column, sum.iter().zip(values).map(|(c, value)| c * value).sum::<f64>())
        })
    }

    fn of_displacements(&self, course: Course) -> [f64; PARTS] {
        let Course { motion: Motion { omega, velocity }, spin_up, speed_up } = course;
        [1.0, -omega * omega, -velocity * velocity, spin_up, speed_up, 0.0]
    }

    fn of_rates(&self, motion: Motion) -> [f64; PARTS] {
        [0.0, 0.0, 0.0, 2.0 * motion.omega, 2.0 * motion.velocity, 0.0]
    }
}

/// Forces on all displacements as those on the unknowns, and moment and force of the hub.
pub fn extended(system: &System, forces: &[f64]) -> Vec<f64> {
    let mut sums = system.gather(forces);
    let sum = |weights: &[f64]| weights.iter().zip(forces).map(|(weight, force)| weight * force).sum::<f64>();
    sums.extend([sum(&system.arms), sum(&system.along)]);
    sums
}

/// All entries of the parts in one list, those of one place together.
fn merged(system: &System, parts: [&Matrix; PARTS]) -> Vec<(usize, usize, [f64; PARTS])> {
    let mut entries: Vec<(usize, usize, [f64; PARTS])> = Vec::new();
    for (part, matrix) in parts.into_iter().enumerate() {
        for &(i, j, value) in &matrix.entries {
            let Some(column) = system.unknown[j] else { continue };
            let mut add = |row: usize, weight: f64| {
                let mut values = [0.0; PARTS];
                values[part] = weight * value;
                entries.push((row, column, values));
            };
            system.unknown[i].iter().for_each(|row| add(*row, 1.0));
            for (row, weights) in [(system.size, &system.arms), (system.size + 1, &system.along)] {
                if weights[i] != 0.0 {
                    add(row, weights[i]);
                }
            }
        }
    }
    entries.sort_unstable_by_key(|(i, j, _)| (*i, *j));
    entries.dedup_by(|next, kept| {
        let same = (next.0, next.1) == (kept.0, kept.1);
        if same {
            kept.2.iter_mut().zip(next.2).for_each(|(kept, next)| *kept += next);
        }
        same
    });
    entries
}
