//! Radiation of the surfaces that touch the air.

use crate::config::Thermal;
use crate::heat::tensor::mesh::body::HeatBody;

/// Constant of Stefan and Boltzmann [W/(m² K⁴)].
const STEFAN_BOLTZMANN: f64 = 5.670_374_419e-8;

/// Radiation of a body during a step, even along its streamlines.
#[derive(Clone, Debug, Default)]
pub struct Radiation {
    /// Load on every mode [W/m²]; empty without radiation.
    pub load: Vec<f64>,
    /// Heat lost [W/m].
    pub heat: f64,
    /// Field summed along the streamlines.
    sums: Vec<f64>,
}

impl Radiation {
    /// Radiation during a step of `dt` seconds after the temperatures `field`.
    ///
    /// It follows from the mean temperatures along the streamlines at the beginning of the step. The factor
    /// `(1 − e⁻ˣ)/x`, with `x` the step over the time in which the whole body would cool, accounts for the cooling
    /// within the step: long steps are right to first order and never cool below the surroundings.
    pub fn set(&mut self, body: &HeatBody, thermal: &Thermal, field: &[f64], dt: f64) {
        let Self { load, heat, sums } = self;
        load.clear();
        *heat = 0.0;
        if thermal.emissivity <= 0.0 {
            return;
        }
        let modes = &body.modes;
        body.integrate(field, sums);
        let length: f64 = body.streamline.weights.iter().sum();
        load.resize(modes.len(), 0.0);
        let (strength, mut slope) = (thermal.emissivity * STEFAN_BOLTZMANN, 0.0);
        for (row, exposed) in modes.shapes.row_iter().zip(&modes.exposed) {
            let mean = row.iter().zip(&*sums).map(|(shape, sum)| shape * sum).sum::<f64>() / length;
            let temperature = (thermal.reference + mean).max(0.0);
            let flux = strength * exposed * (temperature.powi(4) - thermal.reference.powi(4));
            slope += 4.0 * strength * exposed * temperature.powi(3);
            load.iter_mut().zip(row.iter()).for_each(|(load, shape)| *load -= flux * shape);
            *heat += flux * length;
        }
        let cooled = dt * slope / (body.heat_capacity * modes.section);
        let share = if cooled > 0.0 { -libm::expm1(-cooled) / cooled } else { 1.0 };
        load.iter_mut().for_each(|load| *load *= share);
        *heat *= share;
    }
}
