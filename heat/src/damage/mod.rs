//! Metallurgy of hot treads: histories of places that were heated while they stood in the contact, and of the points of
//! the tread that passed through it.
//!
//! The temperature fields of [`crate::heat`] live on meshes that stand with the contact, on which heat that turns out
//! of it is smeared. A wheel that is locked, or nearly so, heats one place of its tread. Here a *spot*, a fine mesh
//! over arc and depth that is fixed to the material, takes over the field while the place lies under the contact, and
//! conducts the heat on by itself when the wheel has turned it away. Every node records what metallurgy asks for: peak,
//! time above Ac1, cooling rate, martensite. Derivation and limits: `docs/theory/material-history.md`.
//!
//! Temperatures given to this room are excess temperatures over the reference \[K], those it reports are absolute.

mod conduction;
mod fatigue;
mod mesh;
mod record;
mod shared;
mod spot;
mod tread;
mod worst;

pub use conduction::ConductionScratch;
pub use fatigue::surface_fatigue;
pub use mesh::{SpotLayout, SpotMesh};
use record::Recorder;
pub use record::{Criteria, Findings, PointHistory, Records};
use spot::Visit;
pub use spot::{ColumnSampler, Spot, SpotField};
pub use tread::Tread;
pub use worst::Worst;

use serde::{Deserialize, Serialize};
use std::f64::consts::{PI, TAU};

/// Largest number of spots. Beyond it, the least hot of the cold ones is forgotten, but for its findings.
pub const MOST_SPOTS: usize = 8;
/// Time in which a wheel turns by less than the length of the nominal contact if it heats one place [s].
const HEATING_TIME: f64 = 10e-3;
/// Distance of places below which one slide that crept on has heated both [half-widths of the nominal contact].
const CONNECTED: f64 = 4.0;
/// Longest time between two looks at the temperatures of a place below the contact, in internal steps \[s].
const LOOK: f64 = 0.9e-3;
/// Share of the half-width of the nominal contact by which a wheel turns that hardly does \[1]: a tenth of an element of
/// a spot.
const STILL: f64 = 0.01;
/// Share of the excess temperature that opens a spot at which it is cold again [1].
const COLD: f64 = 0.25;

/// Model of the material history of one wheel; immutable, its data are in the [`Damage`].
#[derive(Clone, Debug)]
pub struct HotSpots {
    mesh: SpotMesh,
    /// Radius of the wheel \[m].
    radius: f64,
    /// Half-width of the nominal contact \[m].
    half_width: f64,
    /// Half-length of the zone in which there usually is contact \[m].
    zone: f64,
    /// Absolute reference temperature \[K].
    reference: f64,
    /// Coefficient of convection to the air [W/(m² K)].
    convection: f64,
}

/// History of the wheel's material. Without hot spots it allocates no memory.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Damage {
    /// Highest temperature of the wheel's tread in the contact so far \[K].
    pub peak: f64,
    /// Highest temperature of the rail's surface in the contact so far \[K].
    pub rail_peak: f64,
    /// Points of the tread that were hot in the contact.
    pub tread: Tread,
    /// Places that were heated in one piece, the oldest first.
    pub spots: Vec<Spot>,
    /// Extremes of all these places so far.
    pub worst: Worst,
    /// Findings at spots that had to make room.
    pub forgotten: Findings,
    /// Their largest shares of martensite at the depths of the mesh \[1]; empty without any.
    pub forgotten_martensite: Vec<f64>,
    /// Number of places heated in one piece so far; those that touch each other count as one.
    pub places: u64,
}

/// Motion and temperatures of the tread in a step, and its position at the end.
#[derive(Clone, Copy, Debug)]
pub struct TreadStep<'a> {
    /// Length of the step \[s].
    pub dt: f64,
    /// True if nobody looks at the history before the next step.
    pub interim: bool,
    /// Angle of the wheel at the end, forward positive \[rad].
    pub angle: f64,
    /// Angular velocity, forward positive [rad/s].
    pub omega: f64,
    /// Length of the contact, zero without one \[m].
    pub contact_length: f64,
    /// Largest distance of the contact from the contact point \[m].
    pub contact_reach: f64,
    /// Highest excess temperatures of wheel and rail in the contact zone \[K].
    pub hottest: [f64; 2],
    /// Mean excess temperature of the wheel \[K].
    pub bulk: f64,
    /// Positions at which the surface of the wheel is known \[m], ascending, and its excess temperatures there \[K].
    pub surface: (&'a [f64], &'a [f64]),
    /// Temperatures and cooling rate that decide about the structure of the steel.
    pub criteria: Criteria,
}

impl HotSpots {
    /// Model of a wheel with the given mesh.
    pub fn new(layout: &SpotLayout) -> Self {
        Self {
            mesh: SpotMesh::new(layout),
            radius: layout.radius,
            half_width: layout.half_width,
            zone: layout.zone,
            reference: layout.reference,
            convection: layout.convection,
        }
    }

    /// Mesh of a spot.
    pub fn mesh(&self) -> &SpotMesh {
        &self.mesh
    }

    /// History of a wheel whose tread and rail have the excess temperatures `hottest` \[K] at the start.
    pub fn begin(&self, hottest: [f64; 2]) -> Damage {
        let [peak, rail_peak] = hottest.map(|excess| self.reference + excess);
        Damage { peak, rail_peak, ..Damage::default() }
    }

    /// Advances the history by one step.
    pub fn advance(
        &self,
        damage: &mut Damage,
        now: &TreadStep,
        sample: ColumnSampler,
        scratch: &mut ConductionScratch,
    ) {
        damage.peak = damage.peak.max(self.reference + now.hottest[0]);
        damage.rail_peak = damage.rail_peak.max(self.reference + now.hottest[1]);
        let (ac1, threshold) = (now.criteria.austenitisation - self.reference, now.criteria.threshold);
        let turned = self.radius * now.omega * now.dt;
        if now.hottest[0] > ac1 {
            let points = 8.0 * PI * self.radius / self.half_width;
            damage.tread.allocate(TAU * self.radius, points);
            damage.tread.pass(now.surface, ac1, self.radius * now.angle, turned, now.dt);
        }
        let heats = now.hottest[0] - now.bulk > threshold && self.stands(now.omega);
        if damage.spots.is_empty() && !heats {
            return;
        }
        let nearest = damage.spots.iter().map(|spot| self.distance(spot, now).abs()).fold(f64::INFINITY, f64::min);
        for spot in &mut damage.spots {
            self.advance_spot(spot, now, heats, sample, (&mut damage.worst, scratch));
        }
        if heats && nearest > self.half_width {
            self.make_room(damage);
            damage.places += u64::from(nearest > CONNECTED * self.half_width);
            self.open(damage, now, sample);
        }
    }

    /// Opens a spot at the contact point. Beyond the zone of the contact its temperatures are those of spots that lie
    /// there.
    fn open(&self, damage: &mut Damage, now: &TreadStep, sample: ColumnSampler) {
        let (mesh, record) = (&self.mesh, self.recorder(now));
        let layers = mesh.depth.len();
        let visit = Visit { distance: 0.0, reach: self.reach(now), dt: now.dt, still: 0.0, holds: 0.0, film: 0.0 };
        let mut temperature = vec![0.0; mesh.size()];
        for (&arc, column) in mesh.arc.iter().zip(temperature.chunks_exact_mut(layers)) {
            let known = |spot: &Spot| arc - self.distance(spot, now);
            let beyond = !visit.covers(arc);
            if !(beyond && damage.spots.iter().rev().any(|spot| spot.column(mesh, known(spot), column))) {
                sample(arc, column);
            }
        }
        let arc = (self.radius * now.angle).rem_euclid(TAU * self.radius);
        let spot = Spot::at(arc, temperature, mesh, &record);
        spot.raise(mesh, self.reference, &mut damage.worst);
        damage.spots.push(spot);
    }

    fn recorder(&self, now: &TreadStep) -> Recorder {
        Recorder { criteria: now.criteria, reference: self.reference }
    }

    /// Distance from the contact point up to which the temperatures of the contact are known finely \[m].
    fn reach(&self, now: &TreadStep) -> f64 {
        self.zone.max(now.contact_reach)
    }

    fn advance_spot(
        &self,
        spot: &mut Spot,
        now: &TreadStep,
        heats: bool,
        sample: ColumnSampler,
        (worst, scratch): (&mut Worst, &mut ConductionScratch),
    ) {
        let distance = self.distance(spot, now);
        let under = self.stands(now.omega) && distance.abs() <= self.half_width;
        let record = self.recorder(now);
        let film = self.convection + self.chill(now);
        let news = if under && (heats || spot.following) {
            let still = STILL * self.half_width / (self.radius * now.omega.abs());
            let holds = if now.interim { LOOK.min(still) } else { 0.0 };
            let visit = Visit { distance, reach: self.reach(now), dt: now.dt, still, holds, film };
            spot.follow(&self.mesh, &visit, sample, &record, scratch)
        } else {
            spot.conduct(&self.mesh, now.dt, film, &record, scratch)
        };
        if news {
            spot.raise(&self.mesh, self.reference, worst);
        }
        if !heats || !under {
            spot.rest_below(now.bulk + COLD * now.criteria.threshold);
        }
    }

    /// Rotation so slow that the contact heats one place.
    fn stands(&self, omega: f64) -> bool {
        self.radius * omega.abs() * HEATING_TIME <= 2.0 * self.half_width
    }

    /// Distance of a spot from the contact point along the tread \[m], the shorter way round.
    fn distance(&self, spot: &Spot, now: &TreadStep) -> f64 {
        self.shorter_way(spot.arc - self.radius * now.angle)
    }

    /// A distance along the tread \[m], the shorter way round.
    fn shorter_way(&self, distance: f64) -> f64 {
        let round = TAU * self.radius;
        (distance + 0.5 * round).rem_euclid(round) - 0.5 * round
    }

    /// Distance along the tread \[m] from the contact point to the point that touches when the wheel has turned by another
    /// `ahead` \[rad].
    pub fn along_tread(&self, ahead: f64) -> f64 {
        self.shorter_way(self.radius * ahead)
    }

    /// Excess temperatures \[K] at the depths of the mesh below the point of the tread that touches at the angle `point`
    /// of the wheel \[rad], if that point lies on a hot place; of several the latest counts.
    pub fn column(&self, damage: &Damage, point: f64) -> Option<Vec<f64>> {
        let mut column = vec![0.0; self.mesh.depth.len()];
        let beside = |spot: &Spot| self.shorter_way(self.radius * point - spot.arc);
        damage.spots.iter().rev().any(|spot| spot.column(&self.mesh, beside(spot), &mut column)).then_some(column)
    }

    /// Angle of the wheel between 0 and 2π at which the hottest place touches \[rad]; none without any.
    pub fn hottest_angle(&self, damage: &Damage) -> Option<f64> {
        let turn = |arc: f64| (arc / self.radius).rem_euclid(TAU);
        (!damage.worst.peaks.is_empty()).then(|| turn(damage.worst.hottest))
    }

    /// Coefficient of the heat that a rolling wheel gives to the cold rail, as a mean over a turn [W/(m² K)]: bodies of
    /// equal effusivity e that touch for the time t exchange `e ΔT √(t/π)` per area.
    fn chill(&self, now: &TreadStep) -> f64 {
        let speed = self.radius * now.omega.abs();
        if speed == 0.0 || now.contact_length <= 0.0 {
            return 0.0;
        }
        let touches = now.contact_length / speed;
        self.mesh.effusivity() * (touches / PI).sqrt() * now.omega.abs() / TAU
    }

    /// Forgets one spot if the list is full: the least hot of those that are cold again, else of all.
    fn make_room(&self, damage: &mut Damage) {
        if damage.spots.len() < MOST_SPOTS {
            return;
        }
        let rank = |spot: &Spot| (spot.is_hot(), spot.findings().peak);
        let least = (0..damage.spots.len()).min_by(|a, b| {
            let [(hot_a, peak_a), (hot_b, peak_b)] = [a, b].map(|i| rank(&damage.spots[*i]));
            hot_a.cmp(&hot_b).then(peak_a.total_cmp(&peak_b))
        });
        if let Some(least) = least {
            let spot = damage.spots.remove(least);
            damage.forgotten = damage.forgotten.with(&spot.findings());
            raise(&mut damage.forgotten_martensite, spot.martensite());
        }
    }

    /// Agreement of a history with the dimensions of this model.
    pub fn fits(&self, damage: &Damage) -> bool {
        let layers = [&damage.worst.peaks, &damage.forgotten_martensite].map(Vec::len);
        let known = layers.iter().all(|count| *count == 0 || *count == self.mesh.depth.len());
        let place = damage.worst.heat.is_finite() && damage.worst.hottest.is_finite();
        known && place && damage.spots.len() <= MOST_SPOTS && damage.spots.iter().all(|spot| spot.fits(&self.mesh))
    }
}

impl Damage {
    /// Findings at all places together.
    pub fn findings(&self) -> Findings {
        let all = self.spots.iter().fold(self.forgotten, |all, spot| all.with(&spot.findings()));
        Findings { above_ac1: all.above_ac1.max(self.tread.longest()), ..all }
    }

    /// Largest share of martensite that there is now at each depth of the mesh, of all places \[1]; empty without any.
    pub fn martensite(&self) -> Vec<f64> {
        let mut most = self.forgotten_martensite.clone();
        self.spots.iter().for_each(|spot| raise(&mut most, spot.martensite()));
        most
    }

    /// Number of places that are still hot.
    pub fn hot_places(&self) -> usize {
        self.spots.iter().filter(|spot| spot.is_hot()).count()
    }

    /// Replaces this by a copy, reusing memory.
    pub fn copy_from(&mut self, other: &Self) {
        let Self { peak, rail_peak, tread, spots, worst, forgotten, forgotten_martensite, places } = other;
        (self.peak, self.rail_peak) = (*peak, *rail_peak);
        self.tread.copy_from(tread);
        self.spots.clone_from(spots);
        self.worst.clone_from(worst);
        self.forgotten_martensite.clone_from(forgotten_martensite);
        (self.forgotten, self.places) = (*forgotten, *places);
    }
}

/// Raises values at depths to those of another place; none are zero.
fn raise(most: &mut Vec<f64>, values: &[f64]) {
    most.resize(most.len().max(values.len()), 0.0);
    most.iter_mut().zip(values).for_each(|(most, value)| *most = most.max(*value));
}
