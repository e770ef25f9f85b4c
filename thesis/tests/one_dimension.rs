//! The rod in a stream of the introduction, figure 5.1.

use wheelrail_thesis::one_dimension::Rod;
use wheelrail_thesis::stabilise::Scheme;

/// Numbers of the specification, computed independently: error at the nodes over the largest temperature.
#[test]
fn errors_of_three_schemes_are_those_of_the_figure() {
    let rod = Rod::of_the_thesis(200.0);
    let [galerkin, supg, bubble] = Scheme::ALL.map(|scheme| rod.nodal_error(20, scheme));
    println!("Galerkin {galerkin:.4}, SUPG {supg:.1e}, quasi-residual-free bubble {bubble:.4}");
    assert!((galerkin - 0.896).abs() < 0.002);
    assert!(supg < 1e-12);
    assert!((bubble - 0.166).abs() < 0.002);
}

#[test]
fn supg_is_exact_at_the_nodes_for_every_velocity_and_mesh() {
    for velocity in [0.5, 3.0, 40.0, 700.0, 1e5] {
        for elements in [2, 7, 20, 100] {
            let error = Rod::of_the_thesis(velocity).nodal_error(elements, Scheme::Supg);
            assert!(error < 1e-11, "{velocity} {elements}: {error}");
        }
    }
}

#[test]
fn a_condensed_bubble_is_a_node_of_a_finer_mesh_and_converges_with_it() {
    let rod = Rod::of_the_thesis(200.0);
    let errors = [400, 800].map(|elements| rod.nodal_error(elements, Scheme::Bubble));
    let order = (errors[0] / errors[1]).log2();
    println!("order {order:.3}");
    assert!((order - 2.0).abs() < 0.1);
}
