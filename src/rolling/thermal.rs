//! Heat of the rolling contact: what the mechanics gives to the temperature fields, and what they give back.
//!
//! The coupling is staggered: a mechanical step first, then one implicit heat step with its friction power, pressure and
//! patch held over the step. Friction coefficient and thermal deformation of the next step follow from the new
//! temperatures.
//!
//! **Thermal deformation.** The temperature of the wheel is split into its bulk and the layer under the contact.
//! - The bulk is taken as axisymmetric. An annulus on a rigid cold hub in plane strain grows by
//!   `u(r_o) = (1+ν)/(1−ν) α I/r_o + C (r_o − r_i²/r_o)`, `I = ∫ T r dr`, with `C` from `σ_r(r_o) = 0` (Timoshenko &
//!   Goodier, *Theory of Elasticity*, section 150). It lifts the hub and raises the peripheral velocity.
//! - The layer (tens of micrometres, much thinner than the patch) is held by the cold material below: it swells by
//!   `(1+ν)/(1−ν) α ∫T dz`, and its membrane force `−Eα/(1−ν) ∫T dz` pulls tangentially at the body by its gradient.

use super::state::State;
use super::{Model, StepError, Workspace};
use crate::config::{ConductanceLaw, Config, Hub};
use crate::contact::streamline::edge_offset;
use crate::contact::{ContactGrid, ContactSolution, patches};
use crate::heat::{
    Conductance, Exchange, Heat, HeatConfig, HeatError, HeatFlows, HeatState, HeatTimeScheme, HubCondition, Patch,
    Temperatures, TreadHeat,
};
use crate::piecewise::{Piecewise, interpolate, mean, peak};
use nalgebra::DVector;
use serde::{Deserialize, Serialize};

/// Temperature fields and what the last step found about them, per metre of width.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ThermalState {
    /// Both temperature fields.
    pub fields: HeatState,
    /// Mean heat flows over the last step [W/m].
    pub flows: HeatFlows,
    /// Excess temperatures [K].
    pub temperatures: Temperatures,
    /// Mean excess temperatures of the surfaces in the patch: wheel, rail [K].
    pub patch_mean: [f64; 2],
    /// Mean of both over the friction coefficient, now and one step before [K].
    pub heating: [f64; 2],
    /// Excess surface temperatures of wheel and rail at the candidates, reversible heating included [K].
    pub surface: [Vec<f64>; 2],
    /// Time during which the hottest contact point was above Ac1 [s].
    pub austenitised: f64,
    /// Heat put in and heat passed on or stored since the start [J/m]: their difference is the imbalance.
    pub supplied: f64,
    pub received: f64,
    /// Growth of the wheel radius [m].
    pub growth: f64,
    /// Swelling of both layers at the candidates [m].
    pub swelling: Vec<f64>,
    /// Tangential nodal forces of the layers' membrane forces at the candidates: on wheel, on rail [N/m].
    pub membrane: [Vec<f64>; 2],
}

impl ThermalState {
    /// Takes what acts back on the contact in the `share` of its change.
    pub(super) fn average(&mut self, before: &ThermalState, share: f64) {
        let ours = self.membrane.iter_mut().chain([&mut self.swelling]).flatten().chain(&mut self.heating);
        let theirs = before.membrane.iter().chain([&before.swelling]).flatten().chain(&before.heating);
        for (now, before) in ours.chain([&mut self.growth]).zip(theirs.chain([&before.growth])) {
            *now = before + share * (*now - before);
        }
    }

    /// Whether the temperatures have the dimensions of this heat model and of `candidates` contact candidates.
    pub(super) fn fits(&self, heat: &Heat, candidates: usize) -> bool {
        let zone = [&self.surface, &self.membrane].into_iter().flatten().chain([&self.swelling]);
        heat.fits(&self.fields) && zone.map(Vec::len).all(|length| length == candidates)
    }
}

/// Parameters of the heat model for a configuration; `half_width` at the nominal load and `zone` [m].
pub fn heat_config(config: &Config, half_width: f64, zone: f64) -> HeatConfig {
    let (material, thermal) = (&config.material, &config.thermal);
    HeatConfig {
        conductivity: material.conductivity,
        specific_heat: material.specific_heat,
        density: material.density,
        wheel_radius: config.wheel.radius,
        hub_radius: config.wheel.hub_radius,
        rail_length: config.rail.length,
        rail_height: config.rail.height,
        half_width,
        smallest_half_width: half_width * thermal.smallest_load_ratio.sqrt(),
        zone,
        max_speed: thermal.max_speed,
        elements_per_half_width: config.mesh.elements_per_half_width,
        hub: match thermal.hub {
            Hub::Fixed => HubCondition::Fixed,
            Hub::Insulated => HubCondition::Insulated,
        },
        conductance: match thermal.conductance_law {
            ConductanceLaw::Constant => Conductance::Constant { value: thermal.conductance },
            ConductanceLaw::Pressure => {
                Conductance::Pressure { value: thermal.conductance, reference_pressure: thermal.reference_pressure }
            }
        },
        friction_fraction: thermal.heat_ratio,
        wheel_share: thermal.wheel_share,
        convection: thermal.convection,
        time_scheme: HeatTimeScheme::Sdirk2,
    }
}

impl From<HeatError> for StepError {
    fn from(error: HeatError) -> Self {
        StepError::Heat(error)
    }
}

/// Edges of a run of closed nodes below grid scale, never inside its outermost nodes [m].
fn edges(grid: &ContactGrid, contact: &ContactSolution, run: &std::ops::Range<usize>) -> [f64; 2] {
    let (first, last) = (run.start, run.end - 1);
    let offset = |edge: usize, inner: usize| {
        let inner = if edge == inner { 0.0 } else { contact.normal(grid, inner) };
        grid.spacing * edge_offset(contact.normal(grid, edge), inner).max(1e-3)
    };
    let low = grid.x[first] - offset(first, (first + 1).min(last));
    let high = grid.x[last] + offset(last, last.max(first + 1) - 1);
    [low, high]
}

/// A nodal quantity as a profile over all patches, zero at their edges.
fn over_patches(grid: &ContactGrid, contact: &ContactSolution, value: impl Fn(usize) -> f64) -> Piecewise {
    let mut profile = Piecewise::default();
    for run in patches(&contact.status) {
        let [low, high] = edges(grid, contact, &run);
        profile.x.push(low);
        profile.value.push(0.0);
        for i in run {
            profile.x.push(grid.x[i]);
            profile.value.push(value(i));
        }
        profile.x.push(high);
        profile.value.push(0.0);
    }
    profile
}

impl Model {
    /// What the contact does to the temperature fields. Friction power and patch of the new time act over the whole step,
    /// so that the heat flows reported with it add up to its friction power.
    fn exchange(&self, contact: &ContactSolution, tread_heat: f64) -> Exchange {
        let grid = &self.grid;
        let patches = patches(&contact.status)
            .iter()
            .map(|run| edges(grid, contact, run))
            .map(|[low, high]| Patch { low, high })
            .collect();
        // Where friction acts, in proportion to traction times slip; the total is the friction power.
        let dissipation = |i: usize| (-contact.tangential(grid, i) * contact.slip[i] / grid.spacing).max(0.0);
        let friction = over_patches(grid, contact, dissipation);
        let (total, shape) = (contact.friction_power(grid), friction.integral());
        let pressure = over_patches(grid, contact, |i| contact.normal(grid, i) / grid.spacing);
        let friction_power = if shape > 0.0 {
            friction.scaled(total / shape)
        } else {
            // Centred slip without any slipping node: spread it like the pressure.
            let load = pressure.integral();
            if load > 0.0 { pressure.clone().scaled(total / load) } else { Piecewise::default() }
        };
        let thermal = &self.config.thermal;
        let blocks: &[f64] = if thermal.tread_blocks == 2 { &[1.0, -1.0] } else { &[1.0] };
        let heat = tread_heat / self.config.model.contact_width / blocks.len() as f64;
        let block = |side: &f64| TreadHeat { angle: side * thermal.tread_angle, width: thermal.tread_width, heat };
        let tread = if heat == 0.0 { Vec::new() } else { blocks.iter().map(block).collect() };
        let reversible = if self.config.physics.thermoelastic_heating {
            let [wheel, rail] = self.reversible_temperatures(contact);
            Piecewise { x: grid.x.clone(), value: wheel.iter().zip(&rail).map(|(w, r)| w - r).collect() }
        } else {
            Piecewise::default()
        };
        Exchange { patches, pressure, friction_power, tread, reversible, ambient: 0.0, held: true }
    }

    /// Stationary temperatures of a stationary contact, with the initial excess temperature of the wheel on top. At
    /// standstill, where nothing carries heat away, only the latter.
    pub(super) fn stationary_heat(
        &self,
        heat: &Heat,
        state: &State,
        tread_heat: f64,
    ) -> Result<ThermalState, StepError> {
        let (v, omega) = (state.velocity.now, state.omega.now);
        let mut fields = heat.initial(self.config.thermal.wheel_excess);
        let mut flows = HeatFlows::default();
        let exchange = self.exchange(&state.contact, tread_heat);
        if v.abs() > 1e-3 || (omega * self.grid.radius).abs() > 1e-3 {
            let (stationary, settled) = heat.stationary(v, omega, &exchange)?;
            fields = heat.sum(&stationary, &fields)?;
            flows = settled;
        }
        self.thermal_state(heat, state, fields, flows, None, 0.0)
    }

    /// The heat step that belongs to a mechanical step `dt`, from the temperatures of `before` and the contact of `next`.
    pub(super) fn step_heat(
        &self,
        heat: &Heat,
        before: &ThermalState,
        next: &State,
        tread_heat: f64,
        dt: f64,
        workspace: &mut Workspace,
    ) -> Result<ThermalState, StepError> {
        let exchange = self.exchange(&next.contact, tread_heat);
        let mut fields = before.fields.clone();
        let flows = heat.step(&mut fields, dt, next.velocity.now, next.omega.now, &exchange, &mut workspace.heat)?;
        self.thermal_state(heat, next, fields, flows, Some(before), dt)
    }

    fn thermal_state(
        &self,
        heat: &Heat,
        state: &State,
        fields: HeatState,
        flows: HeatFlows,
        before: Option<&ThermalState>,
        dt: f64,
    ) -> Result<ThermalState, StepError> {
        let mut temperatures = heat.temperatures(&fields)?;
        let (mut wheel, mut rail) = heat.zone_temperatures(&fields)?;
        let mut surface = heat.at_zone(&fields, &self.grid.x)?;
        if self.config.physics.thermoelastic_heating {
            let reversible = self.reversible_temperatures(&state.contact);
            let zone = heat.zone_x();
            for (body, field) in [&mut wheel, &mut rail].into_iter().enumerate() {
                let here = |x: f64| interpolate(&self.grid.x, &reversible[body], x);
                field.iter_mut().zip(zone).for_each(|(t, &x)| *t += here(x));
                surface[body].iter_mut().zip(&reversible[body]).for_each(|(t, r)| *t += r);
            }
            (temperatures.wheel_max, temperatures.rail_max) = (peak(zone, &wheel), peak(zone, &rail));
            (temperatures.wheel_centre, temperatures.rail_centre) = (wheel[zone.len() / 2], rail[zone.len() / 2]);
        }
        let hottest = self.config.thermal.reference + temperatures.wheel_max.max(temperatures.rail_max);
        let above = if hottest > self.config.tuning.austenitisation { dt } else { 0.0 };
        let supplied = dt * (flows.friction + flows.tread);
        let received = dt
            * (flows.stored_wheel
                + flows.stored_rail
                + flows.to_hub
                + flows.outflow
                + flows.wheel_to_air
                + flows.rail_to_air);
        let mut patch_mean = [0.0; 2];
        let runs = patches(&state.contact.status);
        if let (Some(first), Some(last)) = (runs.first(), runs.last()) {
            let [low, _] = edges(&self.grid, &state.contact, first);
            let [_, high] = edges(&self.grid, &state.contact, last);
            patch_mean = [&wheel, &rail].map(|t| mean(heat.zone_x(), t, low, high));
        }
        let heating = if state.friction > 0.0 { 0.5 * (patch_mean[0] + patch_mean[1]) / state.friction } else { 0.0 };
        let mut result = ThermalState {
            surface,
            patch_mean,
            heating: [heating, before.map_or(heating, |b| b.heating[0])],
            austenitised: before.map_or(0.0, |b| b.austenitised) + above,
            supplied: before.map_or(0.0, |b| b.supplied) + supplied,
            received: before.map_or(0.0, |b| b.received) + received,
            growth: 0.0,
            swelling: vec![0.0; self.grid.len()],
            membrane: [vec![0.0; self.grid.len()], vec![0.0; self.grid.len()]],
            fields,
            flows,
            temperatures,
        };
        if self.config.physics.thermal_expansion {
            self.expand(heat, &mut result)?;
        }
        Ok(result)
    }

    /// Thermal deformation of the bodies.
    fn expand(&self, heat: &Heat, state: &mut ThermalState) -> Result<(), StepError> {
        let Config { wheel, material, .. } = &self.config;
        let (ro, ri, nu) = (wheel.radius, wheel.hub_radius, material.poissons_ratio);
        let swell = (1.0 + nu) / (1.0 - nu) * material.expansion;
        let moment = 0.5 * state.temperatures.wheel_mean * (ro * ro - ri * ri);
        let c = swell * moment / (ro * ro) / (1.0 / (1.0 - 2.0 * nu) + ri * ri / (ro * ro));
        state.growth = swell * moment / ro + c * (ro - ri * ri / ro);

        let [wheel, rail] = heat.layers(&state.fields, &self.grid.x)?;
        let membrane = material.youngs_modulus * material.expansion / (1.0 - nu);
        let n = self.grid.len();
        for i in 0..n {
            state.swelling[i] = swell * (wheel[i] + rail[i]);
            let (left, right) = (i.saturating_sub(1), (i + 1).min(n - 1));
            state.membrane[0][i] = -0.5 * membrane * (wheel[right] - wheel[left]);
            state.membrane[1][i] = -0.5 * membrane * (rail[right] - rail[left]);
        }
        Ok(())
    }

    /// Friction coefficient of the coming step from that available and the nominal slip velocity; `ratio` is its length
    /// over that of the step before, 0 if that says nothing.
    pub(super) fn friction(&self, available: f64, slip: f64, thermal: Option<&ThermalState>, ratio: f64) -> f64 {
        let law = &self.config.tuning;
        let falling = law.falling_ratio + (1.0 - law.falling_ratio) * (-law.falling_decay * slip.abs()).exp();
        let cold = available * falling;
        // The flash temperature follows the friction coefficient within microseconds, T = θμ. Solving μ = cold (1 − KT)
        // with θ extrapolated to the coming step keeps the law stable in long steps and second order in short ones.
        let [now, before] = thermal.map_or([0.0; 2], |t| t.heating);
        let heating = (now + ratio * (now - before)).clamp(0.0, 2.0 * now.max(0.0));
        (cold / (1.0 + cold * law.softening * heating)).max(cold * law.softening_floor)
    }

    /// Undeformed gap with the thermal growth of wheel and layers.
    pub(super) fn thermal_gap(&self, thermal: Option<&ThermalState>) -> Vec<f64> {
        match thermal {
            Some(t) => self.gap.iter().zip(&t.swelling).map(|(g, s)| g - s - t.growth).collect(),
            None => self.gap.clone(),
        }
    }

    /// Adds the displacement by the layers' membrane forces to the free surface displacement of one body.
    pub(super) fn add_membrane(&self, free: &mut DVector<f64>, compliance: &nalgebra::DMatrix<f64>, membrane: &[f64]) {
        if membrane.iter().all(|f| *f == 0.0) {
            return;
        }
        let mut forces = DVector::zeros(free.len());
        for (i, f) in membrane.iter().enumerate() {
            forces[self.grid.dof(i)] = *f;
        }
        free.gemv(1.0, compliance, &forces, 1.0);
    }
}
