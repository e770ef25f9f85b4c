//! Mixed control: which partner of each work-conjugate pair is prescribed, and to what.

use serde::{Deserialize, Serialize};

/// Prescribed partner of (moment, angular velocity).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Rotation {
    Velocity,
    Moment,
}

/// Prescribed partner of (horizontal force, translational velocity).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Translation {
    Velocity,
    Force,
}

/// Prescribed partner of (vertical load, hub displacement).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Vertical {
    Force,
    Displacement,
}

/// Real-valued inputs of the whole wheel; used for values and for their time derivatives.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Drive {
    /// Angular velocity, forward rolling positive [rad/s].
    pub omega: f64,
    /// Driving moment, forward positive [N m].
    pub moment: f64,
    /// Translational velocity [m/s].
    pub velocity: f64,
    /// Horizontal driving force on the hub [N].
    pub force: f64,
    /// Vertical load pressing the hub down [N].
    pub load: f64,
    /// Hub height above just touching, up positive [m].
    pub displacement: f64,
    /// Friction coefficient available now [1].
    pub friction: f64,
    /// Brake block heat into the tread [W].
    pub tread_heat: f64,
}

/// Everything the outside prescribes during one communication step.
///
/// Forces and friction follow `drive + rate·(t − t_start)`. Prescribed velocities and the hub displacement cannot jump:
/// they move linearly from their present value to the input's value at the end of the communication step.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Inputs {
    pub rotation: Rotation,
    pub translation: Translation,
    pub vertical: Vertical,
    /// Values at the start of the step.
    pub drive: Drive,
    /// First time derivatives; zero unless the master supplies them.
    pub rate: Drive,
}

/// An input outside its range.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{name} = {value} is outside its range: {low} to {high}")]
pub struct InputError {
    /// FMI name of the input.
    pub name: &'static str,
    pub value: f64,
    pub low: f64,
    pub high: f64,
}

/// Name, smallest and largest meaningful value of each real input, in the order of [`Drive::values`].
pub const INPUT_RANGES: [(&str, f64, f64); 8] = [
    ("drive.omega", -2e4, 2e4),
    ("drive.moment", -1e9, 1e9),
    ("drive.velocity", -200.0, 200.0),
    ("drive.force", -1e9, 1e9),
    ("drive.load", 0.0, 1e9),
    ("drive.displacement", -0.1, 0.1),
    ("rail.friction", 0.0, 10.0),
    ("drive.tread_heat", 0.0, 1e9),
];

impl Drive {
    /// The values in the order of [`INPUT_RANGES`].
    pub fn values(&self) -> [f64; 8] {
        [
            self.omega,
            self.moment,
            self.velocity,
            self.force,
            self.load,
            self.displacement,
            self.friction,
            self.tread_heat,
        ]
    }

    /// The inverse of [`Drive::values`].
    fn from_values(values: [f64; 8]) -> Self {
        let [omega, moment, velocity, force, load, displacement, friction, tread_heat] = values;
        Self { omega, moment, velocity, force, load, displacement, friction, tread_heat }
    }

    /// `f` of the values of both, one by one.
    pub fn zip(&self, other: &Self, f: impl Fn(f64, f64) -> f64) -> Self {
        let (a, b) = (self.values(), other.values());
        Self::from_values(std::array::from_fn(|k| f(a[k], b[k])))
    }

    /// Refuses values out of range, infinite or not a number.
    pub fn validate(&self) -> Result<(), InputError> {
        for ((name, low, high), value) in INPUT_RANGES.into_iter().zip(self.values()) {
            if !(value >= low && value <= high) {
                return Err(InputError { name, value, low, high });
            }
        }
        Ok(())
    }
}

impl Inputs {
    /// Refuses inputs out of range, infinite or not a number; rates only need to be finite.
    pub fn validate(&self) -> Result<(), InputError> {
        self.drive.validate()?;
        for ((name, ..), value) in INPUT_RANGES.into_iter().zip(self.rate.values()) {
            if !value.is_finite() {
                return Err(InputError { name, value, low: f64::MIN, high: f64::MAX });
            }
        }
        Ok(())
    }

    /// The values `time` seconds after the start of the communication step. A ramp to the end of a range does not leave
    /// it by rounding.
    pub fn at(&self, time: f64) -> Drive {
        let (values, rates) = (self.drive.values(), self.rate.values());
        Drive::from_values(std::array::from_fn(|k| {
            let (_, low, high) = INPUT_RANGES[k];
            let by = time * rates[k];
            let value = values[k] + by;
            let limited = value.clamp(low, high);
            let rounding = 4.0 * f64::EPSILON * (values[k].abs() + by.abs());
            if (value - limited).abs() <= rounding { limited } else { value }
        }))
    }
}

/// Creepage `2 (V − V_C)/(V + V_C)` of the translational and the peripheral velocity [m/s]: braking positive, 0 at
/// standstill.
///
/// Where wheel and rail move against each other the quotient has a pole (`V_C = −V`) and says nothing; such a wheel slides
/// more than a locked one, and the creepage stays at the value of the locked wheel, 2.
pub fn creepage(v: f64, v_c: f64) -> f64 {
    if at_rest(v, v_c) {
        0.0
    } else if v * v_c < 0.0 {
        2.0
    } else {
        2.0 * (v - v_c) / (v + v_c)
    }
}

/// Slide `(V − V_C)/V` of EN 15595 [1]: 1 for the locked wheel, 0 at standstill; of a wheel that spins on the spot it is
/// given as if it travelled at the speed [`STANDSTILL`].
pub fn slide(v: f64, v_c: f64) -> f64 {
    if at_rest(v, v_c) { 0.0 } else { (v - v_c) / v.abs().max(STANDSTILL).copysign(v) }
}

/// The one rule of standstill: the speeds of travel and circumference [m/s] together are below [`STANDSTILL`].
fn at_rest(v: f64, v_c: f64) -> bool {
    v.abs() + v_c.abs() < STANDSTILL
}

/// Peripheral velocity that belongs to a velocity and a creepage above −2: `V_C = V (1 − ξ/2)/(1 + ξ/2)`.
pub fn peripheral_velocity(v: f64, creepage: f64) -> f64 {
    v * (1.0 - 0.5 * creepage) / (1.0 + 0.5 * creepage)
}

/// Sum of translational and peripheral speed below which creepage and slide are reported as zero [m/s]: a wheel at rest
/// rocks on its elastic contact with some mm/s.
pub const STANDSTILL: f64 = 0.02;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn creepage_is_the_thesis_definition_and_bounded() {
        assert!((creepage(10.0, 9.0) - 2.0 / 19.0).abs() < 1e-15);
        assert!((creepage(-10.0, -9.0) - 2.0 / 19.0).abs() < 1e-15);
        assert_eq!(creepage(10.0, 0.0), 2.0);
        assert_eq!(creepage(0.0, 10.0), -2.0);
        assert_eq!(creepage(0.0, 0.0), 0.0);
        assert!((creepage(13.0, peripheral_velocity(13.0, 3e-4)) - 3e-4).abs() < 1e-15);
    }

    #[test]
    fn a_ramp_to_the_end_of_a_range_does_not_leave_it_by_rounding() {
        let (start, step) = (0.007, 0.003);
        let inputs = |k: usize, slope: f64| {
            let (mut values, mut rates) = ([0.0; 8], [0.0; 8]);
            (values[k], rates[k]) = (start, slope);
            let (drive, rate) = (Drive::from_values(values), Drive::from_values(rates));
            let (rotation, translation, vertical) = (Rotation::Moment, Translation::Force, Vertical::Force);
            Inputs { rotation, translation, vertical, drive, rate }
        };
        assert!(start + step * (-start / step) < 0.0, "the case rounds below zero");
        for (k, (name, low, _)) in INPUT_RANGES.into_iter().enumerate().filter(|(_, range)| range.1 == 0.0) {
            assert_eq!(inputs(k, -start / step).at(step).values()[k], low, "{name}");
            assert_eq!(inputs(k, -2.0 * start / step).at(step).validate().unwrap_err().name, name);
        }
    }

    #[test]
    fn a_value_that_is_not_a_number_is_refused_by_name() {
        let drive = Drive { load: f64::NAN, ..Drive::default() };
        assert_eq!(drive.validate().unwrap_err().name, "drive.load");
    }
}
