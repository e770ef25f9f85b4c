//! Eigenpairs of 32 digits where a pencil makes it hard: few rows, equal or nearly equal eigenvalues, scales far apart, and a mass
//! that is hardly one.

use wheelrail_numerics::linalg::LinalgError;
use wheelrail_numerics::linalg::pencil::{Wide, WideModes, narrow, wide, wide_modes};

type Matrix = Vec<Wide>;

/// Numbers between −1 and 1, always the same.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
}

fn matrix(n: usize, entry: impl Fn(usize, usize) -> Wide) -> Matrix {
    (0..n * n).map(|at| entry(at / n, at % n)).collect()
}

fn unit(n: usize) -> Matrix {
    matrix(n, |i, j| wide(f64::from(u8::from(i == j))))
}

fn product(n: usize, a: &[Wide], b: &[Wide]) -> Matrix {
    matrix(n, |i, j| (0..n).fold(Wide::ZERO, |sum, l| sum + a[i * n + l] * b[l * n + j]))
}

fn transposed(n: usize, a: &[Wide]) -> Matrix {
    matrix(n, |i, j| a[j * n + i])
}

fn largest(a: &[Wide]) -> f64 {
    a.iter().fold(0.0, |most: f64, entry| most.max(entry.0.abs()))
}

/// A symmetric matrix with given eigenvalues: `Q D Q` with the reflections of three random vectors.
fn with_eigenvalues(values: &[f64], random: &mut Random) -> Matrix {
    let n = values.len();
    let mut found = matrix(n, |i, j| if i == j { wide(values[i]) } else { Wide::ZERO });
    for _ in 0..3 {
        let v: Vec<Wide> = (0..n).map(|_| wide(random.next())).collect();
        let length = v.iter().fold(Wide::ZERO, |sum, v| sum + *v * *v);
        let one = unit(n);
        let q = matrix(n, |i, j| one[i * n + j] - wide(2.0) * v[i] * v[j] / length);
        found = product(n, &product(n, &q, &found), &q);
    }
    // Equal to its transposed to the last digit.
    matrix(n, |i, j| found[i.min(j) * n + i.max(j)])
}

/// How far the shapes are from orthonormal in the mass \[1], and the stiffness between them from the eigenvalues, over the
/// largest one.
fn errors(n: usize, mass: &[Wide], stiffness: &[Wide], modes: &WideModes) -> [f64; 2] {
    let back = transposed(n, &modes.shapes);
    let gram = product(n, &product(n, &back, mass), &modes.shapes);
    let ritz = product(n, &product(n, &back, stiffness), &modes.shapes);
    let one = unit(n);
    let off = |found: &[Wide], by: &dyn Fn(usize) -> Wide| {
        largest(&matrix(n, |i, j| found[i * n + j] - one[i * n + j] * by(i)))
    };
    let most = largest(&modes.values).max(f64::MIN_POSITIVE);
    [off(&gram, &|_| Wide::ONE), off(&ritz, &|i| modes.values[i]) / most]
}

#[test]
fn eigenvalues_that_are_equal_or_nearly_so_have_orthonormal_shapes() {
    let mut random = Random(3);
    let spread = |n: usize, by: f64| -> Vec<f64> { (0..n).map(|i| 1.0 + by * i as f64).collect() };
    let mut worst = [0.0_f64; 3];
    for n in [1, 2, 3, 5, 8, 9, 17, 40] {
        let half = |i: usize| if i < n / 2 { 0.0 } else { 1.0 };
        let clusters = [
            vec![0.0; n],
            vec![7.0; n],
            spread(n, 1e-14),
            spread(n, 1.0),
            (0..n).map(half).collect(),
            (0..n).map(|i| 10_f64.powi(-(i as i32 % 16))).collect(),
            (0..n).map(|i| half(i) * 1e12 + (i % 3) as f64).collect(),
        ];
        for mut exact in clusters {
            let stiffness = with_eigenvalues(&exact, &mut random);
            let modes = wide_modes(&unit(n), &stiffness, n).unwrap();
            exact.sort_by(f64::total_cmp);
            let most = exact[n - 1].max(1e-300);
            let off = modes.values.iter().zip(&exact).fold(0.0_f64, |off, (a, b)| off.max((*a - wide(*b)).0.abs()));
            let [gram, ritz] = errors(n, &unit(n), &stiffness, &modes);
            worst = [worst[0].max(off / most), worst[1].max(gram), worst[2].max(ritz)];
            assert!(modes.values.windows(2).all(|pair| pair[0].0 <= pair[1].0));
        }
    }
    println!("eigenvalues {:.1e}, shapes {:.1e}, stiffness {:.1e}", worst[0], worst[1], worst[2]);
    assert!(worst.iter().all(|worst| *worst < 1e-29), "{worst:?}");
}

/// The units of a body are anyone's: powers of two change no digit.
#[test]
fn eigenvalues_go_with_the_units() {
    let n = 9;
    let mut random = Random(5);
    let values: Vec<f64> = (0..n).map(|i| 4_f64.powi(i as i32)).collect();
    let stiffness = with_eigenvalues(&values, &mut random);
    let plain = wide_modes(&unit(n), &stiffness, n).unwrap();
    for power in [-500, -300, -100, 100, 300, 450] {
        let by = 2_f64.powi(power);
        let scaled: Matrix = stiffness.iter().map(|entry| Wide(entry.0 * by, entry.1 * by)).collect();
        let modes = wide_modes(&unit(n), &scaled, n);
        let found = modes.unwrap_or_else(|error| panic!("2^{power}: {error}"));
        for (found, value) in found.values.iter().zip(&plain.values) {
            assert!((narrow(*found) / by / narrow(*value) - 1.0).abs() < 1e-14, "2^{power}: {found:?}");
        }
    }
}

/// Layers whose masses lie up to 16 decades apart, as rows and columns scaled by `s`: `S K S φ = λ S M S φ` has the eigenvalues
/// of `K φ = λ M φ`.
#[test]
fn rows_of_very_different_sizes_have_the_same_eigenvalues() {
    let n = 12;
    let mut random = Random(11);
    let exact: Vec<f64> = (0..n).map(|i| 1.0 + i as f64).collect();
    let stiffness = with_eigenvalues(&exact, &mut random);
    for decades in [4.0, 16.0, 40.0] {
        let size = |i: usize| wide(10_f64.powf(0.5 * decades * ((i * 7 % n) as f64 / (n - 1) as f64 - 0.5)));
        let scaled = |a: &[Wide]| matrix(n, |i, j| size(i) * a[i * n + j] * size(j));
        let modes = wide_modes(&scaled(&unit(n)), &scaled(&stiffness), n).unwrap();
        for (found, exact) in modes.values.iter().zip(&exact) {
            assert!((*found - wide(*exact)).0.abs() < 1e-28 * n as f64, "{decades} decades: {found:?}");
        }
    }
}

/// With a mass of condition c, digits are lost as c says, and no more.
#[test]
fn a_nearly_singular_mass_costs_the_digits_of_its_condition() {
    let n = 10;
    let mut random = Random(17);
    for condition in [1e4, 1e8, 1e14, 1e20] {
        let masses: Vec<f64> = (0..n).map(|i| if i == 0 { 1.0 / condition } else { 1.0 }).collect();
        let mass = with_eigenvalues(&masses, &mut random);
        let stiffness = with_eigenvalues(&(0..n).map(|i| (i + 1) as f64).collect::<Vec<_>>(), &mut random);
        let modes = wide_modes(&mass, &stiffness, n).unwrap();
        let [gram, ritz] = errors(n, &mass, &stiffness, &modes);
        println!("condition {condition:.0e}: shapes {gram:.1e}, stiffness {ritz:.1e}");
        assert!(gram < 1e-29 * condition && ritz < 1e-29 * condition);
        assert!(modes.values.iter().all(|value| value.0 > 0.0));
    }
    let mut singular = with_eigenvalues(&[0.0, 1.0, 1.0], &mut random);
    singular[0] -= wide(1e-20);
    assert!(matches!(wide_modes(&singular, &unit(3), 3), Err(LinalgError::NotPositiveDefinite { .. })));
}

#[test]
fn one_and_two_rows_are_those_of_the_formula() {
    let modes = wide_modes(&[wide(4.0)], &[wide(3.0)], 1).unwrap();
    assert_eq!((modes.values[0], modes.shapes[0]), (wide(0.75), wide(0.5)));
    for ([a, b, d], exact) in [
        ([2.0, 1.0, 2.0], [1.0, 3.0]),
        ([2.0, 0.0, 1.0], [1.0, 2.0]),
        ([0.0, 0.0, 0.0], [0.0, 0.0]),
        ([0.0, 1.0, 0.0], [-1.0, 1.0]),
        ([5.0, -4.0, -1.0], [-3.0, 7.0]),
        ([1.0, 1e-40, 1.0], [1.0, 1.0]),
        ([1.0, 1e-200, 2.0], [1.0, 2.0]),
    ] {
        let modes = wide_modes(&unit(2), &[a, b, b, d].map(wide), 2).unwrap();
        for (found, exact) in modes.values.iter().zip(exact) {
            assert!((*found - wide(exact)).0.abs() < 1e-30, "{a} {b} {d}: {found:?}");
        }
    }
}

#[test]
fn what_is_no_number_has_no_modes_whatever_the_size() {
    for n in [1, 2, 5] {
        for odd in [f64::NAN, f64::INFINITY] {
            let mut stiffness = unit(n);
            stiffness[n * n - 1] = wide(odd);
            assert!(wide_modes(&unit(n), &stiffness, n).is_err(), "{n} rows with {odd} in the stiffness");
            let mut mass = unit(n);
            mass[n * n - 1] = wide(odd);
            assert!(wide_modes(&mass, &unit(n), n).is_err(), "{n} rows with {odd} in the mass");
        }
    }
}
