//! Search for the friction coefficients that the laws give to the slips of all lines of a contact together.
//!
//! All lines roll on one wheel and displace each other, so that the coefficient of one changes the slips of all. Broyden's
//! method (1965) finds them, which for one line is that of secants: it begins with one slope for each line, from the step
//! before, and every evaluation improves the derivatives along the way it went. Evaluations may be those of a contact that
//! has not settled yet.
//!
//! Where friction falls faster than inertia and elasticity allow within one step, there are several solutions. There a step
//! of Newton's method would lead away from the law; the coefficients then become those of the law. More slip on a line,
//! and so less friction, means more slip on all, so that coefficients which follow the law in this way from above fall to the
//! largest solution and no further: the one that is left of the step before.

use crate::linalg::DenseSystem;

/// Relative difference from the law that ends the search.
const TOLERANCE: f64 = 1e-10;
/// Change of the coefficients over the errors at its ends with which it tells derivatives.
const NOTICED: f64 = 10.0;
/// Longest step over the distance from the laws \[1].
const LONGEST: f64 = 10.0;
/// Slopes that a later search may begin with \[1].
const ORDINARY: std::ops::Range<f64> = 0.1..10.0;

/// The search on all lines of one contact problem.
pub(in crate::contact) struct CoefficientsTogether {
    /// Smallest and largest coefficient of every law.
    bounds: Vec<[f64; 2]>,
    /// Changes of the excess over the law by those of all coefficients, line by line \[1].
    derivatives: Vec<f64>,
    /// The evaluation before: coefficients, their excess over those of the laws, and the error of the contact \[1].
    before: Option<(Vec<f64>, Vec<f64>, f64)>,
    system: DenseSystem,
}

impl CoefficientsTogether {
    /// A search between the bounds of the laws, with the slopes of an earlier one \[1].
    pub fn new(bounds: Vec<[f64; 2]>, slopes: impl Iterator<Item = f64>) -> Self {
        let count = bounds.len();
        let mut derivatives = vec![0.0; count * count];
        for (line, slope) in slopes.enumerate() {
            derivatives[line * (count + 1)] = if ORDINARY.contains(&slope) { slope } else { 1.0 };
        }
        Self { bounds, derivatives, before: None, system: DenseSystem::default() }
    }

    /// Change of the excess of a line by a common change of all coefficients, for a later search \[1].
    pub fn slope(&self, line: usize) -> f64 {
        self.row(line).iter().sum()
    }

    fn row(&self, line: usize) -> &[f64] {
        let count = self.bounds.len();
        &self.derivatives[count * line..][..count]
    }

    /// Better coefficients after `used` gave slips at which the laws give `found`, in a contact with a relative `error`;
    /// `None` where they agree.
    pub fn next(&mut self, used: Vec<f64>, found: &[f64], error: f64) -> Option<Vec<f64>> {
        let excess: Vec<f64> = used.iter().zip(found).map(|(used, found)| used - found).collect();
        let agrees =
            |((used, found), excess): ((&f64, &f64), &f64)| excess.abs() <= TOLERANCE * used.abs().max(found.abs());
        if used.iter().zip(found).zip(&excess).all(agrees) {
            return None;
        }
        let error = error * used.iter().fold(0.0, |most: f64, used| most.max(used.abs()));
        if let Some((other, there, error_there)) = self.before.take() {
            let moved: Vec<f64> = used.iter().zip(&other).map(|(new, old)| new - old).collect();
            if length(&moved) > NOTICED * error.max(error_there) {
                self.learn(&moved, excess.iter().zip(&there).map(|(new, old)| new - old));
            }
        }
        let step = self.step(&excess);
        self.before = Some((used, excess, error));
        let (used, ..) = self.before.as_ref()?;
        let within = |((used, step), [low, high]): ((&f64, f64), &[f64; 2])| (used + step).clamp(*low, *high);
        Some(match step {
            Some(step) => used.iter().zip(step).zip(&self.bounds).map(within).collect(),
            None => found.to_vec(),
        })
    }

    /// Takes the change of the excess along a way.
    fn learn(&mut self, moved: &[f64], change: impl Iterator<Item = f64>) {
        let (count, square) = (moved.len(), moved.iter().map(|moved| moved * moved).sum::<f64>());
        for (row, change) in self.derivatives.chunks_exact_mut(count).zip(change) {
            let expected: f64 = row.iter().zip(moved).map(|(by, moved)| by * moved).sum();
            row.iter_mut().zip(moved).for_each(|(by, moved)| *by += (change - expected) * moved / square);
        }
    }

    /// Step of Newton's method; `None` where it leads away from the laws, or far.
    fn step(&mut self, excess: &[f64]) -> Option<Vec<f64>> {
        let count = excess.len();
        self.system.reset(count);
        for (line, excess) in excess.iter().enumerate() {
            let (coefficients, right) = self.system.row(line);
            coefficients.copy_from_slice(&self.derivatives[count * line..][..count]);
            *right = -excess;
        }
        let step = self.system.solve()?.to_vec();
        let towards: f64 = step.iter().zip(excess).map(|(step, excess)| -step * excess).sum();
        (towards > 0.0 && length(&step) <= LONGEST * length(excess)).then_some(step)
    }
}

/// Length of a vector.
fn length(vector: &[f64]) -> f64 {
    vector.iter().map(|value| value * value).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Coefficients and evaluations until the laws give those that are used, from `start`.
    fn search(start: &[f64], bounds: [f64; 2], laws: impl Fn(&[f64]) -> Vec<f64>) -> (Vec<f64>, usize) {
        let slopes = start.iter().map(|_| 0.0);
        let (mut search, mut used) = (CoefficientsTogether::new(vec![bounds; start.len()], slopes), start.to_vec());
        for count in 1..50 {
            let found = laws(&used);
            match search.next(used.clone(), &found, 0.0) {
                Some(next) => used = next,
                None => return (used, count),
            }
        }
        panic!("no end at {used:?}");
    }

    /// Friction of lines whose slips fall by 8 m/s per unit of their own friction, and by 4 m/s with the mean of all.
    fn coupled(used: &[f64]) -> Vec<f64> {
        let mean = used.iter().sum::<f64>() / used.len() as f64;
        let slip = |(k, mu): (usize, &f64)| (4.0 + 0.1 * k as f64 - 8.0 * mu - 4.0 * mean).max(0.0);
        used.iter().enumerate().map(slip).map(|slip| 0.3 * (0.4 + 0.6 * (-0.6 * slip).exp())).collect()
    }

    #[test]
    fn lines_that_change_each_others_slip_find_their_friction_together() {
        for start in [0.12, 0.2, 0.3] {
            let (mu, count) = search(&[start; 7], [0.12, 0.3], coupled);
            let left = mu.iter().zip(coupled(&mu)).map(|(used, law)| (used - law).abs()).fold(0.0, f64::max);
            println!("from {start}: {mu:?} in {count}, {left:.1e} left");
            assert!(left < 1e-10 && count <= 14);
        }
    }

    #[test]
    fn of_several_solutions_that_below_the_start_is_found_whatever_rounding_says() {
        // Solutions at .15, .2 and .28 on every line.
        let law = |mu: f64| mu - 20.0 * (mu - 0.15) * (mu - 0.2) * (mu - 0.28);
        let laws = |used: &[f64]| used.iter().map(|mu| law(*mu)).collect::<Vec<_>>();
        for rounding in [0.0, 1e-13, -1e-13] {
            let (mu, count) = search(&[0.3, 0.3 + rounding, 0.29], [0.12, 0.35], laws);
            println!("{mu:?} in {count}");
            assert!(mu.iter().all(|mu| (mu - 0.28).abs() < 1e-6));
        }
    }

    #[test]
    fn one_line_is_found_by_secants() {
        let law = |mu: f64| 0.3 * (0.4 + 0.6 * (-0.5 * (mu - 0.2)).exp()).clamp(0.4, 2.0);
        let (mu, count) = search(&[0.3], [0.12, 0.6], |used| vec![law(used[0])]);
        println!("{mu:?} in {count}");
        assert!((mu[0] - law(mu[0])).abs() <= 1e-10 * mu[0] && count <= 8);
    }

    #[test]
    fn laws_that_are_obeyed_already_change_nothing() {
        assert_eq!(search(&[0.3, 0.2], [0.1, 0.4], |used| used.to_vec()), (vec![0.3, 0.2], 1));
    }
}
