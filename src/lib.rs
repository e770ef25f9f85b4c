//! Transient wheel–rail rolling contact as a co-simulation FMU.
//!
//! A deformable wheel (annulus on a rigid hub) rolls on a deformable rail (plate on a fixed base): plane strain, linear
//! elasticity, inertia, exact Coulomb friction and heat, in a frame that moves with the wheel centre while the material
//! streams through it (arbitrary Lagrangian–Eulerian description). The model is that of A. Draganis, *Numerical
//! simulation of thermomechanically coupled transient rolling contact*, PhD thesis, Chalmers 2014, Papers A–D.
//!
//! # Equations
//!
//! With the stream derivative `∂` (`−∂_φ` in the wheel, `−∂_x` in the rail), displacement `u` relative to hub or base,
//! and wheel speed `V`, angular velocity `Ω` (forward rolling positive), hub height `U`, Paper D, eq. 9 reads
//!
//! ```text
//! wheel  ρ(ü + 2Ω ∂u̇ + Ω̇ ∂u + Ω² ∂²u) = div σ − ρ(V̇ e_x + Ü e_y + Ω̇ (y, −x) − Ω² X)
//! rail   ρ(ü + 2V ∂u̇ + V̇ ∂u + V² ∂²u) = div σ
//! gap    g = r − √(r² − x²) + u_y,wheel + U − u_y,rail ≥ 0,   λ_n ≥ 0,   g λ_n = 0
//! slip   s = V (1 + ∂_x u_rail) − rΩ (1 + ∂_x u_wheel) + d_t(u_wheel − u_rail),   |λ_t| ≤ μ λ_n,   λ_t ∥ −s
//! heat   ρc (Ṫ + Ω ∂T) = k ΔT (rail: V),  q → body = share of γ_f |λ_t s| ∓ k_c (T_wheel − T_rail)
//! hub    m V̇ + d_t p_x = F + Σλ_t,   I Ω̇ + d_t p_Ω = M − Σ(r λ_t + x λ_n),   m_y Ü + d_t p_y = Σλ_n − load
//! ```
//!
//! where `p` is the momentum of the deformation. Of each pair (moment, Ω), (force, V), (load, U) one partner is
//! prescribed and the other is a reaction.
//!
//! # Units and signs
//!
//! SI everywhere. x points in travel direction, y up. Contact forces are those on the wheel: `F_x > 0` is traction.
//! Creepage is `ξ = 2 (V − rΩ)/(V + rΩ)`: braking positive, locked wheel 2. [`simulation`] speaks of the whole wheel,
//! [`rolling`] and below of one metre of width.
//!
//! # Map
//!
//! | room | content |
//! |---|---|
//! | [`config`] | parameters and presets: plain data |
//! | [`analytic`] | Hertz, Carter: start guesses and tests |
//! | [`material`] | moduli, wave speeds, diffusivity: constants that follow from the parameters |
//! | [`multistep`] | the time formula: derivative, history, impulse |
//! | [`piecewise`] | piecewise linear functions: profiles, nodal values, inputs over time |
//! | [`linalg`] | sparse factorisation, vibration modes |
//! | [`fem`] | streamline-aligned graded meshes, elements, assembly |
//! | [`mechanics`] | elasticity and convection; full and reduced bodies behind one interface |
//! | [`heat`] | temperature of both bodies on boundary-layer meshes, modal direct solver |
//! | [`contact`] | exact Coulomb contact by an active set, on a grid of paired nodes |
//! | [`rolling`] | stationary and transient rolling, mixed control, observables, energy audit |
//! | [`simulation`] | façade: configuration → model → advance → outputs |
//! | [`fmi`] | the FMI 2.0 co-simulation slave around it |
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
