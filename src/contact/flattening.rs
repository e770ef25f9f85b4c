//! What a surface has lost to yield and wear: where it lies on the material, and how deep it is.

use super::worn::{Loss, Worn};
use crate::piecewise::Piecewise;
use serde::{Deserialize, Serialize};

/// Dents in the surface of a body, each on a lattice of its own that is fixed to the material, and what is worn off.
///
/// Positions `s` \[m] run along the material: `angle · r + x` on the wheel, `distance + x` on the rail.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Flattening {
    dents: Vec<Dent>,
    /// Circumference of a wheel \[m]; zero: the surface is open.
    circumference: f64,
    /// What wear has taken off.
    worn: Worn,
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

impl Flattening {
    /// An undamaged surface: closed with a circumference \[m], or open with zero.
    pub fn none(circumference: f64) -> Self {
        Self { dents: Vec::new(), circumference, worn: Worn::none(circumference) }
    }

    /// Whether the surface is undamaged.
    pub fn is_empty(&self) -> bool {
        self.dents.is_empty() && self.worn.is_empty()
    }

    /// Number of dents.
    pub fn len(&self) -> usize {
        self.dents.len()
    }

    /// Depth \[m] at the position `s` \[m].
    pub fn depth(&self, s: f64) -> f64 {
        self.dents.iter().map(|dent| dent.at(self.nearest(s, dent))).sum::<f64>() + self.worn.depth(s)
    }

    /// What wear has taken off.
    pub fn worn(&self) -> &Worn {
        &self.worn
    }

    /// Takes off the wear of a step, on cells of about `spacing` \[m].
    pub fn wear(&mut self, loss: &Loss, spacing: f64) {
        self.worn.take(loss, spacing);
    }

    /// Largest depth of a dent \[m].
    pub fn deepest(&self) -> f64 {
        self.dents.iter().flat_map(|dent| &dent.depth).copied().fold(0.0, f64::max)
    }

    /// Presses the depth `by` over x \[m], not empty and zero outside its ends, into the material that lies at `place` + x.
    ///
    /// What meets no dent starts one with lattice points `spacing` \[m] apart, some of them at the nodes of `by`.
    pub fn press(&mut self, place: f64, by: &Piecewise, spacing: f64) {
        let (Some(&low), Some(&high)) = (by.x.first(), by.x.last()) else { return };
        let circumference = self.circumference;
        let met = self.dents.iter_mut().find_map(|dent| {
            let shift = dent.turns(place + 0.5 * (low + high), circumference);
            let place = place - shift;
            (place + low <= dent.last() && place + high >= dent.first).then_some((dent, place))
        });
        match met {
            Some((dent, place)) => dent.press(place, by),
            None => {
                let mut dent = Dent { first: place + low, spacing, depth: Vec::new() };
                dent.press(place, by);
                self.dents.push(dent);
            }
        }
    }

    /// Forgets what lies farther than `reach` \[m] from the position `s` \[m].
    pub fn forget_beyond(&mut self, s: f64, reach: f64) {
        self.dents.retain(|dent| dent.last() > s - reach && dent.first < s + reach);
        self.worn.forget_beyond(s, reach);
    }

    /// The position `s` in the turn of the wheel that is nearest to a dent.
    fn nearest(&self, s: f64, dent: &Dent) -> f64 {
        s - dent.turns(s, self.circumference)
    }

    /// Whether all numbers are finite and the lattices are sound.
    pub fn is_sound(&self) -> bool {
        self.circumference.is_finite() && self.dents.iter().all(Dent::is_sound) && self.worn.is_sound()
    }
}

impl Dent {
    /// Position of the last lattice point [m].
    fn last(&self) -> f64 {
        self.first + self.spacing * self.depth.len().saturating_sub(1) as f64
    }

    /// Whole turns [m] from the dent's own to that in which the position `s` is.
    fn turns(&self, s: f64, circumference: f64) -> f64 {
        if circumference == 0.0 {
            return 0.0;
        }
        let middle = 0.5 * (self.first + self.last());
        circumference * ((s - middle) / circumference).round()
    }

    fn at(&self, s: f64) -> f64 {
        let place = (s - self.first) / self.spacing;
        let last = self.depth.len() as f64 - 1.0;
        if place < -1.0 || place > last + 1.0 {
            return 0.0;
        }
        let (whole, share) = (place.floor(), place - place.floor());
        let depth = |k: f64| if k < 0.0 || k > last { 0.0 } else { self.depth[k as usize] };
        depth(whole) + share * (depth(whole + 1.0) - depth(whole))
    }

    /// Grows the lattice to the ends of `by` and adds it.
    fn press(&mut self, place: f64, by: &Piecewise) {
        let (Some(&low), Some(&high)) = (by.x.first(), by.x.last()) else { return };
        let ahead = ((self.first - (place + low)) / self.spacing - 1e-6).ceil().max(0.0) as usize;
        self.first -= ahead as f64 * self.spacing;
        self.depth.splice(0..0, std::iter::repeat_n(0.0, ahead));
        let needed = ((place + high - self.first) / self.spacing - 1e-6).ceil().max(0.0) as usize + 1;
        if self.depth.len() < needed {
            self.depth.resize(needed, 0.0);
        }
        for (k, depth) in self.depth.iter_mut().enumerate() {
            *depth += by.at(self.first + k as f64 * self.spacing - place);
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
    fn what_is_pressed_in_stays_where_it_was_pressed_in() {
        let mut rail = Flattening::none(0.0);
        rail.press(3.0, &hat(0.0), H);
        rail.press(3.0, &hat(0.0), H);
        assert!((rail.depth(3.0) - 2e-5).abs() < 1e-17 && (rail.depth(3.0 + 0.5 * H) - 1e-5).abs() < 1e-15);
        assert_eq!((rail.depth(3.0 + 2.5 * H), rail.depth(2.9), rail.len()), (0.0, 0.0, 1));
        rail.press(3.0, &hat(2.0 * H), H);
        assert!((rail.depth(3.0 + 2.0 * H) - 1e-5).abs() < 1e-12 && (rail.depth(3.0) - 2e-5).abs() < 1e-12);
        assert_eq!(rail.len(), 1);
        rail.forget_beyond(5.0, 1.0);
        assert!(rail.is_empty());
    }

    #[test]
    fn a_flat_comes_back_with_every_turn_of_the_wheel() {
        let mut wheel = Flattening::none(2.0);
        wheel.press(0.1, &hat(0.0), H);
        for turns in [-3.0, 0.0, 5.0] {
            assert!((wheel.depth(0.1 + 2.0 * turns) - 1e-5).abs() < 1e-15);
            assert_eq!(wheel.depth(1.1 + 2.0 * turns), 0.0);
        }
        wheel.press(1.1 + 6.0, &hat(0.0), H);
        assert_eq!(wheel.len(), 2);
        assert!((wheel.depth(1.1) - 1e-5).abs() < 1e-15 && (wheel.deepest() - 1e-5).abs() < 1e-20);
        wheel.press(0.1 + 4.0, &hat(0.0), H);
        assert!(wheel.len() == 2 && (wheel.deepest() - 2e-5).abs() < 1e-15);
    }
}
