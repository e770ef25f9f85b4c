//! A place of the tread that was heated in one piece.

use super::conduction::{ConductionScratch, beside, conduct};
use super::mesh::SpotMesh;
use super::record::{Findings, Recorder, Records};
use super::shared;
use super::worst::Worst;
use crate::linalg::vectorised::dot;
use serde::{Deserialize, Serialize};
use std::ops::Range;
use std::sync::Arc;

/// First step of its own after the contact has left a spot [s], and the share of the time since then that later ones
/// take; beside a contact that stands still, of the time since the place became hot.
const FIRST_STEP: f64 = 4e-5;
const STEP_SHARE: f64 = 0.05;
/// Time in which a wheel that stands still hardly turns \[s].
const STANDS: f64 = 1e-2;
/// Temperature below which the heat that a place brought along is forgotten [K].
const NEGLIGIBLE: f64 = 1.0;

/// Function that fills a column with the excess temperatures \[K] at the depths of the mesh, at a distance along the
/// tread \[m] from the contact point.
pub type ColumnSampler<'a> = &'a dyn Fn(f64, &mut [f64]);

/// A step of a place under the contact.
#[derive(Clone, Copy, Debug)]
pub(super) struct Visit {
    /// Distance of its middle from the contact point along the tread \[m].
    pub distance: f64,
    /// Distance from the contact point up to which the temperatures of the contact are known finely \[m].
    pub reach: f64,
    /// Length of the step \[s].
    pub dt: f64,
    /// Time in which the wheel hardly turns, infinite at rest \[s].
    pub still: f64,
    /// Time for which a look at the temperatures of the contact holds \[s].
    pub holds: f64,
    /// Coefficient of the heat lost from the surface [W/(m² K)].
    pub film: f64,
}

impl Visit {
    /// Knowledge of the temperatures at `arc` \[m] from the middle of the place from the contact.
    pub fn covers(&self, arc: f64) -> bool {
        (self.distance + arc).abs() <= self.reach
    }

    /// Columns of the mesh at which the contact knows the temperatures.
    fn columns(&self, mesh: &SpotMesh) -> Range<usize> {
        let from = mesh.arc.partition_point(|arc| self.distance + arc < -self.reach);
        from..mesh.arc.partition_point(|arc| self.distance + arc <= self.reach).max(from)
    }
}

/// A place of the tread that was heated in one piece, once or several times.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Spot {
    /// Position of its middle in the material: distance along the tread, backwards from the point that touched at angle
    /// 0 \[m].
    pub arc: f64,
    /// Heating by the contact, from which it then takes its temperatures.
    pub following: bool,
    /// Its temperatures and the records of its points; none while it is cold. Copies of a state share them.
    #[serde(with = "shared")]
    field: Option<Arc<SpotField>>,
    /// Time since the contact left it \[s].
    alone: f64,
    /// Time that is still to be computed \[s], and that of the places beside the contact \[s].
    pending: f64,
    beside: f64,
    /// Martensite that it brought into its rest; a new heating begins with it, and what becomes austenite again loses it.
    #[serde(with = "shared")]
    rested: Option<Arc<Records>>,
    /// Largest share of martensite that there is now at each depth of the mesh \[1].
    martensite: Vec<f64>,
    /// Findings of earlier heatings.
    earlier: Findings,
    /// Findings of the latest heating.
    latest: Findings,
}

/// Temperatures of a spot.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SpotField {
    /// Excess temperatures \[K].
    pub temperature: Vec<f64>,
    /// Excess over the temperatures under the contact: heat from before that the contact does not know; empty: zero.
    pub remainder: Vec<f64>,
    /// Records of the nodes.
    pub records: Records,
    /// Time since the place became hot \[s].
    pub age: f64,
}

impl Spot {
    /// A place whose middle touches at the distance `arc` \[m] turned, with the excess temperatures `temperature` \[K].
    pub(super) fn at(arc: f64, temperature: Vec<f64>, mesh: &SpotMesh, recorder: &Recorder) -> Self {
        let records = recorder.begin(&temperature, mesh);
        let field = Some(Arc::new(SpotField { temperature, records, ..SpotField::default() }));
        let mut spot = Self { arc, following: true, field, ..Self::default() };
        spot.judge(mesh, recorder);
        spot
    }

    /// Findings at this place.
    pub fn findings(&self) -> Findings {
        self.earlier.with(&self.latest)
    }

    /// Largest share of martensite that there is now at each depth of the mesh \[1].
    pub fn martensite(&self) -> &[f64] {
        &self.martensite
    }

    /// Presence of temperatures that are still followed.
    pub fn is_hot(&self) -> bool {
        self.field.is_some()
    }

    /// Temperatures while it is hot.
    pub fn field(&self) -> Option<&SpotField> {
        self.field.as_deref()
    }

    /// Step under the contact, or its time put by until a new look is due: in the zone of the contact the temperatures are
    /// those of the sample and the heat that the place brought along; beyond, where the sample is coarse, the place conducts
    /// by itself. Returns `true` if its temperatures are new.
    pub(super) fn follow(
        &mut self,
        mesh: &SpotMesh,
        visit: &Visit,
        sample: ColumnSampler,
        recorder: &Recorder,
        scratch: &mut ConductionScratch,
    ) -> bool {
        let back = !std::mem::replace(&mut self.following, true);
        self.pending += visit.dt;
        if !back && self.pending < visit.holds {
            return false;
        }
        let dt = std::mem::take(&mut self.pending);
        let (layers, all) = (mesh.depth.len(), 0..mesh.arc.len());
        // A place that was at rest is cold, and has the martensite of before.
        if self.field.is_none() {
            self.field = Some(Arc::new(SpotField::cold(mesh, recorder, self.rested.take())));
            self.earlier.martensite_depth = 0.0;
        }
        let Some(field) = self.field.as_mut().map(Arc::make_mut) else { return false };
        let before = field.temperature.clone();
        let SpotField { temperature: now, remainder, age, .. } = &mut *field;
        let covered = visit.columns(mesh);
        if back {
            conduct(mesh, now, all, dt, visit.film, scratch);
            remainder.clear();
            remainder.resize(mesh.size(), 0.0);
        } else {
            self.beside += dt;
            if visit.still <= STANDS || self.beside >= mesh.resolution * STEP_SHARE * *age {
                let dt = std::mem::take(&mut self.beside);
                for columns in beside(mesh, &covered, dt).into_iter().filter(|columns| !columns.is_empty()) {
                    conduct(mesh, now, columns, dt, visit.film, scratch);
                }
            }
            if !remainder.is_empty() {
                conduct(mesh, remainder, all, dt, visit.film, scratch);
            }
        }
        let mut seen = vec![0.0; layers];
        for column in covered {
            sample(visit.distance + mesh.arc[column], &mut seen);
            for (node, seen) in (column * layers..).zip(&seen) {
                if back {
                    remainder[node] = (now[node] - seen).max(0.0);
                }
                now[node] = seen + remainder.get(node).copied().unwrap_or(0.0);
            }
        }
        if remainder.iter().all(|rest| rest.abs() < NEGLIGIBLE) {
            *remainder = Vec::new();
        }
        field.record(&before, recorder, dt);
        self.alone = 0.0;
        self.judge(mesh, recorder);
        true
    }

    /// Fills `column` with the temperatures at the distance `arc` \[m] from the middle, and returns `true`, within the
    /// mesh of a hot place.
    pub(super) fn column(&self, mesh: &SpotMesh, arc: f64, column: &mut [f64]) -> bool {
        let (Some(field), layers) = (self.field(), mesh.depth.len()) else { return false };
        let after = mesh.arc.partition_point(|place| *place <= arc);
        if after == 0 || after == mesh.arc.len() {
            return false;
        }
        let (from, to) = (mesh.arc[after - 1], mesh.arc[after]);
        let share = (arc - from) / (to - from);
        let at = |k: usize| &field.temperature[k * layers..(k + 1) * layers];
        for ((value, a), b) in column.iter_mut().zip(at(after - 1)).zip(at(after)) {
            *value = a + share * (b - a);
        }
        true
    }

    /// Step of `dt` \[s] away from the contact; returns `true` if its temperatures are new.
    pub(super) fn conduct(
        &mut self,
        mesh: &SpotMesh,
        dt: f64,
        film: f64,
        recorder: &Recorder,
        scratch: &mut ConductionScratch,
    ) -> bool {
        (self.following, self.beside) = (false, 0.0);
        let Some(field) = self.field.as_mut() else { return false };
        let own_step = |alone: f64| mesh.resolution * FIRST_STEP.max(STEP_SHARE * alone);
        self.pending += dt;
        if self.pending < own_step(self.alone) {
            return false;
        }
        let field = Arc::make_mut(field);
        field.remainder = Vec::new();
        let mut before = Vec::new();
        while self.pending >= own_step(self.alone) {
            let step = own_step(self.alone);
            self.pending -= step;
            self.alone += step;
            before.clone_from(&field.temperature);
            conduct(mesh, &mut field.temperature, 0..mesh.arc.len(), step, film, scratch);
            field.record(&before, recorder, step);
        }
        self.judge(mesh, recorder);
        true
    }

    /// Raises extremes at the depths of the mesh to those of this place; `reference` is the absolute temperature without
    /// excess \[K].
    pub(super) fn raise(&self, mesh: &SpotMesh, reference: f64, worst: &mut Worst) {
        let Some(field) = self.field() else { return };
        let (layers, thickness) = (mesh.depth.len(), mesh.shares.iter().sum::<f64>());
        let Worst { peaks, heat, hottest } = worst;
        peaks.resize(layers, 0.0);
        for (arc, (column, _)) in mesh.arc.iter().zip(field.records.columns(layers)) {
            peaks.iter_mut().zip(column).for_each(|(peak, place)| *peak = peak.max(*place));
            let found = dot(column, &mesh.shares) - reference * thickness;
            if found > *heat {
                (*heat, *hottest) = (found, self.arc + arc);
            }
        }
    }

    /// Ends the history of temperatures when all are below a limit \[K]; findings stay.
    pub(super) fn rest_below(&mut self, limit: f64) {
        let cold = |field: &SpotField| field.temperature.iter().all(|&excess| excess < limit);
        if self.field().is_some_and(cold) {
            self.rested = self.field().map(|field| Arc::new(field.records.at_rest()));
            (self.field, self.following) = (None, false);
            [self.alone, self.pending, self.beside] = [0.0; 3];
            self.earlier = self.findings();
            self.latest = Findings::default();
        }
    }

    fn judge(&mut self, mesh: &SpotMesh, recorder: &Recorder) {
        if let Some(field) = &self.field {
            self.latest = Findings::of(mesh, &field.records, &recorder.criteria);
            self.martensite = field.records.martensite(mesh.depth.len());
        }
    }

    /// Agreement of the data with the dimensions of a mesh.
    pub(super) fn fits(&self, mesh: &SpotMesh) -> bool {
        let size = mesh.size();
        let fits = |field: &SpotField| {
            let times = [field.age, self.alone, self.pending, self.beside];
            field.temperature.len() == size
                && field.records.fits(mesh)
                && (field.remainder.is_empty() || field.remainder.len() == size)
                && times.iter().all(|time| time.is_finite() && *time >= 0.0)
        };
        let rested = self.rested.as_ref().is_none_or(|records| records.fits(mesh));
        let shares = self.martensite.len() == mesh.depth.len();
        self.arc.is_finite() && rested && shares && self.field().is_none_or(fits)
    }
}

impl SpotField {
    /// Temperatures of a place without excess, with the records of a place at rest.
    fn cold(mesh: &SpotMesh, recorder: &Recorder, rested: Option<Arc<Records>>) -> Self {
        let temperature = vec![0.0; mesh.size()];
        let records = rested.map_or_else(|| recorder.begin(&temperature, mesh), Arc::unwrap_or_clone);
        Self { records, temperature, ..Self::default() }
    }

    /// Notes a step of `dt` \[s] from the excess temperatures `before` \[K] to those of now in the records of the points.
    fn record(&mut self, before: &[f64], recorder: &Recorder, dt: f64) {
        self.age += dt;
        recorder.record(&mut self.records, [before, &self.temperature], self.age, dt);
    }
}
