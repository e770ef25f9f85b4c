//! Features against their formulas, repetition, spectra returned, and profiles that are refused.

use super::*;
use std::f64::consts::{PI, TAU};

const RADIUS: f64 = 0.46;
const WHEEL: Body = Body::Wheel { radius: RADIUS };
const TURN: f64 = TAU * RADIUS;

fn rail(text: &str) -> Profile {
    Profile::parse(text, None, Body::Rail).unwrap()
}

fn wheel(text: &str) -> Profile {
    Profile::parse(text, None, WHEEL).unwrap()
}

/// A file of samples in a folder of its own.
fn with_file<T>(name: &str, text: &str, use_it: impl Fn(&Path) -> T) -> T {
    let folder = std::env::temp_dir().join(format!("wheelrail-profile-{}-{name}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::write(folder.join("profile.csv"), text).unwrap();
    let result = use_it(&folder);
    std::fs::remove_dir_all(&folder).unwrap();
    result
}

/// Compares heights with a formula.
fn agrees(profile: &Profile, positions: &[f64], formula: impl Fn(f64) -> f64, tolerance: f64) {
    for &x in positions {
        assert!((profile.height(x) - formula(x)).abs() < tolerance, "{x}: {} {}", profile.height(x), formula(x));
    }
}

#[test]
fn nothing_is_smooth() {
    for text in ["", "  \n"] {
        let smooth = rail(text);
        assert!(smooth.is_smooth() && smooth == Profile::default());
        assert_eq!((smooth.height(3.0), smooth.shortest_wavelength_between(-1e9, 1e9)), (0.0, f64::INFINITY));
    }
    assert!(!rail("hole(length = 1e-3, depth = 0)").is_smooth());
}

#[test]
fn features_add_up() {
    let profile = rail(
        "sinusoid(amplitude = 5e-6, wavelength = 0.05) + sinusoid(amplitude = 2e-6, wavelength = 0.03, phase = 1)\n\
         + hole(position = 2, length = 5e-3, depth = 1e-3)",
    );
    let waves = |x: f64| 5e-6 * (TAU * x / 0.05).sin() + 2e-6 * (TAU * x / 0.03 + 1.0).sin();
    let sum = |x: f64| waves(x) - if (x - 2.0).abs() <= 2.5e-3 { 1e-3 } else { 0.0 };
    agrees(&profile, &[-7.3, 0.0, 0.0125, 1.997, 1.998, 2.0024, 2.003, 40.0], sum, 1e-15);
    assert_eq!(profile.shortest_wavelength_between(1.0, 1.9974), 0.03);
    assert_eq!(profile.shortest_wavelength_between(1.0, 1.9976), 0.01);
}

#[test]
fn shapes_on_the_rail_are_those_of_their_formulas() {
    agrees(
        &rail("squat(position = 1, length = 0.04, depth = 2e-4)"),
        &[0.97, 0.985, 1.0, 1.013, 1.03],
        |x| {
            if (x - 1.0).abs() < 0.02 { -2e-4 * (PI * (x - 1.0) / 0.04).cos().powi(2) } else { 0.0 }
        },
        1e-18,
    );
    agrees(
        &rail("step(position = 0.5, height = 1e-4)"),
        &[-1.0, 0.49, 0.51, 1e6],
        |x| {
            if x >= 0.5 { 1e-4 } else { 0.0 }
        },
        1e-18,
    );
    let bump = rail("step(position = 0.5, height = 1e-4, length = 0.2)");
    assert_eq!([0.49, 0.51, 0.69, 0.71].map(|x| bump.height(x)), [0.0, 1e-4, 1e-4, 0.0]);
    // The ends of a dipped joint meet at the given angle, and the dip has no other kink.
    let joint = rail("joint(position = 3, angle = 0.02, length = 1.2, gap = 6e-3, depth = 1e-3)");
    let dip = |x: f64| -0.02 * 1.2 / 8.0 * (1.0 - (x - 3.0).abs() / 0.6).max(0.0).powi(2);
    agrees(&joint, &[2.3, 2.5, 2.99, 3.01, 3.4, 3.7], dip, 1e-16);
    let slope = |x: f64| (joint.height(x + 1e-6) - joint.height(x - 1e-6)) / 2e-6;
    assert!((slope(3.0 + 5e-4) - slope(3.0 - 5e-4) - 0.02 * (1.0 - 5e-4 / 0.6)).abs() < 1e-9);
    assert!((joint.height(3.0029) - dip(3.0029) + 1e-3).abs() < 1e-16 && joint.height(3.0031) == dip(3.0031));
    assert_eq!(joint.height(3.0), -4e-3);
}

#[test]
fn a_fresh_flat_is_a_chord_and_a_rounded_one_half_as_deep() {
    for length in [0.02f64, 0.04, 0.06] {
        let fresh = wheel(&format!("flat(position = 1, length = {length})"));
        let depth = length * length / (8.0 * RADIUS);
        assert!((fresh.height(1.0) / -depth - 1.0).abs() < 1.5e-3, "{length}: {} {depth}", fresh.height(1.0));
        // Every point of it is as far from the axis as the chord.
        let chord = (RADIUS * RADIUS - 0.25 * length * length).sqrt();
        let arc = RADIUS * (0.5 * length / RADIUS).asin();
        let form = |x: f64| ((chord / ((x - 1.0) / RADIUS).cos()) - RADIUS).min(0.0);
        agrees(&fresh, &[0.5, 1.0 - 0.9 * arc, 1.0 - 0.3 * arc, 1.0, 1.0 + 0.7 * arc, 1.0 + 1.1 * arc], form, 1e-15);
        assert!(fresh.height(1.0 + 0.999 * arc) < 0.0 && fresh.height(1.0 + 1.001 * arc) == 0.0);
        let rounded = wheel(&format!("flat(position = 1, length = {length}, shape = rounded)"));
        let form = |x: f64| {
            let wave = -0.25 * depth * (1.0 + (TAU * (x - 1.0) / length).cos());
            if (x - 1.0).abs() < 0.5 * length { wave } else { 0.0 }
        };
        agrees(&rounded, &[0.5, 1.0 - 0.4 * length, 1.0, 1.0 + 0.3 * length, 1.0 + 0.6 * length], form, 1e-18);
        assert!((rounded.height(1.0) + 0.5 * depth).abs() < 1e-18);
    }
}

#[test]
fn a_wheel_carries_the_same_after_every_turn() {
    let wavelength = TURN / 58.0;
    let profile = wheel(&format!(
        "polygon(order = 7, amplitude = 2e-5, phase = 0.4) + flat(position = 0.01, length = 0.04) \
         + sinusoid(amplitude = 1e-6, wavelength = {wavelength}) + roughness(spectrum = EN_ISO_3095, seed = 5) \
         + hole(position = -0.3, length = 0.01, depth = 1e-4, every = 0.5, count = 3)"
    ));
    for i in 0..200 {
        let x = TURN * f64::from(i) / 200.0;
        for turns in [-3.0, 1.0, 40.0] {
            let (one, other) = (profile.height(x), profile.height(x + turns * TURN));
            assert!((one - other).abs() < 1e-15, "{x} {turns}: {one} {other}");
        }
    }
    let holes = wheel("hole(position = -0.3, length = 0.01, depth = 1e-4, every = 0.5, count = 3)");
    let found: Vec<i32> = (0..289).filter(|i| holes.height(f64::from(*i) * 0.01) < 0.0).collect();
    assert_eq!(found, [20, 70, 259]);
    let whole = wheel(&format!("hole(length = 0.01, depth = 1e-4, every = {})", TURN / 4.0));
    assert_eq!((0..2890).filter(|i| whole.height(f64::from(*i) * 0.001) < 0.0).count() / 10, 4);
}

#[test]
fn a_thousand_holes_are_one_feature_and_each_has_its_place() {
    let holes = rail("hole(position = 2, length = 5e-3, depth = 1e-3, every = 0.05, count = 1000)");
    for k in -3i32..1003 {
        let middle = 2.0 + 0.05 * f64::from(k);
        let there = (0..1000).contains(&k);
        for (x, inside) in [(middle, true), (middle + 2.4e-3, true), (middle - 2.4e-3, true), (middle + 2.6e-3, false)]
        {
            assert_eq!(holes.height(x), if there && inside { -1e-3 } else { 0.0 }, "{k} {x}");
            assert_eq!(holes.shortest_wavelength_between(x, x + 0.001) < 1.0, there && x <= middle + 2.5e-3, "{k} {x}");
        }
    }
    let endless = rail("hole(position = 2, length = 5e-3, depth = 1e-3, every = 0.05)");
    assert_eq!([1.95, 2.0, 1e5].map(|x| endless.height(x)), [0.0, -1e-3, -1e-3]);
}

#[test]
fn patterns_begin_and_end_gently_where_asked() {
    let profile = rail("sinusoid(amplitude = 1e-5, wavelength = 0.05, from = 1, to = 3, blend = 0.5)");
    let share = |x: f64| {
        let t = (2.0 * (x - 1.0).min(3.0 - x)).clamp(0.0, 1.0);
        t * t * (3.0 - 2.0 * t)
    };
    let form = |x: f64| 1e-5 * share(x) * (TAU * x / 0.05).sin();
    agrees(&profile, &[0.9, 1.01, 1.3, 1.49, 1.51, 2.0, 2.6, 2.99, 3.1], form, 1e-18);
    assert_eq!(profile.shortest_wavelength_between(3.01, 9.0), f64::INFINITY);
}

#[test]
fn files_are_linear_between_samples_and_level_outside() {
    let text = "height,position,comment\n1e-5,0.5,a\n3e-5,1.0,b\n-1e-5,1.5,c\n";
    with_file("linear", text, |folder| {
        let read = |text: &str, body| Profile::parse(text, Some(folder), body).unwrap();
        let profile = read("profile.csv", Body::Rail);
        let expected = [(0.0, 1e-5), (0.5, 1e-5), (0.75, 2e-5), (1.0, 3e-5), (1.25, 1e-5), (1.5, -1e-5), (9.0, -1e-5)];
        for (x, height) in expected {
            assert!((profile.height(x) - height).abs() < 1e-19, "{x}");
        }
        assert_eq!(profile.shortest_wavelength_between(0.0, 1.0), 1.0);
        let path = folder.join("profile.csv");
        assert_eq!(Profile::parse(path.to_str().unwrap(), None, Body::Rail).unwrap(), profile);
        // Repeated, the line from the last sample leads back to the first.
        let repeated = read("file(\"profile.csv\", position = 10, every = 2, factor = -2)", Body::Rail);
        for (x, height) in [(11.0, -6e-5), (12.0, 0.0), (13.0, -6e-5), (12.5, -2e-5), (1.0, -2e-5)] {
            assert!((repeated.height(x) - height).abs() < 1e-16, "{x} {}", repeated.height(x));
        }
        let round = read("profile.csv", WHEEL);
        let seam = |x: f64| -1e-5 + 2e-5 * (x - 1.5) / (TURN - 1.0);
        assert!((round.height(2.5) - seam(2.5)).abs() < 1e-18 && (round.height(0.2) - seam(0.2 + TURN)).abs() < 1e-18);
    });
    let whole = format!("position,height\n0,1e-5\n1,2e-5\n{TURN},1e-5\n");
    with_file("whole", &whole, |folder| {
        let round = Profile::parse("profile.csv", Some(folder), WHEEL).unwrap();
        assert!((round.height(TURN + 0.5) - 1.5e-5).abs() < 1e-18);
    });
}

/// Levels of the one-third octaves with mid-band wavelengths 10^(number/10) m \[dB re 1 µm]: Fourier sums of heights
/// over one period, taken at places that have nothing to do with the table inside.
fn levels(profile: &Profile, period: f64, numbers: std::ops::RangeInclusive<i32>) -> Vec<f64> {
    let edge = |number: f64| period / 10f64.powf(0.1 * number);
    let most = edge(f64::from(*numbers.start()) - 0.5);
    let count = (3.1 * most) as usize;
    let heights: Vec<f64> =
        (0..count).map(|i| profile.height(0.777 + period * (i as f64 / count as f64 - 2.0))).collect();
    let square = |wave: usize| {
        let (sin, cos) = (TAU * wave as f64 / count as f64).sin_cos();
        let turn = num_complex(&heights, cos, sin);
        2.0 * (turn[0] * turn[0] + turn[1] * turn[1]) / (count * count) as f64
    };
    let band = |number: i32| {
        let waves = edge(f64::from(number) + 0.5).ceil() as usize..edge(f64::from(number) - 0.5).ceil() as usize;
        10.0 * (waves.map(square).sum::<f64>() / 1e-12).log10()
    };
    numbers.map(band).collect()
}

/// `Σ h_i z^i` for `z` on the unit circle.
fn num_complex(heights: &[f64], cos: f64, sin: f64) -> [f64; 2] {
    heights.iter().rev().fold([0.0; 2], |[re, im], h| [re * cos - im * sin + h, re * sin + im * cos])
}

#[test]
fn seeded_roughness_returns_its_one_third_octaves() {
    let limits = [-8.0, -7.4, -6.8, -6.2, -5.6, -5.0, -3.2, -1.1, 0.9, 2.9, 4.9, 7.0, 9.0, 11.0, 13.0, 15.0, 17.1];
    let cases = [
        ("roughness(spectrum = EN_ISO_3095, seed = 7, length = 20)", Body::Rail, 20.0, -20, limits.to_vec()),
        ("roughness(spectrum = EN_ISO_3095, offset = 10)", WHEEL, TURN, -20, limits.map(|level| level + 10.0).to_vec()),
        ("roughness(levels = [3, -40, 12.5], longest = 0.05, seed = 9)", Body::Rail, 50.0, -15, vec![12.5, -40.0, 3.0]),
    ];
    for (text, body, period, shortest, expected) in cases {
        let profile = Profile::parse(text, None, body).unwrap();
        let last = shortest + expected.len() as i32 - 1;
        let found = levels(&profile, period, shortest..=last);
        let worst = found.iter().zip(&expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        println!("figure: roughness.octaves [dB] = {worst:.1e}");
        assert!(worst < 0.5, "{text}: {found:?} {expected:?}");
    }
}

#[test]
fn the_same_seed_gives_the_same_bits_on_every_machine_and_another_seed_another_rail() {
    let bits = |seed: u32| {
        let profile = rail(&format!(
            "roughness(spectrum = EN_ISO_3095, seed = {seed}, shortest = 0.02) + sinusoid(amplitude = 1e-6, wavelength = 0.3)"
        ));
        (0..2000).fold(0xcbf2_9ce4_8422_2325u64, |hash, i| {
            (hash ^ profile.height(f64::from(i) * 0.377).to_bits()).wrapping_mul(0x0100_0000_01b3)
        })
    };
    println!("{:#x} {:#x}", bits(1), bits(2));
    // Written down from the first machine that computed it; no other may find anything else.
    assert_eq!(bits(1), 0xda4b_c1d8_f015_7de3);
    assert_ne!(bits(1), bits(2));
    // A wave keeps its phase when shorter waves are added.
    let [coarse, fine] = [0.1, 0.05]
        .map(|shortest| rail(&format!("roughness(spectrum = EN_ISO_3095, seed = 1, shortest = {shortest})")));
    let rest = rail("roughness(levels = [2.9, 0.9, -1.1], longest = 0.08, seed = 1)");
    let worst = (0..500).map(|i| f64::from(i) * 0.13).map(|x| fine.height(x) - coarse.height(x) - rest.height(x));
    assert!(worst.fold(0.0, |a: f64, b| a.max(b.abs())) < 1e-9);
}

/// A text that must be refused, and words of its refusal.
fn refused(text: &str, body: Body, words: &[&str]) {
    let message = Profile::parse(text, None, body).unwrap_err().to_string();
    assert!(words.iter().all(|word| message.contains(word)), "{text}: {message}");
}

#[test]
fn texts_without_meaning_are_refused_by_name_value_and_range() {
    for (text, words) in [
        ("sinusoid", &["column 9", "(", "the end"][..]),
        ("sinusoid(amplitude 5e-6)", &["column 20", "=", "not 0.000005"]),
        ("hole(length = 5mm, depth = 1)", &["column 15", "without a unit", "5mm"]),
        ("hole(length = 1e400, depth = 1)", &["column 15", "finite", "1e400"]),
        ("hole(length = 1) hole(length = 2)", &["column 18", "+ or the end", "hole"]),
        ("hole(length = 5e-3, depth = 1e-3) +", &["column 36", "the name of a feature", "the end"]),
        ("3 + 4", &["column 1", "the name of a feature", "3"]),
        ("file(\"a.csv)", &["column 6", "closing"]),
        ("roughness(levels = [1, two], longest = 1)", &["a number", "two"]),
        ("sinusoide(amplitude = 1)", &["column 1", "sinusoide is unknown", "sinusoid"]),
        ("whole(length = 1)", &["whole is unknown", "hole"]),
        ("sinusoid(amplitude = 1e-6, wavelenght = 1)", &["sinusoid needs wavelength", "wavelenght"]),
        ("sinusoid(amplitude = 1e-6, wavelength = 1, fase = 1)", &["no parameter fase", "phase"]),
        ("sinusoid(amplitude = 1e-6, wavelength = 0)", &["wavelength = 0 m of sinusoid", "0.0001 to 1000 m"]),
        ("sinusoid(amplitude = NaN, wavelength = 1)", &["amplitude = NaN of sinusoid", "0 to 0.02 m"]),
        ("hole(length = -5e-3, depth = 1e-3)", &["length = -0.005 m of hole", "0.0001 to 1000 m"]),
        ("hole(length = 5e-3, depth = 1)", &["depth = 1 m of hole", "0 to 0.02 m"]),
        ("hole(length = 5e-3, length = 1, depth = 1)", &["hole is given length twice"]),
        ("hole(length = 5e-3, depth = 1e-3, every = 1e-3)", &["every = 0.001 m of hole", "0.005 to"]),
        ("hole(length = 5e-3, depth = 1e-3, every = 1, count = 2.5)", &["count = 2.5 of hole", "whole, 1 to"]),
        ("hole(length = 5e-3, depth = 1e-3, count = 3)", &["hole needs every", "repeats"]),
        ("step(height = 1e-4, every = 3)", &["step needs length"]),
        ("joint(length = 1)", &["joint needs angle", "gap"]),
        ("flat(length = 0.04)", &["flat", "wheel only", "on the rail use"]),
        ("polygon(order = 3, amplitude = 1e-5)", &["polygon", "wheel only"]),
        ("roughness(seed = 1)", &["roughness needs spectrum", "levels"]),
        ("roughness(spectrum = EN_ISO_3381)", &["spectrum = EN_ISO_3381 of roughness", "EN_ISO_3095"]),
        ("roughness(spectrum = EN_ISO_3095, seed = -1)", &["seed = -1", "0 to"]),
        ("roughness(spectrum = EN_ISO_3095, seed = 0.5)", &["seed = 0.5", "whole"]),
        ("roughness(spectrum = EN_ISO_3095, longest = 0.45)", &["longest = 0.45 m", "0.398107 or 0.501187 m"]),
        ("roughness(spectrum = EN_ISO_3095, longest = 0.01, shortest = 0.1)", &["shortest = 0.1 m", "to 0.0102 m"]),
        (
            "roughness(spectrum = EN_ISO_3095, longest = 2, length = 1)",
            &["longest = 1.99526 m", "no whole number", "1 m"],
        ),
        (
            "roughness(spectrum = EN_ISO_3095, shortest = 1e-3, length = 1000)",
            &["shortest = 0.001 m", "at most 2097152"],
        ),
        ("roughness(levels = [], longest = 1)", &["levels = [] of roughness", "a list"]),
        ("roughness(levels = [300], longest = 1)", &["levels = [… 300 …]", "-100 to 60 dB"]),
        ("roughness(levels = [3], spectrum = EN_ISO_3095)", &["levels", "leave one out"]),
        ("file(3)", &["the name of a parameter", "3"]),
        ("file(name = rail)", &["name = rail of file", "a text between"]),
        ("nowhere.csv", &["nowhere.csv cannot be read", "working directory"]),
    ] {
        refused(text, Body::Rail, words);
    }
    for (text, words) in [
        ("joint(angle = 0.01)", &["joint", "rail only", "on the wheel use"][..]),
        ("polygon(order = 31, amplitude = 1e-5)", &["order = 31", "1 to 30"]),
        ("flat(length = 0.04, shape = round)", &["shape = round", "fresh or rounded"]),
        ("flat(length = 0.3)", &["length = 0.3 m of flat", "0.001 to 0.23 m"]),
        ("sinusoid(amplitude = 1e-6, wavelength = 0.05)", &["wavelength = 0.05 m", "58 times", "0.0498321593328"]),
        ("hole(length = 0.01, depth = 1e-4, every = 1)", &["every = 1 m", "2.89027 m", "3 times"]),
        ("hole(length = 0.01, depth = 1e-4, every = 1, count = 3)", &["count = 3", "at most 2"]),
        ("hole(length = 3, depth = 1e-4)", &["length = 3 m", "at most the circumference 2.89027 m"]),
        ("step(height = 1e-4)", &["step needs length"]),
    ] {
        refused(text, WHEEL, words);
    }
}

#[test]
fn files_without_meaning_are_refused_by_line_and_value() {
    for (name, text, words) in [
        (
            "unsorted",
            "position,height\n0,1e-6\n2,0\n1,0\n",
            &["line 4", "position = 1 m", "larger than 2 m", "sort"][..],
        ),
        ("twice", "position,height\n0,1e-6\n0,0\n", &["line 3", "position = 0 m", "larger than 0 m"]),
        ("nan", "position,height\n0,1e-6\n1,NaN\n", &["line 3", "height = \"NaN\"", "finite"]),
        ("infinite", "position,height\ninf,1e-6\n1,0\n", &["line 2", "position = \"inf\""]),
        ("words", "position,height\n0,1e-6\n1,high\n", &["line 3", "height = \"high\""]),
        ("short", "position,height\n0,1e-6\n1\n", &["line 3", "1 cell, but line 1 names 2 columns"]),
        ("column", "position,depth\n0,1e-6\n1,0\n", &["line 1", "column height is missing", "position,depth"]),
        ("headless", "0,1e-6\n1,0\n", &["line 1", "column position is missing", "0,1e-6"]),
        ("deep", "position,height\n0,1e-6\n1,-0.2\n", &["line 3", "height = -0.2 m", "0.1 m"]),
        ("one", "position,height\n0,1e-6\n", &["1 sample, at least 2"]),
        ("none", "", &["line 1", "no line of names"]),
        ("comma", "position,height\n0,0\n1,0,00005\n", &["line 3", "3 cells", "decimal points"]),
        ("double", "position,height,height\n0,0,1e-6\n", &["line 1", "two columns height"]),
    ] {
        with_file(name, text, |folder| {
            let message = Profile::parse("profile.csv", Some(folder), Body::Rail).unwrap_err().to_string();
            assert!(words.iter().chain(&["profile.csv"]).all(|word| message.contains(word)), "{name}: {message}");
        });
    }
    with_file("long", "position,height\n0,1e-6\n1,0\n3,1e-6\n", |folder| {
        let read = |text, body| Profile::parse(text, Some(folder), body).unwrap_err().to_string();
        let message = read("profile.csv", WHEEL);
        assert!(message.contains("length = 3 m") && message.contains("circumference"), "{message}");
        let message = read("file(\"profile.csv\", every = 2)", Body::Rail);
        assert!(message.contains("every = 2 m") && message.contains("3 to"), "{message}");
        let message = read("other.csv", Body::Rail);
        assert!(message.contains("other.csv cannot be read") && message.contains("relative to"), "{message}");
    });
}

/// A wheel that was measured all around is written with the digits that its owner likes.
#[test]
fn a_closed_profile_of_a_wheel_is_closed_whatever_the_digits_of_its_positions() {
    const COUNT: usize = 200;
    for radius in [0.33, 0.42, 0.45, RADIUS, 0.625] {
        let turn = TAU * radius;
        let height = |x: f64| 1e-4 * (3.0 * TAU * x / turn).sin();
        for digits in 4..=9 {
            let row = |k: usize| {
                let x = turn * k as f64 / COUNT as f64;
                format!("{x:.digits$},{:?}\n", height(if k == COUNT { 0.0 } else { x }))
            };
            let text: String = std::iter::once("position,height\n".to_owned()).chain((0..=COUNT).map(row)).collect();
            let read = |folder: &Path| Profile::parse("profile.csv", Some(folder), Body::Wheel { radius });
            let profile = with_file("digits", &text, read).unwrap_or_else(|error| panic!("{digits} digits: {error}"));
            let places: Vec<_> = (0..1000).map(|k| turn * (k as f64 / 1000.0 - 0.5)).collect();
            // Half a digit of the position on the steepest slope, and the chord between samples.
            let slope = 3.0 * TAU / turn * 1e-4;
            agrees(&profile, &places, height, 0.5 * slope * 10f64.powi(-(digits as i32)) + 1.2e-7);
            let shortest = profile.shortest_wavelength_between(-turn, turn);
            assert!(shortest > turn / COUNT as f64, "{digits} digits: a wave of {shortest} m at the end of the file");
        }
    }
    // The last digit may be beyond the circumference, but not two samples.
    let text = "position,height\n0,0\n1,1e-5\n2.8903,0\n2.8904,0\n";
    let message = with_file("twice", text, |folder| Profile::parse("profile.csv", Some(folder), WHEEL).unwrap_err());
    assert!(message.to_string().contains("no more than one sample from 2.89027 m on"), "{message}");
    let text = "position,height\n0,0\n1,1e-5\n2.8906,0\n";
    let message = with_file("beyond", text, |folder| Profile::parse("profile.csv", Some(folder), WHEEL).unwrap_err());
    let message = message.to_string();
    assert!(
        message.contains("length = 2.8906 m") && message.contains("at most the circumference 2.89027 m"),
        "{message}"
    );
}

#[test]
fn cross_sections_of_rails_and_wheels_are_told_from_profiles_along_the_way() {
    let section = |name: &str, body: Body, from: f64, to: f64, height: &dyn Fn(f64) -> f64| {
        let row = |k: usize| {
            let x = from + (to - from) * k as f64 / 72.0;
            format!("{x:?},{:?}\n", height(x))
        };
        let text: String = std::iter::once("position,height\n".to_owned()).chain((0..=72).map(row)).collect();
        with_file(name, &text, |folder| Profile::parse("profile.csv", Some(folder), body).unwrap()).cross_section()
    };
    // Crown, shoulder and corner of a head; conicity and flange of a tread.
    let head = |z: f64| {
        let z = z.abs();
        -z * z / 0.6 - (z - 0.01).max(0.0).powi(2) / 0.22 - (z - 0.026).max(0.0).powi(2) / 0.026
    };
    let tread = |z: f64| -z / 40.0 + 0.028 * (-((z + 0.055) / 0.012).powi(2)).exp();
    for (name, found) in [
        ("head", section("head", Body::Rail, -0.036, 0.036, &head)),
        ("tread", section("tread", WHEEL, -0.07, 0.06, &tread)),
    ] {
        let [height, length] = found.unwrap_or_else(|| panic!("{name} is not seen"));
        println!("{name}: {height} m on {length} m");
        assert!((3e-3..0.05).contains(&height) && (0.07..0.14).contains(&length), "{name}: {height} m, {length} m");
    }
    let squat = |x: f64| -1e-3 * (-(x / 0.015).powi(2)).exp();
    let weld = |x: f64| 2e-3 * (1.0 - (x / 0.1).powi(2)).max(0.0);
    let ramp = |x: f64| 0.05 * x;
    let fresh = |x: f64| -(0.06_f64.powi(2) / 4.0 - x * x).max(0.0) / (2.0 * RADIUS);
    type Case<'a> = (&'a str, Body, f64, &'a dyn Fn(f64) -> f64);
    let cases: [Case; 4] = [
        ("squat", Body::Rail, 0.05, &squat),
        ("weld", Body::Rail, 0.15, &weld),
        ("ramp", Body::Rail, 0.5, &ramp),
        ("flat", WHEEL, 0.05, &fresh),
    ];
    for (name, body, half, height) in cases {
        assert_eq!(section(name, body, -half, half, height), None, "{name}");
    }
}

#[test]
fn examples_of_the_documentation_are_profiles_and_it_names_every_feature() {
    let text = include_str!("../../../../docs/profiles.md");
    let mut parsed = 0;
    for block in text.split("```profile").skip(1) {
        let (kind, rest) = block.split_once('\n').unwrap();
        let body = if kind.contains("wheel") { WHEEL } else { Body::Rail };
        for line in rest.split("```").next().unwrap().lines().filter(|line| !line.is_empty()) {
            assert!(!Profile::parse(line, None, body).unwrap().is_smooth(), "{line}");
            parsed += 1;
        }
    }
    assert_eq!(parsed, 7);
    assert!(catalogue::names().all(|name| text.contains(&format!("| `{name}` |"))));
}
