//! Figures and tables of the thesis, one function each: the thesis's method, ours, the closed form and the quoted
//! number.

mod annulus;
mod braking;
mod carter;
mod closed_forms;
mod corrugation;
mod extent;
mod extrapolation;
mod friction_heat;
mod heat_switched;
mod holes;
mod introduction;
mod lost_heat;
mod maps;
mod mesh_heat;
mod meshes;
mod paper_b;
mod plate;
mod prescribed_braking;
mod queue;
mod ramp_steps;
mod ramps;
mod rolling;
mod rough;
mod share;
mod sliding_hole;
mod tractions;
mod tread_heat;
mod tread_map;
mod validation;

pub use extent::Extent;
pub use queue::compute;

use crate::plot::{Curve, Plot, Source};
use crate::quoted::Status;

/// Something that a figure must show; if it does not, the run fails.
#[derive(Clone, Debug)]
pub struct Predicate {
    /// In words.
    pub says: String,
    /// Truth of the statement.
    pub holds: bool,
}

/// One figure, table or statement recomputed.
#[derive(Clone, Debug)]
pub struct Figure {
    /// Its name in the thesis: `I 5.1`, `B 5`.
    pub item: &'static str,
    /// Title.
    pub title: &'static str,
    /// Outcome.
    pub status: Status,
    /// Parameters; assumed ones are marked in words.
    pub parameters: &'static str,
    /// Finding, in words.
    pub finding: String,
    /// Drawings.
    pub plots: Vec<Plot>,
    /// Recomputed values by name.
    pub values: Vec<(String, f64)>,
    /// Never empty: a figure that nothing tests is refused.
    pub predicates: Vec<Predicate>,
}

impl Figure {
    /// Flaws of the item: nothing that tests it, something that does not hold, or curves that look alike.
    pub fn flaws(&self) -> Vec<String> {
        if self.predicates.is_empty() {
            return vec![format!("{}: nothing tests it", self.item)];
        }
        let broken = self.predicates.iter().filter(|predicate| !predicate.holds);
        let broken = broken.map(|predicate| format!("{}: {} does not hold", self.item, predicate.says));
        let alike = self.plots.iter().filter_map(Plot::flaw).map(|flaw| format!("{}: {flaw}", self.item));
        broken.chain(alike).collect()
    }
}

/// Every figure and table of the thesis that computes something, and the sentences with numbers, in the thesis's order.
pub const ITEMS: &[&str] = &[
    "I 4.2",
    "I 5.1",
    "A 4",
    "A T1",
    "A T2",
    "A T3",
    "A 5–6",
    "A text",
    "A 7",
    "A 8–10",
    "A 11",
    "A 12",
    "A 13–14",
    "B 4",
    "B 5",
    "B 6",
    "B 7",
    "B 10",
    "B 11",
    "B 12",
    "B 13",
    "B 14",
    "B 15",
    "B 16",
    "B 17",
    "B 18–19",
    "C 4",
    "C 6",
    "C 7",
    "C 8–11",
    "C 12",
    "C 13",
    "C 14",
    "C 15",
    "D 4",
    "D 6",
    "D T1",
    "D 7–8",
    "D 9",
    "D 10",
    "D 11–15",
    "D 16–17",
    "D 18",
    "D 19–21",
];

/// Computes one figure, or says why not.
#[derive(Clone, Copy)]
pub enum Recipe {
    /// In one extent.
    Fixed(fn() -> Result<Figure, String>),
    /// With more points or meshes in full.
    Extended(fn(Extent) -> Result<Figure, String>),
}

impl Recipe {
    /// True if it has more points or meshes in full.
    pub fn grows(self) -> bool {
        matches!(self, Self::Extended(_))
    }

    /// The figure.
    pub fn compute(self, extent: Extent) -> Result<Figure, String> {
        match self {
            Self::Fixed(recipe) => recipe(),
            Self::Extended(recipe) => recipe(extent),
        }
    }
}

/// Recomputed items, with the function that covers each.
pub const ALL: &[(&str, Recipe)] = &[
    ("I 4.2", Recipe::Fixed(introduction::rod)),
    ("I 5.1", Recipe::Fixed(introduction::schemes)),
    ("A 4", Recipe::Fixed(meshes::paper_a)),
    ("A text", Recipe::Fixed(closed_forms::hertz)),
    ("A T1", Recipe::Fixed(corrugation::mesh)),
    ("A T2", Recipe::Fixed(corrugation::step)),
    ("A T3", Recipe::Fixed(corrugation::ends)),
    ("A 5–6", Recipe::Fixed(plate::energy)),
    ("A 7", Recipe::Fixed(rough::spectrum)),
    ("A 8–10", Recipe::Fixed(rough::densities)),
    ("A 11", Recipe::Fixed(corrugation::force)),
    ("A 12", Recipe::Extended(corrugation::excitation)),
    ("A 13–14", Recipe::Fixed(holes::discontinuity)),
    ("B 4", Recipe::Fixed(meshes::ring)),
    ("B 5", Recipe::Fixed(annulus::galerkin)),
    ("B 6", Recipe::Fixed(annulus::supg)),
    ("B 7", Recipe::Fixed(annulus::bubble)),
    ("B 10", Recipe::Fixed(meshes::paper_b)),
    ("B 11", Recipe::Extended(mesh_heat::convergence)),
    ("B 12", Recipe::Fixed(tread_map::map)),
    ("B 13", Recipe::Fixed(tread_heat::pressure)),
    ("B 14", Recipe::Extended(tread_heat::velocity)),
    ("B 15", Recipe::Extended(tread_heat::conductance)),
    ("B 16", Recipe::Extended(tread_heat::load)),
    ("B 17", Recipe::Fixed(heat_switched::transient)),
    ("B 18–19", Recipe::Fixed(holes::small)),
    ("C 4", Recipe::Fixed(meshes::paper_c)),
    ("C 6", Recipe::Extended(mesh_heat::regularisation)),
    ("C 7", Recipe::Fixed(rolling::paper_c)),
    ("C 8–11", Recipe::Fixed(friction_heat::profiles)),
    ("C 12", Recipe::Extended(lost_heat::temperature)),
    ("C 13", Recipe::Fixed(friction_heat::locked)),
    ("C 14", Recipe::Extended(friction_heat::velocity)),
    ("C 15", Recipe::Extended(friction_heat::conductance)),
    ("D 4", Recipe::Fixed(meshes::paper_d)),
    ("D 6", Recipe::Extended(rolling::paper_d)),
    ("D T1", Recipe::Fixed(ramps::table)),
    ("D 7–8", Recipe::Fixed(ramps::force)),
    ("D 9", Recipe::Fixed(tractions::profiles)),
    ("D 10", Recipe::Fixed(ramps::temperature)),
    ("D 11–15", Recipe::Fixed(prescribed_braking::velocities)),
    ("D 16–17", Recipe::Fixed(braking::moment)),
    ("D 18", Recipe::Extended(share::braking)),
    ("D 19–21", Recipe::Fixed(sliding_hole::sharp)),
];

/// Items that are not recomputed yet.
pub const MISSING: &[&str] = &[];

/// A statement and whether it holds.
fn must(says: impl Into<String>, holds: bool) -> Predicate {
    Predicate { says: says.into(), holds }
}

/// That stationary heat balances: put in is what leaves, as far as `worst` \[1] of it. Not where a number is missing.
fn balanced(worst: f64) -> Predicate {
    must(format!("heat put in and heat that leaves agree within 1e-8 of it: {worst:.1e}"), worst <= 1e-8)
}

/// The largest of some numbers, NaN if one of them is.
fn largest(values: impl IntoIterator<Item = f64>) -> f64 {
    values.into_iter().fold(0.0, |most, value| if value > most || value.is_nan() { value } else { most })
}

/// A curve of given points.
fn curve(source: Source, name: impl Into<String>, points: Vec<[f64; 2]>) -> Curve {
    Curve { source, name: name.into(), points }
}
