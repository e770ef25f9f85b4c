//! Shapes of the surfaces of wheel and rail: how they are made, and how yielding and wear change them.
//!
//! The contact reads the [`Unevenness`](crate::contact::Unevenness) of a [`Placement`], behind which everything else of this
//! room stands:
//!
//! | file | content |
//! |---|---|
//! | [`profile`] | heights on top of circle and plane: files, waves, roughness, holes, joints, flats |
//! | `dents`, `worn` | depths that yielding and wear have taken off, fixed to the material |
//! | `flattening` | both together, as a state remembers them for each body |
//! | `flat` | length and depth of the deepest flat of the tread |
//! | `wear_law` | mass that friction wears off |
//! | `shape` | what is missing from circle and plane at x: profiles and flattening where the wheel stands |

mod dents;
mod flat;
mod flattening;
pub mod profile;
mod shape;
mod wear_law;
mod worn;

pub use flat::{Flat, TreadLevel};
pub use flattening::Flattening;
pub use profile::{Body, Profile, ProfileError, csv, longest_flat};
pub use shape::{Placement, SurfaceError, Surfaces};
pub use wear_law::WearLaw;
pub use worn::{WearIncrement, Worn};
