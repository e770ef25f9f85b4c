//! Unknowns of the linear problem: of every line normal forces of the closed nodes and shear of those that stick or turn, and
//! changes of the motions that are sought. Motions themselves would ask for forces thousands of times as large in the
//! elimination, since velocities of hub and rim hardly differ, and rounding with them.

use super::axes::Axes;
use crate::axes::Axis;
use crate::contact::line::contact_line::ContactLine;

/// Unknowns of given states.
#[derive(Default)]
pub(super) struct Unknowns {
    /// Those of every line.
    pub lines: Vec<LineUnknowns>,
    /// Axes whose motions are sought; the height of the hub comes last.
    pub axes: Vec<Axis>,
}

/// Unknown forces of one line.
#[derive(Default)]
pub(super) struct LineUnknowns {
    /// Closed nodes.
    pub closed: Vec<usize>,
    /// Friction along and across over normal force at each of the closed nodes that slip; zero where they stick \[1].
    pub friction: Vec<[f64; 2]>,
    /// Unknown shear.
    pub shear: Vec<ShearUnknown>,
}

/// Unknown shear at a closed node.
#[derive(Clone, Copy)]
pub(super) struct ShearUnknown {
    /// Place of the node among the closed ones.
    pub place: usize,
    /// Its direction, along and across.
    pub direction: [f64; 2],
    /// Slip in this direction per force [m/s/(N/m)]: zero at a node that sticks, [`Slide::turn`](crate::contact::line::state::Slide)
    /// at one whose friction turns.
    pub turn: f64,
}

impl Unknowns {
    /// Lists the unknowns of the present states.
    pub fn list(&mut self, lines: &[ContactLine], axes: &Axes) {
        self.lines.resize_with(lines.len(), LineUnknowns::default);
        self.lines.iter_mut().zip(lines).for_each(|(unknowns, line)| unknowns.list(line));
        self.axes.clear();
        self.axes.extend(axes.sought());
    }

    /// Lists the normal forces of the closed nodes and the height of the hub, if that is sought, alone.
    pub fn list_pressures(&mut self, lines: &[ContactLine], axes: &Axes) {
        self.lines.resize_with(lines.len(), LineUnknowns::default);
        for (unknowns, line) in self.lines.iter_mut().zip(lines) {
            unknowns.list_closed(line);
            unknowns.friction.resize(unknowns.closed.len(), [0.0; 2]);
        }
        self.axes.clear();
        self.axes.extend(axes.sought().filter(|&axis| axis == Axis::Height));
    }

    /// Closed nodes of all lines.
    pub fn closed(&self) -> usize {
        self.lines.iter().map(|line| line.closed.len()).sum()
    }

    /// Moves the lines by `changes` of the motions that are sought.
    pub fn move_by(&self, changes: &[f64], lines: &mut [ContactLine], axes: &Axes) {
        for (change, &k) in changes.iter().zip(&self.axes) {
            let value = if axes.holds(k) { 0.0 } else { lines[0].traction.rigid[k] + change };
            lines.iter_mut().for_each(|line| line.traction.rigid[k] = value);
        }
    }
}

impl LineUnknowns {
    /// Lists the unknowns of the present states.
    fn list(&mut self, line: &ContactLine) {
        self.list_closed(line);
        for (place, &i) in self.closed.iter().enumerate() {
            let (status, friction) = (line.state.status[i], line.friction(i));
            let mut add = |direction, turn| self.shear.push(ShearUnknown { place, direction, turn });
            if status.is_stuck() {
                [[1.0, 0.0], [0.0, 1.0]].into_iter().take(line.state.directions()).for_each(|unit| add(unit, 0.0));
                self.friction.push([0.0; 2]);
                continue;
            }
            let slide = line.slide(i);
            let [along, across] = slide.direction;
            if line.state.directions() > 1 && slide.turn.is_finite() && friction > 0.0 {
                add([-across, along], slide.turn);
            }
            self.friction.push(slide.direction.map(|part| part * friction));
        }
    }

    /// Lists the closed nodes alone.
    fn list_closed(&mut self, line: &ContactLine) {
        let status = &line.state.status;
        self.closed.clear();
        self.friction.clear();
        self.shear.clear();
        self.closed.extend((0..status.len()).filter(|&i| status[i].is_active()));
    }
}
