//! Lines that do not touch: a wheel in the air keeps its points, without tractions.

use super::chebyshev::{Arch, TERMS};
use super::contact::SeriesContact;
use super::points::COUNT;
use super::series_line::SeriesLine;
use crate::axes::Axis;
use crate::contact::error::ContactError;

/// Rounds in which motions and the places next to each other settle: all is linear but for the places.
const ROUNDS: usize = 4;

/// Finds the motions without contact forces; true if no line touches then.
pub fn solve(contact: &mut SeriesContact) -> Result<bool, ContactError> {
    contact.lines.iter_mut().for_each(SeriesLine::begin_anew);
    contact.lines.iter_mut().for_each(SeriesLine::open);
    contact.displace();
    for _ in 0..ROUNDS {
        contact.share(&[])?;
        contact.rise();
        contact.displace();
        contact.lines.iter_mut().for_each(SeriesLine::approach);
    }
    for line in &mut contact.lines {
        line.slips = Default::default();
        line.across.slips = Default::default();
    }
    contact.exchange();
    Ok(contact.lines.iter().all(|line| line.middle_gap().gap >= 0.0))
}

impl SeriesContact<'_> {
    /// Gives the hub the height of its balance without contact forces.
    fn rise(&mut self) {
        let motion = &self.rigid.height;
        let height = match motion.target() {
            Some(target) => target,
            None => {
                let inertia = motion.gain * self.inertia(Axis::Height, Axis::Height);
                self.lines[0].rigid.height - self.unbalance(Axis::Height, 0.0) / inertia
            }
        };
        self.lines.iter_mut().for_each(|line| line.rigid.height = height);
    }
}

impl SeriesLine<'_> {
    /// Takes all tractions away.
    fn open(&mut self) {
        let none = Arch { count: COUNT, terms: [0.0; TERMS], ..self.tractions.pressure };
        let tractions = &mut self.tractions;
        (tractions.pressure, tractions.stick, tractions.lateral, tractions.slide) = (none, none, none, 0.0);
        tractions.directions = Some([1; COUNT]);
        self.across.powers = Default::default();
        self.place_pressure();
        self.place_shear();
    }

    /// Moves the places to where the surfaces come next to each other.
    fn approach(&mut self) {
        let half = self.tractions.pressure.half_width;
        if let Ok(shift) = self.shape_pressure() {
            self.tractions.pressure.centre += shift.clamp(-half, half);
        }
        self.open();
    }
}
