//! One row per parameter: the macro that makes struct fields, defaults, ranges and access of one list.

use super::value::{Kind, Value};

/// Group of readers for which a parameter is meant. Reference pages show the basic ones first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Level {
    /// Parameters that describe a vehicle, its wheel and track, and a run: what an engineer sets.
    Basic,
    /// Parameters whose defaults are meant to be kept, unless one knows the theory behind them.
    Expert,
}

/// A row of the table of parameters of `T`: what anyone may ask about one parameter, and its value.
#[derive(Debug)]
pub struct Row<T: 'static> {
    /// Fixed number of the parameter, which survives new ones: programs may know it.
    pub number: u32,
    /// Readers for whom it is meant.
    pub level: Level,
    /// Name in the form `group.name`.
    pub name: &'static str,
    /// Kind, unit and range of the values.
    pub kind: Kind,
    /// True if the value may change during a run.
    pub tunable: bool,
    /// Meaning, plain text.
    pub text: &'static str,
    /// Present value.
    pub read: fn(&T) -> Value,
    /// Takes a value; one of another type changes nothing.
    pub write: fn(&mut T, &Value),
}

/// Defines a configuration: a struct of groups, each a struct of parameters, and the table of its rows.
///
/// ```text
/// group: Group fixed {              // `tunable` if its parameters may change during a run
///     1020 basic radius: f64 = 0.46, of "wheel", in "m" as "mm", from 0.01 to 10.0, "Outer radius of the wheel";
/// }
/// ```
///
/// Behind the rows of a group may stand fields that are `inside`, with type, default and meaning: they are no parameters,
/// and only code sets them.
///
/// A row has number, level (`basic` or `expert`), field, type, default and meaning. Between them may stand: `of`, the
/// group in the name if it is not that of the struct; `in`, the SI unit, and `as`, the unit in which people like to
/// read it; `from … to`, the range; and `nominal`, the usual size. Types are `f64`, `Option<f64>` (unset until
/// written), `usize`, `bool`, `String` and those that `choice!` defines.
macro_rules! parameters {
    (@group $group:ident) => { stringify!($group) };
    (@group $group:ident, $of:literal) => { $of };
    (@level basic) => { $crate::config::row::Level::Basic };
    (@level expert) => { $crate::config::row::Level::Expert };
    (@tunable fixed) => { false };
    (@tunable tunable) => { true };
    (@display) => { None };
    (@display $display:literal) => { Some($display) };
    (
        $(#[$about:meta])*
        pub struct $Config:ident {
            $(
                $(#[$doc:meta])*
                $group:ident: $Group:ident $access:ident {
                    $(
                        $number:literal $level:ident $field:ident: $type:ty = $default:expr
                            $(, of $of:literal)?
                            $(, in $unit:literal $(as $display:literal)?)?
                            $(, from $low:literal to $high:literal)?
                            $(, nominal $nominal:literal)?
                            , $text:literal;
                    )*
                    $( inside $inner:ident: $inner_type:ty = $inner_default:expr, $inner_text:literal; )*
                }
            )*
        }
    ) => {
        $(#[$about])*
        #[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
        pub struct $Config {
            $( $(#[$doc])* pub $group: $Group, )*
        }

        $(
            $(#[$doc])*
            #[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
            pub struct $Group {
                $( #[doc = concat!($text, $(" \\[", $unit, "]",)? ".")] pub $field: $type, )*
                $( #[doc = concat!($inner_text, ".")] pub $inner: $inner_type, )*
            }

            impl Default for $Group {
                fn default() -> Self {
                    Self { $( $field: $default, )* $( $inner: $inner_default, )* }
                }
            }
        )*

        impl $Config {
            /// Number of parameters.
            pub const COUNT: usize = [$($( $number, )*)*].len();

            /// Names of the fields that are no parameters, in the form `group.name`.
            pub const INSIDE: &'static [&'static str] =
                &[$( $( concat!(stringify!($group), ".", stringify!($inner)), )* )*];

            /// The row of every parameter, in the order of their numbers.
            #[allow(clippy::needless_update)] // A row may give all its limits.
            pub fn rows() -> &'static [$crate::config::row::Row<$Config>] {
                use $crate::config::units::Measure;
                use $crate::config::value::{RowValue, ValueLimits};
                // An array: a vector would be lost when the library is unloaded, for statics are never dropped.
                type Rows = [$crate::config::row::Row<$Config>; $Config::COUNT];
                static ROWS: std::sync::OnceLock<Rows> = std::sync::OnceLock::new();
                ROWS.get_or_init(|| {
                    let mut rows = [$($(
                        $crate::config::row::Row {
                            number: $number,
                            level: parameters!(@level $level),
                            name: concat!(parameters!(@group $group $(, $of)?), ".", stringify!($field)),
                            kind: <$type as RowValue>::kind(ValueLimits {
                                $( measure: Measure { unit: $unit, display: parameters!(@display $($display)?) }, )?
                                $( low: f64::from($low), high: f64::from($high), )?
                                $( nominal: $nominal, )?
                                ..ValueLimits::default()
                            }),
                            tunable: parameters!(@tunable $access),
                            text: $text,
                            read: |config: &$Config| RowValue::read(&config.$group.$field),
                            write: |config: &mut $Config, value| RowValue::write(&mut config.$group.$field, value),
                        },
                    )*)*];
                    rows.sort_by_key(|row| row.number);
                    rows
                })
            }
        }
    };
}
pub(crate) use parameters;

#[cfg(test)]
mod tests {
    use super::super::value::{Kind, Value, choice};
    use super::Level;

    choice! {
        /// A choice.
        pub enum Shape named "Shape", "Form of something" {
            Round = "round", "like a wheel";
            Flat = "flat", "like a rail";
        }
    }

    parameters! {
        /// A table of one row of every kind.
        pub struct Local {
            /// Fixed ones.
            head: Head fixed {
                7 basic profile: String = "cone".to_owned(), "Name of a profile";
                3 basic shape: Shape = Shape::Round, "Form of the head";
                5 expert count: usize = 2, from 1 to 4, "How many there are";
                4 basic on: bool = true, "Whether it is there";
                inside core: f64 = 1.5, "What only code sets";
            }
            /// One that may change.
            tuning: Tuned tunable {
                6 expert width: f64 = 0.07, of "head", in "m" as "mm", from -1.5 to 2.0, nominal 0.1, "Width of the head";
            }
        }
    }

    #[test]
    fn a_row_is_field_default_name_range_and_access() {
        let rows = Local::rows();
        let names: Vec<_> = rows.iter().map(|row| (row.number, row.name, row.tunable)).collect();
        let expected = [
            (3, "head.shape", false),
            (4, "head.on", false),
            (5, "head.count", false),
            (6, "head.width", true),
            (7, "head.profile", false),
        ];
        assert_eq!(names, expected);
        let basic: Vec<_> = rows.iter().filter(|row| row.level == Level::Basic).map(|row| row.number).collect();
        assert_eq!(basic, [3, 4, 7]);
        let local = Local::default();
        assert_eq!(Local::INSIDE, ["head.core"]);
        assert_eq!((local.head.profile.as_str(), local.head.core, local.tuning.width), ("cone", 1.5, 0.07));
        assert!(
            matches!(rows[3].kind, Kind::Real { min: -1.5, max: 2.0, nominal: 0.1, measure } if measure.unit == "m")
        );
        assert!(matches!(rows[2].kind, Kind::Integer { min: 1, max: 4 }));
    }

    #[test]
    fn texts_choices_counts_and_switches_are_read_and_written() {
        let mut local = Local::default();
        for (row, value) in Local::rows().iter().zip([
            Value::Integer(2),
            Value::Boolean(false),
            Value::Integer(4),
            Value::Real(1.0),
            Value::String("worn".to_owned()),
        ]) {
            assert_ne!((row.read)(&local), value);
            (row.write)(&mut local, &value);
            assert_eq!((row.read)(&local), value);
            assert_eq!(row.kind.check(row.name, &value), Ok(()));
        }
        assert_eq!((local.head.profile.as_str(), local.head.shape), ("worn", Shape::Flat));
        let profile = &Local::rows()[4];
        (profile.write)(&mut local, &Value::Real(1.0));
        assert_eq!(local.head.profile, "worn");
        assert!(profile.kind.check(profile.name, &Value::Real(1.0)).unwrap_err().contains("head.profile"));
    }
}
