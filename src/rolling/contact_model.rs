//! The contact between wheel and rail: surfaces, solver, and the one place where its problem is put together.

use super::contact_step::ContactStep;
use super::error::StepError;
use super::line::Line;
use super::lines;
use super::load_to_come;
use super::patch_lines::PatchLines;
use super::standing;
use super::state::State;
use super::thermal_state::ThermalDeformation;
use crate::axes::{Axis, PerAxis};
use crate::config::{Config, RowsError};
use crate::contact::limits::borne_in_sliding;
use crate::contact::{
    ActiveSetScratch, ActiveSetSolver, AxisDrive, Begin, ContactError, ContactProblem, ContactState, Friction, Layer,
    LineLayout, LineProblem, SteelLimits, SurfaceResponse, Traction, Undeformed,
};
use crate::material::{INDENTATION, Isotropic, YIELD_IN_SHEAR};
use crate::piecewise::{self, smooth_step};
use crate::surface::{Placement, Surfaces};

/// Contact of the wheel with the rail.
pub struct ContactModel {
    /// Shapes of both surfaces.
    pub surfaces: Surfaces,
    /// How contact forces are found.
    pub solver: ActiveSetSolver,
    /// Lines of the patch.
    pub patch: PatchLines,
    /// Wheel load for which the mesh is laid out [N].
    nominal_load: f64,
    /// Half-width of the Hertzian patch under it [m].
    nominal_half_width: f64,
    /// Width of the line contact [m].
    width: f64,
    /// Layer between the surfaces.
    layer: Layer,
    /// Pressure at which cold steel yields \[Pa]; infinite: never.
    pub yield_pressure: f64,
    /// Yield strength of cold steel in shear \[Pa].
    pub shear_yield: f64,
    /// Half-width of the nominal patch over the shear modulus [m/Pa].
    flows: f64,
    /// Distance from the contact point up to which contact is looked for at all [m].
    reach: f64,
}

impl ContactModel {
    /// Contact of surfaces that may touch up to `reach` \[m] from the contact point.
    ///
    /// # Errors
    /// Rows of a patch without meaning.
    pub fn new(config: &Config, surfaces: Surfaces, solver: ActiveSetSolver, reach: f64) -> Result<Self, RowsError> {
        Ok(Self {
            patch: PatchLines::new(config, surfaces.is_smooth(), reach)?,
            surfaces,
            solver,
            nominal_load: config.model.nominal_load,
            nominal_half_width: config.nominal_patch().half_length,
            width: config.width(),
            layer: Layer { shear: config.contact.layer_flexibility },
            yield_pressure: match config.physics.yielding {
                true => INDENTATION * config.material.yield_strength,
                false => f64::INFINITY,
            },
            shear_yield: YIELD_IN_SHEAR * config.material.yield_strength,
            flows: config.nominal_patch().half_length / Isotropic::from(&config.material).shear_modulus(),
            reach,
        })
    }

    /// How far the material of one of the bodies stands under the patch of a `traction` while the hub moves with the
    /// `velocities` V [m/s] and Ω [rad/s], in steps of `duration` \[s] \[1].
    fn standing(&self, [velocity, omega]: [f64; 2], duration: f64, traction: &Traction) -> f64 {
        let slowest = traction.extent().map_or(0.0, |patch| standing::slowest(patch, duration));
        standing::share(velocity, slowest).max(standing::share(omega * self.surfaces.radius, slowest))
    }

    /// Smallest pressure under which the steel of the present contact would yield, and the smallest that is used \[Pa],
    /// on the line on which the one is the smallest part of the other; zero and zero while nothing yields.
    pub fn softest(&self, state: &State) -> [f64; 2] {
        let lines = state.lines.iter().filter_map(|line| self.softest_of(state, line));
        lines.min_by(|a, b| (a[0] * b[1]).total_cmp(&(b[0] * a[1]))).unwrap_or_default()
    }

    fn softest_of(&self, state: &State, line: &Line) -> Option<[f64; 2]> {
        let traction = &line.contact.traction;
        let bears = self.borne(state, line).filter(|_| traction.yielding.share > 0.0)?;
        Some([bears, self.least_pressure(traction.resultant.height)])
    }

    /// Smallest pressure under which the steel in the patch of a line would yield at its temperatures \[Pa]; `None` if it does not
    /// touch.
    fn borne(&self, state: &State, line: &Line) -> Option<f64> {
        let traction = &line.contact.traction;
        let patch = traction.extent()?;
        let strength = &line.weakening().strength;
        let within = strength.x.iter().zip(&strength.value).filter(|(x, _)| **x > patch.low && **x < patch.high);
        let share = within.map(|(_, share)| *share).fold(1.0, f64::min);
        let standing =
            self.standing([state.motion.velocity.now, state.motion.omega.now], state.clock.last_step, traction);
        Some(self.yield_pressure * share * borne_in_sliding(standing, traction.friction.coefficient))
    }

    /// Smallest pressure under which the steel of some lines would yield at their temperatures \[Pa].
    pub fn softest_steel(&self, lines: &[Line]) -> f64 {
        let shares = lines.iter().flat_map(|line| &line.weakening().strength.value);
        self.yield_pressure * shares.copied().fold(1.0, f64::min)
    }

    /// Largest pressure of a state over what the steel of its line bears \[1], and that \[Pa].
    pub fn overload(&self, state: &State) -> [f64; 2] {
        let overloads = state.lines.iter().filter_map(|line| {
            let traction = &line.contact.traction;
            let bears = self.borne(state, line)?.max(self.least_pressure(traction.resultant.height));
            Some([traction.pressure_max / bears, bears])
        });
        overloads.max_by(|a, b| a[0].total_cmp(&b[0])).unwrap_or_default()
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

    /// Solves for the contact forces of all lines; `start` are the results of the step before.
    ///
    /// Lines are laid out for a load. The search begins with the load that is expected and solves again where it has found
    /// another one: a search by tangents of the load as a function of the approach.
    pub fn solve(
        &self,
        step: &ContactStep,
        start: &[Line],
        found: &mut Vec<Line>,
        scratch: &mut ActiveSetScratch,
    ) -> Result<(), ContactError> {
        found.resize_with(start.len(), Line::default);
        let patch = &*self.patch.at(step.shift);
        let carried = |lines: &[Line]| self.width * lines::sum(lines, |line| line.contact.traction.resultant.height);
        let before = carried(start);
        let expected = load_to_come::expected(patch, step, start, [before, self.nominal_load], self.width);
        let mut load = patch.load_of(expected);
        // More layouts count as iterations: they tell one branch from another.
        let (mut more, first) = (0, load);
        let grows = if before > 0.0 && expected > 0.0 { patch.stretch(expected / before) } else { 1.0 };
        let mut begin = Begin::Before(grows);
        for _ in 0..MOST_LAYOUTS {
            patch.lay_out(load, found);
            self.solve_laid_out((step, patch, begin), start, found, scratch)
                .map_err(|error| self.of_patch(error, load))?;
            let next = patch.load_of(carried(found)).clamp(load / LARGEST_FACTOR, load * LARGEST_FACTOR);
            let next = followed(first, next);
            if !patch.is_sized() || missed(load, next) <= if more == 0 { 0.0 } else { SAME_LOAD } {
                break;
            }
            (load, more, begin) = (next, more + 1, Begin::Found);
        }
        found.iter_mut().for_each(|line| line.contact.traction.iterations += more);
        Ok(())
    }

    /// Failure of lines that are laid out for `load` \[N], whose widths are parts of that of the bodies, as that of the
    /// patch.
    fn of_patch(&self, error: ContactError, load: f64) -> ContactError {
        match error {
            ContactError::ZoneExceeded { zone, .. } if self.patch.is_sized() && load > 0.0 => {
                ContactError::ZoneExceeded { zone, load: load / self.width }
            }
            other => other,
        }
    }

    /// Solves for the contact forces of lines that are laid out.
    fn solve_laid_out(
        &self,
        (step, patch, begin): (&ContactStep, &PatchLines, Begin),
        start: &[Line],
        found: &mut [Line],
        scratch: &mut ActiveSetScratch,
    ) -> Result<(), ContactError> {
        let places: Vec<_> = start.iter().map(|line| self.placement(step, line)).collect();
        let lines = start.iter().zip(step.friction).zip(&places).zip(&*found).enumerate();
        let problem = ContactProblem {
            lines: lines
                .map(|(k, (((line, friction), place), own))| {
                    self.line((step, patch), (line, place), *friction, (k, &own.layout))
                })
                .collect(),
            rigid: step.rigid,
            drift: step.drift,
            nominal_load: self.nominal_line_load(),
            edge_tolerance: step.edge_tolerance,
            begin,
        };
        let before: Vec<_> = start.iter().map(|line| &line.contact).collect();
        let mut after: Vec<_> = found.iter_mut().map(|line| &mut line.contact).collect();
        self.solver.solve(&problem, &before, &mut after, scratch)
    }

    /// Where on the surfaces a line in the state `start` stands.
    fn placement<'a>(&'a self, step: &ContactStep, start: &'a Line) -> Placement<'a> {
        let [distance, angle] = start.place(step.place);
        let flattening = [&start.flattening[0], &start.flattening[1]];
        Placement { surfaces: &self.surfaces, distance, angle, flattening }
    }

    /// Problem of a line with its number and layout, which is in the state `start`.
    fn line<'a>(
        &'a self,
        (step, patch): (&'a ContactStep, &'a PatchLines),
        (start, place): (&'a Line, &'a Placement<'a>),
        friction: Friction,
        (number, layout): (usize, &LineLayout),
    ) -> LineProblem<'a> {
        let ThermalDeformation { radius_growth, swelling, membrane_force, .. } = start.deformation();
        let (weakening, traction) = (start.weakening(), &start.contact.traction);
        LineProblem {
            share: layout.share,
            position: layout.position,
            size: layout.size,
            kernel: layout.kernel,
            layer: self.layer,
            patch: patch.flexibility().map(|patch| layout.in_patch(patch, number)),
            bodies: surface_response(step),
            membrane: [&membrane_force[0], &membrane_force[1]],
            time: step.time,
            duration: step.duration,
            surfaces: Undeformed {
                radius: self.surfaces.radius,
                // On another radius than that of its circle the wheel stands as much higher over the rail.
                growth: *radius_growth + (step.radius - self.surfaces.radius),
                elevation: step.elevation - layout.gap - (step.radius - self.surfaces.radius),
                swelling: [&swelling[0], &swelling[1]],
                uneven: place.unevenness(),
            },
            limits: SteelLimits {
                pressure: self.yield_pressure,
                least: self.least_pressure(traction.resultant.height).max(step.firm),
                sheared: self.standing(
                    [step.rigid.travel.start(), step.rigid.rotation.start()],
                    step.duration,
                    traction,
                ),
                flows: self.flows,
                softened: if step.firm < self.yield_pressure { &weakening.strength } else { &piecewise::EMPTY },
                film: &weakening.film,
            },
            friction,
        }
    }

    /// Contact state of a line with a layout in the patch under a line load [N/m] (the nominal load where none is given), all stuck
    /// and without forces yet. Nodes of lines that go with their load are as much smaller as these are shorter.
    pub fn hertzian_guess(&self, load: f64, layout: &LineLayout) -> ContactState {
        let share = if load > 0.0 { load / self.nominal_line_load() } else { 1.0 };
        let size = layout.size.map_or_else(|| share.sqrt(), |size| size.under_load);
        self.solver.touching(self.nominal_half_width * size)
    }

    /// True if a driving force has jumped from what drove the hub in the last step, prescribed or reaction, or the
    /// available friction coefficient from that of the last step, by more than [`JUMP`].
    pub fn jumped(&self, state: &State, drives: &PerAxis<AxisDrive>, friction: f64) -> bool {
        let jump = JUMP * self.nominal_line_load();
        let available = state.available_friction;
        let speeds = state.motion.velocities();
        let force = |axis: Axis| {
            drives[axis].loads().is_some_and(|[load, limit]| {
                let (resisting, speed) = (state.hub.force[axis] - load, speeds[axis]);
                // A holding brake gives what is asked for.
                let able = if speed == 0.0 { resisting.clamp(-limit, limit) } else { -limit * speed.signum() };
                (resisting - able).abs() > jump * axis.arm(self.surfaces.radius)
            })
        };
        (friction - available).abs() > JUMP * available.max(friction) || Axis::ALL.into_iter().any(force)
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

/// Relative difference of a load from that of a layout \[1]; zero where there is none.
fn missed(load: f64, next: f64) -> f64 {
    if load > 0.0 { (next / load - 1.0).abs() } else { 0.0 }
}

/// Load for which lines are laid out that carry `next` in the layout of the load `first`: the latter within [`SAME_LOAD`],
/// the former from twice as much on, and between them without a jump or a kink.
fn followed(first: f64, next: f64) -> f64 {
    first + smooth_step(missed(first, next) / SAME_LOAD - 1.0) * (next - first)
}

/// Linear answer of the bodies under a line.
fn surface_response<'a>(step: &'a ContactStep) -> SurfaceResponse<'a> {
    let (operators, [wheel, rail]) = (step.operators, step.free);
    SurfaceResponse {
        shared: operators.shared(),
        lift: operators.lift,
        free: [&wheel.surface, &rail.surface],
        inertial: &operators.wheel.inertial_response,
        momentum: &operators.wheel.momentum,
        deformation_inertia: &operators.wheel.deformation_inertia,
    }
}

/// Jump of a driving force relative to the nominal load, or of the friction coefficient relative to itself, that
/// restarts the multistep formula. Smaller ones, such as those of inputs that a master holds for a step, are a part of the
/// course that the formula continues: their force is as exact, in a third of the internal steps.
const JUMP: f64 = 0.1;

/// Most loads for which lines are laid out in a step: a wheel that strikes the rail begins from next to none.
const MOST_LAYOUTS: usize = 12;
/// Largest factor from one of them to the next.
const LARGEST_FACTOR: f64 = 30.0;
/// Relative difference of the load carried from that laid out for which counts as none \[1]. The approach then errs by
/// a ninth of its square.
const SAME_LOAD: f64 = 2e-3;

/// Length of the contact zone over the longest patch of softened steel \[1].
const SPREAD: f64 = 1.15;
