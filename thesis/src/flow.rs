//! Conduction in a stream on one triangle, `∫ w ρc v·∇θ + k ∇w·∇θ = ∫ w s`, with the stabilisations of the thesis.

use crate::stabilise::{Scheme, bubble_position, intrinsic_time, stream_length};
use crate::triangle::{Order, laplacians, linear_gradients, place, points_of_degree};
use nalgebra::{DMatrix, DVector};

/// Medium that streams and conducts.
pub struct Flow<'a> {
    /// Heat capacity of the volume ρc [J/(m³ K)].
    pub capacity: f64,
    /// Conductivity k [W/(m K)].
    pub conductivity: f64,
    /// Velocity [m/s] at a place \[m].
    pub velocity: &'a dyn Fn([f64; 2]) -> [f64; 2],
    /// Source [W/m³].
    pub source: f64,
    /// Degree of the polynomials that the quadrature integrates exactly, 2 to 5.
    pub degree: usize,
}

/// Matrix [W/(m K)] and load [W/m] of an element.
pub type Element = (DMatrix<f64>, DVector<f64>);

/// Least share of the area that each part of a triangle with a bubble keeps \[1].
const SMALLEST_PART: f64 = 1e-3;

impl Flow<'_> {
    /// The element on a triangle.
    pub fn element(&self, corners: &[[f64; 2]; 3], order: Order, scheme: Scheme) -> Element {
        match scheme {
            Scheme::Galerkin => self.weighted(corners, order, |_| 0.0),
            Scheme::Supg => {
                let velocity = (self.velocity)(place(corners, [1.0 / 3.0; 3]));
                let speed = velocity[0].hypot(velocity[1]);
                let time = |length: f64| intrinsic_time(length, self.capacity, speed, self.conductivity);
                self.weighted(corners, order, |slopes| time(stream_length(slopes, velocity)))
            }
            Scheme::Bubble => self.with_bubble(corners, order),
        }
    }

    /// Element with the weight `w + τ ρc v·∇w`; `tau` [m³ K/W] of the gradients of the element's functions [1/m] at a
    /// place.
    fn weighted(&self, corners: &[[f64; 2]; 3], order: Order, tau: impl Fn(&[[f64; 2]]) -> f64) -> Element {
        let n = order.count();
        let curvature = laplacians(corners, order);
        let (mut matrix, mut load) = (DMatrix::zeros(n, n), DVector::zeros(n));
        for point in points_of_degree(corners, order, self.degree) {
            let (values, slopes) = (point.shape.values, point.shape.gradients);
            let velocity = (self.velocity)(point.place);
            let tau = tau(&slopes[..n]);
            let convect = |i: usize| self.capacity * (slopes[i][0] * velocity[0] + slopes[i][1] * velocity[1]);
            for i in 0..n {
                let weight = values[i] + tau * convect(i);
                load[i] += point.weight * weight * self.source;
                for j in 0..n {
                    let conduct = slopes[i][0] * slopes[j][0] + slopes[i][1] * slopes[j][1];
                    let residual = weight * convect(j) - tau * convect(i) * self.conductivity * curvature[j];
                    matrix[(i, j)] += point.weight * (residual + self.conductivity * conduct);
                }
            }
        }
        (matrix, load)
    }

    /// Three triangles about the bubble's node, whose inner unknowns are eliminated.
    fn with_bubble(&self, corners: &[[f64; 2]; 3], order: Order) -> Element {
        let n = order.count();
        let inner = self.bubble_node(corners);
        let node = place(corners, inner);
        let size = if order == Order::Linear { 4 } else { 10 };
        let (mut matrix, mut load) = (DMatrix::zeros(size, size), DVector::zeros(size));
        for i in 0..3 {
            let next = (i + 1) % 3;
            let nodes = match order {
                Order::Linear => vec![i, next, 3],
                Order::Quadratic => vec![i, next, 6, 3 + i, 7 + next, 7 + i],
            };
            let (part, share) = self.weighted(&[corners[i], corners[next], node], order, |_| 0.0);
            for (a, &row) in nodes.iter().enumerate() {
                load[row] += share[a];
                for (b, &column) in nodes.iter().enumerate() {
                    matrix[(row, column)] += part[(a, b)];
                }
            }
        }
        condense(&matrix, &load, n)
    }

    /// Barycentric coordinates of the bubble's node: on the streamline through the centroid.
    fn bubble_node(&self, corners: &[[f64; 2]; 3]) -> [f64; 3] {
        let velocity = (self.velocity)(place(corners, [1.0 / 3.0; 3]));
        let speed = velocity[0].hypot(velocity[1]);
        if speed == 0.0 {
            return [1.0 / 3.0; 3];
        }
        // Change of the coordinates per metre along the stream.
        let slopes = linear_gradients(corners).map(|g| (g[0] * velocity[0] + g[1] * velocity[1]) / speed);
        let ways = |least: f64, sign: f64| {
            let way = slopes.iter().filter(|slope| sign * **slope < 0.0).map(|slope| (1.0 / 3.0 - least) / slope.abs());
            way.fold(f64::INFINITY, f64::min)
        };
        let (back, ahead) = (ways(0.0, -1.0), ways(0.0, 1.0));
        let peclet = self.capacity * speed * (back + ahead) / self.conductivity;
        let along = bubble_position(peclet) * (back + ahead) - back;
        let along = along.clamp(-ways(SMALLEST_PART, -1.0), ways(SMALLEST_PART, 1.0));
        slopes.map(|slope| 1.0 / 3.0 + along * slope)
    }
}

/// Eliminates all unknowns of an element beyond the first `kept`.
fn condense(matrix: &DMatrix<f64>, load: &DVector<f64>, kept: usize) -> Element {
    let inner = matrix.nrows() - kept;
    let block = |i: usize, j: usize, rows: usize, columns: usize| matrix.view((i, j), (rows, columns)).into_owned();
    let right = block(kept, 0, inner, kept).insert_column(kept, 0.0);
    let mut right = right;
    right.set_column(kept, &load.rows(kept, inner));
    // The inner block of a triangle with positive area and conductivity is never singular: its symmetric part conducts.
    let solved = block(kept, kept, inner, inner).lu().solve(&right).unwrap_or_else(|| DMatrix::zeros(inner, kept + 1));
    let coupling = block(0, kept, kept, inner);
    let reduced = block(0, 0, kept, kept) - &coupling * solved.columns(0, kept);
    (reduced, load.rows(0, kept) - coupling * solved.column(kept))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::double_area;

    const CORNERS: [[f64; 2]; 3] = [[0.1, -0.2], [1.3, 0.1], [0.4, 0.9]];

    /// Share of the smallest of the three parts of a triangle \[1].
    fn smallest_part(corners: &[[f64; 2]; 3], at: [f64; 3]) -> f64 {
        let node = place(corners, at);
        let part = |i: usize| double_area(&[corners[i], corners[(i + 1) % 3], node]) / double_area(corners);
        part(0).min(part(1)).min(part(2))
    }

    fn flow(velocity: &dyn Fn([f64; 2]) -> [f64; 2]) -> Flow<'_> {
        Flow { capacity: 2.0, conductivity: 0.3, velocity, source: 1.5, degree: 5 }
    }

    #[test]
    fn supg_without_a_stream_adds_nothing_and_a_bubble_only_its_load() {
        let still = |_: [f64; 2]| [0.0, 0.0];
        let (matrix, load) = flow(&still).weighted(&CORNERS, Order::Linear, |_| 0.0);
        // With τ from the limit of a vanishing stream the weights are unchanged, since v itself vanishes.
        let (upwinded, upwinded_load) = flow(&still).weighted(&CORNERS, Order::Linear, |_| 7.0);
        assert_eq!((&matrix, &load), (&upwinded, &upwinded_load));
        // Linear functions are harmonic, so a bubble does not see them: same matrix; and constants keep all of the
        // load.
        let (bubble, bubble_load) = flow(&still).element(&CORNERS, Order::Linear, Scheme::Bubble);
        assert!((matrix - bubble).amax() < 1e-13);
        assert!((load.sum() - bubble_load.sum()).abs() < 1e-13);
    }

    #[test]
    fn stabilised_elements_hold_exact_solutions_that_their_functions_contain() {
        // v·∇θ = s/ρc for linear θ: consistent schemes leave the residual of an inner patch, here of the whole weight
        // 1.
        let stream = |_: [f64; 2]| [0.8, -0.5];
        let flow = Flow { source: 2.0 * (0.8 * 3.0 - 0.5 * 2.0), ..flow(&stream) };
        for order in [Order::Linear, Order::Quadratic] {
            let mesh = crate::mesh::Mesh { nodes: CORNERS.to_vec(), triangles: vec![[0, 1, 2]] };
            let space = crate::triangle::Space::new(&mesh, order);
            let theta = DVector::from_iterator(
                order.count(),
                space.elements[0].iter().map(|node| 3.0 * space.places[*node][0] + 2.0 * space.places[*node][1]),
            );
            let (plain, plain_load) = flow.element(&CORNERS, order, Scheme::Galerkin);
            let boundary = &plain * &theta - plain_load;
            for scheme in [Scheme::Supg, Scheme::Bubble] {
                let (matrix, load) = flow.element(&CORNERS, order, scheme);
                let change = (&matrix * &theta - load - &boundary).amax();
                println!("{order:?} {scheme:?}: {change:.1e}");
                assert!(change < 1e-12, "{order:?} {scheme:?}: {change}");
            }
        }
    }

    #[test]
    fn a_bubble_moves_downstream_and_never_degenerates_a_triangle() {
        let mut before = 0.0;
        for speed in [1e-6, 0.1, 1.0, 10.0, 1e3, 1e9] {
            let stream = move |_: [f64; 2]| [0.6 * speed, 0.8 * speed];
            let at = flow(&stream).bubble_node(&CORNERS);
            let node = place(&CORNERS, at);
            let along = 0.6 * node[0] + 0.8 * node[1];
            assert!(smallest_part(&CORNERS, at) > 0.999 * SMALLEST_PART, "{speed}: {at:?}");
            assert!(along > before, "{speed}");
            before = along;
        }
    }
}
