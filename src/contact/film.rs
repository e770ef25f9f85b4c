//! Division of the heat of friction under a molten film that is finer than the elements of the contact.

use crate::piecewise::{Piecewise, interpolate};

/// Mean share within the reach of a place below which there is nothing to divide by \[1].
const VANISHES: f64 = 1e-6;

/// Divides `density`, linear between its places, within the reach of every place as `share` \[1] has it, and replaces
/// `out` by it; the integral of every place's part stays. A place within whose reach the share vanishes keeps its part
/// as it was. `share` is given at its own places and constant beyond them.
pub fn divided(density: &Piecewise, share: &Piecewise, out: &mut Piecewise) {
    let (x, q) = (&density.x, &density.value);
    let share_at = |at: f64| interpolate(&share.x, &share.value, at);
    let elements = || x.windows(2).enumerate().filter(|(_, ends)| ends[1] > ends[0]);
    // Places in an element between which both functions are linear, and how far in it they are.
    let places = |ends: &[f64]| {
        let (a, b) = (ends[0], ends[1]);
        let within = share.x.iter().copied().filter(move |&at| at > a && at < b);
        std::iter::once(a).chain(within).chain(std::iter::once(b)).map(move |at| (at, (at - a) / (b - a)))
    };
    // Integrals of the hats, with the share and without, by the trapezoidal rule between these places.
    let mut weights = vec![[0.0; 2]; x.len()];
    for (e, ends) in elements() {
        let shared = |(at, xi): (f64, f64)| (at, [1.0 - xi, xi].map(|hat| hat * share_at(at)));
        for ((from, before), (to, after)) in places(ends).map(shared).zip(places(ends).map(shared).skip(1)) {
            for k in [0, 1] {
                weights[e + k][0] += 0.5 * (to - from) * (before[k] + after[k]);
            }
        }
        for k in [0, 1] {
            weights[e + k][1] += 0.5 * (ends[1] - ends[0]);
        }
    }
    out.clear();
    for (e, ends) in elements() {
        for (at, xi) in places(ends) {
            let part = |node: usize, hat: f64| {
                let [shared, whole] = weights[node];
                let factor = if shared > VANISHES * whole { share_at(at) * whole / shared } else { 1.0 };
                q[node] * hat * factor
            };
            let value = part(e, 1.0 - xi) + part(e + 1, xi);
            if out.x.last() != Some(&at) || out.value.last() != Some(&value) {
                out.push(at, value);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_divided_keeps_its_integral_and_goes_where_the_share_is() {
        let density = Piecewise { x: vec![0.0, 1.0, 2.0, 3.0], value: vec![0.0, 4.0, 2.0, 0.0] };
        let divided_by = |shares: [f64; 6]| {
            let share = Piecewise { x: vec![0.0, 0.4, 0.9, 1.3, 1.7, 3.0], value: shares.to_vec() };
            let mut out = Piecewise::default();
            divided(&density, &share, &mut out);
            assert!((out.integral() - density.integral()).abs() < 1e-14);
            out
        };
        let even = divided_by([0.5; 6]);
        assert!((0..30).map(|i| 0.1 * f64::from(i)).all(|x| (even.at(x) - density.at(x)).abs() < 1e-14));
        let parted = divided_by([1.0, 1.0, 0.0, 0.0, 1.0, 1.0]);
        assert_eq!([parted.at(0.9), parted.at(1.1), parted.at(1.3)], [0.0; 3]);
        // A place within whose reach nothing is left keeps its part.
        assert_eq!(divided_by([0.0; 6]).at(1.0), 4.0);
    }
}
