//! Invariants of longest-edge refinement.

use wheelrail_thesis::mesh::Mesh;
use wheelrail_thesis::rivara;

/// Rectangle of right triangles, all diagonals of one length: the mesh on which ties must be broken alike from both
/// sides.
fn rectangle(columns: usize, rows: usize, width: f64, height: f64) -> Mesh {
    let mut mesh = Mesh::default();
    for j in 0..=rows {
        for i in 0..=columns {
            mesh.nodes.push([width * i as f64 / columns as f64, height * j as f64 / rows as f64]);
        }
    }
    for j in 0..rows {
        for i in 0..columns {
            let a = j * (columns + 1) + i;
            let (b, c) = (a + 1, a + columns + 1);
            mesh.triangles.extend([[a, b, c], [b, c + 1, c]]);
        }
    }
    mesh
}

/// Pseudo-random numbers in [0, 1).
fn random(seed: &mut u64) -> f64 {
    *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*seed >> 11) as f64 / (1_u64 << 53) as f64
}

#[test]
fn refinement_keeps_meshes_conforming_areas_exact_and_angles_above_half_the_smallest() {
    for seed in 1..=8 {
        let mut random_state = seed;
        let mut mesh = rectangle(6, 4, 1.0, 0.3);
        for (k, node) in mesh.nodes.iter_mut().enumerate() {
            let inside = k % 7 > 0 && k % 7 < 6 && k / 7 > 0 && k / 7 < 4;
            if inside {
                node[0] += 0.08 * (random(&mut random_state) - 0.5);
                node[1] += 0.04 * (random(&mut random_state) - 0.5);
            }
        }
        let (area, angle) = (mesh.area(), mesh.smallest_angle());
        assert!(mesh.is_conforming());
        for _ in 0..12 {
            let marked: Vec<usize> = (0..mesh.triangles.len()).filter(|_| random(&mut random_state) < 0.25).collect();
            rivara::refine(&mut mesh, &marked);
            assert!(mesh.is_conforming(), "{seed}: {} triangles", mesh.triangles.len());
        }
        println!("{} triangles, angle {:.3} of the first", mesh.triangles.len(), mesh.smallest_angle() / angle);
        assert!(mesh.triangles.len() > 1000);
        assert!((mesh.area() / area - 1.0).abs() < 1e-13);
        assert!(mesh.smallest_angle() >= (0.5 - 1e-9) * angle);
    }
}

#[test]
fn meshes_full_of_equal_edges_are_refined_without_end_less_walks() {
    for (columns, rows) in [(1, 1), (2, 2), (30, 6)] {
        let mut mesh = rectangle(columns, rows, columns as f64, rows as f64);
        let count = mesh.triangles.len();
        rivara::refine_all(&mut mesh, 3);
        assert!(mesh.is_conforming());
        // Isosceles right triangles stay of their kind.
        assert!((mesh.smallest_angle().to_degrees() - 45.0).abs() < 1e-9);
        assert!(mesh.triangles.len() >= 8 * count);
    }
}

#[test]
fn every_marked_triangle_is_cut_and_a_target_size_is_reached() {
    let mut mesh = rectangle(30, 6, 1.0, 0.1);
    let near = |corners: &[[f64; 2]; 3]| {
        corners.iter().any(|c| (c[0] - 0.5).hypot(c[1] - 0.1) < 0.01) && rivara::longest(corners) > 1e-3_f64.powi(2)
    };
    rivara::refine_while(&mut mesh, near);
    assert!(mesh.is_conforming());
    assert!((0..mesh.triangles.len()).all(|t| !near(&mesh.corners(t))));
    // Far away nothing has changed.
    assert!(mesh.triangles.len() < 6000, "{}", mesh.triangles.len());
}

#[test]
fn hanging_nodes_and_triangles_inside_out_are_seen() {
    let mut mesh = rectangle(1, 1, 1.0, 1.0);
    assert!(mesh.is_conforming());
    // The diagonal halved on one side only.
    mesh.nodes.push([0.5, 0.5]);
    mesh.triangles[0] = [0, 1, 4];
    mesh.triangles.push([0, 4, 2]);
    assert!(!mesh.is_conforming());
    let mut mesh = rectangle(1, 1, 1.0, 1.0);
    mesh.triangles[0].swap(0, 1);
    assert!(!mesh.is_conforming());
}
