//! Where the results of a run begin to lose their meaning although every step succeeds.

use super::Simulation;
use crate::material::INDENTATION;
use crate::mechanics::nominal_half_width;
use crate::rolling::contact_model::memory_length;

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
    /// Distance from the contact point up to which contact is looked for.
    Reach,
    /// Pressure that steel carries, where it is not limited by yielding.
    Yield,
    /// Pressure under which softened steel spreads as far as the contact zone shows.
    Softening,
    /// Temperature up to which steel is solid.
    Melting,
    /// Internal step that resolves what falling friction excites.
    StickSlip,
    /// Internal step below which friction that falls with the slip has no definite value.
    Chatter,
    /// Wavelength of the surfaces that the contact grid resolves.
    Waves,
    /// Internal step that resolves the shortest wave of the surfaces.
    Sampling,
    /// Residual of the energy balance.
    Energy,
    /// Internal steps that a communication step takes.
    Effort,
    /// Last sample of the profile of the rail.
    End,
}

impl Limit {
    /// All of them.
    const ALL: [Self; 15] = {
        use Limit::*;
        [
            Speed,
            ThermalLoad,
            Patch,
            Zone,
            Reach,
            Yield,
            Softening,
            Melting,
            StickSlip,
            Chatter,
            Waves,
            Sampling,
            Energy,
            Effort,
            End,
        ]
    };
}

/// Elements per half-width of the patch below which traction profiles are no more than a hint.
const FEWEST_ELEMENTS: f64 = 2.0;
/// Elements, and internal steps, per wavelength of a surface below which it is not resolved.
const FEWEST_PER_WAVE: f64 = 4.0;
/// Error of the force over a sharp hole, over load, element and hole, one element added to it, in half-widths \[1]: the edges are found to
/// within an element, and a hole that does not change the height of the wheel takes about a tenth of its squared length off the force.
/// Measured: `docs/theory/profiles.md`, section 6.
const HOLE: f64 = 0.2;
/// Load that the candidate zone carries in any case, over the nominal load.
pub(super) const ZONE_LOAD: f64 = 2.0;
/// Share of the zone in which contact is looked for from which on its end is near \[1].
const NEAR_END: f64 = 0.8;
/// Internal step times the torsional frequency of the wheel, up to which falling friction may excite it: the second-order
/// formula damps it by a ratio of a quarter of its cube, 2e-3.
const RESOLVED_PHASE: f64 = 0.2;
/// Displacement of the tread that answers friction without delay, per friction coefficient under the nominal load, over `a²/R` \[1].
/// Estimated: with it, steps of up to 25 µs are indefinite in `railway_dry`, where those of 20 µs chatter and those of 50 µs do not.
const TREAD_SHIFT: f64 = 1.5;
/// Residual of the energy balance beyond which a run is told of it \[1].
const UNBALANCED: f64 = 0.05;
/// Internal steps in one communication step beyond which a run is told that it takes long \[1]: with heat about half a second.
const MANY_STEPS: f64 = 2000.0;

impl Simulation {
    /// Limits that the present state is beyond.
    pub fn exceeded_limits(&self) -> impl Iterator<Item = Limit> {
        Limit::ALL.into_iter().filter(|limit| {
            let (value, bound) = self.against(*limit);
            match limit {
                Limit::ThermalLoad | Limit::Patch | Limit::Softening | Limit::Chatter | Limit::Waves => {
                    value > 0.0 && value < bound
                }
                _ => value > bound,
            }
        })
    }

    /// The value that a limit is about, and its bound: speeds [m/s], loads \[N], elements \[1], pressures \[Pa], temperatures
    /// \[K] or phases \[rad]. The value is 0 without contact, and that of heat without heat.
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
            Limit::Reach => {
                let extent = self.state().contact.traction.extent();
                (extent.map_or(0.0, |patch| f64::max(-patch.low, patch.high)), NEAR_END * self.model().rolling.reach)
            }
            Limit::Yield => {
                let elastic = if config.physics.yielding { 0.0 } else { 1.0 };
                (elastic * outputs.contact_pressure_max, INDENTATION * config.material.yield_strength)
            }
            Limit::Softening => {
                let [softest, least] = self.model().rolling.contact.softest(self.state());
                (softest, least)
            }
            Limit::Melting => {
                let stays_solid = if config.material.latent_heat > 0.0 { 0.0 } else { 1.0 };
                let hottest = outputs.temperature_wheel_max.max(outputs.temperature_rail_max);
                (stays_solid * hottest, config.material.solidus)
            }
            Limit::StickSlip => (self.unresolved_phase(), RESOLVED_PHASE),
            Limit::Chatter => (self.state().clock.last_step, self.indefinite_step()),
            Limit::Waves => {
                let element = nominal_half_width(config) / config.mesh.elements_per_half_width as f64;
                (self.shortest_wave(), FEWEST_PER_WAVE * element)
            }
            Limit::Sampling => {
                let mean = self.latest_way() / outputs.internal_steps.max(1) as f64;
                (mean.max(speed * self.state().clock.last_step), self.shortest_wave() / FEWEST_PER_WAVE)
            }
            Limit::Energy => (outputs.energy_residual.abs(), UNBALANCED),
            Limit::Effort => (outputs.internal_steps as f64, MANY_STEPS),
            Limit::End => {
                let forward = outputs.wheel_velocity >= 0.0;
                let end = self.model().rolling.contact.surfaces.rail.as_ref().and_then(|rail| rail.end(forward));
                let (place, end) =
                    (outputs.wheel_distance, end.unwrap_or(if forward { f64::INFINITY } else { -f64::INFINITY }));
                if forward { (place, end) } else { (-place, -end) }
            }
        }
    }

    /// Shortest wavelength of the surfaces that have been in the contact zone since the last communication point \[m]; infinite on
    /// smooth ones. A jump counts as one of the length of the nominal patch.
    fn shortest_wave(&self) -> f64 {
        let (rolling, way) = (&self.model().rolling, self.latest_ways());
        let mut middle = self.state().place(rolling.wheel.radius);
        middle.iter_mut().zip(way).for_each(|(place, way)| *place -= 0.5 * way);
        let patch = 2.0 * nominal_half_width(self.model().config());
        rolling.contact.surfaces.wavelength(middle, rolling.zone + 0.5 * self.latest_way(), patch)
    }

    /// Ways of tread and wheel centre in the last communication step \[m]; none at the start.
    fn latest_ways(&self) -> [f64; 2] {
        let (outputs, radius) = (self.outputs(), self.model().config().wheel.radius);
        match self.checkpoint.before.first() {
            Some((_, before)) if outputs.internal_steps > 0 => {
                [radius * (outputs.wheel_angle - before.wheel_angle), outputs.wheel_distance - before.wheel_distance]
            }
            _ => [0.0; 2],
        }
    }

    /// The longer of both \[m].
    fn latest_way(&self) -> f64 {
        self.latest_ways().into_iter().fold(0.0, |longest, way| way.abs().max(longest))
    }

    /// Largest error of the force over a sharp hole \[m] that the grid makes, over the load \[1].
    fn error_over_a_hole(&self, length: f64) -> f64 {
        let config = self.model().config();
        let half_width = nominal_half_width(config);
        let element = half_width / config.mesh.elements_per_half_width as f64;
        HOLE * element * (length + element) / (half_width * half_width)
    }

    /// Phase by which the torsion of the wheel turns in an internal step \[rad], where it may grow: in a sliding contact
    /// whose friction falls with the slip.
    fn unresolved_phase(&self) -> f64 {
        let tuning = self.tuning();
        let falls = tuning.falling_ratio < 1.0 && tuning.falling_decay > 0.0;
        if falls && self.slides() { self.model().rolling.torsion * self.state().clock.last_step } else { 0.0 }
    }

    /// Whether nothing sticks in a loaded contact.
    fn slides(&self) -> bool {
        let outputs = self.outputs();
        outputs.contact_tread_slip != 0.0 && outputs.contact_stick_fraction == 0.0
    }

    /// Internal step up to which several coefficients of friction fit \[s], 0 where one does: the tread has no mass of its own and
    /// answers a lower friction with a slip that lowers it further, unless a memory holds it. Estimated.
    fn indefinite_step(&self) -> f64 {
        let (tuning, config, state) = (self.tuning(), self.model().config(), self.state());
        if !self.slides() {
            return 0.0;
        }
        let outputs = self.outputs();
        let (slip, decay) = (outputs.contact_tread_slip.abs(), tuning.falling_decay);
        let slope = state.available_friction * (1.0 - tuning.falling_ratio) * decay * (-decay * slip).exp();
        let half_width = nominal_half_width(config);
        let load = outputs.contact_force_y / config.model.nominal_load;
        let shift = TREAD_SHIFT * load * half_width * half_width / config.wheel.radius;
        let length = memory_length(tuning);
        let memory = if length > 0.0 { 0.5 * state.clock.last_step * slip / length } else { 1.0 };
        slope.max(0.0) * shift * memory.min(1.0)
    }

    /// What a limit means for the present state, with both numbers and what to change.
    pub fn describe_limit(&self, limit: Limit) -> String {
        let (value, bound) = self.against(limit);
        match limit {
            Limit::Speed => format!(
                "speed {value:.1} m/s ({:.0} km/h) is above thermal.max_speed = {bound:.1} m/s: the thermal boundary layer is \
                 thinner than the mesh, and temperatures are inexact; raise thermal.max_speed, or check the unit of the speed",
                3.6 * value
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
            Limit::Reach => format!(
                "the surfaces touch {:.1} mm from the contact point, and steps in which they touch beyond {:.1} mm are refused: a wider \
                 flat, patch or hole has no room; set mesh.reach (now {:?} m) to {:.3} m or more",
                1e3 * value,
                1e3 * bound / NEAR_END,
                self.model().config().mesh.reach,
                2.0 * value
            ),
            Limit::Yield => format!(
                "peak pressure {:.0} MPa is above {:.0} MPa, which steel of material.yield_strength carries: the bodies \
                 stay elastic, and patch, forces and temperatures are not those of steel that flows; set \
                 physics.yielding, or check drive.load and model.contact_width",
                value * 1e-6,
                bound * 1e-6
            ),
            Limit::Softening => format!(
                "steel under the contact is so hot that it would yield at {:.0} MPa, and the patch would outgrow the contact \
                 zone; it is held together at {:.0} MPa: half-width, pressure and flattening further on are no more than a \
                 hint; end the slide earlier",
                value * 1e-6,
                bound * 1e-6
            ),
            Limit::Melting => format!(
                "contact temperature {value:.0} K is above material.solidus = {bound:.0} K: nothing melts without \
                 material.latent_heat, and temperatures further on are too high; set it, end the slide earlier, or let \
                 the friction fall with friction.softening or friction.falling_ratio"
            ),
            Limit::StickSlip => format!(
                "friction falls with the slip of a sliding wheel, and its torsion of {:.0} rad/s turns by {value:.2} rad \
                 in an internal step, more than {bound:.1}: stick-slip that may arise is damped by the time formula; \
                 lower solver.max_step to {:.1e} s to see it",
                self.model().rolling.torsion,
                0.9 * bound / self.model().rolling.torsion
            ),
            Limit::Chatter => format!(
                "friction falls with the slip so steeply that in internal steps below about {:.1} us, now {:.1} us, several \
                 coefficients fit and friction may jump from step to step; set friction.memory_length (now {:?} m) to 2.5e-5 m",
                1e6 * bound,
                1e6 * value,
                self.tuning().memory_length
            ),
            Limit::Energy | Limit::Effort => self.describe_numerics(limit, value),
            Limit::Waves | Limit::Sampling | Limit::End => self.describe_profile(limit, value, bound),
        }
    }

    /// The same of limits that profiles of wheel and rail have.
    fn describe_profile(&self, limit: Limit, value: f64, bound: f64) -> String {
        match limit {
            Limit::Waves => format!(
                "wheel.profile or rail.profile has waves of {:.2} mm here, shorter than {FEWEST_PER_WAVE:.0} elements of the \
                 contact, {:.2} mm: forces are inexact, over a hole of half that length by up to {:.2} % of the load; raise \
                 mesh.elements_per_half_width, or leave such waves out, which the patch evens out",
                1e3 * value,
                1e3 * bound,
                1e2 * self.error_over_a_hole(0.5 * value)
            ),
            Limit::Sampling => format!(
                "an internal step takes the wheel {:.2} mm on, more than a quarter, {:.2} mm, of the shortest wave of \
                 wheel.profile and rail.profile here: forces are inexact; lower solver.max_step, or set it to 0, which \
                 chooses it by the profile",
                1e3 * value,
                1e3 * bound
            ),
            _ => format!(
                "the contact has passed the last sample of rail.profile at {:.3} m, behind which the rail keeps its last height; \
                 repeat it with file(\"...\", every = length), or give a longer file",
                if self.outputs().wheel_velocity >= 0.0 { bound } else { -bound }
            ),
        }
    }

    /// The same of limits of what has been computed.
    fn describe_numerics(&self, limit: Limit, value: f64) -> String {
        match limit {
            Limit::Energy => format!(
                "energy of {:.1} % of what has been dissipated or is stored is missing (solver.energy_residual): the contact is made, lost \
                 or loaded faster than internal steps of {:.1e} s follow, or load and parameters are beyond what the model is made \
                 for; forces are inexact, too; lower solver.tolerance (now {:?}) or solver.max_step (now {:?} s)",
                1e2 * value,
                self.state().clock.last_step,
                self.tuning().tolerance,
                self.tuning().max_step
            ),
            _ => format!(
                "the last communication step took {value:.0} internal steps, the last one of {:.1e} s, and such steps take long to \
                 compute: the contact changes fast, or solver.tolerance (now {:?}) or solver.max_step (now {:?} s) ask for them",
                self.state().clock.last_step,
                self.tuning().tolerance,
                self.tuning().max_step
            ),
        }
    }
}
