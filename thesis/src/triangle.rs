//! Straight triangles with linear and quadratic functions, and the numbering of their nodes.
//!
//! Local nodes: the three corners, then for quadratic functions the middles of the edges 01, 12 and 20.

use crate::mesh::{Mesh, double_area, edge, edges};
use std::collections::{HashMap, HashSet};

/// Degree of the shape functions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Order {
    /// Three nodes.
    Linear,
    /// Six nodes.
    Quadratic,
}

impl Order {
    /// Nodes of a triangle.
    pub fn count(self) -> usize {
        match self {
            Self::Linear => 3,
            Self::Quadratic => 6,
        }
    }
}

/// Shape functions at one place of a triangle; entries beyond the number of its nodes are zero.
#[derive(Clone, Copy, Debug)]
pub struct Shape {
    /// Values \[1].
    pub values: [f64; 6],
    /// Gradients [1/m].
    pub gradients: [[f64; 2]; 6],
}

/// A place of integration.
#[derive(Clone, Copy, Debug)]
pub struct Point {
    /// Shape functions there.
    pub shape: Shape,
    /// Place \[m].
    pub place: [f64; 2],
    /// Weight \[m²]; the weights of a triangle add up to its area.
    pub weight: f64,
}

/// Gradients of the linear shape functions [1/m].
pub fn linear_gradients(corners: &[[f64; 2]; 3]) -> [[f64; 2]; 3] {
    let area = double_area(corners);
    [0, 1, 2].map(|i| {
        let (b, c) = (corners[(i + 1) % 3], corners[(i + 2) % 3]);
        [(b[1] - c[1]) / area, (c[0] - b[0]) / area]
    })
}

/// Place with the given barycentric coordinates \[m].
pub fn place(corners: &[[f64; 2]; 3], at: [f64; 3]) -> [f64; 2] {
    [0, 1].map(|axis| (0..3).map(|i| at[i] * corners[i][axis]).sum())
}

/// Shape functions at barycentric coordinates.
pub fn shape(corners: &[[f64; 2]; 3], order: Order, at: [f64; 3]) -> Shape {
    let slopes = linear_gradients(corners);
    let mut shape = Shape { values: [0.0; 6], gradients: [[0.0; 2]; 6] };
    for i in 0..3 {
        let (next, scale) = ((i + 1) % 3, |vector: [f64; 2], factor: f64| vector.map(|x| factor * x));
        match order {
            Order::Linear => {
                shape.values[i] = at[i];
                shape.gradients[i] = slopes[i];
            }
            Order::Quadratic => {
                shape.values[i] = at[i] * (2.0 * at[i] - 1.0);
                shape.gradients[i] = scale(slopes[i], 4.0 * at[i] - 1.0);
                shape.values[3 + i] = 4.0 * at[i] * at[next];
                let (a, b) = (scale(slopes[i], 4.0 * at[next]), scale(slopes[next], 4.0 * at[i]));
                shape.gradients[3 + i] = [a[0] + b[0], a[1] + b[1]];
            }
        }
    }
    shape
}

/// Second derivatives `∂ₓₓ + ∂ᵧᵧ` of the shape functions [1/m²], constant within a straight triangle.
pub fn laplacians(corners: &[[f64; 2]; 3], order: Order) -> [f64; 6] {
    let mut found = [0.0; 6];
    if order == Order::Quadratic {
        let slopes = linear_gradients(corners);
        let product = |i: usize, j: usize| slopes[i][0] * slopes[j][0] + slopes[i][1] * slopes[j][1];
        for i in 0..3 {
            found[i] = 4.0 * product(i, i);
            found[3 + i] = 8.0 * product(i, (i + 1) % 3);
        }
    }
    found
}

/// Seven places of integration, exact for polynomials of degree five (Radon 1948): the rule of \[B] § 4.
pub fn points(corners: &[[f64; 2]; 3], order: Order) -> [Point; 7] {
    let root = 15.0_f64.sqrt();
    let area = 0.5 * double_area(corners);
    let (near, far) = ((6.0 - root) / 21.0, (6.0 + root) / 21.0);
    let (light, heavy) = ((155.0 - root) / 1200.0, (155.0 + root) / 1200.0);
    let beside = |i: usize, share: f64| {
        let mut at = [share; 3];
        at[i] = 1.0 - 2.0 * share;
        at
    };
    let rule: [([f64; 3], f64); 7] = [
        ([1.0 / 3.0; 3], 9.0 / 40.0),
        (beside(0, near), light),
        (beside(1, near), light),
        (beside(2, near), light),
        (beside(0, far), heavy),
        (beside(1, far), heavy),
        (beside(2, far), heavy),
    ];
    rule.map(|(at, weight)| Point {
        shape: shape(corners, order, at),
        place: place(corners, at),
        weight: weight * area,
    })
}

/// Places of integration of a rule that is exact for polynomials of degree two to five (three points; four, one of them
/// negative; six after Dunavant 1985; those of [`points`]).
pub fn points_of_degree(corners: &[[f64; 2]; 3], order: Order, degree: usize) -> Vec<Point> {
    let area = 0.5 * double_area(corners);
    // Share of two coordinates, and weight of each of the three points that have it.
    let triples: &[(f64, f64)] = match degree {
        2 => &[(1.0 / 6.0, 1.0 / 3.0)],
        3 => &[(0.2, 25.0 / 48.0)],
        4 => &[(0.445_948_490_915_965, 0.223_381_589_678_011), (0.091_576_213_509_771, 0.109_951_743_655_322)],
        _ => return points(corners, order).to_vec(),
    };
    let beside = |(share, weight): &(f64, f64)| {
        let (share, weight) = (*share, *weight);
        (0..3).map(move |i| ([0, 1, 2].map(|j| if i == j { 1.0 - 2.0 * share } else { share }), weight))
    };
    let centre = (degree == 3).then_some(([1.0 / 3.0; 3], -27.0 / 48.0));
    let point = |(at, weight): ([f64; 3], f64)| Point {
        shape: shape(corners, order, at),
        place: place(corners, at),
        weight: weight * area,
    };
    triples.iter().flat_map(beside).chain(centre).map(point).collect()
}

/// Nodes of all elements of a mesh: its own, and with quadratic functions the middles of its edges after them.
#[derive(Clone, Debug)]
pub struct Space {
    /// Degree of the functions.
    pub order: Order,
    /// Places of the nodes \[m].
    pub places: Vec<[f64; 2]>,
    /// Nodes of each triangle in local order.
    pub elements: Vec<Vec<usize>>,
    /// Both ends of each edge on the boundary of the mesh, counter-clockwise, and its middle node where there is one.
    pub sides: Vec<(usize, usize, Option<usize>)>,
}

impl Space {
    /// Numbers the nodes.
    pub fn new(mesh: &Mesh, order: Order) -> Self {
        let mut places = mesh.nodes.clone();
        let mut middles: HashMap<(usize, usize), usize> = HashMap::new();
        let mut elements = Vec::with_capacity(mesh.triangles.len());
        for triangle in &mesh.triangles {
            let mut nodes = triangle.to_vec();
            if order == Order::Quadratic {
                for edge in edges(*triangle) {
                    nodes.push(*middles.entry(edge).or_insert_with(|| {
                        let (a, b) = (mesh.nodes[edge.0], mesh.nodes[edge.1]);
                        places.push([0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])]);
                        places.len() - 1
                    }));
                }
            }
            elements.push(nodes);
        }
        let boundary: HashSet<_> = mesh.boundary().into_iter().collect();
        let around = |nodes: &Vec<usize>| [0, 1, 2].map(|i| (nodes[i], nodes[(i + 1) % 3], nodes.get(3 + i).copied()));
        let sides = elements.iter().flat_map(around).filter(|(a, b, _)| boundary.contains(&edge(*a, *b))).collect();
        Self { order, places, elements, sides }
    }

    /// Corners of triangle `t` \[m].
    pub fn corners(&self, t: usize) -> [[f64; 2]; 3] {
        [0, 1, 2].map(|i| self.places[self.elements[t][i]])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CORNERS: [[f64; 2]; 3] = [[0.1, -0.2], [1.3, 0.1], [0.4, 0.9]];

    #[test]
    fn integration_is_exact_for_degree_five() {
        // ∫ λ₀ᵃ λ₁ᵇ λ₂ᶜ = 2A a! b! c! / (a + b + c + 2)!
        let factorial = |n: usize| (1..=n).product::<usize>() as f64;
        let powers = (0..=5).flat_map(|a| (0..=5 - a).flat_map(move |b| (0..=5 - a - b).map(move |c| [a, b, c])));
        for [a, b, c] in powers {
            let exact = double_area(&CORNERS) * factorial(a) * factorial(b) * factorial(c) / factorial(a + b + c + 2);
            let term = |p: &Point| {
                let v = p.shape.values;
                p.weight * v[0].powi(a as i32) * v[1].powi(b as i32) * v[2].powi(c as i32)
            };
            for degree in (a + b + c).max(2)..=5 {
                let found: f64 = points_of_degree(&CORNERS, Order::Linear, degree).iter().map(term).sum();
                assert!((found / exact - 1.0).abs() < 1e-11, "{degree}: {a}{b}{c}: {found} {exact}");
            }
        }
    }

    #[test]
    fn quadratic_functions_reproduce_quadratics_with_their_slopes_and_curvatures() {
        let f = |[x, y]: [f64; 2]| 1.0 + 2.0 * x - y + 3.0 * x * x - 4.0 * x * y + 0.5 * y * y;
        let mesh = Mesh { nodes: CORNERS.to_vec(), triangles: vec![[0, 1, 2]] };
        let space = Space::new(&mesh, Order::Quadratic);
        let nodal: Vec<f64> = space.elements[0].iter().map(|node| f(space.places[*node])).collect();
        for point in points(&CORNERS, Order::Quadratic) {
            let sum = |values: [f64; 6]| values.iter().zip(&nodal).map(|(n, v)| n * v).sum::<f64>();
            let [x, y] = point.place;
            assert!((sum(point.shape.values) - f([x, y])).abs() < 1e-13);
            assert!((sum(point.shape.gradients.map(|g| g[0])) - (2.0 + 6.0 * x - 4.0 * y)).abs() < 1e-12);
            assert!((sum(point.shape.gradients.map(|g| g[1])) - (-1.0 - 4.0 * x + y)).abs() < 1e-12);
        }
        let curvature: f64 = laplacians(&CORNERS, Order::Quadratic).iter().zip(&nodal).map(|(l, v)| l * v).sum();
        assert!((curvature - 7.0).abs() < 1e-11, "{curvature}");
    }
}
