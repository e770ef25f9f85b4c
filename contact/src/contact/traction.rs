//! Result of a solved contact for everyone else: forces, patches and profiles, read off its nodes.

use crate::axes::PerAxis;
use crate::linalg::POINTS;
use crate::piecewise::{Interval, Piecewise, weighted_mean};
use nalgebra::DVector;
use serde::{Deserialize, Serialize};

/// Friction power at the end of a step over its mean below which friction counts as ending in the step [1].
const ENDING: f64 = 0.2;

/// Forces between wheel and rail, patches, profiles and powers that follow from them, per metre of width.
///
/// Positions are relative to the point below the wheel centre, positive in travel direction. Profiles are zero outside
/// the patches.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Traction {
    /// Forces on the ports of the wheel, moments of the contact forces with the polynomials of the bodies, x and y of every
    /// point [N/m]; the ports of the rail receive the opposite.
    pub port_forces: DVector<f64>,
    /// All forces on the ports of wheel and rail: contact forces, and the pull of hot layers [N/m].
    pub loads: [DVector<f64>; 2],
    /// Displacements of the ports of wheel and rail \[m].
    pub surface: [DVector<f64>; 2],
    /// Rigid motions (V [m/s], U \[m], Ω [rad/s], V_z [m/s]) with which they were found.
    pub rigid: PerAxis<f64>,
    /// Generalised forces on the wheel: force x, force y [N/m], forward moment about the hub centre \[N], force z [N/m].
    pub resultant: PerAxis<f64>,
    /// Edges of the contact patches, x ascending \[m]; between nodes they follow from the pressures beside them.
    pub edges: Vec<Interval>,
    /// Edges by the outermost pressures at each end alone, as if the other end were far: between these the bodies conduct
    /// heat to each other. Edges of short patches lie farther inside, and what is hot on a few nodes would
    /// get hotter yet.
    pub conducting: Vec<Interval>,
    /// The contact patches, x ascending \[m]: the stretches over which the profiles below are not zero. Each holds
    /// everything on which forces act, so that it may reach a little beyond its edges.
    pub patches: Vec<Interval>,
    /// Share of the contact length that sticks \[1].
    pub stick_fraction: f64,
    /// Largest pressure \[Pa].
    pub pressure_max: f64,
    /// Contact pressure \[Pa].
    pub pressure: Piecewise,
    /// Friction traction on the wheel, forward positive \[Pa].
    pub shear: Piecewise,
    /// Velocity of the wheel surface relative to that of the rail [m/s]; minus shear times slip integrates to the
    /// friction power, but for the thousandths that pressure on the inclined surface and expanding material add to it.
    pub slip: Piecewise,
    /// Friction traction on the wheel across, to the right positive \[Pa]; empty where there is none across.
    pub lateral_shear: Piecewise,
    /// Velocity of the wheel surface relative to that of the rail across [m/s]; empty where friction does not act across.
    pub lateral_slip: Piecewise,
    /// Moment of both friction tractions on the wheel about the vertical through the centre of load, `Σ (z F_x − x F_z)`
    /// \[N]: per metre of the line's width.
    pub spin_moment: f64,
    /// Friction coefficient and the heat of friction.
    pub friction: SolvedFriction,
    /// Work of the pull of hot layers on the way of the surfaces in the step, with the mean of its values at both ends [J/m].
    pub pull_work: f64,
    /// Yielding of the steel.
    pub yielding: Yielding,
    /// Share of the contact length on which a molten film takes friction away \[1].
    pub under_film: f64,
    /// Iterations until all decisions between open, stick and slip were made, without those of the search for the
    /// friction coefficient.
    pub iterations: usize,
}

/// Friction of a solved contact, per metre of width.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SolvedFriction {
    /// Coefficient with which the forces were found \[1].
    pub coefficient: f64,
    /// Slip velocity that gave it: the mean over the patches, weighted with the pressure, of the velocity of the wheel
    /// surface relative to that of the rail, at the end of the step; positive in braking, zero without contact [m/s].
    pub tread_slip: f64,
    /// Its lateral part [m/s].
    pub lateral_slip: f64,
    /// Change of the excess of the coefficient over its law by the coefficient \[1], with which the search of the next step
    /// begins; 0: it is not known.
    pub law_slope: f64,
    /// Length of the mean slip velocity, along and across, that friction depends on [m/s].
    pub slip_speed: f64,
    /// Power that friction turns from mechanical energy into heat at the end of the step, net of the power that hot
    /// material gives back by expanding as it passes the contact [W/m].
    pub power: f64,
    /// Energy that friction has turned into heat in the step [J/m].
    pub work: f64,
    /// Density of the dissipation at the end of the step [W/m²].
    pub dissipation: Piecewise,
    /// Excess of the mean dissipation of the step over that at its end, relative to the latter \[1]: with it,
    /// [`Self::dissipation`] integrates to the energy of the step.
    pub excess: f64,
}

/// Yielding of the steel in a solved contact, per metre of width.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Yielding {
    /// Depth by which yielding steel lies in the way of the other surface \[m], with zeros at its ends; empty where
    /// nothing yields.
    pub overlap: Piecewise,
    /// Work of that part of it which has become permanent in the step [J/m].
    pub plastic_work: f64,
    /// Work of the rest, which springs back when the pressure falls [J/m].
    pub springing_work: f64,
    /// Share of the contact length that yields \[1].
    pub share: f64,
}

impl SolvedFriction {
    /// Takes the power of friction at the end of a step of `duration` seconds [W/m] and its energy in it [J/m]; returns
    /// the power for which the profile of dissipation stands. Friction never cools: where it is less than the errors of
    /// what hot material gives back, it heats nothing. Nor does it where its coefficient is zero.
    pub(super) fn dissipate(&mut self, friction: f64, work: f64, duration: f64) -> f64 {
        (self.power, self.work, self.slip_speed) = (friction, work, self.tread_slip.abs());
        if self.coefficient == 0.0 {
            self.excess = 0.0;
            return 0.0;
        }
        let mean = if duration > 0.0 { work / duration } else { friction }.max(0.0);
        // Where friction has all but ended within the step, its mean stands for it.
        let power = if friction > ENDING * mean { friction } else { mean };
        self.excess = if power > 0.0 { mean / power - 1.0 } else { 0.0 };
        power
    }

    /// Takes away the slip and its dissipation.
    fn rest(&mut self) {
        (self.power, self.work, self.tread_slip, self.slip_speed, self.excess) = (0.0, 0.0, 0.0, 0.0, 0.0);
        self.lateral_slip = 0.0;
        self.dissipation.value.fill(0.0);
    }
}

impl Traction {
    /// Scales the profiles of slip so that shear stress times slip has the `power` over the patch [W/m].
    pub(super) fn scale_slip(&mut self, power: f64) {
        let work = |shear: &Piecewise, slip: &Piecewise| weighted_mean(slip, &shear.x, &shear.value) * slip.integral();
        let own = work(&self.shear, &self.slip) + work(&self.lateral_shear, &self.lateral_slip);
        if power * own > 0.0 {
            self.slip.scale(power / own);
            self.lateral_slip.scale(power / own);
        }
    }

    /// That of surfaces which touch without forces.
    pub fn without_forces() -> Self {
        let ports = || DVector::zeros(2 * POINTS);
        let [loads, surface] = [(); 2].map(|()| [ports(), ports()]);
        Self { port_forces: ports(), loads, surface, ..Self::default() }
    }

    /// True if it has the ports of the bodies and finite forces there.
    pub fn fits(&self) -> bool {
        let vectors = self.loads.iter().chain(&self.surface).chain([&self.port_forces]);
        vectors.into_iter().all(|values| values.len() == 2 * POINTS) && self.port_forces.iter().all(|f| f.is_finite())
    }

    /// From the beginning of the first patch to the end of the last one; `None` without contact.
    pub fn extent(&self) -> Option<Interval> {
        hull(&self.patches)
    }

    /// Friction force on the wheel [N/m], along the round wheel and the plane rail; slopes of the rail apart.
    pub fn friction_force(&self) -> f64 {
        self.port_forces.iter().step_by(2).sum()
    }

    /// Half of the distance between the outermost contact edges \[m]; zero without contact.
    pub fn half_width(&self) -> f64 {
        hull(&self.edges).map_or(0.0, Interval::half_length)
    }

    /// Length that is in contact, all patches together \[m].
    pub fn touching(&self) -> f64 {
        self.edges.iter().map(|edges| edges.high - edges.low).sum()
    }

    /// Work of the pressure where the surfaces have become `deeper` \[m] at the nodes of the overlap, the first and the
    /// last of which bear nothing [J/m]. Where nodes lie between the lattice points of a dent it keeps a little less
    /// than the whole overlap, the more the wider the nodes: the rest springs back.
    pub fn work_of(&self, deeper: impl Fn(f64) -> f64) -> f64 {
        let x = &self.yielding.overlap.x;
        let width = |i: usize| 0.5 * (x[(i + 1).min(x.len() - 1)] - x[i.saturating_sub(1)]);
        (0..x.len()).map(|i| width(i) * deeper(x[i]) * self.pressure.at(x[i])).sum()
    }

    /// Integral of the pressure times a function of x, that of its middle in every piece of the pressure [N/m times the
    /// unit of the function]; it is asked from low x to high.
    pub fn load_times(&self, mut of: impl FnMut(f64) -> f64) -> f64 {
        self.pressure.segments().map(|(x, p)| 0.5 * (x[1] - x[0]) * (p[0] + p[1]) * of(0.5 * (x[0] + x[1]))).sum()
    }

    /// Work of the pressure on the whole overlap [J/m].
    pub fn overlap_work(&self) -> f64 {
        self.work_of(|x| self.yielding.overlap.at(x))
    }

    /// Takes away all that lies across, which an earlier use of the memory may have left.
    pub fn clear_across(&mut self) {
        (self.spin_moment, self.friction.lateral_slip) = (0.0, 0.0);
        self.lateral_shear.clear();
        self.lateral_slip.clear();
    }

    /// Takes away all slip and its dissipation: the state of a wheel at rest.
    pub fn rest(&mut self) {
        self.friction.rest();
        self.slip.value.fill(0.0);
        self.lateral_slip.value.fill(0.0);
    }
}

/// From the beginning of the first interval to the end of the last one.
fn hull(intervals: &[Interval]) -> Option<Interval> {
    Some(Interval { low: intervals.first()?.low, high: intervals.last()?.high })
}
