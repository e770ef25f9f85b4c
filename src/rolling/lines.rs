//! Sums, means and extremes over the contact lines of a state.
//!
//! A line has its own contact, temperatures and surfaces; the lines share the wheel, the rail and their rigid motions.
//! Quantities per metre of width are those of the line's own width, so that those of all lines are added up by their
//! shares of the width.

use super::line::Line;
use super::state::State;
use crate::axes::PerAxis;
use nalgebra::DVector;
use std::borrow::Cow;

impl State {
    /// Sum of a quantity per metre of width over all lines, by their shares of the width.
    pub fn sum(&self, of: impl Fn(&Line) -> f64) -> f64 {
        sum(&self.lines, of)
    }

    /// Width of all lines over that of the bodies \[1].
    pub fn covered(&self) -> f64 {
        self.sum(|_| 1.0)
    }

    /// Largest value of a quantity on any line.
    pub fn largest(&self, of: impl Fn(&Line) -> f64) -> f64 {
        self.lines.iter().map(of).fold(f64::NEG_INFINITY, f64::max)
    }

    /// The line with the largest value of a quantity, of equal ones the first; `None` without lines.
    pub fn line_of_largest(&self, of: impl Fn(&Line) -> f64) -> Option<&Line> {
        let larger = |a: &'_ Line, b: &'_ Line| of(b) > of(a);
        self.lines.iter().reduce(|a, b| if larger(a, b) { b } else { a })
    }

    /// Contact forces of all lines on the wheel: x, y, z [N/m], forward moment about the hub centre \[N].
    pub fn resultant(&self) -> PerAxis<f64> {
        PerAxis::from_fn(|axis| self.sum(|line| line.contact.traction.resultant[axis]))
    }

    /// Moment of the tractions of all lines on the wheel about the vertical through the centre of load \[N].
    pub fn spin_moment(&self) -> f64 {
        self.sum(|line| line.contact.traction.spin_moment)
    }

    /// Iterations that the last contact solution took, the same for all lines.
    pub fn iterations(&self) -> usize {
        self.lines.first().map_or(0, |line| line.contact.traction.iterations)
    }

    /// Half the distance between the outermost contact edges of the longest line \[m].
    pub fn half_width(&self) -> f64 {
        self.largest(|line| line.contact.traction.half_width())
    }

    /// Mean of a quantity over all lines, by their widths.
    pub fn mean(&self, of: impl Fn(&Line) -> f64) -> f64 {
        self.weighted_mean(|_| 1.0, of)
    }

    /// Mean of a quantity over all lines, by the normal forces that they carry; without contact by their widths.
    pub fn mean_under_load(&self, of: impl Fn(&Line) -> f64) -> f64 {
        self.weighted_mean(|line| line.contact.traction.resultant.height, of)
    }

    /// Mean of a quantity over all lines, by the area on which they touch; without contact by their widths.
    pub fn mean_over_area(&self, of: impl Fn(&Line) -> f64) -> f64 {
        self.weighted_mean(|line| line.contact.traction.touching(), of)
    }

    fn weighted_mean(&self, weight: impl Fn(&Line) -> f64, of: impl Fn(&Line) -> f64) -> f64 {
        let weights = self.sum(&weight);
        match self.lines.as_slice() {
            [line] => of(line),
            _ if weights > 0.0 => self.sum(|line| weight(line) * of(line)) / weights,
            _ => self.sum(of) / self.covered(),
        }
    }

    /// Friction coefficient of all lines together \[1].
    pub fn friction(&self) -> f64 {
        self.mean_under_load(|line| line.contact.traction.friction.coefficient)
    }

    /// Mean slip velocity of the tread in the contact: x, z [m/s].
    pub fn tread_slip(&self) -> [f64; 2] {
        let along = self.mean_under_load(|line| line.contact.traction.friction.tread_slip);
        [along, self.mean_under_load(|line| line.contact.traction.friction.lateral_slip)]
    }

    /// Rigid motions (V [m/s], U \[m], Ω [rad/s]) with which the contact forces were found.
    pub fn rigid(&self) -> PerAxis<f64> {
        self.lines.first().map_or(PerAxis::default(), |line| line.contact.traction.rigid)
    }

    /// Forces of all lines together on the ports of wheel (0) or rail (1), contact forces and the pull of hot layers
    /// [N/m].
    pub fn loads(&self, body: usize) -> Cow<'_, DVector<f64>> {
        mean(&self.lines, |line| &line.contact.traction.loads[body])
    }

    /// True if any line has contact.
    pub fn touches(&self) -> bool {
        self.lines.iter().any(|line| !line.contact.traction.patches.is_empty())
    }

    /// Growth of the wheel radius by its bulk temperature \[m].
    pub fn growth(&self) -> f64 {
        self.lines.first().map_or(0.0, |line| line.deformation().radius_growth)
    }

    /// Positions \[m] along the surfaces of wheel (of that `radius` \[m]) and rail that lie below the wheel centre.
    /// That of the wheel goes by the rim, which torsion turns against the hub.
    pub fn place(&self, radius: f64) -> [f64; 2] {
        let rim_angle = self.mean_under_load(|line| line.contact.rim_angle());
        [(self.motion.angle - rim_angle) * radius, self.motion.distance]
    }
}

/// Sum of a quantity per metre of width over lines, by their shares of the width.
pub fn sum(lines: &[Line], of: impl Fn(&Line) -> f64) -> f64 {
    lines.iter().map(|line| line.layout.share * of(line)).sum()
}

/// Sum of vectors of the lines by their shares of the width; empty without lines.
pub fn mean<'a>(lines: &'a [Line], of: impl Fn(&'a Line) -> &'a DVector<f64>) -> Cow<'a, DVector<f64>> {
    match lines {
        [line] if line.layout.share == 1.0 => Cow::Borrowed(of(line)),
        lines => {
            let mut mean = DVector::zeros(lines.first().map_or(0, |line| of(line).len()));
            lines.iter().for_each(|line| mean.axpy(line.layout.share, of(line), 1.0));
            Cow::Owned(mean)
        }
    }
}
