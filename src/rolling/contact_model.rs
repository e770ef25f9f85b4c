//! The contact between wheel and rail: surfaces, solver, and the one place where its problem is put together.

use super::bodies::Operators;
use super::error::StepError;
use super::standing;
use super::state::{State, ThermalDeformation, Weakening};
use crate::config::Config;
use crate::contact::limits::borne_in_sliding;
use crate::contact::{
    AxisDrive, ContactError, ContactProblem, ContactScratch, ContactSolver, ContactState, Friction, LineProblem,
    RetardedSurface, RigidMotion, SteelLimits, SurfaceResponse, Traction,
};
use crate::material::{INDENTATION, YIELD_IN_SHEAR};
use crate::mechanics;
use crate::mechanics::response::FreeResponse;
use crate::multistep::TimeDerivative;
use crate::surface::{Flattening, Placement, Surfaces};

/// Contact of the wheel with the rail.
pub struct ContactModel {
    /// Shapes of both surfaces.
    pub surfaces: Surfaces,
    /// How contact forces are found.
    pub solver: Box<dyn ContactSolver>,
    /// Wheel load for which the mesh is laid out [N].
    nominal_load: f64,
    /// Half-width of the Hertzian patch under it [m].
    nominal_half_width: f64,
    /// Width of the line contact [m].
    width: f64,
    /// Pressure at which cold steel yields [Pa]; infinite: never.
    yield_pressure: f64,
    /// Yield strength of cold steel in shear \[Pa].
    pub shear_yield: f64,
    /// Distance from the contact point up to which contact is looked for at all [m].
    reach: f64,
}

/// Everything that distinguishes one contact problem of a model from another.
pub struct ContactStep<'a> {
    /// Answers of the bodies for this step size.
    pub operators: &'a Operators,
    /// Their answers without contact forces: wheel, rail.
    pub free: &'a [FreeResponse; 2],
    /// The three rigid motions.
    pub rigid: [RigidMotion; 3],
    /// Time formula; all zero: stationary.
    pub time: TimeDerivative,
    /// Length of the step \[s]; zero: stationary.
    pub duration: f64,
    /// Distance travelled \[m] and angle turned \[rad] at the end of the step, as predicted.
    pub place: [f64; 2],
    /// Height of the rail \[m].
    pub elevation: f64,
    /// How heat has deformed the bodies.
    pub deformation: &'a ThermalDeformation,
    /// Permanent flattening of wheel and rail.
    pub flattening: &'a [Flattening; 2],
    /// Strength of the steel after heat has weakened it.
    pub weakening: &'a Weakening,
    /// Friction coefficient as a function of the slip at the end of the step.
    pub friction: Friction,
    /// Largest change of the weights at the contact edges that counts as converged \[1].
    pub edge_tolerance: f64,
}

impl ContactModel {
    /// Contact of surfaces that may touch up to `reach` \[m] from the contact point.
    pub fn new(config: &Config, surfaces: Surfaces, solver: Box<dyn ContactSolver>, reach: f64) -> Self {
        Self {
            surfaces,
            solver,
            nominal_load: config.model.nominal_load,
            nominal_half_width: mechanics::nominal_half_width(config),
            width: config.model.contact_width,
            yield_pressure: match config.physics.yielding {
                true => INDENTATION * config.material.yield_strength,
                false => f64::INFINITY,
            },
            shear_yield: YIELD_IN_SHEAR * config.material.yield_strength,
            reach,
        }
    }

    /// How far the material of one of the bodies stands under the patch of a `traction` while the hub moves with the
    /// `velocities` V [m/s] and Ω [rad/s], in steps of `duration` \[s] \[1].
    fn standing(&self, [velocity, omega]: [f64; 2], duration: f64, traction: &Traction) -> f64 {
        let slowest = traction.extent().map_or(0.0, |patch| standing::slowest(patch, duration));
        standing::share(velocity, slowest).max(standing::share(omega * self.surfaces.radius, slowest))
    }

    /// Smallest pressure under which the steel of the present contact would yield, and the smallest that is used \[Pa];
    /// zero and zero while nothing yields.
    pub fn softest(&self, state: &State) -> [f64; 2] {
        let traction = &state.contact.traction;
        let (Some(patch), true) = (traction.extent(), traction.yielding.share > 0.0) else { return [0.0; 2] };
        let strength = &state.weakening().strength;
        let within = strength.x.iter().zip(&strength.value).filter(|(x, _)| **x > patch.low && **x < patch.high);
        let share = within.map(|(_, share)| *share).fold(1.0, f64::min);
        let standing =
            self.standing([state.motion.velocity.now, state.motion.omega.now], state.clock.last_step, traction);
        let softest = self.yield_pressure * share * borne_in_sliding(standing, traction.friction.coefficient);
        [softest, self.least_pressure(traction.resultant[1])]
    }

    /// Pressure \[Pa] under which the line load of a contact \[N/m] spreads over most of the zone.
    pub fn least_pressure(&self, load: f64) -> f64 {
        SPREAD * load.max(self.nominal_line_load()) / (2.0 * self.reach)
    }

    /// Nominal wheel load per metre of width [N/m].
    pub fn nominal_line_load(&self) -> f64 {
        self.nominal_load / self.width
    }

    /// Half-width of the Hertzian patch under the nominal load \[m].
    pub fn nominal_half_width(&self) -> f64 {
        self.nominal_half_width
    }

    /// Solves for the contact forces; `start` is the result of the step before.
    pub fn solve(
        &self,
        step: &ContactStep,
        start: &ContactState,
        found: &mut ContactState,
        scratch: &mut ContactScratch,
    ) -> Result<(), ContactError> {
        let ThermalDeformation { radius_growth, swelling, membrane_force } = step.deformation;
        let (operators, [wheel, rail]) = (step.operators, step.free);
        let bodies = SurfaceResponse {
            compliance: [&operators.wheel.surface, &operators.rail.surface],
            relative: &operators.relative,
            free: [&wheel.surface, &rail.surface],
            inertial: &operators.wheel.inertial_response,
            momentum: &operators.wheel.momentum,
            deformation_inertia: &operators.wheel.deformation_inertia,
            retarded: [(&operators.wheel, wheel), (&operators.rail, rail)].map(|(operator, free)| {
                let layer = operator.layer.as_ref()?;
                let share = layer.share(operator.a0);
                Some(RetardedSurface { flexibility: &layer.flexibility, share, known: &free.retarded })
            }),
        };
        let [distance, angle] = step.place;
        let line = LineProblem {
            bodies,
            membrane: [&membrane_force[0], &membrane_force[1]],
            time: step.time,
            duration: step.duration,
            surfaces: &self.surfaces,
            placement: Placement {
                distance,
                angle,
                elevation: step.elevation,
                growth: *radius_growth,
                swelling: [&swelling[0], &swelling[1]],
                flattening: [&step.flattening[0], &step.flattening[1]],
            },
            limits: SteelLimits {
                pressure: self.yield_pressure,
                least: self.least_pressure(start.traction.resultant[1]),
                sheared: self.standing([step.rigid[0].start(), step.rigid[2].start()], step.duration, &start.traction),
                softened: &step.weakening.strength,
                film: &step.weakening.film,
            },
        };
        let problem = ContactProblem {
            line,
            rigid: step.rigid,
            friction: step.friction,
            nominal_load: self.nominal_line_load(),
            edge_tolerance: step.edge_tolerance,
        };
        self.solver.solve(&problem, start, found, scratch)
    }

    /// Contact state of the Hertzian patch under a line load [N/m] (the nominal load where none is given), all stuck
    /// and without forces yet.
    pub fn hertzian_guess(&self, load: f64) -> ContactState {
        let share = if load > 0.0 { load / self.nominal_line_load() } else { 1.0 };
        self.solver.touching(self.nominal_half_width * share.sqrt())
    }

    /// True if a driving force has jumped from what drove the hub in the last step, prescribed or reaction, or the
    /// available friction coefficient from that of the last step, by more than [`JUMP`].
    pub fn jumped(&self, state: &State, drives: &[AxisDrive; 3], friction: f64) -> bool {
        let limit = JUMP * self.nominal_line_load();
        let limits = [limit, limit, limit * self.surfaces.radius];
        let available = state.available_friction;
        let speeds = state.motion.velocities();
        let force = |k: usize| {
            drives[k].loads().is_some_and(|[load, limit]| {
                let resisting = state.hub.force[k] - load;
                // A holding brake gives what is asked for.
                let able = if speeds[k] == 0.0 { resisting.clamp(-limit, limit) } else { -limit * speeds[k].signum() };
                (resisting - able).abs() > limits[k]
            })
        };
        (friction - available).abs() > JUMP * available.max(friction) || (0..3).any(force)
    }

    /// Turns a failure in a step of `step` seconds at `time` into that of the step.
    pub fn failure(&self, source: ContactError, time: f64, step: f64) -> StepError {
        match source {
            ContactError::ZoneExceeded { zone, load } => StepError::ZoneExceeded { zone, load: load * self.width },
            source => StepError::Contact { time, step, source },
        }
    }

    /// Elastic energy of the contact under the nominal load, from its Hertzian penetration `a²/2r` [J/m].
    pub fn nominal_energy(&self) -> f64 {
        let penetration = self.nominal_half_width.powi(2) / (2.0 * self.surfaces.radius);
        0.5 * self.nominal_line_load() * penetration
    }
}

/// Jump of a driving force relative to the nominal load, or of the friction coefficient relative to itself, that
/// restarts the multistep formula.
const JUMP: f64 = 0.02;

/// Length of the contact zone over the longest patch of softened steel \[1].
const SPREAD: f64 = 1.15;
