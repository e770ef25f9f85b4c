//! Limits beyond which the results of a run begin to lose their meaning although every step succeeds.

mod met;
mod texts;

use super::Simulation;
use crate::contact::{FrictionLaw, Ports};
use crate::material::{BOILS, INDENTATION};
use crate::mechanics::{grid_spacing, nominal_half_width};

/// Makes the enumeration and the list of its items.
macro_rules! limits {
    ($($(#[$doc:meta])* $name:ident,)*) => {
        /// A limit of the meshes, the steps or the model.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum Limit {
            $($(#[$doc])* $name,)*
        }

        impl Limit {
            const ALL: &[Self] = &[$(Self::$name),*];
        }
    };
}

limits! {
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
    /// Temperature up to which there is steel at all.
    Boiling,
    /// Internal step that resolves what falling friction excites.
    StickSlip,
    /// Internal step below which friction that falls with the slip has no definite value.
    Chatter,
    /// Wavelength of the surfaces that the contact grid resolves.
    Waves,
    /// Internal step that resolves the shortest wave of the surfaces.
    Sampling,
    /// Blow that a corner of the track gives to the wheel.
    Track,
    /// Residual of the energy balance.
    Energy,
    /// Internal steps that a communication step takes.
    Effort,
    /// Internal steps that solver.max_internal_steps allows.
    Limited,
    /// Last sample of the profile of the rail.
    End,
}

/// Bound within which a value keeps its meaning; a value of zero is always within.
#[derive(Clone, Copy)]
enum Bound {
    AtMost(f64),
    AtLeast(f64),
}

impl Bound {
    fn is_exceeded_by(self, value: f64) -> bool {
        match self {
            Self::AtMost(bound) => value > bound * (1.0 + ROUND_OFF),
            Self::AtLeast(bound) => value > 0.0 && value < bound * (1.0 - ROUND_OFF),
        }
    }

    fn number(self) -> f64 {
        match self {
            Self::AtMost(bound) | Self::AtLeast(bound) => bound,
        }
    }
}

/// Share of a bound by which a value may be beyond it: who sets a load at a bound is within it \[1].
const ROUND_OFF: f64 = 1e-9;
/// Elements per half-width of the patch below which traction profiles are no more than a hint.
const FEWEST_ELEMENTS: f64 = 2.0;
/// Elements, and internal steps, per wavelength of a surface below which it is not resolved.
const FEWEST_PER_WAVE: f64 = 4.0;
/// Error of the force over a sharp hole, over load, element and hole, one element added to it, in half-widths \[1]: the
/// edges are found to within an element, and a hole that does not change the height of the wheel takes about a tenth of
/// its squared length off the force. Measured: `docs/theory/profiles.md`, section 6.
const HOLE: f64 = 0.2;
/// Load that the candidate zone carries in any case, over the nominal load \[1].
pub(super) const ZONE_LOAD: f64 = 2.0;
/// Share of the zone in which contact is looked for from which on its end is near \[1].
const NEAR_END: f64 = 0.8;
/// Internal step times the torsional frequency of the wheel, up to which falling friction may excite it: the
/// second-order formula damps it by a ratio of a quarter of its cube, 2e-3.
const RESOLVED_PHASE: f64 = 0.2;
/// Displacement of the tread that answers friction without delay, per friction coefficient under the nominal load, over
/// `a²/R` \[1]. Estimated: with it, steps of up to 25 µs are indefinite in `railway_dry`, where those of 20 µs chatter
/// and those of 50 µs do not.
const TREAD_SHIFT: f64 = 1.5;
/// Blow of a corner of `rail.elevation`, over the nominal load, beyond which a run is told of it \[1].
const CORNER: f64 = 5e-3;
/// Residual of the energy balance beyond which a run is told of it \[1].
const UNBALANCED: f64 = 0.05;
/// Internal steps in one communication step beyond which a run is told that it takes long \[1]: with heat about half a
/// second.
const MANY_STEPS: f64 = 2000.0;

impl Simulation {
    /// Limits that the present state is beyond.
    pub fn exceeded_limits(&self) -> impl Iterator<Item = Limit> {
        Limit::ALL.iter().copied().filter(|limit| {
            let (value, bound) = self.against(*limit);
            bound.is_exceeded_by(value)
        })
    }

    /// Value of a limit, and its bound: speeds [m/s], loads \[N], lengths \[m], elements \[1], pressures \[Pa],
    /// temperatures \[K] or phases \[rad]. The value is 0 without contact, and that of heat without heat.
    fn against(&self, limit: Limit) -> (f64, Bound) {
        use Bound::{AtLeast, AtMost};
        let (outputs, config) = (self.outputs(), self.model().config());
        let heat = if config.thermal.enabled { 1.0 } else { 0.0 };
        let (load, nominal) = (outputs.contact_force_y, config.model.nominal_load);
        match limit {
            Limit::Speed => (heat * self.speed(), AtMost(config.thermal.max_speed)),
            Limit::ThermalLoad => (heat * load, AtLeast(config.thermal.smallest_load_ratio * nominal)),
            Limit::Patch => {
                let on_grid = self.state().lines.iter().any(|line| line.contact.ports != Ports::Smooth);
                let cells = outputs.contact_half_width / self.model().rolling.spacing;
                (if on_grid { cells } else { 0.0 }, AtLeast(FEWEST_ELEMENTS))
            }
            Limit::Zone => (load, AtMost(ZONE_LOAD * nominal)),
            Limit::Reach => (self.touching_reach(), AtMost(NEAR_END * self.model().rolling.reach)),
            Limit::Yield => {
                let elastic = if config.physics.yielding { 0.0 } else { 1.0 };
                (elastic * outputs.contact_pressure_max, AtMost(INDENTATION * config.material.yield_strength))
            }
            Limit::Softening => {
                let [softest, least] = self.model().rolling.contact.softest(self.state());
                (softest, AtLeast(least))
            }
            Limit::Melting => {
                let melts = config.material.latent_heat > 0.0 && config.thermal.reference < config.material.solidus;
                let stays_solid = if melts { 0.0 } else { 1.0 };
                let hottest = outputs.temperature_wheel_max.max(outputs.temperature_rail_max);
                (stays_solid * hottest, AtMost(config.material.solidus))
            }
            Limit::Boiling => {
                let so_far = [outputs.peak_temperature, outputs.rail_peak, outputs.temperature_wheel_bulk];
                (so_far.into_iter().fold(0.0, f64::max), AtMost(BOILS))
            }
            Limit::StickSlip => (self.unresolved_phase(), AtMost(RESOLVED_PHASE)),
            Limit::Chatter => (self.state().clock.last_step, AtLeast(self.indefinite_step())),
            Limit::Waves => (self.shortest_wave(), AtLeast(FEWEST_PER_WAVE * self.model().rolling.spacing)),
            Limit::Sampling => {
                let mean = self.latest_way() / outputs.internal_steps.max(1) as f64;
                let way = mean.max(self.speed() * self.state().clock.last_step);
                (way, AtMost(self.shortest_wave() / FEWEST_PER_WAVE))
            }
            Limit::Track => (self.blow_of_the_track(), AtMost(CORNER * nominal)),
            Limit::Energy => (outputs.energy_residual.abs(), AtMost(UNBALANCED)),
            Limit::Effort => (outputs.internal_steps as f64, AtMost(MANY_STEPS)),
            Limit::Limited => (outputs.limited_steps as f64, AtMost(0.0)),
            Limit::End => {
                let sign = if outputs.wheel_velocity >= 0.0 { 1.0 } else { -1.0 };
                let end = self.model().rolling.contact.surfaces.rail.end(sign > 0.0);
                (sign * outputs.wheel_distance, AtMost(end.map_or(f64::INFINITY, |end| sign * end)))
            }
        }
    }

    /// Larger one of the speeds of wheel centre and tread [m/s].
    fn speed(&self) -> f64 {
        let (outputs, radius) = (self.outputs(), self.model().config().wheel.radius);
        outputs.wheel_velocity.abs().max((radius * outputs.wheel_omega).abs())
    }

    /// Largest distance from the contact point at which the surfaces touch \[m].
    fn touching_reach(&self) -> f64 {
        self.state()
            .largest(|line| line.contact.traction.extent().map_or(0.0, |patch| f64::max(-patch.low, patch.high)))
    }

    /// Shortest wavelength of the surfaces that have been in the contact zone since the last communication point \[m];
    /// infinite on smooth ones. A jump counts as one of the length of the nominal patch.
    fn shortest_wave(&self) -> f64 {
        let (rolling, way) = (&self.model().rolling, self.latest_ways());
        let mut middle = self.state().place(rolling.wheel.radius);
        middle.iter_mut().zip(way).for_each(|(place, way)| *place -= 0.5 * way);
        let patch = 2.0 * nominal_half_width(self.model().config());
        rolling.contact.surfaces.shortest_wavelength(middle, rolling.zone + 0.5 * self.latest_way(), patch)
    }

    /// Ways of tread and wheel centre in the last communication step \[m]; zero at the start.
    fn latest_ways(&self) -> [f64; 2] {
        let (outputs, radius) = (self.outputs(), self.model().config().wheel.radius);
        match self.checkpoint.before.first() {
            Some((_, before)) if outputs.internal_steps > 0 => {
                [radius * (outputs.wheel_angle - before.wheel_angle), outputs.wheel_distance - before.wheel_distance]
            }
            _ => [0.0; 2],
        }
    }

    /// Longer one of these ways \[m].
    fn latest_way(&self) -> f64 {
        self.latest_ways().into_iter().fold(0.0, |longest, way| way.abs().max(longest))
    }

    /// Largest error of the force over a sharp hole of a `length` \[m] by the grid, over the load \[1].
    fn error_over_a_hole(&self, length: f64) -> f64 {
        let config = self.model().config();
        let (half_width, element) = (nominal_half_width(config), grid_spacing(config));
        HOLE * element * (length + element) / (half_width * half_width)
    }

    /// Force \[N] that the error of the rate of `rail.elevation` may ring the wheel on its contact with: rate `ṡ` times
    /// `√(k m)`, with the stiffness `k` from load and approach, and the mass `m` of the wheel.
    fn blow_of_the_track(&self) -> f64 {
        let (outputs, rolling) = (self.outputs(), &self.model().rolling);
        let stiffness = outputs.contact_force_y / outputs.contact_approach;
        if stiffness.is_nan() || stiffness <= 0.0 {
            return 0.0;
        }
        let mass = rolling.wheel.inertia.height * self.model().config().width();
        self.state().rise.error * (stiffness * mass).sqrt()
    }

    /// Energy \[J] that the balance misses, and the largest error \[N] of the contact force of a wheel that stays on the
    /// rail which goes with it: the force `√(2 k E)` that the energy `E` is worth as an oscillation on the contact. Its
    /// stiffness `k` is that of the nominal patch on rigid bodies, and those of elastic bodies are softer.
    fn missing_energy(&self) -> (f64, f64) {
        let (contact, width) = (&self.model().rolling.contact, self.model().config().width());
        let missing = self.state().audit.imbalance().abs();
        let share = (missing / contact.nominal_energy()).sqrt();
        (width * missing, width * contact.nominal_line_load() * share)
    }

    /// Phase by which the torsion of the wheel turns in an internal step \[rad], where it may grow: in a sliding
    /// contact whose friction falls with the slip.
    fn unresolved_phase(&self) -> f64 {
        let falls = FrictionLaw::from(self.tuning()).slip.falls();
        if falls && self.slides() { self.model().rolling.torsion * self.state().clock.last_step } else { 0.0 }
    }

    /// Mean slip velocity of the tread [m/s].
    fn slip(&self) -> f64 {
        let outputs = self.outputs();
        libm::hypot(outputs.contact_tread_slip, outputs.contact_tread_slip_z)
    }

    /// Full sliding in a loaded contact.
    fn slides(&self) -> bool {
        let outputs = self.outputs();
        self.slip() != 0.0 && outputs.contact_stick_fraction == 0.0
    }

    /// Internal step up to which several coefficients of friction fit \[s], 0 where one does: the tread has no mass of
    /// its own and answers a lower friction with a slip that lowers it further, unless a memory holds it. Estimated.
    fn indefinite_step(&self) -> f64 {
        let (law, config, state) = (FrictionLaw::from(self.tuning()), self.model().config(), self.state());
        if !self.slides() {
            return 0.0;
        }
        let outputs = self.outputs();
        let slip = self.slip();
        let fall = law.fall(state.available_friction, slip);
        let half_width = nominal_half_width(config);
        let load = outputs.contact_force_y / config.model.nominal_load;
        let shift = TREAD_SHIFT * load * half_width * half_width / config.wheel.radius;
        let length = law.memory_length;
        let memory = if length > 0.0 { 0.5 * state.clock.last_step * slip / length } else { 1.0 };
        fall.max(0.0) * shift * memory.min(1.0)
    }
}
