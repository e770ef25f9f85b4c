//! A place of the tread that was heated in one piece.

use super::conduction::{self, conduct};
use super::mesh::SpotMesh;
use super::record::{Findings, Point, Recorder};
use super::shared;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// First step of its own after the contact has left a spot [s], and the share of the time since then that later ones take.
const FIRST_STEP: f64 = 2e-5;
const STEP_SHARE: f64 = 0.03;
/// What a place had of heat of its own is forgotten when it is less than this [K].
const NEGLIGIBLE: f64 = 1.0;

/// Fills a column with the excess temperatures \[K] at the depths of the mesh, at a distance along the tread \[m] from the
/// contact point.
pub type Sample<'a> = &'a dyn Fn(f64, &mut [f64]);

/// A place of the tread that was heated in one piece, once or several times.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Spot {
    /// Where its middle lies in the material: distance along the tread, backwards from what touched at angle 0 \[m].
    pub arc: f64,
    /// Whether the contact is heating it, so that it takes its temperatures from there.
    pub following: bool,
    /// Its temperatures and what its points remember; none while it is cold. Copies of a state share them.
    #[serde(with = "shared")]
    field: Option<Arc<Field>>,
    /// Time since the contact left it \[s].
    alone: f64,
    /// Time that is still to be computed \[s].
    pending: f64,
    /// What was found when it was hot before.
    earlier: Findings,
    /// What was found since.
    latest: Findings,
}

/// Temperatures of a spot.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Field {
    /// Excess temperatures \[K].
    pub temperature: Vec<f64>,
    /// What they are more than those under the contact: heat from before that the contact does not know; empty: nothing.
    pub remainder: Vec<f64>,
    /// Histories of the nodes.
    pub points: Vec<Point>,
    /// Time since the place became hot \[s].
    pub age: f64,
}

impl Spot {
    /// A place whose middle touches at the distance `arc` \[m] turned.
    pub(super) fn at(arc: f64) -> Self {
        Self { arc, ..Self::default() }
    }

    /// What was found there.
    pub fn findings(&self) -> Findings {
        self.earlier.with(&self.latest)
    }

    /// Whether it is still being followed.
    pub fn is_hot(&self) -> bool {
        self.field.is_some()
    }

    /// Its temperatures, while it is hot.
    pub fn field(&self) -> Option<&Field> {
        self.field.as_deref()
    }

    /// A step of `dt` \[s] under the contact, from which it now is `distance` \[m] away: its temperatures are those of the
    /// sample, and what it brought along.
    pub(super) fn follow(
        &mut self,
        mesh: &SpotMesh,
        distance: f64,
        dt: f64,
        film: f64,
        sample: Sample,
        recorder: &Recorder,
    ) {
        let mut seen = vec![0.0; mesh.size()];
        for (arc, column) in mesh.arc.iter().zip(seen.chunks_exact_mut(mesh.depth.len())) {
            sample(distance + arc, column);
        }
        let Some(field) = self.field.as_mut() else {
            let points = seen.iter().map(|&excess| recorder.begin(excess)).collect();
            self.field = Some(Arc::new(Field { temperature: seen, points, ..Field::default() }));
            self.following = true;
            self.judge(mesh, recorder);
            return;
        };
        let field = Arc::make_mut(field);
        if !self.following {
            // It comes back: up to now it has gone its own way.
            let dt = std::mem::take(&mut self.pending) + dt;
            field.advance(mesh, dt, film, recorder, &mut conduction::Scratch::default());
            field.remainder = field.temperature.iter().zip(&seen).map(|(own, seen)| (own - seen).max(0.0)).collect();
            field.take(seen, 0.0, recorder);
            self.following = true;
        } else {
            if !field.remainder.is_empty() {
                conduct(mesh, &mut field.remainder, dt, film, &mut conduction::Scratch::default());
            }
            field.take(seen, dt, recorder);
        }
        self.alone = 0.0;
        self.judge(mesh, recorder);
    }

    /// A step of `dt` \[s] away from the contact; returns whether its temperatures are new.
    pub(super) fn conduct(&mut self, mesh: &SpotMesh, dt: f64, film: f64, recorder: &Recorder) -> bool {
        self.following = false;
        let Some(field) = self.field.as_mut() else { return false };
        let own_step = |alone: f64| mesh.resolution * FIRST_STEP.max(STEP_SHARE * alone);
        self.pending += dt;
        if self.pending < own_step(self.alone) {
            return false;
        }
        let field = Arc::make_mut(field);
        field.remainder = Vec::new();
        let mut scratch = conduction::Scratch::default();
        while self.pending >= own_step(self.alone) {
            let step = own_step(self.alone);
            self.pending -= step;
            self.alone += step;
            field.advance(mesh, step, film, recorder, &mut scratch);
        }
        self.judge(mesh, recorder);
        true
    }

    /// Raises the highest temperatures at the depths of the mesh \[K] to those of this place.
    pub(super) fn raise(&self, peaks: &mut [f64]) {
        let depths = peaks.len();
        for column in self.field().iter().flat_map(|field| field.points.chunks_exact(depths)) {
            peaks.iter_mut().zip(column).for_each(|(peak, point)| *peak = peak.max(point.peak));
        }
    }

    /// Ends the history of temperatures when all are below a limit \[K]; what was found stays.
    pub(super) fn rest_below(&mut self, limit: f64) {
        let cold = |field: &Field| field.temperature.iter().all(|&excess| excess < limit);
        if self.field().is_some_and(cold) {
            (self.field, self.following, self.alone, self.pending) = (None, false, 0.0, 0.0);
            self.earlier = self.findings();
            self.latest = Findings::default();
        }
    }

    fn judge(&mut self, mesh: &SpotMesh, recorder: &Recorder) {
        if let Some(field) = &self.field {
            self.latest = Findings::of(mesh, &field.points, &recorder.criteria);
        }
    }

    /// Whether the data have the dimensions of a mesh.
    pub(super) fn fits(&self, mesh: &SpotMesh) -> bool {
        let size = mesh.size();
        let fits = |field: &Field| {
            let times = [field.age, self.alone, self.pending];
            field.temperature.len() == size
                && field.points.len() == size
                && (field.remainder.is_empty() || field.remainder.len() == size)
                && times.iter().all(|time| time.is_finite() && *time >= 0.0)
        };
        self.arc.is_finite() && self.field().is_none_or(fits)
    }
}

impl Field {
    /// Own conduction over a step, with the records of the points.
    fn advance(&mut self, mesh: &SpotMesh, dt: f64, film: f64, recorder: &Recorder, scratch: &mut conduction::Scratch) {
        let before = self.temperature.clone();
        conduct(mesh, &mut self.temperature, dt, film, scratch);
        self.age += dt;
        recorder.step(&mut self.points, &before, &self.temperature, self.age, dt);
    }

    /// Takes over what is `seen` under the contact after `dt` [s], and adds what the place has of its own: conduction is
    /// linear.
    fn take(&mut self, mut seen: Vec<f64>, dt: f64, recorder: &Recorder) {
        seen.iter_mut().zip(&self.remainder).for_each(|(seen, rest)| *seen += rest);
        if self.remainder.iter().all(|rest| rest.abs() < NEGLIGIBLE) {
            self.remainder = Vec::new();
        }
        self.age += dt;
        recorder.step(&mut self.points, &self.temperature, &seen, self.age, dt);
        self.temperature = seen;
    }
}
