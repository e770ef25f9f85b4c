//! Numbers with their derivatives: contact forces are written once, and their tangents follow.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// Variables of a contact element: slave node, the node upstream of it, both ends of the master segment, ω and V.
pub const VARIABLES: usize = 10;

/// A number and its derivatives by the variables.
#[derive(Clone, Copy, Debug)]
pub struct Dual {
    /// The number.
    pub value: f64,
    /// Its derivatives.
    pub slopes: [f64; VARIABLES],
}

impl Dual {
    /// A constant.
    pub fn constant(value: f64) -> Self {
        Self { value, slopes: [0.0; VARIABLES] }
    }

    /// Variable number `i`.
    pub fn variable(value: f64, i: usize) -> Self {
        let mut dual = Self::constant(value);
        dual.slopes[i] = 1.0;
        dual
    }

    /// A function of it with the given value and slope there.
    fn chain(self, value: f64, slope: f64) -> Self {
        Self { value, slopes: self.slopes.map(|s| slope * s) }
    }

    /// Square root.
    pub fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        self.chain(root, 0.5 / root)
    }

    /// Hyperbolic tangent.
    pub fn tanh(self) -> Self {
        let value = self.value.tanh();
        self.chain(value, self.value.cosh().powi(-2))
    }
}

impl Add for Dual {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self { value: self.value + other.value, slopes: std::array::from_fn(|i| self.slopes[i] + other.slopes[i]) }
    }
}

impl Neg for Dual {
    type Output = Self;
    fn neg(self) -> Self {
        self.chain(-self.value, -1.0)
    }
}

impl Sub for Dual {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Dual {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        // The product rule: half of the product from each side carries its value.
        let half = 0.5 * self.value * other.value;
        self.chain(half, other.value).add(other.chain(half, self.value))
    }
}

impl Div for Dual {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        self * other.chain(1.0 / other.value, -1.0 / (other.value * other.value))
    }
}
