//! States, forces and motions of lines in an iterate, to go back to.

use crate::axes::PerAxis;
use crate::contact::line::contact_line::ContactLine;
use crate::contact::line::state::{NodeStatus, Slide};
use nalgebra::DVector;

/// States, forces and motions of a line in an iterate.
#[derive(Default)]
pub(super) struct Present {
    status: Vec<NodeStatus>,
    yielded: Vec<bool>,
    forces: DVector<f64>,
    lateral: Vec<f64>,
    slides: Vec<Slide>,
    rigid: PerAxis<f64>,
}

impl Present {
    fn take(&mut self, line: &ContactLine) {
        self.status.clone_from(&line.state.status);
        self.yielded.clone_from(&line.state.yielded);
        self.forces.clone_from(&line.state.forces);
        self.lateral.clone_from(&line.state.lateral);
        self.slides.clone_from(&line.iterate.slides);
        self.rigid = line.traction.rigid;
    }

    fn give_back(&self, line: &mut ContactLine) {
        line.state.status.clone_from(&self.status);
        line.state.yielded.clone_from(&self.yielded);
        line.state.forces.clone_from(&self.forces);
        line.state.lateral.clone_from(&self.lateral);
        line.iterate.slides.clone_from(&self.slides);
        line.traction.rigid = self.rigid;
    }
}

/// Takes those of all lines.
pub(super) fn take(lines: &[ContactLine], present: &mut Vec<Present>) {
    present.resize_with(lines.len(), Present::default);
    present.iter_mut().zip(lines).for_each(|(present, line)| present.take(line));
}

/// Gives them back to the lines.
pub(super) fn give_back(present: &[Present], lines: &mut [ContactLine]) {
    present.iter().zip(lines).for_each(|(present, line)| present.give_back(line));
}
