//! Carter's tractions on a wheel of Papers B to D.

use super::mesh_heat::half_width;
use crate::annulus::OUTER;
use wheelrail::analytic::{carter_force, carter_full_slip, hertz_peak_pressure};

/// End of the slip zone \[m] for a load [N/m]: from there to the front the contact sticks.
pub(super) fn slip_end(creepage: f64, friction: f64, load: f64) -> f64 {
    let a = half_width(load);
    let share = carter_force(creepage, carter_full_slip(friction, a, OUTER)).abs();
    a * (1.0 - 2.0 * (1.0 - share).sqrt())
}

/// Traction \[Pa] at x \[m], positive for a driven wheel.
pub(super) fn traction(x: f64, creepage: f64, friction: f64, load: f64) -> f64 {
    let a = half_width(load);
    let peak = friction * hertz_peak_pressure(load, a);
    let end = slip_end(creepage, friction, load);
    let (half, middle) = (0.5 * (a - end), 0.5 * (a + end));
    let root = |value: f64| value.max(0.0).sqrt();
    peak * (root(1.0 - (x / a).powi(2)) - half / a * root(1.0 - ((x - middle) / half).powi(2)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// In steps fine enough for the roots at its ends.
    #[test]
    fn tractions_add_up_to_the_force_of_the_law() {
        let (load, friction) = (100e3, 0.4);
        let a = half_width(load);
        for creepage in [-1e-4, -4e-4, -9e-4] {
            let step = a / 1e5;
            let sum: f64 =
                (0..200_000).map(|i| traction((f64::from(i) + 0.5) * step - a, creepage, friction, load)).sum();
            let law = carter_force(creepage, carter_full_slip(friction, a, OUTER)) * friction * load;
            assert!((sum * step / law - 1.0).abs() < 1e-5, "{creepage}: {} {law}", sum * step);
        }
    }
}
