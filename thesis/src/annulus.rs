//! The test of \[B] § 4: heat in a rotating annulus with a uniform source and cold rims, whose exact temperature does
//! not depend on the rotation.

use crate::Error;
use crate::flow::Flow;
use crate::mesh::Mesh;
use crate::sparse::Matrix;
use crate::stabilise::Scheme;
use crate::triangle::{Order, Space, shape};

/// Outer radius \[m].
pub const OUTER: f64 = 0.5;
/// Inner radius \[m].
pub const INNER: f64 = 0.05;
/// Source [W/m³].
pub const SOURCE: f64 = 1000.0;
/// Heat capacity of the volume [J/(m³ K)].
pub const CAPACITY: f64 = 8000.0 * 460.0;
/// Conductivity [W/(m K)], not stated in \[B]: the one of its main example.
pub const CONDUCTIVITY: f64 = 45.0;

/// Exact temperature \[K] at radius `r` \[m].
pub fn exact(r: f64) -> f64 {
    let logarithms = (OUTER / r).ln() / (OUTER / INNER).ln();
    SOURCE / (4.0 * CONDUCTIVITY) * (OUTER * OUTER - r * r - (OUTER * OUTER - INNER * INNER) * logarithms)
}

/// Radius of the largest exact temperature \[m].
pub fn hottest() -> f64 {
    ((OUTER * OUTER - INNER * INNER) / (2.0 * (OUTER / INNER).ln())).sqrt()
}

/// A computed temperature.
pub struct Field {
    mesh: Mesh,
    space: Space,
    /// Temperatures of the nodes \[K].
    pub theta: Vec<f64>,
    /// Heat of the source less that which leaves through the rims by their reactions, over that of the source \[1].
    pub imbalance: f64,
}

/// Temperature of an annulus that turns with `omega` [rad/s] as the thesis has it, `v = ω (y, −x)`.
pub fn solve(mesh: Mesh, order: Order, scheme: Scheme, omega: f64) -> Result<Field, Error> {
    solve_by(mesh, order, scheme, omega, 5)
}

/// System with a quadrature of the given degree, 2 to 5.
pub fn solve_by(mesh: Mesh, order: Order, scheme: Scheme, omega: f64, degree: usize) -> Result<Field, Error> {
    let space = Space::new(&mesh, order);
    let velocity = |[x, y]: [f64; 2]| [omega * y, -omega * x];
    let flow = Flow { capacity: CAPACITY, conductivity: CONDUCTIVITY, velocity: &velocity, source: SOURCE, degree };
    let (mut matrix, mut load) = (Matrix::new(space.places.len()), vec![0.0; space.places.len()]);
    for (t, nodes) in space.elements.iter().enumerate() {
        let (part, share) = flow.element(&mesh.corners(t), order, scheme);
        for (a, &row) in nodes.iter().enumerate() {
            load[row] += share[a];
            for (b, &column) in nodes.iter().enumerate() {
                matrix.add(row, column, part[(a, b)]);
            }
        }
    }
    let rims = rims(&space);
    let (rows, heat) = (matrix.fix(&rims), load.iter().sum::<f64>());
    let mut leaves: f64 = rims.iter().map(|node| std::mem::take(&mut load[*node])).sum();
    let theta = matrix.factorise()?.solve(load)?;
    leaves -= rows.multiply(&theta).iter().sum::<f64>();
    Ok(Field { mesh, space, theta, imbalance: (leaves / heat - 1.0).abs() })
}

/// Nodes of both rims, middles of their edges included.
fn rims(space: &Space) -> Vec<usize> {
    let ends = |&(a, b, middle): &_| [Some(a), Some(b), middle];
    let mut found: Vec<usize> = space.sides.iter().flat_map(ends).flatten().collect();
    found.sort_unstable();
    found.dedup();
    found
}

impl Field {
    /// Temperature \[K] at a place \[m]; `None` outside of the mesh.
    pub fn at(&self, place: [f64; 2]) -> Option<f64> {
        (0..self.mesh.triangles.len()).find_map(|t| {
            let corners = self.mesh.corners(t);
            let slopes = crate::triangle::linear_gradients(&corners);
            let at = [0, 1, 2]
                .map(|i| 1.0 + slopes[i][0] * (place[0] - corners[i][0]) + slopes[i][1] * (place[1] - corners[i][1]));
            let inside = at.iter().all(|share| *share > -1e-9);
            inside.then(|| {
                let values = shape(&corners, self.space.order, at).values;
                self.space.elements[t].iter().zip(values).map(|(node, value)| value * self.theta[*node]).sum()
            })
        })
    }

    /// Mean over the circle of radius `r` \[m].
    pub fn mean_on_circle(&self, r: f64) -> f64 {
        let samples = 360;
        let angle = |i: usize| std::f64::consts::TAU * (i as f64 + 0.5) / samples as f64;
        let values = (0..samples).filter_map(|i| self.at([r * angle(i).cos(), r * angle(i).sin()]));
        values.sum::<f64>() / samples as f64
    }
}
