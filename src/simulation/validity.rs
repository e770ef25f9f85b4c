//! Limits beyond which the results of a run begin to lose their meaning although every step succeeds.

mod met;
mod texts;

use super::Simulation;
use crate::contact::FrictionLaw;
use crate::material::{BOILS, INDENTATION};
use crate::mechanics::BodyParameters;
use crate::rolling::line::Line;

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
    /// Wavelength of the surfaces that contact nodes resolve.
    Waves,
    /// Height of the surfaces that internal steps pass over.
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
/// its squared length off the force. See `docs/theory/profiles.md`, section 6.
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
/// Height that internal steps pass over, over the approach of the bodies under the nominal load, beyond which a run is told of it \[1].
/// The force errs by about half of that share of the load.
const MISSED: f64 = 0.01;
/// Blow of a corner of `rail.elevation`, over the nominal load, beyond which a run is told of it \[1].
const CORNER: f64 = 5e-3;
/// Residual of the energy balance beyond which a run is told of it \[1].
const UNBALANCED: f64 = 0.05;
/// Largest rise of the hub that vibrations are taken to have \[m].
const MOST_RISE: f64 = 1e-3;
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
                let cells = |line: &Line| line.contact.traction.half_width() / line.contact.grid.size;
                (self.state().largest(cells) / self.model().rolling.spacing, AtLeast(FEWEST_ELEMENTS))
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
            Limit::Sampling => (self.missed_height(), AtMost(MISSED * self.nominal_approach())),
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
        let patch = 2.0 * self.model().rolling.contact.nominal_half_width();
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

    /// Ways in an internal step \[m]: the mean of the last communication step, and the last one.
    fn strides(&self) -> [f64; 2] {
        let last = self.speed() * self.state().clock.last_step;
        [self.latest_way() / self.outputs().internal_steps.max(1) as f64, last]
    }

    /// Height of the surfaces that internal steps pass over \[m]; zero where they resolve the shortest wave, or the patch,
    /// which evens out shorter ones.
    fn missed_height(&self) -> f64 {
        let (rolling, patch) = (&self.model().rolling, self.model().rolling.contact.nominal_half_width());
        let seen = self.shortest_wave().max(2.0 * patch) / FEWEST_PER_WAVE;
        let (all, ways, end) = (self.latest_way(), self.latest_ways(), self.state().place(rolling.wheel.radius));
        let [mean, last] = self.strides();
        let of_stride = |(stride, way): (f64, f64)| {
            let share = if all > 0.0 { (way / all).min(1.0) } else { 0.0 };
            let begin = |body: usize| end[body] - share * ways[body];
            let places = [0, 1].map(|body| [begin(body).min(end[body]), begin(body).max(end[body])]);
            if stride > seen { rolling.contact.surfaces.missed(places, stride, patch) } else { 0.0 }
        };
        [(mean, all), (last, last)].into_iter().map(of_stride).fold(0.0, f64::max)
    }

    /// Approach of the bodies under the nominal load, were they rigid but for the contact \[m].
    fn nominal_approach(&self) -> f64 {
        libm::pow(self.model().rolling.contact.nominal_half_width(), 2.0) / (2.0 * self.model().config().wheel.radius)
    }

    /// Loss of more energy than goes with a load that has moved up and down by `rise` \[m]: where vibrations are
    /// damped, a part of that is missing for a while, and comes back, and the force hardly feels it. A slope of the track and a
    /// start in the air are larger than what vibrates: `MOST_RISE` bounds what counts.
    pub fn loses_energy(&self, rise: f64) -> bool {
        let config = self.model().config();
        let goes_along = UNBALANCED * config.model.nominal_load * rise.min(MOST_RISE);
        config.damping.is_none() || self.missing_energy().0 > goes_along
    }

    /// Largest error of the force over a sharp hole of a `length` \[m] by the grid, over the load \[1].
    fn error_over_a_hole(&self, length: f64) -> f64 {
        let config = self.model().config();
        let (half_width, element) =
            (self.model().rolling.contact.nominal_half_width(), BodyParameters::from(config).grid_spacing());
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
    /// contact whose friction falls with the slip by more than the damping of the wheel takes.
    fn unresolved_phase(&self) -> f64 {
        let frequency = self.model().rolling.torsion.frequency;
        if self.excites_torsion() { frequency * self.state().clock.last_step } else { 0.0 }
    }

    /// Friction that falls by `−μ′` with the slip, where it feeds more into the torsion of the wheel than its damping takes:
    /// `P |μ′| > 2 ζ ω m`, after `1 + (ω L/s)²` times less with a memory of the length `L` at the slip `s`.
    fn excites_torsion(&self) -> bool {
        let (law, config, slip) = (FrictionLaw::from(self.tuning()), self.model().config(), self.slip());
        if !self.slides() {
            return false;
        }
        let torsion = self.model().rolling.torsion;
        let late = torsion.frequency * law.memory_length / slip;
        let fall = law.fall(self.state().available_friction, slip) / (1.0 + late * late);
        let damping = 2.0 * config.damping.wheel_torsion * torsion.frequency;
        let mass = config.material.density * torsion.rim_area * config.width();
        fall * self.outputs().contact_force_y > damping * mass
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
        let (outputs, slip) = (self.outputs(), self.slip());
        if slip == 0.0 {
            return 0.0;
        }
        let fall = law.fall(state.available_friction, slip);
        let half_width = self.model().rolling.contact.nominal_half_width();
        let load = outputs.contact_force_y / config.model.nominal_load;
        let shift = TREAD_SHIFT * load * half_width * half_width / config.wheel.radius;
        let length = law.memory_length;
        let memory = if length > 0.0 { 0.5 * state.clock.last_step * slip / length } else { 1.0 };
        fall.max(0.0) * shift * memory.min(1.0)
    }
}
