//! Meshes of wheel and rail as the thesis builds them, on the dimensions of Paper A.

use wheelrail_thesis::mesh::Mesh;
use wheelrail_thesis::rail::{self, Plate};
use wheelrail_thesis::wheel::{self, Annulus};

const WHEEL: Annulus = Annulus { outer: 0.46, inner: 0.046 };
const PATCH: f64 = 0.01;

/// Nodes of the boundary within half a patch of the contact.
fn across(mesh: &Mesh, depth: impl Fn([f64; 2]) -> f64) -> usize {
    let mut nodes: Vec<usize> = mesh.boundary().into_iter().flat_map(|(a, b)| [a, b]).collect();
    nodes.sort_unstable();
    nodes.dedup();
    nodes.into_iter().map(|n| mesh.nodes[n]).filter(|p| p[0].abs() <= 0.5 * PATCH && depth(*p) < 0.001).count()
}

#[test]
fn the_wheel_is_round_centred_and_fine_where_it_touches() {
    for global in [1, 2, 3] {
        let size = PATCH / 4.0;
        let mesh = wheel::rolling(WHEEL, PATCH, size, global, 0.3).unwrap();
        let (tread, _) = wheel::rims(&mesh, WHEEL);
        let radius = |n: &usize| mesh.nodes[*n][0].hypot(mesh.nodes[*n][1]);
        let roundness = tread.iter().fold(0.0_f64, |worst, n| worst.max((radius(n) / WHEEL.outer - 1.0).abs()));
        let [x, y] = mesh.centroid();
        let count = across(&mesh, |p| p[1] + WHEEL.outer);
        println!(
            "{global} refinements: {} triangles, {} nodes, roundness {roundness:.1e}, centre {:.1e} m, {count} nodes across, \
             smallest angle {:.1} degrees",
            mesh.triangles.len(),
            mesh.nodes.len(),
            x.hypot(y),
            mesh.smallest_angle().to_degrees(),
        );
        assert!(mesh.is_conforming());
        assert!(roundness < 1e-12);
        assert!(x.hypot(y) < 1e-10);
        assert!(count >= 4 && mesh.smallest_angle() > 0.0);
    }
}

#[test]
fn the_hub_moves_a_hundred_times_as_far_as_the_centre_of_gravity_was_off() {
    let rim = Annulus { outer: 0.5, inner: 0.05 };
    let mut mesh = wheel::coarse(&[0.05, 0.1, 0.25, 0.5], 72);
    let near = |corners: &[[f64; 2]; 3]| corners.iter().any(|c| c[1] < -0.4);
    wheelrail_thesis::rivara::refine_while(&mut mesh, |c| near(c) && wheelrail_thesis::rivara::longest(c) > 1e-4);
    wheel::make_round(&mut mesh, rim);
    let before = mesh.centroid();
    let way = wheel::centre(&mut mesh, rim, 0.3).unwrap();
    // A/A_h is 99 for the annulus itself; the polygons of rim and hub differ from their circles.
    let factor = way[1] / before[1];
    println!("centre off by {:.3e} m, hub moved by {:.3e} m: {factor:.1} times", before[1], way[1]);
    assert!((factor / 99.0 - 1.0).abs() < 0.05);
    let [x, y] = mesh.centroid();
    assert!(x.hypot(y) < 1e-10);
    assert!(mesh.is_conforming());
}

#[test]
fn the_rail_is_refined_in_its_box_and_nowhere_else() {
    let plate = Plate { length: 1.0, height: 0.1 };
    let mesh = rail::rolling(plate, 31, PATCH, 0.00375);
    println!("{} triangles, {} nodes", mesh.triangles.len(), mesh.nodes.len());
    assert!(mesh.is_conforming());
    assert!((mesh.area() - 0.1).abs() < 1e-14);
    assert!(across(&mesh, |p| -p[1]) >= 3);
    let far = |t: &usize| mesh.corners(*t).iter().all(|c| c[0].abs() > 0.2);
    let shortest = (0..mesh.triangles.len()).filter(far).map(|t| {
        let c = mesh.corners(t);
        (c[0][0] - c[1][0]).hypot(c[0][1] - c[1][1])
    });
    assert!(shortest.fold(f64::INFINITY, f64::min) > 0.016);
}
