//! Where the results of a run begin to lose their meaning although every step succeeds.

use super::Simulation;
use crate::mechanics::nominal_half_width;

/// A limit of what the meshes resolve.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Limit {
    /// Speed for which the thermal boundary layers are resolved.
    Speed,
    /// Load above which the patch is thermally resolved.
    ThermalLoad,
    /// Elements across the contact patch.
    Patch,
    /// Load for which the candidate zone is laid out.
    Zone,
}

/// Elements per half-width of the patch below which traction profiles are no more than a hint.
const FEWEST_ELEMENTS: f64 = 2.0;
/// Load that the candidate zone carries in any case, over the nominal load.
pub(super) const ZONE_LOAD: f64 = 2.0;

impl Simulation {
    /// Limits that the present state is beyond.
    pub fn exceeded_limits(&self) -> impl Iterator<Item = Limit> {
        [Limit::Speed, Limit::ThermalLoad, Limit::Patch, Limit::Zone].into_iter().filter(|limit| {
            let (value, bound) = self.against(*limit);
            match limit {
                Limit::Speed | Limit::Zone => value > bound,
                Limit::ThermalLoad | Limit::Patch => value > 0.0 && value < bound,
            }
        })
    }

    /// The value that a limit is about, and its bound: speeds [m/s], loads [N] or elements [1]. The value is 0 without
    /// contact, and that of heat without heat.
    fn against(&self, limit: Limit) -> (f64, f64) {
        let (outputs, config) = (self.outputs(), self.model().config());
        let heat = if config.thermal.enabled { 1.0 } else { 0.0 };
        let speed = outputs.wheel_velocity.abs().max((config.wheel.radius * outputs.wheel_omega).abs());
        let (load, nominal) = (outputs.contact_force_y, config.model.nominal_load);
        match limit {
            Limit::Speed => (heat * speed, config.thermal.max_speed),
            Limit::ThermalLoad => (heat * load, config.thermal.smallest_load_ratio * nominal),
            Limit::Patch => {
                let element = nominal_half_width(config) / config.mesh.elements_per_half_width as f64;
                (outputs.contact_half_width / element, FEWEST_ELEMENTS)
            }
            Limit::Zone => (load, ZONE_LOAD * nominal),
        }
    }

    /// What a limit means for the present state, with both numbers and what to change.
    pub fn describe_limit(&self, limit: Limit) -> String {
        let (value, bound) = self.against(limit);
        match limit {
            Limit::Speed => format!(
                "speed {value:.1} m/s is above thermal.max_speed = {bound:.1} m/s: the thermal boundary layer is thinner \
                 than the mesh, and temperatures are inexact; raise thermal.max_speed"
            ),
            Limit::ThermalLoad => format!(
                "contact load {value:.0} N is below thermal.smallest_load_ratio x model.nominal_load = {bound:.0} N: the \
                 patch is shorter than the thermal mesh resolves, and temperatures are inexact; lower \
                 thermal.smallest_load_ratio"
            ),
            Limit::Patch => format!(
                "half-width of the patch is {value:.2} elements, fewer than {bound:.0}: tractions are inexact; raise \
                 mesh.elements_per_half_width, or lower model.nominal_load and set drive.load"
            ),
            Limit::Zone => format!(
                "contact load {value:.0} N is above {ZONE_LOAD:.0} x model.nominal_load = {bound:.0} N, for which the \
                 contact zone is laid out: the patch may reach its end; raise model.nominal_load and set drive.load, \
                 which follows it unless set"
            ),
        }
    }
}
