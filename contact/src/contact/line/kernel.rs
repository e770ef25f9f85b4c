//! Flexibility of a line for itself on the nodes of a grid: the discrete kernel `1/(n + ½)`, to which the
//! edge-consistent slip rows belong (see [`super::streamline`]).

use crate::analytic::digamma;
use nalgebra::DMatrix;

/// Logarithms of the distances of `nodes` over 1 m, with their signs reversed \[1]; `spacing` is the distance of the
/// nodes in the middle \[m]. At neighbouring nodes their differences are those of the discrete kernel `1/(n + ½)`, so that
/// they are `−ln h − ψ(n + ½)` with the digamma function ψ, the number n of cells between two nodes and their mean length
/// h. Beyond the middle, where cells grow, h is that of the nodes at hand: with the spacing of the middle a node would
/// give way by its own force the more, the longer its cells are.
pub fn logarithms(nodes: &[f64], spacing: f64) -> DMatrix<f64> {
    let cells: Vec<f64> = nodes.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let width = |i: usize| {
        let beside = [i.checked_sub(1), Some(i)].map(|at| at.and_then(|at| cells.get(at)).copied());
        0.5 * (beside[0].or(beside[1]).unwrap_or(spacing) + beside[1].or(beside[0]).unwrap_or(spacing))
    };
    // `ψ(n + ½) − ln n`, and `ψ(½)`.
    let discrete = |apart: usize| digamma(apart as f64 + 0.5) - libm::log(apart.max(1) as f64);
    let discrete: Vec<f64> = (0..nodes.len()).map(discrete).collect();
    DMatrix::from_fn(nodes.len(), nodes.len(), |i, j| {
        let distance = if i == j { width(i) } else { (nodes[i] - nodes[j]).abs() };
        -libm::log(distance) - discrete[i.abs_diff(j)]
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::kernel::Logarithm;

    #[test]
    fn a_line_is_displaced_as_the_half_plane_far_from_its_force_and_by_the_discrete_kernel_beside_it() {
        let along = Logarithm { factor: 2.0, reach: 0.03_f64.ln() };
        let h = 1e-4;
        let nodes: Vec<f64> = (0..200).map(|i| h * f64::from(i)).collect();
        let logarithms = logarithms(&nodes, h);
        let at = |n: usize| along.displacement(logarithms[(n, 0)]);
        assert!((at(0) - at(1) - 4.0).abs() < 1e-12 && (at(3) - at(4) - 2.0 / 3.5).abs() < 1e-12);
        assert!((at(150) + 2.0 * (0.015f64 / 0.03).ln()).abs() < 1e-5);
    }

    /// A constant pressure on nodes that are five times as far apart at the ends as in the middle, against its integral
    /// `∫ ln(L/|x − s|) ds`: to 0.3 % of the smallest displacement, as with equal cells of the largest size.
    #[test]
    fn nodes_of_growing_distance_are_displaced_as_the_half_plane_under_a_pressure() {
        let (h, reach) = (1e-4, 0.03_f64);
        let along = Logarithm { factor: 1.0, reach: reach.ln() };
        let mut half = vec![0.0];
        for k in 0..90 {
            let last = half[half.len() - 1];
            half.push(last + h * (1.0 + 0.1 * f64::from((k - 40).max(0))).min(5.0));
        }
        let nodes: Vec<f64> = half[1..].iter().rev().map(|x| -x).chain(half.iter().copied()).collect();
        let logarithms = logarithms(&nodes, h);
        let inner = 1..nodes.len() - 1;
        let [low, high] = [0, nodes.len() - 2].map(|i| 0.5 * (nodes[i] + nodes[i + 1]));
        let part = |s: f64| if s == 0.0 { 0.0 } else { s * (1.0 - (s.abs() / reach).ln()) };
        let mut worst = 0.0_f64;
        for i in inner.clone() {
            let by = |j: usize| 0.5 * (nodes[j + 1] - nodes[j - 1]) * along.displacement(logarithms[(i, j)]);
            let (found, expected) = (inner.clone().map(by).sum::<f64>(), part(high - nodes[i]) - part(low - nodes[i]));
            worst = worst.max((found / expected - 1.0).abs());
        }
        assert!(worst < 3e-3, "{worst}");
        assert_eq!(logarithms, logarithms.transpose());
    }
}
