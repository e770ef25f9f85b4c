//! Displacement of lines by the tangential forces of all lines of a patch, as far as it is smooth on each line.

use super::contact::SeriesContact;
use super::series_line::SeriesLine;
use crate::contact::flexibility::{self, ByPowers};

impl SeriesContact<'_> {
    /// Gives all lines the fields of the present shear.
    pub fn exchange(&mut self) {
        for at in 0..self.lines.len() {
            let Some(patch) = self.lines[at].problem.line.patch else { continue };
            let [along, across] = patch.fields(self.lines.iter().map(|line| [line.powers[1], line.across.powers]));
            (self.lines[at].field, self.lines[at].across.field) = (along, across);
        }
    }

    /// Derivatives of the displacements of a line along and across by its size, while the forces stay where they are \[m].
    pub fn growth(&self, at: usize) -> [ByPowers; 2] {
        let Some(patch) = self.lines[at].problem.line.patch else { return Default::default() };
        let moments = self.lines.iter().map(|line| [line.powers[1], line.across.powers]);
        patch.flexibility.sums(patch.line, moments, |by| &by.growth)
    }
}

impl SeriesLine<'_> {
    /// Changes of the slip with displacement and strain of the field.
    pub fn slip_of_field(&self) -> [f64; 2] {
        let speed = self.rigid.travel + self.rim_velocity();
        flexibility::slip_of_field([self.problem.line.time.a0, speed], self.half_length)
    }
}
