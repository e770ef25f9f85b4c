//! The model of one parameter set: small owners side by side, immutable during a run.

use super::bodies::{Bodies, KeptOperators};
use super::contact_model::ContactModel;
use super::error::ModelError;
use super::line::Line;
use super::patch_lines;
use super::rigid::RigidWheel;
use super::state::State;
use super::support::TrackSupport;
use super::thermal::{self, ThermalModel};
use super::wheelset::Wheelset;
use crate::analytic;
use crate::config::Config;
use crate::contact::line::ContactGrid;
use crate::contact::{ActiveSetScratch, ActiveSetSolver, LineKernel};
use crate::heat::{HeatError, HeatModel, HeatParameters};
use crate::material::Isotropic;
use crate::mechanics::response::FreeResponse;
use crate::mechanics::{self, Pair};
use crate::surface::{Flattening, Surfaces, TreadLevel};

/// Everything that does not change during a run; instances with equal parameters share it.
pub struct RollingModel {
    /// Parameters; the tunable ones among them play no part.
    pub config: Config,
    /// Deformable wheel and rail.
    pub bodies: Bodies,
    /// Rigid motion of the wheel.
    pub wheel: RigidWheel,
    /// Contact between them.
    pub contact: ContactModel,
    /// Tread of the wheel as it is made.
    pub tread: TreadLevel,
    /// Temperatures, unless they are switched off.
    pub thermal: Option<ThermalModel>,
    /// Distance of the nodes on which contact is looked for \[m].
    pub spacing: f64,
    /// Half-length of the zone in which ordinary contact is looked for \[m].
    pub zone: f64,
    /// Half-length of the zone beyond which contact is never looked for \[m].
    pub reach: f64,
    /// Width of the patch under the nominal load, of which the heat model is \[m].
    pub patch_width: f64,
    /// Torsion of the wheel on its hub, which falling friction can excite.
    pub torsion: analytic::Torsion,
}

/// Deviation of the sum of all shares from one that counts as round-off [1].
const SHARES_ROUND_OFF: f64 = 1e-12;

/// Scratch space of the computations; never part of a state.
#[derive(Default)]
pub struct Workspace {
    /// Operators of recent step sizes.
    pub operators: KeptOperators,
    /// Answers of wheel and rail without contact forces.
    pub free: [FreeResponse; 2],
    /// Of the contact solver.
    pub contact: ActiveSetScratch,
    /// Of the heat step.
    pub heat: thermal::ThermalScratch,
    /// State before and after an internal step.
    pub states: [State; 2],
}

impl RollingModel {
    /// Refuses a configuration whose meshes would take more memory and time than is sensible, in microseconds.
    pub fn check_size(config: &Config) -> Result<(), ModelError> {
        mechanics::check_size(&config.into())?;
        if config.thermal.enabled {
            thermal::check_size(config)?;
        }
        Ok(())
    }

    /// Builds the model on given bodies with given surfaces.
    pub fn new(config: Config, bodies: Pair, surfaces: Surfaces) -> Result<Self, ModelError> {
        let grid =
            ContactGrid::new(bodies.surface_x.clone(), bodies.spacing, bodies.candidates.start).under(bodies.reach);
        let reach = bodies.surface_x[bodies.candidates.clone()].last().copied().unwrap_or(0.0);
        let Pair { spacing, zone, .. } = bodies;
        let steel = Isotropic::from(&config.material);
        let shear = steel.shear_wave_speed();
        let thermal = match config.thermal.enabled {
            true => Some(ThermalModel::new(&config, zone, spacing, reach)?),
            false => None,
        };
        let contact = ContactModel::new(&config, surfaces, ActiveSetSolver::new(grid), zone.max(reach))?;
        let wheelset = Wheelset::new(&config, &contact.patch);
        Ok(Self {
            wheel: RigidWheel::new(&config, wheelset),
            tread: TreadLevel::of(&contact.surfaces),
            bodies: {
                let bodies = Bodies::new(bodies.wheel, bodies.rail, TrackSupport::new(&config));
                if config.contact.shape.is_line() { bodies } else { bodies.with_lines(patch_lines::apart(&config)) }
            },
            contact,
            reach: zone.max(reach),
            patch_width: config.nominal_patch().width,
            torsion: analytic::hub_torsion(config.wheel.radius, config.wheel.hub_radius, shear),
            thermal,
            spacing,
            zone,
            config,
        })
    }

    /// Puts contact lines side by side with the given `shares` of the width \[1] in the place of a single one. Beside
    /// the bodies that all of them press, each has the flexibility of a half-plane for itself, whose displacement by a
    /// force ends at the distance `length` \[m].
    ///
    /// # Errors
    ///
    /// [`ModelError::Lines`] if the shares are not positive or do not add up to one.
    pub fn with_lines(mut self, shares: Vec<f64>, length: f64) -> Result<Self, ModelError> {
        let sum: f64 = shares.iter().sum();
        let sound = shares.iter().all(|share| *share > 0.0) && (sum - 1.0).abs() < SHARES_ROUND_OFF && length > 0.0;
        if !sound {
            return Err(ModelError::Lines { shares, length });
        }
        let kernel = LineKernel::of_half_plane(Isotropic::from(&self.config.material).half_plane(), length);
        self.bodies = self.bodies.with_lines(kernel);
        self.contact.patch = self.contact.patch.in_shares(&shares, kernel);
        Ok(self)
    }

    /// Puts the heat model that `heat` makes for the given parameters in the place of the one on tensor meshes; without
    /// temperatures there is none.
    pub fn with_heat(
        mut self,
        heat: impl FnOnce(&HeatParameters) -> Result<Box<dyn HeatModel>, HeatError>,
    ) -> Result<Self, ModelError> {
        if let Some(thermal) = &self.thermal {
            let margin = thermal.spacing;
            self.thermal = Some(ThermalModel::with_heat(&self.config, self.zone, margin, self.reach, heat)?);
        }
        Ok(self)
    }

    /// Width of the patch under the nominal load over that in a state \[1].
    pub fn narrowing(&self, state: &State) -> f64 {
        self.patch_width / (self.wheel.width * state.covered())
    }

    /// Radius of rolling in a state \[m]: that of the cold wheel at the contact and its growth by the bulk temperature.
    pub fn rolling_radius(&self, state: &State) -> f64 {
        self.wheel.wheelset.radius(state.motion.pose.lateral) + state.growth()
    }

    /// True if a state has the dimensions of this model and only finite numbers in its contact forces.
    pub fn fits(&self, state: &State) -> bool {
        self.bodies.fits(state)
            && self.contact.patch.fits(&state.lines)
            && state.lines.iter().all(|line| self.fits_line(line))
    }

    fn fits_line(&self, line: &Line) -> bool {
        self.contact.solver.fits(&line.contact)
            && line.flattening.iter().all(Flattening::is_sound)
            && match (&line.thermal, &self.thermal) {
                (Some(temperatures), Some(model)) => model.fits(temperatures),
                (None, None) => true,
                _ => false,
            }
    }
}
