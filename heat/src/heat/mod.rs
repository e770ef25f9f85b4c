//! Temperature of wheel and rail: resolved under the contact, coupled, at any speed and step size.
//!
//! Both fields live on tensor meshes of their own (streamlines × depth), graded from the thermal boundary layer
//! `δ = √(2κa/V)` (tens of micrometres) to the size of the bodies. Everything is per metre of width; temperatures are
//! excess temperatures over the reference \[K]. Forward rolling is positive: at the contact the material of both bodies
//! flows towards −x.
//!
//! ```text
//! wheel    ρc (∂_t T − ω ∂_φ T) = k ΔT      hub: T = 0 or insulated; sources: q; tread: −h T
//! rail     ρc (∂_t T − V ∂_x T) = k ΔT      inflow: ρc|V|T − k ∂_n T = 0; outflow: k ∂_n T = 0; base insulated
//! contact  q → wheel = β γ_f |τ s| − k_c (T_w − T_r),   q → rail = (1 − β) γ_f |τ s| + k_c (T_w − T_r)
//! ```
//!
//! A. Draganis, PhD thesis, Chalmers 2014: Paper B, section 4 (energy balance in the moving frame), Paper C, section
//! 4.2 (conductance, friction heat). The tensor meshes with streamwise upwinding in every term replace its triangles.
//!
//! Limits:
//! - Line contact in the plane; distances along the surface stand for x in the contact zone (they differ by `x²/6r²`).
//! - Loads are held over a step, but for the friction power. The time formula is of second order under constant
//!   speeds and exchange; a run in which they vary is of first order in the step.
//! - A hot spot carried round the wheel is smeared where the mesh along the tread is coarse.
//! - Air has the reference temperature, and convection to it acts under the contact, too.

mod error;
mod exchange;
mod flows;
mod lateral;
mod limits;
mod melting;
mod model;
mod observation;
mod parameters;
mod state;
mod tensor;

pub use crate::piecewise::Interval;
pub use error::HeatError;
pub use exchange::{Exchange, HeatPlace, HeatSource};
pub use flows::HeatFlows;
pub use lateral::{LateralCells, LateralHistory, LateralMixing, MIXED_AT};
pub use limits::{LARGEST_STEP, SMALLEST_STEP};
pub use melting::Melting;
pub use model::{HeatLine, HeatModel};
pub use observation::{Observation, TemperatureField, Temperatures};
pub use parameters::{HeatMaterial, HeatParameters, Widths};
pub use state::HeatState;
pub use tensor::{Heat, HeatScratch, WheelStage};
