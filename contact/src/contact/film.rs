//! A molten film that is finer than the elements of the contact: what is left of the friction of a node, and what the heat of
//! that would be without the film. With the film at the nodes of the temperatures it heats every place by its own share.

use crate::piecewise::{Piecewise, interpolate};

/// Means of the `share` within the reach of every inner node of `x`, weighted by its hat \[1]: what a force at the node has
/// whose traction has the share at every place. `share` is given at its own places and constant beyond them.
pub fn means(x: &[f64], share: &Piecewise) -> Vec<f64> {
    let mut means: Vec<_> = weights(x, share).into_iter().skip(1).map(|[shared, whole]| shared / whole).collect();
    means.pop();
    means
}

/// Replaces `out` by what the `density` of a film's heat would be without it: every place of the density has the mean of
/// the share within its reach, which is nowhere zero.
pub fn undone(density: &Piecewise, share: &Piecewise, out: &mut Piecewise) {
    out.x.clone_from(&density.x);
    out.value.clear();
    let weights = weights(&density.x, share);
    out.value.extend(density.value.iter().zip(weights).map(|(value, [shared, whole])| match *value {
        0.0 => 0.0,
        value => value * whole / shared,
    }));
}

/// Integrals of the hats of the nodes `x` with the share and without.
fn weights(x: &[f64], share: &Piecewise) -> Vec<[f64; 2]> {
    let mut weights = vec![[0.0; 2]; x.len()];
    for (e, ends) in elements(x) {
        let shared = |(at, xi): (f64, f64)| (at, [1.0 - xi, xi], share_at(share, at));
        let parts = places(ends, share).map(shared).zip(places(ends, share).map(shared).skip(1));
        for ((from, hats, of_from), (to, next_hats, of_to)) in parts {
            for k in [0, 1] {
                let (hat, next) = (hats[k], next_hats[k]);
                weights[e + k][0] +=
                    (to - from) / 6.0 * (hat * (2.0 * of_from + of_to) + next * (of_from + 2.0 * of_to));
                weights[e + k][1] += 0.5 * (to - from) * (hat + next);
            }
        }
    }
    weights
}

/// Elements that are longer than nothing, each with its first node.
fn elements(x: &[f64]) -> impl Iterator<Item = (usize, &[f64])> {
    x.windows(2).enumerate().filter(|(_, ends)| ends[1] > ends[0])
}

/// Places in an element between which its hats and the share are linear, and how far in it they are \[1].
fn places<'a>(ends: &[f64], share: &'a Piecewise) -> impl Iterator<Item = (f64, f64)> + 'a {
    let (a, b) = (ends[0], ends[1]);
    let within = share.x.iter().copied().filter(move |&at| at > a && at < b);
    std::iter::once(a).chain(within).chain(std::iter::once(b)).map(move |at| (at, (at - a) / (b - a)))
}

fn share_at(share: &Piecewise, at: f64) -> f64 {
    interpolate(&share.x, &share.value, at)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Nodes bear the mean of a film that they do not resolve: of a uniform traction the density without the film is uniform.
    #[test]
    fn density_of_nodes_that_bear_the_mean_of_a_film_is_uniform_without_it() {
        let x: Vec<f64> = (0..6).map(f64::from).collect();
        let share = Piecewise { x: vec![0.2, 1.4, 1.9, 2.3, 2.6, 3.1], value: vec![1.0, 0.2, 1e-6, 1e-6, 0.7, 1.0] };
        let borne = means(&x, &share);
        assert!(borne.len() == 4 && borne.iter().all(|mean| (0.01..1.0).contains(mean)), "{borne:?}");
        let density = Piecewise { x, value: [&[0.0], &borne[..], &[0.0]].concat() };
        let mut whole = Piecewise::default();
        undone(&density, &share, &mut whole);
        assert!(whole.value[1..5].iter().all(|value| (value - 1.0).abs() < 1e-14), "{whole:?}");
        assert_eq!([whole.value[0], whole.value[5]], [0.0; 2]);
        // A linear share has the mean of its value at the node of a uniform grid.
        let linear = Piecewise { x: vec![-1.0, 7.0], value: vec![0.0, 0.8] };
        assert!(
            means(&density.x, &linear).iter().zip(1..).all(|(mean, i)| (mean - 0.1 * f64::from(i + 1)).abs() < 1e-15)
        );
    }
}
