//! Friction along, or along and across, under given pressures, wherever the shear of a line stands.
//!
//! [`law`] has the law of one line and says what it asks of a shear, [`linear`] makes it linear for all lines and free
//! motions together, [`newton`] goes from linear law to linear law. What lines are, and how their slips follow from their
//! shear, is the matter of the solver that asks.

mod law;
mod linear;
mod newton;

pub(super) use law::{ByDirection, ConeProblem, ConeVerdict, Polynomials, SlipRows};
pub(super) use linear::{ByPolynomials, FreeMotion, Linearised, TangentialCoupling};
pub(super) use newton::Newton;
