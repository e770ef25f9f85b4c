//! Axes of the rigid motion of the wheel: their names, their order and their number.
//!
//! Each axis has a generalised velocity and the force or moment that does work on it. Matrices have a row or a column for
//! every axis, in the order of [`Axis::ALL`].

use serde::{Deserialize, Serialize};
use std::ops::{Index, IndexMut};

/// Declares the axes: name of the quantity that belongs to one in a [`PerAxis`], name of the axis, documentation.
macro_rules! axes {
    ($($field:ident: $axis:ident, $doc:literal;)*) => {
        /// An axis of the rigid motion of the wheel.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum Axis {
            $(#[doc = $doc] $axis,)*
        }

        impl Axis {
            /// All of them, in their order.
            pub const ALL: [Self; Self::COUNT] = [$(Self::$axis),*];
            /// Their number.
            pub const COUNT: usize = [$(stringify!($axis)),*].len();
        }

        /// One value for each axis.
        #[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
        pub struct PerAxis<T> {
            $(#[doc = $doc] pub $field: T,)*
        }

        impl<T> PerAxis<T> {
            /// The values that a function has for the axes, in their order.
            #[inline]
            pub fn from_fn(mut of: impl FnMut(Axis) -> T) -> Self {
                Self { $($field: of(Axis::$axis)),* }
            }

            /// The values in the order of the axes.
            #[inline]
            pub fn values(self) -> [T; Axis::COUNT] {
                [$(self.$field),*]
            }
        }

        impl<T> Index<Axis> for PerAxis<T> {
            type Output = T;

            #[inline]
            fn index(&self, axis: Axis) -> &T {
                match axis {
                    $(Axis::$axis => &self.$field,)*
                }
            }
        }

        impl<T> IndexMut<Axis> for PerAxis<T> {
            #[inline]
            fn index_mut(&mut self, axis: Axis) -> &mut T {
                match axis {
                    $(Axis::$axis => &mut self.$field,)*
                }
            }
        }
    };
}

axes! {
    travel: Travel, "Travel of the wheel along the rail: velocity V [m/s], force in x [N/m].";
    height: Height, "Height of the hub: U \\[m], its velocity U̇ [m/s], force in y [N/m].";
    rotation: Rotation, "Rotation about the axle: angular velocity Ω, forward positive [rad/s], forward moment \\[N].";
    lateral: Lateral, "Travel of the wheel across the rail, to the right: velocity V_z [m/s], force in z [N/m].";
}

impl Axis {
    /// Number of the row or column of a matrix that belongs to it.
    #[inline]
    pub fn number(self) -> usize {
        self as usize
    }

    /// Axes along the surfaces, in their order.
    #[inline]
    pub fn along() -> impl Iterator<Item = Self> + Clone {
        Self::ALL.into_iter().filter(|axis| *axis != Self::Height)
    }

    /// Force or moment of the axis that counts as much as a unit of force at a rim of this `radius` \[m].
    #[inline]
    pub fn arm(self, radius: f64) -> f64 {
        match self {
            Self::Travel | Self::Height | Self::Lateral => 1.0,
            Self::Rotation => radius,
        }
    }
}

impl<T: Copy> PerAxis<T> {
    /// A function of every value.
    #[inline]
    pub fn map<U>(self, mut of: impl FnMut(T) -> U) -> PerAxis<U> {
        PerAxis::from_fn(|axis| of(self[axis]))
    }

    /// The axes with their values, in their order.
    #[inline]
    pub fn iter(self) -> impl Iterator<Item = (Axis, T)> {
        Axis::ALL.into_iter().map(move |axis| (axis, self[axis]))
    }
}

impl PerAxis<f64> {
    /// Sum of the products with other values, such as the power of forces.
    #[inline]
    pub fn dot(self, other: Self) -> f64 {
        self.iter().map(|(axis, value)| value * other[axis]).sum()
    }

    /// Adds a multiple of other values.
    #[inline]
    pub fn add(&mut self, factor: f64, other: Self) {
        other.iter().for_each(|(axis, value)| self[axis] += factor * value);
    }

    /// One on an axis, zero on all others.
    #[inline]
    pub fn unit(axis: Axis) -> Self {
        Self::from_fn(|other| if other == axis { 1.0 } else { 0.0 })
    }
}
