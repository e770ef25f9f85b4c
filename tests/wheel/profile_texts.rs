//! Texts and files of profiles that somebody mistyped: never a panic, never a surface without heights.

use crate::common::Random;
use std::path::Path;
use wheelrail::surface::{Body, Profile};

const TEXTS: [&str; 8] = [
    "sinusoid(amplitude = 5e-6, wavelength = 0.05, phase = 1.5) + hole(position = 2, length = 5e-3, depth = 1e-3)",
    "joint(position = 1.5, angle = 0.02, length = 1, gap = 6e-3)",
    "squat(position = 3, length = 0.04, depth = 2e-4) + roughness(spectrum = EN_ISO_3095, seed = 7, from = 0.2, blend = 0.1)",
    "hole(position = 2, length = 5e-3, depth = 1e-3, every = 0.05, count = 1000)",
    "roughness(levels = [9, 7, 4.9, 2.9], longest = 0.16, seed = 3, length = 20)",
    "flat(length = 0.04) + flat(position = 1, length = 0.02, shape = rounded)",
    "polygon(order = 18, amplitude = 1e-5, phase = 0.3)",
    "step(height = -1e-4, position = 0.5, length = 0.1) + file(\"rail.csv\", factor = 2, every = 3)",
];
const PIECES: [&str; 34] = [
    "(",
    ")",
    "[",
    "]",
    "+",
    "-",
    "=",
    ",",
    "\"",
    ".",
    " ",
    "e",
    "1e309",
    "-1e308",
    "1e-320",
    "nan",
    "inf",
    "0",
    "-0",
    "ü",
    "\u{0}",
    "\n",
    "hole",
    "step(",
    "flat(length = ",
    "position",
    "levels = [",
    "seed = ",
    "every = 1e-9",
    "count = 1e18",
    "EN_ISO_3095",
    "rounded",
    ".csv",
    "roughness(longest = 1e9, shortest = 1e-9, spectrum = EN_ISO_3095)",
];

/// Cut, with a piece put in or in the place of another, or with another text behind it; some changes one after the
/// other.
fn mistyped(random: &mut Random) -> String {
    let mut text: Vec<char> = random.of(&TEXTS).chars().collect();
    for _ in 0..=random.below(3) {
        let numbers: Vec<usize> = (0..text.len()).filter(|&i| text[i].is_ascii_digit()).collect();
        if !numbers.is_empty() && random.below(2) == 0 {
            text[random.of(&numbers)] = char::from(b'0' + random.below(10) as u8);
            continue;
        }
        let at = random.below(text.len() + 1);
        let end = (at + random.below(12)).min(text.len());
        match random.below(4) {
            0 => drop(text.drain(at..end)),
            1 => drop(text.splice(at..at, random.of(&PIECES).chars())),
            2 => drop(text.splice(at..end, random.of(&PIECES).chars())),
            _ => drop(text.splice(at.., random.of(&TEXTS).chars().skip(random.below(40)))),
        }
    }
    text.into_iter().collect()
}

#[test]
fn two_thousand_mistyped_profiles_are_surfaces_or_refused_by_name() {
    let mut random = Random(5);
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    std::fs::write(folder.join("rail.csv"), "position,height\n0,0\n1,1e-5\n2,0\n").unwrap();
    let (mut surfaces, mut refused) = (0, 0);
    for _ in 0..2_000 {
        let text = mistyped(&mut random);
        for body in [Body::Rail, Body::Wheel { radius: 0.46 }] {
            match Profile::parse(&text, Some(folder), body) {
                Ok(profile) => {
                    surfaces += 1;
                    for s in [-3.0, 0.0, 0.499, 2.0, 1e4] {
                        assert!(profile.height(s).is_finite(), "{text}: {} at {s}", profile.height(s));
                    }
                    assert!(profile.shortest_wavelength_between(-9.0, 9.0) > 0.0, "{text}");
                }
                Err(error) => {
                    refused += 1;
                    assert!(error.to_string().starts_with("profile"), "{text}: {error}");
                }
            }
        }
    }
    println!("{surfaces} surfaces, {refused} refused");
    assert!(surfaces > 250 && refused > 2000, "{surfaces} {refused}");
}

/// The cost of a text is bounded before anything is computed: by its length, and by the samples of all its roughness.
#[test]
fn texts_that_would_take_long_are_refused_by_name() {
    let rough = "roughness(spectrum = EN_ISO_3095, shortest = 8e-4, length = 50)";
    let refusal = |text: &str| Profile::parse(text, None, Body::Rail).unwrap_err().to_string();
    assert!(Profile::parse(rough, None, Body::Rail).is_ok());
    let (many, endless) = ([rough; 2].join(" + "), ["hole(length = 1, depth = 1e-3)"; 1000].join(" + "));
    assert!(refusal(&many).contains("shortest") && refusal(&many).contains("for all roughness"), "{}", refusal(&many));
    assert!(refusal(&endless).contains("column 20001") && refusal(&endless).contains(".csv"), "{}", refusal(&endless));
    let names: String = (0..1500).map(|k| format!("a{k} = 1, ")).collect();
    assert!(refusal(&format!("hole({names}length = 1)")).contains("needs depth"));
}

#[test]
fn three_thousand_damaged_files_are_surfaces_or_refused_by_line() {
    let mut random = Random(6);
    let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join("damaged.csv");
    let good: String = (0..30).map(|k| format!("{:?},{:?}\n", 0.1 * f64::from(k), 1e-6 * f64::from(k % 7))).collect();
    let pieces =
        ["", ",", "\n", "\n\n", "nan", "-inf", "1e400", "0", "-1", "\"", "position,height\n", "\u{feff}", ";", "x"];
    let (mut surfaces, mut refused) = (0, 0);
    for _ in 0..3000 {
        let mut bytes = format!("position,height\n{good}").into_bytes();
        for _ in 0..=random.below(3) {
            let at = random.below(bytes.len());
            let end = (at + random.below(6)).min(bytes.len());
            match random.below(3) {
                0 => drop(bytes.splice(at..end, random.of(&pieces).bytes())),
                1 => bytes[at] = random.below(256) as u8,
                _ => bytes.truncate(at + 1),
            }
        }
        std::fs::write(&file, &bytes).unwrap();
        match Profile::parse(file.to_str().unwrap(), None, Body::Rail) {
            Ok(profile) => {
                surfaces += 1;
                assert!([-1.0, 0.05, 1.0, 9.0].iter().all(|&s| profile.height(s).is_finite()));
            }
            Err(error) => {
                refused += 1;
                assert!(error.to_string().contains("damaged.csv"), "{error}");
            }
        }
    }
    println!("{surfaces} surfaces, {refused} refused");
    assert!(surfaces > 100 && refused > 500);
}

/// Reads a profile of the rail from `file.csv` with this text.
fn read(name: &str, text: &str, profile: &str) -> Result<Profile, String> {
    let folder = std::env::temp_dir().join(format!("wheelrail-ends-{}-{name}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::write(folder.join("file.csv"), text).unwrap();
    let result = Profile::parse(profile, Some(&folder), Body::Rail).map_err(|error| error.to_string());
    std::fs::remove_dir_all(&folder).unwrap();
    result
}

#[test]
fn a_repeated_file_closes_where_its_ends_differ_by_rounding_and_is_refused_in_short_numbers_where_they_differ() {
    let repeated = |name: &str, last: &str, end: &str| {
        read(name, &format!("position,height\n0,0\n1,1e-5\n{last},{end}\n"), "file(\"file.csv\", every = 2)")
    };
    for (name, last, end) in [
        ("sine", "2", "-2.4e-22"),
        ("digits", "2", "4e-10"),
        ("share", "2", "1e-9"),
        ("longer", "2.0000000000000004", "0"),
        ("shorter", "1.9999999999", "0"),
    ] {
        let profile = repeated(name, last, end).unwrap();
        for (x, height) in [(2.0, 0.0), (4.5, 5e-6), (7.0, 1e-5)] {
            assert!((profile.height(x) - height).abs() < 1e-14, "{name}: {:e} at {x}", profile.height(x));
        }
        assert!((profile.shortest_wavelength_between(0.0, 3.0) - 2.0).abs() < 1e-9);
    }
    for (name, last, end, word) in
        [("step", "2", "1.234567891234e-6", "1.23457e-6 m as the first, 0 m"), ("long", "2.1", "0", "2.1")]
    {
        let message = repeated(name, last, end).unwrap_err();
        assert!(message.contains("every = 2 m") && message.contains(word), "{message}");
    }
}
