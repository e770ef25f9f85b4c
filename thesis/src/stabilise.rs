//! Stabilisation of convection: streamline upwinding (\[I] § 5.2.1, \[D] § 5.2.3) and quasi-residual-free bubbles (\[B]
//! Fig. 2).

/// How an element treats convection.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scheme {
    /// Weights equal to the trial functions.
    Galerkin,
    /// Streamline-upwind Petrov–Galerkin.
    Supg,
    /// A further node inside the element, eliminated within it.
    Bubble,
}

impl Scheme {
    /// All of them, in the order of the thesis.
    pub const ALL: [Self; 3] = [Self::Galerkin, Self::Supg, Self::Bubble];
}

/// `coth P − 1/P` of the half Péclet number `P = ρc|v|h/2k` \[1]: share of full upwinding.
///
/// The series takes over where the difference would lose digits.
pub fn upwind(half_peclet: f64) -> f64 {
    if half_peclet.abs() < 1e-2 {
        half_peclet / 3.0 - half_peclet.powi(3) / 45.0 + 2.0 * half_peclet.powi(5) / 945.0
    } else {
        1.0 / half_peclet.tanh() - 1.0 / half_peclet
    }
}

/// Intrinsic time of SUPG, `τ = h/(2ρc|v|) (coth P − 1/P)` [m³ K/W], for the weight `w + τ ρc v·∇w`.
///
/// `length` \[m] along the stream, `capacity` ρc [J/(m³ K)], `speed` [m/s], `conductivity` [W/(m K)]. Without a stream
/// it is the limit `h²/12k`.
pub fn intrinsic_time(length: f64, capacity: f64, speed: f64, conductivity: f64) -> f64 {
    let half_peclet = 0.5 * capacity * speed * length / conductivity;
    if half_peclet == 0.0 {
        return length * length / (12.0 * conductivity);
    }
    0.25 * length * length / conductivity * upwind(half_peclet) / half_peclet
}

/// Half Péclet numbers up to which `coth P ≈ 1/P + P/3` and from which on `coth P ≈ 1` (\[D] § 5.2.3): either changes
/// the share of upwinding by a hundredth at most.
pub const SPLIT: [f64; 2] = [0.38, 2.9];

/// `(ρc|v|)² τ` of SUPG as `a + b |v| + c |v|²` with constants a [W/(m K)], b [J/(m² K)] and c [J s/(m³ K)], where one
/// of the two approximations of \[D] § 5.2.3 holds at all speeds [m/s] from the first to the second; `None` where the
/// half Péclet number comes into the range between them.
pub fn split_time(length: f64, capacity: f64, [slowest, fastest]: [f64; 2], conductivity: f64) -> Option<[f64; 3]> {
    let half_peclet = |speed: f64| 0.5 * capacity * speed * length / conductivity;
    if half_peclet(fastest) <= SPLIT[0] {
        Some([0.0, 0.0, capacity * capacity * length * length / (12.0 * conductivity)])
    } else if half_peclet(slowest) >= SPLIT[1] {
        Some([-conductivity, 0.5 * capacity * length, 0.0])
    } else {
        None
    }
}

/// Length along the stream, `2|v|/Σ|v·∇Nᵢ|` \[m]; `gradients` [1/m] of all shape functions of the element at a place.
/// Those of linear functions give the longest chord through a corner, those of quadratic ones less, the less the nearer
/// to a corner. Zero without a stream.
pub fn stream_length(gradients: &[[f64; 2]], velocity: [f64; 2]) -> f64 {
    let sum: f64 = gradients.iter().map(|g| (g[0] * velocity[0] + g[1] * velocity[1]).abs()).sum();
    if sum == 0.0 { 0.0 } else { 2.0 * velocity[0].hypot(velocity[1]) / sum }
}

/// Place of the bubble's node on its streamline, as share of the way from inflow to outflow: where the exact solution
/// with zero ends is stationary, `ln((e^P − 1)/P)/P` of the full Péclet number `P = ρc|v|h/k` \[1]. ½ without a stream,
/// 1 in a strong one.
pub fn bubble_position(peclet: f64) -> f64 {
    if peclet.abs() < 1e-3 {
        0.5 + peclet / 24.0
    } else {
        1.0 - peclet.ln() / peclet + (-(-peclet).exp()).ln_1p() / peclet
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn upwinding_grows_from_a_third_of_the_peclet_number_to_one() {
        for p in [1e-6, 1e-4] {
            assert!((upwind(p) / (p / 3.0) - 1.0).abs() < 1e-8);
        }
        assert!((upwind(1e6) - (1.0 - 1e-6)).abs() < 1e-12);
        // Series and closed form meet.
        let (below, above) = (upwind(0.01 - 1e-9), upwind(0.01 + 1e-9));
        assert!((above - below - 2e-9 / 3.0).abs() < 1e-13, "{}", above - below);
    }

    #[test]
    fn intrinsic_time_has_both_limits_of_the_thesis() {
        let (h, rho_c, k) = (0.02, 3.68e6, 45.0);
        assert!((intrinsic_time(h, rho_c, 1e-9, k) / (h * h / (12.0 * k)) - 1.0).abs() < 1e-6);
        assert_eq!(intrinsic_time(h, rho_c, 0.0, k), h * h / (12.0 * k));
        let v = 10.0;
        let strong = h / (2.0 * rho_c * v) - k / (rho_c * v).powi(2);
        assert!((intrinsic_time(h, rho_c, v, k) / strong - 1.0).abs() < 1e-12);
    }

    #[test]
    fn both_approximations_are_within_a_hundredth_of_upwinding_and_none_stands_between_them() {
        let (h, rho_c, k) = (0.02, 3.68e6, 45.0);
        let speed = |half_peclet: f64| 2.0 * half_peclet * k / (rho_c * h);
        for p in [1e-6, 0.1, SPLIT[0], SPLIT[1], 10.0, 1e4] {
            let v = speed(p);
            let [a, b, c] = split_time(h, rho_c, [v, v], k).unwrap();
            let exact = intrinsic_time(h, rho_c, v, k) * (rho_c * v).powi(2);
            let off = (a + b * v + c * v * v) / exact - 1.0;
            println!("{p}: {off:.1e}");
            assert!(off.abs() < 0.011);
        }
        // Not where speeds reach from one range into the other, nor in between.
        assert!(split_time(h, rho_c, [speed(0.1), speed(10.0)], k).is_none());
        assert!(split_time(h, rho_c, [speed(1.0), speed(1.0)], k).is_none());
    }

    #[test]
    fn bubble_node_moves_from_the_middle_to_the_outflow() {
        for (p, place) in [(1.0, 0.5413), (10.0, 0.7697), (20.0, 0.8502)] {
            assert!((bubble_position(p) - place).abs() < 5e-5, "{p}: {}", bubble_position(p));
        }
        assert!((bubble_position(0.0) - 0.5).abs() < 1e-15 && (bubble_position(1e6) - 1.0).abs() < 2e-5);
        let (below, above) = (bubble_position(1e-3 - 1e-9), bubble_position(1e-3 + 1e-9));
        assert!((above - below).abs() < 1e-9, "{}", above - below);
    }

    #[test]
    fn length_along_the_stream_is_the_longest_chord_through_a_corner() {
        // Unit right triangle: gradients of its linear functions.
        let gradients = [[-1.0, -1.0], [1.0, 0.0], [0.0, 1.0]];
        assert_eq!(stream_length(&gradients, [3.0, 0.0]), 1.0);
        let diagonal = stream_length(&gradients, [2.0, 2.0]);
        assert!((diagonal - 0.5_f64.sqrt()).abs() < 1e-15, "{diagonal}");
    }
}
