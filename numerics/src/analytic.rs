//! Closed forms: start guesses, tests and reports.

use std::f64::consts::PI;

/// Contact modulus `E* = E/(2(1 − ν²))` of two bodies of the same material \[Pa] (Johnson, *Contact Mechanics*, 4.2).
pub fn contact_modulus(youngs_modulus: f64, poissons_ratio: f64) -> f64 {
    0.5 * youngs_modulus / (1.0 - poissons_ratio * poissons_ratio)
}

/// Surface of an elastic half-plane in plane strain under line forces (Johnson, *Contact Mechanics* (1985), eqs. 2.25).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HalfPlane {
    /// `κ = 2 (1 − ν²)/(πE)`: a line force displaces the surface along itself by `−κ ln|x|` [m/(N/m)].
    pub kernel: f64,
    /// `g = (1 − 2ν)(1 + ν)/E`: a pressure strains the surface by `−g p` [1/Pa].
    pub coupling: f64,
}

impl HalfPlane {
    /// Displacement `component` (0: x, 1: y) at the distance `x` \[m] from a unit line force in direction `force`, of a
    /// body that lies above its surface (`side` 1) or below it (−1), but for a constant [m/(N/m)].
    pub fn displacement(&self, component: usize, force: usize, x: f64, side: f64) -> f64 {
        match (component, force) {
            (0, 1) => -0.5 * side * self.coupling * x.signum(),
            (1, 0) => 0.5 * side * self.coupling * x.signum(),
            _ => -self.kernel * libm::log(x.abs()),
        }
    }
}

/// Digamma function of a positive number, by its recurrence and its asymptotic series (Abramowitz & Stegun, 6.3.5 and
/// 6.3.18).
pub fn digamma(mut x: f64) -> f64 {
    let mut below = 0.0;
    while x < 10.0 {
        below += 1.0 / x;
        x += 1.0;
    }
    let y = 1.0 / (x * x);
    libm::log(x)
        - 0.5 / x
        - y * (1.0 / 12.0 - y * (1.0 / 120.0 - y * (1.0 / 252.0 - y * (1.0 / 240.0 - y / 132.0))))
        - below
}

/// Half-width of the Hertzian line contact `a = √(4PR/(πE*))` \[m]; `load` [N/m] (Johnson, 4.43).
pub fn hertz_half_width(load: f64, radius: f64, contact_modulus: f64) -> f64 {
    (4.0 * load * radius / (PI * contact_modulus)).sqrt()
}

/// Peak pressure of the Hertzian line contact `p0 = 2P/(πa)` \[Pa] (Johnson, 4.44).
pub fn hertz_peak_pressure(load: f64, half_width: f64) -> f64 {
    2.0 * load / (PI * half_width)
}

/// Load of a Hertzian line contact with that half-width, `P = πE*a²/(4R)` [N/m]; the inverse of [`hertz_half_width`].
pub fn hertz_load(half_width: f64, radius: f64, contact_modulus: f64) -> f64 {
    PI * contact_modulus * half_width * half_width / (4.0 * radius)
}

/// Speed of Rayleigh waves [m/s] from that of shear waves [m/s] (Viktorov, *Rayleigh and Lamb Waves* (1967): 0.5 % for
/// any Poisson's ratio).
pub fn rayleigh_speed(shear_wave_speed: f64, poissons_ratio: f64) -> f64 {
    shear_wave_speed * (0.87 + 1.12 * poissons_ratio) / (1.0 + poissons_ratio)
}

/// Magnitude of the creepage at which Carter's contact slips fully: `μ a/R` for a cylinder on a plane of the same
/// material with half-width `a` (Johnson, 8.3: `ξ = μ a/R · (1 − √(1 − F/μP))`).
pub fn carter_full_slip(friction: f64, half_width: f64, radius: f64) -> f64 {
    friction * half_width / radius
}

/// Carter's force–creepage law `|F|/(μP) = 1 − (1 − |ξ|/ξ_fs)²`, 1 beyond full slip; traction (`ξ < 0`) positive.
pub fn carter_force(creepage: f64, full_slip: f64) -> f64 {
    let rest = (1.0 - creepage.abs() / full_slip).max(0.0);
    -(1.0 - rest * rest).copysign(creepage)
}

/// Growth of the radius \[m] of an annulus in plane strain, fixed at its inner radius, by a temperature with the mean
/// `temperature` \[K] over its area.
///
/// `expansion` is `α (1 + ν)/(1 − ν)` [1/K], Poisson's ratio ν, the radii `outer` and `inner` \[m]. From the radial
/// displacement `u = expansion · m(r)/r + c (r − r_i²/r)` with `m(r) = ∫ T r dr` from `r_i`; free of stress at the rim
/// (Timoshenko & Goodier, *Theory of Elasticity*, 3rd ed., section 150).
pub fn annulus_growth(temperature: f64, expansion: f64, poissons_ratio: f64, outer: f64, inner: f64) -> f64 {
    let (square, inner_square) = (outer * outer, inner * inner);
    let moment = 0.5 * temperature * (square - inner_square);
    let c = expansion * moment / square / (1.0 / (1.0 - 2.0 * poissons_ratio) + inner_square / square);
    expansion * moment / outer + c * (outer - inner_square / outer)
}

/// Lowest torsional vibration of an annulus, see [`hub_torsion`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Torsion {
    /// Natural frequency [rad/s].
    pub frequency: f64,
    /// Share of the moment of inertia about the axle that moves with it \[1].
    pub inertia_share: f64,
    /// Its modal mass referred to the motion of the rim, over the density \[m²]: `∫u² dA/u_rim²`. A force at the rim
    /// meets the mass per width `density · rim_area`.
    pub rim_area: f64,
}

/// Lowest torsional vibration of an annulus in plane strain, held at its inner radius, free at the outer one; radii in
/// \[m], the inner one at most 0.9 of the outer one, speed of shear waves `c_S` in [m/s].
///
/// The tangential displacement `C₁(kr) = J₁(kr) Y₁(k r_i) − Y₁(kr) J₁(k r_i)` vanishes at the hub; the rim is free of
/// shear stress where `C₂(k r_o) = 0`; the frequency is `k c_S` (Love, *Mathematical Theory of Elasticity*, 4th ed.,
/// section 200, for the solid cylinder). `inertia_share` is `(∫ C₁ r² dr)²/(∫ C₁² r dr ∫ r³ dr)`, in closed form with
/// `C₂(k r_i) = 2/(π k r_i)`.
pub fn hub_torsion(outer: f64, inner: f64, shear_wave_speed: f64) -> Torsion {
    let combination = |order: i32, k: f64, r: f64| {
        bessel_j(order, k * r) * bessel_y(1, k * inner) - bessel_y(order, k * r) * bessel_j(1, k * inner)
    };
    // Positive below the lowest root, which lies at `√8 r_i/r_o²` for a small hub and higher for a large one.
    let step = 0.01 * inner / (outer * outer);
    let mut high = step;
    while combination(2, high, outer) > 0.0 {
        high += step;
    }
    let mut low = high - step;
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if combination(2, middle, outer) > 0.0 { low = middle } else { high = middle }
    }
    let at_hub = 2.0 / (PI * low * inner);
    let (square, inner_square) = (outer * outer, inner * inner);
    let momentum = inner_square * at_hub / low;
    let rim = combination(1, low, outer);
    let norm = 0.5 * (square * rim * rim - inner_square * at_hub * at_hub);
    let inertia = 0.25 * (square * square - inner_square * inner_square);
    Torsion {
        frequency: low * shear_wave_speed,
        inertia_share: momentum * momentum / (norm * inertia),
        rim_area: 2.0 * PI * norm / (rim * rim),
    }
}

/// Terms of the power series of Bessel functions, enough for arguments up to 20.
const TERMS: i32 = 60;
/// Euler's constant γ.
const EULER: f64 = 0.577_215_664_901_532_9;

/// Bessel function of the first kind and of integer order, `J_n(x)` (DLMF 10.2.2).
fn bessel_j(order: i32, x: f64) -> f64 {
    let half = 0.5 * x;
    let mut term = (1..=order).fold(1.0, |term, k| term * half / f64::from(k));
    let mut sum = term;
    for k in 1..TERMS {
        term *= -half * half / (f64::from(k) * f64::from(k + order));
        sum += term;
    }
    sum
}

/// Bessel function of the second kind, `Y_n(x)`, `n` = 0, 1 or 2 (DLMF 10.8.1, 10.6.1).
fn bessel_y(order: i32, x: f64) -> f64 {
    if order == 2 {
        return 2.0 / x * bessel_y(1, x) - bessel_y(0, x);
    }
    let half = 0.5 * x;
    let mut term = (1..=order).fold(1.0, |term, k| term * half / f64::from(k));
    // ψ(k + 1) + ψ(k + n + 1) for k = 0.
    let mut digammas = -2.0 * EULER + (1..=order).map(|k| 1.0 / f64::from(k)).sum::<f64>();
    let mut sum = digammas * term;
    for k in 1..TERMS {
        term *= -half * half / (f64::from(k) * f64::from(k + order));
        digammas += 1.0 / f64::from(k) + 1.0 / f64::from(k + order);
        sum += digammas * term;
    }
    let singular = if order == 1 { 1.0 / half } else { 0.0 };
    (2.0 * libm::log(half) * bessel_j(order, x) - sum - singular) / PI
}

/// Temperature rise \[K] of the surface of a half-space at `x` \[m] under the flux `flux` [W/m²] on `|x| ≤ half_width`
/// that moves fast towards +x with `speed` [m/s]; `effusivity` is `√(k ρc)` [W s^½/(m² K)].
///
/// `T(x) = 1/√(π k ρc V) ∫ₓ^a q(x′)/√(x′ − x) dx′`, the limit of large Péclet number (Jaeger 1942; Carslaw & Jaeger,
/// *Conduction of Heat in Solids*, 2nd ed., 10.7).
pub fn moving_source(x: f64, half_width: f64, speed: f64, effusivity: f64, flux: &dyn Fn(f64) -> f64) -> f64 {
    const POINTS: i32 = 2000;
    // x′ = x + t², t from the trailing edge or x to the leading edge; the cosine smooths the edges of the flux.
    let (low, high) = ((-half_width - x).max(0.0).sqrt(), (half_width - x).max(0.0).sqrt());
    let part = |i: i32| {
        let angle = PI * (f64::from(i) + 0.5) / f64::from(POINTS);
        let t = 0.5 * (low + high) - 0.5 * (high - low) * libm::cos(angle);
        flux(x + t * t) * libm::sin(angle)
    };
    let integral = 0.5 * (high - low) * PI / f64::from(POINTS) * (0..POINTS).map(part).sum::<f64>();
    2.0 * integral / (effusivity * (PI * speed).sqrt())
}

/// Flash temperature: largest [`moving_source`] \[K] of the heat `heat` [W/m] spread like a Hertzian pressure (Blok
/// 1937).
pub fn flash_temperature(heat: f64, half_width: f64, speed: f64, effusivity: f64) -> f64 {
    let flux = |x: f64| 2.0 * heat / (PI * half_width) * (1.0 - (x / half_width).powi(2)).max(0.0).sqrt();
    let rise = |share: f64| moving_source(share * half_width, half_width, speed, effusivity, &flux);
    // One maximum, between the leading and the trailing edge: ternary search.
    let (mut low, mut high) = (-1.0, 1.0);
    for _ in 0..40 {
        let third = (high - low) / 3.0;
        if rise(low + third) < rise(high - third) { low += third } else { high -= third }
    }
    rise(0.5 * (low + high))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Abramowitz & Stegun, tables 9.1, 9.2 and 9.5 (zeros).
    #[test]
    fn bessel_functions_are_the_tabulated_ones() {
        let known = [
            (bessel_j(0, 1.0), 0.765_197_686_557_966_6),
            (bessel_j(1, 1.0), 0.440_050_585_744_933_5),
            (bessel_j(2, 1.0), 0.114_903_484_931_900_5),
            (bessel_y(0, 1.0), 0.088_256_964_215_676_96),
            (bessel_y(1, 1.0), -0.781_212_821_300_288_7),
            (bessel_y(2, 1.0), -1.650_682_606_816_254_4),
        ];
        for (found, exact) in known {
            assert!((found - exact).abs() < 1e-14, "{found} for {exact}");
        }
        assert!(bessel_j(1, 3.831_705_970_207_512).abs() < 1e-14 && bessel_y(1, 2.197_141_326_031_017).abs() < 1e-14);
        // Wronskian.
        for x in [0.03_f64, 0.3, 3.0, 15.0] {
            let wronskian = bessel_j(2, x) * bessel_y(1, x) - bessel_j(1, x) * bessel_y(2, x);
            assert!((wronskian * 0.5 * PI * x - 1.0).abs() < 1e-7, "{x}: {wronskian}");
        }
    }

    /// The equation of the shape itself, `R″ + R′/r − R/r² + k² R = 0` from the hub outwards (Runge–Kutta), with the
    /// integrals of the inertia share along it.
    #[test]
    fn torsion_on_the_hub_leaves_the_rim_free_of_stress() {
        for inner in [0.02, 0.1, 0.5, 0.9] {
            let torsion = hub_torsion(1.0, inner, 3000.0);
            let square = (torsion.frequency / 3000.0).powi(2);
            // R, R′, ∫ R r² dr, ∫ R² r dr, and their slopes.
            let slope = |r: f64, [u, v, ..]: [f64; 4]| [v, -v / r + u / (r * r) - square * u, u * r * r, u * u * r];
            let (n, mut y) = (4000, [0.0, 1.0, 0.0, 0.0]);
            let h = (1.0 - inner) / f64::from(n);
            let along = |y: [f64; 4], k: [f64; 4], h: f64| std::array::from_fn(|i| y[i] + h * k[i]);
            for i in 0..n {
                let r = inner + h * f64::from(i);
                let k1 = slope(r, y);
                let k2 = slope(r + 0.5 * h, along(y, k1, 0.5 * h));
                let k3 = slope(r + 0.5 * h, along(y, k2, 0.5 * h));
                let k4 = slope(r + h, along(y, k3, h));
                y = std::array::from_fn(|j| y[j] + h / 6.0 * (k1[j] + 2.0 * (k2[j] + k3[j]) + k4[j]));
            }
            let [u, v, momentum, norm] = y;
            // Stress at the rim against that at the hub, μ R′ = μ.
            assert!((v - u).abs() < 1e-7, "stress {:e} with hub {inner}", v - u);
            assert!(u > 0.0 && momentum > 0.0, "the lowest shape has no node");
            let share = momentum * momentum / (norm * 0.25 * (1.0 - inner.powi(4)));
            assert!((torsion.inertia_share / share - 1.0).abs() < 1e-7, "{torsion:?} against {share}");
            let area = 2.0 * PI * norm / (u * u);
            assert!((torsion.rim_area / area - 1.0).abs() < 1e-7, "{torsion:?} against {area}");
        }
        // A rigid disc on a small hub: stiffness 4πμ r_i² over the inertia ½πρ r_o⁴.
        let disc = hub_torsion(1.0, 0.01, 3000.0);
        assert!((disc.frequency / (8.0_f64.sqrt() * 0.01 * 3000.0) - 1.0).abs() < 1e-3, "{disc:?}");
    }

    #[test]
    fn a_uniform_moving_source_is_hottest_at_its_trailing_edge() {
        // T(−a) = 2 q √(2a/(π V))/e, Jaeger's maximum.
        let (a, speed, effusivity, flux) = (1e-3, 20.0, 1.3e4, 1e8);
        let rise = |x: f64| moving_source(x, a, speed, effusivity, &|_| flux);
        let exact = 2.0 * flux * (2.0 * a / (PI * speed)).sqrt() / effusivity;
        assert!((rise(-a) / exact - 1.0).abs() < 1e-6 && rise(-0.9 * a) < rise(-a) && rise(-1.1 * a) < rise(-a));
    }

    /// Rim of a uniformly heated annulus: `σ_r = (λ + 2μ) u′ + λ u/r − (3λ + 2μ) α T = 0` with `u(r_i) = 0`.
    #[test]
    fn rim_of_the_heated_annulus_is_free_of_stress() {
        let (nu, alpha, temperature, outer, inner) = (0.3, 1.2e-5, 50.0, 0.46, 0.2);
        let (lame, shear) = (nu / ((1.0 + nu) * (1.0 - 2.0 * nu)), 0.5 / (1.0 + nu));
        let expansion = alpha * (1.0 + nu) / (1.0 - nu);
        let growth = annulus_growth(temperature, expansion, nu, outer, inner);
        // u = A r + B/r with the equilibrium of a uniform temperature, and u(r_i) = 0.
        let a = growth * outer / (outer * outer - inner * inner);
        let b = -a * inner * inner;
        let slope = a - b / (outer * outer);
        let thermal = (3.0 * lame + 2.0 * shear) * alpha * temperature;
        let stress = (lame + 2.0 * shear) * slope + lame * growth / outer - thermal;
        assert!(stress.abs() < 1e-12 * thermal, "{stress:e} against {thermal:e}");
    }

    #[test]
    fn digamma_has_its_known_values() {
        const EULER: f64 = 0.577_215_664_901_532_9;
        assert!((digamma(0.5) + EULER + 2.0 * 2f64.ln()).abs() < 1e-13);
        assert!((digamma(1.0) + EULER).abs() < 1e-13);
        assert!((digamma(30.5) - digamma(29.5) - 1.0 / 29.5).abs() < 1e-13);
    }
}
