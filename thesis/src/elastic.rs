//! Triangles in plane strain, linear or quadratic, and what a stationary stream of material adds (\[B] (33),
//! stationary): matrices without velocities, as the decomposition of \[D] (20) wants them.

use crate::mesh::{Mesh, edges};
use crate::rail::Plate;
use crate::sparse::Matrix;
use crate::triangle::{Point, Space, linear_gradients, points};

/// `∫ Bᵀ E B` \[Pa] for Young's modulus \[Pa] and Poisson's ratio; unknowns 2i and 2i + 1 of node i.
pub fn stiffness(space: &Space, young: f64, poisson: f64) -> Matrix {
    let shear = 0.5 * young / (1.0 + poisson);
    let lame = 2.0 * shear * poisson / (1.0 - 2.0 * poisson);
    assemble(space, |point, a, b| {
        let [a, b] = [a, b].map(|function| point.shape.gradients[function]);
        let product = a[0] * b[0] + a[1] * b[1];
        let entry =
            |p: usize, q: usize| lame * a[p] * b[q] + shear * (a[q] * b[p] + if p == q { product } else { 0.0 });
        [[entry(0, 0), entry(0, 1)], [entry(1, 0), entry(1, 1)]]
    })
}

/// `3Kα ∫ (∇N) N` [N/(m K)] (`−K_uθ` of \[B] (33)): forces of temperatures on nodes, rows 2i and 2i + 1 of node i, one
/// column for each node; with the thermal expansion \[1/K].
pub fn expansion(space: &Space, [young, poisson, expansion]: [f64; 3]) -> Matrix {
    let stress = young * expansion / (1.0 - 2.0 * poisson);
    let mut matrix = Matrix::new(2 * space.places.len());
    for (t, nodes) in space.elements.iter().enumerate() {
        for point in points(&space.corners(t), space.order) {
            for (i, slope) in nodes.iter().zip(point.shape.gradients) {
                for (j, value) in nodes.iter().zip(point.shape.values) {
                    (0..2).for_each(|axis| matrix.add(2 * i + axis, *j, stress * point.weight * slope[axis] * value));
                }
            }
        }
    }
    matrix.compressed()
}

/// `ρ ∫ (v·∇N)ᵀ (v·∇N)` for a velocity field of unit coefficient; the stiffness of the stream is minus its square
/// times this.
pub fn convection(space: &Space, density: f64, velocity: impl Fn([f64; 2]) -> [f64; 2]) -> Matrix {
    in_both_directions(space, |point, a, b| density * along(&velocity, point, a) * along(&velocity, point, b))
}

/// `ρ ∫ N X` \[kg]: the centrifugal load for a unit angular velocity about the origin.
pub fn centrifugal(space: &Space, density: f64) -> Vec<f64> {
    let mut load = vec![0.0; 2 * space.places.len()];
    for (t, nodes) in space.elements.iter().enumerate() {
        for point in points(&space.corners(t), space.order) {
            for (node, value) in nodes.iter().zip(point.shape.values) {
                (0..2).for_each(|axis| load[2 * node + axis] += density * point.weight * value * point.place[axis]);
            }
        }
    }
    load
}

/// `ρ ∫ N N` [kg/m]: the same in both directions.
pub fn mass(space: &Space, density: f64) -> Matrix {
    in_both_directions(space, |point, a, b| density * point.shape.values[a] * point.shape.values[b])
}

/// `ρ ∫ N (v·∇N)` [kg/(m s)] for a velocity field [m/s], to be taken twice the velocities of the nodes.
pub fn gyroscopic(space: &Space, density: f64, velocity: impl Fn([f64; 2]) -> [f64; 2]) -> Matrix {
    in_both_directions(space, |point, a, b| density * point.shape.values[a] * along(&velocity, point, b))
}

/// `v·∇N` of a function at a point.
fn along(velocity: &impl Fn([f64; 2]) -> [f64; 2], point: &Point, function: usize) -> f64 {
    let (v, slope) = (velocity(point.place), point.shape.gradients[function]);
    v[0] * slope[0] + v[1] * slope[1]
}

/// `ρ ∮ (c_P n n + c_S t t) N N` [kg/(m s)] on the vertical ends of a plate (Lysmer and Kuhlemeyer; \[A] § 2.5), for
/// Young's modulus \[Pa], Poisson's ratio and density [kg/m³].
pub fn dashpots(mesh: &Mesh, plate: Plate, [young, poisson, density]: [f64; 3]) -> Matrix {
    let shear = 0.5 * young / (1.0 + poisson);
    let pressure = 2.0 * shear * (1.0 - poisson) / (1.0 - 2.0 * poisson);
    let impedance = [pressure, shear].map(|modulus| (density * modulus).sqrt());
    let mut matrix = Matrix::new(2 * mesh.nodes.len());
    let at_end = |node: usize| mesh.nodes[node][0].abs() > 0.5 * plate.length - 1e-9;
    for (a, b) in mesh.boundary().into_iter().filter(|(a, b)| at_end(*a) && at_end(*b)) {
        let length = (mesh.nodes[a][1] - mesh.nodes[b][1]).abs();
        for (i, j, share) in [(a, a, 2.0), (b, b, 2.0), (a, b, 1.0), (b, a, 1.0)] {
            (0..2).for_each(|axis| matrix.add(2 * i + axis, 2 * j + axis, impedance[axis] * length * share / 6.0));
        }
    }
    matrix
}

/// `ρ ∮ (v·n) N (v·∇N)` [kg/m³] on the vertical ends of a plate of linear triangles, through which material passes with
/// `v = −e_x`, to be taken `V²` times (\[B] (33), \[D] (35)): what makes an end free of the traction `P·n` instead of
/// the natural one, which carries the stream's momentum, too.
pub fn open_ends(mesh: &Mesh, plate: Plate, density: f64) -> Matrix {
    let mut matrix = Matrix::new(2 * mesh.nodes.len());
    let at_end = |node: usize| mesh.nodes[node][0].abs() > 0.5 * plate.length - 1e-9;
    for (t, nodes) in mesh.triangles.iter().enumerate() {
        let slopes = linear_gradients(&mesh.corners(t));
        for (a, b) in edges(*nodes).into_iter().filter(|(a, b)| at_end(*a) && at_end(*b)) {
            let [p, q] = [a, b].map(|node| mesh.nodes[node]);
            // v·n is −1 where material comes in, on the right, and v·∇ is −∂x.
            let through = -p[0].signum();
            let share = 0.5 * density * through * (p[1] - q[1]).abs();
            for row in [a, b] {
                for (column, slope) in nodes.iter().zip(&slopes) {
                    (0..2).for_each(|axis| matrix.add(2 * row + axis, 2 * column + axis, -share * slope[0]));
                }
            }
        }
    }
    matrix
}

/// Integrates `entry(point, a, b)` over all pairs of functions, the same in both directions and nothing between them.
fn in_both_directions(space: &Space, entry: impl Fn(&Point, usize, usize) -> f64) -> Matrix {
    assemble(space, |point, a, b| {
        let value = entry(point, a, b);
        [[value, 0.0], [0.0, value]]
    })
}

/// Integrates `entry(point, a, b)`, one value for each pair of directions, over all pairs of functions.
fn assemble(space: &Space, entry: impl Fn(&Point, usize, usize) -> [[f64; 2]; 2]) -> Matrix {
    let mut matrix = Matrix::new(2 * space.places.len());
    for (t, nodes) in space.elements.iter().enumerate() {
        let points = points(&space.corners(t), space.order);
        for (a, i) in nodes.iter().enumerate() {
            for (b, j) in nodes.iter().enumerate() {
                let mut sum = [[0.0; 2]; 2];
                for point in &points {
                    let part = entry(point, a, b);
                    (0..2).for_each(|p| (0..2).for_each(|q| sum[p][q] += point.weight * part[p][q]));
                }
                let parts = (0..2).flat_map(|p| (0..2).map(move |q| (p, q))).filter(|(p, q)| sum[*p][*q] != 0.0);
                parts.for_each(|(p, q)| matrix.add(2 * i + p, 2 * j + q, sum[p][q]));
            }
        }
    }
    matrix
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rail;
    use crate::triangle::Order;
    use crate::wheel::coarse;

    #[test]
    fn rigid_motions_strain_nothing_and_a_turn_convects_like_its_own_centrifugal_load() {
        let mesh = coarse(&[0.1, 0.3, 0.5], 24);
        for order in [Order::Linear, Order::Quadratic] {
            let space = Space::new(&mesh, order);
            let stiffness = stiffness(&space, 200e9, 0.3);
            let field =
                |f: &dyn Fn([f64; 2]) -> [f64; 2]| space.places.iter().flat_map(|n| f(*n)).collect::<Vec<f64>>();
            for rigid in [field(&|_| [1.0, 0.0]), field(&|_| [0.0, 1.0]), field(&|[x, y]| [y, -x])] {
                assert!(stiffness.multiply(&rigid).iter().all(|force| force.abs() < 1e-2), "of 1e11");
            }
            // (v·∇)X = v and ∫ (v·∇N)·v = −∫ N (v·∇)v = ∫ N X for v = (y, −x), up to the chords of the rims.
            let turn = |[x, y]: [f64; 2]| [y, -x];
            let left = convection(&space, 8000.0, turn).multiply(&field(&|place| place));
            let right = centrifugal(&space, 8000.0);
            let inner = 24..48;
            let error = inner.map(|n| (left[2 * n] - right[2 * n]).abs()).fold(0.0, f64::max);
            let scale = right.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
            println!("{order:?}: {:.1e}", error / scale);
            assert!(error < 1e-12 * scale);
        }
    }

    /// With it a uniform stretch, whose material has no acceleration, needs no forces at all; without it the ends would
    /// be pushed.
    #[test]
    fn the_term_of_the_ends_makes_them_blind_to_a_uniform_stretch() {
        let (plate, density) = (Plate { length: 1.0, height: 0.1 }, 8000.0);
        let mesh = rail::rolling(plate, 11, 0.01, 0.02);
        let stream = convection(&Space::new(&mesh, Order::Linear), density, |_| [-1.0, 0.0]);
        let ends = open_ends(&mesh, plate, density);
        let stretch: Vec<f64> = mesh.nodes.iter().flat_map(|[x, y]| [*x, *y]).collect();
        let [inner, outer] = [&stream, &ends].map(|matrix| matrix.multiply(&stretch));
        let most = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0_f64, |most, force| most.max(force.abs()));
        let (left, scale) = (most(&mut inner.iter().zip(&outer).map(|(s, b)| s - b)), most(&mut inner.iter().copied()));
        println!("{left:.1e} of {scale:.1e} N/m");
        assert!(left < 1e-12 * scale && scale > 1.0);
    }

    /// Error in the mean square of a stream through a held plate with `2n × n` cells, over that of the field.
    fn stream(order: Order, n: usize) -> f64 {
        let (plate, [young, poisson, density], speed) = (Plate { length: 2.0, height: 1.0 }, [1.0, 0.3, 0.16], 1.0);
        let space = Space::new(&rail::coarse(plate, 2 * n + 1, n + 1), order);
        let exact = |[x, y]: [f64; 2]| [(2.0 * x + y).sin(), (x - 3.0 * y).cos()];
        // −div σ + ρV² u_xx of these fields.
        let shear = 0.5 * young / (1.0 + poisson);
        let lame = 2.0 * shear * poisson / (1.0 - 2.0 * poisson);
        let inertia = density * speed * speed;
        let force = |[x, y]: [f64; 2]| {
            let (s, c) = ((2.0 * x + y).sin(), (x - 3.0 * y).cos());
            [
                (lame + shear) * (4.0 * s - 3.0 * c) + (5.0 * shear - 4.0 * inertia) * s,
                (lame + shear) * (2.0 * s + 9.0 * c) + (10.0 * shear - inertia) * c,
            ]
        };
        let mut matrix = Matrix::sum(&[
            (1.0, &stiffness(&space, young, poisson)),
            (-speed * speed, &convection(&space, density, |_| [-1.0, 0.0])),
        ]);
        let integral = |f: &mut dyn FnMut(&crate::triangle::Point, &[usize])| {
            for (t, nodes) in space.elements.iter().enumerate() {
                points(&space.corners(t), order).iter().for_each(|point| f(point, nodes));
            }
        };
        let mut load = vec![0.0; matrix.size];
        integral(&mut |point, nodes| {
            let there = force(point.place);
            for (node, value) in nodes.iter().zip(point.shape.values) {
                (0..2).for_each(|axis| load[2 * node + axis] += point.weight * value * there[axis]);
            }
        });
        let rim = |[x, y]: [f64; 2]| x.abs() > 1.0 - 1e-9 || (y + 0.5).abs() > 0.5 - 1e-9;
        let held: Vec<usize> = (0..space.places.len()).filter(|n| rim(space.places[*n])).collect();
        for node in &held {
            (0..2).for_each(|axis| load[2 * node + axis] = exact(space.places[*node])[axis]);
        }
        matrix.fix(&held.iter().flat_map(|node| [2 * node, 2 * node + 1]).collect::<Vec<_>>());
        let u = matrix.factorise().unwrap().solve(load).unwrap();
        let (mut error, mut all) = (0.0, 0.0);
        integral(&mut |point, nodes| {
            for (axis, wanted) in exact(point.place).into_iter().enumerate() {
                let found: f64 = nodes.iter().zip(point.shape.values).map(|(node, v)| v * u[2 * node + axis]).sum();
                error += point.weight * (found - wanted).powi(2);
                all += point.weight * wanted * wanted;
            }
        });
        (error / all).sqrt()
    }

    #[test]
    fn displacements_in_a_stream_converge_with_order_two_on_linear_and_three_on_quadratic_triangles() {
        for (order, wanted) in [(Order::Linear, 2.0), (Order::Quadratic, 3.0)] {
            let errors = [4, 8, 16].map(|n| 100.0 * stream(order, n));
            let orders = [0, 1].map(|i| (errors[i] / errors[i + 1]).log2());
            println!("{order:?}: errors {errors:.2?} %, orders {orders:.2?}");
            assert!((orders[1] - wanted).abs() < 0.15);
        }
    }
}
