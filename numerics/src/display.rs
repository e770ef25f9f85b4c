//! Numbers, their ranges and names like a misspelt one in messages.

/// A number with at most six significant digits, for messages.
pub fn display_number(value: f64) -> String {
    let rounded = format!("{value:.5e}").parse().unwrap_or(value);
    plain(rounded)
}

/// A range in words; infinite bounds are open.
pub fn display_range([min, max]: [f64; 2], unit: &str) -> String {
    let unit = if unit == "1" { String::new() } else { format!(" {unit}") };
    let [low, high] = [min, max].map(display_number);
    match (min.is_finite(), max.is_finite()) {
        (true, true) => format!("{low} to {high}{unit}"),
        (true, false) => format!("finite, at least {low}{unit}"),
        (false, true) => format!("finite, at most {high}{unit}"),
        (false, false) => "finite numbers".to_owned(),
    }
}

/// A number outside the range `bounds`, with as many digits as it takes to see that.
pub fn display_outside(value: f64, bounds: [f64; 2]) -> String {
    let shown = display_number(value);
    if bounds.iter().any(|&bound| display_number(bound) == shown) { plain(value) } else { shown }
}

/// Shortest form that reads back to the same number, with an exponent for large and small ones.
fn plain(value: f64) -> String {
    let ordinary = value == 0.0 || !value.is_finite() || (1e-4..1e6).contains(&value.abs());
    if ordinary { format!("{value}") } else { format!("{value:e}") }
}

/// How many names an error message suggests.
const SUGGESTIONS: usize = 3;

/// The names most like `name`, for messages.
pub fn nearest<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> String {
    let similarity = |candidate: &str| strsim::jaro_winkler(candidate, name).max(tail_similarity(candidate, name));
    let mut near: Vec<_> = candidates.into_iter().map(|candidate| (similarity(candidate), candidate)).collect();
    near.sort_by(|a, b| b.0.total_cmp(&a.0));
    let names: Vec<_> = near.iter().take(SUGGESTIONS).map(|(_, name)| *name).collect();
    names.join(", ")
}

/// Similarity of the last parts of two structured names: who forgets the group still finds the variable.
fn tail_similarity(a: &str, b: &str) -> f64 {
    let tail = |name: &str| name.rsplit('.').next().unwrap_or_default().to_owned();
    0.95 * strsim::normalized_damerau_levenshtein(&tail(a), &tail(b))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_in_messages_are_short_and_show_that_they_are_outside() {
        for (value, text) in [
            (0.0, "0"),
            (-27.777_777_777, "-27.7778"),
            (1e300 / 3.0, "3.33333e299"),
            (200.0, "200"),
            (1e9, "1e9"),
            (1e-5, "1e-5"),
            (f64::NAN, "NaN"),
            (f64::NEG_INFINITY, "-inf"),
        ] {
            assert_eq!(display_number(value), text);
        }
        assert_eq!(display_outside(1.0_f64.next_up(), [0.0, 1.0]), "1.0000000000000002");
        assert_eq!(display_outside(1.123_456_789, [0.0, 1.0]), "1.12346");
    }
}
