//! Search for the friction coefficient that the law gives to the very slip that it causes.
//!
//! The slip depends on the coefficient, the coefficient on the slip: `μ = law(s(μ))`. Whatever the slip, the law stays
//! within its bounds, so that `μ − law(s(μ))` is not positive at the lower and not negative at the upper one: between
//! them lies a solution. Secants find it within a few evaluations; where they leave the bracket, or shrink it too
//! slowly, it is halved, so that steep laws, jumps from slip to stick and long steps converge as well. Friction that
//! falls faster than inertia and elasticity allow within one step has several solutions; the search ends at one near
//! its start.

/// Relative change of the coefficient that ends the search.
const TOLERANCE: f64 = 1e-10;
/// Relative width of the bracket at which the slip jumps rather than varies. Either it jumps between slip and stick; or
/// the states found meanwhile shift the solution by a trifle, beyond an end that was evaluated with others. So the
/// search starts once more from there, and ends where the bracket closes again.
const NARROW: f64 = 1e-13;
/// Evaluations in which secants must halve the bracket.
const PATIENCE: usize = 4;

/// The search in one contact problem.
pub(in crate::contact) struct CoefficientSearch {
    /// Bracket of the solution \[1].
    bracket: [f64; 2],
    /// True for the ends of it that were evaluated. The bounds of the law are solutions themselves where the contact
    /// sticks.
    tried: [bool; 2],
    /// The evaluation before: coefficient, and its excess over that of the law \[1].
    before: Option<[f64; 2]>,
    /// Width of the bracket when secants were last given a chance, and evaluations since.
    width: f64,
    since: usize,
    /// The bounds of the law, until they have been used a second time.
    again: Option<[f64; 2]>,
}

impl CoefficientSearch {
    /// A search between the bounds of the law.
    pub fn new(bracket: [f64; 2]) -> Self {
        let width = bracket[1] - bracket[0];
        Self { bracket, tried: [false; 2], before: None, width, since: 0, again: Some(bracket) }
    }

    /// The coefficient to try next after `used` gave a slip at which the law gives `found`; `None` where both agree.
    pub fn next(&mut self, used: f64, found: f64) -> Option<f64> {
        let excess = used - found;
        if excess.abs() <= TOLERANCE * used.abs().max(found.abs()) {
            return None;
        }
        let side = if excess > 0.0 { 1 } else { 0 };
        (self.bracket[side], self.tried[side]) = (used, true);
        let [low, high] = self.bracket;
        if high - low <= NARROW * high.abs() {
            let again = self.again.take()?;
            *self = Self { again: None, ..Self::new(again) };
            return Some(found);
        }
        let proposal = match self.before.replace([used, excess]) {
            Some([other, excess_there]) => used - excess * (used - other) / (excess - excess_there),
            None => found,
        };
        self.since += 1;
        if self.since > PATIENCE {
            let slow = high - low > 0.5 * self.width;
            (self.width, self.since) = (high - low, 0);
            if slow {
                return Some(0.5 * (low + high));
            }
        }
        Some(match proposal {
            inside if inside > low && inside < high => inside,
            above if above >= high && !self.tried[1] => high,
            below if below <= low && !self.tried[0] => low,
            _ => 0.5 * (low + high),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Coefficient and evaluations until `law(slip(μ)) = μ`.
    fn search(start: f64, bounds: [f64; 2], law: impl Fn(f64) -> f64) -> (f64, usize) {
        let (mut search, mut mu) = (CoefficientSearch::new(bounds), start);
        for count in 1..200 {
            match search.next(mu, law(mu)) {
                Some(next) => mu = next,
                None => return (mu, count),
            }
        }
        panic!("no end at {mu}");
    }

    #[test]
    fn a_solution_that_moves_beyond_an_evaluated_end_is_found_all_the_same() {
        // After four evaluations the slip is that of other states, and the solution a little lower.
        let count = std::cell::Cell::new(0);
        let law = |mu: f64| {
            count.set(count.get() + 1);
            let shift = if count.get() > 4 { 1e-7 } else { 0.0 };
            0.2 + 0.3 * (-5.0 * mu).exp() - shift
        };
        let (mu, evaluations) = search(0.3, [0.1, 0.5], law);
        assert!((mu - 0.2 - 0.3 * (-5.0 * mu).exp() + 1e-7).abs() < 1e-10 && evaluations < 60, "{mu} {evaluations}");
    }

    #[test]
    fn smooth_laws_take_few_evaluations() {
        for gain in [-2.0, -0.5, 0.0, 0.5, 5.0] {
            let law = |mu: f64| 0.3 * (0.4 + 0.6 * (-gain * (mu - 0.2)).exp()).clamp(0.4, 2.0);
            let (mu, count) = search(0.3, [0.12, 0.6], law);
            println!("gain {gain}: {mu} in {count}");
            assert!((mu - law(mu)).abs() <= 1e-10 * mu && count <= 10);
        }
    }

    #[test]
    fn friction_that_falls_faster_than_the_step_allows_still_has_an_answer() {
        // Slip that vanishes above μ = 0.2 and grows by 50 m/s per unit of friction below; Polach's dry law.
        let law = |mu: f64| 0.3 * (0.4 + 0.6 * (-0.6 * (50.0 * (0.2 - mu)).max(0.0)).exp());
        for start in [0.12, 0.15, 0.19, 0.21, 0.3] {
            let (mu, count) = search(start, [0.12, 0.3], law);
            println!("from {start}: {mu} in {count}");
            assert!((mu - law(mu)).abs() <= 1e-10 * mu && count < 60);
        }
    }

    #[test]
    fn a_contact_that_sticks_reaches_the_bound_at_once() {
        let law = |mu: f64| 0.3 * (0.4 + 0.6 * (-0.6 * (50.0 * (0.2 - mu)).max(0.0)).exp());
        let (mu, count) = search(0.25, [0.12, 0.3], law);
        assert_eq!((mu, count), (0.3, 2));
    }

    #[test]
    fn a_jump_of_the_slip_ends_the_search_at_the_jump() {
        let (mu, count) = search(0.3, [0.1, 0.3], |mu| if mu < 0.2345 { 0.3 } else { 0.1 });
        assert!((mu - 0.2345).abs() < 1e-12 && count < 150, "{mu} in {count}");
    }
}
