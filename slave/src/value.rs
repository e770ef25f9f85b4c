//! Value references, and values as they cross the interface.

/// Value reference of a variable.
pub type Reference = u32;

/// Types of FMI 2.0. Items of an enumeration are integers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Type {
    /// `fmi2Real`.
    Real,
    /// `fmi2Integer`.
    Integer,
    /// `fmi2Boolean`.
    Boolean,
    /// `fmi2String`.
    String,
}

impl Type {
    /// All types.
    pub const ALL: [Type; 4] = [Type::Real, Type::Integer, Type::Boolean, Type::String];
}

/// Types of FMI 3.0 that variables have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ElementType {
    /// `fmi3Float64`.
    Float64,
    /// `fmi3Int32`.
    Int32,
    /// `fmi3Int64`: the number of an item of an enumeration.
    Int64,
    /// `fmi3Boolean`.
    Boolean,
    /// `fmi3String`.
    String,
}

/// Value of a scalar variable, or of an element of an array.
#[derive(Clone, Debug, PartialEq)]
pub enum Scalar {
    /// `fmi2Real`.
    Real(f64),
    /// `fmi2Integer`.
    Integer(i32),
    /// `fmi2Boolean`.
    Boolean(bool),
    /// `fmi2String`.
    String(String),
}

impl Scalar {
    /// Type of the value.
    pub fn of(&self) -> Type {
        match self {
            Scalar::Real(_) => Type::Real,
            Scalar::Integer(_) => Type::Integer,
            Scalar::Boolean(_) => Type::Boolean,
            Scalar::String(_) => Type::String,
        }
    }
}
