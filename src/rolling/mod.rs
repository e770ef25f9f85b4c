//! Rolling: the deformable bodies, the contact between them and the rigid motion of the wheel, advanced in time.
//!
//! Everything in this room is per metre of width; [`outputs`] scales to the whole wheel. From the ground up:
//!
//! | file | content |
//! |---|---|
//! | [`state`], [`line`](mod@line), [`thermal_state`] | data of a restart: shared ones, those of a contact line, its temperatures |
//! | [`lines`] | sums, means and extremes over all lines |
//! | [`control`], [`error`], [`creepages`], `friction_law` | inputs; failures; speeds as ratios; the friction law of the parameters |
//! | [`support`], [`bodies`], [`rigid`], [`sideways`], [`wheelset`], [`patch_lines`], [`contact_model`], [`thermal`] | owners of one part each, gathered in [`model`] |
//! | [`brake`] | how the wheel is braked and held |
//! | [`flattening`], [`wear`], `spreading` | what yielding, friction and conduction across the width change in a step |
//! | [`step`] | one implicit step: predict, solve the contact, commit, audit, heat |
//! | [`stationary`], [`substeps`], `decisions`, [`audit`] | start state; division of communication steps, and by which decisions; energy balance |
//! | [`output_rows`], `output_table`, [`outputs`], `across`, [`profile`], [`suggested_step`], [`fields`], [`sensitivity`] | what one can ask of a state |

mod across;
pub mod audit;
pub mod bodies;
pub mod brake;
pub mod contact_model;
pub mod contact_step;
pub mod control;
pub mod creepages;
mod decisions;
pub mod direction;
pub mod elevation;
pub mod error;
pub mod fields;
pub mod flattening;
mod friction_law;
pub mod line;
pub mod lines;
pub mod load_to_come;
pub mod model;
pub mod output_rows;
mod output_table;
pub mod outputs;
pub mod patch_lines;
pub mod profile;
pub mod ramp;
pub mod rigid;
pub mod sensitivity;
pub mod sideways;
mod spreading;
pub mod standing;
pub mod state;
pub mod stationary;
mod step;
pub mod substeps;
pub mod suggested_step;
pub mod support;
pub mod thermal;
pub mod thermal_state;
pub mod wear;
pub mod wheelset;

pub use control::{Drive, InputError, Inputs, Lateral, Rotation, Translation, Vertical};
pub use error::{ModelError, StepError};
pub use line::Line;
pub use model::{RollingModel, Workspace};
pub use output_rows::{OutputRow, Outputs, Read};
pub use profile::{MOST_LINES, PROFILE_POINTS};
pub use sensitivity::{Difference, Origin};
pub use state::State;
