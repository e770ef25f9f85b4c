//! Mixed control: which partner of each work-conjugate pair is prescribed, and to what. An input is one row here, and
//! its use in the code.

use super::ramp::{RAMP_NUMBERS, RampRow, STEEPEST};
use crate::config::row::{Level, Row};
use crate::config::units::Measure;
use crate::config::value::{RowValue, ValueLimits, choice, questions};
use crate::display::{display_outside, display_range};
use serde::{Deserialize, Serialize};

choice! {
    /// Prescribed partner of (moment, angular velocity).
    pub enum Rotation named "RotationControl",
        "Which of driving moment and angular velocity is prescribed; the other is the reaction"
    {
        Velocity = "velocity", "drive.omega is prescribed";
        Moment = "moment", "drive.moment is prescribed";
    }
}

choice! {
    /// Prescribed partner of (horizontal force, translational velocity).
    pub enum Translation named "TranslationControl",
        "Which of horizontal force and travel velocity is prescribed; the other is the reaction"
    {
        Velocity = "velocity", "drive.velocity is prescribed";
        Force = "force", "drive.force is prescribed";
    }
}

choice! {
    /// Prescribed partner of (vertical load, hub displacement).
    pub enum Vertical named "VerticalControl",
        "Which of vertical load and hub height is prescribed; the other is the reaction"
    {
        Force = "force", "drive.load is prescribed";
        Displacement = "displacement", "drive.displacement is prescribed";
    }
}

choice! {
    /// Prescribed partner of (lateral force, lateral velocity).
    pub enum Lateral named "LateralControl",
        "Which of lateral force and lateral velocity is prescribed; the other is the reaction"
    {
        Velocity = "velocity", "drive.lateral_velocity is prescribed";
        Force = "force", "drive.lateral_force is prescribed";
    }
}

questions! {
    /// The angular velocity is prescribed, the moment its reaction.
    Rotation: prescribes_motion { Velocity => true, Moment => false }
    /// The travel velocity is prescribed, the horizontal force its reaction.
    Translation: prescribes_motion { Velocity => true, Force => false }
    /// The hub height is prescribed, the load its reaction.
    Vertical: prescribes_motion { Displacement => true, Force => false }
    /// The lateral velocity is prescribed, the lateral force its reaction.
    Lateral: prescribes_motion { Velocity => true, Force => false }
}

/// The row of one real input.
#[derive(Clone, Copy, Debug)]
pub struct DriveRow {
    /// Fixed number of the input, which survives new ones: programs may know it.
    pub number: u32,
    /// Name in the form `group.name`.
    pub name: &'static str,
    /// Name of its time derivative.
    pub rate_name: &'static str,
    /// Unit.
    pub measure: Measure,
    /// Smallest meaningful value.
    pub low: f64,
    /// Largest meaningful value.
    pub high: f64,
    /// Usual size.
    pub nominal: f64,
    /// Meaning, plain text.
    pub text: &'static str,
    /// The value.
    pub field: fn(&mut Drive) -> &mut f64,
    /// Input that is its time derivative, of forces, friction and heat: what is prescribed as a motion moves linearly anyway.
    pub ramp: Option<RampRow>,
}

impl DriveRow {
    /// Heat that a source brings: of all inputs these alone are powers.
    pub fn is_heat(&self) -> bool {
        self.measure.unit == "W"
    }

    /// Input that acts on temperatures alone.
    pub fn is_thermal(&self) -> bool {
        self.is_heat() || self.measure.unit == "K"
    }

    /// Refuses a value out of range, infinite or not a number.
    fn check(&self, value: f64) -> Result<(), InputError> {
        let DriveRow { name, low, high, measure, .. } = *self;
        let refused = || InputError { name, value, low, high, unit: measure.unit };
        if value >= low && value <= high { Ok(()) } else { Err(refused()) }
    }
}

/// Defines the inputs: choices between partners, and real values with their group, unit, range and usual size.
macro_rules! inputs {
    (@display) => { None };
    (@display $display:literal) => { Some($display) };
    (@ramp $number:literal $name:expr, $nominal:literal) => { None };
    (@ramp $number:literal $name:expr, $nominal:literal $unit:literal) => {
        Some(RampRow {
            number: $number + RAMP_NUMBERS,
            name: concat!($name, "_rate"),
            measure: Measure { unit: $unit, display: None },
            nominal: 10.0 * $nominal,
            text: concat!(
                "Time derivative of ", $name, " during the coming steps, in which it ramps from the value it has; unset: it is held"
            ),
        })
    };
    (
        controls { $( $choice_number:literal $choice:ident: $Choice:ty, $choice_text:literal; )* }
        values {
            $(
                $number:literal $field:ident of $group:literal, in $unit:literal $(as $display:literal)?,
                    from $low:literal to $high:literal, nominal $nominal:literal $(ramps in $per_second:literal)?, $text:literal;
            )*
        }
    ) => {
        /// Real-valued inputs of the whole wheel; used for values and for their time derivatives.
        #[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
        pub struct Drive {
            $( #[doc = concat!($text, " \\[", $unit, "].")] pub $field: f64, )*
        }

        /// Number of real inputs.
        const COUNT: usize = [$( $number ),*].len();

        impl Drive {
            /// The row of every real input.
            pub const ROWS: [DriveRow; COUNT] = [$(
                DriveRow {
                    number: $number,
                    name: concat!($group, ".", stringify!($field)),
                    rate_name: concat!("der(", $group, ".", stringify!($field), ")"),
                    measure: Measure { unit: $unit, display: inputs!(@display $($display)?) },
                    low: $low,
                    high: $high,
                    nominal: $nominal,
                    text: $text,
                    field: |drive| &mut drive.$field,
                    ramp: inputs!(
                        @ramp $number concat!($group, ".", stringify!($field)), $nominal $($per_second)?
                    ),
                },
            )*];

            /// Number of inputs that have their time derivative as another input.
            pub const RAMPS: usize = {
                let (mut count, mut k) = (0, 0);
                while k < COUNT {
                    count += Self::ROWS[k].ramp.is_some() as usize;
                    k += 1;
                }
                count
            };

            /// The values in the order of [`Drive::ROWS`].
            pub fn values(&self) -> [f64; COUNT] {
                [$( self.$field ),*]
            }

            /// The inverse of [`Drive::values`].
            fn from_values([$( $field ),*]: [f64; COUNT]) -> Self {
                Self { $( $field ),* }
            }
        }

        /// Everything the outside prescribes during one communication step.
        ///
        /// Forces and friction follow `drive + rate·(t − t_start)`. Prescribed velocities and the hub displacement
        /// cannot jump: they move linearly from their present value to the input's value at the end of the communication
        /// step. The elevation of the rail gets there on a cubic ([`super::elevation`]).
        #[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
        pub struct Inputs {
            $( #[doc = concat!($choice_text, ".")] pub $choice: $Choice, )*
            /// Values at the start of the step.
            pub drive: Drive,
            /// First time derivatives; zero unless the master supplies them.
            pub rate: Drive,
        }

        impl Inputs {
            /// Number of choices between partners.
            pub const CONTROLS: usize = [$( $choice_number ),*].len();

            /// The rows of the choices between partners.
            pub fn controls() -> [Row<Inputs>; Self::CONTROLS] {
                [$(
                    Row {
                        number: $choice_number,
                        level: Level::Basic,
                        name: concat!("control.", stringify!($choice)),
                        kind: <$Choice as RowValue>::kind(ValueLimits::default()),
                        tunable: true,
                        text: $choice_text,
                        read: |inputs| inputs.$choice.read(),
                        write: |inputs, value| inputs.$choice.write(value),
                    },
                )*]
            }
        }
    };
}

inputs! {
    controls {
        100 rotation: Rotation,
            "Prescribed partner of (moment, angular velocity); switching between steps is bumpless";
        101 translation: Translation,
            "Prescribed partner of (horizontal force, travel velocity); switching between steps is bumpless";
        102 vertical: Vertical, "Prescribed partner of (load, hub height); switching between steps is bumpless";
        103 lateral: Lateral,
            "Prescribed partner of (lateral force, lateral velocity), with contact.lateral; switching between steps is bumpless";
    }
    values {
        200 omega of "drive", in "rad/s" as "rpm", from -2e4 to 2e4, nominal 60.0,
            "Angular velocity, forward rolling positive; unset: from initial.velocity and initial.creepage, or \
             without creepage";
        201 moment of "drive", in "N.m" as "kN.m", from -1e9 to 1e9, nominal 1e4 ramps in "N.m/s",
            "Driving moment on the hub, forward positive (braking negative)";
        202 velocity of "drive", in "m/s" as "km/h", from -200.0 to 200.0, nominal 30.0,
            "Travel velocity of the wheel centre, positive in x; unset: initial.velocity";
        203 force of "drive", in "N" as "kN", from -1e9 to 1e9, nominal 1e4 ramps in "N/s",
            "Horizontal driving force on the hub, positive in x";
        204 load of "drive", in "N" as "kN", from 0.0 to 1e9, nominal 1e5 ramps in "N/s",
            "Vertical load on the hub, pressing down positive, the weight of wheel and axle included; unset: model.nominal_load";
        205 displacement of "drive", in "m" as "mm", from -0.1 to 0.1, nominal 1e-4,
            "Hub height above just touching a rail of elevation 0, up positive (pressed: negative); unset: the height at which \
             the wheel carries drive.load at the start";
        207 load_change of "drive", in "N" as "kN", from -1e9 to 1e9, nominal 1e4 ramps in "N/s",
            "Vertical load on the hub in addition to drive.load, pressing down positive: what a suspension adds to the static \
             load. Masters whose connections are zero before the first step keep the load at the start";
        208 lateral_velocity of "drive", in "m/s" as "mm/s", from -50.0 to 50.0, nominal 0.1,
            "Lateral velocity of the wheel on the rail in the plane of contact, at the centre of load (contact.load_position), to the right \
             positive, with contact.lateral: what the wheelset moves to the right, less drive.velocity times the sine of the angle of attack, \
             which is positive where the wheel is turned to the right, both over the cosine of drive.contact_angle";
        209 lateral_force of "drive", in "N" as "kN", from -1e9 to 1e9, nominal 1e4 ramps in "N/s",
            "Lateral force on the hub in the plane of contact, to the right positive, with contact.lateral";
        210 spin of "drive", in "1/m", from -100.0 to 100.0, nominal 0.1 ramps in "1/(m.s)",
            "Spin of the wheel on the rail over its velocity, with contact.lateral: seen from above it turns clockwise over the ground \
             by this angle per metre travelled (in a right-hand curve 1/radius), times the cosine of drive.contact_angle, besides what \
             drive.contact_angle makes";
        211 contact_angle of "drive", in "rad" as "deg", from -1.5 to 1.5, nominal 0.05 ramps in "rad/s",
            "Angle between the plane of contact and the axle, with contact.lateral: positive where the plane rises to the right, as that of \
             a right-hand wheel does. The turning wheel spins in this plane with minus wheel.omega times the sine";
        212 lateral of "wheelset", in "m" as "mm", from -0.1 to 0.1, nominal 1e-3,
            "Shift of the wheelset from the middle of the track, to the right positive, with wheelset.side: it moves linearly to its \
             value at the end of the step, as all of wheelset.* do";
        213 yaw of "wheelset", in "rad" as "mrad", from -0.5 to 0.5, nominal 1e-3,
            "Turn of the wheelset against the track seen from above, clockwise positive (to the right), with wheelset.side";
        214 roll of "wheelset", in "rad" as "mrad", from -0.5 to 0.5, nominal 1e-3,
            "Lean of the wheelset against the track, positive where its right end is the lower one, with wheelset.side";
        215 lateral_rate of "wheelset", in "m/s" as "mm/s", from -50.0 to 50.0, nominal 0.1,
            "Rate of wheelset.lateral";
        216 yaw_rate of "wheelset", in "rad/s" as "mrad/s", from -50.0 to 50.0, nominal 0.1,
            "Rate of the wheelset's turn over ground, clockwise positive: in a curve more than that of wheelset.yaw, by the velocity over \
             the radius";
        217 roll_rate of "wheelset", in "rad/s" as "mrad/s", from -50.0 to 50.0, nominal 0.1,
            "Rate of wheelset.roll";
        250 friction of "rail", in "1", from 0.0 to 10.0, nominal 0.3 ramps in "1/s",
            "Friction coefficient available now; unset: friction.coefficient";
        251 temperature of "rail", in "K" as "degC", from 0.0 to 1e4, nominal 300.0 ramps in "K/s",
            "Absolute temperature of the rail that arrives at the contact, uniform over its depth. A change is \
             that of all rail ahead of the contact and comes under the wheel with the way; unset: thermal.reference";
        252 slope of "rail", in "1" as "%", from -0.5 to 0.5, nominal 0.01 ramps in "1/s",
            "Gradient of the track, rising in x positive: the weight of all masses that move in x pulls the wheel along it, \
             downhill; drive.load stays normal to the track";
        253 elevation of "rail", in "m" as "mm", from -0.1 to 0.1, nominal 1e-3,
            "Height of the rail under the wheel, up positive; it reaches its value at the end of the step, smoothly: see \
             rail.elevation_rate. The zero of drive.displacement stays where it was (the height of the modelled piece of rail is \
             the parameter rail.height)";
        254 elevation_rate of "rail", in "m/s" as "mm/s", from -10.0 to 10.0, nominal 1e-2,
            "Rate of rail.elevation at the end of the step: velocity times inclination of the rail under the wheel. A master that \
             knows the track gives it, and steps of a tenth of a wave are short enough; 0: that of the parabola through this height \
             and those of the two steps before, for which steps should be a thirtieth of a wave";
        206 tread_heat of "drive", in "W" as "kW", from 0.0 to 1e9, nominal 1e4 ramps in "W/s",
            "Heat of the brake blocks into the tread";
        260 torque of "brake", in "N.m" as "kN.m", from 0.0 to 1e9, nominal 1e4 ramps in "N.m/s",
            "Strength of the brake: its moment opposes the rotation, and holds the wheel at rest as far as that takes no \
             more; acts beside drive.moment, and not while control.rotation prescribes drive.omega";
    }
}

/// An input outside its range.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{name} = {} is outside its range: {}", display_outside(*value, [*low, *high]), display_range([*low, *high], unit))]
pub struct InputError {
    /// Name of the input.
    pub name: &'static str,
    /// Its value.
    pub value: f64,
    /// Smallest value allowed.
    pub low: f64,
    /// Largest value allowed.
    pub high: f64,
    /// Unit of all three.
    pub unit: &'static str,
}

impl Drive {
    /// All that presses the hub down \[N].
    pub fn pressing(&self) -> f64 {
        self.load + self.load_change
    }

    /// Usual sizes of all inputs, where their values are not larger.
    pub fn sizes(&self) -> Self {
        let values = self.values();
        Self::from_values(std::array::from_fn(|k| values[k].abs().max(Self::ROWS[k].nominal)))
    }

    /// `f` of the values of both, one by one.
    pub fn zip(&self, other: &Self, f: impl Fn(f64, f64) -> f64) -> Self {
        let (a, b) = (self.values(), other.values());
        Self::from_values(std::array::from_fn(|k| f(a[k], b[k])))
    }

    /// Refuses values out of range, infinite or not a number.
    pub fn validate(&self) -> Result<(), InputError> {
        Self::ROWS.iter().zip(self.values()).try_for_each(|(row, value)| row.check(value))
    }
}

/// Nothing drives the wheel, which moves freely but for the side.
impl Default for Inputs {
    fn default() -> Self {
        Self {
            rotation: Rotation::Moment,
            translation: Translation::Force,
            vertical: Vertical::Force,
            lateral: Lateral::Velocity,
            drive: Drive::default(),
            rate: Drive::default(),
        }
    }
}

impl Inputs {
    /// Refuses inputs out of range, infinite or not a number; rates of motions only need to be finite.
    pub fn validate(&self) -> Result<(), InputError> {
        self.drive.validate()?;
        for (row, value) in Drive::ROWS.iter().zip(self.rate.values()) {
            if let Some(RampRow { name, measure, .. }) = row.ramp {
                let (low, high) = (-STEEPEST, STEEPEST);
                let refused = InputError { name, value, low, high, unit: measure.unit };
                (low..=high).contains(&value).then_some(()).ok_or(refused)?;
            } else if !value.is_finite() {
                let (low, high) = (f64::NEG_INFINITY, f64::INFINITY);
                return Err(InputError { name: row.rate_name, value, low, high, unit: "1" });
            }
        }
        Ok(())
    }

    /// The values `time` seconds after the start of the communication step. A ramp to the end of a range does not leave
    /// it by rounding.
    pub fn at(&self, time: f64) -> Drive {
        let (values, rates) = (self.drive.values(), self.rate.values());
        Drive::from_values(std::array::from_fn(|k| {
            let DriveRow { low, high, .. } = Drive::ROWS[k];
            let by = time * rates[k];
            let value = values[k] + by;
            let limited = value.clamp(low, high);
            let rounding = 4.0 * f64::EPSILON * (values[k].abs() + by.abs());
            if (value - limited).abs() <= rounding { limited } else { value }
        }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ramp_to_the_end_of_a_range_does_not_leave_it_by_rounding() {
        let (start, step) = (0.007, 0.003);
        let inputs = |k: usize, slope: f64| {
            let (mut values, mut rates) = ([0.0; COUNT], [0.0; COUNT]);
            (values[k], rates[k]) = (start, slope);
            let (drive, rate) = (Drive::from_values(values), Drive::from_values(rates));
            Inputs { drive, rate, ..Inputs::default() }
        };
        assert!(start + step * (-start / step) < 0.0, "the case rounds below zero");
        for (k, row) in Drive::ROWS.iter().enumerate().filter(|(_, row)| row.low == 0.0) {
            assert_eq!(inputs(k, -start / step).at(step).values()[k], row.low, "{}", row.name);
            assert_eq!(inputs(k, -2.0 * start / step).at(step).validate().unwrap_err().name, row.name);
        }
    }

    #[test]
    fn a_rate_that_is_not_finite_is_refused_as_a_rate() {
        let refused = |rate: Drive| Inputs { rate, ..Inputs::default() }.validate().unwrap_err().to_string();
        let motion = refused(Drive { velocity: f64::INFINITY, ..Drive::default() });
        assert_eq!(motion, "der(drive.velocity) = inf is outside its range: finite numbers");
        let force = refused(Drive { load: f64::INFINITY, ..Drive::default() });
        assert!(force.starts_with("drive.load_rate = inf is outside its range: "), "{force}");
    }

    #[test]
    fn a_value_that_is_not_a_number_is_refused_by_name() {
        let drive = Drive { load: f64::NAN, ..Drive::default() };
        assert_eq!(drive.validate().unwrap_err().name, "drive.load");
    }
}
