//! Transient wheel–rail rolling contact as a co-simulation FMU.
//!
//! A deformable wheel (annulus on a rigid hub) rolls on a deformable rail (plate on a fixed base): plane strain, linear
//! elasticity, inertia, exact Coulomb friction and heat, in a frame that moves with the wheel centre while the material
//! streams through it (arbitrary Lagrangian–Eulerian description). The model is that of A. Draganis, *Numerical
//! simulation of thermomechanically coupled transient rolling contact*, PhD thesis, Chalmers 2014, Papers A–D.
//!
//! # Units and signs
//!
//! SI everywhere. x points in travel direction, y up. Contact forces are those on the wheel: `F_x > 0` is traction.
//! Creepage is `ξ = 2 (V − rΩ)/(V + rΩ)`: braking positive, locked wheel 2. [`simulation`] speaks of the whole wheel,
//! [`rolling`] and below of one metre of width.
//!
//! # Map
//!
//! Equations and derivations are pages of their own under [`docs/theory`](../../../docs/theory/README.md); the map names
//! those that belong to a room.
//!
//! | room | content | theory |
//! |---|---|---|
//! | [`config`] | parameters and presets: plain data | |
//! | [`analytic`] | Hertz, Carter: start guesses and tests | |
//! | [`material`] | moduli, wave speeds, diffusivity: constants that follow from the parameters | |
//! | [`multistep`] | the time formula: derivative, history, impulse | [time-formula](../../../docs/theory/time-formula.md) |
//! | [`piecewise`] | piecewise linear functions: profiles, nodal values, inputs over time | |
//! | [`linalg`] | sparse factorisation, vibration modes | |
//! | [`fem`] | streamline-aligned graded meshes, elements, assembly | |
//! | [`mechanics`] | elasticity and convection; full and reduced bodies behind one interface | [ale-balance](../../../docs/theory/ale-balance.md), [condensation](../../../docs/theory/condensation.md), [damping](../../../docs/theory/damping.md) |
//! | [`heat`] | temperature of both bodies on boundary-layer meshes, modal direct solver | [heat](../../../docs/theory/heat.md) |
//! | [`contact`] | what a contact is for everyone else; exact Coulomb contact by an active set; friction laws | [contact](../../../docs/theory/contact.md), [edge-consistent-rows](../../../docs/theory/edge-consistent-rows.md), [kernel-correction](../../../docs/theory/kernel-correction.md) |
//! | [`rolling`] | stationary and transient rolling, mixed control, observables, energy audit | [lever-arms](../../../docs/theory/lever-arms.md), [friction-and-coupling](../../../docs/theory/friction-and-coupling.md) |
//! | [`simulation`] | façade: configuration → model → advance → outputs | |
//! | [`fmi`] | the FMI 2.0 co-simulation slave around it | |
//!
//! Imports run downward only; a test keeps it so.
#![deny(unsafe_code)]

pub mod analytic;
pub mod config;
pub mod contact;
pub mod fem;
pub mod fmi;
pub mod heat;
pub mod linalg;
pub mod material;
pub mod mechanics;
pub mod multistep;
pub mod piecewise;
pub mod rolling;
pub mod simulation;
