//! What acts on the surfaces: contact conductance, frictional heat, heat on the tread, air.
//!
//! Everything enters the equations through moments over the surface elements, `∫ q ds`, `∫ q ξ ds`, `∫ k_c ξ² ds` with
//! ξ from 0 to 1 across an element, integrated piecewise between all break points (nodes of the mesh and of the profile,
//! edges of the patches). Profiles may have kinks and jumps anywhere; their total heat is kept to round-off.

use super::{Heat, HeatError};
use crate::piecewise::{Piecewise, interpolate};
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// Interval of the surface where the bodies touch [m].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Patch {
    pub low: f64,
    pub high: f64,
}

/// Contact conductance `k_c` [W/(m² K)].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, tag = "law", rename_all = "snake_case")]
pub enum Conductance {
    Constant {
        value: f64,
    },
    /// `k_c = value (p/reference_pressure)^0.95` (Cooper, Mikic & Yovanovich, *Int. J. Heat Mass Transfer* 12 (1969)).
    Pressure {
        value: f64,
        reference_pressure: f64,
    },
}

/// Exponent of the pressure in the conductance of rough surfaces in plastic contact.
const PRESSURE_EXPONENT: f64 = 0.95;

/// Prescribed heat on an arc of the tread that is fixed in space (a brake block).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct TreadHeat {
    /// Angle of its middle from the contact point, positive on the leading side [rad].
    pub angle: f64,
    /// Its extent [rad].
    pub width: f64,
    /// Heat into the wheel [W/m], uniform over the arc.
    pub heat: f64,
}

/// What acts on the bodies during a step, per metre of width.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Exchange {
    /// Where the bodies touch; none: lifted off.
    pub patches: Vec<Patch>,
    /// Contact pressure [Pa]; used by the pressure-dependent conductance only.
    pub pressure: Piecewise,
    /// Friction power per area `|τ s|` [W/m²], of which the fraction `γ_f` becomes heat in the bodies.
    pub friction_power: Piecewise,
    pub tread: Vec<TreadHeat>,
    /// Reversible temperatures that conduct besides those of the fields: wheel less rail [K].
    pub reversible: Piecewise,
    /// Excess temperature of the air [K].
    pub ambient: f64,
    /// Whether speeds and everything above hold over the whole step, instead of varying linearly from the step before.
    pub held: bool,
}

/// Moments of everything that acts, on the surface elements; linear in the data.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Supply {
    /// `∫ k_c (1, ξ, ξ²) ds` on the elements of the contact zone [W/(m K)].
    pub conductance: Vec<[f64; 3]>,
    /// `γ_f ∫ q (1, ξ) ds` on the elements of the contact zone [W/m].
    pub friction: Vec<[f64; 2]>,
    /// `∫ q (1, ξ) ds` on the elements of the tread [W/m]; empty without heat there.
    pub tread: Vec<[f64; 2]>,
    /// `∫ k_c (1, ξ) (reversible temperature of the wheel less that of the rail) ds` on the elements of the contact zone
    /// [W/m]; empty without.
    pub reversible: Vec<[f64; 2]>,
    pub ambient: f64,
}

impl Supply {
    /// `(1 − f) a + f b`.
    pub fn mix(a: &Self, b: &Self, f: f64, out: &mut Self) {
        fn blend<const N: usize>(a: &[[f64; N]], b: &[[f64; N]], f: f64, out: &mut Vec<[f64; N]>) {
            let zero = [0.0; N];
            out.clear();
            out.extend((0..a.len().max(b.len())).map(|e| {
                let (x, y) = (a.get(e).unwrap_or(&zero), b.get(e).unwrap_or(&zero));
                std::array::from_fn(|k| if x[k] == y[k] { x[k] } else { (1.0 - f) * x[k] + f * y[k] })
            }));
        }
        blend(&a.conductance, &b.conductance, f, &mut out.conductance);
        blend(&a.friction, &b.friction, f, &mut out.friction);
        blend(&a.tread, &b.tread, f, &mut out.tread);
        blend(&a.reversible, &b.reversible, f, &mut out.reversible);
        out.ambient = if a.ambient == b.ambient { a.ambient } else { (1.0 - f) * a.ambient + f * b.ambient };
    }

    /// First and one past the last element of the zone that conducts.
    pub fn contact(&self) -> std::ops::Range<usize> {
        let conducts = |c: &[f64; 3]| c[0] > 0.0;
        match self.conductance.iter().position(conducts) {
            Some(first) => first..self.conductance.iter().rposition(conducts).map_or(first, |last| last + 1),
            None => 0..0,
        }
    }
}

impl Heat {
    /// Moments of `exchange` on the surface elements.
    pub(super) fn supply(&self, exchange: &Exchange) -> Result<Supply, HeatError> {
        check("friction power", &exchange.friction_power)?;
        if !exchange.ambient.is_finite() {
            return Err(HeatError::Input { name: "ambient temperature", value: exchange.ambient });
        }
        let mut supply = Supply { ambient: exchange.ambient, ..Supply::default() };
        supply.friction.resize(self.zone_elements(), [0.0; 2]);
        for (x, v) in exchange.friction_power.segments() {
            self.over_elements("friction power", x, &mut |e, xi, at, length| {
                let value = |t: f64| self.config.friction_fraction * (v[0] + t * (v[1] - v[0]));
                let (q0, q1) = (value(at[0]), value(at[1]));
                let moments = &mut supply.friction[e];
                moments[0] += 0.5 * length * (q0 + q1);
                // ∫ of the product of two linear functions.
                moments[1] += length / 6.0 * (q0 * (2.0 * xi[0] + xi[1]) + q1 * (xi[0] + 2.0 * xi[1]));
            })?;
        }
        supply.conductance.resize(self.zone_elements(), [0.0; 3]);
        self.add_conductance(exchange, &mut supply.conductance)?;
        if !exchange.reversible.x.is_empty() {
            check("reversible temperature", &exchange.reversible)?;
            let Piecewise { x, value } = &exchange.reversible;
            let jump: Vec<f64> = self.zone_x().iter().map(|&at| interpolate(x, value, at)).collect();
            let through = |(c, d): (&[f64; 3], &[f64])| {
                let slope = d[1] - d[0];
                [c[0] * d[0] + c[1] * slope, c[1] * d[0] + c[2] * slope]
            };
            supply.reversible = supply.conductance.iter().zip(jump.windows(2)).map(through).collect();
        }
        self.add_tread(&exchange.tread, &mut supply.tread)?;
        Ok(supply)
    }

    fn add_conductance(&self, exchange: &Exchange, out: &mut [[f64; 3]]) -> Result<(), HeatError> {
        for patch in &exchange.patches {
            if patch.low.is_nan() || patch.high.is_nan() || patch.low > patch.high {
                return Err(HeatError::Patch { low: patch.low, high: patch.high });
            }
            match self.config.conductance {
                Conductance::Constant { value } => {
                    self.over_elements("contact patch", [patch.low, patch.high], &mut |e, xi, _, length| {
                        add_moments(&mut out[e], xi, length, &|_| value);
                    })?;
                }
                Conductance::Pressure { value, reference_pressure } => {
                    check("contact pressure", &exchange.pressure)?;
                    for (x, p) in exchange.pressure.segments() {
                        let inside = [x[0].max(patch.low), x[1].min(patch.high)];
                        if inside[1] <= inside[0] {
                            continue;
                        }
                        let pressure = |place: f64| p[0] + (place - x[0]) / (x[1] - x[0]) * (p[1] - p[0]);
                        let law = |p: f64| value * (p.max(0.0) / reference_pressure).powf(PRESSURE_EXPONENT);
                        self.over_elements("contact pressure", inside, &mut |e, xi, at, length| {
                            let (from, to) = (pressure(inside[0]), pressure(inside[1]));
                            let along = |f: f64| from + (at[0] + f * (at[1] - at[0])) * (to - from);
                            add_moments(&mut out[e], xi, length, &|f| law(along(f)));
                        })?;
                    }
                }
            }
        }
        Ok(())
    }

    fn add_tread(&self, segments: &[TreadHeat], out: &mut Vec<[f64; 2]>) -> Result<(), HeatError> {
        let line = &self.wheel.line;
        for segment in segments {
            let TreadHeat { angle, width, heat } = *segment;
            if !(heat.is_finite() && angle.is_finite()) {
                return Err(HeatError::Input { name: "tread heat", value: heat + angle });
            }
            if !(width > 0.0 && width <= 2.0 * PI) {
                return Err(HeatError::Input { name: "width of tread heat", value: width });
            }
            out.resize(line.len(), [0.0; 2]);
            let length = width * self.config.wheel_radius;
            let middle = angle.rem_euclid(2.0 * PI) * self.config.wheel_radius;
            for (e, h) in line.lengths.iter().enumerate() {
                for turn in -2..=1 {
                    let start = line.nodes[e] - f64::from(turn) * line.closed;
                    let low = ((middle - 0.5 * length - start) / h).clamp(0.0, 1.0);
                    let high = ((middle + 0.5 * length - start) / h).clamp(0.0, 1.0);
                    if high > low {
                        let part = heat / length * (high - low) * h;
                        out[e][0] += part;
                        out[e][1] += part * 0.5 * (low + high);
                    }
                }
            }
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
        let (x, zone) = (self.zone_x(), self.config.zone);
        let [low, high] = interval;
        // Edges that coincide with the end of the zone are inside, round-off included.
        let reach = zone * (1.0 + 1e-12);
        if let Some(&x) = interval.iter().find(|x| x.is_nan() || x.abs() > reach) {
            return Err(HeatError::OutsideZone { name, x, zone });
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
    profile.check().map_err(|why| HeatError::Profile { name, why })
}

/// Adds `∫ c (1, ξ, ξ²) ds` over a part of an element by Gauss quadrature (3 points); `c` takes the fraction of the part.
fn add_moments(out: &mut [f64; 3], xi: [f64; 2], length: f64, c: &dyn Fn(f64) -> f64) {
    const POINTS: [(f64, f64); 3] =
        [(0.112_701_665_379_258_31, 5.0 / 18.0), (0.5, 8.0 / 18.0), (0.887_298_334_620_741_7, 5.0 / 18.0)];
    for (f, weight) in POINTS {
        let x = xi[0] + f * (xi[1] - xi[0]);
        let value = weight * length * c(f);
        out[0] += value;
        out[1] += value * x;
        out[2] += value * x * x;
    }
}
