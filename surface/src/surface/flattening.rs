//! Depth that yielding and wear have taken off a surface.

use super::dents::Dents;
use super::worn::{WearIncrement, Worn};
use crate::piecewise::Piecewise;
use serde::{Deserialize, Serialize};

/// Dents and wear of the surface of a body, fixed to its material.
///
/// Positions `s` \[m] run along the material: `angle · r + x` on the wheel, `distance + x` on the rail.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Flattening {
    dents: Dents,
    worn: Worn,
}

impl Flattening {
    /// An undamaged surface: closed with a circumference \[m], or open with zero.
    pub fn none(circumference: f64) -> Self {
        Self { dents: Dents::none(circumference), worn: Worn::none(circumference) }
    }

    /// Absence of dents and wear.
    pub fn is_empty(&self) -> bool {
        self.dents.is_empty() && self.worn.is_empty()
    }

    /// Depth \[m] at the position `s` \[m].
    pub fn depth(&self, s: f64) -> f64 {
        self.dents.depth(s) + self.worn.depth(s)
    }

    /// Depth of the dents at the position `s` \[m].
    pub fn dent(&self, s: f64) -> f64 {
        self.dents.depth(s)
    }

    /// Largest depth of a dent \[m].
    pub fn deepest_dent(&self) -> f64 {
        self.dents.deepest()
    }

    /// Presence of dents.
    pub fn is_dented(&self) -> bool {
        !self.dents.is_empty()
    }

    /// Largest depth that dents, and that wear has taken off \[m].
    pub fn deepest(&self) -> f64 {
        self.dents.deepest().max(self.worn.deepest())
    }

    /// Positions \[m] of the deepest dent and of the most worn place.
    pub fn deepest_places(&self) -> impl Iterator<Item = f64> {
        self.dents.deepest_place().into_iter().chain(self.worn.deepest_place())
    }

    /// Depth that wear has taken off.
    pub fn worn(&self) -> &Worn {
        &self.worn
    }

    /// Adds the depth `added` over x \[m], not empty and zero outside its ends, to the dents of the material at
    /// `position` + x; a new dent has lattice points `spacing` \[m] apart.
    pub fn indent(&mut self, position: f64, added: &Piecewise, spacing: f64) {
        self.dents.add(position, added, spacing);
    }

    /// Takes off the wear of a step, on cells of about `spacing` \[m].
    pub fn wear(&mut self, increment: &WearIncrement, spacing: f64) {
        self.worn.remove(increment, spacing);
    }

    /// Forgets everything that lies farther than `reach` \[m] from the position `s` \[m].
    pub fn forget_beyond(&mut self, s: f64, reach: f64) {
        self.dents.forget_beyond(s, reach);
        self.worn.forget_beyond(s, reach);
    }

    /// Finiteness of all numbers, and sound lattices and cells.
    pub fn is_sound(&self) -> bool {
        self.dents.is_sound() && self.worn.is_sound()
    }
}
