//! Surface loads, divided among the elements of the surfaces.
//!
//! Everything enters the equations through moments over the surface elements, `∫ q ds`, `∫ q ξ ds`, `∫ k_c ξ² ds` with
//! ξ from 0 to 1 across an element, integrated piecewise between all break points (nodes of the mesh and of the
//! profile, edges of the patches). Profiles may have kinks and jumps anywhere; their total heat is kept to round-off.

use super::sources::SourceLoads;
use crate::heat::error::HeatError;
use crate::heat::exchange::Exchange;
use crate::heat::state::BoundaryState;
use crate::heat::tensor::mesh::layout::HeatLayout;
use crate::piecewise::{Interval, Piecewise, interpolate};

/// Moments of all loads on the surface elements; linear in the data.
#[derive(Clone, Debug, Default)]
pub struct SurfaceLoads {
    /// `∫ k_c (1, ξ, ξ²) ds` on the elements of the contact zone [W/(m K)].
    pub conductance: Vec<[f64; 3]>,
    /// `γ_f ∫ q (1, ξ) ds` on the elements of the contact zone [W/m].
    pub friction: Vec<[f64; 2]>,
    /// Share of it that acts in the present stage [1].
    pub friction_share: f64,
    /// Loads of the sources beside friction.
    pub sources: SourceLoads,
    /// `∫ k_c (1, ξ) (reversible temperature of the wheel less that of the rail) ds` on the elements of the contact
    /// zone [W/m]; empty without.
    pub reversible: Vec<[f64; 2]>,
    /// Heat content over `ρc` of the rail that enters with the stream \[K].
    pub arriving: f64,
}

impl SurfaceLoads {
    /// Friction heat in the present stage [W/m].
    pub fn friction_heat(&self) -> f64 {
        self.friction_share * self.friction.iter().map(|q| q[0]).sum::<f64>()
    }

    /// Replaces the loads by the moments of `exchange` on the surface elements; `arriving` is the heat
    /// content over `ρc` of the rail that enters \[K].
    pub fn set(&mut self, layout: &HeatLayout, exchange: &Exchange, arriving: f64) -> Result<(), HeatError> {
        self.friction_share = 1.0;
        self.arriving = arriving;
        let zone = Zone { x: layout.zone_positions(), half_length: layout.config.reach };
        self.friction.clear();
        self.friction.resize(layout.zone_elements(), [0.0; 2]);
        zone.add_friction(layout.config.heat_ratio, &exchange.friction_power, &mut self.friction)?;
        if !exchange.film.is_empty() {
            zone.leave(&exchange.film, &mut self.friction);
        }
        self.conductance.clear();
        self.conductance.resize(layout.zone_elements(), [0.0; 3]);
        zone.add_conductance(layout.config.conductance, &exchange.patches, &mut self.conductance)?;
        self.reversible.clear();
        if !exchange.reversible.is_empty() {
            zone.add_reversible(&exchange.reversible, &self.conductance, &mut self.reversible)?;
        }
        self.sources.set(layout, &exchange.sources)
    }

    /// Sums of the loads, at the given speeds.
    pub fn boundary(&self, speeds: [f64; 2]) -> BoundaryState {
        BoundaryState {
            speeds,
            conductance: self.conductance.iter().map(|c| c[0]).sum(),
            heat: [self.friction.iter().map(|q| q[0]).sum(), self.sources.heat()],
        }
    }
}

/// Elements of the contact zone.
struct Zone<'a> {
    /// Positions of their nodes \[m], ascending.
    x: &'a [f64],
    /// Half-length within which everything has to act \[m].
    half_length: f64,
}

impl Zone<'_> {
    /// Adds the moments of a friction power, of which the share `fraction` becomes heat.
    fn add_friction(&self, fraction: f64, power: &Piecewise, out: &mut [[f64; 2]]) -> Result<(), HeatError> {
        check("friction power", power)?;
        for (x, v) in power.segments() {
            self.over_elements("friction power", x, &mut |e, xi, at, length| {
                let value = |t: f64| fraction * (v[0] + t * (v[1] - v[0]));
                let (q0, q1) = (value(at[0]), value(at[1]));
                out[e][0] += 0.5 * length * (q0 + q1);
                // ∫ of the product of two linear functions.
                out[e][1] += length / 6.0 * (q0 * (2.0 * xi[0] + xi[1]) + q1 * (xi[0] + 2.0 * xi[1]));
            })?;
        }
        Ok(())
    }

    /// Leaves the `share` at every node of its load: a node without friction is not heated by its neighbours, either.
    fn leave(&self, share: &Piecewise, loads: &mut [[f64; 2]]) {
        let share_at = |x: f64| interpolate(&share.x, &share.value, x);
        for (load, ends) in loads.iter_mut().zip(self.x.windows(2)) {
            let [whole, second] = *load;
            let of_second = second * share_at(ends[1]);
            *load = [(whole - second) * share_at(ends[0]) + of_second, of_second];
        }
    }

    /// Appends the heat that reversible temperatures conduct, taken as linear on every element.
    fn add_reversible(
        &self,
        difference: &Piecewise,
        conductance: &[[f64; 3]],
        out: &mut Vec<[f64; 2]>,
    ) -> Result<(), HeatError> {
        check("reversible temperature", difference)?;
        let value = |x: f64| interpolate(&difference.x, &difference.value, x);
        let mut from = self.x.first().map_or(0.0, |&x| value(x));
        for (c, &end) in conductance.iter().zip(&self.x[1..]) {
            let to = value(end);
            let slope = to - from;
            out.push([c[0] * from + c[1] * slope, c[1] * from + c[2] * slope]);
            from = to;
        }
        Ok(())
    }

    /// Adds the moments of the conductance of all patches.
    fn add_conductance(&self, value: f64, patches: &[Interval], out: &mut [[f64; 3]]) -> Result<(), HeatError> {
        for patch in patches {
            if patch.low.is_nan() || patch.high.is_nan() || patch.low > patch.high {
                let Interval { low, high } = patch;
                let why = format!("contact patch from {low} m to {high} m: its ends must be numbers and ascend");
                return Err(HeatError::Exchange(why));
            }
            self.over_elements("contact patch", [patch.low, patch.high], &mut |e, xi, _, length| {
                add_moments(&mut out[e], xi, length, value);
            })?;
        }
        Ok(())
    }

    /// Divides an interval among the elements of the contact zone: element, ξ at both ends, fractions of the interval
    /// at both ends, length of the part.
    fn over_elements(
        &self,
        name: &'static str,
        interval: [f64; 2],
        f: &mut dyn FnMut(usize, [f64; 2], [f64; 2], f64),
    ) -> Result<(), HeatError> {
        let (x, zone) = (self.x, self.half_length);
        let [low, high] = interval;
        // Edges that coincide with the end of the zone are inside, round-off included.
        let reach = zone * (1.0 + 1e-12);
        if let Some(&x) = interval.iter().find(|x| x.is_nan() || x.abs() > reach) {
            let why = format!("{name} reaches x = {x} m, outside the contact zone of ±{zone} m");
            return Err(HeatError::Exchange(why));
        }
        let first = x.partition_point(|&x| x <= low).saturating_sub(1);
        for (e, ends) in x.windows(2).enumerate().skip(first) {
            if ends[0] >= high {
                break;
            }
            let part = [low.max(ends[0]), high.min(ends[1])];
            if part[1] > part[0] {
                let xi = part.map(|x| (x - ends[0]) / (ends[1] - ends[0]));
                f(e, xi, part.map(|x| (x - low) / (high - low)), part[1] - part[0]);
            }
        }
        Ok(())
    }
}

/// Refuses a profile that is no function.
fn check(name: &'static str, profile: &Piecewise) -> Result<(), HeatError> {
    profile.check().map_err(|why| HeatError::Exchange(format!("{name}: {why}")))
}

/// Adds `∫ c (1, ξ, ξ²) ds` over a part of an element by Gauss quadrature (3 points).
fn add_moments(out: &mut [f64; 3], xi: [f64; 2], length: f64, c: f64) {
    const POINTS: [(f64, f64); 3] =
        [(0.112_701_665_379_258_31, 5.0 / 18.0), (0.5, 8.0 / 18.0), (0.887_298_334_620_741_7, 5.0 / 18.0)];
    for (f, weight) in POINTS {
        let x = xi[0] + f * (xi[1] - xi[0]);
        let value = weight * length * c;
        out[0] += value;
        out[1] += value * x;
        out[2] += value * x * x;
    }
}
