//! Dents that yielding leaves in a surface, each on a lattice that is fixed to the material.

use crate::piecewise::Piecewise;
use serde::{Deserialize, Serialize};

/// Dents in the surface of a body.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Dents {
    dents: Vec<Dent>,
    /// Circumference of a wheel [m]; zero: the surface is open.
    circumference: f64,
}

/// One stretch of flattened surface.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Dent {
    /// Position of the first lattice point [m].
    first: f64,
    /// Distance of the lattice points [m].
    spacing: f64,
    /// Depth at the lattice points [m]; the surface is linear between them and undamaged beyond.
    depth: Vec<f64>,
}

/// Number to which small ones add without fractions: `1.5 · 2⁵²`.
const WHOLE: f64 = 6_755_399_441_055_744.0;

impl Dents {
    /// A surface without dents: closed with a circumference \[m], or open with zero.
    pub fn none(circumference: f64) -> Self {
        Self { dents: Vec::new(), circumference }
    }

    /// Absence of dents.
    pub fn is_empty(&self) -> bool {
        self.dents.is_empty()
    }

    /// Depth \[m] at the position `s` \[m].
    pub fn depth(&self, s: f64) -> f64 {
        self.dents.iter().map(|dent| dent.depth_at(s - dent.turns(s, self.circumference))).sum()
    }

    /// Largest depth \[m].
    pub fn deepest(&self) -> f64 {
        self.dents.iter().flat_map(|dent| &dent.depth).copied().fold(0.0, f64::max)
    }

    /// Position \[m] of the deepest lattice point of all dents.
    pub fn deepest_place(&self) -> Option<f64> {
        let points = self.dents.iter().flat_map(|dent| {
            dent.depth.iter().enumerate().map(|(k, depth)| [*depth, dent.first + k as f64 * dent.spacing])
        });
        points.max_by(|a, b| a[0].total_cmp(&b[0])).map(|[_, s]| s)
    }

    /// Adds the depth `added` over x \[m], not empty and zero outside its ends, to the material that lies at `position`
    /// + x.
    ///
    /// A depth that meets no dent starts one with lattice points `spacing` \[m] apart, some of them at the nodes of
    /// `added`.
    pub fn add(&mut self, position: f64, added: &Piecewise, spacing: f64) {
        let (Some(&low), Some(&high)) = (added.x.first(), added.x.last()) else { return };
        let circumference = self.circumference;
        let met = self.dents.iter_mut().find_map(|dent| {
            let shift = dent.turns(position + 0.5 * (low + high), circumference);
            let position = position - shift;
            (position + low <= dent.last() && position + high >= dent.first).then_some((dent, position))
        });
        match met {
            Some((dent, position)) => dent.add(position, added),
            None => {
                let mut dent = Dent { first: position + low, spacing, depth: Vec::new() };
                dent.add(position, added);
                self.dents.push(dent);
            }
        }
    }

    /// Forgets dents that lie farther than `reach` \[m] from the position `s` \[m].
    pub fn forget_beyond(&mut self, s: f64, reach: f64) {
        self.dents.retain(|dent| dent.last() > s - reach && dent.first < s + reach);
    }

    /// Finiteness of all numbers, and positive distances of all lattices.
    pub fn is_sound(&self) -> bool {
        self.circumference.is_finite() && self.dents.iter().all(Dent::is_sound)
    }
}

impl Dent {
    /// Position of the last lattice point [m].
    fn last(&self) -> f64 {
        self.first + self.spacing * self.depth.len().saturating_sub(1) as f64
    }

    /// Whole circumferences \[m] between the dent and the position `s`, so that `s` less them is the nearest one to the
    /// dent.
    fn turns(&self, s: f64, circumference: f64) -> f64 {
        if circumference == 0.0 {
            return 0.0;
        }
        let middle = 0.5 * (self.first + self.last());
        // The sum has no digits behind the point.
        circumference * ((s - middle) / circumference + WHOLE - WHOLE)
    }

    fn depth_at(&self, s: f64) -> f64 {
        let index = (s - self.first) / self.spacing;
        let last = self.depth.len() as f64 - 1.0;
        if index < -1.0 || index > last + 1.0 {
            return 0.0;
        }
        let (whole, share) = (index.floor(), index - index.floor());
        let depth = |k: f64| if k < 0.0 || k > last { 0.0 } else { self.depth[k as usize] };
        depth(whole) + share * (depth(whole + 1.0) - depth(whole))
    }

    /// Extends the lattice to the ends of `added` and adds it.
    fn add(&mut self, position: f64, added: &Piecewise) {
        let (Some(&low), Some(&high)) = (added.x.first(), added.x.last()) else { return };
        let ahead = ((self.first - (position + low)) / self.spacing - 1e-6).ceil().max(0.0) as usize;
        self.first -= ahead as f64 * self.spacing;
        self.depth.splice(0..0, std::iter::repeat_n(0.0, ahead));
        let needed = ((position + high - self.first) / self.spacing - 1e-6).ceil().max(0.0) as usize + 1;
        if self.depth.len() < needed {
            self.depth.resize(needed, 0.0);
        }
        for (k, depth) in self.depth.iter_mut().enumerate() {
            *depth += added.at(self.first + k as f64 * self.spacing - position);
        }
    }

    fn is_sound(&self) -> bool {
        self.first.is_finite() && self.spacing > 0.0 && self.depth.iter().all(|depth| depth.is_finite())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const H: f64 = 1e-3;

    fn hat(at: f64) -> Piecewise {
        Piecewise { x: vec![at - H, at, at + H], value: vec![0.0, 1e-5, 0.0] }
    }

    #[test]
    fn a_dent_stays_where_it_was_made_in_the_material() {
        let mut rail = Dents::none(0.0);
        rail.add(3.0, &hat(0.0), H);
        rail.add(3.0, &hat(0.0), H);
        assert!((rail.depth(3.0) - 2e-5).abs() < 1e-17 && (rail.depth(3.0 + 0.5 * H) - 1e-5).abs() < 1e-15);
        assert_eq!((rail.depth(3.0 + 2.5 * H), rail.depth(2.9), rail.dents.len()), (0.0, 0.0, 1));
        rail.add(3.0, &hat(2.0 * H), H);
        assert!((rail.depth(3.0 + 2.0 * H) - 1e-5).abs() < 1e-12 && (rail.depth(3.0) - 2e-5).abs() < 1e-12);
        assert_eq!(rail.dents.len(), 1);
        rail.forget_beyond(5.0, 1.0);
        assert!(rail.is_empty());
    }

    #[test]
    fn a_dent_comes_back_with_every_turn_of_the_wheel() {
        let mut wheel = Dents::none(2.0);
        wheel.add(0.1, &hat(0.0), H);
        for turns in [-3.0, 0.0, 5.0] {
            assert!((wheel.depth(0.1 + 2.0 * turns) - 1e-5).abs() < 1e-15);
            assert_eq!(wheel.depth(1.1 + 2.0 * turns), 0.0);
        }
        wheel.add(1.1 + 6.0, &hat(0.0), H);
        assert_eq!(wheel.dents.len(), 2);
        assert!((wheel.depth(1.1) - 1e-5).abs() < 1e-15 && (wheel.deepest() - 1e-5).abs() < 1e-20);
        wheel.add(0.1 + 4.0, &hat(0.0), H);
        assert!(wheel.dents.len() == 2 && (wheel.deepest() - 2e-5).abs() < 1e-15);
    }
}
