//! The macro that makes the struct of outputs and their rows from the table in [`super::output_rows`].

/// Defines the outputs. A row has number, field, sort, name and meaning. Between the last two may stand: `in`, the SI
/// unit, and `as`, the unit in which people like to read it; `from … to`, the range; `nominal`, the usual size; and
/// `start zero` for what is zero at the start by definition.
macro_rules! outputs {
    (@type real) => { f64 };
    (@type count) => { u64 };
    (@type flag) => { bool };
    (@type profile) => { Vec<f64> };
    (@type deferred) => { Vec<f64> };
    (@type lines) => { Vec<f64> };
    (@mark real) => { 1.0 };
    (@mark count) => { 1 };
    (@mark flag) => { true };
    (@mark $several:ident) => { vec![1.0] };
    (@read real $field:ident) => { Read::Real(|outputs| outputs.$field) };
    (@read count $field:ident) => { Read::Count(|outputs| outputs.$field) };
    (@read flag $field:ident) => { Read::Flag(|outputs| outputs.$field) };
    (@read profile $field:ident) => { Read::Profile(|outputs| &outputs.$field) };
    (@read deferred $field:ident) => { Read::Deferred(|outputs| &outputs.$field) };
    (@read lines $field:ident) => { Read::Profile(|outputs| &outputs.$field) };
    (@points profile $name:literal $text:literal) => { points!($name, $text) };
    (@points deferred $name:literal $text:literal) => { points!($name, $text) };
    (@points lines $name:literal $text:literal) => { points!(lines $name, $text) };
    (@points $sort:ident $name:literal $text:literal) => { &[] };
    (@measure) => { Measure { unit: "1", display: None } };
    (@measure $unit:literal) => { Measure { unit: $unit, display: None } };
    (@measure $unit:literal $display:literal) => { Measure { unit: $unit, display: Some($display) } };
    (@or $default:expr) => { $default };
    (@or $default:expr, $value:literal) => { $value };
    (@zero) => { false };
    (@zero zero) => { true };
    (
        $(
            $number:literal $field:ident: $sort:ident $name:literal
                $(, in $unit:literal $(as $display:literal)?)?
                $(, from $low:literal $(to $high:literal)?)?
                $(, nominal $nominal:literal)?
                $(, start $zero:ident)?
                , $text:literal;
        )*
    ) => {
        /// Everything the model returns at a communication point.
        #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
        pub struct Outputs {
            $( #[doc = concat!($text, $(" \\[", $unit, "]",)? ".")] pub $field: outputs!(@type $sort), )*
        }

        impl Outputs {
            /// Outputs none of which is what its default is.
            #[cfg(test)]
            pub fn marked() -> Self {
                Self { $( $field: outputs!(@mark $sort) ),* }
            }

            /// The row of every output.
            pub const ROWS: [OutputRow; [$( $number ),*].len()] = [$(
                OutputRow {
                    number: $number,
                    name: $name,
                    measure: outputs!(@measure $($unit $($display)?)?),
                    low: outputs!(@or f64::NEG_INFINITY $(, $low)?),
                    high: outputs!(@or f64::INFINITY $($(, $high)?)?),
                    nominal: outputs!(@or 1.0 $(, $nominal)?),
                    starts_at_zero: outputs!(@zero $($zero)?),
                    text: $text,
                    read: outputs!(@read $sort $field),
                    points: outputs!(@points $sort $name $text),
                },
            )*];
        }
    };
}
pub(super) use outputs;
