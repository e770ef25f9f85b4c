//! Random roughness of a given spectrum: one-third octave levels in wavelength, made of sinusoids with seeded phases.
//!
//! A realisation is periodic: it repeats after the circumference of the wheel, or after a length of rail. Every whole
//! number of waves in that period that belongs to a band becomes a sinusoid; those of one band are equally high, so
//! that their mean square is exactly that of the level, and their phases are random. The sum is tabulated once with
//! height and slope and read by cubic interpolation.
//!
//! The same seed gives the same bits on every machine: phases come from the generator SplitMix64 (Steele, Lea, Flood,
//! *Fast splittable pseudorandom number generators*, OOPSLA 2014), functions from the crate `libm`, and nothing depends
//! on the order in which anything is computed. The phase of a wave depends on the seed and on its number alone.

use std::f64::consts::TAU;

/// Level 0 dB is this root mean square \[m].
pub const REFERENCE: f64 = 1e-6;
/// Longest wavelength of [`EN_ISO_3095`] as number of its band, 10 lg(λ/1 m).
pub const LONGEST_LIMIT: i32 = 3;
/// Limit of acoustic rail roughness in dB re 1 µm, one-third octaves from 2 m to 0.8 mm.
///
/// EN ISO 3095:2013, as tabulated for the network "E" in Directive (EU) 2015/996, amended by (EU) 2021/1226, Table G-1.
pub const EN_ISO_3095: [f64; 35] = [
    17.1, 17.1, 17.1, 17.1, 17.1, 17.1, 17.1, 17.1, 15.0, 13.0, 11.0, 9.0, 7.0, 4.9, 2.9, 0.9, -1.1, -3.2, -5.0, -5.6,
    -6.2, -6.8, -7.4, -8.0, -8.6, -9.2, -9.8, -10.4, -11.0, -11.6, -12.2, -12.8, -13.4, -14.0, -14.0,
];
/// Samples of the table for one of the shortest waves; cubic interpolation then errs by less than 1e-4 of its
/// amplitude.
const SAMPLES_PER_WAVE: f64 = 16.0;
/// Largest number of samples of a table.
pub const LARGEST_TABLE: usize = 1 << 21;

/// Levels, seed and period of a realisation.
#[derive(Clone, Debug, PartialEq)]
pub struct Spectrum {
    /// Number of the band with the longest waves: 10 lg of its mid-band wavelength over 1 m.
    pub longest: i32,
    /// Levels from there to shorter waves \[dB re 1 µm].
    pub levels: Vec<f64>,
    /// Seed of the phases.
    pub seed: u64,
    /// Period \[m].
    pub period: f64,
}

/// Wavelength 10^(number/10) m: mid-band of a one-third octave, or between two for halves (IEC 61260-1, base ten).
pub fn band_wavelength(number: f64) -> f64 {
    libm::exp10(0.1 * number)
}

impl Spectrum {
    /// Numbers of waves in the period that belong to band `i` of the list: from the first to before the last.
    pub fn waves(&self, i: usize) -> std::ops::Range<usize> {
        let number = f64::from(self.longest) - i as f64;
        let [few, many] = [0.5, -0.5].map(|half| (self.period / band_wavelength(number + half)).ceil() as usize);
        few.max(1)..many.max(1)
    }

    /// Number of samples of the table.
    pub fn samples(&self) -> usize {
        let most = self.waves(self.levels.len().saturating_sub(1)).end;
        ((SAMPLES_PER_WAVE * most as f64) as usize).next_power_of_two()
    }

    /// The realisation.
    pub fn realise(&self) -> Roughness {
        let count = self.samples();
        let mut sum = vec![[0.0; 2]; count];
        for (i, level) in self.levels.iter().enumerate() {
            let waves = self.waves(i);
            let amplitude = REFERENCE * libm::exp10(level / 20.0) * (2.0 / waves.len() as f64).sqrt();
            for wave in waves {
                let angle = TAU * share(self.seed, wave as u64);
                let (number, half) = (TAU / self.period * wave as f64, 0.5 * amplitude);
                let [re, im] = [half * libm::cos(angle), half * libm::sin(angle)];
                // The real part of the sum becomes the height, the imaginary part the slope.
                sum[wave] = [re - number * re, im - number * im];
                sum[count - wave] = [re + number * re, -im - number * im];
            }
        }
        transform(&mut sum);
        let shortest =
            self.period / self.waves(self.levels.len().saturating_sub(1)).end.saturating_sub(1).max(1) as f64;
        Roughness { period: self.period, table: sum, shortest }
    }
}

/// Number from 0 to below 1 that belongs to a seed and a place in its sequence: SplitMix64, upper 53 bits.
fn share(seed: u64, place: u64) -> f64 {
    let mut z = seed.wrapping_add(place.wrapping_add(1).wrapping_mul(0x9E37_79B9_7F4A_7C15));
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
}

/// Replaces `c_n` by `Σ_n c_n exp(2πi jn/N)` for all j; N is a power of two (Cooley and Tukey 1965).
fn transform(values: &mut [[f64; 2]]) {
    let count = values.len();
    let bits = count.trailing_zeros();
    for i in 0..count {
        let reversed = i.reverse_bits() >> (usize::BITS - bits).min(usize::BITS - 1);
        if bits > 0 && reversed > i {
            values.swap(i, reversed);
        }
    }
    let turn = |i: usize| {
        let angle = TAU * i as f64 / count as f64;
        [libm::cos(angle), libm::sin(angle)]
    };
    let turns: Vec<[f64; 2]> = (0..count / 2).map(turn).collect();
    let mut half = 1;
    while half < count {
        for block in values.chunks_exact_mut(2 * half) {
            let (first, second) = block.split_at_mut(half);
            for (i, (a, b)) in first.iter_mut().zip(second).enumerate() {
                let [cos, sin] = turns[i * (count / (2 * half))];
                let turned = [b[0] * cos - b[1] * sin, b[0] * sin + b[1] * cos];
                *b = [a[0] - turned[0], a[1] - turned[1]];
                *a = [a[0] + turned[0], a[1] + turned[1]];
            }
        }
        half *= 2;
    }
}

/// A realisation: heights and slopes at equal distances, repeated after the period.
#[derive(Clone, Debug, PartialEq)]
pub struct Roughness {
    period: f64,
    /// Height \[m] and slope.
    table: Vec<[f64; 2]>,
    shortest: f64,
}

impl Roughness {
    /// Height at a position \[m].
    pub fn height(&self, position: f64) -> f64 {
        let count = self.table.len();
        let turns = position / self.period;
        let at = (turns - turns.floor()) * count as f64;
        let before = (at as usize).min(count - 1);
        let ([h0, s0], [h1, s1]) = (self.table[before], self.table[(before + 1) % count]);
        let (d, t) = (self.period / count as f64, at - before as f64);
        let u = 1.0 - t;
        u * u * (h0 * (1.0 + 2.0 * t) + d * s0 * t) + t * t * (h1 * (1.0 + 2.0 * u) - d * s1 * u)
    }

    /// Shortest wavelength \[m].
    pub fn wavelength(&self) -> f64 {
        self.shortest
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_transform_is_the_sum_it_stands_for() {
        for count in [1, 2, 4, 16] {
            let given: Vec<[f64; 2]> = (0..count).map(|n| [share(1, n), share(2, n)]).collect();
            let mut fast = given.clone();
            transform(&mut fast);
            for (j, found) in fast.iter().enumerate() {
                let mut sum = [0.0; 2];
                for (n, c) in given.iter().enumerate() {
                    let (sin, cos) = (TAU * (j * n) as f64 / count as f64).sin_cos();
                    sum = [sum[0] + c[0] * cos - c[1] * sin, sum[1] + c[0] * sin + c[1] * cos];
                }
                assert!((0..2).all(|part| (sum[part] - found[part]).abs() < 1e-13), "{j} of {count}");
            }
        }
    }

    #[test]
    fn the_generator_is_the_published_one() {
        // First outputs of SplitMix64 for the seed 1234567, as in the reference implementation by S. Vigna.
        let published = [6457827717110365317u64, 3203168211198807973, 9817491932198370423, 4593380528125082431];
        for (place, number) in published.into_iter().enumerate() {
            assert_eq!(share(1234567, place as u64), (number >> 11) as f64 / 2f64.powi(53));
        }
    }

    #[test]
    fn limits_are_given_where_the_table_has_them() {
        let at = |number: i32| EN_ISO_3095[usize::try_from(LONGEST_LIMIT - number).unwrap()];
        assert_eq!(
            [at(3), at(-4), at(-5), at(-13), at(-15), at(-20), at(-31)],
            [17.1, 17.1, 15.0, -1.1, -5.0, -8.0, -14.0]
        );
    }
}
