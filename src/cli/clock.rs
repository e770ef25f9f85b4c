//! Times of communication points: the numbers that a person writes.
//!
//! Products in floating point miss them: 9 steps of .001 s are .009000000000000001 s. A step is therefore what its shortest decimal
//! says, or a simple fraction such as a third. The Python package does the same (`wheelrail.times`).

/// Digits of a decimal that a person may have written; a number that is none has more.
const DIGITS: usize = 15;
/// Largest denominator of a fraction that is meant by such a number.
const SIMPLE: f64 = 1e6;

/// Time after `count` steps of `step` \[s].
pub fn time_after(count: usize, step: f64) -> f64 {
    let plain = count as f64 * step;
    if let Some((digits, exponent)) = decimal(step) {
        return format!("{}e{exponent}", digits.saturating_mul(count as i128)).parse().unwrap_or(plain);
    }
    fraction(step).map_or(plain, |[above, below]| count as f64 * above / below)
}

/// Digits and power of ten of a short decimal; `None` of other numbers.
fn decimal(number: f64) -> Option<(i128, i32)> {
    let text = format!("{number:e}");
    let (mantissa, exponent) = text.split_once('e')?;
    let places = mantissa.split_once('.').map_or(0, |(_, behind)| behind.len());
    let digits = mantissa.replace('.', "");
    let short = digits.trim_start_matches('-').len() <= DIGITS;
    Some((digits.parse().ok()?, exponent.parse::<i32>().ok()? - i32::try_from(places).ok()?)).filter(|_| short)
}

/// Numerator and denominator of the simple fraction that a number is, by its continued fraction.
fn fraction(number: f64) -> Option<[f64; 2]> {
    let (mut above, mut below, mut rest) = ([0.0, 1.0], [1.0, 0.0], number);
    loop {
        let whole = rest.floor();
        above = [above[1], whole * above[1] + above[0]];
        below = [below[1], whole * below[1] + below[0]];
        if below[1].is_nan() || below[1] > SIMPLE {
            return None;
        }
        if above[1] / below[1] == number {
            return Some([above[1], below[1]]);
        }
        rest = 1.0 / (rest - whole);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_of_steps_are_the_decimals_that_a_person_writes() {
        let mut mended = 0;
        for (step, places) in [(1e-4, 4), (2e-4, 4), (1e-3, 3), (2.5e-3, 4), (5e-3, 3), (0.01, 2), (0.1, 1), (7e-6, 6)]
        {
            for count in (0..2000).chain([999_999, 1_000_000, 123_456_789]) {
                let written: f64 = format!("{:.places$}", count as f64 * step).parse().unwrap();
                assert_eq!(time_after(count, step), written, "{count} steps of {step}");
                mended += usize::from(count as f64 * step != written);
            }
        }
        println!("{mended} products of floating point are others");
        assert!(mended > 1000);
    }

    #[test]
    fn thirds_add_up_and_other_steps_are_products() {
        assert_eq!([1, 2, 3, 300].map(|count| time_after(count, 1.0 / 3.0)), [1.0 / 3.0, 2.0 / 3.0, 1.0, 100.0]);
        let odd = 1e-3 * std::f64::consts::PI;
        assert_eq!(time_after(7, odd), 7.0 * odd);
        assert!(time_after(2, f64::NAN).is_nan());
    }
}
