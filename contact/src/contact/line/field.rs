//! Displacements of a line along and across, of which those of all lines of its patch are polynomials.

use super::contact_line::{ContactLine, LineIterate};
use crate::contact::flexibility::{ByPowers, at, slip_of_field};
use crate::contact::problem::LineProblem;
use crate::linalg::POINTS;
use crate::multistep::History;

impl ContactLine<'_> {
    /// Moments of the line's own forces along (0) or across (1) with the powers of their places [N/m].
    pub fn moments_of_shear(&self, direction: usize) -> ByPowers {
        let mut moments = ByPowers::default();
        for (i, powers) in self.given.powers.iter().enumerate() {
            let force = self.shear(i)[direction];
            if force != 0.0 {
                moments.iter_mut().zip(powers).for_each(|(moment, power)| *moment += force * power);
            }
        }
        moments
    }

    /// Displacement of the wheel less that of the rail at a candidate along (0) or across (1) by the lines of the patch \[m].
    pub fn moved_by_lines(&self, direction: usize, i: usize) -> f64 {
        self.given.powers.get(i).map_or(0.0, |powers| at(&self.iterate.fields[direction].displacement, powers))
    }

    /// Slope along the line of that displacement \[1]: half of it is the strain of the wheel, the other half that of the rail.
    pub fn stretch_by_lines(&self, direction: usize, i: usize) -> f64 {
        let Some(patch) = self.problem.patch else { return 0.0 };
        at(&self.iterate.fields[direction].strain, &self.given.powers[i]) / patch.half_length
    }

    /// Displacement of the wheel less that of the rail at a candidate along (0) or across (1) \[m].
    pub fn moved(&self, direction: usize, i: usize) -> f64 {
        let port = self.grid.component(i);
        let own = match direction {
            0 => self.state.surface[0][port] - self.state.surface[1][port],
            _ => self.iterate.displaced[port / 2],
        };
        let by_lines = self.moved_by_lines(direction, i);
        if direction == 0 { own + by_lines + self.moved_by_layer(port) } else { own + by_lines }
    }

    /// Moves the history of the displacement along (0) or across (1) on, and that of its part that becomes smaller where the
    /// line becomes wider.
    pub fn remember(&mut self, direction: usize) {
        let time = self.problem.time;
        for i in 0..self.grid.len() {
            let moved = self.moved(direction, i);
            self.state.moved[direction][i].reach(&time, moved);
        }
        let LineProblem { patch: Some(_), size: Some(_), .. } = *self.problem else { return };
        let widened = &mut self.state.widened[direction];
        let begins = widened.is_empty();
        widened.resize(self.grid.len(), History::default());
        for (i, history) in widened.iter_mut().enumerate() {
            let port = self.grid.component(i);
            let own = match direction {
                0 => 2.0 * self.iterate.own.along[port],
                _ => self.iterate.displaced[port / 2],
            };
            let growth = at(&self.iterate.growths[direction], &self.given.powers[i]);
            let value = own - 2.0 * growth;
            if begins { *history = History::constant(value) } else { history.reach(&time, value) }
        }
    }

    /// Elastic energy of the shear along (0) or across (1) in the lines of the patch, and across in the line itself [J/m].
    pub fn energy_of_shear(&self, direction: usize) -> f64 {
        let LineIterate { moments, fields, displaced, .. } = &*self.iterate;
        let by_lines = moments[direction].iter().zip(&fields[direction].displacement).map(|(moment, by)| moment * by);
        let first = (self.grid.component(0) / 2).min(displaced.len());
        let own = match direction {
            0 => 0.0,
            _ => self.state.lateral.iter().zip(&displaced[first..]).map(|(force, moved)| force * moved).sum(),
        };
        0.5 * (own + by_lines.sum::<f64>())
    }

    /// Writes slips [m/s] along (0) or across (1) as a polynomial of the place, by the moments of all `lines` of the patch in all
    /// `directions`: its coefficients one after the other, each by all moments. Without a patch there are none.
    pub fn slips_by_moments(&self, direction: usize, [lines, directions]: [usize; 2], slips: &mut Vec<f64>) {
        let Some(patch) = self.problem.patch else { return };
        let speeds = [self.problem.time.a0, self.traction.rigid.travel + self.rim_velocity()];
        let [by_displacement, by_strain] = slip_of_field(speeds, patch.half_length);
        let (first, count) = (slips.len(), lines * directions * POINTS);
        slips.resize(first + count * POINTS, 0.0);
        let slips = &mut slips[first..];
        for (place, (by, other)) in (0..lines).flat_map(|by| (0..directions).map(move |other| (by, other))).enumerate()
        {
            let Some(between) = patch.between(by, [direction, other]) else { continue };
            let moments = between.displacement.iter().zip(&between.strain).enumerate();
            for (moment, (displacements, strains)) in moments {
                for power in 0..POINTS {
                    slips[power * count + place * POINTS + moment] =
                        by_displacement * displacements[power] + by_strain * strains[power];
                }
            }
            if (by, other) == (patch.line, direction) {
                slips[place * POINTS] += by_displacement * patch.by_reach(direction);
            }
        }
    }
}
