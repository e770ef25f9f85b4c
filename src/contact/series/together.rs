//! Linear problem of all lines together: shear of the stretches that stick, and the motions that are not prescribed.

use super::contact::SeriesContact;
use super::equations::{Coefficients, ROOM, eliminate};
use super::stretch::{SHARED, Stretch};
use crate::contact::error::ContactError;
use crate::linalg::POINTS;

/// Equations of the shared unknowns, by unknown, and their right-hand side.
type SharedEquations = [Coefficients; SHARED + 1];

impl SeriesContact<'_> {
    /// Solves for the shear of stretches of the half-lengths `halves` \[m] that stick from the leading edges on
    /// (`None`: nothing sticks on this line), and for the motions that are not prescribed. Writes the strengths of the
    /// roots at the ends where slip begins to `roots` \[Pa].
    pub fn stick(&mut self, halves: &[Option<f64>], roots: &mut [f64]) -> Result<(), ContactError> {
        self.lines.iter_mut().zip(halves).for_each(|(line, half)| line.begin_stretch(*half));
        let surface = self.surface();
        let axes = self.free_axes();
        let mut stretches: Vec<Option<Stretch>> = Vec::with_capacity(self.lines.len());
        for (line, half) in self.lines.iter().zip(halves) {
            stretches.push(half.map(|_| line.stretch(&surface, axes.clone())).transpose()?);
        }
        let shared = self.share(&stretches)?;
        for axis in axes {
            self.speed_up(axis, shared[POINTS + axis / 2]);
        }
        for ((line, stretch), root) in self.lines.iter_mut().zip(&stretches).zip(roots) {
            *root = stretch.as_ref().map_or(0.0, |stretch| line.take(&stretch.tractions(&shared)));
            line.place_shear();
        }
        self.displace();
        Ok(())
    }

    /// Finds the motions that are not prescribed where nothing sticks.
    pub fn glide(&mut self) -> Result<(), ContactError> {
        for line in &mut self.lines {
            line.begin_stretch(None);
            line.place_shear();
        }
        self.displace();
        if self.free_axes().next().is_none() {
            return Ok(());
        }
        let shared = self.share(&[])?;
        for axis in self.free_axes() {
            self.speed_up(axis, shared[POINTS + axis / 2]);
        }
        self.displace();
        Ok(())
    }

    /// Shared unknowns: the moments of the shear of all stretches, and the changes of V and Ω.
    fn share(&self, stretches: &[Option<Stretch>]) -> Result<[f64; SHARED], ContactError> {
        let mut columns: SharedEquations = [[0.0; ROOM]; SHARED + 1];
        let mut forces = [0.0; 1 + SHARED];
        (0..SHARED).for_each(|k| columns[k][k] = 1.0);
        for (line, stretch) in self.lines.iter().zip(stretches) {
            let (Some(stretch), share) = (stretch, line.problem.line.share) else { continue };
            let [known, by_shared @ ..] = stretch.moments();
            (0..POINTS).for_each(|l| columns[SHARED][l] += share * known[l]);
            for (column, moments) in columns.iter_mut().zip(by_shared) {
                (0..POINTS).for_each(|l| column[l] += share * moments[l]);
            }
            forces.iter_mut().zip(stretch.forces()).for_each(|(sum, force)| *sum += share * force);
        }
        self.write_balances(&mut columns, &forces);
        if !eliminate(&mut columns, SHARED) {
            return Err(ContactError::Unsuited { reason: "the lines have no common solution" });
        }
        Ok(std::array::from_fn(|k| columns[SHARED][k]))
    }

    /// Writes the balances of the motions that are not prescribed; `forces` are those of the stretches without shared
    /// unknowns, and what a unit of each takes away.
    fn write_balances(&self, columns: &mut SharedEquations, forces: &[f64; 1 + SHARED]) {
        let (bodies, radius) = (self.bodies(), self.lines[0].problem.line.radius());
        // Of friction alone: the stretches have no shear yet.
        let resultant = self.resultant();
        for axis in self.free_axes() {
            let (row, arm) = (POINTS + axis / 2, if axis == 0 { 1.0 } else { -radius });
            for (l, column) in columns[..POINTS].iter_mut().enumerate() {
                column[row] = bodies.momentum[(axis, 2 * l)];
            }
            for (column, force) in columns.iter_mut().zip(&forces[1..]) {
                column[row] += arm * force;
            }
            for other in self.free_axes() {
                let column = &mut columns[POINTS + other / 2];
                let change = self.inertia(axis, other) * self.rigid[other].gain;
                // The equation of an axis that is prescribed says that it does not change.
                column[row] += change - if axis == other { 1.0 } else { 0.0 };
            }
            columns[SHARED][row] = arm * forces[0] - self.unbalance(axis, resultant);
        }
    }
}
