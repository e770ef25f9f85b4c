//! Transient wheel–rail rolling contact as a co-simulation FMU.
//!
//! A deformable wheel (annulus on a rigid hub) rolls on a deformable rail (plate on a fixed base): plane strain, linear
//! elasticity, inertia, exact Coulomb friction and heat, in a frame that moves with the wheel centre while the material
//! streams through it (arbitrary Lagrangian–Eulerian description). The model is that of A. Draganis, *Numerical
//! simulation of thermomechanically coupled transient rolling contact*, PhD thesis, Chalmers 2014, Papers A–D.
//!
//! # Notation, units and signs
//!
//! SI everywhere. x points in travel direction, y up. Contact forces are those on the wheel: `F_x > 0` is traction.
//!
//! | symbol | name in the code | unit per metre of width | of the whole wheel | sign |
//! |---|---|---|---|---|
//! | `V` | `velocity` | m/s | m/s | travel in x |
//! | `Ω` | `omega` | rad/s | rad/s | forward rolling; the thesis counts the other way round |
//! | `U` | `height` | m | m | up, zero where the undeformed bodies just touch |
//! | `u` | `displacement` | m | | relative to the rigid hub (wheel) or the base (rail) |
//! | `λ_n`, `λ_t` | `port_forces` | N/m | | on the wheel: up, forward |
//! | `F_x`, `F_y` | `resultant`, `contact_force_*` | N/m | N | on the wheel: forward, up |
//! | moment | `resultant`, `hub`, `*_moment` | N | N m | forward |
//! | mass, moment of inertia | `inertia` | kg/m, kg m | kg, kg m² | |
//! | energy, power | `energy`, `*_power` | J/m, W/m | J, W | |
//! | `p`, `τ` | `pressure`, `shear` | Pa | Pa | pressing; on the wheel forward |
//! | `s` | `slip` | m/s | m/s | wheel surface relative to the rail's, forward |
//! | `ξ = 2 (V − rΩ)/(V + rΩ)` | `creepage` | 1 | 1 | braking; locked wheel 2 |
//! | `T` | `temperature_*` | K over the reference | K absolute | |
//!
//! [`simulation`], [`config`] and [`fmi`] speak of the whole wheel, [`rolling`] and the rooms below it of one metre of
//! width; [`rolling::outputs`] and [`rolling::rigid`] convert.
//!
//! # Map
//!
//! Equations and derivations are pages of their own under [`docs/theory`](../../../docs/theory/README.md); the map
//! names those that belong to a room. Imports run downward only, from the end of this table to its beginning; a test
//! keeps it so.
//!
//! | room | content | theory |
//! |---|---|---|
//! | [`config`] | parameters, units and presets: a [`config::table`] of one row each | |
//! | [`analytic`] | Hertz, Carter and other closed forms: start guesses and tests | |
//! | [`patch`] | closed forms of the elliptical patch and of the lines that stand for it | [lines] |
//! | [`material`] | moduli, wave speeds, diffusivity: constants that follow from the parameters | |
//! | [`axes`] | axes of the rigid motion of the wheel, and what has a value for each | |
//! | [`multistep`] | the time formula: derivative, history, impulse | [time-formula] |
//! | [`piecewise`] | piecewise linear functions: profiles, nodal values, inputs over time | |
//! | [`lru`] | what is expensive to compute, kept for the steps that share it | |
//! | [`files`] | reading of regular files of bounded size | |
//! | [`display`] | numbers, their ranges and names like a misspelt one in messages | |
//! | [`linalg`] | sparse factorisation, vibration modes, GMRES | |
//! | [`fem`] | streamline-aligned graded meshes, elements, assembly | |
//! | [`mechanics`] | bodies: [`mechanics::BodyResponse`] | [ale-balance], [condensation], [damping], [rail-ends] |
//! | [`heat`] | temperature of both bodies behind [`heat::HeatModel`]: boundary-layer meshes, direct solver | [heat] |
//! | [`surface`] | shapes of both surfaces: files, waves, roughness, holes, joints, flats; dents; wear | [profiles] |
//! | [`contact`] | Coulomb contact; friction laws | [contact] |
//! | [`damage`] | history of hot places of the tread, structure of the steel | [material-history] |
//! | [`rolling`] | steady and transient rolling, control, outputs, audit | [lever-arms], [friction-and-coupling] |
//! | [`simulation`] | façade: configuration → shared model → advance → outputs; stored bases, advice | |
//! | [`wheels`] | many of them, stepped side by side on all cores | |
//! | [`fmi`] | the FMI 2.0 co-simulation slave around it | |
//!
//! The archive is made by the crate `wheelrail-pack`. How to add to a room: `CONTRIBUTING.md`.
//!
//! [ale-balance]: ../../../docs/theory/ale-balance.md
//! [condensation]: ../../../docs/theory/condensation.md
//! [contact]: ../../../docs/theory/contact.md
//! [damping]: ../../../docs/theory/damping.md
//! [friction-and-coupling]: ../../../docs/theory/friction-and-coupling.md
//! [heat]: ../../../docs/theory/heat.md
//! [lever-arms]: ../../../docs/theory/lever-arms.md
//! [material-history]: ../../../docs/theory/material-history.md
//! [lines]: ../../../docs/theory/lines.md
//! [profiles]: ../../../docs/theory/profiles.md
//! [rail-ends]: ../../../docs/theory/rail-ends.md
//! [time-formula]: ../../../docs/theory/time-formula.md
#![deny(unsafe_code)]
#![warn(missing_docs)]

pub mod config;
pub mod fmi;
pub mod rolling;
pub mod simulation;
pub mod wheels;

pub use wheelrail_bodies::{material, mechanics};
pub use wheelrail_contact::{contact, patch};
pub use wheelrail_heat::{damage, heat};
pub use wheelrail_numerics::{analytic, axes, display, fem, linalg, lru, multistep, piecewise};
pub use wheelrail_surface::{files, surface};
