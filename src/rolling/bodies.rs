//! The deformable wheel and rail, and their answers for the step sizes in use.

use super::line::Line;
use super::lines;
use super::state::State;
use super::support::{CondensedBase, TrackSupport};
use crate::axes::PerAxis;
use crate::contact::line::kernel::{line_compliance, line_energy, logarithms};
use crate::contact::{Influence, LineKernel, Ports};
use crate::lru::Lru;
use crate::mechanics::response::{BodyState, Convection, FreeResponse, StepOperator};
use crate::mechanics::{BodyResponse, MechanicsError, Pair};
use crate::multistep::TimeDerivative;
use nalgebra::DMatrix;
use std::sync::Arc;

/// Wheel and rail, and what carries the rail.
///
/// Their coordinates do not depend on the [`Ports`] through which the contact of a state sees them.
pub struct Bodies {
    /// Annulus on its hub, plate on its base; of their surfaces only the ports of ordinary patches.
    narrow: [Box<dyn BodyResponse>; 2],
    /// Both with the ports of wide ones.
    wide: Option<[Box<dyn BodyResponse>; 2]>,
    /// Both less half-planes, for a solver that knows those.
    smooth: [Box<dyn BodyResponse>; 2],
    /// Track below its base; `None`: the base is fixed.
    pub support: Option<TrackSupport>,
    /// Positions of the nodes of the narrow and of the wide ports \[m], and their distance in the middle \[m].
    nodes: ([Vec<f64>; 2], f64),
    /// Flexibility of one body that belongs to lines, where they have one of their own beside that of the bodies, and
    /// the logarithms of the distances of the nodes of the narrow and of the wide ports \[1].
    apart: Option<(LineKernel, [Arc<DMatrix<f64>>; 2])>,
}

/// Answers of both bodies for one step size.
pub struct Operators {
    /// Weight of the new value in the time formula [1/s].
    pub a0: f64,
    /// Ports to which they belong.
    pub ports: Ports,
    /// Of the wheel.
    pub wheel: StepOperator,
    /// Of the rail on its support.
    pub rail: StepOperator,
    /// Its base, unless it is fixed.
    pub base: Option<CondensedBase>,
    /// Sum of both surface compliances [m/(N/m)].
    pub relative: DMatrix<f64>,
    /// Sums and parts of the compliances that all lines share; `None`: there is a single line.
    shared: Option<Compliances>,
    /// See [`crate::contact::SurfaceResponse::lift`].
    pub lift: f64,
    /// Logarithms of the distances of the nodes \[1]; `None`: lines have no flexibility of their own, or the ports are
    /// smooth, and their solver knows it.
    logarithms: Option<Arc<DMatrix<f64>>>,
}

/// Compliances of wheel and rail, and their sum [m/(N/m)].
type Compliances = ([DMatrix<f64>; 2], DMatrix<f64>);

impl Operators {
    /// Displacements by the forces of all lines.
    pub fn shared(&self) -> Influence<'_> {
        match &self.shared {
            Some(shared) => influence(shared),
            None => Influence { compliance: [&self.wheel.surface, &self.rail.surface], relative: &self.relative },
        }
    }

    /// Logarithms of the distances of all nodes, where lines have a flexibility of their own \[1].
    pub fn logarithms(&self) -> Option<&DMatrix<f64>> {
        self.logarithms.as_deref()
    }
}

fn influence(([wheel, rail], relative): &Compliances) -> Influence<'_> {
    Influence { compliance: [wheel, rail], relative }
}

/// Operators of a dozen step sizes, those of steps that are halved and joined again, by their `a0` and ports; never part
/// of a state.
pub type KeptOperators = Lru<(f64, Ports), Arc<Operators>, 12>;

impl Bodies {
    /// Wheel and rail, the rail on its `support`.
    pub fn new(pair: Pair, support: Option<TrackSupport>) -> Self {
        let wings = pair.wide.as_ref().map_or(Vec::new(), |wide| wide.surface_x.clone());
        let nodes = ([pair.surface_x, wings], pair.spacing);
        let wide = pair.wide.map(|pair| [pair.wheel, pair.rail]);
        let smooth = [pair.smooth.wheel, pair.smooth.rail];
        Self { narrow: [pair.wheel, pair.rail], wide, smooth, support, nodes, apart: None }
    }

    /// Wheel and rail as the contact of a state sees them.
    fn of(&self, state: &State) -> [&dyn BodyResponse; 2] {
        let other = match lines::ports(&state.lines) {
            Ports::Narrow => None,
            Ports::Wide => self.wide.as_ref(),
            Ports::Smooth => Some(&self.smooth),
        };
        let [wheel, rail] = other.unwrap_or(&self.narrow);
        [&**wheel, &**rail]
    }

    /// Both bodies at rest, undeformed.
    pub fn at_rest(&self) -> [BodyState; 2] {
        [0, 1].map(|body| BodyState::zeros(self.narrow[body].state_len()))
    }

    /// Takes from each body the flexibility `kernel`, in whose place lines have one of their own.
    pub fn with_lines(mut self, kernel: LineKernel) -> Self {
        let (nodes, spacing) = &self.nodes;
        self.apart = Some((kernel, nodes.each_ref().map(|nodes| Arc::new(logarithms(nodes, *spacing)))));
        self
    }

    /// Logarithms of the distances of the nodes of given ports, where lines have a flexibility of their own \[1].
    fn logarithms(&self, ports: Ports) -> Option<&Arc<DMatrix<f64>>> {
        let (_, [narrow, wide]) = self.apart.as_ref()?;
        match ports {
            Ports::Narrow => Some(narrow),
            Ports::Wide => Some(wide),
            Ports::Smooth => None,
        }
    }

    /// Compliances of wheel and rail less the flexibility that belongs to lines, where they have one of their own.
    fn shared(&self, ports: Ports, surfaces: [&DMatrix<f64>; 2]) -> Option<Compliances> {
        let (kernel, _) = self.apart.as_ref()?;
        let apart = match self.logarithms(ports) {
            Some(logarithms) => line_compliance(kernel, logarithms),
            // Bodies at smooth ports lack the logarithms already.
            None => line_compliance(kernel, &DMatrix::zeros(surfaces[0].nrows() / 2, surfaces[0].nrows() / 2)),
        };
        let [wheel, rail] = surfaces.map(|surface| surface - &apart);
        let sum = &wheel + &rail;
        Some(([wheel, rail], sum))
    }

    /// Elastic energy of the contact that the bodies do not count [J/m].
    pub fn energy_of_contact(&self, state: &State) -> f64 {
        state.sum(|line| line.contact.energy) + self.energy_of_lines(state)
    }

    /// Elastic energy of the flexibility of lines that the bodies do not count, less that which they count in its place
    /// [J/m].
    fn energy_of_lines(&self, state: &State) -> f64 {
        let Some((apart, _)) = &self.apart else { return 0.0 };
        let Some(logarithms) = self.logarithms(lines::ports(&state.lines)) else {
            // Solvers of smooth ports count the logarithms.
            let sum = |body: usize, component: usize| state.loads(body).iter().skip(component).step_by(2).sum::<f64>();
            let constant = |component: usize| apart.along(component).displacement(0.0);
            let of_body = |body: usize| [0, 1].map(|c| 0.5 * constant(c) * sum(body, c).powi(2)).iter().sum::<f64>();
            return state.sum(|line| line.layout.energy) - of_body(0) - of_body(1);
        };
        let counted: f64 = [0, 1].map(|body| line_energy(apart, logarithms, &state.loads(body))).iter().sum();
        let of_line = |line: &Line| {
            let loads = line.contact.traction.loads.iter();
            line.layout.energy + loads.map(|loads| line_energy(&line.layout.kernel, logarithms, loads)).sum::<f64>()
        };
        state.sum(of_line) - counted
    }

    /// Operators for `a0` on the ports of `state`, which are kept.
    pub fn operators(
        &self,
        a0: f64,
        state: &State,
        kept: &mut KeptOperators,
    ) -> Result<Arc<Operators>, MechanicsError> {
        let ports = lines::ports(&state.lines);
        if !kept.find(|of| *of == (a0, ports)) {
            let [wheel, rail] = self.of(state);
            let (wheel, mut rail) = (wheel.operator(a0)?, rail.operator(a0)?);
            let base = self.support.as_ref().map(|support| support.condense(&mut rail));
            let relative = &wheel.surface + &rail.surface;
            let (shared, logarithms) =
                (self.shared(ports, [&wheel.surface, &rail.surface]), self.logarithms(ports).cloned());
            let lift = self.apart.as_ref().map_or(0.0, |(LineKernel { tangential, normal, .. }, _)| {
                normal.factor * normal.reach - tangential.factor * tangential.reach
            });
            let operators = Operators { a0, ports, wheel, rail, base, relative, shared, lift, logarithms };
            kept.keep((a0, ports), Arc::new(operators));
        }
        Ok(kept.present().clone())
    }

    /// Answers of wheel and rail known before the contact is solved; `streams` are those of wheel and rail.
    pub fn free_responses(
        &self,
        operators: &Operators,
        state: &State,
        td: &TimeDerivative,
        streams: [Convection; 2],
        out: &mut [FreeResponse; 2],
    ) {
        let [wheel, rail] = self.of(state);
        wheel.free_response(&operators.wheel, &state.wheel, td, streams[0], &mut out[0]);
        rail.free_response(&operators.rail, &state.rail, td, streams[1], &mut out[1]);
        if let Some(base) = &operators.base {
            base.move_free(&state.base, td, &mut out[1]);
        }
    }

    /// Kinetic and elastic energy of the deformation and of the track, the coupling with the rigid velocities (V, U̇,
    /// Ω) included [J/m].
    pub fn energy(&self, state: &State, velocities: PerAxis<f64>) -> f64 {
        let [on_wheel, on_rail] = [0, 1].map(|body| state.loads(body));
        let track = self.support.as_ref().map_or(0.0, |support| support.energy(&state.base));
        let of_base = along_base(state.base.velocities());
        let [wheel, rail] = self.of(state);
        wheel.energy(&state.wheel, &on_wheel, velocities) + rail.energy(&state.rail, &on_rail, of_base) + track
    }

    /// Power that damping and open ends take out of the bodies and the track [W/m].
    pub fn dissipation(&self, state: &State) -> f64 {
        let track = self.support.as_ref().map_or(0.0, |support| support.dissipation(&state.base));
        let motion = state.motion.values();
        let [wheel, rail] = self.of(state);
        wheel.dissipation(&state.wheel, motion.rotation) + rail.dissipation(&state.rail, motion.travel) + track
    }

    /// Accepts the contact forces in `next`: writes the advanced deformation of both bodies and the motion of the rail
    /// base to it. `accelerations` are the rigid ones (V̇, Ü, Ω̇).
    pub fn commit(
        &self,
        operators: &Operators,
        free: &[FreeResponse; 2],
        accelerations: PerAxis<f64>,
        td: &TimeDerivative,
        state: &State,
        next: &mut State,
    ) {
        let [wheel, rail] = self.of(next);
        let on_wheel = lines::mean(&next.lines, |line| &line.contact.traction.loads[0]);
        let on_rail = lines::mean(&next.lines, |line| &line.contact.traction.loads[1]);
        wheel.commit(&operators.wheel, &free[0], &on_wheel, accelerations, td, &state.wheel, &mut next.wheel);
        next.base = match &operators.base {
            Some(base) => base.advance(&state.base, td, &free[1], &on_rail),
            None => state.base,
        };
        let of_base = along_base(next.base.accelerations());
        rail.commit(&operators.rail, &free[1], &on_rail, of_base, td, &state.rail, &mut next.rail);
    }

    /// True if a state has the dimensions of these bodies.
    pub fn fits(&self, state: &State) -> bool {
        let fits = |body: &BodyState, response: &dyn BodyResponse| {
            let n = response.state_len();
            let arrays = [
                &body.displacement,
                &body.velocity,
                &body.acceleration,
                &body.displacement_before,
                &body.velocity_before,
            ];
            let convected = body.convected.len();
            arrays.iter().all(|array| array.len() == n)
                && (convected == 0 || convected == n)
                && body.retarded.fits(response.retarded_len())
        };
        let [wheel, rail] = self.of(state);
        fits(&state.wheel, wheel) && fits(&state.rail, rail)
    }
}

/// Motions of the base of the rail, which does not turn, from those in x and y.
fn along_base([travel, height]: [f64; 2]) -> PerAxis<f64> {
    PerAxis { travel, height, ..PerAxis::default() }
}

/// Number of surface components that the contact of a state sees.
pub fn ports(state: &State) -> usize {
    state.lines.first().map_or(0, |line| line.contact.traction.port_forces.len())
}
