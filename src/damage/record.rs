//! Records of the temperatures of points of material, and findings at a place of the tread.

use super::mesh::SpotMesh;
use serde::{Deserialize, Serialize};

/// Between these temperatures cooling rates of steel are taken: 800 and 500 °C [K].
const COOLING: [f64; 2] = [1073.15, 773.15];
/// Martensite per kelvin below its start, `1 − exp(−α (Ms − T))` (Koistinen & Marburger, *Acta Metall.* 7 (1959))
/// [1/K].
const KOISTINEN_MARBURGER: f64 = 0.011;
/// Share of martensite that counts as martensitic [1].
const MARTENSITIC: f64 = 0.5;

/// Temperatures and cooling rate that decide about the structure of the steel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Criteria {
    /// Austenitisation temperature Ac1 \[K].
    pub austenitisation: f64,
    /// Temperature Ms below which austenite becomes martensite \[K].
    pub martensite_start: f64,
    /// Cooling rate between 800 and 500 °C above which it does not become pearlite before [K/s].
    pub critical_cooling: f64,
    /// Excess temperature over the bulk of the wheel that opens a spot \[K].
    pub threshold: f64,
}

/// Damage of a point of material.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct MaterialPoint {
    /// Highest temperature so far \[K].
    pub peak: f64,
    /// Time above Ac1 so far \[s].
    pub above_ac1: f64,
    /// Time at which it fell below 800 °C, or below Ac1 if it had not reached 800 °C, and that temperature [s, K]; none
    /// unless it is between them and 500 °C.
    pub left: Option<[f64; 2]>,
    /// Mean cooling rate from there to 500 °C; zero before [K/s].
    pub cooling_rate: f64,
    /// Share of martensite \[1].
    pub martensite: f64,
}

impl MaterialPoint {
    /// Records a step of `dt` \[s] to the time `time` \[s], from one temperature to another \[K].
    pub fn record(&mut self, [before, after]: [f64; 2], time: f64, dt: f64, criteria: &Criteria) {
        self.peak = self.peak.max(after);
        let ac1 = criteria.austenitisation;
        if before.max(after) < ac1.min(COOLING[1]) && self.cooling_rate < criteria.critical_cooling {
            // Nothing to record below the temperatures that matter.
            return;
        }
        self.above_ac1 += dt * share_above(before, after, ac1);
        if after > before {
            if after > ac1 {
                (self.left, self.cooling_rate, self.martensite) = (None, 0.0, 0.0);
            }
            return;
        }
        let falls_below = |level: f64| before >= level && level > after;
        let crossing = |level: f64| time - dt * (level - after) / (before - after);
        for level in [COOLING[0].max(ac1), ac1] {
            if falls_below(level) && self.left.is_none() {
                self.left = Some([crossing(level), level]);
            }
        }
        if falls_below(COOLING[1])
            && let Some([since, from]) = self.left.take()
        {
            self.cooling_rate = ((from - COOLING[1]) / (crossing(COOLING[1]) - since)).max(0.0);
        }
        if after < criteria.martensite_start && self.cooling_rate >= criteria.critical_cooling {
            let share = -(-KOISTINEN_MARBURGER * (criteria.martensite_start - after)).exp_m1();
            self.martensite = self.martensite.max(share);
        }
    }
}

/// Share of a step with linear temperature that lies above a level.
fn share_above(before: f64, after: f64, level: f64) -> f64 {
    match (before > level, after > level) {
        (true, true) => 1.0,
        (false, false) => 0.0,
        _ => (before.max(after) - level) / (before - after).abs(),
    }
}

/// Findings at a place of the tread.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Findings {
    /// Highest temperature of its hottest point \[K].
    pub peak: f64,
    /// Longest time of a point above Ac1 \[s].
    pub above_ac1: f64,
    /// Mean cooling rate of that point from 800 to 500 °C, zero while it is hotter [K/s]. The hottest point may be one
    /// that was hot for milliseconds, somewhere at an edge; which one depends on the mesh.
    pub cooling_rate: f64,
    /// Depth to which Ac1 was exceeded \[m].
    pub ac1_depth: f64,
    /// Depth to which at least half is martensite \[m].
    pub martensite_depth: f64,
}

impl Findings {
    /// Union of both: the worst of each; the cooling rate is that of the one that was longer above Ac1.
    pub fn with(&self, other: &Self) -> Self {
        Self {
            peak: self.peak.max(other.peak),
            cooling_rate: if other.above_ac1 > self.above_ac1 { other.cooling_rate } else { self.cooling_rate },
            above_ac1: self.above_ac1.max(other.above_ac1),
            ac1_depth: self.ac1_depth.max(other.ac1_depth),
            martensite_depth: self.martensite_depth.max(other.martensite_depth),
        }
    }

    /// Findings at all points of a mesh.
    pub(super) fn of(mesh: &SpotMesh, points: &[MaterialPoint], criteria: &Criteria) -> Self {
        let ac1 = criteria.austenitisation;
        let mut found = Self::default();
        for column in points.chunks_exact(mesh.depth.len()) {
            let mut last = [None; 2];
            for (layer, point) in column.iter().enumerate() {
                found.peak = found.peak.max(point.peak);
                if point.above_ac1 > found.above_ac1 {
                    (found.above_ac1, found.cooling_rate) = (point.above_ac1, point.cooling_rate);
                }
                if point.peak > ac1 {
                    last[0] = Some(layer);
                }
                if point.martensite > MARTENSITIC {
                    last[1] = Some(layer);
                }
            }
            let austenitised = deepest(&mesh.depth, column, last[0], |point| point.peak - ac1);
            let martensitic = deepest(&mesh.depth, column, last[1], |point| point.martensite - MARTENSITIC);
            found.ac1_depth = found.ac1_depth.max(austenitised.0);
            // What ends where austenite ended ends at the same depth between the nodes.
            let all = martensitic.1.is_some() && martensitic.1 == austenitised.1;
            found.martensite_depth = found.martensite_depth.max(if all { austenitised.0 } else { martensitic.0 });
        }
        found
    }
}

/// Depth to which an excess is positive, linear between nodes \[m], and the last node with it, which is `last`.
fn deepest(
    depth: &[f64],
    column: &[MaterialPoint],
    last: Option<usize>,
    excess: impl Fn(&MaterialPoint) -> f64,
) -> (f64, Option<usize>) {
    let Some(end) = last else {
        return (0.0, None);
    };
    let Some(below) = column.get(end + 1) else {
        return (depth[end], last);
    };
    let (inside, outside) = (excess(&column[end]), excess(below));
    (depth[end] + inside / (inside - outside) * (depth[end + 1] - depth[end]), last)
}

/// Recorder of the points of a spot.
pub(super) struct Recorder {
    /// Temperatures and cooling rate that decide about the structure.
    pub criteria: Criteria,
    /// Absolute temperature over which excess temperatures are counted [K].
    pub reference: f64,
}

impl Recorder {
    /// A point that has the excess temperature `excess` [K] when its history begins.
    pub fn begin(&self, excess: f64) -> MaterialPoint {
        MaterialPoint { peak: self.reference + excess, ..MaterialPoint::default() }
    }

    /// The points after a step of `dt` [s] to the time `time` [s] between excess temperatures [K].
    pub fn stepped(
        &self,
        points: &[MaterialPoint],
        [before, after]: [&[f64]; 2],
        time: f64,
        dt: f64,
    ) -> Vec<MaterialPoint> {
        let steps = points.iter().zip(before.iter().zip(after));
        let stepped = steps.map(|(point, (&before, &after))| {
            let mut point = *point;
            point.record([self.reference + before, self.reference + after], time, dt, &self.criteria);
            point
        });
        stepped.collect()
    }
}
