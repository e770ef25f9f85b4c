//! Comparison of a step with the one before.

use crate::heat::state::{BoundaryState, HeatState};

/// Relative change of speeds, conductance or heat from one step to the next that counts as a jump.
const JUMP: f64 = 0.3;
/// Heat whose changes do not count [W/m]: it warms a rolling contact by less than a kelvin.
const SLIGHT_HEAT: f64 = 1e4;
/// Digits after the first of the binary numbers to which shared speeds are rounded: those of speeds that change by less
/// than 0.8 % in a step, and of those that change by less than 3 %.
const SHARED_DIGITS: [u32; 2] = [6, 4];

/// Speeds near the present ones that many steps share: those of the last step, rounded, the more coarsely the faster
/// they change. Where one has changed by more than the coarser rounding does, the present one takes its place.
///
/// They follow from the state, so that a step depends smoothly on its inputs.
pub fn shared_speeds(state: &HeatState, speeds: [f64; 2]) -> [f64; 2] {
    let Some(last) = state.last else { return speeds };
    let shared = |last: f64, speed: f64| {
        let serves = |digits: &u32| (last - speed).abs() <= speed.abs() / f64::from(2 << digits);
        SHARED_DIGITS.into_iter().find(serves).map_or(speed, |digits| rounded(last, digits))
    };
    [0, 1].map(|i| shared(last.speeds[i], speeds[i]))
}

/// The nearest number with this many binary digits after the first.
fn rounded(value: f64, digits: u32) -> f64 {
    let rest = f64::MANTISSA_DIGITS - 1 - digits;
    f64::from_bits((value.to_bits() + (1 << (rest - 1))) >> rest << rest)
}

/// Test that speeds, conductance or heat change so much from `before` to `next` that a step cannot continue smoothly.
pub fn jumps(before: &BoundaryState, next: &BoundaryState) -> bool {
    let jump = |a: f64, b: f64| (a - b).abs() > JUMP * a.abs().max(b.abs());
    let change: f64 = before.heat.iter().zip(&next.heat).map(|(a, b)| (a - b).abs()).sum();
    let larger = before.heat.iter().sum::<f64>().max(next.heat.iter().sum());
    before.speeds.iter().zip(&next.speeds).any(|(a, b)| jump(*a, *b))
        || jump(before.conductance, next.conductance)
        || change > SLIGHT_HEAT + JUMP * larger
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn speeds_that_change_by_two_percent_in_a_step_share_few_inverses() {
        let (mut last, mut used) = (60.0, Vec::new());
        // Down to half and back, twice.
        let factors = [1.0 / 1.02, 1.02, 1.0 / 1.02, 1.02].into_iter().flat_map(|factor| [factor; 35]);
        for factor in factors {
            let boundary = BoundaryState { speeds: [last, 27.0], ..BoundaryState::default() };
            let state = HeatState { last: Some(boundary), ..HeatState::default() };
            let now = last * factor;
            let [shared, steady] = shared_speeds(&state, [now, 27.0]);
            assert!((shared / now - 1.0).abs() <= 1.0 / 16.0 && (steady / 27.0 - 1.0).abs() < 1.0 / 128.0);
            if !used.contains(&shared) {
                used.push(shared);
            }
            last = now;
        }
        println!("{} speeds of 140 steps", used.len());
        assert!(used.len() < 19);
    }

    #[test]
    fn a_speed_that_jumps_or_stands_is_its_own() {
        let boundary = BoundaryState { speeds: [20.0, 0.0], ..BoundaryState::default() };
        let state = HeatState { last: Some(boundary), ..HeatState::default() };
        for speeds in [[22.0, 0.0], [18.0, 0.1], [-20.0, -0.0]] {
            assert_eq!(shared_speeds(&state, speeds), speeds);
        }
        assert_eq!(shared_speeds(&HeatState::default(), [20.0, 1.0]), [20.0, 1.0]);
    }
}
