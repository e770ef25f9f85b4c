//! Law of wear: mass that friction takes off a wheel.

/// Mass that a wheel loses per distance rolled, as a function of the energy that friction dissipates per distance and
/// area, Tγ/A, in three regimes that need not join.
///
/// Source of the form and of the usual numbers, twin-disc tests of the steel R8T against rails of grade 900A: F.
/// Braghin, R. Lewis, R. S. Dwyer-Joyce, S. Bruni, *Wear* 261 (2006) 1253–1264, as they are quoted from memory: 5.3
/// µg/(m mm²) per N/mm², 55 µg/(m mm²) from 10.4 N/mm², and 61.9 µg/(m mm²) more per N/mm² from 77.2 N/mm².
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WearLaw {
    /// Mild wear: mass over energy [kg/J].
    pub mild: f64,
    /// Severe wear: mass over distance and area [kg/m³].
    pub severe: f64,
    /// Catastrophic wear: mass over the energy beyond its beginning [kg/J].
    pub catastrophic: f64,
    /// Tγ/A from which wear is severe \[Pa].
    pub severe_from: f64,
    /// Tγ/A from which it is catastrophic \[Pa].
    pub catastrophic_from: f64,
}

impl WearLaw {
    /// That of the source.
    pub fn r8t() -> Self {
        Self { mild: 5.3e-9, severe: 55e-3, catastrophic: 61.9e-9, severe_from: 10.4e6, catastrophic_from: 77.2e6 }
    }

    /// The law of a steel that wears `factor` times as much \[1].
    pub fn scaled(&self, factor: f64) -> Self {
        let [mild, severe, catastrophic] = [self.mild, self.severe, self.catastrophic].map(|wear| wear * factor);
        Self { mild, severe, catastrophic, ..*self }
    }

    /// Mass per distance [kg/m] where the energy `t_gamma` \[N], Tγ, is dissipated per distance over the contact area
    /// `area` \[m²]. All three may be per metre of width.
    pub fn rate(&self, t_gamma: f64, area: f64) -> f64 {
        if area <= 0.0 {
            return 0.0;
        }
        match t_gamma / area {
            x if x < self.severe_from => self.mild * t_gamma,
            x if x < self.catastrophic_from => self.severe * area,
            x => (self.severe + self.catastrophic * (x - self.catastrophic_from)) * area,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 5 and 40 N/mm² over 100 mm²: 26.5 and 55 µg per metre and mm²; the regimes join within 0.3 %.
    #[test]
    fn wear_has_three_regimes_that_join() {
        let law = WearLaw::r8t().scaled(1.0);
        let wear_rate = |t_gamma: f64, area: f64| law.rate(t_gamma, area);
        let area = 1e-4;
        assert!((wear_rate(500.0, area) - 2.65e-6).abs() < 1e-15);
        assert!((wear_rate(4000.0, area) - 5.5e-6).abs() < 1e-15);
        assert!((wear_rate(10e3, area) / 5.5e-6 - 1.0 - 61.9 * 22.8 / 55.0).abs() < 1e-9);
        // Severe below, mild above, if the regimes began elsewhere.
        let beside = [(1039.9, 5.3e-9 * 1039.9), (1040.1, 5.5e-6)];
        assert!(beside.iter().all(|(t_gamma, rate)| (wear_rate(*t_gamma, area) / rate - 1.0).abs() < 1e-12));
        assert!((wear_rate(1039.9, area) / wear_rate(1040.1, area) - 1.0).abs() < 3e-3);
        assert!((wear_rate(7719.9, area) / wear_rate(7720.1, area) - 1.0).abs() < 3e-3);
        assert_eq!([wear_rate(0.0, area), wear_rate(100.0, 0.0)], [0.0; 2]);
    }
}
