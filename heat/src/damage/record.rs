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

/// Damage of a point of material besides its peak.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PointHistory {
    /// Time above Ac1 so far \[s].
    pub above_ac1: f64,
    /// Time at which it fell below 800 °C, or below Ac1 if it had not reached 800 °C, and that temperature [s, K]; none
    /// unless it is between them and 500 °C.
    pub left: Option<[f64; 2]>,
    /// Mean cooling rate from there to 500 °C; zero before [K/s].
    pub cooling_rate: f64,
    /// Share of martensite that there is now: below Ms, and none once it is austenite again \[1].
    pub martensite: f64,
}

impl Criteria {
    /// True if a step between such temperatures \[K] leaves the history of a point that was never hot as it is.
    fn leaves_cold(&self, hotter: f64) -> bool {
        hotter < self.austenitisation.min(COOLING[1]) && self.critical_cooling > 0.0
    }
}

impl PointHistory {
    /// Records a step of `dt` \[s] to the time `time` \[s], from one temperature to another \[K].
    pub fn record(&mut self, [before, after]: [f64; 2], time: f64, dt: f64, criteria: &Criteria) {
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
            let share = -libm::expm1(-KOISTINEN_MARBURGER * (criteria.martensite_start - after));
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
    /// Depth to which at least half is martensite now \[m]: steel that became austenite again is none.
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
    pub(super) fn of(mesh: &SpotMesh, records: &Records, criteria: &Criteria) -> Self {
        let ac1 = criteria.austenitisation;
        let mut found = Self::default();
        for (peaks, histories) in records.columns(mesh.depth.len()) {
            found.peak = peaks.iter().fold(found.peak, |most, peak| most.max(*peak));
            for history in histories {
                if history.above_ac1 > found.above_ac1 {
                    (found.above_ac1, found.cooling_rate) = (history.above_ac1, history.cooling_rate);
                }
            }
            let austenitised = deepest(&mesh.depth, peaks, |peak| peak - ac1);
            let martensitic = deepest(&mesh.depth, histories, |history| history.martensite - MARTENSITIC);
            found.ac1_depth = found.ac1_depth.max(austenitised.0);
            // What ends where austenite ended ends at the same depth between the nodes.
            let all = martensitic.1.is_some() && martensitic.1 == austenitised.1;
            found.martensite_depth = found.martensite_depth.max(if all { austenitised.0 } else { martensitic.0 });
        }
        found
    }
}

/// Depth to which an excess is positive, linear between nodes \[m], and the last node with it.
fn deepest<T>(depth: &[f64], column: &[T], excess: impl Fn(&T) -> f64) -> (f64, Option<usize>) {
    let Some(last) = column.iter().rposition(|point| excess(point) > 0.0) else {
        return (0.0, None);
    };
    let Some(below) = column.get(last + 1) else {
        return (depth[last], Some(last));
    };
    let (inside, outside) = (excess(&column[last]), excess(below));
    (depth[last] + inside / (inside - outside) * (depth[last + 1] - depth[last]), Some(last))
}

/// Records of the points of a mesh, column by column.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Records {
    /// Highest temperatures so far \[K].
    peaks: Vec<f64>,
    /// Histories of the points of each column; empty where none was ever as hot as matters.
    histories: Vec<Vec<PointHistory>>,
}

impl Records {
    /// Highest temperatures \[K] and histories of the columns of `layers` points.
    pub(super) fn columns(&self, layers: usize) -> impl Iterator<Item = (&[f64], &[PointHistory])> {
        self.peaks.chunks_exact(layers).zip(self.histories.iter().map(Vec::as_slice))
    }

    /// Largest share of martensite that there is now at each of `layers` depths \[1].
    pub(super) fn martensite(&self, layers: usize) -> Vec<f64> {
        let mut most = vec![0.0_f64; layers];
        for histories in &self.histories {
            most.iter_mut().zip(histories).for_each(|(most, history)| *most = most.max(history.martensite));
        }
        most
    }

    /// Part of the records that counts after a rest: highest temperatures so far, and martensite.
    pub(super) fn at_rest(&self) -> Self {
        let kept = |history: &PointHistory| PointHistory { martensite: history.martensite, ..PointHistory::default() };
        let histories = self.histories.iter().map(|histories| match histories.iter().any(|h| h.martensite > 0.0) {
            true => histories.iter().map(kept).collect(),
            false => Vec::new(),
        });
        Self { peaks: self.peaks.clone(), histories: histories.collect() }
    }

    /// Agreement with the dimensions of a mesh.
    pub(super) fn fits(&self, mesh: &SpotMesh) -> bool {
        let layers = mesh.depth.len();
        self.peaks.len() == mesh.size()
            && self.histories.len() == mesh.arc.len()
            && self.histories.iter().all(|histories| histories.is_empty() || histories.len() == layers)
    }
}

/// Recorder of the points of a spot.
pub(super) struct Recorder {
    /// Temperatures and cooling rate that decide about the structure.
    pub criteria: Criteria,
    /// Absolute temperature over which excess temperatures are counted [K].
    pub reference: f64,
}

impl Recorder {
    /// Records of points that have the excess temperatures `excess` [K] when their history begins.
    pub fn begin(&self, excess: &[f64], mesh: &SpotMesh) -> Records {
        let peaks = excess.iter().map(|excess| self.reference + excess).collect();
        Records { peaks, histories: vec![Vec::new(); mesh.arc.len()] }
    }

    /// Adds a step of `dt` \[s] to the time `time` \[s] between excess temperatures \[K] to the records.
    pub fn record(&self, records: &mut Records, [before, after]: [&[f64]; 2], time: f64, dt: f64) {
        let layers = before.len() / records.histories.len().max(1);
        let absolute = |excess: f64| self.reference + excess;
        records.peaks.iter_mut().zip(after).for_each(|(peak, after)| *peak = peak.max(absolute(*after)));
        let columns = before.chunks_exact(layers).zip(after.chunks_exact(layers));
        for (histories, (before, after)) in records.histories.iter_mut().zip(columns) {
            let highest = before.iter().chain(after).fold(f64::NEG_INFINITY, |most, excess| most.max(*excess));
            if histories.is_empty() && self.criteria.leaves_cold(absolute(highest)) {
                continue;
            }
            histories.resize(layers, PointHistory::default());
            for (history, (before, after)) in histories.iter_mut().zip(before.iter().zip(after)) {
                history.record([absolute(*before), absolute(*after)], time, dt, &self.criteria);
            }
        }
    }
}
