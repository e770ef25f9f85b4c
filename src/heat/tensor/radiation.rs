//! Radiation of the surfaces that touch the air.

use super::layout::Heat;
use super::modal::HeatBody;
use super::state::HeatState;

/// Constant of Stefan and Boltzmann [W/(m² K⁴)].
const STEFAN_BOLTZMANN: f64 = 5.670_374_419e-8;

/// What a body radiates during a step, even along its streamlines.
#[derive(Clone, Debug, Default)]
pub(super) struct Radiation {
    /// Load on every mode [W/m²]; empty without radiation.
    pub load: Vec<f64>,
    /// Heat lost [W/m].
    pub heat: f64,
    /// Field summed along the streamlines.
    sums: Vec<f64>,
}

impl Heat {
    /// Replaces `radiation` by what wheel and rail radiate during a step of `dt` seconds after `state`.
    ///
    /// It follows from the mean temperatures along the streamlines at the beginning of the step. What falls with the
    /// temperature on the way, `(1 − e⁻ˣ)/x` with `x` the step over the time in which the whole body would cool, keeps the
    /// heat of long steps right to first order and never cools below the surroundings.
    pub(super) fn set_radiation(&self, state: &HeatState, dt: f64, radiation: &mut [Radiation; 2]) {
        let (wheel, rail) = self.split(state);
        for ((body, field), radiation) in [(&self.wheel, wheel), (&self.rail, rail)].into_iter().zip(radiation) {
            radiation.load.clear();
            radiation.heat = 0.0;
            if self.config.thermal.emissivity > 0.0 {
                self.radiate(body, field, dt, radiation);
            }
        }
    }

    fn radiate(&self, body: &HeatBody, field: &[f64], dt: f64, radiation: &mut Radiation) {
        let (modes, thermal) = (&body.modes, &self.config.thermal);
        let Radiation { load, heat, sums } = radiation;
        body.integrate(field, sums);
        let length: f64 = body.line.weights.iter().sum();
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
        let share = if cooled > 0.0 { -(-cooled).exp_m1() / cooled } else { 1.0 };
        load.iter_mut().for_each(|load| *load *= share);
        *heat *= share;
    }
}
