//! One line on its way to the solution on a single patch.

use super::chebyshev::Arch;
use super::constants::Constants;
use super::hot_layers::{self, SeriesLayers};
use super::places::{AtPlaces, Places, hub_arm, total};
use super::state::{SeriesState, Tractions, Uncorrected};
use super::surface::{AtPoints, Moments, SmoothSurfaces, plus};
use super::tables::{POWER, QUADRATURE};
use crate::axes::PerAxis;
use crate::contact::flexibility::{ByPowers, Field};
use crate::contact::line::LineHistory;
use crate::contact::problem::{LineProblem, OneLine};
use crate::contact::solver::ContactState;
use crate::contact::traction::Traction;
use crate::linalg::POINTS;

/// Result of the step before.
#[derive(Clone, Copy)]
pub struct SeriesStart<'a> {
    pub before: &'a SeriesState,
    pub history: &'a LineHistory,
    pub traction: &'a Traction,
}

impl<'a> SeriesStart<'a> {
    /// Start of a line that the series have solved before.
    pub fn of(state: &'a ContactState) -> Option<Self> {
        Some(Self { before: state.solver.series()?, history: &state.history, traction: &state.traction })
    }
}

/// The lateral direction of a line.
#[derive(Clone, Copy, Debug, Default)]
pub struct Across {
    /// Moments of the shear across with the powers of the places [N/m].
    pub powers: ByPowers,
    /// Displacement and strain across by the lines of the patch under their present shear.
    pub field: Field,
    /// See [`SeriesState::uncorrected`].
    pub uncorrected: Uncorrected,
    /// Slip across at the places of [`SeriesLine::slips`] [m/s], once the solution has been checked.
    pub slips: [f64; POWER],
}

/// A line with a single patch in the present iterate.
pub struct SeriesLine<'a> {
    pub constants: &'a Constants,
    pub problem: OneLine<'a>,
    pub before: &'a SeriesState,
    pub history: &'a LineHistory,
    /// Hot layers; `None`: the surfaces are cold.
    pub layers: Option<SeriesLayers>,
    /// Moments of their pulls on wheel and rail, and the mean of those of all lines.
    pub pulls: [AtPoints; 2],
    pub mean_pulls: [AtPoints; 2],
    pub tractions: Tractions,
    /// V [m/s], U \[m], Ω [rad/s].
    pub rigid: PerAxis<f64>,
    /// Tractions, motions and friction with which the search began.
    begun: (Tractions, PerAxis<f64>, f64),
    /// See [`SeriesState::slope`].
    pub slope: f64,
    /// See [`SeriesState::law_slope`].
    pub law_slope: f64,
    /// Rim angle \[rad].
    pub rim_angle: f64,
    /// Friction coefficient \[1], and that of the step before.
    pub friction: f64,
    pub before_friction: f64,
    /// Places of the pressure.
    pub pressed: Places,
    /// Their forces times the height of the hub above them \[N].
    hub_arm: f64,
    /// Places of the shear of [`Tractions::stick`].
    pub stuck: Places,
    /// Load of all lines per metre of the bodies' width [N/m].
    pub mean_load: f64,
    /// Moments of its tractions.
    pub moments: Moments,
    /// Smooth displacements under the tractions of all lines.
    pub surface: SmoothSurfaces,
    /// Length by which places on the line are measured \[m].
    pub half_length: f64,
    /// Moments of pressure and shear with the powers of these places [N/m].
    pub powers: [ByPowers; 2],
    /// Effect of the lines of the patch under their present shear.
    pub field: Field,
    /// Its lateral direction.
    pub across: Across,
    /// Slip at the places of [`Self::slipping`] [m/s], once the solution has been checked.
    pub slips: [f64; POWER],
}

impl<'a> SeriesLine<'a> {
    pub fn new(constants: &'a Constants, problem: OneLine<'a>, start: &SeriesStart<'a>) -> Self {
        let SeriesStart { before, history, traction } = *start;
        let mut rigid = problem.rigid.map(|motion| motion.start());
        rigid.height = problem.rigid.height.target().unwrap_or(traction.rigid.height);
        let tractions = before.expected(&problem.line.time);
        let friction = problem.line.friction.coefficient(traction.friction.slip_speed);
        let layers = SeriesLayers::new(constants, &problem, &before.tractions.pressure);
        Self {
            constants,
            problem,
            before,
            history,
            pulls: hot_layers::pulls(&layers),
            mean_pulls: Default::default(),
            layers,
            tractions,
            rigid,
            begun: (tractions, rigid, friction),
            slope: before.slope,
            law_slope: before.law_slope,
            rim_angle: history.rim_angle.now,
            friction,
            before_friction: traction.friction.coefficient,
            pressed: Places::default(),
            hub_arm: 0.0,
            stuck: Places::default(),
            mean_load: 0.0,
            moments: Moments::default(),
            surface: SmoothSurfaces::default(),
            half_length: problem.line.patch.map_or(before.tractions.pressure.half_width, |patch| patch.half_length),
            powers: Default::default(),
            field: Field::default(),
            across: Across { uncorrected: before.uncorrected, ..Across::default() },
            slips: [0.0; POWER],
        }
    }

    /// Returns to where the search began.
    pub fn begin_anew(&mut self) {
        (self.tractions, self.rigid, self.friction) = self.begun;
        (self.slope, self.law_slope) = (self.before.slope, self.before.law_slope);
        self.rim_angle = self.history.rim_angle.now;
    }

    /// Goes on in another layout, with its load times `factor`.
    pub fn relay(&mut self, line: &'a LineProblem<'a>, factor: f64) {
        let further = line.kernel.tangential.reach - self.problem.line.kernel.tangential.reach;
        if let Some(layers) = &mut self.layers {
            layers.reach_further(further);
        }
        self.half_length = line.patch.map_or(self.half_length, |patch| patch.half_length);
        self.problem.line = line;
        self.resize(0.0, factor);
    }

    /// Velocity with which the rim passes the contact [m/s].
    pub fn rim_velocity(&self) -> f64 {
        let time = &self.problem.line.time;
        self.problem.line.radius()
            * (self.rigid.rotation - time.a0 * self.rim_angle - self.history.rim_angle.offset(time))
    }

    /// Side from which the material arrives: 1 from `+x`.
    pub fn upstream(&self) -> f64 {
        // Points must not change sides with the rim of a wheel that stands.
        let rim = match self.is_sideways() {
            true => self.problem.line.radius() * self.rigid.rotation,
            false => self.rim_velocity(),
        };
        if self.rigid.travel + rim >= 0.0 { 1.0 } else { -1.0 }
    }

    /// Sum of the speeds of both surfaces [m/s].
    pub fn speed(&self) -> f64 {
        self.rigid.travel.abs() + self.rim_velocity().abs()
    }

    /// Load of the patch [N/m].
    pub fn load(&self) -> f64 {
        self.tractions.pressure.total()
    }

    /// Rigid accelerations with the present motions.
    pub fn accelerations(&self) -> PerAxis<f64> {
        PerAxis::from_fn(|axis| self.problem.rigid[axis].acceleration(self.rigid[axis]))
    }

    /// Effect of hot layers at x; zero where the surfaces are cold.
    pub fn warm<const N: usize>(&self, x: &[f64; N], of: impl Fn(&SeriesLayers, &[f64; N]) -> [f64; N]) -> [f64; N] {
        self.layers.as_ref().map_or([0.0; N], |layers| of(layers, x))
    }

    /// `∫ p f dx` for something that hot layers do.
    pub fn over_pressure(&self, f: impl Fn(&SeriesLayers, &[f64; QUADRATURE]) -> [f64; QUADRATURE]) -> f64 {
        total(&self.pressed.force, &self.warm(&self.pressed.x, f))
    }

    /// `∫ q f dx`.
    pub fn over_shear(&self, f: impl Fn(&SeriesLayers, &[f64; QUADRATURE]) -> [f64; QUADRATURE]) -> f64 {
        let slipping = self.tractions.slide * self.over_pressure(&f);
        if self.tractions.slides() {
            return slipping;
        }
        slipping + total(&self.stuck.force, &self.warm(&self.stuck.x, f))
    }

    /// Tangential displacement of the wheel less that of the rail at the points, but for `−2κ ∫ q ln|x − s| ds` under
    /// the pressure's friction `q` and, if `sticks`, the part that sticking takes away from it.
    pub fn relative(&self, surface: &SmoothSurfaces, sticks: bool) -> AtPoints {
        let (smooth, kernel) = (surface.relative(), self.problem.line.kernel.tangential);
        let stick = if sticks { self.tractions.stick } else { Arch::default() };
        let reach = 2.0 * kernel.factor * kernel.reach * Tractions { stick, ..self.tractions }.total();
        let warm = self.layers.as_ref().map_or([0.0; POINTS], |layers| layers.relative);
        std::array::from_fn(|k| smooth[k] + warm[k] + reach)
    }

    /// Places and moments of the pressure.
    pub fn place_pressure(&mut self) {
        let Constants { tables, points, .. } = self.constants;
        let pressure = &self.tractions.pressure;
        if let Some(layers) = &mut self.layers {
            layers.fit(pressure);
        }
        self.pressed.put(tables, points, [pressure; 2], self.half_length);
        self.hub_arm = hub_arm(&self.pressed, self.problem.line.surfaces.radius);
        (self.moments.normal, self.powers[0]) = (self.pressed.moments, self.pressed.powers);
        self.slide_all();
    }

    /// Places of the shear, and the moments of pressure and shear.
    pub fn place_shear(&mut self) {
        let Constants { tables, points, .. } = self.constants;
        self.slide_all();
        let Tractions { pressure, stick, .. } = &self.tractions;
        if stick.half_width == 0.0 {
            self.stuck = Places::default();
            return;
        }
        self.stuck.put(tables, points, [stick, pressure], self.half_length);
        self.moments.tangential = plus(&self.moments.tangential, &self.stuck.moments);
        self.powers[1] = plus(&self.powers[1], &self.stuck.powers);
    }

    /// Takes the moments of the shear with which all of the patch slips.
    pub fn slide_all(&mut self) {
        let slide = self.tractions.slide;
        self.moments.tangential = self.moments.normal.map(|moment| slide * moment);
        self.powers[1] = self.powers[0].map(|moment| slide * moment);
    }

    /// Takes smooth displacements under the present tractions, and the rim angle: the mean of `û_x` over the pressure
    /// vanishes.
    pub fn displace(&mut self, surface: SmoothSurfaces) {
        self.surface = surface;
        let (kernel, arm) = (self.problem.line.kernel.tangential, self.hub_arm);
        let along = &self.surface.wheel.tangential;
        let mut sum = self.pressed.moved(along, kernel.factor * self.tractions.slide);
        sum += self.over_pressure(|layers, _| layers.along[0]);
        // Betti: the work of the pressure on the displacements by the shear is that of the shear on those by the
        // pressure.
        sum -= kernel.factor * self.stuck.work;
        sum += kernel.factor * kernel.reach * self.load() * self.friction_force();
        // Without a load the middle of the places stands for its mean.
        self.rim_angle = match arm > 0.0 {
            true => sum / arm,
            false => {
                let middle = self.constants.points.polynomial(along).at(self.tractions.pressure.centre);
                middle / self.problem.line.surfaces.radius
            }
        };
    }

    /// Tangential force on the wheel [N/m].
    pub fn friction_force(&self) -> f64 {
        let Tractions { pressure, slide, stick, .. } = &self.tractions;
        slide * pressure.total() + stick.total()
    }

    /// Forces of the line on the wheel: x, y [N/m], forward moment \[N].
    pub fn resultant(&self) -> PerAxis<f64> {
        let (tangential, line) = (self.friction_force(), &self.problem.line);
        let middle = self.half_length * self.pressed.powers[1];
        let rotation = line.grown() * self.lifted() - line.radius() * tangential - line.grown() * middle;
        PerAxis { travel: tangential, height: self.load(), rotation, lateral: self.tractions.lateral.total() }
    }

    /// Part of the moment that the deformation of the wheel changes \[N]. Lever arms are those of the deformed wheel
    /// about the turned rim, where the mean of `û_x` over the pressure vanishes. The line's own flexibility does not
    /// turn with the wheel: of its displacements the tangential one by the shear, which has entered the rim angle, is
    /// taken back, and the normal one has no part (`docs/theory/lines.md`, section 3).
    pub fn lifted(&self) -> f64 {
        let kernel = self.problem.line.kernel.tangential;
        let lift = |places: &Places| {
            let tilt = self.rim_angle * self.half_length * places.powers[1];
            places.moved(&self.surface.wheel.normal, kernel.factor) - tilt
        };
        // Places hold the shear to which these displacements belong.
        let force = self.tractions.slide * self.load() + self.stuck.powers[0];
        let height = kernel.factor * kernel.reach * self.load() + self.problem.line.bodies.lift * self.mean_load;
        self.tractions.slide * lift(&self.pressed) + lift(&self.stuck) + height * force
    }

    /// Ends of the slipping part \[m]; `None` where all sticks.
    pub fn slipping_ends(&self) -> [f64; 2] {
        let (patch, stick) = (self.tractions.pressure.ends(), self.tractions.stick.ends());
        let throughout = self.tractions.slides() || self.tractions.directions.is_some();
        match (throughout, self.upstream() > 0.0) {
            (true, _) => patch,
            (false, true) => [patch[0], stick[0]],
            (false, false) => [stick[1], patch[1]],
        }
    }

    /// Places of the slipping part \[m], and the friction forces that belong to them [N/m].
    pub fn slipping(&self) -> ([f64; POWER], [f64; POWER]) {
        let (tables, [low, high]) = (&self.constants.tables, self.slipping_ends());
        let (centre, half) = (0.5 * (low + high), 0.5 * (high - low));
        let places = tables.places.map(|t| centre + half * t);
        let densities = match self.tractions.directions {
            Some(_) => self.tractions.stick.density(&places),
            None => self.tractions.pressure.density(&places).map(|p| self.tractions.slide * p),
        };
        let force = |q: usize| half * tables.weights[q] * densities[q];
        (places, std::array::from_fn(force))
    }

    /// Mean of a quantity at the places of the pressure, weighted with it.
    pub fn mean_under_pressure(&self, values: &AtPlaces) -> f64 {
        let load = self.load();
        if load > 0.0 { total(&self.pressed.force, values) / load } else { 0.0 }
    }

    /// Mean slip over the pressure [m/s], once the solution has been checked.
    pub fn tread_slip(&self) -> f64 {
        let slide = self.tractions.slide;
        if self.is_sideways() {
            return self.mean_under_pressure(&self.slips);
        }
        if slide != 0.0 {
            let (_, force) = self.slipping();
            return force.iter().zip(&self.slips).map(|(f, s)| f * s).sum::<f64>() / (slide * self.load());
        }
        total(&self.pressed.force, &self.slip(&self.pressed.x, &self.surface, true)) / self.load()
    }
}
