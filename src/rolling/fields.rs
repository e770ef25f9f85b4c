//! Fields of a state in the whole bodies, for pictures: in the frame of the rail's contact point, wheel above rail.

use super::line::Line;
use super::model::RollingModel;
use super::state::State;
use crate::heat::HeatError;
use crate::mechanics::field::{NodalLoads, add_loads, rail_field, wheel_field};
use crate::mechanics::{BodyParameters, MechanicsError};
use nalgebra::DVector;

pub use crate::heat::TemperatureField;
pub use crate::mechanics::field::{BodyField, Stress};

/// Why fields could not be given.
#[derive(Debug, thiserror::Error)]
pub enum FieldError {
    /// Vibration modes know the surface only.
    #[error("displacement and stress of the whole bodies need solver.reduced = false: modes have none")]
    Reduced,
    /// The mesh.
    #[error("finite-element model: {0}")]
    Mechanics(#[from] MechanicsError),
    /// The temperatures.
    #[error("heat: {0}")]
    Heat(#[from] HeatError),
}

/// Fields of wheel and rail, undeformed wheel and rail just touching at the origin.
#[derive(Clone, Debug)]
pub struct Fields {
    /// Of the wheel; its displacement includes the height of the hub.
    pub wheel: BodyField,
    /// Of the rail; its displacement includes that of the base.
    pub rail: BodyField,
    /// Absolute temperatures of wheel and rail on meshes of their own; `None` if they are not computed.
    pub temperature: Option<[TemperatureField; 2]>,
}

/// Fields of a state of the full response.
pub fn fields(model: &RollingModel, state: &State) -> Result<Fields, FieldError> {
    let (bodies, motion) = (&BodyParameters::from(&model.config), &state.motion);
    let lift = |nodes: &mut [[f64; 2]]| nodes.iter_mut().for_each(|[_, y]| *y += bodies.radius);
    let (nodes, ports) =
        ([nodal_loads(bodies, state, 0)?, nodal_loads(bodies, state, 1)?], [0, 1].map(|body| state.loads(body)));
    let loads = |body: usize| NodalLoads { nodes: &nodes[body], ports: &ports[body] };
    let mut wheel = wheel_field(bodies, &state.wheel, motion.omega.now, loads(0))?.ok_or(FieldError::Reduced)?;
    let mut rail = rail_field(bodies, &state.rail, motion.velocity.now, loads(1))?.ok_or(FieldError::Reduced)?;
    lift(&mut wheel.mesh.nodes);
    wheel.displacement.iter_mut().for_each(|[_, y]| *y += motion.height.now);
    wheel.velocity.iter_mut().for_each(|[_, y]| *y += motion.height.rate);
    let (mut base, speed) = (state.base.displacement.map(|b| b.now), state.base.velocities());
    base[1] += state.elevation;
    for k in 0..2 {
        rail.displacement.iter_mut().for_each(|u| u[k] += base[k]);
        rail.velocity.iter_mut().for_each(|v| v[k] += speed[k]);
    }
    let mut temperature = temperatures(model, state)?;
    if let Some([of_wheel, _]) = &mut temperature {
        lift(&mut of_wheel.mesh.nodes);
    }
    Ok(Fields { wheel, rail, temperature })
}

/// Forces of all lines on the surface nodes of wheel (0) or rail (1), x and y of each, contact forces and the pull of hot
/// layers [N/m].
fn nodal_loads(bodies: &BodyParameters, state: &State, body: usize) -> Result<DVector<f64>, MechanicsError> {
    let sign = if body == 0 { 1.0 } else { -1.0 };
    let mut sum = DVector::zeros(0);
    for line in &state.lines {
        let nodes = &line.contact.grid;
        let mut loads = &nodes.forces * sign;
        let guards = (loads.len() / 2).saturating_sub(nodes.pull[body].len()) / 2;
        nodes.pull[body].iter().enumerate().for_each(|(i, pull)| loads[2 * (i + guards)] += pull);
        loads *= line.layout.share;
        add_loads(bodies, nodes.size, &loads, &mut sum)?;
    }
    Ok(sum)
}

/// Absolute temperatures in wheel (about its centre) and rail under the hottest line, with either response; `None` if
/// they are not computed.
pub fn temperatures(model: &RollingModel, state: &State) -> Result<Option<[TemperatureField; 2]>, HeatError> {
    let warmest = state.line_of_largest(Line::hottest).and_then(|line| line.thermal.as_ref());
    match (&model.thermal, warmest) {
        (Some(heat), Some(thermal)) => heat.fields(thermal).map(Some),
        _ => Ok(None),
    }
}
