//! The deformable wheel and rail, and their answers for the step sizes in use.

use super::line::Line;
use super::lines;
use super::state::State;
use super::support::{CondensedBase, TrackSupport};
use crate::contact::line::kernel::{KernelCorrection, line_compliance};
use crate::contact::{Influence, LineKernel, LineLayout, Ports};
use crate::mechanics::response::{BodyResponse, BodyState, Convection, FreeResponse, StepOperator};
use crate::mechanics::{MechanicsError, Pair};
use crate::multistep::TimeDerivative;
use nalgebra::{DMatrix, DVector};
use std::borrow::Cow;
use std::sync::Arc;

/// Number of step sizes whose operators are kept: those of steps that are halved and joined again.
const KEPT: usize = 12;

/// Wheel and rail, and what carries the rail.
///
/// Their coordinates do not depend on the [`Ports`] through which the contact of a state sees them.
pub struct Bodies {
    /// Annulus on its hub, plate on its base; of their surfaces only the ports of ordinary patches.
    narrow: [Box<dyn BodyResponse>; 2],
    /// Both with the ports of wide ones.
    wide: Option<[Box<dyn BodyResponse>; 2]>,
    /// Both less half-planes, for a solver that knows those.
    smooth: Option<[Box<dyn BodyResponse>; 2]>,
    /// Track below its base; `None`: the base is fixed.
    pub support: Option<TrackSupport>,
    /// Correction of their compliance at grid scale, if there is any.
    correction: Option<KernelCorrection>,
    /// Positions of the nodes of the narrow and of the wide ports \[m], and their distance in the middle \[m].
    nodes: ([Vec<f64>; 2], f64),
    /// Flexibility of one body that belongs to lines, where they have one of their own beside that of the bodies; its
    /// compliances at the narrow and wide ports [m/(N/m)].
    apart: Option<(LineKernel, [DMatrix<f64>; 2])>,
    /// True if this correction is part of them, because it is damped as they are.
    hold_correction: bool,
}

/// Answers of both bodies for one step size, corrected at grid scale.
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
    /// Nodes of the ports \[m] and their distance in the middle \[m]; none where they are smooth.
    nodes: Option<(Vec<f64>, f64)>,
}

/// Compliances of wheel and rail, and their sum [m/(N/m)].
type Compliances = ([DMatrix<f64>; 2], DMatrix<f64>);

/// Compliances by the forces of one of several lines itself [m/(N/m)].
pub struct OwnCompliances {
    /// Flexibility of one body that belongs to the line.
    alone: DMatrix<f64>,
    whole: Compliances,
}

impl OwnCompliances {
    /// Displacement of one body as far as only the line itself feels it.
    pub fn alone(&self) -> &DMatrix<f64> {
        &self.alone
    }
}

fn with_sum([wheel, rail]: [DMatrix<f64>; 2]) -> Compliances {
    let sum = &wheel + &rail;
    ([wheel, rail], sum)
}

impl Operators {
    /// Compliances by the forces of a line itself; `None` where there is a single one, and at smooth ports, whose
    /// solver knows the flexibility of lines.
    pub fn of_line(&self, layout: &LineLayout) -> Option<OwnCompliances> {
        let (nodes, spacing) = self.nodes.as_ref()?;
        let ([wheel, rail], _) = self.shared.as_ref()?;
        let alone = line_compliance(&layout.kernel, nodes, *spacing);
        let whole = with_sum([wheel, rail].map(|shared| &alone + layout.share * shared));
        Some(OwnCompliances { alone, whole })
    }

    /// Displacements by the forces of a line itself, whose compliances are `of_line` where there are several.
    pub fn own<'a>(&'a self, of_line: Option<&'a OwnCompliances>) -> Influence<'a> {
        match of_line {
            Some(own) => influence(&own.whole),
            None => Influence { compliance: [&self.wheel.surface, &self.rail.surface], relative: &self.relative },
        }
    }

    /// Displacements by the forces of other lines; `None`: there are none.
    pub fn others(&self) -> Option<Influence<'_>> {
        self.shared.as_ref().map(influence)
    }
}

fn influence(([wheel, rail], relative): &Compliances) -> Influence<'_> {
    Influence { compliance: [wheel, rail], relative }
}

/// Operators of recently used step sizes; never part of a state.
#[derive(Default)]
pub struct OperatorCache {
    recent: Vec<Arc<Operators>>,
}

impl Bodies {
    /// Wheel and rail, the rail on its `support`, with a `correction` of their compliance at grid scale.
    pub fn new(pair: Pair, support: Option<TrackSupport>, correction: Option<KernelCorrection>) -> Self {
        let (wide, mut hold_correction) = (pair.wide, false);
        let wings = wide.as_ref().map_or(Vec::new(), |wide| wide.surface_x.clone());
        let nodes = ([pair.surface_x.clone(), wings], pair.spacing);
        let mut corrected = |wheel: Box<dyn BodyResponse>, rail: Box<dyn BodyResponse>, ports: usize| {
            let mut bodies = [wheel, rail];
            let mut layers = [DMatrix::zeros(ports, ports), DMatrix::zeros(ports, ports)];
            correct(correction.as_ref(), layers.each_mut());
            let taken = bodies.iter_mut().zip(&layers).map(|(body, layer)| body.take_layer(layer));
            hold_correction = taken.fold(true, |all, one| all & one);
            bodies
        };
        let narrow = corrected(pair.wheel, pair.rail, 2 * pair.surface_x.len());
        let wide = wide.map(|pair| corrected(pair.wheel, pair.rail, 2 * pair.surface_x.len()));
        let smooth = pair.smooth.map(|pair| [pair.wheel, pair.rail]);
        Self { narrow, wide, smooth, support, correction, nodes, apart: None, hold_correction }
    }

    /// Wheel and rail as the contact of a state sees them.
    fn of(&self, state: &State) -> [&dyn BodyResponse; 2] {
        let other = match ports_of(state) {
            Ports::Narrow => None,
            Ports::Wide => self.wide.as_ref(),
            Ports::Smooth => self.smooth.as_ref(),
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
        let ([narrow, wide], spacing) = &self.nodes;
        self.apart = Some((kernel, [narrow, wide].map(|nodes| line_compliance(&kernel, nodes, *spacing))));
        self
    }

    /// Compliance of the flexibility that belongs to lines, at given ports with `size` components.
    fn apart(&self, ports: Ports, size: usize) -> Option<Cow<'_, DMatrix<f64>>> {
        let (kernel, [narrow, wide]) = self.apart.as_ref()?;
        // Bodies at smooth ports lack `−κ ln|x|` already.
        let rest = |i: usize, j: usize| match (i % 2, j % 2) {
            (0, 0) => kernel.tangential.factor * kernel.tangential.reach,
            (1, 1) => kernel.normal.factor * kernel.normal.reach,
            _ => 0.0,
        };
        Some(match ports {
            Ports::Narrow => Cow::Borrowed(narrow),
            Ports::Wide => Cow::Borrowed(wide),
            Ports::Smooth => Cow::Owned(DMatrix::from_fn(size, size, rest)),
        })
    }

    /// Nodes of given ports \[m].
    fn nodes(&self, ports: Ports) -> Option<&Vec<f64>> {
        let ([narrow, wide], _) = &self.nodes;
        match ports {
            Ports::Narrow => Some(narrow),
            Ports::Wide => Some(wide),
            Ports::Smooth => None,
        }
    }

    /// Elastic energy of the contact that the bodies do not count [J/m].
    pub fn correction_energy(&self, state: &State) -> f64 {
        let forces = lines::mean(&state.lines, |line| &line.contact.traction.port_forces);
        let correction = match (ports_of(state), &self.correction) {
            _ if self.hold_correction => 0.0,
            (Ports::Narrow | Ports::Wide, Some(correction)) => correction.energy(&forces),
            (Ports::Narrow | Ports::Wide, None) | (Ports::Smooth, _) => state.sum(|line| line.contact.energy),
        };
        correction + self.energy_of_lines(state)
    }

    /// Elastic energy of the flexibility of lines that the bodies do not count, less that which they count in its place
    /// [J/m].
    fn energy_of_lines(&self, state: &State) -> f64 {
        let ports = ports_of(state);
        let Some(apart) = self.apart(ports, self::ports(state)) else { return 0.0 };
        let quadratic = |matrix: &DMatrix<f64>, forces: &DVector<f64>| 0.5 * forces.dot(&(matrix * forces));
        let counted: f64 = [0, 1].map(|body| quadratic(&apart, &state.loads(body))).iter().sum();
        let of_line = |line: &Line| {
            let own = self.nodes(ports).map_or(0.0, |nodes| {
                let alone = line_compliance(&line.layout.kernel, nodes, self.nodes.1);
                line.contact.traction.loads.iter().map(|loads| quadratic(&alone, loads)).sum()
            });
            own + line.layout.energy
        };
        state.sum(of_line) - counted
    }

    /// Operators for `a0` on the ports of `state`, from the cache if they are there.
    pub fn operators(
        &self,
        a0: f64,
        state: &State,
        cache: &mut OperatorCache,
    ) -> Result<Arc<Operators>, MechanicsError> {
        let (recent, ports) = (&mut cache.recent, ports_of(state));
        if let Some(at) = recent.iter().position(|o| o.a0 == a0 && o.ports == ports) {
            recent[at..].rotate_left(1);
        } else {
            if recent.len() >= KEPT {
                recent.remove(0);
            }
            let [wheel, rail] = self.of(state);
            let (mut wheel, mut rail) = (wheel.operator(a0)?, rail.operator(a0)?);
            let base = self.support.as_ref().map(|support| support.condense(&mut rail));
            match ports {
                Ports::Narrow | Ports::Wide if !self.hold_correction => {
                    correct(self.correction.as_ref(), [&mut wheel.surface, &mut rail.surface]);
                }
                Ports::Narrow | Ports::Wide | Ports::Smooth => {}
            }
            let relative = &wheel.surface + &rail.surface;
            let apart = self.apart(ports, wheel.surface.nrows());
            let shared = apart.map(|apart| with_sum([&wheel, &rail].map(|body| &body.surface - &*apart)));
            let nodes = shared.as_ref().and_then(|_| self.nodes(ports)).map(|nodes| (nodes.clone(), self.nodes.1));
            let lift = self.apart.as_ref().map_or(0.0, |(LineKernel { tangential, normal, .. }, _)| {
                normal.factor * normal.reach - tangential.factor * tangential.reach
            });
            recent.push(Arc::new(Operators { a0, ports, wheel, rail, base, relative, shared, lift, nodes }));
        }
        Ok(recent[recent.len() - 1].clone())
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
    pub fn energy(&self, state: &State, velocities: [f64; 3]) -> f64 {
        let [on_wheel, on_rail] = [0, 1].map(|body| state.loads(body));
        let track = self.support.as_ref().map_or(0.0, |support| support.energy(&state.base));
        let [x, y] = state.base.velocities();
        let [wheel, rail] = self.of(state);
        wheel.energy(&state.wheel, &on_wheel, velocities) + rail.energy(&state.rail, &on_rail, [x, y, 0.0]) + track
    }

    /// Power that damping and open ends take out of the bodies and the track [W/m].
    pub fn dissipation(&self, state: &State) -> f64 {
        let track = self.support.as_ref().map_or(0.0, |support| support.dissipation(&state.base));
        let [velocity, _, omega] = state.motion.values();
        let [wheel, rail] = self.of(state);
        wheel.dissipation(&state.wheel, omega) + rail.dissipation(&state.rail, velocity) + track
    }

    /// Accepts the contact forces in `next`: writes the advanced deformation of both bodies and the motion of the rail
    /// base to it. `accelerations` are the rigid ones (V̇, Ü, Ω̇).
    pub fn commit(
        &self,
        operators: &Operators,
        free: &[FreeResponse; 2],
        accelerations: [f64; 3],
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
        let [x, y] = next.base.accelerations();
        rail.commit(&operators.rail, &free[1], &on_rail, [x, y, 0.0], td, &state.rail, &mut next.rail);
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
            arrays.iter().all(|array| array.len() == n) && body.retarded.fits(response.retarded_len())
        };
        let [wheel, rail] = self.of(state);
        fits(&state.wheel, wheel) && fits(&state.rail, rail)
    }
}

/// Adds half of a correction to the surface compliance of each body.
fn correct(correction: Option<&KernelCorrection>, compliances: [&mut DMatrix<f64>; 2]) {
    let Some(correction) = correction else { return };
    compliances.into_iter().for_each(|compliance| correction.add_to(compliance, 0.5));
}

/// Number of surface components that the contact of a state sees.
pub fn ports(state: &State) -> usize {
    state.lines.first().map_or(0, |line| line.contact.traction.port_forces.len())
}

/// Ports of the lines of a state, the same for all.
fn ports_of(state: &State) -> Ports {
    state.lines.first().map_or_else(Ports::default, |line| line.contact.ports)
}
