//! Speeds of the wheel on the rail as ratios: creepages, slide, spin, and energy per metre.

/// Creepage `2 (V − V_C)/(V + V_C)` of the translational and the peripheral velocity [m/s]: braking positive, 0 at
/// standstill.
///
/// Where wheel and rail move against each other the quotient has a pole (`V_C = −V`) and says nothing; such a wheel
/// slides more than a locked one, and the creepage stays at the value of the locked wheel, 2. The sign is relative to
/// the direction of travel: that of a wheel which spins on the spot changes with it, unlike that of `V − V_C`.
pub fn creepage(v: f64, v_c: f64) -> f64 {
    if at_rest(v, v_c) {
        0.0
    } else if v * v_c < 0.0 {
        2.0
    } else {
        2.0 * (v - v_c) / (v + v_c)
    }
}

/// Slide `(V − V_C)/V` of EN 15595 \[1]: 1 for the locked wheel, 0 at standstill; of a wheel that spins on the spot it
/// is given as if it travelled at the speed [`STANDSTILL`].
pub fn slide(v: f64, v_c: f64) -> f64 {
    if at_rest(v, v_c) { 0.0 } else { (v - v_c) / v.abs().max(STANDSTILL).copysign(v) }
}

/// Dissipated energy per metre travelled \[N] of the dissipated `power` \[W]: 0 at standstill; of a wheel that spins on
/// the spot it is given as if it travelled at the speed [`STANDSTILL`].
pub fn per_metre(power: f64, v: f64, v_c: f64) -> f64 {
    if at_rest(v, v_c) { 0.0 } else { power.max(0.0) / v.abs().max(STANDSTILL) }
}

/// Lateral creepage \[1] of a lateral velocity [m/s], or spin [1/m] of an angular velocity about the normal [rad/s]: over the mean
/// of V and V_C, or half the larger one where they are opposed, 0 at standstill. The sign is relative to the direction of travel.
pub fn over_mean_speed(value: f64, v: f64, v_c: f64) -> f64 {
    let larger = if v.abs() > v_c.abs() { v } else { v_c };
    let sum = if v * v_c < 0.0 { larger } else { v + v_c };
    if at_rest(v, v_c) { 0.0 } else { 2.0 * value / sum }
}

/// The one rule of standstill: the speeds of travel and circumference [m/s] together are below [`STANDSTILL`].
fn at_rest(v: f64, v_c: f64) -> bool {
    v.abs() + v_c.abs() < STANDSTILL
}

/// Peripheral velocity that belongs to a velocity and a creepage above −2: `V_C = V (1 − ξ/2)/(1 + ξ/2)`.
pub fn peripheral_velocity(v: f64, creepage: f64) -> f64 {
    v * (1.0 - 0.5 * creepage) / (1.0 + 0.5 * creepage)
}

/// Sum of translational and peripheral speed below which creepage, slide and the energy per metre are reported as zero
/// [m/s]: a wheel at rest rocks on its elastic contact with some mm/s.
pub const STANDSTILL: f64 = 0.02;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn creepage_is_the_thesis_definition_and_bounded() {
        assert!((creepage(10.0, 9.0) - 2.0 / 19.0).abs() < 1e-15);
        assert!((creepage(-10.0, -9.0) - 2.0 / 19.0).abs() < 1e-15);
        assert_eq!(creepage(10.0, 0.0), 2.0);
        assert_eq!(creepage(0.0, 10.0), -2.0);
        assert_eq!(creepage(0.0, 0.0), 0.0);
        assert!((creepage(13.0, peripheral_velocity(13.0, 3e-4)) - 3e-4).abs() < 1e-15);
    }

    #[test]
    fn creepage_slide_and_energy_per_metre_know_one_standstill() {
        let all =
            |v: f64, v_c: f64| [creepage(v, v_c), slide(v, v_c), per_metre(1e3, v, v_c), over_mean_speed(1.0, v, v_c)];
        for (v, v_c) in
            [(0.0, 0.0), (0.5, 0.49), (-0.9, 0.09), (0.0, -0.99)].map(|(v, c)| (v * STANDSTILL, c * STANDSTILL))
        {
            assert_eq!(all(v, v_c), [0.0; 4]);
        }
        for (v, v_c) in [(0.6, 0.5), (-0.9, 0.2), (0.0, -1.01)].map(|(v, c)| (v * STANDSTILL, c * STANDSTILL)) {
            assert!(all(v, v_c).iter().all(|value| *value != 0.0), "{:?}", all(v, v_c));
        }
        // Locked, the energy per metre is the force; spinning on the spot it stays finite.
        assert_eq!(per_metre(3e4 * 20.0, -20.0, 0.0), 3e4);
        assert_eq!(per_metre(1e3, 0.0, 5.0), 1e3 / STANDSTILL);
        assert_eq!(
            [(10.0, 10.0), (-10.0, -10.0), (10.0, -1.0)].map(|(v, c)| over_mean_speed(0.1, v, c)),
            [0.01, -0.01, 0.02]
        );
    }
}
