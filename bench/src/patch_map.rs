//! The patch from above: pressure, shear along and across, slip along and temperatures on a regular grid of x, along the rail, and z, across.
//!
//! A patch is computed on lines side by side. Between two of them the square of the half-length is linear in z, or of an
//! ellipse in z², and falls to zero at the edge: the outline of an ellipse is exact. Values are taken at the
//! same share of the half-length. Pressure and shear are proportional to it besides, so that of an ellipse Hertz's
//! pressure is exact; slip and temperature are linear, and so is the place where slip turns to stick.

use crate::settings::Patch;
use wheelrail::contact::Traction;
use wheelrail::rolling::{Line, State};
use wheelrail::simulation::Outputs;

/// Slip [m/s] below which a place sticks, as in the report page.
const STICKS: f64 = 1e-6;
/// Slip of places that stick over the largest of the line, at most, where friction acts across, too \[1].
const RESIDUE: f64 = 0.05;
/// Free width between two lines, over their mean width, from which on they belong to two patches \[1].
const APART: f64 = 0.2;

/// Numbers of places along and across.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct GridSize {
    /// Along the rail.
    pub along: usize,
    /// Across it.
    pub across: usize,
}

/// Quantities on the grid, in this order, one after the other; each row by row, x ascending in a row.
pub const QUANTITIES: [&str; 7] =
    ["pressure", "shear", "shear_z", "slip", "state", "temperature_wheel", "temperature_rail"];
/// Number of `state` among them.
pub const STATE: usize = 4;
/// Values of `state`: nothing touches, the surfaces stick, they slip.
pub const STATES: [f64; 3] = [0.0, 1.0, 2.0];

/// One line as the grid sees it.
struct Strip<'a> {
    line: &'a Line,
    /// Lateral position of its middle \[m].
    z: f64,
    /// Width \[m].
    width: f64,
    /// Middle and half-length of all on which forces act \[m].
    centre: f64,
    half_length: f64,
    /// Places where slip turns to stick or back, from the middle over the half-length, ascending \[1].
    turns: Vec<f64>,
    /// True if it slips before the first of them.
    slips: bool,
}

/// Lines with no free width between them, z ascending.
struct Group<'a> {
    strips: Vec<Strip<'a>>,
    /// Both ends \[m].
    low: f64,
    high: f64,
}

/// A place across a group: two neighbours with the share of the second, and the half-length there.
struct Place<'a, 'b> {
    lines: [(&'b Strip<'a>, f64); 2],
    centre: f64,
    half_length: f64,
    /// Half-length over that of the outermost line beyond it, otherwise 1.
    fading: f64,
}

/// The patch of a state. Its lines are those of the outputs `line.*`.
pub struct PatchMap<'a> {
    groups: Vec<Group<'a>>,
    patch: Patch,
    points: &'a [f64],
    reference: f64,
}

impl Strip<'_> {
    /// Distance of a place from the nearest one where slip turns to stick, or from the nearest end, all over the
    /// half-length \[1]: positive where it slips.
    fn slipping(&self, place: f64) -> f64 {
        let passed = self.turns.partition_point(|turn| *turn < place);
        let slips = self.slips != (passed % 2 == 1);
        let nearest = self.turns.iter().map(|turn| (place - turn).abs()).fold(1.0 - place.abs(), f64::min);
        if slips { nearest } else { -nearest }
    }
}

impl<'a> PatchMap<'a> {
    /// The patch of a state and of its outputs. `reference` is the temperature of cold steel \[K].
    pub fn new(state: &'a State, outputs: &'a Outputs, patch: Patch, reference: f64) -> Self {
        // Lines of a symmetric patch stand for two of those of the outputs.
        let symmetric = outputs.contact_line_count as usize > state.lines.len();
        let strips = seen(&state.lines, symmetric).into_iter().enumerate().map(|(k, line)| strip(line, outputs, k));
        let mut groups: Vec<Group> = Vec::new();
        for strip in strips {
            let [low, high] = [-0.5, 0.5].map(|side| strip.z + side * strip.width);
            match groups.last_mut() {
                Some(group) if patch == Patch::Ellipse || low - group.high < APART * strip.width => {
                    group.high = high;
                    group.strips.push(strip);
                }
                _ => groups.push(Group { strips: vec![strip], low, high }),
            }
        }
        if let (Patch::Ellipse, [group]) = (patch, groups.as_mut_slice()) {
            (group.low, group.high) = (-0.5 * outputs.contact_width, 0.5 * outputs.contact_width);
        }
        Self { groups, patch, points: &outputs.profile_x, reference }
    }

    /// Both ends of the patch across \[m].
    pub fn ends(&self) -> [f64; 2] {
        [self.groups.first().map_or(0.0, |group| group.low), self.groups.last().map_or(0.0, |group| group.high)]
    }

    /// Appends both ends of the patch along the rail \[m] at the middle of each row of a grid across `z` \[m]: the rear ones,
    /// then the front ones. They are equal where nothing touches.
    pub fn outline(&self, rows: usize, z: [f64; 2], out: &mut Vec<f64>) {
        let places: Vec<_> = (0..rows).map(|row| self.place(middle(z, row, rows))).collect();
        for side in [-1.0, 1.0] {
            let end = |place: &Place| place.centre + side * place.half_length;
            out.extend(places.iter().map(|place| place.as_ref().map_or(0.0, end)));
        }
    }

    /// Appends the values of all [`QUANTITIES`] on a grid whose cells fill `x` and `z` \[m], at the middle of each.
    pub fn fill(&self, size: GridSize, [x, z]: [[f64; 2]; 2], out: &mut Vec<f64>) {
        let first = out.len();
        let cells = size.along * size.across;
        out.resize(first + QUANTITIES.len() * cells, 0.0);
        for row in 0..size.across {
            let place = self.place(middle(z, row, size.across));
            for column in 0..size.along {
                let values = self.values(place.as_ref(), middle(x, column, size.along));
                for (quantity, value) in values.into_iter().enumerate() {
                    out[first + quantity * cells + row * size.along + column] = value;
                }
            }
        }
    }

    fn place<'b>(&'b self, z: f64) -> Option<Place<'a, 'b>> {
        let group = self.groups.iter().find(|group| (group.low..=group.high).contains(&z))?;
        let (first, last) = (group.strips.first()?, group.strips.last()?);
        if self.patch == Patch::Line {
            return Some(Place {
                lines: [(first, 1.0), (first, 0.0)],
                centre: first.centre,
                half_length: first.half_length,
                fading: 1.0,
            });
        }
        let law = |z: f64| if self.patch == Patch::Ellipse { z * z } else { z };
        let beyond = |line: &'b Strip<'a>, edge: f64| {
            let Strip { z: end, centre, half_length, .. } = *line;
            let left = (law(edge) - law(z)) / (law(edge) - law(end));
            let fading = if left.is_finite() { left.max(0.0).sqrt() } else { 1.0 };
            Place { lines: [(line, 1.0), (line, 0.0)], centre, half_length: fading * half_length, fading }
        };
        if z <= first.z {
            return Some(beyond(first, group.low));
        }
        if z >= last.z {
            return Some(beyond(last, group.high));
        }
        let pair = group.strips.windows(2).find(|pair| z <= pair[1].z)?;
        let [a, b] = [&pair[0], &pair[1]];
        // Of two lines at the same distance from the middle, z² tells nothing.
        let between = |low: f64, high: f64, at: f64| if high == low { 0.5 } else { (at - low) / (high - low) };
        let of_law = between(law(a.z), law(b.z), law(z));
        let share = if (0.0..=1.0).contains(&of_law) { of_law } else { between(a.z, b.z, z) };
        let mix = |x: f64, y: f64| x + share * (y - x);
        Some(Place {
            lines: [(a, 1.0 - share), (b, share)],
            centre: mix(a.centre, b.centre),
            half_length: mix(a.half_length.powi(2), b.half_length.powi(2)).sqrt(),
            fading: 1.0,
        })
    }

    fn values(&self, place: Option<&Place>, x: f64) -> [f64; QUANTITIES.len()] {
        let mut values = [0.0, 0.0, 0.0, 0.0, STATES[0], self.reference, self.reference];
        let Some(Place { lines, centre, half_length, fading }) = place else { return values };
        let (from_centre, mut slips) = (x - centre, 0.0);
        let inside = from_centre.abs() <= *half_length;
        for (strip, weight) in lines.iter().filter(|(_, weight)| *weight > 0.0) {
            let at = strip.centre
                + match inside && *half_length > 0.0 {
                    true => from_centre / half_length * strip.half_length,
                    false => from_centre + from_centre.signum() * (strip.half_length - half_length),
                };
            let traction = &strip.line.contact.traction;
            if inside && strip.half_length > 0.0 {
                let scale = weight * half_length / strip.half_length;
                values[0] += scale * traction.pressure.at(at);
                values[1] += scale * traction.shear.at(at);
                values[2] += scale * traction.lateral_shear.at(at);
                values[3] += weight * traction.slip.at(at);
                slips += weight * strip.slipping(from_centre / half_length);
            }
            if let Some(thermal) = &strip.line.thermal {
                for (body, surface) in thermal.surface.iter().enumerate() {
                    values[STATE + 1 + body] += fading * weight * interpolated(self.points, surface, at);
                }
            }
        }
        if values[0] > 0.0 {
            values[STATE] = if slips > 0.0 { STATES[2] } else { STATES[1] };
        }
        values
    }
}

/// Middle of the cell `k` of `n` that fill an interval.
fn middle([low, high]: [f64; 2], k: usize, n: usize) -> f64 {
    low + (high - low) * (k as f64 + 0.5) / n as f64
}

/// Lines in the order of the outputs `line.*`: those of a symmetric patch beside the middle twice.
fn seen(lines: &[Line], symmetric: bool) -> Vec<&Line> {
    if !symmetric {
        return lines.iter().collect();
    }
    let middle = |line: &&Line| line.layout.ordinate == 0.0;
    let beside = || lines.iter().filter(move |line| !middle(line));
    beside().rev().chain(lines.iter().filter(middle)).chain(beside()).collect()
}

fn strip<'a>(line: &'a Line, outputs: &Outputs, k: usize) -> Strip<'a> {
    let extent = line.contact.traction.extent();
    let (centre, half_length) = extent.map_or((0.0, 0.0), |extent| (extent.middle(), extent.half_length()));
    let of = |values: &[f64]| values.get(k).copied().unwrap_or(0.0);
    let (turns, slips) = turns(&line.contact.traction, [centre, half_length]);
    let (z, width) = (of(&outputs.line_position), of(&outputs.line_width));
    Strip { line, z, width, centre, half_length, turns, slips }
}

/// Places where slip turns to stick or back on a line with this middle and half-length, and whether it slips before them.
///
/// Where friction acts across, too, slip is not exactly zero where the surfaces stick: a small share of the largest divides them.
fn turns(traction: &Traction, [centre, half_length]: [f64; 2]) -> (Vec<f64>, bool) {
    let Traction { slip, lateral_slip, stick_fraction, .. } = traction;
    let amount = |(x, along): (&f64, &f64)| (*x, (along.powi(2) + lateral_slip.at(*x).powi(2)).sqrt());
    let amounts: Vec<_> = slip.x.iter().zip(&slip.value).map(amount).collect();
    let largest = amounts.iter().fold(0.0, |largest: f64, (_, amount)| largest.max(*amount));
    let least = match lateral_slip.is_empty() {
        true => STICKS,
        false if *stick_fraction <= 0.0 => -1.0,
        false if *stick_fraction >= 1.0 => 2.0 * largest,
        false => RESIDUE * largest,
    };
    let nodes: Vec<_> = amounts.iter().map(|(x, amount)| (*x, amount - least)).collect();
    let turn = |pair: &[(f64, f64)]| {
        let [a, b] = [pair[0], pair[1]];
        let place = a.0 - (b.0 - a.0) * a.1 / (b.1 - a.1);
        ((a.1 > 0.0) != (b.1 > 0.0)).then_some((place - centre) / half_length)
    };
    (nodes.windows(2).filter_map(turn).collect(), nodes.first().is_some_and(|node| node.1 > 0.0))
}

/// Value at a place between ascending points; beyond them that of the last one.
fn interpolated(points: &[f64], values: &[f64], at: f64) -> f64 {
    let next = points.partition_point(|point| *point < at);
    match (next.checked_sub(1), values.get(next)) {
        (None, first) => first.copied().unwrap_or(0.0),
        (Some(before), None) => values.get(before).copied().unwrap_or(0.0),
        (Some(before), Some(after)) => {
            let share = (at - points[before]) / (points[next] - points[before]);
            values[before] + share * (after - values[before])
        }
    }
}
