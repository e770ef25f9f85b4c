//! Constants that follow from the parameters of the material, each in one place.

use crate::analytic::{self, HalfPlane};

/// An isotropic, linear elastic, heat-conducting material in plane strain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Isotropic {
    /// Young's modulus \[Pa].
    pub youngs_modulus: f64,
    /// Poisson's ratio \[1].
    pub poissons_ratio: f64,
    /// Density [kg/m³].
    pub density: f64,
    /// Coefficient of linear thermal expansion [1/K].
    pub expansion: f64,
    /// Thermal conductivity [W/(m K)].
    pub conductivity: f64,
    /// Specific heat [J/(kg K)].
    pub specific_heat: f64,
}

/// Melting of steel, and the friction of its film.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeltingFilm {
    /// Absolute temperature at which melting begins \[K].
    pub solidus: f64,
    /// Absolute temperature at which it is complete \[K].
    pub liquidus: f64,
    /// Share of the friction coefficient that a film of molten steel has at the liquidus \[1].
    pub friction: f64,
}

impl Isotropic {
    /// Lamé's first constant `λ = Eν/((1 + ν)(1 − 2ν))` \[Pa].
    pub fn lame(&self) -> f64 {
        let (e, nu) = (self.youngs_modulus, self.poissons_ratio);
        e * nu / ((1.0 + nu) * (1.0 - 2.0 * nu))
    }

    /// Shear modulus, Lamé's second constant `μ = E/(2(1 + ν))` \[Pa].
    pub fn shear_modulus(&self) -> f64 {
        0.5 * self.youngs_modulus / (1.0 + self.poissons_ratio)
    }

    /// Modulus of pressure waves and of strain in one direction only, `λ + 2μ` \[Pa].
    pub fn wave_modulus(&self) -> f64 {
        let nu = self.poissons_ratio;
        2.0 * self.shear_modulus() * (1.0 - nu) / (1.0 - 2.0 * nu)
    }

    /// Modulus of uniaxial stress in plane strain, `E/(1 − ν²)` \[Pa].
    pub fn plane_strain_modulus(&self) -> f64 {
        2.0 * self.contact_modulus()
    }

    /// Contact modulus `E*` of two bodies of this material \[Pa].
    pub fn contact_modulus(&self) -> f64 {
        analytic::contact_modulus(self.youngs_modulus, self.poissons_ratio)
    }

    /// Surface of a half-plane of this material.
    pub fn half_plane(&self) -> HalfPlane {
        let nu = self.poissons_ratio;
        HalfPlane {
            kernel: 2.0 / (std::f64::consts::PI * self.plane_strain_modulus()),
            coupling: (1.0 - 2.0 * nu) * (1.0 + nu) / self.youngs_modulus,
        }
    }

    /// Speed of pressure waves `√((λ + 2μ)/ρ)` [m/s].
    pub fn pressure_wave_speed(&self) -> f64 {
        (self.wave_modulus() / self.density).sqrt()
    }

    /// Speed of shear waves `√(μ/ρ)` [m/s].
    pub fn shear_wave_speed(&self) -> f64 {
        (self.shear_modulus() / self.density).sqrt()
    }

    /// Speed of Rayleigh waves [m/s], see [`analytic::rayleigh_speed`].
    pub fn rayleigh_speed(&self) -> f64 {
        analytic::rayleigh_speed(self.shear_wave_speed(), self.poissons_ratio)
    }

    /// Heat capacity per volume `ρc` [J/(m³ K)].
    pub fn heat_capacity(&self) -> f64 {
        self.density * self.specific_heat
    }

    /// Thermal diffusivity `κ = k/(ρc)` [m²/s].
    pub fn diffusivity(&self) -> f64 {
        self.conductivity / self.heat_capacity()
    }

    /// Expansion in the one free direction per temperature where the other two are held, `α (1 + ν)/(1 − ν)` [1/K]: how
    /// much a heated layer on a cold body swells.
    pub fn layer_expansion(&self) -> f64 {
        (1.0 + self.poissons_ratio) / (1.0 - self.poissons_ratio) * self.expansion
    }

    /// Pressure in the plane of such a layer per temperature, `Eα/(1 − ν)` [Pa/K].
    pub fn layer_pressure(&self) -> f64 {
        self.youngs_modulus * self.expansion / (1.0 - self.poissons_ratio)
    }

    /// Gough–Joule factor `T₀ β/(ρc)` with `β = α(3λ + 2μ) = αE/(1 − 2ν)` \[K]: warming per compressive volume strain
    /// at the absolute temperature `reference` \[K] (Draganis, thesis eq. 3.6).
    pub fn gough_joule(&self, reference: f64) -> f64 {
        reference * self.expansion * self.youngs_modulus / (1.0 - 2.0 * self.poissons_ratio) / self.heat_capacity()
    }
}

/// Largest mean pressure of a plastic indentation of a half-plane over the yield strength in tension: Prandtl's `2 + π`
/// times the yield strength in shear, which is that in tension over `√3` (von Mises) \[1].
pub const INDENTATION: f64 = (2.0 + std::f64::consts::PI) / SQRT_3;
/// Yield strength in shear over that in tension (von Mises) \[1].
pub const YIELD_IN_SHEAR: f64 = 1.0 / SQRT_3;
const SQRT_3: f64 = 1.732_050_807_568_877_2;

/// Share of its cold yield strength that steel keeps over the temperature \[K].
///
/// Reduction factors for structural steel at 2 % strain, EN 1993-1-2:2005, table 3.1, linear between the given
/// temperatures and constant beyond the last one; taken for wheel and rail steels, for which no such table was found.
pub fn yield_share(temperature: f64) -> f64 {
    const CELSIUS: [f64; 9] = [400.0, 500.0, 600.0, 700.0, 800.0, 900.0, 1000.0, 1100.0, 1180.0];
    const SHARE: [f64; 9] = [1.0, 0.78, 0.47, 0.23, 0.11, 0.06, 0.04, 0.02, 0.004];
    let celsius = (temperature - CELSIUS_ZERO).clamp(CELSIUS[0], CELSIUS[8]);
    crate::piecewise::interpolate(&CELSIUS, &SHARE, celsius)
}

/// 0 °C \[K].
const CELSIUS_ZERO: f64 = 273.15;
/// Temperature up to which steel keeps its yield strength \[K].
pub const SOFTENS: f64 = 400.0 + CELSIUS_ZERO;

/// Share of the friction coefficient on a surface that may melt \[1], whose temperature is `rest` \[K] and the share
/// times `heating` \[K].
///
/// The share falls from 1 at the solidus to that of the film at the liquidus and to nothing [`FILM_GROWS`]
/// above it, linear between; what is returned is the one that belongs to its own temperature. Molten steel of the
/// asperities and then of a whole film is sheared instead of solid steel. With its viscosity of about 6 mPa s
/// (literature), a film of 1 µm and 20 m/s carry 0.1 MPa, less than a thousandth of the contact pressure: what remains
/// is a small number, and its size is judgement. A film that gets hotter melts more steel and thickens until its own
/// friction no longer heats it.
pub fn melted_share(heating: f64, rest: f64, film: &MeltingFilm) -> f64 {
    let &MeltingFilm { solidus, liquidus, friction: film_friction } = film;
    let heating = heating.max(0.0);
    let fall = (1.0 - film_friction) / (liquidus - solidus);
    let share = (1.0 + fall * (solidus - rest)) / (1.0 + fall * heating);
    if share >= film_friction {
        return share.min(1.0);
    }
    (film_friction * (FILM_GROWS + liquidus - rest) / (FILM_GROWS + film_friction * heating)).max(0.0)
}

/// Temperature at which iron boils \[K] (CRC Handbook of Chemistry and Physics: 2861 °C).
pub const BOILS: f64 = 3134.0;

/// Excess over the liquidus at which the film under the contact no longer carries friction \[K].
pub const FILM_GROWS: f64 = 40.0;

#[cfg(test)]
mod tests {
    use super::*;

    const STEEL: Isotropic = Isotropic {
        youngs_modulus: 2.1e11,
        poissons_ratio: 0.3,
        density: 7850.0,
        expansion: 1.2e-5,
        conductivity: 45.0,
        specific_heat: 460.0,
    };

    #[test]
    fn friction_falls_to_that_of_a_film_at_the_liquidus_and_to_nothing_above_it() {
        let film = MeltingFilm { solidus: 1700.0, liquidus: 1800.0, friction: 0.1 };
        for heating in [0.0, 1300.0, 1400.0, 1420.0, 2000.0, 1e4, 1.51e4, 1e5, 1e6] {
            let share = melted_share(heating, 300.0, &film);
            let temperature = 300.0 + share * heating;
            let molten = ((temperature - 1700.0) / 100.0).clamp(0.0, 1.0);
            let carried = 1.0 - ((temperature - 1800.0) / FILM_GROWS).clamp(0.0, 1.0);
            assert!((share - (1.0 - 0.9 * molten) * carried).abs() < 1e-12, "{heating}: {share}");
        }
        assert_eq!(melted_share(1400.0, 300.0, &film), 1.0);
        assert_eq!(melted_share(100.0, 1841.0, &film), 0.0, "hotter than any film without friction");
        let alone = MeltingFilm { friction: 1.0, ..film };
        assert_eq!(melted_share(1e6, 300.0, &alone), 1.0);
    }

    fn close(a: f64, b: f64) -> bool {
        (a / b - 1.0).abs() < 1e-12
    }

    #[test]
    fn moduli_satisfy_the_identities_of_isotropic_elasticity() {
        let (lame, shear) = (STEEL.lame(), STEEL.shear_modulus());
        assert!(close(STEEL.wave_modulus(), lame + 2.0 * shear));
        assert!(close(STEEL.poissons_ratio, lame / (2.0 * (lame + shear))));
        assert!(close(STEEL.plane_strain_modulus(), 4.0 * shear * (lame + shear) / (lame + 2.0 * shear)));
        assert!(close(STEEL.plane_strain_modulus(), 2.0 * STEEL.contact_modulus()));
        // Johnson, eqs. 2.25, in terms of the shear modulus.
        let half_plane = STEEL.half_plane();
        assert!(close(half_plane.kernel, (1.0 - STEEL.poissons_ratio) / (std::f64::consts::PI * shear)));
        assert!(close(half_plane.coupling, (1.0 - 2.0 * STEEL.poissons_ratio) / (2.0 * shear)));
        let beta = STEEL.expansion * (3.0 * lame + 2.0 * shear);
        assert!(close(STEEL.gough_joule(300.0), 300.0 * beta / (7850.0 * 460.0)));
        assert!(close(STEEL.layer_expansion(), beta / STEEL.wave_modulus()));
        // Stress σ_t = λ ε_n − β T of the layer with σ_n = (λ + 2μ) ε_n − β T = 0.
        assert!(close(STEEL.layer_pressure(), beta - lame * STEEL.layer_expansion()));
        assert!(close(STEEL.density * STEEL.shear_wave_speed().powi(2), shear));
        assert!(close(STEEL.density * STEEL.pressure_wave_speed().powi(2), lame + 2.0 * shear));
        assert!(close(STEEL.diffusivity(), 45.0 / (7850.0 * 460.0)));
    }

    /// Rayleigh's equation `(2 − q)² = 4 √(1 − q) √(1 − q c_S²/c_P²)` with `q = (c_R/c_S)²`.
    #[test]
    fn rayleigh_speed_solves_its_equation_within_half_a_percent() {
        for nu in [0.0, 0.1, 0.2, 0.3, 0.4, 0.49] {
            let material = Isotropic { poissons_ratio: nu, ..STEEL };
            let shear = material.shear_wave_speed();
            let squared = (shear / material.pressure_wave_speed()).powi(2);
            let residual = |q: f64| (2.0 - q).powi(2) - 4.0 * ((1.0 - q) * (1.0 - q * squared)).sqrt();
            let (mut low, mut high) = (0.3_f64, 1.0_f64);
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                if residual(middle) < 0.0 { low = middle } else { high = middle }
            }
            let exact = shear * low.sqrt();
            assert!((material.rayleigh_speed() / exact - 1.0).abs() < 5e-3, "ν = {nu}");
        }
    }
}
