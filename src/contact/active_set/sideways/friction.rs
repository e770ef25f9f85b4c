//! The shear of all lines and the free motions of one turn.
//!
//! Slips by shear hardly change from turn to turn: they are found again only where other nodes touch, or where the last turn
//! came less near than turns do.

use super::super::search::ActiveSet;
use super::slips;
use crate::axes::{Axis, PerAxis};
use crate::contact::cone::{ByDirection, ConeProblem, ConeVerdict, Linearised, Newton, TangentialCoupling};
use crate::contact::error::ContactError;
use crate::contact::line::contact_line::ContactLine;

/// Violation of friction and change of normal forces that count as none \[1].
pub const TOLERANCE: f64 = 1e-9;
/// Violation of friction that ends Newton's method at most, and the share of that before which does \[1].
const ROUGHEST: f64 = 1e-2;
const SHARE: f64 = 1e-3;
/// Share of the violation of the turn before up to which slips by shear are kept \[1].
const NEAR: f64 = 0.1;

/// Problem of friction of all lines at the beginning of a turn.
pub struct Prepared<const N: usize> {
    /// Closed nodes of every line.
    nodes: Vec<Vec<usize>>,
    shears: Vec<ByDirection<N, 2>>,
    problems: Vec<ConeProblem<N, 2>>,
    coupling: TangentialCoupling<2>,
    /// Linear law of before.
    linear: Option<Linearised<N, 2>>,
    /// Violation of friction by the present shear \[1].
    violation: f64,
}

impl<const N: usize> Prepared<N> {
    /// Problem of the present iterate of a `search`, from that of the turn `before`, in which friction was violated by `last`
    /// \[1].
    pub fn renewed(before: Option<Self>, search: &mut ActiveSet, last: f64) -> Self {
        let nodes: Vec<_> = search.lines.iter().map(ContactLine::closed_nodes).collect();
        let fits = |before: &Self| before.nodes == nodes && before.axes().eq(search.free_axes());
        if let Some(mut before) = before.filter(fits) {
            before.take(search);
            if before.violation <= NEAR * last {
                return before;
            }
        }
        let coupling = search.coupling();
        let problems = search.lines.iter().zip(&nodes).map(|(line, nodes)| slips::problem(line, nodes)).collect();
        let mut prepared = Self { nodes, shears: Vec::new(), problems, coupling, linear: None, violation: 0.0 };
        prepared.take(search);
        prepared
    }

    /// Axes of the motions that are free.
    fn axes(&self) -> impl Iterator<Item = Axis> {
        self.coupling.motions.iter().map(|motion| motion.axis)
    }

    /// Takes slips, friction and balances of the present iterate.
    fn take(&mut self, search: &mut ActiveSet) {
        let Self { nodes, shears, problems, coupling, .. } = self;
        *shears = search.lines.iter().zip(&*nodes).map(|(line, nodes)| slips::shears(line, nodes)).collect();
        let moments: Vec<_> = problems.iter().zip(&*shears).map(|(problem, shear)| problem.moments(shear)).collect();
        search.take_balances(coupling, &moments);
        for (k, (line, problem)) in search.lines.iter().zip(&mut *problems).enumerate() {
            slips::take(line, &nodes[k], problem, &shears[k], &coupling.by_lines(k, &moments));
        }
        self.violation = Newton::new(coupling, problems, shears, PerAxis::default()).largest();
    }

    /// Finds shear and motions and gives them to the `search`; returns how far friction and balances were violated before
    /// \[1].
    pub fn shear(&mut self, search: &mut ActiveSet, linear_laws: &mut usize) -> Result<f64, ContactError> {
        let Self { nodes, shears, problems, coupling, linear, violation } = self;
        let mut newton = Newton::new(coupling, problems, shears, PerAxis::default());
        newton.linear = linear.take();
        newton.run((SHARE * *violation).clamp(TOLERANCE, ROUGHEST))?;
        *linear_laws += newton.linear_laws;
        *linear = newton.linear.take();
        let (found, rigid) = (std::mem::take(&mut newton.shears), newton.rigid);
        let states: Vec<_> = newton.verdicts.iter().map(ConeVerdict::states).collect();
        for (k, line) in search.lines.iter_mut().enumerate() {
            line.traction.rigid = rigid;
            // No shear leaves its disc, whatever the tolerance.
            slips::give(line, &nodes[k], &problems[k].within(&found[k], 1.0), &states[k]);
        }
        Ok(*violation)
    }
}
