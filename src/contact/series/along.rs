//! Lines that slip along only: on arches where slip is one stretch in one direction, else at points.

use super::chebyshev::Arch;
use super::contact::SeriesContact;
use super::points::COUNT;
use super::series_line::SeriesLine;
use super::state::Tractions;
use super::{cone_search, stick};
use crate::contact::error::ContactError;
use std::f64::consts::PI;

/// Shortest way of the material in a step, over the half-width of the patch \[1]: below, the creepage under a held force
/// remembers every place where slip has begun, and twelve points miss it by some per cent.
const SHORTEST_WAY: f64 = 0.25;

impl SeriesLine<'_> {
    /// True if points resolve what the line remembers.
    fn suits_points(&self) -> bool {
        let way = 0.5 * self.speed() / self.problem.line.time.a0;
        self.problem.line.time.is_stationary() || way > SHORTEST_WAY * self.before.tractions.pressure.half_width
    }

    /// Tractions with an arch in the place of points that stick from the leading edge on and slip in one direction behind
    /// it; `None` if they do not.
    fn as_arch(&self) -> Option<Tractions> {
        let states = self.tractions.directions?;
        let stuck = states.iter().take_while(|state| **state == 0).count();
        let sign = *states.get(stuck).unwrap_or(&1);
        if stuck == 0 && states.iter().all(|state| *state == sign) {
            let (slide, stick) = (f64::from(sign) * self.friction, Arch::default());
            return Some(Tractions { slide, stick, directions: None, ..self.tractions });
        }
        if stuck == 0 || states[stuck..].iter().any(|state| *state != sign) {
            return None;
        }
        let Tractions { pressure, stick: shear, .. } = self.tractions;
        let (slide, share) = (f64::from(sign) * self.friction, (stuck as f64 / COUNT as f64).min(0.99));
        let half_width = share * pressure.half_width;
        let centre = pressure.centre + self.upstream() * (pressure.half_width - half_width);
        let mut stick = Arch { centre, half_width, ..shear };
        // Of Carter's form, with the force of the points.
        let total = 2.0 * (shear.total() - slide * pressure.total()) / (PI * half_width);
        stick.terms = std::array::from_fn(|k| if k == 0 { total } else { 0.0 });
        Some(Tractions { slide, stick, directions: None, ..self.tractions })
    }
}

/// Finds tractions and motions: on arches where slip is one stretch in one direction on every line, else on points.
pub fn solve(contact: &mut SeriesContact) -> Result<(), ContactError> {
    // Under a layer shear begins with a slope, and ends without a root where slip begins: arches have neither.
    if contact.lines.iter().any(|line| line.problem.line.layer > 0.0) {
        return Err(ContactError::Unsuited { reason: "there is an elastic layer" });
    }
    if contact.lines.iter().all(|line| line.tractions.directions.is_none()) {
        let Err(error) = stick::solve(contact) else { return Ok(()) };
        contact.lines.iter_mut().for_each(SeriesLine::begin_anew);
        if !contact.lines.iter().all(SeriesLine::suits_points) {
            return Err(error);
        }
    } else if !contact.lines.iter().all(SeriesLine::suits_points) {
        return Err(ContactError::Unsuited {
            reason: "slip has no single beginning, and the material moves too little in the step",
        });
    }
    cone_search::solve::<1>(contact)?;
    let arches: Option<Vec<Tractions>> = contact.lines.iter().map(SeriesLine::as_arch).collect();
    let Some(arches) = arches else { return Ok(()) };
    // Points have decided, and arches are more exact.
    let found: Vec<_> = contact.lines.iter().map(|line| (line.tractions, line.rigid)).collect();
    contact.lines.iter_mut().zip(arches).for_each(|(line, arch)| line.tractions = arch);
    if stick::solve(contact).is_ok() {
        return Ok(());
    }
    for (line, (tractions, rigid)) in contact.lines.iter_mut().zip(found) {
        (line.tractions, line.rigid) = (tractions, rigid);
    }
    cone_search::solve::<1>(contact)
}
